//! Cutting an array into chunks, and the filters on them: byte shuffle, then deflate in zlib's framing.

/// Effort of libdeflate on meshes.
pub(super) const MESH_LEVEL: i32 = 6;

/// h5py's automatic chunk shape: halve the axes in turn until a chunk is near a target size that grows slowly with the array.
/// No axis of the chunk is longer than the array's. `shape` has no zero.
pub(super) fn auto_chunk(shape: &[usize], element_size: usize) -> Vec<usize> {
    const BASE: f64 = 16.0 * 1024.0;
    const MIN: f64 = 8.0 * 1024.0;
    const MAX: f64 = 1024.0 * 1024.0;
    let bytes = |shape: &[usize]| shape.iter().map(|&n| n as f64).product::<f64>() * element_size as f64;
    let target = (BASE * (bytes(shape) / MAX).log10().exp2()).clamp(MIN, MAX);
    let mut chunk = shape.to_vec();
    for axis in (0..shape.len()).cycle() {
        let size = bytes(&chunk);
        let near = size < target || (size - target).abs() / target < 0.5;
        if (near && size < MAX) || chunk.iter().all(|&n| n == 1) {
            break;
        }
        chunk[axis] = chunk[axis].div_ceil(2);
    }
    chunk
}

/// An array seen as three axes: shorter shapes get leading ones.
pub(super) fn three_axes(shape: &[usize]) -> [usize; 3] {
    let mut axes = [1; 3];
    axes[3 - shape.len()..].copy_from_slice(shape);
    axes
}

/// Number of chunks along each axis.
pub(super) fn grid(shape: [usize; 3], chunk: [usize; 3]) -> [usize; 3] {
    std::array::from_fn(|axis| shape[axis].div_ceil(chunk[axis]))
}

/// The part of a chunk inside the array: its first element, and its extent.
fn overlap(shape: [usize; 3], chunk: [usize; 3], at: [usize; 3]) -> ([usize; 3], [usize; 3]) {
    let first = std::array::from_fn(|axis| at[axis] * chunk[axis]);
    (first, std::array::from_fn(|axis| chunk[axis].min(shape[axis] - first[axis])))
}

/// Copies elements of `B` bytes between an array and one chunk of it. `copy` gets the offset in the array, the offset in the
/// chunk, and the number of elements of each run.
fn for_each_run(shape: [usize; 3], chunk: [usize; 3], at: [usize; 3], mut copy: impl FnMut(usize, usize, usize)) {
    let (first, extent) = overlap(shape, chunk, at);
    for y in 0..extent[0] {
        for x in 0..extent[1] {
            let from = ((first[0] + y) * shape[1] + first[1] + x) * shape[2] + first[2];
            copy(from, (y * chunk[1] + x) * chunk[2], extent[2]);
        }
    }
}

/// The bytes of one chunk, zero where it hangs over the end of the array.
pub(super) fn gather(bytes: &[u8], element_size: usize, shape: [usize; 3], chunk: [usize; 3], at: [usize; 3]) -> Vec<u8> {
    fn sized<const B: usize>(bytes: &[u8], shape: [usize; 3], chunk: [usize; 3], at: [usize; 3]) -> Vec<u8> {
        let source: &[[u8; B]] = bytemuck::cast_slice(bytes);
        let mut out = vec![0u8; chunk.iter().product::<usize>() * B];
        let target: &mut [[u8; B]] = bytemuck::cast_slice_mut(&mut out);
        for_each_run(shape, chunk, at, |from, to, n| {
            if n == 1 {
                target[to] = source[from];
            } else {
                target[to..to + n].copy_from_slice(&source[from..from + n]);
            }
        });
        out
    }
    match element_size {
        1 => sized::<1>(bytes, shape, chunk, at),
        2 => sized::<2>(bytes, shape, chunk, at),
        4 => sized::<4>(bytes, shape, chunk, at),
        _ => sized::<8>(bytes, shape, chunk, at),
    }
}

/// HDF5's shuffle filter: first byte of every element, then second byte of every element, and so on.
pub(super) fn shuffle(raw: &[u8], element_size: usize) -> Vec<u8> {
    fn sized<const B: usize>(raw: &[u8]) -> Vec<u8> {
        let elements: &[[u8; B]] = bytemuck::cast_slice(raw);
        let mut out = vec![0u8; raw.len()];
        for (byte, plane) in out.chunks_exact_mut(elements.len()).enumerate() {
            plane.iter_mut().zip(elements).for_each(|(out, element)| *out = element[byte]);
        }
        out
    }
    match element_size {
        1 => raw.to_vec(),
        2 => sized::<2>(raw),
        4 => sized::<4>(raw),
        _ => sized::<8>(raw),
    }
}

/// HDF5's shuffle undone: first bytes of all elements, then second bytes, and so on.
pub(super) fn unshuffle_into<const B: usize>(shuffled: &[u8], raw: &mut [u8]) {
    let elements: &mut [[u8; B]] = bytemuck::cast_slice_mut(raw);
    let count = elements.len();
    let planes: [&[u8]; B] = std::array::from_fn(|byte| &shuffled[byte * count..(byte + 1) * count]);
    for (i, element) in elements.iter_mut().enumerate() {
        *element = std::array::from_fn(|byte| planes[byte][i]);
    }
}

/// [`unshuffle_into`] for elements of `element_size` bytes.
pub(super) fn unshuffle(shuffled: &[u8], element_size: usize, raw: &mut [u8]) {
    match element_size {
        1 => raw.copy_from_slice(shuffled),
        2 => unshuffle_into::<2>(shuffled, raw),
        4 => unshuffle_into::<4>(shuffled, raw),
        _ => unshuffle_into::<8>(shuffled, raw),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunk_shapes_are_h5pys() {
        assert_eq!(auto_chunk(&[768, 1024], 2), [96, 128]);
        assert_eq!(auto_chunk(&[768, 1024, 3], 2), [96, 128, 1]);
        assert_eq!(auto_chunk(&[768, 1024, 3], 4), [48, 128, 1]);
        assert_eq!(auto_chunk(&[1, 1], 8), [1, 1]);
        assert_eq!(auto_chunk(&[7, 5, 3], 2), [7, 5, 3]);
        assert_eq!(auto_chunk(&[97, 131], 4), [25, 66]);
    }
}
