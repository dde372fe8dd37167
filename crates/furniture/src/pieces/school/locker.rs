//! A row of lockers of sheet metal, two to five columns of 30 cm with one to three doors above each other, 1.85 m high, class cabinet; doors
//! have slots above and below, a plate with a number and a lock.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, to_front};
use crate::pieces::{Furniture, board};
use crate::shape::Reshape;
use enfilade_math::{DAffine3, Rng, Vec3};

/// A row of lockers.
#[derive(Clone, Copy, Debug)]
pub struct Lockers {
    /// Columns beside each other.
    pub columns: usize,
    /// Doors above each other.
    pub tiers: usize,
    /// Finish of the doors.
    pub doors: Finish,
    /// Finish of the case.
    pub case: Finish,
}

/// Width of a column, depth, height and height of the base, metres.
const COLUMN: f32 = 0.3;
const DEPTH: f32 = 0.48;
const HEIGHT: f32 = 1.85;
const BASE: f32 = 0.1;

impl Furniture for Lockers {
    fn random(rng: &mut Rng) -> Self {
        let doors = [Finish::ColoredMetal(rng.below(4) as u8), Finish::ColoredMetal(1), Finish::CoatedWhite, Finish::Wood][rng.below(4)];
        Self { columns: 2 + rng.below(4), tiers: 1 + rng.below(3), doors, case: [Finish::CoatedWhite, Finish::BlackMetal][rng.below(2)] }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(COLUMN * self.columns as f32 + 0.02, DEPTH, HEIGHT)
    }

    fn reach(&self) -> f32 {
        0.55
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("lockers", Class::Cabinet, pose);
        let (x, y) = (0.5 * self.size().x, 0.5 * DEPTH);
        b.part(&object, "case", board([-x, -y, BASE], [x, y - 0.02, HEIGHT], 0.002), self.case);
        b.part(&object, "base", board([0.01 - x, 0.01 - y, 0.0], [x - 0.01, y - 0.05, BASE + 0.001], 0.001), Finish::BlackMetal);
        let step = (HEIGHT - BASE - 0.02) / self.tiers as f32;
        let (mut slots, mut locks, mut plates) = (Vec::new(), Vec::new(), Vec::new());
        for column in 0..self.columns {
            let at = COLUMN * (column as f32 - 0.5 * (self.columns - 1) as f32);
            for tier in 0..self.tiers {
                let z = BASE + 0.01 + step * tier as f32;
                let door = board([at - 0.145, y - 0.0198, z + 0.004], [at + 0.145, y - 0.004, z + step - 0.004], 0.0025);
                b.part(&object, &format!("door_{}_{}", column + 1, tier + 1), door, self.doors);
                let slot = |k: usize, from: f32| {
                    board(
                        [at - 0.07, y - 0.0046, from + 0.022 * k as f32],
                        [at + 0.07, y - 0.0032, from + 0.022 * k as f32 + 0.007],
                        0.0004,
                    )
                };
                slots.extend((0..4).flat_map(|k| [slot(k, z + 0.05), slot(k, z + step - 0.13)]));
                locks.push(to_front(cylinder(0.014, 0.006, 20)).moved(Vec3::new(at - 0.115, y - 0.0045, z + 0.5 * step)));
                plates.push(board([at - 0.025, y - 0.0046, z + step - 0.19], [at + 0.025, y - 0.0032, z + step - 0.165], 0.0003));
            }
        }
        b.part(&object, "slots", all(slots), Finish::BlackPlastic);
        b.part(&object, "locks", all(locks), Finish::Chrome);
        b.part(&object, "plates", all(plates), Finish::Paper);
    }
}
