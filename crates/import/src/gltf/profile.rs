//! `EXT_lights_ies`: photometric profiles at nodes.

use super::container::Document;
use super::uri::{Uri, resolve_uri};
use crate::ImportError;
use crate::assembly::Assembly;
use crate::ies;
use enfilade_math::{DAffine3, DMat3, Mat3, Rgb};
use enfilade_scene::Light;
use serde_json::Value;
use std::path::PathBuf;

/// Adds the light that the extension of a node describes. Profiles shine along the node's −z, with horizontal angles counted from
/// +x towards +y; a node's scale does not change their strength.
///
/// # Errors
/// When the profile is not there or makes no sense.
pub(super) fn add(
    document: &Document,
    instance: &Value,
    node_name: Option<&str>,
    node: usize,
    file_from_node: DAffine3,
    a: &mut Assembly,
) -> Result<(), ImportError> {
    let place = format!("nodes[{node}].extensions.EXT_lights_ies");
    let root = document.root.extensions.as_ref().and_then(|e| e.others.get("EXT_lights_ies"));
    let profiles = root.and_then(|e| e.get("lights")).and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    let index = instance.get("light").and_then(Value::as_u64);
    let Some((index, profile)) = index.and_then(|i| Some((i, profiles.get(usize::try_from(i).ok()?)?))) else {
        let found = instance.get("light").map_or("no light".to_string(), |l| format!("light {l}"));
        return Err(
            a.malformed(place, format!("found {found}, expected one of the {} profiles of the file; export it again", profiles.len()))
        );
    };
    let profile_place = format!("extensions.EXT_lights_ies.lights[{index}]");
    let (file, bytes) = bytes(document, profile, &profile_place, a)?;
    let within = if file == a.file() { profile_place.as_str() } else { "" };
    let parsed = ies::parse(&bytes, &file, within)?;
    for warning in parsed.warnings {
        a.warn(&profile_place, warning);
    }
    let number = |value: &Value| value.as_f64().map(|v| v as f32);
    let multiplier = instance.get("multiplier").and_then(number).unwrap_or(1.0).max(0.0);
    let color = instance.get("color").and_then(Value::as_array).map(|c| c.iter().filter_map(number).collect::<Vec<f32>>());
    let color = match color.as_deref() {
        Some([r, g, b]) => Rgb::new(*r, *g, *b).map(|c| c.clamp(0.0, 1.0)),
        _ => Rgb::WHITE,
    };
    let own = profile.get("name").and_then(Value::as_str).filter(|n| !n.trim().is_empty());
    let name = node_name.or(own).map_or_else(|| format!("profile_{index}"), str::to_string);
    let Some(web_from_file) = rotation_to(file_from_node.matrix3) else {
        a.warn(place, format!("light {name:?} has a placement that makes no sense, so it was left out"));
        return Ok(());
    };
    let (position, intensity) = (file_from_node.translation.as_vec3(), color * multiplier);
    let light = Light::Profile { name, position, web_from_world: web_from_file, intensity, web: Box::new(parsed.web) };
    a.push_light_at(file_from_node.translation, light);
    Ok(())
}

/// The file of a profile, and its bytes.
fn bytes(document: &Document, profile: &Value, place: &str, a: &mut Assembly) -> Result<(PathBuf, Vec<u8>), ImportError> {
    let problem = |problem: String, a: &Assembly| Err(a.malformed(place, problem));
    if let Some(view) = profile.get("bufferView").and_then(Value::as_u64) {
        return match document.view(usize::try_from(view).unwrap_or(usize::MAX)) {
            Ok((bytes, _)) => Ok((a.file().to_path_buf(), bytes.to_vec())),
            Err(message) => problem(message, a),
        };
    }
    match profile.get("uri").and_then(Value::as_str).map(resolve_uri) {
        None => problem("has neither a uri nor a bufferView; export the file again".into(), a),
        Some(Ok(Uri::Data(bytes))) => Ok((a.file().to_path_buf(), bytes)),
        Some(Ok(Uri::Path(path))) => a.read(&path),
        Some(Err(message)) => problem(message, a),
    }
}

/// The rotation into the space of a matrix's columns, their scale taken out. `None` when they are flat.
fn rotation_to(file_from_node: DMat3) -> Option<Mat3> {
    let z = file_from_node.z_axis.try_normalize()?;
    let x = (file_from_node.x_axis - z * z.dot(file_from_node.x_axis)).try_normalize()?;
    let y = (file_from_node.y_axis - z * z.dot(file_from_node.y_axis) - x * x.dot(file_from_node.y_axis)).try_normalize()?;
    Some(DMat3::from_cols(x, y, z).transpose().as_mat3())
}
