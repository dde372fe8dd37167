//! Output of sensors: `sensors/<sensor>/<scene>/<camera>/frame.IIII.<what>`, and beside it the random values drawn for every frame.

use crate::atomic::begin_folder;
use crate::frames::{read_json, write_layer};
use crate::npz::{NpyArray, npz, read_npy};
use crate::read::{frame_numbers_in, read_image, sorted_names};
use crate::tables::Table;
use crate::{Dataset, DatasetError, check_name, write_bytes};
use enfilade_frame::{Layer, Values};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use std::path::Path;

/// Random values drawn for a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct SensedFrame {
    /// Number of the frame.
    pub frame: u32,
    /// Names and values.
    pub drawn: Vec<(&'static str, f64)>,
}

/// The scan of a lidar, beam by beam: rows of one elevation, from the first on, and columns of one azimuth.
#[derive(Clone, Debug, PartialEq)]
pub struct Scan {
    /// Rows and columns.
    pub shape: [usize; 2],
    /// Distances, metres; NaN where nothing returned.
    pub distances_m: Vec<f32>,
    /// End points of the beams, camera axes (x right, y up, z backward), metres; NaN where nothing returned.
    pub points: Vec<[f32; 3]>,
    /// Diffuse reflectance times the cosine to the surface's normal, 0 to 1; 0 where nothing returned.
    pub intensities: Vec<f32>,
    /// Part number from 1, as in `render_entity_id`; -1 where nothing returned.
    pub parts: Vec<i16>,
}

impl Scan {
    /// A scan in which nothing has returned.
    pub fn empty(shape: [usize; 2]) -> Self {
        let beams = shape[0] * shape[1];
        Self {
            shape,
            distances_m: vec![f32::NAN; beams],
            points: vec![[f32::NAN; 3]; beams],
            intensities: vec![0.0; beams],
            parts: vec![-1; beams],
        }
    }

    /// The bytes of a `.npz` file: `distances_m`, `points`, `intensities` (float32) and `render_entity_id` (int16).
    pub fn to_npz(&self) -> Vec<u8> {
        let [rows, columns] = self.shape;
        let floats = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect();
        let arrays = [
            NpyArray::new("distances_m", "<f4", &[rows, columns], floats(&self.distances_m)),
            NpyArray::new("points", "<f4", &[rows, columns, 3], floats(self.points.as_flattened())),
            NpyArray::new("intensities", "<f4", &[rows, columns], floats(&self.intensities)),
            NpyArray::new("render_entity_id", "<i2", &[rows, columns], self.parts.iter().flat_map(|v| v.to_le_bytes()).collect()),
        ];
        npz(&arrays).expect("writing to memory cannot fail")
    }

    /// The scan of the bytes of the file at `path`.
    ///
    /// # Errors
    /// When they are not what [`Scan::to_npz`] gives.
    pub fn from_npz(path: &Path, bytes: &[u8]) -> Result<Self, DatasetError> {
        let read = |name, dtype, shape: &[usize]| read_npy(path, bytes, NpyArray::new(name, dtype, shape, Vec::new()));
        let distances = read("distances_m", "<f4", &[0, 0])?;
        let [rows, columns] = [distances.shape[0], distances.shape[1]];
        let (points, intensities) = (read("points", "<f4", &[rows, columns, 3])?, read("intensities", "<f4", &[rows, columns])?);
        let parts = read("render_entity_id", "<i2", &[rows, columns])?;
        Ok(Self {
            shape: [rows, columns],
            distances_m: distances.floats(),
            points: points.floats().as_chunks().0.to_vec(),
            intensities: intensities.floats(),
            parts: parts.bytes.as_chunks().0.iter().map(|bytes| i16::from_le_bytes(*bytes)).collect(),
        })
    }
}

