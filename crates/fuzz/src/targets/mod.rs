//! The table of targets, what a target is, and how it gets its inputs. Beside it, one file per subject reads them.

#[cfg(feature = "program")]
mod annotations;
mod collections;
mod compressed;
#[cfg(feature = "dataset")]
mod datasets;
#[cfg(feature = "program")]
mod farm;
#[cfg(feature = "program")]
mod homes;
mod octree;
#[cfg(feature = "program")]
mod partial;
mod scene_files;
mod sweethome;
mod texts;
#[cfg(feature = "program")]
mod training;
mod vray;
#[cfg(feature = "program")]
mod vray_image;

use crate::seeds;
use crate::{Run, Seed};
use std::path::{Path, PathBuf};

/// Something that reads bytes.
pub struct Target {
    /// Name of the target, and of its folders.
    pub name: &'static str,
    /// Description of the input.
    pub about: &'static str,
    /// The longest input that is tried, bytes: some times as long as a file in which everything is used.
    pub longest: usize,
    /// How the input is read.
    pub reads: Reads,
    /// Makes files to begin with, beside those in `seeds/<name>/`.
    pub seeds: fn() -> Vec<Seed>,
    /// Words of the format that no seed has.
    pub words: &'static [&'static str],
}

/// How a target reads its input.
pub enum Reads {
    /// Imports the scene file `scene` of a folder in which `file` holds the bytes. Both may be the same.
    Scene {
        /// The file that is made of the bytes.
        file: &'static str,
        /// The file that is imported.
        scene: &'static str,
    },
    /// By a function of its own, which gets a folder where it may write.
    Own(fn(&Path) -> Run),
}

/// All targets.
pub const TARGETS: &[Target] = &[
    importer("gltf", "scene.gltf", "scene.gltf", "glTF, as text and binary", seeds::gltf),
    own("draco", "Draco streams of a glTF", 8 << 10, compressed::draco, compressed::dracos),
    own("meshopt", "buffer views of a glTF that meshopt has packed", 8 << 10, compressed::meshopt, compressed::meshopts),
    importer("obj", "scene.obj", "scene.obj", "Wavefront OBJ", none),
    importer("mtl", "scene.mtl", "with_mtl.obj", "MTL materials of an OBJ", none),
    importer("mitsuba", "scene.xml", "scene.xml", "Mitsuba XML", seeds::mitsuba),
    importer("ply", "mesh.ply", "with_ply.xml", "PLY meshes of a Mitsuba scene", seeds::ply),
    importer("serialized", "mesh.serialized", "with_serialized.xml", "Mitsuba's compressed meshes", seeds::serialized),
    importer("ies", "lamp.ies", "with_ies.gltf", "IES photometric profiles of a glTF", none),
    importer("vray", "scene.vrscene", "scene.vrscene", "V-Ray's scene description, imported", none),
    importer("pbrt", "scene.pbrt", "scene.pbrt", "pbrt's scene description, versions 3 and 4", none),
    importer("usd", "scene.usd", "scene.usd", "Universal Scene Description, as text and binary", seeds::usd),
    importer("usdz", "scene.usdz", "scene.usdz", "archives of Universal Scene Description", seeds::usdz),
    importer("fbx", "scene.fbx", "scene.fbx", "FBX, as text and binary", seeds::fbx),
    importer("collada", "scene.dae", "scene.dae", "COLLADA", none),
    importer("stl", "scene.stl", "scene.stl", "STL, as text and binary", none),
    importer("urdf", "scene.urdf", "scene.urdf", "robots and furniture in URDF", none),
    importer("sdf", "scene.sdf", "scene.sdf", "worlds and models of Gazebo in SDF", none),
    importer("mjcf", "scene.mjcf", "scene.mjcf", "models of MuJoCo", none),
    own("states", "stored runs of simulators, npz and CSV", 4 << 10, scene_files::states, none),
    own("zip", "scenes in ZIP archives", 8 << 10, scene_files::archive, seeds::gltf),
    own("sweethome", "homes of Sweet Home 3D", 8 << 10, sweethome::home, none),
    own("collections", "scenes of collections, and what they are made of", 8 << 10, collections::scene, none),
    // TGA is the one format without a signature, so the extension must name it.
    importer("picture", "picture.tga", "with_picture.obj", "pictures of all formats as textures", seeds::pictures),
    own("package", "scene packages, their checksum set right", 16 << 10, scene_files::package, seeds::packages),
    own("vrscene", "V-Ray's scene description, its values, and what edits them", 8 << 10, vray::document, none),
    own("octree", "OctoMap's trees, .bt", 4 << 10, octree::trees, seeds::octrees),
    #[cfg(feature = "program")]
    own("vray_image", "V-Ray's images with their render elements, OpenEXR", 8 << 10, vray_image::image, seeds::vray_images),
    #[cfg(feature = "dataset")]
    own("hdf5", "HDF5 arrays, and everything that a dataset has of them", 8 << 10, datasets::hdf5, seeds::arrays),
    #[cfg(feature = "dataset")]
    own("tables", "CSV tables of a dataset, of labels, classes and suggestions", 4 << 10, datasets::tables, seeds::tables),
    #[cfg(feature = "dataset")]
    own("records", "JSON of a dataset: manifest, records, cameras, masks", 4 << 10, datasets::records, seeds::records),
    #[cfg(feature = "program")]
    own("nyuv2", "NYUv2's published file, MATLAB 7.3", 32 << 10, training::nyuv2, none),
    #[cfg(feature = "program")]
    own("pix3d", "Pix3D: pix3d.json, its splits, and voxels, MATLAB 5", 8 << 10, training::pix3d, training::pix3d_files),
    own("keyframes", "poses made by hand, CSV and JSON", 4 << 10, texts::keyframes, none),
    own("plans", "floor plans: ours, layouts, of collections, SVG and DXF", 8 << 10, texts::plan, none),
    #[cfg(feature = "program")]
    own("config", "configurations of datasets and sensors, TOML", 4 << 10, texts::config, none),
    #[cfg(feature = "program")]
    own("library", "furniture catalogues of Sweet Home 3D, and assets.toml", 8 << 10, homes::library, seeds::catalogues),
    #[cfg(feature = "program")]
    own("partial", "frames in the making, their checksum set right", 4 << 10, partial::partial, partial::seeds),
    #[cfg(feature = "program")]
    own("farm", "plans, markers and records of a farm, and the archives of its frames", 8 << 10, farm::job, farm::seeds),
    #[cfg(feature = "program")]
    own("annotations", "the logs of annotating", 8 << 10, annotations::log, annotations::logs),
    #[cfg(feature = "program")]
    own("requests", "requests to both servers", 4 << 10, annotations::requests, none),
];

