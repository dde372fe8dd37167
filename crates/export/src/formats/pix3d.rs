//! Pix3D as Mesh R-CNN reads it: images, masks, a model and its voxels per instance, and JSON with the pose of each in camera space.
//!
//! A model is the instance's mesh in axes like Pix3D's (x left, y up, z inward of the world: −x, z, y), moved to the middle of its box and scaled
//! into the ball of diameter 1, as Pix3D's models are and as Mesh R-CNN scales voxels. `rot_mat` and `trans_mat` bring it to the camera,
//! whose axes are x left, y up, z forward, in the model's unit; times `meters_per_unit` that is metres.

use crate::ExportError;
use crate::calibration::Calibration;
use crate::export_folder::ExportFolder;
use crate::instances::{Instance, instances};
use crate::mesh::{SurfaceMesh, instance_meshes, missing_mesh_file};
use crate::picture::{SHOWN, color_jpeg, grey8_png};
use crate::selected_frames::{SelectedFrames, Track, View};
use enfilade_dataset::{InstanceView, Side};
use enfilade_frame::{Frame, Layer};
use enfilade_math::{DMat3, DVec3};
use enfilade_scene::Intrinsics;
use enfilade_shapes::{Annotation, Document, Excluded, Image, Reason, Rendered, Surface, Voxels, category_from_nyu40};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// Vertices that are nearer to the camera's plane than this leave the frustum, metres: the perspective is undefined at 0.
const NEAR_M: f64 = 0.01;

/// Tolerance of the principal point from the middle of the image, pixels: Mesh R-CNN assumes that it is there.
const CENTRE_TOLERANCE_PX: f64 = 0.5;

/// Tolerance of the aspect of pixels: Mesh R-CNN has one focal length.
const SQUARE_TOLERANCE: f64 = 1e-3;

/// World axes to those of models: x left, y up, z inward.
const MODEL_FROM_WORLD: DMat3 = DMat3::from_cols(DVec3::NEG_X, DVec3::Z, DVec3::Y);

/// OpenCV's camera axes (x right, y down) to Pix3D's (x left, y up), and back.
const PIX3D_FROM_OPENCV: DMat3 = DMat3::from_cols(DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z);

/// The model of an instance.
struct Model {
    /// Vertices, world, metres.
    world: Vec<DVec3>,
    /// Middle of its box, world, metres.
    center: DVec3,
    meters_per_unit: f64,
}

/// The entries of a frame: picture, annotations, excluded instances.
type Told = (Image, Vec<Annotation>, Vec<Excluded>);

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    let mut all = Document::empty("Rendered by enfilade; see README.md");
    let mut sides = BTreeMap::new();
    for tracks in selected.scenes() {
        let scene = &tracks[0].scene;
        let cameras = tracks.iter().map(|track| camera(selected, track)).collect::<Result<Vec<_>, _>>()?;
        let meshes = instance_meshes(selected.dataset, scene)?;
        if meshes.is_empty() {
            return Err(selected.unsuitable(scene, shapeless(selected, scene)));
        }
        let models = write_models(selected, out, scene, meshes)?;
        for (track, calibration) in tracks.iter().zip(&cameras) {
            let views = instance_views(selected, track)?;
            let track_views: Vec<View<'_>> = track.views().collect();
            let told = selected.each_of(&track_views, |view| write_frame(selected, out, view, calibration, &models, &views))?;
            told.into_iter().for_each(|told| add(&mut all, told));
        }
    }
    match selected.dataset.read_partition() {
        Err(error) if error.is_not_found() => {}
        rows => sides.extend(rows?.into_iter().filter_map(|row| Some(((row.scene, row.camera, row.frame), row.side.ok()?)))),
    }
    out.write("pix3d_all.json", &all.to_json())?;
    let side_of = |image: &Image| sides.get(&(image.scene.clone()?, image.camera.clone()?, image.frame?)).copied();
    let present: BTreeSet<Side> = all.images.iter().filter_map(side_of).collect();
    for side in present {
        out.write(&format!("pix3d_{}.json", side.name()), &all.only(|image| side_of(image) == Some(side)).to_json())?;
    }
    Ok(())
}

/// Why a scene has no meshes of instances, and what to do.
fn shapeless(selected: &SelectedFrames<'_>, scene: &str) -> String {
    let (problem, remedy) = match missing_mesh_file(selected.dataset, scene) {
        Some(file) if file.contains("_objects_") => (format!("{file} is missing in _detail/mesh"), "label it"),
        Some(file) => (format!("{file} is missing in _detail/mesh"), "make it again with `enfilade import --force`"),
        None => ("no part of it is an instance".to_string(), "label it"),
    };
    format!("{problem}, so shapes are not known; {remedy}, or leave it out")
}

