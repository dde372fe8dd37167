//! Parts that are added: a mesh, or all of another scene.

use super::materials::MaterialChoice;
use super::names::unique_thing;
use super::place::{check_placement, index_of, mirrors, not_rigid, wound};
use super::{EditError, LabelledScene};
use crate::{Body, Material, Object, Part, PartId, PartLabel, Scene, SceneError, is_stuff};
use enfilade_geometry::Mesh;
use enfilade_math::DAffine3;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A mesh that becomes a part.
#[derive(Clone, Debug, PartialEq)]
pub struct NewPart {
    /// Name of the part; where something has it, it gets a number.
    pub name: String,
    /// Counter-clockwise triangles face outward.
    pub mesh: Arc<Mesh>,
    /// What it is made of.
    pub material: MaterialChoice,
    /// Placement of the mesh in the world. If it mirrors, the triangles are turned round, so that fronts stay fronts.
    pub world_from_mesh: DAffine3,
    /// NYU40 class, 1 to 40; it becomes an instance of it.
    pub class: Option<i16>,
}

impl NewPart {
    /// A part at the origin without a class.
    pub fn new(name: impl Into<String>, mesh: impl Into<Arc<Mesh>>, material: MaterialChoice) -> Self {
        Self { name: name.into(), mesh: mesh.into(), material, world_from_mesh: DAffine3::IDENTITY, class: None }
    }
}

/// All of a scene that becomes part of another one.
#[derive(Clone, Debug)]
pub struct NewThing<'a> {
    /// Name of the object that contains it; where something has it, it gets a number. A single part gets this name, several get it before
    /// theirs, with a slash between.
    pub name: String,
    /// What is added: its parts, and its lights. Its surroundings and cameras are not.
    pub of: &'a LabelledScene,
    /// A material instead of all of its own.
    pub material: Option<MaterialChoice>,
    /// Placement of the thing in the world.
    pub world_from_thing: DAffine3,
    /// NYU40 class of all of its parts, which become one instance; unless given, they have their own labels, with new instances.
    pub class: Option<i16>,
}

impl LabelledScene {
    /// The scene with one more part.
    ///
    /// # Errors
    /// When the mesh, the placement or the material is not valid, with the name of the part.
    pub fn with_part(&self, new: &NewPart) -> Result<Self, EditError> {
        let name = unique_thing(&self.scene, &new.name);
        new.mesh.validate().map_err(|error| SceneError::Mesh { part: name.clone(), error })?;
        check_placement(&name, new.world_from_mesh)?;
        let mut edited = self.clone();
        let scene = &mut edited.scene;
        let material = scene.material(&new.material, |_| false)?;
        let mesh = wound(&new.mesh, mirrors(&new.world_from_mesh));
        let part = Part { name, object: None, mesh: index_of(&mut scene.meshes, mesh), material, world_from_mesh: new.world_from_mesh };
        scene.parts.push(part);
        scene.check_coordinates(scene.parts.len() as PartId - 1)?;
        edited.labels.parts.push(edited.label_of(new.class)?);
        self.checked(edited)
    }

    /// The scene with all parts and lights of another one.
    ///
    /// # Errors
    /// As [`LabelledScene::with_part`], and when a body that moves would be distorted or mirrored.
    pub fn with_thing(&self, new: &NewThing<'_>) -> Result<Self, EditError> {
        let name = unique_thing(&self.scene, &new.name);
        let mut edited = self.clone();
        let label = edited.label_of(new.class)?;
        let root = edited.scene.objects.len() as u32;
        edited.scene.objects.push(Object { name: name.clone(), parent: None });
        let of = &new.of.scene;
        let inner = |object: Option<u32>| object.map_or(root, |object| root + 1 + object);
        edited.scene.objects.extend(of.objects.iter().map(|o| Object { name: o.name.clone(), parent: Some(inner(o.parent)) }));
        let materials = edited.take_materials(new)?;
        let instances = edited.new_instances(new.of)?;
        for (part, own) in of.parts.iter().zip(&new.of.labels.parts) {
            let part_name = if of.parts.len() == 1 { name.clone() } else { format!("{name}/{}", part.name) };
            let world_from_mesh = new.world_from_thing * part.world_from_mesh;
            check_placement(&part_name, world_from_mesh)?;
            let mesh = wound(&of.meshes[part.mesh as usize], mirrors(&world_from_mesh) != mirrors(&part.world_from_mesh));
            edited.scene.parts.push(Part {
                name: part_name,
                object: Some(inner(part.object)),
                mesh: index_of(&mut edited.scene.meshes, mesh),
                material: materials[&part.material],
                world_from_mesh,
            });
            if new.material.is_some() {
                edited.scene.check_coordinates(edited.scene.parts.len() as PartId - 1)?;
            }
            let own = PartLabel { instance: instances.get(&own.instance).copied().unwrap_or(-1), ..*own };
            edited.labels.parts.push(if new.class.is_some() { label } else { own });
        }
        for light in &of.lights {
            let own_name = if light.name().is_empty() { "light" } else { light.name() };
            edited.scene.lights.push(light.moved(&new.world_from_thing).renamed(format!("{name}/{own_name}")));
        }
        edited.take_bodies(&self.scene, new, &name)?;
        self.checked(edited)
    }

