//! TUM RGB-D sequences (Sturm et al. 2012): `<scene>_<camera>/{rgb,depth}/<time>.png` with `rgb.txt`, `depth.txt` and `groundtruth.txt`.
//!
//! Depth is planar, 16-bit PNG, 5000 to the metre, 0 for none and from 13.107 m on. A line of `groundtruth.txt` is `time tx ty tz qx qy qz
//! qw`: camera centre in metres, and the rotation from OpenCV's camera axes to the world. Times are seconds with ten digits and six decimals,
//! as in its own files, so that names in order of text are in order of time; frame 0 is at EuRoC's [`START_S`].

use super::euroc::START_S;
use crate::ExportError;
use crate::calibration::Calibration;
use crate::depth::{DEPTH, planar_m, whole_units};
use crate::export_folder::ExportFolder;
use crate::picture::{SHOWN, color_png, grey16_png};
use crate::selected_frames::{SelectedFrames, Track, View};
use enfilade_math::DQuat;
use std::fmt::Write;

/// Units of depth pictures per metre.
const PER_METRE: f64 = 5000.0;

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    for track in &selected.tracks {
        let k = Calibration::of_upright_pinhole(selected, track)?;
        let step_s = frame_time_s(selected, track)?;
        let (mut rgb, mut depth) = ("# timestamp filename\n".to_string(), "# timestamp filename\n".to_string());
        let mut truth = "# timestamp tx ty tz qx qy qz qw\n".to_string();
        for view in track.views() {
            let time = time(view, step_s);
            let _ = writeln!(rgb, "{time} rgb/{time}.png");
            let _ = writeln!(depth, "{time} depth/{time}.png");
            let p = view.pose().position;
            let q = DQuat::from_mat3(&k.world_from_opencv(view)).normalize();
            let _ = writeln!(truth, "{time} {} {} {} {} {} {} {}", p.x, p.y, p.z, q.x, q.y, q.z, q.w);
        }
        let [[fx, _, cx], [_, fy, cy], _] = k.intrinsics.opencv_k();
        let calibration = format!(
            "# fx fy cx cy width height depth_units_per_metre\n{fx} {fy} {cx} {cy} {} {} {PER_METRE}\n",
            k.intrinsics.width, k.intrinsics.height
        );
        for (name, text) in [("rgb", rgb), ("depth", depth), ("groundtruth", truth), ("calibration", calibration)] {
            out.write(&format!("{}/{name}.txt", folder(track)), text.as_bytes())?;
        }
    }
    selected.each(|view| write_frame(selected, out, view))?;
    Ok(())
}

fn folder(track: &Track) -> String {
    format!("{}_{}", track.scene, track.name)
}

/// Seconds between frames of a track.
fn frame_time_s(selected: &SelectedFrames<'_>, track: &Track) -> Result<f64, ExportError> {
    Ok(selected.dataset.read_frame_time(&track.scene, &track.name)?)
}

/// The time of a frame, seconds, as files are named.
fn time(view: View<'_>, step_s: f64) -> String {
    let microseconds = START_S * 1_000_000 + (f64::from(view.frame()) * step_s * 1e6).round() as u64;
    format!("{}.{:06}", microseconds / 1_000_000, microseconds % 1_000_000)
}

fn write_frame(selected: &SelectedFrames<'_>, out: &ExportFolder, view: View<'_>) -> Result<(), ExportError> {
    let (folder, time) = (folder(view.track), time(view, frame_time_s(selected, view.track)?));
    let k = Calibration::of_upright_pinhole(selected, view.track)?;
    let frame = selected.read(view, &[&SHOWN[..], &DEPTH].concat())?;
    let depth: Vec<u16> = planar_m(selected, view, &k, &frame)?.into_iter().map(|metres| whole_units(metres, PER_METRE)).collect();
    out.write(&format!("{folder}/depth/{time}.png"), &grey16_png(frame.width, frame.height, &depth))?;
    out.write(&format!("{folder}/rgb/{time}.png"), &color_png(selected, view, &frame)?)
}
