//! The configuration of a dataset, from `dataset.toml` or for the demo.
//!
//! [`resolve`] reads the keys of the file and lays its levels over each other; what comes out, with every default filled in, are the
//! `settings`. `checks` has the ranges of all values, wherever they come from.

mod camera;
mod checks;
mod choices;
pub mod demo;
mod document;
mod expand;
mod farm;
mod files;
mod import;
mod locate;
mod presets;
mod products;
mod rendering;
mod resolve;
mod select;
mod sensors;
mod settings;
#[cfg(test)]
mod tests;
mod vary;

use crate::error::Error;
use crate::workdir::refuse_other_text;
use enfilade_import::Format;
use enfilade_scene::{GIT_LFS_POINTER, decoded_text, is_git_lfs_pointer};
use resolve::resolve;
use settings::environment_variable;
use std::path::Path;

pub use camera::{CameraConfig, CameraModel, LensConfig, StereoConfig};
pub use choices::{Overrides, Quality, RenderChoices};
pub use farm::{FarmConfig, Placeholder};
pub(crate) use files::models;
pub use import::{FileSource, Lamps};
pub use select::select;
pub use sensors::read_sensors;
pub use settings::{CameraChoice, Config, LabelSource, SceneConfig, Source, Varies};

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
        let unreadable = |e| {
            Error::usage(
                format!("cannot read {}: {e}", file.display()),
                "name a TOML file or the folder of a dataset, or make the demo: enfilade run --demo out",
            )
        };
        let bytes = std::fs::read(file).map_err(unreadable)?;
        let text = decoded_text(&bytes);
        if is_git_lfs_pointer(&bytes) {
            return Err(Error::usage(format!("{} is {GIT_LFS_POINTER}", file.display()), "fetch the file, and do this again"));
        }
        let absolute = std::path::absolute(file).map_err(Error::io("find", file))?;
        refuse_other_text(&absolute)?;
        let mut config = resolve(file, &text, overrides, &environment_variable)?;
        config.base = absolute.parent().map(Path::to_path_buf).unwrap_or_default();
        Ok(config)
    }

    /// The demo: one generated room.
    ///
    /// # Errors
    /// When an override is out of its range.
    pub fn demo(overrides: &Overrides) -> Result<Self, Error> {
        let text = format!(
            "name = \"demo\"\nseed = {}\nframes = {}\nrender.size = {:?}\nrender.samples = {}\nplan.mode.kind = \"walk\"\n[[scene]]\nname = \"{}\"\nhome = {}\ncameras = [\"{}\"]\n",
            demo::SEED,
            demo::FRAMES,
            demo::SIZE,
            demo::SAMPLES,
            demo::SCENE,
            demo::HOME,
            demo::CAMERA
        );
        Ok(resolve(Path::new("demo"), &text, overrides, &|_| None)?)
    }
}
