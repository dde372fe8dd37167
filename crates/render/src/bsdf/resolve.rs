//! From a material of the scene, at one surface point, to its lobes.

use super::coat::CoatTable;
use super::coated::Coated;
use super::ggx::Facets;
use super::layers::CLEARCOAT_ETA;
use super::mixture::Mixture;
use super::sheen::Sheen;
use super::{Bsdf, Fresnel, Layers, Lobe, Model, fresnel, thin_reflectance};
use enfilade_math::{Rgb, Vec2};
use enfilade_scene::{self as scene, ColorParam, Image, Material, Principled, ScalarParam};

/// What is needed to read a material at a point.
#[derive(Clone, Copy)]
pub struct Inputs<'a> {
    /// The scene's pictures.
    pub images: &'a [Image],
    /// Texture coordinates of the point.
    pub uv: Vec2,
    /// The coat of the material's index of refraction, if it has a diffuse base under a dielectric.
    pub coat: Option<&'a CoatTable>,
    /// Cosine of the viewing direction, > 0.
    pub cos_o: f32,
    /// True when `wo` is on the side that outward normals point to.
    pub outside: bool,
}

impl Inputs<'_> {
    /// A colour parameter here, on [0,∞).
    #[inline]
    pub fn color(&self, p: &ColorParam) -> Rgb {
        match &p.texture {
            Some(t) => p.factor * self.images[t.image as usize].sample(t, self.uv).0,
            None => p.factor,
        }
    }

    /// A colour parameter here, on [0,1].
    #[inline]
    fn reflectance(&self, p: &ColorParam) -> Rgb {
        self.color(p).map(|v| v.clamp(0.0, 1.0))
    }

    /// A scalar parameter here.
    #[inline]
    pub fn scalar(&self, p: &ScalarParam) -> f32 {
        match &p.texture {
            Some((t, channel)) if p.factor != 0.0 => {
                let (rgb, alpha) = self.images[t.image as usize].sample(t, self.uv);
                p.factor * if *channel == 3 { alpha } else { rgb[usize::from(*channel)] }
            }
            _ => p.factor,
        }
    }

    /// A scalar parameter here, on [0,1].
    #[inline]
    fn share(&self, p: &ScalarParam) -> f32 {
        self.scalar(p).clamp(0.0, 1.0)
    }
}

impl<'a> Bsdf<'a> {
    /// The scattering of `material` at a point.
    #[inline]
    pub fn new(material: &'a Material, at: &Inputs<'a>) -> Self {
        match &material.bsdf {
            scene::Bsdf::Diffuse { reflectance } => Self::lambert(at.reflectance(reflectance)),
            scene::Bsdf::Conductor { eta, k, reflectance, alpha } => {
                let facets = Facets::new(at.scalar(alpha), at.cos_o);
                Self::one(Lobe::Reflection { facets, fresnel: Fresnel::Conductor { eta, k }, tint: at.reflectance(reflectance) })
            }
            scene::Bsdf::Dielectric { eta, alpha, transmittance, .. } => {
                let eta = if at.outside { *eta } else { 1.0 / *eta };
                let facets = Facets::new(at.scalar(alpha), at.cos_o);
                Self::one(Lobe::Refraction { facets, eta, tint: at.reflectance(transmittance) })
            }
            scene::Bsdf::ThinDielectric { eta, transmittance } => Self::one(Lobe::Thin { eta: *eta, tint: at.reflectance(transmittance) }),
            scene::Bsdf::Plastic { diffuse, alpha, specular, nonlinear, .. } => {
                coated(at, at.reflectance(diffuse), at.scalar(alpha), at.reflectance(specular), *nonlinear)
            }
            scene::Bsdf::Principled(p) => principled(p, at),
        }
    }

    fn one(lobe: Lobe<'a>) -> Self {
        Self { reflectance: Rgb::BLACK, model: Model::One(lobe) }
    }
}

/// A diffuse base under the point's coat; without one (an index of one or less) the base alone.
#[inline]
fn coated<'a>(at: &Inputs<'a>, reflectance: Rgb, alpha: f32, tint: Rgb, saturating: bool) -> Bsdf<'a> {
    let Some(table) = at.coat else { return Bsdf::lambert(reflectance) };
    let lobe = Lobe::Coated(Coated::new(table.at(alpha), alpha, reflectance, tint, saturating, at.cos_o));
    Bsdf { reflectance, model: Model::One(lobe) }
}

