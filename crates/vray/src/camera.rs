//! The camera and trajectory of a dataset in V-Ray's form.

use crate::edit::{CameraKeyframe, CameraPath};
use crate::error::VrayError;
use crate::lens::LensPicture;
use enfilade_dataset::{CameraRecord, Dataset, read_ray_grid};
use enfilade_scene::{Camera, Intrinsics, Pose, Projection};
use std::path::PathBuf;

/// The field of view and size of Hypersim's images, used as defaults.
const FOV_X_DEG: f64 = 60.0;
const SIZE: [u32; 2] = [1024, 768];

/// A camera that is requested in place of the dataset's own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CameraWish {
    /// Horizontal field of view of a plain pinhole, degrees.
    pub fov_x_deg: Option<f64>,
    /// Size of the images, pixels.
    pub size: Option<[u32; 2]>,
    /// A grid of rays in the form of Hypersim's `camera_lens_distortion.hdf5`.
    pub rays: Option<PathBuf>,
}

/// A camera with its path through a scene.
#[derive(Clone, Debug)]
pub struct FilmedCamera {
    /// For the scene. Its `lens` is `None`: the caller decides where [`FilmedCamera::lens`] is written.
    pub path: CameraPath,
    /// The lens picture for V-Ray, if the camera is not a plain pinhole.
    pub lens: Option<LensPicture>,
    /// Effects that V-Ray's images will not show, in words.
    pub left_out: Vec<&'static str>,
}

/// The camera `name` of a dataset's scene with its trajectory in units of `meters_per_unit`.
///
/// It is the dataset's own camera with the changes in `wish`; Hypersim's pinhole if the dataset describes none. Pinholes
/// with a centred principal point and square pixels are V-Ray's own; every other camera with an image plane becomes a [`LensPicture`].
///
/// # Errors
/// When the dataset cannot be read, has no such trajectory, or the camera has no form in V-Ray's scene.
pub fn filmed_camera(
    dataset: &Dataset,
    scene: &str,
    name: &str,
    meters_per_unit: f64,
    wish: &CameraWish,
) -> Result<FilmedCamera, VrayError> {
    let trajectory = dataset.read_trajectory(scene, name)?;
    if trajectory.poses.is_empty() {
        return Err(VrayError::usage(
            format!("{name} of scene {scene} has no poses"),
            "plan the trajectory again: enfilade run OUT --only plan",
        ));
    }
    let camera = wished_camera(dataset, scene, name, wish)?;
    if camera.shutter.is_some_and(|shutter| shutter.readout_s > 0.0) {
        return Err(VrayError::usage(
            format!("{name} has a rolling shutter, which would have to be V-Ray's own"),
            "take a camera without: [camera.shutter] readout_s = 0, or name --fov-deg for a plain pinhole",
        ));
    }
    let mut left_out = Vec::new();
    if camera.lens.is_some() {
        left_out.push("the lens's aperture: V-Ray's images will be in focus everywhere");
    }
    if camera.shutter.is_some_and(|shutter| shutter.exposure_s > 0.0) {
        left_out.push("the shutter: V-Ray's camera will be at rest for each frame");
    }
    let (fov_x_rad, lens) = match &camera.projection {
        Projection::Pinhole(k) if is_plain(k) => (k.fov_x_rad(), None),
        projection => {
            let picture = LensPicture::new(projection)?;
            (picture.fov_x_rad, Some(picture))
        }
    };
    let keyframe = |pose: &Pose| CameraKeyframe {
        frame: i64::from(pose.frame),
        position: (pose.position / meters_per_unit).to_array(),
        world_from_camera: std::array::from_fn(|row| pose.world_from_camera.row(row).to_array()),
    };
    let path = CameraPath {
        keyframes: trajectory.poses.iter().map(keyframe).collect(),
        frame_time_s: dataset.read_frame_time(scene, name)?,
        fov_x_rad,
        size: camera.size(),
        lens: None,
    };
    Ok(FilmedCamera { path, lens, left_out })
}

/// The dataset's camera with the requested changes.
pub(crate) fn wished_camera(dataset: &Dataset, scene: &str, name: &str, wish: &CameraWish) -> Result<Camera, VrayError> {
    let own = match dataset.read_camera(scene, name) {
        Err(error) if error.is_not_found() => None,
        camera => Some(camera?),
    };
    let size = wish.size.or(own.as_ref().map(Camera::size)).unwrap_or(SIZE);
    if size.contains(&0) || wish.fov_x_deg.is_some_and(|fov| !(fov > 0.0 && fov < 180.0)) {
        return Err(VrayError::usage("no camera has this field of view and size", "give 0 < --fov-deg < 180 and at least one pixel"));
    }
    let pinhole = |fov_deg: f64| Camera::from(Intrinsics::from_fov_x(size[0], size[1], fov_deg.to_radians()));
    match (&wish.rays, wish.fov_x_deg, own) {
        (Some(_), Some(_), _) => Err(VrayError::usage("a grid of rays has its own field of view", "leave out --fov-deg or --rays")),
        (Some(rays), None, _) => Ok(Projection::RayGrid(read_ray_grid(rays, size)?).into()),
        (None, Some(fov_deg), _) => Ok(pinhole(fov_deg)),
        (None, None, None) => Ok(pinhole(FOV_X_DEG)),
        (None, None, Some(own)) if own.size() == size => Ok(own),
        (None, None, Some(own)) => match &own.projection {
            Projection::Pinhole(k) if is_plain(k) => Ok(pinhole(k.fov_x_rad().to_degrees())),
            _ => Err(VrayError::usage(
                format!("{name} is no plain pinhole, so another size would be another camera"),
                "leave out --size, or give --fov-deg too",
            )),
        },
    }
}

