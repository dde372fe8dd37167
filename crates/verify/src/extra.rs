//! The law of the optional layers of a frame: what guides denoising, material, surfaces behind glass, flow.

use super::law::Law;
use super::scan::Scan;
use enfilade_frame::vector;
use enfilade_frame::{Layer, Values, traits};

/// Rounding of float16 and of two ways to the same distance.
const ROUNDING: f64 = 2e-3;

/// A named condition of one pixel.
type Condition<'a> = (&'a str, &'a dyn Fn(usize) -> bool);

pub(super) fn check(scan: &mut Scan<'_>) {
    check_guides(scan);
    check_extra(scan);
}

fn check_guides(scan: &mut Scan<'_>) {
    let layers = [Layer::NormalFilteredWorld, Layer::NormalBeyondWorld, Layer::ReflectanceBeyond].map(|layer| scan.frame.get(layer));
    let [Some(filtered), Some(beyond), Some(reflectance)] = layers else { return };
    let is_mean = |i: &usize| [filtered, beyond].iter().all(|normal| vector(normal, *i).length() <= 1.0 + ROUNDING);
    let is_share = |i: &usize| (3 * i..3 * i + 3).all(|c| (0.0..=1.0).contains(&reflectance.get(c)));
    let what = "normal_filtered_world and normal_beyond_world must be at most unit vectors, reflectance_beyond on [0,1]";
    scan.broken(Law::ExtraLayers, what, (0..scan.frame.pixels()).filter(|i| !is_mean(i) || !is_share(i)));
}

fn check_extra(scan: &mut Scan<'_>) {
    let layers = [
        Layer::RenderEntityId,
        Layer::DepthMeters,
        Layer::BaseColor,
        Layer::Metallic,
        Layer::Roughness,
        Layer::TransmissionWeight,
        Layer::NormalGeometricWorld,
        Layer::SurfaceTraits,
        Layer::DepthBehindMeters,
        Layer::EntityBehindId,
        Layer::OcclusionBoundary,
        Layer::OpticalFlow,
        Layer::SceneFlow,
        Layer::FlowVisibility,
    ];
    let found: Vec<&Values> = layers.iter().filter_map(|layer| scan.frame.get(*layer)).collect();
    let Ok(found) = <[&Values; 14]>::try_from(found) else { return };
    let [entity, depth, base, metallic, roughness, transmission, normal, kind, behind, entity_behind, boundary, image, camera, visible] =
        found;
    let share = |v: f64| (0.0..=1.0 + ROUNDING).contains(&v);
    let void = |i: usize| entity.get(i) == -1.0;
    let parameters = |i: usize| {
        let colors = (3 * i..3 * i + 3).all(|c| share(base.get(c)));
        colors && [metallic, roughness, transmission].iter().all(|values| share(values.get(i)))
    };
    let normals = |i: usize| if void(i) { vector(normal, i).is_nan() } else { (vector(normal, i).length() - 1.0).abs() < ROUNDING };
    let opaque = |i: usize| kind.get(i) as u8 & traits::GLASS == 0;
    let beyond = |i: usize| match (void(i), behind.get(i).is_nan()) {
        (true, nothing) => nothing && entity_behind.get(i) == -1.0,
        (false, true) => !opaque(i) && entity_behind.get(i) == -1.0,
        (false, false) if opaque(i) => entity_behind.get(i) == entity.get(i) && behind.get(i) == depth.get(i),
        (false, false) => behind.get(i) >= depth.get(i) * (1.0 - ROUNDING) && entity_behind.get(i) >= 1.0,
    };
    // Later versions added it.
    let way = scan.frame.get(Layer::DepthBeyondMeters);
    let farther = |i: usize| way.is_none_or(|way| way.get(i).is_nan() || !void(i) && way.get(i) >= depth.get(i) * (1.0 - ROUNDING));
    let codes = |i: usize| boundary.get(i) <= 2.0 && visible.get(i) <= 1.0 && kind.get(i) <= 63.0;
    let flows = |i: usize| {
        let moved = vector(camera, i).is_finite();
        let shown = image.get(2 * i).is_finite() && image.get(2 * i + 1).is_finite();
        !(void(i) && moved) && (!shown || moved) && (visible.get(i) == 0.0 || shown)
    };
    let conditions: [Condition; 6] = [
        ("base_color, metallic, roughness and transmission_weight must lie on [0,1]", &parameters),
        ("normal_geometric_world must be a unit vector where something is hit", &normals),
        ("depth_behind_meters and entity_behind_id must be the first surface, or beyond it", &beyond),
        ("depth_beyond_meters must be the first surface, or farther", &farther),
        ("occlusion_boundary, flow_visibility and surface_traits must be of their codes", &codes),
        ("flow is only of surfaces, and visible only where it has an image", &flows),
    ];
    let pixels = entity.len();
    for (what, holds) in conditions {
        scan.broken(Law::ExtraLayers, what, (0..pixels).filter(|i| !holds(*i)));
    }
}
