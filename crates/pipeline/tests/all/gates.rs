//! Gates of views: each fault is found for what it is, rejected views are left out everywhere, and planning looks for better ones.

use crate::common::{Block, LAMP, TABLE, WALL, block, write_blocks};
use enfilade_dataset::{Dataset, FrameStatus, ViewVerdict};
use enfilade_pipeline::{Config, Overrides, Silent, Stage, Summary, run, run_stage};
use std::path::Path;

/// Views, the first of them good: what is wrong with each, where it is taken from, and what it looks at.
const VIEWS: [(&str, [f64; 3], [f64; 3]); 7] = [
    ("", [0.2, -0.9, 1.4], [0.0, 0.9, 0.6]),
    ("buried", [1.65, 1.15, 1.0], [0.0, 0.0, 1.0]),
    ("outside", [6.0, 0.0, 1.3], [0.0, 0.0, 1.3]),
    ("blocked", [0.0, 1.45, 1.3], [0.0, 1.5, 1.3]),
    ("bare_wall", [-0.8, 0.0, 1.5], [-2.0, 0.0, 1.5]),
    ("blank", [50.0, 50.0, 1.0], [60.0, 60.0, 2.0]),
    ("", [0.2, -0.9, 1.4], [-0.5, 0.9, 0.6]),
];

const CUPBOARD: Block = block("cupboard", [1.4, 0.9, 0.0], [1.9, 1.4, 2.0], [0.6, 0.1, 0.1]);

/// A dataset of a room, by the keys of its plan and its gates.
fn config(folder: &Path, plan: &str, gate: &str) -> Config {
    write_blocks(folder, &[WALL, TABLE, CUPBOARD, LAMP]);
    let pose = |(i, (_, position, look_at)): (usize, &(&str, [f64; 3], [f64; 3]))| {
        format!("{{\"frame\": {i}, \"position\": {position:?}, \"look_at\": {look_at:?}}}")
    };
    let poses: Vec<String> = VIEWS.iter().enumerate().map(pose).collect();
    std::fs::write(folder.join("poses.json"), format!("[{}]", poses.join(","))).unwrap();
    let text = format!(
        "seed = 3\nframes = 6\n[render]\nsize = [64, 48]\nsamples = 2\nmax_bounces = 2\n[carve]\nrays = 8192\niterations = 2\n[plan]\n{plan}\n\
         [gate]\n{gate}\n[[scene]]\nname = \"room\"\nfile = \"room.obj\"\nup_axis = \"z\"\n\
         cameras = [{{ position = [0.2, -0.9, 1.4], look_at = [0.0, 0.9, 0.6] }}]\n"
    );
    std::fs::write(folder.join("dataset.toml"), text).unwrap();
    Config::read(&folder.join("dataset.toml"), &Overrides::default()).unwrap()
}

const GIVEN: &str = "mode = { kind = \"keyframes\", files = [\"poses.json\"] }";

fn failures(summary: &Summary) -> Vec<&str> {
    summary.scenes.iter().filter_map(|s| s.failure.as_ref()).map(|f| f.message.as_str()).collect()
}

/// The frames whose view passes according to `VIEWS`.
fn good() -> Vec<u32> {
    (0..).zip(VIEWS).filter(|(_, view)| view.0.is_empty()).map(|(frame, _)| frame).collect()
}

