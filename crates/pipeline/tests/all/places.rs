//! Starts of trajectories: places in a building, found ones, and open places.

use enfilade_dataset::Dataset;
use enfilade_explore::PlanReport;
use enfilade_pipeline::{Config, Event, Overrides, Reporter, Stage, Summary, run};
use std::path::Path;
use std::sync::Mutex;

/// Keeps what it is warned of.
#[derive(Default)]
struct Warnings(Mutex<Vec<String>>);

impl Reporter for Warnings {
    fn on(&self, _scene: &str, _stage: Stage, event: Event) {
        if let Event::Warned(warning) = event {
            self.0.lock().unwrap().push(warning.message.clone());
        }
    }
}

/// A box of `faces` quadrilaterals as OBJ, from (0, 0, 0) to (x, y, z), z up, seen from within if `inward`.
fn cuboid([x, y, z]: [f64; 3], inward: bool) -> String {
    let mut text = String::new();
    for i in 0..8 {
        let at = |bit: u32, far: f64| if i >> bit & 1 == 1 { far } else { 0.0 };
        text += &format!("v {} {} {}\n", at(0, x), at(1, y), at(2, z));
    }
    for [a, b, c, d] in [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]] {
        let face = if inward { [a, b, c, d] } else { [d, c, b, a] };
        text += &format!("f {}\n", face.map(|i| (i + 1).to_string()).join(" "));
    }
    text
}

/// A dataset of the scene file `name`, made with `cameras` under a grey sky, and what was warned of.
fn made(folder: &Path, [name, scene]: [&str; 2], cameras: &str) -> (Dataset, Summary, String) {
    std::fs::write(folder.join(name), scene).unwrap();
    std::fs::write(folder.join("sky.pfm"), sky()).unwrap();
    let text = format!(
        "seed = 1\nframes = 3\n[render]\nsize = [32, 24]\nsamples = 1\n[carve]\nrays = 8192\niterations = 1\n[[scene]]\nname = \"s\"\n\
         file = {name:?}\nup_axis = \"z\"\nenvironment = {{ file = \"sky.pfm\" }}\n{cameras}"
    );
    std::fs::write(folder.join("dataset.toml"), text).unwrap();
    let config = Config::read(&folder.join("dataset.toml"), &Overrides::default()).unwrap();
    let heard = Warnings::default();
    let summary = run(&config, &folder.join("out"), None, &heard).unwrap();
    (Dataset::open(folder.join("out")).unwrap(), summary, heard.0.into_inner().unwrap().join("\n"))
}

/// A grey sky of 4 × 2 pixels.
fn sky() -> Vec<u8> {
    let values = [0.5f32; 4 * 2 * 3];
    [b"PF\n4 2\n-1.0\n".to_vec(), values.iter().flat_map(|v| v.to_le_bytes()).collect()].concat()
}

fn report(dataset: &Dataset) -> PlanReport {
    serde_json::from_slice(&std::fs::read(dataset.layout().plan_report("s", "cam_00")).unwrap()).unwrap()
}

#[test]
fn a_thing_under_a_sky_is_carved_walked_around_and_rendered_with_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let cameras = "cameras = [{ position = [1, -3.5, 1.2], look_at = [1, 0.5, 0.5] }]\n[scene.carve]\nextent_m = 10\n";
    let (dataset, summary, warnings) = made(folder.path(), ["block.obj", &cuboid([2.0, 1.0, 1.0], false)], cameras);
    assert!(summary.ok(), "{:?}", summary.scenes[0].failure);
    assert!(report(&dataset).start.unwrap().is_kept);
    assert_eq!(dataset.frame_numbers("s", "cam_00").unwrap(), [0, 1, 2], "no gate rejects views for being open");
    assert!(warnings.contains("is in the open"), "{warnings}");
}

#[test]
fn a_given_view_is_rendered_whatever_the_gates_think_of_it() {
    let folder = tempfile::tempdir().unwrap();
    // Straight at a wall from near: a bare wall without depth.
    let cameras = "lamps = \"ceiling\"\ncameras = [{ position = [2, 0.6, 1.2], look_at = [2, 0, 1.2] }]\n";
    let (dataset, summary, _) = made(folder.path(), ["room.obj", &cuboid([4.0, 3.0, 2.5], true)], cameras);
    assert!(summary.ok(), "{:?}", summary.scenes[0].failure);
    assert!(dataset.frame_numbers("s", "cam_00").unwrap().contains(&0));
    let judged = dataset.read_view_gates("s", "cam_00").unwrap().unwrap();
    assert!(judged[0].fault.is_some() && judged[0].verdict == enfilade_dataset::ViewVerdict::Reported);
}

#[test]
fn found_places_take_the_part_of_cameras_that_are_not_wanted() {
    let folder = tempfile::tempdir().unwrap();
    let (dataset, summary, _) =
        made(folder.path(), ["room.obj", &cuboid([4.0, 3.0, 2.5], true)], "lamps = \"ceiling\"\ncameras = \"found\"\n");
    assert!(summary.ok(), "{:?}", summary.scenes[0].failure);
    assert_eq!(report(&dataset).start.unwrap().name, "start_00");
}

#[test]
fn a_file_whose_cameras_are_all_outside_begins_at_found_places_with_a_warning_unless_one_is_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let room = "<scene version=\"3.0.0\"><sensor type=\"perspective\" id=\"bird\"><float name=\"fov\" value=\"40\"/><transform name=\"to_world\">\
                <lookat origin=\"9, 9, 9\" target=\"0, 0, 1\" up=\"0, 0, 1\"/></transform></sensor>\
                <shape type=\"cube\"><boolean name=\"flip_normals\" value=\"true\"/><transform name=\"to_world\"><scale x=\"2\" y=\"1.5\" z=\"1.25\"/>\
                <translate z=\"1.25\"/></transform></shape><emitter type=\"constant\"/></scene>";
    let made = |cameras: &str| made(folder.path(), ["room.xml", room], &format!("lamps = \"ceiling\"\n{cameras}"));
    let (dataset, found, warnings) = made("");
    assert!(found.ok(), "{:?}", found.scenes[0].failure);
    assert!(warnings.contains("no camera of the file is in a building"), "{warnings}");
    assert_eq!(report(&dataset).start.unwrap().name, "start_00");
    let (_, chosen, warnings) = made("cameras = [\"bird\"]\n");
    assert!(chosen.ok(), "{:?}", chosen.scenes[0].failure);
    assert!(warnings.contains("is in the open"), "{warnings}");
}
