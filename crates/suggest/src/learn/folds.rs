//! Cross-validation: models learned without some scenes or volumes, and asked about those.

use super::groups::NameGroup;
use super::train::{LearnConfig, learn};
use crate::calibration::{Calibration, Judged};
use crate::lexicon::Lexicon;
use crate::suggester::{PartNames, Suggester, Suggestion};
use std::collections::BTreeSet;

/// What stays together when scenes are held out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Split {
    /// A scene.
    Scene,
    /// A volume of scenes, which were made and named by the same people: `ai_037` of `ai_037_002`.
    Volume,
}

/// What models say of groups that they have not seen.
#[derive(Clone, Debug)]
pub struct HeldOut {
    /// Per group: what is suggested, with a confidence that is calibrated on other scenes than the group's.
    pub suggestions: Vec<Option<Suggestion>>,
    /// Per group with labelled objects and a suggestion: the score, and the share that is right.
    pub scores: Vec<Judged>,
    /// The same with the confidence in place of the score.
    pub confidences: Vec<Judged>,
}

/// Weight of names in a bin of the curve of confidences.
const BIN: f32 = 120.0;

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
    for fold in 0..folds {
        let seen: Vec<&NameGroup> = groups.iter().zip(&fold_of).filter(|&(_, &f)| f != fold).map(|(group, _)| group).collect();
        let weights = learn(&seen, lexicon, config);
        let suggester = Suggester::uncalibrated(weights, lexicon.clone());
        for (i, group) in groups.iter().enumerate().filter(|&(i, _)| fold_of[i] == fold) {
            let name = group.words.join(" ");
            raw[i] = suggester.suggest(&PartNames { part: &name, ..PartNames::default() });
        }
    }
    let judge = |i: usize| judged(&groups[i], raw[i].as_ref()?);
    let scores: Vec<Judged> = (0..groups.len()).filter_map(judge).collect();
    let mut suggestions = raw.clone();
    for fold in fold_of.iter().copied().collect::<BTreeSet<_>>() {
        let others: Vec<Judged> = (0..groups.len()).filter(|&i| fold_of[i] != fold).filter_map(judge).collect();
        let calibration = Calibration::fit(&others, BIN);
        for i in (0..groups.len()).filter(|&i| fold_of[i] == fold) {
            suggestions[i] = raw[i].as_ref().map(|suggestion| suggestion.calibrated(&calibration));
        }
    }
    let confidences = groups.iter().zip(&suggestions).filter_map(|(group, suggestion)| judged(group, suggestion.as_ref()?)).collect();
    HeldOut { suggestions, scores, confidences }
}

impl HeldOut {
    /// The curve of confidences of all that was judged.
    pub fn calibration(&self) -> Calibration {
        Calibration::fit(&self.scores, BIN)
    }
}

/// How a suggestion fares on the labelled objects of a group; `None` when there are none. Every name of a scene counts once.
fn judged(group: &NameGroup, suggestion: &Suggestion) -> Option<Judged> {
    let labelled = group.labelled();
    let right = group.of_class(suggestion.class) as f32 / labelled.max(1) as f32;
    (labelled > 0).then_some(Judged { score: suggestion.confidence, right, weight: 1.0 })
}
