//! Storage: the log, the files, and continuing after a restart.

use crate::room::{Page, assign, class, package, scene, stroke};
use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::{Array, Dataset, MeshFiles};
use enfilade_frame::Pass;
use enfilade_label_page::{AnnotateOptions, App};
use enfilade_math::DVec3;
use enfilade_scene::{Heard, Intrinsics, Labels, PartLabel, Pose, Quiet, Trajectory};
use serde_json::json;

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
    assert_eq!(mesh.read_pieces().unwrap(), [1]);
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
    assert!(mesh.read_pieces().unwrap().is_empty());
    drop(again);
    let mesh_folder = folder.path().join("scenes/room/_detail/mesh");
    assert_eq!(open(&mesh_folder).labels().await, [(-1, -1); 6]);
}

#[tokio::test]
async fn a_scene_that_was_only_looked_at_begins_with_the_labels_that_it_got_since() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    dataset.write_scene("room", &scene()).unwrap();
    assert_eq!(Page::open(folder.path()).labels().await, [(-1, -1); 6]);
    let labels = Labels { parts: (1..=6).map(|number| PartLabel { semantic: number, instance: number }).collect() };
    dataset.write_label_tables("room", &labels).unwrap();
    let page = Page::open(folder.path());
    page.act(assign(&[0], class(40))).await;
    page.post("save", "{}").await;
    let saved = dataset.read_label_tables("room").unwrap().parts;
    assert_eq!((saved[0].semantic, &saved[1..]), (40, &labels.parts[1..]));
    drop(page);
    // From the first edit on, the log determines the labels, not the tables.
    dataset.write_label_tables("room", &Labels { parts: vec![PartLabel::NONE; 6] }).unwrap();
    assert_eq!(Page::open(folder.path()).labels().await[5], (6, 6));
}

#[tokio::test]
async fn an_annotation_opens_whichever_of_its_tables_was_not_written_any_more() {
    const TABLES: [&str; 5] =
        ["metadata_objects.csv", "mesh_faces_oi.hdf5", "metadata_object_splits.csv", "mesh_objects_si.hdf5", "mesh_objects_sii.hdf5"];
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    dataset.write_scene("room", &scene()).unwrap();
    let mesh = dataset.mesh_files("room");
    let put = |table: &str, bytes: Option<&Vec<u8>>| match bytes {
        Some(bytes) => std::fs::write(mesh.file(table), bytes).unwrap(),
        None => drop(std::fs::remove_file(mesh.file(table))),
    };
    let split = |piece: u32, by: serde_json::Value| json!({ "type": "split", "piece": piece, "by": by });
    let undo = || json!({ "type": "undo" });
    let actions = [assign(&[0], class(3)), split(5, json!("component")), split(6, json!({ "faces": [70, 71] })), undo(), undo()];
    let mut saves: Vec<[Option<Vec<u8>>; 5]> = Vec::new();
    for action in actions {
        let page = Page::open(folder.path());
        page.act(action).await;
        page.post("save", "{}").await;
        let labels = page.labels().await;
        drop(page);
        saves.push(TABLES.map(|table| std::fs::read(mesh.file(table)).ok()));
        let [.., before, after] = saves.as_slice() else { continue };
        for (table, bytes) in TABLES.into_iter().zip(before) {
            TABLES.into_iter().zip(after).for_each(|(table, bytes)| put(table, bytes.as_ref()));
            put(table, bytes.as_ref());
            assert_eq!(Page::open(folder.path()).labels().await, labels, "{table} of before edit {}", saves.len());
        }
        // All were written again.
        assert!(TABLES.map(|table| std::fs::read(mesh.file(table)).ok()) == *after);
    }
}

#[tokio::test]
async fn planned_cameras_stand_in_the_scene_whatever_the_unit_of_the_dataset() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    dataset.write_scene("room", &scene()).unwrap();
    let pose = Pose::look_at(0, DVec3::new(1.0, -4.0, 2.0), DVec3::ZERO, DVec3::Z).unwrap();
    let trajectory = Trajectory { name: "cam_00".into(), poses: vec![pose] };
    let camera = Intrinsics::from_fov_x(64, 48, 1.0).into();
    dataset.write_camera_parameters("room", &camera).unwrap();
    dataset.write_trajectory("room", &trajectory, &camera, None).unwrap();
    let seen = |scene: serde_json::Value| [scene["cameras"][0]["frames"][0]["position"].clone(), scene["bounds"]["max"].clone()];
    let metres = seen(Page::open(folder.path()).get("scene").await);
    assert_eq!(metres[0], json!([1.0, -4.0, 2.0]));
    std::fs::write(dataset.layout().metadata_scene("room"), "parameter_name,parameter_value\nmeters_per_asset_unit,0.5\n").unwrap();
    let halves = seen(Page::open(folder.path()).get("scene").await);
    assert_eq!(halves[0], json!([0.5, -2.0, 1.0]));
    let half = |value: &serde_json::Value| value.as_array().unwrap().iter().map(|v| 0.5 * v.as_f64().unwrap()).collect::<Vec<_>>();
    assert_eq!(halves[1], json!(half(&metres[1])));
}

