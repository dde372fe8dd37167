//! Materials of parts.

use super::names::{printable, unique};
use super::place::index_of;
use super::select::Selection;
use super::unused::LetGo;
use super::{EditError, LabelledScene};
use crate::{Image, Material, PartId, Scene};
use std::collections::BTreeSet;
use std::sync::Arc;

/// A material for parts: one that the scene has, or a new one.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialChoice {
    /// The first of the scene's materials that has this name.
    Named(String),
    /// A new one, unless the scene has an equal one. Where another has its name, the name gets a number.
    New {
        /// The material, whose textures refer to `images`.
        material: Box<Material>,
        /// Pictures of the textures.
        images: Vec<Arc<Image>>,
    },
}

impl From<Material> for MaterialChoice {
    /// A new material without textures.
    fn from(material: Material) -> Self {
        Self::New { material: Box::new(material), images: Vec::new() }
    }
}

impl LabelledScene {
    /// The scene with these parts made of a material. Materials and pictures that only they used are dropped.
    ///
    /// # Errors
    /// When there is no part or object of a name, or several objects of one; when the scene has no material of the name chosen, or a number of the
    /// new one is out of its domain; when the material has textures, and a part has no texture coordinates.
    pub fn with_material(&self, names: &[impl AsRef<str>], choice: &MaterialChoice) -> Result<Self, EditError> {
        let parts = Selection::of(&self.scene, names)?.parts;
        let mut edited = self.clone();
        edited.set_material(&parts, choice)?;
        self.checked(edited)
    }

    /// Makes parts of a material.
    pub(super) fn set_material(&mut self, parts: &BTreeSet<PartId>, choice: &MaterialChoice) -> Result<(), EditError> {
        let mut gone = LetGo::default();
        parts.iter().for_each(|part| gone.material(&self.scene.parts[*part as usize]));
        // Names of materials that nothing else uses become free.
        let others = self.scene.parts.iter().zip(0..).filter(|(_, id)| !parts.contains(id));
        let kept: BTreeSet<u32> = others.map(|(part, _)| part.material).collect();
        let let_go: BTreeSet<u32> = parts.iter().map(|part| self.scene.parts[*part as usize].material).collect();
        let material = self.scene.material(choice, |index| let_go.contains(&index) && !kept.contains(&index))?;
        for part in parts {
            self.scene.parts[*part as usize].material = material;
            self.scene.check_coordinates(*part)?;
        }
        self.drop_unused(gone);
        Ok(())
    }
}

impl Scene {
    /// The index of a material, which is added where it is new. Names of materials of which `is_free` is true may be taken again.
    pub(super) fn material(&mut self, choice: &MaterialChoice, is_free: impl Fn(u32) -> bool) -> Result<u32, EditError> {
        match choice {
            MaterialChoice::Named(name) => {
                let found = self.materials.iter().position(|material| material.name == *name);
                let names = || self.materials.iter().map(|material| material.name.as_str()).collect::<Vec<_>>();
                found.map(|index| index as u32).ok_or_else(|| EditError::unknown("material", name, &names()))
            }
            MaterialChoice::New { material, images } => {
                let places: Vec<u32> = images.iter().map(|image| index_of(&mut self.images, image.clone())).collect();
                let place = |image: u32| places.get(image as usize).copied().unwrap_or(u32::MAX);
                Ok(self.push_material(material.as_ref().clone().repictured(place), is_free))
            }
        }
    }

    /// The index of an equal material, or of the new one at the end, under a name that no other has.
    pub(super) fn push_material(&mut self, material: Material, is_free: impl Fn(u32) -> bool) -> u32 {
        let material = Material { name: printable(&material.name, "material"), ..material };
        if let Some(equal) = self.materials.iter().position(|known| *known == material) {
            return equal as u32;
        }
        let taken: BTreeSet<&str> =
            self.materials.iter().zip(0..).filter(|(_, index)| !is_free(*index)).map(|(known, _)| known.name.as_str()).collect();
        let name = unique(material.name.clone(), |name| taken.contains(name));
        self.materials.push(Material { name, ..material });
        self.materials.len() as u32 - 1
    }

    /// Checks that a part whose material has textures has texture coordinates.
    pub(super) fn check_coordinates(&self, part: PartId) -> Result<(), EditError> {
        let part = &self.parts[part as usize];
        let material = &self.materials[part.material as usize];
        let mut has_textures = false;
        material.textures(|_| has_textures = true);
        if has_textures && self.meshes[part.mesh as usize].uvs.is_empty() {
            let problem = format!("its mesh has no texture coordinates, which the textures of the material {:?} need", material.name);
            return Err(EditError::value(format!("part {:?}", part.name), problem));
        }
        Ok(())
    }
}
