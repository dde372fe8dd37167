//! Doors, passages and windows of drawn plans, each in the wall that it is nearest to.

use super::Site;
use super::outlines::OPPOSITE;
use crate::plan::Doorway;
use crate::plan::openings::{DOOR_TOP, Shared};
use crate::room::kind::row;
use crate::room::{Filling, Opening, Room, WAY_DEPTH, Wall};
use enfilade_furniture::{Leaf, RoomKind};
use enfilade_math::{DVec2, Vec2};
use enfilade_scene::{DrawnOpening, Hinge, OpeningKind};

/// An opening belongs to a wall that is no farther away, metres.
const REACH: f32 = 0.3;
/// From an opening to the end of its piece of wall, at least, metres.
const MARGIN: f32 = 0.06;
/// An opening may be moved along its wall by this without being mentioned, metres.
const UNSEEN: f32 = 0.02;
/// Openings of other programs' files that are too wide for their walls may be narrowed to this share.
const NARROWER: f32 = 0.8;
/// Widest door between rooms, metres.
const WIDEST_DOOR: f64 = 1.4;
/// Usual widths of passages and windows, metres.
const PASSAGE: f32 = 1.2;
const WINDOW: f32 = 1.2;
/// Smallest opening that people pass, and smallest window, metres.
const SMALLEST: [f32; 2] = [0.6, 0.3];
/// Wall above doors, and above windows, at least, metres.
const ABOVE: f32 = 0.05;
/// Usual distance of a window's upper edge from the ceiling, metres.
const LINTEL: f32 = 0.33;

/// A piece of wall that something opens.
#[derive(Clone, Copy)]
struct Place {
    room: usize,
    wall: Wall,
    /// The middle of the opening along the wall.
    x: f32,
}

impl Site {
    /// Adds an opening of the file.
    ///
    /// # Errors
    /// If it cannot be built: what is wrong, and where. If the plan is not in our own words, it is left out and a note is made instead.
    pub fn open(&mut self, opening: &DrawnOpening) -> Result<(), String> {
        match self.try_open(opening) {
            Err(problem) if self.strict => Err(problem),
            Err(problem) => {
                self.notes.push(format!("{problem}; it is left out"));
                Ok(())
            }
            Ok(()) => Ok(()),
        }
    }

    fn try_open(&mut self, opening: &DrawnOpening) -> Result<(), String> {
        let name = format!("the {} at [{:.2}, {:.2}]", opening.kind.name(), opening.at.x, opening.at.y);
        let is_window = opening.kind == OpeningKind::Window;
        let width = |usual: f32| opening.width_m.map_or(usual, |width| width as f32);
        let place = self.nearest(opening.at).ok_or_else(|| format!("{name} is in no wall: move it to within {REACH} m of one"))?;
        let room = &self.rooms[place.room];
        let back = *room.face(place.wall).back(place.x);
        let beyond = if back.outer { None } else { self.beyond(place) };
        match (back.outer, beyond, is_window) {
            (false, Some(beyond), true) => {
                let [a, b] = [place.room, beyond.room].map(|room| &self.names[room]);
                return Err(format!("{name} is in the wall between {a:?} and {b:?}, expected an outer wall"));
            }
            (false, None, _) => return Err(format!("{name} is in a wall with another wall close behind it that is not parallel")),
            _ => {}
        }
        let kind = self.kind(&name, opening, beyond.is_some())?;
        let usual = match kind {
            OpeningKind::Door if self.rooms[beyond.map_or(place.room, |b| b.room)].kind.wet() => 0.76,
            OpeningKind::Door => 0.885,
            OpeningKind::Passage => PASSAGE,
            OpeningKind::Window => WINDOW,
        };
        let width = width(usual);
        let least = SMALLEST[usize::from(is_window)];
        if !(width.is_finite() && width >= least) {
            return Err(format!("{name} is {width:.2} m wide, expected at least {least} m"));
        }
        let x = self.within(&name, place, beyond, width)?;
        let z = self.heights(&name, &DrawnOpening { kind, ..opening.clone() }, place, beyond, x)?;
        let places: Vec<(Place, [f32; 2])> = std::iter::once((place, x)).chain(beyond.map(|b| (b, self.opposite(place, b, x)))).collect();
        for (place, x) in &places {
            let meets = |o: &&Opening| o.wall == place.wall && o.x[0] < x[1] + 0.02 && x[0] < o.x[1] + 0.02;
            if self.rooms[place.room].openings.iter().any(|o| meets(&o)) {
                return Err(format!("{name} overlaps another opening in the same wall of {:?}", self.names[place.room]));
            }
        }
        match kind {
            OpeningKind::Window => self.window(place, x, z),
            OpeningKind::Passage => self.passage(&places, z),
            OpeningKind::Door => self.door(&places, z, opening),
        }
        Ok(())
    }

