//! EuRoC MAV sequences (Burri et al. 2016): `<scene>_<camera>/mav0` with the grey pictures of `cam0` (and `cam1` of a stereo rig), the inertial
//! measurements of `imu0`, and `state_groundtruth_estimate0`.
//!
//! Times are nanoseconds, and frame 0 is at [`START_S`]: 19 digits as in EuRoC's own files, so that names in order of text are in order of
//! time and programs that cut off the last nine digits find seconds before them. The body is the left camera with OpenCV's axes, and the
//! IMU is at its position, so that T_BS of both is the identity, except for cameras with a tilted image plane, which are turned. The world
//! is the dataset's, z up.

use crate::ExportError;
use crate::calibration::Calibration;
use crate::export_folder::ExportFolder;
use crate::picture::{SHOWN, grey8_png, tone_mapped};
use crate::selected_frames::{SelectedFrames, Track, View};
use enfilade_dataset::{StereoRecord, StereoSide};
use enfilade_math::{DMat3, DMat4, DVec3};
use enfilade_scene::MotionSample;
use std::fmt::Write;

/// The time of frame 0, seconds: of ten digits, as clocks have had since 2001 and have until 2286.
pub(super) const START_S: u64 = 1_400_000_000;

/// Weights of red, green and blue in a grey picture: Rec. 601's luma, as OpenCV has them.
const LUMA: [f64; 3] = [0.299, 0.587, 0.114];

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    for track in &selected.tracks {
        let k = Calibration::of_upright_pinhole(selected, track)?;
        let (folder, number, stereo) = place(selected, track)?;
        let motion = selected.dataset.read_motion(&track.scene, &track.name)?.ok_or_else(|| {
            let problem = "its frames are no video (less than a second apart); plan with mode = { kind = \"video\" }, or leave it out";
            selected.unsuitable(track.folder(), problem)
        })?;
        let step_s = selected.dataset.read_frame_time(&track.scene, &track.name)?;
        let mut list = "#timestamp [ns],filename\n".to_string();
        for view in track.views() {
            let time = time(view, step_s);
            let _ = writeln!(list, "{time},{time}.png");
        }
        let camera = format!("{folder}/cam{number}");
        out.write(&format!("{camera}/data.csv"), list.as_bytes())?;
        out.write(&format!("{camera}/sensor.yaml"), camera_yaml(&k, 1.0 / step_s, stereo.as_ref()).as_bytes())?;
        let is_with_left = |left: &StereoRecord| selected.tracks.iter().any(|t| t.scene == track.scene && t.name == left.partner);
        if number == 1 && !stereo.as_ref().is_some_and(is_with_left) {
            let problem = "it is the right camera of a rig, which goes with the left one; choose both";
            return Err(selected.unsuitable(track.folder(), problem));
        }
        if number == 0 {
            let samples: Vec<MotionSample> = motion.samples().collect();
            out.write(&format!("{folder}/imu0/data.csv"), measurements(&samples).as_bytes())?;
            out.write(&format!("{folder}/imu0/sensor.yaml"), imu_yaml(motion.rate_hz()).as_bytes())?;
            out.write(&format!("{folder}/state_groundtruth_estimate0/data.csv"), truth(&samples).as_bytes())?;
        }
    }
    selected.each(|view| write_frame(selected, out, view))?;
    Ok(())
}

/// The folder `mav0` of a track, whether it is `cam0` or `cam1` there, and the rig that it is of.
fn place(selected: &SelectedFrames<'_>, track: &Track) -> Result<(String, usize, Option<StereoRecord>), ExportError> {
    let stereo = selected.dataset.read_stereo(&track.scene, &track.name)?;
    let right = stereo.as_ref().is_some_and(|stereo| stereo.side == StereoSide::Right);
    let first = stereo.as_ref().filter(|_| right).map_or(&track.name, |stereo| &stereo.partner);
    Ok((format!("{}_{first}/mav0", track.scene), usize::from(right), stereo))
}

