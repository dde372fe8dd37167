//! Lights in a pattern over a whole ceiling, as in offices, schools and shops.

use super::Furnisher;
use crate::room::Footprint;
use crate::room::ceiling::GRID_BELOW;
use enfilade_furniture::office::{Around, CeilingPanel, TubeLamp};
use enfilade_furniture::{CEILING_TILE_M, CONTACT, Furniture, pose};
use enfilade_math::Vec2;
use std::f32::consts::FRAC_PI_2;

/// From one light to the next, along and across, metres.
const APART: Vec2 = Vec2::new(2.4, 2.1);
/// Air between the ends of tubes in one line, metres.
const ENDS: f32 = 0.5;
/// Distance of lights from walls, metres.
const WALL: f32 = 0.25;

impl Furnisher<'_> {
    /// Lights over the whole ceiling: panels in place of tiles where it has a grid, else lines of tubes.
    pub fn work_lights(&mut self) {
        if self.room.has_grid() && self.chance(0.85) {
            let panel = CeilingPanel::random(&mut self.rng);
            self.panels(panel);
        } else {
            let lamp = TubeLamp::random(&mut self.rng);
            let drop = if self.room.has_grid() || self.room.size.z < 2.75 { 0.0 } else { lamp.drop };
            self.tubes(TubeLamp { drop, ..lamp });
        }
    }

    /// Panels in place of tiles.
    fn panels(&mut self, panel: CeilingPanel) {
        let size = self.room.size.truncate();
        let along_x = size.x >= size.y;
        let tiles = if along_x { [panel.tiles, 1] } else { [1, panel.tiles] };
        let snapped = |x: f32, tiles: u8| {
            let cells = x / CEILING_TILE_M;
            CEILING_TILE_M * if tiles == 1 { cells.floor() + 0.5 } else { cells.round() }
        };
        for y in spread(size.y, APART.y) {
            for x in spread(size.x, APART.x) {
                let at = Vec2::new(snapped(x, tiles[0]), snapped(y, tiles[1]));
                self.fix(at, if along_x { 0.0 } else { FRAC_PI_2 }, &panel);
            }
        }
    }

    /// Lines of tubes along the room.
    fn tubes(&mut self, lamp: TubeLamp) {
        let size = self.room.size.truncate();
        let (length, width, yaw) = if size.x >= size.y { (size.x, size.y, 0.0) } else { (size.y, size.x, FRAC_PI_2) };
        let across = if lamp.around == Around::Nothing { APART.y } else { APART.x };
        for y in spread(width, across) {
            for x in spread(length, lamp.length + ENDS) {
                let at = Vec2::from_angle(yaw).rotate(Vec2::new(x, y));
                self.fix(at, yaw, &lamp);
            }
        }
    }

    /// Fixes a light to the ceiling at a point of the box around the room, counted from its middle, unless a wall or a thing is there.
    fn fix(&mut self, at: Vec2, yaw: f32, lamp: &dyn Furniture) {
        let (grain, height) = (self.room.grain, self.room.size.z);
        let center = self.room.box_center + Vec2::from_angle(grain).rotate(at);
        let around = Footprint { center, half: 0.5 * lamp.size().truncate(), yaw: grain + yaw };
        let z = [height - lamp.size().z, height];
        if !self.room.slopes.is_empty() || !self.room.holds(&around, WALL) || !self.floor.is_free(&around, z) {
            return;
        }
        let below = CONTACT + if self.room.has_grid() { GRID_BELOW } else { 0.0 };
        self.build(lamp, pose(f64::from(center.x), f64::from(center.y), f64::from(height - below), f64::from(grain + yaw)));
        self.floor.take(around, z);
    }

    /// Fixes a thing to the ceiling before the middle of a wall that it faces, `out` metres from it.
    pub fn fix_before(&mut self, wall: crate::room::Wall, x: f32, out: f32, thing: &dyn Furniture) {
        let center = self.room.before(wall, x, out);
        let at = Vec2::from_angle(-self.room.grain).rotate(center - self.room.box_center);
        let yaw = self.room.yaw(wall) + std::f32::consts::PI - self.room.grain;
        self.fix(at, yaw, thing);
    }
}

/// Places of equal things over a length, about `apart` from each other, counted from its middle.
fn spread(length: f32, apart: f32) -> impl Iterator<Item = f32> {
    let count = (length / apart).round().max(1.0);
    (0..count as usize).map(move |k| length * ((k as f32 + 0.5) / count - 0.5))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_are_spread_evenly_and_symmetrically() {
        let places: Vec<f32> = spread(7.2, 2.4).collect();
        assert!(places.iter().zip([-2.4, 0.0, 2.4]).all(|(found, expected)| (found - expected).abs() < 1e-5), "{places:?}");
        assert_eq!(spread(1.0, 2.4).collect::<Vec<_>>(), [0.0]);
    }
}
