//! Scenes that move: their state at a moment, and edits that keep bodies right.

use crate::{Body, BodyId, BodyStates, PartId, Scene, SceneError, StartCamera};
use enfilade_math::DAffine3;
use std::collections::BTreeSet;

impl Scene {
    /// True when no part and no light moves: there may be joints that stay as they are, and cameras that ride through the scene.
    pub fn is_still(&self) -> bool {
        let carries = |body: &crate::Body| !body.parts.is_empty() || !body.lights.is_empty();
        self.moving_bodies().iter().zip(&self.bodies).all(|(moves, body)| !moves || !carries(body))
    }

    /// By body: whether it leaves rest at any moment, by itself or with what bears it.
    pub fn moving_bodies(&self) -> Vec<bool> {
        let mut moving: Vec<bool> = Vec::with_capacity(self.bodies.len());
        for body in &self.bodies {
            moving.push(!body.motion.is_rest() || body.parent.is_some_and(|parent| moving[parent as usize]));
        }
        moving
    }

    /// The cameras as they are at a moment: those that ride on bodies go with them.
    pub fn cameras_at(&self, time_s: f64) -> Vec<StartCamera> {
        let mut cameras = self.cameras.clone();
        for (body, map) in self.bodies.iter().zip(self.world_from_rest(time_s)).filter(|(_, map)| *map != DAffine3::IDENTITY) {
            body.cameras.iter().for_each(|&camera| cameras[camera as usize] = self.cameras[camera as usize].moved(&map));
        }
        cameras
    }

    /// Leaves every joint at rest, and takes out bodies that have none.
    pub fn hold_still(&mut self) {
        if self.bodies.iter().all(|body| body.limits.is_none()) {
            self.bodies.clear();
        }
        self.bodies.iter_mut().for_each(|body| body.motion = body.motion.rested());
    }

    /// The maps of the world to itself that take each body from rest to its place at a moment.
    pub fn world_from_rest(&self, time_s: f64) -> Vec<DAffine3> {
        let mut maps: Vec<DAffine3> = Vec::with_capacity(self.bodies.len());
        for body in &self.bodies {
            let own = body.motion.world_from_rest(time_s);
            maps.push(body.parent.map_or(own, |parent| maps[parent as usize] * own));
        }
        maps
    }

    /// By part: the map of the world to itself from its place at one moment to that at another; `None` of parts that have no body.
    pub fn carried(&self, from_s: f64, to_s: f64) -> Vec<Option<DAffine3>> {
        let [from, to] = [from_s, to_s].map(|time_s| self.world_from_rest(time_s));
        let carried: Vec<DAffine3> =
            from.iter().zip(&to).map(|(from, to)| if from == to { DAffine3::IDENTITY } else { *to * from.inverse() }).collect();
        self.body_of_parts().into_iter().map(|body| body.map(|body| carried[body as usize])).collect()
    }

    /// By part: whether its mesh changes its shape over time.
    pub fn deforming_parts(&self) -> Vec<bool> {
        let mut deforming = vec![false; self.parts.len()];
        let bodies = self.bodies.iter().filter(|body| matches!(body.motion.states, BodyStates::Deform { .. }));
        bodies.flat_map(|body| &body.parts).for_each(|&part| deforming[part as usize] = true);
        deforming
    }

    /// The parts whose meshes have one shape at one moment and another at another.
    pub fn deformed(&self, from_s: f64, to_s: f64) -> Vec<PartId> {
        let changes = |body: &&Body| body.motion.shape_at(from_s) != body.motion.shape_at(to_s);
        self.bodies.iter().filter(changes).flat_map(|body| body.parts.iter().copied()).collect()
    }

    /// The body of each part.
    pub fn body_of_parts(&self) -> Vec<Option<BodyId>> {
        let mut bodies = vec![None; self.parts.len()];
        for (body, id) in self.bodies.iter().zip(0..) {
            body.parts.iter().for_each(|&part| bodies[part as usize] = Some(id));
        }
        bodies
    }

