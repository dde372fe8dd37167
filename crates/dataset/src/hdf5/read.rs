//! Reading an array, or a rectangle of an image: by our own decoder where it knows the file's form, else through the HDF5 library.

use super::array::{Array, Element, Elements};
use super::bytes::{max_chunks, max_inflated};
use super::image_decoder::{decode, open, read_image};
use super::volume::has_damaged_tree;
use super::window::Window;
use super::write::{datatype, os_error};
use crate::DatasetError;
use enfilade_scene::{GIT_LFS_POINTER, is_git_lfs_pointer};
use rust_hdf5::{DatatypeMessage, H5File, Hdf5Error};
use std::fs::File;
use std::io::Read;
use std::panic::catch_unwind;
use std::path::Path;

/// Reads the array of a file, ours or Hypersim's.
///
/// # Errors
/// When the file is missing or damaged, or contains anything but one dataset named `dataset` of a known element type.
pub fn read_array(path: &Path) -> Result<Array, DatasetError> {
    if let Some(image) = read_image(path) {
        return Ok(image);
    }
    let length = check_length(path)?;
    // The library would walk some such trees for ever, and take the chunks that it does not find for ones that were never written.
    if has_damaged_tree(path, "dataset") {
        return Err(DatasetError::hdf5(path, format!("the index of its chunks is broken: {DAMAGED}")));
    }
    // The library relies on some of a file's contents without checking, and panics if they are wrong.
    let gave_up = |_| Err(DatasetError::hdf5(path, format!("the HDF5 library gave up on it: {DAMAGED}")));
    catch_unwind(|| read_dataset(path, length)).unwrap_or_else(gave_up)
}

/// Reads a rectangle of an image of two axes or three: of an image in chunks only those that it touches.
///
/// # Errors
/// When the file is missing or damaged, contains no image, or the window exceeds it.
///
/// ```
/// use enfilade_dataset::hdf5::{Array, Elements, Packing, Storage, Window, read_window, write_array};
/// use enfilade_frame::Layer;
/// # let folder = tempfile::tempdir()?;
/// let path = folder.path().join("frame.0000.semantic.hdf5");
/// let classes = Array::new(&[2, 3], Elements::I16(vec![1, 2, 3, 4, 5, 6]));
/// write_array(&path, &classes, Storage::Image(Packing::of_layer(Layer::Semantic)), &[])?;
/// let right = read_window(&path, Window { top: 0, left: 1, height: 2, width: 2 })?;
/// assert_eq!(right, Array::new(&[2, 2], Elements::I16(vec![2, 3, 5, 6])));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_window(path: &Path, window: Window) -> Result<Array, DatasetError> {
    if let Some((mut source, map)) = open(path) {
        check(path, &map.shape, window)?;
        if let Some(array) = decode(&mut source, &map, window) {
            return Ok(array);
        }
    }
    let whole = read_array(path)?;
    check(path, &whole.shape, window)?;
    Ok(whole.cut(window))
}

/// The shape of the image in a file, without decoding it where it is compressed.
///
/// # Errors
/// As [`read_array`].
pub fn image_shape(path: &Path) -> Result<Vec<usize>, DatasetError> {
    match open(path) {
        Some((_, map)) => Ok(map.shape),
        None => Ok(read_array(path)?.shape),
    }
}

