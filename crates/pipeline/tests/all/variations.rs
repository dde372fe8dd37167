//! Variations of a scene: their names, what they share with it, and that they follow it.

use crate::common::{LAMP, TABLE, WALL, block, write_blocks};
use crate::rooms::{failures, files, write_poses};
use enfilade_dataset::{Dataset, PartitionConfig, Side};
use enfilade_frame::Layer;
use enfilade_pipeline::{Config, Overrides, Silent, Stage, Summary, run, run_stage};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A room with a table, a chair, a lamp and a cup on the table; `keys` are those of `[scene.vary]`.
fn config(folder: &Path, keys: &str) -> Config {
    let chair = block("chair", [-0.5, -0.2, 0.0], [-0.1, 0.2, 0.45], [0.3, 0.3, 0.5]);
    write_blocks(folder, &[WALL, TABLE, LAMP, chair, block("cup", [-0.4, 0.8, 0.7], [-0.3, 0.9, 0.8], [0.6, 0.6, 0.6])]);
    write_poses(folder, "one.json", 0.2);
    fs::write(folder.join("labels.csv"), "name,semantic\nwall,wall\ntable,table\nlamp,lamp\nchair,chair\ncup,otherprop\n").unwrap();
    let text = format!(
        "name = \"set\"\nseed = 3\nlabels = \"labels.csv\"\nframes = 2\n[render]\nsize = [64, 48]\nsamples = 2\nmax_bounces = 2\n\
         [carve]\nrays = 8192\niterations = 2\n[gate]\naction = \"report\"\n[[scene]]\nname = \"room\"\nfile = \"room.obj\"\n\
         up_axis = \"z\"\ncameras = [{{ position = [0.2, -0.9, 1.4], look_at = [0.0, 0.9, 0.6] }}]\n\
         plan.mode = {{ kind = \"keyframes\", files = [\"one.json\"] }}\n[scene.vary]\n{keys}"
    );
    fs::write(folder.join("dataset.toml"), text).unwrap();
    Config::read(&folder.join("dataset.toml"), &Overrides::default()).unwrap()
}

fn made(keys: &str) -> (TempDir, PathBuf, Config) {
    let place = tempfile::tempdir().unwrap();
    let (config, out) = (config(place.path(), keys), place.path().join("out"));
    assert_whole(&run(&config, &out, None, &Silent).unwrap());
    (place, out, config)
}

fn assert_whole(summary: &Summary) {
    assert!(summary.ok(), "{:?}", failures(summary));
}

/// Whether two files are one.
#[cfg(unix)]
fn is_link(a: &Path, b: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let inode = |path: &Path| path.metadata().unwrap_or_else(|error| panic!("{}: {error}", path.display())).ino();
    inode(a) == inode(b)
}

