//! Palettes made by rule, in Oklab's lightness, chroma and hue (Ottosson 2020, "A perceptual color space for image processing").

use super::{Palette, WHITE, floor_tile, wall_tile};
use crate::texture::{PaperPattern, Pattern, SlabLook, WoodTone};
use enfilade_math::{Rgb, Rng};
use std::f32::consts::TAU;

/// Linear RGB of Oklab's lightness (0 to 1), chroma (cloth seldom exceeds 0.15) and hue in turns; held within what surfaces reflect.
fn oklch(lightness: f32, chroma: f32, hue: f32) -> Rgb {
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

/// A palette of one leading hue and its companions.
///
/// Walls are pale and nearly neutral in three of four homes, tinted in one of eight, dark in one of eight; cloth lies at middling
/// lightness and small chroma, accents at larger chroma and hues that are near to the leading one, opposite, or a third away.
pub(super) fn palette(rng: &mut Rng) -> Palette {
    let hue = rng.next_f32();
    let companion = hue + [0.08, 0.5, 0.333, -0.333][rng.below(4)] + rng.range(-0.03, 0.03);
    let warm = rng.range(0.17, 0.28);
    let wall = match rng.below(8) {
        0 => oklch(rng.range(0.30, 0.45), rng.range(0.015, 0.05), hue),
        1 => oklch(rng.range(0.78, 0.88), rng.range(0.03, 0.06), hue),
        2..=4 => WHITE,
        _ => oklch(rng.range(0.88, 0.92), rng.range(0.005, 0.02), warm),
    };
    let accent_wall = oklch(rng.range(0.42, 0.82), rng.range(0.03, 0.07), hue);
    let cloth = |rng: &mut Rng, hue: f32, most: f32| oklch(rng.range(0.35, 0.82), most * rng.next_f32(), hue);
    let art = [
        oklch(0.92, 0.015, warm),
        oklch(rng.range(0.75, 0.84), 0.06, companion),
        oklch(rng.range(0.60, 0.70), 0.13, companion),
        oklch(rng.range(0.50, 0.60), 0.07, hue),
        oklch(rng.range(0.28, 0.36), 0.04, hue),
    ];
    let kitchen = [oklch(rng.range(0.35, 0.88), rng.range(0.0, 0.06), hue), oklch(rng.range(0.84, 0.92), 0.008, warm)];
    let mut palette = Palette {
        wall,
        accent_wall,
        floor: WoodTone::ALL[rng.below(8)],
        wood: WoodTone::ALL[rng.below(8)],
        sofa: cloth(rng, hue, 0.07),
        armchair: cloth(rng, companion, 0.11),
        rug: [oklch(rng.range(0.72, 0.88), 0.02, warm), oklch(rng.range(0.35, 0.6), 0.07, hue)],
        curtain: oklch(rng.range(0.80, 0.92), 0.015, warm),
        accents: [oklch(rng.range(0.62, 0.78), 0.13, companion), oklch(rng.range(0.45, 0.6), 0.11, hue), oklch(0.88, 0.02, warm)],
        art,
        kitchen,
        slab: [SlabLook::CARRARA, SlabLook::QUARTZ, SlabLook::GRANITE, SlabLook::LIMESTONE, SlabLook::MARQUINA][rng.below(5)],
        floor_tile: floor_tile(0, [art[3], art[4]], rng),
        wall_tile: wall_tile(0, [art[1], art[3]], rng),
        linen: [WHITE; 2],
        linen_pattern: Pattern::Plain,
        paper: PaperPattern::Grass,
        leather: oklch(rng.range(0.3, 0.52), 0.07, 0.15),
    };
    palette.details(rng);
    palette
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