    /// A label with a class and an instance that no part has.
    fn label_of(&self, class: Option<i16>) -> Result<PartLabel, EditError> {
        match class {
            None => Ok(PartLabel::NONE),
            Some(semantic) if !(1..=40).contains(&semantic) => {
                Err(EditError::value("label", format!("found the class {semantic}, expected 1 to 40")))
            }
            Some(semantic) if is_stuff(semantic) => Ok(PartLabel { semantic, instance: -1 }),
            Some(semantic) => Ok(PartLabel { semantic, instance: self.free_instance()? }),
        }
    }

    fn free_instance(&self) -> Result<i16, EditError> {
        let largest = self.labels.parts.iter().map(|label| label.instance).max().unwrap_or(0).max(0);
        largest.checked_add(1).ok_or_else(|| EditError::value("labels", format!("no instance number is left after {largest}")))
    }

    /// Numbers that no part has, by the instances of another scene.
    fn new_instances(&self, of: &Self) -> Result<BTreeMap<i16, i16>, EditError> {
        let own: BTreeSet<i16> = of.labels.parts.iter().map(|label| label.instance).filter(|instance| *instance > 0).collect();
        let first = if own.is_empty() { 1 } else { self.free_instance()? };
        let last = usize::from(first.unsigned_abs()) + own.len();
        if last > i16::MAX as usize + 1 {
            return Err(EditError::value("labels", format!("{} more instances than numbers are left", last - i16::MAX as usize - 1)));
        }
        Ok(own.into_iter().zip(first..).collect())
    }

    /// Adds the bodies of a thing, whose parts and lights come after those of the scene `before`.
    fn take_bodies(&mut self, before: &Scene, new: &NewThing<'_>, name: &str) -> Result<(), EditError> {
        let [parts, lights, bodies] = [before.parts.len(), before.lights.len(), before.bodies.len()].map(|count| count as u32);
        for body in &new.of.scene.bodies {
            let carried = body.carried(&new.world_from_thing).ok_or_else(|| not_rigid(&body.name))?;
            self.scene.bodies.push(Body {
                name: format!("{name}/{}", body.name),
                parent: body.parent.map(|parent| bodies + parent),
                parts: body.parts.iter().map(|part| parts + part).collect(),
                lights: body.lights.iter().map(|light| lights + light).collect(),
                // Cameras of a thing are not added.
                cameras: Vec::new(),
                limits: carried.limits,
                motion: carried.motion,
            });
        }
        Ok(())
    }

    /// Adds the materials and pictures that the parts of a thing use; gives their new indices.
    fn take_materials(&mut self, new: &NewThing<'_>) -> Result<BTreeMap<u32, u32>, EditError> {
        let of = &new.of.scene;
        let used: BTreeSet<u32> = of.parts.iter().map(|part| part.material).collect();
        if let Some(choice) = &new.material {
            let material = self.scene.material(choice, |_| false)?;
            return Ok(used.into_iter().map(|own| (own, material)).collect());
        }
        let mut materials = BTreeMap::new();
        for own in used {
            let material: &Material = &of.materials[own as usize];
            let mut places = BTreeMap::new();
            material.textures(|texture| _ = places.insert(texture.image, 0));
            for (image, place) in &mut places {
                *place = index_of(&mut self.scene.images, of.images[*image as usize].clone());
                if let Some(file) = new.of.picture_files.get(image) {
                    self.picture_files.entry(*place).or_insert_with(|| file.clone());
                }
            }
            materials.insert(own, self.scene.push_material(material.clone().repictured(|image| places[&image]), |_| false));
        }
        Ok(materials)
    }
}
