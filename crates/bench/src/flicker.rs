//! Measures how much delivered surfaces change from frame to frame: what crawls in a film.
//!
//! `flicker [SCENE | home]… [--samples N] [--frames N] [--size WxH] [--reference N]` walks sideways past each scene's first camera, 2 cm
//! and half a degree a frame, and renders every frame with 16 samples. Flicker is the mean of |a − b| over the mean of a, where a is the
//! luminance of a pixel and b that of the place to which exact flow leads, interpolated in the next frame, over pixels whose point the next
//! frame shows. What shines changes with the view, too, and so do textures between pixels: denoised pictures of 256 samples tell how much.

use crate::denoise::unguided;
use anyhow::{Context, Result};
use enfilade_denoise::{DenoiseError, Denoiser, denoise};
use enfilade_frame::{Frame, Layer};
use enfilade_math::{DMat3, Rgb};
use enfilade_render::{FlowTo, Guide, RenderConfig, RenderScene, add_extra_layers, render_frame};
use enfilade_scene::{Camera, CameraView, Intrinsics, Pose, Quiet, Scene};

/// Way and turn from frame to frame.
const STEP_M: f64 = 0.02;
const TURN_DEG: f64 = 0.5;

/// What is measured.
struct Walk {
    size: [u32; 2],
    frames: usize,
    samples: u32,
    reference: u32,
}

/// Runs the instrument.
pub fn run() -> Result<()> {
    let mut walk = Walk { size: [256, 192], frames: 5, samples: 16, reference: 256 };
    let mut scenes = Vec::new();
    let mut arguments = crate::arguments::arguments();
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().with_context(|| format!("{argument} needs a value"));
        match argument.as_str() {
            "--samples" => walk.samples = value()?.parse()?,
            "--frames" => walk.frames = value()?.parse()?,
            "--reference" => walk.reference = value()?.parse()?,
            "--size" => walk.size = crate::arguments::size(&value()?)?,
            _ => scenes.push(argument),
        }
    }
    for scene in crate::arguments::scenes(scenes) {
        let (name, scene) = scene?;
        println!("{name}");
        measure(&scene, &walk)?;
    }
    Ok(())
}

/// A way to make pictures of rendered frames.
type Way = (&'static str, fn(&Frame, &Denoiser) -> Result<Vec<f32>, DenoiseError>);

const WAYS: [Way; 3] = [
    ("as rendered", |frame, _| Ok(luminance(frame))),
    ("denoised, guided by normals of pixel centres", |frame, denoiser| {
        Ok(luminance(&denoise(&unguided(frame), |noisy| denoiser.filter(noisy))?))
    }),
    ("denoised: what is written", |frame, denoiser| Ok(luminance(&denoise(frame, |noisy| denoiser.filter(noisy))?))),
];

fn measure(scene: &Scene, walk: &Walk) -> Result<()> {
    let camera = scene.cameras.first().context("the scene has no camera")?;
    let [width, height] = walk.size;
    let taken_with = Camera::from(Intrinsics::from_fov_x(width, height, camera.fov_x_rad));
    let poses: Vec<Pose> = (0..walk.frames).map(|i| step(&camera.pose(0), i)).collect();
    let views: Vec<CameraView> = poses.iter().map(|pose| CameraView::still(&taken_with, pose)).collect();
    let prepared = RenderScene::new(scene, &Quiet)?;
    let denoiser = Denoiser::built_in();
    let render = |samples: u32| -> Result<Vec<Frame>> {
        let config = RenderConfig { samples, ..RenderConfig::default() };
        let guide = Guide::learn(&prepared, &views, &config);
        let frame = |i: usize| {
            let mut frame = render_frame(&prepared, &guide, &views[i], &config, &Quiet)?;
            add_extra_layers(&prepared, &views[i], views.get(i + 1).map(FlowTo::still), &mut frame);
            Ok(frame)
        };
        (0..views.len()).map(frame).collect()
    };
    let frames = render(walk.samples)?;
    for (what, picture) in WAYS {
        let pictures = frames.iter().map(|frame| picture(frame, &denoiser)).collect::<Result<Vec<_>, _>>()?;
        println!("  {what:<46} {:>4} samples: {:.4}", walk.samples, flicker(&frames, &pictures));
    }
    let clean = render(walk.reference)?;
    let (what, picture) = WAYS[WAYS.len() - 1];
    let pictures = clean.iter().map(|frame| picture(frame, &denoiser)).collect::<Result<Vec<_>, _>>()?;
    println!("  {what:<46} {:>4} samples: {:.4}", walk.reference, flicker(&clean, &pictures));
    Ok(())
}

/// The pose of frame `i`: to the right of the first, and turned to the left by as much that the view stays.
fn step(first: &Pose, i: usize) -> Pose {
    let to_right = first.world_from_camera.x_axis * (STEP_M * i as f64);
    let turn = DMat3::from_axis_angle(first.world_from_camera.y_axis, (TURN_DEG * i as f64).to_radians());
    let (position, look_at) = (first.position + to_right, first.position + to_right + turn * (first.look_at - first.position));
    Pose { frame: i as u32, position, look_at, world_from_camera: turn * first.world_from_camera }
}

fn luminance(frame: &Frame) -> Vec<f32> {
    let color = frame.get(Layer::Color).expect("a rendered or denoised frame has it");
    let channel = |pixel: usize, c: usize| color.get(3 * pixel + c) as f32;
    (0..color.len() / 3).map(|pixel| Rgb::new(channel(pixel, 0), channel(pixel, 1), channel(pixel, 2)).luminance()).collect()
}

/// Mean relative change of what two frames show, over all pairs of neighbours.
fn flicker(frames: &[Frame], pictures: &[Vec<f32>]) -> f64 {
    let (mut change, mut brightness) = (0.0, 0.0);
    for (frame, pair) in frames.iter().zip(pictures.windows(2)) {
        let [flow, visible] = [Layer::OpticalFlow, Layer::FlowVisibility].map(|layer| frame.get(layer).expect("an extra layer"));
        let width = frame.width as usize;
        for pixel in (0..frame.pixels()).filter(|pixel| visible.get(*pixel) == 1.0) {
            let place = [pixel % width, pixel / width].map(|v| v as f64);
            let [x, y] = [0, 1].map(|c| place[c] + flow.get(2 * pixel + c));
            if let Some(there) = interpolated(&pair[1], width, x, y) {
                change += (f64::from(pair[0][pixel]) - there).abs();
                brightness += f64::from(pair[0][pixel]);
            }
        }
    }
    change / brightness
}

/// The picture between four pixels, in units of pixels from the centre of the first one; `None` beyond the outer centres.
fn interpolated(picture: &[f32], width: usize, x: f64, y: f64) -> Option<f64> {
    let inside = x >= 0.0 && y >= 0.0 && x < (width - 1) as f64 && y < (picture.len() / width - 1) as f64;
    inside.then(|| {
        let (left, top) = (x.floor() as usize, y.floor() as usize);
        let at = |dx: usize, dy: usize| f64::from(picture[(top + dy) * width + left + dx]);
        let (u, v) = (x - left as f64, y - top as f64);
        (1.0 - v) * ((1.0 - u) * at(0, 0) + u * at(1, 0)) + v * ((1.0 - u) * at(0, 1) + u * at(1, 1))
    })
}
