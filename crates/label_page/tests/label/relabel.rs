//! A dataset that was rendered, whose parts are split and labelled anew: its label images follow, and nothing is rendered.

use crate::room::{Page, assign};
use enfilade_dataset::{ANNOTATION_LOG, Dataset, mesh_names};
use enfilade_frame::{Layer, Values};
use enfilade_geometry::Bvh;
use enfilade_label_page::AnnotateOptions;
use enfilade_math::{Ray, Vec3};
use enfilade_pipeline::{CameraChoice, Config, Overrides, Silent, Stage, Summary, WORKDIR, demo, run, run_stage};
use enfilade_scene::CameraView;
use serde_json::json;
use std::collections::BTreeSet;
use std::path::Path;

/// A small demo, made in `out`.
fn small_demo(out: &Path) -> Config {
    let mut config = Config::demo(&Overrides { frames: Some(2), size: Some([96, 72]), ..Overrides::default() }).unwrap();
    let scene = &mut config.scenes[0];
    scene.cameras = vec![CameraChoice::Named("living_1".into())];
    (scene.render.samples, scene.render.max_bounces, scene.carve.rays, scene.carve.iterations) = (2, Some(2), 8192, 2);
    assert!(run(&config, out, None, &Silent).unwrap().ok());
    config
}

/// A page of the demo in `out`.
fn page_of(out: &Path) -> Page {
    Page::with(&AnnotateOptions { path: out.to_path_buf(), scene: Some(demo::SCENE.into()), ..AnnotateOptions::default() })
}

/// Compares the tables that the label stage made in `out` with those that the page writes to a separate folder, `apart`.
async fn assert_tables_are_those_of_the_page(out: &Path, apart: &Path) {
    let mesh = Dataset::open(out).unwrap().mesh_files(demo::SCENE);
    std::fs::create_dir(apart).unwrap();
    std::fs::copy(mesh.file(ANNOTATION_LOG), apart.join(ANNOTATION_LOG)).unwrap();
    let options = AnnotateOptions {
        path: out.to_path_buf(),
        scene: Some(demo::SCENE.into()),
        labels: Some(apart.to_path_buf()),
        ..AnnotateOptions::default()
    };
    Page::with(&options).post("save", "{}").await;
    for table in [
        mesh_names::OBJECTS,
        mesh_names::FACES_OBJECTS,
        mesh_names::OBJECT_PIECES,
        mesh_names::OBJECTS_SEMANTIC,
        mesh_names::OBJECTS_INSTANCE,
        mesh_names::SEMANTIC_COLORS,
        mesh_names::INSTANCE_COLORS,
    ] {
        let [stage, page] = [mesh.file(table), apart.join(table)].map(|path| std::fs::read(path).unwrap());
        assert!(stage == page, "{table}");
    }
}

/// What rays through the pixels of a frame meet: part (from 1) and piece, or none.
fn cast(dataset: &Dataset, camera: &str, frame: usize) -> Vec<Option<(i16, u32)>> {
    let mesh = dataset.mesh_files(demo::SCENE);
    let (whole, pieces) = (mesh.read().unwrap(), mesh.read_objects_of_faces().unwrap());
    let corners: Vec<[Vec3; 3]> = whole.faces.iter().map(|face| face.map(|i| whole.vertices[i as usize].as_vec3())).collect();
    let bvh = Bvh::new(&corners, &|_| false);
    let (with, trajectory) = (dataset.read_camera(demo::SCENE, camera).unwrap(), dataset.read_trajectory(demo::SCENE, camera).unwrap());
    let view = CameraView::of_frame(&with, &trajectory.poses, frame);
    let [width, height] = with.size();
    let meet = |i: u32| {
        let ray = view.centre_ray(f64::from(i % width) + 0.5, f64::from(i / width) + 0.5)?;
        let hit = bvh.closest(&Ray::new(ray.origin.as_vec3(), ray.direction.as_vec3()))?;
        Some((whole.object_of_face[hit.triangle as usize] as i16 + 1, pieces[hit.triangle as usize]))
    };
    (0..width * height).map(meet).collect()
}

