//! Why an import fails: one error for all formats, each case with file, place, what was found and what to do.

use enfilade_scene::{GIT_LFS_POINTER, PackageError, SceneError};
use std::path::{Path, PathBuf};

/// Why a scene file could not be imported. Every message names the file, the place in it, what was found and what to do.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The file name's extension belongs to no importer.
    #[error("{}: {found}; expected one of {known}", file.display())]
    UnknownFormat {
        /// The scene file.
        file: PathBuf,
        /// The extension that was found.
        found: String,
        /// The extensions that are known.
        known: String,
    },
    /// A file that cannot be read.
    #[error("{}: cannot be read ({source}); {remedy}", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// The system's error.
        source: std::io::Error,
        /// Advice on what to do.
        remedy: String,
    },
    /// The pointer that Git LFS leaves in the place of a file that it has not fetched.
    #[error("{}: this is {GIT_LFS_POINTER}", file.display())]
    GitLfs {
        /// The file.
        file: PathBuf,
    },
    /// A file whose content is not what its format calls for.
    #[error("{}: {place}: {problem}", file.display())]
    Malformed {
        /// The file.
        file: PathBuf,
        /// Place in it: a line, an element, an index.
        place: String,
        /// What was found, what was expected, and what to do.
        problem: String,
    },
    /// A texture that is not there or cannot be decoded.
    #[error(
        "{}: {user} needs the texture {texture}, which {problem}; {}, or go on with plain colours: --allow-missing-textures on the command \
         line, allow_missing_textures = true in dataset.toml",
        file.display(),
        remedy(problem)
    )]
    Texture {
        /// The scene file.
        file: PathBuf,
        /// The material or light that uses the texture.
        user: String,
        /// The texture's file, or its place in the scene file.
        texture: String,
        /// The fault.
        problem: String,
    },
    /// A mesh in a file of its own that is not there.
    #[error(
        "{}: {user} needs the mesh {mesh}, which {problem}; put the file there or correct the path in the scene, or go on without it: \
         --allow-missing-meshes on the command line, allow_missing_meshes = true in dataset.toml",
        file.display()
    )]
    Mesh {
        /// The scene file.
        file: PathBuf,
        /// The shape that uses the mesh.
        user: String,
        /// The mesh's file.
        mesh: String,
        /// The fault.
        problem: String,
    },
    /// A scene package that cannot be read.
    #[error("{}: {source}", file.display())]
    Package {
        /// The package.
        file: PathBuf,
        /// The fault.
        source: PackageError,
    },
    /// The file was read, but what it describes is not a usable scene.
    #[error("{}: {source}{told}", file.display())]
    Scene {
        /// The scene file.
        file: PathBuf,
        /// The fault.
        source: SceneError,
        /// What was left out of a scene of which nothing is left, as a sentence; else empty.
        told: String,
    },
    /// An option whose value makes no sense.
    #[error("import option {option}: {problem} (on the command line: --{})", option.replace('_', "-"))]
    Option {
        /// Name of the option.
        option: &'static str,
        /// What was found and what was expected.
        problem: String,
    },
}

/// Advice about a texture, by its fault.
fn remedy(problem: &str) -> &'static str {
    if problem.starts_with("cannot be read") || problem.starts_with("is not in the archive") {
        "put the file there, beside the scene or into a folder textures beside it, or correct the path in the scene"
    } else if problem.contains(GIT_LFS_POINTER) {
        "import again then"
    } else if problem.ends_with("not a picture") {
        "download or copy the picture again"
    } else {
        "save the picture as PNG or JPEG, under this name or with the new one in the scene"
    }
}

impl ImportError {
    /// A [`ImportError::Malformed`] in few words.
    pub(crate) fn malformed(file: &Path, place: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Malformed { file: file.to_path_buf(), place: place.into(), problem: problem.into() }
    }
}
