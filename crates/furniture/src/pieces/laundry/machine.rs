//! A front-loading washing machine or dryer, 60 cm wide, 85 cm high and 50 to 60 cm deep, of class other furniture, in white or steel. Its
//! door protrudes from the cabinet at +y; the back is towards the wall.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, to_front, turned};
use crate::pieces::{Furniture, Surface, board};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// The kind of machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaundryMachine {
    /// A clear door and a drawer for detergent.
    Washer,
    /// A dark door and a drawer for condensate.
    Dryer,
}

/// A front-loading washing machine or a dryer.
#[derive(Clone, Copy, Debug)]
pub struct WashingMachine {
    /// Whether it washes or dries.
    pub does: LaundryMachine,
    /// Depth of the cabinet.
    pub depth: f32,
    /// Finish of the cabinet.
    pub finish: Finish,
    /// Finish of the door's ring.
    pub ring: Finish,
}

/// Width, metres: machines are 60 cm wide and 85 cm high, to stand below a worktop.
const WIDTH: f32 = 0.598;
/// Height, metres.
const HEIGHT: f32 = 0.85;
/// Height of the door's middle, metres.
const DOOR: f32 = 0.46;
/// How far the door with its grip may protrude from the cabinet, metres.
const OUT: f32 = 0.045;
/// Depth inside the cabinet at which parts of the front begin, metres.
const SUNK: f32 = 0.001;

impl Furniture for WashingMachine {
    fn random(rng: &mut Rng) -> Self {
        let does = [LaundryMachine::Washer, LaundryMachine::Washer, LaundryMachine::Dryer][rng.below(3)];
        let finish = [Finish::CoatedWhite, Finish::CoatedWhite, Finish::CoatedWhite, Finish::Steel][rng.below(4)];
        let ring = [Finish::Chrome, Finish::WhitePlastic, Finish::BlackPlastic][rng.below(3)];
        Self { does, depth: rng.range(0.5, 0.6), finish, ring }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(WIDTH, self.depth + OUT, HEIGHT)
    }

    fn reach(&self) -> f32 {
        0.7
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = 0.5 * self.size().truncate();
        vec![Surface { min: -half, max: half - Vec2::Y * OUT, z: HEIGHT, headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let name = if self.does == LaundryMachine::Washer { "washing_machine" } else { "dryer" };
        let machine = b.object(name, Class::OtherFurniture, pose);
        let (x, rear) = (0.5 * WIDTH, -0.5 * self.size().y);
        let face = rear + self.depth;
        let body = rounded_box(Vec3::new(WIDTH, self.depth - 0.0005, HEIGHT - 0.04), 0.006, 2);
        b.part(&machine, "cabinet", body.moved(Vec3::new(0.0, rear + 0.5 * self.depth, 0.015 + 0.5 * (HEIGHT - 0.04))), self.finish);
        let top = rounded_box(Vec3::new(WIDTH, self.depth + 0.004, 0.0245), 0.006, 2);
        b.part(&machine, "top", top.moved(Vec3::new(0.0, rear + 0.5 * self.depth + 0.002, HEIGHT - 0.01225)), self.finish);
        let feet = [(-1.0f32, -1.0f32), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|(sx, sy)| {
            cylinder(0.02, 0.0155, 18).moved(Vec3::new(sx * (x - 0.06), rear + 0.5 * self.depth + sy * (0.5 * self.depth - 0.06), 0.0))
        });
        b.part(&machine, "feet", all(feet), Finish::Rubber);
        // The panel: drawer, dial and display.
        let (low, high) = (HEIGHT - 0.135, HEIGHT - 0.03);
        let drawer = board([-x + 0.02, face - 0.002, low], [-x + 0.20, face + 0.006, high], 0.003);
        b.part(&machine, "drawer", drawer, if self.finish == Finish::Steel { Finish::Steel } else { Finish::WhitePlastic });
        b.part(
            &machine,
            "drawer_grip",
            board([-x + 0.07, face + 0.0055, low + 0.012], [-x + 0.15, face + 0.0068, low + 0.034], 0.0006),
            Finish::BlackPlastic,
        );
        let dial = [[0.0, 0.0], [0.034, 0.0], [0.034, 0.004], [0.027, 0.007], [0.025, 0.024], [0.022, 0.027], [0.0, 0.027]];
        b.part(&machine, "dial", to_front(turned(&dial, 40)).moved(Vec3::new(0.0, face - SUNK, 0.5 * (low + high))), self.ring);
        b.part(&machine, "display", board([0.07, face - SUNK, low + 0.025], [0.19, face + 0.0015, high - 0.02], 0.0008), Finish::Screen);
        let keys = (0..4).map(|k| to_front(cylinder(0.006, 0.004, 14)).moved(Vec3::new(0.085 + 0.03 * k as f32, face - SUNK, low + 0.010)));
        b.part(&machine, "keys", all(keys), Finish::BlackPlastic);
        self.door(b, &machine, face, rng);
        let flap = board([x - 0.15, face - SUNK, 0.05], [x - 0.04, face + 0.0015, 0.125], 0.001);
        b.part(&machine, "flap", flap, if self.finish == Finish::Steel { Finish::Steel } else { Finish::WhitePlastic });
    }
}

impl WashingMachine {
    fn door(&self, b: &mut Builder, machine: &crate::builder::Object, face: f32, rng: &mut Rng) {
        let at = Vec3::new(0.0, face - SUNK, DOOR);
        let place = |profile: &[[f32; 2]]| to_front(turned(profile, 64)).moved(at);
        let ring =
            [[0.145, 0.0], [0.225, 0.0], [0.228, 0.006], [0.215, 0.026], [0.195, 0.034], [0.165, 0.032], [0.148, 0.022], [0.145, 0.0]];
        b.part(machine, "door", place(&ring), self.ring);
        let glass = [[0.0, 0.002], [0.147, 0.002], [0.147, 0.022], [0.13, 0.028], [0.08, 0.030], [0.0, 0.028]];
        b.part(machine, "window", place(&glass), Finish::GlossBlack);
        let grip = rounded_box(Vec3::new(0.022, 0.02, 0.09), 0.007, 3);
        b.part(machine, "grip", grip.moved(at + Vec3::new(-0.196, 0.034, 0.0)), if rng.below(2) == 0 { Finish::Chrome } else { self.ring });
        if self.does == LaundryMachine::Dryer {
            // Slots of the heat exchanger's grille.
            let slots = (0..9)
                .map(|k| board([-0.24 + 0.03 * k as f32, face - SUNK, 0.06], [-0.225 + 0.03 * k as f32, face + 0.0012, 0.12], 0.0006));
            b.part(machine, "grille", all(slots), Finish::BlackPlastic);
        } else {
            let marks = (0..12).map(|k| {
                let p = Vec2::from_angle(TAU * k as f32 / 12.0) * 0.043;
                to_front(cylinder(0.0014, 0.0018, 8)).moved(Vec3::new(p.x, face - SUNK, HEIGHT - 0.0825 + p.y))
            });
            b.part(machine, "marks", all(marks), Finish::BlackPlastic);
        }
    }
}
