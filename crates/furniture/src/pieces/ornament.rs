//! Small things on tables, shelves and sills: vases 14 to 32 cm high, every second with branches, bowls, mugs, magazines, stacks of books,
//! candlesticks and trays; and a basket with a blanket that stands on the floor. They are of class other prop, but for magazines (paper)
//! and books. Most are turned forms, and each begins [`CONTACT`] above what carries it.

use super::book::pile_of_books;
use super::form::all;
use super::wall_art::printed;
use super::{CONTACT, Furniture, grained};
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::palette::Palette;
use crate::shape::{Reshape, grid, lathe, leaf, rounded_box, spline, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use enfilade_textures::{BOOK_COLUMNS, PaintingStyle};
use std::f32::consts::TAU;

/// A turned vase, with or without branches.
#[derive(Clone, Copy, Debug)]
pub struct Vase {
    /// Height without branches.
    pub height: f32,
    /// Largest radius.
    pub belly: f32,
    /// Branches in it.
    pub branches: usize,
}

impl Furniture for Vase {
    fn random(rng: &mut Rng) -> Self {
        let height = rng.range(0.14, 0.32);
        Self { height, belly: rng.range(0.26, 0.4) * height, branches: if rng.below(2) == 0 { 0 } else { 3 + rng.below(4) } }
    }

    fn size(&self) -> Vec3 {
        let [reach, tall] = if self.branches > 0 { [0.41, 0.66] } else { [0.0, 0.002] };
        Vec3::new(2.0 * self.belly + reach, 2.0 * self.belly + reach, self.height + tall)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let vase = b.object("vase", Class::OtherProp, pose);
        let (h, r) = (self.height, self.belly);
        let neck = rng.range(0.30, 0.5);
        let shoulder = rng.range(0.45, 0.62);
        let outside = spline(
            &[
                [0.55 * r, 0.0],
                [0.72 * r, 0.06 * h],
                [0.97 * r, 0.30 * h],
                [r, shoulder * 0.8 * h],
                [0.72 * r, (shoulder + 0.18) * h],
                [neck * r, 0.88 * h],
                [(neck + 0.06) * r, h],
            ],
            6,
        );
        let mut profile = vec![Vec2::ZERO];
        profile.extend(&outside);
        profile.extend(outside.iter().rev().take_while(|p| p.y > 0.08 * h).map(|p| Vec2::new((p.x - 0.004).max(0.002), p.y - 0.001)));
        profile.push(Vec2::new(0.0, 0.08 * h));
        let glaze = Finish::Ceramic(rng.below(3) as u8);
        b.part(&vase, "body", lathe(&profile, 40).moved(Vec3::new(0.0, 0.0, CONTACT)), glaze);
        for k in 0..self.branches {
            let out = Vec2::from_angle(rng.range(0.0, TAU));
            let (tall, spread) = (rng.range(0.42, 0.62), rng.range(0.05, 0.17));
            let point = |t: f32| (out * (0.4 * neck * r * (1.0 - t) + spread * t * t)).extend(0.3 * h + (h * 0.7 + tall) * t);
            let path: Vec<Vec3> = (0..=8).map(|i| point(i as f32 / 8.0)).collect();
            // Its foot stands on the floor of the vase.
            let foot = path[0].truncate().extend(0.08 * h);
            let stalk: Vec<Vec3> = [foot].into_iter().chain(path.iter().copied()).collect();
            let mut twigs = tube(&stalk, 0.0022, 6);
            let mut leaves = None;
            for j in 4..=8 {
                let turn = rng.range(0.0, TAU);
                let length = rng.range(0.05, 0.085);
                let one = leaf(length, 0.42 * length, 0.5).turned(Vec3::Y, -rng.range(0.2, 0.9)).turned(Vec3::Z, turn).moved(path[j]);
                leaves = Some(match leaves {
                    None => one,
                    Some(all) => Reshape::with(all, one),
                });
                twigs = twigs.with(tube(&[path[j - 1], path[j]], 0.0018, 5));
            }
            b.part(&vase, &format!("branch_{}", k + 1), twigs, Finish::Bark);
            if let Some(leaves) = leaves {
                b.part(&vase, &format!("leaves_{}", k + 1), leaves, Finish::Leaf);
            }
        }
    }
}

/// A shallow bowl.
#[derive(Clone, Copy, Debug)]
pub struct Bowl {
    /// Radius of the rim.
    pub radius: f32,
}

impl Furniture for Bowl {
    fn random(rng: &mut Rng) -> Self {
        Self { radius: rng.range(0.07, 0.15) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.radius, 2.0 * self.radius, 0.45 * self.radius)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let bowl = b.object("bowl", Class::OtherProp, pose);
        let r = self.radius;
        let curve = |wall: f32| {
            spline(&[[0.42 * r, wall], [0.72 * r - wall, 0.12 * r + 0.6 * wall], [0.92 * r - wall, 0.28 * r], [r - wall, 0.45 * r]], 5)
        };
        let mut profile = vec![Vec2::ZERO];
        profile.extend(curve(0.0));
        profile.extend(curve(0.004).into_iter().rev());
        profile.push(Vec2::new(0.0, 0.005));
        b.part(&bowl, "body", lathe(&profile, 48).moved(Vec3::new(0.0, 0.0, CONTACT)), Finish::Ceramic(rng.below(3) as u8));
    }
}

/// A mug with its handle.
#[derive(Clone, Copy, Debug)]
pub struct Mug;

impl Furniture for Mug {
    fn random(_rng: &mut Rng) -> Self {
        Self
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.144, 0.084, 0.093)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let mug = b.object("mug", Class::OtherProp, pose);
        // Straight, round below, or narrow at the foot; some are low.
        let (foot, belly) = [(0.035, 0.0395), (0.022, 0.036), (0.027, 0.032)][rng.below(3)];
        let h = [0.09, 0.09, 0.078][rng.below(3)];
        let profile = [
            [0.0, 0.0],
            [foot, 0.0],
            [belly, 0.009],
            [0.041, 0.5 * h],
            [0.041, h],
            [0.0395, h + 0.0015],
            [0.038, h],
            [0.0375, 0.5 * h],
            [belly - 0.004, 0.012],
            [0.8 * foot, 0.007],
            [0.0, 0.007],
        ];
        let handle: Vec<Vec3> = (0..=12)
            .map(|k| {
                let (sin, cos) = (std::f32::consts::PI * (k as f32 / 12.0 - 0.5)).sin_cos();
                Vec3::new(0.0385 + 0.028 * cos, 0.0, 0.52 * h + 0.3 * h * sin)
            })
            .collect();
        let glaze = Finish::Ceramic(rng.below(3) as u8);
        b.part(&mug, "body", lathe(&profile.map(Vec2::from_array), 36).smoothed(40.0).moved(Vec3::new(0.0, 0.0, CONTACT)), glaze);
        b.part(&mug, "handle", tube(&handle, 0.0048, 10), glaze);
        if rng.below(2) == 0 {
            b.part(&mug, "coffee", crate::shape::disk(0.0376, 32).moved(Vec3::new(0.0, 0.0, 0.8 * h)), Finish::Soil);
        }
    }
}

