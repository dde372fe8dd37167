//! One frame: every pixel's geometry and colour, tile by tile and pass by pass.
//!
//! The first passes give every pixel equally many samples. The noise estimated from these decides how many more each pixel gets (see
//! [`crate::budget`]), and further passes take those. With a noise target there may be rounds of further passes, until the measured noise
//! is not above it.

use crate::budget::Budget;
use crate::config::RenderConfig;
use crate::error::RenderError;
use crate::film::{PixelSum, resolve_fixture, resolve_light_parts};
use crate::geometry_pass::pixel_geometry;
use crate::guide::Guide;
use crate::integrator::Integrator;
use crate::layers::{Pixel, add_fixture, add_light_parts, layers};
use crate::light_parts::LightParts;
use crate::partial::{self, Header, PartialError};
use crate::prepared::RenderScene;
use crate::rows::Rows;
use crate::sampling::add_samples;
use crate::tile_film::TileFilm;
use crate::tiles::Tiles;
use enfilade_frame::{Frame, f16, picture_noise};
use enfilade_math::Rgb;
use enfilade_parallel::{map, map_up_to};
use enfilade_scene::{CameraView, Cx};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// `samples` over this is what every pixel gets first, to find out where the others are needed.
const FIRST_DIVISOR: u32 = 4;
/// Least number of first samples: fewer are not enough to estimate a pixel's error.
const MIN_FIRST: u32 = 8;
/// Largest number of first samples with a noise target: `samples` may be far more than the target needs, and the 48 pixels around one, from
/// which its noise is estimated, have three thousand samples together.
const MAX_FIRST_FOR_NOISE: u32 = 64;

/// Renders every layer except the labels. The bytes depend only on the arguments, not on the number of threads.
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

/// A frame in the making. After any pass it can be looked at, kept as bytes, or ended.
///
/// ```
/// # use enfilade_frame::Layer;
/// # use enfilade_geometry::Mesh;
/// # use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
/// # use enfilade_scene::{Camera, CameraView, Environment, Intrinsics, Material, Part, Pose, Quiet, Scene};
/// use enfilade_render::{FrameRender, Guide, RenderConfig, RenderScene};
/// # let mesh = Mesh { positions: vec![Vec3::X, Vec3::ONE, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() };
/// # let scene = Scene {
/// #     meshes: vec![mesh.into()],
/// #     materials: vec![Material::diffuse("grey", Rgb::splat(0.5))],
/// #     parts: vec![Part { name: "part".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY }],
/// #     environment: Some(Environment::Constant { radiance: Rgb::WHITE }),
/// #     ..Scene::default()
/// # };
/// # let camera = Camera::from(Intrinsics::from_fov_x(16, 12, 1.0));
/// # let pose = Pose::look_at(0, DVec3::ZERO, DVec3::ONE, DVec3::Z).unwrap();
/// # let view = CameraView::still(&camera, &pose);
/// # let prepared = RenderScene::new(&scene, &Quiet)?;
/// let config = RenderConfig { samples: 32, adaptive: false, ..RenderConfig::default() };
/// let guide = Guide::learn(&prepared, &[view], &config);
/// let mut rendering = FrameRender::new(&prepared, &guide, &view, &config)?;
/// rendering.pass(&Quiet);
/// assert_eq!(rendering.samples(), 16.0);
///
/// // The key names everything that the frame depends on. A frame that continues from the saved bytes ends as if it had not been interrupted.
/// let saved = rendering.save(b"scene, view and settings");
/// let mut resumed = FrameRender::new(&prepared, &guide, &view, &config)?;
/// resumed.restore(&saved, b"scene, view and settings")?;
/// for frame in [&mut rendering, &mut resumed] {
///     frame.pass(&Quiet);
///     assert!(frame.is_done());
/// }
/// assert_eq!(rendering.frame().get(Layer::Color), resumed.frame().get(Layer::Color));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct FrameRender<'a, 's> {
    integrator: Integrator<'a, 's>,
    /// For equal stretches of the exposure, if something moves in it.
    exposed: Vec<Integrator<'a, 's>>,
    /// What the geometry layers show.
    rows: Rows<'a, 's>,
    view: CameraView<'a>,
    tiles: Tiles,
    /// Per tile, what its pixels have gathered.
    film: Vec<TileFilm>,
    /// Samples that each pixel is to have in the end, row by row; until the first samples are taken, their number.
    wanted: Vec<u32>,
    schedule: Schedule,
    /// Passes done.
    done: u32,
}

