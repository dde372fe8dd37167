//! Other colours for the materials of some classes.
//!
//! A material belongs to the class that has most of its area. What looks like wood becomes another wood; metal, glass and mirrors stay as
//! they are. Materials keep their names, numbers and textures.

mod oklab;
mod palette;
mod recolor;

use crate::config::{ColorRange, MaterialVary};
use crate::draw::chance;
use crate::first::{First, VaryError};
use crate::sources::{area_m2, glows};
use enfilade_dataset::VariedMaterial;
use enfilade_math::{Rgb, Rng, hash_text};
use enfilade_options::closest;
use enfilade_scene::{Cx, LabelledScene, NYU40, PartId, Warning};
use oklab::Oklch;
use palette::{CLASSES, draw, made};
use recolor::{Albedo, base_colors, recolor};
use std::collections::BTreeMap;

pub use recolor::{LEAST, MOST};

/// Words in the names of wooden materials.
const WOODEN: [&str; 14] =
    ["wood", "oak", "walnut", "parquet", "plank", "veneer", "timber", "pine", "cherry", "beech", "birch", "laminate", "teak", "mahogany"];
/// Words in the names of materials that keep their colours whatever they cover: what grows, and metals that files have as other things.
const KEPT: [&str; 12] = ["leaf", "leaves", "plant", "branch", "dirt", "soil", "steel", "chrome", "metal", "alumin", "brass", "mirror"];
/// Share of a material's area at the ceiling from which on it is the ceiling's, whatever else it covers.
const CEILING_SHARE: f32 = 0.2;
/// Least share of a material's area that is of classes made like the one that has most.
const ALIKE_SHARE: f32 = 0.8;
/// Hues and chroma of wood: brown. Of textured materials alone, because brown paint is not wood.
const BROWN_DEG: [f32; 2] = [40.0, 95.0];
const BROWN_CHROMA: [f32; 2] = [0.03, 0.14];

/// Recolours materials, each with numbers of its own, so that one does not depend on which others there are.
pub fn vary(
    scene: &mut LabelledScene,
    first: &First,
    config: &MaterialVary,
    rng: &Rng,
    cx: &dyn Cx,
) -> Result<Vec<VariedMaterial>, VaryError> {
    let classes = classes_of_materials(scene);
    let ranges = ranges(config, first, &classes, cx)?;
    let mut varied = Vec::new();
    for (index, class) in classes {
        let Some((made, range)) = ranges.get(class) else { continue };
        let material = &mut scene.scene.materials[index as usize];
        let name = material.name.to_lowercase();
        let rng = &mut rng.fork(hash_text(&material.name));
        if !chance(rng, config.share) || KEPT.iter().any(|word| name.contains(word)) {
            continue;
        }
        let images = &scene.scene.images;
        let colors = base_colors(&mut material.bsdf);
        let mut change = None;
        for param in colors {
            let is_wood =
                WOODEN.iter().any(|word| name.contains(word)) || param.texture.is_some() && is_brown(Albedo::of(param, images).mean);
            let target = draw(*made, is_wood, range, &mut rng.clone()).rgb();
            let done = recolor(param, images, target);
            change.get_or_insert(done);
        }
        if let Some(change) = change {
            let (from, to) = (change.from.to_array(), change.to.to_array());
            varied.push(VariedMaterial { name: material.name.clone(), class: class.into(), from, to });
        }
    }
    Ok(varied)
}

fn is_brown(mean: Rgb) -> bool {
    let color = Oklch::of(mean);
    let within = |[low, high]: [f32; 2], v: f32| (low..=high).contains(&v);
    within(BROWN_DEG, color.hue_deg) && within(BROWN_CHROMA, color.chroma)
}

/// The class of each material, by the number of the material; without those that glow, and those of no class or several.
fn classes_of_materials(scene: &LabelledScene) -> BTreeMap<u32, &'static str> {
    let mut areas: BTreeMap<u32, BTreeMap<i16, f32>> = BTreeMap::new();
    for (id, part) in scene.scene.parts.iter().enumerate() {
        if !glows(&scene.scene, id as PartId) {
            let class = scene.labels.parts[id].semantic;
            *areas.entry(part.material).or_default().entry(class).or_default() += area_m2(&scene.scene, part);
        }
    }
    areas.iter().filter_map(|(material, areas)| Some((*material, class_of(areas)?))).collect()
}

/// The class of a material with these areas; `None` where too much of it is of classes that are made otherwise.
fn class_of(areas: &BTreeMap<i16, f32>) -> Option<&'static str> {
    let name = |class: i16| usize::try_from(class - 1).ok().and_then(|at| NYU40.get(at)).map(|class| class.name);
    let known: Vec<(&'static str, f32)> = areas.iter().filter_map(|(class, area)| Some((name(*class)?, *area))).collect();
    let all: f32 = known.iter().map(|(_, area)| area).sum();
    let ceiling = known.iter().find(|(class, area)| *class == "ceiling" && *area >= CEILING_SHARE * all);
    if let Some((class, _)) = ceiling {
        return Some(class);
    }
    let (class, _) = known.iter().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(a.0)))?;
    let is_listed = |class: &str| CLASSES.iter().any(|(known, _)| *known == class);
    let alike = |other: &str| other == *class || is_listed(other) && is_listed(class) && made(other) == made(class);
    let share: f32 = known.iter().filter(|(other, _)| alike(other)).map(|(_, area)| area).sum();
    (share >= ALIKE_SHARE * all).then_some(class)
}

type Ranges = BTreeMap<&'static str, (palette::Made, ColorRange)>;

/// The classes that vary and their colours. Of classes that are named, those that the scene does not have are told.
fn ranges(config: &MaterialVary, first: &First, there: &BTreeMap<u32, &'static str>, cx: &dyn Cx) -> Result<Ranges, VaryError> {
    let given = &config.classes.0;
    if given.is_empty() {
        return Ok(CLASSES.iter().map(|(name, made)| (*name, (*made, ColorRange::default()))).collect());
    }
    let mut known: Vec<&str> = there.values().copied().collect();
    known.sort_unstable();
    known.dedup();
    let missing: Vec<&String> = given.keys().filter(|name| !known.contains(&name.as_str())).collect();
    let told = missing.first().map(|name| {
        let near = closest(name, &known).map_or(String::new(), |near| format!("did you mean {near:?}? "));
        let has = if known.is_empty() { "it has no labels".to_string() } else { format!("its classes: {}", known.join(", ")) };
        format!("nothing in it has a material of the class {name:?}, which `materials` of [vary] names; {near}{has}")
    });
    match told {
        Some(message) if missing.len() == given.len() => Err(VaryError::NothingToVary { scene: first.name.into(), message }),
        Some(message) => {
            cx.warn(Warning { place: first.name.into(), message });
            Ok(named(config))
        }
        None => Ok(named(config)),
    }
}

fn named(config: &MaterialVary) -> Ranges {
    let row = |name: &'static str| Some((name, (made(name), config.classes.0.get(name)?.clone())));
    NYU40.iter().filter_map(|class| row(class.name)).collect()
}
