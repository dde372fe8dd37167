//! Plants, all of class other prop: in a pot (ferns, cacti, monsteras, swords and palms, in pots of 10 to 19 cm radius that scale them),
//! hanging from the ceiling, and cut flowers in a vase of 14 to 24 cm. Leaves are meshes of their own that are turned and placed; the
//! origin of the hanging plant is on the ceiling.

use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, around, turned, vessel, wire};
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, disk, grid, leaf, sphere, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Angle from one leaf, stalk or flower to the next, radians: the golden angle, by which they shade each other least.
const GOLDEN_ANGLE: f32 = 2.4;
/// A plant of one of several habits in a pot.
#[derive(Clone, Copy, Debug)]
pub struct Foliage {
    /// Habit of the plant.
    pub habit: Habit,
    /// Radius of the pot's rim.
    pub pot: f32,
    /// Finish of the pot.
    pub finish: Finish,
}

/// The habit of a plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Habit {
    /// Arching fronds with many leaflets.
    Fern,
    /// Ribbed columns with thorns.
    Cactus,
    /// Broad leaves with deep cuts on long stalks.
    Monstera,
    /// Upright blades like swords.
    Sword,
    /// Feathered fronds of a palm.
    Palm,
}

impl Foliage {
    fn soil(&self) -> f32 {
        1.62 * self.pot
    }

    fn pot(&self, b: &mut Builder, plant: &Object) {
        let (r, h) = (self.pot, 1.8 * self.pot);
        let outside = if self.finish == Finish::Terracotta {
            vec![[0.7 * r, 0.0], [0.92 * r, 0.8 * h], [0.99 * r, 0.805 * h], [r, h]]
        } else {
            vec![[0.78 * r, 0.0], [0.84 * r, 0.02 * h], [0.97 * r, 0.6 * h], [r, h]]
        };
        b.part(plant, "pot", vessel(&outside, 0.06 * r + 0.002, 48), self.finish);
        b.part(plant, "soil", disk(0.9 * r, 36).moved(Vec3::new(0.0, 0.0, self.soil())), Finish::Soil);
    }

    /// A frond from the middle of the pot: leaflets on both sides of an arching rib.
    fn frond(&self, length: f32, rise: f32, turn: f32, leaflet: f32, pairs: usize) -> [Mesh; 2] {
        // The rib starts at the angle `rise` and bends over as it goes out.
        let point = |t: f32| {
            let a = rise - 1.5 * t * t;
            let out = length * t * (0.5 * (rise.cos() + a.cos()));
            let up = length * t * (0.6 * rise.sin() + 0.4 * a.sin());
            Vec3::new(out, 0.0, up)
        };
        let path: Vec<Vec3> = (0..=10).map(|k| point(k as f32 / 10.0)).collect();
        let rib = tube(&path, 0.004 * length.sqrt(), 5);
        let blades = (0..pairs).flat_map(|k| {
            let t = 0.14 + 0.85 * k as f32 / (pairs - 1) as f32;
            let size = leaflet * (PI * (0.12 + 0.8 * t)).sin().max(0.15);
            let ahead = (point((t + 0.03).min(1.0)) - point(t - 0.03)).normalize_or(Vec3::X);
            [-1.0f32, 1.0].map(|s| {
                let blade = leaf(size, 0.22 * size, 0.7).turned(Vec3::Z, s * 1.05);
                blade.turned(Vec3::Y, -ahead.z.clamp(-1.0, 1.0).asin()).moved(point(t))
            })
        });
        let place = |mesh: Mesh| mesh.turned(Vec3::Z, turn).moved(Vec3::new(0.0, 0.0, self.soil() - 0.004));
        [place(rib), place(all(blades))]
    }

