//! Animations of a camera's frames.

use crate::{Animation, AnimationError, AnimationFormat};
use enfilade_dataset::{Dataset, DatasetError, StereoSide, write_bytes};
use enfilade_frame::Layer;
use enfilade_frame::tonemap::ToneMap;
use enfilade_scene::{Counted, Cx};
use enfilade_show::display::Display;
use enfilade_show::drivers::measure_exposures;
use enfilade_show::exposure::{Exposure, display_exposure};
use enfilade_show::picture::Picture;
use enfilade_show::planview::Report;
use enfilade_show::preview::{PREVIEWS, Subject, preview_over};
use enfilade_show::stretch::{Stretch, is_stretched, shown_values};
use std::path::{Path, PathBuf};

/// Pictures per second of trajectories that are no videos, as in the toolkit's animations.
const STILLS_PER_SECOND: f64 = 5.0;
/// Frames that are made ready while their predecessors are encoded, which bounds the memory.
const BATCH: usize = 8;
/// Values that a range is measured from, at most: enough for percentiles that look the same as the exact ones.
const RANGE_SAMPLES: usize = 4_000_000;

/// Something of frames that can be animated: a layer, or a preview made of several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Film {
    /// Name of the film.
    pub name: &'static str,
    subject: Subject,
}

impl Film {
    /// The layer of that name, or else the preview that is none.
    pub fn from_name(name: &str) -> Option<Self> {
        let preview = || PREVIEWS.iter().filter(|spec| !matches!(spec.subject, Subject::Layer(_))).find(|spec| stem(spec.name) == name);
        let layer = Layer::from_name(name).map(|layer| Self { name: layer.spec().name, subject: Subject::Layer(layer) });
        layer.or_else(|| preview().map(|spec| Self { name: stem(spec.name), subject: spec.subject }))
    }

    /// The layers that it needs.
    fn layers(self) -> Vec<Layer> {
        let mut layers = self.subject.layers();
        if self.subject == Subject::ToneMapped {
            layers.push(Layer::RenderEntityId);
        }
        layers
    }
}

/// A preview's name without its extension.
fn stem(name: &str) -> &str {
    name.split_once('.').map_or(name, |(stem, _)| stem)
}

/// The settings of an animation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnimateConfig {
    /// The form of the files.
    pub format: AnimationFormat,
    /// Pictures per second; by default as the trajectory was timed if it is a video, else 5.
    pub fps: Option<f64>,
}

/// An animation that was written.
#[derive(Clone, Debug, PartialEq)]
pub struct Animated {
    /// The file.
    pub path: PathBuf,
    /// Number of frames that it shows.
    pub frames: usize,
    /// Pictures per second.
    pub fps: f64,
    /// Length of the file.
    pub bytes: u64,
}

/// Why there is no animation.
#[derive(Debug, thiserror::Error)]
pub enum AnimateError {
    /// A file cannot be read or written.
    #[error(transparent)]
    Dataset(#[from] DatasetError),
    /// The pictures cannot be encoded.
    #[error("{scene}/{camera}: {source}")]
    Animation {
        /// Name of the scene.
        scene: String,
        /// Name of the camera.
        camera: String,
        /// The fault.
        source: AnimationError,
    },
}

/// No frame of a camera has the layers of a film.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{scene}/{camera} has no frame with {}", layers.join(", "))]
pub struct NoFrames {
    /// Name of the scene.
    pub scene: String,
    /// Name of the camera.
    pub camera: String,
    /// The layers that were asked for.
    pub layers: Vec<&'static str>,
}

/// The frames of one camera.
#[derive(Clone, Copy)]
struct Shot<'a> {
    dataset: &'a Dataset,
    scene: &'a str,
    camera: &'a str,
}

