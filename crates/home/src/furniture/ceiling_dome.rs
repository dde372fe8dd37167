use super::Furniture;
use crate::builder::{Builder, Class};
use crate::light::Glow;
use crate::materials::Finish;
use crate::shape::lathe;
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
        // A spherical cap that is 7 cm deep, closed at the top.
        let (rise, edge) = (0.07, r - 0.012);
        let ball = (edge * edge + rise * rise) / (2.0 * rise);
        let open = (edge / ball).asin();
        let mut profile: Vec<Vec2> = (0..=16)
            .map(|k| {
                let (sin, cos) = (open * k as f32 / 16.0).sin_cos();
                Vec2::new(if k == 0 { 0.0 } else { ball * sin }, -0.0185 - rise + ball * (1.0 - cos))
            })
            .collect();
        profile.push(Vec2::new(0.0, -0.0182));
        b.glow(&lamp, "glass", lathe(&profile, 64), Glow::WORK);
    }
}
