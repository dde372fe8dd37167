//! Questions about all frames of a camera together.

use super::place;
use super::{Answer, Asker};
use crate::seen::SeenFrame;
use crate::things::Things;
use crate::words;
use enfilade_dataset::DescribedInstance;
use enfilade_math::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// A thing is clearly seen in a frame in which it covers this share.
const CLEAR: f64 = 5e-3;
/// Questions of a kind, at most.
const EACH: usize = 10;
/// Things to choose from.
const CHOICES: usize = 4;
/// The nearest of several is nearer than the next by this, metres.
const NEARER_M: f64 = 0.15;
/// Distances below this are not asked for, metres.
const APART_M: f64 = 0.1;
/// Things that directions are asked between are so far apart, metres.
const DIRECTION_M: f64 = 0.5;

/// A thing, with the frames in which it is first seen at all and first seen clearly.
type First<'a> = (&'a DescribedInstance, [u32; 2]);

/// The things that the frames show, taken together.
struct Shown<'a> {
    things: &'a Things,
    /// Things that the frames show clearly, with none beside them that could be meant by their name.
    unique: Vec<First<'a>>,
    /// All that they show and that has a name, by name: those clearly seen, and how many there are in all.
    by_noun: BTreeMap<&'a str, (Vec<i16>, usize)>,
}

impl<'a> Shown<'a> {
    fn new(things: &'a Things, described: &'a [DescribedInstance], seen: &[&SeenFrame]) -> Self {
        let mut first: BTreeMap<i16, (u32, Option<u32>)> = BTreeMap::new();
        for frame in seen {
            for (&instance, sight) in &frame.sights {
                let (_, clear) = first.entry(instance).or_insert((frame.frame, None));
                *clear = clear.or(frame.covers(sight, CLEAR).then_some(frame.frame));
            }
        }
        let mut by_noun: BTreeMap<&str, (Vec<i16>, usize)> = BTreeMap::new();
        let mut unique = Vec::new();
        let named = first.iter().filter_map(|(&i, first)| Some((&described[things.place(i)?], *first)));
        for (thing, (any, clear)) in named.filter(|(thing, _)| !thing.noun.is_empty() && words::is_countable(&thing.noun)) {
            let (clearly, all) = by_noun.entry(&thing.noun).or_default();
            *all += 1;
            if let Some(clear) = clear {
                clearly.push(thing.instance);
                unique.push((thing, [any, clear]));
            }
        }
        let nouns: Vec<&str> = by_noun.keys().copied().collect();
        let is_alone = |noun: &str| words::is_alone(noun, nouns.iter().copied());
        unique.retain(|(thing, _)| by_noun[thing.noun.as_str()].1 == 1 && is_alone(&thing.noun));
        // "Chairs" may be meant to have office chairs among them.
        by_noun.retain(|noun, _| is_alone(noun));
        Self { things, unique, by_noun }
    }

    fn distance_m(&self, a: &DescribedInstance, b: &DescribedInstance) -> f64 {
        let body =
            |thing: &DescribedInstance| &self.things.bodies[self.things.place(thing.instance).expect("things that are shown have bodies")];
        body(a).distance_m(body(b))
    }

