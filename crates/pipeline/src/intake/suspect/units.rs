//! Whether sizes are plausible for rooms and furniture in metres, and which unit would make them so.

use super::names::Named;
use super::room;
use super::things::things;
use crate::intake::seen::Look;
use enfilade_math::{DVec3, quantile};
use enfilade_scene::Scene;
use std::ops::RangeInclusive;

/// Units that files have, and what they are called.
pub(in crate::intake) const UNITS: [(f64, &str); 8] = [
    (0.001, "millimetres"),
    (0.01, "centimetres"),
    (0.0254, "inches"),
    (0.1, "decimetres"),
    (0.3048, "feet"),
    (10.0, "tens of metres"),
    (100.0, "metres, if its exporter took centimetres for its unit"),
    (1000.0, "metres, if its exporter took millimetres for its unit"),
];
/// Heights of rooms, metres: of dwellings and offices (the International Residential Code, R305, requires 2.13 m), and of everything from
/// what people can stand in to halls.
const USUAL_M: RangeInclusive<f64> = 2.0..=4.5;
const POSSIBLE_M: RangeInclusive<f64> = 1.8..=30.0;
/// Weights of a room that certainly is one, and of all other evidence: exporters join meshes of one name or material over several storeys
/// to one thing that is as high as these.
const SURE: u32 = 4;
const LIKELY: u32 = 1;
/// Total weight of merely unusual sizes that is enough if no size is usual.
const UNUSUAL: u32 = 6;

/// The judgement from sizes.
pub(in crate::intake) enum Sizes {
    /// Nothing is known by name, or the evidence is contradictory.
    Unknown,
    /// The sizes are plausible for rooms or furniture.
    Fit,
    /// The sizes are not plausible.
    Suspect(Suspicion),
}

/// A unit that seems to be another.
pub(in crate::intake) struct Suspicion {
    /// Factor for the sizes.
    pub factor: f64,
    /// Name of the file's unit then, if it is a common one.
    pub name: Option<&'static str>,
    /// Whether there is more evidence than a hollow that may be a room.
    pub is_sure: bool,
    /// The things that are too large or too small, in words.
    pub because: Vec<String>,
    /// Their sizes with the factor.
    pub then: Vec<String>,
}

/// A size and what it should be.
struct Evidence {
    /// The thing with this size: "the chair is" or "rooms are".
    subject: String,
    size_m: f64,
    usual_m: RangeInclusive<f64>,
    possible_m: RangeInclusive<f64>,
    weight: u32,
    /// Whether it is sufficient evidence that things are too small.
    tells_small: bool,
}

impl Evidence {
    fn fits(&self, factor: f64) -> bool {
        self.usual_m.contains(&(self.size_m * factor))
    }

    fn is_large(&self) -> bool {
        self.size_m > *self.usual_m.end()
    }

    fn is_small(&self) -> bool {
        self.size_m < *self.usual_m.start()
    }

    /// Whether there is no such thing.
    fn is_impossible(&self) -> bool {
        self.size_m > *self.possible_m.end() || (self.tells_small && self.size_m < *self.possible_m.start())
    }

    /// Factor to the middle of the usual range.
    fn ratio(&self) -> f64 {
        (self.usual_m.start() * self.usual_m.end()).sqrt() / self.size_m
    }

    fn words(&self, factor: f64) -> String {
        format!("{} {} m high", self.subject, metres(self.size_m * factor))
    }
}

/// Weighs the sizes of rooms and things along `up`.
pub(in crate::intake) fn judge(scene: &Scene, look: &Look, named: &Named, up: DVec3) -> Sizes {
    let of_room = room::height(scene, look, named, up).map(|room| Evidence {
        subject: "rooms are".into(),
        size_m: room.height_m,
        usual_m: USUAL_M,
        possible_m: POSSIBLE_M,
        weight: if room.is_sure { SURE } else { LIKELY },
        tells_small: room.is_sure,
    });
    let of_things = things(scene, look, named, up).into_iter().map(|thing| Evidence {
        subject: format!("the {} is", thing.kind.name),
        size_m: thing.height_m,
        usual_m: thing.kind.usual_m.clone(),
        possible_m: thing.kind.possible_m.clone(),
        weight: LIKELY,
        tells_small: true,
    });
    weigh(&of_room.into_iter().chain(of_things).collect::<Vec<_>>())
}

