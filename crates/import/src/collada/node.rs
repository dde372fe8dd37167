//! The nodes of the visual scene: transforms, and what they place.

use super::document::{Dae, Node, at, called, child, children, exactly};
use super::material::Materials;
use super::{geometry, light};
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::{DAffine3, DMat3, DMat4, DVec3};
use enfilade_scene::{ObjectId, PartLabel};
use std::collections::HashMap;

/// Nodes within nodes deeper than this are taken for a cycle.
const MAX_DEPTH: usize = 64;
/// More visits than this are taken for a mistake: instances of instances multiply.
const MAX_VISITS: usize = 1_000_000;

/// Places all that the scene shows.
pub(super) fn place_scene(dae: &Dae, a: &mut Assembly) -> Result<(), ImportError> {
    let named = at(dae.root, &["scene", "instance_visual_scene"]).and_then(|i| dae.target(i.attribute("url")?));
    let first = || at(dae.root, &["library_visual_scenes", "visual_scene"]);
    let mut placer = Placer { dae, materials: Materials::new(dae), meshes: HashMap::new(), visits: 0 };
    match named.filter(|n| n.tag_name().name() == "visual_scene").or_else(first) {
        Some(scene) => {
            let nodes: Vec<Node> = children(scene, "node").collect();
            for (i, node) in nodes.iter().enumerate() {
                a.progress(i + 1, nodes.len());
                placer.node(*node, DAffine3::IDENTITY, None, 0, a)?;
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
    Ok(())
}

struct Placer<'p, 'd> {
    dae: &'p Dae<'d>,
    materials: Materials,
    /// By primitive and the set of its texture coordinates; `None` for those without faces.
    meshes: HashMap<(roxmltree::NodeId, Option<String>), Option<u32>>,
    visits: usize,
}

impl<'d> Placer<'_, 'd> {
    fn node(
        &mut self,
        node: Node<'d>,
        file_from_parent: DAffine3,
        parent: Option<ObjectId>,
        depth: usize,
        a: &mut Assembly,
    ) -> Result<(), ImportError> {
        self.visits += 1;
        if depth > MAX_DEPTH || self.visits > MAX_VISITS {
            return Err(a.malformed(
                called(node),
                format!("nodes are nested more than {MAX_DEPTH} deep, or more than {MAX_VISITS}; check its instances"),
            ));
        }
        let name = node.attribute("name").or(node.attribute("id")).filter(|n| !n.trim().is_empty()).unwrap_or("node");
        let file_from_node = file_from_parent * transform(node, a)?;
        let object = a.push_object(name, parent);
        for child_node in node.children().filter(roxmltree::Node::is_element) {
            let url = child_node.attribute("url").unwrap_or_default();
            let tag = child_node.tag_name().name();
            if tag == "node" {
                self.node(child_node, file_from_node, Some(object), depth + 1, a)?;
            }
            if !tag.starts_with("instance_") {
                continue;
            }
            let Some(target) = self.dae.target(url) else {
                a.warn(called(node), format!("it refers to {url:?}, which is not in the file; export the scene with all of it"));
                continue;
            };
            match tag {
                "instance_node" => self.node(target, file_from_node, Some(object), depth + 1, a)?,
                "instance_geometry" => self.geometry(target, child_node, name, file_from_node, Some(object), a)?,
                "instance_controller" => self.controller(target, child_node, name, file_from_node, object, a)?,
                "instance_light" => light::add_light(self.dae, target, name, file_from_node, a),
                "instance_camera" => light::add_camera(target, name, file_from_node, a),
                other => a.warn(called(node), format!("{other} is not supported and was left out")),
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
        let bound = skin.and_then(|skin| child(skin, "bind_shape_matrix")).and_then(exactly::<16>).map_or(DAffine3::IDENTITY, affine);
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

/// Sixteen numbers row by row as a placement; the last row is not used.
fn affine(m: [f64; 16]) -> DAffine3 {
    let m = DMat4::from_cols_array(&m).transpose();
    DAffine3::from_mat4(m)
}

/// The product of a node's transforms, in their order.
fn transform(node: Node, a: &Assembly) -> Result<DAffine3, ImportError> {
    let mut whole = DAffine3::IDENTITY;
    for element in node.children().filter(roxmltree::Node::is_element) {
        let tag = element.tag_name().name();
        let next = match tag {
            "matrix" => exactly::<16>(element).map(affine),
            "translate" => exactly::<3>(element).map(|v| DAffine3::from_translation(v.into())),
            "scale" => exactly::<3>(element).map(|v| DAffine3::from_scale(v.into())),
            "rotate" => exactly::<4>(element).map(|[x, y, z, degrees]| {
                let axis = DVec3::new(x, y, z).try_normalize();
                axis.map_or(DAffine3::IDENTITY, |axis| DAffine3::from_axis_angle(axis, degrees.to_radians()))
            }),
            "lookat" => exactly::<9>(element).and_then(looking),
            "skew" => exactly::<7>(element).and_then(skewed),
            _ => continue,
        };
        let problem =
            || format!("found a <{tag}> that is no transform; expected as many finite numbers as COLLADA has; export the file again");
        whole *= next.ok_or_else(|| a.malformed(called(node), problem()))?;
    }
    Ok(whole)
}

/// A place from which −z looks at another, by eye, target and up.
fn looking(v: [f64; 9]) -> Option<DAffine3> {
    let [eye, target, up] = [0, 3, 6].map(|i| DVec3::new(v[i], v[i + 1], v[i + 2]));
    let axes = crate::assembly::orthonormal(up, eye - target)?;
    Some(DAffine3::from_mat3_translation(axes, eye))
}

/// RenderMan's skew: by an angle in degrees, the axis `from` is turned towards `to`.
fn skewed(v: [f64; 7]) -> Option<DAffine3> {
    let [angle, rest @ ..] = v;
    let (from, to) = (DVec3::new(rest[0], rest[1], rest[2]).try_normalize()?, DVec3::new(rest[3], rest[4], rest[5]).try_normalize()?);
    // The component of `from` at a right angle to `to`.
    let across = (from - to * from.dot(to)).try_normalize()?;
    let (along, over) = (from.dot(to), from.dot(across));
    let turned = (along.atan2(over) + angle.to_radians()).tan();
    let shear = turned - along / over;
    let outer = |column: f64| to * (shear * column);
    Some(DAffine3::from_mat3(DMat3::IDENTITY + DMat3::from_cols(outer(across.x), outer(across.y), outer(across.z))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn skew_keeps_what_lies_along_the_axis_it_turns_to() {
        // 45° from y towards x: (0, 1, 0) becomes (1, 1, 0).
        let m = skewed([45.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0]).unwrap();
        assert!((m.transform_point3(DVec3::Y) - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-12);
        assert!((m.transform_point3(DVec3::X) - DVec3::X).length() < 1e-12 && (m.transform_point3(DVec3::Z) - DVec3::Z).length() < 1e-12);
    }

    #[test]
    fn a_view_looks_from_its_eye_at_its_target() {
        let m = looking([1.0, 2.0, 3.0, 1.0, 2.0, 0.0, 0.0, 1.0, 0.0]).unwrap();
        assert_eq!(
            (m.translation, m.transform_vector3(DVec3::NEG_Z), m.transform_vector3(DVec3::Y)),
            (DVec3::new(1.0, 2.0, 3.0), DVec3::NEG_Z, DVec3::Y)
        );
    }
}
