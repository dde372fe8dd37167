//! Materials: effects of the common profile.

use super::document::{Dae, Node, at, called, child, children, exactly, number, text};
use crate::ImportError;
use crate::assembly::{Assembly, Source};
use crate::images::Use;
use enfilade_math::{Rgb, linear_from_srgb};
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, Principled, ScalarParam, TextureRef, Wrap};
use std::collections::HashMap;

/// Reflectance of surfaces without a material.
const GREY: f32 = 0.5;
/// Shading models of the common profile.
const MODELS: [&str; 4] = ["phong", "blinn", "lambert", "constant"];
/// Parameters without a counterpart.
const LEFT_OUT: [&str; 2] = ["reflective", "bump"];

/// The materials met so far, by their ids; the empty id is the material of geometry that has none.
pub(super) struct Materials {
    known: HashMap<String, u32>,
    /// True where colours are written as they are.
    linear: bool,
}

impl Materials {
    pub(super) fn new(dae: &Dae) -> Self {
        Self { known: HashMap::new(), linear: dae.tool().contains("Blender") }
    }

    /// The material that an instance binds to a symbol, else the one of that id, else grey.
    pub(super) fn of(&mut self, dae: &Dae, instance: Node, symbol: Option<&str>, a: &mut Assembly) -> Result<u32, ImportError> {
        let bound = at(instance, &["bind_material", "technique_common"]).and_then(|technique| {
            let mut all = children(technique, "instance_material");
            let own = all.find(|m| m.attribute("symbol") == symbol);
            own.and_then(|m| dae.target(m.attribute("target")?))
        });
        let material = bound.or_else(|| dae.by_id(symbol?)).filter(|n| n.tag_name().name() == "material");
        let id = material.and_then(|m| m.attribute("id")).unwrap_or_default().to_string();
        if let Some(&known) = self.known.get(&id) {
            return Ok(known);
        }
        if let (None, Some(symbol)) = (material, symbol) {
            a.warn(called(instance), format!("the material {symbol:?} is not in the file; grey stands in"));
        }
        let made = material.map(|material| self.read(dae, material, a)).transpose()?;
        let index = a.push_material(made.unwrap_or_else(|| Material::diffuse("default", Rgb::splat(GREY))));
        self.known.insert(id, index);
        Ok(index)
    }

    fn read(&self, dae: &Dae, material: Node, a: &mut Assembly) -> Result<Material, ImportError> {
        let name = material.attribute("name").or(material.attribute("id")).unwrap_or("material").to_string();
        let effect = child(material, "instance_effect").and_then(|i| dae.target(i.attribute("url")?));
        let profile = effect.and_then(|effect| child(effect, "profile_COMMON"));
        let technique = profile.and_then(|profile| child(profile, "technique"));
        let model = technique.and_then(|t| t.children().find(|n| MODELS.contains(&n.tag_name().name())));
        let (Some(effect), Some(profile), Some(model)) = (effect, profile, model) else {
            a.warn(called(material), "its effect has no common profile; grey stands in");
            return Ok(Material::diffuse(name, Rgb::splat(GREY)));
        };
        if effect
            .descendants()
            .any(|n| LEFT_OUT.contains(&n.tag_name().name()) && n.descendants().any(|t| t.tag_name().name() == "texture"))
        {
            a.warn("library_effects", "bump maps and pictures of reflections were left out");
        }
        Reader { dae, scopes: [profile, effect], model, user: format!("material {name:?}"), linear: self.linear, a }.material(name)
    }
}

/// A colour or a picture of an effect, and its opacity.
struct Value {
    color: Rgb,
    alpha: f32,
    texture: Option<TextureRef>,
}

struct Reader<'r, 'd, 'a> {
    dae: &'r Dae<'d>,
    /// Elements in which parameters are sought.
    scopes: [Node<'d>; 2],
    model: Node<'d>,
    user: String,
    linear: bool,
    a: &'r mut Assembly<'a>,
}

