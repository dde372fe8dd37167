//! Finished work after changes of scenes, cameras or the list of scenes, and after a killed run.

use crate::rooms::{ONE, config, failures, files, place, write_poses};
use enfilade_dataset::Dataset;
use enfilade_frame::{Layer, Pass};
use enfilade_pipeline::{
    ColorKind, Event, Overrides, RenderChoices, Reporter, Silent, Stage, Summary, estimate, relabel, run, run_stage, run_stages,
    stored_config,
};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Files of poses.
const TWO: &[&str] = &["one.json", "two.json"];

#[test]
fn frames_count_for_the_poses_and_the_scene_alone_that_they_were_taken_of() {
    let (folder, out) = place();
    let config = config(folder.path(), &[("a", "room.obj", ONE, "")]);
    run(&config, &out, None, &Silent).unwrap();
    let dataset = Dataset::open(&out).unwrap();
    let frames = || dataset.frame_numbers("a", "cam_00").unwrap();
    for stage in [Stage::Import, Stage::Plan] {
        run_stage(&out, stage, None, true, &Silent).unwrap();
    }
    assert_eq!(frames(), [0, 1], "the scene and the plan are the same");

    write_poses(folder.path(), "one.json", 0.3);
    run_stage(&out, Stage::Plan, None, false, &Silent).unwrap();
    assert_eq!(frames(), [1], "the camera of frame 0 stands elsewhere");
    assert!(!dataset.has_layer("a", "cam_00", 0, Layer::Color) && !dataset.has_layer("a", "cam_00", 0, Layer::Semantic));

    let scene = folder.path().join("room.obj");
    fs::write(&scene, fs::read_to_string(&scene).unwrap().replace("o table", "o desk")).unwrap();
    run_stage(&out, Stage::Import, None, false, &Silent).unwrap();
    assert!(frames().is_empty(), "its parts have other names");
    let summary = run(&config, &out, None, &Silent).unwrap();
    assert!(summary.ok(), "{:?}", failures(&summary));
    assert_eq!(frames(), [0, 1]);
}

#[test]
fn a_forecast_with_fewer_cameras_leaves_the_folder_as_it_is() {
    let (folder, out) = place();
    let two = config(folder.path(), &[("a", "room.obj", TWO, "")]);
    run(&two, &out, None, &Silent).unwrap();
    let before = files(&out);
    let one = config(folder.path(), &[("a", "room.obj", ONE, ""), ("b", "room.obj", ONE, "")]);
    let (summary, forecasts) = estimate(&one, &out, None, &Silent).unwrap();
    assert!(summary.ok(), "{:?}", failures(&summary));
    assert!(summary.warnings.iter().any(|warning| warning.contains("finished frames of a,")), "{:?}", summary.warnings);
    let frames: Vec<(&str, u64)> = forecasts.iter().map(|(name, forecast)| (name.as_str(), forecast.frames)).collect();
    assert_eq!(frames, [("a", 2), ("b", 2)]);
    let after = files(&out);
    let differ: Vec<_> = before.keys().chain(after.keys()).filter(|path| before.get(*path) != after.get(*path)).collect();
    assert!(differ.is_empty(), "{differ:?}");

    // The remaining work of a scene of that folder is forecast in place.
    let (_, forecasts) = estimate(&two, &out, None, &Silent).unwrap();
    assert_eq!(forecasts[0].1.frames, 0);
    // So is an added scene, which removes nothing from the others.
    let three = config(folder.path(), &[("a", "room.obj", TWO, ""), ("c", "room.obj", ONE, "")]);
    estimate(&three, &out, None, &Silent).unwrap();
    let layout = Dataset::open(&out).unwrap().layout().clone();
    assert!(layout.overview().is_file() && layout.statistics().is_file());
}

/// Saves a file again as soon as a scene is being imported.
struct Saver {
    path: PathBuf,
    has_saved: AtomicBool,
}

impl Reporter for Saver {
    fn on(&self, _scene: &str, stage: Stage, event: Event) {
        if stage != Stage::Import || !matches!(event, Event::Progress { .. }) || self.has_saved.swap(true, Ordering::Relaxed) {
            return;
        }
        // The clock of file systems advances in steps.
        std::thread::sleep(Duration::from_millis(50));
        let text = fs::read_to_string(&self.path).unwrap();
        fs::write(&self.path, text + "# saved again\n").unwrap();
    }
}

