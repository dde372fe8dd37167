//! The routes, asked as a browser asks them.

use super::{Viewer, router};
use axum::body::{Body, to_bytes};
use axum::http::{Request, StatusCode, header};
use axum::response::Response;
use enfilade_dataset::hdf5::{Storage, read_array, write_array};
use enfilade_dataset::{Array, Dataset, Elements, FrameInfo, FrameTime, JudgedView, LabelColors, Node, ViewFault, ViewVerdict};
use enfilade_dataset::{mesh_names, write_bytes};
use enfilade_frame::{DENOISED, Dtype, Frame, LAYERS, Layer, Pass, Values, f16};
use enfilade_math::DVec3;
use enfilade_scene::{Camera, Intrinsics, Labels, PartLabel, Pose, Trajectory};
use serde_json::Value;
use std::path::Path;
use tower::ServiceExt;

pub(super) const WIDTH: u32 = 12;
pub(super) const HEIGHT: u32 = 7;

/// Numbers that differ from pixel to pixel and fit the layer's type.
pub(super) fn layer_values(layer: Layer, seed: usize) -> Values {
    let spec = layer.spec();
    let n = (WIDTH * HEIGHT) as usize * spec.channels;
    let wave = |i: usize| ((i * 7 + seed) as f64 * 0.31).sin() + 1.5;
    match spec.dtype {
        Dtype::F16 => Values::F16((0..n).map(|i| f16::from_f64(wave(i))).collect()),
        Dtype::F32 => Values::F32((0..n).map(|i| wave(i) as f32).collect()),
        Dtype::I16 => Values::I16((0..n).map(|i| ((i + seed) % 9) as i16 - 1).collect()),
        Dtype::U8 => Values::U8((0..n).map(|i| ((i + seed) % 4) as u8).collect()),
    }
}

/// A dataset of one camera: frame 0 with every layer, frame 1 rejected, frame 2 planned.
pub(super) fn dataset(root: &Path) -> Dataset {
    let dataset = Dataset::create(root).unwrap();
    let camera: Camera = Intrinsics::from_fov_x(WIDTH, HEIGHT, 1.0).into();
    let pose = |frame| Pose::look_at(frame, DVec3::new(f64::from(frame), 0.5, 1.5), DVec3::new(2.0, 3.0, 1.0), DVec3::Z).unwrap();
    let trajectory = Trajectory { name: "cam_00".into(), poses: vec![pose(0), pose(1), pose(2)] };
    dataset.write_trajectory("room", &trajectory, &camera, None).unwrap();
    dataset.write_camera_parameters("room", &camera).unwrap();
    let of = |passes: &[Pass]| {
        let mut frame = Frame::new(WIDTH, HEIGHT);
        LAYERS.iter().filter(|spec| passes.contains(&spec.pass)).for_each(|spec| frame.insert(spec.layer, layer_values(spec.layer, 0)));
        frame
    };
    let info = FrameInfo { seed: u64::MAX, samples: 4, config_hash: "c".into(), pose: pose(0), camera, sampling: None, recipe: None };
    let rendered = of(&[Pass::Final, Pass::Geometry, Pass::Guides, Pass::LightParts, Pass::Extra]);
    dataset.write_frame("room", "cam_00", &rendered, &info, FrameTime::default()).unwrap();
    dataset.write_label_layers("room", "cam_00", 0, &of(&[Pass::Label]), "l").unwrap();
    let mut denoised = Frame::new(WIDTH, HEIGHT);
    DENOISED.iter().for_each(|(layer, _)| denoised.insert(*layer, layer_values(*layer, 0)));
    dataset.write_denoised(["room", "cam_00"], 0, &denoised, ["d", "d"], true).unwrap();
    let fault = ViewFault { gate: "blocked".into(), value: 0.75, limit: 0.5 };
    let view = |frame, verdict, fault| (JudgedView { frame, verdict, fault }, vec![]);
    let views = [view(0, ViewVerdict::Passed, None), view(1, ViewVerdict::Rejected, Some(fault)), view(2, ViewVerdict::Passed, None)];
    dataset.write_view_gates("room", "cam_00", &[], &views).unwrap();
    dataset
}

