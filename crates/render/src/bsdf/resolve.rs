//! From a material of the scene, at one surface point, to its lobes.

use super::coated::Coated;
use super::ggx::Facets;
use super::layers::CLEARCOAT_ETA;
use super::mixture::Mixture;
use super::rough_diffuse::RoughDiffuse;
use super::sheen::Sheen;
use super::{Bsdf, Fresnel, Inputs, Layers, Lobe, Model, disney_model, energy, fresnel, thin_reflectance};
use crate::texture::Footprint;
use enfilade_math::Rgb;
use enfilade_scene::{self as scene, Distribution, Principled};

impl<'a> Bsdf<'a> {
    /// The scattering of `bsdf` at a point.
    #[inline]
    pub fn new(bsdf: &'a scene::Bsdf, at: &Inputs<'a>) -> Self {
        match bsdf {
            scene::Bsdf::Diffuse { reflectance } => Self::lambert(at.reflectance(reflectance)),
            scene::Bsdf::RoughDiffuse { reflectance, roughness } => {
                let reflectance = at.reflectance(reflectance);
                if at.tables.lambertian {
                    return Self::lambert(reflectance);
                }
                let lobe = Lobe::RoughDiffuse(RoughDiffuse::new(reflectance, at.unit_scalar(roughness), at.cos_o));
                Self { reflectance, ..Self::one(lobe) }
            }
            scene::Bsdf::Conductor { eta, k, reflectance, alpha } => {
                let (fresnel, tint, roughness) = (Fresnel::Conductor { eta, k }, at.reflectance(reflectance), at.scalar(alpha));
                Self::one(match alpha.distribution {
                    Distribution::Ggx => metal(Facets::new(roughness, at.cos_o), fresnel, tint, at.cos_o),
                    Distribution::Beckmann => Lobe::Reflection { facets: Facets::beckmann(roughness, at.cos_o), fresnel, tint },
                })
            }
            scene::Bsdf::Dielectric { eta, alpha, transmittance, .. } => {
                Self::one(glass(*eta, at.scalar(alpha), alpha.distribution, at.reflectance(transmittance), at))
            }
            scene::Bsdf::ThinDielectric { eta, transmittance } => Self::one(thin(*eta, 0.0, at.reflectance(transmittance), at)),
            scene::Bsdf::Plastic { diffuse, alpha, specular, nonlinear, .. } => {
                // A saturating base reflects more on average than its average colour would, so no average is taken.
                let base = Inputs { footprint: if *nonlinear { Footprint::POINT } else { at.footprint }, ..*at };
                coated(at, base.reflectance(diffuse), at.scalar(alpha), at.reflectance(specular), *nonlinear, 1.0)
            }
            scene::Bsdf::Principled(p) => principled(p, at),
            scene::Bsdf::Disney(p) => disney_model::disney(p, at),
            scene::Bsdf::Blend { first, second, weight } => blend([first, second], at.unit_scalar(weight), at),
        }
    }

    fn one(lobe: Lobe<'a>) -> Self {
        Self { reflectance: Rgb::BLACK, model: Model::One(lobe) }
    }
}

/// A diffuse base of which the fraction `covered` is under the point's coat; without a coat (an index of one or less) only the base.
#[inline]
fn coated<'a>(at: &Inputs<'a>, reflectance: Rgb, alpha: f32, tint: Rgb, saturating: bool, covered: f32) -> Bsdf<'a> {
    let Some(table) = at.tables.coat.as_ref().filter(|_| covered > 0.0) else { return Bsdf::lambert(reflectance) };
    let lobe = Lobe::Coated(Coated::new(table.at(alpha), alpha, reflectance, tint, saturating, covered, at.cos_o));
    Bsdf { reflectance, model: Model::One(lobe) }
}

/// A metal with all bounces between its facets.
#[inline]
fn metal<'a>(facets: Facets, fresnel: Fresnel<'a>, tint: Rgb, cos_o: f32) -> Lobe<'a> {
    // Schlick's curve passes its cosine-weighted mean, 1/21 of the way up, at this cosine; metals follow it closely.
    const MEAN_COSINE: f32 = 0.456;
    let scale = if facets.smooth() { Rgb::WHITE } else { energy::of_metal(cos_o, facets.alpha, fresnel.eval(MEAN_COSINE)) };
    Lobe::Reflection { facets, fresnel, tint: tint * scale }
}

/// Indices of refraction this close to 1 count as 1: rough facets would bend light into directions that cannot be distinguished.
const NO_REFRACTION: f32 = 1e-3;

/// The border of a transparent body of the index `ior`, with all bounces between its facets where these are GGX's.
#[inline]
fn glass<'a>(ior: f32, alpha: f32, distribution: Distribution, tint: Rgb, at: &Inputs<'a>) -> Lobe<'a> {
    let eta = if at.outside { ior } else { 1.0 / ior };
    // A surface that does not bend light does not scatter it either, at any roughness.
    let alpha = if (ior - 1.0).abs() < NO_REFRACTION { 0.0 } else { alpha };
    let scale = at.tables.glass.as_ref().map_or(1.0, |table| table.scale(at.cos_o, alpha, at.outside));
    let facets = match distribution {
        Distribution::Ggx => Facets::new(alpha, at.cos_o),
        Distribution::Beckmann => Facets::beckmann(alpha, at.cos_o),
    };
    Lobe::Refraction { facets, eta, tint, scale }
}

