//! Further layers of the surface that the ray through a pixel's centre meets: its material, the surfaces behind it, its position in the
//! next frame. They are point samples in the sense of `geometry_pass`, computed after a frame and only on request.

mod appearance;
mod boundary;
pub(crate) mod flow;
pub(crate) mod surfaces;

use crate::beyond::distance_beyond;
use crate::geometry_pass::{Sighting, sighting};
use crate::prepared::{AlphaTest, RenderScene};
use crate::rows::Rows;
use crate::surface::Surface;
use crate::texture::Cone;
use appearance::Appearance;
use enfilade_frame::{Frame, Layer, Values, f16, traits};
use enfilade_math::{Ray, Rgb, Vec3};
use enfilade_parallel::map_up_to;
use enfilade_scene::{CameraRay, CameraView};
use flow::Flow;
pub use flow::FlowTo;

/// Metals below this GGX alpha show a reflection that can be made out.
const MIRROR_ALPHA: f32 = 0.01;

/// Panes that are looked through one after the other.
const MAX_PANES: usize = 64;

/// Distance of a pixel's corners from its centre, where they are looked at, in pixel widths: just inside, where neighbours do not look.
const CORNER: f64 = 0.49;

/// Adds the layers of [`enfilade_frame::Pass::Extra`] to a frame of `view`. `scene` is a scene, or what each row shows. `next` is the view of
/// the trajectory's next frame; without one there is no flow. The caller marks what moves in `surface_traits`. The frame must have its geometry layers.
///
/// # Panics
/// When the frame is not of the view's size, or lacks `depth_meters` or `normal_world`.
pub fn add_extra_layers<'a, 's: 'a>(scene: impl Into<Rows<'a, 's>>, view: &CameraView<'_>, next: Option<FlowTo<'_>>, frame: &mut Frame) {
    let rows = scene.into();
    let [width, height] = view.camera().size();
    assert_eq!([frame.width, frame.height], [width, height], "the frame must be of the view's size");
    let at = |index: u32| (index % width, index / width);
    let pixels: Vec<Option<Extra>> = map_up_to((width * height) as usize, |index| extra(&rows, view, next, at(index as u32)));
    let boundary = boundary::boundaries(view, frame);

    let half = |f: fn(&Extra) -> f32| Values::F16(pixels.iter().map(|p| f16::from_f32(p.as_ref().map_or(0.0, f))).collect());
    let halves = |f: fn(&Extra) -> [f32; 3], void: f32| {
        Values::F16(pixels.iter().flat_map(|p| p.as_ref().map_or([void; 3], f)).map(f16::from_f32).collect())
    };
    let number = |f: fn(&Extra) -> i16| Values::I16(pixels.iter().map(|p| p.as_ref().map_or(-1, f)).collect());
    frame.insert(Layer::MaterialId, number(|p| p.material));
    frame.insert(Layer::BaseColor, halves(|p| rgb(p.appearance.base_color), 0.0));
    frame.insert(Layer::Metallic, half(|p| p.appearance.metallic));
    frame.insert(Layer::Roughness, half(|p| p.appearance.roughness()));
    frame.insert(Layer::TransmissionWeight, half(|p| p.appearance.transmission));
    frame.insert(Layer::EmittedRadiance, halves(|p| p.emitted, 0.0));
    frame.insert(Layer::NormalGeometricWorld, halves(|p| p.normal.to_array(), f32::NAN));
    frame.insert(Layer::SurfaceTraits, Values::U8(pixels.iter().map(|p| p.as_ref().map_or(0, |p| p.traits)).collect()));
    frame.insert(Layer::DepthBehindMeters, Values::F32(pixels.iter().map(|p| p.as_ref().map_or(f32::NAN, |p| p.behind_m)).collect()));
    frame.insert(Layer::EntityBehindId, number(|p| p.entity_behind));
    frame.insert(Layer::DepthBeyondMeters, Values::F32(pixels.iter().map(|p| p.as_ref().map_or(f32::NAN, |p| p.beyond_m)).collect()));
    frame.insert(Layer::OcclusionBoundary, Values::U8(boundary));
    insert_flow(frame, &pixels.iter().map(|p| p.as_ref().and_then(|p| p.flow)).collect::<Vec<_>>());
}

/// Adds `optical_flow`, `scene_flow` and `flow_visibility` from the view `from` to any other view of the scene to a frame of `from`'s
/// size, with the same numbers as [`add_extra_layers`] has for the next view.
pub(crate) fn add_flow(rows: &Rows<'_, '_>, from: &CameraView<'_>, to: FlowTo<'_>, frame: &mut Frame) {
    let pixel = |index: u32| {
        let centre = (f64::from(index % frame.width) + 0.5, f64::from(index / frame.width) + 0.5);
        let scene = rows.at(centre.1);
        let found = sighting(scene, from, centre)?;
        flow::flow((scene, rows.band(centre.1)), from, to, centre, (found.triangle, found.p_world))
    };
    let flows: Vec<Option<Flow>> = map_up_to((frame.width * frame.height) as usize, |index| pixel(index as u32));
    insert_flow(frame, &flows);
}

