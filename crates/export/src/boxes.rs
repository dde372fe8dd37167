//! The box of every instance of a scene: Hypersim's oriented boxes where their files are there, else the extents of the mesh.

use crate::ExportError;
use crate::mesh::{InstanceMesh, read_f64};
use enfilade_dataset::{Dataset, DatasetError};
use enfilade_math::{DMat3, DVec3};
use std::collections::BTreeMap;

/// A box in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct InstanceBox {
    /// Metres.
    pub center: DVec3,
    /// Columns are the box's axes in the world; a rotation.
    pub world_from_box: DMat3,
    /// Full lengths along the axes, metres.
    pub extents: DVec3,
}

/// The box of every instance by its number.
///
/// The files are `metadata_semantic_instance_bounding_box_object_aligned_2d_{positions,orientations,extents}.hdf5`: row `i` belongs
/// to instance `i` and is infinite where there is none; axes are columns; lengths are asset units.
pub(crate) fn instance_boxes(
    dataset: &Dataset,
    scene: &str,
    meshes: &BTreeMap<i16, InstanceMesh>,
) -> Result<BTreeMap<i16, InstanceBox>, ExportError> {
    let file =
        |what: &str| dataset.layout().mesh_file(scene, &format!("metadata_semantic_instance_bounding_box_object_aligned_2d_{what}.hdf5"));
    if !file("positions").is_file() {
        return Ok(meshes.iter().map(|(&number, mesh)| (number, extents_of(mesh))).collect());
    }
    let metres = dataset.meters_per_asset_unit(scene)?;
    let [positions, orientations, extents] = [read_f64(&file("positions"))?, read_f64(&file("orientations"))?, read_f64(&file("extents"))?];
    let n = positions.len() / 3;
    if orientations.len() != 9 * n || extents.len() != 3 * n || n > i16::MAX as usize {
        let problem = format!("{n} rows, but the files of orientations and extents have other lengths; make the boxes again");
        return Err(DatasetError::Hdf5 { path: file("positions"), problem }.into());
    }
    let row = |i: usize| InstanceBox {
        center: DVec3::from_slice(&positions[3 * i..]) * metres,
        world_from_box: right_handed(DMat3::from_cols_slice(&orientations[9 * i..]).transpose()),
        extents: DVec3::from_slice(&extents[3 * i..]) * metres,
    };
    let known = (1..n).map(|i| (i as i16, row(i)));
    Ok(known.filter(|(_, b)| b.center.is_finite() && b.extents.is_finite() && b.world_from_box.is_finite()).collect())
}

/// The axis-aligned box of a mesh, which has vertices.
fn extents_of(mesh: &InstanceMesh) -> InstanceBox {
    let (min, max) = mesh.vertices.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), &v| (a.min(v), b.max(v)));
    InstanceBox { center: 0.5 * (min + max), world_from_box: DMat3::IDENTITY, extents: max - min }
}

/// Turns the third axis around where the matrix mirrors.
fn right_handed(m: DMat3) -> DMat3 {
    if m.determinant() < 0.0 { DMat3::from_cols(m.x_axis, m.y_axis, -m.z_axis) } else { m }
}

impl InstanceBox {
    /// A world point in the box's own axes, from its centre.
    pub fn local(&self, p_world: DVec3) -> DVec3 {
        self.world_from_box.transpose() * (p_world - self.center)
    }
}