/// glTF's metallic-roughness model: a metal, a transparent body and a coated diffuse base in their shares, under sheen and
/// clear-coat.
fn principled<'a>(p: &Principled, at: &Inputs<'a>) -> Bsdf<'a> {
    let base = at.reflectance(&p.base_color);
    let metallic = at.share(&p.metallic);
    let transmission = at.share(&p.transmission);
    let alpha = at.share(&p.roughness).powi(2);
    let (glass, solid) = ((1.0 - metallic) * transmission, (1.0 - metallic) * (1.0 - transmission));

    let coated_base = || {
        // Fresnel's equations instead of glTF's Schlick, so that coat and base share out exactly all light; the specular
        // colour tints at every angle.
        let tint = at.reflectance(&p.specular_color) * at.share(&p.specular);
        coated(at, base, alpha, tint, false)
    };
    let metal = || Lobe::Reflection { facets: Facets::new(alpha, at.cos_o), fresnel: Fresnel::Schlick { f0: base }, tint: Rgb::WHITE };
    let body = || match p.solid {
        true => Lobe::Refraction { facets: Facets::new(alpha, at.cos_o), eta: if at.outside { p.ior } else { 1.0 / p.ior }, tint: base },
        false => Lobe::Thin { eta: p.ior, tint: base },
    };

    let sheen_color = at.reflectance(&p.sheen_color);
    let clearcoat = if at.outside { at.share(&p.clearcoat) } else { 0.0 };
    let covered = clearcoat > 0.0 || !sheen_color.is_black();
    if !covered {
        if solid == 1.0 {
            return coated_base();
        }
        if metallic == 1.0 {
            return Bsdf::one(metal());
        }
        if glass == 1.0 {
            return Bsdf::one(body());
        }
    }

    let mut reflectance = Rgb::BLACK;
    let mut mixture = Mixture::new();
    if solid > 0.0 {
        let bsdf = coated_base();
        reflectance = bsdf.reflectance * solid;
        if let Model::One(lobe) = bsdf.model {
            mixture.add(lobe, Rgb::WHITE, solid, solid * lobe.albedo(at.cos_o).total(bsdf.reflectance).luminance());
        }
    }
    if metallic > 0.0 {
        let lobe = metal();
        mixture.add(lobe, Rgb::BLACK, metallic, metallic * lobe.albedo(at.cos_o).specular.luminance());
    }
    if glass > 0.0 {
        mixture.add(body(), Rgb::BLACK, glass, glass);
    }
    if covered {
        cover(&mut mixture, p, at, sheen_color, clearcoat);
    }
    mixture.finish();
    let model = if mixture.is_empty() { Model::Black } else { Model::Mixture(mixture) };
    Bsdf { reflectance, model }
}

/// Lays sheen and clear-coat over the lobes of a principled material.
fn cover(mixture: &mut Mixture<'_>, p: &Principled, at: &Inputs<'_>, sheen_color: Rgb, clearcoat: f32) {
    let sheen_roughness = at.scalar(&p.sheen_roughness).clamp(0.05, 1.0);
    mixture.cover(Layers { clearcoat, sheen: sheen_color.max_component(), sheen_roughness });
    let under_coat = 1.0 - clearcoat * fresnel::dielectric(at.cos_o, CLEARCOAT_ETA).0;
    let sheen = Lobe::Sheen(Sheen::new(sheen_roughness, sheen_color * under_coat, at.cos_o));
    mixture.add(sheen, Rgb::BLACK, 1.0, 0.3 * sheen_color.luminance());
    if clearcoat > 0.0 {
        let facets = Facets::new(at.share(&p.clearcoat_roughness).powi(2), at.cos_o);
        let lobe = Lobe::Reflection { facets, fresnel: Fresnel::Dielectric { eta: CLEARCOAT_ETA }, tint: Rgb::WHITE };
        mixture.add(lobe, Rgb::BLACK, clearcoat, clearcoat * fresnel::dielectric(at.cos_o, CLEARCOAT_ETA).0);
    }
}

/// Share of light that goes straight through a thin pane of `material` at cosine `cos`; `None` when it has no such lobe.
///
/// This is the [`Lobe::Thin`] of [`Bsdf::new`] as a shadow ray sees it.
pub fn straight_transmittance(material: &Material, at: &Inputs<'_>) -> Option<Rgb> {
    match &material.bsdf {
        scene::Bsdf::ThinDielectric { eta, transmittance } => {
            Some(at.reflectance(transmittance) * (1.0 - thin_reflectance(at.cos_o, *eta)))
        }
        scene::Bsdf::Principled(p) if !p.solid && p.transmission.factor > 0.0 => {
            let glass = (1.0 - at.share(&p.metallic)) * at.share(&p.transmission);
            let sheen = at.reflectance(&p.sheen_color).max_component();
            let clearcoat = if at.outside { at.share(&p.clearcoat) } else { 0.0 };
            let layers = Layers { clearcoat, sheen, sheen_roughness: at.scalar(&p.sheen_roughness).clamp(0.05, 1.0) };
            let pane = at.reflectance(&p.base_color) * (1.0 - thin_reflectance(at.cos_o, p.ior));
            Some(pane * (glass * layers.passes(at.cos_o, at.cos_o)))
        }
        _ => None,
    }
}
