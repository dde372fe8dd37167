//! The scene that is annotated: loaded from a scene file, or from the mesh folder of a dataset's scene.

use super::face_colors::FaceColors;
use super::options::AnnotateOptions;
use super::planned::{PlannedCamera, PlannedFrame, cameras_of_file, field_of_view, is_plain};
use super::scene_error::SceneError;
use super::unsplit::unsplit;
use super::without_log;
use enfilade_dataset::{Dataset, DatasetError, MeshFiles, MeshGeometry, WORKDIR, mesh_names, quoted, scene_hash};
use enfilade_frame::Pass;
use enfilade_import::ImportOptions;
use enfilade_math::Vec3;
use enfilade_scene::{Cx, PartLabel, Pose, Warning, WorldMesh};
use std::path::{Path, PathBuf};

/// The imported scene, below the working folder of a dataset.
const PACKAGE: &str = "scene.scene";

/// Stands for "none" in [`AnnotatedScene::material_of_face`].
pub const NO_MATERIAL: u32 = u32::MAX;

/// Triangles in world space, the parts that they belong to, and the labels that the parts have already.
pub struct AnnotatedScene {
    /// The scene's name.
    pub name: String,
    /// Source of the scene, for people.
    pub origin: String,
    /// Folder of the labels.
    pub labels_folder: PathBuf,
    /// Corners of every face in the world, metres.
    pub corners: Vec<[Vec3; 3]>,
    /// Number of vertices in the files.
    pub vertices: usize,
    /// The part of every face.
    pub part_of_face: Vec<u32>,
    /// The material of every face, [`NO_MATERIAL`] where it has none.
    pub material_of_face: Vec<u32>,
    /// Colours of its surfaces.
    pub colors: FaceColors,
    /// Names of the parts.
    pub parts: Vec<String>,
    /// Parent objects of the parts, outermost first, separated by slashes; empty where a mesh folder does not state them.
    pub around: Vec<String>,
    /// Names of the materials.
    pub materials: Vec<String>,
    /// The labels of the parts before the first edit; none of them if there were edits already, because then the log has them.
    pub labels: Vec<PartLabel>,
    /// From where pictures are to be taken.
    pub cameras: Vec<PlannedCamera>,
    /// Metres per unit of the files.
    pub meters_per_unit: f64,
    /// True when a label stage makes the tables of labels and objects in that folder from the log.
    pub has_label_stage: bool,
}

impl AnnotatedScene {
    /// Loads what is to be annotated.
    ///
    /// # Errors
    /// When there is nothing to annotate at the path, or it cannot be read.
    pub fn load(options: &AnnotateOptions, cx: &dyn Cx) -> Result<Self, SceneError> {
        let AnnotateOptions { path, scene, labels, .. } = options;
        let (scene, labels) = (scene.as_deref(), labels.as_deref());
        let wrong = |problem: &str| SceneError::Path { path: path.display().to_string(), problem: problem.into() };
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
        if folder.join(mesh_names::VERTICES).is_file() {
            return Self::of_mesh_folder(&folder, labels, cx);
        }
        if folder.join("_detail/mesh").is_dir() {
            return Self::of_mesh_folder(&folder.join("_detail/mesh"), labels, cx);
        }
        let dataset = Dataset::open(&folder).map_err(|error| match error {
            DatasetError::NotADataset { .. } => wrong("it is neither a dataset nor a mesh folder"),
            other => other.into(),
        })?;
        let scenes = dataset.scenes()?;
        let problem = |problem: String| SceneError::Scene { path: path.display().to_string(), problem, scenes: scenes.join(", ") };
        let name = match (scene, scenes.as_slice()) {
            (Some(name), _) if scenes.iter().any(|s| s == name) => name,
            (Some(name), _) => return Err(problem(format!("it has no scene {name:?}"))),
            (None, [only]) => only,
            (None, all) => return Err(problem(format!("it has {} scenes", all.len()))),
        };
        Self::of_mesh_folder(&dataset.layout().mesh_dir(name), labels, cx)
    }

