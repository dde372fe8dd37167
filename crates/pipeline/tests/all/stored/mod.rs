//! Datasets that earlier versions made are read, verified and gone on with, as docs/layout-versions.md promises.
//!
//! `tests/data/dataset-VERSION.tar.gz` is one that VERSION made of `tests/data/room`. A release adds its own with
//! `crates/bench/src/store_dataset.rs`, whose head has the command, and none is ever made anew.

mod values;

use crate::rooms::{failures, files};
use enfilade_dataset::Dataset;
use enfilade_explore::PlanReport;
use enfilade_frame::{LAYERS, Layer, Values};
use enfilade_loader::{Choice, Options, Samples};
use enfilade_pipeline::{Config, Overrides, STAGES, Silent, Stage, Summary, partition, replay, run, run_stage, verify};
use enfilade_scene::Quiet;
use flate2::read::GzDecoder;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The program that made the dataset, from `stored.json`.
#[derive(Deserialize)]
struct Made {
    /// Versions of its stages.
    stages: BTreeMap<String, u32>,
    /// Checksums as [`values::checksums`] gave them.
    values: BTreeMap<String, String>,
}

/// A stored dataset in a folder of its own.
struct Stored {
    name: String,
    folder: TempDir,
    made: Made,
}

impl Stored {
    fn unpack(archive: &Path) -> Self {
        let folder = tempfile::tempdir().unwrap();
        tar::Archive::new(GzDecoder::new(File::open(archive).unwrap())).unpack(folder.path()).unwrap();
        // Its old path is replaced by the path here.
        let here = serde_json::to_string(folder.path().to_str().unwrap()).unwrap();
        for (path, text) in files(&folder.path().join("out/.enfilade")) {
            if let Ok(text) = String::from_utf8(text) {
                fs::write(folder.path().join("out/.enfilade").join(path), text.replace("{FOLDER}", here.trim_matches('"'))).unwrap();
            }
        }
        let made = serde_json::from_slice(&fs::read(folder.path().join("stored.json")).unwrap()).unwrap();
        Self { name: archive.file_name().unwrap().to_str().unwrap().into(), folder, made }
    }

    fn out(&self) -> PathBuf {
        self.folder.path().join("out")
    }

    fn dataset(&self) -> Dataset {
        Dataset::open(self.out()).unwrap()
    }

    fn config(&self) -> Config {
        Config::read(&self.folder.path().join("dataset.toml"), &Overrides::default()).unwrap()
    }

    /// Whether the stage makes today what it made then.
    fn is_same(&self, stage: Stage) -> bool {
        self.made.stages.get(stage.name()) == Some(&stage.version())
    }

    /// The stages before the first whose version has risen: they have nothing to do. Pictures are not stored, so they are made in any case.
    fn kept(&self) -> BTreeSet<Stage> {
        let same = STAGES.iter().map(|spec| spec.stage).take_while(|stage| self.is_same(*stage));
        same.filter(|stage| *stage != Stage::Preview).collect()
    }

    fn run(&self) -> Summary {
        let summary = run(&self.config(), &self.out(), None, &Silent).unwrap();
        assert!(summary.ok(), "{}: {:?}", self.name, failures(&summary));
        summary
    }
}

/// Stored datasets of all versions.
fn all() -> Vec<Stored> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let mut archives: Vec<PathBuf> = fs::read_dir(data).unwrap().map(|entry| entry.unwrap().path()).collect();
    archives.retain(|path| path.extension().is_some_and(|end| end == "gz"));
    archives.sort();
    assert!(!archives.is_empty());
    archives.iter().map(|archive| Stored::unpack(archive)).collect()
}

/// The newest: what is tried with it is about this version.
fn newest() -> Stored {
    all().pop().unwrap()
}

/// The stages that had something to do.
fn done(summary: &Summary) -> Vec<Stage> {
    summary.scenes[0].stages.iter().filter(|stage| !stage.up_to_date).map(|stage| stage.stage).collect()
}

/// Whether the file is a page, or a record of pages and pictures: they look as today's program draws them.
fn is_drawn(path: &Path) -> bool {
    let records = [".enfilade/room/preview.json", ".enfilade/statistics.json"];
    path.extension().is_some_and(|end| end == "html") || records.iter().any(|record| path == Path::new(record))
}

fn change(path: &Path, from: &str, to: &str) {
    let text = fs::read_to_string(path).unwrap();
    assert!(text.contains(from), "{} has no {from}", path.display());
    fs::write(path, text.replacen(from, to, 1)).unwrap();
}

#[test]
fn stored_datasets_are_read_with_the_values_that_were_stored() {
    for stored in all() {
        let dataset = stored.dataset();
        assert!(dataset.read_manifest().unwrap().is_some(), "{}", stored.name);
        assert_eq!(values::checksums(&dataset), stored.made.values, "{}", stored.name);
        let report = dataset.layout().plan_report("room", "cam_00");
        serde_json::from_slice::<PlanReport>(&fs::read(report).unwrap()).unwrap();
    }
}

