//! Strokes, filters, expansion, labels, splits.

use crate::room::{PARTS, Page, assign, camera, class, package, stroke};
use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::{Array, MeshFiles};
use enfilade_math::DVec3;
use enfilade_scene::PartLabel;
use serde_json::{Value, json};

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
    assert!(picked["piece"] == 1 && (picked["point"][1].as_f64().unwrap() + 0.5).abs() < 1e-5, "{picked}");
    assert!((picked["distance_m"].as_f64().unwrap() - 4.5).abs() < 1e-3);
    let away = json!({ "position": [0, -5, 1], "orientation": [-1, 0, 0, 0, 0, 1, 0, 1, 0], "fov_y_deg": 60, "width": 100, "height": 100 });
    let (_, nothing) = page.post("pick", json!({ "camera": away, "pixel": [50, 50] }).to_string()).await;
    assert_eq!(nothing, json!({ "piece": -1 }));
    let (_, look) = page.post("select", json!({ "camera": camera(), "shape": { "click": [50, 50] }, "faces": true }).to_string()).await;
    let face = look["faces"][0].as_u64().unwrap();
    assert!(look["faces"].as_array().unwrap().len() == 1 && (2..14).contains(&face), "{look}");
}

#[tokio::test]
async fn a_viewpoint_sees_what_it_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    // From the front `behind` is hidden by `near`, and the wall is seen squarely.
    for piece in 0..6 {
        let (_, place) = page.post("viewpoint", json!({ "camera": camera(), "pieces": [piece] }).to_string()).await;
        let point = |name: &str| [0, 1, 2].map(|axis| place[name][axis].as_f64().unwrap());
        let [from, to] = ["from", "to"].map(|name| DVec3::from_array(point(name)));
        let back = (from - to).normalize();
        let right = DVec3::Z.cross(back).normalize();
        let up = back.cross(right);
        let orientation: Vec<f64> = (0..3).flat_map(|axis| [right[axis], up[axis], back[axis]]).collect();
        let seen = json!({ "position": from.to_array(), "orientation": orientation, "fov_y_deg": 60, "width": 100, "height": 100 });
        let look = json!({ "camera": seen, "shape": { "rectangle": [0, 0, 100, 100] } });
        let (_, selected) = page.post("select", look.to_string()).await;
        assert!(selected["pieces"].as_array().unwrap().contains(&json!(piece)), "{piece}: {place} {selected}");
    }
    let (status, refused) = page.post("viewpoint", json!({ "camera": camera(), "pieces": [6] }).to_string()).await;
    assert!(status == 400 && refused["error"].as_str().unwrap().contains("piece 6"), "{refused}");
    assert_eq!(page.post("viewpoint", json!({ "camera": camera(), "pieces": [] }).to_string()).await.1, Value::Null);
}

#[tokio::test]
async fn what_lies_before_the_near_plane_is_not_touched() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    let mut camera = camera();
    let mut seen = Vec::new();
    for near_m in [0.0, 4.6, 5.6] {
        camera["near_m"] = json!(near_m);
        let (_, picked) = page.post("pick", json!({ "camera": camera, "pixel": [50.5, 50.5] }).to_string()).await;
        for shape in [json!({ "click": [50, 50] }), json!({ "rectangle": [48, 48, 52, 52] })] {
            let (_, selected) = page.post("select", json!({ "camera": camera, "shape": shape }).to_string()).await;
            assert_eq!(selected["pieces"], json!([picked["piece"]]), "{near_m} {shape}");
        }
        seen.push((picked["piece"].as_i64(), picked["distance_m"].as_f64().map(|distance| (10.0 * distance).round())));
    }
    // The front of the box, its back from within, and what is behind it.
    assert_eq!(seen[..2], [(Some(1), Some(45.0)), (Some(1), Some(55.0))]);
    assert_eq!(seen[2].0, Some(2));
    camera["near_m"] = json!(-1);
    let (status, refused) = page.post("pick", json!({ "camera": camera, "pixel": [50, 50] }).to_string()).await;
    assert!(status == 400 && refused["error"].as_str().unwrap().contains("near_m"), "{refused}");
}

