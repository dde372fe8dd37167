//! Which parts of a material change together: those of classes that are made alike.
//!
//! A material that the ceiling and the walls share has two groups, so each gets a colour of its own. Parts of classes that do not vary
//! keep the material as it is.

use super::palette::{Made, made};
use crate::config::ColorRange;
use crate::sources::{area_m2, glows};
use enfilade_scene::{LabelledScene, NYU40, Part, PartId, Scene};
use std::collections::BTreeMap;

/// The classes that vary, with what they are made of and the ranges of their colours.
pub type Ranges = BTreeMap<&'static str, (Made, ColorRange)>;

/// What says that a material is wood.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wooden {
    /// Nothing.
    No,
    /// A brown texture: of sofas, curtains and rugs it is leather or cloth.
    Brown,
    /// The name of the material.
    Named,
}

/// Least share of the area of walls that is overhead where the ceiling is a part of them.
const CEILING_SHARE: f32 = 0.2;
/// Classes of cloth whose things may be of wood.
const CARVED: [&str; 2] = ["chair", "bed"];

/// Parts of one material that change together.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// What they are made of.
    pub made: Made,
    /// Class of most of their area.
    pub class: &'static str,
    /// Their area, square metres.
    pub area_m2: f32,
    /// Their numbers.
    pub parts: Vec<PartId>,
    /// Whether walls and ceiling are one part of them.
    pub has_ceiling: bool,
}

/// A material's parts by what becomes of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Users {
    /// Groups that may change, the largest first.
    pub groups: Vec<Group>,
    /// Whether parts of other classes use the material too.
    pub has_others: bool,
}

/// What keeps parts together: classes made alike and, where classes have ranges of their own, the class.
type Key = (Made, Option<&'static str>);

/// The classes of parts that have materials which do not glow, by name.
pub fn classes_there(scene: &LabelledScene) -> Vec<&'static str> {
    let there = (0..scene.scene.parts.len()).filter(|id| !glows(&scene.scene, *id as PartId));
    let mut names: Vec<_> = there.filter_map(|id| name_of(scene.labels.parts[id].semantic)).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// The users of each material that does not glow. Parts without a class go with the largest group of their material.
/// Furniture of one wood stays of one wood, whatever its classes; `by_class` keeps all classes apart.
pub fn users(scene: &LabelledScene, ranges: &Ranges, by_class: bool, wooden: &dyn Fn(u32) -> Wooden) -> BTreeMap<u32, Users> {
    let mut parts: BTreeMap<u32, Vec<PartId>> = BTreeMap::new();
    for (id, part) in scene.scene.parts.iter().enumerate() {
        if !glows(&scene.scene, id as PartId) {
            parts.entry(part.material).or_default().push(id as PartId);
        }
    }
    parts.into_iter().map(|(material, parts)| (material, of_parts(scene, ranges, by_class, wooden(material), &parts))).collect()
}

fn of_parts(scene: &LabelledScene, ranges: &Ranges, by_class: bool, wooden: Wooden, parts: &[PartId]) -> Users {
    let mut areas: BTreeMap<Key, BTreeMap<&'static str, (f32, Vec<PartId>)>> = BTreeMap::new();
    let (mut unknown, mut has_others) = (Vec::new(), false);
    for &id in parts {
        let Some(class) = name_of(scene.labels.parts[id as usize].semantic) else {
            unknown.push(id);
            continue;
        };
        if !ranges.contains_key(class) {
            has_others = true;
            continue;
        }
        let key = (alike(class, wooden), by_class.then_some(class));
        let (area, of_class) = areas.entry(key).or_default().entry(class).or_default();
        *area += area_m2(&scene.scene, &scene.scene.parts[id as usize]);
        of_class.push(id);
    }
    let mut groups: Vec<Group> = areas.into_iter().filter_map(|((made, _), classes)| group(made, wooden, classes)).collect();
    for group in groups.iter_mut().filter(|group| group.made == Made::Wall) {
        if overhead_m2(&scene.scene, &group.parts) >= CEILING_SHARE * group.area_m2 {
            (group.made, group.has_ceiling) = (Made::Ceiling, true);
        }
    }
    groups.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2));
    match groups.first_mut() {
        Some(largest) => largest.parts.extend(unknown),
        None => has_others |= !unknown.is_empty(),
    }
    Users { groups, has_others }
}

fn group(made: Made, wooden: Wooden, classes: BTreeMap<&'static str, (f32, Vec<PartId>)>) -> Option<Group> {
    let area_m2 = classes.values().map(|(area, _)| area).sum();
    let (class, _) = classes.iter().max_by(|a, b| a.1.0.total_cmp(&b.1.0).then(b.0.cmp(a.0)))?;
    let class = *class;
    // Planks of a floor, boards of a wall.
    let is_boards = wooden != Wooden::No && matches!(made, Made::Wall | Made::Ceiling | Made::Floor | Made::Door);
    let made = if is_boards { Made::Wood } else { made };
    let mut parts: Vec<PartId> = classes.into_values().flat_map(|(_, parts)| parts).collect();
    parts.sort_unstable();
    Some(Group { made, class, area_m2, parts, has_ceiling: false })
}

/// Area of the level surfaces in the upper quarter of some parts, square metres.
fn overhead_m2(scene: &Scene, parts: &[PartId]) -> f32 {
    let parts: Vec<&Part> = parts.iter().map(|part| &scene.parts[*part as usize]).collect();
    let heights = parts.iter().flat_map(|part| scene.world_positions(part)).map(|p| p.z);
    let (low, high) = heights.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), z| (low.min(z), high.max(z)));
    let overhead = low + 0.75 * (high - low);
    let corners = parts.iter().flat_map(|part| {
        let triangles = 0..scene.meshes[part.mesh as usize].triangles.len();
        triangles.map(|triangle| scene.world_corners(part, triangle))
    });
    let areas = corners.map(|[a, b, c]| {
        let n = 0.5 * (b - a).cross(c - a);
        let is_level = n.z.abs() > 0.9 * n.length() && a.z.min(b.z).min(c.z) > overhead;
        if is_level { n.length() } else { 0.0 }
    });
    areas.sum()
}

/// What parts of a class are made of; walls, ceilings, floors and doors of wood are not yet told from others.
fn alike(class: &str, wooden: Wooden) -> Made {
    match made(class) {
        Made::Cloth if wooden == Wooden::Brown && !CARVED.contains(&class) => Made::Cloth,
        Made::Joinery | Made::Cloth | Made::Thing if wooden != Wooden::No => Made::Wood,
        made => made,
    }
}

fn name_of(class: i16) -> Option<&'static str> {
    usize::try_from(class - 1).ok().and_then(|at| NYU40.get(at)).map(|class| class.name)
}
