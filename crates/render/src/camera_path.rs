//! Paths from the camera on: what the first surface sends back is kept in the parts that the colour layers need.
//!
//! From the second surface on [`Integrator::radiance`] follows the path.

use crate::beyond::Beyond;
use crate::bsdf::Value;
use crate::integrator::{Direct, Integrator, bsdf_set, roulette_throughput};
use crate::light_parts::{Arriving, Origin};
use crate::pixel_sample::{CameraSample, FOLLOWED, FixtureLight, PixelSample};
use crate::texture::Cone;
use crate::vertex::{Segment, Vertex};
use enfilade_math::Rgb;

/// One in this many samples of a surface without diffuse reflectance measures the light that falls on it.
const IRRADIANCE_STRIDE: u32 = 4;

impl Integrator<'_, '_> {
    /// Follows the path of a camera ray.
    pub fn sample(&self, camera: &CameraSample) -> PixelSample {
        // Find the first surface. Where there is none, the background is seen, and all of it is residual.
        let mut sample = PixelSample::default();
        let Some(ray) = camera.ray else { return sample };
        let sampler = &camera.sampler;
        let cone = Cone::camera(self.pixel_angle);
        let seen = self.scene.seen(&ray, &cone, || sampler.set(bsdf_set(0))[3]);
        sample.expected_reflectance = seen.reflectance;
        let Some(hit) = seen.hit else {
            let background = self.scene.lights.background(ray.direction);
            sample.parts.add_background(background);
            sample.residual = background.total();
            self.background_by_origin(background, None).into_iter().for_each(|(from, light)| sample.add_seen(from, light));
            return sample;
        };
        let segment = Segment::from_camera(ray, cone);
        let surface = self.scene.surface(&hit, ray.direction, &segment.cone);

        // Add what the first surface emits towards the camera. No light sample could have found it, so it counts in full.
        sample.residual = surface.emission(self.scene);
        if self.config.light_parts {
            sample.parts.add_emission(sample.residual);
        }
        sample.add_seen(self.origin_of_surface(&surface), sample.residual);

        // Note what guides denoising.
        let bsdf = surface.bsdf(self.scene);
        sample.normal = surface.ns;
        if camera.index < FOLLOWED {
            sample.beyond = Beyond::first(self.scene, &surface, &bsdf);
        }

        // Sample a light and add what the surface reflects of it: next-event estimation, weighted against the BSDF's own directions.
        let vertex = Vertex::new(self.guide, surface.lifted(self.scene), bsdf);
        let mut illumination = Rgb::BLACK;
        sample.reflectance = vertex.bsdf.reflectance;
        for Direct { weight, light, from, crosses, scattered } in self.sample_lights(&vertex, 0, sampler, segment.medium) {
            let mut arriving = Arriving::default();
            arriving.add(from, light, !scattered);
            if scattered {
                arriving = self.clamped(arriving, weight.total(sample.reflectance));
            }
            illumination += self.add_scattered(&mut sample, &weight, &arriving, crosses);
        }

        // Sample the direction in which the path continues. The first surface always has one: Russian roulette begins after it.
        let u = sampler.set(bsdf_set(0));
        if let Some((weight, mut next)) = vertex.scatter([u[0], u[1], u[2]], &segment) {
            next.window = self.window(&vertex.surface, &next);
            let (crossed, reflected) = (next.crossed, weight.total(sample.reflectance));
            let light = self.radiance(next, 1, true, roulette_throughput(reflected), vertex.expected(), sampler);
            illumination += self.add_scattered(&mut sample, &weight, &self.clamped(light, reflected), crossed);
        }

        // Where nothing is reflected diffusely, some samples measure the light on a white surface in its place.
        sample.illumination = if sample.reflectance.is_black() {
            camera.index.is_multiple_of(IRRADIANCE_STRIDE).then(|| self.irradiance(&vertex.surface, sampler))
        } else {
            Some(illumination)
        };
        sample
    }

    /// Adds what the first surface makes of arriving light to everything but the illumination, which is returned.
    #[inline]
    fn add_scattered(&self, sample: &mut PixelSample, weight: &Value, light: &Arriving, crossed: bool) -> Rgb {
        sample.residual += weight.specular * light.total;
        if self.config.light_parts {
            sample.parts.add_scattered(sample.reflectance, weight, light, crossed);
        }
        let by_fixture = light.by_fixture.iter().map(|&(fixture, light)| FixtureLight {
            fixture,
            illumination: weight.diffuse * light,
            residual: weight.specular * light,
        });
        sample.fixtures.extend(by_fixture);
        weight.diffuse * light.total
    }
}

impl PixelSample {
    /// Adds light that is seen where it comes from to what fixtures add; the residual has it already.
    fn add_seen(&mut self, from: Origin, light: Rgb) {
        if let Some(fixture) = from.fixture.filter(|_| !light.is_black()) {
            self.fixtures.push(FixtureLight { fixture, illumination: Rgb::BLACK, residual: light });
        }
    }
}
