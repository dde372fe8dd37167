//! What is refused while a configuration is read: values out of their ranges, names and files that cannot be.

use super::choices::{check_filter_radius, check_noise, check_positive, check_samples, check_save_interval};
use super::document::Resolver;
use super::expand::expand;
use super::locate::ConfigError;
use super::patch::{RenderPatch, gate_problem};
use super::{CameraConfig, Config, SceneConfig, Source};
use crate::error::Error;
use crate::workdir::OWN_FILES;
use enfilade_dataset::{check_name, read_ray_grid};
use enfilade_label::LabelTable;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// Pixels along the longer side of an image.
const LARGEST_SIDE: u32 = 16_384;
/// Frame numbers have four digits.
const MOST_FRAMES: u32 = 10_000;
/// What names of scenes are made of.
const NAMES: &str = "names become folders: use 1 to 200 letters, digits, '-', '_' and '.', and do not begin with '.'";

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
        let mut names = HashSet::new();
        for scene in &self.scenes {
            if !names.insert(scene.name.as_str()) {
                return Err(Error::usage(format!("two scenes have the name {:?}", scene.name), "names of scenes must be unique"));
            }
            check_scene_name(&scene.name).map_err(|help| Error::usage(no_scene_name(&scene.name), help))?;
            let good = "the configuration of the demo has good values";
            scene.check().map_err(|problem| Error::usage(format!("scene {:?}: {problem}", scene.name), good))?;
        }
        Ok(())
    }
}

impl SceneConfig {
    fn check(&self) -> Result<(), String> {
        let within = |section: &str, problem: Option<String>| problem.map_or(Ok(()), |problem| Err(format!("in `{section}`: {problem}")));
        match &self.source {
            Source::File(file) => check_meters_per_unit(file.meters_per_unit)?,
            Source::Home(home) => within("home", home.problem())?,
        }
        check_size(self.size)?;
        self.fov_x_deg.map_or(Ok(()), |fov| check_fov(fov, &self.camera))?;
        within("camera", self.camera.problem(self.size))?;
        within("carve", self.carve.validate().err().map(|e| e.to_string()))?;
        check_frames(self.plan.frames)?;
        within("plan", self.plan.validate().err().map(|e| e.to_string()))?;
        within("gate", gate_problem(&self.gate))?;
        self.check_rendering()
    }

    fn check_rendering(&self) -> Result<(), String> {
        check_samples(self.render.samples)?;
        self.render.noise.map_or(Ok(()), check_noise)?;
        self.render.clamp.map_or(Ok(()), |clamp| check_positive("clamp", f64::from(clamp)))?;
        check_filter_radius(self.render.filter_radius)?;
        self.time_limit_s.map_or(Ok(()), |limit| check_positive("time_limit_s", limit))?;
        check_save_interval(self.save_every_s)
    }
}

