//! The repository's folder, and running programs in it.

use serde_json::Value;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The repository.
#[derive(Clone)]
pub struct House {
    /// Root folder of the house.
    pub root: PathBuf,
    /// Whether tests make their long searches too.
    pub searches: bool,
}

impl House {
    /// The repository that this program belongs to.
    ///
    /// # Errors
    /// When the program is not run by cargo.
    pub fn find() -> Result<Self, String> {
        let own = std::env::var_os("CARGO_MANIFEST_DIR").ok_or("run this as `cargo xtask`")?;
        let root = Path::new(&own).parent().ok_or("xtask has no folder above it")?;
        Ok(Self { root: root.to_path_buf(), searches: false })
    }

    /// `cargo` with these arguments, at the root.
    pub fn cargo(&self, arguments: &[&str]) -> Command {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        self.command(cargo, arguments)
    }

    /// A program with these arguments, at the root.
    pub fn command(&self, program: impl AsRef<OsStr>, arguments: &[&str]) -> Command {
        let mut command = Command::new(program);
        command.args(arguments).current_dir(&self.root);
        command
    }

    /// The text of a file, its path given from the root.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn read(&self, path: impl AsRef<Path>) -> Result<String, String> {
        let path = path.as_ref();
        std::fs::read_to_string(self.root.join(path)).map_err(|error| format!("cannot read {}: {error}", path.display()))
    }

    /// The output of `cargo metadata` with these further arguments.
    ///
    /// # Errors
    /// When cargo fails.
    pub fn metadata(&self, arguments: &[&str]) -> Result<Value, String> {
        let output = self.cargo(&["metadata", "--format-version", "1", "--locked"]).args(arguments).stderr(Stdio::inherit()).output();
        let output = output.map_err(|error| format!("cannot run cargo metadata: {error}"))?;
        if !output.status.success() {
            return Err("cargo metadata failed; if Cargo.lock is not up to date, run `cargo update --workspace` and commit it".into());
        }
        serde_json::from_slice(&output.stdout).map_err(|error| format!("cannot read what cargo metadata says: {error}"))
    }

    /// The target folder of cargo.
    ///
    /// # Errors
    /// When cargo fails.
    pub fn target(&self) -> Result<PathBuf, String> {
        let metadata = self.metadata(&["--no-deps"])?;
        let folder = metadata["target_directory"].as_str().ok_or("cargo metadata names no target directory")?;
        Ok(folder.into())
    }

    /// A program that was built with the tests.
    ///
    /// # Errors
    /// When cargo fails.
    pub fn tested(&self, program: &str) -> Result<PathBuf, String> {
        Ok(self.target()?.join("debug").join(format!("{program}{}", std::env::consts::EXE_SUFFIX)))
    }

    /// True when `cargo NAME` is installed.
    pub fn has_cargo_command(&self, name: &str) -> bool {
        let status = self.cargo(&[name, "--version"]).stdout(Stdio::null()).stderr(Stdio::null()).status();
        status.is_ok_and(|status| status.success())
    }

    /// True on a machine that runs unattended, where nothing may be left out.
    pub fn unattended() -> bool {
        std::env::var_os("CI").is_some_and(|value| !value.is_empty() && value != "false")
    }
}
