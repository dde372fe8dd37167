//! The nodes of the visual scene: transforms, and what they place.

use super::animation::Animations;
use super::document::{Dae, Node, at, called, child, children, exactly};
use super::material::Materials;
use super::transform::{Transforms, affine};
use super::{geometry, light};
use crate::ImportError;
use crate::assembly::Assembly;
use crate::motion::Changing;
use enfilade_math::DAffine3;
use enfilade_scene::{BodyId, ObjectId, PartLabel};
use std::collections::HashMap;

/// Nodes within nodes deeper than this are taken for a cycle.
const MAX_DEPTH: usize = 64;
/// More visits than this are taken for a mistake: instances of instances multiply.
const MAX_VISITS: usize = 1_000_000;

/// Places all that the scene shows.
pub(super) fn place_scene(dae: &Dae, a: &mut Assembly) -> Result<(), ImportError> {
    let named = at(dae.root, &["scene", "instance_visual_scene"]).and_then(|i| dae.target(i.attribute("url")?));
    let first = || at(dae.root, &["library_visual_scenes", "visual_scene"]);
    let animations = Animations::read(dae, a);
    let mut placer = Placer { dae, animations: &animations, materials: Materials::new(dae), meshes: HashMap::new(), visits: 0 };
    match named.filter(|n| n.tag_name().name() == "visual_scene").or_else(first) {
        Some(scene) => {
            let nodes: Vec<Node> = children(scene, "node").collect();
            for (i, node) in nodes.iter().enumerate() {
                a.progress(i + 1, nodes.len());
                placer.node(*node, Within { file_from_parent: DAffine3::IDENTITY, object: None, body: None, depth: 0 }, a)?;
            }
        }
        None => {
            a.warn("whole file", "there is no visual scene; every geometry was placed as it is");
            for geometry in children(dae.root, "library_geometries").flat_map(|library| children(library, "geometry")) {
                let name = geometry.attribute("name").or(geometry.attribute("id")).unwrap_or("geometry");
                placer.geometry(geometry, geometry, name, DAffine3::IDENTITY, None, a)?;
            }
        }
    }
    animations.report(a);
    Ok(())
}

/// What a node is in.
#[derive(Clone, Copy)]
struct Within {
    file_from_parent: DAffine3,
    object: Option<ObjectId>,
    /// The body that bears it.
    body: Option<BodyId>,
    depth: usize,
}

struct Placer<'p, 'd> {
    dae: &'p Dae<'d>,
    animations: &'p Animations,
    materials: Materials,
    /// By primitive and the set of its texture coordinates; `None` for those without faces.
    meshes: HashMap<(roxmltree::NodeId, Option<String>), Option<u32>>,
    visits: usize,
}

