//! Frames to be seen, and sensors that see them.

use enfilade_dataset::Scan;
use enfilade_frame::{Frame, Layer, Values, f16};
use enfilade_scene::{Intrinsics, Projection};
use enfilade_sensors::{Data, Reading, Sensor, Sensors, Subject};
use std::path::Path;

/// 80 by 60 pixels, 90 degrees wide: a focal length of 40 pixels.
pub fn camera() -> Projection {
    Projection::Pinhole(Intrinsics { width: 80, height: 60, fx: 40.0, fy: 40.0, cx: 40.0, cy: 30.0, skew: 0.0 })
}

/// Surfaces that face the camera's axis, of planar depth `depth_m(x, y)`, reflectance and radiance as given.
pub fn facing(depth_m: impl Fn(usize, usize) -> f64, reflectance: f64, radiance: [f64; 3]) -> Frame {
    let mut frame = Frame::new(80, 60);
    let pixels = || (0..80 * 60).map(|i| (i % 80, i / 80));
    let secant = |(x, y): (usize, usize)| camera().ray(x as f64 + 0.5, y as f64 + 0.5).unwrap().length();
    let thrice = |v: [f64; 3]| Values::F16(pixels().flat_map(|_| v.map(f16::from_f64)).collect());
    frame.insert(Layer::DepthZMeters, Values::F32(pixels().map(|(x, y)| depth_m(x, y) as f32).collect()));
    frame.insert(Layer::DepthMeters, Values::F32(pixels().map(|(x, y)| (depth_m(x, y) * secant((x, y))) as f32).collect()));
    frame.insert(Layer::NormalCam, thrice([0.0, 0.0, 1.0]));
    frame.insert(Layer::DiffuseReflectance, thrice([reflectance; 3]));
    frame.insert(Layer::Color, thrice(radiance));
    frame.insert(Layer::RenderEntityId, Values::I16(vec![1; 80 * 60]));
    frame
}

/// The only sensor of a text.
pub fn sensor(text: &str) -> Sensor {
    let sensors: Sensors = toml::from_str(text).unwrap();
    sensors.check().unwrap();
    sensors.all().next().unwrap()
}

/// Why a text's sensors cannot be used.
pub fn refused(text: &str) -> String {
    toml::from_str::<Sensors>(text).unwrap().check().unwrap_err().to_string()
}

/// The reading of a sensor for a frame.
pub fn reading(text: &str, frame: &Frame) -> Reading {
    let projection = camera();
    sensor(text).sense(&Subject { scene: "room", camera: "cam_00", number: 0, projection: &projection, frame, motion: None }).unwrap()
}

/// The reading as a layer.
pub fn values(text: &str, frame: &Frame) -> (Layer, Values) {
    match reading(text, frame).data {
        Data::Layer(layer, values) => (layer, values),
        Data::File { name, .. } => panic!("a file {name}"),
    }
}

/// The reading as depths, metres.
pub fn depths(text: &str, frame: &Frame) -> Vec<f64> {
    let (_, values) = values(text, frame);
    (0..values.len()).map(|i| values.get(i)).collect()
}

/// The reading as the beams of a scan.
pub fn scan(text: &str, frame: &Frame) -> Scan {
    match reading(text, frame).data {
        Data::File { bytes, .. } => Scan::from_npz(Path::new("scan.npz"), &bytes).unwrap(),
        Data::Layer(layer, _) => panic!("a layer {layer:?}"),
    }
}

/// The reading as a picture of 8 bits a channel, or of 16.
pub fn picture(text: &str, frame: &Frame) -> image::DynamicImage {
    match reading(text, frame).data {
        Data::File { bytes, .. } => image::load_from_memory(&bytes).unwrap(),
        Data::Layer(layer, _) => panic!("a layer {layer:?}"),
    }
}
