//! V-Ray's images into a dataset: a room that our own renderer rendered is written as V-Ray writes images, and read back.

use enfilade_dataset::Dataset;
use enfilade_frame::{Frame, LAYERS, Layer, Pass, Values};
use enfilade_pipeline::{Config, Overrides, Silent, Stage, run, run_stage, verify};
use enfilade_scene::{Pose, Quiet};
use enfilade_vray::edit::{add_color_channels, add_geometry_channels};
use enfilade_vray::{CameraWish, CollectConfig, Job, JobConfig, collect, read_job, read_scene, write_job};
use exr::prelude::{AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, LayerAttributes, Text, WritableImage};
use std::fs;
use std::path::{Path, PathBuf};

/// Metres per unit of V-Ray's scene.
const UNIT: f32 = 0.5;
/// V-Ray's nodes with the row of their object, in another order than the room's parts; the rail is none of them.
const NODES: [(&str, i64); 4] = [("lamp", 2), ("rail", -1), ("room", 0), ("table", 1)];

/// A closed room (y up) with a table and a lamp.
fn write_room(folder: &Path) {
    let mut obj = "mtllib room.mtl\n".to_string();
    let blocks = [
        ("room", "wall", [-2.0, 0.0, -1.5], [2.0, 2.5, 1.5], true),
        ("table", "wood", [-0.9, 0.0, -1.2], [0.3, 0.7, -0.6], false),
        ("lamp", "light", [-0.3, 2.3, -0.3], [0.3, 2.4, 0.3], false),
    ];
    for (n, (object, material, min, max, inward)) in blocks.into_iter().enumerate() {
        obj += &format!("o {object}\nusemtl {material}\n");
        for i in 0..8 {
            let pick = |axis: usize| if i >> axis & 1 == 0 { min[axis] } else { max[axis] };
            obj += &format!("v {} {} {}\n", pick(0), pick(1), pick(2));
        }
        for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            let mut corners = face.map(|i: usize| (8 * n + i + 1).to_string());
            if inward {
                corners.reverse();
            }
            obj += &format!("f {}\n", corners.join(" "));
        }
    }
    fs::write(folder.join("room.obj"), obj).unwrap();
    let mtl = "newmtl wall\nKd 0.7 0.7 0.7\nnewmtl wood\nKd 0.4 0.25 0.1\nnewmtl light\nKd 0 0 0\nKe 12 11 10\n";
    fs::write(folder.join("room.mtl"), mtl).unwrap();
}

const CONFIG: &str = "seed = 3\nframes = 2\n[render]\nsize = [48, 36]\nsamples = 2\nmax_bounces = 3\n[carve]\nrays = 8192\niterations = 2\n\
    [[scene]]\nname = \"room\"\nfile = \"room.obj\"\ncameras = [{ position = [0.2, -0.9, 1.4], look_at = [0.0, 0.9, 0.6] }]\n";

/// A room in `own` with frames of our renderer, the same in `data` without, and V-Ray's job in `job`.
struct Prepared {
    _folder: tempfile::TempDir,
    data: PathBuf,
    job: PathBuf,
    fov_x_deg: f32,
    poses: Vec<Pose>,
    frames: Vec<Frame>,
}

