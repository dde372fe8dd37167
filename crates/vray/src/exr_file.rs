//! V-Ray's images: OpenEXR files, as `vrimg2exr` or V-Ray itself writes them.
//!
//! The image is `R`, `G`, `B`; a render element `E` is `E.R`, `E.G`, `E.B` (or `E.X`, …), and one that is a number `E` alone. Scan
//! lines and tiles, half, float and whole numbers, one part or several (where a part is named after the element) are all read.

use crate::error::VrayError;
use crate::header::Header;
use enfilade_dataset::DatasetError;
use enfilade_import::{check_exr_blocks, check_exr_table};
use exr::image::FlatSamples;
use exr::meta::MetaData;
use exr::prelude::{ReadChannels, ReadLayers, read};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// Channels and parts of an image at most; one with all of V-Ray's render elements has fewer.
const MAX_CHANNELS: usize = 512;
/// Images whose channels take more bytes than this when they are decoded are refused: 4 GiB, which is 129 channels of floats at 3840x2160.
const MAX_BYTES: u64 = 1 << 32;
/// Names that writers use for the part with the image itself.
const IMAGE_PARTS: [&str; 4] = ["", "rgba", "rgb color", "beauty"];

/// An image with its render elements.
#[derive(Debug)]
pub struct VrayImage {
    path: PathBuf,
    pub(crate) header: Header,
    channels: BTreeMap<String, FlatSamples>,
}

impl VrayImage {
    /// Reads a file of the given size. Nothing of an image is read before its header is known to be of that size.
    ///
    /// # Errors
    /// When it cannot be read, or is of another size, a part of an image, subsampled or deep.
    pub fn read(path: &Path, size: [u32; 2]) -> Result<Self, VrayError> {
        let wrong = |problem: String| VrayError::usage(format!("{}: {problem}", path.display()), CONVERT);
        let open =
            || File::open(path).map(BufReader::new).map_err(|source| DatasetError::Io { action: "read", path: path.to_path_buf(), source });
        let damaged = |e: exr::error::Error| wrong(format!("it cannot be read as OpenEXR ({e})"));
        check_headers(&MetaData::read_from_buffered(open()?, false).map_err(damaged)?, size).map_err(wrong)?;
        check_exr_table(open()?, |_| true).map_err(|problem| wrong(format!("it {problem}")))?;
        let image = read().no_deep_data().largest_resolution_level().all_channels().all_layers().all_attributes();
        let image = image.from_buffered(open()?).map_err(damaged)?;
        let (mut header, mut channels) = (Header::default(), BTreeMap::new());
        let parts = image.layer_data.len();
        image.attributes.other.iter().for_each(|(name, value)| header.take(&name.to_string(), value));
        for layer in image.layer_data {
            layer.attributes.other.iter().for_each(|(name, value)| header.take(&name.to_string(), value));
            let part = layer.attributes.layer_name.map_or(String::new(), |name| name.to_string());
            for channel in layer.channel_data.list {
                let name = full_name(if parts > 1 { &part } else { "" }, &channel.name.to_string());
                if channels.insert(name.clone(), channel.sample_data).is_some() {
                    return Err(wrong(format!("it has two channels {name}")));
                }
            }
        }
        Ok(Self { path: path.to_path_buf(), header, channels })
    }

    /// Path of the image, for messages.
    pub fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// True when it has the render element, in colours or coordinates.
    pub fn has(&self, element: &str) -> bool {
        self.find(element).is_some()
    }

    /// Three channels of a render element, pixel by pixel; the image itself has the name "".
    ///
    /// # Errors
    /// When it has none.
    pub fn triples(&self, element: &str) -> Result<Vec<[f32; 3]>, VrayError> {
        let [r, g, b] = self.find(element).ok_or_else(|| self.lacks(if element.is_empty() { "R, G and B" } else { element }))?;
        Ok(r.values_as_f32().zip(g.values_as_f32()).zip(b.values_as_f32()).map(|((r, g), b)| [r, g, b]).collect())
    }

