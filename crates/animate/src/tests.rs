//! Animations, decoded again: sizes, times, colours and refusals.

use crate::{Animation, AnimationFormat};
use enfilade_show::picture::{Picture, from_pixels};
use openh264::decoder::Decoder as H264Decoder;
use openh264::formats::YUVSource;

/// A smooth picture in motion, or one of seven colours.
fn picture(width: u32, height: u32, time: u32, smooth: bool) -> Picture {
    from_pixels(width, height, |i| {
        let (x, y) = ((i as u32 % width) as f64, (i as u32 / width) as f64);
        let wave = |phase: f64| (127.5 + 120.0 * ((x + 3.0 * f64::from(time)) / 19.0 + y / 23.0 + phase).sin()) as u8;
        if smooth { [wave(0.0), wave(2.1), wave(4.2), 255] } else { [(i as u32 / 11 % 7) as u8 * 40, 90, 200, 255] }
    })
}

fn encode(format: AnimationFormat, pictures: &[(Picture, u32)], fps: f64) -> Vec<u8> {
    let mut animation = Animation::begin(format, pictures[0].0.dimensions(), fps).unwrap();
    pictures.iter().for_each(|(picture, times)| animation.add(picture, *times).unwrap());
    animation.finish().unwrap()
}

/// Pictures as RGB with their size, and when each begins in seconds; the last number is when the animation ends.
type Decoded = (Vec<((u32, u32), Vec<u8>)>, Vec<f64>);

fn decode(format: AnimationFormat, bytes: &[u8]) -> Decoded {
    match format {
        AnimationFormat::Mp4 => decode_mp4(bytes),
        AnimationFormat::Gif => decode_gif(bytes),
    }
}

fn decode_gif(bytes: &[u8]) -> Decoded {
    let mut options = ::gif::DecodeOptions::new();
    options.set_color_output(::gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes).unwrap();
    let (mut pictures, mut times) = (Vec::new(), vec![0.0]);
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        let rgb = frame.buffer.chunks(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        pictures.push(((u32::from(frame.width), u32::from(frame.height)), rgb));
        times.push(times[times.len() - 1] + f64::from(frame.delay) / 100.0);
    }
    (pictures, times)
}

/// The content of the first box of that name, anywhere in the file.
fn find_box<'a>(bytes: &'a [u8], name: &[u8; 4]) -> &'a [u8] {
    let at = bytes.windows(4).position(|w| w == name).unwrap();
    let length = u32::from_be_bytes(bytes[at - 4..at].try_into().unwrap()) as usize;
    &bytes[at + 4..at - 4 + length]
}

/// Our own reading of the boxes that a player needs; the pictures are then decoded by OpenH264.
fn decode_mp4(bytes: &[u8]) -> Decoded {
    let settings = find_box(bytes, b"avcC");
    let sps_length = usize::from(u16::from_be_bytes([settings[6], settings[7]]));
    let pps = &settings[8 + sps_length..];
    let pps_length = usize::from(u16::from_be_bytes([pps[1], pps[2]]));
    let start = [0, 0, 0, 1];
    let head = [&start[..], &settings[8..8 + sps_length], &start[..], &pps[3..3 + pps_length]].concat();
    let sizes = find_box(bytes, b"stsz");
    let word = |at: usize| u32::from_be_bytes(sizes[at..at + 4].try_into().unwrap()) as usize;
    let mut rest = find_box(bytes, b"mdat");
    let mut decoder = H264Decoder::new().unwrap();
    let mut pictures = Vec::new();
    for sample in 0..word(8) {
        let (mut units, after) = rest.split_at(word(12 + 4 * sample));
        rest = after;
        let mut stream = if sample == 0 { head.clone() } else { Vec::new() };
        while let Some((length, unit)) = units.split_first_chunk::<4>() {
            let length = u32::from_be_bytes(*length) as usize;
            stream.extend_from_slice(&[&start, &unit[..length]].concat());
            units = &unit[length..];
        }
        let yuv = decoder.decode(&stream).unwrap().expect("a picture for each sample");
        let (width, height) = yuv.dimensions();
        let mut rgb = vec![0; 3 * width * height];
        yuv.write_rgb8(&mut rgb);
        pictures.push(((width as u32, height as u32), rgb));
    }
    let media = find_box(bytes, b"mdhd");
    let word = |at: usize| f64::from(u32::from_be_bytes(media[at..at + 4].try_into().unwrap()));
    (pictures, vec![0.0, word(16) / word(12)])
}