#[test]
fn every_bad_view_is_rejected_for_its_reason_and_left_out_everywhere() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let summary = run(&config(folder.path(), GIVEN, ""), &out, None, &Silent).unwrap();
    // Verification knows that the other frames are not missing and that no camera was at their places; it reports that most frames are
    // rejected.
    let [failure] = failures(&summary)[..] else { panic!("{:?}", failures(&summary)) };
    assert!(failure.starts_with("1 of ") && failure.contains("gates reject at most half") && failure.contains("5 of 7 views"), "{failure}");
    let dataset = Dataset::open(&out).unwrap();
    let layout = dataset.layout();
    let views = dataset.read_view_gates("room", "cam_00").unwrap().unwrap();
    for (view, (expected, ..)) in views.iter().zip(VIEWS) {
        let found = view.fault.as_ref().map_or("", |fault| fault.gate.as_str());
        assert_eq!(found, expected, "{view:?}");
        assert_eq!(view.verdict == ViewVerdict::Rejected, !expected.is_empty());
        assert_eq!(layout.rejected_view("room", "cam_00", view.frame).is_file(), !expected.is_empty());
    }
    assert_eq!(dataset.frame_numbers("room", "cam_00").unwrap(), good());
    let page = std::fs::read_to_string(layout.gates_page("room")).unwrap();
    assert!(page.contains("5 of 7 views rejected") && page.contains("cam_00/rejected/frame.0003.jpg"), "{page}");

    let manifest = dataset.read_manifest().unwrap().unwrap();
    let frames = &manifest.scenes["room"].cameras["cam_00"].frames;
    assert_eq!((frames[0].status, frames[3].status), (FrameStatus::Complete, FrameStatus::Rejected));
    assert!(frames[3].reason.as_ref().unwrap().starts_with("blocked: "), "{:?}", frames[3].reason);
    let split = dataset.read_partition().unwrap();
    let excluded: Vec<&str> = split.iter().filter_map(|row| row.side.as_ref().err()).map(String::as_str).collect();
    assert_eq!(excluded, ["BURIED", "OUTSIDE", "BLOCKED", "BARE WALL", "BLANK"]);
    // Poses and numbers stay.
    assert_eq!(dataset.read_trajectory("room", "cam_00").unwrap().poses.len(), VIEWS.len());
    let again = run(&config(folder.path(), GIVEN, ""), &out, None, &Silent).unwrap();
    assert!(again.scenes[0].stages.iter().all(|stage| stage.up_to_date) && !again.ok());

    // With other limits another view passes; existing frames stay, and a rejected one is removed.
    let wider = config(folder.path(), GIVEN, "max_plane_share = 1\nmin_depth_range_m = 0");
    let summary = run(&wider, &out, None, &Silent).unwrap();
    let rendered = summary.scenes[0].stages.iter().find(|s| s.stage == Stage::Render).unwrap();
    assert!(rendered.summary.starts_with("1 frame of") && rendered.summary.contains("2 kept"), "{}", rendered.summary);
    assert_eq!(dataset.frame_numbers("room", "cam_00").unwrap(), [0, 4, 6]);
    run(&config(folder.path(), GIVEN, ""), &out, None, &Silent).unwrap();
    assert_eq!(dataset.frame_numbers("room", "cam_00").unwrap(), good());
    assert!(!layout.layer("room", "cam_00", 4, enfilade_frame::Layer::Color).exists());
}

#[test]
fn views_that_are_only_reported_are_rendered() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    run(&config(folder.path(), GIVEN, "action = \"report\""), &out, None, &Silent).unwrap();
    let dataset = Dataset::open(&out).unwrap();
    assert_eq!(dataset.frame_numbers("room", "cam_00").unwrap().len(), VIEWS.len());
    let views = dataset.read_view_gates("room", "cam_00").unwrap().unwrap();
    assert_eq!(views.iter().filter(|view| view.verdict == ViewVerdict::Reported).count(), 5);
    assert!(dataset.read_partition().unwrap().iter().all(|row| row.side.is_ok()));
}

#[test]
fn where_no_view_is_left_the_error_says_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let summary = run(&config(folder.path(), GIVEN, "max_plane_share = 0"), &folder.path().join("out"), None, &Silent).unwrap();
    let failure = summary.scenes[0].failure.as_ref().unwrap();
    assert_eq!(failure.stage, Stage::Gate);
    assert!(failure.message.contains("all 7 views are rejected") && failure.message.contains("3 bare_wall"), "{}", failure.message);
    assert!(failure.hint.as_ref().unwrap().contains("gates.html"));
}

#[test]
fn planned_views_pass_because_planning_asks_the_same_gates() {
    let rejected = |mode: &str, limit: f64, action: &str| {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        // A strict limit, which some views of so small a room break.
        let gate = format!("max_plane_share = {limit}\naction = \"{action}\"");
        let config = config(folder.path(), &format!("test_width = 48\nqueries = 200\nmode = {mode}"), &gate);
        drop(run(&config, &out, None, &Silent).unwrap());
        let views = Dataset::open(&out).unwrap().read_view_gates("room", "cam_00").unwrap().unwrap();
        // The start camera's own view is never changed.
        (views[1..].iter().filter(|view| view.fault.is_some()).count(), views.len())
    };
    for (mode, limit) in [
        ("{ kind = \"walk\" }", 0.4),
        ("{ kind = \"stills\", min_distance_m = 0.4 }", 0.5),
        ("{ kind = \"coverage\", views = 2, poses = 150, samples = 1000 }", 0.4),
    ] {
        let (without, with) = (rejected(mode, limit, "report"), rejected(mode, limit, "reject"));
        assert!(without.0 > 0 && with.0 == 0 && with.1 > 2, "{mode}: {without:?} {with:?}");
    }
}

#[test]
fn rendering_waits_for_the_gates() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    run(&config(folder.path(), GIVEN, ""), &out, None, &Silent).unwrap();
    run_stage(&out, Stage::Plan, None, true, &Silent).unwrap();
    let failed = run_stage(&out, Stage::Render, None, false, &Silent).unwrap();
    assert!(failed.scenes[0].failure.as_ref().unwrap().hint.as_ref().unwrap().contains("--only gate"));
    run_stage(&out, Stage::Gate, None, false, &Silent).unwrap();
    assert!(run_stage(&out, Stage::Render, None, false, &Silent).unwrap().nothing_done());
}
