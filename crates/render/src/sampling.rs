//! Takes the samples of a tile's pixels.

use crate::config::RenderConfig;
use crate::integrator::Integrator;
use crate::pixel_sample::CameraSample;
use crate::tile_film::TileFilm;
use enfilade_math::{Ray, Sampler};
use enfilade_scene::CameraView;

/// Makes the moment within the exposure independent of everything else that is random.
const SHUTTER_SEED: u64 = 0x5a07_7e12;

/// Adds samples to the pixels of a tile until each has its goal. There is an integrator for each of equal stretches of the whole exposure.
pub(crate) fn add_samples(
    integrators: &[Integrator<'_, '_>],
    view: &CameraView<'_>,
    pixels: &[(u32, u32)],
    goals: &[u32],
    film: &mut TileFilm,
) {
    for (i, &pixel) in pixels.iter().enumerate() {
        for index in film.sums[i].samples()..goals[i] {
            let (sample, share) = camera_sample(integrators[0].config, view, pixel, index);
            // Filters reach beyond the borders.
            let integrator = &integrators[((share * integrators.len() as f32) as usize).min(integrators.len() - 1)];
            film.add(i, &integrator.sample(&sample));
        }
    }
}

/// Sample number `index` of a pixel, and its moment as a share of the whole exposure, on [0,1).
fn camera_sample(config: &RenderConfig, view: &CameraView<'_>, (x, y): (u32, u32), index: u32) -> (CameraSample, f32) {
    let frame = view.pose().frame;
    let sampler = Sampler::new(config.seed, frame, x, y, index);
    let u = sampler.set(0);
    let offset = [u[0], u[1]].map(|u| f64::from(config.filter.offset(u, config.filter_radius)));
    let time = match view.camera().shutter {
        Some(_) => Sampler::new(config.seed ^ SHUTTER_SEED, frame, x, y, index).set(0)[0],
        None => 0.5,
    };
    let [x, y] = [f64::from(x) + 0.5 + offset[0], f64::from(y) + 0.5 + offset[1]];
    let ray = view.ray(x, y, [u[2], u[3]], time);
    // Where the picture shows nothing it is black.
    let ray = ray.map(|ray| Ray::new(ray.origin.as_vec3(), ray.direction.as_vec3().normalize()));
    (CameraSample { ray, sampler, index }, view.exposure_share(y, time))
}
