//! The verbs that write a dataset in other forms.

use super::flags::Flags;
use super::{CamerasArg, FramesArg};
use clap::{Args, ValueEnum};
use enfilade_animate::{AnimationFormat, Film};
use enfilade_export::ExportOptions;
use std::path::PathBuf;

/// `export`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade export out --format coco -o out-coco\n  enfilade export out --format colmap -o room --scene home --camera cam_00 --frames 0..10\n  \
    enfilade export out --format exr -o exr --layers color,depth_meters,semantic_instance\n\nNothing is rendered. docs/export.md has units, axes and contents of every format; each export has a README.md."
)]
pub struct ExportArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// The layout
    #[arg(long, value_parser = clap::builder::PossibleValuesParser::new(format_values()))]
    pub format: String,
    /// The folder to write; an earlier export there is replaced
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub chosen: FramesArg,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub options: Flags<ExportOptions>,
    /// If OUT exists and is no export, rename it to OUT.old
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
}

/// `animate`.
#[derive(Args)]
#[command(after_help = "Examples:\n  enfilade animate out\n  enfilade animate out --layers color,depth_meters,semantic --fps 10\n  \
    enfilade animate out --scene home --camera cam_00 --layers tonemap --format gif -o films\n\nExposure and ranges are the same in \
    all frames, but in tonemap, which is Hypersim's. docs/previews.md has the names.")]
pub struct AnimateArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// Only the scenes of these names ("bed*", "hall,bedroom")
    #[arg(long, value_name = "PATTERN", visible_alias = "scenes")]
    pub scene: Option<String>,
    /// Only the cameras of these names ("cam_00", "cam_0*")
    #[arg(long, value_name = "PATTERN", visible_alias = "cameras")]
    pub camera: Option<String>,
    /// What to show, one file each: layers, or tonemap, gamma, lambertian, non_lambertian, diff
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',', default_value = "color", value_parser = parse_film)]
    pub layers: Vec<Film>,
    /// The form of the files
    #[arg(long, value_enum, default_value_t = AnimationFormatArg::Mp4)]
    pub format: AnimationFormatArg,
    /// Pictures per second [default: as the trajectory was timed if it is a video, else 5]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub fps: Option<f64>,
    /// The folder to write to [default: `animations` in the dataset]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
}

/// `--format` of `animate`.
#[derive(Clone, Copy, ValueEnum)]
pub enum AnimationFormatArg {
    /// H.264; for every browser and player
    Mp4,
    /// 256 colours per picture; for everything that shows pictures
    Gif,
}

impl From<AnimationFormatArg> for AnimationFormat {
    fn from(arg: AnimationFormatArg) -> Self {
        match arg {
            AnimationFormatArg::Mp4 => Self::Mp4,
            AnimationFormatArg::Gif => Self::Gif,
        }
    }
}

fn parse_film(name: &str) -> Result<Film, String> {
    let layers = || enfilade_frame::LAYERS.iter().map(|spec| spec.name).collect::<Vec<_>>().join(", ");
    let found = Film::from_name(name.trim());
    found.ok_or_else(|| format!("there are tonemap, gamma, lambertian, non_lambertian, diff, and the layers {}", layers()))
}

/// The formats as `--format` shows them.
fn format_values() -> Vec<clap::builder::PossibleValue> {
    enfilade_export::FORMATS.iter().map(|spec| clap::builder::PossibleValue::new(spec.name).help(spec.about)).collect()
}
