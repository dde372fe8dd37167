//! glTF files as models: metres, y up, the front toward +z unless `assets.toml` states another.

use super::table::Table;
use enfilade_furniture::models::{Body, Model};
use enfilade_import::ImportOptions;
use enfilade_math::{DMat3, Vec3};
use enfilade_scene::Quiet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The models of these files, given by name and path, in their order; the error of a broken one names the file and what to do.
pub(super) fn models(files: &[(String, PathBuf)], table: &Table) -> Vec<Result<Model, String>> {
    enfilade_parallel::map(files, |(name, path)| model(name, path, table))
}

/// A model. Only its size, and whether it emits light, is kept until the model is used: a whole library would not fit into memory.
fn model(name: &str, path: &Path, table: &Table) -> Result<Model, String> {
    let choice = table.of(name);
    let stem = Path::new(name).file_stem().map_or(name.into(), |stem| stem.to_string_lossy());
    let families = choice.families_or(&stem);
    let (turn, stretched) = (choice.front.turn(), choice.size);
    // The size of a model that fits no family is not needed.
    let (size, shines) = if families.is_empty() {
        (stretched.unwrap_or_default(), false)
    } else {
        let body = read(path, turn, stretched)?;
        (body.size(), body.parts.iter().any(|part| body.shines(part)))
    };
    let file = path.to_path_buf();
    let mut model = Model::new(stem.to_string(), size, families, Box::new(move || read(&file, turn, stretched).map(Arc::new)));
    model.file = name.into();
    model.licence = choice.licence.or(choice.licence_of_all).unwrap_or_else(|| "licence not stated".into());
    (model.shines, model.weight) = (shines, choice.weight);
    Ok(model)
}

fn read(path: &Path, turn: DMat3, size: Option<Vec3>) -> Result<Body, String> {
    let imported = enfilade_import::load(path, &ImportOptions::default(), &Quiet).map_err(|error| error.to_string())?;
    Body::new(imported.scene, turn, size).map_err(|problem| format!("{}: {problem}", path.display()))
}
