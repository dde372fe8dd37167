//! A dining chair of wood, 46 × 50 cm and 80 cm high: a hollowed seat on four round legs, of which the rear ones go on upward and carry a
//! bent backrest; one object of class chair. Only its pad varies: every second chair has one, in an accent of the palette.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::{Furniture, grained, standing};
use crate::shape::{Reshape, grid, rounded_box, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::PI;

/// A dining chair: a seat on four round legs with a bent backrest.
#[derive(Clone, Copy, Debug)]
pub struct BentRail {
    /// True for a seat pad in the palette's cloth.
    pub pad: bool,
}

/// Height of the middle of the seat board, metres: common seats are 44 to 47 cm high.
const SEAT: f32 = 0.455;

impl Furniture for BentRail {
    fn random(rng: &mut Rng) -> Self {
        Self { pad: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.46, 0.50, 0.80)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let chair = b.object("chair", Class::Chair, pose);
        let wood = Finish::Wood;
        let seat = rounded_box(Vec3::new(0.43, 0.41, 0.024), 0.011, 3)
            .deformed(|p| {
                Vec3::new(
                    p.x * (1.0 + 0.16 * p.y),
                    p.y,
                    p.z - 0.018 * (1.0 - (p.x / 0.215).powi(2)).max(0.0) * (1.0 - (p.y / 0.205).powi(2)).max(0.0),
                )
            })
            .smoothed(40.0);
        b.part(&chair, "seat", grained(seat.moved(Vec3::new(0.0, 0.02, SEAT)), rng), wood);
        for (side, s) in [("left", -1.0), ("right", 1.0)] {
            let front = [Vec3::new(s * 0.20, 0.21, 0.0), Vec3::new(s * 0.175, 0.175, SEAT - 0.006)];
            b.part(&chair, &format!("leg_front_{side}"), grained(standing(tube(&front, 0.0145, 14)), rng), wood);
            let back = [
                Vec3::new(s * 0.195, -0.225, 0.0),
                Vec3::new(s * 0.178, -0.175, 0.40),
                Vec3::new(s * 0.178, -0.178, 0.50),
                Vec3::new(s * 0.182, -0.195, 0.62),
                Vec3::new(s * 0.186, -0.217, 0.72),
            ];
            b.part(&chair, &format!("leg_back_{side}"), grained(standing(tube(&back, 0.0135, 14)), rng), wood);
            let rail = [Vec3::new(s * 0.187, 0.193, 0.22), Vec3::new(s * 0.187, -0.199, 0.20)];
            b.part(&chair, &format!("stretcher_{side}"), grained(tube(&rail, 0.008, 10), rng), wood);
        }
        b.part(&chair, "backrest", grained(backrest(), rng), wood);
        if self.pad {
            let pad = rounded_box(Vec3::new(0.38, 0.36, 0.03), 0.014, 3).uv_moved(Vec2::splat(rng.next_f32()));
            b.part(&chair, "pad", pad.moved(Vec3::new(0.0, 0.02, SEAT + 0.0125 + 0.0145)), Finish::Accent(2));
        }
    }
}

/// A board bent around the sitter's back.
fn backrest() -> enfilade_geometry::Mesh {
    const N: usize = 14;
    let section: Vec<Vec2> = (0..12)
        .map(|k| {
            let (sin, cos) = (k as f32 / 12.0 * 2.0 * PI).sin_cos();
            let round = |v: f32| v.signum() * v.abs().powf(0.55);
            Vec2::new(0.0085 * round(cos), 0.062 * round(sin))
        })
        .collect();
    let point = |i: usize, j: usize| {
        let along = 2.0 * (j.clamp(1, N + 1) - 1) as f32 / N as f32 - 1.0;
        // Its ends reach into the rear legs.
        let angle = 0.32 * along;
        let radius = 0.6;
        let center = Vec3::new(radius * angle.sin(), 0.369 - radius * angle.cos(), 0.735);
        if j == 0 || j == N + 2 {
            return center;
        }
        let q = section[i % 12];
        let out = Vec3::new(angle.sin(), -angle.cos(), 0.0);
        center + out * q.x + Vec3::new(0.0, -0.12 * q.y, q.y * (1.0 - 0.25 * along * along))
    };
    // The grid runs around the section first and along the board second, which turns faces inward unless the section runs backwards.
    let mesh = grid(12, N + 2, |i, j| point(12 - i, j), |i, j| Vec2::new(j as f32 / N as f32 * 0.4, i as f32 / 12.0 * 0.3));
    mesh.smoothed(50.0)
}
