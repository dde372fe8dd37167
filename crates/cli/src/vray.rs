//! `vray`: the verbs of the crate `vray`, with this program's output.

use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use enfilade_scene::Cx;
use enfilade_vray::verbs::{self, Console, VrayArgs};

/// Edits V-Ray's scenes, writes jobs for it, or collects its images.
pub fn vray(args: &VrayArgs, quiet: bool) -> Result<Verdict, Problem> {
    verbs::vray(args, &Terminal { quiet })?;
    Ok(Verdict::Done)
}

/// Standard output for results, standard error for progress.
struct Terminal {
    quiet: bool,
}

impl Console for Terminal {
    fn say(&self, line: &str) {
        say(line);
    }

    fn begin(&self, name: &str, verb: &'static str) -> Box<dyn Cx + '_> {
        Box::new(Progress::new(self.quiet).begun(name, verb))
    }
}
