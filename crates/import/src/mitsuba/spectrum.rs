//! Spectra to linear Rec. 709 RGB, and the substances that Mitsuba knows by name.

use super::reader::Reader;
use super::xml::Node;
use crate::ImportError;
use crate::spectrum::{self, Kind};
use enfilade_math::{Rgb, linear_from_srgb};

impl Reader<'_, '_> {
    /// The colour of a property as the file's version of Mitsuba has it.
    ///
    /// In RGB daylight is white. From version 2 on, light of a constant spectrum is none: it is the pinkish light of equal energy at all
    /// wavelengths, CIE's illuminant E. Version 0.x takes it for white. A `float`, and a spectrum of the type `uniform`, are white in
    /// all versions, and so is a constant reflectance.
    ///
    /// # Errors
    /// When the value is not a spectrum.
    pub(super) fn spectrum(&self, node: &Node, kind: Kind) -> Result<Rgb, ImportError> {
        let color = color(node, kind)?;
        let constant = node.tag == "spectrum" && node.plugin.is_empty() && node.numbers("value").is_ok_and(|values| values.len() == 1);
        let as_equal_energy = constant && kind == Kind::Emission && self.version >= 2;
        Ok(if as_equal_energy { color * Rgb::from_xyz([1.0; 3]) } else { color })
    }
}

/// The colour of a property in all versions: `rgb`, `srgb`, `spectrum`, `blackbody`, `color`, or a plain `float`. The samples of a spectrum
/// in a file are in its value.
///
/// # Errors
/// When the value is not a spectrum.
pub(super) fn color(node: &Node, kind: Kind) -> Result<Rgb, ImportError> {
    let text = node.attribute("value").unwrap_or_default().trim();
    match node.tag.as_str() {
        "blackbody" => blackbody(node),
        // Hexadecimal digits are encoded in `srgb` alone.
        "rgb" | "color" if text.starts_with('#') => hex(node, text),
        "srgb" if text.starts_with('#') => Ok(hex(node, text)?.map(linear_from_srgb)),
        "srgb" => Ok(triple(node)?.map(linear_from_srgb)),
        "spectrum" if !node.plugin.is_empty() && text.is_empty() => object(node, kind),
        "spectrum" if text.contains(':') => sampled(node, text, kind),
        "rgb" | "spectrum" | "color" | "float" | "integer" => triple(node),
        other => Err(node.error(format!("<{other}> is not a colour; expected rgb, srgb, spectrum, blackbody or float"))),
    }
}

/// A spectrum with properties of its own, as Mitsuba 2 and 3 have them.
fn object(node: &Node, kind: Kind) -> Result<Rgb, ImportError> {
    let list = |name: &str| node.child(name).map_or(Ok(Vec::new()), |c| c.numbers("value"));
    match node.plugin.as_str() {
        "blackbody" => blackbody(node),
        // Light is relative to daylight in RGB, so that daylight itself is white.
        "d65" => {
            let color = node.child("color").map_or(Ok(Rgb::WHITE), |c| color(c, Kind::Factor))?;
            Ok(color * node.float_or("scale", 1.0)? as f32)
        }
        "uniform" => {
            let value = node.float("value")?.ok_or_else(|| node.error("there is no float named value; add it"))?;
            Ok(Rgb::splat(value as f32))
        }
        "irregular" => pairs(node, &list("wavelengths")?, &list("values")?, kind),
        "regular" => {
            let (values, range) = (list("values")?, list("range")?);
            let end = |names: [&str; 2], i: usize| {
                let named = node.float(names[0])?.or(node.float(names[1])?).or(range.get(i).copied());
                named.ok_or_else(|| node.error(format!("there is no float named {}; add it", names[0])))
            };
            let (first, last) = (end(["wavelength_min", "lambda_min"], 0)?, end(["wavelength_max", "lambda_max"], 1)?);
            let step = (last - first) / values.len().saturating_sub(1).max(1) as f64;
            let wavelengths: Vec<f64> = (0..values.len()).map(|i| first + step * i as f64).collect();
            pairs(node, &wavelengths, &values, kind)
        }
        other => {
            let known = "blackbody, d65, uniform, regular or irregular";
            Err(node.error(format!("spectra of the type {other:?} are not supported; expected {known}")))
        }
    }
}

