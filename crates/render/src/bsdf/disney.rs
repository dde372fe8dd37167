//! The lobes of Disney's model that others do not have, as Mitsuba 3 has them in `principled` and `principledthin`.
//!
//! Burley 2012, "Physically Based Shading at Disney", and 2015, "Extending the Disney BRDF to a BSDF". Which lobes a material has is said
//! in [`super::disney_model`].

use super::fresnel;
use super::ggx::{self, Facets};
use super::sample::{Event, Sample, Value};
use enfilade_math::{INV_PI, Rgb, Vec3, angle, warp};
use std::f32::consts::PI;

/// The roughness of the clear-coat's masking.
const COAT_MASKING: f32 = 0.25;

/// A lobe that only this model has.
#[derive(Clone, Copy, Debug)]
pub enum Part {
    /// The diffuse base with its retro-reflection, demodulated.
    Diffuse {
        /// Roughness of the base.
        roughness: f32,
        /// How much of it is flattened like skin, by Hanrahan and Krueger.
        flatness: f32,
    },
    /// Fuzz.
    Sheen {
        /// Multiplies it.
        color: Rgb,
    },
    /// The clear-coat, by the distribution GTR1, over its strength.
    Coat {
        /// Roughness.
        alpha: f32,
    },
    /// Refraction, without the corresponding reflection.
    Through {
        /// The surface.
        facets: Facets,
        /// Index beyond the surface over the index on the side of `wo`.
        eta: f32,
        /// Multiplies it.
        tint: Rgb,
    },
    /// Light that a rough sheet scatters in transmission: reflection, turned to the other side.
    Sheet {
        /// The surface.
        facets: Facets,
        /// Index of refraction.
        eta: f32,
        /// Multiplies it.
        tint: Rgb,
    },
    /// Diffuse light on the other side.
    Translucent {
        /// Fraction of light.
        color: Rgb,
    },
}

const NOTHING: (Value, f32) = (Value { diffuse: Rgb::BLACK, specular: Rgb::BLACK }, 0.0);

