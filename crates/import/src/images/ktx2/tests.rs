//! Pictures that Basis Universal's own encoder has made (`tests/ktx2/make.mjs`), and ones put together here.

use super::super::float_picture::FloatPicture;
use super::*;

/// A file of these texels; `level` is the content of its level.
fn file(format: u32, scheme: u32, size: [u32; 2], notes: &[u8], level: &[u8]) -> Vec<u8> {
    let notes_at = FIXED_AND_LEVEL + DESCRIPTOR.len();
    let words = [format, 1, size[0], size[1], 0, 0, 1, 1, scheme, FIXED_AND_LEVEL as u32, 44, notes_at as u32, notes.len() as u32];
    let longs = [0u64, 0, (notes_at + notes.len()) as u64, level.len() as u64, 0];
    let words = words.into_iter().flat_map(u32::to_le_bytes).chain(longs.into_iter().flat_map(u64::to_le_bytes));
    MAGIC.iter().copied().chain(words).chain(DESCRIPTOR).chain(notes.iter().copied()).chain(level.iter().copied()).collect()
}

const FIXED_AND_LEVEL: usize = 104;
const DESCRIPTOR: [u8; 44] = [0; 44];

fn note(key: &str, value: &str) -> Vec<u8> {
    let entry = [key.as_bytes(), b"\0", value.as_bytes(), b"\0"].concat();
    let mut bytes = [&(entry.len() as u32).to_le_bytes()[..], &entry].concat();
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    bytes
}

fn texels(file: &[u8]) -> Vec<[u8; 4]> {
    match decode(file).unwrap_or_else(|e| panic!("{e}")) {
        Surface::Bytes { texels, .. } => texels,
        Surface::Floats(_) => panic!("floats"),
    }
}

/// The largest and the mean difference of a channel from the picture that `make.mjs` encodes.
fn errors(file: &[u8], with_alpha: bool) -> (i32, f64) {
    let found = texels(file);
    assert_eq!(found.len(), 24 * 18);
    let (mut largest, mut sum) = (0, 0.0);
    for (i, texel) in found.iter().enumerate() {
        let (x, y) = (i as i32 % 24, i as i32 / 24);
        let expected = [10 * x, 14 * y, 128, if with_alpha { 255 - 8 * x } else { 255 }];
        for (found, expected) in texel.iter().zip(expected) {
            let difference = (i32::from(*found) - expected).abs();
            (largest, sum) = (largest.max(difference), sum + f64::from(difference));
        }
    }
    (largest, sum / (4 * found.len()) as f64)
}

const UASTC: &[u8] = include_bytes!("../../../tests/ktx2/uastc.ktx2");

#[test]
fn basis_universal_is_its_picture_within_the_error_of_the_form() {
    for (name, bytes, with_alpha, largest, mean) in [
        ("ETC1S", &include_bytes!("../../../tests/ktx2/etc1s.ktx2")[..], false, 40, 8.0),
        ("ETC1S with alpha", include_bytes!("../../../tests/ktx2/etc1s_alpha.ktx2"), true, 40, 8.0),
        ("UASTC", UASTC, false, 12, 2.0),
        ("UASTC, Zstandard", include_bytes!("../../../tests/ktx2/uastc_alpha_zstd.ktx2"), true, 12, 2.0),
    ] {
        let (worst, typical) = errors(bytes, with_alpha);
        assert!(worst <= largest && typical <= mean, "{name}: {worst} {typical}");
    }
}

#[test]
fn zlib_unpacks_to_the_same_texels() {
    let level = u64::from_le_bytes(*UASTC[80..].first_chunk().unwrap()) as usize;
    let mut packed = Vec::new();
    std::io::Read::read_to_end(&mut flate2::read::ZlibEncoder::new(&UASTC[level..], flate2::Compression::default()), &mut packed).unwrap();
    let mut file = [&UASTC[..level], &packed].concat();
    file[44] = 3;
    file[88..96].copy_from_slice(&(packed.len() as u64).to_le_bytes());
    assert_eq!(texels(&file), texels(UASTC));
}

