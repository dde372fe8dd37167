//! A flat lamp under a ceiling, 26 to 40 cm across: a dish of opal glass, which gives off all the light, in a rim of steel; class lamp. The
//! origin is on the ceiling, and everything hangs below it at negative z.

use super::Furniture;
use crate::builder::{Builder, Class};
use crate::lamplight::Glow;
use crate::materials::Finish;
use crate::shape::lathe;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A flat lamp under the ceiling: a dish of opal glass in a metal rim. Its origin is on the ceiling.
#[derive(Clone, Copy, Debug)]
pub struct CeilingDome {
    /// Radius over the rim.
    pub radius: f32,
}

impl Furniture for CeilingDome {
    fn random(rng: &mut Rng) -> Self {
        Self { radius: rng.range(0.13, 0.2) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.radius, 2.0 * self.radius, 0.09)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let lamp = b.object("ceiling_lamp", Class::Lamp, pose);
        let r = self.radius;
        let rim = [[0.0, -0.018], [r - 0.006, -0.018], [r, -0.014], [r, 0.001], [0.0, 0.001]];
        b.part(&lamp, "rim", lathe(&rim.map(Vec2::from_array), 64), Finish::Steel);
        b.glow(&lamp, "glass", self.glass(), Glow::WORK);
    }
}

impl CeilingDome {
    /// A spherical cap that is 7 cm deep. The rim closes it at the top: a lid of glass below the rim would take its share of the lamp's
    /// flux where nobody sees it.
    fn glass(&self) -> Mesh {
        let (rise, edge) = (0.07, self.radius - 0.012);
        let ball = (edge * edge + rise * rise) / (2.0 * rise);
        let open = (edge / ball).asin();
        let profile: Vec<Vec2> = (0..=16)
            .map(|k| {
                let (sin, cos) = (open * k as f32 / 16.0).sin_cos();
                Vec2::new(if k == 0 { 0.0 } else { ball * sin }, -0.0185 - rise + ball * (1.0 - cos))
            })
            .collect();
        lathe(&profile, 64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lamplight::area_m2;
    use std::f32::consts::PI;

    #[test]
    fn all_the_flux_of_a_dome_comes_into_the_room() {
        for radius in [0.13, 0.2] {
            let dish = CeilingDome { radius }.glass();
            let faces = (0..dish.triangles.len()).map(|t| {
                let [a, b, c] = dish.corners(t);
                0.5 * (b - a).cross(c - a)
            });
            let seen_m2: f32 = faces.filter(|face| face.z < 0.0).map(Vec3::length).sum();
            let lumens = 1000.0 * Glow::WORK.luminance_kcd(area_m2(&dish)).luminance() * PI * seen_m2;
            assert!((lumens / Glow::WORK.lumens - 1.0).abs() < 1e-3, "{lumens} lm");
        }
    }
}
