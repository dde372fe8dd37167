//! Previews, boxes, contact sheets and questions over a dataset on disk.

mod boxes;
mod exposure;
mod present;

pub use boxes::preview_boxes;
pub use exposure::{Exposures, expose_camera, measure_exposures};

use crate::display::Display;
use crate::exposure::Exposure;
use crate::inspect::{Names, OutsideError, PixelReport, inspect};
use crate::palette::LabelPalette;
use crate::picture::jpeg;
use crate::preview::{PREVIEWS, PreviewSpec, Subject, preview};
use crate::sheet::{MOST_TILES, OverviewTile, OverviewTitle, SheetConfig, SheetTitle, overview_sheet, spread, trajectory_sheet};
use enfilade_dataset::{Dataset, DatasetError, counted, write_bytes};
use enfilade_frame::tonemap::ToneMap;
use enfilade_frame::{Frame, LAYERS, Layer};
use enfilade_scene::{CameraView, Counted, Cx};
use present::read_present;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Writes every preview that the layers of the given frames allow, and returns the files. The exposures belong to the same frames. For the
/// frames `made`, which [`preview_frame_alone`] has handled, only previews that need the whole trajectory are written.
///
/// # Errors
/// When a layer cannot be read or a file cannot be written.
pub fn preview_camera(
    dataset: &Dataset,
    [scene, camera]: [&str; 2],
    frames: &[u32],
    exposures: &Exposures,
    made: &BTreeSet<u32>,
    cx: &dyn Cx,
) -> Result<Vec<PathBuf>, DatasetError> {
    let count = Counted::new(cx, "frames", frames.len());
    let one = |index: usize| {
        let number = frames[index];
        let wanted = |spec: &PreviewSpec| spec.of_trajectory() || !made.contains(&number);
        count.unit(|| preview_frame(dataset, [scene, camera], number, exposures.of(index), wanted))
    };
    let files: Vec<Vec<PathBuf>> = enfilade_parallel::try_map_up_to(frames.len(), one)?;
    Ok(files.into_iter().flatten().collect())
}

/// Writes every preview of a frame that does not need its whole trajectory, and returns the files.
///
/// # Errors
/// As [`preview_camera`].
pub fn preview_frame_alone(dataset: &Dataset, shot: [&str; 2], number: u32) -> Result<Vec<PathBuf>, DatasetError> {
    let exposure = Exposure { frame: exposure::frame_tone(dataset, shot, number)?, display: Display::default() };
    preview_frame(dataset, shot, number, exposure, |spec| !spec.of_trajectory())
}

fn preview_frame(
    dataset: &Dataset,
    [scene, camera]: [&str; 2],
    number: u32,
    exposure: Exposure,
    wanted: impl Fn(&PreviewSpec) -> bool,
) -> Result<Vec<PathBuf>, DatasetError> {
    let specs: Vec<PreviewSpec> = PREVIEWS.into_iter().filter(wanted).collect();
    let shown: Vec<Layer> = specs.iter().flat_map(|spec| spec.subject.layers()).collect();
    let needed: Vec<Layer> = LAYERS.iter().map(|spec| spec.layer).filter(|layer| shown.contains(layer)).collect();
    let frame = read_present(dataset, scene, camera, number, &needed)?;
    let palette = LabelPalette::of_scene(dataset, scene)?;
    let one = |spec: &PreviewSpec| -> Result<Option<PathBuf>, DatasetError> {
        let path = dataset.layout().preview(scene, camera, number, spec.pass, spec.name);
        let Some(bytes) = spec.file_of_scene(&frame, exposure, &palette) else { return remove_old(&path).map(|()| None) };
        write_bytes(&path, bytes)?;
        Ok(Some(path))
    };
    let written: Vec<Option<PathBuf>> = enfilade_parallel::try_map(&specs, one)?;
    Ok(written.into_iter().flatten().collect())
}

/// Removes a picture of a layer that the frame no longer has.
fn remove_old(path: &Path) -> Result<(), DatasetError> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(DatasetError::Io { action: "remove", path: path.into(), source: error })
        }
        _ => Ok(()),
    }
}

/// Writes the contact sheet of a camera with this exposure and returns its path; `None` when the camera has no frames.
///
/// # Errors
/// When a layer cannot be read or the file cannot be written.
pub fn write_contact_sheet(
    dataset: &Dataset,
    [scene, camera]: [&str; 2],
    frames: &[u32],
    display: Display,
    config: &SheetConfig,
) -> Result<Option<PathBuf>, DatasetError> {
    if frames.is_empty() {
        return Ok(None);
    }
    let all = LAYERS.map(|spec| spec.layer);
    let read = |&i: &usize| read_present(dataset, scene, camera, frames[i], &all).map(|frame| (frames[i], frame));
    let shown: Vec<(u32, Frame)> = enfilade_parallel::try_map(&spread(frames.len(), config.frames), read)?;
    let sheet = trajectory_sheet(SheetTitle { scene, camera, frames: frames.len() }, &shown, display, config);
    let path = dataset.layout().contact_sheet(scene, camera);
    write_bytes(&path, jpeg(&sheet))?;
    Ok(Some(path))
}

