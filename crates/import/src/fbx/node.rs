//! The node tree: parts, lights and cameras with their placements.

use super::animation::Animations;
use super::light::{add_camera, add_light};
use super::material::{self, Materials};
use super::matrix::affine;
use super::mesh;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::DAffine3;
use enfilade_scene::{BodyId, ObjectId, PartLabel};
use std::collections::{HashMap, HashSet};
use ufbx::{ElementType, Node, Scene};

/// Adds all that the nodes carry, in the order of the tree.
///
/// # Errors
/// When a mesh cannot be used, or a texture is missing.
pub(super) fn place(scene: &Scene, animations: &Animations, a: &mut Assembly) -> Result<(), ImportError> {
    let hidden_layers = scene.display_layers.as_ref().iter().filter(|l| !l.visible);
    let hidden: HashSet<u32> = hidden_layers.flat_map(|l| l.nodes.as_ref().iter().map(|n| n.element.element_id)).collect();
    let mut placer = Placer { materials: Materials::default(), meshes: HashMap::new() };
    let mut stack: Vec<(&Node, bool, Option<ObjectId>, Option<BodyId>)> = vec![(&scene.root_node, true, None, None)];
    let mut done = 0;
    while let Some((node, inherited, parent, bearer)) = stack.pop() {
        done += 1;
        a.progress(done, scene.nodes.count);
        let follows = ufbx::find_prop(&node.element.props, "Visibility Inheritance").is_none_or(|p| p.value_int != 0);
        let visible = node.visible && !hidden.contains(&node.element.element_id) && (inherited || !follows);
        let named = node.mesh.is_some() || !node.element.name.trim().is_empty();
        let object = if named { Some(a.push_object(&name(node), parent)) } else { parent };
        let body = body(node, animations, bearer, a);
        let before = a.contents();
        placer.node(node, object, visible, a)?;
        // Bent meshes follow their bones.
        if let Some(body) = body.filter(|_| !is_bent(node)) {
            a.carry(body, before);
        }
        let levels = node.attrib_type == ElementType::LodGroup;
        if levels && node.children.count > 1 {
            a.warn(place_of(node), "only the first of its levels of detail was used");
        }
        let wanted = if levels { &node.children.as_ref()[..node.children.count.min(1)] } else { node.children.as_ref() };
        stack.extend(wanted.iter().rev().map(|child| (child.as_ref(), visible, object, body)));
    }
    report_motion(scene, animations, a);
    Ok(())
}

/// The body that a node is, if it moves by itself, else the one that bears it.
fn body(node: &Node, animations: &Animations, bearer: Option<BodyId>, a: &mut Assembly) -> Option<BodyId> {
    match animations.of(node) {
        None => bearer,
        Some(Ok((file_from_frame, states))) => a.push_body(&name(node), bearer, file_from_frame, states).or(bearer),
        Some(Err(problem)) => {
            a.warn(place_of(node), format!("it is animated, but {problem}; it stays"));
            bearer
        }
    }
}

/// True if bones bend the node's mesh.
pub(super) fn is_bent(node: &Node) -> bool {
    node.mesh.as_ref().is_some_and(|mesh| !mesh.skin_deformers.is_empty())
}

/// Says what became of the animation of the file.
fn report_motion(scene: &Scene, animations: &Animations, a: &mut Assembly) {
    if animations.is_empty() {
        return;
    }
    let message = match a.drop_unused_bodies() {
        0 => "nothing that is seen moves by it; parts stay in the pose of its first moment".into(),
        bodies => format!("{bodies} things move by the first animation (still = true leaves motion out)"),
    };
    let others = scene.anim_stacks.count.saturating_sub(1);
    let more = if others > 0 { format!("; {others} more were dropped") } else { String::new() };
    a.warn("animations", message + &more);
}

struct Placer {
    materials: Materials,
    /// Scene mesh of (mesh, part, set of texture coordinates); `None` for those without a surface.
    meshes: HashMap<(u32, usize, usize), Option<u32>>,
}

