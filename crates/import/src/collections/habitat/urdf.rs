//! Articulated objects in URDF: the visual meshes of their links, and their joints as bodies.
//!
//! As <http://wiki.ros.org/urdf/XML> has it: `origin` is a translation `xyz` and the fixed-axis angles `rpy`, radians.

use super::super::assets::Models;
use crate::ImportError;
use crate::assembly::{Assembly, Piece};
use crate::joints::graph::add_bodies;
use crate::joints::joint::{Joint, Kind, Link};
use crate::joints::urdf::Joints;
use crate::vectors;
use crate::xml::xml_text;
use enfilade_math::{DAffine3, DMat3, DVec3};
use enfilade_scene::{BodyMotion, PartId};
use roxmltree::{Document, Node};
use serde_json::Value;
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// An articulated object.
pub(super) struct Robot {
    /// Meshes of the object, in the space of the base link.
    pub pieces: Vec<Piece>,
    /// The frame of the base link's mass in the base link.
    pub inertial: DAffine3,
    /// By piece: its link.
    link_of_pieces: Vec<usize>,
    links: Vec<Link>,
    joints: Vec<Joint>,
    /// The joint that moves each link, if any.
    movers: Vec<Option<usize>>,
    /// The joints in the order of their states: from the base on, depth first.
    order: Vec<usize>,
}

impl Robot {
    /// Adds the bodies of the joints of an object that was placed, with its parts by piece, in the states that its instance gives them.
    pub fn add_bodies(mut self, name: &str, file_from_base: DAffine3, parts: &[Option<PartId>], pose: Option<&Value>, a: &mut Assembly) {
        for joint in &mut self.joints {
            joint.file_from_frame = file_from_base * joint.file_from_frame;
        }
        self.links.iter_mut().for_each(|link| link.name = format!("{name}/{}", link.name));
        add_bodies(&mut self.links, &mut self.joints, &self.movers, a);
        for (part, link) in parts.iter().zip(&self.link_of_pieces) {
            if let (Some(part), Some(body)) = (part, self.links[*link].body) {
                a.carry_part(body, *part);
            }
        }
        a.sort_bodies();
        if let Some(pose) = pose {
            self.pose(name, pose, a);
        }
    }

    /// Puts the joints into the states of `initial_joint_pose`: a list of radians and metres.
    fn pose(&self, name: &str, pose: &Value, a: &mut Assembly) {
        let stated: Option<Vec<f64>> = pose.as_array().and_then(|list| list.iter().map(Value::as_f64).collect());
        let one_each = self.joints.iter().all(|joint| matches!(joint.kind, Kind::Hinge | Kind::Slide));
        let Some(stated) = stated.filter(|stated| stated.len() == self.joints.len() && one_each) else {
            let message = format!(
                "initial_joint_pose of {name:?} is {pose}, expected a list of {} numbers, one for each joint that moves; it is at rest",
                self.joints.len()
            );
            a.warn("articulated_object_instances", message);
            return;
        };
        for (number, value) in self.order.iter().zip(stated) {
            let joint = &self.joints[*number];
            if let Ok(states) = joint.states(&[&[value]]) {
                a.move_body(joint.body, joint.file_from_frame, BodyMotion { times_s: vec![0.0], states });
            }
        }
    }
}

/// Reads an articulated object.
///
/// # Errors
/// When the file is no URDF or a number in it is none.
pub(super) fn read(file: &Path, models: &mut Models, a: &mut Assembly) -> Result<Robot, ImportError> {
    let bytes = a.read_input(file, "the dataset lists it; copy or unpack it again")?;
    let text = xml_text(&bytes);
    let malformed = |problem: String| ImportError::malformed(file, "URDF", format!("{problem}; unpack the dataset again"));
    let document = Document::parse(&text).map_err(|e| malformed(e.to_string()))?;
    let robot = document.root_element();
    let links: Vec<Node> = robot.children().filter(|n| n.has_tag_name("link")).collect();
    let stands = base_from_link(&robot, &links).map_err(malformed)?;
    let tree = Joints::of(robot, &links, a).map_err(|e| malformed(e.to_string()))?;
    let (mut pieces, mut link_of_pieces) = (Vec::new(), Vec::new());
    let (mut shapes, mut loose) = (0, 0);
    for link in &links {
        match stands.get(name_of(link)) {
            Some(base_from_link) => {
                shapes += add_visuals(link, *base_from_link, file, models, &mut pieces, a)?;
                link_of_pieces.resize(pieces.len(), tree.stands.get(name_of(link)).copied().unwrap_or(0));
            }
            None => loose += 1,
        }
    }
    if shapes > 0 {
        a.warn("articulated objects", format!("{shapes} visual shapes of {} are no meshes and were left out", file.display()));
    }
    if loose > 0 {
        a.warn("articulated objects", format!("{loose} links of {} hang on themselves and were left out", file.display()));
    }
    let base = links.iter().find(|link| stands.get(name_of(link)) == Some(&DAffine3::IDENTITY));
    let inertial = base.and_then(|base| child(base, "inertial")).map_or(Ok(DAffine3::IDENTITY), |i| origin(&i)).map_err(malformed)?;
    let order = tree.depth_first();
    let Joints { joints, links, movers, .. } = tree;
    Ok(Robot { pieces, inertial, link_of_pieces, links, joints, movers, order })
}

