//! Free space by space carving, and camera trajectories by view saliency.
//!
//! The algorithms are those of Hypersim (Roberts et al., "Hypersim: A Photorealistic Synthetic Dataset for Holistic Indoor Scene
//! Understanding", ICCV 2021, and its supplement), with the paper's rules where the published code departs from them:
//!
//! 1. [`find_starts`] looks for places to stand in scenes that come without cameras.
//! 2. [`carve`] marks every voxel that a surface touches as occupied, and every voxel that a ray from the start cameras reaches
//!    before an occupied one as free. The result is an octree.
//! 3. [`plan`] finds poses in the free space by one of several modes ([`Mode`]), [`follow`] those that were made by hand; both say in
//!    a [`PlanReport`] how the trajectory came out. The default mode walks: every step draws poses near the last one and chooses
//!    among them in proportion to how much a small test image of each shows ([`Saliency`]).
//!    [`plan_accepted`] lets the caller have a last word on every view, and [`Surroundings`] tells what is around a point.
//!
//! All results are functions of the inputs and the seed, whatever the number of threads.

mod armadillo;
mod carve;
mod error;
mod find_starts;
mod grid;
mod plan;
mod preset;
mod saliency;
mod space;
mod surroundings;
mod view;
mod view_stats;

pub use carve::{CarveConfig, carve};
pub use error::ExploreError;
pub use find_starts::{StartsConfig, find_starts};
pub use plan::{
    CoverageConfig, CoverageReport, Fault, FrameValues, Keyframe, KeyframesConfig, Mode, PartCoverage, PlanConfig, PlanReport,
    PlanStatistics, Planned, RejectedCounts, RelaxedFrame, Spread, StillsConfig, VideoConfig, WalkConfig, follow, parse_keyframes, plan,
    plan_accepted,
};
pub use preset::Preset;
pub use saliency::Saliency;
pub use space::{CarveReport, FreeSpace, Leak, StartReport};
pub use surroundings::Surroundings;
pub use view::view_stats;
pub use view_stats::ViewStats;

#[cfg(test)]
mod testroom;
