//! The result of carving: the octree with the box around its free voxels, and a report of how it came out.

use crate::ExploreError;
use enfilade_geometry::{OccupancyTree, Voxel};
use enfilade_math::DVec3;
use serde::{Deserialize, Serialize};

/// The free space in which a camera can be: the result of carving.
#[derive(Clone, Debug)]
pub struct FreeSpace {
    /// Free, occupied and unknown voxels.
    pub tree: OccupancyTree,
    /// Lower corner of the box around all free voxels, metres.
    pub free_min: DVec3,
    /// Upper corner of the box around all free voxels, metres.
    pub free_max: DVec3,
    /// Measurements of carving.
    pub report: CarveReport,
}

impl FreeSpace {
    /// The free space of a tree that was carved earlier.
    ///
    /// # Errors
    /// [`ExploreError::NoFreeSpace`] when no voxel is free.
    pub fn new(tree: OccupancyTree, report: CarveReport) -> Result<Self, ExploreError> {
        match tree.bounds(Voxel::Free) {
            Some((free_min, free_max)) => Ok(Self { tree, free_min, free_max, report }),
            None => Err(ExploreError::NoFreeSpace("the octree holds no free voxel; carve the scene again".into())),
        }
    }
}

/// Measurements of carving.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CarveReport {
    /// Free voxels.
    pub free_voxels: u64,
    /// Volume of the free voxels, cubic metres.
    pub free_volume_m3: f64,
    /// Voxels that a surface touches.
    pub occupied_voxels: u64,
    /// Share of the domain that is neither.
    pub unknown_share: f64,
    /// Positions from which rays were cast, in order.
    pub positions: Vec<DVec3>,
    /// Share of all rays that left the domain without meeting an occupied voxel: 0 in a closed room; more where a window has no
    /// pane, a wall or ceiling is missing, or a camera is outside.
    pub escaped_share: f64,
    /// Voxels that rays reached and that are outside the building; unknown in the tree, unless they were to be kept.
    pub outside_voxels: u64,
    /// Places where free space leads out of the building, the largest first.
    pub leaks: Vec<Leak>,
    /// True where leaks were looked for, or no ray left the domain, so that there can be none. A preset that keeps what is outside does not
    /// look, and in an open place there is no outside.
    #[serde(default)]
    pub sought_leaks: bool,
    /// Result for each start camera, in their order.
    pub starts: Vec<StartReport>,
}

/// The result for one start camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StartReport {
    /// The position asked for.
    pub asked: DVec3,
    /// The position carved from: another one when the one asked for is in an occupied voxel, `None` when the camera was skipped.
    pub used: Option<DVec3>,
    /// Why it was skipped.
    pub problem: Option<String>,
    /// True where hardly a direction around it meets a surface.
    #[serde(default)]
    pub is_open: bool,
}

/// A place where free space leads out of the building.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Leak {
    /// Middle of the leak, metres.
    pub position: DVec3,
    /// The area of the faces between voxels inside and outside, square metres.
    pub area_m2: f64,
}
