//! Frames go in whole: layers under temporary names, then all renamed, then the commit record.

use crate::atomic::{create_parent, remove_folder, remove_if_there, rename, temporary};
use crate::hdf5::{ArrayView, Packing, Storage, write_view};
use crate::layout_version::newer;
use crate::read::{frame_number, sorted_names};
use crate::record::RECORD_FORMAT;
use crate::{ColorKind, Dataset, DatasetError, FileRecord, FrameRecord, FrameTime, LabelRecord, Recipe, Sampling, check_name, write_json};
use enfilade_frame::{DENOISED, Frame, LAYERS, Layer, Pass, Values};
use enfilade_scene::{Camera, Pose};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The inputs of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameInfo {
    /// Seed of the random numbers.
    pub seed: u64,
    /// Samples per pixel.
    pub samples: u32,
    /// Hash of everything that the frame's values depend on; a frame with another hash is not complete.
    pub config_hash: String,
    /// Pose of the camera; its frame number is the frame's.
    pub pose: Pose,
    /// The camera.
    pub camera: Camera,
    /// Use of its samples, if that is known.
    pub sampling: Option<Sampling>,
    /// The program and settings that rendered it, if they are known.
    pub recipe: Option<Recipe>,
}

/// A frame in memory, and the layer under whose name each of its layers is stored.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'f> {
    frame: &'f Frame,
    name: fn(Layer) -> Layer,
}

impl<'f> From<&'f Frame> for Placed<'f> {
    fn from(frame: &'f Frame) -> Self {
        Self { frame, name: |layer| layer }
    }
}

impl Dataset {
    /// Writes a frame that was rendered elsewhere, with colour under its plain names: all its layers, then the commit record. The frame's
    /// number is the pose's.
    ///
    /// An older frame of that number, and its labels, cease to exist before the new files take their places, so that what is
    /// there is never a mixture. Frames may be written from several threads at once.
    ///
    /// # Errors
    /// When a file cannot be written. Then the frame does not count as complete, and the temporary files are gone.
    pub fn write_frame(
        &self,
        scene: &str,
        camera: &str,
        frame: &Frame,
        info: &FrameInfo,
        time: FrameTime,
    ) -> Result<FrameRecord, DatasetError> {
        self.write_placed([scene, camera], Placed { frame, name: |layer| layer }, info, time)
    }

    /// Writes a frame that was rendered, with colour under names that end with `_rendered`: its plain names are made from these, by
    /// [`Dataset::write_denoised`] or [`Dataset::link_rendered`], and until then the frame does not count as complete.
    ///
    /// # Errors
    /// As [`Dataset::write_frame`].
    pub fn write_rendered(
        &self,
        scene: &str,
        camera: &str,
        frame: &Frame,
        info: &FrameInfo,
        time: FrameTime,
    ) -> Result<FrameRecord, DatasetError> {
        let name = |layer| DENOISED.into_iter().find(|(plain, _)| *plain == layer).map_or(layer, |(_, kept)| kept);
        self.write_placed([scene, camera], Placed { frame, name }, info, time)
    }

    fn write_placed(
        &self,
        [scene, camera]: [&str; 2],
        placed: Placed<'_>,
        info: &FrameInfo,
        time: FrameTime,
    ) -> Result<FrameRecord, DatasetError> {
        check_name("scene name", scene)?;
        check_name("camera name", camera)?;
        self.make_records_dir(scene, camera)?;
        let number = info.pose.frame;
        let (intrinsics, camera_model) = FrameRecord::of_camera(&info.camera);
        let record = FrameRecord {
            format: RECORD_FORMAT,
            scene: scene.to_string(),
            camera: camera.to_string(),
            frame: number,
            seed: info.seed,
            samples: info.samples,
            config_hash: info.config_hash.clone(),
            sampling: info.sampling,
            pose: (&info.pose).into(),
            intrinsics,
            camera_model,
            recipe: info.recipe.clone(),
            color: ColorKind::Rendered,
            denoised: None,
            files: self.write_aside(scene, camera, number, placed)?,
        };
        let commit = || {
            self.remove_frame(scene, camera, number)?;
            self.put_in_place(scene, camera, number, placed)?;
            self.append_time(scene, camera, number, time)?;
            write_json(&self.layout().frame_record(scene, camera, number), &record)
        };
        if let Err(error) = commit() {
            self.remove_aside(scene, camera, number, placed);
            let _ = self.remove_frame(scene, camera, number);
            return Err(error);
        }
        Ok(record)
    }

