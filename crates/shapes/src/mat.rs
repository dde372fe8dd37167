//! MATLAB's files of version 5, limited to one array of numbers. "MAT-File Format", The MathWorks, R2024a.

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use std::io::{Read, Write};

/// Bytes of the header.
const HEADER: usize = 128;

/// Largest size of one inflated element: a grid of 512³ doubles and a little more.
const MAX_INFLATED: u64 = 1 << 30;

const INT8: u32 = 1;
const INT32: u32 = 5;
const UINT8: u32 = 2;
const UINT32: u32 = 6;
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;

/// Class of arrays of bytes.
const CLASS_UINT8: u8 = 9;

/// An array of numbers, first index fastest.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Array {
    pub shape: Vec<usize>,
    pub values: Vec<f64>,
}

/// The bytes of a file with one array of bytes, first index fastest.
pub(crate) fn write(name: &str, shape: [usize; 3], values: &[u8]) -> Vec<u8> {
    let mut body = Vec::with_capacity(values.len() + 128);
    put(&mut body, UINT32, &[u32::from(CLASS_UINT8), 0].map(u32::to_le_bytes).concat());
    put(&mut body, INT32, &shape.map(|n| (n as i32).to_le_bytes()).concat());
    put(&mut body, INT8, name.as_bytes());
    put(&mut body, UINT8, values);
    let mut matrix = Vec::with_capacity(body.len() + 8);
    put(&mut matrix, MATRIX, &body);
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(&matrix).expect("writing to memory cannot fail");
    let packed = encoder.finish().expect("writing to memory cannot fail");
    // The text, 8 bytes of no subsystem, version 1.0, and the mark of little-endian files.
    let mut bytes = format!("{:<116}", "MATLAB 5.0 MAT-file, written by enfilade").into_bytes();
    bytes.extend([0; 8]);
    bytes.extend(0x0100u16.to_le_bytes());
    bytes.extend(b"IM");
    bytes.extend([COMPRESSED, packed.len() as u32].map(u32::to_le_bytes).concat());
    bytes.extend(packed); // compressed elements are not padded
    bytes
}

fn put(bytes: &mut Vec<u8>, kind: u32, data: &[u8]) {
    bytes.extend([kind, data.len() as u32].map(u32::to_le_bytes).concat());
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
}

/// The array of that name. `Err` is the problem with the file.
pub(crate) fn read(bytes: &[u8], name: &str) -> Result<Array, String> {
    if bytes.starts_with(b"\x89HDF") || bytes.get(..20).is_some_and(|head| head.starts_with(b"MATLAB 7.3")) {
        return Err("it is a MATLAB file of version 7.3; save it with '-v7'".into());
    }
    let big_endian = match bytes.get(HEADER - 2..HEADER) {
        Some(b"IM") => false,
        Some(b"MI") => true,
        _ => return Err("expected a MATLAB file of version 5: 128 bytes that end in IM or MI".into()),
    };
    let mut rest = Elements { bytes: &bytes[HEADER..], big_endian };
    let mut seen = Vec::new();
    while !rest.bytes.is_empty() {
        let (kind, data) = rest.next()?;
        let inflated;
        let (kind, data) = if kind == COMPRESSED {
            inflated = inflate(data)?;
            Elements { bytes: &inflated, big_endian }.next()?
        } else {
            (kind, data)
        };
        if kind != MATRIX {
            continue;
        }
        let mut parts = Elements { bytes: data, big_endian };
        let (_, flags) = parts.next()?;
        let (dimensions_kind, dimensions) = parts.next()?;
        let shape: Vec<usize> = numbers(dimensions_kind, dimensions, big_endian)?.into_iter().map(|n| n.max(0.0) as usize).collect();
        let (_, found) = parts.next()?;
        if found != name.as_bytes() {
            seen.push(String::from_utf8_lossy(found).into_owned());
            continue;
        }
        return array(flags, shape, &mut parts, big_endian);
    }
    Err(format!("it has no array {name:?}, but {}", if seen.is_empty() { "nothing".into() } else { seen.join(", ") }))
}

fn array(flags: &[u8], shape: Vec<usize>, parts: &mut Elements<'_>, big_endian: bool) -> Result<Array, String> {
    let word: [u8; 4] = flags.get(..4).and_then(|word| word.try_into().ok()).ok_or("an array has no flags")?;
    let word = if big_endian { u32::from_be_bytes(word) } else { u32::from_le_bytes(word) };
    // Classes 6 to 15 are arrays of numbers; bit 11 is set where they are complex.
    if !(6..=15).contains(&(word & 0xff)) || word & 0x0800 != 0 {
        return Err(format!("its array is of class {}, expected real numbers", word & 0xff));
    }
    let (kind, data) = parts.next()?;
    let values = numbers(kind, data, big_endian)?;
    let expected = shape.iter().try_fold(1usize, |product, &n| product.checked_mul(n));
    if expected != Some(values.len()) {
        return Err(format!("its array of {shape:?} has {} values", values.len()));
    }
    Ok(Array { shape, values })
}

fn inflate(data: &[u8]) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let read = ZlibDecoder::new(data).take(MAX_INFLATED + 1).read_to_end(&mut bytes);
    read.map_err(|error| format!("a compressed element is damaged: {error}"))?;
    if bytes.len() as u64 > MAX_INFLATED { Err("an element is larger than one gigabyte".into()) } else { Ok(bytes) }
}

