//! Metals, by their complex indices of refraction near 612, 549 and 465 nm: Johnson & Christy and Palik, by way of
//! refractiveindex.info.

use super::Maker;
use enfilade_math::{Rgb, Vec2};
use enfilade_scene::{Bsdf, Material, ScalarParam};
use enfilade_textures::{self as texture, Grain};

/// Real and imaginary part.
type Index = [Rgb; 2];

pub const STEEL: Index = [Rgb::new(2.91, 2.95, 2.58), Rgb::new(3.09, 2.93, 2.77)];
/// Evened out between the channels: plated chromium is neutral.
pub const CHROMIUM: Index = [Rgb::new(3.1, 2.92, 2.4), Rgb::new(4.2, 4.23, 4.0)];
pub const BRASS: Index = [Rgb::new(0.444, 0.527, 1.094), Rgb::new(3.695, 2.765, 1.829)];
pub const COPPER: Index = [Rgb::new(0.20, 0.92, 1.10), Rgb::new(3.91, 2.45, 2.14)];
pub const ALUMINIUM: Index = [Rgb::new(1.35, 0.97, 0.62), Rgb::new(7.47, 6.40, 5.30)];
pub const SILVER: Index = [Rgb::new(0.155, 0.145, 0.135), Rgb::new(4.10, 3.40, 2.45)];

/// Polished or ground metal of roughness `alpha`, darkened to `reflectance`.
pub fn conductor(name: &str, [eta, k]: Index, reflectance: f32, alpha: impl Into<ScalarParam>) -> Material {
    Material::new(name, Bsdf::Conductor { eta, k, reflectance: Rgb::splat(reflectance).into(), alpha: alpha.into().into() })
}

impl Maker<'_> {
    /// Metal ground along u: fine scratches that spread highlights across them.
    pub(super) fn brushed(&mut self, name: &'static str, index: Index, alpha: f32) -> Material {
        let layers =
            self.skin("brushed metal", &(), [0.30, 0.15], |seed| texture::skin("brushed metal", [512, 512], |uv| scratches(uv, seed)));
        layers.relieved(conductor(name, index, 0.97, layers.alpha(alpha / 0.5)), 0.000_04)
    }
}

/// Scratches along u; roughness about one half.
fn scratches(uv: Vec2, seed: u32) -> Grain {
    let line = |along: i32, across: i32, key: u32| {
        texture::noise::noise(Vec2::new(uv.x * along as f32, uv.y * across as f32), [along, across], seed ^ key)
    };
    let fine = line(5, 256, 1) + 0.6 * line(9, 120, 2);
    Grain { color: Rgb::WHITE, alpha: 0.5 + 0.08 * fine, height: 0.5 + 0.28 * fine }
}
