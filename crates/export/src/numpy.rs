//! Layers as the bytes of `.npy` files, version 1.0 of the format (NEP 1).

use enfilade_dataset::npy_head;
use enfilade_frame::{Dtype, Values};

/// The bytes of an array file in C order, little-endian.
pub(crate) fn npy(values: &Values, shape: &[usize]) -> Vec<u8> {
    let dtype = match values.dtype() {
        Dtype::F16 => "<f2",
        Dtype::F32 => "<f4",
        Dtype::I16 => "<i2",
        Dtype::U8 => "|u1",
    };
    let mut bytes = npy_head(dtype, shape);
    bytes.extend(values.as_bytes());
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_begin_at_a_multiple_of_64_and_the_header_says_what_they_are() {
        for n in 1..80 {
            let bytes = npy(&Values::I16(vec![-1; n]), &[n, 1]);
            let start = bytes.len() - 2 * n;
            assert_eq!((start % 64, bytes[start - 1], bytes[start]), (0, b'\n', 0xff));
            assert_eq!(10 + u16::from_le_bytes([bytes[8], bytes[9]]) as usize, start);
        }
        let text = String::from_utf8_lossy(&npy(&Values::U8(vec![0; 6]), &[2, 3])).into_owned();
        assert!(text.contains("{'descr': '|u1', 'fortran_order': False, 'shape': (2, 3), }"), "{text}");
    }
}
