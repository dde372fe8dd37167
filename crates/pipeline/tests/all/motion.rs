//! Scenes that move, against formulas: a door that turns, a box that falls, a chain that swings, a wheel that rolls.

use crate::common::{LAMP, WALL, assert_made, assert_related, block, write_blocks};
use enfilade_dataset::{Dataset, FilmedBodies, FrameBodies, ViewVerdict};
use enfilade_frame::{Layer, traits, vector};
use enfilade_math::{DAffine3, DMat3, DVec3};
use enfilade_pipeline::{Config, FlowPairs, MakeOptions, Overrides, Request, Silent, make, replay, run};
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
    assert_made(&config, &out);
    assert!(run(&config, &out, None, &Silent).unwrap().nothing_done());

    let dataset = Dataset::open(&out).unwrap();
    let bodies = dataset.read_filmed_bodies("room", "cam_00").unwrap().unwrap();
    poses_are_as_expected(&bodies);
    let mut compared = 0;
    for frame in 0..FRAMES {
        compared += flow_is_as_expected(&dataset, frame);
    }
    assert!(compared > 1000, "{compared} pixels show something that moves");

    assert_related(&dataset, "room");

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

/// A panel passes a camera at rest whose rows are read one after the other: its edges lean by its speed times the time of a row, in the ids, in
/// the colour and in the places of its body, and every relation between frames holds. A box that falls is seen by each row at its own moment.
#[test]
fn rows_of_a_rolling_shutter_see_what_moves_at_their_own_moments() {
    let (speed, readout_s, frame_s, left, depth) = (3.0, 0.1, 0.2, -0.9, 0.5);
    let folder = tempfile::tempdir().unwrap();
    let panel = block("panel", [left, depth, 0.3], [left + 0.5, depth + 0.01, 1.9], [0.1, 0.1, 0.1]);
    let box_ = block("box", [0.9, 0.9, 1.3], [1.2, 1.2, 1.6], [0.5, 0.2, 0.1]);
    write_blocks(folder.path(), &[WALL, LAMP, panel, box_]);
    let path = "frame,position_x,position_y,position_z,look_at_x,look_at_y,look_at_z,roll_deg\n0,0,-1.3,1,0,1,1,0\n1,0,-1.3,1,0,1,1,0\n";
    std::fs::write(folder.path().join("path.csv"), path).unwrap();
    let text = format!(
        "seed = 3\n[render]\nsize = [64, 48]\nsamples = 16\nadaptive = false\nmax_bounces = 1\nfilter = \"box\"\nextra = true\n\
         [gate]\naction = \"report\"\n[carve]\nrays = 8192\niterations = 2\n[[scene]]\nname = \"room\"\nfile = \"room.obj\"\nup_axis = \"z\"\n\
         camera = {{ shutter = {{ exposure_s = 0.002, readout_s = {readout_s}, frame_time_s = {frame_s} }} }}\n\
         [scene.plan]\nmode = {{ kind = \"keyframes\", files = [\"path.csv\"] }}\n\
         [[scene.motion]]\nof = \"panel\"\ntimes_s = [-1, 1]\nmoved_m = [[{}, 0, 0], [{speed}, 0, 0]]\n\
         [[scene.motion]]\nof = \"box\"\ntimes_s = [-1, 1]\nmoved_m = [[0, 0, 2], [0, 0, -2]]\n",
        -speed
    );
    std::fs::write(folder.path().join("dataset.toml"), text).unwrap();
    let (config, out) = (Config::read(&folder.path().join("dataset.toml"), &Overrides::default()).unwrap(), folder.path().join("out"));
    assert_made(&config, &out);

    let dataset = Dataset::open(&out).unwrap();
    let layers = [Layer::RenderEntityId, Layer::DiffuseReflectance];
    let read = |frame| dataset.read_frame("room", "cam_00", frame, &layers).unwrap();
    // 60 degrees wide: pixels per metre on the panel's plane.
    let pixels_per_m = 32.0 / 30f64.to_radians().tan() / (depth + 1.3);
    for (number, frame) in [0, 1].map(|number| (number, read(number))) {
        let [ids, colors] = layers.map(|layer| frame.get(layer).unwrap());
        let edge_x = |row: usize| {
            let time_s = frame_s * f64::from(number) + readout_s * ((row as f64 + 0.5) / 48.0 - 0.5);
            32.0 + pixels_per_m * (left + speed * time_s)
        };
        let (mut rows, mut off) = (0, 0.0f64);
        for row in 12..40 {
            let row_of = |x: usize| row * 64 + x;
            let Some(first) = (0..64).find(|&x| ids.get(row_of(x)) == 3.0) else { panic!("frame {number} row {row} has no panel") };
            // The first pixel whose centre is on it; half of a band's step is a quarter of a pixel.
            let expected = edge_x(row);
            assert!((first as f64 - expected).abs() < 0.76, "frame {number} row {row}: {first}, expected {expected}");
            // Its colour ends there too: white outside, dark inside.
            let covered: f64 = (first.saturating_sub(3)..first + 4).map(|x| (0.7 - colors.get(3 * row_of(x))) / 0.6).sum();
            off += (first as f64 + 4.0 - covered - expected) / 28.0;
            rows += 1;
        }
        assert!(rows == 28 && off.abs() < 0.1, "frame {number}: the edge of the colour is off by {off} pixels");
        // Over these rows the edge leans by speed times row time: 5.4 pixels.
        assert!((edge_x(39) - edge_x(12) - 27.0 / 48.0 * readout_s * speed * pixels_per_m).abs() < 1e-9 && edge_x(39) - edge_x(12) > 5.0);
    }

    let bodies = dataset.read_filmed_bodies("room", "cam_00").unwrap().unwrap();
    let bands = bodies.bands(1);
    assert!(bands.len() > 15 && bands.len() % 2 == 1, "{} bands", bands.len());
    for band in bands {
        assert!((band.world_from_rest[0].translation.x - speed * band.time_s).abs() < 1e-12);
    }
    assert!((bodies.frames().nth(1).unwrap().time_s - frame_s).abs() < 1e-12);
    let step_s = bands.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).fold(0.0, f64::max);
    assert!(step_s * speed * pixels_per_m < 0.5 + 1e-9, "a band is {step_s} s long");

    assert_related(&dataset, "room");
    assert!(replay(&dataset.layout().frame_record("room", "cam_00", 1), None, &Quiet).unwrap().is_same());

    // One moment for all rows, as of a global shutter, is not what these frames show.
    let global: Vec<FrameBodies> = bodies.frames().map(|frame| FrameBodies { first_row: 0, ..frame.clone() }).collect();
    dataset.write_body_poses("room", "cam_00", &global).unwrap();
    let broken: Vec<Law> = verify_scene(&dataset, "room", &Quiet).unwrap().failures().map(|law| law.law).collect();
    assert!(broken.contains(&Law::PairFlow), "{broken:?}");
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

