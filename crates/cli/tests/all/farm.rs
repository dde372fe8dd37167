//! A dataset that several workers make is the one that a single machine makes, whatever happens to the workers.

use crate::common::{Lamp, assert_same, contents, enfilade, fail, folder, run, scene, succeed, write_config, write_room};
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

/// Two scenes of three frames, with one label table and products, and what one machine makes of them in `whole`.
fn write_scenes(d: &Path) {
    write_room(d, "room", Lamp::On);
    write_room(d, "den", Lamp::On);
    fs::write(d.join("labels.csv"), "material,nyu40_id\nwall,1\nwood,7\nlight,35\n").unwrap();
    write_config(d, &["room", "den"].map(|name| scene(name) + "labels = \"labels.csv\"\nproducts = [\"pairs\", \"flow\", \"words\"]\n"));
}

/// Tasks of one frame each, since a thousandth of a second is less than any takes.
const PLAN: [&str; 8] = ["farm", "plan", "dataset.toml", "-o", "job", "--minutes", "1e-6", "--quiet"];

#[test]
fn shares_of_the_work_come_together_as_one_machine_would_have_made_them() {
    let dir = folder();
    let d = dir.path();
    write_scenes(d);
    succeed(d, &["run", "dataset.toml", "-o", "whole"]);
    succeed(d, &PLAN);
    // The same plan again is no other job; another one is refused.
    succeed(d, &PLAN);
    fail(d, &["farm", "plan", "dataset.toml", "-o", "job", "--seed", "4"], 1, &["holds another job"]);
    let words = ["divided by --minutes 0.000001 --cpus 8", "--minutes 15 --cpus 8 would divide it otherwise", "another place"];
    fail(d, &["farm", "plan", "dataset.toml", "-o", "job"], 2, &words);
    fail(d, &[&PLAN[..], &["--cpus", "2"]].concat(), 2, &["--cpus 2 would divide it otherwise"]);
    // Nothing that the scenes were made from is needed any more.
    for file in ["room.obj", "room.mtl", "den.obj", "den.mtl", "labels.csv"] {
        fs::remove_file(d.join(file)).unwrap();
    }
    let (code, text, _) = run(d, &["farm", "status", "job"]);
    assert!(code == 1 && text.contains("0 of 6 frames") && text.contains("missing: 0-5"), "{text}");
    fail(d, &["farm", "collect", "job", "-o", "early"], 2, &["6 of 6 tasks are not done", "--task 0-5"]);
    fail(d, &["farm", "work", "job", "--task", "6"], 65, &["there is no task 6"]);

    // Three workers at once, two of them with the same tasks.
    let shares: [&[&str]; 3] = [&["--shard", "0/2"], &["--shard", "1/2"], &["--task", "2-4"]];
    let workers: Vec<_> = (0..3)
        .map(|i| {
            let scratch = format!("scratch{}", i % 2);
            let mut command = enfilade(d, &["farm", "work", "job", "--scratch", &scratch, "--threads", "1"]);
            command.args(shares[i]).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
        })
        .collect();
    for mut worker in workers {
        assert_eq!(worker.wait().unwrap().code(), Some(0));
    }
    let text = succeed(d, &["farm", "status", "job"]);
    assert!(text.contains("6 of 6 frames are committed; 0 of 6 tasks are missing"), "{text}");
    assert_eq!(succeed(d, &["farm", "status", "job", "--missing"]).trim(), "");
    let text = succeed(d, &["farm", "status", "job", "--price", "0.05", "--attempts", "attempts.csv"]);
    assert!(text.contains("vCPU-hours paid") && text.contains("dollars at 0.05 per vCPU-hour (given)"), "{text}");
    assert!(text.contains("The smallest machine is unknown: the prices have no sizes"), "{text}");
    let table = fs::read_to_string(d.join("attempts.csv")).unwrap();
    assert!(table.lines().count() > 6 && table.contains("room@scene_cam_00_final,0,"), "{table}");
    fs::write(d.join("machines.csv"), "name,dollars_per_vcpu_hour,vcpus,memory_gib\ntiny,0.05,1,0.25\nbig,0.05,2,64\nsmall,0.05,1,64\n")
        .unwrap();
    let text = succeed(d, &["farm", "status", "job", "--price", "machines.csv", "--attempts", "attempts.csv"]);
    assert!(text.contains("the system's): small; all of them there"), "{text}");
    let table = fs::read_to_string(d.join("attempts.csv")).unwrap();
    let column = table.lines().next().unwrap().split(',').position(|name| name == "min_feasible_instance_type").unwrap();
    assert!(table.lines().skip(1).all(|row| row.split(',').nth(column) == Some("small")), "{table}");
    succeed(d, &["farm", "collect", "job", "-o", "out"]);
    assert_same(&contents(&d.join("whole")), &contents(&d.join("out")));
    // A second time nothing is fetched or made, and the dataset stays what it is.
    succeed(d, &["farm", "collect", "job", "-o", "out"]);
    assert_same(&contents(&d.join("whole")), &contents(&d.join("out")));
    // Stages go on from there as in any dataset.
    succeed(d, &["verify", "out"]);
    let left: Vec<_> = fs::read_dir(d.join("scratch0")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["cache"], "workers leave nothing but the cache");
}

