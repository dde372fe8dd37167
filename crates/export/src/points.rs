//! A cloud of coloured surface points of a scene, with the frames that see each: what structure from motion would give, but exact.
//!
//! Points are taken on a regular grid of pixels of every frame, at their stored distance along the pixel's ray. A frame sees a point
//! when it projects into the image and the stored distance at that pixel is the point's.

use crate::ExportError;
use crate::depth::distance_m;
use crate::picture::{SHOWN, tone_mapped};
use crate::selected_frames::{SelectedFrames, Track, View};
use enfilade_frame::Layer;
use enfilade_math::DVec3;

/// About how many points a frame gives: as many as a good photograph has features.
const POINTS_PER_FRAME: f64 = 1000.0;

/// Largest relative difference of distance at which a frame sees a point: a pixel's own size on a surface seen at a slant.
const SAME_SURFACE: f64 = 0.01;

/// A point of a surface.
pub(crate) struct CloudPoint {
    /// World, metres.
    pub position: DVec3,
    /// Colour as displayed, sRGB.
    pub color: [u8; 3],
    /// At least one.
    pub sightings: Vec<Sighting>,
}

/// A point in the image of a frame that sees it.
pub(crate) struct Sighting {
    /// Index of the frame among those of the cloud.
    pub view: usize,
    /// Image coordinates from the upper left corner of the image, pixels.
    pub at: (f64, f64),
}

/// A point in a frame: its index, and its position in the image.
type Seen = (usize, (f64, f64));

/// The cloud of some cameras' frames, in their order.
pub(crate) fn cloud(selected: &SelectedFrames<'_>, tracks: &[Track]) -> Result<Vec<CloudPoint>, ExportError> {
    let views: Vec<View<'_>> = tracks.iter().flat_map(Track::views).collect();
    let given = selected.each_of(&views, |view| points_of(selected, view))?;
    let mut points: Vec<CloudPoint> = given.into_iter().flatten().collect();
    let seen = selected.each_of(&views, |view| sightings_of(selected, view, &points))?;
    for (view, sightings) in seen.into_iter().enumerate() {
        for (point, at) in sightings {
            points[point].sightings.push(Sighting { view, at });
        }
    }
    points.retain(|point| !point.sightings.is_empty());
    Ok(points)
}

/// The points that a frame gives, row by row.
fn points_of(selected: &SelectedFrames<'_>, view: View<'_>) -> Result<Vec<CloudPoint>, ExportError> {
    let frame = selected.read(view, &[&SHOWN[..], &[Layer::DepthMeters]].concat())?;
    let distance = distance_m(selected, view, &frame)?;
    let picture = tone_mapped(selected, view, &frame)?;
    let stride = ((frame.pixels() as f64 / POINTS_PER_FRAME).sqrt().ceil() as usize).max(1);
    let camera = view.camera();
    let mut points = Vec::new();
    for y in (stride / 2..frame.height as usize).step_by(stride) {
        for x in (stride / 2..frame.width as usize).step_by(stride) {
            let distance = distance[y * frame.width as usize + x];
            let ray = camera.centre_ray(x as f64 + 0.5, y as f64 + 0.5).filter(|_| distance.is_finite());
            let Some(ray) = ray else { continue };
            let [r, g, b, _] = picture.get_pixel(x as u32, y as u32).0;
            points.push(CloudPoint { position: ray.origin + ray.direction * distance, color: [r, g, b], sightings: Vec::new() });
        }
    }
    Ok(points)
}

/// The points that a frame sees, and their image positions.
fn sightings_of(selected: &SelectedFrames<'_>, view: View<'_>, points: &[CloudPoint]) -> Result<Vec<Seen>, ExportError> {
    let frame = selected.read(view, &[Layer::DepthMeters])?;
    let distance = distance_m(selected, view, &frame)?;
    let camera = view.camera();
    let (width, height) = (f64::from(frame.width), f64::from(frame.height));
    let sees = |point: &CloudPoint| {
        let (x, y) = camera.project(point.position)?;
        if !(x >= 0.0 && x < width && y >= 0.0 && y < height) {
            return None;
        }
        let stored = distance[y as usize * frame.width as usize + x as usize];
        let own = camera.row_placement(y).0.distance(point.position);
        ((stored - own).abs() <= SAME_SURFACE * own).then_some((x, y))
    };
    Ok(points.iter().enumerate().filter_map(|(i, point)| Some((i, sees(point)?))).collect())
}

/// The bytes of a binary PLY file of the points with their colours.
pub(crate) fn ply(points: &[CloudPoint]) -> Vec<u8> {
    let mut bytes = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", points.len()).into_bytes();
    bytes.extend("xyz".chars().flat_map(|axis| format!("property float {axis}\n").into_bytes()));
    bytes.extend(["red", "green", "blue"].iter().flat_map(|color| format!("property uchar {color}\n").into_bytes()));
    bytes.extend(b"end_header\n");
    for point in points {
        bytes.extend(point.position.to_array().iter().flat_map(|&v| (v as f32).to_le_bytes()));
        bytes.extend(point.color);
    }
    bytes
}
