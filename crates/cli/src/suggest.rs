//! `suggest`: a label table from the names in a scene file, and the parts that are left to people.

use crate::args::SuggestArgs;
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use enfilade_label::class_name;
use enfilade_pipeline::{FileSource, UnsurePart, suggest_labels};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Names of unsure parts that are printed; the table has all.
const SHOWN: usize = 20;

/// `suggest`: labels proposed for one scene file.
pub fn suggest(args: &SuggestArgs, quiet: bool) -> Result<Verdict, Problem> {
    let file = FileSource::of(args.input.to_string_lossy());
    let source = FileSource { up_axis: args.up_axis, allow_missing_textures: true, allow_missing_meshes: true, ..file };
    let output = args.output.clone().unwrap_or_else(|| {
        let stem = args.input.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy());
        PathBuf::from(format!("{stem}.labels.csv"))
    });
    let found = {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.input.display().to_string(), "suggest");
        suggest_labels(&source, args.min_confidence, &output, args.force, &cx)?
    };
    let sure = found.parts - found.unsure.len();
    let percent = 100.0 * sure as f64 / found.parts.max(1) as f64;
    say(&format!("{sure} of {} parts ({percent:.0} %) have a class with a confidence of {:.2} or more", found.parts, found.min_confidence));
    for (&class, count) in &found.classes {
        say(&format!("{count:7}  {}", class_name(class)));
    }
    print_unsure(&found.unsure);
    say(&format!("table    {}", output.display()));
    Ok(Verdict::Done)
}

/// The parts without a class, those of one name and material in one line, the most first.
fn print_unsure(unsure: &[UnsurePart]) {
    let mut lines: BTreeMap<String, usize> = BTreeMap::new();
    for part in unsure {
        let stem = part.part.trim_end_matches(|c: char| c.is_ascii_digit() || "._- ".contains(c));
        let guess = match &part.guess {
            Some(guess) => format!("perhaps {} ({:.2})", class_name(guess.class), guess.confidence),
            None => "the names say nothing".into(),
        };
        *lines.entry(format!("{} of {}: {guess}", if stem.is_empty() { &part.part } else { stem }, part.material)).or_default() += 1;
    }
    let mut lines: Vec<_> = lines.into_iter().collect();
    lines.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    if !lines.is_empty() {
        say(&format!("unsure of {} parts, which have -1 in the table:", unsure.len()));
    }
    lines.iter().take(SHOWN).for_each(|(line, count)| say(&format!("{count:7}  {line}")));
    if lines.len() > SHOWN {
        say(&format!("         and {} more; see the table", lines.len() - SHOWN));
    }
}
