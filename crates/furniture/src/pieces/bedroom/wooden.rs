//! Beds with rails of wood, and those of plain metal tubes.

use super::bed_frame::{BOARD, Bed, BedFrame, OUT, RAIL};
use crate::builder::{Builder, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, rod};
use crate::pieces::{board, grained, leg, on};
use crate::shape::{Reshape, rounded_box, sphere};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

impl Bed {
    /// Adds wooden rails and slats.
    pub(super) fn wooden(&self, b: &mut Builder, bed: &Object, rng: &mut Rng) {
        let wood = Finish::Wood;
        let (x, y) = (0.5 * self.width, 0.5 * self.length);
        for (name, s) in [("rail_left", -1.0f32), ("rail_right", 1.0)] {
            let (a, c) = (s * (x + 0.002), s * (x + OUT - 0.003));
            let rail = board([a.min(c), -y - 0.002, RAIL - 0.16], [a.max(c), y + 0.004, RAIL], 0.004);
            b.part(bed, name, grained(rail, rng), wood);
        }
        let foot = board([-x - OUT, y + 0.0045, RAIL - 0.17], [x + OUT, y + OUT, RAIL + 0.01], 0.004);
        b.part(bed, "rail_foot", grained(foot, rng), wood);
        for (i, s) in [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0)].into_iter().enumerate() {
            let at = on(DAffine3::IDENTITY, Vec3::new(s.x * (x - 0.03), y - 0.04, 0.0), 0.0);
            b.part_at(
                bed,
                &format!("leg_{}", i + 1),
                grained(leg(RAIL - 0.161, [0.018, 0.028], Vec2::new(s.x * 0.02, 0.02)), rng),
                at,
                wood,
            );
        }
        let slats = (0..14).map(|k| {
            let at = -y + 0.1 + (2.0 * y - 0.2) * k as f32 / 13.0;
            board([-x + 0.002, at - 0.03, 0.235], [x - 0.002, at + 0.03, 0.2595], 0.003)
        });
        b.part(bed, "slats", all(slats), wood);
        let carriers = [-1.0f32, 1.0].map(|s| board([s * (x - 0.02) - 0.015, -y, 0.20], [s * (x - 0.02) + 0.015, y, 0.2348], 0.002));
        b.part(bed, "carriers", all(carriers), wood);
    }

    /// Adds a wooden headboard, of a panel or of slats.
    pub(super) fn wooden_head(&self, b: &mut Builder, bed: &Object, rng: &mut Rng) {
        let (x, y) = (0.5 * self.width + OUT, -0.5 * self.length - 0.0025);
        let wood = Finish::Wood;
        if self.frame == BedFrame::Panel {
            let panel = rounded_box(Vec3::new(2.0 * x, BOARD - 0.004, self.headboard - 0.12), 0.012, 3);
            b.part(bed, "headboard", grained(panel.moved(Vec3::new(0.0, y - 0.5 * BOARD, 0.5 * (self.headboard + 0.12))), rng), wood);
            for (name, s) in [("leg_head_left", -1.0), ("leg_head_right", 1.0)] {
                let mesh = rounded_box(Vec3::new(0.05, BOARD - 0.008, 0.14), 0.006, 2);
                b.part(bed, name, grained(mesh.moved(Vec3::new(s * (x - 0.08), y - 0.5 * BOARD, 0.07)), rng), wood);
            }
            return;
        }
        for (name, s) in [("post_left", -1.0), ("post_right", 1.0)] {
            let mesh = rounded_box(Vec3::new(0.05, BOARD, self.headboard), 0.008, 3);
            b.part(bed, name, grained(mesh.moved(Vec3::new(s * (x - 0.025), y - 0.5 * BOARD, 0.5 * self.headboard)), rng), wood);
        }
        for (name, z) in [("head_rail_top", self.headboard - 0.07), ("head_rail_low", 0.40)] {
            let rail = board([-x + 0.0495, y - 0.032, z - 0.035], [x - 0.0495, y - 0.008, z + 0.035], 0.006);
            b.part(bed, name, grained(rail, rng), wood);
        }
        let count = (2.0 * x / 0.11) as usize;
        let slats = (0..count).map(|k| {
            let at = -x + 0.05 + (2.0 * x - 0.1) * (k as f32 + 0.5) / count as f32;
            board([at - 0.02, y - 0.027, 0.434], [at + 0.02, y - 0.013, self.headboard - 0.104], 0.004)
        });
        b.part(bed, "head_slats", all(slats), wood);
    }

    /// Adds a frame of plain metal tubes.
    pub(super) fn metal(&self, b: &mut Builder, bed: &Object) {
        let black = Finish::BlackMetal;
        let (x, y) = (0.5 * self.width + 0.5 * OUT, 0.5 * self.length + 0.018);
        let (z, half) = (RAIL - 0.06, 0.0125);
        let rails = [-1.0f32, 1.0].map(|s| board([s * x - half, -y, z - 0.03], [s * x + half, y, z + 0.03], 0.003));
        b.part(bed, "rails", all(rails), black);
        let slats = (0..12).map(|k| {
            let at = -y + 0.12 + (2.0 * y - 0.24) * k as f32 / 11.0;
            board([-x + half, at - 0.03, 0.245], [x - half, at + 0.03, 0.2595], 0.003)
        });
        b.part(bed, "slats", all(slats), Finish::Wood);
        for (name, at, high) in [("head", -y, self.headboard), ("foot", y, RAIL)] {
            let posts = [-1.0f32, 1.0].map(|s| rod([s * x, at, 0.0], [s * x, at, high], 0.0145, 16));
            let balls = [-1.0f32, 1.0].map(|s| sphere(0.022, 18).moved(Vec3::new(s * x, at, high)));
            let mut frame = all(posts.into_iter().chain(balls));
            let bar = high - 0.04;
            frame = frame.with(rod([-x, at, bar], [x, at, bar], 0.011, 14));
            frame = frame.with(rod([-x, at, z], [x, at, z], 0.011, 14));
            if name == "head" {
                let count = (2.0 * x / 0.12) as usize;
                let bars = (1..count).map(|k| {
                    let px = -x + 2.0 * x * k as f32 / count as f32;
                    rod([px, at, z], [px, at, bar], 0.006, 10)
                });
                frame = frame.with(all(bars));
            }
            b.part(bed, name, frame, black);
        }
    }
}
