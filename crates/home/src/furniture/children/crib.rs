use crate::builder::{Builder, Class};
use crate::furniture::form::{all, rod};
use crate::furniture::{CONTACT, Furniture, board, grained};
use crate::materials::Finish;
use crate::shape::{Reshape, padded_box, pillow};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A cot with bars on all sides for a mattress of 60 × 120 cm.
#[derive(Clone, Copy, Debug)]
pub struct Crib {
    /// Of the wood.
    pub finish: Finish,
    /// Boards instead of bars at head and foot.
    pub solid_ends: bool,
}

/// Bars are 60 mm apart: EN 716 asks for 45 to 65 mm between them.
const PITCH: f32 = 0.072;
const RAIL: f32 = 0.85;
const LOW: f32 = 0.27;

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
            let post = board([sx * x - 0.022, sy * y - 0.022, 0.0], [sx * x + 0.022, sy * y + 0.022, 0.92], 0.005);
            b.part(&crib, &format!("post_{}", i + 1), grained(post, rng), self.finish);
        }
        for (i, s) in [-1.0f32, 1.0].into_iter().enumerate() {
            let rail = |z: f32| board([0.0215 - x, s * y - 0.014, z - 0.025], [x - 0.0215, s * y + 0.014, z + 0.025], 0.004);
            let count = ((2.0 * x - 0.044) / PITCH) as usize;
            let bars = (1..count).map(|k| {
                let at = (2.0 * x - 0.044) * (k as f32 / count as f32 - 0.5);
                rod([at, s * y, LOW], [at, s * y, RAIL], 0.0075, 10)
            });
            b.part(&crib, &format!("side_{}", i + 1), grained(all(bars.chain([rail(LOW), rail(RAIL)])), rng), self.finish);
            let cross = |z: f32| board([s * x - 0.014, 0.0215 - y, z - 0.025], [s * x + 0.014, y - 0.0215, z + 0.025], 0.004);
            let end = if self.solid_ends {
                board([s * x - 0.009, 0.0215 - y, LOW - 0.025], [s * x + 0.009, y - 0.0215, RAIL], 0.003).with(cross(RAIL))
            } else {
                let count = ((2.0 * y - 0.044) / PITCH) as usize;
                let bars = (1..count).map(|k| {
                    let at = (2.0 * y - 0.044) * (k as f32 / count as f32 - 0.5);
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
