//! Textures read through a footprint: mip pyramids, and the ray cones that determine how coarse a lookup may be.
//!
//! Level 0 is the scene's own picture. The others are built here, each texel the mean of the linear values that it covers, so that
//! every level has the picture's mean: pictures of eight bits get levels of sixteen linear bits (a rounding of 8·10⁻⁶), others floats.
//! Williams 1983, "Pyramidal Parametrics"; Akenine-Möller et al. 2019 and 2021 for the cones.

mod cone;
mod pyramid;

pub(crate) use cone::{Cone, Footprint};

use enfilade_math::{Rgb, Vec2};
use enfilade_scene::{Alpha, ColorParam, Image, Material, ScalarParam, TextureRef};
use pyramid::Pyramid;
use std::sync::Arc;

/// The pictures of a scene, ready to be read.
#[derive(Debug, Default)]
pub(crate) struct Textures<'s> {
    pyramids: Vec<Pyramid<'s>>,
}

impl<'s> Textures<'s> {
    /// Builds the pyramids of the pictures that `materials` use.
    pub fn new(images: &'s [Arc<Image>], materials: &[Material]) -> Self {
        let mut uses = vec![Use::Unused; images.len()];
        for material in materials {
            material.textures(|t| uses[t.image as usize] = uses[t.image as usize].max(Use::Texture));
        }
        for material in materials {
            if let Alpha::Mask { opacity, .. } | Alpha::Blend { opacity } = &material.alpha
                && let Some((t, 3)) = &opacity.texture
            {
                uses[t.image as usize] = Use::CutOut;
            }
        }
        let pyramid = |index: usize| match uses[index] {
            Use::Unused => Pyramid::single(&images[index]),
            Use::Texture => Pyramid::new(&images[index], false),
            Use::CutOut => Pyramid::new(&images[index], true),
        };
        Self { pyramids: enfilade_parallel::map_up_to(images.len(), pyramid) }
    }

    /// Linear RGB and alpha of `texture` around `uv`.
    #[inline]
    pub fn sample(&self, texture: &TextureRef, uv: Vec2, footprint: &Footprint) -> (Rgb, f32) {
        let [r, g, b, a] = self.pyramids[texture.image as usize].sample(texture, uv, footprint).to_array();
        (Rgb::new(r, g, b), a)
    }

    /// A colour parameter around `uv`.
    #[inline]
    pub fn color(&self, p: &ColorParam, uv: Vec2, footprint: &Footprint) -> Rgb {
        match &p.texture {
            Some(t) => p.factor * self.sample(t, uv, footprint).0,
            None => p.factor,
        }
    }

    /// A scalar parameter around `uv`.
    #[inline]
    pub fn scalar(&self, p: &ScalarParam, uv: Vec2, footprint: &Footprint) -> f32 {
        match &p.texture {
            Some((t, channel)) if p.factor != 0.0 => {
                let (rgb, alpha) = self.sample(t, uv, footprint);
                p.factor * if *channel == 3 { alpha } else { rgb[usize::from(*channel)] }
            }
            _ => p.factor,
        }
    }

    /// Slope of the luminance of `texture` around `uv`: derivatives by u and v.
    #[inline]
    pub fn slope(&self, texture: &TextureRef, uv: Vec2, footprint: &Footprint) -> Vec2 {
        let by_texture = self.pyramids[texture.image as usize].slope(texture, uv, footprint);
        let m = texture.uv_transform;
        Vec2::new(by_texture.x * m[0][0] + by_texture.y * m[1][0], by_texture.x * m[0][1] + by_texture.y * m[1][1])
    }
}

/// Use of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Use {
    /// Nothing that is read through a footprint.
    Unused,
    /// A texture.
    Texture,
    /// A texture whose alpha cuts out the surface: colours are weighted by it.
    CutOut,
}
