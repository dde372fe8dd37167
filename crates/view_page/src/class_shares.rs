//! The share of each class in the frames of a scene. No table has it for things without an instance, such as walls, so the layer `semantic`
//! is counted, on the first request for a class.

use super::place::{FramePlace, problem, stamp};
use super::problems::Problems;
use super::shares::Shares;
use super::viewer::{Viewer, work};
use axum::extract::{Path, State};
use axum::http::HeaderMap;
use axum::response::Response;
use enfilade_dataset::Elements;
use enfilade_dataset::hdf5::read_array;
use enfilade_frame::Layer;
use enfilade_serve::{ApiProblem, reply};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::sync::Arc;

/// `GET /api/view/class_shares/{scene}`.
pub async fn class_shares(
    State(viewer): State<Arc<Viewer>>,
    Path(scene): Path<String>,
    headers: HeaderMap,
) -> Result<Response, ApiProblem> {
    let gzip = reply::takes_gzip(&headers);
    work(viewer, move |viewer| {
        viewer.check_scene(&scene)?;
        Ok(reply::json(gzip, &viewer.class_shares(&scene)?))
    })
    .await
}

impl Viewer {
    fn class_shares(&self, scene: &str) -> Result<Value, ApiProblem> {
        let mut places = Vec::new();
        for camera in self.dataset.cameras(scene).map_err(problem)? {
            self.check_camera(scene, &camera)?;
            let labelled =
                self.layers_of_frames(scene, &camera, None)?.into_iter().filter(|(_, layers)| layers.contains(&(Layer::Semantic as usize)));
            places.extend(labelled.map(|(frame, _)| FramePlace { scene: scene.into(), camera: camera.clone(), frame }));
        }
        let counted: Vec<_> = enfilade_parallel::map(&places, |place| self.shares(place));
        let mut lost = Problems::default();
        let mut seen = BTreeSet::new();
        let mut frames = Vec::new();
        for (place, shares) in places.iter().zip(counted) {
            let shares = lost.or_nothing("gallery", shares);
            seen.extend(shares.classes().map(|class| Some(i64::from(class))));
            frames.push(json!({ "camera": place.camera, "frame": place.frame, "shares": *shares }));
        }
        let classes = lost.or_nothing("gallery", self.classes(scene));
        let classes: Vec<_> = classes.into_iter().filter(|class| seen.contains(&class["id"].as_i64())).collect();
        Ok(json!({ "scene": scene, "classes": classes, "frames": frames, "problems": lost }))
    }

    fn shares(&self, place: &FramePlace) -> Result<Arc<Shares>, ApiProblem> {
        let path = self.dataset.layer_source(&place.scene, &place.camera, place.frame, Layer::Semantic);
        self.allow(&path)?;
        self.shares.get(place, stamp(&path), || {
            let array = read_array(&path).map_err(problem)?;
            let Elements::I16(classes) = &array.values else {
                let error = format!("{}: expected int16, found {}", path.display(), array.values.element().name());
                return Err(ApiProblem::failed(error, "delete the file and make it again"));
            };
            Ok(Shares::of(classes))
        })
    }
}
