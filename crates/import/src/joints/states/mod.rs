//! Stored runs of simulators: the state of every joint, or the pose of every body, step by step.
//!
//! | file | contents |
//! |---|---|
//! | `.npz` of MuJoCo | `qpos` (steps × nq, in MuJoCo's order), with `mocap_pos` and `mocap_quat` if there are such bodies; or `xpos` (steps × bodies × 3) and `xquat` (steps × bodies × 4: w, x, y, z), with `body_names` if they are not all the model's in its order |
//! | `.npz` or `.csv` of joints | an array or a column for each joint, by its name: radians or metres |
//! | `time` | seconds of each step, in all of them |

mod apply;
mod npz;

pub(crate) use apply::{Tree, apply};

use crate::ImportError;
use crate::assembly::Assembly;
use npz::{Array, Values};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Most steps of a run; a frame shows one moment, and 200,000 are two hours at 30 frames per second.
const MOST_STEPS: usize = 200_000;

/// Names of arrays of MuJoCo.
const OF_MUJOCO: [&str; 6] = ["time", "qpos", "xpos", "xquat", "mocap_pos", "mocap_quat"];

/// A stored run.
pub(crate) struct States {
    file: PathBuf,
    arrays: BTreeMap<String, Array>,
    times_s: Vec<f64>,
}

/// An array of numbers, by step.
struct Track<'s> {
    name: &'s str,
    steps: usize,
    values: &'s [f64],
    /// Lengths of its axes behind the first one.
    axes: &'s [usize],
}

impl States {
    /// Reads the run that the import options name; `None` if they name none. `step_s` is the time of a step, if the model states one.
    ///
    /// # Errors
    /// When it cannot be read, its arrays have different numbers of steps, or a moment is no number or comes before the one ahead.
    pub(crate) fn read(step_s: Option<f64>, a: &mut Assembly) -> Result<Option<Self>, ImportError> {
        let Some(file) = a.options().states.clone() else { return Ok(None) };
        // The path is the caller's, not the scene file's.
        let bytes = std::fs::read(&file).map_err(|source| {
            let remedy = "the import options name it as the states; correct the path".to_string();
            ImportError::Read { file: file.clone(), source, remedy }
        })?;
        a.note_inputs(std::slice::from_ref(&file));
        let is_text = file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"));
        let read = if is_text { columns(&bytes) } else { npz::arrays(&file, bytes) };
        let arrays = read.map_err(|(place, problem)| ImportError::malformed(&file, place, problem))?;
        let mut states = Self { file, arrays, times_s: Vec::new() };
        states.times_s = states.moments(step_s, a)?;
        Ok(Some(states))
    }

    fn moments(&self, step_s: Option<f64>, a: &mut Assembly) -> Result<Vec<f64>, ImportError> {
        let steps = self.used().map(|track| (track.steps, track.name)).max();
        let Some((steps, longest)) = steps.filter(|(steps, _)| *steps > 0) else {
            return Err(self.wrong("whole file", "there are no steps in it; expected arrays with a first axis of steps".into()));
        };
        if steps > MOST_STEPS {
            let problem = format!("{steps} steps, more than {MOST_STEPS}; save every n-th (qpos[::{}])", steps.div_ceil(MOST_STEPS));
            return Err(self.wrong(&format!("array {longest:?}"), problem));
        }
        let times = match (self.track("time")?, step_s) {
            (Some(time), _) => time.values.to_vec(),
            (None, Some(step_s)) => {
                a.warn(
                    self.file.display().to_string(),
                    format!("there is no array time: a step was taken for {step_s} s, the model's timestep"),
                );
                (0..steps).map(|step| step as f64 * step_s).collect()
            }
            (None, None) => return Err(self.wrong("array \"time\"", "it is missing; add the seconds of every step".into())),
        };
        for track in self.used() {
            if track.steps != times.len() {
                let [found, expected] = [track.steps, times.len()];
                let problem = format!("it has {found} steps, but time has {expected}; cut all to the shortest, or save the run again");
                return Err(self.wrong(&format!("array {:?}", track.name), problem));
            }
        }
        if let Some(step) = times.iter().position(|time| !time.is_finite()) {
            return Err(self.wrong("array \"time\"", format!("step {step} is {}, expected seconds", times[step])));
        }
        if let Some(at) = times.windows(2).position(|pair| pair[1] < pair[0]) {
            let problem = format!("step {} ({} s) comes before the one ahead of it ({} s)", at + 1, times[at + 1], times[at]);
            return Err(self.wrong("array \"time\"", problem));
        }
        Ok(times)
    }

