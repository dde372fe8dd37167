//! Walls, ceilings and floors: paint, plaster, wallpaper, brick, planks, parquet, tiles, carpet, concrete.

use super::{Maker, coated, rough};
use enfilade_math::Rgb;
use enfilade_scene::Material;
use enfilade_textures as texture;

impl Maker<'_> {
    /// Matt emulsion on rolled plaster. White emulsion reflects 80 to 85 % (EN ISO 2813 calls it matt below 10 gloss units at 85°).
    pub(super) fn wall_paint(&mut self, name: &str, color: Rgb) -> Material {
        let layers = self.skin("rolled paint", &(), [1.0, 1.0], |seed| texture::rolled("rolled paint", seed));
        layers.relieved(rough(name, layers.tinted(color), 0.4), 0.000_35)
    }

    pub(super) fn lime_plaster(&mut self, color: Rgb) -> Material {
        let layers = self.skin("lime plaster", &(), [2.2, 2.2], |seed| texture::trowelled("lime plaster", seed));
        layers.relieved(rough("lime plaster", layers.tinted(lightened(color, 1.12)), 0.6), 0.001_5)
    }

    pub(super) fn wallpaper(&mut self) -> Material {
        let palette = self.palette();
        // Figures differ from the ground in tone, not in hue.
        let ground = palette.accent_wall;
        let toward = if ground.luminance() > 0.3 { ground * 0.62 } else { ground.lerp(Rgb::splat(0.7), 0.28) };
        let colors = [ground, toward, palette.accents[0].lerp(ground, 0.35)];
        let layers = self
            .skin("wallpaper", &(palette.paper, colors), [1.06, 1.06], |seed| texture::wallpaper("wallpaper", palette.paper, colors, seed));
        layers.relieved(rough("wallpaper", layers.tinted(Rgb::WHITE), 0.3), 0.000_25)
    }

    pub(super) fn brick(&mut self) -> Material {
        let (clay, mortar) = (Rgb::new(0.33, 0.13, 0.075), Rgb::new(0.42, 0.39, 0.34));
        let layers = self.skin("brick", &(), [1.0, 0.972], |seed| texture::brick("brick", clay, mortar, seed));
        layers.relieved(rough("brick", layers.tinted(Rgb::WHITE), 0.8), 0.005)
    }

    pub(super) fn plank_floor(&mut self) -> Material {
        let tone = self.palette().floor;
        let layers = self.varnished("floor planks", &tone, [2.0, 1.0], |seed| texture::floor_planks("floor planks", &tone, seed));
        layers.relieved(coated("oiled floor", layers.tinted(Rgb::WHITE), layers.alpha(0.95)), 0.000_25)
    }

    pub(super) fn parquet_floor(&mut self) -> Material {
        let tone = self.palette().floor;
        let side = texture::HERRINGBONE_M;
        let layers =
            self.varnished("herringbone parquet", &tone, [side, side], |seed| texture::herringbone("herringbone parquet", &tone, seed));
        layers.relieved(coated("herringbone parquet", layers.tinted(Rgb::WHITE), layers.alpha(0.75)), 0.000_5)
    }

    pub(super) fn tiles(&mut self, name: &'static str, look: texture::TileLook) -> Material {
        let layers = self.skin(name, &look, look.covers(), |seed| texture::tiles(name, &look, seed));
        layers.relieved(coated(name, layers.tinted(Rgb::WHITE), layers.alpha(1.0)), texture::TileLook::RELIEF_M)
    }

    pub(super) fn carpet(&mut self) -> Material {
        let color = self.palette().rug[0];
        let layers = self.skin("carpet loops", &(), [0.36, 0.36], |seed| texture::loops("carpet loops", 110, 0.5, seed));
        layers.relieved(rough("carpet", layers.tinted(lightened(color, 1.1)), 1.0), 0.002)
    }

    pub(super) fn concrete(&mut self) -> Material {
        let tone = Rgb::new(0.36, 0.35, 0.335);
        let layers = self.varnished("concrete", &(), [2.4, 2.4], |seed| texture::concrete("concrete", tone, true, seed));
        layers.relieved(coated("sealed microcement", layers.tinted(Rgb::WHITE), layers.alpha(1.0)), 0.000_4)
    }
}

/// A colour raised by one over the mean of the picture that multiplies it, but not above what surfaces reflect.
pub(super) fn lightened(color: Rgb, by: f32) -> Rgb {
    color * by.min(0.88 / color.max_component().max(0.01))
}
