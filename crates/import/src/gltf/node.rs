//! The node tree: parts, cameras and lights with their placements.

use super::animation::Animations;
use super::container::Document;
use super::objects::{self, Objects};
use super::parts::{Parts, Stand};
use super::transform::placement;
use super::{instancing, label, light, profile};
use crate::ImportError;
use crate::assembly::{Assembly, FileLabel, TimedPoses};
use enfilade_math::DAffine3;
use enfilade_scene::{BodyId, ObjectId};
use gltf::json::scene::Node;

/// Aspect of a camera that does not state one: the default aspect of this workspace's pictures.
const DEFAULT_ASPECT: f64 = 4.0 / 3.0;

/// The extension that states whether a node is shown.
const VISIBILITY: &str = "KHR_node_visibility";

/// Indices of the nodes that a scene begins with: the default scene's, else the first one's, else all nodes without a parent.
pub(super) fn roots(document: &Document, assembly: &mut Assembly) -> Result<Vec<usize>, ImportError> {
    let root = &document.root;
    let wanted = root.scene.map(|s| s.value());
    if let Some(missing) = wanted.filter(|&s| s >= root.scenes.len()) {
        assembly.warn("scene", format!("the default scene {missing} does not exist; the first one was used"));
    }
    if let Some(scene) = wanted.and_then(|s| root.scenes.get(s)).or(root.scenes.first()) {
        if root.scenes.len() > 1 {
            assembly.warn("scenes", format!("{} scenes, of which one was imported", root.scenes.len()));
        }
        return Ok(scene.nodes.iter().map(|n| n.value()).collect());
    }
    let mut has_parent = vec![false; root.nodes.len()];
    for child in root.nodes.iter().flat_map(|n| n.children.iter().flatten()) {
        if let Some(flag) = has_parent.get_mut(child.value()) {
            *flag = true;
        }
    }
    Ok((0..root.nodes.len()).filter(|&i| !has_parent[i]).collect())
}

/// A node to visit, with what it inherits.
struct Visit {
    node: usize,
    file_from_parent: DAffine3,
    label: FileLabel,
    parent: Option<ObjectId>,
    /// The body that it belongs to.
    body: Option<BodyId>,
}

/// Walks the tree from `roots`, depth first in the order of the file, and adds all that the nodes carry.
///
/// # Errors
/// When a mesh or material cannot be read, or an index points at nothing.
pub(super) fn place(document: &Document, roots: &[usize], assembly: &mut Assembly) -> Result<(), ImportError> {
    let nodes = &document.root.nodes;
    let objects = Objects::new(document, assembly);
    let animations = Animations::new(document, assembly);
    let mut placer = Placer { document, parts: Parts::new(document, &animations) };
    let visit = |file_from_parent, label, parent, body| move |&node: &usize| Visit { node, file_from_parent, label, parent, body };
    let mut stack: Vec<Visit> = roots.iter().rev().map(visit(DAffine3::IDENTITY, FileLabel::NONE, None, None)).collect();
    let mut seen = vec![false; nodes.len()];
    let mut done = 0;
    while let Some(Visit { node: index, file_from_parent, label, parent, body }) = stack.pop() {
        let Some(node) = nodes.get(index) else {
            return Err(assembly.malformed("nodes", format!("there is a reference to node {index}, but there are only {}", nodes.len())));
        };
        if std::mem::replace(&mut seen[index], true) {
            assembly.warn(format!("nodes[{index}]"), "the node is reached twice (a cycle or a second parent); it was placed once");
            continue;
        }
        done += 1;
        assembly.progress(done, nodes.len());
        if is_invisible(node) {
            assembly.warn(format!("nodes[{index}]"), "the node is invisible (KHR_node_visibility); it was left out with all below it");
            continue;
        }
        let file_from_node = file_from_parent * document.local_transform(index);
        let object = objects.of(document, node, index, parent, assembly);
        let label = label::of(document, index, object, label, assembly);
        let own_label = label::of_parts(document, index, object, label, assembly);
        let body = moving(document, &animations, index, file_from_parent, assembly)
            .and_then(|(name, frame, states)| assembly.push_body(&name, body, frame, states).or_else(|| assembly.no_body(&name)))
            .or(body);
        let before = assembly.contents();
        placer.node((node, index, body), file_from_node, (object, parent), own_label, assembly)?;
        if let Some(body) = body.filter(|_| node.skin.is_none()) {
            assembly.carry(body, before);
        }
        let children: Vec<usize> = node.children.iter().flatten().map(|c| c.value()).collect();
        stack.extend(children.iter().rev().map(visit(file_from_node, label, object, body)));
    }
    placer.parts.finish(assembly);
    report_motion(document, assembly);
    Ok(())
}

