//! Textures, and the colour and number parameters that may have them.

use super::reader::{MAX_REFERENCES, Reader, spelling};
use super::spectrum;
use super::transform;
use super::xml::Node;
use crate::ImportError;
use crate::assembly::Source;
use crate::images::Use;
use crate::mesh::flip_v_of_transform;
use crate::spectrum::Kind;
use enfilade_math::Rgb;
use enfilade_scene::{ColorParam, Filter, Image, Pixels, TextureRef, Wrap};

/// Replaces textures that have no counterpart.
const MID_GREY: f32 = 0.5;

/// A texture as this workspace knows it: a factor, a picture, and for numbers its channel if the file names one.
#[derive(Clone, Copy)]
pub(super) struct Texture {
    pub factor: Rgb,
    pub picture: Option<TextureRef>,
    pub channel: Option<u8>,
}

impl<'n> Reader<'n, '_> {
    /// The colour parameter `name` of `node`, or a default.
    pub(super) fn color(&mut self, node: &'n Node, name: &str, kind: Kind, default: Rgb) -> Result<ColorParam, ImportError> {
        let Some(property) = self.property(node, name)? else { return Ok(default.into()) };
        if property.tag != "texture" {
            return Ok(self.spectrum(property, kind)?.into());
        }
        let t = self.texture(property, Use::Color, 0)?;
        Ok(ColorParam { factor: t.factor, texture: t.picture })
    }

    /// A texture; `usage` is its use, unless the texture is marked as raw.
    pub(super) fn texture(&mut self, node: &'n Node, usage: Use, depth: usize) -> Result<Texture, ImportError> {
        if depth > MAX_REFERENCES {
            return Err(node.error("textures go in a circle"));
        }
        match node.plugin.as_str() {
            "bitmap" | "ldrtexture" | "exrtexture" => self.bitmap(node, usage),
            "checkerboard" => self.checkerboard(node),
            "scale" => {
                self.report_unknown(node, &["scale"], &["texture", "rgb", "spectrum"]);
                let factor = match self.property(node, "scale")? {
                    Some(scale) => spectrum::color(scale, Kind::Factor)?,
                    None => Rgb::WHITE,
                };
                let Some(inner) = self.objects(node, "texture")?.first().copied() else {
                    return Err(node.error("there is no texture within the scale texture"));
                };
                let t = self.texture(inner, usage, depth + 1)?;
                Ok(Texture { factor: t.factor * factor, ..t })
            }
            "mesh_attribute" => {
                let factor = self.mesh_attribute(node)?.unwrap_or(Rgb::splat(MID_GREY));
                Ok(Texture { factor, picture: None, channel: None })
            }
            other => {
                self.warn(node, format!("{other} textures are not supported{}; a mid grey stands in", spelling(other)));
                Ok(Texture { factor: Rgb::splat(MID_GREY), picture: None, channel: None })
            }
        }
    }

    fn bitmap(&mut self, node: &'n Node, usage: Use) -> Result<Texture, ImportError> {
        const KNOWN: [&str; 20] = [
            "filename",
            "filter_type",
            "wrap_mode",
            "wrap_mode_u",
            "wrap_mode_v",
            "gamma",
            "raw",
            "channel",
            "uscale",
            "vscale",
            "uvscale",
            "uoffset",
            "voffset",
            "to_uv",
            "cache",
            "max_anisotropy",
            "accel",
            "format",
            "src_gamma",
            "data",
        ];
        self.report_unknown(node, &KNOWN, &[]);
        let Some(path) = node.raw_text("filename").filter(|path| !path.trim().is_empty()) else {
            self.warn(node, "the bitmap names no file; a mid grey stands in");
            return Ok(Texture { factor: Rgb::splat(MID_GREY), picture: None, channel: None });
        };
        let gamma = node.float("gamma")?.unwrap_or(-1.0);
        let raw = node.flag("raw", false) || gamma == 1.0;
        if !raw && gamma != -1.0 && (gamma - 2.2).abs() > 0.3 {
            self.warn(node, format!("gamma {gamma} treated as sRGB"));
        }
        let image = self.a.image(&Source::File(path), if raw { Use::Data } else { usage }, &node.place())?;
        let channel = match node.text("channel").as_deref() {
            None | Some("") => None,
            Some("r" | "x") => Some(0),
            Some("g" | "y") => Some(1),
            Some("b" | "z") => Some(2),
            Some("a") => Some(3),
            Some(other) => {
                self.warn(node, format!("unknown channel {other:?}; red was used"));
                Some(0)
            }
        };
        let Some(image) = image else { return Ok(Texture { factor: Rgb::splat(MID_GREY), picture: None, channel }) };
        let both = node.text("wrap_mode");
        let wrap_u = self.wrap(node, node.text("wrap_mode_u").or(both.clone()));
        let wrap_v = self.wrap(node, node.text("wrap_mode_v").or(both));
        let nearest = node.text("filter_type").is_some_and(|f| f == "nearest");
        let picture = TextureRef {
            image,
            uv_transform: uv_transform(node)?,
            wrap: [wrap_u, wrap_v],
            filter: if nearest { Filter::Nearest } else { Filter::Linear },
        };
        Ok(Texture { factor: Rgb::WHITE, picture: Some(picture), channel })
    }

    fn wrap(&mut self, node: &Node, mode: Option<String>) -> Wrap {
        match mode.as_deref() {
            None | Some("repeat") => Wrap::Repeat,
            Some("clamp") => Wrap::Clamp,
            Some("mirror") => Wrap::Mirror,
            Some(other) => {
                self.warn(node, format!("wrap mode {other:?} treated as clamp"));
                Wrap::Clamp
            }
        }
    }

    /// Two by two squares, baked into a picture of as many texels.
    fn checkerboard(&mut self, node: &'n Node) -> Result<Texture, ImportError> {
        self.report_unknown(node, &["color0", "color1", "uscale", "vscale", "uvscale", "uoffset", "voffset", "to_uv"], &[]);
        let color = |reader: &Self, name: &str, default: f32| -> Result<[f32; 3], ImportError> {
            let property = reader.property(node, name)?.filter(|p| p.tag != "texture");
            let c = property.map_or(Ok(Rgb::splat(default)), |p| spectrum::color(p, Kind::Factor))?;
            Ok([c.r, c.g, c.b])
        };
        let (a, b) = (color(self, "color0", 0.4)?, color(self, "color1", 0.2)?);
        let pixels = Pixels::RgbF32(vec![a, b, b, a]);
        let image = self.a.push_image(Image { name: "checkerboard".into(), width: 2, height: 2, pixels });
        let picture = TextureRef { uv_transform: uv_transform(node)?, filter: Filter::Nearest, ..TextureRef::new(image) };
        Ok(Texture { factor: Rgb::WHITE, picture: Some(picture), channel: None })
    }
}

/// The map of texture coordinates that a texture states, for coordinates with v upward (Mitsuba's point down).
fn uv_transform(node: &Node) -> Result<[[f32; 3]; 2], ImportError> {
    let both = node.float_or("uvscale", 1.0)?;
    let (su, sv) = (node.float_or("uscale", both)?, node.float_or("vscale", both)?);
    let (ou, ov) = (node.float_or("uoffset", 0.0)?, node.float_or("voffset", 0.0)?);
    let mut rows = [[su, 0.0, ou], [0.0, sv, ov]];
    if node.child("to_uv").is_some() {
        let t = transform::of(node, "to_uv")?;
        let m = t.matrix3;
        // A 3×3 matrix keeps its offset in the third column, a 4×4 one in the fourth.
        rows = [[m.x_axis.x, m.y_axis.x, m.z_axis.x + t.translation.x], [m.x_axis.y, m.y_axis.y, m.z_axis.y + t.translation.y]];
    }
    Ok(flip_v_of_transform(rows.map(|row| row.map(|v| v as f32))))
}
