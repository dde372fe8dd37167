//! Roughness of microfacets: GGX alpha from a parameter, by each version's own `remaproughness`.

use super::params::Params;
use super::reader::Reader;
use super::version::Version;
use crate::ImportError;
use enfilade_scene::ScalarParam;

impl Reader<'_> {
    /// GGX alpha of `uroughness`, `vroughness` and `roughness`, whose names begin with `prefix`. Where `remaproughness` is on, as by
    /// default, they are put through the version's own formula: in version 3 a polynomial (Pharr, Jakob & Humphreys 2016, 8.4.2), in
    /// version 4 the square root.
    pub(super) fn alpha(&mut self, params: &Params, prefix: &str, default: f32) -> Result<ScalarParam, ImportError> {
        let remap = params.flag("remaproughness", true)?;
        let roughness = self.roughness(params, prefix, default)?;
        Ok(self.remapped(roughness, remap))
    }

    /// GGX alpha of glass, which is smooth where its roughness is zero. The other materials of version 3 are not: its polynomial is
    /// 0.047 there.
    pub(super) fn alpha_of_glass(&mut self, params: &Params) -> Result<ScalarParam, ImportError> {
        let remap = params.flag("remaproughness", true)?;
        let roughness = self.roughness(params, "", 0.0)?;
        let smooth = roughness.texture.is_none() && roughness.factor <= 0.0;
        Ok(if smooth { 0.0.into() } else { self.remapped(roughness, remap) })
    }

    /// Roughness as the file states it; the mean of both directions.
    fn roughness(&mut self, params: &Params, prefix: &str, default: f32) -> Result<ScalarParam, ImportError> {
        let names = ["roughness", "uroughness", "vroughness"].map(|n| format!("{prefix}{n}"));
        let both = self.scalar(params, &names[0], default)?;
        let mut either = [both; 2];
        for (value, name) in either.iter_mut().zip(&names[1..]) {
            if params.has(name) {
                *value = self.scalar(params, name, default)?;
            }
        }
        let [u, v] = either;
        if u == v {
            return Ok(u);
        }
        self.warn(&params.place, "anisotropic roughness was replaced by its mean");
        Ok(ScalarParam { factor: 0.5 * (u.factor + v.factor), texture: u.texture.or(v.texture) })
    }

    fn remapped(&mut self, roughness: ScalarParam, remap: bool) -> ScalarParam {
        match (remap, self.version) {
            (false, _) => ScalarParam { factor: roughness.factor.max(0.0), ..roughness },
            (true, Version::V3) => self.mapped(roughness, "alpha of roughness", alpha_of_roughness),
            (true, Version::V4) => self.mapped(roughness, "alpha of roughness", |r| r.max(0.0).sqrt()),
        }
    }
}

/// pbrt-v3's `RoughnessToAlpha`.
fn alpha_of_roughness(roughness: f32) -> f32 {
    let x = roughness.max(1e-3).ln();
    [0.819_955, 0.1734, 0.017_120_1, 0.000_640_711].iter().zip(1..).fold(1.621_42, |sum, (c, i)| sum + c * x.powi(i))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roughness_of_version_3_follows_its_polynomial() {
        assert!((alpha_of_roughness(1.0) - 1.621_42).abs() < 1e-6);
        assert!((alpha_of_roughness(0.1) - 0.461_76).abs() < 1e-4, "{}", alpha_of_roughness(0.1));
        assert!(alpha_of_roughness(0.0) == alpha_of_roughness(1e-3) && alpha_of_roughness(0.0) > 0.0);
    }
}
