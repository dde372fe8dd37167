//! Each verb on its own, on a tiny dataset and on single files.

use crate::common::{Lamp, assert_same, contents, fail, folder, run, scene, succeed, write_config, write_room};
use std::fs;

#[test]
fn a_file_becomes_a_package_and_a_package_is_a_scene_file() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    let text = succeed(d, &["import", "room.obj", "-o", "metres.scene"]);
    assert!(text.contains("4 parts, 48 triangles") && text.contains("4.0 x 3.0 x 2.5 m"), "{text}");
    let text = succeed(d, &["import", "room.obj", "-o", "feet.scene", "--meters-per-unit", "0.3048", "--up-axis", "z"]);
    assert!(text.contains("1.2 x 0.8 x 0.9 m"), "{text}");
    let text = succeed(d, &["import", "metres.scene", "-o", "again.scene"]);
    assert!(text.contains("4.0 x 3.0 x 2.5 m"), "{text}");
    assert_eq!(fs::read(d.join("metres.scene")).unwrap(), fs::read(d.join("again.scene")).unwrap());
    assert!(d.join("metres.report.json").is_file());
    let words = ["meters_per_unit", "metres.scene is a scene package", "in metres with z up"];
    fail(d, &["import", "metres.scene", "-o", "feet.scene", "--meters-per-unit", "0.3048"], 1, &words);
    fail(d, &["import", "metres.scene", "-o", "feet.scene", "--up-axis", "y"], 1, &["up_axis", "metres.scene is a scene package"]);
}

#[test]
fn an_import_does_not_write_over_what_it_reads() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    succeed(d, &["import", "room.obj", "-o", "room.glb"]);
    succeed(d, &["import", "room.obj", "-o", "room.scene"]);
    for (file, args) in [("room.glb", &["-o", "room.glb"][..]), ("room.glb", &["-o", "./room.glb"]), ("room.scene", &[])] {
        let before = fs::read(d.join(file)).unwrap();
        fail(d, &[&["import", file][..], args].concat(), 2, &[file, "choose another file with -o"]);
        assert_eq!(fs::read(d.join(file)).unwrap(), before);
    }
}

#[test]
fn a_scene_is_written_as_gltf_and_read_back() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    succeed(d, &["import", "room.obj", "-o", "room.glb"]);
    let text = succeed(d, &["import", "room.glb", "-o", "again.scene"]);
    assert!(text.contains("4 parts, 48 triangles") && text.contains("4.0 x 3.0 x 2.5 m"), "{text}");
    fail(d, &["import", "room.obj", "-o", "room.usd"], 2, &["room.usd", ".scene", ".glb"]);
}

