//! The last check: everything at once, with nothing asleep.

use crate::model::Model;
use crate::place::{Placed, moved};
use crate::shapes::pose;
use crate::surfaces::Surfaces;
use crate::world::World;
use enfilade_dataset::{PlacedObject, PlacedObjects};
use enfilade_math::{DMat3, DQuat, DVec3};
use enfilade_scene::LabelledScene;
use std::collections::BTreeMap;

/// Time for which everything is simulated once more, seconds.
const AGAIN_S: f64 = 2.0;
/// How far an object may move in it, metres.
const STEADY_M: f64 = 0.002;
/// Depth to which things may be in each other at the end, metres.
const DEEPEST_M: f64 = 0.0008;
/// Space around objects in which the scene takes part, metres.
const AROUND_M: f64 = 0.1;
/// Times that this is repeated before what still moves is removed.
const ROUNDS: usize = 3;

/// Simulates until nothing moves, and removes what does not come to rest or is in something else. Returns the numbers that objects had when
/// they were removed, in that order, with the reasons.
pub fn settle_all(world: &mut World, placed: &mut Vec<Placed<'_>>) -> Vec<(usize, String)> {
    let mut removed = Vec::new();
    let mut round = 0;
    loop {
        let mut next = world.renewed();
        next.run(AGAIN_S);
        let way = |number: usize| moved(&placed[number], &world.placement(number), &next.placement(number));
        let worst = (0..world.len()).map(|number| (way(number), number)).max_by(|a, b| a.0.total_cmp(&b.0));
        round += 1;
        let reason = match worst.filter(|(way, _)| *way > STEADY_M) {
            None => {
                let deep = (0..world.len()).map(|number| (world.depth(number), number)).max_by(|a, b| a.0.total_cmp(&b.0));
                let Some((depth, number)) = deep.filter(|(depth, _)| *depth > DEEPEST_M) else { return removed };
                (number, format!("{:.1} mm deep in something else at rest", depth * 1e3))
            }
            Some(_) if round < ROUNDS => {
                *world = next;
                continue;
            }
            Some((way, number)) => (number, format!("it does not come to rest: {:.0} mm in {AGAIN_S} s", way * 1e3)),
        };
        world.remove(reason.0);
        placed.remove(reason.0);
        removed.push(reason);
        round = 0;
    }
}

/// How far the objects of a scene move when they are simulated for two more seconds by a new simulation, metres, at most. `scene` is the scene
/// without them, and `load` reads a model.
///
/// # Errors
/// When a model cannot be read.
pub fn moved_again(
    scene: &LabelledScene,
    placed: &PlacedObjects,
    load: &dyn Fn(&str) -> Result<LabelledScene, String>,
) -> Result<f64, String> {
    let mut models = BTreeMap::new();
    for object in &placed.objects {
        if !models.contains_key(&object.model) {
            models.insert(&object.model, Model::new(load(&object.model)?)?);
        }
    }
    let around = |object: &PlacedObject| {
        let at = DVec3::from_array([0, 1, 2].map(|i| object.world_from_model[i][3]));
        let reach = DVec3::splat(AROUND_M + 2.0 * models[&object.model].longest * object.scale);
        [at - reach, at + reach]
    };
    let mut world = World::new(&scene.scene, &placed.objects.iter().map(around).collect::<Vec<_>>());
    let surfaces = Surfaces::default();
    let mut bodies = Vec::new();
    for object in &placed.objects {
        let (model, scale) = (&models[&object.model], object.scale);
        let rows = object.world_from_model;
        let rotation = DMat3::from_cols_array_2d(&[0, 1, 2].map(|column| [0, 1, 2].map(|row| rows[row][column])));
        let translation = DVec3::from_array([0, 1, 2].map(|row| rows[row][3]));
        world.add(model.shape(scale), pose(DQuat::from_mat3(&rotation), translation));
        bodies.push(Placed { model, scale, surfaces: &surfaces, is_upright: false });
    }
    let before: Vec<_> = (0..world.len()).map(|number| world.placement(number)).collect();
    world.run(AGAIN_S);
    Ok(bodies.iter().zip(before).enumerate().map(|(i, (body, before))| moved(body, &before, &world.placement(i))).fold(0.0, f64::max))
}
