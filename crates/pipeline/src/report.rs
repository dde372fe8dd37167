//! Reports of a run: to a [`Reporter`] while it continues, and in a [`Summary`] at its end.

use crate::request::Product;
use crate::stage::Stage;
use crate::workdir::Hash;
use enfilade_dataset::FrameTime;
use enfilade_scene::{Cx, Warning};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// An event of a stage of a scene.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// The stage begins.
    Started,
    /// `done` of `total` units of `what` are finished.
    Progress {
        /// The unit, such as "frames".
        what: &'a str,
        /// How many are finished.
        done: u64,
        /// Number of all units.
        total: u64,
    },
    /// Something was dropped, guessed or fixed.
    Warned(&'a Warning),
    /// Nothing had to be done.
    UpToDate,
    /// The stage is done.
    Finished {
        /// One line: what it made.
        summary: &'a str,
        /// Seconds on the wall clock.
        wall_s: f64,
    },
    /// The stage could not be done; the scene's later stages are left out.
    Failed {
        /// One line with all causes.
        message: &'a str,
    },
}

/// Hears what a run does, from any thread.
pub trait Reporter: Sync {
    /// Something happened to `stage` of `scene`.
    fn on(&self, scene: &str, stage: Stage, event: Event);

    /// Something happened to `product` of `scene`, whose name is empty for the dataset as a whole.
    fn on_product(&self, _scene: &str, _product: Product, _event: Event) {}
}

/// A [`Reporter`] that hears nothing.
pub struct Silent;

impl Reporter for Silent {
    fn on(&self, _scene: &str, _stage: Stage, _event: Event) {}
}

/// Result of a run.
#[derive(Clone, Debug)]
pub struct Summary {
    /// Outcomes of the scenes, in the order of the configuration.
    pub scenes: Vec<SceneOutcome>,
    /// Warnings about the dataset as a whole, a line each.
    pub warnings: Vec<String>,
    /// Results of products of the dataset as a whole.
    pub products: Vec<ProductOutcome>,
    /// Seconds on the wall clock.
    pub wall_s: f64,
}

impl Summary {
    /// True if every scene and every product succeeded.
    pub fn ok(&self) -> bool {
        self.scenes.iter().all(|s| s.failure.is_none()) && self.all_products().all(|product| product.failure.is_none())
    }

    /// Results of products, in scenes and in the dataset as a whole.
    pub fn all_products(&self) -> impl Iterator<Item = &ProductOutcome> {
        self.scenes.iter().flat_map(|scene| &scene.products).chain(&self.products)
    }

    /// True when no stage and no product had anything to do.
    pub fn nothing_done(&self) -> bool {
        let is_idle = self.scenes.iter().flat_map(|s| &s.stages).all(|s| s.up_to_date);
        self.ok() && is_idle && self.all_products().all(|product| product.made == 0)
    }
}

/// Result of one scene.
#[derive(Clone, Debug)]
pub struct SceneOutcome {
    /// Name of the scene in the dataset.
    pub name: String,
    /// The stages that succeeded, in order.
    pub stages: Vec<StageOutcome>,
    /// Results of its products.
    pub products: Vec<ProductOutcome>,
    /// The failure of the stage that did not succeed, if any.
    pub failure: Option<Failure>,
}

impl SceneOutcome {
    /// True when an earlier stage than this one failed.
    pub(crate) fn stopped_before(&self, stage: Stage) -> bool {
        self.failure.as_ref().is_some_and(|failure| failure.stage < stage)
    }
}

/// Result of one stage of a scene.
#[derive(Clone, Debug)]
pub struct StageOutcome {
    /// Which.
    pub stage: Stage,
    /// True when it was skipped because nothing changed.
    pub up_to_date: bool,
    /// One line: what it made (now or earlier).
    pub summary: String,
    /// Number of warnings in its report.
    pub warnings: usize,
    /// Seconds on the wall clock, of this run.
    pub wall_s: f64,
    /// Key of its inputs.
    pub(crate) key: Hash,
}

/// Result of a product of a scene, or of the dataset as a whole.
#[derive(Clone, Debug)]
pub struct ProductOutcome {
    /// Which.
    pub product: Product,
    /// The scene; `None` for the dataset as a whole.
    pub scene: Option<String>,
    /// Parts that were made.
    pub made: usize,
    /// Lines about what was made.
    pub lines: Vec<String>,
    /// Why it could not be made, and what to do.
    pub failure: Option<(String, Option<String>)>,
}

