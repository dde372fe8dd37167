//! Samples of pixels near each other, taken together: their paths from the camera on.
//!
//! At the first surface the estimate is kept in three parts: the diffuse reflectance A, the *demodulated* diffuse light E
//! (what the diffuse lobe would send for a reflectance of one) and the rest R, so that a sample's radiance is A·E + R.
//!
//! Light that the paths find beyond the second surface is shared: see [`crate::reuse`].

use crate::bsdf::Value;
use crate::integrator::{Direct, Indirect, Integrator, Step, bsdf_set, for_roulette, light_set};
use crate::prepared::Cutout;
use crate::reuse::{Far, Link, Reach};
use crate::split::{Arriving, Split};
use crate::texture::Cone;
use crate::vertex::{Segment, Vertex};
use enfilade_math::{Ray, Rgb, Sampler};

/// One in this many samples of a surface without diffuse reflectance measures the light that falls on it.
const IRRADIANCE_STRIDE: u32 = 4;

/// A camera ray to follow.
pub(crate) struct CameraSample {
    /// With a unit direction; `None` where the picture shows nothing, and is black.
    pub ray: Option<Ray>,
    pub sampler: Sampler,
    /// The sample's number within the pixel.
    pub index: u32,
}

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

/// The first surface of a camera's path, or one that it reaches by way of mirrors and glass alone.
pub(crate) struct Head<'a, 's> {
    pub vertex: Vertex<'a, 's>,
    /// Number of the camera ray.
    camera: usize,
    /// Surfaces before it.
    pub bounce: u32,
    /// How many of them might have sent the path elsewhere than by a mirror or glass.
    pub forks: u32,
    /// What lies before it; `None` of the first surface.
    before: Option<Passage>,
    /// True unless it lies in something that absorbs light.
    pub shares: bool,
}

/// The way by mirrors and glass from the first surface on.
#[derive(Clone, Copy)]
struct Passage {
    throughput: Rgb,
    /// True when it goes through the first surface.
    crossed: bool,
}

/// Light gathered for a pixel's sample: that of the first surface's diffuse lobes for a reflectance of one, and the rest.
#[derive(Clone, Copy, Default)]
struct Gathered {
    light: Value,
    split: Split,
}

/// Paths of pixels near each other.
#[derive(Default)]
pub(crate) struct Batch<'a, 's> {
    pub heads: Vec<Head<'a, 's>>,
    /// What paths found after a head, whose number it is, and others may use.
    pub fars: Vec<(usize, Far<'a>)>,
    pub links: Vec<Link>,
    /// Of each camera ray, the number of the first head.
    firsts: Vec<Option<usize>>,
    gathered: Vec<Gathered>,
}

impl Head<'_, '_> {
    /// What the way from the first surface lets through.
    fn passed(&self) -> Rgb {
        self.before.map_or(Rgb::WHITE, |before| before.throughput)
    }
}

impl<'a, 's> Integrator<'a, 's> {
    /// Samples along camera rays of pixels near each other, which share what they find. `batch` is where the work is done.
    pub fn samples<'b>(&self, cameras: &'b [CameraSample], batch: &'b mut Batch<'a, 's>) -> impl Iterator<Item = PixelSample> {
        batch.heads.clear();
        batch.fars.clear();
        batch.firsts.clear();
        batch.gathered.clear();
        batch.gathered.resize(cameras.len(), Gathered::default());
        for (number, camera) in cameras.iter().enumerate() {
            let first = self.follow(number, camera, batch);
            batch.firsts.push(first);
        }
        self.share(batch);
        let batch = &*batch;
        cameras.iter().zip(&batch.firsts).zip(&batch.gathered).map(|((camera, first), gathered)| {
            let first = first.map(|head| &batch.heads[head].vertex);
            self.pixel_sample(camera, first, gathered)
        })
    }

