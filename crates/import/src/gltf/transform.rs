//! Transforms as glTF states them: a matrix column by column, or translation, rotation (a quaternion) and scale.

use super::container::Document;
use enfilade_math::{DAffine3, DMat3, DVec3};
use gltf::json::scene::Node;

impl Document {
    /// The own transform of a node that there is.
    pub(super) fn local_transform(&self, index: usize) -> DAffine3 {
        let mut transform = local_transform(&self.root.nodes[index]);
        if let Some(exact) = self.far_translations.get(&index) {
            transform.translation = *exact;
        }
        transform
    }
}

/// A node's own transform: its matrix, or translation, rotation and scale.
fn local_transform(node: &Node) -> DAffine3 {
    if let Some(matrix) = &node.matrix {
        return affine(matrix);
    }
    placement(node.translation.unwrap_or([0.0; 3]), node.rotation.as_ref().map_or([0.0; 4], |q| q.0), node.scale.unwrap_or([1.0; 3]))
}

/// A matrix of 16 numbers, column by column.
pub(super) fn affine(m: &[f32; 16]) -> DAffine3 {
    let column = |i: usize| DVec3::new(f64::from(m[i]), f64::from(m[i + 1]), f64::from(m[i + 2]));
    DAffine3::from_mat3_translation(DMat3::from_cols(column(0), column(4), column(8)), column(12))
}

/// Scale first, then rotation, then translation.
pub(super) fn placement(translation: [f32; 3], rotation: [f32; 4], scale: [f32; 3]) -> DAffine3 {
    let vec = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    DAffine3::from_mat3_translation(rotation_of(rotation) * DMat3::from_diagonal(vec(scale)), vec(translation))
}

/// The rotation of a quaternion (x, y, z, w), which need not be of unit length; a zero one turns nothing.
fn rotation_of(q: [f32; 4]) -> DMat3 {
    let [x, y, z, w] = q.map(f64::from);
    let length = x * x + y * y + z * z + w * w;
    if length == 0.0 {
        return DMat3::IDENTITY;
    }
    let s = 2.0 / length;
    DMat3::from_cols(
        DVec3::new(1.0 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)),
        DVec3::new(s * (x * y - z * w), 1.0 - s * (x * x + z * z), s * (y * z + x * w)),
        DVec3::new(s * (x * z + y * w), s * (y * z - x * w), 1.0 - s * (x * x + y * y)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_about_z_takes_x_to_y_whatever_the_length() {
        let r = rotation_of([0.0, 0.0, 3.0, 3.0]);
        assert!((r * DVec3::X - DVec3::Y).length() < 1e-12 && (r * DVec3::Z - DVec3::Z).length() < 1e-12);
        assert_eq!(rotation_of([0.0; 4]), DMat3::IDENTITY);
    }
}
