//! Textures, and the colour and number parameters that may have them.

use super::definition::TextureDefinition;
use super::made::{Picture, Texture};
use super::params::{Params, Values};
use super::reader::{MAX_REFERENCES, Reader};
use super::version::Version;
use crate::ImportError;
use crate::assembly::Source;
use crate::images::{self, Use};
use crate::spectrum::Kind;
use enfilade_math::Rgb;
use enfilade_scene::{ColorParam, Filter, Image, Pixels, ScalarParam, TextureRef, Wrap};

/// Replaces textures that have no counterpart.
const MID_GREY: f32 = 0.5;

impl Reader<'_> {
    /// Notes a texture; the later one of a name counts from here on.
    pub(super) fn define_texture(&mut self, definition: TextureDefinition) {
        self.texture_names[usize::from(definition.number)].insert(definition.name.clone(), self.textures.len());
        self.textures.push(definition);
    }

    /// Notes which textures parameters refer to, by the definitions of their names so far.
    pub(super) fn bind(&self, params: &Params) {
        for param in params.iter().filter(|p| p.kind == "texture") {
            if let Values::Strings(names) = &param.values
                && let Some(name) = names.first()
            {
                param.bound.set([0, 1].map(|i| self.texture_names[i].get(name).copied()));
            }
        }
    }

    /// The colour parameter `name`, or a default.
    pub(super) fn color_param(&mut self, params: &Params, name: &str, default: Rgb) -> Result<ColorParam, ImportError> {
        let t = self.texture_param(params, name, default, false, 0)?;
        Ok(ColorParam { factor: t.factor, texture: t.picture.map(|p| self.as_color(p)) })
    }

    /// The number parameter `name`, or a default.
    pub(super) fn scalar(&mut self, params: &Params, name: &str, default: f32) -> Result<ScalarParam, ImportError> {
        let t = self.texture_param(params, name, Rgb::splat(default), true, 0)?;
        let Some(Picture { texture, channel }) = t.picture else { return Ok(t.factor.g.into()) };
        if channel.is_none() && !images::is_grey(self.a.image_at(texture.image)) {
            self.warn(&params.place, format!("the texture of the number {name} is coloured; its red channel was used"));
        }
        Ok(ScalarParam { factor: t.factor.r, texture: Some((texture, channel.unwrap_or(0))) })
    }

    fn texture_param(&mut self, params: &Params, name: &str, default: Rgb, number: bool, depth: usize) -> Result<Texture, ImportError> {
        let Some(param) = params.get(name) else { return Ok(default.into()) };
        let Values::Strings(names) = &param.values else { return Ok(self.color_of(params, param, Kind::Factor)?.into()) };
        if param.kind != "texture" {
            return Ok(self.color_of(params, param, Kind::Factor)?.into());
        }
        let wanted = names.first().map(String::as_str).unwrap_or_default();
        let bound = param.bound.get();
        // Version 4 lets definitions come later.
        let find = |i: usize| bound[i].or_else(|| self.texture_names[i].get(wanted).copied());
        let index = find(usize::from(number)).or_else(|| find(usize::from(!number)));
        let index = index.ok_or_else(|| params.place.error(format!("{name} refers to the texture {wanted:?}, which is not defined")))?;
        self.texture(index, depth)
    }

    /// The converted texture, converted once.
    fn texture(&mut self, index: usize, depth: usize) -> Result<Texture, ImportError> {
        let definition = &self.textures[index];
        if let Some(made) = definition.made {
            return Ok(made);
        }
        let (params, class, number) = (definition.params.clone(), definition.class.clone(), definition.number);
        if depth > MAX_REFERENCES {
            return Err(params.place.error(format!("textures are nested more than {MAX_REFERENCES} deep")));
        }
        let texture = match class.as_str() {
            "constant" => self.texture_param(&params, "value", Rgb::WHITE, number, depth + 1)?,
            "imagemap" => self.image_map(&params, number)?,
            "scale" => self.scaled(&params, number, depth + 1)?,
            "mix" => self.mixed(&params, number, depth + 1)?,
            "checkerboard" => self.checkerboard(&params, number, depth + 1)?,
            "bilerp" => {
                self.warn(&params.place, "the corners' mean stands in for the texture");
                let mut sum = Rgb::BLACK;
                for (corner, default) in [("v00", 0.0), ("v01", 1.0), ("v10", 0.0), ("v11", 1.0)] {
                    sum += self.color(&params, corner, Kind::Factor, Rgb::splat(default))?;
                }
                (sum * 0.25).into()
            }
            "directionmix" => {
                self.warn(&params.place, "textures by direction are not supported; the mean of both stands in");
                let (a, b) = self.pair(&params, Rgb::BLACK, Rgb::WHITE, number, depth + 1)?;
                self.flat(a).lerp(self.flat(b), 0.5).into()
            }
            _ => {
                self.warn(&params.place, format!("{class} textures are not supported; a mid grey stands in"));
                return Ok(self.keep(index, Rgb::splat(MID_GREY).into()));
            }
        };
        self.report_unused(&params, &["trilinear", "maxanisotropy", "filter", "aamode"]);
        Ok(self.keep(index, texture))
    }

    fn keep(&mut self, index: usize, texture: Texture) -> Texture {
        self.textures[index].made = Some(texture);
        texture
    }

    fn pair(&mut self, params: &Params, first: Rgb, second: Rgb, number: bool, depth: usize) -> Result<(Texture, Texture), ImportError> {
        Ok((self.texture_param(params, "tex1", first, number, depth)?, self.texture_param(params, "tex2", second, number, depth)?))
    }

    /// One colour for a whole texture.
    fn flat(&self, texture: Texture) -> Rgb {
        texture.picture.map_or(texture.factor, |p| texture.factor * self.mean(p))
    }

    fn image_map(&mut self, params: &Params, number: bool) -> Result<Texture, ImportError> {
        let Some(path) = params.string("filename")?.filter(|path| !path.trim().is_empty()) else {
            self.warn(&params.place, "the image map names no file; a mid grey stands in");
            return Ok(Rgb::splat(MID_GREY).into());
        };
        let linear = match params.string("encoding")? {
            None | Some("sRGB") => !params.flag("gamma", true)?,
            Some("linear") => true,
            Some(other) => {
                self.warn(&params.place, format!("the encoding {other:?} was taken for sRGB"));
                false
            }
        };
        let scale = params.float_or("scale", 1.0)? as f32;
        let usage = if linear { Use::Data } else { Use::Color };
        let Some(image) = self.a.image(&Source::File(path), usage, &params.place.text())? else { return Ok(Rgb::splat(MID_GREY).into()) };
        let wrap = match params.string("wrap")? {
            None | Some("repeat") => Wrap::Repeat,
            Some("clamp") => Wrap::Clamp,
            Some(other) => {
                self.warn(&params.place, format!("wrapping by {other:?} was taken for clamp"));
                Wrap::Clamp
            }
        };
        let filter = if params.string("filter")? == Some("point") { Filter::Nearest } else { Filter::Linear };
        let texture = TextureRef { uv_transform: self.uv_transform(params, 1.0)?, wrap: [wrap; 2], filter, ..TextureRef::new(image) };
        let picture = if number { self.as_number(texture) } else { texture.into() };
        if params.flag("invert", false)? {
            let inverted = self.baked(picture, "inverted", &[scale], |c| (c * scale).map(|v| (1.0 - v).max(0.0)));
            return Ok(Texture { factor: Rgb::WHITE, picture: Some(inverted) });
        }
        Ok(Texture { factor: Rgb::splat(scale), picture: Some(picture) })
    }

    /// s = uscale·u + udelta, and likewise t, both times `scale`. v goes upward in pbrt as here.
    fn uv_transform(&mut self, params: &Params, scale: f64) -> Result<[[f32; 3]; 2], ImportError> {
        if let Some(mapping) = params.string("mapping")?.filter(|m| *m != "uv") {
            self.warn(&params.place, format!("{mapping} mapping is not supported; the mesh's own coordinates were used"));
            params.ignore(&["v1", "v2"]);
        }
        let number = |name: &str, default: f64| Ok::<f32, ImportError>((scale * params.float_or(name, default)?) as f32);
        Ok([[number("uscale", 1.0)?, 0.0, number("udelta", 0.0)?], [0.0, number("vscale", 1.0)?, number("vdelta", 0.0)?]])
    }

    /// The product of two textures.
    fn scaled(&mut self, params: &Params, number: bool, depth: usize) -> Result<Texture, ImportError> {
        let (a, b) = match self.version {
            Version::V3 => self.pair(params, Rgb::WHITE, Rgb::WHITE, number, depth)?,
            Version::V4 => (
                self.texture_param(params, "tex", Rgb::WHITE, number, depth)?,
                self.texture_param(params, "scale", Rgb::WHITE, true, depth)?,
            ),
        };
        let b = if a.picture.is_some() && b.picture.is_some() {
            self.warn(&params.place, "a product of two pictures is not supported; the mean of the second was used");
            self.flat(b).into()
        } else {
            b
        };
        Ok(Texture { factor: a.factor * b.factor, picture: a.picture.or(b.picture) })
    }

    /// One texture fading into another: baked where one of the three is a picture.
    fn mixed(&mut self, params: &Params, number: bool, depth: usize) -> Result<Texture, ImportError> {
        let (a, b) = self.pair(params, Rgb::BLACK, Rgb::WHITE, number, depth)?;
        let amount = self.texture_param(params, "amount", Rgb::splat(0.5), true, depth)?;
        let Some(picture) = a.picture.or(b.picture).or(amount.picture) else {
            return Ok(a.factor.lerp(b.factor, amount.factor.g).into());
        };
        // Whatever is of another picture than the first counts by its mean.
        let mut several = false;
        let [a, b, amount] = [a, b, amount].map(|t| match t.picture {
            Some(p) if p != picture => {
                several = true;
                (self.flat(t), false)
            }
            p => (t.factor, p.is_some()),
        });
        if several {
            self.warn(&params.place, "a mix of several pictures is not supported; the means of all but the first were used");
        }
        let factors: Vec<f32> = [a, b, amount].iter().flat_map(|(f, own)| [f.r, f.g, f.b, f32::from(u8::from(*own))]).collect();
        let mix = |c: Rgb| {
            let value = |(factor, own): (Rgb, bool)| if own { factor * c } else { factor };
            value(a).lerp(value(b), value(amount).r.clamp(0.0, 1.0))
        };
        Ok(Texture { factor: Rgb::WHITE, picture: Some(self.baked(picture, "mixed", &factors, mix)) })
    }

    /// Unit squares of two colours, baked into a picture of two by two texels.
    fn checkerboard(&mut self, params: &Params, number: bool, depth: usize) -> Result<Texture, ImportError> {
        if params.float_or("dimension", 2.0)? != 2.0 {
            self.warn(&params.place, "checkerboards in space are not supported; the mean of both colours stands in");
            let (a, b) = self.pair(params, Rgb::WHITE, Rgb::BLACK, number, depth)?;
            return Ok(self.flat(a).lerp(self.flat(b), 0.5).into());
        }
        let (a, b) = self.pair(params, Rgb::WHITE, Rgb::BLACK, number, depth)?;
        if a.picture.is_some() || b.picture.is_some() {
            self.warn(&params.place, "pictures within a checkerboard are not supported; their means were used");
        }
        let (a, b) = (self.flat(a).to_array(), self.flat(b).to_array());
        // Row 0 is the top: the square at the lower left is of the first colour.
        let pixels = Pixels::RgbF32(vec![b, a, a, b]);
        let image = self.a.push_image(Image { name: "checkerboard".into(), width: 2, height: 2, pixels });
        let uv_transform = self.uv_transform(params, 0.5)?;
        let picture = TextureRef { uv_transform, filter: Filter::Nearest, ..TextureRef::new(image) };
        Ok(Texture { factor: Rgb::WHITE, picture: Some(picture.into()) })
    }
}
