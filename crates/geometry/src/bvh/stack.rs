//! The stack of a traversal: children that wait to be visited, each with the parameter at which the ray enters it.

use super::node::WIDTH;
use super::placed::MAX_LEVELS;
use std::mem::MaybeUninit;

/// Room for the waiting children of every level, for the mark where a placement is left, and for a whole vector beyond the last.
const ROOM: usize = (WIDTH - 1) * MAX_LEVELS + 2 + WIDTH;

/// Children and the parameters at which the ray enters them; the next to be visited is the last.
///
/// The traversal keeps at most `WIDTH - 1` entries per level of a tree of at most `MAX_LEVELS` levels, and one mark, so that there is
/// always room for `WIDTH` more. Whoever writes to the arrays relies on that.
pub(super) struct Stack<'r> {
    pub children: &'r mut [MaybeUninit<u32>; ROOM],
    pub enter_at: &'r mut [MaybeUninit<f32>; ROOM],
    /// Below it, everything has been written.
    pub len: usize,
}

/// Memory of a [`Stack`], apart from its length, which so stays in a register.
pub(super) struct Room {
    children: [MaybeUninit<u32>; ROOM],
    enter_at: [MaybeUninit<f32>; ROOM],
}

impl Room {
    #[inline(always)]
    pub fn new() -> Self {
        Self { children: [const { MaybeUninit::uninit() }; ROOM], enter_at: [const { MaybeUninit::uninit() }; ROOM] }
    }
}

impl<'r> Stack<'r> {
    #[inline(always)]
    pub fn new(room: &'r mut Room) -> Self {
        Self { children: &mut room.children, enter_at: &mut room.enter_at, len: 0 }
    }

    #[inline(always)]
    pub fn push(&mut self, child: u32, enter_at: f32) {
        debug_assert!(self.len + WIDTH < ROOM);
        // SAFETY: there is room.
        unsafe {
            self.children.get_unchecked_mut(self.len).write(child);
            self.enter_at.get_unchecked_mut(self.len).write(enter_at);
        }
        self.len += 1;
    }

    /// Puts an entry in its place among those from `base` on, which are sorted with the nearest last.
    #[inline(always)]
    pub fn insert(&mut self, base: usize, child: u32, enter_at: f32) {
        debug_assert!(self.len + WIDTH < ROOM);
        let mut at = self.len;
        // SAFETY: `at` is at most `len`, where there is room and below which everything has been written.
        unsafe {
            while at > base {
                let below = self.enter_at.get_unchecked(at - 1).assume_init();
                if below >= enter_at {
                    break;
                }
                self.enter_at.get_unchecked_mut(at).write(below);
                let child_below = *self.children.get_unchecked(at - 1);
                *self.children.get_unchecked_mut(at) = child_below;
                at -= 1;
            }
            self.enter_at.get_unchecked_mut(at).write(enter_at);
            self.children.get_unchecked_mut(at).write(child);
        }
        self.len += 1;
    }

    /// The child to be visited next, left in its place.
    #[inline(always)]
    pub fn last(&self) -> Option<u32> {
        let last = self.len.checked_sub(1)?;
        // SAFETY: below `len`, everything has been written.
        Some(unsafe { self.children.get_unchecked(last).assume_init() })
    }

    #[inline(always)]
    pub fn pop(&mut self) -> Option<u32> {
        let last = self.last()?;
        self.len -= 1;
        Some(last)
    }

    /// The child to be visited next among those that are entered at no more than `limit`. For users of `insert` and `push_by_distance`.
    #[inline(always)]
    pub fn pop_up_to(&mut self, limit: f32) -> Option<u32> {
        while let Some(child) = self.pop() {
            // SAFETY: it was below `len` just now, where everything has been written.
            if unsafe { self.enter_at.get_unchecked(self.len).assume_init() } <= limit {
                return Some(child);
            }
        }
        None
    }

    /// Drops what the ray enters beyond `limit`.
    #[inline(always)]
    pub fn retain_up_to(&mut self, limit: f32) {
        let mut kept = 0;
        for at in 0..self.len {
            // SAFETY: `kept` and `at` are below `len`, where everything has been written.
            unsafe {
                let (child, enter_at) = (*self.children.get_unchecked(at), *self.enter_at.get_unchecked(at));
                if enter_at.assume_init() <= limit {
                    *self.children.get_unchecked_mut(kept) = child;
                    *self.enter_at.get_unchecked_mut(kept) = enter_at;
                    kept += 1;
                }
            }
        }
        self.len = kept;
    }
}
