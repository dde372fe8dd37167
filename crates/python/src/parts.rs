//! `scene.parts`: the parts of a scene, by number and by name.

use crate::mesh::Mesh;
use crate::numbers::matrix_of;
use enfilade_options::closest;
use enfilade_scene::{LabelledScene, NYU40, PartId, PartLabel};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::{PyIndexError, PyKeyError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyIterator, PyList, PySlice};
use std::sync::Arc;

/// The parts of a scene, in the order of their numbers: a sequence. `parts[3]` and `parts["chair_1/seat"]` are parts, `parts[2:5]` is a list of
/// them, and `"chair_1/seat" in parts` tells whether there is one of the name.
#[pyclass(module = "enfilade", frozen, sequence)]
pub struct Parts(pub Arc<LabelledScene>);

#[pymethods]
impl Parts {
    /// Names of the parts, in their order.
    #[getter]
    fn names(&self) -> Vec<&str> {
        self.0.scene.parts.iter().map(|part| part.name.as_str()).collect()
    }

    fn __len__(&self) -> usize {
        self.0.scene.parts.len()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        self.list(py, 0..self.__len__())?.try_iter()
    }

    fn __contains__(&self, name: &Bound<'_, PyAny>) -> bool {
        let part = name.cast::<Part>().map(|part| part.get().part().name.clone());
        part.or_else(|_| name.extract::<String>()).is_ok_and(|name| self.0.scene.parts.iter().any(|part| part.name == name))
    }

    fn __getitem__<'py>(&self, py: Python<'py>, key: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let part = |index: usize| Part { scene: self.0.clone(), index };
        let count = self.__len__();
        if let Ok(name) = key.extract::<String>() {
            let found = self.0.scene.parts.iter().position(|part| part.name == name);
            return Ok(Bound::new(py, part(found.ok_or_else(|| self.unknown(&name))?))?.into_any());
        }
        if let Ok(slice) = key.cast::<PySlice>() {
            let range = slice.indices(count as isize)?;
            let indices = (0..range.slicelength as isize).map(|k| (range.start + k * range.step) as usize);
            return Ok(self.list(py, indices)?.into_any());
        }
        let wrong = |_| PyTypeError::new_err(format!("parts are found by number or name, not by {key:?}"));
        let index: isize = key.extract().map_err(wrong)?;
        let found = usize::try_from(if index < 0 { index + count as isize } else { index }).ok().filter(|found| *found < count);
        let found = found.ok_or_else(|| PyIndexError::new_err(format!("part {index} of a scene of {count} parts")))?;
        Ok(Bound::new(py, part(found))?.into_any())
    }

    fn __repr__(&self) -> String {
        format!("<enfilade.Parts: {}>", self.__len__())
    }
}

impl Parts {
    fn list<'py>(&self, py: Python<'py>, indices: impl Iterator<Item = usize>) -> PyResult<Bound<'py, PyList>> {
        let parts = indices.map(|index| Py::new(py, Part { scene: self.0.clone(), index })).collect::<PyResult<Vec<_>>>()?;
        PyList::new(py, parts)
    }

    fn unknown(&self, name: &str) -> PyErr {
        let meant = closest(name, &self.names()).map_or(String::new(), |nearest| format!("; did you mean {nearest:?}?"));
        PyKeyError::new_err(format!("the scene has no part {name:?}{meant}"))
    }
}

/// A part of a scene: what is seen as one, with one mesh and one material. It belongs to the scene as that was: edits give scenes with other parts.
#[pyclass(module = "enfilade", frozen)]
pub struct Part {
    scene: Arc<LabelledScene>,
    index: usize,
}

impl Part {
    /// The part in Rust.
    pub fn part(&self) -> &enfilade_scene::Part {
        &self.scene.scene.parts[self.index]
    }

    fn own_label(&self) -> PartLabel {
        self.scene.labels.parts.get(self.index).copied().unwrap_or(PartLabel::NONE)
    }
}

#[pymethods]
impl Part {
    /// Name of the part, which no other part of the scene has.
    #[getter]
    fn name(&self) -> &str {
        &self.part().name
    }

