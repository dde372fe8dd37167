//! Cloth. Most of it is a rough diffuse surface; velvet and terry add the sheen of their fibres.

use super::wall::lightened;
use super::{Layers, Maker, rough};
use crate::palette::COTTON;
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, Material, Principled};
use enfilade_textures::{self as texture, Pattern, RugStyle, Weave};

/// Colours of clothes besides the palette's: denim, black, white, grey, camel, navy, olive, wine.
const CLOTHES: [Rgb; 8] = [
    Rgb::new(0.075, 0.12, 0.22),
    Rgb::new(0.022, 0.022, 0.024),
    Rgb::new(0.72, 0.715, 0.70),
    Rgb::new(0.24, 0.24, 0.245),
    Rgb::new(0.40, 0.27, 0.15),
    Rgb::new(0.025, 0.035, 0.075),
    Rgb::new(0.12, 0.125, 0.06),
    Rgb::new(0.16, 0.025, 0.035),
];

/// One over the mean of a woven picture: colours are raised by it, so that the cloth has them on average.
const WOVEN: f32 = 1.16;

impl Maker<'_> {
    /// Upholstery: about four threads to the centimetre, heathered.
    pub(super) fn upholstery(&mut self, name: &str, color: Rgb) -> Material {
        let layers =
            self.skin("upholstery weave", &(), [0.26, 0.26], |seed| texture::weave("upholstery weave", Weave::Plain, 128, 0.8, seed));
        cloth(name, layers, lightened(color, WOVEN), 0.000_8)
    }

    /// Linen: ten threads to the centimetre, with slubs.
    pub(super) fn linen(&mut self, name: &str, color: Rgb) -> Material {
        let layers = self.skin("linen weave", &(), [0.14, 0.14], |seed| texture::weave("linen weave", Weave::Plain, 128, 1.0, seed));
        cloth(name, layers, lightened(color, WOVEN), 0.000_35)
    }

    /// Thin white cloth: half of it is holes.
    pub(super) fn sheer(&mut self) -> Material {
        let material = self.linen("sheer curtain", Rgb::splat(0.78));
        Material { alpha: Alpha::Blend { opacity: 0.55.into() }, ..material }
    }

    pub(super) fn rug(&mut self) -> Material {
        let [ground, figure] = self.palette().rug;
        let style = [RugStyle::Lattice, RugStyle::Bordered, RugStyle::Stripes][self.seed("rug style", &(ground, figure)) as usize % 3];
        let rug = self.picture("rug", &(ground, figure), [1.0, 1.0], |seed| texture::rug("rug", style, ground, figure, seed));
        rough("rug wool", rug.tinted(Rgb::WHITE), 1.0)
    }

    pub(super) fn knitted(&mut self, color: Rgb) -> Material {
        let layers = self.skin("knit", &(), [0.30, 0.30], |seed| texture::knit("knit", 24, seed));
        cloth("knitted wool", layers, lightened(color, 1.2), 0.003)
    }

    pub(super) fn boucle(&mut self) -> Material {
        let color = self.palette().curtain;
        let layers = self.skin("boucle", &(), [0.26, 0.26], |seed| texture::loops("boucle", 46, 1.6, seed));
        cloth("boucle", layers, lightened(color, 1.15), 0.004)
    }

    /// A dark pile whose fibres shine where they are seen from the side.
    pub(super) fn velvet(&mut self) -> Material {
        let color = self.palette().armchair;
        let layers = self.skin("velvet pile", &(), [0.7, 0.7], |seed| texture::pile("velvet pile", seed));
        layers.relieved(sheen("velvet", layers, color * 0.55, color.lerp(Rgb::splat(0.5), 0.2), 0.32), 0.001)
    }

    pub(super) fn bed_linen(&mut self, i: u8) -> Material {
        let palette = self.palette();
        let [ground, figure] = palette.linen;
        // The sheet is plain, the duvet patterned, the pillow cases take up one or the other, the bedspread is plain in the figure's colour.
        let (pattern, colors) = match i % 4 {
            0 => (Pattern::Plain, [COTTON; 2]),
            1 => (palette.linen_pattern, [ground, figure]),
            2 if palette.linen_pattern == Pattern::Plain => (Pattern::Plain, [COTTON; 2]),
            2 => (palette.linen_pattern, [ground, figure]),
            _ => (Pattern::Plain, [palette.accents[0].lerp(palette.art[3], 0.5); 2]),
        };
        let layers = self.skin("bed linen", &(pattern, colors), [0.48, 0.48], |seed| texture::cotton("bed linen", pattern, colors, seed));
        cloth("bed linen", layers, Rgb::WHITE, 0.001)
    }

    pub(super) fn mattress(&mut self) -> Material {
        let colors = [Rgb::new(0.72, 0.715, 0.70), Rgb::new(0.50, 0.54, 0.60)];
        let layers = self.skin("ticking", &(), [0.48, 0.48], |seed| texture::cotton("ticking", Pattern::PinStripes, colors, seed));
        cloth("mattress ticking", layers, Rgb::WHITE, 0.000_8)
    }

    pub(super) fn towel(&mut self, i: u8) -> Material {
        let palette = self.palette();
        let color = [COTTON, palette.accents[0], palette.art[3], palette.accents[2]][usize::from(i) % 4];
        let layers = self.skin("terry loops", &(), [0.16, 0.16], |seed| texture::loops("terry loops", 90, 0.8, seed));
        layers.relieved(sheen("terry", layers, lightened(color, 1.12), color * 0.15, 0.6), 0.002)
    }

    pub(super) fn clothes(&mut self, i: u8) -> Material {
        let palette = self.palette();
        let (i, kind) = (usize::from(i), usize::from(i) % 3);
        let color =
            if i % 12 < 8 { CLOTHES[i % 12] } else { [palette.accents[0], palette.art[3], palette.accents[1], palette.armchair][i % 4] };
        let layers = match kind {
            0 => self.skin("twill", &(), [0.10, 0.10], |seed| texture::weave("twill", Weave::Twill, 128, 0.7, seed)),
            1 => self.skin("jersey", &(), [0.09, 0.09], |seed| texture::knit("jersey", 48, seed)),
            _ => self.skin("herringbone cloth", &(), [0.16, 0.16], |seed| {
                texture::weave("herringbone cloth", Weave::Herringbone, 128, 0.6, seed)
            }),
        };
        cloth("clothes", layers, lightened(color, WOVEN), 0.000_3)
    }

    pub(super) fn felt(&mut self, name: &'static str, coarse: i32, covers: f32, color: Rgb, depth: f32) -> Material {
        let layers = self.skin(name, &(), [covers, covers], |seed| texture::felt(name, coarse, seed));
        cloth(name, layers, lightened(color, 1.2), depth)
    }
}

fn cloth(name: &str, layers: Layers, color: Rgb, depth_m: f32) -> Material {
    layers.relieved(rough(name, layers.tinted(color), 0.7), depth_m)
}

/// Cloth with upright fibres: a diffuse ground under sheen.
fn sheen(name: &str, layers: Layers, color: Rgb, sheen: Rgb, roughness: f32) -> Material {
    let principled = Principled {
        base_color: layers.tinted(color),
        specular: 0.0.into(),
        sheen_color: sheen.into(),
        sheen_roughness: roughness.into(),
        ..Principled::default()
    };
    Material::new(name, Bsdf::Principled(Box::new(principled)))
}
