//! The whole way from a part's names to a suggestion: words, features, weights, probabilities, confidence.

use crate::calibration::{Calibration, Thresholds};
use crate::features::features;
use crate::lexicon::Lexicon;
use crate::table::TableError;
use crate::weights::{CLASSES, Weights, softmax};
use crate::words::words;
use enfilade_scene::Scene;

const WEIGHTS: (&str, &str) = ("data/weights.csv", include_str!("../data/weights.csv"));
const CALIBRATION: (&str, &str) = ("data/calibration.csv", include_str!("../data/calibration.csv"));
const THRESHOLDS: (&str, &str) = ("data/thresholds.csv", include_str!("../data/thresholds.csv"));
/// Alternatives that a suggestion may have.
const MAX_ALTERNATIVES: usize = 3;
/// What a material's name counts beside a part's: half, because it says what a thing is made of more often than what it is.
const MATERIAL_SHARE: f32 = 0.5;

/// Knows which classes names stand for. The same names always get the same suggestion; nothing is read or kept.
///
/// ```
/// use enfilade_suggest::{PartNames, Suggester};
/// let names = PartNames { part: "Object_12", material: "pillow_fabric", group: "bedroom/bed_double" };
/// let suggestion = Suggester::builtin().suggest(&names).unwrap();
/// assert!(suggestion.alternatives.iter().all(|(_, confidence)| *confidence <= suggestion.confidence));
/// ```
#[derive(Clone, Debug)]
pub struct Suggester {
    weights: Weights,
    lexicon: Lexicon,
    calibration: Calibration,
    thresholds: Thresholds,
}

/// The names by which a part is judged. Any may be empty.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PartNames<'a> {
    /// The part's own name; `object/part` says which object it belongs to.
    pub part: &'a str,
    /// Its material's name.
    pub material: &'a str,
    /// The groups that it is in, outermost first, with slashes between.
    pub group: &'a str,
}

/// A class that a name may stand for.
#[derive(Clone, Debug, PartialEq)]
pub struct Suggestion {
    /// NYU40 class, 1 to 40.
    pub class: i16,
    /// Probability that it is right, from 0 to 1: of names with this confidence in scenes that were held out, that share was.
    pub confidence: f32,
    /// Up to three other classes, the likeliest first, with their probabilities, none above `confidence`.
    pub alternatives: Vec<(i16, f32)>,
}

impl Suggester {
    /// With the tables that come with the crate.
    ///
    /// # Panics
    /// When they are damaged, which the crate's tests exclude.
    pub fn builtin() -> Self {
        Self::from_tables(WEIGHTS, CALIBRATION, THRESHOLDS).unwrap_or_else(|error| panic!("a table that was built in is damaged: {error}"))
    }

    /// With tables of your own: of each what errors call it, and its text. The word list is the crate's.
    ///
    /// # Errors
    /// The first row that is damaged.
    pub fn from_tables(weights: (&str, &str), calibration: (&str, &str), thresholds: (&str, &str)) -> Result<Self, TableError> {
        Ok(Self {
            weights: Weights::parse(weights.1, weights.0)?,
            lexicon: Lexicon::builtin()?,
            calibration: Calibration::parse(calibration.1, calibration.0)?,
            thresholds: Thresholds::parse(thresholds.1, thresholds.0)?,
        })
    }

    /// With weights that were learned, before anything is known of their precision: the confidence is the model's own probability.
    pub fn uncalibrated(weights: Weights, lexicon: Lexicon) -> Self {
        Self { weights, lexicon, calibration: Calibration::identity(), thresholds: Thresholds::default() }
    }

    /// The minimum confidence from which on at least the share `precision` of names is right, as measured in held-out volumes of
    /// scenes; 0.95 is the highest that is known. `None` where none is.
    pub fn min_confidence(&self, precision: f32) -> Option<f32> {
        self.thresholds.min_confidence(precision)
    }

    /// What a part of these names is; `None` when they have no word of which anything is known.
    pub fn suggest(&self, names: &PartNames<'_>) -> Option<Suggestion> {
        let evidence = self.evidence(names);
        if evidence.is_empty() {
            return None;
        }
        let mut sums = self.weights.start();
        evidence.iter().for_each(|(features, share)| self.weights.add(features, *share, &mut sums));
        Some(Suggestion::of(&softmax(&sums)).calibrated(&self.calibration))
    }

