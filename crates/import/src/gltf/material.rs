//! glTF materials to [`Material`].

use super::container::{Document, ImageAt};
use crate::ImportError;
use crate::assembly::{Assembly, Source};
use crate::images::{self, Use};
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, Filter, Material, NormalMap, Principled, ScalarParam, TextureRef, Wrap};
use gltf::json::extensions::texture::TextureTransform;
use gltf::json::material::{AlphaMode, Material as Json, NormalTexture};
use gltf::json::texture::{Info, MagFilter, WrappingMode};
use gltf::json::validation::Checked;
use serde_json::Value;
use std::collections::HashMap;

/// Attenuation colours below this count as this: a perfectly black one would absorb without limit.
const DARKEST_ATTENUATION: f32 = 1e-4;

/// Stands for the index of refraction 0, by which `KHR_materials_ior` means that all light is reflected.
const MIRROR_IOR: f32 = 1000.0;

/// Textures of extensions that the `gltf` crate leaves as JSON: extension and key.
const LAYER_TEXTURES: [(&str, &str); 4] = [
    ("KHR_materials_clearcoat", "clearcoatTexture"),
    ("KHR_materials_clearcoat", "clearcoatRoughnessTexture"),
    ("KHR_materials_sheen", "sheenColorTexture"),
    ("KHR_materials_sheen", "sheenRoughnessTexture"),
];

/// The materials met so far: scene index and texture coordinate set of each.
#[derive(Default)]
pub(super) struct Materials {
    known: HashMap<Option<usize>, (u32, u32)>,
}

impl Materials {
    /// Scene index and texture coordinate set of material `index`; `None` is glTF's default material.
    pub(super) fn get(
        &mut self,
        document: &Document,
        index: Option<usize>,
        place: &str,
        a: &mut Assembly,
    ) -> Result<(u32, u32), ImportError> {
        if let Some(&known) = self.known.get(&index) {
            return Ok(known);
        }
        let materials = &document.root.materials;
        let default = Json::default();
        let json = match index {
            Some(i) => materials
                .get(i)
                .ok_or_else(|| a.malformed(place, format!("it refers to material {i}, but there are only {}", materials.len())))?,
            None => {
                a.warn(place, "no material; glTF's default, a rough white metal, was used");
                &default
            }
        };
        let fallback = || index.map_or("default".to_string(), |i| format!("material_{i}"));
        let name = json.name.clone().filter(|n| !n.trim().is_empty()).unwrap_or_else(fallback);
        let uv_set = uv_set(json, &name, a);
        let material = Converter { document, user: format!("material {name:?}"), a }.material(name, json)?;
        let known = (a.push_material(material), uv_set);
        self.known.insert(index, known);
        Ok(known)
    }
}