/// Writes the contact sheet of these scenes, with the first frame of every trajectory that has one, and returns its path. Of more
/// than [`MOST_TILES`] trajectories it shows that many, spread evenly.
///
/// # Errors
/// When a layer cannot be read or the file cannot be written.
pub fn write_overview(dataset: &Dataset, scenes: &[String], title: &str, config: &SheetConfig) -> Result<PathBuf, DatasetError> {
    let mut filmed: Vec<(String, String, Vec<u32>)> = Vec::new();
    for scene in scenes {
        for camera in dataset.cameras(scene)? {
            let frames = dataset.frame_numbers(scene, &camera)?;
            if frames.first().is_some_and(|&first| dataset.has_layer(scene, &camera, first, Layer::Color)) {
                filmed.push((scene.clone(), camera, frames));
            }
        }
    }
    let scenes: BTreeSet<&String> = filmed.iter().map(|(scene, ..)| scene).collect();
    let title = OverviewTitle { dataset: title, scenes: scenes.len(), cameras: filmed.len() };
    let shown = spread(filmed.len(), MOST_TILES);
    let mut tiles = Vec::new();
    for &i in &shown {
        let (scene, camera, frames) = &filmed[i];
        tiles.extend(overview_tile(dataset, [scene, camera], frames)?.map(|tile| tile.shrunk(shown.len(), config)));
    }
    let path = dataset.layout().overview();
    write_bytes(&path, jpeg(&overview_sheet(title, &tiles, config)))?;
    Ok(path)
}

fn overview_tile(dataset: &Dataset, [scene, camera]: [&str; 2], frames: &[u32]) -> Result<Option<OverviewTile>, DatasetError> {
    let frame = read_present(dataset, scene, camera, frames[0], &[Layer::Color, Layer::RenderEntityId])?;
    let stored = dataset.read_tone_maps(scene, camera)?.first().map(|row| Display { scale: row.display_scale, white: row.display_white });
    let exposure = stored.map(Exposure::from).or_else(|| ToneMap::of_frame(&frame).map(Exposure::from)).unwrap_or_default();
    let shown = preview(Subject::Displayed, &frame, exposure);
    let detail = format!("{camera}  ·  {}  ·  {} x {} px", counted(frames.len(), "frame"), frame.width, frame.height);
    Ok(shown.map(|shown| OverviewTile { scene: scene.to_string(), detail, picture: shown.picture }))
}

