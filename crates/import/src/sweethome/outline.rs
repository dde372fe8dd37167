//! Walls on the plan: their outlines, and how they join.

use super::xml::Element;
use crate::ImportError;
use enfilade_math::DVec2;
use std::collections::HashMap;

/// A round wall turns at most by this, radians: a whole circle has no ends.
const MAX_ARC_RAD: f64 = 0.999 * std::f64::consts::TAU;

/// A wall as the file has it; centimetres, plan coordinates (y down the plan).
pub(super) struct Wall<'x> {
    pub element: Element<'x>,
    pub start: DVec2,
    pub end: DVec2,
    pub thickness: f64,
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
    /// Reads a wall of a level. `None` for those without length or thickness, which have no surface.
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
            arc: element.number_or("arcExtent", 0.0)?.clamp(-MAX_ARC_RAD, MAX_ARC_RAD),
            bottom,
            tops: [elevation + height, elevation + at_end],
            level: element.text("level"),
            joined: [element.text("wallAtStart"), element.text("wallAtEnd")],
        };
        Ok((start.distance(end) > 1e-3 && thickness > 0.0 && height.max(at_end) > 0.0).then_some(wall))
    }

    /// Ends of the wall on the plan.
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
