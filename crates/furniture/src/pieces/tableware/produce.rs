//! Things to eat, class other prop: a bowl of 30 cm with nine pieces of fruit and perhaps bananas, a loaf on a board with up to three
//! slices cut off, and pots of basil, rosemary or chives. Each fruit and slice is an object.

use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, cut_out, turned, vessel, wire};
use crate::pieces::{CONTACT, Furniture, board, grained, on};
use crate::shape::{Reshape, disk, leaf, rounded_box, sphere, spline};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// A bowl full of fruit.
#[derive(Clone, Copy, Debug)]
pub struct FruitBowl {
    /// Bananas lie over the rest.
    pub bananas: bool,
}

/// An apple-like body of radius `r` about the origin: hollow at the stalk and at its foot.
fn apple(r: f32, n: usize) -> Mesh {
    let outline = spline(
        &[
            [0.0, -0.74 * r],
            [0.3 * r, -0.9 * r],
            [0.8 * r, -0.6 * r],
            [r, 0.1 * r],
            [0.72 * r, 0.74 * r],
            [0.28 * r, 0.86 * r],
            [0.0, 0.62 * r],
        ],
        4,
    );
    let profile: Vec<[f32; 2]> = outline.iter().map(Vec2::to_array).collect();
    turned(&profile, n).with(wire(&[[0.0, 0.0, 0.6 * r], [0.01 * r, 0.0, 0.8 * r], [0.1 * r, 0.0, 1.05 * r]], 0.0013, 6))
}

fn pear(r: f32, n: usize) -> Mesh {
    let outline =
        spline(&[[0.0, -0.9 * r], [0.5 * r, -0.85 * r], [r, -0.1 * r], [0.75 * r, 0.7 * r], [0.38 * r, 1.3 * r], [0.0, 1.5 * r]], 4);
    let profile: Vec<[f32; 2]> = outline.iter().map(Vec2::to_array).collect();
    turned(&profile, n).with(wire(&[[0.0, 0.0, 1.45 * r], [0.02 * r, 0.0, 1.65 * r], [0.12 * r, 0.0, 1.85 * r]], 0.0013, 6))
}

fn lemon(r: f32, n: usize) -> Mesh {
    let outline = spline(
        &[
            [0.0, -1.32 * r],
            [0.16 * r, -1.22 * r],
            [0.7 * r, -0.75 * r],
            [r, 0.0],
            [0.7 * r, 0.75 * r],
            [0.2 * r, 1.2 * r],
            [0.0, 1.35 * r],
        ],
        4,
    );
    let profile: Vec<[f32; 2]> = outline.iter().map(Vec2::to_array).collect();
    turned(&profile, n)
}

/// Fruit of kind `k` and its skin, by the numbers of [`Finish::Fruit`].
fn fruit(k: usize, r: f32) -> (&'static str, Mesh, Finish) {
    match k {
        0 | 3 => ("apple", apple(r, 24), Finish::Fruit(k as u8)),
        1 => ("orange", sphere(r, 28), Finish::Fruit(1)),
        2 => ("lemon", lemon(0.78 * r, 24), Finish::Fruit(2)),
        4 => ("pear", pear(0.9 * r, 24), Finish::Fruit(4)),
        _ => ("plum", sphere(0.7 * r, 24), Finish::Fruit(5)),
    }
}

impl Furniture for FruitBowl {
    fn random(rng: &mut Rng) -> Self {
        Self { bananas: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.30, 0.30, if self.bananas { 0.215 } else { 0.18 })
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let bowl = b.object("bowl", Class::OtherProp, pose);
        let body = vessel(&[[0.055, 0.0], [0.062, 0.008], [0.10, 0.025], [0.135, 0.055], [0.148, 0.085]], 0.005, 48);
        let finish = if rng.below(2) == 0 { Finish::DarkWood } else { Finish::Ceramic(rng.below(3) as u8) };
        b.part(&bowl, "body", body.moved(Vec3::new(0.0, 0.0, CONTACT)), finish);
        let kinds = [rng.below(6), rng.below(6)];
        let r = 0.037;
        // Three at the bottom, five on the slope of the bowl around them, one on top; a home that settles lets them down.
        let ring = |n: usize, radius: f32, z: f32, start: f32| {
            (0..n).map(move |i| (Vec2::from_angle(start + TAU * i as f32 / n as f32) * radius).extend(z))
        };
        let start = rng.range(0.0, TAU);
        let places = ring(3, 0.046, 0.045, start).chain(ring(5, 0.094, 0.105, start + 0.4)).chain(ring(1, 0.0, 0.108, 0.0));
        for (i, at) in places.enumerate() {
            let (name, mesh, skin) = fruit(kinds[i % 2], r * rng.range(0.94, 1.0));
            let tilt = rng.range(0.2, 1.2);
            let object = b.object(name, Class::OtherProp, on(pose, at, rng.range(0.0, TAU)));
            b.part(&object, "body", mesh.turned(Vec3::X, tilt), skin);
        }
        if self.bananas {
            self.bunch(b, pose, rng);
        }
    }
}

