//! `[[motion]]`: what moves in a scene, and how.

use crate::joints::{self, Opening};
use crate::surfaces::fits;
use crate::{ComposeError, Many};
use enfilade_math::{DQuat, DVec3};
use enfilade_options::{closest, options};
use enfilade_scene::{Body, BodyMotion, BodyStates, PartId, RigidPose, Scene};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Least length of a direction.
const SHORTEST: f64 = 1e-9;

options! {
    /// Things that move as one.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct MotionGroup {
        /// What moves: names of objects or parts, with `*` and `?`; one or a list.
        pub of: Many = Many::default(),
        /// What moves, by its joint, in place of `of` and an axis: names of joints (`dresser_1/drawer_2`) or of objects with joints
        /// (`door_1`), with `*` and `?`; one or a list. `open` says how.
        #[serde(skip_serializing_if = "Many::is_empty")]
        pub joint: Many = Many::default(),
        /// Shares of the joint's range at these moments: 0 is closed, 1 open as far as it goes.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub open: Vec<f64> = Vec::new(),
        /// Name of the body; the first of `of` unless given.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub name: Option<String> = None,
        /// Name of the body that bears it, of an earlier `[[motion]]` or of the file: where that goes, this goes along.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub on: Option<String> = None,
        /// The moments at which its states are given, seconds, ascending. Frame n shows n times the time between frames.
        pub times_s: Vec<f64> = Vec::new(),
        /// Angles about `axis` through `point_m` at these moments, degrees, counter-clockwise seen against the axis.
        pub angles_deg: Vec<f64> = Vec::new(),
        /// Distances along `axis` at these moments, metres.
        pub distances_m: Vec<f64> = Vec::new(),
        /// Ways from rest at these moments, `[[x, y, z], …]`, metres, for free motion.
        pub moved_m: Vec<[f64; 3]> = Vec::new(),
        /// Rotations from rest at these moments, `[[x, y, z], …]`, for free motion: the direction is the axis, the length the angle in degrees.
        /// They are about `point_m`.
        pub turned_deg: Vec<[f64; 3]> = Vec::new(),
        /// The axis of `angles_deg` and `distances_m`.
        pub axis: [f64; 3] = [0.0, 0.0, 1.0],
        /// The point that rotations are about, world, metres; the middle of the thing's box unless given.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub point_m: Option<[f64; 3]> = None,
    }
}

/// The scene, in which the things of these groups move as well. Groups are numbered from 1.
///
/// # Errors
/// The first value that cannot be, with its key, and names of nothing.
pub fn with_motion(scene: &Scene, groups: &[MotionGroup]) -> Result<Scene, ComposeError> {
    let mut scene = scene.clone();
    let mut opened = BTreeSet::new();
    for (group, number) in groups.iter().zip(1..) {
        if group.joint.is_empty() {
            let body = group.body(&scene, number)?;
            scene.bodies.push(body);
        } else {
            group.validate(number)?;
            let opening = Opening { names: &group.joint.0, times_s: &group.times_s, shares: &group.open };
            joints::open(&mut scene, &opening, &mut opened).map_err(|problem| wrong(number, "joint", problem))?;
        }
        scene.validate().map_err(|error| wrong(number, "of", error.to_string()))?;
    }
    Ok(scene)
}

fn wrong(group: usize, key: &'static str, problem: String) -> ComposeError {
    ComposeError::Motion { group, key, problem }
}