#[test]
#[cfg(unix)]
fn variations_of_light_and_colour_share_geometry_free_space_and_poses_with_their_scene() {
    let (_place, out, config) = made("count = 2\nlamps = {}\nmaterials = { share = 1, textures = 0 }\nexposure = [1, 1]\n");
    assert_eq!(config.scenes.iter().map(|scene| scene.name.as_str()).collect::<Vec<_>>(), ["room", "room_v01", "room_v02"]);
    let dataset = Dataset::open(&out).unwrap();
    let layout = dataset.layout();
    let mesh =
        |scene: &str| fs::read_dir(layout.mesh_file(scene, "x").parent().unwrap()).unwrap().map(|e| e.unwrap().path()).collect::<Vec<_>>();
    for name in ["room_v01", "room_v02"] {
        let [octomap, nodes, poses] = [
            [layout.octomap("room"), layout.octomap(name)],
            [layout.metadata_nodes("room"), layout.metadata_nodes(name)],
            ["room", name].map(|scene| layout.keyframes(scene, "cam_00", "positions")),
        ];
        for [first, own] in [octomap, nodes, poses] {
            assert!(is_link(&first, &own), "{}", own.display());
        }
        let linked =
            mesh("room").iter().filter(|path| is_link(path, &layout.mesh_file(name, path.file_name().unwrap().to_str().unwrap()))).count();
        assert!(linked >= 10, "{linked} of {:?}", mesh("room"));
        // The package lacks what the first scene's has, which is there under a second name.
        let package = layout.scene_package(name);
        assert!(is_link(&layout.scene_package("room"), &package.with_file_name("first.scene")));
        assert!(fs::read(&package).unwrap().starts_with(b"enfilade scene 4 changes\n"));
        let record = dataset.read_variation(name).unwrap().unwrap();
        assert!(record.keeps_geometry && record.lamps.len() == 1 && !record.materials.is_empty());
        // The same surfaces in other light.
        let layers = |scene: &str| dataset.read_frame(scene, "cam_00", 1, &[Layer::RenderEntityId, Layer::Semantic, Layer::Color]).unwrap();
        let (first, own) = (layers("room"), layers(name));
        assert_eq!(
            [Layer::RenderEntityId, Layer::Semantic].map(|layer| first.get(layer)),
            [Layer::RenderEntityId, Layer::Semantic].map(|layer| own.get(layer))
        );
        assert_ne!(first.get(Layer::Color), own.get(Layer::Color));
    }
    // One side of the partition for all of them.
    let sides: BTreeSet<Side> = dataset.read_partition().unwrap().into_iter().map(|row| row.side.unwrap()).collect();
    assert_eq!(sides.len(), 1);
    let split = fs::read_to_string(layout.partition_report()).unwrap();
    assert!(split.contains("\"variations\"") && split.contains("room_v02"), "{split}");
    let report = enfilade_pipeline::partition(&out, |config: &mut PartitionConfig| config.shares = [0.0, 0.0, 1.0]).unwrap();
    assert_eq!(report.scenes["test"].len(), 3);
    // The offset of the exposure is in the table of tone maps.
    let scale = |scene: &str| dataset.read_tone_maps(scene, "cam_00").unwrap()[0].display_scale;
    assert!(scale("room_v01") > 0.0 && scale("room") > 0.0);
}

#[test]
fn textures_leave_every_surface_where_it_is_and_the_first_package_is_needed() {
    let (_place, out, config) = made("count = 1\nmaterials = { share = 1, textures = 1 }\n");
    let dataset = Dataset::open(&out).unwrap();
    let record = dataset.read_variation("room_v01").unwrap().unwrap();
    assert!(record.keeps_geometry && record.materials.iter().any(|material| material.texture.is_some()), "{record:?}");
    let layers = |scene: &str| dataset.read_frame(scene, "cam_00", 1, &[Layer::RenderEntityId, Layer::DepthMeters, Layer::Color]).unwrap();
    let (first, own) = (layers("room"), layers("room_v01"));
    for layer in [Layer::RenderEntityId, Layer::DepthMeters] {
        assert_eq!(first.get(layer), own.get(layer));
    }
    assert_ne!(first.get(Layer::Color), own.get(Layer::Color));
    // Without it, the scene is imported again.
    let beside = dataset.layout().scene_package("room_v01").with_file_name("first.scene");
    let before = files(&out);
    fs::remove_file(&beside).unwrap();
    assert_whole(&run(&config, &out, None, &Silent).unwrap());
    assert!(beside.is_file());
    assert_eq!(files(&out).keys().collect::<Vec<_>>(), before.keys().collect::<Vec<_>>());
}

