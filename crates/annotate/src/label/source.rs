//! What is annotated: a scene file, or the mesh folder of a dataset's scene.

use super::app::AnnotateOptions;
use super::log::unsplit;
use enfilade_dataset::{Dataset, DatasetError, MeshFiles, MeshGeometry, quoted, scene_hash};
use enfilade_import::{Format, ImportOptions};
use enfilade_math::{DMat3, DVec3, Vec3};
use enfilade_scene::{Camera, Cx, PartLabel, Pose, Scene, Warning, WorldMesh};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Stands for "none" in [`Source::material_of_face`].
pub const NO_MATERIAL: u32 = u32::MAX;

/// The work folder of a dataset that `enfilade run` makes.
const WORKDIR: &str = ".enfilade";

/// A scene as it is annotated: triangles in the world, the parts they belong to, and what is known of them already.
pub struct Source {
    /// The scene's name.
    pub name: String,
    /// Where it comes from, for people.
    pub origin: String,
    /// Where labels are written.
    pub labels_folder: PathBuf,
    /// Corners of every face in the world, metres.
    pub corners: Vec<[Vec3; 3]>,
    /// Number of vertices in the source.
    pub vertices: usize,
    /// The part of every face.
    pub part_of_face: Vec<u32>,
    /// The material of every face, [`NO_MATERIAL`] where it has none.
    pub material_of_face: Vec<u32>,
    /// Names of the parts.
    pub parts: Vec<String>,
    /// Names of the materials.
    pub materials: Vec<String>,
    /// What the parts were called before anything is done here; none where the log says it, because something was done already.
    pub labels: Vec<PartLabel>,
    /// From where pictures are to be taken.
    pub cameras: Vec<PlannedCamera>,
    /// Metres per unit of the source's files.
    pub meters_per_unit: f64,
    /// True when the folder of labels is the mesh folder that the scene was read from.
    pub in_mesh_folder: bool,
}

/// A camera's planned frames.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlannedCamera {
    /// Its name.
    pub name: String,
    /// In order.
    pub frames: Vec<PlannedFrame>,
}

/// A view of the scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlannedFrame {
    /// Frame number.
    pub frame: u32,
    /// Metres.
    pub position: [f64; 3],
    /// World from camera, row by row.
    pub orientation: [f64; 9],
    /// Vertical field of view; of cameras that are no pinhole that of a pinhole which shows about as much.
    pub fov_y_deg: f64,
    /// Width over height.
    pub aspect: f64,
}

impl PlannedFrame {
    /// The view of a pose.
    pub fn new(pose: &Pose, fov_y_deg: f64, aspect: f64) -> Self {
        let orientation = pose.world_from_camera.transpose().to_cols_array();
        Self { frame: pose.frame, position: pose.position.to_array(), orientation, fov_y_deg, aspect }
    }
}

