//! Every path of the tree, in one place. Nothing here touches the disk.
//!
//! The tree is Hypersim's. Ours beside it: `manifest.json`, `manifest_times.csv`, `split.json`, `verify.json`, `verify.html`,
//! `statistics/`, `sensors/`, `relit/`, `pairs.csv`, `_detail/covisibility.hdf5` with its list of frames, `_detail/metadata_fixtures.csv`,
//! `_detail/metadata_bodies.csv`, `_detail/metadata_planes.csv`, `_detail/metadata_instances.csv`, `_detail/metadata_instance_relations.csv`, `_detail/plan_preview/`,
//! `_detail/variation.json`, `_detail/gates.html`, and in each camera's `_detail` folder `metadata_view_gates.csv`, `rejected/`, `metadata_tonemap.csv`,
//! `metadata_body_poses.csv`, `metadata_frame_instances.csv`, `amodal_instances/`, `pairs/`, `surfaces/`, `planes/`, `tracks.npz`, `captions.jsonl`,
//! `questions.jsonl`, `cameras_opencv.json`, `plan_report.json`, `frames/` with the commit records, `after_frame/` with what users'
//! programs have made on a farm and, for cameras that are more than a pinhole, `camera.json` and its arrays. The layers of fixtures are
//! beside those of `scene_<camera>_final_hdf5`.

use crate::{DatasetError, FramePair};
use enfilade_frame::{Layer, Pass};
use std::path::{Path, PathBuf};

/// The layers that a fixture has a part of.
pub(crate) const FIXTURE_PARTS: [Layer; 2] = [Layer::DiffuseIllumination, Layer::Residual];

/// The pipeline's own folder within a dataset: scenes, plans, hashes of what was made from what. No part of the dataset's format.
pub const WORKDIR: &str = ".enfilade";
/// The scene package in a scene's part of that folder.
pub const SCENE_PACKAGE: &str = "scene.scene";

/// The paths of a dataset. All methods are pure functions of the root and the names.
///
/// ```
/// use enfilade_dataset::Layout;
/// use enfilade_frame::Layer;
/// use std::path::Path;
/// let layout = Layout::new("homes");
/// assert_eq!(
///     layout.layer("home_001", "cam_00", 7, Layer::DepthMeters),
///     Path::new("homes/scenes/home_001/images/scene_cam_00_geometry_hdf5/frame.0007.depth_meters.hdf5")
/// );
/// assert_eq!(layout.metadata_nodes("home_001"), Path::new("homes/scenes/home_001/_detail/metadata_nodes.csv"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    root: PathBuf,
    scenes: PathBuf,
    /// Layout for pictures, if they do not go into the dataset.
    pictures: Option<Box<Layout>>,
}

/// Characters that the name of a scene or a camera may have: files and folders are named after it with about 40 more, and file systems
/// allow 255.
const MAX_NAME: usize = 200;

/// Checks that `name` can be part of a path on every system.
///
/// # Errors
/// When it is empty, longer than 200 characters, begins with a dot, or has characters other than `a` to `z`, `A` to `Z`, digits, `_`,
/// `-` and `.`.
///
/// ```
/// use enfilade_dataset::check_name;
/// assert!(check_name("scene name", "ai_001_001").is_ok());
/// assert!(check_name("scene name", "../secrets").is_err());
/// ```
pub fn check_name(what: &'static str, name: &str) -> Result<(), DatasetError> {
    let allowed = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
    if name.is_empty() || name.len() > MAX_NAME || name.starts_with('.') || !name.chars().all(allowed) {
        return Err(DatasetError::Name { what, name: name.to_string() });
    }
    Ok(())
}

impl Layout {
    /// The toolkit's tree: scenes are under `<root>/scenes`. An empty root gives paths relative to the dataset.
    pub fn new(root: impl Into<PathBuf>) -> Self {
        let root = root.into();
        Self { scenes: root.join("scenes"), root, pictures: None }
    }

