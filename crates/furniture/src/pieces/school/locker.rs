//! A row of lockers of sheet metal, two to five columns of 30 cm with one to three doors above each other, 1.85 m high, class cabinet; doors
//! have slots above and below, a plate with a number and a lock.

use crate::builder::{Builder, Class, Object};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, to_front};
use crate::pieces::joinery::hollow_box;
use crate::pieces::{Furniture, board};
use crate::shape::Reshape;
use enfilade_geometry::Mesh;
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
        b.part(&object, "case", self.case(b.has_joints()), self.case);
        b.part(&object, "base", board([0.01 - x, 0.01 - y, 0.0], [x - 0.01, y - 0.05, BASE + 0.001], 0.001), Finish::BlackMetal);
        let mut fittings = Vec::new();
        for column in 0..self.columns {
            for tier in 0..self.tiers {
                let [at, z, step] = self.place(column, tier);
                let name = format!("door_{}_{}", column + 1, tier + 1);
                let door = board([at - 0.145, y - 0.0198, z + 0.004], [at + 0.145, y - 0.004, z + step - 0.004], 0.0025);
                let from = b.part_count();
                b.part(&object, &name, door, self.doors);
                let own = Fittings::of(at, y, z, step);
                if b.has_joints() {
                    own.add(b, &object, &format!("{name}_"));
                    // The lock is at the left edge, the hinges are at the right one.
                    b.joint(&object, &name, &Joint::cupboard(at + 0.145, y - 0.004, 1.0), from..b.part_count());
                } else {
                    fittings.push(own);
                }
            }
        }
        if !fittings.is_empty() {
            Fittings::joined(fittings).add(b, &object, "");
        }
    }
}

impl Lockers {
    /// Middle (x) of a locker, its lower end and its height.
    fn place(&self, column: usize, tier: usize) -> [f32; 3] {
        let step = (HEIGHT - BASE - 0.02) / self.tiers as f32;
        [COLUMN * (column as f32 - 0.5 * (self.columns - 1) as f32), BASE + 0.01 + step * tier as f32, step]
    }

    /// The case: a solid, or a box behind each door where they open, between walls at either end.
    fn case(&self, hollow: bool) -> Mesh {
        let (x, y) = (0.5 * self.size().x, 0.5 * DEPTH);
        if !hollow {
            return board([-x, -y, BASE], [x, y - 0.02, HEIGHT], 0.002);
        }
        /// Thickness of sheet metal with its folds, metres.
        const SHEET: f32 = 0.006;
        let boxes = (0..self.columns).flat_map(|column| (0..self.tiers).map(move |tier| (column, tier))).map(|(column, tier)| {
            let [at, z, step] = self.place(column, tier);
            hollow_box([at - 0.1499, -y, z + 0.0001], [at + 0.1499, y - 0.02, z + step - 0.0001], SHEET)
        });
        let ends = [-1.0f32, 1.0].map(|s| board([s * (x - 0.005) - 0.005, -y, BASE], [s * (x - 0.005) + 0.005, y - 0.02, HEIGHT], 0.001));
        let level = |z: f32| board([0.0102 - x, -y, z], [x - 0.0102, y - 0.02, z + 0.01], 0.001);
        all(boxes.chain(ends).chain([level(BASE), level(HEIGHT - 0.01)]))
    }
}

/// What is on a door: slots above and below, a lock, and a plate for its number.
struct Fittings([Vec<Mesh>; 3]);

impl Fittings {
    /// Fittings of a door about x = `at` whose face is 4 mm behind `y`, over a height of `step` from `z`.
    fn of(at: f32, y: f32, z: f32, step: f32) -> Self {
        let slot = |k: usize, from: f32| {
            board([at - 0.07, y - 0.0046, from + 0.022 * k as f32], [at + 0.07, y - 0.0032, from + 0.022 * k as f32 + 0.007], 0.0004)
        };
        let slots = (0..4).flat_map(|k| [slot(k, z + 0.05), slot(k, z + step - 0.13)]).collect();
        let lock = to_front(cylinder(0.014, 0.006, 20)).moved(Vec3::new(at - 0.115, y - 0.0045, z + 0.5 * step));
        let plate = board([at - 0.025, y - 0.0046, z + step - 0.19], [at + 0.025, y - 0.0032, z + step - 0.165], 0.0003);
        Self([slots, vec![lock], vec![plate]])
    }

    /// Fittings of several doors together.
    fn joined(all: Vec<Self>) -> Self {
        let mut joined = [Vec::new(), Vec::new(), Vec::new()];
        for own in all {
            joined.iter_mut().zip(own.0).for_each(|(all, own)| all.extend(own));
        }
        Self(joined)
    }

    fn add(self, b: &mut Builder, object: &Object, prefix: &str) {
        let kinds = [("slots", Finish::BlackPlastic), ("locks", Finish::Chrome), ("plates", Finish::Paper)];
        for ((name, finish), meshes) in kinds.into_iter().zip(self.0) {
            b.part(object, &format!("{prefix}{name}"), all(meshes), finish);
        }
    }
}
