//! Numbers from Python: vectors, matrices and poses, from anything that numpy can convert to an array.

use enfilade_math::{DAffine3, DMat3, DVec3, Rgb};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The value as an array of numbers.
pub fn array<'py>(value: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArrayDyn<'py, f64>> {
    value.py().import("numpy")?.call_method1("asarray", (value, "float64"))?.extract()
}

/// Rows of N numbers each; `name` is for messages. Rows may hold anything, such as NaN.
pub fn rows<const N: usize>(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<[f64; N]>> {
    let array = array(value)?;
    let array = array.as_array();
    match array.shape() {
        [_, found] if *found == N => Ok(array.rows().into_iter().map(|row| std::array::from_fn(|i| row[i])).collect()),
        [0] => Ok(Vec::new()),
        shape => Err(PyValueError::new_err(format!("{name} has the shape {shape:?}; expected n x {N}"))),
    }
}

/// Three numbers.
pub fn three(name: &str, value: &Bound<'_, PyAny>) -> PyResult<[f64; 3]> {
    let array = array(value)?;
    let array = array.as_array();
    if array.shape() != [3] {
        return Err(PyValueError::new_err(format!("{name} has the shape {:?}; expected 3 numbers", array.shape())));
    }
    Ok([array[[0]], array[[1]], array[[2]]])
}

/// One number for all channels, or three; finite and within `range`.
pub fn color(name: &str, value: &Bound<'_, PyAny>, range: std::ops::RangeInclusive<f64>) -> PyResult<Rgb> {
    let channels = match value.extract::<f64>() {
        Ok(all) => [all; 3],
        Err(_) => three(name, value)?,
    };
    for channel in channels {
        within(name, channel, range.clone())?;
    }
    Ok(Rgb::from(channels.map(|channel| channel as f32)))
}

/// A number within `range`, which ends at infinity where there is no limit; infinite numbers are refused all the same.
pub fn within(name: &str, value: f64, range: std::ops::RangeInclusive<f64>) -> PyResult<f64> {
    if value.is_finite() && range.contains(&value) {
        return Ok(value);
    }
    let (from, to) = (range.start(), range.end());
    let expected = if to.is_finite() { format!("{from} to {to}") } else { format!("a number of {from} or more") };
    Err(PyValueError::new_err(format!("{name} is {value}; expected {expected}")))
}

/// A pose from three numbers (a position, turned by `turn_deg` about the vertical axis) or from a matrix of 4 x 4 or 3 x 4. What it holds is
/// checked by the edit that uses it, which knows the part.
pub fn pose(name: &str, value: Option<&Bound<'_, PyAny>>, turn_deg: f64) -> PyResult<DAffine3> {
    let turn = || DMat3::from_rotation_z(turn_deg.to_radians());
    let Some(value) = value else { return Ok(DAffine3::from_mat3(turn())) };
    let array = array(value)?;
    let array = array.as_array();
    match array.shape() {
        [3] => Ok(DAffine3 { matrix3: turn(), translation: DVec3::new(array[[0]], array[[1]], array[[2]]) }),
        [rows @ (3 | 4), 4] => {
            let last = |column: usize| array[[3, column]];
            if *rows == 4 && [last(0), last(1), last(2), last(3)] != [0.0, 0.0, 0.0, 1.0] {
                let found: Vec<f64> = (0..4).map(last).collect();
                return Err(PyValueError::new_err(format!("{name} has the last row {found:?}; expected 0 0 0 1")));
            }
            if turn_deg != 0.0 {
                return Err(PyValueError::new_err(format!("{name} is a matrix; turn_deg is for positions")));
            }
            let column = |j: usize| DVec3::new(array[[0, j]], array[[1, j]], array[[2, j]]);
            Ok(DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) })
        }
        shape => Err(PyValueError::new_err(format!("{name} has the shape {shape:?}; expected 3 numbers, or a matrix of 4 x 4 or 3 x 4"))),
    }
}

/// A placement as a matrix of 4 x 4.
pub fn matrix_of<'py>(py: Python<'py>, placement: &DAffine3) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let rows = enfilade_math::DMat4::from(*placement).transpose().to_cols_array();
    PyArray1::from_slice(py, &rows).reshape([4, 4])
}
