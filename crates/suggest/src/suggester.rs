//! The suggester computes a suggestion from a part's names: words, features, weights, probabilities, confidence, and the names around it.

use crate::calibration::{Calibration, Thresholds};
use crate::chain::{Level, Shares, mix};
use crate::features::features;
use crate::lexicon::Lexicon;
use crate::roles::{Role, Roles, halves};
use crate::table::TableError;
use crate::weights::{CLASSES, Weights, softmax};
use crate::words::{is_plural, words};
use enfilade_scene::{ObjectId, Part, Scene};
use std::collections::{BTreeSet, HashMap};

const WEIGHTS: (&str, &str) = ("data/weights.csv", include_str!("../data/weights.csv"));
const CALIBRATION: (&str, &str) = ("data/calibration.csv", include_str!("../data/calibration.csv"));
const THRESHOLDS: (&str, &str) = ("data/thresholds.csv", include_str!("../data/thresholds.csv"));
const SHARES: (&str, &str) = ("data/shares.csv", include_str!("../data/shares.csv"));
const AROUND: (&str, &str) = ("data/around.csv", include_str!("../data/around.csv"));
/// Alternatives that a suggestion may have.
const MAX_ALTERNATIVES: usize = 3;
/// Weight of a material's name relative to a part's: half, because it names what a thing is made of more often than what it is.
const MATERIAL_SHARE: f32 = 0.5;
/// Names around a part that are looked at, from the inside.
const MAX_LEVELS: usize = 8;
/// Number of classes of things in it, beside its own, from which a name counts as a collection.
const COLLECTION: usize = 4;
/// Wall, floor and ceiling: only places have them.
const SHELL: [i16; 3] = [1, 2, 22];

/// Finds the classes of names. The same names always get the same suggestion; no files are read and no state is kept.
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
    roles: Roles,
    calibration: Calibration,
    thresholds: Thresholds,
    shares: Shares,
    around: Calibration,
}

/// The names by which a part is judged. Any may be empty.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PartNames<'a> {
    /// The part's own name; text before a slash names the object around it, as in `object/part`.
    pub part: &'a str,
    /// Name of the part's material.
    pub material: &'a str,
    /// What it belongs to, outermost first, separated by slashes: parents in a hierarchy, groups.
    pub group: &'a str,
}

/// A class that a name may have.
#[derive(Clone, Debug, PartialEq)]
pub struct Suggestion {
    /// NYU40 class, 1 to 40.
    pub class: i16,
    /// Probability that it is right, from 0 to 1: among names with this confidence in held-out scenes, this share was right.
    pub confidence: f32,
    /// The object that the part belongs to, if that object's name decided: all parts with the same are one thing. Set only by
    /// [`Suggester::suggest_scene`].
    pub whole: Option<ObjectId>,
    /// Up to three other classes, the likeliest first, with their probabilities, none above `confidence`.
    pub alternatives: Vec<(i16, f32)>,
}

/// The levels of names that were around others.
type Known = HashMap<String, Option<Level>>;

impl Suggester {
    /// With the tables that come with the crate.
    ///
    /// # Panics
    /// When they are damaged, which the crate's tests exclude.
    pub fn builtin() -> Self {
        Self::from_tables([WEIGHTS, CALIBRATION, THRESHOLDS, SHARES, AROUND])
            .unwrap_or_else(|error| panic!("a table that was built in is damaged: {error}"))
    }

    /// With tables of your own, as learning writes them: weights, calibration, thresholds, shares, and the curve of names among others; of
    /// each what errors call it, and its text. The word lists are the crate's.
    ///
    /// # Errors
    /// The first row that is damaged.
    pub fn from_tables([weights, calibration, thresholds, shares, around]: [(&str, &str); 5]) -> Result<Self, TableError> {
        Ok(Self {
            weights: Weights::parse(weights.1, weights.0)?,
            lexicon: Lexicon::builtin()?,
            roles: Roles::builtin()?,
            calibration: Calibration::parse(calibration.1, calibration.0)?,
            thresholds: Thresholds::parse(thresholds.1, thresholds.0)?,
            shares: Shares::parse(shares.1, shares.0)?,
            around: Calibration::parse(around.1, around.0)?,
        })
    }

    /// With weights that were learned, before their precision is measured: the confidence is the model's own probability, and names around
    /// a part are not used.
    ///
    /// # Panics
    /// When the crate's list of roles is damaged, which its tests exclude.
    pub fn uncalibrated(weights: Weights, lexicon: Lexicon) -> Self {
        Self {
            weights,
            lexicon,
            roles: Roles::builtin().unwrap_or_else(|error| panic!("a table that was built in is damaged: {error}")),
            calibration: Calibration::identity(),
            thresholds: Thresholds::default(),
            shares: Shares::new([0.0; 4]),
            around: Calibration::identity(),
        }
    }