    /// A render element of whole numbers; −1 means none, also where it is stored as 2³² − 1.
    ///
    /// # Errors
    /// When the image lacks it, or some values are not whole numbers, as after filtering.
    pub fn ids(&self, element: &str) -> Result<Vec<i64>, VrayError> {
        let names = [element.to_string(), format!("{element}.{element}"), format!("{element}.Y"), format!("{element}.R")];
        let samples = names.iter().find_map(|name| self.channels.get(name)).ok_or_else(|| self.lacks(element))?;
        let id = |(index, v): (usize, f64)| match v {
            _ if v == f64::from(u32::MAX) => Ok(-1),
            _ if v.fract() == 0.0 && v.abs() <= f64::from(1 << 24) => Ok(v as i64),
            _ => Err(VrayError::usage(
                format!("{}: {element} is {v} at pixel index {index}, which is no number of an entity", self.path.display()),
                "render it with the scene that `enfilade vray layers` made, without filters and with whole numbers (write_integer_ids)",
            )),
        };
        let values: Vec<f64> = match samples {
            FlatSamples::U32(v) => v.iter().map(|&v| f64::from(v)).collect(),
            FlatSamples::F32(v) => v.iter().map(|&v| f64::from(v)).collect(),
            FlatSamples::F16(v) => v.iter().map(|v| f64::from(v.to_f32())).collect(),
        };
        values.into_iter().enumerate().map(id).collect()
    }

    fn find(&self, element: &str) -> Option<[&FlatSamples; 3]> {
        let channel = |letter: &str| {
            let name = if element.is_empty() { letter.to_string() } else { format!("{element}.{letter}") };
            self.channels.get(&name)
        };
        let all = |[a, b, c]: [&str; 3]| Some([channel(a)?, channel(b)?, channel(c)?]);
        all(["R", "G", "B"]).or_else(|| all(["X", "Y", "Z"]))
    }

    fn lacks(&self, what: &str) -> VrayError {
        let there = self.channels.keys().cloned().collect::<Vec<_>>().join(", ");
        VrayError::usage(format!("{}: it has no {what}, only {there}", self.path.display()), CONVERT)
    }
}

const CONVERT: &str = "render it whole with the scene that `enfilade vray layers` and `pass` made, and convert it with all channels: \
    vrimg2exr FILE.vrimg FILE.exr";

/// A channel's name, preceded by its part's name unless it already has that.
fn full_name(part: &str, channel: &str) -> String {
    let is_image = IMAGE_PARTS.contains(&part.to_ascii_lowercase().as_str());
    if is_image || channel.strip_prefix(part).is_some_and(|rest| rest.is_empty() || rest.starts_with('.')) {
        channel.into()
    } else {
        format!("{part}.{channel}")
    }
}