fn weigh(evidence: &[Evidence]) -> Sizes {
    let sum = |holds: &dyn Fn(&Evidence) -> bool| evidence.iter().filter(|e| holds(e)).map(|e| e.weight).sum::<u32>();
    let fitting = sum(&|e| e.fits(1.0));
    for is_off in [Evidence::is_large as fn(&Evidence) -> bool, Evidence::is_small] {
        let off: Vec<&Evidence> = evidence.iter().filter(|e| is_off(e)).collect();
        let weight = sum(&is_off);
        let by_one = off.iter().any(|e| e.is_impossible()) && weight > fitting;
        let by_many = fitting == 0 && weight >= UNUSUAL && off.len() > 1;
        if by_one || by_many {
            return Sizes::Suspect(suspicion(&off));
        }
    }
    if fitting > 0 { Sizes::Fit } else { Sizes::Unknown }
}

/// The unit that makes most of what is off as it should be, a usual one if there is one.
fn suspicion(off: &[&Evidence]) -> Suspicion {
    let fitting = |factor: f64| off.iter().filter(|e| e.fits(factor)).map(|e| e.weight).sum::<u32>();
    let middle = quantile(&mut off.iter().map(|e| e.ratio().ln()).collect::<Vec<f64>>(), 0.5).unwrap_or(0.0).exp();
    let best = UNITS.into_iter().filter(|(factor, _)| fitting(*factor) > 0).max_by(|(a, _), (b, _)| {
        let apart = |factor: &f64| (factor / middle).ln().abs();
        fitting(*a).cmp(&fitting(*b)).then(apart(b).total_cmp(&apart(a)))
    });
    let all: u32 = off.iter().map(|e| e.weight).sum();
    let usual = best.filter(|(factor, _)| 2 * fitting(*factor) > all);
    let (factor, name) = usual.map_or((one_digit(middle), None), |(factor, name)| (factor, Some(name)));
    let words = |factor: f64| off.iter().map(|e| e.words(factor)).collect::<Vec<_>>();
    Suspicion { factor, name, is_sure: off.iter().any(|e| e.tells_small), because: words(1.0), then: words(factor) }
}

/// A number to one significant digit: nothing more is known.
fn one_digit(number: f64) -> f64 {
    format!("{number:.0e}").parse().unwrap_or(number)
}

/// A length to two digits behind the point, or, where it is below a centimetre, to two significant ones.
fn metres(length: f64) -> String {
    if length >= 0.01 { format!("{length:.2}") } else { format!("{length:.1e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn evidence(size_m: f64, usual_m: RangeInclusive<f64>, possible_m: RangeInclusive<f64>, weight: u32) -> Evidence {
        Evidence { subject: "it is".into(), size_m, usual_m, possible_m, weight, tells_small: true }
    }

    fn room(height_m: f64) -> Evidence {
        evidence(height_m, USUAL_M, POSSIBLE_M, SURE)
    }

    fn chair(height_m: f64) -> Evidence {
        evidence(height_m, 0.55..=1.35, 0.3..=2.0, LIKELY)
    }

    fn proposed(evidence: &[Evidence]) -> Option<f64> {
        match weigh(evidence) {
            Sizes::Suspect(suspicion) => Some(suspicion.factor),
            _ => None,
        }
    }

    #[test]
    fn every_usual_unit_is_proposed_for_a_room_of_it() {
        // A room of 2.6 m with a chair of 0.9 m, as a file in the unit has it.
        for (unit, _) in UNITS {
            assert_eq!(proposed(&[room(2.6 / unit), chair(0.9 / unit)]), Some(unit));
        }
        assert_eq!(proposed(&[room(1.3), chair(0.45)]), Some(2.0));
        assert_eq!(proposed(&[room(1.3)]), Some(2.0));
        assert!(matches!(weigh(&[room(2.6), chair(0.9)]), Sizes::Fit) && matches!(weigh(&[]), Sizes::Unknown));
    }

    #[test]
    fn halls_and_single_odd_things_are_no_reason() {
        assert_eq!(proposed(&[room(11.0)]), None);
        assert_eq!(proposed(&[room(11.0), chair(0.9)]), None);
        // Furniture of a building of three storeys, each kind in one mesh.
        assert_eq!(proposed(&[room(2.6), chair(7.0), chair(7.0), chair(7.5)]), None);
        // A sculpture that is called a chair, in a room.
        assert_eq!(proposed(&[room(2.6), chair(12.8)]), None);
        assert_eq!(proposed(&[chair(12.8)]), Some(0.1));
        assert_eq!(proposed(&[chair(0.9)]), None);
    }
}
