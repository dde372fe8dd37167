//! Report of a trajectory: values per frame for pictures and later tools, and their statistics.

use crate::Preset;
use enfilade_math::{DMat3, DVec3};
use enfilade_scene::{PartId, Trajectory};
use serde::{Deserialize, Serialize};

/// A trajectory and its report.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// Poses numbered from 0 without a gap.
    pub trajectory: Trajectory,
    /// Measurements of the trajectory.
    pub report: PlanReport,
}

/// Measurements of a trajectory, in metres and degrees.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlanReport {
    /// Name of the trajectory: `cam_00`, `cam_01`, …
    pub trajectory: String,
    /// Name of the mode that made it: `walk`, `video`, `stills`, `coverage`, `objects` or `keyframes`.
    pub mode: String,
    /// Preset whose rules it follows.
    #[serde(default)]
    pub preset: Preset,
    /// The greatest roll that the plan gives a camera, degrees; none where it has no limit: by Hypersim's preset, and for poses made by
    /// hand. The start camera keeps its own.
    pub roll_limit_deg: Option<f64>,
    /// The boxes that a walk keeps to; none for other modes.
    #[serde(default)]
    pub walk: Option<WalkBoxes>,
    /// The camera that it begins with; none for poses made by hand.
    #[serde(default)]
    pub start: Option<PlannedStart>,
    /// Share of the area of all surfaces of the scene that some frame sees.
    pub seen_area_share: f64,
    /// Share of the parts of the scene of which some frame sees something.
    pub seen_part_share: f64,
    /// Statistics over the frames.
    pub statistics: PlanStatistics,
    /// Candidates that were not taken, by reason.
    pub rejected: RejectedCounts,
    /// Frames that break a rule because nothing better was found, or because they were given.
    pub relaxed: Vec<RelaxedFrame>,
    /// Frames of which a single plane fills more than nine tenths: reported, not rejected.
    pub bare_frames: Vec<u32>,
    /// The coverage reached, if the mode plans for coverage.
    pub coverage: Option<CoverageReport>,
    /// The objects that the frames look at, if the mode is `objects`, and how often each is visible.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub objects: Vec<ObjectVisibility>,
    /// Values of every frame.
    pub per_frame: FrameValues,
}

/// The camera that a trajectory begins with, and whether frame 0 keeps it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlannedStart {
    /// Name of the start camera.
    pub name: String,
    /// Position of the start camera, metres.
    pub position: DVec3,
    /// Orientation of the start camera, camera to world.
    pub world_from_camera: DMat3,
    /// True where frame 0 is this pose, exactly; false where it was moved or turned.
    pub is_kept: bool,
    /// True if the look-at point of frame 0 is on its axis; false if no point there is free and one beside the axis is used.
    pub looks_along_axis: bool,
}

/// The boxes that bound the next pose of a walk: equations 2 and 3 of Hypersim's supplement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WalkBoxes {
    /// The box of the camera's position.
    pub position: WalkBox,
    /// The box of the camera's target.
    pub target: WalkBox,
}

/// A box that bounds the next pose of a walk.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WalkBox {
    /// Greatest distance from the last one along x, y and z, metres.
    pub step_m: [f64; 3],
    /// Greatest height above or below the one of frame 0, metres; none if it goes up and down with the floor.
    pub height_range_m: Option<f64>,
}

/// Values of every frame, in the order of the trajectory; all vectors have one entry per frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameValues {
    /// Frame numbers.
    pub frame: Vec<u32>,
    /// Score of the view by the configured saliency.
    pub score: Vec<f64>,
    /// Share of the pixels that show no surface.
    pub void_share: Vec<f64>,
    /// Share of the pixels that show the back of a surface whose front is what free space sees.
    pub back_face_share: Vec<f64>,
    /// Share of the pixels that show a surface nearer than the configured `min_depth_m`.
    pub near_share: Vec<f64>,
    /// Share of the pixels that the largest plane of a single part fills.
    pub plane_share: Vec<f64>,
    /// Share of the level or of the upward directions around the camera, whichever is greater, in which there is no surface, or only the
    /// back of one.
    pub open_share: Vec<f64>,
    /// Distance from the camera to the nearest surface, metres; none in an empty scene.
    pub clearance_m: Vec<Option<f64>>,
    /// Height of the camera above the floor, metres, see `PlanConfig::camera_height_m`; none above nothing.
    pub height_m: Vec<Option<f64>>,
    /// Angle between the image's x axis and the horizon, degrees.
    pub roll_deg: Vec<f64>,
    /// Angle of the viewing axis above the horizon, degrees.
    pub pitch_deg: Vec<f64>,
    /// Distance from the camera of the frame before, metres; none for the first.
    pub step_m: Vec<Option<f64>>,
    /// Angle turned since the frame before, about whatever axis, degrees; none for the first.
    pub turn_deg: Vec<Option<f64>>,
    /// Share of the surface points in view that the frame before saw too; none for the first, and for views of nothing.
    pub overlap: Vec<Option<f64>>,
}

/// [`FrameValues`] in short.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "FrameValues describes each one")]
pub struct PlanStatistics {
    pub score: Spread,
    pub void_share: Spread,
    pub back_face_share: Spread,
    pub clearance_m: Spread,
    pub height_m: Spread,
    pub roll_deg: Spread,
    pub pitch_deg: Spread,
    pub step_m: Spread,
    pub turn_deg: Spread,
    pub overlap: Spread,
}

