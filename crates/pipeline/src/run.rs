//! Running stages over the scenes of a dataset: all of them, or one verb.

use crate::config::{Config, Overrides, SceneConfig};
use crate::error::Error;
use crate::intake::read_table;
use crate::partition::write_partition;
use crate::products::{Pictures, Place, adopt, bring_up_to_date, not_judged, pictures, told_out_of_date, update_sheet, update_statistics};
use crate::report::{Event, Failure, ProductOutcome, Reporter, SceneOutcome, StageCx, Stopwatch, Summary};
use crate::request::{PairsRequest, Request};
use crate::scene_types::write_scene_types;
use crate::stages::{CARD, Job, STAGES, Stage, StageSpec, advance, draw_plan};
use crate::workdir::{RUN, Workdir, read_json};
use enfilade_dataset::{CameraEntry, Dataset, FrameStatus, ManifestInfo, WORKDIR, remove_if_there, write_json};
use enfilade_scene::{Cx, Quiet, Warning};
use enfilade_show::report_card::write_report;
use enfilade_verify::{VerifyReport, join_reports, verify_listed_scene};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The stored data of a run with which single stages can be run again.
#[derive(Serialize, Deserialize)]
struct RunFile {
    base: PathBuf,
    /// [`Config::carried`], relative to the dataset's folder.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    carried: BTreeMap<String, PathBuf>,
    config: Config,
}

/// Names listed in a warning.
const NAMES_SHOWN: usize = 5;
/// The stages that make frames: `color` is what people load, so it is denoised where they render.
const RENDERING: [&StageSpec; 2] = [&STAGES[Stage::Render as usize], &STAGES[Stage::Denoise as usize]];
/// The stages that new labels make necessary.
const LABELLING: [&StageSpec; 2] = [&STAGES[Stage::Label as usize], &STAGES[Stage::Boxes as usize]];

/// Makes the dataset `config` in the folder `out`: every stage of every scene that is not up to date.
///
/// `pattern` restricts it to some scenes ([`Config::select`]). A scene that fails is reported and the others continue.
///
/// # Errors
/// Only what concerns the run as a whole: the output folder, the lock, the pattern.
pub fn run(config: &Config, out: &Path, pattern: Option<&str>, reporter: &dyn Reporter) -> Result<Summary, Error> {
    let scenes = config.select(pattern)?;
    let workdir = Workdir::create(out)?;
    store_config(&workdir, config)?;
    let stages: Vec<&StageSpec> = STAGES.iter().collect();
    let session = Session::with_products(config, &workdir)?;
    let mut summary = session.run(&scenes, &stages, false, reporter)?;
    summary.warnings.extend(session.unknown_scenes());
    summary.warnings.extend(config.farm.not_run_here());
    Ok(summary)
}

/// Runs one stage of the dataset in `out` with the configuration stored there. After rendering it also makes the colour layers and, for
/// labelled scenes, the labels; after new labels also the boxes of the labelled things.
///
/// # Errors
/// As [`run`], and if `out` is not a dataset.
pub fn run_stage(out: &Path, stage: Stage, pattern: Option<&str>, force: bool, reporter: &dyn Reporter) -> Result<Summary, Error> {
    let (workdir, config) = open(out)?;
    let scenes = config.select(pattern)?;
    let stages: &[&StageSpec] = match stage {
        Stage::Render => &RENDERING,
        Stage::Label => &LABELLING,
        other => &[other.spec()],
    };
    Session::new(&config, &workdir)?.run(&scenes, stages, force, reporter)
}

/// Runs some stages of the dataset `config` in `out`, as [`run`] runs all, in their order. After rendering it also makes the colour layers
/// and the labels; after new labels also the boxes of the labelled things. With `force`, stages that are up to date run too.
///
/// # Errors
/// As [`run`].
pub fn run_stages(
    config: &Config,
    out: &Path,
    stages: &[Stage],
    pattern: Option<&str>,
    force: bool,
    reporter: &dyn Reporter,
) -> Result<Summary, Error> {
    let scenes = config.select(pattern)?;
    let workdir = Workdir::create(out)?;
    let session = Session::new(config, &workdir)?;
    let asked = |stage: Stage| stages.contains(&stage);
    let wanted = |stage: Stage| {
        asked(stage)
            || match stage {
                Stage::Denoise => asked(Stage::Render),
                Stage::Boxes => asked(Stage::Label),
                _ => false,
            }
    };
    let specs: Vec<&StageSpec> = STAGES.iter().filter(|spec| wanted(spec.stage)).collect();
    store_config(&workdir, config)?;
    session.run(&scenes, &specs, force, reporter)
}