pub(super) async fn ask(root: &Path, address: &str, headers: &[(&str, &str)]) -> Response {
    let mut request = Request::get(address);
    for (name, value) in headers {
        request = request.header(*name, *value);
    }
    router(Viewer::open(root).unwrap()).oneshot(request.body(Body::empty()).unwrap()).await.unwrap()
}

pub(super) async fn bytes(response: Response) -> Vec<u8> {
    to_bytes(response.into_body(), usize::MAX).await.unwrap().to_vec()
}

pub(super) async fn json(root: &Path, address: &str) -> Value {
    let response = ask(root, address, &[]).await;
    assert_eq!(response.status(), StatusCode::OK, "{address}");
    serde_json::from_slice(&bytes(response).await).unwrap()
}

#[tokio::test]
async fn every_layer_has_the_bytes_of_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    for spec in &LAYERS {
        let response = ask(folder.path(), &format!("/api/view/layer/room/cam_00/0/{}", spec.name), &[]).await;
        assert_eq!(response.status(), StatusCode::OK, "{}", spec.name);
        let head = |name: &str| response.headers()[name].to_str().unwrap().to_string();
        assert_eq!(head("x-enfilade-shape"), format!("{HEIGHT},{WIDTH},{}", spec.channels));
        let stored = read_array(&dataset.layout().layer("room", "cam_00", 0, spec.layer)).unwrap().values;
        assert_eq!(head("x-enfilade-dtype"), stored.element().name());
        assert!(serde_json::from_str::<Value>(&head("x-enfilade-summary")).unwrap()["range"][1].is_number());
        assert_eq!(bytes(response).await, stored.as_bytes(), "{}", spec.name);
    }
}

#[tokio::test]
async fn small_and_compact_pictures_are_of_the_same_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    let stored = read_array(&dataset.layout().layer("room", "cam_00", 0, Layer::DepthMeters)).unwrap().values;
    let address = "/api/view/layer/room/cam_00/0/depth_meters";
    let small = ask(folder.path(), &format!("{address}?step=4"), &[]).await;
    assert_eq!(
        (&small.headers()["x-enfilade-shape"], &small.headers()["x-enfilade-size"]),
        (&"2,3,1".parse().unwrap(), &"7,12".parse().unwrap())
    );
    let pixel = |x: usize, y: usize| &stored.as_bytes()[4 * (12 * y + x)..][..4];
    let expected: Vec<u8> = [0, 4].into_iter().flat_map(|y| [0, 4, 8].map(|x| pixel(x, y).to_vec()).concat()).collect();
    assert_eq!(bytes(small).await, expected);
    let compact = ask(folder.path(), &format!("{address}?compact=1"), &[]).await;
    assert_eq!(compact.headers()["x-enfilade-packing"], "planes");
    let planes = bytes(compact).await;
    let n = planes.len() / 4;
    let together: Vec<u8> = (0..n).flat_map(|i| [planes[i], planes[n + i], planes[2 * n + i], planes[3 * n + i]]).collect();
    assert_eq!(together, stored.as_bytes());
}

#[tokio::test]
async fn json_is_compressed_for_those_who_take_it() {
    let folder = tempfile::tempdir().unwrap();
    dataset(folder.path());
    let packed = ask(folder.path(), "/api/view/dataset", &[("accept-encoding", "gzip, br")]).await;
    assert_eq!(packed.headers()[header::CONTENT_ENCODING], "gzip");
    let packed = bytes(packed).await;
    let plain = bytes(ask(folder.path(), "/api/view/dataset", &[]).await).await;
    let mut unpacked = vec![0; plain.len()];
    libdeflater::Decompressor::new().gzip_decompress(&packed, &mut unpacked).unwrap();
    assert!(unpacked == plain && packed.len() < plain.len() / 3);
}

