//! A dataset for the tests: two boxes in the corner of a room, every value in closed form.
#![allow(dead_code, reason = "each test file uses a part of it")]

use enfilade_dataset::{Dataset, FrameInfo, FrameTime, ManifestInfo};
use enfilade_export::Format;
use enfilade_frame::{Dtype, Frame, LAYERS, Layer, Pass, Values, f16};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
use enfilade_scene::{
    Camera, CameraView, DoorLeaf, Hinge, Intrinsics, Labels, Material, OpeningKind, Part, PartLabel, Pose, RoomOutline, Rooms, Scene,
    Trajectory, WallOpening,
};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Parts: floor, wall, and two boxes by their corners.
const BOXES: [[[f64; 3]; 2]; 2] = [[[-0.5, 0.5, 0.0], [0.3, 1.0, 0.6]], [[0.6, 0.8, 0.0], [1.0, 1.2, 0.4]]];

/// NYU40 class and instance of each part: floor, wall, table, chair.
const LABELS: [(i16, i16); 4] = [(2, -1), (1, -1), (7, 1), (5, 2)];

/// A pinhole with an off-centre principal point and pixels that are no squares.
pub fn pinhole() -> Camera {
    Intrinsics { width: 40, height: 30, fx: 33.0, fy: 34.5, cx: 19.25, cy: 15.75, skew: 0.0 }.into()
}

/// The pinhole that a format can have: Pix3D's cameras look through the middle of the image, and have one focal length.
pub fn pinhole_of(format: Format) -> Camera {
    match format {
        Format::Pix3d => Intrinsics { width: 40, height: 30, fx: 33.0, fy: 33.0, cx: 20.0, cy: 15.0, skew: 0.0 }.into(),
        _ => pinhole(),
    }
}

/// The first hit of a ray: distance and part. The wall is 1.4 m high, and there is nothing above it.
fn meet(origin: DVec3, direction: DVec3) -> Option<(f64, usize)> {
    let mut best: Option<(f64, usize)> = None;
    let mut try_hit = |distance: f64, part: usize| {
        if distance > 1e-9 && best.is_none_or(|(nearest, _)| distance < nearest) {
            best = Some((distance, part));
        }
    };
    try_hit(-origin.z / direction.z, 0);
    let to_wall = (2.0 - origin.y) / direction.y;
    if (origin + direction * to_wall).z < 1.4 {
        try_hit(to_wall, 1);
    }
    for (i, corners) in BOXES.iter().enumerate() {
        let [low, high] = corners.map(|corner| (DVec3::from(corner) - origin) / direction);
        let (near, far) = (low.min(high).max_element(), low.max(high).min_element());
        if near < far {
            try_hit(near, 2 + i);
        }
    }
    best.filter(|&(distance, _)| (origin + direction * distance).y <= 2.0 + 1e-9)
}

/// The frame that the camera sees at pose `index`.
fn frame(camera: &Camera, poses: &[Pose], index: usize) -> Frame {
    let [width, height] = camera.size();
    let view = CameraView::of_frame(camera, poses, index);
    let mut layers: BTreeMap<Layer, Vec<f64>> = BTreeMap::new();
    for i in 0..width * height {
        let (x, y) = (f64::from(i % width) + 0.5, f64::from(i / width) + 0.5);
        let ray = view.centre_ray(x, y);
        let hit = ray.and_then(|ray| meet(ray.origin, ray.direction).map(|(distance, part)| (ray, distance, part)));
        let mut push = |layer: Layer, values: &[f64]| layers.entry(layer).or_default().extend(values);
        let Some((ray, distance, part)) = hit else {
            push(Layer::DepthMeters, &[f64::NAN]);
            push(Layer::DepthZMeters, &[f64::NAN]);
            push(Layer::Position, &[f64::NAN; 3]);
            push(Layer::Color, &[1.5, 1.6, 1.8]);
            [Layer::RenderEntityId, Layer::Semantic, Layer::SemanticInstance].into_iter().for_each(|layer| push(layer, &[-1.0]));
            push(Layer::Valid, &[0.0]);
            continue;
        };
        let ahead = -(poses[index].world_from_camera.transpose() * ray.direction).z;
        push(Layer::DepthMeters, &[distance]);
        push(Layer::DepthZMeters, &[distance * ahead]);
        push(Layer::Position, &(ray.origin + ray.direction * distance).to_array());
        push(Layer::Color, &[0.2 + 0.1 * part as f64, 0.3, 0.1 + 0.01 * x]);
        push(Layer::RenderEntityId, &[part as f64 + 1.0]);
        push(Layer::Semantic, &[f64::from(LABELS[part].0)]);
        push(Layer::SemanticInstance, &[f64::from(LABELS[part].1)]);
        push(Layer::Valid, &[1.0]);
    }
    let mut frame = Frame::new(width, height);
    layers.into_iter().for_each(|(layer, values)| frame.insert(layer, store(layer, &values)));
    frame
}

fn store(layer: Layer, values: &[f64]) -> Values {
    match layer.spec().dtype {
        Dtype::F16 => Values::F16(values.iter().map(|&v| f16::from_f64(v)).collect()),
        Dtype::F32 => Values::F32(values.iter().map(|&v| v as f32).collect()),
        Dtype::I16 => Values::I16(values.iter().map(|&v| v as i16).collect()),
        Dtype::U8 => Values::U8(values.iter().map(|&v| v as u8).collect()),
    }
}

