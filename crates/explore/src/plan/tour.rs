//! The way of a video: through places all over the free space, the nearest unvisited one next, along shortest ways pulled straight.

use super::VideoConfig;
use super::places::Places;
use super::planner::Planner;
use crate::ExploreError;
use enfilade_math::{DVec3, Rng};

/// A polyline with room around every point of it.
pub(super) struct Tour {
    /// Corners of the tour. The first is the place nearest to the start.
    pub corners: Vec<DVec3>,
    /// Indices of the corners that are waypoints, in order.
    pub waypoints: Vec<usize>,
}

/// Points along straight ways, by length.
pub(super) struct Polyline<'a> {
    corners: &'a [DVec3],
    /// Distance along the tour of each corner, metres.
    pub reached_m: Vec<f64>,
}

impl<'a> Polyline<'a> {
    pub fn new(corners: &'a [DVec3]) -> Self {
        let mut reached_m = vec![0.0];
        for pair in corners.windows(2) {
            reached_m.push(reached_m[reached_m.len() - 1] + pair[0].distance(pair[1]));
        }
        Self { corners, reached_m }
    }

    pub fn length_m(&self) -> f64 {
        self.reached_m[self.reached_m.len() - 1]
    }

    /// The point `m` metres along.
    pub fn at(&self, m: f64) -> DVec3 {
        let i = self.reached_m.partition_point(|reached| *reached <= m).clamp(1, self.corners.len() - 1) - 1;
        let length = self.reached_m[i + 1] - self.reached_m[i];
        self.corners[i].lerp(self.corners[i + 1], ((m - self.reached_m[i]) / length).clamp(0.0, 1.0))
    }
}

/// Heights of places in one layer of voxels may differ by this.
const ROUNDING_M: f64 = 1e-6;

/// A way of at least `length_m`. When every waypoint was visited it goes round again.
pub(super) fn tour(planner: &Planner, start: DVec3, length_m: f64, video: &VideoConfig, rng: &mut Rng) -> Result<Tour, ExploreError> {
    // Heights count from the first place, not from the start camera, since places are centres of voxels.
    let range = planner.config.height_range_m + ROUNDING_M;
    let free_height = planner.config.camera_height_m.is_none();
    let places = Places::around(planner.rules, start, |first, p| !free_height || (p.z - first.z).abs() <= range);
    if places.points.is_empty() {
        return Err(ExploreError::NoPlaces { trajectory: planner.name.into(), position: start, clearance_m: planner.config.clearance_m });
    }
    let waypoints = waypoints(&places, video.waypoint_distance_m, rng);
    let mut tour = Tour { corners: vec![places.points[0]], waypoints: vec![0] };
    let (mut here, mut length, mut left) = (0, 0.0, waypoints.clone());
    let mut found = 0;
    while length < length_m {
        if left.is_empty() {
            if found == 0 {
                return Err(no_way(planner, start, "there is no second place to go to; lower clearance_m"));
            }
            (left, found) = (waypoints.clone(), 0);
        }
        let ways = places.ways_from(here);
        let Some(next) = (0..left.len()).filter(|i| left[*i] != here).min_by_key(|i| (ways[left[*i]].1, left[*i])) else {
            left.clear();
            continue;
        };
        let next = left.swap_remove(next);
        left.sort_unstable();
        let leg = pulled_straight(planner, way(&places, &ways, next));
        if leg.iter().any(|p| planner.gates.is_open(*p)) {
            continue;
        }
        length += leg.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>();
        tour.corners.extend(&leg[1..]);
        tour.waypoints.push(tour.corners.len() - 1);
        (here, found) = (next, found + 1);
    }
    Ok(tour)
}

/// The error of a video that cannot be made.
pub(super) fn no_way(planner: &Planner, position: DVec3, problem: impl Into<String>) -> ExploreError {
    ExploreError::NoWay { trajectory: planner.name.into(), position, problem: problem.into() }
}

/// Places at least `distance_m` apart, and as dense as that allows; where that leaves a single one, the place farthest from it as well.
/// Ascending.
fn waypoints(places: &Places, distance_m: f64, rng: &mut Rng) -> Vec<usize> {
    let mut chosen: Vec<usize> = Vec::new();
    for place in places.shuffled(rng) {
        if chosen.iter().all(|other| places.points[*other].distance(places.points[place]) >= distance_m) {
            chosen.push(place);
        }
    }
    if let [only] = chosen[..] {
        let distance = |place: usize| places.points[place].distance(places.points[only]);
        let farthest = (0..places.points.len()).filter(|place| *place != only);
        chosen.extend(farthest.max_by(|a, b| distance(*a).total_cmp(&distance(*b))));
    }
    chosen.sort_unstable();
    chosen
}

/// The places along the way that leads to `to`.
fn way(places: &Places, ways: &[(u32, u32)], to: usize) -> Vec<DVec3> {
    let mut back = vec![places.points[to]];
    let mut at = to;
    while ways[at].0 as usize != at {
        at = ways[at].0 as usize;
        back.push(places.points[at]);
    }
    back.reverse();
    back
}

/// Leaves out corners between which the straight way is clear, twice over.
fn pulled_straight(planner: &Planner, mut way: Vec<DVec3>) -> Vec<DVec3> {
    for _ in 0..2 {
        let mut kept = vec![way[0]];
        let mut i = 0;
        while i + 1 < way.len() {
            // The farthest corner with a clear way to it; each try halves the number of corners skipped.
            let mut ahead = way.len() - 1 - i;
            while ahead > 1 && !(planner.rules.is_clear_way(way[i], way[i + ahead]) && keeps_height(planner, way[i], way[i + ahead])) {
                ahead /= 2;
            }
            i += ahead;
            kept.push(way[i]);
        }
        way = kept;
    }
    way
}

/// Whether a straight way keeps the height above the floor that is asked for, if one is.
fn keeps_height(planner: &Planner, from: DVec3, to: DVec3) -> bool {
    let steps = (from.distance(to) / planner.rules.space.tree.resolution_m()).ceil() as usize;
    planner.config.camera_height_m.is_none()
        || (0..=steps).all(|i| planner.rules.is_at_height(from.lerp(to, i as f64 / steps.max(1) as f64)))
}