#[tokio::test]
async fn the_dataset_its_scenes_cameras_and_frames_are_told() {
    let folder = tempfile::tempdir().unwrap();
    dataset(folder.path());
    let all = json(folder.path(), "/api/view/dataset").await;
    assert_eq!((&all["scenes"], all["layers"].as_array().unwrap().len()), (&serde_json::json!(["room"]), LAYERS.len()));
    let scene = json(folder.path(), "/api/view/scene/room").await;
    assert_eq!((&scene["cameras"], scene["classes"].as_array().unwrap().len()), (&serde_json::json!(["cam_00"]), 40));
    let camera = json(folder.path(), "/api/view/camera/room/cam_00").await;
    let frames = camera["frames"].as_array().unwrap();
    assert_eq!(frames.iter().map(|frame| frame["layers"].as_array().unwrap().len()).collect::<Vec<_>>(), [LAYERS.len(), 0, 0]);
    let [fault] = frames[1]["faults"].as_array().unwrap().as_slice() else { panic!("{}", frames[1]) };
    assert_eq!((&fault["gate"], &fault["value"], &fault["limit"]), (&"blocked".into(), &0.75.into(), &0.5.into()));
    assert_eq!((&fault["by"], &fault["rejects"]), (&"planning".into(), &Value::Bool(true)));
    assert_eq!((&frames[0]["complete"], &frames[2]["complete"]), (&Value::Bool(true), &Value::Bool(false)));
    assert_eq!((&camera["projection"]["kind"], camera["projection"]["corner_rays"].as_array().unwrap().len()), (&"pinhole".into(), 4));
    let frame = json(folder.path(), "/api/view/frame/room/cam_00/0").await;
    assert_eq!(frame["record"]["seed"], u64::MAX.to_string(), "a browser would round the number");
}

#[tokio::test]
async fn objects_that_were_split_off_are_told_with_class_and_instance() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    let node = |node_id, name: &str, object_id| Node {
        node_id,
        node_name: name.into(),
        object_id,
        object_name: name.into(),
        is_partly_there: false,
    };
    dataset.write_nodes("room", &[node(1, "sky", None), node(2, "harp", Some(0))]).unwrap();
    let labels = Labels { parts: vec![PartLabel { semantic: 3, instance: 1 }, PartLabel { semantic: 7, instance: 2 }] };
    dataset.write_label_tables("room", &labels).unwrap();
    let objects = |names: &[&str]| serde_json::json!({ "names": names, "semantic": [3, 7], "instance": [1, 2] });
    assert_eq!(json(folder.path(), "/api/view/scene/room").await["objects"], objects(&["harp"]), "without a table of objects");
    dataset.mesh_files("room").write_objects(&["harp".into()], &[("harp~2".into(), 0)], &[0, 1]).unwrap();
    let scene = json(folder.path(), "/api/view/scene/room").await;
    assert_eq!((&scene["parts"], &scene["objects"]), (&serde_json::json!(["sky", "harp"]), &objects(&["harp", "harp~2"])));
}

#[tokio::test]
async fn classes_are_those_of_the_scenes_list_while_its_labels_are() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    let files = dataset.mesh_files("room");
    let labels = Labels { parts: vec![PartLabel { semantic: 7, instance: 1 }] };
    let rows: Vec<String> = (1..78).map(|id| format!("{id},thing {id},{id},0,0")).collect();
    let header = "semantic_id,semantic_name,semantic_color_r,semantic_color_g,semantic_color_b";
    write_bytes(&files.file("semantic_label_descs.csv"), format!("{header}\n{}\n", rows.join("\n"))).unwrap();
    files.write_labels(&labels, &LabelColors { semantic: (0..78).map(|id| [id, 0, 0]).collect(), instances: 1 }).unwrap();
    let classes = async || json(folder.path(), "/api/view/scene/room").await["classes"].as_array().unwrap().clone();
    let told = classes().await;
    assert_eq!((told.len(), &told[76]), (77, &serde_json::json!({ "id": 77, "name": "thing 77", "color": [77, 0, 0] })));
    // Labels from a table of NYU40 again: the list is left over.
    let mut colors = LabelColors::nyu40(&labels);
    colors.semantic[7] = [1, 2, 3];
    files.write_labels(&labels, &colors).unwrap();
    let told = classes().await;
    assert_eq!((told.len(), &told[6]), (40, &serde_json::json!({ "id": 7, "name": "table", "color": [1, 2, 3] })));
    write_bytes(&files.file("semantic_label_descs.csv"), "semantic_id,semantic_name\n1,a\n").unwrap();
    let told = json(folder.path(), "/api/view/scene/room").await;
    let said = told["problems"][0]["error"].as_str().unwrap();
    assert!(said.contains("semantic_label_descs.csv") && said.contains("line 1: no column"), "{said}");
    assert_eq!((&told["cameras"], &told["problems"][0]["panel"]), (&serde_json::json!(["cam_00"]), &"objects".into()));
}

