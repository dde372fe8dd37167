//! A garden chair of one piece of plastic, 55 × 53 cm and 82 cm high, class chair: a dished seat, broad upright bars in the back, arms, and
//! four legs that spread. People use such chairs on balconies, in kitchens and in workshops.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::all;
use crate::pieces::standing;
use crate::shape::{Reshape, bendable_box, rounded_box};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec3};

/// A garden chair of one piece of plastic.
#[derive(Clone, Copy, Debug)]
pub struct PlasticChair {
    /// Finish of all of it.
    pub finish: Finish,
}

impl PlasticChair {
    /// Size of the box around it.
    pub const SIZE: Vec3 = Vec3::new(0.57, 0.55, 0.85);

    /// A random one; half of them are white.
    pub fn random(rng: &mut Rng) -> Self {
        let colored = Finish::Plastic(rng.below(5) as u8);
        Self { finish: [Finish::WhitePlastic, colored][rng.below(2)] }
    }

    /// Adds its parts.
    pub fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let chair = b.object("chair", Class::Chair, pose);
        let seat = bendable_box(Vec3::new(0.43, 0.42, 0.02), 0.006, [8, 8, 1]).deformed(|p| {
            let dish = 0.018 * (1.0 - (p.x / 0.215).powi(2)) * (1.0 - (p.y / 0.21).powi(4));
            let front = 0.02 * ((p.y - 0.12) / 0.09).max(0.0).powi(2);
            Vec3::new(p.x * (1.0 + 0.12 * p.y), p.y + 0.025, p.z - dish - front + 0.44)
        });
        b.part(&chair, "seat", seat.smoothed(50.0), self.finish);
        let mut legs = Vec::new();
        for s in [-1.0f32, 1.0] {
            legs.push(beam([s * 0.255, 0.235, 0.0], [s * 0.215, 0.19, 0.435], [0.05, 0.026]));
            legs.push(beam([s * 0.25, -0.24, 0.0], [s * 0.205, -0.17, 0.435], [0.05, 0.026]));
            // The front legs go on to the arms.
            legs.push(beam([s * 0.215, 0.16, 0.43], [s * 0.245, 0.1, 0.63], [0.05, 0.02]));
        }
        b.part(&chair, "legs", all(legs), self.finish);
        b.part(&chair, "back", back(), self.finish);
        let arms = [-1.0f32, 1.0].map(|s| {
            bendable_box(Vec3::new(0.055, 0.34, 0.016), 0.006, [1, 10, 1])
                .deformed(|p| {
                    let t = (p.y / 0.34 + 0.5).clamp(0.0, 1.0);
                    Vec3::new(p.x + s * (0.205 + 0.036 * (1.0 - (1.0 - t).powi(3))), p.y - 0.045, p.z + 0.634 - 0.01 * t * t)
                })
                .smoothed(50.0)
        });
        b.part(&chair, "arms", all(arms), self.finish);
    }
}

/// A beam of rectangular section, `size` across x and y, between two points, cut off at the floor.
fn beam(from: [f32; 3], to: [f32; 3], size: [f32; 2]) -> Mesh {
    let (from, to) = (Vec3::from_array(from), Vec3::from_array(to));
    let height = to.z - from.z;
    let mesh = rounded_box(Vec3::new(size[0], size[1], height), 0.006, 2);
    let along = |p: Vec3| from.lerp(to, p.z / height + 0.5) + Vec3::new(p.x, p.y, 0.0);
    standing(mesh.deformed(along)).smoothed(40.0)
}

/// Upright bars between a lower and an upper band, bent around the sitter.
fn back() -> Mesh {
    let bent = |p: Vec3| {
        let t = (p.z - 0.44) / 0.38;
        let top = 1.0 - 0.04 * (p.x / 0.2).powi(2) * t.max(0.0);
        Vec3::new(p.x * (1.0 + 0.06 * t), p.y - 0.19 - 0.06 * t + 0.5 * p.x * p.x, 0.44 + (p.z - 0.44) * top)
    };
    let bar = |x: f32, wide: f32, z: [f32; 2], cells: [usize; 3]| {
        bendable_box(Vec3::new(wide, 0.014, z[1] - z[0]), 0.005, cells)
            .moved(Vec3::new(x, 0.0, 0.5 * (z[0] + z[1])))
            .deformed(bent)
            .smoothed(50.0)
    };
    let bars = (-2..=2).map(|k| bar(0.082 * k as f32, 0.05, [0.47, 0.77], [2, 1, 8]));
    all(bars.chain([bar(0.0, 0.415, [0.43, 0.485], [12, 1, 1]), bar(0.0, 0.415, [0.755, 0.83], [12, 1, 2])]))
}
