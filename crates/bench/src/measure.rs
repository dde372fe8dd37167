//! Renders a scene through its own camera and writes the colour as a NumPy array: our side of `cargo xtask oracle`, `bench render` and
//! `bench cycles`.
//!
//! `measure SCENE --size WIDTHxHEIGHT [--config JSON] [--seeds N] [--denoise] [--out FILE.npy]` renders N pictures (default 1), whose seeds
//! count upward from the configuration's, with every layer, as a dataset's frames are. `--config` holds fields of `RenderConfig`; what it
//! leaves out has its default. The array is float32, N × height × width × 3, linear; with `--denoise` as many denoised pictures follow,
//! made as a dataset's are. One line of JSON reports the denoiser and the processor seconds (user and system, all threads) of loading (with
//! the denoiser), of learning where light comes from, of rendering, and of denoising.

use anyhow::{Context, Result, bail};
use enfilade_denoise::{Denoiser, denoise};
use enfilade_frame::{Frame, Layer};
use enfilade_import::{ImportOptions, load};
use enfilade_pipeline::Stopwatch;
use enfilade_render::{Guide, RenderConfig, RenderScene, render_frame};
use enfilade_scene::{Camera, CameraView, Intrinsics, Quiet, StartCamera};
use std::path::PathBuf;

/// The rendering job.
struct Job {
    scene: PathBuf,
    size: (u32, u32),
    config: RenderConfig,
    seeds: u64,
    denoise: bool,
    out: Option<PathBuf>,
}

/// Runs the instrument.
pub fn run() -> Result<()> {
    let time = Stopwatch::start();
    let job = arguments()?;
    let imported = load(&job.scene, &ImportOptions::default(), &Quiet)?;
    for warning in &imported.report.warnings {
        eprintln!("{warning}");
    }
    let camera = imported.scene.cameras.first().with_context(|| format!("{} has no camera", job.scene.display()))?;
    let prepared = RenderScene::new(&imported.scene, &Quiet)?;
    let denoiser = job.denoise.then(denoiser);
    let loaded = time.cpu_s();
    let (mut pictures, mut clean, mut learned, mut denoised) = (Vec::new(), Vec::new(), 0.0, 0.0);
    for seed in 0..job.seeds {
        let config = RenderConfig { seed: job.config.seed + seed, ..job.config.clone() };
        let (frame, seconds) = picture(&prepared, camera, job.size, &config)?;
        pictures.extend(color(&frame, Layer::Color));
        learned += seconds;
        if let Some(denoiser) = &denoiser {
            let denoising = Stopwatch::start();
            clean.extend(color(&denoise(&frame, |noisy| denoiser.filter(noisy))?, Layer::Color));
            denoised += denoising.cpu_s();
        }
    }
    let rendered = time.cpu_s() - loaded - learned - denoised;
    pictures.append(&mut clean);
    if let Some(path) = &job.out {
        let (width, height) = job.size;
        let bytes = npy(&[pictures.len() / (3 * width as usize * height as usize), height as usize, width as usize, 3], &pictures);
        std::fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
    }
    println!(
        "{}",
        serde_json::json!({
            "triangles": prepared.triangle_count(),
            "load_core_s": loaded,
            "learn_core_s": learned,
            "render_core_s": rendered,
            "denoise_core_s": denoised,
            "denoiser": denoiser.map(|denoiser| denoiser.name()),
        })
    );
    Ok(())
}

fn arguments() -> Result<Job> {
    let mut job = Job { scene: PathBuf::new(), size: (256, 192), config: RenderConfig::default(), seeds: 1, denoise: false, out: None };
    let mut words = crate::arguments::arguments();
    while let Some(word) = words.next() {
        let mut value = || words.next().with_context(|| format!("{word} needs a value"));
        match word.as_str() {
            "--size" => job.size = crate::arguments::size(&value()?)?.into(),
            "--config" => job.config = serde_json::from_str(&value()?).context("--config should hold fields of RenderConfig as JSON")?,
            "--seeds" => job.seeds = value()?.parse().context("--seeds should be a whole number")?,
            "--denoise" => job.denoise = true,
            "--out" => job.out = Some(value()?.into()),
            flag if flag.starts_with("--") => bail!("unknown option {flag}; expected --size, --config, --seeds, --denoise or --out"),
            scene => job.scene = scene.into(),
        }
    }
    if job.scene.as_os_str().is_empty() {
        bail!("name a scene: measure SCENE [--size WIDTHxHEIGHT] [--config JSON] [--seeds N] [--denoise] [--out FILE.npy]");
    }
    Ok(job)
}

/// The denoiser of the pictures that users get.
fn denoiser() -> Denoiser {
    Denoiser::built_in()
}

/// A frame from the scene's own camera, and the processor seconds of learning for it.
fn picture(scene: &RenderScene<'_>, camera: &StartCamera, (width, height): (u32, u32), config: &RenderConfig) -> Result<(Frame, f64)> {
    let taken_with = Camera::from(Intrinsics::from_fov_x(width, height, camera.fov_x_rad));
    let view = CameraView::still(&taken_with, &camera.pose(0));
    let learning = Stopwatch::start();
    let guide = Guide::learn(scene, std::slice::from_ref(&view), config);
    let learned = learning.cpu_s();
    Ok((render_frame(scene, &guide, &view, config, &Quiet)?, learned))
}

fn color(frame: &Frame, layer: Layer) -> Vec<f32> {
    let values = frame.get(layer).expect("every rendered frame has color, every denoised one its companion");
    (0..3 * frame.pixels()).map(|i| values.get(i) as f32).collect()
}

/// A NumPy array file, version 1.0, of little-endian float32 in C order.
fn npy(shape: &[usize], values: &[f32]) -> Vec<u8> {
    let shape = shape.iter().map(|n| format!("{n},")).collect::<String>();
    let mut header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({shape}), }}");
    // Magic number, version and length take ten bytes; the whole is padded to a multiple of 64 and ends with a line feed.
    header.extend(std::iter::repeat_n(' ', 63 - (10 + header.len()) % 64));
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
    bytes
}
