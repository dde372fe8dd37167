//! Materials that are drawn for objects.

use enfilade_math::{Rgb, Rng, linear_from_srgb};
use enfilade_scene::{Bsdf, Material, MaterialChoice, Principled};

/// Share of metals.
const METALS: f64 = 0.2;

/// A material of one colour: hue uniform, saturation 0 to 0.9, lightness 0.15 to 0.85 (of HSL, in sRGB), roughness 0.15 to 0.9.
pub fn drawn(name: &str, rng: &mut Rng) -> MaterialChoice {
    let is_metal = rng.next_f64() < METALS;
    let color = color(rng.range(0.0, 6.0), rng.range(0.0, 0.9), rng.range(0.15, 0.85));
    let principled = Principled {
        base_color: color.into(),
        metallic: if is_metal { 1.0.into() } else { 0.0.into() },
        roughness: rng.range(0.15, 0.9).into(),
        ..Principled::default()
    };
    Material::new(format!("{name} (drawn)"), Bsdf::Principled(Box::new(principled))).into()
}

/// A colour of HSL, the hue in sixths of the circle.
fn color(hue: f32, saturation: f32, lightness: f32) -> Rgb {
    let chroma = (1.0 - (2.0 * lightness - 1.0).abs()) * saturation;
    let channel = |shift: f32| {
        let place = (hue + shift).rem_euclid(6.0);
        let share = (2.0 - (place - 3.0).abs()).clamp(0.0, 1.0);
        linear_from_srgb(lightness + chroma * (0.5 - share))
    };
    Rgb::new(channel(0.0), channel(4.0), channel(2.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// HSL's own definition: hue 0 is red, 2 green, 4 blue.
    #[test]
    fn colors_are_those_of_hsl() {
        assert_eq!(color(0.0, 1.0, 0.5), Rgb::new(1.0, 0.0, 0.0));
        assert_eq!(color(2.0, 1.0, 0.5), Rgb::new(0.0, 1.0, 0.0));
        assert_eq!(color(4.0, 1.0, 0.5), Rgb::new(0.0, 0.0, 1.0));
        assert_eq!(color(1.0, 1.0, 0.5), Rgb::new(1.0, 1.0, 0.0));
        assert_eq!(color(3.3, 0.0, 1.0), Rgb::WHITE);
    }
}
