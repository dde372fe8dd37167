//! The path tracer: radiance along camera rays, split at the first surface.
//!
//! At the first surface the estimate is kept in three parts: the diffuse reflectance A, the *demodulated* diffuse light E
//! (what the diffuse lobe would send for a reflectance of one) and the rest R, so that a sample's radiance is A·E + R.

use crate::bsdf::{Bsdf, Event, Value};
use crate::config::RenderConfig;
use crate::light::{LightChoice, power_heuristic};
use crate::prepared::{Cutout, RenderScene};
use crate::surface::{MIN_COSINE, Surface};
use enfilade_math::{Onb, Ray, Rgb, Sampler, Vec3, offset_origin, warp};
use enfilade_scene::Bsdf as Model;

/// One sample of a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PixelSample {
    /// Diffuse reflectance A of the first surface.
    pub reflectance: Rgb,
    /// Demodulated diffuse light E.
    pub illumination: Option<Rgb>,
    /// Everything else, R.
    pub residual: Rgb,
}

/// One in this many samples of a surface without diffuse reflectance measures the light that falls on it.
const IRRADIANCE_STRIDE: u32 = 4;

/// Random numbers: set 0 is the camera's; each bounce has two more.
const fn bsdf_set(bounce: u32) -> u32 {
    1 + 2 * bounce
}
const fn light_set(bounce: u32) -> u32 {
    2 + 2 * bounce
}

/// Estimates radiance along paths of one scene.
pub(crate) struct Integrator<'a, 's> {
    pub scene: &'a RenderScene<'s>,
    pub config: &'a RenderConfig,
    pub choice: &'a LightChoice,
}

/// A path between two surfaces.
struct Segment {
    ray: Ray,
    /// Where light was last sampled from, and the density of the ray's direction there; `None` after the camera or a
    /// mirror, where light sampling has no chance.
    sampled: Option<(Vec3, f32)>,
    /// Absorption of the body the ray is inside of, per metre.
    absorption: Rgb,
}

impl<'s> Integrator<'_, 's> {
    /// A sample along a camera ray (unit direction); `index` is the sample's number within the pixel.
    pub fn sample(&self, ray: Ray, sampler: &Sampler, index: u32) -> PixelSample {
        let Some(hit) = self.scene.closest(&ray, Cutout::Random) else {
            return PixelSample { residual: self.scene.lights.background(ray.direction), ..PixelSample::default() };
        };
        let surface = self.scene.surface(&hit, ray.direction);
        let bsdf = surface.bsdf(self.scene);
        let onb = surface.onb();
        let wo = viewing(&onb, surface.wo);
        let mut split = Value { diffuse: Rgb::BLACK, specular: surface.emission(self.scene) };

        // Light reflected straight from the sources.
        let (direct, direct_light) = self.sample_lights(&surface, &bsdf, &onb, wo, sampler.set(light_set(0)));
        split.diffuse += direct.diffuse * direct_light;
        split.specular += direct.specular * direct_light;

        // Light that comes by way of other surfaces, and sources that the direction happens to meet.
        let u = sampler.set(bsdf_set(0));
        if let Some((weight, segment)) = scatter(&surface, &bsdf, &onb, wo, [u[0], u[1], u[2]], &Segment::from_camera(ray)) {
            let light = self.radiance(segment, weight.total(bsdf.reflectance), sampler);
            split.diffuse += weight.diffuse * light;
            split.specular += weight.specular * light;
        }

        let has_diffuse = !bsdf.reflectance.is_black();
        let illumination = if has_diffuse {
            Some(split.diffuse)
        } else {
            index.is_multiple_of(IRRADIANCE_STRIDE).then(|| self.irradiance(&surface, sampler))
        };
        PixelSample { reflectance: bsdf.reflectance, illumination, residual: split.specular }
    }

    /// Radiance along a path beyond the first surface. `throughput` is what the first surface lets through of it; only
    /// roulette looks at that.
    fn radiance(&self, mut segment: Segment, first_throughput: Rgb, sampler: &Sampler) -> Rgb {
        let mut radiance = Rgb::BLACK;
        let mut throughput = Rgb::WHITE;
        for bounce in 1..=self.config.max_bounces.saturating_add(1) {
            // Next surface, or the surroundings.
            let Some(hit) = self.scene.closest(&segment.ray, Cutout::Random) else {
                return radiance + throughput * self.background(&segment);
            };
            let surface = self.scene.surface(&hit, segment.ray.direction);
            throughput *= absorbed(segment.absorption, hit.t);

            // Emission met by chance, weighted against light sampling.
            let emission = surface.emission(self.scene);
            if !emission.is_black() {
                let weight = segment.sampled.map_or(1.0, |(from, pdf)| {
                    let light_pdf =
                        self.scene.lights.surface_pdf(self.scene, self.choice, from, segment.ray.direction, &hit, surface.p, surface.ng);
                    power_heuristic(pdf, light_pdf)
                });
                radiance += throughput * emission * weight;
            }

            // The last surface only shows what it emits: light sampling before it counted on that.
            if bounce > self.config.max_bounces {
                return radiance;
            }

            // Light reflected straight from the sources.
            let bsdf = surface.bsdf(self.scene);
            if bsdf.is_black() {
                return radiance;
            }
            let onb = surface.onb();
            let wo = viewing(&onb, surface.wo);
            let (direct, light) = self.sample_lights(&surface, &bsdf, &onb, wo, sampler.set(light_set(bounce)));
            radiance += throughput * direct.total(bsdf.reflectance) * light;

            // Onward.
            let u = sampler.set(bsdf_set(bounce));
            let Some((weight, next)) = scatter(&surface, &bsdf, &onb, wo, [u[0], u[1], u[2]], &segment) else { return radiance };
            throughput *= weight.total(bsdf.reflectance);
            segment = next;

            // Russian roulette.
            if bounce >= self.config.roulette_start {
                let survival = (throughput * first_throughput).max_component().max(0.25 * throughput.max_component()).min(0.95);
                if u[3] >= survival {
                    return radiance;
                }
                throughput *= 1.0 / survival;
            }
        }
        radiance
    }

    /// Direct light: the BSDF's value over the light's density, weighted against BSDF sampling, and the radiance that arrives.
    fn sample_lights(&self, surface: &Surface<'s>, bsdf: &Bsdf<'_>, onb: &Onb, wo: Vec3, u: [f32; 4]) -> (Value, Rgb) {
        let nothing = (Value::default(), Rgb::BLACK);
        let wanted = |wi: Vec3| sides_agree(wi.dot(onb.z), wi.dot(surface.ng));
        let Some(light) = self.scene.lights.sample(self.scene, self.choice, surface.p, [u[0], u[1], u[2]], wanted) else { return nothing };
        let wi = onb.to_local(light.wi);
        let (value, density) = bsdf.eval_pdf(wo, wi);
        if value == Value::default() {
            return nothing;
        }
        let arriving = self.scene.transmittance(&surface.shadow_ray(light.wi, light.target));
        if arriving.is_black() {
            return nothing;
        }
        let weight = if light.is_delta { 1.0 } else { power_heuristic(light.pdf, density) } / light.pdf;
        (value * weight, self.scene.lights.radiance_of(&light) * arriving)
    }

    /// Irradiance over π at a surface without diffuse reflectance, by a white Lambert surface in its place.
    fn irradiance(&self, surface: &Surface<'s>, sampler: &Sampler) -> Rgb {
        let bsdf = Bsdf::lambert(Rgb::WHITE);
        let onb = surface.onb();
        let wo = viewing(&onb, surface.wo);
        let (direct, light) = self.sample_lights(surface, &bsdf, &onb, wo, sampler.set(light_set(0)));
        let mut irradiance = direct.diffuse * light;
        let u = sampler.set(bsdf_set(0));
        let wi = warp::cosine_hemisphere([u[0], u[1]]);
        let wi_world = onb.to_world(wi);
        if wi.z > 0.0 && wi_world.dot(surface.ng) > 0.0 {
            let ray = Ray::new(offset_origin(surface.p, surface.ng), wi_world);
            let pdf = warp::cosine_hemisphere_pdf(wi.z);
            let segment = Segment { ray, sampled: Some((surface.p, pdf)), absorption: Rgb::BLACK };
            irradiance += self.radiance(segment, Rgb::WHITE, sampler);
        }
        irradiance
    }

    fn background(&self, segment: &Segment) -> Rgb {
        match segment.sampled {
            None => self.scene.lights.background(segment.ray.direction),
            Some((from, pdf)) => self.scene.lights.background_weighted(self.choice, from, segment.ray.direction, pdf),
        }
    }
}

