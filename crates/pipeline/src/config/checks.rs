//! What is refused while a configuration is read: values out of their ranges, names and files that cannot be.

use super::choices::{check_noise, check_positive, check_samples};
use super::document::Resolver;
use super::expand::expand;
use super::locate::ConfigError;
use super::patch::RenderPatch;
use super::{CameraConfig, SceneConfig};
use enfilade_dataset::read_ray_grid;
use enfilade_post::label::LabelTable;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// Pixels along the longer side of an image.
const LARGEST_SIDE: u32 = 16_384;
/// Frame numbers have four digits.
const MOST_FRAMES: u32 = 10_000;

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

    pub(super) fn checked_name(&self, name: &Spanned<String>, what: &str) -> Result<String, ConfigError> {
        let text = name.get_ref();
        let allowed = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
        if text.is_empty() || text.starts_with('.') || !text.chars().all(allowed) {
            let help = "names become folders: use letters, digits, '-', '_' and '.', and do not begin with '.'";
            return Err(self.refuse(name, format!("{text:?} cannot be the {what}"), help));
        }
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
        if let Some(radius) = render.filter_radius.as_ref().filter(|v| !(*v.get_ref() >= 0.0 && v.get_ref().is_finite())) {
            let message = format!("filter_radius must be 0 or more pixels, found {}", radius.get_ref());
            return Err(self.refuse(radius, message, "for example: filter_radius = 1"));
        }
        match render.save_every_s.as_ref().filter(|v| !(*v.get_ref() >= 0.0 && v.get_ref().is_finite())) {
            Some(interval) => {
                let message = format!("save_every_s must be at least 0, found {}", interval.get_ref());
                Err(self.refuse(interval, message, "for example: save_every_s = 30"))
            }
            None => Ok(()),
        }
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
