//! `carve`: the scene to its free space, beginning at the cameras where trajectories will begin.

use super::starts::carved;
use super::{Inputs, Job, Outcome, Record, Stage, variation};
use crate::error::Error;
use crate::report::StageCx;
use crate::workdir::{Hash, read_json};
use enfilade_dataset::{counted, take_file, write_json};
use enfilade_explore::{FreeSpace, Mode, StartReport};
use enfilade_scene::StartCamera;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The cameras where trajectories begin, in the work folder.
pub(super) const STARTS: &str = "starts.json";

/// A camera where a trajectory begins.
#[derive(Serialize, Deserialize)]
struct Start {
    #[serde(flatten)]
    camera: StartCamera,
    /// True if it was skipped, because it is in a wall.
    #[serde(default)]
    is_skipped: bool,
    /// True if hardly any direction around it meets a surface.
    #[serde(default)]
    is_open: bool,
}

/// All start cameras; there is at least one.
pub(super) fn starts(job: &Job) -> Result<Vec<StartCamera>, Error> {
    Ok(read_starts(job)?.into_iter().map(|start| start.camera).collect())
}

/// Start cameras that are not inside of things: carving began there.
pub(super) fn standing(job: &Job) -> Result<Vec<StartCamera>, Error> {
    Ok(read_starts(job)?.into_iter().filter(|start| !start.is_skipped).map(|start| start.camera).collect())
}

/// Whether a trajectory begins in the open, where the gates that assume a room do not apply to views.
pub(super) fn is_open_place(job: &Job) -> Result<bool, Error> {
    Ok(read_starts(job)?.iter().any(|start| start.is_open))
}

fn read_starts(job: &Job) -> Result<Vec<Start>, Error> {
    let path = job.work_file(STARTS)?;
    let unreadable = || Error::scene(format!("{}: the list of start cameras cannot be read", path.display()), job.again(Stage::Carve));
    read_json(&path).filter(|starts: &Vec<Start>| !starts.is_empty()).ok_or_else(unreadable)
}

pub(super) fn settings(job: &Job) -> Hash {
    let usual = Hash::of(&(&job.scene.carve, &job.scene.cameras, job.scene.finds_cameras, exploring_seed(job)));
    // Cameras that film as they are may be where no trajectory could begin.
    if let Mode::Cameras(_) = job.scene.plan.mode { Hash::of(&(usual, "cameras")) } else { usual }
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    if let Some(first) = variation::of_same_geometry(job)? {
        return outputs(&first)?.iter().map(|path| first.input_from(Stage::Carve, path)).collect::<Result<_, _>>().map(Some);
    }
    Ok(Some(vec![job.input_from(Stage::Import, &job.package()?)?]))
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    if let Some(first) = variation::of_same_geometry(job)? {
        let (from, to) = (outputs(&first)?, outputs(job)?);
        from.iter().zip(&to).try_for_each(|(from, to)| take_file(from, to))?;
        return variation::taken_over(&first, Stage::Carve, to);
    }
    let name = &job.scene.name;
    let world = job.load_world()?;
    let (starts, space) = carved(job, &world, exploring_seed(job), cx)?;
    job.dataset.write_free_space(name, &space.tree.to_bt(), space.free_min, space.free_max).map_err(Error::stage)?;
    let summary = summary(&space, starts.len());
    let start =
        |(camera, report): (StartCamera, &StartReport)| Start { camera, is_skipped: report.used.is_none(), is_open: report.is_open };
    let starts: Vec<Start> = starts.into_iter().zip(&space.report.starts).map(start).collect();
    write_json(&job.work_file(STARTS)?, &starts)?;
    let report = serde_json::to_value(&space.report).unwrap_or_default();
    Ok(Outcome { summary, outputs: outputs(job)?, report, ..Outcome::default() })
}

fn summary(space: &FreeSpace, cameras: usize) -> String {
    let (size, report) = (space.free_max - space.free_min, &space.report);
    let seen = format!(
        "{:.0} m3 of free space within {:.1} x {:.1} x {:.1} m, seen from {}",
        report.free_volume_m3,
        size.x,
        size.y,
        size.z,
        counted(cameras, "camera")
    );
    let leaks = match report.leaks.first() {
        Some(leak) => format!("{}, the largest {:.1} m2 at {:.1}", counted(report.leaks.len(), "leak"), leak.area_m2, leak.position),
        None if report.sought_leaks => "no leaks".into(),
        None => "leaks were not looked for".into(),
    };
    format!("{seen}; {:.0} % of the domain unknown; {leaks}", 100.0 * report.unknown_share)
}

fn exploring_seed(job: &Job) -> u64 {
    job.scene.exploring_seed("carve", job.scene.carve.preset)
}

/// Every file that carving writes.
pub(super) fn outputs(job: &Job) -> Result<Vec<PathBuf>, Error> {
    let (layout, name) = (job.dataset.layout(), &job.scene.name);
    let octomap = [layout.octomap(name), layout.octomap_free_space_min(name), layout.octomap_free_space_max(name)];
    Ok(octomap.into_iter().chain([job.work_file(STARTS)?]).collect())
}
