//! Products without a record in a dataset, as earlier versions left them. Those versions removed products that were out of date, so
//! existing ones are fresh when first seen. The requests for them are recovered from the files as far as possible.

use super::record::{MadePart, Place, Record};
use super::relit;
use super::stale::States;
use super::table::PRODUCTS;
use crate::error::Error;
use crate::request::{FlowPairs, FrameChoice, Product, Request, Scope};
use crate::stages::Output;
use enfilade_dataset::{Dataset, DatasetError, WORKDIR};
use enfilade_multiview::CovisibilityConfig;
use enfilade_sensors::Sensor;

/// Writes a record for every product of a scene that is there without one. It is called before anything that they are made from changes.
///
/// # Errors
/// If a file needed to find existing products cannot be read, or a record cannot be written.
pub(crate) fn adopt(dataset: &Dataset, scene: &str) -> Result<(), Error> {
    let place = Place::Scene(scene);
    // A damaged table of cameras is reported, and made again, by planning.
    if !dataset.root().join(WORKDIR).is_dir() || !dataset.layout().metadata_cameras(scene).is_file() || dataset.cameras(scene).is_err() {
        return Ok(());
    }
    for spec in PRODUCTS.iter().filter(|spec| spec.scope != Scope::Dataset) {
        if Record::read(dataset, place, spec.product).is_some() {
            continue;
        }
        let requests = found(dataset, scene, spec.product).map_err(Error::stage)?;
        if !requests.is_empty() {
            take(dataset, place, spec.product, requests)?;
        }
    }
    Ok(())
}

/// Writes the record of a product as if `requests` had made what is there.
fn take(dataset: &Dataset, place: Place, product: Product, requests: Vec<Request>) -> Result<(), Error> {
    let mut record = Record { requests, ..Record::default() };
    let mut states = States::new(dataset, place);
    for wanted in states.wanted_by(product, &record)? {
        let files = (product.spec().files)(&states.subject, &wanted.part)?;
        let files: Vec<Output> = files.iter().filter_map(|path| Output::by_length(dataset.root(), path).ok()).collect();
        if !files.is_empty() {
            record.parts.insert(wanted.part.name, MadePart { from: Some(wanted.key), files });
        }
    }
    record.write(dataset, place, product)
}

/// The requests that would have made the existing files of a product.
fn found(dataset: &Dataset, scene: &str, product: Product) -> Result<Vec<Request>, DatasetError> {
    let layout = dataset.layout();
    Ok(match product {
        Product::Covisibility if layout.covisibility(scene).is_file() => {
            vec![Request::Covisibility { pixels: CovisibilityConfig::default().grid_pixels, cameras: None }]
        }
        Product::Rooms if layout.plane_table(scene).is_file() => vec![Request::Rooms { of: FrameChoice::default() }],
        Product::Words if layout.described_instances(scene).is_file() => vec![Request::Words],
        Product::Flow => flow(dataset, scene)?,
        Product::Tracks => tracks(dataset, scene)?,
        Product::Surfaces => surfaces(dataset, scene)?,
        Product::Sensors => sensors(dataset, scene)?,
        Product::Relit => relit::found(dataset, scene)?,
        _ => Vec::new(),
    })
}

fn flow(dataset: &Dataset, scene: &str) -> Result<Vec<Request>, DatasetError> {
    let mut pairs = Vec::new();
    for camera in dataset.cameras(scene)? {
        pairs.extend(dataset.pairs_with_layers(scene, &camera)?);
    }
    Ok(if pairs.is_empty() { Vec::new() } else { vec![Request::Flow { pairs: FlowPairs::Between(pairs), cameras: None }] })
}

fn tracks(dataset: &Dataset, scene: &str) -> Result<Vec<Request>, DatasetError> {
    let mut requests = Vec::new();
    for camera in dataset.cameras(scene)?.into_iter().filter(|camera| dataset.layout().tracks(scene, camera).is_file()) {
        // Damaged files are reported where they are judged.
        let Ok(tracks) = dataset.read_tracks(scene, &camera) else { continue };
        let frames = tracks.frames.first().zip(tracks.frames.last()).map(|(first, last)| *first..last + 1);
        requests.push(Request::Tracks {
            points: tracks.positions.len() as u32,
            seed: 0,
            of: FrameChoice { cameras: Some(vec![camera]), frames },
        });
    }
    Ok(requests)
}

fn surfaces(dataset: &Dataset, scene: &str) -> Result<Vec<Request>, DatasetError> {
    let mut requests = Vec::new();
    for camera in dataset.cameras(scene)?.into_iter().filter(|camera| dataset.layout().surfaces_dir(scene, camera).is_dir()) {
        let mut numbers = dataset.frame_numbers(scene, &camera)?;
        numbers.retain(|&number| dataset.has_surfaces(scene, &camera, number));
        let Some(Ok(first)) = numbers.first().map(|&number| dataset.read_surfaces(scene, &camera, number)) else { continue };
        let request = |of| Request::Surfaces { layers: first.count as u32, of };
        requests.extend(FrameChoice::runs(&camera, &numbers).map(request));
    }
    Ok(requests)
}

fn sensors(dataset: &Dataset, scene: &str) -> Result<Vec<Request>, DatasetError> {
    let mut requests = Vec::new();
    for name in dataset.sensors()? {
        // Readings of another version are not judged, and cannot be made again.
        let Some(sensor) = dataset.sensor_settings::<Sensor>(&name)?.filter(|sensor| sensor.format == Sensor::FORMAT) else { continue };
        for camera in dataset.cameras(scene)? {
            let numbers = dataset.sensed_frame_numbers(&name, [scene, &camera])?;
            requests.extend(FrameChoice::runs(&camera, &numbers).map(|of| Request::Sensor { sensor: sensor.clone(), of }));
        }
    }
    Ok(requests)
}
