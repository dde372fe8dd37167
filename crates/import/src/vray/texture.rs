//! Textures, and the colour and number parameters that may have them.

use super::material::MID_GREY;
use super::parameters;
use super::plugins::Handle;
use super::reader::{MAX_CHAIN, Reader};
use super::uvw::Placement;
use crate::ImportError;
use crate::assembly::Source;
use crate::images;
use enfilade_math::Rgb;
use enfilade_scene::{ColorParam, Filter, ScalarParam, TextureRef};
use enfilade_vrscene::Value;

/// A texture as this workspace knows it: a factor, a picture, and for numbers its channel if the scene names one.
#[derive(Clone, Copy)]
pub(super) struct Texture {
    pub factor: Rgb,
    pub picture: Option<TextureRef>,
    pub channel: Option<u8>,
}

impl From<Rgb> for Texture {
    fn from(factor: Rgb) -> Self {
        Self { factor, picture: None, channel: None }
    }
}

/// Textures that pass another one on unchanged, and the parameter that names it.
const PASSING: [(&str, &str); 3] = [("TexAColor", "texture"), ("TexFloat", "input"), ("TexColorToFloat", "input")];

/// Parameters of other textures that are nearest to their result, in order of preference.
const NEAREST: [&str; 12] = [
    "texture",
    "texmap",
    "texture_map",
    "base_texture",
    "basetex",
    "input",
    "input_color",
    "color_a",
    "tex1",
    "color1",
    "texture1",
    "default_color",
];

