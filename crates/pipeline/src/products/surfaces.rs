//! Surfaces along the rays of a frame: a part for each frame.

use super::flow::package;
use super::record::{Asked, Part};
use super::sources::Subject;
use crate::error::Error;
use crate::request::Request;
use crate::workdir::Hash;
use enfilade_dataset::counted;
use enfilade_multiview::{Filmed, write_surfaces};
use enfilade_scene::Cx;
use std::collections::BTreeMap;
use std::path::PathBuf;

pub(super) fn parts(subject: &Subject, request: &Request) -> Result<Vec<Part>, Error> {
    let Request::Surfaces { layers, of } = request else { return Ok(Vec::new()) };
    let frames = subject.chosen(|camera, frame| of.has(camera, frame))?;
    Ok(frames.into_iter().map(|frame| Part::of_frame(frame, Hash::of(layers))).collect())
}

pub(super) fn make(subject: &Subject, asked: &[Asked], cx: &dyn Cx) -> Result<Vec<String>, Error> {
    let filmed = Filmed::read(subject.dataset, subject.scene, None, cx).map_err(Error::stage)?;
    let package = package(subject, &filmed, cx)?;
    let mut frames: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for Asked { part, request } in asked {
        let Request::Surfaces { layers, .. } = request else { continue };
        let found = part.frames.iter().filter_map(|(camera, number)| filmed.find(camera, *number));
        frames.entry(*layers).or_default().extend(found);
    }
    let mut lines = Vec::new();
    for (layers, frames) in &frames {
        write_surfaces(&filmed, &package, frames, *layers, cx).map_err(Error::stage)?;
        lines.push(format!("{}: {} with up to {layers} surfaces per pixel", subject.scene, counted(frames.len(), "frame")));
    }
    Ok(lines)
}

pub(super) fn files(subject: &Subject, part: &Part) -> Result<Vec<PathBuf>, Error> {
    let (camera, frame) = &part.frames[0];
    Ok(subject.files_of_frame(&subject.dataset.layout().surfaces_dir(subject.scene, camera), *frame))
}
