//! `import`: a scene file, or a generated home, to a scene package, the labels that came with it, and the dataset's scene files.

use super::{Input, Inputs, Job, Outcome, Record};
use crate::assets;
use crate::config::{FileSource, Source};
use crate::error::Error;
use crate::report::{StageCx, count};
use crate::workdir::{Hash, write_json, write_whole};
use enfilade_home::HomeConfig;
use enfilade_import::{EnvironmentOverride, ImportOptions, ImportedLabel};
use enfilade_scene::{Cx, Labels, PartLabel, Scene, WorldMesh};
use std::path::{Path, PathBuf};

/// Labels that came with the scene, in the work folder.
pub(super) const LABELS: &str = "labels.json";

pub(super) fn settings(job: &Job) -> Hash {
    match &job.scene.source {
        Source::Home(config) if !config.assets.is_empty() => {
            Hash::of(&(&job.scene.source, assets::names(config, &|path| job.config.path(path))))
        }
        source => Hash::of(source),
    }
}

/// The files that the last import read or looked for in vain: which these are, only reading tells.
pub(super) fn inputs(job: &Job, previous: Option<&Record>) -> Inputs {
    let source = match &job.scene.source {
        Source::Home(config) => return asset_inputs(job, config).map(Some),
        Source::File(source) => source,
    };
    let Some(record) = previous else { return Ok(None) };
    // What the configuration names may by now be other files than were read, which still lie where they were.
    let was_read = |path: &Path| record.inputs.iter().any(|input| input.path == path);
    let named = [Some(&source.file), source.environment.as_ref().map(|environment| &environment.file)];
    if named.into_iter().flatten().any(|written| job.config.path(written).is_ok_and(|path| !was_read(&path))) {
        return Ok(None);
    }
    // One that cannot be read makes the import run, which then says so.
    Ok(record.inputs.iter().map(|input| Input::of_any(&input.path)).collect::<Result<_, _>>().ok())
}

/// The files of the libraries that a home takes models of, all of them: which ones it takes, only making it tells.
fn asset_inputs(job: &Job, config: &HomeConfig) -> Result<Vec<Input>, Error> {
    assets::files(config, &|path| job.config.path(path))?.iter().map(|path| Input::of(path)).collect()
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    let name = &job.scene.name;
    let (scene, labels, inputs, report) = match &job.scene.source {
        Source::Home(config) => {
            let home = assets::home(config, &|path| job.config.path(path), cx)?;
            let report = if home.credits.is_empty() { serde_json::Value::Null } else { serde_json::json!({ "credits": home.credits }) };
            (home.scene, Some(home.labels), assets::files(config, &|path| job.config.path(path))?, report)
        }
        Source::File(source) => {
            let imported = load_file(source, &job.config.path(&source.file)?, &|path| job.config.path(path), cx)?;
            let labels = imported.labels.map(|labels| labels_by_part(&imported.scene, &labels));
            let report = serde_json::to_value(&imported.report).unwrap_or_default();
            (imported.scene, labels, [imported.inputs, imported.missing].concat(), report)
        }
    };
    job.dataset.write_scene(name, &scene).map_err(Error::stage)?;
    let package = job.package()?;
    write_whole(&package, &enfilade_scene::to_bytes(&scene))?;
    let labels_file = job.work_file(LABELS)?;
    write_json(&labels_file, &labels)?;
    job.forget_scene();
    let layout = job.dataset.layout();
    let outputs = vec![package, labels_file, layout.metadata_scene(name), layout.metadata_nodes(name), layout.metadata_materials(name)];
    let inputs = inputs.iter().map(|path| Input::of_any(path)).collect::<Result<_, _>>()?;
    Ok(Outcome { summary: describe(&scene), outputs, inputs: Some(inputs), report })
}

/// Imports `file` with the choices of `source`; `locate` finds the other files that these name.
pub(crate) fn load_file(
    source: &FileSource,
    file: &Path,
    locate: &dyn Fn(&str) -> Result<PathBuf, Error>,
    cx: &dyn Cx,
) -> Result<enfilade_import::Imported, Error> {
    let environment = match &source.environment {
        Some(e) => Some(EnvironmentOverride { file: locate(&e.file)?, scale: e.scale, rotation_deg: e.rotation_deg }),
        None => None,
    };
    let options = ImportOptions {
        meters_per_unit: source.meters_per_unit,
        up_axis: source.up_axis,
        environment,
        allow_missing_textures: source.allow_missing_textures,
    };
    enfilade_import::load(file, &options, cx).map_err(Error::stage)
}

pub(crate) fn labels_by_part(scene: &Scene, labels: &[ImportedLabel]) -> Labels {
    let mut parts = vec![PartLabel::NONE; scene.parts.len()];
    for label in labels {
        parts[label.part as usize] = label.label;
    }
    Labels { parts }
}

/// One line about a scene.
pub(crate) fn describe(scene: &Scene) -> String {
    let triangles: usize = scene.parts.iter().map(|p| scene.meshes[p.mesh as usize].triangles.len()).sum();
    let extent = WorldMesh::new(scene).bounds.extent();
    format!(
        "{}, {}, {}, {}; {:.1} x {:.1} x {:.1} m",
        count(scene.parts.len(), "part"),
        count(triangles, "triangle"),
        count(scene.materials.len(), "material"),
        count(scene.images.len(), "image"),
        extent.x,
        extent.y,
        extent.z
    )
}
