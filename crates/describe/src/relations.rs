//! Spatial relations between things, as people name them: on, in, hangs from, against, under, beside, facing.
//!
//! Support is decided from the walls, floors and ceilings outward: a thing is on what its feet stand on and, if nothing is under it, hangs
//! from what touches it above or beside. docs/words.md states each relation with its thresholds.

use crate::body::Body;
use crate::contact::{self, AGAINST_M, Attempt, Meeting};
use enfilade_dataset::{InstanceRelation, RelationKind};
use enfilade_math::{DVec2, DVec3};
use enfilade_scene::{CEILING, WALL};
use std::collections::BTreeSet;

/// Share of the rays that meet a thing's main support from which on another thing carries it too.
const ALSO: f64 = 0.2;
/// Number of the six ways from a thing's middle, down among them, on which it meets another that it is in: on all but the way out.
const IN_WAYS: usize = 5;
/// Farthest that a thing in another may reach beyond its sides, seen from above, metres: what is draped over something is not in it.
const WITHIN_M: f32 = 0.005;
/// Least share of a side's rays that meet another thing or a wall if the thing stands against it.
const AGAINST_SHARE: f64 = 0.4;
/// Greatest gap to what a thing stands against, as a share of its longest side: a mug near a lamp does not stand against it.
const AGAINST_LENGTHS: f64 = 0.15;
/// Share of a thing that has another above it if it is under it.
const UNDER_SHARE: f64 = 0.5;
/// Greatest height of what a thing is under above it, metres.
const UNDER_M: f32 = 2.0;
/// Things beside each other are at most so far apart, metres.
const BESIDE_M: f64 = 0.5;
/// Greatest gap between things beside each other, in lengths of the smaller one.
const BESIDE_LENGTHS: f64 = 1.5;
/// Share of the lower thing's height in which the heights of things beside each other overlap.
const BESIDE_OVERLAP: f64 = 0.3;
/// Greatest distance to what a thing faces, metres.
const FACING_M: f64 = 5.5;
/// Greatest angle between a thing's front and what it faces, aside, above or below, degrees.
const FACING_DEG: f64 = 20.0;
/// Classes of things that people use from their front, and that so face others: bed, chair, sofa, desk, television, mirror.
const FACING_CLASSES: [i16; 6] = [4, 5, 6, 14, 19, 25];
/// Classes of things that are faced: furniture, doors, windows, mirrors, televisions and similar.
const FACED_CLASSES: [i16; 18] = [3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 15, 17, 19, 24, 25, 30, 32, 36];
/// Classes of what is in a wall: door, window.
const OPENINGS: [i16; 2] = [8, 9];

/// The support of a thing.
#[derive(Clone, Debug, Default)]
struct Support {
    kind: Option<RelationKind>,
    by: Vec<(usize, Meeting)>,
}

/// The bodies of a scene and what carries them.
struct Scene<'b> {
    bodies: &'b [Body],
    supports: Vec<Support>,
}

/// All relations of these bodies, by subject, then kind, then object. `front` returns the direction of an instance's front, if it has one.
pub fn relations(bodies: &[Body], front: impl Fn(i16) -> Option<DVec2> + Sync) -> Vec<InstanceRelation> {
    let scene = Scene { bodies, supports: supports(bodies) };
    let of_thing = |&i: &usize| {
        let mut found = scene.carried(i);
        found.extend(scene.against(i));
        found.extend(scene.under(i));
        found.extend(scene.beside(i));
        found.extend(front(bodies[i].instance).into_iter().flat_map(|front| scene.facing(i, front)));
        found
    };
    let things: Vec<usize> = (0..bodies.len()).filter(|&i| bodies[i].is_thing()).collect();
    let mut all: Vec<InstanceRelation> = enfilade_parallel::flat_map(&things, of_thing);
    all.sort_by_key(|r| (r.subject, r.kind, r.object, r.object_semantic));
    all
}

/// Other bodies whose bounds come within `reach_m` of a body's.
fn near(bodies: &[Body], i: usize, reach_m: f64) -> impl Iterator<Item = (usize, &Body)> {
    bodies.iter().enumerate().filter(move |(j, b)| *j != i && bodies[i].bounds_distance_m(b) <= reach_m)
}

