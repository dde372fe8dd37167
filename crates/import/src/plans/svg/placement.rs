//! Places of elements in the drawing.

use super::path::numbers;
use enfilade_math::{DMat3, DVec2, DVec3};
use roxmltree::Node;

/// Metres of a unit where the file does not say.
pub(super) const UNIT: f64 = 0.01;

/// From an element's units to the root's.
pub(super) fn placement(node: &Node) -> Result<DMat3, String> {
    let mut placed = DMat3::IDENTITY;
    for ancestor in node.ancestors().filter(Node::is_element) {
        if let Some(text) = ancestor.attribute("transform") {
            placed = transform(text)? * placed;
        }
    }
    Ok(placed)
}

fn transform(text: &str) -> Result<DMat3, String> {
    let mut whole = DMat3::IDENTITY;
    for call in text.split(')').map(|call| call.trim().trim_start_matches(',').trim()).filter(|call| !call.is_empty()) {
        let (name, arguments) =
            call.split_once('(').ok_or_else(|| format!("found the transform {text:?}, expected such as translate(2 3)"))?;
        whole *= match (name.trim(), &numbers(arguments)?[..]) {
            ("translate", &[x]) => DMat3::from_translation(DVec2::new(x, 0.0)),
            ("translate", &[x, y]) => DMat3::from_translation(DVec2::new(x, y)),
            ("scale", &[s]) => DMat3::from_scale(DVec2::splat(s)),
            ("scale", &[x, y]) => DMat3::from_scale(DVec2::new(x, y)),
            ("rotate", &[degrees]) => DMat3::from_angle(degrees.to_radians()),
            ("rotate", &[degrees, x, y]) => {
                let middle = DMat3::from_translation(DVec2::new(x, y));
                middle * DMat3::from_angle(degrees.to_radians()) * middle.inverse()
            }
            ("matrix", &[a, b, c, d, e, f]) => DMat3::from_cols(DVec3::new(a, b, 0.0), DVec3::new(c, d, 0.0), DVec3::new(e, f, 1.0)),
            _ => return Err(format!("found the transform {call:?}), expected translate, scale, rotate or matrix")),
        };
    }
    Ok(whole)
}
