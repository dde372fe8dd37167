//! Natural materials and food: leaves, bark, soil, petals, fruit, bread; and the jackets of books.

use super::solid::FRUITS;
use super::{Maker, coated, rough};
use enfilade_math::Rgb;
use enfilade_scene::Material;
use enfilade_textures as texture;

/// Jackets of books besides the palette's colours.
const JACKETS: [Rgb; 9] = [
    Rgb::new(0.62, 0.58, 0.50),
    Rgb::new(0.035, 0.05, 0.10),
    Rgb::new(0.25, 0.035, 0.03),
    Rgb::new(0.70, 0.68, 0.63),
    Rgb::new(0.03, 0.03, 0.032),
    Rgb::new(0.10, 0.16, 0.12),
    Rgb::new(0.50, 0.40, 0.26),
    Rgb::new(0.16, 0.22, 0.29),
    Rgb::new(0.72, 0.70, 0.66),
];

impl Maker<'_> {
    pub(super) fn leaf(&mut self, name: &'static str, blade: Rgb, vein: Rgb) -> Material {
        let layers = self.skin(name, &(), [1.0, 1.0], |seed| texture::leaf(name, blade, vein, seed));
        coated(name, layers.tinted(Rgb::WHITE), layers.alpha(1.0))
    }

    /// Bark: the grain of coarse felt.
    pub(super) fn bark(&mut self) -> Material {
        self.felt("bark", 16, 0.10, Rgb::new(0.16, 0.115, 0.07), 0.003)
    }

    /// Crumbs of 3 mm.
    pub(super) fn soil(&mut self) -> Material {
        let layers = self.skin("crumbs", &(), [0.14, 0.14], |seed| texture::loops("crumbs", 110, 1.6, seed));
        layers.relieved(rough("soil", layers.tinted(Rgb::new(0.05, 0.035, 0.024)), 1.0), 0.005)
    }

    pub(super) fn petal(&self, i: u8) -> Material {
        let palette = self.palette();
        let colors = [palette.accents[0], Rgb::new(0.74, 0.72, 0.66), palette.art[2], palette.accents[1]];
        rough("petal", colors[usize::from(i) % 4], 0.3)
    }

    pub(super) fn fruit(&mut self, i: u8) -> Material {
        let layers = self.skin("rolled paint", &(), [0.1, 0.1], |seed| texture::rolled("rolled paint", seed));
        layers.relieved(coated("fruit skin", FRUITS[usize::from(i) % FRUITS.len()], 0.28), 0.000_05)
    }

    pub(super) fn bread(&mut self) -> Material {
        let layers = self.skin("crumbs", &(), [0.30, 0.30], |seed| texture::loops("crumbs", 110, 1.6, seed));
        layers.relieved(rough("bread crust", layers.tinted(Rgb::new(0.42, 0.25, 0.13)), 0.6), 0.000_5)
    }

    pub(super) fn book_jackets(&mut self) -> Material {
        let palette = self.palette();
        let jackets = [palette.accents.as_slice(), &palette.art, &JACKETS].concat();
        let books = self.picture("book jackets", &jackets, [1.0, 1.0], |seed| texture::book_spines("book jackets", &jackets, seed));
        coated("book jackets", books.tinted(Rgb::WHITE), 0.3)
    }
}