#[test]
fn a_second_run_does_nothing_and_changes_of_the_first_scene_make_the_variations_again() {
    let (place, out, config) = made("count = 1\nlamps = { lit = [1, 1] }\n");
    let before = files(&out);
    assert!(run(&config, &out, None, &Silent).unwrap().nothing_done());
    assert_eq!(files(&out), before);
    // Another colour of the file's wall.
    let library = place.path().join("room.mtl");
    fs::write(&library, fs::read_to_string(&library).unwrap().replace("Kd 0.7 0.7 0.7", "Kd 0.3 0.7 0.7")).unwrap();
    let summary = run(&config, &out, None, &Silent).unwrap();
    assert_whole(&summary);
    let made = |scene: &str, stage: Stage| {
        let outcome = summary.scenes.iter().find(|outcome| outcome.name == scene).unwrap();
        !outcome.stages.iter().find(|outcome| outcome.stage == stage).unwrap().up_to_date
    };
    assert!(made("room_v01", Stage::Import) && made("room_v01", Stage::Render));
    assert!(!made("room_v01", Stage::Carve), "the free space is the same");
    // More variations leave those that are there as they are.
    let more = self::config(place.path(), "count = 2\nlamps = { lit = [1, 1] }\n");
    let render = |scene: &str| out.join(format!(".enfilade/{scene}/render.json"));
    let library = fs::read_to_string(&library).unwrap();
    fs::write(place.path().join("room.mtl"), library.replace("Kd 0.7 0.7 0.7", "Kd 0.3 0.7 0.7")).unwrap();
    let kept = fs::read(render("room_v01")).unwrap();
    assert_whole(&run(&more, &out, None, &Silent).unwrap());
    assert_eq!((fs::read(render("room_v01")).unwrap() == kept, render("room_v02").is_file()), (true, true));
}

#[test]
fn what_moves_is_carved_anew_and_seen_from_the_same_poses() {
    let keys = "count = 4\nfurniture = { share = 1, shift_m = 0.4 }\nclutter = { remove = [1, 1] }\n";
    let (_place, out, _) = made(keys);
    let dataset = Dataset::open(&out).unwrap();
    let mut moved = 0;
    for name in ["room_v01", "room_v02", "room_v03", "room_v04"] {
        let record = dataset.read_variation(name).unwrap().unwrap();
        assert!(record.removed == ["cup"] && !record.keeps_geometry, "{record:?}");
        moved += record.moved.len();
        assert_eq!(dataset.read_trajectory(name, "cam_00").unwrap(), dataset.read_trajectory("room", "cam_00").unwrap());
        assert_ne!(dataset.read_free_space(name).unwrap().0, dataset.read_free_space("room").unwrap().0);
        assert_eq!(dataset.read_nodes(name).unwrap().len() + 1, dataset.read_nodes("room").unwrap().len());
    }
    assert!(moved > 0);
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let keys = "count = 2\nlamps = {}\nsky = {}\nmaterials = {}\nfurniture = {}\nclutter = {}\n";
    let made = |threads: usize| {
        let place = tempfile::tempdir().unwrap();
        let (config, out) = (config(place.path(), keys), place.path().join("out"));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert_whole(&pool.install(|| run(&config, &out, None, &Silent)).unwrap());
        let mut found = files(&out.join("scenes"));
        found.retain(|path, _| !path.to_string_lossy().contains("manifest_times"));
        found
    };
    let (one, three) = (made(1), made(3));
    assert_eq!(one.keys().collect::<Vec<_>>(), three.keys().collect::<Vec<_>>());
    let differ: Vec<_> = one.iter().filter(|(path, bytes)| three[*path] != **bytes).map(|(path, _)| path).collect();
    assert!(differ.is_empty(), "{differ:?}");
}

#[test]
fn a_variation_alone_says_that_its_scene_comes_first() {
    let place = tempfile::tempdir().unwrap();
    let (config, out) = (config(place.path(), "count = 1\nlamps = {}\n"), place.path().join("out"));
    let summary = run(&config, &out, Some("room_v01"), &Silent).unwrap();
    let failure = summary.scenes[0].failure.as_ref().unwrap();
    assert!(failure.message.contains("the results of `import` for scene room are not there"), "{}", failure.message);
    assert!(failure.hint.as_ref().unwrap().contains("--only import --scene room"), "{:?}", failure.hint);
    // Imported and planned, it is enough.
    for stage in [Stage::Import, Stage::Carve, Stage::Plan] {
        assert_whole(&run_stage(&out, stage, Some("room"), false, &Silent).unwrap());
    }
    assert_whole(&run(&config, &out, Some("room_v01"), &Silent).unwrap());
}
