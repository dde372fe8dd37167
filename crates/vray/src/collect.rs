//! V-Ray's images as the frames of a dataset.

use crate::camera::{CameraWish, check_described, filmed_camera, wished_camera};
use crate::color::add_colors;
use crate::entities::Entities;
use crate::error::VrayError;
use crate::exr_file::VrayImage;
use crate::geometry::{Placed, add_geometry};
use crate::header::Expected;
use crate::notes::Notes;
use crate::rays::Sight;
use enfilade_dataset::{
    CameraRecord, Dataset, DatasetError, FrameInfo, FrameTime, ManifestInfo, Recipe, WORKDIR, WorkLock, counted, refuse_newer_layout,
    remove_if_there,
};
use enfilade_frame::Frame;
use enfilade_scene::{Camera, Cx, Pose};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};

/// Raised when the same images give other frames.
const VERSION: u32 = 2;

/// The images that become frames of a camera.
#[derive(Clone, Debug)]
pub struct CollectConfig {
    /// Name of the scene in the dataset.
    pub scene: String,
    /// Name of the camera, which has a trajectory.
    pub camera: String,
    /// Folder of the geometry pass: `*.IIII.exr`.
    pub geometry: PathBuf,
    /// Folder of the final pass, likewise.
    pub beauty: PathBuf,
    /// Table of the nodes of V-Ray's scene, as `metadata_nodes.csv`; `None`: the dataset's own.
    pub nodes: Option<PathBuf>,
    /// Metres per unit of V-Ray's scene.
    pub meters_per_unit: f64,
    /// The camera that was rendered, where it is not the dataset's own.
    pub wish: CameraWish,
    /// A camera in an image's header that is not the trajectory's, or positions that are not on its rays, are a warning.
    pub ignore_camera: bool,
    /// Read images again whose frames exist.
    pub force: bool,
}

/// Result of collecting images.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Collected {
    /// Frames that were written.
    pub written: usize,
    /// Frames that were there already, of the same images.
    pub kept: usize,
    /// Frames of the trajectory that have no image.
    pub missing: Vec<u32>,
}

/// Reads V-Ray's images of a camera and writes them as frames of the dataset at `root`, as our own renderer does.
///
/// # Errors
/// When the dataset or an image cannot be read, an image is not of the camera, only one pass of a frame is there, or a file cannot be
/// written. Frames that were written before stay.
pub fn collect(root: &Path, config: &CollectConfig, cx: &dyn Cx) -> Result<Collected, VrayError> {
    if !(config.meters_per_unit.is_finite() && config.meters_per_unit > 0.0) {
        return Err(VrayError::usage(format!("{} metres per unit is no scale", config.meters_per_unit), "name the scene's meters_scale"));
    }
    let dataset = Dataset::open(root)?;
    refuse_newer_layout(root)?;
    let _lock = root.join(WORKDIR).is_dir().then(|| WorkLock::take(root)).transpose()?;
    let source = Source::read(&dataset, config)?;
    let images = source.images(config)?;
    let (mut done, mut notes) = (Collected::default(), Notes::default());
    for (at, pose) in source.poses.iter().enumerate() {
        cx.progress("frames", at as u64, source.poses.len() as u64);
        match images.get(&pose.frame) {
            None => done.missing.push(pose.frame),
            Some(paths) => match source.frame(&dataset, config, pose, paths, &mut notes)? {
                true => done.written += 1,
                false => done.kept += 1,
            },
        }
    }
    notes.tell(cx);
    if done.written > 0 {
        refresh(&dataset, &config.scene)?;
    }
    Ok(done)
}

/// Everything needed to read the images of a camera.
struct Source {
    camera: Camera,
    /// Field of view of the pinhole in V-Ray's scene.
    fov_x_deg: f64,
    poses: Vec<Pose>,
    entities: Entities,
    meters_in_dataset: f64,
}

/// The two images of a frame.
struct Images {
    geometry: PathBuf,
    beauty: PathBuf,
}

