//! Numbers nodes and lights, so that images distinguish them, and hides those that have no object in the mesh.

use enfilade_vrscene::{Document, Value};
use std::collections::HashMap;

/// Kinds of lights that have a shape and could be seen, in the order in which they get their numbers.
const LIGHTS: [&str; 3] = ["LightRectangle", "LightMesh", "LightDome"];

/// A node or light with its number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entity {
    /// The entity's value in `render_entity_id`, from 1.
    pub id: i64,
    /// The plugin's name.
    pub name: String,
    /// Row of its object in the mesh; `None` for lights and for nodes that are no object of the mesh.
    pub object: Option<usize>,
    /// True for lights.
    pub light: bool,
}

/// Further changes to nodes and lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EntityOptions {
    /// Nodes that are no object of the mesh are made invisible, so that images show what the mesh has.
    pub hide_nodes_not_in_mesh: bool,
    /// Rectangle, mesh and dome lights are made invisible; they light all the same.
    pub hide_lights: bool,
}

/// Numbers nodes from 1 in their order, and after them rectangle, mesh and dome lights.
///
/// A node belongs to the object whose name it has before its first `@`. (The toolkit numbers rectangle lights twice and mesh lights
/// never.)
pub fn set_entity_ids(scene: &mut Document, objects: &[&str], options: EntityOptions) -> Vec<Entity> {
    let mut rows: HashMap<&str, usize> = HashMap::new();
    for (row, name) in objects.iter().enumerate() {
        rows.entry(name).or_insert(row);
    }
    let mut entities: Vec<Entity> = Vec::new();
    for node in scene.of_kind_mut("Node") {
        let name = String::from_utf8_lossy(node.name()).into_owned();
        let object = rows.get(name.split('@').next().unwrap_or("")).copied();
        let id = entities.len() as i64 + 1;
        node.set("objectID", &Value::Int(id));
        if options.hide_nodes_not_in_mesh && object.is_none() {
            node.set("visible", &Value::Int(0));
        }
        entities.push(Entity { id, name, object, light: false });
    }
    for kind in LIGHTS {
        for light in scene.of_kind_mut(kind) {
            let id = entities.len() as i64 + 1;
            light.set("objectID", &Value::Int(id));
            if options.hide_lights {
                light.set("invisible", &Value::Int(1));
            }
            entities.push(Entity { id, name: String::from_utf8_lossy(light.name()).into_owned(), object: None, light: true });
        }
    }
    entities
}
