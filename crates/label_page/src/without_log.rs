//! Labels in a folder without the log of the edits that made them, as where tables alone were copied.

use super::scene_error::SceneError;
use enfilade_dataset::{DatasetError, MeshFiles, mesh_names};
use enfilade_label::LabelTable;
use enfilade_scene::{Cx, PartLabel, Warning};
use std::collections::HashMap;
use std::path::Path;

/// The labels that tables in `folder` give these parts; `None` where it has a log with edits, which says more, or no tables.
///
/// # Errors
/// When the tables are damaged, about another scene, or about pieces of parts, which only the log could make again.
pub fn read(folder: &Path, parts: &[String], cx: &dyn Cx) -> Result<Option<Vec<PartLabel>>, SceneError> {
    let files = MeshFiles::new(folder);
    if files.annotated_scene()?.is_some() {
        return Ok(None);
    }
    let (labels, table) = match files.read_labels() {
        Ok(labels) => (of_objects(&files, folder, labels.parts, parts)?, mesh_names::OBJECTS_SEMANTIC),
        Err(error) if error.is_not_found() => match std::fs::read(files.file(LIST)) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            bytes => {
                let bytes = bytes.map_err(|source| DatasetError::Io { action: "read", path: files.file(LIST), source })?;
                (of_list(folder, &bytes, parts, cx)?, LIST)
            }
        },
        Err(error) => return Err(error.into()),
    };
    let labelled = labels.iter().filter(|label| **label != PartLabel::NONE).count();
    let message =
        format!("the labels of {labelled} of {} parts come from {table}: there is no log of the edits that made them", parts.len());
    cx.warn(Warning { place: folder.display().to_string(), message });
    Ok(Some(labels))
}

/// The table of labels by the names of parts.
pub const LIST: &str = "labels.csv";

fn wrong(folder: &Path, problem: String) -> SceneError {
    SceneError::Labels { folder: folder.to_path_buf(), problem }
}

/// Labels of objects as labels of parts of the same names.
fn of_objects(files: &MeshFiles, folder: &Path, labels: Vec<PartLabel>, parts: &[String]) -> Result<Vec<PartLabel>, SceneError> {
    let pieces = files.read_pieces()?.len();
    if pieces > 0 {
        return Err(wrong(
            folder,
            format!("its tables have pieces of parts that were cut ({pieces}), which only the log of the edits can make again"),
        ));
    }
    let names = match files.read_object_names() {
        Ok(names) => names,
        Err(error) if error.is_not_found() => parts.to_vec(),
        Err(error) => return Err(error.into()),
    };
    if labels.len() != names.len() || labels.len() != parts.len() {
        return Err(wrong(
            folder,
            format!("its tables label {} objects of {}, but the scene has {} parts", labels.len(), names.len(), parts.len()),
        ));
    }
    match names.iter().zip(parts).find(|(name, part)| name.trim() != part.trim()) {
        Some((name, part)) => Err(wrong(folder, format!("its tables are about another scene: found {name:?}, expected {part:?}"))),
        None => Ok(labels),
    }
}

/// Labels of parts by a table of names.
fn of_list(folder: &Path, bytes: &[u8], parts: &[String], cx: &dyn Cx) -> Result<Vec<PartLabel>, SceneError> {
    let table = LabelTable::parse(bytes, &folder.join(LIST).display().to_string())?;
    let named: HashMap<&str, PartLabel> = table
        .rows()
        .iter()
        .map(|row| (row.name.trim(), PartLabel { semantic: row.semantic, instance: row.instance.unwrap_or(PartLabel::NONE.instance) }))
        .collect();
    let labels: Vec<PartLabel> = parts.iter().map(|part| named.get(part.trim()).copied().unwrap_or(PartLabel::NONE)).collect();
    let known = parts.iter().filter(|part| named.contains_key(part.trim())).count();
    if known < named.len() {
        let problem = format!("{LIST} names {} parts, of which the scene has {known}", named.len());
        return Err(wrong(folder, problem));
    }
    if !table.ignored().is_empty() {
        let message = format!(
            "{LIST} has other columns too ({}), which are lost when the table is written with the first edit; keep a copy of it",
            table.ignored().join(", ")
        );
        cx.warn(Warning { place: folder.display().to_string(), message });
    }
    Ok(labels)
}
