//! Triangles of a scene with what they are labelled as.

use enfilade_dataset::{Dataset, DatasetError};
use enfilade_math::DVec3;
use enfilade_scene::PartLabel;

/// NYU40's class of doors.
pub const DOOR: i16 = 8;
/// NYU40's class of windows.
pub const WINDOW: i16 = 9;

/// A triangle of the scene, world, metres.
#[derive(Clone, Copy, Debug)]
pub struct LabelledTriangle {
    /// Corners of the triangle.
    pub corners: [DVec3; 3],
    /// What it is.
    pub label: PartLabel,
}

impl LabelledTriangle {
    /// Unit normal, which may point to either side, and area; zero for triangles without area.
    pub fn normal_and_area(&self) -> (DVec3, f64) {
        let [a, b, c] = self.corners;
        let cross = (b - a).cross(c - a);
        (cross.normalize_or_zero(), 0.5 * cross.length())
    }

    /// The mean of its corners.
    pub fn center(&self) -> DVec3 {
        self.corners.iter().sum::<DVec3>() / 3.0
    }
}

/// The triangles of a scene's mesh folder, with the labels of their parts.
///
/// # Errors
/// When a file of the mesh folder is missing or damaged.
pub fn labelled_triangles(dataset: &Dataset, scene: &str) -> Result<Vec<LabelledTriangle>, DatasetError> {
    let files = dataset.mesh_files(scene);
    let (mesh, objects, labels) = (files.read()?, files.read_objects_of_faces()?, files.read_labels()?);
    let metres = dataset.meters_per_asset_unit(scene)?;
    let triangle = |(face, object): (&[u32; 3], u32)| LabelledTriangle {
        corners: face.map(|vertex| mesh.vertices[vertex as usize] * metres),
        label: labels.parts.get(object as usize).copied().unwrap_or(PartLabel::NONE),
    };
    Ok(mesh.faces.iter().zip(objects).map(triangle).collect())
}
