//! Free and occupied space of a scene, as cubes.
//!
//! Little-endian: magic `ENFSPAC1`, f32 edge of a voxel in metres, u32 number of free cubes, u32 number of occupied cubes, u32 0;
//! then for each cube f32 x, y, z of its smallest corner and f32 edge, in metres, the free ones first.

use super::place::{problem, stamp};
use super::viewer::{Viewer, work};
use axum::extract::{Path, State};
use axum::http::HeaderMap;
use axum::response::Response;
use enfilade_dataset::DatasetError;
use enfilade_geometry::{OccupancyTree, Voxel};
use enfilade_serve::{ApiProblem, reply};
use std::sync::Arc;

/// `GET /api/view/scene/{scene}/space`.
pub async fn space(State(viewer): State<Arc<Viewer>>, Path(scene): Path<String>, headers: HeaderMap) -> Result<Response, ApiProblem> {
    let gzip = reply::takes_gzip(&headers);
    work(viewer, move |viewer| {
        viewer.check_scene(&scene)?;
        let path = viewer.layout().octomap(&scene);
        viewer.allow(&path)?;
        let metres = viewer.meters_per_unit(&scene)?;
        let bytes = viewer.buffers.get(&(scene.clone(), "space"), stamp(&path), || {
            let file = std::fs::read(&path).map_err(|source| problem(DatasetError::Io { action: "read", path: path.clone(), source }))?;
            let damaged = |e| ApiProblem::failed(format!("{}: {e}", path.display()), "run the carve stage again");
            Ok::<_, ApiProblem>(cubes(&OccupancyTree::from_bt(&file).map_err(damaged)?, metres))
        })?;
        Ok(reply::array(bytes.to_vec(), gzip, &[]))
    })
    .await
}

/// The buffer of a tree whose unit is this many metres.
fn cubes(tree: &OccupancyTree, metres: f64) -> Vec<u8> {
    let edge = tree.resolution_m() * metres;
    let of = |state: Voxel| tree.leaves().filter(move |leaf| leaf.state == state);
    let mut bytes = b"ENFSPAC1".to_vec();
    bytes.extend((edge as f32).to_le_bytes());
    for count in [of(Voxel::Free).count() as u32, of(Voxel::Occupied).count() as u32, 0] {
        bytes.extend(count.to_le_bytes());
    }
    for leaf in of(Voxel::Free).chain(of(Voxel::Occupied)) {
        let corner = leaf.key.corner(tree.resolution_m()) * metres;
        let side = edge * f64::from(1u32 << leaf.level);
        [corner.x, corner.y, corner.z, side].iter().for_each(|&v| bytes.extend((v as f32).to_le_bytes()));
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::DVec3;

    #[test]
    fn cubes_are_where_the_voxels_are() {
        let mut tree = OccupancyTree::new(0.25);
        tree.set(tree.key(DVec3::new(1.1, 0.1, 0.1)).unwrap(), Voxel::Occupied);
        tree.set(tree.key(DVec3::new(0.1, 0.1, 0.1)).unwrap(), Voxel::Free);
        let bytes = cubes(&tree, 2.0);
        let float = |at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        assert_eq!((&bytes[..8], float(8), bytes[12], bytes[16], bytes.len()), (&b"ENFSPAC1"[..], 0.5, 1, 1, 24 + 32));
        assert_eq!([24, 28, 32, 36].map(float), [0.0, 0.0, 0.0, 0.5]);
        assert_eq!([40, 44, 48, 52].map(float), [2.0, 0.0, 0.0, 0.5]);
    }
}
