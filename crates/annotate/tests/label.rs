//! Labelling a room through the routes, as its page does.

mod room;

use enfilade_annotate::label::{AnnotateOptions, App};
use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::{Array, Dataset, MeshFiles};
use enfilade_scene::{PartLabel, Quiet};
use room::{PARTS, Page, camera, class, package, scene};
use serde_json::{Value, json};

fn stroke(shape: Value, apply: Value) -> Value {
    json!({ "type": "stroke", "camera": camera(), "shape": shape, "apply": apply })
}

fn assign(pieces: &[u32], apply: Value) -> Value {
    json!({ "type": "assign", "pieces": pieces, "apply": apply })
}

#[tokio::test]
async fn a_room_is_labelled_from_nothing_to_hypersims_files() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    let described = page.get("scene").await;
    assert_eq!((described["name"].as_str(), described["pieces"].as_u64(), described["faces"].as_u64()), (Some("room"), Some(6), Some(74)));
    assert_eq!((described["classes"][4]["name"].as_str(), described["next_instance"].as_i64()), (Some("chair"), Some(1)));
    page.act(stroke(json!({ "rectangle": [0, 0, 100, 100] }), class(40))).await;
    page.act(stroke(json!({ "click": [50, 80] }), class(1))).await;
    page.act(stroke(json!({ "line": [[10, 50], [90, 50]] }), json!({ "layer": "instance", "unique": true }))).await;
    page.act(assign(&[0], json!({ "layer": "instance", "value": -1 }))).await;
    let change = page.act(json!({ "type": "assign_each", "pieces": [3, 4, 2], "semantic": [5, 5, 35] })).await;
    assert_eq!((change["pieces"].clone(), change["revision"].as_u64()), (json!([3, 4, 2]), Some(5)));
    page.act(assign(&[5, 2], json!({ "layer": "instance", "new": true }))).await;
    let (status, saved) = page.post("save", "{}").await;
    assert!(status.is_success() && saved["files"].as_array().unwrap().len() >= 9, "{saved}");

    // The line met wall, near, left and right in the order of pieces.
    let expected = [(1, -1), (40, 2), (35, 5), (5, 3), (5, 4), (40, 5)];
    assert_eq!(page.labels().await, expected.map(|(s, i)| (i64::from(s), i64::from(i))));
    let labels_folder = folder.path().join("room.scene.labels");
    let files = MeshFiles::new(&labels_folder);
    let label = |(semantic, instance)| PartLabel { semantic, instance };
    assert_eq!(files.read_labels().unwrap().parts, expected.map(label));
    let read = |name: &str| read_array(&files.file(name)).unwrap();
    assert_eq!(read("mesh_objects_si.hdf5"), Array::i64(&[6, 1], vec![1, 40, 35, 5, 5, 40]));
    assert_eq!(read("metadata_semantic_colors.hdf5").shape, [41, 3]);
    // Five were given out: the wall's too, although nothing has it now.
    assert_eq!(read("metadata_semantic_instance_colors.hdf5").shape, [6, 3]);
    let text = |name: &str| std::fs::read_to_string(labels_folder.join(name)).unwrap();
    assert_eq!(text("metadata_objects.csv"), format!("object_name\n{}\n", PARTS.join("\n")));
    assert!(text("labels.csv").contains("near,40,otherprop,2\n"), "{}", text("labels.csv"));
    assert!(text("metadata_scene_annotation_tool.log").starts_with("[HYPERSIM: SCENE_ANNOTATION_TOOL] Loaded scene:   "));
    page.app.close().unwrap();
    assert!(
        text("metadata_scene_annotation_tool.log")
            .lines()
            .nth(1)
            .unwrap()
            .starts_with("[HYPERSIM: SCENE_ANNOTATION_TOOL] Unloaded scene: ")
    );
}

