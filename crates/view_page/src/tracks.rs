//! Points that are followed through the frames of a camera, to be drawn over its pictures.
//!
//! Little-endian: magic `ENFTRKS1`, u32 number of points N, u32 number of frames T, u32 × T numbers of the frames, f32 N × T × 2 places as
//! shares of width and height, u8 N × T: 1 where the point is hidden or outside of the image.

use super::place::{problem, stamp};
use super::viewer::{Viewer, work};
use axum::extract::{Path, State};
use axum::http::HeaderMap;
use axum::response::Response;
use enfilade_dataset::Tracks;
use enfilade_serve::{ApiProblem, reply};
use std::sync::Arc;

/// `GET /api/view/tracks/{scene}/{camera}`.
pub async fn tracks(
    State(viewer): State<Arc<Viewer>>,
    Path((scene, camera)): Path<(String, String)>,
    headers: HeaderMap,
) -> Result<Response, ApiProblem> {
    let gzip = reply::takes_gzip(&headers);
    work(viewer, move |viewer| {
        viewer.check_camera(&scene, &camera)?;
        let path = viewer.layout().tracks(&scene, &camera);
        viewer.allow(&path)?;
        let key = (format!("{scene}/{camera}"), "tracks");
        let bytes = viewer.buffers.get(&key, stamp(&path), || viewer.dataset.read_tracks(&scene, &camera).map(buffer).map_err(problem))?;
        Ok(reply::array(bytes.to_vec(), gzip, &[]))
    })
    .await
}

fn buffer(tracks: Tracks) -> Vec<u8> {
    let mut bytes = b"ENFTRKS1".to_vec();
    let words = [tracks.positions.len() as u32, tracks.frames.len() as u32].into_iter().chain(tracks.frames);
    bytes.extend(words.flat_map(u32::to_le_bytes));
    bytes.extend(tracks.points.as_flattened().iter().flat_map(|v| v.to_le_bytes()));
    bytes.extend(tracks.occluded.into_iter().map(u8::from));
    bytes
}
