//! `enfilade.Scene`: a scene in memory, of which pictures are made without a dataset.

use crate::camera::Camera;
use crate::errors::IntoPy;
use crate::interrupt::{Interrupt, watched};
use crate::light::Light;
use crate::material::Material;
use crate::parts::{self, Parts};
use crate::progress::Bar;
use crate::scene_files::{file_source, home_config};
use crate::{editing, json, keywords, numbers};
use enfilade_export::scene_encoder;
use enfilade_pipeline::{FilePlace, LabelSource, LoadedScene, MotionGroup};
use enfilade_scene::{Body, EditError, LabelledScene, NewThing, WorldMesh};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::json;
use std::path::PathBuf;

/// A scene in memory: `Scene.read` reads a file in any format that enfilade imports, `Scene.home` makes a furnished home, `Scene.empty` has nothing.
///
/// A scene is a value: `add`, `remove`, `move`, `scale`, `set_material` and the edits of lights and cameras each give a new scene, and leave this one as
/// it is.
///
/// `scene.camera()` finds a good place, and `enfilade.render(scene, camera)` makes a picture of it with every layer. What rays need is prepared
/// for the first picture and kept for all others. The world is right-handed with z up, in metres.
#[pyclass(module = "enfilade", frozen)]
pub struct Scene(pub LoadedScene);

