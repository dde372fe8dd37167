//! The parameters of a plugin as the types that an importer asks for.
//!
//! An animated parameter has the value of its first keyframe ([`Handle::is_animated`] is true for those). One that the plugin does not
//! state has the default that the caller gives, which is V-Ray's.

use super::plugins::Handle;
use crate::ImportError;
use enfilade_math::{DAffine3, DMat3, DVec3, Rgb};
use enfilade_vrscene::{Matrix, Value};

impl<'n> Handle<'n> {
    /// Kind of the plugin, such as `Node`; empty if it is not text.
    pub(super) fn kind(self) -> &'n str {
        std::str::from_utf8(self.plugin.kind()).unwrap_or_default()
    }

    /// Name of the parameter.
    pub(super) fn name(self) -> String {
        String::from_utf8_lossy(self.plugin.name()).into_owned()
    }

    /// Kind and name of the plugin, for messages.
    pub(super) fn place(self) -> String {
        format!("{} {}", self.kind(), self.name())
    }

    /// An error about one of its parameters.
    pub(super) fn error(self, parameter: &str, problem: impl AsRef<str>) -> ImportError {
        let place = self.plugin.parameter(parameter).map_or_else(|| self.plugin.place(), |p| p.place());
        ImportError::malformed(self.file, format!("{place}: {}: {parameter}", self.place()), problem.as_ref())
    }

    /// The value of a parameter; for an animated one the value of the first keyframe. `None` if the plugin does not have it.
    pub(super) fn value(self, parameter: &str) -> Result<Option<Value>, ImportError> {
        let value = self.plugin.get(parameter).map_err(|e| {
            let problem = format!("expected {}, found {}; export the scene again or correct the value", e.expected, e.found);
            ImportError::malformed(self.file, format!("{}: {}: {parameter}", e.place, self.place()), problem)
        })?;
        match value {
            Some(Value::Animated(keys)) => match keys.into_iter().next() {
                Some((_, first)) => Ok(Some(first)),
                None => Err(self.error(parameter, "found no keyframes, expected (frame, value); write a value")),
            },
            other => Ok(other),
        }
    }

    /// Number of keyframes of a parameter; 0 if it is not animated.
    pub(super) fn keyframes(self, parameter: &str) -> usize {
        match self.plugin.parameter(parameter) {
            Some(p) if p.raw().starts_with(b"interpolate") => match p.value() {
                Ok(Value::Animated(keys)) => keys.len(),
                _ => 0,
            },
            _ => 0,
        }
    }

    /// True when a parameter changes over time.
    pub(super) fn is_animated(self, parameter: &str) -> bool {
        self.keyframes(parameter) > 1
    }

    fn wrong_type(self, parameter: &str, found: &Value, expected: &str) -> ImportError {
        self.error(parameter, format!("found {}, expected {expected}; correct the value", shown(found)))
    }

    /// A finite number.
    pub(super) fn number(self, parameter: &str, default: f64) -> Result<f64, ImportError> {
        match self.value(parameter)? {
            None => Ok(default),
            Some(value) => match value.number() {
                Some(number) if number.is_finite() => Ok(number),
                _ => Err(self.wrong_type(parameter, &value, "a number")),
            },
        }
    }

    /// A truth value.
    pub(super) fn flag(self, parameter: &str, default: bool) -> Result<bool, ImportError> {
        Ok(self.number(parameter, f64::from(u8::from(default)))? != 0.0)
    }

    /// A whole number.
    pub(super) fn int(self, parameter: &str, default: i64) -> Result<i64, ImportError> {
        Ok(self.number(parameter, default as f64)? as i64)
    }

    /// A string; `None` where it is empty.
    pub(super) fn text(self, parameter: &str) -> Result<Option<String>, ImportError> {
        match self.value(parameter)? {
            None => Ok(None),
            Some(Value::Text(text)) if text.is_empty() => Ok(None),
            Some(Value::Text(text)) => Ok(Some(String::from_utf8_lossy(&text).into_owned())),
            Some(other) => Err(self.wrong_type(parameter, &other, "a string in quotes")),
        }
    }

    /// A colour without a texture, linear.
    pub(super) fn color(self, parameter: &str, default: Rgb) -> Result<Rgb, ImportError> {
        match self.value(parameter)? {
            None => Ok(default),
            Some(value) => match constant(&value) {
                Some(color) if color.is_finite() => Ok(color),
                _ => Err(self.wrong_type(parameter, &value, "Color(r, g, b)")),
            },
        }
    }

    /// True when a parameter for a texture states one: black and zero are V-Ray's defaults of such parameters, and `NULL` is none.
    pub(super) fn states_texture(self, parameter: &str) -> Result<bool, ImportError> {
        let Some(value) = self.value(parameter)? else { return Ok(false) };
        Ok(constant(&value).map_or_else(|| value.plugin().is_some_and(|name| name != b"NULL"), |color| !color.is_black()))
    }

    /// The parameter that counts: the one for a texture, which overrides the plain one where it is stated.
    pub(super) fn overriding<'p>(self, plain: &'p str, texture: &'p str) -> Result<&'p str, ImportError> {
        Ok(if self.states_texture(texture)? { texture } else { plain })
    }

    /// Three numbers.
    pub(super) fn vector(self, parameter: &str, default: DVec3) -> Result<DVec3, ImportError> {
        match self.value(parameter)? {
            None => Ok(default),
            Some(Value::Vector(v) | Value::Color(v)) => Ok(dvec3(v)),
            Some(other) => Err(self.wrong_type(parameter, &other, "Vector(x, y, z)")),
        }
    }

    /// A placement; the identity where the plugin does not have it.
    pub(super) fn transform(self, parameter: &str) -> Result<DAffine3, ImportError> {
        let placement = match self.value(parameter)? {
            None => return Ok(DAffine3::IDENTITY),
            Some(Value::Transform(t)) => DAffine3::from_mat3_translation(columns(&t.matrix), DVec3::from(t.offset)),
            Some(Value::Matrix(m)) => DAffine3::from_mat3(columns(&m)),
            Some(other) => return Err(self.wrong_type(parameter, &other, "Transform(Matrix(…), Vector(…))")),
        };
        if placement.is_finite() {
            return Ok(placement);
        }
        Err(self.error(parameter, "a number of the transform is not finite; correct the value"))
    }

    /// The plugin that a parameter refers to; `None` where it is absent or `NULL`.
    pub(super) fn reference(self, parameter: &str) -> Result<Option<Handle<'n>>, ImportError> {
        match self.value(parameter)? {
            None => Ok(None),
            Some(value) => self.resolve(parameter, &value),
        }
    }

    /// The plugin that a value of this plugin refers to.
    pub(super) fn resolve(self, parameter: &str, value: &Value) -> Result<Option<Handle<'n>>, ImportError> {
        match (value, value.plugin()) {
            (_, Some(b"NULL")) => Ok(None),
            (Value::Text(text), _) if text.is_empty() => Ok(None),
            (_, Some(name)) => self.plugins.named(name).map(Some).ok_or_else(|| {
                let name = String::from_utf8_lossy(name);
                self.error(parameter, format!("refers to {name}, but no plugin has this name; add the plugin or the file that it is in"))
            }),
            _ => Err(self.wrong_type(parameter, value, "the name of a plugin")),
        }
    }

    /// The plugins that a list refers to, empty places left out.
    pub(super) fn references(self, parameter: &str) -> Result<Vec<Handle<'n>>, ImportError> {
        let Some(value) = self.value(parameter)? else { return Ok(Vec::new()) };
        let values = match value {
            Value::List(_, values) => values,
            single => vec![single],
        };
        values.iter().filter_map(|value| self.resolve(parameter, value).transpose()).collect()
    }

    /// Whole numbers; empty where the plugin does not have them.
    pub(super) fn ints(self, parameter: &str) -> Result<Vec<i32>, ImportError> {
        let Some(value) = self.value(parameter)? else { return Ok(Vec::new()) };
        ints(&value).ok_or_else(|| self.wrong_type(parameter, &value, "ListInt(…)"))
    }

    /// Triples; empty where the plugin does not have them.
    pub(super) fn vectors(self, parameter: &str) -> Result<Vec<[f32; 3]>, ImportError> {
        let Some(value) = self.value(parameter)? else { return Ok(Vec::new()) };
        vectors(&value).ok_or_else(|| self.wrong_type(parameter, &value, "ListVector(…)"))
    }
}