const CELL: &str = r#"<mujoco><compiler angle="radian"/><worldbody>
  <light type="point" pos="0 0 2.3" diffuse="1 1 1"/>
  <geom name="floor" type="box" size="2 1.5 .05" pos="0 0 -.05"/><geom name="ceiling" type="box" size="2 1.5 .05" pos="0 0 2.55"/>
  <geom name="east" type="box" size=".05 1.5 1.3" pos="2.05 0 1.25"/><geom name="west" type="box" size=".05 1.5 1.3" pos="-2.05 0 1.25"/>
  <geom name="north" type="box" size="2 .05 1.3" pos="0 1.55 1.25"/><geom name="south" type="box" size="2 .05 1.3" pos="0 -1.55 1.25"/>
  <geom name="post" type="box" size=".05 .05 .5" pos="0 0 .5"/><geom name="crate" type="box" size=".2 .2 .2" pos="1.4 .3 .2"/>
  <camera name="wall" pos="0 -1.3 1.5" xyaxes="1 0 0 0 .4 .9"/>
  <body name="arm" pos="0 0 1.1"><joint name="turn" axis="0 0 1" range="-3 3"/><geom name="link" type="box" size=".25 .03 .03" pos=".25 0 0"/>
   <geom name="finger" type="box" size=".02 .02 .02" pos=".75 .05 0"/><camera name="wrist" pos=".5 0 .15" xyaxes="0 -1 0 .3 0 1"/></body>
  </worldbody></mujoco>"#;

