//! The table of targets, and what reads for each.

mod annotations;
mod arrays;
mod datasets;
mod homes;
mod partial;
pub mod scene_files;
mod texts;
mod vray;

use crate::{Reads, Seed, Target, seeds};

/// All targets.
pub const TARGETS: [Target; 20] = [
    importer("gltf", "scene.gltf", "scene.gltf", "glTF, as text and binary", seeds::gltf),
    importer("obj", "scene.obj", "scene.obj", "Wavefront OBJ", none),
    importer("mtl", "scene.mtl", "with_mtl.obj", "MTL materials of an OBJ", none),
    importer("mitsuba", "scene.xml", "scene.xml", "Mitsuba XML", seeds::mitsuba),
    importer("ply", "mesh.ply", "with_ply.xml", "PLY meshes of a Mitsuba scene", seeds::ply),
    importer("serialized", "mesh.serialized", "with_serialized.xml", "Mitsuba's compressed meshes", seeds::serialized),
    importer("ies", "lamp.ies", "with_ies.gltf", "IES photometric profiles of a glTF", none),
    // The extension is that of the one format which has no signature.
    importer("picture", "picture.tga", "with_picture.obj", "PNG, JPEG, BMP, TGA, HDR, EXR and PFM as textures", seeds::pictures),
    own("package", "scene packages, their checksum set right", 16 << 10, scene_files::package, seeds::packages),
    own("vrscene", "V-Ray's scene description, its values, and what edits them", 8 << 10, vray::document, none),
    own("octree", "OctoMap's trees, .bt and .ot", 4 << 10, arrays::octree, seeds::octrees),
    own("hdf5", "HDF5 arrays, and everything that a dataset has of them", 8 << 10, arrays::hdf5, seeds::arrays),
    own("tables", "CSV tables of a dataset, of labels, classes and suggestions", 4 << 10, datasets::tables, seeds::tables),
    own("records", "JSON of a dataset: manifest, records, cameras, masks", 4 << 10, datasets::records, seeds::records),
    own("keyframes", "poses made by hand, CSV and JSON", 4 << 10, texts::keyframes, none),
    own("config", "configurations, TOML", 4 << 10, texts::config, none),
    own("library", "furniture catalogues of Sweet Home 3D, and assets.toml", 8 << 10, homes::library, seeds::catalogues),
    own("partial", "frames in the making, their checksum set right", 4 << 10, partial::partial, partial::seeds),
    own("annotations", "the logs of annotating", 8 << 10, annotations::log, annotations::logs),
    own("requests", "requests to both servers", 4 << 10, annotations::requests, none),
];

/// A target that imports: `file` is made of the bytes, `scene` is imported; the files beside them are those of [`scene_files`].
const fn importer(name: &'static str, file: &'static str, scene: &'static str, about: &'static str, seeds: fn() -> Vec<Seed>) -> Target {
    Target { name, about, longest: 8 << 10, reads: Reads::Scene { file, scene }, seeds, words: &[] }
}

const fn own(name: &'static str, about: &'static str, longest: usize, run: fn(&std::path::Path) -> crate::Run, seeds: fn() -> Vec<Seed>) -> Target {
    Target { name, about, longest, reads: Reads::Own(run), seeds, words: &[] }
}

/// For targets whose seeds are all files.
fn none() -> Vec<Seed> {
    Vec::new()
}
