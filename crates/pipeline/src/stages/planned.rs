//! What planning makes.

use enfilade_dataset::StereoRecord;
use enfilade_explore::PlanReport;
use enfilade_scene::{Camera, Trajectory};

/// The trajectories of a scene, what they are filmed with, and a report of each that was planned.
pub(super) struct Made {
    pub camera: Camera,
    pub filmed: Vec<(Trajectory, Option<StereoRecord>)>,
    pub reports: Vec<PlanReport>,
    /// One line.
    pub summary: String,
}
