//! BOP (Benchmark for 6D Object Pose Estimation): `train_pbr/NNNNNN/` per camera of a scene, `models/` with a mesh per instance.
//!
//! Every instance of every scene is an object of its own with one number in the whole export. Its model's axes are those of its box, with
//! the origin at the box's centre, in millimetres. Poses are model to camera with OpenCV's axes, millimetres. K is for whole-numbered
//! pixel centres, as bop_toolkit's functions use it. Depth is planar, 16-bit PNG, millimetres (`depth_scale` 1), 0 for none. Boxes are
//! `[x, y, width, height]` by `calc_2d_bbox`: width is the last column minus the first. Whole objects are counted as `calc_gt_info.py`
//! counts them: in an image three times as wide and high, which is what the stage `boxes` looks at.

use crate::ExportError;
use crate::boxes::instance_boxes;
use crate::calibration::{Calibration, row_major};
use crate::depth::{DEPTH, millimetres, planar_m};
use crate::export_folder::ExportFolder;
use crate::instances::{Instance, instances};
use crate::mesh::{SurfaceMesh, instance_meshes, missing_mesh_file};
use crate::picture::{SHOWN, color_png, grey8_png, grey16_png};
use crate::selected_frames::{SelectedFrames, Track, View};
use enfilade_dataset::{AmodalMasks, DatasetError, InstanceView, PixelArea};
use enfilade_frame::{Frame, Layer};
use enfilade_math::{DVec3, OrientedBox};
use serde::Serialize;
use std::collections::BTreeMap;

/// A BOP object.
struct Object {
    id: u32,
    shape: OrientedBox,
    mesh: Option<SurfaceMesh>,
}

#[derive(Serialize)]
struct ImageCamera {
    #[serde(rename = "cam_K")]
    k: [f64; 9],
    depth_scale: f64,
    #[serde(rename = "cam_R_w2c")]
    rotation: [f64; 9],
    #[serde(rename = "cam_t_w2c")]
    translation_mm: [f64; 3],
}

/// The camera of the whole dataset, which bop_toolkit reads before any scene.
#[derive(Serialize)]
struct DatasetCamera {
    cx: f64,
    cy: f64,
    depth_scale: f64,
    fx: f64,
    fy: f64,
    height: u32,
    width: u32,
}

#[derive(Serialize)]
struct Truth {
    #[serde(rename = "cam_R_m2c")]
    rotation: [f64; 9],
    #[serde(rename = "cam_t_m2c")]
    translation_mm: [f64; 3],
    obj_id: u32,
}

#[derive(Serialize)]
struct TruthInfo {
    bbox_obj: [i64; 4],
    bbox_visib: [i64; 4],
    px_count_all: u64,
    px_count_valid: usize,
    px_count_visib: u64,
    visib_fract: f64,
}

#[derive(Serialize)]
struct ModelInfo {
    diameter: f64,
    min_x: f64,
    min_y: f64,
    min_z: f64,
    size_x: f64,
    size_y: f64,
    size_z: f64,
}

#[derive(Serialize)]
struct ObjectEntry {
    scene: String,
    instance: i16,
    nyu40: i16,
}

#[derive(Serialize)]
struct SceneEntry {
    scene: String,
    camera: String,
}

/// Visibility of instances in a camera's frames, by frame and instance number.
type Known = BTreeMap<(u32, i16), InstanceView>;

/// An instance as if nothing hid it.
struct Whole {
    /// Pixels of the whole instance, also those beyond the image.
    area: PixelArea,
    /// 255 on those in the image, 0 elsewhere.
    mask: Vec<u8>,
}

