//! Descriptions of the instances of a scene, relations between them, and captions and questions about its frames:
//! `_detail/metadata_instances.csv`, `_detail/metadata_instance_relations.csv`, `_detail/<camera>/captions.jsonl` and `questions.jsonl`.

use crate::tables::Table;
use crate::{Dataset, DatasetError, check_name, write_bytes};
use enfilade_math::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use std::path::Path;

const INSTANCES: [&str; 16] = [
    "semantic_instance_id",
    "semantic_id",
    "semantic_name",
    "name",
    "noun",
    "room",
    "color",
    "material",
    "center_x",
    "center_y",
    "center_z",
    "length_m",
    "width_m",
    "height_m",
    "front_x",
    "front_y",
];
const RELATIONS: [&str; 5] = ["subject_instance_id", "relation", "object_instance_id", "object_semantic_id", "distance_m"];

/// The description of an instance.
#[derive(Clone, Debug, PartialEq)]
pub struct DescribedInstance {
    /// Number of the instance, as in the images.
    pub instance: i16,
    /// Class of the instance.
    pub semantic: i16,
    /// Name of the class.
    pub semantic_name: String,
    /// Name of the instance: in generated homes the object's name, else the name of its largest part.
    pub name: String,
    /// The word for it in plain English; empty if none is known.
    pub noun: String,
    /// Name of the room that its middle is in; empty where rooms are not known.
    pub room: String,
    /// Name of the colour that most of it has; empty where no colour prevails, or it reflects as mirrors and glass do.
    pub color: String,
    /// Name of the material of most of its surface; empty where materials are not known.
    pub material: String,
    /// The middle of its upright box, world, metres.
    pub center: DVec3,
    /// The box's sides, metres: the longer horizontal one, the shorter, the vertical one.
    pub size_m: DVec3,
    /// Unit vector to where its front looks, seen from above, where that is known.
    pub front: Option<DVec2>,
}

/// A kind of spatial relation between two instances.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs, reason = "RelationKind::ALL says what each is called; docs/words.md what it means")]
pub enum RelationKind {
    On,
    In,
    HangsFrom,
    Against,
    Under,
    Beside,
    Facing,
}

impl RelationKind {
    /// All of them.
    pub const ALL: [Self; 7] = [Self::On, Self::In, Self::HangsFrom, Self::Against, Self::Under, Self::Beside, Self::Facing];

    /// Name of the relation in the file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::On => "on",
            Self::In => "in",
            Self::HangsFrom => "hangs_from",
            Self::Against => "against",
            Self::Under => "under",
            Self::Beside => "beside",
            Self::Facing => "facing",
        }
    }
}

/// A spatial relation between two things: subject, relation, object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InstanceRelation {
    /// Number of the instance that is the subject.
    pub subject: i16,
    /// Kind of relation.
    pub kind: RelationKind,
    /// Number of the other instance; −1 for walls, floors and ceilings.
    pub object: i16,
    /// The class of the other.
    pub object_semantic: i16,
    /// Distance between them, metres: the gap if they touch or are beside each other, the distance of their middles if one faces the other.
    pub distance_m: f64,
}

/// The caption of a frame: a line of `captions.jsonl`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Caption {
    /// Scene, camera and frame: `home/cam_00/0007`.
    pub id: String,
    /// Name of the scene.
    pub scene_name: String,
    /// Name of the camera.
    pub camera: String,
    /// Number of the frame.
    pub frame: u32,
    /// Sentences about the frame or scene.
    pub caption: String,
    /// The instances that they speak of.
    pub instances: Vec<i16>,
}

