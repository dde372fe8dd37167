//! The plan of a job: made once, on one machine, from the configuration of a dataset.

use crate::object_names::{PLAN, object_name};
use crate::program::is_here;
use crate::{Attempt, Created, FarmError, Store};
use enfilade_dataset::{Price, WORKDIR, quoted};
use enfilade_options::{named, options};
use enfilade_pipeline::{Config, Expected, FarmConfig, Part, Prepared, PreparedScene, Reporter, Summary, prepare};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Version of the plan's form.
const FORMAT: u32 = 1;

options! {
    /// Options for dividing the work.
    #[derive(Clone, Copy, Debug)]
    pub struct PlanOptions {
        /// How long a task is to take, minutes.
        ///
        /// Shorter tasks spend much of their time on loading the scene, longer ones lose more when a node dies.
        pub minutes: f64 = 15.0 => named("MINUTES"),
        /// Threads of a worker.
        pub cpus: u32 = 8,
    }
}

impl PlanOptions {
    /// Checks the numbers.
    ///
    /// # Errors
    /// When one cannot be.
    pub fn check(&self) -> Result<(), FarmError> {
        let refuse = |problem: String| Err(FarmError::Request(problem));
        match *self {
            Self { minutes, .. } if !(minutes > 0.0 && minutes.is_finite()) => {
                refuse(format!("a task cannot take {minutes} minutes; expected a time above 0, such as 15"))
            }
            Self { cpus: 0, .. } => refuse("workers have 0 threads; expected 1 or more, such as 8".into()),
            _ => Ok(()),
        }
    }
}

/// All tasks of a job, and their inputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Version of this form.
    pub format: u32,
    /// The program, with its version: only the same makes the same bytes.
    pub program: String,
    /// Names the content of the job: two plans of one name make the same frames.
    pub id: String,
    /// Name of the dataset.
    pub dataset: String,
    /// Files of the dataset as a whole, by path within its folder.
    pub files: BTreeMap<String, StoredFile>,
    /// The scenes.
    pub scenes: Vec<PlannedScene>,
    /// The tasks; a task's number is its index.
    pub tasks: Vec<Task>,
    /// Threads that tasks were sized for.
    pub cpus: u32,
    /// Minutes that tasks were sized for; `None` in plans of before this was kept.
    pub minutes: Option<f64>,
    /// Other settings of the workers.
    #[serde(default, skip_serializing_if = "FarmConfig::is_default")]
    pub farm: FarmConfig,
}

/// The part of a plan that is read first.
#[derive(Deserialize)]
struct Planner {
    program: String,
}

/// The size and cost of a plan, as one value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlanStatement {
    /// Number of tasks.
    pub tasks: usize,
    /// Number of frames.
    pub frames: u64,
    /// Number of scenes.
    pub scenes: usize,
    /// vCPU-hours that rendering and finishing all frames will take; of the user's program nothing is known.
    pub vcpu_hours: Expected,
    /// In the order of the prices.
    pub prices: Vec<PricedPlan>,
}

/// The expected cost of all frames at a price.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PricedPlan {
    /// Name and rates of the price.
    #[serde(flatten)]
    pub price: Price,
    /// All rates together.
    pub dollars: Expected,
}

impl Plan {
    /// The size of the plan, and its cost at some prices.
    pub fn statement(&self, prices: &[Price]) -> PlanStatement {
        let cpu_s = self.scenes.iter().fold(Expected::default(), |sum, scene| sum + scene.cpu_s);
        let per_cpu_s = |factor: &dyn Fn(f64) -> f64| Expected { mean: factor(cpu_s.mean), deviation: factor(cpu_s.deviation) };
        let priced = |price: &Price| PricedPlan { price: price.clone(), dollars: per_cpu_s(&|cpu_s| price.dollars(cpu_s / 3600.0)) };
        PlanStatement {
            tasks: self.tasks.len(),
            frames: self.tasks.iter().map(|task| task.part.frames.len() as u64).sum(),
            scenes: self.scenes.len(),
            vcpu_hours: per_cpu_s(&|cpu_s| cpu_s / 3600.0),
            prices: prices.iter().map(priced).collect(),
        }
    }
}

