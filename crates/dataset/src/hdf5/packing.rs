//! Storage of arrays in files: as one run of bytes, or cut into chunks that are compressed.
//!
//! The choices for layers of images are by the kind of their values; docs/benchmarks/storage.md has the measurements behind them.

use super::array::Element;
use enfilade_frame::{Dtype, Layer};

/// The storage of an array in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// One run of bytes: Hypersim's camera arrays.
    Contiguous,
    /// Chunks of h5py's shape, shuffled and deflated: meshes. Arrays of more than three axes or without elements are stored as one run.
    Compressed,
    /// Chunks as given: images, of two axes or three. Other arrays are stored as one run.
    Image(Packing),
    /// An image for fast reading: one run of bytes if it has one channel of floating-point numbers, or if LZ4 would save less than a
    /// quarter; else chunks of 128x128 pixels with all channels, shuffled if they are floating-point numbers, under LZ4, for which h5py
    /// needs the package hdf5plugin. Our readers take both like any other. Arrays of other than two or three axes are stored as one run.
    Fast,
}

/// Chunks and filters of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Packing {
    /// Rows and columns of a chunk; smaller images are one chunk.
    pub chunk: [usize; 2],
    /// True when a chunk holds all channels of its pixels, false for one chunk per channel.
    pub channels_together: bool,
    /// HDF5's shuffle filter: bytes of one significance side by side.
    pub shuffle: bool,
    /// Effort of libdeflate, 1 to 12. Whatever it is, the result is plain gzip to readers.
    pub level: i32,
}

impl Packing {
    /// The packing of a layer's file.
    pub fn of_layer(layer: Layer) -> Self {
        match layer.spec().dtype {
            Dtype::I16 => Self::of_numbers(Element::I16),
            Dtype::U8 => Self::of_numbers(Element::U8),
            Dtype::F32 => Self::of_numbers(Element::F32),
            Dtype::F16 if layer == Layer::TexCoord => Self { channels_together: false, ..Self::of_numbers(Element::F16) },
            Dtype::F16 => Self::of_numbers(Element::F16),
        }
    }

    /// The packing of an image of such numbers.
    pub fn of_numbers(element: Element) -> Self {
        let plain = Self { chunk: [128, 128], channels_together: true, shuffle: true, level: 6 };
        match element {
            // Runs of equal numbers: shuffling costs readers time and saves nothing.
            Element::I16 | Element::I64 | Element::U8 => Self { shuffle: false, level: 9, ..plain },
            // Channels that vary smoothly and apart from each other.
            Element::F32 | Element::F64 => Self { channels_together: false, ..plain },
            Element::F16 => plain,
        }
    }

    /// Packing of [`Storage::Fast`], which has no level.
    pub(super) fn fast(element: Element) -> Self {
        let shuffle = matches!(element, Element::F16 | Element::F32 | Element::F64);
        Self { chunk: [128, 128], channels_together: true, shuffle, level: 0 }
    }

    /// True for images that [`Storage::Fast`] has as one run of bytes whatever LZ4 would save: of one channel of
    /// floating-point numbers, as depth is. It shrinks to a quarter, but takes four times as long to put together as to copy.
    pub(super) fn is_copied(element: Element, shape: &[usize]) -> bool {
        Self::fast(element).shuffle && shape.get(2).is_none_or(|&channels| channels == 1)
    }

    /// True when LZ4 saves enough of `raw` bytes to be undone at every reading: a quarter.
    pub(super) fn pays(raw: usize, packed: usize) -> bool {
        4 * packed <= 3 * raw
    }

    /// The chunk's shape for an image of two axes or three, none of them zero.
    pub(super) fn chunk_shape(self, shape: &[usize]) -> Vec<usize> {
        let sides = shape.iter().zip(self.chunk).map(|(&axis, side)| axis.min(side));
        let channels = shape.get(2).map(|&channels| if self.channels_together { channels } else { 1 });
        sides.chain(channels).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crop_touches_few_chunks_and_no_chunk_is_larger_than_the_image() {
        let color = Packing::of_layer(Layer::Color);
        assert_eq!(color.chunk_shape(&[768, 1024, 3]), [128, 128, 3]);
        assert_eq!(color.chunk_shape(&[7, 500, 3]), [7, 128, 3]);
        assert_eq!(Packing::of_layer(Layer::Position).chunk_shape(&[768, 1024, 3]), [128, 128, 1]);
        assert_eq!(Packing::of_layer(Layer::DepthMeters).chunk_shape(&[768, 1024]), [128, 128]);
    }
}
