//! Pairs of frames, flow between them, and tracks, on the command line.

use crate::common::{Lamp, contents, fail, folder, scene, succeed, write_config, write_room};
use std::fs;

#[test]
fn pairs_are_measured_filtered_and_hold_their_law_on_any_number_of_threads() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    let text = succeed(d, &["make", "out", "pairs"]);
    // The first frame looks away from what the last one sees.
    assert!(text.contains("room: 3 frames, 2 of 3 pairs") && text.contains("pairs.csv"), "{text}");
    let of_all = contents(&d.join("out"));
    let list = fs::read_to_string(d.join("out/pairs.csv")).unwrap();
    assert!(list.starts_with("scene_name,first_camera_name,") && list.lines().count() == 3, "{list}");
    succeed(d, &["--threads", "1", "make", "out", "pairs", "--force"]);
    assert!(of_all == contents(&d.join("out")));
    assert!(succeed(d, &["verify", "out"]).contains("laws hold over 3 frames"));

    // The chosen pairs go to the requested file, and the matrix stays complete.
    let text = succeed(d, &["make", "out", "pairs", "--baseline", "100..", "--pairs", "far.csv"]);
    assert!(text.contains("0 of 3 pairs") && fs::read_to_string(d.join("far.csv")).unwrap().lines().count() == 1, "{text}");
    assert_eq!(fs::read_to_string(d.join("out/pairs.csv")).unwrap(), list);
    fs::rename(d.join("out/.enfilade"), d.join("elsewhere")).unwrap();
    assert!(succeed(d, &["make", "out", "pairs"]).contains("decided by the frames' distances only"));
    assert!(succeed(d, &["verify", "out"]).contains("laws hold over 3 frames"));

    fs::rename(d.join("elsewhere"), d.join("out/.enfilade")).unwrap();
    succeed(d, &["run", "out", "--only", "render", "--force"]);
    let matrix = d.join("out/scenes/room/_detail/covisibility.hdf5");
    assert!(matrix.exists() && d.join("out/pairs.csv").exists(), "what related frames is theirs as long as they have the same bytes");

    fail(d, &["make", "out", "pairs", "--overlap", "0.7..0.2"], 2, &["0.2..0.7"]);
    fail(d, &["make", "out", "pairs", "--camera", "cam_07"], 2, &["no camera is named \"cam_07\""]);
}

#[test]
fn flow_leads_from_frame_to_frame_and_holds_its_laws() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &["run", "dataset.toml", "-o", "out", "--extra"]);
    let detail = d.join("out/scenes/room/_detail/cam_00/pairs");
    assert!(succeed(d, &["make", "out", "flow", "--step", "1"]).contains("room: flow of 2 pairs"));
    for layer in ["optical_flow", "scene_flow", "flow_visibility"] {
        let stored = d.join(format!("out/scenes/room/images/scene_cam_00_geometry_hdf5/frame.0001.{layer}.hdf5"));
        let pair = detail.join(format!("frame.0001.cam_00.frame.0002.{layer}.hdf5"));
        assert!(fs::read(stored).unwrap() == fs::read(pair).unwrap(), "{layer} to the next frame is the layer, byte by byte");
    }
    succeed(d, &["make", "out", "pairs"]);
    assert!(succeed(d, &["make", "out", "flow"]).contains("room: flow of 2 pairs"), "there and back, without those that are there");
    assert!(succeed(d, &["make", "out", "flow", "--between", "cam_00/2", "cam_00/0"]).contains("room: flow of 1 pair"));
    assert!(detail.join("frame.0002.cam_00.frame.0000.optical_flow.hdf5").is_file());
    assert!(succeed(d, &["verify", "out"]).contains("laws hold over 3 frames"));
    fail(d, &["make", "out", "flow", "--between", "cam_00/2", "cam_00/9"], 2, &["no finished frame cam_00/9"]);
    fail(d, &["make", "out", "flow", "--step", "7"], 1, &["no pair of existing frames"]);
    fs::remove_file(d.join("out/pairs.csv")).unwrap();
    fail(d, &["make", "out", "flow"], 2, &["pairs.csv does not exist", "enfilade make out pairs", "--step"]);
    fs::rename(d.join("out/.enfilade"), d.join("elsewhere")).unwrap();
    fail(d, &["make", "out", "flow", "--step", "-1"], 1, &["scene.scene", "enfilade run"]);
}

#[test]
fn tracks_follow_points_and_hold_their_laws() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    let text = succeed(d, &["make", "out", "tracks", "--points", "100"]);
    assert!(text.contains("room/cam_00: 100 points through 3 frames"), "{text}");
    let file = d.join("out/scenes/room/_detail/cam_00/tracks.npz");
    let bytes = fs::read(&file).unwrap();
    succeed(d, &["--threads", "1", "make", "out", "tracks", "--points", "100", "--force"]);
    assert_eq!(fs::read(&file).unwrap(), bytes);
    assert!(succeed(d, &["verify", "out"]).contains("laws hold over 3 frames"));
    assert!(succeed(d, &["make", "out", "tracks", "--frames", "1.."]).contains("256 points through 2 frames"));
    fail(d, &["make", "out", "tracks", "--frames", "7.."], 1, &["no existing frame"]);
}
