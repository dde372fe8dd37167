//! The frames of a dataset are shown to sensors.

use crate::{Reading, Sensor, SensorError, Sensors, Subject};
use enfilade_dataset::{ChosenFrames, Dataset, SensedFrame};
use enfilade_frame::{Frame, Layer};
use enfilade_scene::{Counted, Cx, Projection};

/// Shows frames to sensors, and writes what they give below `sensors/` of the dataset: a folder for each, with its settings, and in it scenes
/// and cameras. Readings of a sensor of the same name but other settings are removed first. Gives the number of frames.
///
/// # Errors
/// When a sensor's settings are wrong, a frame cannot be seen by it, or a file cannot be read or written.
pub fn sense(dataset: &Dataset, sensors: &Sensors, chosen: &ChosenFrames, cx: &dyn Cx) -> Result<usize, SensorError> {
    sensors.check()?;
    let sensors: Vec<Sensor> = sensors.all().collect();
    let mut layers: Vec<Layer> = sensors.iter().flat_map(Sensor::layers).collect();
    layers.sort_unstable();
    layers.dedup();
    for sensor in &sensors {
        dataset.begin_sensor(sensor.name(), sensor)?;
    }
    let mut seen = 0;
    for scene in &chosen.scenes {
        for (camera, frames) in chosen.of_scene(dataset, scene, cx)? {
            show(dataset, &sensors, &layers, [scene, &camera], &frames, cx)?;
            seen += frames.len();
        }
    }
    Ok(seen)
}

/// Shows frames of a camera to sensors, whose folders were begun, and writes their readings.
///
/// # Errors
/// When a frame cannot be read or be seen by a sensor, or a file cannot be written.
pub fn sense_frames(dataset: &Dataset, sensors: &[Sensor], of: [&str; 2], frames: &[u32], cx: &dyn Cx) -> Result<(), SensorError> {
    let mut layers: Vec<Layer> = sensors.iter().flat_map(Sensor::layers).collect();
    layers.sort_unstable();
    layers.dedup();
    show(dataset, sensors, &layers, of, frames, cx)
}

/// Reads the layers that a frame has; a frame of 0 × 0 pixels if it has none.
fn read(dataset: &Dataset, (scene, camera, number): (&str, &str, u32), layers: &[Layer]) -> Result<Frame, SensorError> {
    let there: Vec<Layer> = layers.iter().copied().filter(|&layer| dataset.gives_layer(scene, camera, number, layer)).collect();
    Ok(if there.is_empty() { Frame::new(0, 0) } else { dataset.read_frame(scene, camera, number, &there)? })
}

impl Sensor {
    /// The reading for a stored frame (scene, camera, number).
    ///
    /// # Errors
    /// When the frame cannot be read, or cannot be seen by the sensor.
    pub fn look(&self, dataset: &Dataset, frame: (&str, &str, u32), projection: &Projection) -> Result<Reading, SensorError> {
        let (scene, camera, number) = frame;
        let motion = if self.feels_motion() { dataset.read_motion(scene, camera)? } else { None };
        let frame = read(dataset, frame, &self.layers())?;
        self.sense(&Subject { scene, camera, number, projection, frame: &frame, motion: motion.as_ref() })
    }
}

/// Shows frames of one camera to all sensors.
fn show(
    dataset: &Dataset,
    sensors: &[Sensor],
    layers: &[Layer],
    [scene, camera]: [&str; 2],
    frames: &[u32],
    cx: &dyn Cx,
) -> Result<(), SensorError> {
    let projection = dataset.read_camera(scene, camera)?.projection;
    let motion = if sensors.iter().any(Sensor::feels_motion) { dataset.read_motion(scene, camera)? } else { None };
    let counted = Counted::new(cx, "frames", frames.len());
    let readings = |&number: &u32| {
        counted.unit(|| -> Result<Vec<SensedFrame>, SensorError> {
            let frame = read(dataset, (scene, camera, number), layers)?;
            let subject = Subject { scene, camera, number, projection: &projection, frame: &frame, motion: motion.as_ref() };
            let sensed = |sensor: &Sensor| {
                let reading = sensor.sense(&subject)?;
                reading.write(dataset, sensor.name(), &subject)?;
                Ok(SensedFrame { frame: number, drawn: reading.drawn })
            };
            sensors.iter().map(sensed).collect()
        })
    };
    let rows: Vec<Vec<SensedFrame>> = enfilade_parallel::try_map(frames, readings)?;
    for (i, sensor) in sensors.iter().enumerate() {
        let rows: Vec<&SensedFrame> = rows.iter().map(|row| &row[i]).collect();
        dataset.write_sensed_frames(sensor.name(), [scene, camera], &rows)?;
    }
    Ok(())
}
