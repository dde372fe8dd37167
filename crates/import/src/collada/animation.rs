//! Animations: channels that give the transforms of nodes their numbers over time.
//!
//! All animations of a file run together, on their own clock. A channel names a transform by the id of its node and its own `sid`, and one of
//! its numbers by `.X`, `.Y`, `.Z`, `.ANGLE`, `(index)` or, in a matrix, `(column)(row)`, as other programs read it.

use super::curve::{Control, Curve, Segment};
use super::document::{Dae, Node, at, called, child, children, numbers, text, width};
use crate::assembly::Assembly;
use std::collections::HashMap;

/// Most moments of one channel.
const MOST_MOMENTS: usize = 200_000;

/// The channels of a file, by the transforms, and sources of weights, that they change.
#[derive(Default)]
pub(super) struct Animations {
    channels: HashMap<roxmltree::NodeId, Vec<Channel>>,
    count: usize,
}

/// Numbers of a transform over time.
pub(super) struct Channel {
    /// The number that it gives; `None` if it gives all.
    pub first: Option<usize>,
    pub curve: Curve,
}

impl Channel {
    /// Where a number of the transform is among those of the channel, if it is.
    pub(super) fn number_within(&self, number: usize) -> Option<usize> {
        match self.first {
            None => Some(number),
            Some(first) => (first == number).then_some(0),
        }
    }
}

/// The tangents of all numbers at a moment: the time of each, where it is stated, and its value.
type Tangents = Vec<(Option<f64>, f64)>;

/// What a channel changes.
struct Target<'d> {
    transform: Node<'d>,
    first: Option<usize>,
    /// How many numbers.
    width: usize,
}

impl Animations {
    /// Reads the animations of a file; what cannot be used is reported.
    pub(super) fn read(dae: &Dae, a: &mut Assembly) -> Self {
        let mut found = Self::default();
        let Some(library) = child(dae.root, "library_animations") else { return found };
        let channels = library.descendants().filter(|n| n.is_element() && n.tag_name().name() == "channel");
        for channel in channels {
            let address = channel.attribute("target").unwrap_or_default();
            let read = target(dae, address).and_then(|target| Ok((curve(dae, channel, target.width, a)?, target)));
            match read.and_then(|(curve, target)| found.add(curve, &target)) {
                Ok(()) => found.count += 1,
                Err(problem) => a.warn(format!("channel of {address:?}"), format!("{problem}; the channel was left out")),
            }
        }
        found
    }

    /// The channels that change a transform.
    pub(super) fn of(&self, transform: Node) -> &[Channel] {
        self.channels.get(&transform.id()).map_or(&[], Vec::as_slice)
    }

    /// Says what became of the animations.
    pub(super) fn report(&self, a: &mut Assembly) {
        if self.count == 0 {
            return;
        }
        let message = match a.drop_unused_bodies() {
            0 => "nothing that is seen moves by them; everything stays where the scene has it".into(),
            bodies => format!("{bodies} things move by {} channels (still = true leaves motion out)", self.count),
        };
        a.warn("library_animations", message);
    }

    fn add(&mut self, curve: Curve, target: &Target) -> Result<(), String> {
        let known = self.channels.entry(target.transform.id()).or_default();
        if known.iter().any(|other| other.first.is_none() || target.first.is_none() || other.first == target.first) {
            return Err("another one moves the same numbers".into());
        }
        known.push(Channel { first: target.first, curve });
        Ok(())
    }
}

/// What an address such as `door/rotateZ.ANGLE` means.
fn target<'d>(dae: &Dae<'d>, address: &str) -> Result<Target<'d>, String> {
    let none = || "it moves no transform of a node and no weight of a morph, and nothing else can be moved".to_string();
    let mut steps = address.split('/');
    let split = |step: &'_ str| step.find(['.', '(']).unwrap_or(step.len());
    let id = steps.next().ok_or_else(none)?;
    let (mut element, mut member) = match dae.by_id(id) {
        Some(element) => (element, ""),
        // A number of the element itself; ids may have dots.
        None => (dae.by_id(&id[..split(id)]).ok_or_else(none)?, &id[split(id)..]),
    };
    for step in steps {
        let end = split(step);
        member = &step[end..];
        let sid = &step[..end];
        element = element.descendants().find(|n| n.attribute("sid") == Some(sid)).ok_or_else(none)?;
    }
    // Weights of morphs are the numbers of a source.
    if element.tag_name().name() == "float_array" {
        element = element.parent_element().ok_or_else(none)?;
    }
    let is_of_morph = element.parent_element().is_some_and(|parent| parent.tag_name().name() == "morph");
    let weights = || array_of(dae, element, "float_array").filter(|_| is_of_morph).map(|array| numbers(array).0.len());
    let all = width(element.tag_name().name()).or_else(weights).filter(|all| *all > 0).ok_or_else(none)?;
    if member.is_empty() {
        return Ok(Target { transform: element, first: None, width: all });
    }
    let indices: Option<Vec<usize>> =
        member.strip_prefix('(').and_then(|m| m.strip_suffix(')')).and_then(|m| m.split(")(").map(|i| i.parse().ok()).collect());
    let number = match (member, indices.as_deref()) {
        (".X", _) => Some(0),
        (".Y", _) => Some(1),
        (".Z", _) => Some(2),
        (".ANGLE", _) => Some(3),
        (_, Some([index])) => Some(*index),
        (_, Some([column, row])) if all == 16 && *column < 4 => row.checked_mul(4).and_then(|at| at.checked_add(*column)),
        _ => None,
    };
    let first = number.filter(|&number| number < all);
    let problem = || format!("found {member:?}, expected .X, .Y, .Z, .ANGLE or a number of the {all} in brackets");
    Ok(Target { transform: element, first: Some(first.ok_or_else(problem)?), width: 1 })
}

