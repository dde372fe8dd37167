//! Variation of a surface's colours by its textures: a number per part, used to find views with visible detail.

use crate::{Image, Parameter, Pixels, Scene};
use enfilade_math::Rgb;

/// Texels of an image that are looked at, at most.
const TEXELS: usize = 4096;

/// RMS contrast of every part's colours: the standard deviation of their luminance over its mean (Peli 1990, "Contrast in complex
/// images"). 0 for a part of one colour; of several coloured textures the one that varies most counts.
pub(crate) fn of_parts(scene: &Scene) -> Vec<f32> {
    let of_images: Vec<f32> = scene.images.iter().map(|image| of_image(image)).collect();
    let of_materials: Vec<f32> = scene
        .materials
        .iter()
        .map(|material| {
            let mut max = 0.0f32;
            material.bsdf.parameters(&mut |parameter| {
                if let Parameter::Color(color) = parameter
                    && let Some(texture) = color.texture
                {
                    max = max.max(of_images.get(texture.image as usize).copied().unwrap_or(0.0));
                }
            });
            max
        })
        .collect();
    scene.parts.iter().map(|part| of_materials.get(part.material as usize).copied().unwrap_or(0.0)).collect()
}

fn of_image(image: &Image) -> f32 {
    let luminance = |at: usize| match &image.pixels {
        Pixels::Rgba8 { texels, srgb } => {
            let [r, g, b, _] = texels[at];
            let linear = || Rgb::new(f32::from(r), f32::from(g), f32::from(b)) / 255.0;
            if *srgb { Rgb::from_srgb8([r, g, b]).luminance() } else { linear().luminance() }
        }
        Pixels::RgbF32(texels) => Rgb::from(texels[at]).luminance(),
    };
    let len = match &image.pixels {
        Pixels::Rgba8 { texels, .. } => texels.len(),
        Pixels::RgbF32(texels) => texels.len(),
    };
    // Spread over the image by the golden ratio, so that no pattern of rows or columns is missed.
    let count = len.min(TEXELS);
    let step = |k: usize| ((k as f64 * 0.618_033_988_749_894_9).fract() * len as f64) as usize;
    let values = (0..count).map(|k| f64::from(luminance(step(k).min(len - 1))));
    let (sum, squares) = values.fold((0.0, 0.0), |(sum, squares), v| (sum + v, squares + v * v));
    if sum <= 0.0 {
        return 0.0;
    }
    let mean = sum / count as f64;
    ((squares / count as f64 - mean * mean).max(0.0).sqrt() / mean) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(texels: Vec<[u8; 4]>) -> Image {
        Image { name: "test".into(), width: 64, height: 64, pixels: Pixels::Rgba8 { srgb: true, texels } }
    }

    #[test]
    fn a_chequerboard_of_black_and_white_has_contrast_one_and_one_colour_none() {
        let board = (0..64 * 64).map(|i| if (i + i / 64) % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] }).collect();
        assert!((of_image(&image(board)) - 1.0).abs() < 0.05);
        assert!(of_image(&image(vec![[90, 120, 30, 255]; 64 * 64])) < 1e-3);
        assert_eq!(of_image(&image(vec![[0; 4]; 64 * 64])), 0.0);
    }
}
