//! The section `[camera]`: what the pictures are taken with.

use crate::error::Error;
use enfilade_dataset::read_ray_grid;
use enfilade_math::DMat3;
use enfilade_scene::{Camera, CameraError, Fisheye, Intrinsics, Projection, RadialTangential, Shutter, ThinLens, TiltedPinhole};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The camera of a scene's pictures. The default is a pinhole in focus, at rest for each frame.
///
/// The image size and the field of view are keys of `[render]`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CameraConfig {
    /// Which direction belongs to which image point.
    pub model: CameraModel,
    /// OpenCV's camera matrix in pixels, row by row, with pixel centres at whole numbers; without it the field of view and
    /// `principal_point` count.
    #[serde(rename = "K")]
    pub k: Option<[[f64; 3]; 3]>,
    /// Width and height of the images that `K` is of; without it that of `[render]`. `K` is scaled where the pictures differ.
    #[serde(rename = "K_size")]
    pub k_size: Option<[u32; 2]>,
    /// Where the viewing axis meets the image, as shares of width and height from the upper left corner: a shifted lens.
    pub principal_point: Option<[f64; 2]>,
    /// OpenCV's coefficients: k1 k2 p1 p2 [k3 [k4 k5 k6]] for `radial_tangential`, k1 k2 k3 k4 for `fisheye`.
    pub distortion: Option<Vec<f64>>,
    /// Hypersim's `M_cam_from_uv`, row by row, for `tilted_pinhole`.
    pub cam_from_uv: Option<[[f64; 3]; 3]>,
    /// File of rows × columns × 3 rays in Hypersim's form, for `ray_grid`.
    pub ray_grid: Option<String>,
    /// Depth of field.
    pub lens: Option<LensConfig>,
    /// Motion blur and rolling shutter.
    pub shutter: Option<Shutter>,
    /// A second camera beside each.
    pub stereo: Option<StereoConfig>,
}

/// The camera models.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs, reason = "Projection describes each one")]
pub enum CameraModel {
    #[default]
    Pinhole,
    TiltedPinhole,
    RadialTangential,
    Fisheye,
    Equirectangular,
    RayGrid,
}

/// A thin lens, by its radius or by f-number and focal length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LensConfig {
    /// Radius of the aperture, metres.
    pub aperture_radius_m: Option<f64>,
    /// Focal length over diameter of the aperture.
    pub f_number: Option<f64>,
    /// Focal length of the lens; it does not change the field of view.
    pub focal_length_mm: Option<f64>,
    /// Distance of what is in focus, metres.
    pub focus_distance_m: Option<f64>,
    /// Straight edges of the aperture; 0 is a circle.
    pub blades: u32,
    /// Turns the plane of focus about the camera's x and y axis, degrees.
    pub focus_tilt_deg: [f64; 2],
}

/// A stereo rig: the planned camera is the left one, and the right one stands beside it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StereoConfig {
    /// Distance between the two, metres.
    pub baseline_m: f64,
}

impl CameraConfig {
    /// True for the pinhole that is meant when nothing is said.
    pub(crate) fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// True for a model that is as wide as the field of view says.
    pub(crate) fn takes_field_of_view(&self) -> bool {
        self.k.is_none() && matches!(self.model, CameraModel::Pinhole | CameraModel::RadialTangential | CameraModel::Fisheye)
    }

    /// The horizontal fields of view that the model can have end here, degrees.
    pub(super) fn fov_limit_deg(&self) -> f64 {
        if self.model == CameraModel::Fisheye { 360.0 } else { 180.0 }
    }

