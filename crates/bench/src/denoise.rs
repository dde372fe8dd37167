//! Measures the error with and without denoising, for several ways of guiding the filter.
//!
//! `denoise [SCENE | home]… [--samples A,B] [--reference N] [--size WxH]` renders each scene's first camera with 16 and 64 samples per
//! pixel, or others, and twice with N (256) as the reference. Error is the mean of (x − a)(x − b) / (reference² + 0.01), where a and b are the two
//! references, whose noise so drops out; the image is scaled to a mean of 0.5, and the worst 0.1 % are left out. The denoiser is the
//! one in the binary.

use anyhow::{Context, Result};
use enfilade_denoise::{DenoiseError, Denoiser, GUIDES, Noisy, denoise};
use enfilade_frame::{Frame, Layer, Values, f16};
use enfilade_pipeline::Stopwatch;
use enfilade_render::{Guide, RenderConfig, RenderScene, render_frame};
use enfilade_scene::{Camera, CameraView, Intrinsics, Quiet, Scene};

/// Runs the instrument.
pub fn run() -> Result<()> {
    let (mut reference, mut size, mut counts, mut scenes) = (256, [384, 288], vec![16, 64], Vec::new());
    let mut arguments = crate::arguments::arguments();
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--samples" => {
                let text = arguments.next().context("--samples needs numbers, such as 8,16")?;
                counts = text.split(',').map(str::parse).collect::<Result<_, _>>()?;
            }
            "--reference" => reference = arguments.next().context("--reference needs a number")?.parse()?,
            "--size" => {
                size = crate::arguments::size(&arguments.next().context("--size needs WxH")?)?;
            }
            _ => scenes.push(argument),
        }
    }
    let denoiser = Denoiser::built_in();
    println!("{}, {}x{} pixels, references of {reference} samples", denoiser.name(), size[0], size[1]);
    for scene in crate::arguments::scenes(scenes) {
        let (name, scene) = scene?;
        println!("\n{name}");
        measure(&scene, size, (&counts, reference), &denoiser)?;
    }
    Ok(())
}

fn measure(scene: &Scene, [width, height]: [u32; 2], (counts, reference): (&[u32], u32), denoiser: &Denoiser) -> Result<()> {
    let camera = scene.cameras.first().context("the scene has no camera")?;
    let taken_with = Camera::from(Intrinsics::from_fov_x(width, height, camera.fov_x_rad));
    let view = CameraView::still(&taken_with, &camera.pose(0));
    let prepared = RenderScene::new(scene, &Quiet)?;
    let render = |samples, seed| {
        let config = RenderConfig { samples, seed, ..RenderConfig::default() };
        let guide = Guide::learn(&prepared, std::slice::from_ref(&view), &config);
        render_frame(&prepared, &guide, &view, &config, &Quiet)
    };
    let references = [picture(&render(reference, 11)?, Layer::Color), picture(&render(reference, 12)?, Layer::Color)];
    println!("  {:<62} {:>8} {:>8} {:>8} {:>7}", "", "samples", "error", "mean", "core-s");
    let mean = |color: &[f32]| color.iter().map(|&v| f64::from(v)).sum::<f64>() / color.len() as f64;
    let true_mean = 0.5 * (mean(&references[0]) + mean(&references[1]));
    for &samples in counts {
        let frame = render(samples, 1)?;
        let row = |what: &str, color: &[f32], seconds: f64| {
            let (error, bias) = (relative_error(color, &references), 100.0 * (mean(color) / true_mean - 1.0));
            println!("  {what:<62} {samples:>8} {error:>8.4} {bias:>+7.2}% {seconds:>7.2}");
        };
        row("as rendered", &picture(&frame, Layer::Color), 0.0);
        for way in WAYS {
            let time = Stopwatch::start();
            let color = (way.1)(&frame, denoiser)?;
            row(way.0, &color, time.cpu_s());
        }
    }
    Ok(())
}

