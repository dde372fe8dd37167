//! Common parts of URDF and SDF: child elements, names and placements.

use enfilade_math::{DAffine3, DMat3, DVec3};
use roxmltree::Node;

/// The first element of a name within another.
pub(super) fn child<'a, 'd>(node: Node<'a, 'd>, tag: &str) -> Option<Node<'a, 'd>> {
    children(node, tag).next()
}

/// The elements of a name within another, in order.
pub(super) fn children<'a, 'd, 't>(node: Node<'a, 'd>, tag: &'t str) -> impl Iterator<Item = Node<'a, 'd>> + use<'a, 'd, 't> {
    node.children().filter(move |n| n.is_element() && n.tag_name().name() == tag)
}

/// The name that an element states; empty where it states none.
pub(super) fn name_of<'d>(node: Node<'d, '_>) -> &'d str {
    node.attribute("name").map(str::trim).unwrap_or_default()
}

/// A placement of a translation and angles about the fixed axes x, y, z.
pub(super) fn pose(translation: DVec3, angles_rad: DVec3) -> DAffine3 {
    let turn = DMat3::from_rotation_z(angles_rad.z) * DMat3::from_rotation_y(angles_rad.y) * DMat3::from_rotation_x(angles_rad.x);
    DAffine3::from_mat3_translation(turn, translation)
}
