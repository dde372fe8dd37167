//! Checks on every style of a family, whatever its weight.

use super::catalogue_tests::{SLACK, held, inside_out};
use super::piece_tests::{APART, loose_among, nothing, side_by_side};
use super::{Furniture, Place};
use enfilade_math::{Bounds3, Vec3};

/// What is wrong with these named things: invalid or inside out, beyond their box, not held as their place says, or in pieces.
fn faults(place: Place, things: &[(String, Box<dyn Furniture>)]) -> Vec<String> {
    let scene = side_by_side(things, nothing());
    let mut found: Vec<String> = scene.validate().err().map(|error| error.to_string()).into_iter().collect();
    let mut filled = vec![Bounds3::EMPTY; things.len()];
    for part in &scene.parts {
        let first = scene.world_positions(part).next().map_or(0.0, |p| p.x);
        let k = (f64::from(first) / APART).round() as usize;
        found.extend(inside_out(&scene.meshes[part.mesh as usize]).map(|wrong| format!("{}, {}: {wrong}", things[k].0, part.name)));
        let own = scene.world_positions(part).map(|p| p - Vec3::X * (APART * k as f64) as f32);
        filled[k] = own.fold(filled[k], Bounds3::include);
    }
    for ((name, thing), filled) in things.iter().zip(&filled) {
        let expected = place.bounds(thing.size());
        let over = [expected.min - filled.min, filled.max - expected.max];
        if over[0].max(over[1]).max_element() > SLACK {
            found.push(format!("{name} reaches {over:?} m below and beyond its box"));
        }
        if !held(place, filled, &expected) {
            found.push(format!("{name} floats: {filled:?}"));
        }
    }
    found.extend([nothing(), nothing().with_joints()].into_iter().flat_map(|b| loose_among(things, place, b)));
    found
}

/// Fails if anything is wrong with these named things.
pub fn check(place: Place, things: &[(String, Box<dyn Furniture>)]) {
    let found = faults(place, things);
    assert!(found.is_empty(), "{found:#?}");
}