    fn of_file(options: &AnnotateOptions, cx: &dyn Cx) -> Result<Self, SceneError> {
        let AnnotateOptions { path, labels, up_axis, .. } = options;
        let meters_per_unit = options.meters_per_unit.unwrap_or(1.0);
        let import = ImportOptions {
            meters_per_unit,
            up_axis: *up_axis,
            allow_missing_textures: true,
            allow_missing_meshes: true,
            ..ImportOptions::default()
        };
        let imported = enfilade_import::load(path, &import, cx)?;
        let scene = &imported.scene;
        let mut known = vec![PartLabel::NONE; scene.parts.len()];
        imported.labels.iter().flatten().for_each(|label| known[label.part as usize] = label.label);
        let mesh = WorldMesh::new(scene);
        let part_of_face: Vec<u32> = mesh.sources.iter().map(|source| source.part).collect();
        let name = path.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy().into_owned());
        let labels_folder = labels.clone().unwrap_or_else(|| path.with_added_extension("labels"));
        let parts: Vec<String> = scene.parts.iter().map(|part| part.name.clone()).collect();
        // With labels of an earlier version, what is in the folder may be of that version.
        if options.carry.is_none() {
            known = without_log::read(&labels_folder, &parts, cx)?.unwrap_or(known);
        }
        Ok(Self {
            origin: path.display().to_string(),
            labels_folder,
            vertices: scene.parts.iter().map(|part| scene.meshes[part.mesh as usize].positions.len()).sum(),
            material_of_face: part_of_face.iter().map(|&part| scene.parts[part as usize].material).collect(),
            part_of_face,
            colors: FaceColors::of(scene, &mesh.sources),
            corners: mesh.corners,
            parts,
            around: scene.parts.iter().map(|part| scene.lineage(part).join("/")).collect(),
            materials: scene.materials.iter().map(|material| material.name.clone()).collect(),
            labels: known,
            cameras: cameras_of_file(scene),
            meters_per_unit: 1.0,
            has_label_stage: false,
            name,
        })
    }

    fn of_mesh_folder(folder: &Path, labels: Option<&Path>, cx: &dyn Cx) -> Result<Self, SceneError> {
        let home = SceneOfDataset::of(folder);
        let mesh = read_mesh(&MeshFiles::new(folder))?;
        let scale = home.as_ref().and_then(|home| home.dataset.meters_per_asset_unit(&home.scene).ok()).unwrap_or(1.0);
        let vertex = |index: u32| (mesh.vertices[index as usize] * scale).as_vec3();
        let labels_folder = labels.unwrap_or(folder);
        // If there are edits, the labels follow from the log and the tables are written again.
        let is_annotated = matches!(MeshFiles::new(labels_folder).annotated_scene(), Ok(Some(_)));
        let parts = mesh.objects.len();
        // Those in another folder of labels come before those of the mesh folder.
        let elsewhere = labels.map(|labels| without_log::read(labels, &mesh.objects, cx)).transpose()?.flatten();
        let known = match elsewhere {
            _ if is_annotated => vec![PartLabel::NONE; parts],
            Some(known) => known,
            None => read_labels(parts, folder, home.as_ref(), cx)?,
        };
        let name = home.as_ref().map(|home| home.scene.clone());
        let has_label_stage = labels.is_none() && home.as_ref().is_some_and(SceneOfDataset::has_label_stage);
        Ok(Self {
            name: name.unwrap_or_else(|| folder.file_name().map_or_else(|| "scene".into(), |n| n.to_string_lossy().into_owned())),
            origin: folder.display().to_string(),
            labels_folder: labels_folder.to_path_buf(),
            vertices: mesh.vertices.len(),
            corners: mesh.faces.iter().map(|face| face.map(vertex)).collect(),
            colors: home.as_ref().map_or(FaceColors::Unknown, SceneOfDataset::colors),
            part_of_face: mesh.object_of_face,
            material_of_face: mesh.material_of_face.iter().map(|m| m.unwrap_or(NO_MATERIAL)).collect(),
            around: vec![String::new(); mesh.objects.len()],
            parts: mesh.objects,
            materials: mesh.materials,
            labels: known,
            cameras: home.map(|home| home.cameras(cx)).unwrap_or_default(),
            meters_per_unit: scale,
            has_label_stage,
        })
    }

    /// The parent objects of a part, outermost first, separated by slashes: those that the file states, else those that its name begins
    /// with.
    pub fn object_of(&self, part: u32) -> &str {
        let around = self.around[part as usize].as_str();
        if around.is_empty() { self.parts[part as usize].rsplit_once('/').map_or("", |(object, _)| object) } else { around }
    }

    /// Identifies the scene: a hash of the names of the parts and of how many faces each has.
    pub fn hash(&self) -> String {
        let mut faces = vec![0; self.parts.len()];
        self.part_of_face.iter().for_each(|&part| faces[part as usize] += 1);
        scene_hash(self.parts.iter().map(String::as_str).zip(faces))
    }
}

