//! A cot for a mattress of 60 × 120 cm, of wood or white lacquer, with bars or boards at head and foot (class bed), and the cushion (class
//! pillow) and blanket (class other prop) in it. The head is at +x.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, rod};
use crate::pieces::{CONTACT, Furniture, board, grained};
use crate::shape::{Reshape, padded_box, pillow};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A cot with bars on all sides for a mattress of 60 × 120 cm.
#[derive(Clone, Copy, Debug)]
pub struct Crib {
    /// What posts, rails and bars are made of.
    pub finish: Finish,
    /// Head and foot are boards instead of bars.
    pub solid_ends: bool,
}

/// Distance from bar to bar, metres, before it is rounded up to fit: about 60 mm are free between bars; EN 716 asks for 45 to 65 mm.
const PITCH: f32 = 0.072;
/// Height of the middle of the upper rails, metres.
const RAIL: f32 = 0.85;
/// Height of the middle of the lower rails, metres: the slats lie on them.
const LOW: f32 = 0.27;
/// Half the thickness of the posts, metres.
const POST: f32 = 0.022;
/// Distance of a rail's end from the axis of a post, metres: half a millimetre inside the post.
const IN_POST: f32 = 0.0215;
/// Half the height of the rails, metres.
const HALF_RAIL: f32 = 0.025;

impl Furniture for Crib {
    fn random(rng: &mut Rng) -> Self {
        Self { finish: [Finish::WhiteLacquer, Finish::Wood][rng.below(2)], solid_ends: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(1.28, 0.68, 0.92)
    }

    fn reach(&self) -> f32 {
        0.7
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let crib = b.object("crib", Class::Bed, pose);
        let (x, y) = (0.617, 0.317);
        for (i, (sx, sy)) in [(1.0f32, 1.0f32), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].into_iter().enumerate() {
            let post = board([sx * x - POST, sy * y - POST, 0.0], [sx * x + POST, sy * y + POST, 0.92], 0.005);
            b.part(&crib, &format!("post_{}", i + 1), grained(post, rng), self.finish);
        }
        for (i, s) in [-1.0f32, 1.0].into_iter().enumerate() {
            let rail = |z: f32| board([IN_POST - x, s * y - 0.014, z - HALF_RAIL], [x - IN_POST, s * y + 0.014, z + HALF_RAIL], 0.004);
            let count = ((2.0 * x - 2.0 * POST) / PITCH) as usize;
            let bars = (1..count).map(|k| {
                let at = (2.0 * x - 2.0 * POST) * (k as f32 / count as f32 - 0.5);
                rod([at, s * y, LOW], [at, s * y, RAIL], 0.0075, 10)
            });
            b.part(&crib, &format!("side_{}", i + 1), grained(all(bars.chain([rail(LOW), rail(RAIL)])), rng), self.finish);
            let cross = |z: f32| board([s * x - 0.014, IN_POST - y, z - HALF_RAIL], [s * x + 0.014, y - IN_POST, z + HALF_RAIL], 0.004);
            let end = if self.solid_ends {
                board([s * x - 0.009, IN_POST - y, LOW - HALF_RAIL], [s * x + 0.009, y - IN_POST, RAIL], 0.003).with(cross(RAIL))
            } else {
                let count = ((2.0 * y - 2.0 * POST) / PITCH) as usize;
                let bars = (1..count).map(|k| {
                    let at = (2.0 * y - 2.0 * POST) * (k as f32 / count as f32 - 0.5);
                    rod([s * x, at, LOW], [s * x, at, RAIL], 0.0075, 10)
                });
                all(bars.chain([cross(LOW), cross(RAIL)]))
            };
            b.part(&crib, &format!("end_{}", i + 1), grained(end, rng), self.finish);
        }
        let slats = (0..12).map(|k| {
            let at = -0.57 + 0.1036 * k as f32;
            board([at - 0.025, -0.302, LOW + 0.004], [at + 0.025, 0.302, LOW + 0.014], 0.001)
        });
        b.part(&crib, "slats", all(slats), Finish::Wood);
        let mattress = padded_box(Vec3::new(1.18, 0.585, 0.09), 0.03, 0.006).moved(Vec3::new(0.0, 0.0, LOW + 0.0142 + CONTACT + 0.051));
        b.part(&crib, "mattress", mattress, Finish::BedLinen(0));
        let level = LOW + 0.0142 + 0.102 + 3.0 * CONTACT;
        let cushion = b.object("cushion", Class::Pillow, pose);
        let mesh = pillow(Vec2::new(0.28, 0.4), 0.07, rng).moved(Vec3::new(0.38, 0.0, level + 0.03));
        b.part(&cushion, "cover", mesh, Finish::BedLinen(2));
        let blanket = b.object("blanket", Class::OtherProp, pose);
        let quilt = padded_box(Vec3::new(0.62, 0.54, 0.03), 0.014, 0.01).uv_moved(Vec2::splat(rng.next_f32()));
        b.part(&blanket, "quilt", quilt.moved(Vec3::new(-0.22, 0.0, level + 0.022)), Finish::Accent(rng.below(3) as u8));
    }
}
