//! MTL material libraries.

use crate::ImportError;
use crate::assembly::{Assembly, Source};
use crate::images::{self, Use};
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, NormalMap, Principled, ScalarParam, TextureRef, Wrap};
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// Metres that a bump map's full range stands for at `-bm 1`; MTL does not say, and this suits plaster and wood.
const BUMP_METRES: f32 = 0.005;

/// One `newmtl`: its statements by keyword in lower case, later ones replacing earlier ones.
#[derive(Clone)]
pub(crate) struct Entry {
    name: String,
    /// Folder of the library, to which pictures are relative, as the scene file would spell it.
    folder: String,
    /// True where Blender's own exporter wrote the library.
    of_blender: bool,
    statements: BTreeMap<String, String>,
}

/// Materials by name.
pub(crate) type Library = HashMap<String, Entry>;

/// The materials that Java 3D's loader of OBJ files knows by name, and under the empty name that of faces without one. Programs
/// that are built on it, such as Sweet Home 3D, have many models that rely on them. Colours are rounded to a thousandth. Their `d`
/// is opacity, as in Sweet Home 3D's loader; in Java 3D's it is transparency.
pub(super) fn java3d() -> Library {
    let mut library = Library::new();
    parse(include_str!("java3d.mtl"), "", &mut library);
    let unnamed = library.get("default").cloned();
    library.extend(unnamed.map(|entry| (String::new(), entry)));
    library
}

/// Reads the libraries that an OBJ file in `folder` names, whose materials replace those of `library`. One that is not there is a
/// warning.
pub(super) fn read_libraries(
    names: &[String],
    folder: &str,
    mut library: Library,
    assembly: &mut Assembly,
) -> Result<Library, ImportError> {
    let spelled = |name: &str| Path::new(folder).join(name).to_string_lossy().into_owned();
    for line in names {
        // The rest of the line is one name with spaces, or, if there is no such file, several names.
        let whole = assembly.exists(&spelled(line)) || !line.contains(char::is_whitespace);
        let candidates: Vec<&str> = if whole { vec![line] } else { line.split_whitespace().collect() };
        for name in candidates.into_iter().map(spelled) {
            match assembly.read(&name) {
                Ok((_, bytes)) => parse(&String::from_utf8_lossy(&bytes), &folder_of(&name), &mut library),
                Err(ImportError::Read { file, source, .. }) => {
                    let message =
                        format!("the material library {} cannot be read ({source}); grey stands in for its materials", file.display());
                    assembly.warn(format!("mtllib {line}"), message);
                }
                Err(other) => return Err(other),
            }
        }
    }
    Ok(library)
}

/// The folder of a file as the scene file spells it, with a slash at its end; empty where that is the scene file's own.
pub(super) fn folder_of(path: &str) -> String {
    path.replace('\\', "/").rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"))
}

fn parse(text: &str, folder: &str, library: &mut Library) {
    let of_blender = is_of_blender(text);
    let mut current: Option<String> = None;
    for line in text.lines() {
        let line = super::without_comment(line, is_text).trim();
        let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let (keyword, rest) = (keyword.to_ascii_lowercase(), rest.trim().to_string());
        if keyword == "newmtl" {
            let entry = Entry { name: rest.clone(), folder: folder.to_string(), of_blender, statements: BTreeMap::new() };
            library.insert(rest.clone(), entry);
            current = Some(rest);
        } else if !keyword.is_empty()
            && let Some(entry) = current.as_ref().and_then(|name| library.get_mut(name))
        {
            entry.statements.insert(keyword, rest);
        }
    }
}

