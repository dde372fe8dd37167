//! `make`: products of finished frames, as the command line's verb of that name makes them.

use crate::arguments::{Frames, Names};
use crate::errors::IntoPy;
use crate::interrupt::{Interrupt, watched};
use crate::progress::Bar;
use crate::{json, keywords};
use enfilade_dataset::Dataset;
use enfilade_pipeline::{FrameChoice, Made, MakeOptions, PRODUCTS, Product, ProductOptions};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Keywords of `make` besides the options of products.
const OWN: [&str; 9] = ["dataset", "what", "stale", "force", "scenes", "cameras", "frames", "camera_table", "progress"];

/// Makes products of finished frames, each after those that it needs: "pairs", "flow", "tracks", "surfaces", "rooms", "words", "sensors" and
/// "relit". What is up to date is left alone; what it was asked for by is kept, so that a run, or `stale`, makes it again when it is out of date.
///
/// what: one or several of these. stale: makes again what is out of date, as it was asked for: of `what`, or of everything.
/// force: makes also what is up to date.
/// scenes, cameras: only these; `*` stands for any run of characters. frames: only these numbers, where a product is made by frame.
/// {options}
/// camera_table: another metadata_camera_parameters.csv.
/// progress: shows how far it has come; unless given, in notebooks and terminals.
///
/// Gives a list of what was made: product, scene, the number of parts made and kept, and lines about it.
#[pyfunction]
#[pyo3(signature = (dataset, what=None, *, stale=false, force=false, scenes=None, cameras=None, frames=None, camera_table=None, progress=None,
    **options))]
pub fn make<'py>(
    py: Python<'py>,
    dataset: PathBuf,
    what: Option<Names>,
    stale: bool,
    force: bool,
    scenes: Option<Names>,
    cameras: Option<Names>,
    frames: Option<Frames>,
    camera_table: Option<PathBuf>,
    progress: Option<bool>,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let products = what.iter().flat_map(Names::list).map(|name| product(&name)).collect::<PyResult<Vec<Product>>>()?;
    if products.is_empty() && !stale {
        return Err(PyValueError::new_err(format!("nothing is asked for: name one of {}, or give stale=True", words())));
    }
    let options: ProductOptions = keywords::options(options, "make", &OWN)?;
    let opened = Dataset::open(&dataset).map_err(IntoPy::into_py)?;
    let opened = match camera_table {
        Some(table) => opened.with_camera_table(table),
        None => opened,
    };
    let select = |what, names: &[String], chosen: Option<&Names>| {
        enfilade_pipeline::select(what, names, chosen.map(Names::pattern).as_deref()).map_err(IntoPy::into_py)
    };
    let scenes = select("scene", &opened.scenes().map_err(IntoPy::into_py)?, scenes.as_ref())?;
    let cameras = match &cameras {
        None => None,
        chosen => Some(select("camera", &opened.camera_names(&scenes).map_err(IntoPy::into_py)?, chosen.as_ref())?),
    };
    let of = FrameChoice { cameras, frames: frames.map(|frames| frames.range()).transpose()? };
    let bar = Bar::new(py, progress, "make")?;
    let made = watched(py, &bar, |cx: &Interrupt| match stale {
        true => enfilade_pipeline::make_stale(&opened, &scenes, &products, cx),
        false => enfilade_pipeline::make_products(&opened, &scenes, &products, (&options, &of), MakeOptions { force }, cx),
    })?;
    json::to_python(py, &made.iter().map(told).collect::<Vec<Value>>())
}

fn told(made: &Made) -> Value {
    json!({ "product": made.product.name(), "scene": made.scene, "made": made.made, "kept": made.kept, "lines": made.lines })
}

/// The product of that name.
fn product(name: &str) -> PyResult<Product> {
    let unknown = || PyValueError::new_err(format!("there is no product {name:?}; the products are: {}", words()));
    Product::from_name(name).ok_or_else(unknown)
}

fn words() -> String {
    PRODUCTS.iter().map(|spec| spec.name).collect::<Vec<_>>().join(", ")
}
