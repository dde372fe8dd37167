//! Makes the stored dataset of a version, which the versions after it must read: `crates/pipeline/tests/all/stored` has the tests.
//!
//! `store-dataset ROOM ARCHIVE` runs `ROOM/dataset.toml` and packs the room, the dataset `out`, and `stored.json` into the file
//! ARCHIVE, a `.tar.gz`. `stored.json` has the versions of the stages, and checksums of the values of all layers. Pictures and statistics
//! are left out: they are made from the rest, and would be most of it.
//!
//! ```text
//! cd crates/pipeline && cargo run -p enfilade-bench -- store-dataset tests/data/room tests/data/dataset-0.1.0.tar.gz
//! ```

#[path = "../../pipeline/tests/all/stored/values.rs"]
mod values;

use anyhow::{Context, Result, ensure};
use enfilade_dataset::Dataset;
use enfilade_pipeline::{Config, Overrides, STAGES, Silent, WORKDIR};
use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::json;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// Placeholder in the archive for the folder that it was made in; the tests replace it by their own folder.
const FOLDER: &str = "{FOLDER}";

/// Runs the instrument.
pub fn run() -> Result<()> {
    let words: Vec<PathBuf> = crate::arguments::arguments().map(PathBuf::from).collect();
    let [room, archive] = words.as_slice() else { anyhow::bail!("expected the folder of the room and the archive to write") };
    let folder = tempfile::tempdir()?;
    for path in files(room)? {
        fs::copy(&path, folder.path().join(path.strip_prefix(room)?))?;
    }
    let out = folder.path().join("out");
    let summary = enfilade_pipeline::run(&Config::read(&folder.path().join("dataset.toml"), &Overrides::default())?, &out, None, &Silent)?;
    ensure!(summary.ok(), "{:?}", summary.scenes[0].failure);
    let stages: BTreeMap<&str, u32> = STAGES.iter().map(|spec| (spec.name, spec.stage.version())).collect();
    let stored = json!({ "stages": stages, "values": values::checksums(&Dataset::open(&out)?) });
    fs::write(folder.path().join("stored.json"), serde_json::to_string_pretty(&stored)? + "\n")?;
    let bytes = pack(folder.path(), archive)?;
    println!("{}: {bytes} bytes", archive.display());
    Ok(())
}

/// Packs what is kept of the files of `folder`, without its own path.
fn pack(folder: &Path, archive: &Path) -> Result<u64> {
    let written = folder.to_str().context("the temporary folder's path is not UTF-8")?;
    let mut tar = tar::Builder::new(GzEncoder::new(File::create(archive)?, Compression::best()));
    for path in files(folder)? {
        let name = path.strip_prefix(folder)?.to_str().context("a name is not UTF-8")?.replace('\\', "/");
        if !is_kept(&name) {
            continue;
        }
        let mut bytes = fs::read(&path)?;
        if name.contains(WORKDIR) && name.ends_with(".json") {
            bytes = String::from_utf8(bytes)?.replace(written, FOLDER).into_bytes();
        }
        ensure!(!bytes.windows(written.len()).any(|part| part == written.as_bytes()), "{name} names the folder that it was made in");
        let mut header = tar::Header::new_gnu();
        header.set_size(bytes.len() as u64);
        header.set_mode(0o644);
        tar.append_data(&mut header, name, bytes.as_slice())?;
    }
    Ok(tar.into_inner()?.finish()?.metadata()?.len())
}

fn is_kept(name: &str) -> bool {
    let is_picture = [".jpg", ".png"].iter().any(|end| name.ends_with(end));
    !is_picture && !name.starts_with("out/statistics/") && !name.ends_with("/lock")
}

/// All files below a folder, sorted.
fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        match path.is_dir() {
            true => found.extend(files(&path)?),
            false => found.push(path),
        }
    }
    found.sort();
    Ok(found)
}
