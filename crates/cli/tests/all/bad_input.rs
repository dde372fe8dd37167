//! Bad input gives one clear message that names file and place and says what to do; it never panics.

use crate::common::{CAMERA, Lamp, enfilade, fail, folder, run, scene, succeed, write_config, write_room};
use std::fs;

#[test]
fn an_unknown_key_is_shown_in_its_line_with_a_proposal() {
    let dir = folder();
    fs::write(dir.path().join("dataset.toml"), "name = \"a\"\n[render]\nsampels = 4\n[[scene]]\nname = \"a\"\nhome = {}\n").unwrap();
    let text = fail(
        dir.path(),
        &["run", "dataset.toml"],
        2,
        &["dataset.toml:3:1: unknown key `sampels`", "did you mean `samples`?", "3 | sampels = 4"],
    );
    assert_eq!(text.matches("error:").count(), 1, "{text}");
}

#[test]
fn a_missing_configuration_and_a_missing_dataset_are_told() {
    let dir = folder();
    fail(dir.path(), &["run", "nothing.toml"], 2, &["cannot read nothing.toml", "run --demo"]);
    fail(dir.path(), &["run", "nothing", "--only", "carve"], 2, &["cannot read nothing", "the folder of a dataset"]);
    fail(dir.path(), &["verify", "nothing"], 2, &["nothing"]);
}

#[test]
fn a_scene_in_place_of_the_configuration_is_told() {
    let dir = folder();
    write_room(dir.path(), "room", Lamp::On);
    fail(dir.path(), &["run", "room.obj"], 2, &["room.obj is a scene", "write dataset.toml", "file = \"room.obj\""]);
    // No text at all.
    fs::write(dir.path().join("room.glb"), [b"glTF".as_slice(), &[0xff; 20]].concat()).unwrap();
    fail(dir.path(), &["run", "room.glb"], 2, &["room.glb is a scene"]);
}

#[test]
fn a_long_line_is_shown_in_part() {
    let dir = folder();
    fs::write(dir.path().join("room.yaml"), format!("{{\"nodes\": [{}]}}", "0, ".repeat(100_000))).unwrap();
    let text = fail(dir.path(), &["run", "room.yaml"], 2, &["room.yaml:1:1: "]);
    assert!(text.len() < 1000, "{} bytes", text.len());
}

#[test]
fn what_late_stages_would_refuse_is_refused_before_the_first() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    fs::write(d.join("class.csv"), "material,nyu40_id\nwall,99\n").unwrap();
    for (keys, words) in [
        ("labels = \"nope.csv\"", ["there is no label table nope.csv", "^^^"]),
        ("labels = \"class.csv\"", ["class.csv:2: class 99 is out of range", "^^^"]),
        ("render.filter_radius = -1", ["filter_radius must lie between 0 and 16", "^^"]),
        ("camera = { model = \"ray_grid\", ray_grid = \"nope.hdf5\" }", ["there is no ray grid nope.hdf5", "^^^"]),
        ("plan.mode = { kind = \"keyframes\", files = [] }", ["files = []: expected at least one file of poses", "^^^"]),
        ("carve.voxel_m = 0", ["voxel_m = 0: expected a positive length", "^"]),
    ] {
        write_config(d, &[format!("{}{keys}\n", scene("room"))]);
        let text = fail(d, &["run", "dataset.toml", "-o", "out"], 2, &words);
        assert!(text.contains("dataset.toml:15:"), "{text}");
    }
    assert!(!d.join("out").exists());
}

#[test]
fn an_unset_variable_is_named_with_its_line() {
    let dir = folder();
    fs::write(dir.path().join("dataset.toml"), "[[scene]]\nname = \"a\"\nfile = \"$ENFILADE_SCENES/a.gltf\"\n").unwrap();
    fail(dir.path(), &["run", "dataset.toml"], 2, &["dataset.toml:3:8: the environment variable ENFILADE_SCENES is not set", "export"]);
}

#[test]
fn folders_that_hold_something_else_or_cannot_be_written_are_refused() {
    let dir = folder();
    fs::create_dir(dir.path().join("photos")).unwrap();
    fs::write(dir.path().join("photos/cat.jpg"), "x").unwrap();
    fail(dir.path(), &["run", "--demo", "photos"], 2, &["photos holds something else", "cat.jpg"]);
    assert_eq!(fs::read_dir(dir.path().join("photos")).unwrap().count(), 1);
    // Permissions do not bind every user, so a folder below a file is used as one that cannot be written.
    fail(dir.path(), &["run", "--demo", "photos/cat.jpg/out"], 1, &["photos/cat.jpg/out", "choose another output folder"]);
}