#[tokio::test]
async fn what_lies_outside_of_the_clip_box_is_not_touched() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    let mut camera = camera();
    // The boxes of `pair` are at 2.75 to 3.25 m, `left` ends at x = -1.5 m, the wall is at y = 5 m.
    for (min, max, expected) in [
        ([-20.0; 3], [20.0; 3], json!([0, 1, 3, 4, 5])),
        ([-20.0; 3], [20.0, 20.0, 2.5], json!([0, 1, 3, 4])),
        ([-1.4, -20.0, -20.0], [20.0, 4.9, 2.5], json!([1, 4])),
        ([-20.0; 3], [-19.0; 3], json!([])),
    ] {
        camera["clip"] = json!({ "min": min, "max": max });
        let look = json!({ "camera": camera, "shape": { "rectangle": [0, 0, 100, 100] } });
        assert_eq!(page.post("select", look.to_string()).await.1["pieces"], expected, "{min:?} {max:?}");
    }
    let (_, picked) = page.post("pick", json!({ "camera": camera, "pixel": [50, 50] }).to_string()).await;
    assert_eq!(picked, json!({ "piece": -1 }));
    camera["clip"] = json!({ "min": [0, 0, 1], "max": [1, 1, 0] });
    let (status, refused) = page.post("pick", json!({ "camera": camera, "pixel": [50, 50] }).to_string()).await;
    assert!(status == 400 && refused["error"].as_str().unwrap().contains("camera.clip"), "{refused}");
}

#[tokio::test]
async fn every_pixel_of_a_rectangle_sees_what_its_ray_sees() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    // From a place where no ray meets an edge exactly.
    let mut camera = camera();
    camera["position"] = json!([0.013, -5.0, 1.021]);
    let mut pixels = Vec::new();
    for y in 0..100 {
        pixels.extend([[0.5, f64::from(y) + 0.5], [99.5, f64::from(y) + 0.5]]);
    }
    // The second box cuts through things, and a side of the third lies in the front of `near`.
    let clips = [[[-9.0; 3], [9.0; 3]], [[-2.1, -0.2, 0.7], [0.2, 9.0, 1.3]], [[-9.0, -0.5, -9.0], [9.0; 3]]];
    for (clip, hidden) in [(None, json!([])), (None, json!([1, 3]))]
        .into_iter()
        .chain(clips.iter().flat_map(|clip| [(Some(clip), json!([])), (Some(clip), json!([1]))]))
    {
        let mut camera = camera.clone();
        if let Some([min, max]) = clip {
            camera["clip"] = json!({ "min": min, "max": max });
        }
        let look = |shape: Value| json!({ "camera": camera, "shape": shape, "faces": true, "hidden": hidden }).to_string();
        let all = page.post("select", look(json!({ "rectangle": [0, 0, 99.9, 99.9] }))).await.1;
        let rays = page.post("select", look(json!({ "pen": pixels }))).await.1;
        assert!(all["faces"] == rays["faces"] && !all["faces"].as_array().unwrap().is_empty(), "{clip:?} {hidden}: {all} {rays}");
    }
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
async fn a_class_and_a_new_instance_are_one_step() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    let thing = |more: &str| json!({ "layer": "semantic", "value": 5, more: true });
    let change = page.act(assign(&[1, 2], thing("new"))).await;
    assert_eq!((&change["semantic"], &change["instance"]), (&json!([5, 5]), &json!([1, 1])));
    assert_eq!(change["description"], "Class chair, new instance 1 on 2 parts");
    let change = page.act(assign(&[3, 4], thing("unique"))).await;
    assert_eq!((&change["semantic"], &change["instance"]), (&json!([5, 5]), &json!([2, 3])));
    let change = page.act(json!({ "type": "undo" })).await;
    assert_eq!((&change["semantic"], &change["instance"]), (&json!([-1, -1]), &json!([-1, -1])));
    let (status, error) = page.refused(assign(&[1], json!({ "layer": "semantic", "value": 5, "new": true, "unique": true }))).await;
    assert!(status == 400 && error.contains("apply is none of"), "{error}");
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
async fn what_gets_another_class_leaves_the_instance_that_it_shares() {
    let folder = tempfile::tempdir().unwrap();
    let page = Page::open(&package(folder.path()));
    let thing = |id: i64| json!({ "layer": "semantic", "value": id, "new": true });
    page.act(assign(&[5], thing(5))).await;
    page.act(json!({ "type": "split", "piece": 5, "by": "component" })).await;
    // The piece that was split off is still of the chair; with a class of its own it is not.
    assert_eq!(page.labels().await[5..], [(5, 1), (5, 1)]);
    let change = page.act(assign(&[6], class(7))).await;
    assert_eq!(change["undo_description"].as_str().unwrap(), "Class table, out of an instance of another class, on pair~2", "{change}");
    assert_eq!(page.labels().await[5..], [(5, 1), (7, -1)]);
    // What changes as a whole keeps its instance.
    page.act(assign(&[1, 2], thing(4))).await;
    page.act(assign(&[1, 2], class(6))).await;
    assert_eq!(page.labels().await[1..3], [(6, 2), (6, 2)]);
    page.act(json!({ "type": "assign_each", "pieces": [1, 2], "semantic": [6, 9] })).await;
    assert_eq!(page.labels().await[1..3], [(6, 2), (9, -1)]);
}
