//! Laws of the colour layers and the reason codes.

use super::law::Law;
use super::scan::Scan;
use enfilade_frame::{Layer, Validity, f16};

const COLOR_LAYERS: [Layer; 7] = [
    Layer::Color,
    Layer::DiffuseIllumination,
    Layer::DiffuseReflectance,
    Layer::Residual,
    Layer::ColorDenoised,
    Layer::DiffuseIlluminationDenoised,
    Layer::ResidualDenoised,
];

pub(super) fn check(scan: &mut Scan<'_>) {
    for layer in COLOR_LAYERS {
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
    recomposition(scan, [Layer::ColorDenoised, Layer::DiffuseIlluminationDenoised, Layer::ResidualDenoised]);
    void_codes(scan);
    reason_codes(scan);
}

/// `parts`: a colour, the illumination and the residual that it is made of.
fn recomposition(scan: &mut Scan<'_>, parts: [Layer; 3]) {
    let Some(reflectance) = scan.layer(Layer::DiffuseReflectance) else { return };
    let [Some(color), Some(illumination), Some(residual)] = parts.map(|layer| scan.layer(layer)) else { return };
    let differs = |i: &usize| {
        let sum = reflectance.get(*i) as f32 * illumination.get(*i) as f32 + residual.get(*i) as f32;
        f16::from_f32(sum).to_f64() != color.get(*i)
    };
    let what = format!("{} is not A * S + R", parts[0].spec().name);
    scan.broken(Law::Recomposition, &what, (0..color.len()).filter(differs).map(|i| i / 3));
}

fn void_codes(scan: &mut Scan<'_>) {
    let (Some(codes), Some(ids)) = (scan.layer(Layer::Valid), scan.layer(Layer::RenderEntityId)) else { return };
    let void = f64::from(Validity::Void as u8);
    let differ = (0..ids.len()).filter(|&i| (codes.get(i) == void) != (ids.get(i) == -1.0));
    scan.broken(Law::VoidCode, "valid and render_entity_id disagree", differ);
}

fn reason_codes(scan: &mut Scan<'_>) {
    let (Some(codes), Some(reflectance)) = (scan.layer(Layer::Valid), scan.layer(Layer::DiffuseReflectance)) else { return };
    let radiance: Vec<_> = [Layer::Color, Layer::DiffuseIllumination, Layer::Residual].into_iter().filter_map(|l| scan.layer(l)).collect();
    let any = |pixel: usize, test: &dyn Fn(usize) -> bool| (3 * pixel..3 * pixel + 3).any(test);
    let expected = |pixel: usize| {
        let saturated = any(pixel, &|i| radiance.iter().any(|values| values.get(i) >= f16::MAX.to_f64()));
        let diffuse = any(pixel, &|i| reflectance.get(i) != 0.0);
        match (saturated, diffuse) {
            (true, _) => Validity::Saturated,
            (false, false) => Validity::NoDiffuse,
            (false, true) => Validity::Valid,
        }
    };
    let wrong =
        (0..codes.len()).filter(|&i| codes.get(i) != f64::from(Validity::Void as u8) && codes.get(i) != f64::from(expected(i) as u8));
    scan.broken(Law::ReasonCodes, "another reason code would be right", wrong);
}
