//! A sitting bear or rabbit of plush, 22 to 38 cm high without long ears, of class other prop: ellipsoids of fur with a muzzle and soles of
//! a pale cloth and eyes and nose of black plastic. It is modelled one metre high and scaled; it looks to +y.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, sphere};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec3};

/// A sitting bear of plush, or a rabbit with long ears.
#[derive(Clone, Copy, Debug)]
pub struct PlushBear {
    /// Height of the seated animal without long ears.
    pub height: f32,
    /// A rabbit with long ears instead of a bear.
    pub rabbit: bool,
    /// What body, head and limbs are covered with.
    pub fur: Finish,
}

/// A ball stretched to the half axes `half`.
fn ball(half: [f32; 3], at: [f32; 3]) -> Mesh {
    let half = Vec3::from_array(half);
    sphere(1.0, 24).deformed(|p| p * half).smoothed(60.0).moved(Vec3::from_array(at))
}

impl Furniture for PlushBear {
    fn random(rng: &mut Rng) -> Self {
        let fur = [Finish::Boucle, Finish::Felt, Finish::KnittedThrow, Finish::Wicker][rng.below(4)];
        Self { height: rng.range(0.22, 0.38), rabbit: rng.below(3) == 0, fur }
    }

    fn size(&self) -> Vec3 {
        let h = self.height;
        Vec3::new(0.86 * h, 0.84 * h, if self.rabbit { 1.36 * h } else { 1.06 * h })
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let h = self.height;
        let bear = b.object("plush_toy", Class::OtherProp, on(pose, Vec3::new(0.0, -0.06 * h, CONTACT), 0.0));
        let mut part = |name: &str, mesh: Mesh, finish: Finish| {
            let mesh = Mesh { positions: mesh.positions.iter().map(|&p| p * h).collect(), ..mesh };
            b.part(&bear, name, mesh, finish);
        };
        part("body", ball([0.25, 0.21, 0.3], [0.0, 0.0, 0.3]), self.fur);
        part("head", ball([0.23, 0.2, 0.2], [0.0, 0.03, 0.76]), self.fur);
        part("muzzle", ball([0.1, 0.09, 0.075], [0.0, 0.2, 0.71]), Finish::Paper);
        part("nose", ball([0.036, 0.026, 0.024], [0.0, 0.285, 0.74]), Finish::BlackPlastic);
        let tilt = rng.range(-0.1, 0.1);
        for (name, s) in [("left", -1.0f32), ("right", 1.0)] {
            part(&format!("eye_{name}"), ball([0.022, 0.018, 0.022], [s * 0.085, 0.213, 0.81]), Finish::BlackPlastic);
            let ear = if self.rabbit {
                ball([0.065, 0.04, 0.26], [0.0, 0.0, 0.2]).turned(Vec3::Y, s * 0.22 + tilt).moved(Vec3::new(s * 0.1, 0.0, 0.88))
            } else {
                ball([0.085, 0.045, 0.085], [s * 0.17, 0.01, 0.93])
            };
            part(&format!("ear_{name}"), ear, self.fur);
            let arm = ball([0.085, 0.085, 0.2], [0.0, 0.0, -0.15]).turned(Vec3::X, 0.55).turned(Vec3::Y, -s * 0.5).moved(Vec3::new(
                s * 0.2,
                0.04,
                0.52,
            ));
            part(&format!("arm_{name}"), arm, self.fur);
            let leg = ball([0.1, 0.24, 0.1], [0.0, 0.16, 0.0]).turned(Vec3::Z, -s * 0.38).moved(Vec3::new(s * 0.15, 0.07, 0.1));
            part(&format!("leg_{name}"), leg, self.fur);
            let sole = ball([0.07, 0.02, 0.075], [0.0, 0.4, 0.0]).turned(Vec3::Z, -s * 0.38).moved(Vec3::new(s * 0.15, 0.065, 0.1));
            part(&format!("sole_{name}"), sole, Finish::Paper);
        }
    }
}
