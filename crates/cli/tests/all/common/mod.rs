//! Helpers of the tests of the binary: tiny scenes, runs of the program, and a hash of a finished dataset.
#![allow(dead_code, reason = "each test file uses a part of it")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder that is removed at the end of the test.
pub fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

/// The program with its arguments, to be run in `dir`.
pub fn enfilade(dir: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_enfilade"));
    command.args(args).current_dir(dir).env_remove("ENFILADE_SCENES").env_remove("RUST_BACKTRACE");
    command
}

/// Exit code, standard output and standard error of a run.
pub fn run(dir: &Path, args: &[&str]) -> (i32, String, String) {
    let Output { status, stdout, stderr } = enfilade(dir, args).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let (out, err) = (text(stdout), text(stderr));
    assert!(!err.contains("panicked") && !out.contains("panicked"), "{args:?} panicked:\n{err}");
    (status.code().unwrap_or(-1), out, err)
}

/// A run that must come through.
pub fn succeed(dir: &Path, args: &[&str]) -> String {
    let (code, out, err) = run(dir, args);
    assert_eq!(code, 0, "{args:?}\n{out}\n{err}");
    out
}

/// A run that must exit with `code`, and print each of `words` on standard output or error.
pub fn fail(dir: &Path, args: &[&str], code: i32, words: &[&str]) -> String {
    let (found, out, err) = run(dir, args);
    let text = format!("{out}\n{err}");
    assert_eq!(found, code, "{args:?}\n{text}");
    for word in words {
        assert!(text.contains(word), "{args:?} does not say {word:?}:\n{text}");
    }
    text
}

/// Whether the test room has its lamp.
#[derive(Clone, Copy, PartialEq)]
pub enum Lamp {
    On,
    Off,
}

/// Writes `name.obj`: a closed room of 4 x 3 x 2.5 m (y up) with a table, a box and a ceiling lamp.
pub fn write_room(dir: &Path, name: &str, lamp: Lamp) -> PathBuf {
    let mut obj = format!("mtllib {name}.mtl\n");
    let mut vertices = 0;
    let mut block = |object: &str, material: &str, min: [f32; 3], max: [f32; 3], inward: bool| {
        obj.push_str(&format!("o {object}\nusemtl {material}\n"));
        for i in 0..8 {
            let pick = |axis: usize| if i >> axis & 1 == 0 { min[axis] } else { max[axis] };
            obj.push_str(&format!("v {} {} {}\n", pick(0), pick(1), pick(2)));
        }
        for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            let corners: Vec<String> = face.iter().map(|i| (vertices + i + 1).to_string()).collect();
            let corners: Vec<String> = if inward { corners.into_iter().rev().collect() } else { corners };
            obj.push_str(&format!("f {}\n", corners.join(" ")));
        }
        vertices += 8;
    };
    block("room", "wall", [-2.0, 0.0, -1.5], [2.0, 2.5, 1.5], true);
    block("table", "wood", [-0.9, 0.0, -1.2], [0.3, 0.7, -0.6], false);
    block("box", "red", [0.8, 0.0, -1.1], [1.3, 0.5, -0.6], false);
    block("lamp", "light", [-0.3, 2.3, -0.3], [0.3, 2.4, 0.3], false);
    fs::write(dir.join(format!("{name}.obj")), obj).unwrap();
    let light = if lamp == Lamp::On { "Ke 12 11 10" } else { "" };
    let mtl =
        format!("newmtl wall\nKd 0.7 0.7 0.7\nnewmtl wood\nKd 0.4 0.25 0.1\nnewmtl red\nKd 0.6 0.1 0.1\nnewmtl light\nKd 0 0 0\n{light}\n");
    fs::write(dir.join(format!("{name}.mtl")), mtl).unwrap();
    dir.join(format!("{name}.obj"))
}

/// Settings that make everything quick.
pub const QUICK: &str =
    "seed = 3\nframes = 3\n[render]\nsize = [48, 36]\nsamples = 4\nmax_bounces = 4\n[carve]\nrays = 8192\niterations = 2\n";

/// A camera in the test room (metres, z up).
pub const CAMERA: &str = "cameras = [{ position = [0.2, -0.9, 1.4], look_at = [0.0, 0.9, 0.6] }]\n";

/// A `[[scene]]` of the test room `name`.
pub fn scene(name: &str) -> String {
    format!("[[scene]]\nname = \"{name}\"\nfile = \"{name}.obj\"\n{CAMERA}")
}

/// Writes `dataset.toml` of [`QUICK`] settings and the given scenes.
pub fn write_config(dir: &Path, scenes: &[String]) {
    fs::write(dir.join("dataset.toml"), format!("name = \"set\"\n{QUICK}{}", scenes.concat())).unwrap();
}

/// The content of every file of a dataset that two runs must agree in.
pub fn contents(root: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![root.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            match (path.is_dir(), name.as_str()) {
                (_, ".enfilade" | "manifest_times.csv") => {}
                (true, _) => folders.push(path),
                (false, _) => drop(files.insert(path.strip_prefix(root).unwrap().to_path_buf(), fs::read(&path).unwrap())),
            }
        }
    }
    files
}

/// Fails with the names of files in which two datasets differ.
pub fn assert_same(a: &BTreeMap<PathBuf, Vec<u8>>, b: &BTreeMap<PathBuf, Vec<u8>>) {
    let names = |x: &BTreeMap<PathBuf, Vec<u8>>, y: &BTreeMap<PathBuf, Vec<u8>>| {
        x.iter().filter(|(name, bytes)| y.get(*name) != Some(bytes)).map(|(name, _)| name.clone()).collect::<Vec<_>>()
    };
    assert!(a == b, "files that differ:\n{:#?}\n{:#?}", names(a, b), names(b, a));
}
