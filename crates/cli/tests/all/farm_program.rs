//! The program that nodes run after every frame: what it leaves comes with the frame, and its failure is the frame's.

use crate::common::{Lamp, QUICK, assert_same, contents, enfilade, fail, folder, run, scene, succeed, write_room};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, Instant};

/// Tasks of one frame each, since a thousandth of a second is less than any takes.
const PLAN: [&str; 7] = ["farm", "plan", "dataset.toml", "-o", "job", "--minutes", "1e-6"];
/// The color of a frame on its node.
const COLOR: &str = "{frame_dir}/scenes/{scene}/images/scene_{camera}_final_hdf5/frame.{frame}.color.hdf5";

/// A room of three frames, and a shell's script that nodes run after each; its arguments are the color's file and words.
fn write(d: &Path, script: &str, further: &str) {
    write_room(d, "room", Lamp::On);
    let program =
        format!("[farm]\nafter_frame = [\"sh\", \"-c\", '''{script}''', \"{COLOR}\", \"{{scene}}/{{camera}}/{{frame}} {{{{}}}} $HOME\"]\n");
    fs::write(d.join("dataset.toml"), format!("name = \"set\"\n{QUICK}{}{program}{further}", scene("room"))).unwrap();
}

/// The files that programs have left in a dataset, and the rest of it.
fn apart(root: &Path) -> [BTreeMap<PathBuf, Vec<u8>>; 2] {
    let is_left = |path: &PathBuf| path.components().any(|part| part.as_os_str() == "after_frame");
    let (left, rest) = contents(root).into_iter().partition(|(path, _)| is_left(path));
    [left, rest]
}

#[test]
fn what_the_program_leaves_comes_with_the_frame_and_the_rest_is_as_one_machine_makes_it() {
    let dir = folder();
    let d = dir.path();
    write(d, "wc -c <\"$0\" | tr -d ' ' >bytes.txt; mkdir deep; printf %s \"$1\" >deep/name.txt; rm \"$0\"", "");
    let text = succeed(d, &["run", "dataset.toml", "-o", "whole"]);
    assert!(text.contains("warning: [farm] after_frame (\"sh\") was not run: nodes of a farm do that"), "{text}");
    let whole = contents(&d.join("whole"));
    assert!(!whole.keys().any(|path| path.iter().any(|part| part == "after_frame")));

    let rates = "0.0165,licence=0.00015/core-minute";
    let text = succeed(d, &[&PLAN[..], &["--price", rates]].concat());
    assert!(text.contains("dollars at 0.0165 per vCPU-hour and 0.00015 per core-minute for licence (given): "), "{text}");
    assert!(text.contains("and what \"sh\" takes after every frame") && !text.contains("warning"), "{text}");
    // Two workers at the same tasks make the same frames, whichever is first.
    let workers = ["a", "b"].map(|scratch| {
        let mut command = enfilade(d, &["farm", "work", "job", "--task", "0-2", "--scratch", scratch, "--threads", "1"]);
        command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    });
    for mut worker in workers {
        assert_eq!(worker.wait().unwrap().code(), Some(0));
    }
    let text = succeed(d, &["farm", "status", "job", "--price", rates, "--attempts", "attempts.csv"]);
    assert!(
        text.contains("% into the program that is run after them,") && text.contains(" for machine, ") && text.contains(" for licence")
    );
    assert!(!text.contains("came out differently"), "{text}");
    let table = fs::read_to_string(d.join("attempts.csv")).unwrap();
    let column = |name: &str| table.lines().next().unwrap().split(',').position(|cell| cell == name).unwrap();
    let dollars = |row: &str, name: &str| row.split(',').nth(column(name)).unwrap().parse::<f64>().unwrap();
    for row in table.lines().skip(1) {
        let (machine, licence) = (dollars(row, "cost_cloud_dollars"), dollars(row, "cost_vray_dollars"));
        assert!((licence - machine * 0.009 / 0.0165).abs() < 2e-6, "{row}");
    }
    fs::write(
        d.join("prices.csv"),
        "name,dollars_per_vcpu_hour,vcpus,memory_gib,licence_dollars_per_core_minute\nowned,0,64,64,\nrented,0.05,64,64,0.00015\n",
    )
    .unwrap();
    let text = succeed(d, &["farm", "status", "job", "--price", "prices.csv"]);
    assert!(text.contains("0.00 dollars at 0 per vCPU-hour (owned)") && text.contains("for licence (rented): "), "{text}");
    assert!(text.contains("owned; all of them there, whole machines: 0.00 dollars"), "the cheaper with its licence: {text}");

    for _ in 0..2 {
        succeed(d, &["farm", "collect", "job", "-o", "out"]);
        let [left, rest] = apart(&d.join("out"));
        assert_same(&whole, &rest);
        assert_eq!(left.len(), 6, "{:?}", left.keys());
        for frame in 0..3 {
            let of = |name: &str| &left[&PathBuf::from(format!("scenes/room/_detail/cam_00/after_frame/frame.{frame:04}/{name}"))];
            assert_eq!(of("deep/name.txt"), format!("room/cam_00/{frame:04} {{}} $HOME").as_bytes());
            let color = format!("scenes/room/images/scene_cam_00_final_hdf5/frame.{frame:04}.color.hdf5");
            assert_eq!(String::from_utf8_lossy(of("bytes.txt")).trim(), rest[&PathBuf::from(color)].len().to_string());
        }
    }
    succeed(d, &["verify", "out"]);
    // The program's files of frames that are rendered again are outdated, so they are removed.
    succeed(d, &["run", "out", "--only", "render", "--force"]);
    assert!(apart(&d.join("out"))[0].is_empty());

    // Another program makes another job, and changes nothing of what one machine has made.
    write(d, "true", "");
    fail(d, &PLAN, 1, &["holds another job"]);
    assert!(succeed(d, &["run", "dataset.toml", "-o", "whole"]).contains("Nothing to do"));
}

