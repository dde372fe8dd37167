//! A layer: one file's opinions, by the paths of what they are about.

use super::value::Value;
use std::collections::HashMap;
use std::rc::Rc;

/// Deepest nesting of prims, dictionaries and lists; beyond it a file is taken for damaged.
pub(super) const MAX_DEPTH: usize = 128;

/// Longest path, bytes.
pub(super) const MAX_PATH: usize = 4096;

/// Time codes a second where a layer states none.
const DEFAULT_CODES_PER_SECOND: f64 = 24.0;

/// Names of fields. Both encodings are brought to those of the binary one.
pub(super) mod field {
    pub const SPECIFIER: &str = "specifier";
    pub const TYPE: &str = "typeName";
    pub const CHILDREN: &str = "primChildren";
    pub const PROPERTIES: &str = "properties";
    pub const DEFAULT: &str = "default";
    pub const SAMPLES: &str = "timeSamples";
    pub const CONNECTIONS: &str = "connectionPaths";
    pub const TARGETS: &str = "targetPaths";
    pub const REFERENCES: &str = "references";
    pub const PAYLOAD: &str = "payload";
    pub const INHERITS: &str = "inheritPaths";
    pub const SPECIALIZES: &str = "specializes";
    pub const VARIANT_SETS: &str = "variantSetNames";
    pub const VARIANTS: &str = "variantSelection";
    pub const SUBLAYERS: &str = "subLayers";
    pub const SUBLAYER_OFFSETS: &str = "subLayerOffsets";
    pub const SCHEMAS: &str = "apiSchemas";
}

/// The fields of a prim, property, variant or of the layer itself.
pub(super) type Fields = Vec<(Rc<str>, Value)>;

/// The opinions of one file.
#[derive(Debug, Default)]
pub(super) struct Layer {
    /// Location of the layer: a path relative to the scene file's folder, with `[inner]` for files in an archive.
    pub location: String,
    /// Fields by path: `/` is the layer, `/A/B` a prim, `/A{set=name}` a variant, `/A.points` a property.
    pub specs: HashMap<String, Fields>,
}

impl Layer {
    /// Time codes a second.
    pub(super) fn codes_per_second(&self) -> f64 {
        let stated = |name: &str| self.get("/", name).and_then(Value::as_number).filter(|rate| rate.is_finite() && *rate > 0.0);
        stated("timeCodesPerSecond").or_else(|| stated("framesPerSecond")).unwrap_or(DEFAULT_CODES_PER_SECOND)
    }

    /// A field of a path.
    pub(super) fn get(&self, path: &str, field: &str) -> Option<&Value> {
        self.specs.get(path)?.iter().find(|(name, _)| &**name == field).map(|(_, value)| value)
    }
}

/// The path of a child prim. There is no slash between a variant and a prim in it.
pub(super) fn child_path(parent: &str, name: &str) -> String {
    let slash = if parent.ends_with(['/', '}']) { "" } else { "/" };
    format!("{parent}{slash}{name}")
}

/// The path of a property.
pub(super) fn property_path(prim: &str, name: &str) -> String {
    format!("{prim}.{name}")
}

/// The prim and the property of a path such as `/A/B.inputs:file`.
pub(super) fn split_property(path: &str) -> (&str, &str) {
    path.split_once('.').unwrap_or((path, ""))
}

/// A path without its variants.
pub(super) fn without_variants(path: &str) -> String {
    let mut out = String::with_capacity(path.len());
    for (i, piece) in path.split('{').enumerate() {
        if i == 0 {
            out.push_str(piece);
        } else if let Some((_, rest)) = piece.split_once('}') {
            if !rest.is_empty() && !rest.starts_with(['.', '/']) {
                out.push('/');
            }
            out.push_str(rest);
        }
    }
    out
}

/// `path` with `from` at its beginning replaced by `to`; `None` when it is not there.
pub(super) fn moved(path: &str, from: &str, to: &str) -> Option<String> {
    if from == "/" {
        return Some(if to == "/" { path.to_string() } else { format!("{to}{path}") });
    }
    let rest = path.strip_prefix(from)?;
    (rest.is_empty() || rest.starts_with(['/', '.']))
        .then(|| if to == "/" && rest.starts_with('/') { rest.to_string() } else { format!("{to}{rest}") })
}

/// An absolute path from one that may be relative to the prim `at`.
pub(super) fn absolute(path: &str, at: &str) -> String {
    if path.starts_with('/') || path.is_empty() {
        return path.to_string();
    }
    let (prim, property) = match path.rsplit_once('/') {
        // A dot that is not a step up begins a property.
        _ if path.starts_with('.') && !path.starts_with("..") => ("", Some(&path[1..])),
        Some((folder, last)) if last != ".." && last.contains('.') => {
            let (name, property) = split_property(last);
            return absolute(&format!("{folder}/{name}"), at) + "." + property;
        }
        None if path != ".." && path.contains('.') => (split_property(path).0, Some(split_property(path).1)),
        _ => (path, None),
    };
    let mut steps: Vec<&str> = at.split('/').filter(|s| !s.is_empty()).collect();
    for step in prim.split('/').filter(|s| !s.is_empty() && *s != ".") {
        if step == ".." {
            steps.pop();
        } else {
            steps.push(step);
        }
    }
    let prim = format!("/{}", steps.join("/"));
    property.map_or(prim.clone(), |p| property_path(&prim, p))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_joined_moved_and_made_absolute() {
        assert_eq!(child_path("/", "A"), "/A");
        assert_eq!(child_path("/A{v=x}", "B"), "/A{v=x}B");
        assert_eq!(without_variants("/A{v=x}B/C{w=y}.p"), "/A/B/C.p");
        assert_eq!(without_variants("/A{v=x}{w=y}B"), "/A/B");
        assert_eq!(moved("/A/B.c", "/A", "/W/X").as_deref(), Some("/W/X/B.c"));
        assert_eq!(moved("/AB", "/A", "/W"), None);
        for (path, expected) in [("../C", "/A/C"), ("C.x:y", "/A/B/C.x:y"), (".out", "/A/B.out"), ("../../D/E.o", "/D/E.o"), ("/Z", "/Z")] {
            assert_eq!(absolute(path, "/A/B"), expected);
        }
    }
}
