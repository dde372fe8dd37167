//! A filing cabinet of sheet metal, class cabinet: low with three drawers on castors for under a desk, or high with two to four drawers for
//! hanging files, 32 cm each.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, rod};
use crate::pieces::joinery::{body_box, boxed};
use crate::pieces::{Furniture, Surface, board};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec3};

/// A filing cabinet of sheet metal, high on the floor or low on castors under a desk.
#[derive(Clone, Copy, Debug)]
pub struct FilingCabinet {
    /// Drawers for hanging files, or the three flat ones of a low cabinet.
    pub drawers: usize,
    /// Low and on castors.
    pub low: bool,
    /// Finish of the sheet metal.
    pub finish: Finish,
}

impl Furniture for FilingCabinet {
    fn random(rng: &mut Rng) -> Self {
        let low = rng.below(2) == 0;
        let finish = [Finish::CoatedWhite, Finish::BlackMetal, Finish::ColoredMetal(rng.below(4) as u8)][rng.below(3)];
        Self { drawers: if low { 3 } else { 2 + rng.below(3) }, low, finish }
    }

    fn size(&self) -> Vec3 {
        if self.low { Vec3::new(0.42, 0.56, 0.57) } else { Vec3::new(0.46, 0.62, 0.07 + 0.32 * self.drawers as f32) }
    }

    fn reach(&self) -> f32 {
        0.6
    }

    fn surfaces(&self) -> Vec<Surface> {
        let size = self.size();
        let half = 0.5 * size.truncate() - 0.03;
        vec![Surface { min: -half, max: half, z: size.z, headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("filing_cabinet", Class::Cabinet, pose);
        let size = self.size();
        let (half, front) = (0.5 * size.x, 0.5 * size.y);
        let low = if self.low { 0.065 } else { 0.03 };
        let (inner, top) = (front - 0.036, size.z);
        let case = body_box(b, [-half, -front, low], [half, inner, top], 0.003);
        b.part(&object, "case", case, self.finish);
        if self.low {
            let castor = |x: f32, y: f32| {
                let wheel = cylinder(0.026, 0.02, 20).turned(Vec3::Y, std::f32::consts::FRAC_PI_2).moved(Vec3::new(x - 0.01, y, 0.026));
                wheel.with(rod([x, y, 0.03], [x, y, low + 0.002], 0.008, 8))
            };
            let spots = [(-1.0f32, -1.0f32), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
            b.part(&object, "castors", all(spots.map(|(x, y)| castor(x * (half - 0.06), y * (front - 0.08)))), Finish::BlackPlastic);
        } else {
            b.part(
                &object,
                "base",
                board([0.01 - half, 0.01 - front, 0.0], [half - 0.01, inner - 0.02, low - 0.0002], 0.001),
                Finish::BlackPlastic,
            );
        }
        let h = (top - low - 0.02) / self.drawers as f32;
        let mut pulled = Vec::new();
        for k in 0..self.drawers {
            let z = [low + 0.01 + h * k as f32 + 0.002, low + 0.01 + h * (k + 1) as f32 - 0.002];
            let face = board([0.006 - half, inner + 0.0004, z[0]], [half - 0.006, inner + 0.02, z[1]], 0.003);
            let from = b.part_count();
            b.part(&object, &format!("drawer_{}", k + 1), face, self.finish);
            let at = Vec3::new(0.0, inner + 0.026, z[1] - 0.05);
            let grip = rounded_box(Vec3::new(0.13, 0.014, 0.02), 0.005, 3).moved(at);
            let frame = board([-0.035, inner + 0.0198, z[1] - 0.105], [0.035, inner + 0.022, z[1] - 0.078], 0.0006);
            b.part(&object, &format!("pull_{}", k + 1), grip.with(frame), Finish::Aluminium);
            let rect = [0.006 - half, half - 0.006, z[0], z[1]];
            let name = format!("drawer_{}", k + 1);
            let joint = boxed(b, &object, &name, rect, inner + 0.0004, inner + front - 0.03, self.finish);
            pulled.push((name, joint, from..b.part_count()));
        }
        let lock = crate::pieces::form::to_front(cylinder(0.008, 0.004, 18));
        b.part(&object, "lock", lock.moved(Vec3::new(half - 0.04, inner + 0.0199, top - 0.045)), Finish::Chrome);
        let lock = b.part_count() - 1;
        for (k, (name, joint, parts)) in pulled.into_iter().enumerate() {
            // The lock is in the front of the uppermost drawer.
            let locked = (k + 1 == self.drawers).then_some(lock);
            b.joint(&object, &name, &joint, parts.chain(locked));
        }
    }
}
