//! `import` of a single file, without a dataset.

use crate::config::FileSource;
use crate::error::Error;
use crate::stages::{describe, load_file};
use crate::workdir::{write_json, write_whole};
use enfilade_scene::{Cx, Warning};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// What importing a file made.
#[derive(Clone, Debug)]
pub struct Imported {
    /// One line about the scene.
    pub summary: String,
    /// The report beside the package.
    pub report: PathBuf,
    /// Everything that was dropped, guessed or mended.
    pub warnings: Vec<Warning>,
}

#[derive(Serialize)]
struct Report<'a> {
    scene: &'a str,
    import: &'a enfilade_import::ImportReport,
}

/// Imports the file of `source` (a path as it stands) to the scene package `package` and a report `<package>.report.json`.
///
/// # Errors
/// When the file cannot be imported or the package cannot be written.
pub fn import_file(source: &FileSource, package: &Path, cx: &dyn Cx) -> Result<Imported, Error> {
    let imported = load_file(source, Path::new(&source.file), &|path| Ok(path.into()), cx)?;
    let summary = describe(&imported.scene);
    let report = package.with_extension("report.json");
    write_whole(package, &enfilade_scene::to_bytes(&imported.scene))?;
    write_json(&report, &Report { scene: &summary, import: &imported.report })?;
    Ok(Imported { summary, report, warnings: imported.report.warnings })
}
