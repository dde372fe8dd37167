//! V-Ray's images into a dataset: a room that our own renderer rendered is written as V-Ray writes images, and read back.

mod common;

use common::{Lamp, contents, fail, folder, scene, succeed, write_config, write_room};
use enfilade_dataset::Dataset;
use enfilade_frame::{Frame, LAYERS, Layer, Pass, Values};
use enfilade_scene::Pose;
use exr::prelude::{AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, LayerAttributes, Text, WritableImage};
use std::fs;
use std::path::Path;

/// Metres per unit of V-Ray's scene.
const UNIT: f32 = 0.5;
/// In another order than the parts of the room: room, table, box, lamp.
const NODES: [&str; 5] = ["box", "rail", "lamp", "room", "table"];

/// A V-Ray scene with the room's nodes, and one that is not in the room.
fn vrscene() -> String {
    let nodes: String = NODES.iter().map(|name| format!("Node {name}@node {{ geometry=mesh; }}\n")).collect();
    format!("SettingsUnitsInfo units {{ meters_scale={UNIT}; }}\nRenderView view {{ fov=1; }}\n{nodes}")
}

/// The dataset `own` with frames of our renderer, a copy `data` of it without, and the job of V-Ray in `job`.
fn prepare(dir: &Path) {
    write_room(dir, "room", Lamp::On);
    write_config(dir, &[scene("room")]);
    succeed(dir, &["run", "dataset.toml", "-o", "own"]);
    copy_folder(&dir.join("own"), &dir.join("data"));
    fs::remove_dir_all(dir.join("data/scenes/room/images")).unwrap();
    fs::remove_dir_all(dir.join("data/scenes/room/_detail/cam_00/frames")).unwrap();
    fs::create_dir(dir.join("data/scenes/room/_detail/cam_00/frames")).unwrap();
    fs::write(dir.join("room.vrscene"), vrscene()).unwrap();
    let objects = "own/scenes/room/_detail/mesh/metadata_objects.csv";
    let entities = ["--objects", objects, "--nodes", "nodes.csv", "--hide-lights"];
    succeed(dir, &[["vray", "entities", "room.vrscene", "-o", "a.vrscene"].as_slice(), &entities].concat());
    succeed(dir, &["vray", "layers", "a.vrscene", "-o", "b.vrscene"]);
    let of = ["--dataset", "data", "--scene", "room", "--folder", "/mnt/job", "--nodes", "nodes.csv"];
    let said = succeed(dir, &[["vray", "jobs", "b.vrscene", "-o", "job"].as_slice(), &of].concat());
    assert!(said.contains("cam_00   3 frames in 7 steps"), "{said}");
}

fn copy_folder(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        if entry.path().is_dir() { copy_folder(&entry.path(), &target) } else { drop(fs::copy(entry.path(), target).unwrap()) }
    }
}

