//! pbrt scene descriptions of versions 3 and 4 (`.pbrt`, `.pbrt.gz`).
//!
//! The version is told by the words of the file. `Include` and `Import` are followed.
//!
//! | what | supported |
//! |---|---|
//! | shapes | `trianglemesh`, `plymesh` (also `.ply.gz`), `bilinearmesh`, `sphere`, `disk`, `cylinder`, `cone` with their cuts; `loopsubdiv` by its control mesh, with a warning. Round shapes become meshes of 96 segments to the circle |
//! | placement | all transforms, named coordinate systems, `ObjectBegin` and instances (which share meshes), `ReverseOrientation` |
//! | materials of version 3 | `matte`, `plastic`, `metal`, `mirror`, `glass`, `uber`, `substrate`, `mix`, `disney`, `none` |
//! | materials of version 4 | `diffuse`, `coateddiffuse`, `conductor`, `coatedconductor`, `dielectric`, `thindielectric`, `mix`, `interface` |
//! | substituted with a warning | `translucent` and `diffusetransmission` (what they transmit is lost), `subsurface`, `kdsubsurface`, `hair`, `fourier`, `measured` |
//! | details | `bumpmap`, `displacement`, `normalmap`, `alpha`; `remaproughness` by each version's own formula, textures included |
//! | textures | `constant`, `imagemap`, `scale`, `mix`, `checkerboard` (baked), by `uv`; others and other mappings are mid grey or `uv`, with a warning. Pictures of numbers count by their alpha or the mean of their channels (version 4), by their luminance (version 3) |
//! | spectra | `rgb`, `color`, `xyz`, `blackbody`, wavelengths, `.spd` files; metals, glasses and illuminants by name |
//! | lights | `point`, `spot`, `distant`, `infinite` (maps of both layouts), `diffuse` area lights; `power`, `illuminance`, `scale`, `twosided` |
//! | cameras | `perspective`, as a pinhole |
//! | skipped in silence | `Sampler`, `Integrator`, `PixelFilter`, `Accelerator`, `Option`, `Film` but for its size: they say how to render, not what |
//! | dropped with a warning | media (but for absorption within glass), motion (the first moment is used), curves and the other shapes, goniometric and projection lights, portals, colour spaces other than sRGB, sensors and exposure |
//!
//! The crates that read pbrt's text know one version each (`pbrt4` 0.2 the fourth, `rs_pbrt`, a renderer, the third), keep no place for
//! messages and say nothing about what a scene means, which is most of the work; so the reading is our own.
//!
//! # Handedness
//!
//! pbrt's world is left-handed unless the transform in front of the camera mirrors it, as `Scale -1 1 1` does. Worlds of the first kind
//! are mirrored along x here, so that pictures come out as pbrt shows them; those of the second kind are right-handed as they stand.
//!
//! # Light
//!
//! Version 3 takes a light's colour for its radiance. Version 4 takes a spectrum's shape alone, scaled to a luminance of one, and
//! `scale`, `power` and `illuminance` for the strength; the colour of `rgb` keeps its own strength.
//!
//! # Names
//!
//! A part is named `<material>_<mesh file or type of shape>`, where the material is the one of `MakeNamedMaterial` or `inline`.

mod bake;
mod camera;
mod directive;
mod environment;
mod light;
mod material;
mod metallic;
mod params;
mod rough;
mod round;
mod shape;
mod spectra;
mod state;
mod texture;
mod tokens;
mod version;

pub(crate) use environment::PBRT_FROM_MAP;

use crate::assembly::Assembly;
use crate::{ImportError, Imported};
use enfilade_math::{DAffine3, DVec3};
use params::{Params, Place};
use state::{Saved, State};
use std::collections::HashMap;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use tokens::Tokens;
use version::Version;

/// Materials or textures within each other deeper than this are taken for a cycle.
const MAX_REFERENCES: usize = 32;

/// A compressed file may unpack to so many bytes.
const MAX_UNPACKED: u64 = 4 << 30;

/// Imports a pbrt scene.
pub(crate) fn load(mut assembly: Assembly) -> Result<Imported, ImportError> {
    let file = assembly.file().to_path_buf();
    let bytes = unpacked(assembly.read_scene_file()?, &file)?;
    let version = version::detect(&bytes, &file, &mut assembly)?;
    let mut reader = Reader::new(assembly, version);
    reader.file(&bytes, &file)?;
    reader.end_of_scene(&file)?;
    reader.a.finish()
}

