//! The elementary ways of scattering. A [`super::Bsdf`] is a weighted sum of these.
//!
//! All directions are unit vectors in shading space (z = shading normal, facing `wo`, so `wo.z` > 0) and point away from the
//! surface; `wi.z` < 0 is transmission. Values include the cosine |wi.z|; densities are per solid angle of `wi`.

use super::coat::CoatTable;
use super::{fresnel, ggx};
use enfilade_math::{INV_PI, Rgb, Vec3, warp};

/// Fresnel term of a reflecting lobe.
#[derive(Clone, Copy, Debug)]
pub enum Fresnel {
    /// Dielectric seen from outside.
    Dielectric {
        /// Index of refraction.
        eta: f32,
    },
    /// Metal by its complex index.
    Conductor {
        /// Real part.
        eta: Rgb,
        /// Imaginary part.
        k: Rgb,
    },
    /// Schlick's approximation.
    Schlick {
        /// At normal incidence.
        f0: Rgb,
        /// At grazing incidence.
        f90: Rgb,
    },
}

impl Fresnel {
    /// Reflectance at the cosine `cos_i` ≥ 0.
    #[inline]
    pub fn eval(&self, cos_i: f32) -> Rgb {
        match *self {
            Self::Dielectric { eta } => Rgb::splat(fresnel::dielectric(cos_i, eta).0),
            Self::Conductor { eta, k } => fresnel::conductor(cos_i, eta, k),
            Self::Schlick { f0, f90 } => fresnel::schlick(cos_i, f0, f90),
        }
    }
}

/// One way of scattering.
#[derive(Clone, Copy, Debug)]
pub enum Lobe<'a> {
    /// Lambert's law, demodulated: the value for a reflectance of one. With a coat, light passes it on the way in and out.
    Diffuse {
        /// The coat above, its roughness, and the base colour whose inner reflections it multiplies (white: none).
        coat: Option<(&'a CoatTable, f32, Rgb)>,
    },
    /// Reflection at a rough or smooth interface.
    Reflection {
        /// GGX roughness.
        alpha: f32,
        /// Reflectance.
        fresnel: Fresnel,
    },
    /// Reflection and refraction at the border of a transparent body.
    Refraction {
        /// GGX roughness.
        alpha: f32,
        /// Index beyond the surface over the index on the side of `wo`.
        eta: f32,
        /// Multiplies transmitted light.
        tint: Rgb,
    },
    /// A thin pane: mirror reflection and straight transmission.
    Thin {
        /// Index of refraction.
        eta: f32,
        /// Multiplies transmitted light.
        tint: Rgb,
    },
    /// Retro-reflecting fuzz of cloth. Estevez & Kulla 2017, "Production Friendly Microfacet Sheen BRDF".
    Sheen {
        /// Perceptual roughness on (0,1].
        roughness: f32,
    },
}

/// How a sampled direction came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// From a density over directions.
    Finite,
    /// One of finitely many directions: light sampling cannot find it.
    Delta,
    /// Straight on through a thin pane: shadow rays take this way too.
    Straight,
}

/// A sampled direction.
#[derive(Clone, Copy, Debug)]
pub struct LobeSample {
    /// Incident direction.
    pub wi: Vec3,
    /// Value (with cosine) over probability, for [`Event::Delta`] and [`Event::Straight`] only.
    pub delta_weight: Rgb,
    /// What kind of direction it is.
    pub event: Event,
}

