//! `assets.toml` beside the models: data that their files do not have.
//!
//! ```toml
//! licence = "CC0 1.0"                 # of all models, like the other keys out here
//! front = "+z"
//!
//! [models."chairs/chair_07.glb"]      # a file's path from here, or a piece's name in a catalogue
//! family = "armchair"                 # or class = "chair"
//! size = [0.8, 0.85, 0.9]
//! weight = 2
//! ```

use crate::error::Error;
use enfilade_furniture::assets::families_of;
use enfilade_furniture::{FAMILIES, Place};
use enfilade_math::{DMat3, DVec3, Vec3};
use enfilade_options::closest;
use enfilade_scene::{NYU40, decoded_text};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Name of the table.
pub(super) const NAME: &str = "assets.toml";

/// The axis of a file, whose y points up, that a model's front looks along.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub(super) enum Front {
    /// +z is the front, as in glTF.
    #[default]
    #[serde(rename = "+z")]
    Z,
    #[serde(rename = "-z")]
    MinusZ,
    #[serde(rename = "+x")]
    X,
    #[serde(rename = "-x")]
    MinusX,
}

impl Front {
    /// Turns a scene with z up, as importers make it, so that its front looks along +y.
    pub fn turn(self) -> DMat3 {
        // Importers take (x, y, z) to (x, −z, y).
        let (x, y) = match self {
            Self::Z => (DVec3::NEG_X, DVec3::NEG_Y),
            Self::MinusZ => (DVec3::X, DVec3::Y),
            Self::X => (DVec3::Y, DVec3::NEG_X),
            Self::MinusX => (DVec3::NEG_Y, DVec3::X),
        };
        DMat3::from_cols(x, y, DVec3::Z)
    }

    /// Width, depth and height, seen from this front, of what has `size` seen from +z.
    pub fn turned(self, size: Vec3) -> Vec3 {
        match self {
            Self::Z | Self::MinusZ => size,
            Self::X | Self::MinusX => Vec3::new(size.y, size.x, size.z),
        }
    }
}

/// The support of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Stands {
    Floor,
    Wall,
    Ceiling,
    Surface,
}

impl Stands {
    fn allows(self, place: Place) -> bool {
        match place {
            Place::AgainstWall => matches!(self, Self::Floor | Self::Wall),
            Place::Free | Place::Corner | Place::Underfoot => self == Self::Floor,
            Place::OnWall => self == Self::Wall,
            Place::Ceiling => self == Self::Ceiling,
            Place::OnSurface => self == Self::Surface,
        }
    }
}

/// Keys for one model, and for all.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    family: Option<String>,
    class: Option<String>,
    size: Option<[f32; 3]>,
    front: Option<Front>,
    stands: Option<Stands>,
    weight: Option<f32>,
    licence: Option<String>,
    #[serde(rename = "use")]
    wanted: Option<bool>,
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    front: Option<Front>,
    licence: Option<String>,
    #[serde(default)]
    models: BTreeMap<String, Entry>,
}

/// A table that has been read and checked.
#[derive(Clone, Debug, Default)]
pub(super) struct Table(Document);

/// The table's settings for one model, its own and the defaults.
pub(super) struct Choice {
    /// The families that it may replace; `None` if the table does not state them.
    pub families: Option<Vec<&'static str>>,
    /// Width, depth and height, metres.
    pub size: Option<Vec3>,
    pub front: Front,
    pub weight: f32,
    /// Licence of this model in the table.
    pub licence: Option<String>,
    /// Licence in the table for all models without their own.
    pub licence_of_all: Option<String>,
    /// False if it must not be used.
    pub wanted: bool,
    stands: Option<Stands>,
}

impl Choice {
    /// The families from the table, or else from the words of `name`.
    pub fn families_or(&self, name: &str) -> Vec<&'static str> {
        let by_name = || families_of(name).iter().copied().filter(|family| allowed(family, self.stands)).collect();
        self.families.clone().unwrap_or_else(by_name)
    }
}

fn allowed(family: &str, stands: Option<Stands>) -> bool {
    stands.is_none_or(|stands| FAMILIES.iter().any(|f| f.name == family && stands.allows(f.place)))
}

impl Table {
    /// Reads the table of a library with models of these names; an empty one if there is no table.
    ///
    /// # Errors
    /// When it is not TOML, has an unknown key, family, class or model, or a number out of its domain. In a table that is `whole`,
    /// every entry must be about a model that there is.
    pub fn read(file: &Path, models: &[&str], whole: bool) -> Result<Self, Error> {
        let bytes = match std::fs::read(file) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Self::default()),
            Err(error) => return Err(Error::io("read", file)(error)),
        };
        let (at, text) = (file.display(), decoded_text(&bytes));
        let hint = "docs/homes.md has an example of assets.toml";
        let document: Document = toml::from_str(&text).map_err(|error| Error::usage(format!("{at}: {error}"), hint))?;
        for (name, entry) in &document.models {
            let refuse = |problem: String, hint: String| Err(Error::usage(format!("{at}: model {name:?}: {problem}"), hint));
            if whole && !models.contains(&name.as_str()) {
                let hint = closest(name, models)
                    .map_or("write its path from assets.toml, with /".into(), |near| format!("did you mean {near:?}?"));
                return refuse("there is no such model".into(), hint);
            }
            if let Some((problem, hint)) = entry.problem() {
                return refuse(problem, hint);
            }
        }
        Ok(Self(document))
    }

    /// The table's settings for the model of this name.
    pub fn of(&self, name: &str) -> Choice {
        let entry = self.0.models.get(name).cloned().unwrap_or_default();
        Choice {
            families: entry.families(),
            size: entry.size.map(Vec3::from_array),
            front: entry.front.or(self.0.front).unwrap_or_default(),
            weight: entry.weight.unwrap_or(1.0),
            licence: entry.licence,
            licence_of_all: self.0.licence.clone(),
            wanted: entry.wanted.unwrap_or(true),
            stands: entry.stands,
        }
    }
}

