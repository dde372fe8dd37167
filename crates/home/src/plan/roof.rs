//! Homes under a roof: the ceilings along one outer side, or along two opposite ones, slope down to a knee wall.
//!
//! Roofs are drawn until one fits: doors and passages are where they were, with room to stand before them, and every room that had a window
//! has one. Windows that would reach into the slope move along their wall to where it is high enough, become narrower or lower, or are left
//! out where the room has others.

use super::FloorPlan;
use super::slicing::Cell;
use crate::room::kind::norm;
use enfilade_furniture::RoomKind;
use enfilade_math::{DVec2, Rng};
use enfilade_scene::{CeilingSlope, DrawnPlan, OpeningKind, Rooms, Slope, WallFace};

/// Probability that a roof is sought.
const OFTEN: f32 = 0.6;
/// Roofs that are tried.
const TRIES: u64 = 12;
/// Heights of knee walls, metres.
const KNEE: [f32; 2] = [1.0, 1.6];
/// Pitches, degrees.
const PITCH: [f32; 2] = [25.0, 45.0];
/// Height under which people stand, metres, and the share of the floor of every room that has it.
const STANDING: (f32, f32) = (1.9, 0.6);
/// Wall above windows, metres.
const ABOVE: f64 = 0.1;
/// From a window to the end of its wall, and to other openings in it, metres.
const MARGIN: f64 = 0.3;
/// Shares of their widths that windows may have under a slope, the best first, and the least width, metres.
const NARROWER: ([f64; 4], f64) = ([1.0, 0.8, 0.65, 0.5], 0.6);
/// Lowest sill, and least height, of a window that became lower, metres.
const LOWER: [f64; 2] = [0.45, 0.55];
/// Step between places along a wall, metres.
const STEP: f64 = 0.05;

impl FloorPlan {
    /// The plan under a roof that begins at sides of `whole`, where the draw wants one and one fits; else the same plan.
    #[must_use]
    pub(super) fn under_roof(self, whole: &Cell, rng: &Rng) -> Self {
        if rng.fork(0).next_f32() >= OFTEN {
            return self;
        }
        let layout = self.to_rooms();
        let found = (1..=TRIES).find_map(|attempt| {
            let slopes = slopes(whole, &mut rng.fork(attempt));
            self.roofed(&layout, &slopes, rng)
        });
        found.unwrap_or(self)
    }

    fn roofed(&self, layout: &Rooms, slopes: &[Slope], rng: &Rng) -> Option<Self> {
        let mut drawn = DrawnPlan::from(layout);
        let over = |room: usize| slopes.iter().map(move |&slope| CeilingSlope { room, slope });
        drawn.slopes = (0..drawn.rooms.len()).flat_map(over).collect();
        let mut lost = vec![0usize; drawn.rooms.len()];
        let mut kept = vec![0usize; drawn.rooms.len()];
        let mut gone = Vec::new();
        for (i, opening) in layout.openings.iter().enumerate().filter(|(_, opening)| opening.kind == OpeningKind::Window) {
            let room = layout.walls[opening.walls[0]].room;
            match refitted(layout, slopes, i) {
                Some((along, width, z)) => {
                    let face = &layout.walls[opening.walls[0]];
                    let at = face.point(along, 0.0).truncate() - DVec2::from(face.inward) * (0.5 * face.thickness_m);
                    let window = &mut drawn.openings[i];
                    (window.at, window.width_m, window.z_m) = (at, Some(width), Some(z));
                    kept[room] += 1;
                }
                None => {
                    lost[room] += 1;
                    gone.push(i);
                }
            }
        }
        let is_dark = |room: usize| kept[room] == 0 && lost[room] > 0 && norm(self.rooms[room].kind).window;
        if (0..drawn.rooms.len()).any(is_dark) {
            return None;
        }
        gone.into_iter().rev().for_each(|i| _ = drawn.openings.remove(i));
        let (plan, notes) = Self::drawn(&drawn, rng).ok()?;
        let stands = plan.rooms.iter().all(|room| room.share_above(STANDING.0) >= STANDING.1);
        (notes.is_empty() && stands && plan.rooms.iter().any(|room| !room.slopes.is_empty())).then_some(plan)
    }
}

/// The planes of a roof, from one side of a home or from two opposite ones.
fn slopes(whole: &Cell, rng: &mut Rng) -> Vec<Slope> {
    let (first, both) = (rng.below(4), rng.below(2) == 0);
    let (low_z_m, pitch_deg) = (f64::from(rng.range(KNEE[0], KNEE[1])), f64::from(rng.range(PITCH[0], PITCH[1])));
    let [low, high] = [whole.min, whole.max].map(|p| p.as_dvec2());
    let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)].map(|p| p.to_array());
    let side = |k: usize| Slope { from: corners[k % 4], to: corners[(k + 1) % 4], low_z_m, pitch_deg };
    std::iter::once(side(first)).chain(both.then(|| side(first + 2))).collect()
}

