//! Readings of sensors: a part for each sensor and frame.

use super::record::{Asked, Part};
use super::sources::Subject;
use crate::error::Error;
use crate::request::Request;
use crate::workdir::Hash;
use enfilade_dataset::counted;
use enfilade_frame::Layer;
use enfilade_scene::Cx;
use enfilade_sensors::{Sensor, sense_frames};
use std::collections::BTreeMap;
use std::path::PathBuf;

pub(super) fn layers(request: &Request) -> Vec<Layer> {
    if let Request::Sensor { sensor, .. } = request { sensor.layers() } else { Vec::new() }
}

pub(super) fn parts(subject: &Subject, request: &Request) -> Result<Vec<Part>, Error> {
    let Request::Sensor { sensor, of } = request else { return Ok(Vec::new()) };
    let (frames, settings) = (subject.chosen(|camera, frame| of.has(camera, frame))?, Hash::of(sensor));
    let part = |frame: (String, u32)| Part {
        name: format!("{}/{}/{:04}", sensor.name(), frame.0, frame.1),
        frames: vec![frame],
        settings: settings.clone(),
    };
    Ok(frames.into_iter().map(part).collect())
}

/// Sensors that look at the same frames look at them together: each frame is read once.
pub(super) fn make(subject: &Subject, asked: &[Asked], cx: &dyn Cx) -> Result<Vec<String>, Error> {
    let mut sensors: Vec<(&Sensor, BTreeMap<&str, Vec<u32>>)> = Vec::new();
    for Asked { part, request } in asked {
        let Request::Sensor { sensor, .. } = request else { continue };
        let (camera, frame) = &part.frames[0];
        let place = sensors.iter().position(|(known, _)| *known == sensor).unwrap_or_else(|| {
            sensors.push((sensor, BTreeMap::new()));
            sensors.len() - 1
        });
        sensors[place].1.entry(camera).or_default().push(*frame);
    }
    for (sensor, _) in &sensors {
        subject.dataset.begin_sensor(sensor.name(), sensor).map_err(Error::stage)?;
    }
    let mut together: BTreeMap<(&str, &[u32]), Vec<Sensor>> = BTreeMap::new();
    for (sensor, cameras) in &sensors {
        for (camera, frames) in cameras {
            together.entry((camera, frames.as_slice())).or_default().push((*sensor).clone());
        }
    }
    for ((camera, frames), sensors) in &together {
        sense_frames(subject.dataset, sensors, [subject.scene, camera], frames, cx).map_err(Error::stage)?;
    }
    let line = |(sensor, cameras): &(&Sensor, BTreeMap<&str, Vec<u32>>)| {
        let frames = cameras.values().map(Vec::len).sum();
        format!("{}: {} of {}", sensor.name(), counted(frames, "frame"), subject.scene)
    };
    Ok(sensors.iter().map(line).collect())
}

pub(super) fn files(subject: &Subject, part: &Part) -> Result<Vec<PathBuf>, Error> {
    let (camera, frame) = &part.frames[0];
    let sensor = part.name.split('/').next().unwrap_or_default();
    let folder = subject.dataset.layout().sensor_dir(sensor).join(subject.scene).join(camera);
    Ok(subject.files_of_frame(&folder, *frame))
}