    /// The tree of Hypersim's unpacked archives: scenes are directly under the root.
    pub fn flat(root: impl Into<PathBuf>) -> Self {
        let root = root.into();
        Self { scenes: root.clone(), root, pictures: None }
    }

    /// A layout with previews, contact sheets and tables of exposures in a tree of the same form under `folder`.
    pub(crate) fn with_pictures_in(self, folder: impl Into<PathBuf>) -> Self {
        let folder = folder.into();
        let pictures = if self.scenes == self.root { Self::flat(folder) } else { Self::new(folder) };
        Self { pictures: Some(Box::new(pictures)), ..self }
    }

    /// The tree that pictures are in.
    fn of_pictures(&self) -> &Self {
        self.pictures.as_deref().unwrap_or(self)
    }

    /// The dataset's folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Everything that is known about the dataset as a whole, as JSON.
    pub fn manifest(&self) -> PathBuf {
        self.root.join("manifest.json")
    }

    /// The times of all frames: the only file that differs between two runs.
    pub fn manifest_times(&self) -> PathBuf {
        self.root.join("manifest_times.csv")
    }

    /// One row per scene: image size, units, `M_cam_from_uv`, `M_proj`.
    pub fn camera_parameters(&self) -> PathBuf {
        self.root.join("metadata_camera_parameters.csv")
    }

    /// One picture per trajectory of the whole dataset.
    pub fn overview(&self) -> PathBuf {
        self.of_pictures().root.join("contact_sheet.jpg")
    }

    /// The outcome of the last verification, as JSON.
    pub fn verify_report(&self) -> PathBuf {
        self.root.join("verify.json")
    }

    /// The report of `verify` as a page for a browser.
    pub fn verify_page(&self) -> PathBuf {
        self.root.join("verify.html")
    }

    /// The partition of images into learning, validation and testing.
    pub fn partition(&self) -> PathBuf {
        self.root.join("metadata_images_split_scene_v1.csv")
    }

    /// The kind of room that each camera goes through.
    pub fn scene_types(&self) -> PathBuf {
        self.root.join("metadata_camera_trajectories.csv")
    }

    /// The report of the partition, with the assets that are on several sides of it, as JSON.
    pub fn partition_report(&self) -> PathBuf {
        self.root.join("split.json")
    }

    /// Numbers and charts of the whole dataset, and the page `statistics.html` that shows them.
    pub fn statistics_dir(&self) -> PathBuf {
        self.root.join("statistics")
    }

    /// The numbers of the statistics, as JSON.
    pub fn statistics(&self) -> PathBuf {
        self.statistics_dir().join("statistics.json")
    }

    /// Pairs of frames that see the same surfaces, chosen among all, with the share that each sees of the other.
    pub fn pairs(&self) -> PathBuf {
        self.root.join("pairs.csv")
    }

    /// Frames relit by mixes of fixtures.
    pub fn relit_dir(&self) -> PathBuf {
        self.root.join("relit")
    }

    /// A file of a frame relit by a mix (scene, camera, number): `frame.IIII.<what>`.
    pub fn relit(&self, mix: &str, (scene, camera, frame): (&str, &str, u32), what: &str) -> PathBuf {
        self.relit_dir().join(mix).join(scene).join(camera).join(format!("frame.{frame:04}.{what}"))
    }

    /// Output of sensors.
    pub fn sensors_dir(&self) -> PathBuf {
        self.root.join("sensors")
    }

    /// The readings of one sensor.
    pub fn sensor_dir(&self, sensor: &str) -> PathBuf {
        self.sensors_dir().join(sensor)
    }

    /// The settings of a sensor.
    pub fn sensor_settings(&self, sensor: &str) -> PathBuf {
        self.sensor_dir(sensor).join("sensor.json")
    }

