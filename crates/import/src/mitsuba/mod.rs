//! Mitsuba scene descriptions (XML) of versions 0.5, 0.6, 2 and 3.
//!
//! Property names may be in camel case (`toWorld`) or snake case (`to_world`). `<default>` parameters, `<include>`, `<alias>`, `<ref>`
//! and `<path>` are followed.
//!
//! | element | supported |
//! |---|---|
//! | shapes | `obj` (in version 0.x one part per group and material, of the bsdf of the material's name, else of one without a name, else as the `.mtl` library has it; `shapeIndex`, `loadMaterials`), `ply` (text and binary), `serialized`, `rectangle`, `disk`, `sphere`, `cube`, `cylinder`, `shapegroup` and `instance`; `faceNormals`, `flipNormals`. Round shapes become meshes of 96 segments with smooth normals, which have 0.07 % less area |
//! | bsdfs | `diffuse`, `roughdiffuse`, `plastic`, `roughplastic`, `conductor`, `roughconductor`, `dielectric`, `roughdielectric`, `thindielectric`, `principled`, `principledthin`, `phong` and `ward` (as plastic), `coating` and `roughcoating` (a diffuse base becomes plastic, others lose the coat), `twosided`, `mask`, `bumpmap`, `normalmap`, `blendbsdf`, `mixturebsdf`, `null` (the shape is left out) |
//! | textures | `bitmap`, `checkerboard` (baked), `scale`, `mesh_attribute` of a PLY file (its mean); filter, wrapping, channel, `uscale … voffset`, `to_uv` |
//! | spectra | `rgb`, `srgb`, `spectrum` (one value, wavelengths, a file, or of the type `blackbody`, `d65`, `uniform`, `regular`, `irregular`), `blackbody`, `float`; metals and substances by name |
//! | emitters | `area`, `constant`, `envmap`, `point`, `spot`, `directional`, `sunsky`, `sky`, `sun` (by Hillaire's model in place of Hosek's) |
//! | sensors | `perspective`, `thinlens` (as a pinhole) |
//! | skipped in silence | integrators, samplers, films (but for their size), reconstruction filters: they are no part of the scene |
//! | dropped with a warning | media, animation (its first moment is used), Beckmann and Phong distributions (GGX of the same alpha), anisotropy, whatever else has no counterpart |
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
//! # Names
//!
//! A part is named by the shape's `id`, else `<material>_<mesh file or shape type>`, where the material is the `id` of the bsdf or
//! `inline`. Materials carry the bsdf's `id`; those of emitters `<id>_emitter`. Where version 0.x finds several meshes in
//! an OBJ file, `.<group>` is appended.

mod attribute;
mod bsdf;
mod emitter;
mod mask;
mod number;
mod obj;
mod placement;
mod sensor;
mod serialized;
mod shape;
pub(crate) mod spectrum;
mod texture;
mod transform;
mod xml;

use crate::assembly::Assembly;
use crate::{ImportError, Imported};
use attribute::Attributes;
use std::collections::{HashMap, HashSet};
use xml::Node;

/// References to references deeper than this are taken for a cycle.
const MAX_REFERENCES: usize = 32;

/// A scene has at most so many parts, instances counted one by one.
const MAX_PARTS: usize = 4_000_000;

/// References within references may lead to so many more shapes and bsdfs than the file has elements; beyond them is taken for a
/// mistake: a group of two instances of a group of two instances … has as many shapes as it likes.
const MAX_VISITS: usize = 1 << 16;

/// Imports a Mitsuba scene.
pub(crate) fn load(mut assembly: Assembly) -> Result<Imported, ImportError> {
    let root = xml::read(&mut assembly)?;
    let mut reader = Reader {
        a: assembly,
        version: root.attribute("version").and_then(|v| v.split('.').next()?.trim().parse().ok()).unwrap_or(0),
        ids: HashMap::new(),
        referred_to: HashSet::new(),
        aliases: HashMap::new(),
        materials: HashMap::new(),
        meshes: HashMap::new(),
        greys: HashMap::new(),
        attributes: Attributes::default(),
        obj: obj::Files::default(),
        elements: 0,
        parts: 0,
        visits: 0,
    };
    reader.index(&root);
    let total = root.children.len();
    for (i, node) in root.children.iter().enumerate() {
        reader.a.progress(i + 1, total);
        reader.scene_element(node)?;
    }
    reader.a.finish()
}

/// A scene being read: the tree's objects by id, and what has been made of them.
struct Reader<'n, 'a> {
    a: Assembly<'a>,
    /// The first number of the version that the scene file is for; 0 where it states none.
    version: u32,
    ids: HashMap<&'n str, &'n Node>,
    /// The ids in the file's references.
    referred_to: HashSet<&'n str>,
    aliases: HashMap<&'n str, &'n str>,
    materials: HashMap<bsdf::MaterialKey, u32>,
    meshes: HashMap<shape::MeshKey, Option<u32>>,
    /// The grey pictures of coloured ones.
    greys: HashMap<u32, u32>,
    attributes: Attributes,
    obj: obj::Files,
    /// Elements of the file and of those that it includes.
    elements: usize,
    /// Parts so far.
    parts: usize,
    /// How often references within references led to shapes and bsdfs so far.
    visits: usize,
}

