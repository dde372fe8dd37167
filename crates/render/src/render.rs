//! One frame: every pixel's geometry and colour, tile by tile.

use crate::config::RenderConfig;
use crate::error::RenderError;
use crate::film::{PixelColor, PixelSum};
use crate::geometry_pass::{PixelGeometry, camera_ray, pixel_geometry};
use crate::integrator::Integrator;
use crate::light::LightChoice;
use crate::prepared::RenderScene;
use enfilade_frame::{Frame, Layer, Validity, Values, f16};
use enfilade_math::{Ray, Sampler, warp};
use enfilade_scene::{Cx, Intrinsics, Pose};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Side of a tile in pixels: large enough for coherent rays, small enough to spread over threads.
const TILE: u32 = 16;

/// One pixel of all rendered layers.
struct Pixel {
    color: PixelColor,
    geometry: Option<PixelGeometry>,
}

/// Renders every layer but the labels. The bytes depend on the arguments alone, whatever the number of threads.
///
/// # Errors
/// When the camera or the settings are not usable.
pub fn render_frame(
    scene: &RenderScene<'_>,
    intrinsics: &Intrinsics,
    pose: &Pose,
    config: &RenderConfig,
    cx: &dyn Cx,
) -> Result<Frame, RenderError> {
    check(intrinsics, pose, config)?;
    let (width, height) = (intrinsics.width, intrinsics.height);
    let columns = width.div_ceil(TILE);
    let tiles = columns * height.div_ceil(TILE);
    let choice = LightChoice::learn(scene, intrinsics, pose, config);
    let integrator = Integrator { scene, config, choice: &choice };
    let done = AtomicU64::new(0);
    let rendered: Vec<Vec<Pixel>> = (0..tiles)
        .into_par_iter()
        .map(|tile| {
            let (x0, y0) = ((tile % columns) * TILE, (tile / columns) * TILE);
            let pixels = (y0..height.min(y0 + TILE))
                .flat_map(|y| (x0..width.min(x0 + TILE)).map(move |x| (x, y)))
                .map(|(x, y)| render_pixel(&integrator, intrinsics, pose, x, y))
                .collect();
            cx.progress("rendering", done.fetch_add(1, Ordering::Relaxed) + 1, u64::from(tiles));
            pixels
        })
        .collect();
    Ok(assemble(width, height, columns, &rendered))
}

fn check(intrinsics: &Intrinsics, pose: &Pose, config: &RenderConfig) -> Result<(), RenderError> {
    let camera = |problem: String| Err(RenderError::Camera { frame: pose.frame, problem });
    if !pose.position.is_finite() || !pose.world_from_camera.is_finite() {
        return camera(format!("its pose is not finite: {pose:?}"));
    }
    if intrinsics.width == 0 || intrinsics.height == 0 || !(intrinsics.fx > 0.0 && intrinsics.fy > 0.0) {
        return camera(format!(
            "its image is {}x{} with focal lengths {} and {}",
            intrinsics.width, intrinsics.height, intrinsics.fx, intrinsics.fy
        ));
    }
    if config.samples == 0 {
        return Err(RenderError::Config { field: "samples", found: "0".into(), expected: "at least 1" });
    }
    if !(config.filter_radius >= 0.0 && config.filter_radius.is_finite()) {
        return Err(RenderError::Config { field: "filter_radius", found: config.filter_radius.to_string(), expected: "0 or more pixels" });
    }
    Ok(())
}

fn render_pixel(integrator: &Integrator<'_, '_>, intrinsics: &Intrinsics, pose: &Pose, x: u32, y: u32) -> Pixel {
    let config = integrator.config;
    let mut sum = PixelSum::default();
    for index in 0..config.samples {
        let sampler = Sampler::new(config.seed, pose.frame, x, y, index);
        let u = sampler.set(0);
        let offset = [u[0], u[1]].map(|u| f64::from(warp::tent(u, config.filter_radius)));
        let (origin, direction) = camera_ray(intrinsics, pose, f64::from(x) + 0.5 + offset[0], f64::from(y) + 0.5 + offset[1]);
        sum.add(&integrator.sample(Ray::new(origin.as_vec3(), direction.as_vec3().normalize()), &sampler, index));
    }
    Pixel { color: sum.resolve(), geometry: pixel_geometry(integrator.scene, intrinsics, pose, x, y) }
}

/// Puts the tiles' pixels in order, layer by layer.
fn assemble(width: u32, height: u32, columns: u32, tiles: &[Vec<Pixel>]) -> Frame {
    let pixel = |x: u32, y: u32| {
        let tile_width = (width - x / TILE * TILE).min(TILE);
        &tiles[(y / TILE * columns + x / TILE) as usize][(y % TILE * tile_width + x % TILE) as usize]
    };
    let pixels: Vec<&Pixel> = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
    let color = |f: fn(&PixelColor) -> [f16; 3]| Values::F16(pixels.iter().flat_map(|p| f(&p.color)).collect());
    let nan = [f16::NAN; 3];
    let half = |f: fn(&PixelGeometry) -> [f16; 3], void: [f16; 3]| {
        Values::F16(pixels.iter().flat_map(|p| p.geometry.as_ref().map_or(void, f)).collect())
    };
    let single = |f: fn(&PixelGeometry) -> f32| Values::F32(pixels.iter().map(|p| p.geometry.as_ref().map_or(f32::NAN, f)).collect());

    let mut frame = Frame::new(width, height);
    frame.insert(Layer::Color, color(|c| c.color));
    frame.insert(Layer::DiffuseIllumination, color(|c| c.illumination));
    frame.insert(Layer::DiffuseReflectance, color(|c| c.reflectance));
    frame.insert(Layer::Residual, color(|c| c.residual));
    frame.insert(Layer::DepthMeters, single(|g| g.distance_m));
    frame.insert(Layer::DepthZMeters, single(|g| g.depth_z_m));
    let position = pixels.iter().flat_map(|p| p.geometry.as_ref().map_or([f32::NAN; 3], |g| g.position)).collect();
    frame.insert(Layer::Position, Values::F32(position));
    frame.insert(Layer::NormalWorld, half(|g| g.normal_world, nan));
    frame.insert(Layer::NormalCam, half(|g| g.normal_cam, nan));
    frame.insert(Layer::NormalBumpWorld, half(|g| g.normal_bump_world, nan));
    frame.insert(Layer::NormalBumpCam, half(|g| g.normal_bump_cam, nan));
    frame.insert(Layer::TexCoord, half(|g| g.tex_coord, [f16::ZERO; 3]));
    frame.insert(Layer::RenderEntityId, Values::I16(pixels.iter().map(|p| p.geometry.as_ref().map_or(-1, |g| g.entity)).collect()));
    frame.insert(Layer::Valid, Values::U8(pixels.iter().map(|p| validity(p) as u8).collect()));
    frame
}

fn validity(pixel: &Pixel) -> Validity {
    match pixel.geometry {
        None => Validity::Void,
        Some(_) if pixel.color.saturated => Validity::Saturated,
        Some(_) if pixel.color.reflectance.iter().all(|&a| a == f16::ZERO) => Validity::NoDiffuse,
        Some(_) => Validity::Valid,
    }
}
