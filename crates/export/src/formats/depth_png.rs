//! Depth as 16-bit PNG in millimetres, and `cameras.json` with what is needed to make points of it.
//!
//! Depth is planar for cameras with a K and an image plane, and the distance along the ray for fisheyes, panoramas and grids of rays;
//! `depth` in `cameras.json` says which. 0 is "no depth".

use crate::ExportError;
use crate::calibration::{Calibration, Distortion};
use crate::depth::{DEPTH, distance_m, millimetres, planar_m};
use crate::picture::grey16_png;
use crate::place::Place;
use crate::source::{Source, Track, View};
use serde::Serialize;

pub(crate) const README: &str = "\
# Depth in 16-bit PNG

`<scene>/<camera>/frame.IIII.png` is depth in whole millimetres; 0 is no depth (nothing hit, or beyond 65.535 m).
`<scene>/<camera>/cameras.json` has the camera and the pose of every frame.

- `depth` is `planar` (along the viewing axis) or `distance` (along the pixel's ray; fisheyes, panoramas and grids of rays).
- `K` is OpenCV's: pixel centres are whole numbers. `K_corner` is the same camera with pixel centres at halves. `model` and
  `distortion` are OpenCV's (`opencv`: k1 k2 p1 p2 k3 k4 k5 k6; `opencv_fisheye`: k1 k2 k3 k4).
- `world_from_camera` has axes x right, y down, z forward, and metres; the world is right-handed with z up.
- So the point of pixel (column x, row y) is world_from_camera [z (x - cx) / fx, z (y - cy) / fy, z, 1], z = value / 1000.
";

#[derive(Serialize)]
struct Cameras {
    width: u32,
    height: u32,
    depth: &'static str,
    depth_unit_m: f64,
    invalid: u16,
    model: &'static str,
    #[serde(rename = "K", skip_serializing_if = "Option::is_none")]
    k: Option<[[f64; 3]; 3]>,
    #[serde(rename = "K_corner", skip_serializing_if = "Option::is_none")]
    k_corner: Option<[[f64; 3]; 3]>,
    distortion: Vec<f64>,
    frames: Vec<FrameEntry>,
}

#[derive(Serialize)]
struct FrameEntry {
    frame: u32,
    file: String,
    world_from_camera: [[f64; 4]; 4],
}

pub(crate) fn write(source: &Source<'_>, place: &Place) -> Result<(), ExportError> {
    source.each(|view| {
        let frame = source.read(view, &DEPTH)?;
        let depth = match planar(view.track) {
            Some(calibration) => planar_m(source, view, &calibration, &frame)?,
            None => distance_m(source, view, &frame)?,
        };
        let values: Vec<u16> = depth.into_iter().map(millimetres).collect();
        place.write(&format!("{}/{}", view.track.folder(), file_name(view)), &grey16_png(frame.width, frame.height, &values))
    })?;
    source.tracks.iter().try_for_each(|track| place.write_json(&format!("{}/cameras.json", track.folder()), &cameras(track)))
}

/// The calibration of a camera whose depth is planar.
fn planar(track: &Track) -> Option<Calibration> {
    Calibration::of(track).filter(|_| track.camera.projection.has_image_plane())
}

fn file_name(view: View<'_>) -> String {
    format!("frame.{:04}.png", view.frame())
}

fn cameras(track: &Track) -> Cameras {
    let [width, height] = track.camera.size();
    let calibration = Calibration::of(track);
    let (model, distortion) = match calibration.as_ref().map(|c| &c.distortion) {
        None => ("rays", Vec::new()),
        Some(Distortion::None) => ("pinhole", Vec::new()),
        Some(Distortion::RadialTangential(d)) => ("opencv", d.to_vec()),
        Some(Distortion::Fisheye(d)) => ("opencv_fisheye", d.to_vec()),
    };
    let straight = |view: View<'_>| match &calibration {
        Some(calibration) => calibration.opencv_pose(view),
        None => Calibration::opencv_pose_of(view.pose()),
    };
    let corner = |k: [[f64; 3]; 3]| [[k[0][0], k[0][1], k[0][2] + 0.5], [k[1][0], k[1][1], k[1][2] + 0.5], k[2]];
    let k = calibration.as_ref().map(|c| c.intrinsics.opencv_k());
    Cameras {
        width,
        height,
        depth: if planar(track).is_some() { "planar" } else { "distance" },
        depth_unit_m: 0.001,
        invalid: 0,
        model,
        k,
        k_corner: k.map(corner),
        distortion,
        frames: track.views().map(|v| FrameEntry { frame: v.frame(), file: file_name(v), world_from_camera: straight(v) }).collect(),
    }
}
