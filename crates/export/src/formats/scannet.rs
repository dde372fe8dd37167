//! ScanNet's exported scans: `scans/<scene>_<camera>/{color,depth,pose,intrinsic,label-filt,instance-filt}`.
//!
//! Depth is planar, 16-bit PNG in millimetres, 0 for none. `pose/N.txt` is camera to world with OpenCV's axes, metres. `intrinsic/` has K
//! for whole-numbered pixel centres in 4 × 4 matrices; colour and depth are one camera, so both are the same and the extrinsics are
//! the identity. Labels are NYU40 numbers; in ScanNet's own files they are numbers of its raw vocabulary.

use crate::ExportError;
use crate::calibration::Calibration;
use crate::depth::{DEPTH, millimetres, planar_m};
use crate::picture::{SHOWN, color_jpeg, grey8_png, grey16_png};
use crate::place::Place;
use crate::source::{Source, Track, View};
use enfilade_frame::{Frame, Layer, Values};
use std::fmt::Write;

pub(crate) const README: &str = "\
# ScanNet

`scans/<scene>_<camera>/` looks like an exported ScanNet scan; N is the frame number.

- `color/N.jpg`: tone-mapped colour. `depth/N.png`: planar depth, 16 bits, millimetres, 0 is none.
- `pose/N.txt`: camera to world, 4 x 4; camera x right, y down, z forward; metres; the world is right-handed with z up.
- `intrinsic/`: 4 x 4 matrices, pixel centres at whole numbers. Colour and depth are of one camera: extrinsics are the identity.
- `label-filt/N.png`: 16 bits, NYU40 class (ScanNet's own files have numbers of its raw vocabulary), 0 is none.
- `instance-filt/N.png`: instance number within the scene, 0 is none; 8 bits as ScanNet's, or 16 where a number is above 255.
- `<scan>.txt`: sizes and focal lengths as ScanNet's. A layer that the dataset lacks has no folder.
";

pub(crate) fn write(source: &Source<'_>, place: &Place) -> Result<(), ExportError> {
    for track in &source.tracks {
        let k = Calibration::of_pinhole(source, track)?;
        let folder = folder(track);
        let intrinsic = matrix(&four_by_four(k.intrinsics.opencv_k()));
        let identity = matrix(&four_by_four([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]));
        for what in ["color", "depth"] {
            place.write(&format!("{folder}/intrinsic/intrinsic_{what}.txt"), intrinsic.as_bytes())?;
            place.write(&format!("{folder}/intrinsic/extrinsic_{what}.txt"), identity.as_bytes())?;
        }
        place.write(&format!("{folder}/{}.txt", scan(track)), about(track, &k).as_bytes())?;
    }
    source.each(|view| write_frame(source, place, view))?;
    Ok(())
}

fn scan(track: &Track) -> String {
    format!("{}_{}", track.scene, track.name)
}

fn folder(track: &Track) -> String {
    format!("scans/{}", scan(track))
}

fn write_frame(source: &Source<'_>, place: &Place, view: View<'_>) -> Result<(), ExportError> {
    let (folder, n) = (folder(view.track), view.frame());
    let k = Calibration::of_pinhole(source, view.track)?;
    let frame = source.read(view, &[&SHOWN[..], &DEPTH, &[Layer::Semantic, Layer::SemanticInstance]].concat())?;
    place.write(&format!("{folder}/pose/{n}.txt"), matrix(&k.opencv_pose(view)).as_bytes())?;
    let depth: Vec<u16> = planar_m(source, view, &k, &frame)?.into_iter().map(millimetres).collect();
    place.write(&format!("{folder}/depth/{n}.png"), &grey16_png(frame.width, frame.height, &depth))?;
    if frame.get(Layer::Color).is_some() {
        place.write(&format!("{folder}/color/{n}.jpg"), &color_jpeg(source, view, &frame)?)?;
    }
    if let Some(semantic) = frame.get(Layer::Semantic) {
        place.write(&format!("{folder}/label-filt/{n}.png"), &grey16_png(frame.width, frame.height, &numbers(semantic)))?;
    }
    if let Some(instance) = frame.get(Layer::SemanticInstance) {
        place.write(&format!("{folder}/instance-filt/{n}.png"), &instance_png(&frame, &numbers(instance)))?;
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
