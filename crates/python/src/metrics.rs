//! `enfilade.Confusion`: the confusion matrix, which numpy arrays of any integer type are added to.

use enfilade_loader::confusion::{Confusion as Matrix, ConfusionError};
use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A confusion matrix: numbers of pixels by true and predicted class, and the scores that follow from them.
///
/// ```python
/// scores = enfilade.Confusion(13)
/// scores.add(prediction, truth, ignore=-1)
/// scores.mean_iou
/// ```
///
/// Pixels of all images go into one matrix. Intersection over union of a class is TP / (TP + FP + FN). Matrices can be pickled.
///
/// Parameters
/// ----------
/// classes: how many there are; they are counted from 0.
/// counts: integers, classes × classes, to go on with; rows are true classes.
#[pyclass(module = "enfilade", frozen)]
pub struct Confusion {
    matrix: Mutex<Matrix>,
}

impl Confusion {
    fn matrix(&self) -> MutexGuard<'_, Matrix> {
        // A poisoned lock is fine: a matrix changes in one step, so it is consistent even if a thread panicked.
        self.matrix.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Confusion {
    #[new]
    #[pyo3(signature = (classes, counts=None))]
    fn new(classes: usize, counts: Option<PyReadonlyArray2<'_, i64>>) -> PyResult<Self> {
        if !(1..=4096).contains(&classes) {
            return Err(PyValueError::new_err(format!("{classes} classes; expected 1 to 4096")));
        }
        let mut matrix = Matrix::new(classes);
        if let Some(counts) = counts {
            if counts.shape() != [classes, classes] {
                return Err(PyValueError::new_err(format!("counts of shape {:?}; expected ({classes}, {classes})", counts.shape())));
            }
            let values = counts.as_array().iter().map(|&count| u64::try_from(count)).collect::<Result<Vec<_>, _>>();
            let values = values.map_err(|_| PyValueError::new_err("counts has negative numbers; expected numbers of pixels"))?;
            matrix = Matrix::of_counts(classes, values);
        }
        Ok(Self { matrix: Mutex::new(matrix) })
    }

    /// Counts the pixels of an image, or of many.
    ///
    /// prediction, truth: integers of any type, of one shape.
    /// ignore: pixels of this truth are left out, whatever was predicted.
    #[pyo3(signature = (prediction, truth, ignore=-1))]
    fn add(&self, py: Python<'_>, prediction: &Bound<'_, PyAny>, truth: &Bound<'_, PyAny>, ignore: i64) -> PyResult<()> {
        let (shapes, values) =
            ([shape("prediction", prediction)?, shape("truth", truth)?], [numbers("prediction", prediction)?, numbers("truth", truth)?]);
        if shapes[0] != shapes[1] {
            return Err(PyValueError::new_err(format!("prediction has shape {:?}, truth {:?}; expected the same", shapes[0], shapes[1])));
        }
        py.detach(|| self.matrix().add(&values[0], &values[1], ignore)).map_err(wrong)
    }

    /// Adds the pixels of another matrix.
    fn merge(&self, other: &Self) -> PyResult<()> {
        let other = other.matrix().clone();
        self.matrix().merge(&other).map_err(wrong)
    }

    /// int64, classes × classes: pixels by true class (row) and predicted class (column).
    #[getter]
    fn counts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let matrix = self.matrix();
        let counts: Vec<i64> = matrix.counts().iter().map(|&count| count as i64).collect();
        let flat: Bound<'py, numpy::PyArray1<i64>> = numpy::IntoPyArray::into_pyarray(counts, py);
        Ok(flat.reshape([matrix.classes(), matrix.classes()])?.into_any())
    }

    /// Number of classes.
    #[getter]
    fn classes(&self) -> usize {
        self.matrix().classes()
    }

    /// Number of pixels that were counted.
    #[getter]
    fn pixels(&self) -> u64 {
        self.matrix().pixels()
    }

    /// Intersection over union of each class; None where a class occurs neither in truth nor in prediction.
    #[getter]
    fn iou(&self) -> Vec<Option<f64>> {
        self.matrix().iou()
    }

    /// Mean of the intersections over union of the classes that occur; None without pixels.
    #[getter]
    fn mean_iou(&self) -> Option<f64> {
        self.matrix().mean_iou()
    }

    /// Share of pixels whose class is right; None without pixels.
    #[getter]
    fn pixel_accuracy(&self) -> Option<f64> {
        self.matrix().accuracy()
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<((usize,), Bound<'py, PyDict>)> {
        let named = PyDict::new(py);
        named.set_item("counts", self.counts(py)?)?;
        Ok(((self.classes(),), named))
    }

    fn __repr__(&self) -> String {
        let matrix = self.matrix();
        let score = matrix.mean_iou().map_or("none".into(), |score| format!("{score:.4}"));
        format!("<enfilade.Confusion of {} classes: {} pixels, mean IoU {score}>", matrix.classes(), matrix.pixels())
    }
}

fn wrong(error: ConfusionError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

fn shape(what: &str, array: &Bound<'_, PyAny>) -> PyResult<Vec<usize>> {
    let untyped = array.cast::<numpy::PyUntypedArray>().map_err(|_| no_array(what, array))?;
    Ok(untyped.shape().to_vec())
}

fn no_array(what: &str, found: &Bound<'_, PyAny>) -> PyErr {
    let kind = found.getattr("dtype").map_or_else(|_| format!("a {}", found.get_type()), |dtype| format!("an array of {dtype}"));
    PyTypeError::new_err(format!("{what} is {kind}; expected a numpy array of integers"))
}

/// The values of an array of integers.
fn numbers(what: &str, array: &Bound<'_, PyAny>) -> PyResult<Vec<i64>> {
    fn of<T: numpy::Element + Copy>(array: &Bound<'_, PyAny>, number: impl Fn(T) -> i64) -> Option<Vec<i64>> {
        let array = array.cast::<PyArrayDyn<T>>().ok()?.readonly();
        Some(match array.as_slice() {
            // A slice has the order of memory, which differs from the order of pixels for Fortran's layout.
            Ok(values) if array.is_c_contiguous() => values.iter().map(|&value| number(value)).collect(),
            _ => array.as_array().iter().map(|&value| number(value)).collect(),
        })
    }
    let found = of::<i64>(array, |value| value).or_else(|| of::<u8>(array, i64::from)).or_else(|| of::<i16>(array, i64::from));
    let found = found.or_else(|| of::<u16>(array, i64::from)).or_else(|| of::<i32>(array, i64::from));
    let found = found.or_else(|| of::<i8>(array, i64::from)).or_else(|| of::<u32>(array, i64::from));
    // A value beyond int64 is no class; nor is the largest int64.
    let found = found.or_else(|| of::<u64>(array, |value| i64::try_from(value).unwrap_or(i64::MAX)));
    found.ok_or_else(|| no_array(what, array))
}
