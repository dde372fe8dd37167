//! The objects of a collection's scene: their names, their classes and the numbers of their instances.
//!
//! An object is called `<category> (<id>)`, from the second of a category on `<category>_2 (<id>)`, and its parts `<object>/<part>` where
//! it has several. So label tables and `enfilade annotate` see objects, and `enfilade suggest` their categories.

use crate::assembly::{Assembly, Piece};
use crate::classes::class_of;
use enfilade_math::DAffine3;
use enfilade_scene::{PartId, PartLabel, is_stuff};
use std::collections::{BTreeMap, HashMap};

/// Categories without a class that a warning names.
const NAMED: usize = 12;

/// Names, numbers and categories of the objects that were placed so far.
#[derive(Default)]
pub(super) struct Objects {
    names: HashMap<String, usize>,
    instances: i16,
    /// Objects that came after the last number.
    without_number: usize,
    /// Categories without a class, and the number of their objects.
    unknown: BTreeMap<String, usize>,
    /// Objects of which the collection has no category.
    nameless: usize,
}

/// An object that is about to be placed.
pub(super) struct Object {
    /// Name of the object, which no other has.
    pub name: String,
    /// Class and instance of the object.
    pub label: PartLabel,
}

impl Objects {
    /// The next object of a category; `id` is what the collection calls it or its model.
    pub fn next(&mut self, category: Option<&str>, id: &str) -> Object {
        let category = category.map(str::trim).filter(|c| !c.is_empty());
        let semantic = category.and_then(class_of);
        match category {
            Some(category) if semantic.is_none() => *self.unknown.entry(category.to_string()).or_default() += 1,
            None => self.nameless += 1,
            Some(_) => (),
        }
        let label = semantic.map_or(PartLabel::NONE, |semantic| self.label(semantic));
        Object { name: self.name(category, id), label }
    }

    /// An object whose class follows from the layout itself, such as a wall.
    pub fn of_class(&mut self, semantic: i16, name: &str) -> Object {
        Object { label: self.label(semantic), name: self.name(None, name) }
    }

    /// A class with the next number, if its instances are counted.
    fn label(&mut self, semantic: i16) -> PartLabel {
        if is_stuff(semantic) {
            return PartLabel { semantic, instance: -1 };
        }
        match self.instances.checked_add(1) {
            Some(next) => self.instances = next,
            None => {
                self.without_number += 1;
                return PartLabel { semantic, instance: -1 };
            }
        }
        PartLabel { semantic, instance: self.instances }
    }

    fn name(&mut self, category: Option<&str>, id: &str) -> String {
        // A slash would divide the name into an object and its part.
        let plain = |text: &str| text.replace(" / ", ", ").replace('/', ",");
        let base = plain(category.unwrap_or(id));
        let count = self.names.entry(base.clone()).or_default();
        *count += 1;
        let numbered = if *count > 1 { format!("{base}_{count}") } else { base };
        if category.is_some() && !id.is_empty() { format!("{numbered} ({})", plain(id)) } else { numbered }
    }

    /// Reports what has no class.
    pub fn finish(self, a: &mut Assembly) {
        if !self.unknown.is_empty() {
            let objects: usize = self.unknown.values().sum();
            let mut named: Vec<String> = self.unknown.iter().take(NAMED).map(|(name, count)| format!("{name} ({count})")).collect();
            if self.unknown.len() > NAMED {
                named.push(format!("and {} more", self.unknown.len() - NAMED));
            }
            let message = format!(
                "{objects} objects are of categories that stand for no class of NYU40, and stay unlabelled: {}; a label table, enfilade \
                 suggest or enfilade annotate names them",
                named.join(", ")
            );
            a.warn("labels", message);
        }
        if self.nameless > 0 {
            a.warn("labels", format!("of {} objects the collection has no category here; they stay unlabelled", self.nameless));
        }
        if self.without_number > 0 {
            a.warn("labels", format!("{} objects came after the last instance number, {}; they have none", self.without_number, i16::MAX));
        }
    }
}

impl Object {
    /// Adds the parts of the object, and gives them by piece. Where it has no class, its pieces have those that the model's own file gives them.
    pub fn place(&self, pieces: &[Piece], file_from_model: DAffine3, a: &mut Assembly) -> Vec<Option<PartId>> {
        let object = a.push_object(&self.name, None);
        let part = |piece: &Piece| {
            let name = if pieces.len() > 1 { format!("{}/{}", self.name, piece.name) } else { self.name.clone() };
            let label = if self.label == PartLabel::NONE { piece.label_in(object) } else { self.label.into() };
            a.push_part_of(object, &name, piece.mesh, piece.material, file_from_model * piece.model_from_mesh, label)
        };
        pieces.iter().map(part).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_are_numbered_within_their_category_and_stuff_has_no_instance() {
        let mut objects = Objects::default();
        let of = |o: Object| (o.name, o.label.semantic, o.label.instance);
        assert_eq!(of(objects.next(Some("chair"), "ab12")), ("chair (ab12)".into(), 5, 1));
        assert_eq!(of(objects.next(Some("chair"), "ab12")), ("chair_2 (ab12)".into(), 5, 2));
        assert_eq!(of(objects.next(Some("Corner/Side Table"), "x")), ("Corner,Side Table (x)".into(), 7, 3));
        assert_eq!(of(objects.next(Some("floor"), "")), ("floor".into(), 2, -1));
        assert_eq!(of(objects.next(Some("gizmo"), "y")), ("gizmo (y)".into(), -1, -1));
        assert_eq!(of(objects.next(None, "y")), ("y".into(), -1, -1));
        assert_eq!((objects.unknown.len(), objects.nameless), (1, 1));
    }
}
