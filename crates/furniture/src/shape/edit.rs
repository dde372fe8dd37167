//! Changes to a finished mesh: moved, turned, deformed, joined with another, and with new normals up to a crease angle.

use enfilade_geometry::Mesh;
use enfilade_math::{Affine3A, Quat, Vec2, Vec3};
use std::collections::HashMap;

/// Changes to a finished shape, chained: `rounded_box(..).turned(..).moved(..)`.
pub trait Reshape: Sized {
    /// Shifted by `offset`.
    #[must_use]
    fn moved(self, offset: Vec3) -> Self;
    /// Rotated about the axis through the origin by `angle` radians.
    #[must_use]
    fn turned(self, axis: Vec3, angle: f32) -> Self;
    /// Every vertex moved to `f` of it; normals are dropped, so follow with [`Reshape::smoothed`].
    #[must_use]
    fn deformed(self, f: impl Fn(Vec3) -> Vec3) -> Self;
    /// New normals, averaged over faces that meet at an angle below `crease` degrees. Sharper edges stay sharp.
    #[must_use]
    fn smoothed(self, crease: f32) -> Self;
    /// Texture coordinates shifted by `offset`.
    #[must_use]
    fn uv_moved(self, offset: Vec2) -> Self;
    /// One mesh of this and the other.
    #[must_use]
    fn with(self, other: Self) -> Self;
}

impl Reshape for Mesh {
    fn moved(mut self, offset: Vec3) -> Self {
        self.positions.iter_mut().for_each(|p| *p += offset);
        self
    }

    fn turned(mut self, axis: Vec3, angle: f32) -> Self {
        let rotation = Affine3A::from_quat(Quat::from_axis_angle(axis, angle));
        self.positions.iter_mut().for_each(|p| *p = rotation.transform_point3(*p));
        self.normals.iter_mut().for_each(|n| *n = rotation.transform_vector3(*n).normalize());
        self
    }

    fn deformed(mut self, f: impl Fn(Vec3) -> Vec3) -> Self {
        self.positions.iter_mut().for_each(|p| *p = f(*p));
        self.normals.clear();
        self
    }

    fn smoothed(self, crease: f32) -> Self {
        let cos_crease = crease.to_radians().cos();
        let faces: Vec<Vec3> = (0..self.triangles.len())
            .map(|t| {
                let [a, b, c] = self.corners(t);
                (b - a).cross(c - a)
            })
            .collect();
        let key = |p: Vec3| p.to_array().map(|v| (v * 1e6).round() as i64);
        let mut around: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
        for (t, triangle) in self.triangles.iter().enumerate() {
            for &i in triangle {
                around.entry(key(self.positions[i as usize])).or_default().push(t);
            }
        }
        let mut mesh = Self::default();
        let mut known: HashMap<(u32, [i32; 3]), u32> = HashMap::new();
        for (t, triangle) in self.triangles.iter().enumerate() {
            let own = faces[t].normalize_or(Vec3::Z);
            let corners = triangle.map(|i| {
                let p = self.positions[i as usize];
                let sum: Vec3 = around[&key(p)].iter().map(|&f| faces[f]).filter(|f| f.normalize_or(Vec3::Z).dot(own) > cos_crease).sum();
                let normal = sum.normalize_or(own);
                *known.entry((i, normal.to_array().map(|v| (v * 4096.0).round() as i32))).or_insert_with(|| {
                    mesh.positions.push(p);
                    mesh.normals.push(normal);
                    if let Some(&uv) = self.uvs.get(i as usize) {
                        mesh.uvs.push(uv);
                    }
                    mesh.positions.len() as u32 - 1
                })
            });
            mesh.triangles.push(corners);
        }
        mesh
    }

    fn uv_moved(mut self, offset: Vec2) -> Self {
        self.uvs.iter_mut().for_each(|uv| *uv += offset);
        self
    }

    fn with(mut self, other: Self) -> Self {
        self.append(&other);
        self
    }
}
