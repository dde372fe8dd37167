//! Procedural furnished homes and public rooms: the embedded default input, and labelled scenes without end.
//!
//! [`home()`] is a function of its [`HomeConfig`] alone. From the bottom up: `plan` lays out rooms, [`room`] and `shell` are their walls;
//! `place` decides what fits where, `rooms` furnishes each kind of room with things of the crate `enfilade-furniture`. Objects with a fault
//! that [`check`] would find are moved until they rest on something and run into nothing, or removed where that fails. `life` is what people
//! have left lying and moved in rooms that are furnished. [`light`] is the hour, the sky and the surroundings outside.
//!
//! ```
//! use enfilade_home::check::faults;
//! use enfilade_home::{HomeConfig, RoomKind, home};
//!
//! let config = HomeConfig { seed: 7, rooms: vec![RoomKind::Bathroom], clutter: 0.0, ..HomeConfig::default() };
//! let made = home(&config);
//! assert!(made.scene.parts.iter().any(|part| part.name.starts_with("toilet_1/")));
//! assert_eq!(made.scene.parts.len(), made.labels.parts.len());
//! assert_eq!(faults(&made), []);
//! ```

pub mod building;
mod cameras;
pub mod check;
mod config;
mod fault;
mod gravity;
mod home;
mod joint;
mod lacks;
mod life;
pub mod light;
mod open;
mod place;
mod plan;
pub mod room;
mod rooms;
mod settle;
mod shell;
mod states;

pub use building::Building;
pub use config::{HomeConfig, RoomShape};
pub use enfilade_furniture::RoomKind;
pub use home::{Home, Removal, Shift};
pub use joint::HomeJoint;
pub use plan::FloorPlan;
pub use states::{State, StateWord, States};

use enfilade_furniture::assets::Library;
use enfilade_furniture::models::Model;
use enfilade_furniture::{Builder, DecorConfig, Materials, object_of};
use enfilade_math::{DVec2, DVec3, Rng, Vec2};
use enfilade_scene::{DrawnPlan, OpeningKind, Rooms, Scene, WallOpening};
use light::{LightConfig, Moment};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A furnished home at some hour of some day, with our own furniture only.
pub fn home(config: &HomeConfig) -> Home {
    home_with(config, &Library::default())
}

/// A furnished home in which models of `library`, which the caller has read from [`HomeConfig::assets`], replace our furniture.
///
/// Models that turn out to be broken are replaced by our own furniture; [`Library::broken`] lists them afterwards. [`HomeConfig::plan`] is
/// not read: see [`home_on`].
pub fn home_with(config: &HomeConfig, library: &Library) -> Home {
    let plan = FloorPlan::of(config.building, &config.programme(), &config.stream(config.layout, 1));
    let plan = match config.shape {
        RoomShape::Rectangular => plan,
        RoomShape::Varied => plan.varied(&config.stream(config.layout, 7)),
    };
    furnished(config, library, plan)
}

/// A furnished home on a plan that somebody drew, which the caller has read from [`HomeConfig::plan`].
///
/// ```
/// use enfilade_furniture::assets::Library;
/// use enfilade_home::{HomeConfig, home_on};
/// use enfilade_scene::{DrawnPlan, DrawnRoom};
///
/// let polygon = [[0.0, 0.0], [2.4, 0.0], [2.4, 1.6], [1.6, 2.2], [0.0, 2.2]].map(Into::into).to_vec();
/// let room = DrawnRoom { name: "bath".into(), kind: "bathroom".into(), polygon, height_m: None };
/// let config = HomeConfig { clutter: 0.0, ..HomeConfig::of_seed(3) };
/// let made = home_on(&config, &Library::default(), &DrawnPlan { rooms: vec![room], ..DrawnPlan::default() })?;
/// assert_eq!(made.rooms().outlines[0].polygon.len(), 5);
/// assert!(made.notes[0].contains("an entrance was added"));
/// # Ok::<(), String>(())
/// ```
///
/// # Errors
/// What is wrong with the plan: overlapping rooms, an outline that crosses itself, an unknown kind of room, and so on.
pub fn home_on(config: &HomeConfig, library: &Library, drawn: &DrawnPlan) -> Result<Home, String> {
    let (plan, mut notes) = FloorPlan::drawn_in(&named(drawn, &config.rooms)?, config.building, &config.stream(config.layout, 1))?;
    let mut home = furnished(config, library, plan);
    notes.extend(lacks::lacks(&home));
    home.notes = notes;
    Ok(home)
}

/// The plan with these kinds of rooms, unless there are none.
fn named(drawn: &DrawnPlan, kinds: &[RoomKind]) -> Result<DrawnPlan, String> {
    if !kinds.is_empty() && kinds.len() != drawn.rooms.len() {
        return Err(format!("`rooms` gives {} kinds of rooms, but the plan has {} rooms", kinds.len(), drawn.rooms.len()));
    }
    let mut named = drawn.clone();
    for (room, kind) in named.rooms.iter_mut().zip(kinds) {
        room.kind = kind.name().into();
    }
    Ok(named)
}