/// The track's camera, which must look straight through square pixels at the middle of the image.
fn camera(selected: &SelectedFrames<'_>, track: &Track) -> Result<Calibration, ExportError> {
    let calibration = Calibration::of_pinhole(selected, track)?;
    let Intrinsics { width, height, fx, fy, cx, cy, skew } = calibration.intrinsics;
    let (off_x, off_y) = (cx - f64::from(width) / 2.0, cy - f64::from(height) / 2.0);
    if off_x.abs().max(off_y.abs()) > CENTRE_TOLERANCE_PX {
        let tilted = if calibration.is_straight() { "" } else { " (it is tilted)" };
        let problem = format!(
            "its principal point is {off_x:.2}, {off_y:.2} pixels from the middle of the image{tilted}, and the format has it there; leave the camera out"
        );
        return Err(selected.unsuitable(track.folder(), problem));
    }
    if (fx / fy - 1.0).abs() > SQUARE_TOLERANCE || skew.abs() > CENTRE_TOLERANCE_PX {
        let problem = format!(
            "its focal lengths are {fx:.3} and {fy:.3} pixels and its skew {skew}, and the format has one focal length; leave the camera out"
        );
        return Err(selected.unsuitable(track.folder(), problem));
    }
    Ok(calibration)
}

/// Writes the models of a scene that take part, and returns their poses.
fn write_models(
    selected: &SelectedFrames<'_>,
    out: &ExportFolder,
    scene: &str,
    meshes: BTreeMap<i16, SurfaceMesh>,
) -> Result<BTreeMap<i16, Model>, ExportError> {
    let labels = selected.labels(scene)?;
    let takes_part = |number: i16| {
        let parts = labels.parts.iter().filter(|part| part.instance == number);
        parts.into_iter().any(|part| category_from_nyu40(part.semantic).is_some())
    };
    let wanted: Vec<_> = meshes.into_iter().filter(|(number, _)| takes_part(*number)).collect();
    let one = |(number, mesh): (i16, SurfaceMesh)| Ok(write_model(out, scene, number, mesh)?.map(|model| (number, model)));
    let written: Result<Vec<_>, ExportError> = wanted.into_par_iter().map(one).collect();
    Ok(written?.into_iter().flatten().collect())
}

/// Writes a model and its voxels; `None` when the mesh has no extent.
fn write_model(out: &ExportFolder, scene: &str, number: i16, mesh: SurfaceMesh) -> Result<Option<Model>, ExportError> {
    let (min, max) = mesh.vertices.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), &v| (a.min(v), b.max(v)));
    let center = 0.5 * (min + max);
    let meters_per_unit = 2.0 * mesh.vertices.iter().map(|v| v.distance(center)).fold(0.0, f64::max);
    if !(meters_per_unit > 0.0 && meters_per_unit.is_finite()) {
        return Ok(None);
    }
    let vertices = mesh.vertices.iter().map(|&v| MODEL_FROM_WORLD * (v - center) / meters_per_unit).collect();
    let surface = Surface::new(vertices, mesh.faces).expect("faces of a mesh that was read have their corners");
    let Some(voxels) = Voxels::of(&surface, Voxels::PIX3D_SIDE) else { return Ok(None) };
    out.write(&model_file(scene, number, "model.obj"), &obj(&surface))?;
    out.write(&model_file(scene, number, "voxel.mat"), &voxels.to_mat())?;
    Ok(Some(Model { world: mesh.vertices, center, meters_per_unit }))
}

fn model_file(scene: &str, number: i16, name: &str) -> String {
    format!("model/{scene}/{number:04}/{name}")
}

/// The bytes of an OBJ file.
fn obj(surface: &Surface) -> Vec<u8> {
    let mut text = String::new();
    // Adding zero turns −0 into 0.
    surface.vertices().iter().for_each(|v| text.push_str(&format!("v {:.7} {:.7} {:.7}\n", v.x + 0.0, v.y + 0.0, v.z + 0.0)));
    surface.faces().iter().for_each(|[a, b, c]| text.push_str(&format!("f {} {} {}\n", a + 1, b + 1, c + 1)));
    text.into_bytes()
}

/// Pixels of each instance as counted by the dataset, by frame and instance; empty if it has no counts.
fn instance_views(selected: &SelectedFrames<'_>, track: &Track) -> Result<BTreeMap<(u32, i16), InstanceView>, ExportError> {
    match selected.dataset.read_instance_views(&track.scene, &track.name) {
        Err(error) if error.is_not_found() => Ok(BTreeMap::new()),
        views => Ok(views?.into_iter().map(|view| ((view.frame, view.instance), view)).collect()),
    }
}