#[test]
fn a_file_that_is_saved_while_it_is_imported_is_imported_again() {
    for file in ["room.obj", "room.mtl"] {
        let (folder, out) = place();
        let config = config(folder.path(), &[("a", "room.obj", ONE, "")]);
        let saver = Saver { path: folder.path().join(file), has_saved: AtomicBool::new(false) };
        estimate(&config, &out, None, &saver).unwrap();
        assert!(saver.has_saved.load(Ordering::Relaxed));
        let is_up_to_date = || run_stage(&out, Stage::Import, None, false, &Silent).unwrap().nothing_done();
        assert_eq!([is_up_to_date(), is_up_to_date()], [false, true], "{file}");
    }
}

#[test]
fn a_camera_whose_removal_was_killed_goes_with_the_next_plan_and_troubles_no_other_scene() {
    let (folder, out) = place();
    let scenes = |of_b| [("a", "room.obj", ONE, ""), ("b", "room.obj", of_b, "")];
    run(&config(folder.path(), &scenes(TWO)), &out, None, &Silent).unwrap();
    let dataset = Dataset::open(&out).unwrap();
    let layout = dataset.layout();
    // The table is gone, and some of the camera.
    fs::remove_file(layout.metadata_cameras("b")).unwrap();
    fs::remove_dir_all(layout.camera_dir("b", "cam_01")).unwrap();
    let fewer = config(folder.path(), &scenes(ONE));
    let summary = run(&fewer, &out, Some("a"), &Silent).unwrap();
    assert!(summary.ok(), "{:?}", failures(&summary));
    run(&fewer, &out, None, &Silent).unwrap();
    assert_eq!(dataset.cameras("b").unwrap(), ["cam_00"]);
    for pass in [Pass::Final, Pass::Geometry] {
        assert!(!layout.layer_dir("b", "cam_01", pass).exists() && !layout.preview_dir("b", "cam_01", pass).exists());
    }
    assert_eq!(dataset.frame_numbers("b", "cam_00").unwrap(), [0, 1]);
}

#[test]
fn a_change_of_color_that_was_killed_is_ended_without_rendering() {
    let (folder, out) = place();
    let mut config = config(folder.path(), &[("a", "room.obj", ONE, "")]);
    config.scenes[0].color = ColorKind::Rendered;
    run(&config, &out, None, &Silent).unwrap();
    let dataset = Dataset::open(&out).unwrap();
    let layer = |layer| dataset.layout().layer("a", "cam_00", 1, layer);
    let whole = fs::read(layer(Layer::Color)).unwrap();
    let depth = || fs::metadata(layer(Layer::DepthMeters)).unwrap().modified().unwrap();
    let rendered_at = depth();
    for color in [ColorKind::Rendered, ColorKind::Denoised] {
        // As an earlier version leaves it: what was rendered has made way, and something else came half into its place.
        fs::remove_file(layer(Layer::ColorRendered)).unwrap();
        fs::rename(layer(Layer::Color), layer(Layer::ColorRendered)).unwrap();
        fs::write(layer(Layer::Color), "half").unwrap();
        config.scenes[0].color = color;
        assert!(run(&config, &out, None, &Silent).unwrap().ok());
        let is_rendered = fs::read(layer(Layer::Color)).unwrap() == whole;
        assert!(fs::read(layer(Layer::ColorRendered)).unwrap() == whole && is_rendered == (color == ColorKind::Rendered));
        assert!(run(&config, &out, None, &Silent).unwrap().nothing_done());
    }
    assert_eq!(depth(), rendered_at);
}

#[test]
fn scenes_that_are_gone_are_named_nowhere() {
    let (folder, out) = place();
    let fresh = folder.path().join("fresh");
    let all = config(folder.path(), &[("a", "room.obj", ONE, ""), ("b", "room.obj", ONE, ""), ("c", "broken.obj", ONE, "")]);
    assert!(!run(&all, &out, None, &Silent).unwrap().ok());
    let dataset = Dataset::open(&out).unwrap();
    assert!(dataset.read_manifest().unwrap().unwrap().scenes["c"].failed.is_some());
    let rest = config(folder.path(), &[("a", "room.obj", ONE, "")]);
    fs::remove_dir_all(dataset.layout().scene_dir("b")).unwrap();
    run(&rest, &out, None, &Silent).unwrap();
    run(&rest, &fresh, None, &Silent).unwrap();
    let expected = Dataset::open(&fresh).unwrap();
    let told = |dataset: &Dataset| {
        let layout = dataset.layout();
        [layout.manifest(), layout.camera_parameters(), layout.partition(), layout.overview(), layout.statistics()]
            .map(|path| fs::read(path).unwrap())
    };
    assert!(told(&dataset) == told(&expected));
}

