//! Scenes that move, against formulas: a door that turns, a box that falls, a chain that swings, a wheel that rolls.

use crate::common::{LAMP, WALL, block, write_blocks};
use enfilade_dataset::{Dataset, FilmedBodies, FrameBodies, ViewVerdict};
use enfilade_frame::{Layer, traits, vector};
use enfilade_math::{DAffine3, DMat3, DVec3};
use enfilade_pipeline::{Config, FlowPairs, FrameChoice, MakeOptions, Overrides, PairsRequest, Request, Silent, make, replay, run};
use enfilade_scene::{CameraView, Quiet};
use enfilade_verify::{Law, verify_scene};
use std::fmt::Write;
use std::path::Path;

const FRAMES: u32 = 4;
/// Part of each body, as `render_entity_id` numbers it.
const PARTS: [(&str, i64); 5] = [("door", 3), ("box", 4), ("upper", 5), ("lower", 6), ("wheel", 7)];
const WHEEL_RADIUS_M: f64 = 0.25;

/// The way of a body from rest at a moment, by formula.
fn expected(body: &str, t: f64) -> DAffine3 {
    let about = |point: DVec3, axis: DVec3, angle: f64| {
        DAffine3::from_translation(point) * DAffine3::from_axis_angle(axis, angle) * DAffine3::from_translation(-point)
    };
    let swing = |t: f64| 0.5 * (1.1 * t).sin();
    let upper = about(DVec3::new(0.0, 1.2, 2.2), DVec3::Y, swing(t));
    match body {
        "door" => about(DVec3::new(-1.9, 1.0, 0.0), DVec3::Z, t * 0.25),
        "box" => DAffine3::from_translation(DVec3::NEG_Z * (0.5 * 0.2 * t * t)),
        "upper" => upper,
        "lower" => upper * about(DVec3::new(0.0, 1.2, 1.7), DVec3::Y, 2.0 * swing(t)),
        "wheel" => {
            let way = 0.3 * t;
            let roll = about(DVec3::new(0.9, 0.4, WHEEL_RADIUS_M), DVec3::Y, way / WHEEL_RADIUS_M);
            DAffine3::from_translation(DVec3::X * way) * roll
        }
        _ => unreachable!("{body}"),
    }
}

fn config(folder: &Path) -> Config {
    let thing = |name, min, max| block(name, min, max, [0.6, 0.4, 0.3]);
    let blocks = [
        WALL,
        LAMP,
        thing("door", [-1.9, 1.0, 0.1], [-1.2, 1.05, 2.0]),
        thing("box", [-0.9, 0.2, 1.2], [-0.6, 0.5, 1.5]),
        thing("upper", [-0.05, 1.15, 1.7], [0.05, 1.25, 2.2]),
        thing("lower", [-0.05, 1.15, 1.2], [0.05, 1.25, 1.7]),
        thing("wheel", [0.65, 0.35, 0.0], [1.15, 0.45, 0.5]),
    ];
    write_blocks(folder, &blocks);
    let path = "frame,position_x,position_y,position_z,look_at_x,look_at_y,look_at_z,roll_deg\n\
                0,-0.2,-1.3,1.4,0.0,1.0,1.0,0\n3,0.2,-1.2,1.3,-0.1,1.0,1.0,0\n";
    std::fs::write(folder.join("path.csv"), path).unwrap();
    let mut text = String::from(
        "seed = 3\n[render]\nsize = [64, 48]\nsamples = 1\nmax_bounces = 1\nextra = true\n[carve]\nrays = 8192\niterations = 2\n[gate]\naction = \"report\"\n\
         [[scene]]\nname = \"room\"\nfile = \"room.obj\"\nup_axis = \"z\"\n[scene.plan]\nmode = { kind = \"keyframes\", files = [\"path.csv\"] }\n",
    );
    let list = |state: &dyn Fn(f64) -> String| (0..FRAMES).map(|t| state(f64::from(t))).collect::<Vec<_>>().join(", ");
    let swing = |t: f64| (0.5 * (1.1 * t).sin()).to_degrees();
    let times = list(&|t| t.to_string());
    let mut motion = |keys: String| writeln!(text, "[[scene.motion]]\ntimes_s = [{times}]\n{keys}").unwrap();
    // Two states are enough for what moves evenly.
    motion(format!("of = \"door\"\npoint_m = [-1.9, 1.0, 0.0]\nangles_deg = [{}]", list(&|t| (t * 0.25f64).to_degrees().to_string())));
    motion(format!("of = \"box\"\nmoved_m = [{}]", list(&|t| format!("[0.0, 0.0, {:?}]", -0.1 * t * t))));
    motion(format!("of = \"upper\"\naxis = [0, 1, 0]\npoint_m = [0.0, 1.2, 2.2]\nangles_deg = [{}]", list(&|t| swing(t).to_string())));
    motion(format!(
        "of = \"lower\"\non = \"upper\"\naxis = [0, 1, 0]\npoint_m = [0.0, 1.2, 1.7]\nangles_deg = [{}]",
        list(&|t| (2.0 * swing(t)).to_string())
    ));
    motion(format!(
        "of = \"wheel\"\npoint_m = [0.9, 0.4, 0.25]\nmoved_m = [{}]\nturned_deg = [{}]",
        list(&|t| format!("[{:?}, 0.0, 0.0]", 0.3 * t)),
        list(&|t| format!("[0.0, {:?}, 0.0]", (0.3 * t / WHEEL_RADIUS_M).to_degrees()))
    ));
    std::fs::write(folder.join("dataset.toml"), text).unwrap();
    Config::read(&folder.join("dataset.toml"), &Overrides::default()).unwrap()
}

