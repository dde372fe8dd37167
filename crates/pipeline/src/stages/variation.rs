//! Variations of a scene: made from its package and its labels, with its free space where nothing has moved, and with its trajectories.
//!
//! A variation is a scene of its own. Files of it that are the same as those of the first scene are second names of these (hard links), so
//! they take no room. Every stage has the first scene's files among its inputs, so that the variation follows when these change.

use super::planned::Made;
use super::{Input, Inputs, Job, Outcome, Record, Stage, imported, label};
use crate::config::{Source, Varies};
use crate::error::Error;
use crate::report::StageCx;
use crate::workdir::{Hash, read_json};
use enfilade_dataset::{ANNOTATION_LOG, CLASS_LIST, Variation, counted, share_file, take_file};
use enfilade_explore::PlanReport;
use enfilade_home::light_of;
use enfilade_scene::{Cx, FIRST_PACKAGE, LabelledScene, PackageError, PictureFiles, Rooms, Scene, Warning, to_bytes_beside};
use enfilade_vary::{First, HomeLight, vary};
use std::path::{Path, PathBuf};

/// What of the configuration a variation depends on; everything else is in the first scene's files.
pub(super) fn settings(job: &Job, varies: &Varies) -> Hash {
    Hash::of(&(varies, job.scene.seed))
}

/// The package of the first scene, and all that says what its parts are.
pub(super) fn inputs(first: &Job) -> Inputs {
    let files = first.dataset.mesh_files(&first.scene.name);
    let mut inputs = vec![
        first.input_from(Stage::Import, &first.package()?)?,
        first.input_from(Stage::Import, &first.work_file(imported::LABELS)?)?,
        Input::of_any(&first.dataset.layout().placed_objects(&first.scene.name))?,
        Input::of_any(&files.file(ANNOTATION_LOG))?,
        Input::of_any(&files.file(CLASS_LIST))?,
    ];
    if let Some(labels) = &first.scene.labels {
        inputs.push(Input::of(&first.config.path(&labels.table)?)?);
    }
    if let Source::Home(_) = first.scene.source {
        inputs.push(first.input_from(Stage::Import, &first.dataset.layout().rooms(&first.scene.name))?);
    }
    Ok(Some(inputs))
}

/// Makes a variation.
pub(super) fn run(job: &Job, varies: &Varies, first: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    let (name, layout) = (&job.scene.name, job.dataset.layout());
    let inputs = inputs(first)?;
    let scene = labelled(first, cx)?;
    let (home, rooms) = of_home(first)?;
    let placed = first.dataset.read_placed_objects(&first.scene.name).map_err(Error::stage)?;
    let fixed = placed.iter().flat_map(|placed| &placed.objects).map(|object| object.instance).collect();
    let known = First { name, scene: &scene, home, rooms: rooms.as_ref(), fixed };
    let mut record = Variation::new(&varies.of, varies.number, varies.sets);
    let varied = vary(&known, &varies.config, &job.scene.variation_seeds(varies), &mut record, cx)
        .map_err(|error| Error::scene(error.to_string(), "docs/vary.md says what varies, and by which labels"))?;
    let scene = varied.scene;
    let package = package(job, first, &scene.scene)?;
    let mut outputs = imported::write(job, (&scene.scene, &package), Some(&scene.labels), (varied.rooms.as_ref(), placed.as_ref()), None)?;
    // The units and the offset are the file's.
    take_file(&layout.metadata_scene(&first.scene.name), &layout.metadata_scene(name))?;
    job.dataset.write_variation(name, &record).map_err(Error::stage)?;
    outputs.extend([layout.variation(name), job.work_file(FIRST_PACKAGE)?]);
    let shared = share(job, first, &outputs)?;
    let summary = format!("{}, {}; {shared}", imported::describe(&scene.scene), described(&record));
    let report = serde_json::to_value(&record).unwrap_or_default();
    Ok(Outcome { summary, outputs, inputs, report })
}

/// The package of a variation, without what the package of the first scene has, which gets a second name beside it.
fn package(job: &Job, first: &Job, scene: &Scene) -> Result<Vec<u8>, Error> {
    let of_first = first.package()?;
    let bytes = std::fs::read(&of_first).map_err(Error::io("read", &of_first))?;
    take_file(&of_first, &job.work_file(FIRST_PACKAGE)?)?;
    let told = |error: PackageError| Error::scene(format!("{}: {error}", of_first.display()), first.again(Stage::Import));
    let loaded = first.load_scene()?;
    to_bytes_beside(scene, &loaded, &bytes).map_err(told)
}

/// The first scene with its labels: what people annotated, else the table's, else its own.
fn labelled(first: &Job, cx: &StageCx) -> Result<LabelledScene, Error> {
    let scene = first.load_scene()?;
    let (mut labels, has_pieces) = label::known_labels(first)?;
    if has_pieces {
        let message = "people have split parts of it; variations know those as wholes, by the class of what is left of them".into();
        cx.warn(Warning { place: first.scene.name.clone(), message });
    }
    labels.parts.truncate(scene.parts.len());
    Ok(LabelledScene { scene: scene.as_ref().clone(), labels, picture_files: PictureFiles::new() })
}

