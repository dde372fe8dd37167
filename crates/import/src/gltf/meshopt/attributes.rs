//! The packing of attributes: bytes of the same place in consecutive elements, as differences in groups of 16.
//!
//! Mode 0 of appendix A of `KHR_meshopt_compression`. Version 0 has differences of bytes, version 1 also those of 16 bits, and exclusive
//! ors of 32.

use super::bytes::{Bytes, CUT_SHORT, signed};

/// Elements of a block, at most.
const BLOCK: usize = 256;

/// Bits of a difference in a group by the two bits of its header: of version 0, and of version 1 where the control of the byte is 0 or 1.
const BITS: [[u32; 4]; 3] = [[0, 2, 4, 8], [0, 1, 2, 4], [1, 2, 4, 8]];

/// Unpacks the given number of elements of `stride` bytes, a multiple of 4.
///
/// # Errors
/// When the data are damaged, as the rest of a sentence.
pub(super) fn unpack(packed: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, String> {
    let version = match packed.first() {
        Some(0xa0) => 0,
        Some(0xa1) => 1,
        found => return Err(format!("begins with {found:02x?}, expected a0 or a1 for attributes; export the file again")),
    };
    // Behind the blocks, at the very end, are the element before the first and, in version 1, the kind of every four bytes.
    let tail = if version == 0 { stride } else { stride + stride / 4 };
    let padded = tail.max(if version == 0 { 32 } else { 24 });
    let blocks = packed.len().checked_sub(padded).and_then(|end| packed.get(1..end)).ok_or(CUT_SHORT)?;
    let (first, kinds) = packed[packed.len() - tail..].split_at(stride);
    let mut last = first.to_vec();
    let mut bytes = Bytes(blocks);
    let mut elements = Vec::new();
    let block = ((0x2000 / stride) & !15).min(BLOCK);
    let mut differences = vec![[0u8; BLOCK]; stride];
    for start in (0..count).step_by(block) {
        let count = block.min(count - start);
        read_block(&mut bytes, version, count, &mut differences)?;
        for i in 0..count {
            for (word, last) in last.chunks_exact_mut(4).enumerate() {
                let difference = [0, 1, 2, 3].map(|byte| differences[4 * word + byte][i]);
                step(last, difference, kinds.get(word).copied().unwrap_or(0))?;
            }
            elements.extend_from_slice(&last);
        }
    }
    bytes.end()?;
    Ok(elements)
}

/// Reads the differences of a block, byte by byte of an element.
fn read_block(bytes: &mut Bytes, version: u8, count: usize, differences: &mut [[u8; BLOCK]]) -> Result<(), String> {
    let controls = if version == 0 { &[][..] } else { bytes.take(differences.len() / 4)? };
    let groups = count.div_ceil(16);
    for (byte, column) in differences.iter_mut().enumerate() {
        let control = controls.get(byte / 4).map(|c| c >> (2 * (byte % 4)) & 3);
        let bits = match control {
            None => &BITS[0],
            Some(2) => {
                column.fill(0);
                continue;
            }
            Some(3) => {
                column[..count].copy_from_slice(bytes.take(count)?);
                continue;
            }
            Some(control) => &BITS[usize::from(control) + 1],
        };
        let headers = bytes.take(groups.div_ceil(4))?;
        for (i, group) in column.as_chunks_mut::<16>().0.iter_mut().take(groups).enumerate() {
            let header = headers[i / 4] >> (2 * (i % 4)) & 3;
            read_group(bytes, bits[usize::from(header)], group)?;
        }
    }
    Ok(())
}

/// Reads 16 differences of the given number of bits; with fewer than eight bits, the largest number means that a whole byte follows after
/// the group.
fn read_group(bytes: &mut Bytes, bits: u32, group: &mut [u8; 16]) -> Result<(), String> {
    if bits == 0 {
        group.fill(0);
        return Ok(());
    }
    let heads = bytes.take(2 * bits as usize)?;
    if bits == 8 {
        group.copy_from_slice(heads);
        return Ok(());
    }
    let (in_byte, follows) = (8 / bits as usize, (1u8 << bits) - 1);
    for (i, difference) in group.iter_mut().enumerate() {
        // The highest bits come first, except for single ones.
        let place = if bits == 1 { i % 8 } else { in_byte - 1 - i % in_byte };
        let head = heads[i / in_byte] >> (place * bits as usize) & follows;
        *difference = if head == follows { bytes.byte()? } else { head };
    }
    Ok(())
}

/// Four bytes of an element from those of the one before.
fn step(last: &mut [u8], difference: [u8; 4], kind: u8) -> Result<(), String> {
    let pair = |bytes: &[u8]| u16::from_le_bytes([bytes[0], bytes[1]]);
    match kind & 3 {
        0 => last.iter_mut().zip(difference).for_each(|(last, d)| *last = last.wrapping_add(signed(u32::from(d)) as u8)),
        1 => {
            for (last, d) in last.chunks_exact_mut(2).zip(difference.chunks_exact(2)) {
                let next = pair(last).wrapping_add(signed(u32::from(pair(d))) as u16);
                last.copy_from_slice(&next.to_le_bytes());
            }
        }
        2 => {
            let turned = u32::from_le_bytes(difference).rotate_right(u32::from(kind >> 4));
            last.iter_mut().zip(turned.to_le_bytes()).for_each(|(last, d)| *last ^= d);
        }
        _ => return Err(format!("has attributes of the unknown kind {kind:#x}; export the file again")),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(hexadecimal: &str) -> Vec<u8> {
        let digit = |c: u8| char::from(c).to_digit(16).unwrap() as u8;
        hexadecimal.as_bytes().chunks_exact(2).map(|pair| digit(pair[0]) << 4 | digit(pair[1])).collect()
    }

    /// By meshoptimizer 1.3's encoder, version 1 at level 3: floats as exclusive ors, differences of 16 bits, and differences of bytes.
    #[test]
    fn all_kinds_of_version_1_are_unpacked() {
        let alternating = "a1390515555555550000000010301070103010f010301070103010f0081808040100ff0000000000000000000000000000000000\
            00000000803f12";
        let powers = "a14a012084ffffff0515755d5703030355000000000000000000000000000000000000000000000000803f01";
        let scattered = "a15a004a52ffffffffffff0200ff0206383363383363830f0003060303000000000000000000000000000000000000000000003d00";
        let expected: [&dyn Fn(i32) -> f32; 3] =
            [&|i| if i % 2 == 0 { 1.0 + i as f32 / 16.0 } else { -1.0 - i as f32 / 16.0 }, &|i| 2f32.powi(i % 5), &|i| {
                2f32.powi(i * 7 % 11 - 5)
            }];
        for (packed, expected) in [alternating, powers, scattered].into_iter().zip(expected) {
            let packed = bytes(packed);
            let floats: Vec<f32> = unpack(&packed, 20, 4).unwrap().as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
            assert_eq!(floats, (0..20).map(expected).collect::<Vec<f32>>());
            for end in 0..packed.len() {
                assert!(unpack(&packed[..end], 20, 4).is_err(), "{end}");
            }
            assert!(unpack(&packed, 4, 4).unwrap_err().contains("bytes behind its packed data"));
        }
    }
}
