//! KTX 2: the first picture of a file, uncompressed, in blocks (BC1 to BC7), or in Basis Universal's forms (ETC1S, UASTC).
//!
//! The layout follows the KTX File Format Specification 2.0. Of cube maps, arrays, volumes and smaller copies (mipmaps) the first and
//! largest picture is read. Two channels of Basis Universal are the x and y of normals, to which z is added, as for BC5.

mod basis;
mod header;
mod inflate;

use super::float_picture::check_size;
use super::layout::Surface;
use header::{Header, Texels};

/// The first bytes of every file.
pub(super) const MAGIC: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";

/// Decodes a file.
///
/// # Errors
/// The fault, as the rest of a sentence that begins with its name.
pub(super) fn decode(bytes: &[u8]) -> Result<Surface, String> {
    let header = Header::read(bytes)?;
    let Header { width, height, .. } = header;
    check_size(width, height)?;
    let level = header.level(bytes)?;
    let surface = match header.texels {
        Texels::Plain(layout) => {
            let level = inflate::inflate(header.packing, level, layout.bytes(width, height))?;
            layout.decode(&level, width, height)
        }
        Texels::Uastc => {
            let size = u64::from(width.div_ceil(4)) * u64::from(height.div_ceil(4)) * 16;
            let level = inflate::inflate(header.packing, level, size)?;
            Surface::Bytes { width, height, texels: basis::uastc(&level, &header)? }
        }
        Texels::Etc1s => Surface::Bytes { width, height, texels: basis::etc1s(bytes, level, &header)? },
    };
    Ok(arranged(surface, &header))
}

/// The picture with its rows from the top down, and its channels in the order that the file specifies.
fn arranged(surface: Surface, header: &Header) -> Surface {
    fn from_top<T: Copy>(width: u32, texels: Vec<T>, header: &Header) -> Vec<T> {
        if header.bottom_up { texels.chunks_exact(width as usize).rev().flatten().copied().collect() } else { texels }
    }
    match surface {
        Surface::Floats(mut picture) => {
            picture.texels = from_top(picture.width, picture.texels, header);
            if let Some([red, green, blue, _]) = header.swizzle {
                let channel = |[r, g, b]: [f32; 3], from: u8| channel([r, g, b, 1.0], from, 1.0);
                picture.texels.iter_mut().for_each(|texel| *texel = [red, green, blue].map(|from| channel(*texel, from)));
            }
            Surface::Floats(picture)
        }
        Surface::Bytes { width, height, texels } => {
            let mut texels = from_top(width, texels, header);
            if let Some(swizzle) = header.swizzle {
                texels.iter_mut().for_each(|texel| *texel = swizzle.map(|from| channel(*texel, from, 255)));
            }
            Surface::Bytes { width, height, texels }
        }
    }
}

/// The value of a texel that a letter of a swizzle refers to.
fn channel<T: Copy + Default>(texel: [T; 4], from: u8, one: T) -> T {
    match from {
        b'r' => texel[0],
        b'g' => texel[1],
        b'b' => texel[2],
        b'a' => texel[3],
        b'0' => T::default(),
        _ => one,
    }
}

#[cfg(test)]
mod tests;
