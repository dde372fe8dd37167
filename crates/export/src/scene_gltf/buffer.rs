//! The file's one buffer, and the views and accessors into it.

use serde_json::{Value, json};

/// Component types of the specification.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;

/// The target of a buffer view of vertices or corners.
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// Bytes, with lists of their views and accessors.
#[derive(Default)]
pub(super) struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// Adds bytes as they are; the index of their view.
    pub(super) fn view(&mut self, data: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": data.len() }));
        self.bytes.extend_from_slice(data);
        self.views.len() - 1
    }

    fn view_for(&mut self, target: u32, data: &[u8]) -> usize {
        let view = self.view(data);
        self.views[view]["target"] = json!(target);
        view
    }

    /// Adds what vertices have, `N` floats each; the index of its accessor. `bounds` as positions need them.
    pub(super) fn vectors<const N: usize>(&mut self, values: &[[f32; N]], bounds: bool) -> usize {
        let accessor = self.numbers(values, bounds);
        if let Some(view) = self.views.last_mut() {
            view["target"] = json!(ARRAY_BUFFER);
        }
        accessor
    }

    /// Adds lists of `N` floats that are no vertices; the index of their accessor.
    pub(super) fn numbers<const N: usize>(&mut self, values: &[[f32; N]], bounds: bool) -> usize {
        let data: Vec<u8> = values.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
        let view = self.view(&data);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        let mut accessor = json!({ "bufferView": view, "componentType": FLOAT, "count": values.len(), "type": kind });
        if bounds {
            let extreme = |pick: fn(f32, f32) -> f32, start: f32| -> Vec<f32> {
                (0..N).map(|axis| values.iter().fold(start, |found, v| pick(found, v[axis]))).collect()
            };
            accessor["min"] = json!(extreme(f32::min, f32::INFINITY));
            accessor["max"] = json!(extreme(f32::max, f32::NEG_INFINITY));
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds the corners of triangles; the index of their accessor.
    pub(super) fn indices(&mut self, triangles: &[[u32; 3]]) -> usize {
        let data: Vec<u8> = triangles.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
        let view = self.view_for(ELEMENT_ARRAY_BUFFER, &data);
        self.accessors.push(json!({ "bufferView": view, "componentType": UNSIGNED_INT, "count": 3 * triangles.len(), "type": "SCALAR" }));
        self.accessors.len() - 1
    }

    /// Views, accessors and bytes.
    pub(super) fn finish(self) -> (Vec<Value>, Vec<Value>, Vec<u8>) {
        (self.views, self.accessors, self.bytes)
    }
}