#[test]
fn stages_run_one_by_one_and_pixels_answer() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    let card = || ["verify.json", "verify.html"].map(|name| fs::read(d.join("out").join(name)).ok());
    let of_run = card();
    assert!(of_run.iter().all(Option::is_some) && String::from_utf8_lossy(of_run[0].as_ref().unwrap()).contains("\"split_whole\""));
    for stage in ["import", "carve", "plan", "gate", "render", "label", "preview"] {
        let text = succeed(d, &["run", "out", "--only", stage]);
        assert!(text.contains("nothing to do"), "{stage}: {text}");
    }
    for stage in ["import", "carve", "plan", "gate", "render", "label", "preview"] {
        let text = succeed(d, &["run", "out", "--only", stage, "--force"]);
        assert!(!text.contains("nothing to do"), "{stage}: {text}");
    }
    let text = succeed(d, &["run", "out", "--only", "plan", "--draw-plan"]);
    let pages = d.join("out/scenes/room/_detail/plan_preview");
    assert!(text.contains("nothing to do") && text.contains("plan_preview/index.html"), "{text}");
    assert!(pages.join("cam_00_plan.png").is_file() && pages.join("index.html").is_file());
    // The card of a run has gone, because stages ran since; the verb writes the same.
    assert_eq!(card(), [None, None]);
    assert!(succeed(d, &["verify", "out"]).contains("laws hold over 3 frames of 1 scene"));
    assert_eq!(card(), of_run);
    succeed(d, &["run", "out", "--only", "plan", "--force"]);
    assert!(!pages.exists(), "pictures of an earlier plan are removed");
    let text = succeed(d, &["inspect", "out", "--frame", "1", "--pixel", "24,18"]);
    assert!(text.contains("depth_meters") && text.contains("part"), "{text}");
    fail(d, &["inspect", "out", "--pixel", "48,0"], 1, &["columns 0 to 47"]);
    fail(d, &["inspect", "out", "--frame", "7", "--pixel", "0,0"], 1, &["has no frame 7"]);
    fail(d, &["inspect", "out", "--camera", "cam_01", "--pixel", "0,0"], 2, &["no camera is named \"cam_01\"", "cam_00"]);
    let text = succeed(d, &["export", "out", "--format", "depth-png", "-o", "depth", "--frames", "0..2"]);
    assert!(text.contains("2 frames") && d.join("depth/room/cam_00/frame.0001.png").is_file(), "{text}");
    fail(d, &["export", "out", "--format", "depth-png", "-o", "."], 2, &["the dataset is inside it"]);
    fail(d, &["export", "out", "--format", "depth-png", "-o", "depth", "--layers", "colour"], 2, &["the layers are: color"]);

    // A layer that was cut short is found by verification and repaired by rendering that frame again.
    let layer = d.join("out/scenes/room/images/scene_cam_00_geometry_hdf5/frame.0001.position.hdf5");
    let bytes = fs::read(&layer).unwrap();
    fs::write(&layer, &bytes[..bytes.len() / 2]).unwrap();
    fail(d, &["verify", "out"], 1, &["FAIL", "frame.0001"]);
    let text = succeed(d, &["run", "dataset.toml", "-o", "out"]);
    assert!(text.contains("all") && fs::read(&layer).unwrap() == bytes, "{text}");
}

#[test]
fn frames_that_lack_files_are_not_previewed_until_they_are_whole_again() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    let whole = contents(&d.join("out"));
    let images = d.join("out/scenes/room/images");
    fs::remove_file(images.join("scene_cam_00_geometry_hdf5/frame.0002.semantic.hdf5")).unwrap();
    let words = ["frame 2 of room/cam_00", "`label`", "enfilade run out --only label --scene room"];
    fail(d, &["run", "out", "--only", "preview", "--force"], 1, &words);
    succeed(d, &["label", "out", "--scene", "room"]);

    fs::remove_file(images.join("scene_cam_00_final_hdf5/frame.0001.color.hdf5")).unwrap();
    fail(d, &["run", "out", "--only", "preview", "--force"], 1, &["frame.0001.color.hdf5: it is missing", "render the frame again"]);
    // Elsewhere there are pictures of the others.
    let (code, _, told) = run(d, &["run", "out", "--only", "preview", "-o", "pictures"]);
    assert!(code == 0 && told.contains("room/cam_00: frame 1 is left out: "), "{told}");
    let pictures = d.join("pictures/scenes/room/images/scene_cam_00_final_preview");
    assert_eq!([1, 2].map(|frame| pictures.join(format!("frame.000{frame}.color.jpg")).is_file()), [false, true]);
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    assert_same(&whole, &contents(&d.join("out")));
    fail(d, &["run", "out", "--only", "preview", "--cameras-csv", "cameras.csv"], 2, &["--cameras-csv", "-o"]);
}

#[test]
fn a_scene_that_cannot_be_rendered_is_named_beside_the_forecasts_of_the_others() {
    let dir = folder();
    let d = dir.path();
    for (name, lamp) in [("a", Lamp::On), ("b", Lamp::Off), ("c", Lamp::On)] {
        write_room(d, name, lamp);
    }
    write_config(d, &["a", "b", "c"].map(scene));
    let words = ["b: `render` failed: the scene has no light", "1 of 3 scenes failed"];
    let text = fail(d, &["run", "dataset.toml", "-o", "out", "--estimate"], 1, &words);
    let is_forecast = |name: &str| text.lines().any(|line| line.starts_with(&format!("{name} ")) && line.contains(" MB ("));
    assert_eq!(["a", "b", "c", "all"].map(is_forecast), [true, false, true, true], "{text}");
}

