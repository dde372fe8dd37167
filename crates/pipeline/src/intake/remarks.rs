//! The findings of an inspection of a scene, in sentences that name the key for repairs.

use super::doubled;
use super::labels::labels_by_part;
use super::seen::Look;
use super::suspect::{self, Sizes, UNITS};
use crate::config::FileSource;
use enfilade_dataset::counted;
use enfilade_import::Imported;
use enfilade_label::doubts;
use enfilade_scene::{Alpha, PartId, Scene};
use std::fmt::Write;
use std::ops::RangeInclusive;

/// Longest sides of what may be a room or a building, metres; beyond them the unit is probably another.
const BUILDINGS_M: RangeInclusive<f32> = 1.0..=200.0;
/// Longest sides of what mostly is a room or a flat, metres: a unit that leads there is proposed.
const ROOMS_M: RangeInclusive<f32> = 2.0..=60.0;
/// Common areas below this are a matter of contact, square metres.
const LEAST_OVERLAP_M2: f64 = 0.01;
/// Floors without a ceiling are reported from this area on, square metres, and from this share of all floors.
const LEAST_OPEN_M2: f64 = 2.0;
const LEAST_OPEN_SHARE: f64 = 0.2;
/// Share of what is seen in rooms that may be backs: sheets have two sides.
const BACKS_SHARE: f64 = 0.3;
/// Share of the ground plan that rooms have at least; smaller hollows are the insides of things.
const LEAST_ROOMS_SHARE: f64 = 0.2;
/// Number of names listed in place of all.
const NAMED: usize = 3;

/// About the geometry, most important first.
pub(super) fn of_geometry(source: &FileSource, imported: &Imported, look: &Look) -> Vec<String> {
    let (scene, suspicions) = (&imported.scene, suspect::judge(source, imported, look));
    let unit = match (suspicions.sizes, unit(source, look)) {
        (Sizes::Fit, _) => None,
        // A cup is no building.
        (Sizes::Unknown, Some(_)) if suspicions.is_thing && look.world.bounds.extent().max_element() < *BUILDINGS_M.start() => None,
        (Sizes::Suspect(suspicion), by_length) if suspicion.is_sure || by_length.is_none() => {
            Some(suspect::of_unit(source, imported.report.format, &suspicion))
        }
        (_, by_length) => by_length,
    };
    // Rooms are found by their heights in metres along z.
    let rooms_are_known = unit.is_none() && suspicions.axes.is_none();
    let [open_floor, backs] = if rooms_are_known { [open_floor(look), backs(scene, look)] } else { [None, None] };
    let found = [suspicions.axes, unit, open_floor, doubled::remark(source, scene, look), overlapping(scene, look), backs];
    found.into_iter().flatten().chain(invisible(scene)).chain(without_area(scene, look)).collect()
}

/// Doubts about the instances that the file itself defines.
pub(super) fn of_labels(imported: &Imported) -> Vec<String> {
    let Some(labels) = &imported.labels else { return Vec::new() };
    doubts(&imported.scene, &labels_by_part(&imported.scene, labels)).remarks(&imported.scene)
}

/// The remark that a scene has no light; `None` if it has.
pub(super) fn of_light(scene: &Scene) -> Option<String> {
    (!has_light(scene)).then(|| {
        "nothing in it shines, so every picture would be black; light it by environment = \"sky\" or \"overcast\" (or --environment sky), \
         which comes in through windows, or by lamps = \"ceiling\" (or --lamps ceiling) in every room"
            .into()
    })
}

/// Whether anything of a scene shines.
pub(crate) fn has_light(scene: &Scene) -> bool {
    let shines = |part: &enfilade_scene::Part| !scene.materials[part.material as usize].emission.factor.is_black();
    scene.environment.is_some() || !scene.lights.is_empty() || scene.parts.iter().any(shines)
}

fn unit(source: &FileSource, look: &Look) -> Option<String> {
    let size = look.world.bounds.extent();
    let longest = size.max_element();
    let [_, others] = look.largest_and_others();
    let is_building = |longest: f32| BUILDINGS_M.contains(&longest);
    if look.world.bounds.is_empty() || is_building(longest) || (!others.is_empty() && is_building(others.extent().max_element())) {
        return None;
    }
    let stated = source.meters_per_unit;
    let mut text = format!("it is {longest:.2} m long; if it is a room, its unit is another");
    let fits = |(factor, _): &&(f64, &str)| ROOMS_M.contains(&((longest as f64 * factor / stated) as f32));
    let proposals: Vec<String> = UNITS.iter().filter(fits).map(|(factor, name)| proposal(size.to_array(), *factor, stated, name)).collect();
    if proposals.is_empty() {
        text.push_str(": state it by meters_per_unit (or --meters-per-unit)");
    } else {
        let _ = write!(text, ". {}", proposals.join("; "));
    }
    Some(text)
}