#[tokio::test]
async fn what_is_behind_is_not_touched_unless_what_hides_it_is_hidden() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    let none = json!({});
    assert_eq!(page.selected(json!({ "rectangle": [0, 0, 100, 100] }), none.clone()).await, [0, 1, 3, 4, 5]);
    assert_eq!(page.selected(json!({ "rectangle": [45, 45, 55, 55] }), none.clone()).await, [1]);
    let hidden = json!({ "hidden": [1] });
    assert_eq!(page.selected(json!({ "rectangle": [0, 0, 100, 100] }), hidden.clone()).await, [0, 2, 3, 4, 5]);
    assert_eq!(page.selected(json!({ "click": [50, 50] }), hidden.clone()).await, [2]);
    assert_eq!(page.selected(json!({ "pen": [[50, 50]] }), json!({ "hidden": [1, 2] })).await, [0]);
    assert!(page.selected(json!({ "rectangle": [200, 200, 300, 300] }), none.clone()).await.is_empty());
    // A pen from left of the left box to right of the right one, outside of the image in between.
    assert_eq!(
        page.selected(json!({ "pen": [[10, 50], [-50, 50], [-50, 500], [150, 500], [150, 50], [90, 50]] }), none.clone()).await,
        [0, 3, 4]
    );
    let (_, picked) = page.post("pick", json!({ "camera": camera(), "pixel": [50.5, 50.5] }).to_string()).await;
    assert_eq!((picked["piece"].as_i64(), picked["point"][1].as_f64()), (Some(1), Some(-0.5)));
    assert!((picked["distance_m"].as_f64().unwrap() - 4.5).abs() < 1e-3);
    let away = json!({ "position": [0, -5, 1], "orientation": [-1, 0, 0, 0, 0, 1, 0, 1, 0], "fov_y_deg": 60, "width": 100, "height": 100 });
    let (_, nothing) = page.post("pick", json!({ "camera": away, "pixel": [50, 50] }).to_string()).await;
    assert_eq!(nothing, json!({ "piece": -1 }));
    let (_, look) = page.post("select", json!({ "camera": camera(), "shape": { "click": [50, 50] }, "faces": true }).to_string()).await;
    let face = look["faces"][0].as_u64().unwrap();
    assert!(look["faces"].as_array().unwrap().len() == 1 && (2..14).contains(&face), "{look}");
}

#[tokio::test]
async fn every_pixel_of_a_rectangle_sees_what_its_ray_sees() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    let look = |shape: Value, hidden: Value| json!({ "camera": camera(), "shape": shape, "faces": true, "hidden": hidden });
    let all = page.post("select", look(json!({ "rectangle": [0, 0, 99.9, 99.9] }), json!([])).to_string()).await.1;
    let mut pixels = Vec::new();
    for y in 0..100 {
        pixels.extend([[0.5, f64::from(y) + 0.5], [99.5, f64::from(y) + 0.5]]);
    }
    let rays = page.post("select", look(json!({ "pen": pixels }), json!([])).to_string()).await.1;
    assert_eq!(all["faces"], rays["faces"]);
}

#[tokio::test]
async fn filters_ask_each_face_before_the_selection_grows() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    page.act(assign(&[1, 2], json!({ "layer": "instance", "new": true }))).await;
    page.act(assign(&[1, 3], class(7))).await;
    let everything = json!({ "rectangle": [0, 0, 100, 100] });
    let filtered = async |filter: &str, expand: &str| {
        page.selected(everything.clone(), json!({ "filters": { filter: true }, "expand": expand })).await
    };
    // near: instance and class; behind: instance, not visible; left: class.
    assert_eq!(filtered("only_without_instance", "piece").await, [0, 3, 4, 5]);
    assert_eq!(filtered("only_with_instance", "piece").await, [1]);
    assert_eq!(filtered("only_without_class", "piece").await, [0, 4, 5]);
    assert_eq!(filtered("only_with_class", "piece").await, [1, 3]);
    // The expansion takes what the filter would not have let through, and what is hidden.
    assert_eq!(filtered("only_with_instance", "instance").await, [1, 2]);
    assert_eq!(filtered("only_without_instance", "class").await, [0, 1, 3, 4, 5]);
    assert_eq!(filtered("only_with_instance", "class").await, [1, 3]);
    let both = json!({ "filters": { "only_without_class": true, "only_with_instance": true } });
    assert!(page.selected(everything.clone(), both).await.is_empty());
    let contradiction =
        json!({ "camera": camera(), "shape": everything, "filters": { "only_with_class": true, "only_without_class": true } });
    let (status, body) = page.post("select", contradiction.to_string()).await;
    assert!(status == 400 && body["error"].as_str().unwrap().contains("contradict"), "{body}");
}

