//! What the colour layers of a frame hold, rendered or denoised, and the change from one to the other without rendering.
//!
//! The record of a frame says which. A change takes its steps in an order in which the files tell at any moment what it has come to:
//! as long as the record says `rendered`, a file of the name `*_rendered` is what was rendered, on its way to or from its plain name, and
//! [`Dataset::settle_color`] takes it back.

use crate::atomic::{remove_if_there, rename};
use crate::{ColorKind, Dataset, DatasetError, Denoised, FrameRecord, write_json};
use enfilade_frame::{DENOISED, Frame, Layer};
use std::collections::BTreeMap;
use std::path::PathBuf;

impl Dataset {
    /// Puts the denoised layers (`diffuse_illumination`, `residual`, `color`) in place of the rendered ones. These stay under names that end
    /// with `_rendered` where `keep_rendered` says so. Where the frame is denoised already, what was rendered must still be there.
    ///
    /// # Errors
    /// When the frame has no record, or what was rendered is gone, or a file cannot be written. Then the frame is as it was, or
    /// [`Dataset::settle_color`] makes it so.
    pub fn write_denoised(
        &self,
        [scene, camera]: [&str; 2],
        frame: u32,
        layers: &Frame,
        [denoiser, denoise_hash]: [&str; 2],
        keep_rendered: bool,
    ) -> Result<FrameRecord, DatasetError> {
        self.restore_rendered([scene, camera], frame)?;
        let mut record = self.recorded(scene, camera, frame)?;
        let written = self.write_aside(scene, camera, frame, layers)?;

        // What was rendered makes way, and `color` goes first, so that nobody finds a frame of both kinds.
        let mut rendered = BTreeMap::new();
        for (plain, kept) in DENOISED.into_iter().rev() {
            let [from, to] = [plain, kept].map(|layer| self.layout().layer(scene, camera, frame, layer));
            if let Some(file) = record.files.remove(&self.name_in_scene(scene, &from)) {
                rename(&from, &to)?;
                rendered.insert(self.name_in_scene(scene, &to), file);
            }
        }
        self.put_in_place(scene, camera, frame, layers)?;

        // The record says that it is done; only then is anything dropped.
        record.files.extend(written);
        let mut dropped = BTreeMap::new();
        if keep_rendered { &mut record.files } else { &mut dropped }.extend(rendered);
        record.color = ColorKind::Denoised;
        record.denoised = Some(Denoised { denoiser: denoiser.into(), denoise_hash: denoise_hash.into(), dropped });
        write_json(&self.layout().frame_record(scene, camera, frame), &record)?;
        if !keep_rendered {
            self.remove_kept(scene, camera, frame)?;
        }
        Ok(record)
    }

    /// Puts the layers that were rendered back in place of denoised ones; a frame that is as it was rendered stays so.
    ///
    /// # Errors
    /// When the frame has no record, or what was rendered was not kept, or a file cannot be written.
    pub fn restore_rendered(&self, [scene, camera]: [&str; 2], frame: u32) -> Result<(), DatasetError> {
        self.settle_color([scene, camera], frame)?;
        let record = self.recorded(scene, camera, frame)?;
        if record.denoised.is_none() {
            return Ok(());
        }
        let path = self.layout().frame_record(scene, camera, frame);
        let kept = DENOISED.map(|(_, kept)| self.layout().layer(scene, camera, frame, kept));
        if !record.has_rendered() || !kept.iter().all(|path| path.is_file()) {
            return Err(DatasetError::text(
                &path,
                "its color is denoised and what was rendered was not kept (keep_rendered = false); render the frame again".to_string(),
            ));
        }
        write_json(&path, &record.as_rendered())?;
        self.settle_color([scene, camera], frame)
    }

    /// Drops the layers that were rendered of a denoised frame.
    ///
    /// # Errors
    /// When the record cannot be read or written, or a file cannot be removed.
    pub fn drop_rendered(&self, [scene, camera]: [&str; 2], frame: u32) -> Result<(), DatasetError> {
        let mut record = self.recorded(scene, camera, frame)?;
        let Some(denoised) = &mut record.denoised else { return Ok(()) };
        if denoised.dropped.is_empty() {
            denoised.dropped = record.files.extract_if(.., |path, _| plain_name(path).is_some()).collect();
            write_json(&self.layout().frame_record(scene, camera, frame), &record)?;
        }
        self.remove_kept(scene, camera, frame)
    }

    /// Ends what a killed change has left: the frame is what its record says afterwards, if all its files are there.
    ///
    /// # Errors
    /// When a file cannot be moved or removed.
    pub fn settle_color(&self, [scene, camera]: [&str; 2], frame: u32) -> Result<(), DatasetError> {
        let kept: Vec<(PathBuf, PathBuf)> = DENOISED
            .into_iter()
            .map(|(plain, kept)| [plain, kept].map(|layer| self.layout().layer(scene, camera, frame, layer)))
            .map(|[plain, kept]| (plain, kept))
            .filter(|(_, kept)| kept.is_file())
            .collect();
        if kept.is_empty() {
            return Ok(());
        }
        // Without a record that can be read there is no frame, and it is rendered again.
        let Some(record) = self.frame_record(scene, camera, frame).ok().flatten() else { return Ok(()) };
        match &record.denoised {
            None => kept.iter().try_for_each(|(plain, kept)| rename(kept, plain)),
            Some(_) if record.has_rendered() => Ok(()),
            Some(_) => self.remove_kept(scene, camera, frame),
        }
    }

    fn recorded(&self, scene: &str, camera: &str, frame: u32) -> Result<FrameRecord, DatasetError> {
        let path = self.layout().frame_record(scene, camera, frame);
        let missing = || DatasetError::text(&path, "the frame has no record; render it first".to_string());
        self.frame_record(scene, camera, frame)?.ok_or_else(missing)
    }

    fn remove_kept(&self, scene: &str, camera: &str, frame: u32) -> Result<(), DatasetError> {
        let remove = |layer: Layer| remove_if_there(&self.layout().layer(scene, camera, frame, layer));
        DENOISED.into_iter().try_for_each(|(_, kept)| remove(kept))
    }
}

/// The path of a layer that `path` holds as it was rendered, where it is one that is named so.
fn plain_name(path: &str) -> Option<String> {
    let mut layers = DENOISED.into_iter();
    layers.find_map(|(plain, kept)| {
        let start = path.strip_suffix(&format!(".{}.hdf5", kept.spec().name))?;
        Some(format!("{start}.{}.hdf5", plain.spec().name))
    })
}

impl FrameRecord {
    /// The record as it was when the frame was rendered: it names what is told by geometry, labels and light, whatever was denoised since.
    #[must_use]
    pub fn as_rendered(&self) -> Self {
        let mut record = self.clone();
        let Some(denoised) = record.denoised.take() else { return record };
        record.color = ColorKind::Rendered;
        let mut files = std::mem::take(&mut record.files);
        files.extend(denoised.dropped);
        for (path, file) in &files {
            match plain_name(path) {
                Some(plain) => drop(record.files.insert(plain, file.clone())),
                None => drop(record.files.entry(path.clone()).or_insert_with(|| file.clone())),
            }
        }
        record
    }

    /// True where what was rendered is there, under one name or the other.
    pub fn has_rendered(&self) -> bool {
        self.denoised.as_ref().is_none_or(|denoised| denoised.dropped.is_empty())
    }
}
