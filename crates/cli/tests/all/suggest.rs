//! `suggest`: a label table from the names of a scene file.

use crate::common::{Lamp, fail, folder, succeed, write_room};
use std::fs;

/// Part and class of every row of a table.
fn rows(text: &str) -> Vec<(String, i16)> {
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("part,nyu40_id,nyu40_name,instance,confidence,guess"));
    lines.map(|line| line.split(',').collect::<Vec<_>>()).map(|cells| (cells[0].to_string(), cells[1].parse().unwrap())).collect()
}

#[test]
fn a_table_is_proposed_and_what_is_unsure_is_not_guessed() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    let text = succeed(d, &["suggest", "room.obj", "--min-confidence", "0.7"]);
    assert!(text.contains("of 4 parts") && text.contains("room.labels.csv"), "{text}");
    let table = rows(&fs::read_to_string(d.join("room.labels.csv")).unwrap());
    let class = |name: &str| table.iter().find(|(part, _)| part.contains(name)).unwrap().1;
    assert_eq!((table.len(), class("table"), class("lamp"), class("box")), (4, 7, 35, -1), "{table:?}");
    let again = fs::read(d.join("room.labels.csv")).unwrap();
    succeed(d, &["suggest", "room.obj", "--min-confidence", "0.7", "-o", "again.csv"]);
    assert_eq!(fs::read(d.join("again.csv")).unwrap(), again);
}

#[test]
fn more_confidence_means_fewer_labels() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    let labelled = |least: &str| {
        succeed(d, &["suggest", "room.obj", "-o", "t.csv", "--min-confidence", least, "--force"]);
        rows(&fs::read_to_string(d.join("t.csv")).unwrap()).iter().filter(|(_, class)| *class > 0).count()
    };
    let counts = ["0", "0.5", "0.8", "1"].map(labelled);
    assert!(counts.is_sorted_by(|a, b| a >= b) && counts[0] > 0 && counts[3] == 0, "{counts:?}");
}

#[test]
fn a_table_that_was_corrected_and_a_scene_file_are_not_written_over() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    succeed(d, &["suggest", "room.obj"]);
    // A second run changes nothing.
    succeed(d, &["suggest", "room.obj"]);
    let suggested = fs::read(d.join("room.labels.csv")).unwrap();
    let corrected = [suggested.as_slice(), b"box,29,box,,1.000,\n"].concat();
    fs::write(d.join("room.labels.csv"), &corrected).unwrap();
    fail(d, &["suggest", "room.obj"], 2, &["room.labels.csv is there and differs", "--force"]);
    assert_eq!(fs::read(d.join("room.labels.csv")).unwrap(), corrected);
    succeed(d, &["suggest", "room.obj", "--force"]);
    assert_eq!(fs::read(d.join("room.labels.csv")).unwrap(), suggested);
    for file in ["room.obj", "room.mtl"] {
        let before = fs::read(d.join(file)).unwrap();
        fail(d, &["suggest", "room.obj", "-o", file, "--force"], 2, &[file, "choose another file with -o"]);
        assert_eq!(fs::read(d.join(file)).unwrap(), before);
    }
}

#[test]
fn wrong_commands_say_what_to_do() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    fail(d, &["suggest", "room.obj", "--min-confidence", "1.5"], 2, &["1.5", "from 0 to 1"]);
    fail(d, &["suggest", "nothing.obj"], 1, &["nothing.obj"]);
    assert!(!d.join("nothing.labels.csv").exists() && !d.join("room.labels.csv").exists());
}
