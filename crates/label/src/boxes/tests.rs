//! Boxes against brute force over random orientations, and against known shapes.

use super::*;
use enfilade_math::{DQuat, Rng};

fn random_turn(rng: &mut Rng) -> DMat3 {
    // Uniform over the rotations: Shoemake 1992.
    let [u, v, w] = [rng.next_f64(), rng.next_f64(), rng.next_f64()];
    let ((sv, cv), (sw, cw)) = ((std::f64::consts::TAU * v).sin_cos(), (std::f64::consts::TAU * w).sin_cos());
    DMat3::from_quat(DQuat::from_xyzw((1.0 - u).sqrt() * sv, (1.0 - u).sqrt() * cv, u.sqrt() * sw, u.sqrt() * cw))
}

/// The least volume over many random orientations.
fn brute_force(points: &[DVec3], tries: usize) -> f64 {
    let mut rng = Rng::new(11);
    let volume = |_| OrientedBox::around(points.iter().copied(), random_turn(&mut rng)).unwrap().volume();
    (0..tries).map(volume).fold(f64::INFINITY, f64::min)
}

/// Checks what must be true of every result.
fn assert_sound(points: &[DVec3]) -> InstanceBoxes {
    let boxes = boxes_around(points).unwrap();
    let reach = points.iter().map(|p| p.length()).fold(1.0, f64::max);
    for b in &boxes {
        let error = b.world_from_box.transpose() * b.world_from_box - DMat3::IDENTITY;
        assert!(error.to_cols_array().iter().all(|v| v.abs() < 1e-12), "{b:?}");
        assert!((b.world_from_box.determinant() - 1.0).abs() < 1e-12, "{b:?}");
        assert!(b.extents.min_element() >= 0.0);
        assert!(points.iter().all(|&p| b.distance_beyond(p) < 1e-12 * reach), "{b:?}");
    }
    let [axis_aligned, upright, free] = boxes;
    assert!(upright.extents.x >= upright.extents.y && upright.world_from_box.z_axis == DVec3::Z);
    assert!(free.extents.x >= free.extents.y && free.extents.y >= free.extents.z);
    assert!(size(&free) <= size(&upright) && size(&free) <= size(&axis_aligned), "{boxes:?}");
    boxes
}

fn corners_of(extents: DVec3, turn: DMat3) -> Vec<DVec3> {
    OrientedBox { center: DVec3::new(3.0, -2.0, 1.0), world_from_box: turn, extents }.corners().into()
}

#[test]
fn turned_boxes_are_found_exactly() {
    let mut rng = Rng::new(1);
    for _ in 0..40 {
        let extents = DVec3::new(2.0, 1.3, 0.2 + rng.next_f64());
        let [.., free] = assert_sound(&corners_of(extents, random_turn(&mut rng)));
        assert!((free.volume() / extents.element_product() - 1.0).abs() < 1e-9, "{free:?}");
    }
    let standing = corners_of(DVec3::new(2.0, 1.0, 3.0), DMat3::from_rotation_z(0.5));
    let [_, upright, _] = assert_sound(&standing);
    assert!((upright.extents - DVec3::new(2.0, 1.0, 3.0)).length() < 1e-12);
}

#[test]
fn random_rotations_find_nothing_smaller() {
    let mut rng = Rng::new(2);
    for count in [4, 5, 6, 8, 12, 30, 100] {
        let turn = random_turn(&mut rng);
        let stretched = |rng: &mut Rng| turn * (DVec3::new(rng.next_f64(), 0.6 * rng.next_f64(), 0.3 * rng.next_f64()));
        let points: Vec<DVec3> = (0..count).map(|_| stretched(&mut rng)).collect();
        let [.., free] = assert_sound(&points);
        let tried = brute_force(&points, 30_000);
        assert!(free.volume() <= tried, "{count} points: {} above {tried}", free.volume());
    }
}

#[test]
fn spheres_and_l_shapes_are_nearly_least() {
    let mut rng = Rng::new(3);
    let sphere: Vec<DVec3> = (0..20_000).map(|_| random_turn(&mut rng).x_axis).collect();
    let [.., free] = assert_sound(&sphere);
    assert!(free.volume() <= 8.0 && free.volume() <= brute_force(&sphere, 100), "{}", free.volume());
    let turn = random_turn(&mut rng);
    let long = corners_of(DVec3::new(3.0, 1.0, 1.0), DMat3::IDENTITY);
    let tall = corners_of(DVec3::new(1.0, 1.0, 2.0), DMat3::IDENTITY).into_iter().map(|p| p + DVec3::new(-1.0, 0.0, 1.5));
    let l: Vec<DVec3> = long.into_iter().chain(tall).map(|p| turn * p).collect();
    let [.., free] = assert_sound(&l);
    assert!(free.volume() <= 9.0 + 1e-9 && free.volume() <= brute_force(&l, 30_000), "{}", free.volume());
}

#[test]
fn planes_lines_and_points_have_flat_boxes() {
    let mut rng = Rng::new(4);
    for turn in [DMat3::IDENTITY, random_turn(&mut rng), random_turn(&mut rng)] {
        let [.., free] = assert_sound(&corners_of(DVec3::new(2.0, 1.0, 0.0), turn));
        assert!((free.extents - DVec3::new(2.0, 1.0, 0.0)).length() < 1e-6, "{free:?}");
        let [.., free] = assert_sound(&corners_of(DVec3::new(2.0, 0.0, 0.0), turn));
        assert!((free.extents - DVec3::new(2.0, 0.0, 0.0)).length() < 1e-6, "{free:?}");
    }
    let [.., free] = assert_sound(&[DVec3::new(1.0, 2.0, 3.0); 3]);
    assert_eq!((free.center, free.extents), (DVec3::new(1.0, 2.0, 3.0), DVec3::ZERO));
    assert_eq!(boxes_around(&[]), None);
}

