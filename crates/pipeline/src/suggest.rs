//! `suggest`: a label table of a scene file, from the names in it.

use crate::config::FileSource;
use crate::error::Error;
use crate::intake::load_file;
use crate::single::{refuse_overwriting, write_output};
use enfilade_import::Imported;
use enfilade_label::class_name;
use enfilade_scene::{Cx, ObjectId, Part, Scene, is_stuff};
use enfilade_suggest::{Suggester, Suggestion};
use std::collections::{BTreeMap, BTreeSet};
use std::io::ErrorKind;
use std::path::Path;

/// Share of the written classes that should be right, if no confidence is given.
const PRECISION: f32 = 0.9;

/// A suggested label table.
#[derive(Clone, Debug)]
pub struct SuggestedLabels {
    /// Number of parts of the scene.
    pub parts: usize,
    /// Minimum confidence with which a class was written.
    pub min_confidence: f32,
    /// How many parts got which class, by NYU40 number.
    pub classes: BTreeMap<i16, usize>,
    /// The parts that got none, in the order of the scene.
    pub unsure: Vec<UnsurePart>,
}

/// A part of unknown class.
#[derive(Clone, Debug)]
pub struct UnsurePart {
    /// Name of the part.
    pub part: String,
    /// Name of the part's material.
    pub material: String,
    /// The best guess, if its names give any information.
    pub guess: Option<Suggestion>,
}

/// Writes the label table `output` for the scene file of `source` (its path is used unchanged): a row per part, −1 where the confidence is
/// below `min_confidence`, from 0 to 1; by default, below the confidence at which nine of ten are right. An existing table that differs is
/// replaced only with `force`.
///
/// # Errors
/// When the confidence is out of range, the file cannot be imported, or the table is an input file, has other contents or cannot be
/// written.
pub fn suggest_labels(
    source: &FileSource,
    min_confidence: Option<f32>,
    output: &Path,
    force: bool,
    cx: &dyn Cx,
) -> Result<SuggestedLabels, Error> {
    let suggester = Suggester::builtin();
    let min_confidence = min_confidence.or_else(|| suggester.min_confidence(PRECISION)).unwrap_or(1.0);
    if !(0.0..=1.0).contains(&min_confidence) {
        return Err(Error::usage(format!("the least confidence is {min_confidence}"), "give a number from 0 to 1"));
    }
    let Imported { scene, inputs, .. } = load_file(source, Path::new(&source.file), &|path| Ok(path.into()), cx)?;
    refuse_overwriting(output, &inputs)?;
    let suggestions = suggester.suggest_scene(&scene);
    let table = table(&scene, &suggestions, min_confidence);
    if !force {
        refuse_another(output, &table)?;
    }
    write_output(output, table.as_bytes())?;
    let mut found = SuggestedLabels { parts: scene.parts.len(), min_confidence, classes: BTreeMap::new(), unsure: Vec::new() };
    for (part, suggestion) in scene.parts.iter().zip(suggestions) {
        match suggestion {
            Some(sure) if sure.confidence >= min_confidence => *found.classes.entry(sure.class).or_default() += 1,
            guess => {
                let material = scene.materials[part.material as usize].name.clone();
                found.unsure.push(UnsurePart { part: part.name.clone(), material, guess });
            }
        }
    }
    Ok(found)
}

/// Refuses to replace a file that is not `table`: people correct these by hand.
fn refuse_another(output: &Path, table: &str) -> Result<(), Error> {
    match std::fs::read(output) {
        Ok(there) if there == table.as_bytes() => Ok(()),
        Ok(_) => Err(Error::usage(
            format!("{} is there and differs from what is suggested; someone may have corrected it", output.display()),
            "name another file with -o, or replace it with --force",
        )),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        Err(error) => Err(Error::io("read", output)(error)),
    }
}

/// The table as `label` reads it, which ignores the last two columns: the confidence, and the class that it is for. The column `instance`
/// marks parts of several objects that are one thing; `label` numbers the others.
fn table(scene: &Scene, suggestions: &[Option<Suggestion>], min_confidence: f32) -> String {
    let mut text = String::from("part,nyu40_id,nyu40_name,instance,confidence,guess\n");
    let sure = |suggestion: &Option<Suggestion>| suggestion.clone().filter(|s| s.confidence >= min_confidence);
    let instances = instances(scene, &suggestions.iter().map(sure).collect::<Vec<_>>());
    for ((part, suggestion), instance) in scene.parts.iter().zip(suggestions).zip(instances) {
        let class = sure(suggestion).map_or(-1, |s| s.class);
        let (confidence, guess) = suggestion.as_ref().map_or((0.0, ""), |s| (s.confidence, class_name(s.class)));
        let instance = instance.map_or_else(String::new, |instance| instance.to_string());
        text.push_str(&format!("{},{class},{},{instance},{confidence:.3},{guess}\n", quoted(&part.name), class_name(class)));
    }
    text
}

