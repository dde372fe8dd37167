//! The dataset of the analytic frame, and its contents beside frames.

use crate::{frame, intrinsics, labels, pose, scene, store};
use enfilade_dataset::{BoxKind, Covisibility, CovisibleFrame, Dataset, Fixture, FrameInfo, FramePair, FrameTime, HiddenBy};
use enfilade_dataset::{InstanceRelation, InstanceView, ManifestInfo, PartitionRow, RelationKind, Side, Surfaces, Tracks, write_json};
use enfilade_frame::{DENOISED, Frame, Layer, Pass, f16, vector};
use enfilade_geometry::{OccupancyTree, Voxel};
use enfilade_math::{DMat3, DVec2, DVec3, OrientedBox, Vec3};
use enfilade_scene::{Pose, RoomOutline, Rooms, Trajectory};

/// The fixtures that light the room.
pub fn fixtures() -> Vec<Fixture> {
    let fixture = |id, kind: &str, place: Option<Vec3>| Fixture {
        id,
        kind: kind.into(),
        name: kind.into(),
        intensity: place.map(|_| 1.0),
        position: place,
        node_ids: Vec::new(),
        lights: place.map(|_| "bulb".to_string()).into_iter().collect(),
    };
    vec![fixture(1, "sky", None), fixture(2, "lamp", Some(Vec3::new(0.0, 0.0, 2.4)))]
}

/// The mirror as the frame from `pose` shows it, all of it visible.
fn instance_views(pose: &Pose) -> Option<InstanceView> {
    let area = enfilade_label::instances::visible_areas(frame(pose).get(Layer::SemanticInstance)?, intrinsics().width).remove(&1)?;
    let (visible, full, inside_pixels) = (area, area, area.pixels);
    Some(InstanceView { frame: pose.frame, instance: 1, semantic: 19, visible, full, inside_pixels })
}

/// The plan report of a walk that begins at `first`.
fn plan_report(first: &Pose) -> serde_json::Value {
    let bounds = serde_json::json!({ "step_m": [1.5, 1.5, 0.25], "height_range_m": 0.25 });
    let (position, world_from_camera) = (first.position, first.world_from_camera);
    serde_json::json!({
        "trajectory": "cam_00",
        "mode": "walk",
        "roll_limit_deg": 5.0,
        "walk": { "position": bounds, "target": bounds },
        "start": {
            "name": "start", "position": position, "world_from_camera": world_from_camera, "is_kept": true, "looks_along_axis": true,
        },
    })
}

/// The covisibility of two frames: everything that is in the image, since nothing hides anything here.
fn covisibility(poses: [&Pose; 2]) -> Covisibility {
    let (k, frames) = (intrinsics(), poses.map(frame));
    let points = |i: usize| {
        let positions = frames[i].get(Layer::Position).unwrap();
        (0..frames[i].pixels()).map(|pixel| vector(positions, pixel)).filter(|p| p.is_finite()).collect::<Vec<_>>()
    };
    let share = |of: usize, by: usize| {
        let is_seen = |p: &&DVec3| {
            let p_camera = poses[by].world_from_camera.transpose() * (**p - poses[by].position);
            let (x, y) = k.project(p_camera);
            p_camera.z < 0.0 && (0.0..f64::from(k.width)).contains(&x) && (0.0..f64::from(k.height)).contains(&y)
        };
        let points = points(of);
        if of == by { 1.0 } else { (points.iter().filter(is_seen).count() as f64 / points.len() as f64) as f32 }
    };
    let listed = |i: usize| {
        let surface_pixels = points(i).len() as u32;
        CovisibleFrame { camera: "cam_00".into(), frame: poses[i].frame, grid_step_px: 1, surface_pixels }
    };
    let shares = vec![share(0, 0), share(0, 1), share(1, 0), share(1, 1)];
    Covisibility { frames: vec![listed(0), listed(1)], hidden_by: HiddenBy::Distances, shares }
}