impl Resolver<'_> {
    /// Refuses a label table that the last stages could not use.
    pub(super) fn check_table(&self, table: &Spanned<String>) -> Result<(), ConfigError> {
        let Some(path) = self.new_file(table.get_ref(), table, "label table")? else { return Ok(()) };
        let refuse = |message: String| self.refuse(table, message, "correct the table, or name another one");
        let bytes = std::fs::read(&path).map_err(|e| refuse(format!("cannot read the label table {}: {e}", path.display())))?;
        LabelTable::parse(&bytes, &path.display().to_string()).map(drop).map_err(|e| refuse(e.to_string()))
    }

    /// Refuses a camera that cannot be, and notes which images its matrix is of.
    pub(super) fn check_camera(&self, scene: &mut SceneConfig, camera: &Spanned<CameraConfig>) -> Result<(), ConfigError> {
        if let Some(file) = &scene.camera.ray_grid
            && let Some(path) = self.new_file(file, camera, "ray grid")?
        {
            read_ray_grid(&path, scene.size).map_err(|e| self.refuse(camera, e.to_string(), "docs/cameras.md explains the file"))?;
        }
        if scene.camera.k.is_some() {
            scene.camera.k_size.get_or_insert(scene.size);
        }
        match scene.camera.problem(scene.size) {
            Some(problem) => Err(self.refuse(camera, problem, "the keys of [camera] are explained in docs/cameras.md")),
            None => Ok(()),
        }
    }

    pub(super) fn check_path<T>(&self, path: &str, place: &Spanned<T>) -> Result<(), ConfigError> {
        self.expanded(path, place).map(drop)
    }

    fn expanded<T>(&self, path: &str, place: &Spanned<T>) -> Result<String, ConfigError> {
        let help = "set the variable before running, as in: export NAME=/path/to/folder";
        expand(path, self.variable).map_err(|e| self.refuse(place, e, help))
    }

    /// The file that `path` means, which must be there; `None` when it was looked at before.
    fn new_file<T>(&self, path: &str, place: &Spanned<T>, what: &str) -> Result<Option<PathBuf>, ConfigError> {
        let folder = self.source.file.parent().unwrap_or(Path::new(""));
        let found = folder.join(self.expanded(path, place)?);
        if !found.is_file() {
            let help = "check the path for a typing mistake; it begins in the folder of the configuration";
            return Err(self.refuse(place, format!("there is no {what} {}", found.display()), help));
        }
        Ok(self.looked_at.borrow_mut().insert(found.clone()).then_some(found))
    }

    /// The name of the dataset.
    pub(super) fn checked_name(&self, name: &Spanned<String>) -> Result<String, ConfigError> {
        let text = name.get_ref();
        check_name("name", text).map_err(|_| self.refuse(name, format!("{text:?} cannot be the name"), NAMES))?;
        Ok(text.clone())
    }

    pub(super) fn checked_scene_name(&self, name: &Spanned<String>) -> Result<String, ConfigError> {
        let text = name.get_ref();
        check_scene_name(text).map_err(|help| self.refuse(name, no_scene_name(text), help))?;
        Ok(text.clone())
    }

    /// Refuses numbers out of their range.
    pub(super) fn check_render(&self, render: &RenderPatch) -> Result<(), ConfigError> {
        if let Some(samples) = &render.samples {
            check_samples(*samples.get_ref()).map_err(|m| self.refuse(samples, m, "for example: samples = 64"))?;
        }
        if let Some(noise) = &render.noise {
            check_noise(*noise.get_ref()).map_err(|m| self.refuse(noise, m, "for example: noise = 0.02 for two per cent"))?;
        }
        if let Some(clamp) = &render.clamp {
            let check = check_positive("clamp", f64::from(*clamp.get_ref()));
            check.map_err(|m| self.refuse(clamp, m, "for example: clamp = 10; without the key nothing is clamped"))?;
        }
        if let Some(limit) = &render.time_limit_s {
            let check = check_positive("time_limit_s", *limit.get_ref());
            check.map_err(|m| self.refuse(limit, m, "for example: time_limit_s = 90; without the key there is no limit"))?;
        }
        if let Some(radius) = &render.filter_radius {
            check_filter_radius(*radius.get_ref()).map_err(|m| self.refuse(radius, m, "for example: filter_radius = 1"))?;
        }
        if let Some(interval) = &render.save_every_s {
            check_save_interval(*interval.get_ref()).map_err(|m| self.refuse(interval, m, "for example: save_every_s = 30"))?;
        }
        Ok(())
    }
}

pub(super) fn check_frames(frames: u32) -> Result<u32, String> {
    if (1..=MOST_FRAMES).contains(&frames) {
        Ok(frames)
    } else {
        Err(format!("frames must lie between 1 and {MOST_FRAMES}, found {frames}"))
    }
}

pub(super) fn check_size(size: [u32; 2]) -> Result<[u32; 2], String> {
    if size.iter().all(|s| (1..=LARGEST_SIDE).contains(s)) {
        return Ok(size);
    }
    Err(format!("width and height must lie between 1 and {LARGEST_SIDE} pixels, found {} x {}", size[0], size[1]))
}

/// Gives what to do where this cannot be the name of a scene.
fn check_scene_name(name: &str) -> Result<(), &'static str> {
    match check_name("scene name", name) {
        Err(_) => Err(NAMES),
        Ok(()) if OWN_FILES.contains(&name) => Err("a file of the work folder has it; take another"),
        Ok(()) => Ok(()),
    }
}

fn no_scene_name(name: &str) -> String {
    format!("{name:?} cannot be the name of a scene")
}

pub(super) fn check_fov(fov_x_deg: f64, camera: &CameraConfig) -> Result<(), String> {
    let limit = camera.fov_limit_deg();
    if fov_x_deg > 0.0 && fov_x_deg < limit {
        return Ok(());
    }
    Err(format!("fov_x_deg must lie between 0 and {limit}, found {fov_x_deg}"))
}

pub(super) fn check_meters_per_unit(meters: f64) -> Result<(), String> {
    if meters > 0.0 && meters.is_finite() { Ok(()) } else { Err(format!("meters_per_unit must be a positive number, found {meters}")) }
}