impl Scene {
    /// The scene after an edit, made while the interpreter is free.
    pub fn edited(&self, py: Python<'_>, edit: impl FnOnce(&LabelledScene) -> Result<LabelledScene, EditError> + Send) -> PyResult<Self> {
        py.detach(|| self.0.edited(edit)).map(Self).map_err(IntoPy::into_py)
    }
}

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

    /// A scene without anything, to be filled by `add`.
    #[staticmethod]
    #[pyo3(signature = (name="scene"))]
    fn empty(name: &str) -> Self {
        Self(LoadedScene::empty(name))
    }

    /// The scene with something added, which is labelled as one instance: a new scene, as of every edit. Scenes share what did not change.
    ///
    /// source: a `Mesh` (or what stands for one, such as a mesh of trimesh); the path of a scene file in any format that `Scene.read` reads; or a
    /// scene. Lights of files and scenes come along; surroundings and cameras do not, and `warnings` says so.
    /// pose: where it is placed: 3 numbers (metres) for the position of its origin, or a matrix of 4 x 4 or 3 x 4; at the origin unless given. Matrices may
    /// scale and mirror, but not flatten.
    /// turn_deg: with a position, its turn about the vertical axis, counter-clockwise seen from above, degrees.
    /// name: of the part; of files and scenes of several parts, of their object, and before their names. The file's, or "part", unless given; where something
    /// has it, it gets a number.
    /// label: its class in NYU40, by name or number; files and scenes have their own labels unless given.
    /// material: a `Material`, or the name of one in the scene; a mesh is grey and others have their own unless given.
    /// meters_per_unit, up_axis, allow_missing_textures: of files, as of `Scene.read`.
    /// progress: shows how far reading has come; unless given, in notebooks and terminals.
    ///
    /// Meshes, poses and materials that no scene file may have are refused with a ValueError that names the part; a file that cannot be read is
    /// a RuntimeError.
    #[pyo3(signature = (source, pose=None, *, turn_deg=0.0, name=None, label=None, material=None, meters_per_unit=1.0, up_axis=None, allow_missing_textures=false, progress=None))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn add(
        &self,
        py: Python<'_>,
        source: &Bound<'_, PyAny>,
        pose: Option<&Bound<'_, PyAny>>,
        turn_deg: f64,
        name: Option<String>,
        label: Option<&Bound<'_, PyAny>>,
        material: Option<&Bound<'_, PyAny>>,
        meters_per_unit: f64,
        up_axis: Option<&str>,
        allow_missing_textures: bool,
        progress: Option<bool>,
    ) -> PyResult<Self> {
        let place = FilePlace {
            name,
            material: material.map(Material::choice).transpose()?,
            world_from_file: numbers::pose("pose", pose, turn_deg)?,
            class: label.map(parts::class).transpose()?,
        };
        if let Ok(other) = source.cast::<Self>() {
            let FilePlace { name, material, world_from_file: world_from_thing, class } = place;
            let (name, of) = (name.unwrap_or_else(|| other.get().0.name().into()), other.get().0.contents());
            return self.edited(py, |scene| scene.with_thing(&NewThing { name, of, material, world_from_thing, class }));
        }
        let options = editing::FileOptions { meters_per_unit, up_axis, allow_missing_textures, progress };
        editing::add(&self.0, py, source, place, &options).map(Self)
    }

    /// The scene without these parts, the lights that belong to them, and the meshes, materials and pictures that only they use.
    ///
    /// parts: the name of a part, or of an object, which stands for all of its parts; a `Part`; or several of these. Here and in the other edits,
    /// a name that the scene does not have is refused with a ValueError, which has the nearest name. Lights belong to what is named if their names
    /// begin with its name and a slash, as those of added files do.
    fn remove(&self, py: Python<'_>, parts: &Bound<'_, PyAny>) -> PyResult<Self> {
        let names = parts::names(parts)?;
        self.edited(py, |scene| scene.without(&names))
    }

    /// The scene with these parts moved together, and the lights that belong to them.
    ///
    /// parts: as of `remove`.
    /// by: how far: 3 numbers, metres, or a matrix of 4 x 4 or 3 x 4 in the world, after which the pose of each part is `by @ pose`.
    /// to: instead, the place for the middle of the bottom of the box around them, 3 numbers, metres.
    /// turn_deg: before that, they are turned about the vertical axis through the middle of their box, counter-clockwise seen from above, degrees.
    #[pyo3(name = "move", signature = (parts, by=None, *, to=None, turn_deg=0.0))]
    fn moved(
        &self,
        py: Python<'_>,
        parts: &Bound<'_, PyAny>,
        by: Option<&Bound<'_, PyAny>>,
        to: Option<[f64; 3]>,
        turn_deg: f64,
    ) -> PyResult<Self> {
        if by.is_some() == to.is_some() && (by.is_some() || turn_deg == 0.0) {
            return Err(PyValueError::new_err("say how far (by) or where to (to), and not both"));
        }
        let (names, by) = (parts::names(parts)?, numbers::pose("by", by, 0.0)?);
        self.edited(py, |scene| {
            let turned = if turn_deg == 0.0 { None } else { Some(scene.turned(&names, turn_deg.to_radians())?) };
            let scene = turned.as_ref().unwrap_or(scene);
            to.map_or_else(|| scene.moved(&names, by), |to| scene.moved_to(&names, to.into()))
        })
    }

    /// The scene with these parts larger or smaller.
    ///
    /// parts: as of `remove`.
    /// factor: one number, or three for x, y and z of the world; more than 0.
    /// about: the point that stays, metres; the middle of the bottom of the box around them unless given, so that what stands still stands.
    #[pyo3(signature = (parts, factor, *, about=None))]
    fn scale(&self, py: Python<'_>, parts: &Bound<'_, PyAny>, factor: &Bound<'_, PyAny>, about: Option<[f64; 3]>) -> PyResult<Self> {
        let names = parts::names(parts)?;
        let factors = factor.extract::<f64>().map_or_else(|_| numbers::three("factor", factor), |all| Ok([all; 3]))?;
        self.edited(py, |scene| scene.scaled(&names, factors.into(), about.map(Into::into)))
    }

    /// The scene with these parts made of a material.
    ///
    /// parts: as of `remove`. material: a `Material`, or the name of one in the scene.
    fn set_material(&self, py: Python<'_>, parts: &Bound<'_, PyAny>, material: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (names, material) = (parts::names(parts)?, Material::choice(material)?);
        self.edited(py, |scene| scene.with_material(&names, &material))
    }

    /// The scene in which a thing moves, as `[[motion]]` of a dataset moves it: `scene.animate(of="door_1*", times_s=[0, 2], angles_deg=[0, 90],
    /// point_m=[1.2, 0, 0])`. A thing may ride on an earlier one, by `on`. `at` gives the scene at a moment; `render` shows a scene that moves at rest;
    /// `save` keeps motion, in a `.scene` for datasets and in a `.glb` as an animation.
    ///
    /// {options}
    #[pyo3(signature = (**options))]
    fn animate(&self, py: Python<'_>, options: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let motion: MotionGroup = keywords::options(options, "Scene.animate", &[])?;
        py.detach(|| self.0.with_motion(&motion)).map(Self).map_err(IntoPy::into_py)
    }

    /// The scene as it is at a moment, seconds from the beginning; nothing in it moves any more.
    fn at(&self, py: Python<'_>, time_s: f64) -> PyResult<Self> {
        if !time_s.is_finite() {
            return Err(PyValueError::new_err(format!("time_s is {time_s}; expected a finite number of seconds")));
        }
        Ok(py.detach(|| Self(self.0.still_at(time_s))))
    }

    /// The scene with one more light; where a light has its name, it gets a number.
    fn add_light(&self, py: Python<'_>, light: &Light) -> PyResult<Self> {
        self.edited(py, |scene| scene.with_light(light.0.clone()))
    }

    /// The scene without the light of that name.
    fn remove_light(&self, py: Python<'_>, name: &str) -> PyResult<Self> {
        self.edited(py, |scene| scene.without_light(name))
    }

    /// The scene with one more camera, which `camera` finds by its name; where a camera has it, it gets a number.
    ///
    /// camera: a `Camera`, of which pose, horizontal field of view and the ratio of its sides are kept; no panorama.
    /// name: instead of the camera's.
    #[pyo3(signature = (camera, name=None))]
    fn add_camera(&self, py: Python<'_>, camera: &Camera, name: Option<String>) -> PyResult<Self> {
        let start = camera.start(name)?;
        self.edited(py, |scene| scene.with_camera(start))
    }

    /// The scene without the camera of that name.
    fn remove_camera(&self, py: Python<'_>, name: &str) -> PyResult<Self> {
        self.edited(py, |scene| scene.without_camera(name))
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

    /// Writes the scene with its labels as a scene package (.scene), binary glTF (.glb) or for simulators (.xml of MuJoCo, .urdf, .usda), and gives
    /// what the file cannot hold.
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

    /// The parts: a sequence of `Part`, by number and by name. `render_entity_id` of the first is 1.
    #[getter]
    fn parts(&self) -> Parts {
        Parts(self.0.contents().clone())
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

    /// The lights that are no surfaces.
    #[getter]
    fn lights(&self) -> Vec<Light> {
        self.0.scene().lights.iter().cloned().map(Light).collect()
    }

    /// What moves or can move, in the order of numbers: dictionaries with `name`, `parent` (the name of the body that bears it, or None), `joint` ("hinge",
    /// "slide", "free" or "deform"), `limits` (radians or metres from rest, or None), `moves` and `parts` (names).
    #[getter]
    fn bodies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let scene = self.0.scene();
        let row = |body: &Body| {
            json!({
                "name": body.name,
                "parent": body.parent.map(|parent| &scene.bodies[parent as usize].name),
                "joint": body.motion.states.joint(),
                "limits": body.limits,
                "moves": !body.motion.is_rest(),
                "parts": body.parts.iter().map(|&part| &scene.parts[part as usize].name).collect::<Vec<_>>(),
            })
        };
        json::to_python(py, &scene.bodies.iter().map(row).collect::<Vec<_>>())
    }

    /// Names of its cameras: `camera` gives each with its pose.
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
