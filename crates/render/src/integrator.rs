//! The path tracer: radiance along camera rays, split at the first surface.
//!
//! At the first surface the estimate is kept in three parts: the diffuse reflectance A, the *demodulated* diffuse light E
//! (what the diffuse lobe would send for a reflectance of one) and the rest R, so that a sample's radiance is A·E + R.

use crate::bsdf::{Bsdf, Value};
use crate::config::RenderConfig;
use crate::guide::Guide;
use crate::light::{LightKind, LightPoint, power_heuristic};
use crate::prepared::{Cutout, RenderScene};
use crate::split::{Arriving, Split};
use crate::surface::Surface;
use crate::texture::Cone;
use crate::vertex::{Segment, Vertex, sides_agree};
use enfilade_math::{Ray, Rgb, Sampler, Vec3};

/// One sample of a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PixelSample {
    /// Diffuse reflectance A of the first surface.
    pub reflectance: Rgb,
    /// Demodulated diffuse light E.
    pub illumination: Option<Rgb>,
    /// Everything else, R.
    pub residual: Rgb,
    /// A·E + R in parts, where they are asked for.
    pub split: Split,
}

/// One in this many samples of a surface without diffuse reflectance measures the light that falls on it.
const IRRADIANCE_STRIDE: u32 = 4;

/// A path goes on with this times the ratio of the light it is expected to find to that of the first surface: the light is not known
/// exactly, and ending a path that mattered costs more than following one that did not.
const SURVIVAL_GAIN: f32 = 0.8;
/// The same where nothing is known of the light, and of the light that mirrors and glass find, for what the path lets through.
const UNKNOWN_GAIN: f32 = 6.0;
/// Bounds of the probability that a path goes on.
const LEAST_SURVIVAL: f32 = 0.2;
const MOST_SURVIVAL: f32 = 0.95;

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
    pub guide: &'a Guide,
    /// The angle that a camera ray stands for, radians.
    pub pixel_angle: f32,
}

/// Light sampled at a source.
struct Direct {
    /// The BSDF's value over the light's density, weighted against BSDF sampling.
    weight: Value,
    /// Radiance that arrives.
    light: Rgb,
    kind: LightKind,
    /// True when it reaches the surface from behind.
    crosses: bool,
}

