//! Number parameters, and the textures that may replace them.

use super::reader::Reader;
use super::spectrum;
use super::texture::Texture;
use super::xml::Node;
use crate::ImportError;
use crate::images::{self, Use};
use crate::spectrum::Kind;
use enfilade_math::{Rgb, srgb_from_linear};
use enfilade_scene::{Image, Pixels, ScalarParam, TextureRef};

impl<'n> Reader<'n, '_> {
    /// The number parameter `name` of `node`, or a default.
    pub(super) fn scalar(&mut self, node: &'n Node, name: &str, default: f32) -> Result<ScalarParam, ImportError> {
        let Some(property) = self.property(node, name)? else { return Ok(default.into()) };
        if property.tag != "texture" {
            return Ok(grey(spectrum::color(property, Kind::Factor)?).into());
        }
        // Mitsuba linearizes number textures like colours unless they are marked raw.
        let t = self.texture(property, Use::Color, 0)?;
        Ok(self.as_number(t))
    }

    /// The number parameter `name` of `node`, where this workspace has no texture: `None` without it, and the mean, with a warning,
    /// where it is one.
    pub(super) fn plain(&mut self, node: &'n Node, name: &str) -> Result<Option<f64>, ImportError> {
        let Some(property) = self.property(node, name)? else { return Ok(None) };
        if property.attribute("value").is_some() {
            return Ok(property.numbers("value")?.first().copied());
        }
        if property.tag != "texture" {
            return Ok(Some(f64::from(grey(spectrum::color(property, Kind::Factor)?))));
        }
        self.warn(property, format!("a texture of {name} in {} is not supported; its mean was used", node.plugin));
        let t = self.texture(property, Use::Color, 0)?;
        let number = self.as_number(t);
        let mean = number.texture.map_or(1.0, |(picture, channel)| images::mean(self.a.image_at(picture.image), channel));
        Ok(Some(f64::from(number.factor * mean)))
    }

    /// A texture as a number: its channel if it names one, else its colours' luminance; their mean in version 0.x.
    pub(super) fn as_number(&mut self, t: Texture) -> ScalarParam {
        let factor = grey(t.factor);
        let texture = t.picture.map(|picture| match t.channel {
            Some(channel) => (picture, channel),
            None => (TextureRef { image: self.grey_picture(picture.image), ..picture }, 0),
        });
        ScalarParam { factor, texture }
    }

    /// The grey picture of a coloured one, as precise as that.
    fn grey_picture(&mut self, image: u32) -> u32 {
        if let Some(&made) = self.greys.get(&image) {
            return made;
        }
        let source = self.a.image_at(image);
        if images::is_grey(source) {
            return image;
        }
        let number = |c: Rgb| if self.version < 2 { (c.r + c.g + c.b) / 3.0 } else { c.luminance() };
        let width = source.width as usize;
        let values = (0..width * source.height as usize).map(|i| number(source.texel(i % width, i / width).0));
        let pixels = match source.pixels {
            Pixels::Rgba8 { srgb, .. } => {
                let byte = |v: f32| ((if srgb { srgb_from_linear(v) } else { v }).clamp(0.0, 1.0) * 255.0).round() as u8;
                Pixels::Rgba8 { srgb, texels: values.map(byte).map(|v| [v, v, v, 255]).collect() }
            }
            Pixels::RgbF32(_) => Pixels::RgbF32(values.map(|v| [v; 3]).collect()),
        };
        let made = Image { name: format!("{} (grey)", source.name), width: source.width, height: source.height, pixels };
        let made = self.a.push_image(made);
        self.greys.insert(image, made);
        made
    }
}

/// A colour as a number.
fn grey(c: Rgb) -> f32 {
    if c.r == c.g && c.g == c.b { c.r } else { c.luminance() }
}
