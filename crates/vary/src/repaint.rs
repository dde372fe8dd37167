//! Other emission for some parts, which may share their materials with others.

use crate::names::free_name;
use enfilade_math::Rgb;
use enfilade_scene::{Material, PartId, Scene};
use std::collections::{BTreeMap, BTreeSet};

/// Emission of a part, and the name of its material where that says something about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Paint {
    /// Factor of the emission.
    pub emission: Rgb,
    /// Another name for the material.
    pub name: Option<String>,
}

/// Gives parts another emission. Materials keep their numbers: where the parts of one differ afterwards, those like the first keep it, and
/// the others get new ones at the end.
pub fn repaint(scene: &mut Scene, paints: &BTreeMap<PartId, Paint>) {
    let mut users: BTreeMap<u32, Vec<PartId>> = BTreeMap::new();
    for (part, id) in scene.parts.iter().zip(0..) {
        users.entry(part.material).or_default().push(id);
    }
    let mut taken: BTreeSet<String> = scene.materials.iter().map(|material| material.name.clone()).collect();
    for (index, parts) in users {
        if parts.iter().all(|part| !paints.contains_key(part)) {
            continue;
        }
        let before = scene.materials[index as usize].clone();
        let mut made: Vec<(Material, u32)> = Vec::new();
        for part in parts {
            let painted = paints.get(&part).map_or_else(|| before.clone(), |paint| painted(&before, paint));
            let known = made.iter().find(|(material, _)| *material == painted).map(|(_, at)| *at);
            let at = known.unwrap_or_else(|| {
                let at = if made.is_empty() { index } else { scene.materials.len() as u32 };
                // The first of a material's successors may have its name.
                let is_taken = |name: &str| taken.contains(name) && !(made.is_empty() && name == before.name);
                let named = Material { name: free_name(&painted.name, is_taken), ..painted.clone() };
                taken.insert(named.name.clone());
                if made.is_empty() {
                    scene.materials[index as usize] = named;
                } else {
                    scene.materials.push(named);
                }
                made.push((painted, at));
                at
            });
            scene.parts[part as usize].material = at;
        }
    }
}

fn painted(before: &Material, paint: &Paint) -> Material {
    let mut material = before.clone();
    material.emission.factor = paint.emission;
    if let Some(name) = &paint.name {
        material.name.clone_from(name);
    }
    material
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::DAffine3;
    use enfilade_scene::Part;

    #[test]
    fn parts_that_differ_afterwards_get_materials_of_their_own_and_numbers_stay() {
        let part = |name: &str, material| Part { name: name.into(), object: None, mesh: 0, material, world_from_mesh: DAffine3::IDENTITY };
        let mut scene = Scene {
            parts: vec![part("a", 0), part("b", 1), part("c", 0), part("d", 0)],
            materials: vec![Material::emitter("bulb", Rgb::WHITE), Material::diffuse("oak", Rgb::splat(0.4))],
            ..Scene::default()
        };
        let paint = |v| Paint { emission: Rgb::splat(v), name: None };
        repaint(&mut scene, &[(0, paint(2.0)), (2, paint(0.0)), (3, paint(2.0))].into());
        assert_eq!(scene.parts.iter().map(|part| part.material).collect::<Vec<_>>(), [0, 1, 2, 0]);
        let of = |index: usize| (scene.materials[index].name.as_str(), scene.materials[index].emission.factor.r);
        assert_eq!([of(0), of(1), of(2)], [("bulb", 2.0), ("oak", 0.0), ("bulb 2", 0.0)]);
    }
}