impl Dataset {
    /// Writes the settings of a sensor. Readings that are there of other settings are removed.
    ///
    /// # Errors
    /// When the name cannot be part of a path, or the folder cannot be used.
    pub fn begin_sensor(&self, sensor: &str, settings: &impl Serialize) -> Result<(), DatasetError> {
        check_name("sensor name", sensor)?;
        begin_folder(&self.layout().sensor_dir(sensor), &self.layout().sensor_settings(sensor), settings)
    }

    /// The names of the sensors that have readings.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn sensors(&self) -> Result<Vec<String>, DatasetError> {
        let folder = self.layout().sensors_dir();
        if !folder.is_dir() {
            return Ok(Vec::new());
        }
        Ok(sorted_names(&folder)?.into_iter().filter(|name| self.layout().sensor_settings(name).is_file()).collect())
    }

    /// The settings of a sensor; `None` where there are none.
    ///
    /// # Errors
    /// When they cannot be read.
    pub fn sensor_settings<T: DeserializeOwned>(&self, sensor: &str) -> Result<Option<T>, DatasetError> {
        read_json(&self.layout().sensor_settings(sensor), "run enfilade make OUT sensors again")
    }

    /// The numbers of a camera's frames that a sensor has seen, sorted.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn sensed_frame_numbers(&self, sensor: &str, [scene, camera]: [&str; 2]) -> Result<Vec<u32>, DatasetError> {
        frame_numbers_in(&self.layout().sensor_dir(sensor).join(scene).join(camera))
    }

    /// Writes a reading with the unit and the meaning of a layer.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_sensed_layer(
        &self,
        sensor: &str,
        frame: (&str, &str, u32),
        [width, height]: [usize; 2],
        layer: Layer,
        values: &Values,
    ) -> Result<(), DatasetError> {
        let path = self.layout().sensed(sensor, frame, &format!("{}.hdf5", layer.spec().name));
        write_layer(&path, [height, width], layer, values)
    }

    /// Writes a reading that is a file of its own kind.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_sensed_file(&self, sensor: &str, frame: (&str, &str, u32), what: &str, bytes: &[u8]) -> Result<(), DatasetError> {
        write_bytes(&self.layout().sensed(sensor, frame, what), bytes)
    }

    /// Writes what was drawn for frames of a camera; what is there of others stays.
    ///
    /// # Errors
    /// When the file cannot be written, or what is there is no such table.
    pub fn write_sensed_frames(&self, sensor: &str, [scene, camera]: [&str; 2], frames: &[&SensedFrame]) -> Result<(), DatasetError> {
        let Some(first) = frames.first() else { return Ok(()) };
        let names = first.drawn.iter().map(|(name, _)| *name);
        let header: Vec<&str> = std::iter::once("frame_id").chain(names).collect();
        let path = self.layout().sensed_frames(sensor, scene, camera);
        let mut table = Table::new(&path, &header);
        let row = |frame: &&SensedFrame| {
            let values = frame.drawn.iter().map(|(_, value)| value.to_string());
            std::iter::once(frame.frame.to_string()).chain(values).collect()
        };
        let mut rows: BTreeMap<u32, Vec<String>> = BTreeMap::new();
        if path.is_file() {
            let old = Table::read(&path)?;
            let number = old.column("frame_id")?;
            let same = old.header == table.header;
            for row in (0..old.rows.len()).filter(|_| same) {
                rows.insert(old.parse(row, number)?, old.rows[row].clone());
            }
        }
        rows.extend(frames.iter().map(|frame| (frame.frame, row(frame))));
        table.rows = rows.into_values().collect();
        table.write()
    }

    /// A reading that has the meaning of a layer, with its height and width.
    ///
    /// # Errors
    /// When the file is missing, damaged, or not an image of the layer's channels.
    pub fn read_sensed_layer(&self, sensor: &str, frame: (&str, &str, u32), layer: Layer) -> Result<([usize; 2], Values), DatasetError> {
        read_image(&self.layout().sensed(sensor, frame, &format!("{}.hdf5", layer.spec().name)), layer, None)
    }
}
