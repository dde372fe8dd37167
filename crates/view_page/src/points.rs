//! A frame as points in space: the end of the ray through each pixel's centre, in the colour of the pixel.
//!
//! Little-endian: magic `ENFPNTS1`, u32 number of points N, u32 0, f32 N × 3 positions in metres, u8 N × 4 red, green, blue (sRGB) and
//! 255. Points are taken along the camera's own rays, so every camera model gives the right ones.

use super::place::{FramePlace, problem};
use super::viewer::{Viewer, work};
use axum::extract::rejection::QueryRejection;
use axum::extract::{Path, Query, State};
use axum::http::HeaderMap;
use axum::response::Response;
use enfilade_frame::Layer;
use enfilade_scene::CameraView;
use enfilade_serve::{ApiProblem, reply};
use serde::Deserialize;
use std::sync::Arc;

/// Points of a reply without `?most=N`.
const MAX_POINTS: usize = 200_000;

/// The query of a request for points.
#[derive(Debug, Deserialize)]
pub struct PointsQuery {
    /// Maximum number of points, evenly spread over the image.
    most: Option<usize>,
}

/// `GET /api/view/points/{scene}/{camera}/{frame}`.
pub async fn points(
    State(viewer): State<Arc<Viewer>>,
    Path((scene, camera, frame)): Path<(String, String, String)>,
    query: Result<Query<PointsQuery>, QueryRejection>,
    headers: HeaderMap,
) -> Result<Response, ApiProblem> {
    let place = FramePlace::parse([scene, camera, frame])?;
    let wrong = |e: QueryRejection| ApiProblem::bad_request(e.body_text(), "most is a number of points, 1 or more");
    let max_points = query.map_err(wrong)?.0.most.unwrap_or(MAX_POINTS).max(1);
    let gzip = reply::takes_gzip(&headers);
    work(viewer, move |viewer| {
        viewer.check_camera(&place.scene, &place.camera)?;
        Ok(reply::array(viewer.cloud(&place, max_points)?, gzip, &[]))
    })
    .await
}

impl Viewer {
    fn cloud(&self, place: &FramePlace, max_points: usize) -> Result<Vec<u8>, ApiProblem> {
        let depth = self.layer(place, Layer::DepthMeters)?;
        let [height, width, _] = depth.shape;
        let missing = |what: &str| ApiProblem::not_found(format!("there is no {what} for this frame"), "run the plan stage for the scene");
        let camera = self.camera_model(&place.scene, &place.camera)?.ok_or_else(|| missing("camera model"))?;
        if camera.size() != [width as u32, height as u32] {
            let error = format!("depth_meters has {width} x {height} pixels, but the camera {:?}", camera.size());
            return Err(ApiProblem::failed(error, "make the frame again"));
        }
        let trajectory = self.dataset.read_trajectory(&place.scene, &place.camera).map_err(problem)?;
        let index = trajectory.poses.iter().position(|pose| pose.frame == place.frame).ok_or_else(|| missing("pose"))?;
        let view = CameraView::of_frame(&camera, &trajectory.poses, index);
        let colors = self.tone_mapped(place, height * width)?;
        let step = ((height * width).div_ceil(max_points) as f64).sqrt().ceil() as usize;
        let (mut positions, mut paint) = (Vec::new(), Vec::new());
        for (y, x) in (0..height).step_by(step).flat_map(|y| (0..width).step_by(step).map(move |x| (y, x))) {
            let at = y * width + x;
            let metres = depth.number(at);
            let Some(ray) = view.centre_ray(x as f64 + 0.5, y as f64 + 0.5).filter(|_| metres.is_finite()) else { continue };
            let point = ray.origin + ray.direction * metres;
            positions.extend(point.as_vec3().to_array().map(f32::to_le_bytes).concat());
            let [r, g, b] = colors.as_ref().map_or([180; 3], |colors| colors[at]);
            paint.extend([r, g, b, 255]);
        }
        let mut bytes = b"ENFPNTS1".to_vec();
        bytes.extend(((paint.len() / 4) as u32).to_le_bytes());
        bytes.extend(0u32.to_le_bytes());
        Ok([bytes, positions, paint].concat())
    }
}
