//! Libraries as users have them: tiny ones, made here, and Poly Haven's furniture where it is.

use super::{Notes, home, names, of_root, read_library};
use crate::error::Error;
use enfilade_home::check::faults;
use enfilade_home::{Home, HomeConfig, RoomKind};
use enfilade_math::Vec3;
use enfilade_scene::{Cx, Heard, Quiet, to_bytes};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The corners and triangles of a box of this size that stands on y = 0.
fn cuboid([w, h, d]: [f32; 3]) -> (Vec<[f32; 3]>, Vec<[u16; 3]>) {
    let corner =
        |k: u16| [[-0.5, 0.5][usize::from(k & 1)] * w, [0.0, 1.0][usize::from(k >> 1 & 1)] * h, [-0.5, 0.5][usize::from(k >> 2)] * d];
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    ((0..8).map(corner).collect(), sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

/// A box as binary glTF.
fn glb(size: [f32; 3]) -> Vec<u8> {
    let (corners, triangles) = cuboid(size);
    let mut bin: Vec<u8> = corners.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    bin.extend(triangles.iter().flatten().flat_map(|i| i.to_le_bytes()));
    let [w, h, d] = size;
    let mut json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0,"name":"body"}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"material":0}}]}}],
        "materials":[{{"name":"oak","pbrMetallicRoughness":{{"baseColorFactor":[0.4,0.3,0.2,1],"metallicFactor":0}}}}],
        "buffers":[{{"byteLength":{0}}}],
        "bufferViews":[{{"buffer":0,"byteLength":96}},{{"buffer":0,"byteOffset":96,"byteLength":72}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3","min":[{1},0,{2}],"max":[{3},{h},{4}]}},
        {{"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}}]}}"#,
        bin.len(),
        -0.5 * w,
        -0.5 * d,
        0.5 * w,
        0.5 * d
    );
    while json.len() % 4 != 0 {
        json.push(' ');
    }
    let mut out = b"glTF".to_vec();
    out.extend([2, 28 + json.len() as u32 + bin.len() as u32].iter().flat_map(|v: &u32| v.to_le_bytes()));
    for (kind, chunk) in [(b"JSON", json.as_bytes()), (b"BIN\0", &bin)] {
        out.extend((chunk.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(chunk);
    }
    out
}

/// A catalogue with a wardrobe whose model is a unit cube, a door, and a lamp whose model is missing.
fn sh3f(file: &Path) {
    let catalogue = "license=CC-BY 3.0\nname#1=Wardrobe\nid#1=t#wardrobe\ncategory#1=Bedroom\nmodel#1=/w/w.obj\nwidth#1=120\ndepth#1=60\n\
        height#1=205.5\ncreator#1=Ann\nmodelRotation#1=0 0 1 0 1 0 -1 0 0\nname#2=Door\ncategory#2=Doors and windows\nmodel#2=/d.obj\n\
        name#3=Lamp\nid#3=t#lamp\ncategory#3=Lights\nmodel#3=/l/l.obj\nwidth#3=30\ndepth#3=30\nheight#3=45\nlightSourceX#3=15\n\
        lightSourceY#3=15\nlightSourceZ#3=30\n";
    archive(file, catalogue);
}

/// A catalogue of this text, with a unit cube as the model `/w/w.obj`.
fn archive(file: &Path, catalogue: &str) {
    let (corners, triangles) = cuboid([1.0; 3]);
    let mut obj = "mtllib w.mtl\nusemtl oak\n".to_string();
    corners.iter().for_each(|[x, y, z]| obj += &format!("v {x} {y} {z}\n"));
    triangles.iter().map(|t| t.map(|i| i + 1)).for_each(|[a, b, c]| obj += &format!("f {a} {b} {c}\n"));
    let mut archive = zip::ZipWriter::new(std::fs::File::create(file).unwrap());
    let entries =
        [("PluginFurnitureCatalog.properties", catalogue), ("w/w.obj", &obj), ("w/w.mtl", "newmtl oak\nKd 0.4 0.3 0.2\nmap_Kd lost.png\n")];
    for (name, text) in entries {
        archive.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
        archive.write_all(text.as_bytes()).unwrap();
    }
    archive.finish().unwrap();
}

/// A folder with a nightstand whose name does not reveal it, a bed, and a catalogue.
fn library() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("beds")).unwrap();
    std::fs::write(folder.path().join("beds/old_bed_1k.glb"), glb([1.8, 0.9, 2.1])).unwrap();
    std::fs::write(folder.path().join("k17.glb"), glb([0.45, 0.5, 0.4])).unwrap();
    let table = "licence = \"CC0\"\n[models.\"k17.glb\"]\nfamily = \"nightstand\"\n[models.\"t#lamp\"]\nuse = false\n";
    std::fs::write(folder.path().join("assets.toml"), table).unwrap();
    sh3f(&folder.path().join("few.sh3f"));
    folder
}

fn config(folder: &Path) -> HomeConfig {
    let assets = vec![folder.to_string_lossy().into_owned()];
    HomeConfig { rooms: vec![RoomKind::Bedroom], assets, ..HomeConfig::of_seed(2) }
}

fn located(path: &str) -> Result<PathBuf, Error> {
    Ok(path.into())
}

fn made(config: &HomeConfig) -> Result<Home, Error> {
    home(config, &located, &Quiet)
}

/// The first home of these seeds that has models of all of these names: not every room has place for everything.
fn first_with(config: &HomeConfig, seeds: std::ops::Range<u64>, names: &[&str], cx: &dyn Cx) -> (HomeConfig, Home) {
    let mut tried = seeds.map(|seed| HomeConfig { seed, ..config.clone() }).map(|config| {
        let home = home(&config, &located, cx).expect("the library can be used");
        (config, home)
    });
    let has = |home: &Home, name: &str| home.credits.iter().any(|credit| credit.contains(name));
    tried.find(|(_, home)| names.iter().all(|name| has(home, name))).expect("one of the homes has them all")
}

/// Message and hint of a failure.
fn refused(config: &HomeConfig) -> (String, String) {
    let error = made(config).expect_err("it is refused");
    (error.to_string(), error.hint().unwrap_or_default())
}

#[test]
fn models_are_placed_like_our_own_with_labels_and_credits() {
    let folder = library();
    let heard = Heard::default();
    let (config, home) = first_with(&config(folder.path()), 0..30, &["Wardrobe", "k17", "old_bed"], &heard);
    let of_wardrobe = |line: &String| line.contains("not as their files say") && line.contains("lost.png");
    assert!(heard.lines().iter().any(of_wardrobe), "{heard:?}");
    assert_eq!(faults(&home), []);
    assert_eq!(home.scene.validate(), Ok(()));
    let of = |name: &str| home.scene.parts.iter().position(|part| part.name == name).unwrap_or_else(|| panic!("no {name}"));
    for (name, class) in [("bed_1/body", 4), ("nightstand_1/body", 32), ("wardrobe_1/oak", 3)] {
        assert_eq!(home.labels.parts[of(name)].semantic, class, "{name}");
        assert_eq!(home.scene.materials[home.scene.parts[of(name)].material as usize].name, "oak");
    }
    let wardrobe = &home.scene.parts[of("wardrobe_1/oak")];
    let mesh = &home.scene.meshes[wardrobe.mesh as usize];
    let width = mesh.positions.iter().map(|p| p.x).fold(0.0, f32::max);
    assert!((width - 0.6).abs() < 1e-4, "catalogues say how wide their things are: {width}");
    let wardrobe = "Wardrobe (few.sh3f, t#wardrobe): CC-BY 3.0, by Ann";
    assert_eq!(home.credits, [wardrobe, "k17 (k17.glb): CC0", "old_bed_1k (beds/old_bed_1k.glb): CC0"]);
    assert_eq!(to_bytes(&made(&config).unwrap().scene), to_bytes(&home.scene), "same seed, same bytes");
    let without = made(&HomeConfig { assets_share: 0.0, ..config.clone() }).unwrap();
    assert!(without.credits.is_empty());
    assert_eq!(names(&config, &located), ["assets.toml", "beds/old_bed_1k.glb", "few.sh3f", "k17.glb"]);
}

#[test]
fn the_table_beside_a_single_catalogue_is_one_of_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let catalogue = folder.path().join("few.sh3f");
    sh3f(&catalogue);
    let config = HomeConfig { assets: vec![catalogue.to_string_lossy().into_owned()], ..HomeConfig::default() };
    assert_eq!(names(&config, &located), ["few.sh3f"]);
    std::fs::write(folder.path().join("assets.toml"), "[models.\"t#lamp\"]\nuse = false\n").unwrap();
    assert_eq!(names(&config, &located), ["few.sh3f", "assets.toml"]);
}

#[test]
fn libraries_that_cannot_be_used_are_refused_with_file_and_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let of = config(at);
    let (message, hint) = refused(&config(&at.join("nowhere")));
    assert!(message.contains("no library of models at") && message.contains("nowhere") && hint.contains(".sh3f"), "{message}");
    let (message, hint) = refused(&of);
    assert!(message.contains("there are no models in") && hint.contains(".glb"), "{message}");
    std::fs::write(at.join("thing.glb"), glb([0.5; 3])).unwrap();
    let (message, hint) = refused(&of);
    assert!(message.contains("thing.glb: its name does not tell what it is") && hint.contains("assets.toml"), "{message}");
    std::fs::rename(at.join("thing.glb"), at.join("mug.glb")).unwrap();
    let (message, _) = refused(&of);
    assert!(message.contains("mug.glb: 0.50 x 0.50 x 0.50 m fits none of: mug from"), "{message}");
    std::fs::write(at.join("bed.glb"), b"glTF and no more").unwrap();
    let (message, hint) = refused(&of);
    assert!(message.contains("bed.glb") && hint.contains("allow_broken_assets"), "{message}");
    std::fs::write(at.join("bed.glb"), glb([1.6, 0.9, 2.1])).unwrap();
    std::fs::write(at.join("few.sh3f"), b"no archive").unwrap();
    let (message, hint) = refused(&of);
    assert!(message.contains("few.sh3f: whole file: not an archive") && hint.contains("download"), "{message}");
}

