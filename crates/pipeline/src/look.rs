//! `look`: the first picture of a scene file, in one step.
//!
//! The file is imported and inspected. It gets light if it has none, and a viewpoint is searched if none of its cameras is in a room or
//! sees something. Then one picture is rendered, denoised and tone-mapped for display.

use crate::config::{FileSource, Lamps};
use crate::error::Error;
use crate::intake::{Held, Look, has_light, load_file, settle};
use crate::report::Stopwatch;
use crate::single::{refuse_overwriting, write_output};
use crate::stages::describe;
use enfilade_denoise::{Denoiser, denoise};
use enfilade_explore::{Saliency, StartsConfig, find_starts, is_indoors, view_stats};
use enfilade_frame::{Frame, Pass};
use enfilade_import::{EnvironmentOverride, Imported};
use enfilade_math::{DMat3, DVec3, Ray};
use enfilade_options::closest;
use enfilade_render::{FrameRender, Guide, RenderConfig, RenderScene};
use enfilade_scene::{Camera, CameraView, Cx, Intrinsics, Pose, Scene, StartCamera, Warning};
use enfilade_show::exposure::{Brightness, Exposure, display_exposure};
use enfilade_show::preview::{PreviewSpec, Subject};
use std::f64::consts::{PI, TAU};
use std::path::Path;

/// Width and height of the picture, pixels.
const SIZE: [u32; 2] = [640, 480];
/// Samples per pixel, before denoising, where there is time for them.
const SAMPLES: u32 = 16;
/// Horizontal field of view from a found place: 75 degrees, a wide lens.
const WIDE_RAD: f64 = 75.0 * PI / 180.0;
/// Range of the field of view of a file's camera, for pictures that show something.
const FOV_RAD: [f64; 2] = [20.0 * PI / 180.0, 100.0 * PI / 180.0];
/// Number of places tried besides the found ones, in all rooms together.
const EYES: usize = 24;
/// Headings tried at each place, and how far the view is tilted down, radians.
const HEADINGS: u32 = 24;
const TILT_RAD: f64 = 0.08;
/// Distance beyond which a farther view is not better, metres.
const FAR_M: f64 = 6.0;
/// Test images of them.
const TEST_SIZE: [u32; 2] = [64, 48];
/// Least share of a camera's pixels that show something, and the distance over the scene's diagonal beyond which a surface counts as seen
/// and not only in the way.
const SEES_SHARE: f64 = 0.2;
const IN_THE_WAY: f32 = 0.002;

/// Result of a look.
#[derive(Clone, Debug)]
pub struct Looked {
    /// One line about the scene.
    pub summary: String,
    /// The view, in words.
    pub view: String,
    /// The light that was added, if the file has none.
    pub light: Option<String>,
    /// Samples per pixel that were taken.
    pub samples: f64,
    /// Wall time of everything, seconds.
    pub wall_s: f64,
}

/// Renders a picture of the file of `source` (its path is used unchanged) to `output`, a JPEG or PNG by its extension; from the file's
/// camera `camera` if one is named. No samples are begun after `seconds` of rendering.
///
/// # Errors
/// If the file cannot be imported, has no such camera, no viewpoint is found, or the picture cannot be written.
pub fn look(source: &FileSource, camera: Option<&str>, seconds: u32, output: &Path, cx: &dyn Cx) -> Result<Looked, Error> {
    let time = Stopwatch::start();
    let name = picture_name(output)?;
    let held = Held::over(cx);
    let mut imported = load_file(source, Path::new(&source.file), &|path| Ok(path.into()), &held)?;
    refuse_overwriting(output, &imported.inputs)?;
    let (light, look) = lit(source, &mut imported, cx);
    drop(held);
    let scene = &imported.scene;
    let (start, view) = place(scene, &look, camera, cx)?;
    drop(look);

    let (frame, samples) = render(scene, &start, seconds, cx)?;
    let layers = denoise(&frame, |noisy| Denoiser::built_in().filter(noisy)).map_err(Error::stage)?;
    let mut shown = frame;
    layers.iter().for_each(|(layer, values)| shown.insert(layer, values.clone()));
    let display = display_exposure(&Brightness::of_frame(&shown, 1).into_iter().collect::<Vec<_>>());
    let spec = PreviewSpec { pass: Pass::Final, name, subject: Subject::Displayed };
    let bytes = spec.file(&shown, Exposure::from(display)).unwrap_or_default();
    write_output(output, &bytes)?;
    Ok(Looked { summary: describe(scene), view, light, samples, wall_s: time.wall_s() })
}

