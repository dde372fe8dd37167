//! Other colours and textures for the materials of some classes.
//!
//! The parts of a material change by groups of classes that are made alike: a paint that walls and ceiling share becomes two. What looks like
//! wood becomes another wood; metal, glass and mirrors stay as they are. Materials that are not divided keep their names and numbers.

mod groups;
mod mapping;
mod oklab;
mod palette;
mod recolor;
mod textures;

use crate::config::{ColorRange, MaterialVary};
use crate::draw::chance;
use crate::first::{First, VaryError};
use crate::names::free_name;
use enfilade_dataset::VariedMaterial;
use enfilade_furniture::{DecorConfig, LampLight, Materials};
use enfilade_math::{Rgb, Rng, hash_text};
use enfilade_options::closest;
use enfilade_scene::{Cx, LabelledScene, Material, NYU40, Scene, Warning};
use groups::{Group, Ranges, Users, Wooden, classes_there, users};
use mapping::Mapped;
use oklab::Oklch;
use palette::{CLASSES, draw, made};
use recolor::{Albedo, Recolored, base_colors, is_cut, recolor};
use std::collections::BTreeSet;
use textures::{Look, choose};

pub use recolor::{LEAST, MOST};

/// Words in the names of wooden materials.
const WOODEN: [&str; 14] =
    ["wood", "oak", "walnut", "parquet", "plank", "veneer", "timber", "pine", "cherry", "beech", "birch", "laminate", "teak", "mahogany"];
/// Words in the names of materials that keep their colours whatever they cover: what grows, and metals that files have as other things.
const KEPT: [&str; 12] = ["leaf", "leaves", "plant", "branch", "dirt", "soil", "steel", "chrome", "metal", "alumin", "brass", "mirror"];
/// Hues and chroma of wood: brown. Of textured materials alone, because brown paint is not wood.
const BROWN_DEG: [f32; 2] = [40.0, 95.0];
const BROWN_CHROMA: [f32; 2] = [0.03, 0.14];

/// Changes materials, each group of parts with numbers of its own, so that one does not depend on which others there are.
pub fn vary(
    scene: &mut LabelledScene,
    first: &First,
    config: &MaterialVary,
    rng: &Rng,
    cx: &dyn Cx,
) -> Result<Vec<VariedMaterial>, VaryError> {
    let ranges = ranges(config, first, &classes_there(scene), cx)?;
    let earlier = scene.scene.materials.clone();
    let wooden: Vec<Wooden> = earlier.iter().map(|material| wooden(material, &scene.scene)).collect();
    let materials = Materials::new(DecorConfig::default().palette(), LampLight::default(), rng.fork(hash_text("pictures")));
    let mut work = Work { config, ranges: &ranges, rng, wooden: &wooden, materials, mapped: Mapped::default(), varied: Vec::new() };
    for (index, users) in users(scene, &ranges, !config.classes.0.is_empty(), &|index| wooden[index as usize]) {
        users.groups.iter().filter(|group| group.has_ceiling).for_each(|group| tell_of_ceiling(&scene.scene, first, group, cx));
        work.vary(&mut scene.scene, index, &users);
    }
    let varied = work.varied;
    if varied.iter().any(|material| material.texture.is_some()) {
        scene.scene.remove_unused_meshes();
        scene.drop_pictures_of(&earlier);
    }
    Ok(varied)
}

/// What the changes of all materials have in common.
struct Work<'a> {
    config: &'a MaterialVary,
    ranges: &'a Ranges,
    rng: &'a Rng,
    /// By material.
    wooden: &'a [Wooden],
    /// Makes other textures, each picture once.
    materials: Materials,
    mapped: Mapped,
    varied: Vec<VariedMaterial>,
}

/// What a group of parts becomes.
struct Change {
    material: Material,
    look: Option<&'static Look>,
    colors: Recolored,
}

