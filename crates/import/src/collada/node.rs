//! The nodes of the visual scene: transforms, and what they place.

use super::animation::Animations;
use super::deform::{self, Deform};
use super::document::{Dae, Node, at, called, children};
use super::material::Materials;
use super::transform::Transforms;
use super::{geometry, light};
use crate::ImportError;
use crate::assembly::Assembly;
use crate::motion::{Changing, Moved};
use enfilade_geometry::Mesh;
use enfilade_math::DAffine3;
use enfilade_scene::{BodyId, ObjectId, PartLabel, Shape};
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
                placer.node(*node, &Within::default(), a)?;
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
#[derive(Default)]
struct Within<'d> {
    file_from_parent: DAffine3,
    object: Option<ObjectId>,
    /// The body that bears it.
    body: Option<BodyId>,
    /// The nodes, from the outermost on.
    chain: Vec<Node<'d>>,
    /// Whether one of them changes its scale or shear, so that what is in it deforms.
    is_stretched: bool,
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
    fn node(&mut self, node: Node<'d>, within: &Within<'d>, a: &mut Assembly) -> Result<(), ImportError> {
        self.visits += 1;
        if within.chain.len() > MAX_DEPTH || self.visits > MAX_VISITS {
            return Err(a.malformed(
                called(node),
                format!("nodes are nested more than {MAX_DEPTH} deep, or more than {MAX_VISITS}; check its instances"),
            ));
        }
        let name = node.attribute("name").or(node.attribute("id")).filter(|n| !n.trim().is_empty()).unwrap_or("node");
        let transforms = Transforms::of(node, self.animations, a)?;
        let file_from_node = within.file_from_parent * transforms.rest();
        let object = a.push_object(name, within.object);
        let Moved { body, problem } = moving(node, name, &transforms, within, a);
        let is_stretched = within.is_stretched || problem.is_some();
        let body = body.or(within.body).filter(|_| !is_stretched);
        let chain = [&within.chain[..], &[node]].concat();
        let inner = Within { file_from_parent: file_from_node, object: Some(object), body, chain, is_stretched };
        for child_node in node.children().filter(roxmltree::Node::is_element) {
            let url = child_node.attribute("url").unwrap_or_default();
            let tag = child_node.tag_name().name();
            if tag == "node" {
                self.node(child_node, &inner, a)?;
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
                    self.node(target, &inner, a)?;
                    continue;
                }
                "instance_geometry" if is_stretched => {
                    let deform = Deform::of_nodes(&inner.chain, self.animations, a)?;
                    self.deformed((target, child_node), name, &deform, &inner, a)?;
                }
                "instance_geometry" => self.geometry(target, child_node, name, file_from_node, Some(object), a)?,
                "instance_controller" => self.controller(target, child_node, name, &inner, a)?,
                "instance_light" => light::add_light(self.dae, target, name, file_from_node, a),
                "instance_camera" => light::add_camera(target, name, file_from_node, a),
                other => a.warn(called(node), format!("{other} is not supported and was left out")),
            }
            if is_stretched && matches!(tag, "instance_light" | "instance_camera") {
                a.warn(
                    called(node),
                    "its scale or shear changes, which lights and cameras do not follow; they stay where they are at rest",
                );
            }
            // Joints place a skin by themselves.
            let is_skin = tag == "instance_controller" && deform::skin_of(target).is_some();
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
                    let made = geometry::mesh(self.dae, primitive, set.as_deref(), a)?;
                    let file = a.file().to_path_buf();
                    let pushed = a.push_mesh_from(made.origin, made.mesh, &file, &called(geometry))?;
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

    /// Adds what a controller moves: in the pose of its joints and with its weights, or where these make no sense as it was bound.
    fn controller(
        &mut self,
        controller: Node<'d>,
        instance: Node<'d>,
        name: &str,
        within: &Within<'d>,
        a: &mut Assembly,
    ) -> Result<(), ImportError> {
        let Some(source) = deform::source(self.dae, controller) else {
            a.warn(called(controller), "it moves no geometry of the file and was left out");
            return Ok(());
        };
        let deform = match Deform::read(self.dae, controller, instance, self.animations, a)? {
            Ok(deform) => deform,
            Err(problem) => {
                deform::stays(controller, &problem, a);
                // Joints place a skin by themselves, whatever the position of its node.
                let placement = deform::skin_of(controller).map_or(within.file_from_parent, deform::bind_shape);
                return self.geometry(source, instance, name, placement, within.object, a);
            }
        };
        let deform = if within.is_stretched { deform.within(&within.chain, self.animations, a)? } else { deform };
        self.deformed((source, instance), name, &deform, within, a)
    }

    /// Adds the parts of a geometry whose shape may change; `instance` binds its materials.
    fn deformed(
        &mut self,
        (geometry, instance): (Node<'d>, Node<'d>),
        name: &str,
        deform: &Deform,
        within: &Within<'d>,
        a: &mut Assembly,
    ) -> Result<(), ImportError> {
        let placement = if deform.has_joints() { DAffine3::IDENTITY } else { within.file_from_parent };
        let bearer = within.body.filter(|_| !deform.has_joints());
        let object = within.object.unwrap_or_else(|| a.push_object(name, None));
        let primitives = geometry::primitives(geometry, a);
        let several = primitives.len() > 1;
        for primitive in primitives {
            let symbol = primitive.attribute("material");
            let made = geometry::mesh(self.dae, primitive, self.set(instance, symbol).as_deref(), a)?;
            let Shape { positions, normals } = deform.shape(&made, None);
            let mesh = Mesh { positions, normals, triangles: deform.triangles(&made.mesh), ..made.mesh.clone() };
            let file = a.file().to_path_buf();
            let Some(mesh) = a.push_mesh_from(made.origin, mesh, &file, &called(geometry))? else { continue };
            let material = self.materials.of(self.dae, instance, symbol, a)?;
            let part = if several { format!("{name}.{}", a.material_at(material).name) } else { name.to_string() };
            let placed = a.push_part_of(object, &part, mesh, material, placement, PartLabel::NONE);
            let timed = deform.timed(&made, (&placement, &called(instance)), a);
            if let (Some(placed), Some(timed)) = (placed, timed) {
                a.deform(placed, bearer, timed);
            }
        }
        Ok(())
    }

    /// The set of texture coordinates that the instance binds to a material.
    fn set(&self, instance: Node<'d>, symbol: Option<&str>) -> Option<String> {
        let technique = at(instance, &["bind_material", "technique_common"])?;
        let material = children(technique, "instance_material").find(|m| m.attribute("symbol") == symbol)?;
        let is_uv = |b: &Node| b.attribute("input_semantic") == Some("TEXCOORD");
        children(material, "bind_vertex_input").find(is_uv)?.attribute("input_set").map(str::to_string)
    }
}

/// The body that a node is, if it moves by itself, and why that is not all of its motion.
fn moving(node: Node, name: &str, transforms: &Transforms, within: &Within, a: &mut Assembly) -> Moved {
    let moments = transforms.moments();
    if moments.is_empty() {
        return Moved { body: None, problem: None };
    }
    let (local, told) = (|time_s, side| transforms.at(time_s, side), |time_s| format!("{time_s} s"));
    let node = Changing { place: &called(node), name, rest: transforms.rest(), moments, local: &local, told: &told };
    node.moved((within.file_from_parent, within.body), a)
}