impl Source {
    fn read(dataset: &Dataset, config: &CollectConfig) -> Result<Self, VrayError> {
        let (scene, name) = (&config.scene, &config.camera);
        let filmed = filmed_camera(dataset, scene, name, config.meters_per_unit, &config.wish)?;
        let camera = wished_camera(dataset, scene, name, &config.wish)?;
        if !check_described(dataset, scene, name, &config.wish)? {
            if !camera.projection.is_linear() {
                let message = format!("the dataset says nothing of the camera {name}, and its table of cameras holds no grid of rays");
                return Err(VrayError::usage(message, "plan the dataset with that camera"));
            }
            dataset.write_camera_parameters(scene, &camera)?;
        }
        let entities = Entities::read(dataset, scene, config.nodes.as_deref())?;
        let poses = dataset.read_trajectory(scene, name)?.poses;
        let rejected = dataset.rejected_views(scene, name)?;
        let meters_in_dataset = match dataset.meters_per_asset_unit(scene) {
            Err(error) if error.is_not_found() => 1.0,
            meters => meters?,
        };
        Ok(Self {
            camera,
            fov_x_deg: filmed.path.fov_x_rad.to_degrees(),
            poses: poses.into_iter().filter(|pose| !rejected.contains_key(&pose.frame)).collect(),
            entities,
            meters_in_dataset,
        })
    }

    /// The images of both passes by frame.
    fn images(&self, config: &CollectConfig) -> Result<BTreeMap<u32, Images>, VrayError> {
        let (geometry, mut beauty) = (numbered(&config.geometry)?, numbered(&config.beauty)?);
        let mut images = BTreeMap::new();
        for (frame, path) in geometry {
            let Some(other) = beauty.remove(&frame) else { return Err(alone(&path, "final", &config.beauty)) };
            if !self.poses.iter().any(|pose| pose.frame == frame) {
                return Err(VrayError::usage(
                    format!("{}: the trajectory of {} has no frame {frame} that is worth rendering", path.display(), config.camera),
                    "move the image away, or name its camera",
                ));
            }
            images.insert(frame, Images { geometry: path, beauty: other });
        }
        match beauty.values().next() {
            Some(path) => Err(alone(path, "geometry", &config.geometry)),
            None => Ok(images),
        }
    }

    /// Writes a frame; false when it is there already.
    fn frame(&self, dataset: &Dataset, config: &CollectConfig, pose: &Pose, paths: &Images, notes: &mut Notes) -> Result<bool, VrayError> {
        let content = [hash_of_file(&paths.geometry)?, hash_of_file(&paths.beauty)?];
        let hash = self.hash(config, pose, &content);
        if !config.force && dataset.frame_is_complete(&config.scene, &config.camera, pose.frame, &hash) {
            return Ok(false);
        }
        let [width, height] = self.camera.size();
        let mut frame = Frame::new(width, height);
        let expected = Expected { pose, fov_x_deg: self.fov_x_deg, meters_per_unit: config.meters_per_unit };
        let open = |path: &Path, notes: &mut Notes| {
            let image = VrayImage::read(path, [width, height])?;
            image.header.check(&expected, &image.name(), config.ignore_camera, notes)?;
            Ok::<_, VrayError>(image)
        };
        let image = open(&paths.geometry, notes)?;
        let (meters_per_unit, meters_in_dataset) = (config.meters_per_unit, self.meters_in_dataset);
        add_geometry(&mut frame, &image, &Placed { pose, meters_per_unit, meters_in_dataset, entities: &self.entities }, notes)?;
        let sight = Sight { projection: &self.camera.projection, pose, meters_per_unit: meters_in_dataset };
        sight.check(&frame, &image.name(), config.ignore_camera, notes)?;
        let geometry_s = image.header.rendering_s.unwrap_or(0.0);
        drop(image);
        let image = open(&paths.beauty, notes)?;
        add_colors(&mut frame, &image, notes)?;
        let info = FrameInfo {
            seed: 0,
            samples: 0,
            config_hash: hash,
            pose: *pose,
            camera: self.camera.clone(),
            sampling: None,
            recipe: Some(recipe(config, &content, image.header.version.as_deref())),
        };
        let wall_s = geometry_s + image.header.rendering_s.unwrap_or(0.0);
        let time = FrameTime { wall_s, ..FrameTime::default() };
        dataset.write_frame(&config.scene, &config.camera, &frame, &info, time)?;
        Ok(true)
    }

    /// Names everything that a frame's values depend on.
    fn hash(&self, config: &CollectConfig, pose: &Pose, content: &[String; 2]) -> String {
        let camera = CameraRecord::from(&self.camera);
        hash_of(&("vray", VERSION, content, config.meters_per_unit, self.meters_in_dataset, camera, pose, self.entities.parts()))
    }
}

