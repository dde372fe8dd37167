//! Parametric meshes: bevelled boxes, turned profiles, tubes, frames and cloth.
//!
//! Every shape is in metres, its texture coordinates too, so that one woven or grained picture fits everything at its true
//! size. Closed shapes have outward winding. Shapes whose curvature is known carry exact normals; the others get theirs from
//! [`Reshape::smoothed`].

mod boxes;
mod cloth;
mod edit;
mod frame;
mod lathe;
mod tube;

pub use boxes::{bendable_box, bevelled_box, padded_box, rounded_box};
pub use cloth::{curtain, leaf, pillow};
pub use edit::Reshape;
pub use frame::{Top, picture_frame, slab_below, slab_with_openings};
pub use lathe::{curve, disk, lathe, sphere, spline};
pub use tube::{rounded_loop, tube};

use enfilade_geometry::Mesh;
use enfilade_math::{Vec2, Vec3};

/// A sheet of `nu` × `nv` quads over vertices numbered 0..=nu, 0..=nv, without normals. It faces where its u direction cross
/// its v direction points; quads that collapse to a line or a point (poles) lose their empty triangles.
pub fn grid(nu: usize, nv: usize, position: impl Fn(usize, usize) -> Vec3, uv: impl Fn(usize, usize) -> Vec2) -> Mesh {
    grid_by([nu, nv], &position, &uv)
}

/// Compiled once, not for every shape.
fn grid_by([nu, nv]: [usize; 2], position: &dyn Fn(usize, usize) -> Vec3, uv: &dyn Fn(usize, usize) -> Vec2) -> Mesh {
    let mut mesh = Mesh::default();
    for j in 0..=nv {
        for i in 0..=nu {
            mesh.positions.push(position(i, j));
            mesh.uvs.push(uv(i, j));
        }
    }
    let index = |i: usize, j: usize| (j * (nu + 1) + i) as u32;
    for j in 0..nv {
        for i in 0..nu {
            let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
            for t in [[a, b, c], [a, c, d]] {
                let [p, q, r] = t.map(|i| mesh.positions[i as usize]);
                if p != q && q != r && r != p {
                    mesh.triangles.push(t);
                }
            }
        }
    }
    mesh
}

/// Volume of a closed mesh in cubic metres: positive when the winding is outward.
#[cfg(test)]
pub(crate) fn volume(mesh: &Mesh) -> f32 {
    let cone = |t| {
        let [a, b, c] = mesh.corners(t);
        a.dot(b.cross(c)) / 6.0
    };
    (0..mesh.triangles.len()).map(cone).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_shapes_face_outward() {
        let vase = [[0.0, 0.0], [0.1, 0.0], [0.1, 0.3], [0.09, 0.3], [0.09, 0.01], [0.0, 0.01]].map(Vec2::from_array);
        let path = [Vec3::ZERO, Vec3::new(0.0, 0.1, 0.2), Vec3::new(0.3, 0.1, 0.4)];
        // 1.5 m at one end, level at 2.5 m from 1 m on.
        let gable = Top { height: |p: Vec2| (p.x + 3.5).min(2.5), bends: vec![-1.0] };
        let shapes = [
            ("bevelled box", bevelled_box(Vec3::new(0.4, 0.3, 0.2), 0.01), 0.4 * 0.3 * 0.2),
            ("rounded box", rounded_box(Vec3::new(0.4, 0.3, 0.2), 0.02, 3), 0.4 * 0.3 * 0.2),
            ("sphere", sphere(0.5, 48), std::f32::consts::FRAC_PI_6),
            ("vase", lathe(&vase, 64), 0.003_14 * 3.0 - 0.008_1 * std::f32::consts::PI * 0.29),
            ("tube", tube(&path, 0.02, 24), 0.001_257 * (0.2236 + 0.3606)),
            ("picture frame", picture_frame(0.8, 0.6, &[[0.0, 0.0], [0.0, 0.02], [0.05, 0.02], [0.05, 0.0]]), 0.05 * 0.02 * 2.6),
            ("slab", slab_with_openings(4.0, [0.0, 2.5], 0.3, &[[-1.0, 1.0, 0.8, 2.2]]), 0.3 * (10.0 - 2.8)),
            ("gable", slab_below(4.0, [0.0, 3.0], 0.3, &[[0.0, 1.0, 0.8, 2.2]], &gable), 0.3 * (10.0 - 0.5 - 1.4)),
        ];
        for (name, mesh, expected) in shapes {
            assert_eq!(mesh.validate(), Ok(()), "{name}");
            let found = volume(&mesh);
            assert!((found - expected).abs() < 0.1 * expected, "{name}: {found} instead of {expected}");
            let outward = (0..mesh.triangles.len()).all(|t| {
                let [a, b, c] = mesh.corners(t);
                let n = (b - a).cross(c - a);
                mesh.normals.is_empty() || mesh.triangles[t].iter().all(|&i| mesh.normals[i as usize].dot(n) > -1e-9)
            });
            assert!(outward, "{name}: a shading normal points inward");
        }
    }

    #[test]
    fn texture_coordinates_are_metres() {
        let mesh = bevelled_box(Vec3::new(2.0, 0.5, 0.1), 0.002);
        let span = mesh.uvs.iter().fold((f32::MAX, f32::MIN), |(low, high), uv| (low.min(uv.x), high.max(uv.x)));
        assert!((span.1 - span.0 - 2.0).abs() < 0.01, "the grain runs along the longest edge: {span:?}");
    }
}