/// Writes the frame's picture and masks; returns its entries in the file, without ids.
fn write_frame(
    selected: &SelectedFrames<'_>,
    out: &ExportFolder,
    view: View<'_>,
    calibration: &Calibration,
    models: &BTreeMap<i16, Model>,
    views: &BTreeMap<(u32, i16), InstanceView>,
) -> Result<Told, ExportError> {
    let [color, entity] = SHOWN;
    let frame = selected.read(view, &[color, entity, Layer::Semantic, Layer::SemanticInstance])?;
    let image_name = format!("img/{}/frame.{:04}.jpg", view.track.folder(), view.frame());
    out.write(&image_name, &color_jpeg(selected, view, &frame)?)?;
    let mut told = (image(view, &frame, image_name), Vec::new(), Vec::new());
    for instance in instances(&frame) {
        let bbox = bbox(&instance, frame.width);
        let exclude = |reason, annotation: Option<Annotation>| {
            let (instance, nyu40) = (instance.number, instance.semantic);
            Excluded { reason, image_id: 0, instance, nyu40, bbox, annotation: annotation.map(Box::new) }
        };
        let Some(category_id) = category_from_nyu40(instance.semantic) else {
            told.2.push(exclude(Reason::Class, None));
            continue;
        };
        let Some(model) = models.get(&instance.number) else {
            told.2.push(exclude(Reason::NoMesh, None));
            continue;
        };
        let segmentation = format!("mask/{}/frame.{:04}.{:04}.png", view.track.folder(), view.frame(), instance.number);
        out.write(&segmentation, &grey8_png(frame.width, frame.height, &instance.mask(&frame)))?;
        let leaves = leaves_frustum(view, calibration, model);
        let counted = views.get(&(view.frame(), instance.number));
        let rendered = Rendered {
            instance: instance.number,
            nyu40: instance.semantic,
            meters_per_unit: model.meters_per_unit,
            leaves_frustum: leaves.is_some(),
            visibility: counted.map(InstanceView::visibility),
            truncation: counted.map(InstanceView::truncation),
        };
        let (rot_mat, trans_mat) = pose(view, calibration, model);
        let Intrinsics { width, height, fx, fy, .. } = calibration.intrinsics;
        let annotation = Annotation {
            id: 0,
            image_id: 0,
            category_id,
            iscrowd: 0,
            area: instance.pixels.len() as f64,
            bbox,
            segmentation,
            model: model_file(&view.track.scene, instance.number, "model.obj"),
            voxel: model_file(&view.track.scene, instance.number, "voxel.mat"),
            k: [0.5 * (fx + fy), f64::from(width) / 2.0, f64::from(height) / 2.0],
            rot_mat,
            trans_mat,
            rendered: Some(rendered),
        };
        match leaves {
            None => told.1.push(annotation),
            Some(reason) => told.2.push(exclude(reason, Some(annotation))),
        }
    }
    Ok(told)
}

fn image(view: View<'_>, frame: &Frame, file_name: String) -> Image {
    let (scene, camera) = (Some(view.track.scene.clone()), Some(view.track.name.clone()));
    Image { id: 0, file_name, width: frame.width, height: frame.height, scene, camera, frame: Some(view.frame()) }
}

/// Left border, upper border, width and height of the visible pixels.
fn bbox(instance: &Instance, width: u32) -> [f64; 4] {
    let [x_min, y_min, x_max, y_max] = instance.extent(width);
    [x_min, y_min, x_max - x_min + 1, y_max - y_min + 1].map(f64::from)
}

/// Rotation by rows, and translation in the model's unit, from the model to the camera.
fn pose(view: View<'_>, calibration: &Calibration, model: &Model) -> ([[f64; 3]; 3], [f64; 3]) {
    let (rotation, translation) = calibration.opencv_from_world(view);
    let camera_from_model = PIX3D_FROM_OPENCV * rotation * MODEL_FROM_WORLD.transpose();
    let origin = PIX3D_FROM_OPENCV * (rotation * model.center + translation) / model.meters_per_unit;
    // Adding zero turns −0 into 0.
    (camera_from_model.transpose().to_cols_array_2d().map(|row| row.map(|v| v + 0.0)), origin.to_array().map(|v| v + 0.0))
}

/// Why the mesh is not whole within the image: every vertex must be in front of the camera and fall on the image.
fn leaves_frustum(view: View<'_>, calibration: &Calibration, model: &Model) -> Option<Reason> {
    let (rotation, translation) = calibration.opencv_from_world(view);
    let k = &calibration.intrinsics;
    let seen: Vec<DVec3> = model.world.iter().map(|&v| rotation * v + translation).collect();
    if seen.iter().any(|p| p.z <= NEAR_M) {
        return Some(Reason::BehindCamera);
    }
    let inside = |p: &DVec3| {
        let (x, y) = (k.cx + k.fx * p.x / p.z, k.cy + k.fy * p.y / p.z);
        (0.0..=f64::from(k.width)).contains(&x) && (0.0..=f64::from(k.height)).contains(&y)
    };
    (!seen.iter().all(inside)).then_some(Reason::OutsideImage)
}

/// Appends a frame under the next ids.
fn add(all: &mut Document, (image, annotations, excluded): Told) {
    let image_id = all.images.len() as u64 + 1;
    all.images.push(Image { id: image_id, ..image });
    for annotation in annotations {
        all.annotations.push(Annotation { id: all.annotations.len() as u64 + 1, image_id, ..annotation });
    }
    all.excluded.extend(excluded.into_iter().map(|entry| {
        let annotation = entry.annotation.map(|annotation| Box::new(Annotation { image_id, ..*annotation }));
        Excluded { image_id, annotation, ..entry }
    }));
}
