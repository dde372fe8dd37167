//! FBX materials to [`Material`], from the maps that the library makes the same for all shaders.

use super::reader::of_blender;
use super::texture::{Inverted, inverted, texture};
use crate::ImportError;
use crate::assembly::Assembly;
use crate::images::{self, Use};
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, NormalMap, Principled, ScalarParam, TextureRef};
use std::collections::{HashMap, HashSet};
use ufbx::{MaterialMap, ShaderType};

/// Reflectance of surfaces without a material.
const GREY: f32 = 0.5;
/// Height of a bump map's full range at a factor of one, metres. FBX does not define it; this suits plaster and wood.
const BUMP_METRES: f32 = 0.005;
/// Transmission colours below this count as this: a perfectly black one would absorb without limit.
const DARKEST_TRANSMISSION: f32 = 1e-4;

/// The materials met so far, and their inverted pictures.
#[derive(Default)]
pub(super) struct Materials {
    known: HashMap<Option<u32>, u32>,
    inverted: Inverted,
}

impl Materials {
    /// Scene index of a material; of grey where there is none.
    pub(super) fn get(&mut self, material: Option<&ufbx::Material>, a: &mut Assembly) -> Result<u32, ImportError> {
        let key = material.map(|m| m.element.element_id);
        if let Some(&known) = self.known.get(&key) {
            return Ok(known);
        }
        let made = match material {
            None => Material::diffuse("default", Rgb::splat(GREY)),
            Some(m) => {
                let name = name(m);
                let user = format!("material {name:?}");
                Converter { m, user, inverted: &mut self.inverted, used: HashSet::new(), a }.material(name)?
            }
        };
        let index = a.push_material(made);
        self.known.insert(key, index);
        Ok(index)
    }
}

/// The material's name; programs that write none get a stable one.
pub(super) fn name(material: &ufbx::Material) -> String {
    let name = material.element.name.trim();
    if name.is_empty() { format!("material_{}", material.element.typed_id) } else { name.to_string() }
}

/// Name of the texture coordinate set of a material: the set of its base colour, or of its first texture. Empty if none is stated.
pub(super) fn uv_set<'m>(material: &'m ufbx::Material, a: &mut Assembly) -> &'m str {
    let base = material.pbr.base_color.texture.as_ref().or(material.fbx.diffuse_color.texture.as_ref());
    let set = |t: &'m ufbx::Texture| -> &'m str { &t.uv_set };
    let all: Vec<&str> = material.textures.iter().map(|t| set(&t.texture)).collect();
    let first = base.map(|t| set(t)).or(all.first().copied()).unwrap_or_default();
    if all.iter().any(|s| *s != first) {
        let what = if first.is_empty() { "the first one".to_string() } else { format!("{first:?}") };
        a.warn(format!("material {:?}", name(material)), format!("its textures use several coordinate sets; all were given {what}"));
    }
    first
}

struct Converter<'c, 'a> {
    m: &'c ufbx::Material,
    user: String,
    inverted: &'c mut Inverted,
    /// The textures that count for something, by their elements.
    used: HashSet<u32>,
    a: &'c mut Assembly<'a>,
}