fn furnished(config: &HomeConfig, library: &Library, plan: FloorPlan) -> Home {
    // What is decided before anything is built: the hour, the colours. Each has random numbers of its own.
    let light = light(&plan, config, &config.stream(config.light, 4));
    let decor = DecorConfig { seed: config.materials.unwrap_or(config.seed), realism: config.realism };
    // Shell and furniture of every room.
    let builder = Builder::new(Materials::new(decor.palette(), light.lamp_light(), decor.pictures()).worn(config.lived_in));
    let mut builder = if config.states.is_some() { builder.with_joints() } else { life::openable(builder, config) };
    let rooms = rooms::furnish(&mut builder, &plan, &decor, config, library);
    let life = life::Life::bring(&mut builder, &plan, &decor, config, rooms);
    let (models, fronts) = (builder.models().clone(), builder.fronts().clone());
    let jointed = builder.joints().to_vec();
    let (mut scene, mut labels) = builder.finish();
    let waiting = life.take(&mut scene, &mut labels);
    let joints = jointed.iter().filter_map(|jointed| HomeJoint::new(jointed, &scene)).collect();
    let (removed, moved, credits, notes) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut home = Home { scene, labels, plan, fronts, removed, moved, credits, notes, joints, state_notes: Vec::new() };
    // Things that float or run into others are moved or removed.
    settle::settle(&mut home);
    life.live(&mut home, &waiting);
    if config.states.is_none() {
        home.joints.clear();
        home.scene.bodies.clear();
    }
    settle::tidy(&mut home);
    if let Some(states) = &config.states {
        open::open(&mut home, states, &config.stream(None, 8));
    }
    home.credits = self::credits(&home.scene, &models);
    // Light and cameras are for the home as it is in the end.
    light.illuminate(&mut home.scene, &outlooks(&home.plan));
    home.scene.cameras = cameras::cameras(&home.scene, &home.labels, &home.plan);
    home
}

/// The light of a home that was made of `config` and has these rooms, and the directions in which its windows look out, each once.
pub fn light_of(config: &HomeConfig, rooms: &Rooms) -> (LightConfig, Vec<Vec2>) {
    let windows = |room: usize| {
        let is_window = |opening: &&WallOpening| opening.kind == OpeningKind::Window;
        let face = |opening: &WallOpening| opening.walls.first().and_then(|&wall| rooms.walls.get(wall));
        rooms.openings.iter().filter(is_window).filter_map(move |opening| {
            let [left, right] = [0, 1].map(|corner| DVec3::from(opening.corners[corner]));
            let out = -DVec2::from(face(opening).filter(|face| face.room == room)?.inward).as_vec2();
            Some((left.distance(right), out))
        })
    };
    let mut outlooks: Vec<Vec2> = Vec::new();
    let mut first = None;
    for room in 0..rooms.outlines.len() {
        first = first.or_else(|| windows(room).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, out)| out));
        for (_, out) in windows(room) {
            if !outlooks.contains(&out) {
                outlooks.push(out);
            }
        }
    }
    (light_facing(first.unwrap_or(Vec2::Y), config, &config.stream(config.light, 4)), outlooks)
}

/// The models that are still in the scene, one line each.
fn credits(scene: &Scene, models: &BTreeMap<String, Arc<Model>>) -> Vec<String> {
    let used = scene.parts.iter().filter_map(|part| models.get(object_of(&part.name)));
    let lines: BTreeSet<String> = used.map(|model| format!("{} ({}): {}", model.name, model.file, model.licence)).collect();
    lines.into_iter().collect()
}

/// The light of a home: by day its sun is in front of the largest window of the first room that has one.
fn light(plan: &FloorPlan, config: &HomeConfig, rng: &Rng) -> LightConfig {
    let largest = |room: &room::Room| room.windows().max_by(|a, b| a.size().x.total_cmp(&b.size().x)).map(|w| -room.inward(w.wall));
    light_facing(plan.rooms.iter().find_map(largest).unwrap_or(Vec2::Y), config, rng)
}

/// The light of a home whose first windows look in the direction `out`.
fn light_facing(out: Vec2, config: &HomeConfig, rng: &Rng) -> LightConfig {
    let cover = config.seed == 0 && config.light.is_none();
    let moment = config.moment.unwrap_or_else(|| if cover { Moment::Day } else { Moment::usual(&mut rng.fork(1)) });
    let light = if cover && moment == Moment::Day {
        LightConfig { day_of_year: 172, hour: 14.6, ..LightConfig::default() }
    } else {
        LightConfig::random(moment, &mut rng.fork(2))
    };
    lit_as(config.building, moment, light, &mut rng.fork(5)).facing_sun(out, rng.fork(3).range(0.2, 0.8))
}

/// The light with the lamps and the surroundings of a kind of building.
fn lit_as(building: Building, moment: Moment, light: LightConfig, rng: &mut Rng) -> LightConfig {
    let Some(own) = building.row().light else { return light };
    let outside = own.outside[rng.below(own.outside.len())];
    let by_day = own.by_day[rng.below(own.by_day.len())];
    let lamps = if moment == Moment::Day { by_day } else { 1.0 };
    LightConfig { outside, lamps, lamps_klx: own.lamps_klx, ..light }
}

/// The directions in which windows look out, each once.
fn outlooks(plan: &FloorPlan) -> Vec<Vec2> {
    let mut found: Vec<Vec2> = Vec::new();
    for out in plan.rooms.iter().flat_map(|room| room.windows().map(|window| -room.inward(window.wall))) {
        if !found.contains(&out) {
            found.push(out);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_light_of_a_home_follows_from_its_rooms() {
        for seed in 1..4 {
            let config = HomeConfig { seed, rooms: vec![RoomKind::Living], clutter: 0.0, ..HomeConfig::default() };
            let plan = FloorPlan::new(&config.programme(), &config.stream(config.layout, 1));
            let (found, looks) = light_of(&config, &plan.to_rooms());
            let made = light(&plan, &config, &config.stream(config.light, 4));
            assert!((found.north_deg - made.north_deg).abs() < 0.1, "{found:?} {made:?}");
            assert_eq!((found.hour, found.seed, looks.len()), (made.hour, made.seed, outlooks(&plan).len()));
        }
    }
}
