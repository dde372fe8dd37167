//! What sensors have made of frames is what their settings say, bit by bit: every reading that is there is made again.

use super::boxes::there;
use super::card::Card;
use super::law::Law;
use super::read::readable;
use enfilade_dataset::{Dataset, DatasetError};
use enfilade_frame::Layer;
use enfilade_scene::Camera;
use enfilade_sensors::{Data, Sensor, Subject};
use rayon::prelude::*;

/// Checks the readings of a scene's cameras. What cannot be read goes on the card.
pub(super) fn check(dataset: &Dataset, scene: &str, cameras: &[(&str, &Camera)], card: &mut Card) {
    for name in readable(card, dataset.sensors()).unwrap_or_default() {
        let Some(sensor) = readable(card, dataset.sensor_settings::<Sensor>(&name)).flatten() else { continue };
        for (camera, model) in cameras {
            let frames = readable(card, dataset.sensed_frame_numbers(&name, [scene, camera])).unwrap_or_default();
            let cards: Vec<Card> = frames.par_iter().map(|&number| check_frame(dataset, &sensor, (scene, camera, number), model)).collect();
            cards.into_iter().for_each(|found| card.merge(found));
        }
    }
}

/// Checks one reading; where its frame is not there, that is told elsewhere.
fn check_frame(dataset: &Dataset, sensor: &Sensor, (scene, camera, number): (&str, &str, u32), model: &Camera) -> Card {
    let mut card = Card::default();
    let layers: Vec<Layer> = sensor.layers().into_iter().filter(|&layer| dataset.gives_layer(scene, camera, number, layer)).collect();
    let Some(frame) = there(dataset.read_frame(scene, camera, number, &layers)).and_then(|read| readable(&mut card, read)) else {
        return card;
    };
    let subject = Subject { scene, camera, number, projection: &model.projection, frame: &frame };
    let place = || format!("sensors/{}/{scene}/{camera}/frame.{number:04}", sensor.name());
    let same = match sensor.sense(&subject) {
        Ok(reading) => readable(&mut card, is_stored(dataset, sensor.name(), (scene, camera, number), &reading.data)),
        Err(error) => {
            card.observe(Law::Sensed, 1.0, || error.to_string());
            return card;
        }
    };
    card.observe(Law::Sensed, if same == Some(true) { 0.0 } else { 1.0 }, place);
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