    /// What in these names speaks for a class (above 0) or against it, the strongest first: features as
    /// [`features`](crate::features::features) writes them, and their weights, in natural logarithms of odds.
    pub fn reasons(&self, names: &PartNames<'_>, class: i16) -> Vec<(String, f32)> {
        let weighed = |(features, share): (Vec<String>, f32)| {
            features.into_iter().map(move |feature| {
                let weight = share * self.weights.of(&feature, class);
                (feature, weight)
            })
        };
        let mut reasons: Vec<_> = self.evidence(names).into_iter().flat_map(weighed).filter(|(_, weight)| *weight != 0.0).collect();
        reasons.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        reasons
    }

    /// The features of a part's own names and of its material's, of which anything is known, and how much each list counts.
    fn evidence(&self, names: &PartNames<'_>) -> Vec<(Vec<String>, f32)> {
        let own: Vec<String> = [names.group, names.part].into_iter().flat_map(words).collect();
        let mut material = words(names.material);
        // Exporters often name a part after its material: that is one word, not two.
        material.retain(|word| !own.contains(word));
        let known = |words: &[String]| Some(features(words, &self.lexicon)).filter(|features| self.weights.knows(features));
        let own = known(&own);
        let share = if own.is_some() { MATERIAL_SHARE } else { 1.0 };
        own.map(|features| (features, 1.0)).into_iter().chain(known(&material).map(|features| (features, share))).collect()
    }

    /// What every part of a scene is, in the order of `Scene::parts`.
    ///
    /// # Panics
    /// When a part's material does not exist; a valid scene has none such.
    pub fn suggest_scene(&self, scene: &Scene) -> Vec<Option<Suggestion>> {
        let names = scene.parts.iter().map(|part| PartNames {
            part: &part.name,
            material: &scene.materials[part.material as usize].name,
            group: "",
        });
        names.map(|names| self.suggest(&names)).collect()
    }
}

impl Suggestion {
    /// The likeliest classes.
    fn of(probabilities: &[f32; CLASSES]) -> Self {
        let mut order: Vec<usize> = (0..CLASSES).collect();
        order.sort_by(|&a, &b| probabilities[b].total_cmp(&probabilities[a]));
        let pair = |i: usize| (i as i16 + 1, probabilities[i]);
        let (class, confidence) = pair(order[0]);
        Self { class, confidence, alternatives: order[1..=MAX_ALTERNATIVES].iter().map(|&i| pair(i)).collect() }
    }

    /// With a score turned into a confidence; the alternatives share what is left as before.
    pub(crate) fn calibrated(&self, calibration: &Calibration) -> Self {
        let confidence = calibration.confidence(self.confidence);
        let factor = (1.0 - confidence) / (1.0 - self.confidence).max(f32::EPSILON);
        let alternatives = self.alternatives.iter().map(|&(class, p)| (class, (p * factor).min(confidence))).collect();
        Self { class: self.class, confidence, alternatives }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::NYU40;

    fn of(part: &str, material: &str) -> Option<Suggestion> {
        Suggester::builtin().suggest(&PartNames { part, material, group: "" })
    }

    fn class(part: &str) -> &'static str {
        of(part, "").map_or("nothing", |suggestion| NYU40[suggestion.class as usize - 1].name)
    }

    #[test]
    fn known_answers() {
        for (name, expected) in [
            ("sofa_01", "sofa"),
            ("Couch", "sofa"),
            ("Tisch", "table"),
            ("lampa", "lamp"),
            ("AI53_005_armchair_metal_2917", "chair"),
            ("стул.003", "chair"),
            ("DiningTable01", "table"),
            ("Living room/book_17", "books"),
            ("Kitchen_Cabinet", "cabinet"),
            ("curtain_left", "curtain"),
            ("Kühlschrank", "refrigerator"),
            ("miroir", "mirror"),
            ("Floor", "floor"),
            ("ceiling_02", "ceiling"),
            ("WineBottle", "otherprop"),
        ] {
            assert_eq!(class(name), expected, "{name}");
        }
    }

    #[test]
    fn names_that_say_nothing_get_nothing_or_little_confidence() {
        for name in ["", "obj_185", "Archinteriors8_01_55", "Mesh.017", "\u{0}🛋️", "12345", "qwqx"] {
            assert_eq!(of(name, ""), None, "{name:?}");
        }
        for name in ["Plane001", "Box422", "Cylinder 7"] {
            assert!(of(name, "").is_none_or(|s| s.confidence < 0.6), "{name}: {:?}", of(name, ""));
        }
    }

    #[test]
    fn odd_names_are_no_trouble_and_answers_do_not_change() {
        let suggester = Suggester::builtin();
        for part in ["x".repeat(1_000_000), "sofa ".repeat(200_000), "ﬁ\u{202e}\u{301}sofa\n\"'".into()] {
            let names = PartNames { part: &part, material: &part, group: &part };
            assert_eq!(suggester.suggest(&names), Suggester::builtin().suggest(&names));
        }
    }

