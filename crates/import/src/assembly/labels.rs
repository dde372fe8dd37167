//! Labels that the scene file gives: classes as it states them, and instances, which it may leave to us.

use enfilade_scene::{NYU40, ObjectId, PartLabel};

/// The label of a part in a scene file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FileLabel {
    /// NYU40 class, 1 to 40, or −1.
    pub semantic: i16,
    /// Number from 1, or −1 for none; `None` if the file does not state one.
    pub instance: Option<i16>,
    /// The object that the label was given to: all of it is one instance if the file states no number.
    pub whole: Option<ObjectId>,
}

impl FileLabel {
    /// No class and no instance.
    pub(crate) const NONE: Self = Self { semantic: -1, instance: None, whole: None };

    /// A class that is given to a node or prim with all below it.
    pub(crate) fn given(semantic: i16, whole: ObjectId) -> Self {
        Self { semantic, instance: None, whole: Some(whole) }
    }
}

impl From<PartLabel> for FileLabel {
    /// Class and instance as they are stated, with an instance of −1 for none.
    fn from(label: PartLabel) -> Self {
        Self { semantic: label.semantic, instance: Some(label.instance), whole: None }
    }
}

/// The class of NYU40 of this name, however it is written: `night_stand` and `Nightstand` are one.
pub(crate) fn class_named(name: &str) -> Option<i16> {
    let letters: String = name.chars().filter(char::is_ascii_alphabetic).map(|c| c.to_ascii_lowercase()).collect();
    let letters = if letters == "refridgerator" { "refrigerator" } else { &letters }; // the spelling of NYU's own list
    NYU40.iter().find(|class| class.name == letters).map(|class| class.id)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_known_however_their_names_are_written() {
        for (name, class) in [("chair", Some(5)), ("Night stand", Some(32)), ("shower_curtain", Some(28)), ("couch", None), ("", None)] {
            assert_eq!(class_named(name), class, "{name}");
        }
    }
}
