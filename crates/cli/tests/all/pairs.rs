//! Pairs of frames on the command line.

use crate::common::{Lamp, contents, fail, folder, scene, succeed, write_config, write_room};
use std::fs;

#[test]
fn pairs_are_measured_filtered_and_hold_their_law_on_any_number_of_threads() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    let text = succeed(d, &["pairs", "out"]);
    assert!(text.contains("room: 3 frames, 3 of 3 pairs") && text.contains("pairs.csv"), "{text}");
    let of_all = contents(&d.join("out"));
    let list = fs::read_to_string(d.join("out/pairs.csv")).unwrap();
    assert!(list.starts_with("scene_name,first_camera_name,") && list.lines().count() == 4, "{list}");
    succeed(d, &["--threads", "1", "pairs", "out"]);
    assert!(of_all == contents(&d.join("out")));
    assert!(succeed(d, &["verify", "out"]).contains("laws hold over 3 frames"));

    // What is chosen goes where it is asked for, and the matrix stays whole.
    let text = succeed(d, &["pairs", "out", "--min-baseline", "100", "-o", "far.csv"]);
    assert!(text.contains("0 of 3 pairs") && fs::read_to_string(d.join("far.csv")).unwrap().lines().count() == 1, "{text}");
    assert_eq!(fs::read_to_string(d.join("out/pairs.csv")).unwrap(), list);
    fs::rename(d.join("out/.enfilade"), d.join("elsewhere")).unwrap();
    assert!(succeed(d, &["pairs", "out"]).contains("told by distances alone"));
    assert!(succeed(d, &["verify", "out"]).contains("laws hold over 3 frames"));

    fs::rename(d.join("elsewhere"), d.join("out/.enfilade")).unwrap();
    succeed(d, &["render", "out", "--force"]);
    let matrix = d.join("out/scenes/room/_detail/covisibility.hdf5");
    assert!(!matrix.exists() && !d.join("out/pairs.csv").exists(), "frames that are made again lose what related them");

    fail(d, &["pairs", "out", "--overlap", "0.7..0.2"], 2, &["0.2..0.7"]);
    fail(d, &["pairs", "out", "--camera", "cam_07"], 2, &["no camera is named \"cam_07\""]);
}
