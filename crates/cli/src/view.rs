//! `view`: the page that shows a dataset.

use crate::args::ViewArgs;
use crate::outcome::{Problem, Verdict, say};
use enfilade_serve::serve;
use enfilade_view_page::{PAGE, Viewer, router};

/// `view`: serves the page until it is asked to end.
pub fn view(args: &ViewArgs) -> Result<Verdict, Problem> {
    let viewer = Viewer::of(args.table.open(&args.dataset)?);
    serve(router(viewer), PAGE, &args.listen.listen(), |addresses| say(&format!("{addresses}\nEnd with Ctrl-C.")))?;
    Ok(Verdict::Done)
}
