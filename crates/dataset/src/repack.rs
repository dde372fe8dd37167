//! A copy of a dataset whose images are stored for fast reading.

use crate::atomic::remove_folder;
use crate::frames::attributes_of;
use crate::hdf5::{Storage, read_array, write_array};
use crate::layout::FIXTURE_PARTS;
use crate::read::sorted_names;
use crate::{Dataset, DatasetError, FileRecord, FrameEntry, Layout, replace_file, write_bytes, write_json};
use enfilade_frame::{LAYERS, Layer};
use enfilade_scene::{Counted, Cx};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

/// Size of a copy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Repacked {
    /// Images.
    pub files: u64,
    /// Bytes of these files in the dataset.
    pub bytes_before: u64,
    /// Bytes of these files in the copy.
    pub bytes_after: u64,
}

/// One image to be copied.
struct ImageCopy {
    from: PathBuf,
    to: PathBuf,
    /// Attributes of the copy.
    attributes: Vec<(&'static str, &'static str)>,
}

/// The sign by which a copy is known: nothing else is replaced.
const MARK: &str = "enfilade_repack.json";

/// Kind recorded in [`MARK`].
const MARK_KIND: &str = "enfilade repack 1";

/// Folder of an unfinished copy, within the copy's folder, because that may be a disk of its own.
const GROWING: &str = ".repack.partial";

/// Folder of an earlier copy until it is removed.
const OLD: &str = ".repack.old";

/// Held while a copy is made.
const LOCK: &str = ".repack.lock";

/// Names in the folder of a copy that are not part of it. `lost+found` is there where the folder is a disk of its own.
const BESIDE: [&str; 5] = [GROWING, OLD, LOCK, MARK, "lost+found"];

#[derive(Serialize, Deserialize)]
struct Mark {
    kind: String,
    enfilade_version: String,
}

/// Note about records in the manifest of a copy.
const RECORDS: &str = "This is a copy for fast reading: a frame counts when it has a file, and has no record; checksums are BLAKE3 of \
    whole files.";

impl Dataset {
    /// Copies the frames, cameras and tables of this dataset to `out`, with images as [`Storage::Fast`] and otherwise the same values, types
    /// and names. `layers` restricts it to some. Frames have no commit records in the copy, as in Hypersim's release; the manifest, where
    /// there is one, lists the files of the copy. Geometry and previews are left out. `cx` gets the progress of every image.
    ///
    /// An earlier copy at `out` is replaced as a whole, when all of the new one is there; anything else there is refused.
    ///
    /// # Errors
    /// When a file cannot be read or written, `out` contains something else than a copy, or one of `out` and the dataset is inside the
    /// other.
    pub fn repack(&self, out: &Path, layers: Option<&[Layer]>, cx: &dyn Cx) -> Result<Repacked, DatasetError> {
        let growing = Growing::prepare(out, self.root())?;
        let copy = &growing.copy;
        let mut images = Vec::new();
        copy_file(&self.camera_table(), &copy.layout().camera_parameters())?;
        copy_file(&self.layout().partition(), &copy.layout().partition())?;
        copy_file(&self.layout().scene_types(), &copy.layout().scene_types())?;
        for scene in self.scenes()? {
            copy_files(&self.layout().detail_dir(&scene), &copy.layout().detail_dir(&scene), |_| true)?;
            copy_files(&self.layout().mesh_dir(&scene), &copy.layout().mesh_dir(&scene), is_table)?;
            for camera in self.cameras(&scene)? {
                copy_files(&self.layout().camera_dir(&scene, &camera), &copy.layout().camera_dir(&scene, &camera), |_| true)?;
                self.list(copy.layout(), &scene, &camera, layers, &mut images)?;
            }
        }
        let counted = Counted::new(cx, "images", images.len());
        let sizes: Vec<[u64; 2]> = enfilade_parallel::try_map(&images, |image| counted.unit(|| image.run()))?;
        self.copy_manifest(copy)?;
        growing.take_place()?;
        let sum = |which: usize| sizes.iter().map(|sizes| sizes[which]).sum();
        Ok(Repacked { files: images.len() as u64, bytes_before: sum(0), bytes_after: sum(1) })
    }

