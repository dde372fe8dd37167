//! Hypersim's tone map for samples: the exposure of an image, and its colour as displayed bytes, by a table for half precision.

use crate::sample::Image;
use enfilade_frame::tonemap::{ToneMap, brightness, encode};
use enfilade_frame::{Values, f16};
use half::slice::HalfFloatSliceExt;

/// The tone map of an image: 90th percentile of the brightness of the pixels that show the scene by `seen`, of all pixels if it is `None`.
pub(crate) fn fit(color: &Image, seen: Option<&Values>) -> ToneMap {
    let mut values = vec![0.0; color.values.len()];
    match &color.values {
        Values::F16(v) => v.convert_to_f32_slice(&mut values),
        other => values.iter_mut().enumerate().for_each(|(i, v)| *v = other.get(i) as f32),
    }
    let (pixels, _) = values.as_chunks::<3>();
    let shown = pixels.iter().enumerate().filter(|(i, _)| seen.is_none_or(|ids| ids.get(*i) != -1.0));
    let found: Vec<f64> = shown.map(|(_, pixel)| brightness(pixel.map(f64::from))).filter(|b| !b.is_nan()).collect();
    ToneMap::fit(found)
}

/// Radiance as displayed bytes.
pub(crate) fn displayed(color: &Image, tone: ToneMap) -> Image {
    let byte = |radiance: f64| (255.0 * encode(tone.scale * radiance)).round() as u8;
    let values = match &color.values {
        Values::F16(v) => {
            // The bytes of all numbers from zero to the largest; the others are black, or white if infinite.
            let table: Vec<u8> = (0..=f16::INFINITY.to_bits()).map(|bits| byte(f16::from_bits(bits).to_f64())).collect();
            v.iter().map(|v| table.get(usize::from(v.to_bits())).copied().unwrap_or(0)).collect()
        }
        other => (0..other.len()).map(|i| byte(other.get(i))).collect(),
    };
    Image { values: Values::U8(values), ..*color }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_gives_what_the_formula_gives() {
        let radiance = [0.0, 0.1, 0.7, 1.0, 3.0, 65504.0, -1.0, f32::NAN, f32::INFINITY, 1e-6, 0.25, 0.5];
        let half = Image { height: 2, width: 2, channels: 3, values: Values::F16(radiance.map(f16::from_f32).to_vec()) };
        let single = Image { values: Values::F32(radiance.map(|v| f16::from_f32(v).to_f32()).to_vec()), ..half };
        for tone in [ToneMap { scale: 1.0 }, ToneMap { scale: 0.3 }, ToneMap { scale: 0.0 }] {
            let (a, b) = (displayed(&half, tone), displayed(&single, tone));
            assert_eq!(a.values.as_bytes(), b.values.as_bytes(), "{tone:?}");
        }
    }

    #[test]
    fn the_exposure_shows_the_percentile_at_four_fifths() {
        let color = Image { height: 1, width: 4, channels: 3, values: Values::F32(vec![0.5; 12]) };
        assert_eq!(displayed(&color, fit(&color, None)).values, Values::U8(vec![204; 12]));
        let nothing_seen = fit(&color, Some(&Values::I16(vec![-1; 4])));
        assert_eq!(nothing_seen.scale, 1.0);
    }
}
