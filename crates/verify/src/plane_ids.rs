//! The law of planes: pixels that are recorded to show a plane of the rooms are on it.

use super::card::Card;
use super::law::Law;
use super::read::readable;
use enfilade_dataset::{Dataset, Elements};
use enfilade_frame::{Frame, Layer, vector};
use enfilade_math::DVec3;
use enfilade_scene::{PLANE_NEAR_M, PlaneKind, RoomPlane, Rooms, WALL};

/// Checks the planes of a frame, where it has them.
pub(super) fn check(dataset: &Dataset, [scene, camera]: [&str; 2], number: u32, rooms: &Rooms, frame: &Frame, card: &mut Card) {
    let Some(stored) = readable(card, dataset.read_plane_ids([scene, camera], number)).flatten() else { return };
    let Some(planes) = readable(card, dataset.read_plane_table(scene)) else { return };
    let place = format!("{scene}/{camera}/frame.{number:04}");
    let (Some(positions), Some(classes)) = (frame.get(Layer::Position), frame.get(Layer::Semantic)) else { return };
    let Elements::I16(ids) = &stored.values else { return };
    if ids.len() != frame.pixels() || planes != rooms.planes() {
        let what = if ids.len() == frame.pixels() { "metadata_planes.csv is of other rooms" } else { "planes of another size" };
        card.observe(Law::PlaneIds, f64::INFINITY, || format!("{place}: {what}"));
        return;
    }
    let is_wrong = |pixel: &usize| {
        let (p, class): (DVec3, i16) = (vector(positions, *pixel), classes.get(*pixel) as i16);
        !is_true(rooms, &planes, ids[*pixel], class, p)
    };
    let wrong: Vec<usize> = (0..ids.len()).filter(is_wrong).collect();
    card.observe(Law::PlaneIds, wrong.len() as f64, || {
        let first = wrong.first().copied().unwrap_or_default();
        let (x, y) = (first % frame.width as usize, first / frame.width as usize);
        format!("{place}: {} of {} pixels, the first of them ({x}, {y}), of plane {}", wrong.len(), ids.len(), ids[first])
    });
}

/// Whether a pixel of this class and point shows the plane of this number; −1 is none.
fn is_true(rooms: &Rooms, planes: &[RoomPlane], id: i16, class: i16, p: DVec3) -> bool {
    if id == -1 {
        return class != WALL || !rooms.walls.iter().any(|wall| wall.off_m(p) <= PLANE_NEAR_M);
    }
    let plane = usize::try_from(id).ok().and_then(|id| planes.get(id.wrapping_sub(1)));
    plane.is_some_and(|plane| {
        // Walls and ceiling may be labelled as one shell.
        let is_of_class = plane.kind.class() == class || (class, plane.kind) == (WALL, PlaneKind::Ceiling);
        is_of_class && (plane.normal.dot(p) - plane.offset_m).abs() <= PLANE_NEAR_M + 1e-9
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_testroom as testroom;

    #[test]
    fn planes_that_pixels_do_not_lie_on_are_found() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let rooms = testroom::rooms();
        let frame = dataset.read_frame("room", "cam_00", 1, &[Layer::Position, Layer::Semantic]).unwrap();
        let found = |change: &dyn Fn(&mut Vec<i16>)| {
            let (positions, classes) = (frame.get(Layer::Position).unwrap(), frame.get(Layer::Semantic).unwrap());
            let plane = |i: usize| rooms.plane_at(classes.get(i) as i16, vector(positions, i)).map_or(-1, |place| place as i16 + 1);
            let mut ids: Vec<i16> = (0..frame.pixels()).map(plane).collect();
            change(&mut ids);
            dataset.write_plane_table("room", &rooms.planes()).unwrap();
            let size = if ids.len() == frame.pixels() { [frame.height as usize, frame.width as usize] } else { [1, ids.len()] };
            dataset.write_plane_ids(["room", "cam_00"], 1, size, ids).unwrap();
            let mut card = Card::default();
            check(&dataset, ["room", "cam_00"], 1, &rooms, &frame, &mut card);
            card.finding(Law::PlaneIds).unwrap().value
        };
        assert_eq!(found(&|_| ()), 0.0);
        let some = |ids: &[i16]| ids.iter().position(|id| *id > 0).unwrap();
        assert!(found(&|ids| ids.iter_mut().for_each(|id| *id = if *id > 0 { *id % 5 + 1 } else { *id })) > 0.0);
        let of_a_wall = |ids: &[i16]| ids.iter().position(|id| *id > 2).unwrap();
        let put = |place: &dyn Fn(&[i16]) -> usize, id: i16| {
            found(&|ids| {
                let at = place(ids);
                ids[at] = id;
            })
        };
        assert_eq!((put(&some, 99), put(&some, -2), put(&of_a_wall, -1)), (1.0, 1.0, 1.0));
        assert!(found(&|ids| ids.truncate(3)).is_infinite());
    }
}