/// Flow from one frame to another.
fn flow(from: &Pose, to: &Pose) -> Frame {
    let (k, shown) = (intrinsics(), frame(from));
    let positions = shown.get(Layer::Position).unwrap();
    let [mut image, mut moved, mut seen] = [const { Vec::new() }; 3];
    for pixel in 0..shown.pixels() {
        let p = vector(positions, pixel);
        let [before, after] = [from, to].map(|pose| pose.world_from_camera.transpose() * (p - pose.position));
        let (x, y) = k.project(after);
        let at = DVec2::new((pixel as u32 % k.width) as f64 + 0.5, (pixel as u32 / k.width) as f64 + 0.5);
        let inside = after.z < 0.0 && (0.0..f64::from(k.width)).contains(&x) && (0.0..f64::from(k.height)).contains(&y);
        image.extend((DVec2::new(x, y) - at).to_array());
        moved.extend((after - before).to_array());
        seen.push(f64::from(u8::from(inside)));
    }
    let mut flow = Frame::new(k.width, k.height);
    for (layer, values) in [(Layer::OpticalFlow, image), (Layer::SceneFlow, moved), (Layer::FlowVisibility, seen)] {
        flow.insert(layer, store(layer, values));
    }
    flow
}

/// Points of the first frame, followed into the second.
fn tracks(poses: [&Pose; 2]) -> Tracks {
    let (k, shown) = (intrinsics(), frame(poses[0]));
    let positions = shown.get(Layer::Position).unwrap();
    let mut tracks = Tracks { frames: poses.map(|pose| pose.frame).into(), ..Tracks::default() };
    for pixel in (7..shown.pixels()).step_by(97).filter(|&pixel| vector(positions, pixel).is_finite()) {
        let p = vector(positions, pixel);
        let seed = [(pixel as u32 % k.width) as f32 + 0.5, (pixel as u32 / k.width) as f32 + 0.5];
        tracks.positions.push(p);
        tracks.seeds.push((0, seed));
        for pose in poses {
            let (x, y) = k.project(pose.world_from_camera.transpose() * (p - pose.position));
            let (width, height) = (f64::from(k.width), f64::from(k.height));
            tracks.points.push([(x / width) as f32, (y / height) as f32]);
            tracks.occluded.push(!(0.0..width).contains(&x) || !(0.0..height).contains(&y));
        }
    }
    tracks
}

/// The rooms that the floor and the wall belong to: one of 16 by 10 metres behind the camera.
pub fn rooms() -> Rooms {
    let polygon = vec![[-8.0, -8.0], [8.0, -8.0], [8.0, 2.0], [-8.0, 2.0]];
    let room = RoomOutline { name: "hall_1".into(), kind: "hall".into(), polygon, floor_z_m: 0.0, ceiling_z_m: 2.5 };
    let mut rooms = Rooms::default();
    rooms.push_room(room, &[(0.3, true); 4]);
    rooms
}

/// The surfaces along the rays of a frame: what it shows, and 1 m behind it the back of the same part.
pub fn surfaces(frame: &Frame) -> Surfaces {
    let value = |layer: Layer, i: usize| frame.get(layer).unwrap().get(i);
    let seen = |pixel: usize| value(Layer::RenderEntityId, pixel) as i16;
    let each = |pixel: usize| [pixel, pixel];
    let labels = labels();
    let class = |entity: i16| usize::try_from(entity - 1).map_or(-1, |part| labels.parts[part].semantic);
    let distance = |pixel: usize| value(Layer::DepthMeters, pixel) as f32;
    let normal = |pixel: usize| [0, 1, 2].map(|axis| f16::from_f64(value(Layer::NormalGeometricWorld, 3 * pixel + axis)));
    let pixels = || 0..frame.pixels();
    Surfaces {
        size: [frame.height as usize, frame.width as usize],
        count: 2,
        distance_m: pixels().flat_map(|pixel| [distance(pixel), distance(pixel) + 1.0]).collect(),
        entity: pixels().flat_map(each).map(seen).collect(),
        semantic: pixels().flat_map(each).map(|pixel| class(seen(pixel))).collect(),
        side: pixels().flat_map(|pixel| if seen(pixel) == -1 { [0, 0] } else { [1, 2] }).collect(),
        normal_world: pixels().flat_map(each).flat_map(normal).collect(),
        bent_distance_m: pixels().map(distance).collect(),
        bent_position: pixels().flat_map(|pixel| [0, 1, 2].map(|axis| value(Layer::Position, 3 * pixel + axis) as f32)).collect(),
        bent_entity: pixels().map(seen).collect(),
    }
}

