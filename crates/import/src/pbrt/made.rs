//! What has been made of materials, textures and shapes: each is made once and shared by all that refer to it.

use enfilade_math::{DAffine3, Rgb};
use enfilade_scene::{Alpha, Bsdf, ColorParam, Image, NormalMap, TextureRef};

/// What a material scatters, and what it does beside.
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

/// Which channel of which picture, which computation, and the bits of its factors.
pub(super) type BakeKey = (u32, Option<u8>, &'static str, Vec<u32>);

/// A picture, and what of it counts: one channel (3 is alpha) in place of each of the three, or the colour.
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
    /// What counts of a texel, linear; a channel stands in all three places.
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
    /// How many shapes it is to pbrt, which counts each triangle of a mesh as one.
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
