//! Reading a dataset: its contents, and its layers as values.

use crate::hdf5::{Element, Elements, Window, image_shape, read_array, read_window};
use crate::layout::camera_of_layer_dir;
use crate::release::planar_depth_of_part;
use crate::tables::Table;
use crate::{Dataset, DatasetError};
use enfilade_frame::{Dtype, Frame, LAYERS, Layer, Pass, Values};
use enfilade_scene::Projection;
use half::slice::HalfFloatSliceExt;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

impl Dataset {
    /// The names of the scenes, sorted.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn scenes(&self) -> Result<Vec<String>, DatasetError> {
        let is_scene = |name: &String| self.layout().detail_dir(name).is_dir() || self.layout().images_dir(name).is_dir();
        Ok(sorted_names(self.layout().scenes_dir())?.into_iter().filter(is_scene).collect())
    }

    /// The names of a scene's cameras: those of `metadata_cameras.csv` that have any file, or without that table those with poses or
    /// images, sorted. Hypersim's tables also name cameras that were left out of the release, and who downloads images alone has no
    /// folder `_detail`.
    ///
    /// # Errors
    /// When the scene is not there or cannot be read.
    pub fn cameras(&self, scene: &str) -> Result<Vec<String>, DatasetError> {
        let path = self.layout().metadata_cameras(scene);
        match Table::read(&path) {
            Err(error) if error.is_not_found() => self.cameras_by_files(scene),
            table => {
                let table = table?;
                let names = table.column("camera_name")?;
                let layout = self.layout();
                let images = |name: &str| LAYERS.iter().any(|spec| layout.layer_dir(scene, name, spec.pass).is_dir());
                let there = |name: &&String| layout.camera_dir(scene, name).is_dir() || images(name);
                Ok(table.rows.iter().map(|row| &row[names]).filter(there).cloned().collect())
            }
        }
    }

    /// The names of all cameras of the scenes, each once, sorted.
    ///
    /// # Errors
    /// As [`Dataset::cameras`].
    pub fn camera_names(&self, scenes: &[String]) -> Result<Vec<String>, DatasetError> {
        let mut names = BTreeSet::new();
        for scene in scenes {
            names.extend(self.cameras(scene)?);
        }
        Ok(names.into_iter().collect())
    }

    /// The cameras that have poses or images, whether or not `metadata_cameras.csv` lists them, sorted.
    ///
    /// # Errors
    /// As [`Dataset::cameras`].
    pub fn cameras_by_files(&self, scene: &str) -> Result<Vec<String>, DatasetError> {
        let names = |folder: PathBuf| if folder.is_dir() { sorted_names(&folder) } else { Ok(Vec::new()) };
        let has_poses = |name: &String| self.layout().keyframes(scene, name, "positions").is_file();
        let mut cameras: BTreeSet<String> = names(self.layout().detail_dir(scene))?.into_iter().filter(has_poses).collect();
        cameras.extend(names(self.layout().images_dir(scene))?.iter().filter_map(|name| camera_of_layer_dir(name).map(String::from)));
        if cameras.is_empty() {
            sorted_names(&self.layout().scene_dir(scene))?;
        }
        Ok(cameras.into_iter().collect())
    }

    /// The numbers of a camera's complete frames, ascending.
    ///
    /// A frame of ours is complete when its commit record and all the record's files are there, colour among them. Where a camera has no folder of
    /// records (Hypersim's own data), a frame counts when it has any layer.
    ///
    /// # Errors
    /// When a folder or record cannot be read.
    pub fn frame_numbers(&self, scene: &str, camera: &str) -> Result<Vec<u32>, DatasetError> {
        let records = self.layout().records_dir(scene, camera);
        if !records.is_dir() {
            return self.frames_with_layers(scene, camera);
        }
        let mut frames = Vec::new();
        for frame in sorted_names(&records)?.iter().filter_map(|name| frame_number(name, "json")) {
            if self.frame_record(scene, camera, frame)?.is_some_and(|record| self.frame_is_whole([scene, camera], &record)) {
                frames.push(frame);
            }
        }
        frames.sort_unstable();
        Ok(frames)
    }

    /// One layer as it is stored; Hypersim's own depth and position are `F16`, ours `F32`.
    ///
    /// # Errors
    /// When the file is missing, damaged, or not an image of the layer's channels.
    pub fn read_layer(&self, scene: &str, camera: &str, frame: u32, layer: Layer) -> Result<Values, DatasetError> {
        Ok(self.read_layer_window(scene, camera, frame, layer, None)?.1)
    }

    /// [`Dataset::read_layer`] for a rectangle of the image, of which only the chunks that it touches are decoded. Gives height and width
    /// too; without a window they are the image's.
    ///
    /// # Errors
    /// As there, and when the window leaves the image.
    pub fn read_layer_window(
        &self,
        scene: &str,
        camera: &str,
        frame: u32,
        layer: Layer,
        window: Option<Window>,
    ) -> Result<([usize; 2], Values), DatasetError> {
        read_image(&self.layout().layer(scene, camera, frame, layer), layer, window)
    }

    /// The given layers of a frame, as the table of layers describes them: half precision becomes single precision if the table specifies
    /// that, positions are in metres whatever the unit of the files, and planar depth that is not stored is computed from distances and
    /// camera ([`planar_depth`](crate::planar_depth)).
    ///
    /// # Errors
    /// As [`Dataset::read_layer`], and when the layers differ in size or are stored as something else.
    ///
    /// # Panics
    /// When `layers` is empty: a frame without layers has no size.
    pub fn read_frame(&self, scene: &str, camera: &str, frame: u32, layers: &[Layer]) -> Result<Frame, DatasetError> {
        let projection = || Ok(self.read_camera(scene, camera)?.projection);
        let mut whole: Option<Frame> = None;
        for &layer in layers {
            let ([height, width], values) = self.read_specified(scene, camera, frame, layer, None, &projection)?;
            let whole = whole.get_or_insert_with(|| Frame::new(width as u32, height as u32));
            if (whole.width as usize, whole.height as usize) != (width, height) {
                let path = self.layer_source(scene, camera, frame, layer);
                let problem = format!("{width}x{height} pixels, but other layers of the frame have {}x{}", whole.width, whole.height);
                return Err(DatasetError::hdf5(&path, format!("{problem}; delete the frame's files and render it again")));
            }
            whole.insert(layer, values);
        }
        Ok(whole.expect("at least one layer"))
    }

    /// One layer as in [`Dataset::read_frame`], in a rectangle of the image or whole, with its height and width. `projection` returns the
    /// camera's projection; it is called if planar depth is computed.
    ///
    /// # Errors
    /// As there, and when the window leaves the image, or planar depth is computed of images of another size than the camera's.
    pub fn read_specified(
        &self,
        scene: &str,
        camera: &str,
        frame: u32,
        layer: Layer,
        window: Option<Window>,
        projection: &dyn Fn() -> Result<Projection, DatasetError>,
    ) -> Result<([usize; 2], Values), DatasetError> {
        let stored = self.stored_layer(scene, camera, frame, layer);
        let (size, values) = self.read_layer_window(scene, camera, frame, stored, window)?;
        let wrong = |problem| DatasetError::hdf5(&self.layout().layer(scene, camera, frame, stored), problem);
        let mut values = as_specified(values, stored).map_err(wrong)?;
        if stored != layer {
            let [height, width] = size;
            let part = window.unwrap_or(Window { top: 0, left: 0, height, width });
            let whole = if window.is_some() { self.image_size(scene, camera, frame, stored)? } else { size };
            values = self.planar(scene, camera, &projection()?, part, whole, &values)?;
        }
        if layer == Layer::Position {
            self.positions_in_metres(scene, &mut values)?;
        }
        Ok((size, values))
    }

    /// Height and width of the image that a layer is read from.
    ///
    /// # Errors
    /// When the file is missing or damaged, or contains no image.
    pub fn image_size(&self, scene: &str, camera: &str, frame: u32, layer: Layer) -> Result<[usize; 2], DatasetError> {
        let path = self.layer_source(scene, camera, frame, layer);
        match *image_shape(&path)? {
            [height, width, ..] => Ok([height, width]),
            ref shape => Err(DatasetError::hdf5(&path, format!("expected an image, found an array of shape {shape:?}"))),
        }
    }

    /// Planar depth of a part of an image of distances, which has `height` and `width` as a whole.
    fn planar(
        &self,
        scene: &str,
        camera: &str,
        projection: &Projection,
        part: Window,
        [height, width]: [usize; 2],
        distance: &Values,
    ) -> Result<Values, DatasetError> {
        let wrong = |problem: String| DatasetError::text(&self.camera_table(), problem);
        let [w, h] = projection.size().map(|side| side as usize);
        if [width, height] != [w, h] {
            let found = format!("the images of {scene}/{camera} have {width}x{height} pixels, but its camera {w}x{h}");
            return Err(wrong(format!("{found}; name a table of cameras of the images' size, or use depth_meters")));
        }
        if !projection.has_image_plane() {
            return Err(wrong(format!("{scene}/{camera} has no image plane, so no planar depth; use depth_meters")));
        }
        Ok(Values::F32(planar_depth_of_part(projection, part, distance)))
    }

    /// True when the frame has a file for `layer`. A `*_rendered` file that its record does not list is no layer of its own: it is another
    /// name of the same content as the plain name.
    pub fn has_layer(&self, scene: &str, camera: &str, frame: u32, layer: Layer) -> bool {
        let path = self.layout().layer(scene, camera, frame, layer);
        path.is_file() && (layer.spec().pass != Pass::Rendered || self.is_listed(scene, camera, frame, &path))
    }

    /// True when the frame's record lists the file, and where there is no record to read.
    fn is_listed(&self, scene: &str, camera: &str, frame: u32, path: &Path) -> bool {
        let record = self.frame_record(scene, camera, frame).ok().flatten();
        record.is_none_or(|record| record.files.contains_key(&self.name_in_scene(scene, path)))
    }

    /// The numbers of frames that have any layer, ascending.
    fn frames_with_layers(&self, scene: &str, camera: &str) -> Result<Vec<u32>, DatasetError> {
        let folders: BTreeSet<_> = LAYERS.iter().map(|spec| self.layout().layer_dir(scene, camera, spec.pass)).collect();
        let mut frames = BTreeSet::new();
        for folder in folders.iter().filter(|folder| folder.is_dir()) {
            let names = sorted_names(folder)?;
            frames
                .extend(names.iter().filter_map(|name| LAYERS.iter().find_map(|spec| frame_number(name, &format!("{}.hdf5", spec.name)))));
        }
        Ok(frames.into_iter().collect())
    }
}