/// The minimum, mean and maximum of the values that there are; all zero where there are none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "plain words")]
pub struct Spread {
    pub min: f64,
    pub mean: f64,
    pub max: f64,
}

/// Why a view is not worth taking. The later ones are worse: when nothing better is found, one that fails an earlier one is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Fault {
    /// Too little or too much of it was in the view before: `overlap`.
    Overlap,
    /// The caller of [`crate::plan_accepted`] does not accept it.
    Refused,
    /// Shows no surface in too many pixels: `max_void_share`.
    Void,
    /// Too many pixels show something nearer than `min_depth_m`: `max_near_share`.
    Near,
    /// Too many pixels show the back of surfaces, as from outside a room: `max_back_face_share`.
    BackFaces,
    /// The camera is in the open, as outside a building: `max_open_share`.
    Open,
    /// The camera is in a wall, too near to one, or at another height than asked for.
    Place,
    /// The point looked at is not in free space, hidden or too near.
    Sight,
    /// Roll or pitch beyond their limits.
    Tilt,
}

/// Numbers of candidates that were drawn and had a fault.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "Fault describes each one")]
pub struct RejectedCounts {
    #[serde(default)]
    pub refused: u64,
    pub overlap: u64,
    pub void: u64,
    pub near: u64,
    pub back_faces: u64,
    pub open: u64,
}

/// A frame with a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RelaxedFrame {
    /// Number of the frame.
    pub frame: u32,
    /// The fault of the frame.
    pub fault: Fault,
}

/// Shares of all surfaces by number of views. Areas are measured by points spread evenly over all surfaces, so they do not depend
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

/// Shares of one part by number of views.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PartCoverage {
    /// The part; its `node_id` in `metadata_nodes.csv` is one more.
    pub part: PartId,
    /// Area of the part, square metres.
    pub area_m2: f64,
    /// Share of the part's area that the frames see, as [`CoverageReport::seen_share`].
    pub seen_share: Vec<f64>,
}

/// How often an object is visible: in frames whose test image shows at least a tenth of the pixels that it would have if nothing hid it, and
/// if it were whole in the picture.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ObjectVisibility {
    /// Name of the object.
    pub name: String,
    /// Share of the frames in which it is to be visible.
    pub wanted_share: f64,
    /// Share of the frames in which it is.
    pub visible_share: f64,
}

/// One entry of each of [`FrameValues`].
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameRow {
    pub frame: u32,
    pub score: f64,
    pub void_share: f64,
    pub back_face_share: f64,
    pub near_share: f64,
    pub plane_share: f64,
    pub open_share: f64,
    pub clearance_m: Option<f64>,
    pub height_m: Option<f64>,
    pub roll_deg: f64,
    pub pitch_deg: f64,
    pub step_m: Option<f64>,
    pub turn_deg: Option<f64>,
    pub overlap: Option<f64>,
}

impl FrameValues {
    /// Adds the values of the next frame.
    pub(super) fn push(&mut self, row: FrameRow) {
        self.frame.push(row.frame);
        self.score.push(row.score);
        self.void_share.push(row.void_share);
        self.back_face_share.push(row.back_face_share);
        self.near_share.push(row.near_share);
        self.plane_share.push(row.plane_share);
        self.open_share.push(row.open_share);
        self.clearance_m.push(row.clearance_m);
        self.height_m.push(row.height_m);
        self.roll_deg.push(row.roll_deg);
        self.pitch_deg.push(row.pitch_deg);
        self.step_m.push(row.step_m);
        self.turn_deg.push(row.turn_deg);
        self.overlap.push(row.overlap);
    }
}

impl Spread {
    /// The spread of `values`.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let (mut min, mut max, mut sum, mut n) = (f64::INFINITY, f64::NEG_INFINITY, 0.0, 0u32);
        for v in values {
            (min, max, sum, n) = (min.min(v), max.max(v), sum + v, n + 1);
        }
        if n == 0 { Self::default() } else { Self { min, mean: sum / f64::from(n), max } }
    }
}

impl PlanStatistics {
    /// The statistics of `values`.
    pub fn of(values: &FrameValues) -> Self {
        let all = |values: &[f64]| Spread::of(values.iter().copied());
        let some = |values: &[Option<f64>]| Spread::of(values.iter().flatten().copied());
        Self {
            score: all(&values.score),
            void_share: all(&values.void_share),
            back_face_share: all(&values.back_face_share),
            clearance_m: some(&values.clearance_m),
            height_m: some(&values.height_m),
            roll_deg: all(&values.roll_deg),
            pitch_deg: all(&values.pitch_deg),
            step_m: some(&values.step_m),
            turn_deg: some(&values.turn_deg),
            overlap: some(&values.overlap),
        }
    }
}

impl RejectedCounts {
    /// One more with this fault. Faults of place, sight and tilt are not counted: such points are no candidates.
    pub(super) fn add(&mut self, fault: Fault) {
        match fault {
            Fault::Refused => self.refused += 1,
            Fault::Overlap => self.overlap += 1,
            Fault::Void => self.void += 1,
            Fault::Near => self.near += 1,
            Fault::BackFaces => self.back_faces += 1,
            Fault::Open => self.open += 1,
            Fault::Place | Fault::Sight | Fault::Tilt => {}
        }
    }
}
