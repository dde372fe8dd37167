//! A shallow cabinet on the wall, 50 to 100 × 62 to 75 cm, whose doors are mirrors, two in three with a lamp above. The carcass is of class
//! cabinet, each door of class mirror, the lamp of class lamp. The origin is the middle of the back, on the wall.

use crate::builder::{Builder, Class};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::form::rod;
use crate::pieces::joinery::{INSIDE, body_box};
use crate::pieces::{Furniture, board, on};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec3};

/// A shallow cabinet on the wall whose doors are mirrors, with a lamp above; its origin is the middle of its back.
#[derive(Clone, Copy, Debug)]
pub struct MirrorCabinet {
    /// Width of the cabinet.
    pub width: f32,
    /// Height of the cabinet.
    pub height: f32,
    /// A lamp on top.
    pub lamp: bool,
    /// Finish of the carcass.
    pub finish: Finish,
}

/// Depth of the carcass, metres.
const DEPTH: f32 = 0.14;
/// Space above the cabinet for the lamp, metres; as much is left below, so that the origin is in the middle.
const LAMP: f32 = 0.07;

impl Furniture for MirrorCabinet {
    fn random(rng: &mut Rng) -> Self {
        let finish = [Finish::WhiteLacquer, Finish::Aluminium, Finish::Wood][rng.below(3)];
        Self { width: [0.5, 0.6, 0.8, 1.0][rng.below(4)], height: rng.range(0.62, 0.75), lamp: rng.below(3) > 0, finish }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, DEPTH + 0.026, self.height + 2.0 * LAMP)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let cabinet = b.object("mirror_cabinet", Class::Cabinet, pose);
        let (x, z) = (0.5 * self.width, 0.5 * self.height);
        let carcass = body_box(b, [-x, 0.0, -z], [x, DEPTH, z], 0.002);
        b.part(&cabinet, "carcass", carcass, self.finish);
        if b.has_joints() {
            let shelf = |z: f32| board([INSIDE - x, INSIDE, z - 0.003], [x - INSIDE, DEPTH - 0.01, z + 0.003], 0.001);
            b.part(&cabinet, "shelves", shelf(-z / 3.0).with(shelf(z / 3.0)), Finish::Glass);
        }
        let doors = ((self.width / 0.4).round() as usize).max(1);
        let wide = self.width / doors as f32;
        for k in 0..doors {
            let from = -x + k as f32 * wide;
            let mirror = b.object("mirror", Class::Mirror, pose);
            let panel = |inset: f32, y: [f32; 2]| {
                board([from + 0.0012 + inset, y[0], -z + inset], [from + wide - 0.0012 - inset, y[1], z - inset], 0.0012)
            };
            let from_part = b.part_count();
            b.part(&mirror, "door", panel(0.0, [DEPTH + 0.0008, DEPTH + 0.015]), self.finish);
            b.part(&mirror, "glass", panel(0.002, [DEPTH + 0.0148, DEPTH + 0.019]), Finish::Mirror);
            let (edge, side) = if k % 2 == 0 { (from, -1.0) } else { (from + wide, 1.0) };
            b.joint(&mirror, "door", &Joint::cupboard(edge, DEPTH + 0.019, side), from_part..b.part_count());
        }
        if self.lamp {
            let lamp = b.object("lamp", Class::Lamp, on(pose, Vec3::Z * z, 0.0));
            let (half, y) = (0.32 * self.width, 0.135);
            b.part(&lamp, "arm", rounded_box(Vec3::new(0.05, 0.10, 0.012), 0.003, 2).moved(Vec3::new(0.0, 0.09, 0.0065)), Finish::Chrome);
            b.part(
                &lamp,
                "profile",
                rounded_box(Vec3::new(2.0 * half + 0.02, 0.03, 0.02), 0.004, 2).moved(Vec3::new(0.0, y, 0.023)),
                Finish::Chrome,
            );
            b.part(&lamp, "tube", rod([-half, y, 0.045], [half, y, 0.045], 0.0145, 16), Finish::OpalGlobe);
        }
    }
}
