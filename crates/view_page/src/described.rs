//! Descriptions of a scene and its frames: words, colours, materials, sizes and relations of instances, rooms, captions and questions.

use super::derived_files::INERTIAL;
use super::place::{FramePlace, optional, problem};
use super::problems::Problems;
use super::viewer::Viewer;
use enfilade_dataset::{Caption, DatasetError, DescribedInstance, InstanceRelation, Question};
use enfilade_scene::{RoomPlane, Rooms};
use enfilade_serve::ApiProblem;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::path::Path;

impl Viewer {
    /// Descriptions and relations of a scene's instances, its rooms and the names of their planes; empty lists where there are no such
    /// files.
    pub(super) fn described(&self, scene: &str, lost: &mut Problems) -> Value {
        let instances = lost.or_nothing("objects", self.described_instances(scene));
        let relations = lost.or_nothing("objects", self.instance_relations(scene));
        let rooms = lost.or_nothing("frame", self.rooms(scene));
        let instance = |one: &DescribedInstance| {
            json!({ "instance": one.instance, "name": one.name, "noun": one.noun, "room": one.room, "color": one.color,
                "material": one.material, "size_m": one.size_m.to_array() })
        };
        let relation = |one: &InstanceRelation| {
            json!({ "subject": one.subject, "kind": one.kind.name(), "object": one.object, "object_semantic": one.object_semantic,
                "distance_m": one.distance_m })
        };
        let plane = |all: &Rooms| {
            let name = |plane: &RoomPlane| format!("{} of {}", plane.kind.name(), all.outlines[plane.room].name);
            all.planes().iter().map(name).collect::<Vec<_>>()
        };
        json!({
            "instances": instances.iter().map(instance).collect::<Vec<_>>(),
            "relations": relations.iter().map(relation).collect::<Vec<_>>(),
            "rooms": rooms.iter().flat_map(|all| &all.outlines).map(|room| json!({ "name": room.name, "kind": room.kind })).collect::<Vec<_>>(),
            "planes": rooms.as_ref().map(plane).unwrap_or_default(),
        })
    }

    fn described_instances(&self, scene: &str) -> Result<Vec<DescribedInstance>, ApiProblem> {
        self.allow(&self.layout().described_instances(scene))?;
        Ok(optional(self.dataset.read_described_instances(scene))?.unwrap_or_default())
    }

    fn instance_relations(&self, scene: &str) -> Result<Vec<InstanceRelation>, ApiProblem> {
        self.allow(&self.layout().instance_relations(scene))?;
        Ok(optional(self.dataset.read_instance_relations(scene))?.unwrap_or_default())
    }

    fn rooms(&self, scene: &str) -> Result<Option<Rooms>, ApiProblem> {
        self.allow(&self.layout().rooms(scene))?;
        self.dataset.read_rooms(scene).map_err(problem)
    }

    /// Captions of a frame, and questions about it.
    pub(super) fn words(&self, place: &FramePlace, lost: &mut Problems) -> Value {
        let FramePlace { scene, camera, frame } = place;
        let captions: Vec<Caption> = lost.or_nothing("frame", self.lines(&self.layout().captions(scene, camera)));
        let questions: Vec<Question> = lost.or_nothing("frame", self.lines(&self.layout().questions(scene, camera)));
        let question = |one: &Question| {
            json!({ "kind": one.question_type, "question": one.question, "options": one.options, "answer": one.ground_truth,
                "instances": one.instances, "of_all_frames": one.frame.is_none() })
        };
        let asked = questions.iter().filter(|one| one.frame.is_none_or(|number| number == *frame));
        json!({
            "caption": captions.iter().find(|one| one.frame == *frame).map(|one| &one.caption),
            "questions": asked.map(question).collect::<Vec<_>>(),
        })
    }

    /// Readings of a frame that are no pictures: the sensor, and the file's path in the dataset.
    pub(super) fn tables_of_sensors(&self, FramePlace { scene, camera, frame }: &FramePlace) -> Result<Vec<Value>, ApiProblem> {
        self.allow(&self.layout().sensors_dir())?;
        let sensors = self.dataset.sensors().map_err(problem)?;
        let file = |sensor: &String| self.layout().sensed(sensor, (scene, camera, *frame), INERTIAL);
        let there = sensors.iter().map(|sensor| (sensor, file(sensor))).filter(|(_, path)| path.is_file());
        Ok(there.map(|(sensor, path)| json!({ "sensor": sensor, "path": self.in_dataset(&path) })).collect())
    }

    /// The lines of a file, each in JSON; none if there is no file.
    fn lines<T: DeserializeOwned>(&self, path: &Path) -> Result<Vec<T>, ApiProblem> {
        self.allow(path)?;
        let text = std::fs::read_to_string(path).map_err(|source| DatasetError::Io { action: "read", path: path.to_path_buf(), source });
        let text = optional(text)?.unwrap_or_default();
        let line = |(at, line): (usize, &str)| {
            let wrong = |e| ApiProblem::failed(format!("{}: line {}: {e}", path.display(), at + 1), "run enfilade make OUT words again");
            serde_json::from_str(line).map_err(wrong)
        };
        text.lines().enumerate().map(line).collect()
    }
}