impl<'n> Reader<'n, '_> {
    /// Notes the ids of a tree. Depth is bounded by the parser.
    fn index(&mut self, node: &'n Node) {
        self.elements += node.children.len();
        for child in &node.children {
            if child.tag == "alias" {
                if let (Some(id), Some(new)) = (child.attribute("id"), child.attribute("as")) {
                    self.aliases.insert(new, id);
                }
            } else if let Some(id) = child.id.as_deref().filter(|_| child.tag != "ref")
                && self.ids.insert(id, child).is_some()
            {
                self.warn(child, "the id is used twice; the later one counts");
            }
            if child.tag == "ref" {
                self.referred_to.extend(child.id.as_deref());
            }
            self.attributes.wanted |= child.plugin == "mesh_attribute";
            self.index(child);
        }
    }

    fn scene_element(&mut self, node: &'n Node) -> Result<(), ImportError> {
        match node.tag.as_str() {
            "shape" => self.shape(node),
            "emitter" => self.emitter(node),
            "sensor" => self.sensor(node),
            // Definitions are read where they are referred to; the rest says how to render, not what.
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

    /// The object that a `ref` stands for; any other element stands for itself.
    fn resolve(&self, node: &'n Node) -> Result<&'n Node, ImportError> {
        let mut node = node;
        for _ in 0..MAX_REFERENCES {
            if node.tag != "ref" {
                return Ok(node);
            }
            let id = node.id.as_deref().ok_or_else(|| node.error("the reference has no id"))?;
            let id = self.aliases.get(id).copied().unwrap_or(id);
            node = self.ids.get(id).copied().ok_or_else(|| node.error(format!("nothing in the scene has the id {id:?}")))?;
        }
        Err(node.error("references go in a circle"))
    }

    /// True when any reference leads to `node`.
    fn is_referred_to(&self, node: &Node) -> bool {
        let meant = |id: &&str| self.ids.get(self.aliases.get(id).unwrap_or(id)).is_some_and(|found| std::ptr::eq(*found, node));
        self.referred_to.iter().any(meant)
    }

    /// The objects of a tag directly within `node`, references followed.
    fn objects(&self, node: &'n Node, tag: &str) -> Result<Vec<&'n Node>, ImportError> {
        let mut found = Vec::new();
        for child in node.children.iter().filter(|c| c.tag == tag || c.tag == "ref") {
            let target = self.resolve(child)?;
            if target.tag == tag {
                found.push(target);
            }
        }
        Ok(found)
    }

    /// The property or object `name` of `node`, references followed.
    fn property(&self, node: &'n Node, name: &str) -> Result<Option<&'n Node>, ImportError> {
        let Some(child) = node.child(name) else { return Ok(None) };
        let found = self.resolve(child)?;
        // Daylight times a texture is the texture in RGB.
        let texture = if found.plugin == "d65" { self.objects(found, "texture")?.first().copied() } else { None };
        Ok(Some(texture.unwrap_or(found)))
    }

    /// Counts one of these `things` that is come to; `depth` references have led there.
    ///
    /// # Errors
    /// When references go in a circle, or lead to more things than a scene has.
    fn visit(&mut self, node: &Node, depth: usize, things: &str) -> Result<(), ImportError> {
        self.visits += usize::from(depth > 1);
        if depth > MAX_REFERENCES {
            return Err(node.error(format!("{things} go in a circle")));
        }
        let most = MAX_VISITS + self.elements;
        if self.visits > most {
            return Err(node.error(format!("references lead to more than {most} shapes and bsdfs; refer to each thing once")));
        }
        Ok(())
    }

    fn warn(&mut self, node: &Node, message: impl Into<String>) {
        self.a.warn(node.place(), message);
    }

    /// Warns of every property and object of `node` that is neither in `known` nor of an object tag in `tags`.
    fn report_unknown(&mut self, node: &'n Node, known: &[&str], tags: &[&str]) {
        for child in &node.children {
            let named = known.contains(&child.name.as_str());
            let object = tags.contains(&child.tag.as_str()) || (child.tag == "ref" && !tags.is_empty());
            if !named && !object && child.tag != "alias" {
                self.warn(child, format!("ignored in {}", node.plugin));
            }
        }
    }
}

/// What a message about an unknown plugin adds where its name has capitals: Mitsuba's have none.
fn spelling(plugin: &str) -> String {
    let small = plugin.to_lowercase();
    if small == plugin { String::new() } else { format!(" (plugins have small letters: {small:?})") }
}
