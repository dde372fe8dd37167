//! Small scene files made on the spot.

// Each test file uses a part of this.
#![allow(dead_code, reason = "shared by several test files")]

pub mod fbx;
pub mod vray;

use enfilade_import::{ImportError, ImportOptions, Imported, load};
use enfilade_scene::{Bsdf, Principled, Quiet};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A folder of files that goes away with it.
pub struct Folder(TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> &Self {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("a parent")).expect("a folder");
        std::fs::write(path, bytes).expect("a file");
        self
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn load(&self, name: &str) -> Result<Imported, ImportError> {
        self.load_with(name, &ImportOptions::default())
    }

    pub fn load_with(&self, name: &str, options: &ImportOptions) -> Result<Imported, ImportError> {
        load(&self.path(name), options, &Quiet)
    }

    /// The message of the error that loading `name` gives, without the folder's own path.
    pub fn error(&self, name: &str) -> String {
        let error = self.load(name).expect_err("an error").to_string();
        error.replace(&format!("{}/", self.0.path().display()), "")
    }
}

/// Warnings of an import as text, without folders.
pub fn warnings(imported: &Imported) -> String {
    imported
        .report
        .warnings
        .iter()
        .map(|w| format!("{}: {}\n", Path::new(&w.place).file_name().unwrap().to_string_lossy(), w.message))
        .collect()
}

/// A PNG of `width` × `height` pixels, all of one colour.
pub fn png(width: u32, height: u32, pixel: [u8; 4]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbaImage::from_pixel(width, height, image::Rgba(pixel)).write_to(&mut bytes, image::ImageFormat::Png).expect("a PNG");
    bytes.into_inner()
}

/// Base64 of RFC 4648 with padding.
pub fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    bytes
        .chunks(3)
        .flat_map(|c| {
            let n = u32::from(c[0]) << 16 | u32::from(*c.get(1).unwrap_or(&0)) << 8 | u32::from(*c.get(2).unwrap_or(&0));
            let digit = move |i: usize| if i <= c.len() { DIGITS[(n >> (18 - 6 * i) & 63) as usize] as char } else { '=' };
            (0..4).map(digit).collect::<Vec<_>>()
        })
        .collect()
}

/// A glTF document in the making: one buffer as a data URI.
pub struct Gltf {
    pub json: Value,
    bytes: Vec<u8>,
}

impl Gltf {
    /// One triangle in the plane z = 0 with texture coordinates, as mesh 0 at node 0 ("Chair").
    pub fn triangle() -> Self {
        let json = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"name": "Chair", "mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
            "materials": [{"name": "Wood", "pbrMetallicRoughness": {"metallicFactor": 0.0}}],
            "accessors": [], "bufferViews": []
        });
        let mut gltf = Self { json, bytes: Vec::new() };
        gltf.accessor(&[0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat(), 5126, "VEC3", 3);
        gltf.accessor(&[0.0f32, 1.0, 1.0, 1.0, 0.0, 0.0].map(f32::to_le_bytes).concat(), 5126, "VEC2", 3);
        gltf.accessor(&[0u16, 1, 2].map(u16::to_le_bytes).concat(), 5123, "SCALAR", 3);
        gltf
    }

    /// Appends a buffer view with these bytes and an accessor of all of it; returns the accessor's index.
    pub fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        let accessors = self.json["accessors"].as_array_mut().expect("accessors");
        accessors.push(json!({"bufferView": view, "componentType": component, "type": kind, "count": count}));
        accessors.len() - 1
    }

    /// Appends a buffer view with these bytes.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        while !self.bytes.len().is_multiple_of(4) {
            self.bytes.push(0);
        }
        let views = self.json["bufferViews"].as_array_mut().expect("views");
        views.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend(bytes);
        views.len() - 1
    }

    /// The document as `.gltf` text with the buffer as a data URI.
    pub fn text(&self) -> String {
        let mut json = self.json.clone();
        let uri = format!("data:application/octet-stream;base64,{}", base64(&self.bytes));
        json["buffers"] = json!([{"byteLength": self.bytes.len(), "uri": uri}]);
        json.to_string()
    }

    /// The document as `.glb`.
    pub fn binary(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bytes.len()}]);
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut binary = self.bytes.clone();
        binary.resize(binary.len().next_multiple_of(4), 0);
        let word = |n: usize| (n as u32).to_le_bytes();
        [
            b"glTF".to_vec(),
            word(2).to_vec(),
            word(28 + text.len() + binary.len()).to_vec(),
            word(text.len()).to_vec(),
            b"JSON".to_vec(),
            text,
            word(binary.len()).to_vec(),
            b"BIN\0".to_vec(),
            binary,
        ]
        .concat()
    }
}

/// The principled surface that a material has.
pub fn principled(bsdf: &Bsdf) -> &Principled {
    match bsdf {
        Bsdf::Principled(p) => p,
        other => panic!("not principled: {other:?}"),
    }
}
