//! Lists of numbers packed into a string: hexadecimal, or compressed by zlib and written in base 64.
//!
//! `ZIPC`, then the number of bytes unpacked and packed (each a little-endian u32 in 8 hexadecimal digits), then base 64. Without
//! `ZIPC` the string is plain hexadecimal.

use crate::error::SceneTextError;
use crate::scan::Scanner;
use crate::transform::{Transform, Vector};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use std::io::{Read, Write};

const MAGIC: &[u8] = b"ZIPC";
/// A list longer than this is refused, bytes; a mesh of eighty million vertices fits. The limit is needed because a small packed string
/// can expand a thousandfold.
const MAX_BYTES: usize = 1 << 30;

/// The string of a packed list and the bracket after it; `unit` reads one value from its bytes.
pub fn list<T, const N: usize>(scanner: &mut Scanner, unit: fn([u8; N]) -> T) -> Result<Vec<T>, SceneTextError> {
    let bytes = unpacked(scanner)?;
    let (units, rest) = bytes.as_chunks::<N>();
    if !rest.is_empty() {
        return Err(scanner.error_at(scanner.at - 1, format!("a multiple of {N} bytes and not {}", bytes.len())));
    }
    Ok(units.iter().map(|bytes| unit(*bytes)).collect())
}

/// Three float32.
pub fn triple(bytes: [u8; 12]) -> Vector {
    let (units, _) = bytes.as_chunks::<4>();
    std::array::from_fn(|i| f32::from_le_bytes(units[i]))
}

/// The string of a transform and the bracket after it: nine float32, then three float64 (or, of old exporters, float32).
pub fn transform(scanner: &mut Scanner) -> Result<Transform, SceneTextError> {
    const MATRIX_BYTES: usize = 36;
    let bytes = unpacked(scanner)?;
    let Some((matrix, offset)) = bytes.split_at_checked(MATRIX_BYTES) else {
        return Err(scanner.error_at(scanner.at - 1, format!("60 bytes and not {}", bytes.len())));
    };
    let (rows, _) = matrix.as_chunks::<12>();
    let offset = match offset.len() {
        24 => offset.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect(),
        12 => offset.as_chunks::<4>().0.iter().map(|b| f64::from(f32::from_le_bytes(*b))).collect(),
        _ => Vec::new(),
    };
    let Ok(offset) = <[f64; 3]>::try_from(offset) else {
        return Err(scanner.error_at(scanner.at - 1, format!("60 bytes and not {}", bytes.len())));
    };
    Ok(Transform { matrix: std::array::from_fn(|i| triple(rows[i])), offset })
}

/// A string and the bracket after it, unpacked.
fn unpacked(scanner: &mut Scanner) -> Result<Vec<u8>, SceneTextError> {
    scanner.skip_blank()?;
    let at = scanner.at + 1;
    let text = scanner.string()?;
    let bytes = match text.strip_prefix(MAGIC) {
        Some(rest) => inflated(rest).map_err(|expected| scanner.error_at(at, expected))?,
        None => from_hex(text).ok_or_else(|| scanner.error_at(at, "hexadecimal digits, two per byte"))?,
    };
    scanner.expect(b')', "`)` after the string")?;
    Ok(bytes)
}

/// Decodes the text after `ZIPC`; the error is what was expected there.
fn inflated(text: &[u8]) -> Result<Vec<u8>, String> {
    let header = text.get(..16).and_then(from_hex).ok_or("two sizes of 8 hexadecimal digits after ZIPC")?;
    let (sizes, _) = header.as_chunks::<4>();
    let [raw_size, packed_size] = [0, 1].map(|i| u32::from_le_bytes(sizes[i]) as usize);
    if raw_size > MAX_BYTES {
        return Err(format!("at most {MAX_BYTES} bytes unpacked and not {raw_size}"));
    }
    let packed = STANDARD.decode(&text[16..]).map_err(|e| format!("base 64 after the sizes ({e})"))?;
    if packed.len() != packed_size {
        return Err(format!("{packed_size} packed bytes as the header says and not {}", packed.len()));
    }
    // Reads no more than the header promises and one byte, so that a damaged file cannot fill the memory.
    let mut raw = Vec::new();
    let read = ZlibDecoder::new(packed.as_slice()).take(raw_size as u64 + 1).read_to_end(&mut raw);
    read.map_err(|e| format!("data packed by zlib ({e})"))?;
    if raw.len() == raw_size { Ok(raw) } else { Err(format!("{raw_size} bytes unpacked as the header says and not {}", raw.len())) }
}

fn from_hex(text: &[u8]) -> Option<Vec<u8>> {
    let digit = |b: u8| char::from(b).to_digit(16).map(|d| d as u8);
    let (pairs, rest) = text.as_chunks::<2>();
    if rest.is_empty() { pairs.iter().map(|&[high, low]| Some(digit(high)? << 4 | digit(low)?)).collect() } else { None }
}

/// Writes a packed list under its name.
pub fn write(name: &str, bytes: impl Iterator<Item = u8>, out: &mut Vec<u8>) {
    let raw: Vec<u8> = bytes.collect();
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(&raw).expect("writing to memory cannot fail");
    let packed = encoder.finish().expect("writing to memory cannot fail");
    let hex = |size: usize| (size as u32).to_le_bytes().iter().map(|b| format!("{b:02X}")).collect::<String>();
    out.extend(format!("{name}(\"ZIPC{}{}{}\")", hex(raw.len()), hex(packed.len()), STANDARD.encode(&packed)).bytes());
}
