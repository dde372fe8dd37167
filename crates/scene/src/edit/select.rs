//! The parts and lights that names stand for.

use super::{EditError, LabelledScene};
use crate::{PartId, Scene};
use enfilade_math::{DVec3, place};
use std::collections::{BTreeMap, BTreeSet};

/// What names stand for.
pub struct Selection {
    /// Indices of parts.
    pub parts: BTreeSet<PartId>,
    /// Indices of the lights that belong to them.
    pub lights: BTreeSet<usize>,
}

impl Selection {
    /// The parts of these names and of the objects of these names, see [`crate::LabelledScene`].
    pub fn of(scene: &Scene, names: &[impl AsRef<str>]) -> Result<Self, EditError> {
        let by_name: BTreeMap<&str, PartId> = scene.parts.iter().map(|part| part.name.as_str()).zip(0..).collect();
        let mut parts = BTreeSet::new();
        for name in names.iter().map(AsRef::as_ref) {
            match by_name.get(name) {
                Some(part) => _ = parts.insert(*part),
                None => parts.extend(of_object(scene, name)?),
            }
        }
        let belongs = |light: &str| names.iter().any(|name| light.strip_prefix(name.as_ref()).is_some_and(|rest| rest.starts_with('/')));
        let lights = scene.lights.iter().enumerate().filter(|(_, light)| belongs(light.name())).map(|(index, _)| index).collect();
        Ok(Self { parts, lights })
    }

    /// The box around the parts in the world; `None` without parts.
    pub fn bounds(&self, scene: &Scene) -> Option<[DVec3; 2]> {
        self.parts.iter().map(|part| scene.part_bounds(*part)).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }
}

/// The parts of the object of that name.
fn of_object(scene: &Scene, name: &str) -> Result<Vec<PartId>, EditError> {
    let named = |object: &u32| scene.objects[*object as usize].name == name;
    let mut objects = BTreeSet::new();
    let mut parts = Vec::new();
    for (part, id) in scene.parts.iter().zip(0..) {
        // The innermost of nested objects of one name is not another one.
        if let Some(object) = scene.objects_around(part).filter(named).last() {
            objects.insert(object);
            parts.push(id);
        }
    }
    match (objects.len(), parts.first()) {
        (1, _) => Ok(parts),
        (count, Some(first)) => Err(EditError::Ambiguous { name: name.into(), count, part: scene.parts[*first as usize].name.clone() }),
        (_, None) => {
            let around = scene.objects.iter().map(|object| object.name.as_str());
            let known: Vec<&str> = scene.parts.iter().map(|part| part.name.as_str()).chain(around).collect();
            Err(EditError::unknown("part or object", name, &known))
        }
    }
}

impl LabelledScene {
    /// The parts that names stand for, in the order of the scene.
    ///
    /// # Errors
    /// When there is no part or object of a name, or several objects of one.
    pub fn select(&self, names: &[impl AsRef<str>]) -> Result<Vec<PartId>, EditError> {
        Ok(Selection::of(&self.scene, names)?.parts.into_iter().collect())
    }

    /// The least and greatest coordinates of the parts that names stand for, metres of the world; `None` without names.
    ///
    /// # Errors
    /// As [`LabelledScene::select`].
    pub fn bounds_of(&self, names: &[impl AsRef<str>]) -> Result<Option<[DVec3; 2]>, EditError> {
        Ok(Selection::of(&self.scene, names)?.bounds(&self.scene))
    }
}

impl Scene {
    /// The least and greatest coordinates of the triangles of a part, metres of the world.
    ///
    /// # Panics
    /// When there is no such part.
    pub fn part_bounds(&self, part: PartId) -> [DVec3; 2] {
        let part = &self.parts[part as usize];
        let mesh = &self.meshes[part.mesh as usize];
        let corners = mesh.triangles.iter().flatten().map(|corner| mesh.positions[*corner as usize]);
        let placed = corners.map(|p| place(&part.world_from_mesh, p).as_dvec3());
        placed.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[min, max], p| [min.min(p), max.max(p)])
    }
}
