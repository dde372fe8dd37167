//! A camera: its model, its pose for each frame, and which of its views were rendered or rejected.

use super::place::{optional, problem};
use super::viewer::{Viewer, work};
use crate::serve::{ApiProblem, reply};
use axum::extract::{Path, State};
use axum::http::HeaderMap;
use axum::response::Response;
use enfilade_dataset::{ViewVerdict, loader_problem};
use enfilade_frame::{LAYERS, Layer, Pass};
use enfilade_scene::{Camera, Projection};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// `GET /api/view/camera/{scene}/{camera}`.
pub async fn camera(
    State(viewer): State<Arc<Viewer>>,
    Path((scene, camera)): Path<(String, String)>,
    headers: HeaderMap,
) -> Result<Response, ApiProblem> {
    let gzip = reply::takes_gzip(&headers);
    work(viewer, move |viewer| {
        viewer.check_camera(&scene, &camera)?;
        Ok(reply::json(gzip, &viewer.camera_facts(&scene, &camera)?))
    })
    .await
}

/// One view of a camera, as it is sent to the page.
#[derive(Default)]
struct View {
    pose: Option<Value>,
    layers: Vec<usize>,
    complete: bool,
    gate: Option<Value>,
}

impl Viewer {
    fn camera_facts(&self, scene: &str, camera: &str) -> Result<Value, ApiProblem> {
        let layout = self.layout();
        let keyframes =
            ["positions", "orientations", "look_at_positions", "frame_indices"].map(|what| layout.keyframes(scene, camera, what));
        self.allow_all(keyframes)?;
        self.allow_all([layout.camera_parameters(), layout.metadata_camera(scene, camera), layout.view_gates(scene, camera)])?;
        let model = self.camera_model(scene, camera)?;
        let mut views: BTreeMap<u32, View> = BTreeMap::new();
        let trajectory = optional(self.dataset.read_trajectory(scene, camera))?;
        for pose in trajectory.iter().flat_map(|trajectory| &trajectory.poses) {
            let rows = pose.world_from_camera.transpose().to_cols_array();
            let value = json!({ "position": pose.position.to_array(), "orientation": rows });
            views.entry(pose.frame).or_default().pose = Some(value);
        }
        for (frame, layers) in self.layers_of_frames(scene, camera, model.as_ref())? {
            views.entry(frame).or_default().layers = layers.into_iter().collect();
        }
        self.allow(&layout.records_dir(scene, camera))?;
        for frame in self.dataset.frame_numbers(scene, camera).map_err(problem)? {
            views.entry(frame).or_default().complete = true;
        }
        for judged in self.dataset.read_view_gates(scene, camera).map_err(problem)?.unwrap_or_default() {
            let verdict = match judged.verdict {
                ViewVerdict::Passed => continue,
                ViewVerdict::Rejected => "rejected",
                ViewVerdict::Reported => "reported",
            };
            let fault = judged.fault.map(|fault| json!({ "gate": fault.gate, "value": fault.value, "limit": fault.limit }));
            let picture = Some(layout.rejected_view(scene, camera, judged.frame)).filter(|path| path.is_file());
            let picture = picture.map(|path| self.in_dataset(&path));
            let gate = json!({ "verdict": verdict, "fault": fault, "picture": picture });
            views.entry(judged.frame).or_default().gate = Some(gate);
        }
        let tone: Vec<Value> = self.tone_maps(scene, camera)?.iter().map(|row| json!([row.frame, row.scale, row.display_scale])).collect();
        let frames: Vec<Value> = views
            .into_iter()
            .map(|(frame, v)| json!({ "frame": frame, "pose": v.pose, "layers": v.layers, "complete": v.complete, "gate": v.gate }))
            .collect();
        Ok(json!({
            "name": camera,
            "frame_time_s": self.dataset.read_frame_time(scene, camera).map_err(problem)?,
            "projection": model.as_ref().map(projection),
            "loader_problem": model.as_ref().filter(|_| !self.dataset.is_released(scene)).and_then(loader_problem),
            "frames": frames,
            "tone": tone,
        }))
    }

    /// For each frame that has any layer, the positions of its layers in [`LAYERS`]. Planar depth counts where it can be computed.
    fn layers_of_frames(&self, scene: &str, camera: &str, model: Option<&Camera>) -> Result<BTreeMap<u32, BTreeSet<usize>>, ApiProblem> {
        let mut found: BTreeMap<u32, BTreeSet<usize>> = BTreeMap::new();
        let folders: BTreeSet<_> = [Pass::Final, Pass::Geometry].map(|pass| self.layout().layer_dir(scene, camera, pass)).into();
        for folder in folders {
            self.allow(&folder)?;
            let Ok(entries) = std::fs::read_dir(&folder) else { continue };
            for name in entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()) {
                let parts: Vec<&str> = name.split('.').collect();
                if let ["frame", number, layer, "hdf5"] = parts[..]
                    && let (Ok(number), Some(layer)) = (number.parse(), LAYERS.iter().position(|spec| spec.name == layer))
                {
                    found.entry(number).or_default().insert(layer);
                }
            }
        }
        let planar = model.is_some_and(|camera| camera.projection.has_image_plane());
        for layers in found.values_mut().filter(|layers| planar && layers.contains(&(Layer::DepthMeters as usize))) {
            layers.insert(Layer::DepthZMeters as usize);
        }
        Ok(found)
    }

    /// The camera; `None` if the dataset does not describe it.
    pub(super) fn camera_model(&self, scene: &str, camera: &str) -> Result<Option<Camera>, ApiProblem> {
        let layout = self.layout();
        self.allow_all([layout.camera_parameters(), layout.camera_model(scene, camera), layout.camera_ray_grid(scene, camera)])?;
        if !layout.camera_model(scene, camera).is_file() && !self.dataset.camera_table().is_file() {
            return Ok(None);
        }
        // Hypersim's table lacks other scenes, which have poses and pictures all the same.
        Ok(self.dataset.read_camera(scene, camera).ok())
    }
}

/// The kind of the camera, its image size, and the rays through the image's corners in camera space, from the upper left clockwise.
fn projection(camera: &Camera) -> Value {
    let [width, height] = camera.size();
    let (w, h) = (f64::from(width), f64::from(height));
    let ray = |x: f64, y: f64| camera.projection.ray(x, y).map(|ray| ray.normalize().to_array());
    let corners: Option<Vec<[f64; 3]>> = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)].into_iter().map(|(x, y)| ray(x, y)).collect();
    let kind = match &camera.projection {
        Projection::Pinhole(_) => "pinhole",
        Projection::TiltedPinhole(_) => "tilted pinhole",
        Projection::RadialTangential(..) => "radial-tangential",
        Projection::Fisheye(..) => "fisheye",
        Projection::Equirectangular { .. } => "equirectangular",
        Projection::RayGrid(_) => "ray grid",
    };
    let middle = |y: f64| camera.projection.ray(w / 2.0, y);
    let fov_y_deg = middle(0.0).zip(middle(h)).map(|(top, bottom)| top.angle_between(bottom).to_degrees());
    let linear = camera.projection.is_linear();
    json!({ "kind": kind, "linear": linear, "width": width, "height": height, "corner_rays": corners, "fov_y_deg": fov_y_deg })
}