#[tokio::test]
async fn erasing_and_unique_ids() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    page.act(stroke(json!({ "rectangle": [0, 0, 100, 100] }), json!({ "layer": "instance", "unique": true }))).await;
    assert_eq!(page.labels().await.iter().map(|l| l.1).collect::<Vec<_>>(), [1, 2, -1, 3, 4, 5]);
    page.act(stroke(json!({ "click": [50, 50] }), json!({ "layer": "instance", "value": -1 }))).await;
    let change = page.act(assign(&[1, 2], json!({ "layer": "instance", "unique": true }))).await;
    assert_eq!((change["instance"].clone(), change["next_instance"].as_i64()), (json!([6, 7]), Some(8)));
    // What was undone is not given out again.
    let change = page.act(json!({ "type": "undo" })).await;
    assert_eq!((change["instance"].clone(), change["next_instance"].as_i64()), (json!([-1, -1]), Some(8)));
    let same = page.act(assign(&[0], json!({ "layer": "instance", "value": 1 }))).await;
    assert_eq!((same["revision"].as_u64(), same["description"].as_str()), (Some(4), Some("Nothing to change")));
}

#[tokio::test]
async fn parts_are_split_in_three_ways() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    page.act(assign(&[5], class(18))).await;
    let change = page.act(json!({ "type": "split", "piece": 5, "by": "component" })).await;
    assert_eq!((change["added"][0]["name"].as_str(), change["added"][0]["piece"].as_u64()), (Some("pair~2"), Some(6)));
    assert_eq!((change["added"][0]["faces"].as_u64(), change["added"][0]["semantic"].as_i64()), (Some(12), Some(18)));
    assert_eq!((change["resized"][0]["faces"].as_u64(), change["resized"][0]["max"][0].as_f64()), (Some(12), Some(-0.75)));
    assert_eq!(change["moved_faces"][0].as_array().unwrap().len(), 12);
    assert!(change["moved_faces"][1].as_array().unwrap().iter().all(|piece| piece == 6));
    // Both halves are boxes of one geometry, and so are near, left and right; the wall is another.
    let keys = page.get("pieces").await["geometry_keys"].clone();
    assert!(
        keys[5] == keys[6] && keys[5] == keys[2] && keys[1] == keys[3] && keys[3] == keys[4] && keys[0] != keys[1] && keys[1] != keys[2]
    );
    // The front of the left half, painted.
    let (_, look) = page
        .post(
            "select",
            json!({ "camera": camera(), "shape": { "rectangle": [26, 7, 34, 15] }, "faces": true, "filters": { "only_with_class": true } })
                .to_string(),
        )
        .await;
    let painted: Vec<u64> =
        look["faces"].as_array().unwrap().iter().map(|f| f.as_u64().unwrap()).filter(|f| (50..62).contains(f)).collect();
    let change = page.act(json!({ "type": "split", "piece": 5, "by": { "faces": painted } })).await;
    assert_eq!((change["added"][0]["name"].as_str(), change["added"][0]["faces"].as_u64()), (Some("pair~3"), Some(painted.len() as u64)));
    assert_eq!(change["resized"][0]["faces"].as_u64(), Some(12 - painted.len() as u64));
    assert!(page.refused(json!({ "type": "split", "piece": 5, "by": { "faces": [0] } })).await.1.contains("face 0 belongs to piece 0"));
    assert_eq!(page.refused(json!({ "type": "split", "piece": 1, "by": "component" })).await.0, 409);
    assert_eq!(page.refused(json!({ "type": "split", "piece": 1, "by": "material" })).await.0, 409);
    assert_eq!(page.refused(json!({ "type": "split", "piece": 1, "by": { "faces": [] } })).await.0, 409);
    // Undone, everything is whole again.
    page.act(json!({ "type": "undo" })).await;
    let change = page.act(json!({ "type": "undo" })).await;
    assert_eq!((change["removed"].clone(), change["resized"][0]["faces"].as_u64()), (json!([6]), Some(24)));
    assert_eq!(page.get("pieces").await["names"], json!(PARTS));
}