/// Why a pixel cannot be reported on.
#[derive(Debug, thiserror::Error)]
pub enum InspectError {
    /// A file cannot be read.
    #[error(transparent)]
    Dataset(#[from] DatasetError),
    /// No such pixel.
    #[error(transparent)]
    Outside(#[from] OutsideError),
    /// No such frame.
    #[error("{scene}/{camera} has no frame {frame}; its frames: {there}")]
    NoFrame {
        /// Name of the scene.
        scene: String,
        /// Name of the camera.
        camera: String,
        /// The requested frame.
        frame: u32,
        /// The first and last frame that are there.
        there: String,
    },
}

/// Reports on pixel (x, y) of a frame: every layer that is there, with the names that the dataset knows.
///
/// # Errors
/// When there is no such frame or pixel, or a file cannot be read.
pub fn inspect_pixel(dataset: &Dataset, scene: &str, camera: &str, frame: u32, [x, y]: [u32; 2]) -> Result<PixelReport, InspectError> {
    let trajectory = dataset.read_trajectory(scene, camera)?;
    let frames = dataset.frame_numbers(scene, camera)?;
    let index = trajectory.poses.iter().position(|pose| pose.frame == frame).filter(|_| frames.contains(&frame));
    let Some(index) = index else {
        if let Some(problem) = dataset.incomplete_frames(scene, camera, &frames)?.remove(&frame) {
            return Err(problem.into());
        }
        let there = match (frames.first(), frames.last()) {
            (Some(first), Some(last)) => format!("{} from {first} to {last}", frames.len()),
            _ => "none".to_string(),
        };
        return Err(InspectError::NoFrame { scene: scene.into(), camera: camera.into(), frame, there });
    };
    let layers = read_present(dataset, scene, camera, frame, &LAYERS.map(|spec| spec.layer))?;
    // Parts of Hypersim's archives are often downloaded without tables.
    let nodes = match dataset.read_nodes(scene) {
        Err(error) if error.is_not_found() => Vec::new(),
        nodes => nodes?,
    };
    let parts: Vec<String> = nodes.into_iter().map(|node| node.node_name).collect();
    let names = Names { parts: &parts, materials: &[] };
    let with = dataset.read_camera(scene, camera)?;
    Ok(inspect(&layers, &CameraView::of_frame(&with, &trajectory.poses, index), names, x, y)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_dataset::hdf5::{Storage, read_array, write_array};
    use enfilade_dataset::{Array, Elements};
    use enfilade_scene::Quiet;
    use enfilade_testroom as testroom;

    #[test]
    fn every_preview_and_both_sheets_are_written() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let (exposures, table) = expose_camera(&dataset, "room", "cam_00", &[0, 1]).unwrap();
        assert!(table.is_file());
        let files = preview_camera(&dataset, ["room", "cam_00"], &[0, 1], &exposures, &BTreeSet::new(), &Quiet).unwrap();
        assert_eq!(files.len(), 2 * PREVIEWS.len());
        assert!(files.iter().all(|file| file.is_file()));
        let config = SheetConfig { width: 600, frames: 1 };
        let sheet = write_contact_sheet(&dataset, ["room", "cam_00"], &[0, 1], exposures.display, &config).unwrap().unwrap();
        let overview = write_overview(&dataset, &["room".to_string()], "homes", &config).unwrap();
        for path in [sheet, overview] {
            assert_eq!(image::open(path).unwrap().width(), 600);
        }
        assert_eq!(write_contact_sheet(&dataset, ["room", "cam_00"], &[], exposures.display, &config).unwrap(), None);
    }

    #[test]
    fn the_overview_of_hundreds_of_cameras_shows_as_many_as_fit() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let color = |camera: &str| dataset.layout().layer("room", camera, 0, Layer::Color);
        let cameras: Vec<String> = (0..MOST_TILES + 10).map(|i| format!("cam_{i:02}")).collect();
        for camera in &cameras[1..] {
            std::fs::create_dir_all(color(camera).parent().unwrap()).unwrap();
            std::fs::copy(color("cam_00"), color(camera)).unwrap();
        }
        std::fs::write(dataset.layout().metadata_cameras("room"), format!("camera_name\n{}\n", cameras.join("\n"))).unwrap();
        let sheet =
            image::open(write_overview(&dataset, &["room".to_string()], "homes", &SheetConfig { width: 600, frames: 1 }).unwrap()).unwrap();
        // Four columns of pictures 113 x 85 pixels large: 50 rows with their captions, and the text above and below.
        assert_eq!((sheet.width(), sheet.height()), (600, 50 * (85 + 64) + 140));
    }

    #[test]
    fn the_overview_of_some_scenes_shows_no_others() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let config = SheetConfig { width: 600, frames: 1 };
        let overview =
            |scenes: &[&str]| write_overview(&dataset, &scenes.iter().map(ToString::to_string).collect::<Vec<_>>(), "homes", &config);
        let alone = std::fs::read(overview(&["room"]).unwrap()).unwrap();
        let color = |scene: &str| dataset.layout().layer(scene, "cam_00", 0, Layer::Color);
        for path in [color("hall"), dataset.layout().metadata_cameras("hall")] {
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        }
        std::fs::copy(color("room"), color("hall")).unwrap();
        std::fs::write(dataset.layout().metadata_cameras("hall"), "camera_name\ncam_00\n").unwrap();
        let of_both = overview(&["room", "hall"]).unwrap();
        assert!(std::fs::read(&of_both).unwrap() != alone);
        let of_one = overview(&["room"]).unwrap();
        assert!(of_one == of_both && std::fs::read(of_one).unwrap() == alone);
    }

    #[test]
    fn pictures_made_of_single_frames_are_those_of_the_whole_trajectory_and_only_the_rest_is_made_then() {
        let [apart, whole] = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
        let shot = ["room", "cam_00"];
        let preview = |dataset: &Dataset, made: &[u32]| {
            let (exposures, _) = expose_camera(dataset, "room", "cam_00", &[0, 1]).unwrap();
            preview_camera(dataset, shot, &[0, 1], &exposures, &made.iter().copied().collect(), &Quiet).unwrap()
        };
        let dataset = testroom::dataset(apart.path());
        let alone: Vec<PathBuf> = [0, 1].iter().flat_map(|&frame| preview_frame_alone(&dataset, shot, frame).unwrap()).collect();
        let rest = preview(&dataset, &[0, 1]);
        assert_eq!((alone.len(), rest.len()), (2 * (PREVIEWS.len() - 1), 2));
        assert!(rest.iter().all(|path| path.to_string_lossy().ends_with("display.jpg")));
        let expected = preview(&testroom::dataset(whole.path()), &[]);
        assert_eq!(expected.len(), alone.len() + rest.len());
        for path in expected {
            let same = apart.path().join(path.strip_prefix(whole.path()).unwrap());
            assert!(std::fs::read(&path).unwrap() == std::fs::read(&same).unwrap(), "{}", same.display());
        }
    }