impl Entry {
    fn families(&self) -> Option<Vec<&'static str>> {
        let class = self.class.as_ref().and_then(|class| NYU40.iter().find(|c| c.name.eq_ignore_ascii_case(class)));
        let meant = |family: &&enfilade_furniture::Family| match (&self.family, class) {
            (Some(name), _) => family.name == name,
            (None, Some(class)) => family.class as i16 == class.id && allowed(family.name, self.stands),
            (None, None) => false,
        };
        let said = self.family.is_some() || self.class.is_some();
        said.then(|| FAMILIES.iter().filter(meant).map(|family| family.name).collect())
    }

    /// The problem with it, if any, and what to do.
    fn problem(&self) -> Option<(String, String)> {
        let unknown = |what: &str, found: &str, known: &[&str]| {
            let near = closest(found, known).map(|near| format!("did you mean {near:?}? "));
            (format!("unknown {what} {found:?}"), format!("{}known are: {}", near.unwrap_or_default(), known.join(", ")))
        };
        let families: Vec<&str> = FAMILIES.iter().map(|f| f.name).collect();
        if let Some(family) = self.family.as_ref().filter(|family| !families.contains(&family.as_str())) {
            return Some(unknown("family", family, &families));
        }
        if let Some(class) = &self.class
            && self.families().is_none_or(|families| families.is_empty())
        {
            let mut classes: Vec<&str> = NYU40.iter().filter(|c| FAMILIES.iter().any(|f| f.class as i16 == c.id)).map(|c| c.name).collect();
            classes.dedup();
            if !classes.iter().any(|known| known.eq_ignore_ascii_case(class)) {
                return Some(unknown("class", class, &classes));
            }
            return Some((format!("no thing of class {class:?} can be placed that way"), "correct `stands`, or leave it out".into()));
        }
        if let Some(size) = self.size.filter(|size| !size.iter().all(|v| v.is_finite() && *v > 0.0)) {
            return Some((format!("size is {size:?}"), "give width, depth and height in metres, each above zero".into()));
        }
        let weight = self.weight.filter(|weight| !(weight.is_finite() && *weight > 0.0));
        weight.map(|weight| (format!("weight is {weight}"), "give a number above zero, or `use = false`".into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Table, Error> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join(NAME);
        std::fs::write(&file, text).unwrap();
        Table::read(&file, &["a.glb", "stool.gltf"], true)
    }

    #[test]
    fn entries_say_what_a_model_is_and_defaults_hold_for_the_others() {
        let table =
            read("licence = \"CC0\"\nfront = \"-x\"\n[models.\"a.glb\"]\nclass = \"sofa\"\nfront = \"+x\"\nsize = [2, 1, 0.8]\n").unwrap();
        let a = table.of("a.glb");
        assert!(a.families_or("chair").contains(&"sofa") && a.front == Front::X && a.size == Some(Vec3::new(2.0, 1.0, 0.8)));
        let other = table.of("stool.gltf");
        assert!(other.families_or("stool").contains(&"bar_stool") && other.front == Front::MinusX && other.weight == 1.0);
        assert_eq!((a.licence, other.licence_of_all), (None, Some("CC0".into())));
        let lamps = read("[models.\"a.glb\"]\nclass = \"lamp\"\nstands = \"ceiling\"\n").unwrap();
        assert_eq!(lamps.of("a.glb").families_or(""), ["pendant", "ceiling_lamp", "ceiling_panel", "tube_lamp"]);
    }

    #[test]
    fn wrong_entries_are_told_with_model_and_remedy() {
        for (text, problem, remedy) in [
            ("[models.\"a.glb\"]\nclass = \"sofaa\"\n", "model \"a.glb\": unknown class \"sofaa\"", "did you mean \"sofa\"?"),
            ("[models.\"a.glb\"]\nfamily = \"armchairs\"\n", "unknown family \"armchairs\"", "did you mean \"armchair\"?"),
            ("[models.\"b.glb\"]\nfamily = \"sofa\"\n", "there is no such model", "a.glb"),
            ("[models.\"a.glb\"]\nsize = [1, 0, 1]\n", "size is [1.0, 0.0, 1.0]", "above zero"),
            ("[models.\"a.glb\"]\nweight = -1\n", "weight is -1", "use = false"),
            ("[models.\"a.glb\"]\nclass = \"sofa\"\nstands = \"ceiling\"\n", "no thing of class \"sofa\" can be placed that way", "stands"),
            ("[models.\"a.glb\"]\ncolour = 3\n", "unknown field `colour`", "docs/homes.md"),
        ] {
            let error = read(text).unwrap_err();
            let (message, hint) = (error.to_string(), error.hint().unwrap_or_default());
            assert!(message.contains(problem) && hint.contains(remedy), "{text}: {message} / {hint}");
        }
    }

    #[test]
    fn fronts_look_along_y() {
        // +z of a file is −y after import, +x stays.
        assert_eq!(Front::Z.turn() * DVec3::NEG_Y, DVec3::Y);
        assert_eq!(Front::MinusZ.turn() * DVec3::Y, DVec3::Y);
        assert_eq!(Front::X.turn() * DVec3::X, DVec3::Y);
        assert_eq!(Front::MinusX.turn() * DVec3::NEG_X, DVec3::Y);
        assert!([Front::Z, Front::MinusZ, Front::X, Front::MinusX].iter().all(|f| f.turn().determinant() == 1.0));
    }
}
