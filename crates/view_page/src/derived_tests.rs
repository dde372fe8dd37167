//! The routes for pictures that are derived from frames or stored separately.

use super::tests::{HEIGHT, WIDTH, ask, bytes, dataset, json, layer_values};
use axum::http::StatusCode;
use enfilade_dataset::hdf5::{Storage, read_array, write_array};
use enfilade_dataset::{Array, Caption, Covisibility, CovisibleFrame, Dataset, DescribedInstance, Elements, Fixture, FramePair, HiddenBy};
use enfilade_dataset::{InstanceRelation, PairRow, Question, RelationKind, Scan, Surfaces, Tracks, write_bytes, write_pairs};
use enfilade_frame::{Frame, Layer, f16};
use enfilade_math::{DVec2, DVec3};
use serde_json::{Value, json as value};
use std::io::Cursor;
use std::path::Path;

const PIXELS: usize = (WIDTH * HEIGHT) as usize;
const FRAME: (&str, &str, u32) = ("room", "cam_00", 0);

fn frame_of(layers: &[Layer]) -> Frame {
    let mut frame = Frame::new(WIDTH, HEIGHT);
    layers.iter().for_each(|&layer| frame.insert(layer, layer_values(layer, 3)));
    frame
}

fn elements(layer: Layer) -> Elements {
    Elements::from(layer_values(layer, 3))
}

/// Frame 0 gets two fixtures, a mix, two surfaces, layers that lead to frame 2, and readings of four sensors.
fn derive(dataset: &Dataset) {
    let fixture = |id, kind: &str, name: &str| Fixture {
        id,
        kind: kind.into(),
        name: name.into(),
        intensity: None,
        position: None,
        node_ids: vec![],
        lights: vec![],
    };
    dataset.write_fixtures("room", &[fixture(1, "sky", "sky"), fixture(2, "lamp", "bulb/glass")]).unwrap();
    for (id, layer) in [1, 2].into_iter().flat_map(|id| [Layer::DiffuseIllumination, Layer::Residual].map(|layer| (id, layer))) {
        let array = Array::new(&[HEIGHT as usize, WIDTH as usize, 3], elements(layer));
        write_array(&dataset.layout().fixture_layer("room", "cam_00", 0, id, layer), &array, Storage::Contiguous, &[]).unwrap();
    }
    dataset.write_relit("evening", FRAME, &frame_of(&[Layer::Color, Layer::DiffuseIllumination, Layer::Residual]), b"no picture").unwrap();
    let numbers = |count: usize| (0..PIXELS * count).map(|i| i as f32);
    let surfaces = Surfaces {
        size: [HEIGHT as usize, WIDTH as usize],
        count: 2,
        distance_m: numbers(2).collect(),
        entity: numbers(2).map(|v| v as i16).collect(),
        semantic: numbers(2).map(|v| v as i16 % 40).collect(),
        side: numbers(2).map(|v| v as u8 % 3).collect(),
        normal_world: numbers(6).map(f16::from_f32).collect(),
        bent_distance_m: numbers(1).collect(),
        bent_position: numbers(3).collect(),
        bent_entity: numbers(1).map(|v| v as i16).collect(),
    };
    dataset.write_surfaces("room", "cam_00", 0, surfaces).unwrap();
    dataset.write_plane_ids(["room", "cam_00"], 0, [HEIGHT as usize, WIDTH as usize], numbers(1).map(|v| v as i16).collect()).unwrap();
    let pair = FramePair { scene: "room".into(), first: ("cam_00".into(), 0), second: ("cam_00".into(), 2) };
    dataset.write_pair_layers(&pair, &frame_of(&[Layer::OpticalFlow, Layer::SceneFlow, Layer::FlowVisibility])).unwrap();
    for sensor in ["kinect", "phone", "raw", "spin"] {
        dataset.begin_sensor(sensor, &value!({ "name": sensor })).unwrap();
    }
    dataset
        .write_sensed_layer("kinect", FRAME, [WIDTH as usize, HEIGHT as usize], Layer::DepthZMeters, &layer_values(Layer::DepthZMeters, 3))
        .unwrap();
    let mut png = Cursor::new(Vec::new());
    image::RgbImage::from_fn(WIDTH, HEIGHT, |x, y| image::Rgb([x as u8, y as u8, 200]))
        .write_to(&mut png, image::ImageFormat::Png)
        .unwrap();
    dataset.write_sensed_file("phone", FRAME, "color.png", png.get_ref()).unwrap();
    let mut png = Cursor::new(Vec::new());
    image::ImageBuffer::from_fn(WIDTH, HEIGHT, |x, y| image::Luma([(4000 * y + x) as u16]))
        .write_to(&mut png, image::ImageFormat::Png)
        .unwrap();
    dataset.write_sensed_file("raw", FRAME, "raw.png", png.get_ref()).unwrap();
    let scan = Scan { distances_m: vec![1.0, 2.0, f32::NAN], parts: vec![3, 4, -1], ..Scan::empty([1, 3]) };
    dataset.write_sensed_file("spin", FRAME, "scan.npz", &scan.to_npz()).unwrap();
    dataset.write_sensed_file("spin", FRAME, "imu.csv", b"time_s\n").unwrap();
}

