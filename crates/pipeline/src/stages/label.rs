//! `label`: what every part is, as people annotated it, from a table or from the scene itself, joined to the entity ids of finished frames.

use super::{Input, Inputs, Job, Outcome, Record, Stage, imported, objects};
use crate::error::Error;
use crate::intake::read_table;
use crate::report::StageCx;
use crate::workdir::{Hash, read_json};
use enfilade_dataset::{
    ANNOTATION_LOG, BodyPlaces, CLASS_LIST, Classes, DatasetError, LabelColors, MeshFiles, counted, mesh_names, quoted,
};
use enfilade_frame::{Frame, Layer, Pass, Values, vector};
use enfilade_label::annotation::{Annotation, AnnotationError};
use enfilade_label::{LabelReport, Pieces, doubts, join};
use enfilade_scene::{Cx, Labels, PartLabel, Quiet, Scene, Warning};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The tables of labels and objects; the table of pieces exists only if people cut parts.
const TABLES: [&str; 5] =
    [mesh_names::OBJECTS_SEMANTIC, mesh_names::OBJECTS_INSTANCE, mesh_names::OBJECTS, mesh_names::FACES_OBJECTS, mesh_names::OBJECT_PIECES];
/// Names listed in a warning; the report has all.
const NAMES_SHOWN: usize = 5;

pub(super) fn settings(job: &Job) -> Hash {
    Hash::of(&job.scene.labels.as_ref().map(|l| &l.scene))
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    let mut inputs = vec![job.input_from(Stage::Import, &job.package()?)?, Input::of(&job.work_file(imported::LABELS)?)?];
    if let Some(labels) = &job.scene.labels {
        inputs.push(Input::of(&job.config.path(&labels.table)?)?);
    }
    let files = job.dataset.mesh_files(&job.scene.name);
    if files.annotated_scene().map_err(Error::stage)?.is_some() {
        inputs.extend([Input::of(&files.file(ANNOTATION_LOG))?, Input::of_any(&files.file(CLASS_LIST))?]);
    }
    inputs.extend(job.rendered_records()?);
    Ok(Some(inputs))
}

/// Whether every frame has its labels.
pub(super) fn frames_are_whole(job: &Job) -> bool {
    job.layers_are_whole(Pass::Label)
}

/// The labels from `enfilade annotate`, if there are any: they take precedence over everything else.
fn annotation(job: &Job) -> Result<Option<Annotation>, Error> {
    let files = job.dataset.mesh_files(&job.scene.name);
    match Annotation::read(&files, &*job.load_scene()?) {
        Err(error @ AnnotationError::OtherScene { .. }) => Err(other_scene(job, &files, &error)),
        read => read.map_err(Error::stage),
    }
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    let (known, report) = known(job, cx)?;
    let hash = known.hash().0;
    let frames = job.frames()?;
    let is_stale = |(camera, frame): &(String, u32)| job.force || !job.dataset.labels_are_complete(&job.scene.name, camera, *frame, &hash);
    let stale: BTreeSet<&(String, u32)> = frames.iter().filter(|frame| is_stale(frame)).collect();
    for (done, of) in frames.iter().enumerate() {
        if stale.contains(of) {
            label_frame(job, &of.0, of.1, &known, &hash)?;
        }
        cx.progress("frames", done as u64 + 1, frames.len() as u64);
    }
    let labels = &known.labels;
    let labelled = labels.parts.iter().filter(|l| l.semantic >= 1).count();
    let parts = counted(labels.parts.len(), "part");
    let mut summary = format!("{labelled} of {parts} have a class, in {}", counted(frames.len(), "frame"));
    if known.is_annotated {
        summary.push_str(", as annotated");
    } else if labelled == 0 && job.scene.labels.is_none() {
        summary.push_str("; the scene comes without labels and no table is given");
    }
    Ok(Outcome { summary, outputs: outputs(job), report, ..Outcome::default() })
}

