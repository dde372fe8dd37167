//! Positions of lamps on a ceiling: spread evenly over it, and away from walls.

use super::{Ceiling, Piece};
use enfilade_geometry::Bvh;
use enfilade_math::{Ray, Vec3};
use std::collections::{HashMap, VecDeque};

/// A lamp lights about this much of a ceiling, square metres, ...
const AREA_M2: f64 = 10.0;
/// ... and no ceiling has more lamps than this.
const MAX_LAMPS: usize = 64;
/// Side of a lamp, metres; smaller where the ceiling is narrow.
const SIDE_M: std::ops::RangeInclusive<f32> = 0.15..=0.6;
/// Share of the distance to the nearest wall that half of a lamp's side may take.
const REACH: f32 = 0.6;
/// Rounds in which lamps move to the middle of what they light.
const ROUNDS: usize = 20;
/// The ceiling above a lamp is looked for from this far below it, metres.
const BELOW_M: f32 = 0.3;

/// A square lamp right below a ceiling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LampPlace {
    /// Middle of its upper face, metres.
    pub top: Vec3,
    /// Side of the square, metres; the sides are along x and y.
    pub side_m: f32,
    /// The part of the ceiling that it has to itself, square metres.
    pub area_m2: f64,
}

impl Ceiling {
    /// Places of lamps, about one for every 10 m²: by Lloyd's algorithm, each in the middle of the part of the ceiling that is nearest
    /// to it.
    pub fn lamps(&self, bvh: &Bvh) -> Vec<LampPlace> {
        let count = ((self.area_m2() / AREA_M2).round() as usize).clamp(1, MAX_LAMPS);
        let to_wall = self.distances_to_walls();
        let mut middles = self.spread(count);
        for _ in 0..ROUNDS {
            middles = self.shares(&middles).iter().map(|share| mean(share.iter().map(|&i| &self.pieces[i]))).collect();
        }
        let shares = self.shares(&middles);
        let places = middles.iter().zip(&shares).filter(|(_, share)| !share.is_empty());
        places.map(|(middle, share)| self.lamp(bvh, *middle, share, &to_wall)).collect()
    }

    /// The lamp of a share of the pieces: at the one nearest to the middle that has room for a whole lamp, or else where there is most.
    fn lamp(&self, bvh: &Bvh, middle: Vec3, share: &[usize], to_wall: &[f32]) -> LampPlace {
        let roomy = SIDE_M.end() / 2.0 / REACH;
        let room = |i: usize| to_wall[i].min(roomy);
        let apart = |i: usize| self.pieces[i].at.truncate().distance_squared(middle.truncate());
        let best = share.iter().copied().min_by(|&a, &b| room(b).total_cmp(&room(a)).then(apart(a).total_cmp(&apart(b))));
        let best = best.unwrap_or_default();
        let side_m = (2.0 * REACH * to_wall[best]).clamp(*SIDE_M.start(), *SIDE_M.end());
        let at = self.pieces[best].at;
        let area_m2 = share.len() as f64 * f64::from(self.spacing_m).powi(2);
        LampPlace { top: Vec3::new(at.x, at.y, lowest(bvh, at, side_m)), side_m, area_m2 }
    }

    /// Pieces that are far from each other, the first at the beginning.
    fn spread(&self, count: usize) -> Vec<Vec3> {
        let mut chosen = vec![self.pieces[0].at];
        let mut apart: Vec<f32> = vec![f32::INFINITY; self.pieces.len()];
        while chosen.len() < count {
            let last = chosen[chosen.len() - 1];
            apart.iter_mut().zip(&self.pieces).for_each(|(d, piece)| *d = d.min(piece.at.distance_squared(last)));
            let farthest = (0..apart.len()).fold(0, |best, i| if apart[i] > apart[best] { i } else { best });
            chosen.push(self.pieces[farthest].at);
        }
        chosen
    }

    /// For every middle, the pieces that are nearer to it than to the others.
    fn shares(&self, middles: &[Vec3]) -> Vec<Vec<usize>> {
        let mut shares = vec![Vec::new(); middles.len()];
        for (i, piece) in self.pieces.iter().enumerate() {
            let apart = |k: usize| middles[k].distance_squared(piece.at);
            let nearest = (1..middles.len()).fold(0, |best, k| if apart(k) < apart(best) { k } else { best });
            shares[nearest].push(i);
        }
        shares
    }