impl Lobe<'_> {
    /// Value × cosine; zero for smooth lobes.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        match *self {
            Self::Diffuse { coat } => {
                if wi.z <= 0.0 {
                    return Rgb::BLACK;
                }
                let lambert = Rgb::splat(wi.z * INV_PI);
                let Some((table, alpha, base)) = coat else { return lambert };
                let through = table.transmittance(wo.z, alpha) * table.transmittance(wi.z, alpha) / (table.eta * table.eta);
                let inner = table.inner_reflectance(alpha);
                lambert * base.map(|b| through / (1.0 - b * inner))
            }
            Self::Reflection { alpha, fresnel } => {
                if alpha < ggx::SMOOTH_ALPHA || wi.z <= 0.0 {
                    return Rgb::BLACK;
                }
                let m = (wo + wi).normalize();
                fresnel.eval(wo.dot(m).clamp(0.0, 1.0)) * (ggx::d(m, alpha) * ggx::g2(wo, wi, alpha) / (4.0 * wo.z))
            }
            Self::Refraction { alpha, eta, tint } => {
                if alpha < ggx::SMOOTH_ALPHA || wi.z == 0.0 {
                    return Rgb::BLACK;
                }
                let Some((m, f, jacobian)) = refraction_half_vector(wo, wi, eta) else { return Rgb::BLACK };
                let common = ggx::d(m, alpha) * ggx::g2(wo, wi, alpha) * wo.dot(m) / wo.z;
                if wi.z > 0.0 {
                    Rgb::splat(f * common * jacobian)
                } else {
                    // Radiance is compressed by eta² on entering the denser side.
                    tint * ((1.0 - f) * common * jacobian / (eta * eta))
                }
            }
            Self::Thin { .. } => Rgb::BLACK,
            Self::Sheen { roughness } => {
                if wi.z <= 0.0 {
                    return Rgb::BLACK;
                }
                let m = (wo + wi).normalize();
                Rgb::splat(charlie(m, roughness) / (4.0 * (wo.z + wi.z - wo.z * wi.z)))
            }
        }
    }

    /// Density with which [`Lobe::sample`] finds `wi`; zero for smooth lobes.
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        match *self {
            Self::Diffuse { .. } | Self::Sheen { .. } => warp::cosine_hemisphere_pdf(wi.z),
            Self::Reflection { alpha, .. } => {
                if alpha < ggx::SMOOTH_ALPHA || wi.z <= 0.0 {
                    return 0.0;
                }
                let m = (wo + wi).normalize();
                ggx::g1(wo, alpha) * ggx::d(m, alpha) / (4.0 * wo.z)
            }
            Self::Refraction { alpha, eta, .. } => {
                if alpha < ggx::SMOOTH_ALPHA || wi.z == 0.0 {
                    return 0.0;
                }
                let Some((m, f, jacobian)) = refraction_half_vector(wo, wi, eta) else { return 0.0 };
                let choice = if wi.z > 0.0 { f } else { 1.0 - f };
                choice * ggx::visible_pdf(wo, m, alpha) * jacobian
            }
            Self::Thin { .. } => 0.0,
        }
    }

    /// Samples an incident direction. `u` is uniform on [0,1)³. `None` when the direction falls on the wrong side.
    #[inline]
    pub fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<LobeSample> {
        let finite = |wi: Vec3| Some(LobeSample { wi, delta_weight: Rgb::BLACK, event: Event::Finite });
        let mirrored = Vec3::new(-wo.x, -wo.y, wo.z);
        match *self {
            Self::Diffuse { .. } | Self::Sheen { .. } => {
                let wi = warp::cosine_hemisphere([u[0], u[1]]);
                if wi.z > 0.0 { finite(wi) } else { None }
            }
            Self::Reflection { alpha, fresnel } => {
                if alpha < ggx::SMOOTH_ALPHA {
                    return Some(LobeSample { wi: mirrored, delta_weight: fresnel.eval(wo.z), event: Event::Delta });
                }
                let wi = ggx::reflect(wo, ggx::sample_visible(wo, alpha, [u[0], u[1]]));
                if wi.z > 0.0 { finite(wi) } else { None }
            }
            Self::Refraction { alpha, eta, tint } => {
                let smooth = alpha < ggx::SMOOTH_ALPHA;
                let m = if smooth { Vec3::Z } else { ggx::sample_visible(wo, alpha, [u[0], u[1]]) };
                let cos = wo.dot(m);
                let (f, cos_t) = fresnel::dielectric(cos.max(0.0), eta);
                if u[2] < f {
                    let wi = ggx::reflect(wo, m);
                    if smooth {
                        return Some(LobeSample { wi, delta_weight: Rgb::WHITE, event: Event::Delta });
                    }
                    return if wi.z > 0.0 { finite(wi) } else { None };
                }
                let wi = (m * (cos / eta - cos_t) - wo / eta).normalize();
                if smooth {
                    return Some(LobeSample { wi, delta_weight: tint * (1.0 / (eta * eta)), event: Event::Delta });
                }
                if wi.z < 0.0 { finite(wi) } else { None }
            }
            Self::Thin { eta, tint } => {
                let r = thin_reflectance(wo.z, eta);
                if u[2] < r {
                    Some(LobeSample { wi: mirrored, delta_weight: Rgb::WHITE, event: Event::Delta })
                } else {
                    Some(LobeSample { wi: -wo, delta_weight: tint, event: Event::Straight })
                }
            }
        }
    }
}

/// Reflectance of a pane with all its inner reflections, without absorption.
#[inline]
pub fn thin_reflectance(cos: f32, eta: f32) -> f32 {
    let r = fresnel::dielectric(cos, eta).0;
    2.0 * r / (1.0 + r)
}

/// The microfacet normal (z > 0) that takes `wo` to `wi` by reflection or refraction, the Fresnel reflectance there, and the
/// Jacobian from the solid angle of the normal to that of `wi`. `None` when no facet does.
#[inline]
fn refraction_half_vector(wo: Vec3, wi: Vec3, eta: f32) -> Option<(Vec3, f32, f32)> {
    if wi.z > 0.0 {
        let m = (wo + wi).normalize();
        let cos = wo.dot(m);
        return Some((m, fresnel::dielectric(cos.clamp(0.0, 1.0), eta).0, 1.0 / (4.0 * cos)));
    }
    let m = (wo + wi * eta).try_normalize()?;
    let m = if m.z < 0.0 { -m } else { m };
    let (cos_o, cos_i) = (wo.dot(m), wi.dot(m));
    if cos_o <= 0.0 || cos_i >= 0.0 {
        return None;
    }
    let (f, cos_t) = fresnel::dielectric(cos_o.min(1.0), eta);
    if cos_t == 0.0 {
        return None;
    }
    let denominator = cos_o + eta * cos_i;
    Some((m, f, eta * eta * cos_i.abs() / (denominator * denominator)))
}

/// The "Charlie" distribution of fibres. Its `alpha` is the square of the roughness.
#[inline]
fn charlie(m: Vec3, roughness: f32) -> f32 {
    let inverse_alpha = 1.0 / (roughness * roughness).max(1e-4);
    let sin2 = (m.x * m.x + m.y * m.y).clamp(0.0, 1.0);
    (2.0 + inverse_alpha) * sin2.powf(0.5 * inverse_alpha) * (0.5 * INV_PI)
}
