//! `[farm]`: what a node of a farm does with every frame that it has finished, as Hypersim's cloud let users run code of their own.
//!
//! `after_frame = ["program", "argument", …]` is run without a shell. In its arguments stand placeholders, which are filled in for every
//! frame; `{{` and `}}` stand for single braces.

use enfilade_options::{closest, options};
use serde::{Deserialize, Serialize};
use std::ffi::OsString;
use std::path::Path;

/// A program that takes longer than an hour for a frame, which is longer than most take to be rendered, hangs.
const TIMEOUT_S: f64 = 3600.0;

options! {
    /// What nodes of a farm do besides rendering.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct FarmConfig keys pub(super) FarmKeys {
        /// The program that a node runs after every frame, and its arguments; empty where there is none.
        pub after_frame: Vec<String> = Vec::new(),
        /// Seconds on the wall clock after which that program is ended, which is a failure.
        pub after_frame_timeout_s: f64 = TIMEOUT_S,
    }
}

/// What stands in an argument for something of the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placeholder {
    /// The dataset's folder on the node, in which of all frames there is only this one.
    FrameDir,
    /// An empty folder, whose files are committed with the frame.
    OutDir,
    /// Name of the scene.
    Scene,
    /// Name of the trajectory.
    Camera,
    /// Number of the frame in four digits, as in the names of files.
    Frame,
}

impl Placeholder {
    const NAMES: [(&'static str, Self); 5] = [
        ("frame_dir", Self::FrameDir),
        ("out_dir", Self::OutDir),
        ("scene", Self::Scene),
        ("camera", Self::Camera),
        ("frame", Self::Frame),
    ];

    fn of(name: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(known, _)| *known == name).map(|&(_, placeholder)| placeholder)
    }
}

/// Why a value of `[farm]` cannot be.
pub(super) struct FarmProblem {
    pub key: &'static str,
    /// What was found and what was expected.
    pub message: String,
    /// What to write instead.
    pub help: String,
}

impl FarmConfig {
    /// True when nothing of it was asked for.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Checks everything but whether the program is there, which only the nodes know.
    ///
    /// # Errors
    /// The first value that cannot be.
    pub(super) fn validate(&self) -> Result<(), FarmProblem> {
        let refuse = |key, message: String, help: &str| Err(FarmProblem { key, message, help: help.into() });
        let limit = self.after_frame_timeout_s;
        if !(limit > 0.0 && limit.is_finite()) {
            let message = format!("after_frame_timeout_s must be above 0, found {limit}");
            return refuse("after_frame_timeout_s", message, "for example: after_frame_timeout_s = 600");
        }
        let Some((program, arguments)) = self.after_frame.split_first() else { return Ok(()) };
        let key = "after_frame";
        if program.trim().is_empty() || program.contains(['{', '}']) {
            let message = format!("after_frame begins with {program:?}; expected the name of a program, without placeholders");
            return refuse(key, message, EXAMPLE);
        }
        if Path::new(program).components().count() > 1 && !Path::new(program).is_absolute() {
            let message = format!("after_frame begins with the path {program:?}, which is relative, and nodes do not run in your folder");
            return refuse(key, message, "write an absolute path that every node has, or the name of a program that is found by PATH");
        }
        if let Some(argument) = self.after_frame.iter().find(|argument| argument.contains('\0')) {
            let message = format!("after_frame: {argument:?} has a zero byte, which no argument can have");
            return refuse(key, message, EXAMPLE);
        }
        match arguments.iter().find_map(|argument| pieces(argument).err()) {
            Some((message, help)) => Err(FarmProblem { key, message: format!("after_frame: {message}"), help }),
            None => Ok(()),
        }
    }

    /// The program and its arguments, with what `fill` says for the placeholders; `None` where there is no program.
    pub fn command(&self, fill: impl Fn(Placeholder) -> OsString) -> Option<(&str, Vec<OsString>)> {
        let (program, arguments) = self.after_frame.split_first()?;
        let filled = |argument: &String| {
            // Arguments that cannot be read were refused with the configuration.
            let pieces = pieces(argument).unwrap_or_else(|_| vec![Piece::Text(argument)]);
            pieces.into_iter().fold(OsString::new(), |mut filled, piece| {
                match piece {
                    Piece::Text(text) => filled.push(text),
                    Piece::Place(placeholder) => filled.push(fill(placeholder)),
                }
                filled
            })
        };
        Some((program, arguments.iter().map(filled).collect()))
    }

    /// A line for a run on this machine alone, where a program is named that it does not run.
    pub(crate) fn not_run_here(&self) -> Option<String> {
        let program = self.after_frame.first()?;
        Some(format!(
            "[farm] after_frame ({program:?}) was not run: nodes of a farm do that, not `run`; to run it here too, make the dataset by \
             `enfilade farm plan`, `work` and `collect`"
        ))
    }
}

