//! One frame: every pixel's geometry and colour, tile by tile and pass by pass.

use crate::budget::{Budget, Estimate};
use crate::config::RenderConfig;
use crate::error::RenderError;
use crate::film::PixelSum;
use crate::geometry_pass::pixel_geometry;
use crate::guide::Guide;
use crate::integrator::{Integrator, PixelSample};
use crate::layers::{Pixel, layers};
use crate::prepared::RenderScene;
use crate::tiles::Tiles;
use enfilade_frame::Frame;
use enfilade_math::{Ray, Sampler};
use enfilade_scene::{CameraView, Cx};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Share of the samples that are spread evenly, to find out where the others are needed.
const FIRST_SHARE: u32 = 4;
/// The fewest samples that say anything about a pixel's error.
const FEWEST: u32 = 8;
/// Mean samples per pixel of a pass after the first.
const PASS: u32 = 16;
/// Makes the moment within the exposure independent of everything else that is random.
const SHUTTER_SEED: u64 = 0x5a07_7e12;

/// Renders every layer but the labels. The bytes depend on the arguments alone, whatever the number of threads.
///
/// # Errors
/// When the camera or the settings are not usable.
pub fn render_frame(
    scene: &RenderScene<'_>,
    guide: &Guide,
    view: &CameraView<'_>,
    config: &RenderConfig,
    cx: &dyn Cx,
) -> Result<Frame, RenderError> {
    let mut rendering = FrameRender::new(scene, guide, view, config)?;
    while !rendering.is_done() {
        rendering.pass(cx);
    }
    Ok(rendering.frame())
}

/// A frame in the making. After the first pass it can be looked at, kept, or ended at any time.
pub struct FrameRender<'a, 's> {
    integrator: Integrator<'a, 's>,
    view: CameraView<'a>,
    tiles: Tiles,
    /// Per tile, its pixels' sums so far.
    sums: Vec<Vec<PixelSum>>,
    /// Samples of every pixel in the end, row by row; before the first pass is done, those of that pass.
    wanted: Vec<u32>,
    first: u32,
    /// Passes done, and passes in all.
    done: u32,
    passes: u32,
}

impl<'a, 's> FrameRender<'a, 's> {
    /// A frame without samples.
    ///
    /// # Errors
    /// When the camera or the settings are not usable.
    pub fn new(scene: &'a RenderScene<'s>, guide: &'a Guide, view: &CameraView<'a>, config: &'a RenderConfig) -> Result<Self, RenderError> {
        check_camera(view)?;
        config.check()?;
        let [width, height] = view.camera().size();
        let tiles = Tiles::new(width, height);
        let sums = (0..tiles.count()).map(|t| vec![PixelSum::default(); tiles.pixels(t).count()]).collect();
        let spread = config.adaptive || config.noise.is_some();
        let first = if spread { (config.samples / FIRST_SHARE).max(FEWEST).min(config.samples) } else { config.samples.min(PASS) };
        let passes = 1 + (config.samples - first).div_ceil(PASS);
        let wanted = vec![first; width as usize * height as usize];
        // Half of what a pixel covers: many samples resolve more than one would.
        let pixel_angle = 0.5 * view.pixel_angle(0.5 * f64::from(width), 0.5 * f64::from(height));
        let integrator = Integrator { scene, config, guide, pixel_angle };
        Ok(Self { integrator, view: *view, tiles, sums, wanted, first, done: 0, passes })
    }

    /// True when every pixel has the samples that it should have.
    pub fn is_done(&self) -> bool {
        self.done == self.passes
    }

