//! Products after changes of their inputs: they stay, are out of date, and are made again as requested.

use crate::rooms::{ONE, config, failures, files, place, write_poses};
use enfilade_dataset::Dataset;
use enfilade_pipeline::{
    ColorKind, Config, FlowPairs, FrameChoice, LabelSource, MakeOptions, PairsRequest, Product, Request, Silent, Stage, make, make_stale,
    out_of_date, relabel, run, run_stage, run_stages, verify,
};
use enfilade_scene::Quiet;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const LABELS: &str = "name,semantic,instance\nwall,wall,\ntable,table,1\nlamp,lamp,2\n";

/// A finished dataset of scene a, and its path.
fn finished() -> (TempDir, PathBuf, Config) {
    let (folder, out) = place();
    fs::write(folder.path().join("labels.csv"), LABELS).unwrap();
    let mut config = config(folder.path(), &[("a", "room.obj", ONE, "[scene.render]\nfixtures = true\n")]);
    config.scenes[0].labels = Some(LabelSource { table: "labels.csv".into(), scene: "a".into() });
    let summary = run(&config, &out, None, &Silent).unwrap();
    assert!(summary.ok(), "{:?}", failures(&summary));
    (folder, out, config)
}

fn make_all(out: &Path, requests: &[Request]) {
    let dataset = Dataset::open(out).unwrap();
    make(&dataset, &["a".into()], requests, MakeOptions::default(), &Quiet).unwrap();
}

fn all() -> FrameChoice {
    FrameChoice::default()
}

fn sensor(text: &str) -> Request {
    let sensors: enfilade_sensors::Sensors = serde_json::from_str(text).unwrap();
    Request::Sensor { sensor: sensors.all().next().unwrap(), of: all() }
}

