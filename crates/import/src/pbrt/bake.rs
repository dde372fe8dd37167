//! Pictures made of pictures, where pbrt computes what a scene's textures cannot.

use super::Reader;
use enfilade_math::Rgb;
use enfilade_scene::{Image, Pixels, ScalarParam, TextureRef};

/// Pictures may be computed up to so many texels (12 bytes each) in all.
const MAX_BAKED: usize = 1 << 28;

/// Which picture, which computation, and the bits of its factors.
pub(super) type Key = (u32, &'static str, Vec<u32>);

impl Reader<'_> {
    /// `picture` with every texel's linear colour replaced by `f` of it; as it is, with a warning, when too much was computed already.
    ///
    /// `what` and `factors` tell computations apart: pictures that agree in them are computed once.
    pub(super) fn baked(&mut self, picture: TextureRef, what: &'static str, factors: &[f32], f: impl Fn(Rgb) -> Rgb) -> TextureRef {
        let key = (picture.image, what, factors.iter().map(|v| v.to_bits()).collect::<Vec<_>>());
        if let Some(&image) = self.baked.get(&key) {
            return TextureRef { image, ..picture };
        }
        let source = self.a.image_at(picture.image);
        self.baked_texels += source.width as usize * source.height as usize;
        if self.baked_texels > MAX_BAKED {
            let place = format!("texture {}", source.name);
            self.a.warn(place, format!("too many pictures to compute ({what}); it was used as it is"));
            return picture;
        }
        let texels = (0..source.height as usize).flat_map(|y| (0..source.width as usize).map(move |x| (x, y)));
        let texels = texels.map(|(x, y)| f(source.texel(x, y).0).to_array()).collect();
        let name = format!("{} ({what})", source.name);
        let image = Image { name, width: source.width, height: source.height, pixels: Pixels::RgbF32(texels) };
        let image = self.a.push_image(image);
        self.baked.insert(key, image);
        TextureRef { image, ..picture }
    }

    /// A number put through `f`, texel by texel where it has a texture.
    pub(super) fn mapped(&mut self, value: ScalarParam, what: &'static str, f: impl Fn(f32) -> f32) -> ScalarParam {
        let Some((picture, channel)) = value.texture else { return f(value.factor).into() };
        let baked = self.baked(picture, what, &[value.factor, f32::from(channel)], |c| {
            Rgb::splat(f(value.factor * c.to_array()[usize::from(channel.min(2))]))
        });
        ScalarParam { factor: 1.0, texture: Some((baked, 0)) }
    }

    /// The mean of a picture's linear colours.
    pub(super) fn mean(&self, picture: TextureRef) -> Rgb {
        let image = self.a.image_at(picture.image);
        let mut sum = [0.0f64; 3];
        for (x, y) in (0..image.height as usize).flat_map(|y| (0..image.width as usize).map(move |x| (x, y))) {
            let texel = image.texel(x, y).0.to_array();
            (0..3).for_each(|i| sum[i] += f64::from(texel[i]));
        }
        let count = f64::from(image.width) * f64::from(image.height);
        let [r, g, b] = sum.map(|s| (s / count) as f32);
        Rgb::new(r, g, b)
    }
}