/// Whole numbers of a list, of whichever kind it is.
pub(super) fn ints(value: &Value) -> Option<Vec<i32>> {
    match value {
        Value::Ints(list) => Some(list.clone()),
        Value::List(_, list) => list.iter().map(|v| if let Value::Int(i) = v { i32::try_from(*i).ok() } else { None }).collect(),
        _ => None,
    }
}

/// The triples of a list, of whichever kind it is.
pub(super) fn vectors(value: &Value) -> Option<Vec<[f32; 3]>> {
    match value {
        Value::Vectors(list) | Value::Colors(list) => Some(list.clone()),
        Value::List(_, list) => list.iter().map(|v| if let Value::Vector(v) | Value::Color(v) = v { Some(*v) } else { None }).collect(),
        _ => None,
    }
}

/// The colour of a value that is no texture. Numbers are greys.
pub(super) fn constant(value: &Value) -> Option<Rgb> {
    match value {
        Value::Color(c) | Value::Vector(c) => Some(Rgb::from(*c)),
        Value::AColor([r, g, b, _]) => Some(Rgb::new(*r, *g, *b)),
        other => other.number().map(|v| Rgb::splat(v as f32)),
    }
}

fn dvec3(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

/// V-Ray writes where the axes go: the columns.
fn columns(m: &Matrix) -> DMat3 {
    DMat3::from_cols(dvec3(m[0]), dvec3(m[1]), dvec3(m[2]))
}

/// A value for messages, cut short.
fn shown(value: &Value) -> String {
    const SHOWN: usize = 40;
    let text = String::from_utf8_lossy(&value.to_bytes()).into_owned();
    if text.chars().count() <= SHOWN { text } else { format!("{}…", text.chars().take(SHOWN).collect::<String>()) }
}