/// Facts about one image.
type Told = (ImageCamera, Vec<(Truth, TruthInfo)>);

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    let (mut models, mut entries) = (BTreeMap::new(), BTreeMap::new());
    let mut folders = BTreeMap::new();
    let mut first_id = 1;
    for tracks in selected.scenes() {
        let scene = &tracks[0].scene;
        let objects = objects_of(selected, scene, first_id)?;
        first_id += objects.len() as u32;
        let labels = selected.labels(scene)?.parts;
        for (&instance, object) in &objects {
            models.insert(object.id, write_model(out, object)?);
            let nyu40 = labels.iter().find(|label| label.instance == instance).map_or(-1, |label| label.semantic);
            entries.insert(object.id, ObjectEntry { scene: scene.clone(), instance, nyu40 });
        }
        for track in tracks {
            let folder = format!("train_pbr/{:06}", folders.len());
            write_track(selected, out, track, &folder, &objects)?;
            folders.insert(folders.len(), SceneEntry { scene: scene.clone(), camera: track.name.clone() });
        }
    }
    out.write_json("camera.json", &dataset_camera(&Calibration::of_pinhole(selected, &selected.tracks[0])?))?;
    out.write_json("models/models_info.json", &models)?;
    out.write_json("objects.json", &entries)?;
    out.write_json("scenes.json", &folders)
}

fn dataset_camera(calibration: &Calibration) -> DatasetCamera {
    let k = calibration.intrinsics;
    let [[fx, _, cx], [_, fy, cy], _] = k.opencv_k();
    DatasetCamera { cx, cy, depth_scale: 1.0, fx, fy, height: k.height, width: k.width }
}

/// The objects of a scene by instance number, numbered from `first_id`.
fn objects_of(selected: &SelectedFrames<'_>, scene: &str, first_id: u32) -> Result<BTreeMap<i16, Object>, ExportError> {
    let mut meshes = instance_meshes(selected.dataset, scene)?;
    let boxes = instance_boxes(selected.dataset, scene, &meshes)?;
    if boxes.is_empty() {
        return Err(selected.unsuitable(scene, without_objects(selected, scene)));
    }
    let object = |(id, (number, shape))| (number, Object { id, shape, mesh: meshes.remove(&number) });
    Ok((first_id..).zip(boxes).map(object).collect())
}

/// Why a scene has no objects, and what to do.
fn without_objects(selected: &SelectedFrames<'_>, scene: &str) -> String {
    let (problem, remedy) = match missing_mesh_file(selected.dataset, scene) {
        Some(file) if !file.contains("_objects_") => {
            (format!("it has neither box files nor a mesh ({file} is missing in _detail/mesh)"), "add one of them")
        }
        _ => ("no part of it is labelled as an instance".to_string(), "label it"),
    };
    format!("{problem}, so poses of objects are not known; {remedy}, or leave it out")
}

fn write_track(
    selected: &SelectedFrames<'_>,
    out: &ExportFolder,
    track: &Track,
    folder: &str,
    objects: &BTreeMap<i16, Object>,
) -> Result<(), ExportError> {
    let calibration = Calibration::of_pinhole(selected, track)?;
    let known = known_instances(selected, track)?;
    let views: Vec<View<'_>> = track.views().collect();
    let told = selected.each_of(&views, |view| write_frame(selected, out, view, folder, &calibration, objects, &known))?;
    let (mut cameras, mut truths, mut infos) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
    for (view, (camera, seen)) in views.iter().zip(told) {
        let (truth, info): (Vec<Truth>, Vec<TruthInfo>) = seen.into_iter().unzip();
        cameras.insert(view.frame(), camera);
        truths.insert(view.frame(), truth);
        infos.insert(view.frame(), info);
    }
    out.write_json(&format!("{folder}/scene_camera.json"), &cameras)?;
    out.write_json(&format!("{folder}/scene_gt.json"), &truths)?;
    out.write_json(&format!("{folder}/scene_gt_info.json"), &infos)
}

/// Results of the stage `boxes`; empty for Hypersim's own data.
fn known_instances(selected: &SelectedFrames<'_>, track: &Track) -> Result<Known, ExportError> {
    let views = match selected.dataset.read_instance_views(&track.scene, &track.name) {
        Err(error) if error.is_not_found() => Vec::new(),
        views => views?,
    };
    Ok(views.into_iter().map(|view| ((view.frame, view.instance), view)).collect())
}

