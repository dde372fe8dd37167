//! Placement: the floor of a room, which only accepts things that leave people room to walk.
//!
//! Things are placed one after another, the most important first. For each, candidates along the walls or over the floor are sorted
//! by a cost, and the first that fits is taken: no solid meets another or a space that must stay free (where doors swing, before
//! drawers, before windows), and a person can still walk from every door to every other and up to everything that has a front.

mod scatter;
mod walk;

pub use crate::room::Footprint;
pub use scatter::scatter;
pub use walk::{BODY, Walk};

use crate::room::{Room, Wall};
use enfilade_furniture::{CONTACT, pose};
use enfilade_math::{DAffine3, Vec2, Vec3};

/// Distance between walls and the things along them, because of the skirting, metres.
const WALL_GAP: f32 = 0.02;
/// Distance between walls and the things along them in rooms with tiles, where things are fixed to the wall, metres.
const TILED_GAP: f32 = 0.0;
/// Distance between things that do not belong together, metres.
const AIR: f32 = 0.02;
/// People walk under what is higher than this, metres.
const HEADROOM: f32 = 2.0;
/// People step over what is lower than this, metres.
const UNDERFOOT: f32 = 0.03;
/// Things on the floor that are lower than this are stepped over, and drawers and doors open above them, metres.
const LYING: f32 = 0.11;
/// Distance between a window and things higher than its sill, metres.
const BEFORE_WINDOW: f32 = 0.22;
/// Length of a window's sill beyond each side, metres.
const SILL_END: f32 = 0.06;
/// Height of a door's casing above it, metres.
const CASING: f32 = 0.08;
/// Distance between candidates along walls, metres.
const STEP: f32 = 0.05;
/// Air between things and a sloping ceiling, metres.
const BELOW_SLOPE: f32 = 0.03;
/// Candidates whose ways around are checked before giving up.
const TRIALS: usize = 80;

/// A thing of a group, in the group's space: origin just before the wall behind it, x along the wall, y into the room.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    /// Width, depth and height of the box around the thing.
    pub size: Vec3,
    /// The middle of its footprint.
    pub at: Vec2,
    /// Turn of the thing; 0 faces into the room.
    pub yaw: f32,
    /// Lower end of its box above the floor.
    pub z: f32,
    /// Depth of floor before it that must stay free.
    pub reach: f32,
    /// Lies flat on the floor: people walk over it, but other groups do not stand on it.
    pub flat: bool,
    /// Free height over it under a sloping ceiling, metres, where people need more than it does itself.
    pub headroom: f32,
}

impl Piece {
    /// Something that stands with its back to the wall.
    pub fn standing(size: Vec3, reach: f32) -> Self {
        Self { size, at: Vec2::new(0.0, 0.5 * size.y), yaw: 0.0, z: 0.0, reach, flat: false, headroom: 0.0 }
    }

    /// The thing at another place of the group.
    #[must_use]
    pub fn at(self, x: f32, y: f32, yaw: f32) -> Self {
        Self { at: Vec2::new(x, y), yaw, ..self }
    }
}

/// Where a group may stand.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    /// The origin of the group.
    pub origin: Vec2,
    /// Turn of the group.
    pub yaw: f32,
    /// The wall behind it.
    pub wall: Option<Wall>,
    /// Place of the group along that wall.
    pub x: f32,
}

impl Spot {
    /// From the group's space to the room's.
    pub fn point(&self, p: Vec2) -> Vec2 {
        self.origin + Vec2::from_angle(self.yaw).rotate(p)
    }

    /// The way that it faces.
    pub fn front(&self) -> Vec2 {
        Vec2::from_angle(self.yaw).perp()
    }
}

#[derive(Clone, Copy, Debug)]
struct Taken {
    footprint: Footprint,
    z: [f32; 2],
    /// False for space that must stay free of solids.
    solid: bool,
}

/// The floor of one room, with what stands on it so far.
#[derive(Clone, Debug)]
pub struct Floor {
    room: Room,
    gap: f32,
    taken: Vec<Taken>,
    walk: Walk,
    fronts: Vec<Footprint>,
}

impl Floor {
    /// The empty room: its ways and windows are to be kept free.
    pub fn new(room: &Room) -> Self {
        let gap = if room.kind.wet() { TILED_GAP } else { WALL_GAP };
        let mut floor = Self { room: room.clone(), gap, taken: Vec::new(), walk: Walk::new(room), fronts: Vec::new() };
        for opening in &room.openings {
            let around = [opening.x[0] - SILL_END, opening.x[1] + SILL_END];
            let zone = if opening.is_way() { room.way_zone(opening) } else { floor.strip(opening.wall, around, BEFORE_WINDOW) };
            let z = if opening.is_way() { [0.0, opening.z[1] + CASING] } else { [opening.z[0] - 0.01, opening.z[1]] };
            floor.taken.push(Taken { footprint: zone, z, solid: false });
        }
        floor
    }

