//! Portable float map: `PF` (colour) or `Pf` (grey), width, height, scale (negative: little-endian), rows from the bottom up.

use super::float_picture::FloatPicture;

/// Decodes a PFM.
pub(super) fn decode(bytes: &[u8]) -> Result<FloatPicture, String> {
    let mut at = 0;
    let mut field = |what: &str| -> Result<&str, String> {
        while bytes.get(at).is_some_and(u8::is_ascii_whitespace) {
            at += 1;
        }
        let start = at;
        while bytes.get(at).is_some_and(|b| !b.is_ascii_whitespace()) {
            at += 1;
        }
        let text = std::str::from_utf8(&bytes[start..at]).unwrap_or_default();
        if text.is_empty() { Err(format!("is a PFM whose header ends before its {what}")) } else { Ok(text) }
    };
    let channels = if field("signature")? == "PF" { 3 } else { 1 };
    let number = |what: &str, text: &str| text.parse::<u32>().map_err(|_| format!("is a PFM with the {what} {text:?}"));
    let width = number("width", field("width")?)?;
    let height = number("height", field("height")?)?;
    let scale_text = field("scale")?;
    let scale: f32 = scale_text.parse().map_err(|_| format!("is a PFM with the scale {scale_text:?}"))?;
    let body = bytes.get(at + 1..).unwrap_or_default();
    let row_bytes = width as usize * channels * 4;
    let needed = row_bytes.checked_mul(height as usize).filter(|&n| n > 0 && body.len() >= n);
    let needed = needed.ok_or_else(|| format!("is a PFM of {width}x{height} pixels with only {} bytes of them", body.len()))?;
    let value = |b: &[u8]| {
        let four = [b[0], b[1], b[2], b[3]];
        if scale < 0.0 { f32::from_le_bytes(four) } else { f32::from_be_bytes(four) }
    };
    let texel = |b: &[u8]| if channels == 3 { [value(b), value(&b[4..]), value(&b[8..])] } else { [value(b); 3] };
    let texels = body[..needed].chunks_exact(row_bytes).rev().flat_map(|row| row.chunks_exact(channels * 4).map(texel)).collect();
    Ok(FloatPicture { width, height, texels })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_from_the_bottom_up_in_either_byte_order() {
        let mut bytes = b"Pf\n1 2\n-1.0\n".to_vec();
        bytes.extend([1.0f32, 2.0].iter().flat_map(|v| v.to_le_bytes()));
        assert_eq!(decode(&bytes).unwrap().texels, vec![[2.0; 3], [1.0; 3]]);
        let mut bytes = b"PF 1 1 1.0\n".to_vec();
        bytes.extend([1.0f32, 2.0, 3.0].iter().flat_map(|v| v.to_be_bytes()));
        assert_eq!(decode(&bytes).unwrap().texels, vec![[1.0, 2.0, 3.0]]);
    }

    #[test]
    fn truncated_and_absurd_headers_are_told() {
        assert!(decode(b"PF\n2 2\n-1.0\nabc").err().unwrap().contains("only 3 bytes"));
        assert!(decode(b"PF\n4294967295 4294967295\n-1.0\n").is_err());
        assert!(decode(b"PF\n2").err().unwrap().contains("ends before its height"));
    }
}