    /// The minimum confidence from which on at least the share `precision` of names is right, as measured in held-out volumes of
    /// scenes; 0.95 is the highest that is known. `None` where none is.
    pub fn min_confidence(&self, precision: f32) -> Option<f32> {
        self.thresholds.min_confidence(precision)
    }

    /// The suggestion for a part with these names; `None` if they have no known word.
    pub fn suggest(&self, names: &PartNames<'_>) -> Option<Suggestion> {
        let (own, around) = split(names);
        Some(self.suggest_knowing(own, names.material, &around, &mut HashMap::new())?.0)
    }

    /// The suggestion for a part with this name among the names around it, from the inside, and which of these decided, if one did. `known`
    /// caches names that were around others, because scenes repeat them.
    fn suggest_knowing(&self, own: &str, material: &str, around: &[&str], known: &mut Known) -> Option<(Suggestion, Option<usize>)> {
        let evidence = self.evidence(own, material);
        let levels = self.levels(&evidence, own, material, around, known);
        let (by, levels): (Vec<Option<usize>>, Vec<Level>) = levels.into_iter().unzip();
        let (probabilities, shares) = mix(&levels, &self.shares);
        if *shares.first()? >= 1.0 {
            return Some((Suggestion::of(&self.probabilities(&evidence)).calibrated(&self.calibration), None));
        }
        let found = Suggestion::of(&probabilities).calibrated(&self.around);
        let weight = |i: &usize| shares[*i] * levels[*i].probabilities[found.class as usize - 1];
        let decided = (0..levels.len()).max_by(|i, j| weight(i).total_cmp(&weight(j)))?;
        Some((found, by[decided]))
    }

    /// The evidence in these names for a class (above 0) or against it, the strongest first: features as
    /// [`features`](crate::features::features) writes them, and their weights, in natural logarithms of odds, as far as their name counts.
    pub fn reasons(&self, names: &PartNames<'_>, class: i16) -> Vec<(String, f32)> {
        let (own, around) = split(names);
        let mut evidence = self.evidence(own, names.material);
        let levels = self.levels(&evidence, own, names.material, &around, &mut HashMap::new());
        let (by, levels): (Vec<Option<usize>>, Vec<Level>) = levels.into_iter().unzip();
        let (_, shares) = mix(&levels, &self.shares);
        evidence.iter_mut().for_each(|(_, share)| *share *= shares.first().copied().unwrap_or(1.0));
        let outer = by.iter().zip(&shares).filter_map(|(by, share)| Some((features(&words(around[(*by)?]), &self.lexicon), *share)));
        let weighed = |(features, share): (Vec<String>, f32)| {
            features.into_iter().map(move |feature| {
                let weight = share * self.weights.of(&feature, class);
                (feature, weight)
            })
        };
        let mut reasons: Vec<_> = evidence.into_iter().chain(outer).flat_map(weighed).filter(|(_, weight)| *weight != 0.0).collect();
        reasons.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        reasons
    }

    /// The features of a part's own name and of its material's, of which anything is known, and how much each list counts.
    fn evidence(&self, own: &str, material: &str) -> Vec<(Vec<String>, f32)> {
        let own = words(own);
        let mut material = words(material);
        // Exporters often name a part after its material: that is one word, not two.
        material.retain(|word| !own.contains(word));
        let known = |words: &[String]| Some(features(words, &self.lexicon)).filter(|features| self.weights.knows(features));
        let own = known(&own);
        let share = if own.is_some() { MATERIAL_SHARE } else { 1.0 };
        own.map(|features| (features, 1.0)).into_iter().chain(known(&material).map(|features| (features, share))).collect()
    }

    /// The model's probabilities of the classes.
    fn probabilities(&self, evidence: &[(Vec<String>, f32)]) -> [f32; CLASSES] {
        let mut sums = self.weights.start();
        evidence.iter().for_each(|(features, share)| self.weights.add(features, *share, &mut sums));
        softmax(&sums)
    }

