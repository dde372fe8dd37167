//! From a table to the label of every part.

use super::rows::{Index, Match, Whole};
use super::table::{LabelTable, Row};
use enfilade_scene::{Labels, PartId, PartLabel, Scene, is_stuff};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeSet, HashMap};

/// Result of applying a table to a scene.
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
    /// Name of the part.
    pub part: String,
    /// Name of the part's material.
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

impl LabelTable {
    /// Labels the parts of the scene called `scene_name`.
    ///
    /// A row about the part takes precedence over one about its object, then come rows about the object's parents, nearest first, and last
    /// a row about the material. At each level, a row for this scene takes precedence over one for all scenes. Objects and their parents
    /// are named alone or with all parents before them (`World/chair_1`); the text before the last slash of a part's name also counts as an
    /// object's name. Materials match exactly, else without regard to case, else without Blender's numeric suffix (`Oak.001` is Oak).
    ///
    /// An instance number given in a row is used. Every other labelled part that is not wall, floor or ceiling gets one, from 1 in the
    /// order of parts. It is shared by the parts of one class that belong to one object ([`Scene::object_of`]), or that one row labels by a
    /// common parent.
    pub fn assign(&self, scene_name: &str, scene: &Scene) -> (Labels, LabelReport) {
        let index = Index::new(&self.rows, scene_name, scene);
        let found: Vec<Option<Match<'_>>> = (0..scene.parts.len()).map(|part| index.find(part as PartId)).collect();
        let labels = Labels { parts: number_instances(&self.rows, &found) };
        let report = self.report(&index, scene, &labels);
        (labels, report)
    }

