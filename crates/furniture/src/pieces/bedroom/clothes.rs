//! Clothes: garments on hangers, piles of folded clothes of 30 × 25 cm, and heaps; each garment or folded piece is an object of class
//! clothes. A garment on a hanger hangs from a rod at the origin that runs along y.

use super::garment::Garment;
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, wire};
use crate::pieces::soft::{Wrinkles, folded};
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// A garment on a hanger: the rod that carries it is at the origin and runs along y.
pub fn hang_garment(b: &mut Builder, pose: DAffine3, garment: Garment, rng: &mut Rng) {
    /// Distance from the rod down to the neck of a garment, metres.
    const NECK: f32 = 0.085;
    let object = b.object("clothes", Class::Clothes, pose);
    // The hook ends at the top of the hanger; in other clothes than trousers the hanger is not seen, and the hook ends below the collar.
    let end = if garment == Garment::Trousers { NECK } else { NECK + 0.065 };
    let hook = wire(
        &[
            [-0.014, 0.0, 0.002],
            [-0.008, 0.0, 0.0145],
            [0.004, 0.0, 0.017],
            [0.015, 0.0, 0.006],
            [0.010, 0.0, -0.012],
            [0.0, 0.0, -0.03],
            [0.0, 0.0, -end],
        ],
        0.0016,
        6,
    );
    b.part(&object, "hook", hook, Finish::Steel);
    if garment == Garment::Trousers {
        let bar = -NECK - 0.10;
        let frame = wire(
            &[[-0.19, 0.0, bar], [-0.17, 0.0, -NECK - 0.05], [0.0, 0.0, -NECK], [0.17, 0.0, -NECK - 0.05], [0.19, 0.0, bar]],
            0.005,
            8,
        )
        .with(tube(&[Vec3::new(-0.19, 0.0, bar), Vec3::new(0.19, 0.0, bar)], 0.005, 8));
        b.part(&object, "hanger", frame, Finish::Wood);
        let cloth = crate::pieces::soft::over_rod(0.30, 0.56, 0.52, 0.0125, 0.006, rng);
        b.part(&object, "cloth", cloth.moved(Vec3::new(0.0, 0.0, bar)), Finish::Clothes(rng.below(8) as u8));
        return;
    }
    b.part(&object, "cloth", garment.cloth(0.0, rng).moved(Vec3::new(0.0, 0.0, -NECK)), Finish::Clothes(rng.below(8) as u8));
}

/// Folded clothes on each other.
#[derive(Clone, Copy, Debug)]
pub struct FoldedClothes {
    /// Number of clothes.
    pub count: usize,
}

impl FoldedClothes {
    /// Width of the largest piece, metres.
    const WIDTH: f32 = 0.30;
    /// Depth of the largest piece, metres.
    const DEPTH: f32 = 0.25;
}

impl Furniture for FoldedClothes {
    fn random(rng: &mut Rng) -> Self {
        Self { count: 1 + rng.below(6) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(Self::WIDTH + 0.05, Self::DEPTH + 0.05, 0.056 * self.count as f32 + 0.002)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let mut z = CONTACT;
        for _ in 0..self.count {
            let layers = 2 + rng.below(2);
            let size = Vec3::new(Self::WIDTH * rng.range(0.9, 1.0), Self::DEPTH * rng.range(0.9, 1.0), rng.range(0.03, 0.055));
            let object = b.object("clothes", Class::Clothes, on(pose, Vec3::new(0.0, 0.0, z), rng.range(-0.06, 0.06)));
            b.part(&object, "cloth", folded(size, layers, rng), Finish::Clothes(rng.below(8) as u8));
            z += size.z + CONTACT;
        }
    }
}

/// A heap of clothes: crumpled cloth of `size`, standing on z = 0.
pub fn heap(size: Vec3, rng: &mut Rng) -> Mesh {
    let folds: Vec<Mesh> = (0..4)
        .map(|k| {
            let turn = rng.range(0.0, TAU);
            let scale = Vec3::new(rng.range(0.55, 0.75), rng.range(0.5, 0.7), rng.range(0.6, 0.95));
            let lumps = Wrinkles::new(0.12, 0.05, rng);
            let offset = if k == 0 { Vec2::ZERO } else { Vec2::from_angle(turn) * 0.16 * size.truncate() };
            crate::shape::sphere(0.5, 36)
                .deformed(|p| {
                    let bump = 1.0 - 2.2 * lumps.at(Vec2::new(p.x + p.z, p.y - 0.5 * p.z));
                    let q = p * scale * size * bump;
                    Vec3::new(q.x + offset.x, q.y + offset.y, (q.z + 0.35 * size.z).max(0.0))
                })
                .smoothed(80.0)
        })
        .collect();
    all(folds)
}
