//! What can be opened in homes: ranges that are free, states that are asked for, and homes that stay as they are without.

use enfilade_furniture::{JointKind, object_of};
use enfilade_home::check::faults;
use enfilade_home::{Home, HomeConfig, RoomKind, State, StateWord, States, home};
use enfilade_math::{DVec3, Vec3};
use enfilade_scene::{Body, BodyStates};
use std::collections::{BTreeMap, BTreeSet};

/// Without life, which leaves ranges of joints free.
fn with(states: Option<States>) -> Home {
    let rooms = vec![RoomKind::Hall, RoomKind::Bedroom, RoomKind::Kitchen, RoomKind::Bathroom];
    home(&HomeConfig { rooms, states, lived_in: 0.0, ..HomeConfig::of_seed(5) })
}

fn all(word: StateWord) -> Option<States> {
    Some(States::All(State::Word(word)))
}

fn each<const N: usize>(named: [(&str, State); N]) -> Option<States> {
    Some(States::Each(named.into_iter().map(|(name, state)| (name.to_string(), state)).collect()))
}

fn body<'a>(home: &'a Home, name: &str) -> &'a Body {
    home.scene.bodies.iter().find(|body| body.name == name).expect("the joint has a body")
}

/// Where the parts of each object are, without those that only things with joints have.
fn places(home: &Home) -> BTreeMap<&str, DVec3> {
    home.scene.parts.iter().map(|part| (part.name.as_str(), part.world_from_mesh.translation)).collect()
}

/// One test, as making the homes takes far longer than looking at them.
#[test]
fn things_open_as_far_as_they_are_asked_to_and_as_they_can() {
    let [plain, made, closed, open, random] =
        [None, all(StateWord::Made), all(StateWord::Closed), all(StateWord::Open), all(StateWord::Random)].map(with);
    joints_leave_a_home_as_it_is(&plain, &made);
    ranges_are_free_and_of_one_object(&made);
    closed_things_are_at_the_one_end_and_open_ones_at_the_other(&made, &closed, &open);
    random_states_are_a_function_of_the_seed(&random);
    for (home, word) in [(&made, "made"), (&closed, "closed"), (&open, "open"), (&random, "random")] {
        let found = faults(home);
        let of_joints: Vec<String> = found.iter().map(ToString::to_string).collect();
        assert!(found.is_empty(), "{word}: {}", of_joints.join("\n"));
        assert_eq!(home.scene.validate(), Ok(()));
        assert!(home.scene.is_still(), "{word}");
    }
}

#[test]
fn what_people_leave_is_not_in_the_way_of_what_opens() {
    let rooms = vec![RoomKind::Bedroom, RoomKind::Kitchen];
    for states in [all(StateWord::Random), all(StateWord::Open)] {
        let home = home(&HomeConfig { rooms: rooms.clone(), states, lived_in: 0.8, ..HomeConfig::of_seed(7) });
        assert_eq!(faults(&home), []);
    }
}

fn joints_leave_a_home_as_it_is(plain: &Home, made: &Home) {
    assert!(plain.joints.is_empty() && plain.scene.bodies.is_empty() && plain.rooms().joints.is_empty());
    assert_eq!((&plain.removed, plain.moved.len()), (&made.removed, made.moved.len()));
    let (usual, found) = (places(plain), places(made));
    let moved: Vec<&str> = usual
        .iter()
        .filter(|(name, at)| found.get(*name).is_some_and(|here| !here.abs_diff_eq(**at, 1e-9)))
        .map(|(name, _)| *name)
        .collect();
    assert!(moved.is_empty(), "{moved:?}");
    // Only what was one part is several now.
    let gone: BTreeSet<&str> = usual.keys().filter(|name| !found.contains_key(*name)).filter_map(|name| name.split('/').nth(1)).collect();
    assert!(gone.iter().all(|part| ["knobs", "pulls"].contains(part)), "{gone:?}");
}

fn ranges_are_free_and_of_one_object(made: &Home) {
    let kinds: BTreeSet<JointKind> = made.joints.iter().map(|joint| joint.kind).collect();
    for kind in [JointKind::Door, JointKind::Window, JointKind::Cupboard, JointKind::Drawer, JointKind::Lid, JointKind::Tap] {
        assert!(kinds.contains(&kind), "no {}", kind.name());
    }
    for joint in &made.joints {
        let body = body(made, &joint.body);
        let [closed, open] = body.limits.unwrap();
        assert!(joint.built[0] <= closed && closed <= 0.0 && 0.0 <= open && open <= joint.built[1], "{joint:?} {:?}", body.limits);
        let is_limited = closed - joint.built[0] > 1e-9 || joint.built[1] - open > 1e-9;
        assert_eq!(is_limited, joint.limited_by.is_some(), "{joint:?} {:?}", body.limits);
        let label = made.labels.parts[body.parts[0] as usize];
        let own = |part: &&u32| object_of(&made.scene.parts[**part as usize].name) == object_of(&joint.body);
        assert!(body.parts.iter().filter(own).all(|&part| made.labels.parts[part as usize] == label), "{}", joint.body);
        assert!(label.semantic > 0 && label.instance > 0, "{}", joint.body);
    }
    let listed = made.rooms().joints;
    assert_eq!(listed.len(), made.joints.len());
    let door = listed.iter().find(|joint| joint.kind == "door").unwrap();
    assert_eq!((door.joint.as_str(), door.axis[0], door.axis[2].abs()), ("hinge", 0.0, 1.0));
    let drawer = listed.iter().find(|joint| joint.kind == "drawer").unwrap();
    assert!(drawer.state == 0.0 && drawer.limits[0] == 0.0 && drawer.point_m.is_none(), "{drawer:?}");
}

