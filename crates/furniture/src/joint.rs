//! Joints of furniture and doors: what moves, about or along which axis, and how far. Pieces declare them where they build the parts that
//! move; [`Builder::joint`](crate::Builder::joint) makes a body of the scene of each.

use enfilade_math::{DAffine3, DVec3, Vec3};
use enfilade_options::words;
use enfilade_scene::BodyStates;

words! {
    /// Things that have joints.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
    pub enum JointKind {
        /// The leaf of a door between rooms.
        Door = "door",
        /// A sash of a window.
        Window = "window",
        /// An upright door of furniture or of an appliance, hinged or sliding.
        Cupboard = "cupboard",
        /// A drawer.
        Drawer = "drawer",
        /// A front that tilts about its lower edge.
        Flap = "flap",
        /// A lid that is lifted at its front.
        Lid = "lid",
        /// The lever of a tap.
        Tap = "tap",
        /// A seat that turns on its foot.
        Chair = "chair",
    }
}

/// Angle to which doors of furniture open, radians: 110 degrees, as cup hinges do.
pub const WIDE: f64 = 1.92;
/// Angle to which doors between rooms open, radians: 100 degrees, before they meet the corner of their wall.
const AJAR: f64 = 1.745;
/// A right angle, radians.
const RIGHT: f64 = std::f64::consts::FRAC_PI_2;

/// The way that something moves, in its object's own space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axis {
    /// Turns about a line: counter-clockwise seen against `along` opens.
    Hinge {
        /// A point on the line.
        point: DVec3,
        /// Direction of the line, unit length.
        along: DVec3,
    },
    /// Slides in this direction, unit length, to open.
    Slide(DVec3),
}

/// Declaration of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// The thing that moves.
    pub kind: JointKind,
    /// How it moves.
    pub axis: Axis,
    /// States closed and wide open, radians or metres, relative to the state in which it is built.
    pub limits: [f64; 2],
}

/// A joint of an object in a scene, by the body that has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Jointed {
    /// Name of the body: that of the object, `/`, and the name of what moves.
    pub body: String,
    /// The thing that moves.
    pub kind: JointKind,
}

impl Joint {
    /// A drawer that is pulled out to +y by `length` metres.
    pub fn drawer(length: f32) -> Self {
        Self { kind: JointKind::Drawer, axis: Axis::Slide(DVec3::Y), limits: [0.0, length.into()] }
    }

    /// An upright door that faces +y, hinged at the edge of its face at `x`, `y`; `side` is −1 where that is its edge at smaller x, +1 where
    /// it is the other.
    pub fn cupboard(x: f32, y: f32, side: f32) -> Self {
        Self { kind: JointKind::Cupboard, axis: upright(x, y, side), limits: [0.0, WIDE] }
    }

    /// A door that slides along x by `by` metres, to −x where that is negative.
    pub fn sliding(by: f32) -> Self {
        Self { kind: JointKind::Cupboard, axis: Axis::Slide(DVec3::X * f64::from(by.signum())), limits: [0.0, by.abs().into()] }
    }

    /// A front that faces +y and tilts to the front by `most` radians, hinged at the lower edge of its face at `y`, `z`.
    pub fn flap(y: f32, z: f32, most: f64) -> Self {
        Self { kind: JointKind::Flap, axis: Self::across(y, z, -1.0), limits: [0.0, most] }
    }

    /// A front that tilts until it is level.
    pub fn level_flap(y: f32, z: f32) -> Self {
        Self::flap(y, z, RIGHT)
    }

    /// A lid that is lifted by `most` radians about its rear edge at `y`, `z`; it is built closed, or `open`.
    pub fn lid(y: f32, z: f32, most: f64, open: bool) -> Self {
        let limits = if open { [-most, 0.0] } else { [0.0, most] };
        Self { kind: JointKind::Lid, axis: Self::across(y, z, 1.0), limits }
    }

    /// A sash that opens to +y by a right angle, hinged as [`Joint::cupboard`] is.
    pub fn window(x: f32, y: f32, side: f32) -> Self {
        Self { kind: JointKind::Window, axis: upright(x, y, side), limits: [0.0, RIGHT] }
    }

    /// The leaf of a door, hinged as [`Joint::cupboard`] is, that is built open by `open_rad`.
    pub fn leaf(x: f32, y: f32, side: f32, open_rad: f32) -> Self {
        let open = f64::from(open_rad);
        Self { kind: JointKind::Door, axis: upright(x, y, side), limits: [-open, AJAR.max(open) - open] }
    }

