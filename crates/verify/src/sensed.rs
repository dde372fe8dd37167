//! The law of sensors: readings follow from frames and settings, bit by bit. Every existing reading is made again.

use super::card::Card;
use super::law::Law;
use super::not_judged::NotJudged;
use super::read::readable;
use enfilade_dataset::{Dataset, DatasetError};
use enfilade_scene::Camera;
use enfilade_sensors::{Data, Sensor};

/// Checks the readings of a scene's cameras. Unreadable files are added to the card; the returned notes are about readings that could not
/// be checked.
pub(super) fn check(dataset: &Dataset, scene: &str, cameras: &[(&str, &Camera)], not_judged: &NotJudged, card: &mut Card) -> Vec<String> {
    let mut notes = Vec::new();
    for name in readable(card, dataset.sensors()).unwrap_or_default() {
        let Some(sensor) = readable(card, dataset.sensor_settings::<Sensor>(&name)).flatten() else { continue };
        if sensor.format != Sensor::FORMAT {
            notes.push(format!("sensors/{name} is of another version, and was not made again: run enfilade make OUT sensors"));
            continue;
        }
        let problem = match sensor.check() {
            Ok(()) if sensor.name() == name => None,
            Ok(()) => Some(format!("sensors/{name} has the settings of {:?}", sensor.name())),
            Err(error) => Some(error.to_string()),
        };
        if let Some(problem) = problem {
            card.observe(Law::Sensed, 1.0, || problem);
            continue;
        }
        for (camera, model) in cameras {
            let mut frames = readable(card, dataset.sensed_frame_numbers(&name, [scene, camera])).unwrap_or_default();
            let folder = dataset.layout().sensor_dir(&name).join(scene).join(camera);
            frames.retain(|&number| !not_judged.has_of_frame(&folder, number));
            let check = |&number: &u32| check_frame(dataset, &sensor, (scene, camera, number), model);
            let cards: Vec<Card> = enfilade_parallel::map(&frames, check);
            cards.into_iter().for_each(|found| card.merge(found));
        }
    }
    notes
}

/// Checks one reading.
fn check_frame(dataset: &Dataset, sensor: &Sensor, frame: (&str, &str, u32), model: &Camera) -> Card {
    let mut card = Card::default();
    match sensor.look(dataset, frame, &model.projection) {
        Err(error) => card.observe(Law::Sensed, 1.0, || error.to_string()),
        Ok(reading) => {
            let same = readable(&mut card, is_stored(dataset, sensor.name(), frame, &reading.data));
            let (scene, camera, number) = frame;
            let place = || format!("sensors/{}/{scene}/{camera}/frame.{number:04}", sensor.name());
            card.observe(Law::Sensed, if same == Some(true) { 0.0 } else { 1.0 }, place);
        }
    }
    card
}

/// True when a reading has these bits on disk.
fn is_stored(dataset: &Dataset, sensor: &str, frame: (&str, &str, u32), data: &Data) -> Result<bool, DatasetError> {
    match data {
        Data::Layer(layer, values) => {
            let (_, stored) = dataset.read_sensed_layer(sensor, frame, *layer)?;
            Ok(stored.as_bytes() == values.as_bytes())
        }
        Data::File { name, bytes } => {
            let path = dataset.layout().sensed(sensor, frame, name);
            Ok(std::fs::read(&path).is_ok_and(|stored| stored == *bytes))
        }
    }
}
