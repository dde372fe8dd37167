//! A layer of a frame, or what was derived from it, as raw little-endian numbers, for the page to colour.
//!
//! `?step=N` keeps every Nth pixel of every Nth row, for a small picture that arrives at once. `?compact=1` is for slow connections: the
//! bytes of one significance are stored together (`x-enfilade-packing: planes`), and the whole is compressed if the browser accepts gzip.

use super::decoded_layer::{DecodedLayer, planes_of};
use super::picture::FramePicture;
use super::place::{FramePlace, problem, stamp};
use super::stored_picture::stored_image;
use super::summary::Summary;
use super::viewer::{Viewer, work};
use axum::extract::rejection::QueryRejection;
use axum::extract::{Path, Query, State};
use axum::http::{HeaderMap, header};
use axum::response::Response;
use enfilade_dataset::{Elements, ToneMapRow};
use enfilade_frame::tonemap::{ToneMap, brightness, percentile};
use enfilade_frame::{LAYERS, Layer};
use enfilade_serve::{ApiProblem, reply};
use serde::Deserialize;
use std::sync::Arc;

/// With a larger step a picture would have only a few pixels.
const MAX_STEP: usize = 64;

/// The query of a request for a layer.
#[derive(Debug, Default, Deserialize)]
pub struct LayerQuery {
    /// Distance between kept pixels and between kept rows; 1 when absent.
    step: Option<usize>,
    /// 1 for fewer bytes at the cost of more work.
    compact: Option<u8>,
}

/// `GET /api/view/layer/{scene}/{camera}/{frame}/{layer}`.
pub async fn layer(
    State(viewer): State<Arc<Viewer>>,
    Path((scene, camera, frame, name)): Path<(String, String, String, String)>,
    query: Result<Query<LayerQuery>, QueryRejection>,
    headers: HeaderMap,
) -> Result<Response, ApiProblem> {
    let place = FramePlace::parse([scene, camera, frame])?;
    let unknown = || {
        let names: Vec<&str> = LAYERS.iter().map(|spec| spec.name).collect();
        let help = format!("choose one of {}, or one that the camera's answer lists below derived", names.join(", "));
        ApiProblem::bad_request(format!("there is no layer {name:?}"), help)
    };
    let picture = FramePicture::from_name(&name).ok_or_else(unknown)?;
    let Query(query) = query.map_err(|e| ApiProblem::bad_request(e.body_text(), "step is a number from 1 to 64, compact is 0 or 1"))?;
    let step = query.step.unwrap_or(1);
    if !(1..=MAX_STEP).contains(&step) {
        return Err(ApiProblem::bad_request(format!("the step is {step}"), format!("choose one from 1 to {MAX_STEP}")));
    }
    let compact = query.compact.is_some_and(|compact| compact != 0);
    let gzip = compact && reply::takes_gzip(&headers);
    work(viewer, move |viewer| {
        let source = stamp(&viewer.source(&place, &picture));
        let decoded = viewer.picture(&place, &picture)?;
        let mut summary = decoded.summary.clone();
        if picture.spec(&[]).unit == "W/(sr m^2)" {
            summary.tone_scale = viewer.tone_scale(&place)?;
        }
        let ([height, width], bytes) = decoded.every(step);
        let size = decoded.values.element().size();
        let planes = compact && size > 1 && !matches!(decoded.values, Elements::I16(_));
        let bytes = if planes { planes_of(&bytes, size) } else { bytes };
        let mut headers = vec![
            ("x-enfilade-shape", format!("{height},{width},{}", decoded.shape[2])),
            ("x-enfilade-size", format!("{},{}", decoded.shape[0], decoded.shape[1])),
            ("x-enfilade-dtype", decoded.values.element().name().to_string()),
            ("x-enfilade-summary", serde_json::to_string(&summary).expect("plain data encodes")),
        ];
        if planes {
            headers.push(("x-enfilade-packing", "planes".to_string()));
        }
        // The tag is made from the file's stamp and the request: a digest of megabytes would cost more than it saves.
        let tag = reply::tag_of(format!("{source:?} {step} {compact} {gzip} {headers:?}").as_bytes());
        let mut response = reply::array(bytes, gzip, &headers);
        response.headers_mut().insert(header::ETAG, tag);
        Ok(response)
    })
    .await
}

impl Viewer {
    /// A layer of a frame, from memory or from its file. It is as stored, except that positions are in metres, and planar depth that is not
    /// stored is computed from the distances.
    ///
    /// # Errors
    /// 404 if there is no such file, 403 if it is outside of the dataset, 500 if it is damaged or another layer.
    pub(super) fn layer(&self, place: &FramePlace, layer: Layer) -> Result<Arc<DecodedLayer>, ApiProblem> {
        let FramePlace { scene, camera, frame } = place;
        let path = self.dataset.layer_source(scene, camera, *frame, layer);
        self.allow(&path)?;
        self.layers.get(&(place.clone(), FramePicture::Layer(layer)), stamp(&path), || {
            let spec = layer.spec();
            if path != self.layout().layer(scene, camera, *frame, layer)
                || (layer == Layer::Position && self.meters_per_unit(scene)? != 1.0)
            {
                let read = self.dataset.read_frame(scene, camera, *frame, &[layer]).map_err(problem)?;
                let values = read.get(layer).map(|values| Elements::from(values.clone()));
                let missing = || ApiProblem::not_found(format!("{}: no layer {}", path.display(), spec.name), "choose another layer");
                let (values, shape) = (values.ok_or_else(missing)?, [read.height as usize, read.width as usize, spec.channels]);
                return Ok(DecodedLayer { shape, summary: Summary::new(&layer.into(), &values), values });
            }
            let ([height, width], values) = stored_image(&path, spec.channels)?;
            Ok(DecodedLayer { shape: [height, width, spec.channels], summary: Summary::new(&layer.into(), &values), values })
        })
    }

    /// The scale of radiance in Hypersim's tone map of a frame, if `metadata_tonemap.csv` does not have it: `None` if it does, and if the
    /// frame has no color or no `render_entity_id`.
    fn tone_scale(&self, place: &FramePlace) -> Result<Option<f64>, ApiProblem> {
        let has = |layer| self.dataset.has_layer(&place.scene, &place.camera, place.frame, layer);
        let table = self.layout().tone_maps(&place.scene, &place.camera);
        if table.is_file() || !has(Layer::Color) || !has(Layer::RenderEntityId) {
            return Ok(None);
        }
        let (color, ids) = (self.layer(place, Layer::Color)?, self.layer(place, Layer::RenderEntityId)?);
        let (Elements::F16(color), Elements::I16(ids)) = (&color.values, &ids.values) else { return Ok(None) };
        let seen = color.chunks_exact(3).zip(ids).filter(|(_, id)| **id != -1);
        let values = seen.map(|(rgb, _)| brightness([rgb[0], rgb[1], rgb[2]].map(|x| f64::from(x.to_f32())))).collect();
        Ok(Some(ToneMap::of_percentile(percentile(values)).scale))
    }

    /// The exposures of a camera's frames, as far as there is a table of them.
    pub(super) fn tone_maps(&self, scene: &str, camera: &str) -> Result<Vec<ToneMapRow>, ApiProblem> {
        self.allow(&self.layout().tone_maps(scene, camera))?;
        self.dataset.read_tone_maps(scene, camera).map_err(problem)
    }
}
