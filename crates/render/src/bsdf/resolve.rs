//! From a material of the scene, at one surface point, to its lobes.

use super::coat::CoatTable;
use super::{Bsdf, CAPACITY, CLEARCOAT_ETA, Entry, Fresnel, Layers, Lobe, fresnel, sheen_albedo, thin_reflectance};
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
    pub fn color(&self, p: &ColorParam) -> Rgb {
        p.texture.map_or(p.factor, |t| p.factor * self.images[t.image as usize].sample(&t, self.uv).0)
    }

    /// A colour parameter here, on [0,1].
    fn reflectance(&self, p: &ColorParam) -> Rgb {
        self.color(p).map(|v| v.clamp(0.0, 1.0))
    }

    /// A scalar parameter here.
    pub fn scalar(&self, p: &ScalarParam) -> f32 {
        p.texture.map_or(p.factor, |(t, channel)| {
            let (rgb, alpha) = self.images[t.image as usize].sample(&t, self.uv);
            p.factor * if channel == 3 { alpha } else { rgb[usize::from(channel)] }
        })
    }
}

impl<'a> Bsdf<'a> {
    /// The scattering of `material` at a point.
    pub fn new(material: &Material, at: &Inputs<'a>) -> Self {
        let mut bsdf = Self::black();
        match &material.bsdf {
            scene::Bsdf::Diffuse { reflectance } => {
                bsdf.reflectance = at.reflectance(reflectance);
                bsdf.add(Lobe::Diffuse { coat: None }, Rgb::BLACK, bsdf.reflectance.luminance());
            }
            scene::Bsdf::Conductor { eta, k, reflectance, alpha } => {
                let lobe = Lobe::Reflection { alpha: at.scalar(alpha), fresnel: Fresnel::Conductor { eta: *eta, k: *k } };
                let tint = at.reflectance(reflectance);
                bsdf.add(lobe, tint, tint.luminance());
            }
            scene::Bsdf::Dielectric { eta, alpha, transmittance, .. } => {
                let eta = if at.outside { *eta } else { 1.0 / *eta };
                bsdf.add(Lobe::Refraction { alpha: at.scalar(alpha), eta, tint: at.reflectance(transmittance) }, Rgb::WHITE, 1.0);
            }
            scene::Bsdf::ThinDielectric { eta, transmittance } => {
                bsdf.add(Lobe::Thin { eta: *eta, tint: at.reflectance(transmittance) }, Rgb::WHITE, 1.0);
            }
            scene::Bsdf::Plastic { diffuse, eta, alpha, specular, nonlinear } => {
                let base = at.reflectance(diffuse);
                let inner = if *nonlinear { base } else { Rgb::WHITE };
                bsdf.add_coated_diffuse(at, base, inner, at.scalar(alpha), 1.0);
                let tint = at.reflectance(specular);
                let f = fresnel::dielectric(at.cos_o, *eta).0;
                bsdf.add(
                    Lobe::Reflection { alpha: at.scalar(alpha), fresnel: Fresnel::Dielectric { eta: *eta } },
                    tint,
                    f * tint.luminance(),
                );
            }
            scene::Bsdf::Principled(p) => bsdf.add_principled(p, at),
        }
        bsdf.finish();
        bsdf
    }

    /// A diffuse base of colour `base` under the point's coat; `share` of the surface is so.
    fn add_coated_diffuse(&mut self, at: &Inputs<'a>, base: Rgb, inner: Rgb, alpha: f32, share: f32) {
        self.reflectance = base * share;
        let through = at.coat.map_or(1.0, |table| table.transmittance(at.cos_o, alpha));
        let coat = at.coat.map(|table| (table, alpha, inner));
        self.add(Lobe::Diffuse { coat }, Rgb::BLACK, self.reflectance.luminance() * through);
    }

