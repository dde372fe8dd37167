//! Labels in the `extras` of nodes.

use crate::assembly::{Assembly, FileLabel, class_named};
use enfilade_scene::ObjectId;
use gltf::json::scene::Node;
use serde_json::Value;

/// The label that a node's extras give, where they are silent the inherited one.
pub(super) fn of(node: &Node, index: usize, object: Option<ObjectId>, inherited: FileLabel, a: &mut Assembly) -> FileLabel {
    let extras = node.extras.as_ref().and_then(|extras| serde_json::from_str::<Value>(extras.get()).ok());
    let Some(extras) = extras else { return inherited };
    let mut label = match class(&extras, index, a) {
        Some(semantic) => FileLabel { semantic, instance: None, whole: object },
        None => inherited,
    };
    if let Some(value) = extras.get("instance") {
        match whole_number(value).and_then(|i| i16::try_from(i).ok()).filter(|&i| i > 0 || i == -1) {
            Some(instance) => label.instance = Some(instance),
            None => {
                let message = format!("found {value}, expected a whole number from 1 to 32767, or -1 for none; the number was ignored");
                a.warn(format!("nodes[{index}].extras.instance"), message);
            }
        }
    }
    label
}

/// The class by `semantic`, else by `semantic_id`.
fn class(extras: &Value, index: usize, a: &mut Assembly) -> Option<i16> {
    let by_id = |value: &Value| whole_number(value).filter(|id| (1..=40).contains(id)).map(|id| id as i16);
    let found = ["semantic", "semantic_id"].map(|key| {
        let value = extras.get(key)?;
        Some((key, value, value.as_str().and_then(class_named).or_else(|| by_id(value))))
    });
    let class = found.iter().flatten().find_map(|(.., class)| *class);
    if let (None, Some((key, value, _))) = (class, found.iter().flatten().next()) {
        let problem = format!("found {value}, expected a NYU40 id (1 to 40) or name; the label was ignored");
        a.warn(format!("nodes[{index}].extras.{key}"), problem);
    }
    if let [Some((_, value, Some(named))), Some((_, id, Some(numbered)))] = found
        && named != numbered
    {
        a.warn(format!("nodes[{index}].extras"), format!("semantic is {value}, but semantic_id is {id}; semantic counts"));
    }
    class
}

/// A whole number, also as programs write it that know floating point or texts alone.
fn whole_number(value: &Value) -> Option<i64> {
    let number = value.as_f64().or_else(|| value.as_str()?.trim().parse().ok())?;
    (number.fract() == 0.0 && number.abs() < 1e9).then_some(number as i64)
}