/// A camera on an arm that turns by formula films a room: its poses are the formula's, what turns with it does not move in its pictures, and
/// every law holds. A camera on the wall films with it and stays.
#[test]
fn cameras_on_bodies_film_as_they_ride() {
    let folder = tempfile::tempdir().unwrap();
    let angle = |t: f64| 0.8 * (3.0 * t).sin();
    let rows: String = (0..FRAMES).map(|n| f64::from(n) * (1.0 / 10.0)).map(|t| format!("{t:?},{:?}\n", angle(t))).collect();
    std::fs::write(folder.path().join("cell.xml"), CELL).unwrap();
    std::fs::write(folder.path().join("run.csv"), format!("time,turn\n{rows}")).unwrap();
    let text = format!(
        "seed = 3\nframes = {FRAMES}\n[render]\nsize = [64, 48]\nsamples = 1\nmax_bounces = 1\nextra = true\n[carve]\nrays = 8192\niterations = 2\n\
         [gate]\naction = \"report\"\n[plan]\nmode = {{ kind = \"cameras\", fps = 10 }}\n\
         [[scene]]\nname = \"cell\"\nfile = \"cell.xml\"\nstates = \"run.csv\"\ncameras = [\"wrist\", \"wall\"]\n"
    );
    std::fs::write(folder.path().join("dataset.toml"), text).unwrap();
    let (config, out) = (Config::read(&folder.path().join("dataset.toml"), &Overrides::default()).unwrap(), folder.path().join("out"));
    assert_made(&config, &out);

    let dataset = Dataset::open(&out).unwrap();
    assert!((dataset.read_frame_time("cell", "cam_00").unwrap() - 0.1).abs() < 1e-12);
    let [wrist, wall] = ["cam_00", "cam_01"].map(|camera| dataset.read_trajectory("cell", camera).unwrap().poses);
    assert_eq!((wrist.len(), wall.len()), (FRAMES as usize, FRAMES as usize));
    for (n, pose) in wrist.iter().enumerate() {
        let turn = DMat3::from_rotation_z(angle(0.1 * n as f64));
        let (position, up) = (turn * DVec3::new(0.5, 0.0, 0.15) + DVec3::Z * 1.1, turn * DVec3::new(0.3, 0.0, 1.0).normalize());
        assert!(pose.position.distance(position) < 1e-5, "frame {n}: {}, expected {position}", pose.position);
        assert!(pose.world_from_camera.y_axis.distance(up) < 1e-9, "frame {n}: {}", pose.world_from_camera);
        assert_eq!((wall[n].position, wall[n].world_from_camera), (wall[0].position, wall[0].world_from_camera));
    }

    // The finger is on the arm as the camera is: it stays where it is in the picture, while the room goes by.
    let finger = dataset.read_nodes("cell").unwrap().iter().position(|node| node.node_name == "finger").unwrap() as f64 + 1.0;
    let (mut on_arm, mut passing) = (0, 0);
    for number in 0..FRAMES - 1 {
        let frame = dataset.read_frame("cell", "cam_00", number, &[Layer::RenderEntityId, Layer::OpticalFlow, Layer::SceneFlow]).unwrap();
        let [entities, flow, scene_flow] =
            [Layer::RenderEntityId, Layer::OpticalFlow, Layer::SceneFlow].map(|layer| frame.get(layer).unwrap());
        for pixel in 0..frame.pixels() {
            let way_px = flow.get(2 * pixel).hypot(flow.get(2 * pixel + 1));
            if entities.get(pixel) == finger {
                assert!(way_px < 1e-3 && vector(scene_flow, pixel).length() < 1e-5, "frame {number}: {way_px} px");
                on_arm += 1;
            } else {
                passing += u32::from(way_px > 2.0);
            }
        }
    }
    assert!(on_arm > 20 && passing > 2000, "{on_arm} pixels of the finger, {passing} of what passes by");
    make(&dataset, &["cell".into()], &[Request::Flow { pairs: FlowPairs::Step(1), cameras: None }], MakeOptions::default(), &Quiet)
        .unwrap();
    let report = verify_scene(&dataset, "cell", &Quiet).unwrap();
    assert_eq!(report.failures().map(|law| format!("{:?} {:?}", law.law, law.worst)).collect::<Vec<_>>(), Vec::<String>::new());
}