/// Takes V-Ray's place: writes the images of both passes of a frame of `own` into the job.
fn render_as_v_ray(dir: &Path, frame: &Frame, pose: &Pose, fov_x_deg: f32, number: u32) {
    let value = |layer: Layer, i: usize| frame.get(layer).unwrap().get(i) as f32;
    let all = |layer: Layer, of: &dyn Fn(f32) -> f32| (0..3 * frame.pixels()).map(|i| of(value(layer, i))).collect::<Vec<f32>>();
    let known = |v: f32| if v.is_nan() { 0.0 } else { v };
    let id = |i: usize| match value(Layer::RenderEntityId, i) {
        -1.0 => u32::MAX,
        part => 1 + NODES.iter().position(|node| *node == ["room", "table", "box", "lamp"][part as usize - 1]).unwrap() as u32,
    };
    let mut geometry = vec![AnyChannel::new("VRayRenderEntityID", FlatSamples::U32((0..frame.pixels()).map(id).collect()))];
    geometry.extend(triple("VRayPosition", &all(Layer::Position, &|v| known(v) / UNIT)));
    // An artist's normals: some have another length, and some face away.
    geometry.extend(triple("VRayNormal", &all(Layer::NormalWorld, &|v| -2.0 * known(v))));
    geometry.extend(triple("VRayNormalBump", &all(Layer::NormalBumpWorld, &|v| -known(v))));
    geometry.extend(triple("VRayTexCoord", &all(Layer::TexCoord, &|v| v)));
    let (a, s, r) = (Layer::DiffuseReflectance, Layer::DiffuseIllumination, Layer::Residual);
    let image: Vec<f32> = (0..3 * frame.pixels()).map(|i| value(a, i) * value(s, i) + value(r, i)).collect();
    let mut beauty = triple("", &image);
    beauty.extend(triple("VRayDiffuseFilter", &all(a, &|v| v)));
    beauty.extend(triple("VRayRawTotalLighting", &all(s, &|v| v)));
    beauty.extend(triple("VRaySpecular", &all(r, &|v| v)));
    for part in ["VRayReflection", "VRayRefraction", "VRaySSS2", "VRaySelfIllumination", "VRayCaustics", "VRayAtmosphere", "VRayBackground"] {
        beauty.extend(triple(part, &vec![0.0; 3 * frame.pixels()]));
    }
    for (pass, channels) in [("geometry", geometry), ("final", beauty)] {
        let path = dir.join(format!("job/images/scene_cam_00_{pass}/frame.{number:04}.exr"));
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        let size = (frame.width as usize, frame.height as usize);
        let layer = exr::prelude::Layer::new(size, attributes(pose, fov_x_deg), Encoding::SMALL_LOSSLESS, AnyChannels::sort(channels.into_iter().collect()));
        Image::from_layer(layer).write().to_file(path).unwrap();
    }
}

fn triple(element: &str, values: &[f32]) -> Vec<AnyChannel<FlatSamples>> {
    let channel = |(c, letter): (usize, &str)| {
        let name = if element.is_empty() { letter.to_string() } else { format!("{element}.{letter}") };
        AnyChannel::new(name.as_str(), FlatSamples::F32(values.iter().skip(c).step_by(3).copied().collect()))
    };
    ["R", "G", "B"].into_iter().enumerate().map(channel).collect()
}

/// V-Ray 4's: right, backward, down, and the place in the scene's units.
fn attributes(pose: &Pose, fov_x_deg: f32) -> LayerAttributes {
    let m = pose.world_from_camera;
    let p = pose.position / f64::from(UNIT);
    let rows = [(m.x_axis, 0.0), (m.z_axis, 0.0), (-m.y_axis, 0.0), (p, 1.0)];
    let matrix: Vec<f32> = rows.iter().flat_map(|(v, w)| [v.x as f32, v.y as f32, v.z as f32, *w]).collect();
    let mut attributes = LayerAttributes::default();
    let mut put = |name: &str, value| drop(attributes.other.insert(Text::new_or_panic(name), value));
    put("cameraTransform", AttributeValue::Matrix4x4(matrix.try_into().unwrap()));
    put("cameraFov", AttributeValue::F32(fov_x_deg));
    put("vrayInfo/vraycore", AttributeValue::Text(Text::new_or_panic("4.20.01")));
    attributes
}

/// Largest difference of two layers, relative where values are above 1; NaN are the same.
fn differ(a: &Values, b: &Values) -> f64 {
    let off = |i: usize| match (a.get(i), b.get(i)) {
        (a, b) if a.is_nan() && b.is_nan() => 0.0,
        (a, b) => (a - b).abs() / a.abs().max(1.0),
    };
    (0..a.len()).map(off).fold(0.0, |most: f64, v| if v.is_nan() { f64::INFINITY } else { most.max(v) })
}