/// A file that workers need, which is in the store under the hash of its content.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StoredFile {
    /// BLAKE3 of the content.
    pub blake3: String,
    /// Length.
    pub bytes: u64,
}

/// One scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlannedScene {
    /// Name of the scene in the dataset.
    pub name: String,
    /// Files of the scene, by path within the dataset's folder.
    pub files: BTreeMap<String, StoredFile>,
    /// Number of frames.
    pub frames: u64,
    /// Processor seconds that they will take in all.
    pub cpu_s: Expected,
    /// Peak memory, bytes.
    pub memory_bytes: Expected,
    /// Bytes of its frames and files.
    pub disk_bytes: Expected,
}

/// Frames that one worker makes in one go.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// The frames.
    #[serde(flatten)]
    pub part: Part,
    /// Processor seconds that they will take.
    pub cpu_s: f64,
}

/// A plan in its store.
#[derive(Debug)]
pub struct Job {
    /// The store with all its objects.
    pub store: Store,
    /// The plan of the job.
    pub plan: Plan,
}

impl Job {
    /// The job in `store`.
    ///
    /// # Errors
    /// When there is none, or it was planned by another version.
    pub fn open(store: Store) -> Result<Self, FarmError> {
        let missing = || {
            let (place, into) = (store.url(), quoted(store.url()));
            FarmError::Request(format!("{place} holds no job; plan one: enfilade farm plan dataset.toml -o {into}"))
        };
        let bytes = store.get(PLAN)?.ok_or_else(missing)?;
        let anew = "plan the job again in another place";
        let wrong = |problem: String| FarmError::Damaged { place: format!("{}/{PLAN}", store.url()), problem };
        // Before the rest, which other versions may put otherwise.
        if let Ok(Planner { program: planner }) = serde_json::from_slice(&bytes)
            && planner != program()
        {
            let problem = format!("was planned by {planner}, this is {}; only the same version makes the same bytes", program());
            return Err(wrong(format!("{problem}: use {planner}, or {anew}")));
        }
        let plan = Plan::from_json(&bytes).map_err(|error| wrong(format!("{error}; {anew}")))?;
        Ok(Self { store, plan })
    }

    /// The task of a number.
    ///
    /// # Errors
    /// When there is none.
    pub fn task(&self, number: u32) -> Result<&Task, FarmError> {
        let tasks = &self.plan.tasks;
        let none = || FarmError::Request(format!("there is no task {number}; the job has tasks 0 to {}", tasks.len().saturating_sub(1)));
        tasks.get(number as usize).ok_or_else(none)
    }

    /// Every file that workers on `scene` need, by path within the dataset's folder.
    pub fn files_of(&self, scene: &str) -> impl Iterator<Item = (&String, &StoredFile)> {
        let own = self.plan.scenes.iter().filter(move |planned| planned.name == scene);
        self.plan.files.iter().chain(own.flat_map(|planned| &planned.files))
    }
}

fn program() -> String {
    format!("enfilade {}", env!("CARGO_PKG_VERSION"))
}