/// How a frame's samples are spread over passes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Schedule {
    /// Samples that every pixel gets, which show where further samples are needed.
    first: u32,
    /// Passes that take them.
    first_passes: u32,
    /// Passes in all.
    passes: u32,
}

impl Schedule {
    pub fn new(config: &RenderConfig) -> Self {
        let first = (config.samples / FIRST_DIVISOR).max(MIN_FIRST).min(config.samples);
        let first = match (config.noise, config.adaptive) {
            (Some(_), _) => first.min(MAX_FIRST_FOR_NOISE),
            (None, true) => first,
            (None, false) => config.samples,
        };
        let first_passes = first.div_ceil(FrameRender::PASS);
        Self { first, first_passes, passes: first_passes + (config.samples - first).div_ceil(FrameRender::PASS) }
    }

    /// The budget that decides how many samples each pixel gets, once the first are taken.
    pub fn budget(&self, config: &RenderConfig) -> Budget {
        Budget { first: self.first, mean: config.samples, noise: config.noise }
    }

    /// True when every pixel gets the same number of samples.
    pub fn is_even(&self) -> bool {
        self.passes == self.first_passes
    }

    /// Samples after pass number `pass` of a pixel that has `taken` some before it and is to have `wanted` in the end.
    fn goal(&self, pass: u32, taken: u32, wanted: u32) -> u32 {
        if pass < self.first_passes {
            return (u64::from(self.first) * u64::from(pass + 1) / u64::from(self.first_passes)) as u32;
        }
        taken + wanted.saturating_sub(taken) / (self.passes - pass)
    }
}

impl<'a, 's> FrameRender<'a, 's> {
    /// Mean samples per pixel of a pass at most: short enough to be interrupted after it.
    pub const PASS: u32 = 16;

    /// A frame without samples.
    ///
    /// # Errors
    /// When the camera or the settings are not usable.
    pub fn new(scene: &'a RenderScene<'s>, guide: &'a Guide, view: &CameraView<'a>, config: &'a RenderConfig) -> Result<Self, RenderError> {
        check_camera(view)?;
        config.validate()?;
        let [width, height] = view.camera().size();
        let tiles = Tiles::new(width, height);
        let fixtures = if config.fixtures { scene.fixtures().len() } else { 0 };
        let film = (0..tiles.count()).map(|tile| TileFilm::new(tiles.pixels(tile).count(), config.light_parts, fixtures)).collect();
        let schedule = Schedule::new(config);
        let wanted = vec![schedule.first; width as usize * height as usize];
        let integrator = integrator(scene, guide, view, config);
        Ok(Self { integrator, exposed: Vec::new(), rows: scene.into(), view: *view, tiles, film, wanted, schedule, done: 0 })
    }