#[test]
fn v_rays_images_become_the_frames_that_our_renderer_writes() {
    let dir = folder();
    let d = dir.path();
    prepare(d);
    let (own, data) = (Dataset::open(d.join("own")).unwrap(), Dataset::open(d.join("data")).unwrap());
    let poses = own.read_trajectory("room", "cam_00").unwrap().poses;
    let fov_x_deg = own.read_camera("room", "cam_00").unwrap().projection.fov_x_rad(3.0).to_degrees() as f32;
    let layers: Vec<Layer> =
        LAYERS.iter().filter(|spec| matches!(spec.pass, Pass::Final | Pass::Geometry)).map(|spec| spec.layer).collect();
    let rendered: Vec<Frame> = poses.iter().map(|pose| own.read_frame("room", "cam_00", pose.frame, &layers).unwrap()).collect();
    for (frame, pose) in rendered.iter().zip(&poses) {
        render_as_v_ray(d, frame, pose, fov_x_deg, pose.frame);
    }
    let said = succeed(d, &["vray", "collect", "data", "--job", "job/job.json"]);
    assert!(said.contains("room/cam_00: 3 frames written"), "{said}");
    for (frame, pose) in rendered.iter().zip(&poses) {
        let found = data.read_frame("room", "cam_00", pose.frame, &layers).unwrap();
        for &layer in &layers {
            let (ours, theirs) = (frame.get(layer).unwrap(), found.get(layer).unwrap());
            let bound = match layer {
                Layer::ColorStandardError => {
                    assert!((0..theirs.len()).all(|i| theirs.get(i).is_nan()));
                    continue;
                }
                // What is subtracted and added again is rounded twice, and normals of 11 bits get unit length once more.
                Layer::Residual => 1e-3,
                Layer::NormalWorld | Layer::NormalCam | Layer::NormalBumpWorld | Layer::NormalBumpCam => 1e-3,
                Layer::DepthMeters | Layer::DepthZMeters => 1e-6,
                _ => 0.0,
            };
            assert!(differ(ours, theirs) <= bound, "{} differs by {} in frame {}", layer.spec().name, differ(ours, theirs), pose.frame);
        }
    }
    // Everything that follows rendering works on them, and the laws hold.
    for verb in ["label", "boxes", "preview", "stats"] {
        succeed(d, &[verb, "data"]);
    }
    let card = succeed(d, &["verify", "data"]);
    assert!(card.contains("laws hold over 3 frames"), "{card}");
    let before = contents(&d.join("data"));
    assert!(succeed(d, &["vray", "collect", "data", "--job", "job/job.json"]).contains("0 frames written, 3 kept"));
    common::assert_same(&before, &contents(&d.join("data")));
}

#[test]
fn images_of_something_else_are_refused() {
    let dir = folder();
    let d = dir.path();
    prepare(d);
    let own = Dataset::open(d.join("own")).unwrap();
    let poses = own.read_trajectory("room", "cam_00").unwrap().poses;
    let layers: Vec<Layer> =
        LAYERS.iter().filter(|spec| matches!(spec.pass, Pass::Final | Pass::Geometry)).map(|spec| spec.layer).collect();
    let frame = own.read_frame("room", "cam_00", 0, &layers).unwrap();
    let collect = ["vray", "collect", "data", "--job", "job/job.json"];
    let refused = |more: &[&str], words: &[&str]| drop(fail(d, &[collect.as_slice(), more].concat(), 2, words));
    refused(&[], &["scene_cam_00_geometry", "name the folder"]);
    render_as_v_ray(d, &frame, &poses[1], 60.0, 0);
    refused(&[], &["frame.0000.exr", "its camera stood at", "--ignore-camera"]);
    render_as_v_ray(d, &frame, &poses[0], 30.0, 0);
    refused(&[], &["its camera sees 30 degrees"]);
    let warned = fail(d, &[collect.as_slice(), &["--ignore-camera"]].concat(), 0, &["header's camera is not the trajectory's"]);
    assert!(warned.contains("1 frame written; 2 of the trajectory have no image, frame 1 first"), "{warned}");
    fs::remove_file(d.join("job/images/scene_cam_00_final/frame.0000.exr")).unwrap();
    fs::write(d.join("job/images/scene_cam_00_final/frame.0001.exr"), "no image").unwrap();
    refused(&[], &["has no image of the final pass"]);
    refused(&["--camera", "cam_07"], &["has no such camera", "cam_00"]);
    refused(&["--fov-deg", "60"], &["--job", "cannot be used"]);
    assert!(fs::read_to_string(d.join("job/render.sh")).unwrap().contains("\"$IMAPVIEWER\" '-incremental'"));
    let pre = fs::read_to_string(d.join("job/vrscenes/scene_cam_00_pre.vrscene")).unwrap();
    assert!(pre.contains("auto_save_file=\"/mnt/job/shared/scene_cam_00/_hypersim_light_cache.%04d.vrlmap\""), "{pre}");
}