#[test]
fn sides_point_toward_the_mean() {
    let mut points = corners_of(DVec3::new(2.0, 1.0, 0.5), DMat3::from_rotation_z(0.4));
    // Many corners at one end, as a finely meshed handle has.
    let heavy = points[0];
    points.extend([heavy; 20]);
    for b in &assert_sound(&points)[1..] {
        assert!(b.world_from_box.x_axis.dot(heavy - b.center) > 0.0);
    }
}

#[test]
fn instances_gather_their_parts_and_numbers_without_triangles_are_absent() {
    let scene = enfilade_testroom::scene();
    let label = |instance| enfilade_scene::PartLabel { semantic: 5, instance };
    let boxes = scene_boxes(&scene, &Labels { parts: vec![label(3), label(-1), label(3)] });
    assert_eq!(boxes.iter().map(Option::is_some).collect::<Vec<_>>(), [false, false, false, true]);
    assert_eq!(of_kind(&boxes[3].unwrap(), BoxKind::AxisAligned).extents, DVec3::new(1.0, 1.0, 0.0));
}

/// How much larger than the original's a box of least volume may be.
const ABOVE_ORIGINAL: f64 = 1e-6;

#[test]
fn the_boxes_of_a_real_house_are_the_originals_or_smaller() {
    let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
        return eprintln!("skipped: ENFILADE_SCENES is not set");
    };
    let golden = std::path::Path::new(&scenes).join("../golden");
    let Ok(mesh) = std::fs::read(golden.join("aws-house/mesh.npz")) else {
        return eprintln!("skipped: no golden results beside the scenes");
    };
    let mesh = enfilade_testkit::Npz::new(&mesh);
    let (vertices, faces, objects) = (mesh.f32("vertices"), mesh.i32("faces"), mesh.i32("oi"));
    let read = |name: &str| enfilade_dataset::hdf5::read_array(&golden.join(format!("boxes/{name}.hdf5"))).unwrap().values;
    let enfilade_dataset::Elements::I64(instances) = read("mesh_objects_sii") else { panic!("not int64") };
    let rows = |kind: BoxKind, what: &str| match read(&format!("metadata_semantic_instance_bounding_box_{}_{what}", kind.name())) {
        enfilade_dataset::Elements::F64(values) => values,
        other => panic!("{}", other.element().name()),
    };
    let mut points: Vec<Vec<DVec3>> = vec![Vec::new(); rows(BoxKind::AxisAligned, "extents").len() / 3];
    for (corners, &object) in faces.chunks_exact(3).zip(&objects) {
        let place = |&i: &i32| DVec3::from_array(std::array::from_fn(|c| f64::from(vertices[3 * i as usize + c])));
        points[instances[object as usize].max(0) as usize].extend(corners.iter().map(place));
    }
    points[0].clear();
    let ours: Vec<_> = points.iter().map(|points| boxes_around(points)).collect();
    let mut totals = [[0.0; 2]; 3];
    let (mut smallest, mut largest, mut sum) = (f64::INFINITY, 0.0f64, 0.0);
    for kind in BoxKind::ALL {
        let [extents, orientations, positions] = ["extents", "orientations", "positions"].map(|what| rows(kind, what));
        for (i, ours) in ours.iter().enumerate() {
            let theirs = DVec3::from_slice(&extents[3 * i..]);
            let Some(ours) = ours.as_ref().map(|boxes| of_kind(boxes, kind)) else {
                assert_eq!(theirs, DVec3::INFINITY, "instance {i}");
                continue;
            };
            totals[kind as usize][0] += ours.volume();
            totals[kind as usize][1] += theirs.element_product();
            if kind == BoxKind::ObjectAligned3d {
                let ratio = ours.volume() / theirs.element_product().max(1e-12);
                (smallest, largest, sum) = (smallest.min(ratio), largest.max(ratio), sum + ratio);
                let bound = theirs.element_product() * (1.0 + ABOVE_ORIGINAL) + 1e-9;
                assert!(ours.volume() <= bound, "instance {i}: {} m3, the original has {}", ours.volume(), theirs.element_product());
                continue;
            }
            assert!((ours.extents - theirs).abs().max_element() < 1e-9, "{} {i}: {} against {theirs}", kind.name(), ours.extents);
            assert!((ours.center - DVec3::from_slice(&positions[3 * i..])).length() < 1e-9, "{} {i}", kind.name());
            let turned = DMat3::from_cols_slice(&orientations[9 * i..]).transpose();
            let same = |a: DVec3, b: DVec3| (a - b).length() < 1e-6;
            let x = ours.world_from_box.x_axis;
            // Where the mean is in the middle, rounding chose the direction; where the rectangle is a square, the side too.
            let mean = points[i].iter().sum::<DVec3>() / points[i].len() as f64;
            let even = (mean - ours.center).dot(x).abs() < 1e-6;
            let square = (theirs.x - theirs.y).abs() < 1e-6;
            let agrees = same(x, turned.x_axis)
                || (even && same(-x, turned.x_axis))
                || (square && (same(x, turned.y_axis) || same(-x, turned.y_axis)));
            assert!(agrees, "{} {i}: {} against {turned}", kind.name(), ours.world_from_box);
        }
    }
    eprintln!("total volumes in m3, ours and the original's: {totals:?}");
    let mean = sum / ours.iter().flatten().count() as f64;
    eprintln!("ours over the original's, object_aligned_3d: mean {mean:.6}, {smallest:.6} to {largest:.6}");
}
