//! `import`: a scene file, or a generated home, to a scene package, the labels that came with it, and the dataset's scene files.

use super::{Input, Inputs, Job, Outcome, Record, imported, objects, variation};
use crate::assets;
use crate::config::{FileSource, Source};
use crate::error::Error;
use crate::intake::{self, labels_by_part};
use crate::report::StageCx;
use crate::workdir::Hash;
use enfilade_compose::with_motion;
use enfilade_dataset::remove_if_there;
use enfilade_home::HomeConfig;
use enfilade_import::{EnvironmentOverride, scene_in_folder};
use enfilade_scene::{FIRST_PACKAGE, PACKAGE_HEAD_BYTES, is_current_package};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

pub(super) fn settings(job: &Job) -> Hash {
    if let Some(varies) = &job.scene.varies {
        return variation::settings(job, varies);
    }
    let source = source_settings(job);
    let still = if job.scene.objects.is_empty() { source } else { Hash::of(&(source, objects::settings(job))) };
    if job.scene.motions.is_empty() { still } else { Hash::of(&(still, "motion", &job.scene.motions)) }
}

fn source_settings(job: &Job) -> Hash {
    match &job.scene.source {
        Source::Home(config) if !config.assets.is_empty() => {
            Hash::of(&(&job.scene.source, assets::names(config, &|path| job.config.path(path))))
        }
        source => Hash::of(source),
    }
}

/// The files that the last import read or looked for in vain: they are known only after reading.
pub(super) fn inputs(job: &Job, previous: Option<&Record>) -> Inputs {
    if let Some(first) = job.first()? {
        return variation::inputs(&first);
    }
    let source = match &job.scene.source {
        Source::Home(config) if job.scene.objects.is_empty() => return asset_inputs(job, config).map(Some),
        Source::Home(_) => None,
        Source::File(source) => Some(source),
    };
    let Some(record) = previous else { return Ok(None) };
    // If the configuration names other files now, the files read before do not matter, although they may still exist.
    let was_read = |path: &Path| record.inputs.iter().any(|input| input.path == in_folder(path));
    if source.into_iter().flat_map(named).any(|written| job.config.path(&written).is_ok_and(|path| !was_read(&path))) {
        return Ok(None);
    }
    // A file that cannot be read makes the stage run, and its error has the reason.
    Ok(record.inputs.iter().map(|input| Input::of_any(&input.path)).collect::<Result<_, _>>().ok())
}

/// Whether the scene package is one that this version of the program reads.
pub(super) fn package_is_current(job: &Job) -> bool {
    let mut head = Vec::new();
    let file = job.package().ok().and_then(|path| File::open(path).ok());
    file.is_some_and(|file| file.take(PACKAGE_HEAD_BYTES).read_to_end(&mut head).is_ok() && is_current_package(&head))
}

/// The file that is imported of a path: of a folder the scene of a collection in it.
fn in_folder(path: &Path) -> PathBuf {
    let within = if path.is_dir() { scene_in_folder(path).ok().flatten() } else { None };
    within.unwrap_or_else(|| path.to_path_buf())
}

