//! Cloth that people have thrown down: clothes over chairs and on floors, blankets on sofas, towels.

use super::stage::{Bundle, Stage};
use super::table::At;
use super::textiles::Textiles;
use super::things::{floor_point, on_floor, within};
use super::wish::Wish;
use crate::place::Floor;
use crate::room::Footprint;
use enfilade_furniture::cloth::{Sheet, Solid, Textile};
use enfilade_furniture::family_of;
use enfilade_furniture::meet::{Body, overlap};
use enfilade_geometry::Mesh;
use enfilade_math::{Bounds3, DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, TAU};

/// Random places that are tried for each piece of cloth.
const TRIES: usize = 12;
/// Cloth that lies further from its middle than this share of its diagonal cannot be, metres beside it that are looked at.
const AROUND: f32 = 0.12;
/// Height above the highest thing below it from which cloth falls, metres.
const ABOVE: f32 = 0.03;
/// Depth below that thing that is looked at, metres.
const DEEP: f32 = 1.1;
/// What is looked at beyond that, for further falls in the same place, metres.
const SPARE: f32 = 0.25;
/// The highest edge of a piece: all that is at most this much lower, metres.
const EDGE: f32 = 0.05;
/// Cloth lower than this lies on the floor, metres.
const LOW: f32 = 0.1;
/// Greatest height from which cloth falls to the floor, metres: a fall ends after about 1.1 m, and folds take time.
const HIGH: f32 = 0.6;

/// Lets a piece of cloth fall where its row says, if there is a place.
pub fn throw(stage: &mut Stage, floors: &mut [Floor], wish: &Wish, bundle: Bundle, sort: Textiles) {
    let mut rng = wish.rng.clone();
    let textile = sort.textile(&mut rng);
    for _ in 0..TRIES {
        let Some(mut sheet) = held_over(stage, &floors[wish.room], wish, textile, &mut rng) else { continue };
        settle(stage, &mut sheet, &mut None);
        let Some(bounds) = bounds_of(&sheet) else { return };
        let floor = &mut floors[wish.room];
        let place = Footprint { center: bounds.center().truncate(), half: 0.5 * bounds.extent().truncate(), yaw: 0.0 };
        let low = bounds.min.z < LOW;
        if !floor.room().holds(&place, -0.01) || low && !floor.leave(&place, bounds.extent().z, !on_floor(wish.row.at)) {
            // Other places are hardly better, and each costs a fall.
            return;
        }
        let origin = bounds.center();
        let [upper, lower] = sheet.sides(origin);
        hang(stage, bundle, joined(upper, lower), origin);
        return;
    }
}

/// Puts a bundle of one part into the home with this mesh.
pub fn hang(stage: &mut Stage, mut bundle: Bundle, mesh: Mesh, origin: Vec3) {
    let scene = &mut stage.home.scene;
    scene.meshes.push(mesh.into());
    let number = scene.meshes.len() as u32 - 1;
    bundle.parts.iter_mut().for_each(|part| part.mesh = number);
    stage.put(bundle, DAffine3::from_translation(origin.as_dvec3()));
}

/// One mesh of both sides.
pub fn joined(mut upper: Mesh, lower: Mesh) -> Mesh {
    upper.append(&lower);
    upper
}

/// Lets a sheet fall on all that is around and below it: on what is `known` of that from an earlier fall, if it is enough.
pub fn settle(stage: &Stage, sheet: &mut Sheet, known: &mut Option<Solid>) {
    let Some(around) = bounds_of(sheet) else { return };
    let reach = 0.25 * sheet.textile.size.length() + AROUND;
    let window = Bounds3 {
        min: Vec3::new(around.min.x - reach, around.min.y - reach, (around.min.z - DEEP).max(-0.06)),
        max: around.max + Vec3::new(reach, reach, 0.1),
    };
    let solid = match known.take().filter(|solid| solid.covers(&window)) {
        Some(solid) => solid,
        None => {
            let window = Bounds3 { min: window.min - SPARE, max: window.max + SPARE };
            Solid::new(&window, stage.triangles(&window))
        }
    };
    sheet.fall(known.insert(solid));
}

/// The box around a sheet, if it has any points.
pub fn bounds_of(sheet: &Sheet) -> Option<Bounds3> {
    let cloth = sheet.points.iter().zip(&sheet.here).filter(|(_, here)| **here).map(|(p, _)| *p);
    let bounds = Bounds3::from_points(cloth);
    bounds.min.is_finite().then_some(bounds)
}

/// A sheet over a random place of its row, from which it can fall.
fn held_over(stage: &mut Stage, floor: &Floor, wish: &Wish, textile: Textile, rng: &mut Rng) -> Option<Sheet> {
    let room = floor.room();
    let (at, yaw, crumpled) = match wish.row.at {
        At::Over(_) => {
            let (crest, reach) = stage.over(wish.host.as_deref()?, false)?.crest(EDGE)?;
            // It hangs to both sides of the edge: its length lies across that.
            let across = if reach.x > reach.y { 0.0 } else { FRAC_PI_2 };
            let aside = Vec2::new(rng.range(-0.2, 0.2) * reach.x, rng.range(-0.2, 0.2) * reach.y);
            (crest.truncate() + aside, across + rng.range(-0.25, 0.25), rng.range(0.0, 0.25))
        }
        _ if on_floor(wish.row.at) => {
            let half = Vec2::splat(0.22);
            let point = floor_point(stage, room, wish, half, rng)?;
            let place = Footprint { center: point, half, yaw: 0.0 };
            stage.floor(wish.room)?.level(&place, 0.5)?;
            (point, rng.range(0.0, TAU), rng.range(0.75, 1.0))
        }
        _ => {
            let ground = stage.over(wish.host.as_deref()?, false)?;
            let point = within(ground.window(), rng);
            ground.top(point)?;
            (point, rng.range(0.0, TAU), rng.range(0.3, 0.95))
        }
    };
    let mut sheet = Sheet::new(textile, at.extend(0.0), yaw, crumpled, rng);
    let bounds = bounds_of(&sheet)?;
    // Above all that it covers, but for what is too high to be below it. Nobody throws cloth on curtains, which are too thin to carry it.
    let column = Bounds3 { min: bounds.min.truncate().extend(0.0), max: bounds.max.truncate().extend(1.25) };
    let is_curtain = |body: &Body| family_of(&body.name).ends_with("curtain") && overlap(&body.bounds, &column, 0.0);
    if stage.bodies.iter().any(is_curtain) {
        return None;
    }
    let top = stage.bodies.iter().filter(|body| overlap(&body.bounds, &column, 0.0)).filter_map(|body| highest(body, &column));
    let height = top.fold(0.0f32, f32::max) + ABOVE;
    if on_floor(wish.row.at) && height > HIGH {
        return None;
    }
    let lift = Vec3::Z * (height - bounds.min.z);
    sheet.points.iter_mut().for_each(|p| *p += lift);
    let inside = sheet.points.iter().zip(&sheet.here).all(|(p, here)| !here || room.contains(p.truncate(), -0.015));
    inside.then_some(sheet)
}

/// The highest point of a body in a column, below that column's end.
fn highest(body: &Body, column: &Bounds3) -> Option<f32> {
    let inside =
        |p: &Vec3| p.truncate().cmpge(column.min.truncate()).all() && p.truncate().cmple(column.max.truncate()).all() && p.z < column.max.z;
    let tops = body.within(column).flatten().filter(|p| inside(p)).map(|p| p.z);
    tops.reduce(f32::max)
}