#[test]
fn a_program_that_fails_is_the_frames_failure_and_the_frame_is_not_rendered_again() {
    let dir = folder();
    let d = dir.path();
    let weights = d.join("weights");
    let script = format!("if [ ! -e \"{0}\" ]; then echo no weights in {0} >&2; exit 3; fi; cp \"{0}\" .", weights.display());
    write(d, &script, "");
    succeed(d, &PLAN);
    let words =
        ["task 1: permanent, 0 frames committed", "after_frame: \"sh\" ended with exit code 3; expected 0; it said last:\nno weights in "];
    fail(d, &["farm", "work", "job", "--task", "1", "--scratch", "a"], 65, &words);
    fail(d, &["farm", "status", "job"], 1, &["0 of 3 frames", "attempts: 1 permanent", "no weights in"]);
    let json = |name: &str| serde_json::from_slice::<serde_json::Value>(&fs::read(d.join("job").join(name)).unwrap()).unwrap();
    let kept = json("kept/room/cam_00/0001.json");
    fs::write(&weights, "w").unwrap();
    // Kept files of another frame, damaged since, are not used.
    for end in ["json", "tar"] {
        let [from, to] = ["0001", "0002"].map(|frame| d.join(format!("job/kept/room/cam_00/{frame}.{end}")));
        fs::copy(from, to).unwrap();
    }
    fs::write(d.join("job/kept/room/cam_00/0002.tar"), "x").unwrap();
    succeed(d, &["farm", "work", "job", "--shard", "0/1", "--scratch", "a"]);
    // The recorded rendering time is the first attempt's.
    let done = json("done/room/cam_00/0001.json");
    assert!(done["wall_s"] == kept["wall_s"] && done["attempt"] != kept["attempt"] && done["after_frame_wall_s"].as_f64() > Some(0.0));
    assert_eq!(fs::read_dir(d.join("job/kept/room/cam_00")).unwrap().count(), 0, "nothing is kept of frames that are committed");
    succeed(d, &["farm", "collect", "job", "-o", "out"]);
    succeed(d, &["run", "dataset.toml", "-o", "whole"]);
    let [left, rest] = apart(&d.join("out"));
    assert_same(&contents(&d.join("whole")), &rest);
    assert!(left.len() == 3 && left.values().all(|content| content == b"w"));
}

#[test]
fn programs_that_are_missing_hang_or_cannot_be_are_told() {
    let dir = folder();
    let d = dir.path();
    write(d, "sleep 100", "after_frame_timeout_s = 0.3\n");
    succeed(d, &[&PLAN[..], &["--frames", "1"]].concat());
    let words = ["task 0: permanent", "took longer than after_frame_timeout_s = 0.3 and was ended"];
    fail(d, &["farm", "work", "job", "--task", "0", "--scratch", "a"], 65, &words);
    let change = |from: &str, to: &str| {
        let text = fs::read_to_string(d.join("dataset.toml")).unwrap();
        assert!(text.contains(from));
        fs::write(d.join("dataset.toml"), text.replace(from, to)).unwrap();
    };
    change("\"sh\"", "\"no-such-program\"");
    let plan = ["farm", "plan", "dataset.toml", "-o", "other", "--frames", "1"];
    assert!(succeed(d, &plan).contains("warning: [farm] after_frame: this machine has no program \"no-such-program\""));
    let words = ["\"no-such-program\" cannot be started", "install it on every node"];
    fail(d, &["farm", "work", "other", "--task", "0", "--scratch", "a"], 65, &words);
    change("{camera}_final", "{cam}_final");
    let words = ["dataset.toml:", "there is no placeholder {cam}", "did you mean {camera}?", "the placeholders are {frame_dir}, {out_dir}"];
    fail(d, &plan, 2, &words);
    fail(d, &["run", "dataset.toml", "-o", "whole"], 2, &words);
    change("after_frame_timeout_s = 0.3", "after_frame_timeout = 3");
    fail(d, &plan, 2, &["unknown key `after_frame_timeout`", "did you mean `after_frame_timeout_s`?"]);
}

#[test]
fn a_worker_that_is_asked_to_end_ends_the_program_and_keeps_the_finished_frame() {
    let dir = folder();
    let d = dir.path();
    let [begun, over] = ["begun", "over"].map(|name| d.join(name).display().to_string());
    write(d, &format!("touch \"{begun}\"; [ -e \"{over}\" ] || sleep 100"), "");
    succeed(d, &[&PLAN[..], &["--frames", "1"]].concat());
    let mut worker =
        enfilade(d, &["farm", "work", "job", "--task", "0", "--scratch", "a"]).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let waiting = Instant::now();
    while !Path::new(&begun).exists() && waiting.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(std::process::Command::new("kill").arg(worker.id().to_string()).status().unwrap().success());
    assert_eq!(worker.wait().unwrap().code(), Some(75));
    assert!(d.join("job/kept/room/cam_00/0000.tar").is_file(), "the frame is kept, but for what the program leaves");
    let text = run(d, &["farm", "status", "job"]).1;
    assert!(text.contains("attempts: 1 transient") && text.contains("was ended, since the worker was asked to end"), "{text}");
    fs::write(over, "").unwrap();
    succeed(d, &["farm", "work", "job", "--task", "0", "--scratch", "a"]);
    succeed(d, &["farm", "collect", "job", "-o", "out"]);
}
