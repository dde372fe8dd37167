//! Parts, cameras and lights as nodes below a root that turns our z up into glTF's y up.

use super::document::Document;
use super::motion::{Bodies, adopt};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec3, Rgb, Vec3};
use enfilade_scene::{Labels, Light, NYU40, Object, PartLabel, Scene, SpotFalloff, StartCamera, is_stuff};
use serde_json::{Value, json};
use std::collections::HashMap;

/// Takes our z up to glTF's y up, column by column.
const GLTF_FROM_WORLD: [f32; 16] = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];

/// Adds the root and everything below it.
pub(super) fn add_all(document: &mut Document, scene: &Scene, labels: &Labels) {
    document.nodes.push(Value::Null);
    let bodies = Bodies::add(document, scene);
    let mut children: Vec<usize> = bodies.roots(scene).collect();
    let mut vertices: HashMap<u32, Value> = HashMap::new();
    let mut faces: HashMap<(u32, bool), Value> = HashMap::new();
    let mut meshes: HashMap<(u32, u32, bool), usize> = HashMap::new();
    for (index, part) in scene.parts.iter().enumerate() {
        let mirrored = part.world_from_mesh.matrix3.determinant() < 0.0;
        let mesh = *meshes.entry((part.mesh, part.material, mirrored)).or_insert_with(|| {
            let shape = &scene.meshes[part.mesh as usize];
            let attributes = vertices.entry(part.mesh).or_insert_with(|| attributes(document, shape)).clone();
            let indices = faces.entry((part.mesh, mirrored)).or_insert_with(|| indices(document, shape, mirrored)).clone();
            let primitive = json!({ "attributes": attributes, "indices": indices, "material": part.material });
            document.meshes.push(json!({ "primitives": [primitive] }));
            document.meshes.len() - 1
        });
        let mut node = json!({ "name": part.name, "mesh": mesh });
        let bearer = bodies.of_part(index);
        place(&mut node, &bearer.map_or(part.world_from_mesh, |(_, from_world)| *from_world * part.world_from_mesh));
        if let Some(extras) = labels.parts.get(index).and_then(extras) {
            node["extras"] = extras;
        }
        if let Some(object) = part.object {
            node["extras"]["object"] = json!(object);
        }
        document.nodes.push(node);
        put(document, &mut children, bearer.map(|(bearer, _)| bearer));
    }
    for (index, camera) in scene.cameras.iter().enumerate() {
        let bearer = bodies.of_camera(index);
        add_camera(document, camera, bearer.map_or(&DAffine3::IDENTITY, |(_, from_world)| from_world));
        put(document, &mut children, bearer.map(|(bearer, _)| bearer));
    }
    for (index, light) in scene.lights.iter().enumerate() {
        let bearer = bodies.of_light(index);
        if add_light(document, light, bearer.map_or(&DAffine3::IDENTITY, |(_, from_world)| from_world)) {
            put(document, &mut children, bearer.map(|(bearer, _)| bearer));
        }
    }
    document.nodes[0] = json!({ "name": "z_up_to_y_up", "matrix": GLTF_FROM_WORLD, "children": children });
}

/// Puts the node that was added last below a body, or else among the root's children.
fn put(document: &mut Document, children: &mut Vec<usize>, bearer: Option<usize>) {
    let node = document.nodes.len() - 1;
    match bearer {
        Some(bearer) => adopt(document, bearer, node),
        None => children.push(node),
    }
}

/// The mesh's triangles. Under a mirroring matrix glTF takes the other side for the front, so the corners of those parts are swapped.
fn indices(document: &mut Document, mesh: &Mesh, mirrored: bool) -> Value {
    let triangles: Vec<[u32; 3]> = mesh.triangles.iter().map(|&[a, b, c]| if mirrored { [a, c, b] } else { [a, b, c] }).collect();
    json!(document.buffer.indices(&triangles))
}

/// The mesh's vertices. Texture coordinates point down in glTF.
fn attributes(document: &mut Document, mesh: &Mesh) -> Value {
    let buffer = &mut document.buffer;
    let positions: Vec<[f32; 3]> = mesh.positions.iter().map(|p| p.to_array()).collect();
    let mut attributes = json!({ "POSITION": buffer.vectors(&positions, true) });
    if !mesh.normals.is_empty() {
        let normals: Vec<[f32; 3]> = mesh.normals.iter().map(|n| n.normalize_or(Vec3::Z).to_array()).collect();
        attributes["NORMAL"] = json!(buffer.vectors(&normals, false));
    }
    if !mesh.uvs.is_empty() {
        let uvs: Vec<[f32; 2]> = mesh.uvs.iter().map(|uv| [uv.x, 1.0 - uv.y]).collect();
        attributes["TEXCOORD_0"] = json!(buffer.vectors(&uvs, false));
    }
    attributes
}

