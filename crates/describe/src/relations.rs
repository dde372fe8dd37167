//! How things stand to each other, in the words of people: on, in, hangs from, against, under, beside, facing.
//!
//! What carries a thing is decided from the walls, floors and ceilings outward: a thing is on what its feet stand on and, if nothing is under
//! it, hangs from what touches it above or beside. docs/words.md states each relation with its thresholds.

use crate::body::Body;
use crate::contact::{self, AGAINST_M, Attempt, CEILING, Meeting};
use enfilade_dataset::{InstanceRelation, RelationKind};
use enfilade_math::{DVec2, DVec3};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Of the rays that meet what carries a thing most, another meets at least this share if it carries the thing too.
const ALSO: f64 = 0.2;
/// A thing is in another that is met on so many of the six ways from its middle, down among them: on all but that out.
const IN_WAYS: usize = 5;
/// And that has it between its sides, seen from above, up to this, metres: what is draped over something is not in it.
const WITHIN_M: f32 = 0.005;
/// Another thing or a wall is met by this share of a side's rays if the thing stands against it.
const AGAINST_SHARE: f64 = 0.4;
/// And is no farther away than this share of the thing's longest side: a mug near a lamp does not stand against it.
const AGAINST_LENGTHS: f64 = 0.15;
/// This share of a thing has another above it if it is under it.
const UNDER_SHARE: f64 = 0.5;
/// And no higher than this, metres.
const UNDER_M: f32 = 2.0;
/// Things beside each other are at most so far apart, metres.
const BESIDE_M: f64 = 0.5;
/// And at most so many lengths of the smaller one.
const BESIDE_LENGTHS: f64 = 1.5;
/// Their heights overlap by this share of the lower one's.
const BESIDE_OVERLAP: f64 = 0.3;
/// What a thing faces is at most so far away, metres.
const FACING_M: f64 = 5.5;
/// And no farther aside, above or below than this angle, degrees.
const FACING_DEG: f64 = 20.0;
/// Classes of things that people use from their front, and that so face others: bed, chair, sofa, desk, television, mirror.
const FACING_CLASSES: [i16; 6] = [4, 5, 6, 14, 19, 25];
/// Classes of what they face: furniture, doors, windows, mirrors, televisions and the like.
const FACED_CLASSES: [i16; 18] = [3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 15, 17, 19, 24, 25, 30, 32, 36];
/// Classes of what is in a wall: door, window.
const OPENINGS: [i16; 2] = [8, 9];
/// The wall's class.
const WALL: i16 = 1;

/// What carries a thing, and how.
#[derive(Clone, Debug, Default)]
struct Support {
    kind: Option<RelationKind>,
    by: Vec<(usize, Meeting)>,
}

/// All relations of these bodies, by subject, then kind, then object. `front` says to where the front of an instance looks, where it has any.
pub fn relations(bodies: &[Body], front: impl Fn(i16) -> Option<DVec2> + Sync) -> Vec<InstanceRelation> {
    let supports = supports(bodies);
    let things: Vec<usize> = (0..bodies.len()).filter(|&i| bodies[i].instance >= 1).collect();
    let of_thing = |&i: &usize| {
        let mut found = carried(bodies, &supports, i);
        found.extend(against(bodies, &supports, i));
        found.extend(under(bodies, &supports, i));
        found.extend(beside(bodies, &supports, i));
        found.extend(front(bodies[i].instance).into_iter().flat_map(|front| facing(bodies, i, front)));
        found
    };
    let mut all: Vec<InstanceRelation> = things.par_iter().flat_map_iter(of_thing).collect();
    all.sort_by_key(|r| (r.subject, r.kind, r.object, r.object_semantic));
    all
}

fn relation(bodies: &[Body], subject: usize, kind: RelationKind, object: usize, distance_m: f64) -> InstanceRelation {
    let Body { instance, semantic, .. } = bodies[object];
    InstanceRelation { subject: bodies[subject].instance, kind, object: instance, object_semantic: semantic, distance_m }
}

/// The others whose bounds come within `reach_m` of a body's.
fn near(bodies: &[Body], i: usize, reach_m: f64) -> impl Iterator<Item = (usize, &Body)> {
    bodies.iter().enumerate().filter(move |(j, b)| *j != i && bodies[i].bounds_distance_m(b) <= reach_m)
}

