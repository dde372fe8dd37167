//! `EXT_mesh_gpu_instancing`: a node's mesh in many places.

use super::container::Document;
use super::transform::placement;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::DAffine3;
use gltf::json::Index;
use serde_json::Value;

/// The extension's name.
pub(super) const NAME: &str = "EXT_mesh_gpu_instancing";

/// Placements of a node's mesh by the extension, each relative to the node. Attributes of other names are left out.
///
/// # Errors
/// When an attribute cannot be read, or they are of different lengths.
pub(super) fn places(
    document: &Document,
    extension: &Value,
    node: usize,
    file_from_node: DAffine3,
    a: &mut Assembly,
) -> Result<Vec<DAffine3>, ImportError> {
    let place = |name: &str| format!("nodes[{node}].extensions.{NAME}.attributes{name}");
    let translations = vectors::<3>(document, extension, "TRANSLATION").map_err(|e| a.malformed(place(".TRANSLATION"), e))?;
    let rotations = vectors::<4>(document, extension, "ROTATION").map_err(|e| a.malformed(place(".ROTATION"), e))?;
    let scales = vectors::<3>(document, extension, "SCALE").map_err(|e| a.malformed(place(".SCALE"), e))?;
    let lengths = [translations.as_ref().map(Vec::len), rotations.as_ref().map(Vec::len), scales.as_ref().map(Vec::len)];
    let Some(count) = lengths.into_iter().flatten().next() else {
        a.warn(place(""), "found no TRANSLATION, ROTATION or SCALE; the mesh was placed once");
        return Ok(vec![file_from_node]);
    };
    if lengths.into_iter().flatten().any(|length| length != count) {
        let found = lengths.map(|length| length.map_or("none".into(), |length| length.to_string())).join(", ");
        let problem = format!("found {found} of TRANSLATION, ROTATION, SCALE, expected as many of each; export the file again");
        return Err(a.malformed(place(""), problem));
    }
    let of = |i: usize| {
        placement(
            translations.as_ref().map_or([0.0; 3], |t| t[i]),
            rotations.as_ref().map_or([0.0; 4], |r| r[i]),
            scales.as_ref().map_or([1.0; 3], |s| s[i]),
        )
    };
    Ok((0..count).map(|i| file_from_node * of(i)).collect())
}

/// An attribute of all instances; `None` where it is not stated.
fn vectors<const N: usize>(document: &Document, extension: &Value, name: &str) -> Result<Option<Vec<[f32; N]>>, String> {
    let Some(accessor) = extension.get("attributes").and_then(|a| a.get(name)) else { return Ok(None) };
    let index = accessor.as_u64().and_then(|i| u32::try_from(i).ok()).ok_or_else(|| format!("found {accessor}, expected an accessor"))?;
    document.vectors(Index::new(index)).map(Some)
}
