//! Laws of the files that describe a camera beyond its matrix, and of stereo rigs.

use super::card::Card;
use super::law::Law;
use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::{Array, Dataset, Elements, StereoRecord, opencv_cameras};
use enfilade_math::DVec3;
use enfilade_scene::{Camera, CameraView, Pose, Trajectory};
use serde_json::Value;

/// Checks the files of one camera. They are recomputed from `camera.json` and the poses.
pub(super) fn check(dataset: &Dataset, scene: &str, trajectory: &Trajectory, camera: &Camera, card: &mut Card) {
    let (name, layout) = (&trajectory.name, dataset.layout());
    let place = format!("{scene}/{name}");
    let off = ray_error(dataset, scene, name, camera);
    card.observe(Law::CameraFiles, off, || format!("{place}: camera_rays.hdf5"));
    check_opencv(dataset, scene, trajectory, camera, card);
    if camera.shutter.is_some_and(|shutter| shutter.readout_s > 0.0) {
        for what in ["positions", "orientations"] {
            let path = layout.camera_rows(scene, name, what);
            let off = read_array(&path).map_or(f64::INFINITY, |array| row_error(&array, camera, trajectory, what == "positions"));
            card.observe(Law::CameraFiles, off, || path.display().to_string());
        }
    }
    match dataset.read_stereo(scene, name) {
        Err(error) => card.observe(Law::Stereo, f64::INFINITY, || error.to_string()),
        Ok(None) => card.observe(Law::Stereo, 0.0, || place),
        Ok(Some(stereo)) => check_stereo(dataset, scene, trajectory, &stereo, card),
    }
}

/// `cameras_opencv.json` has the poses and the calibration that the other files have.
fn check_opencv(dataset: &Dataset, scene: &str, trajectory: &Trajectory, camera: &Camera, card: &mut Card) {
    let path = dataset.layout().cameras_opencv(scene, &trajectory.name);
    if !path.is_file() {
        return;
    }
    let value = |text: &[u8]| serde_json::from_slice::<Value>(text).unwrap_or_default();
    let stored = value(&std::fs::read(&path).unwrap_or_default());
    let expected = value(opencv_cameras(scene, trajectory, camera).as_bytes());
    for (law, key) in [(Law::Calibration, "K"), (Law::CameraFiles, "distortion"), (Law::CameraFiles, "frames")] {
        card.observe(law, difference(&stored[key], &expected[key]), || format!("{key} in {}", path.display()));
    }
}

/// Largest difference between numbers at the same places; infinite where the places differ.
fn difference(a: &Value, b: &Value) -> f64 {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => (a.as_f64().unwrap_or(f64::NAN) - b.as_f64().unwrap_or(f64::NAN)).abs(),
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => a.iter().zip(b).map(|(a, b)| difference(a, b)).fold(0.0, f64::max),
        (Value::Object(a), Value::Object(b)) if a.keys().eq(b.keys()) => {
            a.values().zip(b.values()).map(|(a, b)| difference(a, b)).fold(0.0, f64::max)
        }
        _ if a == b => 0.0,
        _ => f64::INFINITY,
    }
}

/// Largest difference between the stored ray of a pixel and the camera's; infinite when the file is missing, damaged or superfluous.
fn ray_error(dataset: &Dataset, scene: &str, name: &str, camera: &Camera) -> f64 {
    let [width, height] = camera.size();
    match dataset.read_camera_rays(scene, name, [width, height]) {
        Ok(None) if camera.projection.is_linear() => 0.0,
        Ok(Some(rays)) if !camera.projection.is_linear() => {
            let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
            let off = |((x, y), stored): ((u32, u32), &DVec3)| match camera.projection.ray(f64::from(x) + 0.5, f64::from(y) + 0.5) {
                Some(ray) => ray.normalize().distance(*stored),
                None if stored.is_nan() => 0.0,
                None => f64::INFINITY,
            };
            // NaN, where a ray should be, is the worst.
            pixels.zip(&rays).map(off).fold(0.0, |worst, off| if off.is_nan() { f64::INFINITY } else { worst.max(off) })
        }
        _ => f64::INFINITY,
    }
}