/// What carries each thing. Walls, floors and ceilings carry themselves; then, round by round, what they carry in the most telling way; where
/// that leads no farther, in a less telling one.
fn supports(bodies: &[Body]) -> Vec<Support> {
    let attempts = |i: usize| {
        let others: Vec<(usize, &Body)> = near(bodies, i, 0.03).collect();
        if bodies[i].instance < 1 { Vec::new() } else { contact::attempts(&bodies[i], &others) }
    };
    let attempts: Vec<Vec<Attempt>> = (0..bodies.len()).into_par_iter().map(attempts).collect();
    let mut supports: Vec<Support> = vec![Support::default(); bodies.len()];
    let mut carried: Vec<bool> = bodies.iter().map(|body| body.instance < 1).collect();
    loop {
        let by_known = |attempt: &Attempt| {
            let known: Vec<(usize, Meeting)> = attempt.met.iter().copied().filter(|&(j, _)| carried[j]).collect();
            (!known.is_empty()).then(|| Support { kind: Some(attempt.kind), by: foremost(known) })
        };
        let open = || (0..bodies.len()).filter(|&i| !carried[i]);
        let first = |i: usize| Some((i, attempts[i].first().and_then(by_known)?));
        let any = |i: usize| Some((i, attempts[i].iter().find_map(by_known)?));
        let mut next: Vec<(usize, Support)> = open().filter_map(first).collect();
        if next.is_empty() {
            next = open().filter_map(any).collect();
        }
        if next.is_empty() {
            return supports;
        }
        for (i, support) in next {
            carried[i] = true;
            supports[i] = support;
        }
    }
}

/// Those that are met most.
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

/// On, in, or hangs from.
fn carried(bodies: &[Body], supports: &[Support], i: usize) -> Vec<InstanceRelation> {
    let mut found = Vec::new();
    for (j, container) in near(bodies, i, 0.0).filter(|(_, b)| b.instance >= 1 && b.upright.volume() > bodies[i].upright.volume()) {
        if is_in(&bodies[i], container) {
            found.push(relation(bodies, i, RelationKind::In, j, 0.0));
        }
    }
    let within: BTreeSet<i16> = found.iter().map(|relation| relation.object).collect();
    let Some(kind) = supports[i].kind else { return found };
    let is_opening = OPENINGS.contains(&bodies[i].semantic);
    for &(j, meeting) in supports[i].by.iter().filter(|(j, _)| bodies[*j].instance < 1 || !within.contains(&bodies[*j].instance)) {
        let kind = if is_opening && bodies[j].semantic == WALL { RelationKind::In } else { kind };
        found.push(relation(bodies, i, kind, j, meeting.gap_m));
    }
    found
}

