//! glTF materials to [`Material`]: metallic-roughness and the extensions that add layers to it.

use super::container::Document;
use super::file_material::FileMaterial;
use super::gloss_pictures::GlossPictures;
use super::{texture, unrendered};
use crate::ImportError;
use crate::assembly::Assembly;
use crate::images::{self, Use};
use enfilade_math::Rgb;
use enfilade_scene::{Bsdf, ColorParam, Filter, Material, NormalMap, Principled, ScalarParam, TextureRef, Wrap};
use gltf::json::extensions::texture::TextureTransform;
use gltf::json::material::{AlphaMode, Material as Json, NormalTexture};
use gltf::json::texture::{Info, MagFilter, WrappingMode};
use gltf::json::validation::Checked;
use serde_json::Value;

/// Attenuation colours below this count as this: a perfectly black one would absorb without limit.
const DARKEST_ATTENUATION: f32 = 1e-4;

/// Replaces the index of refraction 0, with which `KHR_materials_ior` means that all light is reflected.
const MIRROR_IOR: f32 = 1000.0;

/// Textures of extensions that the `gltf` crate leaves as JSON: extension and key.
const LAYER_TEXTURES: [(&str, &str); 4] = [
    ("KHR_materials_clearcoat", "clearcoatTexture"),
    ("KHR_materials_clearcoat", "clearcoatRoughnessTexture"),
    ("KHR_materials_sheen", "sheenColorTexture"),
    ("KHR_materials_sheen", "sheenRoughnessTexture"),
];

/// The texture coordinate set that a material uses: its base colour's, or the first other texture's.
pub(super) fn uv_set(json: &Json, name: &str, a: &mut Assembly) -> u32 {
    let set = |info: &Info| transform_of(info).and_then(|t| t.tex_coord).unwrap_or(info.tex_coord);
    let pbr = &json.pbr_metallic_roughness;
    let gloss = json.extensions.as_ref().and_then(|e| e.pbr_specular_glossiness.as_ref());
    let surface = match gloss {
        Some(gloss) => [gloss.diffuse_texture.as_ref(), gloss.specular_glossiness_texture.as_ref()],
        None => [pbr.base_color_texture.as_ref(), pbr.metallic_roughness_texture.as_ref()],
    };
    let infos = surface.into_iter().chain([json.emissive_texture.as_ref()]);
    let mut sets: Vec<u32> = infos.flatten().map(set).collect();
    sets.extend(json.normal_texture.as_ref().map(|n| transform_of_normal(n).and_then(|t| t.tex_coord).unwrap_or(n.tex_coord)));
    if let Some(ext) = &json.extensions {
        let transmission = ext.transmission.as_ref().and_then(|t| t.transmission_texture.as_ref());
        let specular = ext.specular.as_ref().map(|s| [s.specular_texture.as_ref(), s.specular_color_texture.as_ref()]);
        sets.extend(transmission.into_iter().chain(specular.into_iter().flatten().flatten()).map(set));
        let layers = LAYER_TEXTURES.iter().filter_map(|(extension, key)| layer_texture(ext.others.get(*extension)?, key));
        sets.extend(layers.map(|info| set(&info)));
    }
    let first = sets.first().copied().unwrap_or(0);
    if sets.iter().any(|&s| s != first) {
        a.warn(format!("material {name:?}"), format!("its textures use several coordinate sets; all were given set {first}"));
    }
    first
}

fn transform_of(info: &Info) -> Option<&TextureTransform> {
    info.extensions.as_ref()?.texture_transform.as_ref()
}

/// The `gltf` crate leaves the transform of a normal texture as JSON.
fn transform_of_normal(normal: &NormalTexture) -> Option<TextureTransform> {
    serde_json::from_value(normal.extensions.as_ref()?.others.get("KHR_texture_transform")?.clone()).ok()
}

/// A texture of an extension that the `gltf` crate leaves as JSON.
fn layer_texture(extension: &Value, key: &str) -> Option<Info> {
    serde_json::from_value(extension.get(key)?.clone()).ok()
}