impl<'n> Reader<'n, '_> {
    /// A colour parameter, or a default.
    pub(super) fn color(&mut self, plugin: Handle<'n>, parameter: &str, default: Rgb) -> Result<ColorParam, ImportError> {
        let Some(value) = plugin.value(parameter)? else { return Ok(default.into()) };
        let texture = self.texture_of(plugin, parameter, &value, 0)?;
        Ok(ColorParam { factor: texture.factor, texture: texture.picture })
    }

    /// A colour parameter that must not vary: the mean of a texture, with a warning.
    pub(super) fn plain_color(&mut self, plugin: Handle<'n>, parameter: &str, default: Rgb) -> Result<Rgb, ImportError> {
        self.plain_color_of(plugin, parameter, default, 0)
    }

    /// [`Reader::plain_color`] of a plugin that `depth` others lead to.
    fn plain_color_of(&mut self, plugin: Handle<'n>, parameter: &str, default: Rgb, depth: usize) -> Result<Rgb, ImportError> {
        let Some(value) = plugin.value(parameter)?.filter(|value| value.plugin() != Some(b"NULL")) else { return Ok(default) };
        let texture = self.texture_of(plugin, parameter, &value, depth)?;
        let Some(picture) = texture.picture else { return Ok(texture.factor) };
        self.warn(plugin, format!("a texture of {parameter} is not supported; its mean colour was used"));
        Ok(texture.factor * self.mean_of(picture.image))
    }

    /// A number parameter that must not vary: the mean of a texture, with a warning.
    pub(super) fn plain_number(&mut self, plugin: Handle<'n>, parameter: &str, default: f64) -> Result<f64, ImportError> {
        let Some(value) = plugin.value(parameter)?.filter(|value| value.plugin() != Some(b"NULL")) else { return Ok(default) };
        if value.number().is_some() {
            return plugin.number(parameter, default);
        }
        let number = self.scalar_of(plugin, parameter, &value)?;
        let Some((picture, channel)) = number.texture else { return Ok(f64::from(number.factor)) };
        self.warn(plugin, format!("a texture of {parameter} is not supported; its mean was used"));
        Ok(f64::from(number.factor * self.mean_of(picture.image)[usize::from(channel.min(2))]))
    }

    /// A number parameter, or a default.
    pub(super) fn scalar(&mut self, plugin: Handle<'n>, parameter: &str, default: f32) -> Result<ScalarParam, ImportError> {
        match plugin.value(parameter)? {
            None => Ok(default.into()),
            Some(value) => self.scalar_of(plugin, parameter, &value),
        }
    }

    /// The number parameter of a plugin's value.
    pub(super) fn scalar_of(&mut self, plugin: Handle<'n>, parameter: &str, value: &Value) -> Result<ScalarParam, ImportError> {
        let texture = self.texture_of(plugin, parameter, value, 0)?;
        let Some(picture) = texture.picture else { return Ok(grey(texture.factor).into()) };
        let channel = self.channel_of(plugin, parameter, &texture, picture);
        Ok(ScalarParam { factor: grey(texture.factor), texture: Some((picture, channel)) })
    }

    fn channel_of(&mut self, plugin: Handle, parameter: &str, texture: &Texture, picture: TextureRef) -> u8 {
        if texture.channel.is_none() && !images::is_grey(self.a.image_at(picture.image)) {
            self.warn(plugin, format!("the texture of {parameter} is coloured; its red channel was used"));
        }
        texture.channel.unwrap_or(0)
    }

    /// 1 − a number parameter.
    pub(super) fn complement(&mut self, plugin: Handle<'n>, parameter: &str, default: f32) -> Result<ScalarParam, ImportError> {
        let value = self.scalar(plugin, parameter, default)?;
        let Some((picture, channel)) = value.texture else { return Ok((1.0 - value.factor).into()) };
        let image = self.complement_of(picture.image, Rgb::splat(value.factor), Some(channel));
        Ok(ScalarParam { factor: 1.0, texture: Some((TextureRef { image, ..picture }, 0)) })
    }

    /// Perceptual roughness by a parameter for it, or for glossiness, its complement.
    pub(super) fn roughness(
        &mut self,
        plugin: Handle<'n>,
        parameter: &str,
        default: f32,
        is_roughness: bool,
    ) -> Result<ScalarParam, ImportError> {
        if is_roughness { self.scalar(plugin, parameter, default) } else { self.complement(plugin, parameter, default) }
    }

    /// GGX's alpha for a perceptual roughness. Of a texture the mean counts.
    pub(super) fn squared(&mut self, plugin: Handle, roughness: ScalarParam) -> ScalarParam {
        let Some((picture, channel)) = roughness.texture else { return (roughness.factor * roughness.factor).into() };
        self.warn(plugin, "a texture of the glossiness of mirrors and glass is not supported; its mean was used");
        let mean = roughness.factor * self.mean_of(picture.image)[usize::from(channel.min(2))];
        (mean * mean).into()
    }

    /// The texture of a plugin's value: a constant, or another plugin.
    pub(super) fn texture_of(&mut self, plugin: Handle<'n>, parameter: &str, value: &Value, depth: usize) -> Result<Texture, ImportError> {
        if depth > MAX_CHAIN {
            return Err(plugin.error(parameter, "textures refer to each other in a circle; correct the reference that closes it"));
        }
        if let Some(color) = parameters::constant(value) {
            if color.is_finite() {
                return Ok(color.into());
            }
            return Err(plugin.error(parameter, "the colour is not finite; correct the value"));
        }
        let Some(texture) = plugin.resolve(parameter, value)? else { return Ok(Rgb::BLACK.into()) };
        let output = match value {
            Value::Name(name) => name.windows(2).position(|pair| pair == b"::").map(|at| String::from_utf8_lossy(&name[at + 2..])),
            _ => None,
        };
        let mut made = self.texture(texture, depth + 1)?;
        match output.as_deref() {
            None | Some("color" | "out_color" | "out_transparency") => {}
            Some("out_alpha" | "alpha") => made.channel = Some(3),
            Some("red" | "out_red") => made.channel = Some(0),
            Some("green" | "out_green") => made.channel = Some(1),
            Some("blue" | "out_blue") => made.channel = Some(2),
            Some("out_intensity") => {}
            Some(other) => self.warn(texture, format!("the output {other} is not supported; the colour was used")),
        }
        Ok(made)
    }

    fn texture(&mut self, t: Handle<'n>, depth: usize) -> Result<Texture, ImportError> {
        let within = |reader: &mut Self, parameter: &str| match t.value(parameter)? {
            Some(value) => reader.texture_of(t, parameter, &value, depth),
            None => Ok(Rgb::BLACK.into()),
        };
        if let Some((_, parameter)) = PASSING.iter().find(|(kind, _)| *kind == t.kind()) {
            return within(self, parameter);
        }
        match t.kind() {
            "TexBitmap" => self.bitmap(t, depth),
            "TexCombineColor" => {
                let (color, mix) = (t.color("color", Rgb::BLACK)?, t.number("texture_multiplier", 1.0)? as f32);
                let texture = within(self, "texture")?;
                if texture.picture.is_some() && mix != 1.0 && !color.is_black() {
                    self.warn(t, "a colour mixed into a texture is not supported; the texture was used alone");
                }
                let rest = if texture.picture.is_none() { color * (1.0 - mix) } else { Rgb::BLACK };
                Ok(Texture { factor: texture.factor * mix + rest, ..texture })
            }
            "TexInvert" => {
                let texture = within(self, "texture")?;
                Ok(self.inverted(texture))
            }
            kind => {
                // A constant has less information than a texture.
                let holds = |parameter: &&&str| t.plugin.parameter(parameter).is_some();
                let Some(parameter) = NEAREST.iter().find(holds) else {
                    self.warn(t, format!("{kind} is not supported; a mid grey stands in"));
                    return Ok(Rgb::splat(MID_GREY).into());
                };
                self.warn(t, format!("{kind} is not supported; its {parameter} was used alone"));
                within(self, parameter)
            }
        }
    }

    fn inverted(&mut self, texture: Texture) -> Texture {
        match texture.picture {
            None => texture.factor.map(|v| 1.0 - v).into(),
            Some(picture) => {
                let image = self.complement_of(picture.image, texture.factor, texture.channel);
                Texture { factor: Rgb::WHITE, picture: Some(TextureRef { image, ..picture }), channel: texture.channel.map(|_| 0) }
            }
        }
    }

    /// A picture on the surface.
    fn bitmap(&mut self, t: Handle<'n>, depth: usize) -> Result<Texture, ImportError> {
        let mut factor = self.plain_color_of(t, "color_mult", Rgb::WHITE, depth)?;
        if t.states_texture("color_offset")? {
            self.warn(t, "color_offset is not supported and was left out");
        }
        if t.int("placement_type", 0)? != 0 {
            self.warn(t, "a part of a picture (placement_type) is not supported; the whole of it was used");
        }
        let Some(image) = self.picture(t)? else {
            factor *= MID_GREY;
            return Ok(factor.into());
        };
        let Placement { channel, uv_transform, wrap } = self.placement(t)?;
        match self.channel {
            None => self.channel = Some(channel),
            Some(known) if known != channel => {
                self.warn(t, format!("the material's textures use several channels; all were given channel {known}"));
            }
            Some(_) => {}
        }
        // −1 turns filtering off.
        let unfiltered = t.reference("bitmap")?.map_or(Ok(1), |buffer| buffer.int("filter_type", 1))? < 0;
        let filter = if unfiltered { Filter::Nearest } else { Filter::Linear };
        let picture = TextureRef { image, uv_transform, wrap, filter };
        let texture = Texture { factor, picture: Some(picture), channel: None };
        Ok(if t.flag("invert", false)? { self.inverted(texture) } else { texture })
    }

    /// The image of a `TexBitmap`; `None`, with a warning, when there is none.
    pub(super) fn picture(&mut self, t: Handle<'n>) -> Result<Option<u32>, ImportError> {
        let buffer = t.reference("bitmap")?;
        let file = match buffer {
            Some(buffer) if buffer.kind() == "BitmapBuffer" => buffer.text("file")?.map(|file| (buffer, file)),
            _ => None,
        };
        let Some((buffer, file)) = file else {
            self.warn(t, "it has no picture in a file (BitmapBuffer with file); a mid grey stands in");
            return Ok(None);
        };
        let path = match self.a.beside(buffer.file, &file) {
            Some(found) if !self.a.exists(&file) => self.a.spelled(&found),
            _ => file,
        };
        let usage = self.decoding(buffer, &path)?;
        self.a.image(&Source::File(&path), usage, &buffer.place())
    }
}

/// The grey value of a colour.
fn grey(color: Rgb) -> f32 {
    if color.r == color.g && color.g == color.b { color.r } else { color.luminance() }
}
