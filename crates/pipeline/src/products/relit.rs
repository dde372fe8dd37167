//! Frames as mixes of lamps light them: a part for each mix and frame.

use super::record::{Asked, Part};
use super::sources::Subject;
use crate::error::Error;
use crate::relight::{Mix, mixes_of, relight_frames};
use crate::request::{FrameChoice, MixRequest, Request};
use crate::workdir::Hash;
use enfilade_dataset::{Dataset, DatasetError, Fixture, counted};
use enfilade_scene::{Cx, Warning};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A request for each mix of the table `file`.
///
/// # Errors
/// When the table is wrong or means fixtures that no scene has, or none of the scenes has fixtures.
pub fn read_mixes(file: &Path, dataset: &Dataset, scenes: &[String], of: &FrameChoice) -> Result<Vec<Request>, Error> {
    let fixtures = |scene: &String| dataset.read_fixtures(scene).map_err(Error::stage);
    let all: Vec<Fixture> = scenes.iter().map(fixtures).collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect();
    if all.is_empty() {
        return Err(no_fixtures());
    }
    let mixes = mixes_of(file, Some(&all))?;
    Ok(mixes.into_iter().map(|mix| Request::Mix { mix: MixRequest(mix), of: of.clone() }).collect())
}

fn no_fixtures() -> Error {
    let message = "no scene that was chosen has the light of its fixtures apart".to_string();
    Error::usage(message, "render it with --fixtures (or fixtures = true below [render])")
}

/// Refuses scenes none of which has fixtures, and warns of those that have none.
pub(super) fn check(subjects: &[Subject], cx: &dyn Cx) -> Result<(), Error> {
    let is_unlit = |subject: &&Subject| subject.dataset.read_fixtures(subject.scene).is_ok_and(|fixtures| fixtures.is_empty());
    let unlit: Vec<&Subject> = subjects.iter().filter(is_unlit).collect();
    if unlit.len() == subjects.len() {
        return Err(no_fixtures());
    }
    for subject in unlit {
        let message = "it is left out, since the light of its fixtures is not apart; render it with --fixtures".into();
        cx.warn(Warning { place: subject.scene.into(), message });
    }
    Ok(())
}

pub(super) fn parts(subject: &Subject, request: &Request) -> Result<Vec<Part>, Error> {
    let Request::Mix { mix, of } = request else { return Ok(Vec::new()) };
    if subject.dataset.read_fixtures(subject.scene).map_err(Error::stage)?.is_empty() {
        return Ok(Vec::new());
    }
    let (frames, settings) = (subject.chosen(|camera, frame| of.has(camera, frame))?, Hash::of(mix));
    let part = |frame: (String, u32)| Part {
        name: format!("{}/{}/{:04}", mix.name(), frame.0, frame.1),
        frames: vec![frame],
        settings: settings.clone(),
    };
    Ok(frames.into_iter().map(part).collect())
}

/// Mixes of the same frames are made together: the light of each fixture is read once.
pub(super) fn make(subject: &Subject, asked: &[Asked], cx: &dyn Cx) -> Result<Vec<String>, Error> {
    let (dataset, scene) = (subject.dataset, subject.scene);
    let fixtures = dataset.read_fixtures(scene).map_err(Error::stage)?;
    let mut frames: BTreeMap<(&str, u32), Vec<&Mix>> = BTreeMap::new();
    for Asked { part, request } in asked {
        let Request::Mix { mix, .. } = request else { continue };
        let (camera, frame) = &part.frames[0];
        frames.entry((camera, *frame)).or_default().push(&mix.0);
    }
    for mix in frames.values().flatten() {
        dataset.begin_mix(&mix.name, mix).map_err(Error::stage)?;
    }
    relight_frames(dataset, scene, &frames, &fixtures, cx)?;
    Ok(vec![format!("{scene}: {} by every mix", counted(frames.len(), "frame"))])
}

pub(super) fn files(subject: &Subject, part: &Part) -> Result<Vec<PathBuf>, Error> {
    let (camera, frame) = &part.frames[0];
    let mix = part.name.split('/').next().unwrap_or_default();
    let folder = subject.dataset.layout().relit_dir().join(mix).join(subject.scene).join(camera);
    Ok(subject.files_of_frame(&folder, *frame))
}

/// The requests that would have made the existing pictures of a scene.
pub(super) fn found(dataset: &Dataset, scene: &str) -> Result<Vec<Request>, DatasetError> {
    let mut requests = Vec::new();
    for name in dataset.mixes()? {
        let Some(mix) = dataset.mix_rules::<Mix>(&name)? else { continue };
        for camera in dataset.cameras(scene)? {
            let numbers = dataset.relit_frame_numbers(&name, [scene, &camera])?;
            requests.extend(FrameChoice::runs(&camera, &numbers).map(|of| Request::Mix { mix: MixRequest(mix.clone()), of }));
        }
    }
    Ok(requests)
}

#[cfg(test)]
mod tests {
    use super::super::make::make;
    use super::super::update::MakeOptions;
    use super::*;
    use enfilade_frame::{Layer, Values, f16};
    use enfilade_scene::Quiet;
    use enfilade_testroom as testroom;
    use std::ops::Range;

    fn relight(dataset: &Dataset, file: &Path, frames: Range<u32>) -> Result<(), Error> {
        let scenes = ["room".to_string()];
        let requests = read_mixes(file, dataset, &scenes, &FrameChoice { cameras: None, frames: Some(frames) })?;
        make(dataset, &scenes, &requests, MakeOptions::default(), &Quiet).map(drop)
    }

    #[test]
    fn all_fixtures_as_they_are_are_the_rendered_picture_and_none_is_black() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let file = folder.path().join("mixes.csv");
        let table = "mix,fixture,r,g,b\nsame,*,1,1,1\nnone,*,0,0,0\nred,lamp,1,0,0\nred,sky,0,0,0\n";
        std::fs::write(&file, table).unwrap();
        relight(&dataset, &file, 1..2).unwrap();
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
        relight(&dataset, &file, 0..1).unwrap();
        assert!(!picture("red").exists() && picture("same").is_file());
        let error = relight(&dataset, &file, 9..10).unwrap_err().to_string();
        assert!(error.contains("no existing frame was selected"), "{error}");
    }

    #[test]
    fn a_dataset_without_fixtures_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        dataset.write_fixtures("room", &[]).unwrap();
        let file = folder.path().join("mixes.csv");
        std::fs::write(&file, "mix,fixture,r,g,b\na,sky,0,0,0\n").unwrap();
        let error = relight(&dataset, &file, 0..2).unwrap_err();
        assert!(error.to_string().contains("no scene that was chosen") && error.hint().unwrap().contains("--fixtures"), "{error}");
    }
}
