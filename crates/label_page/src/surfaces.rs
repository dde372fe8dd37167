//! Data that the page draws: the faces, the colours of instances and of materials, and rendered pictures.

use super::answer::{Answer, Shared};
use axum::extract::rejection::QueryRejection;
use axum::extract::{Path, Query, State};
use axum::http::{HeaderMap, header};
use axum::response::IntoResponse;
use enfilade_serve::{ApiProblem, beside, reply};
use serde::Deserialize;

/// The query of a request for geometry.
#[derive(Deserialize)]
pub struct GeometryQuery {
    /// Only the first levels, up to this number of faces.
    most: Option<usize>,
}

/// The faces, the important ones first.
pub async fn geometry(State(app): Shared, query: Result<Query<GeometryQuery>, QueryRejection>, headers: HeaderMap) -> Answer {
    let gzip = reply::takes_gzip(&headers);
    let most = query.map_err(|e| ApiProblem::bad_request(e.body_text(), "most is a number of faces"))?.0.most;
    beside(move || {
        let session = app.session();
        let bytes = app.order().encode(session.pieces().of_face(), session.pieces().list().len(), most);
        drop(session);
        Ok(reply::array(bytes, gzip, &[]))
    })
    .await
}

/// Colours of all possible instance numbers, as the files have them: three bytes each, from number 0, which means none.
pub async fn instance_colors_of_files() -> Answer {
    beside(|| {
        let colors = enfilade_dataset::instance_colors(i16::MAX as usize);
        let bytes: Vec<u8> = colors.into_iter().flatten().map(|channel| u8::try_from(channel).unwrap_or(0)).collect();
        Ok(([(header::CONTENT_TYPE, "application/octet-stream")], bytes).into_response())
    })
    .await
}

/// Colour of each face, three bytes each.
pub async fn face_colors(State(app): Shared, headers: HeaderMap) -> Answer {
    let gzip = reply::takes_gzip(&headers);
    beside(move || match app.face_colors() {
        Ok(colors) => Ok(reply::array(colors.to_vec(), gzip, &[])),
        Err(problem) => Err(ApiProblem::not_found(problem.clone(), "look at the labels, or open the scene's file")),
    })
    .await
}

/// The rendered picture of a planned frame.
pub async fn photograph(State(app): Shared, Path((camera, frame)): Path<(String, String)>) -> Answer {
    beside(move || {
        let frames = app.scene().cameras.iter().filter(|one| one.name == camera).flat_map(|one| &one.frames);
        let path = frames.filter(|one| one.frame.to_string() == frame).find_map(|one| one.photograph.as_ref());
        let none = || ApiProblem::not_found(format!("frame {frame} of {camera:?} has no picture here"), "render it, with previews");
        let bytes = std::fs::read(path.ok_or_else(none)?).map_err(|_| none())?;
        Ok(([(header::CONTENT_TYPE, "image/jpeg"), (header::CACHE_CONTROL, "no-cache")], bytes).into_response())
    })
    .await
}
