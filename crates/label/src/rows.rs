//! The rows of a table that apply to a part, and to the objects that it is a part of.

use super::table::{Row, Subject};
use enfilade_scene::{ObjectId, Part, PartId, Scene};
use std::collections::{HashMap, HashSet};

/// A row of a table, by its index, that applies to a part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Match<'a> {
    pub row: usize,
    /// The parts that are one instance by this row.
    pub whole: Whole<'a>,
}

/// The parts that a row labels as one thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Whole<'a> {
    /// The parts of an object, by [`Scene::object_of`], or everything below it.
    Object(u32),
    /// The parts `object/…` of this name.
    Named(&'a str),
}

/// The rows of a table that concern one scene, by name.
pub(super) struct Index<'a> {
    /// All of them, those for this scene only first.
    pub rows: Vec<usize>,
    exact: HashMap<(Subject, &'a str), usize>,
    /// Material rows by lower-case name.
    lower: HashMap<String, usize>,
    /// Material rows by lower-case name without numeric suffix.
    stem: HashMap<String, usize>,
    scene: &'a Scene,
    /// The objects' names, preceded by the names of their parents.
    paths: Vec<String>,
    /// The names of parts and of their own objects, with and without parents: rows about these names do not apply to parents.
    near: HashSet<&'a str>,
}

impl<'a> Index<'a> {
    pub fn new(table: &'a [Row], scene_name: &str, scene: &'a Scene) -> Self {
        let with = |scene: Option<&str>| (0..table.len()).filter(move |&i| table[i].scene.as_deref() == scene).collect::<Vec<_>>();
        let rows = [with(Some(scene_name)), with(None)].concat();
        let own = scene.parts.iter().filter_map(|part| part.object).map(|object| scene.objects[object as usize].name.as_str());
        let near = scene.parts.iter().map(|part| part.name.as_str()).chain(own).collect();
        let (exact, lower, stem) = (HashMap::new(), HashMap::new(), HashMap::new());
        let mut index = Self { rows: rows.clone(), exact, lower, stem, scene, paths: paths(scene), near };
        for i in rows {
            let row = &table[i];
            index.exact.entry((row.subject, row.name.as_str())).or_insert(i);
            if matches!(row.subject, Subject::Material | Subject::Name) {
                let lower = row.name.to_lowercase();
                index.stem.entry(without_numeric_suffix(&lower).to_string()).or_insert(i);
                index.lower.entry(lower).or_insert(i);
            }
        }
        index
    }

    /// The row that labels a part.
    pub fn find(&self, part: PartId) -> Option<Match<'a>> {
        self.candidates(part).into_iter().next()
    }

    /// Every row that applies to a part, in order of precedence.
    pub fn candidates(&self, part: PartId) -> Vec<Match<'a>> {
        let (own, part) = (Whole::Object(self.scene.object_of(part)), &self.scene.parts[part as usize]);
        let mut found: Vec<Match<'a>> = Vec::new();
        let mut add = |row: Option<usize>, whole| found.extend(row.map(|row| Match { row, whole }));
        for subject in [Subject::Part, Subject::Name, Subject::Object] {
            add(self.exact(subject, &part.name), own);
        }
        self.of_objects(part, &mut add);
        let material = &self.scene.materials[part.material as usize].name;
        let lower = material.to_lowercase();
        add(self.exact(Subject::Material, material), own);
        add(self.exact(Subject::Name, material), own);
        add(self.lower.get(&lower).copied(), own);
        add(self.stem.get(without_numeric_suffix(&lower)).copied(), own);
        found
    }

    /// The rows about what a part belongs to: its object, the prefix of its name before the last slash, and all parents.
    fn of_objects(&self, part: &'a Part, add: &mut impl FnMut(Option<usize>, Whole<'a>)) {
        for (level, object) in self.scene.objects_around(part).enumerate() {
            for name in self.names_of(object).into_iter().filter(|name| level == 0 || !self.near.contains(name)) {
                add(self.exact(Subject::Object, name), Whole::Object(object));
                add(self.exact(Subject::Name, name), Whole::Object(object));
            }
            if level == 0 {
                self.of_prefix(part, add);
            }
        }
        if part.object.is_none() {
            self.of_prefix(part, add);
        }
    }

    fn of_prefix(&self, part: &'a Part, add: &mut impl FnMut(Option<usize>, Whole<'a>)) {
        let Some(name) = before_slash(&part.name) else { return };
        add(self.exact(Subject::Object, name), Whole::Named(name));
        add(self.exact(Subject::Name, name), Whole::Named(name));
    }

    /// An object's name with and without its parents.
    fn names_of(&self, object: ObjectId) -> [&str; 2] {
        [&self.paths[object as usize], &self.scene.objects[object as usize].name]
    }

    fn exact(&self, subject: Subject, name: &str) -> Option<usize> {
        self.exact.get(&(subject, name)).copied()
    }
}

/// The names of all objects, preceded by the names of their parents, separated by slashes.
fn paths(scene: &Scene) -> Vec<String> {
    let mut paths: Vec<String> = Vec::with_capacity(scene.objects.len());
    for object in &scene.objects {
        let path = object.parent.map_or(object.name.clone(), |parent| format!("{}/{}", paths[parent as usize], object.name));
        paths.push(path);
    }
    paths
}

/// The text before the last slash of a part's name.
fn before_slash(part: &str) -> Option<&str> {
    part.rsplit_once('/').map(|(object, _)| object).filter(|object| !object.is_empty())
}

/// The name without a numeric suffix such as `.001`.
fn without_numeric_suffix(name: &str) -> &str {
    match name.rsplit_once('.') {
        Some((stem, digits)) if !stem.is_empty() && !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()) => stem,
        _ => name,
    }
}
