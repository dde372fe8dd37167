//! The functions that make scene files: `enfilade.import_scene` and `enfilade.home`.

use crate::arguments::Names;
use crate::errors::IntoPy;
use crate::interrupt::{Interrupt, interruptible};
use crate::json;
use enfilade_export::scene_encoder;
use enfilade_pipeline::{EnvironmentOverride, FileSource, HomeConfig, Lamps, Moment, RoomKind, UpAxis, scene_file_of};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Imports a scene file (.gltf, .glb, .obj, .xml, .pbrt, .pbrt.gz, .ply, .usd, .usda, .usdc, .usdz, .fbx, .dae, .stl, .urdf, .sdf, .world,
/// .zip, .sh3d, .sh3f, .vrscene, .json, .house, .semantic.txt, .scene) to a scene package (.scene) or binary glTF (.glb), and writes a
/// report beside it.
///
/// output: the file to write; the input's name with .scene, in the current folder, unless given.
/// meters_per_unit: metres per unit of the file.
/// up_axis: "y", "z", "x", "-x", "-y" or "-z"; as its format says unless given.
/// environment: an equirectangular picture that lights the scene instead of the file's own surroundings, or "sky" or "overcast".
/// lamps: "ceiling" hangs lamps from the ceiling of every room.
/// drop_doubled_faces: of faces with the same corners keeps the first.
/// panes: makes clear panes of parts or materials of these names, in which `*` stands for any characters.
/// allow_missing_textures: goes on with plain grey where a texture is missing.
/// allow_missing_meshes: goes on without a mesh whose file is missing or damaged.
///
/// Gives a dictionary: `scene` and `report` (paths), `summary`, `warnings` (dropped, guessed or fixed), `lost` (what the output cannot hold).
/// The scenes of a dataset are imported by `enfilade.stage("import", dataset)`.
#[pyfunction]
#[pyo3(signature = (file, output=None, *, meters_per_unit=1.0, up_axis=None, environment=None, lamps=None, drop_doubled_faces=false, panes=None,
    allow_missing_textures=false, allow_missing_meshes=false))]
pub fn import_scene<'py>(
    py: Python<'py>,
    file: PathBuf,
    output: Option<PathBuf>,
    meters_per_unit: f64,
    up_axis: Option<&str>,
    environment: Option<PathBuf>,
    lamps: Option<&str>,
    drop_doubled_faces: bool,
    panes: Option<Names>,
    allow_missing_textures: bool,
    allow_missing_meshes: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let output = output.unwrap_or_else(|| scene_file_of(&file));
    let source = file_source(&file, meters_per_unit, up_axis, environment, lamps, drop_doubled_faces, panes, allow_missing_textures)?;
    let source = FileSource { allow_missing_meshes, ..source };
    let encode = scene_encoder(&output).map_err(IntoPy::into_py)?;
    let imported = interruptible(py, |cx: &Interrupt| enfilade_pipeline::import_file(&source, &output, encode, cx))?;
    let done = json!({ "scene": output, "report": imported.report, "summary": imported.summary, "warnings": imported.warnings, "lost": imported.lost });
    json::to_python(py, &done)
}

/// Makes a furnished home of a seed, with its labels, as a scene package (.scene) or binary glTF (.glb).
///
/// rooms: kinds of rooms (living, kitchen, dining, bedroom, childrens, study, bathroom, toilet, hall, laundry), each as often as wanted; four to
/// eight, as the seed decides, unless given.
/// seed: of everything random. layout, furniture, materials, light: seeds of that alone.
/// realism: share of the colours that go together. clutter: density of small things; 0 has none but what shelves and cabinets hold, 1 is a
/// home that is lived in, 2 is untidy. moment: "day", "evening" or "night"; as the seed decides unless given.
/// assets: folders of glTF models, or furniture of Sweet Home 3D (.sh3f), to take in place of our own furniture where a model fits.
/// assets_share: share of the things for which a model fits that are models.
/// allow_broken_assets: goes on with our own furniture where a model is broken.
///
/// Gives a dictionary: `scene` (path), `summary`, `rooms`, `lost` (what the output cannot hold), `credits` (of the models that are in it).
#[pyfunction]
#[pyo3(signature = (output=PathBuf::from("home.scene"), *, rooms=None, seed=0, layout=None, furniture=None, materials=None, realism=1.0,
    light=None, moment=None, clutter=1.0, assets=None, assets_share=1.0, allow_broken_assets=false))]