/// A layer's image, or a rectangle of it, with height and width.
pub(crate) fn read_image(path: &Path, layer: Layer, window: Option<Window>) -> Result<([usize; 2], Values), DatasetError> {
    let array = window.map_or_else(|| read_array(path), |window| read_window(path, window))?;
    let channels = layer.spec().channels;
    let size = match (array.shape.as_slice(), channels) {
        (&[height, width], 1) => [height, width],
        (&[height, width, found], _) if found == channels => [height, width],
        (shape, _) => {
            let problem = format!("expected an image of {channels} channels, found an array of shape {shape:?}");
            return Err(DatasetError::hdf5(path, problem));
        }
    };
    let unknown = |other: Elements| DatasetError::hdf5(path, format!("expected image values, found {}", other.element().name()));
    Ok((size, array.values.into_values().map_err(unknown)?))
}

/// The number in `frame.IIII.<rest>`.
pub(crate) fn frame_number(name: &str, rest: &str) -> Option<u32> {
    name.strip_prefix("frame.")?.strip_suffix(rest)?.strip_suffix('.')?.parse().ok()
}

/// The numbers of the frames that a folder has files of, by their names, sorted; none where there is no folder.
pub(crate) fn frame_numbers_in(folder: &Path) -> Result<Vec<u32>, DatasetError> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let number = |name: &String| name.strip_prefix("frame.")?.split_once('.')?.0.parse().ok();
    let mut numbers: Vec<u32> = sorted_names(folder)?.iter().filter_map(number).collect();
    numbers.sort_unstable();
    numbers.dedup();
    Ok(numbers)
}

