//! Answers, events, and requests that are wrong.

use crate::room::{Page, assign, camera, class, package, scene, stroke};
use serde_json::{Value, json};

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
async fn an_edit_that_comes_again_with_its_id_is_done_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = package(folder.path());
    let undo = json!({ "client": "test", "id": "the undo", "action": { "type": "undo" } }).to_string();
    let page = Page::open(&path);
    page.act(assign(&[0], class(3))).await;
    page.act(assign(&[1], class(5))).await;
    let (_, first) = page.post("edit", undo.clone()).await;
    assert_eq!((first["revision"].as_u64(), first["pieces"].clone()), (Some(3), json!([1])));
    assert_eq!(page.post("edit", undo.clone()).await.1, first);
    drop(page);
    // Also after the program was started again, and after other edits.
    let page = Page::open(&path);
    page.act(assign(&[2], class(7))).await;
    assert_eq!(page.post("edit", undo.clone()).await.1, first);
    assert_eq!(page.labels().await[..3], [(3, -1), (-1, -1), (7, -1)]);
    // After very many it is not known any more what it changed, but that it was done.
    for revision in 5..=80_i64 {
        let id = revision.to_string();
        let again = json!({ "client": "test", "id": id, "action": assign(&[3], class(1 + revision % 40)) });
        assert_eq!(page.post("edit", again.to_string()).await.1["revision"].as_i64(), Some(revision));
    }
    let (status, refused) = page.post("edit", undo).await;
    assert!(status == 409 && refused["error"].as_str().unwrap().contains("done already"), "{refused}");
    assert_eq!(page.get("scene").await["revision"].as_u64(), Some(80));
}