fn insert_flow(frame: &mut Frame, flows: &[Option<Flow>]) {
    let image = |flow: &Option<Flow>| flow.and_then(|flow| flow.image).unwrap_or([f32::NAN; 2]);
    frame.insert(Layer::OpticalFlow, Values::F32(flows.iter().flat_map(image).collect()));
    frame.insert(Layer::SceneFlow, Values::F32(flows.iter().flat_map(|flow| flow.map_or([f32::NAN; 3], |flow| flow.camera)).collect()));
    frame.insert(Layer::FlowVisibility, Values::U8(flows.iter().map(|flow| u8::from(flow.is_some_and(|flow| flow.visible))).collect()));
}

/// The further layers of one pixel.
struct Extra {
    /// From 1.
    material: i16,
    appearance: Appearance,
    /// W/(sr m²).
    emitted: [f32; 3],
    /// Normal of the triangle, facing the camera.
    normal: Vec3,
    traits: u8,
    /// Metres; NaN when nothing but glass is met.
    behind_m: f32,
    /// From 1; −1 when nothing but glass is met.
    entity_behind: i16,
    /// Metres; NaN when the way of most of the light leaves the scene.
    beyond_m: f32,
    flow: Option<Flow>,
}

fn extra(rows: &Rows<'_, '_>, view: &CameraView<'_>, next: Option<FlowTo<'_>>, (x, y): (u32, u32)) -> Option<Extra> {
    let centre = (f64::from(x) + 0.5, f64::from(y) + 0.5);
    let (scene, band) = (rows.at(centre.1), rows.band(centre.1));
    let Sighting { surface, triangle: number, direction, distance_m, p_world } = sighting(scene, view, centre)?;
    let triangle = scene.triangles.get(number);
    let appearance = surface.appearance(scene);
    let (behind_m, entity_behind) = match appearance.transmission {
        0.0 => (distance_m as f32, (triangle.part + 1) as i16),
        _ => behind(scene, &surface, direction.as_vec3(), distance_m as f32),
    };
    let emitted = surface.emission(scene);
    let one_sided = !surface.outside && !surface.material.two_sided && !surface.material.bsdf.transmits();
    let mut bits = 0;
    for (is_set, bit) in [
        (appearance.metallic > 0.5 && appearance.alpha < MIRROR_ALPHA, traits::MIRROR),
        (appearance.transmission > 0.0, traits::GLASS),
        (!emitted.is_black(), traits::EMITTER),
        (is_partial(scene, view, centre, triangle.part), traits::PARTIAL),
        (one_sided, traits::BACK),
    ] {
        bits |= if is_set { bit } else { 0 };
    }
    Some(Extra {
        material: (triangle.material + 1) as i16,
        appearance,
        emitted: rgb(emitted),
        normal: surface.ng,
        traits: bits,
        behind_m,
        entity_behind,
        beyond_m: distance_beyond(scene, &surface, distance_m as f32),
        flow: next.and_then(|next| flow::flow((scene, band), view, next, centre, (number, p_world))),
    })
}

/// The channels, limited to the range of float16.
fn rgb(color: Rgb) -> [f32; 3] {
    [color.r, color.g, color.b].map(|v| v.min(f16::MAX.to_f32()))
}

/// Whether a corner of the pixel shows another part than `part`, or nothing.
fn is_partial(scene: &RenderScene<'_>, view: &CameraView<'_>, (x, y): (f64, f64), part: u32) -> bool {
    [(-CORNER, -CORNER), (CORNER, -CORNER), (-CORNER, CORNER), (CORNER, CORNER)].into_iter().any(|(dx, dy)| {
        let Some(CameraRay { origin, direction }) = view.centre_ray(x + dx, y + dy) else { return true };
        let hit = scene.closest(&Ray::new(origin.as_vec3(), direction.as_vec3()), AlphaTest::Half);
        hit.is_none_or(|hit| scene.triangles.get(hit.triangle).part != part)
    })
}

/// Distance to, and number of, the first surface straight on that lets no light through where it is met.
fn behind(scene: &RenderScene<'_>, first: &Surface<'_>, direction: Vec3, distance_m: f32) -> (f32, i16) {
    let (mut far_m, mut before) = (distance_m, first.clone());
    for _ in 0..MAX_PANES {
        let Some(hit) = scene.closest(&before.ray(direction), AlphaTest::Half) else { break };
        let surface = scene.surface(&hit, direction, &Cone::POINT);
        far_m += surface.p.distance(before.p);
        if surface.appearance(scene).transmission == 0.0 {
            return (far_m, (scene.triangles.get(hit.triangle).part + 1) as i16);
        }
        before = surface;
    }
    (f32::NAN, -1)
}
