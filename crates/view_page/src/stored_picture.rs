//! Reading what was derived from a frame: arrays, pictures of cameras, scans of lidars.

use super::decoded_layer::DecodedLayer;
use super::derived_files::{READINGS, REFRACTED, ReadingKind, SURFACES};
use super::picture::FramePicture;
use super::place::{FramePlace, problem, stamp};
use super::summary::Summary;
use super::viewer::Viewer;
use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::{Array, DatasetError, Elements, FramePair, Scan};
use enfilade_serve::ApiProblem;
use image::DynamicImage;
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl Viewer {
    /// The file that a picture is read from.
    pub(super) fn source(&self, place: &FramePlace, picture: &FramePicture) -> PathBuf {
        let FramePlace { scene, camera, frame } = place;
        let (layout, of_frame) = (self.layout(), (scene.as_str(), camera.as_str(), *frame));
        match picture {
            FramePicture::Layer(layer) => self.dataset.layer_source(scene, camera, *frame, *layer),
            FramePicture::Fixture { fixture, part } => layout.fixture_layer(scene, camera, *frame, *fixture, *part),
            FramePicture::Mix { mix, layer } => layout.relit(mix, of_frame, &format!("{}.hdf5", layer.spec().name)),
            FramePicture::Surface { what, .. } => layout.surfaces(scene, camera, *frame, SURFACES[*what].name),
            FramePicture::Refracted { what } => layout.surfaces(scene, camera, *frame, REFRACTED[*what].name),
            FramePicture::Plane => layout.plane_ids(scene, camera, *frame),
            FramePicture::To { camera: other, frame: number, layer } => {
                let pair = FramePair { scene: scene.clone(), first: (camera.clone(), *frame), second: (other.clone(), *number) };
                layout.pair_layer(&pair, *layer)
            }
            FramePicture::Sensed { sensor, what } => layout.sensed(sensor, of_frame, READINGS[*what].file),
        }
    }

    /// A picture of a frame, from memory or from its file: a layer as [`Viewer::layer`] reads it, anything else as stored.
    ///
    /// # Errors
    /// As [`Viewer::layer`].
    pub(super) fn picture(&self, place: &FramePlace, picture: &FramePicture) -> Result<Arc<DecodedLayer>, ApiProblem> {
        if let FramePicture::Layer(layer) = picture {
            return self.layer(place, *layer);
        }
        let path = self.source(place, picture);
        self.allow(&path)?;
        self.layers.get(&(place.clone(), picture.clone()), stamp(&path), || {
            let spec = picture.spec(&[]);
            let (size, values) = match picture {
                FramePicture::Surface { nth, .. } => one_surface(&path, *nth, spec.channels)?,
                FramePicture::Sensed { what, .. } => reading(&path, READINGS[*what].kind, spec.channels)?,
                _ => stored_image(&path, spec.channels)?,
            };
            let [height, width] = size;
            Ok(DecodedLayer { shape: [height, width, spec.channels], summary: Summary::new(&spec, &values), values })
        })
    }
}

/// Height, width and values of an image of this number of channels.
///
/// # Errors
/// If the file is missing, damaged, or has other contents.
pub(super) fn stored_image(path: &Path, channels: usize) -> Result<([usize; 2], Elements), ApiProblem> {
    let array = read_array(path).map_err(problem)?;
    let size = image_size(path, &array, channels)?;
    Ok((size, array.values))
}

fn image_size(path: &Path, array: &Array, channels: usize) -> Result<[usize; 2], ApiProblem> {
    let wrong = |expected: String, found: String| {
        let error = format!("{}: expected {expected}, found {found}", path.display());
        Err(ApiProblem::failed(error, "delete the file and make it again"))
    };
    if matches!(array.values, Elements::F64(_) | Elements::I64(_)) {
        return wrong("image values".into(), array.values.element().name().into());
    }
    match (array.shape.as_slice(), channels) {
        (&[height, width] | &[height, width, 1], 1) if height.min(width) > 0 => Ok([height, width]),
        (&[height, width, found], _) if found == channels && height.min(width) > 0 => Ok([height, width]),
        (shape, _) => wrong(format!("an image of {channels} channels"), format!("an array of shape {shape:?}")),
    }
}