/// The stored settings of the dataset in `out`, with `overrides` for the scenes that match `pattern`; all seeds stay the same.
///
/// # Errors
/// When `out` is no dataset, and when a number is out of its range.
pub fn stored_config(out: &Path, overrides: &Overrides, pattern: Option<&str>) -> Result<Config, Error> {
    let (_workdir, mut config) = open(out)?;
    let chosen: Vec<String> = config.select(pattern)?.iter().map(|scene| scene.name.clone()).collect();
    let mut scenes = config.scenes.iter_mut().filter(|scene| chosen.contains(&scene.name));
    scenes.try_for_each(|scene| overrides.lay_over_stored(scene))?;
    Ok(config)
}

/// Draws the trajectories of the scenes of the dataset `config` in `out` that came through in `summary`, planned now or earlier. Returns the
/// page of each.
///
/// # Errors
/// When a picture cannot be made or written.
pub fn draw_plans(config: &Config, out: &Path, summary: &Summary, reporter: &dyn Reporter) -> Result<Vec<PathBuf>, Error> {
    let workdir = Workdir::open(out)?;
    let session = Session::new(config, &workdir)?;
    let came_through = |scene: &&SceneConfig| summary.scenes.iter().any(|done| done.name == scene.name && done.failure.is_none());
    let draw = |scene: &SceneConfig| {
        let job = Job::new(config, scene, &session.dataset, &workdir, false);
        draw_plan(&job, &StageCx::new(&scene.name, Stage::Plan, reporter))
    };
    config.scenes.iter().filter(came_through).map(draw).collect()
}

/// Checks every law for `scenes` of any dataset. If a scene that passed before fails now, its record is removed, so that the next [`run`]
/// verifies it again.
///
/// # Errors
/// When the manifest, or a file that a product is made from, cannot be read.
pub fn verify(dataset: &Dataset, scenes: &[String], cx: &dyn Cx) -> Result<VerifyReport, Error> {
    let manifest = dataset.read_manifest()?;
    let mut reports = Vec::new();
    for scene in scenes {
        let report = verify_listed_scene(dataset, manifest.as_ref(), scene, &not_judged(dataset, scene)?, cx);
        if !report.passed {
            forget_passing(dataset, scene, cx);
        }
        reports.push(report);
    }
    Ok(join_reports(dataset, reports))
}

/// Removes what a run has kept of verifying a scene, the record first, as without one the stage runs. Data of others have none.
fn forget_passing(dataset: &Dataset, scene: &str, cx: &dyn Cx) {
    let folder = dataset.root().join(WORKDIR).join(scene);
    for path in [folder.join(Stage::Verify.record()), folder.join(CARD)] {
        if let Err(error) = remove_if_there(&path) {
            cx.warn(Warning { place: path.display().to_string(), message: Error::from(error).explain() });
        }
    }
}

/// Gives scenes of the dataset in `out` another label table, and labels them again. `table` is a CSV file.
///
/// # Errors
/// As [`run_stage`], and when `table` cannot be read.
pub fn relabel(out: &Path, table: &Path, pattern: Option<&str>, force: bool, reporter: &dyn Reporter) -> Result<Summary, Error> {
    let table = std::path::absolute(table).map_err(Error::io("find", table))?;
    let (workdir, config) = open_with(out, pattern, |scene| scene.set_label_table(&table.to_string_lossy()))?;
    // Before the choice is stored: a mistyped name must not cost the labels that are there.
    read_table(&table)?;
    store_config(&workdir, &config)?;
    let scenes = config.select(pattern)?;
    Session::new(&config, &workdir)?.run(&scenes, &LABELLING, force, reporter)
}