    /// By the rule of Hypersim's `scene_generate_images_semantic_segmentation.py`: the colour of a number is its row of the table, none is black.
    #[test]
    fn pictures_of_labels_have_the_colours_of_the_scenes_tables() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let tables = ["metadata_semantic_colors.hdf5", "metadata_semantic_instance_colors.hdf5"];
        let mesh = |name: &str| dataset.layout().mesh_file("room", name);
        // Another table of instances than ours.
        let own: Vec<i64> = (0..3 * 20).map(|i| if i < 3 { -1 } else { 7 * i % 251 }).collect();
        write_array(&mesh(tables[1]), &Array::i64(&[20, 3], own), Storage::Contiguous, &[]).unwrap();
        let (exposures, _) = expose_camera(&dataset, "room", "cam_00", &[0, 1]).unwrap();
        preview_camera(&dataset, ["room", "cam_00"], &[0, 1], &exposures, &BTreeSet::new(), &Quiet).unwrap();
        for (layer, name, table) in
            [(Layer::Semantic, "semantic.png", tables[0]), (Layer::SemanticInstance, "semantic_instance.png", tables[1])]
        {
            let picture =
                image::open(dataset.layout().preview("room", "cam_00", 0, enfilade_frame::Pass::Geometry, name)).unwrap().into_rgb8();
            let Elements::I64(colors) = read_array(&mesh(table)).unwrap().values else { panic!("{table} has int64") };
            let numbers = dataset.read_layer("room", "cam_00", 0, layer).unwrap();
            let mut known = BTreeSet::new();
            for (i, pixel) in picture.pixels().enumerate() {
                let number = numbers.get(i) as i16;
                let expected = if number < 1 { [0; 3] } else { [0, 1, 2].map(|c| colors[3 * number as usize + c] as u8) };
                assert_eq!(pixel.0, expected, "{name}: number {number}");
                known.insert(number);
            }
            assert!(known.len() > 1, "{name}: {known:?}");
        }
    }

    #[test]
    fn pictures_follow_from_radiance_by_the_stored_exposures() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let (exposures, _) = expose_camera(&dataset, "room", "cam_00", &[0, 1]).unwrap();
        preview_camera(&dataset, ["room", "cam_00"], &[0, 1], &exposures, &BTreeSet::new(), &Quiet).unwrap();
        let color = dataset.read_layer("room", "cam_00", 1, Layer::Color).unwrap();
        let row = dataset.read_tone_maps("room", "cam_00").unwrap()[1];
        let picture =
            |name| image::open(dataset.layout().preview("room", "cam_00", 1, enfilade_frame::Pass::Final, name)).unwrap().into_rgb8();
        let close = |picture: image::RgbImage, shown: &dyn Fn([f64; 3]) -> [f64; 3]| {
            let radiance = |i: usize| [0, 1, 2].map(|c| color.get(3 * i + c));
            let near = |(i, pixel): (usize, &image::Rgb<u8>)| {
                shown(radiance(i)).iter().zip(pixel.0).all(|(v, byte)| (v * 255.0 - f64::from(byte)).abs() < 13.0)
            };
            picture.pixels().enumerate().filter(|pixel| near(*pixel)).count() as f64 / f64::from(picture.width() * picture.height())
        };
        let tone = ToneMap { scale: row.scale };
        let display = Display { scale: row.display_scale, white: row.display_white };
        assert!(close(picture("tonemap.jpg"), &|v| v.map(|v| tone.apply(v))) > 0.9);
        assert!(close(picture("display.jpg"), &|v| display.apply(v)) > 0.9);
    }

    #[test]
    fn a_pixel_is_reported_with_names_and_a_missing_frame_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let report = inspect_pixel(&dataset, "room", "cam_00", 0, [5, 45]).unwrap();
        assert_eq!((report.part.as_deref(), report.class.as_deref()), (Some("floor"), Some("floor")));
        let error = inspect_pixel(&dataset, "room", "cam_00", 7, [0, 0]).unwrap_err().to_string();
        assert_eq!(error, "room/cam_00 has no frame 7; its frames: 2 from 0 to 1");
        assert!(inspect_pixel(&dataset, "room", "cam_00", 0, [64, 0]).unwrap_err().to_string().contains("outside of the image"));
        std::fs::remove_file(dataset.layout().layer("room", "cam_00", 0, Layer::NormalCam)).unwrap();
        let error = inspect_pixel(&dataset, "room", "cam_00", 0, [5, 45]).unwrap_err().to_string();
        assert!(error.contains("frame.0000.normal_cam.hdf5") && error.contains("render the frame again"), "{error}");
    }
}
