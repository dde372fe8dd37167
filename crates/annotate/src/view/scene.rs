//! A scene: its cameras, the names of its parts, classes and instances, and the boxes around them.

use super::place::{optional, problem};
use super::{Viewer, work};
use crate::serve::{ApiProblem, reply};
use axum::extract::{Path, State};
use axum::http::HeaderMap;
use axum::response::Response;
use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::{BoxKind, Elements, instance_colors};
use serde_json::{Map, Value, json};
use std::sync::Arc;

/// `GET /api/view/scene/{scene}`.
pub async fn scene(State(viewer): State<Arc<Viewer>>, Path(scene): Path<String>, headers: HeaderMap) -> Result<Response, ApiProblem> {
    let gzip = reply::takes_gzip(&headers);
    work(viewer, move |viewer| {
        viewer.check_scene(&scene)?;
        Ok(reply::json(gzip, &viewer.scene_facts(&scene)?))
    })
    .await
}

impl Viewer {
    fn scene_facts(&self, scene: &str) -> Result<Value, ApiProblem> {
        let layout = self.layout();
        let mesh = |name: &str| layout.mesh_file(scene, name);
        self.allow_all([
            layout.metadata_cameras(scene),
            layout.metadata_nodes(scene),
            layout.metadata_scene(scene),
            layout.mesh_dir(scene),
        ])?;
        self.allow_all(["mesh_objects_si.hdf5", "mesh_objects_sii.hdf5", "metadata_semantic_instance_colors.hdf5"].map(mesh))?;
        let nodes = optional(self.dataset.read_nodes(scene))?.unwrap_or_default();
        let labels = optional(self.dataset.read_label_tables(scene))?.unwrap_or_default();
        let label = |object: Option<u32>| object.and_then(|object| labels.parts.get(object as usize));
        let instances = labels.parts.iter().map(|label| label.instance).max().unwrap_or(0).max(0) as usize;
        let pages = [("Rejected views", layout.gates_page(scene)), ("Plans", layout.plan_preview_dir(scene).join("index.html"))];
        let pages =
            pages.iter().filter(|(_, path)| path.is_file()).map(|(title, path)| json!({ "title": title, "path": self.in_dataset(path) }));
        Ok(json!({
            "name": scene,
            "cameras": self.dataset.cameras(scene).map_err(problem)?,
            "meters_per_unit": self.meters_per_unit(scene)?,
            // By `render_entity_id` - 1.
            "parts": {
                "names": nodes.iter().map(|node| &node.node_name).collect::<Vec<_>>(),
                "semantic": nodes.iter().map(|node| label(node.object_id).map_or(-1, |label| label.semantic)).collect::<Vec<_>>(),
                "instance": nodes.iter().map(|node| label(node.object_id).map_or(-1, |label| label.instance)).collect::<Vec<_>>(),
            },
            "materials": self.material_names(scene)?,
            "instance_colors": self.colors_of_instances(scene, instances),
            "boxes": self.boxes(scene)?,
            "has_geometry": mesh("mesh_vertices.hdf5").is_file() && mesh("mesh_faces_vi.hdf5").is_file(),
            "has_space": layout.octomap(scene).is_file(),
            "pages": pages.collect::<Vec<_>>(),
        }))
    }

    /// Metres per asset unit; 1 where nothing says it.
    pub(super) fn meters_per_unit(&self, scene: &str) -> Result<f64, ApiProblem> {
        Ok(optional(self.dataset.meters_per_asset_unit(scene))?.unwrap_or(1.0))
    }

    /// By `material_id` - 1; none where there is no table.
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
        let path = self.layout().mesh_file(scene, "metadata_semantic_instance_colors.hdf5");
        match read_array(&path).map(|array| array.values) {
            Ok(Elements::I64(values)) if values.len() > 3 * instances => values.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
            _ => instance_colors(instances),
        }
    }

    /// By kind, one per instance in metres, null where there is none; kinds without files are absent.
    fn boxes(&self, scene: &str) -> Result<Value, ApiProblem> {
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
        Ok(Value::Object(kinds))
    }
}
