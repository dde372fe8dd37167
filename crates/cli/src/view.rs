//! `view`: the page that shows a dataset.

use crate::args::ViewArgs;
use crate::outcome::{Problem, Verdict, say};
use enfilade_annotate::serve::serve;
use enfilade_annotate::view::{Viewer, router};

/// `view`: serves the page until it is asked to end.
pub fn view(args: &ViewArgs) -> Result<Verdict, Problem> {
    let viewer = Viewer::of(args.table.open(&args.dataset)?);
    serve(router(viewer), &args.listen.listen(), "/view/", |addresses| say(&format!("{addresses}\nEnd with Ctrl-C.")))?;
    Ok(Verdict::Done)
}
