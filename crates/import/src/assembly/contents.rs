//! Pictures, materials, meshes, parts and cameras of the scene being built.

use super::Assembly;
use super::labels::FileLabel;
use crate::{ImportError, mesh};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec3};
use enfilade_scene::{Material, Object, ObjectId, Part, PartId, PartLabel, StartCamera, printable};
use std::path::Path;
use std::sync::Arc;

/// Below this ratio of a placement's determinant to the product of its axes' lengths, it flattens what it places.
const SINGULAR: f64 = 1e-12;

/// Greatest depth of nested objects: more levels carry no information.
const MAX_DEPTH: u8 = 64;

impl Assembly<'_> {
    /// Adds a picture made by the importer.
    pub(crate) fn push_image(&mut self, image: impl Into<Arc<enfilade_scene::Image>>) -> u32 {
        self.scene.images.push(image.into());
        (self.scene.images.len() - 1) as u32
    }

    /// The index that the next picture will have.
    pub(crate) fn next_image(&self) -> u32 {
        self.scene.images.len() as u32
    }

    /// A picture by its index.
    pub(crate) fn image_at(&self, index: u32) -> &enfilade_scene::Image {
        &self.scene.images[index as usize]
    }

    /// A mesh by its index.
    pub(crate) fn mesh_at(&self, index: u32) -> &Mesh {
        &self.scene.meshes[index as usize]
    }

    /// A material by its index.
    pub(crate) fn material_at(&self, index: u32) -> &Material {
        &self.scene.materials[index as usize]
    }

    /// Adds a material.
    pub(crate) fn push_material(&mut self, material: Material) -> u32 {
        self.scene.materials.push(material);
        (self.scene.materials.len() - 1) as u32
    }

    /// True when a material reads any picture.
    pub(crate) fn is_textured(&self, material: u32) -> bool {
        let mut found = false;
        self.scene.materials[material as usize].textures(|_| found = true);
        found
    }

    /// The area of a mesh under a placement.
    pub(crate) fn area(&self, mesh: u32, placement: DAffine3) -> f64 {
        mesh::area(self.mesh_at(mesh), placement)
    }

    /// Checks and repairs a mesh and adds it. `None` (and a warning) when it is empty.
    ///
    /// # Errors
    /// When an index is out of range or a position is not finite; `place` is the mesh's place in messages.
    pub(crate) fn push_mesh(&mut self, mut mesh: Mesh, file: &Path, place: &str) -> Result<Option<u32>, ImportError> {
        if mesh.triangles.is_empty() {
            self.warnings.push(format!("{}: {place}", file.display()), "the mesh has no triangles and was left out".into());
            return Ok(None);
        }
        for note in mesh::repair(&mut mesh) {
            self.warnings.push(format!("{}: {place}", file.display()), note);
        }
        mesh.validate().map_err(|e| ImportError::malformed(file, place, e.to_string()))?;
        self.scene.meshes.push(mesh.into());
        Ok(Some((self.scene.meshes.len() - 1) as u32))
    }

    /// Adds a mesh as [`Assembly::push_mesh`] does, whose positions count from `origin`, a point of the mesh's own space.
    ///
    /// # Errors
    /// As [`Self::push_mesh`].
    pub(crate) fn push_mesh_from(&mut self, origin: DVec3, mesh: Mesh, file: &Path, place: &str) -> Result<Option<u32>, ImportError> {
        let pushed = self.push_mesh(mesh, file, place)?;
        if let Some(index) = pushed.filter(|_| origin != DVec3::ZERO) {
            self.origins.insert(index, origin);
        }
        Ok(pushed)
    }

    /// Adds something that the file names as one thing, or that contains such things: a node, a prim, a group. Objects without parts are
    /// removed at the end.
    pub(crate) fn push_object(&mut self, name: &str, parent: Option<ObjectId>) -> ObjectId {
        let depth = |object: ObjectId| self.object_depths[object as usize];
        // An object that is nested too deeply becomes a sibling of its parent.
        let parent =
            parent.and_then(|parent| if depth(parent) < MAX_DEPTH { Some(parent) } else { self.scene.objects[parent as usize].parent });
        self.object_depths.push(parent.map_or(1, |parent| depth(parent) + 1));
        self.scene.objects.push(Object { name: printable(name, ""), parent });
        (self.scene.objects.len() - 1) as ObjectId
    }

    /// Makes a part one of an object.
    pub(crate) fn set_object(&mut self, part: PartId, object: ObjectId) {
        self.scene.parts[part as usize].object = Some(object);
    }

    /// Places a mesh that is an object by itself, as [`Self::push_part_of`] does those of objects.
    pub(crate) fn push_part(&mut self, name: &str, mesh: u32, material: u32, file_from_mesh: DAffine3, label: PartLabel) {
        let object = self.push_object(name, None);
        self.push_part_of(object, name, mesh, material, file_from_mesh, label);
    }

    /// Places a mesh of an object in the world under a unique name made from `name`. Of parts that a placement flattens only what keeps an
    /// area remains, with a warning. A mirrored placement gets a copy of the mesh with its triangles reversed, so that fronts stay fronts.
    /// `None` where nothing remains.
    pub(crate) fn push_part_of(
        &mut self,
        object: ObjectId,
        name: &str,
        mut mesh: u32,
        material: u32,
        file_from_mesh: DAffine3,
        label: impl Into<FileLabel>,
    ) -> Option<PartId> {
        let mut world_from_mesh = self.world_from_file * file_from_mesh;
        if let Some(origin) = self.origins.get(&mesh) {
            world_from_mesh *= DAffine3::from_translation(*origin);
        }
        let m = world_from_mesh.matrix3;
        let determinant = m.determinant();
        let size = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
        if !world_from_mesh.is_finite() || !determinant.is_finite() || determinant.abs() <= SINGULAR * size {
            let Some((sheet, placement)) = self.flattened(mesh, world_from_mesh) else {
                self.warn(format!("part {name:?}"), "its placement flattens it to nothing (a scale of zero), so it was left out");
                return None;
            };
            self.warn(format!("part {name:?}"), "its placement flattens it (a scale of zero); the faces that have an area then were kept");
            (mesh, world_from_mesh) = (sheet, placement);
        } else if determinant < 0.0 {
            mesh = self.reversed(mesh);
        }
        let name = self.part_names.unique(name);
        let part = self.scene.parts.len() as PartId;
        self.file_labels.push((part, label.into()));
        self.scene.parts.push(Part { name, object: Some(object), mesh, material, world_from_mesh });
        Some(part)
    }

    fn reversed(&mut self, mesh: u32) -> u32 {
        if let Some(&found) = self.reversed.get(&mesh) {
            return found;
        }
        let mut copy = Mesh::clone(&self.scene.meshes[mesh as usize]);
        copy.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        self.scene.meshes.push(copy.into());
        let index = (self.scene.meshes.len() - 1) as u32;
        self.reversed.insert(mesh, index);
        index
    }

    /// Adds a camera by its placement in the file (x right, y up, z backward) and horizontal field of view, under a unique name.
    pub(crate) fn push_camera(&mut self, name: &str, file_from_camera: DAffine3, fov_x_rad: f64, aspect: f64) {
        let placement = self.world_from_file * file_from_camera;
        let axes = orthonormal(placement.matrix3.y_axis, placement.matrix3.z_axis);
        let plausible = fov_x_rad > 0.0 && fov_x_rad < std::f64::consts::PI && aspect > 0.0 && aspect.is_finite();
        match axes {
            Some(world_from_camera) if plausible && placement.translation.is_finite() => {
                let name = self.camera_names.unique(name);
                let position = placement.translation;
                self.scene.cameras.push(StartCamera { name, position, world_from_camera, fov_x_rad, aspect });
            }
            _ => self.warn(format!("camera {name:?}"), "its placement or field of view makes no sense, so it was left out"),
        }
    }
}

/// Right-handed orthonormal axes with z along `z` and y as near to `y` as can be.
pub(crate) fn orthonormal(y: DVec3, z: DVec3) -> Option<DMat3> {
    let z = z.try_normalize()?;
    let x = y.try_normalize()?.cross(z).try_normalize()?;
    Some(DMat3::from_cols(x, z.cross(x).normalize(), z))
}
