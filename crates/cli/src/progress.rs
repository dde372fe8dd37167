//! Progress of a run: a live line on a terminal, plain lines at intervals anywhere else.

use enfilade_pipeline::{Event, Product, Reporter, Stage};
use enfilade_scene::{Cx, Warning};
use indicatif::{ProgressBar, ProgressStyle};
use std::borrow::Borrow;
use std::io::{IsTerminal, Write};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// A silent program looks stuck after about this long.
const INTERVAL: Duration = Duration::from_secs(5);
/// Warnings shown per stage; the record of the stage has all.
const WARNINGS_SHOWN: usize = 3;

/// Writes to standard error.
pub struct Progress {
    state: Arc<Mutex<State>>,
    stop: Option<Sender<()>>,
    heart: Option<JoinHandle<()>>,
}

struct State {
    quiet: bool,
    bar: Option<ProgressBar>,
    scene: String,
    stage: &'static str,
    running: bool,
    what: String,
    fraction: f64,
    began: Instant,
    last_line: Instant,
    warnings: usize,
}

impl Progress {
    /// Reports to standard error, or with `quiet` nowhere.
    pub fn new(quiet: bool) -> Self {
        let now = Instant::now();
        let live = !quiet && std::io::stderr().is_terminal();
        let state = Arc::new(Mutex::new(State {
            quiet,
            bar: live.then(new_bar),
            scene: String::new(),
            stage: "",
            running: false,
            what: String::new(),
            fraction: 0.0,
            began: now,
            last_line: now,
            warnings: 0,
        }));
        let (stop, stopped) = channel();
        let beating = state.clone();
        let heart = || std::thread::Builder::new().spawn(move || beat(&beating, &stopped));
        // Where the system gives no further thread, the run goes on without these signs of life.
        let heart = (!quiet && !live).then(heart).and_then(Result::ok);
        Self { state, stop: Some(stop), heart }
    }

    /// The [`Cx`] for work outside a dataset.
    pub fn cx<'a>(&'a self, name: &'a str, stage: Stage) -> impl Cx + 'a {
        SingleCx { progress: self, name, stage }
    }

    /// Begins work on `name` that is no stage of the pipeline, and gives its [`Cx`].
    pub fn begin(&self, name: &str, verb: &'static str) -> impl Cx + '_ {
        self.start(name, verb);
        VerbCx(self)
    }

    /// The [`Cx`] of work on `name` that is no stage of the pipeline, and all that is reported.
    pub fn begun(self, name: &str, verb: &'static str) -> impl Cx + use<> {
        self.start(name, verb);
        VerbCx(self)
    }

    fn start(&self, name: &str, verb: &'static str) {
        let mut state = self.lock();
        if !state.quiet {
            state.start(name, verb);
        }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        let mut state = self.lock();
        if state.running {
            state.count_the_rest();
        }
        drop(state);
        if let Some(bar) = self.lock().bar.take() {
            bar.finish_and_clear();
        }
        self.stop.take();
        if let Some(heart) = self.heart.take() {
            let _ = heart.join(); // it cannot fail in a way that matters at the end
        }
    }
}

impl Reporter for Progress {
    fn on(&self, scene: &str, stage: Stage, event: Event) {
        self.hear(scene, stage.name(), event);
    }

    fn on_product(&self, scene: &str, product: Product, event: Event) {
        self.hear(if scene.is_empty() { "dataset" } else { scene }, product.name(), event);
    }
}

impl Progress {
    /// Shows what happens to a stage or a product of a scene.
    fn hear(&self, scene: &str, name: &'static str, event: Event) {
        let mut state = self.lock();
        if state.quiet {
            return;
        }
        match event {
            Event::Started => state.start(scene, name),
            Event::Progress { what, done, total } => state.progress(what, done, total),
            Event::Warned(warning) => state.warn(warning),
            Event::UpToDate => {
                state.heading(scene);
                state.line(&format!("  {name:<8} nothing to do"));
            }
            Event::Finished { summary, wall_s } => {
                state.count_the_rest();
                state.end();
                state.line(&format!("  {name:<8} {summary} ({wall_s:.1} s)"));
            }
            // The reason is reported once, at the end.
            Event::Failed { .. } => {
                state.heading(scene);
                state.count_the_rest();
                state.end();
                state.line(&format!("  {name:<8} FAILED"));
            }
        }
    }
}

impl State {
    fn heading(&mut self, scene: &str) {
        if self.scene != scene {
            self.scene = scene.to_string();
            self.line(scene);
        }
    }

