//! Objects of `[[object]]` in datasets: placed on import, labelled, recorded, and placed again when what they depend on changes.

use crate::rooms::{ONE, config, failures, files, place};
use enfilade_dataset::{Dataset, PlacedObjects};
use enfilade_pipeline::{Config, Overrides, Silent, run};
use enfilade_scene::PartLabel;
use std::fs;
use std::path::Path;

/// Two models of 10 cm and 16 cm.
fn write_models(folder: &Path) {
    fs::create_dir_all(folder.join("models")).unwrap();
    for (name, half) in [("cube", 0.05), ("crate", 0.08)] {
        let corner = |i: usize| format!("v {} {} {}\n", [-half, half][i & 1], [-half, half][i >> 1 & 1], [-half, half][i >> 2]);
        let corners: String = (0..8).map(corner).collect();
        let faces = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
        fs::write(folder.join(format!("models/{name}.obj")), corners + faces).unwrap();
    }
}

const OBJECTS: &str = "[[scene.object]]\nfiles = \"models\"\ncount = 3\non = \"table\"\nlabel = \"box\"\n";

fn placed(out: &Path) -> Option<PlacedObjects> {
    Dataset::open(out).unwrap().read_placed_objects("a").unwrap()
}

/// Label of each part by its name.
fn labels(out: &Path) -> Vec<(String, PartLabel)> {
    let dataset = Dataset::open(out).unwrap();
    let names = dataset.read_nodes("a").unwrap().into_iter().map(|node| node.node_name);
    let labels = dataset.mesh_files("a").read_labels().unwrap();
    names.zip(labels.parts).collect()
}

#[test]
fn objects_stand_on_the_table_and_keep_their_labels_beside_a_table_of_labels() {
    let (folder, out) = place();
    write_models(folder.path());
    fs::write(folder.path().join("labels.csv"), "part,nyu40_id\ntable,7\nwall,1\n").unwrap();
    let config_file = folder.path().join("dataset.toml");
    config(folder.path(), &[("a", "room.obj", ONE, OBJECTS)]);
    let text = fs::read_to_string(&config_file).unwrap().replace("up_axis = \"z\"", "up_axis = \"z\"\nlabels = \"labels.csv\"");
    fs::write(&config_file, text).unwrap();
    let labelled = Config::read(&config_file, &Overrides::default()).unwrap();
    let summary = run(&labelled, &out, None, &Silent).unwrap();
    assert!(summary.ok(), "{:?}", failures(&summary));
    let first = placed(&out).unwrap();
    assert_eq!((first.objects.len(), first.missing.len()), (3, 0));
    for object in &first.objects {
        assert_eq!((object.rests_on.as_str(), object.semantic), ("table", 29));
        let half = if object.model == "models/cube.obj" { 0.05 } else { 0.08 };
        assert!((object.world_from_model[2][3] - 0.7 - half).abs() < 1e-3, "{object:?}");
        let label = PartLabel { semantic: 29, instance: object.instance };
        assert!(labels(&out).contains(&(object.name.clone(), label)), "{:?}", labels(&out));
    }
    assert!(labels(&out).iter().any(|(name, label)| name == "table" && label.semantic == 7));

    // Nothing is made again, until another model is there.
    let before = files(&out);
    run(&labelled, &out, None, &Silent).unwrap();
    assert_eq!(files(&out), before);
    fs::copy(folder.path().join("models/cube.obj"), folder.path().join("models/another.obj")).unwrap();
    run(&labelled, &out, None, &Silent).unwrap();
    assert_eq!(placed(&out).unwrap().objects.iter().filter(|object| object.model == "models/another.obj").count(), 1);

    // Without objects their record is gone.
    let summary = run(&config(folder.path(), &[("a", "room.obj", ONE, "")]), &out, None, &Silent).unwrap();
    assert!(summary.ok(), "{:?}", failures(&summary));
    assert_eq!(placed(&out), None);
}

#[test]
fn a_group_without_models_is_an_error_that_names_the_pattern() {
    let (folder, out) = place();
    let summary = run(&config(folder.path(), &[("a", "room.obj", ONE, OBJECTS)]), &out, None, &Silent).unwrap();
    assert!(failures(&summary).iter().any(|failure| failure.contains("[[object]]: no model is called")), "{:?}", failures(&summary));
}
