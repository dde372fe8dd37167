//! The ranges of everything in a configuration, wherever it comes from: a file, the command line or a program.
//!
//! What other crates read they check themselves (`validate`, `problem`); here are the other keys, and the order of all checks.

use super::camera::CameraConfig;
use super::import::FileSource;
use super::settings::{Config, SceneConfig, Source};
use crate::error::Error;
use crate::workdir::OWN_FILES;
use enfilade_dataset::check_name;
use enfilade_explore::ExploreError;
use enfilade_import::ImportError;
use enfilade_render::{RenderConfig, RenderError};
use std::collections::HashSet;

/// Pixels along the longer side of an image.
const LARGEST_SIDE: u32 = 16_384;
/// Frame numbers have four digits.
const MAX_FRAMES: u32 = 10_000;
/// What names of scenes are made of.
pub(super) const NAMES: &str = "names become folders, which have to be read everywhere: use 1 to 200 of a to z, A to Z, 0 to 9, '-', '_' and '.' \
     (Buero for Büro), and do not begin with '.'";

/// Where a key stands in `dataset.toml`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Section {
    /// The scene itself, or the file's top level.
    Scene,
    /// The scene itself, or `[import]`.
    Import,
    Home,
    Camera,
    Render,
    Carve,
    Plan,
    Gate,
}

/// A value that cannot be.
#[derive(Debug)]
pub(super) struct Misset {
    pub section: Section,
    /// The key; of a home and a camera the whole table is meant.
    pub key: &'static str,
    /// What was found and what was expected.
    pub message: String,
    /// What to write instead.
    pub help: &'static str,
}

impl Misset {
    fn new(section: Section, key: &'static str, message: impl Into<String>, help: &'static str) -> Self {
        Self { section, key, message: message.into(), help }
    }

    /// The message for someone who does not see the key.
    fn with_section(&self) -> String {
        let section = match self.section {
            Section::Scene | Section::Import | Section::Home | Section::Render => return self.message.clone(),
            Section::Camera => "camera",
            Section::Carve => "carve",
            Section::Plan => "plan",
            Section::Gate => "gate",
        };
        format!("in `{section}`: {}", self.message)
    }
}

impl Config {
    /// Refuses what [`Config::read`] refuses of names and numbers: for a configuration that a program has put together. Files are
    /// looked at by the stages that read them.
    ///
    /// # Errors
    /// When there is no scene, two have one name, a name cannot be a folder's, or a value is out of its range.
    pub fn check(&self) -> Result<(), Error> {
        if self.scenes.is_empty() {
            return Err(Error::usage("the configuration has no scenes", "add at least one; that of the demo has one"));
        }
        self.farm.validate().map_err(|wrong| Error::usage(format!("in `farm`: {}", wrong.message), wrong.help))?;
        let mut names = HashSet::new();
        for scene in &self.scenes {
            if !names.insert(scene.name.as_str()) {
                return Err(Error::usage(format!("two scenes have the name {:?}", scene.name), "names of scenes must be unique"));
            }
            check_scene_name(&scene.name).map_err(|help| Error::usage(no_scene_name(&scene.name), help))?;
            let good = "the configuration of the demo has good values";
            scene.validate().map_err(|wrong| Error::usage(format!("scene {:?}: {}", scene.name, wrong.with_section()), good))?;
        }
        Ok(())
    }
}

impl SceneConfig {
    /// Checks every value but names, and files, which must be read for that.
    ///
    /// # Errors
    /// The first one that cannot be.
    pub(super) fn validate(&self) -> Result<(), Misset> {
        match &self.source {
            Source::File(file) => check_import(file)?,
            Source::Home(home) => {
                found(home.problem(), |problem| Misset::new(Section::Home, "home", format!("in `home`: {problem}"), HOME))?;
            }
        }
        check_size(self.size)?;
        self.fov_x_deg.map_or(Ok(()), |fov| check_fov(fov, &self.camera))?;
        let help = "the keys of [camera] are explained in docs/cameras.md";
        found(self.camera.problem(self.size), |problem| Misset::new(Section::Camera, "camera", problem, help))?;
        let help = "the defaults are voxel_m = 0.1, extent_m = 30, rays = 262144 and iterations = 5";
        self.carve.validate().map_err(|error| of_exploring(Section::Carve, &error, help))?;
        check_frames(self.plan.frames)?;
        let help = "the keys of [plan] are explained in docs/trajectories.md";
        self.plan.validate().map_err(|error| of_exploring(Section::Plan, &error, help))?;
        self.gate.validate().map_err(|error| {
            let is_share = error.field.ends_with("_share");
            let help = if is_share { "for example: max_plane_share = 0.9" } else { "for example: min_depth_m = 0.3" };
            Misset::new(Section::Gate, error.field, error.to_string(), help)
        })?;
        check_rendering(&self.render, self.time_limit_s, self.save_every_s)
    }
}