/// Largest difference between the stored pose of a row and the camera's.
fn row_error(array: &Array, camera: &Camera, trajectory: &Trajectory, positions: bool) -> f64 {
    let Elements::F64(values) = &array.values else { return f64::INFINITY };
    let mut expected = Vec::with_capacity(values.len());
    for index in 0..trajectory.poses.len() {
        let view = CameraView::of_frame(camera, &trajectory.poses, index);
        for row in 0..camera.size()[1] {
            let (position, world_from_camera) = view.row_placement(f64::from(row) + 0.5);
            match positions {
                true => expected.extend(position.to_array()),
                false => expected.extend(world_from_camera.transpose().to_cols_array()),
            }
        }
    }
    if values.len() != expected.len() {
        return f64::INFINITY;
    }
    values
        .iter()
        .zip(&expected)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, |worst, off| if off.is_nan() { f64::INFINITY } else { worst.max(off) })
}

/// Checks frame by frame that the partner is where the record states and looks in the same direction, and that its record of this camera
/// agrees.
fn check_stereo(dataset: &Dataset, scene: &str, trajectory: &Trajectory, stereo: &StereoRecord, card: &mut Card) {
    let (name, partner) = (&trajectory.name, &stereo.partner);
    let other = dataset.read_trajectory(scene, partner).map(|t| t.poses).unwrap_or_default();
    let mutual = dataset
        .read_stereo(scene, partner)
        .ok()
        .flatten()
        .is_some_and(|back| back.partner == *name && back.side != stereo.side && back.baseline_m == stereo.baseline_m);
    let offset = DVec3::from(stereo.partner_position_m);
    let broken = !mutual || other.len() != trajectory.poses.len() || (offset.length() - stereo.baseline_m).abs() > 1e-12;
    card.observe(Law::Stereo, if broken { f64::INFINITY } else { 0.0 }, || format!("{scene}/{name}: it and {partner} are no pair"));
    for (pose, partner) in trajectory.poses.iter().zip(&other) {
        let off = (pose.position + pose.world_from_camera * offset).distance(partner.position);
        let turned = (pose.world_from_camera - partner.world_from_camera).to_cols_array().iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let frames = |a: &Pose, b: &Pose| if a.frame == b.frame { 0.0 } else { f64::INFINITY };
        card.observe(Law::Stereo, off.max(turned) + frames(pose, partner), || format!("{scene}/{name}/frame.{:04}", pose.frame));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_dataset::StereoSide;
    use enfilade_dataset::hdf5::{Storage, write_array};
    use enfilade_scene::{Fisheye, Projection, Shutter};
    use enfilade_testroom as testroom;

    fn trajectory() -> Trajectory {
        let first = testroom::pose();
        let second = Pose { frame: 1, position: first.position + DVec3::X * 0.1, ..first };
        Trajectory { name: "cam_00".into(), poses: vec![first, second] }
    }

    /// A fisheye with a rolling shutter, and a plain pinhole.
    fn cameras() -> [Camera; 2] {
        let fisheye = Projection::Fisheye(testroom::intrinsics(), Fisheye::new([0.01, 0.0, 0.0, 0.0]).unwrap());
        let shutter = Shutter { exposure_s: 0.01, readout_s: 0.02, frame_time_s: 0.1 };
        [Camera { shutter: Some(shutter), ..fisheye.into() }, testroom::intrinsics().into()]
    }

    /// The laws that the files of `camera` break after `change`.
    fn failures(camera: &Camera, change: impl Fn(&Dataset)) -> Vec<Law> {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        dataset.write_trajectory("room", &trajectory(), camera, None).unwrap();
        change(&dataset);
        let mut card = Card::default();
        check(&dataset, "room", &trajectory(), camera, &mut card);
        card.failures()
    }

    #[test]
    fn files_that_are_not_the_cameras_are_found() {
        let [rolling, pinhole] = cameras();
        assert_eq!(failures(&rolling, |_| ()), []);
        assert_eq!(failures(&pinhole, |_| ()), []);
        let bent = |d: &Dataset| {
            let path = d.layout().camera_rays("room", "cam_00");
            let Array { shape, values: Elements::F64(mut rays) } = read_array(&path).unwrap() else { panic!("rays are float64") };
            rays[3 * 70] += 1e-6;
            write_array(&path, &Array::f64(&shape, rays), Storage::Compressed, &[]).unwrap();
        };
        assert_eq!(failures(&rolling, bent), [Law::CameraFiles]);
        let other_motion = |d: &Dataset| {
            let [mut other, _] = cameras();
            other.shutter = Some(Shutter { readout_s: 0.03, ..other.shutter.unwrap() });
            d.write_trajectory("room", &trajectory(), &other, None).unwrap();
        };
        assert_eq!(failures(&rolling, other_motion), [Law::CameraFiles]);
        let gone = |d: &Dataset| std::fs::remove_file(d.layout().camera_rows("room", "cam_00", "orientations")).unwrap();
        assert_eq!(failures(&rolling, gone), [Law::CameraFiles]);
        let left_over = |d: &Dataset| d.write_trajectory("room", &trajectory(), &cameras()[0], None).unwrap();
        assert_eq!(failures(&pinhole, left_over), [Law::CameraFiles]);
    }

    #[test]
    fn poses_and_calibration_for_opencv_that_are_not_the_cameras_are_found() {
        let [_, pinhole] = cameras();
        let rewritten = |from: &str, to: &str| {
            failures(&pinhole, |d| {
                let path = d.layout().cameras_opencv("room", "cam_00");
                let text = std::fs::read_to_string(&path).unwrap();
                assert!(text.contains(from), "{text}");
                std::fs::write(&path, text.replacen(from, to, 1)).unwrap();
            })
        };
        assert_eq!(rewritten("OpenCV:", "As OpenCV has it:"), []);
        assert_eq!(rewritten("\"frame\": 1", "\"frame\": 2"), [Law::CameraFiles]);
        let fx = format!("{:?}", testroom::intrinsics().fx);
        assert_eq!(rewritten(&fx, &format!("{:?}", testroom::intrinsics().fx + 1e-3)), [Law::Calibration]);
        assert_eq!(rewritten("{", "["), [Law::Calibration, Law::CameraFiles]);
        assert_eq!(failures(&pinhole, |d| std::fs::remove_file(d.layout().cameras_opencv("room", "cam_00")).unwrap()), []);
    }

    #[test]
    fn a_rig_that_is_none_is_found() {
        let [_, pinhole] = cameras();
        let rig = |d: &Dataset, right: Trajectory, back: Option<StereoRecord>| {
            let left = StereoRecord::new(StereoSide::Left, "cam_01".into(), 0.12);
            d.write_trajectory("room", &trajectory(), &pinhole, Some(&left)).unwrap();
            d.write_trajectory("room", &right, &pinhole, back.as_ref()).unwrap();
        };
        let beside = |m: f64| trajectory().beside("cam_01".into(), m);
        let back = |m: f64| Some(StereoRecord::new(StereoSide::Right, "cam_00".into(), m));
        assert_eq!(failures(&pinhole, |d| rig(d, beside(0.12), back(0.12))), []);
        assert_eq!(failures(&pinhole, |d| rig(d, beside(0.121), back(0.12))), [Law::Stereo]);
        assert_eq!(failures(&pinhole, |d| rig(d, beside(0.12), back(0.13))), [Law::Stereo]);
        assert_eq!(failures(&pinhole, |d| rig(d, beside(0.12), None)), [Law::Stereo]);
        let mut turned = beside(0.12);
        turned.poses[1].world_from_camera *= enfilade_math::DMat3::from_rotation_y(1e-6);
        assert_eq!(failures(&pinhole, |d| rig(d, turned.clone(), back(0.12))), [Law::Stereo]);
    }
}