    /// Random values drawn for the frames of a camera.
    pub fn sensed_frames(&self, sensor: &str, scene: &str, camera: &str) -> PathBuf {
        self.sensor_dir(sensor).join(scene).join(camera).join("metadata_sensed_frames.csv")
    }

    /// Output of a sensor for a frame (scene, camera, number): `frame.IIII.<what>`.
    pub fn sensed(&self, sensor: &str, (scene, camera, frame): (&str, &str, u32), what: &str) -> PathBuf {
        self.sensor_dir(sensor).join(scene).join(camera).join(format!("frame.{frame:04}.{what}"))
    }

    /// The scene that frames were rendered from, as a package in the work folder; only where the dataset was made here.
    pub fn scene_package(&self, scene: &str) -> PathBuf {
        self.root.join(WORKDIR).join(scene).join(SCENE_PACKAGE)
    }

    /// The folder of the scenes.
    pub fn scenes_dir(&self) -> &Path {
        &self.scenes
    }

    /// A scene's folder.
    pub fn scene_dir(&self, scene: &str) -> PathBuf {
        self.scenes.join(scene)
    }

    /// Everything about a scene but its images.
    pub fn detail_dir(&self, scene: &str) -> PathBuf {
        self.scene_dir(scene).join("_detail")
    }

    /// Metres per asset unit.
    pub fn metadata_scene(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("metadata_scene.csv")
    }

    /// The names of the scene's cameras.
    pub fn metadata_cameras(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("metadata_cameras.csv")
    }

    /// Render entities and the objects they belong to.
    pub fn metadata_nodes(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("metadata_nodes.csv")
    }

    /// Materials, as the `material_id` layer numbers them.
    pub fn metadata_materials(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("metadata_materials.csv")
    }

    /// What moves in the scene, if anything does.
    pub fn metadata_bodies(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("metadata_bodies.csv")
    }

    /// The places of what moves, in the frames of a camera.
    pub fn metadata_body_poses(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("metadata_body_poses.csv")
    }

    /// The fixtures that light the scene, if frames have the light of each apart.
    pub fn metadata_fixtures(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("metadata_fixtures.csv")
    }

    /// The share of each frame's surfaces that each other frame of the scene sees.
    pub fn covisibility(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("covisibility.hdf5")
    }

    /// The frames of its rows and columns.
    pub fn covisibility_frames(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("covisibility_frames.csv")
    }

    /// Descriptions of the scene's instances.
    pub fn described_instances(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("metadata_instances.csv")
    }

    /// Relations between the scene's instances.
    pub fn instance_relations(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("metadata_instance_relations.csv")
    }

    /// Captions of a camera's frames.
    pub fn captions(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("captions.jsonl")
    }

    /// Questions about a camera's frames.
    pub fn questions(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("questions.jsonl")
    }

    /// A camera's trajectory and records.
    pub fn camera_dir(&self, scene: &str, camera: &str) -> PathBuf {
        self.detail_dir(scene).join(camera)
    }

    /// One array of the trajectory: `frame_indices`, `positions`, `look_at_positions` or `orientations`.
    pub fn keyframes(&self, scene: &str, camera: &str, what: &str) -> PathBuf {
        self.camera_dir(scene, camera).join(format!("camera_keyframe_{what}.hdf5"))
    }

    /// Seconds between frames.
    pub fn metadata_camera(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("metadata_camera.csv")
    }

    /// K and 4×4 poses in OpenCV's axes.
    pub fn cameras_opencv(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("cameras_opencv.json")
    }

    /// Report of the trajectory: values per frame, rejected candidates, coverage. Only if it was planned here; for a stereo rig at the left
    /// camera.
    pub fn plan_report(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("plan_report.json")
    }

    /// The camera in full, where it is more than a pinhole in focus and at rest, or one of a stereo rig.
    pub fn camera_model(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("camera.json")
    }

    /// The ray of every pixel, for cameras that no matrix describes.
    pub fn camera_rays(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("camera_rays.hdf5")
    }