pub(crate) fn store_config(workdir: &Workdir, config: &Config) -> Result<(), Error> {
    let inside = |path: &PathBuf| path.strip_prefix(workdir.out()).unwrap_or(path).to_path_buf();
    let carried = config.carried.iter().map(|(written, path)| (written.clone(), inside(path))).collect();
    Ok(write_json(&workdir.file(RUN), &RunFile { base: config.base.clone(), carried, config: config.clone() })?)
}

pub(crate) fn open(out: &Path) -> Result<(Workdir, Config), Error> {
    let workdir = Workdir::open(out)?;
    let path = workdir.file(RUN);
    let text = std::fs::read(&path).map_err(|e| no_settings(&path, &e))?;
    let RunFile { base, carried, config } = serde_json::from_slice(&text).map_err(|e| no_settings(&path, &e))?;
    let carried = carried.into_iter().map(|(written, path)| (written, out.join(path))).collect();
    Ok((workdir, Config { base, carried, ..config }))
}

/// The stored settings cannot be used: they are not there, damaged, or have keys of a newer program.
fn no_settings(path: &Path, problem: &dyn std::fmt::Display) -> Error {
    let message = format!(
        "{} holds no settings that this enfilade, {}, understands ({problem}); it is damaged, or another version wrote it",
        path.display(),
        env!("CARGO_PKG_VERSION")
    );
    Error::usage(message, "use the version that wrote it, or run `enfilade run` for this folder once; what is finished is kept")
}

/// Opens a dataset as [`open`] does, with `change` made to the chosen scenes; [`store_config`] makes it last.
fn open_with(out: &Path, pattern: Option<&str>, change: impl Fn(&mut SceneConfig)) -> Result<(Workdir, Config), Error> {
    let (workdir, mut config) = open(out)?;
    let chosen: Vec<String> = config.select(pattern)?.iter().map(|s| s.name.clone()).collect();
    config.scenes.iter_mut().filter(|s| chosen.contains(&s.name)).for_each(change);
    Ok((workdir, config))
}

/// The first of the names, and how many more there are.
pub(crate) fn first_of(names: &[&str]) -> String {
    let shown = names[..names.len().min(NAMES_SHOWN)].join(", ");
    match names.len().saturating_sub(NAMES_SHOWN) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

/// Reports that a stage of a scene failed, and why.
pub(crate) fn told_failure(scene: &str, stage: Stage, error: &Error, reporter: &dyn Reporter) -> Failure {
    let message = error.explain();
    reporter.on(scene, stage, Event::Failed { message: &message });
    Failure { stage, message, hint: error.hint() }
}

/// The pairs of frames that the configuration requests: one list for all scenes that request them.
fn configured_pairs(config: &Config) -> Vec<Request> {
    let of_scene = |scene: &SceneConfig| {
        scene.products.iter().find_map(|request| if let Request::Pairs(pairs) = request { Some(pairs.clone()) } else { None })
    };
    let asked: Vec<(String, PairsRequest)> =
        config.scenes.iter().filter_map(|scene| Some((scene.name.clone(), of_scene(scene)?))).collect();
    let Some((_, pairs)) = asked.first() else { return Vec::new() };
    let names = asked.iter().map(|(name, _)| name.clone()).collect();
    let scenes = if asked.len() == config.scenes.len() { None } else { Some(names) };
    vec![Request::Pairs(PairsRequest { scenes, ..pairs.clone() })]
}

/// A run over scenes.
pub(crate) struct Session<'a> {
    pub config: &'a Config,
    pub workdir: &'a Workdir,
    pub dataset: Dataset,
    /// Whether products are made too, and not only the stages.
    makes_products: bool,
}

impl<'a> Session<'a> {
    pub fn new(config: &'a Config, workdir: &'a Workdir) -> Result<Self, Error> {
        Ok(Self { config, workdir, dataset: Dataset::create(workdir.out()).map_err(Error::stage)?, makes_products: false })
    }

    /// A session as by [`Session::new`], for runs that bring products up to date as well.
    pub fn with_products(config: &'a Config, workdir: &'a Workdir) -> Result<Self, Error> {
        Ok(Self { makes_products: true, ..Self::new(config, workdir)? })
    }