/// The labels of a scene, with the report on their sources; the tables of labels and objects are written.
pub(super) fn known(job: &Job, cx: &StageCx) -> Result<(Known, serde_json::Value), Error> {
    let (files, scene) = (job.dataset.mesh_files(&job.scene.name), job.load_scene()?);
    let annotation = annotation(job)?;
    let is_annotated = annotation.is_some();
    let (annotation, classes, report) = match annotation {
        Some(annotation) => {
            warn_of_unused_table(job, &files, cx);
            (annotation, files.read_own_classes().map_err(Error::stage)?.unwrap_or_else(Classes::nyu40), serde_json::Value::Null)
        }
        None => {
            let (labels, report) = labels_of(job, cx)?;
            (Annotation::of_whole_parts(&scene, labels), Classes::nyu40(), report)
        }
    };
    write_tables(&files, &scene, &annotation, &classes).map_err(Error::stage)?;
    let split = Pieces::read(&files, &scene).map_err(Error::stage)?;
    refuse_cut_deforming(split.as_ref(), &scene)?;
    Ok((Known { labels: annotation.labels, split, is_annotated }, report))
}

/// Refuses pieces of parts that deform: which piece a point is on is only known at rest.
fn refuse_cut_deforming(split: Option<&Pieces>, scene: &Scene) -> Result<(), Error> {
    let deforming = scene.deforming_parts();
    let cut = split.and_then(|split| split.pieces_of_faces().map(|(part, _)| part).find(|&part| deforming[part as usize]));
    let Some(part) = cut else { return Ok(()) };
    let message = format!("part {:?} was cut into pieces, but its shape changes over time", scene.parts[part as usize].name);
    Err(Error::scene(message, "undo the cut in `enfilade annotate`, or import the scene with still = true".to_string()))
}

/// Writes the tables of labels and their colours, and of objects: parts, and the pieces of those that people split.
fn write_tables(files: &MeshFiles, scene: &Scene, annotation: &Annotation, classes: &Classes) -> Result<(), DatasetError> {
    let parts: Vec<String> = scene.parts.iter().map(|part| part.name.clone()).collect();
    files.write_objects(&parts, &annotation.pieces, &annotation.piece_of_face)?;
    let colors = LabelColors { semantic: classes.color_rows(), instances: annotation.instances };
    files.write_labels(&annotation.labels, &colors).map(drop)
}

/// The labels of every part, or of every piece if parts were split.
pub(super) struct Known {
    labels: Labels,
    split: Option<Pieces>,
    is_annotated: bool,
}

impl Known {
    /// Hash by which frames record the labels that they were made with.
    pub fn hash(&self) -> Hash {
        match &self.split {
            None => Hash::of(&self.labels),
            Some(split) => Hash::of(&(&self.labels, split.pieces_of_faces().collect::<Vec<_>>())),
        }
    }
}

/// Says that a scene's label table is not used.
fn warn_of_unused_table(job: &Job, files: &MeshFiles, cx: &StageCx) {
    let Some(source) = &job.scene.labels else { return };
    let message = format!("not used, because the scene was annotated; to use it again, move {} away", files.file(ANNOTATION_LOG).display());
    cx.warn(Warning { place: source.table.clone(), message });
}

/// The error of an annotation of other parts, and what to do about it.
fn other_scene(job: &Job, files: &MeshFiles, error: &AnnotationError) -> Error {
    let mut hint = "import the scene as it was annotated, or move the log away to label again".to_string();
    let (table, out, name) = (files.file("labels.csv"), quoted(job.out().display()), quoted(&job.scene.name));
    if table.is_file() {
        let command = format!("enfilade label {out} --scene {name} --table {}", quoted(table.display()));
        hint = format!("{hint}; with the log away, this keeps labels by the names of parts: {command}");
    }
    Error::scene(error.to_string(), hint)
}

/// The labels of the parts of a scene before or after its label stage, and whether people split parts.
///
/// # Errors
/// When the annotation or the table cannot be read.
pub(super) fn known_labels(job: &Job) -> Result<(Labels, bool), Error> {
    match annotation(job)? {
        Some(annotation) => Ok((annotation.labels, !annotation.pieces.is_empty())),
        // What is wrong with the table, the label stage of this scene tells.
        None => labels_of(job, &Quiet).map(|(labels, _)| (labels, false)),
    }
}

/// From the table if there is one, else what came with the scene, else none.
fn labels_of(job: &Job, cx: &dyn Cx) -> Result<(Labels, serde_json::Value), Error> {
    let scene = job.load_scene()?;
    let Some(source) = &job.scene.labels else {
        let none = || Labels { parts: vec![PartLabel::NONE; scene.parts.len()] };
        let labels = read_json::<Option<Labels>>(&job.work_file(imported::LABELS)?).flatten().unwrap_or_else(none);
        return Ok((labels, serde_json::Value::Null));
    };
    let (mut labels, report) = assign_table(&job.config.path(&source.table)?, &source.scene, &scene, cx)?;
    if let Some(own) = read_json::<Option<Labels>>(&job.work_file(imported::LABELS)?).flatten() {
        objects::keep_labels(job, &scene, &own, &mut labels)?;
    }
    Ok((labels, serde_json::to_value(&report).unwrap_or_default()))
}

