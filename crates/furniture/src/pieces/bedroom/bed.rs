//! Beds for one (mattress 90 to 120 cm wide) or two (140 to 180 cm), 200 to 210 cm long, on one of five kinds of frame with a headboard 92
//! to 115 cm high; class bed. What lies on them is in `bedding`. The head is at −y; the frame is built in a space whose origin is below the
//! middle of the mattress.

use super::bedding::{Bedding, Cover};
use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, rod};
use crate::pieces::{Furniture, board, grained, leg, on};
use crate::shape::{Reshape, padded_box, rounded_box, sphere};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

/// The frame under the mattress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BedFrame {
    /// Wooden rails with a headboard of one panel.
    Panel,
    /// Wooden rails with a headboard of upright slats.
    Slats,
    /// An upholstered box with a padded headboard of upright channels.
    Upholstered,
    /// An upholstered box with a plain, tall padded headboard.
    BoxSpring,
    /// Black metal tubes.
    Metal,
}

/// A bed, its head to the wall.
#[derive(Clone, Copy, Debug)]
pub struct Bed {
    /// Width of the mattress: 0.9 m for one, 1.4 to 1.8 m for two.
    pub width: f32,
    /// Length of the mattress.
    pub length: f32,
    /// The frame under the mattress.
    pub frame: BedFrame,
    /// The cover of the bed.
    pub cover: Cover,
    /// Scatter cushions.
    pub cushions: usize,
    /// A throw across the foot.
    pub throw: bool,
    /// Height of the headboard.
    pub headboard: f32,
}

/// Thickness of headboards of wood or metal, metres.
const BOARD: f32 = 0.04;
/// Thickness of padded headboards, metres.
const PADDED: f32 = 0.09;
/// Height of the rails' upper edge, metres.
const RAIL: f32 = 0.32;
/// How far rails protrude beyond the mattress, metres.
const OUT: f32 = 0.03;

impl Bed {
    /// A bed for this many sleepers, 1 or 2.
    pub fn for_sleepers(sleepers: usize, rng: &mut Rng) -> Self {
        let width = if sleepers == 1 { [0.9, 0.9, 1.0, 1.2][rng.below(4)] } else { [1.4, 1.6, 1.6, 1.8][rng.below(4)] };
        let frames = [BedFrame::Panel, BedFrame::Slats, BedFrame::Upholstered, BedFrame::BoxSpring, BedFrame::Metal];
        Self {
            width,
            length: [2.0, 2.0, 2.1][rng.below(3)],
            frame: frames[rng.below(5)],
            cover: [Cover::Duvet, Cover::Duvet, Cover::OpenCorner, Cover::Bedspread][rng.below(4)],
            cushions: if sleepers == 1 { rng.below(2) } else { rng.below(4) },
            throw: rng.below(3) == 0,
            headboard: rng.range(0.92, 1.15),
        }
    }

    fn padded(&self) -> bool {
        matches!(self.frame, BedFrame::Upholstered | BedFrame::BoxSpring)
    }

    fn head_depth(&self) -> f32 {
        if self.padded() { PADDED } else { BOARD }
    }

    fn bedding(&self) -> Bedding {
        let mattress = Vec2::new(self.width, self.length);
        let (base, thickness) = match self.frame {
            BedFrame::BoxSpring => (0.34, 0.24),
            BedFrame::Upholstered => (0.28, 0.22),
            BedFrame::Panel | BedFrame::Slats | BedFrame::Metal => (0.26, 0.20),
        };
        // A corner of the bedspread hangs lower by the factor √2, and must not reach the floor.
        let hang = if self.cover == Cover::Bedspread { (base + thickness - 0.09) / std::f32::consts::SQRT_2 } else { 0.27 };
        let sleepers = if self.width < 1.3 { 1 } else { 2 };
        let around = 0.5 * mattress + OUT;
        Bedding { mattress, base, thickness, around, hang, cover: self.cover, sleepers, cushions: self.cushions, throw: self.throw }
    }