    /// Runs `stages` over `scenes`.
    pub fn run(&self, scenes: &[&SceneConfig], stages: &[&StageSpec], force: bool, reporter: &dyn Reporter) -> Result<Summary, Error> {
        let time = Stopwatch::start();
        // Scene by scene; one that fails does not stop the others.
        let mut outcomes: Vec<SceneOutcome> = Vec::new();
        for scene in scenes {
            let stages = self.with_labels(scene, stages)?;
            let outcome = self.run_scene(scene, &stages, force, &outcomes, reporter);
            outcomes.push(outcome);
        }

        // Then the files of the dataset as a whole, each from those before it.
        let finished = self
            .write_manifest(&outcomes, None)
            .and_then(|()| self.write_overview(stages, &outcomes))
            .and_then(|()| self.write_partition())
            .and_then(|warnings| self.write_card(stages, &outcomes).map(|()| warnings))
            .and_then(|warnings| self.write_statistics(stages, &outcomes).map(|()| warnings));

        let mut warnings = finished.as_ref().ok().cloned().unwrap_or_default();
        let products = self.make_products_of_dataset(&mut outcomes, reporter);
        warnings.extend(self.out_of_date());
        let summary = Summary { scenes: outcomes, warnings, products, wall_s: time.wall_s() };
        match finished {
            // If a scene has failed, for example on a full disk, the user must see that error; the next run writes these files.
            Err(error) if summary.ok() => Err(error),
            _ => Ok(summary),
        }
    }

    /// Brings the products of a scene up to date that need nothing of the dataset as a whole.
    fn make_products_of(&self, scene: &SceneConfig, late: bool, reporter: &dyn Reporter) -> Vec<ProductOutcome> {
        let of_scene = |request: &Request| match request {
            Request::Pairs(pairs) => pairs.covisibility(),
            other => other.clone(),
        };
        let configured: Vec<Request> = scene.products.iter().map(of_scene).collect();
        bring_up_to_date(&self.dataset, Place::Scene(&scene.name), &configured, late, reporter)
    }

    /// Brings the products of the dataset as a whole up to date, and the products of scenes that come after them.
    fn make_products_of_dataset(&self, outcomes: &mut [SceneOutcome], reporter: &dyn Reporter) -> Vec<ProductOutcome> {
        if !self.makes_products {
            return Vec::new();
        }
        let configured = configured_pairs(self.config);
        let products = bring_up_to_date(&self.dataset, Place::Dataset, configured.as_slice(), false, reporter);
        for outcome in outcomes.iter_mut().filter(|outcome| outcome.failure.is_none()) {
            let scene = self.config.scenes.iter().find(|scene| scene.name == outcome.name);
            outcome.products.extend(scene.into_iter().flat_map(|scene| self.make_products_of(scene, true, reporter)));
        }
        products
    }

    /// A line about products that are out of date; `None` where none is.
    fn out_of_date(&self) -> Option<String> {
        let told = self.dataset.scenes().map_err(Error::stage).and_then(|scenes| told_out_of_date(&self.dataset, &scenes));
        told.unwrap_or_else(|error| Some(format!("it is unknown which products are out of date: {}", error.explain())))
    }

