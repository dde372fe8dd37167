//! The fall of a sheet on things, in small steps.

use super::{Sheet, Solid};
use enfilade_math::{Vec2, Vec3};

/// Duration of a step, seconds.
const STEP_S: f32 = 0.008;
/// Most steps until the sheet is at rest.
const STEPS: usize = 230;
/// Steps in which a sheet falls at least.
const FALLING: usize = 70;
/// A sheet whose points move less in a step, in the mean, is at rest, metres.
const AT_REST: f32 = 0.000_15;
/// Corrections of distances in each step.
const ROUNDS: usize = 6;
/// Gravity, m/s².
const GRAVITY: f32 = 9.81;
/// Share of the speed that a step leaves.
const AIR: f32 = 0.985;
/// Friction of cloth on things.
const FRICTION: f32 = 0.75;
/// Share of the speed that a step leaves where the sheet touches something.
const CONTACT: f32 = 0.6;

/// A distance between two points that stays.
struct Tie {
    ends: [usize; 2],
    length: f32,
    /// Share of the error that a round corrects.
    strength: f32,
}

impl Sheet {
    fn ties(&self) -> Vec<Tie> {
        let pitch = self.pitch();
        let stiff = self.textile.stiff;
        // Across, along, both diagonals, and over two cells, which resists bending.
        let ways = [(1, 0, 1.0), (0, 1, 1.0), (1, 1, 0.35), (1, -1, 0.35), (2, 0, stiff), (0, 2, stiff)];
        let mut ties = Vec::new();
        for j in 0..self.count[1] as i32 {
            for i in 0..self.count[0] as i32 {
                for (di, dj, strength) in ways {
                    let (k, l) = (i + di, j + dj);
                    if k < 0 || l < 0 || k >= self.count[0] as i32 || l >= self.count[1] as i32 {
                        continue;
                    }
                    let ends = [self.index(i as usize, j as usize), self.index(k as usize, l as usize)];
                    if ends.iter().all(|&end| self.here[end]) {
                        ties.push(Tie { ends, length: (pitch * Vec2::new(di as f32, dj as f32)).length(), strength });
                    }
                }
            }
        }
        ties
    }

    /// Lets the sheet fall until it rests on `solid`.
    pub fn fall(&mut self, solid: &Solid) {
        let ties = self.ties();
        let half = self.textile.half;
        let most = 0.6 * half;
        let mut speed = vec![Vec3::ZERO; self.points.len()];
        for step in 0..STEPS {
            let before = self.points.clone();
            // Towards the end everything slows down.
            let air = if 4 * step > 3 * STEPS { 0.9 } else { AIR };
            for (p, v) in self.points.iter_mut().zip(&mut speed) {
                *v = *v * air - Vec3::Z * GRAVITY * STEP_S;
                *p += (*v * STEP_S).clamp_length_max(most);
            }
            for _ in 0..ROUNDS {
                for tie in &ties {
                    let [a, b] = tie.ends;
                    let along = self.points[b] - self.points[a];
                    let length = along.length().max(1e-6);
                    let shift = along * (0.5 * tie.strength * (length - tie.length) / length);
                    self.points[a] += shift;
                    self.points[b] -= shift;
                }
            }
            if step % 2 == 0 {
                self.keep_apart();
            }
            for (k, v) in speed.iter_mut().enumerate() {
                let moved = (self.points[k] - before[k]).clamp_length_max(most);
                self.points[k] = before[k] + moved;
                let touches = self.push_out(k, before[k], solid, half);
                *v = (self.points[k] - before[k]) / STEP_S * if touches { CONTACT } else { 1.0 };
            }
            if step > FALLING && self.moved(&before) < AT_REST {
                return;
            }
        }
    }

    /// How far the points of the sheet have moved, in the mean.
    fn moved(&self, before: &[Vec3]) -> f32 {
        let cloth = (0..self.points.len()).filter(|&k| self.here[k]);
        let (sum, count) = cloth.fold((0.0, 0), |(sum, count), k| (sum + self.points[k].distance(before[k]), count + 1));
        sum / count.max(1) as f32
    }

    /// Moves a point out of what it is in, and holds it there by friction; true where it touches something.
    fn push_out(&mut self, k: usize, before: Vec3, solid: &Solid, half: f32) -> bool {
        let Some((distance, away)) = solid.at(self.points[k]).filter(|(distance, _)| *distance < half) else { return false };
        let push = half - distance;
        self.points[k] += away * push.min(half);
        let moved = self.points[k] - before;
        let aside = moved - away * away.dot(moved);
        let held = (FRICTION * push / aside.length().max(1e-9)).min(1.0);
        self.points[k] -= aside * held;
        true
    }