/// True for a library that Blender 3.2 or newer wrote: "# Blender 4.5.0 MTL File: …". Older ones have no version there, and other laws.
fn is_of_blender(text: &str) -> bool {
    let version = text.strip_prefix("# Blender ").filter(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    version.and_then(|rest| rest.lines().next()).is_some_and(|line| line.contains(" MTL File"))
}

/// True for keywords that a name or path follows.
fn is_text(keyword: &str) -> bool {
    let keyword = keyword.to_ascii_lowercase();
    keyword.starts_with("map_") || matches!(keyword.as_str(), "newmtl" | "bump" | "norm" | "disp" | "decal" | "refl")
}

/// The material of an entry.
pub(super) fn material(entry: &Entry, a: &mut Assembly) -> Result<Material, ImportError> {
    let mut c = Converter { entry, user: format!("material {:?}", entry.name), a };
    c.report_ignored();
    let bsdf = c.bsdf()?;
    let emission = match c.rgb("ke").filter(|ke| !ke.is_black()) {
        Some(ke) => c.color(ke, "map_ke", 0.0)?,
        // Some writers give the picture alone and leave the colour black.
        None if entry.statements.contains_key("map_ke") && c.rgb("ke").is_none() => c.color(Rgb::WHITE, "map_ke", 0.0)?,
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

/// A `map_…` statement: options and the picture's path.
struct Map<'m> {
    path: &'m str,
    scale: [f32; 2],
    offset: [f32; 2],
    clamp: bool,
    bump: f32,
}

impl<'c> Converter<'c, '_> {
    fn bsdf(&mut self) -> Result<Bsdf, ImportError> {
        let has = |key: &str| self.entry.statements.contains_key(key);
        let eta = self.number("ni").filter(|&n| n > 1.0 && n.is_finite()).unwrap_or(1.5);
        let illum = self.number("illum").unwrap_or(2.0) as i32;
        if ["pr", "pm", "pc", "ps", "map_pr", "map_pm"].iter().any(|k| has(k)) {
            return self.principled(eta);
        }
        if self.is_glass(illum) {
            let transmittance = self.rgb("tf").unwrap_or(Rgb::WHITE).map(|c| c.clamp(0.0, 1.0)).into();
            return Ok(Bsdf::Dielectric { eta, alpha: 0.0.into(), transmittance, absorption: Rgb::BLACK });
        }
        let diffuse = self.base_color()?;
        let (specular, roughness) = self.highlight();
        // Illumination models 0 and 1 have no highlight, whatever Ks says.
        let shiny = !matches!(illum, 0 | 1) && (!specular.is_black() || has("map_ks"));
        if !shiny {
            return Ok(Bsdf::Diffuse { reflectance: diffuse });
        }
        let specular = self.color(if specular.is_black() { Rgb::WHITE } else { specular }, "map_ks", 0.5)?;
        if diffuse.factor.is_black() && !self.entry.of_blender {
            return Ok(Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance: specular, alpha: roughness.powi(2).into() });
        }
        // Not a plastic, whose rough coat loses light.
        let roughness = roughness.into();
        let p = Principled { base_color: diffuse, roughness, ior: eta, specular_color: specular, ..Principled::default() };
        Ok(Bsdf::Principled(Box::new(p)))
    }

    /// True for solid glass. Only models 6 and 7 refract; 4 and 9, "glass on", keep the colour `Kd` and let straight through what `d` says.
    /// But where they state neither, glass is meant.
    fn is_glass(&self, illum: i32) -> bool {
        let has_color = self.entry.statements.contains_key("map_kd") || self.rgb("kd").is_some_and(|kd| !kd.is_black());
        let see_through = self.opacity() < 1.0 || self.entry.statements.contains_key("map_d");
        matches!(illum, 6 | 7) || matches!(illum, 4 | 9) && !has_color && !see_through
    }

    /// Colour and roughness of the highlight. Blender writes half its strength as `Ks`, and its roughness r as `Ns` = 1000·(1 − r)².
    fn highlight(&self) -> (Rgb, f32) {
        let (ks, ns) = (self.rgb("ks").unwrap_or(Rgb::BLACK), self.number("ns").unwrap_or(0.0).max(0.0));
        let (specular, roughness) = match self.entry.of_blender {
            true => (ks * 2.0, 1.0 - (ns / 1000.0).sqrt()),
            false => (ks, alpha_of_exponent(ns).sqrt()),
        };
        (specular.map(|c| c.clamp(0.0, 1.0)), roughness.clamp(0.0, 1.0))
    }

    fn principled(&mut self, ior: f32) -> Result<Bsdf, ImportError> {
        let number = |c: &Self, key: &str, default: f32| c.number(key).map_or(default, |v| v.clamp(0.0, 1.0));
        let mapped = |c: &Self, key: &str, without: f32| if c.entry.statements.contains_key(key) { 1.0 } else { without };
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
        let mapped = self.entry.statements.contains_key("map_kd");
        let kd = self.rgb("kd").map(|c| c.map(|v| v.clamp(0.0, 1.0)));
        let factor = match kd {
            Some(kd) if !(mapped && kd.is_black()) => kd,
            _ if mapped => Rgb::WHITE,
            _ => Rgb::splat(super::GREY),
        };
        self.color(factor, "map_kd", 0.5)
    }

    fn alpha(&mut self, bsdf: &Bsdf) -> Result<Alpha, ImportError> {
        if matches!(bsdf, Bsdf::Dielectric { .. }) {
            return Ok(Alpha::Opaque);
        }
        let opacity = self.opacity();
        let mut texture = None;
        if let Some(map) = self.map("map_d") {
            texture = self.texture(&map, Use::Data)?.map(|t| {
                let transparent = !images::is_opaque(self.a.image_at(t.image));
                (t, if transparent { 3 } else { 0 })
            });
        }
        let opacity = ScalarParam { factor: opacity, texture };
        Ok(if opacity.factor < 1.0 || texture.is_some() { Alpha::Blend { opacity } } else { Alpha::Opaque })
    }

    fn opacity(&self) -> f32 {
        self.number("d").or_else(|| self.number("tr").map(|t| 1.0 - t)).unwrap_or(1.0).clamp(0.0, 1.0)
    }

    fn normal_map(&mut self) -> Result<Option<NormalMap>, ImportError> {
        let found = ["norm", "map_bump", "bump"].iter().find_map(|key| Some((*key, self.map(key)?)));
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
        let Some(map) = self.map(key) else { return Ok(factor.into()) };
        let texture = self.texture(&map, Use::Color)?;
        Ok(ColorParam { factor: if texture.is_some() { factor } else { factor * stand_in }, texture })
    }

    fn scalar(&mut self, factor: f32, key: &str, stand_in: f32) -> Result<ScalarParam, ImportError> {
        let Some(map) = self.map(key) else { return Ok(factor.into()) };
        let texture = self.texture(&map, Use::Data)?;
        Ok(ScalarParam { factor: if texture.is_some() { factor } else { stand_in }, texture: texture.map(|t| (t, 0)) })
    }

    fn texture(&mut self, map: &Map, usage: Use) -> Result<Option<TextureRef>, ImportError> {
        let path = if Path::new(map.path).is_absolute() { map.path.to_string() } else { format!("{}{}", self.entry.folder, map.path) };
        let image = self.a.image(&Source::File(&path), usage, &self.user)?;
        Ok(image.map(|image| TextureRef {
            uv_transform: [[map.scale[0], 0.0, map.offset[0]], [0.0, map.scale[1], map.offset[1]]],
            wrap: [if map.clamp { Wrap::Clamp } else { Wrap::Repeat }; 2],
            ..TextureRef::new(image)
        }))
    }

    fn map(&self, key: &str) -> Option<Map<'c>> {
        let entry: &'c Entry = self.entry;
        parse_map(entry.statements.get(key)?)
    }

    fn number(&self, key: &str) -> Option<f32> {
        self.entry.statements.get(key)?.split_whitespace().next()?.parse().ok().filter(|v: &f32| v.is_finite())
    }

    fn rgb(&self, key: &str) -> Option<Rgb> {
        let numbers: Vec<f32> = self.entry.statements.get(key)?.split_whitespace().map_while(|w| w.parse().ok()).collect();
        match numbers[..] {
            [r, g, b, ..] => Some(Rgb::new(r, g, b)),
            [grey, ..] => Some(Rgb::splat(grey)),
            [] => None,
        }
        .filter(|c| c.is_finite())
    }

    fn report_ignored(&mut self) {
        const IGNORED: [&str; 6] = ["disp", "map_disp", "refl", "decal", "aniso", "map_ns"];
        for key in IGNORED {
            // An anisotropy of zero is none.
            if self.entry.statements.contains_key(key) && self.number(key) != Some(0.0) {
                self.warn(format!("{key} ignored"));
            }
        }
    }

    fn warn(&mut self, message: impl Into<String>) {
        let user = self.user.clone();
        self.a.warn(user, message);
    }
}

