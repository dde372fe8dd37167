//! Objects and groups as objects of the scene.
//!
//! Where a file has several `o`, each is an object, and its groups are parts of it. Else every group is one, within the `o` if there is one:
//! programs that know groups alone write all of them into one `o`, or none. Faces without either are an object for each material.

use super::file::{Group, ObjFile};
use crate::assembly::Assembly;
use enfilade_scene::ObjectId;
use std::collections::HashMap;

/// The objects of a file, as its groups are placed.
pub(super) struct Objects {
    /// True where each `o` is an object.
    by_object: bool,
    objects: HashMap<usize, ObjectId>,
    groups: HashMap<(usize, String), ObjectId>,
}

impl Objects {
    pub(super) fn new(obj: &ObjFile) -> Self {
        let named = |group: &&Group| group.object_name.is_some();
        let first = obj.groups.iter().find(named).map(|group| group.object);
        let by_object = obj.groups.iter().filter(named).any(|group| Some(group.object) != first);
        Self { by_object, objects: HashMap::new(), groups: HashMap::new() }
    }

    /// The object of a group, whose part is called `part`.
    pub(super) fn of(&mut self, group: &Group, part: &str, a: &mut Assembly) -> ObjectId {
        let object =
            group.object_name.as_deref().map(|name| *self.objects.entry(group.object).or_insert_with(|| a.push_object(name, None)));
        match (object, &group.name) {
            (Some(object), _) if self.by_object => object,
            // The group that an `o` begins is the object itself.
            (Some(object), Some(name)) if group.object_name.as_ref() == Some(name) => object,
            (_, Some(name)) => self.group(group.object, name, &group.around, object, a),
            (_, None) => a.push_object(part, object),
        }
    }

    /// The object of a group within the groups `around` it and the object `outermost`.
    fn group(&mut self, object: usize, name: &str, around: &[String], outermost: Option<ObjectId>, a: &mut Assembly) -> ObjectId {
        let mut inside = outermost;
        let names: Vec<&str> = std::iter::once(name).chain(around.iter().map(String::as_str)).collect();
        for i in (0..names.len()).rev() {
            let key = (object, names[i..].join(" "));
            inside = Some(*self.groups.entry(key).or_insert_with(|| a.push_object(names[i], inside)));
        }
        inside.unwrap_or_else(|| a.push_object(name, None))
    }
}
