//! SVG drawings of floor plans: outlines of rooms, and lines where doors and windows are.
//!
//! Rooms are `polygon`, `polyline`, `rect` and `path` elements; paths have straight pieces (M, L, H, V, Z, absolute or relative). What an
//! element is, its `data-kind`, `inkscape:label`, `<title>`, `id` or first `class` says, in this order: a word with "door", "window" or
//! "passage" is an opening as long as the element, "ignore" is left out, any other word is the kind of a room. Elements without a word,
//! such as frames and furniture, are left out. `translate`, `scale`, `rotate` and `matrix` of groups count.
//!
//! SVG has no length of the real world: `data-meters-per-unit` of the root gives the metres of a unit; without it a unit is a centimetre.
//! y points down in SVG and up in plans.

use super::loops::around;
use super::source::Source;
use crate::ImportError;
use enfilade_math::{DMat3, DVec2, DVec3};
use enfilade_scene::{DrawnPlan, DrawnRoom, OpeningKind};
use roxmltree::{Document, Node};

/// Metres of a unit where the file does not say.
const UNIT: f64 = 0.01;
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
        None => UNIT,
        Some(Ok(unit)) if unit > 0.0 && unit.is_finite() => unit,
        Some(_) => {
            return Err(source.error(SCALE, format!("found {:?}, expected metres of a unit, such as 0.01", stated.unwrap_or_default())));
        }
    };
    let mut plan = DrawnPlan::default();
    if stated.is_none() {
        plan.notes.push(format!("a unit of the drawing was taken as {UNIT} m; {SCALE} of its svg element says otherwise"));
    }
    let mut without_word = 0;
    for node in root.descendants().filter(Node::is_element) {
        let line = document.text_pos_at(node.range().start).row;
        let corners = corners(&node).map_err(|problem| source.error(format!("line {line}"), problem))?;
        let Some(corners) = corners.filter(|corners| corners.len() > 1) else { continue };
        let Some(word) = word(&node) else {
            without_word += 1;
            continue;
        };
        let placed = placement(&node).map_err(|problem| source.error(format!("line {line}"), problem))?;
        let points: Vec<DVec2> = corners.into_iter().map(|p| placed.transform_point2(p) * DVec2::new(unit, -unit)).collect();
        let lower = word.to_lowercase();
        let opening = [("door", OpeningKind::Door), ("window", OpeningKind::Window), ("passage", OpeningKind::Passage)];
        match opening.iter().find(|(part, _)| lower.contains(part)) {
            _ if lower.contains("ignore") => {}
            Some((_, kind)) => plan.openings.extend(around(*kind, &points, None)),
            None => plan.rooms.push(DrawnRoom { name: format!("{word} (line {line})"), kind: word, polygon: points, height_m: None }),
        }
    }
    if without_word > 0 {
        plan.notes.push(format!("{without_word} shapes have no id, title or class that says what they are; they are left out"));
    }
    Ok(plan)
}

/// What an element is.
fn word(node: &Node) -> Option<String> {
    let own = |name: &str| node.attributes().find(|a| a.name() == name).map(|a| a.value());
    let title =
        node.children().find(|child| child.has_tag_name("title") || child.tag_name().name() == "title").and_then(|title| title.text());
    let found = own("data-kind").or_else(|| own("label")).or(title).or_else(|| own("id")).or_else(|| own("class")?.split(' ').next());
    found
        .map(|word| word.trim().trim_end_matches(|c: char| c.is_ascii_digit() || "_- ".contains(c)).to_string())
        .filter(|word| !word.is_empty())
}

/// The corners of a shape in its own units; `None` for other elements.
fn corners(node: &Node) -> Result<Option<Vec<DVec2>>, String> {
    let number = |name: &str| node.attribute(name).map_or(Ok(0.0), |text| text.parse::<f64>().map_err(|_| not_a_number(name, text)));
    let pairs = |name: &str| {
        let numbers = numbers(node.attribute(name).unwrap_or_default())?;
        Ok::<_, String>(numbers.chunks_exact(2).map(DVec2::from_slice).collect::<Vec<DVec2>>())
    };
    Ok(Some(match node.tag_name().name() {
        "polygon" | "polyline" => pairs("points")?,
        "line" => vec![DVec2::new(number("x1")?, number("y1")?), DVec2::new(number("x2")?, number("y2")?)],
        "rect" => {
            let (at, size) = (DVec2::new(number("x")?, number("y")?), DVec2::new(number("width")?, number("height")?));
            vec![at, at + DVec2::new(size.x, 0.0), at + size, at + DVec2::new(0.0, size.y)]
        }
        "path" if word(node).is_some() => path(node.attribute("d").unwrap_or_default())?,
        _ => return Ok(None),
    }))
}

