//! The rooms of a building as architects draw it: walls cut, doors with the arc of their leaf, windows as double lines, rooms with name
//! and area. x to the right, y up.

use crate::drawing::{Anchor, Dark, Drawing, Ink, Point, Text, themed_svg};
use crate::sheet::canvas::Color;
use enfilade_math::DVec2;
use enfilade_scene::{Hinge, OpeningKind, RoomOutline, Rooms, WallFace, WallOpening};
use std::f64::consts::FRAC_PI_2;

/// Pixels per metre.
const SCALE: f64 = 70.0;
/// Paper around the building, metres.
const MARGIN_M: f64 = 0.6;
const PAPER: Color = [255; 3];
const INK: Color = [34, 35, 42];
const SOFT: Color = [98, 102, 110];
const FLOOR: Color = [247, 243, 234];
/// Colours on dark pages.
const DARK: Dark =
    Dark { paper: [31, 32, 36], inks: &[(INK, [232, 232, 228]), (SOFT, [160, 164, 172]), (FLOOR, [46, 47, 52]), (PAPER, [31, 32, 36])] };
/// Points of a quarter of a circle.
const ARC: usize = 12;

/// The drawing as a file, 70 pixels to a metre.
pub fn rooms_svg(rooms: &Rooms) -> String {
    themed_svg(&drawing(rooms), &DARK)
}

fn drawing(rooms: &Rooms) -> Drawing {
    let thickest = rooms.walls.iter().map(|wall| wall.thickness_m).fold(0.0, f64::max);
    let corners = || rooms.outlines.iter().flat_map(|room| &room.polygon).map(|&corner| DVec2::from(corner));
    let frame = DVec2::splat(thickest + MARGIN_M);
    let low = corners().reduce(DVec2::min).unwrap_or_default() - frame;
    let high = corners().reduce(DVec2::max).unwrap_or_default() + frame;
    let page = Page { low, high };
    let size = ((high - low) * SCALE).ceil();
    let mut drawing = Drawing::new(size.x as u32, size.y as u32, PAPER);
    // Walls first, as dark ground; floors and openings are cut out of it.
    for wall in &rooms.walls {
        let [from, to] = ends(wall);
        // Corners belong to both walls.
        let along = (to - from).normalize_or_zero() * if wall.outer { wall.thickness_m } else { 0.0 };
        drawing.area(&page.strip(from - along, to + along, wall, wall.thickness_m), Ink::solid(INK));
    }
    for room in &rooms.outlines {
        let outline: Vec<Point> = room.polygon.iter().map(|&corner| page.at(corner.into())).collect();
        drawing.area(&outline, Ink::solid(FLOOR));
    }
    for opening in &rooms.openings {
        draw_opening(&mut drawing, &page, &rooms.walls[opening.walls[0]], opening);
    }
    for room in &rooms.outlines {
        write_name(&mut drawing, &page, room);
    }
    drawing
}

/// Placement of the building on the page.
struct Page {
    low: DVec2,
    high: DVec2,
}

impl Page {
    fn at(&self, p: DVec2) -> Point {
        [((p.x - self.low.x) * SCALE) as f32, ((self.high.y - p.y) * SCALE) as f32]
    }

    /// From one point of a face to another, and behind it.
    fn strip(&self, from: DVec2, to: DVec2, wall: &WallFace, depth_m: f64) -> [Point; 4] {
        let behind = -DVec2::from(wall.inward) * depth_m;
        [from, to, to + behind, from + behind].map(|p| self.at(p))
    }
}

fn ends(wall: &WallFace) -> [DVec2; 2] {
    [wall.from.into(), wall.to.into()]
}

fn draw_opening(drawing: &mut Drawing, page: &Page, wall: &WallFace, opening: &WallOpening) {
    // The lower edge, from right to left for someone in the room.
    let [left, right, ..] = opening.corners.map(|[x, y, _]| DVec2::new(x, y));
    let inward = DVec2::from(wall.inward);
    drawing.area(
        &page.strip(right, left, wall, wall.thickness_m),
        Ink::solid(if opening.kind == OpeningKind::Window { PAPER } else { FLOOR }),
    );
    match opening.kind {
        OpeningKind::Window => {
            for depth in [0.0, 0.4, 0.6, 1.0].map(|share| share * wall.thickness_m) {
                let run = [left, right].map(|p| page.at(p - inward * depth));
                drawing.line(&run, 1.2, Ink::solid(INK));
            }
        }
        OpeningKind::Door => {
            // Drawn open at a right angle, regardless of its angle.
            let is_left = opening.leaf.is_none_or(|leaf| leaf.hinge == Hinge::Left);
            let (hinge, free) = if is_left { (left, right) } else { (right, left) };
            let quarter = |i: usize| {
                let turn = FRAC_PI_2 * i as f64 / ARC as f64;
                page.at(hinge + (free - hinge) * turn.cos() + inward * hinge.distance(free) * turn.sin())
            };
            drawing.line(&[page.at(hinge), quarter(ARC)], 1.6, Ink::solid(INK));
            drawing.line(&(0..=ARC).map(quarter).collect::<Vec<_>>(), 0.8, Ink::solid(SOFT));
        }
        OpeningKind::Passage => {}
    }
}

fn write_name(drawing: &mut Drawing, page: &Page, room: &RoomOutline) {
    let middle = room.polygon.iter().map(|&corner| DVec2::from(corner)).sum::<DVec2>() / room.polygon.len() as f64;
    let [x, y] = page.at(middle);
    let line = |words: String, y: f32, height: f32, ink: Color| Text {
        at: [x, y],
        words,
        height,
        bold: false,
        anchor: Anchor::Middle,
        ink: Ink::solid(ink),
        halo: Some(Ink::solid(FLOOR)),
    };
    drawing.write(line(room.name.clone(), y, 11.0, INK));
    drawing.write(line(format!("{:.1} m²", room.area_m2()), y + 18.0, 9.0, SOFT));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rooms_are_drawn_to_scale_with_names_and_openings() {
        let polygon = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]];
        let room = RoomOutline { name: "study_1".into(), kind: "study".into(), polygon, floor_z_m: 0.0, ceiling_z_m: 2.5 };
        let mut rooms = Rooms::default();
        rooms.push_room(room, &[(0.4, true); 4]);
        let corners = [[3.0, 0.0, 0.9], [1.0, 0.0, 0.9], [1.0, 0.0, 2.1], [3.0, 0.0, 2.1]];
        rooms.openings.push(WallOpening { kind: OpeningKind::Window, walls: vec![0], corners, leaf: None });
        let page = drawing(&rooms);
        // Two metres more than the room in each direction: walls and margins on both sides.
        assert_eq!([page.width, page.height], [6.0, 5.0].map(|metres: f64| (metres * SCALE) as u32));
        let svg = rooms_svg(&rooms);
        assert!(svg.contains("study_1") && svg.contains("12.0 m²") && svg.contains("prefers-color-scheme:dark"), "{svg}");
    }
}
