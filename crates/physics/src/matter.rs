//! Densities: by words in the names of materials, else by class, else that of wood.

use enfilade_scene::{Labels, NYU40, PartId, Scene};

/// Of what nothing is known, kg/m³: wood, as in the simulation of `[[object]]`.
const UNKNOWN: f64 = 600.0;

/// Words in the name of a material, and the density, kg/m³; the first row with a word that occurs holds. Solid things that are mostly air, such as
/// cushions and leaves, have the density of the whole.
pub(crate) const BY_MATERIAL: [(&[&str], f64); 12] = [
    (&["cushion", "sofa cloth", "armchair cloth", "boucle", "foam", "mattress", "pillow", "duvet"], 40.0),
    (&["cloth", "linen", "wool", "cotton", "fabric", "textile", "knit", "curtain", "towel", "carpet"], 200.0),
    (&["leaf", "petal", "fruit", "soil", "wicker", "rattan", "basket"], 400.0),
    (&["cork"], 240.0),
    (&["aluminium", "aluminum"], 2700.0),
    (&["steel", "chrome", "brass", "iron", "metal", "copper", "powder coat"], 7800.0),
    (&["glass", "mirror", "lamp"], 2500.0),
    (&["ceramic", "porcelain", "tile", "terrazzo", "stone", "marble", "granite", "concrete", "screed", "brick"], 2400.0),
    (&["plaster", "wall paint", "ceiling paint"], 1200.0),
    (&["plastic", "rubber", "wax", "screen", "leather"], 1000.0),
    (&["paper", "book", "cover", "painting", "print"], 700.0),
    (&["wood", "oak", "pine", "walnut", "beech", "ash", "birch", "veneer", "plank", "floor", "bark", "front"], 600.0),
];

/// Classes, and the density, kg/m³, of their parts whose materials tell nothing.
pub(crate) const BY_CLASS: [(&[&str], f64); 6] = [
    (&["wall", "floor", "ceiling"], 2000.0),
    (&["pillow", "bed", "sofa"], 60.0),
    (&["clothes", "towel", "curtain", "floormat", "showercurtain", "blinds"], 200.0),
    (&["toilet", "sink", "bathtub"], 2400.0),
    (&["window", "mirror"], 2500.0),
    (&["books", "paper", "picture"], 700.0),
];

/// The density of a part, kg/m³.
pub(crate) fn density(scene: &Scene, labels: &Labels, part: PartId) -> f64 {
    let material = scene.materials[scene.parts[part as usize].material as usize].name.to_lowercase();
    let by_material = BY_MATERIAL.iter().find(|(words, _)| words.iter().any(|word| material.contains(word)));
    let class = labels.parts.get(part as usize).and_then(|label| NYU40.get(usize::try_from(label.semantic - 1).ok()?));
    let by_class = || BY_CLASS.iter().find(|(names, _)| class.is_some_and(|class| names.contains(&class.name)));
    by_material.or_else(by_class).map_or(UNKNOWN, |(_, density)| *density)
}
