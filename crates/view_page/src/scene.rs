//! A scene: its cameras, its classes, the names of its parts and objects, and the boxes around instances.

use super::place::{optional, problem};
use super::problems::Problems;
use super::viewer::{Viewer, work};
use axum::extract::{Path, State};
use axum::http::HeaderMap;
use axum::response::Response;
use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::{BoxKind, DatasetError, Elements, Node, instance_colors, mesh_names};
use enfilade_scene::PartLabel;
use enfilade_serve::{ApiProblem, reply};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use std::sync::Arc;

/// A row of `metadata_objects.csv`.
#[derive(Deserialize)]
struct ObjectRow {
    object_name: String,
}

/// Names and labels of a scene's objects, by their number.
#[derive(Default, Serialize)]
struct Objects {
    names: Vec<String>,
    semantic: Vec<i16>,
    instance: Vec<i16>,
}

/// `GET /api/view/scene/{scene}`.
pub async fn scene(State(viewer): State<Arc<Viewer>>, Path(scene): Path<String>, headers: HeaderMap) -> Result<Response, ApiProblem> {
    let gzip = reply::takes_gzip(&headers);
    work(viewer, move |viewer| {
        viewer.check_scene(&scene)?;
        let (mut facts, lost) = viewer.scene_facts(&scene)?;
        facts["problems"] = json!(lost);
        Ok(reply::json(gzip, &facts))
    })
    .await
}

impl Viewer {
    /// Facts about a scene for the page, and the files that could not be read.
    fn scene_facts(&self, scene: &str) -> Result<(Value, Problems), ApiProblem> {
        let layout = self.layout();
        let mesh = |name: &str| layout.mesh_file(scene, name);
        self.allow_all([
            layout.metadata_cameras(scene),
            layout.metadata_nodes(scene),
            layout.metadata_scene(scene),
            layout.mesh_dir(scene),
        ])?;
        self.allow_all([mesh_names::OBJECTS_SEMANTIC, mesh_names::OBJECTS_INSTANCE, mesh_names::INSTANCE_COLORS].map(mesh))?;
        let mut lost = Problems::default();
        let nodes = lost.or_nothing("objects", optional(self.dataset.read_nodes(scene))).unwrap_or_default();
        let labels = lost.or_nothing("objects", optional(self.dataset.read_label_tables(scene))).unwrap_or_default();
        let instances = labels.parts.iter().map(|label| label.instance).max().unwrap_or(0).max(0) as usize;
        let pages = [
            ("Rejected views", layout.gates_page(scene)),
            ("Plans", layout.plan_preview_dir(scene).join("index.html")),
            ("Floor plan", layout.rooms_drawing(scene)),
        ];
        let pages =
            pages.iter().filter(|(_, path)| path.is_file()).map(|(title, path)| json!({ "title": title, "path": self.in_dataset(path) }));
        let facts = json!({
            "name": scene,
            "cameras": lost.or_nothing("views", self.dataset.cameras(scene).map_err(problem)),
            "meters_per_unit": lost.or_nothing("display", self.meters_per_unit(scene).map(Some)).unwrap_or(1.0),
            "classes": lost.or_nothing("objects", self.classes(scene)),
            // Indexed by `render_entity_id` - 1.
            "parts": nodes.iter().map(|node| &node.node_name).collect::<Vec<_>>(),
            "objects": lost.or_nothing("objects", self.objects(scene, &nodes, &labels.parts)),
            "materials": lost.or_nothing("objects", self.material_names(scene)),
            "instance_colors": self.colors_of_instances(scene, instances),
            "boxes": lost.or_nothing("objects", self.boxes(scene)),
            "has_geometry": mesh(mesh_names::VERTICES).is_file() && mesh(mesh_names::FACES_VERTICES).is_file(),
            "described": self.described(scene, &mut lost),
            "has_pairs": layout.covisibility(scene).is_file(),
            "has_space": layout.octomap(scene).is_file(),
            "pages": pages.collect::<Vec<_>>(),
        });
        Ok((facts, lost))
    }

