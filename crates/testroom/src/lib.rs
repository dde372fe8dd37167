//! An analytic frame for tests: every layer of a room corner whose values are known in closed form.
//!
//! Floor (part 1, z = 0), wall (part 2, y = 2, up to z = 2.5) and a mirror in the wall (part 3), void above. The mirror has no
//! diffuse reflectance; one of its pixels is saturated.

use enfilade_dataset::{BoxKind, Covisibility, CovisibleFrame, FramePair, HiddenBy, InstanceRelation, InstanceView, Partition};
use enfilade_dataset::{RelationKind, SplitRow, Surfaces, Tracks};
use enfilade_frame::{DENOISED, FixtureLayers, Frame, LAYERS, Layer, Pass, Validity, Values, f16, traits, vector};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec2, DVec3, OrientedBox, Rgb, Vec3};
use enfilade_scene::{Intrinsics, Labels, Material, Part, PartLabel, Pose, Scene, Structure, StructureRoom, WorldMesh};

/// Names of the parts, in the order of their numbers.
pub const PARTS: [&str; 3] = ["floor", "wall", "wall/mirror"];

/// The camera: 64 by 48 pixels, 70 degrees wide.
pub fn intrinsics() -> Intrinsics {
    Intrinsics::from_fov_x(64, 48, 70f64.to_radians())
}

/// Where the camera of the first frame stands: before the wall, looking at the mirror.
pub fn pose() -> Pose {
    Pose::look_at(0, DVec3::new(0.3, -3.0, 1.5), DVec3::new(-0.2, 1.0, 1.4), DVec3::new(0.02, 0.0, 1.0)).unwrap()
}

/// What the parts are: a floor, a wall, and a mirror, which is instance 1.
pub fn labels() -> Labels {
    let label = |semantic, instance| PartLabel { semantic, instance };
    Labels { parts: vec![label(2, -1), label(1, -1), label(19, 1)] }
}

/// What a ray meets: distance along it, part, normal toward the camera, texture coordinates.
fn meet(origin: DVec3, direction: DVec3) -> Option<(f64, i16, DVec3, DVec2)> {
    let to_floor = -origin.z / direction.z;
    let to_wall = (2.0 - origin.y) / direction.y;
    let wall = origin + direction * to_wall;
    if to_wall > 0.0 && (0.0..2.5).contains(&wall.z) {
        let mirror = wall.x.abs() < 0.5 && (1.0..2.0).contains(&wall.z);
        return Some((to_wall, if mirror { 3 } else { 2 }, DVec3::NEG_Y, DVec2::new(wall.x, wall.z)));
    }
    let floor = origin + direction * to_floor;
    (to_floor > 0.0 && floor.y < 2.0).then_some((to_floor, 1, DVec3::Z, DVec2::new(floor.x, floor.y)))
}