    /// The levels of a part and the index of the surrounding name of each, its own first. A part whose own names are unknown still has one
    /// if names around it are known.
    fn levels(
        &self,
        evidence: &[(Vec<String>, f32)],
        own: &str,
        material: &str,
        around: &[&str],
        known: &mut Known,
    ) -> Vec<(Option<usize>, Level)> {
        let mut outer: Vec<(Option<usize>, Level)> = Vec::new();
        let own_words = words(own);
        let piece_of_named = self.roles.is_piece_of_named(&own_words, &self.lexicon);
        let mut inside = own_words.clone();
        for (i, name) in around.iter().enumerate() {
            // A node and its mesh, a part and its object: one name, not two.
            let named = words(name);
            if inside == named || (inside.starts_with(&named) && !piece_of_named) {
                continue;
            }
            inside = named;
            if !known.contains_key(*name) {
                known.insert((*name).to_string(), self.level_around(name));
            }
            outer.extend(known.get(*name).cloned().flatten().map(|level| (Some(i), level)));
        }
        if evidence.is_empty() && outer.is_empty() {
            return Vec::new();
        }
        let material = words(material);
        // The wood of a table may be on a chair.
        let is_made_of = self.roles.is_piece_of_named(&material, &self.lexicon);
        let role = match (self.roles.of(&own_words, &self.lexicon), self.roles.of(&material, &self.lexicon)) {
            (Role::Filler | Role::Side | Role::Unlisted, Role::Thing(class)) if !is_made_of => Role::Thing(class),
            // A name without words is a filler: what is around it tells more than what it is made of.
            (Role::Unlisted, _) if own_words.is_empty() => Role::Filler,
            // The leg of a chair is a piece of the chair around it.
            (Role::Thing(class), _) if piece_of_named => Role::Piece { wholes: vec![class], alone: Some(class) },
            (role, _) => role,
        };
        let probabilities = self.calibration.apply(&self.probabilities(evidence));
        std::iter::once((None, Level { role, probabilities })).chain(outer).collect()
    }

    /// The level of a name around others, if it gives information about them.
    fn level_around(&self, name: &str) -> Option<Level> {
        self.level(&words(name)).map(|(role, p)| Level { role, probabilities: self.calibration.apply(&p) }).filter(Level::speaks)
    }

    /// The role of words, and the model's probabilities; `None` where nothing is known of them.
    pub(crate) fn level(&self, words: &[String]) -> Option<(Role, [f32; CLASSES])> {
        let features = features(words, &self.lexicon);
        let known = self.weights.knows(&features);
        known.then(|| (self.roles.of(words, &self.lexicon), self.probabilities(&[(features, 1.0)])))
    }

    /// Both halves of a name whose first half names a thing, the inner one first.
    pub(crate) fn halves(&self, words: &[String]) -> Option<[(Role, [f32; CLASSES]); 2]> {
        let (outer, inner) = halves(words, &self.lexicon, &self.roles)?;
        let within = self.level(inner).unwrap_or_else(|| (self.roles.of(inner, &self.lexicon), self.probabilities(&[])));
        Some([within, self.level(outer)?])
    }

    /// The suggestion for every part of a scene, in the order of `Scene::parts`, by its name, its material's name, and the names of its
    /// parents.
    ///
    /// # Panics
    /// When a part's material does not exist; a valid scene has none such.
    pub fn suggest_scene(&self, scene: &Scene) -> Vec<Option<Suggestion>> {
        let collections = self.collections(scene);
        let mut known = HashMap::new();
        let suggestion = |part: &Part| {
            let (own, path) = split(&PartNames { part: &part.name, ..PartNames::default() });
            let objects: Vec<ObjectId> =
                scene.objects_around(part).filter(|&object| !collections[object as usize]).take(MAX_LEVELS).collect();
            let lineage: Vec<&str> = objects.iter().map(|&object| scene.objects[object as usize].name.as_str()).collect();
            // A path in the part's name is used only if the file gives no parents.
            let path = if part.object.is_none() { path } else { Vec::new() };
            let around = [lineage, path].concat();
            let (suggestion, by) = self.suggest_knowing(own, &scene.materials[part.material as usize].name, &around, &mut known)?;
            let whole = by.filter(|&by| !is_plural(around[by])).and_then(|by| objects.get(by).copied());
            Some(Suggestion { whole: whole.filter(|whole| Some(*whole) != part.object), ..suggestion })
        };
        scene.parts.iter().map(suggestion).collect()
    }