/// The texture coordinate set that a material uses: its base colour's, or that of the first other texture.
fn uv_set(json: &Json, name: &str, a: &mut Assembly) -> u32 {
    let set = |info: &Info| transform_of(info).and_then(|t| t.tex_coord).unwrap_or(info.tex_coord);
    let pbr = &json.pbr_metallic_roughness;
    let infos = [pbr.base_color_texture.as_ref(), pbr.metallic_roughness_texture.as_ref(), json.emissive_texture.as_ref()];
    let mut sets: Vec<u32> = infos.into_iter().flatten().map(set).collect();
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

struct Converter<'c, 'a> {
    document: &'c Document,
    user: String,
    a: &'c mut Assembly<'a>,
}

impl Converter<'_, '_> {
    fn material(&mut self, name: String, json: &Json) -> Result<Material, ImportError> {
        let pbr = &json.pbr_metallic_roughness;
        let [r, g, b, opacity] = pbr.base_color_factor.0;
        let base_texture = pbr.base_color_texture.as_ref();
        let base_color = self.color(Rgb::new(r, g, b), base_texture, 0.5)?;
        let unlit = json.extensions.as_ref().is_some_and(|e| e.unlit.is_some());
        let bsdf = if unlit {
            self.warn("unlit material; treated as a diffuse surface of its colour");
            Bsdf::Diffuse { reflectance: base_color }
        } else {
            Bsdf::Principled(Box::new(self.principled(json, base_color)?))
        };
        let strength = json.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref()).map_or(1.0, |s| s.emissive_strength.0);
        let emission_factor = Rgb::from(json.emissive_factor.0) * strength;
        let emission = match emission_factor.is_black() {
            true => Rgb::BLACK.into(),
            false => self.color(emission_factor, json.emissive_texture.as_ref(), 0.0)?,
        };
        let alpha = self.alpha(json, opacity, base_color.texture);
        let normal_map = self.normal_map(json)?;
        if json.occlusion_texture.is_some() {
            self.warn("occlusion texture dropped: light transport computes occlusion");
        }
        // A single-sided surface is one that viewers may leave out from behind. Light transport cannot: the back scatters as the front
        // does, or rooms modelled as shells would be black outside-in.
        Ok(Material { name, bsdf, emission, two_sided: true, emits_both_sides: json.double_sided, alpha, normal_map })
    }

    fn principled(&mut self, json: &Json, base_color: ColorParam) -> Result<Principled, ImportError> {
        let pbr = &json.pbr_metallic_roughness;
        let rough = pbr.metallic_roughness_texture.as_ref();
        let mut p = Principled {
            base_color,
            metallic: self.scalar(pbr.metallic_factor.0, rough, 2, 0.0)?,
            roughness: self.scalar(pbr.roughness_factor.0, rough, 1, 0.6)?,
            ..Principled::default()
        };
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
                other => self.warn(format!("extension {other} ignored")),
            }
        }
        Ok(())
    }

    fn alpha(&self, json: &Json, factor: f32, texture: Option<TextureRef>) -> Alpha {
        let texture = texture.filter(|t| !images::is_opaque(self.a.image_at(t.image)));
        let opacity = ScalarParam { factor, texture: texture.map(|t| (t, 3)) };
        let transparent = factor < 1.0 || texture.is_some();
        match json.alpha_mode {
            Checked::Valid(AlphaMode::Mask) if transparent => Alpha::Mask { opacity, cutoff: json.alpha_cutoff.map_or(0.5, |c| c.0) },
            Checked::Valid(AlphaMode::Blend) if transparent => Alpha::Blend { opacity },
            _ => Alpha::Opaque,
        }
    }

    fn normal_map(&mut self, json: &Json) -> Result<Option<NormalMap>, ImportError> {
        let Some(normal) = &json.normal_texture else { return Ok(None) };
        let transform = transform_of_normal(normal);
        if transform.is_none() && normal.extensions.as_ref().is_some_and(|e| e.others.contains_key("KHR_texture_transform")) {
            self.warn("the normal texture's KHR_texture_transform is malformed and was left out; export the file again");
        }
        let texture = self.texture(normal.index.value(), transform.as_ref(), Use::Data)?;
        Ok(texture.map(|texture| NormalMap::Normal { texture, scale: normal.scale }))
    }

    /// A colour; `stand_in` multiplies the factor when the texture is missing and that is allowed.
    fn color(&mut self, factor: Rgb, info: Option<&Info>, stand_in: f32) -> Result<ColorParam, ImportError> {
        let Some(info) = info else { return Ok(factor.into()) };
        let texture = self.texture(info.index.value(), transform_of(info), Use::Color)?;
        Ok(ColorParam { factor: if texture.is_some() { factor } else { factor * stand_in }, texture })
    }

    /// A number from a channel of a texture; `stand_in` multiplies the factor when the texture is missing and that is allowed.
    fn scalar(&mut self, factor: f32, info: Option<&Info>, channel: u8, stand_in: f32) -> Result<ScalarParam, ImportError> {
        let Some(info) = info else { return Ok(factor.into()) };
        let texture = self.texture(info.index.value(), transform_of(info), Use::Data)?;
        Ok(ScalarParam { factor: if texture.is_some() { factor } else { factor * stand_in }, texture: texture.map(|t| (t, channel)) })
    }

    fn texture(&mut self, index: usize, transform: Option<&TextureTransform>, usage: Use) -> Result<Option<TextureRef>, ImportError> {
        let root = &self.document.root;
        let dangling = |kind: &str, i: usize, n: usize| format!("it refers to {kind} {i}, but there are only {n}");
        let Some(texture) = root.textures.get(index) else {
            return Err(self.a.malformed(&self.user, dangling("texture", index, root.textures.len())));
        };
        let source = texture.source.value();
        let Some(image) = root.images.get(source) else {
            let problem = match source == u32::MAX as usize {
                true => format!("textures[{index}] has no PNG or JPEG picture; export with PNG or JPEG textures"),
                false => dangling("image", source, root.images.len()),
            };
            return Err(self.a.malformed(&self.user, problem));
        };
        let found = match self.document.embedded_image(source, image) {
            Ok((place, bytes)) => self.a.image(&Source::Embedded(place, &bytes), usage, &self.user)?,
            Err(ImageAt::File(path)) => self.a.image(&Source::File(&path), usage, &self.user)?,
            Err(ImageAt::Nowhere(problem)) => return Err(self.a.malformed(&self.user, problem)),
        };
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

    fn warn(&mut self, message: impl Into<String>) {
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