    /// Distance between walls and the things along them, metres.
    pub fn gap(&self) -> f32 {
        self.gap
    }

    /// The room.
    pub fn room(&self) -> &Room {
        &self.room
    }

    /// The floor before a piece of wall, `depth` metres deep.
    pub fn strip(&self, wall: Wall, x: [f32; 2], depth: f32) -> Footprint {
        let center = self.room.before(wall, 0.5 * (x[0] + x[1]), 0.5 * depth);
        Footprint { center, half: Vec2::new(0.5 * (x[1] - x[0]), 0.5 * depth), yaw: self.room.yaw(wall) }
    }

    /// Records something solid that is there whatever is placed.
    pub fn take(&mut self, footprint: Footprint, z: [f32; 2]) {
        self.taken.push(Taken { footprint, z, solid: true });
        if z[0] < HEADROOM {
            self.walk.block(&footprint);
        }
    }

    /// True where nothing is yet and nothing need be kept free.
    pub fn is_free(&self, footprint: &Footprint, z: [f32; 2]) -> bool {
        !self.taken.iter().any(|t| z[0] < t.z[1] && t.z[0] < z[1] && t.footprint.meets(footprint, 0.0))
    }

    /// Takes the place of something that is left lying or standing on the floor; false, and nothing is taken, where doors swing, where
    /// ways would be closed, or, for what is not `tucked` below or beside other things, where people stand who open and use something.
    pub fn leave(&mut self, footprint: &Footprint, height: f32, tucked: bool) -> bool {
        let kept = |t: &&Taken| !t.solid && (t.z[0] == 0.0 || !tucked && t.z[0] == UNDERFOOT && height > LYING);
        if self.taken.iter().filter(kept).any(|t| t.footprint.meets(footprint, 0.0)) {
            return false;
        }
        if height > LYING {
            let mut walk = self.walk.clone();
            walk.block(footprint);
            if !walk.is_open(&self.fronts) {
                return false;
            }
            self.walk = walk;
        }
        true
    }

    /// Spots along all walls for something `width` wide, its ends included.
    pub fn along_walls(&self, width: f32) -> Vec<Spot> {
        self.room.walls().into_iter().flat_map(|wall| self.along(wall, width)).collect()
    }

    /// Spots along one wall for something `width` wide.
    pub fn along(&self, wall: Wall, width: f32) -> Vec<Spot> {
        let end = 0.5 * (self.room.length(wall) - width) - self.gap;
        let steps = (2.0 * end / STEP).ceil().max(0.0) as usize;
        let x = |k: usize| if steps == 0 { 0.0 } else { end * (2.0 * k as f32 / steps as f32 - 1.0) };
        let spot = |x: f32| Spot { origin: self.room.before(wall, x, self.gap), yaw: self.room.yaw(wall), wall: Some(wall), x };
        if end < 0.0 { Vec::new() } else { (0..=steps).map(|k| spot(x(k))).collect() }
    }

    /// Spots all over the floor, turned by each of `yaws` from the direction of most walls.
    pub fn everywhere(&self, step: f32, yaws: &[f32]) -> Vec<Spot> {
        let half = 0.5 * self.room.size.truncate();
        let count = (2.0 * half / step).floor();
        let mut spots = Vec::new();
        for j in 0..=count.y as usize {
            for i in 0..=count.x as usize {
                let p = self.room.box_center - half + 0.5 * (2.0 * half - count * step) + step * Vec2::new(i as f32, j as f32);
                spots.extend(yaws.iter().map(|&yaw| Spot { origin: p, yaw: self.room.grain + yaw, wall: None, x: 0.0 }));
            }
        }
        spots
    }

    /// Distance of a point to the nearest door or passage.
    pub fn to_way(&self, p: Vec2) -> f32 {
        self.nearest(p, self.room.ways().map(|o| self.room.before(o.wall, o.center_x(), 0.0)))
    }

    /// Distance of a point to the nearest window; the length of the room's diagonal if there is none.
    pub fn to_window(&self, p: Vec2) -> f32 {
        self.nearest(p, self.room.windows().map(|o| self.room.before(o.wall, o.center_x(), 0.0)))
    }

    fn nearest(&self, p: Vec2, points: impl Iterator<Item = Vec2>) -> f32 {
        points.map(|q| q.distance(p)).fold(self.room.size.truncate().length(), f32::min)
    }

