//! Renders a scene through its own camera and compares the picture with another renderer's.
//!
//! `against-reference SCENE REFERENCE.exr [SAMPLES] [SIDE_BY_SIDE.png]` prints the mean relative difference of the means of
//! 16×16-pixel blocks and writes both pictures, reference on the left, at one exposure.

use anyhow::{Context, Result, bail};
use enfilade_frame::{Frame, Layer};
use enfilade_import::{ImportOptions, load};
use enfilade_render::{Guide, RenderConfig, RenderScene, render_frame};
use enfilade_scene::{Camera, CameraView, Intrinsics, Quiet};
use std::path::Path;
use std::time::Instant;

/// Side of a block in pixels: large enough to average noise out, small enough to see a shifted shadow.
const BLOCK: usize = 16;

/// Runs the instrument.
pub fn run() -> Result<()> {
    let arguments: Vec<String> = crate::arguments::arguments().collect();
    let [scene_file, reference_file, rest @ ..] = arguments.as_slice() else {
        bail!("usage: against-reference SCENE REFERENCE.exr [SAMPLES] [SIDE_BY_SIDE.png]");
    };
    let samples = rest.first().map_or(Ok(64), |s| s.parse()).context("SAMPLES must be a whole number")?;
    let reference = read_exr(Path::new(reference_file))?;
    let started = Instant::now();
    let imported = load(Path::new(scene_file), &ImportOptions::default(), &Quiet)?;
    for warning in &imported.report.warnings {
        println!("  {warning}");
    }
    let camera = imported.scene.cameras.first().context("the scene has no camera")?;
    let (width, height) = (reference.width as u32, reference.height as u32);
    let taken_with = Camera::from(Intrinsics::from_fov_x(width, height, camera.fov_x_rad));
    let prepared = RenderScene::new(&imported.scene, &Quiet)?;
    println!("{} triangles, loaded in {:.2} s", prepared.triangle_count(), started.elapsed().as_secs_f64());
    let started = Instant::now();
    let config = RenderConfig { samples, ..RenderConfig::default() };
    let view = CameraView::still(&taken_with, &camera.pose(0));
    let guide = Guide::learn(&prepared, &[view], &config);
    let frame = render_frame(&prepared, &guide, &view, &config, &Quiet)?;
    let seconds = started.elapsed().as_secs_f64();
    let millions = f64::from(width * height) * f64::from(samples) / 1e6;
    println!("{samples} samples per pixel in {seconds:.1} s: {:.2} M samples per second", millions / seconds);
    let ours = Picture::from_frame(&frame);
    report(&ours, &reference);
    if let Some(path) = rest.get(1) {
        side_by_side(&reference, &ours).save(path)?;
    }
    Ok(())
}

/// Linear RGB, row by row.
struct Picture {
    width: usize,
    height: usize,
    rgb: Vec<[f32; 3]>,
}

impl Picture {
    fn from_frame(frame: &Frame) -> Self {
        let values = frame.get(Layer::Color).expect("every rendered frame has color");
        let rgb = (0..frame.pixels()).map(|p| std::array::from_fn(|c| values.get(3 * p + c) as f32)).collect();
        Self { width: frame.width as usize, height: frame.height as usize, rgb }
    }

    /// Mean luminance of each whole block.
    fn block_means(&self) -> Vec<f64> {
        let (columns, rows) = (self.width / BLOCK, self.height / BLOCK);
        (0..columns * rows)
            .map(|block| {
                let (x0, y0) = (block % columns * BLOCK, block / columns * BLOCK);
                let pixels = (0..BLOCK * BLOCK).map(|i| self.rgb[(y0 + i / BLOCK) * self.width + x0 + i % BLOCK]);
                pixels.map(|[r, g, b]| f64::from(0.2126 * r + 0.7152 * g + 0.0722 * b)).sum::<f64>() / (BLOCK * BLOCK) as f64
            })
            .collect()
    }
}

fn report(ours: &Picture, reference: &Picture) {
    let (a, b) = (ours.block_means(), reference.block_means());
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let floor = 0.01 * mean(&b);
    let mut relative: Vec<f64> = a.iter().zip(&b).map(|(a, b)| (a - b).abs() / b.max(floor)).collect();
    let signed: Vec<f64> = a.iter().zip(&b).map(|(a, b)| (a - b) / b.max(floor)).collect();
    println!("mean: ours {:.5}, reference {:.5} ({:+.2} %)", mean(&a), mean(&b), 100.0 * (mean(&a) / mean(&b) - 1.0));
    println!(
        "{BLOCK}x{BLOCK} block means: mean relative difference {:.2} % (signed {:+.2} %)",
        100.0 * mean(&relative),
        100.0 * mean(&signed)
    );
    relative.sort_by(f64::total_cmp);
    let at = |q: f64| 100.0 * relative[((relative.len() - 1) as f64 * q) as usize];
    println!("  median {:.2} %, 90th percentile {:.2} %, worst {:.2} %", at(0.5), at(0.9), at(1.0));
}

/// The pictures beside each other, at the exposure that puts the reference's 90th percentile of brightness at 0.8 (before gamma 1/2.2).
fn side_by_side(left: &Picture, right: &Picture) -> image::RgbImage {
    let mut brightness: Vec<f32> = left.rgb.iter().map(|[r, g, b]| 0.3 * r + 0.59 * g + 0.11 * b).collect();
    brightness.sort_by(f32::total_cmp);
    let scale = 0.8f32.powf(2.2) / brightness[brightness.len() * 9 / 10].max(1e-6);
    image::RgbImage::from_fn((left.width + right.width) as u32, left.height as u32, |x, y| {
        let (picture, x) = if (x as usize) < left.width { (left, x as usize) } else { (right, x as usize - left.width) };
        let code = |v: f32| ((v * scale).max(0.0).powf(1.0 / 2.2).min(1.0) * 255.0 + 0.5) as u8;
        image::Rgb(picture.rgb[y as usize * picture.width + x].map(code))
    })
}

fn read_exr(path: &Path) -> Result<Picture> {
    let picture = exr::prelude::read_first_rgba_layer_from_file(
        path,
        |size, _| Picture { width: size.width(), height: size.height(), rgb: vec![[0.0; 3]; size.area()] },
        |picture: &mut Picture, position, (r, g, b, _a): (f32, f32, f32, f32)| {
            let index = position.y() * picture.width + position.x();
            picture.rgb[index] = [r, g, b];
        },
    );
    Ok(picture.with_context(|| format!("cannot read {}", path.display()))?.layer_data.channel_data.pixels)
}