impl<'d> Placer<'_, 'd> {
    fn node(&mut self, node: Node<'d>, within: Within, a: &mut Assembly) -> Result<(), ImportError> {
        self.visits += 1;
        if within.depth > MAX_DEPTH || self.visits > MAX_VISITS {
            return Err(a.malformed(
                called(node),
                format!("nodes are nested more than {MAX_DEPTH} deep, or more than {MAX_VISITS}; check its instances"),
            ));
        }
        let name = node.attribute("name").or(node.attribute("id")).filter(|n| !n.trim().is_empty()).unwrap_or("node");
        let transforms = Transforms::of(node, self.animations, a)?;
        let file_from_node = within.file_from_parent * transforms.rest();
        let object = a.push_object(name, within.object);
        let body = moving(node, name, &transforms, &within, a).or(within.body);
        let inner = Within { file_from_parent: file_from_node, object: Some(object), body, depth: within.depth + 1 };
        for child_node in node.children().filter(roxmltree::Node::is_element) {
            let url = child_node.attribute("url").unwrap_or_default();
            let tag = child_node.tag_name().name();
            if tag == "node" {
                self.node(child_node, inner, a)?;
            }
            if !tag.starts_with("instance_") {
                continue;
            }
            let Some(target) = self.dae.target(url) else {
                a.warn(called(node), format!("it refers to {url:?}, which is not in the file; export the scene with all of it"));
                continue;
            };
            let before = a.contents();
            match tag {
                "instance_node" => {
                    self.node(target, inner, a)?;
                    continue;
                }
                "instance_geometry" => self.geometry(target, child_node, name, file_from_node, Some(object), a)?,
                "instance_controller" => self.controller(target, child_node, name, file_from_node, object, a)?,
                "instance_light" => light::add_light(self.dae, target, name, file_from_node, a),
                "instance_camera" => light::add_camera(target, name, file_from_node, a),
                other => a.warn(called(node), format!("{other} is not supported and was left out")),
            }
            // Joints place a skin by themselves.
            let is_skin = tag == "instance_controller" && child(target, "skin").is_some();
            if let Some(body) = body.filter(|_| !is_skin) {
                a.carry(body, before);
            }
        }
        Ok(())
    }

    /// Adds the parts of a geometry; `instance` binds its materials.
    fn geometry(
        &mut self,
        geometry: Node<'d>,
        instance: Node<'d>,
        name: &str,
        file_from_mesh: DAffine3,
        object: Option<ObjectId>,
        a: &mut Assembly,
    ) -> Result<(), ImportError> {
        let primitives = geometry::primitives(geometry, a);
        let object = object.unwrap_or_else(|| a.push_object(name, None));
        let several = primitives.len() > 1;
        for primitive in primitives {
            let symbol = primitive.attribute("material");
            let set = self.set(instance, symbol);
            let key = (primitive.id(), set.clone());
            let mesh = match self.meshes.get(&key) {
                Some(known) => *known,
                None => {
                    let (mesh, origin) = geometry::mesh(self.dae, primitive, set.as_deref(), a)?;
                    let file = a.file().to_path_buf();
                    let pushed = a.push_mesh_from(origin, mesh, &file, &called(geometry))?;
                    self.meshes.insert(key, pushed);
                    pushed
                }
            };
            let Some(mesh) = mesh else { continue };
            let material = self.materials.of(self.dae, instance, symbol, a)?;
            let part = if several { format!("{name}.{}", a.material_at(material).name) } else { name.to_string() };
            a.push_part_of(object, &part, mesh, material, file_from_mesh, PartLabel::NONE);
        }
        Ok(())
    }

    /// Adds what a controller moves: a skin as it was bound, a morph as its base.
    fn controller(
        &mut self,
        controller: Node<'d>,
        instance: Node<'d>,
        name: &str,
        file_from_node: DAffine3,
        object: ObjectId,
        a: &mut Assembly,
    ) -> Result<(), ImportError> {
        let skin = child(controller, "skin");
        let source = skin.or_else(|| child(controller, "morph")).and_then(|n| self.dae.target(n.attribute("source")?));
        let Some(source) = source.filter(|n| n.tag_name().name() == "geometry") else {
            a.warn(called(controller), "it moves no geometry of the file and was left out");
            return Ok(());
        };
        a.warn("library_controllers", "skins are in their bind pose, morphs are their base meshes");
        let bound =
            skin.and_then(|skin| child(skin, "bind_shape_matrix")).and_then(exactly::<16>).map_or(DAffine3::IDENTITY, |m| affine(&m));
        // Joints place a skin by themselves, whatever the position of its node.
        let placement = if skin.is_some() { bound } else { file_from_node };
        self.geometry(source, instance, name, placement, Some(object), a)
    }

    /// The set of texture coordinates that the instance binds to a material.
    fn set(&self, instance: Node<'d>, symbol: Option<&str>) -> Option<String> {
        let technique = at(instance, &["bind_material", "technique_common"])?;
        let material = children(technique, "instance_material").find(|m| m.attribute("symbol") == symbol)?;
        let is_uv = |b: &Node| b.attribute("input_semantic") == Some("TEXCOORD");
        children(material, "bind_vertex_input").find(is_uv)?.attribute("input_set").map(str::to_string)
    }
}

/// The body that a node is, if it moves by itself.
fn moving(node: Node, name: &str, transforms: &Transforms, within: &Within, a: &mut Assembly) -> Option<BodyId> {
    let moments = transforms.moments();
    if moments.is_empty() {
        return None;
    }
    let (local, told) = (|time_s, side| transforms.at(time_s, side), |time_s| format!("{time_s} s"));
    let node = Changing { place: &called(node), name, rest: transforms.rest(), moments, local: &local, told: &told };
    node.body((within.file_from_parent, within.body), a)
}
