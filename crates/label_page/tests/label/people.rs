//! Several people at one scene, copies of things, and labels of earlier versions.

use crate::room::{Page, assign, class, package, scene};
use enfilade_label_page::{AnnotateOptions, App};
use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::{Quiet, Scene, to_bytes};
use serde_json::{Value, json};
use std::path::Path;

/// An action of a person: status and answer.
async fn by(page: &Page, who: &str, action: Value) -> (u16, Value) {
    let (status, answer) = page.post("edit", json!({ "client": who, "who": who, "action": action }).to_string()).await;
    (status.as_u16(), answer)
}

#[tokio::test]
async fn undo_is_a_persons_own_and_is_kept_by_the_log() {
    let folder = tempfile::tempdir().unwrap();
    let path = package(folder.path());
    let page = Page::open(&path);
    by(&page, "Ada", assign(&[1], class(5))).await;
    by(&page, "Ben", assign(&[2], class(7))).await;
    let (_, change) = by(&page, "Ada", json!({ "type": "undo" })).await;
    assert_eq!((&change["pieces"], change["who"].as_str(), change["of"].as_str()), (&json!([1]), Some("Ada"), Some("Ada")));
    assert_eq!(change["people"]["Ben"]["undo"], "Class table on behind");
    assert_eq!(change["people"]["Ada"], json!({ "undo": null, "redo": "Class chair on near" }));
    by(&page, "Ben", assign(&[1], class(3))).await;
    let (status, refused) = by(&page, "Ada", json!({ "type": "redo" })).await;
    assert!(status == 409 && refused["error"].as_str().unwrap().contains("Ben has changed the same since"), "{refused}");
    assert_eq!(by(&page, "Ada", json!({ "type": "undo" })).await.0, 409);
    // The history is everybody's.
    let (_, change) = by(&page, "Ada", json!({ "type": "undo", "everyone": true })).await;
    assert_eq!((change["of"].as_str(), page.labels().await[1]), (Some("Ben"), (-1, -1)));
    let history = page.get("history").await;
    assert_eq!((&history["done"][0]["who"], &history["undone"][0]["who"]), (&json!("Ben"), &json!("Ben")));
    let log = std::fs::read_to_string(folder.path().join("room.scene.labels/annotation_log.jsonl")).unwrap();
    assert!(
        log.starts_with("{\"format\":\"enfilade annotation log 2\",") && log.contains("{\"type\":\"undo_of\",\"revision\":1}"),
        "{log}"
    );
    let labels = page.labels().await;
    drop(page);
    let page = Page::open(&path);
    assert_eq!(page.labels().await, labels);
    by(&page, "Ada", json!({ "type": "redo" })).await;
    assert_eq!(page.labels().await[1], (3, -1), "who undid it may do it again");
}

#[tokio::test]
async fn reviews_have_names_and_every_page_hears_of_them() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    let review = json!({ "client": "a", "who": "Ada", "pieces": [1], "state": "question", "note": "a stool?" });
    let heard = page.first_event("events");
    let (event, (_, rows)) = tokio::join!(heard, async {
        tokio::task::yield_now().await;
        page.post("review", review.to_string()).await
    });
    assert!(event.contains("event: reviews\n"), "{event}");
    assert_eq!(rows, json!([{ "piece": 1, "state": "question", "note": "a stool?", "who": "Ada" }]));
    let table = std::fs::read_to_string(folder.path().join("room.scene.labels/metadata_object_review.csv")).unwrap();
    assert_eq!(table, "object_name,state,note,who\nnear,question,a stool?,Ada\n");
}

#[tokio::test]
async fn copies_are_labelled_with_instances_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    page.act(assign(&[1], json!({ "layer": "semantic", "value": 5, "new": true }))).await;
    let change = page.act(json!({ "type": "same_again", "pieces": [1] })).await;
    assert_eq!((&change["pieces"], &change["semantic"], &change["instance"]), (&json!([3, 4]), &json!([5, 5]), &json!([2, 3])));
    assert_eq!(change["description"], "The same again: 2 copies of near");
    let (status, error) = page.refused(json!({ "type": "same_again", "pieces": [1] })).await;
    assert!(status == 409 && error.contains("all 2 copies of \"near\" have classes already"), "{error}");
    assert!(page.refused(json!({ "type": "same_again", "pieces": [0] })).await.1.contains("no class to give"));
}

/// The change by labelling the second and third part as one thing, and its copies alike, in a room whose parts have these places and meshes.
async fn same_again(folder: &Path, mut room: Scene, places: [DAffine3; 6], meshes: [u32; 6]) -> Value {
    for (part, (place, mesh)) in room.parts.iter_mut().zip(places.into_iter().zip(meshes)) {
        (part.world_from_mesh, part.mesh) = (place, mesh);
    }
    let path = folder.join("room.scene");
    std::fs::write(&path, to_bytes(&room)).unwrap();
    let page = Page::open(&path);
    page.act(assign(&[1, 2], json!({ "layer": "semantic", "value": 5, "new": true }))).await;
    page.act(json!({ "type": "same_again", "pieces": [2, 1] })).await
}

