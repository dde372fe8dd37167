//! The contents of a frame's colour layers, and how they are made from the rendered ones.
//!
//! Rendering writes `*_rendered`. From these come `color`, `diffuse_illumination` and `residual`: denoised, or the same files under a
//! second name (a hard link; a copy where the file system has none). The record of a frame states which, and lists every content once: if
//! colour is as it was rendered, it lists the plain names alone. While colour is being made it lists only the rendered layers, so a change
//! that is killed at any point leaves a frame without colour, and the next run makes it. The layers that guide denoising stay and go with
//! what was rendered: nothing else needs them.

use crate::atomic::{link, remove_if_there};
use crate::whole_frames::Problem;
use crate::{ColorKind, Dataset, DatasetError, Denoised, FileRecord, FrameRecord, write_json};
use enfilade_frame::{DENOISED, Frame, LAYERS, Layer, Pass};
use std::path::{Path, PathBuf};

impl Dataset {
    /// The layer under which `layer` is stored as it was rendered; `None` where it is denoised and what was rendered was not kept.
    ///
    /// # Errors
    /// When the frame's record cannot be read.
    pub fn rendered_layer(&self, [scene, camera]: [&str; 2], frame: u32, layer: Layer) -> Result<Option<Layer>, DatasetError> {
        let Some((_, kept)) = DENOISED.into_iter().find(|(plain, _)| *plain == layer) else { return Ok(Some(layer)) };
        let record = self.frame_record(scene, camera, frame)?;
        Ok(if record.as_ref().is_some_and(|record| !record.has_rendered()) {
            None
        } else if self.layout().layer(scene, camera, frame, kept).is_file() {
            Some(kept)
        } else {
            Some(layer).filter(|_| record.is_none_or(|record| record.denoised.is_none()))
        })
    }

    /// The given layers of a frame as [`Dataset::read_frame`] gives them, but colour as it was rendered, under its plain names.
    ///
    /// # Errors
    /// As there, and when what was rendered was not kept.
    pub fn read_rendered(&self, [scene, camera]: [&str; 2], frame: u32, layers: &[Layer]) -> Result<Frame, DatasetError> {
        let stored = |&layer: &Layer| {
            self.rendered_layer([scene, camera], frame, layer)?
                .ok_or_else(|| self.not_kept(&self.layout().frame_record(scene, camera, frame)))
        };
        let stored = layers.iter().map(stored).collect::<Result<Vec<_>, _>>()?;
        let read = self.read_frame(scene, camera, frame, &stored)?;
        let mut frame = Frame::new(read.width, read.height);
        let values = layers.iter().zip(stored).filter_map(|(&layer, stored)| Some((layer, read.get(stored)?.clone())));
        values.for_each(|(layer, values)| frame.insert(layer, values));
        Ok(frame)
    }

    /// Replaces `diffuse_illumination`, `residual` and `color` of a frame by the denoised `layers`. The rendered layers stay under names
    /// that end with `_rendered` if `keep_rendered` is set; otherwise they are removed, with the layers that guided denoising.
    ///
    /// # Errors
    /// When the frame has no record, or what was rendered is gone, or a file cannot be written. Then the frame has the colour that it had,
    /// or none.
    pub fn write_denoised(
        &self,
        [scene, camera]: [&str; 2],
        frame: u32,
        layers: &Frame,
        [denoiser, denoise_hash]: [&str; 2],
        keep_rendered: bool,
    ) -> Result<FrameRecord, DatasetError> {
        let stored = self.with_rendered_apart([scene, camera], frame)?;
        let written = self.write_aside(scene, camera, frame, layers)?;
        let mut record = self.take_color_off([scene, camera], frame, &stored)?;
        self.put_in_place(scene, camera, frame, layers).inspect_err(|_| self.remove_aside(scene, camera, frame, layers))?;

        // Layers are removed only after the record states that denoising is done.
        let is_dropped = |path: &String, _: &mut FileRecord| !keep_rendered && goes_with_rendered(path);
        let dropped = record.files.extract_if(.., is_dropped).collect();
        record.files.extend(written);
        record.color = ColorKind::Denoised;
        record.denoised = Some(Denoised { denoiser: denoiser.into(), denoise_hash: denoise_hash.into(), dropped });
        write_json(&self.layout().frame_record(scene, camera, frame), &record)?;
        if !keep_rendered {
            self.remove_rendered([scene, camera], frame)?;
        }
        Ok(record)
    }

