//! The accuracy of suggestions: shares of right ones, by name and by object.

use enfilade_suggest::Suggestion;
use enfilade_suggest::learn::NameGroup;
use std::collections::BTreeMap;

/// Suggestions for groups, and how they fare.
pub struct Judgement {
    pub suggestions: Vec<Option<Suggestion>>,
    /// The groups that have labelled objects.
    pub rows: Vec<Row>,
}

/// A group with labelled objects.
#[derive(Clone)]
pub struct Row {
    pub scene: String,
    /// The name has words.
    pub worded: bool,
    /// Labelled objects by class.
    pub classes: BTreeMap<i16, f64>,
    pub suggested: Option<(i16, f64)>,
}

impl Row {
    pub fn objects(&self) -> f64 {
        self.classes.values().sum()
    }

    /// Objects that have the suggested class.
    pub fn right(&self) -> f64 {
        self.suggested.and_then(|(class, _)| self.classes.get(&class).copied()).unwrap_or(0.0)
    }
}

/// The unit of counting.
#[derive(Clone, Copy)]
pub enum By {
    /// A name of a scene.
    Name,
    Object,
}

impl By {
    /// Counts of the right ones and of all.
    fn count(self, row: &Row) -> [f64; 2] {
        match self {
            Self::Name => [row.right() / row.objects(), 1.0],
            Self::Object => [row.right(), row.objects()],
        }
    }
}

impl Judgement {
    pub fn new(groups: &[NameGroup], suggestions: Vec<Option<Suggestion>>) -> Self {
        let row = |(group, suggestion): (&NameGroup, &Option<Suggestion>)| {
            let classes: BTreeMap<i16, f64> = group.classes.range(1..).map(|(&class, &n)| (class, n as f64)).collect();
            let suggested = suggestion.as_ref().map(|s| (s.class, f64::from(s.confidence)));
            (!classes.is_empty()).then(|| Row { scene: group.scene.clone(), worded: !group.words.is_empty(), classes, suggested })
        };
        let rows = groups.iter().zip(&suggestions).filter_map(row).collect();
        Self { suggestions, rows }
    }

    /// Share that is right of all, or of those whose names have words; no suggestion is wrong.
    pub fn accuracy(&self, by: By, worded: bool) -> f64 {
        share(self.rows.iter().filter(|row| row.worded || !worded).map(|row| by.count(row)))
    }

    /// Share of the labelled objects that is right, the mean over scenes.
    pub fn accuracy_per_scene(&self) -> f64 {
        let mut scenes: BTreeMap<&str, [f64; 2]> = BTreeMap::new();
        for row in &self.rows {
            let sum = scenes.entry(&row.scene).or_default();
            let add = By::Object.count(row);
            *sum = [sum[0] + add[0], sum[1] + add[1]];
        }
        scenes.values().map(|sum| sum[0] / sum[1]).sum::<f64>() / scenes.len() as f64
    }

    /// Precision and coverage from a confidence on; coverage is of those whose names have words.
    pub fn of_confidence(&self, min: f64, by: By) -> [f64; 2] {
        let sure = || self.rows.iter().filter(|row| row.suggested.is_some_and(|(_, confidence)| confidence >= min));
        let all: f64 = self.rows.iter().filter(|row| row.worded).map(|row| by.count(row)[1]).sum();
        [share(sure().map(|row| by.count(row))), sure().map(|row| by.count(row)[1]).sum::<f64>() / all]
    }