/// Why a scene stopped.
#[derive(Clone, Debug)]
pub struct Failure {
    /// The stage that failed.
    pub stage: Stage,
    /// One line with all causes.
    pub message: String,
    /// What to do.
    pub hint: Option<String>,
}

/// The [`Cx`] that stages get: passes everything on and keeps the warnings for the stage's record.
pub(crate) struct StageCx<'a> {
    scene: &'a str,
    stage: Stage,
    reporter: &'a dyn Reporter,
    warnings: Mutex<Vec<Warning>>,
}

impl<'a> StageCx<'a> {
    pub fn new(scene: &'a str, stage: Stage, reporter: &'a dyn Reporter) -> Self {
        Self { scene, stage, reporter, warnings: Mutex::new(Vec::new()) }
    }

    pub fn event(&self, event: Event) {
        self.reporter.on(self.scene, self.stage, event);
    }

    /// The warnings in a fixed order: parallel stages warn in any.
    pub fn into_warnings(self) -> Vec<Warning> {
        let mut warnings = self.warnings.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        warnings.sort_by(|a, b| (&a.place, &a.message).cmp(&(&b.place, &b.message)));
        warnings
    }
}

impl Cx for StageCx<'_> {
    fn progress(&self, what: &str, done: u64, total: u64) {
        self.event(Event::Progress { what, done, total });
    }

    fn warn(&self, warning: Warning) {
        self.event(Event::Warned(&warning));
        self.warnings.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(warning);
    }
}

/// The [`Cx`] that the makers of products get: passes everything on, after saying that the product is begun.
pub(crate) struct ProductCx<'a> {
    /// The scene; empty for the dataset as a whole.
    scene: &'a str,
    product: Product,
    reporter: &'a dyn Reporter,
    has_begun: AtomicBool,
}

impl<'a> ProductCx<'a> {
    pub fn new(scene: &'a str, product: Product, reporter: &'a dyn Reporter) -> Self {
        Self { scene, product, reporter, has_begun: AtomicBool::new(false) }
    }

    pub fn event(&self, event: Event) {
        self.reporter.on_product(self.scene, self.product, event);
    }

    fn begin(&self) {
        if !self.has_begun.swap(true, Ordering::Relaxed) {
            self.event(Event::Started);
        }
    }
}

impl Cx for ProductCx<'_> {
    fn progress(&self, what: &str, done: u64, total: u64) {
        self.begin();
        self.event(Event::Progress { what, done, total });
    }

    fn warn(&self, warning: Warning) {
        self.begin();
        self.event(Event::Warned(&warning));
    }
}

/// Wall clock and processor time since its creation.
pub struct Stopwatch {
    wall: Instant,
    cpu_s: f64,
}

impl Stopwatch {
    /// Begins now.
    pub fn start() -> Self {
        Self { wall: Instant::now(), cpu_s: process_cpu_s() }
    }

    /// Seconds on the wall clock.
    pub fn wall_s(&self) -> f64 {
        self.wall.elapsed().as_secs_f64()
    }

    /// Processor seconds of all threads of this process; 0 if the system does not report them.
    pub fn cpu_s(&self) -> f64 {
        process_cpu_s() - self.cpu_s
    }

    /// The time and memory to record for one frame or more that began with this stopwatch.
    pub fn of_frame(&self) -> FrameTime {
        let threads = Some(rayon::current_num_threads() as u32);
        FrameTime { wall_s: self.wall_s(), cpu_s: self.cpu_s(), peak_memory_bytes: peak_memory_bytes(), threads }
    }
}

/// Peak memory of this process; `None` if the system does not report it.
pub(crate) fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok().map(|kib| 1024 * kib)
}

#[cfg(unix)]
fn process_cpu_s() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

#[cfg(not(unix))]
fn process_cpu_s() -> f64 {
    0.0
}

/// True if more threads want to run than the machine has, by the mean of the last minute; false if the system does not report it.
pub(crate) fn machine_is_busy() -> bool {
    let load = std::fs::read_to_string("/proc/loadavg").ok();
    let wanting: Option<f64> = load.and_then(|load| load.split_whitespace().next()?.parse().ok());
    let processors = std::thread::available_parallelism().map_or(1, usize::from) as f64;
    wanting.is_some_and(|wanting| wanting > 1.5 * processors)
}

/// Processor seconds of this thread; wall-clock seconds if the system does not report them.
pub(crate) fn thread_cpu_s() -> f64 {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
    }
    #[cfg(not(unix))]
    {
        static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
        START.get_or_init(Instant::now).elapsed().as_secs_f64()
    }
}
