//! Laws of the colour layers and the reason codes.

use super::law::Law;
use super::rounding::half_step;
use super::scan::Scan;
use enfilade_frame::{DENOISED, LIGHT_BY_PATH, LIGHT_BY_SOURCE, Layer, Validity, Values, f16};
use enfilade_math::Rgb;

/// Above this value of a colour, one of its parts may have been beyond float16.
const NEAR_LIMIT: f64 = 65_000.0;
/// The largest float16 but one: what a colour beyond the largest becomes where no residual makes A * S + R that.
const BELOW_LIMIT: f64 = 65_472.0;
/// Below this radiance the rounding of float16 is no longer relative.
pub(super) const DIM: f64 = 1e-3;

const COLOR_LAYERS: [Layer; 7] = [
    Layer::Color,
    Layer::DiffuseIllumination,
    Layer::DiffuseReflectance,
    Layer::Residual,
    Layer::ColorRendered,
    Layer::DiffuseIlluminationRendered,
    Layer::ResidualRendered,
];

pub(super) fn check(scan: &mut Scan<'_>) {
    for layer in COLOR_LAYERS.into_iter().chain(LIGHT_BY_PATH).chain(LIGHT_BY_SOURCE) {
        let Some(values) = scan.layer(layer) else { continue };
        let name = layer.spec().name;
        scan.broken(Law::ColorFinite, name, (0..values.len()).filter(|&i| !values.get(i).is_finite()).map(|i| i / 3));
        let below_zero = (0..values.len()).map(|i| (i / 3, if values.get(i) < 0.0 { -values.get(i) } else { 0.0 }));
        scan.worst(Law::ColorNotNegative, name, below_zero);
    }
    if let Some(reflectance) = scan.layer(Layer::DiffuseReflectance) {
        let finite = (0..reflectance.len()).map(|i| (i / 3, reflectance.get(i))).filter(|(_, v)| v.is_finite());
        scan.worst(Law::Albedo, "diffuse_reflectance", finite);
    }
    recomposition(scan, [Layer::Color, Layer::DiffuseIllumination, Layer::Residual]);
    recomposition(scan, [Layer::ColorRendered, Layer::DiffuseIlluminationRendered, Layer::ResidualRendered]);
    standard_error(scan);
    light_parts(scan, &LIGHT_BY_PATH, Layer::Color);
    light_parts(scan, &LIGHT_BY_SOURCE, Layer::Color);
    light_parts(scan, &[Layer::Specular, Layer::Transmission, Layer::Emission], Layer::Residual);
    void_codes(scan);
    reason_codes(scan);
}

/// `parts`: a colour, the illumination and the residual that it is made of.
fn recomposition(scan: &mut Scan<'_>, parts: [Layer; 3]) {
    let Some(reflectance) = scan.layer(Layer::DiffuseReflectance) else { return };
    let [Some(color), Some(illumination), Some(residual)] = parts.map(|layer| scan.layer(layer)) else { return };
    if scan.view.released {
        return rounded_recomposition(scan, [color, reflectance, illumination, residual]);
    }
    let differs = |i: &usize| {
        let sum = reflectance.get(*i) as f32 * illumination.get(*i) as f32 + residual.get(*i) as f32;
        f16::from_f32(sum).to_f64() != color.get(*i)
    };
    let what = format!("{} is not A * S + R", parts[0].spec().name);
    scan.broken(Law::Recomposition, &what, (0..color.len()).filter(differs).map(|i| i / 3));
}

/// Checks the sum for four layers that were rounded separately: only differences beyond rounding count. Overflown values are skipped.
fn rounded_recomposition(scan: &mut Scan<'_>, layers: [&Values; 4]) {
    let differs = |i: &usize| {
        let [color, a, s, r] = layers.map(|layer| layer.get(*i));
        let product = a.abs() * half_step(s) + s.abs() * half_step(a) + half_step(a) * half_step(s);
        (a * s + r - color).abs() > product + half_step(r) + half_step(color)
    };
    let count = layers[0].len();
    scan.broken(Law::Recomposition, "color is not A * S + R within the rounding of float16", (0..count).filter(differs).map(|i| i / 3));
}

