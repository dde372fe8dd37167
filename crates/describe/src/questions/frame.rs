//! Questions about a single frame, at most one of each kind.

use super::{Answer, Asker};
use crate::captions::Scope;
use crate::colors::NAMES;
use crate::seen::Sight;
use crate::words;
use enfilade_dataset::{DescribedInstance, RelationKind};
use std::collections::{BTreeMap, BTreeSet};

/// A thing is asked about when it covers this share of the image.
const ASKED: f64 = 3e-3;
/// The nearer of two things is nearer by this share and by this many metres, both at its nearest pixel and at its median one.
const NEARER: f32 = 0.2;
const NEARER_M: f32 = 0.3;
/// Least share of a thing's pixels that have its colour, if that is asked for. Another colour is a wrong answer below the next share.
const CLEARLY: f64 = 0.6;
const HARDLY: f64 = 0.05;
/// Colours that people take for each other.
const NEAR_COLORS: [[&str; 2]; 15] = [
    ["black", "grey"],
    ["grey", "white"],
    ["white", "beige"],
    ["grey", "beige"],
    ["beige", "brown"],
    ["beige", "yellow"],
    ["beige", "pink"],
    ["brown", "orange"],
    ["brown", "red"],
    ["brown", "black"],
    ["orange", "red"],
    ["orange", "yellow"],
    ["red", "pink"],
    ["pink", "purple"],
    ["purple", "blue"],
];
/// Wrong answers beside the right one.
const WRONG: usize = 3;

/// A thing with the words that mean it and no other.
type Meant<'a> = (&'a DescribedInstance, &'a Sight, String);

/// Asks about a frame.
pub fn of_frame(asker: &mut Asker<'_>, scope: &Scope<'_>) {
    let visible = scope.visible(ASKED);
    let mut meant: Vec<Meant<'_>> = visible.iter().filter_map(|&(thing, sight)| Some((thing, sight, scope.definite(thing)?))).collect();
    asker.shuffle(&mut meant);
    let frame = scope.seen.frame;
    standing(asker, scope, &meant, frame);
    color(asker, &meant, frame);
    nearer(asker, &meant, frame);
    sides(asker, &meant, frame);
    count(asker, scope, frame);
}

/// Asks what a thing is on or in. No wrong answer is true, not even indirectly, by way of other things.
fn standing(asker: &mut Asker<'_>, scope: &Scope<'_>, meant: &[Meant<'_>], frame: u32) {
    for (thing, _, name) in meant {
        let mut carrying = scope.relations_of(thing.instance).iter().filter(|r| matches!(r.kind, RelationKind::On | RelationKind::In));
        let (Some(relation), None) = (carrying.next(), carrying.next()) else { continue };
        let Some(right) = scope.object(relation).filter(|_| relation.object >= 1) else { continue };
        let under = carriers(scope, thing.instance);
        let others = meant.iter().filter(|(other, ..)| other.instance != thing.instance && !under.contains(&other.instance));
        let wrong: Vec<String> = others.map(|(_, _, name)| name.clone()).filter(|name| *name != right).take(WRONG).collect();
        if wrong.len() < WRONG {
            continue;
        }
        let are = words::are(&thing.noun);
        let question = format!("What {are} {name} {}?", relation.kind.name());
        asker.ask(Some(frame), "object_relation", question, Answer::Choice { right, wrong }, &[thing.instance, relation.object]);
        return;
    }
}

/// All instances that support an instance or contain it, also indirectly.
fn carriers(scope: &Scope<'_>, instance: i16) -> BTreeSet<i16> {
    let (mut found, mut stack) = (BTreeSet::new(), vec![instance]);
    while let Some(subject) = stack.pop() {
        let by = scope.relations_of(subject).iter().filter(|r| r.object >= 1);
        for relation in by.filter(|r| matches!(r.kind, RelationKind::On | RelationKind::In | RelationKind::HangsFrom)) {
            if found.insert(relation.object) {
                stack.push(relation.object);
            }
        }
    }
    found
}

/// The colour of a thing that has it in this frame too. Colours that some of it has are no wrong answers, nor are those that people mix up with it.
fn color(asker: &mut Asker<'_>, meant: &[Meant<'_>], frame: u32) {
    // "What colour is the blue sofa?" is no question.
    let is_plain = |thing: &DescribedInstance, name: &str| *name == format!("the {}", thing.noun);
    let mut plain = meant.iter().filter(|(thing, sight, name)| is_plain(thing, name) && sight.color_share(&thing.color) >= CLEARLY);
    if let Some((thing, sight, name)) = plain.next() {
        let is_near = |other: &str| NEAR_COLORS.iter().any(|pair| pair.contains(&other) && pair.contains(&thing.color.as_str()));
        let is_wrong = |other: &&&str| **other != thing.color && !is_near(other) && sight.color_share(other) < HARDLY;
        let mut wrong: Vec<String> = NAMES.iter().filter(is_wrong).map(ToString::to_string).collect();
        asker.shuffle(&mut wrong);
        wrong.truncate(WRONG);
        let are = words::are(&thing.noun);
        let answer = Answer::Choice { right: thing.color.clone(), wrong };
        asker.ask(Some(frame), "object_color", format!("What colour {are} {name}?"), answer, &[thing.instance]);
    }
}

