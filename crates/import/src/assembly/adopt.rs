//! Scenes that are parts of others: models with files of their own, each of which is read once and may be placed many times.

use super::{Assembly, FileLabel};
use crate::{ImportError, Imported};
use enfilade_math::DAffine3;
use enfilade_scene::{ObjectId, Part, PartLabel, Scene};
use std::path::Path;
use std::sync::Arc;

/// One mesh of an adopted model with its material, both as indices into the scene.
#[derive(Clone)]
pub(crate) struct Piece {
    pub name: String,
    pub mesh: u32,
    pub material: u32,
    pub model_from_mesh: DAffine3,
    /// The object of the part within the model, if the model is placed only once.
    pub object: Option<ObjectId>,
    /// The label in the model's own file. Its instance number is valid within the model only.
    pub label: PartLabel,
}

impl Piece {
    /// The label of the piece, by the model's file, as a part of `object`: one instance for each class.
    pub(crate) fn label_in(&self, object: ObjectId) -> FileLabel {
        FileLabel::given(self.label.semantic, object)
    }
}

impl Assembly<'_> {
    /// Takes over the meshes, materials and pictures of a model, the files that it was made of and its warnings. Nothing is placed yet:
    /// [`Assembly::push_part`] does, with each piece's placement within the model. `file` is the model's.
    ///
    /// # Errors
    /// When a mesh is not valid, which the model's import excludes.
    pub(crate) fn adopt(&mut self, imported: Imported, file: &Path) -> Result<Vec<Piece>, ImportError> {
        self.note_inputs(&imported.inputs);
        imported.missing.iter().for_each(|file| self.note_missing(file));
        self.pass_on(imported.report.warnings);
        let mut scene = imported.scene;
        turn_mirrored_back(&mut scene);
        let first_image = self.next_image();
        let images = scene.images.len() as u32;
        for image in scene.images {
            self.push_image(image);
        }
        let files = imported.picture_files.into_iter().filter(|(index, _)| *index < images);
        self.picture_files.extend(files.map(|(index, file)| (first_image + index, file)));
        let mut materials = Vec::with_capacity(scene.materials.len());
        for material in scene.materials {
            materials.push(self.push_material(material.repictured(|image| first_image + image)));
        }
        let mut meshes = Vec::with_capacity(scene.meshes.len());
        for mesh in scene.meshes {
            meshes.push(self.push_mesh(Arc::unwrap_or_clone(mesh), file, "model")?);
        }
        let mut objects = Vec::with_capacity(scene.objects.len());
        for object in &scene.objects {
            let parent = object.parent.map(|parent| objects[parent as usize]);
            objects.push(self.push_object(&object.name, parent));
        }
        if !scene.bodies.is_empty() {
            self.warn(file.display().to_string(), "what moves in it stays as it is at rest: motion is read of scene files themselves");
        }
        // A model far from its origin was moved to the origin; within this scene it has the position of its file.
        let moved = imported.report.offset_m.map_or(DAffine3::IDENTITY, |offset| DAffine3::from_translation(offset.into()));
        let mut labels = vec![PartLabel::NONE; scene.parts.len()];
        imported.labels.into_iter().flatten().for_each(|l| labels[l.part as usize] = l.label);
        let piece = |(part, label): (Part, PartLabel)| {
            let (mesh, material) = (meshes[part.mesh as usize]?, materials[part.material as usize]);
            let object = part.object.map(|object| objects[object as usize]);
            Some(Piece { name: part.name, mesh, material, model_from_mesh: moved * part.world_from_mesh, object, label })
        };
        Ok(scene.parts.into_iter().zip(labels).filter_map(piece).collect())
    }
}

/// Gives meshes that mirrored placements have wound the other way their own winding again: [`Assembly::push_part`] winds them by the whole
/// placement. A mesh of a scene has either mirrored placements or others.
fn turn_mirrored_back(scene: &mut Scene) {
    let mut mirrored = vec![false; scene.meshes.len()];
    for part in scene.parts.iter().filter(|part| part.world_from_mesh.matrix3.determinant() < 0.0) {
        mirrored[part.mesh as usize] = true;
    }
    let wound = scene.meshes.iter_mut().zip(mirrored).filter(|(_, mirrored)| *mirrored);
    wound.for_each(|(mesh, _)| Arc::make_mut(mesh).triangles.iter_mut().for_each(|t| t.swap(1, 2)));
}
