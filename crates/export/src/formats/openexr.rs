//! Multi-layer OpenEXR: `<scene>/<camera>/frame.IIII.exr` has every layer of a frame, and Cryptomatte layers of instances and classes.
//!
//! `color` is the file's R, G and B; every other layer has channels `<layer>.R/G/B`, `.X/Y/Z` where it is a point or direction, or `.V`
//! where it is one number. Values, units and "nothing hit" are those of the dataset, bit by bit: float16 is half, all else float (which
//! represents int16 and bytes exactly). Planar depth alone is along the axis of K, which a tilted image plane turns away from the
//! dataset's. Compression is ZIP, without loss.

use crate::ExportError;
use crate::export_folder::ExportFolder;
use crate::formats::cryptomatte::Cryptomatte;
use crate::selected_frames::{SelectedFrames, View};
use enfilade_frame::{Frame, Layer, Values};
use enfilade_scene::{Labels, NYU40};
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, Layer as ExrLayer, LayerAttributes, Text, WritableImage, f16,
};
use std::io::Cursor;

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    selected.each(|view| {
        let frame = selected.read_all(view)?;
        let labels = selected.labels(&view.track.scene)?;
        let name = format!("{}/frame.{:04}.exr", view.track.folder(), view.frame());
        out.write(&name, &file(selected, view, &frame, &labels)?)
    })?;
    Ok(())
}

/// The bytes of a frame's file.
fn file(selected: &SelectedFrames<'_>, view: View<'_>, frame: &Frame, labels: &Labels) -> Result<Vec<u8>, ExportError> {
    let mut channels: Vec<AnyChannel<FlatSamples>> = frame.iter().flat_map(|(layer, values)| channels_of(layer, values)).collect();
    let mut attributes = LayerAttributes::default();
    for matte in mattes(frame, labels) {
        let zero = vec![0.0; matte.ids.len()];
        let rank = [("R", matte.ids.clone()), ("G", matte.coverage.clone()), ("B", zero.clone()), ("A", zero)];
        channels.extend(rank.map(|(c, v)| channel(&format!("{}00.{c}", matte.name), FlatSamples::F32(v))));
        for (name, value) in matte.attributes() {
            attributes.other.insert(Text::new_or_panic(name), AttributeValue::Text(Text::new_or_panic(value)));
        }
    }
    encoded(selected, view, frame, channels, attributes)
}

/// The bytes of a file of one channel, `Y`.
pub(super) fn grey_exr(selected: &SelectedFrames<'_>, view: View<'_>, frame: &Frame, values: Vec<f32>) -> Result<Vec<u8>, ExportError> {
    encoded(selected, view, frame, vec![channel("Y", FlatSamples::F32(values))], LayerAttributes::default())
}

/// The bytes of a file of these channels.
fn encoded(
    selected: &SelectedFrames<'_>,
    view: View<'_>,
    frame: &Frame,
    channels: Vec<AnyChannel<FlatSamples>>,
    attributes: LayerAttributes,
) -> Result<Vec<u8>, ExportError> {
    let size = (frame.width as usize, frame.height as usize);
    let layer = ExrLayer::new(size, attributes, Encoding::SMALL_LOSSLESS, AnyChannels::sort(channels.into_iter().collect()));
    let mut bytes = Vec::new();
    let written = Image::from_layer(layer).write().non_parallel().to_buffered(Cursor::new(&mut bytes));
    written.map_err(|error| selected.unsuitable(view.name(), format!("OpenEXR refuses it: {error}")))?;
    sort_attributes(&mut bytes);
    Ok(bytes)
}

/// The channels of a layer.
fn channels_of(layer: Layer, values: &Values) -> Vec<AnyChannel<FlatSamples>> {
    let spec = layer.spec();
    let letters = match (spec.channels, spec.space) {
        (1, _) => ["V"].as_slice(),
        (_, space) if space.starts_with("linear RGB") => &["R", "G", "B"],
        _ => &["X", "Y", "Z"],
    };
    let name = |letter: &str| if layer == Layer::Color { letter.to_string() } else { format!("{}.{letter}", spec.name) };
    let every = |c: usize| (c..values.len()).step_by(spec.channels);
    let samples = |c: usize| match values {
        Values::F16(v) => FlatSamples::F16(every(c).map(|i| f16::from_bits(v[i].to_bits())).collect()),
        other => FlatSamples::F32(every(c).map(|i| other.get(i) as f32).collect()),
    };
    letters.iter().take(spec.channels).enumerate().map(|(c, letter)| channel(&name(letter), samples(c))).collect()
}

fn channel(name: &str, samples: FlatSamples) -> AnyChannel<FlatSamples> {
    AnyChannel { quantize_linearly: false, ..AnyChannel::new(name, samples) }
}

/// The Cryptomatte layers that the frame's labels allow.
fn mattes(frame: &Frame, labels: &Labels) -> Vec<Cryptomatte> {
    let class = |id: i32| usize::try_from(id - 1).ok().and_then(|i| NYU40.get(i)).map(|class| class.name.to_string());
    let class_of = |instance: i32| labels.parts.iter().find(|l| i32::from(l.instance) == instance).map(|l| i32::from(l.semantic));
    let instance = |number: i32| {
        let name = class_of(number).and_then(class).unwrap_or_else(|| "instance".into());
        (number > 0).then(|| format!("{name}_{number:03}"))
    };
    let instances = frame.get(Layer::SemanticInstance).map(|values| Cryptomatte::new("crypto_instance", values, instance));
    let classes = frame.get(Layer::Semantic).map(|values| Cryptomatte::new("crypto_class", values, class));
    instances.into_iter().chain(classes).collect()
}

/// Puts the attributes of the header in order of name, since the library writes them in another order every time.
///
/// An attribute is its name, a zero, its type, a zero, its length in four bytes, and its value; an empty name ends the header.
fn sort_attributes(file: &mut [u8]) {
    const START: usize = 8; // after the magic number and the version
    let text_end = |from: usize| from + file[from..].iter().position(|&b| b == 0).unwrap_or(0);
    let mut attributes: Vec<Vec<u8>> = Vec::new();
    let mut at = START;
    while file[at] != 0 {
        let length_at = text_end(text_end(at) + 1) + 1;
        let length = u32::from_le_bytes([file[length_at], file[length_at + 1], file[length_at + 2], file[length_at + 3]]);
        let end = length_at + 4 + length as usize;
        attributes.push(file[at..end].to_vec());
        at = end;
    }
    attributes.sort();
    file[START..at].copy_from_slice(&attributes.concat());
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_frame::{Dtype, LAYERS};
    use std::collections::BTreeSet;

    #[test]
    fn every_layer_has_as_many_channels_as_values_and_names_of_its_own() {
        let mut names = BTreeSet::new();
        for spec in LAYERS {
            let n = 6 * spec.channels;
            let values = match spec.dtype {
                Dtype::F16 => Values::F16(vec![enfilade_frame::f16::ONE; n]),
                Dtype::F32 => Values::F32(vec![1.0; n]),
                Dtype::I16 => Values::I16(vec![1; n]),
                Dtype::U8 => Values::U8(vec![1; n]),
            };
            let channels = channels_of(spec.layer, &values);
            assert_eq!(channels.len(), spec.channels, "{}", spec.name);
            for channel in channels {
                assert_eq!(channel.sample_data.len(), 6, "{}", spec.name);
                assert!(names.insert(channel.name.to_string()), "{:?}", channel.name);
            }
        }
    }
}
