//! Voxels of a model, as Pix3D keeps them.
//!
//! In the file the axes are x left, y outward, z up of the model, which is x left, y up, z inward; here they are the model's. Mesh R-CNN
//! centres the occupied voxels and scales them into the ball of diameter 1, as models are.

use crate::ShapesError;
use crate::mat;
use crate::surface::Surface;
use crate::voxelize;
use enfilade_math::DVec3;
use std::path::Path;

/// Name of the array in a file.
const NAME: &str = "voxel";

/// Which cells of a cube are inside of a model.
///
/// ```
/// use enfilade_math::DVec3;
/// use enfilade_shapes::{Surface, Voxels};
/// // The tetrahedron at a corner of the unit cube: it fills the corner's cell, and leaves the opposite one free.
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let surface = Surface::new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap();
/// let voxels = Voxels::of(&surface, 8).unwrap();
/// assert!(voxels.get([0; 3]) && !voxels.get([7; 3]));
/// assert_eq!(Voxels::from_mat(&voxels.to_mat(), "voxel.mat".as_ref()).unwrap(), voxels);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Voxels {
    side: usize,
    /// Occupancy of the cells; cell (x, y, z) is at (x · side + y) · side + z.
    occupied: Vec<bool>,
}

impl Voxels {
    /// Cells on a side of Pix3D's cubes.
    pub const PIX3D_SIDE: usize = 128;

    /// The cells of a cube around the surface that it touches or encloses; `None` when it has no extent.
    ///
    /// The cube has the centre of the surface's box, and its edge is the box's longest. Cells that no path through free cells connects to
    /// the outside count as enclosed.
    pub fn of(surface: &Surface, side: usize) -> Option<Self> {
        let occupied = voxelize::solid(surface, side)?;
        Some(Self { side, occupied })
    }

    /// Cells on a side.
    pub fn side(&self) -> usize {
        self.side
    }

    /// True when the cell is occupied. Indices grow along the model's axes x, y, z.
    pub fn get(&self, [x, y, z]: [usize; 3]) -> bool {
        self.occupied[(x * self.side + y) * self.side + z]
    }

    /// How many cells are occupied.
    pub fn count(&self) -> usize {
        self.occupied.iter().filter(|o| **o).count()
    }

