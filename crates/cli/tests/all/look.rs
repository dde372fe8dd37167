//! `look` and `import --check`: what a stranger does first with a file.

use crate::common::{Lamp, fail, folder, succeed, write_room};
use std::fs;

/// Mean of red, green and blue of a JPEG of 640 x 480 pixels.
fn brightness(path: &std::path::Path) -> f64 {
    let picture = image::open(path).unwrap().into_rgb8();
    assert_eq!(picture.dimensions(), (640, 480));
    picture.as_raw().iter().map(|byte| f64::from(*byte)).sum::<f64>() / picture.as_raw().len() as f64
}

#[test]
fn a_room_is_seen_in_one_step_with_its_own_light_or_with_what_it_lacks() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "lit", Lamp::On);
    let text = succeed(d, &["look", "lit.obj", "--seconds", "1"]);
    assert!(text.contains("a place that was found, since the file has no camera") && text.contains("lit.jpg"), "{text}");
    assert!(!text.contains("light  ") && (60.0..220.0).contains(&brightness(&d.join("lit.jpg"))), "{text}");
    write_room(d, "dark", Lamp::Off);
    let text = succeed(d, &["look", "dark.obj", "-o", "dark.png", "--seconds", "1"]);
    assert!(text.contains("nothing in the file shines: lamps below its ceilings and an overcast sky light it"), "{text}");
    assert!((60.0..220.0).contains(&brightness(&d.join("dark.png"))), "{text}");
    // Nothing else was written.
    let mut names: Vec<String> = fs::read_dir(d).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert_eq!(names, ["dark.mtl", "dark.obj", "dark.png", "lit.jpg", "lit.mtl", "lit.obj"]);
}

#[test]
fn mistakes_about_a_look_say_what_to_do() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    fail(d, &["look", "room.obj", "-o", "room.bmp"], 2, &["room.bmp is no name of a picture", ".jpg or .png"]);
    fail(d, &["look", "room.obj", "--camera", "Camera"], 2, &["the scene has no camera \"Camera\"", "its cameras: []"]);
    fail(d, &["look", "room.obj", "--lamps", "floor"], 2, &["floor", "ceiling"]);
    fail(d, &["look", "nowhere.glb"], 1, &["nowhere.glb"]);
}

#[test]
fn a_check_tells_what_an_import_would_and_writes_nothing() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::Off);
    let text = succeed(d, &["import", "room.obj", "--check", "--meters-per-unit", "100"]);
    assert!(
        text.contains("nothing in it shines") && text.contains("rooms are 250.00 m high") && text.contains("nothing was written"),
        "{text}"
    );
    // It is the number that was stated that is wrong, and the file is not in centimetres.
    assert!(text.contains("with meters_per_unit = 1 (or --meters-per-unit 1), rooms are 2.50 m high"), "{text}");
    assert_eq!(fs::read_dir(d).unwrap().count(), 2);
    // A sky without a file is in the package.
    succeed(d, &["import", "room.obj", "--environment", "overcast"]);
    assert!(fs::metadata(d.join("room.scene")).unwrap().len() > 1_000_000);
}

/// A box of 2 m without its front, seen from 4 m away through its open side, as the Cornell box is.
#[test]
fn the_files_own_camera_is_kept_where_it_sees_something_wherever_it_stands() {
    let dir = folder();
    let d = dir.path();
    let wall = |turn: &str| {
        format!(
            "<shape type=\"rectangle\"><transform name=\"to_world\">{turn}</transform><bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf></shape>"
        )
    };
    let walls: String = [
        "<rotate x=\"1\" angle=\"-90\"/><translate y=\"-1\"/>",
        "<rotate x=\"1\" angle=\"90\"/><translate y=\"1\"/>",
        "<translate z=\"-1\"/>",
        "<rotate y=\"1\" angle=\"90\"/><translate x=\"-1\"/>",
        "<rotate y=\"1\" angle=\"-90\"/><translate x=\"1\"/>",
    ]
    .map(wall)
    .concat();
    let scene = |target: &str| {
        let sensor = format!(
            "<sensor type=\"perspective\"><transform name=\"to_world\"><lookat origin=\"0,0,4\" target=\"{target}\" up=\"0,1,0\"/></transform></sensor>"
        );
        format!("<scene version=\"3.0.0\">{sensor}{walls}<emitter type=\"point\"><point name=\"position\" y=\"0.8\"/></emitter></scene>")
    };
    fs::write(d.join("box.xml"), scene("0,0,0")).unwrap();
    let text = succeed(d, &["look", "box.xml", "--seconds", "1"]);
    assert!(text.contains("view     camera") && text.contains("of the file, which is in no room"), "{text}");
    // One that looks away shows nothing.
    fs::write(d.join("away.xml"), scene("0,0,8")).unwrap();
    let text = succeed(d, &["look", "away.xml", "--seconds", "1"]);
    assert!(!text.contains("which is in no room"), "{text}");
}