impl Work<'_> {
    /// Changes one material, by groups of its parts. The parts that stay as they are keep its number, else the largest group does.
    fn vary(&mut self, scene: &mut Scene, index: u32, users: &Users) {
        let before = scene.materials[index as usize].clone();
        let changes: Vec<Option<Change>> = users.groups.iter().map(|group| self.change(scene, &before, index, group)).collect();
        let mut is_free = !users.has_others && changes.iter().all(Option::is_some);
        for (group, change) in users.groups.iter().zip(changes) {
            let Some(Change { mut material, look, colors }) = change else { continue };
            if let Some(look) = look {
                group.parts.iter().for_each(|part| self.mapped.map(scene, *part, look.mapping));
            }
            let is_divided = !is_free;
            if is_divided {
                let taken: BTreeSet<&str> = scene.materials.iter().map(|known| known.name.as_str()).collect();
                material.name = free_name(&format!("{} {}", before.name, group.class), |name| taken.contains(name));
            }
            self.varied.push(VariedMaterial {
                name: material.name.clone(),
                of: is_divided.then(|| before.name.clone()),
                class: group.class.into(),
                from: colors.from.to_array(),
                to: colors.to.to_array(),
                texture: look.map(|look| look.name.into()),
            });
            if is_divided {
                group.parts.iter().for_each(|part| scene.parts[*part as usize].material = scene.materials.len() as u32);
                scene.materials.push(material);
            } else {
                scene.materials[index as usize] = material;
                is_free = false;
            }
        }
    }

    /// What a group becomes; `None` if it stays as it is.
    fn change(&mut self, scene: &mut Scene, before: &Material, index: u32, group: &Group) -> Option<Change> {
        let rng = self.rng.fork(hash_text(&format!("{}/{}", before.name, group.class)));
        let name = before.name.to_lowercase();
        let mut material = before.clone();
        let from = Albedo::of(base_colors(&mut material.bsdf).first()?, &scene.images, is_cut(before)).mean;
        if !chance(&mut rng.fork(0), self.config.share) || KEPT.iter().any(|word| name.contains(word)) {
            return None;
        }
        let wooden = self.wooden[index as usize];
        let takes = chance(&mut rng.fork(1), self.config.textures);
        let look = takes.then(|| choose(group, before, wooden, &mut rng.fork(2))).flatten();
        let range = &self.ranges.get(group.class)?.1;
        let made = look.map_or(group.made, |look| look.made(group.made));
        let target = draw(made, range, &mut rng.fork(3)).rgb();
        if let Some(look) = look {
            let other = look.material(scene, &mut self.materials, group.made, target, &rng.fork(4));
            (material.bsdf, material.normal_map) = (other.bsdf, other.normal_map);
        }
        let is_cut = is_cut(&material);
        let done: Vec<Rgb> =
            base_colors(&mut material.bsdf).into_iter().map(|param| recolor(param, &scene.images, is_cut, target).to).collect();
        Some(Change { material, look, colors: Recolored { from, to: *done.first()? } })
    }
}

/// Says that walls have the colours of ceilings because both are one part.
fn tell_of_ceiling(scene: &Scene, first: &First, group: &Group, cx: &dyn Cx) {
    let part = group.parts.first().map_or("", |part| scene.parts[*part as usize].name.as_str());
    let message = format!(
        "walls and ceiling are one part of it, such as {part:?}, so both get the colours of ceilings; make the ceiling a part of its own \
         in the file, and the walls vary as walls do"
    );
    cx.warn(Warning { place: first.name.into(), message });
}

/// What says that a material is wood.
fn wooden(material: &Material, scene: &Scene) -> Wooden {
    let name = material.name.to_lowercase();
    if WOODEN.iter().any(|word| name.contains(word)) {
        return Wooden::Named;
    }
    let mut bsdf = material.bsdf.clone();
    let is_brown = base_colors(&mut bsdf)
        .iter()
        .any(|param| param.texture.is_some() && is_brown(Albedo::of(param, &scene.images, is_cut(material)).mean));
    if is_brown { Wooden::Brown } else { Wooden::No }
}

fn is_brown(mean: Rgb) -> bool {
    let color = Oklch::of(mean);
    let within = |[low, high]: [f32; 2], v: f32| (low..=high).contains(&v);
    within(BROWN_DEG, color.hue_deg) && within(BROWN_CHROMA, color.chroma)
}

/// The classes that vary and their colours. Of classes that are named, those that the scene does not have are told.
fn ranges(config: &MaterialVary, first: &First, known: &[&str], cx: &dyn Cx) -> Result<Ranges, VaryError> {
    let given = &config.classes.0;
    if given.is_empty() {
        return Ok(CLASSES.iter().map(|(name, made)| (*name, (*made, ColorRange::default()))).collect());
    }
    let missing: Vec<&String> = given.keys().filter(|name| !known.contains(&name.as_str())).collect();
    let told = missing.first().map(|name| {
        let near = closest(name, known).map_or(String::new(), |near| format!("did you mean {near:?}? "));
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