    fn wooden(&self, b: &mut Builder, bed: &Object, rng: &mut Rng) {
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

    fn wooden_head(&self, b: &mut Builder, bed: &Object, rng: &mut Rng) {
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

    fn upholstered(&self, b: &mut Builder, bed: &Object, rng: &mut Rng) {
        let cloth = [Finish::SofaCloth, Finish::ArmchairCloth, Finish::Velvet, Finish::Boucle][rng.below(4)];
        let (x, y) = (0.5 * self.width, 0.5 * self.length);
        let bedding = self.bedding();
        let top = if self.frame == BedFrame::BoxSpring { bedding.base } else { bedding.base + 0.06 };
        let low = 0.09;
        if self.frame == BedFrame::BoxSpring {
            let half = 0.5 * self.width / bedding.sleepers as f32;
            for k in 0..bedding.sleepers {
                let base = rounded_box(Vec3::new(2.0 * half - 0.004, 2.0 * y, top - low - 0.001), 0.03, 3);
                let at = Vec3::new((2 * k + 1) as f32 * half - x, 0.0, 0.5 * (top + low));
                b.part(bed, &format!("base_{}", k + 1), base.moved(at), cloth);
            }
        } else {
            let side = |sx: f32| {
                let mesh = rounded_box(Vec3::new(OUT + 0.005, 2.0 * y + 0.02, top - low), 0.014, 3);
                mesh.moved(Vec3::new(sx * (x + 0.5 * OUT + 0.002), 0.01, 0.5 * (top + low)))
            };
            b.part(bed, "side_left", side(-1.0), cloth);
            b.part(bed, "side_right", side(1.0), cloth);
            let foot = rounded_box(Vec3::new(2.0 * (x + OUT), OUT, top - low + 0.001), 0.014, 3);
            b.part(bed, "foot", foot.moved(Vec3::new(0.0, y + 0.5 * OUT + 0.002, 0.5 * (top + low))), cloth);
            b.part(bed, "floor", board([-x, -y, low + 0.02], [x, y, bedding.base], 0.004), Finish::DarkWood);
        }
        for (i, s) in [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].into_iter().enumerate() {
            let at = on(DAffine3::IDENTITY, (s * Vec2::new(x - 0.1, y - 0.1)).extend(0.0), 0.0);
            b.part_at(bed, &format!("foot_{}", i + 1), leg(low + 0.021, [0.016, 0.024], Vec2::ZERO), at, Finish::DarkWood);
        }
        self.padded_head(b, bed, cloth, rng);
    }

    fn padded_head(&self, b: &mut Builder, bed: &Object, cloth: Finish, rng: &mut Rng) {
        let (x, y) = (0.5 * self.width + OUT, -0.5 * self.length - 0.003);
        let upright = |mesh: enfilade_geometry::Mesh| mesh.turned(Vec3::X, FRAC_PI_2).turned(Vec3::Z, std::f32::consts::PI);
        let core = board([-x, y - PADDED, 0.02], [x, y - PADDED + 0.03, self.headboard - 0.012], 0.006);
        b.part(bed, "headboard", core, cloth);
        let count = if self.frame == BedFrame::BoxSpring { 1 + rng.below(2) } else { (2.0 * x / rng.range(0.13, 0.24)) as usize };
        let wide = 2.0 * x / count as f32;
        let (low, high) = (0.10, self.headboard);
        for k in 0..count {
            let pad = padded_box(Vec3::new(wide - 0.002, high - low, 0.05), 0.022, if count > 2 { 0.006 } else { 0.004 });
            let at = Vec3::new((k as f32 + 0.5) * wide - x, y - 0.0315, 0.5 * (low + high));
            b.part(bed, &format!("head_pad_{}", k + 1), upright(pad.uv_moved(Vec2::splat(rng.next_f32()))).moved(at), cloth);
        }
    }

    fn metal(&self, b: &mut Builder, bed: &Object) {
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

impl Furniture for Bed {
    fn random(rng: &mut Rng) -> Self {
        let sleepers = 1 + usize::from(rng.below(4) > 0);
        Self::for_sleepers(sleepers, rng)
    }

    fn size(&self) -> Vec3 {
        let cover = 2.0 * (OUT + 0.17);
        Vec3::new(self.width + cover, self.length + self.head_depth() + 0.5 * cover + 0.005, self.headboard.max(1.22))
    }

    fn reach(&self) -> f32 {
        0.6
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let middle = -0.5 * self.size().y + self.head_depth() + 0.005 + 0.5 * self.length;
        let pose = on(pose, Vec3::new(0.0, middle, 0.0), 0.0);
        let bed = b.object("bed", Class::Bed, pose);
        match self.frame {
            BedFrame::Panel | BedFrame::Slats => {
                self.wooden(b, &bed, rng);
                self.wooden_head(b, &bed, rng);
            }
            BedFrame::Upholstered | BedFrame::BoxSpring => self.upholstered(b, &bed, rng),
            BedFrame::Metal => self.metal(b, &bed),
        }
        self.bedding().build(b, &bed, pose, rng);
    }
}