/// The triangles with their objects as they were before any was split: by the log beside them if there is one, else by the tables.
fn read_mesh(files: &MeshFiles) -> Result<MeshGeometry, DatasetError> {
    match unsplit(files) {
        Some((whole, object_of_face)) => files.read_whole(whole, object_of_face).or_else(|_| files.read()),
        None => files.read(),
    }
}

/// The labels of this number of parts by the tables in `folder`; none where there are no tables.
fn read_labels(parts: usize, folder: &Path, home: Option<&SceneOfDataset>, cx: &dyn Cx) -> Result<Vec<PartLabel>, DatasetError> {
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
            if let Some(root) = home.map(|home| home.dataset.root()).filter(|root| root.join(WORKDIR).is_dir()) {
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

/// The dataset and the scene in it that a mesh folder belongs to.
struct SceneOfDataset {
    dataset: Dataset,
    scene: String,
}

impl SceneOfDataset {
    /// `ROOT/scenes/NAME/_detail/mesh` or `ROOT/NAME/_detail/mesh`; `None` for other folders.
    fn of(folder: &Path) -> Option<Self> {
        let detail = folder.parent().filter(|detail| detail.ends_with("_detail"))?;
        let scene = detail.parent()?;
        let scenes = scene.parent()?;
        let root = if scenes.ends_with("scenes") { scenes.parent()? } else { scenes };
        let dataset = Dataset::open(root).ok()?;
        Some(Self { dataset, scene: scene.file_name()?.to_string_lossy().into_owned() })
    }

    /// The imported scene, if it still exists.
    fn package(&self) -> Option<PathBuf> {
        Some(self.dataset.root().join(WORKDIR).join(&self.scene).join(PACKAGE)).filter(|package| package.is_file())
    }

    /// Whether stages can run over the scene.
    fn has_label_stage(&self) -> bool {
        self.package().is_some()
    }

    /// The colours of the materials, where they are known.
    fn colors(&self) -> FaceColors {
        self.package().map_or(FaceColors::Unknown, FaceColors::Package)
    }

    /// The planned trajectories; those that cannot be read are left out with a warning.
    fn cameras(&self, cx: &dyn Cx) -> Vec<PlannedCamera> {
        let mut planned = Vec::new();
        for name in self.dataset.cameras(&self.scene).unwrap_or_default() {
            let (with, trajectory) = (self.dataset.read_camera(&self.scene, &name), self.dataset.read_trajectory(&self.scene, &name));
            match (with, trajectory) {
                (Ok(with), Ok(trajectory)) => {
                    let (fov_y_deg, aspect) = field_of_view(&with);
                    let photograph = |frame| self.dataset.layout().preview(&self.scene, &name, frame, Pass::Final, "tonemap.jpg");
                    let frame = |pose: &Pose| PlannedFrame {
                        photograph: is_plain(&with).then(|| photograph(pose.frame)),
                        ..PlannedFrame::new(pose, fov_y_deg, aspect)
                    };
                    let frames = trajectory.poses.iter().map(frame).collect();
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