    /// Writes the layers that `labels` has (`semantic`, `semantic_instance`) for frame number `frame`, then their record.
    /// `labels_hash` names the tables they were joined from.
    ///
    /// # Errors
    /// As [`Dataset::write_frame`].
    pub fn write_label_layers(
        &self,
        scene: &str,
        camera: &str,
        frame: u32,
        labels: &Frame,
        labels_hash: &str,
    ) -> Result<LabelRecord, DatasetError> {
        check_name("scene name", scene)?;
        check_name("camera name", camera)?;
        self.make_records_dir(scene, camera)?;
        let record = LabelRecord {
            format: RECORD_FORMAT,
            scene: scene.to_string(),
            camera: camera.to_string(),
            frame,
            labels_hash: labels_hash.to_string(),
            files: self.write_aside(scene, camera, frame, labels)?,
        };
        self.commit_beside(scene, camera, frame, labels, &self.layout().label_record(scene, camera, frame), &record)?;
        Ok(record)
    }

    /// Removes the frames of a camera whose record is not one that `stays`, or cannot be read: their layers and all their records.
    ///
    /// # Errors
    /// When the folder of records cannot be read, or a file cannot be removed.
    pub fn retain_frames(&self, scene: &str, camera: &str, stays: impl Fn(&FrameRecord) -> bool) -> Result<(), DatasetError> {
        let records = self.layout().records_dir(scene, camera);
        let names = if records.is_dir() { sorted_names(&records)? } else { Vec::new() };
        for frame in names.iter().filter_map(|name| frame_number(name, "json")) {
            let record = self.frame_record(scene, camera, frame).ok().flatten();
            if record.is_none_or(|record| !stays(&record)) {
                self.remove_frame(scene, camera, frame)?;
            }
        }
        Ok(())
    }

    /// The commit record of a frame; `None` when it has none.
    ///
    /// # Errors
    /// When the record cannot be read or understood.
    pub fn frame_record(&self, scene: &str, camera: &str, frame: u32) -> Result<Option<FrameRecord>, DatasetError> {
        read_record(&self.layout().frame_record(scene, camera, frame), "delete it and render the frame again")
    }

    /// The commit record of a frame's labels; `None` when it has none.
    ///
    /// # Errors
    /// When the record cannot be read or understood.
    pub fn label_record(&self, scene: &str, camera: &str, frame: u32) -> Result<Option<LabelRecord>, DatasetError> {
        read_record(&self.layout().label_record(scene, camera, frame), "delete it and run the label stage again")
    }

    /// Removes the temporary files that a killed run left in a camera's folders. Call it before frames are written, when no
    /// other process writes to this camera.
    ///
    /// # Errors
    /// When a folder cannot be read or a file cannot be removed.
    pub fn remove_temporaries(&self, scene: &str, camera: &str) -> Result<(), DatasetError> {
        let layout = self.layout();
        let folders_of = |pass| [layout.layer_dir(scene, camera, pass), layout.preview_dir(scene, camera, pass)];
        let images = [Pass::Final, Pass::Geometry].map(folders_of);
        let details = [layout.camera_dir(scene, camera), layout.records_dir(scene, camera), layout.surfaces_dir(scene, camera)];
        for folder in images.as_flattened().iter().chain(&details).filter(|folder| folder.is_dir()) {
            for name in sorted_names(folder)?.iter().filter(|name| crate::atomic::is_temporary(name)) {
                remove_if_there(&folder.join(name))?;
            }
        }
        Ok(())
    }

    /// Makes the folder of a camera's records; if it exists, only recorded frames count.
    pub(crate) fn make_records_dir(&self, scene: &str, camera: &str) -> Result<(), DatasetError> {
        let folder = self.layout().records_dir(scene, camera);
        fs::create_dir_all(&folder).map_err(DatasetError::at("create the folder", &folder))
    }

