//! The verbs that run stages.

use super::CamerasArg;
use super::rendering::SettingFlags;
use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
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
