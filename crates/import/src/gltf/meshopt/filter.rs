//! Filters of attributes, applied after unpacking: unit vectors, rotations, floats and colours from forms that pack better.
//!
//! Appendix B of `KHR_meshopt_compression`.

use super::super::packed::Filter;

/// Filters elements of `stride` bytes in place.
pub(super) fn apply(filter: Filter, stride: usize, bytes: &mut [u8]) {
    match (filter, stride) {
        (Filter::None, _) => {}
        (Filter::Octahedral, 4) => {
            of_bytes(bytes, |v| octahedral(v.map(|b| f32::from(b as i8)), 127.0).map(|v| v as i8 as u8));
        }
        (Filter::Octahedral, _) => of_words(bytes, |v| octahedral(v.map(|w| f32::from(w as i16)), 32_767.0).map(|v| v as i16 as u16)),
        (Filter::Quaternion, _) => of_words(bytes, |v| quaternion(v.map(|w| w as i16)).map(|v| v as u16)),
        (Filter::Exponential, _) => {
            bytes.as_chunks_mut::<4>().0.iter_mut().for_each(|v| *v = exponential(i32::from_le_bytes(*v)).to_le_bytes());
        }
        (Filter::Color, 4) => {
            of_bytes(bytes, |[y, o, g, a]| color([i32::from(y), i32::from(o as i8), i32::from(g as i8)], a.into(), 255).map(|v| v as u8));
        }
        (Filter::Color, _) => of_words(bytes, |[y, o, g, a]| {
            color([i32::from(y), i32::from(o as i16), i32::from(g as i16)], a.into(), 65_535).map(|v| v as u16)
        }),
    }
}

fn of_bytes(bytes: &mut [u8], filter: impl Fn([u8; 4]) -> [u8; 4]) {
    bytes.as_chunks_mut::<4>().0.iter_mut().for_each(|element| *element = filter(*element));
}

/// Filters elements of four numbers of 16 bits.
fn of_words(bytes: &mut [u8], filter: impl Fn([u16; 4]) -> [u16; 4]) {
    for element in bytes.as_chunks_mut::<8>().0 {
        let words = filter([0, 1, 2, 3].map(|i| u16::from_le_bytes([element[2 * i], element[2 * i + 1]])));
        for (bytes, word) in element.chunks_exact_mut(2).zip(words) {
            bytes.copy_from_slice(&word.to_le_bytes());
        }
    }
}

/// A unit vector by its place on an octahedron; the third number represents one, and the fourth is kept. Casts of the result saturate.
fn octahedral([x, y, one, w]: [f32; 4], largest: f32) -> [f32; 4] {
    let (x, y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    // The lower half is folded out.
    let beyond = (-z).max(0.0);
    let unfolded = |v: f32| if v >= 0.0 { v - beyond } else { v + beyond };
    let (x, y) = (unfolded(x), unfolded(y));
    let scale = largest / (x * x + y * y + z * z).sqrt();
    let [x, y, z] = [x, y, z].map(|v| (v * scale).round());
    [x, y, z, w]
}

/// A rotation by its three smaller components; the fourth number contains the index of the one that is left out, and the value that
/// represents one.
fn quaternion([x, y, z, last]: [i16; 4]) -> [i16; 4] {
    let scale = std::f32::consts::FRAC_1_SQRT_2 / f32::from(last | 3);
    let [x, y, z] = [x, y, z].map(|v| f32::from(v) * scale);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let mut rotation = [0; 4];
    for (i, v) in [w, x, y, z].into_iter().enumerate() {
        rotation[((last & 3) as usize + i) % 4] = (v * 32_767.0).round() as i16;
    }
    rotation
}

/// A float of a whole number of 24 bits and a power of two of 8 bits.
fn exponential(v: i32) -> f32 {
    2f32.powi(v >> 24) * (v << 8 >> 8) as f32
}

/// Red, green, blue and alpha from luma, orange and green (YCoCg); alpha's highest bit gives the number of bits of all channels.
fn color([y, orange, green]: [i32; 3], alpha: u32, largest: u32) -> [u32; 4] {
    let mask = (2u32 << alpha.checked_ilog2().unwrap_or(0)) - 1;
    let low = alpha & mask >> 1;
    let scale = largest as f32 / mask as f32;
    let alpha = low << 1 | low & 1;
    [y + orange - green, y + green, y - orange - green, alpha as i32].map(|v| (v as f32 * scale).round().clamp(0.0, largest as f32) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_of_octahedra_are_unit_vectors() {
        let filtered = |element: [i8; 4]| {
            let mut bytes = element.map(|v| v as u8);
            apply(Filter::Octahedral, 4, &mut bytes);
            bytes.map(|v| v as i8)
        };
        assert_eq!(filtered([127, 0, 127, 9]), [127, 0, 0, 9]);
        assert_eq!(filtered([0, -63, 63, 0]), [0, -127, 0, 0]);
        assert_eq!(filtered([0, 0, 31, 0]), [0, 0, 127, 0]);
        // The corners are the way down.
        assert_eq!(filtered([-7, 7, 7, 0]), [0, 0, -127, 0]);
        filtered([1, 1, 0, 0]);
    }

    #[test]
    fn rotations_get_their_largest_component_back() {
        let half = (32_767.0 * std::f32::consts::FRAC_1_SQRT_2).round() as i16;
        for largest in 0..4usize {
            let mut expected = [0i16; 4];
            (expected[largest], expected[(largest + 1) % 4]) = (half, half);
            let last = 2044 | largest as i16;
            let rotation = quaternion([last | 3, 0, 0, last]);
            assert!(rotation.iter().zip(expected).all(|(a, b)| (a - b).abs() <= 1), "{rotation:?} {expected:?}");
        }
        // The value that represents one is never negative in a valid file; the index is read from the lowest bits all the same.
        assert_eq!(quaternion([0, 0, 0, -1]), [0, 0, 0, 32_767]);
    }

    #[test]
    fn floats_and_colours_are_as_the_specification_has_them() {
        assert_eq!(exponential(-2 << 24 | 5), 1.25);
        assert_eq!(exponential(3 << 24 | 0xff_ffff), -8.0);
        assert_eq!(exponential(0), 0.0);
        // White at eight bits of alpha: luma 255, no chroma, and all bits of alpha.
        assert_eq!(color([255, 0, 0], 0xff, 255), [255; 4]);
        // Red of four bits: (r, g, b) = (15, 0, 0) is luma 4, orange 7, green −4 by halves that round down.
        assert_eq!(color([4, 7, -4], 0b1111, 255), [255, 0, 17, 255]);
        assert_eq!(color([0, 0, 0], 0, 65_535)[..3], [0; 3]);
    }
}