impl MotionGroup {
    /// Checks every value that does not depend on the scene; `group` is the number in the file, from 1.
    ///
    /// # Errors
    /// The first value that cannot be, with its key.
    pub fn validate(&self, group: usize) -> Result<(), ComposeError> {
        let refuse = |key, problem: &str| Err(wrong(group, key, problem.into()));
        if !self.joint.is_empty() || !self.open.is_empty() {
            return self.validate_joint(group);
        }
        if self.of.0.is_empty() {
            return refuse("of", "missing; expected names of objects or parts, such as of = \"door_1\", or a joint");
        }
        let free = !self.moved_m.is_empty() || !self.turned_deg.is_empty();
        if usize::from(free) + usize::from(!self.angles_deg.is_empty()) + usize::from(!self.distances_m.is_empty()) != 1 {
            return refuse("times_s", "expected states of one kind beside it: angles_deg, distances_m, or moved_m and turned_deg");
        }
        for (key, count) in [
            ("angles_deg", self.angles_deg.len()),
            ("distances_m", self.distances_m.len()),
            ("moved_m", self.moved_m.len()),
            ("turned_deg", self.turned_deg.len()),
        ] {
            if count != 0 && count != self.times_s.len() {
                return Err(wrong(group, key, format!("{count} states for {} moments in times_s", self.times_s.len())));
            }
        }
        if self.axis().is_none() {
            return Err(wrong(group, "axis", format!("found {:?}, expected a direction such as [0, 0, 1]", self.axis)));
        }
        Ok(())
    }

    /// Checks the values of a group that has `joint` or `open`.
    fn validate_joint(&self, group: usize) -> Result<(), ComposeError> {
        let refuse = |key, problem: String| Err(wrong(group, key, problem));
        if self.joint.is_empty() {
            return refuse("open", "a share of the range of a joint; expected joint = \"NAME\" beside it".into());
        }
        let usual = Self::default();
        let others = [
            ("of", !self.of.is_empty()),
            ("name", self.name.is_some()),
            ("on", self.on.is_some()),
            ("angles_deg", !self.angles_deg.is_empty()),
            ("distances_m", !self.distances_m.is_empty()),
            ("moved_m", !self.moved_m.is_empty()),
            ("turned_deg", !self.turned_deg.is_empty()),
            ("axis", self.axis != usual.axis),
            ("point_m", self.point_m.is_some()),
        ];
        if let Some((key, _)) = others.into_iter().find(|(_, given)| *given) {
            return refuse(key, "beside `joint`, which has its own name, axis and parts; expected `times_s` and `open` alone".into());
        }
        if self.open.len() != self.times_s.len() || self.open.is_empty() {
            return refuse("open", format!("{} shares for {} moments in times_s", self.open.len(), self.times_s.len()));
        }
        match self.open.iter().find(|share| !(0.0..=1.0).contains(*share)) {
            Some(share) => refuse("open", format!("found {share}, expected shares from 0 (closed) to 1 (open)")),
            None => Ok(()),
        }
    }

    fn axis(&self) -> Option<DVec3> {
        let axis = DVec3::from_array(self.axis);
        (axis.is_finite() && axis.length() > SHORTEST).then(|| axis.normalize())
    }

    /// The body that the group makes of a scene.
    fn body(&self, scene: &Scene, group: usize) -> Result<Body, ComposeError> {
        self.validate(group)?;
        let parts = self.parts(scene, group)?;
        let lights = scene.lights.iter().zip(0..).filter(|(light, _)| self.takes_light(light.name())).map(|(_, light)| light).collect();
        let parent = match &self.on {
            None => None,
            Some(name) => Some(body_named(scene, name).ok_or_else(|| unknown_body(scene, name, group))?),
        };
        let name = self.name.clone().unwrap_or_else(|| self.of.0[0].clone());
        let motion = BodyMotion { times_s: self.times_s.clone(), states: self.states(scene, &parts) };
        Ok(Body { name, parent, parts, lights, cameras: Vec::new(), limits: None, motion })
    }

