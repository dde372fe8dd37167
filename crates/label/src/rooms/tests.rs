//! Fitted rooms beside those that surfaces were made of.

use super::*;
use enfilade_math::DVec3;
use enfilade_scene::{CEILING, FLOOR, OpeningKind, PartLabel, WALL};
use surfaces::{DOOR, WINDOW};

/// A building: faces of rooms as surfaces with their labels.
#[derive(Default)]
struct Model(Vec<LabelledTriangle>);

impl Model {
    /// A rectangle between two opposite corners of an upright or level plane, from its first corner along `along`.
    fn rectangle(&mut self, semantic: i16, instance: i16, corners: [DVec3; 4]) {
        let [a, b, c, d] = corners;
        for corners in [[a, b, c], [a, c, d]] {
            self.0.push(LabelledTriangle { corners, label: PartLabel { semantic, instance } });
        }
    }

    /// An upright rectangle over a way on the plan.
    fn upright(&mut self, semantic: i16, [from, to]: [[f64; 2]; 2], [low, high]: [f64; 2]) {
        let [a, b] = [DVec2::from(from), DVec2::from(to)];
        self.rectangle(semantic, if semantic == WALL { -1 } else { 7 }, [a.extend(low), b.extend(low), b.extend(high), a.extend(high)]);
    }

    /// Floor and ceiling over a rectangle.
    fn level(&mut self, [low, high]: [[f64; 2]; 2], heights: [f64; 2]) {
        for (semantic, z) in [FLOOR, CEILING].into_iter().zip(heights) {
            self.rectangle(
                semantic,
                -1,
                [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]].map(|[x, y]| DVec3::new(x, y, z)),
            );
        }
    }

    /// The whole model turned about the vertical, degrees.
    fn turned(mut self, deg: f64) -> Self {
        let turn = enfilade_math::DMat3::from_rotation_z(deg.to_radians());
        self.0.iter_mut().for_each(|t| t.corners = t.corners.map(|p| turn * p));
        self
    }
}

/// An L-shaped room and a square one, with a wall of 15 cm and a doorway between them, a door in it, and a window.
fn flat() -> Model {
    let mut model = Model::default();
    // The L: (0,0) to (5,4) without (3,2) to (5,4); the square beside its foot: (5.15,0) to (8,2).
    model.level([[0.0, 0.0], [5.0, 2.0]], [0.0, 2.6]);
    model.level([[0.0, 2.0], [3.0, 4.0]], [0.0, 2.6]);
    model.level([[5.15, 0.0], [8.0, 2.0]], [0.0, 2.4]);
    for (way, top) in [
        ([[0.0, 0.0], [5.0, 0.0]], 2.6),
        ([[5.0, 2.0], [3.0, 2.0]], 2.6),
        ([[3.0, 2.0], [3.0, 4.0]], 2.6),
        ([[3.0, 4.0], [0.0, 4.0]], 2.6),
        ([[5.15, 0.0], [8.0, 0.0]], 2.4),
        ([[8.0, 0.0], [8.0, 2.0]], 2.4),
        ([[8.0, 2.0], [5.15, 2.0]], 2.4),
    ] {
        model.upright(WALL, way, [0.0, top]);
    }
    // A doorway from 0.5 to 1.4 in both faces of the wall between.
    for (x, top) in [(5.0, 2.6), (5.15, 2.4)] {
        model.upright(WALL, [[x, 0.0], [x, 0.5]], [0.0, top]);
        model.upright(WALL, [[x, 1.4], [x, 2.0]], [0.0, top]);
        model.upright(WALL, [[x, 0.5], [x, 1.4]], [2.1, top]);
    }
    model.upright(DOOR, [[5.07, 0.5], [5.07, 1.4]], [0.0, 2.1]);
    // A window from 1 to 2.5 in the wall at x = 0.
    model.upright(WALL, [[0.0, 4.0], [0.0, 2.5]], [0.0, 2.6]);
    model.upright(WALL, [[0.0, 1.0], [0.0, 0.0]], [0.0, 2.6]);
    model.upright(WALL, [[0.0, 1.0], [0.0, 2.5]], [0.0, 0.9]);
    model.upright(WALL, [[0.0, 1.0], [0.0, 2.5]], [2.2, 2.6]);
    model.upright(WINDOW, [[-0.1, 1.0], [-0.1, 2.5]], [0.9, 2.2]);
    model
}

fn areas(rooms: &Rooms) -> Vec<f64> {
    rooms.outlines.iter().map(|room| (100.0 * room.area_m2()).round() / 100.0).collect()
}

