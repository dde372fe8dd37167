//! OpenEXR: the first part's R, G, B (or Y) at full resolution; alpha and other channels are left out.

use super::float_picture::{FloatPicture, check_size};
use ::exr::block;
use ::exr::meta::header::Header;
use ::exr::meta::{BlockDescription, MetaData};
use ::exr::prelude::*;
use std::collections::{BTreeMap, HashSet};
use std::io::{Cursor, Read, Seek};

/// Channels that take more bytes than this when they are decoded are refused.
const MAX_BYTES: u64 = 1 << 30;
/// Blocks (tiles, or the lines that are compressed together) that take more bytes than this are refused.
const MAX_BLOCK_BYTES: u64 = 1 << 27;

/// Decodes an EXR.
pub(super) fn decode(bytes: &[u8]) -> std::result::Result<FloatPicture, String> {
    check(bytes)?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(|e| format!("cannot be decoded ({e})"))?;
    let layer = &image.layer_data;
    let (width, height) = (layer.size.width(), layer.size.height());
    let channels = &layer.channel_data.list;
    let names = || channels.iter().map(|c| c.name.to_string()).collect::<Vec<_>>().join(", ");
    let rgb = colors(channels);
    let [Some(r), Some(g), Some(b)] = rgb else { return Err("has no channels".into()) };
    if [r, g, b].iter().any(|c| c.sampling != Vec2(1, 1) || c.sample_data.len() != width * height) {
        return Err(format!("has subsampled channels ({}), which are not supported; save it as plain RGB", names()));
    }
    let (r, g, b) = (r.sample_data.values_as_f32(), g.sample_data.values_as_f32(), b.sample_data.values_as_f32());
    let texels = r.zip(g).zip(b).map(|((r, g), b)| [r, g, b]).collect();
    Ok(FloatPicture { width: width as u32, height: height as u32, texels })
}

/// The channels of red, green and blue: those without a layer's name (`R`), or else of the first layer that has them
/// (`beauty.R`); where there are none, all three are `Y` or the first channel.
fn colors(channels: &[AnyChannel<FlatSamples>]) -> [Option<&AnyChannel<FlatSamples>>; 3] {
    // Of each layer, the nameless one first: red, green, blue and grey.
    let mut layers: BTreeMap<String, [Option<&AnyChannel<FlatSamples>>; 4]> = BTreeMap::new();
    for channel in channels {
        let name = channel.name.to_string();
        let (layer, last) = name.rsplit_once('.').unwrap_or(("", &name));
        if let Some(place) = ["R", "G", "B", "Y"].iter().position(|color| last.eq_ignore_ascii_case(color)) {
            layers.entry(layer.to_string()).or_default()[place].get_or_insert(channel);
        }
    }
    let grey = layers.values().find_map(|layer| layer[3]).or(channels.first());
    // Of layers with equally many colours the first, which `max_by_key` would leave for the last.
    let [r, g, b, _] = layers.into_values().rev().max_by_key(|layer| layer[..3].iter().flatten().count()).unwrap_or_default();
    [r, g, b].map(|channel| channel.or(grey))
}

/// Refuses pictures whose channels would fill the memory, before any is allocated.
fn check(bytes: &[u8]) -> std::result::Result<(), String> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(|e| format!("cannot be decoded ({e})"))?;
    for header in &meta.headers {
        let (width, height) = (header.layer_size.width(), header.layer_size.height());
        check_size(u32::try_from(width).unwrap_or(u32::MAX), u32::try_from(height).unwrap_or(u32::MAX))?;
        let size = (width as u64 * height as u64).saturating_mul(header.channels.bytes_per_pixel as u64);
        if size > MAX_BYTES {
            return Err(format!(
                "has {width}x{height} pixels of {} bytes, expected at most {MAX_BYTES} bytes; make it smaller",
                header.channels.bytes_per_pixel
            ));
        }
    }
    check_exr_blocks(&meta.headers)?;
    check_exr_table(Cursor::new(bytes), |part| part == 0)
}

/// Refuses an EXR with blocks for which the library would allocate without bound.
///
/// To be called with a file's headers before its pixels are read: a tile may be far larger than the picture, and the library allocates
/// as much as a block claims, which only the tile's size bounds.
///
/// # Errors
/// When a block can take more than 128 MiB; the message is the rest of a sentence that begins with the file's name.
pub fn check_exr_blocks(headers: &[Header]) -> std::result::Result<(), String> {
    match headers.iter().map(block_bytes).max() {
        Some(block) if block > MAX_BLOCK_BYTES => Err(format!(
            "has blocks of up to {block} bytes, expected at most {MAX_BLOCK_BYTES}; save it with smaller tiles, or in scan lines with \
             ZIP compression"
        )),
        _ => Ok(()),
    }
}