/// The kind of picture that the extension of a path names.
fn picture_name(output: &Path) -> Result<&'static str, Error> {
    let extension = output.extension().map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("jpg" | "jpeg") => Ok("look.jpg"),
        Some("png") => Ok("look.png"),
        _ => Err(Error::usage(format!("{} is no name of a picture", output.display()), "end it with .jpg or .png")),
    }
}

/// Adds light to a scene without any; returns which, in words.
fn lit(source: &FileSource, imported: &mut Imported, cx: &dyn Cx) -> (Option<String>, Look) {
    let is_dark = !has_light(&imported.scene) && source.lamps.is_none();
    if !is_dark {
        return (None, settle(source, imported, cx));
    }
    EnvironmentOverride::named("overcast").light(&mut imported.scene);
    let look = settle(&FileSource { lamps: Some(Lamps::Ceiling), ..source.clone() }, imported, cx);
    let light = if look.findings.ceilings.is_empty() {
        "nothing in the file shines: an overcast sky lights it (--environment overcast)"
    } else {
        "nothing in the file shines: lamps below its ceilings and an overcast sky light it (--lamps ceiling --environment overcast)"
    };
    (Some(light.into()), look)
}

/// A camera of the file, by its name.
pub(crate) fn named_camera<'s>(scene: &'s Scene, name: &str) -> Result<&'s StartCamera, Error> {
    let names: Vec<&str> = scene.cameras.iter().map(|c| c.name.as_str()).collect();
    let proposal = || closest(name, &names).map_or(String::new(), |n| format!("did you mean {n:?}? "));
    let found = scene.cameras.iter().find(|camera| camera.name == name);
    found.ok_or_else(|| Error::usage(format!("the scene has no camera {name:?}"), format!("{}its cameras: {names:?}", proposal())))
}

/// The viewpoint, and its description in words.
pub(crate) fn place(scene: &Scene, look: &Look, name: Option<&str>, cx: &dyn Cx) -> Result<(StartCamera, String), Error> {
    let of_file = |camera: &StartCamera| (with_usable_view(camera), format!("camera {:?} of the file", camera.name));
    if let Some(name) = name {
        return named_camera(scene, name).map(of_file);
    }
    if let Some(inside) = scene.cameras.iter().find(|camera| camera.position.is_finite() && is_indoors(&look.bvh, camera.position)) {
        return Ok(of_file(inside));
    }
    if let Some(outside) = scene.cameras.iter().find(|camera| sees_something(look, camera)) {
        let (camera, words) = of_file(outside);
        return Ok((camera, format!("{words}, which is in no room")));
    }
    let places = find_starts(&look.world, &look.bvh, &StartsConfig::default(), cx);
    if let Some(best) = best_view(look, &places) {
        let instead = if scene.cameras.is_empty() { "the file has no camera" } else { "no camera of the file sees anything" };
        return Ok((best, format!("a place that was found, since {instead}")));
    }
    if let Some(outside) = scene.cameras.first() {
        return Ok(of_file(outside));
    }
    cx.warn(Warning { place: "look".into(), message: "it is seen from outside".into() });
    Ok((from_outside(look), "outside, since no place for a camera was found inside".into()))
}

/// Whether enough of a camera's pixels show something, at any position.
fn sees_something(look: &Look, camera: &StartCamera) -> bool {
    if !camera.position.is_finite() || look.world.bounds.is_empty() {
        return false;
    }
    let test = Intrinsics::from_fov_x(TEST_SIZE[0], TEST_SIZE[1], with_usable_view(camera).fov_x_rad);
    let camera_view = Camera::from(test);
    let nearest = IN_THE_WAY * look.world.bounds.extent().length();
    let sees = |pixel: usize| {
        let (x, y) = (pixel as u32 % TEST_SIZE[0], pixel as u32 / TEST_SIZE[0]);
        let direction = camera_view.projection.ray(f64::from(x) + 0.5, f64::from(y) + 0.5).map(|ray| camera.world_from_camera * ray);
        let ray = direction.map(|direction| Ray::new(camera.position.as_vec3(), direction.normalize_or_zero().as_vec3()));
        ray.and_then(|ray| look.bvh.closest(&ray)).is_some_and(|hit| hit.t > nearest)
    };
    let pixels = (TEST_SIZE[0] * TEST_SIZE[1]) as usize;
    (0..pixels).filter(|pixel| sees(*pixel)).count() as f64 >= SEES_SHARE * pixels as f64
}

