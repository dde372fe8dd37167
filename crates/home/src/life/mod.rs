//! Life: what people leave lying, hanging and askew in rooms that are furnished, as much of it as
//! [`HomeConfig::lived_in`](crate::HomeConfig::lived_in) says.
//!
//! The furnished home settles first, so that life changes nothing of it. Then come, in this order: beds that have been slept in
//! ([`beds`]), chairs and cushions out of place ([`askew`]), drawers that are not quite closed ([`ajar`]), things on tables, seats, floors and walls ([`things`], [`walls`]), cloth that
//! falls on what is there ([`cloth`]), all by the [`table`], and at last wear ([`marks`]). Whatever finds no place where it is free,
//! carried and in nobody's way, is left out. Random numbers have a stream of their own, and each thing its own fork of it: with more life
//! there are the same things and others besides.

mod ajar;
mod askew;
mod beds;
mod cloth;
mod ground;
mod marks;
mod stage;
mod table;
mod textiles;
mod things;
mod walls;
mod ways;
mod wish;

use crate::place::Floor;
use crate::plan::FloorPlan;
use crate::{Home, HomeConfig};
use enfilade_furniture::{Builder, DecorConfig, Finish, family_of, left_thing, object_of};
use enfilade_math::{Bounds3, DAffine3, Rng, hash_text};
use enfilade_scene::{Labels, Scene};
use stage::{Bundle, Stage};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use table::{At, ROWS, Row, What, interpolated};
use wish::Wish;

/// Most traces of one row on one piece, or in one room.
const MOST: usize = 14;
/// Floor for which rows give the number of what lies there, m².
const FLOOR: f32 = 10.0;
/// Least and greatest area that counts of a piece, m².
const AREAS: [f32; 2] = [0.2, 4.0];
/// Probability that a screen that is off is on, at ½ and at 1.
const SCREENS: [f32; 2] = [0.45, 0.8];

/// A builder of homes in which some things have an inside, since life may open them.
pub fn openable(b: Builder, config: &HomeConfig) -> Builder {
    if config.lived_in == 0.0 { b } else { b.with_some_joints(interpolated(config.lived_in, ajar::OPENED), opened(config)) }
}

/// The random numbers that choose these.
fn opened(config: &HomeConfig) -> Rng {
    config.stream(config.furniture, 11)
}

/// A room that is furnished: its parts, and its floor with what stands there.
pub struct Furnished {
    /// Parts of the room.
    pub parts: Range<usize>,
    /// The floor of the room.
    pub floor: Floor,
}

/// What life brings into a home, before it has its places.
pub struct Life {
    wishes: Vec<Wish>,
    /// Number of parts of the home itself.
    base: usize,
    floors: Vec<Floor>,
    rng: Rng,
    /// Chooses the things that may be open.
    opened: Rng,
    lived_in: f32,
}

impl Life {
    /// Makes what life brings into the rooms, behind all parts of the home; screens are turned on.
    pub fn bring(b: &mut Builder, plan: &FloorPlan, decor: &DecorConfig, config: &HomeConfig, rooms: Vec<Furnished>) -> Self {
        let (rng, lived_in) = (config.stream(config.furniture, 10), config.lived_in);
        let mut life = Self { wishes: Vec::new(), base: b.part_count(), floors: Vec::new(), rng, opened: opened(config), lived_in };
        let home = decor.palette();
        for (room, furnished) in rooms.into_iter().enumerate() {
            life.floors.push(furnished.floor);
            if lived_in == 0.0 {
                continue;
            }
            b.enter_room(decor.room(&home, room as u64), plan.rooms[room].windows().next().is_none());
            life.screens(b, furnished.parts.clone());
            let hosts = hosts(b.scene(), furnished.parts);
            for row in ROWS.iter().filter(|row| row.is_in(plan.rooms[room].kind)) {
                life.row(b, row, room, plan.rooms[room].area, &hosts, config.clutter);
            }
        }
        life
    }

    /// Turns screens on that are off.
    fn screens(&self, b: &mut Builder, parts: Range<usize>) {
        for part in parts {
            let scene = b.scene();
            let (name, material) = (&scene.parts[part].name, scene.parts[part].material as usize);
            let mut rng = self.rng.fork(hash_text(name)).fork(hash_text("screen"));
            if scene.materials[material].name == "screen" && rng.next_f32() < interpolated(self.lived_in, SCREENS) {
                b.turn_on(part, Finish::ScreenOn(rng.below(8) as u8));
            }
        }
    }