/// Why there is nothing to annotate.
#[derive(Debug, thiserror::Error)]
pub enum SourceError {
    /// The path is not one of the things that can be annotated.
    #[error(
        "{path}: {problem}; expected a scene file ({}), a dataset, a scene's folder in it, or a Hypersim mesh folder",
        Format::extensions()
    )]
    Path {
        /// What was named.
        path: String,
        /// What is wrong with it.
        problem: String,
    },
    /// A dataset has several scenes, or not the one that was named.
    #[error("{path}: {problem}; name one with --scene: {scenes}")]
    Scene {
        /// The dataset.
        path: String,
        /// What is wrong.
        problem: String,
        /// The scenes there are.
        scenes: String,
    },
    /// The scene file cannot be imported.
    #[error(transparent)]
    Import(#[from] enfilade_import::ImportError),
    /// The mesh folder cannot be read.
    #[error(transparent)]
    Dataset(#[from] enfilade_dataset::DatasetError),
}

impl Source {
    /// Loads what is to be annotated.
    ///
    /// # Errors
    /// When there is nothing to annotate at the path, or it cannot be read.
    pub fn load(options: &AnnotateOptions, cx: &dyn Cx) -> Result<Self, SourceError> {
        let AnnotateOptions { path, scene, labels, .. } = options;
        let (scene, labels) = (scene.as_deref(), labels.as_deref());
        let wrong = |problem: &str| SourceError::Path { path: path.display().to_string(), problem: problem.into() };
        if path.is_file() {
            return Self::of_file(options, cx);
        }
        if !path.is_dir() {
            return Err(wrong("there is no such file or folder"));
        }
        if options.meters_per_unit.is_some() || options.up_axis.is_some() {
            return Err(wrong("units and the axis that points up are given for scene files, and this is a folder"));
        }
        let folder = path.canonicalize().map_err(|e| wrong(&e.to_string()))?;
        if folder.join("mesh_vertices.hdf5").is_file() {
            return Self::of_mesh_folder(&folder, labels, cx);
        }
        if folder.join("_detail/mesh").is_dir() {
            return Self::of_mesh_folder(&folder.join("_detail/mesh"), labels, cx);
        }
        let dataset = Dataset::open(&folder).map_err(|_| wrong("it is neither a dataset nor a mesh folder"))?;
        let scenes = dataset.scenes()?;
        let problem = |problem: String| SourceError::Scene { path: path.display().to_string(), problem, scenes: scenes.join(", ") };
        let name = match (scene, scenes.as_slice()) {
            (Some(name), _) if scenes.iter().any(|s| s == name) => name,
            (Some(name), _) => return Err(problem(format!("it has no scene {name:?}"))),
            (None, [only]) => only,
            (None, all) => return Err(problem(format!("it has {} scenes", all.len()))),
        };
        Self::of_mesh_folder(&dataset.layout().mesh_dir(name), labels, cx)
    }

    fn of_file(options: &AnnotateOptions, cx: &dyn Cx) -> Result<Self, SourceError> {
        let AnnotateOptions { path, labels, up_axis, .. } = options;
        let meters_per_unit = options.meters_per_unit.unwrap_or(1.0);
        let import = ImportOptions { meters_per_unit, up_axis: *up_axis, allow_missing_textures: true, ..ImportOptions::default() };
        let imported = enfilade_import::load(path, &import, cx)?;
        let scene = &imported.scene;
        let mut known = vec![PartLabel::NONE; scene.parts.len()];
        imported.labels.iter().flatten().for_each(|label| known[label.part as usize] = label.label);
        let mesh = WorldMesh::new(scene);
        let part_of_face: Vec<u32> = mesh.sources.iter().map(|source| source.part).collect();
        let name = path.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy().into_owned());
        Ok(Self {
            origin: path.display().to_string(),
            labels_folder: labels.clone().unwrap_or_else(|| path.with_added_extension("labels")),
            vertices: scene.parts.iter().map(|part| scene.meshes[part.mesh as usize].positions.len()).sum(),
            material_of_face: part_of_face.iter().map(|&part| scene.parts[part as usize].material).collect(),
            part_of_face,
            corners: mesh.corners,
            parts: scene.parts.iter().map(|part| part.name.clone()).collect(),
            materials: scene.materials.iter().map(|material| material.name.clone()).collect(),
            labels: known,
            cameras: cameras_of_file(scene),
            meters_per_unit: 1.0,
            in_mesh_folder: false,
            name,
        })
    }

    fn of_mesh_folder(folder: &Path, labels: Option<&Path>, cx: &dyn Cx) -> Result<Self, SourceError> {
        let place = Place::of(folder);
        let mesh = read_mesh(&MeshFiles::new(folder))?;
        let scale = place.as_ref().and_then(|place| place.dataset.meters_per_asset_unit(&place.scene).ok()).unwrap_or(1.0);
        let vertex = |index: u32| (mesh.vertices[index as usize] * scale).as_vec3();
        let labels_folder = labels.unwrap_or(folder);
        // The tables are written again from the log then, so it does not matter what became of them.
        let is_annotated = matches!(MeshFiles::new(labels_folder).annotated_scene(), Ok(Some(_)));
        let parts = mesh.objects.len();
        let known = if is_annotated { vec![PartLabel::NONE; parts] } else { read_labels(parts, folder, place.as_ref(), cx)? };
        let name = place.as_ref().map(|place| place.scene.clone());
        Ok(Self {
            name: name.unwrap_or_else(|| folder.file_name().map_or_else(|| "scene".into(), |n| n.to_string_lossy().into_owned())),
            origin: folder.display().to_string(),
            labels_folder: labels_folder.to_path_buf(),
            vertices: mesh.vertices.len(),
            corners: mesh.faces.iter().map(|face| face.map(vertex)).collect(),
            part_of_face: mesh.object_of_face,
            material_of_face: mesh.material_of_face.iter().map(|m| m.unwrap_or(NO_MATERIAL)).collect(),
            parts: mesh.objects,
            materials: mesh.materials,
            labels: known,
            cameras: place.map(|place| place.cameras(cx)).unwrap_or_default(),
            meters_per_unit: scale,
            in_mesh_folder: labels.is_none(),
        })
    }

    /// What tells this scene from others: the names of the parts and how many faces each has.
    pub fn hash(&self) -> String {
        let mut faces = vec![0; self.parts.len()];
        self.part_of_face.iter().for_each(|&part| faces[part as usize] += 1);
        scene_hash(self.parts.iter().map(String::as_str).zip(faces))
    }
}

