//! Maps from the unit square to the domains of rendering, each with its density.

use crate::{INV_PI, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Uniform on the unit disk by the concentric map (Shirley & Chiu 1997); density 1/π per area.
#[inline]
pub fn disk(u: [f32; 2]) -> Vec2 {
    let (a, b) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    if a == 0.0 && b == 0.0 {
        return Vec2::ZERO;
    }
    if a.abs() > b.abs() {
        let (sin, cos) = sin_cos_eighth((PI / 4.0) * (b / a));
        Vec2::new(a * cos, a * sin)
    } else {
        let (sin, cos) = sin_cos_eighth((PI / 4.0) * (a / b));
        Vec2::new(b * sin, b * cos)
    }
}

/// Sine and cosine of `turns` full turns, for |`turns`| below 10⁶: the same on every platform, to 10⁻⁷.
#[inline]
pub fn sin_cos_turns(turns: f32) -> (f32, f32) {
    let rounded = 4.0 * turns + 0.5;
    let towards_zero = rounded as i32;
    let quarter = towards_zero - i32::from(towards_zero as f32 > rounded);
    let (sin, cos) = sin_cos_eighth((turns - 0.25 * quarter as f32) * TAU);
    match quarter & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Sine and cosine by their series, for |`x`| ≤ π/4.
#[inline]
fn sin_cos_eighth(x: f32) -> (f32, f32) {
    let x2 = x * x;
    let sin = x * (1.0 + x2 * (-1.0 / 6.0 + x2 * (1.0 / 120.0 + x2 * (-1.0 / 5040.0 + x2 * (1.0 / 362_880.0)))));
    let cos = 1.0 + x2 * (-0.5 + x2 * (1.0 / 24.0 + x2 * (-1.0 / 720.0 + x2 * (1.0 / 40_320.0))));
    (sin, cos)
}

/// Inverse of [`disk`], to about 1e−6.
#[inline]
pub fn square_from_disk(d: Vec2) -> [f32; 2] {
    let r = d.length();
    let (a, b) = if d.x.abs() > d.y.abs() {
        let a = r.copysign(d.x);
        (a, a * (4.0 / PI) * atan_below_one(d.y / d.x))
    } else if d.y != 0.0 {
        let b = r.copysign(d.y);
        (b * (4.0 / PI) * atan_below_one(d.x / d.y), b)
    } else {
        (0.0, 0.0)
    };
    [0.5 * (a + 1.0), 0.5 * (b + 1.0)].map(|v| v.clamp(0.0, crate::ONE_MINUS_EPSILON))
}

/// Inverse of [`cosine_hemisphere`].
#[inline]
pub fn square_from_cosine_hemisphere(wi: Vec3) -> [f32; 2] {
    square_from_disk(Vec2::new(wi.x, wi.y))
}

/// atan on [−1,1] to 2e−8 and rounding. Abramowitz & Stegun 1964, 4.4.49.
#[inline]
fn atan_below_one(x: f32) -> f32 {
    const C: [f32; 8] =
        [-0.333_331_45, 0.199_935_51, -0.142_089, 0.106_562_64, -0.075_289_64, 0.042_909_61, -0.016_165_737, 0.002_866_225_7];
    // By Estrin's scheme, whose steps do not wait for each other.
    let x2 = x * x;
    let x4 = x2 * x2;
    let pairs = [C[0] + C[1] * x2, C[2] + C[3] * x2, C[4] + C[5] * x2, C[6] + C[7] * x2];
    let x8 = x4 * x4;
    x * (1.0 + x2 * ((pairs[0] + pairs[1] * x4) + (pairs[2] + pairs[3] * x4) * x8))
}

/// The angle of a cosine, radians; values beyond ±1 count as that. Abramowitz & Stegun 1964, 4.4.46: to 2e−8 and rounding.
#[inline]
pub fn acos(x: f32) -> f32 {
    const C: [f32; 8] = [1.570_796_3, -0.214_598_8, 0.088_978_99, -0.050_174_305, 0.030_891_88, -0.017_088_126, 0.006_670_09, -0.001_262_491_1];
    let a = x.abs().min(1.0);
    let a2 = a * a;
    let a4 = a2 * a2;
    let pairs = [C[0] + C[1] * a, C[2] + C[3] * a, C[4] + C[5] * a, C[6] + C[7] * a];
    let angle = (1.0 - a).sqrt() * ((pairs[0] + pairs[1] * a2) + (pairs[2] + pairs[3] * a2) * a4);
    if x < 0.0 { PI - angle } else { angle }
}

/// Cosine-weighted on the upper hemisphere; density [`cosine_hemisphere_pdf`].
#[inline]
pub fn cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    let d = disk(u);
    Vec3::new(d.x, d.y, (1.0 - d.length_squared()).max(0.0).sqrt())
}

/// cosθ/π per solid angle; zero below the horizon.
#[inline]
pub fn cosine_hemisphere_pdf(cos_theta: f32) -> f32 {
    cos_theta.max(0.0) * INV_PI
}

/// Uniform on the unit sphere; density 1/(4π) per solid angle.
#[inline]
pub fn sphere(u: [f32; 2]) -> Vec3 {
    let z = 1.0 - 2.0 * u[0];
    let (sin, cos) = sin_cos_turns(u[1]);
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(r * cos, r * sin, z)
}

/// Uniform in the cone of half-angle acos(`cos_max`) about +z; density [`cone_pdf`].
///
/// Stable for narrow cones such as the sun's: works on 1 − cosθ.
#[inline]
pub fn cone(u: [f32; 2], one_minus_cos_max: f32) -> Vec3 {
    let one_minus_cos = u[0] * one_minus_cos_max;
    let sin_theta = (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt();
    let (sin, cos) = sin_cos_turns(u[1]);
    Vec3::new(sin_theta * cos, sin_theta * sin, 1.0 - one_minus_cos)
}

/// Density of [`cone`] per solid angle, inside the cone.
#[inline]
pub fn cone_pdf(one_minus_cos_max: f32) -> f32 {
    1.0 / (TAU * one_minus_cos_max)
}

/// Barycentric coordinates (b1, b2) uniform on a triangle; density 1/area. Heitz 2019, "A Low-Distortion Map Between
/// Triangle and Square".
#[inline]
pub fn triangle(u: [f32; 2]) -> Vec2 {
    if u[1] > u[0] {
        let x = u[0] * 0.5;
        Vec2::new(x, u[1] - x)
    } else {
        let y = u[1] * 0.5;
        Vec2::new(u[0] - y, y)
    }
}

/// Offset from the pixel centre, in pixels, distributed as the tent filter of radius `radius` (1 = neighbouring centres).
#[inline]
pub fn tent(u: f32, radius: f32) -> f32 {
    let v = 2.0 * u - 1.0;
    radius * v.signum() * (1.0 - (1.0 - v.abs()).max(0.0).sqrt())
}

/// Uniform direction sample of the unit sphere by the Fibonacci spiral: point `k` of `n`, poles included to half a step.
pub fn fibonacci_sphere(k: usize, n: usize) -> glam::DVec3 {
    let golden_angle = std::f64::consts::PI * (3.0 - 5.0f64.sqrt());
    let z = if n == 1 { 0.0 } else { (1.0 / n as f64 - 1.0) + (2.0 - 2.0 / n as f64) * (k as f64 / (n - 1) as f64) };
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = (golden_angle * k as f64).sin_cos();
    glam::DVec3::new(r * cos, r * sin, z)
}

/// Point `i` of the `n`-point Hammersley set on the unit square: even coverage for quadrature, the same every time.
#[inline]
pub fn hammersley(i: u32, n: u32) -> [f32; 2] {
    [(i as f32 + 0.5) / n as f32, i.reverse_bits() as f32 * (1.0 / 4_294_967_296.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_of_cosines_are_those_of_the_mathematics_library() {
        for i in -1000..=1000 {
            let cos = i as f32 / 1000.0;
            assert!((f64::from(acos(cos)) - f64::from(cos).acos()).abs() < 5e-7, "{cos}: {}", acos(cos));
        }
        assert_eq!((acos(1.5), acos(-1.5)), (0.0, PI));
    }

    #[test]
    fn sines_and_cosines_are_those_of_the_mathematics_library() {
        for i in -4000..=4000 {
            let turns = i as f32 / 1000.0;
            let (sin, cos) = sin_cos_turns(turns);
            let exact = (f64::from(turns) * std::f64::consts::TAU).sin_cos();
            assert!((f64::from(sin) - exact.0).abs() < 3e-7 && (f64::from(cos) - exact.1).abs() < 3e-7, "{turns} turns: {sin}, {cos}");
        }
    }
}