impl FruitBowl {
    fn bunch(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("bananas", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, 0.168), rng.range(0.0, TAU)));
        // Radius of the arc that a banana follows.
        let bend = 0.13;
        let fingers = (0..4).map(|k| {
            let fan = 0.28 * (k as f32 - 1.5);
            let points: Vec<[f32; 3]> = (0..=6)
                .map(|i| {
                    let a = 1.3 * (i as f32 / 6.0 - 0.5);
                    [bend * a.sin(), 0.0, bend * (a.cos() - 1.0) + 0.028]
                })
                .collect();
            wire(&points, 0.0165, 12)
                .deformed(|p| {
                    // Fingers are thick in the middle and meet at the stalk.
                    let t = (p.x / 0.079).clamp(-1.0, 1.0);
                    let slim = 1.0 - 0.75 * t.abs().powi(4);
                    let spine = bend * ((1.0 - (p.x / bend).powi(2)).max(0.0).sqrt() - 1.0) + 0.028;
                    Vec3::new(p.x, p.y * slim, spine + (p.z - spine) * slim)
                })
                .moved(Vec3::new(0.08, 0.0, 0.0))
                .turned(Vec3::Z, fan)
                .moved(Vec3::new(-0.08, 0.012 * (k as f32 - 1.5), 0.0))
                .smoothed(60.0)
        });
        b.part(&object, "fingers", all(fingers), Finish::Fruit(2));
    }
}

/// A loaf on a board, with slices cut off.
#[derive(Clone, Copy, Debug)]
pub struct Bread {
    /// Number of slices in front of it.
    pub slices: usize,
}

impl Furniture for Bread {
    fn random(rng: &mut Rng) -> Self {
        Self { slices: rng.below(4) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.42, 0.22, 0.13)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let tray = b.object("cutting_board", Class::OtherProp, pose);
        b.part(&tray, "body", grained(board([-0.19, -0.11, CONTACT], [0.19, 0.11, 0.018], 0.004), rng), Finish::Wood);
        let loaf = b.object("bread", Class::OtherProp, on(pose, Vec3::new(0.04, 0.0, 0.018 + CONTACT), 0.0));
        b.part(&loaf, "loaf", loaf_crust(), Finish::Bread);
        b.part(&loaf, "crumb", loaf_crumb(), Finish::Wax);
        for k in 0..self.slices {
            let at = Vec3::new(-0.11 - 0.008 * k as f32, 0.02 * k as f32 - 0.02, 0.018 + CONTACT + 0.0072 + 0.0146 * k as f32);
            let object = b.object("bread_slice", Class::OtherProp, on(pose, at, rng.range(-0.3, 0.3)));
            b.part(&object, "crust", rounded_box(Vec3::new(0.105, 0.095, 0.013), 0.006, 3), Finish::Bread);
            b.part(&object, "crumb", rounded_box(Vec3::new(0.094, 0.084, 0.0144), 0.003, 2), Finish::Wax);
        }
    }
}

/// Position of the cut of a loaf, as x in its own space, metres.
const CUT: f32 = -0.07;

/// From −1..1 across and 0..1 up to the section of a loaf: domed, a little wider in the middle than at the top.
fn loaf_section(across: f32, up: f32) -> Vec2 {
    Vec2::new(0.055 * across * (1.0 - 0.14 * up.powi(3)), 0.1 * up * (1.0 - 0.3 * across * across * up))
}

