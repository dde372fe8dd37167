//! Pictures made of pictures, where pbrt computes what a scene's textures cannot.

use super::made::Picture;
use super::reader::Reader;
use super::version::Version;
use crate::images;
use enfilade_math::{Rgb, linear_from_srgb, srgb_from_linear};
use enfilade_scene::{Image, Pixels, ScalarParam, TextureRef};

/// At most this many texels (12 bytes each) are computed for a scene.
const MAX_BAKED: usize = 1 << 28;

impl Reader<'_> {
    /// `picture` with what counts of every texel, linear, replaced by `f` of it; as it is, with a warning, when too much was computed
    /// already.
    ///
    /// `what` and `factors` identify the computation: a picture is computed once for each.
    pub(super) fn baked(&mut self, picture: Picture, what: &'static str, factors: &[f32], f: impl Fn(Rgb) -> Rgb) -> Picture {
        let key = (picture.texture.image, picture.channel, what, factors.iter().map(|v| v.to_bits()).collect::<Vec<_>>());
        if let Some(&image) = self.baked.get(&key) {
            return TextureRef { image, ..picture.texture }.into();
        }
        let source = self.a.image_at(picture.texture.image);
        self.baked_texels += source.width as usize * source.height as usize;
        if self.baked_texels > MAX_BAKED {
            let place = format!("texture {}", source.name);
            self.a.warn(place, format!("too many pictures to compute ({what}); it was used as it is"));
            return picture;
        }
        let texels = (0..source.height as usize).flat_map(|y| (0..source.width as usize).map(move |x| (x, y)));
        let texels = texels.map(|(x, y)| f(picture.texel(source, x, y)).to_array()).collect();
        let name = format!("{} ({what})", source.name);
        let image = Image { name, width: source.width, height: source.height, pixels: Pixels::RgbF32(texels) };
        let image = self.a.push_image(image);
        self.baked.insert(key, image);
        TextureRef { image, ..picture.texture }.into()
    }

    /// A picture as a texture of numbers: in version 4 by its alpha where that is not one everywhere, else by the mean of its channels
    /// (`MIPMap::CreateFromFile` and `MIPMap::Bilerp<Float>`); in version 3 by the luminance of its encoded colours
    /// (`ImageTexture::convertIn`).
    pub(super) fn as_number(&mut self, texture: TextureRef) -> Picture {
        let image = self.a.image_at(texture.image);
        if self.version == Version::V4 && !images::is_opaque(image) {
            return Picture { texture, channel: Some(3) };
        }
        if images::is_grey(image) {
            return texture.into();
        }
        let encoded = matches!(image.pixels, Pixels::Rgba8 { srgb: true, .. });
        match self.version {
            Version::V3 if encoded => {
                let luminance = |c: Rgb| linear_from_srgb(c.map(srgb_from_linear).luminance());
                self.baked(texture.into(), "luminance", &[], |c| Rgb::splat(luminance(c)))
            }
            Version::V3 => self.baked(texture.into(), "luminance", &[], |c| Rgb::splat(c.luminance())),
            Version::V4 => self.baked(texture.into(), "mean of its channels", &[], |c| Rgb::splat((c.r + c.g + c.b) / 3.0)),
        }
    }

    /// A picture where a colour is wanted: grey where a number is all that counts of it.
    pub(super) fn as_color(&mut self, picture: Picture) -> TextureRef {
        match picture.channel {
            None => picture.texture,
            Some(_) => self.baked(picture, "number", &[], |c| c).texture,
        }
    }

    /// A number put through `f`, texel by texel where it has a texture.
    pub(super) fn mapped(&mut self, value: ScalarParam, what: &'static str, f: impl Fn(f32) -> f32) -> ScalarParam {
        let Some((texture, channel)) = value.texture else { return f(value.factor).into() };
        let picture = Picture { texture, channel: Some(channel) };
        let baked = self.baked(picture, what, &[value.factor], |c| Rgb::splat(f(value.factor * c.r)));
        ScalarParam { factor: 1.0, texture: Some((baked.texture, baked.channel.unwrap_or(0))) }
    }

    /// The mean of what counts of a picture, linear.
    pub(super) fn mean(&self, picture: Picture) -> Rgb {
        let image = self.a.image_at(picture.texture.image);
        let mut sum = [0.0f64; 3];
        for (x, y) in (0..image.height as usize).flat_map(|y| (0..image.width as usize).map(move |x| (x, y))) {
            let texel = picture.texel(image, x, y).to_array();
            (0..3).for_each(|i| sum[i] += f64::from(texel[i]));
        }
        let count = f64::from(image.width) * f64::from(image.height);
        let [r, g, b] = sum.map(|s| (s / count) as f32);
        Rgb::new(r, g, b)
    }
}
