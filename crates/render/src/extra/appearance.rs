//! Material parameters of a surface in the terms that most renderers share: base colour, metal, roughness, transmission.

use crate::bsdf::fresnel;
use crate::prepared::RenderScene;
use crate::surface::Surface;
use crate::texture::{Footprint, Textures};
use enfilade_math::{Rgb, Vec2};
use enfilade_scene::{Bsdf, ColorParam, ScalarParam};

/// A material at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Appearance {
    /// On [0,1].
    pub base_color: Rgb,
    /// Fraction of metal.
    pub metallic: f32,
    /// GGX alpha; 1 where there is nothing but diffusion.
    pub alpha: f32,
    /// Fraction that lets light through.
    pub transmission: f32,
}

impl Appearance {
    /// Perceptual roughness.
    pub fn roughness(&self) -> f32 {
        self.alpha.sqrt()
    }

    fn lerp(self, other: Self, fraction: f32) -> Self {
        let mix = |a: f32, b: f32| a + fraction * (b - a);
        Self {
            base_color: self.base_color.lerp(other.base_color, fraction),
            metallic: mix(self.metallic, other.metallic),
            alpha: mix(self.alpha, other.alpha),
            transmission: mix(self.transmission, other.transmission),
        }
    }
}

impl Surface<'_> {
    /// Material parameters of the surface at this point.
    pub(crate) fn appearance(&self, scene: &RenderScene<'_>) -> Appearance {
        At { textures: &scene.textures, uv: self.uv }.appearance(&self.material.bsdf)
    }
}

struct At<'a> {
    textures: &'a Textures<'a>,
    uv: Vec2,
}

impl At<'_> {
    fn color(&self, p: &ColorParam) -> Rgb {
        self.textures.color(p, self.uv, &Footprint::POINT).map(|v| v.clamp(0.0, 1.0))
    }

    fn unit_scalar(&self, p: &ScalarParam) -> f32 {
        self.textures.scalar(p, self.uv, &Footprint::POINT).clamp(0.0, 1.0)
    }

    fn appearance(&self, bsdf: &Bsdf) -> Appearance {
        let dull = |base_color| Appearance { base_color, metallic: 0.0, alpha: 1.0, transmission: 0.0 };
        match bsdf {
            Bsdf::Diffuse { reflectance } | Bsdf::RoughDiffuse { reflectance, .. } => dull(self.color(reflectance)),
            Bsdf::Conductor { eta, k, reflectance, alpha } => {
                let base_color = self.color(reflectance) * fresnel::conductor(1.0, *eta, *k);
                Appearance { metallic: 1.0, alpha: self.unit_scalar(alpha), ..dull(base_color) }
            }
            Bsdf::Dielectric { alpha, transmittance, .. } => {
                Appearance { alpha: self.unit_scalar(alpha), transmission: 1.0, ..dull(self.color(transmittance)) }
            }
            Bsdf::ThinDielectric { transmittance, .. } => Appearance { alpha: 0.0, transmission: 1.0, ..dull(self.color(transmittance)) },
            Bsdf::Plastic { diffuse, alpha, .. } => Appearance { alpha: self.unit_scalar(alpha), ..dull(self.color(diffuse)) },
            Bsdf::Principled(p) => {
                let metallic = self.unit_scalar(&p.metallic);
                let transmission = (1.0 - metallic) * self.unit_scalar(&p.transmission);
                Appearance { base_color: self.color(&p.base_color), metallic, alpha: self.unit_scalar(&p.roughness).powi(2), transmission }
            }
            Bsdf::Disney(p) => {
                let metallic = if p.thin { 0.0 } else { self.unit_scalar(&p.metallic) };
                let through = self.unit_scalar(&p.spec_trans);
                let diffuse =
                    if p.thin { 0.5 * self.textures.scalar(&p.diff_trans, self.uv, &Footprint::POINT).clamp(0.0, 2.0) } else { 0.0 };
                let transmission = (1.0 - metallic) * (through + (1.0 - through) * diffuse);
                Appearance { base_color: self.color(&p.base_color), metallic, alpha: self.unit_scalar(&p.roughness).powi(2), transmission }
            }
            Bsdf::Blend { first, second, weight } => self.appearance(first).lerp(self.appearance(second), self.unit_scalar(weight)),
        }
    }
}
