//! A steel cabinet of an office, 80 to 120 cm wide and two, three or five binders high: with two doors or a tambour (class cabinet), or open
//! with rows of binders, as a family of its own (class shelves; each row is of class other prop).

use crate::builder::{Builder, Class, Object};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::form::all;
use crate::pieces::{CONTACT, Furniture, Surface, board, on};
use crate::shape::{Reshape, rounded_box};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec3};

/// A cabinet for binders.
#[derive(Clone, Copy, Debug)]
pub struct OfficeCabinet {
    /// Width.
    pub width: f32,
    /// Rows of binders above each other.
    pub rows: usize,
    /// The cabinet's front.
    pub front: CabinetFront,
    /// Finish of the sheet metal.
    pub finish: Finish,
}

/// The front of an office cabinet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CabinetFront {
    /// Two doors.
    Doors,
    /// Slats that slide into the sides.
    Tambour,
    /// None.
    Open,
}

/// Depth, metres.
const DEPTH: f32 = 0.43;
/// From one board to the next: binders are 32 cm high.
const ROW: f32 = 0.365;
/// Height of the plinth, metres.
const PLINTH: f32 = 0.06;
/// Thickness of boards, metres.
const BOARD: f32 = 0.02;

impl OfficeCabinet {
    /// An open one, with binders.
    pub fn open(rng: &mut Rng) -> Self {
        Self { front: CabinetFront::Open, ..Self::random(rng) }
    }

    fn height(&self) -> f32 {
        PLINTH + ROW * self.rows as f32 + BOARD
    }

    fn case(&self, b: &mut Builder, object: &Object) {
        let (x, y, top) = (0.5 * self.width, 0.5 * DEPTH, self.height());
        let front = if self.front == CabinetFront::Open { y } else { y - 0.032 };
        let mut boards = vec![
            board([-x, -y, PLINTH + 0.0002], [BOARD - x, front, top], 0.002),
            board([x - BOARD, -y, PLINTH + 0.0002], [x, front, top], 0.002),
            board([BOARD - x, 0.001 - y, PLINTH + 0.001], [x - BOARD, 0.012 - y, top - 0.002], 0.0005),
        ];
        for row in 0..=self.rows {
            let z = PLINTH + ROW * row as f32;
            boards.push(board([BOARD - x - 0.001, 0.011 - y, z], [x - BOARD + 0.001, front - 0.001, z + BOARD], 0.001));
        }
        b.part(object, "case", all(boards), self.finish);
        b.part(object, "plinth", board([0.02 - x, 0.02 - y, 0.0], [x - 0.02, y - 0.05, PLINTH], 0.001), Finish::BlackPlastic);
    }

    fn doors(&self, b: &mut Builder, object: &Object) {
        let (x, y, top) = (0.5 * self.width, 0.5 * DEPTH, self.height());
        let first = b.part_count();
        for (name, s) in [("left", -1.0f32), ("right", 1.0)] {
            let ends = [s * 0.0012, s * (x - 0.001)];
            let door = board([ends[0].min(ends[1]), y - 0.0318, PLINTH + 0.002], [ends[0].max(ends[1]), y - 0.012, top - 0.002], 0.0015);
            b.part(object, &format!("door_{name}"), door, self.finish);
        }
        let z = 0.5 * (top + PLINTH);
        let handle = rounded_box(Vec3::new(0.05, 0.018, 0.12), 0.006, 2).moved(Vec3::new(-0.04, y - 0.0105, z));
        b.part(object, "handle", handle, Finish::BlackPlastic);
        // The handle is on the left door.
        for (name, s, parts) in [("left", -1.0, vec![first, first + 2]), ("right", 1.0, vec![first + 1])] {
            b.joint(object, &format!("door_{name}"), &Joint::cupboard(s * (x - 0.001), y - 0.012, s), parts);
        }
    }

