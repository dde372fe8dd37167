//! The export for Mesh R-CNN, read back: models are in camera space where the frames show them.

use enfilade_dataset::{Dataset, PartitionRow, Side};
use enfilade_export::{Existing, ExportConfig, ExportError, Format, export};
use enfilade_frame::{Layer, Values};
use enfilade_math::{DMat3, DVec3};
use enfilade_scene::{Camera, Intrinsics, Pose, Quiet};
use enfilade_shapes::{Annotation, Document, Reason, Voxels};
use std::path::{Path, PathBuf};

/// The corners of instances 1 and 2 of the analytic dataset, a table and a chair.
const BOXES: [[DVec3; 2]; 2] =
    [[DVec3::new(-0.5, 0.5, 0.0), DVec3::new(0.3, 1.0, 0.6)], [DVec3::new(0.6, 0.8, 0.0), DVec3::new(1.0, 1.2, 0.4)]];

fn camera(width: u32, height: u32, focal: f64) -> Camera {
    let (cx, cy) = (f64::from(width) / 2.0, f64::from(height) / 2.0);
    Intrinsics { width, height, fx: focal, fy: focal, cx, cy, skew: 0.0 }.into()
}

fn written(camera: &Camera) -> (tempfile::TempDir, Dataset) {
    let folder = tempfile::tempdir().unwrap();
    let dataset = crate::common::write(&folder.path().join("dataset"), camera);
    (folder, dataset)
}

fn exported(folder: &Path, dataset: &Dataset) -> Result<(PathBuf, Document), ExportError> {
    let out = folder.join("out");
    export(dataset, &ExportConfig::new(Format::Pix3d, dataset.scenes().unwrap()), &out, Existing::Refuse, &Quiet)?;
    let document = Document::read(&out.join("pix3d_all.json")).unwrap();
    Ok((out, document))
}

/// Camera pose of an annotation's frame.
fn pose(dataset: &Dataset, document: &Document, annotation: &Annotation) -> Pose {
    let image = document.images.iter().find(|image| image.id == annotation.image_id).unwrap();
    let poses = dataset.read_trajectory(image.scene.as_ref().unwrap(), image.camera.as_ref().unwrap()).unwrap().poses;
    *poses.iter().find(|pose| Some(pose.frame) == image.frame).unwrap()
}

/// The vertices of a model in camera space, metres.
fn in_camera(out: &Path, annotation: &Annotation) -> Vec<DVec3> {
    let text = std::fs::read_to_string(out.join(&annotation.model)).unwrap();
    let number = |word: &str| word.parse::<f64>().unwrap();
    let vertices = text.lines().filter_map(|line| line.strip_prefix("v ")).map(|line| line.split(' ').map(number).collect::<Vec<_>>());
    let rows = annotation.rot_mat.map(DVec3::from);
    let rotation = DMat3::from_cols(rows[0], rows[1], rows[2]).transpose();
    assert!((rotation.determinant() - 1.0).abs() < 1e-9 && (rotation * rotation.transpose() - DMat3::IDENTITY).x_axis.length() < 1e-9);
    let unit = annotation.rendered.as_ref().unwrap().meters_per_unit;
    vertices.map(|v| unit * (rotation * DVec3::from_slice(&v) + DVec3::from(annotation.trans_mat))).collect()
}

#[test]
fn models_stand_in_camera_space_where_the_frames_show_them() {
    let (folder, dataset) = written(&camera(64, 48, 40.0));
    let (out, document) = exported(folder.path(), &dataset).unwrap();
    assert_eq!(document.images.len(), 6);
    let all = document.excluded.iter().filter_map(|entry| entry.annotation.as_deref()).chain(&document.annotations);
    let mut seen = 0;
    for annotation in all {
        let rendered = annotation.rendered.as_ref().unwrap();
        let [low, high] = BOXES[rendered.instance as usize - 1];
        let view = pose(&dataset, &document, annotation);
        // Camera space is x left, y up, z forward; the dataset's is x right, y up, z backward.
        let world = |p: &DVec3| view.position + view.world_from_camera * DVec3::new(-p.x, p.y, -p.z);
        let vertices = in_camera(&out, annotation);
        assert_eq!(vertices.len(), 8);
        for corner in vertices.iter().map(world) {
            assert!((corner - low).abs().min((corner - high).abs()).max_element() < 1e-5, "{corner} of {low} {high}");
        }
        let [f, cx, cy] = annotation.k;
        let pixels: Vec<[f64; 2]> = vertices.iter().map(|p| [cx - f * p.x / p.z, cy - f * p.y / p.z]).collect();
        let bound = |axis: usize| {
            let values = || pixels.iter().map(|pixel| pixel[axis]);
            (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max))
        };
        let inside = (0..2).all(|axis| bound(axis).0 >= 0.0 && bound(axis).1 <= [64.0, 48.0][axis]);
        assert_eq!(rendered.leaves_frustum, !inside);
        // The visible pixels are within the silhouette's box, to the pixel.
        let [x, y, width, height] = annotation.bbox;
        let ((x0, x1), (y0, y1)) = (bound(0), bound(1));
        assert!(x0 < x + 0.5 && x1 > x + width - 0.5 && y0 < y + 0.5 && y1 > y + height - 0.5);
        seen += 1;
    }
    assert!(seen >= 8, "{seen}");
}

