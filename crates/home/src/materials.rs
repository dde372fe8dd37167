//! What surfaces are made of: one set of materials for the whole home.

use crate::palette::Palette;
use crate::texture::{self, Paint};
use enfilade_math::{Rgb, Rng, Vec2};
use enfilade_scene::{Bsdf, ColorParam, Image, Material, NormalMap, ScalarParam, Scene, TextureRef};

/// Handles into `Scene::materials`.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Materials {
    pub wall: u32,
    pub accent_wall: u32,
    pub ceiling: u32,
    pub floor: u32,
    pub paint_white: u32,
    pub wood: u32,
    pub wood_dark: u32,
    pub lacquer_white: u32,
    pub sofa: u32,
    pub armchair: u32,
    pub curtain: u32,
    pub rug: u32,
    pub accents: [u32; 3],
    pub throw: u32,
    pub steel: u32,
    pub brass: u32,
    pub black_metal: u32,
    pub mirror: u32,
    pub glass: u32,
    pub screen: u32,
    pub black_plastic: u32,
    pub stone: u32,
    pub ceramics: [u32; 3],
    pub leaf: u32,
    pub bark: u32,
    pub soil: u32,
    pub books: u32,
    pub paper: u32,
    pub wicker: u32,
    pub lampshade: u32,
    pub bulb: u32,
    pub globe: u32,
    pub switch: u32,
}

/// Complex indices of refraction at 612, 549 and 465 nm, from Johnson & Christy and Palik by way of refractiveindex.info.
mod metal {
    use enfilade_math::Rgb;
    pub const STEEL: [Rgb; 2] = [Rgb::new(2.91, 2.95, 2.58), Rgb::new(3.09, 2.93, 2.77)];
    pub const BRASS: [Rgb; 2] = [Rgb::new(0.444, 0.527, 1.094), Rgb::new(3.695, 2.765, 1.829)];
    pub const SILVER: [Rgb; 2] = [Rgb::new(0.155, 0.145, 0.135), Rgb::new(4.10, 3.40, 2.45)];
}

/// Adds materials and their pictures to a scene.
struct Supplier<'a> {
    scene: &'a mut Scene,
}

impl Supplier<'_> {
    fn image(&mut self, image: Image, covers: [f32; 2]) -> Paint {
        self.scene.images.push(image);
        Paint { image: self.scene.images.len() as u32 - 1, covers: Vec2::from_array(covers) }
    }

    fn add(&mut self, material: Material) -> u32 {
        self.scene.materials.push(material);
        self.scene.materials.len() as u32 - 1
    }

    fn diffuse(&mut self, name: &str, reflectance: impl Into<ColorParam>) -> u32 {
        self.add(Material::new(name, Bsdf::Diffuse { reflectance: reflectance.into() }))
    }

    fn coated(&mut self, name: &str, diffuse: impl Into<ColorParam>, alpha: f32) -> u32 {
        self.add(coated(name, diffuse, alpha))
    }

    fn metal(&mut self, name: &str, [eta, k]: [Rgb; 2], reflectance: f32, alpha: f32) -> u32 {
        let bsdf = Bsdf::Conductor { eta, k, reflectance: Rgb::splat(reflectance).into(), alpha: alpha.into() };
        self.add(Material::new(name, bsdf))
    }

    fn bumped(&mut self, name: &str, reflectance: ColorParam, relief: TextureRef, height_m: f32) -> u32 {
        let normal_map = Some(NormalMap::Bump { texture: relief, scale: height_m });
        self.add(Material { normal_map, ..Material::new(name, Bsdf::Diffuse { reflectance }) })
    }
}

/// Varnish, lacquer, glaze or plastic: a diffuse body under a clear coat of roughness `alpha`.
pub fn coated(name: &str, diffuse: impl Into<ColorParam>, alpha: f32) -> Material {
    let bsdf =
        Bsdf::Plastic { diffuse: diffuse.into(), eta: 1.5, alpha: ScalarParam::from(alpha), specular: Rgb::WHITE.into(), nonlinear: false };
    Material::new(name, bsdf)
}

/// Linear RGB of unit luminance of a black body of `kelvin`, by Planck's law at 612, 549 and 465 nm relative to 6500 K.
pub fn blackbody(kelvin: f32) -> Rgb {
    let planck = |wavelength_nm: f32, t: f32| 1.0 / ((1.438_777e7 / (wavelength_nm * t)).exp() - 1.0);
    let relative = Rgb::new(612.0, 549.0, 465.0).map(|w| planck(w, kelvin) / planck(w, 6500.0));
    relative / relative.luminance()
}