#[test]
fn stored_datasets_are_loaded_with_all_layers() {
    for stored in all() {
        let layers: Vec<Layer> =
            LAYERS.iter().map(|spec| spec.layer).filter(|l| stored.dataset().has_layer("room", "cam_00", 1, *l)).collect();
        let choice = Choice { layers: Some(layers.clone()), ..Choice::default() };
        let samples = Samples::open(stored.dataset(), &choice, Options { stored: true, ..Options::default() }).unwrap();
        let sample = samples.sample(samples.len() - 1, 0).unwrap();
        assert_eq!((sample.frame, sample.layers.len()), (1, layers.len()), "{}", stored.name);
        assert!(sample.k.is_some() && sample.world_from_camera.is_some(), "{}", stored.name);
        for (layer, image) in &sample.layers {
            let then = &stored.made.values[&format!("room/cam_00/1/{}", layer.spec().name)];
            assert_eq!(blake3::hash(image.values.as_bytes()).to_hex().as_str(), then, "{}: {layer:?}", stored.name);
        }
    }
}

#[test]
fn stored_datasets_verify_and_only_what_a_raised_version_asks_for_is_made_again() {
    for stored in all() {
        let dataset = stored.dataset();
        let report = verify(&dataset, &["room".into()], &Quiet).unwrap();
        assert!(report.passed, "{}: {}", stored.name, report.to_text());
        let (before, kept) = (files(&stored.out()), stored.kept());
        let done = done(&stored.run());
        assert!(
            done.iter().all(|stage| !kept.contains(stage)),
            "{}: {done:?} were made again; a setting or record that is written otherwise?",
            stored.name
        );
        if kept.len() == STAGES.len() - 1 {
            let after = files(&stored.out());
            let changed: Vec<_> =
                before.iter().filter(|(path, bytes)| after.get(*path) != Some(bytes) && !is_drawn(path)).map(|(path, _)| path).collect();
            assert!(changed.is_empty(), "{}: {changed:?} changed", stored.name);
        }
        assert!(stored.run().nothing_done(), "{}", stored.name);
        assert!(verify(&dataset, &["room".into()], &Quiet).unwrap().passed, "{}", stored.name);
    }
}

#[test]
fn stored_settings_are_read_by_every_verb() {
    for stored in all() {
        for stage in stored.kept() {
            let summary = run_stage(&stored.out(), stage, None, false, &Silent).unwrap();
            assert!(summary.nothing_done(), "{}: {}", stored.name, stage.name());
        }
        partition(&stored.out(), |_| {}).unwrap();
    }
}

#[test]
fn a_stored_dataset_that_was_moved_is_imported_and_verified_again_and_nothing_else() {
    for stored in all() {
        let record = stored.out().join(".enfilade/room/import.json");
        let here = serde_json::to_string(stored.folder.path().to_str().unwrap()).unwrap();
        fs::write(&record, fs::read_to_string(&record).unwrap().replace(here.trim_matches('"'), "/elsewhere")).unwrap();
        let done = done(&stored.run());
        let may_be_done = |stage: &Stage| [Stage::Import, Stage::Verify].contains(stage) || !stored.kept().contains(stage);
        assert!(done.contains(&Stage::Import) && done.iter().all(may_be_done), "{}: {done:?}", stored.name);
    }
}

/// The guard of the versions: where one has not risen, the same inputs give the same outputs. Operating systems differ in last bits, which
/// the renderer's random choices may amplify in a pixel.
#[test]
fn stages_whose_version_has_not_risen_make_what_they_made_then() {
    for stored in all() {
        let again = stored.folder.path().join("again");
        assert!(run(&stored.config(), &again, None, &Silent).unwrap().ok());
        let (then, now) = (stored.dataset(), Dataset::open(&again).unwrap());
        let kept = stored.kept();
        for file in [
            then.layout().octomap("room"),
            then.layout().keyframes("room", "cam_00", "positions"),
            then.layout().mesh_file("room", "mesh_vertices.hdf5"),
        ] {
            let name = file.strip_prefix(then.root()).unwrap();
            let same = fs::read(&file).unwrap() == fs::read(again.join(name)).unwrap();
            assert!(same || !kept.contains(&Stage::Plan), "{}: {} is another", stored.name, name.display());
        }
        for spec in LAYERS.iter().filter(|spec| kept.contains(&Stage::Label) && then.has_layer("room", "cam_00", 1, spec.layer)) {
            let values = [&then, &now].map(|dataset| dataset.read_frame("room", "cam_00", 1, &[spec.layer]).unwrap());
            let share = share_that_differs(values.each_ref().map(|frame| frame.get(spec.layer).unwrap()));
            assert!(share < 0.02, "{}: {share} of {} differ: raise the version of the stage that makes it", stored.name, spec.name);
        }
    }
}

/// The share of values that differ by more than a thousandth.
fn share_that_differs([a, b]: [&Values; 2]) -> f64 {
    assert_eq!((a.len(), a.dtype()), (b.len(), b.dtype()));
    let is_near = |a: f64, b: f64| (a.is_nan() && b.is_nan()) || a == b || (a - b).abs() <= 1e-3 * a.abs().max(b.abs()).max(1e-2);
    (0..a.len()).filter(|&i| !is_near(a.get(i), b.get(i))).count() as f64 / a.len() as f64
}

