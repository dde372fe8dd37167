//! The elementary ways of scattering. A [`super::Bsdf`] is one of these, or a mixture.
//!
//! All directions are unit vectors in shading space (z = shading normal, facing `wo`, so `wo.z` > 0) and point away from the
//! surface; `wi.z` < 0 is transmission. Values include the cosine |wi.z|; densities are per solid angle of `wi`. A lobe is made
//! for one viewing direction and only meaningful for that.

use super::coated::Coated;
use super::disney;
use super::fresnel;
use super::ggx::{self, Facets};
use super::rough_diffuse::RoughDiffuse;
use super::sample::{Event, Sample, Value};
use super::sheen::Sheen;
use enfilade_math::{INV_PI, Rgb, Vec3, warp};

/// Fresnel term of a reflecting lobe.
#[derive(Clone, Copy, Debug)]
pub enum Fresnel<'a> {
    /// Dielectric seen from outside.
    Dielectric {
        /// Index of refraction.
        eta: f32,
    },
    /// Metal by its complex index.
    Conductor {
        /// Real part.
        eta: &'a Rgb,
        /// Imaginary part.
        k: &'a Rgb,
    },
    /// Schlick's approximation, white at grazing incidence.
    Schlick {
        /// At normal incidence.
        f0: Rgb,
    },
    /// A part of a dielectric's and Schlick's approximation, added.
    Disney {
        /// Weight of the dielectric.
        dielectric: f32,
        /// Index of refraction.
        eta: f32,
        /// Schlick's part at normal incidence.
        f0: Rgb,
        /// Schlick's part at grazing incidence.
        f90: f32,
    },
}

impl Fresnel<'_> {
    /// Reflectance at the cosine `cos_i` ≥ 0.
    #[inline]
    pub fn eval(&self, cos_i: f32) -> Rgb {
        match *self {
            Self::Dielectric { eta } => Rgb::splat(fresnel::dielectric(cos_i, eta).0),
            Self::Conductor { eta, k } => fresnel::conductor(cos_i, *eta, *k),
            Self::Schlick { f0 } => fresnel::schlick(cos_i, f0, Rgb::WHITE),
            Self::Disney { dielectric, eta, f0, f90 } => {
                let (exact, cos_t) = fresnel::dielectric(cos_i, eta);
                let cos = if eta > 1.0 { cos_i } else { cos_t };
                Rgb::splat(dielectric * exact) + fresnel::schlick(cos, f0, Rgb::splat(f90))
            }
        }
    }
}

/// One way of scattering, or two that always go together.
#[derive(Clone, Copy, Debug)]
pub enum Lobe<'a> {
    /// Lambert's law, demodulated: the value for a reflectance of one.
    Lambert,
    /// Diffuse reflection of a rough surface, demodulated.
    RoughDiffuse(RoughDiffuse),
    /// A diffuse base under a dielectric coat, and the coat's own reflection.
    Coated(Coated<'a>),
    /// Reflection at a rough or smooth interface.
    Reflection {
        /// The surface.
        facets: Facets,
        /// Reflectance.
        fresnel: Fresnel<'a>,
        /// Multiplies it.
        tint: Rgb,
    },
    /// Reflection and refraction at the border of a transparent body.
    Refraction {
        /// The surface.
        facets: Facets,
        /// Index beyond the surface over the index on the side of `wo`.
        eta: f32,
        /// Multiplies transmitted light.
        tint: Rgb,
        /// Multiplies all light: what further bounces between the facets add.
        scale: f32,
    },
    /// A thin pane: reflection and straight transmission, or, where it is rough, what would be reflected on its other side:
    /// KHR_materials_transmission, whose microfacets transmit in the directions that they mirror, turned through the surface.
    Thin {
        /// The surface.
        facets: Facets,
        /// Index of refraction.
        eta: f32,
        /// Multiplies transmitted light.
        tint: Rgb,
        /// Multiplies all light: what further bounces between the facets add.
        scale: f32,
    },
    /// Fuzz of cloth.
    Sheen(Sheen),
    /// A lobe of Disney's model.
    Disney(disney::Part),
}