/// Magazines lying on each other.
#[derive(Clone, Copy, Debug)]
pub struct Magazines {
    /// Number of magazines.
    pub count: usize,
}

impl Furniture for Magazines {
    fn random(rng: &mut Rng) -> Self {
        Self { count: 1 + rng.below(5) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.30, 0.34, 0.006 * self.count as f32)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let pile = b.object("magazines", Class::Paper, pose);
        for i in 0..self.count {
            let mut mesh = rounded_box(Vec3::new(0.21, 0.28, 0.005), 0.001, 1);
            // Each has the plain part of a book jacket as its cover.
            let cell = rng.below(4 * BOOK_COLUMNS);
            let corner = Vec2::new((cell % BOOK_COLUMNS) as f32 + 0.62, (cell / BOOK_COLUMNS) as f32 + 0.1);
            for (uv, p) in mesh.uvs.iter_mut().zip(&mesh.positions) {
                let q = corner + Vec2::new(0.16 * (p.x / 0.21 + 0.5), 0.8 * (p.y / 0.28 + 0.5));
                *uv = q / Vec2::new(BOOK_COLUMNS as f32, 4.0);
            }
            let z = CONTACT + 0.0025 + i as f32 * 0.0055;
            let turn = rng.range(-0.25, 0.25);
            let place = |mesh: Mesh| mesh.turned(Vec3::Z, turn).moved(Vec3::new(0.0, 0.0, z));
            b.part(&pile, &format!("issue_{}", i + 1), place(mesh), Finish::BookJackets);
            if i + 1 == self.count {
                // The cover of the uppermost: a photograph below the title.
                let palettes = Palette::all();
                let style = [PaintingStyle::Hills, PaintingStyle::Shapes, PaintingStyle::Bands][rng.below(3)];
                let photo = printed(b, "cover", style, &palettes[rng.below(palettes.len())], rng);
                let corner = |i: usize, j: usize| Vec2::new(i as f32, j as f32);
                let sheet = grid(
                    1,
                    1,
                    |i, j| Vec3::new(0.19 * (0.5 - corner(i, j).x), 0.095 - 0.21 * corner(i, j).y, 0.0027),
                    |i, j| Vec2::new(corner(i, j).x, corner(i, j).y),
                );
                b.part(&pile, "photo", place(sheet), photo);
                let letters = (0..4 + rng.below(4)).map(|k| {
                    let x = 0.085 - 0.024 * k as f32;
                    super::board([x - 0.017, -0.132, 0.0024], [x, -0.127 + 0.02, 0.0028], 0.0001)
                });
                b.part(&pile, "title", place(all(letters)), Finish::Paper);
            }
        }
    }
}

/// A few large books lying on each other.
#[derive(Clone, Copy, Debug)]
pub struct BookStack {
    /// Number of books.
    pub count: usize,
}

impl Furniture for BookStack {
    fn random(rng: &mut Rng) -> Self {
        Self { count: 1 + rng.below(5) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.28, 0.24, 0.035 * self.count as f32)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        pile_of_books(b, pose, self.count, rng);
    }
}

