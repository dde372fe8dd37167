//! Mitsuba scene descriptions (XML) of versions 0.5, 0.6, 2 and 3.
//!
//! Property names may be in camel case (`toWorld`) or snake case (`to_world`). `<default>` parameters, `<include>`, `<alias>`, `<ref>`
//! and `<path>` are followed.
//!
//! | element | supported |
//! |---|---|
//! | shapes | `obj` (in version 0.x one part per group and material, of the bsdf of the material's name, else of one without a name, else as the `.mtl` library has it; `shapeIndex`, `loadMaterials`), `ply` (text and binary), `serialized`, `rectangle`, `disk`, `sphere`, `cube`, `cylinder`, `shapegroup` and `instance`; `faceNormals`, `flipNormals`. Round shapes become meshes of 96 segments with smooth normals, which have 0.07 % less area |
//! | bsdfs | `diffuse` (also `lambertian`, and `difftrans` without what it transmits), `roughdiffuse`, `plastic`, `roughplastic` (also `pplastic`), `conductor`, `roughconductor`, `dielectric`, `roughdielectric`, `thindielectric`, `principled`, `principledthin`, `phong` and `ward` (as plastic), `coating` and `roughcoating` (a diffuse base becomes plastic, others lose the coat), `twosided`, `mask`, `bumpmap`, `normalmap`, `blendbsdf`, `mixturebsdf`, `null` (the shape is left out) |
//! | textures | `bitmap` (also `ldrtexture`, `exrtexture`), `checkerboard` (baked), `scale`, `mesh_attribute` of a PLY file (its mean); filter, wrapping, channel, `uscale … voffset`, `to_uv` |
//! | spectra | `rgb`, `srgb`, `spectrum` (one value, wavelengths, a file, or of the type `blackbody`, `d65`, `uniform`, `regular`, `irregular`), `blackbody`, `float`; metals and substances by name |
//! | emitters | `area`, `constant`, `envmap`, `point`, `spot`, `directional`, `sunsky`, `sky`, `sun` (by Hillaire's model in place of Hosek's) |
//! | sensors | `perspective`, `thinlens` (as a pinhole) |
//! | skipped in silence | integrators, samplers, films (except for their size), reconstruction filters: they are no part of the scene |
//! | media within shapes | what a `homogeneous` medium of constant `sigma_t` and `albedo`, or `sigma_a` and `sigma_s`, absorbs (with `scale`), within `dielectric` and `roughdielectric`; it does not scatter, which is a warning |
//! | dropped with a warning | other media, animation (its first moment is used), Beckmann and Phong distributions (GGX of the same alpha), anisotropy, colours of vertices that no `mesh_attribute` asks for, whatever else has no counterpart |
//!
//! # Sides
//!
//! A surface has two sides only inside `twosided`, as in Mitsuba; area emitters shine on the front alone. The front of a mesh with
//! vertex normals is where these point; with `faceNormals`, which drops them, the corners' order decides.
//!
//! # Opacity
//!
//! The `opacity` bitmap of a `mask` is read from its colours, as in Mitsuba; in version 0.x from its alpha where that cuts something
//! out and no channel is named, as in the renderers from which the well-known rooms were converted. Coloured pictures of numbers count
//! by their luminance, in version 0.x by the mean of their channels.
//!
//! # Light of a constant spectrum
//!
//! `<spectrum name="radiance" value="10"/>`, and so for every emitter, is light of equal energy at all wavelengths: (12.05, 9.48, 9.09) in
//! versions 2 and 3, as in Mitsuba's RGB variants; version 0.x means white. A `float`, an `rgb`, and a spectrum of the type `uniform` are
//! white in all. Lists and files of wavelengths are integrated alike in all versions.
//!
//! # Names
//!
//! A part is named by the shape's `id`, else `<material>_<mesh file or shape type>`, where the material is the `id` of the bsdf or
//! `inline`. Materials carry the bsdf's `id`; those of emitters `<id>_emitter`. Where version 0.x finds several meshes in
//! an OBJ file, `.<group>` is appended.

mod attribute;
mod bsdf;
mod emitter;
mod made;
mod mask;
mod medium;
mod number;
mod obj;
mod placement;
mod reader;
mod scattering;
mod sensor;
mod serialized;
mod shape;
mod spectrum;
mod texture;
mod transform;
mod xml;

use crate::assembly::Assembly;
use crate::{ImportError, Imported};
use reader::Reader;
use xml::Node;

/// Imports a Mitsuba scene.
pub(crate) fn load(mut assembly: Assembly) -> Result<Imported, ImportError> {
    let root = xml::read(&mut assembly)?;
    let version = root.attribute("version").and_then(|v| v.split('.').next()?.trim().parse().ok()).unwrap_or(0);
    let mut reader = Reader::new(assembly, version);
    reader.index(&root);
    let total = root.children.len();
    for (i, node) in root.children.iter().enumerate() {
        reader.a.progress(i + 1, total);
        reader.scene_element(node)?;
    }
    reader.a.finish()
}

impl<'n> Reader<'n, '_> {
    /// Reads an element directly within the scene.
    fn scene_element(&mut self, node: &'n Node) -> Result<(), ImportError> {
        match node.tag.as_str() {
            "shape" => self.shape(node),
            "emitter" => self.emitter(node),
            "sensor" => self.sensor(node),
            // Definitions are read where they are referred to; the rest are settings of rendering.
            "bsdf" | "texture" | "medium" | "alias" | "integrator" | "sampler" | "film" | "rfilter" | "spectrum" => Ok(()),
            "ref" => match self.resolve(node)? {
                target if target.tag == "ref" => Ok(()),
                target => self.scene_element(target),
            },
            _ => {
                self.warn(node, "unknown element ignored");
                Ok(())
            }
        }
    }
}