/// The name of a node that moves, the frame of its motion in the file, and its states there.
fn moving(
    document: &Document,
    animations: &Animations,
    index: usize,
    file_from_parent: DAffine3,
    a: &mut Assembly,
) -> Option<(String, DAffine3, TimedPoses)> {
    let node = &document.root.nodes[index];
    let states = match animations.states(document, index) {
        Ok(states) => states?,
        Err(problem) => {
            a.warn(format!("nodes[{index}]"), format!("it is animated, but {problem}; it stays"));
            return None;
        }
    };
    if node.matrix.is_some() {
        a.warn(format!("nodes[{index}]"), "it is animated but placed by a matrix, which glTF does not allow; it stays");
        return None;
    }
    let rotation = node.rotation.as_ref().map_or([0.0, 0.0, 0.0, 1.0], |q| q.0);
    let parent_from_frame = placement(node.translation.unwrap_or([0.0; 3]), rotation, [1.0; 3]);
    Some((objects::name(document, node, index), file_from_parent * parent_from_frame, states))
}

/// Says what became of the animations of the file.
fn report_motion(document: &Document, a: &mut Assembly) {
    let count = document.root.animations.len();
    if count == 0 {
        return;
    }
    let message = match a.drop_unused_bodies() {
        0 => format!("{count} animations dropped; parts stay in the pose of their nodes"),
        bodies => format!("{bodies} things move by {count} animations (still = true leaves motion out)"),
    };
    a.warn("animations", message);
}

struct Placer<'d> {
    document: &'d Document,
    parts: Parts<'d>,
}

impl Placer<'_> {
    /// Adds the mesh, camera and light of a node, which belongs to a body. The arguments include its own object and its parent's: if its mesh
    /// is placed many times, each placement is an object.
    fn node(
        &mut self,
        (node, index, body): (&Node, usize, Option<BodyId>),
        file_from_node: DAffine3,
        (object, parent): (Option<ObjectId>, Option<ObjectId>),
        label: FileLabel,
        a: &mut Assembly,
    ) -> Result<(), ImportError> {
        let fallback = || format!("node_{index}");
        let name = node.name.clone().filter(|n| !n.trim().is_empty());
        if let Some(mesh) = node.mesh {
            let own = objects::name(self.document, node, index);
            let places = match node.extensions.as_ref().and_then(|e| e.others.get(instancing::NAME)) {
                Some(extension) => {
                    let places = instancing::places(self.document, extension, index, file_from_node, a)?;
                    places.into_iter().map(|place| (a.push_object(&own, parent), place)).collect()
                }
                None => vec![(object.unwrap_or_else(|| a.push_object(&own, parent)), file_from_node)],
            };
            self.parts.add(mesh.value(), &Stand { node, index, name: own, object, label, body }, &places, a)?;
        }
        if let Some(camera) = node.camera {
            let camera = self.document.root.cameras.get(camera.value());
            let name = name.clone().or_else(|| camera.and_then(|c| c.name.clone())).unwrap_or_else(fallback);
            match camera.and_then(|c| c.perspective.as_ref()) {
                None => a.warn(format!("nodes[{index}]"), format!("camera {name:?} is not perspective and was left out")),
                Some(p) => {
                    let aspect = p.aspect_ratio.map_or(DEFAULT_ASPECT, f64::from);
                    let mut fov_y = f64::from(p.yfov);
                    if fov_y >= std::f64::consts::PI {
                        let problem = format!("camera {name:?}: found {fov_y} as yfov, expected radians below 3.14; degrees were taken");
                        a.warn(format!("nodes[{index}]"), problem);
                        fov_y = fov_y.to_radians();
                    }
                    let fov_x = 2.0 * ((0.5 * fov_y).tan() * aspect).atan();
                    a.push_camera(&name, file_from_node, fov_x, aspect);
                }
            }
        }
        if let Some(light) = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref()) {
            light::add(self.document, light.light.value(), name.as_deref(), index, file_from_node, a);
        }
        if let Some(extras) = node.extensions.as_ref().map(|e| &e.others) {
            if let Some(instance) = extras.get("EXT_lights_ies") {
                profile::add(self.document, instance, name.as_deref(), index, file_from_node, a)?;
            }
            for extension in extras.keys().filter(|e| !["EXT_lights_ies", instancing::NAME, VISIBILITY].contains(&e.as_str())) {
                a.warn(format!("nodes[{index}]"), format!("extension {extension} ignored"));
            }
        }
        Ok(())
    }
}

/// True for nodes that are not to be shown.
fn is_invisible(node: &Node) -> bool {
    let visibility = node.extensions.as_ref().and_then(|e| e.others.get(VISIBILITY));
    visibility.and_then(|v| v.get("visible")).and_then(serde_json::Value::as_bool) == Some(false)
}
