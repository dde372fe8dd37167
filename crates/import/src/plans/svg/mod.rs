//! SVG drawings of floor plans: outlines of rooms, and lines where doors and windows are.
//!
//! Rooms are `polygon`, `polyline`, `rect`, `circle`, `ellipse` and `path` elements; of a path its first outline. What an element is, its
//! `data-kind`, `inkscape:label`, `<title>`, `id` or first `class` says, in this order: a word with "door", "window" or "passage" is an
//! opening as long as the element, "ignore" is left out, any other word is the kind of a room. Elements without a word, such as frames and
//! furniture, are left out. `translate`, `scale`, `rotate` and `matrix` of groups count. Drawings in the form of CubiCasa5k say what shapes
//! are by the classes of the groups around them: [`cubicasa`].
//!
//! SVG has no length of the real world: `data-meters-per-unit` of the root gives the metres of a unit; without it a unit is a centimetre.
//! y points down in SVG and up in plans.

mod cubicasa;
mod path;
mod placement;

use super::curves::{Arc, NEAR_M};
use super::loops::around;
use super::source::Source;
use crate::ImportError;
use enfilade_math::DVec2;
use enfilade_scene::{DrawnPlan, DrawnRoom, OpeningKind};
use path::numbers;
use placement::{UNIT, placement};
use roxmltree::{Document, Node};

/// Elements that are shapes.
const SHAPES: [&str; 7] = ["polygon", "polyline", "line", "rect", "circle", "ellipse", "path"];
/// The key of the root that says it.
const SCALE: &str = "data-meters-per-unit";

pub(super) fn read(source: &Source) -> Result<DrawnPlan, ImportError> {
    let document = Document::parse(source.text).map_err(|error| {
        let at = error.pos();
        source.error(format!("line {}, column {}", at.row, at.col), format!("{error}; expected an SVG drawing"))
    })?;
    let root = document.root_element();
    let stated = root.attribute(SCALE);
    let unit = match stated.map(str::parse::<f64>) {
        None if cubicasa::is(&root) => cubicasa::unit(&root),
        None => UNIT,
        Some(Ok(unit)) if unit > 0.0 && unit.is_finite() => unit,
        Some(_) => {
            return Err(source.error(SCALE, format!("found {:?}, expected metres of a unit, such as 0.01", stated.unwrap_or_default())));
        }
    };
    let mut plan = DrawnPlan::default();
    if stated.is_none() {
        plan.notes.push(format!("a unit of the drawing was taken as {unit:.4} m; {SCALE} of its svg element says otherwise"));
    }
    let is_cubicasa = cubicasa::is(&root);
    let (mut without_word, mut further, mut outside) = (0, 0, 0);
    for node in root.descendants().filter(Node::is_element) {
        let line = document.text_pos_at(node.range().start).row;
        let found = if is_cubicasa { cubicasa::word(&node) } else { word(&node) };
        if !SHAPES.contains(&node.tag_name().name()) || (is_cubicasa && found.is_none()) {
            continue;
        }
        let Some(word) = found else {
            without_word += 1;
            continue;
        };
        let placed = placement(&node).map_err(|problem| source.error(format!("line {line}"), problem))?;
        let scale = placed.x_axis.truncate().length().max(placed.y_axis.truncate().length());
        let near = NEAR_M / (unit * scale).max(f64::MIN_POSITIVE);
        let (corners, has_more) = corners(&node, near).map_err(|problem| source.error(format!("line {line}"), problem))?;
        further += usize::from(has_more);
        if corners.len() < 2 {
            continue;
        }
        let points: Vec<DVec2> = corners.into_iter().map(|p| placed.transform_point2(p) * DVec2::new(unit, -unit)).collect();
        let lower = word.to_lowercase();
        let opening = [("door", OpeningKind::Door), ("window", OpeningKind::Window), ("passage", OpeningKind::Passage)];
        match opening.iter().find(|(part, _)| lower.contains(part)) {
            _ if lower.contains("ignore") => {}
            _ if is_cubicasa && cubicasa::is_outside(&word) => outside += 1,
            Some((_, kind)) => plan.openings.extend(around(*kind, &points, None)),
            None => plan.rooms.push(DrawnRoom { name: format!("{word} (line {line})"), kind: word, polygon: points, height_m: None }),
        }
    }
    if without_word > 0 {
        plan.notes.push(format!("{without_word} shapes have no id, title or class that says what they are; they are left out"));
    }
    if further > 0 {
        plan.notes.push(format!("{further} paths have several outlines; only the first of each was read"));
    }
    if outside > 0 {
        plan.notes.push(format!("{outside} spaces are outdoors or no rooms; they are left out"));
    }
    Ok(plan)
}

/// What an element is.
fn word(node: &Node) -> Option<String> {
    let own = |name: &str| node.attributes().find(|a| a.name() == name).map(|a| a.value());
    let title =
        node.children().find(|child| child.has_tag_name("title") || child.tag_name().name() == "title").and_then(|title| title.text());
    let found = own("data-kind").or_else(|| own("label")).or(title).or_else(|| own("id")).or_else(|| own("class")?.split(' ').next());
    // Names that drawing programs give, such as path1024, say nothing.
    let is_given = |word: &String| SHAPES.contains(&word.as_str()) || word.is_empty();
    found
        .map(|word| word.trim().trim_end_matches(|c: char| c.is_ascii_digit() || "_- ".contains(c)).to_string())
        .filter(|word| !is_given(word))
}

/// The corners of a shape in its own units, those of curves within `near` of them, and whether it has more outlines.
fn corners(node: &Node, near: f64) -> Result<(Vec<DVec2>, bool), String> {
    let number = |name: &str| node.attribute(name).map_or(Ok(0.0), |text| text.parse::<f64>().map_err(|_| not_a_number(name, text)));
    let pairs = |name: &str| {
        let numbers = numbers(node.attribute(name).unwrap_or_default())?;
        Ok::<_, String>(numbers.chunks_exact(2).map(DVec2::from_slice).collect::<Vec<DVec2>>())
    };
    let round = |radii: DVec2| Ok::<_, String>(Arc::whole(DVec2::new(number("cx")?, number("cy")?), radii).corners(near));
    let corners = match node.tag_name().name() {
        "polygon" | "polyline" => pairs("points")?,
        "line" => vec![DVec2::new(number("x1")?, number("y1")?), DVec2::new(number("x2")?, number("y2")?)],
        "rect" => {
            let (at, size) = (DVec2::new(number("x")?, number("y")?), DVec2::new(number("width")?, number("height")?));
            vec![at, at + DVec2::new(size.x, 0.0), at + size, at + DVec2::new(0.0, size.y)]
        }
        "circle" => round(DVec2::splat(number("r")?))?,
        "ellipse" => round(DVec2::new(number("rx")?, number("ry")?))?,
        _ => return path::outline(node.attribute("d").unwrap_or_default(), near),
    };
    Ok((corners, false))
}

fn not_a_number(name: &str, text: &str) -> String {
    format!("{name} is {text:?}, expected a number without a unit")
}
