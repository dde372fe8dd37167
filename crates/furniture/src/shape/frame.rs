//! Shapes around a hole: mitred picture frames, and walls with openings for doors and windows.

use super::Reshape;
use enfilade_geometry::Mesh;
use enfilade_math::{Vec2, Vec3};

/// A mitred frame around a `width` × `height` rectangle in the xz plane, centred on the origin.
///
/// The section is a closed loop of (inset from the outer edge, y) points in either direction.
pub fn picture_frame(width: f32, height: f32, section: &[[f32; 2]]) -> Mesh {
    let corners = [[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]];
    let at = |corner: usize, point: usize| {
        let [sx, sz] = corners[corner % 4];
        let [inset, y] = section[point % section.len()];
        Vec3::new(sx * (0.5 * width - inset), y, sz * (0.5 * height - inset))
    };
    let twice_area: f32 =
        (0..section.len()).map(|i| Vec2::from_array(section[i]).perp_dot(Vec2::from_array(section[(i + 1) % section.len()]))).sum();
    let mut mesh = Mesh::default();
    for corner in 0..4 {
        let mut across = 0.0;
        for i in 0..section.len() {
            let quad = [at(corner, i), at(corner, i + 1), at(corner + 1, i + 1), at(corner + 1, i)];
            let along = |p: Vec3| if corner % 2 == 0 { p.z } else { p.x };
            let step = Vec2::from_array(section[i]).distance(Vec2::from_array(section[(i + 1) % section.len()]));
            let v = [across, across + step, across + step, across];
            across += step;
            let uvs = std::array::from_fn(|k| Vec2::new(along(quad[k]), v[k] + 0.23 * corner as f32));
            push_quad(&mut mesh, quad, uvs, twice_area < 0.0);
        }
    }
    mesh.smoothed(20.0)
}

/// A wall in its own space: x along it from −`length`/2 to `length`/2, its inner face at y = 0, its outer at −`thickness`, z over
/// `height`; with openings [x0, x1, z0, z1] that go through. Openings must not overlap; one that reaches `height[0]` is a door.
pub fn slab_with_openings(length: f32, height: [f32; 2], thickness: f32, openings: &[[f32; 4]]) -> Mesh {
    slab_below(length, height, thickness, openings, &Top { height: |_| f32::INFINITY, bends: Vec::new() })
}

/// The upper end of a wall that is not level: under a roof.
pub struct Top<F: Fn(Vec2) -> f32> {
    /// Height over a point (x, y) of the wall's space; linear between the `bends`, and above all openings.
    pub height: F,
    /// Where it bends, along x.
    pub bends: Vec<f32>,
}

/// A wall as [`slab_with_openings`] makes it, which ends below `top`.
pub fn slab_below<F: Fn(Vec2) -> f32>(length: f32, height: [f32; 2], thickness: f32, openings: &[[f32; 4]], top: &Top<F>) -> Mesh {
    let cuts = |ends: [f32; 2], of: [usize; 2]| {
        let bends: &[f32] = if of[0] == 0 { &top.bends } else { &[] };
        let inner = openings.iter().flat_map(|o| of.map(|k| o[k])).chain(bends.iter().copied()).filter(|&c| c > ends[0] && c < ends[1]);
        let mut all: Vec<f32> = ends.into_iter().chain(inner).collect();
        all.sort_by(f32::total_cmp);
        all.dedup();
        all
    };
    let xs = cuts([-0.5 * length, 0.5 * length], [0, 1]);
    let zs = cuts(height, [2, 3]);
    let solid = |i: isize, j: isize| {
        if i < 0 || j < 0 || i as usize + 1 >= xs.len() || j as usize + 1 >= zs.len() {
            return false;
        }
        let (x, z) = (0.5 * (xs[i as usize] + xs[i as usize + 1]), 0.5 * (zs[j as usize] + zs[j as usize + 1]));
        !openings.iter().any(|o| x > o[0] && x < o[1] && z > o[2] && z < o[3])
    };
    let mut mesh = Mesh::default();
    for j in 0..zs.len() - 1 {
        for i in 0..xs.len() - 1 {
            if !solid(i as isize, j as isize) {
                continue;
            }
            let (x0, x1, z0, z1) = (xs[i], xs[i + 1], zs[j], zs[j + 1]);
            let p = |x: f32, back: bool, z: f32| {
                let y = if back { -thickness } else { 0.0 };
                Vec3::new(x, y, z.min((top.height)(Vec2::new(x, y))))
            };
            let mut face = |quad: [Vec3; 4], uv: fn(Vec3) -> Vec2| push_quad(&mut mesh, quad, quad.map(uv), false);
            face([p(x0, false, z0), p(x0, false, z1), p(x1, false, z1), p(x1, false, z0)], |q| Vec2::new(q.x, q.z));
            face([p(x0, true, z0), p(x1, true, z0), p(x1, true, z1), p(x0, true, z1)], |q| Vec2::new(q.x, q.z));
            if !solid(i as isize - 1, j as isize) {
                face([p(x0, false, z0), p(x0, true, z0), p(x0, true, z1), p(x0, false, z1)], |q| Vec2::new(q.y, q.z));
            }
            if !solid(i as isize + 1, j as isize) {
                face([p(x1, false, z0), p(x1, false, z1), p(x1, true, z1), p(x1, true, z0)], |q| Vec2::new(q.y, q.z));
            }
            if !solid(i as isize, j as isize - 1) {
                face([p(x0, false, z0), p(x1, false, z0), p(x1, true, z0), p(x0, true, z0)], |q| Vec2::new(q.x, q.y));
            }
            if !solid(i as isize, j as isize + 1) {
                face([p(x0, false, z1), p(x0, true, z1), p(x1, true, z1), p(x1, false, z1)], |q| Vec2::new(q.x, q.y));
            }
        }
    }
    // What is above the top has no height left.
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        (b - a).cross(c - a).length()
    };
    let kept: Vec<[u32; 3]> = mesh.triangles.iter().copied().filter(|t| area(t) > 0.0).collect();
    mesh.triangles = kept;
    mesh.smoothed(20.0)
}

fn push_quad(mesh: &mut Mesh, quad: [Vec3; 4], uvs: [Vec2; 4], flipped: bool) {
    let base = mesh.positions.len() as u32;
    mesh.positions.extend(quad);
    mesh.uvs.extend(uvs);
    for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
        mesh.triangles.push(if flipped { [base + a, base + c, base + b] } else { [base + a, base + b, base + c] });
    }
}
