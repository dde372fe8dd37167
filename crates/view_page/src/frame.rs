//! Everything about a frame except its layers: its records, its side of the partition, how much it shows of each instance, and what verification measured.

use super::place::{FramePlace, optional, problem};
use super::problems::Problems;
use super::viewer::{Viewer, work};
use axum::extract::{Path, State};
use axum::http::HeaderMap;
use axum::response::Response;
use enfilade_serve::{ApiProblem, reply};
use serde_json::{Value, json};
use std::sync::Arc;

/// `GET /api/view/frame/{scene}/{camera}/{frame}`.
pub async fn frame(
    State(viewer): State<Arc<Viewer>>,
    Path((scene, camera, frame)): Path<(String, String, String)>,
    headers: HeaderMap,
) -> Result<Response, ApiProblem> {
    let gzip = reply::takes_gzip(&headers);
    let place = FramePlace::parse([scene, camera, frame])?;
    work(viewer, move |viewer| {
        viewer.check_camera(&place.scene, &place.camera)?;
        Ok(reply::json(gzip, &viewer.frame_facts(&place)?))
    })
    .await
}

impl Viewer {
    fn frame_facts(&self, place: &FramePlace) -> Result<Value, ApiProblem> {
        let FramePlace { scene, camera, frame } = place;
        let layout = self.layout();
        self.allow_all([
            layout.frame_record(scene, camera, *frame),
            layout.label_record(scene, camera, *frame),
            layout.frame_instances(scene, camera),
            layout.partition(),
            layout.verify_report(),
        ])?;
        let mut lost = Problems::default();
        let record = lost.or_nothing("frame", self.dataset.frame_record(scene, camera, *frame).map_err(problem));
        let labels = lost.or_nothing("frame", self.dataset.label_record(scene, camera, *frame).map_err(problem));
        let views = lost.or_nothing("objects", optional(self.dataset.read_instance_views(scene, camera))).unwrap_or_default();
        let instances: Vec<Value> = views
            .iter()
            .filter(|view| view.frame == *frame)
            .map(|view| {
                json!({ "instance": view.instance, "semantic": view.semantic, "visible_pixels": view.visible.pixels,
                    "visible_box": view.visible.bounds, "full_box": view.full.bounds,
                    "visibility": view.visibility(), "truncation": view.truncation() })
            })
            .collect();
        let rows = lost.or_nothing("frame", optional(self.dataset.read_partition())).unwrap_or_default();
        let row = rows.iter().find(|row| row.scene == *scene && row.camera == *camera && row.frame == *frame);
        let split = row.map(|row| match &row.side {
            Ok(partition) => json!({ "partition": partition.name() }),
            Err(reason) => json!({ "excluded": reason }),
        });
        // As text, because numbers in a browser are exact only up to 2^53.
        let seed = record.as_ref().map(|record| record.seed.to_string());
        let mut record = json!(record);
        if let Some(seed) = seed {
            record["seed"] = seed.into();
        }
        let words = self.words(place, &mut lost);
        let tables = lost.or_nothing("frame", self.tables_of_sensors(place));
        Ok(json!({ "record": record, "labels": labels, "instances": instances, "split": split, "words": words, "sensor_tables": tables,
            "judged": self.report()?.and_then(|report| report.frame(place).map(|values| json!(values))), "problems": lost }))
    }
}