fn read_dataset(path: &Path, length: u64) -> Result<Array, DatasetError> {
    let file = H5File::options().no_locking().open(path).map_err(|error| read_error(path, &error))?;
    let names = file.dataset_names();
    if names != ["dataset"] {
        let problem = format!("expected exactly one dataset named \"dataset\", found {names:?}; this is no file of a Hypersim dataset");
        return Err(DatasetError::hdf5(path, problem));
    }
    let dataset = file.dataset("dataset").map_err(|error| read_error(path, &error))?;
    let stored = dataset.datatype().map_err(|error| read_error(path, &error))?;
    let element = element_of(&stored).ok_or_else(|| {
        let problem = format!("its elements are {stored:?}; expected float16, float32, float64, int16, int64 or uint8, little-endian");
        DatasetError::hdf5(path, problem)
    })?;
    let shape = dataset.shape();
    let bytes_of = |shape: &[usize]| shape.iter().try_fold(element.size(), |n, &axis| n.checked_mul(axis));
    let fits = |&n: &usize| n as u64 <= max_inflated(length);
    let impossible = || DatasetError::hdf5(path, format!("{length} bytes cannot hold shape {shape:?} of {}: {DAMAGED}", element.name()));
    let expected = bytes_of(&shape).filter(fits).ok_or_else(impossible)?;
    let chunks = |chunk: &[usize]| {
        let mut sides = shape.iter().zip(chunk).map(|(axis, &side)| axis.div_ceil(side.max(1)) as u64);
        sides.try_fold(1_u64, u64::checked_mul).filter(|&chunks| chunks <= max_chunks(length))
    };
    if let Some(chunk) = dataset.chunk_dims().filter(|chunk| bytes_of(chunk).filter(fits).is_none() || chunks(chunk).is_none()) {
        return Err(DatasetError::hdf5(path, format!("{length} bytes cannot hold chunks of {chunk:?}: {DAMAGED}")));
    }
    let bytes = if expected == 0 { Vec::new() } else { dataset.read_raw_bytes().map_err(|error| read_error(path, &error))? };
    if expected != bytes.len() {
        return Err(impossible());
    }
    Ok(Array { values: Elements::from_bytes(element, &bytes), shape })
}

fn check(path: &Path, shape: &[usize], window: Window) -> Result<(), DatasetError> {
    let Window { top, left, height, width } = window;
    match shape {
        &[h, w] | &[h, w, _] if window.fits(h, w) => Ok(()),
        _ => {
            let problem = format!("expected an image with {height}x{width} pixels from row {top}, column {left}, found shape {shape:?}");
            Err(DatasetError::hdf5(path, problem))
        }
    }
}

const DAMAGED: &str = "the file is damaged or cut short; copy it again, or delete it and run the stage that makes it";

/// Compares the file's length with the one in its superblock, as libhdf5 does; the library behind us does not look at it. Gives
/// the length.
fn check_length(path: &Path) -> Result<u64, DatasetError> {
    const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";
    let at_path = || DatasetError::at("read", path);
    let mut file = File::open(path).map_err(at_path())?;
    let length = file.metadata().map_err(at_path())?.len();
    let mut head = Vec::new();
    file.by_ref().take(64).read_to_end(&mut head).map_err(at_path())?;
    if is_git_lfs_pointer(&head) {
        return Err(DatasetError::hdf5(path, format!("it is {GIT_LFS_POINTER}")));
    }
    if !head.starts_with(&SIGNATURE[..head.len().min(SIGNATURE.len())]) {
        return Err(DatasetError::hdf5(path, format!("it does not begin like an HDF5 file: {DAMAGED}")));
    }
    let end_of_file_at = match head.get(8) {
        Some(0) => 40,
        Some(1) => 44,
        _ => 28,
    };
    let expected = head.get(end_of_file_at..end_of_file_at + 8).map(|bytes| bytes.iter().rev().fold(0, |n, &b| n << 8 | u64::from(b)));
    match expected {
        Some(expected) if expected <= length => Ok(length),
        Some(expected) => Err(DatasetError::hdf5(path, format!("{length} bytes long instead of {expected}: {DAMAGED}"))),
        None => Err(DatasetError::hdf5(path, format!("only {length} bytes long: {DAMAGED}"))),
    }
}

/// The element type that `stored` describes, padding and byte order included.
fn element_of(stored: &DatatypeMessage) -> Option<Element> {
    let all = [Element::F16, Element::F32, Element::F64, Element::I16, Element::I64, Element::U8];
    all.into_iter().find(|&element| datatype(element) == *stored)
}

fn read_error(path: &Path, error: &Hdf5Error) -> DatasetError {
    match os_error(error) {
        Some(source) => DatasetError::io("read", path, source),
        None => DatasetError::hdf5(path, format!("{error}: {DAMAGED}")),
    }
}
