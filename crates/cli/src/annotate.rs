//! `annotate`: from arguments to a page in the browser.

use crate::args::{AnnotateArgs, ListenArgs};
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use enfilade_label_page::{AnnotateOptions, App, PAGE, routes};
use enfilade_serve::{Listen, serve};
use std::sync::Arc;

/// `annotate`: serves the page until the program is asked to end.
pub fn annotate(args: &AnnotateArgs, quiet: bool) -> Result<Verdict, Problem> {
    let options = AnnotateOptions {
        path: args.input.clone(),
        scene: args.scene.clone(),
        labels: args.labels.clone(),
        carry: args.carry.clone(),
        classes: args.classes.clone(),
        meters_per_unit: args.meters_per_unit,
        up_axis: args.up_axis,
    };
    let app = {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.input.display().to_string(), "annotate");
        let app = App::open(&options, &cx).map_err(|e| Problem::found(&e))?;
        drop(cx);
        Arc::new(app)
    };
    say(&format!("labels   {}", app.labels_folder().display()));
    let served = serve(routes(app.clone()), PAGE, &args.listen.listen(), |addresses| {
        say(&addresses.to_string());
        say("End with Ctrl-C; every edit is on the disk as soon as the page shows it.");
    });
    app.close()?;
    served.map_err(|e| Problem::found(&e))?;
    Ok(Verdict::Done)
}

impl ListenArgs {
    /// The address to listen on, and what to do once the server listens.
    pub fn listen(&self) -> Listen {
        Listen { address: self.host, port: self.port, token: self.token, open: !self.no_open }
    }
}