    /// What an opening is built as: other programs call wide passages doors, and doors to the outside holes.
    fn kind(&mut self, name: &str, opening: &DrawnOpening, is_inner: bool) -> Result<OpeningKind, String> {
        let is_wide = opening.width_m.is_some_and(|width| width > WIDEST_DOOR);
        match opening.kind {
            OpeningKind::Passage if !is_inner && self.strict => Err(format!("{name} leads to the outside, expected a door there")),
            OpeningKind::Passage if !is_inner => {
                self.notes.push(format!("{name} leads to the outside: it got a door"));
                Ok(OpeningKind::Door)
            }
            OpeningKind::Door if is_inner && is_wide && self.strict => {
                Err(format!("{name} is {:.2} m wide, expected at most {WIDEST_DOOR} m, or a passage", opening.width_m.unwrap_or_default()))
            }
            OpeningKind::Door if is_inner && is_wide => {
                self.notes.push(format!("{name} is {:.2} m wide: it is a passage", opening.width_m.unwrap_or_default()));
                Ok(OpeningKind::Passage)
            }
            kind => Ok(kind),
        }
    }

    /// The wall that a point is in or nearest to.
    fn nearest(&self, at: DVec2) -> Option<Place> {
        let at = at.as_vec2();
        let mut best: Option<(f32, Place)> = None;
        for (number, room) in self.rooms.iter().enumerate() {
            for wall in room.walls() {
                let p = at - room.before(wall, 0.0, 0.0);
                let face = room.face(wall);
                let (x, out) = (p.dot(face.along()), p.dot(face.inward));
                let off = out.max(0.0) + (-out - face.back(x).thickness).max(0.0) + (x.abs() - 0.5 * face.length).max(0.0);
                if off <= REACH && best.is_none_or(|(known, _)| off < known - 1e-4) {
                    best = Some((off, Place { room: number, wall, x }));
                }
            }
        }
        best.map(|(_, place)| place)
    }

