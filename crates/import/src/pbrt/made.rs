//! Converted materials, textures and shapes: each is converted once and shared by all that refer to it.

use enfilade_math::{DAffine3, Rgb};
use enfilade_scene::{Alpha, Bsdf, ColorParam, Image, NormalMap, TextureRef};

/// A converted material: its scattering, opacity and normals.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    /// `None` for `none` and `interface`, which scatter nothing.
    pub bsdf: Option<Bsdf>,
    pub alpha: Alpha,
    pub normal_map: Option<NormalMap>,
}

impl From<Bsdf> for Surface {
    fn from(bsdf: Bsdf) -> Self {
        Self { bsdf: Some(bsdf), alpha: Alpha::Opaque, normal_map: None }
    }
}

/// The light of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Emission {
    pub radiance: ColorParam,
    pub both_sides: bool,
}

/// A texture as this workspace knows it: a factor and a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Texture {
    pub factor: Rgb,
    pub picture: Option<Picture>,
}

impl From<Rgb> for Texture {
    fn from(factor: Rgb) -> Self {
        Self { factor, picture: None }
    }
}

/// Key of a computed picture: picture, channel, computation, and the bits of its factors.
pub(super) type BakeKey = (u32, Option<u8>, &'static str, Vec<u32>);

/// A picture, and the part of it that is used: one channel (3 is alpha) in place of all three, or the colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Picture {
    pub texture: TextureRef,
    pub channel: Option<u8>,
}

impl From<TextureRef> for Picture {
    fn from(texture: TextureRef) -> Self {
        Self { texture, channel: None }
    }
}

impl Picture {
    /// The used part of a texel, linear; a single channel is repeated three times.
    pub(super) fn texel(self, image: &Image, x: usize, y: usize) -> Rgb {
        let (color, alpha) = image.texel(x, y);
        match self.channel {
            None => color,
            Some(channel) => Rgb::splat(color.to_array().get(usize::from(channel)).copied().unwrap_or(alpha)),
        }
    }
}

/// A mesh that shapes share.
#[derive(Clone, Copy)]
pub(super) struct Shape {
    pub mesh: u32,
    /// Number of shapes by pbrt's count, where each triangle of a mesh is one.
    pub pieces: usize,
    pub has_uvs: bool,
}

/// A shape of an object, in the object's space.
#[derive(Clone)]
pub(super) struct Placed {
    pub name: String,
    pub mesh: u32,
    pub material: u32,
    pub object_from_mesh: DAffine3,
}