#[tokio::test]
async fn a_damaged_table_costs_its_own_panel_alone() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    let layout = dataset.layout();
    for (path, address, panel) in [
        (layout.view_gates("room", "cam_00"), "/api/view/camera/room/cam_00", "views"),
        (layout.tone_maps("room", "cam_00"), "/api/view/camera/room/cam_00", "display"),
        (layout.frame_instances("room", "cam_00"), "/api/view/frame/room/cam_00/0", "objects"),
        (layout.metadata_nodes("room"), "/api/view/scene/room", "objects"),
        (layout.view_gates("room", "cam_00"), "/api/view/gallery/room", "gallery"),
    ] {
        let before = std::fs::read(&path).ok();
        std::fs::write(&path, "frame_id\n\"\n\u{0},,,\n").unwrap();
        let told = json(folder.path(), address).await;
        let problems = told["problems"].as_array().unwrap();
        let name = path.file_name().unwrap().to_str().unwrap();
        assert!(problems.len() == 1 && problems[0]["panel"] == panel, "{address}: {told}");
        assert!(problems[0]["error"].as_str().unwrap().contains(name), "{address}: {problems:?}");
        assert_eq!(ask(folder.path(), "/api/view/layer/room/cam_00/0/color", &[]).await.status(), StatusCode::OK, "{name}");
        assert_eq!(ask(folder.path(), "/api/view/thumbnail/room/cam_00/0", &[]).await.status(), StatusCode::OK, "{name}");
        match before {
            Some(before) => std::fs::write(&path, before).unwrap(),
            None => std::fs::remove_file(&path).unwrap(),
        }
    }
}

#[tokio::test]
async fn the_gallery_tells_of_every_frame_and_rejected_view() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    let report = serde_json::json!({ "passed": false, "accepted": false, "scenes": 1, "frames": 1, "gates": [], "pairs": [],
        "laws": [{ "law": "finite", "statement": "numbers are finite", "holds": false, "worst": 1.0, "bound": 0.0, "unit": "px",
            "place": "room/cam_00/frame.0000, pixel 1, 2", "meaning": "", "checks": 1 }],
        "frame_values": [{ "scene": "room", "camera": "cam_00", "frame": 0, "gates": { "depth_range": 0.25 }, "noise": 0.125,
            "noise_target": null, "samples": 4.0, "tone_map_scale": 2.0, "clipped_share": 0.5, "black_share": 0.0,
            "labelled_share": 0.75, "labelled_parts_share": 1.0, "pixels": {} }] });
    let law = serde_json::to_value(enfilade_verify::LAWS[0].law).unwrap();
    let mut report = report;
    report["laws"][0]["law"] = law;
    std::fs::write(dataset.layout().verify_report(), report.to_string()).unwrap();
    let told = json(folder.path(), "/api/view/gallery/room").await;
    let [first, second] = told["frames"].as_array().unwrap().as_slice() else { panic!("{told}") };
    let numbers = ["noise", "clipped", "exposure", "depth_range", "coverage"].map(|name| first[name].as_f64().unwrap());
    assert_eq!((numbers, &first["laws"]), ([0.125, 0.5, 2.0, 0.25, 0.75], &serde_json::json!(["numbers are finite"])));
    assert_eq!((&first["faults"][0]["gate"], &first["faults"][0]["limit"]), (&"depth range".into(), &0.5.into()));
    assert_eq!((&second["frame"], &second["version"], &second["faults"][0]["gate"]), (&1.into(), &Value::Null, &"blocked".into()));
    // The camera's data of the frame agree.
    let camera = json(folder.path(), "/api/view/camera/room/cam_00").await;
    assert_eq!((&camera["frames"][0]["faults"], &camera["frames"][1]["faults"]), (&first["faults"], &second["faults"]));
    let told = json(folder.path(), "/api/view/dataset").await;
    assert_eq!((&told["verify"]["rejected"], &told["verify_problem"]), (&1.into(), &Value::Null));
    let address = format!("/api/view/thumbnail/room/cam_00/0?v={}", first["version"].as_str().unwrap());
    let kept = async |address: &str| {
        ask(folder.path(), address, &[]).await.headers()[header::CACHE_CONTROL].to_str().unwrap().contains("immutable")
    };
    assert!(
        kept(&address).await && !kept("/api/view/thumbnail/room/cam_00/0?v=0").await && !kept("/api/view/thumbnail/room/cam_00/0").await
    );
}

