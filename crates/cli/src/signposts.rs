//! Suggestions for words that are no verb, noun or stage: what newcomers type, and names from elsewhere in the program.

use crate::args::{StageArg, example};
use crate::outcome::Problem;
use clap::ValueEnum;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use enfilade_export::Format;
use enfilade_frame::Layer;
use enfilade_pipeline::Product;

/// Words of people, and what they should have typed. Names of stages, nouns, layers and formats are known without being listed here.
const WORDS: [(&[&str], &str); 28] = [
    (&["covisibility", "overlap", "matches", "matching", "pair", "view-pairs"], "enfilade make OUT pairs"),
    (&["optical-flow", "optical_flow", "scene-flow", "correspondence", "correspondences"], "enfilade make OUT flow"),
    (&["track", "point-tracks", "tapvid"], "enfilade make OUT tracks"),
    (&["surface", "ray-surfaces", "ldi"], "enfilade make OUT surfaces"),
    (&["layout", "room", "structure", "floorplan", "floor-plan", "planes", "walls"], "enfilade make OUT rooms"),
    (
        &["describe", "description", "caption", "captions", "relation", "relations", "question", "questions", "vqa", "text"],
        "enfilade make OUT words",
    ),
    (&["sense", "sensor", "lidar", "kinect", "tof", "imu"], "enfilade make OUT sensors --sensors sensors.toml"),
    (&["relight", "relighting", "mix", "mixes", "lamps"], "enfilade make OUT relit --mixes mixes.csv"),
    (&["trajectory", "trajectories", "path", "paths", "poses"], "enfilade run OUT --only plan"),
    (&["octree", "octomap", "free-space", "voxels"], "enfilade run OUT --only carve"),
    (&["box", "bbox", "bboxes", "bounding-boxes"], "enfilade run OUT --only boxes"),
    (&["previews", "sheet", "contact-sheet", "thumbnails"], "enfilade run OUT --only preview"),
    (&["denoiser"], "enfilade run OUT --color denoised"),
    (&["camera", "cameras", "intrinsics", "calibration"], "enfilade inspect OUT --cameras"),
    (&["segment", "segmentation", "classes", "instance", "instances", "mask", "masks", "semantics"], "enfilade label OUT"),
    (&["split", "splits", "divide", "train", "val"], "enfilade partition OUT"),
    (&["ingest"], "enfilade import FOLDER -o FILE.json"),
    (&["man", "manual", "manpages"], "enfilade completions --man DIR"),
    (&["convert", "load", "open"], "enfilade import FILE"),
    (&["generate", "create", "new", "demo", "start", "resume", "continue", "dataset"], "enfilade run --demo out"),
    (&["house", "apartment", "scene"], "enfilade home"),
    (&["serve", "show", "browse", "gui", "web"], "enfilade view OUT"),
    (&["check", "validate", "test"], "enfilade verify OUT"),
    (&["video", "film", "gif", "mp4"], "enfilade animate OUT"),
    (&["statistics", "histogram", "charts"], "enfilade stats OUT"),
    (&["estimate", "cost", "costs", "price", "forecast"], "enfilade run DATASET.TOML --estimate"),
    (&["slurm", "cluster", "distribute", "submit"], "enfilade farm"),
    (&["photo", "picture", "snapshot"], "enfilade look SCENE"),
];

/// The problem to report instead of clap's, if the unknown word is in the table.
pub fn of(error: &clap::Error) -> Option<Problem> {
    let text = |kind: ContextKind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.as_str()),
        _ => None,
    };
    let (word, place) = match error.kind() {
        ErrorKind::InvalidSubcommand => (text(ContextKind::InvalidSubcommand)?, "a verb"),
        ErrorKind::InvalidValue => match text(ContextKind::InvalidArg)? {
            arg if arg.contains("WHAT") => (text(ContextKind::InvalidValue)?, "something that `make` makes"),
            arg if arg.starts_with("--only") => (text(ContextKind::InvalidValue)?, "a stage"),
            _ => return None,
        },
        _ => return None,
    };
    let command = leads_to(word)?;
    Some(Problem::new(format!("{word:?} is not {place}"), format!("did you mean `{command}`? Everything there is: enfilade --help")))
}