    fn report(&self, index: &Index<'_>, scene: &Scene, labels: &Labels) -> LabelReport {
        let distinct = |value: fn(&PartLabel) -> i16| labels.parts.iter().map(value).filter(|&v| v >= 1).collect::<BTreeSet<_>>().len();
        let parts = &scene.parts;
        let unlabelled: Vec<_> = parts
            .iter()
            .zip(&labels.parts)
            .filter(|(_, label)| label.semantic == -1)
            .map(|(part, _)| UnlabelledPart { part: part.name.clone(), material: scene.materials[part.material as usize].name.clone() })
            .collect();
        let candidates = (0..parts.len()).flat_map(|part| index.candidates(part as PartId));
        let matched: BTreeSet<usize> = candidates.map(|found| found.row).collect();
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

/// The labels that rows give to parts.
fn number_instances<'a>(rows: &[Row], found: &[Option<Match<'a>>]) -> Vec<PartLabel> {
    let stated: BTreeSet<i16> = found.iter().flatten().filter_map(|found| rows[found.row].instance).collect();
    let mut free = (1..=i16::MAX).filter(|number| !stated.contains(number));
    let mut of_whole: HashMap<(Whole<'a>, i16), i16> = HashMap::new();
    let label = |found: &Option<Match<'a>>| {
        let Some(Match { row, whole }) = found else { return PartLabel::NONE };
        let Row { semantic, instance, .. } = rows[*row];
        let instance = match instance {
            Some(instance) => instance,
            None if semantic == -1 || is_stuff(semantic) => -1,
            None => *of_whole.entry((*whole, semantic)).or_insert_with(|| free.next().unwrap_or(-1)),
        };
        PartLabel { semantic, instance }
    };
    found.iter().map(label).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{join, write_table};
    use super::*;
    use enfilade_scene::{Material, Object, Part};

    fn table(text: &str) -> LabelTable {
        LabelTable::parse(text.as_bytes(), "t").unwrap()
    }

    /// Parts by their names and their materials' names, which belong to the objects given by index.
    fn scene(objects: &[(&str, Option<u32>)], parts: &[(&str, &str, Option<u32>)]) -> Scene {
        let part = |(i, &(name, _, object)): (usize, &(&str, &str, Option<u32>))| Part {
            name: name.into(),
            object,
            mesh: 0,
            material: i as u32,
            world_from_mesh: enfilade_math::DAffine3::IDENTITY,
        };
        Scene {
            objects: objects.iter().map(|&(name, parent)| Object { name: name.into(), parent }).collect(),
            parts: parts.iter().enumerate().map(part).collect(),
            materials: parts.iter().map(|(_, material, _)| Material::diffuse(*material, enfilade_math::Rgb::WHITE)).collect(),
            ..Scene::default()
        }
    }

    fn names(list: &[(&str, &str)]) -> Scene {
        scene(&[], &list.iter().map(|&(part, material)| (part, material, None)).collect::<Vec<_>>())
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
    fn siblings_are_instances_of_their_own_and_parts_of_one_object_share_theirs() {
        let objects = [("World", None), ("chair_1", Some(0)), ("chair_2", Some(0)), ("set", Some(0)), ("a", Some(3)), ("b", Some(3))];
        let world = scene(
            &objects,
            &[
                ("World/chair_1.wood", "wood", Some(1)),
                ("World/chair_1.cloth", "cloth", Some(1)),
                ("World/chair_2", "wood", Some(2)),
                ("World/set/a", "wood", Some(4)),
                ("World/set/b", "wood", Some(5)),
            ],
        );
        let labelled = |text: &str| pairs(&table(text).assign("s", &world).0);
        let apart = [(5, 1), (5, 1), (5, 2), (5, 3), (5, 4)];
        // By material, by part, by object with and without parents: always the same things.
        assert_eq!(labelled("material,semantic\nwood,chair\ncloth,chair\n"), apart);
        let parts = "World/chair_1.wood,chair\nWorld/chair_1.cloth,chair\nWorld/chair_2,chair\nWorld/set/a,chair\nWorld/set/b,chair\n";
        assert_eq!(labelled(&format!("part,semantic\n{parts}")), apart);
        assert_eq!(labelled("name,semantic\nchair_1,chair\nWorld/chair_2,chair\na,chair\nb,chair\n"), apart);
        // A row about a parent makes its things one instance, and the nearest row is used.
        assert_eq!(labelled("name,semantic\nset,sofa\nchair_1,chair\n"), [(5, 1), (5, 1), (-1, -1), (6, 2), (6, 2)]);
        assert_eq!(labelled("object,semantic\nWorld/set,sofa\nWorld/set/b,lamp\n")[3..], [(6, 1), (35, 2)]);
        // Another class within an object is another thing.
        assert_eq!(labelled("object,part,semantic\nchair_1,,chair\n,World/chair_1.cloth,pillow\n")[..2], [(5, 1), (18, 2)]);
    }

    #[test]
    fn rows_about_a_part_do_not_speak_of_what_lies_in_an_object_of_that_name() {
        let kitchen = scene(&[("Table", None), ("Table", Some(0)), ("Vase", Some(0))], &[("Table", "m", Some(1)), ("Vase", "m", Some(2))]);
        assert_eq!(pairs(&table("name,semantic\nTable,table\n").assign("s", &kitchen).0), [(7, 1), (-1, -1)]);
    }

    #[test]
    fn rows_about_what_names_have_before_a_slash_make_one_instance_per_class_and_stated_numbers_are_kept() {
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
        let part =
            |name: &str| Part { name: name.into(), object: None, mesh: 0, material: 0, world_from_mesh: enfilade_math::DAffine3::IDENTITY };
        let scene = Scene {
            parts: ["wall", "desk \"big\", old", "desk/leg"].map(part).into(),
            materials: vec![Material::diffuse("m", enfilade_math::Rgb::WHITE)],
            ..Scene::default()
        };
        let label = |semantic, instance| PartLabel { semantic, instance };
        let labels = Labels { parts: vec![label(1, -1), label(14, 4), PartLabel::NONE] };
        let text = write_table(&scene, &labels);
        assert!(text.starts_with("part,nyu40_id,nyu40_name,instance\nwall,1,wall,-1\n"), "{text}");
        let (again, report) = table(&text).assign("any", &scene);
        assert_eq!(again, labels);
        assert!(report.unmatched.is_empty());
        assert_eq!(join(&[2, -1], &again).unwrap().1, [4, -1]);
    }
}