fn proposal(size: [f32; 3], factor: f64, stated: f64, name: &str) -> String {
    let [x, y, z] = size.map(|side| f64::from(side) * factor / stated);
    format!("meters_per_unit = {factor} (or --meters-per-unit {factor}), for a file in {name}, makes it {x:.1} x {y:.1} x {z:.1} m")
}

fn open_floor(look: &Look) -> Option<String> {
    let open_m2 = look.findings.open_floor_m2;
    let covered_m2: f64 = look.findings.ceilings.iter().map(enfilade_explore::Ceiling::area_m2).sum();
    let share = open_m2 / (open_m2 + covered_m2).max(f64::MIN_POSITIVE);
    (open_m2 >= LEAST_OPEN_M2 && share >= LEAST_OPEN_SHARE).then(|| {
        format!(
            "{:.0} % of its floors, {open_m2:.0} m2, have walls around them and no ceiling above; light comes in from there \
             (environment = \"overcast\" is even), and views may look out: max_open_share and max_void_share of [plan] say how many may",
            100.0 * share
        )
    })
}

fn overlapping(scene: &Scene, look: &Look) -> Option<String> {
    let large: Vec<_> = look.findings.overlapping.iter().filter(|overlap| overlap.area_m2 >= LEAST_OVERLAP_M2).collect();
    let total_m2: f64 = large.iter().map(|overlap| overlap.area_m2).sum();
    let name = |part: PartId| &scene.parts[part as usize].name;
    let pairs = large.iter().take(NAMED).map(|overlap| match overlap.parts {
        [a, b] if a == b => format!("{:?} with itself", name(a)),
        [a, b] => format!("{:?} and {:?}", name(a), name(b)),
    });
    (!large.is_empty()).then(|| {
        format!(
            "surfaces lie in each other over about {total_m2:.2} m2 ({}{}), so rounding decides which is seen, in spots; move one of them \
             by a millimetre",
            pairs.collect::<Vec<_>>().join(", "),
            and_more(large.len())
        )
    })
}

fn backs(scene: &Scene, look: &Look) -> Option<String> {
    let plan = look.bounds_of_building().extent();
    let rooms_m2: f64 = look.findings.ceilings.iter().map(enfilade_explore::Ceiling::area_m2).sum();
    if rooms_m2 < LEAST_ROOMS_SHARE * f64::from(plan.x * plan.y) {
        return None;
    }
    let backs = look.findings.backs.as_ref().filter(|backs| backs.share >= BACKS_SHARE && !backs.parts.is_empty())?;
    let is_black = |part: &PartId| {
        let material = &scene.materials[scene.parts[*part as usize].material as usize];
        !material.two_sided && !material.bsdf.transmits()
    };
    let black: Vec<PartId> = backs.parts.iter().copied().filter(is_black).collect();
    let shown = if black.is_empty() { &backs.parts } else { &black };
    let percent = 100.0 * backs.share;
    let names = names(scene, shown);
    Some(if black.is_empty() {
        format!(
            "{percent:.0} % of what is seen in its rooms are backs of faces ({names}): shells whose fronts look outward. Pictures, depth and \
             normals are the same from both sides; the mesh files keep the file's order of corners"
        )
    } else {
        format!(
            "{percent:.0} % of what is seen in its rooms are backs of faces; {names} are black there, since their materials have one side: \
             in Mitsuba files put the bsdf into a \"twosided\" one, or turn the faces"
        )
    })
}

/// Parts that their opacity hides: helpers of an editor, or glass that its exporter made of nothing.
fn invisible(scene: &Scene) -> Option<String> {
    let is_invisible = |part: &PartId| match &scene.materials[scene.parts[*part as usize].material as usize].alpha {
        Alpha::Opaque => false,
        Alpha::Mask { opacity, cutoff } => opacity.factor < *cutoff,
        Alpha::Blend { opacity } => opacity.factor <= 0.0,
    };
    let parts: Vec<PartId> = (0..scene.parts.len() as PartId).filter(is_invisible).collect();
    (!parts.is_empty()).then(|| {
        let (verb, their) = if parts.len() == 1 { ("has", "its") } else { ("have", "their") };
        format!(
            "{} {verb} no opacity and cannot be seen ({}); if that is glass, give {their} material transmission, or an opacity above zero",
            counted(parts.len(), "part"),
            names(scene, &parts)
        )
    })
}

fn without_area(scene: &Scene, look: &Look) -> Option<String> {
    let parts = &look.findings.without_area;
    (!parts.is_empty()).then(|| {
        let verb = if parts.len() == 1 { "has" } else { "have" };
        format!("{} {verb} no area and can never be seen ({}); their numbers stay", counted(parts.len(), "part"), names(scene, parts))
    })
}

fn names(scene: &Scene, parts: &[PartId]) -> String {
    let first: Vec<String> = parts.iter().take(NAMED).map(|part| format!("{:?}", scene.parts[*part as usize].name)).collect();
    first.join(", ") + &and_more(parts.len())
}

pub(super) fn and_more(count: usize) -> String {
    if count > NAMED { format!(" and {} more", count - NAMED) } else { String::new() }
}
