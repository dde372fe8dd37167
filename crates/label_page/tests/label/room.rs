//! A small room, and a page that talks to the routes as a browser would.

use axum::Router;
use axum::body::Body;
use axum::http::{Request, StatusCode};
use enfilade_geometry::Mesh;
use enfilade_label_page::{AnnotateOptions, App, routes};
use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
use enfilade_scene::{Material, Part, Quiet, Scene};
use http_body_util::BodyExt;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tower::ServiceExt;

/// The parts of the room, in order. `behind` is behind `near`; `pair` are two boxes.
pub const PARTS: [&str; 6] = ["wall", "near", "behind", "left", "right", "pair"];

/// A box around the origin.
fn cube(size: f32) -> Mesh {
    let positions = (0..8).map(|i| size * (Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32) - 0.5)).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh { positions, triangles, ..Mesh::default() }
}

/// The room: a wall at y = 5, boxes in front of it.
pub fn scene() -> Scene {
    let wall = Mesh {
        positions: vec![Vec3::new(-9.0, 5.0, -9.0), Vec3::new(9.0, 5.0, -9.0), Vec3::new(9.0, 5.0, 9.0), Vec3::new(-9.0, 5.0, 9.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let moved = |mut mesh: Mesh, x: f32| {
        mesh.positions.iter_mut().for_each(|p| p.x += x);
        mesh
    };
    let mut pair = moved(cube(0.5), -1.0);
    pair.append(&moved(cube(0.5), 1.0));
    let at = |x: f64, y: f64, z: f64| DAffine3::from_translation(DVec3::new(x, y, z));
    let places = [DAffine3::IDENTITY, at(0.0, 0.0, 1.0), at(0.0, 2.0, 1.0), at(-2.0, 0.0, 1.0), at(2.0, 0.0, 1.0), at(0.0, 0.0, 3.0)];
    let meshes = [0, 1, 2, 1, 1, 3];
    let part =
        |i: usize| Part { name: PARTS[i].into(), object: None, mesh: meshes[i], material: u32::from(i > 0), world_from_mesh: places[i] };
    Scene {
        meshes: vec![wall.into(), cube(1.0).into(), cube(0.5).into(), pair.into()],
        parts: (0..PARTS.len()).map(part).collect(),
        materials: vec![Material::diffuse("plaster", Rgb::splat(0.8)), Material::diffuse("wood", Rgb::splat(0.4))],
        ..Scene::default()
    }
}

/// The room in a scene package in `folder`.
pub fn package(folder: &Path) -> PathBuf {
    let path = folder.join("room.scene");
    std::fs::write(&path, enfilade_scene::to_bytes(&scene())).unwrap();
    path
}

/// A view of all of it: `near` covers columns 41 to 58, `left` 3 to 20, `right` 80 to 97, rows 41 to 58; the boxes of `pair` columns
/// 26 to 34 and 65 to 73, rows 7 to 15.
pub fn camera() -> Value {
    json!({ "position": [0, -5, 1], "orientation": [1, 0, 0, 0, 0, -1, 0, 1, 0], "fov_y_deg": 60, "width": 100, "height": 100 })
}

/// A page of an open scene.
pub struct Page {
    pub app: Arc<App>,
    routes: Router,
}

impl Page {
    pub fn open(path: &Path) -> Self {
        Self::with(&AnnotateOptions { path: path.to_path_buf(), ..AnnotateOptions::default() })
    }

    pub fn with(options: &AnnotateOptions) -> Self {
        let app = Arc::new(App::open(options, &Quiet).unwrap());
        Self { routes: routes(app.clone()), app }
    }

    pub async fn ask(&self, request: Request<Body>) -> (StatusCode, Value) {
        let response = self.routes.clone().oneshot(request).await.unwrap();
        let status = response.status();
        let bytes = response.into_body().collect().await.unwrap().to_bytes();
        (status, serde_json::from_slice(&bytes).unwrap_or(Value::Null))
    }

    pub async fn get(&self, path: &str) -> Value {
        let (status, body) = self.ask(Request::get(format!("/api/annotate/{path}")).body(Body::empty()).unwrap()).await;
        assert_eq!(status, StatusCode::OK, "{path}: {body}");
        body
    }

    pub async fn bytes(&self, path: &str, headers: &[(&str, &str)]) -> (axum::http::HeaderMap, Vec<u8>) {
        let mut request = Request::get(format!("/api/annotate/{path}"));
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        let response = self.routes.clone().oneshot(request.body(Body::empty()).unwrap()).await.unwrap();
        let headers = response.headers().clone();
        (headers, response.into_body().collect().await.unwrap().to_bytes().to_vec())
    }

    /// The first event after a revision.
    pub async fn first_event(&self, path: &str) -> String {
        let request = Request::get(format!("/api/annotate/{path}")).body(Body::empty()).unwrap();
        let mut body = self.routes.clone().oneshot(request).await.unwrap().into_body();
        let frame = body.frame().await.unwrap().unwrap();
        String::from_utf8(frame.into_data().unwrap().to_vec()).unwrap()
    }

    pub async fn post(&self, path: &str, body: impl Into<Body>) -> (StatusCode, Value) {
        self.ask(Request::post(format!("/api/annotate/{path}")).body(body.into()).unwrap()).await
    }

    /// An action that must succeed.
    pub async fn act(&self, action: Value) -> Value {
        let (status, change) = self.post("edit", json!({ "client": "test", "action": action }).to_string()).await;
        assert_eq!(status, StatusCode::OK, "{change}");
        change
    }

    /// An action that must fail; its status and error.
    pub async fn refused(&self, action: Value) -> (u16, String) {
        let (status, body) = self.post("edit", json!({ "client": "test", "action": action }).to_string()).await;
        assert!(status.is_client_error(), "{body}");
        (status.as_u16(), body["error"].as_str().unwrap().to_string())
    }

    /// Pieces that a look selects.
    pub async fn selected(&self, shape: Value, more: Value) -> Vec<u64> {
        let mut look = json!({ "camera": camera(), "shape": shape });
        more.as_object().unwrap().iter().for_each(|(key, value)| look[key] = value.clone());
        let (status, body) = self.post("select", look.to_string()).await;
        assert_eq!(status, StatusCode::OK, "{body}");
        body["pieces"].as_array().unwrap().iter().map(|piece| piece.as_u64().unwrap()).collect()
    }

    /// Class and instance of every piece.
    pub async fn labels(&self) -> Vec<(i64, i64)> {
        let pieces = self.get("pieces").await;
        let column = |name: &str| pieces[name].as_array().unwrap().iter().map(|v| v.as_i64().unwrap()).collect::<Vec<_>>();
        column("semantic").into_iter().zip(column("instance")).collect()
    }
}

/// Labels by class.
pub fn class(id: i64) -> Value {
    json!({ "layer": "semantic", "value": id })
}

/// Labels what a stroke touches.
pub fn stroke(shape: Value, apply: Value) -> Value {
    json!({ "type": "stroke", "camera": camera(), "shape": shape, "apply": apply })
}

/// Labels pieces.
pub fn assign(pieces: &[u32], apply: Value) -> Value {
    json!({ "type": "assign", "pieces": pieces, "apply": apply })
}
