//! Walls: their outlines, how they join, and their faces with what doors and windows cut out.

use super::home::Home;
use super::opening::Opening;
use super::paint::Paint;
use super::surface::{Hole, Surface, without_holes};
use super::xml::Element;
use crate::ImportError;
use enfilade_math::{DVec2, DVec3};
use std::collections::HashMap;

/// The most that a round wall turns, radians: a whole circle has no ends.
const MOST_ARC: f64 = 0.999 * std::f64::consts::TAU;

/// A wall as the file has it; centimetres, plan coordinates (y down the plan).
pub(super) struct Wall<'x> {
    element: Element<'x>,
    start: DVec2,
    end: DVec2,
    thickness: f64,
    arc: f64,
    /// Heights of the lower edge, and of the upper one at both ends.
    pub bottom: f64,
    pub tops: [f64; 2],
    pub level: Option<&'x str>,
    joined: [Option<&'x str>; 2],
}

/// Points of both sides from the wall's start to its end; seen along the wall on the plan, left and right of it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Outline {
    pub left: Vec<DVec2>,
    pub right: Vec<DVec2>,
}

impl<'x> Wall<'x> {
    /// A wall that stands on a level. `None` for those without length or thickness, which have no surface.
    pub fn read(element: Element<'x>, elevation: f64, bottom: f64, default_height: f64) -> Result<Option<Self>, ImportError> {
        let point = |x: &str, y: &str| Ok::<_, ImportError>(DVec2::new(element.required(x)?, element.required(y)?));
        let (start, end) = (point("xStart", "yStart")?, point("xEnd", "yEnd")?);
        let thickness = element.required("thickness")?;
        let height = element.number_or("height", default_height)?;
        let at_end = element.number_or("heightAtEnd", height)?;
        let wall = Self {
            element,
            start,
            end,
            thickness,
            arc: element.number_or("arcExtent", 0.0)?.clamp(-MOST_ARC, MOST_ARC),
            bottom,
            tops: [elevation + height, elevation + at_end],
            level: element.text("level"),
            joined: [element.text("wallAtStart"), element.text("wallAtEnd")],
        };
        Ok((start.distance(end) > 1e-3 && thickness > 0.0 && height.max(at_end) > 0.0).then_some(wall))
    }

    /// Its two ends on the plan.
    pub fn ends(&self) -> [DVec2; 2] {
        [self.start, self.end]
    }

    /// The outline of the wall by itself, `extra` thicker on the left and the right.
    fn outline(&self, extra: [f64; 2]) -> Outline {
        let along = self.end - self.start;
        let to_left = DVec2::new(along.y, -along.x).normalize();
        let [left, right] = extra.map(|e| 0.5 * self.thickness + e);
        if self.arc.abs() < 1e-6 {
            let both = [self.start, self.end];
            return Outline { left: both.map(|p| p + to_left * left).to_vec(), right: both.map(|p| p - to_left * right).to_vec() };
        }
        let half = 0.5 * along.length();
        let center = 0.5 * (self.start + self.end) - to_left * (half / (0.5 * self.arc).tan());
        let from_center = self.start - center;
        // As many steps as Sweet Home 3D takes: the square root of the outer arc's length.
        let length = (from_center.length() + 0.5 * self.thickness) * self.arc.abs();
        let steps = (length.sqrt().ceil() as usize).clamp(2, 360);
        let mut outline = Outline { left: Vec::new(), right: Vec::new() };
        for i in 0..=steps {
            let turned = DVec2::from_angle(self.arc * i as f64 / steps as f64).rotate(from_center);
            let outward = turned.normalize_or_zero() * self.arc.signum();
            outline.left.push(center + turned + outward * left);
            outline.right.push(center + turned - outward * right);
        }
        outline
    }
}

/// All walls by their ids, so that they find those that they are joined to.
pub(super) struct Walls<'x> {
    pub list: Vec<Wall<'x>>,
    by_id: HashMap<&'x str, usize>,
}

impl<'x> Walls<'x> {
    pub fn new(list: Vec<Wall<'x>>) -> Self {
        let by_id = list.iter().enumerate().filter_map(|(i, w)| Some((w.element.text("id")?, i))).collect();
        Self { list, by_id }
    }

    /// The outline of a wall, its corners drawn to where its sides meet those of the walls that it is joined to.
    pub fn outline(&self, index: usize, extra: [f64; 2]) -> Outline {
        let wall = &self.list[index];
        let mut outline = wall.outline(extra);
        let id = wall.element.text("id");
        for (k, joined) in wall.joined.iter().enumerate() {
            let Some(&other) = joined.and_then(|id| self.by_id.get(id)).filter(|&&o| o != index) else { continue };
            let there = &self.list[other];
            let corner = if k == 0 { wall.start } else { wall.end };
            let ends = [there.start, there.end].map(|p| p.distance_squared(corner));
            let back = [0, 1].map(|e| id.is_some() && there.joined[e] == id);
            let at = match back {
                [true, false] => 0,
                [false, true] => 1,
                _ if ends[0] < ends[1] => 0,
                _ => 1,
            };
            let theirs = there.outline(if at == k { [extra[1], extra[0]] } else { extra });
            // Two walls that meet with their starts (or their ends) have each other's left on their right.
            let (their_left, their_right) = if at == k { (&theirs.right, &theirs.left) } else { (&theirs.left, &theirs.right) };
            join(&mut outline.left, k, their_left, at, 2.0 * wall.thickness);
            join(&mut outline.right, k, their_right, at, 2.0 * wall.thickness);
        }
        outline
    }
}

/// Moves the first (`end` 0) or last point of a side to where it meets the side of another wall, if that is not further than `limit`.
fn join(side: &mut [DVec2], end: usize, other: &[DVec2], other_end: usize, limit: f64) {
    let pick = |points: &[DVec2], end: usize| match end {
        0 => (points[0], points[1]),
        _ => (points[points.len() - 1], points[points.len() - 2]),
    };
    let ((p, inner), (q, other_inner)) = (pick(side, end), pick(other, other_end));
    let (a, b) = (inner - p, other_inner - q);
    let cross = a.perp_dot(b);
    if cross.abs() <= 4e-3 * a.length() * b.length() {
        return;
    }
    let met = p + a * ((q - p).perp_dot(b) / cross);
    if met.distance(p) < limit {
        let at = if end == 0 { 0 } else { side.len() - 1 };
        side[at] = met;
    }
}

/// One upright side: its points from left to right as seen from its front, and how far along the wall each lies.
struct Side<'s> {
    points: &'s [DVec2],
    /// Left of the wall: its front lies to the left of its points.
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

/// A point of the plan at a height: y up, the plan's y as z.
pub(super) fn lifted(p: DVec2, height: f64) -> DVec3 {
    DVec3::new(p.x, height, p.y)
}