/// Spectrum of pairs: as many values as wavelengths, which ascend.
fn pairs(node: &Node, wavelengths: &[f64], values: &[f64], kind: Kind) -> Result<Rgb, ImportError> {
    if values.len() < 2 || wavelengths.len() != values.len() || wavelengths.windows(2).any(|w| w[0] >= w[1]) {
        let found = format!("found {} values at {} wavelengths", values.len(), wavelengths.len());
        return Err(node.error(format!("{found}, expected two or more values at as many wavelengths that ascend")));
    }
    let mut pairs: Vec<(f64, f64)> = wavelengths.iter().copied().zip(values.iter().copied()).collect();
    Ok(spectrum::sampled(&mut pairs, kind))
}

fn triple(node: &Node) -> Result<Rgb, ImportError> {
    match node.numbers("value")?[..] {
        [r, g, b] => Ok(Rgb::new(r as f32, g as f32, b as f32)),
        [all] => Ok(Rgb::splat(all as f32)),
        ref other => Err(node.error(format!("found {} numbers, expected 1 or 3", other.len()))),
    }
}

/// `#rrggbb`, each component divided by 255.
fn hex(node: &Node, text: &str) -> Result<Rgb, ImportError> {
    let digits = &text[1..];
    let byte = |i: usize| digits.get(i..i + 2).and_then(|d| u8::from_str_radix(d, 16).ok());
    match (digits.len(), byte(0), byte(2), byte(4)) {
        (6, Some(r), Some(g), Some(b)) => Ok(Rgb::new(f32::from(r), f32::from(g), f32::from(b)).map(|c| c / 255.0)),
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

/// Planck's radiance of a `temperature` (kelvin) per nanometre, times `scale`: attributes of `blackbody`, properties of `spectrum`.
fn blackbody(node: &Node) -> Result<Rgb, ImportError> {
    let text = node.raw_text("temperature").or(node.attribute("temperature")).or(node.attribute("value"));
    let text = text.unwrap_or_default().trim_end_matches(['K', 'k', ' ']);
    let kelvin: f64 =
        text.parse().ok().filter(|t| (1.0..1e6).contains(t)).ok_or_else(|| node.error("the temperature should be in kelvin"))?;
    let scale = node.float("scale")?.or(node.numbers("scale")?.first().copied()).unwrap_or(1.0);
    Ok(spectrum::black_body(kelvin) * scale as f32)
}

/// Index of refraction of a clear substance by Mitsuba's name for it.
pub(super) fn substance(name: &str) -> Option<f64> {
    const SUBSTANCES: [(&str, f64); 23] = [
        ("vacuum", 1.0),
        ("helium", 1.000_036),
        ("hydrogen", 1.000_132),
        ("air", 1.000_277),
        ("carbon dioxide", 1.000_45),
        ("water", 1.333),
        ("water ice", 1.31),
        ("acetone", 1.36),
        ("ethanol", 1.361),
        ("carbon tetrachloride", 1.461),
        ("glycerol", 1.472_9),
        ("benzene", 1.501),
        ("silicone oil", 1.520_45),
        ("bromine", 1.661),
        ("fused quartz", 1.458),
        ("pyrex", 1.47),
        ("acrylic glass", 1.49),
        ("polypropylene", 1.49),
        ("bk7", 1.504_6),
        ("sodium chloride", 1.544),
        ("amber", 1.55),
        ("pet", 1.575),
        ("diamond", 2.419),
    ];
    SUBSTANCES.iter().find(|(n, _)| n.eq_ignore_ascii_case(name.trim())).map(|(_, eta)| *eta)
}