/// What to write for surroundings.
const ENVIRONMENT: &str = "for example: environment = { file = \"sky.hdr\", scale = 1 }, \"sky\", \"overcast\", or \
    { sky = \"clear\", date = \"06-21\", hour = 15, latitude_deg = 45 }";

/// What to write for a home.
pub(super) const HOME: &str =
    "home = {} takes everything as it comes; home = { seed = 3, rooms = [\"living\", \"kitchen\", \"hall\"] } chooses";

fn found(problem: Option<String>, misset: impl FnOnce(String) -> Misset) -> Result<(), Misset> {
    problem.map_or(Ok(()), |problem| Err(misset(problem)))
}

fn check_import(file: &FileSource) -> Result<(), Misset> {
    file.importer().validate().map_err(|error| match error {
        ImportError::Option { option: key @ "environment", problem } => {
            Misset::new(Section::Import, key, format!("{key}: {problem}"), ENVIRONMENT)
        }
        ImportError::Option { option: key, problem } => {
            Misset::new(Section::Import, key, format!("{key}: {problem}"), "0.01 for a file in centimetres, 1 for one in metres")
        }
        other => Misset::new(Section::Import, "file", other.to_string(), "choose other options"),
    })
}

fn of_exploring(section: Section, error: &ExploreError, help: &'static str) -> Misset {
    let key = if let ExploreError::Config { field, .. } = error { *field } else { "mode" };
    Misset::new(section, key, error.to_string(), help)
}

/// Checks everything of `[render]` but the size and the field of view.
pub(super) fn check_rendering(render: &RenderConfig, time_limit_s: Option<f64>, save_every_s: f64) -> Result<(), Misset> {
    render.validate().map_err(|error| {
        let key = if let RenderError::Config { field, .. } = &error { *field } else { "samples" };
        Misset::new(Section::Render, key, error.to_string(), example(key))
    })?;
    let refuse = |key, message: String| Err(Misset::new(Section::Render, key, message, example(key)));
    match time_limit_s {
        Some(limit) if !(limit > 0.0 && limit.is_finite()) => {
            refuse("time_limit_s", format!("time_limit_s must be above 0, found {limit}"))
        }
        _ if !(save_every_s >= 0.0 && save_every_s.is_finite()) => {
            refuse("save_every_s", format!("save_every_s must be at least 0, found {save_every_s}"))
        }
        _ => Ok(()),
    }
}

/// A good value of a key of `[render]`.
fn example(key: &str) -> &'static str {
    match key {
        "noise" => "for example: noise = 0.02 for two per cent",
        "clamp" => "for example: clamp = 10; without the key nothing is clamped",
        "filter_radius" => "for example: filter_radius = 1",
        "time_limit_s" => "for example: time_limit_s = 90; without the key there is no limit",
        "save_every_s" => "for example: save_every_s = 30",
        _ => "for example: samples = 64",
    }
}

fn check_frames(frames: u32) -> Result<(), Misset> {
    if (1..=MAX_FRAMES).contains(&frames) {
        return Ok(());
    }
    let message = format!("frames must lie between 1 and {MAX_FRAMES}, found {frames}");
    Err(Misset::new(Section::Scene, "frames", message, "for example: frames = 100"))
}

fn check_size(size: [u32; 2]) -> Result<(), Misset> {
    if size.iter().all(|s| (1..=LARGEST_SIDE).contains(s)) {
        return Ok(());
    }
    let message = format!("width and height must lie between 1 and {LARGEST_SIDE} pixels, found {} x {}", size[0], size[1]);
    Err(Misset::new(Section::Render, "size", message, "for example: size = [1024, 768]"))
}

fn check_fov(fov_x_deg: f64, camera: &CameraConfig) -> Result<(), Misset> {
    let limit = camera.fov_limit_deg();
    if fov_x_deg > 0.0 && fov_x_deg < limit {
        return Ok(());
    }
    let message = format!("fov_x_deg must lie between 0 and {limit}, found {fov_x_deg}");
    Err(Misset::new(Section::Render, "fov_x_deg", message, "60 is a common choice"))
}

/// Gives what to do where this cannot be the name of a scene.
pub(super) fn check_scene_name(name: &str) -> Result<(), &'static str> {
    match check_name("scene name", name) {
        Err(_) => Err(NAMES),
        Ok(()) if OWN_FILES.contains(&name) => Err("a file of the work folder has it; take another"),
        Ok(()) => Ok(()),
    }
}

pub(super) fn no_scene_name(name: &str) -> String {
    format!("{name:?} cannot be the name of a scene")
}
