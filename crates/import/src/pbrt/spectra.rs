//! Spectra as parameters, and those that pbrt knows by name.

use super::params::{Param, Params, Values};
use super::reader::Reader;
use super::version::Version;
use crate::ImportError;
use crate::spectrum::{self, Kind, metal, planck, rgb_of, sampled};
use enfilade_math::Rgb;

impl Reader<'_> {
    /// The colour of a parameter that is no texture, or a default.
    pub(super) fn color(&mut self, params: &Params, name: &str, kind: Kind, default: Rgb) -> Result<Rgb, ImportError> {
        let Some(param) = params.get(name) else { return Ok(default) };
        self.color_of(params, param, kind)
    }

    /// The colour of a parameter that is no texture.
    pub(super) fn color_of(&mut self, params: &Params, param: &Param, kind: Kind) -> Result<Rgb, ImportError> {
        let rgb = match (param.kind.as_str(), &param.values) {
            ("rgb" | "color", Values::Numbers(n)) if n.len() == 3 => return Ok(Rgb::new(n[0] as f32, n[1] as f32, n[2] as f32)),
            ("xyz", Values::Numbers(n)) if n.len() == 3 => return Ok(Rgb::from_xyz([n[0], n[1], n[2]])),
            ("float", Values::Numbers(n)) if n.len() == 1 => return Ok(Rgb::splat(n[0] as f32)),
            ("blackbody", Values::Numbers(n)) if !n.is_empty() => self.blackbody(params, n)?,
            ("spectrum", Values::Numbers(n)) if n.len() >= 2 && n.len().is_multiple_of(2) => {
                let mut pairs: Vec<(f64, f64)> = n.chunks_exact(2).map(|p| (p[0], p[1])).collect();
                self.pairs(&mut pairs, kind)
            }
            ("spectrum", Values::Strings(names)) if names.len() == 1 => self.named_spectrum(params, &names[0], kind)?,
            ("rgb" | "color" | "xyz", _) => return Err(params.wrong(param, "three numbers")),
            ("float", _) => return Err(params.wrong(param, "one number")),
            _ => return Err(params.wrong(param, "pairs of wavelength and value, or one name")),
        };
        // Version 4 takes a light's spectrum for its shape alone.
        let luminance = rgb.luminance();
        Ok(if kind == Kind::Emission && self.version == Version::V4 && luminance > 0.0 { rgb * (1.0 / luminance) } else { rgb })
    }

    /// A temperature in kelvin and in version 3 a factor: Planck's law, scaled to a peak of one.
    fn blackbody(&self, params: &Params, numbers: &[f64]) -> Result<Rgb, ImportError> {
        let kelvin = numbers[0];
        if !(1.0..1e6).contains(&kelvin) {
            return Err(params.place.error(format!("found a temperature of {kelvin}, expected kelvin between 1 and a million")));
        }
        // Wien's displacement law.
        let peak = planck(kelvin, 2.897_771_955e6 / kelvin);
        let factor = if self.version == Version::V3 { numbers.get(1).copied().unwrap_or(1.0) } else { 1.0 };
        Ok(rgb_of(|nm| planck(kelvin, nm) / peak) * factor as f32)
    }

    /// Samples; beyond them version 3 continues with the first and last.
    fn pairs(&self, pairs: &mut Vec<(f64, f64)>, kind: Kind) -> Rgb {
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let (Version::V3, Some(&first), Some(&last)) = (self.version, pairs.first(), pairs.last()) {
            pairs.insert(0, (0.0, first.1));
            pairs.push((1e5, last.1));
        }
        sampled(pairs, kind)
    }

    /// A spectrum by pbrt's name for it, or from a file of wavelengths and values.
    fn named_spectrum(&mut self, params: &Params, name: &str, kind: Kind) -> Result<Rgb, ImportError> {
        if let Some(rgb) = known(name) {
            return Ok(rgb);
        }
        if ["metal-", "glass-", "stdillum-", "illum-"].iter().any(|p| name.starts_with(p)) {
            return Err(params.place.error(format!("pbrt knows no spectrum {name:?}; correct the name")));
        }
        let (file, bytes) = self.a.read(name)?;
        Ok(self.pairs(&mut spectrum::pairs(&bytes, &file)?, kind))
    }

    /// The index of refraction of a clear substance: `eta`, or in version 3 also `index`; 1.5 where neither is given.
    pub(super) fn index_of_refraction(&mut self, params: &Params) -> Result<f32, ImportError> {
        let Some(param) = ["eta", "index"].iter().find_map(|n| params.get(n)) else { return Ok(1.5) };
        let eta = if param.kind == "texture" {
            let value = self.scalar(params, &param.name.clone(), 1.5)?;
            if value.texture.is_some() {
                self.warn(&params.place, "textured indices of refraction are not supported; 1.5 stands in");
                1.5
            } else {
                value.factor
            }
        } else {
            self.color_of(params, param, Kind::Factor)?.g
        };
        if eta > 0.0 { Ok(eta) } else { Err(params.place.error(format!("found an index of refraction of {eta}, expected one above zero"))) }
    }
}

