//! Files that a node makes of a frame beside its layers: the part of `boxes` and `preview` that depends only on the frame and its scene.
//! They travel with the frame, so that these stages need not make them again where frames are gathered.
//!
//! A note in the work folder, `.enfilade/SCENE/made/CAMERA/FRAME.json`, names the inputs of the files. They are used as long as these are
//! the same and the files exist; otherwise, and without a note, the stages make them.

use super::{HASHED_AS, Job, Output, Stage};
use crate::error::Error;
use crate::workdir::{Hash, read_json};
use enfilade_dataset::{BoxKind, InstanceView, write_json};
use enfilade_label::Pieces;
use enfilade_label::boxes::write_boxes;
use enfilade_label::instances::{Solid, solids, view_instances};
use enfilade_scene::{Labels, Quiet, Scene, WorldMesh};
use enfilade_show::drivers::{preview_boxes, preview_frame_alone};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

#[derive(Serialize, Deserialize)]
struct Note {
    instances: Made,
    /// The visible instances of the frame.
    views: Vec<InstanceView>,
    pictures: Made,
}

#[derive(Serialize, Deserialize)]
struct Made {
    /// Key of the files' inputs and of the stage's version.
    from: Hash,
    files: Vec<Output>,
}

impl Made {
    fn new(job: &Job, from: Hash, files: &[PathBuf]) -> Result<Self, Error> {
        Ok(Self { from, files: files.iter().map(|path| Output::by_length(job.out(), path)).collect::<Result<_, _>>()? })
    }

    /// Files of the product, if they are there and made from `from`.
    fn files(&self, job: &Job, from: &Hash) -> Option<Vec<PathBuf>> {
        let are_there = self.from == *from && self.files.iter().all(|file| file.has_its_length(job.out()));
        are_there.then(|| self.files.iter().map(|file| job.out().join(&file.path)).collect())
    }
}

/// The solid instances of a scene; its boxes are written.
pub(super) struct Furniture {
    scene: Arc<Scene>,
    labels: Labels,
    /// Solid instances of all frames, if nothing moves.
    still: Option<Arc<Vec<Solid>>>,
    boxes: Hash,
}

impl Furniture {
    /// Furniture of a scene whose label tables are there.
    pub fn of(job: &Job) -> Result<Self, Error> {
        let scene = scene_of_pieces(job)?;
        let labels = job.dataset.read_label_tables(&job.scene.name).map_err(Error::stage)?;
        write_boxes(job.dataset, &job.scene.name, &scene, &labels).map_err(Error::stage)?;
        Self::known(job, scene, labels, true)
    }

    /// Furniture of a scene of pieces. Unless it is `needed`, there is none.
    pub fn known(job: &Job, scene: Arc<Scene>, labels: Labels, needed: bool) -> Result<Self, Error> {
        let all = || if needed { solids(&WorldMesh::new(&scene), &labels) } else { Vec::new() };
        let still = scene.is_still().then(|| Arc::new(all()));
        Ok(Self { still, scene, labels, boxes: boxes(job)? })
    }

    /// The moment that each frame of a camera shows, seconds; none where nothing moves.
    pub fn moments(&self, job: &Job, camera: &str) -> Result<BTreeMap<u32, f64>, Error> {
        if self.still.is_some() {
            return Ok(BTreeMap::new());
        }
        let filmed = job.dataset.read_filmed_bodies(&job.scene.name, camera).map_err(Error::stage)?;
        Ok(filmed.iter().flat_map(|filmed| filmed.frames()).map(|frame| (frame.frame, frame.time_s)).collect())
    }

    /// The solid instances as a frame finds them.
    pub fn solids(&self, moments: &BTreeMap<u32, f64>, frame: u32) -> Arc<Vec<Solid>> {
        let moved = || {
            let time_s = moments.get(&frame).copied().unwrap_or_default();
            Arc::new(solids(&WorldMesh::new(&self.scene.at(time_s)), &self.labels))
        };
        self.still.clone().unwrap_or_else(moved)
    }
}