#[tokio::test]
async fn a_report_that_cannot_be_read_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    for text in ["{}", "{\"passed\": tr", ""] {
        std::fs::write(dataset.layout().verify_report(), text).unwrap();
        let told = json(folder.path(), "/api/view/dataset").await;
        assert!(
            told["verify"].is_null() && told["verify_problem"].as_str().is_some_and(|problem| problem.contains("line 1")),
            "{text}: {told}"
        );
        assert_eq!(json(folder.path(), "/api/view/gallery/room").await["frames"].as_array().unwrap().len(), 2);
    }
}

#[tokio::test]
async fn the_pixels_of_each_class_are_counted_when_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    let told = json(folder.path(), "/api/view/class_shares/room").await;
    let Elements::I16(stored) = read_array(&dataset.layout().layer("room", "cam_00", 0, Layer::Semantic)).unwrap().values else { panic!() };
    let frame = &told["frames"][0];
    assert_eq!((told["frames"].as_array().unwrap().len(), &frame["camera"], &frame["frame"]), (1, &"cam_00".into(), &0.into()));
    let shares = frame["shares"].as_object().unwrap();
    for class in -1..=7i16 {
        let pixels = stored.iter().filter(|&&value| value == class).count();
        assert_eq!(shares[&class.to_string()].as_f64().unwrap(), pixels as f64 / stored.len() as f64, "{class}");
    }
    let names: Vec<_> = told["classes"].as_array().unwrap().iter().map(|class| class["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["wall", "floor", "cabinet", "bed", "chair", "sofa", "table"]);
}

#[tokio::test]
async fn points_lie_at_their_depth_before_the_camera() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    let buffer = bytes(ask(folder.path(), "/api/view/points/room/cam_00/0", &[]).await).await;
    let count = u32::from_le_bytes(buffer[8..12].try_into().unwrap()) as usize;
    assert_eq!((&buffer[..8], count, buffer.len()), (&b"ENFPNTS1"[..], 84, 16 + 84 * 16));
    let Values::F32(depth) = dataset.read_layer("room", "cam_00", 0, Layer::DepthMeters).unwrap() else { panic!("not float32") };
    for i in 0..count {
        let at = |axis: usize| f64::from(f32::from_le_bytes(buffer[16 + 12 * i + 4 * axis..][..4].try_into().unwrap()));
        let far = (DVec3::new(at(0), at(1), at(2)) - DVec3::new(0.0, 0.5, 1.5)).length();
        assert!((far - f64::from(depth[i])).abs() < 1e-5, "{i}: {far} {}", depth[i]);
    }
}

#[tokio::test]
async fn what_is_not_there_is_not_found_and_what_is_malformed_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    std::fs::write(dataset.layout().layer("room", "cam_00", 0, Layer::Residual), "not an array").unwrap();
    std::fs::write(folder.path().join("notes.txt"), "mine").unwrap();
    let long = "_".repeat(300);
    for (address, status) in [
        (format!("/api/view/scene/{long}").as_str(), 400),
        (&format!("/api/view/layer/room/{long}/0/color"), 400),
        (&format!("/api/view/file/{long}.json"), 404),
        ("/api/view/file/notes.txt/a.json", 404),
        ("/api/view/scene/nothing", 404),
        ("/api/view/camera/room/cam_09", 404),
        ("/api/view/layer/room/cam_00/1/color", 404),
        ("/api/view/layer/room/cam_00/99999999999/color", 400),
        ("/api/view/layer/room/cam_00/-1/color", 400),
        ("/api/view/layer/room/cam_00/+0/color", 400),
        ("/api/view/layer/room/cam_00/0/colour", 400),
        ("/api/view/layer/room/cam_00/0/color?step=0", 400),
        ("/api/view/layer/room/cam_00/0/color?step=x", 400),
        ("/api/view/layer/room/cam_00/0/residual", 500),
        ("/api/view/points/room/cam_00/0?most=x", 400),
        ("/api/view/points/room/cam_00/1", 404),
        ("/api/view/thumbnail/room/cam_00/1", 404),
        ("/api/view/scene/room/space", 404),
        ("/api/view/scene/room/geometry", 404),
        ("/api/view/file/verify.html", 404),
        ("/api/view/file/notes.txt", 400),
        ("/api/view/nothing", 404),
    ] {
        let response = ask(folder.path(), address, &[]).await;
        assert_eq!(response.status().as_u16(), status, "{address}");
        if address != "/api/view/nothing" {
            let said: Value = serde_json::from_slice(&bytes(response).await).unwrap();
            assert!(said["error"].as_str().unwrap().len() > 5 && said["help"].is_string(), "{address}: {said}");
        }
    }
}

