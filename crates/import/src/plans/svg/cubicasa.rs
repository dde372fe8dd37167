//! Drawings in the form of CubiCasa5k's `model.svg` (Kalervo et al. 2019): groups whose classes say what they are.
//!
//! | class of a group | what its own polygon is |
//! |---|---|
//! | `Space Bedroom`, `Space LivingRoom`, … | a room of this kind, by the inner faces of its walls |
//! | `Door Swing Beside`, `Door Slide`, … | a door; one without a leaf (`Door None`) is a passage |
//! | `Window Regular`, … | a window |
//!
//! Other groups (walls, railings, fixed furniture, the leaves of doors) are not needed. Units are pixels of a scan, about a centimetre each.

use super::path::numbers;
use super::placement::{UNIT, placement};
use enfilade_math::DVec2;
use roxmltree::Node;

/// Usual width of doors, and widths between which a unit of a centimetre is believed, metres.
const DOOR: (f64, [f64; 2]) = (0.85, [0.65, 1.1]);
/// Second classes of spaces, and our words for them where they are not understood as they are.
const SPACES: [(&str, &str); 9] = [
    ("Sauna", "bathroom"),
    ("Closet", "laundry"),
    ("DressingRoom", "laundry"),
    ("DraughtLobby", "hall"),
    ("TechnicalRoom", "laundry"),
    ("EatingArea", "dining"),
    ("Den", "study"),
    ("RecreationRoom", "living"),
    ("MediaRoom", "living"),
];
/// Second classes of spaces that are no rooms with a ceiling.
const OUTSIDE: [&str; 6] = ["Outdoor", "CarPort", "Garage", "OpenToBelow", "Elevator", "SwimmingPool"];

/// Whether a drawing is in this form.
pub(super) fn is(root: &Node) -> bool {
    root.descendants().any(|node| classes(&node).next() == Some("Space"))
}

/// What a polygon is, by the group that it belongs to.
pub(super) fn word(node: &Node) -> Option<String> {
    let group = node.parent().filter(|_| node.tag_name().name() == "polygon")?;
    // The first polygon of a group is its outline.
    let first = group.children().find(|child| child.tag_name().name() == "polygon")?;
    let mut classes = classes(&group);
    let (kind, sort) = (classes.next()?, classes.next().unwrap_or_default());
    match kind {
        _ if first != *node => None,
        "Space" => {
            let known = SPACES.iter().find(|(theirs, _)| *theirs == sort).map(|(_, ours)| *ours);
            Some(known.unwrap_or(if sort.is_empty() { "Undefined" } else { sort }).to_string())
        }
        "Door" if sort == "None" => Some("passage".into()),
        "Door" | "Window" => Some(kind.to_lowercase()),
        _ => None,
    }
}

/// Whether a space is no room of a home.
pub(super) fn is_outside(word: &str) -> bool {
    OUTSIDE.contains(&word)
}

/// Metres of a unit: a centimetre, unless doors would not be as wide as doors are.
pub(super) fn unit(root: &Node) -> f64 {
    let is_door = |node: &Node| word(node).is_some_and(|word| word == "door");
    let mut widths: Vec<f64> = root.descendants().filter(is_door).filter_map(|node| longest_side(&node)).collect();
    widths.sort_by(f64::total_cmp);
    let (usual, [low, high]) = DOOR;
    match widths.get(widths.len() / 2) {
        Some(width) if *width > 0.0 && !(low..=high).contains(&(UNIT * width)) => usual / width,
        _ => UNIT,
    }
}

fn longest_side(node: &Node) -> Option<f64> {
    let placed = placement(node).ok()?;
    let points = numbers(node.attribute("points")?).ok()?;
    let points: Vec<DVec2> = points.chunks_exact(2).map(|p| placed.transform_point2(DVec2::from_slice(p))).collect();
    points.windows(2).map(|ends| ends[0].distance(ends[1])).reduce(f64::max)
}

fn classes<'a>(node: &Node<'a, '_>) -> impl Iterator<Item = &'a str> {
    node.attribute("class").unwrap_or_default().split_whitespace()
}
