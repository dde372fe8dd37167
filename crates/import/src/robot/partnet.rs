//! PartNet-Mobility: what `semantics.txt` and `meta.json` beside a `mobility.urdf` say of its links and of the whole.
//!
//! Each line of `semantics.txt` is a link, the kind of its joint and what it is (`link_0 hinge door`): the link is called `door_link_0` then.
//! `model_cat` of `meta.json` is the category of the whole, whose class all parts have as one instance.

use crate::ImportError;
use crate::assembly::{Assembly, FileLabel};
use crate::classes::class_of;
use enfilade_scene::ObjectId;
use std::collections::BTreeMap;

/// The file's name in each folder of the data.
const ROBOT: &str = "mobility.urdf";
/// A category that is called otherwise elsewhere.
const STORAGE: (&str, &str) = ("StorageFurniture", "cabinet");

/// What the links are.
#[derive(Default)]
pub(super) struct Semantics {
    names: BTreeMap<String, String>,
    /// The class of the whole.
    class: Option<i16>,
}

impl Semantics {
    /// Reads the files beside the scene file; of other robots nothing.
    ///
    /// # Errors
    /// When a file has other contents.
    pub(super) fn read(a: &mut Assembly) -> Result<Self, ImportError> {
        let mut semantics = Self::default();
        let names = a.file().with_file_name("semantics.txt");
        if a.file().file_name().is_none_or(|name| name != ROBOT) || !a.is_file(&names) {
            return Ok(semantics);
        }
        let bytes = a.read_input(&names, "check the permission to read it")?;
        for (line, number) in String::from_utf8_lossy(&bytes).lines().zip(1..).filter(|(line, _)| !line.trim().is_empty()) {
            let words: Vec<&str> = line.split_whitespace().collect();
            let [link, _, what] = words[..] else {
                let problem = format!("found {:?}, expected a link, its joint and what it is, such as link_0 hinge door", line.trim());
                return Err(ImportError::malformed(&names, format!("line {number}"), problem));
            };
            semantics.names.insert(link.into(), format!("{what}_{link}"));
        }
        a.warn(
            "robot",
            "models of PartNet-Mobility have no unit (each fits a sphere of about 1 m around its origin): meters_per_unit gives it its size",
        );
        let meta = a.file().with_file_name("meta.json");
        if a.is_file(&meta) {
            let bytes = a.read_input(&meta, "check the permission to read it")?;
            let meta: serde_json::Value =
                serde_json::from_slice(&bytes).map_err(|e| ImportError::malformed(&meta, "whole file", format!("{e}; expected JSON")))?;
            let category = meta.get("model_cat").and_then(|category| category.as_str()).unwrap_or_default();
            semantics.class = class_of(if category == STORAGE.0 { STORAGE.1 } else { category });
            if semantics.class.is_none() {
                a.warn("labels", format!("the category {category:?} stands for no class of NYU40; the parts stay unlabelled"));
            }
        }
        Ok(semantics)
    }

    /// What a link is called.
    pub(super) fn name<'n>(&'n self, link: &'n str) -> &'n str {
        self.names.get(link).map_or(link, String::as_str)
    }

    /// The label of all parts.
    pub(super) fn label(&self, whole: ObjectId) -> Option<FileLabel> {
        self.class.map(|class| FileLabel::given(class, whole))
    }
}
