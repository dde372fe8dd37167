//! `make`: what can be made of finished frames without rendering, a noun for each.

mod flow;
mod frames;
mod pairs;
mod relit;
mod rooms;
mod sensors;
mod surfaces;
mod tracks;
mod words;

pub use frames::cameras;

use crate::args::{MakeArgs, What};
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use enfilade_dataset::Dataset;
use enfilade_scene::Cx;

/// Makes what one noun says of a dataset, and adds what there is to say of it, line by line.
type Maker = fn(&MakeArgs, &Dataset, &mut Vec<String>, &dyn Cx) -> Result<(), Problem>;

/// The function of each noun.
const fn maker(what: What) -> Maker {
    match what {
        What::Pairs => pairs::pairs,
        What::Flow => flow::flow,
        What::Tracks => tracks::tracks,
        What::Surfaces => surfaces::surfaces,
        What::Rooms => rooms::rooms,
        What::Words => words::words,
        What::Sensors => sensors::sensors,
        What::Relit => relit::relit,
    }
}

/// `make`: each noun once, in the order of [`What`], so that what one needs of another is there.
pub fn make(args: &MakeArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = args.table.open(&args.dataset)?;
    let mut nouns = args.what.clone();
    nouns.sort();
    nouns.dedup();
    for what in nouns {
        let mut lines = Vec::new();
        let made = {
            let progress = Progress::new(quiet);
            let cx = progress.begin(&args.dataset.display().to_string(), what.name());
            maker(what)(args, &dataset, &mut lines, &cx)
        };
        lines.iter().for_each(|line| say(line));
        made?;
    }
    Ok(Verdict::Done)
}