/// The reader of one material.
pub(super) struct Converter<'c, 'a> {
    pub(super) document: &'c Document,
    pub(super) user: String,
    pub(super) made: &'c mut GlossPictures,
    pub(super) a: &'c mut Assembly<'a>,
}

impl Converter<'_, '_> {
    /// The material, except for its index and its coordinate set.
    pub(super) fn material(&mut self, name: String, json: &Json) -> Result<FileMaterial, ImportError> {
        let pbr = &json.pbr_metallic_roughness;
        let gloss = json.extensions.as_ref().and_then(|e| e.pbr_specular_glossiness.as_ref());
        let ([r, g, b, opacity], base_texture) = match gloss {
            Some(gloss) => (gloss.diffuse_factor.0, gloss.diffuse_texture.as_ref()),
            None => (pbr.base_color_factor.0, pbr.base_color_texture.as_ref()),
        };
        let base_color = self.color(Rgb::new(r, g, b), base_texture, 0.5)?;
        let unlit = json.extensions.as_ref().is_some_and(|e| e.unlit.is_some());
        let bsdf = if unlit {
            self.warn("unlit material; treated as a diffuse surface of its colour");
            Bsdf::Diffuse { reflectance: base_color }
        } else {
            let p = self.principled(json, base_color)?;
            match gloss {
                Some(gloss) => self.glossy(gloss, p)?,
                None => Bsdf::Principled(Box::new(p)),
            }
        };
        let strength = json.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref()).map_or(1.0, |s| s.emissive_strength.0);
        let emission_factor = Rgb::from(json.emissive_factor.0) * strength;
        let emission = match emission_factor.is_black() {
            true => Rgb::BLACK.into(),
            false => self.color(emission_factor, json.emissive_texture.as_ref(), 0.0)?,
        };
        let has_color = !matches!(&bsdf, Bsdf::Principled(p) if gloss.is_some() && p.metallic.factor == 1.0);
        let cut_out = base_color.texture.filter(|t| !images::is_opaque(self.a.image_at(t.image)));
        let opacity = ScalarParam { factor: opacity, texture: cut_out.map(|t| (t, 3)) };
        let alpha_mode = if let Checked::Valid(mode) = json.alpha_mode { mode } else { AlphaMode::Opaque };
        let normal_map = self.normal_map(json)?;
        if json.occlusion_texture.is_some() {
            self.warn("occlusion texture dropped: light transport computes occlusion");
        }
        // A single-sided surface is one that viewers may leave out from behind. Light transport cannot: the back scatters as the front
        // does, or rooms modelled as shells would be black outside-in.
        let material = Material { emission, emits_both_sides: json.double_sided, normal_map, ..Material::new(name, bsdf) };
        let cutoff = json.alpha_cutoff.map_or(0.5, |c| c.0);
        Ok(FileMaterial { index: None, material, uv_set: 0, opacity, alpha_mode, cutoff, has_color })
    }

    fn principled(&mut self, json: &Json, base_color: ColorParam) -> Result<Principled, ImportError> {
        let pbr = &json.pbr_metallic_roughness;
        let rough = pbr.metallic_roughness_texture.as_ref();
        let mut p = Principled { base_color, ..Principled::default() };
        if json.extensions.as_ref().is_none_or(|e| e.pbr_specular_glossiness.is_none()) {
            p.metallic = self.scalar(pbr.metallic_factor.0, rough, 2, 0.0)?;
            p.roughness = self.scalar(pbr.roughness_factor.0, rough, 1, 0.6)?;
        }
        let Some(ext) = &json.extensions else { return Ok(p) };
        if let Some(ior) = &ext.ior {
            p.ior = match ior.ior.0 {
                0.0 => MIRROR_IOR,
                stated if stated >= 1.0 => stated,
                _ => 1.5,
            };
            if p.ior == 1.5 && ior.ior.0 != 1.5 {
                self.warn(format!("found the index of refraction {}, expected 0 or at least 1; 1.5 was used", ior.ior.0));
            }
        }
        if let Some(t) = &ext.transmission {
            p.transmission = self.scalar(t.transmission_factor.0, t.transmission_texture.as_ref(), 0, 1.0)?;
        }
        if let Some(v) = &ext.volume {
            p.solid = v.thickness_factor.0 > 0.0 && p.transmission.factor > 0.0;
            if v.thickness_texture.is_some() {
                self.warn("thickness texture dropped: light goes through the body's own shape");
            }
            let distance = v.attenuation_distance.0 * self.a.meters_per_unit() as f32;
            if p.solid && distance > 0.0 && distance.is_finite() {
                p.absorption = Rgb::from(v.attenuation_color.0).map(|c| -c.clamp(DARKEST_ATTENUATION, 1.0).ln() / distance);
            }
        }
        if let Some(s) = &ext.specular {
            p.specular = self.scalar(s.specular_factor.0, s.specular_texture.as_ref(), 3, 1.0)?;
            p.specular_color = self.color(Rgb::from(s.specular_color_factor.0), s.specular_color_texture.as_ref(), 1.0)?;
        }
        self.json_extensions(&ext.others, &mut p)?;
        Ok(p)
    }

    /// Extensions that the `gltf` crate leaves as JSON.
    fn json_extensions(&mut self, others: &serde_json::Map<String, Value>, p: &mut Principled) -> Result<(), ImportError> {
        for (name, value) in others {
            for (_, key) in LAYER_TEXTURES.iter().filter(|(extension, _)| extension == name) {
                if value.get(key).is_some() && layer_texture(value, key).is_none() {
                    self.warn(format!("{name}.{key} is malformed, so the texture was left out; export the file again"));
                }
            }
            let number = |key: &str, default: f32| value.get(key).and_then(Value::as_f64).map_or(default, |v| v as f32);
            let texture = |key: &str| layer_texture(value, key);
            match name.as_str() {
                "KHR_materials_clearcoat" => {
                    p.clearcoat = self.scalar(number("clearcoatFactor", 0.0), texture("clearcoatTexture").as_ref(), 0, 1.0)?;
                    let roughness = texture("clearcoatRoughnessTexture");
                    p.clearcoat_roughness = self.scalar(number("clearcoatRoughnessFactor", 0.0), roughness.as_ref(), 1, 0.5)?;
                    if value.get("clearcoatNormalTexture").is_some() {
                        self.warn("normal map of the clear coat dropped; the coat follows the surface");
                    }
                }
                "KHR_materials_sheen" => {
                    let channel =
                        |i: usize| value.get("sheenColorFactor").and_then(|c| c.get(i)).and_then(Value::as_f64).unwrap_or(0.0) as f32;
                    let color = Rgb::new(channel(0), channel(1), channel(2));
                    p.sheen_color = self.color(color, texture("sheenColorTexture").as_ref(), 0.5)?;
                    let roughness = texture("sheenRoughnessTexture");
                    p.sheen_roughness = self.scalar(number("sheenRoughnessFactor", 0.0), roughness.as_ref(), 3, 0.5)?;
                }
                other if unrendered::is_told(other) => {}
                other => self.warn(format!("extension {other} ignored")),
            }
        }
        Ok(())
    }

    fn normal_map(&mut self, json: &Json) -> Result<Option<NormalMap>, ImportError> {
        let Some(normal) = json.normal_texture.as_ref().filter(|normal| self.has_picture(normal.index.value())) else { return Ok(None) };
        let transform = transform_of_normal(normal);
        if transform.is_none() && normal.extensions.as_ref().is_some_and(|e| e.others.contains_key("KHR_texture_transform")) {
            self.warn("the normal texture's KHR_texture_transform is malformed and was left out; export the file again");
        }
        let texture = self.texture(normal.index.value(), transform.as_ref(), Use::Data)?;
        Ok(texture.map(|texture| NormalMap::Normal { texture, scale: normal.scale }))
    }

    /// A colour; `stand_in` multiplies the factor when the texture is missing and that is allowed.
    pub(super) fn color(&mut self, factor: Rgb, info: Option<&Info>, stand_in: f32) -> Result<ColorParam, ImportError> {
        let Some(info) = info.filter(|info| self.has_picture(info.index.value())) else { return Ok(factor.into()) };
        let texture = self.texture(info.index.value(), transform_of(info), Use::Color)?;
        Ok(ColorParam { factor: if texture.is_some() { factor } else { factor * stand_in }, texture })
    }

    /// A number from a channel of a texture; `stand_in` multiplies the factor when the texture is missing and that is allowed.
    fn scalar(&mut self, factor: f32, info: Option<&Info>, channel: u8, stand_in: f32) -> Result<ScalarParam, ImportError> {
        let Some(info) = info.filter(|info| self.has_picture(info.index.value())) else { return Ok(factor.into()) };
        let texture = self.texture(info.index.value(), transform_of(info), Use::Data)?;
        Ok(ScalarParam { factor: if texture.is_some() { factor } else { factor * stand_in }, texture: texture.map(|t| (t, channel)) })
    }

    /// False, with a warning, for a texture that names no picture: plain colours and numbers are used.
    fn has_picture(&mut self, index: usize) -> bool {
        let has_picture = texture::has_picture(self.document, index);
        if !has_picture {
            self.warn(format!("textures[{index}] names no picture; its plain colour or number holds"));
        }
        has_picture
    }

    fn texture(&mut self, index: usize, transform: Option<&TextureTransform>, usage: Use) -> Result<Option<TextureRef>, ImportError> {
        let root = &self.document.root;
        let found = texture::image(self.document, index, usage, &self.user, self.a)?;
        let Some(texture) = root.textures.get(index) else { return Ok(None) };
        let sampler = texture.sampler.and_then(|s| root.samplers.get(s.value()));
        let wrap = |mode: Checked<WrappingMode>| match mode {
            Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
            Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
            _ => Wrap::Repeat,
        };
        let nearest = sampler.is_some_and(|s| matches!(s.mag_filter, Some(Checked::Valid(MagFilter::Nearest))));
        Ok(found.map(|image| TextureRef {
            image,
            uv_transform: transform.map_or(TextureRef::new(0).uv_transform, uv_transform),
            wrap: sampler.map_or([Wrap::Repeat; 2], |s| [wrap(s.wrap_s), wrap(s.wrap_t)]),
            filter: if nearest { Filter::Nearest } else { Filter::Linear },
        }))
    }

    pub(super) fn warn(&mut self, message: impl Into<String>) {
        let user = self.user.clone();
        self.a.warn(user, message);
    }
}

