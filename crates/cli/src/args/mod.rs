//! The command line: one definition per verb and flag, with its help and an example.

mod farm;
mod ingest;
mod outputs;
mod pages;
mod reading;
mod results;
mod scenes;
mod shell;
mod stages;
mod values;
mod views;

pub use farm::{EngineArg, FarmArgs, FarmCollectArgs, FarmPlanArgs, FarmStatusArgs, FarmSubmitArgs, FarmVerb, FarmWorkArgs};
pub use ingest::{IngestArgs, IngestVerb, Pix3dArgs};
pub use outputs::{AnimateArgs, ExportArgs};
pub use pages::{AnnotateArgs, ListenArgs, ViewArgs};
pub use reading::{CamerasArg, FramesArg};
pub use results::{InspectArgs, ReplayArgs, SplitArgs, StatsArgs, VerifyArgs};
pub use scenes::{HomeArgs, ImportArgs, LookArgs, MomentArg, SuggestArgs, UpAxisArg};
pub use shell::{CompletionsArgs, ManArgs};
pub use stages::{LabelArgs, MakeFlags, PlanArgs, PreviewArgs, QualityArg, RenderArgs, RenderFlags, RunArgs, StageArgs};
pub use values::parse_size;
pub use views::{DescribeArgs, FlowArgs, LayoutArgs, PairsArgs, RelightArgs, SenseArgs, SurfacesArgs, TracksArgs};

use crate::vray::VrayArgs;
use clap::{Parser, Subcommand};
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
    /// Print nothing but the result and errors
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// The file of this program.
    #[arg(skip)]
    pub program: Option<PathBuf>,
}

/// The verbs.
#[derive(Subcommand)]
pub enum Verb {
    /// Make a dataset: all stages, for the demo or for the scenes of a TOML file
    Run(RunArgs),
    /// The first picture of a scene file, in some seconds
    Look(LookArgs),
    /// Scene file -> scene package
    Import(ImportArgs),
    /// A furnished home of a seed -> scene package
    Home(HomeArgs),
    /// Scene -> free space (octomap.bt)
    #[command(after_help = "Example:\n  enfilade carve out --scene home")]
    Carve(StageArgs),
    /// Scene, free space -> camera trajectories
    Plan(PlanArgs),
    /// Scene, trajectories -> which views are worth rendering
    #[command(
        after_help = "Example:\n  enfilade gate out\n\nViews that are blank, buried, blocked, outside or of a bare wall are not rendered. _detail/gates.html shows them; [gate] in\n\
        dataset.toml has the limits, and action = \"report\" renders them all the same."
    )]
    Gate(StageArgs),
    /// Scene, trajectories -> frames
    #[command(
        after_help = "Examples:\n  enfilade render out --scene 'bed*'\n  enfilade render out --noise 2% --samples 4096 --splits\n\nFinished frames are kept; a killed run continues where it was."
    )]
    Render(RenderArgs),
    /// Frames -> color without noise, from now on; renders nothing again
    #[command(
        after_help = "Example:\n  enfilade denoise out\n\nWhat was rendered stays as color_rendered, ... unless keep_rendered = false; `render --color rendered` takes it back."
    )]
    Denoise(StageArgs),
    /// Frames, label table -> semantic layers; renders nothing again
    Label(LabelArgs),
    /// Scene, labels -> bounding boxes, and what each frame shows of each instance; renders nothing again
    #[command(
        after_help = "Example:\n  enfilade boxes out\n\nThe boxes lie in _detail/mesh, as Hypersim's do; metadata_frame_instances.csv beside each trajectory has the\n\
        2D boxes, pixel counts, visibility and truncation of every instance in every frame."
    )]
    Boxes(StageArgs),
    /// Frames -> a picture of every layer, and a contact sheet per trajectory
    Preview(PreviewArgs),
    /// Check the laws that tie the layers of a dataset together, and write its report card; the exit code says whether all hold
    Verify(VerifyArgs),
    /// Divide the dataset by scene into train, val and test, from now on in this way
    Split(SplitArgs),
    /// Which frames see the same surfaces: shares, baselines and angles of all pairs of a scene
    Pairs(PairsArgs),
    /// Flow between any two frames of a scene, of different cameras too, forward and backward
    Flow(FlowArgs),
    /// Points on surfaces, followed through the frames of each camera, in TAP-Vid's layout
    Tracks(TracksArgs),
    /// Every surface along the ray of each pixel, front and back, and what is behind glass as glass bends it
    Surfaces(SurfacesArgs),
    /// Rooms, walls, doors and windows of scenes that came without a plan, and which plane of them each pixel shows
    Layout(LayoutArgs),
    /// What things are, how they stand to each other, and that in words: relations, captions, questions with answers
    Describe(DescribeArgs),
    /// What cameras and depth sensors would make of the frames; renders nothing
    Sense(SenseArgs),
    /// Frames with lamps switched, dimmed and tinted; renders nothing
    Relight(RelightArgs),
    /// Everything about one pixel
    Inspect(InspectArgs),
    /// Render one frame again from its record, and compare the bytes
    Replay(ReplayArgs),
    /// The dataset in a layout that other programs load: COCO, BOP, nerfstudio, COLMAP, ScanNet, OpenEXR, ...
    Export(ExportArgs),
    /// A real data set in the layout that training reads
    Ingest(IngestArgs),
    /// Frames -> MP4 or GIF of each trajectory, layer by layer
    Animate(AnimateArgs),
    /// What the images show and what they cost: numbers, charts, outliers
    Stats(StatsArgs),
    /// Edits of V-Ray's scene files, for those who render with V-Ray
    Vray(VrayArgs),
    /// One dataset on many machines: plan, work, status, collect, submit
    Farm(FarmArgs),
    /// Label the parts of a scene, in the browser
    Annotate(AnnotateArgs),
    /// Scene file -> label table, proposed from the names of parts and materials
    Suggest(SuggestArgs),
    /// Look at a dataset in the browser: every layer, values under the cursor, comparisons, the scene in 3D
    View(ViewArgs),
    /// What a shell needs to complete verbs and options, on standard output
    Completions(CompletionsArgs),
    /// The manual pages, in section 1, into a folder
    Man(ManArgs),
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{CommandFactory, ValueEnum};

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
        for (arg, quality) in QualityArg::value_variants().iter().zip([
            enfilade_pipeline::Quality::Draft,
            enfilade_pipeline::Quality::Normal,
            enfilade_pipeline::Quality::High,
        ]) {
            let value = arg.to_possible_value().unwrap();
            assert_eq!(value.get_help().unwrap().to_string(), format!("{} samples", quality.samples()));
        }
    }
}
