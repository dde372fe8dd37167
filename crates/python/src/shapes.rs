//! 3D shape prediction: voxels of Pix3D's files, and the metrics of Mesh R-CNN.

use crate::errors::IntoPy;
use crate::json;
use enfilade_shapes::{CompareConfig, Found, Judged, Mask, Rules, ShapesError, Surface, Truth, Voxels};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::json;
use std::collections::BTreeMap;
use std::path::PathBuf;

impl IntoPy for ShapesError {
    fn into_py(self) -> PyErr {
        let message = self.to_string();
        match self {
            error if error.is_not_found() => PyFileNotFoundError::new_err(message),
            Self::Io { .. } => PyOSError::new_err(message),
            Self::File { .. } => crate::errors::DamagedFileError::new_err(message),
            Self::Value(_) => PyValueError::new_err(message),
        }
    }
}

/// Vertices (N x 3) and faces (M x 3, counted from 0).
type Mesh<'py> = (PyReadonlyArray2<'py, f64>, PyReadonlyArray2<'py, i64>);

fn surface((vertices, faces): &Mesh<'_>) -> PyResult<Surface> {
    let (vertices, faces) = (vertices.as_array(), faces.as_array());
    if vertices.ncols() != 3 || faces.ncols() != 3 {
        let message = format!("a mesh has {} numbers in a vertex and {} in a face; expected 3 and 3", vertices.ncols(), faces.ncols());
        return Err(PyValueError::new_err(message));
    }
    let vertices = vertices.rows().into_iter().map(|row| [row[0], row[1], row[2]].into()).collect();
    let corner = |&corner: &i64| u32::try_from(corner).unwrap_or(u32::MAX); // no mesh has so many vertices, so it is refused below
    let faces = faces.rows().into_iter().map(|row| [corner(&row[0]), corner(&row[1]), corner(&row[2])]).collect();
    Surface::new(vertices, faces).map_err(IntoPy::into_py)
}

/// Compares two meshes as Mesh R-CNN does: both are scaled alike so that the longest edge of the true one's box is 10, and points are drawn from
/// either, uniform by area.
///
/// found, truth: pairs of vertices (float64, N x 3) and faces (int64, M x 3).
/// longest_edge: after scaling; None leaves the meshes as they are. seed: of the points.
///
/// Gives `chamfer_l2`, `normal_consistency`, `abs_normal_consistency`, and per cent by threshold `precision`, `recall` and `f1`.
#[pyfunction]
#[pyo3(signature = (found, truth, *, samples=10_000, longest_edge=Some(10.0), thresholds=vec![0.1, 0.2, 0.3, 0.4, 0.5], seed=0))]
pub fn compare_meshes<'py>(
    py: Python<'py>,
    found: Mesh<'py>,
    truth: Mesh<'py>,
    samples: usize,
    longest_edge: Option<f64>,
    thresholds: Vec<f64>,
    seed: u64,
) -> PyResult<Bound<'py, PyDict>> {
    let (found, truth) = (surface(&found)?, surface(&truth)?);
    let config = CompareConfig { samples, longest_edge, thresholds, seed };
    let compared = py.detach(|| enfilade_shapes::compare(&found, &truth, &config)).map_err(IntoPy::into_py)?;
    let out = PyDict::new(py);
    out.set_item("chamfer_l2", compared.chamfer_l2)?;
    out.set_item("normal_consistency", compared.normal_consistency)?;
    out.set_item("abs_normal_consistency", compared.abs_normal_consistency)?;
    let tables = [PyDict::new(py), PyDict::new(py), PyDict::new(py)];
    for agreement in &compared.agreement {
        for (table, value) in tables.iter().zip([agreement.precision, agreement.recall, agreement.f1]) {
            table.set_item(agreement.threshold, value)?;
        }
    }
    for (name, table) in ["precision", "recall", "f1"].into_iter().zip(tables) {
        out.set_item(name, table)?;
    }
    Ok(out)
}

/// An object: category, box (left, upper, right, lower), mask (bool, height x width), mesh.
#[derive(FromPyObject)]
pub struct Object<'py> {
    #[pyo3(item)]
    category: u32,
    #[pyo3(item("box"))]
    bbox: [f64; 4],
    #[pyo3(item)]
    mask: PyReadonlyArray2<'py, bool>,
    #[pyo3(item)]
    mesh: Mesh<'py>,
}

/// An object that was found.
#[derive(FromPyObject)]
pub struct Detection<'py> {
    #[pyo3(item)]
    score: f64,
    #[pyo3(item)]
    category: u32,
    #[pyo3(item("box"))]
    bbox: [f64; 4],
    #[pyo3(item)]
    mask: PyReadonlyArray2<'py, bool>,
    #[pyo3(item)]
    mesh: Mesh<'py>,
}

fn mask(mask: &PyReadonlyArray2<'_, bool>) -> Mask {
    let array = mask.as_array();
    Mask { width: array.ncols(), height: array.nrows(), pixels: array.iter().copied().collect() }
}

