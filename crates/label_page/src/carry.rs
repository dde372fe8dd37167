//! Labels of an earlier version of a scene, carried over to the parts of this one by their names and shapes.
//!
//! A part keeps its label if one of the same name is here, or, for those whose name is gone, one of the same shape that is the only one, or
//! that is at the same place. What is carried over and what is not is listed in a table.

use super::earlier::{CarryError, Old, earlier};
use super::part_shapes::PartShape;
use enfilade_dataset::{ANNOTATION_LOG, DatasetError, write_bytes};
use enfilade_scene::PartLabel;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};

/// Name of the list in the folder of labels.
pub const CARRIED: &str = "labels_carried.csv";
/// A part whose name is gone is at the same place if its mean has moved by at most this, metres.
const SAME_PLACE_M: f64 = 0.01;

/// How a part got its label, or why not.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum How {
    NameAndShape,
    Name,
    ShapeAndPlace,
    Shape,
    Mixed,
    Lost,
}

impl How {
    fn words(self) -> &'static str {
        match self {
            Self::NameAndShape => "by name and shape",
            Self::Name => "by name; its shape differs or is not known",
            Self::ShapeAndPlace => "by shape and place; its name differs",
            Self::Shape => "by shape; name and place differ",
            Self::Mixed => "not: it was split, and its pieces have several labels",
            Self::Lost => "not: no part has its name or shape",
        }
    }
}

/// What is carried over.
pub struct Carried {
    /// Parts of this scene, and the label of each.
    pub labels: Vec<(u32, PartLabel)>,
    /// For people: how many there are of each kind.
    pub summary: String,
    /// The table.
    list: String,
}

impl Carried {
    /// Finds parts for the labels in the folder `from`.
    ///
    /// # Errors
    /// When it has no labels, or they cannot be read.
    pub fn find(from: &Path, parts: &[PartShape]) -> Result<Self, CarryError> {
        let old = earlier(from)?;
        let found = matches(&old, parts);
        let mut list = csv::Writer::from_writer(Vec::new());
        let mut row = |fields: [&str; 5]| list.write_record(fields).expect("writing to memory cannot fail");
        row(["earlier_name", "object_name", "semantic", "instance", "carried"]);
        let (mut labels, mut counts): (Vec<(u32, PartLabel)>, BTreeMap<How, usize>) = (Vec::new(), BTreeMap::new());
        for (old, (how, part)) in old.iter().zip(&found) {
            *counts.entry(*how).or_default() += 1;
            let PartLabel { semantic, instance } = old.label;
            let [semantic, instance] = [semantic, instance].map(|id| id.to_string());
            let name = part.map_or("", |part: u32| parts[part as usize].name.as_str());
            row([&old.name, name, &semantic, &instance, how.words()]);
            labels.extend(part.map(|part| (part, old.label)));
        }
        let taken: HashSet<u32> = labels.iter().map(|(part, _)| *part).collect();
        for (_, part) in (0..).zip(parts).filter(|(number, _)| !taken.contains(number)) {
            row(["", &part.name, "", "", "no label for it"]);
        }
        let counted: Vec<String> = counts.iter().map(|(how, count)| format!("{count} {}", how.words())).collect();
        let summary = format!("labels of {} of {} parts are carried over: {}", labels.len(), old.len(), counted.join(", "));
        Ok(Self { labels, summary, list: String::from_utf8_lossy(&list.into_inner().expect("flushing memory cannot fail")).into_owned() })
    }

    /// Writes the list into the folder of labels.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, DatasetError> {
        let path = folder.join(CARRIED);
        write_bytes(&path, self.list.as_str()).map(|()| path)
    }
}

/// A row of the list: an earlier label, or a part that got none.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CarriedRow {
    /// The part's name in the earlier version; empty for a part that got no label.
    pub earlier_name: String,
    /// The part that got the label; empty where none did.
    pub object_name: String,
    /// Class; empty for a part that got no label.
    pub semantic: String,
    /// Instance; empty for a part that got no label.
    pub instance: String,
    /// How the label was carried over, or why not.
    pub carried: String,
}

/// The list in a folder of labels; empty where there is none.
///
/// # Errors
/// When the file cannot be read, or is no such list.
pub fn rows(folder: &Path) -> Result<Vec<CarriedRow>, String> {
    let path = folder.join(CARRIED);
    let bytes = match std::fs::read(&path) {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        bytes => bytes.map_err(|e| format!("cannot read {}: {e}", path.display()))?,
    };
    let rows: Result<_, csv::Error> = csv::Reader::from_reader(bytes.as_slice()).deserialize().collect();
    rows.map_err(|e| format!("{}: {e}; remove the file, which nothing needs", path.display()))
}