    /// The images of a camera's complete frames.
    fn list(
        &self,
        copy: &Layout,
        scene: &str,
        camera: &str,
        layers: Option<&[Layer]>,
        images: &mut Vec<ImageCopy>,
    ) -> Result<(), DatasetError> {
        // The attributes are about values in metres.
        let released = self.is_released(scene);
        for frame in self.frame_numbers(scene, camera)? {
            for layer in LAYERS.iter().map(|spec| spec.layer).filter(|layer| layers.is_none_or(|layers| layers.contains(layer))) {
                let (from, to) = (self.layout().layer(scene, camera, frame, layer), copy.layer(scene, camera, frame, layer));
                if self.has_layer(scene, camera, frame, layer) {
                    images.push(ImageCopy { from, to, attributes: if released { Vec::new() } else { attributes_of(layer) } });
                }
            }
            if layers.is_none_or(|layers| FIXTURE_PARTS.iter().all(|part| layers.contains(part))) {
                let record = self.frame_record(scene, camera, frame)?;
                for fixture in 1..=record.map_or(0, |record| record.fixtures()) {
                    for layer in FIXTURE_PARTS {
                        let place = |layout: &Layout| layout.fixture_layer(scene, camera, frame, fixture, layer);
                        images.push(ImageCopy { from: place(self.layout()), to: place(copy), attributes: attributes_of(layer) });
                    }
                }
            }
        }
        Ok(())
    }

    /// Writes the manifest, where there is one, with the files that the copy has.
    fn copy_manifest(&self, copy: &Dataset) -> Result<(), DatasetError> {
        let Some(mut manifest) = self.read_manifest()? else { return Ok(()) };
        manifest.conventions.notes.insert("records".into(), RECORDS.into());
        for (scene, entry) in &mut manifest.scenes {
            let folder = copy.layout().scene_dir(scene);
            let frames: Vec<&mut FrameEntry> = entry.cameras.values_mut().flat_map(|camera| camera.frames.iter_mut()).collect();
            frames.into_par_iter().try_for_each(|frame| {
                frame.files.retain(|name, _| folder.join(name).is_file());
                frame.files.iter_mut().try_for_each(|(name, file)| {
                    *file = FileRecord::of(&folder.join(name))?;
                    Ok::<_, DatasetError>(())
                })
            })?;
        }
        copy.write_manifest(&manifest)
    }
}

/// A copy in the making; it is removed unless it takes its place.
struct Growing<'a> {
    /// The folder that it is for.
    out: &'a Path,
    copy: Dataset,
    is_whole: bool,
    _lock: File,
}

impl<'a> Growing<'a> {
    /// Makes the folder in which the copy grows, and removes one that a killed copy left.
    fn prepare(out: &'a Path, dataset: &Path) -> Result<Self, DatasetError> {
        fs::create_dir_all(out).map_err(DatasetError::at("create the folder", out))?;
        let place = |path: &Path| fs::canonicalize(path).map_err(DatasetError::at("find", path));
        let (target, source) = (place(out)?, place(dataset)?);
        let problem = if target.starts_with(&source) {
            "it would be inside the dataset; choose another folder"
        } else if source.starts_with(&target) {
            "the dataset is inside that folder; choose another one"
        } else if !entries(out)?.is_empty() && !is_copy(out) {
            "the folder is not empty, and what is there was not made by `repack`; choose another one, or move away what is there"
        } else {
            match lock(out)? {
                Some(lock) => {
                    let copy = out.join(GROWING);
                    remove_folder(&copy)?;
                    remove_folder(&out.join(OLD))?;
                    return Ok(Self { out, copy: Dataset::create(copy)?, is_whole: false, _lock: lock });
                }
                None => "another `repack` is at work there; wait until it has finished, or choose another folder",
            }
        };
        Err(DatasetError::Unstorable { what: format!("a copy in {}", out.display()), problem: problem.into() })
    }

