//! `enfilade.Camera`: what a picture is taken with and from where, in OpenCV's conventions.

use crate::errors::IntoPy;
use crate::{json, numbers};
use enfilade_dataset::OpencvCalibration;
use enfilade_math::{DMat3, DVec3, nearest_rotation};
use enfilade_pipeline::{CameraConfig, CameraModel, LensConfig};
use enfilade_scene::{Intrinsics, Pose, StartCamera};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// A matrix that is off by more is not a rotation; rotations in single precision are off by less.
const ORTHONORMAL: f64 = 1e-4;
/// Greatest error of a number of double precision.
const EXACT: f64 = 1e-9;

/// A camera at a place, in OpenCV's conventions: camera axes x right, y down, z forward; image coordinates in which (0, 0) is the centre of the
/// upper left pixel. The world is right-handed with z up, in metres.
///
/// K: 3 x 3, pixels; None for a panorama.
/// size: width and height of the picture, pixels.
/// world_from_camera: 4 x 4, camera to world, metres: K and pose are those that samples of `enfilade.Dataset` have.
/// model: "pinhole", "radial_tangential" or "fisheye" (OpenCV's distortion), or "equirectangular" (a panorama).
/// distortion: OpenCV's coefficients: k1 k2 p1 p2 [k3 [k4 k5 k6]] of radial_tangential, k1 k2 k3 k4 of fisheye.
/// lens: depth of field, as [camera.lens] of dataset.toml has it: a dictionary of `focus_distance_m` and `aperture_radius_m`, or `f_number` and
/// `focal_length_mm`; `blades`, `focus_tilt_deg`.
/// name: what pictures say they were taken with.
///
/// `Camera.look_at` makes one from two points, `Scene.camera` finds a good place.
#[pyclass(module = "enfilade", frozen)]
pub struct Camera {
    /// What it is.
    pub camera: enfilade_scene::Camera,
    /// Where it stands; frame 0.
    pub pose: Pose,
    /// What it is called.
    pub name: String,
    model: String,
    lens: Option<LensConfig>,
}

impl Camera {
    /// A pinhole of this field of view.
    pub fn pinhole([width, height]: [u32; 2], fov_x_deg: f64, pose: Pose, name: String) -> PyResult<Self> {
        if !(fov_x_deg > 0.0 && fov_x_deg < 180.0) {
            return Err(PyValueError::new_err(format!("fov_x_deg is {fov_x_deg}; expected an angle between 0 and 180")));
        }
        let camera = enfilade_scene::Camera::from(Intrinsics::from_fov_x(width, height, fov_x_deg.to_radians()));
        camera.validate().map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(Self { camera, pose, name, model: "pinhole".into(), lens: None })
    }

    /// The camera of a scene that stands where this one does and sees as wide, under its name or another.
    pub fn start(&self, name: Option<String>) -> PyResult<StartCamera> {
        let fov_x_rad = self.camera.projection.fov_x_rad(std::f64::consts::TAU);
        if fov_x_rad >= std::f64::consts::PI {
            return Err(PyValueError::new_err(format!(
                "the camera {:?} sees half of the world or more; cameras of scenes are pinholes",
                self.name
            )));
        }
        let ([width, height], Pose { position, world_from_camera, .. }) = (self.camera.size(), self.pose);
        let aspect = f64::from(width) / f64::from(height);
        Ok(StartCamera { name: name.unwrap_or_else(|| self.name.clone()), position, world_from_camera, fov_x_rad, aspect })
    }

    fn calibration(&self) -> OpencvCalibration {
        OpencvCalibration::of(&self.camera.projection)
    }

    fn coefficients(&self) -> Vec<f64> {
        self.calibration().distortion
    }
}

/// A matrix of that many rows and columns, from anything that numpy can convert to an array.
fn matrix<const R: usize, const C: usize>(name: &str, value: &Bound<'_, PyAny>) -> PyResult<[[f64; C]; R]> {
    let array = numbers::array(value)?;
    let array = array.as_array();
    let wrong = |found: String| Err(PyValueError::new_err(format!("{name} {found}; expected {R} x {C} finite numbers")));
    if array.shape() != [R, C] {
        return wrong(format!("has the shape {:?}", array.shape()));
    }
    if let Some(v) = array.iter().find(|v| !v.is_finite()) {
        return wrong(format!("has the entry {v}"));
    }
    Ok(std::array::from_fn(|i| std::array::from_fn(|j| array[[i, j]])))
}

/// The pose of a matrix in OpenCV's axes.
fn pose(m: [[f64; 4]; 4]) -> PyResult<Pose> {
    let column = |j: usize| DVec3::new(m[0][j], m[1][j], m[2][j]);
    // Zero minus, so that 0 does not become −0.
    let world_from_camera = DMat3::from_cols(column(0), DVec3::ZERO - column(1), DVec3::ZERO - column(2));
    let position = column(3);
    let pose = Pose { frame: 0, position, look_at: position - world_from_camera.z_axis, world_from_camera };
    let off = pose.orthonormality_error();
    if off > ORTHONORMAL || world_from_camera.determinant() < 0.0 || m[3] != [0.0, 0.0, 0.0, 1.0] {
        let expected = "a rotation and a translation over the row 0 0 0 1, as of a camera whose x is right, y down and z forward";
        return Err(PyValueError::new_err(format!("world_from_camera is {m:?}, off by {off:.1e}; expected {expected}")));
    }
    // A matrix in single precision becomes the nearest rotation; an exact rotation keeps its bits.
    let nearest = || nearest_rotation(world_from_camera).unwrap_or(world_from_camera);
    Ok(if off > EXACT { Pose { world_from_camera: nearest(), ..pose } } else { pose })
}

