//! Fixtures for the tests of this crate: a trajectory in a dataset, and OpenEXR files of given channels.

use enfilade_dataset::Dataset;
use enfilade_math::DVec3;
use enfilade_scene::{Camera, Pose, Trajectory};
use exr::prelude::{AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, Layer, LayerAttributes, Text, WritableImage};
use std::path::Path;

/// Two poses of `cam_00`, metres.
pub(crate) fn trajectory() -> Trajectory {
    let pose = |frame, x| Pose::look_at(frame, DVec3::new(x, -3.0, 1.5), DVec3::new(0.0, 0.0, 1.0), DVec3::Z).unwrap();
    Trajectory { name: "cam_00".into(), poses: vec![pose(0, 0.0), pose(1, 0.5)] }
}

/// A dataset with that trajectory in its scene `room`.
pub(crate) fn dataset_of(root: &Path, camera: &Camera) -> Dataset {
    let dataset = Dataset::create(root).unwrap();
    if camera.projection.is_linear() {
        dataset.write_camera_parameters("room", camera).unwrap();
    }
    dataset.write_trajectory("room", &trajectory(), camera, None).unwrap();
    dataset
}

pub(crate) fn channel(name: &str, samples: FlatSamples) -> AnyChannel<FlatSamples> {
    AnyChannel::new(name, samples)
}

/// Writes a file of one part; `transform` is V-Ray's camera.
pub(crate) fn write_exr(
    path: &Path,
    size: [usize; 2],
    channels: Vec<AnyChannel<FlatSamples>>,
    encoding: Encoding,
    transform: Option<([f32; 16], f32)>,
) {
    let mut attributes = LayerAttributes::default();
    if let Some((matrix, fov_x_deg)) = transform {
        attributes.other.insert(Text::new_or_panic("cameraTransform"), AttributeValue::Matrix4x4(matrix));
        attributes.other.insert(Text::new_or_panic("cameraFov"), AttributeValue::F32(fov_x_deg));
        attributes.other.insert(Text::new_or_panic("vrayInfo/vraycore"), AttributeValue::Text(Text::new_or_panic("4.20.01")));
    }
    let layer = Layer::new((size[0], size[1]), attributes, encoding, AnyChannels::sort(channels.into_iter().collect()));
    Image::from_layer(layer).write().to_file(path).unwrap();
}

/// Writes a file of several parts.
pub(crate) fn write_parts(path: &Path, size: [usize; 2], parts: Vec<(String, Vec<AnyChannel<FlatSamples>>)>) {
    let layer = |(name, channels): (String, Vec<AnyChannel<FlatSamples>>)| {
        let attributes = LayerAttributes::named(name.as_str());
        Layer::new((size[0], size[1]), attributes, Encoding::SMALL_LOSSLESS, AnyChannels::sort(channels.into_iter().collect()))
    };
    let layers: Vec<_> = parts.into_iter().map(layer).collect();
    Image::from_layers(exr::prelude::ImageAttributes::with_size((size[0], size[1])), layers).write().to_file(path).unwrap();
}
