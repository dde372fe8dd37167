//! Environments in a scene's extras: our own, and two conventions of converters met in well-known rooms.
//!
//! - `environment`, as `enfilade` writes it: `{"radiance": [3 numbers]}`, or `{"bufferView", "rows": "bands" or "pole_to_pole",
//!   "gltf_from_map": [9 numbers, row by row]}` with an equirectangular OpenEXR picture of radiance inside of the file.
//! - `mitsuba_emitters`: `{"type": "envmap", "filename", "to_world": [16 numbers, row by row], "scale"}`, with Mitsuba's layout.
//! - `pbrt_lights`: `{"type": "infinite", "mapname": [file], "transform": [16 numbers, row by row], "L", "scale"}`, with pbrt-v3's
//!   layout: z up, across by the azimuth from +x towards +y, down by the polar angle.

use super::container::Document;
use crate::ImportError;
use crate::assembly::{Assembly, Source};
use crate::pbrt::PBRT_FROM_MAP;
use enfilade_math::{DMat3, DVec3, Rgb};
use enfilade_scene::{Environment, MapRows};
use serde_json::Value;

/// Uses the first environment found in the extras of the file's scenes.
pub(super) fn add_from_extras(document: &Document, a: &mut Assembly) -> Result<(), ImportError> {
    let extras = document.root.scenes.iter().filter_map(|s| s.extras.as_ref());
    let extras: Vec<Value> = extras.filter_map(|e| serde_json::from_str(e.get()).ok()).collect();
    for extra in &extras {
        if let Some(environment) = extra.get("environment") {
            return own(document, environment, a);
        }
        let emitters = extra.get("mitsuba_emitters").and_then(Value::as_array).into_iter().flatten();
        for e in emitters.filter(|e| e.get("type").and_then(Value::as_str) == Some("envmap")) {
            let Some(file) = e.get("filename").and_then(Value::as_str) else { continue };
            return add(a, "scenes.extras.mitsuba_emitters", file, rotation(e.get("to_world")), scale(e, "scale"));
        }
        let lights = extra.get("pbrt_lights").and_then(Value::as_array).into_iter().flatten();
        for l in lights.filter(|l| l.get("type").and_then(Value::as_str) == Some("infinite")) {
            let name = l.get("mapname").and_then(|m| m.as_str().or_else(|| m.get(0)?.as_str()));
            let Some(file) = name else { continue };
            let file_from_map = rotation(l.get("transform")) * PBRT_FROM_MAP;
            return add(a, "scenes.extras.pbrt_lights", file, file_from_map, scale(l, "L") * scale(l, "scale"));
        }
    }
    Ok(())
}

/// The environment as this workspace writes it.
fn own(document: &Document, environment: &Value, a: &mut Assembly) -> Result<(), ImportError> {
    const PLACE: &str = "scenes.extras.environment";
    if environment.get("radiance").is_some() {
        a.set_environment(Environment::Constant { radiance: scale(environment, "radiance") }, PLACE);
        return Ok(());
    }
    let view = environment.get("bufferView").and_then(Value::as_u64).and_then(|view| usize::try_from(view).ok());
    let numbers: Vec<f64> =
        environment.get("gltf_from_map").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_f64).collect();
    let (Some(view), [xx, xy, xz, yx, yy, yz, zx, zy, zz]) = (view, numbers.as_slice()) else {
        let problem = "expected `radiance`, or `bufferView` and nine numbers as `gltf_from_map`; export the file again";
        return Err(a.malformed(PLACE, problem.to_string()));
    };
    let file_from_map = DMat3::from_cols(DVec3::new(*xx, *yx, *zx), DVec3::new(*xy, *yy, *zy), DVec3::new(*xz, *yz, *zz));
    let rows = match environment.get("rows").and_then(Value::as_str) {
        Some("pole_to_pole") => MapRows::PoleToPole,
        _ => MapRows::Bands,
    };
    let bytes = match document.view(view) {
        Ok((bytes, _)) => bytes,
        Err(problem) => return Err(a.malformed(PLACE, problem)),
    };
    if let Some(image) = a.light_image(&Source::Embedded(PLACE.to_string(), bytes), "the environment")? {
        a.set_environment_map(image, rows, Rgb::WHITE, file_from_map, PLACE);
    }
    Ok(())
}

fn add(a: &mut Assembly, place: &str, file: &str, file_from_map: DMat3, scale: Rgb) -> Result<(), ImportError> {
    a.warn(place, format!("glTF has no environment; {file} was guessed to be one from the scene's extras"));
    if let Some(image) = a.light_image(&Source::File(file), "the environment")? {
        a.set_environment_map(image, MapRows::Bands, scale, file_from_map, place);
    }
    Ok(())
}

/// The 3×3 part of 16 numbers, row by row; the identity when they are not there.
fn rotation(value: Option<&Value>) -> DMat3 {
    let numbers: Vec<f64> = value.and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_f64).collect();
    if numbers.len() != 16 {
        return DMat3::IDENTITY;
    }
    let column = |i: usize| DVec3::new(numbers[i], numbers[4 + i], numbers[8 + i]);
    DMat3::from_cols(column(0), column(1), column(2))
}

/// A number or three of them; white when absent.
fn scale(object: &Value, key: &str) -> Rgb {
    match object.get(key) {
        Some(Value::Array(list)) => {
            let channel = |i: usize| list.get(i).and_then(Value::as_f64).unwrap_or(1.0) as f32;
            Rgb::new(channel(0), channel(1), channel(2))
        }
        Some(value) => Rgb::splat(value.as_f64().unwrap_or(1.0) as f32),
        None => Rgb::WHITE,
    }
}
