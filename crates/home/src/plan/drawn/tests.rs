//! Plans of known answers, and plans that are wrong.

use crate::plan::FloorPlan;
use enfilade_math::{DVec2, Rng};
use enfilade_scene::{CeilingSlope, DrawnOpening, DrawnPlan, DrawnRoom, OpeningKind, Rooms, Slope};

fn room(kind: &str, polygon: &[[f64; 2]]) -> DrawnRoom {
    DrawnRoom { name: format!("the {kind}"), kind: kind.into(), polygon: polygon.iter().map(|&p| DVec2::from(p)).collect(), height_m: None }
}

fn opening(kind: OpeningKind, at: [f64; 2], width_m: Option<f64>) -> DrawnOpening {
    DrawnOpening { width_m, ..DrawnOpening::new(kind, at.into()) }
}

fn built(plan: &DrawnPlan) -> Result<(FloorPlan, Vec<String>), String> {
    FloorPlan::drawn(plan, &Rng::new(1))
}

/// An L of 6 × 5 metres with a notch of 2.4 × 2 for a hall, 0.1 m away.
fn l_shape() -> DrawnPlan {
    DrawnPlan {
        rooms: vec![
            room("living", &[[0.0, 0.0], [6.0, 0.0], [6.0, 3.0], [3.5, 3.0], [3.5, 5.0], [0.0, 5.0]]),
            room("hall", &[[3.6, 3.1], [6.0, 3.1], [6.0, 5.0], [3.6, 5.0]]),
        ],
        openings: vec![
            opening(OpeningKind::Door, [4.6, 3.05], None),
            opening(OpeningKind::Door, [6.1, 4.0], Some(1.01)),
            opening(OpeningKind::Window, [2.0, 0.0], Some(2.0)),
        ],
        strict: true,
        ..DrawnPlan::default()
    }
}

#[test]
fn an_l_has_its_area_walls_and_openings() {
    let (plan, notes) = built(&l_shape()).unwrap();
    assert_eq!(notes, Vec::<String>::new());
    let rooms = plan.to_rooms();
    assert!((rooms.outlines[0].area_m2() - 25.0).abs() < 1e-9 && (plan.rooms[0].area - 25.0).abs() < 1e-4);
    let lengths: Vec<f32> = plan.rooms[0].faces.iter().map(|face| face.length).collect();
    assert_eq!(lengths, [6.0, 3.0, 2.5, 2.0, 3.5, 5.0]);
    // The two walls of the notch are those to the hall.
    let inner: Vec<bool> = plan.rooms[0].faces.iter().map(|face| !face.has_outside()).collect();
    assert_eq!(inner, [false, false, true, true, false, false]);
    assert!(plan.rooms[0].faces[2].backs.iter().all(|back| (back.thickness - 0.1).abs() < 1e-4 && back.beyond == Some(1)));
    let door = rooms.openings.iter().find(|o| o.kind == OpeningKind::Door && o.walls.len() == 2).unwrap();
    assert!((door.size_m()[0] - 0.885).abs() < 1e-6 && (door.center().x - 4.6).abs() < 1e-6, "{door:?}");
    assert_eq!(plan.doorways.iter().map(|way| (way.from, way.into)).collect::<Vec<_>>(), [(None, 1), (Some(0), 1)]);
    assert_eq!(rooms.check(), Ok(()));
}

#[test]
fn rooms_that_touch_are_moved_apart_and_what_is_missing_is_added_and_said() {
    let plan = DrawnPlan {
        rooms: vec![
            room("living", &[[0.0, 0.0], [5.0, 0.0], [5.0, 4.0], [0.0, 4.0]]),
            // A slanted wall in the north-east.
            room("bedroom", &[[5.0, 0.0], [9.0, 0.0], [9.0, 2.0], [7.0, 4.0], [5.0, 4.0]]),
        ],
        ..DrawnPlan::default()
    };
    let (plan, notes) = built(&plan).unwrap();
    assert_eq!(notes.len(), 4, "{notes:#?}");
    for (note, part) in notes.iter().zip(["middles of walls", "an entrance was added", "\"the living\" to \"the bedroom\"", "no windows"]) {
        assert!(note.contains(part), "{note}");
    }
    assert!((plan.rooms[0].area - 4.94 * 4.0).abs() < 1e-3 && (plan.rooms[1].area - (14.0 - 0.06 * 4.0)).abs() < 1e-3);
    let slanted = &plan.rooms[1].faces[2];
    assert!((slanted.length - 8.0f32.sqrt()).abs() < 1e-4 && (slanted.inward.x + 0.5f32.sqrt()).abs() < 1e-5);
    assert!(plan.rooms.iter().all(|room| room.windows().count() > 0));
}

#[test]
fn the_layout_of_a_plan_gives_the_same_plan_again() {
    for plan in [built(&l_shape()).unwrap().0, FloorPlan::new(&crate::room::kind::usual_programme(7), &Rng::new(3))] {
        let rooms = plan.to_rooms();
        let text = serde_json::to_string(&rooms).unwrap();
        let (again, notes) = built(&DrawnPlan::from(&serde_json::from_str::<Rooms>(&text).unwrap())).unwrap();
        assert_eq!(notes, Vec::<String>::new());
        let again = again.to_rooms();
        assert_eq!(again.openings.len(), rooms.openings.len());
        for (a, b) in again.outlines.iter().zip(&rooms.outlines) {
            assert_eq!((&a.kind, a.area_m2() - b.area_m2() < 1e-3), (&b.kind, true));
        }
        for opening in &rooms.openings {
            let same = |other: &&enfilade_scene::WallOpening| {
                let ends = |o: &enfilade_scene::WallOpening| o.corners.map(enfilade_math::DVec3::from);
                other.kind == opening.kind && ends(other).iter().zip(ends(opening)).all(|(a, b)| a.distance(b) < 2e-3)
            };
            let found = again.openings.iter().find(same).unwrap_or_else(|| panic!("{opening:?} of {:#?}", again.openings));
            assert_eq!(found.leaf.map(|leaf| leaf.hinge), opening.leaf.map(|leaf| leaf.hinge));
        }
    }
}

