//! `manifest.json`: the description of the dataset, how to read it, and the state of every frame.

use crate::camera_files::optional;
use crate::frames::read_json;
use crate::layout_version::format;
use crate::{ColorKind, Dataset, DatasetError, FileRecord, ViewFault, refuse_newer_layout, write_json};
use enfilade_frame::{Dtype, LAYERS, LayerSpec, Pass};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The manifest. The same dataset always gives the same bytes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// `enfilade dataset 1`, with the number of [`crate::LAYOUT_VERSION`]. It is the first value in the manifests of all versions.
    pub format: String,
    /// Version of the program that wrote it.
    pub enfilade_version: String,
    /// How to read the files.
    pub conventions: Conventions,
    /// The resolved configuration of the run.
    pub config: serde_json::Value,
    /// Seeds by what they are for.
    pub seeds: BTreeMap<String, u64>,
    /// By name.
    pub scenes: BTreeMap<String, SceneEntry>,
}

/// Units, axes and layers in words.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conventions {
    /// One sentence per subject.
    pub notes: BTreeMap<String, String>,
    /// The table of layers.
    pub layers: Vec<LayerEntry>,
}

/// A row of the table of layers, as in [`LayerSpec`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "plain words")]
pub struct LayerEntry {
    pub name: String,
    pub pass: Pass,
    pub channels: usize,
    pub dtype: Dtype,
    pub unit: String,
    pub space: String,
    pub sentinel: String,
    pub description: String,
}

/// A scene of the manifest.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneEntry {
    /// Why the scene is not finished; absent when nothing went wrong.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
    /// By name.
    pub cameras: BTreeMap<String, CameraEntry>,
}

/// A camera of the manifest.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CameraEntry {
    /// Every frame of the trajectory, in order.
    pub frames: Vec<FrameEntry>,
}

/// The state of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FrameStatus {
    /// In the trajectory, not rendered yet.
    Planned,
    /// Rendered; its files are listed.
    Complete,
    /// The frame could not be rendered; the reason is given.
    Failed,
    /// Not worth rendering; the reason is given.
    Rejected,
}

/// A frame of the manifest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrameEntry {
    /// Frame number.
    pub frame: u32,
    /// State of the frame.
    pub status: FrameStatus,
    /// Why it failed, or was rejected.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Seed of the random numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Hash of everything that the frame's values depend on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub config_hash: Option<String>,
    /// Kind of `color`, `diffuse_illumination` and `residual`; absent if there is no frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<ColorKind>,
    /// The program that denoised them, with its version; absent where they are as they were rendered.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub denoiser: Option<String>,
    /// Layer files, labels included, by path relative to the scene's folder.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub files: BTreeMap<String, FileRecord>,
}

/// Information that only the pipeline has, not the files.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ManifestInfo {
    /// The resolved configuration of the run, without anything that differs between two runs.
    pub config: serde_json::Value,
    /// Seeds by what they are for.
    pub seeds: BTreeMap<String, u64>,
    /// Why a scene failed, by scene.
    pub failed_scenes: BTreeMap<String, String>,
    /// Why a frame failed, by scene, camera and frame number.
    pub failed_frames: BTreeMap<(String, String, u32), String>,
}

