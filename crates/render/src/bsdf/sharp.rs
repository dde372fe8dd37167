//! What a viewer sees sharply in a surface: mirrored in it, and through it.

use super::disney;
use super::fresnel;
use super::ggx::{self, Facets};
use super::lobe::{Lobe, thin_reflectance};
use enfilade_math::{Rgb, Vec3};

/// Up to this roughness (alpha) what is mirrored or seen through a surface can be made out.
const SHARP_ALPHA: f32 = 0.05;

/// The fractions of light from all directions that a surface sends to one viewer, by how they are seen; estimates, as
/// [`Bsdf::albedo`](super::Bsdf::albedo) has them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sharp {
    /// From the direction of the mirror image.
    pub mirrored: Rgb,
    /// From one direction on the other side.
    pub through: Rgb,
    /// That direction, where it is bent: a unit vector in shading space that points away from the surface. `None` where light passes
    /// straight on.
    pub bent: Option<Vec3>,
    /// From everywhere else, without diffuse reflection.
    pub blurred: Rgb,
}

impl Sharp {
    /// Adds a part of another lobe's; of two directions on the other side, that of more light stays.
    pub(super) fn add(&mut self, other: &Self, part: f32) {
        if other.through.luminance() * part > self.through.luminance() {
            self.bent = other.bent;
        }
        self.mirrored += other.mirrored * part;
        self.through += other.through * part;
        self.blurred += other.blurred * part;
    }
}

impl Lobe<'_> {
    /// See [`super::Bsdf::sharp`].
    pub fn sharp(&self, wo: Vec3) -> Sharp {
        let is_sharp = |facets: &Facets| facets.alpha <= SHARP_ALPHA;
        let all = self.albedo(wo.z).specular;
        match self {
            Self::Coated(coated) if is_sharp(&coated.facets) => Sharp { mirrored: all, ..Sharp::default() },
            Self::Reflection { facets, .. } if is_sharp(facets) => Sharp { mirrored: all, ..Sharp::default() },
            Self::Refraction { facets, eta, tint, .. } if is_sharp(facets) => {
                let (mirrored, cos_t) = fresnel::dielectric(wo.z, *eta);
                let through = if cos_t > 0.0 { *tint * (1.0 - mirrored) } else { Rgb::BLACK };
                Sharp { mirrored: Rgb::splat(mirrored), through, bent: Some(bent(wo, *eta, cos_t)), ..Sharp::default() }
            }
            Self::Thin { facets, eta, tint, .. } if is_sharp(facets) => {
                let mirrored = thin_reflectance(wo.z, *eta);
                Sharp { mirrored: Rgb::splat(mirrored), through: *tint * (1.0 - mirrored), ..Sharp::default() }
            }
            Self::Disney(disney::Part::Coat { alpha }) if *alpha <= SHARP_ALPHA => Sharp { mirrored: all, ..Sharp::default() },
            Self::Disney(disney::Part::Through { facets, eta, .. }) if is_sharp(facets) => {
                let (_, cos_t) = fresnel::dielectric(wo.z, *eta);
                let through = if cos_t > 0.0 { all } else { Rgb::BLACK };
                Sharp { through, bent: Some(bent(wo, *eta, cos_t)), ..Sharp::default() }
            }
            Self::Disney(disney::Part::Sheet { facets, .. }) if is_sharp(facets) => Sharp { through: all, ..Sharp::default() },
            _ => Sharp { blurred: all, ..Sharp::default() },
        }
    }
}

/// The direction, on the other side, of light that comes to `wo`.
fn bent(wo: Vec3, eta: f32, cos_t: f32) -> Vec3 {
    ggx::refract(wo, Vec3::Z, eta, cos_t).normalize()
}