/// Plans the dataset `config` into `store`, in a temporary folder. The same plan a second time changes nothing. Returns no job if a scene
/// fails before rendering; the summary reports that.
///
/// # Errors
/// When an option is out of range, the store lacks the guarantees that commits rely on, or it contains another job or one divided
/// differently.
pub fn plan(config: &Config, store: Store, options: &PlanOptions, reporter: &dyn Reporter) -> Result<(Summary, Option<Job>), FarmError> {
    options.check()?;
    let scratch = tempfile::tempdir().map_err(|source| FarmError::io("make a temporary folder in", &std::env::temp_dir(), source))?;
    let out = scratch.path().join("dataset");
    let (mut summary, prepared) = prepare(config, &out, None, reporter)?;
    summary.warnings.extend(not_here(&config.farm));
    if !summary.ok() {
        return Ok((summary, None));
    }
    store.probe(&Attempt::new("plan", |_| None).id)?;
    let there = store.get(PLAN)?;
    // Contents are named by their hashes, so they may be in the store before the plan that names them.
    let to = if there.is_none() { Some(&store) } else { None };
    let scenes = prepared.scenes.iter().map(|scene| planned(scene, &out, to)).collect::<Result<Vec<_>, _>>()?;
    let mut plan = Plan {
        format: FORMAT,
        program: program(),
        id: String::new(),
        dataset: config.name.clone(),
        files: stored(&prepared.files, &out, to)?,
        tasks: prepared.scenes.iter().flat_map(|scene| tasks(scene, options)).collect(),
        scenes,
        cpus: options.cpus,
        minutes: Some(options.minutes),
        farm: config.farm.clone(),
    };
    plan.id = identity(config, &prepared, &plan);
    if let Some(there) = there {
        let old = serde_json::from_slice::<Plan>(&there).ok();
        let Some(old) = old.filter(|old| old.id == plan.id) else {
            let problem = "holds another job; choose another place, or remove that one".to_string();
            return Err(FarmError::Damaged { place: store.url().to_string(), problem });
        };
        refuse_other_division(&old, options, store.url())?;
        return Job::open(store).map(|job| (summary, Some(job)));
    }
    let text = serde_json::to_vec_pretty(&plan).map_err(|error| FarmError::Request(format!("the plan has no JSON form: {error}")))?;
    if store.create(PLAN, &text)? == Created::Taken {
        return Job::open(store).map(|job| (summary, Some(job)));
    }
    Ok((summary, Some(Job { store, plan })))
}

/// A line about a program that this machine does not have: nodes may have it all the same.
fn not_here(farm: &FarmConfig) -> Option<String> {
    let program = farm.after_frame.first()?;
    let is_here = is_here(program, std::env::var_os("PATH").as_deref());
    (!is_here).then(|| format!("[farm] after_frame: this machine has no program {program:?}; every node must have it"))
}

/// Refuses to divide a job anew, since workers and engines know its tasks by their numbers. It goes by the options: times are measured
/// with every plan, and the same options may divide a little otherwise.
fn refuse_other_division(old: &Plan, options: &PlanOptions, place: &str) -> Result<(), FarmError> {
    if old.cpus == options.cpus && old.minutes.is_none_or(|minutes| minutes == options.minutes) {
        return Ok(());
    }
    let PlanOptions { minutes, cpus } = options;
    let divided = old.minutes.map_or(String::new(), |minutes| format!("--minutes {minutes} ")) + &format!("--cpus {}", old.cpus);
    let problem = format!("{place} holds this job, divided by {divided}; --minutes {minutes} --cpus {cpus} would divide it otherwise");
    Err(FarmError::Request(format!("{problem}: give the same, or plan it into another place")))
}

fn planned(scene: &PreparedScene, out: &Path, to: Option<&Store>) -> Result<PlannedScene, FarmError> {
    let forecast = &scene.forecast;
    Ok(PlannedScene {
        name: scene.name.clone(),
        files: stored(&scene.files, out, to)?,
        frames: scene.trajectories.iter().map(|(_, frames)| frames.len() as u64).sum(),
        cpu_s: forecast.cpu_s,
        memory_bytes: forecast.memory_bytes,
        disk_bytes: forecast.disk_bytes,
    })
}

