//! Spectra to linear Rec. 709 RGB, and the optical constants that Mitsuba knows by name.

use super::xml::Node;
use crate::ImportError;
use enfilade_math::{Rgb, linear_from_srgb};

/// Range of visible wavelengths, nm.
const VISIBLE: (u32, u32) = (360, 830);

/// What a spectrum describes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A reflectance or other factor: constant spectra are grey.
    Factor,
    /// Emitted light.
    Emission,
}

/// The colour of a property: `rgb`, `srgb`, `spectrum`, `blackbody`, `color`, or a plain `float`.
///
/// # Errors
/// When the value is none of what these may hold.
pub(super) fn color(node: &Node, kind: Kind) -> Result<Rgb, ImportError> {
    let text = node.attribute("value").unwrap_or_default().trim();
    match node.tag.as_str() {
        "blackbody" => blackbody(node),
        "rgb" | "srgb" | "color" if text.starts_with('#') => hex(node, text),
        "srgb" => Ok(triple(node)?.map(linear_from_srgb)),
        "spectrum" if text.contains(':') => sampled(node, text, kind),
        "rgb" | "spectrum" | "color" | "float" | "integer" => triple(node),
        other => Err(node.error(format!("<{other}> is not a colour; expected rgb, srgb, spectrum, blackbody or float"))),
    }
}

fn triple(node: &Node) -> Result<Rgb, ImportError> {
    match node.numbers("value")?[..] {
        [r, g, b] => Ok(Rgb::new(r as f32, g as f32, b as f32)),
        [all] => Ok(Rgb::splat(all as f32)),
        ref other => Err(node.error(format!("found {} numbers, expected 1 or 3", other.len()))),
    }
}

/// `#rrggbb`, always sRGB-encoded.
fn hex(node: &Node, text: &str) -> Result<Rgb, ImportError> {
    let digits = &text[1..];
    let byte = |i: usize| digits.get(i..i + 2).and_then(|d| u8::from_str_radix(d, 16).ok());
    match (digits.len(), byte(0), byte(2), byte(4)) {
        (6, Some(r), Some(g), Some(b)) => Ok(Rgb::new(f32::from(r), f32::from(g), f32::from(b)).map(|c| linear_from_srgb(c / 255.0))),
        _ => Err(node.error(format!("found the colour {text:?}, expected # and six hexadecimal digits"))),
    }
}

/// `wavelength:value` pairs, linear in between and zero outside.
fn sampled(node: &Node, text: &str, kind: Kind) -> Result<Rgb, ImportError> {
    let pairs = text.split(|c: char| c.is_whitespace() || c == ',').filter(|w| !w.is_empty()).map(|pair| {
        let (wavelength, value) = pair.split_once(':')?;
        Some((wavelength.parse::<f64>().ok()?, value.parse::<f64>().ok()?)).filter(|(w, v)| w.is_finite() && v.is_finite())
    });
    let mut pairs: Vec<(f64, f64)> =
        pairs.collect::<Option<_>>().ok_or_else(|| node.error(format!("found the spectrum {text:?}, expected wavelength:value pairs")))?;
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let value = |wavelength: f64| {
        let after = pairs.partition_point(|p| p.0 < wavelength);
        match (after.checked_sub(1).and_then(|i| pairs.get(i)), pairs.get(after)) {
            (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (wavelength - a.0) / (b.0 - a.0).max(f64::MIN_POSITIVE),
            (None, Some(b)) if b.0 == wavelength => b.1,
            _ => 0.0,
        }
    };
    let rgb = rgb_of(value);
    Ok(match kind {
        Kind::Emission => rgb,
        Kind::Factor => {
            let white = rgb_of(|_| 1.0);
            Rgb::new(rgb.r / white.r, rgb.g / white.g, rgb.b / white.b)
        }
    })
}

/// Planck's radiance of a `temperature` (kelvin) per nanometre, times `scale`.
fn blackbody(node: &Node) -> Result<Rgb, ImportError> {
    let text = node.attribute("temperature").or(node.attribute("value")).unwrap_or_default().trim_end_matches(['K', 'k', ' ']);
    let kelvin: f64 =
        text.parse().ok().filter(|t| (1.0..1e6).contains(t)).ok_or_else(|| node.error("the temperature should be in kelvin"))?;
    let scale = node.numbers("scale")?.first().copied().unwrap_or(1.0);
    let planck = |nm: f64| {
        let metres = nm * 1e-9;
        1e-9 * 1.191_043e-16 / (metres.powi(5) * ((1.438_777e-2 / (metres * kelvin)).exp() - 1.0))
    };
    Ok(rgb_of(planck) * scale as f32)
}

/// Linear RGB of a spectrum, such that a constant one has luminance equal to its value.
fn rgb_of(spectrum: impl Fn(f64) -> f64) -> Rgb {
    let mut xyz = [0.0; 3];
    let mut normalization = 0.0;
    for nm in VISIBLE.0..=VISIBLE.1 {
        let (matching, value) = (matching_functions(f64::from(nm)), spectrum(f64::from(nm)));
        (0..3).for_each(|i| xyz[i] += matching[i] * value);
        normalization += matching[1];
    }
    let [x, y, z] = xyz.map(|v| v / normalization);
    let channel = |a: f64, b: f64, c: f64| (a * x + b * y + c * z).max(0.0) as f32;
    Rgb::new(channel(3.240_97, -1.537_38, -0.498_61), channel(-0.969_24, 1.875_97, 0.041_56), channel(0.055_63, -0.203_98, 1.056_97))
}

/// The CIE 1931 colour matching functions in the multi-lobe fit of Wyman, Sloan & Shirley 2013.
fn matching_functions(nm: f64) -> [f64; 3] {
    let lobe = |mean: f64, below: f64, above: f64| (-0.5 * ((nm - mean) / if nm < mean { below } else { above }).powi(2)).exp();
    [
        1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2),
        0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
        1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8),
    ]
}

