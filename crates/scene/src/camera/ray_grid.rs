//! Hypersim's non-parametric camera: a table of rays over the image, interpolated between its points.

use super::CameraError;
use enfilade_math::{DMat2, DVec2, DVec3};
use std::sync::Arc;

/// Steps of Newton's method, damped where the grid is uneven.
const STEPS: usize = 100;
/// Largest error of an inverse, as a slope.
const TOLERANCE: f64 = 1e-13;

/// Rays at the points of a regular grid over the image; between them their slopes x/−z and y/−z are interpolated bilinearly, so that
/// the grid of a pinhole is that pinhole everywhere.
///
/// The first ray belongs to the upper left *corner* of the image and the last to the lower right one, as in Hypersim's
/// `camera_lens_distortion.hdf5`. Camera space has x right, y up and z backward; every ray has z < 0.
#[derive(Clone, Debug, PartialEq)]
pub struct RayGrid {
    width: u32,
    height: u32,
    rows: usize,
    columns: usize,
    /// Row by row.
    slopes: Arc<[DVec2]>,
}

impl RayGrid {
    /// A grid over an image of `width` × `height` pixels. `rays` has `rows` × `columns` vectors of any length.
    ///
    /// # Errors
    /// When there are fewer than 2 × 2 rays or another number than stated, when one is not finite or does not look forward, or when
    /// the picture would fold over itself or be mirrored.
    pub fn new(width: u32, height: u32, rows: usize, columns: usize, rays: &[DVec3]) -> Result<Self, CameraError> {
        let wrong = |found: String, expected| Err(CameraError::new("ray grid", found, expected));
        if rows < 2 || columns < 2 || rays.len() != rows * columns {
            return wrong(format!("{} rays for {rows} x {columns}", rays.len()), "at least 2 x 2 rays, row by row");
        }
        if let Some(i) = rays.iter().position(|r| !(r.is_finite() && r.z < 0.0)) {
            let (row, column) = (i / columns, i % columns);
            return wrong(format!("{} at row {row}, column {column}", rays[i]), "finite rays with z < 0 (x right, y up, z backward)");
        }
        let grid = Self { width, height, rows, columns, slopes: rays.iter().map(|r| r.truncate() / -r.z).collect() };
        for (row, column) in (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| (row, column))) {
            let mut corners = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE].into_iter();
            // Columns go to the right and rows downward, against y.
            if !corners.all(|at| grid.cell(row, column, at).1.determinant() < 0.0) {
                let found = format!("a fold at row {row}, column {column}");
                return wrong(found, "rays that turn right along a row and down along a column");
            }
        }
        Ok(grid)
    }

    /// Pixels per row, and rows, of the image.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Rows and columns of the grid.
    pub fn shape(&self) -> [usize; 2] {
        [self.rows, self.columns]
    }

    /// The rays with z = −1, row by row.
    pub fn rays(&self) -> impl Iterator<Item = DVec3> {
        self.slopes.iter().map(|s| s.extend(-1.0))
    }

    /// Direction through the image point (x, y), with z = −1. Beyond the image the border's cells continue.
    pub fn ray(&self, x: f64, y: f64) -> DVec3 {
        self.slope(self.grid_from_image() * DVec2::new(x, y)).0.extend(-1.0)
    }

    /// Image point of a camera-space point in front of the camera; `None` when the search for it fails.
    pub fn project(&self, p_camera: DVec3) -> Option<(f64, f64)> {
        let wanted = p_camera.truncate() / -p_camera.z;
        let mut at = 0.5 * DVec2::new((self.columns - 1) as f64, (self.rows - 1) as f64);
        let (mut slope, mut jacobian) = self.slope(at);
        for _ in 0..STEPS {
            let error = slope - wanted;
            if error.length() <= TOLERANCE * (1.0 + wanted.length()) {
                let image = at / self.grid_from_image();
                return Some((image.x, image.y));
            }
            let step = jacobian.inverse() * error;
            // Halve the step until it leads nearer.
            let tries = (0..30).map(|i| at - step * 0.5f64.powi(i));
            let nearer = tries.map(|next| (next, self.slope(next))).find(|(_, (s, _))| (*s - wanted).length() < error.length());
            (at, (slope, jacobian)) = nearer?;
        }
        None
    }

    /// Grid steps per pixel, along x and y.
    fn grid_from_image(&self) -> DVec2 {
        DVec2::new((self.columns - 1) as f64 / f64::from(self.width), (self.rows - 1) as f64 / f64::from(self.height))
    }

    /// Slope at a point of the grid, and its derivatives.
    fn slope(&self, at: DVec2) -> (DVec2, DMat2) {
        let cell = |v: f64, n: usize| (v.max(0.0) as usize).min(n - 2);
        let (row, column) = (cell(at.y, self.rows), cell(at.x, self.columns));
        self.cell(row, column, at - DVec2::new(column as f64, row as f64))
    }

    /// Slope and derivatives at `at` within a cell.
    fn cell(&self, row: usize, column: usize, at: DVec2) -> (DVec2, DMat2) {
        let i = row * self.columns + column;
        let [a, b, c, d] = [i, i + 1, i + self.columns, i + self.columns + 1].map(|i| self.slopes[i]);
        let (top, bottom) = (a + (b - a) * at.x, c + (d - c) * at.x);
        let by_x = (b - a) * (1.0 - at.y) + (d - c) * at.y;
        (top + (bottom - top) * at.y, DMat2::from_cols(by_x, bottom - top))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Intrinsics;

    /// A grid over 64 × 48 pixels made from rays at its points.
    fn grid(rows: usize, columns: usize, ray: impl Fn(f64, f64) -> DVec3) -> Result<RayGrid, CameraError> {
        let at = |i: usize, n: usize, length: f64| length * i as f64 / (n - 1) as f64;
        let points = (0..rows).flat_map(|r| (0..columns).map(move |c| (at(c, columns, 64.0), at(r, rows, 48.0))));
        let rays: Vec<DVec3> = points.map(|(x, y)| ray(x, y)).collect();
        RayGrid::new(64, 48, rows, columns, &rays)
    }

    #[test]
    fn the_grid_of_a_pinhole_is_that_pinhole() {
        let k = Intrinsics { cx: 30.0, fy: 47.0, ..Intrinsics::from_fov_x(64, 48, 1.2) };
        let grid = grid(4, 5, |x, y| k.ray(x, y).normalize()).unwrap();
        for (x, y) in [(0.5, 0.5), (31.7, 40.1), (63.9, 0.1), (-2.0, 50.0)] {
            assert!((grid.ray(x, y) - k.ray(x, y)).length() < 1e-12);
            let (px, py) = grid.project(k.ray(x, y) * 2.5).unwrap();
            assert!((px - x).abs() < 1e-9 && (py - y).abs() < 1e-9);
        }
    }

    #[test]
    fn an_uneven_grid_projects_what_it_sees() {
        let k = Intrinsics::from_fov_x(64, 48, 1.4);
        let wavy = |x: f64, y: f64| {
            let r = k.ray(x, y);
            let bend = 0.04 * (3.0 * r.x).sin() * (2.5 * r.y).cos();
            DVec3::new(r.x * (1.0 - 0.15 * r.length_squared() + 0.15) + bend, r.y + bend, -1.0)
        };
        let grid = grid(13, 17, wavy).unwrap();
        for i in 0..64 * 48 {
            let (x, y) = (f64::from(i % 64) + 0.5, f64::from(i / 64) + 0.5);
            let (px, py) = grid.project(grid.ray(x, y) * 4.0).unwrap();
            assert!((px - x).abs() < 1e-9 && (py - y).abs() < 1e-9, "({x}, {y}) became ({px}, {py})");
        }
    }

    #[test]
    fn grids_that_are_no_camera_are_refused() {
        let k = Intrinsics::from_fov_x(64, 48, 1.4);
        let message = |g: Result<RayGrid, CameraError>| g.unwrap_err().to_string();
        assert!(message(grid(3, 3, |x, y| -k.ray(x, y))).contains("row 0, column 0"));
        assert!(message(grid(3, 3, |x, y| k.ray(64.0 - x, y))).contains("a fold at row 0, column 0"));
        assert!(message(RayGrid::new(64, 48, 2, 2, &[DVec3::NEG_Z; 3])).contains("3 rays for 2 x 2"));
    }
}