/// The light and the rooms of a home; those that were fitted to labels are not as exact as a variation needs.
fn of_home(first: &Job) -> Result<(Option<HomeLight>, Option<Rooms>), Error> {
    let Source::Home(config) = &first.scene.source else { return Ok((None, None)) };
    let rooms = first.dataset.read_rooms(&first.scene.name).map_err(Error::stage)?.ok_or_else(|| first.run_first(Stage::Import))?;
    let (light, outward) = light_of(config, &rooms);
    Ok((Some(HomeLight { light, outward }), Some(rooms)))
}

/// "evening, 4 of 7 lamps lit, 12 materials recoloured, 3 things moved"
fn described(record: &Variation) -> String {
    let mut words = Vec::new();
    words.extend(record.sky.as_ref().map(|sky| sky.moment.clone()));
    if !record.lamps.is_empty() {
        words.push(format!("{} of {} lit", record.lamps.iter().filter(|lamp| lamp.lit).count(), counted(record.lamps.len(), "lamp")));
    }
    let count = |number: usize, what: &str, done: &str| (number > 0).then(|| format!("{} {done}", counted(number, what)));
    words.extend(count(record.materials.len(), "material", "recoloured"));
    let textured = record.materials.iter().filter(|material| material.texture.is_some()).count();
    words.extend((textured > 0).then(|| format!("{textured} of them with another texture")));
    words.extend(count(record.moved.len(), "thing", "moved"));
    words.extend(count(record.removed.len(), "thing", "removed"));
    if words.is_empty() { "nothing differs".into() } else { words.join(", ") }
}

/// Makes files of a variation that are the same as the first scene's second names of these; returns a line about them.
pub(super) fn share(job: &Job, first: &Job, files: &[PathBuf]) -> Result<String, Error> {
    let (mut shared, mut bytes) = (0, 0);
    for path in files {
        let Some(from) = counterpart(job, first, path) else { continue };
        if share_file(&from, path)? {
            shared += 1;
            bytes += path.metadata().map_or(0, |data| data.len());
        }
    }
    let size = bytes as f64 / f64::from(1 << 20);
    Ok(format!("{shared} of {} ({size:.1} MiB) are those of {}", counted(files.len(), "file"), first.scene.name))
}

/// The file of the first scene that has the place of a variation's.
fn counterpart(job: &Job, first: &Job, path: &Path) -> Option<PathBuf> {
    if path.file_name().is_some_and(|name| name == FIRST_PACKAGE) {
        return first.package().ok();
    }
    let layout = job.dataset.layout();
    let folders = [
        (layout.scene_dir(&job.scene.name), layout.scene_dir(&first.scene.name)),
        (job.package().ok()?.parent()?.to_path_buf(), first.package().ok()?.parent()?.to_path_buf()),
    ];
    folders.iter().find_map(|(own, firsts)| Some(firsts.join(path.strip_prefix(own).ok()?)))
}

/// The first scene of a variation whose triangles are all where they are there; `None` for others.
pub(super) fn of_same_geometry<'a>(job: &Job<'a>) -> Result<Option<Job<'a>>, Error> {
    let Some(first) = job.first()? else { return Ok(None) };
    let record = job.dataset.read_variation(&job.scene.name).map_err(Error::stage)?.ok_or_else(|| job.run_first(Stage::Import))?;
    Ok(record.keeps_geometry.then_some(first))
}

/// The outcome of a stage whose files `outputs` are those of the first scene: its summary, and the time that is saved.
pub(super) fn taken_over(first: &Job, stage: Stage, outputs: Vec<PathBuf>) -> Result<Outcome, Error> {
    let record: Option<Record> = read_json(&first.work_file(&stage.record())?);
    let Some(Record { summary, report, wall_s, .. }) = record else { return Err(first.run_first(stage)) };
    let summary = format!("{summary}; taken from {}, where it took {wall_s:.1} s", first.scene.name);
    Ok(Outcome { summary, outputs, report, ..Outcome::default() })
}

/// The files of the first scene's trajectories.
pub(super) fn plan_inputs(first: &Job) -> Result<Vec<Input>, Error> {
    let record: Option<Record> = read_json(&first.work_file(&Stage::Plan.record())?);
    let record = record.ok_or_else(|| first.run_first(Stage::Plan))?;
    record.outputs.iter().map(|output| first.input_from(Stage::Plan, &first.out().join(&output.path))).collect()
}

/// The trajectories of the first scene. Those of a variation in which things have moved are the same: its gates leave out the views that
/// are not worth rendering any more.
pub(super) fn plan_of(first: &Job) -> Result<Made, Error> {
    let name = &first.scene.name;
    let filmed = first.filmed()?;
    let camera = filmed.first().map(|(camera, _)| camera.clone()).ok_or_else(|| first.run_first(Stage::Plan))?;
    let mut all = Vec::new();
    let mut reports = Vec::new();
    for (_, trajectory) in filmed.iter() {
        let stereo = first.dataset.read_stereo(name, &trajectory.name).map_err(Error::stage)?;
        let path = first.dataset.layout().plan_report(name, &trajectory.name);
        reports.extend(read_json::<PlanReport>(&path));
        all.push((trajectory.clone(), stereo));
    }
    let summary = taken_over(first, Stage::Plan, Vec::new())?.summary;
    Ok(Made { camera, filmed: all, reports, summary })
}

/// Offset of the exposure of displayed pictures, stops; 0 for scenes that are no variations.
pub(super) fn exposure_stops(job: &Job) -> f64 {
    let record = job.dataset.read_variation(&job.scene.name).ok().flatten();
    record.map_or(0.0, |record| record.exposure_stops)
}
