//! `UsdUVTexture`, with the transform and the texture coordinates that feed it.

use super::files::{is_embedded, resolve};
use super::shader::{Source, id, source};
use super::stage::{Prim, Stage};
use super::value::Value;
use crate::ImportError;
use crate::assembly::{Assembly, Source as Picture};
use crate::images::Use;
use enfilade_math::{Rgb, srgb_from_linear};
use enfilade_scene::{Image, Pixels, TextureRef, Wrap};
use std::collections::HashMap;
use std::rc::Rc;

/// A texture as a shader's input sees it.
pub(super) struct Texture {
    /// The picture and how coordinates find their way into it; `None` when it is missing and that is allowed.
    pub texture: Option<TextureRef>,
    /// Values are texel × scale + bias, for red, green, blue and alpha.
    pub scale: [f32; 4],
    pub bias: [f32; 4],
    /// The value that replaces a missing picture.
    pub fallback: Option<[f32; 4]>,
    /// The output that is read: r, g, b, a or rgb.
    pub output: String,
}

/// Reads textures of one material.
pub(super) struct Textures<'t, 'a, 'b> {
    pub stage: &'t mut Stage,
    pub a: &'t mut Assembly<'a>,
    /// The material, for messages.
    pub user: String,
    /// Primvar of the texture coordinates, once one is known.
    pub uv_name: Option<String>,
    /// The primvar that the base colour is, where it is one.
    pub color_name: Option<String>,
    /// Pictures whose texels were changed: from which, and how.
    pub baked: &'b mut HashMap<String, u32>,
}

