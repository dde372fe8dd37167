//! Light and material of the luminous parts of lamps.
//!
//! Lamps are sold by luminous flux. A diffuse emitter of flux Φ and area A has the luminance Φ / (π A), in every direction alike.

use super::{Exposure, blackbody};
use enfilade_geometry::Mesh;
use enfilade_math::Rgb;
use enfilade_scene::Material;
use std::f32::consts::PI;

/// The light of one luminous part of a lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glow {
    /// Luminous flux that leaves the part, lumens.
    pub lumens: f32,
    /// Colour temperature, kelvin.
    pub kelvin: f32,
}

impl Glow {
    /// Small globes of opal glass: as a 40 W bulb (EU Regulation 874/2012, table 6).
    pub const SMALL: Self = Self { lumens: 470.0, kelvin: 2700.0 };
    /// A bare bulb: one of 60 W.
    pub const BULB: Self = Self { lumens: 806.0, kelvin: 2700.0 };
    /// Floor lamps, table lamps and pendants with a shade: the bulb, and the shade around it.
    pub const WITH_SHADE: Self = Self { lumens: Self::BULB.lumens + Self::BULB.shaded().lumens, ..Self::BULB };
    /// A ceiling lamp that lights a living room or bedroom alone: 100 lx over 20 m² at a utilisation of one half.
    pub const CEILING: Self = Self { lumens: 3000.0, kelvin: 3000.0 };
    /// A ceiling lamp of a kitchen, bathroom or study: neutral white.
    pub const WORK: Self = Self { lumens: 3600.0, kelvin: 4000.0 };

    /// A strip under wall units or behind a mirror, `length_m` long: 800 lm a metre.
    pub fn strip(length_m: f32) -> Self {
        Self { lumens: 800.0 * length_m, kelvin: 3500.0 }
    }

    /// The light of the bulb that passes a shade of cloth or paper; a cotton drum absorbs a little more than half.
    #[must_use]
    pub const fn shaded(self) -> Self {
        Self { lumens: 0.45 * self.lumens, ..self }
    }

    /// Luminance of a part of `area_m2`, kilo-candela per square metre as linear RGB.
    pub fn luminance_kcd(&self, area_m2: f32) -> Rgb {
        blackbody(self.kelvin) * (self.lumens / (1000.0 * PI * area_m2.max(1e-6)))
    }

    /// The light of a lamp's luminous part, lit or not, by the name of its material, [`Glow::material_name`]; `None` for others.
    pub fn of_material(name: &str) -> Option<Self> {
        let (_, glow) = name.split_once("lit lamp ")?;
        let (lumens, kelvin) = glow.strip_suffix(" K")?.split_once(" lm ")?;
        Some(Self { lumens: lumens.parse().ok()?, kelvin: kelvin.parse().ok()? })
    }

    /// The material of a part with this mesh: white opal that glows where the lamp is `lit`.
    pub fn material(&self, mesh: &Mesh, lit: bool, exposure: Exposure) -> Material {
        let body = Rgb::new(0.72, 0.70, 0.66);
        let emission = if lit { exposure.expose(self.luminance_kcd(area_m2(mesh))) } else { Rgb::BLACK };
        Material { emission: emission.into(), ..Material::diffuse(self.material_name(lit), body) }
    }

    /// Name of the material of a part with this light, from which [`Glow::of_material`] reads it.
    pub fn material_name(&self, lit: bool) -> String {
        format!("{} lamp {:.0} lm {:.0} K", if lit { "lit" } else { "unlit" }, self.lumens, self.kelvin)
    }
}

/// Sum of the triangles' areas.
pub fn area_m2(mesh: &Mesh) -> f32 {
    let doubled = (0..mesh.triangles.len()).map(|t| {
        let [a, b, c] = mesh.corners(t);
        (b - a).cross(c - a).length()
    });
    0.5 * doubled.sum::<f32>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::sphere;

    #[test]
    fn a_globe_gives_off_its_lumens() {
        let globe = sphere(0.1, 64);
        let area = area_m2(&globe);
        assert!((area - 4.0 * PI * 0.01).abs() < 0.001);
        // A sphere of luminance L has the intensity L π r² in every direction, and 4π times that is its flux.
        let luminance = Glow::BULB.luminance_kcd(area).luminance() * 1000.0;
        assert!((luminance * PI * 0.01 * 4.0 * PI / 806.0 - 1.0).abs() < 0.01, "{luminance} cd/m²");
    }

    #[test]
    fn the_name_of_a_material_tells_the_light_of_its_lamp() {
        let globe = sphere(0.1, 16);
        for lit in [true, false] {
            assert_eq!(Glow::of_material(&Glow::CEILING.material(&globe, lit, Exposure::new(1.0)).name), Some(Glow::CEILING));
        }
        assert_eq!([Glow::of_material("oak"), Glow::of_material("lit screen")], [None; 2]);
    }

    #[test]
    fn unlit_lamps_are_black_lights_and_lit_ones_follow_the_exposure() {
        let globe = sphere(0.1, 16);
        let of = |lit, per_kcd| Glow::SMALL.material(&globe, lit, Exposure::new(per_kcd)).emission.factor.luminance();
        assert_eq!(of(false, 1.0), 0.0);
        assert!((of(true, 3.0) / of(true, 1.0) - 3.0).abs() < 1e-4);
    }
}
