//! Damaged or removed files are made again, and finished work is kept.

use crate::rooms::{ONE, config, failures, files, place, write_poses};
use enfilade_dataset::{ANNOTATION_LOG, BoxKind, Dataset, Price};
use enfilade_frame::Layer;
use enfilade_pipeline::{Config, Silent, Stage, replay, run, run_stage, verify, write_statistics};
use enfilade_scene::{Heard, Quiet};
use enfilade_show::stats::StatsConfig;
use std::fs;
use std::path::{Path, PathBuf};

/// Runs `config` over files of `out` after each of them was changed by `damage`: then they are restored, and no frame is rendered.
fn assert_healed(config: &Config, out: &Path, paths: &[PathBuf], damage: impl Fn(&mut Vec<u8>)) {
    let color = Dataset::open(out).unwrap().layout().layer("a", "cam_00", 0, Layer::Color);
    let rendered = fs::metadata(&color).unwrap().modified().unwrap();
    for path in paths {
        let whole = fs::read(path).unwrap();
        let mut bytes = whole.clone();
        damage(&mut bytes);
        assert_ne!(bytes, whole);
        fs::write(path, bytes).unwrap();
        let summary = run(config, out, None, &Silent).unwrap();
        assert!(summary.ok(), "{}: {:?}", path.display(), failures(&summary));
        assert!(fs::read(path).unwrap() == whole, "{} was not made again", path.display());
        assert_eq!(fs::metadata(&color).unwrap().modified().unwrap(), rendered, "{} cost a frame", path.display());
    }
    assert!(run(config, out, None, &Silent).unwrap().nothing_done());
}

/// A dataset of scene a with one camera, and the files of its stages before rendering.
fn dataset_of_one(folder: &Path, out: &Path) -> (Config, Dataset, Vec<PathBuf>) {
    let config = config(folder, &[("a", "room.obj", ONE, "")]);
    let summary = run(&config, out, None, &Silent).unwrap();
    assert!(summary.ok(), "{:?}", failures(&summary));
    let dataset = Dataset::open(out).unwrap();
    let layout = dataset.layout();
    let of_plan = [layout.keyframes("a", "cam_00", "positions"), layout.cameras_opencv("a", "cam_00"), layout.metadata_cameras("a")];
    let of_others =
        [out.join(".enfilade/a/starts.json"), layout.octomap("a"), layout.camera_parameters(), layout.view_gates("a", "cam_00")];
    let tables = ["mesh_vertices.hdf5", "mesh_objects_si.hdf5", "metadata_objects.csv"].map(|file| layout.mesh_file("a", file));
    let boxes = dataset.box_files("a", BoxKind::ALL[0]);
    let statistics = ["statistics.html", "plots/depth_log.svg", "image_statistics/metadata_normal_hist.hdf5"];
    let statistics = statistics.map(|file| layout.statistics_dir().join(file));
    let last = [layout.metadata_scene("a"), layout.statistics()];
    let files = [of_plan.to_vec(), of_others.to_vec(), tables.to_vec(), boxes[..1].to_vec(), statistics.to_vec(), last.to_vec()].concat();
    (config, dataset, files)
}

#[test]
fn files_that_were_changed_in_one_bit_are_made_again_and_cost_no_frame() {
    let (folder, out) = place();
    let (config, _, files) = dataset_of_one(folder.path(), &out);
    // Of tables the last digit, so that they can still be read.
    let change = |bytes: &mut Vec<u8>| match bytes.iter().rposition(u8::is_ascii_digit) {
        Some(digit) if bytes.is_ascii() => bytes[digit] ^= 1,
        _ => *bytes.last_mut().unwrap() ^= 1,
    };
    assert_healed(&config, &out, &files, change);
}

#[test]
fn files_that_were_overwritten_or_emptied_are_made_again_and_cost_no_frame() {
    let (folder, out) = place();
    let (config, _, mut files) = dataset_of_one(folder.path(), &out);
    files.push(out.join(".enfilade/a/scene.scene"));
    assert_healed(&config, &out, &files, |bytes| bytes.fill(b'x'));
    assert_healed(&config, &out, &files[..7], Vec::clear);
}

#[test]
fn derived_files_that_were_removed_are_made_again_alone() {
    let (folder, out) = place();
    let (config, dataset, _) = dataset_of_one(folder.path(), &out);
    let layout = dataset.layout();
    let before = files(&out);
    fs::remove_file(layout.statistics_dir().join("statistics.html")).unwrap();
    assert!(run(&config, &out, None, &Silent).unwrap().nothing_done(), "no stage is at work");
    assert!(files(&out) == before);
    fs::remove_dir_all(layout.statistics_dir()).unwrap();
    run(&config, &out, None, &Silent).unwrap();
    fs::remove_file(layout.mesh_file("a", "metadata_objects.csv")).unwrap();
    let summary = run(&config, &out, None, &Silent).unwrap();
    let made: Vec<Stage> = summary.scenes[0].stages.iter().filter(|stage| !stage.up_to_date).map(|stage| stage.stage).collect();
    assert_eq!(made, [Stage::Label, Stage::Verify]);
    let after = files(&out);
    let differ: Vec<_> = before.keys().filter(|path| before.get(*path) != after.get(*path)).collect();
    assert!(differ.iter().all(|path| path.starts_with(".enfilade/a")), "{differ:?}");
}

