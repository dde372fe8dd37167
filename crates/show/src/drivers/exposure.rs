//! Exposure of a camera's frames.

use super::present::read_present;
use crate::display::Display;
use crate::exposure::{Brightness, Exposure, display_exposure};
use enfilade_dataset::{Dataset, DatasetError, ToneMapRow};
use enfilade_frame::Layer;
use enfilade_frame::tonemap::{GAMMA, PERCENTILE, ToneMap};
use std::path::PathBuf;

/// Largest number of pixels that the exposure of a trajectory is measured from: enough for an error of a thousandth.
const SAMPLES: usize = 4_000_000;

/// The exposures of a camera's frames, in their order; without frames, what shows radiance 1 as white.
#[derive(Clone, Debug, Default)]
pub struct Exposures {
    /// Hypersim's, frame by frame.
    frames: Vec<ToneMap>,
    /// Exposure of the trajectory.
    pub display: Display,
}

impl Exposures {
    /// Exposures of the `index`-th frame.
    pub fn of(&self, index: usize) -> Exposure {
        Exposure { frame: self.frames.get(index).copied().unwrap_or_default(), display: self.display }
    }
}

/// Measures how the frames of a camera are exposed and writes it to `metadata_tonemap.csv`; returns that file too. Displayed pictures of
/// variations are brighter or darker by what [`enfilade_dataset::Variation`] says.
///
/// # Errors
/// When a layer cannot be read or the file cannot be written.
pub fn expose_camera(dataset: &Dataset, scene: &str, camera: &str, frames: &[u32]) -> Result<(Exposures, PathBuf), DatasetError> {
    let measured = measure_exposures(dataset, [scene, camera], frames)?;
    let stops = dataset.read_variation(scene)?.map_or(0.0, |variation| variation.exposure_stops);
    let chosen = display_exposure(&measured);
    let display = Display { scale: chosen.scale * stops.exp2(), ..chosen };
    let tones: Vec<ToneMap> = measured.iter().map(|frame| ToneMap::of_percentile(frame.percentile)).collect();
    let row = |((&frame, measured), tone): ((&u32, &Brightness), &ToneMap)| ToneMapRow {
        frame,
        percentile: 100.0 * PERCENTILE,
        brightness: measured.percentile,
        scale: tone.scale,
        gamma: GAMMA,
        display_scale: display.scale,
        display_white: display.white,
    };
    let rows: Vec<ToneMapRow> = frames.iter().zip(&measured).zip(&tones).map(row).collect();
    dataset.write_tone_maps(scene, camera, &rows)?;
    Ok((Exposures { frames: tones, display }, dataset.layout().tone_maps(scene, camera)))
}

/// Hypersim's exposure of one frame.
pub(super) fn frame_tone(dataset: &Dataset, shot: [&str; 2], frame: u32) -> Result<ToneMap, DatasetError> {
    Ok(ToneMap::of_percentile(measure_exposures(dataset, shot, &[frame])?.first().and_then(|measured| measured.percentile)))
}

/// The brightness of each frame, from which exposures are chosen.
///
/// # Errors
/// When a layer cannot be read.
pub fn measure_exposures(dataset: &Dataset, [scene, camera]: [&str; 2], frames: &[u32]) -> Result<Vec<Brightness>, DatasetError> {
    let one = |&number: &u32| {
        let layers = [Layer::Color, Layer::DiffuseIllumination, Layer::Residual, Layer::RenderEntityId];
        let frame = read_present(dataset, scene, camera, number, &layers)?;
        let step = (frame.pixels() * frames.len()).div_ceil(SAMPLES);
        Ok(Brightness::of_frame(&frame, step).unwrap_or_default())
    };
    enfilade_parallel::try_map(frames, one)
}