/// Samples are not negative, so their mean's standard error is at most the mean: as much as that when all but one are zero.
fn standard_error(scan: &mut Scan<'_>) {
    let (Some(errors), Some(color)) = (scan.layer(Layer::ColorStandardError), scan.rendered(Layer::Color)) else { return };
    let all_unknown = (0..errors.len()).all(|pixel| errors.get(pixel).is_nan());
    let is_cut = may_be_cut(scan, color);
    let excess = |pixel: usize| {
        let error = errors.get(pixel);
        let [r, g, b] = [0, 1, 2].map(|channel| color.get(3 * pixel + channel));
        let luminance = f64::from(Rgb::new(r as f32, g as f32, b as f32).luminance()).max(0.0);
        match (all_unknown, error < 0.0 || !error.is_finite()) {
            (true, _) => 0.0,
            (false, true) => f64::INFINITY,
            (false, false) if is_cut(pixel) || !luminance.is_finite() => 0.0,
            (false, false) => (error - luminance).max(0.0) / luminance.max(DIM),
        }
    };
    scan.worst(Law::StandardError, "color_standard_error", (0..errors.len()).map(|pixel| (pixel, excess(pixel))));
}

/// `parts` sum to `whole`. Each value is rounded to float16 on its own (half a unit in the last place, 2⁻¹² to 2⁻¹¹ of it), and so are
/// the factors of color, which makes at most 3 × 2⁻¹¹ of the sum.
fn light_parts(scan: &mut Scan<'_>, parts: &[Layer], whole: Layer) {
    let layers: Vec<&Values> = parts.iter().filter_map(|&layer| scan.layer(layer)).collect();
    let (Some(values), Some(color)) = (scan.rendered(whole), scan.rendered(Layer::Color)) else { return };
    if layers.len() < parts.len() {
        return;
    }
    let is_cut = may_be_cut(scan, color);
    let error = |i: usize| {
        let sum: f64 = layers.iter().map(|layer| layer.get(i)).sum();
        (sum - values.get(i)).abs() / values.get(i).max(DIM)
    };
    let errors = (0..values.len()).filter(|i| !is_cut(i / 3)).map(|i| (i / 3, error(i)));
    let first = parts.first().map_or("", |layer| layer.spec().name);
    scan.worst(Law::LightParts, &format!("{first} and the layers that go with it do not sum to {}", whole.spec().name), errors);
}

/// True where some channel of the colour, or of the illumination that is in it, may have been cut at the largest float16, or is no number.
pub(super) fn may_be_cut<'a>(scan: &Scan<'a>, color: &'a Values) -> impl Fn(usize) -> bool + use<'a> {
    let illumination = scan.rendered(Layer::DiffuseIllumination);
    let is_near_limit = |values: &Values, i: usize| values.get(i).is_nan() || values.get(i) >= NEAR_LIMIT;
    move |pixel| (3 * pixel..3 * pixel + 3).any(|i| is_near_limit(color, i) || illumination.is_some_and(|values| is_near_limit(values, i)))
}

fn void_codes(scan: &mut Scan<'_>) {
    let (Some(codes), Some(ids)) = (scan.layer(Layer::Valid), scan.layer(Layer::RenderEntityId)) else { return };
    let void = f64::from(Validity::Void as u8);
    let differ = (0..ids.len()).filter(|&i| (codes.get(i) == void) != (ids.get(i) == -1.0));
    scan.broken(Law::VoidCode, "valid and render_entity_id disagree", differ);
}

fn reason_codes(scan: &mut Scan<'_>) {
    let (Some(codes), Some(reflectance)) = (scan.layer(Layer::Valid), scan.layer(Layer::DiffuseReflectance)) else { return };
    let radiance: Vec<_> = DENOISED.into_iter().filter_map(|(layer, _)| scan.rendered(layer)).collect();
    let is_known = !radiance.is_empty();
    let any = |pixel: usize, test: &dyn Fn(usize) -> bool| (3 * pixel..3 * pixel + 3).any(test);
    let reaches = |pixel: usize, value: f64| any(pixel, &|i| radiance.iter().any(|values| values.get(i) >= value));
    let is_right = |pixel: usize| {
        let diffuse = any(pixel, &|i| reflectance.get(i) != 0.0);
        let unsaturated = if diffuse { Validity::Valid } else { Validity::NoDiffuse };
        match codes.get(pixel) {
            code if code == f64::from(Validity::Saturated as u8) => !is_known || reaches(pixel, BELOW_LIMIT),
            code => code == f64::from(unsaturated as u8) && !reaches(pixel, f16::MAX.to_f64()),
        }
    };
    let wrong = (0..codes.len()).filter(|&i| codes.get(i) != f64::from(Validity::Void as u8) && !is_right(i));
    scan.broken(Law::ReasonCodes, "another reason code would be right", wrong);
}
