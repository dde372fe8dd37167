//! Rooms of scenes that came without them, fitted to labelled surfaces, and which of their planes each pixel shows: a part for the scene, and
//! one for each frame.

use super::record::{Asked, Part};
use super::sources::Subject;
use crate::error::Error;
use crate::request::Request;
use crate::workdir::Hash;
use enfilade_dataset::{counted, counted_as, remove_if_there, write_bytes};
use enfilade_label::rooms::{fit_rooms, labelled_triangles, write_planes};
use enfilade_scene::{Cx, Rooms};
use enfilade_show::planview::rooms_svg;
use std::path::PathBuf;

/// Name of the part that is of the scene.
const SCENE: &str = "scene";

pub(super) fn parts(subject: &Subject, request: &Request) -> Result<Vec<Part>, Error> {
    let Request::Rooms { of } = request else { return Ok(Vec::new()) };
    let settings = Hash::of(&built(subject)?);
    let frames = subject.chosen(|camera, frame| of.has(camera, frame))?;
    let of_scene = Part { name: SCENE.into(), frames: Vec::new(), settings: settings.clone() };
    let of_frames = frames.into_iter().map(|frame| Part::of_frame(frame, settings.clone()));
    Ok(std::iter::once(of_scene).chain(of_frames).collect())
}

/// The rooms that the scene came with, which the import has written.
fn built(subject: &Subject) -> Result<Option<Rooms>, Error> {
    let rooms = subject.dataset.read_rooms(subject.scene).map_err(Error::stage)?;
    Ok(rooms.filter(|rooms| rooms.fit.is_none()))
}

pub(super) fn make(subject: &Subject, asked: &[Asked], cx: &dyn Cx) -> Result<Vec<String>, Error> {
    let (dataset, scene) = (subject.dataset, subject.scene);
    let rooms = if asked.iter().any(|asked| asked.part.name == SCENE) {
        rooms_of(subject)?
    } else {
        dataset.read_rooms(scene).map_err(Error::stage)?
    };
    let frames: Vec<&(String, u32)> = asked.iter().flat_map(|asked| &asked.part.frames).collect();
    let Some(rooms) = rooms else {
        // Planes of rooms that are gone are no planes.
        for (camera, number) in &frames {
            remove_if_there(&dataset.layout().plane_ids(scene, camera, *number))?;
        }
        return Ok(vec![format!("{scene}: no labelled walls and floors that enclose a room")]);
    };
    dataset.write_plane_table(scene, &rooms.planes()).map_err(Error::stage)?;
    for of_camera in frames.chunk_by(|a, b| a.0 == b.0) {
        let numbers: Vec<u32> = of_camera.iter().map(|(_, number)| *number).collect();
        write_planes(dataset, [scene, &of_camera[0].0], &rooms, &numbers, cx).map_err(Error::stage)?;
    }
    Ok(vec![format!("{scene}: {}, planes of {}", summary(&rooms), counted(frames.len(), "frame"))])
}

/// The rooms that the scene came with, or else those that are fitted to its current labels.
fn rooms_of(subject: &Subject) -> Result<Option<Rooms>, Error> {
    if let Some(built) = built(subject)? {
        return Ok(Some(built));
    }
    let (dataset, scene, layout) = (subject.dataset, subject.scene, subject.dataset.layout());
    let fitted = fitted(subject)?;
    match &fitted {
        Some(rooms) => {
            dataset.write_rooms(scene, rooms).map_err(Error::stage)?;
            write_bytes(&layout.rooms_drawing(scene), rooms_svg(rooms))?;
        }
        None => {
            let old = [layout.plane_table(scene), layout.rooms(scene), layout.rooms_drawing(scene)];
            old.iter().try_for_each(|path| remove_if_there(path))?;
        }
    }
    Ok(fitted)
}

fn fitted(subject: &Subject) -> Result<Option<Rooms>, Error> {
    let (dataset, scene) = (subject.dataset, subject.scene);
    if dataset.mesh_files(scene).read_classes().map_err(Error::stage)?.is_some_and(|classes| !classes.are_nyu40()) {
        return Ok(None);
    }
    let triangles = match labelled_triangles(dataset, scene) {
        Err(error) if error.is_not_found() => return Ok(None),
        triangles => triangles.map_err(Error::stage)?,
    };
    Ok(fit_rooms(&triangles))
}

pub(super) fn files(subject: &Subject, part: &Part) -> Result<Vec<PathBuf>, Error> {
    let (layout, scene) = (subject.dataset.layout(), subject.scene);
    let paths = match part.frames.first() {
        None => vec![layout.plane_table(scene), layout.rooms(scene), layout.rooms_drawing(scene)],
        Some((camera, frame)) => vec![layout.plane_ids(scene, camera, *frame)],
    };
    Ok(paths.into_iter().filter(|path| path.is_file()).collect())
}

/// Refuses scenes none of which has rooms.
pub(super) fn refuse_none(subjects: &[Subject]) -> Result<(), Error> {
    let has_rooms = |subject: &Subject| subject.dataset.layout().plane_table(subject.scene).is_file();
    let Some(first) = subjects.first().filter(|_| !subjects.iter().any(has_rooms)) else { return Ok(()) };
    Err(Error::scene(
        format!("no scene of {} that was chosen has rooms", first.dataset.root().display()),
        "label walls, floors and ceilings by NYU40's classes: `enfilade suggest` proposes a table, `enfilade annotate` opens a scene",
    ))
}

fn summary(rooms: &Rooms) -> String {
    let Rooms { outlines, walls, openings, fit, .. } = rooms;
    let counts = format!(
        "{}, {}, {}",
        counted(outlines.len(), "room"),
        counted(walls.len(), "wall face"),
        counted_as(openings.len(), "door or window", "doors and windows")
    );
    match fit {
        None => format!("{counts} as it was built"),
        Some(fit) => format!(
            "{counts}, fitted: {:.0} % of walls, floors and ceilings within 2 cm, 95 % within {:.0} cm",
            100.0 * fit.near_share,
            100.0 * fit.p95_m
        ),
    }
}
