//! The mean of a picture, which replaces a texture that cannot be kept.

use enfilade_math::Rgb;
use enfilade_scene::Image;

/// The mean of a picture's linear colours.
pub(crate) fn mean_color(image: &Image) -> Rgb {
    let [r, g, b, _] = means(image);
    Rgb::new(r, g, b)
}

/// The mean of one channel; 3 is alpha.
pub(crate) fn mean(image: &Image, channel: u8) -> f32 {
    means(image)[usize::from(channel.min(3))]
}

fn means(image: &Image) -> [f32; 4] {
    let (width, count) = (image.width as usize, image.width as usize * image.height as usize);
    let mut sum = [0.0f64; 4];
    for i in 0..count {
        let (color, alpha) = image.texel(i % width, i / width);
        [color.r, color.g, color.b, alpha].iter().zip(&mut sum).for_each(|(&v, sum)| *sum += f64::from(v));
    }
    sum.map(|s| (s / count.max(1) as f64) as f32)
}