#[test]
fn statistics_with_costs_stay_as_they_were_asked_for() {
    let (folder, out) = place();
    let (config, dataset, _) = dataset_of_one(folder.path(), &out);
    let asked = StatsConfig { scenes: vec!["a".into()], prices: vec![Price::default()], ..StatsConfig::default() };
    write_statistics(&dataset, &asked, &Quiet).unwrap();
    let before = files(&dataset.layout().statistics_dir());
    assert!(before.contains_key(Path::new("costs.json")));
    run(&config, &out, None, &Silent).unwrap();
    assert!(files(&dataset.layout().statistics_dir()) == before);
}

#[test]
fn tables_of_objects_are_made_by_labelling_and_nothing_is_imported_again() {
    let (folder, out) = place();
    let (_, dataset, _) = dataset_of_one(folder.path(), &out);
    let mesh = dataset.mesh_files("a");
    let label = || run_stage(&out, Stage::Label, None, false, &Silent).unwrap();
    let before = files(&dataset.layout().mesh_dir("a"));
    fs::write(mesh.file("metadata_objects.csv"), "object_name\nfloor\n").unwrap();
    assert!(run_stage(&out, Stage::Import, None, false, &Silent).unwrap().nothing_done());
    assert!(!label().nothing_done() && files(&dataset.layout().mesh_dir("a")) == before);
    // A log without an edit changes nothing.
    fs::write(mesh.file(ANNOTATION_LOG), "").unwrap();
    assert!(label().nothing_done());
}

#[test]
fn damaged_cameras_cost_no_frame_that_depends_on_the_poses_beside_its_own() {
    let shutter = "[scene.camera]\nshutter = { exposure_s = 0.02, readout_s = 0.03, frame_time_s = 0.2 }\n";
    for keys in [shutter, "[scene.render]\nextra = true\n"] {
        let (folder, out) = place();
        let config = config(folder.path(), &[("a", "room.obj", ONE, keys)]);
        let summary = run(&config, &out, None, &Silent).unwrap();
        assert!(summary.ok(), "{:?}", failures(&summary));
        let dataset = Dataset::open(&out).unwrap();
        let layout = dataset.layout();
        let positions = layout.keyframes("a", "cam_00", "positions");
        let mut files = vec![positions.clone(), layout.keyframes("a", "cam_00", "orientations"), layout.camera_parameters()];
        files.extend(dataset.camera_model_files("a", "cam_00"));
        assert_healed(&config, &out, &files, |bytes| bytes.truncate(bytes.len() / 2));
        assert_healed(&config, &out, &files[..2], |bytes| *bytes.last_mut().unwrap() ^= 1);

        // Of another plan they are not.
        write_poses(folder.path(), "one.json", 0.3);
        fs::write(positions, "").unwrap();
        run_stage(&out, Stage::Plan, None, false, &Silent).unwrap();
        assert!(dataset.frame_numbers("a", "cam_00").unwrap().is_empty());
        assert!(!out.join(".enfilade/a/planned").exists());
    }
}

#[test]
fn frames_and_labels_whose_records_are_damaged_are_made_again() {
    let (folder, out) = place();
    let (config, dataset, _) = dataset_of_one(folder.path(), &out);
    let layout = dataset.layout();
    for path in [layout.frame_record("a", "cam_00", 1), layout.label_record("a", "cam_00", 1)] {
        let whole = fs::read_to_string(&path).unwrap();
        let other_length = whole.replacen("\"bytes\": ", "\"bytes\": 9", 1).replacen("  ", " ", 1);
        assert_eq!(other_length.len(), whole.len());
        for damaged in ["x".repeat(whole.len()), other_length] {
            fs::write(&path, damaged).unwrap();
            let summary = run(&config, &out, None, &Silent).unwrap();
            assert!(summary.ok(), "{}: {:?}", path.display(), failures(&summary));
            assert_eq!(fs::read_to_string(&path).unwrap(), whole);
        }
    }
    assert!(run(&config, &out, None, &Silent).unwrap().nothing_done());
}

#[test]
fn a_replay_warns_of_layers_that_were_changed_since() {
    let (folder, out) = place();
    let (_, dataset, _) = dataset_of_one(folder.path(), &out);
    let layout = dataset.layout();
    let warnings = || {
        let heard = Heard::default();
        assert!(replay(&layout.frame_record("a", "cam_00", 0), None, &heard).unwrap().is_same());
        heard.lines()
    };
    assert!(warnings().is_empty());
    fs::write(layout.layer("a", "cam_00", 0, Layer::Color), "").unwrap();
    let told = warnings();
    assert!(told.len() == 1 && told[0].contains("frame.0000.color.hdf5"), "{told:?}");
}