/// Names files by their contents, and puts these into a store. Each is read once.
fn stored(files: &[PathBuf], out: &Path, to: Option<&Store>) -> Result<BTreeMap<String, StoredFile>, FarmError> {
    let file = |path: &PathBuf| {
        let full = out.join(path);
        let bytes = std::fs::read(&full).map_err(|source| FarmError::io("read", &full, source))?;
        let name = path.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/");
        let file = StoredFile { blake3: blake3::hash(&bytes).to_hex().to_string(), bytes: bytes.len() as u64 };
        if let Some(store) = to {
            store.create(&object_name(&file.blake3), &bytes)?;
        }
        Ok((name, file))
    };
    files.iter().map(file).collect()
}

/// Divides a scene's frames: contiguous ones of one trajectory, since its guide is learned once per task, and of equal number.
fn tasks(scene: &PreparedScene, options: &PlanOptions) -> Vec<Task> {
    let frames: usize = scene.trajectories.iter().map(|(_, frames)| frames.len()).sum();
    let frame_cpu_s = scene.forecast.cpu_s.mean / frames.max(1) as f64;
    let wanted_cpu_s = options.minutes * 60.0 * f64::from(options.cpus.max(1));
    let max_frames = (wanted_cpu_s / frame_cpu_s.max(1e-6)).clamp(1.0, 1e6) as usize;
    let divide = |(camera, frames): &(String, Vec<u32>)| -> Vec<Task> {
        let pieces = frames.len().div_ceil(max_frames).max(1);
        let piece =
            |i: usize| frames[i * frames.len() / pieces..(i + 1) * frames.len() / pieces].iter().copied().collect::<BTreeSet<u32>>();
        let task = |frames: BTreeSet<u32>| Task {
            cpu_s: frame_cpu_s * frames.len() as f64,
            part: Part { scene: scene.name.clone(), camera: camera.clone(), frames },
        };
        (0..pieces).map(piece).filter(|frames| !frames.is_empty()).map(task).collect()
    };
    scene.trajectories.iter().flat_map(divide).collect()
}