    /// Replaces an earlier copy, of which nothing is removed before. The mark comes first, so that what is killed from here on is still
    /// known as a copy.
    fn take_place(mut self) -> Result<(), DatasetError> {
        self.is_whole = true;
        let mark = Mark { kind: MARK_KIND.into(), enfilade_version: env!("CARGO_PKG_VERSION").into() };
        write_json(&self.out.join(MARK), &mark)?;
        let old = self.out.join(OLD);
        fs::create_dir_all(&old).map_err(DatasetError::at("create the folder", &old))?;
        move_entries(self.out, &old)?;
        move_entries(self.copy.root(), self.out)?;
        // Files that are still in use are removed by the next copy.
        let _ = fs::remove_dir_all(&old);
        let _ = fs::remove_dir(self.copy.root());
        Ok(())
    }
}

impl Drop for Growing<'_> {
    fn drop(&mut self) {
        if !self.is_whole {
            let _ = fs::remove_dir_all(self.copy.root());
        }
        let _ = fs::remove_file(self.out.join(LOCK));
    }
}

/// Takes the lock of a folder; `None` where another has it. Some network file systems know no locks.
fn lock(out: &Path) -> Result<Option<File>, DatasetError> {
    let path = out.join(LOCK);
    let file = File::create(&path).map_err(DatasetError::at("write", &path))?;
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => Ok(None),
        Err(TryLockError::Error(error)) if error.kind() != std::io::ErrorKind::Unsupported => Err(DatasetError::io("lock", &path, error)),
        _ => Ok(Some(file)),
    }
}

/// Moves the contents of a folder into another one.
fn move_entries(from: &Path, to: &Path) -> Result<(), DatasetError> {
    for path in entries(from)? {
        let to = to.join(path.file_name().unwrap_or_default());
        fs::rename(&path, &to).map_err(DatasetError::at("put in place", &to))?;
    }
    Ok(())
}

/// The contents of a folder except for [`BESIDE`], sorted.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, DatasetError> {
    let found: std::io::Result<Vec<PathBuf>> = fs::read_dir(folder).and_then(|all| all.map(|entry| Ok(entry?.path())).collect());
    let mut paths = found.map_err(DatasetError::at("read the folder", folder))?;
    paths.retain(|path| !BESIDE.iter().any(|name| path.ends_with(name)));
    paths.sort_unstable();
    Ok(paths)
}

/// True for a folder with the mark of a copy.
fn is_copy(folder: &Path) -> bool {
    let mark = fs::read(folder.join(MARK)).ok().and_then(|bytes| serde_json::from_slice::<Mark>(&bytes).ok());
    mark.is_some_and(|mark| mark.kind == MARK_KIND)
}

impl ImageCopy {
    /// Gives the bytes before and after.
    fn run(&self) -> Result<[u64; 2], DatasetError> {
        let array = read_array(&self.from)?;
        replace_file(&self.to, |aside| write_array(aside, &array, Storage::Fast, &self.attributes))?;
        let size = |path: &Path| fs::metadata(path).map(|found| found.len()).map_err(DatasetError::at("read", path));
        Ok([size(&self.from)?, size(&self.to)?])
    }
}

/// Copies those files of a folder that are wanted, not those of the folders in it.
fn copy_files(from: &Path, to: &Path, wanted: fn(&str) -> bool) -> Result<(), DatasetError> {
    if !from.is_dir() {
        return Ok(());
    }
    let names = sorted_names(from)?;
    names.iter().filter(|name| wanted(name)).try_for_each(|name| copy_file(&from.join(name), &to.join(name)))
}

/// True for the files of the mesh folder that are no geometry: objects, labels and boxes.
fn is_table(name: &str) -> bool {
    !name.starts_with("mesh_") || name.starts_with("mesh_objects_")
}

/// Copies a file if it is there.
fn copy_file(from: &Path, to: &Path) -> Result<(), DatasetError> {
    if !from.is_file() {
        return Ok(());
    }
    write_bytes(to, fs::read(from).map_err(DatasetError::at("read", from))?)
}