impl Placer {
    fn node(&mut self, node: &Node, object: Option<ObjectId>, visible: bool, a: &mut Assembly) -> Result<(), ImportError> {
        let name = name(node);
        if let Some(mesh) = &node.mesh {
            if visible {
                self.mesh(node, mesh, object, &name, a)?;
            } else {
                a.warn(place_of(node), "hidden, and left out");
            }
        }
        // Files of version 6 store the views of the program that wrote them as cameras.
        let is_view = node.element.scene.metadata.version < 7000 && name.starts_with("Producer ");
        if let Some(camera) = node.camera.as_ref().filter(|_| !is_view) {
            add_camera(node, camera, &name, a);
        }
        if let Some(light) = &node.light {
            if visible {
                add_light(node, light, &name, a);
            } else {
                a.warn(place_of(node), "the light is hidden, and was left out");
            }
        }
        let surface = matches!(
            node.attrib_type,
            ElementType::NurbsSurface | ElementType::NurbsTrimSurface | ElementType::LineCurve | ElementType::ProceduralGeometry
        );
        if surface {
            a.warn(
                place_of(node),
                format!("{:?} is not supported and was left out; convert it to a mesh and export again", node.attrib_type),
            );
        }
        Ok(())
    }

    fn mesh(&mut self, node: &Node, mesh: &ufbx::Mesh, object: Option<ObjectId>, name: &str, a: &mut Assembly) -> Result<(), ImportError> {
        let object = object.unwrap_or_else(|| a.push_object(name, None));
        report_dropped(node, mesh, a);
        // Skinned meshes may be in world space already.
        let placement = if mesh.skinned_is_local { affine(&node.geometry_to_world) } else { DAffine3::IDENTITY };
        let materials = if node.materials.is_empty() { mesh.materials.as_ref() } else { node.materials.as_ref() };
        let filled = mesh.material_parts.iter().filter(|p| p.num_triangles > 0).count();
        if filled == 0 {
            a.warn(place_of(node), "the mesh has no faces and was left out");
        }
        for part in mesh.material_parts.iter().filter(|p| p.num_triangles > 0) {
            let wanted = materials.get(part.index as usize).map(AsRef::as_ref);
            let material = self.materials.get(wanted, a)?;
            let set = wanted.map_or("", |m| material::uv_set(m, a));
            let set = mesh.uv_sets.iter().position(|s| &*s.name == set).unwrap_or(0);
            let key = (mesh.element.element_id, part.index as usize, set);
            let index = match self.meshes.get(&key) {
                Some(&known) => known,
                None => {
                    let file = a.file().to_path_buf();
                    let (of_part, origin) = mesh::of_part(mesh, part, set, a.meters_per_unit());
                    let built = a.push_mesh_from(origin, of_part, &file, &place_of(node))?;
                    self.meshes.insert(key, built);
                    built
                }
            };
            if let Some(index) = index {
                let own = wanted.map_or("default".to_string(), material::name);
                let part = if filled > 1 { format!("{name}.{own}") } else { name.to_string() };
                a.push_part_of(object, &part, index, material, placement, PartLabel::NONE);
            }
        }
        Ok(())
    }
}

fn report_dropped(node: &Node, mesh: &ufbx::Mesh, a: &mut Assembly) {
    let dropped = [
        (mesh.vertex_color.exists, "vertex colours dropped"),
        (mesh.num_line_faces + mesh.num_point_faces > 0, "points and lines have no surface and were left out"),
        (mesh.subdivision_render_levels > 0, "subdivision of the surface dropped; apply it before exporting"),
        (!mesh.skin_deformers.is_empty(), "the skin was bent to one pose, and its bones were dropped"),
        (!mesh.blend_deformers.is_empty(), "blend shapes were applied with the weights of one moment, and dropped"),
        (!mesh.cache_deformers.is_empty(), "the cache of positions was dropped; the mesh keeps its base shape"),
    ];
    for (_, what) in dropped.into_iter().filter(|(found, _)| *found) {
        a.warn(place_of(node), what);
    }
}

/// The node's name, else its mesh's, light's or camera's, else a stable one.
fn name(node: &Node) -> String {
    let attribute = node.attrib.as_ref().map(|e| e.name.to_string());
    let names = [Some(node.element.name.to_string()), attribute];
    let named = names.into_iter().flatten().find(|n| !n.trim().is_empty());
    named.unwrap_or_else(|| format!("node_{}", node.element.typed_id))
}

fn place_of(node: &Node) -> String {
    format!("node {:?}", name(node))
}
