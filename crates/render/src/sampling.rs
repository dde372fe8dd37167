//! Takes the samples of a tile's pixels: each pixel's camera rays, followed in batches of pixels that share light.

use crate::batch::{Batch, CameraSample};
use crate::config::RenderConfig;
use crate::film::PixelSum;
use crate::integrator::Integrator;
use crate::lattice::lattice;
use crate::split::Split;
use enfilade_math::{Ray, Sampler};
use enfilade_scene::CameraView;

/// Makes the moment within the exposure independent of everything else that is random.
const SHUTTER_SEED: u64 = 0x5a07_7e12;

/// Adds samples to the pixels of a tile until each has its goal. `splits` is empty unless light is split.
pub(crate) fn add_samples(
    integrator: &Integrator<'_, '_>,
    view: &CameraView<'_>,
    pixels: &[(u32, u32)],
    goals: &[u32],
    sums: &mut [PixelSum],
    splits: &mut [Split],
) {
    // Take the samples one number after the other, from that of the pixel with the fewest to the largest goal.
    let config = integrator.config;
    let first = sums.iter().map(PixelSum::samples).min().unwrap_or(0);
    let last = goals.iter().copied().max().unwrap_or(0);
    let (mut batch, mut active, mut cameras) = (Batch::default(), Vec::new(), Vec::new());
    for index in first..last {
        // Group the pixels that take this sample by their lattices; without reuse each pixel is alone.
        active.clear();
        active
            .extend((0..pixels.len()).filter(|&i| sums[i].samples() == index && index < goals[i]).map(|i| (lattice(pixels[i], index), i)));
        active.sort_unstable();
        for members in active.chunk_by(|a, b| config.reuse && a.0 == b.0) {
            // Follow the paths of a group together, and add their samples to the pixels' sums.
            cameras.clear();
            cameras.extend(members.iter().map(|&(_, i)| camera_sample(config, view, pixels[i], index)));
            for (sample, &(_, i)) in integrator.samples(&cameras, &mut batch).zip(members) {
                sums[i].add(&sample);
                if let Some(split) = splits.get_mut(i) {
                    *split += &sample.split;
                }
            }
        }
    }
}

/// Sample number `index` of a pixel.
fn camera_sample(config: &RenderConfig, view: &CameraView<'_>, (x, y): (u32, u32), index: u32) -> CameraSample {
    let frame = view.pose().frame;
    let sampler = Sampler::new(config.seed, frame, x, y, index);
    let u = sampler.set(0);
    let offset = [u[0], u[1]].map(|u| f64::from(config.filter.offset(u, config.filter_radius)));
    let time = match view.camera().shutter {
        Some(_) => Sampler::new(config.seed ^ SHUTTER_SEED, frame, x, y, index).set(0)[0],
        None => 0.5,
    };
    let ray = view.ray(f64::from(x) + 0.5 + offset[0], f64::from(y) + 0.5 + offset[1], [u[2], u[3]], time);
    // Where the picture shows nothing it is black.
    let ray = ray.map(|ray| Ray::new(ray.origin.as_vec3(), ray.direction.as_vec3().normalize()));
    CameraSample { ray, sampler, index }
}