/// Adds the visual meshes of a link, and returns how many visual shapes it has that are none.
fn add_visuals(
    link: &Node,
    base_from_link: DAffine3,
    file: &Path,
    models: &mut Models,
    pieces: &mut Vec<Piece>,
    a: &mut Assembly,
) -> Result<usize, ImportError> {
    let malformed = |problem: String| ImportError::malformed(file, "URDF", format!("{problem}; unpack the dataset again"));
    let mut shapes = 0;
    for visual in link.children().filter(|n| n.has_tag_name("visual")) {
        let Some(mesh) = child(&visual, "geometry").and_then(|g| child(&g, "mesh")) else {
            shapes += 1;
            continue;
        };
        let place = base_from_link * origin(&visual).map_err(malformed)?;
        let scale = numbers(&mesh, "scale").map_err(malformed)?.unwrap_or(DVec3::ONE);
        let named = mesh.attribute("filename").unwrap_or_default();
        let named = named.strip_prefix("package://").or_else(|| named.strip_prefix("file://")).unwrap_or(named);
        let model = models.get(&file.parent().unwrap_or(Path::new("")).join(named), a)?;
        for piece in model.iter().flat_map(|model| &model.pieces) {
            let model_from_mesh = place * DAffine3::from_scale(scale) * piece.model_from_mesh;
            pieces.push(Piece { name: format!("{}.{}", name_of(link), piece.name), model_from_mesh, ..piece.clone() });
        }
    }
    Ok(shapes)
}

/// The pose of each link, by its name; links that no root leads to are left out.
fn base_from_link(robot: &Node, links: &[Node]) -> Result<HashMap<String, DAffine3>, String> {
    let mut joints: HashMap<&str, Vec<(&str, DAffine3)>> = HashMap::new();
    let mut has_parent: HashSet<&str> = HashSet::new();
    for joint in robot.children().filter(|n| n.has_tag_name("joint")) {
        let link = |tag: &str| child(&joint, tag).and_then(|n| n.attribute("link"));
        let (Some(parent), Some(below)) = (link("parent"), link("child")) else { continue };
        joints.entry(parent).or_default().push((below, origin(&joint)?));
        has_parent.insert(below);
    }
    let mut stands = HashMap::new();
    let roots = links.iter().map(name_of).filter(|name| !has_parent.contains(name));
    let mut stack: Vec<(&str, DAffine3)> = roots.map(|name| (name, DAffine3::IDENTITY)).collect();
    while let Some((name, place)) = stack.pop() {
        if stands.insert(name.to_string(), place).is_none() {
            stack.extend(joints.get(name).into_iter().flatten().map(|(below, joint)| (*below, place * *joint)));
        }
    }
    Ok(stands)
}

fn name_of<'d>(node: &Node<'d, '_>) -> &'d str {
    node.attribute("name").unwrap_or_default()
}

fn child<'a, 'd>(node: &Node<'a, 'd>, tag: &str) -> Option<Node<'a, 'd>> {
    node.children().find(|n| n.has_tag_name(tag))
}

/// The placement in the element `origin` within a node.
fn origin(node: &Node) -> Result<DAffine3, String> {
    let Some(origin) = child(node, "origin") else { return Ok(DAffine3::IDENTITY) };
    let (xyz, rpy) = (numbers(&origin, "xyz")?.unwrap_or(DVec3::ZERO), numbers(&origin, "rpy")?.unwrap_or(DVec3::ZERO));
    let turn = DMat3::from_rotation_z(rpy.z) * DMat3::from_rotation_y(rpy.y) * DMat3::from_rotation_x(rpy.x);
    Ok(DAffine3::from_mat3_translation(turn, xyz))
}

fn numbers(node: &Node, attribute: &str) -> Result<Option<DVec3>, String> {
    let Some(text) = node.attribute(attribute) else { return Ok(None) };
    match vectors::numbers(text).as_deref() {
        Some(&[x, y, z]) => Ok(Some(DVec3::new(x, y, z))),
        // For a scale, one number applies to all axes.
        Some(&[all]) if attribute == "scale" => Ok(Some(DVec3::splat(all))),
        _ => Err(format!("found {text:?} as {attribute} of <{}>, expected three numbers", node.tag_name().name())),
    }
}