#[test]
fn a_folder_of_something_else_or_of_another_job_is_not_collected_into() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    fs::create_dir(d.join("papers")).unwrap();
    fs::write(d.join("papers/thesis.tex"), "x").unwrap();
    for (job, seed) in [("job", "4"), ("other", "5")] {
        succeed(d, &["farm", "plan", "dataset.toml", "-o", job, "--seed", seed]);
        succeed(d, &["farm", "work", job, "--shard", "0/1", "--scratch", "scratch"]);
    }
    fail(d, &["farm", "collect", "job", "-o", "papers"], 2, &["thesis.tex"]);
    assert_eq!(fs::read_dir(d.join("papers")).unwrap().count(), 1);
    succeed(d, &["farm", "collect", "job", "-o", "out"]);
    let collected = contents(&d.join("out"));
    fail(d, &["farm", "collect", "other", "-o", "out"], 2, &["another job", "empty folder"]);
    assert_same(&collected, &contents(&d.join("out")));
}

#[test]
fn a_camera_that_was_moved_makes_another_job() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room") + "[scene.plan]\nmode = { kind = \"keyframes\", files = [\"poses.csv\"] }\n"]);
    let header = "frame,position_x,position_y,position_z,look_at_x,look_at_y,look_at_z";
    let poses = |x: f64| fs::write(d.join("poses.csv"), format!("{header}\n0,{x},-0.9,1.4,0.0,0.9,0.6\n2,{x},-0.8,1.4,0.0,0.9,0.6\n"));
    poses(0.2).unwrap();
    succeed(d, &["farm", "plan", "dataset.toml", "-o", "job"]);
    succeed(d, &["farm", "plan", "dataset.toml", "-o", "job"]);
    poses(0.3).unwrap();
    fail(d, &["farm", "plan", "dataset.toml", "-o", "job"], 1, &["holds another job"]);
}