    fn states(&self, scene: &Scene, parts: &[PartId]) -> BodyStates {
        let axis = self.axis().unwrap_or(DVec3::Z);
        if !self.distances_m.is_empty() {
            return BodyStates::Slide { axis, distances_m: self.distances_m.clone() };
        }
        let bounds = parts.iter().map(|&part| scene.part_bounds(part)).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        let middle = bounds.map_or(DVec3::ZERO, |[low, high]| 0.5 * (low + high));
        let point = self.point_m.map_or(middle, DVec3::from_array);
        if !self.angles_deg.is_empty() {
            return BodyStates::Hinge { point, axis, angles_rad: self.angles_deg.iter().map(|angle| angle.to_radians()).collect() };
        }
        let pose = |at: usize| {
            let turned = self.turned_deg.get(at).map_or(DVec3::ZERO, |turned| DVec3::from_array(turned.map(f64::to_radians)));
            let translation = self.moved_m.get(at).map_or(DVec3::ZERO, |moved| DVec3::from_array(*moved));
            RigidPose { rotation: DQuat::from_scaled_axis(turned), translation }
        };
        BodyStates::Free { position: point, rotation: DQuat::IDENTITY, poses: (0..self.times_s.len()).map(pose).collect() }
    }

    /// The parts that the names stand for.
    fn parts(&self, scene: &Scene, group: usize) -> Result<Vec<PartId>, ComposeError> {
        let mut parts = BTreeSet::new();
        for pattern in &self.of.0 {
            let of_object = |part| scene.objects_around(part).any(|object| fits(pattern, &scene.objects[object as usize].name));
            let found = scene.parts.iter().zip(0..).filter(|(part, _)| fits(pattern, &part.name) || of_object(part));
            let before = parts.len();
            parts.extend(found.map(|(_, part)| part));
            if parts.len() == before {
                let names = scene.parts.iter().map(|part| part.name.as_str());
                let known: Vec<&str> = names.chain(scene.objects.iter().map(|object| object.name.as_str())).collect();
                let meant = closest(pattern, &known).map_or(String::new(), |name| format!("; did you mean {name:?}?"));
                return Err(wrong(group, "of", format!("the scene has no part or object {pattern:?}{meant}")));
            }
        }
        Ok(parts.into_iter().collect())
    }

    /// True for lights that belong to the things, by their name.
    fn takes_light(&self, light: &str) -> bool {
        let belongs = |name: &String| light == name || light.strip_prefix(name.as_str()).is_some_and(|rest| rest.starts_with('/'));
        self.of.0.iter().any(belongs)
    }
}

fn body_named(scene: &Scene, name: &str) -> Option<u32> {
    scene.bodies.iter().position(|body| body.name == name).map(|body| body as u32)
}

