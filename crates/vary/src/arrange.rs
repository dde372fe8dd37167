//! Poses of furniture, and what lies about.

use crate::config::{ClutterVary, FurnitureVary, class_id};
use crate::draw::{chance, uniform};
use crate::first::{First, VaryError};
use crate::things::{Things, turned_and_shifted};
use enfilade_dataset::{MovedThing, Variation};
use enfilade_math::{Bounds3, DAffine3, DVec3, Rng, Vec3, hash_text, place};
use enfilade_scene::{Cx, LabelledScene, Light, OpeningKind, Rooms, Warning};
use std::collections::{BTreeMap, BTreeSet};

/// Poses that are tried for a thing before it stays where it is.
const TRIALS: usize = 16;
/// Depth of the space before and behind a door that stays free, metres, and the heights between which it does.
const WAY_M: f64 = 0.9;
const WAY_HEIGHTS_M: [f32; 2] = [0.05, 1.9];
/// Lights this near to the box of what moves go along, metres.
const WITH_LIGHTS_M: f32 = 0.05;

/// What a thing does.
struct Move {
    to: DAffine3,
    turn_rad: f64,
    carried_by: Option<String>,
}

/// Moves and removes things. Numbers are each thing's own, so that none depends on which others there are.
pub fn arrange(
    scene: &mut LabelledScene,
    first: &First,
    kinds: (Option<&FurnitureVary>, Option<&ClutterVary>),
    rng: &Rng,
    record: &mut Variation,
    cx: &dyn Cx,
) -> Result<(), VaryError> {
    let mut things = Things::of(scene, first.rooms.map_or_else(Vec::new, ways));
    let mut moves: BTreeMap<usize, Move> = BTreeMap::new();
    let warn = |kind: &str, classes: &[String]| {
        let message = format!("nothing of the classes {} in it can move, so `{kind}` of [vary] changes nothing", classes.join(", "));
        cx.warn(Warning { place: first.name.into(), message });
    };
    if let Some(clutter) = kinds.1 {
        let chosen = chosen(&things, &clutter.classes, first);
        let small: Vec<usize> =
            chosen.into_iter().filter(|&thing| size_m(&things, thing) <= clutter.size_m && things.rests(thing)).collect();
        if small.is_empty() {
            warn("clutter", &clutter.classes);
        }
        remove(&mut things, &small, clutter, &rng.fork(1), first);
        for thing in small.into_iter().filter(|&thing| !things.list[thing].is_gone).collect::<Vec<_>>() {
            let rng = &mut own(&rng.fork(2), &things, thing);
            if chance(rng, clutter.share) {
                shift(&mut things, thing, [clutter.shift_m, 180.0], rng, &mut moves, first);
            }
        }
    }
    if let Some(furniture) = kinds.0 {
        let chosen = chosen(&things, &furniture.classes, first);
        let standing: Vec<usize> = chosen.into_iter().filter(|&thing| things.rests(thing)).collect();
        if standing.is_empty() {
            warn("furniture", &furniture.classes);
        }
        for thing in standing {
            let rng = &mut own(&rng.fork(3), &things, thing);
            if chance(rng, furniture.share) && !things.list[thing].has_moved {
                shift(&mut things, thing, [furniture.shift_m, furniture.turn_deg], rng, &mut moves, first);
            }
        }
    }
    apply(scene, &things, &moves, record)
}

/// Random numbers of a thing.
fn own(rng: &Rng, things: &Things, thing: usize) -> Rng {
    let thing = &things.list[thing];
    rng.fork(hash_text(&thing.name) ^ thing.instance as u64)
}

/// The things of some classes that may move or go.
fn chosen(things: &Things, classes: &[String], first: &First) -> Vec<usize> {
    let classes: Vec<i16> = classes.iter().filter_map(|name| class_id(name)).collect();
    let is_chosen = |thing: &usize| {
        let thing = &things.list[*thing];
        thing.instance >= 1 && classes.contains(&thing.class) && !first.fixed.contains(&thing.instance)
    };
    (0..things.list.len()).filter(is_chosen).collect()
}

fn size_m(things: &Things, thing: usize) -> f64 {
    f64::from(things.list[thing].body.bounds.extent().max_element())
}

/// Takes things away, of those that carry something only together with all of it.
fn remove(things: &mut Things, small: &[usize], config: &ClutterVary, rng: &Rng, first: &First) {
    let share = uniform(&mut rng.clone(), config.remove);
    for &thing in small {
        if things.list[thing].is_gone || !chance(&mut own(rng, things, thing), share) {
            continue;
        }
        let group = things.group(thing);
        let may_go = |member: &usize| small.contains(member) && !first.fixed.contains(&things.list[*member].instance);
        if group.iter().all(may_go) {
            group.into_iter().for_each(|member| things.list[member].is_gone = true);
        }
    }
}

