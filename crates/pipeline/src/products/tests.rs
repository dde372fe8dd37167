//! The matrix: for every product and every input that changes, it is fresh or out of date according to the table.

use super::record::{MadePart, Place, Record};
use super::sources::Source;
use super::stale::{States, out_of_date};
use super::table::{PRODUCTS, ProductSpec, When};
use crate::relight::mixes_of;
use crate::request::{FlowPairs, FrameChoice, MixRequest, PairsRequest, Product, Request, Scope};
use enfilade_dataset::{Dataset, WORKDIR, mesh_names, write_bytes};
use enfilade_frame::Layer;
use enfilade_sensors::Sensors;
use enfilade_testroom as testroom;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

const SCENE: &str = "room";

/// Something that changes, the sources that it is, and layers whose values change with it.
struct Change {
    name: &'static str,
    sources: &'static [Source],
    layers: &'static [Layer],
    /// Changes files, which are given to be written again afterwards.
    files: fn(&Dataset) -> Vec<PathBuf>,
    make: fn(&Path),
}

fn append(path: &Path) {
    let mut bytes = std::fs::read(path).unwrap_or_default();
    bytes.push(b' ');
    write_bytes(path, bytes).unwrap();
}

/// Another checksum of the layer whose name ends so, in a frame's record.
fn other_checksum(path: &Path, layer: &str) {
    let mut record: serde_json::Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    let files = record["files"].as_object_mut().unwrap();
    let (_, file) = files.iter_mut().find(|(name, _)| name.ends_with(layer)).unwrap();
    file["blake3"] = "0".repeat(64).into();
    write_bytes(path, record.to_string()).unwrap();
}

fn frame_record(dataset: &Dataset) -> Vec<PathBuf> {
    vec![dataset.layout().frame_record(SCENE, "cam_00", 1)]
}

const CHANGES: [Change; 10] = [
    Change {
        name: "depth",
        sources: &[Source::WholeFrames],
        layers: &[Layer::DepthMeters],
        files: frame_record,
        make: |path| other_checksum(path, ".depth_meters.hdf5"),
    },
    Change {
        name: "colour",
        sources: &[Source::WholeFrames],
        layers: &[Layer::Color],
        files: frame_record,
        make: |path| other_checksum(path, ".color.hdf5"),
    },
    Change {
        name: "semantics",
        sources: &[],
        layers: &[Layer::Semantic],
        files: |dataset| vec![dataset.layout().label_record(SCENE, "cam_00", 1)],
        make: |path| other_checksum(path, ".semantic.hdf5"),
    },
    Change {
        name: "where the camera stood",
        sources: &[Source::Frames, Source::WholeFrames],
        layers: &[],
        files: frame_record,
        make: |path| {
            let mut record: serde_json::Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
            record["pose"]["position"][0] = 0.125.into();
            write_bytes(path, record.to_string()).unwrap();
        },
    },
    Change {
        name: "the trajectory",
        sources: &[Source::Poses],
        layers: &[],
        files: |dataset| vec![dataset.layout().keyframes(SCENE, "cam_00", "look_at_positions")],
        make: append,
    },
    Change {
        name: "the scene",
        sources: &[Source::Package],
        layers: &[],
        files: |dataset| vec![dataset.layout().scene_package(SCENE)],
        make: append,
    },
    Change {
        name: "the label tables",
        sources: &[Source::Labels],
        layers: &[],
        files: |dataset| vec![dataset.mesh_files(SCENE).file(mesh_names::OBJECTS_SEMANTIC)],
        make: append,
    },
    Change {
        name: "exposures",
        sources: &[Source::Exposures],
        layers: &[],
        files: |dataset| vec![dataset.layout().tone_maps(SCENE, "cam_00")],
        make: append,
    },
    Change {
        name: "fixtures",
        sources: &[Source::Fixtures],
        layers: &[],
        files: |dataset| vec![dataset.layout().metadata_fixtures(SCENE)],
        make: |path| write_bytes(path, [std::fs::read(path).unwrap_or_default(), b"\n".to_vec()].concat()).unwrap(),
    },
    Change {
        name: "rooms as they were built",
        sources: &[Source::Product(Product::Rooms)],
        layers: &[],
        files: |dataset| vec![dataset.layout().rooms(SCENE)],
        make: append,
    },
];

/// One request of each product.
fn requests(folder: &Path) -> Vec<Request> {
    let of = FrameChoice::default();
    let sensors: Sensors = serde_json::from_str(r#"{"camera": [{"name": "phone"}], "time_of_flight": [{"name": "tof"}]}"#).unwrap();
    let file = folder.join("mixes.csv");
    std::fs::write(&file, "mix,fixture,r,g,b\nhalf,*,0.5,0.5,0.5\n").unwrap();
    let mut requests = vec![
        PairsRequest::default().covisibility(),
        Request::Pairs(PairsRequest::default()),
        Request::Flow { pairs: FlowPairs::Step(1), cameras: None },
        Request::Tracks { points: 16, seed: 1, of: of.clone() },
        Request::Surfaces { layers: 2, of: of.clone() },
        Request::Rooms { of: of.clone() },
        Request::Words,
    ];
    requests.extend(sensors.all().map(|sensor| Request::Sensor { sensor, of: of.clone() }));
    let mixes = mixes_of(&file, None).unwrap();
    requests.extend(mixes.into_iter().map(|mix| Request::Mix { mix: MixRequest(mix), of: of.clone() }));
    requests
}

fn place(spec: &ProductSpec) -> Place<'static> {
    if spec.scope == Scope::Dataset { Place::Dataset } else { Place::Scene(SCENE) }
}