/// A question about a frame or about all frames of a camera: a line of `questions.jsonl`, with the columns of VSI-Bench and ours.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Question {
    /// Scene, camera and number of the question: `home/cam_00/12`.
    pub id: String,
    /// Always `enfilade`.
    pub dataset: String,
    /// Name of the scene.
    pub scene_name: String,
    /// Name of the camera.
    pub camera: String,
    /// Number of the frame; `None`: all frames of the camera, as a video.
    pub frame: Option<u32>,
    /// Kind of question.
    pub question_type: String,
    /// The question.
    pub question: String,
    /// Answers to choose from, `A. sofa` and so on; `None` where a number or a word is asked for.
    pub options: Option<Vec<String>>,
    /// The letter of the right option, or the number or word.
    pub ground_truth: String,
    /// The instances that it is about.
    pub instances: Vec<i16>,
}

impl Dataset {
    /// Writes the descriptions of the instances of a scene.
    ///
    /// # Errors
    /// When the name cannot be part of a path, or the file cannot be written.
    pub fn write_described_instances(&self, scene: &str, instances: &[DescribedInstance]) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        let mut table = Table::new(&self.layout().described_instances(scene), &INSTANCES);
        let row = |i: &DescribedInstance| {
            let words = [&i.semantic_name, &i.name, &i.noun, &i.room, &i.color, &i.material].map(String::clone);
            let numbers = [i.instance, i.semantic].map(|number| number.to_string());
            let lengths = i.center.to_array().into_iter().chain(i.size_m.to_array()).map(metres);
            let front = i.front.map_or([String::new(), String::new()], |front| front.to_array().map(|v| format!("{v:.6}")));
            numbers.into_iter().chain(words).chain(lengths).chain(front).collect()
        };
        table.rows = instances.iter().map(row).collect();
        table.write()
    }

    /// Reads the descriptions of the instances of a scene.
    ///
    /// # Errors
    /// When the table is missing or damaged.
    pub fn read_described_instances(&self, scene: &str) -> Result<Vec<DescribedInstance>, DatasetError> {
        let table = Table::read(&self.layout().described_instances(scene))?;
        let at = table.columns(INSTANCES)?;
        let instance = |row: usize| {
            let text = |column: usize| table.rows[row][at[column]].clone();
            let number = |column: usize| table.parse::<f64>(row, at[column]);
            let place = |first: usize| Ok::<_, DatasetError>(DVec3::new(number(first)?, number(first + 1)?, number(first + 2)?));
            Ok(DescribedInstance {
                instance: table.parse(row, at[0])?,
                semantic: table.parse(row, at[1])?,
                semantic_name: text(2),
                name: text(3),
                noun: text(4),
                room: text(5),
                color: text(6),
                material: text(7),
                center: place(8)?,
                size_m: place(11)?,
                front: if text(14).is_empty() { None } else { Some(DVec2::new(number(14)?, number(15)?)) },
            })
        };
        (0..table.rows.len()).map(instance).collect()
    }

    /// Writes the relations between the instances of a scene.
    ///
    /// # Errors
    /// When the name cannot be part of a path, or the file cannot be written.
    pub fn write_instance_relations(&self, scene: &str, relations: &[InstanceRelation]) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        let mut table = Table::new(&self.layout().instance_relations(scene), &RELATIONS);
        let row = |r: &InstanceRelation| {
            let [subject, object, class] = [r.subject, r.object, r.object_semantic].map(|number| number.to_string());
            vec![subject, r.kind.name().into(), object, class, metres(r.distance_m)]
        };
        table.rows = relations.iter().map(row).collect();
        table.write()
    }

    /// Reads the relations between the instances of a scene.
    ///
    /// # Errors
    /// When the table is missing or damaged, or has a relation that this version does not know.
    pub fn read_instance_relations(&self, scene: &str) -> Result<Vec<InstanceRelation>, DatasetError> {
        let path = self.layout().instance_relations(scene);
        let table = Table::read(&path)?;
        let [subject, relation, object, class, distance] = table.columns(RELATIONS)?;
        let row = |row: usize| {
            let found = &table.rows[row][relation];
            let kind = RelationKind::ALL.into_iter().find(|kind| kind.name() == found).ok_or_else(|| {
                let known = RelationKind::ALL.map(RelationKind::name).join(", ");
                DatasetError::text(
                    &path,
                    format!("line {}: found {found:?}, expected one of {known}; run enfilade make OUT words", row + 2),
                )
            })?;
            Ok(InstanceRelation {
                subject: table.parse(row, subject)?,
                kind,
                object: table.parse(row, object)?,
                object_semantic: table.parse(row, class)?,
                distance_m: table.parse(row, distance)?,
            })
        };
        (0..table.rows.len()).map(row).collect()
    }

    /// Writes the captions and questions of a camera's frames.
    ///
    /// # Errors
    /// When a name cannot be part of a path, or a file cannot be written.
    pub fn write_words(&self, [scene, camera]: [&str; 2], captions: &[Caption], questions: &[Question]) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        check_name("camera name", camera)?;
        write_lines(&self.layout().captions(scene, camera), captions)?;
        write_lines(&self.layout().questions(scene, camera), questions)
    }
}

