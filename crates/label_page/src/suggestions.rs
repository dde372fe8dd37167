//! Labels that are proposed from the names of parts and materials.

use super::scene::AnnotatedScene;
use enfilade_dataset::Classes;
use enfilade_suggest::{PartNames, Suggester};
use serde::Serialize;

/// A proposed class.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Suggestion {
    /// NYU40.
    semantic: i16,
    /// Probability that it is right, in [0, 1].
    confidence: f32,
    /// Classes other than the first and their probabilities, the likeliest first.
    alternatives: Vec<(i16, f32)>,
}

/// A proposal for each part. Suggestions are classes of NYU40, so scenes with another list of classes get none.
pub fn suggestions(scene: &AnnotatedScene, classes: &Classes) -> Vec<Option<Suggestion>> {
    if !classes.are_nyu40() {
        return vec![None; scene.parts.len()];
    }
    let mut material_of = vec![None; scene.parts.len()];
    for (&part, &material) in scene.part_of_face.iter().zip(&scene.material_of_face) {
        material_of[part as usize].get_or_insert(material);
    }
    let suggester = Suggester::builtin();
    let suggest = |((part, around), material): ((&String, &String), Option<u32>)| {
        let material = material.and_then(|material| scene.materials.get(material as usize)).map_or("", String::as_str);
        // Where the parents are known, a path in the part's name adds nothing.
        let part = if around.is_empty() { part } else { part.rsplit('/').next().unwrap_or_default() };
        let found = suggester.suggest(&PartNames { part, material, group: around })?;
        Some(Suggestion { semantic: found.class, confidence: found.confidence, alternatives: found.alternatives })
    };
    scene.parts.iter().zip(&scene.around).zip(material_of).map(suggest).collect()
}
