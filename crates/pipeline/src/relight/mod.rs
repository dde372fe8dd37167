//! Pictures with lamps switched, dimmed and tinted, of frames that have the light of each fixture apart. Nothing is rendered: light adds up.

mod mixes;

use crate::error::Error;
use enfilade_dataset::{ColorKind, Dataset, DatasetError, Fixture, ToneMapRow};
use enfilade_denoise::{Denoiser, GUIDES, denoise, inputs_of};
use enfilade_frame::tonemap::ToneMap;
use enfilade_frame::{DENOISED, Frame, Layer, Values, compose, f16};
use enfilade_math::Rgb;
use enfilade_scene::{Counted, Cx};
use enfilade_show::display::Display;
use enfilade_show::exposure::Exposure;
use enfilade_show::preview::{PreviewSpec, Subject};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Number of mixes that are made at once: each takes 24 bytes per pixel.
const AT_ONCE: usize = 8;

/// The picture of a mix, exposed as the frame's own.
const PICTURE: PreviewSpec = PreviewSpec { pass: enfilade_frame::Pass::Final, name: "display.jpg", subject: Subject::Displayed };

/// Layers of the frame itself that denoising and exposure need, beside [`GUIDES`].
const OWN: [Layer; 4] = [Layer::DiffuseReflectance, Layer::NormalBumpWorld, Layer::RenderEntityId, Layer::Color];

pub(crate) use mixes::{Mix, mixes_of};

/// Lights frames of a scene, by camera and number, each by its mixes, and writes `color`, `diffuse_illumination` and `residual` of each, and a
/// picture, below `relit/MIX/SCENE/CAMERA` of the dataset. They are denoised where the frame's own are, by the network in the program.
///
/// # Errors
/// When a file cannot be read or written.
pub(crate) fn relight_frames(
    dataset: &Dataset,
    scene: &str,
    frames: &BTreeMap<(&str, u32), Vec<&Mix>>,
    fixtures: &[Fixture],
    cx: &dyn Cx,
) -> Result<(), Error> {
    let denoiser = Denoiser::built_in();
    let mut exposures: BTreeMap<&str, Vec<ToneMapRow>> = BTreeMap::new();
    for (camera, _) in frames.keys() {
        exposures.insert(camera, dataset.read_tone_maps(scene, camera)?);
    }
    let counted = Counted::new(cx, "frames", frames.len());
    // One after the other: each has several mixes in memory, and denoising uses all threads.
    frames.iter().try_for_each(|((camera, number), mixes)| {
        let exposure = exposures[camera].iter().find(|row| row.frame == *number).map(exposure);
        counted.unit(|| {
            let mut mixes = mixes.chunks(AT_ONCE);
            mixes.try_for_each(|mixes| relight_frame(dataset, (scene, camera, *number), fixtures, mixes, exposure, &denoiser))
        })
    })
}

/// The exposures that the frame's own pictures have.
fn exposure(row: &ToneMapRow) -> Exposure {
    Exposure { frame: ToneMap { scale: row.scale }, display: Display { scale: row.display_scale, white: row.display_white } }
}

/// Lights one frame by every mix.
fn relight_frame(
    dataset: &Dataset,
    frame: (&str, &str, u32),
    fixtures: &[Fixture],
    mixes: &[&Mix],
    exposure: Option<Exposure>,
    denoiser: &Denoiser,
) -> Result<(), Error> {
    let (scene, camera, number) = frame;
    let has = |layer: &Layer| dataset.has_layer(scene, camera, number, *layer);
    let own: Vec<Layer> = OWN.into_iter().chain(GUIDES.into_iter().filter(has)).collect();
    let guides = dataset.read_frame(scene, camera, number, &own)?;
    let exposure = exposure.unwrap_or_else(|| ToneMap::of_frame(&guides).unwrap_or_default().into());
    let record = dataset.frame_record(scene, camera, number)?;
    let is_denoised = record.is_some_and(|record| record.color == ColorKind::Denoised);

    // Add up what each fixture sends, one fixture at a time.
    let mut sums = vec![Sum::new(guides.pixels()); mixes.len()];
    for fixture in fixtures {
        let ([height, width], light) = dataset.read_fixture_layers(scene, camera, number, fixture.id)?;
        if (width, height) != (guides.width as usize, guides.height as usize) {
            let path = dataset.layout().fixture_layer(scene, camera, number, fixture.id, Layer::Residual);
            let problem = format!("{width}x{height} pixels, but the frame has {}x{}; render it again", guides.width, guides.height);
            return Err(DatasetError::Hdf5 { path, problem }.into());
        }
        for (sum, mix) in sums.iter_mut().zip(mixes) {
            let factor = mix.factor(fixture);
            sum.add([&light.diffuse_illumination, &light.residual], factor);
        }
    }

    // Make layers and a picture of each sum.
    for (sum, mix) in sums.into_iter().zip(mixes) {
        let mut lit = sum.layers(&guides);
        if is_denoised {
            let wanted = inputs_of(|layer| guides.get(layer).is_some());
            let noisy = wanted.into_iter().filter_map(|layer| Some((layer, lit.get(layer).or_else(|| guides.get(layer))?.clone())));
            let mut whole = Frame::new(guides.width, guides.height);
            noisy.for_each(|(layer, values)| whole.insert(layer, values));
            lit = denoise(&whole, |noisy| denoiser.filter(noisy)).map_err(Error::stage)?;
        }
        let picture = PICTURE.file(&lit, exposure).expect("it has color");
        dataset.write_relit(&mix.name, frame, &lit, &picture)?;
    }
    Ok(())
}

/// Light of several fixtures: three values per pixel, row by row.
#[derive(Clone)]
struct Sum {
    illumination: Vec<f32>,
    residual: Vec<f32>,
}

impl Sum {
    fn new(pixels: usize) -> Self {
        Self { illumination: vec![0.0; 3 * pixels], residual: vec![0.0; 3 * pixels] }
    }

    fn add(&mut self, [illumination, residual]: [&Values; 2], factor: Rgb) {
        if factor.is_black() {
            return;
        }
        for (sum, values) in [(&mut self.illumination, illumination), (&mut self.residual, residual)] {
            sum.par_iter_mut().enumerate().for_each(|(i, sum)| *sum += factor[i % 3] * values.get(i) as f32);
        }
    }

    /// The colour layers, in which color = diffuse_reflectance × diffuse_illumination + residual to the last bit.
    fn layers(self, guides: &Frame) -> Frame {
        let reflectance = guides.get(Layer::DiffuseReflectance);
        let mut layers: [Vec<f16>; 3] = Default::default();
        for (i, (illumination, residual)) in self.illumination.into_iter().zip(self.residual).enumerate() {
            let a = f16::from_f64(reflectance.map_or(0.0, |values| values.get(i)));
            let channel = compose(a, illumination, residual);
            for (layer, value) in layers.iter_mut().zip([channel.illumination, channel.residual, channel.color]) {
                layer.push(value);
            }
        }
        let mut frame = Frame::new(guides.width, guides.height);
        DENOISED.iter().zip(layers).for_each(|((layer, _), values)| frame.insert(*layer, Values::F16(values)));
        frame
    }
}