    /// The `stages`; after rendering alone also the stages of labels that were done for the scene, because frames that are rendered again
    /// lose their labels.
    fn with_labels<'s>(&self, scene: &SceneConfig, stages: &[&'s StageSpec]) -> Result<Vec<&'s StageSpec>, Error> {
        let is_among = |stage: Stage| stages.iter().any(|spec| spec.stage == stage);
        let mut with = stages.to_vec();
        if is_among(Stage::Render) && !is_among(Stage::Label) {
            for spec in LABELLING.into_iter().filter(|spec| !is_among(spec.stage)) {
                if self.workdir.scene_file(&scene.name, &spec.stage.record())?.is_file() {
                    with.push(spec);
                }
            }
            with.sort_by_key(|spec| spec.stage);
        }
        Ok(with)
    }

    /// Runs `stages` over a scene, after those with the outcomes `earlier`.
    pub fn run_scene(
        &self,
        scene: &SceneConfig,
        stages: &[&StageSpec],
        force: bool,
        earlier: &[SceneOutcome],
        reporter: &dyn Reporter,
    ) -> SceneOutcome {
        let job = Job::new(self.config, scene, &self.dataset, self.workdir, force);
        let mut outcome = SceneOutcome { name: scene.name.clone(), stages: Vec::new(), products: Vec::new(), failure: None };
        for spec in stages {
            if spec.stage == Stage::Verify && self.makes_products {
                outcome.products = self.make_products_of(scene, false, reporter);
            }
            let ready = || self.prepare_stage(spec.stage, &job, earlier);
            match advance(spec, &job, ready, StageCx::new(&scene.name, spec.stage, reporter)) {
                Ok(done) => outcome.stages.push(done),
                Err(error) => {
                    outcome.failure = Some(told_failure(&scene.name, spec.stage, &error, reporter));
                    break;
                }
            }
        }
        outcome
    }

    /// Does what a stage needs that is about to run.
    fn prepare_stage(&self, stage: Stage, job: &Job, earlier: &[SceneOutcome]) -> Result<(), Error> {
        adopt(&self.dataset, &job.scene.name)?;
        match stage {
            // The manifest is part of what is verified. It lists all scenes, so it is not gathered for each that has nothing to do.
            Stage::Verify => {
                job.leave_out(not_judged(&self.dataset, &job.scene.name)?);
                self.write_manifest(earlier, Some(&job.scene.name))
            }
            _ => Ok(()),
        }
    }

    /// A line about scenes of the folder that the configuration does not have; `None` where it has all.
    pub fn unknown_scenes(&self) -> Option<String> {
        let is_known = |name: &String| self.config.scenes.iter().any(|scene| scene.name == *name);
        // If the folder cannot be read, the run has reported it.
        let unknown: Vec<String> = self.dataset.scenes().unwrap_or_default().into_iter().filter(|name| !is_known(name)).collect();
        if unknown.is_empty() {
            return None;
        }
        let names: Vec<&str> = unknown.iter().map(String::as_str).collect();
        Some(format!(
            "{} also holds scenes that this configuration does not have: {}; they stay as they are, and `run` with a folder does not \
             know them until a configuration that has them is run",
            self.workdir.out().display(),
            first_of(&names)
        ))
    }

    /// Divides the dataset by scene, and writes its kinds of rooms. Returns lines about assets on several sides and, if there are enough
    /// scenes, about sides without an image.
    fn write_partition(&self) -> Result<Vec<String>, Error> {
        let Some(manifest) = self.dataset.read_manifest().map_err(Error::stage)? else { return Ok(Vec::new()) };
        let partition = write_partition(&self.dataset, self.workdir, &manifest)?;
        write_scene_types(&self.dataset, self.config, &manifest)?;
        let empty = partition.empty_sides().filter(|_| !partition.has_few_scenes());
        Ok(partition.leaks().into_iter().chain(empty).collect())
    }

    /// Writes the report card of all scenes, also of those that did not come so far as to be verified. Stages that change what is verified
    /// have removed it.
    fn write_card(&self, stages: &[&StageSpec], outcomes: &[SceneOutcome]) -> Result<(), Error> {
        if stages.iter().all(|spec| spec.stage != Stage::Verify) {
            return Ok(());
        }
        let manifest = self.dataset.read_manifest().map_err(Error::stage)?;
        let mut reports: Vec<VerifyReport> = Vec::new();
        for scene in self.dataset.scenes().map_err(Error::stage)? {
            let stopped = outcomes.iter().filter(|outcome| outcome.name == scene).any(|outcome| outcome.stopped_before(Stage::Verify));
            let kept = if stopped { None } else { read_json(&self.workdir.scene_file(&scene, CARD)?) };
            let report = match kept {
                Some(report) => report,
                None => verify_listed_scene(&self.dataset, manifest.as_ref(), &scene, &not_judged(&self.dataset, &scene)?, &Quiet),
            };
            reports.push(report);
        }
        let report = join_reports(&self.dataset, reports);
        write_report(&self.dataset, &report).map_err(Error::stage)
    }

    /// The keys of the pictures of all scenes, and whether any were made in this run.
    fn pictures(&self, outcomes: &[SceneOutcome]) -> Result<(Pictures, bool), Error> {
        let of_scene = |scene: &SceneOutcome| {
            let stage = scene.stages.iter().find(|outcome| outcome.stage == Stage::Preview)?;
            Some((scene.name.clone(), stage.key.clone()))
        };
        let known = outcomes.iter().filter_map(of_scene).collect();
        let made = outcomes.iter().flat_map(|scene| &scene.stages).any(|outcome| outcome.stage == Stage::Preview && !outcome.up_to_date);
        Ok((pictures(&self.dataset, self.workdir, &known)?, made))
    }

    /// Brings the contact sheet of all scenes up to date, where `stages` make pictures and any frame is complete.
    fn write_overview(&self, stages: &[&StageSpec], outcomes: &[SceneOutcome]) -> Result<(), Error> {
        if stages.iter().all(|spec| spec.stage != Stage::Preview) {
            return Ok(());
        }
        let complete = |c: &CameraEntry| c.frames.iter().any(|f| f.status == FrameStatus::Complete);
        let has_frames = || {
            let manifest = self.dataset.read_manifest().map_err(Error::stage)?;
            Ok(manifest.iter().flat_map(|m| m.scenes.values()).flat_map(|s| s.cameras.values()).any(complete))
        };
        let (pictures, were_made) = self.pictures(outcomes)?;
        update_sheet(&self.dataset, &self.config.name, (&pictures, were_made), has_frames)
    }

    /// Brings the statistics of all scenes up to date, where `stages` make pictures.
    fn write_statistics(&self, stages: &[&StageSpec], outcomes: &[SceneOutcome]) -> Result<(), Error> {
        if stages.iter().all(|spec| spec.stage != Stage::Preview) {
            return Ok(());
        }
        let (pictures, were_made) = self.pictures(outcomes)?;
        update_statistics(&self.dataset, &pictures, were_made)
    }

    /// Writes the manifest of what is on disk, unless it is there already. A failure noted of the scene `at_work` is dropped.
    fn write_manifest(&self, outcomes: &[SceneOutcome], at_work: Option<&str>) -> Result<(), Error> {
        let old = self.dataset.read_manifest().unwrap_or_default();
        let there: BTreeSet<String> = self.dataset.scenes().map_err(Error::stage)?.into_iter().collect();
        let is_known = |name: &String| there.contains(name) || self.config.scenes.iter().any(|scene| scene.name == *name);
        let mut failed_scenes: BTreeMap<String, String> = BTreeMap::new();
        for (name, entry) in old.iter().flat_map(|m| &m.scenes).filter(|(name, _)| is_known(name)) {
            failed_scenes.extend(entry.failed.clone().map(|reason| (name.clone(), reason)));
        }
        for name in outcomes.iter().map(|o| o.name.as_str()).chain(at_work) {
            failed_scenes.remove(name);
        }
        for outcome in outcomes {
            // The manifest is verified too, so it cannot contain the result.
            let failure = outcome.failure.as_ref().filter(|f| f.stage != Stage::Verify);
            failed_scenes.extend(failure.map(|f| (outcome.name.clone(), format!("{}: {}", f.stage.name(), f.message))));
        }
        let info = ManifestInfo {
            config: serde_json::to_value(self.config).unwrap_or_default(),
            seeds: self.config.scenes.iter().map(|s| (s.name.clone(), s.seed)).collect(),
            failed_scenes,
            ..ManifestInfo::default()
        };
        let manifest = self.dataset.collect_manifest(&info).map_err(Error::stage)?;
        if old.as_ref() == Some(&manifest) {
            return Ok(());
        }
        if old.is_none_or(|old| old.scenes.keys().any(|name| !manifest.scenes.contains_key(name))) {
            // Rows of removed scenes in a table of the dataset.
            self.dataset.retain_camera_parameters(|scene| there.contains(scene)).map_err(Error::stage)?;
        }
        self.dataset.write_manifest(&manifest).map_err(Error::stage)
    }
}
