//! Results for the objects of a scene, so that each is converted once.

use super::xml::Node;
use crate::obj::Library;
use crate::ply::Means;
use std::collections::HashMap;
use std::rc::Rc;

/// Key of a material: its bsdf element (by address, since the tree outlives the reader), its emitter, the medium within, and the mesh whose
/// attributes it uses.
pub(super) type MaterialKey = ([Option<*const Node>; 3], Option<u32>);

/// Key of a mesh: plugin, file, index within it, and the flags that change it.
pub(super) type MeshKey = (String, String, i64, [bool; 3]);

/// Data of OBJ files that shapes share.
#[derive(Default)]
pub(super) struct ObjFiles {
    /// By path and the flags that change meshes.
    pub files: HashMap<(String, [bool; 3]), Rc<ObjMeshes>>,
    /// By path of the OBJ file.
    pub libraries: HashMap<String, Rc<Library>>,
    /// By path of the OBJ file and name; `None` where no library defines it.
    pub materials: HashMap<(String, String), Option<u32>>,
}

/// An OBJ file.
#[derive(Default)]
pub(super) struct ObjMeshes {
    pub meshes: Vec<ObjMesh>,
    /// Names of its material libraries.
    pub libraries: Vec<String>,
}

/// The faces of a file with one group and material.
pub(super) struct ObjMesh {
    /// Name of the group, else of the material.
    pub name: String,
    pub material: Option<String>,
    /// `None` where it is empty.
    pub mesh: Option<u32>,
}

/// The attributes of the scene's meshes.
#[derive(Default)]
pub(super) struct Attributes {
    /// True when a texture of the scene refers to any.
    pub wanted: bool,
    /// By mesh; only where some are wanted.
    pub of_mesh: HashMap<u32, Means>,
    /// The mesh whose material is read, if it has attributes.
    pub current: Option<u32>,
}

impl Attributes {
    /// Notes those of a mesh.
    pub(super) fn insert(&mut self, mesh: u32, means: Means) {
        if !means.is_empty() {
            self.of_mesh.insert(mesh, means);
        }
    }

    /// From here on materials are those of `mesh`.
    pub(super) fn turn_to(&mut self, mesh: Option<u32>) {
        self.current = mesh.filter(|mesh| self.of_mesh.contains_key(mesh));
    }
}