fn not_a_number(name: &str, text: &str) -> String {
    format!("{name} is {text:?}, expected a number without a unit")
}

/// Numbers that spaces, commas or signs separate.
fn numbers(text: &str) -> Result<Vec<f64>, String> {
    let mut words: Vec<String> = Vec::new();
    let mut before = ' ';
    for c in text.chars() {
        let starts = matches!(c, '-' | '+') && !matches!(before, 'e' | 'E');
        match words.last_mut() {
            _ if c.is_whitespace() || c == ',' => {}
            Some(word) if !(starts || before.is_whitespace() || before == ',') => word.push(c),
            _ => words.push(c.to_string()),
        }
        before = c;
    }
    words
        .iter()
        .map(|word| word.parse::<f64>().ok().filter(|n| n.is_finite()).ok_or_else(|| format!("found {word:?}, expected a number")))
        .collect()
}

/// The corners of a path of straight pieces: its first outline.
fn path(d: &str) -> Result<Vec<DVec2>, String> {
    let mut corners: Vec<DVec2> = Vec::new();
    let starts: Vec<usize> = d.char_indices().filter(|(_, c)| c.is_ascii_alphabetic() && !matches!(c, 'e' | 'E')).map(|(i, _)| i).collect();
    for (k, &start) in starts.iter().enumerate() {
        let end = starts.get(k + 1).copied().unwrap_or(d.len());
        let command = d.as_bytes()[start] as char;
        let values = numbers(&d[start + 1..end])?;
        let at = |corners: &Vec<DVec2>| corners.last().copied().unwrap_or(DVec2::ZERO);
        let is_relative = command.is_ascii_lowercase();
        match command.to_ascii_uppercase() {
            'M' if !corners.is_empty() => break,
            'M' | 'L' => {
                for pair in values.chunks_exact(2) {
                    let from = if is_relative { at(&corners) } else { DVec2::ZERO };
                    corners.push(from + DVec2::from_slice(pair));
                }
            }
            'H' | 'V' => {
                for value in values {
                    let from = at(&corners);
                    let axis = usize::from(command.eq_ignore_ascii_case(&'v'));
                    let mut to = from;
                    to[axis] = if is_relative { from[axis] + value } else { value };
                    corners.push(to);
                }
            }
            'Z' => break,
            _ => {
                return Err(format!(
                    "the path has the command {command:?}, expected straight pieces: M, L, H, V and Z; flatten its curves"
                ));
            }
        }
    }
    Ok(corners)
}

/// From an element's units to the root's.
fn placement(node: &Node) -> Result<DMat3, String> {
    let mut placed = DMat3::IDENTITY;
    for ancestor in node.ancestors().filter(Node::is_element) {
        if let Some(text) = ancestor.attribute("transform") {
            placed = transform(text)? * placed;
        }
    }
    Ok(placed)
}

fn transform(text: &str) -> Result<DMat3, String> {
    let mut whole = DMat3::IDENTITY;
    for call in text.split(')').map(|call| call.trim().trim_start_matches(',').trim()).filter(|call| !call.is_empty()) {
        let (name, arguments) =
            call.split_once('(').ok_or_else(|| format!("found the transform {text:?}, expected such as translate(2 3)"))?;
        whole *= match (name.trim(), &numbers(arguments)?[..]) {
            ("translate", &[x]) => DMat3::from_translation(DVec2::new(x, 0.0)),
            ("translate", &[x, y]) => DMat3::from_translation(DVec2::new(x, y)),
            ("scale", &[s]) => DMat3::from_scale(DVec2::splat(s)),
            ("scale", &[x, y]) => DMat3::from_scale(DVec2::new(x, y)),
            ("rotate", &[degrees]) => DMat3::from_angle(degrees.to_radians()),
            ("rotate", &[degrees, x, y]) => {
                let middle = DMat3::from_translation(DVec2::new(x, y));
                middle * DMat3::from_angle(degrees.to_radians()) * middle.inverse()
            }
            ("matrix", &[a, b, c, d, e, f]) => DMat3::from_cols(DVec3::new(a, b, 0.0), DVec3::new(c, d, 0.0), DVec3::new(e, f, 1.0)),
            _ => return Err(format!("found the transform {call:?}), expected translate, scale, rotate or matrix")),
        };
    }
    Ok(whole)
}