/// The curve of a channel's sampler, of `width` numbers.
fn curve(dae: &Dae, channel: Node, width: usize, a: &mut Assembly) -> Result<Curve, String> {
    let sampler = channel.attribute("source").and_then(|url| dae.target(url)).ok_or("its sampler is not in the file")?;
    let source = |semantic: &str| {
        let input = children(sampler, "input").find(|input| input.attribute("semantic") == Some(semantic))?;
        dae.target(input.attribute("source")?)
    };
    let floats = |semantic: &str| -> Result<Option<Vec<f64>>, String> {
        let Some(array) = source(semantic).map(|source| array_of(dae, source, "float_array")) else { return Ok(None) };
        let (values, odd) = array.map_or((Vec::new(), 0), numbers);
        if odd > 0 { Err(format!("{odd} of the numbers of its {semantic} are not finite")) } else { Ok(Some(values)) }
    };
    let times_s = floats("INPUT")?.unwrap_or_default();
    let values = floats("OUTPUT")?.unwrap_or_default();
    let count = times_s.len();
    if count == 0 || count > MOST_MOMENTS || values.len() != count * width {
        return Err(format!("found {} numbers for {count} moments, expected {width} each, for 1 to {MOST_MOMENTS}", values.len()));
    }
    if let Some(at) = times_s.windows(2).position(|pair| pair[1] < pair[0]) {
        return Err(format!("moment {} ({} s) comes before the one ahead of it ({} s)", at + 1, times_s[at + 1], times_s[at]));
    }
    let words = source("INTERPOLATION").and_then(|source| array_of(dae, source, "Name_array")).map(text).unwrap_or_default();
    let kinds: Vec<&str> = words.split_ascii_whitespace().collect();
    let tangents = [floats("OUT_TANGENT")?, floats("IN_TANGENT")?];
    let values: Vec<Vec<f64>> = values.chunks_exact(width).map(<[f64]>::to_vec).collect();
    let mut segments = Vec::with_capacity(count.saturating_sub(1));
    for i in 0..count - 1 {
        let kind = kinds.get(i).copied().unwrap_or("LINEAR");
        segments.push(match kind {
            "STEP" => Segment::Step,
            "LINEAR" => Segment::Line,
            "BEZIER" | "HERMITE" => {
                let ends = [0, 1].map(|end| (times_s[i + end], values[i + end].as_slice()));
                let controls = [0, 1].map(|end| tangents[end].as_deref().and_then(|all| controls_at(all, i + end, count, width)));
                bezier(ends, controls, kind == "HERMITE").ok_or_else(|| format!("its tangents are not {width} pairs a moment"))?
            }
            other => {
                a.warn(called(sampler), format!("the interpolation {other} is not supported; lines were taken"));
                Segment::Line
            }
        });
    }
    Ok(Curve { times_s, values, segments })
}

/// The array that a source's values are in.
pub(super) fn array_of<'d>(dae: &Dae<'d>, source: Node<'d>, tag: &str) -> Option<Node<'d>> {
    let accessor = at(source, &["technique_common", "accessor"]);
    let named = accessor.and_then(|accessor| dae.target(accessor.attribute("source")?));
    named.filter(|array| array.tag_name().name() == tag).or_else(|| child(source, tag))
}

/// The tangents at a moment.
fn controls_at(all: &[f64], moment: usize, count: usize, width: usize) -> Option<Tangents> {
    let at = |stride: usize| all.get(moment * stride..(moment + 1) * stride);
    if all.len() == count * width * 2 {
        return Some(at(2 * width)?.chunks_exact(2).map(|pair| (Some(pair[0]), pair[1])).collect());
    }
    // Tangents of values alone are evenly spaced.
    (all.len() == count * width).then(|| at(width).map(|values| values.iter().map(|value| (None, *value)).collect()))?
}

/// The curve between two moments by its tangents at both.
fn bezier(ends: [(f64, &[f64]); 2], tangents: [Option<Tangents>; 2], is_hermite: bool) -> Option<Segment> {
    let [(from_s, from), (to_s, to)] = ends;
    let [out, into] = tangents;
    let third = (to_s - from_s) / 3.0;
    let control = |end_s: f64, end: f64, (time_s, value): (Option<f64>, f64), sign: f64| -> Control {
        let [time_s, value] = match (is_hermite, time_s) {
            (true, time_s) => [end_s + sign * time_s.map_or(third, |t| t / 3.0), end + sign * value / 3.0],
            (false, time_s) => [time_s.unwrap_or(end_s + sign * third), value],
        };
        [time_s.clamp(from_s, to_s), value]
    };
    let pairs = out?.into_iter().zip(into?).zip(from.iter().zip(to));
    let controls = pairs.map(|((out, into), (a, b))| [control(from_s, *a, out, 1.0), control(to_s, *b, into, -1.0)]);
    Some(Segment::Bezier(controls.collect()))
}
