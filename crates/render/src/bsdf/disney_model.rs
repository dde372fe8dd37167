//! Disney's model as Mitsuba 3 has it in `principled` and `principledthin`: from its parameters at a point to the mixture of its lobes.
//!
//! The model does not conserve energy: lobes are added to each other, only single bounces between facets count, and masking is
//! separable. What glTF's model shares with it ([`super::resolve`]) is named alike and means something else.

use super::disney::Part;
use super::ggx::Facets;
use super::mixture::Mixture;
use super::{Bsdf, Fresnel, Inputs, Lobe, Model, fresnel};
use enfilade_math::Rgb;
use enfilade_scene as scene;

/// Mitsuba's facets are no smoother; ours are smooth below.
const MIN_ALPHA: f32 = 1e-3;

/// Smooth facets or ones of this alpha, with Mitsuba's least.
fn facets(alpha: f32, cos_o: f32) -> Facets {
    Facets::separable(if alpha < MIN_ALPHA { 0.0 } else { alpha }, cos_o)
}

/// Values of the parameters at a point.
struct Point {
    base: Rgb,
    roughness: f32,
    metallic: f32,
    through: f32,
    spec_tint: f32,
    /// The base's colour at a luminance of one.
    hue: Rgb,
    sheen: Rgb,
    eta: f32,
}

impl Point {
    fn new(p: &scene::Disney, at: &Inputs<'_>) -> Self {
        let base = at.reflectance(&p.base_color);
        let luminance = base.luminance();
        let hue = if luminance > 0.0 { base * (1.0 / luminance) } else { Rgb::WHITE };
        let sheen = Rgb::WHITE.lerp(hue, at.unit_scalar(&p.sheen_tint)) * at.scalar(&p.sheen).max(0.0);
        Self {
            base,
            roughness: at.unit_scalar(&p.roughness),
            metallic: if p.thin { 0.0 } else { at.unit_scalar(&p.metallic) },
            through: at.unit_scalar(&p.spec_trans),
            spec_tint: at.unit_scalar(&p.spec_tint),
            hue,
            sheen,
            eta: p.eta,
        }
    }

    /// The main reflection's: Fresnel's equations for what is neither metal nor tinted, Schlick's curve for the rest.
    fn fresnel<'a>(&self) -> Fresnel<'a> {
        let (metal, tinted) = (self.metallic, (1.0 - self.metallic) * self.spec_tint);
        let normal = self.hue * ((self.eta - 1.0) / (self.eta + 1.0)).powi(2);
        Fresnel::Disney {
            dielectric: (1.0 - self.metallic) * (1.0 - self.spec_tint),
            eta: self.eta,
            f0: self.base * metal + normal * tinted,
            f90: metal + tinted,
        }
    }
}

/// Scattering by the whole model at a point.
pub fn disney<'a>(p: &scene::Disney, at: &Inputs<'a>) -> Bsdf<'a> {
    let here = Point::new(p, at);
    let mut mixture = Mixture::new();
    let reflectance = if p.thin {
        sheet(&mut mixture, p, &here, at)
    } else if at.outside || p.spec_trans.factor == 0.0 {
        body(&mut mixture, p, &here, at)
    } else {
        let alpha = here.roughness * here.roughness;
        let tint = here.base.map(f32::sqrt);
        let weight = (1.0 - here.metallic) * here.through;
        let lobe = Lobe::Refraction { facets: facets(alpha, at.cos_o), eta: 1.0 / here.eta, tint, scale: 1.0 };
        mixture.add(lobe, Rgb::BLACK, weight, weight);
        Rgb::BLACK
    };
    mixture.finish();
    let model = if mixture.is_empty() { Model::Black } else { Model::Mixture(mixture) };
    Bsdf { reflectance, model }
}