    /// glTF's metallic-roughness model: a metal, a transparent body and a coated diffuse base in their shares, under sheen and
    /// clear-coat.
    fn add_principled(&mut self, p: &Principled, at: &Inputs<'a>) {
        let base = at.reflectance(&p.base_color);
        let metallic = at.scalar(&p.metallic).clamp(0.0, 1.0);
        let transmission = at.scalar(&p.transmission).clamp(0.0, 1.0);
        let alpha = at.scalar(&p.roughness).clamp(0.0, 1.0).powi(2);
        let (glass, solid) = ((1.0 - metallic) * transmission, (1.0 - metallic) * (1.0 - transmission));

        if solid > 0.0 {
            self.add_coated_diffuse(at, base, Rgb::WHITE, alpha, solid);
            // Fresnel's equations instead of glTF's Schlick, so that coat and base share out exactly all light; the specular
            // colour tints at every angle.
            let tint = at.reflectance(&p.specular_color) * at.scalar(&p.specular).clamp(0.0, 1.0);
            let f = fresnel::dielectric(at.cos_o, p.ior).0;
            let lobe = Lobe::Reflection { alpha, fresnel: Fresnel::Dielectric { eta: p.ior } };
            self.add(lobe, tint * solid, solid * f * tint.luminance());
        }
        if metallic > 0.0 {
            let fresnel = Fresnel::Schlick { f0: base, f90: Rgb::WHITE };
            self.add(Lobe::Reflection { alpha, fresnel }, Rgb::splat(metallic), metallic * fresnel.eval(at.cos_o).luminance());
        }
        if glass > 0.0 {
            let lobe = if p.solid {
                Lobe::Refraction { alpha, eta: if at.outside { p.ior } else { 1.0 / p.ior }, tint: base }
            } else {
                Lobe::Thin { eta: p.ior, tint: base }
            };
            self.add(lobe, Rgb::splat(glass), glass);
        }

        let sheen_color = at.reflectance(&p.sheen_color);
        let clearcoat = if at.outside { at.scalar(&p.clearcoat).clamp(0.0, 1.0) } else { 0.0 };
        if clearcoat == 0.0 && sheen_color.is_black() {
            return;
        }
        let sheen_roughness = at.scalar(&p.sheen_roughness).clamp(0.05, 1.0);
        self.layers = Some(Layers { clearcoat, sheen: sheen_color.max_component(), sheen_roughness });
        if !sheen_color.is_black() {
            // Near the horizon the fitted lobe reflects more than it receives; it is scaled down to all of it.
            let excess = sheen_albedo(at.cos_o, sheen_roughness).max(1.0);
            let dimmed = (1.0 - clearcoat * fresnel::dielectric(at.cos_o, CLEARCOAT_ETA).0) / excess;
            self.add_on_top(Lobe::Sheen { roughness: sheen_roughness }, sheen_color * dimmed, 0.3 * sheen_color.luminance());
        }
        if clearcoat > 0.0 {
            let alpha = at.scalar(&p.clearcoat_roughness).clamp(0.0, 1.0).powi(2);
            let f = fresnel::dielectric(at.cos_o, CLEARCOAT_ETA).0;
            let lobe = Lobe::Reflection { alpha, fresnel: Fresnel::Dielectric { eta: CLEARCOAT_ETA } };
            self.add_on_top(lobe, Rgb::splat(clearcoat), clearcoat * f);
        }
    }

    fn add_on_top(&mut self, lobe: Lobe<'a>, scale: Rgb, importance: f32) {
        if importance > 0.0 && self.count < CAPACITY {
            self.entries[self.count] = Entry { lobe, scale, select: importance, on_top: true };
            self.count += 1;
        }
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
            let glass = (1.0 - at.scalar(&p.metallic).clamp(0.0, 1.0)) * at.scalar(&p.transmission).clamp(0.0, 1.0);
            let mut through = at.reflectance(&p.base_color) * (glass * (1.0 - thin_reflectance(at.cos_o, p.ior)));
            let bsdf = Bsdf::new(material, at);
            if let Some(layers) = bsdf.layers {
                let wo = enfilade_math::Vec3::new(0.0, 0.0, at.cos_o);
                through *= layers.dimming(wo, -wo);
            }
            Some(through)
        }
        _ => None,
    }
}
