//! The verbs that run stages.

use super::CamerasArg;
use super::values::{parse_share, parse_size, parse_time};
use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use enfilade_dataset::ColorKind;
use enfilade_pipeline::{STAGES, Stage};
use std::path::PathBuf;

/// `run`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade run --demo out\n  enfilade run --demo out --seed 7 --frames 8 --size 640x480 --quality draft\n  \
    enfilade run dataset.toml -o out --noise 2% --samples 4096\n  \
    enfilade run dataset.toml -o out --estimate --price 0.048\n  \
    enfilade run out --extra --light-parts               # a dataset made before, with other settings from now on\n  \
    enfilade run out --color rendered                    # renders nothing again\n  \
    enfilade run out --only render --scene 'bed*' --force\n  \
    enfilade run dataset.toml -o out --only import,carve,plan --draw-plan\n  \
    enfilade run hypersim --only preview -o pictures     # data of others, left as they are\n\n\
    A second run does nothing that is already done; a killed run continues where it was."
)]
pub struct RunArgs {
    /// The scenes to use and what to make of them; or the folder of a dataset made before, to continue it with the settings stored there
    #[arg(value_name = "DATASET.TOML|OUT", required_unless_present = "demo", conflicts_with = "demo")]
    pub from: Option<PathBuf>,
    /// Make the demo dataset in the folder OUT instead: a generated home
    #[arg(long, value_name = "OUT")]
    pub demo: Option<PathBuf>,
    /// Output folder [default: the dataset's name, in the current folder]; of a dataset made before, with --only preview: the folder of
    /// the pictures
    #[arg(short, long, value_name = "OUT", conflicts_with = "demo")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub settings: SettingFlags,
    /// Only the scenes of these names ("bed*", "hall,bedroom")
    #[arg(long, value_name = "PATTERN", visible_alias = "scene")]
    pub scenes: Option<String>,
    /// Only these stages; render also denoises and labels what it renders, label also makes boxes
    #[arg(long, value_name = "STAGE,STAGE", value_delimiter = ',', conflicts_with = "estimate")]
    pub only: Vec<StageArg>,
    /// Do these stages even if nothing has changed
    #[arg(long, requires = "only")]
    pub force: bool,
    /// Also draw the trajectories, those of earlier runs too: plan and sections with free space, frusta and scores, every view coloured by
    /// part, and statistics
    #[arg(long, conflicts_with = "estimate")]
    pub draw_plan: bool,
    /// Forecast the time, money, disk and memory of the run, from a pilot of a few pixels; nothing is rendered, and no finished frame changes
    #[arg(long)]
    pub estimate: bool,
    /// With --estimate: dollars per vCPU-hour, with further rates such as 0.0165,licence=0.00015/core-minute, or a CSV table [default: 0.0165,
    /// Hypersim's median]
    #[arg(long, value_name = "X|CSV", requires = "estimate", allow_negative_numbers = true)]
    pub price: Option<String>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
}

/// A stage, by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StageArg(pub Stage);

impl ValueEnum for StageArg {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [StageArg; STAGES.len()] = {
            let mut all = [StageArg(Stage::Import); STAGES.len()];
            let mut i = 0;
            while i < all.len() {
                all[i] = StageArg(STAGES[i].stage);
                i += 1;
            }
            all
        };
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let spec = STAGES.iter().find(|spec| spec.stage == self.0)?;
        Some(PossibleValue::new(spec.name).help(spec.about))
    }
}

/// What to make otherwise than the file says, for `run` and `farm plan`.
#[derive(Args)]
pub struct SettingFlags {
    /// Seed of everything random; homes with a seed of their own keep it
    #[arg(long)]
    pub seed: Option<u64>,
    /// Frames per trajectory
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub frames: Option<u32>,
    /// Width and height of the images in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    /// How good the pictures become, in one word
    #[arg(long, conflicts_with = "samples")]
    pub quality: Option<QualityArg>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub render: RenderFlags,
}

/// `--quality`.
#[derive(Clone, Copy, ValueEnum)]
pub enum QualityArg {
    /// 8 samples
    Draft,
    /// 32 samples
    Normal,
    /// 128 samples
    High,
    /// Unbiased: color as it was rendered, with as many samples as a noise of 2% takes
    Reference,
}

/// Choices about rendering. None is made unless asked for.
#[derive(Args)]
#[command(next_help_heading = "Rendering (of a dataset made before: from now on)")]
pub struct RenderFlags {
    /// Samples per pixel: the mean over the image, or with --noise the maximum [default: those of the quality; with --noise 65536]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub samples: Option<u32>,
    /// Stop where the noise is this small: 2% or 0.02
    #[arg(long, value_name = "SHARE", value_parser = parse_share, allow_hyphen_values = true)]
    pub noise: Option<f32>,
    /// Longest path, in surfaces that scatter light after the first [default: no limit, which is unbiased]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub max_bounces: Option<u32>,
    /// Largest radiance of one indirect sample [default: no limit, which is unbiased]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub clamp: Option<f32>,
    /// Wall-clock time after which a frame ends with the samples it has: 90s, 5m; two such runs differ
    #[arg(long, value_name = "TIME", value_parser = parse_time, allow_hyphen_values = true)]
    pub time_limit: Option<f64>,
    /// Also write the light of color by its path (diffuse_direct, ...) and by its source (light_environment, ...)
    #[arg(long)]
    pub light_parts: bool,
    /// Also write the light of each lamp and window, the sun and the sky by itself, for `enfilade make OUT relit`
    #[arg(long)]
    pub fixtures: bool,
    /// Also write material, flow to the next frame, what is behind glass, occlusion boundaries and more, pixel by pixel
    #[arg(long)]
    pub extra: bool,
    /// Make rough diffuse surfaces (plaster, cloth) Lambertian: diffuse_illumination of a point is then the same from everywhere
    #[arg(long)]
    pub lambertian: bool,
    /// Contents of color, diffuse_illumination and residual [default: denoised]; changing them renders nothing again
    #[arg(long, value_enum, value_name = "KIND")]
    pub color: Option<ColorArg>,
}

/// What the colour layers hold.
#[derive(Clone, Copy, ValueEnum)]
pub enum ColorArg {
    /// A clean but biased estimate; the rendered layers are kept beside it, as color_rendered, ...
    Denoised,
    /// The rendered layers: unbiased and noisy
    Rendered,
}

impl From<ColorArg> for ColorKind {
    fn from(color: ColorArg) -> Self {
        match color {
            ColorArg::Denoised => Self::Denoised,
            ColorArg::Rendered => Self::Rendered,
        }
    }
}

/// `label`.
#[derive(Args)]
#[command(after_help = "Examples:\n  enfilade label out\n  enfilade label out --scene home --table my_labels.csv\n\n\
    The table is CSV: a column `part`, `object`, `material` or `name`, a column `nyu40_id` or `semantic` (number or name of a class),\n\
    and if wanted `scene` and `instance`.")]
pub struct LabelArgs {
    /// The dataset's folder, as given to `run`
    pub dataset: PathBuf,
    /// Only the scenes of these names ("bed*", "hall,bedroom")
    #[arg(long, value_name = "PATTERN", visible_alias = "scenes")]
    pub scene: Option<String>,
    /// Do it even if nothing has changed
    #[arg(long)]
    pub force: bool,
    /// Use this table from now on
    #[arg(long, value_name = "CSV")]
    pub table: Option<PathBuf>,
}
