//! The buffers of a glTF file: what it has, and what unpacking adds.

use super::packed::{extension_of, packed_buffer};
use super::uri::{Uri, resolve_uri};
use crate::ImportError;
use crate::assembly::Assembly;
use gltf::json::{Root, buffer};

/// Bytes that fill chunks and buffers up to a multiple of four; some programs count them and do not write them.
pub(super) const PADDING: u64 = 3;

/// Bytes of all buffers.
pub(super) struct Buffers(Vec<Vec<u8>>);

impl Buffers {
    /// Reads the buffers of a file, except for those that are only the fallback of packed data, as these may be placeholders. `binary` is
    /// the binary chunk of a `.glb`.
    ///
    /// # Errors
    /// When a buffer is missing or too short.
    pub(super) fn read(root: &Root, binary: Option<&[u8]>, assembly: &mut Assembly) -> Result<Self, ImportError> {
        let mut buffers = Vec::with_capacity(root.buffers.len());
        for (i, b) in root.buffers.iter().enumerate() {
            let lacking = b.uri.is_none() && (i > 0 || binary.is_none());
            let mut views = root.buffer_views.iter().filter(|view| view.buffer.value() == i).peekable();
            let stands_in = views.peek().is_some() && views.all(|view| extension_of(view).is_some());
            let is_unused = lacking && root.buffer_views.iter().all(|view| view.buffer.value() != i);
            let is_packed = root.buffer_views.iter().any(|view| packed_buffer(view) == Some(i));
            let skipped = (stands_in || is_unused) && !is_packed;
            buffers.push(if skipped { Vec::new() } else { read_buffer(i, b, binary, assembly)? });
        }
        Ok(Self(buffers))
    }

    /// Reads a buffer that is the fallback of packed data; false when the file does not have it.
    pub(super) fn read_plain(&mut self, root: &Root, index: usize, binary: Option<&[u8]>, assembly: &mut Assembly) -> bool {
        let read = root.buffers.get(index).and_then(|b| read_buffer(index, b, binary, assembly).ok());
        match (read, self.0.get_mut(index)) {
            (Some(bytes), Some(place)) => {
                *place = bytes;
                true
            }
            _ => false,
        }
    }

    /// Appends a buffer; its index.
    pub(super) fn push(&mut self, bytes: Vec<u8>) -> u32 {
        self.0.push(bytes);
        self.0.len() as u32 - 1
    }

    /// A range of a buffer, or what is wrong with it; `name` is what asks for it.
    pub(super) fn range(&self, name: &str, buffer: usize, start: u64, length: u64) -> Result<&[u8], String> {
        let bytes = self.0.get(buffer).ok_or_else(|| format!("{name} refers to buffer {buffer}, but there are only {}", self.0.len()))?;
        let end = start.checked_add(length);
        let there = bytes.len() as u64;
        // Padding that is counted and not there.
        let end = end.map(|end| if end > there && end - there <= PADDING { there } else { end });
        let range = end.and_then(|end| bytes.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?));
        range.ok_or_else(|| {
            format!(
                "{name} spans bytes {start} to {start}+{length}, but its buffer has {}; the file is damaged, so export it again",
                bytes.len()
            )
        })
    }
}

fn read_buffer(index: usize, buffer: &buffer::Buffer, binary: Option<&[u8]>, assembly: &mut Assembly) -> Result<Vec<u8>, ImportError> {
    let place = format!("buffers[{index}]");
    let bytes = match &buffer.uri {
        None if index == 0 => {
            binary.map(<[u8]>::to_vec).ok_or_else(|| assembly.malformed(&place, "it has no uri, and the file has no binary chunk"))?
        }
        None => return Err(assembly.malformed(place, "it has no uri; only the first buffer may be the binary chunk")),
        Some(uri) => match resolve_uri(uri).map_err(|problem| assembly.malformed(&place, format!("it {problem}")))? {
            Uri::Data(bytes) => bytes,
            Uri::Path(path) => assembly.read(&path)?.1,
        },
    };
    if (bytes.len() as u64) + PADDING < buffer.byte_length.0 {
        let problem = format!(
            "it should have {} bytes, but only {} are there: it is cut short, so copy or export it again",
            buffer.byte_length.0,
            bytes.len()
        );
        return Err(assembly.malformed(place, problem));
    }
    Ok(bytes)
}
