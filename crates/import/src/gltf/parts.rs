//! Parts: the primitives of a node's mesh with their materials.

use super::animation::Animations;
use super::color::{self, Several, Tint};
use super::container::Document;
use super::deform::{Bound, Deforms};
use super::draco;
use super::file_material::FileMaterial;
use super::materials::Materials;
use super::morph;
use super::painted::painted;
use super::primitive::{self, Pose};
use super::skin::{self, Skins};
use crate::ImportError;
use crate::assembly::{Assembly, FileLabel};
use enfilade_math::{DAffine3, Rgb};
use enfilade_scene::{BodyId, ObjectId};
use gltf::json::mesh::Primitive;
use gltf::json::scene::Node;
use std::collections::{BTreeSet, HashMap};

/// The placement of a mesh of the file, and the names of its parts.
pub(super) struct Stand<'n> {
    pub node: &'n Node,
    pub index: usize,
    pub name: String,
    /// The object that the part belongs to.
    pub object: Option<ObjectId>,
    pub label: FileLabel,
    /// The body that the node belongs to.
    pub body: Option<BodyId>,
}

/// Makes parts of the file's meshes, which share what they can.
pub(super) struct Parts<'d> {
    document: &'d Document,
    materials: Materials,
    skins: Skins<'d>,
    deforms: Deforms<'d>,
    /// `None` for those without a surface.
    shapes: HashMap<Key, Option<Shape>>,
    /// Meshes and primitives whose vertices have several colours that show.
    varied: BTreeSet<(usize, usize)>,
}

/// Key of a primitive's shape: the parts of nodes that move its vertices.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Key {
    mesh: usize,
    primitive: usize,
    skin: Option<usize>,
    /// Bits of the weights of its morph targets.
    weights: Vec<u32>,
}

/// A mesh of the scene, and what the colours of its vertices do to its material.
#[derive(Clone, Copy)]
struct Shape {
    mesh: u32,
    tint: Tint,
    /// The varying colours and opacities that only the tint represents.
    several: Several,
    /// The picture of its colours.
    picture: Option<u32>,
}

impl<'d> Parts<'d> {
    pub(super) fn new(document: &'d Document, animations: &'d Animations) -> Self {
        Self {
            document,
            materials: Materials::default(),
            skins: Skins::new(document),
            deforms: Deforms::new(document, animations),
            shapes: HashMap::new(),
            varied: BTreeSet::new(),
        }
    }

