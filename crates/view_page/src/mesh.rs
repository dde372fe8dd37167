//! The faces of a scene as a buffer for the page's 3D view ([`DisplayOrder`]). Its pieces are the objects of the mesh folder.

use super::place::{problem, stamp};
use super::viewer::{Viewer, work};
use axum::extract::{Path, State};
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::{Array, Elements, mesh_names};
use enfilade_math::Vec3;
use enfilade_serve::DisplayOrder;
use enfilade_serve::{ApiProblem, reply};
use std::sync::Arc;

/// `GET /api/view/scene/{scene}/geometry`.
pub async fn geometry(State(viewer): State<Arc<Viewer>>, Path(scene): Path<String>, headers: HeaderMap) -> Result<Response, ApiProblem> {
    let gzip = reply::takes_gzip(&headers);
    work(viewer, move |viewer| {
        viewer.check_scene(&scene)?;
        let path = viewer.layout().mesh_file(&scene, mesh_names::VERTICES);
        viewer.allow(&path)?;
        let stamp = stamp(&path);
        let tag = reply::tag_of(format!("{stamp:?} {gzip}").as_bytes());
        if reply::has(&headers, &tag) {
            return Ok((StatusCode::NOT_MODIFIED, [(header::ETAG, tag)]).into_response());
        }
        let bytes = viewer.buffers.get(&(scene.clone(), "geometry"), stamp, || viewer.encode_mesh(&scene))?;
        let mut response = reply::array(bytes.to_vec(), gzip, &[]);
        response.headers_mut().insert(header::ETAG, tag);
        Ok(response)
    })
    .await
}

impl Viewer {
    fn encode_mesh(&self, scene: &str) -> Result<Vec<u8>, ApiProblem> {
        let metres = self.meters_per_unit(scene)?;
        let read = |name: &str| -> Result<(Array, String), ApiProblem> {
            let path = self.layout().mesh_file(scene, name);
            self.allow(&path)?;
            Ok((read_array(&path).map_err(problem)?, path.display().to_string()))
        };
        let wrong = |path: &str, found: &str| ApiProblem::failed(format!("{path}: {found}"), "make the scene's mesh folder again");
        let (vertices, path) = read(mesh_names::VERTICES)?;
        let Elements::F64(vertices) = vertices.values else { return Err(wrong(&path, "expected float64")) };
        let point = |p: &[f64]| Vec3::new((p[0] * metres) as f32, (p[1] * metres) as f32, (p[2] * metres) as f32);
        let points: Vec<Vec3> = vertices.chunks_exact(3).map(point).collect();
        let (faces, path) = read(mesh_names::FACES_VERTICES)?;
        let corners: Option<Vec<[Vec3; 3]>> = integers(&faces.values)
            .ok_or_else(|| wrong(&path, "expected integers"))?
            .chunks_exact(3)
            .map(|face| Some([corner(&points, face[0])?, corner(&points, face[1])?, corner(&points, face[2])?]))
            .collect();
        let corners = corners.ok_or_else(|| wrong(&path, "a face has a vertex that mesh_vertices.hdf5 lacks"))?;
        let (objects, path) = read(mesh_names::FACES_OBJECTS)?;
        let objects = integers(&objects.values).filter(|objects| objects.len() == corners.len());
        let objects = objects.ok_or_else(|| wrong(&path, "expected one integer per face"))?;
        // As in Hypersim's own tool, a face without object belongs to object 0.
        let objects: Vec<u32> = objects.into_iter().map(|object| u32::try_from(object).unwrap_or(0)).collect();
        let pieces = objects.iter().max().map_or(0, |&max| max as usize + 1);
        Ok(DisplayOrder::new(&corners).encode(&objects, pieces, None))
    }
}

fn corner(points: &[Vec3], index: i64) -> Option<Vec3> {
    points.get(usize::try_from(index).ok()?).copied()
}

/// Integers of either width; `None` for other elements.
fn integers(values: &Elements) -> Option<Vec<i64>> {
    match values {
        Elements::I64(v) => Some(v.clone()),
        Elements::I16(v) => Some(v.iter().map(|&x| i64::from(x)).collect()),
        _ => None,
    }
}