#[tokio::test]
async fn the_picture_of_a_planned_frame_is_there_once_it_is_rendered() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    dataset.write_scene("room", &scene()).unwrap();
    let pose = Pose::look_at(3, DVec3::new(1.0, -4.0, 2.0), DVec3::ZERO, DVec3::Z).unwrap();
    let camera = Intrinsics::from_fov_x(64, 48, 1.0).into();
    dataset.write_camera_parameters("room", &camera).unwrap();
    let trajectory = Trajectory { name: "cam_00".into(), poses: vec![pose] };
    dataset.write_trajectory("room", &trajectory, &camera, None).unwrap();
    let page = Page::open(folder.path());
    let told = async || page.get("scene").await["cameras"][0]["frames"][0]["photograph"].clone();
    assert_eq!(told().await, json!(false));
    let path = dataset.layout().preview("room", "cam_00", 3, Pass::Final, "tonemap.jpg");
    enfilade_dataset::write_bytes(&path, b"a picture").unwrap();
    assert_eq!(told().await, json!(true));
    let (head, bytes) = page.bytes("photograph/cam_00/3", &[]).await;
    assert_eq!((head["content-type"].to_str().unwrap(), bytes.as_slice()), ("image/jpeg", &b"a picture"[..]));
    for other in ["photograph/cam_00/4", "photograph/cam_01/3", "photograph/cam_00/x", "face_colors"] {
        let refused: serde_json::Value = serde_json::from_slice(&page.bytes(other, &[]).await.1).unwrap();
        assert!(refused["error"].is_string() && refused["help"].is_string(), "{other}: {refused}");
    }
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
async fn reviews_are_kept_beside_the_edits_and_exported() {
    let folder = tempfile::tempdir().unwrap();
    let path = package(folder.path());
    let page = Page::open(&path);
    let ask =
        |pieces: &[u32], state: &str, note: &str| json!({ "client": "test", "pieces": pieces, "state": state, "note": note }).to_string();
    assert_eq!(page.get("reviews").await, json!([]));
    page.post("review", ask(&[0, 1], "done", "")).await;
    let (status, reviews) = page.post("review", ask(&[1], "question", "near, or far?")).await;
    let row = |piece: u32, state: &str, note: &str| json!({ "piece": piece, "state": state, "note": note, "who": "" });
    let expected = json!([row(0, "done", ""), row(1, "question", "near, or far?")]);
    assert_eq!((status.as_u16(), &reviews), (200, &expected));
    for (body, problem) in
        [(ask(&[9], "done", ""), "piece 9"), (ask(&[0], "fine", ""), "unknown variant"), (ask(&[0], "done", &"x".repeat(2001)), "note")]
    {
        let (status, answer) = page.post("review", body).await;
        assert!(status == 400 && answer["error"].as_str().unwrap().contains(problem), "{answer}");
    }
    let table = std::fs::read_to_string(folder.path().join("room.scene.labels/metadata_object_review.csv")).unwrap();
    assert_eq!(table, "object_name,state,note,who\nwall,done,,\nnear,question,\"near, or far?\",\n");
    // No edit was made, and undoing leaves reviews alone.
    assert_eq!(page.get("scene").await["revision"].as_u64(), Some(0));
    drop(page);
    let again = Page::open(&path);
    assert_eq!(again.get("progress").await["reviews"], expected);
}

/// Tables of labels in a folder without the log of the edits that made them.
mod copied {
    use super::*;
    use std::path::{Path, PathBuf};