#[test]
fn what_moves_is_where_formulas_say_and_every_law_holds() {
    let folder = tempfile::tempdir().unwrap();
    let (config, out) = (config(folder.path()), folder.path().join("out"));
    let summary = run(&config, &out, None, &Silent).unwrap();
    let failures: Vec<_> = summary.scenes.iter().filter_map(|s| s.failure.as_ref().map(|f| f.message.clone())).collect();
    assert!(summary.ok(), "{failures:?}");
    assert!(run(&config, &out, None, &Silent).unwrap().nothing_done());

    let dataset = Dataset::open(&out).unwrap();
    let bodies = dataset.read_filmed_bodies("room", "cam_00").unwrap().unwrap();
    poses_are_as_expected(&bodies);
    let mut compared = 0;
    for frame in 0..FRAMES {
        compared += flow_is_as_expected(&dataset, frame);
    }
    assert!(compared > 1000, "{compared} pixels show something that moves");

    // Every relation between frames agrees with stored distances, parts and poses.
    let requests = [
        Request::Flow { pairs: FlowPairs::Step(1), cameras: None },
        Request::Flow { pairs: FlowPairs::Step(-1), cameras: None },
        Request::Tracks { points: 64, seed: 0, of: FrameChoice::default() },
        Request::Pairs(PairsRequest::default()),
        Request::Surfaces { layers: 3, of: FrameChoice::default() },
    ];
    make(&dataset, &["room".into()], &requests, MakeOptions::default(), &Quiet).unwrap();
    let report = verify_scene(&dataset, "room", &Quiet).unwrap();
    assert_eq!(report.failures().map(|law| format!("{:?} {:?}", law.law, law.worst)).collect::<Vec<_>>(), Vec::<String>::new());

    // Poses that are not those of the frames break laws.
    let stored: Vec<FrameBodies> = bodies.frames().cloned().collect();
    let still = |frame: &FrameBodies| FrameBodies { world_from_rest: vec![DAffine3::IDENTITY; PARTS.len()], ..frame.clone() };
    dataset.write_body_poses("room", "cam_00", &stored.iter().map(still).collect::<Vec<_>>()).unwrap();
    let broken: Vec<Law> = verify_scene(&dataset, "room", &Quiet).unwrap().failures().map(|law| law.law).collect();
    for law in [Law::TwoViewDistance, Law::PairFlow, Law::TrackPoints] {
        assert!(broken.contains(&law), "{law:?}: {broken:?}");
    }
    dataset.write_body_poses("room", "cam_00", &stored).unwrap();

    // A frame comes to the same bytes when it is rendered once more.
    let again = replay(&dataset.layout().frame_record("room", "cam_00", 2), None, &Quiet).unwrap();
    assert!(again.is_same(), "{:?}", again.files);
}

