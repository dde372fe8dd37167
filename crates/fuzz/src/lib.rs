//! Everything in the workspace that reads bytes from outside, as one table of fuzz targets.
//!
//! [`TARGETS`] is the list. A target reads bytes by the same functions that the program uses and looks at nothing but that they come
//! back: a panic, a hang and memory without bound are mistakes, an error is an answer. `cargo xtask fuzz` searches for such bytes with
//! libFuzzer; what it finds is mended and stays in `regressions/<target>/`, and an ordinary test reads all of these.
//!
//! To add an importer, write one line `importer(…)` in [`TARGETS`], and put a small file or two into `seeds/<target>/`.

mod seeds;
mod targets;

use std::path::{Path, PathBuf};

pub use targets::TARGETS;

/// The most memory that a target may have at a time, bytes: what a picture of the largest size that is read takes, and something over.
pub const MOST_MEMORY: usize = 3 << 29;

/// Reads an input.
pub type Run = Box<dyn FnMut(&[u8])>;

/// Something that reads bytes.
pub struct Target {
    /// What to call it; also the name of its folders.
    pub name: &'static str,
    /// What it reads.
    pub about: &'static str,
    /// The longest input that is tried, bytes: some times as long as a file in which everything is used.
    pub longest: usize,
    /// How it reads.
    pub reads: Reads,
    /// Makes files to begin with, beside those in `seeds/<name>/`.
    pub seeds: fn() -> Vec<Seed>,
    /// Words of the format that no seed has.
    pub words: &'static [&'static str],
}

/// How a target reads.
pub enum Reads {
    /// Imports the scene file `scene` of a folder in which `file` holds the bytes. Both may be the same.
    Scene {
        /// The file that is made of the bytes.
        file: &'static str,
        /// The file that is imported.
        scene: &'static str,
    },
    /// By a function of its own, which is told of a folder where it may write.
    Own(fn(&Path) -> Run),
}

/// A file to begin with.
pub struct Seed {
    /// What it is.
    pub name: String,
    /// What is in it.
    pub bytes: Vec<u8>,
}

impl Target {
    /// The target of that name.
    pub fn of(name: &str) -> Option<&'static Self> {
        TARGETS.iter().find(|target| target.name == name)
    }

    /// What reads inputs, with files in `folder`, which must be empty.
    ///
    /// # Panics
    /// When the folder cannot be written.
    pub fn prepare(&self, folder: &Path) -> Run {
        match self.reads {
            Reads::Scene { file, scene } => targets::scene_files::prepare(folder, file, scene),
            Reads::Own(prepare) => prepare(folder),
        }
    }

    /// All files to begin with: those that are made and those of `seeds/<name>/`.
    ///
    /// # Panics
    /// When a file cannot be read.
    pub fn all_seeds(&self) -> Vec<Seed> {
        let mut all = (self.seeds)();
        all.extend(files(&self.folder("seeds")));
        all
    }

    /// The inputs that were once found.
    ///
    /// # Panics
    /// When a file cannot be read.
    pub fn regressions(&self) -> Vec<Seed> {
        files(&self.folder("regressions"))
    }

    fn folder(&self, kind: &str) -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join(kind).join(self.name)
    }
}

/// The files of a folder by name; none where there is no folder.
fn files(folder: &Path) -> Vec<Seed> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("a folder that can be listed").path()).collect();
    paths.sort();
    let read = |path: PathBuf| Seed {
        name: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        bytes: std::fs::read(&path).expect("a file that can be read"),
    };
    paths.into_iter().map(read).collect()
}