#[tokio::test]
async fn a_mesh_folder_is_split_by_material_and_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    dataset.write_scene("room", &scene()).unwrap();
    let mesh = dataset.mesh_files("room");
    let faces = mesh.read().unwrap().faces.len();
    // A box of two materials, as Hypersim has them.
    let materials = (0..faces as i64).map(|face| i64::from((2..8).contains(&face))).collect();
    enfilade_dataset::replace_file(&mesh.file("mesh_faces_mi.hdf5"), |aside| {
        enfilade_dataset::hdf5::write_array(aside, &Array::i64(&[faces], materials), enfilade_dataset::hdf5::Storage::Contiguous, &[])
    })
    .unwrap();
    let open = |path: &std::path::Path| Page::open(path);
    let page = open(folder.path());
    let change = page.act(json!({ "type": "split", "piece": 1, "by": "material" })).await;
    assert_eq!((change["added"][0]["name"].as_str(), change["added"][0]["faces"].as_u64()), (Some("near~2"), Some(6)));
    page.act(assign(&[6], class(9))).await;
    page.act(assign(&[1], json!({ "layer": "instance", "new": true }))).await;
    page.post("save", "{}").await;
    assert_eq!(mesh.read_splits().unwrap(), [1]);
    assert_eq!(mesh.read_objects_of_faces().unwrap()[..9], [0, 0, 1, 1, 1, 1, 1, 1, 6]);
    let before = page.labels().await;
    drop(page);
    // The folder itself, or the scene's: the same, and nothing is split twice.
    let again = open(&folder.path().join("scenes/room"));
    assert_eq!(again.labels().await, before);
    assert_eq!(again.get("scene").await["revision"].as_u64(), Some(3));
    for _ in 0..3 {
        again.act(json!({ "type": "undo" })).await;
    }
    again.post("save", "{}").await;
    assert!(mesh.read_splits().unwrap().is_empty());
    drop(again);
    let mesh_folder = folder.path().join("scenes/room/_detail/mesh");
    assert_eq!(open(&mesh_folder).labels().await, [(-1, -1); 6]);
}

#[tokio::test]
async fn undo_and_redo_go_on_after_a_restart_and_after_a_torn_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = package(folder.path());
    let mut states = Vec::new();
    let state = async |page: &Page| {
        let pieces = page.get("pieces").await;
        let (_, bytes) = page.bytes("geometry", &[]).await;
        (pieces["names"].clone(), pieces["semantic"].clone(), pieces["instance"].clone(), pieces["faces"].clone(), bytes)
    };
    let edits = [
        assign(&[0, 1], class(3)),
        json!({ "type": "split", "piece": 5, "by": "component" }),
        assign(&[6, 5], json!({ "layer": "instance", "unique": true })),
        json!({ "type": "split", "piece": 6, "by": { "faces": [70, 71, 73] } }),
        assign(&[7], class(31)),
        stroke(json!({ "rectangle": [0, 0, 100, 100] }), class(12)),
    ];
    {
        let page = Page::open(&path);
        states.push(state(&page).await);
        for edit in &edits {
            page.act(edit.clone()).await;
            states.push(state(&page).await);
        }
    }
    {
        let page = Page::open(&path);
        assert_eq!(state(&page).await, states[6]);
        for at in (0..6).rev() {
            page.act(json!({ "type": "undo" })).await;
            assert_eq!(state(&page).await, states[at], "undone to {at}");
        }
        assert_eq!(page.refused(json!({ "type": "undo" })).await, (409, "there is nothing to undo".into()));
    }
    {
        let page = Page::open(&path);
        assert_eq!(state(&page).await, states[0]);
        for at in 1..=4 {
            page.act(json!({ "type": "redo" })).await;
            assert_eq!(state(&page).await, states[at], "done again to {at}");
        }
    }
    // The program dies while it writes: the last line is cut in the middle.
    let log = folder.path().join("room.scene.labels/annotation_log.jsonl");
    let text = std::fs::read_to_string(&log).unwrap();
    let last = text.trim_end().rfind('\n').unwrap() + 1;
    std::fs::write(&log, &text[..last + (text.len() - last) / 2]).unwrap();
    let page = Page::open(&path);
    assert_eq!(state(&page).await, states[3]);
    page.act(json!({ "type": "redo" })).await;
    assert_eq!(state(&page).await, states[4]);
    // A new edit ends what could be done again.
    page.act(assign(&[2], class(5))).await;
    assert_eq!(page.refused(json!({ "type": "redo" })).await.0, 409);
    drop(page);
    assert_eq!(Page::open(&path).labels().await[2], (5, -1));
    assert_eq!(std::fs::read_to_string(&log).unwrap().lines().count(), 1 + 6 + 6 + 3 + 2);
}

