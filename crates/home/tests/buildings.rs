//! Properties of every building that is not a home, whatever its seed.

use enfilade_home::check::faults;
use enfilade_home::light::Moment;
use enfilade_home::room::kind::{norm, row};
use enfilade_home::{Building, Home, HomeConfig, RoomKind, home, home_on};
use enfilade_scene::{DrawnPlan, DrawnRoom, NYU40};
use std::collections::BTreeSet;

/// Buildings that are no homes.
fn others() -> impl Iterator<Item = Building> {
    Building::ALL.into_iter().filter(|building| *building != Building::Home)
}

fn made(building: Building, rooms: &[RoomKind], seed: u64) -> Home {
    home(&HomeConfig { building, rooms: rooms.to_vec(), moment: Some(Moment::Day), ..HomeConfig::of_seed(seed) })
}

/// The families of a home's things.
fn families(home: &Home) -> BTreeSet<&str> {
    let object = |name: &'_ str| name.split('/').next().unwrap_or_default().len();
    let names = home.scene.parts.iter().map(|part| &part.name[..object(&part.name)]);
    names.map(|name| name.rsplit_once('_').map_or(name, |(family, _)| family)).collect()
}

#[test]
fn each_kind_of_room_is_possible_and_has_what_it_is_for() {
    // Schools and workshops have rooms in the other tests.
    for building in others().filter(|building| ![Building::School, Building::Workshop].contains(building)) {
        // Rooms of homes have tests of their own.
        let own = building.row().kinds.iter().filter(|kind| !Building::Home.row().has(**kind) && norm(**kind).window);
        // A kind of each building: `enfilade-bench -- faults --building …` looks at more.
        let chosen = building as usize % own.clone().count().max(1);
        if let Some(&kind) = own.clone().nth(chosen) {
            let home = made(building, &[kind], 3);
            assert_eq!(faults(&home), [], "{kind:?}");
            assert_eq!(home.scene.validate(), Ok(()), "{kind:?}");
            let there = families(&home);
            for (name, any) in row(kind).needs {
                assert!(any.iter().any(|family| there.contains(family)), "{kind:?} has no {name}: {there:?}");
            }
            let classes = home.labels.parts.iter().map(|label| label.semantic);
            assert!(classes.clone().all(|class| (1..=NYU40.len() as i16).contains(&class)), "{kind:?}");
            assert!(home.scene.cameras.iter().any(|camera| camera.name == format!("{}_1", kind.name())), "{kind:?}");
        }
    }
}

#[test]
fn a_school_has_a_corridor_with_a_door_to_each_classroom_and_lit_panels_in_its_ceilings() {
    let rooms = [RoomKind::Corridor, RoomKind::Classroom, RoomKind::Classroom];
    let school = made(Building::School, &rooms, 1);
    assert_eq!(faults(&school), []);
    let ways: Vec<_> = school.plan.doorways.iter().map(|way| (way.from, way.into)).collect();
    assert_eq!(ways, [(None, 0), (Some(0), 1), (Some(0), 2)]);
    let there = families(&school);
    assert!(["lockers", "student_desk", "class_board", "stacking_chair"].iter().all(|family| there.contains(family)), "{there:?}");
    assert!(there.contains("ceiling_panel") || there.contains("tube_lamp"), "{there:?}");
    assert!(school.plan.rooms.iter().all(|room| (2.8..=3.3).contains(&room.size.z)));
    let tiles = school.scene.parts.iter().filter(|part| part.name.starts_with("ceiling_") && part.name.ends_with("/grid"));
    assert_eq!(tiles.count(), 3);
}

#[test]
fn without_rooms_a_building_has_one_of_its_usual_lists_and_seeds_give_the_same_bytes() {
    for building in others() {
        let config = HomeConfig { building, ..HomeConfig::of_seed(5) };
        let text = serde_json::to_value(&config).unwrap();
        assert_eq!(text["building"], building.name());
        assert_eq!(serde_json::from_value::<HomeConfig>(text).unwrap(), config);
    }
    assert!(serde_json::to_value(HomeConfig::default()).unwrap().get("building").is_none());
    let [first, again] = [0, 0].map(|_| made(Building::Workshop, &[], 2));
    let kinds: Vec<RoomKind> = first.plan.rooms.iter().map(|room| room.kind).collect();
    assert!(Building::Workshop.row().programmes.contains(&&kinds[..]), "{kinds:?}");
    assert!(enfilade_scene::to_bytes(&first.scene) == enfilade_scene::to_bytes(&again.scene));
}

#[test]
fn words_of_drawn_plans_mean_rooms_of_the_building() {
    let polygon = [[0.0, 0.0], [5.2, 0.0], [5.2, 4.0], [0.0, 4.0]].map(Into::into).to_vec();
    let room = DrawnRoom { name: "r".into(), kind: "Conference room".into(), polygon, height_m: None };
    let plan = DrawnPlan { rooms: vec![room], ..DrawnPlan::default() };
    let config = HomeConfig { building: Building::Office, clutter: 0.0, ..HomeConfig::of_seed(3) };
    let office = home_on(&config, &Default::default(), &plan).unwrap();
    assert_eq!(office.plan.rooms[0].kind, RoomKind::Meeting);
    assert_eq!(faults(&office), []);
}
