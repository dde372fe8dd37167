//! `make`: one verb for everything that is made of finished frames, with a noun for each; and which flags go with which noun.

use super::values::{parse_frame, parse_overlap};
use super::{CamerasArg, FramesArg};
use clap::builder::PossibleValue;
use clap::error::ErrorKind;
use clap::{ArgMatches, Args, Command, Id, ValueEnum};
use enfilade_pipeline::Product;
use std::path::PathBuf;

/// `make`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade make out pairs --overlap 0.2..0.7 --baseline 0.3.. --angle ..90\n  enfilade make out pairs flow tracks\n  \
    enfilade make out flow --between cam_00/3 cam_01/7\n  enfilade make out rooms words\n  enfilade make out --stale\n  \
    enfilade make out sensors --sensors examples/sensors.toml --frames 0..4\n  enfilade make out relit --mixes examples/mixes.csv\n\n\
    Nothing is rendered. flow, tracks and surfaces ask the scene itself, so they need the folder in which `enfilade run` made the dataset;\n\
    relit needs frames of `enfilade run --fixtures`. docs/ground-truth.md has a page for each."
)]
pub struct MakeArgs {
    /// The dataset's folder
    #[arg(value_name = "OUT")]
    pub dataset: PathBuf,
    /// What to make, one or several
    #[arg(value_name = "WHAT", required_unless_present = "stale")]
    pub what: Vec<What>,
    /// Make again what is out of date, as it was asked for: of WHAT, or of everything
    #[arg(long, conflicts_with = "force")]
    pub stale: bool,
    /// Make also what is up to date
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub chosen: FramesArg,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub list: ListFlags,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub pairs: PairsFlags,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub flow: FlowFlags,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub tracks: TracksFlags,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub surfaces: SurfacesFlags,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub sensors: SensorsFlags,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub relit: RelitFlags,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
}

/// What `make` makes, in the order in which it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs, reason = "`about` tells what each one is")]
pub enum What {
    Pairs,
    Flow,
    Tracks,
    Surfaces,
    Rooms,
    Words,
    Sensors,
    Relit,
}

impl What {
    /// The noun of the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pairs => "pairs",
            Self::Flow => "flow",
            Self::Tracks => "tracks",
            Self::Surfaces => "surfaces",
            Self::Rooms => "rooms",
            Self::Words => "words",
            Self::Sensors => "sensors",
            Self::Relit => "relit",
        }
    }

    /// What the pipeline calls it.
    pub const fn product(self) -> Product {
        match self {
            Self::Pairs => Product::Pairs,
            Self::Flow => Product::Flow,
            Self::Tracks => Product::Tracks,
            Self::Surfaces => Product::Surfaces,
            Self::Rooms => Product::Rooms,
            Self::Words => Product::Words,
            Self::Sensors => Product::Sensors,
            Self::Relit => Product::Relit,
        }
    }

    /// A call that makes it.
    pub fn example(self) -> String {
        let files = match self {
            Self::Sensors => " --sensors sensors.toml",
            Self::Relit => " --mixes mixes.csv",
            _ => "",
        };
        format!("enfilade make OUT {}{files}", self.name())
    }

    const fn about(self) -> &'static str {
        match self {
            Self::Pairs => "Which frames see the same surfaces: shares, baselines and angles of all view pairs of a scene",
            Self::Flow => "Flow between any two frames of a scene, also of different cameras, forward and backward",
            Self::Tracks => "Points on surfaces, followed through the frames of each camera, in TAP-Vid's layout",
            Self::Surfaces => "Every surface along the ray of each pixel, front and back, and what is behind glass with refraction",
            Self::Rooms => "Rooms, walls, doors and windows of scenes without a plan, and the plane that each pixel shows",
            Self::Words => "Attributes and relations of things, captions, questions with answers",
            Self::Sensors => "Readings of simulated cameras and depth sensors",
            Self::Relit => "Frames with lamps switched, dimmed and tinted",
        }
    }
}

impl ValueEnum for What {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Pairs, Self::Flow, Self::Tracks, Self::Surfaces, Self::Rooms, Self::Words, Self::Sensors, Self::Relit]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()).help(self.about()))
    }
}

/// The list of view pairs, which `pairs` writes and `flow` follows.
#[derive(Args)]
#[command(next_help_heading = "pairs, flow")]
pub struct ListFlags {
    /// The list of view pairs: `pairs` writes it, `flow` follows it there and back [default: pairs.csv in the dataset]
    #[arg(long, value_name = "CSV")]
    pub pairs: Option<PathBuf>,
}

