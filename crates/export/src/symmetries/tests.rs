//! Shapes whose symmetries are known, turned and moved.

use super::*;
use std::f64::consts::{PI, TAU};

/// A solid of revolution about z through (radius, height), closed at both ends, of `n` sides.
fn turned(profile: &[[f64; 2]], n: u32) -> SurfaceMesh {
    let mut mesh = SurfaceMesh::default();
    for &[radius, z] in profile {
        let corner = |k: u32| {
            let angle = TAU * f64::from(k) / f64::from(n);
            DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
        };
        mesh.vertices.extend((0..n).map(corner));
    }
    for ring in 0..profile.len() as u32 - 1 {
        for k in 0..n {
            let [a, b] = [ring * n + k, ring * n + (k + 1) % n];
            mesh.faces.extend([[a, b, b + n], [a, b + n, a + n]]);
        }
    }
    for (first, z) in [(0, profile[0][1]), (mesh.vertices.len() as u32 - n, profile[profile.len() - 1][1])] {
        let middle = mesh.vertices.len() as u32;
        mesh.vertices.push(DVec3::new(0.0, 0.0, z));
        mesh.faces.extend((0..n).map(|k| [middle, first + k, first + (k + 1) % n]));
    }
    mesh
}

fn cuboid(size: DVec3) -> SurfaceMesh {
    let corner = |i: usize| DVec3::from_array(std::array::from_fn(|axis| if i >> axis & 1 == 0 { -0.5 } else { 0.5 })) * size;
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    SurfaceMesh { vertices: (0..8).map(corner).collect(), faces: quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect() }
}

fn join(mut a: SurfaceMesh, b: SurfaceMesh, by: DVec3) -> SurfaceMesh {
    let first = a.vertices.len() as u32;
    a.vertices.extend(b.vertices.iter().map(|v| *v + by));
    a.faces.extend(b.faces.iter().map(|face| face.map(|i| i + first)));
    a
}

fn found(mesh: &SurfaceMesh) -> Symmetries {
    let far = |a: &DVec3| mesh.vertices.iter().map(|b| a.distance(*b)).fold(0.0, f64::max);
    symmetries(mesh, mesh.vertices.iter().map(far).fold(0.0, f64::max), SymmetryRule::Shape)
}

/// Number of discrete rotations and continuous axes, of a shape as it is and turned and moved. The rotations form a group.
fn counts(mesh: SurfaceMesh) -> [usize; 2] {
    let here = found(&mesh);
    let (turn, by) = (DMat3::from_rotation_y(0.7) * DMat3::from_rotation_x(0.5), DVec3::new(0.3, -0.1, 0.2));
    let moved = SurfaceMesh { vertices: mesh.vertices.iter().map(|v| turn * *v + by).collect(), faces: mesh.faces };
    let there = found(&moved);
    for symmetries in [&here, &there] {
        let all = || symmetries.discrete.iter().copied().chain([DMat3::IDENTITY]);
        let has = |m: DMat3| all().any(|other| (other - m).to_cols_array().iter().all(|v| v.abs() < 1e-3));
        let closed = all().all(|a| all().all(|b| has(a * b)));
        assert!(closed || !symmetries.continuous.is_empty(), "no group: {:?}", symmetries.discrete);
    }
    let counts = |found: &Symmetries| [found.discrete.len(), found.continuous.len()];
    assert_eq!(counts(&here), counts(&there), "{here:?} {there:?}");
    assert!((turn * here.center + by - there.center).length() < 1e-9);
    if let ([a], [b]) = (&here.continuous[..], &there.continuous[..]) {
        assert!((turn * *a).dot(*b).abs() > 1.0 - 1e-6, "{a} {b}");
    }
    counts(&here)
}