/// The frame seen from `pose`.
pub fn frame(pose: &Pose) -> Frame {
    let k = intrinsics();
    let labels = labels();
    let mut layers: Vec<Vec<f64>> = vec![Vec::new(); LAYERS.len()];
    let mut push = |layer: Layer, values: &[f64]| layers[layer as usize].extend(values);
    for i in 0..k.width * k.height {
        let (x, y) = (f64::from(i % k.width) + 0.5, f64::from(i / k.width) + 0.5);
        let direction_camera = k.ray(x, y).normalize();
        let hit = meet(pose.position, pose.world_from_camera * direction_camera);
        let (distance, id, normal, uv) = hit.unwrap_or((f64::NAN, -1, DVec3::NAN, DVec2::ZERO));
        let position = pose.position + pose.world_from_camera * direction_camera * distance;
        let in_camera = pose.world_from_camera.transpose() * normal;
        push(Layer::DepthMeters, &[distance]);
        push(Layer::DepthZMeters, &[-direction_camera.z * distance]);
        push(Layer::Position, &position.to_array());
        [Layer::NormalWorld, Layer::NormalBumpWorld].into_iter().for_each(|l| push(l, &normal.to_array()));
        [Layer::NormalCam, Layer::NormalBumpCam].into_iter().for_each(|l| push(l, &in_camera.to_array()));
        push(Layer::TexCoord, &[uv.x, uv.y, 0.0]);
        push(Layer::RenderEntityId, &[f64::from(id)]);
        let label = usize::try_from(id - 1).map_or(PartLabel::NONE, |part| labels.parts[part]);
        push(Layer::Semantic, &[f64::from(label.semantic)]);
        push(Layer::SemanticInstance, &[f64::from(label.instance)]);
        let saturated = id == 3 && i == 20 * k.width + 36;
        let (a, s, r) = match id {
            1 => (0.5, 0.8, 0.05),
            2 => (0.7, 0.4 + 0.3 * (x / 64.0), 0.02),
            3 => (0.0, 0.3, if saturated { 65504.0 } else { 0.6 }),
            _ => (0.0, 0.0, 1.5),
        };
        let [a, s, r] = [a, s, r].map(|v| f16::from_f64(v).to_f32());
        push(Layer::DiffuseReflectance, &[f64::from(a); 3]);
        [Layer::DiffuseIllumination, Layer::DiffuseIlluminationRendered].into_iter().for_each(|l| push(l, &[f64::from(s); 3]));
        [Layer::Residual, Layer::ResidualRendered].into_iter().for_each(|l| push(l, &[f64::from(r); 3]));
        [Layer::Color, Layer::ColorRendered].into_iter().for_each(|l| push(l, &[f64::from(a * s + r); 3]));
        push(Layer::ColorStandardError, &[f64::from(0.125 * (a * s + r))]);
        // The floor is lit from the void, the wall by a lamp.
        let diffuse = f64::from(a * s);
        let (r, seen) = (f64::from(r), id != -1);
        push(Layer::DiffuseDirect, &[0.75 * diffuse; 3]);
        push(Layer::DiffuseIndirect, &[0.25 * diffuse; 3]);
        push(Layer::Specular, &[if seen { r } else { 0.0 }; 3]);
        push(Layer::Transmission, &[0.0; 3]);
        push(Layer::Emission, &[if seen { 0.0 } else { r }; 3]);
        push(Layer::LightEnvironment, &[if id <= 1 { diffuse + r } else { 0.0 }; 3]);
        push(Layer::LightSurfaces, &[if id <= 1 { 0.0 } else { 0.5 * (diffuse + r) }; 3]);
        push(Layer::LightPoints, &[if id <= 1 { 0.0 } else { 0.5 * (diffuse + r) }; 3]);
        push(Layer::LightDistant, &[0.0; 3]);
        push(Layer::MaterialId, &[f64::from(id)]);
        push(Layer::BaseColor, &[f64::from(a); 3]);
        push(Layer::Metallic, &[f64::from(u8::from(id == 3))]);
        push(Layer::Roughness, &[if id == 3 || !seen { 0.0 } else { 1.0 }]);
        push(Layer::TransmissionWeight, &[0.0]);
        push(Layer::EmittedRadiance, &[0.0; 3]);
        push(Layer::NormalGeometricWorld, &normal.to_array());
        push(Layer::SurfaceTraits, &[f64::from(u8::from(id == 3) * traits::MIRROR)]);
        push(Layer::DepthBehindMeters, &[distance]);
        push(Layer::EntityBehindId, &[f64::from(id)]);
        push(Layer::OcclusionBoundary, &[0.0]);
        // The camera rests.
        push(Layer::OpticalFlow, &[if seen { 0.0 } else { f64::NAN }; 2]);
        push(Layer::SceneFlow, &[if seen { 0.0 } else { f64::NAN }; 3]);
        push(Layer::FlowVisibility, &[f64::from(u8::from(seen))]);
        let code = match id {
            -1 => Validity::Void,
            3 if saturated => Validity::Saturated,
            3 => Validity::NoDiffuse,
            _ => Validity::Valid,
        };
        push(Layer::Valid, &[f64::from(code as u8)]);
    }
    let mut frame = Frame::new(k.width, k.height);
    for (spec, values) in LAYERS.iter().zip(layers) {
        frame.insert(spec.layer, store(spec.layer, values));
    }
    add_fixtures(&mut frame);
    frame
}

