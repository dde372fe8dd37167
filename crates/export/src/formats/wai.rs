//! WAI, the layout of MapAnything's data (Keetha et al. 2025): `<scene>/scene_meta.json` with `images/`, `depth/` and `covisibility/`.
//!
//! Frames of all cameras of a scene are in one folder as `<camera>_<IIII>`. Poses are camera to world with OpenCV's axes, metres; K counts
//! from pixel centres. Depth is planar, float32 OpenEXR, metres, 0 for none. The matrix of covisibility is the dataset's, where it has one.

use crate::ExportError;
use crate::calibration::Calibration;
use crate::depth::{DEPTH, planar_m};
use crate::export_folder::ExportFolder;
use crate::formats::openexr::grey_exr;
use crate::numpy::npy;
use crate::picture::{SHOWN, color_png};
use crate::selected_frames::{SelectedFrames, Track, View};
use enfilade_dataset::Covisibility;
use enfilade_frame::Values;
use enfilade_scene::Warning;
use serde_json::{Value, json};

/// The version of the layout.
const VERSION: &str = "0.1";

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    selected.each(|view| write_frame(selected, out, view))?;
    for tracks in selected.scenes() {
        write_scene(selected, out, tracks)?;
    }
    Ok(())
}

fn write_frame(selected: &SelectedFrames<'_>, out: &ExportFolder, view: View<'_>) -> Result<(), ExportError> {
    let calibration = Calibration::of_upright_pinhole(selected, view.track)?;
    let frame = selected.read(view, &[&SHOWN[..], &DEPTH].concat())?;
    let known = |metres: f64| if metres.is_finite() && metres > 0.0 { metres as f32 } else { 0.0 };
    let depth = planar_m(selected, view, &calibration, &frame)?.into_iter().map(known).collect();
    let (scene, name) = (&view.track.scene, view.file_stem());
    out.write(&format!("{scene}/images/{name}.png"), &color_png(selected, view, &frame)?)?;
    out.write(&format!("{scene}/depth/{name}.exr"), &grey_exr(selected, view, &frame, depth)?)
}

/// Writes the file about a scene as a whole.
fn write_scene(selected: &SelectedFrames<'_>, out: &ExportFolder, tracks: &[Track]) -> Result<(), ExportError> {
    let scene = tracks[0].scene.as_str();
    let views: Vec<View<'_>> = tracks.iter().flat_map(Track::views).collect();
    let frames = views.iter().map(|&view| described(selected, view)).collect::<Result<Vec<Value>, _>>()?;
    let mut modalities = json!({});
    if let Some(shares) = covisibility(selected, scene, &views)? {
        let n = views.len();
        let path = format!("covisibility/v0/pairwise_covisibility--{n}x{n}.npy");
        out.write(&format!("{scene}/{path}"), &npy(&Values::F32(shares), &[n, n]))?;
        modalities = json!({ "pairwise_covisibility": { "scene_key": path, "format": "mmap" } });
    }
    let meta = json!({
        "scene_name": scene,
        "dataset_name": "enfilade",
        "version": VERSION,
        "shared_intrinsics": false,
        "camera_model": "PINHOLE",
        "camera_convention": "opencv",
        "scale_type": "metric",
        "scene_modalities": modalities,
        "frames": frames,
        "frame_modalities": {
            "image": { "frame_key": "image", "format": "image" },
            "depth": { "frame_key": "depth", "format": "depth" },
        },
    });
    out.write_json(&format!("{scene}/scene_meta.json"), &meta)
}

/// An entry of the list of frames.
fn described(selected: &SelectedFrames<'_>, view: View<'_>) -> Result<Value, ExportError> {
    let calibration = Calibration::of_upright_pinhole(selected, view.track)?;
    let ([[fl_x, _, cx], [_, fl_y, cy], _], name) = (calibration.intrinsics.opencv_k(), view.file_stem());
    let (image, depth) = (format!("images/{name}.png"), format!("depth/{name}.exr"));
    Ok(json!({
        "frame_name": name,
        "file_path": image,
        "image": image,
        "depth": depth,
        "transform_matrix": calibration.opencv_pose(view),
        "fl_x": fl_x,
        "fl_y": fl_y,
        "cx": cx,
        "cy": cy,
        "w": calibration.intrinsics.width,
        "h": calibration.intrinsics.height,
    }))
}

/// Share of each view's surfaces that each other view sees, 0 if unknown; `None`, with a warning, where that was not measured.
fn covisibility(selected: &SelectedFrames<'_>, scene: &str, views: &[View<'_>]) -> Result<Option<Vec<f32>>, ExportError> {
    let found = match selected.dataset.read_covisibility(scene) {
        Err(error) if error.is_not_found() => None,
        found => Some(found?),
    };
    let place = |view: &View<'_>, of: &Covisibility| {
        of.frames.iter().position(|frame| frame.camera == view.track.name && frame.frame == view.frame())
    };
    let known = found.and_then(|of| {
        let places = views.iter().map(|view| place(view, &of)).collect::<Option<Vec<usize>>>()?;
        let share = |&row: &usize, &column: &usize| Some(of.share(row, column)).filter(|share| share.is_finite()).unwrap_or(0.0);
        Some(places.iter().flat_map(|row| places.iter().map(move |column| (row, column))).map(|(row, column)| share(row, column)).collect())
    });
    if known.is_none() {
        let message = "MapAnything's loaders choose views by covisibility, which was not measured for all of these frames: run `enfilade make OUT pairs`";
        selected.warn(Warning { place: scene.into(), message: message.into() });
    }
    Ok(known)
}