/// The support of each body. Walls, floors and ceilings support themselves. Then, round by round, of the bodies that meet a supported one,
/// those are added that do so in the most conclusive way.
fn supports(bodies: &[Body]) -> Vec<Support> {
    let attempts = |i: usize| {
        let others: Vec<(usize, &Body)> = near(bodies, i, 0.03).collect();
        if bodies[i].is_thing() { contact::attempts(&bodies[i], &others) } else { Vec::new() }
    };
    let attempts: Vec<Vec<Attempt>> = enfilade_parallel::map_up_to(bodies.len(), attempts);
    let mut supports: Vec<Support> = vec![Support::default(); bodies.len()];
    let mut carried: Vec<bool> = bodies.iter().map(|body| !body.is_thing()).collect();
    loop {
        // The first way of each in which something meets it that is carried.
        let way = |i: usize| {
            let known = |attempt: &Attempt| attempt.met.iter().copied().filter(|&(j, _)| carried[j]).collect::<Vec<_>>();
            let mut ways = attempts[i].iter().map(|attempt| (attempt.kind, known(attempt))).enumerate();
            ways.find(|(_, (_, by))| !by.is_empty()).map(|(rank, (kind, by))| (rank, i, Support { kind: Some(kind), by: foremost(by) }))
        };
        let found: Vec<(usize, usize, Support)> = (0..bodies.len()).filter(|&i| !carried[i]).filter_map(way).collect();
        let Some(best) = found.iter().map(|(rank, ..)| *rank).min() else { return supports };
        for (_, i, support) in found.into_iter().filter(|(rank, ..)| *rank == best) {
            carried[i] = true;
            supports[i] = support;
        }
    }
}

/// Bodies that are met most.
fn foremost(mut met: Vec<(usize, Meeting)>) -> Vec<(usize, Meeting)> {
    let most = met.iter().map(|(_, meeting)| meeting.share).fold(0.0, f64::max);
    met.retain(|(_, meeting)| meeting.share >= ALSO * most);
    met
}

/// Whether a body is in another: within its bounds from above, and enclosed on all sides but one.
fn is_in(a: &Body, container: &Body) -> bool {
    let (low, high) = (container.bounds.min - WITHIN_M, container.bounds.max + WITHIN_M);
    let within = a.bounds.min.truncate().cmpge(low.truncate()).all() && a.bounds.max.truncate().cmple(high.truncate()).all();
    let (ways, down) = if within { contact::enclosed(a, container) } else { (0, false) };
    down && ways >= IN_WAYS
}