/// Records of all products as if they had just been made, without files.
fn make_all(dataset: &Dataset, requests: &[Request]) {
    for spec in PRODUCTS.iter().filter(|spec| spec.when == When::Asked) {
        let mut record = Record::default();
        requests.iter().filter(|request| request.product() == spec.product).for_each(|request| record.ask(request));
        record.write(dataset, place(spec), spec.product).unwrap();
        let wanted = States::new(dataset, place(spec)).wanted_by(spec.product, &record).unwrap();
        assert!(!wanted.is_empty(), "{}", spec.name);
        record.parts = wanted.into_iter().map(|part| (part.part.name, MadePart { from: Some(part.key), files: Vec::new() })).collect();
        record.write(dataset, place(spec), spec.product).unwrap();
    }
}

fn stale(dataset: &Dataset) -> BTreeSet<Product> {
    out_of_date(dataset, &[SCENE.into()]).unwrap().into_iter().map(|found| found.product).collect()
}

/// Whether a change makes a product out of date according to the table. Records of [`make_all`] list no files, so a product's own do not
/// count.
fn is_expected(spec: &ProductSpec, requests: &[Request], change: &Change) -> bool {
    let own: Vec<Layer> = requests.iter().filter(|request| request.product() == spec.product).flat_map(spec.layers).collect();
    let reads_layer = spec.reads.contains(&Source::Frames) && own.iter().any(|layer| change.layers.contains(layer));
    let by_product = spec.products().any(|product| is_expected(product.spec(), requests, change));
    reads_layer || by_product || spec.reads.iter().any(|source| change.sources.contains(source))
}

#[test]
fn products_are_out_of_date_exactly_where_the_table_says_that_they_read_what_has_changed() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = testroom::dataset(folder.path());
    std::fs::create_dir_all(dataset.root().join(WORKDIR)).unwrap();
    let requests = requests(folder.path());
    make_all(&dataset, &requests);
    assert_eq!(stale(&dataset), BTreeSet::new());
    for change in &CHANGES {
        let files = (change.files)(&dataset);
        let before: Vec<Option<Vec<u8>>> = files.iter().map(|path| std::fs::read(path).ok()).collect();
        files.iter().for_each(|path| (change.make)(path));
        let expected = PRODUCTS.iter().filter(|spec| is_expected(spec, &requests, change)).map(|spec| spec.product).collect();
        assert_eq!(stale(&dataset), expected, "{}", change.name);
        for (path, bytes) in files.iter().zip(before) {
            match bytes {
                Some(bytes) => write_bytes(path, bytes).unwrap(),
                None => std::fs::remove_file(path).unwrap(),
            }
        }
        assert_eq!(stale(&dataset), BTreeSet::new(), "{} as it was", change.name);
    }
}

#[test]
fn another_version_and_a_part_that_was_not_finished_are_out_of_date() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = testroom::dataset(folder.path());
    std::fs::create_dir_all(dataset.root().join(WORKDIR)).unwrap();
    let requests = requests(folder.path());
    make_all(&dataset, &requests);
    let place = Place::Scene(SCENE);
    let mut record = Record::read(&dataset, place, Product::Sensors).unwrap();
    let whole = record.clone();
    let names: Vec<String> = record.parts.keys().cloned().collect();
    assert_eq!(names, ["phone/cam_00/0000", "phone/cam_00/0001", "tof/cam_00/0000", "tof/cam_00/0001"]);
    record.parts.get_mut(&names[1]).unwrap().from = None;
    record.parts.remove(&names[2]);
    record.write(&dataset, place, Product::Sensors).unwrap();
    let found = out_of_date(&dataset, &[SCENE.into()]).unwrap();
    assert_eq!(found.iter().map(|stale| (stale.product, stale.parts)).collect::<Vec<_>>(), [(Product::Sensors, 2)]);
    whole.write(&dataset, place, Product::Sensors).unwrap();
    assert!(out_of_date(&dataset, &[SCENE.into()]).unwrap().is_empty());
}

#[test]
fn the_table_is_in_the_order_of_the_enum_and_each_product_comes_after_those_it_reads() {
    for (i, spec) in PRODUCTS.iter().enumerate() {
        assert_eq!(spec.product as usize, i);
        assert!(spec.after().all(|product| product < spec.product), "{}", spec.name);
        assert_eq!(Product::from_name(spec.name), Some(spec.product));
    }
}

#[test]
fn later_requests_replace_what_they_cover() {
    let of = |frames| FrameChoice { cameras: None, frames };
    let surfaces = |layers, frames| Request::Surfaces { layers, of: of(frames) };
    let mut record = Record::default();
    for request in [surfaces(2, None), surfaces(4, Some(0..2)), surfaces(8, Some(0..1)), surfaces(3, Some(0..2))] {
        record.ask(&request);
    }
    assert_eq!(record.requests, [surfaces(2, None), surfaces(3, Some(0..2))]);
    record.ask(&surfaces(5, None));
    assert_eq!(record.requests, [surfaces(5, None)]);
    // A sensor has one setting; another one takes the place of all readings.
    let sensor = |text: &str, frames| {
        let sensors: Sensors = serde_json::from_str(text).unwrap();
        Request::Sensor { sensor: sensors.all().next().unwrap(), of: of(frames) }
    };
    let [one, other] = [r#"{"camera": [{"name": "phone"}]}"#, r#"{"camera": [{"name": "phone", "contrast": [1.5, 1.5]}]}"#];
    let mut record = Record::default();
    record.ask(&sensor(one, None));
    record.ask(&sensor(one, Some(1..2)));
    assert_eq!(record.requests.len(), 2);
    record.ask(&sensor(other, Some(0..1)));
    assert_eq!(record.requests, [sensor(other, Some(0..1))]);
}
