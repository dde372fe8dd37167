//! Models of objects: their files, sizes and symmetries.

use super::records::{ContinuousSymmetry, ModelInfo};
use crate::symmetries::Symmetries;
use enfilade_math::{DMat3, DVec3};

/// The size of a model around its origin, by its vertices in metres, or the corners of its box.
pub(super) fn model_info(vertices: Vec<DVec3>, [min, max]: [DVec3; 2]) -> ModelInfo {
    let [min_x, min_y, min_z] = in_millimetres(min);
    let [size_x, size_y, size_z] = in_millimetres(max - min);
    let diameter = 1000.0 * diameter(vertices);
    let (symmetries_discrete, symmetries_continuous) = (Vec::new(), Vec::new());
    ModelInfo { diameter, min_x, min_y, min_z, size_x, size_y, size_z, symmetries_discrete, symmetries_continuous }
}

/// The least and the greatest coordinates.
pub(super) fn bounds(vertices: &[DVec3]) -> [DVec3; 2] {
    vertices.iter().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[a, b], &v| [a.min(v), b.max(v)])
}

impl ModelInfo {
    /// Facts about a model with its symmetries, which are in metres.
    pub fn with_symmetries(self, found: &Symmetries) -> Self {
        let offset = in_millimetres(found.center);
        let continuous = |axis: &DVec3| ContinuousSymmetry { axis: tidied(axis.to_array()), offset };
        Self {
            symmetries_discrete: found.discrete.iter().map(|turn| about(*turn, found.center)).collect(),
            symmetries_continuous: found.continuous.iter().map(continuous).collect(),
            ..self
        }
    }
}

/// Rows of the matrix that turns about a point in metres, in millimetres.
fn about(turn: DMat3, center: DVec3) -> [f64; 16] {
    let t = in_millimetres(center - turn * center);
    let row = |i: usize| [turn.x_axis[i], turn.y_axis[i], turn.z_axis[i], t[i]];
    let rows = [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]].concat();
    tidied(std::array::from_fn(|i| rows[i]))
}

/// The numbers without what rounding left of 0.
fn tidied<const N: usize>(numbers: [f64; N]) -> [f64; N] {
    numbers.map(|v| if v.abs() < 1e-9 { 0.0 } else { v })
}

/// The largest distance between two of the points, which are around the origin.
///
/// Points are taken from the outermost inward, so that pairs too near the origin to matter are never looked at.
fn diameter(mut points: Vec<DVec3>) -> f64 {
    points.sort_by(|a, b| b.length().total_cmp(&a.length()));
    let mut largest = 0.0;
    for (i, a) in points.iter().enumerate() {
        for b in &points[..i] {
            if a.length() + b.length() <= largest {
                break;
            }
            largest = a.distance(*b).max(largest);
        }
    }
    largest
}

pub(super) fn in_millimetres(v: DVec3) -> [f64; 3] {
    (v * 1000.0).to_array().map(|x| x + 0.0)
}

/// The bytes of a text PLY file in millimetres, with the properties that bop_toolkit reads; normals where there are some.
pub(super) fn ply(vertices_m: &[DVec3], normals: Option<&[DVec3]>, faces: &[[u32; 3]]) -> Vec<u8> {
    let mut text = format!("ply\nformat ascii 1.0\nelement vertex {}\n", vertices_m.len());
    let properties = ["x", "y", "z", "nx", "ny", "nz"];
    let count = if normals.is_some() { 6 } else { 3 };
    text.extend(properties[..count].iter().map(|name| format!("property float {name}\n")));
    text.push_str(&format!("element face {}\nproperty list uchar int vertex_indices\nend_header\n", faces.len()));
    for (i, v) in vertices_m.iter().enumerate() {
        let [x, y, z] = in_millimetres(*v).map(|v| v as f32);
        text.push_str(&format!("{x} {y} {z}"));
        if let Some(normals) = normals {
            let [x, y, z] = normals[i].to_array().map(|v| v as f32 + 0.0);
            text.push_str(&format!(" {x} {y} {z}"));
        }
        text.push('\n');
    }
    text.extend(faces.iter().map(|[a, b, c]| format!("3 {a} {b} {c}\n")));
    text.into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_diameter_is_that_of_brute_force() {
        let wave = |i: usize| DVec3::new((i as f64 * 1.7).sin(), 0.4 * (i as f64 * 0.9).cos(), 0.2 * (i as f64 * 2.3).sin());
        let points: Vec<DVec3> = (0..200).map(wave).collect();
        let pairs = points.iter().flat_map(|a| points.iter().map(|b| a.distance(*b)));
        assert_eq!(diameter(points.clone()), pairs.fold(0.0, f64::max));
    }

    #[test]
    fn a_half_turn_beside_the_origin_moves_by_twice_the_way() {
        let half = DMat3::from_rotation_z(std::f64::consts::PI);
        let rows = about(half, DVec3::new(0.01, 0.02, 0.5));
        let expected = [-1.0, 0.0, 0.0, 20.0, 0.0, -1.0, 0.0, 40.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        assert!(rows.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{rows:?}");
    }
}
