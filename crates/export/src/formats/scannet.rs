//! ScanNet's exported scans: `scans/<scene>_<camera>/{color,depth,pose,intrinsic,label-filt,instance-filt}`.
//!
//! Depth is planar, 16-bit PNG in millimetres, 0 for none. `pose/N.txt` is camera to world with OpenCV's axes, metres. `intrinsic/` has K
//! for whole-numbered pixel centres in 4 × 4 matrices; colour and depth are one camera, so both are the same and the extrinsics are
//! the identity. Labels are NYU40 numbers; in ScanNet's own files they are numbers of its raw vocabulary.

use crate::ExportError;
use crate::calibration::Calibration;
use crate::depth::{DEPTH, millimetres, planar_m};
use crate::export_folder::ExportFolder;
use crate::picture::{SHOWN, color_jpeg, grey8_png, grey16_png};
use crate::selected_frames::{SelectedFrames, Track, View};
use enfilade_frame::{Frame, Layer, Values};
use std::fmt::Write;

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    for track in &selected.tracks {
        let k = Calibration::of_pinhole(selected, track)?;
        let folder = folder(track);
        let intrinsic = matrix(&four_by_four(k.intrinsics.opencv_k()));
        let identity = matrix(&four_by_four([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]));
        for what in ["color", "depth"] {
            out.write(&format!("{folder}/intrinsic/intrinsic_{what}.txt"), intrinsic.as_bytes())?;
            out.write(&format!("{folder}/intrinsic/extrinsic_{what}.txt"), identity.as_bytes())?;
        }
        out.write(&format!("{folder}/{}.txt", scan(track)), about(track, &k).as_bytes())?;
    }
    selected.each(|view| write_frame(selected, out, view))?;
    Ok(())
}

fn scan(track: &Track) -> String {
    format!("{}_{}", track.scene, track.name)
}

fn folder(track: &Track) -> String {
    format!("scans/{}", scan(track))
}

fn write_frame(selected: &SelectedFrames<'_>, out: &ExportFolder, view: View<'_>) -> Result<(), ExportError> {
    let (folder, n) = (folder(view.track), view.frame());
    let k = Calibration::of_pinhole(selected, view.track)?;
    let frame = selected.read(view, &[&SHOWN[..], &DEPTH, &[Layer::Semantic, Layer::SemanticInstance]].concat())?;
    out.write(&format!("{folder}/pose/{n}.txt"), matrix(&k.opencv_pose(view)).as_bytes())?;
    let depth: Vec<u16> = planar_m(selected, view, &k, &frame)?.into_iter().map(millimetres).collect();
    out.write(&format!("{folder}/depth/{n}.png"), &grey16_png(frame.width, frame.height, &depth))?;
    if frame.get(Layer::Color).is_some() {
        out.write(&format!("{folder}/color/{n}.jpg"), &color_jpeg(selected, view, &frame)?)?;
    }
    if let Some(semantic) = frame.get(Layer::Semantic) {
        out.write(&format!("{folder}/label-filt/{n}.png"), &grey16_png(frame.width, frame.height, &numbers(semantic)))?;
    }
    if let Some(instance) = frame.get(Layer::SemanticInstance) {
        out.write(&format!("{folder}/instance-filt/{n}.png"), &instance_png(&frame, &numbers(instance)))?;
    }
    Ok(())
}

/// Labels from 1, and 0 where there is none.
fn numbers(labels: &Values) -> Vec<u16> {
    (0..labels.len()).map(|i| labels.get(i).max(0.0) as u16).collect()
}

fn instance_png(frame: &Frame, numbers: &[u16]) -> Vec<u8> {
    let bytes: Result<Vec<u8>, _> = numbers.iter().map(|&n| u8::try_from(n)).collect();
    bytes.map_or_else(|_| grey16_png(frame.width, frame.height, numbers), |bytes| grey8_png(frame.width, frame.height, &bytes))
}

/// A rotation or K in the upper left of the identity.
fn four_by_four(m: [[f64; 3]; 3]) -> [[f64; 4]; 4] {
    let row = |r: [f64; 3]| [r[0], r[1], r[2], 0.0];
    [row(m[0]), row(m[1]), row(m[2]), [0.0, 0.0, 0.0, 1.0]]
}

/// Rows of numbers with spaces between them; every number comes back exactly.
fn matrix(rows: &[[f64; 4]; 4]) -> String {
    let row = |row: &[f64; 4]| row.map(|v| v.to_string()).join(" ") + "\n";
    rows.iter().map(row).collect()
}

/// The page that ScanNet has for every scan.
fn about(track: &Track, calibration: &Calibration) -> String {
    let k = calibration.intrinsics;
    let mut text = String::new();
    for what in ["color", "depth"] {
        let [[fx, _, mx], [_, fy, my], _] = k.opencv_k();
        let _ = writeln!(text, "fx_{what} = {fx}\nfy_{what} = {fy}\nmx_{what} = {mx}\nmy_{what} = {my}");
        let _ = writeln!(text, "{what}Height = {}\n{what}Width = {}", k.height, k.width);
    }
    let _ = writeln!(text, "depthShift = 1000\nnumColorFrames = {0}\nnumDepthFrames = {0}", track.chosen.len());
    text
}
