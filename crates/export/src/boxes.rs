//! The box of every instance of a scene: its upright oriented box where the files are there, else the extents of its mesh.

use crate::ExportError;
use crate::mesh::SurfaceMesh;
use enfilade_dataset::{BoxKind, Dataset};
use enfilade_math::{DMat3, OrientedBox};
use std::collections::BTreeMap;

/// The box of every instance by its number, in metres.
pub(crate) fn instance_boxes(
    dataset: &Dataset,
    scene: &str,
    meshes: &BTreeMap<i16, SurfaceMesh>,
) -> Result<BTreeMap<i16, OrientedBox>, ExportError> {
    let kind = BoxKind::ObjectAligned2d;
    if !dataset.box_files(scene, kind).iter().all(|file| file.is_file()) {
        let extents = |mesh: &SurfaceMesh| OrientedBox::around(mesh.vertices.iter().copied(), DMat3::IDENTITY);
        return Ok(meshes.iter().filter_map(|(&number, mesh)| Some((number, extents(mesh)?))).collect());
    }
    let upright = |b: OrientedBox| OrientedBox { world_from_box: right_handed(b.world_from_box), ..b };
    let rows = (0i16..).zip(dataset.read_boxes(scene, kind)?);
    let known = rows.filter_map(|(number, row)| Some((number, upright(row?))));
    Ok(known.filter(|(_, b)| b.center.is_finite() && b.extents.is_finite() && b.world_from_box.is_finite()).collect())
}

/// Turns the third axis around where the matrix mirrors, as some of Hypersim's own do.
fn right_handed(m: DMat3) -> DMat3 {
    if m.determinant() < 0.0 { DMat3::from_cols(m.x_axis, m.y_axis, -m.z_axis) } else { m }
}