    #[test]
    fn a_material_helps_a_name_that_says_nothing_and_does_not_outweigh_one_that_does() {
        assert_eq!(of("Mesh.001", "Curtains").unwrap().class, 16);
        assert_eq!(of("sofa", "Wood").unwrap().class, 6);
        assert_eq!(of("Mesh.001", "Material.002"), None);
    }

    #[test]
    fn a_part_named_after_its_material_is_as_sure_as_either() {
        assert_eq!(of("Curtains_Mesh012", "Curtains"), of("Curtains_Mesh012", ""));
    }

    #[test]
    fn groups_are_read_before_the_part() {
        let names = PartNames { part: "leg_02", material: "", group: "Living room/chair.003" };
        assert_eq!(Suggester::builtin().suggest(&names).unwrap().class, 5);
    }

    #[test]
    fn reasons_name_what_decided() {
        let suggester = Suggester::builtin();
        let names = PartNames { part: "armchair_02", material: "leather", group: "" };
        let reasons = suggester.reasons(&names, 5);
        assert!(reasons.iter().any(|(feature, weight)| feature == "word armchair" && *weight > 0.0), "{reasons:?}");
        assert!(reasons.iter().map(|r| r.1.abs()).is_sorted_by(|a, b| a >= b));
        assert!(suggester.reasons(&PartNames { part: "Mesh.001", ..names }, 41).is_empty());
        assert!(suggester.reasons(&PartNames::default(), 5).is_empty());
    }

    #[test]
    fn confidences_are_probabilities_and_alternatives_are_no_likelier() {
        for name in ["sofa", "floor lamp", "box", "thing", "bed pillow", "glass"] {
            let Some(found) = of(name, "") else { continue };
            assert!((0.0..=1.0).contains(&found.confidence) && found.alternatives.len() == MAX_ALTERNATIVES, "{found:?}");
            assert!(
                found.alternatives.iter().all(|&(class, p)| class != found.class && (0.0..=found.confidence).contains(&p)),
                "{found:?}"
            );
            assert!(found.alternatives.iter().map(|a| a.1).is_sorted_by(|a, b| a >= b), "{found:?}");
            let sum = found.confidence + found.alternatives.iter().map(|a| a.1).sum::<f32>();
            assert!(sum <= 1.0 + 1e-5, "{name}: {sum}");
        }
    }

    #[test]
    fn more_precision_asks_for_more_confidence() {
        let suggester = Suggester::builtin();
        let thresholds = [0.8, 0.85, 0.9, 0.95].map(|precision| suggester.min_confidence(precision).unwrap());
        assert!(thresholds.is_sorted() && thresholds.iter().all(|t| (0.0..=1.0).contains(t)), "{thresholds:?}");
        assert_eq!(suggester.min_confidence(0.999), None);
    }

    #[test]
    fn damaged_tables_are_told_with_file_and_line() {
        let message = |weights: &str| Suggester::from_tables(("w.csv", weights), CALIBRATION, THRESHOLDS).unwrap_err().to_string();
        assert!(message("").starts_with("w.csv:1: expected the columns feature, class, weight"));
        assert!(message("feature,class,weight\n").contains("w.csv:1: the table has no weights"));
        assert!(message("feature,class,weight\nword a,divan,1\n").starts_with("w.csv:2: unknown class \"divan\""));
        assert_eq!(message("feature,class,weight\nword a,bed,NaN\n"), "w.csv:2: weight \"NaN\" is no finite number");
        assert!(message("feature,class,weight\nword a,bed,1\nword a,bed,2\n").starts_with("w.csv:3: a second weight of \"word a\""));
        assert!(message("feature,class,weight\nword a,bed\n").starts_with("w.csv:2:"));
        let cut = &WEIGHTS.1[..WEIGHTS.1.len() - 12];
        assert!(Suggester::from_tables(("w.csv", cut), CALIBRATION, THRESHOLDS).is_err());
    }

    #[test]
    fn the_tables_are_as_they_would_be_written() {
        assert_eq!(Weights::parse(WEIGHTS.1, WEIGHTS.0).unwrap().to_csv(), WEIGHTS.1);
        assert_eq!(Calibration::parse(CALIBRATION.1, CALIBRATION.0).unwrap().to_csv(), CALIBRATION.1);
        assert_eq!(Thresholds::parse(THRESHOLDS.1, THRESHOLDS.0).unwrap().to_csv(), THRESHOLDS.1);
    }
}
