//! Checks of what can be opened: the same things in the same room, fronts that open freely, and who has joints.

use super::piece_tests::nothing;
use super::{FAMILIES, Family};
use crate::builder::{Builder, pose};
use crate::meet::Body;
use crate::names::object_of;
use enfilade_math::{Bounds3, DAffine3, Rng, Vec3};
use enfilade_scene::{Body as Moving, BodyMotion, BodyStates, Scene};
use std::collections::BTreeSet;

/// Families with joints, and the most that a variant is known to have at least.
const JOINTED: [(&str, usize); 27] = [
    ("bed", 0),
    ("bottle_fridge", 1),
    ("console", 2),
    ("counter", 3),
    ("desk", 2),
    ("dresser", 3),
    ("dressing_table", 2),
    ("filing_cabinet", 3),
    ("glass_cabinet", 4),
    ("kitchen_island", 3),
    ("kitchen_unit", 1),
    ("lockers", 2),
    ("mirror_cabinet", 1),
    ("nightstand", 1),
    ("office_cabinet", 2),
    ("office_chair", 1),
    ("refrigerator", 1),
    ("shoe_cabinet", 2),
    ("sideboard", 5),
    ("till", 1),
    ("toilet", 1),
    ("toy_chest", 1),
    ("tv_bench", 1),
    ("wardrobe", 2),
    ("washbasin", 1),
    ("washing_machine", 2),
    ("workbench", 3),
];

/// Variants of each family that are built.
fn seeds() -> u64 {
    enfilade_testkit::seeds(3, 12)
}
/// Parts may sink this far into each other, metres.
const SINK: f32 = 0.004;

/// A variant of a family, and the random number that would follow.
fn built(family: &Family, seed: u64, mut b: Builder) -> (Scene, u64) {
    let mut rng = Rng::new(seed);
    (family.random)(&mut rng).build(&mut b, pose(0.3, -0.2, 0.0, 0.4), &mut rng);
    (b.finish().0, rng.next_u64())
}

/// The objects, and the box around all of them: drawers of an island are objects of their own, in its body.
fn room(scene: &Scene) -> (BTreeSet<&str>, Bounds3) {
    let objects = scene.parts.iter().map(|part| object_of(&part.name)).collect();
    (objects, Bounds3::from_points(scene.parts.iter().flat_map(|part| scene.world_positions(part))))
}

#[test]
fn what_opens_takes_the_room_of_what_does_not_and_is_free() {
    let found: Vec<String> = enfilade_parallel::flat_map(&JOINTED, |&(name, least)| {
        let family = FAMILIES.iter().find(|family| family.name == name).expect(name);
        let (mut most, mut found) = (0, Vec::new());
        for seed in 0..seeds() {
            let [(plain, next), (jointed, then)] = [nothing(), nothing().with_joints()].map(|b| built(family, seed, b));
            assert_eq!(next, then, "{name}, seed {seed}: other random numbers");
            same_room(&plain, &jointed, seed);
            found.extend(bound(&jointed).into_iter().map(|told| format!("{told}, seed {seed}")));
            most = most.max(jointed.bodies.len());
        }
        assert!(most >= least, "{name} has {most} joints");
        found
    });
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// Things are as large with joints as without, and of the same objects; what moves is of one object.
fn same_room(plain: &Scene, jointed: &Scene, seed: u64) {
    assert!(plain.bodies.is_empty());
    assert_eq!(jointed.validate(), Ok(()));
    let ((objects, usual), (found, around)) = (room(plain), room(jointed));
    assert_eq!(objects, found);
    let [low, high] = [around.min - usual.min, around.max - usual.max].map(|by| by.abs().max_element());
    assert!(low.max(high) < 2e-3, "seed {seed}: {around:?} with joints, {usual:?} without: {objects:?}");
    for body in &jointed.bodies {
        let own = |&part: &u32| object_of(&jointed.parts[part as usize].name) == object_of(&body.name);
        assert!(!body.parts.is_empty() && body.parts.iter().all(own), "{}", body.name);
    }
}

/// What runs into the rest of its own thing when it opens. Seats and levers turn about what is within them, and the box of a washing
/// machine's drawer goes through the sheet behind it, out of sight.
fn bound(scene: &Scene) -> Vec<String> {
    let is_within =
        |name: &str| name.ends_with("/seat") || name.ends_with("_lever") || name == "washing_machine_1/drawer" || name == "dryer_1/drawer";
    let mut found = Vec::new();
    for body in scene.bodies.iter().filter(|body| !is_within(&body.name)) {
        let object = object_of(&body.name);
        let moves = |part: &usize| body.parts.contains(&(*part as u32));
        let rest = |part: &usize| !moves(part) && object_of(&scene.parts[*part].name) == object;
        let rest = solid(scene, (0..scene.parts.len()).filter(rest), &DAffine3::IDENTITY);
        let deep = |share: &f64| is_deep(&solid(scene, (0..scene.parts.len()).filter(moves), &map_to(body, *share)), &rest);
        found.extend([0.1, 0.5, 1.0].into_iter().find(deep).map(|share| format!("{} open by {share}", body.name)));
    }
    found
}

/// The triangles of parts after a map of the world.
fn solid(scene: &Scene, parts: impl Iterator<Item = usize>, map: &DAffine3) -> Body {
    let mut body = Body::new("");
    for part in parts.map(|part| &scene.parts[part]) {
        let world: Vec<Vec3> = scene.world_positions(part).map(|p| map.transform_point3(p.as_dvec3()).as_vec3()).collect();
        body.push(scene.meshes[part.mesh as usize].triangles.iter().map(|t| t.map(|i| world[i as usize])).collect());
    }
    body
}

fn map_to(body: &Moving, share: f64) -> DAffine3 {
    let [closed, open] = body.limits.expect("it has limits");
    let state = closed + share * (open - closed);
    let states = match &body.motion.states {
        BodyStates::Hinge { point, axis, .. } => BodyStates::Hinge { point: *point, axis: *axis, angles_rad: vec![state] },
        BodyStates::Slide { axis, .. } => BodyStates::Slide { axis: *axis, distances_m: vec![state] },
        other @ (BodyStates::Free { .. } | BodyStates::Deform { .. }) => other.clone(),
    };
    BodyMotion { times_s: vec![0.0], states }.world_from_rest(0.0)
}

fn is_deep(a: &Body, b: &Body) -> bool {
    a.meets(b, Vec3::ZERO)
        && [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z].into_iter().all(|way| a.meets(b, way * SINK))
}
