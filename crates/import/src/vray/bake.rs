//! Pictures computed from pictures, each once: complements for opacity and glossiness.

use super::reader::Reader;
use crate::images;
use enfilade_math::Rgb;
use enfilade_scene::{Image, Pixels};

impl Reader<'_, '_> {
    /// The picture of 1 − `factor` × `channel` of another one, or of its colours where no channel is named; not below zero.
    pub(super) fn complement_of(&mut self, image: u32, factor: Rgb, channel: Option<u8>) -> u32 {
        let key = (image, factor.to_array().map(f32::to_bits), channel);
        if let Some(&made) = self.complements.get(&key) {
            return made;
        }
        let source = self.a.image_at(image);
        let texel = |i: usize| {
            let (color, alpha) = source.texel(i % source.width as usize, i / source.width as usize);
            let value = match channel {
                None => color,
                Some(3) => Rgb::splat(alpha),
                Some(c) => Rgb::splat(color[usize::from(c.min(2))]),
            };
            (value * factor).map(|v| (1.0 - v).max(0.0)).to_array()
        };
        let count = source.width as usize * source.height as usize;
        let pixels = match &source.pixels {
            // Numbers of eight bits stay so; colours are linear now and need more.
            Pixels::Rgba8 { .. } if channel.is_some() => {
                let byte = |v: f32| (v.min(1.0) * 255.0).round() as u8;
                let texels = (0..count).map(|i| texel(i).map(byte)).map(|[r, g, b]| [r, g, b, 255]).collect();
                Pixels::Rgba8 { srgb: false, texels }
            }
            _ => Pixels::RgbF32((0..count).map(texel).collect()),
        };
        let name = format!("1 - {}", source.name);
        let (width, height) = (source.width, source.height);
        let made = self.a.push_image(Image { name, width, height, pixels });
        self.complements.insert(key, made);
        made
    }

    /// The mean colour of a picture.
    pub(super) fn mean_of(&self, image: u32) -> Rgb {
        images::mean_color(self.a.image_at(image))
    }
}
