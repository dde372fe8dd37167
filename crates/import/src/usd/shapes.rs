//! The intrinsic shapes: cubes, spheres, cylinders, cones, capsules and planes as meshes.
//!
//! Round shapes are surfaces of revolution with [`SEGMENTS`] sides, spheres that are lights with [`LAMP_SEGMENTS`]. Texture coordinates go round once along u and along the outline
//! in v: USD defines none for them.

use super::stage::Prim;
use crate::mesh::area;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Sides of a full circle.
const SEGMENTS: u32 = 96;
/// Sides of a full circle of spheres that are lights: each triangle is a light of its own to choose from.
const LAMP_SEGMENTS: u32 = 24;

/// The mesh of a prim of a shape's type; `None` for other types.
pub(super) fn mesh(prim: &Prim) -> Option<Mesh> {
    let number = |name: &str, default: f32| prim.number(name).map_or(default, |v| v as f32);
    let radius = number("radius", 1.0);
    let axis = prim.text("axis").unwrap_or("Z").to_string();
    let mesh = match prim.kind() {
        "Cube" => return Some(cuboid(0.5 * number("size", 2.0))),
        "Sphere" => return Some(sphere(radius)),
        "Plane" => plane(number("width", 2.0), number("length", 2.0)),
        "Cylinder" => cylinder(radius, radius, number("height", 2.0)),
        "Cylinder_1" => cylinder(number("radiusBottom", 1.0), number("radiusTop", 1.0), number("height", 2.0)),
        "Cone" => cylinder(radius, 0.0, number("height", 2.0)),
        "Capsule" => capsule(number("radius", 0.5), number("radius", 0.5), number("height", 1.0)),
        "Capsule_1" => capsule(number("radiusBottom", 0.5), number("radiusTop", 0.5), number("height", 1.0)),
        _ => return None,
    };
    Some(turned_to(mesh, &axis))
}

/// A mesh along z turned to another axis, by a cyclic permutation of coordinates.
fn turned_to(mut mesh: Mesh, axis: &str) -> Mesh {
    let turn = |v: Vec3| match axis {
        "X" => Vec3::new(v.z, v.x, v.y),
        "Y" => Vec3::new(v.y, v.z, v.x),
        _ => v,
    };
    mesh.positions.iter_mut().chain(&mut mesh.normals).for_each(|v| *v = turn(*v));
    mesh
}