#[test]
fn of_many_scenes_each_bad_one_is_reported_and_the_good_one_is_made() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "good", Lamp::On);
    write_room(d, "dark", Lamp::Off);
    write_room(d, "walled", Lamp::On);
    // A texture that is not there.
    write_room(d, "untextured", Lamp::On);
    let mtl = fs::read_to_string(d.join("untextured.mtl")).unwrap().replace("newmtl wood\n", "newmtl wood\nmap_Kd oak.png\n");
    fs::write(d.join("untextured.mtl"), mtl).unwrap();
    // A binary glTF whose header promises more than the file holds.
    let glb = [b"glTF".as_slice(), &2u32.to_le_bytes(), &500u32.to_le_bytes(), &400u32.to_le_bytes(), b"JSON{\"asset\":"].concat();
    fs::write(d.join("cut.glb"), glb).unwrap();
    // An index out of range, a vertex that is no number, a file without faces.
    write_room(d, "index", Lamp::On);
    let obj = fs::read_to_string(d.join("index.obj")).unwrap();
    fs::write(d.join("index.obj"), format!("{obj}f 1 2 999\n")).unwrap();
    fs::write(d.join("nan.obj"), "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    fs::write(d.join("empty.obj"), "v 0 0 0\n").unwrap();
    let walled = scene("walled")
        .replace("position = [0.2, -0.9, 1.4]", "position = [-0.3, 0.9, 0.35]")
        .replace("look_at = [0.0, 0.9, 0.6]", "look_at = [0.0, -0.9, 0.6]");
    let missing = format!("[[scene]]\nname = \"missing\"\nfile = \"nowhere.gltf\"\n{CAMERA}");
    let cut = format!("[[scene]]\nname = \"cut\"\nfile = \"cut.glb\"\n{CAMERA}");
    let scenes = [scene("dark"), walled, scene("untextured"), cut, scene("index"), scene("nan"), scene("empty"), missing, scene("good")];
    write_config(d, &scenes);
    let words = [
        "dark: `render` failed: the scene has no light",
        "walled: `carve` failed:",
        "untextured: `import` failed:",
        "oak.png",
        "allow_missing_textures",
        "cut: `import` failed:",
        "cut.glb",
        "index: `import` failed:",
        "999",
        "nan: `import` failed:",
        "empty: `import` failed:",
        "nowhere.gltf",
        "8 of 9 scenes failed",
    ];
    let text = fail(d, &["run", "dataset.toml", "-o", "out"], 1, &words);
    assert!(text.contains("good        ok") && !text.contains("panicked"), "{text}");
    // The good one is whole, and no frame of a bad one is there.
    succeed(d, &["verify", "out", "--scene", "good"]);
    assert!(!d.join("out/scenes/dark/images").exists());
    let manifest = fs::read_to_string(d.join("out/manifest.json")).unwrap();
    assert!(manifest.contains("the scene has no light"), "{manifest}");
    // Mended, the others are made without touching the good one.
    write_room(d, "dark", Lamp::On);
    fail(d, &["run", "dataset.toml", "-o", "out"], 1, &["7 of 9 scenes failed", "nothing to do"]);
}

#[test]
fn films_of_a_dataset_without_any_frame_are_told() {
    let dir = folder();
    let d = dir.path();
    write_config(d, &[format!("[[scene]]\nname = \"missing\"\nfile = \"nowhere.gltf\"\n{CAMERA}")]);
    fail(d, &["run", "dataset.toml", "-o", "out"], 1, &["nowhere.gltf"]);
    fail(d, &["animate", "out"], 1, &["no camera that was chosen has frames in out", "enfilade run"]);
}

#[test]
fn textures_may_be_missing_when_that_is_allowed() {
    let dir = folder();
    write_room(dir.path(), "room", Lamp::On);
    let mtl = fs::read_to_string(dir.path().join("room.mtl")).unwrap().replace("newmtl wood\n", "newmtl wood\nmap_Kd oak.png\n");
    fs::write(dir.path().join("room.mtl"), mtl).unwrap();
    fail(dir.path(), &["import", "room.obj"], 1, &["oak.png"]);
    assert!(!dir.path().join("room.scene").exists());
    succeed(dir.path(), &["import", "room.obj", "--allow-missing-textures"]);
    let report = fs::read_to_string(dir.path().join("room.report.json")).unwrap();
    assert!(report.contains("oak.png"), "{report}");
}

#[test]
fn stages_whose_inputs_are_not_there_say_what_to_run_first() {
    let dir = folder();
    write_room(dir.path(), "room", Lamp::Off);
    write_config(dir.path(), &[scene("room")]);
    fail(dir.path(), &["run", "dataset.toml", "-o", "out"], 1, &["no light"]);
    fail(dir.path(), &["label", "out"], 1, &["the results of `render`", "run first: enfilade run out --only render --scene room"]);
    fail(dir.path(), &["label", "out", "--scene", "romo"], 2, &["no scene is named \"romo\"", "did you mean \"room\"?"]);
}