    /// The largest share of those whose names have words that can be had with a precision of at least `precision`, and the confidence.
    pub fn coverage(&self, precision: f64, by: By) -> [f64; 2] {
        let mut sorted: Vec<&Row> = self.rows.iter().filter(|row| row.suggested.is_some()).collect();
        let confidence = |row: &Row| row.suggested.map_or(0.0, |(_, confidence)| confidence);
        sorted.sort_by(|a, b| confidence(b).total_cmp(&confidence(a)));
        let all: f64 = self.rows.iter().filter(|row| row.worded).map(|row| by.count(row)[1]).sum();
        let (mut sum, mut best) = ([0.0; 2], [0.0; 2]);
        for (i, row) in sorted.iter().enumerate() {
            let add = by.count(row);
            sum = [sum[0] + add[0], sum[1] + add[1]];
            let ends = sorted.get(i + 1).is_none_or(|next| confidence(next) < confidence(row));
            if ends && sum[0] >= precision * sum[1] {
                best = [sum[1] / all, confidence(row)];
            }
        }
        best
    }

    /// Bins of confidence: names, mean confidence, share of names that is right, objects, share of objects.
    pub fn reliability(&self, bounds: &[f64]) -> Vec<[f64; 5]> {
        let bin = |low: f64, high: f64| {
            let rows: Vec<&Row> = self.rows.iter().filter(|row| row.suggested.is_some_and(|(_, c)| (low..high).contains(&c))).collect();
            let mean = rows.iter().filter_map(|row| row.suggested).map(|(_, c)| c).sum::<f64>() / rows.len().max(1) as f64;
            let of = |by: By| share(rows.iter().map(|row| by.count(row)));
            [rows.len() as f64, mean, of(By::Name), rows.iter().map(|row| row.objects()).sum(), of(By::Object)]
        };
        bounds.windows(2).map(|pair| bin(pair[0], pair[1])).collect()
    }

    /// Mean distance of confidence and share of right names over bins, weighted by names.
    pub fn calibration_error(&self) -> f64 {
        let bounds: Vec<f64> = (0..=20).map(|i| f64::from(i) / 20.0 + if i == 20 { 1e-6 } else { 0.0 }).collect();
        let bins = self.reliability(&bounds);
        let total: f64 = bins.iter().map(|bin| bin[0]).sum();
        bins.iter().filter(|bin| bin[0] > 0.0).map(|bin| bin[0] * (bin[1] - bin[2]).abs()).sum::<f64>() / total
    }

    /// Scores of a class, in names: how many have it, precision, recall.
    pub fn of_class(&self, class: i16) -> [f64; 3] {
        let has = |row: &Row| row.classes.get(&class).copied().unwrap_or(0.0) / row.objects();
        let said = |row: &&Row| row.suggested.is_some_and(|(suggested, _)| suggested == class);
        let truth: f64 = self.rows.iter().filter(|row| row.worded).map(has).sum();
        let right: f64 = self.rows.iter().filter(said).map(has).sum();
        [
            truth.max(0.0),
            right.max(0.0) / self.rows.iter().filter(said).count().max(1) as f64,
            if truth > 0.0 { right.max(0.0) / truth } else { 0.0 },
        ]
    }

    /// Share of names for which a class is right that is the most frequent one of that name in all scenes together, of names that
    /// several scenes have: nobody who has only the names can do better.
    pub fn ceiling(groups: &[NameGroup]) -> [f64; 2] {
        let mut tables: BTreeMap<&[String], (usize, BTreeMap<i16, f64>)> = BTreeMap::new();
        for group in groups.iter().filter(|group| group.labelled() > 0 && !group.words.is_empty()) {
            let (scenes, table) = tables.entry(&group.words).or_default();
            *scenes += 1;
            for (&class, &n) in group.classes.range(1..) {
                *table.entry(class).or_default() += n as f64 / group.labelled() as f64;
            }
        }
        let several = || tables.values().filter(|(scenes, _)| *scenes > 1);
        let names: f64 = several().map(|(scenes, _)| *scenes as f64).sum();
        [names, several().map(|(_, table)| table.values().copied().fold(0.0, f64::max)).sum::<f64>() / names]
    }
}

fn share(counts: impl Iterator<Item = [f64; 2]>) -> f64 {
    let sum = counts.fold([0.0; 2], |sum, add| [sum[0] + add[0], sum[1] + add[1]]);
    if sum[1] > 0.0 { sum[0] / sum[1] } else { 0.0 }
}
