//! Openings that doors and windows cut out of walls.

use super::outline::Outline;
use super::surface::{Surface, lifted};
use super::xml::Element;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::DVec2;

/// Openings and walls that differ by more than this sine do not belong together.
const PARALLEL: f64 = 0.1;

/// A box that is cut out of walls; centimetres, plan coordinates.
pub(super) struct Opening {
    center: DVec2,
    /// Unit vector along its width.
    along: DVec2,
    half_width: f64,
    half_depth: f64,
    /// From and to which height.
    pub up: [f64; 2],
}

impl Opening {
    /// The opening of a door or window at `elevation` of the home.
    pub fn read(element: Element, elevation: f64, a: &mut Assembly) -> Result<Self, ImportError> {
        let (width, depth, height) = (element.length("width")?, element.length("depth")?, element.length("height")?);
        let angle = element.number_or("angle", 0.0)?;
        let share = |name, default| Ok::<_, ImportError>(element.number_or(name, default)?.clamp(0.0, 1.0));
        let (wide, mut left) = (share("wallWidth", 1.0)?, share("wallLeft", 0.0)?);
        if element.flag("modelMirrored", false) {
            left = 1.0 - left - wide;
        }
        let (high, top) = (share("wallHeight", 1.0)?, share("wallTop", 0.0)?);
        let rectangle = |shape: &str| shape.split_whitespace().collect::<String>().eq_ignore_ascii_case("M0,0v1h1v-1z");
        if element.text("cutOutShape").is_some_and(|shape| !rectangle(shape)) {
            a.warn(element.place(), "its opening is not a rectangle; the rectangle around it was cut out of the wall");
        }
        let along = DVec2::from_angle(angle);
        let middle = (left + 0.5 * wide - 0.5) * width;
        let upper = elevation + height * (1.0 - top);
        Ok(Self {
            center: DVec2::new(element.required("x")?, element.required("y")?) + along * middle,
            along,
            half_width: 0.5 * wide * width,
            half_depth: 0.5 * depth,
            up: [upper - high * height, upper],
        })
    }

    /// A point relative to the opening: along its width, and across.
    fn local(&self, p: DVec2) -> DVec2 {
        DVec2::new(self.along.dot(p - self.center), self.along.perp_dot(p - self.center))
    }

    /// True for walls that the opening is in: its depth reaches into the wall, and a straight wall has its direction.
    pub fn cuts(&self, start: DVec2, end: DVec2, outline: &Outline, thickness: f64) -> bool {
        let straight = outline.left.len() == 2;
        if straight && (end - start).normalize_or_zero().perp_dot(self.along).abs() > PARALLEL {
            return false;
        }
        let middle: Vec<DVec2> = outline.left.iter().zip(&outline.right).map(|(l, r)| 0.5 * (*l + *r)).collect();
        let reach = self.half_depth + 0.5 * thickness;
        middle.windows(2).any(|p| self.clip(p[0], p[1], reach).is_some())
    }

    /// The share of the way from `a` to `b` that the opening takes. It goes through the whole wall, however thin the door is.
    pub fn along(&self, a: DVec2, b: DVec2) -> Option<[f64; 2]> {
        self.clip(a, b, f64::MAX.sqrt()).filter(|_| self.is_along(a, b))
    }

    fn is_along(&self, a: DVec2, b: DVec2) -> bool {
        // Faces across the opening, such as the ends of its wall, are not cut.
        (b - a).normalize_or_zero().dot(self.along).abs() > 0.8
    }

    fn clip(&self, a: DVec2, b: DVec2, reach: f64) -> Option<[f64; 2]> {
        let (p, q) = (self.local(a), self.local(b));
        let mut range = [0.0f64, 1.0];
        for (from, to, limit) in [(p.x, q.x, self.half_width), (p.y, q.y, reach)] {
            let step = to - from;
            if step.abs() < 1e-9 {
                if from.abs() > limit {
                    return None;
                }
                continue;
            }
            let mut at = [(-limit - from) / step, (limit - from) / step];
            at.sort_by(f64::total_cmp);
            range = [range[0].max(at[0]), range[1].min(at[1])];
        }
        (range[1] - range[0] > 1e-6).then_some(range)
    }

    /// Adds the visible inside of the wall around the hole: its sides, sill and head.
    pub fn add_reveals(&self, outline: &Outline, bottom: f64, tops: [f64; 2], surface: &mut Surface) {
        let cross = |points: &[DVec2]| -> Vec<DVec2> {
            let mut inside: Vec<DVec2> = Vec::new();
            for pair in points.windows(2) {
                if let Some([s, t]) = self.along(pair[0], pair[1]) {
                    let from = pair[0].lerp(pair[1], s);
                    if inside.last().is_none_or(|l| l.distance(from) > 1e-6) {
                        inside.push(from);
                    }
                    inside.push(pair[0].lerp(pair[1], t));
                }
            }
            inside
        };
        let (left, right) = (cross(&outline.left), cross(&outline.right));
        let (Some(&l0), Some(&r0), Some(&l1), Some(&r1)) = (left.first(), right.first(), left.last(), right.last()) else { return };
        let head = tops[0].min(tops[1]);
        let (from, to) = (self.up[0].max(bottom), self.up[1].min(head));
        if to <= from {
            return;
        }
        let quad = |a: DVec2, b: DVec2, surface: &mut Surface| {
            let corners = [(a, from, 0.0), (b, from, 1.0), (b, to, 1.0), (a, to, 0.0)];
            let width = a.distance(b);
            surface.polygon(&corners.map(|(p, z, u)| (lifted(p, z), DVec2::new(u * width, z))));
        };
        quad(l0, r0, surface);
        quad(r1, l1, surface);
        let levels = [(self.up[0] > bottom, from), (self.up[1] < head, to)];
        for (_, z) in levels.into_iter().filter(|(shown, _)| *shown) {
            for i in 0..left.len().min(right.len()).saturating_sub(1) {
                let corners = [left[i], right[i], right[i + 1], left[i + 1]];
                surface.polygon(&corners.map(|p| (lifted(p, z), p)));
            }
        }
    }
}