/// How to read the files, in one sentence per subject.
const NOTES: [(&str, &str); 19] = [
    ("layout", "Hypersim's tree: scenes/<scene>/_detail and scenes/<scene>/images/scene_<camera>_{final,geometry}_hdf5."),
    ("world", "Right-handed, z up, metres; one asset unit is one metre (meters_per_asset_unit = 1)."),
    ("camera", "Axes x right, y up, z backward; camera_keyframe_orientations hold world_from_camera and act on column vectors."),
    (
        "cameras",
        "Where _detail/<camera>/camera.json is there, it describes the camera (distortion, panorama, lens, shutter, stereo partner). \
            position = camera centre + depth_meters * (world_from_camera ray), with the rays of camera_rays.hdf5 where that is there; \
            depth_z_meters is minus the camera-space z, negative behind a camera that sees there. Blur and motion are in the final \
            layers alone: geometry is through the lens's centre, in the middle of the exposure of the pixel's row.",
    ),
    ("opencv", "_detail/<camera>/cameras_opencv.json has K and world_from_camera with x right, y down, z forward, in metres."),
    ("pixels", "Row 0 is the top; the ray of pixel (row i, column j) is M_cam_from_uv (u, v, 1), u = -1 + (2j+1)/W, v = 1 - (2i+1)/H."),
    (
        "fixtures",
        "Where _detail/metadata_fixtures.csv is there, frames may have fixture_NN_diffuse_illumination and fixture_NN_residual: over all fixtures \
            diffuse_reflectance * diffuse_illumination + residual sums to color as it was rendered.",
    ),
    (
        "words",
        "Where _detail/metadata_instances.csv is there, it says what each instance is, metadata_instance_relations.csv how they stand to each \
            other (lengths in metres), and captions.jsonl and questions.jsonl of each camera put it into words.",
    ),
    ("sampling", "Final layers are filtered over the pixel; geometry and label layers are point samples at pixel centres."),
    (
        "identity",
        "color = diffuse_reflectance * diffuse_illumination + residual, evaluated in float32, rounded to float16, to the last bit.",
    ),
    (
        "denoised",
        "A frame's entry and record say whether color, diffuse_illumination and residual are rendered (unbiased, noisy) or denoised (a biased \
         estimate without noise, made with exact reflectance and normals as guides); the identity holds for both. Where they are denoised, \
         layers named *_rendered are what was rendered, if it is kept; color_standard_error and the parts of light belong to those.",
    ),
    (
        "noise",
        "color_standard_error is the standard error of color's luminance. A frame's record says how many samples were taken \
         (samples_taken), how much noise is left, and what ended it; one that a time limit ended (stopped_by) is not the same twice.",
    ),
    (
        "splits",
        "Where they were asked for, diffuse_direct, diffuse_indirect, specular, transmission and emission sum to color, and so do the \
         four light_* layers, within the rounding of float16 (a 500th) and where nothing is saturated.",
    ),
    ("ids", "render_entity_id is node_id of metadata_nodes.csv; object_id there is the row of the mesh folder's object tables."),
    (
        "boxes",
        "Row i of _detail/mesh/metadata_semantic_instance_bounding_box_* is instance i; +infinity where there is none. The columns of an \
         orientation are the directions of the sides: world = position + orientation * box, |box| <= extents / 2. \
         _detail/<camera>/metadata_frame_instances.csv has 2D boxes (pixel borders), pixel counts, visibility and truncation by frame; \
         amodal_instances/ beside it the masks of whole objects as COCO's run lengths.",
    ),
    (
        "gates",
        "_detail/<camera>/metadata_view_gates.csv says which views were found worth rendering; those rejected keep their poses and \
         numbers, have no images, and are shown in _detail/gates.html.",
    ),
    (
        "many_views",
        "`enfilade make` adds to frames. pairs: _detail/covisibility.hdf5 (float32, frames x frames) has in row i, column j the share of frame i's \
         surface pixels whose surface frame j sees, 0 to 1; covisibility_frames.csv beside it lists the frames and what told that something is \
         hidden; pairs.csv has chosen pairs with baseline_m between the camera centres and angle_deg between the viewing axes. flow: \
         _detail/<camera>/pairs/ has optical_flow (px), scene_flow (m) and flow_visibility from the frame named first to the one named second. \
         tracks: _detail/<camera>/tracks.npz has points (shares of width and height) and whether they are occluded, in TAP-Vid's layout.",
    ),
    ("records", "A frame counts when _detail/<camera>/frames/frame.IIII.json is there; checksums are BLAKE3 of whole files."),
    (
        "times",
        "manifest_times.csv tells how long frames took, with the most memory that the process had until then and the number of threads; it \
         is the only file of a run that differs between two (costs that `enfilade stats` adds to statistics/ follow from it).",
    ),
];

