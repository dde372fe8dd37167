//! SpatialLM's layout text (`spatiallm/layout/entity.py`): `wall_0=Wall(ax,ay,az,bx,by,bz,height,thickness)`, doors and windows by their
//! wall, middle, width and height, and boxes, from which the kinds of rooms are guessed.

use super::loops::{area, contains, loops};
use super::source::Source;
use crate::ImportError;
use enfilade_math::DVec2;
use enfilade_scene::{DrawnOpening, DrawnPlan, DrawnRoom, OpeningKind};

/// Ends of walls within this meet, metres: networks place them so well.
const MEET: f64 = 0.15;
/// Most walls.
const MOST: usize = 4000;
/// Classes of boxes, and the kind of room that has them; the first that is there counts.
const SIGNS: [(&str, &str); 12] = [
    ("bed", "bedroom"),
    ("toilet", "bathroom"),
    ("bathtub", "bathroom"),
    ("refrigerator", "kitchen"),
    ("stove", "kitchen"),
    ("counter", "kitchen"),
    ("sofa", "living"),
    ("dining_table", "dining"),
    ("washing_machine", "laundry"),
    ("desk", "study"),
    ("television", "living"),
    ("table", "dining"),
];

struct Wall {
    ends: [DVec2; 2],
    floor: f64,
    height: f64,
}

pub(super) fn read(source: &Source) -> Result<DrawnPlan, ImportError> {
    let (mut walls, mut openings, mut boxes) = (Vec::new(), Vec::new(), Vec::new());
    let mut plan = DrawnPlan::default();
    for (number, line) in source.text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let place = format!("line {}", number + 1);
        let Some((kind, arguments)) = entity(line) else {
            return Err(source.error(place, format!("found {line:?}, expected an entity such as wall_0=Wall(0,0,0,4,0,0,2.5,0)")));
        };
        // Boxes and openings begin with a word: the class, or the wall.
        let numbers: Vec<f64> = arguments.iter().filter_map(|word| word.parse().ok()).filter(|number: &f64| number.is_finite()).collect();
        match (kind, &numbers[..]) {
            ("Wall", &[ax, ay, az, bx, by, _, height, ..]) => {
                walls.push(Wall { ends: [DVec2::new(ax, ay), DVec2::new(bx, by)], floor: az, height });
            }
            ("Door" | "Window", &[x, y, z, width, height]) => {
                let kind = if kind == "Door" { OpeningKind::Door } else { OpeningKind::Window };
                let z_m = Some([z - 0.5 * height, z + 0.5 * height]);
                openings.push(DrawnOpening { width_m: Some(width), z_m, ..DrawnOpening::new(kind, DVec2::new(x, y)) });
            }
            ("Bbox", &[x, y, ..]) => boxes.push((arguments[0].to_string(), DVec2::new(x, y))),
            _ => return Err(source.error(place, format!("found {line:?}, expected the arguments of a {kind}"))),
        }
    }
    if walls.len() > MOST {
        return Err(source.error("walls", format!("there are {}, expected at most {MOST}", walls.len())));
    }
    let floor = walls.iter().map(|wall| wall.floor).fold(f64::INFINITY, f64::min);
    let height = walls.iter().map(|wall| wall.height).fold(f64::NEG_INFINITY, f64::max);
    let segments: Vec<[DVec2; 2]> = walls.iter().map(|wall| wall.ends).collect();
    let (rings, lost) = loops(&segments, MEET);
    if rings.is_empty() {
        return Err(
            source.error("walls", format!("the ends of its {} walls do not meet within {MEET} m to close around a room", walls.len()))
        );
    }
    if lost > 0 {
        plan.notes.push(format!("{lost} of {} walls close around no room; they are left out", walls.len()));
    }
    plan.rooms = rings.into_iter().enumerate().map(|(i, polygon)| room(i, polygon, height, &boxes)).collect();
    let guessed: Vec<String> = plan.rooms.iter().map(|room| format!("{} is a {}", room.name, room.kind)).collect();
    plan.notes.push(format!("SpatialLM does not say what rooms are for; guessed from its boxes and areas: {}", guessed.join(", ")));
    for opening in &mut openings {
        opening.z_m = opening.z_m.map(|z| z.map(|z| (z - floor).max(0.0)));
    }
    plan.openings = merged(openings);
    Ok(plan)
}

/// Name and arguments of `name_0=Name(a,b,c)`.
fn entity(line: &str) -> Option<(&str, Vec<&str>)> {
    let (_, call) = line.trim().split_once('=')?;
    let (kind, rest) = call.split_once('(')?;
    let arguments = rest.strip_suffix(')')?.split(',').map(str::trim).collect();
    Some((kind.trim(), arguments))
}

fn room(number: usize, polygon: Vec<DVec2>, height: f64, boxes: &[(String, DVec2)]) -> DrawnRoom {
    let inside: Vec<&str> = boxes.iter().filter(|(_, at)| contains(&polygon, *at)).map(|(class, _)| class.as_str()).collect();
    let sign = SIGNS.iter().find(|(class, _)| inside.contains(class));
    let kind = sign.map_or(if area(&polygon).abs() > 14.0 { "living" } else { "hall" }, |(_, kind)| kind);
    DrawnRoom { name: format!("room {number}"), kind: kind.into(), polygon, height_m: Some(height) }
}

/// Openings that are on both faces of a wall, each once.
fn merged(openings: Vec<DrawnOpening>) -> Vec<DrawnOpening> {
    /// Largest thickness of a wall, metres.
    const THROUGH: f64 = 0.6;
    let mut kept: Vec<DrawnOpening> = Vec::new();
    for opening in openings {
        let near = |known: &DrawnOpening| known.kind == opening.kind && known.at.distance(opening.at) < THROUGH;
        if !kept.iter().any(near) {
            kept.push(opening);
        }
    }
    kept
}
