//! Joints of SDF: bodies that move, with axis and limits.

use super::sdf_frames::{frame_in, own_pose, told_from};
use crate::ImportError;
use crate::assembly::Assembly;
use crate::joints::elements::{child, children, name_of};
use crate::joints::graph::{Edge, Piece, Trees};
use crate::joints::joint::{Joint, Kind, Mimic};
use crate::joints::states::{self, States, Tree};
use crate::vectors::numbers;
use enfilade_math::{DAffine3, DVec3};
use roxmltree::Node;
use std::collections::BTreeMap;

/// Limits at least so far out are none: SDF's default is 1e16.
const ENDLESS: f64 = 1e12;

/// Links and joints of a file, by their names with those of the models around them (`robot::arm`).
#[derive(Default)]
pub(super) struct Joints {
    pieces: Vec<Piece>,
    numbers: BTreeMap<String, usize>,
    /// With the model around each, in which its ends are named.
    edges: Vec<(String, Edge)>,
}

impl Joints {
    /// Adds a link whose contents are there.
    pub(super) fn link(&mut self, model: &str, piece: Piece) {
        self.numbers.entry(format!("{model}{}", piece.name)).or_insert(self.pieces.len());
        self.pieces.push(piece);
    }

    /// Adds the joints of a model whose links and models are there.
    ///
    /// # Errors
    /// When frames are told from each other in a circle.
    pub(super) fn of_model(&mut self, model: Node, path: &str, file_from_model: DAffine3, a: &mut Assembly) -> Result<(), ImportError> {
        let is_static = child(model, "static").and_then(|n| n.text()).is_some_and(|text| matches!(text.trim(), "true" | "1"));
        for joint in children(model, "joint").filter(|_| !is_static) {
            let place = format!("joint {:?}", name_of(joint));
            let ends = ["parent", "child"].map(|tag| child(joint, tag).and_then(|n| n.text()).map(str::trim).unwrap_or_default());
            let found =
                ends.map(|end| if end == "world" { Some(None) } else { self.numbers.get(&format!("{path}{end}")).copied().map(Some) });
            let ([Some(parent), Some(own)], Some(of)) = (found, found[1]) else {
                let missing = if found[0].is_none() { ends[0] } else { ends[1] };
                a.warn(place, format!("there is no link {missing:?} in its model; it was left out"));
                continue;
            };
            let file_from_child = of.map_or(DAffine3::IDENTITY, |own| self.pieces[own].file_from_link);
            let base = match told_from(joint) {
                Some(frame) => frame_in(model, frame, a)?.map_or(file_from_child, |model_from_frame| file_from_model * model_from_frame),
                None => file_from_child,
            };
            let file_from_frame = base * own_pose(joint, a);
            let (joint, is_fixed) = read(joint, model, (file_from_model, file_from_frame), a)?;
            self.edges.push((path.to_string(), Edge { joint, is_fixed, ends: [parent, own] }));
        }
        Ok(())
    }

    /// Adds the bodies to the scene, with the motion of the states.
    ///
    /// # Errors
    /// When the states cannot be read, or are of other joints.
    pub(super) fn add(self, a: &mut Assembly) -> Result<(), ImportError> {
        // Joints of several models may have one name, which the model's before it tells apart.
        let names: Vec<String> = self.edges.iter().map(|(_, edge)| edge.joint.name.clone()).collect();
        let full = |path: &str, name: &str| {
            if names.iter().filter(|other| *other == name).count() > 1 { format!("{path}{name}") } else { name.to_string() }
        };
        let renamed = |(path, mut edge): (String, Edge)| {
            edge.joint.name = full(&path, &edge.joint.name);
            if let Some(mimic) = &mut edge.joint.mimic {
                mimic.of = full(&path, &mimic.of);
            }
            edge
        };
        let (mut trees, left) = Trees::grown(&self.pieces, self.edges.into_iter().map(renamed).collect());
        for name in left {
            a.warn(
                format!("joint {name:?}"),
                "it closes a circle of links, which has no place among bodies that bear each other; it was left out",
            );
        }
        trees.add(&self.pieces, a);
        if let Some(states) = States::read(None, a)? {
            states::apply(&states, &Tree { joints: &trees.joints, links: &trees.links, ordered: false }, a)?;
        }
        a.drop_unused_bodies();
        Ok(())
    }
}