/// The names in a folder, sorted.
pub(crate) fn sorted_names(folder: &Path) -> Result<Vec<String>, DatasetError> {
    let entries = std::fs::read_dir(folder).map_err(DatasetError::at("read the folder", folder))?;
    let names = entries.map(|entry| entry.map(|e| e.file_name().to_string_lossy().into_owned()));
    let mut names: Vec<String> = names.collect::<Result<_, _>>().map_err(DatasetError::at("read the folder", folder))?;
    names.sort_unstable();
    Ok(names)
}

/// Values as the layer's spec calls for; half precision becomes single without loss.
fn as_specified(values: Values, layer: Layer) -> Result<Values, String> {
    match (values, layer.spec().dtype) {
        (Values::F16(v), Dtype::F32) => {
            let mut wide = vec![0.0; v.len()];
            v.convert_to_f32_slice(&mut wide);
            Ok(Values::F32(wide))
        }
        (values, dtype) if values.dtype() == dtype => Ok(values),
        (values, dtype) => {
            let found = Elements::from(values).element().name();
            let expected = match dtype {
                Dtype::F16 => Element::F16,
                Dtype::F32 => Element::F32,
                Dtype::I16 => Element::I16,
                Dtype::U8 => Element::U8,
            };
            Err(format!("expected {}, found {found}; render the frame again", expected.name()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frame_numbers_are_read_from_whole_names() {
        assert_eq!(frame_number("frame.0012.json", "json"), Some(12));
        assert_eq!(frame_number("frame.12345.color.hdf5", "color.hdf5"), Some(12345));
        for name in ["frame.0012.labels.json", ".frame.0012.json.partial", "frame.json", "frame..json"] {
            assert_eq!(frame_number(name, "json"), None, "{name}");
        }
    }

    #[test]
    fn a_folder_that_is_no_dataset_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let message = Dataset::open(folder.path()).unwrap_err().to_string();
        assert!(message.contains("is not a dataset") && message.contains("\"scenes\""), "{message}");
        let missing = Dataset::open(folder.path().join("nothing")).unwrap_err();
        assert!(missing.is_not_found(), "{missing}");
        Dataset::create(folder.path()).unwrap();
        assert!(Dataset::open(folder.path()).unwrap().scenes().unwrap().is_empty());
    }

    #[test]
    fn hypersims_own_frames_are_read() {
        let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
            return eprintln!("skipped: ENFILADE_SCENES is not set");
        };
        let dataset = Dataset::open(Path::new(&scenes).join("hypersim-real")).unwrap();
        assert_eq!(dataset.scenes().unwrap(), ["ai_037_002"]);
        assert_eq!(dataset.cameras("ai_037_002").unwrap(), ["cam_00"]);
        assert_eq!(dataset.frame_numbers("ai_037_002", "cam_00").unwrap(), [0]);
        assert_eq!(dataset.read_layer("ai_037_002", "cam_00", 0, Layer::DepthMeters).unwrap().dtype(), Dtype::F16);
        let frame = dataset.read_frame("ai_037_002", "cam_00", 0, &[Layer::DepthMeters]).unwrap();
        assert_eq!((frame.width, frame.height), (1024, 768));
        assert!(dataset.read_frame("ai_037_002", "cam_00", 0, &[Layer::Color]).unwrap_err().is_not_found());
    }
}