    /// Distance of a spot's middle to the nearer end of its wall.
    pub fn to_corner(&self, spot: &Spot) -> f32 {
        spot.wall.map_or(0.0, |wall| 0.5 * self.room.length(wall) - spot.x.abs())
    }

    /// Places a group at the cheapest spot where it fits; the poses of its pieces, or `None` where it fits nowhere.
    pub fn place(&mut self, group: &[Piece], spots: Vec<Spot>, cost: impl Fn(&Self, &Spot) -> f32) -> Option<(Spot, Vec<DAffine3>)> {
        self.place_by(group, spots, &cost)
    }

    /// Compiled once, not for every cost.
    fn place_by(&mut self, group: &[Piece], spots: Vec<Spot>, cost: &dyn Fn(&Self, &Spot) -> f32) -> Option<(Spot, Vec<DAffine3>)> {
        let mut priced: Vec<(f32, Spot)> = spots.into_iter().map(|s| (cost(self, &s), s)).filter(|(c, _)| c.is_finite()).collect();
        priced.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut trials = 0;
        for (_, spot) in priced {
            if !self.fits(group, &spot) {
                continue;
            }
            trials += 1;
            if trials > TRIALS {
                return None;
            }
            if let Some(walk) = self.walked(group, &spot) {
                self.take_group(group, &spot, walk);
                return Some((spot, group.iter().map(|piece| piece_pose(piece, &spot)).collect()));
            }
        }
        None
    }

    fn fits(&self, group: &[Piece], spot: &Spot) -> bool {
        // Things at a wall keep the distance of their group.
        let inset = if spot.wall.is_some() { -0.0005 } else { self.gap };
        group.iter().all(|piece| {
            let own = footprint(piece, spot);
            let inside = self.room.holds(&own, inset);
            let z = [piece.z, piece.z + piece.size.z];
            let overlaps = |t: &Taken| z[0] < t.z[1] && t.z[0] < z[1];
            let meets = |t: &Taken| overlaps(t) && t.footprint.meets(&own, if t.solid { AIR } else { 0.0 });
            let front = front(piece, spot);
            let blocked =
                |t: &Taken| t.solid && t.z[0] < HEADROOM && t.z[1] > UNDERFOOT && front.is_some_and(|f| t.footprint.meets(&f, -0.02));
            let within = front.is_none_or(|f| self.room.holds(&f, inset - 0.04));
            let low = !self.room.slopes.is_empty() && self.room.lowest_over(&own) < (z[1] + BELOW_SLOPE).max(piece.headroom);
            inside && within && !low && !self.taken.iter().any(|t| meets(t) || blocked(t))
        })
    }

    /// The ways through the room with the group in it, if they are still open.
    fn walked(&self, group: &[Piece], spot: &Spot) -> Option<Walk> {
        let mut walk = self.walk.clone();
        let solid = |piece: &&Piece| !piece.flat && piece.z < HEADROOM;
        group.iter().filter(solid).for_each(|piece| walk.block(&footprint(piece, spot)));
        let fronts: Vec<Footprint> = self.fronts.iter().copied().chain(group.iter().filter_map(|p| front(p, spot))).collect();
        walk.is_open(&fronts).then_some(walk)
    }

    fn take_group(&mut self, group: &[Piece], spot: &Spot, walk: Walk) {
        self.walk = walk;
        for piece in group {
            let z = [piece.z, piece.z + piece.size.z];
            self.taken.push(Taken { footprint: footprint(piece, spot), z, solid: true });
            if let Some(front) = front(piece, spot) {
                self.taken.push(Taken { footprint: front, z: [UNDERFOOT, HEADROOM], solid: false });
                self.fronts.push(front);
            }
        }
    }
}

fn footprint(piece: &Piece, spot: &Spot) -> Footprint {
    Footprint { center: spot.point(piece.at), half: 0.5 * piece.size.truncate(), yaw: spot.yaw + piece.yaw }
}

/// The floor before a piece that people need.
fn front(piece: &Piece, spot: &Spot) -> Option<Footprint> {
    let own = footprint(piece, spot);
    let ahead = Vec2::from_angle(own.yaw).perp();
    let half = Vec2::new(own.half.x, 0.5 * piece.reach);
    (piece.reach > 0.0).then(|| Footprint { center: own.center + ahead * (own.half.y + 0.5 * piece.reach), half, yaw: own.yaw })
}

fn piece_pose(piece: &Piece, spot: &Spot) -> DAffine3 {
    let own = footprint(piece, spot);
    let z = piece.z + if piece.flat || piece.z > 0.0 { 0.0 } else { CONTACT };
    pose(f64::from(own.center.x), f64::from(own.center.y), f64::from(z), f64::from(own.yaw))
}
