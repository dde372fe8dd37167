//! The classes that labels choose from: NYU40, or a list of the user's, `semantic_label_descs.csv` of the mesh folder.

use crate::{DatasetError, MeshFiles, write_bytes};
use enfilade_scene::{NYU40, decoded_text};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// The user's own list of classes in the mesh folder, where the labels choose from one.
pub const CLASS_LIST: &str = "semantic_label_descs.csv";
/// Columns of the list, as in Hypersim.
const COLUMNS: [&str; 5] = ["semantic_id", "semantic_name", "semantic_color_r", "semantic_color_g", "semantic_color_b"];

/// A class that a part can have.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Class {
    /// From 1.
    pub id: i16,
    /// Name of the class, unique in the list.
    pub name: String,
    /// Display colour, sRGB.
    pub color: [u8; 3],
}

/// A list of classes, by ascending id.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Classes {
    list: Vec<Class>,
}

impl MeshFiles {
    /// The user's own list as it is stored, whether or not the labels were made with it; `None` where there is none.
    ///
    /// # Errors
    /// As [`Classes::read`].
    pub fn read_own_classes(&self) -> Result<Option<Classes>, DatasetError> {
        match Classes::read(&self.file(CLASS_LIST)) {
            Ok(classes) => Ok(Some(classes)),
            Err(error) if error.is_not_found() => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// The user's own list that the labels choose from; `None` where they choose from NYU40. A list that ends elsewhere than the labels'
    /// colours is left over: they were made from another since.
    ///
    /// # Errors
    /// As [`Classes::read`], and when the table of colours is damaged.
    pub fn read_classes(&self) -> Result<Option<Classes>, DatasetError> {
        let Some(own) = self.read_own_classes()? else { return Ok(None) };
        let last = self.read_last_class()?;
        Ok(Some(own).filter(|own| own.list.last().is_some_and(|class| class.id == last)))
    }

    /// Writes a list of the user's own, and returns the file.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_classes(&self, classes: &Classes) -> Result<PathBuf, DatasetError> {
        let path = self.file(CLASS_LIST);
        write_bytes(&path, classes.to_csv()).map(|()| path)
    }
}

impl Classes {
    /// The forty classes of NYUv2 in Hypersim's colours.
    pub fn nyu40() -> Self {
        let class = |class: &enfilade_scene::SemanticClass| Class { id: class.id, name: class.name.into(), color: class.color };
        Self { list: NYU40.iter().map(class).collect() }
    }

    /// Reads a list in the form of Hypersim's `semantic_label_descs.csv`.
    ///
    /// # Errors
    /// When the file cannot be read, a column is missing, an id is below 1, beyond int16 or there twice, or a colour is not 0 to 255.
    pub fn read(file: &Path) -> Result<Self, DatasetError> {
        let bytes = std::fs::read(file).map_err(|source| DatasetError::Io { action: "read", path: file.into(), source })?;
        Self::parse(&bytes).map_err(|problem| DatasetError::Text {
            path: file.into(),
            problem: format!("{problem}; expected the columns {}, as in Hypersim's {CLASS_LIST}", COLUMNS.join(", ")),
        })
    }

    fn parse(bytes: &[u8]) -> Result<Self, String> {
        let text = decoded_text(bytes);
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).flexible(true).from_reader(text.as_bytes());
        let header = reader.headers().map_err(|e| e.to_string())?.clone();
        let column =
            |name: &str| header.iter().position(|h| h.eq_ignore_ascii_case(name)).ok_or_else(|| format!("line 1: no column {name:?}"));
        let [id, name, red, green, blue] = COLUMNS;
        let (id, name, rgb) = (column(id)?, column(name)?, [column(red)?, column(green)?, column(blue)?]);
        let mut classes = BTreeMap::new();
        for record in reader.records() {
            let record = record.map_err(|e| e.to_string())?;
            let line = record.position().map_or(0, csv::Position::line);
            if record.iter().all(str::is_empty) {
                continue;
            }
            let cell = |column: usize| record.get(column).unwrap_or("");
            // A column with gaps is one of floats in many programs.
            let whole = |column: usize| cell(column).strip_suffix(".0").unwrap_or(cell(column));
            let wrong = |what: &str, found: &str, expected: &str| format!("line {line}: {what} is {found:?}, expected {expected}");
            let number = whole(id).parse::<i16>().ok().filter(|id| *id >= 1);
            let number = number.ok_or_else(|| wrong("semantic_id", cell(id), "1 to 32767"))?;
            if cell(name).is_empty() {
                return Err(wrong("semantic_name", "", "a name"));
            }
            let mut color = [0; 3];
            for (channel, &column) in color.iter_mut().zip(&rgb) {
                *channel = whole(column).parse().map_err(|_| wrong("the colour", cell(column), "0 to 255"))?;
            }
            if classes.insert(number, Class { id: number, name: cell(name).into(), color }).is_some() {
                return Err(format!("line {line}: semantic_id {number} is there twice"));
            }
        }
        if classes.is_empty() {
            return Err("it has no classes".into());
        }
        Ok(Self { list: classes.into_values().collect() })
    }

