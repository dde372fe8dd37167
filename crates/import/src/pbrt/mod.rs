//! pbrt scene descriptions of versions 3 and 4 (`.pbrt`, `.pbrt.gz`).
//!
//! The version is recognised by the words of the file (`version.rs`). `Include` and `Import` are followed.
//!
//! | what | supported |
//! |---|---|
//! | shapes | `trianglemesh`, `plymesh` (also `.ply.gz`), `bilinearmesh`, `sphere`, `disk`, `cylinder`, `cone` with their cuts; `loopsubdiv` by its control mesh, with a warning. Round shapes become meshes of 96 segments to the circle |
//! | placement | all transforms, named coordinate systems, `ObjectBegin` and instances (which share meshes), `ReverseOrientation` |
//! | materials of version 3 | `matte`, `plastic`, `metal`, `mirror`, `glass`, `uber`, `substrate`, `mix`, `disney`, `none` |
//! | materials of version 4 | `diffuse`, `coateddiffuse`, `conductor`, `coatedconductor`, `dielectric`, `thindielectric`, `mix`, `interface` |
//! | substituted with a warning | `translucent` and `diffusetransmission` (what they transmit is lost), `subsurface`, `kdsubsurface`, `hair`, `fourier`, `measured` |
//! | details | `bumpmap`, `displacement`, `normalmap`, `alpha`; `remaproughness` by each version's own formula, textures included |
//! | textures | `constant`, `imagemap`, `scale`, `mix`, `checkerboard` (baked), by `uv`; with a warning, `bilerp` and `directionmix` by their mean, others as mid grey, other mappings as `uv`. Pictures of numbers count by their alpha or the mean of their channels (version 4), by their luminance (version 3) |
//! | spectra | `rgb`, `color`, `xyz`, `blackbody`, wavelengths, `.spd` files; metals, glasses and illuminants by name |
//! | lights | `point`, `spot`, `distant`, `infinite` (maps of both layouts), `diffuse` area lights; `power`, `illuminance`, `scale`, `twosided` |
//! | cameras | `perspective`, as a pinhole |
//! | skipped in silence | `Sampler`, `Integrator`, `PixelFilter`, `Accelerator`, `Option`, `Film` except for its size: they are settings of rendering |
//! | dropped with a warning | media (except for absorption within glass), motion (the first moment is used), curves and the other shapes, colours of vertices, projection lights, the picture of goniometric ones (replaced by points), portals, colour spaces other than sRGB, sensors and exposure |
//!
//! The crates that read pbrt's text know one version each (`pbrt4` 0.2 the fourth, `rs_pbrt`, a renderer, the third), record no places for
//! messages and do not interpret a scene, which is most of the work. So the reader is our own.
//!
//! # Handedness
//!
//! pbrt's world is left-handed unless the transform in front of the camera mirrors it, as `Scale -1 1 1` does. Worlds of the first kind
//! are mirrored along x here, so that pictures come out as pbrt shows them; those of the second kind are right-handed already.
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
mod definition;
mod directive;
mod environment;
mod gzip;
mod light;
mod made;
mod material;
mod metallic;
mod params;
mod reader;
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
use gzip::unpacked;
use params::Place;
use reader::Reader;
use std::path::Path;
use std::rc::Rc;
use tokens::Tokens;

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

impl Reader<'_> {
    /// Reads all directives of a file.
    fn file(&mut self, bytes: &[u8], path: &Path) -> Result<(), ImportError> {
        let text = enfilade_scene::decoded_text(bytes);
        let mut tokens = Tokens::new(&text, path);
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
}
