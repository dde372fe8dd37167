//! Rooms that are fitted to generated homes, beside those that the homes were built after.

use enfilade_home::{HomeConfig, home};
use enfilade_label::rooms::{LabelledTriangle, fit_rooms};
use enfilade_scene::{OpeningKind, RoomOutline, Rooms};

/// The surfaces of a home, with their labels.
fn surfaces(home: &enfilade_home::Home) -> Vec<LabelledTriangle> {
    let scene = &home.scene;
    let of_part = |(part, label): (&enfilade_scene::Part, &enfilade_scene::PartLabel)| {
        let (label, count) = (*label, scene.meshes[part.mesh as usize].triangles.len());
        let triangle = |i| LabelledTriangle { corners: scene.world_corners(part, i).map(|p| p.as_dvec3()), label };
        (0..count).map(triangle).collect::<Vec<_>>()
    };
    scene.parts.iter().zip(&home.labels.parts).flat_map(of_part).collect()
}

/// The place of the room in `in_` that has the same middle and area within 1 %, if there is one.
fn same_room(room: &RoomOutline, in_: &Rooms) -> Option<usize> {
    let bounds = |room: &RoomOutline, axis: usize| {
        let along = || room.polygon.iter().map(|p| p[axis]);
        [along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max)]
    };
    let is_same = |other: &RoomOutline| {
        let ends = |room| [bounds(room, 0), bounds(room, 1)].concat();
        let off = ends(room).into_iter().zip(ends(other)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        off < 0.02 && (room.area_m2() / other.area_m2() - 1.0).abs() < 0.01
    };
    in_.outlines.iter().position(is_same)
}

#[test]
fn rooms_doors_and_windows_of_homes_are_found_again() {
    for seed in [7, 11] {
        let home = home(&HomeConfig { seed, ..HomeConfig::default() });
        let (exact, found) = (home.rooms(), fit_rooms(&surfaces(&home)).unwrap());
        // Wide passages join rooms; all others are there.
        let passages = exact.openings.iter().filter(|o| o.kind == OpeningKind::Passage);
        let joined: Vec<usize> = passages.flat_map(|passage| exact.rooms_of(passage).collect::<Vec<_>>()).collect();
        for (i, room) in exact.outlines.iter().enumerate().filter(|(i, _)| !joined.contains(i)) {
            let place = same_room(room, &found).unwrap_or_else(|| panic!("{seed}: no room {i} {room:?} in {:?}", found.outlines));
            let there = &found.outlines[place];
            assert!((there.floor_z_m - room.floor_z_m).abs() < 0.03 && (there.ceiling_z_m - room.ceiling_z_m).abs() < 0.03, "{there:?}");
        }
        for opening in exact.openings.iter().filter(|o| o.kind != OpeningKind::Passage) {
            // Casings surround the hole.
            let is_there = |other: &&enfilade_scene::WallOpening| {
                other.kind == opening.kind && other.center().distance(opening.center()) < 0.2 && {
                    let [a, b] = [opening.size_m(), other.size_m()];
                    (a[0] - b[0]).abs() < 0.2 && (a[1] - b[1]).abs() < 0.2
                }
            };
            let there = found.openings.iter().find(is_there);
            assert!(there.is_some_and(|other| other.walls.len() == opening.walls.len()), "{seed}: {opening:?}, found {there:?}");
        }
        let doors = |rooms: &Rooms| rooms.openings.iter().filter(|o| o.kind != OpeningKind::Passage).count();
        assert!(doors(&found) <= doors(&exact) + 1, "{seed}: {:?}", found.openings);
        assert!(found.fit.unwrap().near_share > 0.85, "{seed}: {:?}", found.fit);
        assert_eq!(found.check(), Ok(()));
    }
}
