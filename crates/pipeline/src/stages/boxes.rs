//! `boxes`: bounding boxes of every instance, and what each frame shows of it. Nothing is rendered again.

use super::made::{self, Furniture};
use super::{Input, Inputs, Job, Outcome, Record, Stage};
use crate::error::Error;
use crate::report::StageCx;
use crate::workdir::Hash;
use enfilade_dataset::{BoxKind, counted, mesh_names};
use enfilade_label::boxes::write_boxes;
use enfilade_label::instances::write_instances;
use std::collections::BTreeMap;

pub(super) fn settings(_job: &Job) -> Hash {
    Hash::of(&())
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    let mut inputs = vec![job.input_from(Stage::Import, &job.package()?)?];
    let files = job.dataset.mesh_files(&job.scene.name);
    for table in [mesh_names::OBJECTS_SEMANTIC, mesh_names::OBJECTS_INSTANCE] {
        inputs.push(job.input_from(Stage::Label, &files.file(table))?);
    }
    let tables = [mesh_names::OBJECT_PIECES, mesh_names::FACES_OBJECTS].map(|table| files.file(table));
    if tables[0].is_file() {
        inputs.extend(tables.iter().map(|path| Input::of(path)).collect::<Result<Vec<_>, _>>()?);
    }
    inputs.extend(job.rendered_records()?);
    inputs.extend(job.label_records()?);
    Ok(Some(inputs))
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    let name = &job.scene.name;
    let scene = made::scene_of_pieces(job)?;
    let labels = job.dataset.read_label_tables(name).map_err(Error::stage)?;
    let (mut outputs, boxed) = write_boxes(job.dataset, name, &scene, &labels).map_err(Error::stage)?;
    let (mut frames, mut seen) = (0, Vec::new());
    for (_, trajectory) in job.filmed()?.iter() {
        let rendered = job.frames_of(trajectory)?;
        let views = |&frame: &u32| Ok(made::views(job, &trajectory.name, frame)?.map(|views| (frame, views)));
        let made: BTreeMap<_, _> = rendered.iter().filter_map(|frame| views(frame).transpose()).collect::<Result<_, Error>>()?;
        frames += rendered.len();
        seen.push((trajectory.name.clone(), rendered, made));
    }
    // Building solids takes long, and other machines may have noted what every frame shows.
    let needed = seen.iter().any(|(_, rendered, made)| made.len() < rendered.len());
    let furniture = Furniture::known(job, scene, labels, needed)?;
    for (camera, rendered, made) in &seen {
        let moments = furniture.moments(job, camera)?;
        let solids = |frame: u32| furniture.solids(&moments, frame);
        outputs.extend(write_instances(job.dataset, [name, camera], rendered, made, &solids, cx).map_err(Error::stage)?);
    }
    let summary = format!("{} of 3 kinds, seen in {}", counted(boxed, "instance"), counted(frames, "frame"));
    Ok(Outcome { summary, outputs, ..Outcome::default() })
}

/// The tables of boxes and of instances by frame, as inputs of what comes later.
pub(super) fn tables(job: &Job) -> Result<Vec<Input>, Error> {
    let name = &job.scene.name;
    let mut files: Vec<_> = BoxKind::ALL.iter().flat_map(|&kind| job.dataset.box_files(name, kind)).collect();
    files.extend(job.filmed()?.iter().map(|(_, trajectory)| job.dataset.layout().frame_instances(name, &trajectory.name)));
    files.iter().map(|path| job.input_from(Stage::Boxes, path)).collect()
}
