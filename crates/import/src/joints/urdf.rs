//! Joints of URDF: where they place the links, and how these move.

use super::elements::{child, children, name_of, origin, vector};
use super::graph::add_bodies;
use super::joint::{Joint, Kind, Link, Mimic};
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::{DAffine3, DVec3};
use roxmltree::Node;
use std::collections::{HashMap, HashSet};

/// The links of a robot that its roots lead to, and the joints between them.
pub(crate) struct Joints<'d> {
    pub joints: Vec<Joint>,
    /// Those around a link come before it; the first is the world.
    pub links: Vec<Link>,
    /// The number of a link among them, by its name.
    pub stands: HashMap<&'d str, usize>,
    /// The joint that moves a link, if any.
    pub movers: Vec<Option<usize>>,
}

impl<'d> Joints<'d> {
    /// Follows the joints from the links that hang on none.
    ///
    /// # Errors
    /// When a number is none.
    pub(crate) fn of(robot: Node<'d, '_>, links: &[Node<'d, '_>], a: &mut Assembly) -> Result<Self, ImportError> {
        let mut below: HashMap<&str, Vec<(&'d str, Node)>> = HashMap::new();
        let mut has_parent: HashSet<&str> = HashSet::new();
        let declared: HashSet<&str> = links.iter().map(|link| name_of(*link)).collect();
        // Joints whose parent no link of the file is: what they hold hangs on the world.
        let mut astray: Vec<(&'d str, Node)> = Vec::new();
        for joint in children(robot, "joint") {
            let link = |tag: &str| child(joint, tag).and_then(|n| n.attribute("link"));
            let (Some(parent), Some(child)) = (link("parent"), link("child")) else { continue };
            has_parent.insert(child);
            if declared.contains(parent) {
                below.entry(parent).or_default().push((child, joint));
                continue;
            }
            if parent != "world" {
                let message = format!("its parent {parent:?} is no link of the file; {child:?} hangs on the world in its place");
                a.warn(format!("joint {:?}", name_of(joint)), message);
            }
            astray.push((child, joint));
        }
        let world = Link { name: "world".into(), file_from_link: DAffine3::IDENTITY, jointed: false, mocap: false, body: None, parent: 0 };
        let mut all = Self { joints: Vec::new(), links: vec![world], stands: HashMap::new(), movers: vec![None] };
        let roots = links.iter().map(|link| name_of(*link)).filter(|name| !has_parent.contains(name));
        let mut stack: Vec<(&'d str, DAffine3, usize, Option<Node>)> = roots.map(|name| (name, DAffine3::IDENTITY, 0, None)).collect();
        for (child, joint) in astray {
            stack.push((child, origin(joint, a)?, 0, Some(joint)));
        }
        while let Some((name, file_from_link, parent, joint)) = stack.pop() {
            if all.stands.contains_key(name) {
                a.warn(format!("link {name:?}"), "several joints hold it; it hangs on one of them");
                continue;
            }
            let joint = joint.map(|joint| read(joint, file_from_link, a)).transpose()?.flatten();
            let own = all.links.len();
            all.stands.insert(name, own);
            all.movers.push(joint.is_some().then_some(all.joints.len()));
            all.links.push(Link { name: name.into(), file_from_link, jointed: joint.is_some(), mocap: false, body: None, parent });
            all.joints.extend(joint);
            for (child, joint) in below.get(name).into_iter().flatten() {
                stack.push((*child, file_from_link * origin(*joint, a)?, own, Some(*joint)));
            }
        }
        Ok(all)
    }

    /// The joints that move, from the root on, each before those that it bears: in the order of the file (depth first).
    pub(crate) fn depth_first(&self) -> Vec<usize> {
        let (mut order, mut stack) = (Vec::new(), vec![0]);
        while let Some(link) = stack.pop() {
            order.extend(self.movers[link]);
            // Links of one parent are listed from the last to the first, and the one that is pushed last comes next.
            stack.extend((1..self.links.len()).filter(|other| self.links[*other].parent == link));
        }
        order
    }

    /// Adds the bodies of the joints to the scene.
    pub(crate) fn push(&mut self, a: &mut Assembly) {
        add_bodies(&mut self.links, &mut self.joints, &self.movers, a);
    }
}

/// A joint that moves; `None` of fixed ones.
fn read(joint: Node, file_from_frame: DAffine3, a: &mut Assembly) -> Result<Option<Joint>, ImportError> {
    let name = name_of(joint).to_string();
    let kind = match joint.attribute("type").map(str::trim) {
        Some("revolute" | "continuous") => Kind::Hinge,
        Some("prismatic") => Kind::Slide,
        Some("floating") => return Ok(Some(Joint::free(&name, file_from_frame))),
        Some("planar") => {
            a.warn(format!("joint {name:?}"), "it is planar, and what it holds stays at rest");
            return Ok(None);
        }
        _ => return Ok(None),
    };
    let axis = child(joint, "axis").map(|axis| vector::<3>(axis, "xyz", a)).transpose()?.flatten().map_or(DVec3::X, DVec3::from_array);
    let Some(axis) = axis.try_normalize() else {
        a.warn(format!("joint {name:?}"), "its axis has no direction, and what it holds stays at rest");
        return Ok(None);
    };
    let limit = child(joint, "limit").filter(|_| joint.attribute("type").map(str::trim) != Some("continuous"));
    let end = |of: &str| limit.map(|limit| vector::<1>(limit, of, a)).transpose().map(|end| end.flatten().map_or(0.0, |[end]| end));
    let limits = Some([end("lower")?, end("upper")?]).filter(|[low, high]| limit.is_some() && low < high);
    if limits.is_none() && joint.attribute("type").map(str::trim) != Some("continuous") {
        a.warn(format!("joint {name:?}"), "it has no limits (lower below upper); it moves without end");
    }
    let number =
        |node: Node, of: &str, default: f64, a: &Assembly| Ok::<_, ImportError>(vector::<1>(node, of, a)?.map_or(default, |[v]| v));
    let mimic = match child(joint, "mimic").and_then(|mimic| Some((mimic, mimic.attribute("joint")?))) {
        Some((mimic, of)) => Some(Mimic {
            of: of.trim().to_string(),
            multiplier: number(mimic, "multiplier", 1.0, a)?,
            offset: number(mimic, "offset", 0.0, a)?,
        }),
        None => None,
    };
    Ok(Some(Joint { kind, axis, limits, mimic, ..Joint::free(&name, file_from_frame) }))
}
