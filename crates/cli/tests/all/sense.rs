//! Sensors before the frames of a dataset, on the command line.

use crate::common::{Lamp, contents, fail, folder, scene, succeed, write_config, write_room};
use std::fs;

const SENSORS: &str = "
[[camera]]
name = \"radiance\"

[[camera]]
name = \"phone\"
format = \"jpg\"
contrast = [1.2, 1.8]
full_well_electrons = [400, 4000]

[[time_of_flight]]
name = \"tof\"

[[structured_light]]
name = \"kinect\"
baseline_m = 0.075
noise_px = 0.05

[[lidar]]
name = \"beams\"
elevations_deg = [-10, 0, 10]
azimuth_deg = [-30, 30]
columns = 61
";

#[test]
fn sensors_see_what_is_stored_and_hold_their_law_on_any_number_of_threads() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    fs::write(d.join("sensors.toml"), SENSORS).unwrap();
    let text = succeed(d, &["make", "out", "sensors", "--sensors", "sensors.toml"]);
    assert!(text.contains("phone: 3 frames") && text.contains("kinect: 3 frames"), "{text}");
    let of_all = contents(&d.join("out/sensors"));
    let images = d.join("out/scenes/room/images");
    for (sensor, stored) in [("radiance", "final_hdf5/frame.0001.color"), ("tof", "geometry_hdf5/frame.0001.depth_meters")] {
        let name = stored.rsplit('/').next().unwrap();
        let sensed = fs::read(d.join(format!("out/sensors/{sensor}/room/cam_00/{name}.hdf5"))).unwrap();
        assert!(sensed == fs::read(images.join(format!("scene_cam_00_{stored}.hdf5"))).unwrap(), "{sensor}: the truth, byte by byte");
    }
    let table = fs::read_to_string(d.join("out/sensors/phone/room/cam_00/metadata_sensed_frames.csv")).unwrap();
    assert!(table.starts_with("frame_id,exposure,") && table.lines().count() == 4, "{table}");
    succeed(d, &["--threads", "1", "make", "out", "sensors", "--sensors", "sensors.toml", "--force"]);
    assert!(of_all == contents(&d.join("out/sensors")));
    assert!(succeed(d, &["verify", "out"]).contains("laws hold over 3 frames"));

    // A reading that is none of the frame is found.
    let sensed = d.join("out/sensors/kinect/room/cam_00");
    fs::copy(sensed.join("frame.0000.depth_z_meters.hdf5"), sensed.join("frame.0001.depth_z_meters.hdf5")).unwrap();
    fail(d, &["verify", "out"], 1, &["readings of sensors", "sensors/kinect/room/cam_00/frame.0001"]);

    // Other settings replace what is there.
    fs::write(d.join("sensors.toml"), SENSORS.replace("noise_px = 0.05", "noise_px = 0.1")).unwrap();
    succeed(d, &["make", "out", "sensors", "--sensors", "sensors.toml", "--frames", "2.."]);
    assert!(!sensed.join("frame.0001.depth_z_meters.hdf5").exists() && sensed.join("frame.0002.depth_z_meters.hdf5").exists());
    assert!(d.join("out/sensors/tof/room/cam_00/frame.0000.depth_meters.hdf5").exists());
    let rows = |sensor: &str| {
        let table = fs::read_to_string(d.join(format!("out/sensors/{sensor}/room/cam_00/metadata_sensed_frames.csv"))).unwrap();
        table.lines().count() - 1
    };
    assert_eq!((rows("tof"), rows("kinect")), (3, 1));
    let text = succeed(d, &["run", "out", "--only", "render", "--force"]);
    assert!(sensed.exists() && !text.contains("out of date"), "the frames have the same bytes: {text}");
}

#[test]
fn wrong_sensors_are_named_with_the_place() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    for (text, parts) in [
        ("[[camera]]\nname = \"a\"\nnoise = 1\n", ["sensors.toml:3:1", "unknown key `noise`"]),
        ("[[camera]]\nname = \"a\"\nstops = [2, 1]\n", ["sensors.toml:3:", "the smaller number first"]),
        ("[[camera]]\nname = \"a\"\nvignetting = 2\n", ["sensors.toml", "vignetting is 2, expected 0 to 1"]),
        ("seed = 3\n", ["has no sensor", "docs/sensors.md"]),
    ] {
        fs::write(d.join("sensors.toml"), text).unwrap();
        fail(d, &["make", "out", "sensors", "--sensors", "sensors.toml"], 2, &parts);
    }
    fail(d, &["make", "out", "sensors", "--sensors", "none.toml"], 2, &["none.toml", "docs/sensors.md"]);
    fs::write(d.join("sensors.toml"), "[[time_of_flight]]\nname = \"a\"\nglass = \"nothing\"\n").unwrap();
    fail(d, &["make", "out", "sensors", "--sensors", "sensors.toml"], 1, &["\"a\"", "surface_traits", "--extra"]);
    fail(d, &["make", "out", "sensors", "--sensors", "sensors.toml", "--frames", "7.."], 1, &["no existing frame"]);
}
