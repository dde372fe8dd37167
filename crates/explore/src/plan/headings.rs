//! The choice of headings along a path: always toward free space, as near as possible to the wanted ones, and turning no more than needed.

use super::planner::Planner;
use super::rules::posed;
use enfilade_math::DVec3;
use enfilade_parallel::map_up_to;
use std::f64::consts::{PI, TAU};

/// Headings compared at every control point.
pub(super) const HEADINGS: usize = 72;

/// Weight of the turn from one control point to the next, relative to the deviation from the wanted heading, both in headings squared.
const TURN_COST: f64 = 6.0;

/// The headings that have free space before them, at every control point of a path.
pub(super) struct Headings {
    /// Heading, pitch and roll asked for, radians.
    wanted: Vec<DVec3>,
    allowed: Vec<[bool; HEADINGS]>,
}

impl Headings {
    /// For control points at `positions`. A heading is allowed where a target `look_distance_m` away is free and visible and a second
    /// camera has room, and so it is for the headings beside it.
    pub fn new(planner: &Planner, positions: &[DVec3], wanted: Vec<DVec3>, look_distance_m: f64) -> Self {
        let level = planner.rules.pitch_limits_rad();
        let rows = map_up_to(positions.len(), |j| {
            let (position, mut wanted) = (positions[j], wanted[j]);
            let sees = |wanted: DVec3| -> [bool; HEADINGS] {
                std::array::from_fn(|y| {
                    let target = position + look_distance_m * direction(angle(y), wanted.y);
                    let pose = posed(0, position, target, wanted.z);
                    pose.is_some_and(|pose| {
                        planner.rules.is_free(target) && planner.rules.sees(position, target) && planner.rules.has_room_beside(&pose)
                    })
                })
            };
            let mut open = sees(wanted);
            if !open.contains(&true) {
                // No free view at the pitch asked for: use the allowed pitch nearest to level.
                wanted.y = 0f64.clamp(level[0], level[1]);
                open = sees(wanted);
            }
            let inner: [bool; HEADINGS] = std::array::from_fn(|y| (0..3).all(|k| open[(y + HEADINGS - 1 + k) % HEADINGS]));
            (wanted, if inner.contains(&true) { inner } else { open })
        });
        let (wanted, allowed) = rows.into_iter().unzip();
        Self { wanted, allowed }
    }

    /// Heading, pitch and roll at every control point, headings counted on beyond a full turn; `None` when there is no sequence of allowed
    /// headings. From each control point to the next it turns by at most the number of headings in `strides`, or, if that is impossible, by
    /// twice or four times as many, and so on.
    pub fn smoothest(&self, strides: &[usize]) -> Option<Vec<DVec3>> {
        let factors = [1, 2, 4, 8, 16, HEADINGS];
        let chosen = factors.into_iter().find_map(|factor| self.sequence(|j| (factor * strides[j]).min(HEADINGS / 2)))?;
        let mut angles = Vec::with_capacity(chosen.len());
        let mut turned = 0i64;
        for (j, &y) in chosen.iter().enumerate() {
            turned += if j == 0 { y as i64 } else { steps_between(chosen[j - 1], y) };
            let heading = TAU * turned as f64 / HEADINGS as f64;
            // Between two headings, come as near to the one asked for as half a step allows.
            let half = 0.5 * TAU / HEADINGS as f64;
            let off = ((self.wanted[j].x - heading + PI).rem_euclid(TAU) - PI).clamp(-half, half);
            angles.push(DVec3::new(heading + off, self.wanted[j].y, self.wanted[j].z));
        }
        Some(angles)
    }

    /// The cheapest sequence of allowed headings (Viterbi 1967) that turns by `stride(j)` of them at most after control point j.
    fn sequence(&self, stride: impl Fn(usize) -> usize) -> Option<Vec<usize>> {
        let stray = |j: usize, y: usize| {
            let off = (self.wanted[j].x - angle(y) + PI).rem_euclid(TAU) - PI;
            if self.allowed[j][y] { (off * HEADINGS as f64 / TAU).powi(2) } else { f64::INFINITY }
        };

        // Forward: the lowest cost of reaching each heading at each control point, and from which heading.
        let mut cost: Vec<f64> = (0..HEADINGS).map(|y| stray(0, y)).collect();
        let mut came_from: Vec<[u8; HEADINGS]> = Vec::with_capacity(self.allowed.len());
        for j in 1..self.allowed.len() {
            let stride = stride(j - 1) as i64;
            let mut row = [0u8; HEADINGS];
            let next = (0..HEADINGS).map(|y| {
                let before = |turn: i64| (y as i64 - turn).rem_euclid(HEADINGS as i64) as usize;
                let turns = (-stride..=stride).map(|turn| (cost[before(turn)] + TURN_COST * (turn * turn) as f64, before(turn)));
                let (lowest, from) = turns.fold((f64::INFINITY, y), |best, found| if found.0 < best.0 { found } else { best });
                row[y] = from as u8;
                lowest + stray(j, y)
            });
            cost = next.collect();
            came_from.push(row);
        }

        // Backward: from the cheapest heading at the end.
        let (mut y, lowest) = (0..HEADINGS).map(|y| (y, cost[y])).min_by(|a, b| a.1.total_cmp(&b.1))?;
        if lowest.is_infinite() {
            return None;
        }
        let mut chosen = vec![y];
        for row in came_from.iter().rev() {
            y = row[y] as usize;
            chosen.push(y);
        }
        chosen.reverse();
        Some(chosen)
    }

    /// Allows a heading, and those beside it, no more around the parameter `u` of the path.
    pub fn forbid(&mut self, u: f64, heading_rad: f64) {
        let y = (heading_rad / TAU * HEADINGS as f64).round().rem_euclid(HEADINGS as f64) as usize % HEADINGS;
        for j in [u.floor() as usize, u.ceil() as usize] {
            for k in 0..3 {
                self.allowed[j.min(self.wanted.len() - 1)][(y + HEADINGS - 1 + k) % HEADINGS] = false;
            }
        }
    }

    /// The control point with the fewest headings.
    pub fn narrowest(&self) -> usize {
        let open = |row: &[bool; HEADINGS]| row.iter().filter(|allowed| **allowed).count();
        (0..self.allowed.len()).min_by_key(|j| open(&self.allowed[*j])).unwrap_or(0)
    }
}

/// The unit direction of a heading and a pitch.
pub(super) fn direction(heading_rad: f64, pitch_rad: f64) -> DVec3 {
    let ((sin, cos), (up, along)) = (heading_rad.sin_cos(), pitch_rad.sin_cos());
    DVec3::new(along * cos, along * sin, up)
}

fn angle(y: usize) -> f64 {
    TAU * y as f64 / HEADINGS as f64
}

/// The short way from one heading to another.
fn steps_between(from: usize, to: usize) -> i64 {
    let half = HEADINGS as i64 / 2;
    (to as i64 - from as i64 + half).rem_euclid(HEADINGS as i64) - half
}
