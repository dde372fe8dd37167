//! What to make, with every default filled in.
//!
//! It goes into the dataset's manifest and into the work folder, and the parts of it that a stage reads are hashed to tell whether the
//! stage must run again: a field that is renamed or written otherwise makes everything anew.

use super::camera::CameraConfig;
use super::expand::expand;
use super::farm::FarmConfig;
use super::import::FileSource;
use super::select::select;
use crate::error::Error;
use crate::request::Request;
use enfilade_compose::{MotionGroup, ObjectGroup};
use enfilade_dataset::ColorKind;
use enfilade_explore::{CarveConfig, PlanConfig, Preset};
use enfilade_home::HomeConfig;
use enfilade_math::hash_u64;
use enfilade_render::RenderConfig;
use enfilade_vary::{Seeds, VaryConfig};
use enfilade_verify::view_gates::GateConfig;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

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
    /// What nodes of a farm do besides. It changes no other file of the dataset.
    #[serde(default, skip_serializing_if = "FarmConfig::is_default")]
    pub farm: FarmConfig,
}

/// One scene of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneConfig {
    /// Name in the dataset: of `a` to `z`, `A` to `Z`, digits, `-`, `_` and `.`.
    pub name: String,
    /// Seed of trajectories and of the renderer's noise.
    pub seed: u64,
    /// Where the scene comes from.
    pub source: Source,
    /// Models that are placed in it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub objects: Vec<ObjectGroup>,
    /// What moves in it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub motions: Vec<MotionGroup>,
    /// The scene of which it is a variation, and what varies; `None` for scenes by themselves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub varies: Option<Varies>,
    /// Where its labels come from; `None` takes what comes with the scene.
    pub labels: Option<LabelSource>,
    /// What kind of room it is, in Hypersim's words; `None` where its rooms say it, or nothing does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scene_type: Option<String>,
    /// Cameras where trajectories begin, one trajectory each; empty means all of the file's, or found ones if it has none.
    pub cameras: Vec<CameraChoice>,
    /// Trajectories begin at places that are found, whatever cameras the file has.
    #[serde(default, skip_serializing_if = "is_false")]
    pub finds_cameras: bool,
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
    /// What `color`, `diffuse_illumination` and `residual` hold.
    #[serde(default)]
    pub color: ColorKind,
    /// Where they are denoised, keeps what was rendered beside them, as layers that are named `*_rendered`.
    #[serde(default = "keep_rendered")]
    pub keep_rendered: bool,
    /// The library to denoise with, in settings that earlier versions stored.
    #[serde(default)]
    pub(super) denoiser: Gone,
    /// What is made of it beside the outputs of the stages.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub products: Vec<Request>,
}

/// What a scene is a variation of. It shares that scene's geometry, free space and trajectories.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Varies {
    /// Name of the first scene, which is before it in the configuration.
    pub of: String,
    /// Number of the variation, from 1.
    pub number: u32,
    /// Numbers of its light, its materials and its arrangement, from 0.
    pub sets: [u32; 3],
    /// What varies.
    pub config: VaryConfig,
}

/// A setting of earlier versions: any stored value is read and ignored, and `null` is stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(super) struct Gone;

impl<'de> Deserialize<'de> for Gone {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        serde::de::IgnoredAny::deserialize(deserializer).map(|_| Self)
    }
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

/// Who wants less on disk says so; who wants what was rendered later cannot.
pub(super) const fn keep_rendered() -> bool {
    true
}

/// After a crash at most this much of a frame's work is lost.
pub(super) const fn save_every_s() -> f64 {
    30.0
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_false(value: &bool) -> bool {
    !value
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

impl Config {
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
        let expanded = expand(written, &environment_variable)
            .map_err(|e| Error::scene(format!("in the path {written:?}: {e}"), "set the variable (export NAME=…) and run again"))?;
        Ok(self.base.join(expanded))
    }
}

impl SceneConfig {
    /// Takes labels from `table` from now on, with the rows of the scene as before. Variations take theirs from the first scene.
    pub(crate) fn set_label_table(&mut self, table: &str) {
        if self.varies.is_some() {
            return;
        }
        let scene = self.labels.take().map_or_else(|| self.name.clone(), |labels| labels.scene);
        self.labels = Some(LabelSource { table: table.replace('$', "$$"), scene });
    }

    /// Seed of the part of the work named by `purpose`: different for every scene and purpose.
    pub fn seed_for(&self, purpose: &str) -> u64 {
        self.seed_of(&self.name, purpose)
    }

    /// [`SceneConfig::seed_for`] the scene `name` of the same seed.
    fn seed_of(&self, name: &str, purpose: &str) -> u64 {
        let text = name.bytes().chain([0]).chain(purpose.bytes());
        text.fold(hash_u64(self.seed), |hash, byte| hash_u64(hash ^ u64::from(byte)))
    }

    /// The seeds of a variation: of its place and of its sets, which are those of all variations of the first scene.
    pub(crate) fn variation_seeds(&self, varies: &Varies) -> Seeds {
        let of_set = |kind: &str, set: u32| self.seed_of(&varies.of, &format!("vary/{kind}/{set}"));
        let [light, materials, arrangement] = varies.sets;
        Seeds {
            place: self.seed_of(&varies.of, "vary/place"),
            light: of_set("light", light),
            materials: of_set("materials", materials),
            arrangement: of_set("arrangement", arrangement),
        }
    }

    /// [`SceneConfig::seed_for`] exploring by a preset: for variations that of the first scene. Hypersim's programs are given the seed as it
    /// is, 0 unless told otherwise.
    pub fn exploring_seed(&self, purpose: &str, preset: Preset) -> u64 {
        match preset {
            Preset::Default | Preset::Paper => self.seed_of(self.varies.as_ref().map_or(&self.name, |varies| &varies.of), purpose),
            Preset::Hypersim => self.seed,
        }
    }
}

pub(super) fn environment_variable(name: &str) -> Option<String> {
    std::env::var(name).ok()
}
