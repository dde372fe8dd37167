//! Padded panels that stand: plain, or drawn in by buttons.

use crate::pieces::form::all;
use crate::shape::{Reshape, grid, sphere};
use enfilade_geometry::Mesh;
use enfilade_math::{Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, PI};

/// Turns a cushion that lies in the xy plane so that its upper side faces +y and its y becomes z.
pub fn upright(mesh: Mesh) -> Mesh {
    mesh.turned(Vec3::X, FRAC_PI_2).turned(Vec3::Z, PI)
}

/// Depth of the quilting at (u, v): 0 at a button, 1 between them. Buttons are `pitch.x` apart along u, rows `pitch.y` along v.
fn quilt(u: f32, v: f32, pitch: Vec2) -> f32 {
    let (a, c) = (u / pitch.x + v / (2.0 * pitch.y), u / pitch.x - v / (2.0 * pitch.y));
    let ridge = |t: f32| (PI * t).sin().abs();
    (ridge(a) * ridge(c)).powf(0.45)
}

/// A padded panel about the origin in the xz plane that is `fat` thick towards +y, and the buttons that draw it in, in a diamond pattern.
pub fn buttoned(size: Vec2, fat: f32, pitch: Vec2) -> [Mesh; 2] {
    /// Length of a cell of the panel's mesh, metres.
    const CELL: f32 = 0.025;
    let [nu, nv] = [size.x, size.y].map(|length| ((length / CELL) as usize).max(8));
    let height = |u: f32, v: f32| {
        let rim = ((1.0 - (2.0 * u / size.x).powi(8)) * (1.0 - (2.0 * v / size.y).powi(8))).max(0.0).sqrt();
        fat * rim * (0.5 + 0.5 * quilt(u, v, pitch))
    };
    let at = |i: usize, j: usize| Vec2::new(size.x * (i as f32 / nu as f32 - 0.5), size.y * (j as f32 / nv as f32 - 0.5));
    let uv = |i: usize, j: usize| at(i, j);
    let front = |i: usize, j: usize| {
        let p = at(nu - i, j);
        Vec3::new(p.x, height(p.x, p.y), p.y)
    };
    let back = |i: usize, j: usize| Vec3::new(at(i, j).x, 0.0, at(i, j).y);
    let panel = grid(nu, nv, front, uv).with(grid(nu, nv, back, uv)).smoothed(70.0);
    let reach = 8;
    let inside = |p: &Vec2| p.x.abs() < 0.5 * size.x - 0.05 && p.y.abs() < 0.5 * size.y - 0.05;
    let places = (-reach..=reach).flat_map(|v| (-40..=40).map(move |u| (u, v))).filter(|(u, v)| (u + v) % 2 == 0);
    let buttons = places.map(|(u, v): (i32, i32)| Vec2::new(0.5 * u as f32, v as f32) * pitch).filter(inside);
    let button = |p: Vec2| {
        let flat = sphere(0.012, 10).deformed(|q| Vec3::new(q.x, 0.5 * q.y, q.z)).smoothed(60.0);
        flat.moved(Vec3::new(p.x, height(p.x, p.y) + 0.003, p.y))
    };
    [panel, all(buttons.map(button))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::volume;

    #[test]
    fn a_buttoned_panel_is_closed_and_drawn_in_where_its_buttons_are() {
        let (size, fat) = (Vec2::new(1.2, 0.5), 0.08);
        let [panel, buttons] = buttoned(size, fat, Vec2::new(0.2, 0.12));
        assert_eq!(panel.validate(), Ok(()));
        let filled = volume(&panel);
        assert!(filled > 0.5 * size.x * size.y * fat && filled < size.x * size.y * fat, "{filled}");
        // A button is in the middle of the panel, where it is half as thick.
        let deepest = buttons.positions.iter().filter(|p| p.x.abs() < 0.02 && p.z.abs() < 0.02).map(|p| p.y).fold(0.0f32, f32::max);
        assert!((deepest - 0.5 * fat - 0.009).abs() < 1e-3, "{deepest}");
    }
}