fn write_frame(
    selected: &SelectedFrames<'_>,
    out: &ExportFolder,
    view: View<'_>,
    folder: &str,
    calibration: &Calibration,
    objects: &BTreeMap<i16, Object>,
    known: &Known,
) -> Result<Told, ExportError> {
    let frame = selected.read(view, &[&SHOWN[..], &DEPTH, &[Layer::SemanticInstance]].concat())?;
    let image = format!("{:06}", view.frame());
    let depth: Vec<u16> = planar_m(selected, view, calibration, &frame)?.into_iter().map(millimetres).collect();
    out.write(&format!("{folder}/rgb/{image}.png"), &color_png(selected, view, &frame)?)?;
    out.write(&format!("{folder}/depth/{image}.png"), &grey16_png(frame.width, frame.height, &depth))?;
    let (rotation, translation) = calibration.opencv_from_world(view);
    let k = calibration.intrinsics.opencv_k().concat();
    let camera = ImageCamera {
        k: std::array::from_fn(|i| k[i]),
        depth_scale: 1.0,
        rotation: row_major(rotation),
        translation_mm: in_millimetres(translation),
    };
    let masks = selected.dataset.read_amodal_masks(&view.track.scene, &view.track.name, view.frame())?.unwrap_or_default();
    let mut seen = Vec::new();
    for instance in instances(&frame) {
        let Some(object) = objects.get(&instance.number) else { continue };
        let whole = whole(selected, view, &frame, &instance, known, &masks)?;
        for (kind, mask) in [("mask", &whole.mask), ("mask_visib", &instance.mask(&frame))] {
            out.write(&format!("{folder}/{kind}/{image}_{:06}.png", seen.len()), &grey8_png(frame.width, frame.height, mask))?;
        }
        let truth = Truth {
            rotation: row_major(rotation * object.shape.world_from_box),
            translation_mm: in_millimetres(rotation * object.shape.center + translation),
            obj_id: object.id,
        };
        seen.push((truth, info(visible_area(&frame, &instance), &whole, &depth)));
    }
    Ok((camera, seen))
}

fn visible_area(frame: &Frame, instance: &Instance) -> PixelArea {
    let [x_min, y_min, x_max, y_max] = instance.extent(frame.width).map(|place| place as i32);
    PixelArea { pixels: instance.pixels.len() as u64, bounds: [x_min, y_min, x_max + 1, y_max + 1] }
}

/// The whole of an instance that the frame shows; the visible part where no more is known of this frame. Labels that were made again since
/// are noticed by what is visible.
fn whole(
    selected: &SelectedFrames<'_>,
    view: View<'_>,
    frame: &Frame,
    instance: &Instance,
    known: &Known,
    masks: &AmodalMasks,
) -> Result<Whole, ExportError> {
    let (number, visible) = (instance.number, visible_area(frame, instance));
    let found = known.get(&(view.frame(), number)).filter(|found| found.visible == visible && masks.size == [frame.height, frame.width]);
    let mask = masks.instances.iter().find(|mask| mask.semantic_instance_id == number);
    let (Some(found), Some(mask)) = (found, mask) else { return Ok(Whole { area: visible, mask: instance.mask(frame) }) };
    let damaged = || DatasetError::Text {
        path: selected.dataset.layout().amodal_masks(&view.track.scene, &view.track.name, view.frame()),
        problem: format!(
            "the runs of instance {number} do not fill the {}x{} pixels of the image; delete it and run the boxes stage again",
            frame.width, frame.height
        ),
    };
    Ok(Whole { area: found.full, mask: of_runs(&mask.counts, masks.size).ok_or_else(damaged)? })
}

/// The mask of runs outside and inside by turns, which go down the columns; `None` when they do not fill it.
fn of_runs(runs: &[u32], [height, width]: [u32; 2]) -> Option<Vec<u8>> {
    let [height, width] = [height as usize, width as usize];
    let mut mask = vec![0; height * width];
    let mut end = 0;
    for (i, &run) in runs.iter().enumerate() {
        let begin = end;
        end += run as usize;
        if end > mask.len() {
            return None;
        }
        if i % 2 == 1 {
            (begin..end).for_each(|place| mask[place % height * width + place / height] = 255);
        }
    }
    (end == mask.len()).then_some(mask)
}