    /// The middles of the occupied cells in the model's space: centred, in the ball of diameter 1. Mesh R-CNN's `read_voxel`.
    pub fn points(&self) -> Vec<DVec3> {
        let side = self.side;
        let cell = |i: usize| DVec3::new((i / (side * side)) as f64, (i / side % side) as f64, (i % side) as f64);
        let cells: Vec<DVec3> = (0..self.occupied.len()).filter(|&i| self.occupied[i]).map(cell).collect();
        let (min, max) = cells.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), &c| (a.min(c), b.max(c)));
        let centred: Vec<DVec3> = cells.into_iter().map(|c| c - 0.5 * (min + max)).collect();
        let radius = centred.iter().map(|c| c.length()).fold(0.0, f64::max);
        if radius > 0.0 { centred.into_iter().map(|c| c / (2.0 * radius)).collect() } else { centred }
    }

    /// The bytes of a MATLAB file with Pix3D's axes.
    pub fn to_mat(&self) -> Vec<u8> {
        let side = self.side;
        // In the file the first index runs fastest: (i, j, k) is cell (i, k, side − 1 − j).
        let cells = (0..side.pow(3)).map(|at| [at % side, at / side % side, at / (side * side)]);
        let values: Vec<u8> = cells.map(|[i, j, k]| u8::from(self.get([i, k, side - 1 - j]))).collect();
        mat::write(NAME, [side; 3], &values)
    }

    /// The voxels of a MATLAB file; `path` is for messages.
    ///
    /// # Errors
    /// When it is no MATLAB file of version 5, or has no cube `voxel` with an occupied cell.
    pub fn from_mat(bytes: &[u8], path: &Path) -> Result<Self, ShapesError> {
        let array = mat::read(bytes, NAME).map_err(|problem| ShapesError::file(path, problem))?;
        let side = array.shape.first().copied().unwrap_or(0);
        if array.shape != [side; 3] {
            return Err(ShapesError::file(path, format!("{NAME} has the shape {:?}, expected a cube", array.shape)));
        }
        let mut voxels = Self { side, occupied: vec![false; array.values.len()] };
        for (at, _) in array.values.iter().enumerate().filter(|(_, value)| **value > 0.0) {
            let [i, j, k] = [at % side, at / side % side, at / (side * side)];
            voxels.occupied[(i * side + k) * side + side - 1 - j] = true;
        }
        if voxels.count() == 0 {
            return Err(ShapesError::file(path, format!("no cell of {NAME} is above 0; leave the model out")));
        }
        Ok(voxels)
    }

    /// Reads a MATLAB file.
    ///
    /// # Errors
    /// When it cannot be read, and as [`Voxels::from_mat`].
    pub fn read(path: &Path) -> Result<Self, ShapesError> {
        let bytes = std::fs::read(path).map_err(ShapesError::io("read", path))?;
        Self::from_mat(&bytes, path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::tests::block;

    fn voxels(side: usize, cells: &[[usize; 3]]) -> Voxels {
        let mut voxels = Voxels { side, occupied: vec![false; side.pow(3)] };
        cells.iter().for_each(|[x, y, z]| voxels.occupied[(x * side + y) * side + z] = true);
        voxels
    }

    #[test]
    fn voxels_come_back_from_their_file() {
        let shape = voxels(4, &[[0, 1, 2], [3, 3, 0], [1, 0, 0]]);
        assert_eq!(Voxels::from_mat(&shape.to_mat(), Path::new("v.mat")).unwrap(), shape);
    }

    #[test]
    fn the_files_axes_are_left_outward_and_up() {
        // One cell at the low end of x, the high end of y (up), and the low end of z (inward), which is the high end of outward.
        let array = mat::read(&voxels(3, &[[0, 2, 0]]).to_mat(), "voxel").unwrap();
        let at = array.values.iter().position(|&v| v > 0.0).unwrap();
        assert_eq!([at % 3, at / 3 % 3, at / 9], [0, 2, 2]);
    }

    #[test]
    fn points_are_centred_in_the_ball_of_diameter_one() {
        let points = voxels(8, &[[1, 2, 3], [5, 2, 6]]).points();
        assert_eq!(points, [DVec3::new(-0.4, 0.0, -0.3), DVec3::new(0.4, 0.0, 0.3)]);
        assert_eq!(voxels(2, &[[0, 1, 1]]).points(), [DVec3::ZERO]);
    }

    #[test]
    fn points_of_a_box_fill_the_box_that_is_scaled_as_models_are() {
        let points = Voxels::of(&block(DVec3::ZERO, DVec3::new(2.0, 1.0, 4.0)), 64).unwrap().points();
        let (min, max) = points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), &c| (a.min(c), b.max(c)));
        let expected = DVec3::new(2.0, 1.0, 4.0) / DVec3::new(2.0, 1.0, 4.0).length();
        assert!((max - min).distance(expected) < 0.03, "{}", max - min);
    }

    #[test]
    fn files_without_a_cube_or_a_cell_are_refused_by_name() {
        let refused = |bytes: Vec<u8>| Voxels::from_mat(&bytes, Path::new("model/v.mat")).unwrap_err().to_string();
        assert!(refused(mat::write("voxel", [2, 2, 1], &[1; 4])).contains("expected a cube"));
        assert!(refused(mat::write("voxel", [2, 2, 2], &[0; 8])).starts_with("model/v.mat: no cell"));
        assert!(Voxels::read(Path::new("nowhere.mat")).unwrap_err().is_not_found());
    }
}