/// A length to a tenth of a millimetre.
fn metres(v: f64) -> String {
    format!("{v:.4}")
}

/// One line of JSON for each.
fn write_lines(path: &Path, rows: &[impl Serialize]) -> Result<(), DatasetError> {
    let line = |row| serde_json::to_string(row).map_err(|error| DatasetError::text(path, format!("cannot be written: {error}")));
    let mut text = String::new();
    for row in rows {
        text += &line(row)?;
        text.push('\n');
    }
    write_bytes(path, text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instances_and_relations_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let sofa = DescribedInstance {
            instance: 3,
            semantic: 6,
            semantic_name: "sofa".into(),
            name: "sofa_1".into(),
            noun: "sofa".into(),
            room: "living_1".into(),
            color: "blue".into(),
            material: "wool, \"felted\"".into(),
            center: DVec3::new(1.0, -2.0, 0.4),
            size_m: DVec3::new(2.1, 0.9, 0.8),
            front: Some(DVec2::X),
        };
        let bare = DescribedInstance { instance: 4, front: None, color: String::new(), ..sofa.clone() };
        dataset.write_described_instances("room", &[sofa.clone(), bare.clone()]).unwrap();
        assert_eq!(dataset.read_described_instances("room").unwrap(), [sofa, bare]);
        let relations =
            RelationKind::ALL.map(|kind| InstanceRelation { subject: 3, kind, object: -1, object_semantic: 2, distance_m: 0.01 });
        dataset.write_instance_relations("room", &relations).unwrap();
        assert_eq!(dataset.read_instance_relations("room").unwrap(), relations);
        let path = dataset.layout().instance_relations("room");
        let text = std::fs::read_to_string(&path).unwrap().replace("facing", "admiring");
        write_bytes(&path, text).unwrap();
        let message = dataset.read_instance_relations("room").unwrap_err().to_string();
        assert!(message.contains("line 8: found \"admiring\", expected one of on, in, hangs_from"), "{message}");
    }

    #[test]
    fn captions_and_questions_are_lines_of_json() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let question = Question {
            id: "room/cam_00/0".into(),
            dataset: "enfilade".into(),
            scene_name: "room".into(),
            camera: "cam_00".into(),
            frame: None,
            question_type: "object_counting".into(),
            question: "How many chairs are there?".into(),
            options: None,
            ground_truth: "4".into(),
            instances: vec![1, 2, 3, 4],
        };
        dataset.write_words(["room", "cam_00"], &[], &[question.clone(), question]).unwrap();
        let text = std::fs::read_to_string(dataset.layout().questions("room", "cam_00")).unwrap();
        let line = "{\"id\":\"room/cam_00/0\",\"dataset\":\"enfilade\",\"scene_name\":\"room\",\"camera\":\"cam_00\",\"frame\":null,\
                    \"question_type\":\"object_counting\",\"question\":\"How many chairs are there?\",\"options\":null,\
                    \"ground_truth\":\"4\",\"instances\":[1,2,3,4]}\n";
        assert_eq!(text, [line, line].concat());
        assert!(std::fs::read(dataset.layout().captions("room", "cam_00")).unwrap().is_empty());
    }
}