    /// The scene as it is at a moment. It shares meshes and pictures, has the same bodies, and is the scene itself where nothing moves. Parts
    /// that deform have meshes of their own, with the same triangles.
    ///
    /// ```
    /// use enfilade_geometry::Mesh;
    /// use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
    /// use enfilade_scene::{Body, BodyMotion, BodyStates, Material, Part, Scene};
    ///
    /// // A door of one metre that turns about the z axis, a quarter in two seconds.
    /// let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Z], triangles: vec![[0, 1, 2]], ..Mesh::default() };
    /// let states = BodyStates::Hinge { point: DVec3::ZERO, axis: DVec3::Z, angles_rad: vec![0.0, std::f64::consts::FRAC_PI_2] };
    /// let scene = Scene {
    ///     meshes: vec![mesh.into()],
    ///     materials: vec![Material::diffuse("oak", Rgb::splat(0.4))],
    ///     parts: vec![Part { name: "door".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY }],
    ///     bodies: vec![Body {
    ///         name: "door".into(),
    ///         parent: None,
    ///         parts: vec![0],
    ///         lights: Vec::new(),
    ///         cameras: Vec::new(),
    ///         limits: None,
    ///         motion: BodyMotion { times_s: vec![0.0, 2.0], states },
    ///     }],
    ///     ..Scene::default()
    /// };
    /// assert_eq!(scene.validate(), Ok(()));
    ///
    /// let half_way = scene.at(1.0);
    /// let corner = half_way.world_corners(&half_way.parts[0], 0)[1];
    /// assert!(corner.distance(Vec3::new(0.5f32.sqrt(), 0.5f32.sqrt(), 0.0)) < 1e-6);
    /// ```
    #[must_use]
    pub fn at(&self, time_s: f64) -> Self {
        let mut scene = self.clone();
        for (body, map) in self.bodies.iter().zip(self.world_from_rest(time_s)) {
            if let Some(shape) = body.motion.shape_at(time_s) {
                for &part in &body.parts {
                    let part = &mut scene.parts[part as usize];
                    scene.meshes.push(shape.on(&scene.meshes[part.mesh as usize]).into());
                    part.mesh = scene.meshes.len() as u32 - 1;
                }
            }
            if map == DAffine3::IDENTITY {
                continue;
            }
            for &part in &body.parts {
                let placed = &mut scene.parts[part as usize].world_from_mesh;
                *placed = map * *placed;
            }
            for &light in &body.lights {
                scene.lights[light as usize] = self.lights[light as usize].moved(&map);
            }
            for &camera in &body.cameras {
                scene.cameras[camera as usize] = self.cameras[camera as usize].moved(&map);
            }
        }
        scene
    }

    /// The scene as it is at a moment, in which nothing moves: that is its rest. Joints with limits stay, and are stated from there.
    #[must_use]
    pub fn still_at(&self, time_s: f64) -> Self {
        let maps = self.world_from_rest(time_s);
        let mut scene = self.at(time_s);
        for (body, was) in scene.bodies.iter_mut().zip(&self.bodies) {
            // Rigid maps carry every motion.
            if let Some(carried) = was.parent.and_then(|parent| was.carried(&maps[parent as usize])) {
                *body = carried;
            }
            let state = was.motion.state_at(time_s).unwrap_or_default();
            body.limits = was.limits.map(|ends| ends.map(|end| end - state));
        }
        scene.hold_still();
        if scene.meshes.len() > self.meshes.len() {
            scene.remove_unused_meshes();
        }
        scene
    }

    /// Takes parts out; those behind them move up. Bodies without parts and lights stay if they bear others.
    pub fn remove_parts(&mut self, gone: &BTreeSet<PartId>) {
        let mut index = 0..;
        self.parts.retain(|_| index.next().is_none_or(|part| !gone.contains(&part)));
        self.bodies.iter_mut().for_each(|body| drop_numbers(&mut body.parts, gone));
        self.remove_unused_bodies();
    }

    /// Takes lights out; those behind them move up.
    pub(crate) fn remove_lights(&mut self, gone: &BTreeSet<u32>) {
        let mut index = 0..;
        self.lights.retain(|_| index.next().is_none_or(|light| !gone.contains(&light)));
        self.bodies.iter_mut().for_each(|body| drop_numbers(&mut body.lights, gone));
        self.remove_unused_bodies();
    }

    /// Takes cameras out; those behind them move up.
    pub(crate) fn remove_cameras(&mut self, gone: &BTreeSet<u32>) {
        let mut index = 0..;
        self.cameras.retain(|_| index.next().is_none_or(|camera| !gone.contains(&camera)));
        self.bodies.iter_mut().for_each(|body| drop_numbers(&mut body.cameras, gone));
        self.remove_unused_bodies();
    }