/// Checks that the camera that is rendered is the one that the dataset's files describe, or that they describe none; returns whether
/// they do.
///
/// # Errors
/// When they describe another one.
pub(crate) fn check_described(dataset: &Dataset, scene: &str, name: &str, wish: &CameraWish) -> Result<bool, VrayError> {
    let camera = wished_camera(dataset, scene, name, wish)?;
    match dataset.read_camera(scene, name) {
        Err(error) if error.is_not_found() => Ok(false),
        Err(error) => Err(error.into()),
        Ok(own) if CameraRecord::from(&own) == CameraRecord::from(&camera) => Ok(true),
        Ok(_) => Err(VrayError::usage(
            format!("this is another camera than the dataset's {name}, whose files would not describe the images"),
            "leave out --fov-deg, --size and --rays, or plan the dataset with that camera",
        )),
    }
}

/// True for the pinholes that field of view and size describe.
fn is_plain(k: &Intrinsics) -> bool {
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b;
    same(k.fy, k.fx) && same(k.cx, 0.5 * f64::from(k.width)) && same(k.cy, 0.5 * f64::from(k.height)) && k.skew == 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{dataset_of, trajectory};
    use enfilade_math::DVec3;
    use enfilade_scene::{Fisheye, Shutter, ThinLens};

    fn filmed(camera: Camera, wish: &CameraWish) -> Result<FilmedCamera, VrayError> {
        let folder = tempfile::tempdir().unwrap();
        let dataset = dataset_of(folder.path(), &camera);
        filmed_camera(&dataset, "room", "cam_00", 0.5, wish)
    }

    #[test]
    fn a_plain_pinhole_is_v_rays_own_and_others_are_bent() {
        let plain = Intrinsics::from_fov_x(16, 12, 1.1);
        let found = filmed(plain.into(), &CameraWish::default()).unwrap();
        assert!(found.lens.is_none() && (found.path.fov_x_rad - 1.1).abs() < 1e-9 && found.path.size == [16, 12]);
        let pose = &trajectory().poses[1];
        assert_eq!(found.path.keyframes[1].frame, 1);
        assert!((DVec3::from(found.path.keyframes[1].position) * 0.5 - pose.position).length() < 1e-12);
        let shifted = Intrinsics { cx: 7.0, ..plain };
        let found = filmed(shifted.into(), &CameraWish::default()).unwrap();
        assert_eq!(found.lens.unwrap().size, [33, 25]);
        let wider = CameraWish { fov_x_deg: Some(90.0), ..CameraWish::default() };
        let found = filmed(shifted.into(), &wider).unwrap();
        assert!(found.lens.is_none() && (found.path.fov_x_rad.to_degrees() - 90.0).abs() < 1e-9 && found.path.size == [16, 12]);
        let larger = CameraWish { size: Some([32, 24]), ..CameraWish::default() };
        assert!((filmed(plain.into(), &larger).unwrap().path.fov_x_rad - 1.1).abs() < 1e-9);
        assert!(filmed(shifted.into(), &larger).unwrap_err().to_string().contains("another camera"));
    }

    #[test]
    fn what_v_ray_cannot_show_is_said() {
        let k = Intrinsics::from_fov_x(16, 12, 1.1);
        let lens = ThinLens { aperture_radius_m: 0.01, focus_distance_m: 2.0, blades: 0, focus_tilt_rad: [0.0; 2] };
        let found = filmed(Camera { lens: Some(lens), ..k.into() }, &CameraWish::default()).unwrap();
        assert_eq!(found.left_out.len(), 1);
        let shutter = Shutter { exposure_s: 0.0, readout_s: 0.1, frame_time_s: 1.0 };
        let message = filmed(Camera { shutter: Some(shutter), ..k.into() }, &CameraWish::default()).unwrap_err().to_string();
        assert!(message.contains("rolling shutter"), "{message}");
        let fisheye = Projection::Fisheye(k, Fisheye::new([0.0; 4]).unwrap());
        assert!(filmed(fisheye.into(), &CameraWish::default()).unwrap_err().to_string().contains("sees to the side"));
        let wrong = CameraWish { size: Some([0, 12]), ..CameraWish::default() };
        assert!(matches!(filmed(k.into(), &wrong), Err(VrayError::Usage { .. })));
    }
}