    /// The parts and what was split off from them, indexed as in `mesh_faces_oi.hdf5`.
    fn objects(&self, scene: &str, nodes: &[Node], labels: &[PartLabel]) -> Result<Objects, ApiProblem> {
        let names: Vec<String> = match self.mesh_table::<ObjectRow>(scene, mesh_names::OBJECTS)? {
            Some(rows) => rows.into_iter().map(|row| row.object_name).collect(),
            None => names_by_nodes(nodes),
        };
        let semantic = labels.iter().map(|label| label.semantic).collect();
        Ok(Objects { names, semantic, instance: labels.iter().map(|label| label.instance).collect() })
    }

    /// The rows of a table of the mesh folder; `None` where it is not there.
    fn mesh_table<T: DeserializeOwned>(&self, scene: &str, name: &str) -> Result<Option<Vec<T>>, ApiProblem> {
        let path = self.layout().mesh_file(scene, name);
        self.allow(&path)?;
        let bytes = std::fs::read(&path).map_err(|source| DatasetError::Io { action: "read", path: path.clone(), source });
        let Some(bytes) = optional(bytes)? else { return Ok(None) };
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes.as_slice());
        let rows: Result<Vec<T>, csv::Error> = reader.deserialize().collect();
        rows.map(Some).map_err(|e| ApiProblem::failed(format!("{}: {e}", path.display()), "fix or delete the file that is named"))
    }

    /// Metres per asset unit; 1 if the dataset does not state it.
    pub(super) fn meters_per_unit(&self, scene: &str) -> Result<f64, ApiProblem> {
        Ok(optional(self.dataset.meters_per_asset_unit(scene))?.unwrap_or(1.0))
    }

    /// Names by `material_id` - 1; empty if there is no table.
    fn material_names(&self, scene: &str) -> Result<Vec<String>, ApiProblem> {
        let path = self.layout().metadata_materials(scene);
        self.allow(&path)?;
        let Ok(text) = std::fs::read_to_string(&path) else { return Ok(Vec::new()) };
        // Two columns, the number first; a name with quotes or commas is quoted.
        let name = |line: &str| line.split_once(',').map(|(_, name)| name.trim().trim_matches('"').replace("\"\"", "\""));
        Ok(text.lines().skip(1).filter_map(name).collect())
    }

    /// The scene's own colours, else ours: row `i` is instance `i`.
    fn colors_of_instances(&self, scene: &str, instances: usize) -> Vec<[i64; 3]> {
        let path = self.layout().mesh_file(scene, mesh_names::INSTANCE_COLORS);
        match read_array(&path).map(|array| array.values) {
            Ok(Elements::I64(values)) if values.len() > 3 * instances => values.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
            _ => instance_colors(instances),
        }
    }

    /// The boxes of each kind, one per instance, in metres, null if an instance has none. Kinds without files are absent.
    fn boxes(&self, scene: &str) -> Result<Map<String, Value>, ApiProblem> {
        let mut kinds = Map::new();
        for kind in BoxKind::ALL {
            self.allow_all(self.dataset.box_files(scene, kind))?;
            let Some(boxes) = optional(self.dataset.read_boxes(scene, kind))? else { continue };
            let one = |b: &enfilade_math::OrientedBox| {
                json!({ "center": b.center.to_array(), "extents": b.extents.to_array(),
                    "orientation": b.world_from_box.transpose().to_cols_array() })
            };
            kinds.insert(kind.name().to_string(), boxes.iter().map(|b| b.as_ref().map(one)).collect());
        }
        Ok(kinds)
    }
}

/// Names of objects from the table of render entities, for datasets without a table of objects.
fn names_by_nodes(nodes: &[Node]) -> Vec<String> {
    let mut names = Vec::new();
    for node in nodes {
        let Some(object) = node.object_id.map(|object| object as usize).filter(|&object| object <= i16::MAX as usize) else { continue };
        if names.len() <= object {
            names.resize(object + 1, String::new());
        }
        names[object].clone_from(&node.object_name);
    }
    names
}