    /// Makes the rendered layers the colour of a frame, by a second name of the same files. A frame with rendered colour stays as it is.
    ///
    /// # Errors
    /// When the frame has no record, or what was rendered was not kept, or a file cannot be written.
    pub fn link_rendered(&self, [scene, camera]: [&str; 2], frame: u32) -> Result<(), DatasetError> {
        let stored = self.with_rendered_apart([scene, camera], frame)?;
        let shown = stored.as_rendered();
        if stored != shown {
            self.take_color_off([scene, camera], frame, &stored)?;
        }
        self.rendered_files([scene, camera], frame, &stored).try_for_each(|[plain, kept]| link(&kept, &plain))?;
        if stored == shown { Ok(()) } else { write_json(&self.layout().frame_record(scene, camera, frame), &shown) }
    }

    /// Removes the rendered layers of a denoised frame, including those that its record lists as dropped if they are still there.
    ///
    /// # Errors
    /// When the record cannot be read or written, or a file cannot be removed.
    pub fn drop_rendered(&self, [scene, camera]: [&str; 2], frame: u32) -> Result<(), DatasetError> {
        let mut record = self.recorded(scene, camera, frame)?;
        let Some(denoised) = &mut record.denoised else { return Ok(()) };
        if denoised.dropped.is_empty() {
            denoised.dropped = record.files.extract_if(.., |path, _| goes_with_rendered(path)).collect();
            write_json(&self.layout().frame_record(scene, camera, frame), &record)?;
        }
        self.remove_rendered([scene, camera], frame)
    }

    /// The record of a frame whose rendered files all exist in full length; `None` if they do not, or the record cannot be read. Its colour
    /// may be missing, and is made from the rest.
    pub fn rendered_record(&self, scene: &str, camera: &str, frame: u32) -> Option<FrameRecord> {
        let record = self.frame_record(scene, camera, frame).ok().flatten()?;
        let files = if record.has_rendered() { record.as_rendered().files } else { record.files.clone() };
        let folder = self.layout().scene_dir(scene);
        let is_there = |(name, file): (&String, &FileRecord)| {
            let kept = kept_name(name).filter(|_| record.has_rendered()).map(|kept| Problem::of(&folder.join(kept), file));
            match kept {
                // Layers that earlier versions rendered, or that come from another machine, have the plain name alone.
                Some(Some(Problem::Missing)) if record.denoised.is_none() => Problem::of(&folder.join(name), file).is_none(),
                Some(problem) => problem.is_none(),
                None => Problem::of(&folder.join(name), file).is_none(),
            }
        };
        files.iter().all(is_there).then_some(record)
    }

    /// True when a frame of the scene has the colour files that its `record` lists, in full length.
    pub fn color_is_whole(&self, scene: &str, record: &FrameRecord) -> bool {
        let folder = self.layout().scene_dir(scene);
        let mut colors = record.files.iter().filter(|(name, _)| kept_name(name).is_some());
        record.has_color() && colors.all(|(name, file)| Problem::of(&folder.join(name), file).is_none())
    }

    fn recorded(&self, scene: &str, camera: &str, frame: u32) -> Result<FrameRecord, DatasetError> {
        let path = self.layout().frame_record(scene, camera, frame);
        let missing = || DatasetError::text(&path, "the frame has no record; render it first".to_string());
        self.frame_record(scene, camera, frame)?.ok_or_else(missing)
    }

    /// The record of a frame whose rendered layers have names of their own. Earlier versions wrote them under the plain names: here they
    /// get the others as well.
    fn with_rendered_apart(&self, [scene, camera]: [&str; 2], frame: u32) -> Result<FrameRecord, DatasetError> {
        let record = self.recorded(scene, camera, frame)?;
        let not_kept = || self.not_kept(&self.layout().frame_record(scene, camera, frame));
        if !record.has_rendered() {
            return Err(not_kept());
        }
        for [plain, kept] in self.rendered_files([scene, camera], frame, &record) {
            match kept.is_file() {
                true => {}
                false if record.denoised.is_none() => link(&plain, &kept)?,
                false => return Err(not_kept()),
            }
        }
        Ok(record)
    }

