//! LZ4 in the framing of the filter that is registered with the HDF Group as 32004: the total length in 8 bytes, the length of a block in
//! 4, then before each block its compressed length, all big-endian. A block that does not shrink is stored as it is.

/// The frame of `raw`, in one block.
pub(super) fn compress(raw: &[u8]) -> Vec<u8> {
    let block = lz4_flex::block::compress(raw);
    let block = if block.len() < raw.len() { &block[..] } else { raw };
    let length = |n: usize| (n as u32).to_be_bytes();
    [&(raw.len() as u64).to_be_bytes()[..], &length(raw.len()), &length(block.len()), block].concat()
}

/// Fills `out` and gives the number of bytes; `None` when the frame is damaged or contains more.
pub(super) fn decompress(frame: &[u8], out: &mut [u8]) -> Option<usize> {
    let number = |at: usize| Some(u32::from_be_bytes(*frame.get(at..)?.first_chunk()?) as usize);
    let total = usize::try_from(u64::from_be_bytes(*frame.first_chunk()?)).ok()?;
    let block = number(8)?.min(total);
    let out = out.get_mut(..total).filter(|_| block > 0)?;
    let mut at = 12;
    for part in out.chunks_mut(block) {
        let length = number(at)?;
        let stored = frame.get(at + 4..)?.get(..length)?;
        if length == part.len() {
            part.copy_from_slice(stored);
        } else if lz4_flex::block::decompress_into(stored, part).ok()? != part.len() {
            return None;
        }
        at += 4 + length;
    }
    Some(total)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_come_back_and_damage_is_found() {
        let smooth: Vec<u8> = (0..40_000u32).map(|i| (i / 300) as u8).collect();
        let noise: Vec<u8> = (0..4000u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
        for raw in [smooth, noise] {
            let frame = compress(&raw);
            let mut out = vec![0; raw.len()];
            assert_eq!(decompress(&frame, &mut out), Some(raw.len()));
            assert!(out == raw && frame.len() <= raw.len() + 16);
            assert_eq!(decompress(&frame[..frame.len() - 1], &mut out), None);
            assert_eq!(decompress(&frame, &mut vec![0; raw.len() - 1]), None);
            assert_eq!(decompress(&frame[..11], &mut out), None);
        }
    }
}