async fn picture(root: &Path, name: &str) -> (String, String, Vec<u8>) {
    let response = ask(root, &format!("/api/view/layer/room/cam_00/0/{name}"), &[]).await;
    assert_eq!(response.status(), StatusCode::OK, "{name}");
    let head = |name: &str| response.headers()[name].to_str().unwrap().to_string();
    let (shape, dtype) = (head("x-enfilade-shape"), head("x-enfilade-dtype"));
    (shape, dtype, bytes(response).await)
}

async fn status(root: &Path, address: &str) -> u16 {
    ask(root, address, &[]).await.status().as_u16()
}

#[tokio::test]
async fn a_camera_tells_what_its_frames_have_beside_layers() {
    let folder = tempfile::tempdir().unwrap();
    derive(&dataset(folder.path()));
    let camera = json(folder.path(), "/api/view/camera/room/cam_00").await;
    let titles: Vec<&str> = camera["derived"].as_array().unwrap().iter().map(|spec| spec["title"].as_str().unwrap()).collect();
    let surface = |nth: &str| ["distance", "normal", "part", "class", "side"].map(|what| format!("surface {nth}, {what}"));
    let mut expected: Vec<String> =
        ["1 sky, illumination", "1 sky, residual", "2 bulb/glass, illumination", "2 bulb/glass, residual"].map(String::from).into();
    expected.extend(["evening, color", "evening, diffuse_illumination", "evening, residual"].map(String::from));
    expected.extend(surface("1").into_iter().chain(surface("2")));
    expected.extend(["distance", "position", "part"].map(|what| format!("behind glass, {what}")));
    expected.push("plane".into());
    expected.extend(["optical flow", "scene flow", "visibility"].map(|what| format!("to cam_00 2, {what}")));
    expected.extend(["kinect, depth_z_meters", "phone, picture", "raw, raw"].map(String::from));
    expected.extend(["distance", "intensity", "part"].map(|what| format!("spin, {what} of beams")));
    assert_eq!(titles, expected);
    let derived: Vec<usize> = camera["frames"].as_array().unwrap().iter().map(|frame| frame["derived"].as_array().unwrap().len()).collect();
    assert_eq!((derived, &camera["problems"]), (vec![titles.len(), 0, 0], &value!([])));
    let lamp = &camera["derived"][2];
    assert_eq!((&lamp["like"], &lamp["pass"], &lamp["unit"]), (&"diffuse_illumination".into(), &"fixtures".into(), &"W/(sr m^2)".into()));
    assert!(lamp["description"].as_str().unwrap().contains("comes from the lamp bulb/glass (fixture 2)"));
    for spec in camera["derived"].as_array().unwrap() {
        let (shape, ..) = picture(folder.path(), spec["name"].as_str().unwrap()).await;
        assert!(shape.ends_with(&format!(",{}", spec["channels"])), "{spec}: {shape}");
    }
    let frame = json(folder.path(), "/api/view/frame/room/cam_00/0").await;
    assert_eq!(frame["sensor_tables"], value!([{ "sensor": "spin", "path": "sensors/spin/room/cam_00/frame.0000.imu.csv" }]));
}

