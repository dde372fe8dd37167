//! A chesterfield: a low sofa of two or three seats (class sofa), or a club chair (class chair), whose buttoned back and arms end in rolls
//! of one height. All of it is covered with one leather or cloth; feet are of dark wood, nails of brass. The buttons are set in a diamond
//! pattern.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, turned};
use crate::pieces::{CONTACT, Furniture};
use crate::shape::{Reshape, grid, padded_box, rounded_box, sphere};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::PI;

/// A low sofa or armchair whose buttoned back runs into rolled arms of the same height.
#[derive(Clone, Copy, Debug)]
pub struct Chesterfield {
    /// Places to sit: one to three.
    pub seats: usize,
    /// Finish of all but feet and nails.
    pub cover: Finish,
}

/// Depth from the back roll to the front of the arms, metres.
const DEPTH: f32 = 0.92;
/// Height of back and arms, metres.
const TOP: f32 = 0.73;
/// Height of the seat, metres.
const SEAT: f32 = 0.43;
/// Height of the seat cushions, metres.
const CUSHION: f32 = 0.15;
/// Distance of the padding's lower edge below the seat, metres: the cushions hide it.
const BELOW_SEAT: f32 = 0.06;
/// Height of the feet, metres.
const LEG: f32 = 0.09;
/// Radius of the rolls, metres.
const ROLL: f32 = 0.085;
/// Thickness of back and arms below their rolls, metres.
const WALL: f32 = 0.16;
/// Distance from button to button, along and up, metres.
const PITCH: [f32; 2] = [0.17, 0.11];

impl Chesterfield {
    fn inner(&self) -> f32 {
        if self.seats == 1 { 0.62 } else { 0.58 * self.seats as f32 }
    }

    /// Depth of the quilting at a point of the padding: 0 at a button, 1 between them.
    fn quilt(u: f32, v: f32) -> f32 {
        let (a, c) = (u / PITCH[0] + v / (2.0 * PITCH[1]), u / PITCH[0] - v / (2.0 * PITCH[1]));
        let ridge = |t: f32| (PI * t).sin().abs();
        (ridge(a) * ridge(c)).powf(0.45)
    }

    /// The padding along `length`: from the seat up the inside, over the roll and down behind it; x along, inside towards +y.
    fn padding(length: f32) -> Mesh {
        let (nu, nv) = ((length / 0.02) as usize, 34);
        let straight = TOP - ROLL - SEAT + BELOW_SEAT;
        let arc = ROLL * 1.55 * PI;
        let point = |i: usize, j: usize| {
            let u = (i as f32 / nu as f32 - 0.5) * length;
            let s = j as f32 / nv as f32 * (straight + arc);
            let ends = ((0.5 * length - u.abs()) / 0.05).clamp(0.0, 1.0);
            let depth = 0.022 * (Self::quilt(u, s) - 1.0) * ends * (1.0 - ((s - straight) / (0.6 * arc)).clamp(0.0, 1.0));
            let (center, normal) = if s < straight {
                (Vec2::new(0.0, SEAT - BELOW_SEAT + s), Vec2::X)
            } else {
                let a = (s - straight) / ROLL;
                let d = Vec2::new(a.cos(), a.sin());
                (Vec2::new(-ROLL, TOP - ROLL) + d * ROLL, d)
            };
            let p = center + normal * depth;
            Vec3::new(-u, p.x, p.y)
        };
        grid(nu, nv, point, |i, j| Vec2::new(i as f32 / nu as f32 * length, j as f32 * 0.02)).smoothed(70.0)
    }

    /// Buttons of [`Self::padding`].
    fn buttons(length: f32) -> Mesh {
        let straight = TOP - ROLL - SEAT + BELOW_SEAT;
        let rows = (straight / PITCH[1]) as usize;
        let places = (0..=rows).flat_map(|row| {
            let v = PITCH[1] * row as f32;
            let offset = if row % 2 == 0 { 0.0 } else { 0.5 * PITCH[0] };
            let count = (0.5 * length / PITCH[0]) as i32 + 1;
            (-count..=count).map(move |k| Vec2::new(k as f32 * PITCH[0] + offset, v))
        });
        let inside = places.filter(|p| p.x.abs() < 0.5 * length - 0.06 && p.y > 0.07);
        all(inside.map(|p| sphere(0.011, 10).moved(Vec3::new(-p.x, -0.018, SEAT - BELOW_SEAT + p.y))))
    }

    /// The round front of a roll, facing +y.
    fn scroll() -> Mesh {
        let face = turned(&[[ROLL - 0.004, -0.01], [ROLL - 0.002, 0.0], [ROLL - 0.012, 0.006], [0.02, 0.004], [0.0, 0.002]], 36);
        crate::pieces::form::to_front(face)
    }
}

