//! Translations of nodes so large that single precision loses them, read once more from the JSON.

use crate::assembly::FAR_M;
use enfilade_math::DVec3;
use gltf::json::scene::Node;
use serde_json::Value;
use std::collections::HashMap;

/// The large translations of nodes in double precision, which the typed JSON does not have; the index of the node is the key.
pub(super) fn far_translations(nodes: &[Node], json: &[u8]) -> HashMap<usize, DVec3> {
    let stated = |node: &Node| node.matrix.map_or(node.translation, |m| Some([m[12], m[13], m[14]]));
    let is_far = |node: &Node| stated(node).is_some_and(|t| t.iter().any(|v| f64::from(v.abs()) >= FAR_M));
    if !nodes.iter().any(is_far) {
        return HashMap::new();
    }
    let Ok(root) = serde_json::from_slice::<Value>(json) else { return HashMap::new() };
    let exact = |i: usize| {
        let node = root.get("nodes")?.get(i)?;
        let (numbers, first) = node.get("matrix").map_or_else(|| (node.get("translation"), 0), |matrix| (Some(matrix), 12));
        let number = |k: usize| numbers?.get(first + k)?.as_f64();
        Some(DVec3::new(number(0)?, number(1)?, number(2)?))
    };
    let far = nodes.iter().enumerate().filter(|(_, node)| is_far(node));
    far.filter_map(|(i, _)| Some((i, exact(i)?))).collect()
}
