//! What would not stay where it is: things that are in each other are joined, what hovers is lowered, and what falls, tips or is
//! pushed is fixed, to what is free and bears it or else to the world.
//!
//! The simulation of `[[object]]` (`enfilade_compose::unrest`) judges, with the pieces that are written. It runs for a short time first, so that what
//! hangs in the air is fixed before it falls on something else.

use crate::bodies::{Group, Hold};
use crate::model::Piece;
use enfilade_compose::{Moments, Solid, Thing, Way, overlaps, unrest};
use enfilade_math::DVec3;
use std::collections::BTreeSet;

/// Seconds for which things are left to themselves, one after the other, to see what falls.
const FALLS_S: [f64; 2] = [0.1, 0.5];
/// Seconds in which what hovers comes down, and those in which everything has to stay.
const LOWERS_S: f64 = 0.25;
const STAYS_S: f64 = 2.0;
/// How far a thing may move, metres.
pub(crate) const STEADY_M: f64 = 5e-4;
/// What moves no farther hovers, and is lowered, metres.
const LOWERED_M: f64 = 3e-3;
/// What comes down by less stands, metres: contacts give way by that much.
const HOVERS_M: f64 = 1e-4;
/// How often things are lowered: each time, what stands on lowered things follows.
const ROUNDS: usize = 3;
/// How deep things may be in each other, metres.
const DEEP_M: f64 = 3e-4;
/// What is nearer to a joint's body at rest than this does not touch it, metres.
const NEAR_M: f64 = 5e-4;
/// Names in a note.
const TOLD: usize = 8;

/// Joins, lowers and fixes what would move.
pub(crate) fn settle(groups: &mut [Group], parts: &mut [Vec<Piece>], notes: &mut Vec<String>) {
    join(groups, parts, notes);
    let mut fallen = BTreeSet::new();
    FALLS_S.iter().for_each(|span| fix(groups, parts, *span, LOWERED_M, &mut fallen));
    for _ in 0..ROUNDS {
        for (number, way) in ways(groups, parts, LOWERS_S).into_iter().filter(|(_, way)| way.middle_m.z < -HOVERS_M) {
            shift(groups, parts, number, DVec3::Z * way.middle_m.z);
        }
    }
    fix(groups, parts, STAYS_S, STEADY_M, &mut fallen);
    if !fallen.is_empty() {
        notes.push(format!(
            "{} things are fixed, to what bears them, because they would not stay by themselves: {}",
            fallen.len(),
            told(&fallen)
        ));
    }
}

/// Fixes what moves farther than `most_m` within some seconds, until nothing does.
fn fix(groups: &mut [Group], parts: &[Vec<Piece>], seconds: f64, most_m: f64, fallen: &mut BTreeSet<String>) {
    loop {
        let ways = ways(groups, parts, seconds);
        let moves: Vec<usize> = ways.iter().filter(|(_, way)| way.farthest_m > most_m).map(|(number, _)| *number).collect();
        if moves.is_empty() {
            break;
        }
        for number in undermost(groups, parts, &moves) {
            groups[number].parent = bearer(groups, parts, number);
            groups[number].joint = Hold::Fixed;
            fallen.insert(groups[number].name.clone());
        }
    }
}

/// The heaviest free group on which a group stands, if it does on any: fixed to the world it would press on that.
fn bearer(groups: &[Group], parts: &[Vec<Piece>], number: usize) -> Option<usize> {
    let own = solids(&groups[number], parts);
    let near = |other: &usize| {
        let two = [own.clone(), solids(&groups[*other], parts)];
        bottom(&two[1]) < bottom(&two[0]) && !overlaps(&two, NEAR_M).is_empty()
    };
    let below = (0..groups.len()).filter(|other| *other != number && groups[*other].joint == Hold::Free);
    below.filter(near).max_by(|a, b| mass_kg(&groups[*a], parts).total_cmp(&mass_kg(&groups[*b], parts)))
}

/// Moves a group and what is joined to it.
fn shift(groups: &mut [Group], parts: &mut [Vec<Piece>], number: usize, by: DVec3) {
    for one in (0..groups.len()).filter(|one| root(groups, *one) == number).collect::<Vec<_>>() {
        groups[one].shift += by;
        let pieces =
            groups[one].parts.iter().flat_map(|part| std::mem::take(&mut parts[*part as usize]).into_iter().map(|piece| (*part, piece)));
        for (part, mut piece) in pieces.collect::<Vec<_>>() {
            piece.solid.corners.iter_mut().for_each(|corner| *corner += by);
            parts[part as usize].push(piece);
        }
    }
}

/// Groups among some that stand on no other of them: what stands on something that falls need not fall itself.
fn undermost(groups: &[Group], parts: &[Vec<Piece>], some: &[usize]) -> Vec<usize> {
    let all: Vec<Vec<Solid>> = some.iter().map(|number| solids(&groups[*number], parts)).collect();
    let bottoms: Vec<f64> = all.iter().map(|thing| bottom(thing)).collect();
    let above = |[a, b]: [usize; 2]| if bottoms[a] > bottoms[b] { a } else { b };
    let borne: BTreeSet<usize> = overlaps(&all, LOWERED_M).into_iter().map(above).collect();
    (0..some.len()).filter(|number| !borne.contains(number)).map(|number| some[number]).collect()
}