impl<'a> Lobe<'a> {
    /// Value × cosine and density with which [`Lobe::sample`] finds `wi`; smooth lobes have neither.
    #[inline]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Value, f32) {
        match self {
            Self::Lambert => {
                let v = wi.z.max(0.0) * INV_PI;
                (Value { diffuse: Rgb::splat(v), specular: Rgb::BLACK }, v)
            }
            Self::RoughDiffuse(rough) => {
                if wi.z <= 0.0 {
                    return NOTHING;
                }
                (Value { diffuse: rough.eval(wo, wi), specular: Rgb::BLACK }, wi.z * INV_PI)
            }
            Self::Coated(coated) => coated.eval_pdf(wo, wi),
            Self::Reflection { facets, fresnel, tint } => {
                if facets.smooth() || wi.z <= 0.0 {
                    return NOTHING;
                }
                let mirrored = facets.mirror(wo, wi);
                (specular(*tint * fresnel.eval(mirrored.cos_half) * mirrored.value), mirrored.pdf)
            }
            Self::Refraction { facets, eta, tint, scale } => {
                let (value, density) = refraction(facets, *eta, *tint, wo, wi);
                (value * *scale, density)
            }
            Self::Thin { facets, eta, tint, scale } => {
                if facets.smooth() || wi.z == 0.0 {
                    return NOTHING;
                }
                let mirrored = facets.mirror(wo, Vec3::new(wi.x, wi.y, wi.z.abs()));
                let r = thin_reflectance(mirrored.cos_half, *eta);
                let (part, tint) = if wi.z > 0.0 { (r, Rgb::WHITE) } else { (1.0 - r, *tint) };
                (specular(tint * (part * scale * mirrored.value)), part * mirrored.pdf)
            }
            Self::Sheen(sheen) => {
                if wi.z <= 0.0 {
                    return NOTHING;
                }
                (specular(sheen.eval(wo, wi)), wi.z * INV_PI)
            }
            Self::Disney(part) => part.eval_pdf(wo, wi),
        }
    }

    /// Samples an incident direction. `u` is uniform on [0,1)³. `None` when the direction falls on the wrong side.
    #[inline]
    pub fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        match self {
            Self::Lambert => {
                let wi = warp::cosine_hemisphere([u[0], u[1]]);
                let weight = Value { diffuse: Rgb::WHITE, specular: Rgb::BLACK };
                (wi.z > 0.0).then_some(Sample { wi, weight, pdf: wi.z * INV_PI, event: Event::Finite })
            }
            Self::Coated(coated) => coated.sample(wo, u),
            Self::Reflection { facets, fresnel, tint } => {
                if facets.smooth() {
                    return Some(Sample::mirrored(wo, *tint * fresnel.eval(wo.z)));
                }
                self.finite(wo, facets.sample(wo, [u[0], u[1]]))
            }
            Self::Refraction { facets, eta, tint, .. } => self.sample_refraction(facets, *eta, *tint, wo, u),
            Self::Thin { facets, eta, .. } if !facets.smooth() => {
                let up = Some(facets.sample(wo, [u[0], u[1]])).filter(|up| up.z > 0.0)?;
                let r = thin_reflectance((0.5 * (wo + up).length()).min(1.0), *eta);
                self.finite(wo, if u[2] < r { up } else { Vec3::new(up.x, up.y, -up.z) })
            }
            Self::Thin { eta, tint, .. } => {
                let r = thin_reflectance(wo.z, *eta);
                if u[2] < r {
                    return Some(Sample::mirrored(wo, Rgb::WHITE));
                }
                Some(Sample { event: Event::Straight, ..Sample::delta(-wo, *tint) })
            }
            Self::Disney(part) => match part.sample(wo, [u[0], u[1]])? {
                Ok(wi) => self.finite(wo, wi),
                Err(sample) => Some(sample),
            },
            Self::RoughDiffuse(_) | Self::Sheen(_) => self.finite(wo, warp::cosine_hemisphere([u[0], u[1]])),
        }
    }

    /// The sample of a direction that came from the lobe's density.
    #[inline]
    fn finite(&self, wo: Vec3, wi: Vec3) -> Option<Sample> {
        let (value, pdf) = self.eval_pdf(wo, wi);
        (pdf > 0.0).then(|| Sample { wi, weight: value * (1.0 / pdf), pdf, event: Event::Finite })
    }

    fn sample_refraction(&self, facets: &Facets, eta: f32, tint: Rgb, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        let m = if facets.smooth() { Vec3::Z } else { ggx::sample_visible(wo, facets.alpha, [u[0], u[1]]) };
        let cos = wo.dot(m);
        let (f, cos_t) = fresnel::dielectric(cos.max(0.0), eta);
        let reflects = u[2] < f;
        let wi = if reflects { ggx::reflect(wo, m) } else { ggx::refract(wo, m, eta, cos_t).normalize() };
        if facets.smooth() {
            let weight = if reflects { Rgb::WHITE } else { tint * (1.0 / (eta * eta)) };
            return Some(Sample::delta(wi, weight));
        }
        if reflects == (wi.z > 0.0) { self.finite(wo, wi) } else { None }
    }

    /// Approximate fraction of light from all directions that is scattered to `wo`: the diffuse part for a reflectance of one, and
    /// everything else.
    pub fn albedo(&self, cos_o: f32) -> Value {
        match self {
            Self::Lambert => Value { diffuse: Rgb::WHITE, specular: Rgb::BLACK },
            Self::RoughDiffuse(rough) => Value { diffuse: rough.albedo, specular: Rgb::BLACK },
            Self::Coated(coated) => coated.albedo(cos_o),
            Self::Reflection { fresnel, tint, .. } => specular(*tint * fresnel.eval(cos_o)),
            Self::Refraction { eta, tint, .. } => {
                let f = fresnel::dielectric(cos_o, *eta).0;
                specular(Rgb::splat(f) + *tint * (1.0 - f))
            }
            Self::Thin { eta, tint, .. } => {
                let r = thin_reflectance(cos_o, *eta);
                specular(Rgb::splat(r) + *tint * (1.0 - r))
            }
            Self::Sheen(sheen) => specular(sheen.albedo(cos_o)),
            Self::Disney(part) => part.albedo(cos_o),
        }
    }

    /// True when everything of the lobe but its diffuse part is nearly as blurred as that.
    pub fn is_rough(&self) -> bool {
        match self {
            Self::Lambert | Self::RoughDiffuse(_) | Self::Sheen(_) => true,
            Self::Coated(coated) => coated.facets.alpha >= ROUGH_ALPHA,
            Self::Reflection { facets, .. } | Self::Refraction { facets, .. } | Self::Thin { facets, .. } => facets.alpha >= ROUGH_ALPHA,
            Self::Disney(part) => part.alpha().is_none_or(|alpha| alpha >= ROUGH_ALPHA),
        }
    }
}

