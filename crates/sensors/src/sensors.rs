//! All sensors of a file `sensors.toml`.

use crate::reading::{Reading, Subject};
use crate::triangulation::SecondEye;
use crate::{CameraSensor, Imu, Lidar, SensorError, TimeOfFlight, Triangulation};
use enfilade_dataset::check_name;
use enfilade_frame::Layer;
use serde::{Deserialize, Serialize};

/// The sensors that frames are shown to: the tables of `sensors.toml`.
///
/// ```
/// let sensors: enfilade_sensors::Sensors = toml::from_str(
///     r#"
///     [[camera]]
///     name = "phone"
///     format = "jpg"
///     full_well_electrons = [1000, 8000]
///
///     [[structured_light]]
///     name = "kinect"
///     baseline_m = 0.075
///     "#,
/// )?;
/// assert_eq!(sensors.all().map(|sensor| sensor.name().to_string()).collect::<Vec<_>>(), ["phone", "kinect"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sensors {
    /// Another seed gives other noise and other numbers of every range.
    #[serde(default)]
    pub seed: u64,
    /// Cameras.
    #[serde(default)]
    pub camera: Vec<CameraSensor>,
    /// Depth by the time of flight.
    #[serde(default)]
    pub time_of_flight: Vec<TimeOfFlight>,
    /// Depth by a projector beside the camera.
    #[serde(default)]
    pub structured_light: Vec<Triangulation>,
    /// Depth by a second camera beside the first.
    #[serde(default)]
    pub stereo: Vec<Triangulation>,
    /// Scanners of laser beams.
    #[serde(default)]
    pub lidar: Vec<Lidar>,
    /// Inertial measurement units.
    #[serde(default)]
    pub imu: Vec<Imu>,
}

/// One sensor, with everything that its readings depend on beside the frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sensor {
    /// Version of the sensors' output: [`Sensor::FORMAT`].
    pub format: u32,
    /// Seed of its noise and of the values drawn for every frame.
    pub seed: u64,
    /// The sensor itself.
    pub kind: Kind,
}

/// Kinds of sensor, with their settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs, reason = "the structures say it")]
pub enum Kind {
    Camera(CameraSensor),
    TimeOfFlight(TimeOfFlight),
    StructuredLight(Triangulation),
    Stereo(Triangulation),
    Lidar(Lidar),
    Imu(Imu),
}

impl Sensors {
    /// All sensors, by kind, in their order.
    pub fn all(&self) -> impl Iterator<Item = Sensor> + '_ {
        let cameras = self.camera.iter().cloned().map(Kind::Camera);
        let timers = self.time_of_flight.iter().cloned().map(Kind::TimeOfFlight);
        let projectors = self.structured_light.iter().cloned().map(Kind::StructuredLight);
        let pairs = self.stereo.iter().cloned().map(Kind::Stereo);
        let scanners = self.lidar.iter().cloned().map(Kind::Lidar);
        let units = self.imu.iter().cloned().map(Kind::Imu);
        cameras.chain(timers).chain(projectors).chain(pairs).chain(scanners).chain(units).map(|kind| Sensor {
            format: Sensor::FORMAT,
            seed: self.seed,
            kind,
        })
    }

    /// Checks every key of every sensor, and that no two have one name.
    ///
    /// # Errors
    /// The first one that is out of its domain.
    pub fn check(&self) -> Result<(), SensorError> {
        let mut names: Vec<String> = Vec::new();
        for sensor in self.all() {
            sensor.check()?;
            if names.iter().any(|name| name == sensor.name()) {
                let problem = "another sensor has this name; its folder is called after it, so give it one of its own".into();
                return Err(SensorError::Setting { sensor: sensor.name().into(), problem });
            }
            names.push(sensor.name().into());
        }
        Ok(())
    }
}

impl Sensor {
    /// Raised when the same settings give other readings.
    pub const FORMAT: u32 = 1;

    /// Name of its folder.
    pub fn name(&self) -> &str {
        match &self.kind {
            Kind::Camera(sensor) => &sensor.name,
            Kind::TimeOfFlight(sensor) => &sensor.name,
            Kind::StructuredLight(sensor) | Kind::Stereo(sensor) => &sensor.name,
            Kind::Lidar(sensor) => &sensor.name,
            Kind::Imu(sensor) => &sensor.name,
        }
    }

    /// The layers that it looks at.
    pub fn layers(&self) -> Vec<Layer> {
        match &self.kind {
            Kind::Camera(sensor) => sensor.layers(),
            Kind::TimeOfFlight(sensor) => sensor.layers(),
            Kind::StructuredLight(sensor) | Kind::Stereo(sensor) => sensor.layers(),
            Kind::Lidar(sensor) => sensor.layers(),
            Kind::Imu(_) => Vec::new(),
        }
    }

    /// Whether it feels how the camera moves.
    pub(crate) fn feels_motion(&self) -> bool {
        matches!(self.kind, Kind::Imu(_))
    }

    /// Checks every key.
    ///
    /// # Errors
    /// The first one that is out of its domain.
    pub fn check(&self) -> Result<(), SensorError> {
        check_name("sensor name", self.name())?;
        let checked = match &self.kind {
            Kind::Camera(sensor) => sensor.check(),
            Kind::TimeOfFlight(sensor) => sensor.check(),
            Kind::StructuredLight(sensor) | Kind::Stereo(sensor) => sensor.check(),
            Kind::Lidar(sensor) => sensor.check(),
            Kind::Imu(sensor) => sensor.check(),
        };
        checked.map_err(|problem| SensorError::Setting { sensor: self.name().into(), problem })
    }

    /// The reading for a frame.
    ///
    /// # Errors
    /// If the frame lacks a layer that the sensor needs, or its camera does not suit such a sensor.
    pub fn sense(&self, subject: &Subject<'_>) -> Result<Reading, SensorError> {
        let rng = subject.rng(self.seed, self.name(), subject.number);
        match &self.kind {
            Kind::Camera(sensor) => sensor.sense(subject, rng),
            Kind::TimeOfFlight(sensor) => sensor.sense(subject, rng),
            Kind::StructuredLight(sensor) => sensor.sense(SecondEye::Projector, subject, rng),
            Kind::Stereo(sensor) => sensor.sense(SecondEye::Camera, subject, rng),
            Kind::Lidar(sensor) => sensor.sense(subject, rng),
            Kind::Imu(sensor) => sensor.sense(subject, self.seed),
        }
    }
}
