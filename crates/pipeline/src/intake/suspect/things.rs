//! Heights of things with recognised names.

use super::names::Named;
use crate::intake::seen::Look;
use enfilade_math::DVec3;
use enfilade_scene::Scene;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

/// Heights of a kind of thing, metres.
pub(super) struct Kind {
    /// NYU40 class.
    class: i16,
    /// In words.
    pub name: &'static str,
    /// Range of nearly all of them.
    pub usual_m: RangeInclusive<f64>,
    /// Range of everything ever built of this kind.
    pub possible_m: RangeInclusive<f64>,
    /// Whether a small one is evidence: true if things with only this name are neither pieces, such as a table's top, nor toys.
    tells_small: bool,
}

/// The table. It has heights, since exporters often join all chairs of a room to one mesh, whose width is meaningless. Usual ones follow
/// the furniture standards (EN 527-1 and EN 1729-1 for tables and seats, DIN 18101 for doors, EN 251 for bathtubs) with margins for
/// antiques and for furniture of children and bars; possible ones are about half as small and a third to two thirds larger.
pub(super) const KINDS: [Kind; 16] = [
    Kind { class: 8, name: "door", usual_m: 1.8..=2.8, possible_m: 0.3..=4.5, tells_small: false },
    Kind { class: 5, name: "chair", usual_m: 0.55..=1.35, possible_m: 0.3..=2.0, tells_small: true },
    Kind { class: 6, name: "sofa", usual_m: 0.5..=1.25, possible_m: 0.3..=2.0, tells_small: true },
    Kind { class: 7, name: "table", usual_m: 0.3..=1.2, possible_m: 0.18..=2.0, tells_small: false },
    Kind { class: 14, name: "desk", usual_m: 0.6..=1.5, possible_m: 0.4..=2.5, tells_small: false },
    Kind { class: 4, name: "bed", usual_m: 0.3..=1.8, possible_m: 0.1..=3.0, tells_small: false },
    Kind { class: 33, name: "toilet", usual_m: 0.35..=1.1, possible_m: 0.2..=2.0, tells_small: true },
    Kind { class: 36, name: "bathtub", usual_m: 0.35..=0.9, possible_m: 0.2..=1.6, tells_small: true },
    Kind { class: 24, name: "refrigerator", usual_m: 0.8..=2.2, possible_m: 0.45..=3.2, tells_small: true },
    Kind { class: 3, name: "cabinet", usual_m: 0.2..=3.0, possible_m: 0.1..=4.5, tells_small: false },
    Kind { class: 10, name: "bookshelf", usual_m: 0.2..=3.2, possible_m: 0.1..=5.0, tells_small: false },
    Kind { class: 12, name: "counter", usual_m: 0.3..=1.4, possible_m: 0.1..=2.7, tells_small: false },
    Kind { class: 17, name: "dresser", usual_m: 0.4..=1.8, possible_m: 0.2..=2.7, tells_small: false },
    Kind { class: 32, name: "nightstand", usual_m: 0.25..=1.0, possible_m: 0.1..=1.7, tells_small: false },
    Kind { class: 25, name: "television", usual_m: 0.2..=1.3, possible_m: 0.1..=2.5, tells_small: false },
    Kind { class: 31, name: "person", usual_m: 0.8..=2.1, possible_m: 0.3..=2.7, tells_small: false },
];

/// The highest thing of a kind.
pub(super) struct Thing {
    pub kind: &'static Kind,
    pub height_m: f64,
}

/// Finds the highest thing of every kind in the table; lower ones than usual only if that is evidence. An object with such a name is one
/// thing, else a part is.
pub(super) fn things(scene: &Scene, look: &Look, named: &Named, up: DVec3) -> Vec<Thing> {
    let kind_of = |class: Option<i16>| class.and_then(|class| KINDS.iter().position(|kind| kind.class == class));
    let object_of =
        |part: usize| scene.parts[part].object.map(|object| object as usize).filter(|object| kind_of(named.objects[*object]).is_some());
    let parts = scene.parts.len();
    let heights = heights(look, parts + scene.objects.len(), up, |part| object_of(part).map_or(part, |object| parts + object));
    let class = |thing: usize| if thing < parts { named.classes[thing] } else { named.objects[thing - parts] };
    let is_whole = |thing: usize| if thing < parts { named.is_whole[thing] } else { named.is_whole_object[thing - parts] };
    let mut highest: BTreeMap<usize, (f64, bool)> = BTreeMap::new();
    for (thing, height_m) in heights.iter().enumerate().filter(|(_, height)| **height > 0.0) {
        let Some(kind) = kind_of(class(thing)) else { continue };
        let entry = highest.entry(kind).or_insert((0.0, false));
        *entry = (entry.0.max(*height_m), entry.1 || is_whole(thing));
    }
    if let Some(kind) = kind_of(named.of_file) {
        highest.insert(kind, (extent_m(look, up), true));
    }
    let thing = |(kind, (height_m, is_whole)): (usize, (f64, bool))| {
        let kind = &KINDS[kind];
        (height_m >= *kind.usual_m.start() || (kind.tells_small && is_whole)).then_some(Thing { kind, height_m })
    };
    highest.into_iter().filter_map(thing).collect()
}

/// Extent along `up` of each of `count` things, metres; `thing_of` gives the thing that a part belongs to.
fn heights(look: &Look, count: usize, up: DVec3, thing_of: impl Fn(usize) -> usize) -> Vec<f64> {
    let mut ranges = vec![[f64::INFINITY, f64::NEG_INFINITY]; count];
    for (corners, source) in look.world.corners.iter().zip(&look.world.sources) {
        let range = &mut ranges[thing_of(source.part as usize)];
        for corner in corners {
            let height = corner.as_dvec3().dot(up);
            *range = [range[0].min(height), range[1].max(height)];
        }
    }
    ranges.into_iter().map(|[low, high]| (high - low).max(0.0)).collect()
}

/// Extent of the whole scene along `up`, metres.
fn extent_m(look: &Look, up: DVec3) -> f64 {
    look.world.bounds.extent().as_dvec3().dot(up).abs()
}
