//! Sofas and easy chairs with an open frame of wood, rattan or metal tube, on which loose cushions lie: seat and back are slats between two
//! sides, and the back leans by 14 to 20°. One seat is 58 to 66 cm wide.

use super::quilt::upright;
use super::styles::{Frame, Sides};
use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, rod};
use crate::pieces::{CONTACT, board, grained, standing};
use crate::shape::{Reshape, padded_box, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A sofa or easy chair with an open frame.
#[derive(Clone, Copy, Debug)]
pub struct OpenFrame {
    /// The sides.
    pub sides: Sides,
    /// Finish of the frame.
    pub finish: Finish,
    /// Finish of the cushions.
    pub cloth: Finish,
    /// Places to sit: one is an easy chair.
    pub seats: usize,
    /// Width of one seat.
    pub seat_width: f32,
    /// One mattress over all seats, as on a sofa bed, instead of cushions.
    pub bench: bool,
    /// Backward lean of the back, radians.
    pub lean: f32,
}

/// Depth from the front legs to the top of the leaning back, metres.
const DEPTH: f32 = 0.84;
/// Height of the slats below the cushions, metres.
const SLATS: f32 = 0.29;
/// Height of the arms' upper sides, metres.
const ARM: f32 = 0.59;
/// Position of the back's foot, metres.
const HINGE: f32 = -0.2;
/// Length of the back from its foot, metres.
const BACK: f32 = 0.55;
/// Half the width of a side, metres.
const SIDE: f32 = 0.032;

impl OpenFrame {
    /// One of this style, for `seats` people.
    pub fn of((sides, finish, cloths, bench): Frame, seats: usize, rng: &mut Rng) -> Self {
        let cloth = cloths[rng.below(cloths.len())];
        Self { sides, finish, cloth, seats, seat_width: rng.range(0.56, 0.66), bench, lean: rng.range(0.25, 0.35) }
    }

    fn inner(&self) -> f32 {
        self.seats as f32 * self.seat_width
    }

    /// Size of the box around it.
    pub fn size(&self) -> Vec3 {
        Vec3::new(self.inner() + 4.0 * SIDE + 0.004, DEPTH, SLATS + BACK + 0.09)
    }

    /// Adds its parts, as an object of `family`.
    pub fn build(&self, b: &mut Builder, family: &str, pose: DAffine3, rng: &mut Rng) {
        let object = b.object(family, if self.seats == 1 { Class::Chair } else { Class::Sofa }, pose);
        let x = 0.5 * self.inner() + SIDE;
        for (name, s) in [("side_left", -1.0f32), ("side_right", 1.0)] {
            b.part(&object, name, grained(self.side().moved(Vec3::new(s * x, 0.0, 0.0)), rng), self.finish);
        }
        let round = matches!(self.sides, Sides::Hoops | Sides::Sticks);
        let bar = |y: f32, z: f32, r: f32| {
            if round { rod([-x, y, z], [x, y, z], r, 12) } else { board([-x, y - r, z - r], [x, y + r, z + r], 0.003) }
        };
        let rails = [bar(0.33, SLATS - 0.026, 0.016), bar(HINGE - 0.03, SLATS - 0.026, 0.016)];
        b.part(&object, "rails", grained(all(rails), rng), self.finish);
        let count = (self.inner() / 0.1) as usize;
        let slat = |k: usize| {
            let at = (k as f32 + 0.5) / count as f32 * self.inner() - 0.5 * self.inner();
            board([at - 0.022, HINGE - 0.04, SLATS - 0.0098], [at + 0.022, 0.34, SLATS], 0.002)
        };
        b.part(&object, "slats", grained(all((0..count).map(slat)), rng), self.finish);
        b.part(&object, "back", grained(self.back(x, round), rng), self.finish);
        self.cushions(b, &object, rng);
    }

    /// A point of the back's plane, `up` from its foot along it and `out` before it.
    fn on_back(&self, x: f32, up: f32, out: f32) -> Vec3 {
        let (sin, cos) = self.lean.sin_cos();
        Vec3::new(x, HINGE - up * sin + out * cos, SLATS - 0.03 + up * cos + out * sin)
    }

    fn back(&self, x: f32, round: bool) -> Mesh {
        let bar = |up: f32, r: f32| tube(&[self.on_back(-x, up, 0.0), self.on_back(x, up, 0.0)], r, if round { 12 } else { 4 });
        let count = (self.inner() / if self.sides == Sides::Sticks { 0.06 } else { 0.12 }) as usize;
        let stick = |k: usize| {
            let at = ((k as f32 + 0.5) / count as f32 - 0.5) * self.inner();
            tube(&[self.on_back(at, 0.04, 0.0), self.on_back(at, BACK, 0.0)], 0.008, 8)
        };
        let posts = [-1.0f32, 1.0].map(|s| tube(&[self.on_back(s * x, -0.02, 0.0), self.on_back(s * x, BACK + 0.01, 0.0)], 0.015, 12));
        all((0..count).map(stick).chain(posts).chain([bar(0.05, 0.014), bar(BACK, 0.016)]))
    }

    /// One side in the plane x = 0.
    fn side(&self) -> Mesh {
        let post = |y: [f32; 2], z: [f32; 2], r: f32| standing(tube(&[Vec3::new(0.0, y[0], z[0]), Vec3::new(0.0, y[1], z[1])], r, 12));
        let [front, rear] = [0.36f32, -0.33];
        match self.sides {
            Sides::Planks => all([
                post([front + 0.02, front - 0.02], [0.0, ARM - 0.01], 0.018),
                post([rear - 0.06, rear], [0.0, ARM - 0.01], 0.018),
                board([-SIDE, rear - 0.06, ARM - 0.024], [SIDE, front + 0.05, ARM], 0.006),
                board([-0.012, rear - 0.02, SLATS - 0.055], [0.012, front, SLATS - 0.012], 0.003),
            ]),
            Sides::Slats => {
                let square = |y: f32, r: f32, z: [f32; 2]| board([-r, y - r, z[0]], [r, y + r, z[1]], 0.003);
                let slats = (1..7).map(|k| {
                    let y = rear + (front - rear) * k as f32 / 7.0;
                    board([-0.007, y - 0.022, 0.1], [0.007, y + 0.022, ARM - 0.02], 0.002)
                });
                let rails =
                    [[0.075, 0.125], [SLATS - 0.055, SLATS - 0.012]].map(|[z0, z1]| board([-0.011, rear, z0], [0.011, front, z1], 0.003));
                let rest = board([-SIDE, rear - 0.05, ARM - 0.022], [SIDE, front + 0.05, ARM], 0.004);
                all(slats.chain(rails).chain([square(front, 0.024, [0.0, ARM - 0.01]), square(rear, 0.024, [0.0, ARM - 0.01]), rest]))
            }
            Sides::Hoops | Sides::Sticks => {
                let r = if self.sides == Sides::Hoops { 0.014 } else { 0.018 };
                let hoop = hoop(front, rear - 0.04, ARM - r);
                let mut parts =
                    vec![standing(tube(&hoop, r, 14)), rod([0.0, rear - 0.03, SLATS - 0.026], [0.0, front, SLATS - 0.026], r, 12)];
                if self.sides == Sides::Sticks {
                    parts.extend((1..9).map(|k| {
                        let y = rear + (front - rear) * k as f32 / 9.0;
                        rod([0.0, y, SLATS - 0.03], [0.0, y, ARM - r], 0.007, 8)
                    }));
                }
                all(parts)
            }
            Sides::Rockers => {
                let runner: Vec<Vec3> = (0..=16)
                    .map(|k| {
                        let t = k as f32 / 8.0 - 1.0;
                        Vec3::new(0.0, 0.4 * t, 0.016 + 0.075 * t * t)
                    })
                    .collect();
                all([
                    tube(&runner, 0.016, 12),
                    post([0.27, 0.25], [0.045, ARM - 0.01], 0.018),
                    post([-0.27, -0.25], [0.045, ARM - 0.01], 0.018),
                    board([-SIDE, rear, ARM - 0.024], [SIDE, 0.32, ARM], 0.006),
                    board([-0.012, -0.3, SLATS - 0.055], [0.012, 0.34, SLATS - 0.012], 0.003),
                ])
            }
        }
    }

    fn cushions(&self, b: &mut Builder, object: &Object, rng: &mut Rng) {
        let (count, fat) = (if self.bench { 1 } else { self.seats }, if self.bench { 0.13 } else { 0.11 });
        let wide = self.inner() / count as f32;
        let (depth, tall) = (0.56, 0.46);
        for k in 0..count {
            let x = (k as f32 + 0.5) * wide - 0.5 * self.inner();
            let seat = padded_box(Vec3::new(wide - 0.01, depth, fat), 0.045, 0.016).uv_moved(Vec2::splat(rng.next_f32()));
            // The padding swells into the gaps between the slats.
            b.part(object, &format!("seat_cushion_{}", k + 1), seat.moved(Vec3::new(x, 0.085, SLATS + CONTACT + 0.5 * fat)), self.cloth);
            let back = padded_box(Vec3::new(wide - 0.012, tall, fat), 0.045, 0.024);
            let back = upright(back).turned(Vec3::X, self.lean).uv_moved(Vec2::splat(rng.next_f32()));
            let at = self.on_back(x, 0.145 + 0.5 * tall, 0.5 * fat + 0.026);
            b.part(object, &format!("back_cushion_{}", k + 1), back.moved(at), self.cloth);
        }
    }
}

/// A path from the floor up, along the arm and down to the floor again, its corners round.
fn hoop(front: f32, rear: f32, top: f32) -> Vec<Vec3> {
    const R: f32 = 0.09;
    let arc = |center: [f32; 2], from: f32| {
        (0..=6).map(move |k| {
            let (sin, cos) = (from + k as f32 / 6.0 * std::f32::consts::FRAC_PI_2).sin_cos();
            Vec3::new(0.0, center[0] + R * cos, center[1] + R * sin)
        })
    };
    let corner = std::f32::consts::FRAC_PI_2;
    let mut path = vec![Vec3::new(0.0, front, 0.0)];
    path.extend(arc([front - R, top - R], 0.0));
    path.extend(arc([rear + R, top - R], corner));
    path.push(Vec3::new(0.0, rear, 0.0));
    path
}