    /// Takes out the bodies that neither have nor bear anything.
    pub fn remove_unused_bodies(&mut self) {
        let has = |body: &crate::Body| !body.parts.is_empty() || !body.lights.is_empty() || !body.cameras.is_empty();
        let mut used: Vec<bool> = self.bodies.iter().map(has).collect();
        for body in (0..self.bodies.len()).rev() {
            if let Some(parent) = self.bodies[body].parent.filter(|_| used[body]) {
                used[parent as usize] = true;
            }
        }
        let mut next = 0;
        let new: Vec<BodyId> = used.iter().map(|&used| (next, next += u32::from(used)).0).collect();
        self.bodies.iter_mut().for_each(|body| body.parent = body.parent.map(|parent| new[parent as usize]));
        let mut keep = used.into_iter();
        self.bodies.retain(|_| keep.next().unwrap_or(false));
    }

    /// Checks the bodies.
    pub(crate) fn validate_bodies(&self) -> Result<(), SceneError> {
        let mut names = BTreeSet::new();
        let [mut parts, mut lights, mut cameras] = [const { BTreeSet::new() }; 3];
        for (body, id) in self.bodies.iter().zip(0..) {
            let wrong = |problem: String| Err(SceneError::Value { what: format!("body {:?}", body.name), problem });
            let dangling = |kind: &'static str, index: u32, count: usize| {
                Err(SceneError::Dangling { what: format!("body {:?}", body.name), kind, index, count })
            };
            if !names.insert(body.name.as_str()) {
                return wrong("two bodies have this name".into());
            }
            if let Some(parent) = body.parent.filter(|&parent| parent >= id) {
                return dangling("the body", parent, id as usize);
            }
            for (numbers, taken, kind, count) in [
                (&body.parts, &mut parts, "part", self.parts.len()),
                (&body.lights, &mut lights, "light", self.lights.len()),
                (&body.cameras, &mut cameras, "camera", self.cameras.len()),
            ] {
                if let Some(&index) = numbers.iter().find(|&&index| index as usize >= count) {
                    return dangling(kind, index, count);
                }
                if let Some(twice) = numbers.iter().find(|&&index| !taken.insert(index)) {
                    return wrong(format!("{kind} {twice} belongs to a body already"));
                }
                if !numbers.is_sorted() {
                    return wrong(format!("its {kind}s are not in ascending order"));
                }
            }
            if let Some(problem) = body.problem().or_else(|| self.shape_problem(body)) {
                return wrong(problem);
            }
        }
        Ok(())
    }

    /// What is wrong with the shapes of a body, if anything.
    fn shape_problem(&self, body: &Body) -> Option<String> {
        let BodyStates::Deform { shapes } = &body.motion.states else { return None };
        if body.parts.len() > 1 || !body.lights.is_empty() {
            let [parts, lights] = [body.parts.len(), body.lights.len()];
            return Some(format!("{parts} parts and {lights} lights; expected one part, which deforms"));
        }
        let mesh = &self.meshes.get(self.parts[*body.parts.first()? as usize].mesh as usize)?;
        let problems = shapes.iter().enumerate().find_map(|(at, shape)| shape.problem(mesh).map(|problem| (at, problem)));
        problems.map(|(at, problem)| format!("shape {at} (at {} s) has {problem}", body.motion.times_s[at]))
    }
}