#[tokio::test]
async fn derived_pictures_have_the_numbers_of_their_files() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    derive(&dataset);
    let root = folder.path();
    for (name, layer) in [
        ("fixture_02_diffuse_illumination", Layer::DiffuseIllumination),
        ("mix.evening.color", Layer::Color),
        ("to.cam_00.2.optical_flow", Layer::OpticalFlow),
        ("sensor.kinect.depth_z_meters", Layer::DepthZMeters),
    ] {
        let stored = elements(layer);
        let shape = format!("{HEIGHT},{WIDTH},{}", layer.spec().channels);
        assert_eq!(picture(root, name).await, (shape, stored.element().name().into(), stored.as_bytes().to_vec()), "{name}");
    }
    let all = read_array(&dataset.layout().surfaces("room", "cam_00", 0, "surface_normal_world")).unwrap();
    let Elements::F16(all) = all.values else { panic!("not float16") };
    let second: Vec<u8> = all.chunks_exact(6).flat_map(|pixel| &pixel[3..]).flat_map(|v| v.to_le_bytes()).collect();
    assert_eq!(picture(root, "surface_normal_world.2").await, (format!("{HEIGHT},{WIDTH},3"), "float16".into(), second));
    let (shape, dtype, raw) = picture(root, "sensor.raw.raw").await;
    assert_eq!((shape, dtype.as_str()), (format!("{HEIGHT},{WIDTH},1"), "float32"));
    assert_eq!(raw[4 * PIXELS - 4..], (24011.0f32).to_le_bytes());
    let (shape, dtype, shown) = picture(root, "sensor.phone.color_png").await;
    assert_eq!((shape, dtype.as_str(), &shown[shown.len() - 3..]), (format!("{HEIGHT},{WIDTH},3"), "uint8", &[11, 6, 200][..]));
    let parts: Vec<u8> = [3i16, 4, -1].into_iter().flat_map(i16::to_le_bytes).collect();
    assert_eq!(picture(root, "sensor.spin.scan_parts").await, ("1,3,1".into(), "int16".into(), parts));
}

#[tokio::test]
async fn fixtures_are_exposed_as_the_frame_is() {
    let folder = tempfile::tempdir().unwrap();
    derive(&dataset(folder.path()));
    let scale = async |name: &str| {
        let response = ask(folder.path(), &format!("/api/view/layer/room/cam_00/0/{name}"), &[]).await;
        serde_json::from_str::<Value>(response.headers()["x-enfilade-summary"].to_str().unwrap()).unwrap()["tone_scale"].as_f64()
    };
    let color = scale("color").await;
    assert!(color.is_some());
    assert_eq!((scale("fixture_01_residual").await, scale("mix.evening.color").await, scale("surface_side.1").await), (color, color, None));
}

