//! Which frames count: those whose record is there, with every file that it lists in full length.

use crate::hdf5::missing_bytes;
use crate::read::{frame_number, sorted_names};
use crate::{Dataset, DatasetError, FileRecord, FrameRecord};
use enfilade_frame::{LAYERS, Layer, Pass};
use enfilade_scene::{Cx, Warning};
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::ops::Range;
use std::path::Path;

impl Dataset {
    /// True when the frame was rendered with `config_hash` and all that rendering has left is there in full length.
    pub fn frame_is_complete(&self, scene: &str, camera: &str, frame: u32, config_hash: &str) -> bool {
        self.rendered_record(scene, camera, frame).is_some_and(|record| record.config_hash == config_hash)
    }

    /// True when the frame's label layers were joined from the tables `labels_hash` and are there in full length.
    pub fn labels_are_complete(&self, scene: &str, camera: &str, frame: u32, labels_hash: &str) -> bool {
        let record = self.label_record(scene, camera, frame).ok().flatten();
        record.is_some_and(|record| record.labels_hash == labels_hash && self.files_are_there(scene, &record.files))
    }

    /// True when the record of a frame's layers of `pass` can be read and all its files are there in full length. Labels have
    /// a record of their own.
    pub fn layers_are_whole(&self, scene: &str, camera: &str, frame: u32, pass: Pass) -> bool {
        let files = self.recorded_files(scene, camera, frame, pass).ok().flatten();
        files.is_some_and(|files| self.files_are_there(scene, &files))
    }

    /// The files of the record that layers of `pass` have; `None` where there is no such record.
    pub(crate) fn recorded_files(
        &self,
        scene: &str,
        camera: &str,
        frame: u32,
        pass: Pass,
    ) -> Result<Option<BTreeMap<String, FileRecord>>, DatasetError> {
        Ok(match pass {
            Pass::Label => self.label_record(scene, camera, frame)?.map(|record| record.files),
            _ => self.frame_record(scene, camera, frame)?.map(|record| record.files),
        })
    }

    /// Why frames of a camera do not count although they have a commit record: the first file of each that is missing or has another
    /// length. `complete` are those that count, as [`Dataset::frame_numbers`] gives them. Hypersim's own data have no records.
    ///
    /// # Errors
    /// When the records' folder or a record cannot be read.
    pub fn incomplete_frames(&self, scene: &str, camera: &str, complete: &[u32]) -> Result<BTreeMap<u32, DatasetError>, DatasetError> {
        let records = self.layout().records_dir(scene, camera);
        let names = if records.is_dir() { sorted_names(&records)? } else { Vec::new() };
        let mut incomplete = BTreeMap::new();
        for frame in names.iter().filter_map(|name| frame_number(name, "json")).filter(|frame| complete.binary_search(frame).is_err()) {
            let record = self.frame_record(scene, camera, frame)?;
            incomplete.extend(record.and_then(|record| self.wrong_frame([scene, camera], &record)).map(|problem| (frame, problem)));
        }
        Ok(incomplete)
    }

    /// Warns of frames in `range` (`None`: all frames) that a reader of the `complete` frames of a camera leaves out. One warning names the
    /// first of [`Dataset::incomplete_frames`] and counts the others; another does so for frames whose labels have a record but are
    /// incomplete.
    ///
    /// # Errors
    /// As there.
    pub fn warn_of_incomplete(
        &self,
        [scene, camera]: [&str; 2],
        complete: &[u32],
        range: Option<&Range<u32>>,
        cx: &dyn Cx,
    ) -> Result<(), DatasetError> {
        let is_asked_for = |frame: &u32| range.is_none_or(|range| range.contains(frame));
        let warn = |message| cx.warn(Warning { place: format!("{scene}/{camera}"), message });
        let mut left_out = self.incomplete_frames(scene, camera, complete)?;
        left_out.retain(|frame, _| is_asked_for(frame));
        if let Some((frame, problem)) = left_out.first_key_value() {
            match left_out.len() - 1 {
                0 => warn(format!("frame {frame} is left out: {problem}")),
                more => warn(format!("frame {frame} and {more} more are left out: {problem}")),
            }
        }
        let asked_for = complete.iter().copied().filter(is_asked_for);
        let mut lacking = asked_for.filter_map(|frame| Some((frame, self.wrong_layers(scene, camera, frame, Pass::Label)?)));
        if let Some((frame, problem)) = lacking.next() {
            match lacking.count() {
                0 => warn(format!("the labels of frame {frame} are not whole: {problem}")),
                more => warn(format!("the labels of frame {frame} and {more} more are not whole: {problem}")),
            }
        }
        Ok(())
    }

