//! Floors and ceilings of rooms, and the ground around them.

use super::home::Home;
use super::outline::Walls;
use super::paint::Paint;
use super::piece::Piece;
use super::surface::{Surface, lifted, subtract};
use super::xml::Element;
use crate::{ImportError, polygon};
use enfilade_math::{DVec2, Vec3};

/// Extent of the ground beyond the rooms, centimetres.
const GROUND_MARGIN: f64 = 2000.0;

/// Corners of one room and of all: beyond them it takes too long to find out which floors overlap.
const MAX_CORNERS: (usize, usize) = (1000, 20_000);

type Triangles = Vec<[DVec2; 3]>;

/// A room's floor plan.
struct Room<'x> {
    element: Element<'x>,
    points: Vec<DVec2>,
    triangles: Triangles,
    level: Option<&'x str>,
}

/// Adds the floors and ceilings of all rooms, and the ground where the home has one. Where floors of one level overlap, the later
/// room has the place; staircases open the floor above them.
pub(super) fn add_all(root: &Element, walls: &Walls, pieces: &[Piece], home: &mut Home) -> Result<(), ImportError> {
    let mut rooms = Vec::new();
    let mut corners = 0;
    for element in root.children().filter(|e| e.tag() == "room") {
        let level = element.text("level");
        if !home.shows(level) {
            continue;
        }
        let mut points = Vec::new();
        for point in element.children().filter(|e| e.tag() == "point") {
            points.push(DVec2::new(point.required("x")?, point.required("y")?));
        }
        corners += points.len();
        if points.len() > MAX_CORNERS.0 || corners > MAX_CORNERS.1 {
            let (of_room, of_home) = MAX_CORNERS;
            let problem =
                format!("found {} corners of {corners} so far, expected {of_room} of {of_home} at most; simplify the room", points.len());
            return Err(element.error(problem));
        }
        if points.len() < 3 {
            home.a.warn(element.place(), "the room has fewer than three corners and was left out");
            continue;
        }
        let triangles = triangulated(&points);
        rooms.push(Room { element, points, triangles, level });
    }
    for index in 0..rooms.len() {
        add_floor(&rooms, index, pieces, home)?;
        add_ceiling(&rooms, index, walls, pieces, home)?;
    }
    add_ground(root, &rooms, home)
}

fn triangulated(points: &[DVec2]) -> Triangles {
    let flat: Vec<Vec3> = points.iter().map(|p| Vec3::new(p.x as f32, p.y as f32, 0.0)).collect();
    polygon::triangulate(&flat).into_iter().map(|t| t.map(|i| points[i])).collect()
}

fn name(room: &Room, index: usize) -> String {
    room.element.text("name").map_or_else(|| format!("room_{}", index + 1), str::to_string)
}

fn add_floor(rooms: &[Room], index: usize, pieces: &[Piece], home: &mut Home) -> Result<(), ImportError> {
    let room = &rooms[index];
    if !room.element.flag("floorVisible", true) {
        return Ok(());
    }
    let elevation = home.elevation_of(room.level);
    let later = rooms[index + 1..].iter().filter(|r| r.element.flag("floorVisible", true));
    let over: Vec<&Room> = later.filter(|r| home.elevation_of(r.level) == elevation).collect();
    let lowest = home.level(room.level).is_none_or(|l| home.is_lowest(l));
    let stairs = pieces.iter().filter(|p| !lowest && p.opens_floor_at(elevation, home.elevation_of(room.level)));
    let triangles = without(room, &over, &stairs.map(Piece::footprint).collect::<Vec<_>>());
    // The picture runs along x and against the plan's y, as on the plan seen from above.
    let surface = sheet(&triangles, &|_| elevation, true, -1.0);
    home.push(&format!("{}.floor", name(room, index)), surface, paint(room.element, "floor")?)
}