/// The spectra that pbrt-v4 knows by name, as RGB; illuminants have a luminance of one.
///
/// Metals are those of [`metal`]; brass (`CuZn`), magnesia and titania have refractiveindex.info's values at 640, 545 and 455 nm. Glasses
/// have Schott's index at the d line (`F5`, `F10` and `F11` are SF5, SF10 and SF11): RGB shows no dispersion. Illuminants have the
/// chromaticities of CIE 15:2004.
fn known(name: &str) -> Option<Rgb> {
    const GLASSES: [(&str, f32); 7] =
        [("BK7", 1.5168), ("BAF10", 1.6700), ("FK51A", 1.4866), ("LASF9", 1.8503), ("F5", 1.6727), ("F10", 1.7283), ("F11", 1.7847)];
    const OXIDES: [(&str, [f32; 3], [f32; 3]); 3] = [
        ("CuZn", [0.444, 0.538, 1.044], [3.534, 2.69, 1.856]),
        ("MgO", [1.735, 1.740, 1.747], [0.0; 3]),
        ("TiO2", [2.875, 2.955, 3.17], [0.0; 3]),
    ];
    const WHITES: [(&str, f64, f64); 16] = [
        ("stdillum-A", 0.447_57, 0.407_45),
        ("stdillum-D50", 0.345_67, 0.358_51),
        ("stdillum-D65", 0.312_72, 0.329_03),
        ("stdillum-F1", 0.3131, 0.3371),
        ("stdillum-F2", 0.3721, 0.3751),
        ("stdillum-F3", 0.4091, 0.3941),
        ("stdillum-F4", 0.4402, 0.4031),
        ("stdillum-F5", 0.3138, 0.3452),
        ("stdillum-F6", 0.3779, 0.3882),
        ("stdillum-F7", 0.3129, 0.3292),
        ("stdillum-F8", 0.3458, 0.3586),
        ("stdillum-F9", 0.3741, 0.3727),
        ("stdillum-F10", 0.3458, 0.3588),
        ("stdillum-F11", 0.3805, 0.3769),
        ("stdillum-F12", 0.4370, 0.4042),
        ("illum-acesD60", 0.321_68, 0.337_67),
    ];
    if let Some(metal_and_part) = name.strip_prefix("metal-") {
        let (substance, part) = metal_and_part.rsplit_once('-')?;
        let oxide = OXIDES.iter().find(|(n, ..)| *n == substance).map(|(_, eta, k)| (Rgb::from(*eta), Rgb::from(*k)));
        let (eta, k) = oxide.or_else(|| spectrum::metal(substance))?;
        return match part {
            "eta" => Some(eta),
            "k" => Some(k),
            _ => None,
        };
    }
    if let Some(glass) = name.strip_prefix("glass-") {
        return GLASSES.iter().find(|(n, _)| *n == glass).map(|(_, eta)| Rgb::splat(*eta));
    }
    let (_, x, y) = WHITES.iter().find(|(n, ..)| *n == name)?;
    Some(Rgb::from_xyz([x / y, 1.0, (1.0 - x - y) / y]))
}

/// Copper, which metals are by default.
pub(super) fn copper() -> (Rgb, Rgb) {
    metal("cu").unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_give_their_substance_and_daylight_is_white() {
        assert_eq!(known("metal-Cu-eta"), Some(copper().0));
        assert_eq!(known("metal-Au-k").map(|k| k.r > k.b), Some(true));
        assert_eq!((known("metal-Cu"), known("metal-Xx-eta"), known("film.spd")), (None, None, None));
        let white = known("stdillum-D65").unwrap();
        assert!((white.r - 1.0).abs() < 2e-3 && (white.g - 1.0).abs() < 2e-3 && (white.b - 1.0).abs() < 2e-3, "{white:?}");
        let lamp = known("stdillum-A").unwrap();
        assert!(lamp.r > 1.5 && lamp.b < 0.4 && (lamp.luminance() - 1.0).abs() < 1e-2, "{lamp:?}");
    }
}