/// Identifies the inputs of the frames: scenes, their labels, and all that is in the dataset by then, such as trajectories. The records of
/// stages contain the times that these took, and are ignored.
fn identity(config: &Config, prepared: &Prepared, plan: &Plan) -> String {
    let decides =
        |path: &str| !path.starts_with(WORKDIR) || [".scene", "label_table.csv", "labels.json"].iter().any(|end| path.ends_with(end));
    let contents = |scene: &PlannedScene| -> Vec<String> {
        scene.files.iter().filter(|(path, _)| decides(path)).map(|(_, file)| file.blake3.clone()).collect()
    };
    let scenes: Vec<_> = plan.scenes.iter().map(|scene| (&scene.name, contents(scene))).collect();
    let frames: Vec<_> = prepared.scenes.iter().map(|scene| &scene.trajectories).collect();
    let text = serde_json::to_vec(&(FORMAT, program(), config, scenes, frames)).unwrap_or_default();
    blake3::hash(&text).to_hex().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_pipeline::Forecast;

    fn scene(frames: u32, cpu_s: f64) -> PreparedScene {
        let forecast = Forecast { cpu_s: Expected { mean: cpu_s, deviation: 0.0 }, ..Forecast::default() };
        let trajectories = vec![("cam_00".into(), (0..frames).collect()), ("cam_01".into(), vec![3, 5])];
        PreparedScene { name: "room".into(), forecast, trajectories, files: Vec::new() }
    }

    #[test]
    fn tasks_take_the_time_that_is_wanted_and_hold_every_frame_once() {
        // 102 frames of 100 s: 12 frames are 20 minutes of one thread.
        let made = tasks(&scene(100, 10_200.0), &PlanOptions { minutes: 20.0, cpus: 1 });
        let sizes: Vec<usize> = made.iter().map(|task| task.part.frames.len()).collect();
        assert_eq!((sizes.len(), sizes.iter().sum::<usize>()), (10, 102), "{sizes:?}");
        assert!(sizes[..9].iter().all(|n| (11..=12).contains(n)), "{sizes:?}");
        assert!(made.iter().all(|task| (task.cpu_s - 100.0 * task.part.frames.len() as f64).abs() < 1e-6));
        let all: BTreeSet<u32> = made[..9].iter().flat_map(|task| task.part.frames.clone()).collect();
        assert_eq!(all, (0..100).collect());
        assert_eq!(made[9].part.frames, BTreeSet::from([3, 5]));
    }

    #[test]
    fn a_job_is_not_divided_by_other_options_than_the_first() {
        let old = |minutes| Plan {
            format: FORMAT,
            program: program(),
            id: String::new(),
            dataset: "rooms".into(),
            files: BTreeMap::new(),
            scenes: Vec::new(),
            tasks: tasks(&scene(10, 100.0), &PlanOptions::default()),
            cpus: 8,
            minutes,
            farm: FarmConfig::default(),
        };
        let again = |minutes, cpus| refuse_other_division(&old(Some(15.0)), &PlanOptions { minutes, cpus }, "/shared/job");
        again(15.0, 8).unwrap();
        let error = again(15.0, 4).unwrap_err().to_string();
        assert!(error.starts_with("/shared/job holds this job, divided by --minutes 15 --cpus 8; --minutes 15 --cpus 4 would"), "{error}");
        assert!(matches!(again(30.0, 8), Err(FarmError::Request(_))));
        // A value that an older plan lacks counts as equal.
        refuse_other_division(&old(None), &PlanOptions { minutes: 30.0, cpus: 8 }, "/shared/job").unwrap();
        assert!(refuse_other_division(&old(None), &PlanOptions { minutes: 30.0, cpus: 4 }, "/shared/job").is_err());
    }

    #[test]
    fn a_job_of_another_version_is_refused_by_its_name_whatever_else_it_holds() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(PLAN), r#"{"format": 2, "program": "enfilade 9.0.0", "tasks": "in a file of their own"}"#)
            .unwrap();
        let store = Store::open(folder.path().to_str().unwrap(), std::iter::empty()).unwrap();
        let message = Job::open(store).unwrap_err().to_string();
        assert!(
            message.contains("was planned by enfilade 9.0.0") && message.contains("use enfilade 9.0.0, or plan the job again"),
            "{message}"
        );
    }

    #[test]
    fn a_plan_is_told_with_what_it_will_cost() {
        let expected = |mean, deviation| Expected { mean, deviation };
        let planned = PlannedScene {
            name: "room".into(),
            files: BTreeMap::new(),
            frames: 102,
            cpu_s: expected(7200.0, 720.0),
            memory_bytes: Expected::default(),
            disk_bytes: Expected::default(),
        };
        let plan = Plan {
            format: FORMAT,
            program: program(),
            id: String::new(),
            dataset: "rooms".into(),
            files: BTreeMap::new(),
            scenes: vec![planned],
            tasks: tasks(&scene(100, 7200.0), &PlanOptions::default()),
            cpus: 8,
            minutes: None,
            farm: FarmConfig::default(),
        };
        let told = plan.statement(&[Price::new("spot", 0.5)]);
        assert_eq!((told.frames, told.scenes, told.vcpu_hours), (102, 1, expected(2.0, 0.2)));
        assert_eq!(told.prices[0].dollars, expected(1.0, 0.1));
        assert!(PlanOptions { minutes: 0.0, cpus: 1 }.check().is_err() && PlanOptions { minutes: f64::NAN, cpus: 1 }.check().is_err());
        assert!(PlanOptions { minutes: 1.0, cpus: 0 }.check().is_err() && PlanOptions::default().check().is_ok());
    }

    #[test]
    fn a_frame_that_takes_long_is_a_task_of_its_own() {
        let made = tasks(&scene(5, 7e6), &PlanOptions::default());
        assert!(made.iter().all(|task| task.part.frames.len() == 1), "{made:?}");
    }
}