/// The origin of the frame, for its record. No program can render it again from that.
fn recipe(config: &CollectConfig, [geometry, beauty]: &[String; 2], version: Option<&str>) -> Recipe {
    Recipe {
        program: format!("V-Ray {}", version.unwrap_or("of unknown version")),
        render_version: VERSION,
        scene_blake3: String::new(),
        settings: serde_json::json!({
            "geometry_exr_blake3": geometry, "final_exr_blake3": beauty, "meters_per_unit": config.meters_per_unit,
        }),
        time_limit_s: None,
    }
}

/// The BLAKE3 hash of plain data, by its JSON text, as the stages of our own renderer have it.
fn hash_of(value: &impl Serialize) -> String {
    // Plain data of ours always has a JSON text; were it not so, an empty text would only cause work to be redone.
    blake3::hash(&serde_json::to_vec(value).unwrap_or_default()).to_hex().to_string()
}

/// The BLAKE3 hash of a file's content.
fn hash_of_file(path: &Path) -> Result<String, VrayError> {
    let unreadable = |source| DatasetError::Io { action: "read", path: path.to_path_buf(), source };
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(File::open(path).map_err(unreadable)?).map_err(unreadable)?;
    Ok(hasher.finalize().to_hex().to_string())
}

/// The images of a folder by the number before `.exr`.
fn numbered(folder: &Path) -> Result<BTreeMap<u32, PathBuf>, VrayError> {
    let unreadable = |e: std::io::Error| {
        VrayError::usage(format!("cannot read the folder {}: {e}", folder.display()), "name the folder with the pass's .exr files")
    };
    let mut images: BTreeMap<u32, PathBuf> = BTreeMap::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        let Some(frame) = path.file_name().and_then(|name| number(&name.to_string_lossy())) else { continue };
        if let Some(other) = images.insert(frame, path.clone()) {
            let (a, b) = if other < path { (other, path) } else { (path, other) };
            return Err(VrayError::usage(
                format!("{} and {} are both frame {frame}", a.display(), b.display()),
                "keep the images of each camera and pass in a folder of their own",
            ));
        }
    }
    if images.is_empty() {
        let message = format!("{} has no images named *.0000.exr", folder.display());
        return Err(VrayError::usage(message, "convert V-Ray's: vrimg2exr FILE.vrimg FILE.exr"));
    }
    Ok(images)
}

/// The number of `frame.0012.exr`.
fn number(name: &str) -> Option<u32> {
    let stem = name.strip_suffix(".exr").or_else(|| name.strip_suffix(".EXR"))?;
    let digits = stem.len() - stem.trim_end_matches(|c: char| c.is_ascii_digit()).len();
    stem[stem.len() - digits..].parse().ok()
}

fn alone(path: &Path, pass: &str, folder: &Path) -> VrayError {
    VrayError::usage(
        format!("{} has no image of the {pass} pass in {}", path.display(), folder.display()),
        "render both passes of a frame, or move the image away until then",
    )
}

/// Updates the manifest for the new frames, and removes the verification report and its page, which described the dataset before.
fn refresh(dataset: &Dataset, scene: &str) -> Result<(), VrayError> {
    let old = dataset.read_manifest()?;
    let mut info = ManifestInfo::default();
    if let Some(old) = old {
        info.failed_scenes = old.scenes.into_iter().filter_map(|(name, entry)| Some((name, entry.failed?))).collect();
        info.failed_scenes.remove(scene);
        (info.config, info.seeds) = (old.config, old.seeds);
    }
    let manifest = dataset.collect_manifest(&info)?;
    dataset.write_manifest(&manifest)?;
    Ok([dataset.layout().verify_report(), dataset.layout().verify_page()].iter().try_for_each(|path| remove_if_there(path))?)
}

impl Collected {
    /// One line.
    pub fn summary(&self) -> String {
        let kept = if self.kept > 0 { format!(", {} kept", self.kept) } else { String::new() };
        let missing = match self.missing.first() {
            Some(first) => format!("; {} of the trajectory have no image, frame {first} first", self.missing.len()),
            None => String::new(),
        };
        format!("{} written{kept}{missing}", counted(self.written, "frame"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_numbered_by_what_stands_before_exr() {
        assert_eq!(number("frame.0012.exr"), Some(12));
        assert_eq!(number("room_v2_0007.EXR"), Some(7));
        assert_eq!((number("frame.exr"), number("frame.0012.vrimg"), number("frame.99999999999.exr")), (None, None, None));
    }
}