/// Writes the mesh of a scene whose one object is one face.
fn mesh_of_one_face(dataset: &Dataset) {
    let write = |name: &str, shape: [usize; 2], values: Elements| {
        let path = dataset.layout().mesh_file("room", name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        write_array(&path, &Array { shape: shape.to_vec(), values }, Storage::Contiguous, &[]).unwrap();
    };
    write(mesh_names::VERTICES, [3, 3], Elements::F64(vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]));
    write(mesh_names::FACES_VERTICES, [1, 3], Elements::I64(vec![0, 1, 2]));
    write(mesh_names::FACES_OBJECTS, [1, 1], Elements::I64(vec![0]));
}

#[tokio::test]
async fn files_and_geometry_have_the_tags_of_their_stamps() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    let film: Vec<u8> = (0..600_000u32).map(|i| (i % 251) as u8).collect();
    let path = folder.path().join("film.mp4");
    std::fs::write(&path, &film).unwrap();
    let tag = |response: &Response| response.headers()[header::ETAG].clone();
    let sent = ask(folder.path(), "/api/view/file/film.mp4", &[]).await;
    let first = tag(&sent);
    assert_eq!((sent.status(), &sent.headers()[header::CONTENT_LENGTH]), (StatusCode::OK, &"600000".parse().unwrap()));
    assert!(bytes(sent).await == film);
    assert_eq!(tag(&ask(folder.path(), "/api/view/file/film.mp4", &[]).await), first);
    std::fs::write(&path, &film[1..]).unwrap();
    assert_ne!(tag(&ask(folder.path(), "/api/view/file/film.mp4", &[]).await), first);
    mesh_of_one_face(&dataset);
    let geometry = "/api/view/scene/room/geometry";
    let (plain, packed) = (ask(folder.path(), geometry, &[]).await, ask(folder.path(), geometry, &[("accept-encoding", "gzip")]).await);
    assert_ne!(tag(&plain), tag(&packed));
    let known = tag(&plain);
    let again = ask(folder.path(), geometry, &[("if-none-match", known.to_str().unwrap())]).await;
    assert_eq!((again.status(), tag(&again)), (StatusCode::NOT_MODIFIED, known));
}

#[tokio::test]
async fn no_path_leaves_the_dataset() {
    let outside = tempfile::tempdir().unwrap();
    std::fs::write(outside.path().join("secret.json"), "{}").unwrap();
    let folder = tempfile::tempdir().unwrap();
    dataset(folder.path());
    for address in [
        "/api/view/scene/..",
        "/api/view/scene/%2e%2e",
        "/api/view/scene/..%2f..%2fetc",
        "/api/view/camera/room/..%2fcam_00",
        "/api/view/layer/..%2froom/cam_00/0/color",
        "/api/view/layer/room/%00/0/color",
        "/api/view/file/../secret.json",
        "/api/view/file/%2e%2e/secret.json",
        "/api/view/file/..%5csecret.json",
        "/api/view/file/scenes/%2e%2e/%2e%2e/secret.json",
        "/api/view/file//etc/passwd.json",
        "/api/view/file/.hidden.json",
    ] {
        let status = ask(folder.path(), address, &[]).await.status();
        assert!(status.is_client_error(), "{address}: {status}");
    }
}

