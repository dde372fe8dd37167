//! A grid of surface cells: a voxel and the axis that the surface faces, found by hashing.

use enfilade_math::{Vec3, hash_u64};
use std::collections::HashMap;

/// A place on a surface that a walk has visited.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Site {
    /// World position.
    pub p: Vec3,
    /// Unit normal on the side that light was scattered on.
    pub n: Vec3,
}

/// Sites kept per cell.
pub(super) const SITES: usize = 4;

/// No cell.
pub(super) const NONE: u32 = u32::MAX;

/// Increment of a key by one voxel along each axis. The lowest three bits are the axis that the surface faces.
const STEP_X: i64 = 1 << 43;
const STEP_Y: i64 = 1 << 23;
const STEP_Z: i64 = 1 << 3;

/// Cells, numbered in the order in which they were found.
#[derive(Debug)]
pub(super) struct Cells {
    origin: Vec3,
    /// Cells per metre.
    scale: f32,
    /// Open addressing: the tag of a key and the cell's number; [`NONE`] is empty. A power of two long, at most half full.
    ///
    /// Small, because it is asked at every vertex and should stay in the processor's cache. Of two cells whose tags are the same by chance
    /// one may not be found, which does no harm.
    slots: Vec<(u32, u32)>,
    /// Key of each cell.
    keys: Vec<u64>,
    /// Places in each cell, up to [`SITES`].
    pub sites: Vec<[Option<Site>; SITES]>,
}

impl Cells {
    /// The cells of `size` metres that contain the sites.
    pub fn new(origin: Vec3, size: f32, sites: &[Site]) -> Self {
        let mut cells = Self { origin, scale: 1.0 / size, slots: Vec::new(), keys: Vec::new(), sites: Vec::new() };
        let mut numbers = HashMap::new();
        for site in sites {
            let key = cells.key(site.p, site.n);
            let number = *numbers.entry(key).or_insert_with(|| {
                cells.keys.push(key);
                cells.sites.push([None; SITES]);
                cells.sites.len() - 1
            });
            if let Some(free) = cells.sites[number].iter_mut().find(|s| s.is_none()) {
                *free = Some(*site);
            }
        }
        cells.slots = vec![(0, NONE); (2 * cells.keys.len()).next_power_of_two().max(64)];
        for (number, &key) in cells.keys.iter().enumerate() {
            let slot = (0..cells.slots.len())
                .map(|i| (hash_u64(key) as usize + i) & (cells.slots.len() - 1))
                .find(|&slot| cells.slots[slot].1 == NONE);
            if let Some(slot) = slot {
                cells.slots[slot] = (tag(hash_u64(key)), number as u32);
            }
        }
        cells
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.sites.len()
    }

    /// The number of the cell of a surface point; [`NONE`] where no walk has been.
    #[inline]
    pub fn find(&self, p: Vec3, n: Vec3) -> u32 {
        self.number(self.key(p, n))
    }

    /// The cells that touch a cell on its surface and face the same way, itself among them.
    pub fn around(&self, cell: usize) -> impl Iterator<Item = usize> {
        let packed = (self.keys[cell] - 1) as i64;
        let steps: [i64; 2] = match (packed & 7) / 2 {
            0 => [STEP_Y, STEP_Z],
            1 => [STEP_X, STEP_Z],
            _ => [STEP_X, STEP_Y],
        };
        let keys = (-1..=1).flat_map(move |a| (-1..=1).map(move |b| (packed + a * steps[0] + b * steps[1]) as u64 + 1));
        keys.map(|key| self.number(key)).filter(|&number| number != NONE).map(|number| number as usize)
    }

    /// The number of the cell of a key, or [`NONE`].
    #[inline]
    fn number(&self, key: u64) -> u32 {
        let (hash, mask) = (hash_u64(key), self.slots.len() - 1);
        let (mut slot, tag) = (hash as usize & mask, tag(hash));
        loop {
            let (found, number) = self.slots[slot];
            if found == tag || number == NONE {
                return number;
            }
            slot = (slot + 1) & mask;
        }
    }

    /// Voxel and facing axis as a number that is never zero.
    #[inline]
    fn key(&self, p: Vec3, n: Vec3) -> u64 {
        let at = (p - self.origin) * self.scale;
        let coordinate = |v: f32| (v.floor().clamp(-500_000.0, 500_000.0) as i64 + 524_288) as u64;
        let a = n.abs();
        let (axis, along) = if a.x >= a.y && a.x >= a.z {
            (0, n.x)
        } else if a.y >= a.z {
            (1, n.y)
        } else {
            (2, n.z)
        };
        let facing = 2 * axis + u64::from(along < 0.0);
        coordinate(at.x) * STEP_X as u64 + coordinate(at.y) * STEP_Y as u64 + coordinate(at.z) * STEP_Z as u64 + facing + 1
    }
}

/// Tag that distinguishes keys in [`Cells::slots`]: bits of the hash that do not determine the slot.
#[inline]
fn tag(hash: u64) -> u32 {
    (hash >> 32) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_around_a_cell_lie_on_its_surface_and_face_its_way() {
        let site = |x: f32, y: f32, z: f32, n: Vec3| Site { p: Vec3::new(x, y, z), n };
        let floor: Vec<Site> = (0..25).map(|i| site((i % 5) as f32 + 0.5, (i / 5) as f32 + 0.5, 0.1, Vec3::Z)).collect();
        let others = [site(2.5, 2.5, 0.1, -Vec3::Z), site(2.5, 2.5, 1.1, Vec3::Z), site(2.5, 2.5, 0.1, Vec3::X)];
        let cells = Cells::new(Vec3::ZERO, 1.0, &[&floor[..], &others].concat());
        let near = |x: f32, y: f32| cells.around(cells.find(Vec3::new(x, y, 0.1), Vec3::Z) as usize).collect::<Vec<_>>();
        assert_eq!(near(2.5, 2.5), [6, 11, 16, 7, 12, 17, 8, 13, 18]);
        assert_eq!(near(0.5, 0.5), [0, 5, 1, 6], "at a corner");
    }
}
