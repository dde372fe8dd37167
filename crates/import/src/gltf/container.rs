//! The outer layer of a glTF file: text or binary, and the content of its buffers.

use super::budget::Budget;
use super::buffers::{Buffers, PADDING};
use super::uri::{Uri, resolve_uri};
use super::{draco, far, lumens, meshopt, omissions, unrendered};
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::DVec3;
use enfilade_scene::{decoded_text, without_padding};
use gltf::json::{Root, buffer, image};
use std::cell::Cell;
use std::collections::HashMap;

/// Extensions that an importer may be required to understand and that this one does.
const SUPPORTED: [&str; 22] = [
    "EXT_lights_ies",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "MSFT_texture_dds",
];

/// True for an extension that is read, or for which the report states what is rendered instead.
pub(super) fn is_supported(extension: &str) -> bool {
    SUPPORTED.contains(&extension) || unrendered::is_told(extension)
}

/// True for an extension that does not affect positions: of looks, metadata, sound, behaviour and animation. It is reported like others
/// that are used and not read.
fn is_harmless(extension: &str) -> bool {
    let name = extension.split_once('_').map_or(extension, |(_, name)| name);
    let begins = [
        "materials_",
        "xmp",
        "audio",
        "animation",
        "physics",
        "collider",
        "interactivity",
        "behavior",
        "behaviour",
        "structural_metadata",
        "mesh_features",
        "instance_features",
        "feature_metadata",
        "packed_metadata",
    ];
    extension == "VRM" || extension.starts_with("VRMC_") || begins.iter().any(|begin| name.to_lowercase().starts_with(begin))
}

/// An accessor without a buffer view is all zeros. All reads of a file together may ask for this many: more is taken for damage rather
/// than allocated.
pub(super) const MAX_ZEROS: u64 = 1 << 22;

/// A parsed glTF file with its buffers.
pub(super) struct Document {
    /// The JSON part. Nothing in it has been checked: indices are followed by `get` only.
    pub root: Root,
    /// Bytes of all buffers.
    buffers: Buffers,
    /// Faults of buffer views whose data cannot be unpacked.
    unreadable_views: HashMap<usize, String>,
    /// Faults of primitives, by mesh, whose data cannot be unpacked.
    unreadable_primitives: HashMap<(usize, usize), String>,
    /// Numbers that accessors without a buffer view may still ask for.
    pub zeros_left: Cell<u64>,
    /// Large translations of nodes, see `far.rs`.
    pub far_translations: HashMap<usize, DVec3>,
    /// Divisor of the strengths of its lights.
    pub lumens_per_watt: f32,
}

impl Document {
    /// Reads the scene file and its buffers.
    ///
    /// # Errors
    /// When the file is cut short, is not glTF 2.0, requires an unknown extension, or a buffer is missing or too short.
    pub(super) fn read(assembly: &mut Assembly) -> Result<Self, ImportError> {
        let bytes = assembly.read_scene_file()?;
        let (json, binary) = if bytes.starts_with(b"glTF") {
            split_binary(&bytes).map_err(|(place, problem)| assembly.malformed(place, problem))?
        } else {
            (bytes.as_slice(), None)
        };
        // Exporters pad the text with spaces, some with zeros.
        let text = decoded_text(json);
        let json = without_padding(&text).as_bytes();
        let mut root = omissions::parse(json).map_err(|(place, problem)| assembly.malformed(place, problem))?;
        check_version(&root, assembly)?;
        let mut buffers = Buffers::read(&root, binary, assembly)?;
        let (mut unreadable_views, mut unreadable_primitives) = (HashMap::new(), HashMap::new());
        let mut budget = Budget::default();
        meshopt::unpack(&mut root, &mut buffers, binary, &mut unreadable_views, &mut budget, assembly);
        draco::unpack(&mut root, &mut buffers, &mut unreadable_primitives, &mut budget, assembly);
        let lumens_per_watt = lumens::per_watt(&root, assembly);
        let far_translations = far::far_translations(&root.nodes, json);
        let zeros_left = Cell::new(MAX_ZEROS);
        Ok(Self { root, buffers, unreadable_views, unreadable_primitives, zeros_left, far_translations, lumens_per_watt })
    }

    /// The bytes of a buffer view, or what is wrong with it.
    pub(super) fn view(&self, index: usize) -> Result<(&[u8], &buffer::View), String> {
        let view = self
            .root
            .buffer_views
            .get(index)
            .ok_or_else(|| format!("refers to bufferView {index}, but there are only {}", self.root.buffer_views.len()))?;
        if let Some(problem) = self.unreadable_views.get(&index) {
            return Err(problem.clone());
        }
        let start = view.byte_offset.map_or(0, |o| o.0);
        let bytes = self.buffers.range(&format!("bufferViews[{index}]"), view.buffer.value(), start, view.byte_length.0)?;
        Ok((bytes, view))
    }

    /// The fault of the packed data of a primitive, if any, as the rest of a sentence.
    pub(super) fn is_unpacked(&self, mesh: usize, primitive: usize) -> Result<(), &str> {
        self.unreadable_primitives.get(&(mesh, primitive)).map_or(Ok(()), |problem| Err(problem))
    }

