//! Frames with the light of each lamp by itself, and pictures with other lamps on; surfaces along rays of the same frames.

use crate::common::{Lamp, contents, fail, folder, scene, succeed, write_config, write_room};
use std::fs;

#[test]
fn light_of_fixtures_is_kept_apart_mixed_and_held_to_its_sum() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    fs::write(d.join("mixes.csv"), "mix,fixture,r,g,b\nlamp_off,lamp,0,0,0\nhalf,*,0.5,0.5,0.5\n").unwrap();
    succeed(d, &["run", "dataset.toml", "-o", "plain"]);
    fail(
        d,
        &["make", "plain", "relit", "--mixes", "mixes.csv"],
        2,
        &["no scene that was chosen has the light of its fixtures apart", "--fixtures"],
    );

    // Nothing else changes.
    succeed(d, &["run", "dataset.toml", "-o", "out", "--fixtures"]);
    let images = |out: &str| d.join(out).join("scenes/room/images");
    let color = |out: &str| fs::read(images(out).join("scene_cam_00_final_hdf5/frame.0001.color.hdf5")).unwrap();
    assert!(color("plain") == color("out"));
    let table = fs::read_to_string(d.join("out/scenes/room/_detail/metadata_fixtures.csv")).unwrap();
    assert!(table.starts_with("fixture_id,kind,name,") && table.contains("lamp"), "{table}");
    let fixtures = table.lines().count() - 1;
    fs::write(d.join("out/scenes/room/_detail/metadata_fixtures.csv"), table.lines().next().unwrap()).unwrap();
    succeed(d, &["run", "dataset.toml", "-o", "out", "--fixtures"]);
    assert_eq!(fs::read_to_string(d.join("out/scenes/room/_detail/metadata_fixtures.csv")).unwrap(), table, "a damaged table is mended");
    let of_frame = fs::read_dir(images("out").join("scene_cam_00_final_hdf5")).unwrap().filter_map(Result::ok);
    let files = of_frame.filter(|entry| entry.file_name().to_string_lossy().starts_with("frame.0001.fixture_")).count();
    assert_eq!(files, 2 * fixtures);
    assert!(succeed(d, &["verify", "out", "--strict"]).contains("laws hold"));

    // Mixes come out the same on any number of threads, and those of frames that are made again are gone.
    let text = succeed(d, &["make", "out", "relit", "--mixes", "mixes.csv", "--frames", "1"]);
    assert!(text.contains("1 frame by every mix"), "{text}");
    let relit = contents(&d.join("out/relit"));
    assert_eq!(relit.len(), 2 * 5, "three layers, a picture and the rules of each mix");
    succeed(d, &["--threads", "1", "make", "out", "relit", "--mixes", "mixes.csv", "--frames", "1", "--force"]);
    assert!(relit == contents(&d.join("out/relit")));
    fs::write(d.join("wrong.csv"), "mix,fixture,r,g,b\na,chandelier,0,0,0\n").unwrap();
    fail(d, &["make", "out", "relit", "--mixes", "wrong.csv"], 2, &["wrong.csv:2: no fixture is \"chandelier\"", "the fixtures are: "]);

    // A part of the light that is another frame's is found.
    let part = |frame: u32| images("out").join(format!("scene_cam_00_final_hdf5/frame.{frame:04}.fixture_01_diffuse_illumination.hdf5"));
    fs::copy(part(0), part(1)).unwrap();
    fail(d, &["verify", "out"], 1, &["light by fixture sums to color"]);
    succeed(d, &["run", "dataset.toml", "-o", "out", "--samples", "8"]);
    assert!(!d.join("out/scenes/room/_detail/metadata_fixtures.csv").exists() && !part(1).exists());
    assert_eq!(contents(&d.join("out/relit")).len(), 2 * 5, "what cannot be made again stays");
}

#[test]
fn surfaces_along_rays_hold_their_law() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    let text = succeed(d, &["make", "out", "surfaces", "--layers", "3"]);
    assert!(text.contains("room: 3 frames with up to 3 surfaces per pixel"), "{text}");
    let folder = d.join("out/scenes/room/_detail/cam_00/surfaces");
    let all = contents(&folder);
    assert_eq!(all.len(), 3 * 8);
    succeed(d, &["--threads", "1", "make", "out", "surfaces", "--layers", "3", "--force"]);
    assert!(all == contents(&folder));
    assert!(succeed(d, &["verify", "out"]).contains("laws hold over 3 frames"));

    // Files of another frame are detected, and made again.
    fs::copy(folder.join("frame.0000.surface_entity_id.hdf5"), folder.join("frame.0001.surface_entity_id.hdf5")).unwrap();
    fail(d, &["verify", "out"], 1, &["surfaces along a ray", "room/cam_00/frame.0001"]);
    succeed(d, &["make", "out", "--stale"]);
    assert!(all == contents(&folder));
}
