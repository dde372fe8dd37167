//! A labelled cloud of points: `<scene>.ply`, the surfaces that the frames of all cameras of a scene show, fused.
//!
//! One point for every cube of a centimetre that contains the surface point of some pixel: at the exact position of the first one, with its
//! normal and labels, and with the mean of the colours of all. Binary PLY, little-endian.

use crate::ExportError;
use crate::depth::distance_m;
use crate::export_folder::ExportFolder;
use crate::picture::{SHOWN, tone_mapped};
use crate::selected_frames::{SelectedFrames, Track, View};
use enfilade_frame::{Frame, Layer, vector};
use enfilade_math::DVec3;
use std::collections::BTreeMap;

/// Side of the cubes, metres. Their middles are at whole multiples, as floors and walls are.
const CUBE_M: f64 = 0.01;

/// Frames that are read before they are fused: what bounds the memory.
const AT_ONCE: usize = 16;

/// A point of a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfacePoint {
    /// World, metres.
    pub position: DVec3,
    /// Colour as displayed, sRGB.
    pub color: [u8; 3],
}

/// The contents of a cube.
struct Fused {
    position: DVec3,
    normal: DVec3,
    /// Class, instance and part; −1 for none.
    labels: [i16; 3],
    color: [f64; 3],
    pixels: u32,
}

/// By the place of the cube.
type Cubes = BTreeMap<[i64; 3], Fused>;

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    for tracks in selected.scenes() {
        out.write(&format!("{}.ply", tracks[0].scene), &ply(cubes(selected, tracks)?.values()))?;
    }
    Ok(())
}

/// The points of a scene alone, with their colours.
pub(crate) fn fused(selected: &SelectedFrames<'_>, tracks: &[Track]) -> Result<Vec<SurfacePoint>, ExportError> {
    let point = |cube: Fused| SurfacePoint { position: cube.position, color: cube.mean_color() };
    Ok(cubes(selected, tracks)?.into_values().map(point).collect())
}

/// The cubes of all frames of a scene.
fn cubes(selected: &SelectedFrames<'_>, tracks: &[Track]) -> Result<Cubes, ExportError> {
    let views: Vec<View<'_>> = tracks.iter().flat_map(Track::views).collect();
    let (mut all, counted) = (Cubes::new(), selected.counted(views.len()));
    for views in views.chunks(AT_ONCE) {
        for cubes in selected.each_counted(&counted, views, |view| of_frame(selected, view))? {
            cubes.into_iter().for_each(|(place, cube)| add(&mut all, place, cube));
        }
    }
    Ok(all)
}

impl Fused {
    fn mean_color(&self) -> [u8; 3] {
        self.color.map(|v| (v / f64::from(self.pixels)).round() as u8)
    }
}

/// Adds the points of another frame in a cube.
fn add(all: &mut Cubes, place: [i64; 3], cube: Fused) {
    let Some(known) = all.get_mut(&place) else {
        all.insert(place, cube);
        return;
    };
    (0..3).for_each(|c| known.color[c] += cube.color[c]);
    known.pixels += cube.pixels;
}

/// The cubes of one frame.
fn of_frame(selected: &SelectedFrames<'_>, view: View<'_>) -> Result<Cubes, ExportError> {
    let wanted = [&SHOWN[..], &[Layer::DepthMeters, Layer::NormalWorld, Layer::Semantic, Layer::SemanticInstance]].concat();
    let frame = selected.read(view, &wanted)?;
    let (distances, picture) = (distance_m(selected, view, &frame)?, tone_mapped(selected, view, &frame)?);
    let camera = view.camera();
    let mut cubes = Cubes::new();
    for (i, distance) in distances.into_iter().enumerate() {
        let (x, y) = ((i % frame.width as usize) as u32, (i / frame.width as usize) as u32);
        let ray = camera.centre_ray(f64::from(x) + 0.5, f64::from(y) + 0.5).filter(|_| distance.is_finite());
        let Some(ray) = ray else { continue };
        let position = ray.origin + ray.direction * distance;
        let [red, green, blue, _] = picture.get_pixel(x, y).0.map(f64::from);
        let cube = Fused {
            position,
            normal: frame.get(Layer::NormalWorld).map_or(DVec3::ZERO, |normals| vector(normals, i)),
            labels: [Layer::Semantic, Layer::SemanticInstance, Layer::RenderEntityId].map(|layer| label(&frame, layer, i)),
            color: [red, green, blue],
            pixels: 1,
        };
        add(&mut cubes, (position / CUBE_M).round().to_array().map(|v| v as i64), cube);
    }
    Ok(cubes)
}

fn label(frame: &Frame, layer: Layer, pixel: usize) -> i16 {
    frame.get(layer).map_or(-1, |values| values.get(pixel) as i16)
}

/// The bytes of the file.
fn ply<'c>(cubes: impl ExactSizeIterator<Item = &'c Fused>) -> Vec<u8> {
    let mut bytes = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", cubes.len()).into_bytes();
    let properties = [
        ("float", &["x", "y", "z", "nx", "ny", "nz"][..]),
        ("uchar", &["red", "green", "blue"]),
        ("short", &["semantic", "instance", "part"]),
    ];
    for (kind, names) in properties {
        names.iter().for_each(|name| bytes.extend(format!("property {kind} {name}\n").bytes()));
    }
    bytes.extend(b"end_header\n");
    for cube in cubes {
        let floats = cube.position.to_array().into_iter().chain(cube.normal.to_array());
        bytes.extend(floats.flat_map(|v| (v as f32).to_le_bytes()));
        bytes.extend(cube.mean_color());
        bytes.extend(cube.labels.iter().flat_map(|v| v.to_le_bytes()));
    }
    bytes
}