/// Splits a `map_…` statement into its options and the path, which may hold spaces.
fn parse_map(statement: &str) -> Option<Map<'_>> {
    let mut map = Map { path: "", scale: [1.0; 2], offset: [0.0; 2], clamp: false, bump: 1.0 };
    let mut rest = statement.trim();
    while rest.starts_with('-') {
        let (option, after) = rest.split_once(char::is_whitespace)?;
        let mut values = Vec::new();
        rest = after.trim_start();
        let most = match option {
            "-s" | "-o" | "-t" => 3,
            "-mm" => 2,
            _ => 1,
        };
        let textual = matches!(option, "-clamp" | "-blendu" | "-blendv" | "-cc" | "-imfchan" | "-type");
        while values.len() < most {
            let word = rest.split_whitespace().next()?;
            match word.parse::<f32>() {
                Ok(value) => values.push(value),
                Err(_) if textual => values.push(f32::from(u8::from(word == "on"))),
                Err(_) => break,
            }
            rest = rest[word.len()..].trim_start();
        }
        let pair = |default: f32| [values.first().copied().unwrap_or(default), values.get(1).copied().unwrap_or(default)];
        match option {
            "-s" => map.scale = pair(1.0),
            "-o" => map.offset = pair(0.0),
            "-clamp" => map.clamp = pair(0.0)[0] > 0.0,
            "-bm" => map.bump = pair(1.0)[0],
            _ => (),
        }
    }
    map.path = rest;
    (!rest.is_empty()).then_some(map)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn map_statements_have_options_and_paths_with_spaces() {
        let map = parse_map("-s 2 3 1 -o 0.5 0 0 -clamp on -bm 0.3 my wood texture.png").unwrap();
        assert_eq!((map.path, map.scale, map.offset, map.clamp, map.bump), ("my wood texture.png", [2.0, 3.0], [0.5, 0.0], true, 0.3));
        assert_eq!(parse_map("3 chairs.png").unwrap().path, "3 chairs.png");
        assert!(parse_map("-bm 1").is_none());
    }

    #[test]
    fn exponents_become_roughness() {
        assert_eq!(alpha_of_exponent(0.0), 1.0);
        assert!((alpha_of_exponent(198.0) - 0.1).abs() < 1e-6);
    }
}
