//! Random walks to the surfaces that matter for a view: they start at its camera and continue by sampling BSDFs. What steers the samples of a
//! rendering is learned at the surfaces that they visit.

use crate::bsdf::Bsdf;
use crate::config::RenderConfig;
use crate::prepared::{AlphaTest, RenderScene};
use crate::surface::Surface;
use crate::texture::Cone;
use enfilade_math::{Ray, Rng};
use enfilade_scene::CameraView;

/// Samples that the pixels of all views will take in all: what is learned may cost a fraction of that.
pub(crate) fn pixel_samples(views: &[CameraView<'_>], config: &RenderConfig) -> u64 {
    let pixels = views.first().map_or(0, |view| view.camera().size().map(u64::from).iter().product::<u64>());
    pixels * u64::from(config.samples) * views.len() as u64
}

/// Follows a path from a random point of the picture over at most `vertices` surfaces, and calls `visit` at each.
pub(crate) fn walk(
    scene: &RenderScene<'_>,
    view: &CameraView<'_>,
    vertices: usize,
    mut rng: Rng,
    mut visit: impl FnMut(&Surface<'_>, &Bsdf<'_>, &mut Rng),
) {
    // Begin at a random image point, through the centre of the lens.
    let [x, y] = view.camera().size().map(|n| rng.next_f64() * f64::from(n));
    let Some(first) = view.centre_ray(x, y) else { return };
    let mut ray = Ray::new(first.origin.as_vec3(), first.direction.as_vec3());
    for _ in 0..vertices {
        // Visit the next surface.
        let Some(hit) = scene.closest(&ray, AlphaTest::Stochastic) else { return };
        let surface = scene.surface(&hit, ray.direction, &Cone::POINT);
        let bsdf = surface.bsdf(scene);
        visit(&surface, &bsdf, &mut rng);

        // Go on in a direction sampled from its BSDF.
        let onb = surface.onb();
        let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
        let Some(sample) = bsdf.sample(onb.to_local(surface.wo), u) else { return };
        ray = surface.ray(onb.to_world(sample.wi));
    }
}