    /// Adds mesh `mesh` of the file at every one of `places`, each with the object that it is there.
    ///
    /// # Errors
    /// When the mesh or its material cannot be read.
    pub(super) fn add(&mut self, mesh: usize, stand: &Stand, places: &[(ObjectId, DAffine3)], a: &mut Assembly) -> Result<(), ImportError> {
        let meshes = &self.document.root.meshes;
        let Some(json) = meshes.get(mesh) else {
            let problem = format!("it refers to mesh {mesh}, but there are only {}", meshes.len());
            return Err(a.malformed(format!("nodes[{}]", stand.index), problem));
        };
        let name = &stand.name;
        let weights = morph::weights(stand.node, json);
        for (i, primitive) in json.primitives.iter().enumerate() {
            let place = format!("meshes[{mesh}].primitives[{i}]");
            let packed = self.document.is_unpacked(mesh, i);
            packed.map_err(|problem| a.malformed(format!("{place}.extensions.{}", draco::NAME), format!("it {problem}")))?;
            let material = self.materials.read(self.document, primitive.material.map(|m| m.value()), &place, a)?;
            let skin = self.skin(stand, primitive, places.len(), &place, a);
            let key = Key { mesh, primitive: i, skin, weights: weights.iter().map(|w| w.to_bits()).collect() };
            let shape = match self.shapes.get(&key) {
                Some(&known) => known,
                None => {
                    let joints = skin.map(|skin| self.skins.joints(skin, stand.index, a)).transpose()?;
                    let pose = Pose { weights, joints: joints.as_deref() };
                    let built = self.shape(primitive, &material, &pose, &place, a)?;
                    self.shapes.insert(key, built);
                    if built.is_some_and(|shape| material.shows(shape.several)) {
                        self.varied.insert((mesh, i));
                    }
                    built
                }
            };
            let Some(shape) = shape else { continue };
            let uv_set = material.uv_set;
            let material = self.materials.tinted(&material, shape.tint, shape.picture, a);
            let bound = Bound { node: stand.index, skin, primitive, uv_set, weights, place: &place };
            let triangles = a.mesh_at(shape.mesh).triangles.clone();
            let deformed = self.deforms.of(&bound, &triangles, &places.iter().map(|(_, place)| *place).collect::<Vec<_>>(), a)?;
            let part = if json.primitives.len() > 1 { format!("{name}.{i}") } else { name.clone() };
            // Joints place a skinned mesh in the file by themselves.
            for &(object, file_from_mesh) in places.iter().take(if skin.is_some() { 1 } else { places.len() }) {
                let file_from_mesh = if skin.is_some() { DAffine3::IDENTITY } else { file_from_mesh };
                // A label of the node itself applies to each placement.
                let is_own = stand.label.whole.is_some() && stand.label.whole == stand.object;
                let label = FileLabel { whole: if is_own { Some(object) } else { stand.label.whole }, ..stand.label };
                let placed = a.push_part_of(object, &part, shape.mesh, material, file_from_mesh, label);
                if let (Some(placed), Some(deformed)) = (placed, &deformed) {
                    a.deform(placed, stand.body.filter(|_| deformed.is_borne), deformed.shapes.clone());
                }
            }
        }
        Ok(())
    }

    /// The skin of the node, where the primitive is bound to one.
    fn skin(&self, stand: &Stand, primitive: &Primitive, places: usize, place: &str, a: &mut Assembly) -> Option<usize> {
        let skin = stand.node.skin?.value();
        if !skin::is_bound(primitive) {
            a.warn(place, "a node has a skin for it, but it has neither joints nor weights; it is placed by the node");
            return None;
        }
        if places > 1 {
            a.warn(format!("nodes[{}]", stand.index), "instances of a mesh with a skin have no meaning; it was placed once");
        }
        Some(skin)
    }

    fn shape(
        &mut self,
        primitive: &Primitive,
        material: &FileMaterial,
        pose: &Pose,
        place: &str,
        a: &mut Assembly,
    ) -> Result<Option<Shape>, ImportError> {
        let Some(mut mesh) = primitive::mesh(self.document, primitive, material.uv_set, pose, place, a)? else { return Ok(None) };
        let colors = color::read(self.document, primitive, &mesh, place, a)?;
        let (mut tint, mut several) = color::mean(&mesh, &colors);
        let is_painted = several.colors && material.has_color && !material.is_textured();
        let painted = is_painted.then(|| painted(&mesh, &colors, &format!("{place}.attributes.COLOR_0"))).flatten();
        let picture = painted.map(|(painted, image)| {
            (mesh, tint.color, several.colors) = (painted, Rgb::WHITE, false);
            image
        });
        let file = a.file().to_path_buf();
        let Some(mesh) = a.push_mesh(mesh, &file, place)? else { return Ok(None) };
        let picture = picture.map(|image| a.push_image(image));
        Ok(Some(Shape { mesh, tint, several, picture }))
    }

    /// Reports what concerns many parts.
    pub(super) fn finish(self, a: &mut Assembly) {
        let Some((mesh, primitive)) = self.varied.first() else { return };
        let others = match self.varied.len() {
            1 => String::new(),
            2 => " and one other primitive".to_string(),
            n => format!(" and {} other primitives", n - 1),
        };
        let first = format!("meshes[{mesh}].primitives[{primitive}]");
        a.warn("meshes", format!("vertex colours vary over {first}{others}, beside textures or in opacity; their mean over each was used"));
    }
}