    fn tambour(&self, b: &mut Builder, object: &Object) {
        let (x, y, top) = (0.5 * self.width - BOARD, 0.5 * DEPTH, self.height());
        let step = 0.032;
        let count = (2.0 * x / step) as usize;
        let slat = |k: usize| {
            let from = -x + 2.0 * x * k as f32 / count as f32;
            rounded_box(Vec3::new(2.0 * x / count as f32 - 0.0012, 0.009, top - PLINTH - 0.024), 0.003, 2).moved(Vec3::new(
                from + x / count as f32,
                y - 0.0275,
                0.5 * (top + PLINTH),
            ))
        };
        b.part(
            object,
            "tambour",
            all((0..count).map(slat)),
            if self.finish == Finish::BlackMetal { Finish::BlackPlastic } else { self.finish },
        );
        let bars =
            [-1.0f32, 1.0].map(|s| board([s * 0.014 - 0.012, y - 0.024, PLINTH + 0.02], [s * 0.014 + 0.012, y - 0.009, top - 0.02], 0.003));
        b.part(object, "bars", all(bars), Finish::Aluminium);
    }

    fn binders(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let x = 0.5 * self.width - BOARD - 0.006;
        let families = [Finish::BlackPlastic, Finish::Plastic(2), Finish::Plastic(3), Finish::Plastic(0), Finish::Cardboard];
        let usual = families[rng.below(families.len())];
        for row in 0..self.rows {
            if rng.below(7) == 0 {
                continue;
            }
            let z = PLINTH + ROW * row as f32 + BOARD + CONTACT;
            let object = b.object("binders", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, z), 0.0));
            let end = x - 2.0 * x * [0.0, 0.05, 0.3, 0.55][rng.below(4)];
            let (mut at, mut count) = (-x, 0);
            loop {
                let width = [0.05, 0.08, 0.08][rng.below(3)];
                if at + width > end {
                    break;
                }
                count += 1;
                let finish = if rng.below(3) == 0 { families[rng.below(families.len())] } else { usual };
                let set_back = 0.5 * DEPTH - 0.05 - rng.range(0.0, 0.025);
                let [back, label] = binder(width).map(|mesh| mesh.moved(Vec3::new(at + 0.5 * width, set_back, 0.0)));
                b.part(&object, &format!("binder_{count:02}"), back, finish);
                b.part(&object, &format!("label_{count:02}"), label, Finish::Paper);
                at += width + 0.001;
            }
        }
    }
}

/// A binder that stands on z = 0 with its back at y = 0, and the label on it.
fn binder(width: f32) -> [Mesh; 2] {
    let back = rounded_box(Vec3::new(width - 0.001, 0.285, 0.317), 0.003, 1).moved(Vec3::new(0.0, -0.1425, 0.159));
    let label = board([-0.36 * width, -0.001, 0.12], [0.36 * width, 0.0006, 0.29], 0.0002);
    [back, label]
}

impl Furniture for OfficeCabinet {
    fn random(rng: &mut Rng) -> Self {
        Self {
            width: [0.8, 1.0, 1.2][rng.below(3)],
            rows: [2, 3, 5, 5][rng.below(4)],
            front: [CabinetFront::Doors, CabinetFront::Tambour][rng.below(2)],
            finish: [Finish::CoatedWhite, Finish::CoatedWhite, Finish::Wood, Finish::BlackMetal][rng.below(4)],
        }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, DEPTH, self.height())
    }

    fn reach(&self) -> f32 {
        0.5
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = 0.5 * self.size().truncate() - 0.03;
        if self.rows > 3 { Vec::new() } else { vec![Surface { min: -half, max: half, z: self.height(), headroom: f32::INFINITY }] }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let open = self.front == CabinetFront::Open;
        let object = if open { b.object("binder_shelf", Class::Shelves, pose) } else { b.object("office_cabinet", Class::Cabinet, pose) };
        self.case(b, &object);
        match self.front {
            CabinetFront::Doors => self.doors(b, &object),
            CabinetFront::Tambour => self.tambour(b, &object),
            CabinetFront::Open => self.binders(b, pose, rng),
        }
    }
}
