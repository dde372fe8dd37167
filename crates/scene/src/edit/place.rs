//! Parts that go, move or grow.

use super::select::Selection;
use super::unused::LetGo;
use super::{EditError, LabelledScene};
use crate::{PartId, Scene};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec3};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Below this ratio of a placement's determinant to the product of its axes' lengths, it flattens what it places.
const SINGULAR: f64 = 1e-12;

impl LabelledScene {
    /// The scene without these parts, the lights that belong to them, and what only they use.
    ///
    /// # Errors
    /// When there is no part or object of a name, or several objects of one.
    pub fn without(&self, names: &[impl AsRef<str>]) -> Result<Self, EditError> {
        let Selection { parts, lights } = Selection::of(&self.scene, names)?;
        let mut edited = self.clone();
        let mut gone = LetGo::default();
        for part in parts.iter().map(|part| &self.scene.parts[*part as usize]) {
            gone.part(part, self.scene.objects_around(part));
        }
        let stays = |part: &PartId| !parts.contains(part);
        let mut index = 0..;
        edited.labels.parts.retain(|_| index.next().is_none_or(|part| stays(&part)));
        edited.scene.remove_parts(&parts);
        edited.scene.remove_lights(&lights.into_iter().map(|light| light as u32).collect());
        edited.drop_unused(gone);
        self.checked(edited)
    }

    /// The scene with these parts, and the lights that belong to them, moved by a map of the world to itself.
    ///
    /// A map that mirrors turns the triangles of meshes round, so that fronts stay fronts. The intensity of lights stays. Motion goes along
    /// where all that a body carries is moved; else what is moved keeps the body's motion as it was.
    ///
    /// # Errors
    /// When there is no part or object of a name, or several objects of one; when a part would be flattened or is nowhere afterwards; when
    /// a body that moves would be distorted or mirrored.
    pub fn moved(&self, names: &[impl AsRef<str>], world_from_before: DAffine3) -> Result<Self, EditError> {
        let Selection { parts, lights } = Selection::of(&self.scene, names)?;
        let mut edited = self.clone();
        let mut gone = LetGo::default();
        edited.scene.carry_bodies(&parts, &world_from_before)?;
        for part in parts {
            gone.mesh(&edited.scene.parts[part as usize]);
            let world_from_mesh = world_from_before * edited.scene.parts[part as usize].world_from_mesh;
            edited.scene.place(part, world_from_mesh)?;
        }
        for light in lights {
            edited.scene.lights[light] = edited.scene.lights[light].moved(&world_from_before);
        }
        edited.drop_unused(gone);
        self.checked(edited)
    }

    /// The scene with these parts turned about the vertical axis through the middle of their box, counter-clockwise seen from above.
    ///
    /// # Errors
    /// As [`LabelledScene::moved`].
    pub fn turned(&self, names: &[impl AsRef<str>], angle_rad: f64) -> Result<Self, EditError> {
        self.about(names, foot, DMat3::from_rotation_z(angle_rad))
    }

    /// The scene with these parts moved so that the middle of the bottom of their box is at `to`.
    ///
    /// # Errors
    /// As [`LabelledScene::moved`].
    pub fn moved_to(&self, names: &[impl AsRef<str>], to: DVec3) -> Result<Self, EditError> {
        let by = self.bounds_of(names)?.map_or(DVec3::ZERO, |bounds| to - foot(bounds));
        self.moved(names, DAffine3::from_translation(by))
    }

    /// The scene with these parts scaled along the axes of the world, about a point: unless given, the middle of the bottom of their box, so
    /// that what stands on the floor still does.
    ///
    /// # Errors
    /// As [`LabelledScene::moved`], and when a factor is not more than 0.
    pub fn scaled(&self, names: &[impl AsRef<str>], factors: DVec3, about: Option<DVec3>) -> Result<Self, EditError> {
        if !(factors.is_finite() && factors.min_element() > 0.0) {
            let what = names.iter().map(|name| format!("{:?}", name.as_ref())).collect::<Vec<_>>().join(", ");
            return Err(EditError::value(format!("scale of {what}"), format!("found {factors}, expected more than 0")));
        }
        self.about(names, |bounds| about.unwrap_or(foot(bounds)), DMat3::from_diagonal(factors))
    }

