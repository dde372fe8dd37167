//! Time that the network in the binary takes, and the differences between sets of instructions.
//!
//! `network [--quick] [--keep FOLDER] [COLOR.pfm NORMAL.pfm]…` filters each picture, or one that it makes up, with every set of
//! instructions of this processor (`--quick`: without the portable ones): three times each, in turn, or once if one run takes longer than
//! five seconds. It prints the least user and system time in seconds, a hash of the bytes, and the difference from the first row: the mean
//! of |a − b| over the mean of |b|, and the greatest |a − b| over |b| plus a hundredth of that mean. With `--keep` the last picture, its
//! normals and the first set's output are left as `color.pfm`, `normal.pfm` and `ours.pfm`, for `xtask/python/library.py`, which compares
//! them with the library.

use enfilade_denoise::{Denoiser, Instructions, Noisy};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Three values per pixel.
struct Picture {
    width: u32,
    height: u32,
    values: Vec<f32>,
}

/// Runs the instrument.
pub fn run() -> Result<()> {
    let threads = rayon::current_num_threads();
    let sets = Instructions::available().into_iter().rev();
    let mut denoisers: Vec<_> = sets.map(|set| (set.name(), Denoiser::built_in_with(set))).collect();
    let mut arguments = crate::arguments::arguments().peekable();
    if arguments.next_if_eq("--quick").is_some() {
        denoisers.retain(|(set, _)| *set != "portable");
    }
    let mut kept = None;
    if arguments.next_if_eq("--keep").is_some() {
        kept = Some(PathBuf::from(arguments.next().ok_or("--keep lacks a folder")?));
    }
    let mut pictures = Vec::new();
    while let Some(color) = arguments.next() {
        let normal = arguments.next().ok_or_else(|| format!("{color} lacks the picture of its normals"))?;
        let (light, normal) = (read(&color)?, read(&normal)?);
        if (light.width, light.height) != (normal.width, normal.height) {
            return Err(format!("{color} and the picture of its normals differ in size").into());
        }
        pictures.push((color, light, normal));
    }
    if pictures.is_empty() {
        pictures.push(("made up".into(), corner(384, 288, true), corner(384, 288, false)));
    }
    println!("{threads} threads");
    for (name, color, normal) in pictures {
        println!("\n{name}, {}x{}", color.width, color.height);
        let ours = measure(&color, &normal, &denoisers);
        if let Some(folder) = &kept {
            let ours = Picture { width: color.width, height: color.height, values: ours };
            for (name, picture) in [("color", &color), ("normal", &normal), ("ours", &ours)] {
                write(&folder.join(format!("{name}.pfm")), picture)?;
            }
        }
    }
    Ok(())
}

/// Returns the output of the first of the denoisers.
fn measure(color: &Picture, normal: &Picture, denoisers: &[(&str, Denoiser)]) -> Vec<f32> {
    let white = vec![1.0; color.values.len()];
    let noisy = Noisy { width: color.width, height: color.height, color: &color.values, albedo: &white, normal: &normal.values };
    let mut found: Vec<(f64, Vec<f32>)> = denoisers.iter().map(|_| (f64::INFINITY, Vec::new())).collect();
    for time in 0..3 {
        for ((_, denoiser), (least, output)) in denoisers.iter().zip(&mut found) {
            if time > 0 && *least > 5.0 {
                continue;
            }
            let before = cpu_seconds();
            *output = denoiser.filter(&noisy);
            *least = least.min(cpu_seconds() - before);
        }
    }
    for ((set, denoiser), (seconds, output)) in denoisers.iter().zip(&found) {
        let mut hasher = DefaultHasher::new();
        output.iter().for_each(|value| value.to_bits().hash(&mut hasher));
        let (mean, greatest) = difference(output, &found[0].1);
        println!(
            "  {:<58} {set:<8} {seconds:>7.2} core-s {:>6.2} per Mpx  {:016x}  mean {mean:.2e}, greatest {greatest:.2e}",
            denoiser.name(),
            1e6 * seconds / f64::from(color.width * color.height),
            hasher.finish(),
        );
    }
    found.swap_remove(0).1
}

/// Mean and greatest difference, as above.
fn difference(a: &[f32], b: &[f32]) -> (f64, f64) {
    let mean = b.iter().map(|&b| f64::from(b).abs()).sum::<f64>() / b.len() as f64;
    let each = || a.iter().zip(b).map(|(&a, &b)| (f64::from(a - b).abs(), f64::from(b).abs()));
    let greatest = each().map(|(d, b)| d / (b + 0.01 * mean)).fold(0.0, f64::max);
    (each().map(|(d, _)| d).sum::<f64>() / b.len() as f64 / mean, greatest)
}

/// User and system seconds of this process.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    let ticks = |i: usize| fields.get(i).and_then(|field| field.parse::<f64>().ok()).unwrap_or(f64::NAN);
    (ticks(11) + ticks(12)) / 100.0
}

/// A floor and two walls under a light that falls off, with noise, or their normals.
fn corner(width: u32, height: u32, light: bool) -> Picture {
    let mut state = 1u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1u64 << 24) as f32
    };
    let mut values = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let (u, v) = (x as f32 / width as f32, y as f32 / height as f32);
            let side = if v > 0.6 { 2 } else { usize::from(u > 0.5) };
            let radiance = [0.8, 0.4, 1.5][side] * (1.2 - u) / (0.3 + v);
            for channel in 0..3 {
                // The square of a random number three times its mean: fireflies among darkness.
                let noise = 3.0 * random().powi(2);
                values.push(if light { radiance * noise } else { f32::from(channel == side) });
            }
        }
    }
    Picture { width, height, values }
}

/// A portable float map in colour: three lines of text, then rows from the bottom, little-endian where the scale is negative.
fn read(path: &str) -> Result<Picture> {
    let file = std::fs::read(path).map_err(|error| format!("{path}: {error}"))?;
    let mut parts = file.splitn(4, |&byte| byte == b'\n');
    let mut line = || parts.next().and_then(|line| std::str::from_utf8(line).ok()).unwrap_or_default().trim();
    let (kind, size, scale) = (line(), line(), line());
    let (width, height) = size.split_once(' ').ok_or_else(|| format!("{path}: the second line is `{size}`; expected a size"))?;
    let (width, height): (u32, u32) = (width.parse()?, height.parse()?);
    let data = parts.next().unwrap_or_default();
    if kind != "PF" || !scale.starts_with('-') || data.len() != 12 * width as usize * height as usize {
        return Err(format!("{path}: not a little-endian portable float map in colour").into());
    }
    let values: Vec<f32> = data.as_chunks().0.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect();
    Ok(Picture { width, height, values: values.chunks_exact(3 * width as usize).rev().flatten().copied().collect() })
}

/// Writes a file that [`read`] can read.
fn write(path: &Path, picture: &Picture) -> Result<()> {
    let mut bytes = format!("PF\n{} {}\n-1\n", picture.width, picture.height).into_bytes();
    let rows = picture.values.chunks_exact(3 * picture.width as usize).rev();
    bytes.extend(rows.flatten().flat_map(|value| value.to_le_bytes()));
    std::fs::write(path, bytes).map_err(|error| format!("{}: {error}", path.display()).into())
}