/// Whether one carries the other, directly or by way of others.
fn rests_on(supports: &[Support], i: usize, on: usize) -> bool {
    let (mut seen, mut stack) = (BTreeSet::from([i]), vec![i]);
    while let Some(k) = stack.pop() {
        for &(j, _) in &supports[k].by {
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

/// What a thing on the floor or on other things stands against: walls, and things that are higher than half of it.
fn against(bodies: &[Body], supports: &[Support], i: usize) -> Vec<InstanceRelation> {
    if supports[i].kind != Some(RelationKind::On) {
        return Vec::new();
    }
    let reach = f64::from(AGAINST_M).min(AGAINST_LENGTHS * bodies[i].upright.extents.max_element());
    let meets = |j: usize, b: &Body| {
        let apart = b.semantic != CEILING && !rests_on(supports, i, j) && !rests_on(supports, j, i);
        let sides = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)];
        let mut met = sides.iter().filter(|_| apart).filter_map(|&(axis, sign)| contact::beside(&bodies[i], b, axis, sign));
        met.any(|meeting| meeting.share >= AGAINST_SHARE).then(|| bodies[i].distance_m(b)).filter(|&gap| gap <= reach)
    };
    let carriers: BTreeSet<usize> = supports[i].by.iter().map(|(j, _)| *j).collect();
    let others = near(bodies, i, f64::from(AGAINST_M)).filter(|(j, _)| !carriers.contains(j));
    others.filter_map(|(j, b)| meets(j, b).map(|gap| relation(bodies, i, RelationKind::Against, j, gap))).collect()
}

/// What a thing is under: things, not those that hang from the ceiling, nor those that it carries or is in.
fn under(bodies: &[Body], supports: &[Support], i: usize) -> Vec<InstanceRelation> {
    let mut found = Vec::new();
    for (j, b) in near(bodies, i, f64::from(UNDER_M)).filter(|(_, b)| b.instance >= 1) {
        let hangs_high =
            supports[j].kind == Some(RelationKind::HangsFrom) && supports[j].by.iter().any(|(k, _)| bodies[*k].semantic == CEILING);
        let higher = f64::from(b.bounds.max.z) > f64::from(bodies[i].bounds.max.z);
        // Books on a shelf are not said to be under those on the next.
        let share_thing = supports[i].by.iter().any(|(k, _)| bodies[*k].instance >= 1 && supports[j].by.iter().any(|(l, _)| k == l));
        if hangs_high || !higher || share_thing || rests_on(supports, j, i) || rests_on(supports, i, j) || is_in(&bodies[i], b) {
            continue;
        }
        if let Some(met) = contact::above(&bodies[i], b, UNDER_M).filter(|met| met.share >= UNDER_SHARE) {
            found.push(relation(bodies, i, RelationKind::Under, j, met.gap_m));
        }
    }
    found
}

/// What stands beside a thing on the same ground, with nothing between; said once, of the lower number.
fn beside(bodies: &[Body], supports: &[Support], i: usize) -> Vec<InstanceRelation> {
    let a = &bodies[i];
    let mut found = Vec::new();
    for (j, b) in near(bodies, i, BESIDE_M).filter(|(_, b)| b.instance > a.instance) {
        let shared = supports[i].kind == Some(RelationKind::On)
            && supports[j].kind == Some(RelationKind::On)
            && supports[i].by.iter().any(|(k, _)| supports[j].by.iter().any(|(l, _)| k == l));
        // What runs around the room is beside everything.
        let around = [(a, b), (b, a)].iter().any(|(a, b)| a.bounds.contains(b.center().as_vec3().truncate().extend(a.bounds.center().z)));
        if !shared || around {
            continue;
        }
        let heights = [a, b].map(|body| body.upright.extents.z);
        let overlap = f64::from(a.bounds.max.z.min(b.bounds.max.z) - a.bounds.min.z.max(b.bounds.min.z));
        let smaller = a.upright.extents.x.min(b.upright.extents.x);
        if overlap < BESIDE_OVERLAP * heights[0].min(heights[1]) {
            continue;
        }
        let distance = a.distance_m(b);
        let level = f64::from(a.bounds.min.z.max(b.bounds.min.z)) + 0.5 * overlap;
        let ends = [a, b].map(|body| body.center().truncate().extend(level));
        let near_enough = distance <= BESIDE_M.min(BESIDE_LENGTHS * smaller);
        if near_enough && !near(bodies, i, BESIDE_M).any(|(k, c)| k != j && c.is_between(ends)) {
            found.push(relation(bodies, i, RelationKind::Beside, j, distance));
        }
    }
    found
}

/// What a thing with a front looks at: things of some size near the middle of its view, with nothing between.
fn facing(bodies: &[Body], i: usize, front: DVec2) -> Vec<InstanceRelation> {
    let a = &bodies[i];
    if !FACING_CLASSES.contains(&a.semantic) {
        return Vec::new();
    }
    let within = near(bodies, i, FACING_M).filter(|(_, b)| b.instance >= 1 && FACED_CLASSES.contains(&b.semantic));
    let mut found = Vec::new();
    for (j, b) in within {
        let way: DVec3 = b.center() - a.center();
        let aside = front.extend(0.0).angle_between(way).to_degrees();
        let distance = way.length();
        let ends = [a.center(), b.center()];
        let free = || near(bodies, i, FACING_M).all(|(k, c)| k == j || !c.is_between(ends));
        if distance > 0.0 && distance <= FACING_M && aside <= FACING_DEG && free() {
            found.push(relation(bodies, i, RelationKind::Facing, j, distance));
        }
    }
    found
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
