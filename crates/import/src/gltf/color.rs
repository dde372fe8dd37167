//! Colours of vertices (`COLOR_0`), and their mean over a primitive, which multiplies its material where they are not painted.

use super::container::Document;
use crate::ImportError;
use crate::assembly::Assembly;
use crate::polygon::triangle_area;
use enfilade_geometry::Mesh;
use enfilade_math::{DVec3, Rgb};
use gltf::json::accessor::Type;
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;

/// Factors of the base colour and the opacity of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tint {
    pub color: Rgb,
    pub opacity: f32,
}

impl Tint {
    /// Changes nothing.
    pub(super) const NONE: Self = Self { color: Rgb::WHITE, opacity: 1.0 };

    /// Red, green, blue and opacity.
    pub(super) fn to_array(self) -> [f32; 4] {
        [self.color.r, self.color.g, self.color.b, self.opacity]
    }
}

/// The properties that differ between the vertices of a primitive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Several {
    pub colors: bool,
    pub opacities: bool,
}

/// `COLOR_0` of a primitive, one a vertex; empty where it has none.
///
/// # Errors
/// When the accessor cannot be read or is of another length than the positions, or a colour is not a number.
pub(super) fn read(
    document: &Document,
    primitive: &Primitive,
    mesh: &Mesh,
    place: &str,
    a: &mut Assembly,
) -> Result<Vec<[f32; 4]>, ImportError> {
    if primitive.attributes.keys().any(|k| matches!(k, Checked::Valid(Semantic::Colors(set)) if *set > 0)) {
        a.warn(place, "vertex colours of further sets dropped; COLOR_0 alone multiplies the base colour");
    }
    let Some(&accessor) = primitive.attributes.get(&Checked::Valid(Semantic::Colors(0))) else {
        return Ok(Vec::new());
    };
    let has_alpha = document.root.accessors.get(accessor.value()).is_some_and(|a| a.type_ == Checked::Valid(Type::Vec4));
    let colors = if has_alpha {
        document.vectors::<4>(accessor)
    } else {
        document.vectors::<3>(accessor).map(|colors| colors.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect())
    };
    let bad = |problem: String| a.malformed(format!("{place}.attributes.COLOR_0"), problem);
    let colors = colors.map_err(bad)?;
    if colors.len() != mesh.positions.len() {
        let problem = format!("found {} colours, expected {}, one a vertex; export the file again", colors.len(), mesh.positions.len());
        return Err(bad(problem));
    }
    if let Some(vertex) = colors.iter().position(|color| color.iter().any(|v| !v.is_finite())) {
        return Err(bad(format!("found {:?} at vertex {vertex}, expected numbers; export the file again", colors[vertex])));
    }
    Ok(colors)
}

/// The mean of colours over the triangles of a primitive, weighted by area, and what of them varies.
pub(super) fn mean(mesh: &Mesh, colors: &[[f32; 4]]) -> (Tint, Several) {
    let color = |vertex: u32| colors.get(vertex as usize).copied();
    let of = |[i, j, k]: [u32; 3]| Some([color(i)?, color(j)?, color(k)?]);
    let triangles: Vec<_> = mesh.triangles.iter().enumerate().filter_map(|(i, t)| Some((area(mesh, i), of(*t)?))).collect();
    let Some((_, [first, ..])) = triangles.first() else { return (Tint::NONE, Several::default()) };
    let varies: [bool; 4] = std::array::from_fn(|c| triangles.iter().any(|(_, corners)| corners.iter().any(|v| v[c] != first[c])));
    let total: f64 = triangles.iter().map(|(area, _)| area).sum();
    let weight = |area: f64| if total > 0.0 && total.is_finite() { area / total } else { 1.0 / triangles.len() as f64 };
    let mean_of = |c: usize| {
        let sum = |corners: &[[f32; 4]; 3]| corners.iter().map(|v| f64::from(v[c])).sum::<f64>();
        triangles.iter().map(|(area, corners)| weight(*area) * sum(corners) / 3.0).sum::<f64>() as f32
    };
    let [r, g, b, opacity] = std::array::from_fn(|c| if varies[c] { mean_of(c) } else { first[c] }.clamp(0.0, 1.0));
    (Tint { color: Rgb::new(r, g, b), opacity }, Several { colors: varies[..3].contains(&true), opacities: varies[3] })
}

/// The area of a triangle; 0 where that is not a number.
fn area(mesh: &Mesh, triangle: usize) -> f64 {
    let corner = |k: usize| mesh.positions.get(mesh.triangles[triangle][k] as usize).map_or(DVec3::ZERO, |p| p.as_dvec3());
    let area = triangle_area([0, 1, 2].map(corner));
    if area.is_finite() { area } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Vec3;

    #[test]
    fn large_triangles_count_more_and_unused_vertices_do_not() {
        let point = |x: f32, y: f32| Vec3::new(x, y, 0.0);
        let positions =
            vec![point(0.0, 0.0), point(3.0, 0.0), point(0.0, 1.0), point(0.0, 0.0), point(1.0, 0.0), point(0.0, 1.0), Vec3::ZERO];
        let mut mesh = Mesh { positions, triangles: vec![[0, 1, 2], [3, 4, 5]], ..Mesh::default() };
        let (red, blue) = ([1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.5]);
        let colors = [red, red, red, blue, blue, blue, [9.0; 4]];
        let tint = |r, b, opacity| Tint { color: Rgb::new(r, 0.0, b), opacity };
        assert_eq!(mean(&mesh, &colors), (tint(0.75, 0.25, 0.875), Several { colors: true, opacities: true }));
        mesh.triangles.pop();
        assert_eq!(mean(&mesh, &colors), (tint(1.0, 0.0, 1.0), Several::default()));
        // Without an area, and beyond the vertices.
        mesh.triangles = vec![[0, 0, 3], [0, 1, 99]];
        let (Tint { color, opacity }, _) = mean(&mesh, &colors);
        assert!((color.r - 2.0 / 3.0).abs() < 1e-6 && (color.b - 1.0 / 3.0).abs() < 1e-6 && (opacity - 2.5 / 3.0).abs() < 1e-6);
        mesh.triangles.clear();
        assert_eq!(mean(&mesh, &colors), (Tint::NONE, Several::default()));
    }
}
