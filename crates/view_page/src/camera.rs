//! A camera: its model, its pose for each frame, and which of its views were rendered or rejected.

use super::faults::Fault;
use super::place::{FramePlace, optional, problem};
use super::problems::Problems;
use super::viewer::{Viewer, work};
use axum::extract::{Path, State};
use axum::http::HeaderMap;
use axum::response::Response;
use enfilade_dataset::loader_problem;
use enfilade_frame::{LAYERS, Layer, Pass};
use enfilade_scene::{Camera, Projection};
use enfilade_serve::{ApiProblem, reply};
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
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
        let (mut facts, lost) = viewer.camera_facts(&scene, &camera)?;
        facts["problems"] = json!(lost);
        Ok(reply::json(gzip, &facts))
    })
    .await
}

/// One view of a camera, as it is sent to the page.
#[derive(Default, Serialize)]
struct View {
    frame: u32,
    pose: Option<Value>,
    layers: Vec<usize>,
    /// The places in the camera's list of derived pictures.
    derived: Vec<usize>,
    complete: bool,
    faults: Vec<Fault>,
    /// The path of planning's picture of a view that it rejected.
    picture: Option<String>,
}

impl Viewer {
    /// Facts about a camera for the page, and the files that could not be read.
    fn camera_facts(&self, scene: &str, camera: &str) -> Result<(Value, Problems), ApiProblem> {
        let layout = self.layout();
        self.allow_all([layout.camera_parameters(), layout.metadata_camera(scene, camera)])?;
        let mut lost = Problems::default();
        let model = lost.or_nothing("frame", self.camera_model(scene, camera));
        let derived = self.derived(scene, camera, &mut lost);
        let mut views = self.views(scene, camera, model.as_ref(), &mut lost)?;
        for view in &mut views {
            view.derived = derived.of_frames.get(&view.frame).cloned().unwrap_or_default();
        }
        let tone = lost.or_nothing("display", self.tone_maps(scene, camera));
        let facts = json!({
            "name": camera,
            "frame_time_s": lost.or_nothing("frame", self.dataset.read_frame_time(scene, camera).map_err(problem).map(Some)),
            "projection": model.as_ref().map(projection),
            "loader_problem": model.as_ref().filter(|_| !self.dataset.is_released(scene)).and_then(loader_problem),
            "frames": views,
            "derived": derived.specs,
            "has_tracks": layout.tracks(scene, camera).is_file(),
            "tone": tone.iter().map(|row| json!([row.frame, row.scale, row.display_scale])).collect::<Vec<_>>(),
        });
        Ok((facts, lost))
    }

    /// The files of a camera's trajectory.
    pub(super) fn keyframes(&self, scene: &str, camera: &str) -> [PathBuf; 4] {
        ["positions", "orientations", "look_at_positions", "frame_indices"].map(|what| self.layout().keyframes(scene, camera, what))
    }

    /// Every frame that has a pose, a layer, a record or a verdict, by its number.
    fn views(&self, scene: &str, camera: &str, model: Option<&Camera>, lost: &mut Problems) -> Result<Vec<View>, ApiProblem> {
        let layout = self.layout();
        self.allow_all(self.keyframes(scene, camera))?;
        self.allow_all([layout.view_gates(scene, camera), layout.records_dir(scene, camera)])?;
        let mut views: BTreeMap<u32, View> = BTreeMap::new();
        let trajectory = lost.or_nothing("views", optional(self.dataset.read_trajectory(scene, camera)));
        for pose in trajectory.iter().flat_map(|trajectory| &trajectory.poses) {
            let rows = pose.world_from_camera.transpose().to_cols_array();
            let value = json!({ "position": pose.position.to_array(), "orientation": rows });
            views.entry(pose.frame).or_default().pose = Some(value);
        }
        for (frame, layers) in self.layers_of_frames(scene, camera, model)? {
            let has =
                |layer: &usize| LAYERS[*layer].pass != Pass::Rendered || self.dataset.has_layer(scene, camera, frame, LAYERS[*layer].layer);
            views.entry(frame).or_default().layers = layers.into_iter().filter(has).collect();
        }
        for frame in lost.or_nothing("frame", self.dataset.frame_numbers(scene, camera).map_err(problem)) {
            views.entry(frame).or_default().complete = true;
        }
        let report = self.report()?;
        for (frame, faults) in lost.or_nothing("views", self.faults(scene, camera, report.as_deref())) {
            views.entry(frame).or_default().faults = faults;
        }
        for (&frame, view) in &mut views {
            view.frame = frame;
            let place = FramePlace { scene: scene.into(), camera: camera.into(), frame };
            view.picture = if view.faults.is_empty() { None } else { self.rejected_picture(&place) };
        }
        Ok(views.into_values().collect())
    }

    /// For each frame that has any layer, the positions of its layers in [`LAYERS`]. Planar depth counts where it can be computed.
    pub(super) fn layers_of_frames(
        &self,
        scene: &str,
        camera: &str,
        model: Option<&Camera>,
    ) -> Result<BTreeMap<u32, BTreeSet<usize>>, ApiProblem> {
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
