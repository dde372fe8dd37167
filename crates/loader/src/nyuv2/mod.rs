//! NYU-Depth V2 (Silberman et al., ECCV 2012) from the file as it is published, `nyu_depth_v2_labeled.mat`.
//!
//! The file is MATLAB 7.3, hence HDF5 with transposed arrays: `images` uint8 \[N, 3, 640, 480\], `depths` float32 and `labels` uint16
//! \[N, 640, 480\], `scenes` a list of texts.

mod tables;

pub use tables::{NyuClasses, NyuSide, PUBLISHED_IMAGES, nyu13_of_nyu40, side_of};

use crate::error::LoaderError;
use crate::sample::{Image, Sample, mask_out};
use enfilade_dataset::{Number, Volume, VolumeArray, Window};
use enfilade_frame::{Layer, Values};
use std::path::{Path, PathBuf};

/// The layers that there are.
pub const NYU_LAYERS: [Layer; 3] = [Layer::Color, Layer::DepthZMeters, Layer::Semantic];

/// The chosen images of NYUv2, and their layers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NyuChoice {
    /// A side of the published split; `None` is all images.
    pub side: Option<NyuSide>,
    /// Classes of the layer `semantic`.
    pub classes: NyuClasses,
    /// Layers of a sample, each in [`NYU_LAYERS`].
    pub layers: Vec<Layer>,
    /// Whether a file with other than the 1449 published images is taken.
    pub partial: bool,
}

/// Images of NYUv2 as samples; may be read from many threads.
#[derive(Debug)]
pub struct NyuV2 {
    path: PathBuf,
    arrays: Vec<(Layer, VolumeArray)>,
    scenes: Vec<String>,
    classes: NyuClasses,
    /// Images of the file, counted from 0.
    images: Vec<usize>,
    height: usize,
    width: usize,
}

impl NyuV2 {
    /// The images of the file that `choice` is about.
    ///
    /// # Errors
    /// When the file is missing, damaged, or is not NYUv2's, or no image is left.
    pub fn open(path: &Path, choice: &NyuChoice) -> Result<Self, LoaderError> {
        let refuse = |problem: String| LoaderError::Request(format!("{}: {problem}", path.display()));
        if choice.layers.is_empty() {
            return Err(refuse("no layers were asked for; name at least one".into()));
        }
        let volume = Volume::open(path)?;
        let mut arrays = Vec::new();
        for &layer in &choice.layers {
            let (name, number, axes) = stored(layer)
                .ok_or_else(|| refuse(format!("NYUv2 has no layer {}; it has color, depth_z_meters and semantic", layer.spec().name)))?;
            let array = volume.array(name)?;
            if array.number != number || array.shape.len() != axes || (axes == 4 && array.shape[1] != 3) {
                let expected = if axes == 4 { "[images, 3, width, height]" } else { "[images, width, height]" };
                let found = format!("array {name:?} is {:?} of shape {:?}", array.number, array.shape);
                return Err(refuse(format!("{found}, expected {number:?} of shape {expected}; is it nyu_depth_v2_labeled.mat?")));
            }
            arrays.push((layer, array));
        }
        let extent = |array: &VolumeArray| [array.shape[0], array.shape[array.shape.len() - 2], array.shape[array.shape.len() - 1]];
        let [count, width, height] = extent(&arrays[0].1);
        if let Some((layer, other)) = arrays.iter().find(|(_, array)| extent(array) != [count, width, height]) {
            let (layer, found) = (layer.spec().name, extent(other));
            return Err(refuse(format!("{layer} has {found:?} images, columns and rows, other layers have {:?}", [count, width, height])));
        }
        if width == 0 || height == 0 {
            return Err(refuse(format!("its images are of {width} columns and {height} rows; download it again")));
        }
        if count != PUBLISHED_IMAGES && !choice.partial {
            return Err(refuse(format!(
                "has {count} images, expected the {PUBLISHED_IMAGES} that are published; ask for `partial` if it is meant to be a part"
            )));
        }
        let chosen = |image: &usize| choice.side.is_none_or(|side| side_of(*image) == Some(side));
        let images: Vec<usize> = (0..count).filter(chosen).collect();
        if images.is_empty() {
            return Err(refuse(format!("none of its {count} images is of the side that was asked for")));
        }
        let scenes = if volume.names().any(|name| name == "scenes") { volume.texts("scenes")? } else { Vec::new() };
        Ok(Self { path: path.to_path_buf(), arrays, scenes, classes: choice.classes, images, height, width })
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.images.len()
    }

