//! Pictures of a camera's frames beside layers: the light of fixtures and mixes of them, surfaces along rays, planes of the rooms,
//! layers that lead to other frames, readings of sensors. They are found by the names of their files.

use super::derived_files::{FIRST_SURFACES, MOST_SURFACES, PLANE, READINGS, REFRACTED, SURFACES};
use super::picture::FramePicture;
use super::picture_spec::PictureSpec;
use super::place::{FramePlace, problem};
use super::problems::Problems;
use super::viewer::Viewer;
use enfilade_dataset::{DatasetError, Fixture, check_name, image_shape};
use enfilade_frame::Pass;
use enfilade_serve::ApiProblem;
use std::collections::{BTreeMap, BTreeSet};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// The pictures that the frames of a camera have beside layers.
pub(super) struct Derived {
    /// Each picture that any frame has.
    pub specs: Vec<PictureSpec>,
    /// Indices into `specs` of the pictures that a frame has.
    pub of_frames: BTreeMap<u32, Vec<usize>>,
}

type Found = BTreeMap<FramePicture, BTreeSet<u32>>;
/// Lists the pictures in a file, by the frame's number and the text after it in the file's name.
type Reader<'a> = &'a dyn Fn(u32, &str) -> Result<Vec<FramePicture>, ApiProblem>;

impl Viewer {
    /// The pictures that the frames of a camera have beside layers. If a folder cannot be read, its contents are missing.
    pub(super) fn derived(&self, scene: &str, camera: &str, lost: &mut Problems) -> Derived {
        let layout = self.layout();
        let mut found = Found::new();
        let mixes = lost.or_nothing("display", self.subfolders(&layout.relit_dir()));
        let sensors = lost.or_nothing("display", self.subfolders(&layout.sensors_dir()));
        let mut find = |folder: &Path, pictures: Reader<'_>| {
            lost.or_nothing("display", self.find(folder, pictures, &mut found));
        };
        find(&layout.layer_dir(scene, camera, Pass::Final), &|_, file| Ok(fixture(file).into_iter().collect()));
        find(&layout.pair_layers_dir(scene, camera), &|_, file| Ok(leading(file).into_iter().collect()));
        find(&layout.surfaces_dir(scene, camera), &|frame, file| match file.strip_suffix(".hdf5") {
            Some(FIRST_SURFACES) => self.surfaces(&FramePlace { scene: scene.into(), camera: camera.into(), frame }),
            Some(name) => {
                let what = REFRACTED.iter().position(|known| known.name == name);
                Ok(what.map(|what| FramePicture::Refracted { what }).into_iter().collect())
            }
            None => Ok(Vec::new()),
        });
        find(&layout.planes_dir(scene, camera), &|_, file| {
            Ok((file.strip_suffix(".hdf5") == Some(PLANE)).then_some(FramePicture::Plane).into_iter().collect())
        });
        for (mix, folder) in mixes {
            find(&folder.join(scene).join(camera), &|_, file| Ok(mixed(&mix, file).into_iter().collect()));
        }
        for (sensor, folder) in sensors {
            find(&folder.join(scene).join(camera), &|_, file| Ok(sensed(&sensor, file)));
        }
        let fixtures = lost.or_nothing("display", self.fixtures(scene));
        let mut of_frames: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (at, frames) in found.values().enumerate() {
            frames.iter().for_each(|&frame| of_frames.entry(frame).or_default().push(at));
        }
        Derived { specs: found.keys().map(|picture| picture.spec(&fixtures)).collect(), of_frames }
    }

    /// Adds the pictures that `pictures` finds in the files `frame.IIII.<file>` of a folder. A missing folder has none. If a file cannot be
    /// read, its pictures are missing; the first such file is reported.
    fn find(&self, folder: &Path, pictures: Reader<'_>, found: &mut Found) -> Result<(), ApiProblem> {
        self.allow(folder)?;
        let cannot = |source| problem(DatasetError::Io { action: "read the folder", path: folder.to_path_buf(), source });
        let entries = match std::fs::read_dir(folder) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
            entries => entries.map_err(cannot)?,
        };
        let mut outcome = Ok(());
        for entry in entries {
            let name = entry.map_err(cannot)?.file_name().to_string_lossy().into_owned();
            let Some((number, file)) = name.strip_prefix("frame.").and_then(|rest| rest.split_once('.')) else { continue };
            let Ok(frame) = number.parse() else { continue };
            match pictures(frame, file) {
                Ok(pictures) => pictures.into_iter().for_each(|picture| {
                    found.entry(picture).or_default().insert(frame);
                }),
                Err(error) => outcome = outcome.and(Err(error)),
            }
        }
        outcome
    }

    /// The surfaces along the rays of a frame, as far as any pixel may have them.
    fn surfaces(&self, place: &FramePlace) -> Result<Vec<FramePicture>, ApiProblem> {
        let path = self.layout().surfaces(&place.scene, &place.camera, place.frame, FIRST_SURFACES);
        self.allow(&path)?;
        let shape = image_shape(&path).map_err(problem)?;
        let count = shape.get(2).copied().unwrap_or(1).min(MOST_SURFACES);
        Ok((1..=count).flat_map(|nth| (0..SURFACES.len()).map(move |what| FramePicture::Surface { nth, what })).collect())
    }

    /// Subfolders of a folder whose names can be part of an address, by name.
    fn subfolders(&self, folder: &Path) -> Result<BTreeMap<String, PathBuf>, ApiProblem> {
        self.allow(folder)?;
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let named = entries.map(|entry| (entry.file_name().to_string_lossy().into_owned(), entry.path()));
        Ok(named.filter(|(name, path)| check_name("name", name).is_ok() && path.is_dir()).collect())
    }

    /// The fixtures of a scene, if frames have the light of each one separately.
    fn fixtures(&self, scene: &str) -> Result<Vec<Fixture>, ApiProblem> {
        self.allow(&self.layout().metadata_fixtures(scene))?;
        self.dataset.read_fixtures(scene).map_err(problem)
    }
}

/// The part of a fixture that is in a file.
fn fixture(file: &str) -> Option<FramePicture> {
    FramePicture::from_name(file.strip_suffix(".hdf5")?).filter(|picture| matches!(picture, FramePicture::Fixture { .. }))
}

/// The layer of a mix that is in a file.
fn mixed(mix: &str, file: &str) -> Option<FramePicture> {
    FramePicture::from_name(&format!("mix.{mix}.{}", file.strip_suffix(".hdf5")?))
}

/// The layer that is in a file `<camera>.frame.JJJJ.<layer>.hdf5`, and leads to that frame.
fn leading(file: &str) -> Option<FramePicture> {
    let (other, layer) = file.strip_suffix(".hdf5")?.rsplit_once('.')?;
    let (camera, number) = other.rsplit_once(".frame.")?;
    let frame: u32 = number.parse().ok()?;
    FramePicture::from_name(&format!("to.{camera}.{frame}.{layer}"))
}

/// The readings of a sensor that are in a file.
fn sensed(sensor: &str, file: &str) -> Vec<FramePicture> {
    let in_file = READINGS.iter().enumerate().filter(|(_, reading)| reading.file == file);
    in_file.map(|(what, _)| FramePicture::Sensed { sensor: sensor.into(), what }).collect()
}
