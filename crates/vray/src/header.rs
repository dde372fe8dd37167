//! The camera data that V-Ray writes into the header of an image, checked against the trajectory.
//!
//! `cameraTransform` has the camera's axes as rows and its centre as the fourth, in the scene's units. V-Ray 4 writes the axes as right,
//! backward, down; a writer that keeps the scene's own order (right, up, backward) is understood as well. `cameraFov` is the
//! horizontal field of view in degrees.

use crate::error::VrayError;
use crate::notes::Notes;
use enfilade_math::DVec3;
use enfilade_scene::Pose;
use exr::meta::attribute::AttributeValue;

/// Largest difference of two unit vectors; the header is float32.
const AXES: f64 = 1e-3;
/// Largest difference of two fields of view, degrees.
const FOV_DEG: f64 = 0.01;
/// Largest difference of two places, metres, and as a share of the larger coordinate: float32 again.
const PLACE_M: f64 = 1e-3;
const PLACE_SHARE: f64 = 1e-5;

/// The header's attributes that concern us.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Header {
    /// Right, backward, down and centre, or right, up, backward and centre.
    pub transform: Option<[f32; 16]>,
    /// Degrees.
    pub fov_x_deg: Option<f32>,
    /// Version of V-Ray.
    pub version: Option<String>,
    /// Seconds.
    pub rendering_s: Option<f64>,
}

impl Header {
    /// Takes an attribute of the file, if it is one of ours.
    pub fn take(&mut self, name: &str, value: &AttributeValue) {
        match (name, value) {
            ("cameraTransform", AttributeValue::Matrix4x4(m)) => self.transform = Some(*m),
            ("cameraFov", AttributeValue::F32(v)) => self.fov_x_deg = Some(*v),
            ("vrayInfo/vraycore", AttributeValue::Text(text)) => self.version = Some(text.to_string()),
            ("vrayInfo/rendertime", AttributeValue::Text(text)) => self.rendering_s = seconds(&text.to_string()),
            _ => {}
        }
    }

    /// Checks the camera against the pose and the field of view of the scene that was to be rendered; `place` names the image.
    ///
    /// # Errors
    /// When they differ; with `lenient` that is a note.
    pub fn check(&self, expected: &Expected<'_>, place: &str, lenient: bool, notes: &mut Notes) -> Result<(), VrayError> {
        if self.transform.is_none() || self.fov_x_deg.is_none() {
            notes.add("the header does not say where the camera stood or what it saw, so that is not checked", place);
        }
        let Some(problem) = self.problem(expected) else { return Ok(()) };
        if lenient {
            notes.add("the header's camera is not the trajectory's", &format!("{place}: {problem}"));
            return Ok(());
        }
        Err(VrayError::usage(
            format!("{place}: {problem}"),
            "the image is of another frame, camera, trajectory or unit: render it with the scene that `enfilade vray camera` or `jobs` made \
             for this dataset; --ignore-camera takes it as it is",
        ))
    }

    /// The problem with the camera, if any.
    fn problem(&self, expected: &Expected<'_>) -> Option<String> {
        let Expected { pose, fov_x_deg, meters_per_unit } = *expected;
        if let Some(transform) = &self.transform {
            let row = |i: usize| DVec3::new(f64::from(transform[4 * i]), f64::from(transform[4 * i + 1]), f64::from(transform[4 * i + 2]));
            let (found, stands) = (row(3), pose.position / meters_per_unit);
            let slack = PLACE_M / meters_per_unit + PLACE_SHARE * stands.abs().max_element();
            let off = (found - stands).length();
            if off.is_nan() || off > slack {
                return Some(format!("its camera stood at {found:.3}, and frame {} of the trajectory at {stands:.3} (units)", pose.frame));
            }
            let axes = pose.world_from_camera;
            let (right, up, backward) = (axes.x_axis, axes.y_axis, axes.z_axis);
            let same = |a: [DVec3; 3]| a.iter().enumerate().all(|(i, axis)| (row(i) - *axis).length() < AXES);
            if !same([right, backward, -up]) && !same([right, up, backward]) {
                let found = [row(0), row(1), row(2)].map(|axis| format!("{axis:.4}")).join(" ");
                return Some(format!(
                    "its camera's axes are {found}, and the trajectory's right, up, backward {right:.4} {up:.4} {backward:.4}"
                ));
            }
        }
        let fov = f64::from(self.fov_x_deg?);
        let off = (fov - fov_x_deg).abs();
        (off.is_nan() || off > FOV_DEG).then(|| format!("its camera sees {fov:.4} degrees, and the dataset's {fov_x_deg:.4} in V-Ray"))
    }
}

