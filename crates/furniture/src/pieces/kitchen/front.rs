//! Doors and drawer fronts of kitchen units, smooth or framed around a panel, with their handles, and the style that the fronts of one
//! kitchen share. A front is in the xz plane of its unit and faces +y.

use crate::builder::{Builder, Object};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::form::{all, rod, to_front, turned, wire};
use crate::pieces::joinery::pull;
use crate::pieces::{board, grained};
use crate::shape::{Reshape, picture_frame};
use enfilade_geometry::Mesh;
use enfilade_math::{Rng, Vec3};

/// The handles of doors and drawers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum Handle {
    Bar,
    Bow,
    Knob,
    /// A folded strip of metal over the edge.
    Edge,
}

/// The style that the units of one kitchen share.
#[derive(Clone, Copy, Debug)]
pub struct KitchenStyle {
    /// Fronts are framed around a panel instead of smooth.
    pub framed: bool,
    /// Handle of every door and drawer.
    pub handle: Handle,
    /// Metal of handles and taps.
    pub metal: Finish,
    /// Fronts below the worktop.
    pub lower: Finish,
    /// Fronts of wall units and tall units.
    pub upper: Finish,
    /// The worktop.
    pub worktop: Finish,
    /// The wall behind the worktop.
    pub splashback: Finish,
    /// Appliances have steel fronts instead of black glass.
    pub steel: bool,
}

impl KitchenStyle {
    /// A random style: which finishes, handles and worktops go together.
    pub fn random(rng: &mut Rng) -> Self {
        let (lower, upper) = [
            (Finish::KitchenFront(0), Finish::KitchenFront(1)),
            (Finish::KitchenFront(0), Finish::KitchenFront(0)),
            (Finish::WhiteLacquer, Finish::WhiteLacquer),
            (Finish::Wood, Finish::WhiteLacquer),
            (Finish::KitchenFront(0), Finish::Wood),
            (Finish::DarkWood, Finish::KitchenFront(1)),
        ][rng.below(6)];
        let wooden = lower == Finish::Wood || upper == Finish::Wood;
        let worktops = [Finish::Worktop, Finish::Stone, Finish::MarbleTop, Finish::Wood];
        let framed = !wooden && rng.below(5) < 2;
        let handle = if framed {
            [Handle::Knob, Handle::Bow, Handle::Bar][rng.below(3)]
        } else {
            [Handle::Bar, Handle::Edge, Handle::Bar, Handle::Knob][rng.below(4)]
        };
        Self {
            framed,
            handle,
            metal: [Finish::Steel, Finish::Steel, Finish::BlackMetal, Finish::Brass][rng.below(4)],
            lower,
            upper,
            worktop: worktops[rng.below(if wooden { 3 } else { 4 })],
            splashback: [Finish::WallTile, Finish::WallTile, Finish::MarbleTop, Finish::Stone][rng.below(4)],
            steel: rng.below(2) == 0,
        }
    }
}

/// The way a front opens, which decides where its handle is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Opening {
    /// A door below eye height with its handle near the upper corner at −x (−1) or +x (+1).
    Below(f32),
    /// A door above the worktop with its handle near the lower corner.
    Above(f32),
    Drawer,
    /// A front that tilts about its lower edge.
    Flap,
    /// It does not open.
    Fixed,
}

/// Thickness of a front, metres.
pub const FRONT: f32 = 0.019;
/// Half of the gap between two fronts, metres.
const GAP: f32 = 0.0015;

