//! Tracks of points through the frames of a camera: a part for each camera.

use super::flow::package;
use super::record::{Asked, Part};
use super::sources::Subject;
use crate::error::Error;
use crate::request::Request;
use crate::workdir::Hash;
use enfilade_dataset::counted;
use enfilade_multiview::{Filmed, TracksConfig, tracks as follow};
use enfilade_scene::Cx;
use std::path::PathBuf;

pub(super) fn parts(subject: &Subject, request: &Request) -> Result<Vec<Part>, Error> {
    let Request::Tracks { points, seed, of } = request else { return Ok(Vec::new()) };
    let frames = subject.chosen(|camera, frame| of.has(camera, frame))?;
    let part = |frames: &[(String, u32)]| Part { name: frames[0].0.clone(), frames: frames.to_vec(), settings: Hash::of(&(points, seed)) };
    Ok(frames.chunk_by(|a, b| a.0 == b.0).map(part).collect())
}

pub(super) fn make(subject: &Subject, asked: &[Asked], cx: &dyn Cx) -> Result<Vec<String>, Error> {
    let filmed = Filmed::read(subject.dataset, subject.scene, None, cx).map_err(Error::stage)?;
    let package = package(subject, &filmed, cx)?;
    let mut lines = Vec::new();
    for Asked { part, request } in asked {
        let Request::Tracks { points, seed, .. } = request else { continue };
        let frames: Vec<usize> = part.frames.iter().filter_map(|(camera, number)| filmed.find(camera, *number)).collect();
        let config = TracksConfig { points: *points, seed: *seed };
        let found = follow(&filmed, &package, &frames, config, cx).map_err(Error::stage)?;
        subject.dataset.write_tracks(subject.scene, &part.name, &found).map_err(Error::stage)?;
        let (points, frames) = (counted(found.positions.len(), "point"), counted(found.frames.len(), "frame"));
        lines.push(format!("{}/{}: {points} through {frames}", subject.scene, part.name));
    }
    Ok(lines)
}

pub(super) fn files(subject: &Subject, part: &Part) -> Result<Vec<PathBuf>, Error> {
    Ok(vec![subject.dataset.layout().tracks(subject.scene, &part.name)])
}