    fn fronds(&self, b: &mut Builder, plant: &Object, rng: &mut Rng) {
        let palm = self.habit == Habit::Palm;
        let count = if palm { 9 } else { 18 };
        let (mut ribs, mut blades) = (Vec::new(), Vec::new());
        for k in 0..count {
            let turn = GOLDEN_ANGLE * k as f32 + rng.range(-0.2, 0.2);
            let [rib, blade] = if palm {
                self.frond(self.pot * rng.range(4.0, 5.4), rng.range(1.0, 1.42), turn, 0.24, 15)
            } else {
                self.frond(self.pot * rng.range(2.0, 2.9), rng.range(0.55, 1.35), turn, 0.34 * self.pot, 15)
            };
            ribs.push(rib);
            blades.push(blade);
        }
        b.part(plant, "ribs", all(ribs), if palm { Finish::PaleLeaf } else { Finish::Leaf });
        b.part(plant, "fronds", all(blades), if palm { Finish::Leaf } else { Finish::PaleLeaf });
    }

    fn cactus(&self, b: &mut Builder, plant: &Object, rng: &mut Rng) {
        let columns = 1 + rng.below(3);
        for (k, d) in around(columns, rng.range(0.0, TAU)).enumerate() {
            let at = if columns == 1 { Vec2::ZERO } else { d * 0.42 * self.pot };
            let (r, h) = (self.pot * if columns == 1 { 0.5 } else { 0.34 }, self.pot * rng.range(1.8, 3.6) * (1.0 - 0.2 * k as f32));
            let ribs = 11.0;
            let outline = |t: f32| (r * (1.0 - (2.0 * (t - 0.55)).max(0.0).powi(4)).max(0.0).powf(0.5) * (0.86 + 0.3 * t.min(0.5)), h * t);
            let around_n = 88;
            let body = grid(
                around_n,
                20,
                |i, j| {
                    let a = TAU * (i % around_n) as f32 / around_n as f32;
                    let t = j as f32 / 20.0;
                    let (radius, z) = outline(t);
                    let radius = if j == 20 { 0.0 } else { radius * (0.9 + 0.1 * (ribs * a).cos()) };
                    Vec3::new(at.x + radius * a.cos(), at.y + radius * a.sin(), self.soil() - 0.003 + z)
                },
                |i, j| Vec2::new(i as f32 * 0.01, j as f32 * 0.02),
            );
            b.part(plant, &format!("column_{}", k + 1), body.smoothed(60.0), Finish::Leaf);
            let thorns = (0..11).flat_map(|rib| (1..9).map(move |j| (TAU * rib as f32 / ribs, j as f32 / 10.0)));
            let thorns = thorns.map(|(a, t)| {
                let (radius, z) = outline(t);
                let (d, foot) = (Vec2::from_angle(a), radius - 0.001);
                let base = Vec3::new(at.x + d.x * foot, at.y + d.y * foot, self.soil() - 0.003 + z);
                tube(&[base, base + Vec3::new(d.x, d.y, 0.4) * 0.011], 0.0006, 3)
            });
            b.part(plant, &format!("thorns_{}", k + 1), all(thorns), Finish::Paper);
        }
    }

    fn stalked(&self, b: &mut Builder, plant: &Object, rng: &mut Rng) {
        let (mut stalks, mut blades) = (Vec::new(), Vec::new());
        for k in 0..10 {
            let turn = GOLDEN_ANGLE * k as f32 + rng.range(-0.3, 0.3);
            let t = k as f32 / 9.0;
            let (out, up) = (self.pot * rng.range(1.0, 1.7) * (1.0 - 0.4 * t), self.pot * (1.6 + 2.6 * t) * rng.range(0.9, 1.1));
            let d = Vec2::from_angle(turn);
            let tip = [d.x * out, d.y * out, self.soil() + up];
            stalks.push(wire(
                &[[d.x * 0.01, d.y * 0.01, self.soil() - 0.01], [d.x * 0.3 * out, d.y * 0.3 * out, self.soil() + 0.6 * up], tip],
                0.0042,
                7,
            ));
            let size = self.pot * rng.range(1.5, 2.0);
            let blade = cut_leaf(size).turned(Vec3::X, rng.range(-0.2, 0.2)).turned(Vec3::Y, rng.range(0.1, 0.7)).turned(Vec3::Z, turn);
            blades.push(blade.moved(Vec3::from_array(tip)));
        }
        b.part(plant, "stalks", all(stalks), Finish::PaleLeaf);
        b.part(plant, "leaves", all(blades), Finish::Leaf);
    }