impl<'s> Integrator<'_, 's> {
    /// A sample along a camera ray (unit direction); `index` is the sample's number within the pixel.
    pub fn sample(&self, ray: Ray, sampler: &Sampler, index: u32) -> PixelSample {
        let Some(hit) = self.scene.closest(&ray, Cutout::Random) else {
            let background = self.scene.lights.background(ray.direction);
            let mut split = Split::default();
            split.add_background(background);
            return PixelSample { residual: background.total(), split, ..PixelSample::default() };
        };
        let camera = Segment::from_camera(ray, Cone::camera(self.pixel_angle));
        let surface = self.scene.surface(&hit, ray.direction, &camera.cone);
        let bsdf = surface.bsdf(self.scene);
        let vertex = Vertex::new(self.guide, &surface, &bsdf);
        let mut sum = Value { diffuse: Rgb::BLACK, specular: surface.emission(self.scene) };
        let mut split = Split::default();
        if self.config.splits {
            split.add_emission(sum.specular);
        }

        // Light reflected straight from the sources.
        if let Some(Direct { weight, light, kind, crosses }) = self.sample_lights(&vertex, sampler.set(light_set(0))) {
            sum.diffuse += weight.diffuse * light;
            sum.specular += weight.specular * light;
            if self.config.splits {
                let mut arriving = Arriving::default();
                arriving.add(kind, light, true);
                split.add_scattered(bsdf.reflectance, &weight, &arriving, crosses);
            }
        }

        // Light that comes by way of other surfaces, and sources that the direction happens to meet.
        let u = sampler.set(bsdf_set(0));
        if let Some((weight, segment)) = vertex.scatter([u[0], u[1], u[2]], &camera) {
            let total = weight.total(bsdf.reflectance);
            let expected = vertex.expected_indirect();
            let crossed = segment.crossed;
            let arriving = self.clamped(self.radiance(segment, total, expected, sampler), total);
            sum.diffuse += weight.diffuse * arriving.total;
            sum.specular += weight.specular * arriving.total;
            if self.config.splits {
                split.add_scattered(bsdf.reflectance, &weight, &arriving, crossed);
            }
        }

        let has_diffuse = !bsdf.reflectance.is_black();
        let illumination = if has_diffuse {
            Some(sum.diffuse)
        } else {
            index.is_multiple_of(IRRADIANCE_STRIDE).then(|| self.irradiance(&surface, sampler))
        };
        PixelSample { reflectance: bsdf.reflectance, illumination, residual: sum.specular, split }
    }

    /// Radiance along a path beyond the first surface. Two numbers concern roulette alone: `first_throughput`, what the first surface
    /// lets through of it, and `expected`, the indirect light that the first surface is expected to reflect (0: unknown).
    fn radiance(&self, mut segment: Segment, first_throughput: Rgb, mut expected: f32, sampler: &Sampler) -> Arriving {
        let mut radiance = Arriving::default();
        let mut throughput = Rgb::WHITE;
        // Until something scatters light, what is met comes straight from its source.
        let mut direct = true;
        for bounce in 1.. {
            // Next surface, or the surroundings.
            let Some(hit) = self.scene.closest(&segment.ray, Cutout::Random) else {
                let (lights, sampled) = (&self.scene.lights, segment.sampled.as_ref());
                let background = lights.background_weighted(&self.guide.choice, sampled, segment.ray.direction);
                radiance.add_background(background, throughput, direct);
                return radiance;
            };
            let surface = self.scene.surface(&hit, segment.ray.direction, &segment.cone);
            throughput *= segment.medium.transmittance(hit.t);

            // Emission met by chance, weighted against light sampling.
            let emission = surface.emission(self.scene);
            if !emission.is_black() {
                let (lights, sampled) = (&self.scene.lights, segment.sampled.as_ref());
                let weight = lights.surface_weight(self.scene, &self.guide.choice, sampled, segment.ray.direction, &hit, surface.p);
                radiance.add(LightKind::Surfaces, throughput * emission * weight, direct);
            }

            // The last surface only shows what it emits: light sampling before it counted on that.
            if self.config.max_bounces.is_some_and(|most| bounce > most) {
                return radiance;
            }

            // Light reflected straight from the sources.
            let bsdf = surface.bsdf(self.scene);
            if bsdf.is_black() {
                return radiance;
            }
            let vertex = Vertex::new(self.guide, &surface, &bsdf);
            if let Some(Direct { weight, light, kind, .. }) = self.sample_lights(&vertex, sampler.set(light_set(bounce))) {
                radiance.add(kind, throughput * weight.total(bsdf.reflectance) * light, false);
            }

            // Onward.
            let u = sampler.set(bsdf_set(bounce));
            let Some((weight, next)) = vertex.scatter([u[0], u[1], u[2]], &segment) else { return radiance };
            if bounce >= self.config.roulette_start {
                let so_far = throughput * first_throughput;
                let here = so_far.luminance() * vertex.expected_indirect();
                let blurred = weight.specular.luminance() <= (bsdf.reflectance * weight.diffuse).luminance();
                let survival = if blurred && here > 0.0 && expected > 0.0 {
                    (SURVIVAL_GAIN * here / expected).max(LEAST_SURVIVAL)
                } else {
                    UNKNOWN_GAIN * (so_far * weight.total(bsdf.reflectance)).max_component() / next.medium.compression
                };
                let survival = survival.min(MOST_SURVIVAL);
                if u[3] >= survival {
                    return radiance;
                }
                throughput *= 1.0 / survival;
                if expected == 0.0 {
                    expected = here;
                }
            }
            throughput *= weight.total(bsdf.reflectance);
            direct &= next.straight;
            segment = next;
        }
        radiance
    }

    /// A sample's indirect light, dimmed to the most that it may add behind the first surface's `throughput`.
    fn clamped(&self, light: Arriving, throughput: Rgb) -> Arriving {
        let Some(most) = self.config.clamp else { return light };
        let brightest = (light.total * throughput).max_component();
        if brightest > most { light.scaled(most / brightest) } else { light }
    }

    /// Direct light, where the light sample sends any.
    fn sample_lights(&self, vertex: &Vertex<'_, 's>, u: [f32; 4]) -> Option<Direct> {
        let surface = vertex.surface;
        let wanted = |wi: Vec3| sides_agree(wi.dot(vertex.onb.z), wi.dot(surface.ng));
        let at = LightPoint::on(surface);
        let light = self.scene.lights.sample(self.scene, &self.guide.choice, &at, [u[0], u[1], u[2]], wanted)?;
        let wi = vertex.onb.to_local(light.wi);
        let (value, pdf) = vertex.eval_pdf(wi, light.wi);
        if value == Value::default() {
            return None;
        }
        let arriving = self.scene.transmittance(&surface.shadow_ray(light.wi, light.target));
        if arriving.is_black() {
            return None;
        }
        let weight = if light.is_delta { 1.0 } else { power_heuristic(light.pdf, pdf) } / light.pdf;
        Some(Direct {
            weight: value * weight,
            light: self.scene.lights.radiance_of(&light) * arriving,
            kind: light.kind(),
            crosses: wi.z < 0.0,
        })
    }

    /// Irradiance over π at a surface without diffuse reflectance, by a white Lambert surface in its place.
    fn irradiance(&self, surface: &Surface<'s>, sampler: &Sampler) -> Rgb {
        let bsdf = Bsdf::lambert(Rgb::WHITE);
        let vertex = Vertex::new(self.guide, surface, &bsdf);
        let direct = self.sample_lights(&vertex, sampler.set(light_set(0)));
        let mut irradiance = direct.map_or(Rgb::BLACK, |direct| direct.weight.diffuse * direct.light);
        let u = sampler.set(bsdf_set(0));
        let nowhere = Segment::from_camera(Ray::new(surface.p, -surface.wo), Cone::POINT);
        if let Some((weight, segment)) = vertex.scatter([u[0], u[1], u[2]], &nowhere) {
            irradiance += weight.diffuse * self.radiance(segment, Rgb::WHITE, vertex.expected_indirect(), sampler).total;
        }
        irradiance
    }
}