/// Writes `<scene>_<camera>_<name>.<format>` to `folder` for each film of which any frame has the layers, and returns what came of each in
/// that order.
///
/// Every film has one exposure and one range for all frames, except `tonemap`, Hypersim's tone mapping, which has its own for each frame.
/// All begin with the first frame of the camera, or of either camera of a rig. The time of a missing frame is given to the one before, or
/// at the beginning to the one after.
///
/// # Errors
/// When something cannot be read, encoded or written.
pub fn animate_camera(
    dataset: &Dataset,
    [scene, camera]: [&str; 2],
    films: &[Film],
    config: AnimateConfig,
    folder: &Path,
    cx: &dyn Cx,
) -> Result<Vec<Result<Animated, NoFrames>>, AnimateError> {
    let shot = Shot { dataset, scene, camera };
    let numbers = dataset.whole_frames([scene, camera], None, cx)?;
    let first = shot.first(&numbers)?;
    let display = display_exposure(&measure_exposures(dataset, [scene, camera], &numbers)?);
    let fps = config.fps.map_or_else(|| shot.pictures_per_second(), Ok)?;
    let counted = Counted::new(cx, "animations", films.len());
    let one = |film: &Film| -> Result<Result<Animated, NoFrames>, AnimateError> {
        let path = folder.join(format!("{scene}_{camera}_{}.{}", film.name, config.format.name()));
        let there = shot.numbers_with(&numbers, &film.layers());
        if there.is_empty() {
            let layers = film.layers().iter().map(|layer| layer.spec().name).collect();
            return Ok(Err(NoFrames { scene: scene.into(), camera: camera.into(), layers }));
        }
        let bytes = shot.encode(*film, (first, &there), display, config.format, fps)?;
        let animated = Animated { path, frames: there.len(), fps, bytes: bytes.len() as u64 };
        write_bytes(&animated.path, bytes)?;
        Ok(Ok(animated))
    };
    enfilade_parallel::try_map(films, |film| counted.unit(|| one(film)))
}

