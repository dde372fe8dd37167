//! Gates that the colour layers decide, as Marigold's programs compute them: 8-bit values are cut, not rounded.

use super::{Gate, GateValues};
use enfilade_frame::tonemap::{ToneMap, brightness};
use enfilade_frame::{Frame, Layer, Values};
use enfilade_math::quantile;

/// Quantile at which shading and residual are clipped before they are recombined.
const CLIP_QUANTILE: f64 = 0.98;

/// Score of equal pictures, dB.
const EQUAL_PSNR: f64 = 100.0;

/// The values of the gates of colour, as far as the layers are there.
pub fn light_values(frame: &Frame) -> GateValues {
    let mut values = GateValues::new();
    if let (Some(color), Some(tone)) = (frame.get(Layer::Color), ToneMap::of_frame(frame)) {
        values.insert(Gate::RgbRange, rgb_range(color, tone));
    }
    let least = |values: &Values| numbers(values).fold(f64::INFINITY, least_or_nan);
    if let Some(albedo) = frame.get(Layer::DiffuseReflectance) {
        values
            .insert(Gate::Albedo, numbers(albedo).map(|a| if a.is_nan() { a } else { (a - 1.0).max(-a).max(0.0) }).fold(0.0, most_or_nan));
    }
    for (gate, layer) in [(Gate::Shading, Layer::DiffuseIllumination), (Gate::Residual, Layer::Residual)] {
        values.extend(frame.get(layer).map(|layer| (gate, least(layer))));
    }
    values.extend(recomposition_psnr(frame).map(|psnr| (Gate::Recomposition, psnr)));
    values
}

fn numbers(values: &Values) -> impl Iterator<Item = f64> {
    (0..values.len()).map(|i| values.get(i))
}

fn least_or_nan(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.min(b) }
}

fn most_or_nan(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// Displayed value of a radiance in 8 bits.
fn byte(tone: ToneMap, radiance: f64) -> f64 {
    (255.0 * tone.apply(radiance)).floor()
}

fn rgb_range(color: &Values, tone: ToneMap) -> f64 {
    // A brighter radiance is shown brighter.
    let (least, greatest) = numbers(color).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    byte(tone, greatest) - byte(tone, least)
}

/// Similarity of the picture to one whose light is clipped at the 98th percentile of shading.
fn recomposition_psnr(frame: &Frame) -> Option<f64> {
    let [color, albedo, shading, residual] =
        [Layer::Color, Layer::DiffuseReflectance, Layer::DiffuseIllumination, Layer::Residual].map(|layer| frame.get(layer));
    let (color, albedo, shading, residual) = (color?, albedo?, shading?, residual?);
    let mut sorted: Vec<f64> = numbers(shading).collect();
    if sorted.iter().chain(&numbers(residual).collect::<Vec<_>>()).any(|v| v.is_nan()) {
        return Some(f64::NAN);
    }
    let clip = quantile(&mut sorted, CLIP_QUANTILE)?;
    let whole: Vec<f64> = numbers(color).collect();
    let clipped: Vec<f64> = (0..whole.len()).map(|i| albedo.get(i) * shading.get(i).min(clip) + residual.get(i).min(clip)).collect();
    let [a, b] = [&whole, &clipped].map(|picture| ToneMap::fit(picture.chunks_exact(3).map(|p| brightness([p[0], p[1], p[2]])).collect()));
    let squares: f64 = whole.iter().zip(&clipped).map(|(x, y)| (byte(a, *x) - byte(b, *y)).powi(2)).sum();
    let mean = squares / whole.len() as f64;
    Some((20.0 * (255.0 / mean.sqrt()).log10()).min(EQUAL_PSNR))
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_testroom::{self as testroom, pixel_of, set};

    /// A frame whose channels are all these values, one entry per pixel.
    fn grey(albedo: &[f64], shading: &[f64], residual: &[f64]) -> Frame {
        let mut frame = Frame::new(albedo.len() as u32, 1);
        let color: Vec<f64> = albedo.iter().zip(shading).zip(residual).map(|((a, s), r)| a * s + r).collect();
        let layers = [
            (Layer::Color, color.as_slice()),
            (Layer::DiffuseReflectance, albedo),
            (Layer::DiffuseIllumination, shading),
            (Layer::Residual, residual),
        ];
        for (layer, values) in layers {
            frame.insert(layer, testroom::store(layer, values.iter().flat_map(|v| [*v; 3]).collect()));
        }
        frame.insert(Layer::RenderEntityId, testroom::store(Layer::RenderEntityId, vec![1.0; albedo.len()]));
        frame
    }

    #[test]
    fn a_frame_without_highlights_survives_clipping_and_a_lamp_does_not() {
        let (albedo, shading) = (vec![0.5; 100], vec![1.0; 100]);
        let dull = light_values(&grey(&albedo, &shading, &vec![0.0; 100]));
        assert_eq!((dull[&Gate::Recomposition], dull[&Gate::RgbRange]), (EQUAL_PSNR, 0.0));
        // Eleven pixels of light are more than a tenth: the tone map follows them, and where they are cut everything else is brighter.
        let lamp: Vec<f64> = (0..100).map(|i| if i < 11 { 8.0 } else { 0.0 }).collect();
        let bright = light_values(&grey(&albedo, &shading, &lamp));
        let tone = |percentile: f64| ToneMap { scale: 0.8f64.powf(2.2) / percentile };
        let (dark, clear) = (byte(tone(8.5), 0.5), byte(tone(1.5), 0.5));
        let mean = 0.89 * (dark - clear).powi(2) + 0.11 * (byte(tone(8.5), 8.5) - byte(tone(1.5), 1.5)).powi(2);
        let expected = 10.0 * (255.0f64.powi(2) / mean).log10();
        assert!((bright[&Gate::Recomposition] - expected).abs() < 1e-9 && expected < 40.0, "{bright:?} {expected}");
    }

    #[test]
    fn every_gate_of_light_rejects_its_fault_alone() {
        let good = testroom::frame(&testroom::pose());
        let p = pixel_of(&good, 1);
        let rejected = |layer, value: f64| {
            let mut frame = good.clone();
            set(&mut frame, layer, p, &[0.2, value, 0.2]);
            let values = light_values(&frame);
            values.into_iter().filter(|(gate, value)| !gate.passes(*value)).map(|(gate, _)| gate).collect::<Vec<_>>()
        };
        let before = rejected(Layer::DiffuseReflectance, 0.2);
        let only = |layer, value| rejected(layer, value).into_iter().filter(|gate| !before.contains(gate)).collect::<Vec<_>>();
        assert_eq!(only(Layer::DiffuseReflectance, 1.001), [Gate::Albedo]);
        assert_eq!(only(Layer::DiffuseReflectance, -0.001), [Gate::Albedo]);
        assert_eq!(only(Layer::DiffuseReflectance, f64::NAN), [Gate::Albedo]);
        assert_eq!(only(Layer::DiffuseIllumination, -0.001), [Gate::Shading]);
        assert_eq!(only(Layer::Residual, -0.001), [Gate::Residual]);
        assert!(rejected(Layer::DiffuseIllumination, f64::NAN).contains(&Gate::Recomposition));
    }
}
