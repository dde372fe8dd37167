//! Boxes with bevelled, round or swelling edges: boards, appliances, cushions.
//!
//! The u coordinate of their texture runs along the longest edge, as the grain of a board does.

use super::Reshape;
use enfilade_geometry::Mesh;
use enfilade_math::{Vec2, Vec3};

/// A box centred on the origin whose edges are bevelled by `radius`: furniture boards. 108 triangles.
pub fn bevelled_box(size: Vec3, radius: f32) -> Mesh {
    build(size, radius, 1, [1; 3])
}

/// A box centred on the origin with round edges of `radius`, each quarter circle in 2 × `segments` steps.
pub fn rounded_box(size: Vec3, radius: f32, segments: usize) -> Mesh {
    build(size, radius, segments, [1; 3])
}

/// A bevelled box that can be bent: its faces have this many cells along x, y and z.
pub fn bendable_box(size: Vec3, radius: f32, cells: [usize; 3]) -> Mesh {
    build(size, radius, 1, cells)
}

/// A rounded box that swells by `swell` metres at the middle of its faces along z, like a filled cushion.
pub fn padded_box(size: Vec3, radius: f32, swell: f32) -> Mesh {
    let half = 0.5 * size;
    build(size, radius, 3, [8; 3])
        .deformed(|p| {
            let q = (p / half).clamp(Vec3::splat(-1.0), Vec3::ONE);
            let bulge = (1.0 - q.x.powi(4)) * (1.0 - q.y.powi(4));
            let waist = (1.0 - q.z * q.z) * 0.35 * swell;
            p + Vec3::new(q.x.powi(3) * waist, q.y.powi(3) * waist, q.z.powi(3) * bulge * swell)
        })
        .smoothed(60.0)
}

/// One grid line across a face: the coordinate of the rounding's centre and the way out from it.
type Line = (f32, f32);

fn lines(half: f32, radius: f32, segments: usize, cells: usize) -> Vec<Line> {
    let inner = half - radius;
    let arc = |k: usize| if k == segments { 1.0 } else { (std::f32::consts::FRAC_PI_4 * k as f32 / segments as f32).tan() };
    let low = (1..=segments).rev().map(|k| (-inner, -radius * arc(k)));
    let flat = (0..=cells).map(|k| (inner * (2.0 * k as f32 / cells as f32 - 1.0), 0.0));
    low.chain(flat).chain((1..=segments).map(|k| (inner, radius * arc(k)))).collect()
}

fn build(size: Vec3, radius: f32, segments: usize, cells: [usize; 3]) -> Mesh {
    let half = 0.5 * size;
    let radius = radius.min(0.499 * size.min_element()).max(1e-4);
    let grain = (0..3).max_by(|&a, &b| size[a].total_cmp(&size[b])).unwrap_or(0);
    let mut mesh = Mesh::default();
    for axis in 0..3 {
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        let (along, across) = if b == grain { (b, a) } else { (a, b) };
        for side in [1.0, -1.0] {
            let (lines_a, lines_b) = (lines(half[a], radius, segments, cells[a]), lines(half[b], radius, segments, cells[b]));
            let base = mesh.positions.len() as u32;
            for &(center_b, out_b) in &lines_b {
                for &(center_a, out_a) in &lines_a {
                    let (mut center, mut out) = (Vec3::ZERO, Vec3::ZERO);
                    (center[a], center[b], center[axis]) = (center_a, center_b, side * (half[axis] - radius));
                    (out[a], out[b], out[axis]) = (out_a, out_b, side * radius);
                    let normal = out.normalize();
                    let p = center + radius * normal;
                    mesh.positions.push(p);
                    mesh.normals.push(normal);
                    mesh.uvs.push(Vec2::new(p[along], p[across] + 0.37 * axis as f32));
                }
            }
            let index = |i: usize, j: usize| base + (j * lines_a.len() + i) as u32;
            for j in 0..lines_b.len() - 1 {
                for i in 0..lines_a.len() - 1 {
                    let quad = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
                    let [p, q, r, s] = if side > 0.0 { quad } else { [quad[0], quad[3], quad[2], quad[1]] };
                    mesh.triangles.extend([[p, q, r], [p, r, s]]);
                }
            }
        }
    }
    mesh
}
