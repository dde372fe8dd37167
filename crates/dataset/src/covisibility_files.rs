//! `covisibility.hdf5`, what share of each frame's surfaces each other frame of a scene sees, and `covisibility_frames.csv`, which frames
//! its rows and columns are.
//!
//! Shares are counted on a grid of pixels, at regular distances in columns and rows, in the middle of their cells: see
//! [`CovisibleFrame::grid`].

use crate::hdf5::{Array, Elements, Storage, read_array, write_array};
use crate::tables::Table;
use crate::{Dataset, DatasetError, check_name, replace_file};

const HEADER: [&str; 6] = ["frame_index", "camera_name", "frame_id", "grid_step_px", "surface_pixels", "hidden_by"];

/// Share of each frame's surfaces that each other frame of a scene sees.
#[derive(Clone, Debug, PartialEq)]
pub struct Covisibility {
    /// The frames of the rows and columns, by camera and number.
    pub frames: Vec<CovisibleFrame>,
    /// How hidden points were determined.
    pub hidden_by: HiddenBy,
    /// Shares of shape (frames, frames): row i, column j is the share of frame i's grid pixels with a surface whose surface frame j sees, 0
    /// to 1. NaN in the rows of frames that show no surface.
    pub shares: Vec<f32>,
}

/// A frame of the matrix.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CovisibleFrame {
    /// Name of the camera.
    pub camera: String,
    /// Frame number.
    pub frame: u32,
    /// Pixels of the image per pixel of the grid, in both directions.
    pub grid_step_px: u32,
    /// Pixels of the grid that show a surface: those that are counted.
    pub surface_pixels: u32,
}

/// The test whether a surface point is hidden from a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HiddenBy {
    /// The frame's stored distances, and where they leave it open a ray through the scene.
    Scene,
    /// The frame's stored distances alone: the scene was not there.
    Distances,
}

impl HiddenBy {
    /// All tests.
    const ALL: [Self; 2] = [Self::Scene, Self::Distances];

    /// Name in the table.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Distances => "distances",
        }
    }
}

impl CovisibleFrame {
    /// Columns and rows of the grid's pixels in an image of `size`, row by row: in the middle of cells of `step_px`, which the border may cut.
    ///
    /// ```
    /// use enfilade_dataset::CovisibleFrame;
    /// let grid: Vec<[u32; 2]> = CovisibleFrame::grid([7, 3], 4).collect();
    /// assert_eq!(grid, [[2, 2], [6, 2]]);
    /// ```
    pub fn grid([width, height]: [u32; 2], step_px: u32) -> impl Iterator<Item = [u32; 2]> {
        let at = move |cell: u32, side: u32| (cell * step_px + step_px / 2).min(side - 1);
        let columns = width.div_ceil(step_px);
        (0..height.div_ceil(step_px)).flat_map(move |row| (0..columns).map(move |column| [at(column, width), at(row, height)]))
    }
}

impl Covisibility {
    /// The share of frame `of`'s surfaces that frame `by` sees, both by their place in the list.
    pub fn share(&self, of: usize, by: usize) -> f32 {
        self.shares[of * self.frames.len() + by]
    }
}

