//! Another colour for a material: its textures stay, so that grain, weave and pattern do, and the factor over them changes.
//!
//! The factor brings the mean of the texture to the new colour, channel by channel. It is lowered where more than one texel in a hundred
//! would reflect more than [`MOST`], and channels of a texture are never raised so far above the others that faint noise of a channel
//! would become colour.

use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, Image, Material};
use std::sync::Arc;

/// Reflectance of soot, which no surface stays below.
pub const LEAST: f32 = 0.02;
/// Reflectance of fresh snow, which no surface exceeds.
pub const MOST: f32 = 0.9;
/// Most by which the factor of one channel may exceed that of another.
const SPREAD: f32 = 12.0;
/// Texels of a picture that are looked at, at most.
const TEXELS: usize = 4096;
/// Steps of a sequence that is spread evenly over the square, so that no pattern of rows, columns or tiles is missed: powers of the
/// reciprocal of 1.3247 (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
const PLACES: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053_3];
/// Share of the texels that may be brighter than [`MOST`].
const BRIGHTEST: f64 = 0.99;

/// The reflectances of a colour's texture: mean, and the bright end of each channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Albedo {
    pub mean: Rgb,
    pub bright: Rgb,
}

impl Albedo {
    /// Of a parameter. `is_cut` says that the alpha of its picture is opacity; elsewhere it may be anything, such as roughness.
    pub fn of(param: &ColorParam, images: &[Arc<Image>], is_cut: bool) -> Self {
        let texture =
            param.texture.map_or(Self { mean: Rgb::WHITE, bright: Rgb::WHITE }, |t| Self::of_image(&images[t.image as usize], is_cut));
        Self { mean: texture.mean * param.factor, bright: texture.bright * param.factor }
    }

    fn of_image(image: &Image, is_cut: bool) -> Self {
        let [width, height] = [image.width, image.height].map(|side| side as usize);
        let at = |k: usize, step: f64, side: usize| (((k as f64 * step).fract() * side as f64) as usize).min(side - 1);
        let texels: Vec<(Rgb, f32)> = if width * height <= TEXELS {
            (0..width * height).map(|k| image.texel(k % width, k / width)).collect()
        } else {
            (0..TEXELS).map(|k| image.texel(at(k, PLACES[0], width), at(k, PLACES[1], height))).collect()
        };
        // What is cut out does not count.
        let there: Vec<Rgb> = texels.iter().filter(|(_, alpha)| !is_cut || *alpha > 0.5).map(|(rgb, _)| *rgb).collect();
        let seen = if there.is_empty() { texels.iter().map(|(rgb, _)| *rgb).collect() } else { there };
        let mean = seen.iter().copied().sum::<Rgb>() / seen.len() as f32;
        let bright = |channel: usize| {
            let mut values: Vec<f32> = seen.iter().map(|rgb| rgb[channel]).collect();
            values.sort_by(f32::total_cmp);
            values[((values.len() - 1) as f64 * BRIGHTEST) as usize]
        };
        Self { mean, bright: Rgb::new(bright(0), bright(1), bright(2)) }
    }
}

/// The colour that a material's surface has before and after.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recolored {
    pub from: Rgb,
    pub to: Rgb,
}

/// The colour parameters of a surface that say what colour it is: none of metal, glass and what light passes.
pub fn base_colors(bsdf: &mut Bsdf) -> Vec<&mut ColorParam> {
    match bsdf {
        Bsdf::Diffuse { reflectance } | Bsdf::RoughDiffuse { reflectance, .. } => vec![reflectance],
        Bsdf::Plastic { diffuse, .. } => vec![diffuse],
        Bsdf::Principled(p) if p.metallic.factor < 0.5 && p.transmission.factor == 0.0 => vec![&mut p.base_color],
        Bsdf::Disney(p) if p.metallic.factor < 0.5 && p.spec_trans.factor == 0.0 => vec![&mut p.base_color],
        Bsdf::Blend { first, second, .. } => {
            let mut colors = base_colors(first);
            colors.extend(base_colors(second));
            colors
        }
        _ => Vec::new(),
    }
}

/// Whether a picture decides where a material is there.
pub fn is_cut(material: &Material) -> bool {
    match &material.alpha {
        Alpha::Opaque => false,
        Alpha::Mask { opacity, .. } | Alpha::Blend { opacity } => opacity.texture.is_some(),
    }
}