/// The time of a frame, nanoseconds, as files are named.
fn time(view: View<'_>, step_s: f64) -> u64 {
    nanoseconds(f64::from(view.frame()) * step_s)
}

/// Seconds from frame 0 as nanoseconds of the sequence's clock.
fn nanoseconds(time_s: f64) -> u64 {
    START_S * 1_000_000_000 + (time_s * 1e9).round() as u64
}

/// The IMU stream, ideal.
fn measurements(motion: &[MotionSample]) -> String {
    let mut text = "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],\
                    a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n"
        .to_string();
    for MotionSample { time_s, angular_rate: w, specific_force: a, .. } in motion {
        let _ = writeln!(text, "{},{},{},{},{},{},{}", nanoseconds(*time_s), w.x, w.y, w.z, a.x, a.y, a.z);
    }
    text
}

/// Pose and velocity of the body; the biases of an ideal unit are 0.
fn truth(motion: &[MotionSample]) -> String {
    let mut text = "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], \
                    v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1], b_w_RS_S_y [rad s^-1], \
                    b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], b_a_RS_S_z [m s^-2]\n"
        .to_string();
    for MotionSample { time_s, position: p, rotation: q, velocity: v, .. } in motion {
        let time = nanoseconds(*time_s);
        let _ = writeln!(text, "{time},{},{},{},{},{},{},{},{},{},{},0,0,0,0,0,0", p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z);
    }
    text
}

/// A pose as in `sensor.yaml`: the transform from the sensor to the body.
fn pose_yaml(body_from_sensor: DMat3, shift_m: DVec3) -> String {
    let rows =
        DMat4::from_mat3_translation(body_from_sensor, shift_m).transpose().to_cols_array().map(|v| (v + 0.0).to_string()).join(", ");
    format!("T_BS:\n  cols: 4\n  rows: 4\n  data: [{rows}]\n")
}

fn camera_yaml(k: &Calibration, rate_hz: f64, stereo: Option<&StereoRecord>) -> String {
    let right = stereo.filter(|stereo| stereo.side == StereoSide::Right);
    let shift = DVec3::X * right.map_or(0.0, |stereo| stereo.baseline_m);
    let [[fx, _, cx], [_, fy, cy], _] = k.intrinsics.opencv_k();
    format!(
        "sensor_type: camera\ncomment: pinhole without distortion\n{}rate_hz: {rate_hz}\nresolution: [{}, {}]\ncamera_model: pinhole\n\
         intrinsics: [{fx}, {fy}, {cx}, {cy}]\ndistortion_model: radial-tangential\ndistortion_coefficients: [0.0, 0.0, 0.0, 0.0]\n",
        pose_yaml(k.body_from_opencv(), shift),
        k.intrinsics.width,
        k.intrinsics.height
    )
}

fn imu_yaml(rate_hz: f64) -> String {
    format!(
        "sensor_type: imu\ncomment: ideal, from the curve that the camera follows\n{}rate_hz: {rate_hz}\ngyroscope_noise_density: 0.0\n\
         gyroscope_random_walk: 0.0\naccelerometer_noise_density: 0.0\naccelerometer_random_walk: 0.0\n",
        pose_yaml(DMat3::IDENTITY, DVec3::ZERO)
    )
}

fn write_frame(selected: &SelectedFrames<'_>, out: &ExportFolder, view: View<'_>) -> Result<(), ExportError> {
    let (folder, number, _) = place(selected, view.track)?;
    let step_s = selected.dataset.read_frame_time(&view.track.scene, &view.track.name)?;
    let frame = selected.read(view, &SHOWN)?;
    let picture = tone_mapped(selected, view, &frame)?;
    let grey = |pixel: [u8; 3]| LUMA.iter().zip(pixel).map(|(weight, value)| weight * f64::from(value)).sum::<f64>().round() as u8;
    let values: Vec<u8> = picture.pixels().map(|pixel| grey([pixel[0], pixel[1], pixel[2]])).collect();
    let path = format!("{folder}/cam{number}/data/{}.png", time(view, step_s));
    out.write(&path, &grey8_png(frame.width, frame.height, &values))
}
