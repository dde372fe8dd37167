//! The addresses of the page's data, and which handler answers each.

use super::viewer::Viewer;
use super::{camera, catalogue, class_shares, files, frame, gallery, layers, mesh, pairs, points, scene, space, thumbnail, tracks};
use axum::Router;
use axum::routing::get;
use std::sync::Arc;

/// The routes of the page, all under `/api/view`.
pub fn router(viewer: Viewer) -> Router {
    Router::new()
        .route("/api/view/dataset", get(catalogue::dataset))
        .route("/api/view/scene/{scene}", get(scene::scene))
        .route("/api/view/scene/{scene}/geometry", get(mesh::geometry))
        .route("/api/view/scene/{scene}/space", get(space::space))
        .route("/api/view/camera/{scene}/{camera}", get(camera::camera))
        .route("/api/view/frame/{scene}/{camera}/{frame}", get(frame::frame))
        .route("/api/view/gallery/{scene}", get(gallery::gallery))
        .route("/api/view/class_shares/{scene}", get(class_shares::class_shares))
        .route("/api/view/pairs/{scene}/{camera}/{frame}", get(pairs::pairs))
        .route("/api/view/tracks/{scene}/{camera}", get(tracks::tracks))
        .route("/api/view/points/{scene}/{camera}/{frame}", get(points::points))
        .route("/api/view/thumbnail/{scene}/{camera}/{frame}", get(thumbnail::thumbnail))
        .route("/api/view/layer/{scene}/{camera}/{frame}/{layer}", get(layers::layer))
        .route("/api/view/file/{*path}", get(files::file))
        .with_state(Arc::new(viewer))
}
