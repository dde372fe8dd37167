//! Spectra to linear Rec. 709 RGB, and the substances that Mitsuba knows by name.

use super::xml::Node;
use crate::ImportError;
use crate::spectrum::{self, Kind};
use enfilade_math::{Rgb, linear_from_srgb};

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
    Ok(spectrum::sampled(&mut pairs, kind))
}

/// Planck's radiance of a `temperature` (kelvin) per nanometre, times `scale`.
fn blackbody(node: &Node) -> Result<Rgb, ImportError> {
    let text = node.attribute("temperature").or(node.attribute("value")).unwrap_or_default().trim_end_matches(['K', 'k', ' ']);
    let kelvin: f64 =
        text.parse().ok().filter(|t| (1.0..1e6).contains(t)).ok_or_else(|| node.error("the temperature should be in kelvin"))?;
    let scale = node.numbers("scale")?.first().copied().unwrap_or(1.0);
    Ok(spectrum::black_body(kelvin) * scale as f32)
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
