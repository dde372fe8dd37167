//! Meshes of geoms: primitives, and texture coordinates of those that have none.

use super::pictures::Layout;
use crate::primitives;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Sides of a full circle, and rings of half a sphere, of capsules.
const SEGMENTS: u32 = 96;
const RINGS: u32 = 24;
/// Half the side of a plane without one, metres.
pub(super) const ENDLESS_M: f64 = 10.0;

/// The form of a geom, in its own axes; lengths in metres.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Form {
    /// In the plane z = 0, facing +z, by half its sides.
    Plane([f64; 2]),
    /// By half its sides.
    Box(DVec3),
    /// By its half axes; spheres too.
    Ellipsoid(DVec3),
    /// Along z.
    Cylinder { radius: f64, half: f64 },
    /// Along z; `half` of the straight piece.
    Capsule { radius: f64, half: f64 },
    /// By its name among the assets.
    Mesh(String),
}

impl Form {
    /// The name of its mesh, which all forms of this name share.
    pub(super) fn key(&self) -> String {
        match self {
            Self::Plane(_) => "<plane>".into(),
            Self::Box(_) => "<box>".into(),
            Self::Ellipsoid(_) => "<ellipsoid>".into(),
            Self::Cylinder { .. } => "<cylinder>".into(),
            Self::Capsule { radius, half } => format!("<capsule {}>", half / radius),
            Self::Mesh(name) => name.clone(),
        }
    }

    /// Half the sides of the box around it, but for meshes.
    pub(super) fn half(&self) -> DVec3 {
        match *self {
            Self::Plane([x, y]) => DVec3::new(x, y, 1.0),
            Self::Box(half) | Self::Ellipsoid(half) => half,
            Self::Cylinder { radius, half } => DVec3::new(radius, radius, half),
            Self::Capsule { radius, half } => DVec3::new(radius, radius, radius + half),
            Self::Mesh(_) => DVec3::ONE,
        }
    }

    /// The mesh of its kind, which [`Form::scale`] gives its size; none of a mesh among the assets.
    pub(super) fn mesh(&self) -> Mesh {
        match self {
            Self::Plane(_) => primitives::rectangle(),
            Self::Box(_) => primitives::cube(),
            Self::Ellipsoid(_) => primitives::sphere(),
            Self::Cylinder { .. } => cylinder(),
            Self::Capsule { radius, half } => capsule((half / radius) as f32),
            Self::Mesh(_) => Mesh::default(),
        }
    }

    /// The scale of its mesh.
    pub(super) fn scale(&self) -> DVec3 {
        if let Self::Capsule { radius, .. } = self { DVec3::splat(*radius) } else { self.half() }
    }
}

/// The closed cylinder of radius 1 from z = −1 to z = 1.
fn cylinder() -> Mesh {
    let turned = DAffine3::from_rotation_x(std::f64::consts::PI);
    let place = |scale: f64, z: f64| DAffine3::from_translation(DVec3::Z * z) * DAffine3::from_scale(DVec3::new(1.0, 1.0, scale));
    joined(&[
        (primitives::cylinder(), place(2.0, -1.0)),
        (primitives::disk(), place(1.0, 1.0)),
        (primitives::disk(), place(1.0, -1.0) * turned),
    ])
}

/// The capsule of radius 1 about the z axis, whose straight piece is from −`half` to `half`.
fn capsule(half: f32) -> Mesh {
    let mut mesh = Mesh::default();
    // The equator twice: at either end of the straight piece.
    let rings = (0..=RINGS).map(|ring| (ring, half)).chain((RINGS..=2 * RINGS).map(|ring| (ring, -half)));
    for (ring, z) in rings {
        let (sin_theta, cos_theta) = (ring as f32 / (2 * RINGS) as f32 * PI).sin_cos();
        for i in 0..=SEGMENTS {
            let (sin_phi, cos_phi) = (i as f32 / SEGMENTS as f32 * TAU).sin_cos();
            let normal = Vec3::new(cos_phi * sin_theta, sin_phi * sin_theta, cos_theta);
            mesh.normals.push(normal);
            mesh.positions.push(normal + Vec3::Z * z);
        }
    }
    mesh.triangles = primitives::bands(2 * RINGS + 1, SEGMENTS);
    mesh
}