    /// Writes every layer under its temporary name, and returns the records of the final files. On an error no temporary file is left.
    pub(crate) fn write_aside<'f>(
        &self,
        scene: &str,
        camera: &str,
        number: u32,
        placed: impl Into<Placed<'f>>,
    ) -> Result<BTreeMap<String, FileRecord>, DatasetError> {
        let placed = placed.into();
        let size = [placed.frame.height as usize, placed.frame.width as usize];
        let files: Vec<_> = self.files_of(scene, camera, number, placed).collect();
        let write = |(path, layer, values, description): &(PathBuf, Layer, &Values, Option<String>)| {
            let record = write_file_aside(path, size, *layer, values, &attributes(*layer, description.as_deref()))?;
            Ok((self.name_in_scene(scene, path), record))
        };
        let written: Result<Vec<_>, DatasetError> = enfilade_parallel::try_map(&files, write);
        if written.is_err() {
            self.remove_aside(scene, camera, number, placed);
        }
        Ok(written?.into_iter().collect())
    }

    /// Removes what [`Self::write_aside`] wrote. Failures are ignored, since an earlier error is being returned.
    pub(crate) fn remove_aside<'f>(&self, scene: &str, camera: &str, number: u32, placed: impl Into<Placed<'f>>) {
        for (path, ..) in self.files_of(scene, camera, number, placed.into()) {
            let _ = fs::remove_file(temporary(&path));
        }
    }

    /// The files of all that a frame has in memory: where each goes, the layer that it is or is a part of, its values, and its description
    /// where that is not the layer's.
    fn files_of<'f>(
        &self,
        scene: &str,
        camera: &str,
        number: u32,
        Placed { frame, name }: Placed<'f>,
    ) -> impl Iterator<Item = (PathBuf, Layer, &'f Values, Option<String>)> {
        let layers =
            frame.iter().map(move |(layer, values)| (self.layout().layer(scene, camera, number, name(layer)), layer, values, None));
        layers.chain(self.fixture_layers(scene, camera, number, frame))
    }

    /// Renames the layers of `frame` from their temporary names, colour last: loaders that look for colour find all or nothing.
    pub(crate) fn put_in_place<'f>(
        &self,
        scene: &str,
        camera: &str,
        number: u32,
        placed: impl Into<Placed<'f>>,
    ) -> Result<(), DatasetError> {
        let mut files: Vec<_> = self.files_of(scene, camera, number, placed.into()).map(|(path, layer, ..)| (path, layer)).collect();
        files.sort_by_key(|&(_, layer)| layer == Layer::Color);
        files.iter().try_for_each(|(path, _)| rename(&temporary(path), path))
    }

    /// Puts layers that come after the frame in place of older ones, then writes their record.
    fn commit_beside(
        &self,
        scene: &str,
        camera: &str,
        number: u32,
        layers: &Frame,
        path: &Path,
        record: &impl Serialize,
    ) -> Result<(), DatasetError> {
        let commit = || {
            remove_if_there(path)?;
            self.put_in_place(scene, camera, number, layers)?;
            write_json(path, record)
        };
        commit().inspect_err(|_| self.remove_aside(scene, camera, number, layers))
    }

    /// Removes a frame with all its layers and records, in the order in which it ceases to count, and what a user's program has made of it.
    fn remove_frame(&self, scene: &str, camera: &str, number: u32) -> Result<(), DatasetError> {
        remove_if_there(&self.layout().frame_record(scene, camera, number))?;
        remove_if_there(&self.layout().label_record(scene, camera, number))?;
        LAYERS.iter().try_for_each(|spec| remove_if_there(&self.layout().layer(scene, camera, number, spec.layer)))?;
        self.remove_fixture_layers(scene, camera, number)?;
        remove_folder(&self.layout().after_frame(scene, camera, number))?;
        // What versions up to 0.1 wrote beside rendered layers.
        remove_if_there(&self.layout().records_dir(scene, camera).join(format!("frame.{number:04}.denoised.json")))?;
        let folder = self.layout().layer_dir(scene, camera, Pass::Final);
        let old =
            ["color", "diffuse_illumination", "residual"].map(|layer| folder.join(format!("frame.{number:04}.{layer}_denoised.hdf5")));
        old.iter().try_for_each(|path| remove_if_there(path))
    }

    /// A path relative to the scene's folder, with forward slashes.
    pub(crate) fn name_in_scene(&self, scene: &str, path: &Path) -> String {
        let relative = path.strip_prefix(self.layout().scene_dir(scene)).unwrap_or(path);
        relative.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
    }
}

