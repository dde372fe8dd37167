//! Textiles that people leave lying: how large and thick each is, and its cut.

use enfilade_math::{Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// The outline of a piece of cloth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// A rectangle.
    Plain,
    /// A body with two sleeves.
    Shirt,
    /// Two legs below a waist.
    Trousers,
}

/// A kind of textile. Lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Textile {
    /// Width and length as it lies flat.
    pub size: Vec2,
    /// The outline of it.
    pub cut: Cut,
    /// Half the thickness: what it keeps from others and, twice, from itself.
    pub half: f32,
    /// Distance between points of the grid.
    pub pitch: f32,
    /// Resistance to bending, 0 (silk) to 1 (quilt).
    pub stiff: f32,
}

impl Textile {
    /// A shirt, pullover or jacket with its sleeves spread.
    pub fn shirt(rng: &mut Rng) -> Self {
        Self { size: Vec2::new(rng.range(1.1, 1.4), rng.range(0.62, 0.74)), cut: Cut::Shirt, half: 0.009, pitch: 0.036, stiff: 0.12 }
    }

    /// A pair of trousers.
    pub fn trousers(rng: &mut Rng) -> Self {
        Self { size: Vec2::new(rng.range(0.42, 0.5), rng.range(0.95, 1.08)), cut: Cut::Trousers, half: 0.009, pitch: 0.034, stiff: 0.2 }
    }

    /// A bath towel.
    pub fn towel(rng: &mut Rng) -> Self {
        Self { size: Vec2::new(rng.range(0.5, 0.7), rng.range(0.9, 1.3)), cut: Cut::Plain, half: 0.008, pitch: 0.036, stiff: 0.15 }
    }

    /// A blanket.
    pub fn blanket(rng: &mut Rng) -> Self {
        Self { size: Vec2::new(rng.range(1.2, 1.4), rng.range(1.5, 1.8)), cut: Cut::Plain, half: 0.009, pitch: 0.046, stiff: 0.1 }
    }

    /// A duvet of this width.
    pub fn duvet(width: f32) -> Self {
        Self { size: Vec2::new(width, 1.95), cut: Cut::Plain, half: 0.024, pitch: 0.052, stiff: 0.1 }
    }

    /// Whether a point of its rectangle, from −½ to ½, is cloth.
    fn has(&self, q: Vec2) -> bool {
        match self.cut {
            Cut::Plain => true,
            Cut::Shirt => q.x.abs() < 0.22 || (q.y > 0.14 - 0.1 * (q.x.abs() - 0.22) && q.y < 0.5 - 0.25 * (q.x.abs() - 0.22)),
            Cut::Trousers => q.y > 0.22 || q.x.abs() > 0.07,
        }
    }
}

/// A piece of cloth as a grid of points.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// The kind.
    pub textile: Textile,
    /// Number of points across and along.
    pub count: [usize; 2],
    /// True where the point is cloth.
    pub here: Vec<bool>,
    /// Positions of the points in the world.
    pub points: Vec<Vec3>,
}

impl Sheet {
    /// The sheet, its middle at `at`, turned by `yaw`: spread out where `crumpled` is 0, pushed together to a heap of folds where it is 1.
    pub fn new(textile: Textile, at: Vec3, yaw: f32, crumpled: f32, rng: &mut Rng) -> Self {
        // An even number of cells, so that every second point is a sheet too.
        let count = (0.5 * textile.size / textile.pitch).ceil().as_uvec2().to_array().map(|n| 2 * n as usize + 1);
        let turn = Vec2::from_angle(yaw);
        let squeeze = Vec2::new(1.0 - rng.range(0.2, 0.5) * crumpled, 1.0 - rng.range(0.2, 0.5) * crumpled);
        // Waves that take up the length by which the cloth is pushed together: ∫ √(s² + a²k²cos²) = 1 for a²k² = 2 (1 − s²), nearly.
        let number = TAU / (Vec2::new(rng.range(5.0, 7.5), rng.range(5.0, 7.5)) * textile.pitch);
        let height = (2.0 * (1.0 - squeeze * squeeze)).max(Vec2::ZERO).powf(0.5) / number;
        let phases: [f32; 4] = std::array::from_fn(|_| rng.range(0.0, TAU));
        let mut sheet = Self { textile, count, here: Vec::new(), points: Vec::new() };
        for j in 0..count[1] {
            for i in 0..count[0] {
                let q = Vec2::new(i as f32 / (count[0] - 1) as f32, j as f32 / (count[1] - 1) as f32) - 0.5;
                let flat = q * textile.size;
                let warp = Vec2::new((5.0 * flat.y + phases[2]).sin(), (4.0 * flat.x + phases[3]).sin());
                let wave = height * (number * flat + Vec2::new(phases[0], phases[1]) + 1.4 * warp).map(f32::sin);
                let p = turn.rotate(flat * squeeze + 0.05 * crumpled * warp);
                sheet.here.push(textile.has(q));
                sheet.points.push(at + p.extend(wave.element_sum()));
            }
        }
        sheet
    }

    /// The point where the cloth lies on `(i, j)`.
    pub(super) fn index(&self, i: usize, j: usize) -> usize {
        j * self.count[0] + i
    }

    /// Distances between points of the flat sheet, across and along.
    pub(super) fn pitch(&self) -> Vec2 {
        self.textile.size / Vec2::new((self.count[0] - 1) as f32, (self.count[1] - 1) as f32)
    }

    /// Lets part of the cloth beyond a line lie folded back over the rest: `beyond` is a unit vector across the line at `line`, on the flat
    /// sheet from −½ to ½ of its size.
    pub fn folded_back(&mut self, line: Vec2, beyond: Vec2) {
        let round = 2.2 * self.textile.half;
        let middle = self.points.iter().sum::<Vec3>() / self.points.len() as f32;
        let pitch = self.pitch();
        let [a, b] =
            [self.points[1] - self.points[0], self.points[self.count[0]] - self.points[0]].map(|v| v.truncate().normalize_or(Vec2::X));
        for j in 0..self.count[1] {
            for i in 0..self.count[0] {
                let q = pitch * Vec2::new(i as f32, j as f32) - 0.5 * self.textile.size;
                let d = (q - line * self.textile.size).dot(beyond);
                if d <= 0.0 {
                    continue;
                }
                let (sin, cos) = (d / round).min(std::f32::consts::PI).sin_cos();
                let back = (d - std::f32::consts::PI * round).max(0.0);
                let flat = q - beyond * d + beyond * (round * sin - back);
                let wave = self.points[j * self.count[0] + i].z - middle.z;
                let index = self.index(i, j);
                self.points[index] = middle + (a * flat.x + b * flat.y).extend(round * (1.0 - cos) + wave);
            }
        }
    }
}
