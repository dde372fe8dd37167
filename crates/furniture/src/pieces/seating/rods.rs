//! An easy chair: an open frame of wooden rods, rails and armrests with two loose cushions in the armchairs' cloth, one object of class
//! chair. Its width over the armrests (68 to 74 cm) and the lean of its back (17 to 22°) vary. Parts are placed in a space whose origin is
//! `FORWARD` in front of the footprint's middle.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::{Furniture, board, grained, on, standing};
use crate::shape::{Reshape, padded_box, rounded_box, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::PI;

/// An easy chair: a wooden frame with two loose cushions.
#[derive(Clone, Copy, Debug)]
pub struct RodChair {
    /// Width over the armrests.
    pub width: f32,
    /// Backward lean of the back, radians.
    pub lean: f32,
}

/// Depth of the footprint, metres: from the front legs to the top of the leaning back.
const DEPTH: f32 = 0.86;
/// Distance of the seat in front of the footprint's middle, metres: the back leans out behind it.
const FORWARD: f32 = 0.075;
/// Height of the middle of the armrests, metres: their upper side is 14 cm above the seat cushion, where elbows rest.
const ARM_HEIGHT: f32 = 0.56;
/// Position of the posts of the back, where its slats end, as a share of half the frame's width.
const POSTS: f32 = 0.8;

impl Furniture for RodChair {
    fn random(rng: &mut Rng) -> Self {
        Self { width: rng.range(0.68, 0.74), lean: rng.range(0.30, 0.38) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, DEPTH, 0.95)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let chair = b.object("armchair", Class::Chair, on(pose, Vec3::new(0.0, FORWARD, 0.0), 0.0));
        let wood = Finish::Wood;
        let half = 0.5 * self.width - 0.03;
        let inner = 2.0 * half - 0.045;
        for (side, s) in [("left", -1.0), ("right", 1.0)] {
            let front = [Vec3::new(s * half, 0.30, 0.0), Vec3::new(s * half, 0.27, ARM_HEIGHT - 0.012)];
            let back = [Vec3::new(s * half, -0.37, 0.0), Vec3::new(s * half, -0.25, ARM_HEIGHT - 0.028)];
            b.part(&chair, &format!("leg_front_{side}"), grained(standing(tube(&front, 0.017, 16)), rng), wood);
            b.part(&chair, &format!("leg_back_{side}"), grained(standing(tube(&back, 0.017, 16)), rng), wood);
            let rest = rounded_box(Vec3::new(0.06, 0.66, 0.026), 0.011, 3).turned(Vec3::X, 0.03);
            b.part(&chair, &format!("armrest_{side}"), grained(rest.moved(Vec3::new(s * half, 0.01, ARM_HEIGHT)), rng), wood);
            let rail = board([s * half - 0.011, -0.30, 0.245], [s * half + 0.011, 0.28, 0.295], 0.004).turned(Vec3::X, 0.06);
            b.part(&chair, &format!("rail_{side}"), grained(rail.moved(Vec3::new(0.0, 0.0, 0.012)), rng), wood);
        }
        let cross = |y: f32, z: f32, radius: f32| tube(&[Vec3::new(-half, y, z), Vec3::new(half, y, z)], radius, 14);
        b.part(&chair, "rail_front", grained(cross(0.262, 0.295, 0.014), rng), wood);
        b.part(&chair, "rail_back", grained(cross(-0.30, 0.255, 0.014), rng), wood);
        // The back: two posts and slats, leaning.
        let post = |s: f32| [Vec3::new(s * POSTS * half, -0.27, 0.26), self.back_point(s * POSTS * half, 0.56)];
        b.part(&chair, "back_post_left", grained(tube(&post(-1.0), 0.013, 14), rng), wood);
        b.part(&chair, "back_post_right", grained(tube(&post(1.0), 0.013, 14), rng), wood);
        for k in 0..3 {
            let up = 0.20 + 0.16 * k as f32;
            let slat = [self.back_point(-POSTS * half, up), self.back_point(POSTS * half, up)];
            b.part(&chair, &format!("back_slat_{}", k + 1), grained(tube(&slat, 0.010, 12), rng), wood);
        }
        let cloth = Finish::ArmchairCloth;
        let seat = padded_box(Vec3::new(inner, 0.58, 0.12), 0.04, 0.022).uv_moved(Vec2::splat(rng.next_f32()));
        b.part(&chair, "seat_cushion", seat.turned(Vec3::X, 0.09).moved(Vec3::new(0.0, 0.035, 0.372)), cloth);
        let back = padded_box(Vec3::new(inner - 0.01, 0.50, 0.12), 0.045, 0.028)
            .turned(Vec3::X, 0.5 * PI)
            .turned(Vec3::Z, PI)
            .turned(Vec3::X, self.lean)
            .uv_moved(Vec2::splat(rng.next_f32()));
        let (sin, cos) = self.lean.sin_cos();
        // The padding swells by 28 mm in the middle, where it rests on the slats: it gives way by 2 mm.
        let middle = self.back_point(0.0, 0.43) + (0.060 + 0.028 + 0.010 - 0.002) * Vec3::new(0.0, cos, sin);
        b.part(&chair, "back_cushion", back.moved(middle), cloth);
    }
}

impl RodChair {
    /// A point of the back `up` metres from its foot.
    fn back_point(&self, x: f32, up: f32) -> Vec3 {
        let (sin, cos) = self.lean.sin_cos();
        Vec3::new(x, -0.27 - up * sin, 0.26 + up * cos)
    }
}