/// Adds the light of two fixtures: the sky, which lights the floor and is seen in the void, and a lamp, which lights all else.
fn add_fixtures(frame: &mut Frame) {
    let [illumination, residual, reflectance] =
        [Layer::DiffuseIllumination, Layer::Residual, Layer::DiffuseReflectance].map(|layer| frame.get(layer).unwrap().clone());
    let ids = frame.get(Layer::RenderEntityId).unwrap().clone();
    for is_sky in [true, false] {
        let own = |values: &Values, has: &dyn Fn(usize) -> bool| {
            let value = |i: usize| if (ids.get(i / 3) <= 1.0) == is_sky && has(i) { values.get(i) } else { 0.0 };
            Values::F16((0..values.len()).map(|i| f16::from_f64(value(i))).collect())
        };
        let diffuse_illumination = own(&illumination, &|i| reflectance.get(i) > 0.0);
        let light = FixtureLayers { diffuse_illumination, residual: own(&residual, &|_| true) };
        frame.push_fixture(light);
    }
}

/// What lights the room.
pub fn fixtures() -> Vec<enfilade_dataset::Fixture> {
    let fixture = |id, kind: &str, place: Option<Vec3>| enfilade_dataset::Fixture {
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

/// Values in the type of a layer.
pub fn store(layer: Layer, values: Vec<f64>) -> Values {
    use enfilade_frame::Dtype;
    match layer.spec().dtype {
        Dtype::F16 => Values::F16(values.into_iter().map(f16::from_f64).collect()),
        Dtype::F32 => Values::F32(values.into_iter().map(|v| v as f32).collect()),
        Dtype::I16 => Values::I16(values.into_iter().map(|v| v as i16).collect()),
        Dtype::U8 => Values::U8(values.into_iter().map(|v| v as u8).collect()),
    }
}

/// Rewrites the channels of one pixel.
pub fn set(frame: &mut Frame, layer: Layer, pixel: usize, channels: &[f64]) {
    let values = frame.get(layer).unwrap();
    let mut all: Vec<f64> = (0..values.len()).map(|i| values.get(i)).collect();
    let at = pixel * channels.len();
    all[at..at + channels.len()].copy_from_slice(channels);
    frame.insert(layer, store(layer, all));
}

/// The first pixel of a part, or of the void (−1), with its left and right neighbours of the same.
pub fn pixel_of(frame: &Frame, part: i16) -> usize {
    let ids = frame.get(Layer::RenderEntityId).unwrap();
    let is = |i: usize| ids.get(i) == f64::from(part);
    (1..frame.pixels() - 1).find(|&i| is(i) && is(i - 1) && is(i + 1)).unwrap()
}

/// A scene whose parts have the names of the analytic frame's; their shapes do not matter.
pub fn scene() -> enfilade_scene::Scene {
    use enfilade_math::{DAffine3, Rgb, Vec3};
    let mesh = enfilade_geometry::Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Default::default() };
    let part = |name: &str| enfilade_scene::Part { name: name.into(), mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY };
    enfilade_scene::Scene {
        meshes: vec![mesh],
        parts: PARTS.map(part).into(),
        materials: vec![enfilade_scene::Material::diffuse("paint", Rgb::splat(0.5))],
        ..Default::default()
    }
}

/// What the frame from `pose` shows of the mirror, all of which is visible.
fn instance_views(pose: &Pose) -> Option<InstanceView> {
    let area = enfilade_label::instances::visible_areas(frame(pose).get(Layer::SemanticInstance)?, intrinsics().width).remove(&1)?;
    let (visible, full, inside_pixels) = (area, area, area.pixels);
    Some(InstanceView { frame: pose.frame, instance: 1, semantic: 19, visible, full, inside_pixels })
}

/// What the plan of a walk that begins at `first` says of itself.
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

/// What two frames see of each other: everything that lies in the image, since nothing hides anything here.
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

/// The layout that the floor and the wall belong to: a room of 16 by 10 metres behind the camera.
pub fn structure() -> Structure {
    let polygon = vec![[-8.0, -8.0], [8.0, -8.0], [8.0, 2.0], [-8.0, 2.0]];
    let room = StructureRoom { name: "hall_1".into(), kind: "hall".into(), polygon, floor_z_m: 0.0, ceiling_z_m: 2.5 };
    let mut structure = Structure::default();
    structure.push_room(room, &[(0.3, true); 4]);
    structure
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

/// A complete dataset of one scene "room" with camera `cam_00` and two frames, labelled, with boxes, layout, fixtures, covisibility, flow, tracks,
/// surfaces along rays, split, free space and manifest.
pub fn dataset(root: &std::path::Path) -> enfilade_dataset::Dataset {
    use enfilade_dataset::{Dataset, FrameInfo, FrameTime};
    use enfilade_geometry::{OccupancyTree, Voxel};
    let dataset = Dataset::create(root).unwrap();
    dataset.write_scene("room", &scene()).unwrap();
    dataset.write_camera_parameters("room", &intrinsics().into()).unwrap();
    dataset.write_label_tables("room", &labels()).unwrap();
    let first = pose();
    let second = Pose { frame: 1, position: first.position + DVec3::X * 0.1, look_at: first.look_at + DVec3::X * 0.1, ..first };
    let trajectory = enfilade_scene::Trajectory { name: "cam_00".into(), poses: vec![first, second] };
    dataset.write_trajectory("room", &trajectory, &intrinsics().into(), None).unwrap();
    enfilade_dataset::write_json(&dataset.layout().plan_report("room", "cam_00"), &plan_report(&first)).unwrap();
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
            .write_frame("room", "cam_00", &part_of(&[Pass::Final, Pass::Geometry, Pass::Split, Pass::Extra]), &info, FrameTime::default())
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
    dataset.write_structure("room", &structure()).unwrap();
    dataset.write_fixtures("room", &fixtures()).unwrap();
    let hangs = InstanceRelation { subject: 1, kind: RelationKind::HangsFrom, object: -1, object_semantic: 1, distance_m: 0.0 };
    dataset.write_instance_relations("room", &[hangs]).unwrap();
    dataset.write_covisibility("room", &covisibility([&first, &second])).unwrap();
    let pair = FramePair { scene: "room".into(), first: ("cam_00".into(), 0), second: ("cam_00".into(), 1) };
    dataset.write_pair_layers(&pair, &flow(&first, &second)).unwrap();
    dataset.write_tracks("room", "cam_00", &tracks([&first, &second])).unwrap();
    let row = |frame| SplitRow { scene: "room".into(), camera: "cam_00".into(), frame, partition: Ok(Partition::Train) };
    dataset.write_split(&[row(0), row(1)]).unwrap();
    dataset.write_manifest(&dataset.collect_manifest(&enfilade_dataset::ManifestInfo::default()).unwrap()).unwrap();
    dataset
}

/// A closed box room as rays meet it: part 0, six sides of two triangles.
pub fn box_room(min: DVec3, max: DVec3) -> WorldMesh {
    let corner = |i: usize| DVec3::new([min.x, max.x][i & 1], [min.y, max.y][(i >> 1) & 1], [min.z, max.z][i >> 2]).as_vec3();
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = Mesh { positions: (0..8).map(corner).collect(), triangles, ..Mesh::default() };
    let part = Part { name: "room".into(), mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY };
    let materials = vec![Material::diffuse("grey", Rgb::splat(0.5))];
    WorldMesh::new(&Scene { meshes: vec![mesh], parts: vec![part], materials, ..Scene::default() })
}