    /// Takes the colour out of the record of a frame, `stored`, before its files change: what is read from here on is a frame without one.
    fn take_color_off(&self, [scene, camera]: [&str; 2], frame: u32, stored: &FrameRecord) -> Result<FrameRecord, DatasetError> {
        let record = stored.without_color();
        if record != *stored {
            write_json(&self.layout().frame_record(scene, camera, frame), &record)?;
        }
        Ok(record)
    }

    /// The plain and the other name of each colour layer that was rendered, `color` last: a reader that looks for it finds all layers or
    /// none.
    fn rendered_files(&self, [scene, camera]: [&str; 2], frame: u32, record: &FrameRecord) -> impl Iterator<Item = [PathBuf; 2]> + use<> {
        let files = record.as_rendered().files;
        let paths = DENOISED.map(|names| <[Layer; 2]>::from(names).map(|layer| self.layout().layer(scene, camera, frame, layer)));
        let rendered: Vec<[PathBuf; 2]> =
            paths.into_iter().filter(|[plain, _]| files.contains_key(&self.name_in_scene(scene, plain))).collect();
        rendered.into_iter()
    }

    fn remove_rendered(&self, [scene, camera]: [&str; 2], frame: u32) -> Result<(), DatasetError> {
        let remove = |layer: Layer| remove_if_there(&self.layout().layer(scene, camera, frame, layer));
        DENOISED.into_iter().map(|(_, kept)| kept).chain(guides()).try_for_each(remove)
    }

    fn not_kept(&self, record: &Path) -> DatasetError {
        let problem = "its color is denoised and what was rendered was not kept (keep_rendered = false); render the frame again";
        DatasetError::text(record, problem.to_string())
    }
}

/// The layers that guide denoising.
fn guides() -> impl Iterator<Item = Layer> {
    LAYERS.iter().filter(|spec| spec.pass == Pass::Guides).map(|spec| spec.layer)
}

/// True of the path of a layer that is kept only where what was rendered is.
fn goes_with_rendered(path: &str) -> bool {
    let is_of = |layer: Layer| {
        path.strip_suffix(".hdf5").and_then(|path| path.strip_suffix(layer.spec().name)).is_some_and(|start| start.ends_with('.'))
    };
    plain_name(path).is_some() || guides().any(is_of)
}

/// The plain path of a layer of which `path` is the rendered version; `None` for every other path.
fn plain_name(path: &str) -> Option<String> {
    renamed(path, |(plain, kept)| [kept, plain])
}

/// The path where a layer that has the plain `path` is stored as it was rendered; `None` of paths that denoising leaves alone.
fn kept_name(path: &str) -> Option<String> {
    renamed(path, |(plain, kept)| [plain, kept])
}

fn renamed(path: &str, names: impl Fn((Layer, Layer)) -> [Layer; 2]) -> Option<String> {
    DENOISED.into_iter().map(names).find_map(|[from, to]| {
        let start = path.strip_suffix(".hdf5")?.strip_suffix(from.spec().name)?.strip_suffix('.')?;
        Some(format!("{start}.{}.hdf5", to.spec().name))
    })
}

impl FrameRecord {
    /// The record as it was when the frame was rendered, with plain names. It depends on geometry, labels and light, not on what was made
    /// of the colour.
    #[must_use]
    pub fn as_rendered(&self) -> Self {
        let mut record = Self { color: ColorKind::Rendered, ..self.clone() };
        let mut files = std::mem::take(&mut record.files);
        files.extend(record.denoised.take().map(|denoised| denoised.dropped).unwrap_or_default());
        for (path, file) in files {
            match plain_name(&path) {
                Some(plain) => drop(record.files.insert(plain, file)),
                None => drop(record.files.entry(path).or_insert(file)),
            }
        }
        record
    }

    /// The record while colour is made: what was rendered, under the names that rendering gives it.
    fn without_color(&self) -> Self {
        let mut record = self.as_rendered();
        let files = std::mem::take(&mut record.files);
        record.files = files.into_iter().map(|(path, file)| (kept_name(&path).unwrap_or(path), file)).collect();
        record
    }

    /// True if the rendered layers exist, under one name or the other.
    pub fn has_rendered(&self) -> bool {
        self.denoised.as_ref().is_none_or(|denoised| denoised.dropped.is_empty())
    }

    /// True where colour is made; between rendering and that it is not.
    pub fn has_color(&self) -> bool {
        self.files.keys().filter_map(|path| plain_name(path)).all(|plain| self.files.contains_key(&plain))
    }
}