    /// For every piece, how far the nearest place is that is none, along the grid, metres.
    fn distances_to_walls(&self) -> Vec<f32> {
        let numbers: HashMap<[u32; 2], usize> = self.pieces.iter().enumerate().map(|(i, piece)| (piece.column, i)).collect();
        let beside = |i: usize| {
            let [x, y] = self.pieces[i].column;
            [[x.wrapping_sub(1), y], [x + 1, y], [x, y.wrapping_sub(1)], [x, y + 1]].map(|column| numbers.get(&column).copied())
        };
        let mut steps = vec![u32::MAX; self.pieces.len()];
        let mut next: VecDeque<usize> = (0..steps.len()).filter(|&i| beside(i).contains(&None)).collect();
        next.iter().for_each(|&i| steps[i] = 0);
        while let Some(i) = next.pop_front() {
            for other in beside(i).into_iter().flatten() {
                if steps[other] == u32::MAX {
                    steps[other] = steps[i] + 1;
                    next.push_back(other);
                }
            }
        }
        steps.into_iter().map(|steps| self.spacing_m * (steps as f32 + 0.5)).collect()
    }
}

fn mean<'a>(pieces: impl ExactSizeIterator<Item = &'a Piece>) -> Vec3 {
    let count = pieces.len().max(1) as f32;
    pieces.map(|piece| piece.at).sum::<Vec3>() / count
}

/// Height of the lowest ceiling above a square around a piece of it, metres.
fn lowest(bvh: &Bvh, at: Vec3, side_m: f32) -> f32 {
    let corners = [(0.0, 0.0), (-0.5, -0.5), (-0.5, 0.5), (0.5, -0.5), (0.5, 0.5)];
    let heights = corners.map(|(x, y)| {
        let below = at + Vec3::new(x * side_m, y * side_m, -BELOW_M);
        let ray = Ray { t_max: 2.0 * BELOW_M, ..Ray::new(below, Vec3::Z) };
        bvh.closest(&ray).map_or(at.z, |hit| below.z + hit.t)
    });
    heights.into_iter().fold(at.z, f32::min)
}

#[cfg(test)]
mod tests {
    use super::super::ceilings;
    use super::*;
    use crate::testroom::{Room, cuboid};
    use enfilade_math::DVec3;

    fn lamps_of(corners: Vec<[Vec3; 3]>) -> Vec<LampPlace> {
        let room = Room::from_corners(corners);
        ceilings(&room.world, &room.bvh).iter().flat_map(|ceiling| ceiling.lamps(&room.bvh)).collect()
    }

    #[test]
    fn a_small_room_has_one_lamp_in_the_middle_of_its_ceiling() {
        let lamps = lamps_of(cuboid(DVec3::ZERO, DVec3::new(4.0, 2.8, 2.5), true));
        assert_eq!(lamps.len(), 1, "{lamps:?}");
        assert!(lamps[0].top.distance(Vec3::new(2.0, 1.4, 2.5)) < 0.15, "{lamps:?}");
        assert_eq!(lamps[0].side_m, 0.6);
    }

    #[test]
    fn a_long_room_has_its_lamps_in_a_row() {
        let mut lamps = lamps_of(cuboid(DVec3::ZERO, DVec3::new(9.0, 3.0, 2.5), true));
        lamps.sort_by(|a, b| a.top.x.total_cmp(&b.top.x));
        let places: Vec<Vec3> = lamps.iter().map(|lamp| lamp.top).collect();
        assert_eq!(places.len(), 3, "{places:?}");
        for (place, x) in places.iter().zip([1.5, 4.5, 7.5]) {
            assert!(place.distance(Vec3::new(x, 1.5, 2.5)) < 0.4, "{places:?}");
        }
    }

    #[test]
    fn lamps_hang_below_sloping_ceilings_and_fit_narrow_ones() {
        // A corridor half a metre wide.
        let lamps = lamps_of(cuboid(DVec3::ZERO, DVec3::new(6.0, 0.5, 2.5), true));
        assert!(lamps.iter().all(|lamp| lamp.side_m < 0.4 && (lamp.top.y - 0.25).abs() < 0.1), "{lamps:?}");
        // A roof that falls by a metre over four.
        let mut corners = cuboid(DVec3::ZERO, DVec3::new(4.0, 3.0, 3.0), true);
        corners.iter_mut().flatten().filter(|p| p.z == 3.0 && p.x == 4.0).for_each(|p| p.z = 2.0);
        let lamps = lamps_of(corners);
        assert_eq!(lamps.len(), 1);
        let (top, half) = (lamps[0].top, lamps[0].side_m / 2.0);
        assert!((top.z - (3.0 - (top.x + half) / 4.0)).abs() < 1e-3, "{lamps:?}");
    }
}