#[tokio::test]
async fn what_is_damaged_or_not_there_costs_only_itself() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    derive(&dataset);
    let (root, layout) = (folder.path(), dataset.layout());
    let of = |name: &str| format!("/api/view/layer/room/cam_00/0/{name}");
    for (name, expected) in [
        ("surface_side.3", 404),
        ("surface_side.0", 400),
        ("surface_side.99999999999999999999", 400),
        ("fixture_03_residual", 404),
        ("to.cam_00.1.optical_flow", 404),
        ("to.cam_00.2.color", 400),
        ("to...%2f2.optical_flow", 400),
        ("sensor.nothing.color", 404),
        ("sensor...color", 400),
        ("mix..hidden.color", 400),
    ] {
        assert_eq!(status(root, &of(name)).await, expected, "{name}");
    }
    write_bytes(&layout.sensed("phone", FRAME, "color.png"), b"no picture").unwrap();
    write_bytes(&layout.sensed("spin", FRAME, "scan.npz"), b"PK").unwrap();
    write_bytes(&layout.surfaces("room", "cam_00", 0, "surface_distance_meters"), b"no array").unwrap();
    let flat = Array::new(&[HEIGHT as usize, WIDTH as usize], elements(Layer::DepthMeters));
    write_array(&layout.fixture_layer("room", "cam_00", 0, 1, Layer::Residual), &flat, Storage::Contiguous, &[]).unwrap();
    for name in ["sensor.phone.color_png", "sensor.spin.scan_distances", "surface_distance_meters.1", "fixture_01_residual"] {
        assert_eq!(status(root, &of(name)).await, 500, "{name}");
    }
    std::fs::write(layout.metadata_fixtures("room"), "fixture_id\n\"").unwrap();
    let camera = json(root, "/api/view/camera/room/cam_00").await;
    let problems = camera["problems"].as_array().unwrap();
    let told: Vec<&str> = problems.iter().map(|one| one["error"].as_str().unwrap()).collect();
    assert!(
        told.iter().any(|error| error.contains("surface_distance_meters")) && told.iter().any(|error| error.contains("metadata_fixtures")),
        "{told:?}"
    );
    assert!(problems.iter().all(|one| one["panel"] == "display"), "{problems:?}");
    let titles: Vec<&str> = camera["derived"].as_array().unwrap().iter().map(|spec| spec["title"].as_str().unwrap()).collect();
    assert!(titles.contains(&"2 fixture, illumination") && titles.contains(&"to cam_00 2, optical flow"), "{titles:?}");
    assert_eq!(status(root, &of("color")).await, 200);
}

#[cfg(unix)]
#[tokio::test]
async fn derived_files_that_lie_elsewhere_are_refused() {
    use std::os::unix::fs::symlink;
    let outside = tempfile::tempdir().unwrap();
    let other = dataset(outside.path());
    derive(&other);
    relate(&other);
    let folder = tempfile::tempdir().unwrap();
    let ours = dataset(folder.path());
    let (theirs, layout) = (other.layout(), ours.layout());
    symlink(theirs.surfaces_dir("room", "cam_00"), layout.surfaces_dir("room", "cam_00")).unwrap();
    symlink(theirs.sensors_dir(), layout.sensors_dir()).unwrap();
    for file in [
        |l: &enfilade_dataset::Layout| l.covisibility("room"),
        |l: &enfilade_dataset::Layout| l.covisibility_frames("room"),
        |l: &enfilade_dataset::Layout| l.tracks("room", "cam_00"),
        |l: &enfilade_dataset::Layout| l.captions("room", "cam_00"),
        |l: &enfilade_dataset::Layout| l.described_instances("room"),
        |l: &enfilade_dataset::Layout| l.fixture_layer("room", "cam_00", 0, 1, Layer::Residual),
    ] {
        symlink(file(theirs), file(layout)).unwrap();
    }
    for address in [
        "/api/view/layer/room/cam_00/0/surface_side.1",
        "/api/view/layer/room/cam_00/0/sensor.phone.color_png",
        "/api/view/layer/room/cam_00/0/fixture_01_residual",
        "/api/view/pairs/room/cam_00/0",
        "/api/view/tracks/room/cam_00",
    ] {
        assert_eq!(status(folder.path(), address).await, 403, "{address}");
    }
    let camera = json(folder.path(), "/api/view/camera/room/cam_00").await;
    let frame = json(folder.path(), "/api/view/frame/room/cam_00/0").await;
    let scene = json(folder.path(), "/api/view/scene/room").await;
    for (told, lacks) in [(&camera, "surfaces"), (&frame, "captions.jsonl"), (&scene, "metadata_instances.csv")] {
        let said = told["problems"].to_string();
        assert!(said.contains(lacks) && said.contains("leads out of the dataset's folder"), "{said}");
    }
    assert_eq!((&frame["words"]["caption"], &scene["described"]["instances"]), (&Value::Null, &value!([])));
}