impl Materials {
    /// The materials of a home in `palette`; their pictures go into `scene`.
    ///
    /// `lamp_kcd_m2` is the luminance of a bulb in units of the scene's radiance.
    pub fn new(scene: &mut Scene, palette: &Palette, lamp: f32, rng: &mut Rng) -> Self {
        let mut seed = || rng.next_u64() as u32;
        let s = &mut Supplier { scene };
        let (tint, relief) = texture::plaster("plaster", seed());
        let (tint, relief) = (s.image(tint, [2.0, 2.0]), s.image(relief, [0.9, 0.9]).texture());
        let floor = s.image(texture::floor_planks("floor planks", palette.floor, seed()), [2.0, 1.0]);
        let wood = s.image(texture::wood("veneer", palette.wood, seed()), [1.6, 0.8]);
        let weave = s.image(texture::weave("weave", 128, 0.45, seed()), [0.34, 0.34]);
        let linen = s.image(texture::weave("linen", 128, 0.6, seed()), [0.26, 0.26]);
        let knit = s.image(texture::knit("knit", 24, seed()), [0.30, 0.30]);
        let stone = s.image(texture::stone("stone", seed()), [0.8, 0.8]);
        let style = [texture::RugStyle::Lattice, texture::RugStyle::Bordered, texture::RugStyle::Stripes][seed() as usize % 3];
        let rug = s.image(texture::rug("rug", style, palette.rug[0], palette.rug[1], seed()), [1.0, 1.0]);
        let jackets = [palette.accents.as_slice(), &palette.art, &BOOK_COLORS].concat();
        let books = s.image(texture::book_spines("book jackets", &jackets, seed()), [1.0, 1.0]);
        let warm = blackbody(2800.0);
        let emitter = |name: &str, radiance: Rgb, body: Rgb| Material { emission: radiance.into(), ..Material::diffuse(name, body) };
        Self {
            wall: s.bumped("wall paint", tint.tinted(palette.wall), relief, 0.0006),
            accent_wall: s.bumped("accent wall paint", tint.tinted(palette.accent_wall), relief, 0.0006),
            ceiling: s.diffuse("ceiling paint", tint.tinted(Rgb::new(0.83, 0.825, 0.81))),
            floor: s.coated("oiled floor", floor.tinted(Rgb::WHITE), 0.22),
            paint_white: s.coated("white paint", Rgb::new(0.74, 0.735, 0.71), 0.18),
            wood: s.coated("veneer", wood.tinted(Rgb::WHITE), 0.25),
            wood_dark: s.coated("stained wood", wood.tinted(Rgb::splat(0.5)), 0.22),
            lacquer_white: s.coated("white lacquer", Rgb::new(0.70, 0.695, 0.675), 0.12),
            sofa: s.diffuse("sofa cloth", weave.tinted(palette.sofa * 1.12)),
            armchair: s.diffuse("armchair cloth", weave.tinted(palette.armchair * 1.12)),
            curtain: s.diffuse("curtain linen", linen.tinted(palette.curtain * 1.1)),
            rug: s.diffuse("rug wool", rug.tinted(Rgb::WHITE)),
            accents: palette.accents.map(|c| s.diffuse("cushion cloth", linen.tinted(c * 1.12))),
            throw: s.diffuse("knitted throw", knit.tinted(palette.accents[2] * 1.1)),
            steel: s.metal("brushed steel", metal::STEEL, 1.0, 0.22),
            brass: s.metal("satin brass", metal::BRASS, 0.95, 0.2),
            black_metal: s.coated("black powder coat", Rgb::splat(0.022), 0.3),
            mirror: s.metal("mirror", metal::SILVER, 0.95, 0.0),
            glass: s
                .add(Material::new("window glass", Bsdf::ThinDielectric { eta: 1.52, transmittance: Rgb::new(0.96, 0.975, 0.965).into() })),
            screen: s.coated("screen", Rgb::splat(0.008), 0.06),
            black_plastic: s.coated("black plastic", Rgb::splat(0.025), 0.25),
            stone: s.coated("honed stone", stone.tinted(Rgb::new(0.66, 0.65, 0.62)), 0.2),
            ceramics: [Rgb::new(0.70, 0.67, 0.61), palette.art[3], palette.art[4]].map(|c| s.coated("glazed ceramic", c, 0.14)),
            leaf: s.coated("leaf", Rgb::new(0.055, 0.13, 0.035), 0.32),
            bark: s.diffuse("bark", Rgb::new(0.16, 0.115, 0.07)),
            soil: s.diffuse("soil", Rgb::new(0.045, 0.032, 0.022)),
            books: s.coated("book jackets", books.tinted(Rgb::WHITE), 0.3),
            paper: s.diffuse("paper", Rgb::new(0.78, 0.77, 0.73)),
            wicker: s.diffuse("wicker", knit.tinted(Rgb::new(0.50, 0.36, 0.21))),
            // The cloth of a lit shade glows: what it lets through is given as its own light.
            lampshade: s.add(emitter("lampshade cloth", warm * (0.028 * lamp), Rgb::new(0.66, 0.62, 0.54))),
            bulb: s.add(emitter("bulb", warm * lamp, Rgb::splat(0.5))),
            globe: s.add(emitter("opal globe", blackbody(2900.0) * (0.07 * lamp), Rgb::splat(0.6))),
            switch: s.coated("white plastic", Rgb::splat(0.72), 0.2),
        }
    }
}

const BOOK_COLORS: [Rgb; 9] = [
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warm_white_is_orange_and_daylight_is_grey() {
        let lamp = blackbody(2800.0);
        assert!(lamp.r > 1.3 && lamp.b < 0.5 && (lamp.luminance() - 1.0).abs() < 1e-5, "{lamp:?}");
        let day = blackbody(6500.0);
        assert!((day.r - 1.0).abs() < 1e-5 && (day.b - 1.0).abs() < 1e-5);
    }
}
