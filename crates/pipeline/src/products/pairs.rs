//! Covisibility of the frames of a scene, and the list of pairs that are chosen by it, `pairs.csv` of the dataset.

use super::record::{Asked, Part};
use super::sources::Subject;
use crate::error::Error;
use crate::request::{PairsRequest, Request};
use crate::workdir::Hash;
use enfilade_dataset::{Dataset, HiddenBy, PairRow, counted, write_pairs};
use enfilade_multiview::{CovisibilityConfig, Filmed, ScenePackage, choose_pairs, covisibility};
use enfilade_scene::Cx;
use std::path::PathBuf;

/// The single part of a scene's covisibility: all frames of the cameras.
pub(super) fn covisibility_parts(subject: &Subject, request: &Request) -> Result<Vec<Part>, Error> {
    let Request::Covisibility { pixels, cameras } = request else { return Ok(Vec::new()) };
    let frames = subject.chosen(|camera, _| cameras.as_ref().is_none_or(|names| names.iter().any(|name| name == camera)))?;
    let part = Part { name: String::new(), frames, settings: Hash::of(pixels) };
    Ok(if part.frames.is_empty() { Vec::new() } else { vec![part] })
}

pub(super) fn make_covisibility(subject: &Subject, asked: &[Asked], cx: &dyn Cx) -> Result<Vec<String>, Error> {
    for asked in asked {
        let Request::Covisibility { pixels, cameras } = asked.request else { continue };
        let filmed = Filmed::read(subject.dataset, subject.scene, cameras.as_deref(), cx).map_err(Error::stage)?;
        let package = ScenePackage::read(&filmed, cx).map_err(Error::stage)?;
        let config = CovisibilityConfig { grid_pixels: *pixels };
        let found = covisibility(&filmed, package.as_ref(), config, cx).map_err(Error::stage)?;
        subject.dataset.write_covisibility(subject.scene, &found).map_err(Error::stage)?;
    }
    Ok(Vec::new())
}

pub(super) fn covisibility_files(subject: &Subject, _part: &Part) -> Result<Vec<PathBuf>, Error> {
    let layout = subject.dataset.layout();
    Ok(vec![layout.covisibility(subject.scene), layout.covisibility_frames(subject.scene)])
}

/// The single part of the list.
pub(super) fn parts(_subject: &Subject, request: &Request) -> Result<Vec<Part>, Error> {
    Ok(vec![Part { name: String::new(), frames: Vec::new(), settings: Hash::of(request) }])
}

pub(super) fn make(subject: &Subject, asked: &[Asked], cx: &dyn Cx) -> Result<Vec<String>, Error> {
    let mut lines = Vec::new();
    for asked in asked {
        let Request::Pairs(request) = asked.request else { continue };
        let (rows, told) = listed(subject.dataset, request, cx)?;
        write_pairs(&subject.dataset.layout().pairs(), &rows).map_err(Error::stage)?;
        lines.extend(told);
    }
    Ok(lines)
}

pub(super) fn files(subject: &Subject, _part: &Part) -> Result<Vec<PathBuf>, Error> {
    Ok(vec![subject.dataset.layout().pairs()])
}

/// The pairs that a request chooses by the covisibility of its scenes, and a line about each of these.
pub(super) fn listed(dataset: &Dataset, request: &PairsRequest, cx: &dyn Cx) -> Result<(Vec<PairRow>, Vec<String>), Error> {
    let (mut rows, mut lines) = (Vec::new(), Vec::new());
    for scene in scenes_of(request, dataset)? {
        let filmed = Filmed::read(dataset, &scene, request.cameras.as_deref(), cx).map_err(Error::stage)?;
        if filmed.is_empty() {
            continue;
        }
        let found = dataset.read_covisibility(&scene).map_err(Error::stage)?;
        let n = filmed.len();
        if found.frames.len() != n {
            let message = format!("covisibility of {scene} has {} frames, but the scene has {n}", found.frames.len());
            return Err(Error::scene(message, "make it again: enfilade make OUT pairs --force"));
        }
        let chosen = choose_pairs(&filmed, &found, &request.filter());
        let hidden = match found.hidden_by {
            HiddenBy::Scene => "",
            HiddenBy::Distances => "; what is hidden was decided by the frames' distances only, since the scene package is missing",
        };
        lines.push(format!("{scene}: {}, {} of {} pairs{hidden}", counted(n, "frame"), chosen.len(), n * (n - 1) / 2));
        rows.extend(chosen);
    }
    Ok((rows, lines))
}

/// The scenes of the dataset that a request is about.
pub(super) fn scenes_of(request: &PairsRequest, dataset: &Dataset) -> Result<Vec<String>, Error> {
    let mut scenes = dataset.scenes().map_err(Error::stage)?;
    scenes.retain(|scene| request.scenes.as_ref().is_none_or(|names| names.contains(scene)));
    Ok(scenes)
}
