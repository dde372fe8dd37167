//! The objects of a scene as triangles in the world.

use enfilade_furniture::meet::{Body, Triangle};
use enfilade_furniture::object_of;
use enfilade_math::Vec3;
use enfilade_scene::{PartId, Scene};
use std::collections::BTreeMap;

/// The objects of a scene, by name.
pub fn bodies_of(scene: &Scene) -> Vec<Body> {
    let mut bodies: BTreeMap<&str, Body> = BTreeMap::new();
    for (part, id) in scene.parts.iter().zip(0..) {
        let name = object_of(&part.name);
        bodies.entry(name).or_insert_with(|| Body::new(name)).push(triangles(scene, id));
    }
    bodies.into_values().collect()
}

/// The triangles of a part in the world.
pub fn triangles(scene: &Scene, part: PartId) -> Vec<Triangle> {
    let part = &scene.parts[part as usize];
    let world: Vec<Vec3> = scene.world_positions(part).collect();
    scene.meshes[part.mesh as usize].triangles.iter().map(|t| t.map(|i| world[i as usize])).collect()
}

/// The object of this name.
pub fn body_named(scene: &Scene, name: &str) -> Body {
    let mut body = Body::new(name);
    let parts = scene.parts.iter().zip(0..).filter(|(part, _)| object_of(&part.name) == name);
    parts.for_each(|(_, part)| body.push(triangles(scene, part)));
    body
}