#[test]
fn plain_texels_and_blocks_are_read_by_their_number() {
    assert_eq!(texels(&file(43, 0, [2, 1], &[], &[1, 2, 3, 4, 5, 6, 7, 8])), [[1, 2, 3, 4], [5, 6, 7, 8]]);
    assert_eq!(texels(&file(23, 0, [1, 1], &[], &[1, 2, 3])), [[1, 2, 3, 255]]);
    assert_eq!(texels(&file(9, 0, [1, 1], &[], &[9])), [[9, 9, 9, 255]]);
    // BC1: one colour in 5, 6 and 5 bits for all texels.
    assert_eq!(texels(&file(131, 0, [4, 4], &[], &[0x00, 0xf8, 0x1f, 0x00, 0, 0, 0, 0])), [[255, 0, 0, 255]; 16]);
    let pixel: Vec<u8> = [4.0f32, 0.5, 0.25].iter().flat_map(|v| v.to_le_bytes()).collect();
    let floats = Surface::Floats(FloatPicture { width: 1, height: 1, texels: vec![[4.0, 0.5, 0.25]] });
    assert_eq!(decode(&file(106, 0, [1, 1], &[], &pixel)), Ok(floats));
}

#[test]
fn notes_turn_rows_and_channels() {
    let up = note("KTXorientation", "ru");
    assert_eq!(texels(&file(37, 0, [1, 2], &up, &[1, 2, 3, 4, 5, 6, 7, 8])), [[5, 6, 7, 8], [1, 2, 3, 4]]);
    let swizzled = [note("KTXwriter", "x"), note("KTXswizzle", "rrr1")].concat();
    assert_eq!(texels(&file(37, 0, [1, 1], &swizzled, &[1, 2, 3, 4])), [[1, 1, 1, 255]]);
    let pixel: Vec<u8> = [4.0f32, 0.5, 0.25].iter().flat_map(|v| v.to_le_bytes()).collect();
    let floats = Surface::Floats(FloatPicture { width: 1, height: 1, texels: vec![[0.25, 1.0, 0.0]] });
    assert_eq!(decode(&file(106, 0, [1, 1], &note("KTXswizzle", "b101"), &pixel)), Ok(floats));
}

#[test]
fn two_channels_of_basis_universal_are_normals() {
    let mut file = UASTC.to_vec();
    let descriptor = u32::from_le_bytes(*file[48..].first_chunk().unwrap()) as usize;
    file[descriptor + 31] = 6;
    for (found, stored) in texels(&file).iter().zip(texels(UASTC)) {
        assert_eq!(*found, super::super::layout::normal([stored[0], stored[1]]));
    }
}

#[test]
fn damage_and_unknown_texels_are_told() {
    let error = |bytes: &[u8]| decode(bytes).unwrap_err();
    assert!(error(MAGIC).contains("cut short in its header"));
    assert!(error(&file(157, 0, [4, 4], &[], &[0; 16])).contains("Vulkan's format 157, which is not read; save it as PNG"));
    assert!(error(&file(37, 7, [1, 1], &[], &[0; 4])).contains("packed in scheme 7"));
    assert!(error(&file(37, 0, [2, 2], &[], &[0; 4])).contains("4 bytes of its picture, expected 16"));
    assert!(error(&file(37, 2, [1, 1], &[], &[0; 4])).contains("cannot be unpacked"));
    assert!(error(&file(37, 0, [1 << 20, 1 << 20], &[], &[])).contains("pixels, expected at most"));
    assert!(error(&file(0, 1, [4, 4], &[], &[])).contains("colour model 0"));
    let etc1s = include_bytes!("../../../tests/ktx2/etc1s.ktx2");
    for cut in [80, 150, 300, etc1s.len() - 40] {
        assert!(decode(&etc1s[..cut]).is_err(), "{cut}");
    }
}