/// Gives a colour parameter the mean `target`, as nearly as reflectances and its texture allow; returns the means. `is_cut` as in
/// [`Albedo::of`].
pub fn recolor(param: &mut ColorParam, images: &[Arc<Image>], is_cut: bool, target: Rgb) -> Recolored {
    let before = Albedo::of(param, images, is_cut);
    let target = target.map(|channel| channel.clamp(LEAST, MOST));
    let channel = |c: usize| target[c] / before.mean[c].max(1e-3);
    let mut gain = Rgb::new(channel(0), channel(1), channel(2));
    if param.texture.is_some() {
        let least = gain.r.min(gain.g).min(gain.b);
        gain = gain.map(|g| g.min(SPREAD * least));
    }
    let brightest = (before.bright * gain).max_component();
    if brightest > MOST {
        gain *= MOST / brightest;
    }
    param.factor *= gain;
    Recolored { from: before.mean, to: before.mean * gain }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::{Pixels, TextureRef};

    fn picture(texels: Vec<[f32; 3]>) -> Arc<Image> {
        Image { name: "t".into(), width: texels.len() as u32, height: 1, pixels: Pixels::RgbF32(texels) }.into()
    }

    #[test]
    fn the_mean_becomes_the_colour_and_the_texture_keeps_its_contrast() {
        let images = [picture(vec![[0.2, 0.1, 0.05], [0.4, 0.2, 0.1]])];
        let mut param = ColorParam { factor: Rgb::WHITE, texture: Some(TextureRef::new(0)) };
        let Recolored { from, to } = recolor(&mut param, &images, false, Rgb::new(0.15, 0.12, 0.1));
        assert!((from.r - 0.3).abs() < 1e-5 && (to.r - 0.15).abs() < 1e-5 && (to.b - 0.1).abs() < 1e-5, "{from:?} {to:?}");
        assert!((Albedo::of(&param, &images, false).mean.g - 0.12).abs() < 1e-5);
        let mut plain = ColorParam::from(Rgb::splat(0.5));
        recolor(&mut plain, &[], false, Rgb::new(0.7, 0.001, 2.0));
        assert!((0..3).all(|c| (plain.factor[c] - [0.7, 0.02, 0.9][c]).abs() < 1e-4), "{:?}", plain.factor);
    }

    #[test]
    fn the_mean_of_checkers_is_that_of_both_colours() {
        for cells in [2, 4, 6, 8, 64] {
            let side = 1024;
            let texel = |k: usize| if (k % side * cells / side + k / side * cells / side).is_multiple_of(2) { [0.8; 3] } else { [0.2; 3] };
            let pixels = Pixels::RgbF32((0..side * side).map(texel).collect());
            let image = Image { name: "checkers".into(), width: side as u32, height: side as u32, pixels };
            let mean = Albedo::of_image(&image, false).mean;
            assert!((mean.g - 0.5).abs() < 0.01, "{cells}: {mean:?}");
        }
    }

    #[test]
    fn what_is_cut_out_does_not_count_but_roughness_in_the_same_place_does_not_matter() {
        let pixels = Pixels::Rgba8 { srgb: false, texels: vec![[51, 51, 51, 255], [255, 255, 255, 60]] };
        let image = Image { name: "leaf".into(), width: 2, height: 1, pixels };
        let mean = |is_cut| Albedo::of_image(&image, is_cut).mean.g;
        assert!((mean(true) - 0.2).abs() < 1e-5 && (mean(false) - 0.6).abs() < 1e-5, "{} {}", mean(true), mean(false));
    }

    #[test]
    fn nothing_reflects_more_than_it_may() {
        let images = [picture(vec![[0.05, 0.05, 0.05], [0.8, 0.8, 0.8]])];
        for target in [Rgb::splat(0.9), Rgb::new(0.9, 0.3, 0.1), Rgb::splat(5.0)] {
            let mut param = ColorParam { factor: Rgb::WHITE, texture: Some(TextureRef::new(0)) };
            recolor(&mut param, &images, false, target);
            assert!(Albedo::of(&param, &images, false).bright.max_component() <= MOST + 1e-4, "{:?}", param.factor);
        }
    }
}