    /// The lever of a tap, about a level axis along x through `y`, `z`: `up` lifts its front, otherwise it tilts to the front.
    pub fn tap(y: f32, z: f32, most: f64, up: bool) -> Self {
        Self { kind: JointKind::Tap, axis: Self::across(y, z, if up { 1.0 } else { -1.0 }), limits: [0.0, most] }
    }

    /// A seat that turns once around about the vertical through its origin.
    pub fn seat() -> Self {
        let limits = [-std::f64::consts::PI, std::f64::consts::PI];
        Self { kind: JointKind::Chair, axis: Axis::Hinge { point: DVec3::ZERO, along: DVec3::Z }, limits }
    }

    fn across(y: f32, z: f32, way: f64) -> Axis {
        Axis::Hinge { point: Vec3::new(0.0, y, z).as_dvec3(), along: DVec3::X * way }
    }

    /// The joint of what is placed in the object's space by a translation.
    #[must_use]
    pub fn moved(self, by: Vec3) -> Self {
        let axis = match self.axis {
            Axis::Hinge { point, along } => Axis::Hinge { point: point + by.as_dvec3(), along },
            slide @ Axis::Slide(_) => slide,
        };
        Self { axis, ..self }
    }

    /// The states of a body at rest that has the joint, in the world.
    pub(crate) fn at_rest(&self, world_from_object: &DAffine3) -> BodyStates {
        let direction = |axis: DVec3| world_from_object.transform_vector3(axis).normalize();
        match self.axis {
            Axis::Hinge { point, along } => {
                BodyStates::Hinge { point: world_from_object.transform_point3(point), axis: direction(along), angles_rad: vec![0.0] }
            }
            Axis::Slide(axis) => BodyStates::Slide { axis: direction(axis), distances_m: vec![0.0] },
        }
    }
}

/// The vertical axis of a door that faces +y, hinged at its edge at smaller (−1) or larger (+1) x.
fn upright(x: f32, y: f32, side: f32) -> Axis {
    Axis::Hinge { point: Vec3::new(x, y, 0.0).as_dvec3(), along: DVec3::Z * f64::from(-side) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::BodyMotion;

    /// Where a point of what moves is when it is wide open.
    fn open(joint: &Joint, point: DVec3) -> DVec3 {
        let wide = joint.limits[1];
        let states = match joint.at_rest(&DAffine3::IDENTITY) {
            BodyStates::Hinge { point, axis, .. } => BodyStates::Hinge { point, axis, angles_rad: vec![wide] },
            BodyStates::Slide { axis, .. } => BodyStates::Slide { axis, distances_m: vec![wide] },
            other @ (BodyStates::Free { .. } | BodyStates::Deform { .. }) => other,
        };
        BodyMotion { times_s: vec![0.0], states }.world_from_rest(0.0).transform_point3(point)
    }

    #[test]
    fn fronts_open_to_the_front() {
        let near = |joint: Joint, from: [f64; 3], to: [f64; 3]| {
            let found = open(&joint, DVec3::from_array(from));
            assert!(found.abs_diff_eq(DVec3::from_array(to), 1e-6), "{joint:?}: {found}");
        };
        near(Joint::drawer(0.25), [0.0, 0.1, 0.3], [0.0, 0.35, 0.3]);
        near(Joint::window(-0.5, 0.5, -1.0), [0.5, 0.5, 1.0], [-0.5, 1.5, 1.0]);
        near(Joint::window(0.5, 0.5, 1.0), [-0.5, 0.5, 1.0], [0.5, 1.5, 1.0]);
        near(Joint::level_flap(0.5, 0.25), [0.1, 0.5, 0.75], [0.1, 1.0, 0.25]);
        near(Joint::lid(-0.5, 0.25, RIGHT, false), [0.1, 0.5, 0.25], [0.1, -0.5, 1.25]);
        near(Joint::sliding(-0.5), [0.1, 0.0, 0.0], [-0.4, 0.0, 0.0]);
        // Fronts end where their neighbours begin: no corner crosses the plane of the hinge's edge before a right angle.
        let corner = open(&Joint { limits: [0.0, RIGHT], ..Joint::cupboard(0.0, 0.0, -1.0) }, DVec3::new(0.0, -0.019, 0.0));
        assert!(corner.x >= 0.0 && corner.y >= -0.019, "{corner}");
    }

    #[test]
    fn a_leaf_that_is_built_open_closes_by_as_much() {
        assert_eq!(Joint::leaf(0.4, -0.018, 1.0, 0.5).limits, [-0.5, AJAR - 0.5]);
        assert_eq!(Joint::lid(0.0, 0.4, 1.5, true).limits, [-1.5, 0.0]);
    }
}
