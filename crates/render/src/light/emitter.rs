//! Patches of emissive surface: what is sampled once the hierarchy has chosen one.
//!
//! A patch is a triangle, a rectangle of two triangles, or, where a texture varies the emission, a piece of either. Near ones
//! are sampled evenly over the solid angle, far ones over the area.

use super::bounds::LightBounds;
use super::spherical::{SphericalRectangle, sample_triangle, triangle_solid_angle};
use enfilade_math::{Bounds3, Rgb, Vec3, warp};

/// Patches that fill more than about this solid angle, in steradians, are sampled over it. Below, the area is as even and
/// cheaper, and single precision would not do.
const NEAR: f32 = 1.5;

/// A piece of emissive surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    shape: Shape,
    /// The triangle it is part of, or the first of two.
    triangle: u32,
    /// Square metres.
    area: f32,
    /// Unit normal; of the emitting side where there is one.
    normal: Vec3,
    emission: Emission,
}

/// Emission of a patch.
#[derive(Clone, Copy, Debug)]
pub(super) enum Emission {
    /// Even emission over the whole patch.
    Even { radiance: Rgb, two_sided: bool },
    /// To be looked up at each point.
    Varied,
}

#[derive(Clone, Copy, Debug)]
enum Shape {
    Triangle([Vec3; 3]),
    Rectangle { corner: Vec3, sides: [Vec3; 2], lengths: [f32; 2] },
}

/// A sampled point of a patch.
pub(super) struct PatchPoint {
    /// World position.
    pub q: Vec3,
    /// Unit direction to it.
    pub wi: Vec3,
    /// Distance, metres.
    pub distance: f32,
    /// Density per solid angle.
    pub pdf: f32,
}

impl Patch {
    /// A patch of `triangle`, all or a part.
    pub fn of_triangle(triangle: u32, corners: [Vec3; 3], normal: Vec3, emission: Emission) -> Self {
        let area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
        Self { shape: Shape::Triangle(corners), triangle, area, normal, emission }
    }

    /// `sides` are orthogonal; `triangle` and the next one make up the whole of which this is a part.
    pub fn of_rectangle(triangle: u32, corner: Vec3, sides: [Vec3; 2], normal: Vec3, emission: Emission) -> Self {
        let lengths = sides.map(Vec3::length);
        Self { shape: Shape::Rectangle { corner, sides, lengths }, triangle, area: lengths[0] * lengths[1], normal, emission }
    }

    pub fn emission(&self) -> Emission {
        self.emission
    }

    /// Unit normal; of the emitting side where there is one.
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    pub fn area(&self) -> f32 {
        self.area
    }

    /// Bounds for the hierarchy; `radiance` is the mean over the patch.
    pub fn light_bounds(&self, radiance: f32, two_sided: bool) -> LightBounds {
        let bounds = match self.shape {
            Shape::Triangle(corners) => Bounds3::from_points(corners),
            Shape::Rectangle { corner, sides: [u, v], .. } => Bounds3::from_points([corner, corner + u, corner + v, corner + u + v]),
        };
        LightBounds::flat(bounds, self.normal, radiance * self.area, two_sided)
    }

    /// A point of the patch, uniform over its area for `u` uniform on [0,1)².
    #[inline]
    pub fn place(&self, u: [f32; 2]) -> Vec3 {
        match self.shape {
            Shape::Triangle([a, b, c]) => {
                let w = warp::triangle(u);
                a * (1.0 - w.x - w.y) + b * w.x + c * w.y
            }
            Shape::Rectangle { corner, sides, .. } => corner + sides[0] * u[0] + sides[1] * u[1],
        }
    }