    /// Follows a path from its camera; all light is gathered but for what others may use. Hands back the number of the first head.
    fn follow(&self, number: usize, camera: &CameraSample, batch: &mut Batch<'a, 's>) -> Option<usize> {
        let ray = camera.ray?;
        let gathered = &mut batch.gathered[number];
        let Some(hit) = self.scene.closest(&ray, Cutout::Random) else {
            let background = self.scene.lights.background(ray.direction);
            gathered.split.add_background(background);
            gathered.light.specular = background.total();
            return None;
        };
        let mut segment = Segment::from_camera(ray, Cone::camera(self.pixel_angle));
        let mut surface = self.scene.surface(&hit, ray.direction, &segment.cone);
        gathered.light.specular = surface.emission(self.scene);
        if self.config.splits {
            gathered.split.add_emission(gathered.light.specular);
        }
        let first = batch.heads.len();
        let (sampler, mut before, mut expected, mut forks) = (&camera.sampler, None, 0.0, 0);
        for bounce in 0.. {
            let bsdf = surface.bsdf(self.scene);
            if before.is_some() && bsdf.is_black() {
                break;
            }
            let vertex = Vertex::new(self.guide, surface, bsdf);
            let head = Head { vertex, camera: number, bounce, forks, before, shares: segment.medium.is_clear() };
            let (vertex, passed) = (&head.vertex, head.passed());
            // Light reflected straight from the sources.
            if let Some(Direct { weight, light, kind, crosses, .. }) =
                self.sample_lights(vertex, sampler.set(light_set(bounce)), segment.medium)
            {
                let mut arriving = Arriving::default();
                arriving.add(kind, light, true);
                self.add(gathered, &head, &weight, arriving, crosses, bounce > 0);
            }
            // Light that comes by way of other surfaces, and sources that the direction happens to meet.
            let step = if bounce == 0 {
                expected = vertex.expected();
                let u = sampler.set(bsdf_set(0));
                vertex.scatter([u[0], u[1], u[2]], &segment).map(|(weight, next)| (Step { weight, survival: 1.0 }, next))
            } else {
                self.onward(bounce, vertex, for_roulette(passed), &segment, &mut expected, sampler)
            };
            let Some((step, next)) = step else {
                batch.heads.push(head);
                break;
            };
            if next.sampled.is_some() {
                let crossed = next.crossed;
                let (own, far) = self.second(&head, &step, next, expected, sampler);
                self.gather(gathered, &head, &step.weight, own, crossed);
                batch.fars.extend(far.map(|far| (batch.heads.len(), far)));
                batch.heads.push(head);
                break;
            }
            // By a mirror or glass to the next head.
            let mut arriving = Arriving::default();
            let reached = self.next_surface(&next, Rgb::WHITE, false, &mut arriving);
            self.gather(gathered, &head, &step.weight, arriving, next.crossed);
            forks += u32::from(!vertex.bsdf.is_sharp());
            batch.heads.push(head);
            if self.config.max_bounces.is_some_and(|most| bounce + 1 > most) {
                break;
            }
            let Some((found, _, through)) = reached else { break };
            let crossed = before.map_or(next.crossed, |before| before.crossed);
            before = Some(Passage { throughput: passed * step.weight.specular * through, crossed });
            (surface, segment) = (found, next);
        }
        Some(first)
    }

    /// Gathers light that arrives at a head by way of other surfaces and is scattered there.
    fn gather(&self, gathered: &mut Gathered, head: &Head<'_, 's>, weight: &Value, light: Arriving, crossed: bool) {
        self.add(gathered, head, weight, light, crossed, true);
    }

    /// Gathers light that arrives at a head and is scattered there, no more of it than may be where it is `indirect`.
    fn add(&self, gathered: &mut Gathered, head: &Head<'_, 's>, weight: &Value, light: Arriving, crossed: bool, indirect: bool) {
        let reflectance = head.vertex.bsdf.reflectance;
        let mirrored = Value { diffuse: Rgb::BLACK, specular: Rgb::WHITE };
        let (reflectance, weight, light, crossed) = match head.before {
            None => (reflectance, weight, light, crossed),
            Some(before) => (Rgb::BLACK, &mirrored, light.dimmed(before.throughput * weight.total(reflectance)), before.crossed),
        };
        let light = if indirect { self.clamped(light, weight.total(reflectance)) } else { light };
        gathered.light.diffuse += weight.diffuse * light.total;
        gathered.light.specular += weight.specular * light.total;
        if self.config.splits {
            gathered.split.add_scattered(reflectance, weight, &light, crossed);
        }
    }

    /// Gathers light that a second surface sends to a head.
    pub fn gather_shared(&self, batch: &mut Batch<'a, 's>, head: usize, weight: &Value, light: Arriving) {
        let head = &batch.heads[head];
        self.gather(&mut batch.gathered[head.camera], head, weight, light, false);
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

    /// What arrives along the `segment` that leaves a head in this `step`: the light that is for this path alone, and what others
    /// may use.
    fn second(
        &self,
        head: &Head<'_, 's>,
        step: &Step,
        segment: Segment,
        mut expected: f32,
        sampler: &Sampler,
    ) -> (Arriving, Option<Far<'a>>) {
        let bounce = head.bounce + 1;
        let mut own = Arriving::default();
        let direct = bounce == 1;
        let Some((surface, hit, throughput)) = self.next_surface(&segment, Rgb::WHITE, direct, &mut own) else { return (own, None) };
        if self.config.max_bounces.is_some_and(|most| bounce > most) {
            self.beyond_panes(segment, surface, throughput, direct, &mut own);
            return (own, None);
        }
        let bsdf = surface.bsdf(self.scene);
        if bsdf.is_black() {
            return (own, None);
        }
        let vertex = Vertex::new(self.guide, surface, bsdf);
        let direct = self.sample_lights(&vertex, sampler.set(light_set(bounce)), segment.medium);
        let so_far = for_roulette(throughput * head.passed() * step.weight.total(head.vertex.bsdf.reflectance));
        let reflectance = vertex.bsdf.reflectance;
        let onward = self.onward(bounce, &vertex, so_far, &segment, &mut expected, sampler).map(|(step, next)| {
            let wi = next.ray.direction;
            let density = next.sampled.filter(|_| !next.straight).map(|(_, pdf)| pdf * step.survival);
            let straight = next.straight && bounce == 1;
            let light = self.radiance(next, bounce + 1, straight, so_far * step.weight.total(reflectance), expected, sampler);
            Indirect { weight: step.weight, light, wi, density }
        });
        if let Some(reach) = Reach::new(&segment, step, &vertex.surface) {
            let far = Far::new(reach, &vertex, &hit, direct, onward, &mut own);
            return (own, far);
        }
        if let Some(Direct { weight, light, kind, .. }) = direct {
            own.add(kind, throughput * weight.total(reflectance) * light, false);
        }
        if let Some(Indirect { weight, light, .. }) = onward {
            own.add_dimmed(&light, throughput * weight.total(reflectance));
        }
        (own, None)
    }
}
