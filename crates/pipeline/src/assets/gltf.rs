//! glTF files as models: metres, y up, the front toward +z unless `assets.toml` says otherwise.

use super::table::Table;
use enfilade_home::assets::{Body, Model};
use enfilade_import::ImportOptions;
use enfilade_scene::Quiet;
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The models of these files, given by name and path, in their order; the error of a broken one names the file and what to do.
pub(super) fn models(files: &[(String, PathBuf)], table: &Table) -> Vec<Result<Model, String>> {
    let wanted = |name: &str| table.of(name).wanted;
    files.par_iter().filter(|(name, _)| wanted(name)).map(|(name, path)| model(name, path, table)).collect()
}

fn model(name: &str, path: &Path, table: &Table) -> Result<Model, String> {
    let choice = table.of(name);
    let imported = enfilade_import::load(path, &ImportOptions::default(), &Quiet).map_err(|error| error.to_string())?;
    let body = Body::new(imported.scene, choice.front.turn(), choice.size).map_err(|problem| format!("{}: {problem}", path.display()))?;
    let stem = Path::new(name).file_stem().map_or(name.into(), |stem| stem.to_string_lossy());
    let families = choice.families_or(&stem);
    let shines = body.parts.iter().any(|part| body.shines(part));
    let size = body.size();
    let body = Arc::new(body);
    let mut model = Model::new(stem.to_string(), size, families, Box::new(move || Ok(Arc::clone(&body))));
    model.file = name.into();
    model.licence = choice.licence.or(choice.licence_of_all).unwrap_or_else(|| "licence not stated".into());
    (model.shines, model.weight) = (shines, choice.weight);
    Ok(model)
}
