//! `enfilade.Light`: lights of scenes that are no surfaces.

use crate::numbers::{color, three, within};
use enfilade_math::{DVec3, Rgb, Vec3};
use enfilade_scene::SpotFalloff;
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// A light without a surface; `Light.point`, `Light.spot` and `Light.sun` make one. Lamps that are seen have a surface: a part with a
/// `Material(emission=...)`.
#[pyclass(module = "enfilade", frozen)]
pub struct Light(pub enfilade_scene::Light);

#[pymethods]
impl Light {
    /// A light that shines from a point to all sides.
    ///
    /// position: x, y and z, metres. intensity: W/sr, one number or linear red, green and blue; a bulb of p watts of light has p / (4 pi).
    #[staticmethod]
    #[pyo3(signature = (position, intensity, *, name="light"))]
    fn point(position: &Bound<'_, PyAny>, intensity: &Bound<'_, PyAny>, name: &str) -> PyResult<Self> {
        let (position, intensity) = (place("position", position)?, color("intensity", intensity, 0.0..=f64::INFINITY)?);
        Ok(Self(enfilade_scene::Light::Point { name: name.into(), position: position.as_vec3(), intensity }))
    }

    /// A light that shines from a point within a cone.
    ///
    /// position, target: where it is and what it shines at, metres. intensity: on the axis, W/sr, one number or linear red, green and blue.
    /// angle_deg: across the cone, more than 0 and less than 180 degrees. soft: share of the cone in which it dims, from 0 (a sharp border) to 1.
    #[staticmethod]
    #[pyo3(signature = (position, target, intensity, *, angle_deg=60.0, soft=0.2, name="spot"))]
    fn spot(
        position: &Bound<'_, PyAny>,
        target: &Bound<'_, PyAny>,
        intensity: &Bound<'_, PyAny>,
        angle_deg: f64,
        soft: f64,
        name: &str,
    ) -> PyResult<Self> {
        let (position, target) = (place("position", position)?, place("target", target)?);
        if !(angle_deg > 0.0 && angle_deg < 180.0) {
            return Err(PyValueError::new_err(format!("angle_deg is {angle_deg}; expected more than 0 and less than 180")));
        }
        let outer_rad = (0.5 * angle_deg).to_radians();
        Ok(Self(enfilade_scene::Light::Spot {
            name: name.into(),
            position: position.as_vec3(),
            direction: direction("target - position", target - position)?,
            intensity: color("intensity", intensity, 0.0..=f64::INFINITY)?,
            inner_rad: (outer_rad * (1.0 - within("soft", soft, 0.0..=1.0)?)) as f32,
            outer_rad: outer_rad as f32,
            falloff: SpotFalloff::SmoothAngle,
        }))
    }

    /// Light from far away, as of the sun.
    ///
    /// direction: in which light travels, of any length. irradiance: of a surface that faces it, W/m2, one number or linear red, green and blue.
    /// angle_deg: across its disk, 0 (parallel light) to 90 degrees; the sun's unless given.
    #[staticmethod]
    #[pyo3(signature = (direction, irradiance, *, angle_deg=0.533, name="sun"))]
    fn sun(direction: &Bound<'_, PyAny>, irradiance: &Bound<'_, PyAny>, angle_deg: f64, name: &str) -> PyResult<Self> {
        let along = place("direction", direction)?;
        Ok(Self(enfilade_scene::Light::Directional {
            name: name.into(),
            direction: self::direction("direction", along)?,
            irradiance: color("irradiance", irradiance, 0.0..=f64::INFINITY)?,
            angular_radius_rad: (0.5 * within("angle_deg", angle_deg, 0.0..=90.0)?).to_radians() as f32,
        }))
    }

    /// "point", "spot", "profile" (a measured distribution, from files alone) or "sun".
    #[getter]
    fn kind(&self) -> &'static str {
        match &self.0 {
            enfilade_scene::Light::Point { .. } => "point",
            enfilade_scene::Light::Spot { .. } => "spot",
            enfilade_scene::Light::Profile { .. } => "profile",
            enfilade_scene::Light::Directional { .. } => "sun",
        }
    }

    /// Name of the light.
    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    /// Where it is, metres; None for light from far away.
    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        use enfilade_scene::Light::{Directional, Point, Profile, Spot};
        match &self.0 {
            Point { position, .. } | Spot { position, .. } | Profile { position, .. } => Some(numbers(py, *position)),
            Directional { .. } => None,
        }
    }

    /// In which light travels, on the axis of a spot, of length 1; None for lights that shine to all sides.
    #[getter]
    fn direction<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        use enfilade_scene::Light::{Directional, Point, Profile, Spot};
        match &self.0 {
            Spot { direction, .. } | Directional { direction, .. } => Some(numbers(py, *direction)),
            Point { .. } | Profile { .. } => None,
        }
    }

    /// Red, green and blue, W/sr (of a profile, the factor of its candela); None for light from far away.
    #[getter]
    fn intensity<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        use enfilade_scene::Light::{Directional, Point, Profile, Spot};
        match &self.0 {
            Point { intensity, .. } | Spot { intensity, .. } | Profile { intensity, .. } => Some(channels(py, *intensity)),
            Directional { .. } => None,
        }
    }

    /// Red, green and blue, W/m2, of a surface that faces light from far away; None for others.
    #[getter]
    fn irradiance<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        match &self.0 {
            enfilade_scene::Light::Directional { irradiance, .. } => Some(channels(py, *irradiance)),
            _ => None,
        }
    }

    fn __repr__(&self) -> String {
        format!("<enfilade.Light {:?}: {}>", self.name(), self.kind())
    }
}

/// Three finite numbers.
fn place(name: &str, value: &Bound<'_, PyAny>) -> PyResult<DVec3> {
    let found = DVec3::from(three(name, value)?);
    if found.is_finite() { Ok(found) } else { Err(PyValueError::new_err(format!("{name} is {found}; expected finite numbers"))) }
}

fn direction(name: &str, along: DVec3) -> PyResult<Vec3> {
    let unit = along.try_normalize().map(|unit| unit.as_vec3());
    unit.ok_or_else(|| PyValueError::new_err(format!("{name} is {along}; expected a direction")))
}

fn numbers(py: Python<'_>, v: Vec3) -> Bound<'_, PyArray1<f64>> {
    PyArray1::from_slice(py, &v.as_dvec3().to_array())
}

fn channels(py: Python<'_>, c: Rgb) -> Bound<'_, PyArray1<f64>> {
    PyArray1::from_slice(py, &c.to_array().map(f64::from))
}
