//! The node tree: parts, lights and cameras with their placements.

use super::animation::{Animations, Motion};
use super::deform::{Clip, Deforming, is_bent, placement};
use super::light::{add_camera, add_light};
use super::material::{self, Materials};
use super::mesh;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_scene::{BodyId, ObjectId, PartLabel};
use std::collections::{HashMap, HashSet};
use ufbx::{ElementType, Node, Scene};

/// Adds all that the nodes carry, in the order of the tree.
///
/// # Errors
/// When a mesh cannot be used, or a texture is missing.
pub(super) fn place(scene: &Scene, (animations, clip): (&Animations, Option<&Clip>), a: &mut Assembly) -> Result<(), ImportError> {
    let hidden_layers = scene.display_layers.as_ref().iter().filter(|l| !l.visible);
    let hidden: HashSet<u32> = hidden_layers.flat_map(|l| l.nodes.as_ref().iter().map(|n| n.element.element_id)).collect();
    let mut placer = Placer { materials: Materials::default(), meshes: HashMap::new(), deforming: Vec::new() };
    let top = Above { visible: true, object: None, carrier: Carrier { body: None, stretches: false } };
    let mut stack: Vec<(&Node, Above)> = vec![(&scene.root_node, top)];
    let mut done = 0;
    while let Some((node, above)) = stack.pop() {
        done += 1;
        a.progress(done, scene.nodes.count);
        let follows = ufbx::find_prop(&node.element.props, "Visibility Inheritance").is_none_or(|p| p.value_int != 0);
        let visible = node.visible && !hidden.contains(&node.element.element_id) && (above.visible || !follows);
        let named = node.mesh.is_some() || !node.element.name.trim().is_empty();
        let object = if named { Some(a.push_object(&name(node), above.object)) } else { above.object };
        let carrier = carrier(node, animations, above.carrier, a);
        let before = a.contents();
        let deforms = clip.is_some() && (carrier.stretches || is_bent(node));
        placer.node(node, Own { object, visible, deforms }, a)?;
        if carrier.stretches && (node.light.is_some() || node.camera.is_some()) {
            a.warn(place_of(node), "it is in a node whose motion is not rigid, and stays");
        }
        // What deforms has all of its motion in its shapes.
        if let Some(body) = carrier.body.filter(|_| !deforms) {
            a.carry(body, before);
        }
        let levels = node.attrib_type == ElementType::LodGroup;
        if levels && node.children.count > 1 {
            a.warn(place_of(node), "only the first of its levels of detail was used");
        }
        let wanted = if levels { &node.children.as_ref()[..node.children.count.min(1)] } else { node.children.as_ref() };
        let above = Above { visible, object, carrier };
        stack.extend(wanted.iter().rev().map(|child| (child.as_ref(), above)));
    }
    if let Some(clip) = clip {
        clip.follow(&placer.deforming, a);
        report_motion(scene, a);
    }
    Ok(())
}

/// What nodes have from the one that they are in.
#[derive(Clone, Copy)]
struct Above {
    visible: bool,
    object: Option<ObjectId>,
    carrier: Carrier,
}

/// What moves a node.
#[derive(Clone, Copy)]
struct Carrier {
    body: Option<BodyId>,
    /// True if the motion of the node, or of one that it is in, is not rigid.
    stretches: bool,
}

/// What moves a node: itself, or what moves the one that it is in.
fn carrier(node: &Node, animations: &Animations, above: Carrier, a: &mut Assembly) -> Carrier {
    match animations.of(node) {
        Motion::Other => Carrier { stretches: true, ..above },
        Motion::Rigid(file_from_frame, states) if !above.stretches => {
            let name = name(node);
            let body = a.push_body(&name, above.body, file_from_frame, states).or_else(|| a.no_body(&name));
            Carrier { body: body.or(above.body), ..above }
        }
        Motion::Rigid(..) | Motion::Still => above,
    }
}

/// Says what became of the animation of the file.
fn report_motion(scene: &Scene, a: &mut Assembly) {
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
    /// Parts whose shape may change.
    deforming: Vec<Deforming>,
}

/// What a node is placed with.
#[derive(Clone, Copy)]
struct Own {
    object: Option<ObjectId>,
    visible: bool,
    /// True if its mesh may change its shape.
    deforms: bool,
}

impl Placer {
    fn node(&mut self, node: &Node, own: Own, a: &mut Assembly) -> Result<(), ImportError> {
        let (name, visible) = (name(node), own.visible);
        if let Some(mesh) = &node.mesh {
            if visible {
                self.mesh(node, mesh, own, &name, a)?;
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

    fn mesh(&mut self, node: &Node, mesh: &ufbx::Mesh, own: Own, name: &str, a: &mut Assembly) -> Result<(), ImportError> {
        let object = own.object.unwrap_or_else(|| a.push_object(name, None));
        report_dropped(node, mesh, own.deforms, a);
        let placement = placement(node);
        let origin = mesh::origin(mesh, a.meters_per_unit());
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
                    let of_part = mesh::of_part(mesh, part, set, origin);
                    let built = a.push_mesh_from(origin, of_part, &file, &place_of(node))?;
                    self.meshes.insert(key, built);
                    built
                }
            };
            if let Some(index) = index {
                let of_material = wanted.map_or("default".to_string(), material::name);
                let named = if filled > 1 { format!("{name}.{of_material}") } else { name.to_string() };
                let placed = a.push_part_of(object, &named, index, material, placement, PartLabel::NONE);
                self.deforming.extend(placed.filter(|_| own.deforms).map(|placed| Deforming {
                    node: node.element.typed_id,
                    mesh_part: part.index as usize,
                    uv_set: set,
                    origin,
                    file_from_mesh: placement,
                    part: placed,
                    place: place_of(node),
                }));
            }
        }
        Ok(())
    }
}

fn report_dropped(node: &Node, mesh: &ufbx::Mesh, deforms: bool, a: &mut Assembly) {
    let dropped = [
        (mesh.vertex_color.exists, "vertex colours dropped"),
        (mesh.num_line_faces + mesh.num_point_faces > 0, "points and lines have no surface and were left out"),
        (mesh.subdivision_render_levels > 0, "subdivision of the surface dropped; apply it before exporting"),
        (!deforms && !mesh.skin_deformers.is_empty(), "the skin was bent to one pose, and its bones were dropped"),
        (!deforms && !mesh.blend_deformers.is_empty(), "blend shapes were applied with the weights of rest, and dropped"),
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
