//! The verbs that judge, divide and ask a dataset.

use super::CamerasArg;
use super::values::{parse_pixel, parse_shares};
use clap::Args;
use std::path::PathBuf;

/// `verify`.
#[derive(Args)]
#[command(after_help = "Examples:\n  enfilade verify out\n  enfilade verify out --strict\n\n\
    The card is stored beside the data: verify.json has every value, verify.html is for a browser. Gates are what those who train on\n\
    such data ask of a frame (docs/verify.md). It also reads datasets of Hypersim itself.")]
pub struct VerifyArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// Only the scenes of these names ("bed*", "hall,bedroom")
    #[arg(long, value_name = "PATTERN", visible_alias = "scenes")]
    pub scene: Option<String>,
    /// Fail also where a gate rejects a frame
    #[arg(long)]
    pub strict: bool,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
}

/// `partition`.
#[derive(Args)]
#[command(
    after_help = "Example:\n  enfilade partition out --seed 1 --shares 70,15,15\n\nA scene's side depends on its name and the seed alone, so no \
    scene moves when others are added; but of fewer scenes\nthan sides, and where train would be empty, the first is in train. `run` divides \
    the same way. split.json tells which\nmeshes and textures are on several sides."
)]
pub struct PartitionArgs {
    /// The dataset's folder, as given to `run`
    pub dataset: PathBuf,
    /// Another seed is another division [default: the last one, at first 0]
    #[arg(long)]
    pub seed: Option<u64>,
    /// Expected shares of train, val and test [default: the last ones, at first 80,10,10]
    #[arg(long, value_name = "A,B,C", value_parser = parse_shares, allow_hyphen_values = true)]
    pub shares: Option<[f64; 3]>,
}

/// `inspect`.
#[derive(Args)]
#[command(after_help = "Examples:\n  enfilade inspect out --scene home --camera cam_00 --frame 0 --pixel 160,120\n  \
    enfilade inspect metadata_camera_parameters.csv --cameras > intrinsics.csv")]
pub struct InspectArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// Name of the scene [default: the only one]
    #[arg(long)]
    pub scene: Option<String>,
    /// Name of the camera
    #[arg(long, default_value = "cam_00")]
    pub camera: String,
    /// Number of the frame
    #[arg(long, default_value_t = 0, allow_negative_numbers = true)]
    pub frame: u32,
    /// Column and row of the pixel, from 0 at the upper left
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel, required_unless_present = "list_cameras", allow_hyphen_values = true)]
    pub pixel: Option<(u32, u32)>,
    /// K of every scene of the table of cameras, as CSV, instead of a pixel; DATASET may be that table itself
    #[arg(long = "cameras", conflicts_with = "pixel")]
    pub list_cameras: bool,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
}

/// `replay`.
#[derive(Args)]
#[command(
    after_help = "Example:\n  enfilade replay out/scenes/home/_detail/cam_00/frames/frame.0000.json\n\nThe exit code is 1 when a byte differs. \
    Labels, and color without noise, are made from a frame afterwards and are not compared."
)]
pub struct ReplayArgs {
    /// The commit record of the frame
    #[arg(value_name = "FRAME.JSON")]
    pub record: PathBuf,
    /// Write the layers below this folder [default: keep nothing]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
}

/// `stats`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade stats out\n  enfilade stats out --price 0.048 --compare other-dataset/statistics\n\nThe page is statistics/statistics.html. \
    Hypersim's own datasets are read as far as they have the layers; its\npublished image statistics can be compared with."
)]
pub struct StatsArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// Only the scenes of these names ("bed*", "hall,bedroom")
    #[arg(long, value_name = "PATTERN", visible_alias = "scenes")]
    pub scene: Option<String>,
    /// Dollars per vCPU-hour, with further rates such as 0.0165,licence=0.00015/core-minute, or a CSV table [default: 0.0165, Hypersim's median]
    #[arg(long, value_name = "X|CSV", allow_hyphen_values = true)]
    pub price: Option<String>,
    /// Draw the charts over the histograms of this folder: statistics of another dataset, or Hypersim's
    #[arg(long, value_name = "FOLDER")]
    pub compare: Option<PathBuf>,
    /// The folder to write [default: statistics, in the dataset; needed with --scene]
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
}