    /// A camera that is a grid of rays, in the form and under the name of Hypersim's toolkit.
    pub fn camera_ray_grid(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("camera_lens_distortion.hdf5")
    }

    /// `positions` or `orientations` of the camera by frame and row, where the shutter rolls.
    pub fn camera_rows(&self, scene: &str, camera: &str, what: &str) -> PathBuf {
        self.camera_dir(scene, camera).join(format!("camera_row_{what}.hdf5"))
    }

    /// The commit records of a camera's frames.
    pub fn records_dir(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("frames")
    }

    /// The commit record of a frame: without it the frame does not count.
    pub fn frame_record(&self, scene: &str, camera: &str, frame: u32) -> PathBuf {
        self.records_dir(scene, camera).join(format!("frame.{frame:04}.json"))
    }

    /// The commit record of a frame's label layers.
    pub fn label_record(&self, scene: &str, camera: &str, frame: u32) -> PathBuf {
        self.records_dir(scene, camera).join(format!("frame.{frame:04}.labels.json"))
    }

    /// Views of a planned camera in each pose, coloured by part: small pictures for people.
    pub fn plan_views_dir(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("preview")
    }

    /// The plan view of a frame, under the toolkit's name.
    pub fn plan_view(&self, scene: &str, camera: &str, frame: u32) -> PathBuf {
        self.plan_views_dir(scene, camera).join(format!("frame.{frame:04}.jpg"))
    }

    /// Drawings of the scene's free space and trajectories, and the page `index.html` that shows them.
    pub fn plan_preview_dir(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("plan_preview")
    }

    /// The verdicts on which views of a camera are worth rendering.
    pub fn view_gates(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("metadata_view_gates.csv")
    }

    /// Pictures of the geometry of the views of a camera that were not, for people.
    pub fn rejected_dir(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("rejected")
    }

    /// The picture of a rejected view.
    pub fn rejected_view(&self, scene: &str, camera: &str, frame: u32) -> PathBuf {
        self.rejected_dir(scene, camera).join(format!("frame.{frame:04}.jpg"))
    }

    /// The page that shows all of them.
    pub fn gates_page(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("gates.html")
    }

    /// Tone mapping from radiance to the 8-bit pictures of each frame of a camera.
    pub fn tone_maps(&self, scene: &str, camera: &str) -> PathBuf {
        self.of_pictures().camera_dir(scene, camera).join("metadata_tonemap.csv")
    }

    /// The folder of the animations, unless another is named.
    pub fn animations_dir(&self) -> PathBuf {
        self.root.join("animations")
    }

    /// Visibility of each instance in each frame of a camera.
    pub fn frame_instances(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("metadata_frame_instances.csv")
    }

    /// The amodal masks of a camera's frames.
    pub fn amodal_masks_dir(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("amodal_instances")
    }

    /// The amodal masks of a frame.
    pub fn amodal_masks(&self, scene: &str, camera: &str, frame: u32) -> PathBuf {
        self.amodal_masks_dir(scene, camera).join(format!("frame.{frame:04}.json"))
    }

    /// Layers that lead from a camera's frames to any others of the scene.
    pub fn pair_layers_dir(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("pairs")
    }

    /// A layer that leads from the first frame of a pair to the second: `frame.IIII.<second camera>.frame.JJJJ.<layer>.hdf5`.
    pub fn pair_layer(&self, pair: &FramePair, layer: Layer) -> PathBuf {
        let FramePair { scene, first: (camera, frame), second: (other, number) } = pair;
        let name = format!("frame.{frame:04}.{other}.{}", layer_file_name(*number, layer));
        self.pair_layers_dir(scene, camera).join(name)
    }

    /// Surfaces along the rays of a camera's frames.
    pub fn surfaces_dir(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("surfaces")
    }

