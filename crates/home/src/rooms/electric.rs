//! Switches by the doors, and sockets.

use super::Furnisher;
use crate::room::{Filling, Opening, kind};
use enfilade_furniture::{Furniture, Socket, Switch, on};
use enfilade_math::Vec3;

/// Height of the middle of switches above the floor, metres (DIN 18015-3).
const SWITCH: f32 = 1.05;
/// Height of sockets above the floor, metres.
const SOCKET: f32 = 0.30;
/// Share of switches with a socket below.
const BELOW: f32 = 0.7;
/// Greatest distance of sockets from the things that they are for, metres.
const FLEX: f32 = 1.5;
/// Floor area for each further group of sockets, square metres.
const AREA: f32 = 6.0;
/// The stream of random numbers of sockets, so that they do not change what else is in a room.
const STREAM: u64 = 0x50c;

impl Furnisher<'_> {
    /// A switch beside the door, where the handle is, and often a socket below it.
    pub fn switch(&mut self, way: &Opening) {
        let hinge = match way.filling {
            Filling::Door(leaf) => leaf.hinge,
            _ => 1.0,
        };
        let half = 0.5 * self.room.length(way.wall);
        let place = |side: f32| way.center_x() + side * (0.5 * way.size().x + 0.15);
        let free = |x: &f32| {
            let others = self.room.openings.iter().filter(|o| o.wall == way.wall);
            x.abs() < half - 0.08 && others.clone().all(|o| *x < o.x[0] - 0.11 || *x > o.x[1] + 0.11)
        };
        let swings = |x: f32| {
            let strip = self.floor.strip(way.wall, [x - 0.05, x + 0.05], 0.06);
            self.room.ways().filter(|o| o.wall != way.wall).any(|o| self.room.way_zone(o).meets(&strip, 0.0))
        };
        let z = [SWITCH - 0.05, SWITCH + 0.05];
        let free = |x: &f32| free(x) && !swings(*x) && self.floor.is_free(&self.floor.strip(way.wall, [x - 0.05, x + 0.05], 0.02), z);
        let Some(x) = [place(-hinge), place(hinge)].into_iter().find(free) else { return };
        let mut rng = self.rng.fork(STREAM + way.wall.0 as u64);
        let low = !self.room.kind.wet() && rng.next_f32() < BELOW;
        let mut fix = |thing: &dyn Furniture, z: f32| {
            self.build(thing, on(self.room.wall_pose(way.wall), Vec3::new(x, 0.0, z), 0.0));
            self.floor.take(self.floor.strip(way.wall, [x - 0.05, x + 0.05], 0.02), [z - 0.05, z + 0.05]);
        };
        fix(&Switch::random(&mut rng), SWITCH);
        if low {
            fix(&Socket { count: 1 }, SOCKET);
        }
    }

    /// Sockets along the walls: near what needs them, then here and there.
    pub fn sockets(&mut self) {
        if !kind::row(self.room.kind).fittings.sockets {
            return;
        }
        let mut rng = self.rng.fork(STREAM);
        for near in std::mem::take(&mut self.plugs) {
            let cost = |distance: f32| if distance < FLEX { distance } else { f32::INFINITY };
            let socket = Socket::random(&mut rng);
            self.hang(&socket, SOCKET, &self.room.walls(), |_, s| cost(s.origin.distance(near)));
        }
        let walls = self.room.walls();
        let first = rng.below(walls.len());
        let count = ((self.room.area / AREA) as usize).clamp(1, 4);
        for wall in (0..count).map(|k| walls[(first + k) % walls.len()]) {
            let wished = 0.45 * self.room.length(wall) * rng.range(-1.0, 1.0);
            self.hang(&Socket::random(&mut rng), SOCKET, &[wall], |_, s| (s.x - wished).abs());
        }
    }
}