const EXAMPLE: &str = "for example: after_frame = [\"python3\", \"/shared/features.py\", \"{frame_dir}\", \"{scene}\", \"{camera}\", \"{frame}\", \"{out_dir}\"]";

/// A part of an argument.
enum Piece<'a> {
    Text(&'a str),
    Place(Placeholder),
}

/// What an argument is made of.
///
/// # Errors
/// For a brace that is single and a placeholder that is not known: what is wrong, and what to do.
fn pieces(argument: &str) -> Result<Vec<Piece<'_>>, (String, String)> {
    let (mut pieces, mut rest) = (Vec::new(), argument);
    while let Some(at) = rest.find(['{', '}']) {
        let (text, brace, after) = (&rest[..at], &rest[at..=at], &rest[at + 1..]);
        pieces.push(Piece::Text(text));
        if let Some(after) = after.strip_prefix(brace) {
            pieces.push(Piece::Text(brace));
            rest = after;
            continue;
        }
        let end = if brace == "{" { after.find('}') } else { None };
        let Some(end) = end else {
            return Err((format!("{argument:?} has a single {brace}"), format!("write {brace}{brace} for one that is meant as it is")));
        };
        let placeholder = Placeholder::of(&after[..end]).ok_or_else(|| unknown(&after[..end]))?;
        pieces.push(Piece::Place(placeholder));
        rest = &after[end + 1..];
    }
    pieces.push(Piece::Text(rest));
    Ok(pieces)
}

fn unknown(name: &str) -> (String, String) {
    let names = Placeholder::NAMES.map(|(name, _)| name);
    let proposal = closest(name, &names).map_or(String::new(), |near| format!("did you mean {{{near}}}? "));
    let known = names.map(|name| format!("{{{name}}}")).join(", ");
    (format!("there is no placeholder {{{name}}}"), format!("{proposal}the placeholders are {known}; write {{{{ and }}}} for braces"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config(words: &[&str]) -> FarmConfig {
        FarmConfig { after_frame: words.iter().map(ToString::to_string).collect(), ..FarmConfig::default() }
    }

    fn filled(words: &[&str]) -> Vec<String> {
        let config = config(words);
        assert!(config.validate().is_ok(), "{words:?}");
        let fill = |placeholder| match placeholder {
            Placeholder::FrameDir => "/node/frame".into(),
            Placeholder::OutDir => "/node/out".into(),
            Placeholder::Scene => "room".into(),
            Placeholder::Camera => "cam_00".into(),
            Placeholder::Frame => "0007".into(),
        };
        let (_, arguments) = config.command(fill).unwrap();
        arguments.into_iter().map(|argument| argument.into_string().unwrap()).collect()
    }

    #[test]
    fn placeholders_are_filled_in_and_doubled_braces_stay_single() {
        let words =
            ["tool", "{frame_dir}/scenes/{scene}/scene_{camera}/frame.{frame}.hdf5", "{out_dir}", "{{\"a\": {{{frame}}}}}", "$HOME; x", ""];
        let expected = ["/node/frame/scenes/room/scene_cam_00/frame.0007.hdf5", "/node/out", "{\"a\": {0007}}", "$HOME; x", ""];
        assert_eq!(filled(&words), expected);
        assert!(config(&[]).command(|_| OsString::new()).is_none());
    }

    #[test]
    fn commands_that_cannot_be_are_refused_with_what_to_write() {
        let said = |config: &FarmConfig| {
            let problem = config.validate().err().unwrap();
            format!("{}: {}; {}", problem.key, problem.message, problem.help)
        };
        for (words, expected) in [
            (
                vec!["tool", "{frame_dri}"],
                "there is no placeholder {frame_dri}; did you mean {frame_dir}? the placeholders are {frame_dir},",
            ),
            (vec!["tool", "{}"], "there is no placeholder {}"),
            (vec!["tool", "a{b"], "\"a{b\" has a single {; write {{ for one"),
            (vec!["tool", "a}"], "\"a}\" has a single }; write }} for one"),
            (vec!["", "x"], "after_frame begins with \"\"; expected the name of a program"),
            (vec!["{scene}"], "without placeholders"),
            (vec!["./tool"], "the path \"./tool\", which is relative"),
            (vec!["tool", "a\0b"], "has a zero byte"),
        ] {
            let found = said(&config(&words));
            assert!(found.starts_with("after_frame: ") && found.contains(expected), "{found}");
        }
        let found = said(&FarmConfig { after_frame_timeout_s: f64::NAN, ..config(&["tool"]) });
        assert!(found.contains("must be above 0, found NaN"), "{found}");
    }
}