#[tokio::test]
async fn an_edit_is_saved_although_its_page_goes_away_before_the_answer() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    let done = async {
        while page.app.session().standing().revision == 0 {
            tokio::task::yield_now().await;
        }
    };
    let edit = json!({ "client": "test", "action": assign(&[0], class(1)) });
    tokio::select! {
        biased;
        () = done => {}
        _ = page.post("edit", edit.to_string()) => {}
    }
    let mut waits = 0..100;
    while page.app.is_unsaved() && waits.next().is_some() {
        tokio::time::sleep(std::time::Duration::from_millis(100)).await;
    }
    assert!(!page.app.is_unsaved());
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
        (stroke(json!({ "pen": ([[0, 0], [60000, 60000]].repeat(60)) }), class(1)), "expected at most"),
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
    ];
    for (action, expected) in cases {
        let (status, error) = page.refused(action.clone()).await;
        assert!(status == 400 && error.contains(expected), "{action}\n{status} {error}");
    }
    for (path, body) in [
        ("edit", "{"),
        ("edit", "[]"),
        ("edit", r#"{"client":"","action":{"type":"redo"}}"#),
        ("edit", r#"{"client":"c","id":"","action":{"type":"redo"}}"#),
        ("select", r#"{"shape":{"click":[1,1]}}"#),
        ("activity", r#"{"seconds_since_last_input":-1}"#),
        ("activity", "null"),
    ] {
        let (status, body) = page.post(path, body).await;
        assert!(status == 400 && body["help"].is_string(), "{path} {body}");
    }
    // What a stroke and a look have in common is flattened into both; fields of the other are unknown to each.
    let mut painted = stroke(json!({ "click": [1, 1] }), class(1));
    painted["faces"] = true.into();
    let labelled = json!({ "camera": camera(), "shape": { "click": [1, 1] }, "apply": class(1) });
    for (path, body, field) in [("edit", json!({ "client": "c", "action": painted }), "faces"), ("select", labelled, "apply")] {
        let (status, body) = page.post(path, body.to_string()).await;
        assert!(status == 400 && body["error"].as_str().unwrap().contains(&format!("unknown field `{field}`")), "{path} {body}");
    }
    let (status, body) = page.post("pick", json!({ "camera": camera(), "pixel": [200, 1] }).to_string()).await;
    assert!(status == 400 && body["error"].as_str().unwrap().contains("pixel 200, 1 is outside"), "{body}");
    let (status, _) = page.ask(axum::http::Request::get("/api/annotate/events?since=x").body(axum::body::Body::empty()).unwrap()).await;
    assert_eq!(status, 400);
    assert_eq!(page.get("scene").await["revision"].as_u64(), Some(0));
    assert_eq!(page.labels().await, [(-1, -1); 6]);
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
    // Of 100² pixels left and right have 2 × 19.2² in front and 2 × 90 at the side, and both of pair 2 × 9.1² and somewhat more.
    assert!((share - 0.885).abs() < 0.02, "{share}");
    assert_eq!((after["labelled_pieces"].as_u64(), after["unlabelled"].as_array().unwrap().len()), (Some(2), 4));
    let without: Vec<&str> = after["without_instance"].as_array().unwrap().iter().map(|row| row["name"].as_str().unwrap()).collect();
    assert_eq!(without, ["wall"]);
    assert_eq!((after["classes"][0]["pieces"].as_u64(), after["classes"][0]["instances"].as_u64()), (Some(2), Some(1)));
    assert_eq!(after["conflicts"], json!([{ "instance": 1, "classes": [-1, 1] }]));
    // Without cameras there are viewpoints all the same.
    std::fs::write(folder.path().join("bare.scene"), enfilade_scene::to_bytes(&scene())).unwrap();
    let bare = Page::open(&folder.path().join("bare.scene")).get("progress").await;
    assert_eq!(bare["visible"]["views_of"].as_str(), Some("generated viewpoints"));
    assert!(bare["unlabelled"][0]["pixels"].as_u64().unwrap() > 0);
}

#[tokio::test]
async fn the_history_has_what_can_be_undone_and_done_again() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    page.act(assign(&[0], class(1))).await;
    page.act(assign(&[1], class(5))).await;
    page.act(json!({ "type": "undo" })).await;
    let history = page.get("history").await;
    let told = |which: &str| history[which].as_array().unwrap().iter().map(|row| row["description"].as_str().unwrap()).collect::<Vec<_>>();
    assert_eq!((told("done"), told("undone")), (vec!["Class wall on wall"], vec!["Class chair on near"]));
    assert!(history["done"][0]["time"].as_str().unwrap().ends_with('Z'), "{history}");
    page.act(json!({ "type": "redo" })).await;
    assert_eq!(page.get("history").await["done"][0]["description"], "Class chair on near");
}

#[tokio::test]
async fn faces_have_the_colours_of_their_materials() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    assert_eq!(page.get("scene").await["has_face_colors"], true);
    let (_, bytes) = page.bytes("face_colors", &[]).await;
    // The wall's two faces are of plaster, all others of wood.
    assert_eq!((bytes.len() / 3, &bytes[..6]), (page.app.scene().corners.len(), &[231; 6][..]));
    assert!(bytes[6..].iter().all(|&channel| channel == 170), "{:?}", &bytes[6..12]);
}

#[tokio::test]
async fn instances_have_the_colours_of_the_files() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    let (_, bytes) = page.bytes("instance_colors", &[]).await;
    assert_eq!(bytes.len(), 3 << 15);
    let files: Vec<i64> = enfilade_dataset::instance_colors(100).into_iter().flatten().skip(3).collect();
    assert!(bytes[3..303].iter().map(|&channel| i64::from(channel)).eq(files));
}

#[tokio::test]
async fn geometry_is_packed_and_compressed_where_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    let (_, plain) = page.bytes("geometry", &[]).await;
    let (headers, packed) = page.bytes("geometry", &[("accept-encoding", "br, gzip;q=1.0")]).await;
    assert_eq!((&headers["content-encoding"], &headers["x-enfilade-bytes"]), (&"gzip".parse().unwrap(), &plain.len().into()));
    assert!(page.bytes("geometry?most=10", &[]).await.1 == plain, "there is one level");
    let mut unpacked = vec![0; plain.len()];
    assert_eq!(libdeflater::Decompressor::new().gzip_decompress(&packed, &mut unpacked), Ok(plain.len()));
    assert!(unpacked == plain && plain.len() == 64 + 16 + 74 * 32);
    let (status, worked) = page.post("activity", r#"{"seconds_since_last_input":0.5}"#).await;
    assert!(status.is_success(), "{worked}");
    page.act(assign(&[0], class(1))).await;
    let log = page.get("worklog").await;
    assert_eq!((log["actions"].as_u64(), log["sessions"].as_array().unwrap().len()), (Some(1), 1));
}
