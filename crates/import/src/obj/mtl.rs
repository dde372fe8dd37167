//! Entries of MTL libraries to [`Material`]: which statements make a surface diffuse, coated, metallic or glass.

use super::blender::Gloss;
use super::check;
use super::library::{Entry, spelled};
use super::map::Map;
use crate::ImportError;
use crate::assembly::{Assembly, Source};
use crate::images::{self, Use};
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, NormalMap, Principled, ScalarParam, TextureRef, Wrap};

/// Height of a bump map's full range at `-bm 1`, metres. MTL does not define it; this suits plaster and wood.
const BUMP_METRES: f32 = 0.005;

/// Reflectance of surfaces whose material is not known.
pub(super) const GREY: f32 = 0.5;

/// The material of an entry.
pub(super) fn material(entry: &Entry, a: &mut Assembly) -> Result<Material, ImportError> {
    let mut c = Converter { entry, user: format!("material {:?}", entry.name), a };
    check::notes(entry).into_iter().for_each(|note| c.warn(note));
    let bsdf = c.bsdf()?;
    let emission = match entry.rgb("ke").filter(|ke| !ke.is_black()) {
        Some(ke) => c.color(ke, "map_ke", 0.0)?,
        // Some writers give the picture alone and leave the colour black.
        None if entry.map("map_ke").is_some() => {
            if entry.has("ke") {
                c.warn("map_Ke stands beside a black Ke, which was taken for white; leave the picture out if it should not shine");
            }
            c.color(Rgb::WHITE, "map_ke", 0.0)?
        }
        None => Rgb::BLACK.into(),
    };
    let alpha = c.alpha(&bsdf)?;
    let normal_map = c.normal_map()?;
    Ok(Material { name: entry.name.clone(), bsdf, emission, two_sided: true, emits_both_sides: true, alpha, normal_map })
}

/// GGX alpha of a Blinn–Phong exponent.
fn alpha_of_exponent(exponent: f32) -> f32 {
    (2.0 / (exponent.max(0.0) + 2.0)).sqrt()
}

struct Converter<'c, 'a> {
    entry: &'c Entry,
    user: String,
    a: &'c mut Assembly<'a>,
}

