//! Memory that several threads write to; there is no other.

use super::block::{Block, Shape, Tensor};
use super::simd::Simd;
use std::marker::PhantomData;

/// The pixels of a tensor, written by several threads.
pub(super) struct Pixels<'a> {
    start: *mut Block,
    /// Blocks from `start` on.
    len: usize,
    shape: Shape,
    top: usize,
    tensor: PhantomData<&'a mut Tensor>,
}

// SAFETY: all that threads do through it is to write pixels, each its own, as `set` asks of them.
unsafe impl Sync for Pixels<'_> {}

impl<'a> Pixels<'a> {
    pub fn new(tensor: &'a mut Tensor) -> Self {
        let (len, shape, top) = (tensor.data.len(), tensor.shape, tensor.top);
        Self { start: tensor.data.as_mut_ptr(), len, shape, top, tensor: PhantomData }
    }

    /// Stores a pixel of a block of channels.
    ///
    /// # Safety
    /// No other thread reads or writes the pixel meanwhile.
    #[inline(always)]
    pub unsafe fn set<S: Simd>(&self, s: S, block: usize, x: usize, y: usize, value: S::Lanes) {
        let index = self.shape.bordered(block, x + 1, y + 1 - self.top);
        assert!(index < self.len);
        // SAFETY: `index` is within the tensor, which is borrowed for as long as `self`, and only this thread writes the pixel.
        s.store(value, unsafe { &mut *self.start.add(index) });
    }
}
