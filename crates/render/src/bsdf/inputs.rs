//! Values of a material's parameters at one surface point.

use super::Tables;
use crate::texture::{Footprint, Textures};
use enfilade_math::{Rgb, Vec2};
use enfilade_scene::{ColorParam, ScalarParam};

/// Everything needed to evaluate a material's parameters at a point.
#[derive(Clone, Copy)]
pub struct Inputs<'a> {
    /// The scene's pictures.
    pub textures: &'a Textures<'a>,
    /// Texture coordinates of the point.
    pub uv: Vec2,
    /// How much of a texture counts.
    pub footprint: Footprint,
    /// The material's tables.
    pub tables: &'a Tables,
    /// Cosine of the viewing direction, > 0.
    pub cos_o: f32,
    /// True when `wo` is on the side that outward normals point to.
    pub outside: bool,
}

impl Inputs<'_> {
    /// A colour parameter here, on [0,1].
    #[inline]
    pub(super) fn reflectance(&self, p: &ColorParam) -> Rgb {
        self.textures.color(p, self.uv, &self.footprint).map(|v| v.clamp(0.0, 1.0))
    }

    /// A scalar parameter here.
    #[inline]
    pub(super) fn scalar(&self, p: &ScalarParam) -> f32 {
        self.textures.scalar(p, self.uv, &self.footprint)
    }

    /// A scalar parameter here, on [0,1].
    #[inline]
    pub(super) fn unit_scalar(&self, p: &ScalarParam) -> f32 {
        self.scalar(p).clamp(0.0, 1.0)
    }
}