    fn swords(&self, b: &mut Builder, plant: &Object, rng: &mut Rng) {
        let blades = (0..13).map(|k| {
            let length = self.pot * rng.range(3.2, 5.4);
            let width = 0.42 * self.pot;
            let (twist, lean) = (rng.range(-0.6, 0.6), rng.range(0.02, 0.2));
            let at = Vec2::from_angle(GOLDEN_ANGLE * k as f32) * 0.55 * self.pot * ((k as f32 + 0.5) / 13.0).sqrt();
            let blade = grid(
                4,
                12,
                |i, j| {
                    let (u, t) = (i as f32 / 2.0 - 1.0, j as f32 / 12.0);
                    let half = 0.5 * width * (0.7 + 0.6 * t) * (1.0 - t.powi(3)).max(0.0).sqrt().max(if j == 12 { 0.0 } else { 0.1 });
                    let (sin, cos) = (twist * t).sin_cos();
                    let p = Vec2::new(cos, sin) * u * half + Vec2::new(-sin, cos) * 0.25 * half * u * u;
                    Vec3::new(p.x, p.y + lean * length * t * t, length * t)
                },
                |i, j| Vec2::new(i as f32 * 0.02, j as f32 * 0.04),
            );
            blade.smoothed(60.0).turned(Vec3::Z, at.to_angle() - 0.5 * PI).moved(at.extend(self.soil() - 0.01))
        });
        b.part(plant, "blades", all(blades), Finish::Leaf);
    }
}

/// A heart-shaped leaf along +x with cuts between its veins.
fn cut_leaf(length: f32) -> Mesh {
    let (nu, nv) = (40, 8);
    let point = |i: usize, j: usize| {
        let (s, t) = (i as f32 / nu as f32, 2.0 * j as f32 / nv as f32 - 1.0);
        let heart = 0.5 * length * 1.0 * ((PI * s.powf(0.62)).sin().max(0.0)).powf(0.6) * (1.0 - 0.35 * s);
        // The outline is cut in towards the rib seven times.
        let wave = (0.5 + 0.5 * (TAU * 7.0 * s).cos()).powi(5);
        let cut = 1.0 - 0.62 * wave * (PI * s).sin().powi(2) * t.abs();
        let sweep = 0.16 * length * t.abs();
        Vec3::new(length * s * 1.05 - 0.12 * length + sweep * (1.0 - s), heart * cut * t, -0.22 * length * s * s + 0.05 * length * t.abs())
    };
    grid(nu, nv, point, |i, j| Vec2::new(i as f32 / nu as f32, j as f32 / nv as f32)).smoothed(70.0)
}

impl Furniture for Foliage {
    fn random(rng: &mut Rng) -> Self {
        let habit = [Habit::Fern, Habit::Cactus, Habit::Monstera, Habit::Sword, Habit::Palm][rng.below(5)];
        let pot = match habit {
            Habit::Palm | Habit::Monstera => rng.range(0.15, 0.19),
            Habit::Sword => rng.range(0.12, 0.16),
            Habit::Fern | Habit::Cactus => rng.range(0.1, 0.15),
        };
        Self {
            habit,
            pot,
            finish: [Finish::Terracotta, Finish::Ceramic(0), Finish::Ceramic(1), Finish::Wicker, Finish::Concrete][rng.below(5)],
        }
    }

