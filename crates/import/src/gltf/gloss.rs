//! `KHR_materials_pbrSpecularGlossiness`: a diffuse colour beneath a reflection of any colour and strength.
//!
//! With f0 the specular colour, m its largest component and x = (1 − cos θ)⁵, the extension reflects f0 + (1 − f0)·x and lets the share
//! 1 − m through to the diffuse colour. Here that is one of these:
//!
//! - a metal of the colour f0, where the diffuse colour is black or m is 1: the same curve;
//! - a dielectric tinted by f0/m, whose index of refraction gives m, where m is no metal's;
//! - else, side by side, a dielectric that reflects 0.04 and a metal of the share w = (m − 0.04)/(1 − 0.04), both tinted by f0/m. For a
//!   grey f0 this is the extension's curve again, (1 − w)·(0.04 + 0.96·x) + w = m + (1 − m)·x, and the diffuse share is 1 − m.

use super::gloss_pictures::Made;
use super::material::Converter;
use crate::ImportError;
use crate::images;
use enfilade_math::{Rgb, srgb_from_linear};
use enfilade_scene::{Bsdf, ColorParam, Image, Pixels, Principled, ScalarParam, TextureRef};
use gltf::json::extensions::material::PbrSpecularGlossiness;

/// Reflectance at normal incidence of the dielectric beside a metal, whose index is 1.5.
const DIELECTRIC: f32 = 0.04;

/// Up to this reflectance at normal incidence a surface is a dielectric; diamond reflects 0.17.
const MAX_DIELECTRIC: f32 = 0.2;

/// Up to this reflectance at normal incidence a surface whose reflectance a picture varies is a dielectric. It is lower, since a tint also
/// dims what dark texels reflect at grazing angles.
const MAX_DIELECTRIC_PICTURE: f32 = 0.08;

/// At most this many texels (8 bytes each) are computed for a scene.
const MAX_TEXELS: usize = 1 << 27;

/// Values in place of a missing picture: reflectance and glossiness of plain plastic.
const MISSING: (f32, f32) = (DIELECTRIC, 0.4);

impl Converter<'_, '_> {
    /// The surface of the extension. `p` has the diffuse colour as its base colour, and further layers.
    pub(super) fn glossy(&mut self, gloss: &PbrSpecularGlossiness, p: Principled) -> Result<Bsdf, ImportError> {
        let own = Principled::default();
        if (p.ior, p.specular, p.specular_color) != (own.ior, own.specular, own.specular_color) {
            self.warn("KHR_materials_ior and KHR_materials_specular have no effect beside KHR_materials_pbrSpecularGlossiness");
        }
        let mut p = Principled { ior: own.ior, specular: own.specular, specular_color: own.specular_color, ..p };
        let mut f0 = Rgb::from(gloss.specular_factor.0).map(|v| v.clamp(0.0, 1.0));
        let mut glossiness = gloss.glossiness_factor.0.clamp(0.0, 1.0);
        let info = gloss.specular_glossiness_texture.as_ref();
        let texture = self.color(Rgb::WHITE, info, 1.0)?.texture;
        if let Some(texture) = texture {
            return Ok(self.pictured(f0, glossiness, texture, p));
        }
        if info.is_some() {
            (f0, glossiness) = (f0 * MISSING.0, glossiness * MISSING.1);
        }
        p.roughness = (1.0 - glossiness).into();
        Ok(uniform(f0, p))
    }

    /// The surface with a picture that multiplies both specular colour and, by its alpha, glossiness.
    fn pictured(&mut self, f0: Rgb, glossiness: f32, texture: TextureRef, mut p: Principled) -> Bsdf {
        let image = self.a.image_at(texture.image);
        let (largest, opaque) = (largest(image, f0), images::is_opaque(image));
        let black = p.base_color.factor.is_black();
        let two_kinds = !black && largest > MAX_DIELECTRIC_PICTURE;
        p.roughness = (1.0 - glossiness).into();
        let made = match opaque && !two_kinds {
            true => None,
            false => match self.made_of(texture.image, f0, glossiness, two_kinds) {
                Some(made) => Some(made),
                None => {
                    let image = self.a.image_at(texture.image);
                    let (mean, alpha) = (images::mean_color(image), images::mean(image, 3));
                    self.warn("there are too many pictures of specular colour and glossiness; the means of this one were used");
                    p.roughness = (1.0 - glossiness * alpha).into();
                    return uniform(mean * f0, p);
                }
            },
        };
        let of = |image: u32| TextureRef { image, ..texture };
        let number = |made: Made, channel: u8| ScalarParam { factor: 1.0, texture: Some((of(made.numbers), channel)) };
        if let Some(made) = made.filter(|_| !opaque) {
            p.roughness = number(made, 1);
        }
        match made.and_then(|made| Some((made, made.tint?))) {
            Some((made, tint)) => side_by_side(ColorParam { factor: Rgb::WHITE, texture: Some(of(tint)) }, number(made, 2), p),
            None if black => metal(ColorParam { factor: f0, texture: Some(texture) }, p),
            None => dielectric(largest, f0, Some(texture), p),
        }
    }

