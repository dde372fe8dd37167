//! The frames of a scene, each with its numbers, to sort and to choose by. Nothing is computed from pixels: the numbers come from the
//! report of verification, the frames' records and the tables.

use super::faults::Fault;
use super::place::{FramePlace, optional, problem, version};
use super::problems::Problems;
use super::report::Report;
use super::viewer::{Viewer, work};
use axum::extract::{Path, State};
use axum::http::HeaderMap;
use axum::response::Response;
use enfilade_frame::Layer;
use enfilade_serve::{ApiProblem, reply};
use enfilade_verify::frame_gates::Gate;
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// `GET /api/view/gallery/{scene}`.
pub async fn gallery(State(viewer): State<Arc<Viewer>>, Path(scene): Path<String>, headers: HeaderMap) -> Result<Response, ApiProblem> {
    let gzip = reply::takes_gzip(&headers);
    work(viewer, move |viewer| {
        viewer.check_scene(&scene)?;
        Ok(reply::json(gzip, &viewer.gallery(&scene)?))
    })
    .await
}

/// A frame, or a view that was rejected. What is not known is null; shares are of 1.
#[derive(Debug, Default, Serialize)]
struct Entry {
    camera: String,
    frame: u32,
    /// Changes with the frame's picture; null where it has none.
    version: Option<String>,
    /// The path of planning's picture of a view that it rejected.
    picture: Option<String>,
    /// Noise of the rendered color.
    noise: Option<f64>,
    /// Share of the pixels that the tone map shows as white.
    clipped: Option<f64>,
    /// Share of the pixels that the tone map shows as black.
    black: Option<f64>,
    /// Factor of radiance before the gamma curve of the tone map.
    exposure: Option<f64>,
    /// Largest minus smallest planar depth, metres.
    depth_range: Option<f64>,
    /// Share of the pixels that see the scene that have a class.
    coverage: Option<f64>,
    /// Instances that are seen.
    objects: Option<usize>,
    /// `train`, `val`, `test`, or why the frame is in none.
    partition: Option<String>,
    faults: Vec<Fault>,
    /// Laws whose worst violation is in the frame.
    laws: Vec<String>,
}

/// Tables about a camera's frames.
struct Tables {
    report: Option<Arc<Report>>,
    exposures: HashMap<u32, f64>,
    objects: Option<HashMap<u32, usize>>,
    partitions: HashMap<u32, String>,
    laws: HashMap<u32, Vec<String>>,
}

impl Viewer {
    fn gallery(&self, scene: &str) -> Result<Value, ApiProblem> {
        let mut lost = Problems::default();
        let mut entries = Vec::new();
        self.allow(&self.layout().metadata_cameras(scene))?;
        for camera in lost.or_nothing("gallery", self.dataset.cameras(scene).map_err(problem)) {
            self.check_camera(scene, &camera)?;
            let tables = self.tables(scene, &camera, &mut lost)?;
            let faults = lost.or_nothing("gallery", self.faults(scene, &camera, tables.report.as_deref()));
            let mut frames: BTreeMap<u32, Vec<Fault>> =
                self.layers_of_frames(scene, &camera, None)?.into_keys().map(|f| (f, vec![])).collect();
            frames.extend(faults);
            for (frame, faults) in frames {
                let place = FramePlace { scene: scene.into(), camera: camera.clone(), frame };
                entries.push(self.entry(&place, faults, &tables));
            }
        }
        Ok(json!({ "scene": scene, "frames": entries, "problems": lost }))
    }

    fn tables(&self, scene: &str, camera: &str, lost: &mut Problems) -> Result<Tables, ApiProblem> {
        let layout = self.layout();
        self.allow_all([layout.view_gates(scene, camera), layout.frame_instances(scene, camera), layout.partition()])?;
        self.allow(&layout.records_dir(scene, camera))?;
        let report = self.report()?;
        let exposures = lost.or_nothing("gallery", self.tone_maps(scene, camera)).iter().map(|row| (row.frame, row.scale)).collect();
        let views = lost.or_nothing("gallery", optional(self.dataset.read_instance_views(scene, camera)));
        let objects = views.map(|views| {
            let mut counts = HashMap::new();
            views.iter().filter(|view| view.visible.pixels > 0).for_each(|view| *counts.entry(view.frame).or_default() += 1);
            counts
        });
        let rows = lost.or_nothing("gallery", optional(self.dataset.read_partition())).unwrap_or_default();
        let mine = rows.iter().filter(|row| row.scene == scene && row.camera == camera);
        let partitions =
            mine.map(|row| (row.frame, row.side.as_ref().map_or_else(ToString::to_string, |part| part.name().into()))).collect();
        let mut laws: HashMap<u32, Vec<String>> = HashMap::new();
        for law in report.iter().flat_map(|report| report.report.failures()) {
            if let Some(frame) = frame_of(&law.place, scene, camera) {
                laws.entry(frame).or_default().push(law.statement.clone());
            }
        }
        Ok(Tables { report, exposures, objects, partitions, laws })
    }

    fn entry(&self, place: &FramePlace, faults: Vec<Fault>, tables: &Tables) -> Entry {
        let FramePlace { scene, camera, frame } = place;
        let judged = tables.report.as_ref().and_then(|report| report.frame(place));
        let pictured =
            [Layer::Color, Layer::ColorRendered, Layer::DepthMeters].map(|layer| self.layout().layer(scene, camera, *frame, layer));
        let picture = pictured.into_iter().find(|path| path.is_file());
        // The record is read where nothing was verified yet.
        let record = || self.dataset.frame_record(scene, camera, *frame).ok().flatten()?.sampling?.noise;
        Entry {
            camera: camera.clone(),
            frame: *frame,
            version: picture.map(|path| version(&path)),
            picture: if faults.is_empty() { None } else { self.rejected_picture(place) },
            noise: judged.map_or_else(record, |values| values.noise),
            clipped: judged.and_then(|values| values.clipped_share),
            black: judged.and_then(|values| values.black_share),
            exposure: judged.and_then(|values| values.tone_map_scale).or_else(|| tables.exposures.get(frame).copied()),
            depth_range: judged.and_then(|values| values.gates.get(&Gate::DepthRange).copied().flatten()),
            coverage: judged.and_then(|values| values.labelled_share),
            objects: tables.objects.as_ref().map(|objects| objects.get(frame).copied().unwrap_or(0)),
            partition: tables.partitions.get(frame).cloned(),
            faults,
            laws: tables.laws.get(frame).cloned().unwrap_or_default(),
        }
    }
}

/// The frame in a place such as `room/cam_00/frame.0012, pixel 3, 4`; `None` where it is of another camera.
fn frame_of(place: &str, scene: &str, camera: &str) -> Option<u32> {
    let rest = place.strip_prefix(scene)?.strip_prefix('/')?.strip_prefix(camera)?.strip_prefix("/frame.")?;
    rest[..rest.bytes().take_while(u8::is_ascii_digit).count()].parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_of_laws_name_frames() {
        assert_eq!(frame_of("room/cam_00/frame.0012, pixel 3, 4", "room", "cam_00"), Some(12));
        assert_eq!(frame_of("room/cam_00/frame.12345", "room", "cam_00"), Some(12345));
        for other in ["room/cam_01/frame.0012", "room2/cam_00/frame.0012", "room", "room/cam_00", "room/cam_00/frame."] {
            assert_eq!(frame_of(other, "room", "cam_00"), None, "{other}");
        }
    }
}
