//! To dress by: a dressing table of 90 to 120 cm with drawers (class table), its round or arched mirror (class mirror) and a stool before
//! it (class chair); a bench of 90 to 140 cm, padded or of slats (class other furniture); and a laundry basket 46 to 60 cm high (class
//! other prop) with a lid or with clothes in it.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, around, cut_out, rod, to_front, turned};
use crate::pieces::joinery::{Handle, body_finish, front, pull};
use crate::pieces::soft::Wrinkles;
use crate::pieces::{CONTACT, Furniture, Surface, board, grained, leg, on};
use crate::shape::{Reshape, lathe, padded_box, rounded_box, spline};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// A dressing table with a mirror, and a stool before it.
#[derive(Clone, Copy, Debug)]
pub struct DressingTable {
    /// Width of the table.
    pub width: f32,
    /// Finish of the table.
    pub finish: Finish,
    /// Handle of each drawer.
    pub handle: Handle,
    /// An arched mirror instead of a round one.
    pub arched: bool,
}

/// Height of the dressing table's top, metres.
const TOP: f32 = 0.76;
/// Depth of the dressing table with its handles, metres; the stool needs 30 cm more before it.
const DEPTH: f32 = 0.44;
/// Depth of the strip at the rear of the top that the mirror takes, metres.
const MIRROR_DEPTH: f32 = 0.13;
/// Height of the stool's seat, metres.
const STOOL: f32 = 0.46;
/// Upper end of the boards below the top, metres below its upper face: the top and air that keeps faces out of one plane.
const BELOW_TOP: f32 = 0.0202;
/// Distance of rear and bottom from the ends of the top, metres: its overhang, a side, and such air.
const BESIDE: f32 = 0.0282;

impl DressingTable {
    fn stool(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let stool = b.object("stool", Class::Chair, pose);
        let cloth = [Finish::Velvet, Finish::Boucle, Finish::ArmchairCloth][rng.below(3)];
        let profile = spline(&[[0.17, 0.0], [0.188, 0.02], [0.19, 0.05], [0.178, 0.085], [0.12, 0.098]], 5);
        let mut section = vec![Vec2::ZERO];
        section.extend(profile);
        section.push(Vec2::new(0.0, 0.1));
        b.part(&stool, "seat", lathe(&section, 48).moved(Vec3::new(0.0, 0.0, STOOL - 0.1)), cloth);
        let legs = around(4, TAU / 8.0).map(|s| leg(STOOL - 0.099, [0.009, 0.015], s * 0.03).moved((s * 0.135).extend(0.0)));
        b.part(&stool, "legs", all(legs), if rng.below(2) == 0 { Finish::Brass } else { self.finish });
    }

    fn mirror(&self, b: &mut Builder, pose: DAffine3) {
        let mirror = b.object("mirror", Class::Mirror, pose);
        let outline: Vec<Vec2> = if self.arched {
            let (w, h) = (0.27f32, 0.36f32);
            let arc = (0..=24).map(|k| Vec2::from_angle(0.5 * TAU * k as f32 / 24.0) * w + Vec2::Y * h);
            arc.chain([Vec2::new(-w, 0.0), Vec2::new(w, 0.0)]).collect()
        } else {
            (0..56).map(|k| Vec2::from_angle(TAU * k as f32 / 56.0) * 0.29 + Vec2::Y * 0.33).collect()
        };
        let middle = outline.iter().sum::<Vec2>() / outline.len() as f32;
        let glass: Vec<Vec2> = outline.iter().map(|&p| middle + (p - middle) * 0.965).collect();
        // Outlines are drawn in the xy plane and then turned upright, to face +y.
        let upright = |outline: &[Vec2], thickness: f32| {
            let mirrored: Vec<Vec2> = outline.iter().rev().map(|p| Vec2::new(p.x, -p.y)).collect();
            to_front(cut_out(&mirrored, thickness, 0.0015))
        };
        b.part(&mirror, "frame", upright(&outline, 0.018), Finish::Brass);
        b.part(&mirror, "glass", upright(&glass, 0.003).moved(Vec3::Y * 0.0175), Finish::Mirror);
        b.part(&mirror, "stand", rounded_box(Vec3::new(0.3, 0.09, 0.012), 0.004, 2).moved(Vec3::new(0.0, 0.01, 0.006)), Finish::Brass);
        let foot = if self.arched { 0.012 } else { 0.05 };
        b.part(&mirror, "post", rod([0.0, -0.008, 0.0], [0.0, -0.008, foot + 0.1], 0.008, 12), Finish::Brass);
    }
}