    /// What is wrong with it, if anything, as far as that shows without its files.
    pub(super) fn problem(&self, size: [u32; 2]) -> Option<String> {
        if let Some(stereo) = self.stereo.filter(|s| !(s.baseline_m.is_finite() && s.baseline_m > 0.0)) {
            return Some(format!("baseline_m is {}; expected a length above 0", stereo.baseline_m));
        }
        let key = |there: bool, key: &str, models: &[CameraModel], names: &str| {
            (there && !models.contains(&self.model)).then(|| format!("`{key}` goes with model {names}"))
        };
        use CameraModel::{Fisheye, Pinhole, RadialTangential, RayGrid, TiltedPinhole};
        let with_k = [Pinhole, RadialTangential, Fisheye];
        let misplaced = key(self.k.is_some(), "K", &with_k, "pinhole, radial_tangential or fisheye")
            .or_else(|| key(self.principal_point.is_some(), "principal_point", &with_k, "pinhole, radial_tangential or fisheye"))
            .or_else(|| key(self.distortion.is_some(), "distortion", &with_k[1..], "radial_tangential or fisheye"))
            .or_else(|| key(self.cam_from_uv.is_some(), "cam_from_uv", &[TiltedPinhole], "tilted_pinhole"))
            .or_else(|| key(self.ray_grid.is_some(), "ray_grid", &[RayGrid], "ray_grid"));
        let both = (self.k.is_some() && self.principal_point.is_some()).then(|| "`K` has a principal point already".to_string());
        let missing = match self.model {
            TiltedPinhole if self.cam_from_uv.is_none() => Some("model tilted_pinhole needs `cam_from_uv`"),
            RayGrid if self.ray_grid.is_none() => Some("model ray_grid needs the file `ray_grid`"),
            _ => None,
        };
        let found = misplaced.or(both).or_else(|| self.problem_of_k()).or_else(|| missing.map(String::from));
        // Any grid will do to see what else is wrong.
        let flat = || Ok(Projection::Pinhole(Intrinsics::from_fov_x(size[0], size[1], 1.0)));
        found.or_else(|| self.build::<CameraError>(size, 1.0, flat).err().map(|error| error.to_string()))
    }

    /// What is wrong with K, of which [`CameraConfig::intrinsics`] reads five numbers.
    fn problem_of_k(&self) -> Option<String> {
        let Some([_, [below, ..], last]) = self.k else {
            return self.k_size.map(|_| "`K_size` goes with `K`".to_string());
        };
        let has_form = below == 0.0 && last == [0.0, 0.0, 1.0];
        (!has_form).then(|| "`K` should have the rows [fx, skew, cx], [0, fy, cy], [0, 0, 1]; is it transposed, or scaled?".to_string())
    }

    /// The camera of pictures of this size, 60 degrees wide where nothing says how wide they are. The file of a grid is a path as it stands.
    ///
    /// # Errors
    /// When a key is missing or does not go with the model, or a value is out of its range.
    pub fn make(&self, size: [u32; 2]) -> Result<Camera, Error> {
        let hint = "docs/cameras.md has the models and what each needs";
        if let Some(problem) = self.problem(size) {
            return Err(Error::usage(problem, hint));
        }
        self.camera(size, 60f64.to_radians(), |written| Ok(written.into()))
    }

    /// The camera of pictures of this size and horizontal field of view. `locate` finds the file of a grid.
    ///
    /// # Errors
    /// When the file of a grid cannot be read or is no camera, or a value is out of its range.
    pub(crate) fn camera(
        &self,
        size: [u32; 2],
        fov_x_rad: f64,
        locate: impl FnOnce(&str) -> Result<PathBuf, Error>,
    ) -> Result<Camera, Error> {
        let grid = || {
            let path = locate(self.ray_grid.as_deref().unwrap_or_default())?;
            Ok(Projection::RayGrid(read_ray_grid(&path, size).map_err(Error::stage)?))
        };
        self.build(size, fov_x_rad, grid)
    }