#[test]
fn what_nodes_have_made_of_frames_is_taken_until_what_it_was_made_from_changes() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &["run", "dataset.toml", "-o", "whole"]);
    succeed(d, &["farm", "plan", "dataset.toml", "-o", "job"]);
    succeed(d, &["farm", "work", "job", "--shard", "0/1", "--scratch", "a"]);
    succeed(d, &["farm", "collect", "job", "-o", "out"]);
    let whole = contents(&d.join("whole"));
    assert_same(&whole, &contents(&d.join("out")));

    // Files of the same length in place of a node's show who made them: stages that run again leave them.
    let room = d.join("out/scenes/room");
    let picture = room.join("images/scene_cam_00_final_preview/frame.0000.color.jpg");
    let overlay = room.join("images/scene_cam_00_final_preview/frame.0000.bb_axis_aligned.jpg");
    let masks = room.join("_detail/cam_00/amodal_instances/frame.0000.json");
    let display = room.join("images/scene_cam_00_final_preview/frame.0000.display.jpg");
    let spoil = |path: &Path| fs::write(path, vec![b'x'; fs::read(path).unwrap().len()]).unwrap();
    let is_spoilt = |path: &Path| fs::read(path).unwrap().iter().all(|&byte| byte == b'x');
    let run_anew = |stages: &[&str]| {
        for stage in stages {
            fs::remove_file(d.join(format!("out/.enfilade/room/{stage}.json"))).unwrap();
            succeed(d, &["run", "out", "--only", stage]);
        }
    };
    [&picture, &overlay, &masks, &display].iter().for_each(|path| spoil(path));
    run_anew(&["boxes", "preview"]);
    assert_eq!([&picture, &overlay, &masks, &display].map(|path| is_spoilt(path)), [true, true, true, false]);
    // One that is missing is made again, and with it the others of its frame.
    fs::remove_file(&picture).unwrap();
    fs::remove_file(&masks).unwrap();
    run_anew(&["boxes", "preview"]);
    succeed(d, &["verify", "out"]);
    assert_same(&whole, &contents(&d.join("out")));
    // Other labels: nothing that was made from the old ones stays.
    fs::write(d.join("labels.csv"), "material,nyu40_id\nwall,1\nwood,7\nlight,35\n").unwrap();
    for out in ["whole", "out"] {
        succeed(d, &["label", out, "--table", "labels.csv"]);
        succeed(d, &["run", out, "--only", "preview"]);
    }
    assert_same(&contents(&d.join("whole")), &contents(&d.join("out")));
}

#[test]
#[cfg(unix)]
fn a_worker_that_is_asked_to_end_keeps_its_frame_and_another_goes_on_within_it() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    let size = ["--frames", "1", "--size", "48x36", "--samples", "1024", "--threads", "2"];
    succeed(d, &[&["farm", "plan", "dataset.toml", "-o", "job"], &size[..]].concat());
    let mut worker = enfilade(d, &["farm", "work", "job", "--task", "0", "--scratch", "a", "--threads", "2"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // It is at work when its record is there, and makes at least one pass over the frame, of very many.
    let begun = Instant::now();
    while fs::read_dir(d.join("job/attempts")).map_or(0, Iterator::count) == 0 && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(20));
    }
    let terminated = std::process::Command::new("kill").arg(worker.id().to_string()).status().unwrap();
    assert!(terminated.success());
    assert_eq!(worker.wait().unwrap().code(), Some(75));
    assert_eq!(fs::read_dir(d.join("job/kept/room/cam_00")).unwrap().count(), 1, "the frame in the making is kept");
    let text = run(d, &["farm", "status", "job"]).1;
    assert!(text.contains("attempts: 1 transient") && text.contains("interrupted within frame 0"), "{text}");
    succeed(d, &["farm", "work", "job", "--task", "0", "--scratch", "b", "--threads", "2"]);
    assert!(!d.join("job/kept/room/cam_00/0000.partial").exists());
    succeed(d, &["farm", "collect", "job", "-o", "out"]);
    succeed(d, &[&["run", "dataset.toml", "-o", "whole"], &size[..]].concat());
    assert_same(&contents(&d.join("whole")), &contents(&d.join("out")));
}

#[test]
fn damage_in_the_store_is_named_and_mended_by_doing_the_task_again() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &["farm", "plan", "dataset.toml", "-o", "job"]);
    succeed(d, &["farm", "work", "job", "--shard", "0/1", "--scratch", "a"]);
    let frames = d.join("job/frames/room/cam_00");
    let payload = fs::read_dir(&frames).unwrap().next().unwrap().unwrap().path();
    let mut bytes = fs::read(&payload).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&payload, bytes).unwrap();
    let text = fail(d, &["farm", "collect", "job", "-o", "out"], 1, &["is not what done/room/cam_00/"]);
    let marker = text.split_whitespace().find(|word| word.starts_with("done/")).unwrap();
    fs::remove_file(d.join("job").join(marker)).unwrap();
    fs::remove_file(&payload).unwrap();
    succeed(d, &["farm", "work", "job", "--shard", "0/1", "--scratch", "a"]);
    succeed(d, &["farm", "collect", "job", "-o", "out"]);
    succeed(d, &["verify", "out"]);
}