impl Scene<'_> {
    fn relation(&self, subject: usize, kind: RelationKind, object: usize, distance_m: f64) -> InstanceRelation {
        let Body { instance, semantic, .. } = self.bodies[object];
        InstanceRelation { subject: self.bodies[subject].instance, kind, object: instance, object_semantic: semantic, distance_m }
    }

    /// The bodies that carry a body.
    fn carriers(&self, i: usize) -> impl Iterator<Item = usize> + '_ {
        self.supports[i].by.iter().map(|(j, _)| *j)
    }

    /// Whether one carries the other, directly or by way of others.
    fn rests_on(&self, i: usize, on: usize) -> bool {
        let (mut seen, mut stack) = (BTreeSet::from([i]), vec![i]);
        while let Some(k) = stack.pop() {
            for j in self.carriers(k) {
                if j == on {
                    return true;
                }
                if seen.insert(j) {
                    stack.push(j);
                }
            }
        }
        false
    }

    /// Whether nothing is between two points of two bodies but what these carry: cushions do not hide a sofa.
    fn is_free(&self, [i, j]: [usize; 2], ends: [DVec3; 2], reach_m: f64) -> bool {
        let hides = |(k, c): (usize, &Body)| k != j && c.is_between(ends) && !self.rests_on(k, i) && !self.rests_on(k, j);
        !near(self.bodies, i, reach_m).any(hides)
    }

    /// On, in, or hangs from.
    fn carried(&self, i: usize) -> Vec<InstanceRelation> {
        let a = &self.bodies[i];
        let larger = near(self.bodies, i, 0.0).filter(|(_, b)| b.is_thing() && b.upright.volume() > a.upright.volume());
        let within: Vec<usize> = larger.filter(|(_, b)| is_in(a, b)).map(|(j, _)| j).collect();
        let mut found: Vec<InstanceRelation> = within.iter().map(|&j| self.relation(i, RelationKind::In, j, 0.0)).collect();
        let Some(kind) = self.supports[i].kind else { return found };
        for &(j, meeting) in self.supports[i].by.iter().filter(|(j, _)| !within.contains(j)) {
            let in_wall = OPENINGS.contains(&a.class) && self.bodies[j].class == WALL;
            found.push(self.relation(i, if in_wall { RelationKind::In } else { kind }, j, meeting.gap_m));
        }
        found
    }

    /// Walls and other things that a thing stands against, if it is on something.
    fn against(&self, i: usize) -> Vec<InstanceRelation> {
        if self.supports[i].kind != Some(RelationKind::On) {
            return Vec::new();
        }
        let a = &self.bodies[i];
        let reach = f64::from(AGAINST_M).min(AGAINST_LENGTHS * a.upright.extents.max_element());
        let sides = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)];
        let meets = |b: &Body| {
            let mut met = sides.iter().filter_map(|&(axis, sign)| contact::beside(a, b, axis, sign));
            met.any(|meeting| meeting.share >= AGAINST_SHARE)
        };
        let others =
            near(self.bodies, i, reach).filter(|(j, b)| b.class != CEILING && meets(b) && !self.rests_on(i, *j) && !self.rests_on(*j, i));
        let gaps = others.map(|(j, b)| (j, a.distance_m(b))).filter(|(_, gap)| *gap <= reach);
        gaps.map(|(j, gap)| self.relation(i, RelationKind::Against, j, gap)).collect()
    }

    /// The things that a thing is under, except those that hang from the ceiling, that it carries, or that it is in.
    fn under(&self, i: usize) -> Vec<InstanceRelation> {
        let a = &self.bodies[i];
        let higher = near(self.bodies, i, f64::from(UNDER_M))
            .filter(|(_, b)| b.is_thing() && b.bounds.max.z > a.bounds.max.z && a.overlaps_from_above(b));
        let met = higher.filter_map(|(j, b)| Some((j, contact::above(a, b, UNDER_M).filter(|met| met.share >= UNDER_SHARE)?)));
        let is_under = |(j, _): &(usize, Meeting)| {
            let hangs_high =
                self.supports[*j].kind == Some(RelationKind::HangsFrom) && self.carriers(*j).any(|k| self.bodies[k].class == CEILING);
            // Books on a shelf do not count as under those on the next.
            let share_thing = self.carriers(i).any(|k| self.bodies[k].is_thing() && self.carriers(*j).any(|l| k == l));
            !hangs_high && !share_thing && !self.rests_on(*j, i) && !self.rests_on(i, *j) && !is_in(a, &self.bodies[*j])
        };
        met.filter(is_under).map(|(j, met)| self.relation(i, RelationKind::Under, j, met.gap_m)).collect()
    }

    /// The things beside a thing on the same support, with nothing between; each pair is listed once, under the lower number.
    fn beside(&self, i: usize) -> Vec<InstanceRelation> {
        let a = &self.bodies[i];
        let is_on = |j: usize| self.supports[j].kind == Some(RelationKind::On);
        let stands_beside = |j: usize, b: &Body| {
            let smaller = a.upright.extents.x.min(b.upright.extents.x);
            let reach = BESIDE_M.min(BESIDE_LENGTHS * smaller);
            let overlap = f64::from(a.bounds.max.z.min(b.bounds.max.z) - a.bounds.min.z.max(b.bounds.min.z));
            let is_level = overlap >= BESIDE_OVERLAP * a.upright.extents.z.min(b.upright.extents.z);
            let shares_ground = self.carriers(i).any(|k| self.carriers(j).any(|l| k == l));
            // Things that run around the room are beside everything.
            let is_around = a.holds_from_above(b.center()) || b.holds_from_above(a.center());
            if a.bounds_distance_m(b) > reach || !is_level || !is_on(j) || !shares_ground || is_around {
                return None;
            }
            let level = f64::from(a.bounds.min.z.max(b.bounds.min.z)) + 0.5 * overlap;
            let ends = [a, b].map(|body| body.center().truncate().extend(level));
            let distance = Some(a.distance_m(b)).filter(|distance| *distance <= reach)?;
            self.is_free([i, j], ends, BESIDE_M).then_some(distance)
        };
        let others = near(self.bodies, i, BESIDE_M).filter(|(_, b)| is_on(i) && b.instance > a.instance);
        others.filter_map(|(j, b)| Some(self.relation(i, RelationKind::Beside, j, stands_beside(j, b)?))).collect()
    }

    /// The things that a thing with a front faces: furniture and similar near the middle of its view, with nothing between.
    fn facing(&self, i: usize, front: DVec2) -> Vec<InstanceRelation> {
        let a = &self.bodies[i];
        let looks = |(j, b): (usize, &Body)| {
            let way = b.center() - a.center();
            let is_ahead = way.length() <= FACING_M && front.extend(0.0).angle_between(way).to_degrees() <= FACING_DEG;
            let is_free = || self.is_free([i, j], [a.center(), b.center()], FACING_M);
            (is_ahead && is_free()).then(|| self.relation(i, RelationKind::Facing, j, way.length()))
        };
        let is_faced = |(_, b): &(usize, &Body)| b.is_thing() && FACED_CLASSES.contains(&b.class);
        let looks_out = FACING_CLASSES.contains(&a.class);
        near(self.bodies, i, FACING_M).filter(|other| looks_out && is_faced(other)).filter_map(looks).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_rooms::boxed;

    /// A room with a rug, a table on it, a mug and a bowl on the table, a sofa at the wall that looks at a television, a lamp and a picture.
    fn room() -> Vec<Body> {
        let at = |instance: i16, semantic: i16, low: [f64; 3], high: [f64; 3]| boxed(instance, semantic, low.into(), high.into());
        vec![
            at(-1, 2, [-3.0, -3.0, -0.1], [3.0, 3.0, 0.0]),
            at(-1, 22, [-3.0, -3.0, 2.5], [3.0, 3.0, 2.6]),
            at(-1, 1, [-3.0, 3.0, 0.0], [3.0, 3.2, 2.5]),
            at(1, 20, [-1.0, -1.0, 0.0], [1.0, 1.0, 0.01]),
            at(2, 7, [-0.5, -0.4, 0.01], [0.5, 0.4, 0.45]),
            at(3, 40, [-0.1, -0.1, 0.45], [0.0, 0.0, 0.55]),
            at(4, 40, [0.1, -0.1, 0.45], [0.25, 0.05, 0.52]),
            at(5, 6, [-1.0, 2.05, 0.0], [1.0, 2.95, 0.8]),
            at(6, 25, [-0.6, -2.8, 0.4], [0.6, -2.7, 1.1]),
            at(7, 35, [-0.2, -0.2, 2.0], [0.2, 0.2, 2.5]),
            at(8, 11, [-0.3, 2.97, 1.4], [0.3, 2.999, 1.8]),
            at(9, 7, [-0.7, -2.95, 0.0], [0.7, -2.6, 0.4]),
        ]
    }

    #[test]
    fn a_living_room_is_told_as_people_would() {
        let bodies = room();
        let front = |instance: i16| match instance {
            5 => Some(DVec2::NEG_Y),
            6 => Some(DVec2::Y),
            _ => None,
        };
        let said = |r: &InstanceRelation| {
            let object = if r.object == -1 { enfilade_label::class_name(r.object_semantic).to_string() } else { r.object.to_string() };
            format!("{} {} {object}", r.subject, r.kind.name())
        };
        let found: Vec<String> = relations(&bodies, front).iter().map(said).collect();
        let expected = [
            "1 on floor",
            "2 on 1",
            "3 on 2",
            "3 beside 4",
            "4 on 2",
            "5 on floor",
            "5 against wall",
            "5 facing 2",
            "5 facing 6",
            "6 on 9",
            "6 facing 2",
            "6 facing 5",
            "7 hangs_from ceiling",
            "8 hangs_from wall",
            "9 on floor",
        ];
        assert_eq!(found, expected);
    }
}