    /// Makes what a row leaves in a room.
    fn row(&mut self, b: &mut Builder, row: &'static Row, room: usize, area: f32, hosts: &BTreeMap<String, Bounds3>, clutter: f32) {
        let own = self.rng.fork(room as u64).fork(hash_text(row.name));
        let rate = row.rate(self.lived_in) * clutter;
        let (families, by_area) = match row.at {
            At::AlongWalls | At::Anywhere | At::OnWalls(_) => {
                return self.some(b, row, room, None, rate * area / FLOOR, &own);
            }
            At::On(families) => (families, true),
            At::OnEach(families) | At::Above(families) | At::Over(families) | At::Under(families) | At::Beside(families) => {
                (families, false)
            }
        };
        for (host, bounds) in hosts.iter().filter(|(host, _)| families.contains(&family_of(host))) {
            let size = bounds.extent();
            let measure = if by_area { (size.x * size.y).clamp(AREAS[0], AREAS[1]) } else { 1.0 };
            self.some(b, row, room, Some(host), rate * measure, &own.fork(hash_text(host)));
        }
    }

    /// Makes about `expected` traces of a row.
    fn some(&mut self, b: &mut Builder, row: &'static Row, room: usize, host: Option<&String>, expected: f32, rng: &Rng) {
        let count = ((expected + rng.clone().next_f32()) as usize).min(MOST);
        for k in 0..count {
            let mut rng = rng.fork(k as u64 + 1);
            let first = b.part_count();
            let cloth = match row.what {
                What::Things(families) => {
                    let family = families[rng.below(families.len())];
                    let Some(thing) = left_thing(family, &mut rng) else { continue };
                    thing.build(b, DAffine3::IDENTITY, &mut rng);
                    None
                }
                What::Cloth(sorts) => {
                    let sort = sorts[rng.below(sorts.len())];
                    sort.cut(b, &mut rng);
                    Some(sort)
                }
            };
            let parts = first - self.base..b.part_count() - self.base;
            self.wishes.push(Wish { row, room, host: host.cloned(), parts, cloth, rng });
        }
    }

    /// Takes the parts of what life brings out of the scene that the builder has finished.
    pub fn take(&self, scene: &mut Scene, labels: &mut Labels) -> Waiting {
        scene.bodies.retain(|body| body.parts.iter().all(|&part| (part as usize) < self.base));
        Waiting(Bundle { parts: scene.parts.split_off(self.base), labels: labels.parts.split_off(self.base) })
    }

    /// Puts all of it into the home, which has settled.
    pub fn live(mut self, home: &mut Home, waiting: &Waiting) {
        if self.lived_in == 0.0 {
            return;
        }
        let mut stage = Stage::new(home);
        let furniture: BTreeSet<String> = stage.bodies.iter().map(|body| body.name.clone()).collect();
        beds::sleep_in(&mut stage, &self.rng, self.lived_in);
        askew::move_about(&mut stage, &mut self.floors, &self.rng, self.lived_in);
        // What is put back may close a way with what is not.
        loop {
            let back = ways::closed_by(&stage, stage.moved().cloned().collect());
            if back.is_empty() {
                break;
            }
            back.iter().for_each(|object| stage.put_back(object));
        }
        ajar::leave_ajar(&mut stage, &mut self.floors, &self.rng, &self.opened, self.lived_in);
        // Cloth falls on what lies there already.
        for cloth in [false, true] {
            for wish in self.wishes.iter().filter(|wish| wish.cloth.is_some() == cloth) {
                let bundle =
                    Bundle { parts: waiting.0.parts[wish.parts.clone()].to_vec(), labels: waiting.0.labels[wish.parts.clone()].to_vec() };
                match (wish.cloth, wish.row.at) {
                    (None, At::OnWalls(heights)) => walls::hang(&mut stage, &mut self.floors[wish.room], wish, bundle, heights),
                    (None, _) => things::lay(&mut stage, &mut self.floors, wish, bundle),
                    (Some(sort), _) => cloth::throw(&mut stage, &mut self.floors, wish, bundle, sort),
                }
            }
        }
        let put: Vec<String> = stage.bodies.iter().map(|body| &body.name).filter(|name| !furniture.contains(*name)).cloned().collect();
        let away = ways::closed_by(&stage, put);
        if !away.is_empty() {
            stage.remove(|part| away.iter().any(|object| object == object_of(part)));
            // What lay on it goes too.
            let fallen = stage.fallen(|object| !furniture.contains(object));
            stage.remove(|part| fallen.contains(object_of(part)));
        }
        marks::wear(&mut stage, &self.rng, self.lived_in);
    }
}

/// Parts without a place.
pub struct Waiting(Bundle);

/// The objects of a room that stand in it, with the boxes around them.
fn hosts(scene: &Scene, parts: Range<usize>) -> BTreeMap<String, Bounds3> {
    let mut hosts: BTreeMap<String, Bounds3> = BTreeMap::new();
    for part in &scene.parts[parts] {
        let around = hosts.entry(object_of(&part.name).into()).or_insert(Bounds3::EMPTY);
        *around = scene.world_positions(part).fold(*around, Bounds3::include);
    }
    hosts
}

#[cfg(test)]
mod tests;
