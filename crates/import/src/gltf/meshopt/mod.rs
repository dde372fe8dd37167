//! `EXT_meshopt_compression` and `KHR_meshopt_compression`: buffer views whose data are packed.
//!
//! Our own code, by the specification of the latter, which covers both versions of the packing. The crates for it are bindings of the C++
//! library, or panic on damaged data.

mod attributes;
mod bytes;
mod filter;
mod indices;

use super::budget::Budget;
use super::buffers::Buffers;
use super::packed::{Mode, Packed, extension_of};
use crate::assembly::Assembly;
use gltf::json::{Index, Root, buffer};
use serde_json::Value;
use std::collections::HashMap;

/// Unpacks all packed buffer views into buffers of their own. Those that cannot be unpacked have their plain data, if the file has it; the
/// faults of the others go into `unreadable` by index.
pub(super) fn unpack(
    root: &mut Root,
    buffers: &mut Buffers,
    binary: Option<&[u8]>,
    unreadable: &mut HashMap<usize, String>,
    budget: &mut Budget,
    a: &mut Assembly,
) {
    for index in 0..root.buffer_views.len() {
        let Some((name, extension)) = extension_of(&root.buffer_views[index]) else { continue };
        let place = format!("bufferViews[{index}].extensions.{name}");
        match unpacked(&place, extension, buffers, budget) {
            Ok(bytes) => {
                let view = &mut root.buffer_views[index];
                let byte_length = bytes.len().into();
                let buffer = Index::new(buffers.push(bytes));
                *view = buffer::View { buffer, byte_length, byte_offset: None, extensions: None, ..view.clone() };
            }
            Err(problem) => {
                let plain = root.buffer_views[index].buffer.value();
                if buffers.read_plain(root, plain, binary, a) {
                    a.warn(place, format!("it {problem}; the plain data of the file were used"));
                } else {
                    unreadable.insert(index, format!("{place} {problem}"));
                }
            }
        }
    }
}

/// The data of an extension, or what is wrong with them.
fn unpacked(place: &str, extension: &Value, buffers: &Buffers, budget: &mut Budget) -> Result<Vec<u8>, String> {
    let packed = Packed::read(extension)?;
    let bytes = buffers.range(place, packed.buffer, packed.byte_offset, packed.byte_length)?;
    let Packed { count, byte_stride: stride, .. } = packed;
    budget.take((count as u64).saturating_mul(stride as u64), bytes.len())?;
    let of_indices = |indices: Vec<u32>| match stride {
        2 => indices.into_iter().flat_map(|i| (i as u16).to_le_bytes()).collect(),
        _ => indices.into_iter().flat_map(u32::to_le_bytes).collect(),
    };
    match packed.mode {
        Mode::Attributes => {
            let mut elements = attributes::unpack(bytes, count, stride)?;
            filter::apply(packed.filter, stride, &mut elements);
            Ok(elements)
        }
        Mode::Triangles => indices::triangles(bytes, count).map(of_indices),
        Mode::Indices => indices::sequence(bytes, count).map(of_indices),
    }
}