/// The model of that name.
fn model(name: &str) -> PyResult<CameraModel> {
    match name {
        "pinhole" => Ok(CameraModel::Pinhole),
        "radial_tangential" => Ok(CameraModel::RadialTangential),
        "fisheye" => Ok(CameraModel::Fisheye),
        "equirectangular" => Ok(CameraModel::Equirectangular),
        other => {
            let expected = "\"pinhole\", \"radial_tangential\", \"fisheye\" or \"equirectangular\"";
            Err(PyValueError::new_err(format!("model is {other:?}; expected {expected}")))
        }
    }
}

#[pymethods]
impl Camera {
    #[new]
    #[pyo3(signature = (K, size, world_from_camera, *, model="pinhole", distortion=None, lens=None, name="camera"))]
    #[allow(non_snake_case, reason = "K is what everybody calls it")]
    fn new(
        K: Option<&Bound<'_, PyAny>>,
        size: [u32; 2],
        world_from_camera: &Bound<'_, PyAny>,
        model: &str,
        distortion: Option<Vec<f64>>,
        lens: Option<&Bound<'_, PyDict>>,
        name: &str,
    ) -> PyResult<Self> {
        let k = K.map(|k| matrix("K", k)).transpose()?;
        let kind = self::model(model)?;
        if k.is_none() && kind != CameraModel::Equirectangular {
            return Err(PyValueError::new_err(format!("K is None; a camera of the model {model:?} needs it")));
        }
        let lens: Option<LensConfig> = lens.map(|lens| json::from_python(lens.as_any())).transpose()?;
        let config = CameraConfig { model: kind, k, distortion, lens, ..CameraConfig::default() };
        let camera = config.make(size).map_err(IntoPy::into_py)?;
        let pose = pose(matrix("world_from_camera", world_from_camera)?)?;
        Ok(Self { camera, pose, name: name.into(), model: model.into(), lens })
    }

    /// A pinhole at `position` that looks at `target`, both in the world, metres.
    ///
    /// size: width and height, pixels. fov_x_deg: horizontal field of view, degrees. up: what is up in the picture.
    #[staticmethod]
    #[pyo3(signature = (position, target, size=[640, 480], fov_x_deg=60.0, *, up=[0.0, 0.0, 1.0], name="camera"))]
    fn look_at(position: [f64; 3], target: [f64; 3], size: [u32; 2], fov_x_deg: f64, up: [f64; 3], name: &str) -> PyResult<Self> {
        let numbers = [position, target, up].concat();
        let pose = Pose::look_at(0, position.into(), target.into(), up.into()).filter(|_| numbers.iter().all(|v| v.is_finite()));
        let none = || format!("there is no view from {position:?} to {target:?} with {up:?} up; expected two places, not along it");
        Self::pinhole(size, fov_x_deg, pose.ok_or_else(|| PyValueError::new_err(none()))?, name.into())
    }

    /// 3 x 3, pixels, before distortion; None for panoramas.
    #[getter(K)]
    fn k<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let rows = self.calibration().intrinsics.map(|k| k.opencv_k().concat());
        rows.map(|rows| PyArray1::from_vec(py, rows).reshape([3, 3])).transpose()
    }

    /// Width and height, pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        self.camera.size().into()
    }

    /// 4 x 4, camera (x right, y down, z forward) to world, metres.
    #[getter]
    fn world_from_camera<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        PyArray1::from_vec(py, self.calibration().world_from_camera(&self.pose).concat()).reshape([4, 4])
    }

    /// Where it stands in the world, metres.
    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.pose.position.to_array())
    }

    /// "pinhole", "radial_tangential", "fisheye" or "equirectangular".
    #[getter]
    fn model(&self) -> &str {
        &self.model
    }

    /// OpenCV's coefficients; none for pinholes and panoramas.
    #[getter]
    fn distortion(&self) -> Vec<f64> {
        self.coefficients()
    }

    /// What pictures say they were taken with.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let named = PyDict::new(py);
        named.set_item("model", &self.model)?;
        let coefficients = self.coefficients();
        named.set_item("distortion", if coefficients.is_empty() { None } else { Some(coefficients) })?;
        named.set_item("lens", self.lens.map(|lens| json::to_python(py, &lens)).transpose()?)?;
        named.set_item("name", &self.name)?;
        let (k, size, pose) = (self.k(py)?, self.size(), self.world_from_camera(py)?);
        Ok(((k, size, pose).into_pyobject(py)?, named))
    }

    fn __repr__(&self) -> String {
        let ([width, height], [x, y, z]) = (self.camera.size(), self.pose.position.to_array());
        let fov_deg = self.camera.projection.fov_x_rad(std::f64::consts::TAU).to_degrees();
        format!(
            "<enfilade.Camera {:?}: {} of {width} x {height}, {fov_deg:.1} degrees wide, at ({x:.2}, {y:.2}, {z:.2}) m>",
            self.name, self.model
        )
    }
}
