//! The obvious ways to compare with: looking whole names up, and searching them for the names of classes.

use enfilade_scene::NYU40;
use enfilade_suggest::Suggestion;
use enfilade_suggest::learn::{NameGroup, Split};
use std::collections::BTreeMap;

/// Every name's most frequent class in the scenes that are not held out; its confidence is the share of the names that have it, counted
/// with one more name that does not, so that frequent names come before those seen once.
pub fn lookup(groups: &[NameGroup], split: Split, folds: usize) -> Vec<Option<Suggestion>> {
    let mut found = vec![None; groups.len()];
    for fold in 0..folds {
        let mut tables: BTreeMap<&[String], BTreeMap<i16, f32>> = BTreeMap::new();
        for group in groups.iter().filter(|group| split.fold(&group.scene, folds) != fold && !group.words.is_empty()) {
            let labelled = group.labelled().max(1) as f32;
            for (&class, &n) in group.classes.range(1..) {
                *tables.entry(&group.words).or_default().entry(class).or_default() += n as f32 / labelled;
            }
        }
        for (i, group) in groups.iter().enumerate().filter(|(_, group)| split.fold(&group.scene, folds) == fold) {
            found[i] = tables.get(group.words.as_slice()).and_then(most_frequent);
        }
    }
    found
}

fn most_frequent(table: &BTreeMap<i16, f32>) -> Option<Suggestion> {
    let total: f32 = table.values().sum();
    let (&class, &n) = table.iter().max_by(|a, b| a.1.total_cmp(b.1).then(b.0.cmp(a.0)))?;
    Some(Suggestion { class, confidence: n / (total + 1.0), whole: None, alternatives: Vec::new() })
}

/// The class whose name is one of the words; the last such word counts.
pub fn keyword(groups: &[NameGroup]) -> Vec<Option<Suggestion>> {
    let class_of = |word: &String| NYU40.iter().find(|class| class.name.trim_end_matches('s') == word.trim_end_matches('s'));
    let of = |group: &NameGroup| group.words.iter().rev().find_map(class_of);
    groups
        .iter()
        .map(|group| of(group).map(|class| Suggestion { class: class.id, confidence: 1.0, whole: None, alternatives: Vec::new() }))
        .collect()
}
