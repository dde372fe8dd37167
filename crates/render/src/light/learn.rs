//! Learns where the light of each source arrives, once for all cameras of a trajectory.

use super::choice::{Arrival, LightChoice};
use super::lights::Lights;
use super::sample::{LightPoint, LightSample};
use super::window::{Glimpses, Windows};
use crate::config::RenderConfig;
use crate::prepared::RenderScene;
use crate::surface::{self, Surface};
use crate::texture::Cone;
use crate::walk::{pixel_samples, walk};
use enfilade_math::{INV_PI, Onb, Ray, Rgb, Rng, Vec3, hash_u64, offset_origin, warp};
use enfilade_parallel::{flat_map_up_to, map_up_to};
use enfilade_scene::CameraView;

/// The most random walks for one camera and for many; small pictures learn from fewer.
const PATHS: u64 = 8192;
const MORE_PATHS: u64 = 65_536;
/// One walk for this many pixel samples.
const SAMPLES_PER_PATH: u64 = 64;
/// Rays from each surface that look for the sky.
const RAYS: usize = 8;
/// Surfaces that a walk visits.
const VERTICES: usize = 5;
/// The most sources tried at each surface; scenes with more try this many at random.
const TRIES: usize = 12;
/// Light samples for an estimate of the irradiance where there are more.
const FEW: usize = 4;

impl LightChoice {
    /// Learns from the points of view of a trajectory. The result depends only on the arguments, not on the number of threads.
    pub fn learn(scene: &RenderScene<'_>, views: &[CameraView<'_>], config: &RenderConfig) -> Self {
        let cameras = views.len() as u64;
        let samples = pixel_samples(views, config);
        let max = (PATHS + PATHS / 4 * cameras.saturating_sub(1)).min(MORE_PATHS);
        let paths = if cameras == 0 { 0 } else { (samples / SAMPLES_PER_PATH).clamp(128, max) };
        let rng = |purpose: u64, path: u64| Rng::new(hash_u64(config.seed ^ hash_u64(0x11_9417 ^ (purpose << 32) ^ path)));
        let view = |path: u64| &views[(path % cameras) as usize];

        // Walk through the scene and look for the sky from every surface: where it is seen, there are windows.
        let windows = if scene.lights.sky.is_some() {
            let seen: Vec<Glimpses> = map_up_to(paths as usize / 2, |path| glimpses(scene, view(path as u64), rng(0, path as u64)));
            let mut all = Glimpses::default();
            for mut one in seen {
                all.surfaces.append(&mut one.surfaces);
                all.escapes.append(&mut one.escapes);
            }
            Windows::find(&all)
        } else {
            None
        };

        // Walk again and try the sources, portals among them, at every surface.
        let arrivals: Vec<Arrival> = flat_map_up_to(paths as usize, |path| {
            let mut arrivals = Vec::new();
            walk(scene, view(path as u64), VERTICES, rng(1, path as u64), |surface, _, rng| {
                try_sources(scene, windows.as_ref(), surface, rng, &mut arrivals);
            });
            arrivals
        });
        Self::from_arrivals(&scene.lights, windows, &arrivals)
    }
}

/// The surfaces of a path, and where the sky is seen from there.
fn glimpses(scene: &RenderScene<'_>, view: &CameraView<'_>, rng: Rng) -> Glimpses {
    let mut seen = Glimpses::default();
    walk(scene, view, VERTICES, rng, |surface, _, rng| {
        seen.surfaces.push((surface.p, surface.ng));
        let onb = Onb::from_z(surface.ng);
        let escapes = (0..RAYS).filter_map(|k| {
            let u = [rng.next_f32(), rng.next_f32()];
            let d = if k < RAYS / 4 { scene.lights.sky.as_ref()?.sample(u)?.0 } else { onb.to_world(warp::cosine_hemisphere(u)) };
            let seen = d.dot(surface.ng) > 0.0 && !scene.transmittance(&surface.shadow_ray(d, None)).is_black();
            seen.then_some((surface.p, d))
        });
        seen.escapes.extend(escapes);
    });
    seen
}