fn closed_things_are_at_the_one_end_and_open_ones_at_the_other(made: &Home, closed: &Home, open: &Home) {
    let state = |home: &Home| home.rooms().joints.into_iter().map(|joint| (joint.name.clone(), joint)).collect::<BTreeMap<_, _>>();
    let (was, shut, wide) = (state(made), state(closed), state(open));
    for (name, joint) in &was {
        let range = joint.limits[1] - joint.limits[0];
        let moves = joint.kind != "chair" && range > 1e-6;
        if moves {
            assert!(shut[name].state < 1e-9, "{:?}", shut[name]);
            let told = open.state_notes.iter().any(|note| note.starts_with(name.as_str()));
            assert!(wide[name].state > 1.0 - 1e-9 || told, "{:?}", wide[name]);
        }
        assert!((wide[name].limits[1] - wide[name].limits[0] - range).abs() < 1e-9);
    }
    // The layout's doors are as open as their leaves; the entrance stays shut.
    let leaves = |home: &Home| home.rooms().openings.iter().filter_map(|opening| Some(opening.leaf?.open_deg)).collect::<Vec<_>>();
    let doors = was.values().filter(|joint| joint.kind == "door").count();
    assert_eq!((leaves(closed).iter().filter(|&&open| open == 0.0).count(), leaves(made).len()), (doors + 1, doors + 1));
    assert_eq!(leaves(open).iter().filter(|&&open| open > 60.0).count(), doors, "{:?}", leaves(open));
    // What moved is where its joint takes it.
    let drawer = was.values().find(|joint| joint.kind == "drawer" && joint.limits[1] > 0.1).unwrap();
    let by = DVec3::from_array(drawer.axis) * (drawer.limits[1] * wide[&drawer.name].state);
    let part = body(made, &drawer.name).parts[0] as usize;
    let went = open.scene.parts[part].world_from_mesh.translation - made.scene.parts[part].world_from_mesh.translation;
    assert!(went.abs_diff_eq(by, 1e-9), "{went} {by}");
}

fn random_states_are_a_function_of_the_seed(random: &Home) {
    let again = with(all(StateWord::Random));
    assert_eq!(places(&again), places(random));
    let states: Vec<f64> = random.rooms().joints.iter().filter(|joint| joint.kind == "drawer").map(|joint| joint.state).collect();
    assert!(states.contains(&0.0) && states.iter().any(|state| (0.05..0.95).contains(state)), "{states:?}");
}

#[test]
fn single_things_are_opened_by_name_and_names_of_nothing_are_told() {
    let rooms = vec![RoomKind::Hall, RoomKind::Bathroom];
    let config = |states| HomeConfig { rooms: rooms.clone(), states, ..HomeConfig::of_seed(2) };
    let named = each([("*/lid", State::Share(0.5)), ("door", State::Share(0.25)), ("toilett_1", State::Share(1.0))]);
    let made = home(&config(named));
    assert_eq!(made.state_notes, ["nothing in this home is called \"toilett_1\"; did you mean \"toilet_1\"?"]);
    let rooms = made.rooms();
    let state = |kind: &str| rooms.joints.iter().filter(|joint| joint.kind == kind).map(|joint| joint.state).collect::<Vec<_>>();
    assert!(state("lid").iter().all(|state| (state - 0.5).abs() < 1e-9) && state("lid").len() == 1);
    assert!(state("door").iter().all(|state| (state - 0.25).abs() < 1e-9) && !state("door").is_empty());
    assert!(state("drawer").iter().all(|&state| state == 0.0));
    // The lid stands at half its angle: its parts are where a turn of the closed one about the hinge takes them.
    let shut = home(&config(each([("lid", State::Word(StateWord::Closed))])));
    let [half, flat] = [&made, &shut].map(|home| body(home, "toilet_1/lid"));
    let BodyStates::Hinge { point, axis, .. } = &flat.motion.states else { panic!("a lid turns") };
    let angle = flat.limits.unwrap()[1] * 0.5;
    let part = flat.parts[0] as usize;
    let turned = |p: DVec3| *point + enfilade_math::DQuat::from_axis_angle(*axis, angle) * (p - *point);
    let corner = |home: &Home| home.scene.world_positions(&home.scene.parts[part]).next().unwrap();
    assert!(corner(&made).abs_diff_eq(turned(corner(&shut).as_dvec3()).as_vec3(), 1e-4), "{:?}", half.limits);
    assert!(corner(&made).distance(corner(&shut)) > 0.01 && Vec3::ZERO != corner(&made));
}