#[tokio::test]
async fn logs_of_other_scenes_and_damaged_ones_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = package(folder.path());
    let labels = Some(folder.path().join("labels"));
    let options = AnnotateOptions { path: path.clone(), labels: labels.clone(), ..AnnotateOptions::default() };
    let error = |options: &AnnotateOptions| App::open(options, &Quiet).err().unwrap().to_string();
    let page = Page::with(&options);
    page.act(assign(&[0], class(3))).await;
    assert!(error(&options).contains("somebody annotates this scene already"));
    drop(page);
    let mut other = scene();
    other.parts.pop();
    std::fs::write(&path, enfilade_scene::to_bytes(&other)).unwrap();
    let message = error(&options);
    assert!(
        message.contains("is about another scene (\"room\" of 6 parts and 74 faces; here \"room\" of 5 parts and 50 faces)"),
        "{message}"
    );
    std::fs::write(&path, enfilade_scene::to_bytes(&scene())).unwrap();
    let log = folder.path().join("labels/annotation_log.jsonl");
    let good = std::fs::read_to_string(&log).unwrap();
    std::fs::write(&log, good.replace("\"pieces\":[0]", "\"pieces\":[99]")).unwrap();
    assert!(error(&options).contains("annotation_log.jsonl:2: the labels do not fit the pieces"), "{}", error(&options));
    std::fs::write(&log, format!("{good}nonsense\n")).unwrap();
    assert!(error(&options).contains("annotation_log.jsonl:3: "), "{}", error(&options));
    std::fs::write(&log, &good[..20]).unwrap();
    assert_eq!(Page::with(&options).labels().await[0], (-1, -1));
}

#[tokio::test]
async fn two_pages_lose_no_edit_and_each_hears_all() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    let ten = async |first: u32| {
        let mut revisions = Vec::new();
        for i in first..first + 10 {
            let change = page.act(assign(&[i % 6], json!({ "layer": "instance", "new": true }))).await;
            revisions.push(change["revision"].as_u64().unwrap());
        }
        revisions
    };
    let (one, other) = tokio::join!(ten(0), ten(3));
    let mut revisions = [one, other].concat();
    revisions.sort_unstable();
    assert_eq!(revisions, (1..=20).collect::<Vec<u64>>());
    let event = page.first_event("events?since=19").await;
    assert!(event.contains("id: 20\n") && event.contains("\"revision\":20"), "{event}");
    assert!(page.first_event("events?since=7").await.contains("id: 8\n"));
    assert!(page.first_event("events?since=21").await.contains("event: reload\n"));
    let listening = page.first_event("events");
    let (event, _) = tokio::join!(listening, async {
        tokio::task::yield_now().await;
        page.act(assign(&[0], class(1))).await
    });
    assert!(event.contains("id: 21\n") && event.contains("Class wall on wall"), "{event}");
}

