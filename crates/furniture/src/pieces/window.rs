//! A window in its opening, of class window: a frame with as many sashes beside each other as the room asks for, their panes and handles,
//! and a sill. Frames and sashes are painted white, handles are of steel, the sill is of stone. The origin is the middle of the opening on
//! the wall's inner face, with y positive into the room.

use super::{WallOpening, board, leg};
use crate::builder::{Builder, Class};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::shape::{Reshape, grid, picture_frame, rounded_box};
use enfilade_math::{Vec2, Vec3};

/// The window in its opening: frame, sashes with panes, handles, sill.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// Number of sashes, beside each other.
    pub sashes: usize,
}

/// y of the panes, metres: the window sits this far behind the wall's inner face.
const PANE: f32 = -0.16;
/// Width of the fixed frame as seen from the room, metres.
const FRAME: f32 = 0.055;
/// Width of a sash's frame around its pane, metres.
const SASH: f32 = 0.06;
/// Width of the post between two sashes, metres.
const MULLION: f32 = 0.06;
/// Depth of the frame inside the wall, metres, so that no gap is left.
const INTO_WALL: f32 = 0.003;
/// Overlap of a sash and the frame, metres.
const LAP: f32 = 0.010;

impl Window {
    /// Height of the sill's surface above the lower edge of the opening, metres.
    pub const SILL: f32 = 0.022;
    /// Length of the sill into the room, metres.
    pub const SILL_DEPTH: f32 = 0.06;

    /// Adds the window in its opening.
    pub fn build(&self, b: &mut Builder, opening: &WallOpening) {
        let white = Finish::WhitePaint;
        let size = opening.size();
        let pose = opening.pose(0.5 * (opening.z[0] + opening.z[1]));
        let window = b.object("window", Class::Window, pose);
        let section = |inset: f32, y: [f32; 2]| [[0.0, y[0]], [0.0, y[1]], [inset - 0.004, y[1]], [inset, y[1] - 0.004], [inset, y[0]]];
        let outer = size + 2.0 * INTO_WALL;
        b.part(&window, "frame", picture_frame(outer.x, outer.y, &section(FRAME + INTO_WALL, [PANE - 0.04, PANE + 0.03])), white);
        let clear = size - 2.0 * FRAME;
        let cell = (clear.x - MULLION * (self.sashes - 1) as f32) / self.sashes as f32;
        for i in 0..self.sashes {
            let x = (cell + MULLION) * i as f32 + 0.5 * (cell - clear.x);
            let sash = Vec2::new(cell, clear.y) + 2.0 * LAP;
            let name = i + 1;
            let frame = picture_frame(sash.x, sash.y, &section(SASH, [PANE - 0.028, PANE + 0.048]));
            let from = b.part_count();
            b.part(&window, &format!("sash_{name}"), frame.moved(Vec3::new(x, 0.0, 0.0)), white);
            let glass = 0.5 * sash - SASH + 0.008;
            let pane = grid(
                1,
                1,
                |i, j| Vec3::new(x + glass.x * (1.0 - 2.0 * i as f32), PANE, glass.y * (2.0 * j as f32 - 1.0)),
                |i, j| Vec2::new(i as f32, j as f32),
            );
            b.part(&window, &format!("pane_{name}"), pane, Finish::Glass);
            if i + 1 < self.sashes {
                let m = x + 0.5 * (cell + MULLION);
                let post = board(
                    [m - 0.5 * MULLION - 0.001, PANE - 0.038, -0.5 * size.y - 0.001],
                    [m + 0.5 * MULLION + 0.001, PANE + 0.028, 0.5 * size.y + 0.001],
                    0.002,
                );
                b.part(&window, &format!("mullion_{name}"), post, white);
            }
            let hand = if i * 2 < self.sashes { -1.0 } else { 1.0 };
            let at = Vec3::new(x + hand * (0.5 * sash.x - 0.5 * SASH), PANE + 0.0478, -0.08 * size.y);
            let rose = rounded_box(Vec3::new(0.026, 0.012, 0.065), 0.004, 2).moved(at + Vec3::new(0.0, 0.006, 0.0));
            let neck =
                leg(0.034, [0.008, 0.008], Vec2::ZERO).turned(Vec3::X, -std::f32::consts::FRAC_PI_2).moved(at + Vec3::new(0.0, 0.010, 0.0));
            let lever = rounded_box(Vec3::new(0.018, 0.012, 0.125), 0.005, 3).moved(at + Vec3::new(0.0, 0.046, -0.05));
            b.part(&window, &format!("handle_{name}"), rose.with(neck).with(lever), Finish::Steel);
            // Sash and pane, and the handle, which comes after the post.
            let joint = Joint::window(x - hand * 0.5 * sash.x, PANE + 0.048, -hand);
            b.joint(&window, &format!("sash_{name}"), &joint, [from, from + 1, b.part_count() - 1]);
        }
        let half = 0.5 * size.x + 0.045;
        let low = -0.5 * size.y;
        let sill = board([-half, PANE + 0.028, low - 0.003], [half, Self::SILL_DEPTH, low + Self::SILL], 0.005);
        b.part(&window, "sill", sill, Finish::Stone);
    }
}
