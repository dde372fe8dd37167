//! `enfilade.Mesh`: triangles, to be added to scenes and as parts have them.

use crate::numbers::rows;
use enfilade_math::{Vec2, Vec3};
use numpy::{Element, PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;

/// A triangle mesh. Its numbers have single precision.
///
/// vertices: n x 3, metres unless the pose that places it scales.
/// triangles: m x 3 indices of vertices, from 0; counter-clockwise seen from outside.
/// normals: n x 3, for smooth shading, of any length but 0; without them, triangles are flat.
/// uvs: n x 2, texture coordinates, v upward; needed by materials with a texture.
///
/// Arrays of other shapes, numbers that are not finite and indices of no vertex are refused with a ValueError. `Mesh.box` and `Mesh.sphere` make the
/// simplest ones; where a mesh is taken, so are objects with `vertices` and `faces`, such as those of trimesh, and pairs of both arrays.
#[pyclass(module = "enfilade", frozen)]
pub struct Mesh(pub Arc<enfilade_geometry::Mesh>);

impl Mesh {
    /// The mesh of what Python has as one; `None` for what is none.
    pub fn of(value: &Bound<'_, PyAny>) -> PyResult<Option<Arc<enfilade_geometry::Mesh>>> {
        if let Ok(mesh) = value.cast::<Self>() {
            return Ok(Some(mesh.get().0.clone()));
        }
        if let Ok((vertices, triangles)) = value.extract::<(Bound<'_, PyAny>, Bound<'_, PyAny>)>() {
            return Self::new(&vertices, &triangles, None, None).map(|mesh| Some(mesh.0));
        }
        let Some(vertices) = value.getattr_opt("vertices")? else { return Ok(None) };
        let Some(faces) = value.getattr_opt("faces")? else { return Ok(None) };
        // trimesh keeps texture coordinates with what the mesh looks like.
        let uvs = value.getattr_opt("visual")?.and_then(|visual| visual.getattr_opt("uv").ok()?).filter(|uvs| !uvs.is_none());
        Self::new(&vertices, &faces, None, uvs.as_ref()).map(|mesh| Some(mesh.0))
    }
}

#[pymethods]
impl Mesh {
    #[new]
    #[pyo3(signature = (vertices, triangles, *, normals=None, uvs=None))]
    fn new(
        vertices: &Bound<'_, PyAny>,
        triangles: &Bound<'_, PyAny>,
        normals: Option<&Bound<'_, PyAny>>,
        uvs: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let three = |v: [f64; 3]| Vec3::from(v.map(|v| v as f32));
        let positions = rows("vertices", vertices)?.into_iter().map(three).collect();
        let triangles = rows("triangles", triangles)?.into_iter().zip(0..).map(|(row, number)| indices(row, number));
        let normals = normals.map_or(Ok(Vec::new()), |normals| rows("normals", normals))?.into_iter().zip(0..);
        let uvs = uvs.map_or(Ok(Vec::new()), |uvs| rows("uvs", uvs))?;
        let mesh = enfilade_geometry::Mesh {
            positions,
            triangles: triangles.collect::<PyResult<_>>()?,
            normals: normals.map(|(normal, vertex)| unit(three(normal), vertex)).collect::<PyResult<_>>()?,
            uvs: uvs.into_iter().map(|uv| Vec2::from(uv.map(|v: f64| v as f32))).collect(),
        };
        mesh.validate().map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(Self(mesh.into()))
    }

    /// A box of a size (x, y, z), metres, about the origin: so that it stands on the floor, place it half its height above.
    #[staticmethod]
    #[pyo3(name = "box")]
    fn cuboid(size: [f32; 3]) -> PyResult<Self> {
        positive("size", &size)?;
        Ok(Self(enfilade_geometry::Mesh::cuboid(size.into()).into()))
    }

    /// A smooth sphere of a radius, metres, about the origin.
    ///
    /// steps: triangles around it, at least 3; a sphere has about `steps` squared triangles.
    #[staticmethod]
    #[pyo3(signature = (radius, steps=48))]
    fn sphere(radius: f32, steps: u32) -> PyResult<Self> {
        positive("radius", &[radius])?;
        if !(3..=4096).contains(&steps) {
            return Err(PyValueError::new_err(format!("steps is {steps}; expected 3 to 4096")));
        }
        Ok(Self(enfilade_geometry::Mesh::sphere(radius, steps).into()))
    }

    /// float32, n x 3.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        table(py, self.0.positions.iter().map(|p| p.to_array()))
    }

    /// uint32, m x 3: indices of vertices.
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        table(py, self.0.triangles.iter().copied())
    }

    /// float32, n x 3, of length 1; None where triangles are flat.
    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f32>>>> {
        let normals = &self.0.normals;
        (!normals.is_empty()).then(|| table(py, normals.iter().map(|n| n.to_array()))).transpose()
    }

    /// float32, n x 2; None where there are none.
    #[getter]
    fn uvs<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f32>>>> {
        let uvs = &self.0.uvs;
        (!uvs.is_empty()).then(|| table(py, uvs.iter().map(|uv| uv.to_array()))).transpose()
    }

    fn __repr__(&self) -> String {
        format!("<enfilade.Mesh: {} vertices, {} triangles>", self.0.positions.len(), self.0.triangles.len())
    }
}

/// An array of these rows.
fn table<'py, T: Element, const N: usize>(
    py: Python<'py>,
    rows: impl ExactSizeIterator<Item = [T; N]>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let count = rows.len();
    PyArray1::from_vec(py, rows.flatten().collect()).reshape([count, N])
}

fn indices(row: [f64; 3], number: usize) -> PyResult<[u32; 3]> {
    if row.iter().any(|index| index.fract() != 0.0 || !(0.0..f64::from(u32::MAX)).contains(index)) {
        return Err(PyValueError::new_err(format!("triangle {number} is {row:?}; expected 3 indices of vertices, from 0")));
    }
    Ok(row.map(|index| index as u32))
}

fn unit(normal: Vec3, vertex: usize) -> PyResult<Vec3> {
    normal.try_normalize().ok_or_else(|| PyValueError::new_err(format!("the normal of vertex {vertex} is {normal}; expected a direction")))
}

fn positive(name: &str, sizes: &[f32]) -> PyResult<()> {
    match sizes.iter().find(|size| !(size.is_finite() && **size > 0.0)) {
        Some(size) => Err(PyValueError::new_err(format!("{name} is {size}; expected more than 0"))),
        None => Ok(()),
    }
}