#[tokio::test]
async fn split_parts_get_the_labels_of_their_pieces_without_rendering() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let config = small_demo(&out);
    let dataset = Dataset::open(&out).unwrap();
    let ids = |frame| match dataset.read_layer(demo::SCENE, "cam_00", frame, Layer::RenderEntityId).unwrap() {
        Values::I16(ids) => ids,
        other => panic!("{:?}", other.dtype()),
    };
    let rendered = std::fs::read(dataset.layout().layer(demo::SCENE, "cam_00", 0, Layer::RenderEntityId)).unwrap();
    let parts = dataset.read_nodes(demo::SCENE).unwrap().len();

    let page = page_of(&out);
    let began: Vec<i64> = page.labels().await.iter().map(|label| label.0).collect();
    let tables = dataset.read_label_tables(demo::SCENE).unwrap();
    let boxed = || dataset.read_boxes(demo::SCENE, enfilade_dataset::BoxKind::AxisAligned).unwrap().iter().flatten().count();
    let boxed_whole = boxed();
    assert_eq!(began, tables.parts.iter().map(|label| i64::from(label.semantic)).collect::<Vec<_>>());
    let seen: BTreeSet<i16> = [ids(0), ids(1)].concat().into_iter().filter(|id| *id >= 1).collect();
    // By component where there are several, else every second face.
    let faces = dataset.mesh_files(demo::SCENE).read().unwrap().object_of_face;
    for part in seen {
        let split = |by: serde_json::Value| json!({ "client": "test", "action": { "type": "split", "piece": part - 1, "by": by } });
        let (status, _) = page.post("edit", split(json!("component")).to_string()).await;
        if status == 409 {
            let own = (0..faces.len()).filter(|&face| faces[face] == part as u32 - 1).step_by(2);
            let (status, _) = page.post("edit", split(json!({ "faces": own.collect::<Vec<_>>() })).to_string()).await;
            assert!(status == 200 || status == 409);
        }
    }
    let pieces = page.labels().await.len();
    assert!(pieces > parts, "nothing was split");
    let all: Vec<usize> = (0..pieces).collect();
    // Neither wall, floor nor ceiling: a law has those where the rooms have them.
    let class = |piece: usize| 3 + piece as i64 % 19;
    page.act(json!({ "type": "assign_each", "pieces": all, "semantic": all.iter().map(|&p| class(p)).collect::<Vec<_>>() })).await;
    page.act(json!({ "type": "assign", "pieces": all, "apply": { "layer": "instance", "unique": true } })).await;
    page.post("save", "{}").await;

    assert_eq!(dataset.read_label_tables(demo::SCENE).unwrap(), tables, "the label stage makes the tables, and nobody else");

    let summary = run_stage(&out, Stage::Label, None, false, &Silent).unwrap();
    assert!(summary.ok(), "{:?}", summary.scenes);
    assert!(summary.scenes[0].stages[0].summary.ends_with("as annotated"), "{:?}", summary.scenes[0].stages);
    assert_tables_are_those_of_the_page(&out, &folder.path().join("apart")).await;
    assert_eq!(std::fs::read(dataset.layout().layer(demo::SCENE, "cam_00", 0, Layer::RenderEntityId)).unwrap(), rendered);
    let (mut of_pieces, mut wrong, mut all) = (0, 0, 0);
    for frame in 0..2 {
        let Values::I16(classes) = dataset.read_layer(demo::SCENE, "cam_00", frame, Layer::Semantic).unwrap() else { panic!() };
        let met = cast(&dataset, "cam_00", frame as usize);
        // Where an edge lies on the ray, the renderer's exact one may meet another part.
        for ((met, id), found) in met.into_iter().zip(ids(frame)).zip(classes) {
            let Some((_, piece)) = met.filter(|(part, _)| *part == id) else { continue };
            all += 1;
            of_pieces += usize::from(piece as usize >= parts);
            wrong += usize::from(i64::from(found) != class(piece as usize));
        }
    }
    assert!(of_pieces > 2000 && wrong * 1000 <= all, "{wrong} of {all} wrong, {of_pieces} of pieces");

    // Boxes were updated with the labels; the rest follows, and every law is satisfied.
    let whole = run(&config, &out, None, &Silent).unwrap();
    assert!(whole.ok(), "{:?}", whole.scenes);
    let made: Vec<Stage> = whole.scenes[0].stages.iter().filter(|stage| !stage.up_to_date).map(|stage| stage.stage).collect();
    assert_eq!(made, [Stage::Preview, Stage::Verify]);
    assert_eq!(boxed(), pieces);

    // With the log put aside, the scene's own labels count, and objects are whole.
    let log = dataset.mesh_files(demo::SCENE).file("annotation_log.jsonl");
    std::fs::rename(&log, folder.path().join("aside")).unwrap();
    let whole = run(&config, &out, None, &Silent).unwrap();
    assert!(whole.ok(), "{:?}", whole.scenes);
    assert_eq!((boxed(), dataset.read_label_tables(demo::SCENE).unwrap()), (boxed_whole, tables.clone()));
    std::fs::rename(folder.path().join("aside"), &log).unwrap();

    // Undone, the label images are as they were.
    let steps = page.get("scene").await["revision"].as_u64().unwrap();
    for _ in 0..steps {
        page.act(json!({ "type": "undo" })).await;
    }
    page.post("save", "{}").await;
    assert!(run_stage(&out, Stage::Label, None, false, &Silent).unwrap().ok());
    let Values::I16(classes) = dataset.read_layer(demo::SCENE, "cam_00", 0, Layer::Semantic).unwrap() else { panic!() };
    let expected = |id: i16| if id < 1 { -1 } else { tables.parts[id as usize - 1].semantic };
    assert!(classes.iter().zip(ids(0)).all(|(&found, id)| found == expected(id)));
}

#[tokio::test]
async fn an_annotation_counts_from_its_first_edit_on_and_for_the_parts_that_were_annotated() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    small_demo(&out);
    let dataset = Dataset::open(&out).unwrap();
    let label = || run_stage(&out, Stage::Label, None, false, &Silent).unwrap();
    let is_annotated = |summary: &Summary| summary.scenes[0].stages[0].summary.ends_with("as annotated");

    // Looked at.
    drop(page_of(&out));
    let looked_at = label();
    assert!(looked_at.ok() && !is_annotated(&looked_at), "{:?}", looked_at.scenes);
    let page = page_of(&out);
    page.act(assign(&[0, 1], json!({ "layer": "instance", "new": true }))).await;
    page.post("save", "{}").await;
    let edited = label();
    assert!(edited.ok() && is_annotated(&edited), "{:?}", edited.scenes);

    // The same parts in another order, as an import leaves them.
    let package = out.join(WORKDIR).join(demo::SCENE).join("scene.scene");
    let mut scene = enfilade_scene::from_bytes(&std::fs::read(&package).unwrap()).unwrap();
    scene.parts.swap(0, 1);
    std::fs::write(&package, enfilade_scene::to_bytes(&scene)).unwrap();
    dataset.write_scene(demo::SCENE, &scene).unwrap();
    let swapped = label();
    let message = &swapped.scenes[0].failure.as_ref().unwrap().message;
    assert!(message.contains("annotation_log.jsonl is about another scene"), "{message}");
}