impl Furniture for DressingTable {
    fn random(rng: &mut Rng) -> Self {
        Self { width: rng.range(0.9, 1.2), finish: body_finish(rng), handle: Handle::random(rng), arched: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, DEPTH + 0.30, TOP + 0.66)
    }

    fn reach(&self) -> f32 {
        0.5
    }

    fn surfaces(&self) -> Vec<Surface> {
        let y = -0.5 * self.size().y;
        let side = |x0: f32, x1: f32| Surface {
            min: Vec2::new(x0, y + MIRROR_DEPTH),
            max: Vec2::new(x1, y + DEPTH - 0.05),
            z: TOP,
            headroom: f32::INFINITY,
        };
        vec![side(-0.5 * self.width, -0.2), side(0.2, 0.5 * self.width)]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let table = b.object("dressing_table", Class::Table, pose);
        let x = 0.5 * self.width;
        let (rear, face) = (-0.5 * self.size().y, -0.5 * self.size().y + DEPTH - Handle::DEPTH);
        b.part(&table, "top", grained(board([-x, rear, TOP - 0.02], [x, face, TOP], 0.0025), rng), self.finish);
        // Where the boards end behind the drawers' fronts.
        let (low, behind) = (TOP - 0.13, face - 0.021);
        for (name, min, max) in [
            ("side_left", [-x + 0.01, rear + 0.01, low], [-x + 0.028, behind, TOP - BELOW_TOP]),
            ("side_right", [x - 0.028, rear + 0.01, low], [x - 0.01, behind, TOP - BELOW_TOP]),
            ("rear", [-x + BESIDE, rear + 0.01, low], [x - BESIDE, rear + 0.022, TOP - BELOW_TOP]),
            ("bottom", [-x + BESIDE, rear + 0.0222, low], [x - BESIDE, behind, low + 0.012]),
        ] {
            b.part(&table, name, grained(board(min, max, 0.0015), rng), self.finish);
        }
        let wide = self.width - 0.02;
        for k in 0..2 {
            let from = -0.5 * wide + 0.5 * k as f32 * wide;
            let rect = [from + 0.0015, from + 0.5 * wide - 0.0015, low, TOP - 0.0225];
            let from_part = b.part_count();
            b.part(&table, &format!("drawer_{}", k + 1), front(rect, face - 0.0205, 0.019, false, rng), self.finish);
            let at = Vec3::new(0.5 * (rect[0] + rect[1]), face - 0.0015, 0.5 * (rect[2] + rect[3]));
            self.handle.add(b, &table, &format!("handle_{}", k + 1), at, 0.14, false);
            let depth = face - 0.0205 - rear - 0.03;
            pull(b, &table, &format!("drawer_{}", k + 1), from_part, rect, face - 0.0205, depth, self.finish);
        }
        let middle = 0.5 * (rear + face);
        for (i, s) in [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].into_iter().enumerate() {
            let at = Vec3::new(s.x * (x - 0.05), middle + s.y * (0.5 * (face - rear) - 0.06), 0.0);
            let mesh = grained(leg(low - 0.0002, [0.012, 0.02], s * 0.02), rng);
            b.part_at(&table, &format!("leg_{}", i + 1), mesh, on(DAffine3::IDENTITY, at, 0.0), self.finish);
        }
        self.mirror(b, on(pose, Vec3::new(0.0, rear + 0.06, TOP + CONTACT), 0.0));
        let stool = Vec3::new(rng.range(-0.06, 0.06), 0.5 * self.size().y - 0.195, 0.0);
        self.stool(b, on(pose, stool, rng.range(0.0, TAU)), rng);
    }
}

/// A long seat for the foot of a bed or a hall.
#[derive(Clone, Copy, Debug)]
pub struct Bench {
    /// Length of the bench.
    pub length: f32,
    /// Upholstered instead of wooden slats.
    pub padded: bool,
    /// A shelf for shoes below.
    pub shelf: bool,
}

