//! Replica as NICE-SLAM prepared it (Zhu et al. 2022): `<scene>_<camera>/results/{frame,depth}NNNNNN`, `traj.txt`, and `cam_params.json`.
//!
//! Files are numbered without gaps from 0. Depth is planar, 16-bit PNG, 6553.5 to the metre, so up to 10 m; 0 for none and beyond. A line of
//! `traj.txt` has the 16 numbers of camera to world row by row, with OpenCV's axes, metres.

use crate::ExportError;
use crate::calibration::Calibration;
use crate::depth::{DEPTH, planar_m, whole_units};
use crate::export_folder::ExportFolder;
use crate::picture::{SHOWN, color_jpeg, grey16_png};
use crate::selected_frames::{SelectedFrames, Track, View};
use serde_json::json;

/// Units of depth pictures per metre.
const PER_METRE: f64 = 6553.5;

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    for track in &selected.tracks {
        let calibration = Calibration::of_upright_pinhole(selected, track)?;
        let line =
            |view: View<'_>| calibration.opencv_pose(view).as_flattened().iter().map(f64::to_string).collect::<Vec<_>>().join(" ") + "\n";
        out.write(&format!("{}/traj.txt", folder(track)), track.views().map(line).collect::<String>().as_bytes())?;
        let k = calibration.intrinsics;
        let [[fx, _, cx], [_, fy, cy], _] = k.opencv_k();
        let camera = json!({ "camera": { "w": k.width, "h": k.height, "fx": fx, "fy": fy, "cx": cx, "cy": cy, "scale": PER_METRE } });
        out.write(&format!("{}/cam_params.json", folder(track)), format!("{camera:#}\n").as_bytes())?;
    }
    selected.each(|view| write_frame(selected, out, view))?;
    Ok(())
}

fn folder(track: &Track) -> String {
    format!("{}_{}", track.scene, track.name)
}

fn write_frame(selected: &SelectedFrames<'_>, out: &ExportFolder, view: View<'_>) -> Result<(), ExportError> {
    let number = view.track.chosen.iter().position(|&index| index == view.index).unwrap_or_default();
    let folder = format!("{}/results", folder(view.track));
    let k = Calibration::of_upright_pinhole(selected, view.track)?;
    let frame = selected.read(view, &[&SHOWN[..], &DEPTH].concat())?;
    let depth: Vec<u16> = planar_m(selected, view, &k, &frame)?.into_iter().map(|metres| whole_units(metres, PER_METRE)).collect();
    out.write(&format!("{folder}/depth{number:06}.png"), &grey16_png(frame.width, frame.height, &depth))?;
    out.write(&format!("{folder}/frame{number:06}.jpg"), &color_jpeg(selected, view, &frame)?)
}