    /// Always false: [`NyuV2::open`] refuses a choice without images.
    pub fn is_empty(&self) -> bool {
        self.images.is_empty()
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The layers of each sample.
    pub fn layers(&self) -> impl Iterator<Item = Layer> {
        self.arrays.iter().map(|(layer, _)| *layer)
    }

    /// The classes of `semantic`.
    pub fn classes(&self) -> NyuClasses {
        self.classes
    }

    /// Number of a sample's image in the file, counted from 1 as MATLAB and the published split do.
    ///
    /// # Panics
    /// When there are fewer samples.
    pub fn frame(&self, index: usize) -> u32 {
        self.images[index] as u32 + 1
    }

    /// Decodes a sample.
    ///
    /// # Errors
    /// When the file is damaged.
    ///
    /// # Panics
    /// When there are fewer samples.
    pub fn sample(&self, index: usize) -> Result<Sample, LoaderError> {
        let (image, height, width) = (self.images[index], self.height, self.width);
        let mut layers = Vec::with_capacity(self.arrays.len());
        let mut mask = vec![1; height * width];
        for (layer, array) in &self.arrays {
            let (mut first, mut count) = (vec![0; array.shape.len()], array.shape.clone());
            (first[0], count[0]) = (image, 1);
            let bytes = array.read(&first, &count)?;
            let values = match array.number {
                Number::U8 => Values::U8(upright::<3, 1, u8>(&bytes, height, width, |byte| byte[0])),
                Number::U16 => Values::I16(upright::<1, 2, i16>(&bytes, height, width, |b| self.classes.of_label(u16::from_le_bytes(b)))),
                _ => Values::F32(upright::<1, 4, f32>(&bytes, height, width, f32::from_le_bytes)),
            };
            let found = Image { height, width, channels: layer.spec().channels, values };
            mask_out(&mut mask, *layer, &found);
            layers.push((*layer, found));
        }
        Ok(Sample {
            scene: self.scenes.get(image).cloned().unwrap_or_default(),
            camera: String::new(),
            frame: self.frame(index),
            window: Window { top: 0, left: 0, height, width },
            layers,
            mask: Some(Image { height, width, channels: 1, values: Values::U8(mask) }),
            k: None,
            world_from_camera: None,
        })
    }
}

/// Name, type and number of axes of the array that has a layer.
fn stored(layer: Layer) -> Option<(&'static str, Number, usize)> {
    match layer {
        Layer::Color => Some(("images", Number::U8, 4)),
        Layer::DepthZMeters => Some(("depths", Number::F32, 3)),
        Layer::Semantic => Some(("labels", Number::U16, 3)),
        _ => None,
    }
}

/// An image of `C` channels by channel, column and row as one by row, column and channel; its elements are of `B` bytes.
fn upright<const C: usize, const B: usize, T: Copy + Default>(
    bytes: &[u8],
    height: usize,
    width: usize,
    value: impl Fn([u8; B]) -> T,
) -> Vec<T> {
    let (elements, _) = bytes.as_chunks::<B>();
    let mut out = vec![T::default(); C * height * width];
    for (i, column) in elements.chunks_exact(height).enumerate() {
        let (channel, x) = (i / width, i % width);
        for (y, &element) in column.iter().enumerate() {
            out[(y * width + x) * C + channel] = value(element);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transposed_images_are_turned_upright() {
        // Two channels would be no image, but show the order: value = 100 channel + 10 column + row.
        let (height, width) = (3, 2);
        let bytes: Vec<u8> =
            (0..2).flat_map(|c| (0..width).flat_map(move |x| (0..height).map(move |y| (100 * c + 10 * x + y) as u8))).collect();
        let out = upright::<2, 1, u8>(&bytes, height, width, |byte| byte[0]);
        assert_eq!(out, [0, 100, 10, 110, 1, 101, 11, 111, 2, 102, 12, 112]);
    }

    #[test]
    fn a_file_that_is_something_else_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("nyu.mat");
        let choice = NyuChoice { side: None, classes: NyuClasses::Forty, layers: NYU_LAYERS.to_vec(), partial: false };
        let said = |path: &Path, choice: &NyuChoice| NyuV2::open(path, choice).unwrap_err().to_string();
        assert!(said(&path, &choice).contains("nyu.mat"));
        std::fs::write(&path, "MATLAB 5.0 MAT-file".repeat(100)).unwrap();
        assert!(said(&path, &choice).contains("holds no HDF5"));
        assert!(said(&path, &NyuChoice { layers: vec![], ..choice }).contains("no layers"));
    }
}
