//! Analytic shapes as meshes, as Mitsuba defines them. Texture coordinates have v downward here.
//!
//! Round shapes are inscribed polygons of [`SEGMENTS`] sides: their area is 0.07 % below the true one, except for lamps.

use crate::mesh::area;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Sides of a full circle.
const SEGMENTS: u32 = 96;
/// Sides of a full circle of spheres that are lights.
const LAMP_SEGMENTS: u32 = 24;

/// [−1,1]² in the plane z = 0, facing +z.
pub(crate) fn rectangle() -> Mesh {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    Mesh {
        positions: corners.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec(),
        normals: vec![Vec3::Z; 4],
        uvs: corners.map(|(x, y)| Vec2::new(0.5 * (x + 1.0), 0.5 * (y + 1.0))).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

/// The unit disk in the plane z = 0, facing +z; u is the radius, v the angle.
pub(crate) fn disk() -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..=SEGMENTS {
        let v = i as f32 / SEGMENTS as f32;
        let (sin, cos) = (v * TAU).sin_cos();
        mesh.positions.extend([Vec3::ZERO, Vec3::new(cos, sin, 0.0)]);
        mesh.uvs.extend([Vec2::new(0.0, v), Vec2::new(1.0, v)]);
    }
    mesh.normals = vec![Vec3::Z; mesh.positions.len()];
    mesh.triangles = (0..SEGMENTS).map(|i| [2 * i, 2 * i + 1, 2 * i + 3]).collect();
    mesh
}

/// The unit sphere around the origin; u is the azimuth about z, v the angle from +z.
pub(crate) fn sphere() -> Mesh {
    sphere_of(SEGMENTS)
}

/// The unit sphere as a light: of few triangles, each of which is a light to choose from, and with the area and so the power of the true one.
pub(crate) fn lamp() -> Mesh {
    let mut mesh = sphere_of(LAMP_SEGMENTS);
    let grown = (4.0 * std::f64::consts::PI / area(&mesh, DAffine3::IDENTITY)).sqrt() as f32;
    mesh.positions.iter_mut().for_each(|p| *p *= grown);
    mesh
}

fn sphere_of(segments: u32) -> Mesh {
    let rings = segments / 2;
    let mut mesh = Mesh::default();
    for j in 0..=rings {
        for i in 0..=segments {
            let uv = Vec2::new(i as f32 / segments as f32, j as f32 / rings as f32);
            let ((sin_phi, cos_phi), (sin_theta, cos_theta)) = ((uv.x * TAU).sin_cos(), (uv.y * PI).sin_cos());
            mesh.positions.push(Vec3::new(cos_phi * sin_theta, sin_phi * sin_theta, cos_theta));
            mesh.uvs.push(uv);
        }
    }
    mesh.normals = mesh.positions.clone();
    mesh.triangles = bands(rings, segments);
    mesh
}

/// Triangles between rows of `segments` + 1 vertices each, from a pole to a pole, where one of two triangles has no area.
pub(crate) fn bands(count: u32, segments: u32) -> Vec<[u32; 3]> {
    let row = segments + 1;
    let mut triangles = Vec::new();
    for (band, i) in (0..count).flat_map(|band| (0..segments).map(move |i| (band, i))) {
        let (above, below) = (band * row + i, (band + 1) * row + i);
        if band > 0 {
            triangles.push([above, below + 1, above + 1]);
        }
        if band + 1 < count {
            triangles.push([above, below, below + 1]);
        }
    }
    triangles
}

/// The open cylinder of radius 1 about the z axis from z = 0 to z = 1, facing outward.
pub(crate) fn cylinder() -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..=SEGMENTS {
        let u = i as f32 / SEGMENTS as f32;
        let (sin, cos) = (u * TAU).sin_cos();
        mesh.positions.extend([Vec3::new(cos, sin, 0.0), Vec3::new(cos, sin, 1.0)]);
        mesh.normals.extend([Vec3::new(cos, sin, 0.0); 2]);
        mesh.uvs.extend([Vec2::new(u, 0.0), Vec2::new(u, 1.0)]);
    }
    mesh.triangles = (0..SEGMENTS).flat_map(|i| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]]).collect();
    mesh
}

/// [−1,1]³ with the whole of texture space on each face.
pub(crate) fn cube() -> Mesh {
    // From the corner of u = 0, v = 1 on, counter-clockwise: by the bits of x, y and z, where 1 means +1.
    const FACES: [[u8; 4]; 6] = [[1, 5, 4, 0], [3, 2, 6, 7], [1, 3, 7, 5], [5, 7, 6, 4], [4, 6, 2, 0], [3, 1, 0, 2]];
    const UVS: [Vec2; 4] = [Vec2::new(0.0, 1.0), Vec2::new(1.0, 1.0), Vec2::new(1.0, 0.0), Vec2::new(0.0, 0.0)];
    let mut mesh = Mesh::default();
    for face in FACES {
        let corners = face.map(|corner| Vec3::from([1, 2, 4].map(|bit| if corner & bit == 0 { -1.0 } else { 1.0 })));
        let base = mesh.positions.len() as u32;
        mesh.positions.extend(corners);
        // The middle of the face.
        mesh.normals.extend([0.5 * (corners[0] + corners[2]); 4]);
        mesh.uvs.extend(UVS);
        mesh.triangles.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
    }
    mesh
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Every face points where its normals do; together they have this area.
    pub(crate) fn assert_faces_and_area(name: &str, mesh: &Mesh, area: f32) {
        assert_eq!(mesh.validate(), Ok(()), "{name}");
        let mut sum = 0.0;
        for t in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(t);
            let face = 0.5 * (b - a).cross(c - a);
            let normal: Vec3 = mesh.triangles[t].iter().map(|&i| mesh.normals[i as usize]).sum();
            assert!(face.dot(normal) > 0.0, "{name} triangle {t}");
            sum += face.length();
        }
        assert!((sum / area - 1.0).abs() < 2e-3, "{name}: {sum} instead of {area}");
    }

    #[test]
    fn every_face_of_a_cube_is_upright_where_mitsubas_is() {
        let mesh = cube();
        // Where u = 0 and v = 1 (downward) is, and the ways of u and of v, for the faces of −y, +y, +x, +z, −x, −z.
        let expected = [
            ([1, -1, -1], Vec3::Z, Vec3::X),
            ([1, 1, -1], -Vec3::X, -Vec3::Z),
            ([1, -1, -1], Vec3::Y, -Vec3::Z),
            ([1, -1, 1], Vec3::Y, Vec3::X),
            ([-1, -1, 1], Vec3::Y, Vec3::Z),
            ([1, 1, -1], -Vec3::Y, Vec3::X),
        ];
        for (face, (corner, u, v)) in expected.into_iter().enumerate() {
            let at = |uv: Vec2| mesh.positions[(4 * face..4 * face + 4).find(|&i| mesh.uvs[i] == uv).unwrap()];
            let start = at(Vec2::Y);
            assert_eq!(start.to_array(), corner.map(|c: i8| f32::from(c)), "{face}");
            assert_eq!((at(Vec2::ONE) - start, start - at(Vec2::ZERO)), (2.0 * u, 2.0 * v), "{face}");
        }
    }

    #[test]
    fn shapes_have_their_area_and_face_along_their_normals() {
        let shapes = [("rectangle", rectangle(), 4.0), ("disk", disk(), PI), ("sphere", sphere(), 4.0 * PI), ("cube", cube(), 24.0)];
        for (name, mesh, area) in shapes.into_iter().chain([("cylinder", cylinder(), TAU)]) {
            assert_faces_and_area(name, &mesh, area);
        }
    }
}