    /// Which objects of a scene are collections: an object that contains walls, floors or ceilings, or things of several other classes, is
    /// not a thing itself, whatever its name (`coffee table scene`).
    fn collections(&self, scene: &Scene) -> Vec<bool> {
        let thing = |name: &str| match self.roles.of(&words(name), &self.lexicon) {
            Role::Thing(class) => Some(class),
            _ => None,
        };
        let own: Vec<Option<i16>> = scene.objects.iter().map(|object| thing(&object.name)).collect();
        let mut held: Vec<BTreeSet<i16>> = vec![BTreeSet::new(); scene.objects.len()];
        for part in &scene.parts {
            let name = part.name.rsplit('/').next().unwrap_or_default();
            part.object.into_iter().for_each(|object| held[object as usize].extend(thing(name)));
        }
        // Parents come before their children.
        for (i, object) in scene.objects.iter().enumerate().rev() {
            if let Some(parent) = object.parent {
                let inside: Vec<i16> = held[i].iter().copied().chain(own[i]).collect();
                held[parent as usize].extend(inside);
            }
        }
        let collection = |(held, own): (&BTreeSet<i16>, &Option<i16>)| {
            let others = held.iter().filter(|class| Some(**class) != *own);
            others.clone().count() >= COLLECTION || others.clone().any(|class| SHELL.contains(class))
        };
        held.iter().zip(&own).map(collection).collect()
    }
}

/// A part's own name, and the names around it, from the inside.
fn split<'a>(names: &PartNames<'a>) -> (&'a str, Vec<&'a str>) {
    let mut path = names.part.rsplit('/').chain(names.group.rsplit('/'));
    (path.next().unwrap_or_default(), path.filter(|name| !name.is_empty()).take(MAX_LEVELS).collect())
}

impl Suggestion {
    /// The likeliest classes.
    fn of(probabilities: &[f32; CLASSES]) -> Self {
        let mut order: Vec<usize> = (0..CLASSES).collect();
        order.sort_by(|&a, &b| probabilities[b].total_cmp(&probabilities[a]));
        let pair = |i: usize| (i as i16 + 1, probabilities[i]);
        let (class, confidence) = pair(order[0]);
        Self { class, confidence, whole: None, alternatives: order[1..=MAX_ALTERNATIVES].iter().map(|&i| pair(i)).collect() }
    }