impl Part {
    /// See [`super::Lobe::eval_pdf`].
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Value, f32) {
        let specular = |specular: Rgb| Value { diffuse: Rgb::BLACK, specular };
        let above = wi.z > 0.0;
        match *self {
            Self::Diffuse { roughness, flatness } if above => {
                let value = diffuse(wo, wi, roughness, flatness) * wi.z * INV_PI;
                (Value { diffuse: Rgb::splat(value), specular: Rgb::BLACK }, wi.z * INV_PI)
            }
            Self::Sheen { color } if above => {
                let halfway = (wo + wi).normalize();
                (specular(color * (schlick(wi.dot(halfway)) * wi.z)), wi.z * INV_PI)
            }
            Self::Coat { alpha } if above => {
                let m = (wo + wi).normalize();
                let (cos, d) = (wo.dot(m), gtr1(m, alpha));
                let masking = ggx::g1(wo, COAT_MASKING) * ggx::g1(wi, COAT_MASKING);
                (specular(Rgb::splat((0.04 + 0.96 * schlick(cos)) * d * masking * wi.z)), d * m.z / (4.0 * cos))
            }
            Self::Through { facets, eta, tint } if !facets.smooth() && wi.z < 0.0 => {
                let Some((m, f, jacobian)) = ggx::refraction_half_vector(wo, wi, eta) else { return NOTHING };
                let common = ggx::d(m, facets.alpha) * jacobian * wo.dot(m) / wo.z;
                (specular(tint * ((1.0 - f) * facets.masking(wo, wi) * common / (eta * eta))), ggx::g1(wo, facets.alpha) * common)
            }
            Self::Sheet { facets, eta, tint } if !facets.smooth() && wi.z < 0.0 => {
                let turned = Vec3::new(wi.x, wi.y, -wi.z);
                let m = (wo + turned).normalize();
                if wi.dot(m) >= 0.0 {
                    return NOTHING;
                }
                let mirrored = facets.mirror(wo, turned);
                (specular(tint * ((1.0 - fresnel::dielectric(mirrored.cos_half, eta).0) * mirrored.value)), mirrored.pdf)
            }
            Self::Translucent { color } if wi.z < 0.0 => (specular(color * (-wi.z * INV_PI)), -wi.z * INV_PI),
            _ => NOTHING,
        }
    }

    /// The direction that is tried, or the whole sample where it is one of finitely many; `None` where there is none. `u` is uniform on
    /// [0,1)².
    pub fn sample(&self, wo: Vec3, u: [f32; 2]) -> Option<Result<Vec3, Sample>> {
        match *self {
            Self::Diffuse { .. } | Self::Sheen { .. } => Some(Ok(warp::cosine_hemisphere(u))),
            Self::Translucent { .. } => Some(Ok(-warp::cosine_hemisphere(u))),
            Self::Coat { alpha } => Some(Ok(ggx::reflect(wo, sample_gtr1(alpha, u)))),
            Self::Through { facets, eta, tint } => {
                let m = if facets.smooth() { Vec3::Z } else { ggx::sample_visible(wo, facets.alpha, u) };
                let (f, cos_t) = fresnel::dielectric(wo.dot(m).clamp(0.0, 1.0), eta);
                let wi = (cos_t > 0.0).then(|| ggx::refract(wo, m, eta, cos_t).normalize())?;
                Some(if facets.smooth() { Err(Sample::delta(wi, tint * ((1.0 - f) / (eta * eta)))) } else { Ok(wi) })
            }
            Self::Sheet { facets, eta, tint } if facets.smooth() => {
                let passed = tint * (1.0 - fresnel::dielectric(wo.z, eta).0);
                Some(Err(Sample { event: Event::Straight, ..Sample::delta(-wo, passed) }))
            }
            Self::Sheet { facets, .. } => {
                let mirrored = facets.sample(wo, u);
                Some(Ok(Vec3::new(mirrored.x, mirrored.y, -mirrored.z)))
            }
        }
    }

    /// See [`super::Lobe::albedo`].
    pub fn albedo(&self, cos_o: f32) -> Value {
        let specular = |specular: Rgb| Value { diffuse: Rgb::BLACK, specular };
        match *self {
            Self::Diffuse { .. } => Value { diffuse: Rgb::WHITE, specular: Rgb::BLACK },
            Self::Sheen { color } => specular(color * (0.05 + 0.5 * schlick(cos_o))),
            Self::Coat { .. } => specular(Rgb::splat(4.0 * (0.04 + 0.96 * schlick(cos_o)))),
            Self::Through { eta, tint, .. } | Self::Sheet { eta, tint, .. } => specular(tint * (1.0 - fresnel::dielectric(cos_o, eta).0)),
            Self::Translucent { color } => specular(color),
        }
    }

    /// Roughness (alpha) of the interface, for lobes that may be sharp.
    pub fn alpha(&self) -> Option<f32> {
        match *self {
            Self::Diffuse { .. } | Self::Sheen { .. } | Self::Translucent { .. } => None,
            Self::Coat { alpha } => Some(alpha),
            Self::Through { facets, .. } | Self::Sheet { facets, .. } => Some(facets.alpha),
        }
    }
}

/// (1 − cos)⁵.
#[inline]
fn schlick(cos: f32) -> f32 {
    (1.0 - cos.abs()).clamp(0.0, 1.0).powi(5)
}

/// The base's value times π for a reflectance of one.
fn diffuse(wo: Vec3, wi: Vec3, roughness: f32, flatness: f32) -> f32 {
    let (o, i) = (schlick(wi.z), schlick(wo.z));
    let cos = wi.dot((wo + wi).normalize());
    let retro = 2.0 * roughness * cos * cos;
    let plain = (1.0 - 0.5 * i) * (1.0 - 0.5 * o) + retro * (o + i + o * i * (retro - 1.0));
    if flatness == 0.0 {
        return plain;
    }
    let edge = |f: f32| 1.0 + (0.5 * retro - 1.0) * f;
    let flat = 1.25 * (edge(o) * edge(i) * (1.0 / (wo.z + wi.z) - 0.5) + 0.5);
    plain + (flat - plain) * flatness
}

/// Burley 2012, equation 4 with γ = 1.
#[inline]
fn gtr1(m: Vec3, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    (a2 - 1.0) / (PI * a2.ln() * (1.0 + (a2 - 1.0) * m.z * m.z))
}

/// A normal in proportion to [`gtr1`] × cosine.
fn sample_gtr1(alpha: f32, u: [f32; 2]) -> Vec3 {
    let a2 = alpha * alpha;
    let cos2 = ((1.0 - a2.powf(1.0 - u[1])) / (1.0 - a2)).clamp(0.0, 1.0);
    let ((sin_phi, cos_phi), sin) = (angle::sin_cos_turns(u[0]), (1.0 - cos2).sqrt());
    Vec3::new(sin * cos_phi, sin * sin_phi, cos2.sqrt())
}