impl Dataset {
    /// Writes the matrix of a scene and the list of its frames.
    ///
    /// # Errors
    /// When the scene's name cannot be part of a path, or a file cannot be written.
    pub fn write_covisibility(&self, scene: &str, covisibility: &Covisibility) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        let n = covisibility.frames.len();
        let mut table = Table::new(&self.layout().covisibility_frames(scene), &HEADER);
        let row = |(index, frame): (usize, &CovisibleFrame)| {
            let numbers = [frame.frame, frame.grid_step_px, frame.surface_pixels].map(|number| number.to_string());
            let [number, step, pixels] = numbers;
            vec![index.to_string(), frame.camera.clone(), number, step, pixels, covisibility.hidden_by.name().to_string()]
        };
        table.rows = covisibility.frames.iter().enumerate().map(row).collect();
        table.write()?;
        let array = Array::new(&[n, n], Elements::F32(covisibility.shares.clone()));
        let hidden_by = covisibility.hidden_by.name();
        let attributes = [
            ("sentinel", "NaN: the frame of the row shows no surface"),
            ("hidden_by", hidden_by),
            (
                "description",
                "Row i, column j: share of the grid pixels of frame i that show a surface whose surface frame j sees, 0 to 1; \
                 covisibility_frames.csv lists the frames and their grids.",
            ),
        ];
        replace_file(&self.layout().covisibility(scene), |aside| write_array(aside, &array, Storage::Compressed, &attributes))
    }

    /// The matrix of a scene.
    ///
    /// # Errors
    /// When a file is missing or damaged, or the two do not belong together.
    pub fn read_covisibility(&self, scene: &str) -> Result<Covisibility, DatasetError> {
        let (path, list) = (self.layout().covisibility(scene), self.layout().covisibility_frames(scene));
        let array = read_array(&path)?;
        let table = Table::read(&list)?;
        let at = table.columns(HEADER)?;
        let frame = |i: usize| {
            let camera = table.rows[i][at[1]].clone();
            let grid_step_px = table.parse(i, at[3])?;
            if grid_step_px == 0 {
                return Err(DatasetError::text(
                    &list,
                    format!("line {}: grid_step_px is 0, expected at least 1; run enfilade make OUT pairs", i + 2),
                ));
            }
            Ok(CovisibleFrame { camera, frame: table.parse(i, at[2])?, grid_step_px, surface_pixels: table.parse(i, at[4])? })
        };
        let frames: Vec<CovisibleFrame> = (0..table.rows.len()).map(frame).collect::<Result<_, _>>()?;
        let name = table.rows.first().map_or("distances", |row| row[at[5]].as_str());
        let unknown =
            || DatasetError::text(&list, format!("hidden_by is {name:?}; expected scene or distances; run enfilade make OUT pairs"));
        let hidden_by = HiddenBy::ALL.into_iter().find(|known| known.name() == name).ok_or_else(unknown)?;
        match array.values {
            Elements::F32(shares) if array.shape == [frames.len(), frames.len()] => Ok(Covisibility { frames, hidden_by, shares }),
            other => {
                let found = format!("{} of shape {:?}", other.element().name(), array.shape);
                let problem = format!("expected float32 of {0} x {0}, the frames of covisibility_frames.csv, found {found}", frames.len());
                Err(DatasetError::hdf5(&path, format!("{problem}; run enfilade make OUT pairs")))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covisibility() -> Covisibility {
        let frame = |frame| CovisibleFrame { camera: "cam_00".into(), frame, grid_step_px: 16, surface_pixels: 3072 };
        Covisibility { frames: vec![frame(0), frame(4)], hidden_by: HiddenBy::Scene, shares: vec![1.0, 0.25, 0.5, 1.0] }
    }

    #[test]
    fn the_matrix_comes_back_with_its_frames() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        assert!(dataset.read_covisibility("room").unwrap_err().is_not_found());
        dataset.write_covisibility("room", &covisibility()).unwrap();
        let back = dataset.read_covisibility("room").unwrap();
        assert_eq!((back.share(0, 1), back.share(1, 0)), (0.25, 0.5));
        assert_eq!(back, covisibility());
        let text = std::fs::read_to_string(dataset.layout().covisibility_frames("room")).unwrap();
        assert!(text.ends_with("\n1,cam_00,4,16,3072,scene\n"), "{text}");
    }

    #[test]
    fn a_matrix_of_other_frames_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        dataset.write_covisibility("room", &covisibility()).unwrap();
        let list = dataset.layout().covisibility_frames("room");
        let text = std::fs::read_to_string(&list).unwrap();
        std::fs::write(&list, text.lines().take(2).collect::<Vec<_>>().join("\n")).unwrap();
        let message = dataset.read_covisibility("room").unwrap_err().to_string();
        assert!(message.contains("expected float32 of 1 x 1") && message.contains("shape [2, 2]"), "{message}");
    }
}
