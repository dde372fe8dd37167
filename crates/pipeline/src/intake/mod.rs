//! Processing of a scene file between its importer and the stages: an inspection of its geometry, and the repairs that the user requested.
//!
//! An importer returns the contents of the file. Here doubled faces are removed, lamps are hung and glass becomes clear, and remarks are
//! made about these and about everything else that the inspection finds; they join the importer's warnings in the report.

mod doubled;
mod enclosed;
mod held;
mod labels;
mod lamps;
mod panes;
mod remarks;
mod seen;
mod suspect;

pub(crate) use held::Held;
pub(crate) use labels::{labelled, labels_by_part, read_table};
pub(crate) use remarks::has_light;
pub(crate) use seen::Look;

use crate::config::{FileSource, Lamps};
use crate::error::Error;
use enfilade_import::Imported;
use enfilade_scene::{Cx, Warning};
use std::path::{Path, PathBuf};

/// [`load_file`] and [`settle`] without anything between: the findings of the inspection are reported before the importer's warnings.
pub(crate) fn read(
    source: &FileSource,
    file: &Path,
    locate: &dyn Fn(&str) -> Result<PathBuf, Error>,
    cx: &dyn Cx,
) -> Result<Imported, Error> {
    let held = Held::over(cx);
    let mut imported = load_file(source, file, locate, &held)?;
    settle(source, &mut imported, cx);
    Ok(imported)
}

/// Imports `file` with the choices of `source`, as the file is; `locate` finds the other files that these name.
pub(crate) fn load_file(
    source: &FileSource,
    file: &Path,
    locate: &dyn Fn(&str) -> Result<PathBuf, Error>,
    cx: &dyn Cx,
) -> Result<Imported, Error> {
    let mut options = source.importer();
    if let Some(written) = options.environment.as_mut().and_then(|e| e.file_mut()) {
        *written = locate(&written.to_string_lossy())?;
    }
    let mut imported = enfilade_import::load(file, &options, cx).map_err(Error::stage)?;
    if source.still {
        imported.scene.hold_still();
    }
    Ok(imported)
}

/// Makes the repairs that `source` requests, and reports the findings of the inspection to `cx` and in the import's report.
pub(crate) fn settle(source: &FileSource, imported: &mut Imported, cx: &dyn Cx) -> Look {
    let look = Look::at(&imported.scene);
    let mut remarks = remarks::of_geometry(source, imported, &look);
    remarks.extend(doubled::drop_faces(source, imported, &look));
    if source.lamps == Some(Lamps::Ceiling) {
        remarks.push(lamps::hang(&mut imported.scene, imported.labels.as_mut(), &look));
    }
    remarks.extend(panes::glaze(source, &mut imported.scene));
    remarks.extend(panes::lost(&imported.scene));
    remarks.extend(remarks::of_light(&imported.scene));
    remarks.extend(enclosed::lamps(&imported.scene, &look));
    remarks.extend(remarks::of_labels(imported));
    for message in remarks {
        let warning = Warning { place: source.file.clone(), message };
        cx.warn(warning.clone());
        imported.report.warnings.push(warning);
    }
    imported.report.recount(&imported.scene);
    look
}
