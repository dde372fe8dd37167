//! The fall of a sheet on things, in small steps: first with every second point, if it has enough of them, then with all.

use super::apart::Near;
use super::mesh::Fine;
use super::{Cut, Sheet, Solid};
use enfilade_math::{Vec2, Vec3};

/// Duration of a step, seconds.
const STEP_S: f32 = 0.008;
/// Most steps until a sheet is at rest: of one that falls, and of one that has fallen with fewer points.
const STEPS: [usize; 2] = [200, 50];
/// Steps that it takes at least, likewise.
const LEAST: [usize; 2] = [40, 10];
/// A sheet whose points move less in a step, in the mean, is at rest, metres.
const AT_REST: f32 = 0.000_15;
/// Corrections of distances in each step: of a sheet in the air, and of one that touches something.
const ROUNDS: [usize; 2] = [2, 6];
/// Cells along either edge of the smallest sheet that falls with fewer points first.
const MANY: usize = 16;
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
    ends: [u32; 2],
    /// The square of the distance, m².
    squared: f32,
    /// Share of the error that a round corrects.
    strength: f32,
}

impl Sheet {
    fn ties(&self) -> Vec<Tie> {
        let pitch = self.pitch();
        let stiff = self.textile.stiff;
        // Across, along, both diagonals, and over two cells, which resists bending.
        let ways = [(1, 0, 1.0), (0, 1, 1.0), (1, 1, 0.35), (1, -1, 0.35), (2, 0, stiff), (0, 2, stiff)];
        let mut ties = Vec::with_capacity(ways.len() * self.points.len());
        for j in 0..self.count[1] as i32 {
            for i in 0..self.count[0] as i32 {
                for (di, dj, strength) in ways {
                    let (k, l) = (i + di, j + dj);
                    if k < 0 || l < 0 || k >= self.count[0] as i32 || l >= self.count[1] as i32 {
                        continue;
                    }
                    let ends = [self.index(i as usize, j as usize), self.index(k as usize, l as usize)];
                    if ends.iter().all(|&end| self.here[end]) {
                        let squared = (pitch * Vec2::new(di as f32, dj as f32)).length_squared();
                        ties.push(Tie { ends: ends.map(|end| end as u32), squared, strength });
                    }
                }
            }
        }
        ties
    }

    /// Lets the sheet fall until it rests on `solid`.
    pub fn fall(&mut self, solid: &mut Solid) {
        match self.coarser() {
            Some(mut coarse) => {
                coarse.drop_on(solid, STEPS[0], LEAST[0]);
                self.points = Fine::of(&coarse).points.into_iter().zip(&self.points).map(|(found, own)| found.unwrap_or(*own)).collect();
                self.drop_on(solid, STEPS[1], LEAST[1]);
            }
            None => self.drop_on(solid, STEPS[0], LEAST[0]),
        }
    }

    /// The sheet with every second point across and along.
    fn coarser(&self) -> Option<Self> {
        let halves = |n: usize| n % 2 == 1 && n > MANY;
        // What is thick for its grid keeps from itself with all of its points only, and narrow pieces need all of them.
        let thick = 4.0 * self.textile.half > self.textile.pitch;
        if thick || self.textile.cut != Cut::Plain || !self.count.into_iter().all(halves) {
            return None;
        }
        let count = self.count.map(|n| n.div_ceil(2));
        let points: Vec<Vec3> = (0..count[0] * count[1]).map(|k| self.points[self.index(2 * (k % count[0]), 2 * (k / count[0]))]).collect();
        Some(Self { textile: self.textile, count, here: vec![true; points.len()], points })
    }