    /// A point of the patch for `u` uniform on [0,1)². `None` when it is seen edge-on.
    #[inline]
    pub fn sample(&self, p: Vec3, u: [f32; 2]) -> Option<PatchPoint> {
        let q = match (self.near(p), self.shape) {
            (Near::Triangle(solid_angle), Shape::Triangle(corners)) => {
                let wi = sample_triangle(corners.map(|c| c - p), u)?;
                let distance = (corners[0] - p).dot(self.normal) / wi.dot(self.normal);
                return (distance > 0.0 && distance.is_finite()).then(|| PatchPoint {
                    q: p + wi * distance,
                    wi,
                    distance,
                    pdf: 1.0 / solid_angle,
                });
            }
            (Near::Rectangle(rectangle), Shape::Rectangle { corner, sides, .. }) => {
                let [s, t] = rectangle.sample(u);
                let q = corner + sides[0] * s + sides[1] * t;
                let distance = q.distance(p);
                return (distance > 0.0).then(|| PatchPoint { q, wi: (q - p) / distance, distance, pdf: 1.0 / rectangle.solid_angle });
            }
            _ => self.place(u),
        };
        let distance = q.distance(p);
        let wi = (q - p) / distance;
        let pdf = distance * distance / (self.area * wi.dot(self.normal).abs());
        (distance > 0.0 && pdf.is_finite()).then_some(PatchPoint { q, wi, distance, pdf })
    }

    /// Density per solid angle with which [`Patch::sample`] finds its point in the unit direction `wi` and at `distance`.
    #[inline]
    pub fn pdf(&self, p: Vec3, wi: Vec3, distance: f32) -> f32 {
        match self.near(p) {
            Near::Triangle(solid_angle) => 1.0 / solid_angle,
            Near::Rectangle(rectangle) => 1.0 / rectangle.solid_angle,
            Near::No => {
                let pdf = distance * distance / (self.area * wi.dot(self.normal).abs());
                if pdf.is_finite() { pdf } else { 0.0 }
            }
        }
    }

    /// The triangle of the scene that the point `q` is on, with its weights of the second and third corner; `corners` gives the corners of
    /// a triangle by its number.
    #[inline]
    pub fn locate(&self, q: Vec3, corners: impl Fn(u32) -> [Vec3; 3]) -> (u32, [f32; 2]) {
        let first = self.triangle;
        let weights = barycentric(q, &corners(first));
        if matches!(self.shape, Shape::Triangle(_)) {
            return (first, inside(weights));
        }
        // Beyond the diagonal is the second triangle.
        let other = barycentric(q, &corners(first + 1));
        let depth = |[b, c]: [f32; 2]| b.min(c).min(1.0 - b - c);
        if depth(weights) >= depth(other) { (first, inside(weights)) } else { (first + 1, inside(other)) }
    }

    /// Whether the patch is sampled over its solid angle as seen from `p`.
    #[inline]
    fn near(&self, p: Vec3) -> Near {
        match self.shape {
            Shape::Triangle(corners) => {
                let middle = (corners[0] + corners[1] + corners[2]) / 3.0 - p;
                if self.area < NEAR * middle.length_squared() {
                    return Near::No;
                }
                let solid_angle = triangle_solid_angle(corners.map(|c| c - p));
                if (NEAR..6.2).contains(&solid_angle) { Near::Triangle(solid_angle) } else { Near::No }
            }
            Shape::Rectangle { corner, sides, lengths } => {
                let middle = corner + 0.5 * (sides[0] + sides[1]) - p;
                if self.area < NEAR * middle.length_squared() {
                    return Near::No;
                }
                match SphericalRectangle::new(corner - p, sides, lengths) {
                    Some(rectangle) if (NEAR..6.2).contains(&rectangle.solid_angle) => Near::Rectangle(rectangle),
                    _ => Near::No,
                }
            }
        }
    }
}

enum Near {
    No,
    /// Solid angle.
    Triangle(f32),
    Rectangle(SphericalRectangle),
}