/// The values expected in the header.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Expected<'a> {
    pub pose: &'a Pose,
    /// Field of view of the pinhole in the scene, which is wider than the image where a lens bends it.
    pub fov_x_deg: f64,
    pub meters_per_unit: f64,
}

/// Seconds of a time as V-Ray writes it, ` 0h  1m 27.4s`.
fn seconds(text: &str) -> Option<f64> {
    let part = |part: &str| {
        let (number, unit) = part.split_at_checked(part.len().checked_sub(1)?)?;
        let scale = match unit {
            "d" => 86400.0,
            "h" => 3600.0,
            "m" => 60.0,
            "s" => 1.0,
            _ => return None,
        };
        number.parse::<f64>().ok().filter(|v| v.is_finite() && *v >= 0.0).map(|v| v * scale)
    };
    text.split_whitespace().map(part).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exr_file::VrayImage;

    fn pose() -> Pose {
        let position = DVec3::new(1.7, 0.2, 2.0);
        Pose::look_at(3, position, DVec3::ZERO, DVec3::Z).unwrap()
    }

    fn header(pose: &Pose, order: impl Fn(DVec3, DVec3, DVec3) -> [DVec3; 3]) -> Header {
        let m = pose.world_from_camera;
        let rows = order(m.x_axis, m.y_axis, m.z_axis).map(|axis| [axis.x, axis.y, axis.z, 0.0]);
        let p = pose.position / 0.01;
        let all: Vec<f32> = rows.iter().flatten().chain(&[p.x, p.y, p.z, 1.0]).map(|&v| v as f32).collect();
        Header { transform: all.try_into().ok(), fov_x_deg: Some(60.0), ..Header::default() }
    }

    fn problem(header: &Header) -> Option<String> {
        header.problem(&Expected { pose: &pose(), fov_x_deg: 60.0, meters_per_unit: 0.01 })
    }

    #[test]
    fn both_orders_of_the_axes_are_understood_and_differences_are_told() {
        for order in [|x, y: DVec3, z| [x, z, -y], |x, y, z| [x, y, z]] {
            assert_eq!(problem(&header(&pose(), order)), None);
        }
        assert!(problem(&header(&pose(), |x, y, z| [x, z, y])).unwrap().contains("axes"));
        let elsewhere = Pose { position: pose().position + DVec3::X * 0.01, ..pose() };
        assert!(problem(&header(&elsewhere, |x, y, z| [x, z, -y])).unwrap().contains("stood at"));
        let wide = Header { fov_x_deg: Some(60.1), ..header(&pose(), |x, y, z| [x, z, -y]) };
        assert!(problem(&wide).unwrap().contains("sees 60.1"));
    }

    /// Images of Hypersim's example of an empty scene, whose camera circles around the origin, are of its trajectory.
    #[test]
    fn a_real_image_of_v_ray_is_of_its_trajectory() {
        let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
            return eprintln!("skipped: ENFILADE_SCENES is not set");
        };
        let folder = std::path::Path::new(&scenes).join("hypersim-real/vray_empty_scene");
        let image = VrayImage::read(&folder.join("_empty_cam_quads_linear.0000.exr"), [1024, 768]).unwrap();
        let meters_per_unit = 0.0254;
        let position = meters_per_unit * DVec3::new(17000.0, 0.0, 20000.0);
        let pose = Pose::look_at(0, position, DVec3::ZERO, DVec3::Z).unwrap();
        let expected = Expected { pose: &pose, fov_x_deg: 45.0, meters_per_unit };
        assert_eq!(image.header.problem(&expected), None);
        assert_eq!((image.header.version.as_deref(), image.header.rendering_s), (Some("4.20.01"), Some(87.4)));
        let next = Pose::look_at(1, position + DVec3::Y, DVec3::ZERO, DVec3::Z).unwrap();
        assert!(image.header.problem(&Expected { pose: &next, ..expected }).unwrap().contains("frame 1 of the trajectory"));
        assert!(image.header.problem(&Expected { meters_per_unit: 0.01, ..expected }).unwrap().contains("stood at"));
        assert_eq!(image.triples("").unwrap().len(), 1024 * 768);
        assert!(image.ids("VRayRenderEntityID").unwrap_err().to_string().contains("it has no VRayRenderEntityID, only A, B, G, R"));
    }

    #[test]
    fn v_rays_times_are_seconds() {
        assert_eq!(seconds(" 0h  1m 27.5s"), Some(87.5));
        assert_eq!(seconds("1d 2h 0m 3s"), Some(93603.0));
        assert_eq!(seconds("soon"), None);
    }
}