#[test]
fn masks_boxes_and_classes_are_those_of_the_frames() {
    let (folder, dataset) = written(&camera(64, 48, 40.0));
    let (out, document) = exported(folder.path(), &dataset).unwrap();
    for annotation in &document.annotations {
        let image = document.images.iter().find(|image| image.id == annotation.image_id).unwrap();
        let rendered = annotation.rendered.as_ref().unwrap();
        assert_eq!(annotation.category_id, if rendered.instance == 1 { 7 } else { 3 });
        let mask = image::open(out.join(&annotation.segmentation)).unwrap().to_luma8();
        let (scene, name) = (image.scene.as_ref().unwrap(), image.camera.as_ref().unwrap());
        let Values::I16(numbers) = crate::common::layer(&dataset, scene, name, image.frame.unwrap(), Layer::SemanticInstance) else {
            panic!()
        };
        assert!(mask.pixels().zip(&numbers).all(|(pixel, number)| (pixel.0[0] == 255) == (*number == rendered.instance)));
        assert_eq!(annotation.area, numbers.iter().filter(|number| **number == rendered.instance).count() as f64);
        assert!(out.join(&image.file_name).is_file());
    }
}

#[test]
fn voxels_have_the_models_proportions() {
    let (folder, dataset) = written(&camera(64, 48, 40.0));
    let (out, document) = exported(folder.path(), &dataset).unwrap();
    let annotation = document.annotations.iter().find(|a| a.rendered.as_ref().unwrap().instance == 1).unwrap();
    let points = Voxels::read(&out.join(&annotation.voxel)).unwrap().points();
    let (min, max) = points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), &p| (a.min(p), b.max(p)));
    // 0.8 along x, 0.5 along y and 0.6 along z of the world are x, z and y of the model.
    let expected = DVec3::new(0.8, 0.6, 0.5) / DVec3::new(0.8, 0.6, 0.5).length();
    assert!((max - min).distance(expected) < 0.02, "{}", max - min);
}

#[test]
fn an_instance_that_leaves_the_image_is_excluded_with_its_reason() {
    // So narrow an angle that no box is whole in the image.
    let (folder, dataset) = written(&camera(40, 30, 120.0));
    let (out, document) = exported(folder.path(), &dataset).unwrap();
    assert_eq!(document.annotations, []);
    assert!(!document.excluded.is_empty());
    for entry in &document.excluded {
        assert_eq!(entry.reason, Reason::OutsideImage);
        let annotation = entry.annotation.as_deref().unwrap();
        assert!(annotation.rendered.as_ref().unwrap().leaves_frustum);
        assert!(out.join(&annotation.segmentation).is_file() && out.join(&annotation.model).is_file());
    }
}

#[test]
fn cameras_that_the_format_cannot_tell_are_refused_by_name() {
    let refused = |camera: Camera| {
        let (folder, dataset) = written(&camera);
        exported(folder.path(), &dataset).unwrap_err().to_string()
    };
    let found = refused(crate::common::pinhole());
    assert!(found.starts_with("room/cam_00 cannot be exported as pix3d: its principal point is -0.75, 0.75 pixels"), "{found}");
    let found = refused(Intrinsics { width: 40, height: 30, fx: 33.0, fy: 34.5, cx: 20.0, cy: 15.0, skew: 0.0 }.into());
    assert!(found.contains("its focal lengths are 33.000 and 34.500 pixels"), "{found}");
}

#[test]
fn the_datasets_sides_are_files_of_their_own() {
    let (folder, dataset) = written(&camera(64, 48, 40.0));
    let row =
        |scene: &str, camera: &str, frame, partition| PartitionRow { scene: scene.into(), camera: camera.into(), frame, side: partition };
    dataset
        .write_partition(&[
            row("room", "cam_00", 0, Ok(Side::Train)),
            row("room", "cam_00", 1, Ok(Side::Train)),
            row("room", "cam_00", 3, Err("dark".into())),
            row("room-two", "cam_00", 12, Ok(Side::Test)),
        ])
        .unwrap();
    let (out, document) = exported(folder.path(), &dataset).unwrap();
    let side = |name: &str| Document::read(&out.join(format!("pix3d_{name}.json"))).unwrap();
    let (train, test) = (side("train"), side("test"));
    assert_eq!((document.images.len(), train.images.len(), test.images.len()), (6, 2, 1));
    assert!(train.annotations.iter().all(|a| train.images.iter().any(|image| image.id == a.image_id)));
    assert!(!out.join("pix3d_val.json").exists());
}

#[test]
fn a_scene_without_a_labelled_mesh_is_refused() {
    let (folder, dataset) = written(&camera(64, 48, 40.0));
    std::fs::remove_file(dataset.layout().mesh_file("room", "mesh_vertices.hdf5")).unwrap();
    let found = exported(folder.path(), &dataset).unwrap_err().to_string();
    assert!(found.contains("room cannot be exported as pix3d: mesh_vertices.hdf5 is missing in _detail/mesh"), "{found}");
}