    fn about(&self, names: &[impl AsRef<str>], point: impl Fn([DVec3; 2]) -> DVec3, m: DMat3) -> Result<Self, EditError> {
        let fixed = self.bounds_of(names)?.map_or(DVec3::ZERO, point);
        self.moved(names, DAffine3 { matrix3: m, translation: fixed - m * fixed })
    }
}

/// The error for a body that would be distorted.
pub(super) fn not_rigid(body: &str) -> EditError {
    let problem = "it moves, so it can be moved, turned and scaled evenly, but not stretched or mirrored";
    EditError::value(format!("body {body:?}"), problem)
}

/// The middle of the bottom of a box.
fn foot([min, max]: [DVec3; 2]) -> DVec3 {
    (0.5 * (min + max)).with_z(min.z)
}

/// Checks that a placement of the part `name` keeps its volume.
pub(super) fn check_placement(name: &str, world_from_mesh: DAffine3) -> Result<(), EditError> {
    let m = world_from_mesh.matrix3;
    let size = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
    if world_from_mesh.is_finite() && m.determinant().abs() > SINGULAR * size {
        return Ok(());
    }
    Err(EditError::value(format!("part {name:?}"), format!("its placement cannot be inverted: {world_from_mesh:?}")))
}

impl Scene {
    /// Carries the motion of bodies and the cameras on them away, where these parts are all that they and the bodies on them have.
    fn carry_bodies(&mut self, parts: &BTreeSet<PartId>, map: &DAffine3) -> Result<(), EditError> {
        let mut whole: Vec<bool> = self.bodies.iter().map(|body| body.parts.iter().all(|part| parts.contains(part))).collect();
        let mut moves: Vec<bool> = self.bodies.iter().map(|body| body.parts.iter().any(|part| parts.contains(part))).collect();
        for body in (0..self.bodies.len()).rev() {
            if let Some(parent) = self.bodies[body].parent.map(|parent| parent as usize) {
                whole[parent] &= whole[body];
                moves[parent] |= moves[body];
            }
        }
        for (body, _) in self.bodies.iter_mut().zip(whole.iter().zip(&moves)).filter(|(_, (whole, moves))| **whole && **moves) {
            *body = body.carried(map).ok_or_else(|| not_rigid(&body.name))?;
            for &camera in &body.cameras {
                self.cameras[camera as usize] = self.cameras[camera as usize].moved(map);
            }
        }
        Ok(())
    }

    /// Places a part; where the placement mirrors and the earlier one did not, or the other way round, with its mesh turned inside out.
    pub(super) fn place(&mut self, part: PartId, world_from_mesh: DAffine3) -> Result<(), EditError> {
        let placed = &mut self.parts[part as usize];
        check_placement(&placed.name, world_from_mesh)?;
        let turns = mirrors(&world_from_mesh) != mirrors(&placed.world_from_mesh);
        placed.world_from_mesh = world_from_mesh;
        if turns {
            let turned = wound(&self.meshes[placed.mesh as usize], true);
            placed.mesh = index_of(&mut self.meshes, turned);
        }
        Ok(())
    }
}

/// True when a placement turns what is inside out.
pub(super) fn mirrors(placement: &DAffine3) -> bool {
    placement.matrix3.determinant() < 0.0
}

/// The mesh, with its triangles turned round if `turns`.
pub(super) fn wound(mesh: &Arc<Mesh>, turns: bool) -> Arc<Mesh> {
    let mut mesh = mesh.clone();
    if turns {
        Arc::make_mut(&mut mesh).triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    mesh
}

/// The index of an equal entry, or of the new one at the end.
pub(super) fn index_of<T: PartialEq>(list: &mut Vec<Arc<T>>, entry: Arc<T>) -> u32 {
    let found = list.iter().position(|known| Arc::ptr_eq(known, &entry) || *known == entry);
    found.unwrap_or_else(|| {
        list.push(entry);
        list.len() - 1
    }) as u32
}