    /// Name of the object that it is a part of; None if it is a thing by itself.
    #[getter]
    fn object(&self) -> Option<&str> {
        self.part().object.map(|object| self.scene.scene.objects[object as usize].name.as_str())
    }

    /// What it is in the layer `render_entity_id`: its number, counted from 1.
    #[getter]
    fn render_entity_id(&self) -> usize {
        self.index + 1
    }

    /// Name of its class in NYU40, such as "lamp"; None if it has no label.
    #[getter]
    fn label(&self) -> Option<&'static str> {
        NYU40.iter().find(|class| class.id == self.own_label().semantic).map(|class| class.name)
    }

    /// Number of its class in NYU40, 1 to 40, as in the layer `semantic`; -1 if it has no label.
    #[getter]
    fn semantic(&self) -> i16 {
        self.own_label().semantic
    }

    /// Number of its instance, as in the layer `semantic_instance`; -1 is none, as of walls.
    #[getter]
    fn instance(&self) -> i16 {
        self.own_label().instance
    }

    /// Triangles of the part in their own space; `pose` places them.
    #[getter]
    fn mesh(&self) -> Mesh {
        Mesh(self.scene.scene.meshes[self.part().mesh as usize].clone())
    }

    /// Name of its material.
    #[getter]
    fn material(&self) -> &str {
        &self.scene.scene.materials[self.part().material as usize].name
    }

    /// 4 x 4, mesh to world, metres. A matrix that mirrors has a mesh whose triangles are clockwise before and counter-clockwise after it.
    #[getter]
    fn pose<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix_of(py, &self.part().world_from_mesh)
    }

    /// 2 x 3, metres: least and greatest x, y and z in the world.
    #[getter]
    #[pyo3(name = "box")]
    fn bounds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let corners = py.detach(|| self.scene.scene.part_bounds(self.index as PartId));
        PyArray1::from_vec(py, corners.map(|corner| corner.to_array()).concat()).reshape([2, 3])
    }

    fn __repr__(&self) -> String {
        let class = self.label().map_or(String::new(), |label| format!(", a {label}"));
        format!("<enfilade.Part {:?}{class}, of {:?}>", self.name(), self.material())
    }
}

/// The names of what is to be edited: a part, a name of a part or object, or several of either.
pub fn names(value: &Bound<'_, PyAny>) -> PyResult<Vec<String>> {
    fn one(value: &Bound<'_, PyAny>) -> Option<String> {
        value.cast::<Part>().map(|part| part.get().part().name.clone()).ok().or_else(|| value.extract().ok())
    }
    let wrong = |found: &Bound<'_, PyAny>| {
        PyTypeError::new_err(format!("found {found:?}; expected parts, names of parts or objects, or a list of them"))
    };
    match one(value) {
        Some(name) => Ok(vec![name]),
        None => {
            value.try_iter().map_err(|_| wrong(value))?.map(|item| item.and_then(|item| one(&item).ok_or_else(|| wrong(&item)))).collect()
        }
    }
}

/// The NYU40 class of a name or number.
pub fn class(value: &Bound<'_, PyAny>) -> PyResult<i16> {
    let refused = |problem: String| Err(pyo3::exceptions::PyValueError::new_err(problem));
    if let Ok(name) = value.extract::<String>() {
        let found = NYU40.iter().find(|class| class.name == name).map(|class| class.id);
        let names: Vec<&str> = NYU40.iter().map(|class| class.name).collect();
        let meant = || closest(&name, &names).map_or(String::new(), |nearest| format!("did you mean {nearest:?}? "));
        return found.map_or_else(|| refused(format!("NYU40 has no class {name:?}; {}enfilade.NYU40 lists them", meant())), Ok);
    }
    let number: i64 =
        value.extract().map_err(|_| PyTypeError::new_err(format!("label is {value:?}; expected a class of NYU40, by name or number")))?;
    match i16::try_from(number) {
        Ok(number @ 1..=40) => Ok(number),
        _ => refused(format!("label is {number}; expected a class of NYU40: 1 to 40, or its name")),
    }
}
