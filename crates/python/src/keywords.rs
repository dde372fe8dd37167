//! Keyword arguments that are options declared once: `**options` of a function becomes the struct that declares them.

use crate::arguments::Names;
use crate::dataset_options::DatasetOptions;
use crate::json;
use crate::render_options::RenderOptions;
use enfilade_export::ExportOptions;
use enfilade_farm::{PlanOptions, SubmitOptions};
use enfilade_options::text::parse_frame;
use enfilade_options::{Form, Given, Options, Spec, proposal};
use enfilade_pipeline::{FileSource, HomeConfig, Overrides, ProductOptions, RenderChoices};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Value, json};

/// A struct of options, whichever it is.
pub trait Target {
    /// Every option of the struct.
    fn declared(&self) -> &'static [Spec];

    /// Sets an option; what was expected where it cannot be set.
    fn give(&mut self, name: &str, given: &Given) -> Result<(), String>;
}

impl<T: Options> Target for T {
    fn declared(&self) -> &'static [Spec] {
        T::OPTIONS
    }

    fn give(&mut self, name: &str, given: &Given) -> Result<(), String> {
        self.set(name, given)
    }
}

/// Applies the keywords to `targets`, each to the one that has its option; `None` is ignored. `function` also takes the keywords `own`,
/// which are not among them.
pub fn apply(targets: &mut [&mut dyn Target], keywords: Option<&Bound<'_, PyDict>>, function: &str, own: &[&str]) -> PyResult<()> {
    for (name, value) in keywords.into_iter().flat_map(|keywords| keywords.iter()) {
        let name: String = name.extract()?;
        let option = |target: &dyn Target| target.declared().iter().find(|spec| spec.name == name);
        let Some((target, spec)) = targets.iter_mut().find_map(|target| option(&**target).map(|spec| (target, spec))) else {
            let known = targets.iter().flat_map(|target| target.declared()).map(|spec| spec.name);
            let known: Vec<&str> = known.chain(own.iter().copied()).collect();
            let message = format!("{function}() got an unexpected keyword argument '{name}'; {}", proposal(&name, &known));
            return Err(PyTypeError::new_err(message));
        };
        if !value.is_none() {
            let wrong = |expected: String| PyValueError::new_err(format!("{name} is {}; {expected}", shown(&value)));
            target.give(&name, &given(&value, spec, &spec.form)?).map_err(wrong)?;
        }
    }
    Ok(())
}

/// Only the options; those without a keyword have their defaults.
pub fn options<T: Options>(keywords: Option<&Bound<'_, PyDict>>, function: &str, own: &[&str]) -> PyResult<T> {
    let mut options = T::default();
    apply(&mut [&mut options], keywords, function, own)?;
    Ok(options)
}

fn given(value: &Bound<'_, PyAny>, spec: &Spec, form: &Form) -> PyResult<Given> {
    let found = match form {
        Form::Switch => value.extract().map(Given::Switch),
        Form::Whole { .. } => value.extract().map(Given::Whole),
        Form::Integer => value.extract().map(Given::Integer),
        Form::Number => value.extract().map(Given::Number),
        Form::Interval { .. } => value.extract::<[f64; 2]>().map(|ends| Given::List(ends.map(Given::Number).to_vec())),
        Form::Text | Form::Word(_) => value.extract().map(Given::Text),
        Form::Path => value.extract().map(Given::Path),
        Form::Frame => value.extract::<FrameName>().and_then(|name| name.given(&form.expected())),
        Form::Size => value.extract::<[u64; 2]>().map(|size| Given::List(size.map(Given::Whole).to_vec())),
        Form::Two(element) => {
            let two: [Bound<'_, PyAny>; 2] = value.extract().map_err(|_| wrong_type(value, spec, form))?;
            return two.iter().map(|value| given(value, spec, element)).collect::<PyResult<_>>().map(Given::List);
        }
        Form::List(element) => return list(value, spec, element),
        Form::Table => return Err(PyTypeError::new_err(format!("argument '{}': {}", spec.name, form.expected()))),
    };
    // A value of the wrong type is a TypeError in Python's words; a number out of its range has a separate error.
    found.map_err(|error| match error.is_instance_of::<PyTypeError>(value.py()) {
        true => wrong_type(value, spec, form),
        false => error,
    })
}

fn wrong_type(value: &Bound<'_, PyAny>, spec: &Spec, form: &Form) -> PyErr {
    PyTypeError::new_err(format!("argument '{}': {}, found {}", spec.name, form.expected(), shown(value)))
}

/// A frame: its camera and number, or both as the command line has them.
#[derive(FromPyObject)]
enum FrameName {
    Parts(String, u32),
    Text(String),
}

impl FrameName {
    fn given(self, expected: &str) -> PyResult<Given> {
        let named = match self {
            Self::Parts(camera, number) => Some((camera, number)),
            Self::Text(text) => parse_frame(&text).ok(),
        };
        let (camera, number) = named.ok_or_else(|| PyValueError::new_err(expected.to_string()))?;
        Ok(Given::frame(camera, number.into()))
    }
}

/// A value that is one or a list of them.
fn list(value: &Bound<'_, PyAny>, spec: &Spec, element: &Form) -> PyResult<Given> {
    let texts = matches!(element, Form::Text | Form::Word(_)).then(|| value.extract::<Names>().ok()).flatten();
    if let Some(names) = texts {
        return Ok(Given::List(names.list().into_iter().map(Given::Text).collect()));
    }
    match given(value, spec, element) {
        Ok(only) => Ok(Given::List(vec![only])),
        Err(error) => {
            let values = value.try_iter().map_err(|_| error)?;
            values.map(|value| given(&value?, spec, element)).collect::<PyResult<_>>().map(Given::List)
        }
    }
}

/// The value as Python shows it.
fn shown(value: &Bound<'_, PyAny>) -> String {
    value.repr().map_or_else(|_| "what cannot be shown".into(), |text| text.to_string())
}

/// The options of the struct `name`, for signatures and doc strings: rows of name, default and sentence.
#[pyfunction]
pub fn declared<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    let options = match name {
        "DatasetOptions" => DatasetOptions::OPTIONS,
        "ExportOptions" => ExportOptions::OPTIONS,
        "FileSource" => FileSource::OPTIONS,
        "HomeConfig" => HomeConfig::OPTIONS,
        "Overrides" => Overrides::OPTIONS,
        "PlanOptions" => PlanOptions::OPTIONS,
        "ProductOptions" => ProductOptions::OPTIONS,
        "RenderOptions" => RenderOptions::OPTIONS,
        "RenderChoices" => RenderChoices::OPTIONS,
        "SubmitOptions" => SubmitOptions::OPTIONS,
        _ => return Err(PyValueError::new_err(format!("no options are declared by {name:?}"))),
    };
    let rows: Vec<Value> = options.iter().map(|spec| json!([spec.name, default(spec), format!("{}.", spec.about())])).collect();
    json::to_python(py, &rows)
}

/// The default, if Python can represent it; the sentence explains `None`.
fn default(spec: &Spec) -> Value {
    spec.word().map_or_else(|| serde_json::from_str(spec.literal()).unwrap_or(Value::Null), Value::from)
}
