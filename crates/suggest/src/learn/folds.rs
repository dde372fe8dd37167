//! Cross-validation: models learned without some scenes or volumes, and asked about those.

use super::groups::NameGroup;
use super::pairs::{Pair, learn_shares};
use super::train::{LearnConfig, learn};
use crate::calibration::{Calibration, Judged};
use crate::chain::Shares;
use crate::lexicon::Lexicon;
use crate::roles::Role;
use crate::suggester::{PartNames, Suggester, Suggestion};
use crate::weights::CLASSES;
use std::collections::{BTreeMap, BTreeSet};

/// The unit that stays together when scenes are held out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Split {
    /// A scene.
    Scene,
    /// A volume of scenes, which were made and named by the same people: `ai_037` of `ai_037_002`.
    Volume,
}

/// Results of models for groups that they have not seen.
#[derive(Clone, Debug)]
pub struct HeldOut {
    /// Per group: the suggestion, with a confidence that is calibrated on other scenes than the group's.
    pub suggestions: Vec<Option<Suggestion>>,
    /// Per group with labelled objects and a suggestion: the score, and the share that is right.
    pub scores: Vec<Judged>,
    /// Per group with labelled objects and a suggestion: the confidence, and the share that is right.
    pub confidences: Vec<Judged>,
    /// Labelled names of two, a thing and its piece, with each half classified by itself.
    pub pairs: Vec<Pair>,
    /// Per pair: the class by both halves with its confidence, by shares of other scenes than the pair's.
    pub by_both: Vec<(i16, f32)>,
}

/// Both halves of a name, the inner one first, as a model sees them.
type Halves = [(Role, [f32; CLASSES]); 2];

/// Weight of names in a bin of the curve of confidences.
const BIN: f32 = 120.0;
/// Names of two that are in a bin, of which there are few.
const BIN_OF_PAIRS: f32 = 80.0;

impl Split {
    /// The fold of a scene, 0 to `folds`−1: a hash (FNV-1a) of what stays together.
    pub fn fold(self, scene: &str, folds: usize) -> usize {
        let kept = match self {
            Self::Scene => scene,
            Self::Volume => scene.rsplit_once('_').map_or(scene, |(volume, _)| volume),
        };
        let hash = kept.bytes().fold(0xcbf2_9ce4_8422_2325u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
        ((hash >> 32) % folds as u64) as usize
    }
}

/// Learns `folds` times without a fold, and asks about its groups.
///
/// # Panics
/// When `folds` is less than 2, or a fold has nothing to judge.
pub fn held_out(groups: &[NameGroup], lexicon: &Lexicon, config: &LearnConfig, split: Split, folds: usize) -> HeldOut {
    assert!(folds >= 2, "held-out scenes need at least two folds, not {folds}");
    let fold_of: Vec<usize> = groups.iter().map(|group| split.fold(&group.scene, folds)).collect();
    let mut raw: Vec<Option<Suggestion>> = vec![None; groups.len()];
    let mut of_two: Vec<(usize, Halves)> = Vec::new();
    for fold in 0..folds {
        let seen: Vec<&NameGroup> = groups.iter().zip(&fold_of).filter(|&(_, &f)| f != fold).map(|(group, _)| group).collect();
        let weights = learn(&seen, lexicon, config);
        let suggester = Suggester::uncalibrated(weights, lexicon.clone());
        for (i, group) in groups.iter().enumerate().filter(|&(i, _)| fold_of[i] == fold) {
            let name = group.words.join(" ");
            raw[i] = suggester.suggest(&PartNames { part: &name, ..PartNames::default() });
            of_two.extend(suggester.halves(&group.words).filter(|_| group.labelled() > 0).map(|halves| (i, halves)));
        }
    }
    let judge = |i: usize| judged(&groups[i], raw[i].as_ref()?);
    let scores: Vec<Judged> = (0..groups.len()).filter_map(judge).collect();
    let mut suggestions = raw.clone();
    let mut pairs: Vec<Pair> = Vec::new();
    for fold in fold_of.iter().copied().collect::<BTreeSet<_>>() {
        let others: Vec<Judged> = (0..groups.len()).filter(|&i| fold_of[i] != fold).filter_map(judge).collect();
        let calibration = Calibration::fit(&others, BIN);
        for i in (0..groups.len()).filter(|&i| fold_of[i] == fold) {
            suggestions[i] = raw[i].as_ref().map(|suggestion| suggestion.calibrated(&calibration));
        }
        for (i, [inner, outer]) in of_two.iter().filter(|(i, _)| fold_of[*i] == fold) {
            let level = |(role, p): &(Role, [f32; CLASSES])| (role.clone(), calibration.apply(p));
            pairs.push(Pair::new(*i, level(inner), level(outer)));
        }
    }
    let by_both = by_both(&pairs, groups, &fold_of);
    let confidences = groups.iter().zip(&suggestions).filter_map(|(group, suggestion)| judged(group, suggestion.as_ref()?)).collect();
    HeldOut { suggestions, scores, confidences, pairs, by_both }
}

impl HeldOut {
    /// The curve of confidences of all that was judged.
    pub fn calibration(&self) -> Calibration {
        Calibration::fit(&self.scores, BIN)
    }

    /// The shares of names around parts, and the curve of the confidences that they give, of all pairs of these groups.
    pub fn around(&self, groups: &[NameGroup]) -> (Shares, Calibration) {
        around(&self.pairs.iter().collect::<Vec<_>>(), groups)
    }
}

/// Classes of pairs by both halves, with shares and a curve that were learned from other folds.
fn by_both(pairs: &[Pair], groups: &[NameGroup], fold_of: &[usize]) -> Vec<(i16, f32)> {
    let folds: BTreeSet<usize> = pairs.iter().map(|pair| fold_of[pair.group]).collect();
    let others = |fold: usize| around(&pairs.iter().filter(|pair| fold_of[pair.group] != fold).collect::<Vec<_>>(), groups);
    let learned: BTreeMap<usize, (Shares, Calibration)> = folds.into_iter().map(|fold| (fold, others(fold))).collect();
    let both = |pair: &Pair| {
        let (shares, calibration) = &learned[&fold_of[pair.group]];
        let (class, score) = pair.by_both(shares);
        (class, if pair.kind().is_some() { calibration.confidence(score) } else { score })
    };
    pairs.iter().map(both).collect()
}

/// The shares of names around parts, and the curve of the confidences that they give.
fn around(pairs: &[&Pair], groups: &[NameGroup]) -> (Shares, Calibration) {
    let shares = learn_shares(pairs.iter().copied(), groups);
    let judged = |pair: &Pair| {
        let ((class, score), group) = (pair.by_both(&shares), &groups[pair.group]);
        Judged { score, right: group.of_class(class) as f32 / group.labelled() as f32, weight: 1.0 }
    };
    let judged: Vec<Judged> = pairs.iter().filter(|pair| pair.kind().is_some()).map(|pair| judged(pair)).collect();
    let calibration = if judged.is_empty() { Calibration::identity() } else { Calibration::fit(&judged, BIN_OF_PAIRS) };
    (shares, calibration)
}

/// How a suggestion fares on the labelled objects of a group; `None` when there are none. Every name of a scene counts once.
fn judged(group: &NameGroup, suggestion: &Suggestion) -> Option<Judged> {
    let labelled = group.labelled();
    let right = group.of_class(suggestion.class) as f32 / labelled.max(1) as f32;
    (labelled > 0).then_some(Judged { score: suggestion.confidence, right, weight: 1.0 })
}
