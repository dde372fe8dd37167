//! Why a sensor cannot be used.

use enfilade_dataset::DatasetError;

/// Why frames could not be sensed: what was found, what was expected, what to do.
#[derive(Debug, thiserror::Error)]
pub enum SensorError {
    /// The dataset cannot be read or written.
    #[error(transparent)]
    Dataset(#[from] DatasetError),
    /// Settings that contradict themselves or leave their domain.
    #[error("sensor {sensor:?}: {problem}")]
    Setting {
        /// Name of the sensor.
        sensor: String,
        /// The key, what was found, and what is expected.
        problem: String,
    },
    /// A frame that such a sensor cannot see.
    #[error("sensor {sensor:?} cannot see {frame}: {problem}")]
    Frame {
        /// The sensor's name.
        sensor: String,
        /// Scene, camera and number.
        frame: String,
        /// The missing data, and what to do.
        problem: String,
    },
}
