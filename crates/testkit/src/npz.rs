//! Reads NumPy's `.npz` archives, for comparisons with results that other programs made.

use std::collections::BTreeMap;
use std::io::Read as _;

/// The arrays of an archive by name, without `.npy`.
pub struct Npz(BTreeMap<String, Vec<u8>>);

impl Npz {
    /// The arrays in the bytes of an archive, compressed or not.
    ///
    /// # Panics
    /// When the bytes are not such an archive.
    pub fn new(bytes: &[u8]) -> Self {
        let u16_at = |at: usize| usize::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]));
        let u32_at = |at: usize| u16_at(at) | (u16_at(at + 2) << 16);
        let end = bytes.windows(4).rposition(|w| w == b"PK\x05\x06").expect("not a zip archive: it has no end record");
        let mut at = u32_at(end + 16);
        let mut arrays = BTreeMap::new();
        for _ in 0..u16_at(end + 10) {
            assert_eq!(&bytes[at..at + 4], b"PK\x01\x02", "the zip archive's directory is damaged");
            let (method, size, name_length, local) = (u16_at(at + 10), u32_at(at + 20), u16_at(at + 28), u32_at(at + 42));
            let name = String::from_utf8_lossy(&bytes[at + 46..at + 46 + name_length]);
            let data = local + 30 + u16_at(local + 26) + u16_at(local + 28);
            let packed = &bytes[data..data + size];
            let mut content = Vec::new();
            match method {
                0 => content.extend(packed),
                8 => drop(flate2::read::DeflateDecoder::new(packed).read_to_end(&mut content).expect("a compressed array is damaged")),
                other => panic!("{name}: zip method {other} is not read"),
            }
            arrays.insert(name.trim_end_matches(".npy").to_string(), content);
            at += 46 + name_length + u16_at(at + 30) + u16_at(at + 32);
        }
        Self(arrays)
    }

    /// The values of an array of float32, in C order.
    pub fn f32(&self, name: &str) -> Vec<f32> {
        self.values(name, "<f4", f32::from_le_bytes)
    }

    /// The values of an array of float64, in C order.
    pub fn f64(&self, name: &str) -> Vec<f64> {
        self.values(name, "<f8", f64::from_le_bytes)
    }

    /// The values of an array of int32, in C order.
    pub fn i32(&self, name: &str) -> Vec<i32> {
        self.values(name, "<i4", i32::from_le_bytes)
    }

    /// The values of an array of int64, in C order.
    pub fn i64(&self, name: &str) -> Vec<i64> {
        self.values(name, "<i8", i64::from_le_bytes)
    }

    fn values<const N: usize, T>(&self, name: &str, kind: &str, value: fn([u8; N]) -> T) -> Vec<T> {
        let npy = self.0.get(name).unwrap_or_else(|| panic!("no array {name:?}, only {:?}", self.0.keys()));
        let (start, length) = match npy[6] {
            1 => (10, usize::from(u16::from_le_bytes([npy[8], npy[9]]))),
            _ => (12, u32::from_le_bytes([npy[8], npy[9], npy[10], npy[11]]) as usize),
        };
        let header = String::from_utf8_lossy(&npy[start..start + length]);
        assert!(header.contains(kind) && header.contains("'fortran_order': False"), "{name}: expected {kind} in C order, found {header}");
        npy[start + length..].chunks_exact(N).map(|bytes| value(bytes.try_into().expect("a chunk has its length"))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_archive_written_by_numpy_is_read() {
        // numpy.savez("a.npz", v=numpy.array([[1.5, -2.0]], "f4")), stored.
        let mut npy = b"\x93NUMPY\x01\x00".to_vec();
        let header = format!("{:<117}\n", "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }");
        npy.extend((header.len() as u16).to_le_bytes());
        npy.extend(header.as_bytes());
        npy.extend([1.5f32, -2.0].into_iter().flat_map(f32::to_le_bytes));
        let size = (npy.len() as u32).to_le_bytes();
        let mut zip = [b"PK\x03\x04".as_slice(), &[0; 22], &[5, 0, 0, 0], b"v.npy", &npy].concat();
        let directory = zip.len() as u32;
        zip.extend([b"PK\x01\x02".as_slice(), &[0; 16], &size, &size, &[5, 0], &[0; 16], b"v.npy"].concat());
        zip.extend([b"PK\x05\x06".as_slice(), &[0; 6], &[1, 0], &[0; 4], &directory.to_le_bytes(), &[0; 2]].concat());
        assert_eq!(Npz::new(&zip).f32("v"), [1.5, -2.0]);
    }
}
