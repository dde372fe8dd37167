//! What to make: the resolved configuration of a dataset, from `dataset.toml` or for the demo.
//!
//! Resolved means that every default is filled in: it goes into the dataset's manifest, and the parts of it that a stage
//! reads are hashed to tell whether the stage must run again.

mod camera;
mod checks;
mod choices;
mod document;
mod expand;
mod locate;
mod patch;
#[cfg(test)]
mod tests;

use crate::error::Error;
use crate::workdir::refuse_other_text;
use enfilade_explore::{CarveConfig, PlanConfig, Preset};
use enfilade_home::HomeConfig;
use enfilade_import::{Format, UpAxis};
use enfilade_math::hash_u64;
use enfilade_render::RenderConfig;
use enfilade_verify::view_gates::GateConfig;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub use camera::{CameraConfig, CameraModel, LensConfig, StereoConfig};
pub use choices::RenderChoices;
pub(crate) use locate::closest;
pub use locate::{ConfigError, Place};

/// A dataset to make.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Where relative paths start: the folder of the TOML file. Not part of what is made.
    #[serde(skip)]
    pub base: PathBuf,
    /// Files that lie elsewhere now than their paths say, by the paths as they are written: a dataset that several machines make
    /// carries with it what the others cannot reach.
    #[serde(skip)]
    pub carried: BTreeMap<String, PathBuf>,
    /// Name of the dataset.
    pub name: String,
    /// In the order of the file; names are unique.
    pub scenes: Vec<SceneConfig>,
}

/// One scene of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneConfig {
    /// Name in the dataset: letters, digits, `-`, `_` and `.`.
    pub name: String,
    /// Seed of trajectories and of the renderer's noise.
    pub seed: u64,
    /// Where the scene comes from.
    pub source: Source,
    /// Where its labels come from; `None` takes what comes with the scene.
    pub labels: Option<LabelSource>,
    /// Cameras where trajectories begin, one trajectory each; empty means all of the file's, or found ones if it has none.
    pub cameras: Vec<CameraChoice>,
    /// Image width and height, pixels.
    pub size: [u32; 2],
    /// Horizontal field of view; `None` takes that of the scene's first used camera.
    pub fov_x_deg: Option<f64>,
    /// What the pictures are taken with.
    #[serde(default, skip_serializing_if = "CameraConfig::is_default")]
    pub camera: CameraConfig,
    /// Free-space carving. Its seed is made from `seed`.
    pub carve: CarveConfig,
    /// Trajectories. Its seed is made from `seed`; its test images get the pictures' field of view and shape.
    pub plan: PlanConfig,
    /// Which views are worth rendering.
    #[serde(default)]
    pub gate: GateConfig,
    /// Light transport. Its seed is made from `seed`, another for each camera.
    pub render: RenderConfig,
    /// Wall-clock seconds after which a frame ends with the samples that it has; `None` is no limit. Frames that it ends are not the
    /// same twice.
    #[serde(default)]
    pub time_limit_s: Option<f64>,
    /// Wall-clock seconds between the moments when a frame in the making is kept, for a run that is killed. Changes no byte.
    #[serde(default = "save_every_s")]
    pub save_every_s: f64,
    /// Makes denoised companions of the colour layers.
    #[serde(default)]
    pub denoise: bool,
    /// The library that denoises, its file or the folder that it lies in; as written. `None` takes what `ENFILADE_OIDN` names, or
    /// what the system has.
    #[serde(default)]
    pub denoise_library: Option<String>,
}

/// Where a scene comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// A file in one of the formats that `import` reads.
    File(FileSource),
    /// The procedural furnished home.
    Home(HomeConfig),
}

/// A scene file and what it does not say itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileSource {
    /// As written: may be relative and may hold environment variables.
    pub file: String,
    /// Metres per unit of the file.
    pub meters_per_unit: f64,
    /// `None` takes the format's own.
    pub up_axis: Option<UpAxis>,
    /// Replaces the file's surroundings.
    pub environment: Option<EnvironmentChoice>,
    /// Goes on, with a warning, where a texture file is missing.
    pub allow_missing_textures: bool,
}