/// Takes numbers out of an ascending list; those behind them become smaller.
fn drop_numbers(list: &mut Vec<u32>, gone: &BTreeSet<u32>) {
    list.retain(|number| !gone.contains(number));
    list.iter_mut().for_each(|number| *number -= gone.range(..*number).count() as u32);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, BodyMotion, BodyStates, Light, Material, Part, RigidPose, Shape};
    use enfilade_geometry::Mesh;
    use enfilade_math::{DMat3, DQuat, DVec3, Rgb, Vec3};
    use std::f64::consts::{FRAC_PI_2, PI};

    fn body(name: &str, parent: Option<BodyId>, parts: Vec<PartId>, states: BodyStates) -> Body {
        let times_s = (0..count_of(&states)).map(|at| at as f64).collect();
        Body { name: name.into(), parent, parts, lights: vec![], cameras: vec![], limits: None, motion: BodyMotion { times_s, states } }
    }

    fn count_of(states: &BodyStates) -> usize {
        BodyMotion { times_s: Vec::new(), states: states.clone() }.count()
    }

    fn hinge(angle: f64) -> BodyStates {
        BodyStates::Hinge { point: DVec3::new(1.0, 0.0, 0.0), axis: DVec3::Z, angles_rad: vec![0.0, angle] }
    }

    /// Three triangles at x = 2, 3 and 4; the second and the third are a door and the handle on it.
    fn scene() -> Scene {
        let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let part = |name: &str, x: f64| Part {
            name: name.into(),
            object: None,
            mesh: 0,
            material: 0,
            world_from_mesh: DAffine3::from_translation(DVec3::X * x),
        };
        Scene {
            meshes: vec![mesh.into()],
            materials: vec![Material::diffuse("m", Rgb::WHITE)],
            parts: vec![part("wall", 2.0), part("door", 3.0), part("handle", 4.0)],
            lights: vec![Light::Point { name: "bulb".into(), position: Vec3::X, intensity: Rgb::WHITE }],
            bodies: vec![
                body("door", None, vec![1], hinge(FRAC_PI_2)),
                body("handle", Some(0), vec![2], BodyStates::Slide { axis: DVec3::X, distances_m: vec![0.0, 0.5] }),
            ],
            ..Scene::default()
        }
    }

    fn at(scene: &Scene, part: usize, time_s: f64) -> DVec3 {
        scene.at(time_s).parts[part].world_from_mesh.translation
    }

    #[test]
    fn what_a_body_bears_moves_with_it() {
        let scene = scene();
        assert_eq!(scene.validate(), Ok(()));
        for (time_s, door, handle) in [
            (-1.0, DVec3::X * 3.0, DVec3::X * 4.0),
            (0.5, DVec3::new(1.0 + 2f64.sqrt(), 2f64.sqrt(), 0.0), DVec3::new(1.0 + 3.25 * 0.5f64.sqrt(), 3.25 * 0.5f64.sqrt(), 0.0)),
            (7.0, DVec3::new(1.0, 2.0, 0.0), DVec3::new(1.0, 3.5, 0.0)),
        ] {
            assert!(at(&scene, 1, time_s).abs_diff_eq(door, 1e-12), "{}", at(&scene, 1, time_s));
            assert!(at(&scene, 2, time_s).abs_diff_eq(handle, 1e-12), "{}", at(&scene, 2, time_s));
            assert_eq!(at(&scene, 0, time_s), DVec3::X * 2.0);
        }
        assert_eq!(scene.at(0.0), scene);
    }

    #[test]
    fn free_bodies_turn_about_their_frame_the_shortest_way_and_jump_where_moments_meet() {
        let mut scene = scene();
        let pose = |angle: f64, x: f64| RigidPose { rotation: DQuat::from_rotation_z(angle), translation: DVec3::X * x };
        let poses = vec![pose(0.0, 0.0), pose(PI / 2.0, 2.0), pose(0.0, 8.0)];
        scene.bodies = vec![body("door", None, vec![1], BodyStates::Free { position: DVec3::X * 3.0, rotation: DQuat::IDENTITY, poses })];
        scene.bodies[0].motion.times_s = vec![0.0, 1.0, 1.0];
        assert!(at(&scene, 1, 0.5).abs_diff_eq(DVec3::X * 4.0, 1e-12));
        assert!(
            (scene.at(0.5).parts[1].world_from_mesh.matrix3 * DVec3::X).abs_diff_eq(DVec3::new(0.5f64.sqrt(), 0.5f64.sqrt(), 0.0), 1e-12)
        );
        assert!(at(&scene, 1, 1.0).abs_diff_eq(DVec3::X * 11.0, 1e-12));
    }

    #[test]
    fn lights_move_with_their_body_and_removals_keep_the_rest_right() {
        let mut scene = scene();
        scene.bodies[1].lights = vec![0];
        let Light::Point { position, .. } = scene.at(1.0).lights[0] else { panic!() };
        assert!(position.abs_diff_eq(Vec3::new(1.0, 0.5, 0.0), 1e-6), "{position}");
        scene.remove_parts(&BTreeSet::from([0]));
        assert_eq!((scene.bodies[0].parts.as_slice(), scene.bodies[1].parts.as_slice()), (&[0][..], &[1][..]));
        scene.remove_parts(&BTreeSet::from([1]));
        assert_eq!(scene.bodies.len(), 2, "the light is still there");
        scene.remove_lights(&BTreeSet::from([0]));
        assert_eq!((scene.bodies.len(), scene.validate()), (1, Ok(())));
    }

    #[test]
    fn cameras_ride_on_their_body_and_do_not_make_a_scene_move() {
        let camera = |name: &str, position| StartCamera {
            name: name.into(),
            position,
            world_from_camera: DMat3::IDENTITY,
            fov_x_rad: 1.0,
            aspect: 1.5,
        };
        let mut scene = scene();
        scene.cameras = vec![camera("wall", DVec3::ZERO), camera("door", DVec3::new(3.0, 0.0, 1.0))];
        scene.bodies[0].cameras = vec![1];
        assert_eq!(scene.validate(), Ok(()));
        // The door turns by a quarter about the vertical at x = 1.
        let turned = &scene.cameras_at(1.0)[1];
        assert!(turned.position.abs_diff_eq(DVec3::new(1.0, 2.0, 1.0), 1e-12), "{}", turned.position);
        assert!(turned.world_from_camera.abs_diff_eq(DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z), 1e-12));
        assert_eq!((scene.at(1.0).cameras, scene.cameras_at(0.0)), (scene.cameras_at(1.0), scene.cameras.clone()));

        // What only films moves nothing that is seen; its body stays for its sake.
        scene.remove_parts(&BTreeSet::from([1, 2]));
        assert_eq!((scene.is_still(), scene.moving_bodies(), scene.bodies.len()), (true, vec![true], 1));
        scene.remove_cameras(&BTreeSet::from([0]));
        assert_eq!((scene.bodies[0].cameras.as_slice(), scene.cameras_at(1.0)[0].position.round()), (&[0][..], DVec3::new(1.0, 2.0, 1.0)));
        scene.bodies[0].cameras = vec![4];
        assert!(scene.validate().unwrap_err().to_string().contains("refers to camera 4, but there are only 1"));
        scene.bodies[0].cameras = vec![0];
        scene.remove_cameras(&BTreeSet::from([0]));
        assert_eq!((scene.bodies.len(), scene.validate()), (0, Ok(())));
    }

    #[test]
    fn bad_bodies_are_refused_by_name_and_moment() {
        let refused = |change: &dyn Fn(&mut Body), told: &str| {
            let mut scene = scene();
            change(&mut scene.bodies[1]);
            let message = scene.validate().unwrap_err().to_string();
            assert!(message.starts_with("body \"") && message.contains(told), "{message}");
        };
        let slide = |distances_m| BodyStates::Slide { axis: DVec3::X, distances_m };
        refused(&|body| body.motion.times_s.truncate(1), "1 moments for 2 states");
        refused(&|body| body.motion.times_s = vec![1.0, 0.5], "moment 1 (0.5 s) comes before the one ahead of it (1 s)");
        refused(&|body| body.motion.states = slide(vec![0.0, f64::NAN]), "state 1 (at 1 s) is not finite");
        refused(&|body| body.parts = vec![1], "part 1 belongs to a body already");
        refused(&|body| body.parts = vec![9], "refers to part 9, but there are only 3");
        refused(&|body| body.parent = Some(1), "refers to the body 1");
        refused(&|body| body.name = "door".into(), "two bodies have this name");
        refused(&|body| body.limits = Some([0.2, 0.1]), "limits 0.2 to 0.1; expected two finite numbers");
        refused(&|body| (body.limits, body.motion) = (Some([0.0, 1.0]), BodyMotion::rest()), "a free body has no limits");
        refused(&|body| body.motion.states = BodyStates::Slide { axis: DVec3::ZERO, distances_m: vec![0.0; 2] }, "no axis");
    }

    #[test]
    fn joints_that_stay_do_not_move_the_scene() {
        let mut scene = scene();
        assert!(!scene.is_still());
        scene.bodies[1].limits = Some([0.0, 0.4]);
        assert_eq!((scene.bodies[0].motion.state_at(0.5), scene.bodies[1].motion.state_at(0.5)), (Some(FRAC_PI_2 / 2.0), Some(0.25)));
        let doubled = scene.bodies[1].carried(&DAffine3::from_scale(DVec3::splat(2.0))).unwrap();
        assert_eq!(doubled.limits, Some([0.0, 0.8]));
        scene.hold_still();
        assert!(scene.is_still() && scene.bodies.len() == 2 && scene.validate().is_ok());
        scene.bodies[1].limits = None;
        scene.hold_still();
        assert_eq!(scene.bodies, []);
    }

    /// The door deforms: its last corner goes from y = 1 to y = 3.
    fn deforming() -> Scene {
        let mut scene = scene();
        let tall = |y: f32| std::sync::Arc::new(Shape { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y * y], normals: Vec::new() });
        scene.bodies[1] = body("door, itself", Some(0), vec![1], BodyStates::Deform { shapes: vec![tall(1.0), tall(3.0)] });
        scene.bodies[0].parts.clear();
        scene
    }

    #[test]
    fn parts_that_deform_have_meshes_of_their_own_and_ride_on_their_bearer() {
        let scene = deforming();
        assert_eq!((scene.validate(), scene.is_still(), scene.deforming_parts()), (Ok(()), false, vec![false, true, false]));
        let there = scene.at(0.5);
        // Twice as tall, at a place that has turned by an eighth about (1, 0).
        let corner = there.world_corners(&there.parts[1], 0)[2];
        let root = 0.5f32.sqrt();
        assert!(corner.distance(Vec3::new(1.0 + 2.0 * root - 2.0 * root, 2.0 * root + 2.0 * root, 0.0)) < 1e-6, "{corner}");
        assert_eq!(there.world_corners(&there.parts[0], 0)[2], Vec3::new(2.0, 1.0, 0.0), "the others keep the mesh");
        assert_eq!((scene.deformed(0.2, 0.3), scene.deformed(1.0, 7.0)), (vec![1], Vec::new()));
        let still = scene.still_at(0.5);
        assert_eq!((still.validate(), still.is_still(), still.meshes.len()), (Ok(()), true, 2));
        assert_eq!(still.world_corners(&still.parts[1], 0), there.world_corners(&there.parts[1], 0));
    }

    #[test]
    fn shapes_of_another_mesh_are_refused_by_body_and_moment() {
        let refused = |change: &dyn Fn(&mut Body), told: &str| {
            let mut scene = deforming();
            change(&mut scene.bodies[1]);
            let message = scene.validate().unwrap_err().to_string();
            assert!(message.contains("door, itself") && message.contains(told), "{message}");
        };
        let other = |shape: Shape| BodyStates::Deform { shapes: vec![Shape::of(&scene().meshes[0]).into(), shape.into()] };
        refused(&|body| body.motion.states = other(Shape::default()), "shape 1 (at 1 s) has 0 positions, but its mesh has 3");
        let bad = Shape { positions: vec![Vec3::X, Vec3::NAN, Vec3::Y], normals: Vec::new() };
        refused(&|body| body.motion.states = other(bad.clone()), "shape 1 (at 1 s) has vertex 1 that is not finite");
        refused(&|body| body.parts = vec![1, 2], "2 parts and 0 lights; expected one part");
        refused(&|body| body.limits = Some([0.0, 1.0]), "has no limits");
    }

    #[test]
    fn a_moment_becomes_rest() {
        let mut scene = scene();
        scene.bodies[1].limits = Some([0.0, 0.75]);
        // The door has turned by a quarter, so the handle on it slides along y, and is out by half a metre of three quarters.
        let there = scene.still_at(1.0);
        assert_eq!((there.is_still(), there.validate()), (true, Ok(())));
        assert!(at(&there, 2, 0.0).abs_diff_eq(at(&scene, 2, 1.0), 1e-12));
        let BodyStates::Slide { axis, .. } = &there.bodies[1].motion.states else { panic!() };
        assert!(axis.abs_diff_eq(DVec3::Y, 1e-12));
        assert_eq!(there.bodies[1].limits, Some([-0.5, 0.25]));
        assert_eq!(scene.still_at(0.0).parts, scene.parts);
    }

    #[test]
    fn motion_is_carried_by_similarities_alone() {
        let scene = scene();
        let map = DAffine3::from_scale_rotation_translation(DVec3::splat(2.0), DQuat::from_rotation_y(0.7), DVec3::new(0.3, -1.0, 2.0));
        for (id, point) in [(0, DVec3::new(3.0, 1.0, 0.5)), (1, DVec3::new(4.0, 0.2, 0.1))] {
            let body = &scene.bodies[id];
            let carried = body.carried(&map).unwrap();
            let expected = map.transform_point3(body.motion.world_from_rest(0.4).transform_point3(point));
            let found = carried.motion.world_from_rest(0.4).transform_point3(map.transform_point3(point));
            assert!(found.abs_diff_eq(expected, 1e-12));
        }
        for distorts in [DVec3::new(1.0, 2.0, 1.0), DVec3::new(-1.0, 1.0, 1.0)] {
            assert_eq!(scene.bodies[0].carried(&DAffine3::from_scale(distorts)), None);
        }
    }
}