    /// Properties of the surfaces along the rays of a frame: `frame.IIII.<what>.hdf5`.
    pub fn surfaces(&self, scene: &str, camera: &str, frame: u32, what: &str) -> PathBuf {
        self.surfaces_dir(scene, camera).join(format!("frame.{frame:04}.{what}.hdf5"))
    }

    /// The planes of the scene's rooms that a camera's frames show.
    pub fn planes_dir(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("planes")
    }

    /// The plane of the scene's rooms that each pixel of a frame shows.
    pub fn plane_ids(&self, scene: &str, camera: &str, frame: u32) -> PathBuf {
        self.planes_dir(scene, camera).join(format!("frame.{frame:04}.plane_id.hdf5"))
    }

    /// Points on surfaces, followed through a camera's frames.
    pub fn tracks(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("tracks.npz")
    }

    /// Output of the user's program for a camera's frames on the nodes of a farm.
    pub fn after_frame_dir(&self, scene: &str, camera: &str) -> PathBuf {
        self.camera_dir(scene, camera).join("after_frame")
    }

    /// Output of the user's program for a frame: a folder with all files that it has left.
    pub fn after_frame(&self, scene: &str, camera: &str, frame: u32) -> PathBuf {
        self.after_frame_dir(scene, camera).join(format!("frame.{frame:04}"))
    }

    /// Rooms, walls, doors and windows of the scene, where they are known.
    pub fn rooms(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("layout.json")
    }

    /// The rooms of a scene as a drawing.
    pub fn rooms_drawing(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("layout.svg")
    }

    /// What the scene differs in from the one that it varies.
    pub fn variation(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("variation.json")
    }

    /// The objects that were placed in the scene.
    pub fn placed_objects(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("placed_objects.json")
    }

    /// The planes of the rooms, to which pixels are assigned.
    pub fn plane_table(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("metadata_planes.csv")
    }

    /// Geometry, objects and labels of the scene.
    pub fn mesh_dir(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("mesh")
    }

    /// A file of the mesh folder; [`crate::mesh_names`] has the names.
    pub fn mesh_file(&self, scene: &str, name: &str) -> PathBuf {
        self.mesh_dir(scene).join(name)
    }

    /// Free space.
    pub fn octomap_dir(&self, scene: &str) -> PathBuf {
        self.detail_dir(scene).join("octomap")
    }

    /// The occupancy tree in OctoMap's binary format.
    pub fn octomap(&self, scene: &str) -> PathBuf {
        self.octomap_dir(scene).join("octomap.bt")
    }

    /// Smallest centre of a free voxel, per axis.
    pub fn octomap_free_space_min(&self, scene: &str) -> PathBuf {
        self.octomap_dir(scene).join("octomap_free_space_min.hdf5")
    }

    /// Largest centre of a free voxel, per axis.
    pub fn octomap_free_space_max(&self, scene: &str) -> PathBuf {
        self.octomap_dir(scene).join("octomap_free_space_max.hdf5")
    }

    /// All pictures of a scene.
    pub fn images_dir(&self, scene: &str) -> PathBuf {
        self.scene_dir(scene).join("images")
    }

    /// The arrays of one pass of a camera. Label layers are with the geometry.
    pub fn layer_dir(&self, scene: &str, camera: &str, pass: Pass) -> PathBuf {
        self.images_dir(scene).join(format!("scene_{camera}_{}_hdf5", pass_name(pass)))
    }

    /// One layer of a frame.
    pub fn layer(&self, scene: &str, camera: &str, frame: u32, layer: Layer) -> PathBuf {
        let spec = layer.spec();
        self.layer_dir(scene, camera, spec.pass).join(layer_file_name(frame, layer))
    }

    /// The part of a layer of a frame that comes from one fixture.
    pub fn fixture_layer(&self, scene: &str, camera: &str, frame: u32, fixture: u32, layer: Layer) -> PathBuf {
        let spec = layer.spec();
        self.layer_dir(scene, camera, spec.pass).join(format!("frame.{frame:04}.fixture_{fixture:02}_{}.hdf5", spec.name))
    }

