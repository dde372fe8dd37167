//! BOP (Benchmark for 6D Object Pose Estimation): `train_pbr/NNNNNN/` per camera of a scene, `models/` with the meshes of objects.
//!
//! Where `[[object]]` placed objects, copies of a model in one size are one object, in the axes of the model's file (`placed.rs`). Elsewhere
//! every instance of every scene is an object of its own, in the axes of its box with the origin at the box's centre (`own.rs`). Objects have
//! one number in the whole export. Poses are model to camera with OpenCV's axes, millimetres. K is for whole-numbered pixel centres, as
//! bop_toolkit's functions use it. Depth is planar, 16-bit PNG, millimetres (`depth_scale` 1), 0 for none. Boxes are `[x, y, width, height]`
//! by `calc_2d_bbox`: width is the last column minus the first. Whole objects are counted as `calc_gt_info.py` counts them: in an image three
//! times as wide and high, which is what the stage `boxes` looks at.

mod coco;
mod model;
mod own;
mod placed;
mod records;
mod targets;
mod whole;

use crate::ExportError;
use crate::calibration::{Calibration, row_major};
use crate::depth::{DEPTH, millimetres, planar_m};
use crate::export_folder::ExportFolder;
use crate::instances::instances;
use crate::options::SymmetryRule;
use crate::picture::{SHOWN, color_jpeg, color_png, grey8_png, grey16_png};
use crate::selected_frames::{SelectedFrames, Track, View};
use coco::{SceneCoco, Silhouette, counted};
use enfilade_dataset::{FilmedBodies, PixelArea, Side};
use enfilade_frame::Layer;
use enfilade_math::DAffine3;
use enfilade_scene::Labels;
use model::in_millimetres;
use records::{DatasetCamera, EvaluationTarget, ImageCamera, SceneEntry, Truth, TruthInfo};
use std::collections::BTreeMap;
use targets::{Pose, Targets};
use whole::{Known, Whole, known_instances, visible_area, whole};

/// The page of exports of placed objects.
const PLACED_PAGE: &str = include_str!("../../readmes/bop_placed.md");

/// One instance in one image.
struct Seen {
    truth: Truth,
    info: TruthInfo,
    /// For `scene_gt_coco.json`.
    silhouette: Option<Silhouette>,
}

/// What is in one folder, and how.
struct Folder<'a> {
    /// `<split>/NNNNNN`
    name: String,
    targets: &'a Targets,
    /// What moves in the scene, and the labels of its parts.
    moving: Option<(FilmedBodies, Labels)>,
    calibration: Calibration,
    known: Known,
    /// Objects were placed: bop_toolkit's further files are written.
    is_placed: bool,
    /// Colour is JPEG, as bop_toolkit expects of `pbr`, and not PNG.
    is_jpeg: bool,
}

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder, rule: SymmetryRule) -> Result<(), ExportError> {
    let placed = placed::placed(selected)?;
    let targets = match &placed {
        Some(placed) => placed.write(selected, out, rule)?,
        None => own::write(selected, out)?,
    };
    let sides = selected.sides_of_scenes()?;
    let (none, mut folders) = (Targets::new(), BTreeMap::new());
    let mut to_find: BTreeMap<&str, Vec<EvaluationTarget>> = BTreeMap::new();
    for track in &selected.tracks {
        let split = placed.as_ref().map(|_| split(sides.get(&track.scene).copied()));
        let (scene_id, name) = (folders.len(), split.unwrap_or(TRAIN));
        let folder = Folder {
            name: format!("{name}/{scene_id:06}"),
            targets: targets.get(&track.scene).unwrap_or(&none),
            moving: match selected.dataset.read_filmed_bodies(&track.scene, &track.name)? {
                Some(bodies) => Some((bodies, selected.labels(&track.scene)?)),
                None => None,
            },
            calibration: Calibration::of_pinhole(selected, track)?,
            known: known_instances(selected, track)?,
            is_placed: placed.is_some(),
            is_jpeg: placed.is_some() && name == TRAIN,
        };
        let seen = write_track(selected, out, track, &folder)?;
        if let Some(placed) = &placed {
            to_find.entry(name).or_default().extend(evaluation_targets(scene_id, &seen));
            write_coco(out, track, &folder, name, placed.ids(), seen)?;
        }
        folders.insert(scene_id, SceneEntry { scene: track.scene.clone(), camera: track.name.clone(), split });
    }
    for (split, targets) in &to_find {
        out.write_json(&format!("{split}_targets_bop19.json"), targets)?;
    }
    if placed.is_some() {
        out.set_page(PLACED_PAGE);
    }
    out.write_json("camera.json", &dataset_camera(&Calibration::of_pinhole(selected, &selected.tracks[0])?))?;
    out.write_json("scenes.json", &folders)
}

const TRAIN: &str = "train_pbr";

/// The split of a side of the partition.
fn split(side: Option<Side>) -> &'static str {
    match side {
        None | Some(Side::Train) => TRAIN,
        Some(Side::Val) => "val",
        Some(Side::Test) => "test",
    }
}

fn dataset_camera(calibration: &Calibration) -> DatasetCamera {
    let k = calibration.intrinsics;
    let [[fx, _, cx], [_, fy, cy], _] = k.opencv_k();
    DatasetCamera { cx, cy, depth_scale: 1.0, fx, fy, height: k.height, width: k.width }
}

