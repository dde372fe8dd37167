//! A diffuse base under a dielectric coat: plastic, varnish, and the dielectric part of principled materials.
//!
//! The base receives what the coat does not reflect in one bounce, and light is reflected between base and coat many times. Ashikhmin &
//! Shirley 2000; Weidlich & Wilkie 2007; Mitsuba's `roughplastic`.

use super::coat::{self, Bounces, Coat};
use super::fresnel;
use super::ggx::Facets;
use super::sample::{Event, Sample, Value};
use enfilade_math::{INV_PI, Rgb, Vec3, warp};
use std::f32::consts::PI;

/// The pair of lobes, for one viewing direction.
#[derive(Clone, Copy, Debug)]
pub struct Coated<'a> {
    /// The coat.
    pub coat: Coat<'a>,
    /// Facets of the coat's surface.
    pub facets: Facets,
    /// Demodulated value of the base over cosine × transmittance on the way in.
    base: Rgb,
    /// Demodulated value over the cosine alone, of the part of the base that has no coat.
    bare: f32,
    /// Transmittance of the coat towards the viewer.
    through_o: f32,
    /// Multiplies the coat's reflection.
    tint: Rgb,
    /// Probability of sampling the base.
    select_base: f32,
}

impl<'a> Coated<'a> {
    /// A base of colour `reflectance` under `coat` of roughness `alpha`, whose reflection is multiplied by `tint`. `saturating`: light that
    /// is reflected between base and coat takes on the base's colour each time; otherwise the base counts as white there. The coat covers
    /// the fraction `covered` of the base, and `tint` includes that factor.
    #[inline]
    pub fn new(coat: Coat<'a>, alpha: f32, reflectance: Rgb, tint: Rgb, saturating: bool, covered: f32, cos_o: f32) -> Self {
        let through_o = coat.transmittance(cos_o);
        let once = through_o * INV_PI / (coat.eta * coat.eta);
        let escapes = coat.inner_transmittance();
        // 1 − r · (1 − escapes), without the cancellation where hardly anything escapes.
        let base = if saturating { reflectance.map(|r| once / ((1.0 - r) + r * escapes)) } else { Rgb::splat(once / escapes) };
        let facets = match coat.bounces {
            Bounces::All => Facets::new(alpha, cos_o),
            Bounces::Single => coat::single(coat.distribution, alpha, cos_o),
        };
        let through = covered * through_o + (1.0 - covered);
        let (diffuse, specular) = (reflectance.luminance() * through, (1.0 - through_o) * tint.luminance());
        // Neither starves.
        let select_base = match (diffuse > 0.0, specular > 0.0) {
            (true, true) => 0.05 + 0.9 * diffuse / (diffuse + specular),
            (true, false) => 1.0,
            _ => 0.0,
        };
        Self { coat, facets, base: base * covered, bare: (1.0 - covered) * INV_PI, through_o, tint, select_base }
    }

    /// See [`super::Lobe::eval_pdf`].
    #[inline]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Value, f32) {
        if wi.z <= 0.0 {
            return (Value::default(), 0.0);
        }
        let diffuse = self.base * (wi.z * self.coat.transmittance(wi.z)) + Rgb::splat(self.bare * wi.z);
        let density = self.select_base * wi.z * INV_PI;
        if self.facets.smooth() {
            return (Value { diffuse, specular: Rgb::BLACK }, density);
        }
        let mirrored = self.facets.mirror(wo, wi);
        let specular = self.tint * (fresnel::dielectric(mirrored.cos_half, self.coat.eta).0 * mirrored.value);
        (Value { diffuse, specular }, density + (1.0 - self.select_base) * mirrored.pdf)
    }

    /// See [`super::Lobe::sample`].
    #[inline]
    pub fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        let wi = if u[2] < self.select_base {
            warp::cosine_hemisphere([u[0], u[1]])
        } else if self.facets.smooth() {
            let reflected = self.tint * (1.0 - self.through_o);
            return Some(Sample::mirrored(wo, reflected * (1.0 / (1.0 - self.select_base))));
        } else {
            self.facets.sample(wo, [u[0], u[1]])
        };
        let (value, pdf) = self.eval_pdf(wo, wi);
        (pdf > 0.0).then(|| Sample { wi, weight: value * (1.0 / pdf), pdf, event: Event::Finite })
    }

    /// See [`super::Lobe::albedo`].
    #[inline]
    pub fn albedo(&self, cos_o: f32) -> Value {
        let diffuse = self.base * (self.coat.mean_transmittance() * PI) + Rgb::splat(self.bare * PI);
        Value { diffuse, specular: self.tint * fresnel::dielectric(cos_o, self.coat.eta).0 }
    }
}
