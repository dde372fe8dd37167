//! A scene in the form of some program: a file, and those that it names.

use std::collections::BTreeMap;
use std::error::Error;

/// A file that holds or describes a scene, and those that it names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SceneFiles {
    /// The file itself.
    pub main: Vec<u8>,
    /// Files by their paths from its folder, with slashes.
    pub beside: BTreeMap<String, Vec<u8>>,
    /// Guesses, and what the form cannot represent.
    pub notes: Vec<String>,
}

/// The files of a scene, or why there cannot be any.
pub type EncodedScene = Result<SceneFiles, Box<dyn Error + Send + Sync>>;

impl From<Vec<u8>> for SceneFiles {
    /// A file that names no others and loses nothing.
    fn from(main: Vec<u8>) -> Self {
        Self { main, ..Self::default() }
    }
}