    /// The previews of one pass of a camera.
    pub fn preview_dir(&self, scene: &str, camera: &str, pass: Pass) -> PathBuf {
        self.of_pictures().images_dir(scene).join(format!("scene_{camera}_{}_preview", pass_name(pass)))
    }

    /// One preview: `frame.IIII.<name>`, where `name` has its extension, as in `tonemap.jpg`.
    pub fn preview(&self, scene: &str, camera: &str, frame: u32, pass: Pass, name: &str) -> PathBuf {
        self.preview_dir(scene, camera, pass).join(format!("frame.{frame:04}.{name}"))
    }

    /// All frames of a camera at a glance.
    pub fn contact_sheet(&self, scene: &str, camera: &str) -> PathBuf {
        self.of_pictures().images_dir(scene).join(format!("scene_{camera}_contact_sheet.jpg"))
    }
}

/// `frame.IIII.<layer>.hdf5`.
pub(crate) fn layer_file_name(frame: u32, layer: Layer) -> String {
    format!("frame.{frame:04}.{}.hdf5", layer.spec().name)
}

fn pass_name(pass: Pass) -> &'static str {
    match pass {
        Pass::Final | Pass::Rendered | Pass::Guides | Pass::LightParts => "final",
        Pass::Geometry | Pass::Label | Pass::Extra => "geometry",
    }
}

/// The camera whose layers are in a folder of this name; `None` for other folders, such as those of previews.
pub(crate) fn camera_of_layer_dir(name: &str) -> Option<&str> {
    let rest = name.strip_prefix("scene_")?.strip_suffix("_hdf5")?;
    let camera = [Pass::Final, Pass::Geometry].iter().find_map(|&pass| rest.strip_suffix(pass_name(pass))?.strip_suffix('_'))?;
    Some(camera).filter(|camera| !camera.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_hypersims() {
        let layout = Layout::new("d");
        let layer = |layer| layout.layer("ai_001_001", "cam_00", 7, layer);
        assert_eq!(layer(Layer::Color), Path::new("d/scenes/ai_001_001/images/scene_cam_00_final_hdf5/frame.0007.color.hdf5"));
        let geometry = "d/scenes/ai_001_001/images/scene_cam_00_geometry_hdf5";
        assert_eq!(layer(Layer::DepthMeters), Path::new(geometry).join("frame.0007.depth_meters.hdf5"));
        assert_eq!(layer(Layer::Semantic), Path::new(geometry).join("frame.0007.semantic.hdf5"));
        assert_eq!(layout.keyframes("s", "cam_01", "positions"), Path::new("d/scenes/s/_detail/cam_01/camera_keyframe_positions.hdf5"));
        assert_eq!(
            layout.preview("s", "cam_00", 12, Pass::Final, "tonemap.jpg"),
            Path::new("d/scenes/s/images/scene_cam_00_final_preview/frame.0012.tonemap.jpg")
        );
        assert_eq!(Layout::flat("d").metadata_scene("s"), Path::new("d/s/_detail/metadata_scene.csv"));
        assert_eq!(Layout::new("").metadata_scene("s"), Path::new("scenes/s/_detail/metadata_scene.csv"));
    }

    #[test]
    fn names_that_leave_their_folder_are_refused() {
        for good in ["ai_001_001", "grey-white-room", "v1.2"] {
            check_name("scene name", good).unwrap();
        }
        let (longest, longer) = ("n".repeat(200), "n".repeat(201));
        check_name("scene name", &longest).unwrap();
        for bad in ["", ".", "..", ".hidden", "a/b", "a\\b", "my room", "küche", &longer] {
            let message = check_name("scene name", bad).unwrap_err().to_string();
            assert!(message.starts_with(&format!("scene name {bad:?}")), "{message}");
        }
    }
}