/// A joint, and whether it holds its links together.
fn read(
    joint: Node,
    model: Node,
    (file_from_model, file_from_frame): (DAffine3, DAffine3),
    a: &mut Assembly,
) -> Result<(Joint, bool), ImportError> {
    let name = name_of(joint).to_string();
    let stated = joint.attribute("type").map_or("", str::trim);
    let mut read = Joint { kind: Kind::Ball, ..Joint::free(&name, file_from_frame) };
    match stated {
        "revolute" | "continuous" => read.kind = Kind::Hinge,
        "prismatic" => read.kind = Kind::Slide,
        "ball" => return Ok((read, false)),
        "fixed" => return Ok((read, true)),
        other => {
            a.warn(
                format!("joint {name:?}"),
                format!("joints of the type {other:?} are not read; what it holds stays as it is in what bears it"),
            );
            return Ok((read, true));
        }
    }
    let axis = child(joint, "axis");
    let xyz = axis.and_then(|axis| child(axis, "xyz"));
    let Some(direction) = xyz.map_or(Some(DVec3::Z), |xyz| vector(xyz.text()?)).and_then(DVec3::try_normalize) else {
        a.warn(format!("joint {name:?}"), "its axis has no direction, and what it holds stays as it is in what bears it");
        return Ok((read, true));
    };
    read.axis = match axis_frame(joint, axis, xyz) {
        None => direction,
        Some(frame) => match frame_in(model, frame, a)? {
            Some(model_from_frame) => {
                let in_file = (file_from_model * model_from_frame).transform_vector3(direction);
                file_from_frame.inverse().transform_vector3(in_file).normalize_or(direction)
            }
            None => direction,
        },
    };
    if stated != "continuous" {
        read.limits = limits(&name, axis, a);
    }
    read.mimic = axis.and_then(|axis| child(axis, "mimic")).and_then(|mimic| {
        let number = |tag: &str, default: f64| child(mimic, tag).and_then(|n| n.text()?.trim().parse().ok()).unwrap_or(default);
        let (multiplier, offset) = (number("multiplier", 1.0), number("offset", 0.0));
        let offset = offset - multiplier * number("reference", 0.0);
        Some(Mimic { of: mimic.attribute("joint")?.trim().to_string(), multiplier, offset })
    });
    Ok((read, false))
}

/// The frame that the axis of a joint is told in, unless it is the joint's. Until version 1.4 of SDF it is the model's.
fn axis_frame<'d>(joint: Node<'d, '_>, axis: Option<Node<'d, '_>>, xyz: Option<Node<'d, '_>>) -> Option<&'d str> {
    let told = xyz.and_then(|xyz| xyz.attribute("expressed_in")).map(str::trim).filter(|frame| !frame.is_empty());
    let of_model = axis.and_then(|axis| child(axis, "use_parent_model_frame")).and_then(|n| n.text());
    let version = joint.document().root_element().attribute("version").and_then(|version| version.trim().parse::<f64>().ok());
    let is_old = version.is_some_and(|version| version < 1.45);
    told.or_else(|| (is_old || of_model.is_some_and(|text| matches!(text.trim(), "true" | "1"))).then_some("__model__"))
}

/// Least and greatest state, if it has both.
fn limits(name: &str, axis: Option<Node>, a: &mut Assembly) -> Option<[f64; 2]> {
    let limit = axis.and_then(|axis| child(axis, "limit"))?;
    let end = |tag: &str| child(limit, tag).and_then(|n| n.text()?.trim().parse::<f64>().ok()).filter(|end| end.abs() < ENDLESS);
    let [low, high] = [end("lower")?, end("upper")?];
    if low > high {
        a.warn(format!("joint {name:?}"), format!("its limits {low} to {high} descend; it moves without end"));
        return None;
    }
    Some([low, high])
}

fn vector(text: &str) -> Option<DVec3> {
    numbers(text).and_then(|v| <[f64; 3]>::try_from(v).ok()).map(DVec3::from_array)
}
