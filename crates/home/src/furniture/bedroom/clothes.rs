use crate::builder::{Builder, Class};
use crate::furniture::form::{all, wire};
use crate::furniture::soft::{Wrinkles, folded};
use crate::furniture::{CONTACT, Furniture, on};
use crate::materials::Finish;
use crate::shape::{Reshape, grid, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// Something to wear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Garment {
    /// A shirt or blouse.
    Shirt,
    /// A jacket.
    Jacket,
    /// A coat.
    Coat,
    /// A dress without sleeves.
    Dress,
    /// Trousers over the bar of the hanger.
    Trousers,
}

impl Garment {
    /// One of those that hang in a wardrobe.
    pub fn random(rng: &mut Rng) -> Self {
        [Self::Shirt, Self::Shirt, Self::Jacket, Self::Coat, Self::Dress, Self::Trousers][rng.below(6)]
    }

    /// From the shoulders to the hem.
    pub fn length(self) -> f32 {
        match self {
            Self::Shirt => 0.72,
            Self::Jacket => 0.76,
            Self::Coat => 1.04,
            Self::Dress => 1.0,
            Self::Trousers => 0.62,
        }
    }

    fn thickness(self) -> f32 {
        match self {
            Self::Coat | Self::Jacket => 0.045,
            Self::Shirt | Self::Dress => 0.026,
            Self::Trousers => 0.016,
        }
    }

    fn sleeves(self) -> bool {
        matches!(self, Self::Shirt | Self::Jacket | Self::Coat)
    }

    /// The cloth as it hangs in the xz plane, its neck at the origin. `droop` is 0 on a hanger, 1 on a hook.
    pub fn cloth(self, droop: f32, rng: &mut Rng) -> Mesh {
        let (nu, nv) = (36, 26);
        let (length, thick) = (self.length() * rng.range(0.94, 1.04), self.thickness());
        let shoulder = rng.range(0.19, 0.22) * (1.0 - 0.35 * droop);
        let flare = match self {
            Self::Dress => 1.35,
            Self::Coat => 1.12,
            Self::Shirt | Self::Jacket => 1.04,
            Self::Trousers => 1.0,
        };
        let (folds, phase) = (3.0 + rng.below(3) as f32, rng.range(0.0, TAU));
        let wrinkles = Wrinkles::new(0.16, 0.008, rng);
        let slope = 0.07 + 0.16 * droop;
        let point = |i: usize, j: usize| {
            if j == 0 {
                return Vec3::ZERO;
            }
            if j == nv {
                return Vec3::new(0.0, 0.0, -length + 0.004);
            }
            let a = (i % nu) as f32 / nu as f32 * TAU;
            let z = -length * ((j.min(nv - 1)) as f32 / (nv - 1) as f32).powf(1.3);
            let down = (-z / length).min(1.0);
            // Shoulders slope from the neck outward, then the sides fall.
            let yoke = (-z / slope).min(1.0);
            let half = if self == Self::Trousers { 0.17 } else { 0.055 + (shoulder - 0.055) * yoke.powf(0.8) };
            let half = half * (1.0 + (flare - 1.0) * down) * (1.0 - 0.12 * (TAU * 0.5 * down).sin());
            let (sin, cos) = a.sin_cos();
            let wave = (folds * a + phase + 2.0 * down).sin() * thick * 0.8 * down * (1.0 + droop);
            let depth = thick * (0.55 + 0.45 * yoke) * (1.0 + 0.7 * droop) + wave + wrinkles.at(Vec2::new(half * cos + sin, z));
            Vec3::new(half * cos.signum() * cos.abs().powf(0.75), depth * sin, z)
        };
        let uv = |i: usize, j: usize| Vec2::new(i as f32 / nu as f32 * 4.0 * shoulder, -length * j as f32 / nv as f32);
        // From the top down and around counter-clockwise: inside out, so the way around is reversed.
        let mut mesh = grid(nu, nv, |i, j| point(nu - i, j), uv).smoothed(75.0);
        if self.sleeves() {
            for s in [-1.0f32, 1.0] {
                let x = s * (shoulder - 0.012);
                let out = rng.range(0.01, 0.04) * (1.0 - droop);
                let path: Vec<Vec3> = (0..=10)
                    .map(|k| {
                        let t = k as f32 / 10.0;
                        Vec3::new(x + s * (0.02 + out * (3.0 * t).sin()), 0.012 * (4.0 * t + phase).sin(), -slope - 0.01 - 0.56 * t)
                    })
                    .collect();
                let crumple = Wrinkles::new(0.10, 0.008, rng);
                let sleeve = tube(&path, 0.042, 14)
                    .deformed(|p| {
                        let y = p.y * 0.62;
                        Vec3::new(p.x, y + y.signum() * crumple.at(Vec2::new(3.0 * p.x, p.z)), p.z)
                    })
                    .smoothed(70.0);
                mesh = mesh.with(sleeve);
            }
        }
        mesh
    }
}

/// A garment on a hanger: the rod that carries it is at the origin and runs along y.
pub fn hang_garment(b: &mut Builder, pose: DAffine3, garment: Garment, rng: &mut Rng) {
    const NECK: f32 = 0.085;
    let object = b.object("clothes", Class::Clothes, pose);
    let hook = wire(
        &[
            [-0.014, 0.0, 0.002],
            [-0.008, 0.0, 0.0145],
            [0.004, 0.0, 0.017],
            [0.015, 0.0, 0.006],
            [0.010, 0.0, -0.012],
            [0.0, 0.0, -0.03],
            [0.0, 0.0, -NECK],
        ],
        0.0016,
        6,
    );
    b.part(&object, "hook", hook, Finish::Steel);
    if garment == Garment::Trousers {
        let frame = wire(
            &[
                [-0.19, 0.0, -NECK - 0.10],
                [-0.17, 0.0, -NECK - 0.05],
                [0.0, 0.0, -NECK],
                [0.17, 0.0, -NECK - 0.05],
                [0.19, 0.0, -NECK - 0.10],
            ],
            0.005,
            8,
        )
        .with(tube(&[Vec3::new(-0.19, 0.0, -NECK - 0.10), Vec3::new(0.19, 0.0, -NECK - 0.10)], 0.005, 8));
        b.part(&object, "hanger", frame, Finish::Wood);
        let cloth = crate::furniture::soft::over_rod(0.30, 0.56, 0.52, 0.0125, 0.006, rng);
        b.part(&object, "cloth", cloth.moved(Vec3::new(0.0, 0.0, -NECK - 0.10)), Finish::Clothes(rng.below(8) as u8));
        return;
    }
    b.part(&object, "cloth", garment.cloth(0.0, rng).moved(Vec3::new(0.0, 0.0, -NECK)), Finish::Clothes(rng.below(8) as u8));
}

/// Folded clothes on each other.
#[derive(Clone, Copy, Debug)]
pub struct FoldedClothes {
    /// How many.
    pub count: usize,
}

impl FoldedClothes {
    const WIDTH: f32 = 0.30;
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
