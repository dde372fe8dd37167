//! Homes in which things are open: free space, tables, layout, and motion by joints.

use crate::common::assert_made;
use enfilade_dataset::Dataset;
use enfilade_explore::{CarveConfig, FreeSpace, carve};
use enfilade_geometry::{Bvh, Voxel};
use enfilade_home::{Home, HomeConfig, RoomKind, State, StateWord, States, home};
use enfilade_math::DVec3;
use enfilade_pipeline::{Config, Overrides, Silent, run};
use enfilade_scene::{BodyStates, Quiet, WorldMesh};
use enfilade_verify::verify_scene;
use std::path::Path;

/// A hall and a bathroom behind a door.
fn hall_and_bathroom(word: StateWord) -> Home {
    let rooms = vec![RoomKind::Hall, RoomKind::Bathroom];
    home(&HomeConfig { rooms, clutter: 0.0, states: Some(States::All(State::Word(word))), ..HomeConfig::of_seed(2) })
}

/// The free space that the hall's cameras reach.
fn from_the_hall(home: &Home) -> FreeSpace {
    let world = WorldMesh::new(&home.scene);
    let bvh = Bvh::new(&world.corners, &|_| false);
    let starts: Vec<DVec3> = home.scene.cameras.iter().filter(|c| c.name.starts_with("hall_")).map(|c| c.position).collect();
    let config = CarveConfig { rays: 1 << 15, ..CarveConfig::default() };
    carve(&world, &bvh, &starts, &config, &Quiet).expect("the hall has free space")
}

/// The middle of the leaf of the only inner door.
fn leaf(home: &Home) -> DVec3 {
    let body = home.scene.bodies.iter().find(|body| body.name.ends_with("/leaf")).expect("an inner door");
    let [low, high] = home.scene.part_bounds(body.parts[0]);
    0.5 * (low + high)
}

#[test]
fn a_shut_door_ends_the_free_space_and_an_open_one_stands_in_it() {
    let [shut, open] = [StateWord::Closed, StateWord::Open].map(hall_and_bathroom);
    let [behind_shut, behind_open] = [&shut, &open].map(from_the_hall);
    // Where the bathroom's first camera is, nobody comes from the hall while the door is shut.
    let bathroom = open.scene.cameras.iter().find(|camera| camera.name == "bathroom_1").unwrap().position;
    assert_ne!(behind_shut.tree.state(bathroom), Voxel::Free);
    assert_eq!(behind_open.tree.state(bathroom), Voxel::Free);
    // The leaf stands where it is: in its opening, or in the way.
    let [in_frame, in_the_way] = [&shut, &open].map(leaf);
    assert!(in_frame.distance(in_the_way) > 0.3);
    assert_eq!([&in_frame, &in_the_way].map(|p| behind_shut.tree.state(*p) == Voxel::Occupied), [true, false]);
    assert_eq!([&in_frame, &in_the_way].map(|p| behind_open.tree.state(*p) == Voxel::Occupied), [false, true]);
}

fn write(folder: &Path, joint: &str) -> Config {
    let text = format!(
        "seed = 3\nframes = 2\n[render]\nsize = [64, 48]\nsamples = 1\nmax_bounces = 1\nextra = true\n[carve]\nrays = 8192\niterations = 2\n\
         [gate]\naction = \"report\"\n[plan]\nmode = {{ kind = \"video\", fps = 1 }}\n\
         [[scene]]\nname = \"bath\"\nhome = {{ seed = 2, rooms = [\"hall\", \"bathroom\"], clutter = 0 }}\ncameras = [\"bathroom_1\"]\n\
         [[scene.motion]]\njoint = \"{joint}\"\ntimes_s = [0, 1]\nopen = [0.25, 1]\n"
    );
    std::fs::write(folder.join("dataset.toml"), text).unwrap();
    Config::read(&folder.join("dataset.toml"), &Overrides::default()).unwrap()
}

#[test]
fn joints_of_homes_open_in_the_course_of_the_frames() {
    let folder = tempfile::tempdir().unwrap();
    let config = write(folder.path(), "toilet_*/lid");
    let out = folder.path().join("out");
    assert_made(&config, &out);
    let dataset = Dataset::open(&out).unwrap();
    let filmed = dataset.read_filmed_bodies("bath", "cam_00").unwrap().expect("something moves");
    let moving: Vec<&str> = filmed.bodies.iter().filter(|body| body.moves).map(|body| body.name.as_str()).collect();
    assert_eq!(moving, ["toilet_1/lid"]);
    let (lid, at) = filmed.bodies.iter().zip(0..).find(|(body, _)| body.moves).unwrap();
    let [closed, open] = lid.limits.unwrap();
    let states: Vec<f64> = filmed.frames().map(|frame| frame.states[at].unwrap()).collect();
    assert!((states[0] - (closed + 0.25 * (open - closed))).abs() < 1e-9 && (states[1] - open).abs() < 1e-9, "{states:?}");
    // The layout lists the same joints.
    let text = std::fs::read_to_string(dataset.layout().rooms("bath")).unwrap();
    let layout: serde_json::Value = serde_json::from_str(&text).unwrap();
    let joints = layout["joints"].as_array().unwrap();
    assert_eq!(joints.len(), filmed.bodies.len());
    let listed = joints.iter().find(|joint| joint["name"] == "toilet_1/lid").unwrap();
    assert_eq!((listed["kind"].as_str(), listed["joint"].as_str()), (Some("lid"), Some("hinge")));
    assert_eq!(listed["limits"], serde_json::json!([closed, open]));
    let report = verify_scene(&dataset, "bath", &Quiet).unwrap();
    assert_eq!(report.failures().map(|law| format!("{:?} {:?}", law.law, law.worst)).collect::<Vec<_>>(), Vec::<String>::new());
}

#[test]
fn joints_that_homes_do_not_have_are_refused_with_the_nearest() {
    let folder = tempfile::tempdir().unwrap();
    let summary = run(&write(folder.path(), "toilett_1"), &folder.path().join("out"), None, &Silent).unwrap();
    let message = &summary.scenes[0].failure.as_ref().unwrap().message;
    assert!(message.contains("[[motion]] 1: joint: the scene has no joint \"toilett_1\"; did you mean \"toilet_1\"?"), "{message}");
}

#[test]
fn a_home_has_joints_where_its_motion_names_them() {
    let folder = tempfile::tempdir().unwrap();
    let config = write(folder.path(), "toilet_1");
    let enfilade_pipeline::Source::Home(home) = &config.scenes[0].source else { panic!("a home") };
    assert_eq!(home.states, Some(States::MADE));
    // Axes are vertical or level, and hinges have a point in the home.
    let made = hall_and_bathroom(StateWord::Made);
    for body in &made.scene.bodies {
        if let BodyStates::Hinge { axis, point, .. } = &body.motion.states {
            assert!(axis.z.abs() < 1e-9 || (axis.z.abs() - 1.0).abs() < 1e-9, "{}", body.name);
            assert!(point.abs().max_element() < 30.0);
        }
    }
}