/// The flags of `pairs`.
#[derive(Args)]
#[command(next_help_heading = "pairs")]
pub struct PairsFlags {
    /// Only pairs that see this share of each other: 0.2..0.7, 30%.. or ..0.5 [default: any at all]
    #[arg(long, value_name = "RANGE", value_parser = parse_overlap)]
    pub overlap: Option<[f32; 2]>,
    /// Only pairs with this distance of the cameras, metres: 0.3..2, 0.3.. or ..2 [default: any]
    #[arg(long, value_name = "RANGE", value_parser = parse_between)]
    pub baseline: Option<[f64; 2]>,
    /// Only pairs with this angle between the viewing axes, degrees: 10..90, 10.. or ..90 [default: any]
    #[arg(long, value_name = "RANGE", value_parser = parse_between)]
    pub angle: Option<[f64; 2]>,
    /// Approximate number of pixels of each frame that are projected into the others [default: 3000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub pixels: Option<u32>,
}

/// The flags of `flow`.
#[derive(Args)]
#[command(next_help_heading = "flow")]
pub struct FlowFlags {
    /// Instead of a list: from each frame to the one N later in its trajectory; -1 is the one before
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub step: Option<i64>,
    /// Instead of a list: from one frame to another, as in cam_00/3 cam_01/7
    #[arg(long, value_names = ["CAMERA/FRAME", "CAMERA/FRAME"], num_args = 2, value_parser = parse_frame, conflicts_with = "step")]
    pub between: Option<Vec<(String, u32)>>,
}

/// The flags of `tracks`.
#[derive(Args)]
#[command(next_help_heading = "tracks")]
pub struct TracksFlags {
    /// Points per camera, seeded evenly over its frames and over the image [default: 256]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub points: Option<u32>,
    /// Another seed gives other points [default: 0]
    #[arg(long)]
    pub seed: Option<u64>,
}

/// The flags of `surfaces`.
#[derive(Args)]
#[command(next_help_heading = "surfaces")]
pub struct SurfacesFlags {
    /// Surfaces per pixel at most, from near to far [default: 8]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=64))]
    pub layers: Option<u32>,
}

/// The flags of `sensors`.
#[derive(Args)]
#[command(next_help_heading = "sensors")]
pub struct SensorsFlags {
    /// The sensors; docs/sensors.md has the kinds and their keys
    #[arg(long, value_name = "TOML")]
    pub sensors: Option<PathBuf>,
}

/// The flags of `relit`.
#[derive(Args)]
#[command(next_help_heading = "relit")]
pub struct RelitFlags {
    /// The mixes: a table of mix, fixture, r, g, b
    #[arg(long, value_name = "CSV")]
    pub mixes: Option<PathBuf>,
}

/// The nouns that each group of flags is for: clap names a group by its struct.
const FLAGS: [(&str, &[What]); 7] = [
    ("ListFlags", &[What::Pairs, What::Flow]),
    ("PairsFlags", &[What::Pairs]),
    ("FlowFlags", &[What::Flow]),
    ("TracksFlags", &[What::Tracks]),
    ("SurfacesFlags", &[What::Surfaces]),
    ("SensorsFlags", &[What::Sensors]),
    ("RelitFlags", &[What::Relit]),
];

/// Nouns that are always of a whole scene, by the flags that would choose a part of it.
const OF_WHOLE_SCENES: [(&str, &[What]); 2] = [("camera", &[What::Words]), ("frames", &[What::Pairs, What::Flow, What::Words])];

/// Refuses flags of nouns that are not asked for, and choices of frames that a noun does not know.
///
/// # Errors
/// One of clap's, with its exit code.
pub fn check_make(matches: &ArgMatches, command: &mut Command) -> Result<(), clap::Error> {
    let asked: Vec<What> = matches.get_many::<What>("what").into_iter().flatten().copied().collect();
    let named = |nouns: &[What]| nouns.iter().map(|noun| noun.name()).collect::<Vec<_>>().join(" and ");
    if matches.get_flag("stale") {
        return check_stale(matches, command);
    }
    for (group, nouns) in FLAGS.iter().filter(|(_, nouns)| !nouns.iter().any(|noun| asked.contains(noun))) {
        if let Some(flag) = matches.get_many::<Id>(group).into_iter().flatten().next() {
            let message = format!("{} goes with {}, but {} is asked for", flag_of(flag.as_str()), named(nouns), named(&asked));
            return Err(command.error(ErrorKind::ArgumentConflict, message));
        }
    }
    for (flag, nouns) in OF_WHOLE_SCENES {
        let whole: Vec<What> = nouns.iter().copied().filter(|noun| asked.contains(noun)).collect();
        if matches.contains_id(flag) && !whole.is_empty() {
            let message = format!("{} does not go with {}; --scene does", flag_of(flag), named(&whole));
            return Err(command.error(ErrorKind::ArgumentConflict, message));
        }
    }
    let other = ["step", "between"].into_iter().find(|flag| matches.contains_id(flag));
    match other.filter(|_| matches.contains_id("pairs") && !asked.contains(&What::Pairs)) {
        Some(flag) => {
            let message = format!("--pairs and {} both say between which frames flow leads; give one of them", flag_of(flag));
            Err(command.error(ErrorKind::ArgumentConflict, message))
        }
        None => Ok(()),
    }
}