impl Shot<'_> {
    /// The frame with which every film of the camera begins, so that they are in step, also with those of the other camera of a rig.
    fn first(&self, numbers: &[u32]) -> Result<u32, DatasetError> {
        let beside = match self.dataset.read_stereo(self.scene, self.camera)? {
            Some(stereo) => self.dataset.frame_numbers(self.scene, &stereo.partner)?,
            None => Vec::new(),
        };
        Ok(numbers.iter().chain(&beside).copied().min().unwrap_or(0))
    }

    /// A video keeps its planned timing. A trajectory without a plan counts as a video if its frames are less than a second apart;
    /// Hypersim's are one second apart.
    fn pictures_per_second(&self) -> Result<f64, DatasetError> {
        let stereo = self.dataset.read_stereo(self.scene, self.camera)?;
        // A rig's plan is its left camera's.
        let right = stereo.as_ref().filter(|stereo| stereo.side == StereoSide::Right);
        let planned = right.map_or(self.camera, |stereo| stereo.partner.as_str());
        let plan = Report::read(&self.dataset.layout().plan_report(self.scene, planned)).filter(|plan| !plan.mode.is_empty());
        let frame_time_s = self.dataset.read_frame_time(self.scene, self.camera)?;
        let is_video = plan.map_or(frame_time_s < 1.0, |plan| ["video", "cameras"].contains(&plan.mode.as_str()));
        Ok(if is_video { 1.0 / frame_time_s } else { STILLS_PER_SECOND })
    }

    fn numbers_with(&self, numbers: &[u32], layers: &[Layer]) -> Vec<u32> {
        let has_all = |&number: &u32| layers.iter().all(|&layer| self.dataset.gives_layer(self.scene, self.camera, number, layer));
        numbers.iter().copied().filter(has_all).collect()
    }

    /// The film of the frames `numbers`, which begins when frame `first` would.
    fn encode(
        &self,
        film: Film,
        (first, numbers): (u32, &[u32]),
        display: Display,
        format: AnimationFormat,
        fps: f64,
    ) -> Result<Vec<u8>, AnimateError> {
        let stretch = self.stretch(film, numbers)?;
        let unencodable = |source| AnimateError::Animation { scene: self.scene.into(), camera: self.camera.into(), source };
        let mut animation: Option<Animation> = None;
        for batch in (0..numbers.len()).collect::<Vec<_>>().chunks(BATCH) {
            let pictures: Vec<Picture> = enfilade_parallel::try_map(batch, |&i| self.picture(film, numbers[i], display, stretch.as_ref()))?;
            for (&i, picture) in batch.iter().zip(&pictures) {
                let before = if i == 0 { numbers[0] - first } else { 0 };
                let times = numbers.get(i + 1).map_or(1, |next| next - numbers[i]).saturating_add(before);
                let begun = match &mut animation {
                    Some(begun) => begun,
                    None => animation.insert(Animation::begin(format, picture.dimensions(), fps).map_err(unencodable)?),
                };
                begun.add(picture, times).map_err(unencodable)?;
            }
        }
        animation.expect("at least one frame").finish().map_err(unencodable)
    }

    fn picture(&self, film: Film, number: u32, display: Display, stretch: Option<&Stretch>) -> Result<Picture, DatasetError> {
        let frame = self.dataset.read_frame(self.scene, self.camera, number, &film.layers())?;
        let own = || ToneMap::of_frame(&frame).unwrap_or_default();
        let exposure = if film.subject == Subject::ToneMapped { Exposure::from(own()) } else { Exposure::from(display) };
        let shown = preview_over(film.subject, &frame, exposure, stretch);
        Ok(shown.expect("the frame has all the layers").picture)
    }

    /// The range over all frames, for a layer that has one.
    fn stretch(&self, film: Film, numbers: &[u32]) -> Result<Option<Stretch>, DatasetError> {
        let Subject::Layer(layer) = film.subject else { return Ok(None) };
        if !is_stretched(layer) {
            return Ok(None);
        }
        let one = |&number: &u32| -> Result<_, DatasetError> {
            let frame = self.dataset.read_frame(self.scene, self.camera, number, &[layer])?;
            let step = (frame.pixels() * numbers.len()).div_ceil(RANGE_SAMPLES);
            Ok(frame.get(layer).map(|values| shown_values(layer, values, step)).unwrap_or_default())
        };
        let frames: Vec<Vec<Vec<f64>>> = enfilade_parallel::try_map(numbers, one)?;
        let channels = frames.iter().map(Vec::len).max().unwrap_or(0);
        let pooled = |c: usize| frames.iter().flat_map(|frame| &frame[c]).copied().collect();
        Ok(Some(Stretch::over((0..channels).map(pooled).collect())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_dataset::StereoRecord;
    use enfilade_scene::{Heard, Quiet};
    use enfilade_testroom as testroom;

    fn animate(root: &Path, names: &[&str], format: AnimationFormat) -> Vec<Result<Animated, NoFrames>> {
        let films: Vec<Film> = names.iter().map(|name| Film::from_name(name).unwrap()).collect();
        let dataset = Dataset::open(root).unwrap();
        let config = AnimateConfig { format, fps: None };
        animate_camera(&dataset, ["room", "cam_00"], &films, config, &root.join("animations"), &Quiet).unwrap()
    }

    #[test]
    fn every_layer_and_every_picture_of_several_layers_can_be_animated() {
        let folder = tempfile::tempdir().unwrap();
        testroom::dataset(folder.path());
        let names: Vec<&str> = enfilade_frame::LAYERS.iter().map(|spec| spec.name).collect();
        let names = [&names[..], &["tonemap", "display", "gamma", "lambertian", "non_lambertian", "diff"]].concat();
        for animated in animate(folder.path(), &names, AnimationFormat::Gif) {
            let animated = animated.unwrap();
            assert_eq!((animated.frames, animated.fps), (2, 5.0));
            assert_eq!(std::fs::metadata(&animated.path).unwrap().len(), animated.bytes, "{}", animated.path.display());
        }
        assert!(folder.path().join("animations/room_cam_00_depth_meters.gif").is_file());
        assert_eq!(Film::from_name("colour"), None);
    }

    #[test]
    fn a_layer_that_no_frame_has_is_named_and_missing_frames_are_passed_over() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        for frame in [0, 1] {
            dataset.drop_rendered(["room", "cam_00"], frame).unwrap();
        }
        let films = animate(folder.path(), &["color_rendered", "color"], AnimationFormat::Gif);
        assert_eq!(films[0].as_ref().unwrap_err().to_string(), "room/cam_00 has no frame with color_rendered");
        assert_eq!(films[1].as_ref().unwrap().frames, 2);
        std::fs::remove_file(dataset.layout().layer("room", "cam_00", 0, Layer::Semantic)).unwrap();
        assert_eq!(animate(folder.path(), &["semantic"], AnimationFormat::Mp4)[0].as_ref().unwrap().frames, 1);
    }

    #[test]
    fn a_frame_that_lacks_a_file_of_its_record_is_left_out_with_a_warning() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        std::fs::remove_file(dataset.layout().layer("room", "cam_00", 1, Layer::NormalCam)).unwrap();
        let (films, heard) = ([Film::from_name("color").unwrap()], Heard::default());
        let config = AnimateConfig { format: AnimationFormat::Gif, fps: None };
        let animated = animate_camera(&dataset, ["room", "cam_00"], &films, config, folder.path(), &heard).unwrap();
        assert_eq!(animated[0].as_ref().unwrap().frames, 1);
        let warnings = heard.lines();
        assert!(warnings.len() == 1 && warnings[0].starts_with("room/cam_00: frame 1 is left out: "), "{warnings:?}");
        assert!(warnings[0].contains("frame.0001.normal_cam.hdf5: it is missing"), "{warnings:?}");
    }

    #[test]
    fn videos_keep_their_time_whatever_it_is_and_others_have_five_pictures_a_second() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let fps = |report: &str, frame_time_s: f64| {
            write_bytes(&dataset.layout().plan_report("room", "cam_00"), report).unwrap();
            dataset.write_frame_time("room", "cam_00", frame_time_s).unwrap();
            animate(folder.path(), &["semantic"], AnimationFormat::Gif).remove(0).unwrap().fps
        };
        let (video, walk, unknown) = (r#"{"mode": "video"}"#, r#"{"mode": "walk"}"#, "{}");
        for (report, frame_time_s, expected) in
            [(video, 0.04, 25.0), (video, 1.0, 1.0), (video, 2.0, 0.5), (walk, 0.04, 5.0), (unknown, 0.04, 25.0), (unknown, 1.0, 5.0)]
        {
            assert_eq!(fps(report, frame_time_s), expected, "{report} with {frame_time_s} s");
        }
    }

    #[test]
    fn both_films_of_a_rig_have_the_time_of_its_plan() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let trajectory = dataset.read_trajectory("room", "cam_00").unwrap();
        for (side, expected) in [(StereoSide::Left, 5.0), (StereoSide::Right, 1.0)] {
            let rig = StereoRecord::new(side, "cam_01".into(), 0.1);
            dataset.write_trajectory("room", &trajectory, &testroom::intrinsics().into(), Some(&rig)).unwrap();
            write_bytes(&dataset.layout().plan_report("room", "cam_01"), r#"{"mode": "video"}"#).unwrap();
            let film = animate(folder.path(), &["semantic"], AnimationFormat::Gif).remove(0).unwrap();
            assert_eq!(film.fps, expected, "{side:?}");
        }
    }

    #[test]
    fn films_begin_with_the_first_frame_of_the_camera_or_of_its_rig() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let pictures_long = || {
            let film = animate(folder.path(), &["semantic"], AnimationFormat::Gif).remove(0).unwrap();
            let bytes = std::fs::read(film.path).unwrap();
            let mut decoder = gif::DecodeOptions::new().read_info(&bytes[..]).unwrap();
            let mut hundredths = 0;
            while let Some(frame) = decoder.read_next_frame().unwrap() {
                hundredths += frame.delay;
            }
            hundredths / 20
        };
        let layer = |camera: &str, layer: Layer| dataset.layout().layer("room", camera, 0, layer);
        std::fs::remove_file(layer("cam_00", Layer::Semantic)).unwrap();
        assert_eq!(pictures_long(), 2, "other films begin with frame 0");
        std::fs::remove_file(dataset.layout().frame_record("room", "cam_00", 0)).unwrap();
        assert_eq!(pictures_long(), 1, "no film has frame 0");
        let rig = StereoRecord::new(StereoSide::Left, "cam_01".into(), 0.1);
        let trajectory = dataset.read_trajectory("room", "cam_00").unwrap();
        dataset.write_trajectory("room", &trajectory, &testroom::intrinsics().into(), Some(&rig)).unwrap();
        let beside = layer("cam_01", Layer::Color);
        std::fs::create_dir_all(beside.parent().unwrap()).unwrap();
        std::fs::copy(layer("cam_00", Layer::Color), beside).unwrap();
        assert_eq!(pictures_long(), 2, "the other camera's films begin with frame 0");
    }
}