fn joined(pieces: &[(Mesh, DAffine3)]) -> Mesh {
    let mut all = Mesh::default();
    for (mesh, place) in pieces {
        let base = all.positions.len() as u32;
        all.positions.extend(mesh.positions.iter().map(|p| place.transform_point3(p.as_dvec3()).as_vec3()));
        all.normals.extend(mesh.normals.iter().map(|n| place.transform_vector3(n.as_dvec3()).as_vec3().normalize_or_zero()));
        all.triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|corner| base + corner)));
    }
    all
}

/// A mesh with the texture coordinates that a layout calls for: x and y over the box around it, from −1 to 1, or those of the side
/// that a triangle faces, from 0 to 1 (a sixth of v for each where the sides differ).
pub(super) fn laid_out(mesh: &Mesh, layout: Layout) -> Mesh {
    let (low, high) = mesh.positions.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
    let (middle, half) = (0.5 * (low + high), (0.5 * (high - low)).max(Vec3::splat(1e-9)));
    let unit = |p: Vec3| (p - middle) / half;
    if layout == Layout::Flat {
        let uvs = mesh.positions.iter().map(|&p| unit(p).truncate()).collect();
        return Mesh { uvs, ..mesh.clone() };
    }
    let mut split = Mesh::default();
    for triangle in &mesh.triangles {
        let corners = triangle.map(|corner| mesh.positions[corner as usize]);
        let face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let side = side(face * half);
        let base = split.positions.len() as u32;
        split.positions.extend(corners);
        split.uvs.extend(corners.map(|p| on_side(unit(p), side, layout)));
        if !mesh.normals.is_empty() {
            split.normals.extend(triangle.map(|corner| mesh.normals[corner as usize]));
        }
        split.triangles.push([base, base + 1, base + 2]);
    }
    split
}

/// The side of a cube that a direction points to: +x, −x, +y, −y, +z, −z.
fn side(direction: Vec3) -> usize {
    let axis = direction.abs().max_position();
    2 * axis + usize::from(direction[axis] < 0.0)
}

/// The texture coordinates of a point of the cube from −1 to 1 on one of its sides, as in cubes of OpenGL: y is up on the sides of x
/// and z.
fn on_side(p: Vec3, side: usize, layout: Layout) -> Vec2 {
    let (u, v) = match side {
        0 => (-p.z, p.y),
        1 => (p.z, p.y),
        2 => (p.x, -p.z),
        3 => (p.x, p.z),
        4 => (p.x, p.y),
        _ => (-p.x, p.y),
    };
    let (u, v) = (0.5 * (u + 1.0), 0.5 * (v + 1.0));
    // The first side is the uppermost of six.
    Vec2::new(u, if layout == Layout::Sides { (5.0 - side as f32 + v.clamp(0.01, 0.99)) / 6.0 } else { v })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitives::tests::assert_faces_and_area;

    #[test]
    fn capsules_and_cylinders_are_closed_and_have_their_area() {
        let sphere = 4.0 * PI;
        for half in [0.0, 0.5, 3.0] {
            let mesh = capsule(half);
            // Without a straight piece its triangles have no area.
            if half > 0.0 {
                assert_faces_and_area("capsule", &mesh, sphere + TAU * 2.0 * half);
            }
            assert!(mesh.positions.iter().all(|p| p.z.abs() <= 1.0 + half));
        }
        assert_faces_and_area("cylinder", &cylinder(), TAU * 2.0 + TAU);
    }

    #[test]
    fn each_side_of_a_cube_shows_the_whole_picture() {
        let cube = laid_out(&primitives::cube(), Layout::Cube);
        for corners in cube.uvs.chunks_exact(6) {
            let span = corners.iter().fold((Vec2::ONE, Vec2::ZERO), |(low, high), uv| (low.min(*uv), high.max(*uv)));
            assert_eq!(span, (Vec2::ZERO, Vec2::ONE));
        }
        let sides = laid_out(&primitives::cube(), Layout::Sides);
        let rows: std::collections::BTreeSet<i32> = sides.uvs.iter().map(|uv| (uv.y * 6.0).floor() as i32).collect();
        assert_eq!(rows.into_iter().collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5]);
        let flat = laid_out(&primitives::rectangle(), Layout::Flat);
        assert_eq!(flat.uvs[2], Vec2::ONE);
    }
}