impl Target {
    /// The target of that name.
    pub fn of(name: &str) -> Option<&'static Self> {
        TARGETS.iter().find(|target| target.name == name)
    }

    /// The function that reads inputs, with files in `folder`, which must be empty.
    ///
    /// # Panics
    /// When the folder cannot be written.
    pub fn prepare(&self, folder: &Path) -> Run {
        match self.reads {
            Reads::Scene { file, scene } => scene_files::prepare(folder, file, scene),
            Reads::Own(prepare) => prepare(folder),
        }
    }

    /// All files to begin with: those that are made and those of `seeds/<name>/`.
    ///
    /// # Panics
    /// When a file cannot be read.
    pub fn all_seeds(&self) -> Vec<Seed> {
        let mut all = (self.seeds)();
        all.extend(Seed::of_folder(&self.folder("seeds")));
        all
    }

    /// The inputs that were once found.
    ///
    /// # Panics
    /// When a file cannot be read.
    pub fn regressions(&self) -> Vec<Seed> {
        Seed::of_folder(&self.folder("regressions"))
    }

    fn folder(&self, kind: &str) -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join(kind).join(self.name)
    }
}

/// A target that imports: `file` is made of the bytes, `scene` is imported; the files beside them are those of [`scene_files`].
const fn importer(name: &'static str, file: &'static str, scene: &'static str, about: &'static str, seeds: fn() -> Vec<Seed>) -> Target {
    Target { name, about, longest: 8 << 10, reads: Reads::Scene { file, scene }, seeds, words: &[] }
}

const fn own(name: &'static str, about: &'static str, longest: usize, run: fn(&Path) -> Run, seeds: fn() -> Vec<Seed>) -> Target {
    Target { name, about, longest, reads: Reads::Own(run), seeds, words: &[] }
}

/// For targets whose seeds are all files.
fn none() -> Vec<Seed> {
    Vec::new()
}
