//! The demo from end to end, tiny: it verifies, a second run does nothing, and a changed setting runs what depends on it.

use enfilade_dataset::{BoxKind, Dataset};
use enfilade_pipeline::{CameraChoice, Config, Event, Overrides, Reporter, Stage, Summary, demo, run, run_stage};
use std::path::Path;
use std::sync::Mutex;

/// Remembers which stages began, and the messages of rendering.
#[derive(Default)]
struct Began(Mutex<Vec<Stage>>, Mutex<Vec<String>>);

impl Reporter for Began {
    fn on(&self, _scene: &str, stage: Stage, event: Event) {
        match (stage, event) {
            (_, Event::Started) => self.0.lock().unwrap().push(stage),
            (Stage::Render, Event::Progress { what, .. }) => {
                let mut told = self.1.lock().unwrap();
                if told.last().is_none_or(|last| last != what) {
                    told.push(what.to_string());
                }
            }
            _ => {}
        }
    }
}

fn tiny_demo() -> Config {
    let mut config = Config::demo(&Overrides { frames: Some(2), size: Some([64, 48]), ..Overrides::default() }).unwrap();
    let scene = &mut config.scenes[0];
    scene.cameras = vec![CameraChoice::Named("living_1".into())];
    (scene.render.samples, scene.render.max_bounces, scene.carve.rays, scene.carve.iterations) = (4, Some(4), 8192, 2);
    config
}

/// Runs and returns the stages that were not up to date.
fn run_and_watch(config: &Config, out: &Path) -> (Summary, Vec<Stage>) {
    let began = Began::default();
    let summary = run(config, out, None, &began).unwrap();
    (summary, began.0.into_inner().unwrap())
}

#[test]
fn the_demo_verifies_and_is_made_once() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut config = tiny_demo();

    let watch = Began::default();
    let first = run(&config, &out, None, &watch).unwrap();
    let (began, told) = (watch.0.into_inner().unwrap(), watch.1.into_inner().unwrap());
    assert_eq!(told[..2], ["building the ray-tracing hierarchy", "learning where light comes from"], "{told:?}");
    assert!(first.ok(), "{:?}", first.scenes);
    assert_eq!(
        began,
        [
            Stage::Import,
            Stage::Carve,
            Stage::Plan,
            Stage::Gate,
            Stage::Render,
            Stage::Denoise,
            Stage::Label,
            Stage::Boxes,
            Stage::Preview,
            Stage::Verify
        ]
    );
    let dataset = Dataset::open(&out).unwrap();
    let labels = dataset.read_label_tables(demo::SCENE).unwrap();
    assert!(labels.parts.len() >= 25 && labels.parts.iter().all(|l| l.semantic >= 1));

    let boxes = dataset.read_boxes(demo::SCENE, BoxKind::ObjectAligned3d).unwrap();
    assert!(boxes.iter().flatten().count() > 10);
    let views = dataset.read_instance_views(demo::SCENE, "cam_00").unwrap();
    assert!(views.iter().any(|view| view.visible.pixels > 0) && views.iter().all(|view| view.inside_pixels > 0));
    assert_eq!(dataset.read_partition().unwrap().len(), 2);
    assert!(dataset.rejected_views(demo::SCENE, "cam_00").unwrap().is_empty());
    let types = std::fs::read_to_string(out.join("metadata_camera_trajectories.csv")).unwrap();
    assert_eq!(types, format!("Animation,Scene type,Notes\n{}_cam_00,Living room,living_1\n", demo::SCENE));

    let (second, began) = run_and_watch(&config, &out);
    assert!(second.nothing_done() && began.is_empty(), "{began:?}");

    // More samples do not change the trajectory; more frames do not change the free space, and are another trajectory to learn from.
    config.scenes[0].render.samples = 5;
    assert_eq!(run_and_watch(&config, &out).1, [Stage::Render, Stage::Denoise, Stage::Label, Stage::Boxes, Stage::Preview, Stage::Verify]);
    config.scenes[0].plan.frames = 3;
    let (more, began) = run_and_watch(&config, &out);
    assert_eq!(began, [Stage::Plan, Stage::Gate, Stage::Render, Stage::Denoise, Stage::Label, Stage::Boxes, Stage::Preview, Stage::Verify]);
    let rendered = more.scenes[0].stages.iter().find(|s| s.stage == Stage::Render).unwrap();
    assert!(rendered.summary.starts_with("3 frames") && !rendered.summary.contains("kept"), "{}", rendered.summary);

    // A preview that was deleted is made again, and only that stage runs.
    std::fs::remove_file(dataset.layout().contact_sheet(demo::SCENE, "cam_00")).unwrap();
    assert_eq!(run_and_watch(&config, &out).1, [Stage::Preview]);
    assert!(dataset.layout().contact_sheet(demo::SCENE, "cam_00").is_file() && dataset.layout().overview().is_file());

    // Verification finds a changed value.
    let layer = dataset.layout().layer(demo::SCENE, "cam_00", 0, enfilade_frame::Layer::DepthMeters);
    let mut bytes = std::fs::read(&layer).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&layer, bytes).unwrap();
    let checked = run_stage(&out, Stage::Verify, None, true, &Began::default()).unwrap();
    let failure = checked.scenes[0].failure.as_ref().unwrap();
    assert!(failure.message.contains("do not hold") && failure.message.contains("depth_meters"), "{}", failure.message);
}