fn poses_are_as_expected(bodies: &FilmedBodies) {
    assert_eq!(bodies.bodies[3].parent, Some(3));
    for listed in bodies.frames() {
        for (body, map) in bodies.bodies.iter().zip(&listed.world_from_rest) {
            let expected = expected(&body.name, f64::from(listed.frame));
            assert!(map.abs_diff_eq(expected, 1e-12), "{} in frame {}: {map:?}, expected {expected:?}", body.name, listed.frame);
        }
    }
}

/// Compares flow, scene flow and the mark of what moves with the formulas; returns the number of pixels that show something that moves.
fn flow_is_as_expected(dataset: &Dataset, number: u32) -> usize {
    let layers = [Layer::Position, Layer::RenderEntityId, Layer::OpticalFlow, Layer::SceneFlow, Layer::SurfaceTraits, Layer::DepthMeters];
    let frame = dataset.read_frame("room", "cam_00", number, &layers).unwrap();
    let [entities, flows, scene_flows, kinds, distances] =
        [Layer::RenderEntityId, Layer::OpticalFlow, Layer::SceneFlow, Layer::SurfaceTraits, Layer::DepthMeters]
            .map(|l| frame.get(l).unwrap());
    let camera = dataset.read_camera("room", "cam_00").unwrap();
    let poses = dataset.read_trajectory("room", "cam_00").unwrap().poses;
    let view = |index: usize| CameraView::of_frame(&camera, &poses, index);
    let mut compared = 0;
    for pixel in 0..frame.pixels() {
        let body = PARTS.iter().find(|(_, part)| *part == entities.get(pixel) as i64);
        assert_eq!(kinds.get(pixel) as u8 & traits::MOVES != 0, body.is_some());
        let Some((body, _)) = body else { continue };
        if number + 1 == FRAMES {
            assert!(flows.get(2 * pixel).is_nan());
            continue;
        }
        let (x, y) = ((pixel % 64) as f64 + 0.5, (pixel / 64) as f64 + 0.5);
        let [from, to] = [view(number as usize), view(number as usize + 1)];
        let ray = from.centre_ray(x, y).unwrap();
        let p = ray.origin + ray.direction * distances.get(pixel);
        let [here, there] = [number, number + 1].map(|frame| expected(body, f64::from(frame)));
        let then = there.transform_point3(here.inverse().transform_point3(p));
        let (to_x, to_y) = to.project(then).unwrap();
        assert!((flows.get(2 * pixel) - (to_x - x)).hypot(flows.get(2 * pixel + 1) - (to_y - y)) < 1e-3, "{body}");
        let in_camera = |view: &CameraView<'_>, p: DVec3| DMat3::transpose(&view.pose().world_from_camera) * (p - view.pose().position);
        let moved: DVec3 = vector(scene_flows, pixel);
        assert!(moved.distance(in_camera(&to, then) - in_camera(&from, p)) < 1e-5, "{body}: {moved}");
        compared += 1;
    }
    compared
}