/// The base with its fuzz, as the given `fraction` of all; returns the diffuse reflectance.
fn base(mixture: &mut Mixture<'_>, p: &scene::Disney, here: &Point, fraction: f32, fuzz: f32, at: &Inputs<'_>) -> Rgb {
    let reflectance = here.base * fraction;
    if fraction <= 0.0 {
        return Rgb::BLACK;
    }
    let lobe = Lobe::Disney(Part::Diffuse { roughness: here.roughness, flatness: at.unit_scalar(&p.flatness) });
    mixture.add(lobe, Rgb::WHITE, 1.0, reflectance.luminance());
    let sheen = Part::Sheen { color: here.sheen };
    mixture.add(Lobe::Disney(sheen), Rgb::BLACK, fuzz, fuzz * sheen.albedo(at.cos_o).specular.luminance());
    reflectance
}

/// A solid body from outside.
fn body(mixture: &mut Mixture<'_>, p: &scene::Disney, here: &Point, at: &Inputs<'_>) -> Rgb {
    let alpha = here.roughness * here.roughness;
    let clear = (1.0 - here.metallic) * here.through;
    let fraction = (1.0 - here.metallic) * (1.0 - here.through);
    let reflectance = base(mixture, p, here, fraction, 1.0 - here.metallic, at);
    let facets = facets(alpha, at.cos_o);
    // Mitsuba reflects nothing at all where the index is one, not even metals.
    if here.eta != 1.0 {
        let fresnel = here.fresnel();
        mixture.add(Lobe::Reflection { facets, fresnel, tint: Rgb::WHITE }, Rgb::BLACK, 1.0, fresnel.eval(at.cos_o).luminance());
    }
    let coat = 0.25 * at.unit_scalar(&p.clearcoat);
    let coat_alpha = 0.1 + (0.001 - 0.1) * at.unit_scalar(&p.clearcoat_gloss);
    mixture.add(Lobe::Disney(Part::Coat { alpha: coat_alpha }), Rgb::BLACK, coat, 0.5 * coat);
    let through = Part::Through { facets, eta: here.eta, tint: here.base.map(f32::sqrt) };
    mixture.add(Lobe::Disney(through), Rgb::BLACK, clear, clear * through.albedo(at.cos_o).specular.luminance());
    reflectance
}

/// A sheet without thickness, from either side.
fn sheet(mixture: &mut Mixture<'_>, p: &scene::Disney, here: &Point, at: &Inputs<'_>) -> Rgb {
    let behind = 0.5 * at.scalar(&p.diff_trans).clamp(0.0, 2.0);
    let (clear, dull) = (here.through, 1.0 - here.through);
    let reflectance = base(mixture, p, here, dull * (1.0 - behind), dull * (1.0 - behind), at);
    let alpha = |roughness: f32| roughness * roughness;
    let (outer, fresnel) = (facets(alpha(here.roughness), at.cos_o), here.fresnel());
    let reflection = Lobe::Reflection { facets: outer, fresnel, tint: Rgb::WHITE };
    mixture.add(reflection, Rgb::BLACK, clear, clear * fresnel.eval(at.cos_o).luminance());
    // Burley 2015, figure 15.
    let inner = facets(alpha((0.65 * here.eta - 0.35) * here.roughness), at.cos_o);
    let through = Part::Sheet { facets: inner, eta: here.eta, tint: here.base };
    mixture.add(Lobe::Disney(through), Rgb::BLACK, clear, clear * through.albedo(at.cos_o).specular.luminance());
    let diffuse = here.base * (dull * behind);
    mixture.add(Lobe::Disney(Part::Translucent { color: diffuse }), Rgb::BLACK, 1.0, diffuse.luminance());
    reflectance
}

/// Fraction of light that passes straight through a smooth sheet at a point.
pub fn straight_transmittance(p: &scene::Disney, at: &Inputs<'_>) -> Rgb {
    let here = Point::new(p, at);
    here.base * (here.through * (1.0 - fresnel::dielectric(at.cos_o, here.eta).0))
}