/// Where a window is under a roof: its middle along the face, its width, and its heights.
fn refitted(layout: &Rooms, slopes: &[Slope], number: usize) -> Option<(f64, f64, [f64; 2])> {
    let opening = &layout.openings[number];
    let face = &layout.walls[opening.walls[0]];
    let (middle, [width, height]) = (face.along_m(opening.center()), opening.size_m());
    let (sill, head) = (opening.center().z - 0.5 * height, opening.center().z + 0.5 * height);
    let others: Vec<[f64; 2]> = layout
        .openings
        .iter()
        .enumerate()
        .filter(|(other, opening)| *other != number && opening.walls[0] == layout.openings[number].walls[0])
        .map(|(_, other)| (face.along_m(other.center()), 0.5 * other.size_m()[0]))
        .map(|(x, half)| [x - half - MARGIN, x + half + MARGIN])
        .collect();
    for share in NARROWER.0 {
        let narrow = (share * width).max(NARROWER.1.min(width));
        let [low, high] = [MARGIN + 0.5 * narrow, face.length_m() - MARGIN - 0.5 * narrow];
        let steps = ((high - low) / STEP).floor().max(0.0) as usize;
        let mut places: Vec<f64> = (0..=steps).map(|k| low + STEP * k as f64).filter(|_| high >= low).collect();
        places.push(middle);
        let is_free = |x: &f64| {
            let span = [x - 0.5 * narrow, x + 0.5 * narrow];
            *x == middle || others.iter().all(|taken| taken[1] < span[0] || span[1] < taken[0])
        };
        let fits = |x: &f64| is_free(x) && lowest(face, slopes, *x, narrow) >= head + ABOVE;
        let nearest = places.into_iter().filter(fits).min_by(|a, b| (a - middle).abs().total_cmp(&(b - middle).abs()));
        if let Some(x) = nearest {
            return Some((x, narrow, [sill, head]));
        }
    }
    let head = lowest(face, slopes, middle, width) - ABOVE;
    let [lowest_sill, least] = LOWER;
    let low = (head - least - 0.15).min(sill).max(lowest_sill);
    let is_kitchen = layout.outlines[face.room].kind == RoomKind::Kitchen.name();
    let low = if is_kitchen { sill } else { low };
    (head - low >= least).then_some((middle, width, [low, head]))
}

/// The least height of the roof over a piece of wall, through all of its thickness.
fn lowest(face: &WallFace, slopes: &[Slope], middle: f64, width: f64) -> f64 {
    let inward = DVec2::from(face.inward);
    let corners = [-0.5, 0.5].into_iter().flat_map(|end| {
        let inner = face.point(middle + end * width, 0.0).truncate();
        [inner, inner - inward * face.thickness_m]
    });
    corners.flat_map(|p| slopes.iter().map(move |slope| slope.z_m(p))).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::room::Room;
    use crate::room::kind::usual_programme;

    #[test]
    fn many_homes_lie_under_a_roof_and_keep_their_doors_and_their_daylight() {
        let mut under = 0;
        for seed in 0..60 {
            let kinds = usual_programme(4 + seed as usize % 5);
            let plain = FloorPlan::new(&kinds, &Rng::new(seed));
            let varied = plain.clone().varied(&Rng::new(seed));
            if varied.rooms.iter().all(|room| room.slopes.is_empty()) {
                continue;
            }
            under += 1;
            assert_eq!(varied.doorways.len(), plain.doorways.len(), "seed {seed}");
            for (room, before) in varied.rooms.iter().zip(&plain.rooms) {
                let lit = |room: &Room| room.windows().count() > 0;
                assert!(lit(room) || !lit(before) || !norm(room.kind).window, "seed {seed}: {:?}", room.kind);
                for opening in &room.openings {
                    let thickness = room.thickness(opening);
                    let ceiling = room.lowest_before(opening.wall, opening.x, [-thickness, 0.0]);
                    assert!(opening.z[1] + 0.04 < ceiling, "seed {seed}: {opening:?} below {ceiling}");
                    let zone = room.way_zone(opening);
                    assert!(!opening.is_way() || room.lowest_over(&zone) > opening.z[1], "seed {seed}: {opening:?}");
                }
            }
        }
        assert!((12..=36).contains(&under), "{under} of 60");
    }
}
