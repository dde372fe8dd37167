//! Covisibility of the frames of a scene, and the list of pairs that are chosen by it, `pairs.csv` of the dataset.

use super::make::{Made, MakeOptions, update};
use super::product::Product;
use super::record::{Part, Place};
use super::request::Request;
use super::sources::Subject;
use super::table::Asked;
use crate::error::Error;
use crate::workdir::Hash;
use enfilade_dataset::{Dataset, HiddenBy, PairRow, counted, write_pairs};
use enfilade_multiview::{CovisibilityConfig, Filmed, PairFilter, ScenePackage, choose_pairs, covisibility};
use enfilade_scene::Cx;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Which pairs of frames are chosen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PairsRequest {
    /// Pixels of each frame that are carried into the others, about.
    pub pixels: u32,
    /// Shares that each frame sees of the other, at least and at most; without them any at all.
    pub overlap: Option<[f32; 2]>,
    /// Least distance between the cameras, metres.
    pub min_baseline_m: f64,
    /// Largest distance between the cameras, metres.
    pub max_baseline_m: Option<f64>,
    /// Angles between the viewing axes, at least and at most, degrees.
    pub angle_deg: [f64; 2],
    /// Names of scenes; `None`: all.
    pub scenes: Option<Vec<String>>,
    /// Names of cameras; `None`: all.
    pub cameras: Option<Vec<String>>,
}

impl Default for PairsRequest {
    fn default() -> Self {
        let pixels = CovisibilityConfig::default().grid_pixels;
        Self { pixels, overlap: None, min_baseline_m: 0.0, max_baseline_m: None, angle_deg: [0.0, 180.0], scenes: None, cameras: None }
    }
}

impl PairsRequest {
    fn filter(&self) -> PairFilter {
        PairFilter {
            overlap: self.overlap.unwrap_or(PairFilter::default().overlap),
            baseline_m: [self.min_baseline_m, self.max_baseline_m.unwrap_or(f64::INFINITY)],
            angle_deg: self.angle_deg,
        }
    }

    /// What is asked of each scene.
    pub(crate) fn covisibility(&self) -> Request {
        Request::Covisibility { pixels: self.pixels, cameras: self.cameras.clone() }
    }

    /// The scenes of the dataset that it is about.
    fn scenes_of(&self, dataset: &Dataset) -> Result<Vec<String>, Error> {
        let mut scenes = dataset.scenes().map_err(Error::stage)?;
        scenes.retain(|scene| self.scenes.as_ref().is_none_or(|names| names.contains(scene)));
        Ok(scenes)
    }
}

/// The one part of a scene's covisibility: all frames of the cameras.
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

/// The one part of the list.
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
fn listed(dataset: &Dataset, request: &PairsRequest, cx: &dyn Cx) -> Result<(Vec<PairRow>, Vec<String>), Error> {
    let (mut rows, mut lines) = (Vec::new(), Vec::new());
    for scene in request.scenes_of(dataset)? {
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

/// Makes the covisibility of the scenes, and then the list.
pub(super) fn make_listed(
    dataset: &Dataset,
    scenes: &[String],
    asked: &[Request],
    options: MakeOptions,
    cx: &dyn Cx,
) -> Result<Vec<Made>, Error> {
    let mut all = Vec::new();
    for request in asked {
        let Request::Pairs(pairs) = request else { continue };
        if !make_covisible(dataset, scenes, pairs, options, cx)? {
            continue;
        }
        let updated = update(dataset, Place::Dataset, Product::Pairs, std::slice::from_ref(request), options, cx)?;
        all.push(Made { product: Product::Pairs, scene: None, made: updated.made, kept: updated.kept, lines: updated.lines });
    }
    Ok(all)
}

/// Makes the covisibility that a request needs of scenes; false where none of them has a frame that is chosen.
fn make_covisible(dataset: &Dataset, scenes: &[String], request: &PairsRequest, options: MakeOptions, cx: &dyn Cx) -> Result<bool, Error> {
    let mut any = false;
    for scene in scenes {
        let updated = update(dataset, Place::Scene(scene), Product::Covisibility, &[request.covisibility()], options, cx)?;
        any |= updated.made + updated.kept > 0;
    }
    Ok(any)
}

/// The pairs that `request` chooses, with a line about each scene; their covisibility is made where it is not there. The dataset's own list
/// stays as it is.
///
/// # Errors
/// When no scene has frames that are chosen, or a file cannot be read or written.
pub fn choose_pairs_of(dataset: &Dataset, request: &PairsRequest, cx: &dyn Cx) -> Result<(Vec<PairRow>, Vec<String>), Error> {
    let _lock = super::make::locked(dataset)?;
    if !make_covisible(dataset, &request.scenes_of(dataset)?, request, MakeOptions::default(), cx)? {
        return Err(super::make::nothing_to_make(dataset, Product::Pairs));
    }
    listed(dataset, request, cx)
}
