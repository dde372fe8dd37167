//! glTF 2.0, as `.gltf` or `.glb`.
//!
//! | feature | what becomes of it |
//! |---|---|
//! | scenes | the default one, else the first, else all root nodes |
//! | nodes | one part per node and primitive, named after the node, else its mesh, else `node_<index>`; `.<primitive>` is appended where a mesh has several; nested, mirrored and sheared transforms; meshes are shared between nodes |
//! | primitives | triangles, strips, fans, with or without indices; points and lines are dropped |
//! | accessors | all component types, normalized integers, sparse ones, strides; `KHR_mesh_quantization` |
//! | buffers | files, data URIs, the binary chunk |
//! | compression | `KHR_draco_mesh_compression` (meshes and clouds of points); `EXT_meshopt_compression` and `KHR_meshopt_compression` (all modes and filters, both versions of attributes). Packed data that are damaged are replaced by the file's plain ones, with a warning; without these they are an error where they are used |
//! | pictures | PNG, JPEG and all that [`crate`] decodes, from files, data URIs and buffer views; sampler wrapping and magnification filter. `KHR_texture_basisu`, `EXT_texture_webp`, `MSFT_texture_dds`; the plain picture beside these is used where they cannot be read, as that of `EXT_texture_avif` always |
//! | materials | metallic-roughness to `Bsdf::Principled`; base colour, metallic-roughness, normal and emissive textures; alpha modes; surfaces scatter on both sides, and emit on both when they are double-sided; `KHR_materials_pbrSpecularGlossiness` (see `gloss.rs`). The occlusion texture is dropped, because light transport computes occlusion |
//! | extensions | `KHR_materials_emissive_strength`, `_ior`, `_transmission`, `_volume`, `_specular`, `_clearcoat` (but its normal map), `_sheen`, `_unlit` (as a diffuse surface of that colour); `KHR_texture_transform`; `KHR_lights_punctual` (candela as W/sr, lux as W/m²; divided by 683 where Blender has multiplied them, see `lumens.rs`); `EXT_lights_ies` (the same; type C); `EXT_mesh_gpu_instancing` (a part per instance); `KHR_node_visibility` (what is invisible is left out); `KHR_materials_variants` (the default materials) |
//! | texture coordinates | one set per primitive: that of the base colour, or of the first texture there is |
//! | cameras | perspective; orthographic ones are dropped |
//! | `COLOR_0` | multiplies base colour and opacity; where it varies, as a picture if the material has no textures (see `painted.rs`), else by its mean over the primitive, as opacity always, and the report says so |
//! | skins | in the pose of the nodes, over time where these are animated; the transform of the node that bears the mesh does not count |
//! | morph targets | by the weights of the node, else of the mesh, over time where these are animated |
//! | reported once, not rendered | `KHR_materials_anisotropy`, `_diffuse_transmission`, `_dispersion`, `_iridescence`, `_volume_scatter` (see `unrendered.rs`) |
//! | animations | translations and rotations of nodes move what is below them; scales, morph targets and skins change the shapes of parts. What cannot be followed stays at rest, with a warning |
//! | dropped with a warning | further vertex colours, light ranges, other extensions |
//!
//! A file that requires an extension outside this list is an error, unless it is one of looks, metadata, sound, behaviour or animation: that
//! is reported and left out. Text may have a byte order mark, whole numbers a point (`3.0`), bounds `NaN`, values `null`, and paddings that are counted
//! may be missing. A texture that names no picture leaves the plain colour or number, with a warning.
//!
//! # Labels
//!
//! `extras` of a node may carry `"semantic"`, a NYU40 class as its id (1 to 40) or name, or `"semantic_id"`, its id, and `"instance"`, a
//! number from 1, or −1 for none. They apply to the node's own parts and to all nodes below it without labels of their own. Without a
//! number each node with a class is an instance, together with the nodes below it that have none of their own; under
//! `EXT_mesh_gpu_instancing` each place is. Wall, floor and ceiling are not counted. `extras` of a mesh label the parts of nodes that state
//! no class themselves; each node that shows it is an instance.
//!
//! # Environments
//!
//! glTF has no environment. `environment` in the `extras` of the scene is one (`environment.rs` has its form). If `extras` of the scene
//! contain `mitsuba_emitters` or `pbrt_lights`, as converters of well-known scenes leave them, their environment map is used, and reported
//! as guessed.

mod accessor;
mod animation;
mod budget;
mod buffers;
mod color;
mod container;
mod deform;
mod draco;
mod environment;
mod far;
mod file_material;
mod gloss;
mod gloss_pictures;
mod instancing;
mod label;
mod light;
mod lumens;
mod material;
mod materials;
mod meshopt;
mod morph;
mod node;
mod objects;
mod omissions;
mod packed;
mod painted;
mod parts;
mod primitive;
mod profile;
mod skin;
mod texture;
mod transform;
mod unrendered;
mod uri;

use crate::assembly::Assembly;
use crate::{ImportError, Imported};
use container::Document;

/// Imports a glTF file.
pub(crate) fn load(mut assembly: Assembly) -> Result<Imported, ImportError> {
    let document = Document::read(&mut assembly)?;
    report_dropped(&document, &mut assembly);
    let roots = node::roots(&document, &mut assembly)?;
    node::place(&document, &roots, &mut assembly)?;
    environment::add_from_extras(&document, &mut assembly)?;
    assembly.finish()
}

/// Warns of whole features that the file uses and that have no counterpart here.
fn report_dropped(document: &Document, assembly: &mut Assembly) {
    let root = &document.root;
    if root.extensions_used.iter().any(|e| e == "KHR_materials_variants") {
        assembly.warn("extensions.KHR_materials_variants", "variants of materials dropped; every part has its default material");
    }
    unrendered::report(root, assembly);
    for extension in &root.extensions_used {
        if !container::is_supported(extension) && extension != "EXT_texture_avif" {
            assembly.warn("extensionsUsed", format!("{extension} is not supported and was ignored"));
        }
    }
}
