//! A screen between desks, 1.2 to 1.5 m high on two feet, of class other structure: felt in a frame of aluminium, sometimes with glass above,
//! or one pane of glass.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::all;
use crate::pieces::{Furniture, board};
use crate::shape::{Reshape, picture_frame, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec3};

/// A screen between desks; it is the same from both sides.
#[derive(Clone, Copy, Debug)]
pub struct Partition {
    /// Width over its frame.
    pub width: f32,
    /// Height above the floor.
    pub height: f32,
    /// Where it is of glass.
    pub glazing: Glazing,
    /// Finish of its cloth.
    pub cloth: Finish,
}

/// Where a screen is of glass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Glazing {
    /// Nowhere.
    None,
    /// The uppermost 30 cm, frosted.
    Upper,
    /// All within the frame: clear, frosted or tinted.
    Whole(Finish),
}

/// Thickness of its frame, and the height of the panel's lower edge above the floor, metres.
const THICK: f32 = 0.036;
const BELOW: f32 = 0.04;
/// Length of its feet across, and half the distance between them, metres: they are where the knees of those who sit at desks are, not below
/// drawers.
const FEET: f32 = 0.3;
const FEET_APART: f32 = 0.17;
/// Height of its glass, metres.
const GLASS: f32 = 0.3;

impl Furniture for Partition {
    fn random(rng: &mut Rng) -> Self {
        Self {
            width: rng.range(1.2, 1.8),
            height: rng.range(1.2, 1.5),
            glazing: [
                Glazing::None,
                Glazing::None,
                Glazing::Upper,
                Glazing::Whole([Finish::Glass, Finish::FrostedGlass, Finish::TintedGlass][rng.below(3)]),
            ][rng.below(4)],
            cloth: [Finish::Felt, Finish::SofaCloth, Finish::ArmchairCloth][rng.below(3)],
        }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, FEET, self.height)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("partition", Class::OtherStructure, pose);
        let (h, half) = (self.height - BELOW, 0.5 * THICK);
        let middle = Vec3::new(0.0, 0.0, BELOW + 0.5 * h);
        let frame = picture_frame(self.width, h, &[[0.0, -half], [0.0, half], [0.022, half], [0.022, -half]]).moved(middle);
        let feet = [-1.0f32, 1.0].map(|s| {
            let x = s * FEET_APART;
            rounded_box(Vec3::new(0.05, FEET, 0.012), 0.004, 2).moved(Vec3::new(x, 0.0, 0.006)).with(board(
                [x - 0.012, -0.012, 0.0118],
                [x + 0.012, 0.012, BELOW + 0.004],
                0.002,
            ))
        });
        b.part(&object, "frame", frame.with(all(feet)), Finish::Aluminium);
        let x = 0.5 * self.width - 0.02;
        let pane = |low: f32, high: f32| crate::pieces::form::picture(2.0 * x, high - low).moved(Vec3::new(0.0, 0.0, 0.5 * (low + high)));
        if let Glazing::Whole(glass) = self.glazing {
            return b.part(&object, "pane", pane(BELOW + 0.02, self.height - 0.02), glass);
        }
        let glazed = self.glazing == Glazing::Upper;
        let top = if glazed { self.height - GLASS } else { self.height - 0.02 };
        b.part(&object, "panel", board([-x, 0.004 - half, BELOW + 0.02], [x, half - 0.004, top], 0.002), self.cloth);
        if glazed {
            b.part(&object, "rail", board([-x, -half, top + 0.0002], [x, half, top + 0.018], 0.002), Finish::Aluminium);
            b.part(&object, "pane", pane(top + 0.016, self.height - 0.018), Finish::FrostedGlass);
        }
    }
}
