//! Convex solids: the pieces of a mesh as closed surfaces, for what else simulates.

use crate::pieces::{bounds, cut, farthest, is_convex};
use crate::shapes::{ours, vector};
use enfilade_math::{DMat3, DVec3};
use rapier3d_f64::math::Matrix;
use rapier3d_f64::parry::mass_properties::MassProperties;
use rapier3d_f64::parry::shape::SharedShape;
use rapier3d_f64::parry::transformation::try_convex_hull;

/// Thickness of a solid whose points lie in a plane, metres.
pub const SHEET_M: f64 = 5e-4;
/// Length of a voxel, metres, where the whole is small; and the fewest and most voxels along its longest side.
const VOXEL_M: f64 = 0.005;
const VOXELS: [u32; 2] = [12, 40];
/// Most corners of a piece of what is not convex. A sphere loses 3 % of its radius.
const CORNERS: usize = 64;
/// Smallest extent, as a share of the greatest, that is scaled to 1 for the hull.
const FLATTEST: f64 = 1e-5;
/// Points that are nearer to a plane than this share of their extent lie in it.
const IN_PLANE: f64 = 1e-6;

/// A convex solid: the corners of its hull, and its faces as triangles, counter-clockwise seen from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// Metres.
    pub corners: Vec<DVec3>,
    /// Indices of corners.
    pub triangles: Vec<[u32; 3]>,
}

/// Mass of a solid of uniform density, and how it is distributed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Kilograms.
    pub mass_kg: f64,
    /// Centre of mass, metres.
    pub center: DVec3,
    /// Moments of inertia about the centre, kg·m², along the axes that the corners are stated in.
    pub inertia: DMat3,
}

impl Solid {
    /// The hull of points; [`SHEET_M`] thick where they lie in a plane. `None` where they lie on a line.
    pub fn around(points: &[DVec3]) -> Option<Self> {
        let (low, high) = bounds(points);
        let extent = (high - low).max_element();
        let normal = widest_normal(points)?;
        let along = |p: &DVec3| (*p - points[0]).dot(normal);
        let (least, most) = points.iter().map(along).fold((0.0f64, 0.0f64), |(least, most), d| (least.min(d), most.max(d)));
        if most - least > (IN_PLANE * extent).max(SHEET_M / 100.0) {
            return Self::hull(points);
        }
        let sides = points.iter().flat_map(|p| [*p - normal * (SHEET_M / 2.0), *p + normal * (SHEET_M / 2.0)]);
        Self::hull(&sides.collect::<Vec<_>>())
    }

    fn hull(points: &[DVec3]) -> Option<Self> {
        let (low, high) = bounds(points);
        // In units of its own length: the library's tolerances are absolute.
        // Along every axis, because of flat things it finds no hull otherwise; hulls stay hulls.
        let (middle, unit) = ((low + high) / 2.0, (high - low).max(DVec3::splat(FLATTEST * (high - low).max_element())));
        let scaled: Vec<_> = points.iter().map(|p| vector((*p - middle) / unit)).collect();
        let (corners, triangles) = try_convex_hull(&scaled).ok()?;
        let solid = Self { corners: corners.into_iter().map(|p| ours(p) * unit + middle).collect(), triangles };
        (solid.volume_m3() > 0.0).then_some(solid)
    }

    /// Cubic metres.
    pub fn volume_m3(&self) -> f64 {
        let origin = self.corners.first().copied().unwrap_or_default();
        let [a, b, c] = [0, 1, 2].map(|i| move |t: &[u32; 3]| t[i] as usize);
        let corner = |i: usize| self.corners[i] - origin;
        self.triangles.iter().map(|t| corner(a(t)).dot(corner(b(t)).cross(corner(c(t)))) / 6.0).sum()
    }

    /// Mass, centre and inertia of the solid with this mass.
    pub fn moments(&self, mass_kg: f64) -> Moments {
        let corners: Vec<_> = self.corners.iter().copied().map(vector).collect();
        let mut found = MassProperties::from_convex_polyhedron(1.0, &corners, &self.triangles);
        found.set_mass(mass_kg, true);
        let m = found.reconstruct_inertia_matrix();
        let inertia = DMat3::from_cols(ours(m.x_axis), ours(m.y_axis), ours(m.z_axis));
        Moments { mass_kg, center: ours(found.local_com), inertia }
    }

    /// The solid in the simulation.
    pub(crate) fn shape(&self) -> Option<SharedShape> {
        let corners: Vec<_> = self.corners.iter().copied().map(vector).collect();
        SharedShape::convex_mesh(corners.clone(), &self.triangles).or_else(|| SharedShape::convex_hull(&corners))
    }
}

impl Moments {
    /// Moments of several solids that move as one; `None` of none, or without mass.
    pub fn joined(all: &[Self]) -> Option<Self> {
        let mass_kg: f64 = all.iter().map(|m| m.mass_kg).sum();
        if mass_kg <= 0.0 {
            return None;
        }
        let center = all.iter().map(|m| m.center * m.mass_kg).sum::<DVec3>() / mass_kg;
        // Steiner's theorem: m (|d|² 1 − d dᵀ) for a centre away by d.
        let moved = |m: &Self| {
            let d = m.center - center;
            let outer = DMat3::from_cols(d * d.x, d * d.y, d * d.z);
            m.inertia + (DMat3::IDENTITY * d.length_squared() - outer) * m.mass_kg
        };
        Some(Self { mass_kg, center, inertia: all.iter().map(moved).fold(DMat3::ZERO, |sum, m| sum + m) })
    }