/// The scene gets a matrix, a list of pairs, tracks, words and relations.
fn relate(dataset: &Dataset) {
    let frame = |frame| CovisibleFrame { camera: "cam_00".into(), frame, grid_step_px: 1, surface_pixels: 84 };
    let shares = vec![1.0, 0.25, 0.0, 0.75, 1.0, 0.0, f32::NAN, f32::NAN, f32::NAN];
    let covisibility = Covisibility { frames: vec![frame(0), frame(2), frame(7)], hidden_by: HiddenBy::Distances, shares };
    dataset.write_covisibility("room", &covisibility).unwrap();
    let pair = FramePair { scene: "room".into(), first: ("cam_00".into(), 2), second: ("cam_00".into(), 0) };
    let row = PairRow { pair, first_seen_by_second: 0.75, second_seen_by_first: 0.25, baseline_m: 2.0, angle_deg: 0.0 };
    write_pairs(&dataset.layout().pairs(), &[row]).unwrap();
    let tracks = Tracks {
        node_ids: Vec::new(),
        frames: vec![0, 2],
        positions: vec![DVec3::ONE],
        seeds: vec![(0, [0.5, 0.5])],
        points: vec![[0.25, 0.5], [1.5, -1.0]],
        occluded: vec![false, true],
    };
    dataset.write_tracks("room", "cam_00", &tracks).unwrap();
    let sofa = DescribedInstance {
        instance: 3,
        semantic: 6,
        semantic_name: "sofa".into(),
        name: "sofa_1".into(),
        noun: "sofa".into(),
        room: "living_1".into(),
        color: "blue".into(),
        material: "wool".into(),
        center: DVec3::ZERO,
        size_m: DVec3::new(2.0, 1.0, 0.75),
        front: Some(DVec2::X),
    };
    dataset.write_described_instances("room", &[sofa]).unwrap();
    let on = InstanceRelation { subject: 3, kind: RelationKind::HangsFrom, object: -1, object_semantic: 22, distance_m: 0.5 };
    dataset.write_instance_relations("room", &[on]).unwrap();
    let caption = |frame| Caption {
        id: format!("room/cam_00/{frame:04}"),
        scene_name: "room".into(),
        camera: "cam_00".into(),
        frame,
        caption: format!("A sofa in frame {frame}."),
        instances: vec![3],
    };
    let question = |frame| Question {
        id: "room/cam_00/0".into(),
        dataset: "enfilade".into(),
        scene_name: "room".into(),
        camera: "cam_00".into(),
        frame,
        question_type: "object_counting".into(),
        question: "How many sofas are there?".into(),
        options: None,
        ground_truth: "1".into(),
        instances: vec![3],
    };
    let questions = [question(None), question(Some(0)), question(Some(2))];
    dataset.write_words(["room", "cam_00"], &[caption(0), caption(2)], &questions).unwrap();
}

#[tokio::test]
async fn partners_of_a_frame_are_told_by_overlap_with_baseline_and_angle() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    let root = folder.path();
    assert_eq!(status(root, "/api/view/pairs/room/cam_00/0").await, 404);
    relate(&dataset);
    let told = json(root, "/api/view/pairs/room/cam_00/0").await;
    let [partner] = told["partners"].as_array().unwrap().as_slice() else { panic!("{told}") };
    assert_eq!((&partner["frame"], &partner["this_seen"], &partner["that_seen"]), (&2.into(), &0.25.into(), &0.75.into()));
    assert_eq!((&partner["baseline_m"], &partner["listed"], &told["count"]), (&2.0.into(), &true.into(), &1.into()));
    let angle_deg = (6.5 / (10.5f64 * 6.5).sqrt()).acos().to_degrees();
    assert!((partner["angle_deg"].as_f64().unwrap() - angle_deg).abs() < 1e-4, "{partner}");
    assert_eq!(told["hidden_by"], "distances");
    let lonely = json(root, "/api/view/pairs/room/cam_00/7").await;
    assert_eq!(lonely["partners"], value!([]));
    assert_eq!(status(root, "/api/view/pairs/room/cam_00/1").await, 404);
    assert_eq!(json(root, "/api/view/scene/room").await["has_pairs"], true);
    std::fs::write(dataset.layout().pairs(), "scene_name\nroom\n").unwrap();
    let told = json(root, "/api/view/pairs/room/cam_00/0").await;
    assert_eq!((&told["partners"][0]["listed"], &told["problems"][0]["panel"]), (&Value::Null, &"pairs".into()));
    // A name in the list that is no name reads no files.
    let list = dataset.layout().covisibility_frames("room");
    std::fs::write(&list, std::fs::read_to_string(&list).unwrap().replace("cam_00,7", "../../..,7")).unwrap();
    assert_eq!(status(root, "/api/view/pairs/room/cam_00/0").await, 200);
    std::fs::write(&list, "frame_index\n").unwrap();
    assert_eq!(status(root, "/api/view/pairs/room/cam_00/0").await, 500);
}