/// `KHR_texture_transform` in this workspace's coordinates. glTF's v points down: with F the flip (u, v) → (u, 1 − v), the map
/// becomes F·T·R·S·F. A positive rotation turns coordinates counter-clockwise as seen on the picture.
fn uv_transform(t: &TextureTransform) -> [[f32; 3]; 2] {
    let ([ox, oy], [sx, sy]) = (t.offset.0, t.scale.0);
    let (sin, cos) = t.rotation.0.sin_cos();
    crate::mesh::flip_v_of_transform([[cos * sx, sin * sy, ox], [-sin * sx, cos * sy, oy]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Vec2;

    /// The extension's own example: offset (0, 1), a quarter turn and scale ½ pick the lower left quadrant, turned clockwise.
    #[test]
    fn texture_transform_picks_the_quadrant_of_the_specification() {
        let json = r#"{"offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5]}"#;
        let t: TextureTransform = serde_json::from_str(json).unwrap();
        let texture = TextureRef { uv_transform: uv_transform(&t), ..TextureRef::new(0) };
        for (ours, expected) in [((0.0, 1.0), (0.0, 0.0)), ((1.0, 1.0), (0.0, 0.5)), ((0.0, 0.0), (0.5, 0.0))] {
            let uv = texture.transform(Vec2::new(ours.0, ours.1));
            assert!((uv - Vec2::new(expected.0, expected.1)).length() < 1e-6, "{ours:?} became {uv}");
        }
    }
}
