//! `Camera` and the size of `Film` to a pinhole: screen windows, lenses and exposure are reported.

use super::params::Params;
use super::reader::Reader;
use super::version::Version;
use crate::ImportError;
use enfilade_math::{DAffine3, DMat3, DVec3};

/// Angle across the shorter edge of the picture, for cameras that have none.
const FALLBACK_FOV_DEG: f64 = 90.0;

impl Reader<'_> {
    /// Adds the camera, once the film behind it is known.
    pub(super) fn finish_camera(&mut self) -> Result<(), ImportError> {
        let Some((params, class, camera_from_world)) = self.camera.take() else { return Ok(()) };
        let film = self.film.take();
        self.report_exposure(&params, film.as_ref())?;
        let silent = ["shutteropen", "shutterclose", "focaldistance", "lensradius"];
        let radius = params.float_or("lensradius", 0.0)?;
        if radius > 0.0 {
            self.warn(
                &params.place,
                format!(
                    "the lens of radius {radius} was replaced by a pinhole: everything is in focus; `lens` in [camera] of dataset.toml \
                     gives all cameras one"
                ),
            );
        }
        let (fov_x, aspect) = field_of_view(&params, film.as_ref(), self.version)?;
        if let [left, right, bottom, top] = *params.numbers("screenwindow")?
            && (left + right != 0.0 || bottom + top != 0.0)
        {
            let message = "the screen window was put around the middle; `principal_point` in [camera] of dataset.toml shifts all cameras";
            self.warn(&params.place, message);
        }
        let fov_x = match class.as_str() {
            "perspective" => fov_x,
            _ => {
                self.warn(&params.place, "only perspective cameras are supported; a pinhole 90 degrees wide replaces it");
                params.ignore_all();
                2.0 * ((0.5 * FALLBACK_FOV_DEG.to_radians()).tan() * aspect.max(1.0)).atan()
            }
        };
        self.report_unused(&params, &silent);
        // pbrt looks along +z with x to the right.
        let to_ours = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0)));
        let file_from_camera = self.file_from_world * camera_from_world.inverse() * to_ours;
        self.a.push_camera("camera", file_from_camera, fov_x, aspect);
        Ok(())
    }

    /// Radiances stay as the file has them; a warning states the factor that the film would apply.
    fn report_exposure(&mut self, camera: &Params, film: Option<&Params>) -> Result<(), ImportError> {
        let Some(film) = film else { return Ok(()) };
        let time = camera.float_or("shutterclose", 1.0)? - camera.float_or("shutteropen", 0.0)?;
        let ratio = time * film.float_or("iso", 100.0)? / 100.0;
        let sensor = film.string("sensor")?.unwrap_or("cie1931").to_string();
        if self.version == Version::V4 && ((ratio - 1.0).abs() > 1e-6 || sensor != "cie1931") {
            let message =
                format!("radiances stay as they are; pbrt's picture is {ratio} times as bright, by its exposure, sensor {sensor}");
            self.warn(&film.place, message);
        }
        Ok(())
    }
}

/// Horizontal field of view in radians, and width over height. `fov` spans the shorter edge of the picture, or rather −1 … 1 of the
/// screen.
fn field_of_view(params: &Params, film: Option<&Params>, version: Version) -> Result<(f64, f64), ImportError> {
    let default = if version == Version::V3 { (640.0, 480.0) } else { (1280.0, 720.0) };
    let size = |name: &str, default: f64| film.map_or(Ok(default), |f| f.float_or(name, default));
    let (width, height) = (size("xresolution", default.0)?, size("yresolution", default.1)?);
    if !(width >= 1.0 && height >= 1.0) {
        return Err(params.place.error(format!("the film has {width}x{height} pixels, expected one each way at least")));
    }
    let aspect = params.float_or("frameaspectratio", width / height)?;
    let mut screen = [-aspect.max(1.0), aspect.max(1.0), -(1.0 / aspect).max(1.0), (1.0 / aspect).max(1.0)];
    let window = params.numbers("screenwindow")?;
    if let Ok(window) = <[f64; 4]>::try_from(window) {
        screen = window;
    } else if !window.is_empty() {
        return Err(params.place.error(format!("screenwindow has {} numbers, expected four", window.len())));
    }
    let [left, right, bottom, top] = screen;
    let half = params.float("halffov")?.unwrap_or(params.float_or("fov", 90.0)? / 2.0);
    Ok((2.0 * (half.to_radians().tan() * 0.5 * (right - left)).atan(), (right - left) / (top - bottom)))
}