    /// Falls from rest, at most `most` steps and at least `least`.
    fn drop_on(&mut self, solid: &mut Solid, most: usize, least: usize) {
        let ties = self.ties();
        let half = self.textile.half;
        let far = 0.6 * half;
        let mut speed = vec![Vec3::ZERO; self.points.len()];
        let mut before = self.points.clone();
        let mut near = Near::default();
        let mut touches = false;
        for step in 0..most {
            before.copy_from_slice(&self.points);
            // Towards the end everything slows down.
            let air = if 4 * step > 3 * most { 0.9 } else { AIR };
            for (p, v) in self.points.iter_mut().zip(&mut speed) {
                *v = *v * air - Vec3::Z * GRAVITY * STEP_S;
                *p += (*v * STEP_S).clamp_length_max(far);
            }
            for _ in 0..ROUNDS[usize::from(touches)] {
                self.hold(&ties);
            }
            if touches && step % 2 == 0 {
                self.keep_apart(&mut near);
            }
            let mut way = 0.0;
            let mut count = 0;
            for (k, v) in speed.iter_mut().enumerate() {
                if !self.here[k] {
                    continue;
                }
                let moved = (self.points[k] - before[k]).clamp_length_max(far);
                self.points[k] = before[k] + moved;
                let touching = self.push_out(k, before[k], solid, half);
                touches |= touching;
                let moved = self.points[k] - before[k];
                *v = moved / STEP_S * if touching { CONTACT } else { 1.0 };
                (way, count) = (way + moved.length(), count + 1);
            }
            if step >= least && way < AT_REST * count as f32 {
                return;
            }
        }
    }

    /// Corrects all distances once, without square roots (Jakobsen 2001, "Advanced character physics").
    fn hold(&mut self, ties: &[Tie]) {
        for tie in ties {
            let [a, b] = tie.ends.map(|end| end as usize);
            let along = self.points[b] - self.points[a];
            let shift = along * (tie.strength * (0.5 - tie.squared / (along.length_squared() + tie.squared)));
            self.points[a] += shift;
            self.points[b] -= shift;
        }
    }

    /// Moves a point out of what it is in, and holds it there by friction; true where it touches something.
    fn push_out(&mut self, k: usize, before: Vec3, solid: &mut Solid, half: f32) -> bool {
        let Some((distance, away)) = solid.at(self.points[k]).filter(|(distance, _)| *distance < half) else { return false };
        let push = half - distance;
        self.points[k] += away * push.min(half);
        let moved = self.points[k] - before;
        let aside = moved - away * away.dot(moved);
        let held = (FRICTION * push / aside.length().max(1e-9)).min(1.0);
        self.points[k] -= aside * held;
        true
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
        Solid::new(&Bounds3 { min: Vec3::new(-1.0, -1.0, -0.1), max: Vec3::new(1.0, 1.0, 1.2) }, triangles)
    }

    #[test]
    fn a_towel_over_a_rail_hangs_on_both_sides_and_keeps_its_length() {
        let mut rail = solid(&[[[1.2, 0.05, 0.1], [0.0, 0.0, 0.8]], [[2.0, 2.0, 0.2], [0.0, 0.0, -0.1]]]);
        let towel = Textile { size: Vec2::new(0.5, 0.9), ..Textile::towel(&mut Rng::new(1)) };
        let mut sheet = Sheet::new(towel, Vec3::new(0.0, 0.0, 0.88), 0.0, 0.0, &mut Rng::new(2));
        sheet.fall(&mut rail);
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
        let mut floor = solid(&[[[2.0, 2.0, 0.2], [0.0, 0.0, -0.1]]]);
        let shirt = Textile::shirt(&mut Rng::new(3));
        let mut sheet = Sheet::new(shirt, Vec3::new(0.0, 0.0, 0.3), 0.4, 1.0, &mut Rng::new(4));
        sheet.fall(&mut floor);
        let cloth = || sheet.points.iter().zip(&sheet.here).filter(|(_, here)| **here).map(|(p, _)| *p);
        let (low, high) = cloth().fold((f32::MAX, f32::MIN), |(low, high), p| (low.min(p.z), high.max(p.z)));
        assert!(low > 0.4 * shirt.half && low < 2.0 * shirt.half && high > 0.03 && high < 0.25, "{low} {high}");
    }
}