#[test]
fn a_flat_is_found_as_it_is() {
    let found = fit_rooms(&flat().0).unwrap();
    assert_eq!(areas(&found), [16.0, 5.7], "{found:?}");
    assert_eq!(found.outlines.iter().map(|room| room.polygon.len()).collect::<Vec<_>>(), [6, 4]);
    assert_eq!(found.outlines.iter().map(|room| [room.floor_z_m, room.ceiling_z_m]).collect::<Vec<_>>(), [[0.0, 2.6], [0.0, 2.4]]);
    let fit = found.fit.unwrap();
    assert!(fit.near_share > 0.999 && fit.p95_m < 1e-6, "{fit:?}");
    let inner: Vec<&WallFace> = found.walls.iter().filter(|wall| !wall.outer).collect();
    assert!(inner.len() == 2 && inner.iter().all(|wall| (wall.thickness_m - 0.15).abs() < 1e-9), "{inner:?}");
    let [window, door] = [OpeningKind::Window, OpeningKind::Door].map(|kind| found.openings.iter().find(|o| o.kind == kind).unwrap());
    assert_eq!((found.openings.len(), window.walls.len(), door.walls.len()), (2, 1, 2));
    for (opening, size, center) in [(window, [1.5, 1.3], [0.0, 1.75, 1.55]), (door, [0.9, 2.1], [5.0, 0.95, 1.05])] {
        let off = opening.size_m().iter().zip(size).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-9 && opening.center().distance(center.into()) < 0.16, "{opening:?}");
    }
    assert_eq!(found.check(), Ok(()));
}

#[test]
fn a_turned_flat_is_found_too() {
    for deg in [0.4, 17.0, 44.0, 90.0] {
        let found = fit_rooms(&flat().turned(deg).0).unwrap();
        let total: f64 = found.outlines.iter().map(RoomOutline::area_m2).sum();
        assert!((total - 21.7).abs() < 0.01 && found.outlines.len() == 2 && found.openings.len() == 2, "{deg}: {found:?}");
        assert!(found.fit.unwrap().p95_m < 1e-3, "{deg}: {:?}", found.fit);
    }
}

#[test]
fn an_open_side_is_closed_by_floor_and_ceiling_and_a_table_tells_nothing() {
    let mut model = Model::default();
    model.level([[0.0, 0.0], [4.0, 3.0]], [0.0, 2.5]);
    for way in [[[0.0, 0.0], [4.0, 0.0]], [[4.0, 0.0], [4.0, 3.0]], [[0.0, 3.0], [0.0, 0.0]]] {
        model.upright(WALL, way, [0.0, 2.5]);
    }
    let found = fit_rooms(&model.0).unwrap();
    assert_eq!((areas(&found), found.outlines[0].kind.as_str()), (vec![12.0], "room"));
    assert_eq!(found.outlines[0].ceiling_z_m, 2.5);
    // A roof above the ceiling, of which the whole was labelled as wall, is another side of it.
    model.level([[-0.3, -0.3], [4.3, 3.3]], [0.0, 2.8]);
    assert_eq!(fit_rooms(&model.0).unwrap().outlines[0].ceiling_z_m, 2.5);
    assert!(fit_rooms(&[]).is_none());
    let floor: Vec<LabelledTriangle> = model.0.into_iter().filter(|t| t.label.semantic == FLOOR).collect();
    assert!(fit_rooms(&floor).is_none(), "a floor without walls is no room");
    let far = LabelledTriangle {
        corners: [DVec3::ZERO, DVec3::new(1e9, 0.0, 0.0), DVec3::new(0.0, 1.0, 2.0)],
        label: PartLabel { semantic: WALL, instance: -1 },
    };
    assert!(fit_rooms(&[far, floor[0], floor[1]]).is_none(), "what is far too large costs no memory");
    let nan = LabelledTriangle { corners: [DVec3::NAN; 3], ..floor[0] };
    assert!(fit_rooms(&[nan]).is_none());
}

#[test]
fn storeys_lie_above_each_other() {
    let mut model = Model::default();
    for (z, side) in [(0.0, 4.0), (2.8, 3.0)] {
        model.level([[0.0, 0.0], [side, 3.0]], [z, z + 2.5]);
        for way in [[[0.0, 0.0], [side, 0.0]], [[side, 0.0], [side, 3.0]], [[side, 3.0], [0.0, 3.0]], [[0.0, 3.0], [0.0, 0.0]]] {
            model.upright(WALL, way, [z, z + 2.5]);
        }
    }
    let found = fit_rooms(&model.0).unwrap();
    let told: Vec<[f64; 2]> = found.outlines.iter().map(|room| [room.area_m2(), room.floor_z_m].map(|v| (1e6 * v).round() / 1e6)).collect();
    assert_eq!(told, [[12.0, 0.0], [9.0, 2.8]]);
}