/// Fixes free things that are in others to these: the lighter one to the heavier, or to the world where the other is fixed.
fn join(groups: &mut [Group], parts: &[Vec<Piece>], notes: &mut Vec<String>) {
    let all: Vec<Vec<Solid>> = groups.iter().map(|group| solids(group, parts)).collect();
    let masses: Vec<f64> = groups.iter().map(|group| mass_kg(group, parts)).collect();
    let mut joined = BTreeSet::new();
    let mut pairs = overlaps(&all, -DEEP_M);
    // The heaviest bearers first, so that what is joined to something hangs on what stays itself.
    pairs.sort_by(|a, b| masses[b[0]].max(masses[b[1]]).total_cmp(&masses[a[0]].max(masses[a[1]])).then(a.cmp(b)));
    for [a, b] in pairs {
        let (light, heavy) = if masses[a] <= masses[b] { (a, b) } else { (b, a) };
        let free = |number: usize| groups[number].joint == Hold::Free;
        let (moves, on) = match (free(light), free(heavy)) {
            (false, false) => continue,
            (true, true) => (light, Some(root(groups, heavy))),
            (true, false) => (light, None),
            (false, true) => (heavy, None),
        };
        groups[moves].joint = Hold::Fixed;
        groups[moves].parent = on.filter(|on| *on != moves);
        joined.insert(groups[moves].name.clone());
    }
    if !joined.is_empty() {
        notes.push(format!("{} things are in others and are fixed to them: {}", joined.len(), told(&joined)));
    }
}

/// What a body is fixed to in the end.
fn root(groups: &[Group], mut number: usize) -> usize {
    while let Some(parent) = groups[number].parent.filter(|_| groups[number].joint == Hold::Fixed) {
        number = parent;
    }
    number
}

/// How the free groups move within some seconds.
fn ways(groups: &[Group], parts: &[Vec<Piece>], seconds: f64) -> Vec<(usize, Way)> {
    let free: Vec<usize> = (0..groups.len()).filter(|number| groups[*number].joint == Hold::Free).collect();
    let mut things: Vec<Vec<&Piece>> = vec![Vec::new(); free.len()];
    let mut fixed = Vec::new();
    for (number, group) in groups.iter().enumerate() {
        match free.binary_search(&root(groups, number)) {
            Ok(thing) => things[thing].extend(pieces(group, parts)),
            Err(_) => fixed.extend(solids(group, parts)),
        }
    }
    let moments = |pieces: &[&Piece]| Moments::joined(&pieces.iter().map(|piece| piece.solid.moments(piece.mass_kg)).collect::<Vec<_>>());
    let thing = |pieces: Vec<&Piece>| Thing { moments: moments(&pieces), solids: pieces.iter().map(|piece| piece.solid.clone()).collect() };
    let ways = unrest(&fixed, &things.into_iter().map(thing).collect::<Vec<_>>(), seconds);
    free.into_iter().zip(ways).collect()
}

/// Pairs of bodies of which one has a hinge or a slide, and which bear each other or touch at rest.
pub(crate) fn touching(groups: &[Group], parts: &[Vec<Piece>]) -> Vec<[usize; 2]> {
    let jointed = |number: usize| matches!(groups[number].joint, Hold::Hinge { .. } | Hold::Slide { .. });
    let all: Vec<Vec<Solid>> = groups.iter().map(|group| solids(group, parts)).collect();
    let near = overlaps(&all, NEAR_M).into_iter().filter(|[a, b]| jointed(*a) || jointed(*b));
    let borne = groups.iter().enumerate().filter_map(|(number, group)| group.bearer.map(|bearer| [bearer.min(number), bearer.max(number)]));
    near.chain(borne).collect::<BTreeSet<_>>().into_iter().collect()
}

fn pieces<'p>(group: &'p Group, parts: &'p [Vec<Piece>]) -> impl Iterator<Item = &'p Piece> {
    group.parts.iter().flat_map(move |part| &parts[*part as usize])
}

fn mass_kg(group: &Group, parts: &[Vec<Piece>]) -> f64 {
    pieces(group, parts).map(|piece| piece.mass_kg).sum()
}

/// Height of the lowest corner.
fn bottom(thing: &[Solid]) -> f64 {
    thing.iter().flat_map(|solid| &solid.corners).map(|corner| corner.z).fold(f64::INFINITY, f64::min)
}

pub(crate) fn solids(group: &Group, parts: &[Vec<Piece>]) -> Vec<Solid> {
    pieces(group, parts).map(|piece| piece.solid.clone()).collect()
}

pub(crate) fn told(names: &BTreeSet<String>) -> String {
    let first: Vec<&str> = names.iter().take(TOLD).map(String::as_str).collect();
    let more = if names.len() > TOLD { ", …" } else { "" };
    format!("{}{more}", first.join(", "))
}
