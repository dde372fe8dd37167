//! The faces of walls: both sides, ends, tops and baseboards, with the holes of doors and windows.

use super::home::Home;
use super::opening::Opening;
use super::outline::{Outline, Wall, Walls};
use super::paint::Paint;
use super::surface::{Hole, Surface, lifted, without_holes};
use crate::ImportError;
use enfilade_math::DVec2;

/// One upright side: its points from left to right as seen from its front, and the distance of each along the wall.
struct Side<'s> {
    points: &'s [DVec2],
    /// Left of the wall: its front is to the left of its points.
    is_left: bool,
    bottom: f64,
    tops: [f64; 2],
}

/// Adds the parts of a wall: both sides with half of the ends each, the top with what holes show of the inside, and baseboards.
pub(super) fn add(walls: &Walls, index: usize, openings: &[Opening], home: &mut Home) -> Result<(), ImportError> {
    let wall = &walls.list[index];
    let name = format!("wall_{}", index + 1);
    let outline = walls.outline(index, [0.0; 2]);
    let cuts: Vec<&Opening> = openings.iter().filter(|o| o.cuts(wall.start, wall.end, &outline, wall.thickness)).collect();
    for (is_left, side, points) in [(true, "left", &outline.left), (false, "right", &outline.right)] {
        let mut surface = Surface::default();
        Side { points, is_left, bottom: wall.bottom, tops: wall.tops }.add(&cuts, &mut surface);
        add_ends(&outline, wall, is_left, &cuts, &mut surface);
        let paint = Paint {
            color: wall.element.color(&format!("{side}SideColor"))?,
            texture: wall.element.child("texture", Some(&format!("{side}SideTexture"))),
            shininess: wall.element.number_or(&format!("{side}SideShininess"), 0.0)?,
        };
        home.push(&format!("{name}.{side}"), surface, paint)?;
        add_baseboard(walls, index, side, &cuts, home)?;
    }
    let mut surface = Surface::default();
    add_top(&outline, wall, &mut surface);
    cuts.iter().for_each(|cut| cut.add_reveals(&outline, wall.bottom, wall.tops, &mut surface));
    let paint = Paint { color: wall.element.color("topColor")?, texture: None, shininess: 0.0 };
    home.push(&format!("{name}.top"), surface, paint)
}

impl Side<'_> {
    fn add(&self, cuts: &[&Opening], surface: &mut Surface) {
        let lengths: Vec<f64> = self.points.windows(2).map(|p| p[0].distance(p[1])).collect();
        let total: f64 = lengths.iter().sum::<f64>().max(1e-9);
        let top = |s: f64| self.tops[0] + s / total * (self.tops[1] - self.tops[0]);
        let mut s = 0.0;
        for (pair, length) in self.points.windows(2).zip(lengths) {
            let (a, b) = (pair[0], pair[1]);
            let holes: Vec<Hole> = cuts.iter().filter_map(|c| Some(Hole { along: c.along(a, b)?, up: c.up })).collect();
            for polygon in without_holes(self.bottom, [top(s), top(s + length)], &holes) {
                // The picture runs to the right as one faces the wall.
                let sign = if self.is_left { -1.0 } else { 1.0 };
                let corner = |p: &DVec2| (lifted(a.lerp(b, p.x), p.y), DVec2::new(sign * (s + p.x * length), p.y));
                let mut corners: Vec<_> = polygon.iter().map(corner).collect();
                if self.is_left {
                    corners.reverse();
                }
                surface.polygon(&corners);
            }
            s += length;
        }
    }
}

/// Half of the face at each end of the wall, on one side of its middle.
fn add_ends(outline: &Outline, wall: &Wall, is_left: bool, cuts: &[&Opening], surface: &mut Surface) {
    let side = if is_left { &outline.left } else { &outline.right };
    let last = outline.left.len() - 1;
    for (at, top) in [(0, wall.tops[0]), (last, wall.tops[1])] {
        let middle = 0.5 * (outline.left[at] + outline.right[at]);
        // Seen from outside, the start has its left side on the left.
        let points = if (at == 0) == is_left { [side[at], middle] } else { [middle, side[at]] };
        Side { points: &points, is_left: false, bottom: wall.bottom, tops: [top; 2] }.add(cuts, surface);
    }
}

fn add_top(outline: &Outline, wall: &Wall, surface: &mut Surface) {
    let lengths: Vec<f64> = outline.left.windows(2).map(|p| p[0].distance(p[1])).collect();
    let total = lengths.iter().sum::<f64>().max(1e-9);
    let mut s = 0.0;
    for (i, length) in lengths.into_iter().enumerate() {
        let at = |s: f64| wall.tops[0] + s / total * (wall.tops[1] - wall.tops[0]);
        let (near, far) = (at(s), at(s + length));
        let corners = [(outline.left[i], near), (outline.right[i], near), (outline.right[i + 1], far), (outline.left[i + 1], far)];
        surface.polygon(&corners.map(|(p, z)| (lifted(p, z), p)));
        s += length;
    }
}

fn add_baseboard(walls: &Walls, index: usize, side: &str, cuts: &[&Opening], home: &mut Home) -> Result<(), ImportError> {
    let wall = &walls.list[index];
    let Some(board) = wall.element.child("baseboard", Some(&format!("{side}SideBaseboard"))) else { return Ok(()) };
    let (thickness, height) = (board.length("thickness")?, board.length("height")?);
    let is_left = side == "left";
    let inner = walls.outline(index, [0.0; 2]);
    let outer = walls.outline(index, if is_left { [thickness, 0.0] } else { [0.0, thickness] });
    let (inner, outer) = if is_left { (inner.left, outer.left) } else { (inner.right, outer.right) };
    // It stands on the floor of its level, which for upper ones is above the wall's lower edge.
    let floor = home.elevation_of(wall.level);
    let top = floor + height;
    let mut surface = Surface::default();
    Side { points: &outer, is_left, bottom: floor, tops: [top; 2] }.add(cuts, &mut surface);
    for i in 0..inner.len() - 1 {
        // Its upper face, as far as no door interrupts it.
        let holes: Vec<Hole> = cuts.iter().filter_map(|c| Some(Hole { along: c.along(outer[i], outer[i + 1])?, up: c.up })).collect();
        for piece in
            without_holes(0.0, [1.0; 2], &holes.iter().filter(|h| h.up[0] < top).map(|h| Hole { up: [0.0, 1.0], ..*h }).collect::<Vec<_>>())
        {
            let at = |p: &DVec2| outer[i].lerp(outer[i + 1], p.x).lerp(inner[i].lerp(inner[i + 1], p.x), p.y);
            let mut corners: Vec<_> = piece.iter().map(|p| (lifted(at(p), top), at(p))).collect();
            if is_left {
                corners.reverse();
            }
            surface.polygon(&corners);
        }
    }
    let own = board.color("color")?;
    let texture = board.child("texture", None);
    let inherits = own.is_none() && texture.is_none();
    let paint = Paint {
        color: if inherits { wall.element.color(&format!("{side}SideColor"))? } else { own },
        texture: if inherits { wall.element.child("texture", Some(&format!("{side}SideTexture"))) } else { texture },
        shininess: 0.0,
    };
    home.push(&format!("wall_{}.{side}_baseboard", index + 1), surface, paint)
}