    /// Moves points of the sheet apart that are nearer to each other than it is thick.
    fn keep_apart(&mut self) {
        const TABLE: usize = 1 << 12;
        let pitch = self.pitch().min_element();
        let apart = (2.0 * self.textile.half).min(0.95 * pitch);
        let cell = |p: Vec3| (p / apart).floor().as_ivec3();
        let slot = |x: i32, y: i32, z: i32| {
            (x.wrapping_mul(73_856_093) ^ y.wrapping_mul(19_349_663) ^ z.wrapping_mul(83_492_791)) as u32 as usize % TABLE
        };
        let mut first = vec![usize::MAX; TABLE];
        let mut next = vec![usize::MAX; self.points.len()];
        for k in (0..self.points.len()).filter(|&k| self.here[k]) {
            let c = cell(self.points[k]);
            let s = slot(c.x, c.y, c.z);
            next[k] = std::mem::replace(&mut first[s], k);
        }
        let columns = self.count[0];
        let near = |a: usize, b: usize| {
            let ([i, j], [k, l]) = ([a % columns, a / columns], [b % columns, b / columns]);
            i.abs_diff(k) <= 1 && j.abs_diff(l) <= 1
        };
        for k in (0..self.points.len()).filter(|&k| self.here[k]) {
            let c = cell(self.points[k]);
            for n in 0..27 {
                let mut other = first[slot(c.x + n % 3 - 1, c.y + n / 3 % 3 - 1, c.z + n / 9 - 1)];
                while other != usize::MAX {
                    let along = self.points[other] - self.points[k];
                    let length = along.length();
                    if other > k && length < apart && length > 1e-6 && !near(k, other) {
                        let shift = along * (0.4 * (apart - length) / length);
                        self.points[k] -= shift;
                        self.points[other] += shift;
                    }
                    other = next[other];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Textile;
    use super::*;
    use crate::meet::Triangle;
    use crate::shape::{Reshape, rounded_box};
    use enfilade_math::{Bounds3, Rng};

    fn solid(boxes: &[[[f32; 3]; 2]]) -> Solid {
        let mesh = boxes.iter().map(|[size, at]| rounded_box(Vec3::from_array(*size), 0.01, 2).moved(Vec3::from_array(*at)));
        let triangles: Vec<Triangle> =
            mesh.flat_map(|mesh| (0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect::<Vec<_>>()).collect();
        Solid::new(&Bounds3 { min: Vec3::new(-1.0, -1.0, -0.1), max: Vec3::new(1.0, 1.0, 1.2) }, triangles.iter())
    }

    #[test]
    fn a_towel_over_a_rail_hangs_on_both_sides_and_keeps_its_length() {
        let rail = solid(&[[[1.2, 0.05, 0.1], [0.0, 0.0, 0.8]], [[2.0, 2.0, 0.2], [0.0, 0.0, -0.1]]]);
        let towel = Textile { size: Vec2::new(0.5, 0.9), ..Textile::towel(&mut Rng::new(1)) };
        let mut sheet = Sheet::new(towel, Vec3::new(0.0, 0.0, 0.88), 0.0, 0.0, &mut Rng::new(2));
        sheet.fall(&rail);
        let ends = |j: usize| sheet.points[sheet.index(sheet.count[0] / 2, j)];
        let (front, middle, back) = (ends(0), ends(sheet.count[1] / 2), ends(sheet.count[1] - 1));
        assert!(middle.z > 0.85 && front.z < 0.55 && back.z < 0.55, "{front} {middle} {back}");
        assert!(front.y < 0.0 && back.y > 0.0);
        let long: f32 = (1..sheet.count[1]).map(|j| ends(j).distance(ends(j - 1))).sum();
        assert!((long - 0.9).abs() < 0.06, "{long}");
        let inside = sheet.points.iter().filter(|p| rail.at(**p).is_some_and(|(d, _)| d < 0.4 * towel.half)).count();
        assert_eq!(inside, 0);
    }

    #[test]
    fn a_crumpled_shirt_lies_on_the_floor_in_folds() {
        let floor = solid(&[[[2.0, 2.0, 0.2], [0.0, 0.0, -0.1]]]);
        let shirt = Textile::shirt(&mut Rng::new(3));
        let mut sheet = Sheet::new(shirt, Vec3::new(0.0, 0.0, 0.3), 0.4, 1.0, &mut Rng::new(4));
        sheet.fall(&floor);
        let cloth = || sheet.points.iter().zip(&sheet.here).filter(|(_, here)| **here).map(|(p, _)| *p);
        let (low, high) = cloth().fold((f32::MAX, f32::MIN), |(low, high), p| (low.min(p.z), high.max(p.z)));
        assert!(low > 0.4 * shirt.half && low < 2.0 * shirt.half && high > 0.03 && high < 0.25, "{low} {high}");
    }
}
