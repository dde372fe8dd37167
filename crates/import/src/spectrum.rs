//! Spectra to linear Rec. 709 RGB, and the optical constants of metals, for all formats that have them.

use crate::ImportError;
use enfilade_math::Rgb;
use std::path::Path;

/// Range of visible wavelengths, nm.
const VISIBLE: (u32, u32) = (360, 830);

/// The quantity that a spectrum describes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A reflectance or other factor: constant spectra are grey.
    Factor,
    /// Emitted light.
    Emission,
}

/// The colour of samples (wavelength in nm, value), linear in between and zero outside; sorts them.
pub(crate) fn sampled(pairs: &mut [(f64, f64)], kind: Kind) -> Rgb {
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
    match kind {
        Kind::Emission => rgb,
        Kind::Factor => {
            let white = rgb_of(|_| 1.0);
            Rgb::new(rgb.r / white.r, rgb.g / white.g, rgb.b / white.b)
        }
    }
}

/// The samples (wavelength in nm, value) that a file lists, between spaces, commas and ends of lines; comments begin with `#`.
///
/// # Errors
/// When a word is not a finite number, or the last one has no partner.
pub(crate) fn pairs(bytes: &[u8], file: &Path) -> Result<Vec<(f64, f64)>, ImportError> {
    let mut numbers = Vec::new();
    for (i, line) in enfilade_scene::decoded_text(bytes).lines().enumerate() {
        let values = line.split('#').next().unwrap_or_default();
        for word in values.split(|c: char| c.is_whitespace() || c == ',').filter(|w| !w.is_empty()) {
            let number = word.parse::<f64>().ok().filter(|n| n.is_finite());
            let problem = || ImportError::malformed(file, format!("line {}", i + 1), format!("{word:?} is not a finite number"));
            numbers.push(number.ok_or_else(problem)?);
        }
    }
    if numbers.len() < 2 || !numbers.len().is_multiple_of(2) {
        let problem = format!("found {} numbers, expected pairs of wavelength and value", numbers.len());
        return Err(ImportError::malformed(file, "whole file", problem));
    }
    Ok(numbers.chunks_exact(2).map(|p| (p[0], p[1])).collect())
}

/// Planck's radiance of a temperature in kelvin at a wavelength in nm, W·m⁻²·sr⁻¹·nm⁻¹.
pub(crate) fn planck(kelvin: f64, nm: f64) -> f64 {
    let metres = nm * 1e-9;
    1e-9 * 1.191_043e-16 / (metres.powi(5) * ((1.438_777e-2 / (metres * kelvin)).exp() - 1.0))
}

/// Radiance of a black body per nanometre, as linear RGB.
pub(crate) fn black_body(kelvin: f64) -> Rgb {
    rgb_of(|nm| planck(kelvin, nm))
}

/// Linear RGB of a spectrum, such that a constant one has luminance equal to its value.
pub(crate) fn rgb_of(spectrum: impl Fn(f64) -> f64) -> Rgb {
    let mut xyz = [0.0; 3];
    let mut normalization = 0.0;
    for nm in VISIBLE.0..=VISIBLE.1 {
        let (matching, value) = (matching_functions(f64::from(nm)), spectrum(f64::from(nm)));
        (0..3).for_each(|i| xyz[i] += matching[i] * value);
        normalization += matching[1];
    }
    Rgb::from_xyz(xyz.map(|v| v / normalization))
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
///
/// Mitsuba's measured spectra (Johnson & Christy, Palik and others by way of the Luxpop and SOPRA collections) under its conversion to
/// RGB.
pub(crate) fn metal(name: &str) -> Option<(Rgb, Rgb)> {
    const METALS: [(&str, [f32; 3], [f32; 3]); 26] = [
        ("none", [0.0; 3], [0.0; 3]),
        ("a-c", [2.944_0, 2.227_1, 1.968_2], [0.887_5, 0.799_3, 0.815_3]),
        ("ag", [0.155_5, 0.116_8, 0.138_3], [4.831_8, 3.123_0, 2.148_7]),
        ("al", [1.657_5, 0.880_4, 0.521_2], [9.223_9, 6.269_5, 4.837_0]),
        ("au", [0.143_1, 0.375_0, 1.442_5], [3.983_2, 2.385_7, 1.603_2]),
        ("be", [4.185_0, 3.185_0, 2.784_1], [3.835_5, 3.010_1, 2.869_0]),
        ("cr", [4.369_7, 2.916_7, 1.654_7], [5.206_4, 4.231_4, 3.754_9]),
        ("cu", [0.200_4, 0.924_0, 1.102_2], [3.912_9, 2.452_9, 2.142_2]),
        ("cu2o", [3.551_8, 2.949_9, 2.751_9], [0.114_2, 0.193_9, 0.606_1]),
        ("cuo", [3.247_5, 2.447_8, 2.210_2], [0.521_1, 0.570_0, 0.722_2]),
        ("hg", [2.398_9, 1.440_0, 0.909_6], [6.327_6, 4.371_9, 3.421_8]),
        ("ir", [3.086_3, 2.082_2, 1.617_9], [5.592_2, 4.067_1, 3.267_3]),
        ("k", [0.064_0, 0.046_4, 0.038_2], [2.104_2, 1.348_9, 0.913_1]),
        ("li", [0.265_8, 0.195_6, 0.220_9], [3.540_2, 2.311_1, 1.668_6]),
        ("mo", [4.484_0, 3.525_1, 2.776_3], [4.111_4, 3.420_8, 3.150_6]),
        ("na_palik", [0.060_3, 0.056_1, 0.062_0], [3.179_3, 2.112_5, 1.579_0]),
        ("nb", [3.420_1, 2.790_1, 2.395_6], [3.441_4, 2.737_7, 2.579_7]),
        ("ni_palik", [2.367_3, 1.663_4, 1.467_1], [4.498_8, 3.050_2, 2.345_4]),
        ("rh", [2.585_8, 1.860_2, 1.554_3], [6.782_3, 4.703_0, 3.976_1]),
        ("ta", [2.062_7, 2.392_9, 2.627_9], [2.408_4, 1.741_5, 1.947_0]),
        ("tic", [3.700_5, 2.837_4, 2.582_3], [3.265_6, 2.351_6, 2.172_8]),
        ("tin", [1.648_4, 1.150_5, 1.379_8], [3.368_3, 1.943_5, 1.102_1]),
        ("v_palik", [4.277_6, 3.512_9, 2.761_1], [3.491_3, 2.889_5, 3.111_5]),
        ("vc", [3.657_6, 2.752_7, 2.532_7], [3.068_3, 2.198_7, 1.963_2]),
        ("vn", [2.865_6, 2.119_2, 1.940_1], [3.032_2, 2.056_1, 1.616_3]),
        ("w", [4.370_8, 3.300_2, 2.998_4], [3.500_6, 2.604_9, 2.273_2]),
    ];
    let (_, eta, k) = METALS.iter().find(|(known, ..)| known.eq_ignore_ascii_case(name.trim()))?;
    Some((Rgb::from(*eta), Rgb::from(*k)))
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
