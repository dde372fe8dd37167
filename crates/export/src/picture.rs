//! Pictures of a frame as bytes of PNG and JPEG files.

use crate::ExportError;
use crate::selected_frames::{SelectedFrames, View};
use enfilade_frame::tonemap::ToneMap;
use enfilade_frame::{Frame, Layer};
use enfilade_show::picture::{Picture, jpeg};
use enfilade_show::preview::{Subject, preview};

/// The layers that the picture of a frame is made from.
pub(crate) const SHOWN: [Layer; 2] = [Layer::Color, Layer::RenderEntityId];

/// The frame's colour as the preview `tonemap` shows it: one exposure per image, gamma 1/2.2. `frame` has `color`.
pub(crate) fn tone_mapped(selected: &SelectedFrames<'_>, view: View<'_>, frame: &Frame) -> Result<Picture, ExportError> {
    let tone = ToneMap::of_frame(frame).unwrap_or_default();
    let shown = preview(Subject::ToneMapped, frame, tone);
    shown.map(|shown| shown.picture).ok_or_else(|| selected.unsuitable(view.name(), "it has no layer color; render it"))
}

/// The bytes of a JPEG file of a frame's colour.
pub(crate) fn color_jpeg(selected: &SelectedFrames<'_>, view: View<'_>, frame: &Frame) -> Result<Vec<u8>, ExportError> {
    Ok(jpeg(&tone_mapped(selected, view, frame)?))
}

/// The bytes of an RGB PNG file of a frame's colour.
pub(crate) fn color_png(selected: &SelectedFrames<'_>, view: View<'_>, frame: &Frame) -> Result<Vec<u8>, ExportError> {
    let picture = tone_mapped(selected, view, frame)?;
    let rgb: Vec<u8> = picture.pixels().flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    Ok(rgb_png(frame.width, frame.height, &rgb))
}

/// The bytes of an RGB PNG file of 8 bits a channel.
pub(crate) fn rgb_png(width: u32, height: u32, rgb: &[u8]) -> Vec<u8> {
    encode(width, height, png::ColorType::Rgb, png::BitDepth::Eight, rgb)
}

/// The bytes of a grey PNG file of 8 bits.
pub(crate) fn grey8_png(width: u32, height: u32, values: &[u8]) -> Vec<u8> {
    encode(width, height, png::ColorType::Grayscale, png::BitDepth::Eight, values)
}

/// The bytes of a grey PNG file of 16 bits.
pub(crate) fn grey16_png(width: u32, height: u32, values: &[u16]) -> Vec<u8> {
    grey16_png_with_text(width, height, values, &[])
}

/// The bytes of a grey PNG file of 16 bits with these keywords and their texts, both plain ASCII.
pub(crate) fn grey16_png_with_text(width: u32, height: u32, values: &[u16], texts: &[(&str, String)]) -> Vec<u8> {
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_be_bytes()).collect();
    encode_with_text(width, height, png::ColorType::Grayscale, png::BitDepth::Sixteen, &bytes, texts)
}

fn encode(width: u32, height: u32, color: png::ColorType, depth: png::BitDepth, data: &[u8]) -> Vec<u8> {
    encode_with_text(width, height, color, depth, data, &[])
}

fn encode_with_text(
    width: u32,
    height: u32,
    color: png::ColorType,
    depth: png::BitDepth,
    data: &[u8],
    texts: &[(&str, String)],
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    for (keyword, text) in texts {
        encoder.add_text_chunk((*keyword).to_string(), text.clone()).expect("there is no header yet");
    }
    let mut writer = encoder.write_header().expect("writing to memory cannot fail");
    writer.write_image_data(data).expect("as many pixels as the header says");
    writer.finish().expect("writing to memory cannot fail");
    bytes
}
