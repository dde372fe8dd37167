//! What would not stay where it is: things that are in each other are joined, and what falls, tips or is pushed is fixed.
//!
//! The simulation of `[[object]]` (`enfilade_compose::unrest`) judges, with the pieces that are written. It runs for a short time first, so that what
//! hangs in the air is fixed before it falls on something else.

use crate::bodies::{Group, Hold};
use crate::model::Piece;
use enfilade_compose::{Solid, overlaps, unrest};
use std::collections::BTreeSet;

/// Seconds for which things are left to themselves, one after the other.
const SPANS_S: [f64; 3] = [0.1, 0.5, 2.0];
/// How far a thing may move, metres.
pub(crate) const STEADY_M: f64 = 5e-4;
/// How deep things may be in each other, metres.
const DEEP_M: f64 = 3e-4;
/// What is nearer to a joint's body at rest than this does not touch it, metres.
const NEAR_M: f64 = 5e-4;
/// Names in a note.
const TOLD: usize = 8;

/// Joins and fixes what would move.
pub(crate) fn settle(groups: &mut [Group], parts: &[Vec<Piece>], notes: &mut Vec<String>) {
    join(groups, parts, notes);
    let mut fallen = BTreeSet::new();
    for span in SPANS_S {
        loop {
            let moved = movers(groups, parts, span);
            if moved.is_empty() {
                break;
            }
            for number in moved {
                groups[number].joint = Hold::Fixed;
                fallen.insert(groups[number].name.clone());
            }
        }
    }
    if !fallen.is_empty() {
        notes.push(format!("{} things are fixed because they would not stay by themselves: {}", fallen.len(), told(&fallen)));
    }
}

/// Fixes free things that are in others to these: the lighter one to the heavier, or to the world where the other is fixed.
fn join(groups: &mut [Group], parts: &[Vec<Piece>], notes: &mut Vec<String>) {
    let all: Vec<Vec<Solid>> = groups.iter().map(|group| solids(group, parts)).collect();
    let mass = |group: &Group| -> f64 { pieces(group, parts).map(|piece| piece.mass_kg).sum() };
    let masses: Vec<f64> = groups.iter().map(mass).collect();
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

/// The free groups that move within some seconds.
fn movers(groups: &[Group], parts: &[Vec<Piece>], seconds: f64) -> Vec<usize> {
    let free: Vec<usize> = (0..groups.len()).filter(|number| groups[*number].joint == Hold::Free).collect();
    let mut things: Vec<Vec<Solid>> = vec![Vec::new(); free.len()];
    let mut fixed = Vec::new();
    for (number, group) in groups.iter().enumerate() {
        match free.binary_search(&root(groups, number)) {
            Ok(thing) => things[thing].extend(solids(group, parts)),
            Err(_) => fixed.extend(solids(group, parts)),
        }
    }
    let ways = unrest(&fixed, &things, seconds);
    free.into_iter().zip(ways).filter(|(_, way)| *way > STEADY_M).map(|(number, _)| number).collect()
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

fn solids(group: &Group, parts: &[Vec<Piece>]) -> Vec<Solid> {
    pieces(group, parts).map(|piece| piece.solid.clone()).collect()
}

fn told(names: &BTreeSet<String>) -> String {
    let first: Vec<&str> = names.iter().take(TOLD).map(String::as_str).collect();
    let more = if names.len() > TOLD { ", …" } else { "" };
    format!("{}{more}", first.join(", "))
}