/// From this roughness on a reflection counts as blurred: half of it spreads over a cone of 60 degrees and more.
const ROUGH_ALPHA: f32 = 0.5;

const NOTHING: (Value, f32) = (Value { diffuse: Rgb::BLACK, specular: Rgb::BLACK }, 0.0);

#[inline]
fn specular(specular: Rgb) -> Value {
    Value { diffuse: Rgb::BLACK, specular }
}

/// Reflectance of a pane with all its inner reflections, without absorption.
#[inline]
pub fn thin_reflectance(cos: f32, eta: f32) -> f32 {
    let r = fresnel::dielectric(cos, eta).0;
    2.0 * r / (1.0 + r)
}

/// Value and density of [`Lobe::Refraction`].
fn refraction(facets: &Facets, eta: f32, tint: Rgb, wo: Vec3, wi: Vec3) -> (Value, f32) {
    if facets.smooth() || wi.z == 0.0 {
        return NOTHING;
    }
    let Some((m, f, jacobian)) = ggx::refraction_half_vector(wo, wi, eta) else { return NOTHING };
    let common = |d: f32| d * jacobian * wo.dot(m).max(0.0) / wo.z;
    let sampled = common(ggx::d(m, facets.alpha));
    let value = facets.masking(wo, wi) * if facets.is_ggx() { sampled } else { common(facets.d(m)) };
    let density = ggx::g1(wo, facets.alpha) * sampled;
    if wi.z > 0.0 {
        (specular(Rgb::splat(f * value)), f * density)
    } else {
        // Radiance is compressed by eta² on entering the denser side.
        (specular(tint * ((1.0 - f) * value / (eta * eta))), (1.0 - f) * density)
    }
}