fn phone() -> Request {
    sensor(r#"{"camera": [{"name": "phone"}]}"#)
}

fn tof() -> Request {
    sensor(r#"{"time_of_flight": [{"name": "tof"}]}"#)
}

/// A request for every product.
fn requests(folder: &Path, out: &Path) -> Vec<Request> {
    let file = folder.join("mixes.csv");
    fs::write(&file, "mix,fixture,r,g,b\nhalf,*,0.5,0.5,0.5\n").unwrap();
    let dataset = Dataset::open(out).unwrap();
    let mut requests = vec![
        Request::Pairs(PairsRequest::default()),
        Request::Flow { pairs: FlowPairs::Step(1), cameras: None },
        Request::Tracks { points: 16, seed: 1, of: all() },
        Request::Surfaces { layers: 2, of: all() },
        Request::Words,
        phone(),
        tof(),
    ];
    requests.extend(enfilade_pipeline::read_mixes(&file, &dataset, &["a".into()], &all()).unwrap());
    requests
}

fn stale(out: &Path) -> BTreeSet<Product> {
    let dataset = Dataset::open(out).unwrap();
    out_of_date(&dataset, &["a".into()]).unwrap().into_iter().map(|found| found.product).collect()
}

/// All files except the work folder, times and the report card, which lists the files at the time of writing.
fn tree(out: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = files(out);
    found.retain(|path, _| {
        !path.starts_with(".enfilade")
            && !path.ends_with("manifest_times.csv")
            && !path.starts_with("verify.json")
            && !path.starts_with("verify.html")
    });
    found
}

fn laws_hold(out: &Path) {
    let report = verify(&Dataset::open(out).unwrap(), &["a".into()], &Quiet).unwrap();
    assert!(report.passed, "{}", report.to_text());
}

#[test]
fn readings_of_frames_that_hold_another_colour_are_out_of_date_and_made_again() {
    let (_folder, out, mut config) = finished();
    make_all(&out, &[phone(), tof()]);
    let reading = Dataset::open(&out).unwrap().layout().sensed("phone", ("a", "cam_00", 1), "color.hdf5");
    let denoised = fs::read(&reading).unwrap();
    config.scenes[0].color = ColorKind::Rendered;
    let summary = run_stages(&config, &out, &[Stage::Render], None, false, &Silent).unwrap();
    assert!(summary.warnings.iter().any(|line| line.starts_with("1 product is out of date: sensors; ")), "{:?}", summary.warnings);
    assert!(fs::read(&reading).unwrap() == denoised, "it stays as it was");
    let report = verify(&Dataset::open(&out).unwrap(), &["a".into()], &Quiet).unwrap();
    assert!(
        report.passed && report.to_text().contains("not checked, because they are out of date: sensors (2 files)"),
        "{}",
        report.to_text()
    );

    let summary = run(&config, &out, None, &Silent).unwrap();
    assert!(summary.ok() && summary.warnings.is_empty(), "{:?} {:?}", failures(&summary), summary.warnings);
    assert!(fs::read(&reading).unwrap() != denoised, "it was made again");
    laws_hold(&out);
    assert!(run(&config, &out, None, &Silent).unwrap().nothing_done());
}

#[test]
fn frames_that_are_rendered_again_keep_their_pairs() {
    let (folder, out, config) = finished();
    make_all(&out, &[Request::Pairs(PairsRequest::default())]);
    let before = tree(&out);
    let list = Dataset::open(&out).unwrap().layout().pairs();
    let summary = run_stage(&out, Stage::Render, None, true, &Silent).unwrap();
    assert!(summary.ok() && summary.warnings.is_empty(), "{:?}", summary.warnings);
    assert!(list.is_file() && stale(&out).is_empty(), "the frames have the same bytes");

    // From elsewhere they see something else.
    write_poses(folder.path(), "one.json", 0.6);
    let summary = run_stage(&out, Stage::Plan, None, false, &Silent).unwrap();
    assert!(
        summary.warnings.iter().any(|line| line.starts_with("2 products are out of date: covisibility, pairs; ")),
        "{:?}",
        summary.warnings
    );
    assert!(list.is_file());
    assert!(run(&config, &out, None, &Silent).unwrap().ok());
    assert!(stale(&out).is_empty());
    laws_hold(&out);
    let after = tree(&out);
    let other = folder.path().join("other");
    run(&config, &other, None, &Silent).unwrap();
    make_all(&other, &[Request::Pairs(PairsRequest::default())]);
    assert!(tree(&other) == after && after != before);
}

#[test]
fn labels_that_are_joined_again_cost_no_surfaces_and_no_planes() {
    let (folder, out, _) = finished();
    make_all(&out, &[Request::Surfaces { layers: 2, of: all() }, Request::Words]);
    let before = tree(&out);
    assert!(run_stage(&out, Stage::Label, None, true, &Silent).unwrap().warnings.is_empty());
    assert!(tree(&out) == before);
    assert!(stale(&out).is_empty());

    // Other labels make them out of date.
    let table = folder.path().join("other.csv");
    fs::write(&table, LABELS.replace("table,table,1", "table,desk,1")).unwrap();
    let summary = relabel(&out, &table, None, false, &Silent).unwrap();
    assert!(
        summary.warnings.iter().any(|line| line.starts_with("2 products are out of date: surfaces, words; ")),
        "{:?}",
        summary.warnings
    );
    let dataset = Dataset::open(&out).unwrap();
    assert!(dataset.has_surfaces("a", "cam_00", 0));
    let made = make_stale(&dataset, &["a".into()], &[Product::Surfaces], &Quiet).unwrap();
    assert_eq!(made.iter().map(|made| (made.product, made.made)).collect::<Vec<_>>(), [(Product::Surfaces, 2)]);
    assert_eq!(stale(&out), BTreeSet::from([Product::Words]));
    laws_hold(&out);
}

#[test]
fn products_without_a_record_are_taken_for_fresh_before_anything_changes() {
    let (folder, out, mut config) = finished();
    make_all(&out, &requests(folder.path(), &out));
    assert!(stale(&out).is_empty());
    let asked = |out: &Path| -> Vec<Vec<u8>> {
        ["flow", "sensors", "relit", "surfaces", "words"]
            .map(|name| fs::read(out.join(format!(".enfilade/a/products/{name}.json"))).unwrap())
            .into()
    };
    let before = asked(&out).len();
    fs::remove_dir_all(out.join(".enfilade/a/products")).unwrap();
    fs::remove_dir_all(out.join(".enfilade/.products")).unwrap();
    config.scenes[0].color = ColorKind::Rendered;
    run_stages(&config, &out, &[Stage::Render], None, false, &Silent).unwrap();
    assert_eq!(asked(&out).len(), before);
    assert_eq!(stale(&out), BTreeSet::from([Product::Sensors, Product::Relit]));
    make_stale(&Dataset::open(&out).unwrap(), &["a".into()], &[], &Quiet).unwrap();
    assert!(stale(&out).is_empty());
    laws_hold(&out);
}

#[test]
fn what_is_up_to_date_is_left_alone_and_what_is_damaged_is_made_again() {
    let (folder, out, _) = finished();
    let requests = requests(folder.path(), &out);
    make_all(&out, &requests);
    let (dataset, before) = (Dataset::open(&out).unwrap(), tree(&out));
    let again = make(&dataset, &["a".into()], &requests, MakeOptions::default(), &Quiet).unwrap();
    assert!(again.iter().all(|made| made.made == 0 && made.kept > 0), "{again:?}");
    let forced = make(&dataset, &["a".into()], &requests, MakeOptions { force: true }, &Quiet).unwrap();
    assert!(forced.iter().all(|made| made.kept == 0), "{forced:?}");
    assert!(tree(&out) == before);
    let cut = dataset.layout().tracks("a", "cam_00");
    fs::write(&cut, "").unwrap();
    assert_eq!(stale(&out), BTreeSet::from([Product::Tracks]));
    make_stale(&dataset, &["a".into()], &[], &Quiet).unwrap();
    assert!(tree(&out) == before);
}

#[test]
fn products_of_the_configuration_are_made_by_a_run_and_forgotten_by_none() {
    let (folder, out) = place();
    fs::write(folder.path().join("labels.csv"), LABELS).unwrap();
    fs::write(folder.path().join("sensors.toml"), "[[time_of_flight]]\nname = \"tof\"\n").unwrap();
    let asked = "products = [\"pairs\", \"flow\", { tracks = { points = 16 } }, { sensors = \"sensors.toml\" }]\n";
    config(folder.path(), &[("a", "room.obj", ONE, ""), ("b", "room.obj", ONE, "")]);
    let file = folder.path().join("dataset.toml");
    fs::write(&file, format!("{asked}{}", fs::read_to_string(&file).unwrap())).unwrap();
    let config = Config::read(&file, &Default::default()).unwrap();
    let summary = run(&config, &out, None, &Silent).unwrap();
    assert!(summary.ok(), "{:?}", failures(&summary));
    let made: BTreeSet<Product> = summary.all_products().map(|outcome| outcome.product).collect();
    assert_eq!(made, BTreeSet::from([Product::Covisibility, Product::Pairs, Product::Flow, Product::Tracks, Product::Sensors]));
    let dataset = Dataset::open(&out).unwrap();
    let list = fs::read_to_string(dataset.layout().pairs()).unwrap();
    assert!(list.contains("\na,cam_00,0,cam_00,1") && list.contains("\nb,cam_00,0,cam_00,1"), "{list}");
    assert_eq!(dataset.pairs_with_layers("b", "cam_00").unwrap().len(), 2, "there and back");
    assert_eq!(dataset.read_tracks("a", "cam_00").unwrap().positions.len(), 16);
    let again = run(&config, &out, None, &Silent).unwrap();
    assert!(again.nothing_done() && again.warnings.is_empty(), "{:?}", again.warnings);

    // One scene's own key replaces the file's, and other options of the file are another request.
    let text = fs::read_to_string(&file).unwrap().replace("points = 16", "points = 8");
    fs::write(&file, text).unwrap();
    let config = Config::read(&file, &Default::default()).unwrap();
    let summary = run(&config, &out, None, &Silent).unwrap();
    let made: Vec<Product> = summary.all_products().filter(|outcome| outcome.made > 0).map(|outcome| outcome.product).collect();
    assert_eq!(made, [Product::Tracks, Product::Tracks]);
    assert_eq!(dataset.read_tracks("a", "cam_00").unwrap().positions.len(), 8);
}

/// Every state in which a run can be killed between two writes: the files of one run up to each write of the record, and of the other run
/// after it.
#[test]
fn making_that_was_killed_ends_with_the_same_bytes() {
    let (folder, out, config) = finished();
    let whole = folder.path().join("whole");
    copy(&out, &whole);
    let requests = requests(folder.path(), &out);
    make_all(&whole, &requests);
    let (begun, expected) = (files(&out), files(&whole));
    let added: Vec<&PathBuf> = expected.keys().filter(|path| begun.get(*path) != expected.get(*path)).collect();
    assert!(added.len() > 40, "{}", added.len());
    // A prefix of the writes exists, in two orders; of records only those written before a product's files.
    for step in (0..added.len()).step_by(7) {
        for reversed in [false, true] {
            let killed = folder.path().join("killed");
            copy(&out, &killed);
            // The request is in the record before the first file changes.
            make_all_unfinished(&whole, &killed);
            let order: Vec<&&PathBuf> = if reversed { added.iter().rev().collect() } else { added.iter().collect() };
            for path in order.into_iter().take(step).filter(|path| !path.starts_with(".enfilade")) {
                write(&killed.join(path), &expected[*path]);
            }
            assert!(!stale(&killed).is_empty());
            let summary = run(&config, &killed, None, &Silent).unwrap();
            assert!(summary.ok(), "{:?}", failures(&summary));
            assert!(tree(&killed) == tree(&whole), "killed after {step} writes");
            fs::remove_dir_all(&killed).unwrap();
        }
    }
}

/// Puts the records of `whole` into `killed`, all their parts unfinished.
fn make_all_unfinished(whole: &Path, killed: &Path) {
    for (path, bytes) in
        files(whole).into_iter().filter(|(path, _)| path.components().any(|part| part.as_os_str().to_string_lossy().ends_with("products")))
    {
        let mut record: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
        for part in record["parts"].as_object_mut().unwrap().values_mut() {
            part["from"] = serde_json::Value::Null;
            part["files"] = serde_json::json!([]);
        }
        write(&killed.join(path), record.to_string().as_bytes());
    }
}

fn copy(from: &Path, to: &Path) {
    files(from).iter().for_each(|(path, bytes)| write(&to.join(path), bytes));
}

fn write(path: &Path, bytes: &[u8]) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, bytes).unwrap();
}
