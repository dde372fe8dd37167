//! The stages, in one table, and the rule by which one is skipped.
//!
//! A stage is a pure function of some other crate plus the thin file here that reads its inputs from the work folder and the
//! dataset and writes its outputs there. It is up to date when its record says that it ran with the same configuration, the
//! same content of the same inputs and the same version of the code, and all its outputs are there as it wrote them.

mod boxes;
mod carve;
mod denoise;
mod finisher;
mod gate;
mod import;
mod job;
mod kept;
mod label;
mod made;
mod pilot;
mod plan;
mod plan_preview;
mod preview;
mod progressive;
pub(crate) mod render;
mod verify;

use crate::error::Error;
use crate::report::{Event, StageCx, StageOutcome, Stopwatch};
use crate::workdir::{Hash, read_json, remove_if_there, write_json};
use enfilade_frame::Pass;
use enfilade_scene::Warning;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

pub(crate) use denoise::check_denoiser;
pub(crate) use finisher::frame_finisher;
pub(crate) use import::{describe, describe_and_measure, labels_by_part, load_file};
pub(crate) use job::{FramesByTrajectory, Job, World};
pub(crate) use label::read_table;
pub(crate) use pilot::pilot;
pub(crate) use plan_preview::draw_plan;
pub(crate) use progressive::{FOLDER as PARTIALS, file_name as kept_part};
pub(crate) use render::missing_frames;
pub(crate) use verify::CARD;

/// A stage by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs)] // STAGES describes each one
pub enum Stage {
    Import,
    Carve,
    Plan,
    Gate,
    Render,
    Denoise,
    Label,
    Boxes,
    Preview,
    Verify,
}

/// What a stage is.
pub struct StageSpec {
    /// Which one.
    pub stage: Stage,
    /// The verb of the command line.
    pub name: &'static str,
    /// What it reads and writes.
    pub about: &'static str,
    /// Changes whenever the stage's outputs change for the same inputs, so that old outputs are made again.
    pub(crate) version: u32,
    /// Everything of the configuration that the outputs depend on.
    settings: fn(&Job) -> Hash,
    /// Everything else that they depend on; `None` when that is only known after the stage has run.
    inputs: fn(&Job, Option<&Record>) -> Inputs,
    /// Does the work.
    run: fn(&Job, &StageCx) -> Result<Outcome, Error>,
}

/// All stages in the order in which they run.
pub const STAGES: [StageSpec; 10] = [
    StageSpec {
        stage: Stage::Import,
        name: "import",
        about: "scene file -> scene package",
        version: 10,
        settings: import::settings,
        inputs: import::inputs,
        run: import::run,
    },
    StageSpec {
        stage: Stage::Carve,
        name: "carve",
        about: "scene -> free space (octomap.bt)",
        version: 4,
        settings: carve::settings,
        inputs: carve::inputs,
        run: carve::run,
    },
    StageSpec {
        stage: Stage::Plan,
        name: "plan",
        about: "scene, free space -> camera trajectories",
        version: 6,
        settings: plan::settings,
        inputs: plan::inputs,
        run: plan::run,
    },
    StageSpec {
        stage: Stage::Gate,
        name: "gate",
        about: "scene, trajectories -> which views are worth rendering",
        version: 1,
        settings: gate::settings,
        inputs: gate::inputs,
        run: gate::run,
    },
    StageSpec {
        stage: Stage::Render,
        name: "render",
        about: "scene, trajectories -> frames",
        version: 12,
        settings: render::settings,
        inputs: render::inputs,
        run: render::run,
    },
    StageSpec {
        stage: Stage::Denoise,
        name: "denoise",
        about: "frames -> denoised colour layers, where asked for",
        version: 3,
        settings: denoise::settings,
        inputs: denoise::inputs,
        run: denoise::run,
    },
    StageSpec {
        stage: Stage::Label,
        name: "label",
        about: "frames, label table -> semantic layers",
        version: 2,
        settings: label::settings,
        inputs: label::inputs,
        run: label::run,
    },
    StageSpec {
        stage: Stage::Boxes,
        name: "boxes",
        about: "scene, labels -> bounding boxes, and what each frame shows of each instance",
        version: 1,
        settings: boxes::settings,
        inputs: boxes::inputs,
        run: boxes::run,
    },
    StageSpec {
        stage: Stage::Preview,
        name: "preview",
        about: "frames -> pictures and contact sheets",
        version: 4,
        settings: preview::settings,
        inputs: preview::inputs,
        run: preview::run,
    },
    StageSpec {
        stage: Stage::Verify,
        name: "verify",
        about: "dataset -> report card",
        version: 5,
        settings: verify::settings,
        inputs: verify::inputs,
        run: verify::run,
    },
];