/// Weights of the second and third corner at a point in a triangle's plane.
#[inline]
fn barycentric(q: Vec3, [a, b, c]: &[Vec3; 3]) -> [f32; 2] {
    let (e1, e2, d) = (*b - *a, *c - *a, q - *a);
    let n = e1.cross(e2);
    let inverse = 1.0 / n.length_squared().max(f32::MIN_POSITIVE);
    [d.cross(e2).dot(n) * inverse, e1.cross(d).dot(n) * inverse]
}

/// Weights moved into the triangle, which rounding may have left.
#[inline]
fn inside([b, c]: [f32; 2]) -> [f32; 2] {
    let (b, c) = (b.max(0.0), c.max(0.0));
    let sum = (b + c).max(1.0);
    [b / sum, c / sum]
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_testkit::ChiSquare;

    /// A patch over the unit square, where its density has no edges: the point at (x, y) and the area per unit of the square.
    fn unfold(patch: &Patch, [x, y]: [f32; 2]) -> (Vec3, f32) {
        match patch.shape {
            Shape::Triangle([a, b, c]) => (a + ((b - a) * (1.0 - y) + (c - a) * y) * x, 2.0 * patch.area * x),
            Shape::Rectangle { corner, sides: [u, v], .. } => (corner + u * x + v * y, patch.area),
        }
    }

    /// The inverse of [`unfold`].
    fn fold(patch: &Patch, q: Vec3) -> [f32; 2] {
        match patch.shape {
            Shape::Triangle(corners) => {
                let [b, c] = barycentric(q, &corners);
                [(b + c).clamp(0.0, 1.0), (c / (b + c)).clamp(0.0, 1.0)]
            }
            Shape::Rectangle { corner, sides, .. } => sides.map(|side| ((q - corner).dot(side) / side.length_squared()).clamp(0.0, 1.0)),
        }
    }

    fn triangle() -> Patch {
        let corners = [Vec3::new(1.0, -1.0, 0.0), Vec3::new(1.0, 2.0, 0.0), Vec3::new(1.5, 0.0, 2.0)];
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
        Patch::of_triangle(0, corners, normal, Emission::Varied)
    }

    fn rectangle() -> Patch {
        Patch::of_rectangle(0, Vec3::new(-1.0, 1.0, 0.5), [Vec3::X * 2.0, Vec3::Z * 1.5], Vec3::Y, Emission::Varied)
    }

    #[test]
    fn patches_are_sampled_as_their_density_says_near_and_far() {
        let (triangle, rectangle) = (triangle(), rectangle());
        for (i, (patch, p)) in [
            (&triangle, Vec3::ZERO),
            (&triangle, Vec3::new(-7.0, -6.0, 5.0)),
            (&rectangle, Vec3::ZERO),
            (&rectangle, Vec3::new(0.5, 1.05, 1.0)),
            (&rectangle, Vec3::new(4.0, -9.0, 3.0)),
        ]
        .into_iter()
        .enumerate()
        {
            let density = |xy: [f32; 2]| {
                let (q, area) = unfold(patch, xy);
                let distance = q.distance(p);
                let wi = (q - p) / distance;
                patch.pdf(p, wi, distance) * wi.dot(patch.normal).abs() / (distance * distance) * area
            };
            let test = ChiSquare::square(200_000, |u| patch.sample(p, [u[0], u[1]]).map(|s| fold(patch, s.q)), density);
            test.assert(&format!("patch {i}"), 5);
        }
    }

    #[test]
    fn the_density_of_a_sampled_point_is_the_density_at_that_point() {
        let patch = rectangle();
        for p in [Vec3::ZERO, Vec3::new(3.0, -8.0, 2.0)] {
            for u in [[0.1, 0.9], [0.5, 0.5], [0.99, 0.01]] {
                let s = patch.sample(p, u).unwrap();
                assert!((s.pdf / patch.pdf(p, s.wi, s.distance) - 1.0).abs() < 1e-5);
                assert!((p + s.wi * s.distance - s.q).length() < 1e-5);
            }
        }
    }
}
