//! The JSON of a glTF file, typed. Small omissions are filled in and numbers put right, but only when the file cannot be read without that.

use gltf::json::Root;
use serde_json::{Value, json};

/// Keys of other JSON that a message names.
const KEYS: usize = 6;
/// Whole numbers up to this are the same as floats.
const MAX_WHOLE: f64 = 9_007_199_254_740_992.0;

/// The typed JSON, or the place and the problem.
///
/// # Errors
/// When the text is not JSON, or not glTF 2.0.
pub(super) fn parse(text: &[u8]) -> Result<Root, (String, String)> {
    let error = match Root::from_slice(text) {
        Ok(root) => return Ok(root),
        Err(error) => error,
    };
    let problem =
        || (format!("line {} column {}", error.line(), error.column()), format!("not valid glTF JSON: {error}; export the file again"));
    let mut value: Value = serde_json::from_slice(&without_nan(text)).map_err(|_| problem())?;
    if let Some(version) = old_version(&value) {
        return Err(("asset.version".into(), format!("found glTF {version}, expected 2.0; convert the file to glTF 2.0")));
    }
    if let Some(keys) = value.as_object().filter(|root| !root.contains_key("asset") && !root.contains_key("meshes")) {
        let keys: Vec<&str> = keys.keys().map(String::as_str).take(KEYS).collect();
        let problem =
            format!("it has no \"asset\", so it is JSON of another program (with {}) and no glTF; give the glTF file", keys.join(", "));
        return Err(("whole file".into(), problem));
    }
    complete(&mut value);
    put_right(&mut value, "");
    let written = value.to_string();
    // The place in the file is known for the first mistake alone, which may have been put right.
    Root::from_slice(written.as_bytes())
        .map_err(|left| if without_place(&left) == without_place(&error) { problem() } else { unclear(&left) })
}

/// The text with `null` for what Python writes where a number is none or infinite, as in bounds of accessors.
fn without_nan(text: &[u8]) -> Vec<u8> {
    let (mut out, mut at, mut in_string) = (Vec::with_capacity(text.len()), 0, false);
    while let Some(&byte) = text.get(at) {
        let word = [&b"NaN"[..], b"-Infinity", b"Infinity"].into_iter().find(|word| !in_string && text[at..].starts_with(word));
        if let Some(word) = word {
            out.extend_from_slice(b"null");
            at += word.len();
            continue;
        }
        in_string ^= byte == b'"';
        out.push(byte);
        at += 1;
        // What is escaped does not end a text.
        if in_string && byte == b'\\' {
            out.extend(text.get(at));
            at += 1;
        }
    }
    out
}

fn unclear(error: &serde_json::Error) -> (String, String) {
    ("whole file".into(), format!("not valid glTF JSON: {}; export the file again", without_place(error)))
}

fn without_place(error: &serde_json::Error) -> String {
    let message = error.to_string();
    message.rsplit_once(" at line ").map_or(message.clone(), |(message, _)| message.to_string())
}

/// Flags, which are neither numbers nor text.
const FLAGS: [&str; 2] = ["doubleSided", "normalized"];
/// Values that are numbers or lists of numbers, beside those called a factor.
const NUMBERS: [&str; 14] = [
    "translation",
    "rotation",
    "scale",
    "matrix",
    "weights",
    "color",
    "intensity",
    "range",
    "ior",
    "yfov",
    "znear",
    "zfar",
    "aspectRatio",
    "alphaCutoff",
];
/// The name of numbers within lists of numbers.
const NUMBER_WITHIN: &str = "Factor";

fn is_number(key: &str) -> bool {
    NUMBERS.contains(&key) || key.ends_with("Factor") || key.ends_with("Strength") || key.ends_with("ConeAngle")
}

/// Corrects mistakes that other readers accept as well: whole numbers written as `3.0`, `null` for missing values, versions and names that
/// are numbers, numbers that are text, colours with or without alpha. `key` is the name of the value. The contents of extras stay.
fn put_right(value: &mut Value, key: &str) {
    match value {
        Value::Number(number) => {
            let whole = number.as_f64().filter(|_| number.is_f64()).filter(|v| v.fract() == 0.0 && v.abs() < MAX_WHOLE);
            if matches!(key, "version" | "minVersion") {
                *value = number.as_f64().map_or_else(|| number.to_string(), |v| format!("{v:.1}")).into();
            } else if key == "name" {
                *value = number.to_string().into();
            } else if let Some(whole) = whole {
                *value = (whole as i64).into();
            }
        }
        Value::String(text) if matches!(text.as_str(), "true" | "false") && FLAGS.contains(&key) => *value = (text == "true").into(),
        Value::String(text) if is_number(key) => {
            if let Some(number) = text.trim().parse::<f64>().ok().and_then(serde_json::Number::from_f64) {
                *value = Value::Number(number);
            }
        }
        Value::Array(list) => {
            let key = if is_number(key) { NUMBER_WITHIN } else { "" };
            list.iter_mut().for_each(|item| put_right(item, key));
        }
        Value::Object(table) => {
            table.retain(|_, item| !item.is_null());
            for (key, length) in [("baseColorFactor", 4), ("emissiveFactor", 3), ("color", 3)] {
                if let Some(list) = table.get_mut(key).and_then(Value::as_array_mut).filter(|list| matches!(list.len(), 3 | 4)) {
                    list.resize(length, json!(1.0));
                }
            }
            table.iter_mut().filter(|(key, _)| *key != "extras").for_each(|(key, item)| put_right(item, key));
        }
        _ => (),
    }
}

/// The version of a file before glTF 2.0, whose lists are maps by name.
fn old_version(root: &Value) -> Option<String> {
    let version = root.get("asset").and_then(|a| a.get("version"));
    let stated = version.map(|v| v.as_str().map_or_else(|| v.to_string(), str::to_string));
    let is_old = stated.as_ref().is_some_and(|v| v.starts_with("0.") || v.starts_with("1."));
    let has_maps = ["buffers", "meshes", "nodes", "scenes"].iter().any(|list| root.get(*list).is_some_and(Value::is_object));
    (is_old || has_maps).then(|| stated.unwrap_or_else(|| "1.0".into()))
}

/// Gives scenes without nodes an empty list of them, and removes channels of animations that move no node (those of extensions, or without a target).
fn complete(root: &mut Value) {
    let list = |root: &mut Value, key: &str| root.get_mut(key).and_then(Value::as_array_mut).map(std::mem::take).unwrap_or_default();
    let mut scenes = list(root, "scenes");
    for scene in scenes.iter_mut().filter_map(Value::as_object_mut) {
        scene.entry("nodes").or_insert_with(|| json!([]));
    }
    let mut animations = list(root, "animations");
    for channels in animations.iter_mut().filter_map(|a| a.get_mut("channels")?.as_array_mut()) {
        channels.retain(|channel| channel.get("target").and_then(|target| target.get("node")).is_some());
    }
    for (key, list) in [("scenes", scenes), ("animations", animations)] {
        if let Some(place) = root.get_mut(key).filter(|place| place.is_array()) {
            *place = list.into();
        }
    }
}