    /// The list in the form of Hypersim's `semantic_label_descs.csv`.
    fn to_csv(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let mut write = |fields: &[&str]| writer.write_record(fields).expect("writing to memory cannot fail");
        write(&COLUMNS);
        for Class { id, name, color } in &self.list {
            let [r, g, b] = color.map(|channel| channel.to_string());
            write(&[&id.to_string(), name, &r, &g, &b]);
        }
        String::from_utf8(writer.into_inner().expect("flushing memory cannot fail")).expect("names are UTF-8")
    }

    /// All classes.
    pub fn list(&self) -> &[Class] {
        &self.list
    }

    /// True for the forty of NYUv2, by number and name.
    pub fn are_nyu40(&self) -> bool {
        self.list.len() == NYU40.len() && self.list.iter().zip(&NYU40).all(|(a, b)| a.id == b.id && a.name == b.name)
    }

    /// The name of a class; "no class" for −1, and the number where the list has none.
    pub fn name(&self, id: i16) -> String {
        match self.list.iter().find(|class| class.id == id) {
            Some(class) => class.name.clone(),
            None if id == -1 => "no class".into(),
            None => id.to_string(),
        }
    }

    /// Checks that labels may have this class.
    ///
    /// # Errors
    /// What was found and what is allowed.
    pub fn check(&self, id: i64) -> Result<i16, String> {
        let known = i16::try_from(id).ok().filter(|id| *id == -1 || self.list.iter().any(|class| class.id == *id));
        known.ok_or_else(|| {
            let mut expected = String::new();
            let (first, last) = (self.list.first().map_or(1, |c| c.id), self.list.last().map_or(1, |c| c.id));
            let _ = write!(expected, "one of the list's {} classes from {first} to {last}, or -1 for none", self.list.len());
            format!("there is no class {id}; expected {expected}")
        })
    }

    /// Display colours as in `metadata_semantic_colors.hdf5`: row `i` is class `i`; row 0 and numbers without a class are −1.
    pub fn color_rows(&self) -> Vec<[i64; 3]> {
        let mut rows = vec![[-1; 3]; self.list.last().map_or(1, |class| class.id as usize + 1)];
        self.list.iter().for_each(|class| rows[class.id as usize] = class.color.map(i64::from));
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hypersims_form_is_read_and_written() {
        let text = "semantic_id , semantic_name  , semantic_color_r , semantic_color_g , semantic_color_b\n\
            2           , fridge, left  , 1 , 2 , 3\n";
        assert!(Classes::parse(text.as_bytes()).is_err());
        let text = text.replace("fridge, left", "plant");
        let classes = Classes::parse(text.as_bytes()).unwrap();
        assert_eq!(classes.list(), [Class { id: 2, name: "plant".into(), color: [1, 2, 3] }]);
        assert_eq!(Classes::parse(classes.to_csv().as_bytes()).unwrap(), classes);
        assert_eq!(classes.color_rows(), [[-1; 3], [-1; 3], [1, 2, 3]]);
        assert_eq!((classes.check(2), classes.check(-1)), (Ok(2), Ok(-1)));
        assert!(classes.check(1).unwrap_err().starts_with("there is no class 1; expected one of the list's 1 classes"));
        let nyu = Classes::nyu40();
        assert_eq!(Classes::parse(nyu.to_csv().as_bytes()).unwrap(), nyu);
        assert!(nyu.are_nyu40() && !classes.are_nyu40());
        assert_eq!(nyu.color_rows(), crate::semantic_colors());
    }

    #[test]
    fn bad_lists_are_told_by_line() {
        let message = |rows: &str| Classes::parse(format!("{}\n{rows}", COLUMNS.join(",")).as_bytes()).unwrap_err();
        assert_eq!(message("0,a,1,2,3\n"), "line 2: semantic_id is \"0\", expected 1 to 32767");
        assert_eq!(message("1,a,1,2,3\n1,b,1,2,3\n"), "line 3: semantic_id 1 is there twice");
        assert_eq!(message("1,a,1,2,256\n"), "line 2: the colour is \"256\", expected 0 to 255");
        assert_eq!(message(""), "it has no classes");
        assert_eq!(Classes::parse(b"id,name\n").unwrap_err(), "line 1: no column \"semantic_id\"");
    }
}