/// The instance numbers of parts that are one thing although they are several objects: the doors and the body of a night stand.
fn instances(scene: &Scene, sure: &[Option<Suggestion>]) -> Vec<Option<i16>> {
    let thing = |(part, suggestion): (&Part, &Option<Suggestion>)| {
        let suggestion = suggestion.as_ref().filter(|s| !is_stuff(s.class))?;
        Some((suggestion.whole.or(part.object)?, suggestion.class))
    };
    let things: Vec<Option<(ObjectId, i16)>> = scene.parts.iter().zip(sure).map(thing).collect();
    let mut objects: BTreeMap<(ObjectId, i16), BTreeSet<ObjectId>> = BTreeMap::new();
    for (part, thing) in scene.parts.iter().zip(&things) {
        thing.zip(part.object).into_iter().for_each(|(thing, object)| _ = objects.entry(thing).or_default().insert(object));
    }
    let mut numbers: BTreeMap<(ObjectId, i16), Option<i16>> = BTreeMap::new();
    let mut next = 1..=i16::MAX;
    let number = |thing: &Option<(ObjectId, i16)>| {
        let thing = thing.filter(|thing| objects[thing].len() > 1)?;
        *numbers.entry(thing).or_insert_with(|| next.next())
    };
    things.iter().map(number).collect()
}

/// A CSV field, in quotes where it needs them.
fn quoted(field: &str) -> String {
    let plain = !field.contains(['"', ',', '\n', '\r']) && field.trim() == field && !field.is_empty();
    if plain { field.to_string() } else { format!("\"{}\"", field.replace('"', "\"\"")) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_label::LabelTable;
    use enfilade_scene::{Material, Object, Part};

    #[test]
    fn the_table_is_one_that_label_reads_and_the_unsure_are_not_guessed() {
        let part =
            |name: &str| Part { name: name.into(), object: None, mesh: 0, material: 0, world_from_mesh: enfilade_math::DAffine3::IDENTITY };
        let parts = ["sofa \"big\", red", "Mesh.001", "thing"].map(part).to_vec();
        let scene = Scene { parts, materials: vec![Material::diffuse("grey", enfilade_math::Rgb::WHITE)], ..Scene::default() };
        let suggestion = |class, confidence| Some(Suggestion { class, confidence, whole: None, alternatives: Vec::new() });
        let text = table(&scene, &[suggestion(6, 0.93), None, suggestion(40, 0.3)], 0.9);
        assert!(text.ends_with("Mesh.001,-1,unlabelled,,0.000,\nthing,-1,unlabelled,,0.300,otherprop\n"), "{text}");
        let (labels, report) = LabelTable::parse(text.as_bytes(), "t").unwrap().assign("any", &scene);
        assert_eq!(labels.parts.iter().map(|label| label.semantic).collect::<Vec<_>>(), [6, -1, -1]);
        assert!(report.unmatched.is_empty());
    }

    #[test]
    fn parts_with_the_class_of_what_they_lie_in_are_one_instance_and_others_have_their_own() {
        let object = |name: &str, parent| Object { name: name.into(), parent };
        let part = |name: &str, object| Part {
            name: name.into(),
            object: Some(object),
            mesh: 0,
            material: 0,
            world_from_mesh: enfilade_math::DAffine3::IDENTITY,
        };
        let objects = vec![
            object("Bedroom", None),
            object("Nightstand", Some(0)),
            object("door", Some(1)),
            object("Chair 1", Some(0)),
            object("legs", Some(3)),
            object("Cube.004", Some(3)),
            object("Wall_0_grp", Some(0)),
            object("Door2", Some(6)),
            object("Lamps", Some(0)),
            object("Cube.001", Some(8)),
            object("Cube.002", Some(8)),
            object("Sofa", Some(0)),
            object("Sofa_seat", Some(11)),
            object("Sofa_Wood_0", Some(11)),
        ];
        let names = [("Nightstand", 1), ("door", 2), ("legs", 4), ("Cube.004", 5), ("Door2", 7), ("Cube.001", 9), ("Cube.002", 10)];
        let names = [names.as_slice(), &[("Sofa_seat", 12), ("Sofa_Wood_0", 13)]].concat();
        let scene = Scene {
            parts: names.iter().map(|&(name, object)| part(name, object)).collect(),
            objects,
            materials: vec![Material::diffuse("grey", enfilade_math::Rgb::WHITE)],
            ..Scene::default()
        };
        let suggester = Suggester::builtin();
        let text = table(&scene, &suggester.suggest_scene(&scene), 0.6);
        let labels = LabelTable::parse(text.as_bytes(), "t").unwrap().assign("any", &scene).0;
        let found: Vec<_> = labels.parts.iter().map(|label| (label.semantic, label.instance)).collect();
        // Two parts of a night stand, two of a chair, a door in a wall, two lamps, and two parts of a sofa.
        assert_eq!(found, [(32, 1), (32, 1), (5, 2), (5, 2), (8, 4), (35, 5), (35, 6), (6, 3), (6, 3)], "{text}");
    }
}