/// The scene, with the pieces of split parts as parts.
pub(super) fn scene_of_pieces(job: &Job) -> Result<Arc<Scene>, Error> {
    let scene = job.load_scene()?;
    let split = Pieces::read(&job.dataset.mesh_files(&job.scene.name), &scene).map_err(Error::stage)?;
    Ok(split.map_or(scene.clone(), |split| Arc::new(split.scene_of_pieces(&scene))))
}

/// Makes these files of a frame that is rendered, denoised unless rendered colour is requested, and labelled; returns the files and then
/// the note.
pub(super) fn make(job: &Job, camera: &str, frame: u32, furniture: &Furniture) -> Result<Vec<PathBuf>, Error> {
    let shot = [job.scene.name.as_str(), camera];
    let solids = furniture.solids(&furniture.moments(job, camera)?, frame);
    let views = view_instances(job.dataset, shot, frame, &solids).map_err(Error::stage)?;
    let mut pictures = preview_frame_alone(job.dataset, shot, frame).map_err(Error::stage)?;
    pictures.extend(preview_boxes(job.dataset, shot[0], camera, &[frame], &Quiet).map_err(Error::stage)?);
    let masks = vec![job.dataset.layout().amodal_masks(shot[0], camera, frame)];
    let note = Note {
        instances: Made::new(job, instances_from(job, camera, frame)?, &masks)?,
        views,
        pictures: Made::new(job, pictures_from(job, camera, frame, &furniture.boxes)?, &pictures)?,
    };
    let path = note_path(job, camera, frame)?;
    write_json(&path, &note)?;
    Ok([masks, pictures, vec![path]].concat())
}

/// The visible instances of a frame, if they are known and its masks exist.
pub(super) fn views(job: &Job, camera: &str, frame: u32) -> Result<Option<Vec<InstanceView>>, Error> {
    let Some(note) = note(job, camera, frame)? else { return Ok(None) };
    let there = note.instances.files(job, &instances_from(job, camera, frame)?).is_some();
    Ok(there.then_some(note.views))
}

/// The pictures of a frame that need nothing but it and the boxes of the scene, if they are there.
pub(super) fn pictures(job: &Job, camera: &str, frame: u32, boxes: &Hash) -> Result<Option<Vec<PathBuf>>, Error> {
    let Some(note) = note(job, camera, frame)? else { return Ok(None) };
    Ok(note.pictures.files(job, &pictures_from(job, camera, frame, boxes)?))
}

/// Names the boxes of the scene.
pub(super) fn boxes(job: &Job) -> Result<Hash, Error> {
    let files = BoxKind::ALL.iter().flat_map(|&kind| job.dataset.box_files(&job.scene.name, kind));
    Ok(Hash::of(&files.map(|path| Hash::of_file(&path)).collect::<Result<Vec<_>, _>>()?))
}

/// The note of a frame; `None` where there is none, or everything is to be made again.
fn note(job: &Job, camera: &str, frame: u32) -> Result<Option<Note>, Error> {
    if job.force { Ok(None) } else { Ok(read_json(&note_path(job, camera, frame)?)) }
}

fn note_path(job: &Job, camera: &str, frame: u32) -> Result<PathBuf, Error> {
    Ok(job.work_file("made")?.join(camera).join(format!("{frame:04}.json")))
}

/// Hash of what a frame's instances are made from: the records of its layers, which name the scene and its labels.
fn instances_from(job: &Job, camera: &str, frame: u32) -> Result<Hash, Error> {
    let labelled = Hash::of_file(&job.dataset.layout().label_record(&job.scene.name, camera, frame))?;
    let rendered = job.rendered_record(camera, frame)?.content;
    Ok(Hash::of(&(HASHED_AS, Stage::Boxes.version(), rendered, labelled)))
}

/// Hash of what a frame's pictures are made from.
fn pictures_from(job: &Job, camera: &str, frame: u32, boxes: &Hash) -> Result<Hash, Error> {
    let shown = Hash::of_file(&job.dataset.layout().frame_record(&job.scene.name, camera, frame))?;
    let instances = instances_from(job, camera, frame)?;
    Ok(Hash::of(&(Stage::Preview.version(), instances, shown, boxes)))
}
