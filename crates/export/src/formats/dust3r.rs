//! Pairs for DUSt3R and MASt3R (Wang et al. 2024, Leroy et al. 2024), in the layout of ScanNet++ that their class `ScanNetpp`
//! reads: `all_metadata.npz` with `<scene>/images/` and `<scene>/depth/`.
//!
//! Frames of all cameras of a scene are in one folder as `<camera>_<IIII>`. Poses are camera to world with OpenCV's axes, metres; K counts
//! from pixel centres. Depth is planar, 16-bit PNG, millimetres, 0 for none. The pairs are those of the dataset's `pairs.csv`.

use crate::ExportError;
use crate::calibration::Calibration;
use crate::depth::{DEPTH, planar_m, whole_units};
use crate::export_folder::ExportFolder;
use crate::picture::{SHOWN, color_jpeg, grey16_png};
use crate::selected_frames::{SelectedFrames, View};
use enfilade_dataset::{FramePair, NpyArray, counted, npz, read_pairs};
use enfilade_scene::Warning;
use std::collections::HashMap;

/// Units of depth pictures per metre.
const PER_METRE: f64 = 1000.0;

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    selected.each(|view| write_frame(selected, out, view))?;
    let views: Vec<View<'_>> = selected.tracks.iter().flat_map(|track| track.views()).collect();
    let mut scenes: Vec<String> = views.iter().map(|view| view.track.scene.clone()).collect();
    scenes.dedup();
    let scene_of = |view: &View<'_>| scenes.iter().position(|scene| *scene == view.track.scene).unwrap_or_default() as i64;
    let (mut intrinsics, mut trajectories) = (Vec::new(), Vec::new());
    for &view in &views {
        let calibration = Calibration::of_upright_pinhole(selected, view.track)?;
        intrinsics.extend(calibration.intrinsics.opencv_k().as_flattened().iter().flat_map(|v| (*v as f32).to_le_bytes()));
        trajectories.extend(calibration.opencv_pose(view).as_flattened().iter().flat_map(|v| (*v as f32).to_le_bytes()));
    }
    let pairs = pairs(selected, &views)?;
    let (n, images) = (views.len(), views.iter().map(View::file_stem).collect::<Vec<_>>());
    let arrays = [
        texts("scenes", &scenes),
        NpyArray::new("sceneids", "<i8", &[n], views.iter().flat_map(|view| scene_of(view).to_le_bytes()).collect()),
        texts("images", &images),
        NpyArray::new("intrinsics", "<f4", &[n, 3, 3], intrinsics),
        NpyArray::new("trajectories", "<f4", &[n, 4, 4], trajectories),
        NpyArray::new("pairs", "<i8", &[pairs.len(), 2], pairs.iter().flatten().flat_map(|place| (*place as i64).to_le_bytes()).collect()),
    ];
    out.write("all_metadata.npz", &npz(&arrays).expect("writing to memory cannot fail"))
}

fn write_frame(selected: &SelectedFrames<'_>, out: &ExportFolder, view: View<'_>) -> Result<(), ExportError> {
    let calibration = Calibration::of_upright_pinhole(selected, view.track)?;
    let frame = selected.read(view, &[&SHOWN[..], &DEPTH].concat())?;
    let depth: Vec<u16> =
        planar_m(selected, view, &calibration, &frame)?.into_iter().map(|metres| whole_units(metres, PER_METRE)).collect();
    let (scene, name) = (&view.track.scene, view.file_stem());
    out.write(&format!("{scene}/images/{name}.jpg"), &color_jpeg(selected, view, &frame)?)?;
    out.write(&format!("{scene}/depth/{name}.png"), &grey16_png(frame.width, frame.height, &depth))
}

/// The indices of both views of each pair that is listed and exported. If there is no list, every frame is paired with the next one of its
/// camera, with a warning.
fn pairs(selected: &SelectedFrames<'_>, views: &[View<'_>]) -> Result<Vec<[usize; 2]>, ExportError> {
    let key = |view: &View<'_>| (view.track.scene.clone(), view.track.name.clone(), view.frame());
    let places: HashMap<_, usize> = views.iter().map(key).zip(0..).collect();
    let list = selected.dataset.layout().pairs();
    if list.is_file() {
        let place = |scene: &str, (camera, frame): &(String, u32)| places.get(&(scene.to_string(), camera.clone(), *frame)).copied();
        let both = |pair: &FramePair| Some([place(&pair.scene, &pair.first)?, place(&pair.scene, &pair.second)?]);
        let listed = read_pairs(&list)?;
        let found: Vec<[usize; 2]> = listed.iter().filter_map(both).collect();
        let left_out = listed.len() - found.len();
        if left_out > 0 {
            let message = format!("{} of {} are of frames that are not exported, and left out", left_out, counted(listed.len(), "pair"));
            selected.warn(Warning { place: list.display().to_string(), message });
        }
        return Ok(found);
    }
    let message = "no pairs.csv, so every frame is paired with the next one of its camera; `enfilade make OUT pairs --overlap 0.2..0.7` chooses better \
                   ones";
    selected.warn(Warning { place: list.display().to_string(), message: message.into() });
    let of_one_camera = |pair: &[View<'_>]| pair[0].track.scene == pair[1].track.scene && pair[0].track.name == pair[1].track.name;
    Ok(views.windows(2).zip(0..).filter(|(pair, _)| of_one_camera(pair)).map(|(_, place)| [place, place + 1]).collect())
}

/// Texts as numpy has them: UCS-4, all as long as the longest, filled up with zeros.
fn texts(name: &'static str, texts: &[String]) -> NpyArray {
    let width = texts.iter().map(|text| text.chars().count()).max().unwrap_or(1).max(1);
    let characters = |text: &String| {
        let mut codes: Vec<u32> = text.chars().map(u32::from).collect();
        codes.resize(width, 0);
        codes
    };
    let bytes = texts.iter().flat_map(characters).flat_map(u32::to_le_bytes).collect();
    NpyArray::new(name, format!("<U{width}"), &[texts.len()], bytes)
}