/// The values of one surface in a file of surfaces, counted from 1.
fn one_surface(path: &Path, nth: usize, channels: usize) -> Result<([usize; 2], Elements), ApiProblem> {
    let array = read_array(path).map_err(problem)?;
    let all = array.shape.get(2).copied().unwrap_or(0);
    let size = image_size(path, &array, all)?;
    if nth > all / channels {
        let error = format!("{}: there is no surface {nth}, only {}", path.display(), all / channels);
        return Err(ApiProblem::not_found(error, "choose a surface that the camera lists"));
    }
    let first = (nth - 1) * channels;
    Ok((size, channels_of(&array.values, all, first, channels)))
}

/// Values of some channels of an image that has `all`.
fn channels_of(values: &Elements, all: usize, first: usize, count: usize) -> Elements {
    fn some<T: Copy>(values: &[T], all: usize, first: usize, count: usize) -> Vec<T> {
        values.chunks_exact(all).flat_map(|pixel| &pixel[first..first + count]).copied().collect()
    }
    match values {
        Elements::F16(v) => Elements::F16(some(v, all, first, count)),
        Elements::F32(v) => Elements::F32(some(v, all, first, count)),
        Elements::F64(v) => Elements::F64(some(v, all, first, count)),
        Elements::I16(v) => Elements::I16(some(v, all, first, count)),
        Elements::I64(v) => Elements::I64(some(v, all, first, count)),
        Elements::U8(v) => Elements::U8(some(v, all, first, count)),
    }
}

/// A reading of a sensor.
fn reading(path: &Path, kind: ReadingKind, channels: usize) -> Result<([usize; 2], Elements), ApiProblem> {
    let scan = || Scan::from_npz(path, &bytes_of(path)?).map_err(problem).and_then(|scan| seen(path, scan.shape, scan));
    match kind {
        ReadingKind::Layer(_) => stored_image(path, channels),
        ReadingKind::Display => decoded(path, |image| Elements::U8(image.to_rgb8().into_raw())),
        ReadingKind::Raw => decoded(path, |image| Elements::F32(image.to_luma16().into_raw().into_iter().map(f32::from).collect())),
        ReadingKind::BeamDistances => scan().map(|scan| (scan.shape, Elements::F32(scan.distances_m))),
        ReadingKind::BeamIntensities => scan().map(|scan| (scan.shape, Elements::F32(scan.intensities))),
        ReadingKind::BeamParts => scan().map(|scan| (scan.shape, Elements::I16(scan.parts))),
    }
}

/// A picture file's pixels.
fn decoded(path: &Path, pixels: impl Fn(DynamicImage) -> Elements) -> Result<([usize; 2], Elements), ApiProblem> {
    let damaged = |e: image::ImageError| ApiProblem::failed(format!("{}: {e}", path.display()), "run enfilade make OUT sensors again");
    let image = image::load_from_memory(&bytes_of(path)?).map_err(damaged)?;
    let size = [image.height() as usize, image.width() as usize];
    seen(path, size, (size, pixels(image)))
}

/// The picture that was read, unless it has no pixels.
fn seen<T>(path: &Path, [height, width]: [usize; 2], read: T) -> Result<T, ApiProblem> {
    if height.min(width) > 0 {
        return Ok(read);
    }
    Err(ApiProblem::failed(format!("{}: there are no pixels in it", path.display()), "run enfilade make OUT sensors again"))
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, ApiProblem> {
    std::fs::read(path).map_err(|source| problem(DatasetError::Io { action: "read", path: path.to_path_buf(), source }))
}
