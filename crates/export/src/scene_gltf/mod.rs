//! A scene with its labels as one binary glTF 2.0 file (`.glb`), for other renderers and modelling programs.
//!
//! - **Tree**: a root that turns our z up into glTF's y up, and below it one node per part, so that parts keep their names. Parts that
//!   share mesh and material share a glTF mesh.
//! - **Labels**: `extras` of a part's node has `"semantic"`, the name of its NYU40 class, `"semantic_id"` (1 to 40), and, for what people
//!   count, `"instance"` (from 1). `enfilade import` reads them back.
//! - **Objects**: `extras.objects` of the scene lists what parts are parts of, each with its `name` and the index of its `parent`; `"object"`
//!   in the `extras` of a part's node is an index into that list. `enfilade import` reads these back too.
//! - **Motion**: each body of a scene that moves is a node with its parts and lights below it, and an animation moves it.
//! - **Materials** as metallic-roughness with the ratified extensions (clear coat, emissive strength, IOR, sheen, specular, transmission,
//!   volume). glTF has no complex indices of refraction, no blends of two surfaces and no heights; their replacements are described in
//!   `material.rs`, and every replacement that changes the look is among the notes.
//! - **Lights** as `KHR_lights_punctual`. The surroundings, which glTF does not have, are an OpenEXR picture inside of the file, at
//!   `extras.environment` of the scene. Lengths are metres, radiances those of the scene.

mod buffer;
mod document;
mod material;
mod motion;
mod node;
mod picture;

use document::Document;
use enfilade_scene::{Labels, PictureFiles, Scene};
use serde_json::{Value, json};

/// A scene as glTF.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneGltf {
    /// The bytes of the file.
    pub glb: Vec<u8>,
    /// What glTF cannot represent, and its replacement.
    pub notes: Vec<String>,
}

/// The scene as glTF; `labels` are joined to the parts in their order, and may be empty. Pictures that are in `files` and are used as they
/// are go into it unchanged, others as PNG.
///
/// The scene must be valid ([`Scene::validate`]).
///
/// ```
/// use enfilade_export::scene_gltf;
/// use enfilade_scene::{Labels, PictureFiles, Scene};
/// let gltf = scene_gltf(&Scene::default(), &Labels::default(), &PictureFiles::new());
/// assert!(gltf.glb.starts_with(b"glTF") && gltf.notes.is_empty());
/// ```
pub fn scene_gltf(scene: &Scene, labels: &Labels, files: &PictureFiles) -> SceneGltf {
    let mut document = Document::new(files);
    material::add_all(&mut document, scene);
    node::add_all(&mut document, scene, labels);
    let environment = picture::environment(&mut document, scene);
    let Document { buffer, meshes, materials, textures, samplers, images, nodes, cameras, lights, animations, extensions, notes, .. } =
        document;
    let (views, accessors, binary) = buffer.finish();
    let mut root = json!({
        "asset": { "version": "2.0", "generator": concat!("enfilade ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "buffers": [{ "byteLength": binary.len() }],
    });
    if let Some(environment) = environment {
        root["scenes"][0]["extras"]["environment"] = environment;
    }
    if !scene.objects.is_empty() {
        root["scenes"][0]["extras"]["objects"] = scene.objects.iter().map(node::object).collect();
    }
    let lists = [
        ("nodes", nodes),
        ("meshes", meshes),
        ("materials", materials),
        ("textures", textures),
        ("samplers", samplers),
        ("images", images),
        ("cameras", cameras),
        ("animations", animations),
        ("bufferViews", views),
        ("accessors", accessors),
    ];
    for (name, list) in lists.into_iter().filter(|(_, list)| !list.is_empty()) {
        root[name] = list.into();
    }
    if !lights.is_empty() {
        root["extensions"] = json!({ "KHR_lights_punctual": { "lights": lights } });
    }
    if !extensions.is_empty() {
        root["extensionsUsed"] = json!(extensions);
    }
    SceneGltf { glb: container(&root, binary), notes }
}

/// The binary container: a header, the JSON padded by blanks, the buffer padded by zeros.
fn container(root: &Value, mut binary: Vec<u8>) -> Vec<u8> {
    let mut text = root.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let word = |n: usize| (n as u32).to_le_bytes();
    let chunk = |kind: &[u8; 4], data: &[u8]| [&word(data.len()), kind.as_slice(), data].concat();
    let chunks = [chunk(b"JSON", &text), chunk(b"BIN\0", &binary)].concat();
    [b"glTF".as_slice(), &word(2), &word(12 + chunks.len()), &chunks].concat()
}