/// Index of refraction of a metal by Mitsuba's name for it, as RGB: (eta, k). `none` is a perfect mirror.
pub(super) fn metal(name: &str) -> Option<(Rgb, Rgb)> {
    let rgb = |eta: [f32; 3], k: [f32; 3]| Some((Rgb::from(eta), Rgb::from(k)));
    match name.to_ascii_lowercase().as_str() {
        "none" => rgb([0.0; 3], [0.0; 3]),
        "ag" => rgb([0.155_5, 0.116_8, 0.138_3], [4.831_8, 3.123_0, 2.148_7]),
        "al" => rgb([1.657_5, 0.880_4, 0.521_2], [9.223_9, 6.269_5, 4.837_0]),
        "au" => rgb([0.143_1, 0.375_0, 1.442_5], [3.983_2, 2.385_7, 1.603_2]),
        "cr" => rgb([4.369_7, 2.916_7, 1.654_7], [5.206_4, 4.231_4, 3.754_9]),
        "cu" => rgb([0.200_4, 0.924_0, 1.102_2], [3.912_9, 2.452_9, 2.142_2]),
        _ => None,
    }
}

/// Index of refraction of a clear substance by Mitsuba's name for it.
pub(super) fn substance(name: &str) -> Option<f64> {
    const SUBSTANCES: [(&str, f64); 16] = [
        ("vacuum", 1.0),
        ("air", 1.000_277),
        ("water", 1.333),
        ("water ice", 1.31),
        ("acetone", 1.36),
        ("ethanol", 1.361),
        ("glycerol", 1.472_9),
        ("benzene", 1.501),
        ("fused quartz", 1.458),
        ("pyrex", 1.47),
        ("acrylic glass", 1.49),
        ("polypropylene", 1.49),
        ("bk7", 1.504_6),
        ("amber", 1.55),
        ("pet", 1.575),
        ("diamond", 2.419),
    ];
    SUBSTANCES.iter().find(|(n, _)| n.eq_ignore_ascii_case(name.trim())).map(|(_, eta)| *eta)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constant_spectra_have_their_luminance_and_daylight_is_nearly_white() {
        assert!((rgb_of(|_| 0.5).luminance() - 0.5).abs() < 1e-3);
        let planck = |t: f64| move |nm: f64| 1.0 / (nm.powi(5) * ((1.438_777e7 / (nm * t)).exp() - 1.0));
        let day = rgb_of(planck(6504.0));
        assert!((day.r / day.g - 1.0).abs() < 0.1 && (day.b / day.g - 1.0).abs() < 0.1, "{day:?}");
        let lamp = rgb_of(planck(2700.0));
        assert!(lamp.r > 1.5 * lamp.g && lamp.g > 2.0 * lamp.b, "{lamp:?}");
    }
}