fn try_sources(scene: &RenderScene<'_>, windows: Option<&Windows>, surface: &Surface<'_>, rng: &mut Rng, arrivals: &mut Vec<Arrival>) {
    let at = surface.light_point();
    let count = scene.lights.source_count(windows.map_or(0, Windows::len));
    for attempt in 0..count.min(TRIES) {
        let source = if count > TRIES { rng.below(count) } else { attempt };
        let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
        let value = contribution(scene, windows, surface, &at, source, u);
        arrivals.push(Arrival { at, source: source as u32, value: if value.is_finite() { value } else { 0.0 } });
    }
}

/// Estimate of the irradiance by a source. Light that both the sky and a portal can find is divided between them.
fn contribution(
    scene: &RenderScene<'_>,
    windows: Option<&Windows>,
    surface: &Surface<'_>,
    at: &LightPoint,
    source: usize,
    u: [f32; 3],
) -> f32 {
    let lights = &scene.lights;
    let from_all_sides = at.n == Vec3::ZERO;
    let wanted = |wi: Vec3| from_all_sides || wi.dot(surface.ng) > 0.0;
    let Some(light) = lights.sample_one(scene, source, windows, at, u, wanted, |_| 1.0) else { return 0.0 };
    let cos = light.wi.dot(surface.ns);
    let cos = if from_all_sides { cos.abs() } else { cos.max(0.0) };
    if cos <= 0.0 {
        return 0.0;
    }
    let arriving = arriving(scene, &surface.shadow_ray(light.wi, light.target), &light);
    if arriving.is_black() {
        return 0.0;
    }
    // A glint is met at its brightest too seldom for a few trials to show how bright it is. They show how much of it is in sight.
    if light.glint.is_some() {
        return lights.prior(source, windows, at);
    }
    (lights.radiance_of(scene, &light, &Cone::POINT, u[0]) * arriving).luminance() * cos / light.pdf
}

/// Transmittance along a shadow ray to a light sample: approximate through curved glass, which is enough for learning.
fn arriving(scene: &RenderScene<'_>, ray: &Ray, light: &LightSample) -> Rgb {
    let through = scene.transmittance(ray);
    if scene.bodies.any && light.is_delta && through.is_black() { scene.about_through_glass(ray) } else { through }
}

impl Lights<'_> {
    /// Estimate of the irradiance over π on a surface at `p` with the unit normal `n`: of each source separately if there are few, so that
    /// no source is rare.
    pub fn irradiance(&self, scene: &RenderScene<'_>, choice: &LightChoice, p: Vec3, n: Vec3, rng: &mut Rng) -> Rgb {
        let at = LightPoint { p, n };
        let origin = offset_origin(p, n);
        let windows = choice.windows();
        let count = self.source_count(windows.map_or(0, Windows::len));
        let facing = |wi: Vec3| wi.dot(n) > 0.0;
        let mut sum = Rgb::BLACK;
        let mut random = || [rng.next_f32(), rng.next_f32(), rng.next_f32()];
        let mut add = |light: &LightSample, pdf: f32| {
            let arriving = self.radiance_of(scene, light, &Cone::POINT, 0.5)
                * arriving(scene, &surface::shadow_ray(origin, light.wi, light.target), light);
            let value = arriving * (light.wi.dot(n) * INV_PI / pdf);
            if value.luminance().is_finite() {
                sum += value;
            }
        };
        if count <= TRIES {
            for source in 0..count {
                if let Some(light) = self.sample_one(scene, source, windows, &at, random(), facing, |_| 1.0) {
                    add(&light, light.pdf);
                }
            }
        } else {
            for _ in 0..FEW {
                if let Some(light) = self.sample(scene, choice, &at, random(), facing) {
                    add(&light, light.pdf * FEW as f32);
                }
            }
        }
        sum
    }
}