#[test]
fn stored_frames_can_be_replayed() {
    for stored in all().iter().filter(|stored| stored.is_same(Stage::Render)) {
        let record = stored.dataset().layout().frame_record("room", "cam_00", 1);
        let replayed = replay(&record, None, &Quiet).unwrap();
        let same = replayed.files.iter().filter(|file| file.same).count();
        // Last bits may differ on another operating system than the one that stored it.
        assert!(
            if cfg!(target_os = "linux") { replayed.is_same() } else { same > 0 },
            "{}: {same} of {}",
            stored.name,
            replayed.files.len()
        );
    }
}

#[test]
fn a_newer_layout_is_refused_in_words_and_nothing_is_changed() {
    let stored = newest();
    let (out, config) = (stored.out(), stored.config());
    change(&stored.dataset().layout().manifest(), "enfilade dataset 1", "enfilade dataset 7");
    let before = files(&out);
    let told = [
        run(&config, &out, None, &Silent).unwrap_err().explain(),
        run_stage(&out, Stage::Render, None, true, &Silent).unwrap_err().explain(),
        partition(&out, |split| split.seed = 9).unwrap_err().explain(),
        Dataset::open(&out).unwrap_err().to_string(),
    ];
    for message in told {
        let expected = "manifest.json: found the layout \"enfilade dataset 7\", expected at most \"enfilade dataset 1\"";
        assert!(message.contains(expected) && message.ends_with("use a newer enfilade"), "{message}");
    }
    assert!(files(&out) == before);
}

#[test]
fn records_of_a_newer_form_are_refused_in_words() {
    let stored = newest();
    let (dataset, of_frame) = (stored.dataset(), stored.dataset().layout().frame_record("room", "cam_00", 1));
    change(&of_frame, "\"format\": 1", "\"format\": 2, \"pose\": null");
    let message = dataset.frame_record("room", "cam_00", 1).unwrap_err().to_string();
    assert!(message.contains("frame.0001.json: found the record's form 2, expected at most 1: it is of a newer enfilade"), "{message}");
}

#[test]
fn what_a_newer_version_of_the_same_layout_adds_is_passed_over() {
    let stored = newest();
    let layout = stored.dataset().layout().clone();
    change(&layout.manifest(), "\"enfilade_version\"", "\"added\": {\"by\": \"0.9\"},\n  \"enfilade_version\"");
    change(&layout.frame_record("room", "cam_00", 1), "\"format\": 1", "\"format\": 1, \"added\": [1]");
    change(&layout.tone_maps("room", "cam_00"), "frame_id,", "added,frame_id,");
    let text = fs::read_to_string(layout.tone_maps("room", "cam_00")).unwrap().replace("\n0,", "\nx,0,").replace("\n1,", "\nx,1,");
    fs::write(layout.tone_maps("room", "cam_00"), text).unwrap();
    assert_eq!(values::checksums(&stored.dataset()), stored.made.values);
    assert_eq!(stored.dataset().read_tone_maps("room", "cam_00").unwrap().len(), 2);
    assert!(verify(&stored.dataset(), &["room".into()], &Quiet).unwrap().passed);
}

#[test]
fn settings_of_a_newer_version_are_told_by_file_and_key_and_a_run_puts_its_own_in_their_place() {
    let stored = newest();
    let settings = stored.out().join(".enfilade/run.json");
    change(&settings, "\"samples\"", "\"caustics\": true, \"samples\"");
    let error = run_stage(&stored.out(), Stage::Label, None, false, &Silent).unwrap_err();
    let message = error.to_string();
    assert!(message.contains("run.json holds no settings that this enfilade") && message.contains("unknown field `caustics`"), "{message}");
    assert!(error.hint().unwrap().contains("run `enfilade run` for this folder once"));
    assert!(done(&stored.run()).iter().all(|stage| !stored.kept().contains(stage)));
    run_stage(&stored.out(), Stage::Label, None, false, &Silent).unwrap();
}

#[test]
fn a_scene_package_of_another_version_is_imported_again() {
    let stored = newest();
    stored.run();
    let package = stored.out().join(".enfilade/room/scene.scene");
    let whole = fs::read(&package).unwrap();
    let other = [b"enfilade scene 2\n".as_slice(), &whole[whole.iter().position(|b| *b == b'\n').unwrap() + 1..]].concat();
    fs::write(&package, &other).unwrap();
    // As if a version with that form had written it.
    let [then, now] = [&other, &whole].map(|bytes| blake3::hash(bytes).to_hex().to_string());
    change(&stored.out().join(".enfilade/room/import.json"), &now, &then);
    assert_eq!(done(&stored.run()), [Stage::Import, Stage::Verify]);
    assert!(stored.run().nothing_done());
    assert!(fs::read(&package).unwrap() == whole);
}
