//! A swivel chair on five castors, class chair, with a seat 45 to 50 cm high: the back padded or a net in a frame, bent around the sitter,
//! with or without arms, and with a head rest where it is tall. The sitter looks to +y.

use crate::builder::{Builder, Class};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::Furniture;
use crate::pieces::form::{all, around, cylinder, rod, turned, wire};
use crate::shape::{Reshape, padded_box, rounded_box, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

/// A swivel chair on five castors.
#[derive(Clone, Copy, Debug)]
pub struct OfficeChair {
    /// Height of the seat: EN 1335 has 400 to 510 mm.
    pub seat: f32,
    /// Height of the back above the seat.
    pub back: f32,
    /// The chair has arms.
    pub arms: bool,
    /// The back is a net in a frame instead of padded.
    pub net: bool,
    /// Finish of the padding.
    pub cloth: Finish,
    /// The base is of polished metal instead of black plastic.
    pub polished: bool,
}

/// Radius of the circle of the castors' swivels, metres.
const BASE: f32 = 0.29;
/// Height at which the spine holds the back, metres above its lower edge.
const HELD: f32 = 0.18;

impl OfficeChair {
    /// Adds what is below the seat; returns the number of the first part that turns with the seat.
    fn base(&self, b: &mut Builder, chair: &crate::builder::Object, turn: f32) -> usize {
        let metal = if self.polished { Finish::Aluminium } else { Finish::BlackPlastic };
        let arms = around(5, turn).map(|d| {
            let path = [[d.x * 0.02, d.y * 0.02, 0.105], [d.x * 0.15, d.y * 0.15, 0.098], [d.x * BASE, d.y * BASE, 0.078]];
            wire(&path, 0.0165, 12)
        });
        b.part(chair, "star", all(arms).with(cylinder(0.034, 0.05, 28).moved(Vec3::new(0.0, 0.0, 0.085))), metal);
        let castor = |d: Vec2| {
            let wheel = |s: f32| cylinder(0.027, 0.017, 24).turned(Vec3::Y, FRAC_PI_2).moved(Vec3::new(s * 0.012 - 0.0085, 0.0, 0.027));
            let hood = rounded_box(Vec3::new(0.012, 0.045, 0.035), 0.004, 2).moved(Vec3::new(0.0, 0.0, 0.042));
            let pin = rod([0.0, 0.0, 0.045], [0.0, 0.0, 0.08], 0.006, 8);
            all([wheel(-1.0), wheel(1.0), hood, pin]).turned(Vec3::Z, d.to_angle() + 0.9).moved((d * BASE).extend(0.0))
        };
        b.part(chair, "castors", all(around(5, turn).map(castor)), Finish::BlackPlastic);
        let lift = cylinder(0.026, 0.12, 24).moved(Vec3::new(0.0, 0.0, 0.1));
        b.part(chair, "sleeve", lift, Finish::BlackPlastic);
        b.part(chair, "gas_spring", cylinder(0.014, self.seat - 0.27, 20).moved(Vec3::new(0.0, 0.0, 0.2)), Finish::Chrome);
        let turning = b.part_count();
        let plate = rounded_box(Vec3::new(0.2, 0.26, 0.045), 0.01, 2).moved(Vec3::new(0.0, -0.03, self.seat - 0.087));
        b.part(
            chair,
            "mechanism",
            plate.with(rod([0.09, 0.04, self.seat - 0.09], [0.22, 0.05, self.seat - 0.095], 0.006, 8)),
            Finish::BlackPlastic,
        );
        turning
    }

    /// Bends a flat back (x across, z up from its lower edge) around the sitter and towards the small of the back.
    fn bent(&self, mesh: Mesh) -> Mesh {
        mesh.deformed(|p| self.bend(p))
    }

    fn bend(&self, p: Vec3) -> Vec3 {
        let t = p.z / self.back;
        let lumbar = 0.03 * (-((t - 0.28) / 0.2).powi(2)).exp();
        let round = 0.9 * p.x * p.x;
        Vec3::new(p.x * (1.0 - 0.18 * t * t), p.y + round + lumbar - 0.26 - 0.13 * t, p.z + self.seat + 0.07)
    }

    /// The spine that holds the back: it ends in the padding, or on a cross piece between the sides of a net's frame.
    fn spine(&self) -> Mesh {
        let behind = if self.net { 0.035 } else { 0.046 };
        let on_back = |z: f32| self.bend(Vec3::new(0.0, -behind, z)).to_array();
        let spine = [[0.0, -0.12, self.seat - 0.09], [0.0, -0.27, self.seat - 0.06], on_back(0.0), on_back(HELD)];
        let spine = wire(&spine, 0.017, 12);
        if !self.net {
            return spine;
        }
        let across: Vec<Vec3> = (0..=12).map(|k| self.bend(Vec3::new(0.218 * (k as f32 / 6.0 - 1.0), -0.014, HELD))).collect();
        spine.with(tube(&across, 0.008, 10))
    }
}

impl Furniture for OfficeChair {
    fn random(rng: &mut Rng) -> Self {
        Self {
            seat: rng.range(0.45, 0.5),
            back: rng.range(0.46, 0.62),
            arms: rng.below(3) > 0,
            net: rng.below(2) == 0,
            cloth: [Finish::BlackPlastic, Finish::Leather, Finish::ArmchairCloth, Finish::SofaCloth, Finish::Felt][rng.below(5)],
            polished: rng.below(2) == 0,
        }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.66, 0.86, self.seat + 0.09 + self.back)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let chair = b.object("office_chair", Class::Chair, pose);
        let turning = self.base(b, &chair, rng.range(0.0, 1.2));
        let seat = padded_box(Vec3::new(0.49, 0.48, 0.06), 0.028, 0.012)
            .deformed(|p| Vec3::new(p.x, p.y, p.z - 0.03 * ((p.y - 0.12) / 0.12).max(0.0).powi(2)))
            .smoothed(60.0);
        b.part(&chair, "seat", seat.uv_moved(Vec2::splat(rng.next_f32())).moved(Vec3::new(0.0, 0.03, self.seat - 0.042)), self.cloth);
        let h = self.back;
        if self.net {
            let frame = crate::shape::picture_frame(0.46, h, &[[0.0, -0.012], [0.0, 0.012], [0.024, 0.012], [0.024, -0.012]]);
            let frame = self.bent(subdivided(frame).moved(Vec3::new(0.0, 0.0, 0.5 * h))).smoothed(40.0);
            b.part(&chair, "back_frame", frame, Finish::BlackPlastic);
            let sheet = crate::shape::grid(
                12,
                12,
                |i, j| Vec3::new(0.215 * (1.0 - i as f32 / 6.0), 0.0, 0.02 + (h - 0.04) * j as f32 / 12.0),
                |i, j| Vec2::new(i as f32 * 0.036, j as f32 * 0.045),
            );
            let net = self.bent(sheet.clone().moved(Vec3::new(0.0, 0.003, 0.0))).smoothed(60.0);
            let rear = Mesh { triangles: sheet.triangles.iter().map(|&[p, q, r]| [p, r, q]).collect(), ..sheet };
            let rear = self.bent(rear.moved(Vec3::new(0.0, -0.003, 0.0))).smoothed(60.0);
            b.part(&chair, "net", net.with(rear), Finish::Felt);
        } else {
            let pad = padded_box(Vec3::new(0.46, h, 0.05), 0.024, 0.01).turned(Vec3::X, FRAC_PI_2).moved(Vec3::new(0.0, 0.0, 0.5 * h));
            b.part(&chair, "back", self.bent(pad).smoothed(60.0).uv_moved(Vec2::splat(rng.next_f32())), self.cloth);
        }
        b.part(&chair, "spine", self.spine(), Finish::BlackPlastic);
        if self.arms {
            for (name, s) in [("left", -1.0f32), ("right", 1.0)] {
                let (x, z) = (s * 0.28, self.seat + 0.21);
                let post = tube(
                    &[Vec3::new(s * 0.1, 0.0, self.seat - 0.085), Vec3::new(x, 0.0, self.seat - 0.08), Vec3::new(x, 0.0, z - 0.012)],
                    0.013,
                    10,
                );
                let pad = rounded_box(Vec3::new(0.075, 0.25, 0.028), 0.012, 3).moved(Vec3::new(x, 0.03, z));
                b.part(&chair, &format!("arm_{name}"), post.with(pad), Finish::BlackPlastic);
            }
        }
        if h > 0.56 {
            let roll = turned(&[[0.0, -0.13], [0.03, -0.13], [0.042, -0.115], [0.042, 0.115], [0.03, 0.13], [0.0, 0.13]], 24)
                .turned(Vec3::Y, FRAC_PI_2);
            let z = self.seat + 0.045 + h;
            b.part(&chair, "head_rest", roll.moved(Vec3::new(0.0, -0.355, z)), self.cloth);
        }
        b.joint(&chair, "seat", &Joint::seat(), turning..b.part_count());
    }
}

/// Cuts every triangle into four, three times, so that a long straight piece can bend.
fn subdivided(mut mesh: Mesh) -> Mesh {
    for _ in 0..3 {
        let mut finer = Mesh::default();
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| (mesh.positions[i as usize], mesh.uvs[i as usize]));
            let middle = |p: (Vec3, Vec2), q: (Vec3, Vec2)| (0.5 * (p.0 + q.0), 0.5 * (p.1 + q.1));
            let corners = [a, b, c, middle(a, b), middle(b, c), middle(c, a)];
            let base = finer.positions.len() as u32;
            finer.positions.extend(corners.map(|c| c.0));
            finer.uvs.extend(corners.map(|c| c.1));
            finer.triangles.extend([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]].map(|t| t.map(|i| base + i)));
        }
        mesh = finer;
    }
    mesh
}
