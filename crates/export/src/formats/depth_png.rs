//! Depth as 16-bit PNG in millimetres, and `cameras.json` with what is needed to make points of it.
//!
//! Depth is planar for cameras with a K and an image plane, and the distance along the ray for fisheyes, panoramas and grids of rays;
//! `depth` in `cameras.json` states which. 0 is "no depth".

use crate::ExportError;
use crate::calibration::{Calibration, Distortion};
use crate::depth::{DEPTH, distance_m, millimetres, planar_m};
use crate::export_folder::ExportFolder;
use crate::picture::grey16_png;
use crate::selected_frames::{SelectedFrames, Track, View};
use serde::Serialize;

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

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    selected.each(|view| {
        let frame = selected.read(view, &DEPTH)?;
        let depth = match planar(view.track) {
            Some(calibration) => planar_m(selected, view, &calibration, &frame)?,
            None => distance_m(selected, view, &frame)?,
        };
        let values: Vec<u16> = depth.into_iter().map(millimetres).collect();
        out.write(&format!("{}/{}", view.track.folder(), file_name(view)), &grey16_png(frame.width, frame.height, &values))
    })?;
    selected.tracks.iter().try_for_each(|track| out.write_json(&format!("{}/cameras.json", track.folder()), &cameras(track)))
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