fn info(visible: PixelArea, whole: &Whole, depth: &[u16]) -> TruthInfo {
    let all = whole.area.pixels;
    TruthInfo {
        bbox_obj: bbox(whole.area),
        bbox_visib: bbox(visible),
        px_count_all: all,
        px_count_valid: whole.mask.iter().zip(depth).filter(|&(&mask, &depth)| mask > 0 && depth > 0).count(),
        px_count_visib: visible.pixels,
        visib_fract: visible.pixels as f64 / all.max(1) as f64,
    }
}

fn bbox(area: PixelArea) -> [i64; 4] {
    let [left, upper, right, lower] = area.bounds.map(i64::from);
    [left, upper, right - 1 - left, lower - 1 - upper]
}

/// Writes the object's mesh, if it is known, and returns its size.
fn write_model(out: &ExportFolder, object: &Object) -> Result<ModelInfo, ExportError> {
    let half = 0.5 * object.shape.extents;
    let mut model = (vec![-half, half], -half, half);
    if let Some(mesh) = &object.mesh {
        let vertices: Vec<DVec3> = mesh.vertices.iter().map(|&v| object.shape.local(v)).collect();
        out.write(&format!("models/obj_{:06}.ply", object.id), &ply(&vertices, &mesh.faces))?;
        let (min, max) = vertices.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), &v| (a.min(v), b.max(v)));
        model = (vertices, min, max);
    }
    let (vertices, min, max) = model;
    let [min_x, min_y, min_z] = in_millimetres(min);
    let [size_x, size_y, size_z] = in_millimetres(max - min);
    Ok(ModelInfo { diameter: 1000.0 * diameter(vertices), min_x, min_y, min_z, size_x, size_y, size_z })
}

/// The largest distance between two of the points, which are around the origin.
///
/// Points are taken from the outermost inward, so that pairs too near the origin to matter are never looked at.
fn diameter(mut points: Vec<DVec3>) -> f64 {
    points.sort_by(|a, b| b.length().total_cmp(&a.length()));
    let mut largest = 0.0;
    for (i, a) in points.iter().enumerate() {
        for b in &points[..i] {
            if a.length() + b.length() <= largest {
                break;
            }
            largest = a.distance(*b).max(largest);
        }
    }
    largest
}

fn in_millimetres(v: DVec3) -> [f64; 3] {
    (v * 1000.0).to_array().map(|x| x + 0.0)
}

/// The bytes of a text PLY file in millimetres, with the properties that bop_toolkit reads.
fn ply(vertices_m: &[DVec3], faces: &[[u32; 3]]) -> Vec<u8> {
    let mut text = format!("ply\nformat ascii 1.0\nelement vertex {}\n", vertices_m.len());
    text.extend("xyz".chars().map(|axis| format!("property float {axis}\n")));
    text.push_str(&format!("element face {}\nproperty list uchar int vertex_indices\nend_header\n", faces.len()));
    text.extend(vertices_m.iter().map(|&v| in_millimetres(v)).map(|[x, y, z]| format!("{} {} {}\n", x as f32, y as f32, z as f32)));
    text.extend(faces.iter().map(|[a, b, c]| format!("3 {a} {b} {c}\n")));
    text.into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_become_a_mask_only_when_they_fill_it() {
        // 3 columns, 2 rows.
        assert_eq!(of_runs(&[0, 2, 3, 1], [2, 3]).unwrap(), [255, 0, 0, 255, 0, 255]);
        for damaged in [&[0, 2, 3][..], &[0, 2, 3, 2], &[u32::MAX, u32::MAX], &[]] {
            assert_eq!(of_runs(damaged, [2, 3]), None, "{damaged:?}");
        }
    }

    #[test]
    fn the_diameter_is_that_of_brute_force() {
        let wave = |i: usize| DVec3::new((i as f64 * 1.7).sin(), 0.4 * (i as f64 * 0.9).cos(), 0.2 * (i as f64 * 2.3).sin());
        let points: Vec<DVec3> = (0..200).map(wave).collect();
        let pairs = points.iter().flat_map(|a| points.iter().map(|b| a.distance(*b)));
        assert_eq!(diameter(points.clone()), pairs.fold(0.0, f64::max));
    }
}