    /// Adds samples to all pixels: the first pass the same number to each, the others where they are needed.
    pub fn pass(&mut self, cx: &dyn Cx) {
        if self.is_done() {
            return;
        }
        let (later, all) = (u64::from(self.done), u64::from(self.passes) - 1);
        let goal = |wanted: u32| {
            if all == 0 { wanted } else { self.first.min(wanted) + (u64::from(wanted.saturating_sub(self.first)) * later / all) as u32 }
        };
        let (integrator, view, tiles, wanted) = (&self.integrator, &self.view, self.tiles, &self.wanted);
        let [width, _] = view.camera().size();
        let finished = AtomicU64::new(u64::from(self.done) * u64::from(tiles.count()));
        let total = u64::from(self.passes) * u64::from(tiles.count());
        self.sums.par_iter_mut().zip(0..tiles.count()).for_each(|(sums, tile)| {
            for (sum, (x, y)) in sums.iter_mut().zip(tiles.pixels(tile)) {
                let goal = goal(wanted[(y * width + x) as usize]);
                add_samples(integrator, view, (x, y), goal, sum);
            }
            cx.progress("rendering", finished.fetch_add(1, Ordering::Relaxed) + 1, total);
        });
        self.done += 1;
        if self.done == 1 && self.passes > 1 {
            self.wanted = self.share();
        }
    }

    /// The samples of every pixel in the end.
    fn share(&self) -> Vec<u32> {
        let config = self.integrator.config;
        if !config.adaptive && config.noise.is_none() {
            return vec![config.samples; self.wanted.len()];
        }
        let estimates: Vec<Vec<Estimate>> = self.sums.iter().map(|tile| tile.iter().map(PixelSum::estimate).collect()).collect();
        let budget = Budget { first: self.first, mean: config.samples, noise: config.noise };
        budget.share(self.view.camera().size()[0] as usize, &self.tiles.rows(&estimates))
    }

    /// Mean samples per pixel so far.
    pub fn samples(&self) -> f64 {
        let taken: u64 = self.sums.iter().flatten().map(|s| u64::from(s.samples())).sum();
        taken as f64 / self.wanted.len() as f64
    }

    /// The layers as they are now.
    pub fn frame(&self) -> Frame {
        let (scene, view, tiles) = (self.integrator.scene, &self.view, self.tiles);
        let pixels: Vec<Vec<Pixel>> = self
            .sums
            .par_iter()
            .zip(0..tiles.count())
            .map(|(sums, tile)| {
                let pixel = |(sum, (x, y)): (&PixelSum, _)| Pixel { color: sum.resolve(), geometry: pixel_geometry(scene, view, x, y) };
                sums.iter().zip(tiles.pixels(tile)).map(pixel).collect()
            })
            .collect();
        let [width, height] = view.camera().size();
        layers(width, height, &tiles.rows(&pixels))
    }
}

/// Adds samples to a pixel until it has `goal`.
fn add_samples(integrator: &Integrator<'_, '_>, view: &CameraView<'_>, (x, y): (u32, u32), goal: u32, sum: &mut PixelSum) {
    let (config, frame) = (integrator.config, view.pose().frame);
    for index in sum.samples()..goal {
        let sampler = Sampler::new(config.seed, frame, x, y, index);
        let u = sampler.set(0);
        let offset = [u[0], u[1]].map(|u| f64::from(config.filter.offset(u, config.filter_radius)));
        let time = match view.camera().shutter {
            Some(_) => Sampler::new(config.seed ^ SHUTTER_SEED, frame, x, y, index).set(0)[0],
            None => 0.5,
        };
        let ray = view.ray(f64::from(x) + 0.5 + offset[0], f64::from(y) + 0.5 + offset[1], [u[2], u[3]], time);
        // Where the picture shows nothing it is black.
        sum.add(&ray.map_or_else(PixelSample::default, |ray| {
            integrator.sample(Ray::new(ray.origin.as_vec3(), ray.direction.as_vec3().normalize()), &sampler, index)
        }));
    }
}

fn check_camera(view: &CameraView<'_>) -> Result<(), RenderError> {
    let pose = view.pose();
    let camera = |problem: String| Err(RenderError::Camera { frame: pose.frame, problem });
    if !pose.position.is_finite() || !pose.world_from_camera.is_finite() {
        return camera(format!("its pose is not finite: {pose:?}"));
    }
    view.camera().validate().or_else(|error| camera(error.to_string()))
}
