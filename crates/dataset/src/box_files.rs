//! The bounding boxes of semantic instances: three arrays per kind in the mesh folder, as Hypersim's toolkit writes them.
//!
//! Row i is instance i: `positions` (n,3) are the centres, `extents` (n,3) the side lengths, both in asset units (metres in our datasets),
//! and `orientations` (n,3,3) take box coordinates to the world, so that their columns are the directions of the sides. Everything is
//! float64. Row 0, and the row of every number that no object has, contains +∞, as in Hypersim's files (its maintainer speaks of NaN).

use crate::hdf5::{Array, Elements, Storage, read_array, write_array};
use crate::{Dataset, DatasetError, check_name, replace_file};
use enfilade_math::{DMat3, DVec3, OrientedBox};
use std::path::PathBuf;

/// A kind of bounding box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoxKind {
    /// Along the world's axes.
    AxisAligned,
    /// Upright: the rectangle of minimum area in the ground plane.
    ObjectAligned2d,
    /// A box of nearly minimum volume.
    ObjectAligned3d,
}

impl BoxKind {
    /// All kinds; `ALL[kind as usize] == kind`.
    pub const ALL: [Self; 3] = [Self::AxisAligned, Self::ObjectAligned2d, Self::ObjectAligned3d];

    /// Hypersim's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::AxisAligned => "axis_aligned",
            Self::ObjectAligned2d => "object_aligned_2d",
            Self::ObjectAligned3d => "object_aligned_3d",
        }
    }
}

impl Dataset {
    /// The three files of a kind of box: extents, orientations, positions.
    pub fn box_files(&self, scene: &str, kind: BoxKind) -> [PathBuf; 3] {
        ["extents", "orientations", "positions"].map(|what| {
            let name = format!("metadata_semantic_instance_bounding_box_{}_{what}.hdf5", kind.name());
            self.layout().mesh_file(scene, &name)
        })
    }

    /// Writes the boxes of a kind; entry i is instance i.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_boxes(&self, scene: &str, kind: BoxKind, boxes: &[Option<OrientedBox>]) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        let rows = |of: fn(&OrientedBox) -> DVec3| {
            let row = |b: &Option<OrientedBox>| b.as_ref().map_or(DVec3::INFINITY, of).to_array();
            Array::f64(&[boxes.len(), 3], boxes.iter().flat_map(row).collect())
        };
        let turned = |b: &Option<OrientedBox>| match b {
            // The transpose's columns are the rows of the matrix, which are stored one after the other.
            Some(b) => b.world_from_box.transpose().to_cols_array(),
            None => [f64::INFINITY; 9],
        };
        let orientations = Array::f64(&[boxes.len(), 3, 3], boxes.iter().flat_map(turned).collect());
        let arrays = [rows(|b| b.extents), orientations, rows(|b| b.center)];
        self.box_files(scene, kind)
            .iter()
            .zip(&arrays)
            .try_for_each(|(path, array)| replace_file(path, |aside| write_array(aside, array, Storage::Contiguous, &[])))
    }

    /// The boxes of a kind in metres; entry i is instance i. If the unit is not recorded, our own files are taken to be in metres.
    ///
    /// # Errors
    /// When a file is missing or damaged, the three do not belong together, or the unit of a release is not recorded.
    pub fn read_boxes(&self, scene: &str, kind: BoxKind) -> Result<Vec<Option<OrientedBox>>, DatasetError> {
        let files = self.box_files(scene, kind);
        let read = |index: usize, width: usize| {
            let Array { values, shape } = read_array(&files[index])?;
            match values {
                Elements::F64(values) if shape.first().is_some_and(|&rows| values.len() == rows * width) => Ok(values),
                other => {
                    let found = format!("{} of shape {shape:?}", other.element().name());
                    Err(DatasetError::hdf5(&files[index], format!("expected float64 with {width} values per row, found {found}")))
                }
            }
        };
        let (extents, orientations, positions) = (read(0, 3)?, read(1, 9)?, read(2, 3)?);
        if orientations.len() != 3 * extents.len() || positions.len() != extents.len() {
            let problem = "it has another number of rows than the positions or orientations beside it; run the boxes stage again";
            return Err(DatasetError::hdf5(&files[0], problem));
        }
        let metres = self.meters_per_stored_unit(scene)?;
        let row = |i: usize| OrientedBox {
            center: DVec3::from_slice(&positions[3 * i..]) * metres,
            world_from_box: DMat3::from_cols_slice(&orientations[9 * i..]).transpose(),
            extents: DVec3::from_slice(&extents[3 * i..]) * metres,
        };
        // Row by row infinite in Hypersim's files; its maintainer speaks of NaN.
        let absent = |b: &OrientedBox| b.extents == DVec3::INFINITY || (b.extents.is_nan() && b.center.is_nan());
        Ok((0..extents.len() / 3).map(row).map(|b| (!absent(&b)).then_some(b)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_come_back_and_absent_instances_are_infinite() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let world_from_box = DMat3::from_rotation_z(0.3);
        let made = OrientedBox { center: DVec3::new(1.0, 2.0, 3.0), world_from_box, extents: DVec3::new(4.0, 1.0, 0.0) };
        for kind in BoxKind::ALL {
            dataset.write_boxes("room", kind, &[None, Some(made), None]).unwrap();
        }
        let message = dataset.read_boxes("room", BoxKind::AxisAligned).unwrap_err().to_string();
        assert!(message.contains("metadata_scene.csv"), "nothing says whose scene it is, nor its unit: {message}");
        dataset.write_nodes("room", &[]).unwrap();
        for kind in BoxKind::ALL {
            assert_eq!(dataset.read_boxes("room", kind).unwrap(), [None, Some(made), None]);
        }
        let [_, orientations, _] = dataset.box_files("room", BoxKind::ObjectAligned2d);
        assert!(orientations.ends_with("_detail/mesh/metadata_semantic_instance_bounding_box_object_aligned_2d_orientations.hdf5"));
        let Elements::F64(values) = read_array(&orientations).unwrap().values else { panic!("not float64") };
        assert!(values[..9].iter().all(|&v| v == f64::INFINITY));
        assert!((values[10] + 0.3f64.sin()).abs() < 1e-15, "rows one after the other: the second column begins at the second value");
    }
}