/// Elements one after the other.
struct Elements<'b> {
    bytes: &'b [u8],
    big_endian: bool,
}

impl<'b> Elements<'b> {
    fn word(&self, at: usize) -> Result<u32, String> {
        let word = self.bytes.get(at..at + 4).ok_or("it ends within an element")?;
        let word: [u8; 4] = word.try_into().expect("four bytes");
        Ok(if self.big_endian { u32::from_be_bytes(word) } else { u32::from_le_bytes(word) })
    }

    /// Type and bytes of the next one.
    fn next(&mut self) -> Result<(u32, &'b [u8]), String> {
        let tag = self.word(0)?;
        // Up to four bytes are stored in the tag itself, whose upper half is then their number.
        let (kind, from, length) = if tag >> 16 != 0 { (tag & 0xffff, 4, (tag >> 16) as usize) } else { (tag, 8, self.word(4)? as usize) };
        let data = self.bytes.get(from..).and_then(|rest| rest.get(..length)).ok_or("it ends within an element")?;
        let padded = if from == 4 {
            8
        } else if kind == COMPRESSED {
            8 + length
        } else {
            8 + length.next_multiple_of(8)
        };
        self.bytes = self.bytes.get(padded..).unwrap_or_default();
        Ok((kind, data))
    }
}

/// Numbers of any type.
fn numbers(kind: u32, data: &[u8], big_endian: bool) -> Result<Vec<f64>, String> {
    macro_rules! read_as {
        ($type:ty) => {
            data.chunks_exact(size_of::<$type>())
                .map(|chunk| {
                    let bytes = chunk.try_into().expect("chunks of that size");
                    (if big_endian { <$type>::from_be_bytes(bytes) } else { <$type>::from_le_bytes(bytes) }) as f64
                })
                .collect()
        };
    }
    Ok(match kind {
        INT8 => read_as!(i8),
        UINT8 => read_as!(u8),
        3 => read_as!(i16),
        4 => read_as!(u16),
        INT32 => read_as!(i32),
        UINT32 => read_as!(u32),
        7 => read_as!(f32),
        9 => read_as!(f64),
        12 => read_as!(i64),
        13 => read_as!(u64),
        other => return Err(format!("its numbers are of type {other}, which is none of the format's")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_array_comes_back() {
        let values: Vec<u8> = (0..24).map(|i| i % 7).collect();
        let found = read(&write("voxel", [2, 3, 4], &values), "voxel").unwrap();
        assert_eq!(found, Array { shape: vec![2, 3, 4], values: values.iter().map(|&v| f64::from(v)).collect() });
    }

    /// `scipy.io.savemat(file, {"note": 3.5, "voxel": numpy.arange(8).reshape(2, 2, 2)}, do_compression=False)` without its clock.
    fn scipys(big_endian: bool) -> Vec<u8> {
        let word = |n: u32| if big_endian { n.to_be_bytes() } else { n.to_le_bytes() };
        let mut bytes = vec![b' '; 124];
        bytes.extend(if big_endian { *b"\x01\x00MI" } else { *b"\x00\x01IM" });
        let mut matrix = |name: &[u8], dimensions: &[u32], values: &[f64], small_name: bool| {
            let mut body = [word(6), word(8), word(6), word(0)].concat();
            body.extend([word(5), word(4 * dimensions.len() as u32)].concat());
            body.extend(dimensions.iter().flat_map(|&n| word(n)));
            body.resize(body.len().next_multiple_of(8), 0);
            if small_name {
                body.extend(word((name.len() as u32) << 16 | 1));
            } else {
                body.extend([word(1), word(name.len() as u32)].concat());
            }
            body.extend(name);
            body.resize(body.len().next_multiple_of(8), 0);
            body.extend([word(9), word(8 * values.len() as u32)].concat());
            body.extend(values.iter().flat_map(|v| if big_endian { v.to_be_bytes() } else { v.to_le_bytes() }));
            bytes.extend([word(14), word(body.len() as u32)].concat());
            bytes.extend(body);
        };
        matrix(b"note", &[1, 1], &[3.5], true);
        matrix(b"voxel", &[2, 2, 2], &[0.0, 4.0, 2.0, 6.0, 1.0, 5.0, 3.0, 7.0], false);
        bytes
    }

    #[test]
    fn doubles_small_names_and_both_byte_orders_are_read() {
        for big_endian in [false, true] {
            let found = read(&scipys(big_endian), "voxel").unwrap();
            assert_eq!((found.shape, found.values), (vec![2, 2, 2], vec![0.0, 4.0, 2.0, 6.0, 1.0, 5.0, 3.0, 7.0]));
            assert_eq!(read(&scipys(big_endian), "note").unwrap().values, [3.5]);
        }
    }

    #[test]
    fn broken_files_are_explained() {
        let whole = write("voxel", [2, 2, 2], &[1; 8]);
        assert!(read(&whole, "shape").unwrap_err().contains("no array \"shape\", but voxel"));
        assert!(read(b"short", "voxel").unwrap_err().contains("version 5"));
        assert!(read(b"\x89HDF\r\n\x1a\n", "voxel").unwrap_err().contains("7.3"));
        for length in HEADER + 1..whole.len() {
            assert!(read(&whole[..length], "voxel").is_err(), "{length} bytes");
        }
        for (length, bytes) in (HEADER..).zip((HEADER..300).map(|length| scipys(false)[..length].to_vec())) {
            assert!(read(&bytes, "voxel").is_err(), "{length} bytes");
        }
    }
}