/// The command that a word is about.
fn leads_to(word: &str) -> Option<String> {
    if let Ok(StageArg(stage)) = StageArg::from_str(word, true) {
        return Some(format!("enfilade run OUT --only {}", stage.name()));
    }
    if let Some(product) = Product::ON_REQUEST.into_iter().find(|product| product.name().eq_ignore_ascii_case(word)) {
        return Some(example(product));
    }
    let lower = word.to_lowercase();
    let known = WORDS.iter().find(|(words, _)| words.contains(&lower.as_str())).map(|(_, command)| (*command).to_string());
    known.or_else(|| leads_to_data(&lower))
}

/// The command that a layer of frames or a format is about.
fn leads_to_data(word: &str) -> Option<String> {
    if Format::from_name(word).is_some() {
        return Some(format!("enfilade export OUT --format {word} -o FOLDER"));
    }
    let is_layer = Layer::from_name(word).is_some() || ["depth", "normal", "normals", "albedo", "rgb", "image", "images"].contains(&word);
    is_layer.then(|| "enfilade view OUT`, or `enfilade export OUT --format exr -o FOLDER".into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::Cli;
    use clap::CommandFactory;
    use std::collections::BTreeSet;

    fn told(words: &str) -> Option<String> {
        let words: Vec<_> = words.split(' ').map(Into::into).collect();
        Cli::of(&words).err().and_then(|error| of(&error)).map(|problem| format!("{problem:?}"))
    }

    #[test]
    fn words_of_newcomers_lead_to_what_they_mean() {
        for (words, command) in [
            ("enfilade depth out", "enfilade export OUT --format exr"),
            ("enfilade segment out", "enfilade label OUT"),
            ("enfilade caption out", "enfilade make OUT words"),
            ("enfilade flow out --step 1", "enfilade make OUT flow"),
            ("enfilade camera out", "enfilade inspect OUT --cameras"),
            ("enfilade render out --force", "enfilade run OUT --only render"),
            ("enfilade denoise out", "enfilade run OUT --only denoise"),
            ("enfilade layout out", "enfilade make OUT rooms"),
            ("enfilade sense out sensors.toml", "enfilade make OUT sensors --sensors"),
            ("enfilade split out", "enfilade partition OUT"),
            ("enfilade coco out", "enfilade export OUT --format coco"),
            ("enfilade make out layout", "enfilade make OUT rooms"),
            ("enfilade make out preview", "enfilade run OUT --only preview"),
            ("enfilade run out --only pairs", "enfilade make OUT pairs"),
        ] {
            let found = told(words).unwrap_or_default();
            assert!(found.contains(command), "{words}: {found}");
        }
        assert_eq!((told("enfilade xyzzy"), told("enfilade export out --format pairs -o x"), told("enfilade --help")), (None, None, None));
    }

    #[test]
    fn no_word_is_listed_twice_or_hides_a_verb() {
        let words: Vec<&str> = WORDS.iter().flat_map(|(words, _)| words.iter().copied()).collect();
        let distinct: BTreeSet<&str> = words.iter().copied().collect();
        assert_eq!(distinct.len(), words.len());
        let command = Cli::command();
        assert!(words.iter().all(|word| command.find_subcommand(word).is_none()));
    }

    #[test]
    fn every_command_that_is_proposed_is_one() {
        let names: Vec<String> = Cli::command().get_subcommands().map(|verb| verb.get_name().to_string()).collect();
        for (words, command) in WORDS {
            let verb = command.split(' ').nth(1).unwrap();
            assert!(names.iter().any(|name| name == verb), "{words:?}: {command}");
        }
    }
}