/// Candles of different heights.
#[derive(Clone, Copy, Debug)]
pub struct Candles {
    /// Number of candles.
    pub count: usize,
}

impl Furniture for Candles {
    fn random(rng: &mut Rng) -> Self {
        Self { count: 1 + rng.below(3) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.1 * self.count as f32, 0.112, 0.28)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let candles = b.object("candlestick", Class::OtherProp, pose);
        for i in 0..self.count {
            let h = rng.range(0.07, 0.13);
            let x = 0.085 * (i as f32 - 0.5 * (self.count - 1) as f32);
            let foot = [
                [0.0, 0.0],
                [0.034, 0.0],
                [0.036, 0.004],
                [0.03, 0.009],
                [0.007, 0.014],
                [0.006, h - 0.018],
                [0.016, h - 0.012],
                [0.016, h],
                [0.0, h],
            ];
            let at = Vec3::new(x, 0.01 * (i as f32), CONTACT);
            b.part(&candles, &format!("foot_{}", i + 1), lathe(&foot.map(Vec2::from_array), 24).moved(at), Finish::Brass);
            let wax = [[0.0, 0.0], [0.0095, 0.0], [0.0095, 0.13], [0.007, 0.134], [0.0, 0.133]];
            b.part(
                &candles,
                &format!("wax_{}", i + 1),
                lathe(&wax.map(Vec2::from_array), 18).moved(at + Vec3::new(0.0, 0.0, h - 0.0002)),
                Finish::Wax,
            );
            let wick = tube(&[at + Vec3::new(0.0, 0.0, h + 0.131), at + Vec3::new(0.001, 0.0, h + 0.143)], 0.0008, 5);
            b.part(&candles, &format!("wick_{}", i + 1), wick, Finish::Soil);
        }
    }
}

/// A wooden tray with a raised rim.
#[derive(Clone, Copy, Debug)]
pub struct Tray {
    /// Radius.
    pub radius: f32,
}

impl Tray {
    /// Height of the surface that things stand on, metres; the rim is 2 cm higher.
    pub const TOP: f32 = 0.009;
}

impl Furniture for Tray {
    fn random(rng: &mut Rng) -> Self {
        Self { radius: rng.range(0.14, 0.2) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.radius, 2.0 * self.radius, 0.028)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let tray = b.object("tray", Class::OtherProp, pose);
        let r = self.radius;
        let profile = [
            [0.0, 0.0],
            [r - 0.006, 0.0],
            [r, 0.004],
            [r, 0.026],
            [r - 0.003, 0.028],
            [r - 0.006, 0.026],
            [r - 0.007, 0.0085],
            [0.0, 0.0085],
        ];
        let mut mesh = lathe(&profile.map(Vec2::from_array), 56);
        for (uv, p) in mesh.uvs.iter_mut().zip(&mesh.positions) {
            *uv = Vec2::new(p.x, p.y + p.z);
        }
        b.part(&tray, "body", grained(mesh, rng).moved(Vec3::new(0.0, 0.0, CONTACT)), Finish::DarkWood);
    }
}

/// A woven basket with a folded blanket in it.
#[derive(Clone, Copy, Debug)]
pub struct Basket {
    /// Radius of the rim.
    pub radius: f32,
}

impl Furniture for Basket {
    fn random(rng: &mut Rng) -> Self {
        Self { radius: rng.range(0.17, 0.23) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.radius, 2.0 * self.radius, 0.40)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let basket = b.object("basket", Class::OtherProp, pose);
        let r = self.radius;
        let outside = spline(&[[0.80 * r, 0.0], [0.94 * r, 0.08], [r, 0.18], [0.97 * r, 0.30], [0.93 * r, 0.34]], 6);
        let mut profile = vec![Vec2::ZERO];
        profile.extend(&outside);
        profile.extend(outside.iter().rev().map(|p| Vec2::new(p.x - 0.012, p.y.max(0.012) + if p.y > 0.33 { 0.004 } else { 0.0 })));
        profile.push(Vec2::new(0.0, 0.012));
        b.part(&basket, "weave", lathe(&profile, 48).moved(Vec3::new(0.0, 0.0, CONTACT)), Finish::Wicker);
        let cloth = crate::shape::padded_box(Vec3::new(1.22 * r, 1.0 * r, 0.20), 0.05, 0.03).uv_moved(Vec2::splat(rng.next_f32()));
        let blanket = b.object("blanket", Class::OtherProp, pose);
        // Folds below the uppermost fill the basket.
        let below = crate::shape::padded_box(Vec3::new(1.2 * r, 1.0 * r, 0.15), 0.05, 0.01).moved(Vec3::new(0.0, 0.0, 0.098));
        b.part(&blanket, "folds", below, Finish::Accent(1));
        b.part(&blanket, "cloth", cloth.turned(Vec3::X, 0.1).turned(Vec3::Z, 0.5).moved(Vec3::new(0.0, 0.0, 0.265)), Finish::Accent(1));
    }
}