    /// The encoded bytes and place of a picture that is inside the glTF file; `Err(path)` when it is a file of its own.
    pub(super) fn embedded_image(&self, index: usize, image: &image::Image) -> Result<(String, Vec<u8>), ImageAt> {
        let place = format!("images[{index}]");
        if let Some(view) = image.buffer_view {
            return self
                .view(view.value())
                .map(|(bytes, _)| (place.clone(), bytes.to_vec()))
                .map_err(|e| ImageAt::Nowhere(format!("{place} {e}")));
        }
        match image.uri.as_deref() {
            None => Err(ImageAt::Nowhere(format!("{place} has neither a uri nor a bufferView"))),
            Some(uri) => match resolve_uri(uri) {
                Ok(Uri::Data(bytes)) => Ok((place, bytes)),
                Ok(Uri::Path(path)) => Err(ImageAt::File(path)),
                Err(problem) => Err(ImageAt::Nowhere(format!("{place} {problem}"))),
            },
        }
    }
}

/// Location of a picture that is not inside the glTF file.
pub(super) enum ImageAt {
    /// In a file.
    File(String),
    /// Nowhere that can be read; why.
    Nowhere(String),
}

fn check_version(root: &Root, assembly: &Assembly) -> Result<(), ImportError> {
    if !root.asset.version.starts_with("2.") {
        let problem = format!("found glTF version {:?}, expected 2.0; convert the file to glTF 2.0", root.asset.version);
        return Err(assembly.malformed("asset.version", problem));
    }
    match root.extensions_required.iter().find(|e| !is_supported(e) && !is_harmless(e)) {
        None => Ok(()),
        Some(extension) => {
            let advice = match extension.as_str() {
                "EXT_texture_avif" => "export with PNG, JPEG, WebP or KTX2 textures",
                _ => "export without it",
            };
            Err(assembly.malformed("extensionsRequired", format!("the file requires {extension}, which is not supported; {advice}")))
        }
    }
}

/// The JSON and binary chunks of a `.glb`. Unknown chunks are skipped, as the format asks.
#[expect(clippy::type_complexity, reason = "two chunks, or the place and the problem")]
fn split_binary(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), (String, String)> {
    let word = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let cut =
        |at: usize, what: &str| (format!("byte {at}"), format!("the file ends inside {what}: it is cut short, so copy or export it again"));
    let (version, length) = (word(4).ok_or_else(|| cut(4, "the header"))?, word(8).ok_or_else(|| cut(8, "the header"))?);
    if version != 2 {
        return Err(("byte 4".into(), format!("found binary glTF version {version}, expected 2; convert the file to glTF 2.0")));
    }
    // The padding of the last chunk may be missing.
    if (bytes.len() as u64) + PADDING < u64::from(length) {
        let problem =
            format!("the header says {length} bytes, but the file has {}: it is cut short, so copy or export it again", bytes.len());
        return Err(("byte 8".into(), problem));
    }
    let (mut json, mut binary, mut at) = (None, None, 12);
    while at < bytes.len() && (json.is_none() || binary.is_none()) {
        let size = word(at).ok_or_else(|| cut(at, "a chunk's header"))? as usize;
        let kind = bytes.get(at + 4..at + 8).ok_or_else(|| cut(at + 4, "a chunk's header"))?;
        let rest = bytes.get(at + 8..).unwrap_or_default();
        let lacks_padding = kind == b"BIN\0" && rest.len() < size && rest.len() as u64 + PADDING >= size as u64;
        let body = if lacks_padding { Some(rest) } else { rest.get(..size) }.ok_or_else(|| cut(at + 8, "a chunk"))?;
        match kind {
            b"JSON" => json = json.or(Some(body)),
            b"BIN\0" => binary = binary.or(Some(body)),
            _ => (),
        }
        at = next_chunk(bytes, at + 8 + size);
    }
    json.map(|json| (json, binary)).ok_or_else(|| ("byte 12".into(), "there is no JSON chunk; export the file again".into()))
}

/// Position of the chunk after one that ends at `end`: the next multiple of four bytes, as the format asks, or, as some programs write it,
/// directly after.
fn next_chunk(bytes: &[u8], end: usize) -> usize {
    let is_binary = |at: usize| bytes.get(at + 4..at + 8) == Some(b"BIN\0");
    let padded = end.next_multiple_of(4);
    if is_binary(end) && !is_binary(padded) { end } else { padded }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_follow_one_another_with_padding_or_without() {
        let json = b"{\"asset\": 12}";
        let chunk = |kind: &[u8], body: &[u8]| [&(body.len() as u32).to_le_bytes()[..], kind, body].concat();
        for (json, padding) in [(&json[..], 0), (&json[..], 4 - json.len() % 4), (b"{\"asset\": 12}   ", 0)] {
            let body = [chunk(b"JSON", json), vec![b' '; padding], chunk(b"BIN\0", &[1, 2, 3])].concat();
            let glb = [b"glTF\x02\0\0\0", &(12 + body.len() as u32).to_le_bytes()[..], &body].concat();
            assert_eq!(split_binary(&glb), Ok((json, Some(&[1, 2, 3][..]))), "{padding}");
        }
    }

    #[test]
    fn truncated_binaries_say_where_they_end() {
        let mut glb = b"glTF\x02\0\0\0\x20\0\0\0\x0c\0\0\0JSON{\"asset\": 1}".to_vec();
        glb.truncate(28);
        assert!(split_binary(&glb).unwrap_err().1.contains("the header says 32 bytes, but the file has 28"));
        assert!(split_binary(b"glTF\x02\0").is_err());
        assert!(split_binary(b"glTF\x01\0\0\0\x0c\0\0\0").unwrap_err().1.contains("version 1"));
        assert!(split_binary(b"glTF\x02\0\0\0\x00\0\0\0").unwrap_err().1.contains("no JSON chunk"));
        assert!(split_binary(b"glTF\x02\0\0\0\x00\0\0\0\xff\xff\xff\xffJSON").unwrap_err().1.contains("cut short"));
    }
}