#[tokio::test]
async fn tracks_are_those_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    assert_eq!(status(folder.path(), "/api/view/tracks/room/cam_00").await, 404);
    relate(&dataset);
    let buffer = bytes(ask(folder.path(), "/api/view/tracks/room/cam_00", &[]).await).await;
    let words: Vec<u32> = [1, 2, 0, 2].into();
    let expected = [
        b"ENFTRKS1".to_vec(),
        words.into_iter().flat_map(u32::to_le_bytes).collect(),
        [0.25f32, 0.5, 1.5, -1.0].into_iter().flat_map(f32::to_le_bytes).collect(),
        vec![0, 1],
    ];
    assert_eq!(buffer, expected.concat());
    assert_eq!(json(folder.path(), "/api/view/camera/room/cam_00").await["has_tracks"], true);
    write_bytes(&dataset.layout().tracks("room", "cam_00"), b"PK").unwrap();
    assert_eq!(status(folder.path(), "/api/view/tracks/room/cam_00").await, 500);
}

#[tokio::test]
async fn words_and_relations_are_told_with_scene_and_frame() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    relate(&dataset);
    let (root, layout) = (folder.path(), dataset.layout());
    let room = value!({ "name": "living_1", "kind": "living_room", "polygon": [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], "floor_z_m": 0.0, "ceiling_z_m": 2.5 });
    let rooms = enfilade_scene::Rooms { outlines: vec![serde_json::from_value(room).unwrap()], ..enfilade_scene::Rooms::default() };
    write_bytes(&layout.rooms("room"), serde_json::to_string(&rooms).unwrap()).unwrap();
    let described = &json(root, "/api/view/scene/room").await["described"];
    let sofa = &described["instances"][0];
    assert_eq!((&sofa["noun"], &sofa["color"], &sofa["size_m"]), (&"sofa".into(), &"blue".into(), &value!([2.0, 1.0, 0.75])));
    let relation = value!({ "subject": 3, "kind": "hangs_from", "object": -1, "object_semantic": 22, "distance_m": 0.5 });
    assert_eq!(
        (&described["relations"], &described["rooms"]),
        (&value!([relation]), &value!([{ "name": "living_1", "kind": "living_room" }]))
    );
    assert_eq!(described["planes"].as_array().unwrap()[..2], ["floor of living_1", "ceiling of living_1"]);
    let words = &json(root, "/api/view/frame/room/cam_00/2").await["words"];
    assert_eq!(words["caption"], "A sofa in frame 2.");
    let of_all: Vec<&Value> = words["questions"].as_array().unwrap().iter().map(|one| &one["of_all_frames"]).collect();
    assert_eq!(of_all, [&Value::Bool(true), &Value::Bool(false)]);
    let text = std::fs::read_to_string(layout.questions("room", "cam_00")).unwrap();
    std::fs::write(layout.questions("room", "cam_00"), format!("{text}{{\n")).unwrap();
    std::fs::write(layout.rooms("room"), "{").unwrap();
    let told = json(root, "/api/view/frame/room/cam_00/2").await;
    let said = told["problems"][0]["error"].as_str().unwrap();
    assert!(said.contains("questions.jsonl: line 4: ") && told["words"]["caption"] == "A sofa in frame 2.", "{told}");
    let scene = json(root, "/api/view/scene/room").await;
    assert!(scene["problems"].to_string().contains("layout.json") && scene["described"]["instances"][0]["noun"] == "sofa", "{scene}");
}
