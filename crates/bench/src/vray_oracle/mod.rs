//! Imports Hypersim's empty scene with its squares, renders it and compares the picture with V-Ray's own.
//!
//! `vray-oracle SCENES [TAGS] [SAMPLES] [PICTURES.png]`: SCENES is the folder of the shared scenes, TAGS the folder of the squares'
//! pictures (tag36h11 of github.com/AprilRobotics/apriltag-imgs; "-" for none: they are grey then). Prints where the edges are and how the
//! radiance differs, and writes V-Ray's picture, ours, and the difference (grey: none; white: ours is a fifth brighter).

mod edges;
mod picture;
mod scene;
#[cfg(test)]
mod tests;

use anyhow::{Context, Result};
use edges::Sight;
use enfilade_render::{Guide, RenderConfig, RenderScene, render_frame};
use enfilade_scene::{CameraView, Quiet};
use picture::{Picture, relative_differences};
use std::collections::BTreeMap;
use std::path::Path;

/// Side of a block, pixels.
const BLOCK: usize = 16;

/// Runs the instrument.
pub fn run() -> Result<()> {
    let arguments: Vec<String> = crate::arguments::arguments().collect();
    let scenes = Path::new(arguments.first().context("name the folder of the shared scenes")?);
    let tags = arguments.get(1).filter(|t| *t != "-").map(std::path::absolute).transpose()?;
    let samples = arguments.get(2).map_or(Ok(64), |s| s.parse())?;
    let folder = tempfile::tempdir()?;
    let imported = scene::import(scenes, tags.as_deref(), folder.path())?;
    println!("{}", imported.report);
    let camera = scene::taken_with(&imported);
    let view = CameraView::still(&camera, &imported.scene.cameras[0].pose(0));
    let reference = Picture::read(&scene::picture(scenes))?;
    let sight = Sight::new(&imported.scene, view);
    report_edges(&sight, &reference);

    let prepared = RenderScene::new(&imported.scene, &Quiet)?;
    let config = RenderConfig { samples, ..RenderConfig::default() };
    let guide = Guide::learn(&prepared, &[view], &config);
    let ours = Picture::of(&render_frame(&prepared, &guide, &view, &config, &Quiet)?)?.vignetted(imported.scene.cameras[0].fov_x_rad);
    report_radiance(&sight, &ours, &reference);
    if let Some(path) = arguments.get(3) {
        pictures(&reference, &ours).save(path)?;
    }
    Ok(())
}

fn report_edges(sight: &Sight, picture: &Picture) {
    let points = sight.edge_points(picture);
    let mut sizes: Vec<f64> = points.iter().map(|p| p.offset_px.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / points.len().max(1) as f64;
    let at = |q: f64| sizes.get(((sizes.len().max(1) - 1) as f64 * q) as usize).copied().unwrap_or(f64::NAN);
    println!(
        "{} places on edges: outward by {:+.3} px in the mean, right {:+.3}, down {:+.3}; size median {:.3}, 90 % {:.3}, 99 % {:.3}, most {:.3}",
        points.len(),
        mean(&mut points.iter().map(|p| p.offset_px)),
        2.0 * mean(&mut points.iter().map(|p| p.offset_px * p.normal.x)),
        2.0 * mean(&mut points.iter().map(|p| p.offset_px * p.normal.y)),
        at(0.5),
        at(0.9),
        at(0.99),
        at(1.0)
    );
}

fn report_radiance(sight: &Sight, ours: &Picture, reference: &Picture) {
    let (a, b) = (ours.shrunk(BLOCK), reference.shrunk(BLOCK));
    let differences = relative_differences(&a, &b);
    let mut by_part: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for (i, difference) in differences.iter().enumerate() {
        let place = |k: usize| (k * BLOCK) as f64 + 0.5 * BLOCK as f64;
        let part = sight.part_at(place(i % a.width), place(i / a.width));
        let name = part.map_or("background", |p| p.name.split(['@', '_']).next().unwrap_or("")).to_string();
        by_part.entry(name).or_default().push(*difference);
    }
    by_part.insert("all".into(), differences.clone());
    println!("{BLOCK}x{BLOCK} blocks, percent:");
    for (name, values) in by_part {
        let mean = 100.0 * values.iter().sum::<f64>() / values.len() as f64;
        let mut sizes: Vec<f64> = values.iter().map(|v| 100.0 * v.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let at = |q: f64| sizes[((sizes.len() - 1) as f64 * q) as usize];
        println!("{name:>12} {:5}: mean {mean:+.2}, size median {:.2}, 90 % {:.2}, most {:.2}", values.len(), at(0.5), at(0.9), at(1.0));
    }
    let mut worst: Vec<usize> = (0..differences.len()).collect();
    worst.sort_by(|a, b| differences[*b].abs().total_cmp(&differences[*a].abs()));
    for i in worst.into_iter().take(12) {
        let (x, y) = (i % a.width, i / a.width);
        println!(
            "  block at ({}, {}): {:+.1} %, ours {:.4?}, V-Ray's {:.4?}",
            x * BLOCK,
            y * BLOCK,
            100.0 * differences[i],
            a.rgb[i],
            b.rgb[i]
        );
    }
}

/// V-Ray's picture, ours, and the difference, side by side.
fn pictures(reference: &Picture, ours: &Picture) -> image::RgbImage {
    let width = reference.width;
    image::RgbImage::from_fn(3 * width as u32, reference.height as u32, |x, y| {
        let (x, at) = (x as usize, y as usize * width + x as usize % width);
        let (a, b) = (ours.rgb[at], reference.rgb[at]);
        let code = |v: f32| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        let shown = |v: f32| code(v.max(0.0).powf(1.0 / 2.2));
        image::Rgb(match x / width {
            0 => b.map(shown),
            1 => a.map(shown),
            _ => std::array::from_fn(|c| code(0.5 + 2.5 * (a[c] - b[c]))),
        })
    })
}