/// Adds the front over `[x0, x1, z0, z1]` whose back is at depth `y`.
pub fn front(
    b: &mut Builder,
    object: &Object,
    name: &str,
    rect: [f32; 4],
    y: f32,
    opening: Opening,
    style: &KitchenStyle,
    finish: Finish,
    rng: &mut Rng,
) {
    let [x0, x1, z0, z1] = [rect[0] + GAP, rect[1] - GAP, rect[2] + GAP, rect[3] - GAP];
    let (w, h) = (x1 - x0, z1 - z0);
    let middle = Vec3::new(0.5 * (x0 + x1), y, 0.5 * (z0 + z1));
    let from = b.part_count();
    let mesh = if style.framed && h > 0.2 && w > 0.2 {
        let rail = 0.062;
        let section = [[0.0, 0.0], [0.0, FRONT - 0.001], [0.001, FRONT], [rail - 0.002, FRONT], [rail, FRONT - 0.002], [rail, 0.0]];
        let panel =
            board([rail - w * 0.5 - 0.002, 0.001, rail - h * 0.5 - 0.002], [w * 0.5 - rail + 0.002, 0.011, h * 0.5 - rail + 0.002], 0.0005);
        picture_frame(w, h, &section).with(panel).moved(middle)
    } else {
        board([x0, y, z0], [x1, y + FRONT, z1], 0.0012)
    };
    b.part(object, name, grained(mesh, rng), finish);
    let (handle, at) = handle(style.handle, opening, w, h);
    b.part(object, &format!("{name}_handle"), handle.moved(middle + at + Vec3::new(0.0, FRONT - 0.0002, 0.0)), style.metal);
    let face = y + FRONT;
    match opening {
        Opening::Below(side) | Opening::Above(side) => {
            let edge = if side > 0.0 { x0 } else { x1 };
            b.joint(object, name, &Joint::cupboard(edge, face, -side), from..b.part_count());
        }
        Opening::Drawer => pull(b, object, name, from, [x0, x1, z0, z1], y, y - BEHIND, Finish::WhiteLacquer),
        Opening::Flap => b.joint(object, name, &Joint::level_flap(face, z0), from..b.part_count()),
        Opening::Fixed => {}
    }
}

/// Distance of the rear end of drawers from the wall, metres.
const BEHIND: f32 = 0.06;

/// A handle, its middle at the origin and its feet on y = 0, and where to put it, from the middle of a front of `w` × `h`.
fn handle(kind: Handle, opening: Opening, w: f32, h: f32) -> (Mesh, Vec3) {
    let (side, level) = match opening {
        Opening::Below(side) => (side, 1.0),
        Opening::Above(side) => (side, -1.0),
        Opening::Drawer | Opening::Flap | Opening::Fixed => (0.0, if h > 0.22 { 1.0 } else { 0.0 }),
    };
    let lying = side == 0.0;
    let length = match kind {
        Handle::Bar if lying => (0.5 * w).min(0.32),
        Handle::Bar => 0.192,
        _ => 0.128_f32.min(0.6 * w),
    };
    let inset = if kind == Handle::Knob { 0.032 } else { 0.035 };
    let along = if lying || kind == Handle::Knob { inset + 0.01 } else { inset + 0.5 * length + 0.012 };
    let at = Vec3::new(side * (0.5 * w - inset), 0.0, level * (0.5 * h - along));
    let half = 0.5 * length;
    let mesh = match kind {
        Handle::Bar => all([
            rod([-half, 0.03, 0.0], [half, 0.03, 0.0], 0.006, 12),
            rod([-0.8 * half, 0.0, 0.0], [-0.8 * half, 0.028, 0.0], 0.004, 8),
            rod([0.8 * half, 0.0, 0.0], [0.8 * half, 0.028, 0.0], 0.004, 8),
        ]),
        Handle::Bow => {
            let bend = [[-half, 0.0, 0.0], [-0.96 * half, 0.016, 0.0], [-0.5 * half, 0.027, 0.0], [0.5 * half, 0.027, 0.0]];
            let rest = [[0.96 * half, 0.016, 0.0], [half, 0.0, 0.0]];
            wire(&[bend.as_slice(), &rest].concat(), 0.0045, 10)
        }
        Handle::Knob => {
            let profile =
                [[0.0, 0.0], [0.009, 0.0], [0.007, 0.004], [0.006, 0.012], [0.014, 0.018], [0.0155, 0.022], [0.013, 0.027], [0.0, 0.028]];
            return (to_front(turned(&profile, 24)), at);
        }
        Handle::Edge => {
            // The strip grips the upper edge of fronts below eye height and the lower edge of those above.
            let half = 0.36 * w;
            let lip = board([-half, -0.0002, -0.0018], [half, 0.013, 0.0002], 0.0006).with(board(
                [-half, 0.011, -0.014],
                [half, 0.013, 0.0],
                0.0006,
            ));
            let level = if lying { 1.0 } else { level };
            let at = Vec3::new(0.0, 0.0, level * 0.5 * h);
            let lip = if level < 0.0 { lip.turned(Vec3::Y, std::f32::consts::PI) } else { lip };
            return (lip, at);
        }
    };
    (if lying { mesh } else { mesh.turned(Vec3::Y, std::f32::consts::FRAC_PI_2) }, at)
}