    /// With a score turned into a confidence; the alternatives share what is left as before.
    pub(crate) fn calibrated(&self, calibration: &Calibration) -> Self {
        let confidence = calibration.confidence(self.confidence);
        let factor = (1.0 - confidence) / (1.0 - self.confidence).max(f32::EPSILON);
        let alternatives = self.alternatives.iter().map(|&(class, p)| (class, (p * factor).min(confidence))).collect();
        Self { class: self.class, confidence, whole: self.whole, alternatives }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::{NYU40, Object};

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
    fn names_that_say_nothing_leave_the_class_to_what_is_around_them_not_to_the_material() {
        let suggester = Suggester::builtin();
        let found = |part: &str, material: &str| {
            let found = suggester.suggest(&PartNames { part, material, group: "" }).unwrap();
            (NYU40[found.class as usize - 1].name, found.confidence)
        };
        // As Sketchfab, Blender, Maya, FBX and exporters of glTF name parts.
        for leaf in [
            "Object_11",
            "Mesh_3",
            "Mesh.001",
            "primitive_0",
            "node_7",
            "defaultMaterial",
            "polySurface12",
            "Geom_5",
            "Node.001_0",
            "lambert2SG",
        ] {
            for (around, expected) in [("Chair.000_30", "chair"), ("Sofa_2/Group_5", "sofa"), ("Table_4/RootNode", "table")] {
                let alone = found(around, "").1;
                for material in ["fabric", "wood", "Leather", "Material.001", "curtain_cloth"] {
                    let (class, confidence) = found(&format!("Sketchfab_model/{around}/{leaf}"), material);
                    assert!(class == expected && confidence >= 0.95 * alone, "{around}/{leaf} of {material}: {class} {confidence}");
                }
            }
        }
        // A material that is called like a thing alone, and one in a place, still tell.
        assert_eq!(found("Bed_2/Object_5", "pillow").0, "pillow");
        assert_eq!(found("Living room/Object_5", "Curtains"), found("Object_5", "Curtains"));
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
    fn pieces_are_what_they_are_pieces_of_and_things_are_what_they_are() {
        let suggester = Suggester::builtin();
        let class = |path: &str| {
            let found = suggester.suggest(&PartNames { part: path, ..PartNames::default() });
            found.map_or("nothing", |suggestion| NYU40[suggestion.class as usize - 1].name)
        };
        for (path, expected) in [
            ("Nightstand/door", "nightstand"),
            ("Nachttisch/Tür", "nightstand"),
            ("Chair 1/legs", "chair"),
            ("Chair 1/legs/Cylinder.003", "chair"),
            ("Sketchfab_model/chair.fbx/RootNode/Object_4", "chair"),
            ("Sofa/cushion", "sofa"),
            ("Sofa/pillow", "pillow"),
            ("Fridge/door", "refrigerator"),
            ("Kitchen/Cabinet_03/drawer", "cabinet"),
            ("Wardrobe/Door/Handle", "cabinet"),
            ("Armoire/Porte_gauche", "cabinet"),
            ("шкаф/дверь", "cabinet"),
            ("Bed/frame", "bed"),
            ("Table lamp/Shade", "lamp"),
            ("Window 2/glass", "window"),
            ("Window 2/Curtain", "curtain"),
            ("Bookshelf/shelf", "bookshelf"),
            ("Bookshelf/book_3", "books"),
            ("Picture/frame", "picture"),
            ("Table/Vase", "otherprop"),
            // Its parent is a place, or a thing that it cannot be a piece of.
            ("Wall_0_grp/Door2", "door"),
            ("Wall_0_grp/Door2/Handle", "door"),
            ("Living room/Table", "table"),
            ("Kitchen_grp/Door", "door"),
            ("House/Level 1/Bedroom/door", "door"),
            ("Bathroom/Sink", "sink"),
        ] {
            assert_eq!(class(path), expected, "{path}");
        }
        // A place adds nothing, and a thing is as sure as alone.
        let found = |path: &str| suggester.suggest(&PartNames { part: path, ..PartNames::default() });
        assert_eq!(found("Kitchen_grp/Door"), found("Door"));
        assert_eq!(found("Wall_0_grp/Door2"), found("Door2"));
        assert_eq!(found("Kitchen/Cube"), found("Cube"));
    }

    #[test]
    fn what_holds_walls_or_things_of_many_kinds_is_no_thing() {
        let object = |name: &str, parent| Object { name: name.into(), parent };
        let part = |name: &str, object| Part {
            name: name.into(),
            object: Some(object),
            mesh: 0,
            material: 0,
            world_from_mesh: enfilade_math::DAffine3::IDENTITY,
        };
        let material = enfilade_scene::Material::diffuse("grey", enfilade_math::Rgb::WHITE);
        let scene = |other: &str| Scene {
            objects: vec![object("coffee_table_scene", None), object("Cube.001", Some(0)), object(other, Some(0))],
            parts: vec![part("Cube.001", 1), part(other, 2)],
            materials: vec![material.clone()],
            ..Scene::default()
        };
        let cube = |other: &str| Suggester::builtin().suggest_scene(&scene(other))[0].clone().unwrap();
        let alone = of("Cube.001", "grey").unwrap();
        assert_eq!((cube("leg").class, cube("leg").whole), (7, Some(0)));
        assert_eq!(cube("Floor"), alone);
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
        let message =
            |weights: &str| Suggester::from_tables([("w.csv", weights), CALIBRATION, THRESHOLDS, SHARES, AROUND]).unwrap_err().to_string();
        assert!(message("").starts_with("w.csv:1: expected the columns feature, class, weight"));
        assert!(message("feature,class,weight\n").contains("w.csv:1: the table has no weights"));
        assert!(message("feature,class,weight\nword a,divan,1\n").starts_with("w.csv:2: unknown class \"divan\""));
        assert_eq!(message("feature,class,weight\nword a,bed,NaN\n"), "w.csv:2: weight \"NaN\" is no finite number");
        assert!(message("feature,class,weight\nword a,bed,1\nword a,bed,2\n").starts_with("w.csv:3: a second weight of \"word a\""));
        assert!(message("feature,class,weight\nword a,bed\n").starts_with("w.csv:2:"));
        let cut = &WEIGHTS.1[..WEIGHTS.1.len() - 12];
        assert!(Suggester::from_tables([("w.csv", cut), CALIBRATION, THRESHOLDS, SHARES, AROUND]).is_err());
    }

    #[test]
    fn the_tables_are_as_they_would_be_written() {
        assert_eq!(Weights::parse(WEIGHTS.1, WEIGHTS.0).unwrap().to_csv(), WEIGHTS.1);
        assert_eq!(Calibration::parse(CALIBRATION.1, CALIBRATION.0).unwrap().to_csv(), CALIBRATION.1);
        assert_eq!(Thresholds::parse(THRESHOLDS.1, THRESHOLDS.0).unwrap().to_csv(), THRESHOLDS.1);
        assert_eq!(Shares::parse(SHARES.1, SHARES.0).unwrap().to_csv(), SHARES.1);
        assert_eq!(Calibration::parse(AROUND.1, AROUND.0).unwrap().to_csv(), AROUND.1);
    }
}
