//! Labels that are proposed from the names of parts and materials.

use super::source::Source;
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
    /// Other classes and their probabilities, the likeliest first.
    alternatives: Vec<(i16, f32)>,
}

/// What is proposed for each part. Suggestions speak NYU40, so another list of classes gets none.
pub fn suggestions(source: &Source, classes: &Classes) -> Vec<Option<Suggestion>> {
    if !classes.are_nyu40() {
        return vec![None; source.parts.len()];
    }
    let mut material_of = vec![None; source.parts.len()];
    for (&part, &material) in source.part_of_face.iter().zip(&source.material_of_face) {
        material_of[part as usize].get_or_insert(material);
    }
    let suggester = Suggester::builtin();
    let suggest = |(part, material): (&String, Option<u32>)| {
        let material = material.and_then(|material| source.materials.get(material as usize)).map_or("", String::as_str);
        let found = suggester.suggest(&PartNames { part, material, ..PartNames::default() })?;
        Some(Suggestion { semantic: found.class, confidence: found.confidence, alternatives: found.alternatives })
    };
    source.parts.iter().zip(material_of).map(suggest).collect()
}