fn unknown_body(scene: &Scene, name: &str, group: usize) -> ComposeError {
    let known: Vec<&str> = scene.bodies.iter().map(|body| body.name.as_str()).collect();
    let problem = if known.is_empty() {
        format!("no body {name:?} comes before; a [[motion]] that bears others must be the first of them")
    } else {
        let meant = closest(name, &known).map_or(String::new(), |name| format!("; did you mean {name:?}?"));
        format!("no body {name:?} comes before{meant}")
    };
    wrong(group, "on", problem)
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_geometry::Mesh;
    use enfilade_math::{DAffine3, Rgb, Vec3};
    use enfilade_scene::{Light, Material, Object, Part};

    /// Two doors of a metre, each with a handle, and a light of the first.
    fn scene() -> Scene {
        let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Z], triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let part = |name: &str, object, x: f64| Part {
            name: name.into(),
            object: Some(object),
            mesh: 0,
            material: 0,
            world_from_mesh: DAffine3::from_translation(DVec3::X * x),
        };
        let object = |name: &str| Object { name: name.into(), parent: None };
        Scene {
            meshes: vec![mesh.into()],
            materials: vec![Material::diffuse("oak", Rgb::splat(0.5))],
            parts: vec![part("leaf_a", 0, 0.0), part("handle_a", 0, 0.5), part("leaf_b", 1, 3.0), part("handle_b", 1, 3.5)],
            objects: vec![object("door_a"), object("door_b")],
            lights: vec![Light::Point { name: "door_a/lamp".into(), position: Vec3::X, intensity: Rgb::WHITE }],
            ..Scene::default()
        }
    }

    fn hinge(of: &str) -> MotionGroup {
        MotionGroup {
            of: Many(vec![of.into()]),
            times_s: vec![0.0, 1.0],
            angles_deg: vec![0.0, 90.0],
            point_m: Some([0.0; 3]),
            ..MotionGroup::default()
        }
    }

    #[test]
    fn things_move_by_name_and_bear_others() {
        let slide = MotionGroup {
            of: Many(vec!["handle_a".into()]),
            on: Some("leaf".into()),
            times_s: vec![0.0, 1.0],
            distances_m: vec![0.0, 0.25],
            axis: [2.0, 0.0, 0.0],
            ..MotionGroup::default()
        };
        let leaf = MotionGroup { name: Some("leaf".into()), ..hinge("leaf_a") };
        let moving = with_motion(&scene(), &[leaf, slide]).unwrap();
        let there = moving.at(1.0);
        assert!(there.parts[1].world_from_mesh.translation.abs_diff_eq(DVec3::Y * 0.75, 1e-12));
        assert_eq!(there.parts[2], scene().parts[2]);

        let doors = with_motion(&scene(), &[hinge("door_*")]).unwrap();
        assert_eq!(doors.bodies[0].parts, [0, 1, 2, 3]);
        let one = with_motion(&scene(), &[hinge("door_a")]).unwrap();
        assert_eq!((one.bodies[0].parts.as_slice(), one.bodies[0].lights.as_slice()), (&[0, 1][..], &[0][..]));
    }

    #[test]
    fn free_motion_is_about_the_middle_unless_a_point_is_given() {
        let free = MotionGroup {
            of: Many(vec!["leaf_b".into()]),
            times_s: vec![0.0, 2.0],
            turned_deg: vec![[0.0; 3], [0.0, 0.0, 90.0]],
            moved_m: vec![[0.0; 3], [0.0, 0.0, 2.0]],
            ..MotionGroup::default()
        };
        let moving = with_motion(&scene(), &[free]).unwrap();
        // The middle of the leaf is at (3.5, 0, 0.5); half way it is a metre higher, and the leaf has turned by 45 degrees.
        let half = moving.at(1.0).parts[2].world_from_mesh;
        assert!(half.transform_point3(DVec3::new(0.5, 0.0, 0.5)).abs_diff_eq(DVec3::new(3.5, 0.0, 1.5), 1e-12));
        assert!((half.matrix3 * DVec3::X).abs_diff_eq(DVec3::new(0.5f64.sqrt(), 0.5f64.sqrt(), 0.0), 1e-12));
    }

    #[test]
    fn what_cannot_be_is_refused_by_group_and_key() {
        let refused = |change: &dyn Fn(&mut MotionGroup), told: &str| {
            let mut group = hinge("door_a");
            change(&mut group);
            let message = with_motion(&scene(), &[hinge("door_b"), group]).unwrap_err().to_string();
            assert!(message.starts_with("[[motion]] 2: ") && message.contains(told), "{message}");
        };
        refused(&|group| group.of = Many(vec!["door_c".into()]), "of: the scene has no part or object \"door_c\"");
        refused(&|group| group.of = Many::default(), "of: missing");
        refused(&|group| group.angles_deg = vec![1.0], "angles_deg: 1 states for 2 moments");
        refused(&|group| group.distances_m = vec![1.0, 2.0], "times_s: expected states of one kind");
        refused(&|group| group.axis = [0.0; 3], "axis: found [0.0, 0.0, 0.0]");
        refused(&|group| group.on = Some("door_d".into()), "on: no body \"door_d\" comes before; did you mean \"door_b\"?");
        refused(&|group| group.name = Some("door_b".into()), "two bodies have this name");
        refused(&|group| (group.of, group.name) = (Many(vec!["door_b".into()]), Some("again".into())), "part 2 belongs to a body already");
        refused(&|group| group.times_s = vec![1.0, 0.0], "moment 1 (0 s) comes before");
    }
}
