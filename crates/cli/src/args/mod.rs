//! The command line: one definition per verb and flag, with its help and an example.

#[cfg(test)]
mod examples;
mod farm;
mod flags;
mod make;
mod outputs;
mod pages;
mod reading;
mod rendering;
mod results;
mod scenes;
mod shell;
mod stages;
mod values;

pub use farm::{FarmArgs, FarmCollectArgs, FarmPlanArgs, FarmStatusArgs, FarmSubmitArgs, FarmVerb, FarmWorkArgs};
pub use make::{MakeArgs, example};
pub use outputs::{AnimateArgs, ExportArgs};
pub use pages::{AnnotateArgs, ListenArgs, ViewArgs};
pub use reading::{CamerasArg, FramesArg};
pub use rendering::SettingFlags;
pub use results::{InspectArgs, PartitionArgs, ReplayArgs, StatsArgs, VerifyArgs};
pub use scenes::{HomeArgs, ImportArgs, LookArgs, SuggestArgs, file_source};
pub use shell::CompletionsArgs;
pub use stages::{LabelArgs, RunArgs, StageArg};

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use enfilade_vray::verbs::VrayArgs;
use make::check_make;
use std::ffi::OsString;
use std::path::PathBuf;

/// Turns 3D interiors into photorealistic image datasets with dense ground truth, in Hypersim's layout.
#[derive(Parser)]
#[command(name = "enfilade", version, arg_required_else_help = true)]
#[command(after_help = "Begin with:\n  enfilade run --demo out\n\nEach verb has its own help with an example: enfilade VERB --help")]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub verb: Verb,
    /// Number of threads [default: one per processor]; changes no byte of the output
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Print only the result and errors
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// The file of this program.
    #[arg(skip)]
    pub program: Option<PathBuf>,
}

impl Cli {
    /// The command line of these words, of which the first is the program's name.
    ///
    /// # Errors
    /// Where it is wrong, and where help or the version was asked for.
    pub fn of(words: &[OsString]) -> Result<Self, clap::Error> {
        let mut command = Self::command();
        let matches = command.try_get_matches_from_mut(words)?;
        if let Some(("make", of_make)) = matches.subcommand() {
            check_make(of_make, &mut command)?;
        }
        Self::from_arg_matches(&matches)
    }
}

/// The verbs.
#[derive(Subcommand)]
pub enum Verb {
    /// Make a dataset, or continue one: all stages, for the demo or for the scenes of a TOML file
    Run(RunArgs),
    /// A first picture of a scene file, in a few seconds
    Look(LookArgs),
    /// Scene file -> scene package
    Import(ImportArgs),
    /// A furnished home of a seed -> scene package
    Home(HomeArgs),
    /// More from finished frames: pairs, flow, tracks, surfaces, rooms, words, sensors, relit pictures
    Make(MakeArgs),
    /// Frames, label table -> semantic layers; renders nothing again
    Label(LabelArgs),
    /// Scene file -> label table, proposed from the names of parts and materials
    Suggest(SuggestArgs),
    /// Label the parts of a scene, in the browser
    Annotate(AnnotateArgs),
    /// Check that the data of a dataset agree, and write its report card; the exit code says whether all laws pass
    Verify(VerifyArgs),
    /// Look at a dataset in the browser: every layer, values under the cursor, comparisons, the scene in 3D
    View(ViewArgs),
    /// Everything about one pixel
    Inspect(InspectArgs),
    /// The dataset in a layout that other programs load: COCO, BOP, nerfstudio, COLMAP, ScanNet, OpenEXR, ...
    Export(ExportArgs),
    /// Frames -> MP4 or GIF of each trajectory, layer by layer
    Animate(AnimateArgs),
    /// What the images show and what they cost: numbers, charts, outliers
    Stats(StatsArgs),
    /// Divide the dataset by scene into train, val and test, from now on in this way
    Partition(PartitionArgs),
    /// Render one frame again from its record, and compare the bytes
    Replay(ReplayArgs),
    /// One dataset on many machines: plan, work, status, collect, submit
    Farm(FarmArgs),
    /// Edits of V-Ray's scene files, if you render with V-Ray
    Vray(VrayArgs),
    /// What a shell needs to complete verbs and options, on standard output; or the manual pages
    Completions(CompletionsArgs),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_definition_is_consistent_and_every_verb_shows_an_example() {
        Cli::command().debug_assert();
        for verb in Cli::command().get_subcommands() {
            let help = verb.get_after_help().map(ToString::to_string).unwrap_or_default();
            assert!(help.contains(&format!("enfilade {}", verb.get_name())), "{}", verb.get_name());
        }
    }

    #[test]
    fn quality_help_tells_the_numbers_that_are_used() {
        use enfilade_options::{Form, Value};
        use enfilade_pipeline::Quality;
        let Form::Word(words) = Quality::FORM else { panic!() };
        for (word, quality) in words.iter().zip([Quality::Draft, Quality::Normal, Quality::High]) {
            assert!(word.about().starts_with(&format!("{} samples, ", quality.samples())), "{word:?}");
        }
    }
}