/// The first two in the list of which something is true.
fn pair<'m>(meant: &'m [Meant<'m>], holds: impl Fn(&Sight, &Sight) -> bool) -> Option<[&'m Meant<'m>; 2]> {
    let pairs = meant.iter().flat_map(|a| meant.iter().map(move |b| [a, b]));
    pairs.into_iter().find(|[a, b]| a.0.instance != b.0.instance && holds(a.1, b.1))
}

fn nearer(asker: &mut Asker<'_>, meant: &[Meant<'_>], frame: u32) {
    let before = |a: f32, b: f32| a * (1.0 + NEARER) < b && a + NEARER_M < b;
    let Some([near, far]) = pair(meant, |a, b| before(a.nearest_m, b.nearest_m) && before(a.median_m, b.median_m)) else { return };
    let mut named = [near, far];
    asker.shuffle(&mut named);
    let question = format!("Which is nearer to the camera, {} or {}?", named[0].2, named[1].2);
    let right = usize::from(named[1].0.instance == near.0.instance);
    let answer = Answer::Ordered(named.map(|(_, _, name)| name.clone()).to_vec(), right);
    asker.ask(Some(frame), "camera_distance", question, answer, &[near.0.instance, far.0.instance]);
}

fn sides(asker: &mut Asker<'_>, meant: &[Meant<'_>], frame: u32) {
    let Some(mut named) = pair(meant, |a, b| a.columns[1] < b.columns[0]) else { return };
    let left = named[0].0.instance;
    asker.shuffle(&mut named);
    let [a, b] = named;
    let are = words::sentence(words::are(&a.0.noun));
    let question = format!("{are} {} to the left or to the right of {} in the picture?", a.2, b.2);
    let answer = Answer::Ordered(vec!["left".into(), "right".into()], usize::from(a.0.instance != left));
    asker.ask(Some(frame), "image_side", question, answer, &[a.0.instance, b.0.instance]);
}

/// Asks for the number of things of a name, if all of them are large enough to be counted.
fn count(asker: &mut Asker<'_>, scope: &Scope<'_>, frame: u32) {
    let mut by_noun: BTreeMap<&str, Vec<(i16, bool)>> = BTreeMap::new();
    for (thing, sight) in scope.visible(0.0).into_iter().filter(|(thing, _)| words::is_countable(&thing.noun)) {
        let clear = scope.seen.covers(sight, ASKED);
        by_noun.entry(&thing.noun).or_default().push((thing.instance, clear));
    }
    let is_alone = |noun: &str| words::is_alone(noun, by_noun.keys().copied());
    let counted = by_noun.iter().filter(|(noun, list)| list.len() >= 2 && list.iter().all(|(_, clear)| *clear) && is_alone(noun));
    let most = counted.max_by_key(|(_, list)| list.len());
    if let Some((noun, list)) = most {
        let question = format!("How many {} are in the picture?", words::plural(noun));
        let instances: Vec<i16> = list.iter().map(|(instance, _)| *instance).collect();
        asker.ask(Some(frame), "image_counting", question, Answer::Open(list.len().to_string()), &instances);
    }
}
