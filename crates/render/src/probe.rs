//! A few pixels of a frame, rendered to estimate the cost of the whole frame.
//!
//! A pixel's samples depend on its position and on no other pixel. So a probe takes the same samples as the frame will, and finds the same
//! noise.

use crate::budget::Estimate;
use crate::config::RenderConfig;
use crate::error::RenderError;
use crate::film::PixelSum;
use crate::guide::Guide;
use crate::integrator::Integrator;
use crate::prepared::RenderScene;
use crate::render::{Schedule, check_camera, integrator};
use crate::sampling::add_samples;
use crate::tile_film::TileFilm;
use enfilade_scene::CameraView;

/// A square of pixels of a frame.
pub struct Probe<'a, 's> {
    integrator: Integrator<'a, 's>,
    view: CameraView<'a>,
    corner: [u32; 2],
    film: TileFilm,
}

impl<'a, 's> Probe<'a, 's> {
    /// Side of the square in pixels.
    pub const SIDE: u32 = 8;

    /// The square whose upper left pixel is `corner`, or near it where it would leave the image, without samples.
    ///
    /// # Errors
    /// When the camera or the settings are not usable, or the image is smaller than a probe.
    pub fn new(
        scene: &'a RenderScene<'s>,
        guide: &'a Guide,
        view: &CameraView<'a>,
        config: &'a RenderConfig,
        corner: [u32; 2],
    ) -> Result<Self, RenderError> {
        check_camera(view)?;
        config.validate()?;
        let size = view.camera().size();
        if size[0] < Self::SIDE || size[1] < Self::SIDE {
            let problem = format!("its image has {}x{} pixels; a forecast needs 8x8", size[0], size[1]);
            return Err(RenderError::Camera { frame: view.pose().frame, problem });
        }
        let corner = [0, 1].map(|axis| corner[axis].min(size[axis] - Self::SIDE));
        let film = TileFilm::new((Self::SIDE * Self::SIDE) as usize, false, 0);
        Ok(Self { integrator: integrator(scene, guide, view, config), view: *view, corner, film })
    }

    /// Takes samples until every pixel has `samples`.
    pub fn take(&mut self, samples: u32) {
        let [x, y] = self.corner;
        let pixels: Vec<(u32, u32)> = (0..Self::SIDE * Self::SIDE).map(|i| (x + i % Self::SIDE, y + i / Self::SIDE)).collect();
        add_samples(std::slice::from_ref(&self.integrator), &self.view, &pixels, &vec![samples; pixels.len()], &mut self.film);
    }
}

/// The mean samples per pixel that a frame will take around each of its probes, by what they have found out about its noise.
pub fn samples_wanted(config: &RenderConfig, probes: &[Probe<'_, '_>]) -> Vec<f64> {
    let pixels = (Probe::SIDE * Probe::SIDE) as usize;
    let schedule = Schedule::new(config);
    if schedule.is_even() {
        return vec![f64::from(config.samples); probes.len()];
    }
    // The probes count as one image, one below the other. Where two meet, pixels count as neighbours that are none in the frame, which
    // changes the answer a little.
    let estimates: Vec<Estimate> = probes.iter().flat_map(|probe| &probe.film.sums).map(PixelSum::estimate).collect();
    let wanted = schedule.budget(config).allocate(Probe::SIDE as usize, &estimates);
    wanted.chunks(pixels).map(|probe| probe.iter().map(|n| f64::from(*n)).sum::<f64>() / pixels as f64).collect()
}
