//! COLMAP: `<scene>/sparse/0/{cameras,images,points3D}` beside `<scene>/images/`, and the binary form of the three files.
//!
//! Images are in one folder, and their names have no other dot: programs for Gaussian splatting take the last part of a name, up to its
//! first dot, and VGGT takes every entry of `images/` for a picture.
//!
//! Poses are world to camera with OpenCV's axes as quaternion (w, x, y, z) and translation in metres; the world is right-handed with z up.
//! Image coordinates count from the upper left corner of the image, so pixel centres are at half-integers, in COLMAP as here. Points are on
//! the stored surfaces, and their tracks name every frame that sees them ([`crate::points`]); errors are 0.

use crate::ExportError;
use crate::calibration::{Calibration, Distortion};
use crate::export_folder::ExportFolder;
use crate::picture::{SHOWN, color_png};
use crate::points::{CloudPoint, cloud};
use crate::selected_frames::{SelectedFrames, Track, View};
use enfilade_math::DQuat;

/// A model in COLMAP's terms. Ids are the index plus 1.
pub(crate) struct Model {
    pub cameras: Vec<CameraEntry>,
    pub images: Vec<ImageEntry>,
    pub points: Vec<PointEntry>,
}

pub(crate) struct CameraEntry {
    pub model: CameraModel,
    pub width: u32,
    pub height: u32,
    pub parameters: Vec<f64>,
}

/// COLMAP's camera models with their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub(crate) enum CameraModel {
    Pinhole = 1,
    Opencv = 4,
    OpencvFisheye = 5,
    FullOpencv = 6,
}

impl CameraModel {
    /// COLMAP's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pinhole => "PINHOLE",
            Self::Opencv => "OPENCV",
            Self::OpencvFisheye => "OPENCV_FISHEYE",
            Self::FullOpencv => "FULL_OPENCV",
        }
    }
}

pub(crate) struct ImageEntry {
    /// (w, x, y, z).
    pub rotation: [f64; 4],
    pub translation: [f64; 3],
    pub camera_id: u32,
    pub name: String,
    /// x, y and the id of the point.
    pub points: Vec<(f64, f64, u64)>,
}

pub(crate) struct PointEntry {
    pub position: [f64; 3],
    pub color: [u8; 3],
    /// Id of the image and index among its points.
    pub track: Vec<(u32, u32)>,
}

