//! nerfstudio: `<scene>/transforms.json`, images, depth and a point cloud, as the `nerfstudio` data parser takes them.
//!
//! `transform_matrix` is camera to world with OpenGL's axes (x right, y up, z backward), metres, the world right-handed with z up.
//! Image coordinates count from the upper left corner, so pixel centres are at half-integers, like nerfstudio's rays. Depth is planar,
//! of fisheyes the distance along the ray, 16-bit PNG in millimetres (its default unit), 0 for none. The parser takes one `camera_model`
//! per file, so the cameras of a scene must be of one model; their calibration is given per frame.

use crate::ExportError;
use crate::calibration::{Calibration, Distortion};
use crate::depth::{DEPTH, distance_m, millimetres, planar_m};
use crate::export_folder::ExportFolder;
use crate::picture::{SHOWN, color_png, grey16_png};
use crate::points::{cloud, ply};
use crate::selected_frames::{SelectedFrames, Track, View};
use serde::Serialize;

#[derive(Serialize)]
struct Transforms {
    camera_model: &'static str,
    ply_file_path: &'static str,
    frames: Vec<FrameEntry>,
}

#[derive(Serialize)]
struct FrameEntry {
    file_path: String,
    depth_file_path: String,
    fl_x: f64,
    fl_y: f64,
    cx: f64,
    cy: f64,
    w: u32,
    h: u32,
    k1: f64,
    k2: f64,
    k3: f64,
    k4: f64,
    p1: f64,
    p2: f64,
    transform_matrix: [[f64; 4]; 4],
}

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    for tracks in selected.scenes() {
        let scene = &tracks[0].scene;
        let model = model_of(selected, tracks)?;
        selected.each_of(&tracks.iter().flat_map(Track::views).collect::<Vec<_>>(), |view| write_frame(selected, out, view))?;
        let frames = tracks.iter().flat_map(Track::views).map(|view| entry(selected, view)).collect::<Result<_, _>>()?;
        out.write(&format!("{scene}/sparse_pc.ply"), &ply(&cloud(selected, tracks)?))?;
        let transforms = Transforms { camera_model: model, ply_file_path: "sparse_pc.ply", frames };
        out.write_json(&format!("{scene}/transforms.json"), &transforms)?;
    }
    Ok(())
}

/// nerfstudio's name of the model that all cameras of a scene share.
fn model_of(selected: &SelectedFrames<'_>, tracks: &[Track]) -> Result<&'static str, ExportError> {
    let name = |track: &Track| {
        let is_fisheye = matches!(calibration(selected, track)?.distortion, Distortion::Fisheye(_));
        Ok(if is_fisheye { "OPENCV_FISHEYE" } else { "OPENCV" })
    };
    let names = tracks.iter().map(name).collect::<Result<Vec<_>, ExportError>>()?;
    if names.iter().any(|&name| name != names[0]) {
        let problem = "its cameras are of different models, and the format has one for all; choose with --camera";
        return Err(selected.unsuitable(&tracks[0].scene, problem));
    }
    Ok(names[0])
}

/// The calibration of a camera that nerfstudio can have.
fn calibration(selected: &SelectedFrames<'_>, track: &Track) -> Result<Calibration, ExportError> {
    let wrong = |problem: &str| selected.unsuitable(track.folder(), format!("{problem}; leave the camera out"));
    let calibration = Calibration::of(track).ok_or_else(|| wrong("panoramas and grids of rays have no calibration here"))?;
    if calibration.intrinsics.skew != 0.0 {
        return Err(wrong("its pixels are skewed, which the format cannot say"));
    }
    match calibration.distortion {
        Distortion::RadialTangential([_, _, _, _, _, k4, k5, k6]) if [k4, k5, k6] != [0.0; 3] => {
            Err(wrong("its distortion has the coefficients k4 to k6 of OpenCV's rational model, which the format cannot say"))
        }
        _ => Ok(calibration),
    }
}

fn write_frame(selected: &SelectedFrames<'_>, out: &ExportFolder, view: View<'_>) -> Result<(), ExportError> {
    let frame = selected.read(view, &[&SHOWN[..], &DEPTH].concat())?;
    let calibration = calibration(selected, view.track)?;
    // Its rays of fisheyes have unit length, which its depth is counted in.
    let depth = match calibration.distortion {
        Distortion::Fisheye(_) => distance_m(selected, view, &frame)?,
        _ => planar_m(selected, view, &calibration, &frame)?,
    };
    let depth: Vec<u16> = depth.into_iter().map(millimetres).collect();
    let scene = &view.track.scene;
    out.write(&format!("{scene}/{}", file(view, "images")), &color_png(selected, view, &frame)?)?;
    out.write(&format!("{scene}/{}", file(view, "depth")), &grey16_png(frame.width, frame.height, &depth))
}

fn file(view: View<'_>, folder: &str) -> String {
    format!("{folder}/{}/frame.{:04}.png", view.track.name, view.frame())
}

fn entry(selected: &SelectedFrames<'_>, view: View<'_>) -> Result<FrameEntry, ExportError> {
    let calibration = calibration(selected, view.track)?;
    let k = calibration.intrinsics;
    let ([k1, k2, k3, k4], [p1, p2]) = match calibration.distortion {
        Distortion::None => ([0.0; 4], [0.0; 2]),
        Distortion::RadialTangential([k1, k2, p1, p2, k3, ..]) => ([k1, k2, k3, 0.0], [p1, p2]),
        Distortion::Fisheye(k) => (k, [0.0; 2]),
    };
    Ok(FrameEntry {
        file_path: file(view, "images"),
        depth_file_path: file(view, "depth"),
        fl_x: k.fx,
        fl_y: k.fy,
        cx: k.cx,
        cy: k.cy,
        w: k.width,
        h: k.height,
        k1,
        k2,
        k3,
        k4,
        p1,
        p2,
        transform_matrix: calibration.opengl_pose(view),
    })
}
