//! Addresses of voxels: OctoMap's keys, three times 16 bits, with the origin of the world in the middle of their range.

use enfilade_math::DVec3;

/// Levels of the tree below its root: a voxel key has this many bits per axis.
pub const TREE_LEVELS: u32 = 16;

/// The key of the voxel whose lower corner is the origin of the world.
const CENTER: i64 = 1 << (TREE_LEVELS - 1);

/// The address of a voxel in OctoMap's key space: per axis floor(coordinate / resolution) + 32768.
///
/// ```
/// use enfilade_geometry::VoxelKey;
/// use enfilade_math::DVec3;
///
/// let key = VoxelKey::at(DVec3::new(-0.01, 0.25, 0.0), 0.1).unwrap();
/// assert_eq!(key, VoxelKey([32767, 32770, 32768]));
/// assert!((key.center(0.1) - DVec3::new(-0.05, 0.25, 0.05)).length() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct VoxelKey(pub [u16; 3]);

impl VoxelKey {
    /// The voxel that holds `p`. `None` when it is beyond the 65,536 voxels per axis of the key space, or NaN.
    #[inline]
    pub fn at(p: DVec3, resolution_m: f64) -> Option<Self> {
        let cells = (p / resolution_m).floor();
        let (low, high) = (DVec3::splat(-CENTER as f64), DVec3::splat(CENTER as f64));
        (cells.cmpge(low).all() && cells.cmplt(high).all()).then(|| Self(cells.to_array().map(|c| (c as i64 + CENTER) as u16)))
    }

    /// The lower corner of the voxel.
    #[inline]
    pub fn corner(self, resolution_m: f64) -> DVec3 {
        DVec3::from(self.0.map(|k| (i64::from(k) - CENTER) as f64)) * resolution_m
    }

    /// The middle of the voxel.
    #[inline]
    pub fn center(self, resolution_m: f64) -> DVec3 {
        DVec3::from(self.0.map(|k| (i64::from(k) - CENTER) as f64 + 0.5)) * resolution_m
    }

    /// The child of a node `level` levels above the voxels that leads to this key: x, y and z contribute bits 0, 1 and 2.
    #[inline]
    pub(super) fn octant(self, level: u32) -> usize {
        let [x, y, z] = self.0.map(|k| usize::from((k >> (level - 1)) & 1));
        x | (y << 1) | (z << 2)
    }

    /// The lower corner of child `octant` of the node with this lower corner, `level` levels above the voxels.
    #[inline]
    pub(super) fn child(self, octant: usize, level: u32) -> Self {
        let [x, y, z] = self.0;
        let bit = |axis: usize| (((octant >> axis) & 1) as u16) << (level - 1);
        Self([x | bit(0), y | bit(1), z | bit(2)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_count_voxels_from_the_origin() {
        assert_eq!(VoxelKey::at(DVec3::ZERO, 0.1), Some(VoxelKey([32768; 3])));
        assert_eq!(VoxelKey::at(DVec3::new(-0.01, 0.25, -0.1001), 0.1), Some(VoxelKey([32767, 32770, 32766])));
        assert_eq!(VoxelKey::at(DVec3::new(3276.79, 0.0, -3276.8), 0.1), Some(VoxelKey([65535, 32768, 0])));
        for outside in [DVec3::X * 3276.9, DVec3::Z * -3276.9, DVec3::NAN] {
            assert_eq!(VoxelKey::at(outside, 0.1), None);
        }
    }

    #[test]
    fn the_center_of_a_voxel_lies_in_it() {
        for key in [[0, 40000, 65535], [32768, 32767, 1]].map(VoxelKey) {
            assert_eq!(VoxelKey::at(key.center(0.07), 0.07), Some(key));
            assert!((key.center(0.07) - key.corner(0.07) - DVec3::splat(0.035)).length() < 1e-9);
        }
    }
}
