//! What the fire service asks for: an extinguisher on its bracket and the sign of an emergency exit, on walls, of class other prop. Their
//! origin is the middle of their back.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cut_out, cylinder, to_front, turned, wire};
use crate::pieces::{Furniture, board};
use crate::shape::Reshape;
use enfilade_math::{DAffine3, Rgb, Rng, Vec2, Vec3};
use enfilade_scene::Material;

/// A fire extinguisher on its bracket.
#[derive(Clone, Copy, Debug)]
pub struct Extinguisher;

/// Safety red and green (ISO 3864).
const RED: Rgb = Rgb::new(0.50, 0.018, 0.014);
const GREEN: Rgb = Rgb::new(0.008, 0.24, 0.10);

impl Furniture for Extinguisher {
    fn random(_rng: &mut Rng) -> Self {
        Self
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.22, 0.22, 0.56)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("fire_extinguisher", Class::OtherProp, pose);
        let red = b.material(crate::materials::coated("safety red", RED, 0.12));
        b.part(&object, "bracket", board([-0.03, 0.0, -0.14], [0.03, 0.03, 0.14], 0.002), Finish::BlackMetal);
        let tank = [[0.0, -0.27], [0.07, -0.27], [0.075, -0.262], [0.075, 0.12], [0.06, 0.16], [0.024, 0.185], [0.0, 0.186]];
        let at = Vec3::new(0.0, 0.104, 0.0);
        b.part(&object, "tank", turned(&tank, 40).moved(at), red);
        let neck = cylinder(0.02, 0.05, 20).moved(at + Vec3::new(0.0, 0.0, 0.184));
        let levers = [0.0f32, 0.025].map(|z| board([-0.01, 0.1, 0.225 + z], [0.01, 0.185, 0.234 + z], 0.002));
        b.part(
            &object,
            "valve",
            neck.with(all(levers)).with(board([-0.012, 0.09, 0.2], [0.012, 0.112, 0.262], 0.002)),
            Finish::BlackPlastic,
        );
        let hose =
            wire(&[[0.015, 0.11, 0.215], [0.07, 0.12, 0.2], [0.094, 0.12, 0.1], [0.09, 0.115, -0.08], [0.086, 0.11, -0.16]], 0.009, 10);
        b.part(&object, "hose", hose, Finish::Rubber);
        let label = turned(&[[0.0755, -0.13], [0.0758, -0.13], [0.0758, 0.02], [0.0755, 0.02], [0.0755, -0.13]], 40).moved(at);
        b.part(&object, "label", label, Finish::Paper);
    }
}

/// The sign of an emergency exit.
#[derive(Clone, Copy, Debug)]
pub struct ExitSign {
    /// The arrow points to +x instead of −x.
    pub mirrored: bool,
}

impl Furniture for ExitSign {
    fn random(rng: &mut Rng) -> Self {
        Self { mirrored: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.32, 0.045, 0.17)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("exit_sign", Class::OtherProp, pose);
        let green = b.material(crate::materials::coated("safety green", GREEN, 0.2));
        let white: Material = crate::materials::coated("sign white", Rgb::splat(0.76), 0.2);
        let white = b.material(white);
        b.part(&object, "case", board([-0.16, 0.0, -0.085], [0.16, 0.04, 0.085], 0.005), Finish::WhitePlastic);
        b.part(&object, "sheet", board([-0.15, 0.0398, -0.075], [0.15, 0.0425, 0.075], 0.0008), green);
        let s = if self.mirrored { 1.0 } else { -1.0 };
        let plate = |outline: &[[f32; 2]]| {
            // Outlines are of the sign as it is seen, where +x is to the left.
            let mut points: Vec<Vec2> = outline.iter().map(|p| Vec2::new(s * p[0], p[1])).collect();
            if s < 0.0 {
                points.reverse();
            }
            to_front(cut_out(&points, 0.0012, 0.0003)).turned(Vec3::Y, std::f32::consts::PI).moved(Vec3::new(0.0, 0.0424, 0.0))
        };
        let door = [[-0.12, -0.055], [-0.06, -0.055], [-0.06, 0.055], [-0.12, 0.055]];
        let shaft = [[0.0, -0.014], [0.065, -0.014], [0.065, 0.014], [0.0, 0.014]];
        let head = [[0.065, -0.045], [0.12, 0.0], [0.065, 0.045]];
        b.part(&object, "signs", all([plate(&door), plate(&shaft), plate(&head)]), white);
    }
}