/// A thin pane with all bounces between its facets.
#[inline]
fn thin<'a>(ior: f32, alpha: f32, tint: Rgb, at: &Inputs<'a>) -> Lobe<'a> {
    let facets = Facets::new(alpha, at.cos_o);
    // Transmitted light is scattered like reflected light, so the two together lose what a white metal loses.
    let scale = if facets.smooth() { 1.0 } else { energy::of_metal(at.cos_o, alpha, Rgb::WHITE).r };
    Lobe::Thin { facets, eta: ior, tint, scale }
}

/// Two materials side by side; `weight` is the fraction of the second.
fn blend<'a>(parts: [&'a scene::Bsdf; 2], weight: f32, at: &Inputs<'a>) -> Bsdf<'a> {
    let Some(tables) = at.tables.blended.as_deref() else { return Bsdf::black() };
    let part = |i: usize| Bsdf::new(parts[i], &Inputs { tables: &tables[i], ..*at });
    if weight == 0.0 || weight == 1.0 {
        return part(weight as usize);
    }
    let (first, second) = (part(0), part(1));
    let reflectance = first.reflectance.lerp(second.reflectance, weight);
    let fraction_of = |part: Rgb, fraction: f32| {
        let channel = |c: usize| if reflectance[c] > 0.0 { fraction * part[c] / reflectance[c] } else { 0.0 };
        Rgb::new(channel(0), channel(1), channel(2))
    };
    let mut mixture = Mixture::new();
    for (part, fraction) in [(&first, 1.0 - weight), (&second, weight)] {
        add(&mut mixture, part, fraction_of(part.reflectance, fraction), fraction, at.cos_o);
    }
    mixture.finish();
    let model = if mixture.is_empty() { Model::Black } else { Model::Mixture(mixture) };
    Bsdf { reflectance, model }
}

/// Adds a whole material to a mixture as the given `fraction` of it. `diffuse` is the share of its reflectance in the reflectance of the
/// whole.
fn add<'a>(mixture: &mut Mixture<'a>, bsdf: &Bsdf<'a>, diffuse: Rgb, fraction: f32, cos_o: f32) {
    match &bsdf.model {
        Model::Black => (),
        Model::One(lobe) => mixture.add(*lobe, diffuse, fraction, fraction * lobe.albedo(cos_o).total(bsdf.reflectance).luminance()),
        Model::Mixture(other) => mixture.add_mixture(other, bsdf.reflectance, diffuse, fraction, cos_o),
    }
}

