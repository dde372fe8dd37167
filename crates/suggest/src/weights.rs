//! The linear model: a weight per feature and class, and the probabilities that they add up to.

use crate::table::{TableError, class_number, number, read};
use enfilade_scene::NYU40;
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write;

/// Number of classes.
pub(crate) const CLASSES: usize = NYU40.len();
/// The feature that every name has.
const BIAS: &str = "every name";
/// Weights smaller than this change no answer and fill half of the table.
const MIN_WEIGHT: f32 = 0.1;
const COLUMNS: [&str; 3] = ["feature", "class", "weight"];

/// Weights by feature; classes without a weight have 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Weights {
    bias: Vec<(i16, f32)>,
    features: HashMap<String, Vec<(i16, f32)>>,
}

impl Weights {
    /// Weights from rows, in two decimals; those below [`MIN_WEIGHT`] are left out.
    pub(crate) fn new(bias: &[f32; CLASSES], features: &BTreeMap<&str, &[f32]>) -> Self {
        let list = |weights: &[f32]| {
            let rounded = weights.iter().map(|w| (w * 100.0).round() / 100.0);
            (1..).zip(rounded).filter(|&(_, w)| w.abs() >= MIN_WEIGHT).collect::<Vec<(i16, f32)>>()
        };
        let features = features.iter().map(|(name, weights)| ((*name).to_string(), list(weights))).filter(|(_, list)| !list.is_empty());
        Self { bias: list(bias), features: features.collect() }
    }

    /// Reads `feature,class,weight`. `file` is what errors call it.
    ///
    /// # Errors
    /// The first row with another number of fields, an unknown class, a weight that is no finite number, or a repetition.
    pub fn parse(text: &str, file: &str) -> Result<Self, TableError> {
        let mut weights = Self::default();
        for (line, [feature, class, weight]) in read(text, file, COLUMNS)? {
            let error = |problem: String| TableError { file: file.into(), line, problem };
            let class = class_number(&class).map_err(error)?;
            let weight = number(&weight, "weight").map_err(error)?;
            let list = if feature == BIAS { &mut weights.bias } else { weights.features.entry(feature.clone()).or_default() };
            if list.iter().any(|&(c, _)| c == class) {
                return Err(error(format!("a second weight of {feature:?} for this class; remove one of the rows")));
            }
            list.push((class, weight));
        }
        if weights.features.is_empty() {
            return Err(TableError {
                file: file.into(),
                line: 1,
                problem: "the table has no weights; take the file as it was released".into(),
            });
        }
        Ok(weights)
    }

    /// The table as text, sorted by feature, then class.
    pub fn to_csv(&self) -> String {
        let mut text = format!("{}\n", COLUMNS.join(","));
        let sorted: BTreeMap<_, _> = self.features.iter().map(|(name, list)| (name.as_str(), list)).collect();
        for (name, list) in std::iter::once((BIAS, &self.bias)).chain(sorted) {
            for &(class, weight) in list {
                let _ = writeln!(text, "{name},{},{weight}", NYU40[class as usize - 1].name); // a String takes all
            }
        }
        text
    }

    /// Number of features and of weights.
    pub fn size(&self) -> (usize, usize) {
        (self.features.len(), self.features.values().map(Vec::len).sum::<usize>() + self.bias.len())
    }

    /// Whether the table has a weight for one of these features.
    pub(crate) fn knows(&self, features: &[String]) -> bool {
        features.iter().any(|feature| self.features.contains_key(feature))
    }

    /// The weight of a feature for a class, 0 where the table has none.
    pub fn of(&self, feature: &str, class: i16) -> f32 {
        let weights = self.features.get(feature).into_iter().flatten();
        weights.filter(|(c, _)| *c == class).map(|(_, weight)| *weight).next().unwrap_or(0.0)
    }

    /// Adds the weights of features, times `factor`, to sums of the classes.
    pub(crate) fn add(&self, features: &[String], factor: f32, sums: &mut [f32; CLASSES]) {
        for &(class, weight) in features.iter().filter_map(|feature| self.features.get(feature)).flatten() {
            sums[class as usize - 1] += factor * weight;
        }
    }

    /// The sums of a name without features.
    pub(crate) fn start(&self) -> [f32; CLASSES] {
        let mut sums = [0.0; CLASSES];
        self.bias.iter().for_each(|&(class, weight)| sums[class as usize - 1] = weight);
        sums
    }
}

/// Probabilities in proportion to the exponentials of sums.
pub(crate) fn softmax(sums: &[f32; CLASSES]) -> [f32; CLASSES] {
    let largest = sums.iter().copied().fold(f32::MIN, f32::max);
    let exponentials = sums.map(|sum| (sum - largest).exp());
    let total: f32 = exponentials.iter().sum();
    exponentials.map(|e| e / total)
}
