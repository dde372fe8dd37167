//! The verbs that look at finished frames anew: related to each other, or through other sensors.

use super::values::{parse_frame, parse_overlap};
use super::{CamerasArg, FramesArg};
use clap::Args;
use std::path::PathBuf;

/// `pairs`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade pairs out\n  enfilade pairs out --overlap 0.2..0.7 --min-baseline 0.3 --max-angle 90\n\nNothing is rendered. \
    _detail/covisibility.hdf5 of each scene has the shares of all pairs, pairs.csv those that were chosen;\ndocs/many-views.md says what is counted."
)]
pub struct PairsArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// Only the scenes of these names ("bed*", "hall,bedroom")
    #[arg(long, value_name = "PATTERN", visible_alias = "scenes")]
    pub scene: Option<String>,
    /// Only the cameras of these names ("cam_00", "cam_0*")
    #[arg(long, value_name = "PATTERN", visible_alias = "cameras")]
    pub camera: Option<String>,
    /// Only pairs that see such a share of each other: 0.2..0.7, 30%.. or ..0.5 [default: any at all]
    #[arg(long, value_name = "RANGE", value_parser = parse_overlap)]
    pub overlap: Option<[f32; 2]>,
    /// Only pairs whose cameras stand at least so far apart
    #[arg(long, value_name = "M", default_value_t = 0.0)]
    pub min_baseline: f64,
    /// Only pairs whose cameras stand at most so far apart
    #[arg(long, value_name = "M", default_value_t = f64::INFINITY, hide_default_value = true)]
    pub max_baseline: f64,
    /// Only pairs whose viewing axes are at least so far turned from each other
    #[arg(long, value_name = "DEG", default_value_t = 0.0)]
    pub min_angle: f64,
    /// Only pairs whose viewing axes are at most so far turned from each other
    #[arg(long, value_name = "DEG", default_value_t = 180.0)]
    pub max_angle: f64,
    /// About so many pixels of each frame are carried into the others
    #[arg(long, value_name = "N", default_value_t = 3000, value_parser = clap::value_parser!(u32).range(1..))]
    pub pixels: u32,
    /// The list of the pairs that are chosen [default: pairs.csv in the dataset]
    #[arg(short, long, value_name = "CSV")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
}

/// `flow`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade flow out --pairs out/pairs.csv\n  enfilade flow out --step -1\n  enfilade flow out --between cam_00/3 cam_01/7\n\n\
    Nothing is rendered, but the scene must be there, as where the dataset was made. optical_flow, scene_flow and flow_visibility\n\
    go to _detail/CAMERA/pairs/; docs/many-views.md says more."
)]
#[group(id = "which", args = ["pairs", "step", "between"], required = true, multiple = false)]
pub struct FlowArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// The pairs of a list, there and back, as `enfilade pairs` writes it
    #[arg(long, value_name = "CSV")]
    pub pairs: Option<PathBuf>,
    /// From each frame to the one so many later in its trajectory; -1 leads to the one before
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub step: Option<i64>,
    /// From one frame to another: cam_00/3 cam_01/7
    #[arg(long, value_names = ["CAMERA/FRAME", "CAMERA/FRAME"], num_args = 2, value_parser = parse_frame)]
    pub between: Option<Vec<(String, u32)>>,
    /// Only the scenes of these names ("bed*", "hall,bedroom")
    #[arg(long, value_name = "PATTERN", visible_alias = "scenes")]
    pub scene: Option<String>,
    /// Only from frames of the cameras of these names to such ones ("cam_00", "cam_0*")
    #[arg(long, value_name = "PATTERN", visible_alias = "cameras")]
    pub camera: Option<String>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
}

/// `tracks`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade tracks out\n  enfilade tracks out --points 1024 --frames 0..24 --camera cam_00\n\nNothing is rendered, but the \
    scene must be there, as where the dataset was made. tracks.npz beside each camera's\ntrajectory has the keys of TAP-Vid; docs/many-views.md says more."
)]
pub struct TracksArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// So many points per camera, seeded evenly over its frames and over the image
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..))]
    pub points: u32,
    /// Another seed gives other points
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub chosen: FramesArg,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
}

/// `surfaces`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade surfaces out\n  enfilade surfaces out --layers 4 --frames 0..4\n\nNothing is rendered, but the scene must be \
    there, as where the dataset was made. _detail/CAMERA/surfaces of each scene\nhas distance, normal, part, class and side of each surface; \
    docs/surfaces.md says more."
)]
pub struct SurfacesArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// So many surfaces per pixel at most, from near to far
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub layers: u32,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub chosen: FramesArg,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
}

/// `layout`.
#[derive(Args)]
#[command(
    after_help = "Example:\n  enfilade layout out\n\nNothing is rendered. layout.json and layout.svg in _detail of each scene are fitted to its walls, floors, \
    ceilings, doors and windows\nwhere it came without them; _detail/CAMERA/planes has the plane of each pixel. docs/structure.md says more."
)]
pub struct LayoutArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub chosen: FramesArg,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
}

/// `describe`.
#[derive(Args)]
#[command(after_help = "Example:\n  enfilade describe out\n\nNothing is rendered. _detail of each scene then has what its instances are \
    and how they stand to each other; each camera's folder\nin it captions and questions with answers. docs/words.md says more.")]
pub struct DescribeArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// Only the scenes of these names ("bed*", "hall,bedroom")
    #[arg(long, value_name = "PATTERN", visible_alias = "scenes")]
    pub scene: Option<String>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
}

/// `sense`.
#[derive(Args)]
#[command(
    after_help = "Example:\n  enfilade sense out examples/sensors.toml --frames 0..4\n\nNothing is rendered. sensors/NAME/SCENE/CAMERA in the \
    dataset has what each sensor makes of each frame;\ndocs/sensors.md has the kinds of sensors and their keys."
)]
pub struct SenseArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// The sensors
    #[arg(value_name = "SENSORS.toml")]
    pub sensors: PathBuf,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub chosen: FramesArg,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
}

/// `relight`.
#[derive(Args)]
#[command(
    after_help = "Example:\n  enfilade render out --fixtures\n  enfilade relight out examples/mixes.csv --frames 0..4\n\nFrames must have been rendered \
    with --fixtures. relit/MIX/SCENE/CAMERA in the dataset has color,\ndiffuse_illumination, residual and a picture of each frame; docs/relight.md \
    has the table."
)]
pub struct RelightArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// The mixes: a table of mix, fixture, r, g, b
    #[arg(value_name = "MIXES.csv")]
    pub mixes: PathBuf,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub chosen: FramesArg,
}