    fn build<E: FromCameraError>(&self, size: [u32; 2], fov_x_rad: f64, grid: impl FnOnce() -> Result<Projection, E>) -> Result<Camera, E> {
        let coefficients = || self.distortion.clone().unwrap_or_else(|| vec![0.0; 4]);
        let projection = match self.model {
            CameraModel::Pinhole => Projection::Pinhole(self.intrinsics(size, fov_x_rad)),
            CameraModel::TiltedPinhole => {
                let matrix = DMat3::from_cols_array_2d(&self.cam_from_uv.unwrap_or_default()).transpose();
                Projection::TiltedPinhole(TiltedPinhole::new(size[0], size[1], matrix).map_err(E::of)?)
            }
            CameraModel::RadialTangential => {
                Projection::RadialTangential(self.intrinsics(size, fov_x_rad), RadialTangential::new(&coefficients()).map_err(E::of)?)
            }
            CameraModel::Fisheye => {
                let found = coefficients();
                let wrong = |found: Vec<f64>| {
                    E::of(CameraError { field: "distortion", found: format!("{found:?}"), expected: "4 numbers: k1, k2, k3, k4" })
                };
                let fisheye = Fisheye::new(found.try_into().map_err(wrong)?).map_err(E::of)?;
                // Without K the picture is as wide as the equidistant one of that field of view.
                let f = f64::from(size[0]) / fov_x_rad;
                let equidistant = Intrinsics { fx: f, fy: f, ..self.intrinsics(size, 1.0) };
                Projection::Fisheye(if self.k.is_some() { self.intrinsics(size, 1.0) } else { equidistant }, fisheye)
            }
            CameraModel::Equirectangular => Projection::Equirectangular { width: size[0], height: size[1] },
            CameraModel::RayGrid => grid()?,
        };
        let lens = self.lens.map(|lens| lens.thin()).transpose().map_err(E::of)?;
        let camera = Camera { projection, lens, shutter: self.shutter };
        camera.validate().map_err(E::of)?;
        Ok(camera)
    }

    fn intrinsics(&self, size: [u32; 2], fov_x_rad: f64) -> Intrinsics {
        let centred = Intrinsics::from_fov_x(size[0], size[1], fov_x_rad);
        match (self.k, self.principal_point) {
            (None, None) => centred,
            (None, Some([x, y])) => Intrinsics { cx: x * f64::from(size[0]), cy: y * f64::from(size[1]), ..centred },
            (Some([[fx, skew, cx], [_, fy, cy], _]), _) => {
                let [w, h] = self.k_size.unwrap_or(size);
                let (x, y) = (f64::from(size[0]) / f64::from(w), f64::from(size[1]) / f64::from(h));
                Intrinsics { fx: fx * x, fy: fy * y, cx: (cx + 0.5) * x, cy: (cy + 0.5) * y, skew: skew * x, ..centred }
            }
        }
    }
}

/// Errors that can say what is wrong with a camera.
trait FromCameraError {
    fn of(error: CameraError) -> Self;
}

impl FromCameraError for CameraError {
    fn of(error: CameraError) -> Self {
        error
    }
}

impl FromCameraError for Error {
    fn of(error: CameraError) -> Self {
        Error::stage(error)
    }
}

