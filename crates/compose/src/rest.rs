//! The last check: everything at once, with nothing asleep.

use crate::place::{Placed, moved};
use crate::world::World;

/// Time for which everything is simulated once more, seconds.
const AGAIN_S: f64 = 2.0;
/// How far an object may move in it, metres.
const STEADY_M: f64 = 0.002;
/// Depth to which things may be in each other at the end, metres.
const DEEPEST_M: f64 = 0.0009;
/// Times that this is repeated before what still moves is removed.
const ROUNDS: usize = 3;

/// Simulates until nothing moves, and removes what does not come to rest or is in something else. Returns the numbers that objects had when
/// they were removed, in that order, with the reasons.
pub fn settle_all(world: &mut World, placed: &mut Vec<Placed<'_>>) -> Vec<(usize, String)> {
    let mut removed = Vec::new();
    let mut round = 0;
    loop {
        let before: Vec<_> = (0..world.len()).map(|number| world.placement(number)).collect();
        let poses = world.poses();
        world.run(AGAIN_S);
        let way = |number: usize| moved(&placed[number], &before[number], &world.placement(number));
        let worst = (0..world.len()).map(|number| (way(number), number)).max_by(|a, b| a.0.total_cmp(&b.0));
        round += 1;
        let restless = worst.filter(|(way, _)| *way > STEADY_M);
        let reason = match restless {
            None => {
                world.restore(&poses);
                let deep = (0..world.len()).map(|number| (world.depth(number), number)).max_by(|a, b| a.0.total_cmp(&b.0));
                let Some((depth, number)) = deep.filter(|(depth, _)| *depth > DEEPEST_M) else { return removed };
                (number, format!("{:.1} mm deep in something else at rest", depth * 1e3))
            }
            Some(_) if round < ROUNDS => continue,
            Some((way, number)) => (number, format!("it does not come to rest: {:.0} mm in {AGAIN_S} s", way * 1e3)),
        };
        world.remove(reason.0);
        placed.remove(reason.0);
        removed.push(reason);
        round = 0;
    }
}
