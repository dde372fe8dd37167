//! Free space by space carving, and camera trajectories by view saliency.
//!
//! The algorithms are those of Hypersim (Roberts et al., "Hypersim: A Photorealistic Synthetic Dataset for Holistic Indoor Scene
//! Understanding", ICCV 2021, and its supplement), with the paper's rules where the published code departs from them:
//!
//! 1. [`find_starts`] looks for places to stand in scenes that come without cameras.
//! 2. [`carve`] marks every voxel that a surface touches as occupied, and every voxel that a ray from the start cameras reaches
//!    before an occupied one as free. The result is an octree.
//! 3. [`plan`] finds poses in the free space by one of several modes ([`Mode`]), [`follow`] those that were made by hand; both return a
//!    [`PlanReport`] with measurements of the trajectory. The default mode walks: every step draws poses near the last one and chooses
//!    among them in proportion to how much a small test image of each shows ([`Saliency`]). [`plan_accepted`] lets the caller accept or
//!    reject every view, and [`Surroundings`] describes what is around a point.
//!
//! [`findings`] looks for what a scene's maker may not have intended, and [`ceilings`] finds where lamps can hang.
//!
//! All results are functions of the inputs and the seed, whatever the number of threads.
//!
//! A closed room of 2 m by 2 m by 2 m, carved and photographed:
//!
//! ```
//! use enfilade_explore::{CarveConfig, Mode, PlanConfig, StillsConfig, carve, plan};
//! use enfilade_geometry::{Bvh, Mesh};
//! use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
//! use enfilade_scene::{Material, Part, Pose, Quiet, Scene, StartCamera, WorldMesh};
//!
//! // Corner i is at the far end of axis k where bit k of i is set; faces look inward.
//! let corner = |i: u8| 2.0 * Vec3::from([i & 1, i >> 1 & 1, i >> 2 & 1].map(f32::from));
//! let faces = [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]];
//! let scene = Scene {
//!     meshes: vec![Mesh {
//!         positions: (0..8).map(corner).collect(),
//!         triangles: faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
//!         ..Mesh::default()
//!     }
//!     .into()],
//!     materials: vec![Material::diffuse("white", Rgb::WHITE)],
//!     parts: vec![Part { name: "room".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY }],
//!     ..Scene::default()
//! };
//! let world = WorldMesh::new(&scene);
//! let bvh = Bvh::new(&world.corners, &|_| false);
//!
//! // The walls are on borders of voxels and occupy those on both sides, so 18 × 18 × 18 voxels are free.
//! let config = CarveConfig { rays: 4096, iterations: 2, ..CarveConfig::default() };
//! let space = carve(&world, &bvh, &[DVec3::splat(0.95)], &config, &Quiet).unwrap();
//! assert_eq!(space.report.free_voxels, 18 * 18 * 18);
//! assert_eq!(space.report.escaped_share, 0.0);
//!
//! let start = Pose::look_at(0, DVec3::splat(0.95), DVec3::new(0.95, 1.5, 0.95), DVec3::Z).unwrap();
//! let start = StartCamera {
//!     name: "start".into(),
//!     position: start.position,
//!     world_from_camera: start.world_from_camera,
//!     fov_x_rad: 1.0,
//!     aspect: 4.0 / 3.0,
//! };
//! let mode = Mode::Stills(StillsConfig { min_distance_m: 0.4, ..StillsConfig::default() });
//! let config = PlanConfig { mode, frames: 3, candidates: 4, test_width: 16, test_height: 12, ..PlanConfig::default() };
//! let planned = plan(&world, &bvh, &space, &start, 0, &config, &Quiet).unwrap();
//! let positions: Vec<DVec3> = planned.trajectory.poses.iter().map(|pose| pose.position).collect();
//! assert_eq!(positions.len(), 3);
//! assert!(positions[1].distance(positions[2]) >= 0.4);
//! ```

mod armadillo;
mod carve;
mod ceilings;
mod error;
mod find_starts;
mod findings;
mod grid;
mod plan;
mod preset;
mod saliency;
mod space;
mod surroundings;
mod view;
mod view_stats;

pub use carve::{CarveConfig, CarveKeys, carve, is_indoors};
pub use ceilings::{Ceiling, LampPlace, ceilings};
pub use error::ExploreError;
pub use find_starts::{StartsConfig, find_starts};
pub use findings::{Backs, Findings, Overlap, doubled_faces, findings};
pub use plan::{
    CamerasConfig, CoverageConfig, CoverageReport, Fault, FrameValues, Keyframe, KeyframesConfig, Mode, ObjectVisibility, ObjectsConfig,
    PartCoverage, PhotosConfig, PlanConfig, PlanKeys, PlanReport, PlanStatistics, Planned, PlannedStart, RejectedCounts, RelaxedFrame,
    Spread, StillsConfig, TargetObject, VideoConfig, WalkBox, WalkBoxes, WalkConfig, film, follow, parse_keyframes, plan, plan_accepted,
    plan_objects,
};
pub use preset::Preset;
pub use saliency::Saliency;
pub use space::{CarveReport, FreeSpace, Leak, StartReport};
pub use surroundings::Surroundings;
pub use view::view_stats;
pub use view_stats::ViewStats;

#[cfg(test)]
mod testroom;