/// The camera with a field of view that a picture can have.
fn with_usable_view(camera: &StartCamera) -> StartCamera {
    StartCamera { fov_x_rad: camera.fov_x_rad.clamp(FOV_RAD[0], FOV_RAD[1]), ..camera.clone() }
}

/// The best view from the found places and others in the rooms around them, with all headings: the one with the largest saliency times the
/// root of its distance. `None` if no place was found.
fn best_view(look: &Look, places: &[StartCamera]) -> Option<StartCamera> {
    if places.is_empty() {
        return None;
    }
    let test = Intrinsics::from_fov_x(TEST_SIZE[0], TEST_SIZE[1], WIDE_RAD);
    let saliency = Saliency::Entropy { alpha: 1.0, beta: 2.0 };
    let starts = StartsConfig::default();
    let ceilings = &look.findings.ceilings;
    let eyes = ceilings.iter().flat_map(|ceiling| ceiling.eyes(EYES.div_ceil(ceilings.len()), starts.eye_height_m as f32));
    let has_room = |p: &DVec3| (0..HEADINGS).all(|k| !look.bvh.occluded(&near_ray(*p, k, starts.clearance_m)));
    let positions = places.iter().map(|place| place.position).chain(eyes.map(|eye| eye.as_dvec3()).filter(has_room));
    let views: Vec<StartCamera> = positions.flat_map(|position| (0..HEADINGS).map(move |k| heading(position, k))).collect();
    let score = |view: &StartCamera| {
        let ray = Ray::new(view.position.as_vec3(), -view.world_from_camera.z_axis.as_vec3());
        let far_m = look.bvh.closest(&ray).map_or(0.0, |hit| f64::from(hit.t).min(FAR_M));
        saliency.score(&view_stats(&look.world, &look.bvh, &test, &view.pose(0))) * far_m.sqrt()
    };
    let scores: Vec<f64> = enfilade_parallel::map(&views, score);
    views.into_iter().zip(scores).max_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(view, _)| view)
}

/// The level direction number `k`.
fn level(k: u32) -> DVec3 {
    let (sin, cos) = (TAU * f64::from(k) / f64::from(HEADINGS)).sin_cos();
    DVec3::new(cos, sin, 0.0)
}

fn near_ray(p: DVec3, k: u32, clearance_m: f64) -> Ray {
    Ray { t_max: clearance_m as f32, ..Ray::new(p.as_vec3(), level(k).as_vec3()) }
}

fn heading(position: DVec3, k: u32) -> StartCamera {
    looking("found", position, level(k) * TILT_RAD.cos() - DVec3::Z * TILT_RAD.sin())
}

fn looking(name: &str, position: DVec3, forward: DVec3) -> StartCamera {
    let right = forward.cross(DVec3::Z).normalize();
    let world_from_camera = DMat3::from_cols(right, right.cross(forward), -forward);
    StartCamera { name: name.into(), position, world_from_camera, fov_x_rad: WIDE_RAD, aspect: 4.0 / 3.0 }
}

/// A view of all of it, from above one corner.
fn from_outside(look: &Look) -> StartCamera {
    let (low, high) = (look.world.bounds.min.as_dvec3(), look.world.bounds.max.as_dvec3());
    let (middle, radius) = (0.5 * (low + high), 0.5 * (high - low).length());
    let forward = DVec3::new(1.0, 1.0, -0.8).normalize();
    looking("outside", middle - forward * (radius / (0.35 * WIDE_RAD).sin()), forward)
}

/// Renders the view for as long as a look may take.
fn render(scene: &Scene, start: &StartCamera, seconds: u32, cx: &dyn Cx) -> Result<(Frame, f64), Error> {
    let camera = Camera::from(Intrinsics::from_fov_x(SIZE[0], SIZE[1], start.fov_x_rad));
    let pose: Pose = start.pose(0);
    let view = CameraView::still(&camera, &pose);
    let prepared = RenderScene::new(scene, cx).map_err(Error::stage)?;
    let config = RenderConfig { samples: SAMPLES, ..RenderConfig::default() };
    let guide = Guide::learn(&prepared, &[view], &config);
    let mut rendering = FrameRender::new(&prepared, &guide, &view, &config).map_err(Error::stage)?;
    let time = Stopwatch::start();
    while !rendering.is_done() && (time.wall_s() < f64::from(seconds) || rendering.samples() == 0.0) {
        rendering.short_pass(cx);
    }
    Ok((rendering.frame(), rendering.samples()))
}
