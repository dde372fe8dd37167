//! Retro-reflecting fuzz of cloth, as glTF's `KHR_materials_sheen` has it: the distribution of Estevez & Kulla 2017, "Production Friendly
//! Microfacet Sheen BRDF".

use enfilade_math::{INV_PI, Rgb, Vec3, angle};
use std::f32::consts::PI;
use std::sync::LazyLock;

/// The fuzz of one surface point.
#[derive(Clone, Copy, Debug)]
pub struct Sheen {
    /// Perceptual roughness on (0,1].
    roughness: f32,
    /// Multiplies the value.
    color: Rgb,
}

impl Sheen {
    /// Fuzz of the perceptual roughness `roughness` > 0 seen at the cosine `cos_o`.
    pub fn new(roughness: f32, color: Rgb, cos_o: f32) -> Self {
        // Near the horizon the fitted lobe reflects more than it receives; it is scaled down to all of it.
        Self { roughness, color: color / unit_albedo(cos_o, roughness).max(1.0) }
    }

    /// Value × cosine; `wi` is above the surface.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.color * unit_value(wo, wi, self.roughness)
    }

    /// Directional albedo.
    pub fn albedo(&self, cos_o: f32) -> Rgb {
        self.color * unit_albedo(cos_o, self.roughness)
    }
}

/// Value × cosine of white fuzz, by the visibility of Neubelt & Pettineo 2013 as `KHR_materials_sheen` has it.
#[inline]
fn unit_value(wo: Vec3, wi: Vec3, roughness: f32) -> f32 {
    let m = (wo + wi).normalize();
    charlie(m, roughness) * wi.z / (4.0 * (wo.z + wi.z - wo.z * wi.z))
}

/// The "Charlie" distribution of fibres. Its `alpha` is the square of the roughness.
#[inline]
fn charlie(m: Vec3, roughness: f32) -> f32 {
    let inverse_alpha = 1.0 / (roughness * roughness).max(1e-4);
    let sin2 = (m.x * m.x + m.y * m.y).clamp(0.0, 1.0);
    (2.0 + inverse_alpha) * sin2.powf(0.5 * inverse_alpha) * (0.5 * INV_PI)
}

/// Roughnesses (r + 1/2)/16 of the table.
const ROUGHNESSES: usize = 16;
/// Cosines (c/31)² of the table; the first one counts as 10⁻⁴.
const COSINES: usize = 32;
/// Points of a table entry's quadrature in each of both angles.
const POINTS: usize = 48;

/// Directional albedo of white fuzz, from a table computed once.
pub fn unit_albedo(cos: f32, roughness: f32) -> f32 {
    static TABLE: LazyLock<[[f32; COSINES]; ROUGHNESSES]> = LazyLock::new(|| {
        std::array::from_fn(|r| {
            let roughness = (r as f32 + 0.5) / ROUGHNESSES as f32;
            std::array::from_fn(|c| quadrature((c as f32 / (COSINES - 1) as f32).powi(2).max(1e-4), roughness))
        })
    });
    let cell = |x: f32, n: usize| {
        let x = x.clamp(0.0, (n - 1) as f32);
        let i = (x as usize).min(n - 2);
        (i, x - i as f32)
    };
    let (r, fr) = cell(roughness * ROUGHNESSES as f32 - 0.5, ROUGHNESSES);
    let (c, fc) = cell(cos.max(0.0).sqrt() * (COSINES - 1) as f32, COSINES);
    let row = |r: usize| TABLE[r][c] * (1.0 - fc) + TABLE[r][c + 1] * fc;
    row(r) * (1.0 - fr) + row(r + 1) * fr
}

/// The albedo at the cosine `cos`, by the midpoint rule over half the hemisphere; cosines are squares, closer together at the horizon.
fn quadrature(cos: f32, roughness: f32) -> f32 {
    let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
    let middle = |i: usize| (i as f32 + 0.5) / POINTS as f32;
    let mut sum = 0.0;
    for (i, j) in (0..POINTS).flat_map(|i| (0..POINTS).map(move |j| (i, j))) {
        let (root, (sin_phi, cos_phi)) = (middle(i), angle::sin_cos_turns(0.5 * middle(j)));
        let z = root * root;
        let sin = (1.0 - z * z).sqrt();
        sum += unit_value(wo, Vec3::new(sin * cos_phi, sin * sin_phi, z), roughness) * 2.0 * root;
    }
    sum * 2.0 * PI / (POINTS * POINTS) as f32
}