impl<'d> Reader<'_, 'd, '_> {
    fn material(&mut self, name: String) -> Result<Material, ImportError> {
        let is_constant = self.model.tag_name().name() == "constant";
        let plain = |grey: f32| Value { color: Rgb::splat(grey), alpha: 1.0, texture: None };
        let emission = self.value("emission", Use::Color)?.unwrap_or(plain(0.0));
        let diffuse = self.value("diffuse", Use::Color)?.unwrap_or(plain(if is_constant { 0.0 } else { GREY }));
        let alpha = self.alpha()?;
        let base = ColorParam { factor: diffuse.color.map(|c| c.clamp(0.0, 1.0)), texture: diffuse.texture };
        let specular = self.value("specular", Use::Color)?;
        let bsdf = match specular.filter(|s| !s.color.is_black() && !is_constant) {
            Some(specular) => {
                let exponent = self.float("shininess").unwrap_or(0.0).max(0.0);
                let roughness = (2.0 / (exponent + 2.0)).sqrt().sqrt() as f32;
                let specular_color = ColorParam { factor: specular.color.map(|c| c.clamp(0.0, 1.0)), texture: specular.texture };
                let ior = self.float("index_of_refraction").filter(|n| *n > 1.0).map_or(1.5, |n| n as f32);
                let p = Principled { base_color: base, roughness: roughness.into(), ior, specular_color, ..Principled::default() };
                Bsdf::Principled(Box::new(p))
            }
            None => Bsdf::Diffuse { reflectance: base },
        };
        let emission = ColorParam { factor: emission.color.map(|c| c.max(0.0)), texture: emission.texture };
        Ok(Material { name, bsdf, emission, two_sided: true, emits_both_sides: true, alpha, normal_map: None })
    }

    /// Opacity of the surface, by the four modes of COLLADA 1.5.
    fn alpha(&mut self) -> Result<Alpha, ImportError> {
        let element = child(self.model, "transparent");
        let transparency = self.float("transparency").map_or(1.0, |t| t.clamp(0.0, 1.0) as f32);
        let Some(element) = element else {
            return Ok(self.opaque_unless(if self.float("transparency").is_some() { transparency } else { 1.0 }, None));
        };
        let Some(value) = self.value("transparent", Use::Data)? else { return Ok(Alpha::Opaque) };
        let mode = element.attribute("opaque").unwrap_or("A_ONE");
        let (share, inverted) = match mode {
            "RGB_ZERO" => (value.color.luminance(), true),
            "RGB_ONE" => (value.color.luminance(), false),
            "A_ZERO" => (value.alpha, true),
            _ => (value.alpha, false),
        };
        if let Some(texture) = value.texture {
            if inverted {
                self.warn(format!("the picture of what is see-through ({mode}) was left out; the surface is opaque"));
                return Ok(Alpha::Opaque);
            }
            let has_alpha = !crate::images::is_opaque(self.a.image_at(texture.image));
            let channel = if mode == "RGB_ONE" || !has_alpha { 0 } else { 3 };
            // The colour's own picture, without an alpha channel, has no information about opacity.
            return Ok(match mode == "RGB_ONE" || has_alpha {
                true => self.opaque_unless(transparency, Some((texture, channel))),
                false => Alpha::Opaque,
            });
        }
        let share = share * transparency;
        Ok(self.opaque_unless(if inverted { 1.0 - share } else { share }, None))
    }

    fn opaque_unless(&mut self, opacity: f32, texture: Option<(TextureRef, u8)>) -> Alpha {
        if opacity <= 0.0 {
            self.warn(
                "found an opacity of zero, which would hide the surface; one was used, since programs disagree about what zero means",
            );
        }
        let factor = if opacity <= 0.0 { 1.0 } else { opacity.min(1.0) };
        if factor < 1.0 || texture.is_some() { Alpha::Blend { opacity: ScalarParam { factor, texture } } } else { Alpha::Opaque }
    }

    /// A number of the model, or of the parameter that it refers to.
    fn float(&self, name: &str) -> Option<f64> {
        let element = child(self.model, name)?;
        let of = |node: Node<'d>| child(node, "float").and_then(|float| number(&text(float)));
        of(element).or_else(|| of(self.parameter(child(element, "param")?.attribute("ref")?)?))
    }

