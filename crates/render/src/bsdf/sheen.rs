//! Retro-reflecting fuzz of cloth. Estevez & Kulla 2017, "Production Friendly Microfacet Sheen BRDF".

use enfilade_math::{INV_PI, Rgb, Vec3, warp};
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

#[inline]
fn unit_value(wo: Vec3, wi: Vec3, roughness: f32) -> f32 {
    let m = (wo + wi).normalize();
    charlie(m, roughness) / (4.0 * (wo.z + wi.z - wo.z * wi.z))
}

/// The "Charlie" distribution of fibres. Its `alpha` is the square of the roughness.
#[inline]
fn charlie(m: Vec3, roughness: f32) -> f32 {
    let inverse_alpha = 1.0 / (roughness * roughness).max(1e-4);
    let sin2 = (m.x * m.x + m.y * m.y).clamp(0.0, 1.0);
    (2.0 + inverse_alpha) * sin2.powf(0.5 * inverse_alpha) * (0.5 * INV_PI)
}

/// Directional albedo of white fuzz, from a table computed once.
pub fn unit_albedo(cos: f32, roughness: f32) -> f32 {
    const N: usize = 16;
    static TABLE: LazyLock<[[f32; N]; N]> = LazyLock::new(|| {
        std::array::from_fn(|r| {
            let roughness = (r as f32 + 0.5) / N as f32;
            std::array::from_fn(|c| {
                let cos = (c as f32 + 0.5) / N as f32;
                let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                let n = 2048u32;
                let directions = (0..n).map(|i| warp::cosine_hemisphere(warp::hammersley(i, n))).filter(|wi| wi.z > 0.0);
                directions.map(|wi| unit_value(wo, wi, roughness) / warp::cosine_hemisphere_pdf(wi.z)).sum::<f32>() / n as f32
            })
        })
    });
    let cell = |v: f32| {
        let x = (v * N as f32 - 0.5).clamp(0.0, (N - 1) as f32);
        let i = (x as usize).min(N - 2);
        (i, x - i as f32)
    };
    let ((r, fr), (c, fc)) = (cell(roughness), cell(cos));
    let row = |r: usize| TABLE[r][c] * (1.0 - fc) + TABLE[r][c + 1] * fc;
    row(r) * (1.0 - fr) + row(r + 1) * fr
}