#[test]
fn a_box_with_three_different_edges_has_three_half_turns() {
    let mesh = cuboid(DVec3::new(0.2, 0.12, 0.07));
    let half = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| DMat3::from_axis_angle(axis, PI));
    let here = found(&mesh).discrete;
    assert!(half.iter().all(|m| here.iter().any(|other| (*other - *m).to_cols_array().iter().all(|v| v.abs() < 1e-9))), "{here:?}");
    assert_eq!(counts(mesh), [3, 0]);
    // Edges that differ by a tenth are different; BOP's tolerance takes them for one, because the box is small.
    let small = cuboid(DVec3::new(0.1, 0.09, 0.06));
    assert_eq!(counts(cuboid(DVec3::new(0.1, 0.09, 0.06))), [3, 0]);
    assert_eq!(symmetries(&small, 0.147, SymmetryRule::Bop).discrete.len(), 7);
    assert_eq!(symmetries(&small, 0.147, SymmetryRule::None), Symmetries::default());
}

#[test]
fn prisms_cubes_and_tetrahedra_have_their_groups() {
    assert_eq!(counts(cuboid(DVec3::new(0.1, 0.1, 0.2))), [7, 0], "square prism");
    assert_eq!(counts(cuboid(DVec3::new(0.1, 0.1, 0.03))), [7, 0], "square tile");
    assert_eq!(counts(cuboid(DVec3::splat(0.1))), [23, 0], "cube");
    assert_eq!(counts(turned(&[[0.05, 0.0], [0.05, 0.12]], 3)), [5, 0], "triangular prism");
    assert_eq!(counts(turned(&[[0.05, 0.0], [0.05, 0.02]], 6)), [11, 0], "hexagonal tile");
    assert_eq!(counts(turned(&[[0.06, 0.0], [0.02, 0.12]], 4)), [3, 0], "square frustum");
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]].map(|c| 0.05 * DVec3::from(c));
    let faces = vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
    assert_eq!(counts(SurfaceMesh { vertices: corners.to_vec(), faces }), [11, 0], "tetrahedron");
}

#[test]
fn solids_of_revolution_have_an_axis_and_those_with_equal_ends_a_flip() {
    assert_eq!(counts(turned(&[[0.04, 0.0], [0.04, 0.15]], 48)), [1, 1], "cylinder");
    assert_eq!(counts(turned(&[[0.04, 0.0], [0.04, 0.07]], 48)), [1, 1], "cylinder with three moments alike");
    assert_eq!(counts(turned(&[[0.05, 0.0], [0.0, 0.12]], 48)), [0, 1], "cone");
    assert_eq!(counts(turned(&[[0.03, 0.0], [0.03, 0.01], [0.004, 0.02], [0.004, 0.1], [0.035, 0.13], [0.03, 0.18]], 48)), [0, 1], "glass");
    let ball: Vec<[f64; 2]> = (0..=24).map(|k| PI * f64::from(k) / 24.0).map(|a| [0.05 * a.sin(), -0.05 * a.cos()]).collect();
    let ball = found(&turned(&ball, 48));
    assert_eq!((ball.discrete.len(), ball.continuous.len()), (0, 3), "ball");
}

#[test]
fn a_handle_leaves_a_mug_without_symmetry() {
    let mug = turned(&[[0.04, 0.0], [0.04, 0.09]], 48);
    assert_eq!(counts(join(mug, cuboid(DVec3::new(0.03, 0.01, 0.05)), DVec3::new(0.05, 0.0, 0.05))), [0, 0]);
    assert_eq!(counts(join(cuboid(DVec3::new(0.2, 0.1, 0.05)), cuboid(DVec3::splat(0.05)), DVec3::new(0.06, 0.0, 0.05))), [0, 0]);
}

#[test]
fn a_point_or_nothing_has_none() {
    let point = SurfaceMesh { vertices: vec![DVec3::ONE; 3], faces: vec![[0, 1, 2]] };
    for mesh in [point, SurfaceMesh::default()] {
        assert_eq!(symmetries(&mesh, 0.0, SymmetryRule::Shape), Symmetries::default());
    }
}
