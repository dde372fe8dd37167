//! Nodes as objects: each node with its primitives is one, and is a child of the nodes above it.
//!
//! Scenes that this program writes have a node for each part, and state in `extras` what these are parts of: `objects` of the scene lists
//! the objects, each with its `name` and the index of its `parent`, and `object` of a node is an index into that list.

use super::container::Document;
use crate::assembly::Assembly;
use enfilade_scene::ObjectId;
use gltf::json::extras::RawValue;
use gltf::json::scene::Node;
use serde_json::Value;

/// The objects that the file itself lists.
pub(super) struct Objects {
    listed: Vec<ObjectId>,
}

impl Objects {
    /// Adds the objects that the scene's extras list.
    pub(super) fn new(document: &Document, a: &mut Assembly) -> Self {
        let root = &document.root;
        let scene = root.scene.and_then(|s| root.scenes.get(s.value())).or(root.scenes.first());
        let extras = scene.and_then(|scene| scene.extras.as_ref()).and_then(|extras| parsed(extras));
        let mut listed: Vec<ObjectId> = Vec::new();
        for object in extras.as_ref().and_then(|extras| extras.get("objects")?.as_array()).into_iter().flatten() {
            let parent = object.get("parent").and_then(|parent| listed.get(parent.as_u64()? as usize)).copied();
            listed.push(a.push_object(object.get("name").and_then(Value::as_str).unwrap_or_default(), parent));
        }
        Self { listed }
    }

    /// The object of a node, a child of `parent`; `parent` itself if the node has neither a name nor a mesh.
    pub(super) fn of(
        &self,
        document: &Document,
        node: &Node,
        index: usize,
        parent: Option<ObjectId>,
        a: &mut Assembly,
    ) -> Option<ObjectId> {
        let stated = node.extras.as_ref().filter(|_| !self.listed.is_empty()).and_then(|extras| parsed(extras));
        if let Some(&object) = stated.and_then(|extras| self.listed.get(extras.get("object")?.as_u64()? as usize)) {
            return Some(object);
        }
        let name = own_name(node).map(str::to_string).or_else(|| node.mesh.is_some().then(|| name(document, node, index)));
        name.map(|name| a.push_object(&name, parent)).or(parent)
    }
}

/// The name of a node with a mesh: its own, else the mesh's, else a stable one.
pub(super) fn name(document: &Document, node: &Node, index: usize) -> String {
    let mesh = node.mesh.and_then(|mesh| document.root.meshes.get(mesh.value()));
    let of_mesh = mesh.and_then(|mesh| mesh.name.as_deref()).filter(|name| !name.trim().is_empty());
    own_name(node).or(of_mesh).map_or_else(|| format!("node_{index}"), str::to_string)
}

fn own_name(node: &Node) -> Option<&str> {
    node.name.as_deref().filter(|name| !name.trim().is_empty())
}

fn parsed(extras: &RawValue) -> Option<Value> {
    serde_json::from_str(extras.get()).ok()
}
