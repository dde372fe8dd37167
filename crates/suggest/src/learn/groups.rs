//! Tables of labelled names, and groups of names of a scene that differ only in their numbers.

use crate::lexicon::Lexicon;
use crate::table::TableError;
use crate::words::words;
use std::collections::BTreeMap;

const BLINDS: i16 = 13;
const CURTAIN: i16 = 16;

/// An object of a scene as a table of labelled names has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedObject {
    /// The scene.
    pub scene: String,
    /// Name of the object.
    pub name: String,
    /// NYU40 class, 1 to 40, or −1 when nobody labelled it.
    pub class: i16,
    /// Instance number, or −1.
    pub instance: i32,
}

/// The objects of a scene whose names have the same words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NameGroup {
    /// The scene.
    pub scene: String,
    /// The words, perhaps none.
    pub words: Vec<String>,
    /// Number of its objects by class; −1 for unlabelled ones.
    pub classes: BTreeMap<i16, usize>,
}

impl NameGroup {
    /// The number of objects with a class.
    pub fn labelled(&self) -> usize {
        self.classes.range(1..).map(|(_, n)| n).sum()
    }

    /// The number of objects of a class.
    pub fn of_class(&self, class: i16) -> usize {
        self.classes.get(&class).copied().unwrap_or(0)
    }
}

/// Reads a CSV table with the columns `scene`, `object_name`, `nyu40_id` and `instance_id`; others are ignored. `file` is what errors
/// call it.
///
/// # Errors
/// The first missing column or row that is no such object.
pub fn read_names(bytes: &[u8], file: &str) -> Result<Vec<NamedObject>, TableError> {
    let error = |line, problem: String| TableError { file: file.into(), line, problem };
    let mut reader = csv::ReaderBuilder::new().from_reader(bytes);
    let header = reader.headers().map_err(|e| error(1, e.to_string()))?.clone();
    let column = |name: &str| {
        let found = header.iter().position(|h| h == name);
        found.ok_or_else(|| error(1, format!("no column {name}; the header has {}", header.iter().collect::<Vec<_>>().join(", "))))
    };
    let [scene, name, class, instance] = ["scene", "object_name", "nyu40_id", "instance_id"].map(column);
    let (scene, name, class, instance) = (scene?, name?, class?, instance?);
    let rows = reader.into_records().map(|record| {
        let record = record.map_err(|e| error(e.position().map_or(1, csv::Position::line), e.to_string()))?;
        let line = record.position().map_or(1, csv::Position::line);
        let number = |column: usize, what: &str| {
            record[column].parse::<i32>().map_err(|_| error(line, format!("{what} {:?} is no whole number", &record[column])))
        };
        let class = number(class, "nyu40_id")?;
        let class = i16::try_from(class).ok().filter(|c| *c == -1 || (1..=40).contains(c));
        let class = class.ok_or_else(|| error(line, format!("nyu40_id is out of range: {:?}; expected 1 to 40, or -1", &record)))?;
        Ok(NamedObject { scene: record[scene].into(), name: record[name].into(), class, instance: number(instance, "instance_id")? })
    });
    rows.collect()
}

/// The groups of objects, sorted by scene and words.
pub fn group(objects: &[NamedObject]) -> Vec<NameGroup> {
    let mut groups: BTreeMap<(&str, Vec<String>), BTreeMap<i16, usize>> = BTreeMap::new();
    for object in objects {
        *groups.entry((&object.scene, words(&object.name))).or_default().entry(object.class).or_default() += 1;
    }
    groups.into_iter().map(|((scene, words), classes)| NameGroup { scene: scene.into(), words, classes }).collect()
}

/// The groups with curtains labelled as NYUv2 does: what is named a curtain, and labelled blinds, counts as curtain.
///
/// Hypersim has most of its curtains as blinds, which NYUv2 keeps apart; nobody who calls it a curtain would agree.
pub fn with_curtains(groups: &[NameGroup], lexicon: &Lexicon) -> Vec<NameGroup> {
    let read = |group: &NameGroup| {
        let mut group = group.clone();
        if lexicon.meanings(&group.words).last() == Some(&CURTAIN) {
            let blinds = group.classes.remove(&BLINDS);
            blinds.iter().for_each(|n| *group.classes.entry(CURTAIN).or_default() += n);
        }
        group
    };
    groups.iter().map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str =
        "scene,object_index,object_name,nyu40_id,instance_id\na,0,AI_chair_01,5,1\na,1,AI_chair_02,5,2\na,2,AI_chair_3,-1,-1\n";

    #[test]
    fn names_that_differ_in_numbers_are_one_group() {
        let groups = group(&read_names(TABLE.as_bytes(), "t").unwrap());
        assert_eq!(groups, [NameGroup { scene: "a".into(), words: vec!["chair".into()], classes: [(-1, 1), (5, 2)].into() }]);
        assert_eq!((groups[0].labelled(), groups[0].of_class(5), groups[0].of_class(6)), (2, 2, 0));
    }

    #[test]
    fn curtains_are_curtains_and_blinds_stay_blinds() {
        let group = |name: &str| NameGroup { scene: "a".into(), words: words(name), classes: [(-1, 1), (13, 2), (16, 3)].into() };
        let read = with_curtains(&[group("curtain_01"), group("roller blind")], &Lexicon::builtin().unwrap());
        assert_eq!(read[0].classes, [(-1, 1), (16, 5)].into());
        assert_eq!(read[1], group("roller blind"));
    }

    #[test]
    fn damage_is_told_with_its_line() {
        let message = |text: &str| read_names(text.as_bytes(), "t.csv").unwrap_err().to_string();
        assert!(message("scene,object_name\n").starts_with("t.csv:1: no column nyu40_id; the header has scene, object_name"));
        assert!(message(&TABLE.replace("-1,-1", "41,-1")).starts_with("t.csv:4: nyu40_id is out of range"));
        assert!(message(&TABLE.replace("5,2", "x,2")).starts_with("t.csv:3: nyu40_id \"x\" is no whole number"));
    }
}