impl Stage {
    /// The stage's row of the table.
    pub fn spec(self) -> &'static StageSpec {
        &STAGES[self as usize]
    }

    /// The verb of the command line.
    pub fn name(self) -> &'static str {
        self.spec().name
    }
}

/// The inputs of a stage, as far as they are known before it has run.
pub(crate) type Inputs = Result<Option<Vec<Input>>, Error>;

/// A file that a stage read, by content.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Input {
    pub path: PathBuf,
    pub content: Hash,
}

impl Input {
    pub fn of(path: &Path) -> Result<Self, Error> {
        Ok(Self { path: path.into(), content: Hash::of_file(path)? })
    }

    /// The same of a file that need not be there.
    pub fn of_any(path: &Path) -> Result<Self, Error> {
        if path.exists() { Self::of(path) } else { Ok(Self { path: path.into(), content: Hash::of(&None::<u8>) }) }
    }
}

/// What a stage's function leaves behind.
#[derive(Default)]
pub(crate) struct Outcome {
    /// One line: what it made.
    pub summary: String,
    /// Files written.
    pub outputs: Vec<PathBuf>,
    /// Files read, for a stage that only knows them afterwards.
    pub inputs: Option<Vec<Input>>,
    /// The report of the stage's function, whatever its form.
    pub report: serde_json::Value,
}

/// What stands in `STAGE.json`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Record {
    /// Hash of settings, inputs and code version.
    key: Hash,
    pub summary: String,
    pub warnings: Vec<Warning>,
    pub report: serde_json::Value,
    pub wall_s: f64,
    pub cpu_s: f64,
    inputs: Vec<Input>,
    outputs: Vec<Output>,
    /// Of planning: what [`plan::listed`] said afterwards. Earlier versions did not note it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    listed: Option<Hash>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Output {
    path: PathBuf,
    bytes: u64,
    /// Of those that [`is_noted`] names. Earlier versions did not note it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    content: Option<Hash>,
}

impl Output {
    /// Its file is there in full length and, where that was noted, with the same content.
    fn is_there(&self, job: &Job) -> bool {
        let path = job.out().join(&self.path);
        let is_same = |content: &Hash| Hash::of_file(&path).is_ok_and(|found| found == *content);
        is_there(&path, self.bytes) && self.content.as_ref().is_none_or(is_same)
    }
}

/// Renders the frames of `job` that are not there, whatever the stage's record says.
pub(crate) fn render_frames(job: &Job, cx: &StageCx) -> Result<(), Error> {
    render::run(job, cx).map(drop)
}

/// True when [`advance`] would find nothing to do.
pub(crate) fn is_up_to_date(spec: &StageSpec, job: &Job) -> Result<bool, Error> {
    let record: Option<Record> = read_json(&job.work_file(&format!("{}.json", spec.name))?);
    let Some(record) = record else { return Ok(false) };
    let inputs = (spec.inputs)(job, Some(&record))?;
    Ok(inputs.is_some_and(|inputs| holds(spec, job, &record, &(spec.settings)(job), &inputs)))
}

/// Whether the stage ran with these settings and inputs, and what it wrote is there.
fn holds(spec: &StageSpec, job: &Job, record: &Record, settings: &Hash, inputs: &[Input]) -> bool {
    let is_there = |output: &Output| output.is_there(job) || (spec.stage == Stage::Import && import::is_annotated(job, &output.path));
    record.key == key(spec, settings, inputs)
        && record.outputs.iter().all(is_there)
        && frames_are_whole(spec.stage, job)
        && (spec.stage != Stage::Plan || is_listed(job, record))
}

/// Whether the scene's row of the table of cameras is as planning left it: scenes share that, so its length tells nothing.
fn is_listed(job: &Job, record: &Record) -> bool {
    plan::listed(job).is_some_and(|row| record.listed.as_ref().is_none_or(|then| row == *then))
}

/// Refuses inputs that are not as an earlier stage wrote them, where what is made of them would take the place of finished frames.
fn refuse_damaged(spec: &StageSpec, job: &Job, inputs: &[Input]) -> Result<(), Error> {
    if spec.stage > Stage::Render {
        return Ok(());
    }
    for earlier in &STAGES[..spec.stage as usize] {
        let Some(record) = read_json::<Record>(&job.work_file(&format!("{}.json", earlier.name))?) else { continue };
        let is_other = |path: &Path, content: &Hash| inputs.iter().any(|input| input.path == path && input.content != *content);
        let noted = record.outputs.iter().filter_map(|output| Some((job.out().join(&output.path), output.content.as_ref()?)));
        let mut damaged: Vec<PathBuf> = noted.filter(|(path, content)| is_other(path, content)).map(|(path, _)| path).collect();
        if earlier.stage == Stage::Plan && !is_listed(job, &record) {
            damaged.push(job.dataset.camera_table());
        }
        if let Some(path) = damaged.first() {
            return Err(job.not_as_written(earlier.stage, path));
        }
    }
    Ok(())
}

