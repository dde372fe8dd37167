//! A joint of a home, and the joints as the layout lists them.

use enfilade_furniture::{JointKind, Jointed, object_of};
use enfilade_math::DVec3;
use enfilade_scene::{Body, BodyStates, Hinge, Labels, PartId, RoomJoint, Scene, WallOpening};

/// A joint of a home. Its range is in the limits of the body of its name: closed and open, relative to the home's rest.
#[derive(Clone, Debug, PartialEq)]
pub struct HomeJoint {
    /// Name of the body: that of the object, `/`, and the name of what moves.
    pub body: String,
    /// The thing that moves.
    pub kind: JointKind,
    /// State as the home is made, relative to its rest, radians or metres.
    pub made: f64,
    /// Closed and open by its own measures, relative to the home's rest: what is around it may leave less.
    pub built: [f64; 2],
    /// The object that stops it before it is wide open, or before it is closed.
    pub limited_by: Option<String>,
}

impl HomeJoint {
    pub(crate) fn new(jointed: &Jointed, scene: &Scene) -> Option<Self> {
        let body = body_named(scene, &jointed.body)?;
        Some(Self { body: jointed.body.clone(), kind: jointed.kind, made: 0.0, built: body.limits?, limited_by: None })
    }
}

/// The joints as the layout lists them.
pub(crate) fn listed(joints: &[HomeJoint], scene: &Scene, labels: &Labels) -> Vec<RoomJoint> {
    let joint = |joint: &HomeJoint| {
        let body = body_named(scene, &joint.body)?;
        let [closed, open] = body.limits?;
        // Not one of what it carries.
        let is_own = |part: &PartId| object_of(&scene.parts[*part as usize].name) == object_of(&joint.body);
        let own = body.parts.iter().copied().find(is_own)?;
        let (axis, point) = match &body.motion.states {
            BodyStates::Hinge { axis, point, .. } => (axis, Some(point.to_array())),
            BodyStates::Slide { axis, .. } => (axis, None),
            BodyStates::Free { .. } | BodyStates::Deform { .. } => return None,
        };
        Some(RoomJoint {
            name: joint.body.clone(),
            kind: joint.kind.name().into(),
            instance: labels.parts.get(own as usize)?.instance,
            joint: body.motion.states.joint().into(),
            axis: axis.to_array(),
            point_m: point,
            limits: [closed, open],
            state: if open > closed { ((0.0 - closed) / (open - closed)).clamp(0.0, 1.0) } else { 0.0 },
            limited_by: joint.limited_by.clone(),
        })
    };
    joints.iter().filter_map(joint).collect()
}

/// Tells the openings of a home how far their doors are open.
pub(crate) fn hang(openings: &mut [WallOpening], joints: &[HomeJoint], scene: &Scene) {
    for joint in joints.iter().filter(|joint| joint.kind == JointKind::Door) {
        let Some(BodyStates::Hinge { point, .. }) = body_named(scene, &joint.body).map(|body| &body.motion.states) else { continue };
        let away = |opening: &WallOpening| {
            let corner = usize::from(opening.leaf.is_some_and(|leaf| leaf.hinge == Hinge::Right));
            DVec3::from_array(opening.corners[corner]).truncate().distance(point.truncate())
        };
        let doors = openings.iter_mut().filter(|opening| opening.leaf.is_some());
        if let Some(leaf) = doors.min_by(|a, b| away(a).total_cmp(&away(b))).and_then(|door| door.leaf.as_mut()) {
            leaf.open_deg = (-joint.built[0]).to_degrees();
        }
    }
}

fn body_named<'a>(scene: &'a Scene, name: &str) -> Option<&'a Body> {
    scene.bodies.iter().find(|body| body.name == name)
}
