//! Bags, all of class bag: backpacks 40 to 48 cm high, leather handbags, shopping bags of paper or cloth, and suitcases on wheels in three
//! common sizes (50, 61 and 70 cm). Cloth and leather bags are padded boxes that narrow to the top and are dented a little; all stand on z
//! = 0 with their front to +y.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, rod, wire};
use crate::pieces::soft::Wrinkles;
use crate::pieces::{CONTACT, Furniture};
use crate::shape::{Reshape, padded_box, rounded_box, rounded_loop, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

/// A padded box that stands on z = 0, narrower and rounder to the top, its cloth a little uneven.
fn sack(size: Vec3, taper: f32, soft: f32, rng: &mut Rng) -> Mesh {
    let uneven = Wrinkles::new(0.14, soft, rng);
    padded_box(size, 0.3 * size.y.min(size.x), 0.05 * size.y)
        .deformed(|p| {
            let t = p.z / size.z + 0.5;
            let slim = 1.0 - taper * t * t;
            let dent = 1.0 - uneven.at(Vec2::new(p.x + 0.7 * p.y, p.z)) / size.y;
            Vec3::new(p.x * slim * (0.5 + 0.5 * dent), p.y * (1.0 - 1.3 * taper * t * t) * dent, (p.z + 0.5 * size.z).max(0.0))
        })
        .smoothed(75.0)
}

/// A strap: a flat band along `path`, `width` wide along x.
fn strap(path: &[[f32; 3]], width: f32) -> Mesh {
    let thick = 0.004;
    let middle = path[0][0];
    wire(path, 0.5 * thick, 8).deformed(|p| Vec3::new(middle + (p.x - middle) * width / thick, p.y, p.z)).smoothed(60.0)
}

/// A backpack that stands, its straps at −y.
#[derive(Clone, Copy, Debug)]
pub struct Backpack {
    /// Width, depth and height.
    pub size: Vec3,
}

impl Furniture for Backpack {
    fn random(rng: &mut Rng) -> Self {
        Self { size: Vec3::new(rng.range(0.28, 0.33), rng.range(0.17, 0.21), rng.range(0.40, 0.48)) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.size.x + 0.03, self.size.y + 0.17, self.size.z + 0.07)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let bag = b.object("backpack", Class::Bag, pose);
        let (s, cloth) = (self.size, Finish::Clothes(rng.below(8) as u8));
        b.part(&bag, "body", sack(s, 0.16, 0.014, rng).moved(Vec3::Z * CONTACT), cloth);
        let pocket = sack(Vec3::new(0.76 * s.x, 0.10, 0.46 * s.z), 0.08, 0.01, rng);
        b.part(&bag, "pocket", pocket.moved(Vec3::new(0.0, 0.48 * s.y, 0.03)), cloth);
        let zip = |w: f32, h: f32, y: f32, z: f32| {
            tube(&rounded_loop(w, h, 0.3 * w.min(h), 6), 0.0022, 6).turned(Vec3::X, FRAC_PI_2).moved(Vec3::new(0.0, y, z))
        };
        b.part(&bag, "zip", zip(0.56 * s.x, 0.10, 0.48 * s.y + 0.05, 0.34 * s.z), Finish::BlackPlastic);
        let straps = [-1.0f32, 1.0].map(|side| {
            let x = side * 0.24 * s.x;
            let back = -0.48 * s.y;
            strap(
                &[
                    [x, back + 0.05, 0.93 * s.z],
                    [x, back - 0.02, 0.88 * s.z],
                    [x, back - 0.065, 0.62 * s.z],
                    [x, back - 0.05, 0.35 * s.z],
                    [x, back + 0.015, 0.10 * s.z],
                ],
                0.05,
            )
        });
        b.part(&bag, "straps", all(straps), cloth);
        let grip = wire(
            &[
                [-0.045, -0.25 * s.y, 0.955 * s.z],
                [-0.04, -0.25 * s.y, s.z + 0.025],
                [0.0, -0.25 * s.y, s.z + 0.045],
                [0.04, -0.25 * s.y, s.z + 0.025],
                [0.045, -0.25 * s.y, 0.955 * s.z],
            ],
            0.006,
            10,
        );
        b.part(&bag, "grip", grip, Finish::BlackPlastic);
    }
}

/// A handbag of leather with one or two handles.
#[derive(Clone, Copy, Debug)]
pub struct Handbag {
    /// Width, depth and height of the body.
    pub size: Vec3,
}

impl Furniture for Handbag {
    fn random(rng: &mut Rng) -> Self {
        Self { size: Vec3::new(rng.range(0.26, 0.38), rng.range(0.11, 0.15), rng.range(0.2, 0.27)) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.size.x + 0.02, self.size.y + 0.03, self.size.z + 0.17)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let bag = b.object("handbag", Class::Bag, pose);
        let (s, leather) = (self.size, Finish::LeatherBag(rng.below(4) as u8));
        b.part(&bag, "body", sack(s, 0.20, 0.006, rng).moved(Vec3::Z * CONTACT), leather);
        let (x, y) = (0.24 * s.x, 0.30 * s.y);
        let handles = [-1.0f32, 1.0].map(|side| {
            let y = side * y;
            let high = s.z + 0.15;
            wire(
                &[
                    [-x, y, 0.72 * s.z],
                    [-x, y, s.z],
                    [-0.8 * x, 0.7 * y, s.z + 0.09],
                    [0.0, 0.5 * y, high],
                    [0.8 * x, 0.7 * y, s.z + 0.09],
                    [x, y, s.z],
                    [x, y, 0.72 * s.z],
                ],
                0.0055,
                12,
            )
        });
        b.part(&bag, "handles", all(handles), leather);
        b.part(
            &bag,
            "clasp",
            rounded_box(Vec3::new(0.03, 0.006, 0.02), 0.002, 2).moved(Vec3::new(0.0, 0.46 * s.y, 0.62 * s.z)),
            Finish::Brass,
        );
    }
}

/// A shopping bag of paper or cloth with cord handles.
#[derive(Clone, Copy, Debug)]
pub struct ShoppingBag {
    /// Width, depth and height.
    pub size: Vec3,
    /// Cloth instead of paper.
    pub cloth: bool,
}

impl Furniture for ShoppingBag {
    fn random(rng: &mut Rng) -> Self {
        Self { size: Vec3::new(rng.range(0.26, 0.36), rng.range(0.11, 0.16), rng.range(0.3, 0.4)), cloth: rng.below(3) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.size.x + 0.01, self.size.y + 0.01, self.size.z + 0.12)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let bag = b.object("shopping_bag", Class::Bag, pose);
        let s = self.size;
        let finish =
            if self.cloth { Finish::Clothes(rng.below(8) as u8) } else { [Finish::Paper, Finish::Cardboard, Finish::Paper][rng.below(3)] };
        let buckle = Wrinkles::new(0.16, if self.cloth { 0.012 } else { 0.006 }, rng);
        // A thin wall, folded inward along the middle of the narrow sides.
        let section = |grow: f32, z: f32| [s.x + grow, s.y + grow, 0.004, z];
        let wall = -0.003;
        let body = crate::pieces::form::loft(
            &[
                section(0.0, 0.0),
                section(0.0, 0.25 * s.z),
                section(0.0, 0.5 * s.z),
                section(0.0, 0.75 * s.z),
                section(0.0, s.z),
                section(wall, s.z),
                section(wall, 0.5 * s.z),
                section(wall, 0.004),
            ],
            2,
        )
        .deformed(|p| {
            let t = p.z / s.z;
            let pinch = 1.0 - 0.3 * t * t;
            let fold = 1.0 - 0.10 * t * (1.0 - (2.0 * p.y / s.y).abs()).max(0.0);
            let dent = 1.0 - buckle.at(Vec2::new(p.x, p.z + p.y)) / s.y * (3.0 * t).min(1.0);
            Vec3::new(p.x * fold, p.y * pinch * dent, p.z)
        })
        .smoothed(35.0);
        b.part(&bag, "body", body.moved(Vec3::Z * CONTACT), finish);
        let handles = [-1.0f32, 1.0].map(|side| {
            let (x, y) = (0.2 * s.x, side * 0.33 * s.y);
            wire(
                &[
                    [-x, y, s.z - 0.03],
                    [-0.95 * x, y, s.z + 0.04],
                    [-0.5 * x, 0.9 * y, s.z + 0.1],
                    [0.5 * x, 0.9 * y, s.z + 0.1],
                    [0.95 * x, y, s.z + 0.04],
                    [x, y, s.z - 0.03],
                ],
                0.003,
                8,
            )
        });
        b.part(&bag, "handles", all(handles), if self.cloth { finish } else { Finish::Paper });
    }
}

/// A suitcase on wheels with a ribbed shell.
#[derive(Clone, Copy, Debug)]
pub struct Suitcase {
    /// Width, depth and height of the shell.
    pub size: Vec3,
    /// The telescopic handle is pulled out.
    pub handle: bool,
}

/// Height of the shell above the floor, metres: the wheels are below it.
const WHEELS: f32 = 0.05;

impl Furniture for Suitcase {
    fn random(rng: &mut Rng) -> Self {
        let sizes = [Vec3::new(0.38, 0.22, 0.50), Vec3::new(0.44, 0.26, 0.61), Vec3::new(0.50, 0.30, 0.70)];
        Self { size: sizes[rng.below(3)], handle: rng.below(3) == 0 }
    }

    fn size(&self) -> Vec3 {
        let rise = if self.handle { 0.42 } else { 0.03 };
        Vec3::new(self.size.x + 0.01, self.size.y + 0.03, WHEELS + self.size.z + rise)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let case = b.object("suitcase", Class::Bag, pose);
        let s = self.size;
        let shell = [Finish::Plastic(rng.below(6) as u8), Finish::BlackPlastic, Finish::ColoredMetal(0)][rng.below(3)];
        let ribs = 9.0;
        let body = rounded_box(Vec3::new(s.x, s.y, s.z), 0.045, 4);
        b.part(&case, "shell", body.moved(Vec3::Z * (WHEELS + 0.5 * s.z)), shell);
        let grooves = (0..ribs as usize).flat_map(|k| {
            let x = (k as f32 + 0.5) / ribs * (s.x - 0.10) - 0.5 * (s.x - 0.10);
            [-1.0f32, 1.0].map(|side| {
                rounded_box(Vec3::new(0.018, 0.008, s.z - 0.11), 0.0035, 2).moved(Vec3::new(x, side * 0.5 * s.y, WHEELS + 0.5 * s.z))
            })
        });
        b.part(&case, "ribs", all(grooves), shell);
        let seam = tube(&rounded_loop(s.x + 0.003, s.z + 0.003, 0.045, 6), 0.004, 8)
            .turned(Vec3::X, FRAC_PI_2)
            .moved(Vec3::Z * (WHEELS + 0.5 * s.z));
        b.part(&case, "seam", seam, Finish::BlackPlastic);
        let wheels = [(-1.0f32, -1.0f32), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|(sx, sy)| {
            let at = Vec3::new(sx * (0.5 * s.x - 0.045), sy * (0.5 * s.y - 0.04), 0.0);
            let wheel = cylinder(0.024, 0.022, 24).moved(Vec3::Z * -0.011).turned(Vec3::Y, FRAC_PI_2).moved(at + Vec3::Z * 0.024);
            wheel.with(rounded_box(Vec3::new(0.03, 0.04, 0.034), 0.008, 2).moved(at + Vec3::Z * 0.043))
        });
        b.part(&case, "wheels", all(wheels), Finish::BlackPlastic);
        let top = WHEELS + s.z;
        let (y, high) = (-0.5 * s.y + 0.05, if self.handle { top + 0.40 } else { top + 0.012 });
        let bars = [-1.0f32, 1.0].map(|side| rod([side * 0.08, y, top - 0.02], [side * 0.08, y, high], 0.007, 12));
        b.part(&case, "bars", all(bars), Finish::Aluminium);
        b.part(&case, "grip", rounded_box(Vec3::new(0.20, 0.026, 0.024), 0.009, 3).moved(Vec3::new(0.0, y, high)), Finish::BlackPlastic);
    }
}