/// An environment map for a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnvironmentChoice {
    /// An equirectangular picture; as written.
    pub file: String,
    /// Multiplies its radiance.
    #[serde(default = "one")]
    pub scale: f32,
    /// About the up axis.
    #[serde(default)]
    pub rotation_deg: f32,
}

/// As long as one may have to wait again after a crash.
const fn save_every_s() -> f64 {
    30.0
}

fn one() -> f32 {
    1.0
}

/// A label table and the rows of it that count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LabelSource {
    /// A CSV file; as written.
    pub table: String,
    /// Rows whose `scene` column is this (or empty) count.
    pub scene: String,
}

/// A camera where a trajectory begins.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, deny_unknown_fields)]
pub enum CameraChoice {
    /// One of the file's, by name.
    Named(String),
    /// An explicit one, in world space (metres, z up).
    Placed {
        /// Camera centre.
        position: [f64; 3],
        /// A point in the middle of the picture.
        look_at: [f64; 3],
    },
}

/// Samples per pixel by one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Quality {
    /// For a look: noisy.
    Draft,
    /// For use.
    Normal,
    /// For publication.
    High,
}

impl Quality {
    /// Samples per pixel.
    pub const fn samples(self) -> u32 {
        match self {
            Self::Draft => 8,
            Self::Normal => 64,
            Self::High => 512,
        }
    }
}

/// Choices that win over those of the configuration.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// Seed of everything; homes with a seed of their own keep it.
    pub seed: Option<u64>,
    /// Frames per trajectory.
    pub frames: Option<u32>,
    /// Image width and height.
    pub size: Option<[u32; 2]>,
    /// Samples per pixel.
    pub quality: Option<Quality>,
    /// Everything else about rendering; its samples win over `quality`.
    pub render: RenderChoices,
}

/// What the demo makes unless told otherwise. Chosen so that all of it takes less than a minute on two cores.
pub mod demo {
    /// Name of the demo's scene.
    pub const SCENE: &str = "home";
    /// Seed: a living room in the evening, whose lamps leave less noise in a minute than the sun does.
    pub const SEED: u64 = 16;
    /// The camera that the trajectory starts from; every home with a living room has it.
    pub const CAMERA: &str = "living_1";
    /// Frames of the trajectory.
    pub const FRAMES: u32 = 4;
    /// Image width and height.
    pub const SIZE: [u32; 2] = [320, 240];
    /// Samples per pixel.
    pub const SAMPLES: u32 = 96;
}

impl Config {
    /// Reads and resolves `file`.
    ///
    /// # Errors
    /// When it cannot be read, lies where the path is not UTF-8, is not TOML, holds an unknown key or a value out of its range, or names
    /// an environment variable that is not set, or a label table or a grid of rays that cannot be used.
    pub fn read(file: &Path, overrides: &Overrides) -> Result<Self, Error> {
        if Format::of(file).is_ok() {
            let message = format!("{} is a scene; expected a configuration that lists it", file.display());
            let hint = "write dataset.toml and name that instead:\n\n  [[scene]]\n  name = \"my-room\"\n  file = ";
            return Err(Error::usage(message, format!("{hint}{:?}", file.display().to_string())));
        }
        let unreadable =
            |e| Error::usage(format!("cannot read {}: {e}", file.display()), "name a TOML file, or make the demo: enfilade run --demo out");
        let text = std::fs::read_to_string(file).map_err(unreadable)?;
        let absolute = std::path::absolute(file).map_err(Error::io("find", file))?;
        refuse_other_text(&absolute)?;
        let mut config = document::resolve(file, &text, overrides, &environment_variable)?;
        config.base = absolute.parent().map(Path::to_path_buf).unwrap_or_default();
        Ok(config)
    }

