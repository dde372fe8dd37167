//! Compressed meshes of glTF: the packed bytes alone, within a document that is right.

use crate::{Run, Seed};
use enfilade_import::{ImportOptions, load};
use enfilade_scene::Quiet;
use serde_json::{Value, json};
use std::path::Path;

/// Imports a document around these bytes, which it has in a file.
fn import(folder: &Path, bytes: &[u8], mut document: Value) {
    document["asset"] = json!({"version": "2.0"});
    document["nodes"] = json!([{"mesh": 0}]);
    document["scenes"] = json!([{"nodes": [0]}]);
    let packed = json!({"uri": "packed.bin", "byteLength": bytes.len()});
    document["buffers"] = json!([packed, {"byteLength": 0}]);
    let scene = folder.join("scene.gltf");
    std::fs::write(folder.join("packed.bin"), bytes).expect("a folder that can be written");
    std::fs::write(&scene, document.to_string()).expect("a folder that can be written");
    if let Ok(imported) = load(&scene, &ImportOptions::default(), &Quiet) {
        imported.scene.validate().expect("an imported scene is valid");
    }
}

/// Draco streams with all attributes that a mesh may have.
pub fn draco(folder: &Path) -> Run {
    let folder = folder.to_path_buf();
    Box::new(move |bytes| {
        let attributes = json!({"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "COLOR_0": 3});
        let accessor = |component: u32, kind: &str| json!({"componentType": component, "type": kind, "count": 3});
        let extensions = json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": attributes}});
        let document = json!({
            "meshes": [{"primitives": [{"attributes": attributes, "indices": 4, "extensions": extensions}]}],
            "accessors": [accessor(5126, "VEC3"), accessor(5126, "VEC3"), accessor(5126, "VEC2"), accessor(5121, "VEC4"), accessor(5123, "SCALAR")],
            "bufferViews": [{"buffer": 0, "byteLength": bytes.len()}]
        });
        import(&folder, bytes, document);
    })
}

const MODES: [&str; 3] = ["ATTRIBUTES", "TRIANGLES", "INDICES"];
const FILTERS: [&str; 5] = ["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"];

/// Packed buffer views: a byte each for mode, filter and stride, two for the number of elements, and the packed bytes. They are the
/// positions of a mesh or its indices.
pub fn meshopt(folder: &Path) -> Run {
    let folder = folder.to_path_buf();
    Box::new(move |bytes| {
        let Some(([mode, filter, stride, low, high], packed)) = bytes.split_first_chunk::<5>() else { return };
        let (mode, filter) = (MODES[usize::from(*mode) % 3], FILTERS[usize::from(*filter) % 5]);
        let count = u16::from_le_bytes([*low, *high]);
        let (stride, is_index) = (u32::from(*stride), mode != "ATTRIBUTES");
        let extension =
            json!({"buffer": 0, "byteLength": packed.len(), "byteStride": stride, "count": count, "mode": mode, "filter": filter});
        let view = json!({"buffer": 1, "byteLength": u32::from(count) * stride, "extensions": {"KHR_meshopt_compression": extension}});
        let (component, kind, elements) = match (is_index, stride) {
            (true, 2) => (5123, "SCALAR", u32::from(count)),
            (true, _) => (5125, "SCALAR", u32::from(count)),
            (false, _) => (5126, "VEC3", u32::from(count) * stride / 12),
        };
        let of_view = json!({"bufferView": 0, "componentType": component, "type": kind, "count": elements});
        let zeros = json!({"componentType": 5126, "type": "VEC3", "count": 64});
        let primitive =
            if is_index { json!({"attributes": {"POSITION": 1}, "indices": 0}) } else { json!({"attributes": {"POSITION": 0}}) };
        import(&folder, packed, json!({"meshes": [{"primitives": [primitive]}], "accessors": [of_view, zeros], "bufferViews": [view]}));
    })
}

/// The JSON and the binary chunk of a `.glb`.
fn split(glb: &[u8]) -> (Value, &[u8]) {
    let length = u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    (serde_json::from_slice(&glb[20..20 + length]).expect("JSON"), &glb[28 + length..])
}

/// Files by Google's encoder.
const DRACO: [(&str, &[u8]); 3] = [
    ("edgebreaker", include_bytes!("../../../import/tests/gltf/draco_edgebreaker.glb")),
    ("valence", include_bytes!("../../../import/tests/gltf/draco_valence.glb")),
    ("sequential", include_bytes!("../../../import/tests/gltf/draco_sequential.glb")),
];

/// Files by meshoptimizer's encoder.
const MESHOPT: [&[u8]; 2] =
    [include_bytes!("../../../import/tests/gltf/meshopt_ext.glb"), include_bytes!("../../../import/tests/gltf/meshopt_khr.glb")];

/// The streams of the importer's tests.
pub fn dracos() -> Vec<Seed> {
    DRACO.iter().map(|(name, glb)| Seed { name: (*name).into(), bytes: split(glb).1.to_vec() }).collect()
}

/// The buffer views of the importer's tests.
pub fn meshopts() -> Vec<Seed> {
    let mut seeds = Vec::new();
    for (version, glb) in MESHOPT.into_iter().enumerate() {
        let (json, binary) = split(glb);
        for (i, view) in json["bufferViews"].as_array().expect("views").iter().enumerate() {
            let extension = view["extensions"].as_object().and_then(|e| e.values().next()).expect("an extension");
            let number = |key: &str| extension[key].as_u64().expect("a number") as usize;
            let place = |names: &[&str], key: &str| names.iter().position(|n| extension[key] == *n).unwrap_or(0) as u8;
            let [low, high] = (number("count") as u16).to_le_bytes();
            let head = [place(&MODES, "mode"), place(&FILTERS, "filter"), number("byteStride") as u8, low, high];
            let packed = &binary[number("byteOffset")..][..number("byteLength")];
            seeds.push(Seed { name: format!("view_{version}_{i}"), bytes: [&head, packed].concat() });
        }
    }
    seeds
}