impl Furniture for Chesterfield {
    fn random(rng: &mut Rng) -> Self {
        let cover = [Finish::Leather, Finish::Leather, Finish::Velvet, Finish::ArmchairCloth][rng.below(4)];
        Self { seats: 2 + rng.below(2), cover }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.inner() + 4.0 * ROLL + 0.02, DEPTH, TOP)
    }

    fn reach(&self) -> f32 {
        0.4
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let class = if self.seats == 1 { Class::Chair } else { Class::Sofa };
        let sofa = b.object("chesterfield", class, pose);
        let (w, back, front) = (self.inner(), -0.5 * DEPTH, 0.5 * DEPTH);
        let base = rounded_box(Vec3::new(w + 2.0 * WALL - 0.01, DEPTH - 0.04, SEAT - CUSHION - LEG), 0.02, 2);
        b.part(&sofa, "base", base.moved(Vec3::new(0.0, 0.0, LEG + 0.5 * (SEAT - CUSHION - LEG))), self.cover);
        // Where the inner faces of back and arms are.
        let inside = back + 2.0 * ROLL;
        let length = front - inside;
        let (arm_x, arm_y) = (0.5 * w, inside + 0.5 * length);
        let wall = |size: Vec3, at: Vec3| rounded_box(size, 0.02, 2).moved(at);
        let height = TOP - ROLL - LEG;
        let rear = wall(Vec3::new(w + 2.0 * WALL, WALL - 0.012, height), Vec3::new(0.0, inside - 0.5 * WALL - 0.006, LEG + 0.5 * height));
        let sides = [-1.0f32, 1.0]
            .map(|s| wall(Vec3::new(WALL - 0.012, length, height), Vec3::new(s * (arm_x + 0.5 * WALL + 0.006), arm_y, LEG + 0.5 * height)));
        b.part(&sofa, "walls", all(sides.into_iter().chain([rear])), self.cover);
        let along = w + 2.0 * WALL + 0.02;
        b.part(&sofa, "back", Self::padding(along).moved(Vec3::new(0.0, inside, 0.0)), self.cover);
        b.part(&sofa, "back_buttons", Self::buttons(w).moved(Vec3::new(0.0, inside, 0.0)), self.cover);
        for (name, s) in [("left", -1.0f32), ("right", 1.0)] {
            let place = |mesh: Mesh| mesh.turned(Vec3::Z, s * 0.5 * PI).moved(Vec3::new(s * arm_x, arm_y, 0.0));
            b.part(&sofa, &format!("arm_{name}"), place(Self::padding(length)), self.cover);
            b.part(&sofa, &format!("arm_{name}_buttons"), place(Self::buttons(length)), self.cover);
            let at = Vec3::new(s * (arm_x + ROLL), front - 0.006, TOP - ROLL);
            b.part(&sofa, &format!("scroll_{name}"), Self::scroll().moved(at), self.cover);
            let nails = crate::pieces::form::around(26, 0.0)
                .map(|d| sphere(0.0045, 8).moved(at + Vec3::new(d.x * (ROLL - 0.014), 0.002, d.y * (ROLL - 0.014))));
            b.part(&sofa, &format!("nails_{name}"), all(nails), Finish::Brass);
        }
        let depth = front - inside - 0.02;
        for k in 0..self.seats {
            let one = w / self.seats as f32;
            let x = (k as f32 + 0.5) * one - 0.5 * w;
            let seat = padded_box(Vec3::new(one - 0.006, depth, 0.12), 0.035, 0.018).uv_moved(Vec2::splat(rng.next_f32()));
            b.part(
                &sofa,
                &format!("seat_cushion_{}", k + 1),
                seat.moved(Vec3::new(x, inside + 0.5 * depth + 0.006, SEAT - CUSHION + CONTACT + 0.07)),
                self.cover,
            );
        }
        let foot = [[0.0, 0.0], [0.02, 0.0], [0.03, 0.012], [0.034, 0.035], [0.024, 0.06], [0.03, LEG + 0.002], [0.0, LEG + 0.002]];
        for (k, (sx, y)) in [(-1.0f32, front - 0.1), (1.0, front - 0.1), (-1.0, back + 0.1), (1.0, back + 0.1)].into_iter().enumerate() {
            b.part(&sofa, &format!("foot_{}", k + 1), turned(&foot, 24).moved(Vec3::new(sx * (0.5 * w + 0.06), y, 0.0)), Finish::DarkWood);
        }
    }
}