/// Refuses an EXR whose table of blocks does not lead to each block once, at full resolution, of the parts that are wanted.
///
/// The library finds blocks by the table, and pixels by the block's own header. If the two differ, it would write a block
/// of another resolution or part over the picture, stop with a panic, or leave pixels out.
///
/// # Errors
/// When the table is wrong or a block cannot be read; the message is the rest of a sentence that begins with the file's name.
pub fn check_exr_table(read: impl Read + Seek, wanted: impl Fn(usize) -> bool) -> std::result::Result<(), String> {
    let check = || -> Result<bool> {
        let file = block::read(read, false)?;
        let headers = file.headers().to_vec();
        let is_wanted = |part: usize, level: Vec2<usize>| wanted(part) && level == Vec2(0, 0);
        let mut found = HashSet::new();
        for chunk in file.filter_chunks(false, |_, tile, block| is_wanted(block.layer, tile.level_index))? {
            let chunk = chunk?;
            let Some(header) = headers.get(chunk.layer_index) else { return Ok(false) };
            let tile = header.get_block_data_indices(&chunk.compressed_block)?;
            let place = (chunk.layer_index, tile.tile_index.x(), tile.tile_index.y());
            if !is_wanted(chunk.layer_index, tile.level_index) || !found.insert(place) {
                return Ok(false);
            }
        }
        Ok(true)
    };
    match check() {
        Ok(true) => Ok(()),
        Ok(false) => Err("is damaged: its table of blocks does not lead to each block once; save it again".into()),
        Err(e) => Err(format!("cannot be read as OpenEXR ({e})")),
    }
}

/// The most bytes that a block can take.
fn block_bytes(header: &Header) -> u64 {
    let pixels = match header.blocks {
        BlockDescription::Tiles(tiles) => (tiles.tile_size.width() as u64).saturating_mul(tiles.tile_size.height() as u64),
        BlockDescription::ScanLines => header.compression.scan_lines_per_block() as u64 * header.layer_size.width() as u64,
    };
    pixels.saturating_mul(header.channels.bytes_per_pixel as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_rgb_and_float_grey_are_read() {
        let mut bytes = Cursor::new(Vec::new());
        let layer = SpecificChannels::rgb(|Vec2(x, y)| (f16::from_f32(x as f32), f16::from_f32(y as f32), f16::from_f32(0.5)));
        Image::from_channels((2, 2), layer).write().to_buffered(&mut bytes).unwrap();
        let picture = decode(bytes.get_ref()).unwrap();
        assert_eq!(picture.texels, vec![[0.0, 0.0, 0.5], [1.0, 0.0, 0.5], [0.0, 1.0, 0.5], [1.0, 1.0, 0.5]]);

        let mut bytes = Cursor::new(Vec::new());
        let grey = SpecificChannels::build().with_channel("Y").with_pixel_fn(|Vec2(x, _)| (x as f32 * 2.0,));
        Image::from_channels((2, 1), grey).write().to_buffered(&mut bytes).unwrap();
        assert_eq!(decode(bytes.get_ref()).unwrap().texels, vec![[0.0; 3], [2.0; 3]]);
    }

    #[test]
    fn colours_come_from_one_layer_and_the_nameless_one_first() {
        let picture = |names: &[&str]| {
            let channels: Vec<_> =
                names.iter().enumerate().map(|(i, name)| AnyChannel::new(*name, FlatSamples::F32(vec![i as f32]))).collect();
            let layer = Layer::new((1, 1), LayerAttributes::default(), Encoding::FAST_LOSSLESS, AnyChannels::sort(channels.into()));
            let mut bytes = Cursor::new(Vec::new());
            Image::from_layer(layer).write().to_buffered(&mut bytes).unwrap();
            decode(bytes.get_ref()).unwrap().texels[0]
        };
        assert_eq!(picture(&["AO.R", "Diffuse.B", "Diffuse.G", "Diffuse.R", "B", "G", "R", "Y"]), [6.0, 5.0, 4.0]);
        assert_eq!(picture(&["AO.R", "beauty.b", "beauty.g", "beauty.r"]), [3.0, 2.0, 1.0]);
        assert_eq!(picture(&["depth.Z", "main.Y"]), [1.0; 3]);
        assert_eq!(picture(&["Z"]), [0.0; 3]);
    }

    /// A picture of 4x4 in tiles of 2x2 and its smaller copies, six tiles in all, and where in the file the table of their places is.
    fn with_levels() -> (Vec<u8>, usize) {
        let level = |side: usize| FlatSamples::F32((0..side * side).map(|i| i as f32).collect());
        let levels = Levels::Mip { rounding_mode: ::exr::math::RoundingMode::Down, level_data: vec![level(4), level(2), level(1)] };
        let encoding =
            Encoding { compression: Compression::Uncompressed, blocks: Blocks::Tiles(Vec2(2, 2)), line_order: LineOrder::Increasing };
        let channels = AnyChannels::sort(vec![AnyChannel::new("Y", levels)].into());
        let layer = Layer::new((4, 4), LayerAttributes::default(), encoding, channels);
        let mut bytes = Cursor::new(Vec::new());
        Image::from_layer(layer).write().to_buffered(&mut bytes).unwrap();
        let bytes = bytes.into_inner();
        // A tile takes 20 bytes before its four floats, and the last level has a single one.
        let table = bytes.len() - (5 * 36 + 24) - 6 * 8;
        (bytes, table)
    }

    #[test]
    fn blocks_of_another_resolution_and_blocks_found_twice_are_refused() {
        let (whole, table) = with_levels();
        assert_eq!(decode(&whole).unwrap().texels[14], [14.0; 3]);
        let refused = |from: usize, to: usize| {
            let mut bytes = whole.clone();
            bytes.copy_within(table + 8 * from..table + 8 * (from + 1), table + 8 * to);
            decode(&bytes).err().unwrap()
        };
        for (from, to) in [(4, 0), (5, 3), (1, 2)] {
            assert!(refused(from, to).contains("does not lead to each block once"), "{from} {to}");
        }
    }
}
