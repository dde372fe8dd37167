//! Articulated objects in URDF: the visual meshes of their links, with all joints at rest.
//!
//! As <http://wiki.ros.org/urdf/XML> has it: `origin` is a translation `xyz` and the fixed-axis angles `rpy`, radians.

use super::super::assets::Models;
use super::super::vectors;
use crate::ImportError;
use crate::assembly::{Assembly, Piece};
use crate::xml::xml_text;
use enfilade_math::{DAffine3, DMat3, DVec3};
use roxmltree::{Document, Node};
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// An articulated object.
pub(super) struct Robot {
    /// Meshes of the object, in the space of the base link.
    pub pieces: Vec<Piece>,
    /// The frame of the base link's mass in the base link.
    pub inertial: DAffine3,
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
    let mut pieces = Vec::new();
    let (mut shapes, mut loose) = (0, 0);
    for link in &links {
        match stands.get(name_of(link)) {
            Some(base_from_link) => shapes += add_visuals(link, *base_from_link, file, models, &mut pieces, a)?,
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
    Ok(Robot { pieces, inertial })
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
