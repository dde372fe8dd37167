//! Arguments as Python passes them, and what each is in Rust: names, layers, indices, frame numbers, positions of crops.

use enfilade_frame::Layer;
use enfilade_loader::CropPlace;
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;

/// One name or several. In names of scenes and cameras `*` stands for any run of characters.
#[derive(Clone, FromPyObject, IntoPyObject)]
pub enum Names {
    /// One.
    One(String),
    /// Several.
    Several(Vec<String>),
}

impl Names {
    /// The names as a list.
    pub fn list(&self) -> Vec<String> {
        match self {
            Self::One(name) => vec![name.clone()],
            Self::Several(names) => names.clone(),
        }
    }

    /// The names as a pattern in the form of the command line, with commas between them.
    pub fn pattern(&self) -> String {
        self.list().join(",")
    }
}

/// The layer of that name.
pub fn layer(name: &str) -> PyResult<Layer> {
    Layer::named(name).map_err(PyValueError::new_err)
}

/// The layers of these names.
pub fn layers(names: Option<&Names>) -> PyResult<Option<Vec<Layer>>> {
    names.map(|names| names.list().iter().map(|name| layer(name)).collect()).transpose()
}

/// The index that Python means: negative ones count from the end.
pub fn position(index: isize, count: usize) -> PyResult<usize> {
    let found = if index < 0 { index + count as isize } else { index };
    let wrong = || PyIndexError::new_err(format!("index {index} of a dataset of {count} samples"));
    usize::try_from(found).ok().filter(|&found| found < count).ok_or_else(wrong)
}

/// Frame numbers: one, or a `range` with a step of one.
#[derive(FromPyObject)]
pub enum Frames {
    /// One.
    One(u32),
    /// From `start`, without `stop`.
    Range {
        /// The first.
        start: u32,
        /// End of the range, one after its last number.
        stop: u32,
        /// 1.
        step: i64,
    },
}

impl Frames {
    /// The numbers as a range.
    pub fn range(&self) -> PyResult<std::ops::Range<u32>> {
        match *self {
            Self::One(frame) => Ok(frame..frame.saturating_add(1)),
            Self::Range { start, stop, step: 1 } if start < stop => Ok(start..stop),
            _ => Err(PyValueError::new_err("frames must be a number or a range with a step of 1 that is not empty, as in range(0, 10)")),
        }
    }
}

/// Position of a crop: `"center"`, `"random"`, or first row and column.
#[derive(Clone, FromPyObject, IntoPyObject)]
pub enum CropPosition {
    /// By name.
    Named(String),
    /// First row and column.
    At((usize, usize)),
}

impl CropPosition {
    /// The position for the loader.
    pub fn crop_place(&self) -> PyResult<CropPlace> {
        match self {
            Self::Named(name) if name == "center" => Ok(CropPlace::Center),
            Self::Named(name) if name == "random" => Ok(CropPlace::Random),
            Self::Named(name) => {
                Err(PyValueError::new_err(format!("crop_place is {name:?}; expected \"center\", \"random\" or (row, column)")))
            }
            &Self::At((top, left)) => Ok(CropPlace::At([top, left])),
        }
    }
}
