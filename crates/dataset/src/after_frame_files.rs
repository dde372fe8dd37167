//! Output of a user's program for a frame on a node of a farm: a folder per frame, `_detail/<camera>/after_frame/frame.IIII/`.
//!
//! The program decides the contents; this module only lists the files. The folder is removed with its frame.

use crate::atomic::remove_folder;
use crate::{Dataset, DatasetError, check_name};
use std::fs;
use std::path::{Path, PathBuf};

impl Dataset {
    /// Makes the folder for a program's files of a frame, and empties it.
    ///
    /// # Errors
    /// When a name cannot be a folder's, or the folder cannot be made or emptied.
    pub fn begin_after_frame(&self, scene: &str, camera: &str, frame: u32) -> Result<PathBuf, DatasetError> {
        check_name("scene name", scene)?;
        check_name("camera name", camera)?;
        let folder = self.layout().after_frame(scene, camera, frame);
        remove_folder(&folder)?;
        fs::create_dir_all(&folder).map_err(DatasetError::at("create the folder", &folder))?;
        Ok(folder)
    }

    /// The files that a program has left of a frame, also those in folders, in the order of their paths; folders without files do not count.
    ///
    /// # Errors
    /// When a folder cannot be read, and for what other machines could not be given: links, devices, and names that are not UTF-8.
    pub fn after_frame_files(&self, scene: &str, camera: &str, frame: u32) -> Result<Vec<PathBuf>, DatasetError> {
        let mut files = Vec::new();
        add_files(&self.layout().after_frame(scene, camera, frame), &mut files)?;
        files.sort();
        Ok(files)
    }

    /// Removes a program's files of a frame, if there are any.
    ///
    /// # Errors
    /// When it cannot be removed.
    pub fn remove_after_frame(&self, scene: &str, camera: &str, frame: u32) -> Result<(), DatasetError> {
        remove_folder(&self.layout().after_frame(scene, camera, frame))
    }
}

fn add_files(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), DatasetError> {
    for entry in fs::read_dir(folder).map_err(DatasetError::at("read the folder", folder))? {
        let entry = entry.map_err(DatasetError::at("read the folder", folder))?;
        let path = entry.path();
        let kind = entry.file_type().map_err(DatasetError::at("look at", &path))?;
        let refuse = |problem: &str| DatasetError::Unstorable { what: path.display().to_string(), problem: problem.into() };
        if entry.file_name().to_str().is_none() {
            return Err(refuse("its name is not UTF-8; leave files with such names"));
        }
        match (kind.is_dir(), kind.is_file()) {
            (true, _) => add_files(&path, files)?,
            (_, true) => files.push(path),
            _ => return Err(refuse("it is a link or a device, and only files can be taken elsewhere; leave a copy")),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_a_program_are_listed_in_order_and_the_next_begins_with_none() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let made = dataset.begin_after_frame("room", "cam_00", 7).unwrap();
        assert_eq!(made, folder.path().join("scenes/room/_detail/cam_00/after_frame/frame.0007"));
        for name in ["b.txt", "a/one.bin", "empty/no"] {
            fs::create_dir_all(made.join(name).parent().unwrap()).unwrap();
            fs::write(made.join(name), name).unwrap();
        }
        fs::remove_file(made.join("empty/no")).unwrap();
        assert_eq!(dataset.after_frame_files("room", "cam_00", 7).unwrap(), ["a/one.bin", "b.txt"].map(|name| made.join(name)));
        dataset.begin_after_frame("room", "cam_00", 7).unwrap();
        assert!(dataset.after_frame_files("room", "cam_00", 7).unwrap().is_empty());
        dataset.remove_after_frame("room", "cam_00", 7).unwrap();
        assert!(dataset.after_frame_files("room", "cam_00", 7).is_err() && !made.exists());
        assert!(dataset.begin_after_frame("..", "cam_00", 7).is_err());
    }

    #[test]
    #[cfg(unix)]
    fn links_are_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let made = dataset.begin_after_frame("room", "cam_00", 0).unwrap();
        std::os::unix::fs::symlink("/etc/hostname", made.join("host")).unwrap();
        let error = dataset.after_frame_files("room", "cam_00", 0).unwrap_err().to_string();
        assert!(error.contains("frame.0000/host cannot be stored: it is a link"), "{error}");
    }
}
