//! Which source a point samples: learned, per frame, from where each source's light arrives.
//!
//! In a room most light is in shadow: the sun is the strongest source and reaches one patch of floor. A few thousand paths from
//! the frame's camera visit the places that matter and try every source there; a grid of cells keeps what arrived. Samples then
//! go to sources in proportion to the root mean square of their contribution, which minimises the variance of the sum, and a
//! fixed share is spread over all sources, so that nothing that was missed is lost: the choice changes noise, never the mean.

use super::Lights;
use crate::config::RenderConfig;
use crate::geometry_pass::camera_ray;
use crate::prepared::{Cutout, RenderScene};
use enfilade_math::{Bounds3, ONE_MINUS_EPSILON, Ray, Rng, Vec3, hash_u64, offset_origin};
use enfilade_scene::{Intrinsics, Pose};
use rayon::prelude::*;

/// Paths that learn, at most; small pictures learn from fewer.
const PATHS: u64 = 8192;
/// Surfaces that a path visits.
const VERTICES: usize = 5;
/// Sources tried at each; scenes with more try this many at random.
const TRIES: usize = 12;
/// Cells along the longest side of what the paths visited.
const CELLS: f32 = 24.0;
/// No cell is smaller, in metres.
const MIN_CELL: f32 = 0.2;
/// Share of the samples that ignores what was learned.
const PRIOR_SHARE: f32 = 0.15;

/// Probabilities of the sources over a grid of cells.
#[derive(Debug)]
pub(crate) struct LightChoice {
    origin: Vec3,
    cell_size: f32,
    /// Cells along x, y and z.
    size: [usize; 3],
    sources: usize,
    /// `sources` numbers a cell, which sum to one.
    probabilities: Vec<f32>,
}

/// What arrived from a source at a point.
struct Arrival {
    p: Vec3,
    source: u32,
    /// Estimate of the irradiance, cosine included.
    value: f32,
}

impl LightChoice {
    /// Learns from the point of view of a frame. Depends on the seed and frame number only, like everything random.
    pub fn learn(scene: &RenderScene<'_>, intrinsics: &Intrinsics, pose: &Pose, config: &RenderConfig) -> Self {
        let samples = u64::from(intrinsics.width) * u64::from(intrinsics.height) * u64::from(config.samples);
        let paths = (samples / 64).clamp(128, PATHS);
        let arrivals: Vec<Arrival> = (0..paths)
            .into_par_iter()
            .flat_map_iter(|path| {
                let seed = hash_u64(config.seed ^ hash_u64(0x11_9417 ^ (u64::from(pose.frame) << 32) ^ path));
                walk(scene, intrinsics, pose, Rng::new(seed))
            })
            .collect();
        Self::from_arrivals(&scene.lights, &arrivals)
    }

    fn from_arrivals(lights: &Lights<'_>, arrivals: &[Arrival]) -> Self {
        let bounds = Bounds3::from_points(arrivals.iter().map(|a| a.p));
        let bounds = if bounds.is_empty() { Bounds3 { min: Vec3::ZERO, max: Vec3::ZERO } } else { bounds };
        let cell_size = (bounds.extent().max_element() / CELLS).max(MIN_CELL);
        let size = (bounds.extent() / cell_size).to_array().map(|n| n as usize + 1);
        let sources = lights.source_count();
        let mut grid = Self { origin: bounds.min, cell_size, size, sources, probabilities: Vec::new() };

        let mut squares = vec![0.0f32; size.iter().product::<usize>() * sources];
        let mut counts = squares.clone();
        for a in arrivals {
            let i = grid.cell(a.p) * sources + a.source as usize;
            squares[i] += a.value * a.value;
            counts[i] += 1.0;
        }
        grid.probabilities = (0..size.iter().product()).flat_map(|cell| grid.cell_probabilities(lights, cell, &squares, &counts)).collect();
        grid
    }