impl LensConfig {
    fn thin(&self) -> Result<ThinLens, CameraError> {
        let radius = match (self.aperture_radius_m, self.f_number, self.focal_length_mm) {
            (Some(radius), None, None) => radius,
            (None, Some(n), Some(f)) => 0.5e-3 * f / n,
            _ => {
                let expected = "aperture_radius_m, or f_number and focal_length_mm";
                return Err(CameraError { field: "lens", found: "without its radius, or with two".into(), expected });
            }
        };
        let Some(focus_distance_m) = self.focus_distance_m else {
            return Err(CameraError { field: "focus_distance_m", found: "not given".into(), expected: "a length above 0" });
        };
        let focus_tilt_rad = self.focus_tilt_deg.map(f64::to_radians);
        Ok(ThinLens { aperture_radius_m: radius, focus_distance_m, blades: self.blades, focus_tilt_rad })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(text: &str, size: [u32; 2]) -> Result<Camera, String> {
        let config: CameraConfig = toml::from_str(text).map_err(|e| e.to_string())?;
        match config.problem(size) {
            Some(problem) => Err(problem),
            None => config.camera(size, 1.0, |_| Err(Error::usage("no file", ""))).map_err(|e| e.to_string()),
        }
    }

    #[test]
    fn nothing_said_is_a_pinhole() {
        assert_eq!(camera("", [64, 48]).unwrap(), Intrinsics::from_fov_x(64, 48, 1.0).into());
        let shifted = camera("principal_point = [0.5, 0.75]", [64, 48]).unwrap();
        assert_eq!(shifted, Intrinsics { cy: 36.0, ..Intrinsics::from_fov_x(64, 48, 1.0) }.into());
    }

    #[test]
    fn opencvs_matrix_is_taken_as_it_is_and_scaled_to_the_pictures() {
        let text = "K = [[500, 2, 319.5], [0, 510, 239.5], [0, 0, 1]]\nK_size = [640, 480]\nmodel = \"radial_tangential\"\n\
            distortion = [-0.1, 0.01, 0, 0]";
        let Projection::RadialTangential(k, _) = camera(text, [320, 240]).unwrap().projection else { panic!() };
        assert_eq!(k, Intrinsics { width: 320, height: 240, fx: 250.0, fy: 255.0, cx: 160.0, cy: 120.0, skew: 1.0 });
    }

    #[test]
    fn a_matrix_that_is_no_calibration_is_refused() {
        for text in
            ["[[500, 0, 0], [0, 500, 0], [320, 240, 1]]", "[[500, 0, 320], [0, 500, 240], [0, 0, 2]]", "[[5, 0, 3], [1, 5, 2], [0, 0, 1]]"]
        {
            assert!(camera(&format!("K = {text}"), [64, 48]).unwrap_err().contains("[0, fy, cy]"), "{text}");
        }
        assert_eq!(camera("K_size = [640, 480]", [64, 48]).unwrap_err(), "`K_size` goes with `K`");
    }

    #[test]
    fn lenses_are_given_by_radius_or_by_f_number() {
        let lens = |text: &str| camera(&format!("lens = {{ focus_distance_m = 2, {text} }}"), [64, 48]).map(|c| c.lens.unwrap());
        assert!((lens("f_number = 2, focal_length_mm = 50").unwrap().aperture_radius_m - 0.0125).abs() < 1e-15);
        assert_eq!(lens("aperture_radius_m = 0.01, blades = 6").unwrap().blades, 6);
        assert!(lens("f_number = 2").unwrap_err().contains("f_number and focal_length_mm"));
        assert!(camera("lens = { aperture_radius_m = 0.1 }", [8, 8]).unwrap_err().contains("focus_distance_m is not given"));
    }

    #[test]
    fn a_fisheye_is_as_wide_as_asked() {
        let Projection::Fisheye(k, _) = camera("model = \"fisheye\"", [100, 80]).unwrap().projection else { panic!() };
        assert_eq!((k.fx, k.cx, k.cy), (100.0, 50.0, 40.0));
        assert!(camera("model = \"fisheye\"\ndistortion = [1, 2]", [100, 80]).unwrap_err().contains("4 numbers"));
    }

    #[test]
    fn keys_of_other_models_are_refused() {
        assert_eq!(camera("distortion = [0, 0, 0, 0]", [8, 8]).unwrap_err(), "`distortion` goes with model radial_tangential or fisheye");
        assert!(camera("model = \"ray_grid\"", [8, 8]).unwrap_err().contains("needs the file `ray_grid`"));
        assert!(camera("model = \"tilted_pinhole\"", [8, 8]).unwrap_err().contains("`cam_from_uv`"));
        assert!(camera("stereo = { baseline_m = -1 }", [8, 8]).unwrap_err().contains("baseline_m is -1"));
        assert!(camera("shutter = { exposure_s = 2 }", [8, 8]).unwrap_err().contains("exposure_s is 2"));
    }
}