impl Default for Conventions {
    fn default() -> Self {
        let notes = NOTES.iter().map(|(subject, note)| (subject.to_string(), note.to_string())).collect();
        let layer = |spec: &LayerSpec| LayerEntry {
            name: spec.name.to_string(),
            pass: spec.pass,
            channels: spec.channels,
            dtype: spec.dtype,
            unit: spec.unit.to_string(),
            space: spec.space.to_string(),
            sentinel: spec.sentinel.to_string(),
            description: spec.description.to_string(),
        };
        Self { notes, layers: LAYERS.iter().map(layer).collect() }
    }
}

impl Dataset {
    /// Gathers the manifest from the trajectories and commit records on disk, and `info`. It reads no layer.
    ///
    /// # Errors
    /// When a trajectory or record cannot be read.
    pub fn collect_manifest(&self, info: &ManifestInfo) -> Result<Manifest, DatasetError> {
        let mut scenes = BTreeMap::new();
        for scene in self.scenes()? {
            let mut entry = SceneEntry::default();
            for camera in self.cameras(&scene)? {
                // A camera that was being removed when the program was killed has none.
                let frames = optional(self.frame_indices(&scene, &camera))?.unwrap_or_default();
                let rejected = self.rejected_views(&scene, &camera)?;
                let entry_of = |frame: u32| self.frame_entry(&scene, &camera, frame, rejected.get(&frame), info);
                let frames = frames.into_iter().map(entry_of).collect::<Result<_, _>>()?;
                entry.cameras.insert(camera, CameraEntry { frames });
            }
            scenes.insert(scene, entry);
        }
        for (scene, reason) in &info.failed_scenes {
            scenes.entry(scene.clone()).or_default().failed = Some(reason.clone());
        }
        Ok(Manifest {
            format: format(),
            enfilade_version: env!("CARGO_PKG_VERSION").to_string(),
            conventions: Conventions::default(),
            config: info.config.clone(),
            seeds: info.seeds.clone(),
            scenes,
        })
    }

    /// The entry of one frame.
    fn frame_entry(
        &self,
        scene: &str,
        camera: &str,
        frame: u32,
        rejected: Option<&ViewFault>,
        info: &ManifestInfo,
    ) -> Result<FrameEntry, DatasetError> {
        let record = self.frame_record(scene, camera, frame)?.filter(|record| self.frame_is_whole([scene, camera], record));
        if let Some(record) = record {
            let mut files = record.files;
            let labels = self.label_record(scene, camera, frame)?.filter(|record| self.files_are_there(scene, &record.files));
            files.extend(labels.into_iter().flat_map(|record| record.files));
            let (seed, config_hash) = (Some(record.seed), Some(record.config_hash));
            let (color, denoiser) = (Some(record.color), record.denoised.map(|denoised| denoised.denoiser));
            return Ok(FrameEntry { frame, status: FrameStatus::Complete, reason: None, seed, config_hash, color, denoiser, files });
        }
        let failed = info.failed_frames.get(&(scene.to_string(), camera.to_string(), frame)).cloned();
        let (status, reason) = match (failed, rejected) {
            (Some(reason), _) => (FrameStatus::Failed, Some(reason)),
            (None, Some(fault)) => (FrameStatus::Rejected, Some(fault.to_string())),
            (None, None) => (FrameStatus::Planned, None),
        };
        Ok(FrameEntry { frame, status, reason, seed: None, config_hash: None, color: None, denoiser: None, files: BTreeMap::new() })
    }

