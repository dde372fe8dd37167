//! Tables beside a scene, in the toolkit's form.

use crate::VrayError;
use crate::edit::{Entity, node_strings};
use enfilade_dataset::write_bytes;
use enfilade_vrscene::Document;
use std::path::Path;

/// Name that means no object.
const NULL_OBJECT: &str = "_NULL_OBJECT";

/// The names of `metadata_objects.csv`, in order.
pub fn objects(path: &Path) -> Result<Vec<String>, VrayError> {
    let wrong = |problem: String| VrayError::usage(format!("{}: {problem}", path.display()), "give the mesh's metadata_objects.csv");
    let mut reader = csv::Reader::from_path(path).map_err(|e| wrong(e.to_string()))?;
    let header = reader.headers().map_err(|e| wrong(e.to_string()))?;
    let column = header.iter().position(|name| name == "object_name").ok_or_else(|| wrong("it has no column object_name".into()))?;
    let name = |row: Result<csv::StringRecord, csv::Error>| row.map(|row| row[column].to_string()).map_err(|e| wrong(e.to_string()));
    reader.records().map(name).collect()
}

/// `metadata_nodes.csv`: nodes and their objects.
pub fn write_nodes(path: &Path, entities: &[Entity], objects: &[String]) -> Result<(), VrayError> {
    let rows = entities.iter().filter(|entity| !entity.light).map(|entity| {
        let object = entity.object.map_or("-1".into(), |row| row.to_string());
        let name = entity.object.map_or(NULL_OBJECT, |row| &objects[row]);
        [entity.id.to_string(), entity.name.clone(), object, name.to_string()]
    });
    write(path, ["node_id", "node_name", "object_id", "object_name"], rows)
}

/// `metadata_node_strings.csv`: the strings that every node leads to.
pub fn write_strings(path: &Path, scene: &Document) -> Result<(), VrayError> {
    let rows = scene
        .of_kind("Node")
        .enumerate()
        .flat_map(|(i, node)| node_strings(scene, node).into_iter().map(move |found| [(i + 1).to_string(), found.path, found.string]));
    write(path, ["node_id", "path", "string"], rows)
}

fn write<const N: usize>(path: &Path, header: [&str; N], rows: impl Iterator<Item = [String; N]>) -> Result<(), VrayError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let in_memory = "writing to memory cannot fail";
    writer.write_record(header).expect(in_memory);
    rows.for_each(|row| writer.write_record(row).expect(in_memory));
    Ok(write_bytes(path, writer.into_inner().expect(in_memory))?)
}
