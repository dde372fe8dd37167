//! Common parts of URDF and SDF: child elements, names and placements.

use crate::ImportError;
use crate::assembly::Assembly;
use crate::vectors::numbers;
use enfilade_math::{DAffine3, DMat3, DVec3};
use roxmltree::Node;

/// The first element of a name within another.
pub(crate) fn child<'a, 'd>(node: Node<'a, 'd>, tag: &str) -> Option<Node<'a, 'd>> {
    children(node, tag).next()
}

/// The elements of a name within another, in order.
pub(crate) fn children<'a, 'd, 't>(node: Node<'a, 'd>, tag: &'t str) -> impl Iterator<Item = Node<'a, 'd>> + use<'a, 'd, 't> {
    node.children().filter(move |n| n.is_element() && n.tag_name().name() == tag)
}

/// The name that an element states; empty where it states none.
pub(crate) fn name_of<'d>(node: Node<'d, '_>) -> &'d str {
    node.attribute("name").map(str::trim).unwrap_or_default()
}

/// A placement of a translation and angles about the fixed axes x, y, z.
pub(crate) fn pose(translation: DVec3, angles_rad: DVec3) -> DAffine3 {
    let turn = DMat3::from_rotation_z(angles_rad.z) * DMat3::from_rotation_y(angles_rad.y) * DMat3::from_rotation_x(angles_rad.x);
    DAffine3::from_mat3_translation(turn, translation)
}

/// The placement in the element `origin` within another.
pub(crate) fn origin(node: Node, a: &Assembly) -> Result<DAffine3, ImportError> {
    let Some(origin) = child(node, "origin") else { return Ok(DAffine3::IDENTITY) };
    let of = |name: &str| vector::<3>(origin, name, a).map(|v| v.map_or(DVec3::ZERO, DVec3::from_array));
    Ok(pose(of("xyz")?, of("rpy")?))
}

/// The numbers of an attribute; `None` where there is none.
pub(crate) fn vector<const N: usize>(node: Node, attribute: &str, a: &Assembly) -> Result<Option<[f64; N]>, ImportError> {
    let Some(text) = node.attribute(attribute) else { return Ok(None) };
    let found: Option<[f64; N]> = numbers(text).and_then(|v| v.try_into().ok());
    let at = node.document().text_pos_at(node.range().start);
    let remedy = if is_xacro(text) { format!(": {TO_URDF}") } else { String::new() };
    let problem = || format!("found {text:?} as {attribute} of <{}>, expected {N} numbers{remedy}", node.tag_name().name());
    found.map(Some).ok_or_else(|| a.malformed(format!("line {}", at.row), problem()))
}

/// What to do with a file for xacro that is called URDF.
const TO_URDF: &str = "the file is written for xacro, so make URDF of it with ROS (xacro FILE > robot.urdf)";

/// Whether a value is an expression or a substitution of xacro.
fn is_xacro(text: &str) -> bool {
    text.contains("${") || text.contains("$(")
}

/// Reports elements of xacro, which are conditions, macros and parts of other files.
pub(crate) fn tell_of_xacro(root: Node, a: &mut Assembly) {
    let of_xacro = |node: &Node| node.tag_name().namespace().is_some_and(|space| space.contains("xacro"));
    let mut all = root.descendants().filter(of_xacro);
    if let Some(first) = all.next() {
        let at = first.document().text_pos_at(first.range().start);
        let (name, more) = (first.tag_name().name(), all.count());
        let others = if more > 0 { format!(" and {more} more elements of xacro were") } else { " was".into() };
        a.warn(format!("line {}", at.row), format!("<xacro:{name}>{others} left out: {TO_URDF}"));
    }
}
