//! `farm` and what it has below it.

use super::flags::{Flags, word};
use super::rendering::SettingFlags;
use clap::{Args, Subcommand};
use enfilade_farm::{EngineName, PlanOptions, SubmitOptions};
use std::path::PathBuf;

/// `farm`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade farm plan dataset.toml -o /shared/job\n  enfilade farm submit /shared/job --engine slurm --collect /shared/rooms\n  \
    enfilade farm work /shared/job --shard 0/4\n  enfilade farm status /shared/job\n  enfilade farm collect /shared/job -o rooms\n\n\
    JOB is a folder that all nodes see, or s3://bucket/prefix, gs://... or az://...; keys and regions come from the environment.\n\
    Exit codes of work: 0 all its tasks are committed, 75 another try may succeed, 65 another would fail too. docs/farm.md says more."
)]
pub struct FarmArgs {
    /// What to do
    #[command(subcommand)]
    pub verb: FarmVerb,
}

/// The verbs of `farm`.
#[derive(Subcommand)]
pub enum FarmVerb {
    /// Package the scenes, plan what to film, and divide the work into tasks
    Plan(FarmPlanArgs),
    /// Render tasks, or continue them, and commit their frames
    Work(FarmWorkArgs),
    /// How far the job has come; the exit code is 0 when nothing is missing, else 1
    Status(FarmStatusArgs),
    /// All frames into one dataset, as one machine would have made it
    Collect(FarmCollectArgs),
    /// Write what an engine needs to render the missing tasks, and for Slurm submit it
    Submit(FarmSubmitArgs),
}

/// `farm plan`.
#[derive(Args)]
pub struct FarmPlanArgs {
    /// The scenes to use and what to make of them
    #[arg(value_name = "DATASET.TOML", required_unless_present = "demo", conflicts_with = "demo")]
    pub config: Option<PathBuf>,
    /// Plan the demo instead: a generated home
    #[arg(long)]
    pub demo: bool,
    /// Where the job is to lie: a folder that all nodes see, or a URL
    #[arg(short, long, value_name = "JOB")]
    pub output: String,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub options: Flags<PlanOptions>,
    /// Also report what it will cost: dollars per vCPU-hour, with further rates such as 0.0165,licence=0.00015/core-minute, or a CSV table [default: 0.0165,
    /// Hypersim's median]
    #[arg(long, value_name = "X|CSV", allow_hyphen_values = true)]
    pub price: Option<String>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub settings: SettingFlags,
}

/// `farm work`.
#[derive(Args)]
pub struct FarmWorkArgs {
    /// The job
    pub job: String,
    /// Numbers of tasks: 7, 0-3, 0-8:2 or 1,5,9-12
    #[arg(long, value_name = "RANGES", required_unless_present = "shard", conflicts_with = "shard")]
    pub task: Option<String>,
    /// Only one of them: the one at the place that the engine's index says (JOB_COMPLETION_INDEX, AWS_BATCH_JOB_ARRAY_INDEX), counted from 0
    #[arg(long, requires = "task")]
    pub nth: bool,
    /// The i-th of N shares of all tasks, counted from 0: 3/16
    #[arg(long, value_name = "I/N")]
    pub shard: Option<String>,
    /// A folder of this node, for scenes and frames in the making [default: enfilade-farm in the temporary folder]
    #[arg(long, value_name = "DIR")]
    pub scratch: Option<PathBuf>,
}

/// `farm status`.
#[derive(Args)]
pub struct FarmStatusArgs {
    /// The job
    pub job: String,
    /// Print only the missing tasks, as --task takes them
    #[arg(long, conflicts_with = "json")]
    pub missing: bool,
    /// Print it as JSON
    #[arg(long)]
    pub json: bool,
    /// Also report what it has cost so far: dollars per vCPU-hour, with further rates such as 0.0165,licence=0.00015/core-minute, or a CSV table
    #[arg(long, value_name = "X|CSV", allow_hyphen_values = true, conflicts_with_all = ["missing", "json"])]
    pub price: Option<String>,
    /// Write a table with a row per attempt: machine, the engine's numbers, times, memory, costs
    #[arg(long, value_name = "CSV", conflicts_with_all = ["missing", "json"])]
    pub attempts: Option<PathBuf>,
}

/// `farm collect`.
#[derive(Args)]
pub struct FarmCollectArgs {
    /// The job
    pub job: String,
    /// The dataset's folder
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    /// Dollars per vCPU-hour, with further rates such as 0.0165,licence=0.00015/core-minute, or a CSV table [default: 0.0165, Hypersim's median]
    #[arg(long, value_name = "X|CSV", allow_hyphen_values = true)]
    pub price: Option<String>,
}

/// `farm submit`.
#[derive(Args)]
#[command(
    mut_arg("program", |arg| arg.help("The program on the nodes [default: this one for Slurm, else enfilade]")),
    mut_arg("image", |arg| arg.required_if_eq("engine", "kubernetes")),
    mut_arg("queue", |arg| arg.required_if_eq("engine", "aws-batch")),
    mut_arg("definition", |arg| arg.required_if_eq("engine", "aws-batch")),
)]
pub struct FarmSubmitArgs {
    /// The job, as the nodes name it
    pub job: String,
    /// What starts the workers
    #[arg(long, value_parser = word::<EngineName>())]
    pub engine: EngineName,
    /// Folder for the files
    #[arg(short, long, value_name = "DIR", default_value = ".")]
    pub output: PathBuf,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub options: Flags<SubmitOptions>,
}
