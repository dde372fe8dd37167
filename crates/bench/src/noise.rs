//! How much noise a second of rendering leaves: the number by which path tracers are compared.
//!
//! `noise [SCENE | home]… [--samples N] [--max-bounces N] [--even] [--unguided]` renders each scene's first camera at 256×192 twice, with
//! different seeds, and prints the error (mean of variance / (mean² + 0.01), the image scaled to a mean of 0.5, the worst 0.1 % left out),
//! the samples per core-second, and error × core-seconds per megapixel, which does not depend on the number of samples.

use anyhow::{Context, Result};
use enfilade_frame::tonemap::ToneMap;
use enfilade_frame::{Frame, Layer};
use enfilade_pipeline::Stopwatch;
use enfilade_render::{Guide, RenderConfig, RenderScene, render_frame};
use enfilade_scene::{Camera, CameraView, Intrinsics, Quiet, Scene};

const WIDTH: u32 = 256;
const HEIGHT: u32 = 192;

/// Runs the instrument.
pub fn run() -> Result<()> {
    let mut config = RenderConfig { samples: 32, ..RenderConfig::default() };
    let mut scenes = Vec::new();
    let mut arguments = crate::arguments::arguments();
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--samples" => config.samples = arguments.next().context("--samples needs a number")?.parse()?,
            "--max-bounces" => config.max_bounces = Some(arguments.next().context("--max-bounces needs a number")?.parse()?),
            "--even" => config.adaptive = false,
            "--unguided" => config.guiding = false,
            _ => scenes.push(argument),
        }
    }
    for scene in crate::arguments::scenes(scenes) {
        let (name, scene) = scene?;
        measure(&name, &scene, &config)?;
    }
    Ok(())
}

fn measure(name: &str, scene: &Scene, config: &RenderConfig) -> Result<()> {
    let camera = scene.cameras.first().with_context(|| format!("{name} has no camera"))?;
    let taken_with = Camera::from(Intrinsics::from_fov_x(WIDTH, HEIGHT, camera.fov_x_rad));
    let view = CameraView::still(&taken_with, &camera.pose(0));
    let prepared = RenderScene::new(scene, &Quiet)?;
    let time = Stopwatch::start();
    let mut learned = 0.0;
    let mut pictures = Vec::new();
    for seed in 0..2 {
        let config = RenderConfig { seed, ..config.clone() };
        let learning = Stopwatch::start();
        let guide = Guide::learn(&prepared, &[view], &config);
        learned += learning.cpu_s();
        pictures.push(luminance(&render_frame(&prepared, &guide, &view, &config, &Quiet)?));
    }
    let samples = config.samples;
    let seconds = time.cpu_s() / 2.0;
    let megapixels = f64::from(WIDTH * HEIGHT) / 1e6;
    let error = relative_error(&pictures[0], &pictures[1]);
    let delivered = tone_mapped_noise(&pictures[0], &pictures[1]);
    println!(
        "{name}: error {error:.4} at {samples} samples, {:.3} M samples per core-second, error x time {:.2}; tone-mapped noise {:.2} %, squared x \
         time {:.2}; learning took {:.2} core-seconds",
        megapixels * f64::from(samples) / seconds,
        error * seconds / megapixels,
        100.0 * delivered,
        1e3 * delivered.powi(2) * seconds / megapixels,
        learned / 2.0
    );
    Ok(())
}

/// The root mean square of the standard error of the tone-mapped value, over its mean.
fn tone_mapped_noise(a: &[f64], b: &[f64]) -> f64 {
    let tone = ToneMap::fit(a.iter().zip(b).map(|(a, b)| 0.5 * (a + b)).collect());
    let (mut variance, mut mean) = (0.0, 0.0);
    for (&a, &b) in a.iter().zip(b) {
        let (a, b) = (tone.apply(a), tone.apply(b));
        variance += 0.5 * (a - b).powi(2);
        mean += 0.5 * (a + b);
    }
    (variance * a.len() as f64).sqrt() / mean
}

fn luminance(frame: &Frame) -> Vec<f64> {
    let values = frame.get(Layer::Color).expect("every rendered frame has color");
    (0..frame.pixels()).map(|p| 0.2126 * values.get(3 * p) + 0.7152 * values.get(3 * p + 1) + 0.0722 * values.get(3 * p + 2)).collect()
}

fn relative_error(a: &[f64], b: &[f64]) -> f64 {
    let scale = 0.5 * a.len() as f64 / a.iter().sum::<f64>();
    let mut errors: Vec<f64> = a
        .iter()
        .zip(b)
        .map(|(&a, &b)| {
            let (a, b) = (a * scale, b * scale);
            let mean = 0.5 * (a + b);
            0.5 * (a - b).powi(2) / (mean * mean + 0.01)
        })
        .collect();
    errors.sort_by(f64::total_cmp);
    errors.truncate(errors.len() * 999 / 1000);
    errors.iter().sum::<f64>() / errors.len() as f64
}
