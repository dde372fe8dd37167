//! `[[object]]`: models that are placed in a scene when it is imported.

use super::{Input, Job};
use crate::config::models;
use crate::error::Error;
use crate::intake::{labelled, read_table};
use crate::report::StageCx;
use enfilade_compose::{ObjectGroup, compose};
use enfilade_dataset::{PlacedObjects, counted};
use enfilade_import::ImportOptions;
use enfilade_scene::{Cx, LabelledScene, Labels, PartLabel, PictureFiles, Scene, Warning};
use enfilade_suggest::Suggester;
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// Share of the classes suggested by names that should be right, where a scene has no labels.
const PRECISION: f32 = 0.9;

/// A scene with its objects.
pub(super) struct WithObjects {
    pub scene: LabelledScene,
    pub placed: PlacedObjects,
    /// The files that were read for it.
    pub inputs: Vec<Input>,
}

/// What the objects of a scene depend on, apart from the scene and the contents of files.
#[derive(Serialize)]
pub(super) struct Settings<'a> {
    groups: &'a [ObjectGroup],
    files: Vec<Vec<String>>,
    label_scene: Option<&'a str>,
    seed: u64,
}

pub(super) fn settings<'a>(job: &'a Job) -> Settings<'a> {
    // A pattern that means nothing any more is an error once the objects are placed.
    let files = job.scene.objects.iter().map(|group| files_of(job, group).unwrap_or_default()).collect();
    let label_scene = job.scene.labels.as_ref().map(|labels| labels.scene.as_str());
    Settings { groups: &job.scene.objects, files, label_scene, seed: seed(job) }
}

fn seed(job: &Job) -> u64 {
    job.scene.seed_for("objects")
}

/// The models that a group means, as they are written.
fn files_of(job: &Job, group: &ObjectGroup) -> Result<Vec<String>, Error> {
    let mut files = Vec::new();
    for pattern in &group.files.0 {
        let path = job.config.path(pattern)?;
        let found = models(pattern, &path.to_string_lossy(), &job.config.base);
        files.extend(found.map_err(|(message, help)| Error::scene(format!("[[object]]: {message}"), help))?);
    }
    Ok(files)
}

/// Places the objects of a scene. They stand on what the labels of the scene say: those of its table, else its own, else those that names
/// suggest.
pub(super) fn place(job: &Job, scene: Scene, labels: Option<Labels>, cx: &StageCx) -> Result<WithObjects, Error> {
    let none = Labels { parts: vec![PartLabel::NONE; scene.parts.len()] };
    let mut inputs = BTreeSet::new();
    let labels = match &job.scene.labels {
        Some(source) => {
            let table = job.config.path(&source.table)?;
            let (labels, _) = read_table(&table)?.assign(&source.scene, &scene);
            inputs.insert(table);
            labels
        }
        None => labels.unwrap_or(none),
    };
    let classes = classes(job, &scene, &labels, cx);
    let scene = LabelledScene { scene, labels, picture_files: PictureFiles::new() };
    let mut groups = Vec::new();
    for group in &job.scene.objects {
        groups.push((group.clone(), files_of(job, group)?));
    }
    let read = Mutex::new(inputs);
    let composed =
        compose(&scene, &classes, &groups, &|group, file| load(job, group, file, &read, cx), seed(job), cx).map_err(Error::stage)?;
    let read = read.into_inner().unwrap_or_else(PoisonError::into_inner);
    let inputs = read.iter().map(|path| Input::of_any(path)).collect::<Result<_, _>>()?;
    Ok(WithObjects { scene: composed.scene, placed: composed.placed, inputs })
}

/// Reads a model, and adds the files that it is made of to `read`.
fn load(job: &Job, group: &ObjectGroup, file: &str, read: &Mutex<BTreeSet<PathBuf>>, cx: &StageCx) -> Result<LabelledScene, String> {
    let path = job.config.path(file).map_err(|error| error.to_string())?;
    let mut inputs = vec![path.clone()];
    let options = ImportOptions { meters_per_unit: group.meters_per_unit, up_axis: group.up_axis, ..ImportOptions::default() };
    let imported = enfilade_import::load(&path, &options, cx).map_err(|error| error.to_string());
    if let Ok(imported) = &imported {
        inputs.extend(imported.inputs.iter().chain(&imported.missing).cloned());
    }
    read.lock().unwrap_or_else(PoisonError::into_inner).extend(inputs);
    imported.map(labelled)
}

/// The class of each part by its label; in a scene without any, by names that are clear.
fn classes(job: &Job, scene: &Scene, labels: &Labels, cx: &StageCx) -> Vec<i16> {
    if labels.parts.iter().any(|label| label.semantic >= 1) {
        return labels.parts.iter().map(|label| label.semantic).collect();
    }
    let suggester = Suggester::builtin();
    let sure = suggester.min_confidence(PRECISION).unwrap_or(1.0);
    let suggested = suggester.suggest_scene(scene).into_iter();
    let classes: Vec<i16> = suggested.map(|one| one.filter(|one| one.confidence >= sure).map_or(-1, |one| one.class)).collect();
    let known = classes.iter().filter(|class| **class >= 1).count();
    let message = format!(
        "scene {:?} has no labels; classes for `on` and `inside` are guessed from the names of {} of {}: give `labels` for better ones",
        job.scene.name,
        known,
        counted(classes.len(), "part")
    );
    cx.warn(Warning { place: "[[object]]".into(), message });
    classes
}

/// Gives placed objects the labels `own`, whatever a table says.
pub(super) fn keep_labels(job: &Job, scene: &Scene, own: &Labels, labels: &mut Labels) -> Result<(), Error> {
    let Some(placed) = job.dataset.read_placed_objects(&job.scene.name).map_err(Error::stage)? else { return Ok(()) };
    let names: BTreeSet<&str> = placed.objects.iter().map(|object| object.name.as_str()).collect();
    for ((part, label), own) in scene.parts.iter().zip(&mut labels.parts).zip(&own.parts) {
        if names.contains(part.name.split('/').next().unwrap_or_default()) {
            *label = *own;
        }
    }
    Ok(())
}

/// What is said of the objects of a scene.
pub(super) fn summary(placed: &PlacedObjects) -> String {
    let left_out = match placed.missing.len() {
        0 => String::new(),
        missing => format!(", {missing} left out"),
    };
    format!("; {} placed{left_out}", counted(placed.objects.len(), "object"))
}
