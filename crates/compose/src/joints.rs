//! `[[motion]]` by joints that the scene has: how far what moves is open at moments.

use crate::surfaces::fits;
use enfilade_options::closest;
use enfilade_scene::{Body, BodyMotion, Scene};
use std::collections::BTreeSet;

/// How far what is named is open at moments.
pub(crate) struct Opening<'a> {
    /// Names of joints, or of objects that have them.
    pub names: &'a [String],
    /// Moments.
    pub times_s: &'a [f64],
    /// Shares of the range at these moments.
    pub shares: &'a [f64],
}

/// Lets the joints that are named open and close; `opened` has the names of those that move already.
///
/// # Errors
/// What is wrong with a name.
pub(crate) fn open(scene: &mut Scene, opening: &Opening, opened: &mut BTreeSet<String>) -> Result<(), String> {
    for pattern in opening.names {
        let named = |body: &&mut Body| {
            let object = body.name.split_once('/').map(|(object, _)| object);
            body.limits.is_some() && (fits(pattern, &body.name) || object.is_some_and(|object| fits(pattern, object)))
        };
        let mut found: Vec<&mut Body> = scene.bodies.iter_mut().filter(named).collect();
        if found.is_empty() {
            return Err(unknown(scene, pattern));
        }
        let mut moves = false;
        for body in &mut found {
            let Some(limits) = body.limits else { continue };
            moves |= limits[0] < limits[1];
            body.motion = motion(body, limits, opening);
            if !opened.insert(body.name.clone()) {
                return Err(format!("{:?} is moved by an earlier [[motion]] or name", body.name));
            }
        }
        if !moves {
            return Err(format!("{:?} cannot move at all: something is in its way (layout.json says what, `limited_by`)", found[0].name));
        }
    }
    Ok(())
}

/// The motion of a joint that is open by these shares.
fn motion(body: &Body, [closed, open]: [f64; 2], opening: &Opening) -> BodyMotion {
    let values = opening.shares.iter().map(|share| closed + share * (open - closed)).collect();
    let states = body.motion.states.with_values(values);
    // Free bodies have no limits.
    states.map_or_else(|| body.motion.clone(), |states| BodyMotion { times_s: opening.times_s.to_vec(), states })
}

/// What is said of a name of no joint.
fn unknown(scene: &Scene, pattern: &str) -> String {
    if scene.bodies.iter().any(|body| body.limits.is_none() && fits(pattern, &body.name)) {
        return format!("{pattern:?} has no limits, so there is no share of its range; give it angles_deg, distances_m or moved_m");
    }
    let with_limits = scene.bodies.iter().filter(|body| body.limits.is_some());
    let known: Vec<&str> = with_limits.flat_map(|body| [body.name.as_str(), body.name.split('/').next().unwrap_or_default()]).collect();
    if known.is_empty() {
        return format!("the scene has no joints, so none called {pattern:?}; homes have them, and files do not");
    }
    let meant = closest(pattern, &known).map_or_else(String::new, |name| format!("; did you mean {name:?}?"));
    format!("the scene has no joint {pattern:?}{meant}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Many, MotionGroup, with_motion};
    use enfilade_geometry::Mesh;
    use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
    use enfilade_scene::{BodyStates, Material, Part};

    /// A door that is a quarter open of two right angles, a drawer that goes out by half a metre, a lid that cannot move, and a free body.
    fn scene() -> Scene {
        let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Z], triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let part = |name: &str| Part { name: name.into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY };
        let hinge = BodyStates::Hinge { point: DVec3::ZERO, axis: DVec3::Z, angles_rad: vec![0.0] };
        let slide = BodyStates::Slide { axis: DVec3::Y, distances_m: vec![0.0] };
        let body = |name: &str, part, states, limits| Body {
            name: name.into(),
            parent: None,
            parts: vec![part],
            lights: Vec::new(),
            cameras: Vec::new(),
            limits,
            motion: BodyMotion { times_s: vec![0.0], states },
        };
        let free = BodyMotion::rest().states;
        let right = std::f64::consts::FRAC_PI_2;
        Scene {
            meshes: vec![mesh.into()],
            materials: vec![Material::diffuse("oak", Rgb::splat(0.5))],
            parts: ["door_1/leaf", "dresser_1/drawer", "chest_1/lid", "ball_1/skin"].map(part).into(),
            bodies: vec![
                body("door_1/leaf", 0, hinge.clone(), Some([-0.5 * right, 1.5 * right])),
                body("dresser_1/drawer_1", 1, slide, Some([0.0, 0.5])),
                body("chest_1/lid", 2, hinge, Some([0.0, 0.0])),
                body("ball", 3, free, None),
            ],
            ..Scene::default()
        }
    }

    fn opens(joint: &str, open: &[f64]) -> MotionGroup {
        let times_s = (0..open.len()).map(|at| at as f64).collect();
        MotionGroup { joint: Many(vec![joint.into()]), times_s, open: open.into(), ..MotionGroup::default() }
    }

    #[test]
    fn shares_are_of_the_range_of_the_joint() {
        let moving = with_motion(&scene(), &[opens("door_1", &[0.0, 1.0]), opens("dresser_*/drawer_?", &[0.2, 0.6])]).unwrap();
        assert_eq!(moving.bodies.len(), 4);
        let right = std::f64::consts::FRAC_PI_2;
        assert_eq!(
            [0.0, 0.5, 2.0].map(|time_s| moving.bodies[0].motion.state_at(time_s).unwrap()),
            [-0.5 * right, 0.5 * right, 1.5 * right]
        );
        assert_eq!(moving.bodies[1].motion.state_at(1.0), Some(0.3));
        assert!(moving.at(1.0).parts[1].world_from_mesh.translation.abs_diff_eq(DVec3::Y * 0.3, 1e-12));
        assert!(moving.bodies[2].motion.is_rest() && moving.bodies[0].limits == scene().bodies[0].limits);
    }

    #[test]
    fn what_cannot_be_is_refused_by_key_with_the_nearest_name() {
        let refused = |group: MotionGroup, told: &str| {
            let message = with_motion(&scene(), &[opens("door_1", &[0.5]), group]).unwrap_err().to_string();
            assert!(message.starts_with("[[motion]] 2: ") && message.contains(told), "{message}");
        };
        refused(opens("dreser_1", &[0.5]), "joint: the scene has no joint \"dreser_1\"; did you mean \"dresser_1\"?");
        refused(opens("ball", &[0.5]), "joint: \"ball\" has no limits");
        refused(opens("chest_1", &[0.5]), "joint: \"chest_1/lid\" cannot move at all");
        refused(opens("door_*", &[0.5]), "joint: \"door_1/leaf\" is moved by an earlier [[motion]]");
        refused(opens("dresser_1", &[0.5, 1.2]), "open: found 1.2, expected shares from 0");
        refused(MotionGroup { open: vec![0.5], ..opens("dresser_1", &[0.5, 0.6]) }, "open: 1 shares for 2 moments");
        refused(MotionGroup { axis: [1.0, 0.0, 0.0], ..opens("dresser_1", &[0.5]) }, "axis: beside `joint`");
        refused(MotionGroup { joint: Many::default(), ..opens("dresser_1", &[0.5]) }, "open: a share of the range of a joint");
        let still = Scene { bodies: Vec::new(), ..scene() };
        let message = with_motion(&still, &[opens("door_1", &[0.5])]).unwrap_err().to_string();
        assert!(message.contains("joint: the scene has no joints"), "{message}");
    }
}
