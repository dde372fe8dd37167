//! Forecasts of the remaining time and resources of a run, scene by scene, from a pilot of each.

use crate::config::{Config, SceneConfig};
use crate::error::Error;
use crate::forecast::Forecast;
use crate::products::try_out;
use crate::report::{Reporter, SceneOutcome, StageCx, Stopwatch, Summary};
use crate::run::{Session, first_of, store_config, told_failure};
use crate::stages::{FramesByTrajectory, Job, STAGES, Stage, StageSpec, is_up_to_date, missing_frames, pilot};
use crate::workdir::Workdir;
use enfilade_dataset::Dataset;
use std::collections::BTreeSet;
use std::path::Path;

/// Results of scenes before rendering, and forecasts of those that succeeded.
type Forecasts = (Summary, Vec<(String, Forecast)>);

/// Forecasts what [`run`](crate::run()) will still take, by scene: it does everything before rendering, which is kept, and tries a little
/// of the rest, which is not kept. Scenes that fail are left out, and the summary has the reasons.
///
/// If a scene with finished frames would be planned anew, the folder and the configuration stored in it are not changed.
///
/// # Errors
/// As [`run`](crate::run()).
pub fn estimate(config: &Config, out: &Path, pattern: Option<&str>, reporter: &dyn Reporter) -> Result<Forecasts, Error> {
    let scenes = config.select(pattern)?;
    let workdir = Workdir::create(out)?;
    let session = Session::new(config, &workdir)?;
    let replanned: Vec<&str> =
        scenes.iter().filter(|scene| session.has_frames(scene) && !session.is_planned(scene)).map(|scene| scene.name.as_str()).collect();
    if replanned.is_empty() {
        return forecast(config, &scenes, &workdir, &missing_frames, reporter);
    }
    let (mut summary, forecasts) = session.forecast_aside(&scenes, reporter)?;
    summary.warnings.push(format!(
        "{} has finished frames of {}, which this configuration plans anew: all their frames are counted, and the folder stays as it \
         is; to keep what was planned, name another one with -o",
        out.display(),
        first_of(&replanned)
    ));
    Ok((summary, forecasts))
}

/// Does all that comes before rendering, and forecasts what the `frames` of every scene take.
pub(crate) fn forecast(
    config: &Config,
    scenes: &[&SceneConfig],
    workdir: &Workdir,
    frames: &dyn Fn(&Job) -> Result<FramesByTrajectory, Error>,
    reporter: &dyn Reporter,
) -> Result<Forecasts, Error> {
    store_config(workdir, config)?;
    let session = Session::new(config, workdir)?;
    let mut summary = session.run(scenes, &before_rendering(), false, reporter)?;
    summary.warnings.extend(session.unknown_scenes());
    let outcomes = scenes.iter().zip(&mut summary.scenes);
    let forecasts = outcomes.filter_map(|(scene, outcome)| session.forecast(scene, outcome, frames, reporter)).collect();
    Ok((summary, forecasts))
}

fn before_rendering() -> Vec<&'static StageSpec> {
    STAGES.iter().filter(|spec| spec.stage < Stage::Render).collect()
}

/// The forecast for the `frames` of a scene.
fn forecast_of(job: &Job, frames: &FramesByTrajectory, reporter: &dyn Reporter) -> Result<Forecast, Error> {
    if frames.is_empty() {
        return Ok(Forecast::default());
    }
    let products = |aside: &Dataset| try_out(job.dataset, &job.scene.name, &job.scene.products, aside);
    Ok(Forecast::of(&pilot(job, frames, &products, &StageCx::new(&job.scene.name, Stage::Render, reporter))?))
}

impl Session<'_> {
    /// Forecasts as [`forecast`] does, without changing the folder: planned scenes are tried in place, and the others, of which all frames
    /// count, in a folder that is removed.
    fn forecast_aside(&self, scenes: &[&SceneConfig], reporter: &dyn Reporter) -> Result<Forecasts, Error> {
        let time = Stopwatch::start();
        let folder = self.workdir.aside()?;
        let workdir = Workdir::create(folder.path())?;
        let aside = Session::new(self.config, &workdir)?;
        // Variations are made from the files of their first scene, so all of them are tried in one place.
        let first = |scene: &SceneConfig| scene.varies.as_ref().map_or_else(|| scene.name.clone(), |varies| varies.of.clone());
        let unplanned: BTreeSet<String> = scenes.iter().filter(|scene| !self.is_planned(scene)).map(|scene| first(scene)).collect();
        let sessions: Vec<&Session> = scenes.iter().map(|scene| if unplanned.contains(&first(scene)) { &aside } else { self }).collect();
        let (mut outcomes, mut forecasts) = (Vec::new(), Vec::new());
        for (session, scene) in sessions.iter().zip(scenes) {
            let mut outcome = session.run_scene(scene, &before_rendering(), false, &outcomes, reporter);
            forecasts.extend(session.forecast(scene, &mut outcome, &missing_frames, reporter));
            outcomes.push(outcome);
        }
        let warnings = self.unknown_scenes().into_iter().collect();
        Ok((Summary { scenes: outcomes, warnings, products: Vec::new(), wall_s: time.wall_s() }, forecasts))
    }

    /// Forecasts what the `frames` of a scene take, with its name, unless its `outcome` is a failure by now.
    fn forecast(
        &self,
        scene: &SceneConfig,
        outcome: &mut SceneOutcome,
        frames: &dyn Fn(&Job) -> Result<FramesByTrajectory, Error>,
        reporter: &dyn Reporter,
    ) -> Option<(String, Forecast)> {
        if outcome.failure.is_some() {
            return None;
        }
        let job = Job::new(self.config, scene, &self.dataset, self.workdir, false);
        match frames(&job).and_then(|frames| forecast_of(&job, &frames, reporter)) {
            Ok(forecast) => Some((scene.name.clone(), forecast)),
            Err(error) => {
                outcome.failure = Some(told_failure(&scene.name, Stage::Render, &error, reporter));
                None
            }
        }
    }

    /// True if any frame of the scene is finished, or may be.
    fn has_frames(&self, scene: &SceneConfig) -> bool {
        let name = &scene.name;
        let has_none = |camera: &String| self.dataset.frame_numbers(name, camera).is_ok_and(|frames| frames.is_empty());
        !self.dataset.cameras(name).unwrap_or_default().iter().all(has_none)
    }

    /// True when nothing is to be done for the scene before rendering.
    fn is_planned(&self, scene: &SceneConfig) -> bool {
        let job = Job::new(self.config, scene, &self.dataset, self.workdir, false);
        let is_there = self.dataset.layout().metadata_cameras(&scene.name).is_file();
        is_there && before_rendering().iter().all(|spec| is_up_to_date(spec, &job).unwrap_or(false))
    }
}