#[test]
fn frames_are_neither_planned_nor_rendered_by_damaged_files() {
    let (folder, out) = place();
    let (_, dataset, _) = dataset_of_one(folder.path(), &out);
    let layout = dataset.layout();
    let before = files(&layout.images_dir("a"));
    let cases = [
        (layout.octomap("a"), Stage::Plan, Stage::Carve),
        (layout.keyframes("a", "cam_00", "positions"), Stage::Render, Stage::Plan),
        (layout.camera_parameters(), Stage::Render, Stage::Plan),
    ];
    for (path, stage, makes) in cases {
        let mut bytes = fs::read(&path).unwrap();
        match bytes.iter().rposition(u8::is_ascii_digit) {
            Some(digit) if bytes.is_ascii() => bytes[digit] ^= 1,
            _ => *bytes.last_mut().unwrap() ^= 1,
        }
        fs::write(&path, bytes).unwrap();
        let summary = run_stage(&out, stage, None, true, &Silent).unwrap();
        let failure = summary.scenes[0].failure.as_ref().unwrap();
        let told = format!("{} is not as `{}` wrote it", path.display(), makes.name());
        assert!(failure.message.starts_with(&told), "{failure:?}");
        let command = format!("enfilade run {} --only {} --scene a", out.display(), makes.name());
        assert!(failure.hint.as_ref().unwrap().ends_with(&command), "{failure:?}");
        for stage in [makes, Stage::Gate] {
            assert!(run_stage(&out, stage, None, false, &Silent).unwrap().ok());
        }
        assert!(run_stage(&out, stage, None, false, &Silent).unwrap().nothing_done());
        assert!(files(&layout.images_dir("a")) == before);
    }
}

#[test]
fn a_record_that_tells_another_pose_is_made_again_by_rendering() {
    let (folder, out) = place();
    let (config, dataset, _) = dataset_of_one(folder.path(), &out);
    let path = dataset.layout().frame_record("a", "cam_00", 1);
    let whole = fs::read_to_string(&path).unwrap();
    // The rest of it, including its length, is unchanged.
    fs::write(&path, whole.replacen("-0.9", "-0.8", 1)).unwrap();
    assert!(!verify(&dataset, &["a".into()], &Quiet).unwrap().passed);
    let summary = run_stage(&out, Stage::Render, None, false, &Silent).unwrap();
    assert!(summary.scenes[0].stages[0].summary.contains("1 kept"), "{summary:?}");
    assert!(fs::read_to_string(&path).unwrap() == whole);
    assert!(run(&config, &out, None, &Silent).unwrap().ok());
}

/// Changes one bit in the middle of a file.
fn flip(path: &Path) {
    let mut bytes = fs::read(path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(path, bytes).unwrap();
}

/// Follows the advice of `verify` about records.
fn follow_advice(out: &Path, dataset: &Dataset) {
    let Ok(report) = verify(dataset, &["a".into()], &Quiet) else { return };
    for law in report.failures() {
        let Some((record, again)) = law.place.split_once("; delete ").and_then(|(_, rest)| rest.split_once(" and run the ")) else {
            continue;
        };
        let stage = if again.starts_with("label") { Stage::Label } else { Stage::Render };
        assert_eq!(again, format!("{} stage again", stage.name()));
        fs::remove_file(record).unwrap();
        assert!(run_stage(out, stage, None, false, &Silent).unwrap().ok());
    }
}

#[test]
fn files_of_every_stage_are_whole_again_after_what_verify_advises() {
    let (folder, out) = place();
    let (config, dataset, _) = dataset_of_one(folder.path(), &out);
    let layout = dataset.layout();
    let layer = |layer| layout.layer("a", "cam_00", 1, layer);
    let boxes = dataset.box_files("a", BoxKind::ALL[0]).into_iter().next().unwrap();
    let tables = [layout.mesh_file("a", "mesh_faces_vi.hdf5"), layout.octomap("a"), boxes, layout.manifest(), layout.verify_report()];
    let of_camera = [layout.keyframes("a", "cam_00", "orientations"), layout.view_gates("a", "cam_00"), layout.statistics()];
    let layers = [Layer::Color, Layer::Position, Layer::Semantic].map(layer);
    let record = layout.frame_record("a", "cam_00", 1);
    for path in tables.iter().chain(&of_camera).chain(&layers).chain([&record]) {
        let whole = fs::read(path).unwrap();
        flip(path);
        // The manifest reports a problem with a record after a run.
        for _ in 0..2 {
            follow_advice(&out, &dataset);
            run(&config, &out, None, &Silent).unwrap();
        }
        assert!(verify(&dataset, &["a".into()], &Quiet).unwrap().passed, "{}", path.display());
        assert!(fs::read(path).unwrap() == whole, "{} was not made again", path.display());
    }
}
