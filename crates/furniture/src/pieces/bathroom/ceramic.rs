//! Sanitary ware as bodies through horizontal sections: rounded rectangles and eggs, one above the other, with smooth transitions, solid or
//! hollow, and the waste that goes into them. All sections of a body have the same number of points; y is to the front, z up.

use crate::pieces::form::{all, rounded_rectangle};
use crate::shape::{Reshape, grid};
use enfilade_geometry::Mesh;
use enfilade_math::{Vec2, Vec3};
use std::f32::consts::TAU;

/// A horizontal section of a body.
#[derive(Clone, Debug)]
pub struct Section {
    /// The outline about the middle, counter-clockwise, with the same number of points in each section of a body.
    pub outline: Vec<Vec2>,
    /// Position of its middle along y.
    pub y: f32,
    /// Height of the section.
    pub z: f32,
}

impl Section {
    /// The points of its outline.
    #[cfg(test)]
    pub fn points(&self) -> impl Iterator<Item = Vec3> {
        self.outline.iter().map(move |p| Vec3::new(p.x, p.y + self.y, self.z))
    }
}

/// A rectangle with round corners.
pub fn rectangle(width: f32, depth: f32, radius: f32, y: f32, z: f32) -> Section {
    Section { outline: rounded_rectangle(width, depth, radius.min(0.499 * width.min(depth)), 8), y, z }
}

/// An egg: round to the front, nearly straight at the back.
pub fn egg(width: f32, depth: f32, y: f32, z: f32) -> Section {
    const N: usize = 44;
    let outline = (0..N)
        .map(|k| {
            let (sin, cos) = (k as f32 / N as f32 * TAU).sin_cos();
            let blunt = |v: f32, p: f32| v.signum() * v.abs().powf(p);
            let power = if sin > 0.0 { 0.95 } else { 0.45 };
            0.5 * Vec2::new(width * blunt(cos, power), depth * blunt(sin, power))
        })
        .collect();
    Section { outline, y, z }
}

/// The body through `sections`, closed at both ends; they run up the outside and, if it is hollow, down the inside.
pub fn body(sections: &[Section]) -> Mesh {
    let (n, last) = (sections[0].outline.len(), sections.len() + 1);
    let point = |i: usize, j: usize| {
        let section = &sections[j.clamp(1, last - 1) - 1];
        let p = if j == 0 || j == last { Vec2::ZERO } else { section.outline[i % n] };
        Vec3::new(p.x, p.y + section.y, section.z)
    };
    let uv = |i: usize, j: usize| {
        let p = point(i, j);
        Vec2::new(p.x + 0.37 * p.y, p.y + p.z)
    };
    grid(n, last, point, uv).smoothed(50.0)
}

/// Sections between `from` and `to` along a quarter of an ellipse that leaves `from` vertically if `upright`, and horizontally otherwise.
pub fn rounding(from: &Section, to: &Section, steps: usize, upright: bool) -> Vec<Section> {
    (1..steps)
        .map(|k| {
            let (sin, cos) = (0.25 * TAU * k as f32 / steps as f32).sin_cos();
            let (across, up) = if upright { (1.0 - cos, sin) } else { (sin, 1.0 - cos) };
            let outline = from.outline.iter().zip(&to.outline).map(|(a, b)| a.lerp(*b, across)).collect();
            Section { outline, y: from.y + (to.y - from.y) * across, z: from.z + (to.z - from.z) * up }
        })
        .collect()
}

/// A hollow body: `outside` goes up to the rim, `inside` down from it, each smoothed between its sections where they are far apart.
pub fn hollow(outside: &[Section], inside: &[Section]) -> Mesh {
    let mut sections = outside.to_vec();
    sections.extend(lining(inside));
    body(&sections)
}

/// The sections of a hollow body's `inside`; the last step, from the wall to the floor, is round.
pub fn lining(inside: &[Section]) -> Vec<Section> {
    let [upper @ .., wall, floor] = inside else { return inside.to_vec() };
    let mut sections = upper.to_vec();
    sections.push(wall.clone());
    sections.extend(rounding(wall, floor, 7, true));
    sections.push(floor.clone());
    sections
}

/// The waste of a basin or tub: a cover and its ring, its middle at the origin.
pub fn waste(radius: f32) -> Mesh {
    let ring = [[0.0, 0.0], [radius, 0.0], [radius, 0.002], [0.8 * radius, 0.004], [0.7 * radius, 0.002], [0.0, 0.002]];
    let cover = [[0.0, 0.0025], [0.66 * radius, 0.0025], [0.62 * radius, 0.006], [0.0, 0.007]];
    all([crate::pieces::form::turned(&ring, 28), crate::pieces::form::turned(&cover, 28)])
}