#[test]
fn a_model_that_is_wanted_and_broken_is_an_error_unless_the_user_allows_it() {
    let folder = library();
    std::fs::write(folder.path().join("assets.toml"), "").unwrap();
    // Every bedside has a lamp, but not every bedroom a bedside.
    let seeds = (0..30).map(|seed| HomeConfig { seed, ..config(folder.path()) });
    let config = seeds.into_iter().find(|config| made(config).is_err()).expect("one of the homes wants the lamp");
    let (message, hint) = refused(&config);
    assert!(message.contains("few.sh3f: l/l.obj: the model is not in the archive") && hint.contains("use = false"), "{message}");
    let heard = Heard::default();
    let home = home(&HomeConfig { allow_broken_assets: true, ..config }, &located, &heard).unwrap();
    assert_eq!(home.scene.validate(), Ok(()));
    assert!(heard.lines().iter().any(|line| line.contains("l/l.obj") && line.contains("our own piece is used instead")));
}

#[test]
fn gltf_is_let_go_until_it_is_wanted_and_that_of_no_family_is_not_opened() {
    let folder = tempfile::tempdir().unwrap();
    let bed = folder.path().join("bed.glb");
    std::fs::write(&bed, glb([1.8, 0.9, 2.1])).unwrap();
    std::fs::write(folder.path().join("thing.glb"), b"glTF and no more").unwrap();
    let models = of_root(folder.path(), false, &Notes::default(), &Quiet).expect("nobody looks into the broken file");
    assert_eq!(models.len(), 2);
    assert!((models[0].size - Vec3::new(1.8, 2.1, 0.9)).abs().max_element() < 1e-4, "{}", models[0].size);
    std::fs::remove_file(bed).unwrap();
    assert!(models[0].body().is_err() && models[1].body().is_err());
}