/// A complete dataset of one scene "room" with camera `cam_00` and two frames, labelled, with boxes, rooms, fixtures, covisibility, flow,
/// tracks, surfaces along rays, split, free space and manifest.
pub fn dataset(root: &std::path::Path) -> Dataset {
    let dataset = Dataset::create(root).unwrap();
    dataset.write_scene("room", &scene()).unwrap();
    dataset.write_camera_parameters("room", &intrinsics().into()).unwrap();
    dataset.write_label_tables("room", &labels()).unwrap();
    let first = pose();
    let second = Pose { frame: 1, position: first.position + DVec3::X * 0.1, look_at: first.look_at + DVec3::X * 0.1, ..first };
    let trajectory = Trajectory { name: "cam_00".into(), poses: vec![first, second] };
    dataset.write_trajectory("room", &trajectory, &intrinsics().into(), None).unwrap();
    write_json(&dataset.layout().plan_report("room", "cam_00"), &plan_report(&first)).unwrap();
    let mut tree = OccupancyTree::new(0.1);
    for pose in &trajectory.poses {
        [pose.position, pose.look_at].into_iter().for_each(|p| tree.set(tree.key(p).unwrap(), Voxel::Free));
        let whole = frame(pose);
        let part_of = |passes: &[Pass]| {
            let mut part = Frame::new(whole.width, whole.height);
            let wanted = whole.iter().filter(|(layer, _)| passes.contains(&layer.spec().pass));
            wanted.for_each(|(layer, values)| part.insert(layer, values.clone()));
            if passes.contains(&Pass::Final) {
                whole.fixtures().iter().for_each(|fixture| part.push_fixture(fixture.clone()));
            }
            part
        };
        let info = FrameInfo {
            seed: 1,
            samples: 1,
            config_hash: "test".into(),
            pose: *pose,
            camera: intrinsics().into(),
            sampling: None,
            recipe: None,
        };
        dataset
            .write_frame(
                "room",
                "cam_00",
                &part_of(&[Pass::Final, Pass::Geometry, Pass::Guides, Pass::LightParts, Pass::Extra]),
                &info,
                FrameTime::default(),
            )
            .unwrap();
        dataset.write_label_layers("room", "cam_00", pose.frame, &part_of(&[Pass::Label]), "test").unwrap();
        dataset.write_surfaces("room", "cam_00", pose.frame, surfaces(&whole)).unwrap();
        let mut denoised = Frame::new(whole.width, whole.height);
        DENOISED.iter().for_each(|(layer, _)| denoised.insert(*layer, whole.get(*layer).unwrap().clone()));
        dataset.write_denoised(["room", "cam_00"], pose.frame, &denoised, ["Smoother 3.1", "test"], true).unwrap();
    }
    dataset.write_free_space("room", &tree.to_bt(), first.position, second.position).unwrap();
    let mirror = OrientedBox { center: DVec3::new(0.0, 2.0, 1.5), world_from_box: DMat3::IDENTITY, extents: DVec3::new(1.0, 0.0, 1.0) };
    BoxKind::ALL.iter().for_each(|&kind| dataset.write_boxes("room", kind, &[None, Some(mirror)]).unwrap());
    let views: Vec<InstanceView> = trajectory.poses.iter().filter_map(instance_views).collect();
    dataset.write_instance_views("room", "cam_00", &views).unwrap();
    dataset.write_rooms("room", &rooms()).unwrap();
    dataset.write_fixtures("room", &fixtures()).unwrap();
    let hangs = InstanceRelation { subject: 1, kind: RelationKind::HangsFrom, object: -1, object_semantic: 1, distance_m: 0.0 };
    dataset.write_instance_relations("room", &[hangs]).unwrap();
    dataset.write_covisibility("room", &covisibility([&first, &second])).unwrap();
    let pair = FramePair { scene: "room".into(), first: ("cam_00".into(), 0), second: ("cam_00".into(), 1) };
    dataset.write_pair_layers(&pair, &flow(&first, &second)).unwrap();
    dataset.write_tracks("room", "cam_00", &tracks([&first, &second])).unwrap();
    let row = |frame| PartitionRow { scene: "room".into(), camera: "cam_00".into(), frame, side: Ok(Side::Train) };
    dataset.write_partition(&[row(0), row(1)]).unwrap();
    dataset.write_manifest(&dataset.collect_manifest(&ManifestInfo::default()).unwrap()).unwrap();
    dataset
}
