//! Sensors to cameras: field of view by `fov`, its axis or a focal length, size by the film.

use super::reader::{Reader, spelling};
use super::transform;
use super::xml::Node;
use crate::ImportError;
use enfilade_math::{DAffine3, DMat3};

/// Mitsuba's film where none states its size.
const DEFAULT_FILM: (f64, f64) = (768.0, 576.0);

/// Diagonal of 35 mm film, mm, by which `focalLength` is measured.
const FILM_DIAGONAL_MM: f64 = 43.266_615_3;

/// The focal length of a sensor that states neither it nor a field of view.
const DEFAULT_FOCAL_LENGTH: &str = "50mm";

impl<'n> Reader<'n, '_> {
    /// Adds the camera of a sensor.
    pub(super) fn sensor(&mut self, node: &'n Node) -> Result<(), ImportError> {
        const KNOWN: [&str; 13] = [
            "fov",
            "fov_axis",
            "focal_length",
            "to_world",
            "near_clip",
            "far_clip",
            "focus_distance",
            "aperture_radius",
            "shutter_open",
            "shutter_close",
            "principal_point_offset_x",
            "principal_point_offset_y",
            "kc",
        ];
        match node.plugin.as_str() {
            "perspective" => (),
            "thinlens" => {
                let (radius, distance) = (node.float_or("aperture_radius", 0.0)?, node.float_or("focus_distance", 0.0)?);
                self.warn(
                    node,
                    format!(
                        "the thin lens (aperture_radius {radius}, focus_distance {distance}, in the file's units) was replaced by a \
                         pinhole: everything is in focus; `lens` in [camera] of dataset.toml gives all cameras one"
                    ),
                );
            }
            other => {
                self.warn(node, format!("{other} sensors are not supported{}; the camera was left out", spelling(other)));
                return Ok(());
            }
        }
        self.report_unknown(node, &KNOWN, &["film", "sampler", "medium"]);
        if let Some(medium) = self.objects(node, "medium")?.first() {
            self.warn(medium, "media outside of shapes are not supported; it was left out");
        }
        for offset in ["principal_point_offset_x", "principal_point_offset_y"] {
            let found = node.float_or(offset, 0.0)?;
            if found != 0.0 {
                self.warn(
                    node,
                    format!("{offset} {found} was set to zero; `principal_point` in [camera] of dataset.toml shifts all cameras"),
                );
            }
        }
        if transform::is_animated(node, "to_world") {
            self.warn(node, "the camera is animated; its first moment was used");
        }
        let film = self.objects(node, "film")?.first().copied();
        let size = |name: &str, default: f64| film.map_or(Ok(default), |f| f.float_or(name, default));
        let (width, height) = (size("width", DEFAULT_FILM.0)?, size("height", DEFAULT_FILM.1)?);
        let fov_x = fov_x_rad(node, width, height)?;
        // Mitsuba looks along +z with x to the left.
        let file_from_mitsuba = transform::of(node, "to_world")?;
        if file_from_mitsuba.matrix3.determinant() < 0.0 {
            self.warn(node, "the camera's placement mirrors the picture; it was turned into one that does not");
        }
        let file_from_camera = file_from_mitsuba * DAffine3::from_mat3(DMat3::from_diagonal([-1.0, 1.0, -1.0].into()));
        let name = node.id.as_deref().unwrap_or("camera");
        self.a.push_camera(name, file_from_camera, fov_x, width / height);
        Ok(())
    }
}

/// The horizontal field of view that `fov` and `fovAxis`, else `focalLength`, state.
fn fov_x_rad(node: &Node, width: f64, height: f64) -> Result<f64, ImportError> {
    let diagonal = width.hypot(height);
    let (extent, half_tangent) = match node.float("fov")? {
        None => {
            let text = node.raw_text("focal_length").unwrap_or(DEFAULT_FOCAL_LENGTH);
            let length: Option<f64> = text.trim().trim_end_matches("mm").trim().parse().ok().filter(|l| *l > 0.0);
            let length = length.ok_or_else(|| node.error(format!("found the focal length {text:?}, expected a number of millimetres")))?;
            (diagonal, 0.5 * FILM_DIAGONAL_MM / length)
        }
        Some(fov) => {
            let extent = match node.text("fov_axis").as_deref() {
                None | Some("x") => width,
                Some("y") => height,
                Some("diagonal") => diagonal,
                Some("smaller") => width.min(height),
                Some("larger") => width.max(height),
                Some(other) => return Err(node.error(format!("found fovAxis {other:?}, expected x, y, diagonal, smaller or larger"))),
            };
            (extent, (0.5 * fov.to_radians()).tan())
        }
    };
    Ok(2.0 * (half_tangent * width / extent).atan())
}
