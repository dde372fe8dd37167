//! Screens, on and off.
//!
//! A lit screen shows a picture in the colours of the palette, as bright as the exposure of the home makes it.

use super::{Maker, coated};
use enfilade_math::Rgb;
use enfilade_scene::{Bsdf, Material, TextureRef, Wrap};
use enfilade_textures::{self as texture, Display};

/// White of a screen, kcd/m²: 250 cd/m² (ISO 9241-307 asks for 100 at least).
const SCREEN_KCD: f32 = 0.25;

impl Maker<'_> {
    /// A screen that is on, seen through its glass.
    pub(super) fn screen_on(&mut self, i: u8) -> Material {
        let shown = Display::ALL[usize::from(i) % Display::ALL.len()];
        let colors = self.palette().art;
        let picture = self
            .picture("screen picture", &(shown, colors, i), [1.0, 1.0], |seed| texture::display("screen picture", shown, &colors, seed));
        let mut material = coated("lit screen", Rgb::splat(0.008), 0.06);
        material.emission = picture.tinted(self.stock.exposure.expose(Rgb::splat(SCREEN_KCD)));
        material.emission.texture = material.emission.texture.map(|t| TextureRef { wrap: [Wrap::Clamp; 2], ..t });
        material
    }

    /// A screen that is off: black glass.
    pub(super) fn screen(&self) -> Material {
        let bsdf = Bsdf::Plastic {
            diffuse: Rgb::splat(0.008).into(),
            eta: 1.5,
            alpha: 0.05.into(),
            specular: Rgb::WHITE.into(),
            nonlinear: false,
        };
        Material::new("screen", bsdf)
    }
}
