//! numpy's archives: arrays as `.npy` files (version 1.0 of the format, NEP 1) in an uncompressed zip archive.

use crate::DatasetError;
use std::borrow::Cow;
use std::io::{Cursor, Read, Write};
use std::path::Path;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter, write::SimpleFileOptions};

/// Magic and version of an array file.
const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";

/// An array of an archive, in C order, little-endian.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NpyArray {
    /// Key of the array in the archive.
    pub name: &'static str,
    /// numpy's description of an element, as in `<f4`.
    pub dtype: Cow<'static, str>,
    /// Length of each axis.
    pub shape: Vec<usize>,
    /// The elements.
    pub bytes: Vec<u8>,
}

impl NpyArray {
    /// An array of these bytes; with none, the description of an array to look for in an archive.
    pub fn new(name: &'static str, dtype: impl Into<Cow<'static, str>>, shape: &[usize], bytes: Vec<u8>) -> Self {
        Self { name, dtype: dtype.into(), shape: shape.to_vec(), bytes }
    }

    /// The values of an array of `<f4`.
    pub(crate) fn floats(&self) -> Vec<f32> {
        self.bytes.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect()
    }
}

/// The header of an array file, up to its values, which follow in C order, little-endian. `dtype` is numpy's description of an element, as
/// in `<f4`.
pub fn npy_head(dtype: &str, shape: &[usize]) -> Vec<u8> {
    let axes = shape.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    // One axis needs the comma that makes it a tuple.
    let comma = if shape.len() == 1 { "," } else { "" };
    let mut header = format!("{{'descr': '{dtype}', 'fortran_order': False, 'shape': ({axes}{comma}), }}");
    // Magic, version and length are 10 bytes; what comes before the values is a multiple of 64 and ends with a new line.
    let padding = 63 - (10 + header.len()) % 64;
    header.push_str(&" ".repeat(padding));
    header.push('\n');
    [MAGIC, &(header.len() as u16).to_le_bytes(), header.as_bytes()].concat()
}

/// The bytes of an archive of arrays; the same arrays give the same bytes.
///
/// # Errors
/// When a name is used twice, or there is no memory.
pub fn npz(arrays: &[NpyArray]) -> std::io::Result<Vec<u8>> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored).last_modified_time(DateTime::default());
    for array in arrays {
        archive.start_file(format!("{}.npy", array.name), options)?;
        archive.write_all(&npy_head(&array.dtype, &array.shape))?;
        archive.write_all(&array.bytes)?;
    }
    Ok(archive.finish()?.into_inner())
}

/// Reads an array of `wanted`'s name, type and number of axes from an archive that [`npz`] has written; lengths of 0 in its shape may be any.
pub(crate) fn read_npy(path: &Path, archive: &[u8], mut wanted: NpyArray) -> Result<NpyArray, DatasetError> {
    let name = wanted.name;
    let wrong = |problem: String| DatasetError::text(path, format!("{name}: {problem}; make the file again"));
    let mut archive = ZipArchive::new(Cursor::new(archive)).map_err(|error| wrong(error.to_string()))?;
    let mut bytes = Vec::new();
    let mut file = archive.by_name(&format!("{name}.npy")).map_err(|error| wrong(error.to_string()))?;
    file.read_to_end(&mut bytes).map_err(|error| wrong(error.to_string()))?;
    let rest = bytes.strip_prefix(MAGIC).filter(|rest| rest.len() > 2).ok_or_else(|| wrong("not an array file of version 1".into()))?;
    let length = 2 + usize::from(u16::from_le_bytes([rest[0], rest[1]]));
    let header = rest.get(2..length).map(String::from_utf8_lossy).ok_or_else(|| wrong("it is cut short".into()))?;
    let found = header.split_once("'shape': (").and_then(|(_, shape)| shape.split_once(')')).map_or("", |(shape, _)| shape);
    let axes: Option<Vec<usize>> = found.split(',').map(str::trim).filter(|axis| !axis.is_empty()).map(|axis| axis.parse().ok()).collect();
    let fits = |axes: &Vec<usize>| axes.len() == wanted.shape.len() && axes.iter().zip(&wanted.shape).all(|(a, b)| *b == 0 || a == b);
    let expected = || wrong(format!("expected {} of shape {:?}, found {}", wanted.dtype, wanted.shape, header.trim()));
    let axes = axes.filter(fits).filter(|_| header.contains(&format!("'{}'", wanted.dtype))).ok_or_else(expected)?;
    let size = usize::from(wanted.dtype.as_bytes()[2] - b'0');
    if Some(rest.len() - length) != axes.iter().try_fold(size, |n, &axis| n.checked_mul(axis)) {
        return Err(wrong("it is cut short, or has more values than its shape says".into()));
    }
    (wanted.shape, wanted.bytes) = (axes, rest[length..].to_vec());
    Ok(wanted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_come_back_and_damage_is_told() {
        let array = |name, shape: &[usize], bytes: Vec<u8>| NpyArray { name, dtype: "|u1".into(), shape: shape.to_vec(), bytes };
        let arrays = [array("a", &[2, 3], vec![1, 2, 3, 4, 5, 6]), array("b", &[4], vec![0, 1, 0, 1])];
        let bytes = npz(&arrays).unwrap();
        assert_eq!(bytes, npz(&arrays).unwrap());
        let path = Path::new("tracks.npz");
        assert_eq!(read_npy(path, &bytes, array("a", &[0, 3], Vec::new())).unwrap(), arrays[0]);
        assert_eq!(read_npy(path, &bytes, array("b", &[4], Vec::new())).unwrap(), arrays[1]);
        let problem = |wanted| read_npy(path, &bytes, wanted).unwrap_err().to_string();
        assert!(problem(array("a", &[0, 2], Vec::new())).contains("expected |u1 of shape [0, 2], found"));
        assert!(problem(NpyArray { dtype: "<f4".into(), ..array("b", &[0], Vec::new()) }).contains("expected <f4"));
        assert!(problem(array("c", &[0], Vec::new())).starts_with("tracks.npz: c: "));
        assert!(read_npy(path, &bytes[..40], arrays[0].clone()).is_err());
        assert!(arrays.iter().all(|array| npy_head(&array.dtype, &array.shape).len().is_multiple_of(64)));
    }
}