    /// Unique things in random order, `count` of them; `None` where there are fewer.
    fn some(&self, asker: &mut Asker<'_>, count: usize) -> Option<Vec<First<'a>>> {
        let mut list = self.unique.clone();
        asker.shuffle(&mut list);
        (list.len() >= count).then(|| list[..count].to_vec())
    }
}

/// Asks about the frames of a camera that were taken from these positions.
pub fn of_video(asker: &mut Asker<'_>, things: &Things, described: &[DescribedInstance], seen: &[&SeenFrame], eyes: &[DVec3]) {
    let shown = Shown::new(things, described, seen);
    counting(asker, &shown);
    sizes(asker, &shown);
    room_size(asker, things, eyes);
    distances(asker, &shown);
    nearest(asker, &shown);
    directions(asker, &shown);
    appearance(asker, &shown);
}

fn counting(asker: &mut Asker<'_>, shown: &Shown<'_>) {
    // Where some are hardly seen, people would count otherwise.
    let counted = shown.by_noun.iter().filter(|(_, (clear, all))| *all >= 2 && clear.len() == *all);
    for (noun, (clear, all)) in counted.take(EACH) {
        let question = format!("How many {} do these frames show?", words::plural(noun));
        asker.ask(None, "object_counting", question, Answer::Open(all.to_string()), clear);
    }
}

fn sizes(asker: &mut Asker<'_>, shown: &Shown<'_>) {
    for (thing, _) in shown.some(asker, shown.unique.len()).into_iter().flatten().take(EACH) {
        let question = format!("How long is the longest side (length, width or height) of the {}, in centimetres?", thing.noun);
        let answer = Answer::Open(format!("{:.0}", 100.0 * thing.size_m.max_element()));
        asker.ask(None, "object_size_estimation", question, answer, &[thing.instance]);
    }
}

/// Asks for the size of the room, if all frames were taken in one known room.
fn room_size(asker: &mut Asker<'_>, things: &Things, eyes: &[DVec3]) {
    let Some(rooms) = &things.rooms else { return };
    let seen: BTreeSet<Option<usize>> = eyes.iter().map(|&eye| rooms.room_at(eye)).collect();
    if let (1, Some(Some(room))) = (seen.len(), seen.first()) {
        let question = "What is the floor area of the room in which these frames were taken, in square metres?".to_string();
        asker.ask(None, "room_size_estimation", question, Answer::Open(format!("{:.1}", rooms.outlines[*room].area_m2())), &[]);
    }
}

fn distances(asker: &mut Asker<'_>, shown: &Shown<'_>) {
    let (mut known, mut asked) = (BTreeSet::new(), 0);
    for _ in 0..2 * EACH {
        let Some([(a, _), (b, _)]) = shown.some(asker, 2).and_then(|some| <[_; 2]>::try_from(some).ok()) else { return };
        let pair = [a.instance.min(b.instance), a.instance.max(b.instance)];
        if asked == EACH || !known.insert(pair) {
            continue;
        }
        let distance = shown.distance_m(a, b);
        if distance >= APART_M {
            asked += 1;
            let question = format!("How far are the {} and the {} apart at their nearest points, in metres?", a.noun, b.noun);
            asker.ask(None, "object_abs_distance", question, Answer::Open(format!("{distance:.1}")), &[a.instance, b.instance]);
        }
    }
}

fn nearest(asker: &mut Asker<'_>, shown: &Shown<'_>) {
    let (mut known, mut asked) = (BTreeSet::new(), 0);
    for _ in 0..2 * EACH {
        let Some(some) = shown.some(asker, 1 + CHOICES) else { return };
        let (target, _) = some[0];
        if asked == EACH || !known.insert(target.instance) {
            continue;
        }
        let mut others: Vec<(f64, &DescribedInstance)> =
            some[1..].iter().map(|&(thing, _)| (shown.distance_m(target, thing), thing)).collect();
        others.sort_by(|a, b| a.0.total_cmp(&b.0));
        if others[1].0 - others[0].0 < NEARER_M {
            known.remove(&target.instance);
            continue;
        }
        asked += 1;
        let mut names: Vec<String> = others.iter().map(|(_, thing)| thing.noun.clone()).collect();
        let right = names.remove(0);
        let question = format!("Which of these is nearest to the {}, measured between nearest points?", target.noun);
        let instances: Vec<i16> = [target.instance].into_iter().chain(others.iter().map(|(_, thing)| thing.instance)).collect();
        asker.ask(None, "object_rel_distance", question, Answer::Choice { right, wrong: names }, &instances);
    }
}

/// Left or right; left, right or back; quarters: one question after the other.
fn directions(asker: &mut Asker<'_>, shown: &Shown<'_>) {
    type Which = fn(f64) -> Option<usize>;
    let kinds: [(&str, Which, &str, &[&str]); 3] = [
        ("object_rel_direction_easy", place::side, "to my left or to my right", &["left", "right"]),
        ("object_rel_direction_medium", place::third, "to my left, to my right or behind me", &["left", "right", "back"]),
        (
            "object_rel_direction_hard",
            place::quarter,
            "to my front-left, front-right, back-left or back-right",
            &["front-left", "front-right", "back-left", "back-right"],
        ),
    ];
    for (kind, which, words, options) in kinds {
        let mut known = BTreeSet::new();
        for _ in 0..3 * EACH {
            let Some([(a, _), (b, _), (c, _)]) = shown.some(asker, 3).and_then(|some| <[_; 3]>::try_from(some).ok()) else { return };
            let [standing, facing, asked] = [a, b, c].map(|thing| thing.center.truncate());
            let apart = [(standing, facing), (standing, asked), (facing, asked)].iter().all(|(p, q)| p.distance(*q) >= DIRECTION_M);
            let right = which(place::angle_deg(standing, facing, asked)).filter(|_| apart && known.len() < EACH);
            let instances = [a, b, c].map(|thing| thing.instance);
            if let Some(right) = right.filter(|_| known.insert(instances)) {
                let question = format!("I stand at the {} and face the {}. Is the {} {words}?", a.noun, b.noun, c.noun);
                let options = options.iter().map(ToString::to_string).collect();
                asker.ask(None, kind, question, Answer::Ordered(options, right), &instances);
            }
        }
    }
}

fn appearance(asker: &mut Asker<'_>, shown: &Shown<'_>) {
    let mut known = BTreeSet::new();
    for _ in 0..2 * EACH {
        // Things that appear one after the other, in random order; their first pixels in the same order as a clear view of them.
        let mut some: Vec<First<'_>> = Vec::new();
        for (thing, [any, clear]) in shown.some(asker, shown.unique.len()).into_iter().flatten() {
            let is_apart = some.iter().all(|(_, [a, c])| any != *a && clear != *c && (any < *a) == (clear < *c));
            if some.len() < CHOICES && is_apart {
                some.push((thing, [any, clear]));
            }
        }
        if some.len() < CHOICES {
            continue;
        }
        let mut in_order = some.clone();
        in_order.sort_by_key(|(_, first)| *first);
        let instances: BTreeSet<i16> = some.iter().map(|(thing, _)| thing.instance).collect();
        if known.len() >= EACH || !known.insert(instances) {
            continue;
        }
        let names = |list: &[First<'_>]| list.iter().map(|(thing, _)| thing.noun.clone()).collect::<Vec<_>>().join(", ");
        let right = names(&in_order);
        let mut wrong = BTreeSet::new();
        while wrong.len() < CHOICES - 1 {
            let mut other = in_order.clone();
            asker.shuffle(&mut other);
            wrong.extend(Some(names(&other)).filter(|other| *other != right));
        }
        let question = format!("In which order do these first appear: {}?", names(&some));
        let instances: Vec<i16> = in_order.iter().map(|(thing, _)| thing.instance).collect();
        asker.ask(None, "obj_appearance_order", question, Answer::Choice { right, wrong: wrong.into_iter().collect() }, &instances);
    }
}
