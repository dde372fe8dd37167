//! Plugins and their parameters. What is read keeps its bytes; what is set is written as exporters write it.

use crate::error::{Place, SceneTextError};
use crate::value::Value;
use std::ops::Range;
use std::sync::Arc;

/// A run of bytes of the file that was read, or bytes that were made.
#[derive(Clone, Debug)]
pub(crate) enum Text {
    Read { file: Arc<[u8]>, range: Range<usize> },
    Made(Vec<u8>),
}

impl Text {
    pub fn bytes(&self) -> &[u8] {
        match self {
            Self::Read { file, range } => &file[range.clone()],
            Self::Made(bytes) => bytes,
        }
    }

    /// Position in its file: line and column; the beginning for bytes that were made.
    pub fn place(&self) -> Place {
        match self {
            Self::Read { file, range } => Place::of(file, range.start),
            Self::Made(_) => Place { line: 1, column: 1 },
        }
    }
}

impl From<&[u8]> for Text {
    fn from(bytes: &[u8]) -> Self {
        Self::Made(bytes.to_vec())
    }
}

/// One `name=value;` of a plugin.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Everything from the end of the item before to the value: blanks, comments, the name, the sign.
    pub(crate) before: Text,
    pub(crate) name: Text,
    pub(crate) value: Text,
    /// From the value to its `;`.
    pub(crate) after: Text,
}

impl Parameter {
    /// A parameter as exporters write it, on a line of its own.
    pub(crate) fn new(name: &[u8], value: &Value) -> Self {
        let before = [b"\n  ".as_slice(), name, b"="].concat();
        Self { before: Text::Made(before), name: name.into(), value: Text::Made(value.to_bytes()), after: Text::Made(b";".to_vec()) }
    }

    /// Name of the parameter.
    pub fn name(&self) -> &[u8] {
        self.name.bytes()
    }

    /// Value of the parameter as it is written.
    pub fn raw(&self) -> &[u8] {
        self.value.bytes()
    }

    /// Value of the parameter.
    ///
    /// # Errors
    /// When it is not one, with the place in the file.
    pub fn value(&self) -> Result<Value, SceneTextError> {
        Value::parse(self.value.bytes()).map_err(|error| error.moved_to(self.value.place()))
    }

    /// Gives it another value. The text around it stays.
    pub fn set(&mut self, value: &Value) {
        self.value = Text::Made(value.to_bytes());
    }

    /// Position in the file that was read: line and column.
    pub fn place(&self) -> Place {
        self.name.place()
    }
}

/// A plugin: a kind, a name that is unique in the scene, and parameters.
#[derive(Clone, Debug)]
pub struct Plugin {
    /// From the end of what came before to the kind.
    pub(crate) before: Text,
    pub(crate) kind: Text,
    /// Between kind and name.
    pub(crate) gap: Text,
    pub(crate) name: Text,
    /// From the name to the `{`.
    pub(crate) opening: Text,
    pub(crate) parameters: Vec<Parameter>,
    /// From the last parameter to the `}`.
    pub(crate) closing: Text,
}

impl Plugin {
    /// A plugin without parameters, as exporters write it.
    pub fn new(kind: &str, name: &str) -> Self {
        let made = |text: &str| Text::Made(text.as_bytes().to_vec());
        Self {
            before: made("\n\n"),
            kind: made(kind),
            gap: made(" "),
            name: made(name),
            opening: made(" {"),
            parameters: Vec::new(),
            closing: made("\n}"),
        }
    }

    /// Kind of the plugin, such as `GeomStaticMesh`.
    pub fn kind(&self) -> &[u8] {
        self.kind.bytes()
    }

    /// Name of the plugin, by which others refer to it.
    pub fn name(&self) -> &[u8] {
        self.name.bytes()
    }

    /// Parameters of the plugin in the order of the file.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// The parameter of a name. Of several with one name the last counts, as in V-Ray.
    pub fn parameter(&self, name: &str) -> Option<&Parameter> {
        self.parameters.iter().rev().find(|p| p.name() == name.as_bytes())
    }

    /// Value of a parameter; `None` where the plugin does not have it and V-Ray takes its default.
    ///
    /// # Errors
    /// When the value cannot be read.
    pub fn get(&self, name: &str) -> Result<Option<Value>, SceneTextError> {
        self.parameter(name).map(Parameter::value).transpose()
    }

    /// Sets a parameter in place or, if there is none, at the end.
    pub fn set(&mut self, name: &str, value: &Value) {
        match self.parameters.iter_mut().rev().find(|p| p.name() == name.as_bytes()) {
            Some(parameter) => parameter.set(value),
            None => self.parameters.push(Parameter::new(name.as_bytes(), value)),
        }
    }

    /// Removes all parameters of a name; returns how many there were.
    pub fn remove(&mut self, name: &str) -> usize {
        let before = self.parameters.len();
        self.parameters.retain(|p| p.name() != name.as_bytes());
        before - self.parameters.len()
    }

    /// All parameters, to be changed.
    pub fn parameters_mut(&mut self) -> &mut Vec<Parameter> {
        &mut self.parameters
    }

    /// Gives it another name. References to it are not changed.
    pub fn rename(&mut self, name: &str) {
        self.name = Text::Made(name.as_bytes().to_vec());
    }

    /// Position in the file that was read: line and column.
    pub fn place(&self) -> Place {
        self.kind.place()
    }
}