    /// A cell's probabilities, from itself and, less, its neighbours.
    fn cell_probabilities(&self, lights: &Lights<'_>, cell: usize, squares: &[f32], counts: &[f32]) -> Vec<f32> {
        let [nx, ny, nz] = self.size;
        let (x, y, z) = (cell % nx, cell / nx % ny, cell / (nx * ny));
        let mut square = vec![0.0f32; self.sources];
        let mut count = vec![0.0f32; self.sources];
        for cz in z.saturating_sub(1)..nz.min(z + 2) {
            for cy in y.saturating_sub(1)..ny.min(y + 2) {
                for cx in x.saturating_sub(1)..nx.min(x + 2) {
                    let weight = if (cx, cy, cz) == (x, y, z) { 1.0 } else { 0.15 };
                    let other = ((cz * ny + cy) * nx + cx) * self.sources;
                    for s in 0..self.sources {
                        square[s] += weight * squares[other + s];
                        count[s] += weight * counts[other + s];
                    }
                }
            }
        }
        let learned: Vec<f32> = square.iter().zip(&count).map(|(q, n)| if *n > 0.0 { (q / n).sqrt() } else { 0.0 }).collect();
        let center = self.origin + Vec3::new(x as f32 + 0.5, y as f32 + 0.5, z as f32 + 0.5) * self.cell_size;
        let prior: Vec<f32> = (0..self.sources).map(|s| lights.prior(s, center)).collect();
        let (learned_sum, prior_sum) = (learned.iter().sum::<f32>(), prior.iter().sum::<f32>());
        let prior_share = if learned_sum > 0.0 { PRIOR_SHARE } else { 1.0 };
        (0..self.sources)
            .map(|s| {
                let uniform = 1.0 / self.sources as f32;
                let by_prior = if prior_sum > 0.0 { 0.5 * prior[s] / prior_sum + 0.5 * uniform } else { uniform };
                let by_learning = if learned_sum > 0.0 { learned[s] / learned_sum } else { 0.0 };
                prior_share * by_prior + (1.0 - prior_share) * by_learning
            })
            .collect()
    }

    /// A source for `u` uniform on [0,1), its probability, and `u` renewed. `None` when there is no source.
    #[inline]
    pub fn sample(&self, p: Vec3, u: f32) -> Option<(usize, f32, f32)> {
        let first = self.cell(p) * self.sources;
        let mut rest = u;
        let cell = &self.probabilities[first..first + self.sources];
        for (source, &probability) in cell.iter().enumerate() {
            if rest < probability || source + 1 == self.sources {
                return Some((source, probability, (rest / probability).min(ONE_MINUS_EPSILON)));
            }
            rest -= probability;
        }
        None
    }

    /// The probability of a source at a point.
    #[inline]
    pub fn probability(&self, p: Vec3, source: usize) -> f32 {
        self.probabilities[self.cell(p) * self.sources + source]
    }

    #[inline]
    fn cell(&self, p: Vec3) -> usize {
        let at = (p - self.origin) / self.cell_size;
        let index = |v: f32, n: usize| (v.max(0.0) as usize).min(n - 1);
        let [nx, ny, nz] = self.size;
        (index(at.z, nz) * ny + index(at.y, ny)) * nx + index(at.x, nx)
    }
}

/// Follows a path and tries the sources at each of its surfaces.
fn walk(scene: &RenderScene<'_>, intrinsics: &Intrinsics, pose: &Pose, mut rng: Rng) -> Vec<Arrival> {
    let mut arrivals = Vec::new();
    let (x, y) = (rng.next_f64() * f64::from(intrinsics.width), rng.next_f64() * f64::from(intrinsics.height));
    let (origin, direction) = camera_ray(intrinsics, pose, x, y);
    let mut ray = Ray::new(origin.as_vec3(), direction.as_vec3());
    for _ in 0..VERTICES {
        let Some(hit) = scene.closest(&ray, Cutout::Random) else { break };
        let surface = scene.surface(&hit, ray.direction);
        try_sources(scene, &surface, &mut rng, &mut arrivals);
        let bsdf = surface.bsdf(scene);
        let onb = surface.onb();
        let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
        let Some(sample) = bsdf.sample(onb.to_local(surface.wo), u) else { break };
        let next = onb.to_world(sample.wi);
        let side = if next.dot(surface.ng) < 0.0 { -surface.ng } else { surface.ng };
        ray = Ray::new(offset_origin(surface.p, side), next);
    }
    arrivals
}

fn try_sources(scene: &RenderScene<'_>, surface: &crate::surface::Surface<'_>, rng: &mut Rng, arrivals: &mut Vec<Arrival>) {
    let lights = &scene.lights;
    let count = lights.source_count();
    for attempt in 0..count.min(TRIES) {
        let source = if count > TRIES { rng.below(count) } else { attempt };
        let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
        let wanted = |wi: Vec3| wi.dot(surface.ng) > 0.0;
        let value = lights.sample_source(scene, source, surface.p, u, wanted).map_or(0.0, |light| {
            let arriving = scene.transmittance(&surface.shadow_ray(light.wi, light.target));
            (lights.radiance_of(&light) * arriving).luminance() * light.wi.dot(surface.ns).max(0.0) / light.pdf
        });
        arrivals.push(Arrival { p: surface.p, source: source as u32, value: if value.is_finite() { value } else { 0.0 } });
    }
}