/// Refuses flags that say how something is to be made, beside one that makes it as it was.
fn check_stale(matches: &ArgMatches, command: &mut Command) -> Result<(), clap::Error> {
    let of_nouns = FLAGS.iter().filter_map(|(group, _)| matches.get_many::<Id>(group)?.next().map(Id::as_str));
    let of_frames = ["camera", "frames"].into_iter().filter(|flag| matches.contains_id(flag));
    match of_nouns.chain(of_frames).next() {
        Some(flag) => {
            let message = format!("--stale makes products as they were asked for, so {} does not go with it; --scene does", flag_of(flag));
            Err(command.error(ErrorKind::ArgumentConflict, message))
        }
        None => Ok(()),
    }
}

fn flag_of(id: &str) -> String {
    format!("--{}", id.replace('_', "-"))
}

/// Numbers from..to, of which one may be left out.
fn parse_between(text: &str) -> Result<[f64; 2], String> {
    let bound = |text: &str, default: f64| if text.trim().is_empty() { Some(default) } else { text.trim().parse().ok() };
    let parsed = text.split_once("..").and_then(|(least, most)| Some([bound(least, 0.0)?, bound(most, f64::INFINITY)?]));
    parsed.filter(|[least, most]| 0.0 <= *least && least <= most).ok_or_else(|| "expected two numbers, as in 0.3..2, 0.3.. or ..2".into())
}

#[cfg(test)]
mod tests {
    use super::super::Cli;
    use super::*;
    use clap::CommandFactory;

    fn refusal(words: &str) -> Option<String> {
        let mut command = Cli::command();
        let matches = command.try_get_matches_from_mut(words.split(' ')).unwrap();
        check_make(matches.subcommand().unwrap().1, &mut command).err().map(|error| error.to_string())
    }

    #[test]
    fn every_flag_of_a_noun_is_in_a_group_of_the_table() {
        let command = Cli::command();
        let make = command.find_subcommand("make").unwrap();
        let of_nouns = make.get_arguments().filter(|arg| arg.get_help_heading().is_some_and(|heading| !heading.contains("Hypersim")));
        let in_groups = || make.get_groups().filter(|group| FLAGS.iter().any(|(name, _)| group.get_id() == *name));
        let mut flags = 0;
        for flag in of_nouns {
            assert!(in_groups().any(|group| group.get_args().any(|id| id == flag.get_id())), "{}", flag.get_id());
            flags += 1;
        }
        assert_eq!((in_groups().count(), flags), (FLAGS.len(), 12));
    }

    #[test]
    fn flags_of_other_nouns_are_refused_by_name() {
        assert_eq!(refusal("enfilade make out pairs tracks --points 9 --overlap 0.1.. --pairs a.csv"), None);
        assert_eq!(refusal("enfilade make out pairs flow --step 1 --pairs a.csv"), None);
        assert_eq!(refusal("enfilade make out sensors --stale --scene room"), None);
        for (words, told) in [
            ("enfilade make out pairs --points 9", "--points goes with tracks, but pairs is asked for"),
            ("enfilade make out rooms words --pairs a.csv", "--pairs goes with pairs and flow, but rooms and words is asked for"),
            ("enfilade make out tracks pairs --frames 3", "--frames does not go with pairs; --scene does"),
            ("enfilade make out words --camera cam_00", "--camera does not go with words"),
            ("enfilade make out flow --step 1 --pairs a.csv", "--pairs and --step both say"),
            ("enfilade make out pairs --stale --overlap 0.1..", "so --overlap does not go with it"),
            ("enfilade make out --stale --frames 3", "so --frames does not go with it"),
        ] {
            let found = refusal(words).unwrap_or_default();
            assert!(found.contains(told), "{words}: {found}");
        }
    }

    #[test]
    fn ranges_of_numbers_are_read() {
        assert_eq!(
            (parse_between("0.3..2"), parse_between("10.."), parse_between("..90")),
            (Ok([0.3, 2.0]), Ok([10.0, f64::INFINITY]), Ok([0.0, 90.0]))
        );
        assert!(["3", "2..1", "-1..2", "a..b", "nan.."].iter().all(|text| parse_between(text).is_err()));
    }
}