    /// The other face of a wall between rooms.
    fn beyond(&self, place: Place) -> Option<Place> {
        let room = &self.rooms[place.room];
        let back = room.face(place.wall).back(place.x);
        let (other, inward) = (back.beyond?, room.inward(place.wall));
        let behind = room.before(place.wall, place.x, -back.thickness);
        let walls = self.rooms[other].walls().into_iter().filter_map(|wall| {
            let face = self.rooms[other].face(wall);
            let p = behind - self.rooms[other].before(wall, 0.0, 0.0);
            let (x, off) = (p.dot(face.along()), p.dot(face.inward).abs() + (p.dot(face.along()).abs() - 0.5 * face.length).max(0.0));
            (face.inward.dot(inward) < OPPOSITE && off < REACH).then_some((off, Place { room: other, wall, x }))
        });
        walls.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, place)| place)
    }

    /// A span of a wall on its other face.
    fn opposite(&self, place: Place, beyond: Place, x: [f32; 2]) -> [f32; 2] {
        let (room, other) = (&self.rooms[place.room], &self.rooms[beyond.room]);
        let middle = room.before(place.wall, 0.5 * (x[0] + x[1]), 0.0) - other.before(beyond.wall, 0.0, 0.0);
        let (middle, half) = (middle.dot(other.face(beyond.wall).along()), 0.5 * (x[1] - x[0]));
        [middle - half, middle + half]
    }

    /// The part of the wall that an opening takes, moved so that it fits in.
    fn within(&mut self, name: &str, place: Place, beyond: Option<Place>, width: f32) -> Result<[f32; 2], String> {
        let face = self.rooms[place.room].face(place.wall);
        let mut free = face.back(place.x).x;
        if let Some(beyond) = beyond {
            let half = 0.5 * self.rooms[beyond.room].length(beyond.wall);
            let ends = self.opposite(beyond, place, [-half, half]);
            free = [free[0].max(ends[0]), free[1].min(ends[1])];
        }
        let free = [free[0] + MARGIN, free[1] - MARGIN];
        let mut width = width;
        if !self.strict && width > free[1] - free[0] && free[1] - free[0] > NARROWER * width {
            self.notes.push(format!("{name} is {width:.2} m wide: it was made {:.2} m wide, so that it fits in", free[1] - free[0]));
            width = free[1] - free[0];
        }
        if width > free[1] - free[0] + 1e-3 {
            return Err(format!(
                "{name} is {width:.2} m wide, but the wall of {:?} has {:.2} m for it there",
                self.names[place.room],
                (free[1] - free[0]).max(0.0)
            ));
        }
        let x = place.x.clamp(free[0] + 0.5 * width, (free[1] - 0.5 * width).max(free[0] + 0.5 * width));
        if (x - place.x).abs() > UNSEEN {
            self.notes.push(format!("{name} was moved by {:.2} m along its wall, so that it fits in", (x - place.x).abs()));
        }
        Ok([x - 0.5 * width, x + 0.5 * width])
    }

    fn heights(&self, name: &str, opening: &DrawnOpening, place: Place, beyond: Option<Place>, x: [f32; 2]) -> Result<[f32; 2], String> {
        let room = &self.rooms[place.room];
        let level = beyond.map_or(room.size.z, |beyond| room.size.z.min(self.rooms[beyond.room].size.z));
        let is_window = opening.kind == OpeningKind::Window;
        let height = self.ceiling(place, beyond, x, is_window).min(level);
        let usual = match opening.kind {
            OpeningKind::Door => [0.0, DOOR_TOP.min(height - ABOVE)],
            OpeningKind::Passage => [0.0, height - LINTEL],
            OpeningKind::Window => [row(room.kind).windows.drawn_sill, height - LINTEL],
        };
        let mut z = opening.z_m.map_or(usual, |z| z.map(|z| z as f32));
        if opening.kind != OpeningKind::Window {
            z[0] = 0.0;
        }
        let least = if is_window { 0.3 } else { 1.9 };
        if !(z[0] >= 0.0 && z[1] - z[0] >= least && z[1] <= height - ABOVE + 1e-3) {
            let sloping = if height < level { ", where the ceiling slopes" } else { "" };
            return Err(format!(
                "{name} reaches from {:.2} m to {:.2} m, expected at least {least} m between the floor and {:.2} m{sloping}",
                z[0],
                z[1],
                height - ABOVE
            ));
        }
        Ok(z)
    }

    /// The least height of the ceilings at an opening: of windows within the wall, of ways also where leaves swing and people step.
    fn ceiling(&self, place: Place, beyond: Option<Place>, x: [f32; 2], is_window: bool) -> f32 {
        let room = &self.rooms[place.room];
        let within = room.lowest_before(place.wall, x, [-room.face(place.wall).back(place.x).thickness, 0.0]);
        if is_window {
            return within;
        }
        let depth = (x[1] - x[0]).max(WAY_DEPTH);
        let there = |place: Place, x: [f32; 2]| self.rooms[place.room].lowest_before(place.wall, x, [0.0, depth]);
        let other = beyond.map_or(f32::INFINITY, |beyond| there(beyond, self.opposite(place, beyond, x)));
        within.min(there(place, x)).min(other)
    }

    fn window(&mut self, place: Place, x: [f32; 2], z: [f32; 2]) {
        let width = x[1] - x[0];
        let sashes = if width < 0.95 { 1 } else { (1 + ((width - 0.15) / 1.05) as usize).min(6) };
        self.rooms[place.room].openings.push(Opening { wall: place.wall, x, z, filling: Filling::Window { sashes } });
    }

    fn passage(&mut self, places: &[(Place, [f32; 2])], z: [f32; 2]) {
        for (k, (place, x)) in places.iter().enumerate() {
            let filling = Filling::Passage { lined: k == 0 };
            self.rooms[place.room].openings.push(Opening { wall: place.wall, x: *x, z, filling });
        }
        self.add_way(places, true);
    }

    fn add_way(&mut self, places: &[(Place, [f32; 2])], open: bool) {
        let way = match places {
            [(into, _)] => Doorway { from: None, into: into.room, open },
            [(from, _), (into, _), ..] => Doorway { from: Some(from.room), into: into.room, open },
            [] => return,
        };
        self.doorways.push(way);
    }

    /// Hangs a door, as the file says or where its leaf is least in the way.
    fn door(&mut self, places: &[(Place, [f32; 2])], z: [f32; 2], stated: &DrawnOpening) {
        let kinds = places.iter().map(|(place, _)| self.rooms[place.room].kind);
        let into = stated.into.and_then(|room| places.iter().position(|(place, _)| place.room == room));
        // Doors swing into the smaller room, but out of toilets.
        let area = |k: &usize| {
            let room = &self.rooms[places[*k].0.room];
            if row(room.kind).ways.swings_out { f32::INFINITY } else { room.area }
        };
        let inside = into.or_else(|| (0..places.len()).min_by(|a, b| area(a).total_cmp(&area(b)))).unwrap_or(0);
        let wet = kinds.into_iter().any(RoomKind::wet);
        let usual =
            [0.0, self.rng.range(0.35, 0.9), self.rng.range(1.2, 1.6), self.rng.range(1.3, 1.6)][self.rng.below(if wet { 3 } else { 4 })];
        let (place, x) = places[inside];
        let room = &self.rooms[place.room];
        let here = Opening { wall: place.wall, x, z, filling: Filling::DoorBack };
        let back = room.thickness(&here);
        let leaf = |hinge: f32| {
            let open_rad = stated.open_deg.map_or(usual, |open| open.to_radians() as f32);
            Leaf { hinge, open_rad: if places.len() == 1 { 0.0 } else { open_rad.clamp(0.0, 1.6) }, back }
        };
        let cost = |hinge: f32| {
            let gap = 0.5 * room.length(place.wall) - hinge * here.center_x();
            10.0 * room.conflicts(&Opening { filling: Filling::Door(leaf(hinge)), ..here }) + gap
        };
        let hinge = match stated.hinge.filter(|_| into.is_some()) {
            Some(Hinge::Left) => 1.0,
            Some(Hinge::Right) => -1.0,
            None if cost(-1.0) < cost(1.0) => -1.0,
            None => 1.0,
        };
        let filling = Filling::Door(leaf(hinge));
        self.rooms[place.room].openings.push(Opening { filling, ..here });
        for (other, x) in places.iter().enumerate().filter(|(k, _)| *k != inside).map(|(_, other)| other) {
            self.rooms[other.room].openings.push(Opening { wall: other.wall, x: *x, ..here });
        }
        self.add_way(places, false);
    }

    /// The longest piece of wall that two rooms share, with its ends, if there is one.
    pub fn shared(&self, from: usize, into: usize) -> Option<Shared> {
        let room = &self.rooms[from];
        let mut best: Option<(f32, Shared)> = None;
        for wall in room.walls() {
            for back in room.face(wall).backs.iter().filter(|back| back.beyond == Some(into)) {
                let place = Place { room: from, wall, x: 0.5 * (back.x[0] + back.x[1]) };
                let Some(beyond) = self.beyond(place) else { continue };
                let half = 0.5 * self.rooms[into].length(beyond.wall);
                let ends = self.opposite(beyond, place, [-half, half]);
                let taken = room.openings.iter().filter(|o| o.wall == wall).map(|o| [o.x[0] - 0.15, o.x[1] + 0.15]);
                let taken = taken.chain(room.low_spans(wall, [0.0, WAY_DEPTH], DOOR_TOP + ABOVE));
                let low = self.rooms[into].low_spans(beyond.wall, [0.0, WAY_DEPTH], DOOR_TOP + ABOVE);
                let taken = taken.chain(low.into_iter().map(|x| self.opposite(beyond, place, x)));
                let Some(clear) = longest([back.x[0].max(ends[0]), back.x[1].min(ends[1])], taken) else { continue };
                if best.as_ref().is_none_or(|(known, _)| clear[1] - clear[0] > *known) {
                    best = Some((clear[1] - clear[0], between(room, &self.rooms[into], [place, beyond], clear)));
                }
            }
        }
        best.map(|(_, shared)| shared)
    }
}

/// A piece of wall between two rooms, measured along the first one's.
fn between(room: &Room, other: &Room, [place, beyond]: [Place; 2], clear: [f32; 2]) -> Shared {
    let middle: Vec2 = other.before(beyond.wall, 0.0, 0.0) - room.before(place.wall, 0.0, 0.0);
    Shared {
        rooms: [place.room, beyond.room],
        walls: [place.wall, beyond.wall],
        clear,
        origins: [0.0, middle.dot(room.face(place.wall).along())],
        signs: [1.0, -1.0],
    }
}

/// The longest piece of a span that nothing takes.
fn longest([low, high]: [f32; 2], taken: impl Iterator<Item = [f32; 2]>) -> Option<[f32; 2]> {
    let mut taken: Vec<[f32; 2]> = taken.collect();
    taken.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (mut from, mut runs) = (low, Vec::new());
    for [a, b] in taken.into_iter().chain([[high, high]]) {
        runs.push([from, a.min(high)]);
        from = from.max(b);
    }
    runs.into_iter().filter(|run| run[1] > run[0]).max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))
}