/// A way to denoise a frame's colour.
type Way = (&'static str, fn(&Frame, &Denoiser) -> Result<Vec<f32>, DenoiseError>);

const WAYS: [Way; 9] = [
    ("color at once, no guides", |frame, denoiser| {
        let (color, one, zero) = (picture(frame, Layer::Color), white(frame), vec![0.0; 3 * frame.pixels()]);
        Ok(filter(frame, denoiser, &color, &one, &zero))
    }),
    ("color at once, reflectance and normals", |frame, denoiser| {
        let (color, albedo) = (picture(frame, Layer::Color), picture(frame, Layer::DiffuseReflectance));
        Ok(filter(frame, denoiser, &color, &albedo, &picture(frame, Layer::NormalBumpWorld)))
    }),
    ("light and residual apart, reflectance and normals", |frame, denoiser| {
        Ok(parts(frame, denoiser, &picture(frame, Layer::DiffuseReflectance)))
    }),
    ("light and residual apart, normals", |frame, denoiser| Ok(parts(frame, denoiser, &white(frame)))),
    ("the same, normals of pixel centres, filtered", |frame, denoiser| {
        Ok(picture(&denoise(&unguided(frame), |noisy| denoiser.filter(noisy))?, Layer::Color))
    }),
    ("the same, normals of the samples", |frame, denoiser| {
        let mut guided = frame.clone();
        guided.insert(Layer::NormalBeyondWorld, values(frame, Layer::NormalFilteredWorld));
        guided.insert(Layer::ReflectanceBeyond, Values::F16(vec![f16::ONE; 3 * frame.pixels()]));
        Ok(picture(&denoise(&guided, |noisy| denoiser.filter(noisy))?, Layer::Color))
    }),
    ("the same, mirrors and glass followed: what is written", |frame, denoiser| {
        Ok(picture(&denoise(frame, |noisy| denoiser.filter(noisy))?, Layer::Color))
    }),
    ("color at once, reflectance and normals of the samples", |frame, denoiser| Ok(at_once(frame, denoiser))),
    ("the mean of these two", |frame, denoiser| {
        let written = picture(&denoise(frame, |noisy| denoiser.filter(noisy))?, Layer::Color);
        Ok(written.iter().zip(at_once(frame, denoiser)).map(|(a, b)| 0.5 * (a + b)).collect())
    }),
];

/// The frame without the layers that guide denoising, as earlier versions rendered it.
pub fn unguided(frame: &Frame) -> Frame {
    let mut unguided = Frame::new(frame.width, frame.height);
    frame.iter().filter(|(layer, _)| !GUIDES.contains(layer)).for_each(|(layer, values)| unguided.insert(layer, values.clone()));
    unguided
}

/// Color denoised at once, guided by reflectance and by the normals of the samples.
fn at_once(frame: &Frame, denoiser: &Denoiser) -> Vec<f32> {
    let [color, albedo, normal] = [Layer::Color, Layer::DiffuseReflectance, Layer::NormalFilteredWorld].map(|layer| picture(frame, layer));
    filter(frame, denoiser, &color, &albedo, &normal)
}

/// Light and residual denoised apart, guided by `albedo` and normals as they are, and put together.
fn parts(frame: &Frame, denoiser: &Denoiser, albedo: &[f32]) -> Vec<f32> {
    let normal = picture(frame, Layer::NormalBumpWorld);
    let light = filter(frame, denoiser, &picture(frame, Layer::DiffuseIllumination), albedo, &normal);
    let residual = filter(frame, denoiser, &picture(frame, Layer::Residual), albedo, &normal);
    let reflectance = picture(frame, Layer::DiffuseReflectance);
    (0..light.len()).map(|i| reflectance[i] * light[i] + residual[i]).collect()
}

fn filter(frame: &Frame, denoiser: &Denoiser, color: &[f32], albedo: &[f32], normal: &[f32]) -> Vec<f32> {
    denoiser.filter(&Noisy { width: frame.width, height: frame.height, color, albedo, normal })
}

fn white(frame: &Frame) -> Vec<f32> {
    vec![1.0; 3 * frame.pixels()]
}

fn values(frame: &Frame, layer: Layer) -> Values {
    frame.get(layer).expect("a rendered and denoised frame has the layer").clone()
}

/// A layer in single precision, 0 where it is not a number.
fn picture(frame: &Frame, layer: Layer) -> Vec<f32> {
    let values = values(frame, layer);
    (0..values.len()).map(|i| values.get(i) as f32).map(|v| if v.is_nan() { 0.0 } else { v }).collect()
}

fn relative_error(found: &[f32], [a, b]: &[Vec<f32>; 2]) -> f64 {
    let mean = |i: usize| 0.5 * (f64::from(a[i]) + f64::from(b[i]));
    let scale = 0.5 * a.len() as f64 / (0..a.len()).map(mean).sum::<f64>();
    // Per pixel: the error by which the worst are left out, and the one without the references' noise.
    let mut errors: Vec<[f64; 2]> = (0..a.len() / 3)
        .map(|pixel| {
            let channel = |i: usize| {
                let (x, m) = (f64::from(found[i]), mean(i));
                let weight = scale * scale / ((m * scale).powi(2) + 0.01) / 3.0;
                [(x - m).powi(2) * weight, (x - f64::from(a[i])) * (x - f64::from(b[i])) * weight]
            };
            (3 * pixel..3 * pixel + 3).map(channel).fold([0.0; 2], |sum, e| [sum[0] + e[0], sum[1] + e[1]])
        })
        .collect();
    errors.sort_by(|x, y| x[0].total_cmp(&y[0]));
    errors.truncate(errors.len() * 999 / 1000);
    errors.iter().map(|e| e[1]).sum::<f64>() / errors.len() as f64
}