/// Moves a thing and what goes with it to the first of some random poses that it may have; where none is, it stays.
fn shift(
    things: &mut Things,
    thing: usize,
    [shift_m, turn_deg]: [f64; 2],
    rng: &mut Rng,
    moves: &mut BTreeMap<usize, Move>,
    first: &First,
) {
    let group = things.group(thing);
    if group.iter().any(|member| first.fixed.contains(&things.list[*member].instance)) {
        return;
    }
    let about = things.list[thing].body.bounds.center();
    for trial in 0..TRIALS {
        // Later trials are smaller ones.
        let scale = 1.0 - trial as f64 / (TRIALS + 4) as f64;
        let mut within = |most: f64| uniform(rng, [-most * scale, most * scale]);
        let (x, y, turn_rad) = (within(shift_m), within(shift_m), within(turn_deg).to_radians());
        let to = turned_and_shifted(about, turn_rad, DVec3::new(x, y, 0.0));
        if things.fits(&group, &to) {
            let name = things.list[thing].name.clone();
            for &member in &group {
                let earlier = moves.remove(&member);
                let (before, turned) = earlier.map_or((DAffine3::IDENTITY, 0.0), |earlier| (earlier.to, earlier.turn_rad));
                let carried_by = (member != thing).then(|| name.clone());
                moves.insert(member, Move { to: to * before, turn_rad: turned + turn_rad, carried_by });
            }
            things.shift(&group, &to);
            return;
        }
    }
}

/// Boxes before and behind doors and passages.
fn ways(rooms: &Rooms) -> Vec<Bounds3> {
    let mut ways = Vec::new();
    for opening in rooms.openings.iter().filter(|opening| opening.kind != OpeningKind::Window) {
        for wall in opening.walls.iter().filter_map(|&wall| rooms.walls.get(wall)) {
            let inward = DVec3::new(wall.inward[0], wall.inward[1], 0.0);
            let corners = opening.corners.iter().map(|corner| DVec3::from(*corner));
            let around = Bounds3::from_points(corners.flat_map(|p| [p, p + WAY_M * inward]).map(|p| p.as_vec3()));
            let floor = wall.floor_z_m as f32;
            let [low, high] = WAY_HEIGHTS_M.map(|height| floor + height);
            ways.push(Bounds3 { min: around.min.with_z(low), max: around.max.with_z(high) });
        }
    }
    ways
}

/// Does to the scene what was decided.
fn apply(scene: &mut LabelledScene, things: &Things, moves: &BTreeMap<usize, Move>, record: &mut Variation) -> Result<(), VaryError> {
    for (&index, change) in moves {
        let thing = &things.list[index];
        for &part in &thing.parts {
            let part = &mut scene.scene.parts[part as usize];
            part.world_from_mesh = change.to * part.world_from_mesh;
        }
        move_lights(scene, &thing.body.bounds, change);
        let center = thing.body.bounds.center();
        let before = place(&change.to.inverse(), center);
        record.moved.push(MovedThing {
            name: thing.name.clone(),
            instance: thing.instance,
            shift_m: (center - before).as_dvec3().to_array(),
            turn_deg: change.turn_rad.to_degrees(),
            carried_by: change.carried_by.clone(),
        });
    }
    let gone: Vec<&crate::things::Thing> = things.list.iter().filter(|thing| thing.is_gone).collect();
    record.removed = gone.iter().map(|thing| thing.name.clone()).collect();
    record.keeps_geometry = record.moved.is_empty() && gone.is_empty();
    if !gone.is_empty() {
        let parts: BTreeSet<&str> =
            gone.iter().flat_map(|thing| &thing.parts).map(|&part| scene.scene.parts[part as usize].name.as_str()).collect();
        *scene = scene.without(&parts.into_iter().collect::<Vec<_>>())?;
    }
    Ok(())
}

/// Lights at a point within what has moved go along. `bounds` is the box around it afterwards.
fn move_lights(scene: &mut LabelledScene, bounds: &Bounds3, change: &Move) {
    let around = Bounds3 { min: bounds.min - WITH_LIGHTS_M, max: bounds.max + WITH_LIGHTS_M };
    let turned = |d: Vec3| change.to.transform_vector3(d.as_dvec3()).as_vec3();
    for light in &mut scene.scene.lights {
        match light {
            Light::Point { position, .. } | Light::Spot { position, .. } | Light::Profile { position, .. } => {
                let after = place(&change.to, *position);
                if !around.contains(after) {
                    continue;
                }
                *position = after;
            }
            Light::Directional { .. } => continue,
        }
        if let Light::Spot { direction, .. } = light {
            *direction = turned(*direction).normalize();
        }
        if let Light::Profile { web_from_world, .. } = light {
            let world_from_web = web_from_world.transpose();
            let axes = [world_from_web.x_axis, world_from_web.y_axis, world_from_web.z_axis].map(turned);
            *web_from_world = enfilade_math::Mat3::from_cols(axes[0], axes[1], axes[2]).transpose();
        }
    }
}
