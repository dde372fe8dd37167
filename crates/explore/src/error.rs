//! Errors of exploration. Each message includes the place, what was found, and which setting to change.

use enfilade_math::DVec3;

/// Why free space or a trajectory could not be found: where, what was found, and what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExploreError {
    /// A configured value out of its domain.
    #[error("{field} = {found}: expected {expected}")]
    Config {
        /// Name of the field.
        field: &'static str,
        /// Value of the setting, as it was found.
        found: String,
        /// The allowed values.
        expected: &'static str,
    },
    /// No start positions.
    #[error("there is no start camera to carve free space from; add a camera to the scene or state one in the scene's settings")]
    NoStarts,
    /// A start position that is not a place.
    #[error("start camera {index} is at {position}, which is not finite; correct its position")]
    StartNotFinite {
        /// Index into the starts.
        index: usize,
        /// The position.
        position: DVec3,
    },
    /// The start cameras are further apart than the cube to be carved.
    #[error(
        "the start cameras are up to {spread_m:.2} m apart along an axis, but the cube to be carved is {extent_m} m wide; raise extent_m \
         above {spread_m:.2} or carve from fewer cameras"
    )]
    ExtentTooSmall {
        /// Largest distance along one axis.
        spread_m: f64,
        /// The configured side.
        extent_m: f64,
    },
    /// The cube leaves the key space of the octree.
    #[error(
        "the cube to be carved reaches from {min} to {max}, beyond the octree's 32768 voxels of {voxel_m} m on each side of the origin; \
         move the scene to the origin or raise voxel_m"
    )]
    OutOfKeySpace {
        /// Lower corner, metres.
        min: DVec3,
        /// Upper corner, metres.
        max: DVec3,
        /// Edge of a voxel.
        voxel_m: f64,
    },
    /// The grid, or the octree made of it, would not fit in memory.
    #[error("carving needs {voxels} voxels of {voxel_m} m ({mib} MiB or more, the limit is {limit_mib}); raise voxel_m or lower extent_m")]
    TooManyVoxels {
        /// Voxels in the domain.
        voxels: u64,
        /// Edge of a voxel.
        voxel_m: f64,
        /// Memory needed.
        mib: u64,
        /// Memory allowed.
        limit_mib: u64,
    },
    /// A start position inside a wall or another solid thing.
    #[error(
        "start camera {index} at {position} is inside a wall or an object: half of the directions around it end within {median_m:.2} m; \
         move it at least two voxels ({clear_m:.2} m) away from every surface"
    )]
    StartInWall {
        /// Index into the starts.
        index: usize,
        /// The position.
        position: DVec3,
        /// Median distance to the surfaces around.
        median_m: f64,
        /// Two voxels, metres.
        clear_m: f64,
    },
    /// Carving freed nothing, or an octree without free voxels was given.
    #[error("no voxel is free: {0}")]
    NoFreeSpace(String),
    /// No permitted place near a start camera.
    #[error(
        "camera {name:?} at {position} cannot begin a trajectory: no free position within {radius_m} m of it keeps {clearance_m} m from \
         every surface{}; move the camera, {}lower clearance_m, or carve with this camera among the starts",
        at_height(.height_m),
        change_height(.height_m)
    )]
    StartBlocked {
        /// Name of the start camera.
        name: String,
        /// Position of the start camera, metres.
        position: DVec3,
        /// Radius of the search, metres.
        radius_m: f64,
        /// The configured clearance.
        clearance_m: f64,
        /// The minimum and maximum height above the floor, where one is configured.
        height_m: Option<[f64; 2]>,
    },
    /// Nothing to look at from a start camera.
    #[error(
        "camera {name:?} at {position} has nothing to look at: no direction has {distance_m} m of free space before a surface; move the \
         camera or lower min_look_distance_m"
    )]
    NothingToLookAt {
        /// Name of the start camera.
        name: String,
        /// Where the trajectory would begin.
        position: DVec3,
        /// The configured smallest distance.
        distance_m: f64,
    },
    /// No next pose, even with more samples and smaller steps.
    #[error(
        "trajectory {trajectory} is stuck at frame {frame}, position {position}: of {queries} sampled positions {look_from} are free, \
         clear and visible, of {queries} sampled targets {look_at} are free and visible, and no pair of them is a view that shows a \
         surface and, unless a preset says otherwise, sees its target at the distance asked for; lower clearance_m or \
         min_look_distance_m, ask for fewer frames, or move the start camera"
    )]
    Stuck {
        /// Name of the trajectory.
        trajectory: String,
        /// The frame that has no pose.
        frame: u32,
        /// Position of the frame before.
        position: DVec3,
        /// Samples per set in the last attempt.
        queries: u32,
        /// Possible camera positions in the last attempt.
        look_from: usize,
        /// Possible targets in the last attempt.
        look_at: usize,
    },
    /// No place with room to move within reach.
    #[error(
        "trajectory {trajectory} has no place to go to: within a metre of {position} there is no free voxel with {clearance_m} m and a \
         voxel's width to every surface, at the height asked for; move the start camera or lower clearance_m"
    )]
    NoPlaces {
        /// Name of the trajectory.
        trajectory: String,
        /// Where it would begin.
        position: DVec3,
        /// The configured clearance.
        clearance_m: f64,
    },
    /// The mode that looks at objects has none.
    #[error("mode objects has nothing to look at: place objects with [[object]], or name some of the scene: look_at = [\"sofa\"]")]
    NoObjects,
    /// An object to look at has no surface.
    #[error("object {name:?} has no triangles to look at; leave it out of look_at, or mend its model")]
    EmptyObject {
        /// Name of the object.
        name: String,
    },
    /// No camera around the objects keeps the rules of a pose.
    #[error(
        "trajectory {trajectory} has no view of its objects: of all cameras drawn {nearest_m} to {farthest_m} m from them none is in free space and \
         sees ahead; widen radius_m or elevation_deg, or lower clearance_m"
    )]
    NoViewOfObjects {
        /// Name of the trajectory.
        trajectory: String,
        /// The configured least distance.
        nearest_m: f64,
        /// The configured greatest distance.
        farthest_m: f64,
    },
    /// A path that cannot be made.
    #[error("trajectory {trajectory} has no way at {position}: {problem}")]
    NoWay {
        /// Name of the trajectory.
        trajectory: String,
        /// Where.
        position: DVec3,
        /// What is wrong there and what to do.
        problem: String,
    },
    /// A table of poses that cannot be understood.
    #[error("{file}, pose {row}: found {found}; expected {expected}")]
    Keyframes {
        /// The file.
        file: String,
        /// Number of the pose, from 1.
        row: usize,
        /// The text found there.
        found: String,
        /// The expected text.
        expected: &'static str,
    },
}

/// The condition that a configured height adds, in words.
fn at_height(height_m: &Option<[f64; 2]>) -> String {
    height_m.map_or_else(String::new, |[min, max]| format!(" and is {min} to {max} m above the floor, as camera_height_m asks"))
}

/// The advice for that condition, in words.
fn change_height(height_m: &Option<[f64; 2]>) -> &'static str {
    if height_m.is_some() { "change camera_height_m, " } else { "" }
}

/// Checks a configured number.
pub(crate) fn require(ok: bool, field: &'static str, found: impl ToString, expected: &'static str) -> Result<(), ExploreError> {
    if ok { Ok(()) } else { Err(ExploreError::Config { field, found: found.to_string(), expected }) }
}