    /// The frame with what moves blurred: each sample sees the scene, with its own guide, of the stretch of the exposure that it falls into.
    /// The stretches are equally long and in the order of time, from the first moment of the upper row to the last of the lower one; geometry
    /// stays that of the frame's own scene. Without a shutter all samples see the middle one.
    #[must_use]
    pub fn exposed(mut self, stretches: &'a [(RenderScene<'s>, Guide)]) -> Self {
        let config = self.integrator.config;
        self.exposed = stretches.iter().map(|(scene, guide)| integrator(scene, guide, &self.view, config)).collect();
        self
    }

    /// The frame whose geometry layers show another scene in each band of rows, as a rolling shutter does of what moves.
    #[must_use]
    pub fn in_rows(mut self, rows: Rows<'a, 's>) -> Self {
        self.rows = rows;
        self
    }

    /// True when every pixel has the samples that it should have.
    pub fn is_done(&self) -> bool {
        self.done >= self.schedule.passes
    }

    /// Adds about 16 samples per pixel: the first passes the same number to each, the others where they are needed.
    pub fn pass(&mut self, cx: &dyn Cx) {
        self.take(u32::MAX, cx);
    }

    /// Passes over the frame as [`FrameRender::pass`] does, but the first pass is done in parts, which take one sample per pixel and then
    /// double the number: for a frame that may have to end soon. In the end the samples are the same.
    pub fn short_pass(&mut self, cx: &dyn Cx) {
        let max = if self.done == 0 { self.begun().saturating_mul(2).max(1) } else { u32::MAX };
        self.take(max, cx);
    }

    /// Samples that every pixel has, as long as the first pass is not done.
    fn begun(&self) -> u32 {
        self.film.first().and_then(|film| film.sums.first()).map_or(0, PixelSum::samples)
    }

    /// Does the next pass, or the part of the first one up to `max` samples of every pixel.
    fn take(&mut self, max: u32, cx: &dyn Cx) {
        if self.is_done() {
            return;
        }
        // Say how far this call goes: in the first pass up to `goal` of its `whole` samples, in every other one to its end.
        let (view, tiles, wanted) = (&self.view, self.tiles, &self.wanted);
        let integrators = if self.exposed.is_empty() { std::slice::from_ref(&self.integrator) } else { &self.exposed };
        let (schedule, pass) = (self.schedule, self.done);
        let [width, _] = view.camera().size();
        let (begun, goal, whole) = match (pass, schedule.goal(0, 0, schedule.first)) {
            (0, whole) => (self.begun().min(whole), max.min(whole), whole),
            _ => (0, 1, 1),
        };

        // Take the samples, one tile per task. A tile's pixels depend on no other tile, so the order in which threads take them changes
        // nothing.
        let count = u64::from(tiles.count());
        let in_pass = |tiles: u64| (u64::from(begun) * count + u64::from(goal.saturating_sub(begun)) * tiles) / u64::from(whole);
        let (finished, before, total) = (AtomicU64::new(0), u64::from(pass) * count, u64::from(schedule.passes) * count);
        self.film.par_iter_mut().zip(0..tiles.count()).for_each(|(film, tile)| {
            // Also before the tile: a caller who ends the work here ends every thread before its next tile.
            cx.progress("rendering", before + in_pass(finished.load(Ordering::Relaxed)), total);
            let pixels: Vec<(u32, u32)> = tiles.pixels(tile).collect();
            let goal =
                |(&(x, y), sum): (&(u32, u32), &PixelSum)| schedule.goal(pass, sum.samples(), wanted[(y * width + x) as usize]).min(max);
            let goals: Vec<u32> = pixels.iter().zip(&film.sums).map(goal).collect();
            add_samples(integrators, view, &pixels, &goals, film);
            cx.progress("rendering", before + in_pass(finished.fetch_add(1, Ordering::Relaxed) + 1), total);
        });
        if goal < whole {
            return;
        }

        // After the first samples, decide from their noise how many each pixel is to have in the end.
        self.done += 1;
        if self.done == schedule.first_passes && !self.is_done() {
            let budget = schedule.budget(self.integrator.config);
            let wanted = budget.allocate(width as usize, &self.rows(PixelSum::estimate));
            self.settle(wanted);
        }

        // When these are taken and the noise is still above its target, continue.
        if self.is_done()
            && schedule.first_passes < schedule.passes
            && let Some(wanted) = self.more()
        {
            self.settle(wanted);
        }
    }

    /// Sets the samples that each pixel is to have in the end, and with a noise target the number of passes that they take.
    fn settle(&mut self, wanted: Vec<u32>) {
        if self.integrator.config.noise.is_some() {
            let taken = self.rows(PixelSum::samples);
            let later: u64 = wanted.iter().zip(&taken).map(|(&wanted, &taken)| u64::from(wanted.saturating_sub(taken))).sum();
            let per_pass = u64::from(Self::PASS) * wanted.len() as u64;
            self.schedule.passes = self.done + later.div_ceil(per_pass) as u32;
        }
        self.wanted = wanted;
    }

    /// More samples for every pixel where the noise is above its target; `None` where it is not, or where no more may be taken.
    fn more(&self) -> Option<Vec<u32>> {
        let config = self.integrator.config;
        let measured = self.noise().filter(|noise| config.noise.is_some_and(|target| *noise > f64::from(target)))?;
        let (estimates, taken) = (self.rows(PixelSum::estimate), self.rows(PixelSum::samples));
        self.schedule.budget(config).more(self.view.camera().size()[0] as usize, &estimates, &taken, measured)
    }

    /// A value of every pixel, row by row.
    fn rows<T: Copy + Default + Send>(&self, value: impl Fn(&PixelSum) -> T + Sync) -> Vec<T> {
        let values: Vec<Vec<T>> = map(&self.film, |film| film.sums.iter().map(&value).collect());
        self.tiles.rows(&values)
    }

    /// Mean samples per pixel so far.
    pub fn samples(&self) -> f64 {
        let taken: u64 = self.film.iter().flat_map(|film| &film.sums).map(|sum| u64::from(sum.samples())).sum();
        taken as f64 / self.wanted.len() as f64
    }

    /// The current noise, as [`Frame::noise`] measures it in the finished frame; `None` after one sample per pixel, which is not enough.
    pub fn noise(&self) -> Option<f64> {
        let stored = |sum: &PixelSum| -> ([f16; 3], f16) {
            let pixel = sum.resolve();
            (pixel.color, pixel.standard_error)
        };
        picture_noise(self.rows(stored).into_iter())
    }

    /// True when the frame is done with fewer samples than it might have taken, because fewer were enough for the noise target: it has at
    /// most the requested noise.
    pub fn met_noise_target(&self) -> bool {
        let config = self.integrator.config;
        let Some(target) = config.noise else { return false };
        let is_met = |noise: f64| noise <= f64::from(target);
        self.is_done() && self.samples() < 0.999 * f64::from(config.samples) && self.noise().is_some_and(is_met)
    }

    /// All of it as bytes, for [`FrameRender::restore`]. `key` names everything that the frame depends on.
    pub fn save(&self, key: &[u8]) -> Vec<u8> {
        let header = Header { done: self.done, passes: self.schedule.passes, ..self.header(key) };
        let sums = self.film.iter().flat_map(|film| &film.sums).flat_map(|sum| sum.to_words());
        let light_parts = self.film.iter().flat_map(|film| &film.light_parts).flat_map(|parts| parts.to_words());
        let fixtures = self.film.iter().flat_map(|film| film.fixtures.as_flattened()).flat_map(|light| light.to_array()).map(f32::to_bits);
        partial::write(&header, self.wanted.iter().copied().chain(sums).chain(light_parts).chain(fixtures))
    }

    /// Continues from where [`FrameRender::save`] was called, in this process or another. The frame must be a new one of the same scene,
    /// guide, view and configuration, identified by `key`.
    ///
    /// # Errors
    /// If the bytes are damaged, or not of this frame. Then this frame is unchanged.
    pub fn restore(&mut self, bytes: &[u8], key: &[u8]) -> Result<(), PartialError> {
        let (header, mut words) = partial::read(bytes)?;
        let expected = Header { done: header.done, passes: header.passes, ..self.header(key) };
        if header != expected || header.done > header.passes {
            return Err(PartialError::OtherFrame);
        }
        let per_pixel = 1 + PixelSum::WORDS + if header.light_parts { LightParts::WORDS } else { 0 } + 6 * header.fixtures as usize;
        if words.len() != self.wanted.len() * per_pixel {
            return Err(PartialError::Damaged);
        }
        let mut next = || words.next().unwrap_or_default();
        (self.done, self.schedule.passes) = (header.done, header.passes);
        self.wanted.iter_mut().for_each(|wanted| *wanted = next());
        let sums = self.film.iter_mut().flat_map(|film| &mut film.sums);
        sums.for_each(|sum| *sum = PixelSum::from_words(&std::array::from_fn(|_| next())));
        let light_parts = self.film.iter_mut().flat_map(|film| &mut film.light_parts);
        light_parts.for_each(|parts| *parts = LightParts::from_words(&std::array::from_fn(|_| next())));
        let fixtures = self.film.iter_mut().flat_map(|film| film.fixtures.as_flattened_mut());
        fixtures.for_each(|light| *light = Rgb::from([0; 3].map(|_: u32| f32::from_bits(next()))));
        Ok(())
    }

    /// The header before the pixels of this frame, before the first pass.
    fn header<'k>(&self, key: &'k [u8]) -> Header<'k> {
        let fixtures = self.film.first().map_or(0, |film| film.fixture_count) as u32;
        Header { size: self.view.camera().size(), done: 0, passes: 0, light_parts: self.integrator.config.light_parts, fixtures, key }
    }

    /// The current layers, except the labels and those of [`crate::add_extra_layers`].
    pub fn frame(&self) -> Frame {
        // Resolve the sums of every pixel, and find the geometry at its centre.
        let (view, tiles) = (&self.view, self.tiles);
        let pixels: Vec<Vec<Pixel>> = map_up_to(self.film.len(), |tile| {
            let pixel = |(sum, (x, y)): (&PixelSum, _)| Pixel {
                color: sum.resolve(),
                guides: sum.guides(),
                geometry: pixel_geometry(self.rows.at(f64::from(y) + 0.5), view, x, y),
            };
            self.film[tile].sums.iter().zip(tiles.pixels(tile as u32)).map(pixel).collect()
        });

        // Arrange them as layers, row by row.
        let [width, height] = view.camera().size();
        let mut frame = layers(width, height, &tiles.rows(&pixels));
        if self.integrator.config.light_parts {
            let resolved = |film: &TileFilm| {
                film.light_parts.iter().zip(&film.sums).map(|(parts, sum)| resolve_light_parts(parts, sum.samples())).collect()
            };
            let parts: Vec<Vec<_>> = map(&self.film, resolved);
            add_light_parts(&mut frame, &tiles.rows(&parts));
        }
        for fixture in 0..self.film.first().map_or(0, |film| film.fixture_count) {
            let resolved = |film: &TileFilm| film.of_fixture(fixture).map(|(sum, light)| resolve_fixture(sum, light)).collect();
            let lights: Vec<Vec<_>> = map(&self.film, resolved);
            add_fixture(&mut frame, &tiles.rows(&lights));
        }
        frame
    }
}

/// The integrator for the pixels of a view.
pub(crate) fn integrator<'a, 's>(
    scene: &'a RenderScene<'s>,
    guide: &'a Guide,
    view: &CameraView<'_>,
    config: &'a RenderConfig,
) -> Integrator<'a, 's> {
    let [width, height] = view.camera().size();
    // Half of what a pixel covers: many samples resolve more than one would.
    let pixel_angle = 0.5 * view.pixel_angle(0.5 * f64::from(width), 0.5 * f64::from(height));
    Integrator { scene, config, guide, pixel_angle }
}

pub(crate) fn check_camera(view: &CameraView<'_>) -> Result<(), RenderError> {
    let pose = view.pose();
    let camera = |problem: String| Err(RenderError::Camera { frame: pose.frame, problem });
    if !pose.position.is_finite() || !pose.world_from_camera.is_finite() {
        return camera(format!("its pose is not finite: {pose:?}"));
    }
    view.camera().validate().or_else(|error| camera(error.to_string()))
}