#[test]
fn warnings_about_broken_models_name_their_files() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("armchair.glb"), glb([0.8, 0.9, 0.8])).unwrap();
    std::fs::write(folder.path().join("bed.glb"), b"glTF and no more").unwrap();
    std::fs::write(folder.path().join("assets.toml"), "[models.\"armchair.glb\"]\nuse = false\n").unwrap();
    let heard = Heard::default();
    read_library(folder.path(), &heard).unwrap();
    let heard = heard.lines();
    assert!(heard.len() == 1 && heard[0].starts_with("bed.glb: ") && heard[0].contains("left out"), "{heard:?}");
}

#[test]
fn what_looks_aside_in_a_catalogue_keeps_its_measures_and_its_lights() {
    let folder = tempfile::tempdir().unwrap();
    let wide = "name#1=Lamp\nid#1=t#lamp\ncategory#1=Lights\nmodel#1=/w/w.obj\nwidth#1=120\ndepth#1=60\nheight#1=50\n\
        lightSourceX#1=30\nlightSourceY#1=15\nlightSourceZ#1=40\n";
    archive(&folder.path().join("few.sh3f"), wide);
    for (table, size, at) in [
        ("", [1.2, 0.6, 0.5], [0.3, 0.15, 0.4]),
        ("front = \"+x\"", [0.6, 1.2, 0.5], [0.15, -0.3, 0.4]),
        ("front = \"-x\"", [0.6, 1.2, 0.5], [-0.15, 0.3, 0.4]),
        ("[models.\"t#lamp\"]\nfront = \"+x\"\nsize = [1.2, 1.2, 1.0]\n", [1.2, 1.2, 1.0], [0.3, -0.3, 0.8]),
    ] {
        std::fs::write(folder.path().join("assets.toml"), table).unwrap();
        let models = of_root(folder.path(), false, &Notes::default(), &Quiet).unwrap();
        let body = models[0].body().unwrap();
        for (found, expected) in [(models[0].size, size), (body.size(), size), (body.bulbs[0].at, at)] {
            assert!((found - Vec3::from_array(expected)).abs().max_element() < 1e-5, "{table}: {found}, not {expected:?}");
        }
    }
}