#[tokio::test]
async fn malformed_requests_are_named_and_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    let broken = |field: &str, value: Value| {
        let mut camera = camera();
        camera[field] = value;
        json!({ "type": "stroke", "camera": camera, "shape": { "click": [1, 1] }, "apply": class(1) })
    };
    let skewed = json!([1, 0, 0, 0, 0, -1, 0, 1, 0.5]);
    let cases = [
        (broken("position", json!([1e300, 0, 0])), "camera.position"),
        (broken("position", json!([null, 0, 0])), "not understood"),
        (broken("orientation", skewed), "camera.orientation"),
        (broken("orientation", json!([0, 0, 0, 0, 0, 0, 0, 0, 0])), "camera.orientation"),
        (broken("fov_y_deg", json!(180)), "camera.fov_y_deg is 180"),
        (broken("width", json!(8193)), "camera.width is 8193; expected 1 to 8192"),
        (broken("height", json!(0)), "camera.height is 0"),
        (broken("height", json!(-1)), "not understood"),
        (stroke(json!({ "pen": [] }), class(1)), "shape.pen is empty"),
        (stroke(json!({ "click": [1e9, 0] }), class(1)), "no image coordinate"),
        (stroke(json!({ "circle": [0, 0, 1] }), class(1)), "circle"),
        (stroke(json!({ "pen": [[0, 0], [60000, 60000]].repeat(60) }), class(1)), "expected at most"),
        (stroke(json!({ "click": [1, 1] }), class(41)), "there is no class 41; expected one of the list's 40 classes from 1 to 40"),
        (assign(&[6], class(1)), "pieces names piece 6, but there are 6 (0 to 5)"),
        (assign(&[0], class(0)), "there is no class 0"),
        (assign(&[0], json!({ "layer": "semantic" })), "apply is none of"),
        (assign(&[0], json!({ "layer": "instance", "value": 2 })), "there is no instance 2; expected 1 to 1"),
        (assign(&[0], json!({ "layer": "instance", "unique": true, "new": true })), "apply is none of"),
        (assign(&[0], json!({ "layer": "material", "value": 1 })), "material"),
        (json!({ "type": "assign_each", "pieces": [0, 1], "semantic": [1] }), "1 classes for 2 pieces"),
        (json!({ "type": "assign_each", "pieces": [0, 0], "semantic": [1, 2] }), "named twice"),
        (json!({ "type": "split", "piece": 7, "by": "component" }), "piece names piece 7"),
        (json!({ "type": "split", "piece": 1, "by": "colour" }), "colour"),
        (json!({ "type": "split", "piece": 1, "by": { "faces": [74] } }), "there is no face 74"),
        (json!({ "type": "paint" }), "paint"),
        (json!({ "type": "undo", "twice": true }), "twice"),
    ];
    for (action, expected) in cases {
        let (status, error) = page.refused(action.clone()).await;
        assert!(status == 400 && error.contains(expected), "{action}\n{status} {error}");
    }
    for (path, body) in [
        ("edit", "{"),
        ("edit", "[]"),
        ("edit", r#"{"client":"","action":{"type":"redo"}}"#),
        ("select", r#"{"shape":{"click":[1,1]}}"#),
        ("activity", r#"{"seconds_since_last_input":-1}"#),
        ("activity", "null"),
    ] {
        let (status, body) = page.post(path, body).await;
        assert!(status == 400 && body["help"].is_string(), "{path} {body}");
    }
    let (status, body) = page.post("pick", json!({ "camera": camera(), "pixel": [200, 1] }).to_string()).await;
    assert!(status == 400 && body["error"].as_str().unwrap().contains("pixel 200, 1 is outside"), "{body}");
    let (status, _) = page.ask(axum::http::Request::get("/api/annotate/events?since=x").body(axum::body::Body::empty()).unwrap()).await;
    assert_eq!(status, 400);
    assert_eq!(page.get("scene").await["revision"].as_u64(), Some(0));
    assert_eq!(page.labels().await, [(-1, -1); 6]);
}

#[tokio::test]
async fn a_list_of_the_users_is_used_saved_and_found_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = package(folder.path());
    let list = folder.path().join("classes.csv");
    std::fs::write(
        &list,
        "semantic_id,semantic_name,semantic_color_r,semantic_color_g,semantic_color_b\n1,soft,255,0,0\n77,hard,0,0,255\n",
    )
    .unwrap();
    {
        let page = Page::with(&AnnotateOptions { path: path.clone(), classes: Some(list), ..AnnotateOptions::default() });
        assert_eq!(
            page.get("scene").await["classes"],
            json!([{ "id": 1, "name": "soft", "color": [255, 0, 0] }, { "id": 77, "name": "hard", "color": [0, 0, 255] }])
        );
        assert!(page.refused(assign(&[0], class(2))).await.1.contains("there is no class 2"));
        page.act(assign(&[0, 1], class(77))).await;
        page.post("save", "{}").await;
    }
    let files = MeshFiles::new(folder.path().join("room.scene.labels"));
    assert_eq!(files.read_labels().unwrap().parts[1].semantic, 77);
    assert_eq!(
        (read_array(&files.file("metadata_semantic_colors.hdf5")).unwrap().shape, files.read_last_class().unwrap()),
        (vec![78, 3], 77)
    );
    assert!(!files.file("labels.csv").exists());
    assert_eq!(Page::open(&path).get("scene").await["classes"][1]["name"].as_str(), Some("hard"));
}

#[tokio::test]
async fn progress_counts_what_is_seen_and_names_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let mut with_camera = scene();
    with_camera.cameras.push(enfilade_scene::StartCamera {
        name: "door".into(),
        position: enfilade_math::DVec3::new(0.0, -5.0, 1.0),
        world_from_camera: enfilade_math::DMat3::from_cols_array(&[1., 0., 0., 0., 0., 1., 0., -1., 0.]),
        fov_x_rad: 60f64.to_radians(),
        aspect: 1.0,
    });
    let path = folder.path().join("room.scene");
    std::fs::write(&path, enfilade_scene::to_bytes(&with_camera)).unwrap();
    let page = Page::open(&path);
    let before = page.get("progress").await;
    assert_eq!((before["visible"]["views_of"].as_str(), before["visible"]["views"].as_u64()), (Some("planned cameras"), Some(1)));
    let names: Vec<&str> = before["unlabelled"].as_array().unwrap().iter().map(|row| row["name"].as_str().unwrap()).collect();
    assert_eq!((names[0], names[5]), ("wall", "behind"));
    assert_eq!(before["unlabelled"][0]["best_view"], json!({ "camera": "door", "frame": 0 }));
    assert_eq!(before["unlabelled"][5]["best_view"], Value::Null);
    page.act(assign(&[0, 1], class(1))).await;
    page.act(assign(&[1, 2], json!({ "layer": "instance", "new": true }))).await;
    let after = page.get("progress").await;
    let share = after["visible"]["pixels_labelled_share"].as_f64().unwrap();
    // left, right and both of pair are 2 × 19.2² + 2 × 9.1² of 100² pixels, more or less.
    assert!((share - 0.91).abs() < 0.02, "{share}");
    assert_eq!((after["labelled_pieces"].as_u64(), after["unlabelled"].as_array().unwrap().len()), (Some(2), 4));
    assert_eq!((after["classes"][0]["pieces"].as_u64(), after["classes"][0]["instances"].as_u64()), (Some(2), Some(1)));
    assert_eq!(after["conflicts"], json!([{ "instance": 1, "classes": [-1, 1] }]));
    // Without cameras there are viewpoints all the same.
    std::fs::write(folder.path().join("bare.scene"), enfilade_scene::to_bytes(&scene())).unwrap();
    let bare = Page::open(&folder.path().join("bare.scene")).get("progress").await;
    assert_eq!(bare["visible"]["views_of"].as_str(), Some("generated viewpoints"));
    assert!(bare["unlabelled"][0]["pixels"].as_u64().unwrap() > 0);
}

#[tokio::test]
async fn geometry_is_packed_and_compressed_where_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    let (_, plain) = page.bytes("geometry", &[]).await;
    let (headers, packed) = page.bytes("geometry", &[("accept-encoding", "br, gzip;q=1.0")]).await;
    assert_eq!(headers["content-encoding"], "gzip");
    let mut unpacked = vec![0; plain.len()];
    assert_eq!(libdeflater::Decompressor::new().gzip_decompress(&packed, &mut unpacked), Ok(plain.len()));
    assert!(unpacked == plain && plain.len() == 64 + 16 + 74 * 32);
    let (status, worked) = page.post("activity", r#"{"seconds_since_last_input":0.5}"#).await;
    assert!(status.is_success(), "{worked}");
    page.act(assign(&[0], class(1))).await;
    let log = page.get("worklog").await;
    assert_eq!((log["actions"].as_u64(), log["sessions"].as_array().unwrap().len()), (Some(1), 1));
}
