//! A model as it is placed: the scene of its file, its convex pieces, and its size.

use crate::pieces::{bounds, pieces};
use crate::shapes::vector;
use enfilade_math::{DQuat, DVec3};
use enfilade_scene::LabelledScene;
use rapier3d_f64::math::Pose3;
use rapier3d_f64::parry::shape::SharedShape;

/// Things of a longer side are not put on furniture, metres: their unit is probably another one.
const LARGEST_M: f64 = 4.0;
/// Things of a shorter side cannot be simulated, metres.
const SMALLEST_M: f64 = 0.003;
/// Thickness of a piece without any, metres.
const THIN_M: f64 = 5e-4;
/// Units of files, metres, with their names.
const UNITS: [(f64, &str); 3] = [(0.01, "centimetres"), (0.001, "millimetres"), (0.0254, "inches")];
/// The size that things on furniture usually have, metres.
const USUAL_M: [f64; 2] = [0.02, 1.0];

/// A model.
pub struct Model {
    /// What is in its file, in metres, z up.
    pub thing: LabelledScene,
    /// Corners of its convex pieces.
    pieces: Vec<Vec<DVec3>>,
    /// Length of the longest side of its box, metres.
    pub longest: f64,
}

impl Model {
    /// A model from the scene of its file.
    ///
    /// # Errors
    /// Why it cannot be placed.
    pub fn new(thing: LabelledScene) -> Result<Self, String> {
        let scene = &thing.scene;
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        for part in &scene.parts {
            let first = points.len() as u32;
            let mesh = &scene.meshes[part.mesh as usize];
            points.extend(mesh.positions.iter().map(|p| part.world_from_mesh.transform_point3(p.as_dvec3())));
            triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        }
        let (low, high) = bounds(&points);
        let longest = (high - low).max_element();
        if !(longest.is_finite() && longest > 0.0) {
            return Err("it has no extent: all of its points are one".into());
        }
        Ok(Self { pieces: pieces(&points, &triangles), thing, longest })
    }

    /// Whether the model can be placed at this scale; `is_chosen` if somebody gave its size.
    ///
    /// # Errors
    /// The size found, and the key that mends it.
    pub fn check_size(&self, scale: f64, is_chosen: bool) -> Result<(), String> {
        let size = self.longest * scale;
        if (SMALLEST_M..=LARGEST_M).contains(&size) {
            return Ok(());
        }
        let expected = format!("its longest side is {} m, expected {SMALLEST_M} to {LARGEST_M} m", short(size));
        let usual = |factor: &f64| (USUAL_M[0]..=USUAL_M[1]).contains(&(size * factor));
        Err(match UNITS.iter().find(|(factor, _)| usual(factor)) {
            _ if is_chosen => expected,
            Some((factor, unit)) => {
                format!(
                    "{expected}; if its file counts in {unit}, set meters_per_unit = {factor}, which makes it {} m",
                    short(size * factor)
                )
            }
            None => format!("{expected}; give its size by size_m, or its unit by meters_per_unit"),
        })
    }

    /// The model in the simulation, this many times as large.
    pub fn shape(&self, scale: f64) -> SharedShape {
        SharedShape::compound(self.pieces.iter().map(|piece| convex(piece, scale)).collect())
    }

    /// The lowest point of the model, turned and scaled, below its origin, metres.
    pub fn lowest(&self, turn: DQuat, scale: f64) -> f64 {
        let points = self.pieces.iter().flatten();
        points.map(|p| (turn * *p).z * scale).fold(f64::INFINITY, f64::min)
    }

    /// Middle of the model's footprint, turned and scaled.
    pub fn middle(&self, turn: DQuat, scale: f64) -> DVec3 {
        let points: Vec<DVec3> = self.pieces.iter().flatten().map(|p| turn * *p * scale).collect();
        let (low, high) = bounds(&points);
        (low + high) / 2.0
    }

    /// Corners of the model's box, scaled.
    pub fn corners(&self, scale: f64) -> [DVec3; 8] {
        let points: Vec<DVec3> = self.pieces.iter().flatten().copied().collect();
        let (low, high) = bounds(&points);
        let corner = |i: usize| DVec3::new([low.x, high.x][i & 1], [low.y, high.y][i >> 1 & 1], [low.z, high.z][i >> 2]);
        std::array::from_fn(|i| corner(i) * scale)
    }
}

/// The hull of a piece; of a flat one a box with some thickness.
fn convex(piece: &[DVec3], scale: f64) -> (Pose3, SharedShape) {
    let points: Vec<DVec3> = piece.iter().map(|p| *p * scale).collect();
    let (low, high) = bounds(&points);
    let half = (high - low) / 2.0;
    let hull = if half.min_element() < THIN_M / 2.0 {
        None
    } else {
        SharedShape::convex_hull(&points.iter().copied().map(vector).collect::<Vec<_>>())
    };
    hull.map_or_else(
        || {
            let half = half.max(DVec3::splat(THIN_M / 2.0));
            (Pose3::from_translation(vector((low + high) / 2.0)), SharedShape::cuboid(half.x, half.y, half.z))
        },
        |hull| (Pose3::IDENTITY, hull),
    )
}

/// A length to three significant digits.
fn short(length: f64) -> String {
    let digits = (2.0 - length.abs().log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{length:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_geometry::Mesh;
    use enfilade_math::{Rgb, Vec3};
    use enfilade_scene::{Material, NewPart};

    fn model(size: Vec3) -> Model {
        let corner = |i: usize| size * Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        let mesh = Mesh { positions: (0..8).map(corner).collect(), triangles, ..Mesh::default() };
        let part = NewPart::new("block", mesh, Material::diffuse("grey", Rgb::splat(0.5)).into());
        Model::new(LabelledScene::default().with_part(&part).unwrap()).unwrap()
    }

    #[test]
    fn a_unit_that_is_another_is_told_with_the_key() {
        let cup = model(Vec3::new(80.0, 80.0, 95.0));
        let problem = cup.check_size(1.0, false).unwrap_err();
        assert!(problem.ends_with("if its file counts in centimetres, set meters_per_unit = 0.01, which makes it 0.950 m"), "{problem}");
        assert_eq!(cup.check_size(0.001, false), Ok(()));
        let vast = model(Vec3::splat(5e6)).check_size(1.0, false).unwrap_err();
        assert!(vast.contains("size_m"), "{vast}");
    }

    #[test]
    fn a_sheet_without_thickness_becomes_a_thin_box() {
        let sheet = model(Vec3::new(0.2, 0.3, 0.0));
        let bounds = sheet.shape(1.0).compute_local_aabb();
        let size = bounds.maxs - bounds.mins;
        assert!((size.x - 0.2).abs() < 1e-6 && (size.z - THIN_M).abs() < 1e-9, "{size:?}");
    }
}