/// The room as two seats of two boxes each, one turned, and two boxes that stand otherwise.
#[tokio::test]
async fn copies_of_several_pieces_have_the_same_arrangement() {
    let folder = tempfile::tempdir().unwrap();
    let room = scene();
    let seat = |x: f64, turn: f64| DAffine3::from_translation(DVec3::new(x, 0.0, 0.0)) * DAffine3::from_rotation_z(turn);
    let above = DAffine3::from_translation(DVec3::new(0.2, 0.0, 0.8));
    let places = [DAffine3::IDENTITY, seat(0.0, 0.0), seat(0.0, 0.0) * above, seat(5.0, 1.0), seat(-5.0, 0.0), seat(5.0, 1.0) * above];
    let meshes = [0, 1, 2, 1, 1, 2];
    let change = same_again(folder.path(), room, places, meshes).await;
    assert_eq!((&change["pieces"], &change["instance"]), (&json!([3, 5]), &json!([2, 2])), "{change}");
}

/// A seat of two boxes, one mirrored whose boxes list their faces the other way, and two boxes that stand otherwise.
#[tokio::test]
async fn mirrored_copies_are_found_whatever_the_order_of_their_faces() {
    let folder = tempfile::tempdir().unwrap();
    let mut room = scene();
    let [mut seat, mut back] = [1, 2].map(|mesh| (*room.meshes[mesh]).clone());
    seat.triangles.reverse();
    back.triangles.reverse();
    room.meshes.extend([seat.into(), back.into()]);
    let at = |x: f64, z: f64| DAffine3::from_translation(DVec3::new(x, 0.0, z));
    let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let arm = at(0.2, 0.8) * DAffine3::from_rotation_z(0.4);
    let places = [DAffine3::IDENTITY, at(0.0, 0.0), arm, at(5.0, 0.0) * mirror, at(-5.0, 0.0), at(5.0, 0.0) * mirror * arm];
    let meshes = [0, 1, 2, 4, 1, 5];
    let change = same_again(folder.path(), room, places, meshes).await;
    assert_eq!((&change["pieces"], &change["instance"]), (&json!([3, 5]), &json!([2, 2])), "{change}");
}

#[tokio::test]
async fn labels_of_an_earlier_version_are_carried_over_by_name_and_shape() {
    let folder = tempfile::tempdir().unwrap();
    let path = package(folder.path());
    let page = Page::open(&path);
    page.act(assign(&[0], class(1))).await;
    page.act(assign(&[1, 2], json!({ "layer": "semantic", "value": 5, "unique": true }))).await;
    page.act(assign(&[5], class(7))).await;
    page.act(json!({ "type": "split", "piece": 5, "by": "component" })).await;
    page.act(assign(&[6], class(8))).await;
    page.post("save", "{}").await;
    page.app.close().unwrap();
    drop(page);
    // Exported again: the wall is gone, `behind` has another name, and the parts another order.
    let mut room = scene();
    room.parts.remove(0);
    room.parts.reverse();
    room.parts.iter_mut().filter(|part| part.name == "behind").for_each(|part| part.name = "hidden".into());
    std::fs::write(&path, to_bytes(&room)).unwrap();
    let labels = folder.path().join("room.scene.labels");
    let options = AnnotateOptions { path: path.clone(), ..AnnotateOptions::default() };
    let refused = App::open(&options, &Quiet).err().unwrap().to_string();
    assert!(refused.contains("is about another scene") && refused.contains("--carry"), "{refused}");
    let carrying = AnnotateOptions { carry: Some(labels.clone()), ..options.clone() };
    let page = Page::with(&carrying);
    // pair, right, left, hidden, near
    assert_eq!(page.labels().await, [(-1, -1), (-1, -1), (-1, -1), (5, 2), (5, 1)]);
    let list = std::fs::read_to_string(labels.join("labels_carried.csv")).unwrap();
    for row in [
        "wall,,1,-1,not: no part has its name or shape",
        "near,near,5,1,by name and shape",
        "behind,hidden,5,2,by shape and place; its name differs",
        "pair,,7,-1,\"not: it was split, and its pieces have several labels\"",
        ",left,,,no label for it",
    ] {
        assert!(list.contains(row), "{row}: {list}");
    }
    let rows = page.get("carried").await;
    assert_eq!(rows.as_array().unwrap().len(), list.lines().count() - 1);
    assert_eq!((&rows[1]["object_name"], &rows[1]["carried"]), (&json!("near"), &json!("by name and shape")));
    assert!(labels.join("annotation_log_1.jsonl").is_file());
    let change = page.act(json!({ "type": "undo" })).await;
    assert_eq!(change["description"], "Undone: Carried over: the labels of 2 parts");
    page.act(json!({ "type": "redo" })).await;
    page.app.close().unwrap();
    drop(page);
    assert!(App::open(&carrying, &Quiet).err().unwrap().to_string().contains("has edits already"));
    assert_eq!(Page::with(&options).labels().await[3], (5, 2));
}
