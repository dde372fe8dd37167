//! From a table to the label of every part.

use super::table::{LabelTable, Row, Subject};
use enfilade_scene::{Labels, PartLabel, Scene, is_stuff};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeSet, HashMap};

/// The names by which a part can be labelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartNames<'a> {
    /// Its own name; `object/part` says which object it belongs to.
    pub part: &'a str,
    /// Its material's name.
    pub material: &'a str,
}

/// What a table did to a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LabelReport {
    /// Number of parts with a class.
    pub labelled_parts: usize,
    /// Number of parts in all.
    pub parts: usize,
    /// Number of different classes in use.
    pub classes: usize,
    /// Number of instances in use.
    pub instances: usize,
    /// Parts without a class.
    pub unlabelled: Vec<UnlabelledPart>,
    /// Rows for this scene that matched nothing.
    pub unmatched: Vec<UnmatchedRow>,
}

/// A part that no row labels.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct UnlabelledPart {
    /// Its name.
    pub part: String,
    /// Its material's name.
    pub material: String,
}

/// A row that matched nothing.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct UnmatchedRow {
    /// Line in the table, from 1.
    pub line: u64,
    /// The name nothing has.
    pub name: String,
}

/// The names of a scene's parts, in order.
pub fn part_names(scene: &Scene) -> Vec<PartNames<'_>> {
    scene.parts.iter().map(|part| PartNames { part: &part.name, material: &scene.materials[part.material as usize].name }).collect()
}

impl LabelTable {
    /// Labels the parts of the scene called `scene_name`.
    ///
    /// A row about the part beats one about its object, which beats one about its material; within these a row for this scene
    /// beats one for all. Materials match exactly, else without regard to case, else without Blender's numeric suffix
    /// (`Oak.001` is Oak). A stated instance counts; every other labelled part that is not wall, floor or ceiling gets one of
    /// its own, from 1 in the order of parts, where parts `object/…` of one class share theirs.
    pub fn assign(&self, scene_name: &str, parts: &[PartNames<'_>]) -> (Labels, LabelReport) {
        let index = Index::new(&self.rows, scene_name);
        let rows: Vec<Option<&Row>> = parts.iter().map(|names| index.find(names).map(|i| &self.rows[i])).collect();
        let labels = Labels { parts: number_instances(parts, &rows) };
        let report = self.report(&index, parts, &labels);
        (labels, report)
    }

    fn report(&self, index: &Index<'_>, parts: &[PartNames<'_>], labels: &Labels) -> LabelReport {
        let distinct = |value: fn(&PartLabel) -> i16| labels.parts.iter().map(value).filter(|&v| v >= 1).collect::<BTreeSet<_>>().len();
        let unlabelled: Vec<_> = parts
            .iter()
            .zip(&labels.parts)
            .filter(|(_, label)| label.semantic == -1)
            .map(|(names, _)| UnlabelledPart { part: names.part.into(), material: names.material.into() })
            .collect();
        let matched: BTreeSet<usize> = parts.iter().flat_map(|names| index.candidates(names)).collect();
        let unmatched = index.rows.iter().filter(|i| !matched.contains(i)).map(|&i| &self.rows[i]);
        LabelReport {
            labelled_parts: parts.len() - unlabelled.len(),
            parts: parts.len(),
            classes: distinct(|l| l.semantic),
            instances: distinct(|l| l.instance),
            unlabelled,
            unmatched: unmatched.map(|row| UnmatchedRow { line: row.line, name: row.name.clone() }).collect(),
        }
    }
}

/// The rows of a table that concern one scene, by name.
struct Index<'a> {
    /// All of them, those for this scene only first.
    rows: Vec<usize>,
    exact: HashMap<(Subject, &'a str), usize>,
    /// Material rows by lower-case name.
    lower: HashMap<String, usize>,
    /// Material rows by lower-case name without numeric suffix.
    stem: HashMap<String, usize>,
}

impl<'a> Index<'a> {
    fn new(table: &'a [Row], scene_name: &str) -> Self {
        let with = |scene: Option<&str>| (0..table.len()).filter(move |&i| table[i].scene.as_deref() == scene).collect::<Vec<_>>();
        let rows = [with(Some(scene_name)), with(None)].concat();
        let mut index = Self { rows: rows.clone(), exact: HashMap::new(), lower: HashMap::new(), stem: HashMap::new() };
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
    fn find(&self, names: &PartNames<'_>) -> Option<usize> {
        self.candidates(names).next()
    }

    /// Every row that speaks of a part, the one that counts first.
    fn candidates(&self, names: &PartNames<'_>) -> impl Iterator<Item = usize> {
        let exact = |subject, name| self.exact.get(&(subject, name)).copied();
        let object = object_of(names.part).unwrap_or(names.part);
        let lower = names.material.to_lowercase();
        [
            exact(Subject::Part, names.part),
            exact(Subject::Name, names.part),
            exact(Subject::Object, names.part),
            exact(Subject::Object, object),
            exact(Subject::Name, object),
            exact(Subject::Material, names.material),
            exact(Subject::Name, names.material),
            self.lower.get(&lower).copied(),
            self.stem.get(without_numeric_suffix(&lower)).copied(),
        ]
        .into_iter()
        .flatten()
    }
}

/// What stands before the last slash of a part's name.
fn object_of(part: &str) -> Option<&str> {
    part.rsplit_once('/').map(|(object, _)| object).filter(|object| !object.is_empty())
}

/// The name without `.001` or the like.
fn without_numeric_suffix(name: &str) -> &str {
    match name.rsplit_once('.') {
        Some((stem, digits)) if !stem.is_empty() && !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()) => stem,
        _ => name,
    }
}

