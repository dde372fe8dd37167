//! MoGe's layout (Wang et al. 2025, microsoft/MoGe at 0744441: `docs/train.md`, `moge/utils/io.py`): a folder per frame with `image.jpg`,
//! `depth.png` and `meta.json`, and lists of the folders.
//!
//! Depth is planar, metres, 16-bit PNG by logarithm: v from 1 to 65534 is near^(1 − d) far^d with d = (v − 1) / 65533, `near` and `far` in the
//! PNG's text; 0 is unknown and 65535 infinite, which is where nothing was hit. `intrinsics` is K over the image's width and height, counted
//! from its corner.

use super::huggingface::sides;
use crate::ExportError;
use crate::calibration::Calibration;
use crate::depth::{DEPTH, planar_m};
use crate::export_folder::ExportFolder;
use crate::picture::{SHOWN, color_jpeg, grey16_png_with_text};
use crate::selected_frames::{SelectedFrames, View};
use enfilade_frame::{Frame, Layer};
use serde::Serialize;

/// Marks of pixels, and the greatest value of a depth.
const UNKNOWN: u16 = 0;
const INFINITE: u16 = u16::MAX;
const STEPS: f64 = 65533.0;

/// The least `near`, and the least and the greatest `far` over `near`, as its own writer has them.
const LEAST_NEAR: f32 = 1e-5;
const LEAST_RANGE: f32 = 1.1;
const GREATEST_RANGE: f32 = 1e5;

#[derive(Serialize)]
struct Meta {
    intrinsics: [[f64; 3]; 3],
}

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    selected.each(|view| write_frame(selected, out, view))?;
    let list = |views: &mut dyn Iterator<Item = View<'_>>| views.map(|view| folder(view) + "\n").collect::<String>();
    out.write(".index.txt", list(&mut selected.views()).as_bytes())?;
    let sides = sides(selected)?;
    if sides.len() > 1 {
        for (side, views) in sides {
            out.write(&format!(".{}.txt", side.name()), list(&mut views.into_iter()).as_bytes())?;
        }
    }
    Ok(())
}

fn folder(view: View<'_>) -> String {
    format!("{}/{}", view.track.scene, view.file_stem())
}

fn write_frame(selected: &SelectedFrames<'_>, out: &ExportFolder, view: View<'_>) -> Result<(), ExportError> {
    let calibration = Calibration::of_upright_pinhole(selected, view.track)?;
    let frame = selected.read(view, &[&SHOWN[..], &DEPTH].concat())?;
    let depth = planar_m(selected, view, &calibration, &frame)?;
    let (near, far, values) = by_logarithm(&depth, &nothing_hit(&frame));
    let text = [("near", near.to_string()), ("far", far.to_string())];
    let [width, height] = [frame.width, frame.height].map(f64::from);
    let k = calibration.intrinsics;
    let intrinsics = [[k.fx / width, 0.0, k.cx / width], [0.0, k.fy / height, k.cy / height], [0.0, 0.0, 1.0]];
    let folder = folder(view);
    out.write(&format!("{folder}/image.jpg"), &color_jpeg(selected, view, &frame)?)?;
    out.write(&format!("{folder}/depth.png"), &grey16_png_with_text(frame.width, frame.height, &values, &text))?;
    out.write_json(&format!("{folder}/meta.json"), &Meta { intrinsics })
}

/// Pixels in which the camera sees nothing but the surroundings.
fn nothing_hit(frame: &Frame) -> Vec<bool> {
    let part = frame.get(Layer::RenderEntityId);
    (0..frame.pixels()).map(|i| part.is_some_and(|part| part.get(i) < 0.0)).collect()
}

/// `near`, `far` and the values of a depth picture.
fn by_logarithm(depth_m: &[f64], infinite: &[bool]) -> (f32, f32, Vec<u16>) {
    let is_depth = |m: &f64| m.is_finite() && *m > 0.0;
    let known = depth_m.iter().copied().filter(is_depth);
    let (least, most) = known.fold((f32::INFINITY, 0.0f32), |(least, most), m| (least.min(m as f32), most.max(m as f32)));
    // A picture of nothing but surroundings has any range.
    let near = if most > 0.0 { least.max(LEAST_NEAR) } else { 1.0 };
    let far = (near * LEAST_RANGE).max(most.min(near * GREATEST_RANGE));
    let value = |(m, infinite): (&f64, &bool)| match is_depth(m) {
        true => {
            let d = (m.clamp(f64::from(near), f64::from(far)) / f64::from(near)).ln() / (f64::from(far) / f64::from(near)).ln();
            1 + (d.clamp(0.0, 1.0) * STEPS).round() as u16
        }
        false if *infinite || *m == f64::INFINITY => INFINITE,
        false => UNKNOWN,
    };
    (near, far, depth_m.iter().zip(infinite).map(value).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The result of `read_depth` in moge/utils/io.py.
    fn read(near: f32, far: f32, value: u16) -> f64 {
        let d = (f64::from(value) - 1.0) / 65533.0;
        f64::from(near).powf(1.0 - d) * f64::from(far).powf(d)
    }

    #[test]
    fn depths_come_back_to_a_step_of_the_logarithm_and_marks_stay_marks() {
        let depth = [0.5, 0.7, 3.25, 19.0, f64::NAN, f64::NAN, 40.0];
        let (near, far, values) = by_logarithm(&depth, &[false, false, false, false, true, false, false]);
        assert_eq!((near, far, values[0], values[6]), (0.5, 40.0, 1, 65534));
        assert_eq!(values[4..6], [65535, 0]);
        for i in [0, 1, 2, 3, 6] {
            // Half a step of the 65533 from 0.5 to 40.
            assert!((read(near, far, values[i]) / depth[i] - 1.0).abs() < 0.5 * (40f64 / 0.5).ln() / 65533.0 + 1e-6);
        }
    }

    #[test]
    fn pictures_of_one_depth_or_of_none_have_a_range() {
        assert_eq!(by_logarithm(&[2.0, 2.0], &[false; 2]), (2.0, 2.2, vec![1, 1]));
        let (near, far, values) = by_logarithm(&[f64::NAN, f64::NAN], &[true, false]);
        assert!(near > 0.0 && far > near && values == [65535, 0]);
        let (near, far, _) = by_logarithm(&[1e-7, 1e9], &[false; 2]);
        assert_eq!((near, far), (1e-5, 1.0));
    }
}