#[test]
fn reports_of_an_earlier_plan_do_not_outlive_it() {
    let (folder, out) = place();
    let reports = || ["cam_00", "cam_01"].map(|camera| Dataset::open(&out).unwrap().layout().plan_report("a", camera).is_file());
    estimate(&config(folder.path(), &[("a", "room.obj", TWO, "")]), &out, None, &Silent).unwrap();
    assert_eq!(reports(), [true, true]);
    let rig = "[scene.camera]\nstereo = { baseline_m = 0.1 }\n";
    estimate(&config(folder.path(), &[("a", "room.obj", ONE, rig)]), &out, None, &Silent).unwrap();
    assert_eq!(Dataset::open(&out).unwrap().cameras("a").unwrap(), ["cam_00", "cam_01"]);
    assert_eq!(reports(), [true, false], "a rig's report is its left camera's");
}

#[test]
fn a_table_of_cameras_that_was_removed_is_made_again_by_planning() {
    let (folder, out) = place();
    estimate(&config(folder.path(), &[("a", "room.obj", ONE, ""), ("b", "room.obj", ONE, "")]), &out, None, &Silent).unwrap();
    let dataset = Dataset::open(&out).unwrap();
    fs::remove_file(dataset.layout().camera_parameters()).unwrap();
    assert!(run_stage(&out, Stage::Plan, None, false, &Silent).unwrap().ok());
    assert_eq!(dataset.read_camera_table().unwrap().scenes().collect::<Vec<_>>(), ["a", "b"]);
    assert!(run_stage(&out, Stage::Plan, None, false, &Silent).unwrap().nothing_done());
}

#[test]
fn frames_of_labelled_scenes_that_are_rendered_again_keep_their_labels() {
    let (folder, out) = place();
    fs::write(folder.path().join("labels.csv"), "name,semantic\nwall,wall\ntable,table\nlamp,lamp\n").unwrap();
    run(&config(folder.path(), &[("a", "room.obj", ONE, "")]), &out, None, &Silent).unwrap();
    relabel(&out, &folder.path().join("labels.csv"), None, false, &Silent).unwrap();
    let dataset = Dataset::open(&out).unwrap();
    let labels = || [Layer::Semantic, Layer::SemanticInstance].map(|layer| dataset.read_frame("a", "cam_00", 1, &[layer]).unwrap());
    let (before, boxes) = (labels(), fs::read(dataset.layout().frame_instances("a", "cam_00")).unwrap());
    for choices in [RenderChoices { extra: true, ..Default::default() }, RenderChoices { fixtures: true, ..Default::default() }] {
        let summary = render_with(&out, choices);
        assert!(summary.ok(), "{:?}", failures(&summary));
        assert_eq!(labels(), before);
    }
    assert!(dataset.has_layer("a", "cam_00", 1, Layer::NormalGeometricWorld), "it was rendered again");
    let summary = run_stage(&out, Stage::Render, None, true, &Silent).unwrap();
    assert!(summary.ok() && labels() == before);
    assert_eq!(fs::read(dataset.layout().frame_instances("a", "cam_00")).unwrap(), boxes, "what frames show of the boxes too");
}

/// Renders the dataset in `out` with these choices from now on.
fn render_with(out: &Path, render: RenderChoices) -> Summary {
    let config = stored_config(out, &Overrides { render, ..Overrides::default() }, None).unwrap();
    run_stages(&config, out, &[Stage::Render], None, false, &Silent).unwrap()
}

#[test]
fn rendering_again_labels_nothing_that_was_not_labelled() {
    let (folder, out) = place();
    run(&config(folder.path(), &[("a", "room.obj", ONE, "")]), &out, None, &Silent).unwrap();
    fs::remove_file(out.join(".enfilade/a").join("label.json")).unwrap();
    let choices = RenderChoices { extra: true, ..Default::default() };
    let summary = render_with(&out, choices);
    assert!(summary.scenes[0].stages.iter().all(|outcome| outcome.stage != Stage::Label));
}
