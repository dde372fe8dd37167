//! A trajectory and what is known of it: what every page about it is drawn from.

use super::coverage::SurfacePoint;
use super::measure::FrameMeasures;
use super::planned::Planned;
use super::report::Report;
use enfilade_scene::{Camera, Trajectory};

/// A trajectory and what is known of it.
pub(super) struct Subject<'a> {
    pub planned: &'a Planned<'a>,
    pub camera: &'a Camera,
    pub trajectory: &'a Trajectory,
    pub measures: &'a [FrameMeasures],
    /// Points of the surfaces.
    pub points: &'a [SurfacePoint],
    /// The plan's own report, whose values the measures are then.
    pub report: Option<&'a Report>,
}

impl Subject<'_> {
    /// Name of the scores.
    pub fn score_name(&self) -> &'static str {
        match self.report {
            Some(_) => "the plan's",
            None => "Hypersim's: the number of triangles seen times the square of the share of pixels that see a surface",
        }
    }
}
