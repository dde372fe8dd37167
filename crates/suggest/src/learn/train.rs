//! Multinomial logistic regression with an L1 penalty, so that few weights are left, by FTRL-Proximal.
//!
//! McMahan et al. 2013, "Ad Click Prediction: a View from the Trenches", algorithm 1, with several passes.

use super::groups::NameGroup;
use crate::features::features;
use crate::lexicon::Lexicon;
use crate::weights::{CLASSES, Weights, softmax};
use std::collections::{BTreeMap, BTreeSet};

/// Number of labelled groups of a class from which their names count more than the word list.
pub const FEW: usize = 5;

/// How weights are learned. The defaults did best on held-out scenes.
#[derive(Clone, Debug, PartialEq)]
pub struct LearnConfig {
    /// Passes over the names. Default 30.
    pub passes: usize,
    /// Length of steps. Default 0.1.
    pub rate: f32,
    /// Penalty on the sum of weights' magnitudes. Default 4.
    pub l1: f32,
    /// Penalty on the sum of their squares. Default 0.1.
    pub l2: f32,
    /// A group of n objects counts n to this power, so that a chandelier of ten thousand crystals does not outweigh all else. Default 0.1.
    pub count_power: f32,
    /// Scenes that need to have a feature. Default 1.
    pub fewest_scenes: usize,
    /// Weight of a word of the word list as an example of its class, relative to 1 for a name of a scene. Without these, rare classes would
    /// have no examples. Default 1.
    pub word_list: f32,
    /// Weight of such a word if fewer than five labelled groups have its class: there is no other evidence, and correlations with its
    /// letters are chance. Default 30.
    pub unseen_word: f32,
}

impl Default for LearnConfig {
    fn default() -> Self {
        Self { passes: 30, rate: 0.1, l1: 4.0, l2: 0.1, count_power: 0.1, fewest_scenes: 1, word_list: 1.0, unseen_word: 30.0 }
    }
}

/// A group as learning sees it.
struct Example {
    features: Vec<usize>,
    /// Shares of the classes.
    shares: Vec<(usize, f32)>,
    weight: f32,
}

/// Weight, and what FTRL keeps of its gradients.
#[derive(Clone, Copy, Default)]
struct State {
    w: f32,
    z: f32,
    n: f32,
}

/// The weights of labelled groups; what nobody labelled is left out. A function of its arguments alone.
pub fn learn(groups: &[&NameGroup], lexicon: &Lexicon, config: &LearnConfig) -> Weights {
    let labelled: Vec<(&NameGroup, Vec<String>)> =
        groups.iter().filter(|g| g.labelled() > 0 && !g.words.is_empty()).map(|&g| (g, features(&g.words, lexicon))).collect();
    // Only features from the list, so that its word is learned like one that no scene has.
    let said = |features: Vec<String>| features.into_iter().filter(|f| f.starts_with("means ") || f.starts_with("head "));
    let listed: Vec<(Vec<String>, i16)> =
        lexicon.entries().iter().map(|(words, class)| (said(features(words, lexicon)).collect(), *class)).collect();
    let mut names: BTreeSet<&str> = frequent(&labelled, config.fewest_scenes);
    // Classes that no scene has a word of are known by the list alone.
    names.extend(listed.iter().flat_map(|(features, _)| features.iter().map(String::as_str)));
    let names: Vec<&str> = names.into_iter().collect();
    let index: BTreeMap<&str, usize> = names.iter().enumerate().map(|(i, &name)| (name, i + 1)).collect();
    let mut examples: Vec<Example> = labelled
        .iter()
        .map(|(group, features)| {
            let total = group.labelled() as f32;
            Example {
                features: std::iter::once(0).chain(features.iter().filter_map(|f| index.get(f.as_str()).copied())).collect(),
                shares: group.classes.range(1..).map(|(&class, &n)| (class as usize - 1, n as f32 / total)).collect(),
                weight: total.powf(config.count_power),
            }
        })
        .collect();
    for (said, class) in &listed {
        let features = std::iter::once(0).chain(said.iter().filter_map(|f| index.get(f.as_str()).copied())).collect();
        let is_seen = said.iter().all(|feature| labelled.iter().filter(|(_, features)| features.contains(feature)).nth(FEW - 1).is_some());
        let weight = if is_seen { config.word_list } else { config.unseen_word };
        examples.push(Example { features, shares: vec![(*class as usize - 1, 1.0)], weight });
    }
    let mut states = vec![[State::default(); CLASSES]; names.len() + 1];
    let mut random = 1u64;
    for _ in 0..config.passes {
        shuffle(&mut examples, &mut random);
        for example in &examples {
            step(example, &mut states, config);
        }
    }
    let weights: Vec<[f32; CLASSES]> = states.iter().map(|row| row.map(|state| state.w)).collect();
    let rows = names.iter().zip(&weights[1..]).map(|(&name, row)| (name, row.as_slice()));
    Weights::new(&weights[0], &rows.collect())
}