/// A frame whose files were lost counted as done, so that nothing was left to do and nothing could be collected.
#[test]
fn a_frame_without_its_files_is_missing_until_its_task_is_done_again() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &PLAN);
    let work = |tasks: &str| succeed(d, &["farm", "work", "job", "--task", tasks, "--scratch", "a"]);
    work("0-2");
    let payload = |frame: &str| {
        let files = fs::read_dir(d.join("job/frames/room/cam_00")).unwrap().map(|entry| entry.unwrap().path());
        files.into_iter().find(|path| path.file_name().unwrap().to_string_lossy().starts_with(frame)).unwrap()
    };
    fs::remove_file(payload("0001")).unwrap();
    fail(d, &["farm", "status", "job"], 1, &["2 of 3 frames are committed", "missing: 1\n"]);
    fail(d, &["farm", "collect", "job", "-o", "out"], 2, &["1 of 3 tasks are not done", "--task 1"]);
    assert!(work("0-2").contains("task 1: done, 1 frames committed"));
    assert!(succeed(d, &["farm", "status", "job"]).contains("3 of 3 frames are committed"));

    // A payload that was cut short is seen where it is read.
    fs::File::options().write(true).open(payload("0002")).unwrap().set_len(100).unwrap();
    fail(d, &["farm", "collect", "job", "-o", "out"], 1, &["job/frames/room/cam_00/0002.", "has 100 bytes, expected", "--task 2"]);
    assert!(work("2").contains("task 2: done, 1 frames committed"));
    // So is a marker that is no text, and a record that is none keeps nothing from being done.
    fs::write(d.join("job/done/room/cam_00/0000.json"), "").unwrap();
    assert!(work("0").contains("task 0: done, 1 frames committed"));
    fs::write(d.join("job/attempts/000000.node.json"), "{").unwrap();
    fail(d, &["farm", "status", "job"], 0, &["warning: ", "attempts/000000.node.json: EOF", "remove it", "3 of 3 frames"]);
    succeed(d, &["farm", "collect", "job", "-o", "out"]);
    succeed(d, &["verify", "out"]);
}

#[test]
fn engines_get_files_for_what_is_missing() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &["farm", "plan", "dataset.toml", "-o", "job", "--minutes", "1e-6", "--cpus", "2"]);
    succeed(d, &["farm", "work", "job", "--task", "1", "--scratch", "a"]);
    succeed(d, &["farm", "submit", "job", "--engine", "slurm", "--dry-run", "-o", "slurm", "--collect", "out", "--at-once", "5"]);
    let script = fs::read_to_string(d.join("slurm/enfilade-set.0.sbatch")).unwrap();
    assert!(script.contains("tasks=(0 2)\n") && script.contains("--array=0-1%5\n") && script.contains("--cpus-per-task=2\n"), "{script}");
    assert!(d.join("slurm/enfilade-set.collect.sbatch").is_file());
    succeed(d, &["farm", "submit", "job", "--engine", "kubernetes", "--image", "registry/enfilade:1", "-o", "k8s"]);
    let job: serde_json::Value = serde_json::from_slice(&fs::read(d.join("k8s/enfilade-set.job.json")).unwrap()).unwrap();
    assert_eq!(job["spec"]["completions"], 2);
    succeed(d, &["farm", "submit", "job", "--engine", "openjd", "-o", "openjd"]);
    assert!(fs::read_to_string(d.join("openjd/template.json")).unwrap().contains("\"range\": \"0,2\""));
    fail(d, &["farm", "submit", "job", "--engine", "aws-batch"], 2, &["--queue"]);
    fail(d, &["farm", "status", "nowhere"], 2, &["nowhere does not exist", "plan a job"]);
    fail(d, &["farm", "work", "ftp://x/y", "--task", "0"], 65, &["ftp://x/y"]);
}