    /// The arrays of numbers.
    fn tracks(&self) -> impl Iterator<Item = Track<'_>> {
        self.arrays.iter().filter_map(|(name, array)| match &array.values {
            Values::Numbers(values) if !array.shape.is_empty() => {
                Some(Track { name, steps: array.shape[0], values, axes: &array.shape[1..] })
            }
            _ => None,
        })
    }

    /// The arrays of numbers that are states: those of MuJoCo if one is there, and else all.
    fn used(&self) -> impl Iterator<Item = Track<'_>> {
        let of_mujoco = self.arrays.contains_key("qpos") || self.arrays.contains_key("xpos");
        self.tracks().filter(move |track| !of_mujoco || OF_MUJOCO.contains(&track.name))
    }

    /// The array of numbers of a name, if it is there.
    fn track(&self, name: &str) -> Result<Option<Track<'_>>, ImportError> {
        if !self.arrays.contains_key(name) {
            return Ok(None);
        }
        let found = self.tracks().find(|track| track.name == name);
        found.map(Some).ok_or_else(|| self.wrong(&format!("array {name:?}"), "it has no numbers by step; save it as float64".into()))
    }

    /// The array of numbers of a name, of which there are as many by step as `axes` says.
    fn shaped(&self, name: &str, axes: &[usize], what: &str) -> Result<Option<Track<'_>>, ImportError> {
        let Some(track) = self.track(name)? else { return Ok(None) };
        if track.axes == axes {
            return Ok(Some(track));
        }
        let problem = format!("found {:?} values by step, expected {axes:?}: {what}; are these states of another model?", track.axes);
        Err(self.wrong(&format!("array {name:?}"), problem))
    }

    /// The texts of an array, if it is there.
    fn texts(&self, name: &str) -> Option<&[String]> {
        match &self.arrays.get(name)?.values {
            Values::Texts(texts) => Some(texts),
            Values::Numbers(_) => None,
        }
    }

    /// The names of all arrays but the time.
    fn names(&self) -> impl Iterator<Item = &str> {
        self.arrays.keys().map(String::as_str).filter(|name| *name != "time")
    }

    fn wrong(&self, place: &str, problem: String) -> ImportError {
        ImportError::malformed(&self.file, place, problem)
    }
}

impl Track<'_> {
    /// Number of values of a step.
    fn width(&self) -> usize {
        self.axes.iter().product()
    }

    /// The values of a step from `first` on.
    fn step(&self, step: usize, first: usize, count: usize) -> &[f64] {
        &self.values[step * self.width() + first..][..count]
    }
}

/// The columns of a table in CSV, by the names in its first row. Where semicolons or tabs separate them, numbers may have decimal commas.
fn columns(bytes: &[u8]) -> Result<BTreeMap<String, Array>, (String, String)> {
    let text = enfilade_scene::decoded_text(bytes);
    let head = text.lines().next().unwrap_or_default();
    let delimiter = [b',', b';', b'\t'].into_iter().find(|mark| head.contains(char::from(*mark))).unwrap_or(b',');
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).delimiter(delimiter).from_reader(text.as_bytes());
    let malformed = |error: csv::Error| ("table".to_string(), error.to_string());
    let names: Vec<String> = reader.headers().map_err(malformed)?.iter().map(str::to_string).collect();
    let mut columns = vec![Vec::new(); names.len()];
    for (row, record) in reader.records().enumerate() {
        for ((column, value), name) in columns.iter_mut().zip(&record.map_err(malformed)?).zip(&names) {
            let problem = || (format!("column {name:?}"), format!("row {} has {value:?}, expected a number", row + 2));
            let decimal = if delimiter == b',' { value.to_string() } else { value.replacen(',', ".", 1) };
            column.push(decimal.parse::<f64>().map_err(|_| problem())?);
        }
    }
    let array = |values: Vec<f64>| Array { shape: vec![values.len()], values: Values::Numbers(values) };
    Ok(names.into_iter().zip(columns.into_iter().map(array)).collect())
}

/// The error of a file of states for a scene whose format has no joints.
pub(crate) fn refuse(file: &Path, format: &str) -> ImportError {
    let problem = format!(
        "found {}, but the scene is {format}; expected a model of MuJoCo (MJCF), or a file with joints in URDF, SDF or USD",
        file.display()
    );
    ImportError::Option { option: "states", problem }
}
