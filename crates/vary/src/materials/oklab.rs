//! Colours by lightness, chroma and hue in Oklab (Ottosson 2020, "A perceptual color space for image processing").

use enfilade_math::Rgb;

/// Lightness from 0 to 1, chroma (cloth seldom exceeds 0.15) and hue in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oklch {
    pub lightness: f32,
    pub chroma: f32,
    pub hue_deg: f32,
}

impl Oklch {
    /// Of linear RGB.
    pub fn of(rgb: Rgb) -> Self {
        let l = (0.412_221_46 * rgb.r + 0.536_332_55 * rgb.g + 0.051_445_995 * rgb.b).max(0.0).cbrt();
        let m = (0.211_903_5 * rgb.r + 0.680_699_5 * rgb.g + 0.107_396_96 * rgb.b).max(0.0).cbrt();
        let s = (0.088_302_46 * rgb.r + 0.281_718_85 * rgb.g + 0.629_978_7 * rgb.b).max(0.0).cbrt();
        let lightness = 0.210_454_26 * l + 0.793_617_8 * m - 0.004_072_047 * s;
        let a = 1.977_998_5 * l - 2.428_592_2 * m + 0.450_593_7 * s;
        let b = 0.025_904_037 * l + 0.782_771_77 * m - 0.808_675_77 * s;
        Self { lightness, chroma: a.hypot(b), hue_deg: b.atan2(a).to_degrees().rem_euclid(360.0) }
    }

    /// Linear RGB; channels outside of [0, 1] are not limited.
    pub fn rgb(self) -> Rgb {
        let (sin, cos) = self.hue_deg.to_radians().sin_cos();
        let (a, b) = (self.chroma * cos, self.chroma * sin);
        let cube = |v: f32| v * v * v;
        let l = cube(self.lightness + 0.396_337_78 * a + 0.215_803_76 * b);
        let m = cube(self.lightness - 0.105_561_346 * a - 0.063_854_17 * b);
        let s = cube(self.lightness - 0.089_484_18 * a - 1.291_485_5 * b);
        Rgb::new(
            4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s,
            -1.268_438 * l + 2.609_757_4 * m - 0.341_319_38 * s,
            -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_come_back_and_primaries_have_their_published_coordinates() {
        for rgb in [Rgb::new(0.2, 0.5, 0.7), Rgb::splat(0.18), Rgb::new(0.6, 0.1, 0.05)] {
            let back = Oklch::of(rgb).rgb();
            assert!((0..3).all(|c| (back[c] - rgb[c]).abs() < 1e-4), "{rgb:?} {back:?}");
        }
        let red = Oklch::of(Rgb::new(1.0, 0.0, 0.0));
        assert!((red.lightness - 0.628).abs() < 1e-3 && (red.chroma - 0.2577).abs() < 1e-3 && (red.hue_deg - 29.23).abs() < 0.1, "{red:?}");
        let white = Oklch::of(Rgb::WHITE);
        assert!((white.lightness - 1.0).abs() < 1e-3 && white.chroma < 1e-3);
    }
}