fn check_headers(file: &MetaData, [width, height]: [u32; 2]) -> Result<(), String> {
    let channels: usize = file.headers.iter().map(|header| header.channels.list.len()).sum();
    if channels > MAX_CHANNELS {
        return Err(format!("it has {channels} channels, and no image of V-Ray's more than {MAX_CHANNELS}"));
    }
    for header in &file.headers {
        let (found, whole) = (header.layer_size, header.shared_attributes.display_window.size);
        let at = header.own_attributes.layer_position;
        if header.deep {
            return Err("it is a deep image".into());
        }
        if (found.0, found.1) != (width as usize, height as usize) {
            let of = if found == whole { String::new() } else { format!(" of an image of {}x{}", whole.0, whole.1) };
            return Err(format!("it has {}x{} pixels{of}, and the dataset's camera {width}x{height}", found.0, found.1));
        }
        if (at.0, at.1) != (header.shared_attributes.display_window.position.0, header.shared_attributes.display_window.position.1) {
            return Err(format!("it is a part of an image, from pixel ({}, {}) on", at.0, at.1));
        }
        if let Some(channel) = header.channels.list.iter().find(|channel| (channel.sampling.0, channel.sampling.1) != (1, 1)) {
            return Err(format!("its channel {} has not every pixel", channel.name));
        }
    }
    let bytes_per_pixel: u64 = file.headers.iter().map(|header| header.channels.bytes_per_pixel as u64).sum();
    let bytes = u64::from(width).saturating_mul(u64::from(height)).saturating_mul(bytes_per_pixel);
    if bytes > MAX_BYTES {
        return Err(format!("its {channels} channels take {bytes} bytes, expected at most {MAX_BYTES}; leave out render elements"));
    }
    check_exr_blocks(&file.headers).map_err(|problem| format!("it {problem}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{channel, write_exr, write_parts};
    use exr::prelude::{Compression, Encoding, LineOrder};

    fn samples(n: usize) -> FlatSamples {
        FlatSamples::F32((0..n).map(|i| i as f32).collect())
    }

    fn read_of(write: impl FnOnce(&Path), size: [u32; 2]) -> Result<VrayImage, VrayError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.0000.exr");
        write(&path);
        VrayImage::read(&path, size)
    }

    #[test]
    fn halves_floats_numbers_tiles_and_parts_are_read() {
        let half = FlatSamples::F16((0..20).map(|i| exr::prelude::f16::from_f32(i as f32)).collect());
        let ids = FlatSamples::U32((0..20).map(|i| if i == 3 { u32::MAX } else { i }).collect());
        let all = || vec![channel("R", half.clone()), channel("G", samples(20)), channel("B", samples(20)), channel("Id", ids.clone())];
        let tiles = exr::prelude::Blocks::Tiles(exr::prelude::Vec2(4, 4));
        for blocks in [exr::prelude::Blocks::ScanLines, tiles] {
            let encoding = Encoding { compression: Compression::ZIP16, blocks, line_order: LineOrder::Increasing };
            let image = read_of(|path| write_exr(path, [5, 4], all(), encoding, None), [5, 4]).unwrap();
            assert_eq!(image.triples("").unwrap()[7], [7.0; 3]);
            assert_eq!(image.ids("Id").unwrap()[2..5], [2, -1, 4]);
        }
        let part = |name: &str, from: f32| {
            let values = |c: f32| FlatSamples::F32(vec![from + c; 20]);
            (name.to_string(), vec![channel("R", values(0.0)), channel("G", values(1.0)), channel("B", values(2.0))])
        };
        let parts = vec![part("RGBA", 0.5), part("VRayNormal", 10.0)];
        let image = read_of(|path| write_parts(path, [5, 4], parts), [5, 4]).unwrap();
        assert_eq!((image.triples("").unwrap()[0], image.triples("VRayNormal").unwrap()[19]), ([0.5, 1.5, 2.5], [10.0, 11.0, 12.0]));
    }

    #[test]
    fn what_is_no_image_of_the_camera_is_refused_in_words() {
        let rgb = || vec![channel("R", samples(20)), channel("G", samples(20)), channel("B", samples(20))];
        let write = |path: &Path| write_exr(path, [5, 4], rgb(), Encoding::SMALL_LOSSLESS, None);
        let message = |result: Result<VrayImage, VrayError>| result.unwrap_err().to_string();
        assert!(message(read_of(write, [4, 4])).contains("it has 5x4 pixels, and the dataset's camera 4x4"));
        let image = read_of(write, [5, 4]).unwrap();
        assert!(image.triples("VRayNormal").unwrap_err().to_string().contains("it has no VRayNormal, only B, G, R"));
        let blended = vec![channel("Id", FlatSamples::F32((0..20).map(|i| i as f32 * 0.5).collect()))];
        let image = read_of(|path| write_exr(path, [5, 4], blended, Encoding::SMALL_LOSSLESS, None), [5, 4]).unwrap();
        assert!(image.ids("Id").unwrap_err().to_string().contains("Id is 0.5 at pixel index 1"));
        assert!(message(read_of(|path| std::fs::write(path, b"no image").unwrap(), [5, 4])).contains("cannot be read as OpenEXR"));
        let cut = |path: &Path| {
            write(path);
            let bytes = std::fs::read(path).unwrap();
            std::fs::write(path, &bytes[..bytes.len() - 20]).unwrap();
        };
        assert!(message(read_of(cut, [5, 4])).contains("cannot be read as OpenEXR"));
    }

    #[test]
    fn what_would_fill_the_memory_is_refused_before_it_is_read() {
        let rgb = || vec![channel("R", samples(20)), channel("G", samples(20)), channel("B", samples(20))];
        let tiles = exr::prelude::Blocks::Tiles(exr::prelude::Vec2(1 << 16, 1 << 16));
        let encoding = Encoding { compression: Compression::Uncompressed, blocks: tiles, line_order: LineOrder::Increasing };
        let problem = read_of(|path| write_exr(path, [5, 4], rgb(), encoding, None), [5, 4]).unwrap_err().to_string();
        assert!(problem.contains("frame.0000.exr: it has blocks of up to 51539607552 bytes, expected at most 134217728"), "{problem}");

        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.0000.exr");
        write_exr(&path, [5, 4], rgb(), Encoding::SMALL_LOSSLESS, None);
        let mut file = MetaData::read_from_file(&path, false).unwrap();
        file.headers[0].layer_size = exr::prelude::Vec2(20_000, 20_000);
        let problem = check_headers(&file, [20_000, 20_000]).unwrap_err();
        assert!(problem.starts_with("its 3 channels take 4800000000 bytes, expected at most 4294967296"), "{problem}");
    }
}
