//! Pictures with lamps switched, dimmed and tinted, of frames that have the light of each fixture apart. Nothing is rendered: light adds up.

mod mixes;

use crate::error::Error;
use enfilade_dataset::{ChosenFrames, ColorKind, Dataset, DatasetError, Fixture, ToneMapRow};
use enfilade_denoise::{Denoiser, INPUTS, denoise};
use enfilade_frame::tonemap::ToneMap;
use enfilade_frame::{DENOISED, Frame, Layer, Values, compose, f16};
use enfilade_math::Rgb;
use enfilade_scene::{Counted, Cx};
use enfilade_show::display::Display;
use enfilade_show::exposure::Exposure;
use enfilade_show::preview::{PreviewSpec, Subject};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;

/// So many mixes are made at once: each takes 24 bytes per pixel.
const AT_ONCE: usize = 8;

/// The picture of a mix, exposed as the frame's own.
const PICTURE: PreviewSpec = PreviewSpec { pass: enfilade_frame::Pass::Final, name: "display.jpg", subject: Subject::Displayed };

/// What denoising and exposure go by: the frame's own.
const GUIDES: [Layer; 4] = [Layer::DiffuseReflectance, Layer::NormalBumpWorld, Layer::RenderEntityId, Layer::Color];

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
    // One after the other: each holds several mixes, and denoising uses all threads.
    frames.iter().try_for_each(|((camera, number), mixes)| {
        let exposure = exposures[camera].iter().find(|row| row.frame == *number).map(exposure);
        counted.unit(|| {
            let mut mixes = mixes.chunks(AT_ONCE);
            mixes.try_for_each(|mixes| relight_frame(dataset, (scene, camera, *number), fixtures, mixes, exposure, &denoiser))
        })
    })
}

/// Lights frames by the mixes of the table `file`. Gives the number of frames, of which each has as many pictures as there are mixes.
///
/// # Errors
/// When the table is wrong or means fixtures that no scene has, no chosen scene has fixtures, or a file cannot be read or written.
pub fn relight(dataset: &Dataset, file: &Path, chosen: &ChosenFrames, cx: &dyn Cx) -> Result<usize, Error> {
    let fixtures = |scene: &String| Ok((scene.clone(), dataset.read_fixtures(scene)?));
    let lit: Vec<(String, Vec<Fixture>)> = chosen.scenes.iter().map(fixtures).collect::<Result<_, DatasetError>>()?;
    let all: Vec<Fixture> = lit.iter().flat_map(|(_, fixtures)| fixtures.clone()).collect();
    if all.is_empty() {
        let message = "no scene that was chosen has the light of its fixtures apart".to_string();
        return Err(Error::usage(message, "render it with --fixtures (or fixtures = true below [render])"));
    }
    let mixes = mixes_of(file, Some(&all))?;
    for mix in &mixes {
        dataset.begin_mix(&mix.name, mix)?;
    }
    let mut count = 0;
    for (scene, fixtures) in lit.iter().filter(|(_, fixtures)| !fixtures.is_empty()) {
        let cameras = chosen.of_scene(dataset, scene, cx)?;
        let named =
            cameras.iter().flat_map(|(camera, frames)| frames.iter().map(|frame| ((camera.as_str(), *frame), mixes.iter().collect())));
        let frames: BTreeMap<(&str, u32), Vec<&Mix>> = named.collect();
        relight_frames(dataset, scene, &frames, fixtures, cx)?;
        count += frames.len();
    }
    Ok(count)
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
    let guides = dataset.read_frame(scene, camera, number, &GUIDES)?;
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
            let noisy = INPUTS.into_iter().filter_map(|layer| Some((layer, lit.get(layer).or_else(|| guides.get(layer))?.clone())));
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

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_testroom as testroom;

    #[test]
    fn all_fixtures_as_they_are_are_the_rendered_picture_and_none_is_black() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let file = folder.path().join("mixes.csv");
        let table = "mix,fixture,r,g,b\nsame,*,1,1,1\nnone,*,0,0,0\nred,lamp,1,0,0\nred,sky,0,0,0\n";
        std::fs::write(&file, table).unwrap();
        let chosen = ChosenFrames { scenes: vec!["room".into()], frames: Some(1..2), ..ChosenFrames::default() };
        assert_eq!(relight(&dataset, &file, &chosen, &enfilade_scene::Quiet).unwrap(), 1);
        let lit = |mix: &str, layer| dataset.read_relit_layer(mix, ("room", "cam_00", 1), layer).unwrap().1;
        let rendered = dataset.read_layer("room", "cam_00", 1, Layer::ColorRendered).unwrap();
        let (same, none, red) = (lit("same", Layer::Color), lit("none", Layer::Color), lit("red", Layer::Color));
        // The room is denoised, so that pixels differ where there are edges.
        let mean = |values: &Values, channel: usize| (0..values.len() / 3).map(|i| values.get(3 * i + channel).min(2.0)).sum::<f64>();
        assert!((mean(&same, 1) / mean(&rendered, 1) - 1.0).abs() < 0.05, "{} and {}", mean(&same, 1), mean(&rendered, 1));
        assert!((0..none.len()).all(|i| none.get(i) < 1e-3));
        assert!(mean(&red, 0) > 0.1 * mean(&same, 0) && mean(&red, 1) < 0.01 * mean(&same, 1));
        let residual = lit("same", Layer::Residual);
        let (a, s) = (dataset.read_layer("room", "cam_00", 1, Layer::DiffuseReflectance).unwrap(), lit("same", Layer::DiffuseIllumination));
        let recomposed = |i: usize| f16::from_f32(a.get(i) as f32 * s.get(i) as f32 + residual.get(i) as f32).to_f64();
        assert!((0..same.len()).all(|i| same.get(i) == recomposed(i)));
        let picture = |mix: &str| folder.path().join(format!("relit/{mix}/room/cam_00/frame.0001.display.jpg"));
        assert!(picture("red").is_file());

        // Other rules take the place of all that is there.
        std::fs::write(&file, table.replace("red,lamp,1", "red,lamp,0.5")).unwrap();
        let none = ChosenFrames { frames: Some(9..10), ..chosen };
        assert_eq!(relight(&dataset, &file, &none, &enfilade_scene::Quiet).unwrap(), 0);
        assert!(!picture("red").exists() && picture("same").is_file());
    }

    #[test]
    fn a_dataset_without_fixtures_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        dataset.write_fixtures("room", &[]).unwrap();
        let file = folder.path().join("mixes.csv");
        std::fs::write(&file, "mix,fixture,r,g,b\na,sky,0,0,0\n").unwrap();
        let chosen = ChosenFrames { scenes: vec!["room".into()], ..ChosenFrames::default() };
        let error = relight(&dataset, &file, &chosen, &enfilade_scene::Quiet).unwrap_err();
        assert!(error.to_string().contains("no scene that was chosen") && error.hint().unwrap().contains("--fixtures"), "{error}");
    }
}
