//! The objects that plans look at: those that `[[object]]` placed, and those that the mode names.

use super::{Job, imported};
use crate::error::Error;
use crate::workdir::read_json;
use enfilade_explore::{Mode, TargetObject};
use enfilade_scene::{Labels, PartId, Scene};

/// NYU40's classes that are no things: walls, floors, doors, windows, blinds, curtains, ceilings.
const SURROUNDINGS: [i16; 7] = [1, 2, 8, 9, 13, 16, 22];

/// Most names that an error lists.
const NAMED: usize = 30;

/// The objects to look at, or the things of photos; none for other modes.
pub(super) fn targets(job: &Job, mode: &Mode, scene: &Scene) -> Result<Vec<TargetObject>, Error> {
    let mode = match mode {
        Mode::Objects(mode) => mode,
        Mode::Photos(_) => return Ok(things(read_json(&job.work_file(imported::LABELS)?).flatten().as_ref())),
        _ => return Ok(Vec::new()),
    };
    let placed =
        if job.scene.objects.is_empty() { None } else { job.dataset.read_placed_objects(&job.scene.name).map_err(Error::stage)? };
    let mut wanted: Vec<(String, f64)> = Vec::new();
    for object in placed.iter().flat_map(|placed| &placed.objects).filter(|object| !object.is_distractor) {
        wanted.push((object.name.clone(), object.visible_share));
    }
    for name in &mode.look_at {
        if wanted.iter().all(|(known, _)| known != name) {
            wanted.push((name.clone(), mode.visible_share));
        }
    }
    let target = |(name, visible_share): (String, f64)| {
        let parts = parts_of(scene, &name);
        if parts.is_empty() { Err(unknown(scene, &name)) } else { Ok(TargetObject { name, parts, visible_share }) }
    };
    wanted.into_iter().map(target).collect()
}

/// All things by the labels that a scene came with, as one object; none without such labels.
fn things(labels: Option<&Labels>) -> Vec<TargetObject> {
    let is_thing = |semantic: i16| semantic >= 1 && !SURROUNDINGS.contains(&semantic);
    let parts: Vec<PartId> =
        labels.iter().flat_map(|labels| (0..).zip(&labels.parts)).filter(|(_, label)| is_thing(label.semantic)).map(|(id, _)| id).collect();
    if parts.is_empty() { Vec::new() } else { vec![TargetObject { name: "things".into(), parts, visible_share: 0.0 }] }
}

/// The parts with this name, or of the object with this name.
fn parts_of(scene: &Scene, name: &str) -> Vec<PartId> {
    let is_of = |part: &enfilade_scene::Part| {
        let mut objects = scene.objects_around(part).map(|object| scene.objects[object as usize].name.as_str());
        part.name == name || part.name.strip_prefix(name).is_some_and(|rest| rest.starts_with('/')) || objects.any(|object| object == name)
    };
    (0..).zip(&scene.parts).filter(|(_, part)| is_of(part)).map(|(id, _)| id).collect()
}

fn unknown(scene: &Scene, name: &str) -> Error {
    let mut names: Vec<&str> = scene.objects.iter().map(|object| object.name.as_str()).collect();
    names.extend(scene.parts.iter().filter(|part| part.object.is_none()).map(|part| part.name.as_str()));
    names.sort_unstable();
    names.dedup();
    let more = if names.len() > NAMED { ", …" } else { "" };
    names.truncate(NAMED);
    Error::scene(
        format!("the plan is to look at {name:?}, and the scene has no object or part of this name"),
        format!("name one of these in look_at: {}{more}; _detail/metadata_nodes.csv lists all parts", names.join(", ")),
    )
}
