//! Input and output of a sensor.

use crate::SensorError;
use enfilade_dataset::Dataset;
use enfilade_frame::{Frame, Layer, LayerSpec, Pass, Values, vector};
use enfilade_math::{DVec3, Rng, hash_u64};
use enfilade_scene::{Motion, Projection};

/// A finished frame in the place of what a sensor would be pointed at.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// Name of the scene.
    pub scene: &'a str,
    /// Name of the camera that it was rendered for.
    pub camera: &'a str,
    /// Number of the frame.
    pub number: u32,
    /// Which direction belongs to which image point.
    pub projection: &'a Projection,
    /// At least the layers that the sensor looks at: [`Sensor::layers`](crate::Sensor::layers).
    pub frame: &'a Frame,
    /// How its camera moves; `None` where its frames are no video.
    pub motion: Option<&'a Motion>,
}

/// The reading of a sensor for a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Random values drawn for this frame, or values that follow from it: of a camera also the exposure, with its stops, and the three
    /// factors of white balance.
    pub drawn: Vec<(&'static str, f64)>,
    /// The sensor's data.
    pub data: Data,
}

/// The sensor's data.
#[derive(Clone, Debug, PartialEq)]
pub enum Data {
    /// Values with the unit and the meaning of a layer.
    Layer(Layer, Values),
    /// A file of another kind: a picture, or the points of a scan.
    File {
        /// End of its name after the frame number, such as `color.jpg`.
        name: &'static str,
        /// Bytes of the whole file.
        bytes: Vec<u8>,
    },
}

impl<'a> Subject<'a> {
    /// Pixels per row, and rows.
    pub(crate) fn size(&self) -> [usize; 2] {
        [self.frame.width as usize, self.frame.height as usize]
    }

    /// A layer that the sensor cannot do without.
    pub(crate) fn layer(&self, sensor: &str, layer: Layer) -> Result<&'a Values, SensorError> {
        self.frame.get(layer).ok_or_else(|| {
            let LayerSpec { name, pass, .. } = layer.spec();
            let remedy = if *pass == Pass::Extra { "render it with `enfilade run OUT --extra`" } else { "render or download it" };
            self.unseen(sensor, format!("it has no layer {name}, which the sensor looks at; {remedy}"))
        })
    }

    /// A layer of float32.
    pub(crate) fn floats(&self, sensor: &str, layer: Layer) -> Result<&'a [f32], SensorError> {
        match self.layer(sensor, layer)? {
            Values::F32(values) => Ok(values),
            other => unreachable!("{} is stored as {:?}", layer.spec().name, other.dtype()),
        }
    }

    /// An error about this frame.
    pub(crate) fn unseen(&self, sensor: &str, problem: String) -> SensorError {
        let frame = format!("{}/{}/frame.{:04}", self.scene, self.camera, self.number);
        SensorError::Frame { sensor: sensor.into(), frame, problem }
    }

    /// The ray through the centre of pixel `i`, camera space, unit length; `None` where the picture shows nothing.
    pub(crate) fn ray(&self, i: usize) -> Option<DVec3> {
        let [width, _] = self.size();
        Some(self.projection.ray((i % width) as f64 + 0.5, (i / width) as f64 + 0.5)?.normalize())
    }

    /// Cosine of the angle between the surface's normal and the way back to the camera, by pixel; 0 where nothing was hit.
    pub(crate) fn cosines(&self, sensor: &str) -> Result<Vec<f64>, SensorError> {
        let normals = self.layer(sensor, Layer::NormalCam)?;
        let cosine = |i| self.ray(i).map_or(0.0, |ray| vector(normals, i).dot(-ray).clamp(0.0, 1.0));
        Ok((0..self.frame.pixels()).map(|i| Some(cosine(i)).filter(|v| v.is_finite()).unwrap_or(0.0)).collect())
    }

    /// The random numbers of a sensor in a frame of this camera.
    pub(crate) fn rng(&self, seed: u64, sensor: &str, number: u32) -> Rng {
        let names = [sensor, self.scene, self.camera];
        let mixed = names.iter().flat_map(|name| name.bytes().chain([0])).fold(seed, |hash, byte| hash_u64(hash ^ u64::from(byte)));
        Rng::new(mixed).fork(u64::from(number))
    }
}

impl Reading {
    /// Puts the reading of a frame in its place below `sensors/` of the dataset.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub(crate) fn write(&self, dataset: &Dataset, sensor: &str, subject: &Subject<'_>) -> Result<(), SensorError> {
        let frame = (subject.scene, subject.camera, subject.number);
        match &self.data {
            Data::Layer(layer, values) => dataset.write_sensed_layer(sensor, frame, subject.size(), *layer, values)?,
            Data::File { name, bytes } => dataset.write_sensed_file(sensor, frame, name, bytes)?,
        }
        Ok(())
    }
}
