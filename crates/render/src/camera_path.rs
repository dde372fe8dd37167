//! Paths from the camera on: over its primary vertices to the second surface, where the light found may be shared.
//!
//! A camera ray meets the first surface. While a path goes on by mirrors and clear glass, each surface that it reaches is one more
//! primary vertex. Once it goes on in a direction that came from a density, the surface which that finds is the second one, and from
//! there on [`Integrator::radiance`] follows the path. What the second surface sends back is gathered for this pixel, or kept
//! as a [`SharedVertex`] for all pixels of the batch: see [`crate::reuse`].

use crate::batch::{Batch, CameraSample, Gathered, PixelSample, PrimaryVertex, SpecularChain};
use crate::integrator::{Direct, Indirect, Integrator, Step, bsdf_set, light_set, roulette_throughput};
use crate::prepared::AlphaTest;
use crate::shared_vertex::{DirectionSample, SharedVertex};
use crate::split::Arriving;
use crate::texture::Cone;
use crate::vertex::{Segment, Vertex};
use enfilade_math::{Rgb, Sampler};

/// One in this many samples of a surface without diffuse reflectance measures the light that falls on it.
const IRRADIANCE_STRIDE: u32 = 4;

impl<'a, 's> Integrator<'a, 's> {
    /// Samples along camera rays of pixels near each other, which share what they find. `batch` is where the work is done.
    pub fn samples<'b>(&self, cameras: &'b [CameraSample], batch: &'b mut Batch<'a, 's>) -> impl Iterator<Item = PixelSample> {
        batch.clear(cameras.len());
        for (number, camera) in cameras.iter().enumerate() {
            let first = self.follow(number, camera, batch);
            batch.firsts.push(first);
        }
        self.share_light(batch);
        let batch = &*batch;
        cameras.iter().zip(&batch.firsts).zip(&batch.gathered).map(|((camera, first), gathered)| {
            let first = first.map(|primary| &batch.primaries[primary].vertex);
            self.pixel_sample(camera, first, gathered)
        })
    }

    /// Follows a path from its camera; all light is gathered but for what others may use. Returns the number of the first primary vertex,
    /// `None` where the camera sees no surface.
    fn follow(&self, number: usize, camera: &CameraSample, batch: &mut Batch<'a, 's>) -> Option<usize> {
        // Find the first surface. Where there is none, the background is seen, and all of it is residual.
        let ray = camera.ray?;
        let gathered = &mut batch.gathered[number];
        let Some(hit) = self.scene.closest(&ray, AlphaTest::Stochastic) else {
            let background = self.scene.lights.background(ray.direction);
            gathered.split.add_background(background);
            gathered.light.specular = background.total();
            return None;
        };
        let mut segment = Segment::from_camera(ray, Cone::camera(self.pixel_angle));
        let mut surface = self.scene.surface(&hit, ray.direction, &segment.cone);

        // Add what the first surface emits towards the camera. No light sample could have found it, so it counts in full.
        gathered.light.specular = surface.emission(self.scene);
        if self.config.splits {
            gathered.split.add_emission(gathered.light.specular);
        }

        // Go from primary vertex to primary vertex, as long as mirrors and glass lead on.
        let first = batch.primaries.len();
        let (sampler, mut chain, mut expected, mut forks) = (&camera.sampler, None, 0.0, 0);
        for bounce in 0.. {
            // End the path at a surface that absorbs all light. The first surface becomes a primary vertex even so: it has a pixel.
            let bsdf = surface.bsdf(self.scene);
            if chain.is_some() && bsdf.is_black() {
                break;
            }
            let vertex = Vertex::new(self.guide, surface, bsdf);
            let primary = PrimaryVertex { vertex, camera: number, bounce, forks, chain, shares_light: segment.medium.is_clear() };
            let (vertex, throughput) = (&primary.vertex, primary.throughput());

            // Sample a light and add what the surface reflects of it: next-event estimation, weighted against the BSDF's own directions.
            if let Some(Direct { weight, light, kind, crosses, .. }) =
                self.sample_lights(vertex, sampler.set(light_set(bounce)), segment.medium)
            {
                let mut arriving = Arriving::default();
                arriving.add(kind, light, true);
                self.add(gathered, &primary, &weight, arriving, crosses, bounce > 0);
            }

            // Sample the direction in which the path goes on. The first surface always has one: Russian roulette begins after it.
            let step = if bounce == 0 {
                expected = vertex.expected();
                let u = sampler.set(bsdf_set(0));
                vertex.scatter([u[0], u[1], u[2]], &segment).map(|(weight, next)| (Step { weight, survival: 1.0 }, next))
            } else {
                self.next_step(bounce, vertex, roulette_throughput(throughput), &segment, &mut expected, sampler)
            };
            let Some((step, next)) = step else {
                batch.primaries.push(primary);
                break;
            };

            // Follow a direction that came from a density to the second surface: its light is for this path, or for all of the batch.
            if next.sampled.is_some() {
                let crossed = next.crossed;
                let (own, shared) = self.second_surface(&primary, &step, next, expected, sampler);
                self.gather(gathered, &primary, &step.weight, own, crossed);
                batch.shared.extend(shared.map(|shared| (batch.primaries.len(), shared)));
                batch.primaries.push(primary);
                break;
            }

            // Follow a mirror or glass to the next primary vertex, and add what that emits.
            let mut arriving = Arriving::default();
            let reached = self.next_surface(&next, Rgb::WHITE, false, &mut arriving);
            self.gather(gathered, &primary, &step.weight, arriving, next.crossed);
            forks += u32::from(!vertex.bsdf.is_sharp());
            batch.primaries.push(primary);
            if self.config.max_bounces.is_some_and(|max| bounce + 1 > max) {
                break;
            }
            let Some((found, _, transmittance)) = reached else { break };
            let crossed = chain.map_or(next.crossed, |chain: SpecularChain| chain.crossed);
            chain = Some(SpecularChain { throughput: throughput * step.weight.specular * transmittance, crossed });
            (surface, segment) = (found, next);
        }
        Some(first)
    }

    /// What arrives along the `segment` that leaves a primary vertex in this `step`: the light that is for this path alone, and what
    /// others may use.
    fn second_surface(
        &self,
        primary: &PrimaryVertex<'_, 's>,
        step: &Step,
        segment: Segment,
        mut expected: f32,
        sampler: &Sampler,
    ) -> (Arriving, Option<SharedVertex<'a>>) {
        // Find the second surface, and add what it emits, weighted against the light sample that was taken at the primary vertex.
        let bounce = primary.bounce + 1;
        let mut own = Arriving::default();
        let direct = bounce == 1;
        let Some((surface, hit, throughput)) = self.next_surface(&segment, Rgb::WHITE, direct, &mut own) else { return (own, None) };
        if self.config.max_bounces.is_some_and(|max| bounce > max) {
            self.beyond_panes(segment, surface, throughput, direct, &mut own);
            return (own, None);
        }
        let bsdf = surface.bsdf(self.scene);
        if bsdf.is_black() {
            return (own, None);
        }
        let vertex = Vertex::new(self.guide, surface, bsdf);

        // Sample a light there, and follow the path beyond it.
        let direct = self.sample_lights(&vertex, sampler.set(light_set(bounce)), segment.medium);
        let so_far = roulette_throughput(throughput * primary.throughput() * step.weight.total(primary.vertex.bsdf.reflectance));
        let reflectance = vertex.bsdf.reflectance;
        let indirect = self.next_step(bounce, &vertex, so_far, &segment, &mut expected, sampler).map(|(step, next)| {
            let wi = next.ray.direction;
            let density = next.sampled.filter(|_| !next.straight).map(|(_, pdf)| pdf * step.survival);
            let straight = next.straight && bounce == 1;
            let light = self.radiance(next, bounce + 1, straight, so_far * step.weight.total(reflectance), expected, sampler);
            Indirect { weight: step.weight, light, wi, density }
        });

        // Share what others could have found here as well; otherwise all of it is for this path.
        if let Some(found_by) = DirectionSample::new(&segment, step, &vertex.surface) {
            let shared = SharedVertex::new(found_by, &vertex, &hit, direct, indirect, &mut own);
            return (own, shared);
        }
        if let Some(Direct { weight, light, kind, .. }) = direct {
            own.add(kind, throughput * weight.total(reflectance) * light, false);
        }
        if let Some(Indirect { weight, light, .. }) = indirect {
            own.add_dimmed(&light, throughput * weight.total(reflectance));
        }
        (own, None)
    }

    /// A pixel's sample made of the light that was gathered for it.
    fn pixel_sample(&self, camera: &CameraSample, first: Option<&Vertex<'_, 's>>, gathered: &Gathered) -> PixelSample {
        let (residual, split) = (gathered.light.specular, gathered.split);
        let Some(Vertex { surface, bsdf, .. }) = first else { return PixelSample { residual, split, ..PixelSample::default() } };
        let illumination = if bsdf.reflectance.is_black() {
            camera.index.is_multiple_of(IRRADIANCE_STRIDE).then(|| self.irradiance(surface, &camera.sampler))
        } else {
            Some(gathered.light.diffuse)
        };
        PixelSample { reflectance: bsdf.reflectance, illumination, residual, split }
    }
}
