//! Frames of SDF: poses may be told from another frame of their model by its name, <http://sdformat.org/tutorials?tut=pose_frame_semantics>.

use crate::ImportError;
use crate::assembly::Assembly;
use crate::joints::elements::{child, name_of, pose};
use crate::vectors::numbers;
use enfilade_math::{DAffine3, DVec3};
use roxmltree::Node;

/// Frames told from each other deeper than this are taken for a circle.
const MAX_DEPTH: usize = 64;

/// The pose in an element, in the frame that it is told from.
pub(super) fn own_pose(element: Node, a: &mut Assembly) -> DAffine3 {
    let Some(node) = child(element, "pose") else { return DAffine3::IDENTITY };
    let degrees = node.attribute("degrees").is_some_and(|v| matches!(v.trim(), "true" | "1"));
    let text = node.text().unwrap_or_default();
    match numbers(text).as_deref() {
        Some(&[x, y, z, roll, pitch, yaw]) => {
            let angles = DVec3::new(roll, pitch, yaw) * if degrees { std::f64::consts::PI / 180.0 } else { 1.0 };
            pose(DVec3::new(x, y, z), angles)
        }
        None if text.trim().is_empty() => DAffine3::IDENTITY,
        _ => {
            a.warn("pose", format!("found {:?} as the pose of {:?}, expected six numbers; it was not used", text.trim(), name_of(element)));
            DAffine3::IDENTITY
        }
    }
}

/// The frame that the pose of an element is told from, if it names one.
pub(super) fn told_from<'d>(element: Node<'d, '_>) -> Option<&'d str> {
    let node = child(element, "pose")?;
    node.attribute("relative_to").or(node.attribute("frame")).map(str::trim).filter(|frame| !frame.is_empty())
}

/// The pose of an element of a scope (a model or world) in that scope.
///
/// # Errors
/// When frames are told from each other in a circle.
pub(super) fn pose_in(scope: Node, element: Node, a: &mut Assembly) -> Result<DAffine3, ImportError> {
    Frames { scope }.of(element, 0, a)
}

/// The pose of the frame `name` in a scope; `None`, with a warning, if there is none.
///
/// # Errors
/// As [`pose_in`].
pub(super) fn frame_in(scope: Node, name: &str, a: &mut Assembly) -> Result<Option<DAffine3>, ImportError> {
    Frames { scope }.named(name, 0, a)
}

/// The frames of a model or world.
struct Frames<'n, 'd> {
    scope: Node<'n, 'd>,
}

impl Frames<'_, '_> {
    /// The pose of an element in the scope.
    fn of(&self, element: Node, depth: usize, a: &mut Assembly) -> Result<DAffine3, ImportError> {
        if depth > MAX_DEPTH {
            let at = element.document().text_pos_at(element.range().start);
            return Err(a.malformed(
                format!("line {}", at.row),
                format!(
                    "the pose of {:?} is told from frames that are told from each other in a circle; take out one relative_to",
                    name_of(element)
                ),
            ));
        }
        let text = |tag: &str| child(element, tag).and_then(|n| n.text()).map(str::trim);
        let base = match (told_from(element), element.tag_name().name()) {
            (Some(frame), _) => Some(frame),
            // A joint stands in its child, a frame in what it is attached to.
            (None, "joint") => text("child"),
            (None, "frame") => element.attribute("attached_to").map(str::trim),
            _ => None,
        };
        let base = base.map(|base| self.named(base, depth + 1, a)).transpose()?.flatten().unwrap_or(DAffine3::IDENTITY);
        let mut placed = base * own_pose(element, a);
        if let Some(frame) = element.attribute("placement_frame").map(str::trim).filter(|frame| !frame.is_empty()) {
            // The pose is that of this frame within the model.
            let own = Frames { scope: element }.named(frame, depth + 1, a)?;
            placed *= own.unwrap_or(DAffine3::IDENTITY).inverse();
        }
        Ok(placed)
    }

    fn named(&self, name: &str, depth: usize, a: &mut Assembly) -> Result<Option<DAffine3>, ImportError> {
        if matches!(name, "" | "__model__") || name == "world" && self.scope.tag_name().name() == "world" {
            return Ok(Some(DAffine3::IDENTITY));
        }
        let (first, rest) = name.split_once("::").map_or((name, None), |(first, rest)| (first, Some(rest)));
        let is_it = |node: &Node| {
            node.is_element()
                && match node.tag_name().name() {
                    "link" | "joint" | "frame" | "model" => name_of(*node) == first,
                    "include" => child(*node, "name").and_then(|n| n.text()).map(str::trim) == Some(first),
                    _ => false,
                }
        };
        let Some(element) = self.scope.children().find(is_it) else {
            a.warn("frame", format!("there is no frame {name:?} in {:?}; it was taken for that of its model", name_of(self.scope)));
            return Ok(None);
        };
        let outer = self.of(element, depth, a)?;
        let Some(rest) = rest else { return Ok(Some(outer)) };
        Ok(Frames { scope: element }.named(rest, depth + 1, a)?.map(|inner| outer * inner))
    }
}
