//! The two sides of a sheet as meshes.

use super::Sheet;
use crate::pieces::soft::Wrinkles;
use crate::shape::Reshape;
use enfilade_geometry::Mesh;
use enfilade_math::{Rng, Vec2, Vec3};

/// Cells of the mesh for each of the sheet, across and along.
const FINE: usize = 2;
/// Thickness at the border as a share of that in the middle.
const HEM: f32 = 0.15;

/// A sheet with more points.
pub(super) struct Fine {
    count: [usize; 2],
    /// `None` where no cloth is.
    pub(super) points: Vec<Option<Vec3>>,
}

impl Fine {
    fn get(&self, i: isize, j: isize) -> Option<Vec3> {
        let inside = i >= 0 && j >= 0 && i < self.count[0] as isize && j < self.count[1] as isize;
        if inside { self.points[j as usize * self.count[0] + i as usize] } else { None }
    }

    /// Points between those of the sheet, on curves through them (Catmull & Rom 1974), where all around is cloth.
    pub(super) fn of(sheet: &Sheet) -> Self {
        let count = sheet.count.map(|n| (n - 1) * FINE + 1);
        let at = |i: isize, j: isize| {
            let (i, j) = (i.clamp(0, sheet.count[0] as isize - 1) as usize, j.clamp(0, sheet.count[1] as isize - 1) as usize);
            let k = sheet.index(i, j);
            (sheet.points[k], sheet.here[k])
        };
        let mix = |p: [(Vec3, bool); 4], t: f32| {
            let [a, b, c, d] = p;
            let (before, after) = (if a.1 { a.0 } else { 2.0 * b.0 - c.0 }, if d.1 { d.0 } else { 2.0 * c.0 - b.0 });
            let curve = 2.0 * b.0
                + (c.0 - before) * t
                + (2.0 * before - 5.0 * b.0 + 4.0 * c.0 - after) * t * t
                + (3.0 * b.0 - before - 3.0 * c.0 + after) * t * t * t;
            (if t == 0.0 { b.0 } else { 0.5 * curve }, b.1 && (t == 0.0 || c.1))
        };
        let mut points = Vec::with_capacity(count[0] * count[1]);
        for j in 0..count[1] {
            for i in 0..count[0] {
                let (k, l) = ((i / FINE) as isize, (j / FINE) as isize);
                let (s, t) = ((i % FINE) as f32 / FINE as f32, (j % FINE) as f32 / FINE as f32);
                let row = |dl: isize| mix([-1, 0, 1, 2].map(|dk| at(k + dk, l + dl)), s);
                let (p, here) = mix([row(-1), row(0), row(1), row(2)], t);
                points.push(here.then_some(p));
            }
        }
        Self { count, points }
    }

    /// Direction to the upper side.
    fn normal(&self, i: isize, j: isize) -> Vec3 {
        let here = self.get(i, j);
        let side = |di: isize, dj: isize| {
            let (low, high) = (self.get(i - di, j - dj).or(here), self.get(i + di, j + dj).or(here));
            high.zip(low).map_or(Vec3::ZERO, |(high, low)| high - low)
        };
        side(1, 0).cross(side(0, 1)).normalize_or(Vec3::Z)
    }

    /// True at the border of the cloth.
    fn is_border(&self, i: isize, j: isize) -> bool {
        (-1..=1).any(|di| (-1..=1).any(|dj| self.get(i + di, j + dj).is_none()))
    }
}

impl Sheet {
    /// The sides of a sheet with padding in it, as [`Sheet::sides`] has them without: lumps of feathers, and creases, on
    /// the upper side.
    pub fn quilted(&self, origin: Vec3, rng: &mut Rng) -> [Mesh; 2] {
        let [lumps, creases] = [(0.36, 0.012), (0.13, 0.011)].map(|(length, height)| Wrinkles::new(length, height, rng));
        // Where it turns sharply, the lower side must not come through the upper one.
        let thin = 0.55 * self.textile.half;
        self.padded(origin, [&|q| lumps.at(q) + creases.at(q), &|_| thin])
    }

    /// The upper and the lower side, which meet at the border, around `origin`. Texture coordinates are metres on the cloth.
    pub fn sides(&self, origin: Vec3) -> [Mesh; 2] {
        self.padded(origin, [&|_| 0.0, &|_| 0.0])
    }

    /// The sides with `padding` at points of the flat sheet, metres: how much the upper one is higher, and the lower one too.
    fn padded(&self, origin: Vec3, padding: [&dyn Fn(Vec2) -> f32; 2]) -> [Mesh; 2] {
        let fine = Fine::of(self);
        let pitch = self.pitch() / FINE as f32;
        let half = 0.8 * self.textile.half;
        [1.0f32, -1.0].map(|side| {
            let mut mesh = Mesh::default();
            for (k, point) in fine.points.iter().enumerate() {
                let (i, j) = ((k % fine.count[0]) as isize, (k / fine.count[0]) as isize);
                let flat = pitch * Vec2::new(i as f32, j as f32);
                let p = point.map_or(Vec3::ZERO, |p| {
                    let thick = match fine.is_border(i, j) {
                        true => HEM * half,
                        false if side > 0.0 => half + padding[0](flat),
                        false => half - padding[1](flat),
                    };
                    p + fine.normal(i, j) * side * thick - origin
                });
                mesh.positions.push(p);
                mesh.uvs.push(flat);
            }
            let index = |i: usize, j: usize| j * fine.count[0] + i;
            for j in 0..fine.count[1] - 1 {
                for i in 0..fine.count[0] - 1 {
                    let quad = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
                    if quad.iter().all(|&k| fine.points[k].is_some()) {
                        let [a, b, c, d] = quad.map(|k| k as u32);
                        mesh.triangles.extend(if side > 0.0 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
                    }
                }
            }
            mesh.smoothed(100.0)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::Textile;
    use super::*;

    #[test]
    fn a_flat_sheet_is_as_thick_as_its_textile_and_closed_but_for_the_hem() {
        for textile in [Textile::towel(&mut Rng::new(1)), Textile::shirt(&mut Rng::new(1)), Textile::trousers(&mut Rng::new(1))] {
            let mut sheet = Sheet::new(textile, Vec3::ZERO, 0.0, 0.0, &mut Rng::new(2));
            sheet.points.iter_mut().for_each(|p| p.z = 0.0);
            let [upper, lower] = sheet.sides(Vec3::ZERO);
            assert_eq!((upper.validate(), lower.validate()), (Ok(()), Ok(())));
            assert!((upper.bounds().max.z - 0.8 * textile.half).abs() < 1e-4 && (lower.bounds().min.z + 0.8 * textile.half).abs() < 1e-4);
            assert!(upper.normals.iter().all(|n| n.z > 0.3) && lower.normals.iter().all(|n| n.z < -0.3));
        }
    }
}
