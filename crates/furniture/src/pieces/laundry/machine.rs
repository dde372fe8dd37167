//! A front-loading washing machine or dryer, 60 cm wide, 85 cm high and 50 to 60 cm deep, of class other furniture, in white or steel. Its
//! door protrudes from the cabinet at +y; the back is towards the wall.

use crate::builder::{Builder, Class, Object};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, to_front, turned};
use crate::pieces::joinery::{INSIDE, hollow_box, pull};
use crate::pieces::{Furniture, Surface, board};
use crate::shape::{Reshape, grid, rounded_box};
use enfilade_geometry::Mesh;
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
/// Radius of the hole behind the door, metres.
const HOLE: f32 = 0.175;
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
        if b.has_joints() {
            self.inside(b, &machine, [rear, face]);
        } else {
            b.part(&machine, "cabinet", body.moved(Vec3::new(0.0, rear + 0.5 * self.depth, 0.015 + 0.5 * (HEIGHT - 0.04))), self.finish);
        }
        let top = rounded_box(Vec3::new(WIDTH, self.depth + 0.004, 0.0245), 0.006, 2);
        b.part(&machine, "top", top.moved(Vec3::new(0.0, rear + 0.5 * self.depth + 0.002, HEIGHT - 0.01225)), self.finish);
        let feet = [(-1.0f32, -1.0f32), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|(sx, sy)| {
            cylinder(0.02, 0.0155, 18).moved(Vec3::new(sx * (x - 0.06), rear + 0.5 * self.depth + sy * (0.5 * self.depth - 0.06), 0.0))
        });
        b.part(&machine, "feet", all(feet), Finish::Rubber);
        // The panel: drawer, dial and display.
        let (low, high) = (HEIGHT - 0.135, HEIGHT - 0.03);
        let from = b.part_count();
        let drawer = board([-x + 0.02, face - 0.002, low], [-x + 0.20, face + 0.006, high], 0.003);
        b.part(&machine, "drawer", drawer, if self.finish == Finish::Steel { Finish::Steel } else { Finish::WhitePlastic });
        b.part(
            &machine,
            "drawer_grip",
            board([-x + 0.07, face + 0.0055, low + 0.012], [-x + 0.15, face + 0.0068, low + 0.034], 0.0006),
            Finish::BlackPlastic,
        );
        pull(b, &machine, "drawer", from, [-x + 0.02, -x + 0.20, low, high], face - 0.002, 0.2, Finish::WhitePlastic);
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
    /// The cabinet of a machine that can be opened, between two depths: a hole in its front leads into the drum.
    fn inside(&self, b: &mut Builder, machine: &Object, [rear, face]: [f32; 2]) {
        let (x, [low, high], sheet) = (0.5 * WIDTH, [0.015, HEIGHT - 0.025], 0.02);
        b.part(machine, "cabinet", hollow_box([-x, rear, low], [x, face - sheet - 0.0002, high], INSIDE), self.finish);
        b.part(machine, "front", plate_with_hole([-x, x, low, high], [face - sheet, face - 0.0003], DOOR, HOLE), self.finish);
        let (wall, deep) = (0.004, 0.3);
        let drum = turned(&[[0.0, 0.0], [HOLE, 0.0], [HOLE, deep], [HOLE - wall, deep], [HOLE - wall, wall], [0.0, wall]], 64);
        b.part(machine, "drum", to_front(drum).moved(Vec3::new(0.0, face - sheet - deep - 0.0004, DOOR)), Finish::Steel);
    }

    fn door(&self, b: &mut Builder, machine: &Object, face: f32, rng: &mut Rng) {
        let at = Vec3::new(0.0, face - SUNK, DOOR);
        let place = |profile: &[[f32; 2]]| to_front(turned(profile, 64)).moved(at);
        let ring =
            [[0.145, 0.0], [0.225, 0.0], [0.228, 0.006], [0.215, 0.026], [0.195, 0.034], [0.165, 0.032], [0.148, 0.022], [0.145, 0.0]];
        let from = b.part_count();
        b.part(machine, "door", place(&ring), self.ring);
        let glass = [[0.0, 0.002], [0.147, 0.002], [0.147, 0.022], [0.13, 0.028], [0.08, 0.030], [0.0, 0.028]];
        b.part(machine, "window", place(&glass), Finish::GlossBlack);
        let grip = rounded_box(Vec3::new(0.022, 0.02, 0.09), 0.007, 3);
        b.part(machine, "grip", grip.moved(at + Vec3::new(-0.196, 0.034, 0.0)), if rng.below(2) == 0 { Finish::Chrome } else { self.ring });
        b.joint(machine, "door", &Joint::cupboard(0.23, face + OUT, 1.0), from..b.part_count());
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

/// A plate over the xz rectangle `[x0, x1, z0, z1]`, between two depths, with a round hole about (0, `middle`).
fn plate_with_hole([x0, x1, z0, z1]: [f32; 4], y: [f32; 2], middle: f32, radius: f32) -> Mesh {
    const STEPS: usize = 64;
    let corners = [[x1, z1], [x0, z1], [x0, z0], [x1, z0]].map(|[x, z]| (z - middle).atan2(x).rem_euclid(TAU));
    let mut angles: Vec<f32> = (0..STEPS).map(|k| TAU * k as f32 / STEPS as f32).chain(corners).collect();
    angles.sort_by(f32::total_cmp);
    let n = angles.len();
    // Around the hole: on the front out to the rim, to the rear, and back.
    let point = |i: usize, j: usize| {
        let way = Vec2::from_angle(angles[i % n]);
        let reach = |way: f32, low: f32, high: f32| {
            if way > 0.0 {
                high / way
            } else if way < 0.0 {
                low / way
            } else {
                f32::INFINITY
            }
        };
        let rim = reach(way.x, x0, x1).min(reach(way.y, z0 - middle, z1 - middle));
        let p = way * if j == 1 || j == 2 { rim } else { radius };
        let depth = if j == 2 || j == 3 { y[0] } else { y[1] };
        Vec3::new(p.x, depth, middle + p.y)
    };
    grid(n, 4, point, |i, j| Vec2::new(point(i, j).x, point(i, j).z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::volume;

    #[test]
    fn a_plate_with_a_hole_is_closed_and_faces_outward() {
        let mesh = plate_with_hole([-0.3, 0.3, 0.0, 0.8], [0.1, 0.12], 0.46, 0.175);
        let expected = 0.02 * (0.6 * 0.8 - std::f32::consts::PI * 0.175 * 0.175);
        assert!((volume(&mesh) - expected).abs() < 0.002 * expected, "{}", volume(&mesh));
    }
}