/// A scene being read.
struct Reader<'a> {
    a: Assembly<'a>,
    version: Version,
    state: State,
    saved: Vec<Saved>,
    /// The file's axes from pbrt's world: the identity, or a mirror.
    file_from_world: DAffine3,
    coordinate_systems: HashMap<String, DAffine3>,
    film: Option<Params>,
    camera: Option<(Params, String, DAffine3)>,
    in_world: bool,
    textures: Vec<texture::Definition>,
    /// Names of textures to indices: of colours, and of numbers.
    texture_names: [HashMap<String, usize>; 2],
    baked: HashMap<bake::Key, u32>,
    baked_texels: usize,
    materials: Vec<material::Definition>,
    material_names: HashMap<String, usize>,
    surfaces: HashMap<usize, material::Surface>,
    finished: HashMap<String, Option<u32>>,
    media: HashMap<String, enfilade_math::Rgb>,
    /// By file or measures, and whether they are turned inside out.
    meshes: HashMap<(String, bool), Option<shape::Shape>>,
    objects: HashMap<String, Vec<shape::Placed>>,
    /// The object being defined, if any.
    object: Option<(String, Vec<shape::Placed>)>,
    parts: usize,
    including: Vec<PathBuf>,
    included: usize,
    next_light: usize,
}

impl<'a> Reader<'a> {
    fn new(a: Assembly<'a>, version: Version) -> Self {
        Self {
            a,
            version,
            state: State::new(),
            saved: Vec::new(),
            file_from_world: DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)),
            coordinate_systems: HashMap::new(),
            film: None,
            camera: None,
            in_world: false,
            textures: Vec::new(),
            texture_names: [HashMap::new(), HashMap::new()],
            baked: HashMap::new(),
            baked_texels: 0,
            materials: vec![material::Definition::default_of(version)],
            material_names: HashMap::new(),
            surfaces: HashMap::new(),
            finished: HashMap::new(),
            media: HashMap::new(),
            meshes: HashMap::new(),
            objects: HashMap::new(),
            object: None,
            parts: 0,
            including: Vec::new(),
            included: 0,
            next_light: 0,
        }
    }

    /// Reads all directives of a file.
    fn file(&mut self, bytes: &[u8], path: &Path) -> Result<(), ImportError> {
        let mut tokens = Tokens::new(bytes, path)?;
        let file = Rc::new(path.to_path_buf());
        self.including.push(path.to_path_buf());
        while let Some(token) = tokens.next()? {
            let tokens::Kind::Bare(word) = token.kind else {
                let place = format!("line {}:{}", token.line, token.column);
                return Err(ImportError::malformed(path, place, "expected a directive, such as Shape, found a value without one"));
            };
            let place = Place { file: file.clone(), line: token.line, column: token.column, what: word.to_string() };
            self.directive(word, place, &mut tokens)?;
        }
        self.including.pop();
        Ok(())
    }

    fn warn(&mut self, place: &Place, message: impl Into<String>) {
        self.a.warn(place.text(), message);
    }

    /// Warns of the parameters that nothing asked for, but for those in `silent`.
    fn report_unused(&mut self, params: &Params, silent: &[&str]) {
        let names: Vec<String> = params.unused().map(|p| p.name.clone()).filter(|n| !silent.contains(&n.as_str())).collect();
        if !names.is_empty() {
            self.warn(&params.place, format!("ignored: {}", names.join(", ")));
        }
    }
}

/// The bytes themselves, or what they hold when they are compressed by gzip.
fn unpacked(bytes: Vec<u8>, path: &Path) -> Result<Vec<u8>, ImportError> {
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(bytes);
    }
    let mut out = Vec::new();
    let read = flate2::read::MultiGzDecoder::new(bytes.as_slice()).take(MAX_UNPACKED + 1).read_to_end(&mut out);
    read.map_err(|e| {
        ImportError::malformed(path, "gzip", format!("cannot be unpacked ({e}); copy the file again or unpack it by gzip -d"))
    })?;
    if out.len() as u64 > MAX_UNPACKED {
        return Err(ImportError::malformed(path, "gzip", "unpacks to more than 4 GiB; split the scene into several files"));
    }
    Ok(out)
}