#[test]
fn arguments_out_of_their_range_are_told() {
    let dir = folder();
    for (args, word) in [
        (&["run", "--demo", "out", "--frames", "0"][..], "frames must lie between 1 and 10000"),
        (&["run", "--demo", "out", "--size", "0x5"], "width and height must lie between"),
        (&["run", "--demo", "out", "--size", "12"], "640x480"),
        (&["run", "--demo", "out", "--threads", "0"], "--threads"),
        (&["run"], "<DATASET.TOML|OUT>"),
        (&["run", "out", "--force"], "--only"),
        (&["import", "."], "enfilade run . --only import"),
        (&["inspect", "out", "--pixel", "1"], "160,120"),
    ] {
        fail(dir.path(), args, 2, &[word]);
    }
    assert!(!dir.path().join("out").exists());
    let (code, out, _) = run(dir.path(), &["make", "--help"]);
    assert!(code == 0 && out.contains("Examples:"));
}

#[test]
fn negative_numbers_are_values_and_not_flags() {
    let dir = folder();
    write_room(dir.path(), "room", Lamp::On);
    for (args, word) in [
        (&["inspect", "out", "--pixel", "-1,0"][..], "expected column and row"),
        (&["run", "--demo", "out", "--frames", "-1"], "invalid value '-1' for '--frames <N>'"),
        (&["run", "--demo", "out", "--time-limit", "-5s"], "time_limit_s must be above 0, found -5"),
        (&["run", "--demo", "out", "--noise", "-2%"], "noise must lie between 0 and 1"),
        (&["animate", "out", "--fps", "-1"], "out"),
        (&["import", "room.obj", "--meters-per-unit", "-1"], "meters_per_unit"),
        (&["partition", "out", "--shares", "-1,50,51"], "out"),
        // A value that was forgotten is not taken from the next flag.
        (&["run", "--demo", "out", "--frames", "--quiet"], "a value is required for '--frames <N>'"),
        (&["run", "--demo", "out", "--time-limit", "--quiet"], "expected a time, as in 90s"),
    ] {
        let (code, out, err) = run(dir.path(), args);
        let text = format!("{out}\n{err}");
        assert!(code != 0 && text.contains(word) && !text.contains("unexpected argument"), "{args:?}: {text}");
    }
}

/// The full disk is simulated by a file that accepts no bytes.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_and_leaves_nothing_half_written() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    fs::create_dir_all(d.join("out/.enfilade/room")).unwrap();
    std::os::unix::fs::symlink("/dev/full", d.join("out/.enfilade/room/.scene.scene.partial")).unwrap();
    let text = fail(
        d,
        &["run", "dataset.toml", "-o", "out"],
        1,
        &["room: `import` failed: cannot write", "No space left on device", "free some space"],
    );
    assert!(text.contains("1 of 1 scenes failed"), "{text}");
    assert!(!d.join("out/.enfilade/room/scene.scene").exists() && !d.join("out/.enfilade/room/import.json").exists());
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
}

/// A program that reads a verb's output must not mistake missing output for an answer.
#[cfg(target_os = "linux")]
#[test]
fn output_that_cannot_be_written_is_told() {
    let dir = folder();
    write_room(dir.path(), "room", Lamp::On);
    for args in [&["--help"][..], &["import", "room.obj", "-o", "room.scene"]] {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let output = enfilade(dir.path(), args).stdout(full).output().unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{args:?}: {told}");
        assert!(told.contains("error: cannot write the output: No space left on device"), "{args:?}: {told}");
    }
}

/// A system that gives no threads is simulated by stacks that exceed all memory.
#[cfg(target_os = "linux")]
#[test]
fn threads_that_cannot_be_started_are_told() {
    let output = enfilade(folder().path(), &["verify", "out"]).env("RUST_MIN_STACK", (1u64 << 47).to_string()).output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(told.contains("error: cannot start threads") && told.contains("--threads 1") && !told.contains("panicked"), "{told}");
}

/// Such folders failed when the first record was written, after the scene had been imported.
#[cfg(target_os = "linux")]
#[test]
fn folders_that_are_not_spelled_in_utf_8_are_refused_at_once() {
    let dir = folder();
    let name: &std::ffi::OsStr = std::os::unix::ffi::OsStrExt::from_bytes(b"r\xe4ume");
    let sources = dir.path().join(name);
    fs::create_dir(&sources).unwrap();
    write_room(&sources, "room", Lamp::On);
    write_config(&sources, &[scene("room")]);
    write_room(dir.path(), "room", Lamp::On);
    write_config(dir.path(), &[scene("room")]);
    for (folder, out) in [(sources.as_path(), std::ffi::OsStr::new("out")), (dir.path(), name)] {
        let output = enfilade(folder, &["run", "dataset.toml", "-o"]).arg(out).output().unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains("is not UTF-8") && told.contains("rename the folder"), "{told}");
    }
    assert!(!sources.join("out").exists());
}