pub fn home<'py>(
    py: Python<'py>,
    output: PathBuf,
    rooms: Option<Names>,
    seed: u64,
    layout: Option<u64>,
    furniture: Option<u64>,
    materials: Option<u64>,
    realism: f32,
    light: Option<u64>,
    moment: Option<&str>,
    clutter: f32,
    assets: Option<Names>,
    assets_share: f32,
    allow_broken_assets: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let seeds = [layout, furniture, materials, light];
    let config = home_config(rooms, seed, seeds, realism, moment, clutter, assets, assets_share, allow_broken_assets)?;
    let encode = scene_encoder(&output).map_err(IntoPy::into_py)?;
    let made = interruptible(py, |cx: &Interrupt| enfilade_pipeline::make_home(&config, &output, encode, cx))?;
    let done = json!({ "scene": output, "summary": made.summary, "rooms": made.rooms, "lost": made.lost, "credits": made.credits });
    json::to_python(py, &done)
}

/// The file with what it does not say itself.
pub fn file_source(
    file: &Path,
    meters_per_unit: f64,
    up_axis: Option<&str>,
    environment: Option<PathBuf>,
    lamps: Option<&str>,
    drop_doubled_faces: bool,
    panes: Option<Names>,
    allow_missing_textures: bool,
) -> PyResult<FileSource> {
    let up_axis = match up_axis {
        None => None,
        Some(name) => match UpAxis::ALL.into_iter().find(|axis| axis.name() == name) {
            Some(axis) => Some(axis),
            None => {
                let known = UpAxis::ALL.map(|axis| format!("{:?}", axis.name())).join(", ");
                return Err(PyValueError::new_err(format!("up_axis is {name:?}; expected one of {known}")));
            }
        },
    };
    let lamps = match lamps {
        None => None,
        Some("ceiling") => Some(Lamps::Ceiling),
        Some(other) => return Err(PyValueError::new_err(format!("lamps is {other:?}; expected \"ceiling\""))),
    };
    let environment = environment.map(|written| EnvironmentOverride::named(&written.to_string_lossy()));
    let panes = panes.map_or_else(Vec::new, |names| names.list());
    let file = FileSource::of(file.to_string_lossy());
    Ok(FileSource { meters_per_unit, up_axis, environment, lamps, drop_doubled_faces, panes, allow_missing_textures, ..file })
}

/// What a home is made by; `seeds` are those of layout, furniture, materials and light.
pub fn home_config(
    rooms: Option<Names>,
    seed: u64,
    [layout, furniture, materials, light]: [Option<u64>; 4],
    realism: f32,
    moment: Option<&str>,
    clutter: f32,
    assets: Option<Names>,
    assets_share: f32,
    allow_broken_assets: bool,
) -> PyResult<HomeConfig> {
    let (rooms, moment) = (rooms.map_or(Ok(Vec::new()), |names| kinds(&names))?, moment.map(self::moment).transpose()?);
    let assets = assets.map_or_else(Vec::new, |names| names.list());
    let config = HomeConfig {
        seed,
        rooms,
        layout,
        furniture,
        materials,
        realism,
        light,
        moment,
        clutter,
        assets,
        assets_share,
        allow_broken_assets,
    };
    if let Some(problem) = config.problem() {
        return Err(PyValueError::new_err(problem));
    }
    Ok(config)
}

fn kinds(names: &Names) -> PyResult<Vec<RoomKind>> {
    let kind = |name: &String| {
        let known = || RoomKind::ALL.map(RoomKind::name).join(", ");
        RoomKind::from_name(name)
            .ok_or_else(|| PyValueError::new_err(format!("there are no rooms of the kind {name:?}; the kinds are: {}", known())))
    };
    names.list().iter().map(kind).collect()
}

fn moment(name: &str) -> PyResult<Moment> {
    match name {
        "day" => Ok(Moment::Day),
        "evening" => Ok(Moment::Evening),
        "night" => Ok(Moment::Night),
        other => Err(PyValueError::new_err(format!("moment is {other:?}; expected \"day\", \"evening\" or \"night\""))),
    }
}
