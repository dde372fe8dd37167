//! Masks: the opacity of a surface.

use super::bsdf::Surface;
use super::reader::Reader;
use super::spectrum;
use super::xml::Node;
use crate::ImportError;
use crate::images::{self, Use};
use crate::spectrum::Kind;
use enfilade_scene::{Alpha, ScalarParam};

/// The channel of alpha.
const ALPHA: u8 = 3;

impl<'n> Reader<'n, '_> {
    pub(super) fn mask(&mut self, node: &'n Node, depth: usize) -> Result<Surface, ImportError> {
        self.report_unknown(node, &["opacity"], &["bsdf"]);
        let mut surface = self.inner(node, depth)?;
        let opacity = match self.property(node, "opacity")? {
            Some(texture) if texture.tag == "texture" => self.opacity(texture)?,
            Some(value) => spectrum::color(value, Kind::Factor)?.luminance().into(),
            None => 0.5.into(),
        };
        if opacity.texture.is_some() || opacity.factor < 1.0 {
            surface.alpha = Alpha::Blend { opacity };
        }
        Ok(surface)
    }

    /// The opacity that a texture states. Where it names no channel, Mitsuba takes its colours. Files of version 0.x were exported for
    /// renderers that take the alpha, where that cuts something out.
    fn opacity(&mut self, node: &'n Node) -> Result<ScalarParam, ImportError> {
        let t = self.texture(node, Use::Color, 0)?;
        let Some(picture) = t.picture else {
            let opacity = if node.plugin == "mesh_attribute" { t.factor.luminance().clamp(0.0, 1.0) } else { 1.0 };
            return Ok(opacity.into());
        };
        if t.channel.is_none() && images::cuts_out(self.a.image_at(picture.image)) {
            if self.version < 2 {
                return Ok(ScalarParam { factor: t.factor.r, texture: Some((picture, ALPHA)) });
            }
            self.warn(node, "the picture's alpha cuts something out, but Mitsuba takes its colours for the opacity; so they were");
        }
        Ok(self.as_number(t))
    }
}
