//! Wood, stone, pottery, lacquer and plastic: bodies under a clear surface.

use super::{Maker, coated, rough};
use enfilade_math::Rgb;
use enfilade_scene::Material;
use enfilade_textures::{self as texture, SlabLook, WoodTone};

/// Colours of household plastic and of lacquered toys besides those of the palette.
const BRIGHT: [Rgb; 4] =
    [Rgb::new(0.55, 0.035, 0.028), Rgb::new(0.72, 0.44, 0.03), Rgb::new(0.035, 0.13, 0.38), Rgb::new(0.06, 0.26, 0.085)];
/// Skins of apples, oranges, lemons, green apples, pears, plums.
pub(super) const FRUITS: [Rgb; 6] = [
    Rgb::new(0.40, 0.035, 0.03),
    Rgb::new(0.66, 0.22, 0.02),
    Rgb::new(0.72, 0.54, 0.05),
    Rgb::new(0.28, 0.38, 0.05),
    Rgb::new(0.44, 0.40, 0.09),
    Rgb::new(0.085, 0.022, 0.07),
];

impl Maker<'_> {
    /// Oiled or lacquered veneer of the palette's wood.
    pub(super) fn veneer(&mut self, name: &'static str, stained: bool) -> Material {
        let wood = self.palette().wood;
        // Stain darkens pale woods and hides their rings.
        let tone = if stained && wood.light.luminance() > 0.15 {
            WoodTone { light: wood.light * Rgb::new(0.30, 0.26, 0.22), dark: wood.dark * Rgb::new(0.28, 0.25, 0.22), ..wood }
        } else {
            wood
        };
        let layers = self.varnished("veneer", &tone, [1.6, 0.8], |seed| texture::veneer("veneer", &tone, seed));
        layers.relieved(coated(name, layers.tinted(Rgb::WHITE), layers.alpha(0.95)), 0.000_12)
    }

    pub(super) fn slab(&mut self, name: &'static str, look: SlabLook, polish: f32) -> Material {
        let slab = self.picture("slab", &look, [1.8, 1.8], |seed| texture::slab("slab", &look, seed));
        coated(name, slab.tinted(Rgb::WHITE), slab.alpha(polish))
    }

    pub(super) fn terrazzo(&mut self) -> Material {
        let palette = self.palette();
        let cement = Rgb::new(0.60, 0.58, 0.54).lerp(palette.wall, 0.3);
        let chips = [palette.art[3].lerp(cement, 0.3), palette.accents[1].lerp(cement, 0.4), Rgb::new(0.14, 0.135, 0.13)];
        let ground = self.picture("terrazzo", &(cement, chips), [1.0, 1.0], |seed| texture::terrazzo("terrazzo", cement, chips, seed));
        coated("terrazzo", ground.tinted(Rgb::WHITE), ground.alpha(1.0))
    }

    /// A kitchen's worktop: stone, or wood where the stone of the palette is a limestone, which acids stain.
    pub(super) fn worktop(&mut self) -> Material {
        let slab = self.palette().slab;
        if slab == SlabLook::LIMESTONE { self.veneer("oiled worktop", false) } else { self.slab("stone worktop", slab, 1.5) }
    }

    pub(super) fn ceramic(&mut self, i: u8) -> Material {
        let palette = self.palette();
        coated("glazed ceramic", [Rgb::new(0.70, 0.67, 0.61), palette.art[3], palette.art[4]][usize::from(i) % 3], 0.10)
    }

    pub(super) fn terracotta(&mut self) -> Material {
        let layers = self.skin("rolled paint", &(), [0.25, 0.25], |seed| texture::rolled("rolled paint", seed));
        layers.relieved(rough("terracotta", layers.tinted(Rgb::new(0.42, 0.185, 0.10)), 0.7), 0.000_15)
    }

    /// Sprayed lacquer with a faint orange peel.
    pub(super) fn lacquer(&mut self, name: &str, color: Rgb, alpha: f32) -> Material {
        let layers = self.skin("rolled paint", &(), [0.14, 0.14], |seed| texture::rolled("rolled paint", seed));
        let gloss = self.gloss(alpha);
        layers.relieved(coated(name, color, gloss), 0.000_012)
    }

    /// A colour for lacquered furniture and toys.
    pub(super) fn paint_color(&self, i: u8) -> Rgb {
        let palette = self.palette();
        [palette.art[3], palette.accents[0], palette.art[4], palette.armchair, palette.art[2]][usize::from(i) % 5]
    }

    pub(super) fn plastic(&mut self, i: u8) -> Material {
        let palette = self.palette();
        let near = [palette.accents[0], palette.accents[1], palette.art[3], palette.art[2]];
        let color = if i % 8 < 4 { near[usize::from(i % 4)] } else { BRIGHT[usize::from(i % 4)] };
        coated("plastic", color, 0.16)
    }

    pub(super) fn cork(&mut self) -> Material {
        let layers = self.skin("cork", &(), [0.4, 0.4], |seed| texture::cork("cork", seed));
        layers.relieved(rough("cork", layers.tinted(Rgb::WHITE), 0.6), 0.000_5)
    }

    pub(super) fn leather(&mut self, name: &'static str, color: Rgb) -> Material {
        let layers = self.varnished("leather", &(), [0.2, 0.2], |seed| texture::leather("leather", seed));
        layers.relieved(coated(name, layers.tinted(color), layers.alpha(1.0)), 0.000_4)
    }

    pub(super) fn leather_bag(&mut self, i: u8) -> Material {
        let colors = [self.palette().leather, Rgb::splat(0.02), Rgb::new(0.30, 0.14, 0.055), Rgb::new(0.22, 0.03, 0.03)];
        self.leather("bag leather", colors[usize::from(i) % 4])
    }

    pub(super) fn wicker(&mut self, name: &'static str, strands: i32, covers: f32, color: Rgb) -> Material {
        let layers = self.skin(name, &(), [covers, covers], |seed| texture::wicker(name, strands, seed));
        layers.relieved(coated(name, layers.tinted(color), layers.alpha(1.0)), 0.003)
    }

    pub(super) fn cardboard(&mut self) -> Material {
        let layers = self.skin("cardboard", &(), [0.3, 0.3], |seed| texture::cardboard("cardboard", seed));
        layers.relieved(rough("cardboard", layers.tinted(Rgb::new(0.47, 0.32, 0.185)), 0.4), 0.000_12)
    }
}