#[cfg(unix)]
#[tokio::test]
async fn symbolic_links_out_of_the_dataset_are_refused() {
    use std::os::unix::fs::symlink;
    let outside = tempfile::tempdir().unwrap();
    let other = dataset(outside.path());
    std::fs::write(outside.path().join("secret.json"), "{}").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let ours = dataset(folder.path());
    symlink(outside.path().join("secret.json"), folder.path().join("linked.json")).unwrap();
    symlink(other.layout().scene_dir("room"), ours.layout().scene_dir("linked")).unwrap();
    let color = ours.layout().layer("room", "cam_00", 0, Layer::Color);
    std::fs::remove_file(&color).unwrap();
    symlink(other.layout().layer("room", "cam_00", 0, Layer::Color), &color).unwrap();
    for address in [
        "/api/view/file/linked.json",
        "/api/view/scene/linked",
        "/api/view/camera/linked/cam_00",
        "/api/view/layer/linked/cam_00/0/depth_meters",
        "/api/view/layer/room/cam_00/0/color",
        "/api/view/thumbnail/room/cam_00/0",
    ] {
        assert_eq!(ask(folder.path(), address, &[]).await.status(), StatusCode::FORBIDDEN, "{address}");
    }
    let fine = ask(folder.path(), "/api/view/layer/room/cam_00/0/depth_meters", &[]).await;
    assert_eq!(fine.status(), StatusCode::OK);
}

#[cfg(unix)]
#[tokio::test]
async fn pipes_in_the_dataset_are_not_waited_for() {
    let folder = tempfile::tempdir().unwrap();
    let ours = dataset(folder.path());
    let color = ours.layout().layer("room", "cam_00", 0, Layer::Color);
    std::fs::remove_file(&color).unwrap();
    for pipe in [&folder.path().join("pipe.html"), &color] {
        assert!(std::process::Command::new("mkfifo").arg(pipe).status().unwrap().success());
    }
    for address in ["/api/view/file/pipe.html", "/api/view/layer/room/cam_00/0/color"] {
        assert_eq!(ask(folder.path(), address, &[]).await.status(), StatusCode::FORBIDDEN, "{address}");
    }
}

#[tokio::test]
async fn positions_are_shown_in_metres_whatever_the_unit() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    let address = "/api/view/layer/room/cam_00/0/position";
    let range = async || {
        let reply = ask(folder.path(), address, &[]).await;
        let summary: Value = serde_json::from_str(reply.headers()["x-enfilade-summary"].to_str().unwrap()).unwrap();
        summary["range"][1].as_f64().unwrap()
    };
    let metres = range().await;
    std::fs::write(dataset.layout().metadata_scene("room"), "parameter_name,parameter_value\nmeters_per_asset_unit,0.5\n").unwrap();
    assert!((range().await / metres - 0.5).abs() < 1e-6);
}

#[tokio::test]
async fn hypersims_own_pictures_are_shown() {
    let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
        return eprintln!("skipped: ENFILADE_SCENES is not set");
    };
    let root = Path::new(&scenes).join("hypersim-real");
    let camera = json(&root, "/api/view/camera/ai_037_002/cam_00").await;
    assert_eq!(camera["frames"].as_array().unwrap().len(), 100);
    let depth = ask(&root, "/api/view/layer/ai_037_002/cam_00/0/depth_meters", &[]).await;
    assert_eq!(
        (&depth.headers()["x-enfilade-shape"], &depth.headers()["x-enfilade-dtype"]),
        (&"768,1024,1".parse().unwrap(), &"float16".parse().unwrap())
    );
    // Planar depth is computed, and the page's list of layers includes it.
    assert!(camera["frames"][0]["layers"].as_array().unwrap().contains(&Value::from(Layer::DepthZMeters as usize)));
    let planar = ask(&root, "/api/view/layer/ai_037_002/cam_00/0/depth_z_meters", &[]).await;
    assert_eq!((planar.status(), &planar.headers()["x-enfilade-dtype"]), (StatusCode::OK, &"float32".parse().unwrap()));
    assert_eq!(ask(&root, "/api/view/thumbnail/ai_037_002/cam_00/0", &[]).await.status(), StatusCode::OK);
}