impl Textures<'_, '_, '_> {
    pub(super) fn warn(&mut self, message: impl Into<String>) {
        let user = self.user.clone();
        self.a.warn(user, message);
    }

    /// The texture that an output of a shader is; `None`, with a warning, for other shaders.
    pub(super) fn read(&mut self, shader: &Rc<Prim>, output: &str, usage: Use) -> Result<Option<Texture>, ImportError> {
        let kind = id(shader);
        if kind.starts_with("ND_") {
            return self.mtlx_texture(shader, usage);
        }
        if kind != "UsdUVTexture" {
            self.warn(format!("{} is a {kind:?}, which is not supported as a texture; its fallback or the default holds", shader.path));
            return Ok(None);
        }
        let vector = |value: Source, default: [f32; 4]| match value {
            Source::Value(v, _) => v.as_tuple::<4>().map_or(default, |v| v.map(|c| c as f32)),
            _ => default,
        };
        let scale = vector(self.source(shader, "inputs:scale")?, [1.0; 4]);
        let bias = vector(self.source(shader, "inputs:bias")?, [0.0; 4]);
        let fallback = match self.source(shader, "inputs:fallback")? {
            Source::Value(v, _) => v.as_tuple::<4>().map(|v| v.map(|c| c as f32)),
            _ => None,
        };
        let usage = match (self.token(shader, "inputs:sourceColorSpace")?.as_str(), output) {
            // Alpha is linear in both, so one picture serves colour and opacity.
            (_, "a") => Use::Color,
            ("raw", _) => Use::Data,
            ("sRGB", _) => Use::Color,
            _ => usage,
        };
        let mut texture = self.image(shader, usage)?.map(TextureRef::new);
        let wrap = [self.wrap(shader, "inputs:wrapS")?, self.wrap(shader, "inputs:wrapT")?];
        let uv_transform = self.coordinates(shader)?;
        if let Some(texture) = &mut texture {
            texture.wrap = wrap;
            texture.uv_transform = uv_transform;
        }
        Ok(Some(Texture { texture, scale, bias, fallback, output: output.to_string() }))
    }

    fn source(&mut self, prim: &Rc<Prim>, name: &str) -> Result<Source, ImportError> {
        source(self.stage, prim, name, self.a)
    }

    pub(super) fn token(&mut self, prim: &Rc<Prim>, name: &str) -> Result<String, ImportError> {
        Ok(match self.source(prim, name)? {
            Source::Value(value, _) => value.as_text().unwrap_or("").to_string(),
            _ => String::new(),
        })
    }

    pub(super) fn wrap(&mut self, shader: &Rc<Prim>, name: &str) -> Result<Wrap, ImportError> {
        Ok(match self.token(shader, name)?.as_str() {
            "clamp" => Wrap::Clamp,
            "mirror" => Wrap::Mirror,
            "black" | "constant" => {
                self.warn("a texture that is black beyond its border is continued with its border instead");
                Wrap::Clamp
            }
            _ => Wrap::Repeat,
        })
    }

    /// The picture of a texture.
    pub(super) fn image(&mut self, shader: &Rc<Prim>, usage: Use) -> Result<Option<u32>, ImportError> {
        let Source::Value(value, layer) = self.source(shader, "inputs:file")? else {
            self.warn(format!("{} names no file; its fallback or the default holds", shader.path));
            return Ok(None);
        };
        let asset = value.as_text().unwrap_or("").to_string();
        self.picture(&asset, &layer, usage)
    }

    /// The picture that an asset path in a layer means.
    pub(super) fn picture(&mut self, asset: &str, layer: &str, usage: Use) -> Result<Option<u32>, ImportError> {
        if asset.is_empty() {
            self.warn("a texture names no file; its fallback or the default holds");
            return Ok(None);
        }
        if asset.contains("<UDIM>") {
            self.warn(format!("of the tiles of {asset} only 1001 is used"));
        }
        let location = resolve(&asset.replace("<UDIM>", "1001"), layer);
        let user = self.user.clone();
        match self.stage.embedded(&location) {
            Some(bytes) => self.a.image(&Picture::Embedded(location, &bytes), usage, &user),
            None if is_embedded(&location) => self.a.image(&Picture::Missing(location), usage, &user),
            None => self.a.image(&Picture::File(&location), usage, &user),
        }
    }

    /// The transform of texture coordinates; notes the primvar that they come from.
    fn coordinates(&mut self, shader: &Rc<Prim>) -> Result<[[f32; 3]; 2], ImportError> {
        let mut transform = TextureRef::new(0).uv_transform;
        let mut at = self.source(shader, "inputs:st")?;
        if let Source::Shader(node, _) = &at
            && id(node) == "UsdTransform2d"
        {
            let node = node.clone();
            let mut pair = |name: &str, default: f32| -> Result<[f32; 2], ImportError> {
                Ok(match source(self.stage, &node, name, self.a)? {
                    Source::Value(v, _) => v.as_tuple::<2>().map_or([default; 2], |v| v.map(|c| c as f32)),
                    _ => [default; 2],
                })
            };
            let ([sx, sy], [tx, ty]) = (pair("inputs:scale", 1.0)?, pair("inputs:translation", 0.0)?);
            let angle = match self.source(&node, "inputs:rotation")? {
                Source::Value(v, _) => v.as_number().unwrap_or(0.0),
                _ => 0.0,
            };
            // Scale first, then a turn counter-clockwise, then translation.
            let (sin, cos) = (angle.to_radians() as f32).sin_cos();
            transform = [[cos * sx, -sin * sy, tx], [sin * sx, cos * sy, ty]];
            at = self.source(&node, "inputs:in")?;
        }
        let Source::Shader(reader, _) = at else { return Ok(transform) };
        if !id(&reader).starts_with("UsdPrimvarReader") {
            self.warn(format!("texture coordinates from a {:?} are not supported; the mesh's own are used", id(&reader)));
            return Ok(transform);
        }
        let name = Some(self.token(&reader, "inputs:varname")?).filter(|n| !n.is_empty()).unwrap_or_else(|| "st".into());
        self.read_at(name);
        Ok(transform)
    }

    /// Notes the primvar of a texture's coordinates.
    pub(super) fn read_at(&mut self, name: String) {
        match &self.uv_name {
            Some(known) if *known != name => {
                let message = format!("it uses the texture coordinates {known:?} and {name:?}; all textures get the first");
                self.warn(message);
            }
            Some(_) => (),
            None => self.uv_name = Some(name),
        }
    }

    /// A picture whose texels are `change` of those of another one: their linear red, green, blue and alpha.
    pub(super) fn baked(&mut self, image: u32, key: &str, kept: Kept, change: impl Fn([f32; 4]) -> [f32; 3]) -> u32 {
        let key = format!("{image} {key}");
        if let Some(&known) = self.baked.get(&key) {
            return known;
        }
        let from = self.a.image_at(image);
        let (width, height) = (from.width as usize, from.height as usize);
        let texels = (0..width * height).map(|i| {
            let (Rgb { r, g, b }, alpha) = from.texel(i % width, i / width);
            change([r, g, b, alpha])
        });
        let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0).round() as u8;
        let bytes = |encode: fn(f32) -> f32| move |t: [f32; 3]| [byte(encode(t[0])), byte(encode(t[1])), byte(encode(t[2])), 255];
        let pixels = match kept {
            Kept::Srgb => Pixels::Rgba8 { srgb: true, texels: texels.map(bytes(srgb_from_linear)).collect() },
            Kept::Linear => Pixels::Rgba8 { srgb: false, texels: texels.map(bytes(|v| v)).collect() },
            Kept::Float => Pixels::RgbF32(texels.map(|t| t.map(|v| v.max(0.0))).collect()),
        };
        let image = Image { name: format!("{} × scale + bias", from.name), width: from.width, height: from.height, pixels };
        let index = self.a.push_image(image);
        self.baked.insert(key, index);
        index
    }

    /// Storage of texels times a scale plus a bias (one pair for each channel that is read): the picture's own if the results stay within 0
    /// and 1.
    pub(super) fn kept(&self, image: u32, scale: &[f32], bias: &[f32]) -> Kept {
        let fits = scale.iter().zip(bias).all(|(s, b)| [*b, s + b].iter().all(|end| (0.0..=1.0).contains(end)));
        match &self.a.image_at(image).pixels {
            Pixels::Rgba8 { srgb: true, .. } if fits => Kept::Srgb,
            Pixels::Rgba8 { srgb: false, .. } if fits => Kept::Linear,
            _ => Kept::Float,
        }
    }
}

/// The storage of a changed picture's texels.
#[derive(Clone, Copy)]
pub(super) enum Kept {
    /// Eight bits, encoded as sRGB.
    Srgb,
    /// Eight bits as they are.
    Linear,
    /// Floating point.
    Float,
}

/// A colour of three numbers.
pub(super) fn rgb(value: &Value) -> Option<Rgb> {
    let color = value.as_tuple::<3>().or_else(|| value.as_tuple::<4>().map(|[r, g, b, _]| [r, g, b]));
    color.or_else(|| value.as_number().map(|v| [v; 3])).map(|c| Rgb::from(c.map(|v| v as f32)))
}
