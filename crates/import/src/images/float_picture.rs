//! Pictures of floating-point numbers as the decoders hand them on, and the size that no picture may exceed.

/// Larger pictures are refused before they are decoded: a small file can claim any number of pixels and, if they are equal, even store them.
const MAX_TEXELS: u64 = 1 << 27;

/// A linear floating-point picture, row 0 at the top.
#[derive(Debug, PartialEq)]
pub(super) struct FloatPicture {
    pub width: u32,
    pub height: u32,
    pub texels: Vec<[f32; 3]>,
}

/// Refuses pictures that are too large.
pub(super) fn check_size(width: u32, height: u32) -> Result<(), String> {
    if u64::from(width) * u64::from(height) > MAX_TEXELS {
        return Err(format!("has {width}x{height} pixels, expected at most {MAX_TEXELS} of them; make it smaller"));
    }
    Ok(())
}