fn number_instances<'a>(parts: &[PartNames<'a>], rows: &[Option<&Row>]) -> Vec<PartLabel> {
    let stated: BTreeSet<i16> = rows.iter().flatten().filter_map(|row| row.instance).collect();
    let mut free = (1..=i16::MAX).filter(|number| !stated.contains(number));
    let mut of_object: HashMap<(&'a str, i16), i16> = HashMap::new();
    let mut labels = Vec::with_capacity(parts.len());
    for (names, row) in parts.iter().zip(rows) {
        let Some(row) = row else {
            labels.push(PartLabel::NONE);
            continue;
        };
        let semantic = row.semantic;
        let mut next = || free.next().unwrap_or(-1);
        let instance = match (row.instance, object_of(names.part)) {
            (Some(instance), _) => instance,
            (None, _) if semantic == -1 || is_stuff(semantic) => -1,
            (None, Some(object)) => *of_object.entry((object, semantic)).or_insert_with(next),
            (None, None) => next(),
        };
        labels.push(PartLabel { semantic, instance });
    }
    labels
}

#[cfg(test)]
mod tests {
    use super::super::{join, write_table};
    use super::*;
    use enfilade_scene::{Material, Part};

    fn table(text: &str) -> LabelTable {
        LabelTable::parse(text.as_bytes(), "t").unwrap()
    }

    fn names<'a>(list: &[(&'a str, &'a str)]) -> Vec<PartNames<'a>> {
        list.iter().map(|&(part, material)| PartNames { part, material }).collect()
    }

    fn pairs(labels: &Labels) -> Vec<(i16, i16)> {
        labels.parts.iter().map(|l| (l.semantic, l.instance)).collect()
    }

    #[test]
    fn part_beats_material_and_a_row_for_the_scene_beats_one_for_all() {
        let t = table("scene,part,material,nyu40_id\n,,Oak,7\n,shelf,,15\nroom,,Oak,14\nhall,,Oak,3\n");
        let parts = names(&[("a", "Oak"), ("shelf", "Oak")]);
        assert_eq!(pairs(&t.assign("room", &parts).0), [(14, 1), (15, 2)]);
        assert_eq!(pairs(&t.assign("elsewhere", &parts).0), [(7, 1), (15, 2)]);
    }

    #[test]
    fn materials_match_without_case_and_without_numeric_suffix() {
        let t = table("material,nyu40_id\nWall Paint,1\nOak.002,7\n");
        let parts = names(&[("a", "WALL PAINT"), ("b", "wall paint.013"), ("c", "Oak.002"), ("d", "Oak"), ("e", "Oak.x"), ("f", "Walls")]);
        let (labels, report) = t.assign("s", &parts);
        assert_eq!(pairs(&labels), [(1, -1), (1, -1), (7, 1), (7, 2), (-1, -1), (-1, -1)]);
        assert_eq!((report.labelled_parts, report.parts, report.classes, report.instances), (4, 6, 2, 2));
        assert_eq!(report.unlabelled[0], UnlabelledPart { part: "e".into(), material: "Oak.x".into() });
    }

    #[test]
    fn parts_of_an_object_share_an_instance_per_class_and_stated_numbers_are_kept() {
        let t = table("name,semantic,instance\nsofa,sofa,\nsofa/pillow,pillow,\nlamp,lamp,2\nfloor,floor,\nnone,chair,-1\n");
        let list = ["sofa/seat", "sofa/pillow", "sofa/back", "floor", "lamp", "none"];
        let parts = names(&list.map(|p| (p, "m")));
        assert_eq!(pairs(&t.assign("s", &parts).0), [(6, 1), (18, 3), (6, 1), (2, -1), (35, 2), (5, -1)]);
    }

    #[test]
    fn rows_that_match_nothing_are_reported_unless_for_another_scene() {
        let t = table("scene,part,nyu40_id\ns,chair,5\ns,chiar,5\nother,thing,5\n,lost,5\n");
        let report = t.assign("s", &names(&[("chair", "m")])).1;
        assert_eq!(report.unmatched, [UnmatchedRow { line: 3, name: "chiar".into() }, UnmatchedRow { line: 5, name: "lost".into() }]);
    }

    #[test]
    fn written_tables_give_the_same_labels_back() {
        let part = |name: &str| Part { name: name.into(), mesh: 0, material: 0, world_from_mesh: enfilade_math::DAffine3::IDENTITY };
        let scene = Scene {
            parts: ["wall", "desk \"big\", old", "desk/leg"].map(part).into(),
            materials: vec![Material::diffuse("m", enfilade_math::Rgb::WHITE)],
            ..Scene::default()
        };
        let label = |semantic, instance| PartLabel { semantic, instance };
        let labels = Labels { parts: vec![label(1, -1), label(14, 4), PartLabel::NONE] };
        let text = write_table(&scene, &labels);
        assert!(text.starts_with("part,nyu40_id,nyu40_name,instance\nwall,1,wall,-1\n"), "{text}");
        let (again, report) = table(&text).assign("any", &part_names(&scene));
        assert_eq!(again, labels);
        assert!(report.unmatched.is_empty());
        assert_eq!(join(&[2, -1], &again).unwrap().1, [4, -1]);
    }
}