/// A block with twelve triangles.
fn block([low, high]: [[f64; 3]; 2]) -> Mesh {
    let corner = |i: usize| Vec3::from_array(std::array::from_fn(|axis| if i >> axis & 1 == 0 { low[axis] } else { high[axis] } as f32));
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh { positions: (0..8).map(corner).collect(), triangles, ..Mesh::default() }
}

fn scene() -> Scene {
    let [first, second] = BOXES;
    let shapes = [[[-3.0, -3.0, -0.1], [3.0, 2.0, 0.0]], [[-3.0, 2.0, 0.0], [3.0, 2.1, 1.4]], first, second];
    let names = ["floor", "wall", "table", "chair"];
    let part = |(i, name): (usize, &&str)| Part {
        name: name.to_string(),
        object: None,
        mesh: i as u32,
        material: 0,
        world_from_mesh: DAffine3::IDENTITY,
    };
    Scene {
        meshes: shapes.map(|shape| block(shape).into()).into(),
        parts: names.iter().enumerate().map(part).collect(),
        materials: vec![Material::diffuse("paint", Rgb::splat(0.5))],
        ..Scene::default()
    }
}

fn pose(frame: u32, x: f64) -> Pose {
    Pose::look_at(frame, DVec3::new(x, -1.6, 1.1), DVec3::new(0.15, 1.0, 0.5), DVec3::new(0.05, 0.0, 1.0)).unwrap()
}

/// Writes the dataset: scene `room` with cameras `cam_00` (frames 0, 1, 3) and `cam_01` (frame 0), scene `room-two` with `cam_00`.
pub fn write(root: &Path, camera: &Camera) -> Dataset {
    let dataset = Dataset::create(root).unwrap();
    let trajectories = [
        ("room", "cam_00", vec![pose(0, 0.1), pose(1, 0.3), pose(3, -0.4)]),
        ("room", "cam_01", vec![pose(0, 0.8)]),
        ("room-two", "cam_00", vec![pose(0, -0.2), pose(12, 0.0)]),
    ];
    for (name, camera_name, poses) in trajectories {
        dataset.write_scene(name, &scene()).unwrap();
        dataset.write_camera_parameters(name, camera).unwrap();
        let label = |&(semantic, instance): &(i16, i16)| PartLabel { semantic, instance };
        dataset.write_rooms(name, &rooms()).unwrap();
        dataset.write_label_tables(name, &Labels { parts: LABELS.iter().map(label).collect() }).unwrap();
        let trajectory = Trajectory { name: camera_name.into(), poses };
        dataset.write_trajectory(name, &trajectory, camera, None).unwrap();
        // Some formats are of videos.
        dataset.write_frame_time(name, camera_name, 0.04).unwrap();
        for (index, pose) in trajectory.poses.iter().enumerate() {
            let whole = frame(camera, &trajectory.poses, index);
            let part_of = |labels: bool| {
                let mut part = Frame::new(whole.width, whole.height);
                let wanted = whole.iter().filter(|(layer, _)| (layer.spec().pass == Pass::Label) == labels);
                wanted.for_each(|(layer, values)| part.insert(layer, values.clone()));
                part
            };
            let info = FrameInfo {
                seed: 1,
                samples: 1,
                config_hash: "test".into(),
                pose: *pose,
                camera: camera.clone(),
                sampling: None,
                recipe: None,
            };
            dataset.write_frame(name, camera_name, &part_of(false), &info, FrameTime::default()).unwrap();
            dataset.write_label_layers(name, camera_name, pose.frame, &part_of(true), "test").unwrap();
        }
    }
    dataset.write_manifest(&dataset.collect_manifest(&ManifestInfo::default()).unwrap()).unwrap();
    dataset
}

/// A room of four metres by five with a door to the outside and a window.
fn rooms() -> Rooms {
    let polygon = vec![[-2.0, -3.0], [2.0, -3.0], [2.0, 2.0], [-2.0, 2.0]];
    let room = RoomOutline { name: "study_1".into(), kind: "study".into(), polygon, floor_z_m: 0.0, ceiling_z_m: 1.4 };
    let mut rooms = Rooms::default();
    rooms.push_room(room, &[(0.3, true); 4]);
    let opening = |kind, wall: usize, along: [f64; 2], z: [f64; 2], leaf| {
        let corner = |i: usize, k: usize| rooms.walls[wall].point(along[i], z[k]).to_array();
        WallOpening { kind, walls: vec![wall], corners: [corner(1, 0), corner(0, 0), corner(0, 1), corner(1, 1)], leaf }
    };
    let leaf = DoorLeaf { hinge: Hinge::Left, open_deg: 0.0 };
    let openings = vec![
        opening(OpeningKind::Door, 0, [1.0, 1.8], [0.0, 1.3], Some(leaf)),
        opening(OpeningKind::Window, 1, [1.0, 2.5], [0.5, 1.2], None),
    ];
    Rooms { openings, ..rooms }
}

/// The layer of a frame of the dataset.
pub fn layer(dataset: &Dataset, scene: &str, camera: &str, frame: u32, layer: Layer) -> Values {
    dataset.read_layer(scene, camera, frame, layer).unwrap()
}

/// Every file below a folder by its name.
pub fn files(root: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![root.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                files.insert(path.strip_prefix(root).unwrap().to_path_buf(), std::fs::read(&path).unwrap());
            }
        }
    }
    files
}

/// Names of layers that the analytic frames have.
pub fn layers() -> Vec<Layer> {
    let have = ["color", "depth_meters", "depth_z_meters", "position", "render_entity_id", "valid", "semantic", "semantic_instance"];
    LAYERS.iter().filter(|spec| have.contains(&spec.name)).map(|spec| spec.layer).collect()
}
