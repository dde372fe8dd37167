//! Simple meshes: the box and the sphere, closed and with outward faces, normals or flat shading, and texture coordinates.

use crate::Mesh;
use enfilade_math::{Vec2, Vec3};
use std::f32::consts::{PI, TAU};

impl Mesh {
    /// A box of this size about the origin: flat faces, each with the whole texture.
    pub fn cuboid(size: Vec3) -> Self {
        let mut mesh = Self::default();
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from);
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            for outward in [axis, -axis] {
                // The texture is upright on the sides, and has +y up on top and bottom.
                let up = if axis == Vec3::Z { Vec3::Y } else { Vec3::Z };
                let right = up.cross(outward);
                let first = mesh.positions.len() as u32;
                mesh.positions.extend(square.map(|uv| 0.5 * size * (outward + right * (2.0 * uv.x - 1.0) + up * (2.0 * uv.y - 1.0))));
                mesh.uvs.extend(square);
                mesh.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|t| t.map(|i| first + i)));
            }
        }
        mesh
    }

    /// A sphere about the origin, smoothly shaded, of `steps` columns (at least 3) and half as many rows. The texture goes round it once.
    pub fn sphere(radius: f32, steps: u32) -> Self {
        let (columns, rows) = (steps.max(3), (steps / 2).max(2));
        let mut mesh = Self::default();
        for row in 0..=rows {
            for column in 0..=columns {
                let uv = Vec2::new(column as f32 / columns as f32, row as f32 / rows as f32);
                // The last column is the first one again, and the poles are points, to the last bit.
                let (sin, cos) = if column == columns { (0.0, 1.0) } else { (TAU * uv.x).sin_cos() };
                let pole = row == 0 || row == rows;
                let (across, up) = if pole { (0.0, if row == 0 { -1.0 } else { 1.0 }) } else { ((PI * uv.y).sin(), -(PI * uv.y).cos()) };
                let normal = Vec3::new(across * cos, across * sin, up);
                mesh.positions.push(radius * normal);
                mesh.normals.push(normal);
                mesh.uvs.push(uv);
            }
        }
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
            let a = row * (columns + 1) + column;
            let b = a + columns + 1;
            if row > 0 {
                mesh.triangles.push([a, a + 1, b + 1]);
            }
            if row + 1 < rows {
                mesh.triangles.push([a, b + 1, b]);
            }
        }
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the divergence theorem.
    fn volume(mesh: &Mesh) -> f64 {
        let corners = (0..mesh.triangles.len()).map(|t| mesh.corners(t).map(|p| p.as_dvec3()));
        corners.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
    }

    #[test]
    fn boxes_and_spheres_enclose_their_volume_with_faces_outward() {
        let cuboid = Mesh::cuboid(Vec3::new(1.0, 2.0, 3.0));
        assert_eq!((cuboid.validate(), cuboid.triangles.len(), cuboid.bounds().extent()), (Ok(()), 12, Vec3::new(1.0, 2.0, 3.0)));
        assert!((volume(&cuboid) - 6.0).abs() < 1e-9, "{}", volume(&cuboid));
        let sphere = Mesh::sphere(0.5, 64);
        assert_eq!(sphere.validate(), Ok(()));
        let round = 4.0 / 3.0 * std::f64::consts::PI * 0.125;
        assert!((0.99..1.0).contains(&(volume(&sphere) / round)), "{}", volume(&sphere) / round);
        assert!(sphere.positions.iter().all(|p| (p.length() - 0.5).abs() < 1e-6));
        assert_eq!(Mesh::sphere(1.0, 0).validate(), Ok(()));
    }
}
