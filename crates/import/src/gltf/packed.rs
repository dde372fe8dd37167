//! The description of packed data in the extension of a buffer view.

use gltf::json::buffer::View;
use serde::Deserialize;
use serde_json::Value;

/// Names of both extensions, which have the same properties; the filter of colours and version 1 of attributes are the second's alone, but
/// read in both.
const NAMES: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Packed data.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Packed {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: u64,
    pub byte_length: u64,
    pub byte_stride: usize,
    pub count: usize,
    pub mode: Mode,
    #[serde(default)]
    pub filter: Filter,
}

/// The packing mode of data.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(super) enum Mode {
    /// Elements of any size.
    Attributes,
    /// Indices of a list of triangles.
    Triangles,
    /// Indices that are no triangles.
    Indices,
}

/// The filter of attributes, applied after unpacking.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(super) enum Filter {
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

/// The extension of a buffer view, by its name.
pub(super) fn extension_of(view: &View) -> Option<(&'static str, &Value)> {
    let others = &view.extensions.as_ref()?.others;
    NAMES.into_iter().find_map(|name| Some((name, others.get(name)?)))
}

/// The buffer of a view's packed data.
pub(super) fn packed_buffer(view: &View) -> Option<usize> {
    let (_, extension) = extension_of(view)?;
    extension.get("buffer")?.as_u64().and_then(|buffer| usize::try_from(buffer).ok())
}

impl Packed {
    /// The properties of an extension.
    ///
    /// # Errors
    /// The fault, as the rest of a sentence.
    pub(super) fn read(extension: &Value) -> Result<Self, String> {
        let packed: Self = Self::deserialize(extension).map_err(|e| format!("is malformed ({e}); export the file again"))?;
        let stride = packed.byte_stride;
        let (fits, expected) = match (packed.mode, packed.filter) {
            (Mode::Attributes, Filter::None | Filter::Exponential) => {
                (stride.is_multiple_of(4) && (4..=256).contains(&stride), "a multiple of 4 up to 256")
            }
            (Mode::Attributes, Filter::Octahedral | Filter::Color) => (stride == 4 || stride == 8, "4 or 8"),
            (Mode::Attributes, Filter::Quaternion) => (stride == 8, "8"),
            (Mode::Triangles | Mode::Indices, _) => (stride == 2 || stride == 4, "2 or 4"),
        };
        if !fits {
            let (mode, filter) = (packed.mode, packed.filter);
            return Err(format!("has a byteStride of {stride}, expected {expected} for {mode:?} with filter {filter:?}; export it again"));
        }
        if packed.mode == Mode::Triangles && !packed.count.is_multiple_of(3) {
            return Err(format!("has {} indices of triangles, expected a multiple of 3; export the file again", packed.count));
        }
        Ok(packed)
    }
}
