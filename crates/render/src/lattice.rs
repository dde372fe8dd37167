//! Which pixels share light: those of one lattice within a square of the image.
//!
//! A lattice takes every second pixel along one axis and every fourth along the other. Neighbours are in different lattices, so their
//! noise is independent: denoisers mistake noise that neighbours have in common for a feature of the picture.

/// Distances in pixels between the members of a lattice, along its two axes.
const STRIDES: [u32; 2] = [2, 4];
/// Side in pixels of the squares that lattices are confined to, counted from the image's upper left.
pub(crate) const SQUARE: u32 = 8;

/// True when two pixels, given as (x, y), share light when `reuse` is on; a pixel always shares its own.
#[inline]
pub(crate) fn may_share_light(a: [usize; 2], b: [usize; 2], reuse: bool) -> bool {
    let (square, stride) = (SQUARE as usize, STRIDES[0] as usize);
    a == b || reuse && (0..2).all(|axis| a[axis] / square == b[axis] / square && a[axis] % stride == b[axis] % stride)
}

/// The key of the lattice that a pixel belongs to in sample number `index`: pixels of equal keys are sampled together. The lattice is
/// turned by a quarter from one sample to the next, so that a pixel shares light with different pixels.
#[inline]
pub(crate) fn lattice((x, y): (u32, u32), index: u32) -> [u32; 4] {
    let [width, height] = if index.is_multiple_of(2) { STRIDES } else { [STRIDES[1], STRIDES[0]] };
    [y / SQUARE, x / SQUARE, y % height, x % width]
}
