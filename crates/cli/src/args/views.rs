//! The verbs that relate frames of a scene to each other.

use super::CamerasArg;
use super::values::parse_overlap;
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