    /// Writes `manifest.json`.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_manifest(&self, manifest: &Manifest) -> Result<(), DatasetError> {
        write_json(&self.layout().manifest(), manifest)
    }

    /// The manifest; `None` where there is none (Hypersim's own data).
    ///
    /// # Errors
    /// When it cannot be read or understood, or is of a newer layout.
    pub fn read_manifest(&self) -> Result<Option<Manifest>, DatasetError> {
        let path = self.layout().manifest();
        refuse_newer_layout(self.root())?;
        let manifest: Option<Manifest> = read_json(&path, "run again, which rewrites it")?;
        match manifest {
            Some(manifest) if manifest.format != format() => {
                let problem = format!("its format is {:?}, expected {:?}; run again, which rewrites it", manifest.format, format());
                Err(DatasetError::text(&path, problem))
            }
            manifest => Ok(manifest),
        }
    }

    /// Reads every file that the manifest lists and compares sizes and checksums: one sentence per file that is missing or not
    /// as it was written, in the manifest's order; none when all is well.
    ///
    /// # Errors
    /// When a file that is there cannot be read.
    pub fn verify_checksums(&self, manifest: &Manifest) -> Result<Vec<String>, DatasetError> {
        let problems = manifest.scenes.iter().map(|(scene, entry)| self.verify_checksums_of(scene, entry));
        Ok(problems.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
    }

    /// [`Dataset::verify_checksums`] of one scene.
    ///
    /// # Errors
    /// As there.
    pub fn verify_checksums_of(&self, scene: &str, entry: &SceneEntry) -> Result<Vec<String>, DatasetError> {
        let frames = entry.cameras.iter().flat_map(|(camera, entry)| entry.frames.iter().map(move |frame| (camera, frame)));
        let files: Vec<_> = frames.flat_map(|(camera, f)| f.files.iter().map(move |file| (camera, f.frame, file))).collect();
        let check = |&(camera, frame, (name, expected)): &(&String, u32, (&String, &FileRecord))| {
            self.check_file([scene, camera], frame, name, expected)
        };
        let problems: Vec<Option<String>> = enfilade_parallel::try_map(&files, check)?;
        Ok(problems.into_iter().flatten().collect())
    }

    /// The fault of one file, if any.
    fn check_file(
        &self,
        [scene, camera]: [&str; 2],
        frame: u32,
        name: &str,
        expected: &FileRecord,
    ) -> Result<Option<String>, DatasetError> {
        let path = self.layout().scene_dir(scene).join(name);
        let found = match FileRecord::of(&path) {
            Err(error) if error.is_not_found() => None,
            found => Some(found?),
        };
        let problem = match &found {
            None => "it is missing".to_string(),
            Some(found) if found.bytes != expected.bytes => format!("{} bytes long instead of {}", found.bytes, expected.bytes),
            Some(found) if found.blake3 != expected.blake3 => "its content is not what was written (checksums differ)".to_string(),
            Some(_) => return Ok(None),
        };
        let (record, pass) = self.made_by(scene, camera, frame, &path);
        let recorded = self.recorded_files(scene, camera, frame, pass).ok().flatten();
        let is_recorded = found.is_some() && recorded.is_some_and(|files| files.get(name) == found.as_ref());
        let stage = match pass {
            Pass::Label => "label",
            _ => "render",
        };
        let remedy = match record.is_file() {
            true if is_recorded => "but it is what its record says, so run again, which rewrites the manifest".to_string(),
            true => format!("delete {} and run the {stage} stage again", record.display()),
            false => "copy it again, or make it again where it was made".to_string(),
        };
        Ok(Some(format!("{}: {problem}; {remedy}", path.display())))
    }

    /// The record that a layer at `path` has, and which layers are in it.
    fn made_by(&self, scene: &str, camera: &str, frame: u32, path: &Path) -> (PathBuf, Pass) {
        let layout = self.layout();
        let spec = LAYERS.iter().find(|spec| layout.layer(scene, camera, frame, spec.layer) == path);
        match spec.map(|spec| spec.pass) {
            Some(Pass::Label) => (layout.label_record(scene, camera, frame), Pass::Label),
            _ => (layout.frame_record(scene, camera, frame), Pass::Final),
        }
    }
}