    /// A scene that was labelled in a folder, and a copy of what it wrote but the log.
    fn labelled(at: &Path, source: &Path, split: bool) -> (Vec<(i64, i64)>, PathBuf) {
        let options = |labels: PathBuf| AnnotateOptions { path: source.into(), labels: Some(labels), ..AnnotateOptions::default() };
        let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
        let labels = runtime.block_on(async {
            let page = Page::with(&options(at.join("first")));
            if split {
                page.act(json!({ "type": "split", "piece": 5, "by": "component" })).await;
            }
            page.act(assign(&[0], class(1))).await;
            page.act(assign(&[1, 2], json!({ "layer": "instance", "new": true }))).await;
            page.post("save", "{}").await;
            page.labels().await
        });
        std::fs::create_dir(at.join("copy")).unwrap();
        for entry in std::fs::read_dir(at.join("first")).unwrap().map(Result::unwrap) {
            if entry.file_name() != "annotation_log.jsonl" {
                std::fs::copy(entry.path(), at.join("copy").join(entry.file_name())).unwrap();
            }
        }
        (labels, at.join("copy"))
    }

    fn sources(at: &Path) -> [PathBuf; 2] {
        let dataset = Dataset::create(at.join("dataset")).unwrap();
        dataset.write_scene("room", &scene()).unwrap();
        [package(at), at.join("dataset")]
    }

    #[test]
    fn are_where_an_annotation_begins_of_files_and_mesh_folders() {
        for source in 0..2 {
            let folder = tempfile::tempdir().unwrap();
            let path = &sources(folder.path())[source];
            let (expected, copy) = labelled(folder.path(), path, false);
            let options = AnnotateOptions { path: path.clone(), labels: Some(copy.clone()), ..AnnotateOptions::default() };
            let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
            runtime.block_on(async {
                let page = Page::with(&options);
                assert_eq!(page.labels().await, expected);
                page.act(assign(&[3], class(5))).await;
                page.post("save", "{}").await;
            });
            let kept = MeshFiles::new(&copy).read_labels().unwrap().parts;
            assert_eq!((i64::from(kept[0].semantic), i64::from(kept[1].instance), kept[3].semantic), (expected[0].0, expected[1].1, 5));
            // The list alone serves as well.
            std::fs::create_dir(folder.path().join("list")).unwrap();
            std::fs::copy(copy.join("labels.csv"), folder.path().join("list/labels.csv")).unwrap();
            let options = AnnotateOptions { labels: Some(folder.path().join("list")), ..options };
            runtime.block_on(async { assert_eq!(Page::with(&options).labels().await[3].0, 5) });
            // Columns that would be lost are told.
            let list = folder.path().join("list/labels.csv");
            let rows = std::fs::read_to_string(&list).unwrap();
            let more: String =
                rows.lines().enumerate().map(|(i, row)| format!("{row},{}\n", if i == 0 { "remark" } else { "old" })).collect();
            for (text, told) in [(rows, false), (more, true)] {
                std::fs::write(&list, text).unwrap();
                std::fs::remove_file(folder.path().join("list/annotation_log.jsonl")).ok();
                let heard = Heard::default();
                App::open(&options, &heard).unwrap();
                let warnings = heard.lines().join("\n");
                assert_eq!(warnings.contains("labels.csv has other columns too (remark), which are lost"), told, "{warnings}");
            }
        }
    }

    #[test]
    fn are_not_overwritten_where_they_cannot_be_those_of_the_scene() {
        let folder = tempfile::tempdir().unwrap();
        let path = sources(folder.path())[0].clone();
        let (_, copy) = labelled(folder.path(), &path, true);
        let options = AnnotateOptions { path, labels: Some(copy.clone()), ..AnnotateOptions::default() };
        let refused = || App::open(&options, &Quiet).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(refused().contains("pieces of parts that were cut (1)"), "{}", refused());
        std::fs::remove_file(copy.join("metadata_object_splits.csv")).unwrap();
        assert!(refused().contains("its tables label 7 objects of 7, but the scene has 6 parts"), "{}", refused());
        let names: String = (0..6).map(|i| format!("part{i}\n")).collect();
        std::fs::write(copy.join("metadata_objects.csv"), format!("object_name\n{names}")).unwrap();
        let labels = Labels { parts: vec![PartLabel { semantic: 3, instance: 1 }; 6] };
        let colors = enfilade_dataset::LabelColors::nyu40(&labels);
        MeshFiles::new(&copy).write_labels(&labels, &colors).unwrap();
        assert!(refused().contains("found \"part0\", expected \"wall\""), "{}", refused());
        assert_eq!(MeshFiles::new(&copy).read_labels().unwrap(), labels);
    }
}