impl Segment {
    fn from_camera(ray: Ray) -> Self {
        Self { ray, sampled: None, absorption: Rgb::BLACK }
    }
}

/// Samples the BSDF and begins the next segment. `None` ends the path.
fn scatter(surface: &Surface<'_>, bsdf: &Bsdf<'_>, onb: &Onb, wo: Vec3, u: [f32; 3], before: &Segment) -> Option<(Value, Segment)> {
    let sample = bsdf.sample(wo, u)?;
    let direction = if sample.event == Event::Straight { before.ray.direction } else { onb.to_world(sample.wi).normalize() };
    let side = direction.dot(surface.ng);
    if sample.event != Event::Straight && !sides_agree(sample.wi.z, side) {
        return None;
    }
    let through = side < 0.0;
    let origin = offset_origin(surface.p, if through { -surface.ng } else { surface.ng });
    let sampled = match sample.event {
        Event::Finite => Some((surface.p, sample.pdf)),
        Event::Delta => None,
        // A pane is no place where directions are chosen: light sampling from before it reaches through it.
        Event::Straight => before.sampled,
    };
    let absorption = match (&surface.material.bsdf, through && sample.event != Event::Straight) {
        (Model::Dielectric { absorption, .. }, true) => inside(surface, *absorption),
        (Model::Principled(p), true) if p.solid => inside(surface, p.absorption),
        _ => before.absorption,
    };
    Some((sample.weight, Segment { ray: Ray::new(origin, direction), sampled, absorption }))
}

/// Absorption beyond a border that was crossed: the body's when it was entered, none when it was left.
fn inside(surface: &Surface<'_>, absorption: Rgb) -> Rgb {
    if surface.outside { absorption } else { Rgb::BLACK }
}

/// Beer–Lambert transmittance over a distance.
#[inline]
fn absorbed(absorption: Rgb, distance: f32) -> Rgb {
    if absorption.is_black() { Rgb::WHITE } else { absorption.map(|a| (-a * distance).exp()) }
}

/// `wo` in shading space, with its cosine kept off zero.
#[inline]
fn viewing(onb: &Onb, wo: Vec3) -> Vec3 {
    let local = onb.to_local(wo);
    Vec3::new(local.x, local.y, local.z.max(MIN_COSINE)).normalize()
}

/// True when a direction is on the same side of the shading and of the geometric surface: no light leaks through bumps.
#[inline]
fn sides_agree(shading_cosine: f32, geometric_cosine: f32) -> bool {
    shading_cosine * geometric_cosine > 0.0
}