fn prepare() -> Prepared {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    write_room(folder.path());
    fs::write(at("room.toml"), CONFIG).unwrap();
    let config = Config::read(&at("room.toml"), &Overrides::default()).unwrap();
    for out in ["own", "data"] {
        let done = run(&config, &at(out), None, &Silent).unwrap();
        assert!(done.ok(), "{:?}", done.scenes[0].failure.as_ref().map(|f| &f.message));
    }
    fs::remove_dir_all(at("data/scenes/room/images")).unwrap();
    fs::remove_dir_all(at("data/scenes/room/_detail/cam_00/frames")).unwrap();
    fs::create_dir(at("data/scenes/room/_detail/cam_00/frames")).unwrap();
    let own = Dataset::open(at("own")).unwrap();
    let objects: Vec<String> = own.read_nodes("room").unwrap().into_iter().map(|node| node.object_name).collect();
    let mut table = "node_id,node_name,object_id,object_name\n".to_string();
    for (i, (name, object)) in NODES.iter().enumerate() {
        let object_name = usize::try_from(*object).map_or("_NULL_OBJECT", |row| &objects[row]);
        table += &format!("{},{name}@node,{object},{object_name}\n", i + 1);
    }
    fs::write(at("nodes.csv"), table).unwrap();
    fs::write(at("room.vrscene"), format!("SettingsUnitsInfo u {{ meters_scale={UNIT}; }}\nRenderView v {{ fov=1; }}\n")).unwrap();
    let mut scene = read_scene(&at("room.vrscene")).unwrap();
    let of = JobConfig {
        scene: "room".into(),
        cameras: Vec::new(),
        wish: CameraWish::default(),
        folder_when_rendering: "/mnt/job".into(),
        nodes: at("nodes.csv"),
        keep_quality: false,
    };
    let data = Dataset::open(at("data")).unwrap();
    let bare = write_job(&scene, &at("room.vrscene"), &data, &of, &at("job"), &Quiet).unwrap_err().to_string();
    assert!(bare.contains("the scene has no RenderChannelExtraTex"), "{bare}");
    add_geometry_channels(&mut scene);
    add_color_channels(&mut scene);
    write_job(&scene, &at("room.vrscene"), &data, &of, &at("job"), &Quiet).unwrap();
    let poses = own.read_trajectory("room", "cam_00").unwrap().poses;
    let frames = poses.iter().map(|pose| own.read_frame("room", "cam_00", pose.frame, &rendered()).unwrap()).collect();
    let fov_x_deg = own.read_camera("room", "cam_00").unwrap().projection.fov_x_rad(3.0).to_degrees() as f32;
    Prepared { data: at("data"), job: at("job"), _folder: folder, fov_x_deg, poses, frames }
}

/// The layers that a renderer writes.
fn rendered() -> Vec<Layer> {
    LAYERS.iter().filter(|spec| matches!(spec.pass, Pass::Final | Pass::Geometry)).map(|spec| spec.layer).collect()
}

/// Settings of the job's only camera.
fn of_job(folder: &Path) -> CollectConfig {
    let Job { scene, cameras, meters_per_unit, nodes, .. } = read_job(&folder.join("job.json")).unwrap();
    let camera = &cameras[0];
    CollectConfig {
        scene,
        camera: camera.camera.clone(),
        geometry: folder.join(&camera.geometry),
        beauty: folder.join(&camera.beauty),
        nodes: Some(folder.join(nodes)),
        meters_per_unit,
        wish: CameraWish::default(),
        ignore_camera: false,
        force: false,
    }
}

