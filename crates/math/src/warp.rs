//! Maps from the unit square to the domains of rendering, each with its density.
//!
//! ```
//! use enfilade_math::{Vec3, warp};
//!
//! // The middle of the square is straight up; a direction's density falls with the cosine of its angle to the normal.
//! let up = warp::cosine_hemisphere([0.5, 0.5]);
//! assert_eq!(up, Vec3::Z);
//! assert_eq!(warp::cosine_hemisphere_pdf(up.z), std::f32::consts::FRAC_1_PI);
//!
//! // The maps to the disk and the hemisphere can be inverted.
//! let wi = warp::cosine_hemisphere([0.2, 0.7]);
//! let [u, v] = warp::square_from_cosine_hemisphere(wi);
//! assert!((u - 0.2).abs() < 1e-5 && (v - 0.7).abs() < 1e-5);
//! ```

use crate::angle::{atan_below_one, sin_cos_eighth, sin_cos_turns};
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
