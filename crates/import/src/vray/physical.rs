//! `CameraPhysical`: which direction belongs to which place of the picture.
//!
//! V-Ray does not publish its formulas. These are the ones that Hypersim's maintainers found and checked against its pictures
//! (github.com/apple/ml-hypersim, contrib/mikeroberts3000, the notebook on camera intrinsics). Lengths are in units of the scene.

use super::plugins::Handle;
use crate::ImportError;
use enfilade_math::{DMat3, DVec3};

/// Least and greatest distance of the film behind the lens, units.
const FILM_DISTANCES: [f64; 2] = [1e-4, 500.0];

/// Halvings of that interval.
const STEPS: usize = 100;

/// Shifts and offsets below this bend nothing.
const NO_SHIFT: f64 = 1e-9;

/// Luminous exposure at the film over luminance × time / f-number², and that which ISO speed S takes for white, times S (ISO 12232).
const EXPOSURE_AT_FILM: f64 = 0.65;
const SATURATION: f64 = 78.0;

/// The value of `exposure` that takes `exposure_value` for ISO, shutter and f-number.
pub(super) const BY_EXPOSURE_VALUE: i64 = 2;

/// Beyond this, brighter than the sun or darker than any night, an exposure value is a mistake.
const MAX_EXPOSURE_VALUE: f64 = 64.0;

/// Factor of radiance by a camera's exposure; 1 if it is turned off.
///
/// White is what saturates a film of this speed by ISO 12232: L · t · S · 0.65 / (78 N²) for a luminance L in cd/m². V-Ray does not
/// publish its formula; this one gives the brightness of its own picture of Hypersim's empty scene to 0.1 % (docs/vray.md). An exposure
/// value EV is N² / t = 2^EV at ISO 100.
pub(super) fn exposure(camera: Handle, photometric_scale: f64) -> Result<f64, ImportError> {
    match camera.int("exposure", 1)? {
        0 => return Ok(1.0),
        BY_EXPOSURE_VALUE => {
            let ev = camera.number("exposure_value", 0.0)?;
            if ev.abs() > MAX_EXPOSURE_VALUE {
                let problem = format!("found {ev}, expected {} to {MAX_EXPOSURE_VALUE}; correct the value", -MAX_EXPOSURE_VALUE);
                return Err(camera.error("exposure_value", problem));
            }
            return Ok(EXPOSURE_AT_FILM * 100.0 / (SATURATION * ev.exp2() * photometric_scale));
        }
        _ => {}
    }
    let [speed, shutter, f] = [("ISO", 200.0), ("shutter_speed", 300.0), ("f_number", 8.0)].map(|(parameter, default)| {
        let found = camera.number(parameter, default)?;
        let problem = format!("found {found}, expected a number above zero; correct the value, or set exposure=0");
        if found > 0.0 { Ok(found) } else { Err(camera.error(parameter, problem)) }
    });
    let (speed, shutter, f) = (speed?, shutter?, f?);
    Ok(EXPOSURE_AT_FILM * speed / (SATURATION * shutter * f * f * photometric_scale))
}

/// The lens and film of a physical camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct Physical {
    film_width: f64,
    /// Width over height of the picture.
    aspect: f64,
    /// Distance of what is in focus.
    focus: f64,
    zoom: f64,
    horizontal_shift: f64,
    lens_shift: f64,
    offset: [f64; 2],
}

impl Physical {
    /// From the parameters of a plugin.
    pub(super) fn of(camera: Handle, aspect: f64, meters_per_unit: f64) -> Result<Self, ImportError> {
        let positive = |parameter: &str, default: f64| {
            let found = camera.number(parameter, default)?;
            let problem = format!("found {found}, expected a number above zero; correct the value");
            if found > 0.0 { Ok(found) } else { Err(camera.error(parameter, problem)) }
        };
        let focus = if camera.flag("specify_focus", false)? { "focus_distance" } else { "target_distance" };
        Ok(Self {
            film_width: positive("film_width", 36.0)? * 0.001 / meters_per_unit,
            aspect,
            focus: positive(focus, 200.0)?,
            zoom: positive("zoom_factor", 1.0)?,
            horizontal_shift: camera.number("horizontal_shift", 0.0)?,
            lens_shift: camera.number("lens_shift", 0.0)?,
            offset: [camera.number("horizontal_offset", 0.0)?, camera.number("vertical_offset", 0.0)?],
        })
    }

    /// True when the camera is not a pinhole whose axis goes through the middle of the picture.
    pub(super) fn is_shifted(&self) -> bool {
        [self.horizontal_shift, self.lens_shift, self.offset[0], self.offset[1]].iter().any(|v| v.abs() > NO_SHIFT)
    }

    /// Hypersim's `M_cam_from_uv` up to a factor, for a film at a distance behind the lens.
    fn at(&self, film_distance: f64) -> DMat3 {
        let k = -self.focus / film_distance;
        let (hs, ls) = (self.horizontal_shift, self.lens_shift);
        let kx = self.film_width * k / (self.zoom * (1.0 + hs * hs).sqrt());
        let ky = self.film_width * k / (self.zoom * (1.0 + ls * ls).sqrt());
        let [ho, vo] = self.offset;
        DMat3::from_cols(
            DVec3::new(-0.5 * kx, 0.0, 0.5 * hs * kx),
            DVec3::new(0.0, -0.5 * ky / self.aspect, 0.5 * ls * ky / self.aspect),
            DVec3::new(ho * kx, vo * ky, -self.focus - ls * vo * ky - hs * ho * kx),
        )
    }

    /// Width of the picture at distance 1 for a film at a distance; infinite where the lens does not see a border.
    fn width(&self, film_distance: f64) -> f64 {
        let m = self.at(film_distance);
        let side = |u: f64| {
            let ray = m * DVec3::new(u, 0.0, 1.0);
            if ray.z < 0.0 { -ray.x / ray.z } else { u * f64::INFINITY }
        };
        side(1.0) - side(-1.0)
    }

    /// Hypersim's `M_cam_from_uv` of a camera that sees `fov_x_rad`, with −1 in its lower right corner. `None` where no film sees that.
    pub(super) fn cam_from_uv(&self, fov_x_rad: f64) -> Option<DMat3> {
        let wanted = 2.0 * (0.5 * fov_x_rad).tan();
        let [mut near, mut far] = FILM_DISTANCES;
        // The nearer the film, the more it sees.
        if !(wanted > 0.0 && self.width(near) >= wanted && self.width(far) <= wanted) {
            return None;
        }
        for _ in 0..STEPS {
            let middle = 0.5 * (near + far);
            *(if self.width(middle) > wanted { &mut near } else { &mut far }) = middle;
        }
        let m = self.at(0.5 * (near + far));
        Some(m * (-1.0 / m.z_axis.z))
    }

    /// Horizontal field of view of a lens of a focal length, by the thin lens's equation.
    pub(super) fn fov_x_rad(&self, focal_length: f64) -> f64 {
        let film_distance = if self.focus > focal_length { focal_length * self.focus / (self.focus - focal_length) } else { focal_length };
        2.0 * (0.5 * self.width(film_distance)).atan()
    }
}