    /// The numbers of frames that are whole, as [`Dataset::frame_numbers`] gives them, with a warning of those in `range` (`None`: of all)
    /// that are not. Hypersim's own frames have no records; of these, ones with a file that is cut short are left out as well.
    ///
    /// # Errors
    /// As there.
    pub fn whole_frames(&self, [scene, camera]: [&str; 2], range: Option<&Range<u32>>, cx: &dyn Cx) -> Result<Vec<u32>, DatasetError> {
        let mut frames = self.frame_numbers(scene, camera)?;
        self.warn_of_incomplete([scene, camera], &frames, range, cx)?;
        if self.layout().records_dir(scene, camera).is_dir() {
            return Ok(frames);
        }
        let mut cut = Vec::new();
        frames.retain(|&frame| {
            let problem = if range.is_none_or(|range| range.contains(&frame)) { self.cut_file(scene, camera, frame) } else { None };
            cut.extend(problem.as_ref().map(|problem| format!("frame {frame}{{}} left out: {problem}")));
            problem.is_none()
        });
        if let Some(first) = cut.first() {
            let more = if cut.len() > 1 { format!(" and {} more are", cut.len() - 1) } else { " is".into() };
            cx.warn(Warning { place: format!("{scene}/{camera}"), message: first.replacen("{}", &more, 1) });
        }
        Ok(frames)
    }

    /// The first layer's file of a frame that is cut short, and by how much.
    fn cut_file(&self, scene: &str, camera: &str, frame: u32) -> Option<String> {
        let files = LAYERS.iter().map(|spec| self.layout().layer(scene, camera, frame, spec.layer));
        files.into_iter().find_map(|path| {
            let [found, expected] = missing_bytes(&path)?;
            Some(format!("{} is cut short: it has {found} of {expected} bytes; download it again", path.display()))
        })
    }

    /// True when the frame of a record has its colour, and all files of the record are there in full length.
    pub(crate) fn frame_is_whole(&self, shot: [&str; 2], record: &FrameRecord) -> bool {
        self.wrong_frame(shot, record).is_none()
    }

    /// Why the frame of a record does not count; `None` where it does.
    fn wrong_frame(&self, [scene, camera]: [&str; 2], record: &FrameRecord) -> Option<DatasetError> {
        let unmade = || {
            let color = self.layout().layer(scene, camera, record.frame, Layer::Color);
            DatasetError::hdf5(&color, "it is not made yet: the frame is rendered, and its run was interrupted; run again".to_string())
        };
        self.wrong_file(scene, &record.files, Pass::Final).or_else(|| (!record.has_color()).then(unmade))
    }

    /// True when all files of a record are there in full length.
    pub(crate) fn files_are_there(&self, scene: &str, files: &BTreeMap<String, FileRecord>) -> bool {
        self.wrong_file(scene, files, Pass::Final).is_none()
    }

    /// The fault of the layers of `pass` that a frame has a record of, if any.
    fn wrong_layers(&self, scene: &str, camera: &str, frame: u32, pass: Pass) -> Option<DatasetError> {
        match self.recorded_files(scene, camera, frame, pass) {
            Ok(files) => self.wrong_file(scene, &files?, pass),
            Err(error) => Some(error),
        }
    }

    /// The fault of the first file in a frame's record of its layers of `pass` that is missing or has another length.
    fn wrong_file(&self, scene: &str, files: &BTreeMap<String, FileRecord>, pass: Pass) -> Option<DatasetError> {
        let folder = self.layout().scene_dir(scene);
        let remedy = match pass {
            Pass::Label => "run the label stage again",
            _ => "render the frame again",
        };
        files.iter().find_map(|(name, file)| {
            let path = folder.join(name);
            Some(match Problem::of(&path, file)? {
                Problem::Length(bytes) => {
                    let problem = format!("it has {bytes} bytes, but the record of its frame says {}; {remedy}", file.bytes);
                    DatasetError::hdf5(&path, problem)
                }
                Problem::Missing => DatasetError::hdf5(&path, format!("it is missing, but its frame has a record; {remedy}")),
                Problem::Unreadable(error) => DatasetError::io("look for", &path, error),
            })
        })
    }
}

/// A fault of a file that its length shows.
pub(crate) enum Problem {
    /// The file is missing.
    Missing,
    /// The file has another length, this one.
    Length(u64),
    /// The file cannot be accessed.
    Unreadable(io::Error),
}

impl Problem {
    /// Compares the file at `path` with its record; `None` where all is well.
    pub fn of(path: &Path, file: &FileRecord) -> Option<Self> {
        match fs::metadata(path).map(|found| found.len()) {
            Ok(bytes) if bytes == file.bytes => None,
            Ok(bytes) => Some(Self::Length(bytes)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Some(Self::Missing),
            Err(error) => Some(Self::Unreadable(error)),
        }
    }
}