#[test]
fn poly_havens_furniture_furnishes_a_living_room() {
    let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
        eprintln!("skipped: ENFILADE_SCENES is not set");
        return;
    };
    let folder = Path::new(&scenes).join("polyhaven-furniture-1k");
    let heard = Heard::default();
    let config = HomeConfig { rooms: vec![RoomKind::Living], ..config(&folder) };
    let (_, home) = first_with(&config, 0..12, &["sofa_03_1k", "wooden_bookshelf_worn_1k"], &heard);
    assert_eq!(faults(&home), []);
    assert!(heard.lines().iter().any(|line| line.contains("tea_set_01_1k.gltf")));
}

#[test]
fn the_plan_of_a_home_is_one_of_its_files_and_its_errors_name_it() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("plan.json");
    let config = HomeConfig { plan: Some(file.display().to_string()), ..HomeConfig::of_seed(1) };
    let locate = |path: &str| Ok(PathBuf::from(path));
    assert_eq!(super::files(&config, &locate).unwrap(), std::slice::from_ref(&file));
    let refused = || home(&config, &locate, &Quiet).unwrap_err().to_string();
    assert!(refused().contains("cannot read the plan"), "{}", refused());
    for (rooms, expected) in [
        ("", "no room was found"),
        (r#"{"kind": "atic", "polygon": [[0, 0], [3, 0], [3, 3]]}"#, "is of the kind \"atic\""),
        (r#"{"kind": "hall", "polygon": [[0, 0], [3, 3], [3, 0], [0, 3]]}"#, "crosses itself"),
        (r#"{"kind": "hall", "polygon": [[0, 0], [3, "a"]]}"#, "line 1, column"),
    ] {
        std::fs::write(&file, format!(r#"{{"format": "enfilade plan 1", "rooms": [{rooms}]}}"#)).unwrap();
        assert!(refused().contains(expected) && refused().contains("plan.json"), "{}", refused());
    }
    std::fs::write(&file, r#"{"rooms": [{"kind": "toilet", "polygon": [[0, 0], [1.6, 0], [1.6, 1.4], [0, 1.8]]}]}"#).unwrap();
    let heard = Heard::default();
    let made = home(&config, &locate, &heard).unwrap();
    assert_eq!(faults(&made), []);
    assert!(made.notes.iter().any(|note| note.contains("an entrance was added to \"toilet_1\"")), "{:?}", made.notes);
}