/// A panel slides past a camera with an open shutter: the share of the exposure in which it covers a pixel is the share of its colour there.
#[test]
fn what_moves_while_the_shutter_is_open_is_blurred() {
    let (speed, exposure_s, left, right, depth) = (0.8, 0.5, -0.9, -0.6, 0.5);
    let folder = tempfile::tempdir().unwrap();
    let panel = block("panel", [left, depth, 0.7], [right, depth + 0.01, 1.3], [0.1, 0.1, 0.1]);
    write_blocks(folder.path(), &[WALL, LAMP, panel]);
    let path = "frame,position_x,position_y,position_z,look_at_x,look_at_y,look_at_z,roll_deg\n0,0,-1.3,1,0,1,1,0\n1,0,-1.3,1,0,1,1,0\n";
    std::fs::write(folder.path().join("path.csv"), path).unwrap();
    let text = format!(
        "seed = 3\n[render]\nsize = [64, 48]\nsamples = 64\nadaptive = false\nmax_bounces = 1\nfilter = \"box\"\n[gate]\naction = \"report\"\n\
         [carve]\nrays = 8192\niterations = 2\n[[scene]]\nname = \"room\"\nfile = \"room.obj\"\nup_axis = \"z\"\n\
         camera = {{ shutter = {{ exposure_s = {exposure_s}, frame_time_s = 1.0 }} }}\n\
         [scene.plan]\nmode = {{ kind = \"keyframes\", files = [\"path.csv\"] }}\n\
         [[scene.motion]]\nof = \"panel\"\ntimes_s = [0, 2]\nmoved_m = [[0, 0, 0], [{}, 0, 0]]\n",
        2.0 * speed
    );
    std::fs::write(folder.path().join("dataset.toml"), text).unwrap();
    let (config, out) = (Config::read(&folder.path().join("dataset.toml"), &Overrides::default()).unwrap(), folder.path().join("out"));
    assert!(run(&config, &out, None, &Silent).unwrap().ok());

    let dataset = Dataset::open(&out).unwrap();
    let camera = dataset.read_camera("room", "cam_00").unwrap();
    let poses = dataset.read_trajectory("room", "cam_00").unwrap().poses;
    let frame = dataset.read_frame("room", "cam_00", 1, &[Layer::DiffuseReflectance]).unwrap();
    let reflectance = frame.get(Layer::DiffuseReflectance).unwrap();
    let view = CameraView::of_frame(&camera, &poses, 1);
    let plane_x = |x: f64| {
        let ray = view.centre_ray(x, 24.5).unwrap();
        ray.origin.x + ray.direction.x * (depth - ray.origin.y) / ray.direction.y
    };
    let mut partly = 0;
    for column in 0..64 {
        // The share of the moments at which the panel covers points of the pixel, in steps.
        let covers = |step: usize| {
            let (share, time_s) = (((step % 32) as f64 + 0.5) / 32.0, 1.0 + exposure_s * (((step / 32) as f64 + 0.5) / 256.0 - 0.5));
            let at_rest = plane_x(f64::from(column) + share) - speed * time_s;
            (left..right).contains(&at_rest)
        };
        let share = (0..32 * 256).filter(|&step| covers(step)).count() as f64 / (32.0 * 256.0);
        let found = (0.7 - reflectance.get(3 * (24 * 64 + column as usize))) / 0.6;
        assert!((found - share).abs() < 0.1, "column {column}: {found}, expected {share}");
        partly += u32::from((0.1..0.9).contains(&share));
    }
    assert!(partly > 8, "{partly}");
    // Its geometry is that of the frame's own moment.
    let bodies = dataset.read_filmed_bodies("room", "cam_00").unwrap().unwrap();
    assert!((bodies.frames().nth(1).unwrap().world_from_rest[0].translation.x - speed).abs() < 1e-12);
    assert!(replay(&dataset.layout().frame_record("room", "cam_00", 1), None, &Quiet).unwrap().is_same());
}

/// A board that comes to stand before the camera hides everything in the second frame; the first one and the third see the room.
#[test]
fn views_are_judged_at_their_own_moment() {
    let folder = tempfile::tempdir().unwrap();
    let board = block("board", [-1.9, -1.25, 0.0], [-1.0, -1.24, 2.0], [0.1, 0.1, 0.1]);
    write_blocks(folder.path(), &[WALL, LAMP, board]);
    let path = "frame,position_x,position_y,position_z,look_at_x,look_at_y,look_at_z,roll_deg\n0,0.5,-1.3,1,-1.5,1.0,0.4,0\n2,0.5,-1.3,1,-1.5,1.0,0.4,0\n";
    std::fs::write(folder.path().join("path.csv"), path).unwrap();
    let text = "[render]\nsize = [64, 48]\nsamples = 1\n[carve]\nrays = 8192\niterations = 2\n[[scene]]\nname = \"room\"\nfile = \"room.obj\"\n\
                up_axis = \"z\"\n[scene.plan]\nmode = { kind = \"keyframes\", files = [\"path.csv\"] }\n\
                [[scene.motion]]\nof = \"board\"\ntimes_s = [0, 1, 2]\nmoved_m = [[0, 0, 0], [1.9, 0, 0], [0, 0, 0]]\n";
    std::fs::write(folder.path().join("dataset.toml"), text).unwrap();
    let (config, out) = (Config::read(&folder.path().join("dataset.toml"), &Overrides::default()).unwrap(), folder.path().join("out"));
    let summary = run(&config, &out, None, &Silent).unwrap();
    assert!(summary.ok(), "{:?}", summary.scenes);
    let judged = Dataset::open(&out).unwrap().read_view_gates("room", "cam_00").unwrap().unwrap();
    assert_eq!(judged.iter().map(|view| view.verdict == ViewVerdict::Passed).collect::<Vec<_>>(), [true, false, true], "{judged:?}");
}
