//! Colours by lightness, chroma and hue in Oklab (Ottosson 2020, "A perceptual color space for image processing").

use enfilade_math::{Rgb, Rng};
use std::f32::consts::TAU;

/// Linear RGB of Oklab's lightness (0 to 1), chroma (cloth seldom exceeds 0.15) and hue in turns; limited to what surfaces can reflect.
pub(super) fn oklch(lightness: f32, chroma: f32, hue: f32) -> Rgb {
    let (sin, cos) = (TAU * hue).sin_cos();
    let (a, b) = (chroma * cos, chroma * sin);
    let cube = |v: f32| v * v * v;
    let l = cube(lightness + 0.396_337_78 * a + 0.215_803_76 * b);
    let m = cube(lightness - 0.105_561_346 * a - 0.063_854_17 * b);
    let s = cube(lightness - 0.089_484_18 * a - 1.291_485_5 * b);
    let rgb = Rgb::new(
        4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s,
        -1.268_438 * l + 2.609_757_4 * m - 0.341_319_38 * s,
        -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s,
    );
    rgb.map(|v| v.clamp(0.012, 0.82))
}

/// Any colour that a surface may have.
pub(super) fn any_color(rng: &mut Rng) -> Rgb {
    oklch(rng.range(0.25, 0.93), rng.range(0.0, 0.2), rng.next_f32())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn greys_have_no_chroma_and_hues_are_where_they_should_be() {
        let grey = oklch(0.6, 0.0, 0.3);
        assert!((grey.r - 0.216).abs() < 1e-3 && (grey.r - grey.g).abs() < 1e-3 && (grey.g - grey.b).abs() < 1e-3, "{grey:?}");
        // The hue of sRGB's red is 29.2 degrees, of its blue 264.1.
        let (red, blue) = (oklch(0.5, 0.15, 29.2 / 360.0), oklch(0.4, 0.15, 264.1 / 360.0));
        assert!(red.r > 3.0 * red.g && red.r > 3.0 * red.b && blue.b > 3.0 * blue.r, "{red:?} {blue:?}");
    }
}