/// Peak signal to noise ratio in decibels over the part that both have.
fn psnr(expected: &Picture, (size, rgb): &((u32, u32), Vec<u8>)) -> f64 {
    let errors = expected.enumerate_pixels().flat_map(|(x, y, pixel)| {
        let at = 3 * (y * size.0 + x) as usize;
        (0..3).map(move |c| f64::from(i32::from(pixel.0[c]) - i32::from(rgb[at + c])).powi(2))
    });
    10.0 * (255.0 * 255.0 / (errors.sum::<f64>() / f64::from(3 * expected.width() * expected.height()))).log10()
}

#[test]
fn pictures_come_back_as_they_were_but_for_little() {
    for (format, least_db) in [(AnimationFormat::Mp4, 34.0), (AnimationFormat::Gif, 28.0)] {
        let pictures: Vec<_> = (0..4).map(|time| (picture(160, 120, time, true), 1)).collect();
        let (decoded, times) = decode(format, &encode(format, &pictures, 10.0));
        assert_eq!((decoded.len(), times[times.len() - 1]), (4, 0.4), "{format:?}");
        for ((expected, _), found) in pictures.iter().zip(&decoded) {
            let db = psnr(expected, found);
            assert!(db > least_db, "{format:?}: {db:.1} dB");
        }
    }
}

#[test]
fn few_colors_are_kept_exactly_by_gif() {
    let drawn = picture(61, 37, 0, false);
    let (decoded, _) = decode(AnimationFormat::Gif, &encode(AnimationFormat::Gif, &[(drawn.clone(), 1)], 5.0));
    assert_eq!(psnr(&drawn, &decoded[0]), f64::INFINITY);
}

#[test]
fn odd_sizes_and_single_pictures_are_animations_too() {
    for format in AnimationFormat::ALL {
        for (width, height) in [(1, 1), (17, 9), (161, 95), (1920, 1080)] {
            let shown = picture(width, height, 0, true);
            let bytes = encode(format, &[(shown.clone(), 1)], 5.0);
            let (decoded, times) = decode(format, &bytes);
            let (w, h) = decoded[0].0;
            let coded = |n: u32| if format == AnimationFormat::Mp4 { n.next_multiple_of(2).max(16) } else { n };
            assert_eq!((w, h), (coded(width), coded(height)), "{format:?}");
            let lasts = times[times.len() - 1];
            assert!(lasts > 0.1, "{format:?} {width}x{height}: lasts {lasts} s");
            assert!(psnr(&shown, &decoded[0]) > 27.0, "{format:?} {width}x{height}: {:.1} dB", psnr(&shown, &decoded[0]));
        }
    }
}

#[test]
fn a_picture_may_stand_for_several() {
    let pictures = [(picture(64, 48, 0, true), 3), (picture(64, 48, 9, true), 1)];
    for format in AnimationFormat::ALL {
        let (decoded, times) = decode(format, &encode(format, &pictures, 30.0));
        let end = times[times.len() - 1];
        assert!((end - 4.0 / 30.0).abs() < 0.006, "{format:?}: {end}");
        let last = psnr(&pictures[1].0, decoded.last().unwrap());
        assert!(last > 27.0, "{format:?}: {last:.1} dB");
    }
}

#[test]
fn the_same_pictures_give_the_same_bytes() {
    let pictures: Vec<_> = (0..3).map(|time| (picture(97, 50, time, true), 1)).collect();
    for format in AnimationFormat::ALL {
        assert!(encode(format, &pictures, 5.0) == encode(format, &pictures, 5.0), "{format:?}");
    }
}

#[test]
fn what_cannot_be_encoded_is_refused_with_a_reason() {
    let message = |format, size, fps| Animation::begin(format, size, fps).err().map(|e| e.to_string()).unwrap_or_default();
    let large = message(AnimationFormat::Mp4, (4096, 2160), 5.0);
    assert!(large.contains("4096x2160") && large.contains("3840x2160") && large.contains("gif"), "{large}");
    assert!(message(AnimationFormat::Gif, (4, 4), 0.0).contains("at most 100"));
    for format in AnimationFormat::ALL {
        let mut animation = Animation::begin(format, (8, 8), 5.0).unwrap();
        let wrong = animation.add(&picture(9, 8, 0, true), 1).unwrap_err().to_string();
        assert!(wrong.contains("9x8 pixels") && wrong.contains("8x8 pixels"), "{wrong}");
        assert!(Animation::begin(format, (8, 8), 5.0).unwrap().finish().is_err(), "{format:?} without pictures");
    }
}
