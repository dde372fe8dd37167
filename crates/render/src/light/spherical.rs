//! Points of triangles and rectangles sampled uniformly over the solid angle that they fill.

use enfilade_math::{Vec3, angle};
use std::f32::consts::{PI, TAU};

/// Solid angle of a triangle, its corners relative to the eye (Van Oosterom & Strackee 1983).
#[inline]
pub(super) fn triangle_solid_angle(corners: [Vec3; 3]) -> f32 {
    let [a, b, c] = corners.map(Vec3::normalize_or_zero);
    2.0 * angle::atan2(a.dot(b.cross(c)).abs(), 1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}

/// A unit direction uniform within the triangle's solid angle. `None` for degenerate triangles.
///
/// Arvo 1995, "Stratified Sampling of Spherical Triangles": one number divides the area by an arc from corner b to the
/// opposite side, the other one places the point on the arc.
pub(super) fn sample_triangle(corners: [Vec3; 3], u: [f32; 2]) -> Option<Vec3> {
    let [a, b, c] = corners.map(Vec3::normalize_or_zero);
    let (ab, ac, bc) = (a.cross(b).try_normalize()?, a.cross(c).try_normalize()?, b.cross(c).try_normalize()?);
    let alpha = angle_between(ab, ac);
    let (beta, gamma) = (angle_between(bc, -ab), angle_between(ac, bc));
    let area = alpha + beta + gamma - PI;
    let (sin_alpha, cos_alpha) = alpha.sin_cos();
    // The sub-triangle of area u·A has the angle φ + α at its new corner on the side ac.
    let (s, t) = (u[0] * area - alpha).sin_cos();
    let (k1, k2) = (t - cos_alpha, s + sin_alpha * a.dot(b));
    let cos_side = (((k2 * t - k1 * s) * cos_alpha - k2) / ((k2 * s + k1 * t) * sin_alpha)).clamp(-1.0, 1.0);
    if !cos_side.is_finite() {
        return None;
    }
    let across = (c - a * c.dot(a)).try_normalize()?;
    let corner = a * cos_side + across * (1.0 - cos_side * cos_side).max(0.0).sqrt();
    let one_minus_z = u[1] * (1.0 - corner.dot(b));
    let z = 1.0 - one_minus_z;
    let along = (corner - b * corner.dot(b)).try_normalize()?;
    (b * z + along * (one_minus_z * (2.0 - one_minus_z)).max(0.0).sqrt()).try_normalize()
}

#[inline]
fn angle_between(a: Vec3, b: Vec3) -> f32 {
    // Precise for small angles too.
    2.0 * (a - b).length().atan2((a + b).length())
}

/// A rectangle as seen from the origin of its own axes: x and y along the sides, z negative towards it.
///
/// Ureña, Fajardo & King 2013, "An Area-Preserving Parametrization for Spherical Rectangles".
pub(super) struct SphericalRectangle {
    x: [f32; 2],
    y: [f32; 2],
    z: f32,
    b: [f32; 2],
    k: f32,
    /// Solid angle of the triangle.
    pub solid_angle: f32,
}

impl SphericalRectangle {
    /// From the place of a corner relative to the eye, and the sides with their lengths. `None` from within its plane.
    #[inline]
    pub fn new(corner: Vec3, [side_u, side_v]: [Vec3; 2], [length_u, length_v]: [f32; 2]) -> Option<Self> {
        let (axis_x, axis_y) = (side_u / length_u, side_v / length_v);
        let (x0, y0) = (corner.dot(axis_x), corner.dot(axis_y));
        let z = -corner.dot(axis_x.cross(axis_y)).abs();
        if z > -1e-6 * (length_u + length_v) {
            return None;
        }
        let (x, y) = ([x0, x0 + length_u], [y0, y0 + length_v]);
        // The z components of the side planes' normals; the inner angles are between planes.
        let component = |v: f32| v / (v * v + z * z).sqrt();
        let (x_low, x_high, y_low, y_high) = (component(x[0]), component(x[1]), component(y[0]), component(y[1]));
        let (g0, g1) = (angle::acos(y_low * x_high), angle::acos(-x_high * y_high));
        let (g2, g3) = (angle::acos(y_high * x_low), angle::acos(-x_low * y_low));
        let k = TAU - g2 - g3;
        let solid_angle = g0 + g1 - k;
        (solid_angle > 0.0).then_some(Self { x, y, z, b: [-y_low, y_high], k, solid_angle })
    }

    /// A point as fractions of the two sides, uniform over the solid angle.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> [f32; 2] {
        let (sin, cos) = angle::sin_cos_turns((u[0] * self.solid_angle + self.k) / TAU);
        let f = (cos * self.b[0] - self.b[1]) / sin;
        let c = (f.signum() / (f * f + self.b[0] * self.b[0]).sqrt()).clamp(-1.0, 1.0);
        let x = (-(c * self.z) / (1.0 - c * c).max(1e-12).sqrt()).clamp(self.x[0], self.x[1]);
        let d2 = x * x + self.z * self.z;
        let component = |y: f32| y / (d2 + y * y).sqrt();
        let (h0, h1) = (component(self.y[0]), component(self.y[1]));
        let h = h0 + u[1] * (h1 - h0);
        let y = if h * h < 1.0 - 1e-6 { h * d2.sqrt() / (1.0 - h * h).sqrt() } else { self.y[1] };
        let fraction = |v: f32, [low, high]: [f32; 2]| ((v - low) / (high - low)).clamp(0.0, 1.0);
        [fraction(x, self.x), fraction(y, self.y)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_testkit::ChiSquare;

    /// Intersection of the ray from the origin with the plane of three points, in terms of their two edge vectors.
    fn place(d: Vec3, [a, b, c]: [Vec3; 3]) -> Option<[f32; 2]> {
        let (e1, e2) = (b - a, c - a);
        let n = e1.cross(e2);
        let t = a.dot(n) / d.dot(n);
        let q = d * t - a;
        let inverse = 1.0 / n.length_squared();
        (t > 0.0 && t.is_finite()).then(|| [q.cross(e2).dot(n) * inverse, e1.cross(q).dot(n) * inverse])
    }

    fn inside_triangle(d: Vec3, corners: [Vec3; 3]) -> bool {
        place(d, corners).is_some_and(|[s, t]| s >= 0.0 && t >= 0.0 && s + t <= 1.0)
    }

    #[test]
    fn triangles_are_sampled_evenly_over_their_solid_angle() {
        let shapes = [
            [Vec3::new(-1.0, -1.0, 1.0), Vec3::new(2.0, 0.0, 1.0), Vec3::new(0.0, 1.5, 0.7)],
            [Vec3::new(0.1, -3.0, 0.2), Vec3::new(0.1, 3.0, 0.3), Vec3::new(4.0, 0.0, -0.2)],
            [Vec3::new(-9.0, -8.0, 0.5), Vec3::new(9.0, -8.0, 0.5), Vec3::new(0.0, 9.0, 0.5)],
        ];
        for (i, corners) in shapes.into_iter().enumerate() {
            let density = 1.0 / triangle_solid_angle(corners);
            let test = ChiSquare::directions(
                200_000,
                |u| sample_triangle(corners, [u[0], u[1]]),
                |d| if inside_triangle(d, corners) { density } else { 0.0 },
            );
            test.assert(&format!("spherical triangle {i}"), 6);
        }
        // An octant has an eighth of the sphere.
        assert!((triangle_solid_angle([Vec3::X, Vec3::Y, Vec3::Z]) - PI / 2.0).abs() < 1e-6);
    }

    #[test]
    fn rectangles_are_sampled_evenly_over_their_solid_angle() {
        let cases = [
            (Vec3::new(-1.0, -0.5, 1.0), Vec3::X * 2.0, Vec3::Y),
            (Vec3::new(0.5, 0.5, -0.3), Vec3::Y * 3.0, Vec3::X * 2.0),
            (Vec3::new(1.0, -4.0, -3.0), Vec3::Y * 5.0, Vec3::Z * 6.0),
        ];
        for (i, (corner, u_side, v_side)) in cases.into_iter().enumerate() {
            let lengths = [u_side.length(), v_side.length()];
            let rectangle = SphericalRectangle::new(corner, [u_side, v_side], lengths).unwrap();
            let corners = [corner, corner + u_side, corner + u_side + v_side, corner + v_side];
            let by_triangles =
                triangle_solid_angle([corners[0], corners[1], corners[2]]) + triangle_solid_angle([corners[0], corners[2], corners[3]]);
            assert!((rectangle.solid_angle / by_triangles - 1.0).abs() < 1e-4, "{} {by_triangles}", rectangle.solid_angle);
            let test = ChiSquare::directions(
                200_000,
                |u| {
                    let [s, t] = rectangle.sample([u[0], u[1]]);
                    (corner + u_side * s + v_side * t).try_normalize()
                },
                |d| {
                    let inside = place(d, [corner, corner + u_side, corner + v_side])
                        .is_some_and(|[s, t]| (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t));
                    if inside { 1.0 / rectangle.solid_angle } else { 0.0 }
                },
            );
            test.assert(&format!("spherical rectangle {i}"), 6);
        }
    }
}
