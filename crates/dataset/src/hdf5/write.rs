//! Writing an array: attributes, chunks and filters, through the HDF5 library, with the chunks compressed here.

use super::array::{Array, ArrayView, Element};
use super::chunks::{MESH_LEVEL, auto_chunk, gather, grid, shuffle, three_axes};
use super::image_map::{DEFLATE, LZ4, SHUFFLE};
use super::lz4;
use super::packing::{Packing, Storage};
use crate::DatasetError;
use libdeflater::{CompressionLvl, Compressor};
use rust_hdf5::types::{H5Type, VarLenUnicode};
use rust_hdf5::{ByteOrder, DatatypeMessage, Filter, FilterPipeline, H5Dataset, H5File, Hdf5Error, LibverBound};
use std::path::Path;

/// Writes `array` to a new file at `path`; see [`crate::replace_file`] for doing so in one step. The same array gives the same
/// bytes. `attributes` become text attributes of the dataset.
///
/// # Errors
/// When the file cannot be written.
pub fn write_array(path: &Path, array: &Array, storage: Storage, attributes: &[(&str, &str)]) -> Result<(), DatasetError> {
    write_view(path, array.view(), storage, attributes)
}

/// Writes borrowed elements as [`write_array`] does.
pub(crate) fn write_view(path: &Path, array: ArrayView, storage: Storage, attributes: &[(&str, &str)]) -> Result<(), DatasetError> {
    let options = H5File::options().no_locking().libver(LibverBound::Earliest);
    let file = options.create(path).map_err(|error| write_error(path, error))?;
    let written = fill(&file, array, storage, attributes);
    // Closed in any case: a file that is dropped open would print its own complaint.
    let closed = file.close_no_sync();
    written.and(closed).map_err(|error| write_error(path, error))
}

fn fill(file: &H5File, array: ArrayView, storage: Storage, attributes: &[(&str, &str)]) -> rust_hdf5::Result<()> {
    let axes = array.shape.len();
    let dataset = match storage {
        _ if array.bytes.is_empty() => write_contiguous(file, array)?,
        Storage::Compressed if (1..=3).contains(&axes) => {
            write_chunks(file, array, &auto_chunk(array.shape, array.element.size()), true, MESH_LEVEL)?
        }
        Storage::Image(packing) if (2..=3).contains(&axes) => {
            write_chunks(file, array, &packing.chunk_shape(array.shape), packing.shuffle, packing.level)?
        }
        Storage::Fast if (2..=3).contains(&axes) => write_fast(file, array)?,
        _ => write_contiguous(file, array)?,
    };
    for (name, value) in attributes {
        let attribute = dataset.new_attr::<VarLenUnicode>().shape(()).create(name)?;
        attribute.write_scalar(&VarLenUnicode((*value).to_string()))?;
    }
    Ok(())
}

fn write_contiguous(file: &H5File, array: ArrayView) -> rust_hdf5::Result<H5Dataset> {
    let dataset = file.new_dataset::<u8>().datatype(datatype(array.element)).shape(array.shape).create("dataset")?;
    if !array.bytes.is_empty() {
        dataset.write_raw_bytes(array.bytes)?;
    }
    Ok(dataset)
}

/// Deflating the chunks here instead of in the HDF5 library is what makes writing fast: libdeflate takes half of zlib's time.
fn write_chunks(file: &H5File, array: ArrayView, chunk: &[usize], shuffled: bool, level: i32) -> rust_hdf5::Result<H5Dataset> {
    let dataset = chunked(file, array, chunk, shuffled, Some(level))?;
    let mut compressor = Compressor::new(CompressionLvl::new(level).unwrap_or_default());
    let mut deflated = Vec::new();
    for (at, filtered) in chunks(array, chunk, shuffled) {
        deflated.resize(compressor.zlib_compress_bound(filtered.len()), 0);
        let length = compressor
            .zlib_compress(&filtered, &mut deflated)
            .map_err(|error| Hdf5Error::InvalidState(format!("deflate failed: {error}")))?;
        dataset.write_chunk_raw_at(&at[3 - chunk.len()..], &deflated[..length], 0)?;
    }
    Ok(dataset)
}

