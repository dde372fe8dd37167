//! Floor plans: from a list of rooms and a seed to rooms with walls, doors and windows.
//!
//! A home is a rectangle cut into cells (`slicing`); a search looks for cuts whose rooms have the widths, proportions, daylight and
//! ways that building practice asks for (`room::kind`, `search`). Rooms of offices and schools are on both sides of a corridor
//! (`corridor`). Doors, passages and windows follow (`openings`). Plans that people draw
//! are built as they are (`drawn`); homes of other shapes are such plans too (`varied`, `roof`).

mod corridor;
mod drawn;
mod openings;
mod roof;
mod rooms;
mod search;
pub mod slicing;
mod varied;

pub use openings::Doorway;

use crate::building::{Building, Layout};
use crate::room::{Room, Side, kind};
use enfilade_furniture::RoomKind;
use enfilade_math::{Rng, Vec3};
use search::{Site, Sketch, on_side, search};
use slicing::Cell;

/// The rooms of a home in their places; the middle of the home is the origin.
#[derive(Clone, Debug)]
pub struct FloorPlan {
    /// In the order of the programme.
    pub rooms: Vec<Room>,
    /// The ways between them; the first is the entrance.
    pub doorways: Vec<Doorway>,
    /// The inner faces of the outer walls.
    pub whole: Cell,
}

/// Searches that are tried before the best of them is taken.
const ATTEMPTS: usize = 6;

impl FloorPlan {
    /// A plan of a home for rooms of these kinds.
    ///
    /// # Panics
    /// When `kinds` is empty.
    pub fn new(kinds: &[RoomKind], rng: &Rng) -> Self {
        Self::of(Building::Home, kinds, rng)
    }

    /// A plan of a building for rooms of these kinds.
    ///
    /// # Panics
    /// When `kinds` is empty.
    pub fn of(building: Building, kinds: &[RoomKind], rng: &Rng) -> Self {
        assert!(!kinds.is_empty(), "a home has at least one room, found none");
        let mut draw = rng.fork(0);
        let entrance = [Side::West, Side::East][draw.below(2)];
        let mut open = [true; 4];
        open[entrance as usize] = kinds.len() == 1;
        open[entrance.turned(2) as usize] = kinds.len() > 6 || draw.below(3) > 0;
        let site = Site { open, entrance };
        let building = building.row();
        let has_corridor = kinds.iter().any(|&kind| kind::row(kind).ways.is_way);
        if building.layout == Layout::Corridor && has_corridor && kinds.len() > 1 {
            let sketch = corridor::along(kinds, &mut rng.fork(9));
            // Rooms of very different sizes, which cannot be equally deep, are laid out around the corridor instead.
            if sketch.cost < corridor::FINE * kinds.len() as f32 {
                return Self::build(kinds, &sketch, site, building.height, &mut draw);
            }
        }
        let mut best: Option<Sketch> = None;
        for attempt in 0..ATTEMPTS as u64 {
            let found = search(kinds, site, &mut rng.fork(10 + attempt));
            if best.as_ref().is_none_or(|b| found.cost < b.cost) {
                best = Some(found);
            }
            if best.as_ref().is_some_and(|b| b.cost < Sketch::FINE) {
                break;
            }
        }
        let sketch = best.unwrap_or_else(|| search(kinds, site, &mut draw));
        Self::build(kinds, &sketch, site, building.height, &mut draw)
    }

    fn build(kinds: &[RoomKind], sketch: &Sketch, site: Site, heights: [f32; 2], rng: &mut Rng) -> Self {
        let (inner_wall, outer_wall) = (rng.range(0.11, 0.15), rng.range(0.32, 0.4));
        let height = rng.range(heights[0], heights[1]);
        let room = |(&kind, cell): (&RoomKind, &Cell)| {
            let outer = Side::ALL.map(|w| on_side(cell, &sketch.whole, w));
            let inset = |w: Side| if outer[w as usize] { 0.0 } else { 0.5 * inner_wall };
            let mut clear = *cell;
            clear.min += enfilade_math::Vec2::new(inset(Side::West), inset(Side::South));
            clear.max -= enfilade_math::Vec2::new(inset(Side::East), inset(Side::North));
            let size = Vec3::new(clear.size().x, clear.size().y, height);
            Room::rectangle(kind, clear.center(), size, outer, [inner_wall, outer_wall])
        };
        let mut rooms: Vec<Room> = kinds.iter().zip(&sketch.cells).map(room).collect();
        let doorways = openings::add_doors(&mut rooms, sketch, kinds, site, rng);
        for room in &mut rooms {
            let open = |side: &Side| room.face(side.wall()).has_outside() && site.open[*side as usize];
            let walls = Side::ALL.into_iter().filter(open).map(Side::wall).collect();
            openings::add_windows(room, walls, rng);
        }
        Self { rooms, doorways, whole: sketch.whole }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::room::Filling;
    use crate::room::kind::{norm, usual_programme};

    /// Programmes of one to eight rooms, and some that lack what others take for granted.
    fn programmes() -> Vec<Vec<RoomKind>> {
        use RoomKind::{Bathroom, Bedroom, Kitchen, Laundry, Toilet};
        let mut all: Vec<_> = (1..=8).map(usual_programme).collect();
        all.push(vec![Bedroom, Bathroom]);
        all.push(vec![Kitchen, Toilet, Laundry]);
        all.push(vec![Bedroom; 4]);
        all
    }

    fn reachable(plan: &FloorPlan) -> usize {
        let mut seen = vec![false; plan.rooms.len()];
        seen[plan.doorways[0].into] = true;
        for _ in 0..plan.rooms.len() {
            for way in &plan.doorways {
                if let Some(from) = way.from {
                    let any = seen[from] || seen[way.into];
                    (seen[from], seen[way.into]) = (any, any);
                }
            }
        }
        seen.iter().filter(|&&s| s).count()
    }

    #[test]
    fn every_room_is_reachable_wide_enough_and_lit() {
        let mut broken = 0;
        for kinds in programmes() {
            for seed in 0..40 {
                let plan = FloorPlan::new(&kinds, &Rng::new(seed));
                assert_eq!(reachable(&plan), kinds.len(), "{kinds:?} {seed}");
                for room in &plan.rooms {
                    let norm = norm(room.kind);
                    let windows = room.openings.iter().filter(|o| matches!(o.filling, Filling::Window { .. }));
                    let lit = !norm.window || windows.count() > 0;
                    broken += usize::from(room.size.truncate().min_element() < norm.width - 0.03 || !lit);
                    for (i, a) in room.openings.iter().enumerate() {
                        let half = 0.5 * room.length(a.wall);
                        assert!(a.x[0] > -half && a.x[1] < half, "{kinds:?} {seed}: {a:?} in a wall of {}", 2.0 * half);
                        let apart = |b: &crate::room::Opening| a.wall != b.wall || a.x[0] > b.x[1] + 0.05 || b.x[0] > a.x[1] + 0.05;
                        assert!(room.openings[..i].iter().all(apart), "{kinds:?} {seed}: {:?}", room.openings);
                    }
                }
            }
        }
        assert_eq!(broken, 0);
    }

    #[test]
    fn the_same_seed_gives_the_same_plan() {
        let kinds = usual_programme(7);
        let plan = |seed| format!("{:?}", FloorPlan::new(&kinds, &Rng::new(seed)));
        assert_eq!(plan(5), plan(5));
        assert_ne!(plan(5), plan(6));
    }
}
