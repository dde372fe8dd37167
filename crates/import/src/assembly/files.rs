//! Files that a scene is made of: those that it refers to by paths as it spells them, and its pictures.

use super::Assembly;
use crate::ImportError;
use crate::archive::Archive;
use crate::images::{self, Decoded, Use};
use enfilade_scene::{GIT_LFS_POINTER, is_git_lfs_pointer};
use std::path::{Component, Path, PathBuf};

/// The source of a picture's bytes.
pub(crate) enum Source<'a> {
    /// A file, by a path as the scene file spells it.
    File(&'a str),
    /// Inside the scene file: the place, which is also the name, and the bytes.
    Embedded(String, &'a [u8]),
    /// Nowhere: a place inside an archive that does not have it.
    Missing(String),
}

/// The folder of a file; the working directory has no name.
pub(super) fn folder_of(file: &Path) -> &Path {
    file.parent().unwrap_or(Path::new(""))
}

impl Assembly<'_> {
    /// The bytes of the scene file itself.
    pub(crate) fn read_scene_file(&mut self) -> Result<Vec<u8>, ImportError> {
        let file = self.file.clone();
        self.read_input(&file, "check the path and the permission to read it")
    }

    /// The bytes of a file that the scene file refers to by `path`, with the path it was found at.
    pub(crate) fn read(&mut self, path: &str) -> Result<(PathBuf, Vec<u8>), ImportError> {
        let file = self.resolve(path);
        self.report_case(path, &file);
        let remedy = format!("{} refers to it; put the file there or correct the reference", self.file.display());
        let bytes = self.read_input(&file, &remedy)?;
        Ok((file, bytes))
    }

    /// The bytes of a file that `from`, a file of the scene, refers to by `path`, and the path at which it was found: in the folder of
    /// `from`, or else in the folder of the scene file.
    pub(crate) fn read_from(&mut self, from: &Path, path: &str) -> Result<(PathBuf, Vec<u8>), ImportError> {
        match self.beside(from, path) {
            Some(beside) => {
                let bytes = self.read_input(&beside, "check the permission to read it")?;
                Ok((beside, bytes))
            }
            None => self.read(path),
        }
    }

    /// The file in the folder of `from`, a file of the scene, that `path` means; `None` where there is none.
    pub(crate) fn beside(&self, from: &Path, path: &str) -> Option<PathBuf> {
        let folder = folder_of(from);
        [folder.join(path), folder.join(path.replace('\\', "/"))].into_iter().find(|file| self.is_file(file))
    }

    /// A file of the scene as the scene file itself would spell it.
    pub(crate) fn spelled(&self, file: &Path) -> String {
        file.strip_prefix(folder_of(&self.file)).unwrap_or(file).to_string_lossy().into_owned()
    }

    /// Looks for files in `folder` first from now on, then in those added before it, then beside the scene file. `folder` is spelled as
    /// in `from`, a file of the scene. False where there is no such folder.
    pub(crate) fn look_in(&mut self, from: &Path, folder: &str) -> bool {
        let folder = folder.replace('\\', "/");
        let places = [from, self.file.as_path()].map(|file| folder_of(file).join(&folder));
        let is_folder = |place: &PathBuf| self.archive.map_or_else(|| place.is_dir(), |archive| archive.contains_folder(place));
        let found = places.into_iter().find(is_folder);
        let is_there = found.is_some();
        self.folders.extend(found);
        is_there
    }

    /// The bytes of a file by its whole path; `remedy` is the advice if it cannot be read.
    pub(crate) fn read_input(&mut self, file: &Path, remedy: &str) -> Result<Vec<u8>, ImportError> {
        let unreadable = |source: std::io::Error| ImportError::Read { file: file.to_path_buf(), source, remedy: remedy.to_string() };
        if self.archive.is_none() {
            let found = std::fs::metadata(file);
            if found.as_ref().is_err_and(|error| error.kind() == std::io::ErrorKind::NotFound) {
                self.note_missing(file);
            }
            // A device would be read without end, and a pipe would block.
            if !found.map_err(unreadable)?.is_file() {
                return Err(unreadable(std::io::Error::other("it is no file")));
            }
        }
        let read = self.archive.map_or_else(|| std::fs::read(file), |archive| archive.read_path(file));
        let bytes = read.map_err(unreadable)?;
        if self.archive.is_none() && !self.inputs.iter().any(|i| i == file) {
            self.inputs.push(file.to_path_buf());
        }
        if is_git_lfs_pointer(&bytes) {
            return Err(ImportError::GitLfs { file: file.to_path_buf() });
        }
        Ok(bytes)
    }

    /// The result of reading a mesh file that `user`, a shape of the scene, refers to by `path`. `None` when it is missing or broken and
    /// the options allow that.
    ///
    /// # Errors
    /// When they do not.
    pub(crate) fn mesh_or_none<T>(&mut self, read: Result<T, ImportError>, path: &str, user: &str) -> Result<Option<T>, ImportError> {
        let (problem, error) = match read {
            Ok(read) => return Ok(Some(read)),
            Err(error @ ImportError::Malformed { .. }) => (format!("is damaged ({error})"), Some(error)),
            Err(ImportError::Read { source, .. }) => (format!("cannot be read ({source})"), None),
            Err(error @ ImportError::GitLfs { .. }) => (format!("is {GIT_LFS_POINTER}"), Some(error)),
            Err(other) => return Err(other),
        };
        let mesh = self.resolve(path).to_string_lossy().into_owned();
        if self.options.allow_missing_meshes {
            self.warn(user, format!("the mesh {mesh} {problem}; it was left out"));
            return Ok(None);
        }
        let (file, user) = (self.file.clone(), user.to_string());
        Err(error.unwrap_or(ImportError::Mesh { file, user, mesh, problem }))
    }

    /// The name in the scene of the picture in `file`: its path from the scene file's folder or within the archive, or its name alone if it
    /// is elsewhere. So the scene does not depend on the location of its folder.
    pub(super) fn picture_name(&self, file: &Path) -> String {
        let home = self.archive.map_or_else(|| folder_of(&self.file), Archive::file);
        let inside = file.strip_prefix(home).ok().filter(|path| path.is_relative());
        let name = inside.unwrap_or_else(|| file.file_name().map_or(file, Path::new));
        let parts = name.components().filter(|part| *part != Component::CurDir);
        parts.map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
    }

    /// The index of a picture, decoded at first use. `user` is the material or light that wants it. `None` when it is missing
    /// and the options allow that; then a plain value must replace it.
    pub(crate) fn image(&mut self, source: &Source, usage: Use, user: &str) -> Result<Option<u32>, ImportError> {
        self.image_or(source, usage, user, "a plain grey stands in")
    }

    /// The index of a picture of light, as [`Assembly::image`] gives it; `None` when it is missing, and then the light is left out.
    pub(crate) fn light_image(&mut self, source: &Source, user: &str) -> Result<Option<u32>, ImportError> {
        self.image_or(source, Use::Color, user, "the light is left out")
    }

    fn image_or(&mut self, source: &Source, usage: Use, user: &str, instead: &str) -> Result<Option<u32>, ImportError> {
        let (key, problem) = match self.try_image(source, usage, user)? {
            Ok(index) => return Ok(Some(index)),
            Err(failed) => failed,
        };
        if self.images.insert((key.clone(), usage), None).is_some() {
            self.warn(user, format!("the texture {key} is missing here as well; {instead}"));
        } else if self.options.allow_missing_textures {
            self.warn(user, format!("the texture {key} {problem}; {instead}"));
        } else {
            return Err(ImportError::Texture { file: self.file.clone(), user: user.to_string(), texture: key, problem });
        }
        Ok(None)
    }

    /// The index of a picture, decoded at first use, or its name and what is wrong with it.
    pub(crate) fn try_image(&mut self, source: &Source, usage: Use, user: &str) -> Result<Result<u32, (String, String)>, ImportError> {
        let elsewhere = match source {
            Source::File(path) if !self.exists(path) => self.elsewhere(path).map(|found| (self.resolve(path), found)),
            _ => None,
        };
        let found = elsewhere.as_ref().map(|(_, found)| Source::File(found));
        let source = found.as_ref().unwrap_or(source);
        let key = match source {
            Source::File(path) => self.resolve(path).to_string_lossy().into_owned(),
            Source::Embedded(place, _) | Source::Missing(place) => place.clone(),
        };
        if let Some(&found) = self.images.get(&(key.clone(), usage)) {
            return Ok(found.ok_or_else(|| (key, String::new())));
        }
        if let Some((stated, found)) = &elsewhere {
            self.warn(user, format!("the texture {} is not there; {found}, which is called alike, was used", stated.display()));
            if !self.missing.contains(stated) {
                self.missing.push(stated.clone());
            }
        }
        let decoded = match self.decoded(source, usage)? {
            Ok(decoded) => decoded,
            Err(problem) => return Ok(Err((key, problem))),
        };
        if let Some(note) = decoded.note {
            self.warn(user, format!("texture {key}: {note}"));
        }
        let index = self.push_image(decoded.image);
        self.picture_files.extend(decoded.file.map(|file| (index, file)));
        self.images.insert((key, usage), Some(index));
        Ok(Ok(index))
    }

    /// A picture, or what is wrong with it.
    fn decoded(&mut self, source: &Source, usage: Use) -> Result<Result<Decoded, String>, ImportError> {
        Ok(match source {
            Source::File(path) => match self.read(path) {
                Ok((file, bytes)) => images::decode(&self.picture_name(&file), &bytes, usage),
                Err(ImportError::Read { source, .. }) => Err(format!("cannot be read ({source})")),
                Err(ImportError::GitLfs { .. }) => Err(format!("is {GIT_LFS_POINTER}")),
                Err(other) => return Err(other),
            },
            Source::Embedded(place, bytes) => images::decode(place, bytes, usage),
            Source::Missing(_) => Err("is not in the archive".to_string()),
        })
    }
}