/// Judges the detections of one image against its objects, as Mesh R-CNN's evaluation does; an image may have several objects.
///
/// truths: dictionaries with `category` (1 to 9), `box` (left, upper, right, lower), `mask` (bool, height x width) and `mesh` (vertices, faces, in
/// camera space). found: the same with `score`. filter_iou: detections whose box overlaps none by more are left out. iou: overlap of
/// boxes and masks that makes a hit. f1: F1 that makes one, 0 to 1, at the distance f1_distance where a true box is 10 long.
///
/// Gives a dictionary per detection, surest first: `category`, `score`, `truth` (index), `box_iou`, `mask_iou`, `f1`, `box_hit`, `mask_hit`,
/// `mesh_hit`.
#[pyfunction]
#[pyo3(signature = (truths, found, *, filter_iou=0.3, iou=0.5, f1=0.5, f1_distance=0.3, samples=10_000, seed=0))]
#[allow(clippy::too_many_arguments, reason = "Python's names")]
pub fn judge_shapes<'py>(
    py: Python<'py>,
    truths: Vec<Object<'py>>,
    found: Vec<Detection<'py>>,
    filter_iou: f64,
    iou: f64,
    f1: f64,
    f1_distance: f64,
    samples: usize,
    seed: u64,
) -> PyResult<Bound<'py, PyAny>> {
    let truth = |o: &Object<'_>| Ok(Truth { category: o.category, bbox: o.bbox, mask: mask(&o.mask), surface: surface(&o.mesh)? });
    let detection = |d: &Detection<'_>| {
        Ok(Found { category: d.category, score: d.score, bbox: d.bbox, mask: mask(&d.mask), surface: surface(&d.mesh)? })
    };
    let truths = truths.iter().map(truth).collect::<PyResult<Vec<_>>>()?;
    let found = found.iter().map(detection).collect::<PyResult<Vec<_>>>()?;
    let rules = Rules { filter_iou, iou, f1, f1_distance, samples, seed };
    let judged = py.detach(|| enfilade_shapes::judge(&truths, &found, &rules)).map_err(IntoPy::into_py)?;
    let row = |j: &Judged| {
        json!({
            "category": j.category, "score": j.score, "truth": j.truth, "box_iou": j.box_iou, "mask_iou": j.mask_iou, "f1": j.f1,
            "box_hit": j.box_hit, "mask_hit": j.mask_hit, "mesh_hit": j.mesh_hit,
        })
    };
    json::to_python(py, &judged.iter().map(row).collect::<Vec<_>>())
}

/// A row of `judge_shapes`.
#[derive(FromPyObject)]
pub struct Row {
    #[pyo3(item)]
    category: u32,
    #[pyo3(item)]
    score: f64,
    #[pyo3(item)]
    truth: usize,
    #[pyo3(item)]
    box_iou: f64,
    #[pyo3(item)]
    mask_iou: f64,
    #[pyo3(item)]
    f1: f64,
    #[pyo3(item)]
    box_hit: bool,
    #[pyo3(item)]
    mask_hit: bool,
    #[pyo3(item)]
    mesh_hit: bool,
}

/// Average precision of boxes, masks and meshes, 0 to 1, from the rows of `judge_shapes` of all images.
///
/// truths: how many objects there are, by category. Gives `box_ap`, `mask_ap`, `mesh_ap`, which are means over the categories that have
/// objects, `truths`, and `categories`, with the same of each. The curve is Pascal VOC's since 2010, as in Mesh R-CNN.
#[pyfunction]
pub fn shape_precision<'py>(py: Python<'py>, rows: Vec<Row>, truths: BTreeMap<u32, usize>) -> PyResult<Bound<'py, PyAny>> {
    let judged = |r: Row| Judged {
        category: r.category,
        score: r.score,
        truth: r.truth,
        box_iou: r.box_iou,
        mask_iou: r.mask_iou,
        f1: r.f1,
        box_hit: r.box_hit,
        mask_hit: r.mask_hit,
        mesh_hit: r.mesh_hit,
    };
    let (all, by_category) = enfilade_shapes::summarize(&rows.into_iter().map(judged).collect::<Vec<_>>(), &truths);
    let told = |p: &enfilade_shapes::Precision| json!({ "box_ap": p.bbox, "mask_ap": p.mask, "mesh_ap": p.mesh, "truths": p.truths });
    let mut out = told(&all);
    let name =
        |id: u32| (id as usize).checked_sub(1).and_then(|i| enfilade_shapes::CATEGORIES.get(i)).map_or(id.to_string(), |n| n.to_string());
    out["categories"] = by_category.iter().map(|(&id, p)| (name(id), told(p))).collect::<serde_json::Map<_, _>>().into();
    json::to_python(py, &out)
}

/// The middles of the occupied voxels of a Pix3D `.mat` file: float32, N x 3, in the model's axes, centred and scaled into the ball of diameter 1.
#[pyfunction]
pub fn read_voxels<'py>(py: Python<'py>, file: PathBuf) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let read = || Voxels::read(&file).map(|voxels| voxels.points().iter().flat_map(|p| p.as_vec3().to_array()).collect::<Vec<f32>>());
    let points = py.detach(read).map_err(IntoPy::into_py)?;
    let count = points.len() / 3;
    points.into_pyarray(py).reshape([count, 3])
}
