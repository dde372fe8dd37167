//! Datasets of a small room.

use crate::common::{LAMP, TABLE, WALL, write_blocks};
use enfilade_pipeline::{Config, Overrides, Summary};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A folder with a room that contains a table and a lamp, a broken scene and files of poses; and the path for a dataset.
pub fn place() -> (TempDir, PathBuf) {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    write_blocks(folder, &[WALL, TABLE, LAMP]);
    fs::write(folder.join("broken.obj"), "f 1 2 3\n").unwrap();
    write_poses(folder, "one.json", 0.2);
    write_poses(folder, "two.json", 0.3);
    let out = folder.join("out");
    (place, out)
}

/// Two poses, the first of them at `x`.
pub fn write_poses(folder: &Path, file: &str, x: f64) {
    let poses = format!(
        "[{{\"frame\": 0, \"position\": [{x}, -0.9, 1.4], \"look_at\": [0.0, 0.9, 0.6]}}, \
         {{\"frame\": 1, \"position\": [0.2, -0.9, 1.4], \"look_at\": [-0.5, 0.9, 0.6]}}]"
    );
    fs::write(folder.join(file), poses).unwrap();
}

/// Scenes by name, file, files of poses and further keys.
pub fn config(folder: &Path, scenes: &[(&str, &str, &[&str], &str)]) -> Config {
    let mut text = "name = \"set\"\nseed = 3\nframes = 2\n[render]\nsize = [64, 48]\nsamples = 2\nmax_bounces = 2\n".to_string();
    text += "[carve]\nrays = 8192\niterations = 2\n[gate]\naction = \"report\"\n";
    for (name, file, poses, keys) in scenes {
        let from = "cameras = [{ position = [0.2, -0.9, 1.4], look_at = [0.0, 0.9, 0.6] }]";
        writeln!(text, "[[scene]]\nname = \"{name}\"\nfile = \"{file}\"\nup_axis = \"z\"\n{from}").unwrap();
        writeln!(text, "[scene.plan]\nmode = {{ kind = \"keyframes\", files = {poses:?} }}\n{keys}").unwrap();
    }
    fs::write(folder.join("dataset.toml"), text).unwrap();
    Config::read(&folder.join("dataset.toml"), &Overrides::default()).unwrap()
}

pub const ONE: &[&str] = &["one.json"];

/// The content of every file but the lock.
pub fn files(root: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let (mut found, mut folders) = (BTreeMap::new(), vec![root.to_path_buf()]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.file_name().unwrap() != "lock" {
                found.insert(path.strip_prefix(root).unwrap().to_path_buf(), fs::read(&path).unwrap());
            }
        }
    }
    found
}

pub fn failures(summary: &Summary) -> Vec<&str> {
    summary.scenes.iter().filter_map(|scene| scene.failure.as_ref()).map(|failure| failure.message.as_str()).collect()
}