/// The attributes of a layer's file.
pub(crate) fn attributes_of(layer: Layer) -> Vec<(&'static str, &'static str)> {
    let spec = layer.spec();
    let attributes = [("unit", spec.unit), ("space", spec.space), ("sentinel", spec.sentinel), ("description", spec.description)];
    attributes.into_iter().filter(|(_, value)| !value.is_empty()).collect()
}

/// The attributes of a file, with a description of its own where it has one.
fn attributes(layer: Layer, description: Option<&str>) -> Vec<(&'static str, &str)> {
    let mut attributes = attributes_of(layer);
    if let Some(own) = description {
        attributes.iter_mut().filter(|(name, _)| *name == "description").for_each(|(_, text)| *text = own);
    }
    attributes
}

/// Writes one layer, or an image with the meaning of one, in one step.
pub(crate) fn write_layer(path: &Path, size: [usize; 2], layer: Layer, values: &Values) -> Result<(), DatasetError> {
    write_file_aside(path, size, layer, values, &attributes_of(layer))?;
    rename(&temporary(path), path)
}

/// Writes an image that is like a layer under the temporary name of `path`, with attributes of its own.
fn write_file_aside(
    path: &Path,
    [height, width]: [usize; 2],
    layer: Layer,
    values: &Values,
    attributes: &[(&str, &str)],
) -> Result<FileRecord, DatasetError> {
    create_parent(path)?;
    let spec = layer.spec();
    let shape = [height, width, spec.channels];
    let shape = if spec.channels == 1 { &shape[..2] } else { &shape[..] };
    let aside = temporary(path);
    write_view(&aside, ArrayView::of_values(shape, values), Storage::Image(Packing::of_layer(layer)), attributes)?;
    FileRecord::of(&aside)
}

impl FileRecord {
    /// Size and checksum of the file at `path`.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn of(path: &Path) -> Result<Self, DatasetError> {
        let content = fs::read(path).map_err(DatasetError::at("read", path))?;
        Ok(Self { bytes: content.len() as u64, blake3: blake3::hash(&content).to_hex().to_string() })
    }
}

/// Reads a JSON file that may not exist. `remedy` is what to do when it cannot be understood.
pub(crate) fn read_json<T: DeserializeOwned>(path: &Path, remedy: &str) -> Result<Option<T>, DatasetError> {
    read_text(path)?.map(|text| parse_json(path, &text, remedy)).transpose()
}

/// Reads a commit record, whose form may be one of a newer program; `None` where there is no file.
fn read_record<T: DeserializeOwned>(path: &Path, remedy: &str) -> Result<Option<T>, DatasetError> {
    #[derive(Deserialize)]
    struct Head {
        format: u32,
    }
    let Some(text) = read_text(path)? else { return Ok(None) };
    match serde_json::from_slice(&text) {
        Ok(Head { format }) if format > RECORD_FORMAT => {
            Err(newer(path, &format!("the record's form {format}"), &RECORD_FORMAT.to_string()))
        }
        _ => parse_json(path, &text, remedy).map(Some),
    }
}

fn read_text(path: &Path) -> Result<Option<Vec<u8>>, DatasetError> {
    match fs::read(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        text => text.map(Some).map_err(DatasetError::at("read", path)),
    }
}

fn parse_json<T: DeserializeOwned>(path: &Path, text: &[u8], remedy: &str) -> Result<T, DatasetError> {
    serde_json::from_slice(text).map_err(|error| DatasetError::text(path, format!("{error}; {remedy}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn temporaries_of_layers_records_and_previews_are_removed_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let layout = dataset.layout();
        let folders = [
            layout.layer_dir("room", "cam_00", Pass::Geometry),
            layout.preview_dir("room", "cam_00", Pass::Final),
            layout.preview_dir("room", "cam_00", Pass::Geometry),
            layout.records_dir("room", "cam_00"),
        ];
        for folder in &folders {
            fs::create_dir_all(folder).unwrap();
            for name in [".frame.0000.x.partial", "frame.0000.x"] {
                fs::write(folder.join(name), "x").unwrap();
            }
        }
        dataset.remove_temporaries("room", "cam_00").unwrap();
        for folder in &folders {
            assert_eq!(sorted_names(folder).unwrap(), ["frame.0000.x"], "{}", folder.display());
        }
    }
}