    /// The moments in the simulation.
    pub(crate) fn properties(&self) -> MassProperties {
        let [x, y, z] = [self.inertia.x_axis, self.inertia.y_axis, self.inertia.z_axis].map(vector);
        MassProperties::with_inertia_matrix(vector(self.center), self.mass_kg, Matrix::from_cols(x, y, z))
    }
}

/// The solid of a mesh that is convex, or flat; `None` of others, and of lines.
pub fn convex_solid(points: &[DVec3], triangles: &[[u32; 3]]) -> Option<Solid> {
    Solid::around(points).filter(|solid| is_convex(points, triangles, &solid.corners))
}

/// The convex solids of a mesh that is not convex: V-HACD's pieces, as those of `[[object]]`, with fewer corners, and with
/// coarser voxels where it is small. Of a mesh in which there are none, its hull.
pub fn solids(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<Solid> {
    let fewer = |solid: Solid| match solid.corners.len() {
        0..=CORNERS => Some(solid),
        _ => Solid::around(&farthest(&solid.corners, CORNERS)),
    };
    let (low, high) = bounds(points);
    let voxels = ((high - low).max_element() / VOXEL_M) as u32;
    let parts = cut(points, triangles, voxels.clamp(VOXELS[0], VOXELS[1]));
    let found: Vec<Solid> = parts.iter().filter_map(|part| Solid::around(part).and_then(fewer)).collect();
    if found.is_empty() { Solid::around(points).and_then(fewer).into_iter().collect() } else { found }
}

/// The normal of the plane through three points that span much; `None` where all lie on a line.
fn widest_normal(points: &[DVec3]) -> Option<DVec3> {
    let first = *points.first()?;
    let farthest = |from: &dyn Fn(&DVec3) -> f64| points.iter().copied().max_by(|a, b| from(a).total_cmp(&from(b)));
    let second = farthest(&|p| p.distance_squared(first))?;
    let axis = (second - first).try_normalize()?;
    let third = farthest(&|p| (*p - first).cross(axis).length_squared())?;
    let across = (third - first).cross(axis);
    (across.length() > IN_PLANE * (second - first).length()).then(|| across.normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(size: DVec3) -> Vec<DVec3> {
        (0..8).map(|i| size * DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect()
    }

    #[test]
    fn a_box_has_the_mass_and_inertia_of_its_formula() {
        let size = DVec3::new(0.2, 0.3, 0.5);
        let solid = Solid::around(&block(size)).unwrap();
        assert!((solid.volume_m3() - 0.03).abs() < 1e-12);
        let moments = solid.moments(6.0);
        assert!(moments.center.distance(size / 2.0) < 1e-9);
        // m (b² + c²) / 12 about the first axis, and so on.
        let squares = size * size;
        let expected = DVec3::new(squares.y + squares.z, squares.x + squares.z, squares.x + squares.y) * (6.0 / 12.0);
        let diagonal = DVec3::new(moments.inertia.x_axis.x, moments.inertia.y_axis.y, moments.inertia.z_axis.z);
        assert!(diagonal.distance(expected) < 1e-9, "{diagonal} {expected}");
    }

    #[test]
    fn halves_joined_are_the_whole() {
        let whole = Solid::around(&block(DVec3::new(0.4, 0.1, 0.1))).unwrap().moments(2.0);
        let half = block(DVec3::new(0.2, 0.1, 0.1));
        let other: Vec<DVec3> = half.iter().map(|p| *p + DVec3::X * 0.2).collect();
        let halves = [half, other].map(|points| Solid::around(&points).unwrap().moments(1.0));
        let joined = Moments::joined(&halves).unwrap();
        assert!(joined.center.distance(whole.center) < 1e-9);
        let worst = (joined.inertia - whole.inertia).to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max);
        assert!(worst < 1e-9, "{worst}");
    }

    #[test]
    fn a_floor_of_thin_boards_has_a_hull() {
        let row = |z: f64, inset: f64| {
            let ends = move |i: i32, j: i32| {
                [0.0, 1.0].map(|to| [0.0, 1.0].map(|too| DVec3::new(f64::from(i) + to, f64::from(j) * 0.165 + 0.165 * too, z)))
            };
            let all = (0..6).flat_map(move |i| (0..25).flat_map(move |j| ends(i, j).into_iter().flatten()));
            all.map(move |p| p + DVec3::new(if p.x < 0.5 { inset } else { -inset }, if p.y < 0.1 { inset } else { -inset }, 0.0))
        };
        let solid = Solid::around(&row(0.0, 0.0016).chain(row(-0.0012, 0.0)).collect::<Vec<_>>()).unwrap();
        assert!((solid.volume_m3() / (6.0 * 25.0 * 0.165 * 0.0012) - 1.0).abs() < 0.01, "{}", solid.volume_m3());
    }

    #[test]
    fn a_tilted_sheet_has_a_thickness_and_a_line_is_nothing() {
        let sheet = [DVec3::ZERO, DVec3::new(0.2, 0.0, 0.2), DVec3::new(0.2, 0.3, 0.2), DVec3::new(0.0, 0.3, 0.0)];
        let area = 0.3 * (0.2f64 * 0.2 * 2.0).sqrt();
        assert!((Solid::around(&sheet).unwrap().volume_m3() - area * SHEET_M).abs() < 1e-9);
        assert_eq!(Solid::around(&[DVec3::ZERO, DVec3::X, DVec3::X * 2.0]), None);
    }
}