#[test]
fn a_run_is_forecast_before_it_and_counted_after_it() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    let text = succeed(d, &["run", "dataset.toml", "-o", "out", "--estimate", "--price", "0.05"]);
    assert!(text.contains("processor time") && text.contains("vCPU-hours") && text.contains("0.05 per vCPU-hour (given)"), "{text}");
    assert!(!d.join("out/scenes/room/images").exists() && !d.join("out/.enfilade/room/pilot").exists());
    assert!(d.join("out/scenes/room/_detail/cam_00/camera_keyframe_positions.hdf5").is_file());
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    let text = succeed(d, &["run", "dataset.toml", "-o", "out", "--estimate"]);
    let row = text.lines().find(|line| line.starts_with("room")).unwrap_or_else(|| panic!("no row:\n{text}"));
    assert_eq!(row.split_whitespace().nth(1), Some("0"), "nothing is still to be done: {row}");
    let page = |name: &str| d.join("out/statistics").join(name);
    assert!(page("statistics.html").is_file() && page("plots/depth_log.png").is_file() && !page("costs.json").exists());
    let numbers = fs::read(page("statistics.json")).unwrap();
    let text = succeed(d, &["stats", "out", "--price", "0.05"]);
    assert!(text.contains("3 images") && text.contains("dollars at 0.05"), "{text}");
    assert!(page("costs.json").is_file() && page("metadata_rendering_jobs.csv").is_file());
    assert_eq!(fs::read(page("statistics.json")).unwrap(), numbers);
    // A licence beside the machine, as Hypersim's, goes into Hypersim's column.
    let text = succeed(d, &["stats", "out", "--price", "16.5,licence=0.15/core-minute"]);
    assert!(text.contains("dollars at 16.5 per vCPU-hour and 0.15 per core-minute for licence (given): "), "{text}");
    let jobs = fs::read_to_string(page("metadata_rendering_jobs.csv")).unwrap();
    let cells = |line: usize| jobs.lines().nth(line).unwrap().split(',').collect::<Vec<_>>();
    let dollars = |name: &str| cells(1)[cells(0).iter().position(|cell| *cell == name).unwrap()].parse::<f64>().unwrap();
    assert!(dollars("cost_vray_dollars") > 0.0 && dollars("cost_vray_dollars") < dollars("cost_cloud_dollars"), "{jobs}");
    let html = fs::read_to_string(page("statistics.html")).unwrap();
    assert!(html.contains("of these, machine") && html.contains("of these, licence"));
    let text = succeed(d, &["run", "dataset.toml", "-o", "out", "--estimate", "--price", "0.0165,licence=0.009"]);
    assert!(text.contains("per vCPU-hour and 0.009 per vCPU-hour for licence (given): "), "{text}");
    fail(d, &["stats", "out", "--price", "cheap"], 2, &["is no number", "--price 0.04"]);
    fail(d, &["stats", "out", "--compare", "dataset.toml"], 1, &["dataset.toml"]);
}

#[test]
fn warnings_that_are_not_shown_are_counted() {
    let dir = folder();
    let d = dir.path();
    fs::write(d.join("a.mtl"), "newmtl m\nKd 200 1 1\nmap_Kd .\nmap_Ks gone.png\nword 1\nillum x\n").unwrap();
    fs::write(d.join("a.obj"), "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\nf 1 2 3\nfoo 1\n").unwrap();
    let (code, out, err) = run(d, &["import", "a.obj", "--allow-missing-textures"]);
    assert_eq!(code, 0, "{err}");
    let told = out.split_once(" warnings)").and_then(|(before, _)| before.rsplit_once('('));
    let all: usize = told.unwrap_or_else(|| panic!("{out}")).1.parse().unwrap();
    assert!(all > 4 && err.matches("warning: ").count() == 3 && err.contains(&format!("… and {} more warnings", all - 3)), "{all}\n{err}");
}