/// Under LZ4, or as one run where that does not pay.
fn write_fast(file: &H5File, array: ArrayView) -> rust_hdf5::Result<H5Dataset> {
    let packing = Packing::fast(array.element);
    let chunk = packing.chunk_shape(array.shape);
    if Packing::is_copied(array.element, array.shape) {
        return write_contiguous(file, array);
    }
    let frames: Vec<_> = chunks(array, &chunk, packing.shuffle).map(|(at, filtered)| (at, lz4::compress(&filtered))).collect();
    if !Packing::pays(array.bytes.len(), frames.iter().map(|(_, frame)| frame.len()).sum()) {
        return write_contiguous(file, array);
    }
    let dataset = chunked(file, array, &chunk, packing.shuffle, None)?;
    for (at, frame) in &frames {
        dataset.write_chunk_raw_at(&at[3 - chunk.len()..], frame, 0)?;
    }
    Ok(dataset)
}

/// A dataset of chunks yet to be written.
fn chunked(file: &H5File, array: ArrayView, chunk: &[usize], shuffled: bool, level: Option<i32>) -> rust_hdf5::Result<H5Dataset> {
    let builder = file.new_dataset::<u8>().datatype(datatype(array.element)).shape(array.shape).chunk(chunk);
    builder.filter_pipeline(filters(shuffled.then_some(array.element.size()), level)).create("dataset")
}

/// The chunks with their places along three axes, shuffled if that is asked for, last axis fastest.
fn chunks<'a>(array: ArrayView<'a>, chunk: &[usize], shuffled: bool) -> impl Iterator<Item = ([usize; 3], Vec<u8>)> + use<'a> {
    let (size, shape3, chunk3) = (array.element.size(), three_axes(array.shape), three_axes(chunk));
    let [a, b, c] = grid(shape3, chunk3);
    (0..a * b * c).map(move |i| {
        let at = [i / (b * c), i / c % b, i % c];
        let raw = gather(array.bytes, size, shape3, chunk3, at);
        (at, if shuffled { shuffle(&raw, size) } else { raw })
    })
}

/// The filters of chunks: shuffle by the size of elements, if given, then deflate at a level, if given, else LZ4.
fn filters(shuffled: Option<usize>, level: Option<i32>) -> FilterPipeline {
    /// A filter that may be left out of chunks that it does nothing for.
    const OPTIONAL: u16 = 1;
    let filter = |id, values: Vec<u32>| Filter { id, flags: OPTIONAL, cd_values: values };
    let shuffle = shuffled.map(|size| filter(SHUFFLE, vec![size as u32]));
    // The level in the file is only informative; zlib's levels end at 9.
    let codec = level.map_or_else(|| filter(LZ4, Vec::new()), |level| filter(DEFLATE, vec![level.clamp(1, 9) as u32]));
    FilterPipeline { filters: shuffle.into_iter().chain([codec]).collect() }
}

/// IEEE 754 half precision, which the library has no Rust type for, and its own descriptions of the others.
pub(super) fn datatype(element: Element) -> DatatypeMessage {
    match element {
        Element::F16 => DatatypeMessage::FloatingPoint {
            size: 2,
            byte_order: ByteOrder::LittleEndian,
            sign_location: 15,
            bit_offset: 0,
            bit_precision: 16,
            exponent_location: 10,
            exponent_size: 5,
            mantissa_location: 0,
            mantissa_size: 10,
            exponent_bias: 15,
        },
        Element::F32 => f32::hdf5_type(),
        Element::F64 => f64::hdf5_type(),
        Element::I16 => i16::hdf5_type(),
        Element::I64 => i64::hdf5_type(),
        Element::U8 => u8::hdf5_type(),
    }
}

/// The operating system's error behind the library's, if there is one. The library hides it behind a private type and shows only
/// its text, which ends in the error's number.
pub(super) fn os_error(error: &Hdf5Error) -> Option<std::io::Error> {
    let text = error.to_string();
    let (_, number) = text.rsplit_once("(os error ")?;
    number.strip_suffix(')')?.parse().ok().map(std::io::Error::from_raw_os_error)
}

fn write_error(path: &Path, error: Hdf5Error) -> DatasetError {
    match os_error(&error) {
        Some(source) => DatasetError::io("write", path, source),
        None => DatasetError::hdf5(path, format!("the array cannot be written as HDF5 ({error})")),
    }
}