impl Furniture for Bench {
    fn random(rng: &mut Rng) -> Self {
        let padded = rng.below(3) > 0;
        Self { length: rng.range(0.9, 1.4), padded, shelf: !padded || rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.length, 0.4, 0.49)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let bench = b.object("bench", Class::OtherFurniture, pose);
        let half = Vec2::new(0.5 * self.length, 0.19);
        let seat = if self.padded { 0.38 } else { 0.45 };
        let wood = if rng.below(2) == 0 { Finish::Wood } else { Finish::DarkWood };
        let slats = |z: f32, inset: f32| {
            all((0..4).map(|k| {
                let y = -half.y + 2.0 * half.y * (k as f32 + 0.5) / 4.0;
                board([-half.x + inset, y - 0.04, z - 0.022], [half.x - inset, y + 0.04, z], 0.003)
            }))
        };
        b.part(&bench, "seat", grained(slats(seat, 0.0), rng), wood);
        let frames = [-1.0f32, 1.0].map(|s| {
            let x = s * (half.x - 0.09);
            let post = |y: f32| board([x - 0.02, y - 0.02, 0.0], [x + 0.02, y + 0.02, seat - 0.0222], 0.004);
            let rail = |z: f32| board([x - 0.014, -half.y + 0.055, z - 0.025], [x + 0.014, half.y - 0.055, z + 0.025], 0.003);
            all([post(-half.y + 0.035), post(half.y - 0.035), rail(seat - 0.0475), rail(0.13)])
        });
        b.part(&bench, "frame", all(frames), wood);
        if self.shelf {
            b.part(&bench, "shelf", grained(slats(0.178, 0.05), rng), wood);
        }
        if self.padded {
            let cloth = [Finish::Velvet, Finish::Boucle, Finish::ArmchairCloth, Finish::SofaCloth][rng.below(4)];
            let pad = padded_box(Vec3::new(self.length - 0.01, 0.385, 0.085), 0.03, 0.012).uv_moved(Vec2::splat(rng.next_f32()));
            b.part(&bench, "pad", pad.moved(Vec3::new(0.0, 0.0, seat + 0.0428 + 0.004)), cloth);
        }
    }
}

/// A basket for laundry, with or without a lid, or with clothes on top.
#[derive(Clone, Copy, Debug)]
pub struct LaundryBasket {
    /// Radius at the top.
    pub radius: f32,
    /// Height of the rim.
    pub height: f32,
    /// The basket has a lid; otherwise clothes stick out of it.
    pub lid: bool,
    /// Plaited instead of cloth or plastic.
    pub plaited: bool,
}

impl Furniture for LaundryBasket {
    fn random(rng: &mut Rng) -> Self {
        Self { radius: rng.range(0.19, 0.24), height: rng.range(0.46, 0.6), lid: rng.below(2) == 0, plaited: rng.below(3) > 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.radius + 0.03, 2.0 * self.radius + 0.03, self.height + if self.lid { 0.06 } else { 0.13 })
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let basket = b.object("laundry_basket", Class::OtherProp, pose);
        let (r, h) = (self.radius, self.height);
        let finish = if self.plaited { Finish::Wicker } else { [Finish::Felt, Finish::WhitePlastic][rng.below(2)] };
        // Every second band of the plaiting protrudes.
        let ripple = if self.plaited { 0.004 } else { 0.0 };
        let rows = 15;
        let wall = |t: f32, inset: f32| Vec2::new(r * (0.84 + 0.16 * t) - inset + ripple * (TAU * t * rows as f32).sin(), h * t);
        let mut profile = vec![Vec2::ZERO];
        let steps = if self.plaited { 6 * rows } else { 8 };
        profile.extend((0..=steps).map(|k| wall(k as f32 / steps as f32, 0.0)));
        profile.push(Vec2::new(r - 0.004, h + 0.006));
        profile.push(Vec2::new(r - 0.010, h + 0.002));
        // The inside narrows as the outside does, which is 0.92 r half way up.
        profile.push(Vec2::new(0.92 * r - 0.014, 0.5 * h));
        profile.push(Vec2::new(0.78 * r, 0.012));
        profile.push(Vec2::new(0.0, 0.012));
        b.part(&basket, "body", lathe(&profile, 48).moved(Vec3::Z * CONTACT), finish);
        if self.lid {
            let lid = [[0.0, 0.0], [r + 0.004, 0.0], [r + 0.008, 0.008], [r + 0.004, 0.02], [0.6 * r, 0.036], [0.0, 0.042]];
            b.part(&basket, "lid", turned(&lid, 48).moved(Vec3::Z * (h + 0.0075)), finish);
        } else {
            let clothes = b.object("clothes", Class::Clothes, pose);
            let size = Vec3::new(2.2 * r, 2.2 * r, 0.2);
            let lumps = Wrinkles::new(0.2, 0.01, rng);
            // The heap fills the basket up to its wall.
            let most = r - 0.018;
            let heap = super::clothes::heap(size, rng)
                .deformed(|p| {
                    let out = p.truncate().length();
                    let kept = p.truncate() * (most / out.max(most));
                    Vec3::new(kept.x, kept.y, p.z + lumps.at(kept))
                })
                .smoothed(80.0);
            b.part(&clothes, "cloth", heap.moved(Vec3::Z * (h - 0.10)), Finish::Clothes(rng.below(8) as u8));
        }
    }
}
