//! The colour of light by its temperature.
//!
//! The Planckian locus in CIE 1931 chromaticities is approximated by the cubic splines of Kim et al. 2002 (US patent 7 024 034, "Color
//! temperature conversion system and method using the same"), which stay within 0.0005 of it from 1667 to 25 000 K.

use enfilade_math::Rgb;

/// Temperatures that the splines cover, kelvin.
pub const KELVIN: [f64; 2] = [1667.0, 25_000.0];

/// Chromaticity x, y of a black body of `kelvin`, which is limited to `KELVIN`.
pub fn chromaticity(kelvin: f64) -> [f64; 2] {
    let t = kelvin.clamp(KELVIN[0], KELVIN[1]);
    let cubic = |[a, b, c, d]: [f64; 4], v: f64| ((a * v + b) * v + c) * v + d;
    let by_temperature = if t <= 4000.0 {
        [-0.266_123_9, -0.234_358_9, 0.877_695_6, 0.179_910]
    } else {
        [-3.025_846_9, 2.107_037_9, 0.222_634_7, 0.240_390]
    };
    let x = cubic(by_temperature, 1e3 / t);
    let by_x = match t {
        t if t <= 2222.0 => [-1.106_381_4, -1.348_110_20, 2.185_558_32, -0.202_196_83],
        t if t <= 4000.0 => [-0.954_947_6, -1.374_185_93, 2.091_370_15, -0.167_488_67],
        _ => [3.081_758_0, -5.873_386_70, 3.751_129_97, -0.370_014_83],
    };
    [x, cubic(by_x, x)]
}

/// Linear RGB of unit luminance of a black body of `kelvin`. What the primaries cannot show, below 1900 K, is limited to what they can.
pub fn color(kelvin: f64) -> Rgb {
    let [x, y] = chromaticity(kelvin);
    let [cx, cz] = [x / y, (1.0 - x - y) / y];
    // Rec. 709 primaries from CIE XYZ (IEC 61966-2-1), with Y = 1.
    let rgb = Rgb::new(
        (3.240_969_9 * cx - 1.537_383_2 - 0.498_610_8 * cz) as f32,
        (-0.969_243_6 * cx + 1.875_967_5 + 0.041_555_1 * cz) as f32,
        (0.055_630_1 * cx - 0.203_977 + 1.056_971_5 * cz) as f32,
    );
    let shown = rgb.map(|channel| channel.max(0.0));
    shown / shown.luminance()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_locus_has_the_chromaticities_of_tables() {
        // Planck's law with c2 = 1.4388 cm·K, as Wyszecki & Stiles 1982, table 1(3.11), has them.
        for (kelvin, x, y) in [(2000.0, 0.5267, 0.4133), (2700.0, 0.4599, 0.4106), (4000.0, 0.3805, 0.3768), (6500.0, 0.3135, 0.3237)] {
            let found = chromaticity(kelvin);
            assert!((found[0] - x).abs() < 1e-3 && (found[1] - y).abs() < 1e-3, "{kelvin} K: {found:?}, expected {x}, {y}");
        }
    }

    #[test]
    fn warm_light_is_orange_daylight_nearly_white_and_all_have_the_same_luminance() {
        let colors = [2700.0, 4000.0, 6500.0, 12_000.0].map(color);
        assert!(colors.iter().all(|c| (c.luminance() - 1.0).abs() < 1e-5 && c.r.min(c.g).min(c.b) > 0.0), "{colors:?}");
        assert!(colors.windows(2).all(|pair| pair[0].r > pair[1].r && pair[0].b < pair[1].b));
        assert!(colors[0].r > 1.5 && colors[0].b < 0.3, "{:?}", colors[0]);
        assert!((colors[2].r - 1.0).abs() < 0.06 && (colors[2].b - 1.0).abs() < 0.06, "{:?}", colors[2]);
    }
}
