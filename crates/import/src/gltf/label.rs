//! Labels in the `extras` of nodes, and of meshes, where Blender writes the custom properties of an object's data.

use super::container::Document;
use crate::assembly::{Assembly, FileLabel, class_named};
use enfilade_scene::ObjectId;
use gltf::json::extras::Extras;
use serde_json::Value;

/// The label that a node's extras give, where they are silent the inherited one.
pub(super) fn of(document: &Document, index: usize, object: Option<ObjectId>, inherited: FileLabel, a: &mut Assembly) -> FileLabel {
    read(&document.root.nodes[index].extras, &format!("nodes[{index}]"), object, inherited, a).unwrap_or(inherited)
}

/// The label of a node's own parts: the node's, unless its extras state no class and its mesh's do. Nodes below do not inherit the latter.
pub(super) fn of_parts(document: &Document, index: usize, object: Option<ObjectId>, node: FileLabel, a: &mut Assembly) -> FileLabel {
    let own = &document.root.nodes[index];
    let stated = parsed(&own.extras);
    let states = |key: &str| stated.as_ref().is_some_and(|extras| extras.get(key).is_some());
    let mesh = own.mesh.map(|mesh| mesh.value()).filter(|_| !KEYS.into_iter().any(states));
    let extras = mesh.and_then(|mesh| Some((mesh, &document.root.meshes.get(mesh)?.extras)));
    let Some(of_mesh) = extras.and_then(|(mesh, extras)| read(extras, &format!("meshes[{mesh}]"), object, node, a)) else { return node };
    FileLabel { instance: of_mesh.instance.or(node.instance.filter(|_| states("instance"))), ..of_mesh }
}

/// Keys that state a class, the one that counts first.
const KEYS: [&str; 2] = ["semantic", "semantic_id"];

fn parsed(extras: &Extras) -> Option<Value> {
    serde_json::from_str(extras.as_ref()?.get()).ok()
}

fn read(extras: &Extras, place: &str, object: Option<ObjectId>, inherited: FileLabel, a: &mut Assembly) -> Option<FileLabel> {
    let extras = parsed(extras)?;
    let mut label = match class(&extras, place, a) {
        Some(semantic) => FileLabel { semantic, instance: None, whole: object },
        None => inherited,
    };
    if let Some(value) = extras.get("instance") {
        match whole_number(value).and_then(|i| i16::try_from(i).ok()).filter(|&i| i > 0 || i == -1) {
            Some(instance) => label.instance = Some(instance),
            None => {
                let message = format!("found {value}, expected a whole number from 1 to 32767, or -1 for none; the number was ignored");
                a.warn(format!("{place}.extras.instance"), message);
            }
        }
    }
    Some(label)
}

/// The class by `semantic`, else by `semantic_id`.
fn class(extras: &Value, place: &str, a: &mut Assembly) -> Option<i16> {
    let by_id = |value: &Value| whole_number(value).filter(|id| (1..=40).contains(id)).map(|id| id as i16);
    let found = KEYS.map(|key| {
        let value = extras.get(key)?;
        Some((key, value, value.as_str().and_then(class_named).or_else(|| by_id(value))))
    });
    let class = found.iter().flatten().find_map(|(.., class)| *class);
    if let (None, Some((key, value, _))) = (class, found.iter().flatten().next()) {
        let problem = format!("found {value}, expected a NYU40 id (1 to 40) or name; the label was ignored");
        a.warn(format!("{place}.extras.{key}"), problem);
    }
    if let [Some((_, value, Some(named))), Some((_, id, Some(numbered)))] = found
        && named != numbered
    {
        a.warn(format!("{place}.extras"), format!("semantic is {value}, but semantic_id is {id}; semantic counts"));
    }
    class
}

/// A whole number, also as programs write it that know floating point or texts alone.
fn whole_number(value: &Value) -> Option<i64> {
    let number = value.as_f64().or_else(|| value.as_str()?.trim().parse().ok())?;
    (number.fract() == 0.0 && number.abs() < 1e9).then_some(number as i64)
}
