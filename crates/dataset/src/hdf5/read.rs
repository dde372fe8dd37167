use super::bytes::{most_chunks, most_inflated};
use super::volume::has_damaged_tree;
use super::window::read_image;
use super::write::{datatype, os_error};
use super::{Array, Element, Elements};
use crate::DatasetError;
use rust_hdf5::{DatatypeMessage, H5File, Hdf5Error};
use std::fs::File;
use std::io::Read;
use std::panic::catch_unwind;
use std::path::Path;

/// Reads the array of a file, ours or Hypersim's.
///
/// # Errors
/// When the file is missing or damaged, or holds anything but one dataset named `dataset` of a known element type.
pub fn read_array(path: &Path) -> Result<Array, DatasetError> {
    if let Some(image) = read_image(path) {
        return Ok(image);
    }
    let length = check_length(path)?;
    // The library would walk some such trees for ever, and take the chunks that it does not find for ones that were never written.
    if has_damaged_tree(path, "dataset") {
        return Err(DatasetError::hdf5(path, format!("the tree that says where its chunks lie is broken: {DAMAGED}")));
    }
    // The library takes some of what stands in a file for granted, and panics where it is not so.
    let gave_up = |_| Err(DatasetError::hdf5(path, format!("the HDF5 library gave up on it: {DAMAGED}")));
    catch_unwind(|| read_dataset(path, length)).unwrap_or_else(gave_up)
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
    let fits = |&n: &usize| n as u64 <= most_inflated(length);
    let impossible = || DatasetError::hdf5(path, format!("{length} bytes cannot hold shape {shape:?} of {}: {DAMAGED}", element.name()));
    let expected = bytes_of(&shape).filter(fits).ok_or_else(impossible)?;
    let chunks = |chunk: &[usize]| {
        let mut sides = shape.iter().zip(chunk).map(|(axis, &side)| axis.div_ceil(side.max(1)) as u64);
        sides.try_fold(1_u64, u64::checked_mul).filter(|&chunks| chunks <= most_chunks(length))
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
