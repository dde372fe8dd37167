//! How good suggestions are on scenes that were held out, and what they save: `cargo xtask bench suggest`
//!
//! Reads Hypersim's names from `hypersim-real/` below `ENFILADE_SCENES`, and the rooms there for a test on names of others; writes
//! `docs/benchmarks/suggest.md` and `suggest.json`.

mod actions;
mod measured;
mod others;
mod pairs;
mod peers;
mod report;
mod scores;

use enfilade_suggest::learn::{LearnConfig, NamedObject, Split, group, held_out, read_names, with_curtains};
use enfilade_suggest::lexicon::Lexicon;
use enfilade_suggest::{Suggester, Suggestion};
use measured::{FOLDS, Measured};
use scores::Judgement;
use std::error::Error;
use std::path::PathBuf;

/// Runs the instrument.
pub fn run() -> Result<(), Box<dyn Error>> {
    let Some(scenes) = std::env::var_os("ENFILADE_SCENES").map(PathBuf::from) else {
        println!("skipped: ENFILADE_SCENES names no folder with hypersim-real/object_names_nyu40.csv");
        return Ok(());
    };
    let path = scenes.join("hypersim-real/object_names_nyu40.csv");
    let bytes = std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let objects: Vec<NamedObject> = read_names(&bytes, &path.display().to_string())?;
    let raw = group(&objects);
    let lexicon = Lexicon::builtin()?;
    let groups = with_curtains(&raw, &lexicon);
    let config = LearnConfig::default();
    let mut unlike = 0;
    let mut measured = Vec::new();
    let mut of_two = Vec::new();
    let suggester = Suggester::builtin();
    let threshold = suggester.min_confidence(0.9).ok_or("no threshold for 90 %")?;
    for split in [Split::Scene, Split::Volume] {
        let held_out = held_out(&groups, &lexicon, &config, split, FOLDS);
        let ours = held_out.suggestions.clone();
        of_two = pairs::measure(&held_out, &groups, threshold);
        unlike = groups.iter().zip(&raw).filter(|(a, b)| a != b).count();
        measured.push((
            Measured {
                split,
                ours: Judgement::new(&groups, ours.clone()),
                lookup: Judgement::new(&groups, peers::lookup(&groups, split, FOLDS)),
                keyword: Judgement::new(&groups, peers::keyword(&groups)),
            },
            Judgement::new(&raw, ours),
        ));
    }
    let suggestions: [&[Option<Suggestion>]; 2] = [&measured[1].0.ours.suggestions, &measured[1].0.lookup.suggestions];
    let saved = suggestions.map(|list| actions::per_scene(&objects, &groups, list, threshold));
    let others = others::measure(&suggester, &scenes)?;
    let report = report::Report {
        objects: &objects,
        groups: &groups,
        measured: &measured,
        curtains: unlike,
        saved: &saved,
        of_two: &of_two,
        others: &others,
        threshold,
        suggester: &suggester,
    };
    report.write(&PathBuf::from("docs/benchmarks"))?;
    Ok(())
}