    fn start(&mut self, scene: &str, stage: &'static str) {
        self.heading(scene);
        (self.stage, self.running, self.warnings, self.fraction) = (stage, true, 0, 0.0);
        self.what.clear();
        self.began = Instant::now();
        if let Some(bar) = &self.bar {
            bar.reset_elapsed();
        }
        self.show();
    }

    fn end(&mut self) {
        self.running = false;
        if let Some(bar) = &self.bar {
            bar.set_message("");
            bar.set_prefix("");
            bar.set_position(0);
        }
    }

    fn progress(&mut self, what: &str, done: u64, total: u64) {
        if self.what != what {
            self.what = what.to_string();
        }
        self.fraction = done as f64 / total.max(1) as f64;
        self.show();
    }

    fn warn(&mut self, warning: &Warning) {
        self.warnings += 1;
        if self.warnings <= WARNINGS_SHOWN {
            self.line(&format!("  {:<8} warning: {warning}", self.stage));
        }
    }

    /// Prints how many warnings of the work that is running were not shown.
    fn count_the_rest(&mut self) {
        let more = self.warnings.saturating_sub(WARNINGS_SHOWN);
        if more > 0 {
            self.line(&format!("  {:<8} … and {more} more warning{}", "", if more == 1 { "" } else { "s" }));
        }
    }

    fn show(&self) {
        if let Some(bar) = &self.bar {
            bar.set_prefix(format!("{:<8}", self.stage));
            bar.set_message(self.what.clone());
            bar.set_position((self.fraction * 1000.0) as u64);
        }
    }

    fn line(&mut self, text: &str) {
        self.last_line = Instant::now();
        match &self.bar {
            Some(bar) => bar.println(text),
            None => {
                let _ = writeln!(std::io::stderr(), "{text}"); // nowhere left to report it
            }
        }
    }
}

fn new_bar() -> ProgressBar {
    let bar = ProgressBar::new(1000);
    if let Ok(style) = ProgressStyle::with_template("  {prefix} {spinner} {bar:30} {percent:>3} % {elapsed:>4} {msg}") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// Prints the state of the work whenever nothing was printed for a while.
fn beat(state: &Mutex<State>, stopped: &Receiver<()>) {
    while stopped.recv_timeout(Duration::from_millis(500)) == Err(RecvTimeoutError::Timeout) {
        let mut state = state.lock().unwrap_or_else(PoisonError::into_inner);
        if state.running && state.last_line.elapsed() >= INTERVAL {
            let seconds = state.began.elapsed().as_secs();
            let text = format!("  {:<8} {:.0} % {} ({seconds} s)", state.stage, 100.0 * state.fraction, state.what);
            state.line(&text);
        }
    }
}

/// Progress of one file without a dataset.
struct VerbCx<P: Borrow<Progress>>(P);

impl<P: Borrow<Progress> + Sync> Cx for VerbCx<P> {
    fn progress(&self, what: &str, done: u64, total: u64) {
        let shared: &Progress = self.0.borrow();
        let mut state = shared.lock();
        if !state.quiet {
            state.progress(what, done, total);
        }
    }

    fn warn(&self, warning: Warning) {
        let shared: &Progress = self.0.borrow();
        let mut state = shared.lock();
        if !state.quiet {
            state.warn(&warning);
        }
    }
}

impl<P: Borrow<Progress>> Drop for VerbCx<P> {
    fn drop(&mut self) {
        let shared: &Progress = self.0.borrow();
        shared.lock().count_the_rest();
    }
}

struct SingleCx<'a> {
    progress: &'a Progress,
    name: &'a str,
    stage: Stage,
}

impl Cx for SingleCx<'_> {
    fn progress(&self, what: &str, done: u64, total: u64) {
        self.progress.on(self.name, self.stage, Event::Progress { what, done, total });
    }

    fn warn(&self, warning: Warning) {
        self.progress.on(self.name, self.stage, Event::Warned(&warning));
    }
}
