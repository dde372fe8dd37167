//! The law of a scene's rooms: the walls, floors and ceilings in frames are on their planes. Fitted rooms say themselves how far they
//! are off.

use super::card::Card;
use super::law::Law;
use enfilade_frame::{Frame, Layer, vector};
use enfilade_math::DVec3;
use enfilade_scene::{CEILING, CeilingSlope, FLOOR, PLANE_NEAR_M as NEAR_M, Rooms, WALL, WallFace, WallOpening};

/// Checks a frame.
pub(super) fn check(rooms: &Rooms, frame: &Frame, place: &str, card: &mut Card) {
    let (Some(positions), Some(classes)) = (frame.get(Layer::Position), frame.get(Layer::Semantic)) else { return };
    if rooms.fit.is_some() {
        return;
    }
    let is_off = |pixel: usize| {
        let p: DVec3 = vector(positions, pixel);
        p.is_finite().then(|| is_elsewhere(rooms, classes.get(pixel) as i16, p)).flatten()
    };
    let found: Vec<(usize, bool)> = (0..frame.pixels()).filter_map(|pixel| Some((pixel, is_off(pixel)?))).collect();
    let off: Vec<usize> = found.iter().filter(|(_, off)| *off).map(|(pixel, _)| *pixel).collect();
    if found.is_empty() {
        return;
    }
    card.observe(Law::LayoutPlanes, off.len() as f64 / found.len() as f64, || {
        let first = off.first().copied().unwrap_or_default();
        let (x, y) = (first % frame.width as usize, first / frame.width as usize);
        format!("{place}: {} of {} pixels, the first of them ({x}, {y})", off.len(), found.len())
    });
}

/// Whether a point of a wall, floor or ceiling is off the planes of the rooms; `None` for other classes.
fn is_elsewhere(rooms: &Rooms, class: i16, p: DVec3) -> Option<bool> {
    let near = |z: f64| (p.z - z).abs() <= NEAR_M;
    let is_there = match class {
        WALL => rooms.walls.iter().any(|wall| is_on(wall, p)) || rooms.openings.iter().any(|o| is_reveal(rooms, o, p)),
        FLOOR => rooms.outlines.iter().any(|room| near(room.floor_z_m)),
        CEILING => {
            let is_under = |of: &CeilingSlope| of.slope.distance_m(p).abs() <= NEAR_M;
            rooms.outlines.iter().any(|room| near(room.ceiling_z_m)) || rooms.slopes.iter().any(is_under)
        }
        _ => return None,
    };
    Some(!is_there)
}

fn is_on(wall: &WallFace, p: DVec3) -> bool {
    let within = |value: f64, high: f64| (-NEAR_M..=high + NEAR_M).contains(&value);
    wall.distance_m(p).abs() <= NEAR_M
        && within(wall.along_m(p), wall.length_m())
        && within(p.z - wall.floor_z_m, wall.ceiling_z_m - wall.floor_z_m)
}

/// Whether a point is on the sides of an opening, in the depth of the wall.
fn is_reveal(rooms: &Rooms, opening: &WallOpening, p: DVec3) -> bool {
    let wall = &rooms.walls[opening.walls[0]];
    let [left, right, upper, _] = opening.corners.map(DVec3::from);
    let (low, high) = (wall.along_m(right) - NEAR_M, wall.along_m(left) + NEAR_M);
    (-wall.thickness_m - NEAR_M..=NEAR_M).contains(&wall.distance_m(p))
        && (low..=high).contains(&wall.along_m(p))
        && (left.z - NEAR_M..=upper.z + NEAR_M).contains(&p.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::{OpeningKind, RoomOutline};

    fn room() -> Rooms {
        let polygon = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]];
        let room = RoomOutline { name: "study_1".into(), kind: "study".into(), polygon, floor_z_m: 0.0, ceiling_z_m: 2.5 };
        let mut rooms = Rooms::default();
        rooms.push_room(room, &[(0.4, true); 4]);
        let corners = [[3.0, 0.0, 0.9], [1.0, 0.0, 0.9], [1.0, 0.0, 2.1], [3.0, 0.0, 2.1]];
        rooms.openings.push(WallOpening { kind: OpeningKind::Window, walls: vec![0], corners, leaf: None });
        rooms
    }

    #[test]
    fn walls_floors_and_ceilings_are_on_their_planes_or_in_reveals() {
        let elsewhere = |class, p: [f64; 3]| is_elsewhere(&room(), class, p.into());
        assert_eq!(elsewhere(WALL, [4.0, 1.0, 1.0]), Some(false));
        assert_eq!(elsewhere(WALL, [3.9, 1.0, 1.0]), Some(true));
        // The side of the window, and as deep where there is no window.
        assert_eq!(elsewhere(WALL, [1.0, -0.2, 1.5]), Some(false));
        assert_eq!(elsewhere(WALL, [0.5, -0.2, 1.5]), Some(true));
        assert_eq!(elsewhere(FLOOR, [1.0, 1.0, 0.01]), Some(false));
        assert_eq!(elsewhere(FLOOR, [1.0, 1.0, 0.05]), Some(true));
        assert_eq!(elsewhere(CEILING, [1.0, 1.0, 2.5]), Some(false));
        assert_eq!(elsewhere(5, [1.0, 1.0, 1.0]), None);
    }

    #[test]
    fn sloping_ceilings_are_ceilings() {
        let mut rooms = room();
        rooms.slopes.push(CeilingSlope {
            room: 0,
            slope: enfilade_scene::Slope { from: [0.0, 0.0], to: [4.0, 0.0], low_z_m: 1.5, pitch_deg: 45.0 },
        });
        assert_eq!(is_elsewhere(&rooms, CEILING, [1.0, 0.5, 2.0].into()), Some(false));
        assert_eq!(is_elsewhere(&rooms, CEILING, [1.0, 0.5, 2.1].into()), Some(true));
    }
}
