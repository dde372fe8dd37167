//! The JSON that Mesh R-CNN reads: COCO's images, annotations and categories, with a model and a camera in each annotation.

use crate::ShapesError;
use crate::classes::CATEGORIES;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A data set in one file. Paths in it begin at its folder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Document {
    /// Description of the document.
    #[serde(default)]
    pub info: Info,
    /// In the order of their ids.
    pub images: Vec<Image>,
    /// Objects to learn and to find.
    pub annotations: Vec<Annotation>,
    /// Objects in the images that are not to be learnt. Mesh R-CNN does not read them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub excluded: Vec<Excluded>,
    /// Pix3D's nine.
    pub categories: Vec<Category>,
}

/// Source of a document.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Info {
    /// In words.
    #[serde(default)]
    pub description: String,
}

/// An image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Image {
    /// From 1.
    pub id: u64,
    /// Path of the image.
    pub file_name: String,
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// Scene, camera and frame of a rendered image.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scene: Option<String>,
    /// Camera of a rendered image.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera: Option<String>,
    /// Frame number of a rendered image.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<u32>,
}

/// An object in an image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Annotation {
    /// From 1.
    pub id: u64,
    /// Image that it is in.
    pub image_id: u64,
    /// 1 to 9.
    pub category_id: u32,
    /// Always 0: one object.
    pub iscrowd: u8,
    /// Pixels of the mask, or of the box where the mask was not counted.
    pub area: f64,
    /// Left border, upper border, width and height of what is seen, pixels.
    pub bbox: [f64; 4],
    /// Path of the mask: a grey PNG as large as the image, above 0 where the object is seen.
    pub segmentation: String,
    /// Path of the mesh, an OBJ file.
    pub model: String,
    /// Path of the voxels, a MATLAB file.
    pub voxel: String,
    /// Focal length, and the principal point, which is the middle of the image; pixels.
    #[serde(rename = "K")]
    pub k: [f64; 3],
    /// Rotation from the model to the camera, by rows.
    pub rot_mat: [[f64; 3]; 3],
    /// The model's origin in camera space, in the model's unit.
    pub trans_mat: [f64; 3],
    /// Further data of a rendered object.
    #[serde(flatten)]
    pub rendered: Option<Rendered>,
}

/// Data of a rendered object beyond Pix3D's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rendered {
    /// Number of the instance in its scene.
    pub instance: i16,
    /// Class of the object.
    pub nyu40: i16,
    /// Metres in one unit of the model.
    pub meters_per_unit: f64,
    /// True when a part of the mesh is not in front of the camera, or falls outside of the image.
    pub leaves_frustum: bool,
    /// Visible share of the whole object, 0 to 1, where the data set has counted it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub visibility: Option<f64>,
    /// Share of the whole object outside of the image, 0 to 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub truncation: Option<f64>,
}

/// An instance that is seen but takes no part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Excluded {
    /// Why.
    pub reason: Reason,
    /// Image that it is in.
    pub image_id: u64,
    /// Number of the instance in its scene.
    pub instance: i16,
    /// Class of the object.
    pub nyu40: i16,
    /// Left border, upper border, width and height of what is seen, pixels.
    pub bbox: [f64; 4],
    /// The annotation it would have had, if its class takes part and its mesh is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub annotation: Option<Box<Annotation>>,
}

/// Why an instance takes no part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// The object's class becomes none of Pix3D's categories.
    Class,
    /// A vertex is behind the camera or nearer than 1 cm.
    BehindCamera,
    /// A vertex falls outside of the image.
    OutsideImage,
    /// The object's mesh is not known, or has no extent.
    NoMesh,
}

/// A category.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Category {
    /// 1 to 9.
    pub id: u32,
    /// Pix3D's name.
    pub name: String,
}

impl Document {
    /// A document without images.
    pub fn empty(description: impl Into<String>) -> Self {
        let category = |(id, name): (u32, &str)| Category { id, name: name.into() };
        Self {
            info: Info { description: description.into() },
            images: Vec::new(),
            annotations: Vec::new(),
            excluded: Vec::new(),
            categories: (1..).zip(CATEGORIES).map(category).collect(),
        }
    }

    /// Reads a file.
    ///
    /// # Errors
    /// When it is missing, or is not such a document.
    pub fn read(path: &Path) -> Result<Self, ShapesError> {
        let bytes = std::fs::read(path).map_err(ShapesError::io("read", path))?;
        let expected = "expected Mesh R-CNN's annotations (images, annotations, categories)";
        serde_json::from_slice(&bytes).map_err(|error| ShapesError::file(path, format!("{error}; {expected}")))
    }

    /// The bytes of a file.
    pub fn to_json(&self) -> Vec<u8> {
        let mut bytes = serde_json::to_vec(self).expect("plain data encodes");
        bytes.push(b'\n');
        bytes
    }

    /// The document with only the images that `keeps` wants, under the same ids.
    #[must_use]
    pub fn only(&self, keeps: impl Fn(&Image) -> bool) -> Self {
        let images: Vec<Image> = self.images.iter().filter(|image| keeps(image)).cloned().collect();
        let kept: std::collections::BTreeSet<u64> = images.iter().map(|image| image.id).collect();
        Self {
            annotations: self.annotations.iter().filter(|a| kept.contains(&a.image_id)).cloned().collect(),
            excluded: self.excluded.iter().filter(|e| kept.contains(&e.image_id)).cloned().collect(),
            images,
            ..self.clone()
        }
    }
}
