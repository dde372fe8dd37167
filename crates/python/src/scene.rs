//! `enfilade.Scene`: a scene in memory, of which pictures are made without a dataset.

use crate::camera::Camera;
use crate::errors::IntoPy;
use crate::interrupt::{Interrupt, watched};
use crate::json;
use crate::progress::Bar;
use crate::scene_files::{file_source, home_config};
use enfilade_export::scene_encoder;
use enfilade_pipeline::{LabelSource, LoadedScene};
use enfilade_scene::WorldMesh;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// A scene in memory: `Scene.read` reads a file in any format that enfilade imports, `Scene.home` makes a furnished home.
///
/// `scene.camera()` finds a good place, and `enfilade.render(scene, camera)` makes a picture of it with every layer. What rays need is prepared
/// for the first picture and kept for all others. The world is right-handed with z up, in metres.
#[pyclass(module = "enfilade", frozen)]
pub struct Scene(pub LoadedScene);

#[pymethods]
impl Scene {
    /// Reads a scene file; the options are those of `import_scene`, and as there what was dropped or guessed is in `warnings` and `report`.
    ///
    /// {options}
    /// labels: a table of part or material names and their NYU40 classes, instead of the labels that come with the file.
    /// label_scene: the name of the scene in the table's column `scene`; that of the file, without its extension, unless given.
    /// progress: shows how far it has come; unless given, in notebooks and terminals.
    #[staticmethod]
    #[pyo3(signature = (file, *, labels=None, label_scene=None, progress=None, **options))]
    fn read(
        py: Python<'_>,
        file: PathBuf,
        labels: Option<PathBuf>,
        label_scene: Option<String>,
        progress: Option<bool>,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let source = file_source(&file, options, "Scene.read", &["file", "labels", "label_scene", "progress"])?;
        let own_name = || enfilade_pipeline::scene_file_of(&file).with_extension("").to_string_lossy().into_owned();
        let labels =
            labels.map(|table| LabelSource { table: table.to_string_lossy().into_owned(), scene: label_scene.unwrap_or_else(own_name) });
        let bar = Bar::new(py, progress, "read")?;
        watched(py, &bar, |cx: &Interrupt| LoadedScene::read(&source, labels.as_ref(), cx)).map(Self)
    }

    /// Makes a furnished, labelled home of a seed; the options are those of `enfilade.home`.
    ///
    /// {options}
    #[staticmethod]
    #[pyo3(signature = (**options))]
    fn home(py: Python<'_>, options: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let config = home_config(options, "Scene.home", &[])?;
        watched(py, &Bar::none(), |cx: &Interrupt| LoadedScene::home(&config, cx)).map(Self)
    }

    /// A camera at a good place: the file's camera `name`, or, without a name, the first of the file's cameras that stands in a room or else
    /// sees something, else the view from a place in a room that shows most, which takes seconds to find the first time. Where there is no room, from outside.
    ///
    /// size: width and height of pictures, pixels. fov_x_deg: horizontal field of view, degrees; that of the file's camera, or 75, unless given.
    #[pyo3(signature = (name=None, *, size=[640, 480], fov_x_deg=None))]
    fn camera(&self, py: Python<'_>, name: Option<&str>, size: [u32; 2], fov_x_deg: Option<f64>) -> PyResult<Camera> {
        let (start, _) = watched(py, &Bar::none(), |cx: &Interrupt| self.0.view(name, cx))?;
        let fov_x_deg = fov_x_deg.unwrap_or(start.fov_x_rad.to_degrees());
        Camera::pinhole(size, fov_x_deg, start.pose(0), start.name.clone())
    }

    /// Writes the scene with its labels as a scene package (.scene) or binary glTF (.glb), and gives what the file cannot hold.
    fn save(&self, py: Python<'_>, file: PathBuf) -> PyResult<Vec<String>> {
        let encode = scene_encoder(&file).map_err(IntoPy::into_py)?;
        py.detach(|| self.0.save(&file, encode)).map_err(IntoPy::into_py)
    }

    /// Name of the scene: that of its file without the extension.
    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    /// One line: numbers of parts, triangles, materials and images, and its size.
    #[getter]
    fn summary(&self, py: Python<'_>) -> String {
        py.detach(|| self.0.summary())
    }

    /// 2 x 3, metres: lowest and highest x, y and z.
    #[getter]
    fn bounds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let bounds = py.detach(|| WorldMesh::new(self.0.scene()).bounds);
        let corners = [bounds.min, bounds.max].map(|corner| corner.as_dvec3().to_array());
        PyArray1::from_vec(py, corners.concat()).reshape([2, 3])
    }

    /// Number of triangles, those of meshes in several places counted each time.
    #[getter]
    fn triangles(&self) -> usize {
        let scene = self.0.scene();
        scene.parts.iter().map(|part| scene.meshes[part.mesh as usize].triangles.len()).sum()
    }

    /// Names of the parts: `render_entity_id` of the first is 1.
    #[getter]
    fn parts(&self) -> Vec<&str> {
        self.0.scene().parts.iter().map(|part| part.name.as_str()).collect()
    }

    /// int16, parts x 2: class (NYU40) and instance of every part; -1 is none.
    #[getter]
    fn labels<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i16>>> {
        let parts = &self.0.labels().parts;
        let rows: Vec<i16> = parts.iter().flat_map(|label| [label.semantic, label.instance]).collect();
        PyArray1::from_vec(py, rows).reshape([parts.len(), 2])
    }

    /// Names of the materials: `material_id` of the first is 1.
    #[getter]
    fn materials(&self) -> Vec<&str> {
        self.0.scene().materials.iter().map(|material| material.name.as_str()).collect()
    }

    /// Names of the cameras that came with it.
    #[getter]
    fn cameras(&self) -> Vec<&str> {
        self.0.scene().cameras.iter().map(|camera| camera.name.as_str()).collect()
    }

    /// What was dropped, guessed or fixed: dictionaries with `place` and `message`.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        json::to_python(py, &self.0.warnings())
    }

    /// The import's report (format, counts, warnings); of a home its rooms, and the credits of models in it.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        json::to_python(py, self.0.report())
    }

    /// The plan as a drawing in SVG, `width` pixels across: what a level plane at two fifths of the height cuts, x to the right and y up.
    #[pyo3(signature = (width=400))]
    fn plan_svg(&self, py: Python<'_>, width: u32) -> String {
        py.detach(|| self.0.plan_svg(width))
    }

    fn _repr_html_<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        this.py().import("enfilade._display")?.call_method1("scene_html", (this,))
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        format!("<enfilade.Scene {:?}: {}>", self.0.name(), py.detach(|| self.0.summary()))
    }
}
