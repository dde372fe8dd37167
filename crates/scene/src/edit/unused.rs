//! What nothing uses after an edit goes: meshes, materials, pictures and objects that the edit let go of. What was unused before stays.

use super::LabelledScene;
use crate::{Environment, Material, Part};
use std::collections::BTreeSet;

/// What an edit let go of, by index; something else may still use it.
#[derive(Default)]
pub struct LetGo {
    meshes: BTreeSet<u32>,
    materials: BTreeSet<u32>,
    objects: BTreeSet<u32>,
}

impl LetGo {
    /// A part's mesh.
    pub fn mesh(&mut self, part: &Part) {
        self.meshes.insert(part.mesh);
    }

    /// A part's material.
    pub fn material(&mut self, part: &Part) {
        self.materials.insert(part.material);
    }

    /// All of a part that goes; `objects` are those around it.
    pub fn part(&mut self, part: &Part, objects: impl Iterator<Item = u32>) {
        self.mesh(part);
        self.material(part);
        self.objects.extend(objects);
    }
}

impl LabelledScene {
    /// Drops what was let go of and nothing uses now; the order of the rest stays.
    pub(super) fn drop_unused(&mut self, gone: LetGo) {
        let scene = &mut self.scene;
        let mut meshes = gone.meshes;
        scene.parts.iter().for_each(|part| _ = meshes.remove(&part.mesh));
        let new = remove(&mut scene.meshes, &meshes);
        scene.parts.iter_mut().for_each(|part| part.mesh = new(part.mesh));

        let mut objects = gone.objects;
        for part in &scene.parts {
            scene.objects_around(part).for_each(|object| _ = objects.remove(&object));
        }
        let new = remove(&mut scene.objects, &objects);
        scene.parts.iter_mut().for_each(|part| part.object = part.object.map(&new));
        scene.objects.iter_mut().for_each(|object| object.parent = object.parent.map(&new));

        let mut materials = gone.materials;
        scene.parts.iter().for_each(|part| _ = materials.remove(&part.material));
        let images = images_of(materials.iter().map(|material| &scene.materials[*material as usize]));
        let new = remove(&mut scene.materials, &materials);
        scene.parts.iter_mut().for_each(|part| part.material = new(part.material));
        self.drop_images(images);
    }

    /// Drops the pictures that `earlier` materials read and nothing reads now.
    pub fn drop_pictures_of(&mut self, earlier: &[Material]) {
        self.drop_images(images_of(earlier.iter()));
    }

    fn drop_images(&mut self, mut images: BTreeSet<u32>) {
        let scene = &mut self.scene;
        images_of(scene.materials.iter()).iter().for_each(|image| _ = images.remove(image));
        if let Some(Environment::Map { image, .. }) = &scene.environment {
            images.remove(image);
        }
        if images.is_empty() {
            return;
        }
        let new = remove(&mut scene.images, &images);
        scene.materials = std::mem::take(&mut scene.materials).into_iter().map(|material| material.repictured(&new)).collect();
        if let Some(Environment::Map { image, .. }) = &mut scene.environment {
            *image = new(*image);
        }
        let files = std::mem::take(&mut self.picture_files).into_iter();
        self.picture_files = files.filter(|(image, _)| !images.contains(image)).map(|(image, file)| (new(image), file)).collect();
    }
}

/// The pictures that materials read.
fn images_of<'a>(materials: impl Iterator<Item = &'a Material>) -> BTreeSet<u32> {
    let mut images = BTreeSet::new();
    materials.for_each(|material| material.textures(|texture| _ = images.insert(texture.image)));
    images
}

/// Removes the entries at `gone`; returns the new index of each that stays.
fn remove<'g, T>(list: &mut Vec<T>, gone: &'g BTreeSet<u32>) -> impl Fn(u32) -> u32 + use<'g, T> {
    let mut index = 0..;
    list.retain(|_| index.next().is_none_or(|index| !gone.contains(&index)));
    move |old| old - gone.range(..old).count() as u32
}