impl<'c> Converter<'c, '_> {
    fn material(&mut self, name: String) -> Result<Material, ImportError> {
        self.report_ignored();
        let m = self.m;
        let classic = matches!(m.shader_type, ShaderType::FbxLambert | ShaderType::FbxPhong | ShaderType::Unknown);
        let bsdf = match m.shader_type {
            _ if m.features.unlit.enabled => {
                self.warn("unlit material; treated as a diffuse surface of its colour");
                Bsdf::Diffuse { reflectance: self.base_color()? }
            }
            ShaderType::FbxPhong => self.phong()?,
            _ if classic => Bsdf::Diffuse { reflectance: self.base_color()? },
            _ => Bsdf::Principled(Box::new(self.principled()?)),
        };
        let strength = number(&m.pbr.emission_factor).unwrap_or(1.0);
        let emission = self.color(&m.pbr.emission_color, Rgb::BLACK, strength, 0.0)?;
        let alpha = if classic { self.transparency()? } else { self.opacity()? };
        let normal_map = self.normal_map()?;
        self.report_unused_textures();
        Ok(Material { name, bsdf, emission, two_sided: true, emits_both_sides: true, alpha, normal_map })
    }

    fn base_color(&mut self) -> Result<ColorParam, ImportError> {
        let strength = number(&self.m.pbr.base_factor).unwrap_or(1.0).clamp(0.0, 1.0);
        let mut color = self.color(&self.m.pbr.base_color, Rgb::splat(GREY), strength, GREY)?;
        color.factor = color.factor.map(|c| c.clamp(0.0, 1.0));
        Ok(color)
    }

    /// Phong's highlight as a clear coat of GGX alpha √(2/(exponent+2)), which loses no light however rough; a highlight on black as a
    /// mirror of its colour.
    fn phong(&mut self) -> Result<Bsdf, ImportError> {
        let fbx = &self.m.fbx;
        let diffuse = self.base_color()?;
        let factor = number(&fbx.specular_factor).unwrap_or(1.0);
        let specular = self.color(&fbx.specular_color, Rgb::BLACK, factor, GREY)?;
        let specular = ColorParam { factor: specular.factor.map(|c| c.clamp(0.0, 1.0)), ..specular };
        if specular.factor.is_black() {
            return Ok(Bsdf::Diffuse { reflectance: diffuse });
        }
        let exponent = number(&fbx.specular_exponent).unwrap_or(20.0).max(0.0);
        let alpha = (2.0 / (exponent + 2.0)).sqrt();
        if diffuse.factor.is_black() {
            return Ok(Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance: specular, alpha: alpha.into() });
        }
        let roughness = alpha.sqrt().into();
        Ok(Bsdf::Principled(Box::new(Principled { base_color: diffuse, roughness, specular_color: specular, ..Principled::default() })))
    }

    fn principled(&mut self) -> Result<Principled, ImportError> {
        let (m, pbr) = (self.m, &self.m.pbr);
        let unit = |v: Option<f32>, default: f32| v.unwrap_or(default).clamp(0.0, 1.0);
        let mut p = Principled {
            base_color: self.base_color()?,
            metallic: self.scalar(&pbr.metalness, 0.0, 0.0)?,
            roughness: self.roughness(&pbr.roughness, &pbr.glossiness, m.features.roughness_as_glossiness.enabled, 0.5)?,
            specular: self.scalar(&pbr.specular_factor, 1.0, 1.0)?,
            specular_color: self.color(&pbr.specular_color, Rgb::WHITE, 1.0, 1.0)?,
            ..Principled::default()
        };
        if let Some(ior) = number(&pbr.specular_ior) {
            p.ior = if ior >= 1.0 { ior } else { 1.5 };
            if ior < 1.0 {
                self.warn(format!("found the index of refraction {ior}, expected at least 1; 1.5 was used"));
            }
        }
        p.transmission = self.scalar(&pbr.transmission_factor, 0.0, 1.0)?;
        if p.transmission.factor > 0.0 {
            self.transmission(&mut p)?;
        }
        p.clearcoat = self.scalar(&pbr.coat_factor, 0.0, 1.0)?;
        let glossy = m.features.coat_roughness_as_glossiness.enabled;
        p.clearcoat_roughness = self.roughness(&pbr.coat_roughness, &pbr.coat_glossiness, glossy, 0.1)?;
        let sheen = unit(number(&pbr.sheen_factor), 0.0);
        p.sheen_color = self.color(&pbr.sheen_color, Rgb::WHITE, sheen, GREY)?;
        p.sheen_roughness = self.scalar(&pbr.sheen_roughness, 0.3, 0.3)?;
        Ok(p)
    }

    /// Transmission: a thin sheet takes its colour; a solid body absorbs so that the colour remains after its depth.
    fn transmission(&mut self, p: &mut Principled) -> Result<(), ImportError> {
        let pbr = &self.m.pbr;
        let thin = self.m.features.thin_walled.enabled;
        let color = rgb(&pbr.transmission_color).unwrap_or(Rgb::WHITE);
        let depth = number(&pbr.transmission_depth).unwrap_or(0.0) * self.a.meters_per_unit() as f32;
        p.solid = !thin;
        if !thin && depth > 0.0 {
            p.absorption = color.map(|c| -c.clamp(DARKEST_TRANSMISSION, 1.0).ln() / depth);
        } else if p.transmission.factor >= 1.0 {
            // Nothing of the base shows, and in our model the base colour tints what passes.
            p.base_color = self.color(&pbr.transmission_color, Rgb::WHITE, 1.0, 1.0)?;
        } else if color != Rgb::WHITE {
            self.warn("the colour of the transmission was replaced by the base colour, since both shine through");
        }
        Ok(())
    }

    /// Opacity of the physical materials, where white is opaque.
    fn opacity(&mut self) -> Result<Alpha, ImportError> {
        let map = &self.m.pbr.opacity;
        let factor = rgb(map).map_or(1.0, mean).clamp(0.0, 1.0);
        let texture = self.texture(map, Use::Data)?;
        Ok(self.alpha(if texture.is_some() { 1.0 } else { factor }, texture, false))
    }

    /// Transparency of Lambert and Phong, where white lets through.
    fn transparency(&mut self) -> Result<Alpha, ImportError> {
        let fbx = &self.m.fbx;
        let texture = self.texture(&fbx.transparency_color, Use::Data)?;
        if texture.is_some() {
            return Ok(self.alpha(1.0, texture, true));
        }
        let color = rgb(&fbx.transparency_color).map_or(0.0, mean);
        let transparency = (color * number(&fbx.transparency_factor).unwrap_or(1.0)).clamp(0.0, 1.0);
        let mut opacity = 1.0 - transparency;
        if opacity <= 0.0 {
            // Some programs write white here for opaque surfaces, and an invisible surface is unlikely to be intended.
            let stated = ufbx::find_prop(&self.m.element.props, "Opacity").map(|p| p.value_vec4.x as f32);
            opacity = stated.filter(|o| *o > 0.0).unwrap_or(1.0).min(1.0);
            self.warn(format!("found a transparency of one, which would hide the surface; an opacity of {opacity} was used"));
        }
        Ok(self.alpha(opacity, None, false))
    }

    /// The cut-outs of an opacity; the picture's alpha channel counts if it varies, else its first one, inverted where it is one of
    /// transparency.
    fn alpha(&mut self, factor: f32, texture: Option<TextureRef>, inverse: bool) -> Alpha {
        let texture = texture.map(|t| match images::is_opaque(self.a.image_at(t.image)) {
            false => (t, 3),
            true if inverse => (inverted(t, self.inverted, self.a), 0),
            true => (t, 0),
        });
        if factor >= 1.0 && texture.is_none() { Alpha::Opaque } else { Alpha::Blend { opacity: ScalarParam { factor, texture } } }
    }

    fn normal_map(&mut self) -> Result<Option<NormalMap>, ImportError> {
        let (pbr, fbx) = (&self.m.pbr, &self.m.fbx);
        // 3ds Max's own materials have one slot for heights and normals.
        let either = matches!(self.m.shader_type, ShaderType::E3DsMaxPhysicalMaterial | ShaderType::OpenpbrMaterial);
        let slots = [(&pbr.normal_map, either), (&fbx.normal_map, false), (&fbx.bump, true)];
        let Some((map, is_bump)) = slots.into_iter().find(|(m, _)| m.texture.is_some()) else { return Ok(None) };
        let Some(texture) = self.texture(map, Use::Data)? else { return Ok(None) };
        let strength = number(&fbx.bump_factor).unwrap_or(1.0);
        let image = self.a.image_at(texture.image);
        // Many files name the colour picture as the bump map too.
        let has_normals = if is_bump { images::looks_like_normals(image) } else { !images::is_grey(image) };
        if has_normals {
            // Some programs write a factor of zero whatever they mean, but Blender the strength of its map.
            let scale = if of_blender(&self.m.element) { strength } else { 1.0 };
            return Ok(Some(NormalMap::Normal { texture, scale }));
        }
        let scale = BUMP_METRES * strength;
        self.warn(format!("the bump map's height was guessed: white is {scale} m above black"));
        Ok(Some(NormalMap::Bump { texture, scale }))
    }

    fn roughness(&mut self, rough: &MaterialMap, gloss: &MaterialMap, as_gloss: bool, default: f32) -> Result<ScalarParam, ImportError> {
        let is_gloss = as_gloss || (!has(rough) && has(gloss));
        let map = if has(gloss) && is_gloss { gloss } else { rough };
        let mut found = self.scalar(map, if is_gloss { 1.0 - default } else { default }, default)?;
        if is_gloss {
            found = match found.texture {
                Some((t, channel)) => ScalarParam { texture: Some((inverted(t, self.inverted, self.a), channel)), ..found },
                None => (1.0 - found.factor).into(),
            };
        }
        Ok(found)
    }

    /// A colour, its strength in its factor. A texture replaces the map's own value, as in the programs that write FBX, except in
    /// glTF's material, where they multiply. `stand_in` is the grey for a texture that is missing and may be.
    fn color(&mut self, map: &'c MaterialMap, default: Rgb, strength: f32, stand_in: f32) -> Result<ColorParam, ImportError> {
        let value = rgb(map).unwrap_or(default);
        self.uses(map);
        if strength == 0.0 || !map.texture_enabled || map.texture.is_none() {
            return Ok((value * strength).into());
        }
        let multiplies = self.m.shader_type == ShaderType::GltfMaterial && !value.is_black();
        let texture = self.texture(map, Use::Color)?;
        let factor = if texture.is_none() { Rgb::splat(stand_in) } else { Rgb::WHITE };
        Ok(ColorParam { factor: factor * if multiplies { value } else { Rgb::WHITE } * strength, texture })
    }

    fn scalar(&mut self, map: &MaterialMap, default: f32, stand_in: f32) -> Result<ScalarParam, ImportError> {
        self.uses(map);
        if !map.texture_enabled || map.texture.is_none() {
            return Ok(number(map).unwrap_or(default).clamp(0.0, 1.0).into());
        }
        let texture = self.texture(map, Use::Data)?;
        Ok(ScalarParam { factor: if texture.is_some() { 1.0 } else { stand_in }, texture: texture.map(|t| (t, 0)) })
    }

    fn texture(&mut self, map: &MaterialMap, usage: Use) -> Result<Option<TextureRef>, ImportError> {
        self.uses(map);
        match map.texture.as_ref().filter(|_| map.texture_enabled) {
            Some(found) => texture(found, usage, &self.user, self.a),
            None => Ok(None),
        }
    }

    /// Takes note that the texture of a map is read, or does not count because it is switched off.
    fn uses(&mut self, map: &MaterialMap) {
        self.used.extend(map.texture.as_ref().map(|texture| texture.element.element_id));
    }

    /// Reports the properties whose textures are not read, except ambient light, which has no meaning when light is computed.
    fn report_unused_textures(&mut self) {
        for slot in self.m.textures.iter().filter(|slot| !self.used.contains(&slot.texture.element.element_id)) {
            let property = &*slot.material_prop;
            if !property.contains("Ambient") {
                let message =
                    format!("the texture {:?} of its property {property:?} is not read and was dropped", &*slot.texture.element.name);
                self.a.warn(&self.user, message);
            }
        }
    }

    fn report_ignored(&mut self) {
        let pbr = &self.m.pbr;
        let on = |map: &MaterialMap| map.texture.is_some() || number(map).is_some_and(|v| v != 0.0);
        for map in [&pbr.subsurface_factor, &pbr.displacement_map, &self.m.fbx.displacement, &pbr.coat_normal, &pbr.ambient_occlusion] {
            self.uses(map);
        }
        let ignored = [
            ("subsurface scattering", on(&pbr.subsurface_factor)),
            ("anisotropy", on(&pbr.specular_anisotropy)),
            ("thin film", on(&pbr.thin_film_factor)),
            ("displacement", pbr.displacement_map.texture.is_some() || self.m.fbx.displacement.texture.is_some()),
            ("normal map of the coat", pbr.coat_normal.texture.is_some()),
            ("ambient occlusion (light transport computes it)", pbr.ambient_occlusion.texture.is_some()),
        ];
        for (what, _) in ignored.into_iter().filter(|(_, found)| *found) {
            self.warn(format!("{what} dropped"));
        }
    }

    fn warn(&mut self, message: impl Into<String>) {
        let user = self.user.clone();
        self.a.warn(user, message);
    }
}

fn has(map: &MaterialMap) -> bool {
    map.has_value || map.texture.is_some()
}

fn number(map: &MaterialMap) -> Option<f32> {
    Some(map.value_vec4.x as f32).filter(|v| map.has_value && v.is_finite())
}

fn rgb(map: &MaterialMap) -> Option<Rgb> {
    let v = &map.value_vec4;
    // One number means a grey.
    let color = if map.value_components == 1 { Rgb::splat(v.x as f32) } else { Rgb::new(v.x as f32, v.y as f32, v.z as f32) };
    Some(color).filter(|c| map.has_value && c.is_finite())
}

fn mean(c: Rgb) -> f32 {
    (c.r + c.g + c.b) / 3.0
}
