//! The names of colours: the eleven basic terms of English (Berlin & Kay 1969, "Basic Color Terms") and beige, recognised by lightness,
//! chroma and hue in Oklab (Ottosson 2020, "A perceptual color space for image processing").

/// Less chroma than this is none; between red and yellow people see it sooner.
const GREY: f32 = 0.04;
const EARTHY_GREY: f32 = 0.012;
/// Lightness below which it is black, and above which it is white.
const BLACK: f32 = 0.32;
const WHITE: f32 = 0.86;

/// Every name there is.
pub const NAMES: [&str; 12] = ["black", "grey", "white", "red", "orange", "yellow", "green", "blue", "purple", "pink", "brown", "beige"];

/// The name of a diffuse reflectance, linear sRGB on [0, 1].
pub fn color_name(rgb: [f32; 3]) -> &'static str {
    let [lightness, a, b] = oklab(rgb);
    let (chroma, hue) = (a.hypot(b), b.atan2(a).to_degrees().rem_euclid(360.0));
    // Wood, leather, sand: dark or pale, and between red and yellow.
    let earthy = (45.0..110.0).contains(&hue) && chroma >= EARTHY_GREY;
    if earthy && lightness > 0.68 && chroma < 0.085 {
        return if lightness > 0.93 && chroma < 0.03 { "white" } else { "beige" };
    }
    if chroma < GREY || lightness < 0.2 {
        return if lightness < BLACK {
            "black"
        } else if lightness > WHITE {
            "white"
        } else {
            "grey"
        };
    }
    if (35.0..110.0).contains(&hue) && lightness < 0.68 && chroma < 0.13 {
        return "brown";
    }
    match hue {
        h if h < 12.0 => "pink",
        h if h < 42.0 => {
            if lightness > 0.7 && chroma < 0.14 {
                "pink"
            } else {
                "red"
            }
        }
        h if h < 78.0 => "orange",
        h if h < 112.0 => "yellow",
        h if h < 185.0 => "green",
        h if h < 285.0 => "blue",
        h if h < 330.0 => "purple",
        _ => "pink",
    }
}

/// Lightness, a and b of linear sRGB.
fn oklab([r, g, b]: [f32; 3]) -> [f32; 3] {
    let l = (0.412_221_46 * r + 0.536_332_55 * g + 0.051_445_995 * b).max(0.0).cbrt();
    let m = (0.211_903_5 * r + 0.680_699_5 * g + 0.107_396_96 * b).max(0.0).cbrt();
    let s = (0.088_302_46 * r + 0.281_718_85 * g + 0.629_978_7 * b).max(0.0).cbrt();
    [
        0.210_454_26 * l + 0.793_617_8 * m - 0.004_072_047 * s,
        1.977_998_5 * l - 2.428_592_2 * m + 0.450_593_7 * s,
        0.025_904_037 * l + 0.782_771_77 * m - 0.808_675_77 * s,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names agree with CSS's named colours, which people named.
    #[test]
    fn names_are_those_that_people_gave() {
        let named = [
            ("black", [0, 0, 0]),
            ("white", [255, 255, 255]),
            ("white", [245, 245, 245]),
            ("grey", [128, 128, 128]),
            ("grey", [169, 169, 169]),
            ("red", [255, 0, 0]),
            ("red", [178, 34, 34]),
            ("orange", [255, 165, 0]),
            ("orange", [255, 140, 0]),
            ("yellow", [255, 255, 0]),
            ("yellow", [255, 215, 0]),
            ("green", [0, 128, 0]),
            ("green", [34, 139, 34]),
            ("green", [143, 188, 143]),
            ("blue", [0, 0, 255]),
            ("blue", [70, 130, 180]),
            ("blue", [25, 25, 112]),
            ("purple", [128, 0, 128]),
            ("purple", [147, 112, 219]),
            ("pink", [255, 192, 203]),
            ("pink", [255, 105, 180]),
            ("brown", [139, 69, 19]),
            ("brown", [160, 82, 45]),
            ("beige", [222, 184, 135]),
            ("beige", [210, 180, 140]),
        ];
        let linear = |v: i32| ((f64::from(v) / 255.0 + 0.055) / 1.055).powf(2.4) as f32;
        for (name, srgb) in named {
            assert_eq!(color_name(srgb.map(linear)), name, "{srgb:?} {:?}", oklab(srgb.map(linear)));
        }
        assert!(named.iter().all(|(name, _)| NAMES.contains(name)));
    }
}
