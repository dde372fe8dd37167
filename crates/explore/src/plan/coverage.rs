//! Coverage: every surface seen a number of times from different angles.

use enfilade_scene::PartId;
use serde::{Deserialize, Serialize};

/// How much of the surfaces was seen how often. Areas are measured by points spread evenly over all surfaces, so they do not depend
/// on how things are cut into triangles.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CoverageReport {
    /// Views wanted of every surface.
    pub views: u32,
    /// Area of all surfaces, square metres.
    pub area_m2: f64,
    /// Share of the area that was seen exactly 0, 1, … times from different angles; the last one is `views` times or more.
    pub seen_share: Vec<f64>,
    /// Share of the area that some pose of those considered sees; the rest is inside of things, hidden or out of reach.
    pub reachable_share: f64,
    /// Parts of which nothing was seen, in order.
    pub never_seen: Vec<PartId>,
    /// Every part that has area, in order.
    pub parts: Vec<PartCoverage>,
}

/// How much of one part was seen how often.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PartCoverage {
    /// The part; its `node_id` in `metadata_nodes.csv` is one more.
    pub part: PartId,
    /// Its area, square metres.
    pub area_m2: f64,
    /// As [`CoverageReport::seen_share`].
    pub seen_share: Vec<f64>,
}