    /// The demo: one generated home.
    ///
    /// # Errors
    /// When an override is out of its range.
    pub fn demo(overrides: &Overrides) -> Result<Self, Error> {
        let text = format!(
            "name = \"demo\"\nseed = {}\nframes = {}\nrender.size = {:?}\nrender.samples = {}\n[[scene]]\nname = \"{}\"\nhome = {{}}\ncameras = [\"{}\"]\n",
            demo::SEED,
            demo::FRAMES,
            demo::SIZE,
            demo::SAMPLES,
            demo::SCENE,
            demo::CAMERA
        );
        Ok(document::resolve(Path::new("demo"), &text, overrides, &|_| None)?)
    }

    /// The scenes whose names match `pattern`; see [`select`].
    ///
    /// # Errors
    /// When none does.
    pub fn select(&self, pattern: Option<&str>) -> Result<Vec<&SceneConfig>, Error> {
        let names: Vec<String> = self.scenes.iter().map(|s| s.name.clone()).collect();
        let chosen = select("scene", &names, pattern)?;
        Ok(self.scenes.iter().filter(|s| chosen.contains(&s.name)).collect())
    }

    /// The file meant by a path of the configuration.
    ///
    /// # Errors
    /// When it names an environment variable that is not set.
    pub fn path(&self, written: &str) -> Result<PathBuf, Error> {
        if let Some(carried) = self.carried.get(written) {
            return Ok(carried.clone());
        }
        let expanded = expand::expand(written, &environment_variable)
            .map_err(|e| Error::scene(format!("in the path {written:?}: {e}"), "set the variable (export NAME=…) and run again"))?;
        Ok(self.base.join(expanded))
    }
}

impl SceneConfig {
    /// Takes labels from `table` from now on, with the rows of the scene as before.
    pub(crate) fn set_label_table(&mut self, table: &str) {
        let scene = self.labels.take().map_or_else(|| self.name.clone(), |labels| labels.scene);
        self.labels = Some(LabelSource { table: table.replace('$', "$$"), scene });
    }

    /// Seed of the part of the work named by `purpose`: different for every scene and purpose.
    pub fn seed_for(&self, purpose: &str) -> u64 {
        let text = self.name.bytes().chain([0]).chain(purpose.bytes());
        text.fold(hash_u64(self.seed), |hash, byte| hash_u64(hash ^ u64::from(byte)))
    }

    /// [`SceneConfig::seed_for`] exploring by a preset. Hypersim's programs are given the seed as it is, 0 unless told otherwise.
    pub fn exploring_seed(&self, purpose: &str, preset: Preset) -> u64 {
        match preset {
            Preset::Default => self.seed_for(purpose),
            Preset::Hypersim => self.seed,
        }
    }
}

fn environment_variable(name: &str) -> Option<String> {
    std::env::var(name).ok()
}

/// The names (of things called `what`) that match `pattern`, in which `*` stands for any run of characters and `,` separates alternatives; all of
/// them without a pattern.
///
/// # Errors
/// When none does.
pub fn select(what: &str, names: &[String], pattern: Option<&str>) -> Result<Vec<String>, Error> {
    let Some(pattern) = pattern else { return Ok(names.to_vec()) };
    let chosen: Vec<String> = names.iter().filter(|name| pattern.split(',').any(|p| matches(p.trim(), name))).cloned().collect();
    if chosen.is_empty() {
        let known: Vec<&str> = names.iter().map(String::as_str).collect();
        let proposal = closest(pattern, &known).map_or(String::new(), |n| format!("did you mean {n:?}? "));
        let hint = format!("{proposal}the {what}s are: {}", names.join(", "));
        return Err(Error::usage(format!("no {what} is named {pattern:?}"), hint));
    }
    Ok(chosen)
}

/// Whether `name` fits `pattern`, in which `*` stands for any run of characters.
fn matches(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((head, tail)) => name
            .strip_prefix(head)
            .is_some_and(|rest| (0..=rest.len()).filter(|&i| rest.is_char_boundary(i)).any(|i| matches(tail, &rest[i..]))),
    }
}