    /// The pictures for a surface, of two kinds or one; `None` when too many were made already.
    fn made_of(&mut self, image: u32, f0: Rgb, glossiness: f32, two_kinds: bool) -> Option<Made> {
        let key = (image, [f0.r, f0.g, f0.b, glossiness].map(f32::to_bits), two_kinds);
        if let Some(&made) = self.made.known.get(&key) {
            return Some(made);
        }
        let source = self.a.image_at(image);
        let (width, height) = (source.width, source.height);
        let texels = width as usize * height as usize;
        if self.made.texels + texels > MAX_TEXELS {
            return None;
        }
        self.made.texels += texels;
        let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0).round() as u8;
        let (mut numbers, mut tints) = (Vec::with_capacity(texels), Vec::new());
        for i in 0..texels {
            let (color, alpha) = source.texel(i % width as usize, i / width as usize);
            let color = color * f0;
            let max = color.max_component();
            numbers.push([0, byte(1.0 - glossiness * alpha), byte(dielectric_share(max)), 255]);
            if two_kinds {
                let [r, g, b] = (color * (1.0 / max.max(DIELECTRIC))).to_array().map(|v| byte(srgb_from_linear(v)));
                tints.push([r, g, b, 255]);
            }
        }
        let name = source.name.clone();
        let mut push = |what: &str, srgb, texels| {
            self.a.push_image(Image { name: format!("{name} ({what})"), width, height, pixels: Pixels::Rgba8 { srgb, texels } })
        };
        let made = Made { numbers: push("roughness, share", false, numbers), tint: two_kinds.then(|| push("tint", true, tints)) };
        self.made.known.insert(key, made);
        Some(made)
    }
}

/// The surface of one specular colour.
fn uniform(f0: Rgb, p: Principled) -> Bsdf {
    let max = f0.max_component();
    if p.base_color.factor.is_black() || max >= 1.0 {
        metal(f0.into(), p)
    } else if max <= MAX_DIELECTRIC {
        dielectric(max, f0, None, p)
    } else {
        side_by_side((f0 * (1.0 / max)).into(), dielectric_share(max).into(), p)
    }
}

/// The share of the dielectric beside a metal where the largest component of the specular colour is `max`.
fn dielectric_share(max: f32) -> f32 {
    ((1.0 - max) / (1.0 - DIELECTRIC)).clamp(0.0, 1.0)
}

fn metal(base_color: ColorParam, p: Principled) -> Bsdf {
    Bsdf::Principled(Box::new(Principled { base_color, metallic: 1.0.into(), ..p }))
}

/// A dielectric that reflects f0 × texture, at most `max`.
fn dielectric(max: f32, f0: Rgb, texture: Option<TextureRef>, mut p: Principled) -> Bsdf {
    if max > 0.0 {
        p.ior = (1.0 + max.sqrt()) / (1.0 - max.sqrt());
        p.specular_color = ColorParam { factor: f0 * (1.0 / max), texture };
    } else {
        p.specular = 0.0.into();
    }
    Bsdf::Principled(Box::new(p))
}

/// A metal and a dielectric of the same tint. The dielectric is the second, which is what remains where only one of them can be kept:
/// it has the diffuse colour.
fn side_by_side(tint: ColorParam, dielectric_share: ScalarParam, p: Principled) -> Bsdf {
    let first = Box::new(metal(tint, p.clone()));
    let second = Box::new(Bsdf::Principled(Box::new(Principled { specular_color: tint, ..p })));
    Bsdf::Blend { first, second, weight: dielectric_share }
}

/// The largest component of all texels of a picture × `factor`.
fn largest(image: &Image, factor: Rgb) -> f32 {
    let (width, texels) = (image.width as usize, image.width as usize * image.height as usize);
    (0..texels).map(|i| (image.texel(i % width, i / width).0 * factor).max_component()).fold(0.0, f32::max).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dielectric_and_metal_side_by_side_follow_the_curve_of_the_extension() {
        for m in [0.04f32, 0.3, 0.7, 1.0] {
            let w = 1.0 - dielectric_share(m);
            for x in [0.0f32, 0.1, 1.0] {
                let both = (1.0 - w) * (DIELECTRIC + (1.0 - DIELECTRIC) * x) + w;
                assert!((both - (m + (1.0 - m) * x)).abs() < 1e-6, "{m} {x}");
            }
            assert!(((1.0 - w) * (1.0 - DIELECTRIC) - (1.0 - m)).abs() < 1e-6, "{m}");
        }
    }

    #[test]
    fn the_index_of_refraction_gives_the_reflectance_back() {
        let Bsdf::Principled(p) = uniform(Rgb::new(0.1, 0.05, 0.0), Principled::default()) else { panic!("not one surface") };
        assert!((((p.ior - 1.0) / (p.ior + 1.0)).powi(2) - 0.1).abs() < 1e-6, "{}", p.ior);
        assert!((p.specular_color.factor.g - 0.5).abs() < 1e-6);
        let Bsdf::Principled(p) = uniform(Rgb::BLACK, Principled::default()) else { panic!("not one surface") };
        assert_eq!((p.specular.factor, p.ior), (0.0, 1.5));
    }
}