/// The features that enough scenes have, sorted.
fn frequent<'a>(labelled: &'a [(&NameGroup, Vec<String>)], fewest_scenes: usize) -> BTreeSet<&'a str> {
    let mut scenes: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (group, features) in labelled {
        for feature in features {
            scenes.entry(feature).or_default().insert(&group.scene);
        }
    }
    scenes.into_iter().filter(|(_, scenes)| scenes.len() >= fewest_scenes).map(|(feature, _)| feature).collect()
}

/// One example's step.
fn step(example: &Example, states: &mut [[State; CLASSES]], config: &LearnConfig) {
    let mut sums = [0.0; CLASSES];
    for &feature in &example.features {
        states[feature].iter().zip(&mut sums).for_each(|(state, sum)| *sum += state.w);
    }
    let mut gradient = softmax(&sums);
    example.shares.iter().for_each(|&(class, share)| gradient[class] -= share);
    for &feature in &example.features {
        // The feature that every name has is not penalised.
        let l1 = if feature == 0 { 0.0 } else { config.l1 };
        for (state, gradient) in states[feature].iter_mut().zip(&gradient) {
            let g = gradient * example.weight;
            let n = state.n + g * g;
            state.z += g - (n.sqrt() - state.n.sqrt()) / config.rate * state.w;
            state.n = n;
            let excess = state.z.abs() - l1;
            state.w = if excess <= 0.0 { 0.0 } else { -excess.copysign(state.z) / ((1.0 + n.sqrt()) / config.rate + config.l2) };
        }
    }
}

/// Fisher and Yates's shuffle with Vigna's splitmix64.
fn shuffle(examples: &mut [Example], random: &mut u64) {
    for i in (1..examples.len()).rev() {
        *random = random.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = *random;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        examples.swap(i, ((x ^ (x >> 31)) % (i as u64 + 1)) as usize);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::words::words;

    fn group(scene: &str, name: &str, class: i16, count: usize) -> NameGroup {
        NameGroup { scene: scene.into(), words: words(name), classes: [(class, count)].into() }
    }

    #[test]
    fn words_of_two_scenes_are_learned_and_the_same_names_give_the_same_bytes() {
        let groups = [
            group("a", "gizmo", 24, 3),
            group("b", "gizmo", 24, 1),
            group("a", "widget", 34, 3),
            group("b", "widget", 34, 9),
            group("c", "once", 4, 9),
        ];
        let groups: Vec<&NameGroup> = groups.iter().collect();
        let lexicon = Lexicon::builtin().unwrap();
        let config = LearnConfig { l1: 0.01, fewest_scenes: 2, ..LearnConfig::default() };
        let weights = learn(&groups, &lexicon, &config);
        let best = |name: &str| {
            let mut sums = weights.start();
            weights.add(&features(&words(name), &lexicon), 1.0, &mut sums);
            (0..CLASSES).max_by(|&a, &b| sums[a].total_cmp(&sums[b])).unwrap() + 1
        };
        assert_eq!([best("Gizmo_12"), best("widget")], [24, 34]);
        let text = weights.to_csv();
        assert!(text.contains("word gizmo,refrigerator,") && !text.contains("once"), "{text}");
        assert_eq!(learn(&groups, &lexicon, &config).to_csv(), text);
    }
}