fn add_ceiling(rooms: &[Room], index: usize, walls: &Walls, pieces: &[Piece], home: &mut Home) -> Result<(), ImportError> {
    let room = &rooms[index];
    if !room.element.flag("ceilingVisible", true) {
        return Ok(());
    }
    let level = home.level(room.level);
    let below_another = level.filter(|l| !home.is_highest(*l));
    let flat = below_another.map(|l| l.elevation + l.height);
    let heights = |p: DVec2| flat.unwrap_or_else(|| height_at(p, room.level, walls, home));
    let later = rooms[index + 1..].iter().filter(|r| r.element.flag("ceilingVisible", true) && r.level == room.level);
    let over: Vec<&Room> = later.collect();
    let elevation = home.elevation_of(room.level);
    let stairs = pieces.iter().filter(|p| flat.is_some_and(|top| p.opens_floor_at(top, elevation)));
    let triangles = without(room, &over, &stairs.map(Piece::footprint).collect::<Vec<_>>());
    let surface = sheet(&triangles, &heights, false, 1.0);
    home.push(&format!("{}.ceiling", name(room, index)), surface, paint(room.element, "ceiling")?)
}

fn paint<'x>(element: Element<'x>, part: &str) -> Result<Paint<'x>, ImportError> {
    Ok(Paint {
        color: element.color(&format!("{part}Color"))?,
        texture: element.child("texture", Some(&format!("{part}Texture"))),
        shininess: element.number_or(&format!("{part}Shininess"), 0.0)?,
    })
}

/// The room's own triangles without those of rooms over it and holes.
fn without(room: &Room, over: &[&Room], holes: &[[DVec2; 4]]) -> Triangles {
    let rooms = over.iter().flat_map(|r| &r.triangles);
    let cut = rooms.fold(room.triangles.clone(), |left, triangle| subtract(left, triangle));
    holes.iter().fold(cut, |left, hole| subtract(left, hole))
}

/// A level or uneven sheet that faces up or down; `v` is the direction of the picture's height on the plan.
fn sheet(triangles: &[[DVec2; 3]], height: &dyn Fn(DVec2) -> f64, faces_up: bool, v: f64) -> Surface {
    let mut surface = Surface::default();
    for triangle in triangles {
        let mut corners = triangle.map(|p| (lifted(p, height(p)), DVec2::new(p.x, v * p.y)));
        // The plan's y runs toward the viewer, so what turns from x to y faces down.
        let turns_down = (triangle[1] - triangle[0]).perp_dot(triangle[2] - triangle[0]) > 0.0;
        if turns_down == faces_up {
            corners.reverse();
        }
        surface.polygon(&corners);
    }
    surface
}

/// The height of the nearest corner of a wall of a level; the level's own height, or the height of the home's walls, if it has none.
pub(super) fn height_at(p: DVec2, level: Option<&str>, walls: &Walls, home: &Home) -> f64 {
    let corners = walls.list.iter().filter(|w| w.level == level).flat_map(|w| w.ends().into_iter().zip(w.tops));
    let nearest = corners.min_by(|(a, _), (b, _)| a.distance_squared(p).total_cmp(&b.distance_squared(p)));
    let own = home.level(level).map_or(home.wall_height, |l| l.elevation + l.height);
    nearest.map_or(own, |(_, top)| top)
}

fn add_ground(root: &Element, rooms: &[Room], home: &mut Home) -> Result<(), ImportError> {
    let Some(environment) = root.child("environment", None) else { return Ok(()) };
    if home.has_cellar() {
        home.a.warn(environment.place(), "the ground was left out, since it would fill the levels below it");
        return Ok(());
    }
    let points = rooms.iter().flat_map(|r| &r.points);
    let (min, max) = points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(min, max), p| (min.min(*p), max.max(*p)));
    if !(min.is_finite() && max.is_finite()) {
        return Ok(());
    }
    let (min, max) = (min - GROUND_MARGIN, max + GROUND_MARGIN);
    let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
    let all = vec![[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]];
    let floors = rooms.iter().filter(|r| home.elevation_of(r.level) == 0.0 && r.element.flag("floorVisible", true));
    let triangles = floors.flat_map(|r| &r.triangles).fold(all, |left, triangle| subtract(left, triangle));
    let paint =
        Paint { color: environment.color("groundColor")?, texture: environment.child("texture", Some("groundTexture")), shininess: 0.0 };
    home.push("ground", sheet(&triangles, &|_| 0.0, true, -1.0), paint)
}