/// Gives a node its matrix, unless it is the identity.
fn place(node: &mut Value, world_from_node: &DAffine3) {
    if *world_from_node != DAffine3::IDENTITY {
        let m = world_from_node.matrix3;
        let column = |c: DVec3, w: f32| [c.x as f32, c.y as f32, c.z as f32, w];
        let columns = [column(m.x_axis, 0.0), column(m.y_axis, 0.0), column(m.z_axis, 0.0), column(world_from_node.translation, 1.0)];
        node["matrix"] = json!(columns.concat());
    }
}

/// An object in the list of the scene's extras.
pub(super) fn object(object: &Object) -> Value {
    let mut entry = json!({ "name": object.name });
    if let Some(parent) = object.parent {
        entry["parent"] = json!(parent);
    }
    entry
}

/// The label for the importer to read back; `None` for an unlabelled part.
fn extras(label: &PartLabel) -> Option<Value> {
    let class = usize::try_from(label.semantic - 1).ok().and_then(|index| NYU40.get(index))?;
    let mut extras = json!({ "semantic": class.name, "semantic_id": class.id });
    // Without a number, the importer would give one to what people count.
    if label.instance > 0 || !is_stuff(label.semantic) {
        extras["instance"] = json!(label.instance);
    }
    Some(extras)
}

fn add_camera(document: &mut Document, camera: &StartCamera, bearer_from_world: &DAffine3) {
    let fov_y = 2.0 * ((0.5 * camera.fov_x_rad).tan() / camera.aspect).atan();
    let perspective = json!({ "yfov": fov_y as f32, "aspectRatio": camera.aspect as f32, "znear": 0.01 });
    document.cameras.push(json!({ "name": camera.name, "type": "perspective", "perspective": perspective }));
    let mut node = json!({ "name": camera.name, "camera": document.cameras.len() - 1 });
    place(&mut node, &(*bearer_from_world * DAffine3::from_mat3_translation(camera.world_from_camera, camera.position)));
    document.nodes.push(node);
}

/// A light shines along its node's −z. False if glTF has none like it.
fn add_light(document: &mut Document, light: &Light, bearer_from_world: &DAffine3) -> bool {
    let (kind, strength, position, direction, spot) = match light {
        Light::Point { position, intensity, .. } => ("point", *intensity, *position, Vec3::NEG_Z, None),
        Light::Spot { position, direction, intensity, inner_rad, outer_rad, falloff, .. } => {
            if *falloff != SpotFalloff::CosineSquare {
                document.notes.push(format!("light {:?}: it dims by another law than glTF's, the square of the cosine", light.name()));
            }
            // The specification wants the inner angle below the outer one.
            let inner = inner_rad.min(outer_rad - 1e-4).max(0.0);
            ("spot", *intensity, *position, *direction, Some(json!({ "innerConeAngle": inner, "outerConeAngle": outer_rad })))
        }
        Light::Directional { direction, irradiance, angular_radius_rad, .. } => {
            if *angular_radius_rad > 0.0 {
                document.notes.push(format!("light {:?}: its disk of {angular_radius_rad} rad became parallel light", light.name()));
            }
            ("directional", *irradiance, Vec3::ZERO, *direction, None)
        }
        Light::Profile { .. } => {
            document.notes.push(format!("light {:?}: its measured distribution has no place in glTF, so it was left out", light.name()));
            return false;
        }
    };
    let intensity = strength.max_component();
    let color = if intensity > 0.0 { strength / intensity } else { Rgb::WHITE };
    let mut entry = json!({ "name": light.name(), "type": kind, "color": color.to_array(), "intensity": intensity });
    if let Some(spot) = spot {
        entry["spot"] = spot;
    }
    document.lights.push(entry);
    document.extensions.insert("KHR_lights_punctual");
    let mut node = json!({
        "name": light.name(),
        "extensions": { "KHR_lights_punctual": { "light": document.lights.len() - 1 } },
    });
    let z = -direction.as_dvec3().normalize_or(DVec3::NEG_Z);
    let x = z.any_orthonormal_vector();
    place(&mut node, &(*bearer_from_world * DAffine3::from_mat3_translation(DMat3::from_cols(x, z.cross(x), z), position.as_dvec3())));
    document.nodes.push(node);
    true
}