/// A rectangle about the origin that faces +z.
pub(super) fn plane(width: f32, length: f32) -> Mesh {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    Mesh {
        positions: corners.map(|(u, v)| Vec3::new((u - 0.5) * width, (v - 0.5) * length, 0.0)).to_vec(),
        normals: vec![Vec3::Z; 4],
        uvs: corners.map(|(u, v)| Vec2::new(u, v)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

fn cuboid(half: f32) -> Mesh {
    let mut mesh = Mesh::default();
    for normal in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
        let up = if normal.z == 0.0 { Vec3::Z } else { Vec3::Y };
        let right = up.cross(normal);
        let mut side = plane(2.0, 2.0);
        side.positions.iter_mut().for_each(|p| *p = half * (normal + right * p.x + up * p.y));
        side.normals = vec![normal; 4];
        mesh.append(&side);
    }
    mesh
}

/// A sphere about the origin.
pub(super) fn sphere(radius: f32) -> Mesh {
    let outline = arc(-0.5 * PI, 0.5 * PI, radius, 0.0, 48);
    revolution(&[outline])
}

/// A sphere of few triangles about the origin, with the area of the true one: it has the light's power, and from all sides together shows
/// as much of it.
pub(super) fn lamp(radius: f32) -> Mesh {
    let outline = arc(-0.5 * PI, 0.5 * PI, 1.0, 0.0, LAMP_SEGMENTS / 2);
    let mut mesh = revolution_of(&[outline], LAMP_SEGMENTS);
    let grown = (4.0 * std::f64::consts::PI / area(&mesh, DAffine3::IDENTITY)).sqrt() as f32;
    mesh.positions.iter_mut().for_each(|p| *p *= radius * grown);
    mesh
}

/// A disk that faces +z.
pub(super) fn disk(radius: f32) -> Mesh {
    revolution(&[vec![flat(radius, 0.0, Vec2::Y), flat(0.0, 0.0, Vec2::Y)]])
}

/// The lateral surface of a cylinder along z, centred.
pub(super) fn tube(radius: f32, height: f32) -> Mesh {
    revolution(&[vec![flat(radius, -0.5 * height, Vec2::X), flat(radius, 0.5 * height, Vec2::X)]])
}

/// A tube along x, like light tubes.
pub(super) fn tube_along_x(radius: f32, length: f32) -> Mesh {
    turned_to(tube(radius, length), "X")
}

fn cylinder(bottom: f32, top: f32, height: f32) -> Mesh {
    let half = 0.5 * height;
    let slope = Vec2::new(height, bottom - top).normalize_or(Vec2::X);
    revolution(&[
        vec![flat(0.0, -half, Vec2::NEG_Y), flat(bottom, -half, Vec2::NEG_Y)],
        vec![flat(bottom, -half, slope), flat(top, half, slope)],
        vec![flat(top, half, Vec2::Y), flat(0.0, half, Vec2::Y)],
    ])
}

fn capsule(bottom: f32, top: f32, height: f32) -> Mesh {
    let half = 0.5 * height;
    let slope = Vec2::new(height, bottom - top).normalize_or(Vec2::X);
    revolution(&[
        arc(-0.5 * PI, 0.0, bottom, -half, 24),
        vec![flat(bottom, -half, slope), flat(top, half, slope)],
        arc(0.0, 0.5 * PI, top, half, 24),
    ])
}

/// A point of an outline: distance from the axis, height, and the normal in that plane.
type Outline = (f32, f32, Vec2);

fn flat(radius: f32, z: f32, normal: Vec2) -> Outline {
    (radius, z, normal)
}

/// Part of a circle, by elevations.
fn arc(from: f32, to: f32, radius: f32, z: f32, steps: u32) -> Vec<Outline> {
    let point = |i: u32| {
        let (sin, cos) = (from + (to - from) * i as f32 / steps as f32).sin_cos();
        // Exactly on the axis at the poles.
        let cos = if cos.abs() < 1e-6 { 0.0 } else { cos };
        (radius * cos, z + radius * sin, Vec2::new(cos, sin))
    };
    (0..=steps).map(point).collect()
}

/// Outlines, from the bottom up, turned about the z axis.
fn revolution(outlines: &[Vec<Outline>]) -> Mesh {
    revolution_of(outlines, SEGMENTS)
}

fn revolution_of(outlines: &[Vec<Outline>], segments: u32) -> Mesh {
    let rows: usize = outlines.iter().map(Vec::len).sum();
    let mut mesh = Mesh::default();
    let mut row = 0;
    for outline in outlines {
        for (i, &(radius, z, normal)) in outline.iter().enumerate() {
            let base = mesh.positions.len() as u32;
            for k in 0..=segments {
                let u = k as f32 / segments as f32;
                // The seam closes exactly.
                let (sin, cos) = ((k % segments) as f32 / segments as f32 * TAU).sin_cos();
                mesh.positions.push(Vec3::new(radius * cos, radius * sin, z));
                mesh.normals.push(Vec3::new(normal.x * cos, normal.x * sin, normal.y));
                mesh.uvs.push(Vec2::new(u, row as f32 / (rows - 1) as f32));
            }
            if i > 0 {
                let below = base - segments - 1;
                for k in 0..segments {
                    // On the axis one of both triangles has no area.
                    if outline[i - 1].0 > 0.0 {
                        mesh.triangles.push([below + k, below + k + 1, base + k + 1]);
                    }
                    if radius > 0.0 {
                        mesh.triangles.push([below + k, base + k + 1, base + k]);
                    }
                }
            }
            row += 1;
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitives::tests::assert_faces_and_area;

    #[test]
    fn shapes_have_their_area_and_face_along_their_normals() {
        let shapes = [
            ("plane", plane(2.0, 3.0), 6.0),
            ("cube", cuboid(1.0), 24.0),
            ("sphere", sphere(2.0), 16.0 * PI),
            ("lamp", lamp(2.0), 16.0 * PI),
            ("disk", disk(1.0), PI),
            ("tube", tube_along_x(1.0, 3.0), 6.0 * PI),
            ("cylinder", cylinder(1.0, 1.0, 2.0), 6.0 * PI),
            ("cone", cylinder(3.0, 0.0, 4.0), PI * 3.0 * (3.0 + 5.0)),
            ("capsule", turned_to(capsule(0.5, 0.5, 1.0), "Y"), 2.0 * PI),
        ];
        for (name, mesh, area) in shapes {
            assert_faces_and_area(name, &mesh, area);
        }
    }
}
