//! `obj` shapes of version 0.x, whose files contain several meshes, each with a material of its own.
//!
//! A mesh has the faces of one group and material. Its material is the shape's last bsdf that is unnamed or has the material's name, else
//! the material of the file's libraries, on its front alone.

use super::made::{ObjMesh, ObjMeshes};
use super::reader::Reader;
use super::xml::Node;
use super::{bsdf, shape};
use crate::ImportError;
use crate::obj::{self, ObjFile};
use enfilade_math::{DAffine3, Rgb};
use enfilade_scene::Material;
use enfilade_scene::ObjectId;
use std::collections::HashMap;
use std::rc::Rc;

impl<'n> Reader<'n, '_> {
    /// Adds the parts of an `obj` shape: all, or the one of `shapeIndex`.
    pub(super) fn obj_shape(
        &mut self,
        node: &'n Node,
        emitter: Option<&'n Node>,
        outer: DAffine3,
        prefix: &str,
    ) -> Result<(), ImportError> {
        let (path, flags) = self.stated(node)?;
        let file = self.obj_file(node, path, flags)?;
        if file.meshes.is_empty() {
            return Ok(());
        }
        let only = usize::try_from(node.float_or("shape_index", -1.0)? as i64).ok();
        if let Some(only) = only.filter(|&only| only >= file.meshes.len()) {
            return Err(node.error(format!("found shapeIndex {only}, but there are only {} meshes in {path}", file.meshes.len())));
        }
        let bsdfs = self.named_bsdfs(node)?;
        let stray = self.stray(node, &bsdfs, &file);
        let (file_from_mesh, medium) = (self.placement(node, outer)?, self.medium_inside(node)?);
        let chosen = file.meshes.iter().enumerate().filter(|(i, _)| only.is_none_or(|only| only == *i));
        let mut objects: HashMap<&str, ObjectId> = HashMap::new();
        for part in chosen.map(|(_, part)| part) {
            let Some(mesh) = part.mesh else { continue };
            let material = part.material.as_deref();
            let own = bsdfs.iter().rev().find(|(name, _)| name.is_empty() || Some(*name) == material).map(|(_, bsdf)| *bsdf);
            let from_library = match material {
                Some(name) if own.is_none() && emitter.is_none() && node.flag("load_materials", true) => {
                    self.material_of_library(node, path, &file, name)?.map(|index| (name, index))
                }
                _ => None,
            };
            let bsdf = own.or(stray);
            let (title, material) = match from_library {
                Some((name, index)) => {
                    if let Some(medium) = medium {
                        self.warn(medium, format!("it was left out of the material {name:?}, which is the OBJ file's"));
                    }
                    (name, Some(index))
                }
                None => (bsdf::name(bsdf), self.material(bsdf, emitter, medium)?),
            };
            let Some(material) = material else {
                self.warn(node, "the shape scatters nothing (null bsdf) and was left out");
                continue;
            };
            let name = node.id.clone().unwrap_or_else(|| format!("{title}_{}", shape::stem(path)));
            let name = if file.meshes.len() > 1 { format!("{name}.{}", part.name) } else { name };
            let own = node.id.as_deref().filter(|_| file.meshes.len() == 1).unwrap_or(&part.name);
            let object = *objects.entry(&part.name).or_insert_with(|| self.a.push_object(own, None));
            self.place(node, Some(object), &format!("{prefix}{name}"), mesh, material, file_from_mesh)?;
        }
        Ok(())
    }

    /// The file, read once.
    fn obj_file(&mut self, node: &'n Node, path: &str, flags: [bool; 3]) -> Result<Rc<ObjMeshes>, ImportError> {
        let key = (path.to_string(), flags);
        if let Some(known) = self.obj.files.get(&key) {
            return Ok(known.clone());
        }
        let read = self.a.read(path).and_then(|(file, bytes)| Ok((ObjFile::parse(&bytes, &file)?, file)));
        let Some((mut obj, file)) = self.a.mesh_or_none(read, path, &node.place())? else {
            let none = Rc::new(ObjMeshes::default());
            self.obj.files.insert(key, none.clone());
            return Ok(none);
        };
        obj.settle(self.a.meters_per_unit());
        obj.notes.iter().for_each(|note| self.a.warn(node.place(), format!("{}: {note}", file.display())));
        if obj.groups.is_empty() {
            self.warn(node, format!("{}: there are no faces; the shape was left out", file.display()));
        }
        let mut meshes = Vec::with_capacity(obj.groups.len());
        for group in &obj.groups {
            let name = group.name.clone().or_else(|| group.material.clone()).unwrap_or_else(|| "mesh".to_string());
            let place = if obj.groups.len() > 1 { format!("mesh {name:?}") } else { "mesh".to_string() };
            let mesh = shape::finish(obj.mesh(std::iter::once(group)), true, flags);
            let mesh = self.a.push_mesh_from(obj.origin, mesh, &file, &place)?;
            meshes.push(ObjMesh { name, material: group.material.clone(), mesh });
        }
        let read = Rc::new(ObjMeshes { meshes, libraries: obj.libraries });
        self.obj.files.insert(key, read.clone());
        Ok(read)
    }

    /// The bsdfs of a shape, each with the name of the file's material that it is for.
    fn named_bsdfs(&self, node: &'n Node) -> Result<Vec<(&'n str, &'n Node)>, ImportError> {
        let mut found = Vec::new();
        for child in node.children.iter().filter(|c| matches!(c.tag.as_str(), "bsdf" | "ref")) {
            let target = self.resolve(child)?;
            if target.tag == "bsdf" {
                found.push((child.attribute("name").unwrap_or_default(), target));
            }
        }
        Ok(found)
    }

    /// A bsdf for a material that the file does not have. It is the best guess for what has no other.
    fn stray(&mut self, node: &'n Node, bsdfs: &[(&'n str, &'n Node)], file: &ObjMeshes) -> Option<&'n Node> {
        let has = |name: &str| file.meshes.iter().any(|part| part.material.as_deref() == Some(name));
        let (name, bsdf) = bsdfs.iter().find(|(name, _)| !name.is_empty() && !has(name))?;
        self.warn(node, format!("the OBJ file has no material {name:?}; the bsdf of this name was used for what has no other"));
        Some(*bsdf)
    }

    /// The material that the libraries of an OBJ file define by a name. `None` where they do not.
    fn material_of_library(&mut self, node: &'n Node, path: &str, file: &ObjMeshes, name: &str) -> Result<Option<u32>, ImportError> {
        let key = (path.to_string(), name.to_string());
        if let Some(&known) = self.obj.materials.get(&key) {
            return Ok(known);
        }
        let library = match self.obj.libraries.get(path) {
            Some(known) => known.clone(),
            None => {
                let read = Rc::new(obj::libraries(&file.libraries, path, &mut self.a)?);
                self.obj.libraries.insert(path.to_string(), read.clone());
                read
            }
        };
        let found = match obj::material(name, &library, &mut self.a) {
            // Mitsuba continues too.
            Err(error @ ImportError::Texture { .. }) => {
                self.warn(node, format!("{error}; the material {name:?} of the OBJ file was not used"));
                None
            }
            found => found?,
        };
        let found = found.map(|material| {
            self.warn(node, format!("the material {name:?} is the OBJ file's; expect other colours than Mitsuba's, which decodes them"));
            self.a.push_material(Material { two_sided: false, emission: Rgb::BLACK.into(), emits_both_sides: false, ..material })
        });
        self.obj.materials.insert(key, found);
        Ok(found)
    }
}