/// All files of the libraries that a home may take models from: the ones it takes are known only after making it.
fn asset_inputs(job: &Job, config: &HomeConfig) -> Result<Vec<Input>, Error> {
    assets::files(config, &|path| job.config.path(path))?.iter().map(|path| Input::of(path)).collect()
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    if let (Some(varies), Some(first)) = (&job.scene.varies, job.first()?) {
        return variation::run(job, varies, &first, cx);
    }
    remove_if_there(&job.dataset.layout().variation(&job.scene.name))?;
    remove_if_there(&job.work_file(FIRST_PACKAGE)?)?;
    let (mut scene, mut labels, rooms, mut inputs, report, offset_m) = match &job.scene.source {
        Source::Home(config) => {
            let home = assets::home(config, &|path| job.config.path(path), cx)?;
            let mut report = if home.credits.is_empty() { serde_json::Value::Null } else { serde_json::json!({ "credits": home.credits }) };
            if !home.notes.is_empty() {
                report["plan"] = serde_json::json!(home.notes);
            }
            if !home.state_notes.is_empty() {
                report["states"] = serde_json::json!(home.state_notes);
            }
            // Its files were known before, and hashed.
            let rooms = home.rooms();
            (home.scene, Some(home.labels), Some(rooms), None, report, None)
        }
        Source::File(source) => {
            let watch = Watch::start(job, source);
            let imported = intake::read(source, &job.config.path(&source.file)?, &|path| job.config.path(path), cx)?;
            let labels = imported.labels.map(|labels| labels_by_part(&imported.scene, &labels));
            let report = serde_json::to_value(&imported.report).unwrap_or_default();
            let inputs = watch.inputs(&[imported.inputs, imported.missing].concat())?;
            (imported.scene, labels, None, Some(inputs), report, imported.report.offset_m)
        }
    };
    let mut placed = None;
    if !job.scene.objects.is_empty() {
        let composed = objects::place(job, scene, labels, cx)?;
        let of_source = match (inputs, &job.scene.source) {
            (None, Source::Home(config)) => asset_inputs(job, config)?,
            (inputs, _) => inputs.unwrap_or_default(),
        };
        inputs = Some([of_source, composed.inputs].concat());
        (scene, labels, placed) = (composed.scene.scene, Some(composed.scene.labels), Some(composed.placed));
    }
    if !job.scene.motions.is_empty() {
        scene = with_motion(&scene, &job.scene.motions).map_err(|error| Error::scene(error.to_string(), "docs/motion.md has the keys"))?;
    }
    let package = enfilade_scene::to_bytes(&scene);
    let outputs = imported::write(job, (&scene, &package), labels.as_ref(), (rooms.as_ref(), placed.as_ref()), offset_m)?;
    let summary = imported::describe(&scene) + &placed.as_ref().map_or_else(String::new, objects::summary);
    Ok(Outcome { summary, outputs, inputs, report })
}

/// The files that the configuration names, as written.
fn named(source: &FileSource) -> impl Iterator<Item = String> {
    let picture = source.environment.as_ref().and_then(EnvironmentOverride::file).map(|file| file.to_string_lossy().into_owned());
    let states = source.states.as_ref().map(|file| file.to_string_lossy().into_owned());
    [Some(source.file.clone()), picture, states].into_iter().flatten()
}

/// Finds files that somebody saves while the scene is read from them: whether the old or the new content was read is unknown.
struct Watch {
    start: SystemTime,
    /// The files that the configuration names, in their state before the import.
    named: Vec<Input>,
}

impl Watch {
    fn start(job: &Job, source: &FileSource) -> Self {
        let files = named(source).filter_map(|written| job.config.path(&written).ok()).filter(|path| path.is_file());
        // A file that cannot be read here makes the import fail with the reason.
        let named = files.filter_map(|path| Input::of(&path).ok()).collect();
        Self { start: SystemTime::now(), named }
    }

    /// The files at `paths` in the state in which they were read. A file that was saved meanwhile gets a hash that no content has, so that
    /// the next run imports again; named ones, which were hashed before, differ from then on anyway.
    fn inputs(&self, paths: &[PathBuf]) -> Result<Vec<Input>, Error> {
        let meanwhile = self.start..=SystemTime::now();
        let is_saved = |path: &Path| path.metadata().and_then(|data| data.modified()).is_ok_and(|time| meanwhile.contains(&time));
        let input = |path: &PathBuf| match self.named.iter().find(|input| input.path == *path) {
            Some(named) => Ok(named.clone()),
            None if is_saved(path) => Ok(Input { path: path.clone(), content: Hash(String::new()) }),
            None => Input::of_any(path),
        };
        paths.iter().map(input).collect()
    }
}
