//! `view`: the page that shows a dataset.

use crate::args::ViewArgs;
use crate::outcome::{Problem, Verdict, say};
use enfilade_serve::serve;
use enfilade_view_page::{PAGE, Viewer, router};

/// `view`: serves the page until it is asked to end.
pub fn view(args: &ViewArgs) -> Result<Verdict, Problem> {
    let dataset = args.table.open_or_await(&args.dataset)?;
    if dataset.scenes().map_or(true, |scenes| scenes.is_empty()) {
        say(&format!("{} has no scenes yet; the page shows them as they are made.", args.dataset.display()));
    }
    let viewer = Viewer::of(dataset);
    serve(router(viewer), PAGE, &args.listen.listen(), |addresses| say(&format!("{addresses}\nEnd with Ctrl-C.")))?;
    Ok(Verdict::Done)
}
