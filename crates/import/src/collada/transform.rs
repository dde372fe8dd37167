//! A node's transforms in their order, at rest and over time.

use super::animation::{Animations, Channel};
use super::curve::Segment;
use super::document::{Node, called, several, width};
use crate::ImportError;
use crate::assembly::Assembly;
use crate::motion::{Side, between_placements};
use enfilade_math::{DAffine3, DMat3, DMat4, DVec3};

/// The transforms of a node.
pub(super) struct Transforms<'a> {
    list: Vec<Transform<'a>>,
}

struct Transform<'a> {
    tag: &'a str,
    numbers: Vec<f64>,
    channels: &'a [Channel],
}

impl<'a> Transforms<'a> {
    /// The transforms of a node.
    ///
    /// # Errors
    /// When a transform has too few numbers, or such that make no sense.
    pub(super) fn of<'d: 'a>(node: Node<'d>, animations: &'a Animations, a: &Assembly) -> Result<Self, ImportError> {
        let mut list = Vec::new();
        for element in node.children().filter(roxmltree::Node::is_element) {
            let tag = element.tag_name().name();
            let Some(width) = width(tag) else { continue };
            let problem =
                || format!("found a <{tag}> that is no transform; expected as many finite numbers as COLLADA has; export the file again");
            let numbers = several(element, width).filter(|numbers| placement(tag, numbers).is_some());
            let numbers = numbers.ok_or_else(|| a.malformed(called(node), problem()))?;
            list.push(Transform { tag, numbers, channels: animations.of(element) });
        }
        Ok(Self { list })
    }

    /// The product of all at rest.
    pub(super) fn rest(&self) -> DAffine3 {
        self.list.iter().fold(DAffine3::IDENTITY, |all, transform| all * transform.of(&transform.numbers))
    }

    /// The product of all at a moment.
    pub(super) fn at(&self, time_s: f64, side: Side) -> DAffine3 {
        self.list.iter().fold(DAffine3::IDENTITY, |all, transform| all * transform.at(time_s, side))
    }

    /// The moments between which they change smoothly; empty where they stay.
    pub(super) fn moments(&self) -> Vec<f64> {
        let all = self.list.iter().flat_map(|transform| transform.channels.iter().map(move |channel| (transform.tag, channel)));
        all.flat_map(|(tag, channel)| channel.curve.moments(channel.number_within(3).filter(|_| tag == "rotate"))).collect()
    }
}

impl Transform<'_> {
    fn at(&self, time_s: f64, side: Side) -> DAffine3 {
        if let ("matrix", [Channel { first: None, curve }]) = (self.tag, self.channels) {
            let (from, to, share) = curve.around(time_s, side);
            let between = from != to && curve.segments[from] == Segment::Line;
            return if between {
                between_placements(&self.of(&curve.values[from]), &self.of(&curve.values[to]), share)
            } else {
                self.of(&curve.at(time_s, side))
            };
        }
        let mut numbers = self.numbers.clone();
        for channel in self.channels {
            let first = channel.first.unwrap_or(0);
            numbers.iter_mut().skip(first).zip(channel.curve.at(time_s, side)).for_each(|(number, now)| *number = now);
        }
        self.of(&numbers)
    }

    /// The placement of numbers; of such that make no sense that of rest.
    fn of(&self, numbers: &[f64]) -> DAffine3 {
        placement(self.tag, numbers).or_else(|| placement(self.tag, &self.numbers)).unwrap_or(DAffine3::IDENTITY)
    }
}

/// The placement that an element of this name states by as many numbers as it takes.
fn placement(tag: &str, v: &[f64]) -> Option<DAffine3> {
    let vector = |at: usize| DVec3::new(v[at], v[at + 1], v[at + 2]);
    Some(match tag {
        "matrix" => affine(v.first_chunk()?),
        "translate" => DAffine3::from_translation(vector(0)),
        "scale" => DAffine3::from_scale(vector(0)),
        "rotate" => {
            let axis = vector(0).try_normalize();
            axis.map_or(DAffine3::IDENTITY, |axis| DAffine3::from_axis_angle(axis, v[3].to_radians()))
        }
        "lookat" => {
            let [eye, target, up] = [0, 3, 6].map(vector);
            // −z looks at the target.
            let axes = crate::assembly::orthonormal(up, eye - target)?;
            DAffine3::from_mat3_translation(axes, eye)
        }
        _ => skewed(v[0], vector(1), vector(4))?,
    })
}

/// Sixteen numbers row by row as a placement; the last row is not used.
pub(super) fn affine(m: &[f64; 16]) -> DAffine3 {
    let m = DMat4::from_cols_array(m).transpose();
    DAffine3::from_mat4(m)
}

/// RenderMan's skew: by an angle in degrees, the axis `from` is turned towards `to`.
fn skewed(degrees: f64, from: DVec3, to: DVec3) -> Option<DAffine3> {
    let (from, to) = (from.try_normalize()?, to.try_normalize()?);
    // The component of `from` at a right angle to `to`.
    let across = (from - to * from.dot(to)).try_normalize()?;
    let (along, over) = (from.dot(to), from.dot(across));
    let turned = (along.atan2(over) + degrees.to_radians()).tan();
    let shear = turned - along / over;
    let outer = |column: f64| to * (shear * column);
    Some(DAffine3::from_mat3(DMat3::IDENTITY + DMat3::from_cols(outer(across.x), outer(across.y), outer(across.z))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn skew_keeps_what_lies_along_the_axis_it_turns_to() {
        // 45° from y towards x: (0, 1, 0) becomes (1, 1, 0).
        let m = skewed(45.0, DVec3::Y, DVec3::X).unwrap();
        assert!((m.transform_point3(DVec3::Y) - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-12);
        assert!((m.transform_point3(DVec3::X) - DVec3::X).length() < 1e-12 && (m.transform_point3(DVec3::Z) - DVec3::Z).length() < 1e-12);
    }

    #[test]
    fn a_view_looks_from_its_eye_at_its_target() {
        let m = placement("lookat", &[1.0, 2.0, 3.0, 1.0, 2.0, 0.0, 0.0, 1.0, 0.0]).unwrap();
        assert_eq!(
            (m.translation, m.transform_vector3(DVec3::NEG_Z), m.transform_vector3(DVec3::Y)),
            (DVec3::new(1.0, 2.0, 3.0), DVec3::NEG_Z, DVec3::Y)
        );
    }
}