/// The three files of a model by name.
pub(crate) type Files = [(&'static str, Vec<u8>); 3];

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder, encode: fn(&Model) -> Files) -> Result<(), ExportError> {
    for tracks in selected.scenes() {
        let scene = &tracks[0].scene;
        let cameras = tracks.iter().map(|track| camera(selected, track)).collect::<Result<_, _>>()?;
        let views: Vec<View<'_>> = tracks.iter().flat_map(Track::views).collect();
        selected.each_of(&views, |view| {
            let frame = selected.read(view, &SHOWN)?;
            out.write(&format!("{scene}/images/{}", name(view)), &color_png(selected, view, &frame)?)
        })?;
        let model = model(cameras, images(selected, tracks)?, &cloud(selected, tracks)?);
        for (file, bytes) in encode(&model) {
            out.write(&format!("{scene}/sparse/0/{file}"), &bytes)?;
        }
    }
    Ok(())
}

fn name(view: View<'_>) -> String {
    format!("{}.png", view.file_stem())
}

fn camera(selected: &SelectedFrames<'_>, track: &Track) -> Result<CameraEntry, ExportError> {
    let wrong = |problem: &str| selected.unsuitable(track.folder(), format!("{problem}; leave the camera out"));
    let calibration = Calibration::of(track).ok_or_else(|| wrong("COLMAP has no such camera (panorama, grid of rays)"))?;
    let k = calibration.intrinsics;
    if k.skew != 0.0 {
        return Err(wrong("its pixels are skewed, which COLMAP cannot say"));
    }
    let (model, distortion) = match calibration.distortion {
        Distortion::None => (CameraModel::Pinhole, Vec::new()),
        Distortion::RadialTangential([k1, k2, p1, p2, 0.0, 0.0, 0.0, 0.0]) => (CameraModel::Opencv, vec![k1, k2, p1, p2]),
        Distortion::RadialTangential(all) => (CameraModel::FullOpencv, all.to_vec()),
        Distortion::Fisheye(all) => (CameraModel::OpencvFisheye, all.to_vec()),
    };
    Ok(CameraEntry { model, width: k.width, height: k.height, parameters: [vec![k.fx, k.fy, k.cx, k.cy], distortion].concat() })
}

/// The images without their points.
fn images(selected: &SelectedFrames<'_>, tracks: &[Track]) -> Result<Vec<ImageEntry>, ExportError> {
    let mut images = Vec::new();
    for (camera, track) in tracks.iter().enumerate() {
        let missing = || selected.unsuitable(track.folder(), "its camera has no calibration; leave it out");
        let calibration = Calibration::of(track).ok_or_else(missing)?;
        for view in track.views() {
            let (rotation, translation) = calibration.opencv_from_world(view);
            let [x, y, z, w] = DQuat::from_mat3(&rotation).to_array();
            let camera_id = camera as u32 + 1;
            images.push(ImageEntry {
                rotation: [w, x, y, z],
                translation: translation.to_array(),
                camera_id,
                name: name(view),
                points: Vec::new(),
            });
        }
    }
    Ok(images)
}

fn model(cameras: Vec<CameraEntry>, mut images: Vec<ImageEntry>, cloud: &[CloudPoint]) -> Model {
    let mut points = Vec::new();
    for (i, point) in cloud.iter().enumerate() {
        let mut track = Vec::new();
        for sighting in &point.sightings {
            let seen = &mut images[sighting.view].points;
            track.push((sighting.view as u32 + 1, seen.len() as u32));
            seen.push((sighting.at.0, sighting.at.1, i as u64 + 1));
        }
        points.push(PointEntry { position: point.position.to_array(), color: point.color, track });
    }
    Model { cameras, images, points }
}

/// The model in COLMAP's binary form, little-endian.
pub(crate) fn binary(model: &Model) -> Files {
    [("cameras.bin", cameras_bin(model)), ("images.bin", images_bin(model)), ("points3D.bin", points_bin(model))]
}

fn cameras_bin(model: &Model) -> Vec<u8> {
    let mut bytes = (model.cameras.len() as u64).to_le_bytes().to_vec();
    for (id, camera) in (1u32..).zip(&model.cameras) {
        bytes.extend(id.to_le_bytes());
        bytes.extend((camera.model as i32).to_le_bytes());
        bytes.extend(u64::from(camera.width).to_le_bytes());
        bytes.extend(u64::from(camera.height).to_le_bytes());
        bytes.extend(camera.parameters.iter().flat_map(|v| v.to_le_bytes()));
    }
    bytes
}

fn images_bin(model: &Model) -> Vec<u8> {
    let mut bytes = (model.images.len() as u64).to_le_bytes().to_vec();
    for (id, image) in (1u32..).zip(&model.images) {
        bytes.extend(id.to_le_bytes());
        bytes.extend(image.rotation.iter().chain(&image.translation).flat_map(|v| v.to_le_bytes()));
        bytes.extend(image.camera_id.to_le_bytes());
        bytes.extend(image.name.as_bytes());
        bytes.push(0);
        bytes.extend((image.points.len() as u64).to_le_bytes());
        for &(x, y, point) in &image.points {
            bytes.extend([x.to_le_bytes(), y.to_le_bytes(), point.to_le_bytes()].concat());
        }
    }
    bytes
}

fn points_bin(model: &Model) -> Vec<u8> {
    let mut bytes = (model.points.len() as u64).to_le_bytes().to_vec();
    for (id, point) in (1u64..).zip(&model.points) {
        bytes.extend(id.to_le_bytes());
        bytes.extend(point.position.iter().flat_map(|v| v.to_le_bytes()));
        bytes.extend(point.color);
        bytes.extend(0f64.to_le_bytes());
        bytes.extend((point.track.len() as u64).to_le_bytes());
        bytes.extend(point.track.iter().flat_map(|&(image, index)| [image.to_le_bytes(), index.to_le_bytes()].concat()));
    }
    bytes
}