/// Writes the files of a folder; returns what each frame shows, by its number.
fn write_track(
    selected: &SelectedFrames<'_>,
    out: &ExportFolder,
    track: &Track,
    folder: &Folder<'_>,
) -> Result<BTreeMap<u32, Vec<Seen>>, ExportError> {
    let views: Vec<View<'_>> = track.views().collect();
    let told = selected.each_of(&views, |view| write_frame(selected, out, view, folder))?;
    let (mut cameras, mut all) = (BTreeMap::new(), BTreeMap::new());
    for (view, (camera, seen)) in views.iter().zip(told) {
        cameras.insert(view.frame(), camera);
        all.insert(view.frame(), seen);
    }
    let truths: BTreeMap<u32, Vec<&Truth>> =
        all.iter().map(|(frame, seen)| (*frame, seen.iter().map(|one| &one.truth).collect())).collect();
    let infos: BTreeMap<u32, Vec<&TruthInfo>> =
        all.iter().map(|(frame, seen)| (*frame, seen.iter().map(|one| &one.info).collect())).collect();
    let name = &folder.name;
    out.write_json(&format!("{name}/scene_camera.json"), &cameras)?;
    out.write_json(&format!("{name}/scene_gt.json"), &truths)?;
    out.write_json(&format!("{name}/scene_gt_info.json"), &infos)?;
    Ok(all)
}

/// What is to be found in the images of a scene.
fn evaluation_targets(scene_id: usize, seen: &BTreeMap<u32, Vec<Seen>>) -> Vec<EvaluationTarget> {
    let of_image = |(&im_id, seen): (&u32, &Vec<Seen>)| {
        let counts = counted(seen.iter().map(|one| (one.truth.obj_id, &one.info)));
        counts.into_iter().map(move |(obj_id, inst_count)| EvaluationTarget { im_id, inst_count, obj_id, scene_id })
    };
    seen.iter().flat_map(of_image).collect()
}

fn write_coco(
    out: &ExportFolder,
    track: &Track,
    folder: &Folder<'_>,
    split: &str,
    ids: impl Iterator<Item = u32>,
    seen: BTreeMap<u32, Vec<Seen>>,
) -> Result<(), ExportError> {
    let mut coco = SceneCoco::new(split, ids);
    for (frame, seen) in seen {
        coco.push_image(frame, format!("rgb/{frame:06}.{}", folder.extension()), track.camera.size());
        for one in seen {
            if let Some(silhouette) = one.silhouette {
                coco.push(one.truth.obj_id, &one.info, silhouette);
            }
        }
    }
    out.write_json(&format!("{}/scene_gt_coco.json", folder.name), &coco)
}

impl Folder<'_> {
    /// Extension of colour images.
    fn extension(&self) -> &'static str {
        if self.is_jpeg { "jpg" } else { "png" }
    }
}

fn write_frame(
    selected: &SelectedFrames<'_>,
    out: &ExportFolder,
    view: View<'_>,
    folder: &Folder<'_>,
) -> Result<(ImageCamera, Vec<Seen>), ExportError> {
    let frame = selected.read(view, &[&SHOWN[..], &DEPTH, &[Layer::SemanticInstance]].concat())?;
    let (image, name) = (format!("{:06}", view.frame()), &folder.name);
    let depth: Vec<u16> = planar_m(selected, view, &folder.calibration, &frame)?.into_iter().map(millimetres).collect();
    let color = if folder.is_jpeg { color_jpeg(selected, view, &frame)? } else { color_png(selected, view, &frame)? };
    out.write(&format!("{name}/rgb/{image}.{}", folder.extension()), &color)?;
    out.write(&format!("{name}/depth/{image}.png"), &grey16_png(frame.width, frame.height, &depth))?;
    let (rotation, translation) = folder.calibration.opencv_from_world(view);
    let k = folder.calibration.intrinsics.opencv_k().concat();
    let camera = ImageCamera {
        k: std::array::from_fn(|i| k[i]),
        depth_scale: 1.0,
        rotation: row_major(rotation),
        translation_mm: in_millimetres(translation),
    };
    let masks = selected.dataset.read_amodal_masks(&view.track.scene, &view.track.name, view.frame())?.unwrap_or_default();
    let moved = folder.moving.as_ref().map(|(bodies, labels)| bodies.at(view.frame()).instances(&labels.parts)).unwrap_or_default();
    let mut seen: Vec<Seen> = Vec::new();
    for instance in instances(&frame) {
        let Some((obj_id, rest)) = folder.targets.get(&instance.number) else { continue };
        // Of things whose parts go different ways there is no pose.
        let Some(map) = moved.get(&instance.number).copied().unwrap_or(Some(DAffine3::IDENTITY)) else { continue };
        let pose = Pose { rotation: map.matrix3 * rest.rotation, translation: map.transform_point3(rest.translation) };
        let whole = whole(selected, view, &frame, &instance, &folder.known, &masks)?;
        let visible = instance.mask(&frame);
        for (kind, mask) in [("mask", &whole.mask), ("mask_visib", &visible)] {
            out.write(&format!("{name}/{kind}/{image}_{:06}.png", seen.len()), &grey8_png(frame.width, frame.height, mask))?;
        }
        let truth = Truth {
            rotation: row_major(rotation * pose.rotation),
            translation_mm: in_millimetres(rotation * pose.translation + translation),
            obj_id: *obj_id,
        };
        let silhouette = folder.is_placed.then(|| Silhouette::new(&visible, &whole.mask, frame.width));
        seen.push(Seen { truth, info: info(visible_area(&frame, &instance), &whole, &depth), silhouette });
    }
    Ok((camera, seen))
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