/// Moves the log of an earlier version out of the way, so that one for this version can begin.
///
/// # Errors
/// When it cannot be moved.
pub fn set_aside(folder: &Path) -> Result<(), DatasetError> {
    let log = folder.join(ANNOTATION_LOG);
    let free = (1u32..).map(|number| folder.join(format!("annotation_log_{number}.jsonl"))).find(|path| !path.exists());
    match free.filter(|_| log.is_file()) {
        Some(to) => std::fs::rename(&log, to).map_err(|source| DatasetError::Io { action: "move", path: log, source }),
        None => Ok(()),
    }
}

/// The part for each earlier part.
fn matches(old: &[Old], parts: &[PartShape]) -> Vec<(How, Option<u32>)> {
    let by_name: HashMap<&str, u32> = (0..).zip(parts).map(|(number, part)| (part.name.trim(), number)).collect();
    let is_like = |old: &Old, part: u32| old.known.as_ref().is_some_and(|known| known.shape.is_like(&parts[part as usize].shape));
    let mut found: Vec<(How, Option<u32>)> = Vec::new();
    let mut taken: HashSet<u32> = HashSet::new();
    for one in old {
        let part = by_name.get(one.name.trim()).copied();
        taken.extend(part);
        found.push(match part {
            _ if one.is_mixed => (How::Mixed, None),
            Some(part) if is_like(one, part) => (How::NameAndShape, Some(part)),
            Some(part) => (How::Name, Some(part)),
            None => (How::Lost, None),
        });
    }
    // Parts of the same shape and place first, then those that are the only ones of their shape on both sides.
    for how in [How::ShapeAndPlace, How::Shape] {
        let lost: Vec<usize> = (0..old.len()).filter(|&i| found[i].0 == How::Lost).collect();
        let candidates = |i: usize, taken: &HashSet<u32>| -> Vec<u32> {
            let near = |part: u32| {
                how == How::Shape || old[i].known.as_ref().is_some_and(|k| k.place.distance(parts[part as usize].place) <= SAME_PLACE_M)
            };
            (0..parts.len() as u32).filter(|part| !taken.contains(part) && is_like(&old[i], *part) && near(*part)).collect()
        };
        for &i in &lost {
            let rivals = lost.iter().filter(|&&other| other != i && found[other].0 == How::Lost && alike(&old[i], &old[other])).count();
            if let [only] = candidates(i, &taken)[..]
                && (how == How::ShapeAndPlace || rivals == 0)
            {
                taken.insert(only);
                found[i] = (how, Some(only));
            }
        }
    }
    found
}

fn alike(a: &Old, b: &Old) -> bool {
    a.known.as_ref().zip(b.known.as_ref()).is_some_and(|(a, b)| a.shape.is_like(&b.shape))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::ShapeInvariants;
    use enfilade_math::DVec3;

    fn part(name: &str, size: f64, x: f64) -> PartShape {
        PartShape { name: name.into(), shape: ShapeInvariants::of_numbers(12, [size, size, size]), place: DVec3::new(x, 0.0, 0.0) }
    }

    #[test]
    fn labels_find_their_parts_by_name_and_by_shape() {
        let before =
            [part("chair_1", 1.0, 0.0), part("chair_2", 1.0, 2.0), part("table", 2.0, 4.0), part("sofa", 3.0, 6.0), part("lamp", 4.0, 8.0)];
        let old: Vec<Old> = (1..)
            .zip(&before)
            .map(|(class, part)| Old {
                name: part.name.clone(),
                known: Some(part.clone()),
                label: PartLabel { semantic: class, instance: -1 },
                is_mixed: false,
            })
            .collect();
        // A chair is renamed, the other one gone; the table has another shape, the sofa other name and place, the lamp is no more.
        let now = [part("stool_7", 1.0, 2.0), part("table", 2.5, 4.0), part("couch", 3.0, 9.0), part("vase", 5.0, 0.0)];
        let found: Vec<_> = matches(&old, &now).into_iter().map(|(how, part)| (how.words(), part)).collect();
        let words = |how: How, part| (how.words(), part);
        assert_eq!(
            found,
            [
                words(How::Lost, None),
                words(How::ShapeAndPlace, Some(0)),
                words(How::Name, Some(1)),
                words(How::Shape, Some(2)),
                words(How::Lost, None)
            ]
        );
    }
}
