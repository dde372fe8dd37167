//! Walls: free pieces of them, and what people hang there themselves.

use super::stage::{Bundle, Stage, middle};
use super::wish::Wish;
use crate::place::Floor;
use crate::room::{Footprint, Room, Wall};
use crate::shell::is_shell;
use enfilade_furniture::meet::overlap;
use enfilade_furniture::on;
use enfilade_furniture::touch::reach;
use enfilade_math::{Bounds3, DAffine3, Rng, Vec2, Vec3};

/// Walls keep this much free beside openings, metres.
const CASING: f32 = 0.12;
/// Skirtings and what else is at the foot of walls, metres.
const FOOT: f32 = 0.1;
/// Places that are tried for each thing.
const TRIES: usize = 60;
/// Free space around what hangs, to the sides and before it, metres.
const AROUND: f32 = 0.04;
/// What is no deeper than this hangs flat, metres.
const FLAT: f32 = 0.03;
/// Distance below a level ceiling, metres.
const BELOW: f32 = 0.1;

/// True where a piece of a wall of twice `half` the size around a point meets no opening; nowhere in rooms with slopes.
pub fn piece(room: &Room, wall: Wall, x: f32, z: f32, half: Vec2) -> bool {
    let inside = x.abs() + half.x < 0.5 * room.length(wall) - 0.01 && z - half.y > FOOT && z + half.y < room.size.z - BELOW;
    let clear = |[low, high]: [f32; 2], at: f32, half: f32| at + half < low - CASING || at - half > high + CASING;
    let mut openings = room.openings.iter().filter(|opening| opening.wall == wall);
    inside && room.slopes.is_empty() && openings.all(|o| clear(o.x, x, half.x) || clear(o.z, z, half.y))
}

/// Hangs a thing, whose origin is the middle of its back, on a wall where nothing is yet.
pub fn hang(stage: &mut Stage, floor: &mut Floor, wish: &Wish, bundle: Bundle, [low, high]: [f32; 2]) {
    let mut rng: Rng = wish.rng.clone();
    let bounds = stage.bodies_of(&bundle, DAffine3::IDENTITY).iter().fold(Bounds3::EMPTY, |all, body| all.union(body.bounds));
    let (extent, center) = (bounds.extent(), bounds.center());
    let half = 0.5 * Vec2::new(extent.x, extent.z);
    for _ in 0..TRIES {
        let room = floor.room();
        let walls = room.walls();
        let wall = walls[rng.below(walls.len())];
        let (x, z) = (0.5 * room.length(wall) * rng.range(-1.0, 1.0), rng.range(low, high));
        if !piece(room, wall, x, z + center.z, half) {
            continue;
        }
        let pose = on(room.wall_pose(wall), Vec3::new(x - center.x, 0.0, z), 0.0);
        let bodies = stage.bodies_of(&bundle, pose);
        let around = bodies.iter().fold(Bounds3::EMPTY, |all, body| all.union(body.bounds));
        let free =
            stage.bodies.iter().filter(|body| !is_shell(&body.name)).all(|body| !body.boxes().any(|own| overlap(&own, &around, AROUND)));
        let back = -room.inward(wall).extend(0.0);
        let carriers = || stage.bodies.iter().filter(|body| is_shell(&body.name));
        let held = bodies.iter().any(|body| carriers().any(|shell| body.meets(shell, back * reach(&body.name, &shell.name))));
        let place = Footprint { center: middle(&around), half: 0.5 * around.extent().truncate(), yaw: 0.0 };
        // What hangs flat on the wall is in nobody's way.
        let passes = extent.y < FLAT || floor.leave(&place, extent.z, true);
        if free && held && passes {
            return stage.put(bundle, pose);
        }
    }
}