impl<'c> Converter<'c, '_> {
    fn bsdf(&mut self) -> Result<Bsdf, ImportError> {
        let has = |key: &str| self.entry.has(key);
        let eta = self.entry.number("ni").filter(|&n| n > 1.0 && n.is_finite()).unwrap_or(1.5);
        let illum = self.entry.number("illum").unwrap_or(2.0) as i32;
        if ["pr", "pm", "pc", "ps", "map_pr", "map_pm"].iter().any(|k| has(k)) {
            return self.principled(eta);
        }
        if self.is_glass(illum) {
            let transmittance = self.entry.rgb("tf").unwrap_or(Rgb::WHITE).map(|c| c.clamp(0.0, 1.0)).into();
            return Ok(Bsdf::Dielectric { eta, alpha: 0.0.into(), transmittance, absorption: Rgb::BLACK });
        }
        if self.entry.rgb("tf").is_some_and(|tf| tf != Rgb::WHITE) {
            self.warn("Tf ignored: only glass (illum 6 or 7) has a colour of what passes through");
        }
        let diffuse = self.base_color()?;
        let (specular, roughness) = self.highlight();
        // Illumination models 0 and 1 have no highlight, whatever Ks is.
        let shiny = !matches!(illum, 0 | 1) && (!specular.is_black() || has("map_ks"));
        if !shiny {
            return Ok(Bsdf::Diffuse { reflectance: diffuse });
        }
        let specular = self.color(if specular.is_black() { Rgb::WHITE } else { specular }, "map_ks", 0.5)?;
        if diffuse.factor.is_black() && !matches!(self.entry.gloss, Gloss::Roughness(_)) {
            return Ok(Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance: specular, alpha: roughness.powi(2).into() });
        }
        // Not a plastic, whose rough coat loses light.
        let roughness = roughness.into();
        let p = Principled { base_color: diffuse, roughness, ior: eta, specular_color: specular, ..Principled::default() };
        Ok(Bsdf::Principled(Box::new(p)))
    }

    /// True for solid glass. Only models 6 and 7 refract; 4 and 9, "glass on", keep the colour `Kd` and transmit straight through by `d`.
    /// But if they state neither, glass is meant.
    fn is_glass(&self, illum: i32) -> bool {
        let has_color = self.entry.has("map_kd") || self.entry.rgb("kd").is_some_and(|kd| !kd.is_black());
        let see_through = self.opacity() < 1.0 || self.entry.has("map_d");
        matches!(illum, 6 | 7) || matches!(illum, 4 | 9) && !has_color && !see_through
    }

    /// Colour and roughness of the highlight. Blender writes half its strength as `Ks`: see [`Gloss`].
    fn highlight(&self) -> (Rgb, f32) {
        let (ks, ns) = (self.entry.rgb("ks").unwrap_or(Rgb::BLACK), self.entry.number("ns").unwrap_or(0.0).max(0.0));
        let (specular, roughness) = match self.entry.gloss {
            Gloss::Roughness(smooth) => (ks * 2.0, 1.0 - (ns / smooth).sqrt()),
            Gloss::Hardness => (ks, alpha_of_exponent(0.51 * ns + 1.0).sqrt()),
            Gloss::Exponent => (ks, alpha_of_exponent(ns).sqrt()),
        };
        (specular.map(|c| c.clamp(0.0, 1.0)), roughness.clamp(0.0, 1.0))
    }

    fn principled(&mut self, ior: f32) -> Result<Bsdf, ImportError> {
        let number = |c: &Self, key: &str, default: f32| c.entry.number(key).map_or(default, |v| v.clamp(0.0, 1.0));
        let mapped = |c: &Self, key: &str, without: f32| if c.entry.has(key) { 1.0 } else { without };
        let roughness = number(self, "pr", mapped(self, "map_pr", 0.5));
        let metallic = number(self, "pm", mapped(self, "map_pm", 0.0));
        let p = Principled {
            base_color: self.base_color()?,
            roughness: self.scalar(roughness, "map_pr", 0.6)?,
            metallic: self.scalar(metallic, "map_pm", 0.0)?,
            ior,
            clearcoat: number(self, "pc", 0.0).into(),
            clearcoat_roughness: number(self, "pcr", 0.0).into(),
            sheen_color: Rgb::splat(number(self, "ps", 0.0)).into(),
            sheen_roughness: 0.5.into(),
            ..Principled::default()
        };
        Ok(Bsdf::Principled(Box::new(p)))
    }

    fn base_color(&mut self) -> Result<ColorParam, ImportError> {
        // A picture with a black or absent Kd is meant to be seen.
        let mapped = self.entry.has("map_kd");
        let kd = self.entry.rgb("kd").map(|c| c.map(|v| v.clamp(0.0, 1.0)));
        let factor = match kd {
            Some(kd) if !(mapped && kd.is_black()) => kd,
            _ if mapped => Rgb::WHITE,
            _ => Rgb::splat(GREY),
        };
        self.color(factor, "map_kd", 0.5)
    }

    fn alpha(&mut self, bsdf: &Bsdf) -> Result<Alpha, ImportError> {
        if matches!(bsdf, Bsdf::Dielectric { .. }) {
            return Ok(Alpha::Opaque);
        }
        let opacity = self.opacity();
        self.report_opacity(opacity);
        let mut texture = None;
        if let Some(map) = self.entry.map("map_d") {
            texture = self.texture(&map, Use::Data)?.map(|t| {
                let transparent = !images::is_opaque(self.a.image_at(t.image));
                (t, map.channel.unwrap_or(if transparent { 3 } else { 0 }))
            });
        }
        let opacity = ScalarParam { factor: opacity, texture };
        Ok(if opacity.factor < 1.0 || texture.is_some() { Alpha::Blend { opacity } } else { Alpha::Opaque })
    }

    /// Opacity by `d`, else by `Tr`, its complement. A `Tr` of one alone is ignored: some programs write it for opaque surfaces.
    fn opacity(&self) -> f32 {
        let stated = self.entry.number("d").map(|d| d.clamp(0.0, 1.0));
        let opposite = || self.entry.number("tr").map(|t| 1.0 - t.clamp(0.0, 1.0)).filter(|d| *d > 0.0);
        stated.or_else(opposite).unwrap_or(1.0)
    }

    fn report_opacity(&mut self, opacity: f32) {
        if opacity == 0.0 {
            self.warn("found d 0, so the surface is not seen; if it should be, make it d 1");
        } else if self.entry.number("d").is_none() && self.entry.number("tr").is_some_and(|t| t >= 1.0) {
            self.warn("found a transparency (Tr) of one, which would hide the surface; an opacity of 1 was used");
        }
    }

    fn normal_map(&mut self) -> Result<Option<NormalMap>, ImportError> {
        let found = ["norm", "map_bump", "bump"].iter().find_map(|key| Some((*key, self.entry.map(key)?)));
        let Some((key, map)) = found else { return Ok(None) };
        let Some(texture) = self.texture(&map, Use::Data)? else { return Ok(None) };
        // Many libraries name the colour picture as the bump map too.
        if key == "norm" || images::looks_like_normals(self.a.image_at(texture.image)) {
            return Ok(Some(NormalMap::Normal { texture, scale: map.bump }));
        }
        self.warn(format!("the bump map's height was guessed: white is {} m above black", BUMP_METRES * map.bump));
        Ok(Some(NormalMap::Bump { texture, scale: BUMP_METRES * map.bump }))
    }

    fn color(&mut self, factor: Rgb, key: &str, stand_in: f32) -> Result<ColorParam, ImportError> {
        let Some(map) = self.entry.map(key) else { return Ok(factor.into()) };
        let texture = self.texture(&map, Use::Color)?;
        Ok(ColorParam { factor: if texture.is_some() { factor } else { factor * stand_in }, texture })
    }

    fn scalar(&mut self, factor: f32, key: &str, stand_in: f32) -> Result<ScalarParam, ImportError> {
        let Some(map) = self.entry.map(key) else { return Ok(factor.into()) };
        let texture = self.texture(&map, Use::Data)?;
        Ok(ScalarParam {
            factor: if texture.is_some() { factor } else { stand_in },
            texture: texture.map(|t| (t, map.channel.unwrap_or(0))),
        })
    }

    fn texture(&mut self, map: &Map, usage: Use) -> Result<Option<TextureRef>, ImportError> {
        let folder = &self.entry.folder;
        let written = spelled(folder, map.path);
        let folders = [String::new(), "textures/".into(), "Textures/".into()].map(|below| format!("{folder}{below}"));
        let path = self.a.find(&[&written], &folders.each_ref().map(String::as_str)).unwrap_or(written);
        let usage = if map.linear { Use::Data } else { usage };
        let image = self.a.image(&Source::File(&path), usage, &self.user)?;
        Ok(image.map(|image| TextureRef {
            uv_transform: [[map.scale[0], 0.0, map.offset[0]], [0.0, map.scale[1], map.offset[1]]],
            wrap: [if map.clamp { Wrap::Clamp } else { Wrap::Repeat }; 2],
            ..TextureRef::new(image)
        }))
    }

    fn warn(&mut self, message: impl Into<String>) {
        let user = self.user.clone();
        self.a.warn(user, message);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_become_roughness() {
        assert_eq!(alpha_of_exponent(0.0), 1.0);
        assert!((alpha_of_exponent(198.0) - 0.1).abs() < 1e-6);
    }
}
