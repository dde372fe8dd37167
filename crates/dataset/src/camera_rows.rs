//! The rows of `metadata_camera_parameters.csv`: ours, and those of all scenes of Hypersim's own table.

use crate::DatasetError;
use crate::tables::Table;
use enfilade_math::{DMat3, DMat4};
use enfilade_scene::{Intrinsics, Projection, TiltedPinhole};
use std::path::{Path, PathBuf};

/// A table of cameras in memory, one row per scene.
#[derive(Clone, Debug)]
pub struct CameraTable {
    path: PathBuf,
    table: Table,
    names: usize,
}

impl CameraTable {
    /// Reads the table at `path`.
    ///
    /// # Errors
    /// When it is missing or no such table.
    pub fn read(path: &Path) -> Result<Self, DatasetError> {
        let table = Table::read(path).map_err(|error| match error.is_not_found() {
            true => DatasetError::NoCameraTable { path: path.to_path_buf() },
            false => error,
        })?;
        let strange = |_| {
            let problem = "line 1: no column \"scene_name\", so it is no table of cameras; for a dataset of ours run the plan stage again";
            DatasetError::text(path, problem)
        };
        Ok(Self { path: path.to_path_buf(), names: table.column("scene_name").map_err(strange)?, table })
    }

    /// The scenes that have a row, in the order of the rows.
    pub fn scenes(&self) -> impl Iterator<Item = &str> {
        self.table.rows.iter().map(|row| row[self.names].as_str())
    }

    /// The scene's row: names of columns and their values.
    ///
    /// # Errors
    /// When the scene has none.
    pub fn cells(&self, scene: &str) -> Result<Vec<[&str; 2]>, DatasetError> {
        let row = &self.table.rows[self.row(scene)?];
        Ok(self.table.header.iter().zip(row).map(|(name, cell)| [name.as_str(), cell]).collect())
    }

    /// The scene's pinhole, from `M_cam_from_uv`; Hypersim's tilt-shift cameras have a tilted image plane.
    ///
    /// # Errors
    /// When the scene has no row, or its matrix is empty or no pinhole's.
    pub fn projection(&self, scene: &str) -> Result<Projection, DatasetError> {
        let row = self.row(scene)?;
        let size = (self.pixels(row, "width")?, self.pixels(row, "height")?);
        let mut cam_from_uv = DMat3::ZERO;
        for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
            cam_from_uv.col_mut(j)[i] = self.number(row, &format!("M_cam_from_uv_{i}{j}"))?;
        }
        if let Some(intrinsics) = intrinsics_from_uv(size, cam_from_uv) {
            return Ok(Projection::Pinhole(intrinsics));
        }
        let wrong = |error| DatasetError::text(&self.path, format!("line {}: scene {scene:?}: {error}", row + 2));
        Ok(Projection::TiltedPinhole(TiltedPinhole::new(size.0, size.1, cam_from_uv).map_err(wrong)?))
    }

    /// The scene's `M_proj`: takes camera space to clip space.
    ///
    /// # Errors
    /// When the scene has no row, or its matrix is empty.
    pub fn projection_matrix(&self, scene: &str) -> Result<DMat4, DatasetError> {
        let row = self.row(scene)?;
        let mut projection = DMat4::ZERO;
        for (i, j) in (0..16).map(|k| (k / 4, k % 4)) {
            projection.col_mut(j)[i] = self.number(row, &format!("M_proj_{i}{j}"))?;
        }
        Ok(projection)
    }

    /// Metres per asset unit of the scene.
    ///
    /// # Errors
    /// When the scene has no row, or the row lacks the value.
    pub fn meters_per_asset_unit(&self, scene: &str) -> Result<f64, DatasetError> {
        self.number(self.row(scene)?, "settings_units_info_meters_scale")
    }

    fn row(&self, scene: &str) -> Result<usize, DatasetError> {
        let row = self.scenes().position(|name| name == scene);
        row.ok_or_else(|| DatasetError::text(&self.path, format!("no row for the scene {scene:?}; run the plan stage for it")))
    }

    fn number(&self, row: usize, column: &str) -> Result<f64, DatasetError> {
        self.table.parse(row, self.table.column(column)?)
    }

    /// Width or height of the images, which the table has as floating-point numbers.
    fn pixels(&self, row: usize, side: &str) -> Result<u32, DatasetError> {
        let value = self.number(row, &format!("settings_output_img_{side}"))?;
        let whole = value >= 1.0 && value <= f64::from(u16::MAX) && value.fract() == 0.0;
        let problem = || format!("line {}: the image's {side} is {value}; expected a whole number of pixels, 1 to {}", row + 2, u16::MAX);
        if whole { Ok(value as u32) } else { Err(DatasetError::text(&self.path, problem())) }
    }
}

/// The inverse of [`Intrinsics::cam_from_uv`] up to the matrix's scale; `None` when the image plane is tilted.
fn intrinsics_from_uv((width, height): (u32, u32), cam_from_uv: DMat3) -> Option<Intrinsics> {
    let m = cam_from_uv * (-1.0 / cam_from_uv.z_axis.z);
    let rest = [m.x_axis.y, m.x_axis.z, m.y_axis.z];
    let (w, h) = (0.5 * f64::from(width), 0.5 * f64::from(height));
    if !m.is_finite() || rest.iter().any(|v| v.abs() > 1e-9) || m.x_axis.x <= 0.0 || m.y_axis.y <= 0.0 {
        return None;
    }
    let (fx, fy) = (w / m.x_axis.x, h / m.y_axis.y);
    // A shear this small is a rounding error.
    let sheared = m.y_axis.x.abs() > 1e-9;
    let skew = if sheared { m.y_axis.x * fx * fy / h } else { 0.0 };
    Some(Intrinsics { width, height, fx, fy, cx: w - m.z_axis.x * fx + skew * m.z_axis.y, cy: h + m.z_axis.y * fy, skew })
}