fn loaf_crust() -> Mesh {
    let crust = crate::shape::padded_box(Vec3::new(0.24, 1.0, 1.0), 0.1, 0.0).moved(Vec3::new(0.0, 0.0, 0.5));
    let shaped = crust.deformed(|p| {
        let x = p.x.max(CUT);
        let scores = 0.05 * (x * 95.0).sin().max(0.0).powi(8) * p.z.powi(6);
        let q = loaf_section(2.0 * p.y, p.z - scores) * (1.0 - 0.5 * (x / 0.12).max(0.0).powi(4));
        Vec3::new(x, q.x, q.y)
    });
    shaped.smoothed(60.0)
}

/// The crumb that the cut face shows.
fn loaf_crumb() -> Mesh {
    let outline: Vec<Vec2> = (0..40)
        .map(|k| {
            let d = Vec2::from_angle(TAU * k as f32 / 40.0);
            let d = d / d.abs().max_element();
            let q = loaf_section(0.9 * d.y, 0.5 + 0.45 * d.x);
            Vec2::new(q.y, q.x)
        })
        .collect();
    cut_out(&outline, 0.002, 0.0004).turned(Vec3::Y, -0.5 * std::f32::consts::PI).moved(Vec3::X * (CUT + 0.001))
}

/// A pot of herbs.
#[derive(Clone, Copy, Debug)]
pub struct HerbPot {
    /// Radius of the pot.
    pub radius: f32,
    /// 0 basil with broad leaves, 1 rosemary with needles, 2 chives.
    pub kind: u8,
}

impl HerbPot {
    fn herbs(&self, b: &mut Builder, plant: &Object, soil: f32, rng: &mut Rng) {
        let mut greens = Mesh::default();
        for k in 0..22 {
            let out = Vec2::from_angle(2.4 * k as f32 + rng.range(-0.3, 0.3));
            let t = ((k as f32 + 0.5) / 22.0).sqrt();
            let foot = out * 0.7 * self.radius * t;
            let (lean, height) = (0.55 * t, rng.range(0.09, 0.15));
            let tip = foot + out * height * lean;
            let stalk = wire(
                &[
                    [foot.x, foot.y, soil - 0.004],
                    [0.6 * foot.x + 0.4 * tip.x, 0.6 * foot.y + 0.4 * tip.y, soil + 0.5 * height],
                    [tip.x, tip.y, soil + height],
                ],
                0.0011,
                4,
            );
            greens = greens.with(stalk);
            let leaves = [5, 9, 0][usize::from(self.kind) % 3];
            for j in 0..leaves {
                let s = 0.4 + 0.6 * j as f32 / (leaves - 1).max(1) as f32;
                let (length, width) = if self.kind == 0 { (0.042, 0.03) } else { (0.022, 0.0035) };
                let at = foot.lerp(tip, s * s).extend(soil + height * s);
                let blade = leaf(length * rng.range(0.7, 1.1), width, 0.5)
                    .turned(Vec3::Y, -rng.range(0.1, 0.9))
                    .turned(Vec3::Z, 2.4 * j as f32 + 1.1 * k as f32);
                greens = greens.with(blade.moved(at));
            }
        }
        b.part(plant, "greens", greens, if self.kind == 1 { Finish::PaleLeaf } else { Finish::Leaf });
    }
}

impl Furniture for HerbPot {
    fn random(rng: &mut Rng) -> Self {
        Self { radius: rng.range(0.05, 0.062), kind: rng.below(3) as u8 }
    }

    fn size(&self) -> Vec3 {
        let w = 2.0 * self.radius + 0.24;
        Vec3::new(w, w, 0.29)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let plant = b.object("herbs", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let (r, h) = (self.radius, 1.75 * self.radius);
        let rim = 0.8 * h;
        let outside = [[0.72 * r, 0.0], [0.93 * r, rim], [r, rim + 0.001], [r, h]];
        b.part(&plant, "pot", vessel(&outside, 0.005, 36), [Finish::Terracotta, Finish::Ceramic(0), Finish::Steel][rng.below(3)]);
        let soil = 0.86 * h;
        b.part(&plant, "soil", disk(0.93 * r - 0.004, 28).moved(Vec3::new(0.0, 0.0, soil)), Finish::Soil);
        self.herbs(b, &plant, soil, rng);
    }
}