/// Labels from the rows of the table at `path` that are about the scene called `name` there; `cx` hears what does not match.
///
/// # Errors
/// When the table cannot be read.
pub(crate) fn assign_table(path: &Path, name: &str, scene: &Scene, cx: &dyn Cx) -> Result<(Labels, LabelReport), Error> {
    let (labels, report) = read_table(path)?.assign(name, scene);
    warn_about(&report, &path.display().to_string(), name, cx);
    for message in doubts(scene, &labels).remarks(scene) {
        cx.warn(Warning { place: path.display().to_string(), message });
    }
    Ok((labels, report))
}

fn warn_about(report: &LabelReport, table: &str, scene: &str, cx: &dyn Cx) {
    let warn = |place: String, message| cx.warn(Warning { place, message });
    if report.labelled_parts == 0 {
        warn(table.into(), format!("no row labels any part of scene {scene:?}; if the table names it otherwise, set label_scene"));
    } else if !report.unlabelled.is_empty() {
        let names: Vec<String> = report.unlabelled.iter().map(|u| format!("{:?} ({})", u.part, u.material)).take(NAMES_SHOWN).collect();
        warn(table.into(), format!("{} parts have no class, among them {}", report.unlabelled.len(), names.join(", ")));
    }
    for row in report.unmatched.iter().take(NAMES_SHOWN) {
        warn(format!("{table}:{}", row.line), format!("nothing in scene {scene:?} is named {:?}", row.name));
    }
}

/// Joins labels to one frame.
pub(super) fn label_frame(job: &Job, camera: &str, frame: u32, known: &Known, hash: &str) -> Result<(), Error> {
    let name = &job.scene.name;
    let wanted: &[Layer] = if known.split.is_some() { &[Layer::RenderEntityId, Layer::Position] } else { &[Layer::RenderEntityId] };
    let rendered = job.dataset.read_frame(name, camera, frame, wanted).map_err(Error::stage)?;
    let Some(Values::I16(ids)) = rendered.get(Layer::RenderEntityId) else {
        let message = format!("frame {frame} of {camera} has no entity ids");
        return Err(Error::scene(message, format!("render it again: enfilade run {} --only render --force", quoted(job.out().display()))));
    };
    let joined = match (&known.split, rendered.get(Layer::Position)) {
        (Some(split), Some(positions)) => {
            let bodies = job.dataset.read_filmed_bodies(name, camera).map_err(Error::stage)?;
            let rest = bodies.map(|bodies| at_rest((ids, rendered.width), positions, bodies.at(frame)));
            split.join(ids, rest.as_ref().unwrap_or(positions), &known.labels)
        }
        _ => join(ids, &known.labels),
    };
    let (semantic, instance) = joined.map_err(Error::stage)?;
    let mut layers = Frame::new(rendered.width, rendered.height);
    layers.insert(Layer::Semantic, Values::I16(semantic));
    layers.insert(Layer::SemanticInstance, Values::I16(instance));
    job.dataset.write_label_layers(name, camera, frame, &layers, hash).map_err(Error::stage).map(drop)
}

/// The places at rest of what the pixels of a frame show: people cut parts at rest.
fn at_rest((ids, width): (&[i16], u32), positions: &Values, places: BodyPlaces<'_>) -> Values {
    let point = |(pixel, &id): (usize, &i16)| {
        let (y, seen) = ((pixel / width as usize) as f64 + 0.5, vector(positions, pixel));
        // Parts that deform are not cut.
        places.in_row(y).at_rest(i64::from(id), seen).unwrap_or(seen).as_vec3().to_array()
    };
    Values::F32(ids.iter().enumerate().flat_map(point).collect())
}

/// The tables; records vouch for the layers of frames.
fn outputs(job: &Job) -> Vec<PathBuf> {
    let files = job.dataset.mesh_files(&job.scene.name);
    TABLES.map(|name| files.file(name)).into_iter().filter(|path| path.is_file()).collect()
}
