//! Walls with their holes, floors and ceilings.

use super::super::objects::Objects;
use super::house::{House, Opening, Wall};
use super::space::MIRROR;
use crate::ImportError;
use crate::assembly::Assembly;
use crate::polygon::{newell_normal, triangulate};
use crate::sweethome::{Hole, without_holes};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec2, DVec3, Rgb, Vec3};
use enfilade_scene::Material;
use serde_json::Value;

/// Distance of a wall's sheet from the wall, inside its room, metres.
const INSIDE: f64 = 0.005;
/// Reflectances of walls and ceilings, and of floors, whose pictures are not available.
const PLASTER: f32 = 0.75;
const BOARDS: f32 = 0.4;
/// Classes of NYU40.
const WALL: i16 = 1;
const FLOOR: i16 = 2;
const CEILING: i16 = 22;

/// A wall by its lower edge, as seen from above, and its height; Unity's axes.
struct Sheet {
    start: DVec2,
    end: DVec2,
    bottom: f64,
    top: f64,
}

impl Sheet {
    /// The sheet of a wall; `None` where its corners are none.
    fn of(wall: &Wall) -> Option<Self> {
        let [first, second, ..] = wall.polygon[..] else { return None };
        let heights = || wall.polygon.iter().map(|p| p.y);
        let (bottom, top) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
        let (start, end) = (DVec2::new(first.x, first.z), DVec2::new(second.x, second.z));
        (start.distance(end) > 1e-9 && top > bottom && start.is_finite() && end.is_finite()).then_some(Self { start, end, bottom, top })
    }
}

/// Adds floors, ceilings and walls.
pub(super) fn add(house: &House, objects: &mut Objects, a: &mut Assembly) -> Result<(), ImportError> {
    for room in &house.rooms {
        let outline: Vec<DVec2> = room.floor.iter().map(|p| DVec2::new(p.x, p.z)).collect();
        let height = room.floor.first().map_or(0.0, |p| p.y);
        let flat = |y: f64, up: bool| polygon(&outline.iter().map(|p| DVec3::new(p.x, y, p.y)).collect::<Vec<_>>(), up);
        part(&format!("{} floor ({})", room.kind, room.id), FLOOR, flat(height, true), room.material.as_ref(), BOARDS, objects, a)?;
        let own = house.walls.iter().filter(|wall| wall.room == room.id).filter_map(Sheet::of);
        let top = own.map(|sheet| sheet.top).fold(f64::NEG_INFINITY, f64::max);
        if top > height {
            part(&format!("{} ceiling ({})", room.kind, room.id), CEILING, flat(top, false), None, PLASTER, objects, a)?;
        }
    }
    let mut strange = 0;
    for wall in house.walls.iter().filter(|wall| !wall.empty) {
        let Some(sheet) = Sheet::of(wall) else {
            strange += 1;
            continue;
        };
        let mesh = standing(&sheet, &holes(wall, &sheet, house), inward(wall, &sheet, house));
        part(&format!("wall ({})", wall.id), WALL, mesh, wall.material.as_ref(), PLASTER, objects, a)?;
    }
    if strange > 0 {
        a.warn("walls", format!("{strange} walls have no length or height; they were left out"));
    }
    a.warn("materials", "the pictures of walls and floors are within AI2-THOR; plain colours stand in");
    Ok(())
}

/// The middle of an opening, and the rotation that takes x along its wall; Unity's axes. `None` without its wall or its place.
pub(super) fn stand_of(opening: &Opening, house: &House) -> Option<(DVec3, DMat3)> {
    let wall = house.walls.iter().find(|wall| Some(&wall.id) == opening.wall0.as_ref())?;
    let (sheet, at) = (Sheet::of(wall)?, opening.position?);
    let along = (sheet.end - sheet.start).normalize();
    let foot = sheet.start + along * at.x;
    let turn = DMat3::from_cols(DVec3::new(along.x, 0.0, along.y), DVec3::Y, DVec3::new(-along.y, 0.0, along.x));
    Some((DVec3::new(foot.x, sheet.bottom + at.y, foot.y), turn))
}

/// The holes of doors and windows in a wall.
fn holes(wall: &Wall, sheet: &Sheet, house: &House) -> Vec<Hole> {
    let length = sheet.start.distance(sheet.end);
    let mut holes = Vec::new();
    for opening in house.doors.iter().chain(&house.windows) {
        let is_first = opening.wall0.as_ref() == Some(&wall.id);
        if !is_first && opening.wall1.as_ref() != Some(&wall.id) {
            continue;
        }
        let Some([p, q]) = opening.corners() else { continue };
        let (near, far) = (p.x.min(q.x), p.x.max(q.x));
        let (near, far) = if is_first { (near, far) } else { (length - far, length - near) };
        let up = [sheet.bottom + p.y.min(q.y), sheet.bottom + p.y.max(q.y)];
        let along = [(near / length).clamp(0.0, 1.0), (far / length).clamp(0.0, 1.0)];
        if along.iter().chain(&up).all(|v| v.is_finite()) && along[0] < along[1] {
            holes.push(Hole { along, up });
        }
    }
    holes
}