/// glTF's metallic-roughness model: a metal, a transparent body and a coated diffuse base in their proportions, under sheen and
/// clear-coat.
fn principled<'a>(p: &Principled, at: &Inputs<'a>) -> Bsdf<'a> {
    let base = at.reflectance(&p.base_color);
    let metallic = at.unit_scalar(&p.metallic);
    let transmission = at.unit_scalar(&p.transmission);
    let alpha = at.unit_scalar(&p.roughness).powi(2);
    let (clear, solid) = ((1.0 - metallic) * transmission, (1.0 - metallic) * (1.0 - transmission));

    let coated_base = || {
        // Fresnel's equations instead of glTF's Schlick, so that coat and base together account for all light; the specular
        // colour tints at every angle. What its largest component does not reflect reaches the base: KHR_materials_specular.
        let tint = at.reflectance(&p.specular_color) * at.unit_scalar(&p.specular);
        coated(at, base, alpha, tint, false, tint.max_component())
    };
    let metal = || metal(Facets::new(alpha, at.cos_o), Fresnel::Schlick { f0: base }, Rgb::WHITE, at.cos_o);
    let body = || if p.solid { glass(p.ior, alpha, Distribution::Ggx, base, at) } else { thin(p.ior, alpha, base, at) };

    let sheen_color = at.reflectance(&p.sheen_color);
    let clearcoat = if at.outside { at.unit_scalar(&p.clearcoat) } else { 0.0 };
    let covered = clearcoat > 0.0 || !sheen_color.is_black();
    if !covered {
        if solid == 1.0 {
            return coated_base();
        }
        if metallic == 1.0 {
            return Bsdf::one(metal());
        }
        if clear == 1.0 {
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
    if clear > 0.0 {
        mixture.add(body(), Rgb::BLACK, clear, clear);
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
    let sheen = Sheen::new(sheen_roughness, sheen_color * under_coat, at.cos_o);
    // Seen from above, the albedo may round to nothing.
    let importance = sheen.albedo(at.cos_o).luminance() + 0.02 * sheen_color.luminance();
    mixture.add(Lobe::Sheen(sheen), Rgb::BLACK, 1.0, importance);
    if clearcoat > 0.0 {
        let facets = Facets::new(at.unit_scalar(&p.clearcoat_roughness).powi(2), at.cos_o);
        let lobe = Lobe::Reflection { facets, fresnel: Fresnel::Dielectric { eta: CLEARCOAT_ETA }, tint: Rgb::WHITE };
        mixture.add(lobe, Rgb::BLACK, clearcoat, clearcoat * fresnel::dielectric(at.cos_o, CLEARCOAT_ETA).0);
    }
}

/// Fraction of light that passes straight through thin panes of `bsdf` at a point; `None` if it has no smooth pane.
///
/// This is the [`Lobe::Thin`] of [`Bsdf::new`] as a shadow ray sees it.
pub fn straight_transmittance(bsdf: &scene::Bsdf, at: &Inputs<'_>) -> Option<Rgb> {
    match bsdf {
        scene::Bsdf::ThinDielectric { eta, transmittance } => {
            Some(at.reflectance(transmittance) * (1.0 - thin_reflectance(at.cos_o, *eta)))
        }
        scene::Bsdf::Principled(p) if !p.solid && p.transmission.factor > 0.0 => {
            if !Facets::new(at.unit_scalar(&p.roughness).powi(2), at.cos_o).smooth() {
                return None;
            }
            let clear = (1.0 - at.unit_scalar(&p.metallic)) * at.unit_scalar(&p.transmission);
            let layers = layers_over(p, at);
            let pane = at.reflectance(&p.base_color) * (1.0 - thin_reflectance(at.cos_o, p.ior));
            Some(pane * (clear * layers.passes(at.cos_o, at.cos_o)))
        }
        scene::Bsdf::Disney(p) if p.is_pane() => Some(disney_model::straight_transmittance(p, at)),
        scene::Bsdf::Blend { first, second, weight } => {
            let (first, second) = (straight_transmittance(first, at), straight_transmittance(second, at));
            if first.is_none() && second.is_none() {
                return None;
            }
            Some(first.unwrap_or_default().lerp(second.unwrap_or_default(), at.unit_scalar(weight)))
        }
        _ => None,
    }
}

/// How a smooth border of a transparent body reflects and refracts light that arrives along the viewing direction.
#[derive(Clone, Copy, Debug)]
pub struct Border {
    /// Index beyond the border over the index on the viewer's side.
    pub eta: f32,
    /// Fraction that is refracted; radiance is compressed by the square of `eta` beside that.
    pub transmitted: Rgb,
    /// Fraction that is mirrored.
    pub reflected: f32,
}

/// The border of a transparent body that `bsdf` is at a point; `None` where it is rough or no border. It is the [`Lobe::Refraction`] of
/// [`Bsdf::new`] as light that is aimed through glass sees it.
pub fn border(bsdf: &scene::Bsdf, at: &Inputs<'_>) -> Option<Border> {
    match bsdf {
        scene::Bsdf::Dielectric { eta, alpha, transmittance, .. } => {
            smooth_border(*eta, at.scalar(alpha), 1.0, || at.reflectance(transmittance), at)
        }
        scene::Bsdf::Principled(p) if p.solid && p.transmission.factor > 0.0 => {
            let clear = (1.0 - at.unit_scalar(&p.metallic)) * at.unit_scalar(&p.transmission);
            let part = clear * layers_over(p, at).passes(at.cos_o, at.cos_o);
            smooth_border(p.ior, at.unit_scalar(&p.roughness).powi(2), part, || at.reflectance(&p.base_color), at)
        }
        scene::Bsdf::Blend { first, second, weight } => {
            let weight = at.unit_scalar(weight);
            let scaled = |b: Border, part: f32| Border { transmitted: b.transmitted * part, reflected: b.reflected * part, ..b };
            match (border(first, at), border(second, at)) {
                (Some(a), None) => Some(scaled(a, 1.0 - weight)),
                (None, Some(b)) => Some(scaled(b, weight)),
                (Some(a), Some(b)) if a.eta == b.eta => Some(Border {
                    eta: a.eta,
                    transmitted: a.transmitted.lerp(b.transmitted, weight),
                    reflected: a.reflected + (b.reflected - a.reflected) * weight,
                }),
                _ => None,
            }
        }
        _ => None,
    }
}

/// The smooth border of a body of the index `ior` that is `part` of what is there.
fn smooth_border(ior: f32, alpha: f32, part: f32, tint: impl FnOnce() -> Rgb, at: &Inputs<'_>) -> Option<Border> {
    let Lobe::Refraction { facets, eta, .. } = glass(ior, alpha, Distribution::Ggx, Rgb::WHITE, at) else { return None };
    if !facets.smooth() {
        return None;
    }
    let (reflected, _) = fresnel::dielectric(at.cos_o, eta);
    Some(Border { eta, transmitted: tint() * (part * (1.0 - reflected)), reflected: part * reflected })
}

/// The layers over a principled material's lobes, as light that passes straight through meets them.
fn layers_over(p: &Principled, at: &Inputs<'_>) -> Layers {
    let sheen = at.reflectance(&p.sheen_color).max_component();
    let clearcoat = if at.outside { at.unit_scalar(&p.clearcoat) } else { 0.0 };
    Layers { clearcoat, sheen, sheen_roughness: at.scalar(&p.sheen_roughness).clamp(0.05, 1.0) }
}