    fn size(&self) -> Vec3 {
        let r = self.pot;
        let (reach, height) = match self.habit {
            Habit::Fern => (2.7, 3.6),
            Habit::Cactus => (1.0, 5.4),
            Habit::Monstera => (3.7, 7.0),
            Habit::Sword => (2.1, 7.1),
            Habit::Palm => (4.2, 6.6),
        };
        Vec3::new(2.0 * reach * r, 2.0 * reach * r, height * r)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let plant = b.object("plant", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        self.pot(b, &plant);
        match self.habit {
            Habit::Fern | Habit::Palm => self.fronds(b, &plant, rng),
            Habit::Cactus => self.cactus(b, &plant, rng),
            Habit::Monstera => self.stalked(b, &plant, rng),
            Habit::Sword => self.swords(b, &plant, rng),
        }
    }
}

/// A pot that hangs from the ceiling with trailing shoots; its origin is on the ceiling.
#[derive(Clone, Copy, Debug)]
pub struct HangingPlant {
    /// Distance from the ceiling to the pot's rim.
    pub drop: f32,
    /// Length of the longest shoots below the rim, metres.
    pub trail: f32,
}

impl Furniture for HangingPlant {
    fn random(rng: &mut Rng) -> Self {
        Self { drop: rng.range(0.5, 0.75), trail: rng.range(0.35, 0.6) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.52, 0.52, self.drop + self.trail + 0.09)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let plant = b.object("hanging_plant", Class::OtherProp, pose);
        let (r, rim) = (0.1, -self.drop);
        b.part(&plant, "hook", turned(&[[0.0, -0.02], [0.008, -0.02], [0.02, -0.004], [0.02, 0.0], [0.0, 0.0]], 20), Finish::Brass);
        let bowl = vessel(&[[0.03, rim - 0.13], [0.07, rim - 0.115], [r, rim - 0.05], [r, rim]], 0.005, 44);
        b.part(&plant, "pot", bowl, Finish::Ceramic(rng.below(3) as u8));
        b.part(&plant, "soil", disk(r - 0.006, 32).moved(Vec3::new(0.0, 0.0, rim - 0.012)), Finish::Soil);
        let cords = around(3, 0.4).map(|d| {
            wire(
                &[
                    [0.0, 0.0, -0.018],
                    [d.x * 0.05, d.y * 0.05, 0.5 * rim],
                    [d.x * (r + 0.003), d.y * (r + 0.003), rim - 0.01],
                    [d.x * 0.06, d.y * 0.06, rim - 0.122],
                ],
                0.0022,
                6,
            )
        });
        b.part(&plant, "cords", all(cords), Finish::Wicker);
        let (mut shoots, mut leaves) = (Vec::new(), Vec::new());
        for k in 0..16 {
            let d = Vec2::from_angle(GOLDEN_ANGLE * k as f32 + rng.range(-0.2, 0.2));
            let length = self.trail * rng.range(0.25, 1.0);
            let out = r + rng.range(0.015, 0.06);
            let path = [
                [d.x * 0.03, d.y * 0.03, rim - 0.015],
                [d.x * 0.8 * r, d.y * 0.8 * r, rim + 0.025],
                [d.x * out, d.y * out, rim - 0.04],
                [d.x * (out + 0.012), d.y * (out + 0.012), rim - length],
            ];
            shoots.push(wire(&path, 0.0015, 4));
            let count = 3 + (length / 0.045) as usize;
            for j in 0..count {
                let t = j as f32 / (count - 1) as f32;
                let z = rim + 0.012 - (length - 0.01) * t;
                let at = Vec3::new(d.x * (out + 0.01 * t), d.y * (out + 0.01 * t), z.min(rim + 0.01));
                let size = rng.range(0.045, 0.07) * (1.0 - 0.3 * t);
                leaves.push(
                    leaf(size, 0.75 * size, 0.6)
                        .turned(Vec3::Y, rng.range(0.2, 1.0))
                        .turned(Vec3::Z, d.to_angle() + rng.range(-1.3, 1.3))
                        .moved(at),
                );
            }
        }
        b.part(&plant, "shoots", all(shoots), Finish::PaleLeaf);
        b.part(&plant, "leaves", all(leaves), Finish::Leaf);
    }
}

/// A vase of cut flowers.
#[derive(Clone, Copy, Debug)]
pub struct FlowerVase {
    /// Height of the vase.
    pub height: f32,
    /// Glass instead of pottery.
    pub glass: bool,
    /// Number of flowers.
    pub flowers: usize,
    /// 0 daisies, 1 tulips, 2 round heads.
    pub kind: u8,
}

impl FlowerVase {
    /// The petals and the heart of a flower that looks up, at the origin.
    fn head(&self, size: f32) -> [Mesh; 2] {
        match self.kind {
            0 => {
                let petals = around(13, 0.0).map(|d| leaf(size, 0.36 * size, 0.25).turned(Vec3::Y, -0.2).turned(Vec3::Z, d.to_angle()));
                [all(petals), sphere(0.3 * size, 14).deformed(|p| Vec3::new(p.x, p.y, 0.5 * p.z + 0.05 * size)).smoothed(60.0)]
            }
            1 => {
                let petal = |d: Vec2, r: f32| {
                    leaf(1.25 * size, 0.85 * size, -0.5).turned(Vec3::Y, -1.15).turned(Vec3::Z, d.to_angle()).moved((d * r).extend(0.0))
                };
                let petals = around(3, 0.0).map(|d| petal(d, 0.08 * size)).chain(around(3, 1.05).map(|d| petal(d, 0.16 * size)));
                [all(petals), sphere(0.2 * size, 12)]
            }
            _ => {
                let petals = (0..34).map(|k| {
                    let z = 1.0 - 1.7 * (k as f32 + 0.5) / 34.0;
                    let a = GOLDEN_ANGLE * k as f32;
                    leaf(0.55 * size, 0.5 * size, 0.9).turned(Vec3::Y, -z.asin()).turned(Vec3::Z, a).moved(Vec3::new(0.0, 0.0, 0.4 * size))
                });
                [all(petals), sphere(0.35 * size, 14).moved(Vec3::new(0.0, 0.0, 0.35 * size))]
            }
        }
    }
}

impl Furniture for FlowerVase {
    fn random(rng: &mut Rng) -> Self {
        Self { height: rng.range(0.14, 0.24), glass: rng.below(2) == 0, flowers: 5 + rng.below(7), kind: rng.below(3) as u8 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.36, 0.36, 1.95 * self.height + 0.06)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let vase = b.object("flower_vase", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let h = self.height;
        let outside = [[0.2 * h, 0.0], [0.26 * h, 0.05 * h], [0.29 * h, 0.4 * h], [0.2 * h, 0.8 * h], [0.24 * h, h]];
        b.part(
            &vase,
            "body",
            vessel(&outside, 0.004, 44),
            if self.glass { Finish::DrinkingGlass } else { Finish::Ceramic(rng.below(3) as u8) },
        );
        let (mut stems, mut petals, mut hearts, mut leaves) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for k in 0..self.flowers {
            let t = ((k as f32 + 0.5) / self.flowers as f32).sqrt();
            let d = Vec2::from_angle(GOLDEN_ANGLE * k as f32 + rng.range(-0.2, 0.2));
            let (foot, rim) = (-0.06 * h * d, 0.15 * h * t * d);
            let out = d * t * (0.1 + 0.12 * h);
            let z = h * rng.range(1.55, 1.85) - 0.1 * h * t;
            let path = [[foot.x, foot.y, 0.005], [rim.x, rim.y, 0.95 * h], [out.x, out.y, z]];
            stems.push(wire(&path, 0.0018, 5));
            let size = rng.range(0.03, 0.04);
            let tilt = 0.9 * t;
            let place = |mesh: Mesh| mesh.turned(Vec3::Y, tilt).turned(Vec3::Z, d.to_angle()).moved(out.extend(z));
            let [petal, heart] = self.head(size);
            petals.push(place(petal));
            hearts.push(place(heart));
            let blade = leaf(0.09, 0.024, 0.9).turned(Vec3::Y, -0.5).turned(Vec3::Z, d.to_angle() + 0.8);
            leaves.push(blade.moved((0.5 * (rim + out)).extend(0.55 * (h + z))));
        }
        b.part(&vase, "stems", all(stems), Finish::PaleLeaf);
        b.part(&vase, "leaves", all(leaves), Finish::Leaf);
        b.part(&vase, "petals", all(petals), Finish::Petal(rng.below(5) as u8));
        b.part(&vase, "hearts", all(hearts), if self.kind == 0 { Finish::Fruit(2) } else { Finish::Petal(rng.below(5) as u8) });
    }
}