/// Whether every frame has a record of the stage that can be read and is about this frame, and all files of that record in full length.
fn frames_are_whole(stage: Stage, job: &Job) -> bool {
    let pass = match stage {
        Stage::Render => return render::frames_are_taken(job).unwrap_or(false),
        Stage::Denoise if job.scene.denoise => Pass::Denoised,
        Stage::Label => Pass::Label,
        _ => return true,
    };
    let is_whole = |(camera, frame): &(String, u32)| job.dataset.layers_are_whole(&job.scene.name, camera, *frame, pass);
    job.frames().is_ok_and(|frames| frames.iter().all(is_whole))
}

/// Runs a stage of a scene unless it is up to date and not forced. `ready` is called before it does, and not where there is nothing to do.
pub(crate) fn advance(spec: &StageSpec, job: &Job, ready: impl FnOnce() -> Result<(), Error>, cx: StageCx) -> Result<StageOutcome, Error> {
    let record_path = job.work_file(&format!("{}.json", spec.name))?;
    let previous: Option<Record> = read_json(&record_path);
    let inputs = (spec.inputs)(job, previous.as_ref())?;
    let settings = (spec.settings)(job);
    if let (false, Some(record), Some(inputs)) = (job.force, &previous, &inputs)
        && holds(spec, job, record, &settings, inputs)
    {
        cx.event(Event::UpToDate);
        let warnings = record.warnings.len();
        return Ok(StageOutcome { stage: spec.stage, up_to_date: true, summary: record.summary.clone(), warnings, wall_s: 0.0 });
    }
    refuse_damaged(spec, job, inputs.as_deref().unwrap_or_default())?;
    ready()?;
    cx.event(Event::Started);
    let time = Stopwatch::start();
    // From here on the old outputs are about to change, so neither the old record nor the report card must vouch for them.
    remove_if_there(&record_path)?;
    if !matches!(spec.stage, Stage::Preview | Stage::Verify) {
        verify::forget(job)?;
    }
    let outcome = (spec.run)(job, &cx)?;
    let inputs = outcome.inputs.or(inputs).unwrap_or_default();
    let noted = |path: &PathBuf| {
        let content = is_noted(path).then(|| Hash::of_file(path)).transpose()?;
        Ok(Output { content, ..output(job, path)? })
    };
    let outputs = outcome.outputs.iter().map(noted).collect::<Result<_, Error>>()?;
    let (wall_s, cpu_s) = (time.wall_s(), time.cpu_s());
    cx.event(Event::Finished { summary: &outcome.summary, wall_s });
    let record = Record {
        key: key(spec, &settings, &inputs),
        summary: outcome.summary,
        warnings: cx.into_warnings(),
        report: outcome.report,
        wall_s,
        cpu_s,
        inputs,
        outputs,
        listed: if spec.stage == Stage::Plan { plan::listed(job) } else { None },
    };
    write_json(&record_path, &record)?;
    let warnings = record.warnings.len();
    Ok(StageOutcome { stage: spec.stage, up_to_date: false, summary: record.summary, warnings, wall_s })
}

fn key(spec: &StageSpec, settings: &Hash, inputs: &[Input]) -> Hash {
    // A dataset may be moved: the contents of its files count, and where they lie does not.
    let contents: Vec<&Hash> = inputs.iter().map(|i| &i.content).collect();
    Hash::of(&(env!("CARGO_PKG_VERSION"), spec.name, spec.version, settings, contents))
}

/// True for outputs whose content is noted. Files of frames are too many bytes to be read in every run; they have checksums in their records.
fn is_noted(path: &Path) -> bool {
    !path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("frame."))
}

fn is_there(path: &Path, bytes: u64) -> bool {
    std::fs::metadata(path).is_ok_and(|m| m.len() == bytes)
}

fn output(job: &Job, path: &Path) -> Result<Output, Error> {
    let bytes = std::fs::metadata(path).map_err(Error::io("read", path))?.len();
    Ok(Output { path: path.strip_prefix(job.out()).unwrap_or(path).into(), bytes, content: None })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_enum() {
        for (i, spec) in STAGES.iter().enumerate() {
            assert_eq!(spec.stage as usize, i);
        }
    }
}