/// Takes V-Ray's place: writes the images of both passes of a frame of `own` into the job.
fn render_as_v_ray(job: &Path, frame: &Frame, pose: &Pose, fov_x_deg: f32, number: u32) {
    let value = |layer: Layer, i: usize| frame.get(layer).unwrap().get(i) as f32;
    let all = |layer: Layer, of: &dyn Fn(f32) -> f32| (0..3 * frame.pixels()).map(|i| of(value(layer, i))).collect::<Vec<f32>>();
    let known = |v: f32| if v.is_nan() { 0.0 } else { v };
    let id = |i: usize| match value(Layer::RenderEntityId, i) {
        -1.0 => u32::MAX,
        part => 1 + NODES.iter().position(|(_, object)| *object == part as i64 - 1).unwrap() as u32,
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
    for part in ["VRayReflection", "VRayRefraction", "VRaySSS2", "VRaySelfIllumination", "VRayCaustics", "VRayAtmosphere", "VRayBackground"]
    {
        beauty.extend(triple(part, &vec![0.0; 3 * frame.pixels()]));
    }
    for (pass, channels) in [("geometry", geometry), ("final", beauty)] {
        let path = job.join(format!("images/scene_cam_00_{pass}/frame.{number:04}.exr"));
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        let size = (frame.width as usize, frame.height as usize);
        let layer = exr::prelude::Layer::new(
            size,
            attributes(pose, fov_x_deg),
            Encoding::SMALL_LOSSLESS,
            AnyChannels::sort(channels.into_iter().collect()),
        );
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
    let Prepared { _folder, data, job, fov_x_deg, poses, frames } = prepare();
    for (frame, pose) in frames.iter().zip(&poses) {
        render_as_v_ray(&job, frame, pose, fov_x_deg, pose.frame);
    }
    let done = collect(&data, &of_job(&job), &Quiet).unwrap();
    assert_eq!((done.written, done.kept, done.missing.len()), (2, 0, 0));
    let dataset = Dataset::open(&data).unwrap();
    for (frame, pose) in frames.iter().zip(&poses) {
        let found = dataset.read_frame("room", "cam_00", pose.frame, &rendered()).unwrap();
        for layer in rendered() {
            let (ours, theirs) = (frame.get(layer).unwrap(), found.get(layer).unwrap());
            let bound = match layer {
                Layer::ColorStandardError => {
                    assert!((0..theirs.len()).all(|i| theirs.get(i).is_nan()));
                    continue;
                }
                // Values that are subtracted and added again are rounded twice, and normals of 11 bits are normalised again.
                Layer::Color | Layer::Residual => 1e-3,
                Layer::NormalWorld | Layer::NormalCam | Layer::NormalBumpWorld | Layer::NormalBumpCam => 1.5e-3,
                Layer::DepthMeters | Layer::DepthZMeters => 1e-6,
                _ => 0.0,
            };
            let off = differ(ours, theirs);
            assert!(off <= bound, "{} differs by {off} in frame {}", layer.spec().name, pose.frame);
        }
    }
    // The stages after rendering work on them, and the laws are satisfied.
    for stage in [Stage::Label, Stage::Boxes, Stage::Preview] {
        let done = run_stage(&data, stage, None, false, &Silent).unwrap();
        assert!(done.ok(), "{:?}", done.scenes[0].failure.as_ref().map(|f| &f.message));
    }
    let card = verify(&dataset, &["room".to_string()], &Quiet).unwrap();
    assert!(card.passed, "{}", card.to_text());
    let again = collect(&data, &of_job(&job), &Quiet).unwrap();
    assert_eq!((again.written, again.kept), (0, 2));
    assert_eq!(dataset.frame_record("room", "cam_00", 0).unwrap().unwrap().recipe.unwrap().program, "V-Ray 4.20.01");
}

#[test]
fn images_of_something_else_are_refused() {
    let Prepared { _folder, data, job, fov_x_deg, poses, frames } = prepare();
    let config = of_job(&job);
    let message = |config: &CollectConfig| collect(&data, config, &Quiet).unwrap_err().to_string();
    assert!(message(&config).contains("cannot read the folder"));
    render_as_v_ray(&job, &frames[0], &poses[1], fov_x_deg, 0);
    assert!(message(&config).contains("its camera stood at"));
    render_as_v_ray(&job, &frames[1], &poses[0], fov_x_deg, 0);
    assert!(message(&config).contains("pixels off the rays of the dataset's camera"));
    render_as_v_ray(&job, &frames[0], &poses[0], 30.0, 0);
    assert!(message(&config).contains("its camera sees 30"));
    let lenient = collect(&data, &CollectConfig { ignore_camera: true, ..config.clone() }, &Quiet).unwrap();
    assert_eq!(lenient.summary(), "1 frame written; 1 of the trajectory have no image, frame 1 first");
    assert!(
        message(&CollectConfig { wish: CameraWish { fov_x_deg: Some(80.0), ..CameraWish::default() }, ..config.clone() })
            .contains("another camera than the dataset's")
    );
    fs::rename(config.beauty.join("frame.0000.exr"), config.beauty.join("frame.0001.exr")).unwrap();
    assert!(message(&config).contains("has no image of the final pass"));
    let script = fs::read_to_string(job.join("render.sh")).unwrap();
    assert!(script.contains("\"$IMAPVIEWER\" '-incremental' '-load' '/mnt/job/shared/scene_cam_00/_hypersim_light_cache.0000.vrlmap'"));
    let pre = fs::read_to_string(job.join("vrscenes/scene_cam_00_pre.vrscene")).unwrap();
    assert!(pre.contains("auto_save_file=\"/mnt/job/shared/scene_cam_00/_hypersim_light_cache.%04d.vrlmap\""), "{pre}");
}