#[test]
fn slivers_and_openings_that_are_a_little_too_wide_in_files_of_other_programs_are_mended_and_said() {
    let mut plan = DrawnPlan { strict: false, ..l_shape() };
    // A shaft in the corner outside, and a window of 6 m, of which the wall has 5.88 m.
    plan.rooms.push(room("toilet", &[[8.0, 8.0], [8.3, 8.0], [8.3, 8.4], [8.0, 8.4]]));
    plan.openings[2].width_m = Some(6.0);
    let (found, notes) = built(&plan).unwrap();
    assert_eq!(found.rooms.len(), 2);
    assert!(notes[0].starts_with("room \"the toilet\" has 0.12 m2; it is left out"), "{notes:?}");
    assert!(notes[1].contains("is 6.00 m wide: it was made 5.88 m wide"), "{notes:?}");
    assert!(built(&DrawnPlan { strict: true, ..plan }).unwrap_err().contains("expected at least 0.8 m2"));
}

/// A change of a plan.
type Change<'a> = &'a dyn Fn(&mut DrawnPlan);

#[test]
fn what_is_wrong_with_a_plan_is_told() {
    let l = l_shape();
    let with = |change: Change| {
        let mut plan = l.clone();
        change(&mut plan);
        built(&plan).unwrap_err()
    };
    let cases: [(Change, &str); 12] = [
        (&|p| p.rooms[1].polygon[0] = DVec2::new(3.0, 2.5), "rooms \"the living\" and \"the hall\" overlap at"),
        (&|p| p.rooms[0].polygon.swap(0, 1), "the outline of room \"the living\" crosses itself near"),
        (&|p| p.rooms[0].kind = "livingroom".into(), "is of the kind \"livingroom\"; did you mean `living`?"),
        (&|p| p.openings[0].width_m = Some(3.0), "the door at [4.60, 3.05] is 3.00 m wide, expected at most 1.4 m, or a passage"),
        (&|p| p.openings[2].width_m = Some(7.0), "the window at [2.00, 0.00] is 7.00 m wide, but the wall of \"the living\" has 5.88 m"),
        (&|p| p.openings[1].kind = OpeningKind::Passage, "leads to the outside, expected a door there"),
        (&|p| p.openings[2] = opening(OpeningKind::Door, [4.8, 3.05], None), "overlaps another opening"),
        (&|p| p.openings[2].at = DVec2::new(4.5, 3.05), "is in the wall between \"the living\" and \"the hall\", expected an outer wall"),
        (&|p| p.openings[2].at = DVec2::new(2.0, 2.0), "the window at [2.00, 2.00] is in no wall"),
        (&|p| p.openings[2].z_m = Some([1.0, 2.9]), "reaches from 1.00 m to 2.90 m"),
        (&|p| p.rooms[1].polygon = [[9.0, 9.0], [12.0, 9.0], [12.0, 12.0], [9.0, 12.0]].map(DVec2::from).to_vec(), "is in"),
        (&|p| p.rooms[0].height_m = Some(26.0), "is 26 m high, expected 2.2 to 6 m"),
    ];
    for (change, part) in cases {
        let message = with(change);
        assert!(message.contains(part), "{message}");
    }
    // Slopes over the living room, from its south wall or from a place of their own.
    let under = |low_z_m: f64, pitch_deg: f64, y: f64| {
        let mut plan = l.clone();
        plan.slopes = vec![CeilingSlope { room: 0, slope: Slope { from: [0.0, y], to: [6.0, y], low_z_m, pitch_deg } }];
        built(&plan)
    };
    for (slope, part) in [
        (
            (1.2, 40.0, 0.0),
            "the window at [2.00, 0.00] reaches from 0.60 m to 0.57 m, expected at least 0.3 m between the floor and 0.85 m",
        ),
        ((0.3, 40.0, 0.0), "the ceiling of room \"the living\" is 0.30 m high at [0.00, 0.00], expected at least 0.5 m"),
        ((1.2, 80.0, 0.0), "has 80 degrees, expected 5 to 75"),
        ((2.9, 40.0, 0.0), "is above the ceilings of all its rooms"),
        ((0.6, 10.0, 0.0), "is at least 1.9 m high over 0 % of its floor, expected 30 %"),
    ] {
        let message = under(slope.0, slope.1, slope.2).unwrap_err();
        assert!(message.contains(part), "{message}");
    }
    let apart = DrawnPlan {
        rooms: vec![
            room("living", &[[0.0, 0.0], [5.0, 0.0], [5.0, 4.0], [0.0, 4.0]]),
            room("bedroom", &[[7.0, 0.0], [9.0, 0.0], [9.0, 4.0], [7.0, 4.0]]),
        ],
        ..DrawnPlan::default()
    };
    let message = built(&apart).unwrap_err();
    assert!(message.starts_with("room \"the bedroom\" has no door, and shares no wall of 0.9 m"), "{message}");
    assert!(built(&DrawnPlan::default()).unwrap_err().contains("0 rooms"));
}