/// The unit vector from a wall into its room; of walls outside away from the rooms. Zero where neither side or both are.
fn inward(wall: &Wall, sheet: &Sheet, house: &House) -> DVec2 {
    const STEP: f64 = 0.02;
    let across = (sheet.end - sheet.start).normalize().perp();
    let middle = 0.5 * (sheet.start + sheet.end);
    let own = house.rooms.iter().find(|room| room.id == wall.room);
    let inside = |p: DVec2| match own {
        Some(room) => holds(room.floor.iter().map(|c| DVec2::new(c.x, c.z)), p),
        None => !house.rooms.iter().any(|room| holds(room.floor.iter().map(|c| DVec2::new(c.x, c.z)), p)),
    };
    match (inside(middle + across * STEP), inside(middle - across * STEP)) {
        (true, false) => across,
        (false, true) => -across,
        _ => DVec2::ZERO,
    }
}

/// True if a point is within a polygon, by the crossings of a ray.
fn holds(corners: impl Iterator<Item = DVec2> + Clone, p: DVec2) -> bool {
    let next = corners.clone().cycle().skip(1);
    let crossings = corners.zip(next).filter(|(a, b)| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x));
    crossings.count() % 2 == 1
}

/// The mesh of a wall with its holes, moved into its room and facing it.
fn standing(sheet: &Sheet, holes: &[Hole], inward: DVec2) -> Mesh {
    let along = sheet.end - sheet.start;
    let moved = sheet.start + inward * INSIDE;
    let faces_left = along.perp().dot(inward) >= 0.0;
    let mut mesh = Mesh::default();
    for piece in without_holes(sheet.bottom, [sheet.top; 2], holes) {
        let corner = |p: &DVec2| {
            let foot = moved + along * p.x;
            (DVec3::new(foot.x, p.y, foot.y) * MIRROR).as_vec3()
        };
        let mut corners: Vec<Vec3> = piece.iter().map(corner).collect();
        // Counter-clockwise pieces face left of the wall in Unity's axes and, mirrored, right.
        if faces_left {
            corners.reverse();
        }
        push_fan(&mut mesh, &corners);
    }
    mesh
}

fn push_fan(mesh: &mut Mesh, corners: &[Vec3]) {
    let first = mesh.positions.len() as u32;
    mesh.positions.extend(corners);
    mesh.triangles.extend((2..corners.len() as u32).map(|i| [first, first + i - 1, first + i]));
}

/// A flat polygon that faces up or down.
fn polygon(corners: &[DVec3], up: bool) -> Mesh {
    let mut positions: Vec<Vec3> = corners.iter().map(|p| (*p * MIRROR).as_vec3()).collect();
    if (newell_normal(&positions).y > 0.0) != up {
        positions.reverse();
    }
    let triangles = triangulate(&positions).into_iter().map(|t| t.map(|i| i as u32)).collect();
    Mesh { positions, triangles, ..Mesh::default() }
}

fn part(
    name: &str,
    class: i16,
    mesh: Mesh,
    material: Option<&Value>,
    plain: f32,
    objects: &mut Objects,
    a: &mut Assembly,
) -> Result<(), ImportError> {
    let file = a.file().to_path_buf();
    let Some(mesh) = a.push_mesh(mesh, &file, name)? else { return Ok(()) };
    let material = a.push_material(Material::diffuse(material_name(material), color(material).unwrap_or(Rgb::splat(plain))));
    let object = objects.of_class(class, name);
    a.push_part(&object.name, mesh, material, DAffine3::IDENTITY, object.label);
    Ok(())
}

/// The name of a material, which is a text before schema 1.0.0.
fn material_name(material: Option<&Value>) -> String {
    let name = material.and_then(|m| m.as_str().or_else(|| m.get("name")?.as_str()));
    name.unwrap_or("plain").to_string()
}

/// The colour of a material, linear, 0 … 1.
fn color(material: Option<&Value>) -> Option<Rgb> {
    let color = material?.get("color")?;
    let channel = |key: &str| color.get(key)?.as_f64().map(|v| enfilade_math::linear_from_srgb(v.clamp(0.0, 1.0) as f32));
    Some(Rgb::new(channel("r")?, channel("g")?, channel("b")?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_told_inside_and_outside_of_concave_outlines() {
        let ell = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)].map(|(x, y)| DVec2::new(x, y));
        for (x, y, inside) in [(0.5, 1.5, true), (1.5, 0.5, true), (1.5, 1.5, false), (-0.1, 1.0, false)] {
            assert_eq!(holds(ell.into_iter(), DVec2::new(x, y)), inside, "{x} {y}");
        }
    }
}