    fn value(&mut self, name: &str, usage: Use) -> Result<Option<Value>, ImportError> {
        let Some(element) = child(self.model, name) else { return Ok(None) };
        if let Some(texture) = child(element, "texture") {
            let found = self.texture(texture, usage)?;
            let color = if found.is_some() { Rgb::WHITE } else { Rgb::splat(GREY) };
            return Ok(Some(Value { color, alpha: 1.0, texture: found }));
        }
        let parameter = || self.parameter(child(element, "param")?.attribute("ref")?);
        let color = child(element, "color").or_else(|| {
            let parameter = parameter()?;
            ["float3", "float4", "color"].iter().find_map(|kind| child(parameter, kind))
        });
        let rgba = color.and_then(|c| exactly::<4>(c).or_else(|| exactly::<3>(c).map(|[r, g, b]| [r, g, b, 1.0])));
        Ok(rgba.map(|[r, g, b, alpha]| {
            let rgb = [r, g, b]
                .map(|v| if self.linear || usage == Use::Data || v > 1.0 { v as f32 } else { linear_from_srgb(v.max(0.0) as f32) });
            Value { color: Rgb::from(rgb), alpha: alpha.clamp(0.0, 1.0) as f32, texture: None }
        }))
    }

    fn parameter(&self, sid: &str) -> Option<Node<'d>> {
        self.scopes.iter().find_map(|scope| children(*scope, "newparam").find(|p| p.attribute("sid") == Some(sid)))
    }

    fn texture(&mut self, texture: Node<'d>, usage: Use) -> Result<Option<TextureRef>, ImportError> {
        let named = texture.attribute("texture").unwrap_or_default();
        let sampler = self.parameter(named).and_then(|p| child(p, "sampler2D").or_else(|| child(p, "sampler")));
        let image = match sampler {
            Some(sampler) => {
                let by_url = child(sampler, "instance_image").and_then(|i| self.dae.target(i.attribute("url")?));
                by_url.or_else(|| {
                    let surface = child(self.parameter(&text(child(sampler, "source")?))?, "surface")?;
                    self.dae.by_id(&text(child(surface, "init_from")?))
                })
            }
            None => self.dae.by_id(named),
        };
        let init = image.filter(|i| i.tag_name().name() == "image").and_then(|i| child(i, "init_from"));
        let path = init.map(|init| child(init, "ref").map_or_else(|| text(init), text)).filter(|path| !path.is_empty());
        let Some(path) = path else {
            self.warn(format!("the texture {named:?} names no picture; a mid grey stands in"));
            return Ok(None);
        };
        let wrap = |name: &str| match sampler.and_then(|s| child(s, name)).map(text).as_deref() {
            Some("CLAMP" | "BORDER" | "NONE") => Wrap::Clamp,
            Some("MIRROR" | "MIRROR_ONCE") => Wrap::Mirror,
            _ => Wrap::Repeat,
        };
        let file = file_of(&path, self.a);
        let image = self.a.image(&Source::File(&file), usage, &self.user)?;
        Ok(image.map(|image| TextureRef { wrap: [wrap("wrap_s"), wrap("wrap_t")], ..TextureRef::new(image) }))
    }

    fn warn(&mut self, message: impl Into<String>) {
        let user = self.user.clone();
        self.a.warn(user, message);
    }
}

/// The path that a picture's URI refers to: as written, or without its scheme and escapes, or its name alone beside the file.
fn file_of(uri: &str, a: &Assembly) -> String {
    let plain = uri.strip_prefix("file://").map_or(uri, |rest| {
        // `file:///C:/a.png` is `C:/a.png`, `file:///a.png` is `/a.png`.
        rest.strip_prefix('/').filter(|rest| rest.as_bytes().get(1) == Some(&b':')).unwrap_or(rest)
    });
    let decoded = String::from_utf8_lossy(&crate::percent::percent_decoded(plain)).into_owned();
    a.find(&[uri, plain, &decoded], &["", "textures/"]).unwrap_or(decoded)
}