/// The triangles with their objects whole: by the log beside them, if it tells, else by the tables.
fn read_mesh(files: &MeshFiles) -> Result<MeshGeometry, DatasetError> {
    match unsplit(files) {
        Some((whole, object_of_face)) => files.read_unsplit(whole, object_of_face).or_else(|_| files.read()),
        None => files.read(),
    }
}

/// The labels of so many parts by the tables in `folder`; none where there are no tables.
fn read_labels(parts: usize, folder: &Path, place: Option<&Place>, cx: &dyn Cx) -> Result<Vec<PartLabel>, DatasetError> {
    let mut known = vec![PartLabel::NONE; parts];
    let warn = |message: String| cx.warn(Warning { place: folder.display().to_string(), message });
    match MeshFiles::new(folder).read_labels() {
        Ok(labels) => {
            if labels.parts.len() < parts {
                warn(format!("labels of {} objects, but there are {parts}: the rest begin without", labels.parts.len()));
            }
            known.iter_mut().zip(labels.parts).for_each(|(known, label)| *known = label);
        }
        Err(error) if error.is_not_found() => {
            if let Some(root) = place.map(|place| place.dataset.root()).filter(|root| root.join(WORKDIR).is_dir()) {
                warn(format!(
                    "the label stage has not run yet, so nothing has a label at first, whatever the scene file or a label table says; \
                     to begin with those labels end this before the first edit, and open the scene again after: enfilade label {}",
                    quoted(root.display())
                ));
            }
        }
        Err(error) => return Err(error),
    }
    Ok(known)
}

/// The cameras that a scene file brings along: one frame each.
fn cameras_of_file(scene: &Scene) -> Vec<PlannedCamera> {
    let camera = |camera: &enfilade_scene::StartCamera| {
        let fov_y = 2.0 * ((0.5 * camera.fov_x_rad).tan() / camera.aspect).atan();
        let frames = vec![PlannedFrame::new(&camera.pose(0), fov_y.to_degrees(), camera.aspect)];
        PlannedCamera { name: camera.name.clone(), frames }
    };
    scene.cameras.iter().map(camera).collect()
}

/// Where in a dataset a mesh folder lies.
struct Place {
    dataset: Dataset,
    scene: String,
}

impl Place {
    /// `ROOT/scenes/NAME/_detail/mesh` or `ROOT/NAME/_detail/mesh`; `None` for other folders.
    fn of(folder: &Path) -> Option<Self> {
        let detail = folder.parent().filter(|detail| detail.ends_with("_detail"))?;
        let scene = detail.parent()?;
        let scenes = scene.parent()?;
        let root = if scenes.ends_with("scenes") { scenes.parent()? } else { scenes };
        let dataset = Dataset::open(root).ok()?;
        Some(Self { dataset, scene: scene.file_name()?.to_string_lossy().into_owned() })
    }

    /// The planned trajectories; those that cannot be read are told and left out.
    fn cameras(&self, cx: &dyn Cx) -> Vec<PlannedCamera> {
        let mut planned = Vec::new();
        for name in self.dataset.cameras(&self.scene).unwrap_or_default() {
            let (with, trajectory) = (self.dataset.read_camera(&self.scene, &name), self.dataset.read_trajectory(&self.scene, &name));
            match (with, trajectory) {
                (Ok(with), Ok(trajectory)) => {
                    let (fov_y_deg, aspect) = field_of_view(&with);
                    let frames = trajectory.poses.iter().map(|pose| PlannedFrame::new(pose, fov_y_deg, aspect)).collect();
                    planned.push(PlannedCamera { name, frames });
                }
                (Err(error), _) | (_, Err(error)) => {
                    cx.warn(Warning { place: name, message: format!("the camera is left out: {error}") });
                }
            }
        }
        planned
    }
}

/// Vertical field of view in degrees, and width over height, of a pinhole that shows about what the camera does.
fn field_of_view(camera: &Camera) -> (f64, f64) {
    /// A page shows no more than this without distorting it beyond recognition.
    const WIDEST_DEG: f64 = 100.0;
    let [width, height] = camera.size().map(f64::from);
    let edge = |y: f64| camera.projection.ray(0.5 * width, y);
    let fov = match (edge(0.0), edge(height)) {
        (Some(top), Some(bottom)) => top.angle_between(bottom).to_degrees(),
        _ => WIDEST_DEG,
    };
    (fov.clamp(1.0, WIDEST_DEG), width / height)
}

/// The pose of a view from `position` to `look_at` with z up, or with y up where the view is vertical.
pub fn upright(frame: u32, position: DVec3, look_at: DVec3) -> Option<Pose> {
    Pose::look_at(frame, position, look_at, DVec3::Z).or_else(|| Pose::look_at(frame, position, look_at, DVec3::Y))
}

/// World from camera of nine numbers, row by row.
pub fn rows(orientation: &[f64; 9]) -> DMat3 {
    DMat3::from_cols_array(orientation).transpose()
}
