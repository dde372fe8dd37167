//! Things that belong together, and what a room of its kind may have besides.

use super::Furnisher;
use super::placed::PLACED;
use super::wishes::{centred, cornered, tucked_away};
use crate::place::{Floor, Piece, Spot};
use enfilade_furniture::{Class, FAMILIES, Place};
use enfilade_math::Vec2;
use std::f32::consts::PI;

/// Distance of the chair's middle from the desk's front, metres.
const CHAIR: f32 = 0.22;
/// Free height over the chair under a sloping ceiling, metres.
const SEATED: f32 = 1.5;
/// Hanging plants keep to corners: this far from both walls, metres.
const CORNER: f32 = 0.6;
/// Probability that a room has a family that nothing else asks for.
const SELDOM: f32 = 0.22;

impl Furnisher<'_> {
    /// A desk with what people work with, and a chair before it.
    pub fn work_place(&mut self, cost: impl Fn(&Floor, &Spot) -> f32) -> bool {
        let chair = if self.chance(0.75) { "office_chair" } else { "chair" };
        let Some(chair) = self.any(chair) else { return false };
        for _ in 0..4 {
            let Some(desk) = self.any("desk") else { return false };
            let size = desk.size();
            let table = Piece::standing(size, 0.0);
            let seat = Piece { headroom: SEATED, ..Piece::standing(chair.size(), 0.0) };
            let turn = self.rng.range(-0.3, 0.3);
            let group = [table, seat.at(0.0, table.at.y + 0.5 * size.y + CHAIR + 0.1, PI + turn)];
            let spots = self.floor.along_walls(size.x);
            let Some((spot, poses)) = self.floor.place(&group, spots, &cost) else { continue };
            self.plugs.push(spot.origin);
            self.build(desk.as_ref(), poses[0]);
            self.build(chair.as_ref(), poses[1]);
            self.litter(&desk.surfaces(), poses[0], 1.4);
            return true;
        }
        false
    }

    /// A basin with a mirror above it.
    pub fn basin(&mut self) {
        let Some(basin) = self.furnish("washbasin", centred) else { return };
        let (x, wall) = (basin.spot.x, basin.spot.wall);
        if let (Some(mirror), Some(wall)) = (self.any("mirror_cabinet"), wall) {
            self.hang(mirror.as_ref(), 1.55, &[wall], |_, s| if (s.x - x).abs() < 0.25 { (s.x - x).abs() } else { f32::INFINITY });
        }
    }

    /// A toilet with its paper and brush.
    pub fn toilet(&mut self) {
        let Some(toilet) = self.furnish("toilet", tucked_away) else { return };
        let (x, wall, half) = (toilet.spot.x, toilet.spot.wall, 0.5 * toilet.size.x);
        let beside = |s: &Spot| if (s.x - x).abs() < half + 0.5 && s.wall == wall { (s.x - x).abs() } else { f32::INFINITY };
        if let Some(brush) = self.any("toilet_brush") {
            self.stand(brush.as_ref(), |_, s| beside(s));
        }
        if let (Some(paper), Some(wall)) = (self.any("paper_holder"), wall) {
            let sides = self.room.beside(wall);
            let near = |floor: &Floor, s: &Spot| {
                let gap = s.origin.distance(toilet.spot.point(Vec2::new(0.0, 0.5 * toilet.size.y)));
                if gap < 0.9 && floor.to_way(s.origin) > 0.3 { gap } else { f32::INFINITY }
            };
            self.hang(paper.as_ref(), 0.7, &[sides[1], sides[0], wall], near);
        }
    }

    /// Lays one of a family of mats where `cost` is lowest.
    pub fn mat(&mut self, family: &str, cost: impl Fn(&Floor, &Spot) -> f32) {
        let Some(mat) = self.any(family) else { return };
        let piece = Piece { flat: true, ..Piece::standing(mat.size(), 0.0).at(0.0, 0.0, 0.0) };
        let spots = self.floor.everywhere(0.1, &[0.0, 0.5 * PI]);
        if let Some((_, poses)) = self.floor.place(&[piece], spots, cost) {
            self.build(mat.as_ref(), poses[0]);
        }
    }

    /// Hangs a plant from the ceiling in the lightest corner with this probability, where nobody walks.
    pub fn hang_plant(&mut self, probability: f32) {
        if !self.chance(probability) {
            return;
        }
        let Some(plant) = self.any("hanging_plant") else { return };
        let (size, height) = (plant.size(), self.room.size.z);
        let piece = Piece { z: height - size.z, ..Piece::standing(size, 0.0).at(0.0, 0.0, 0.0) };
        let cost = |floor: &Floor, s: &Spot| {
            if floor.room().to_walls(s.origin)[1] < CORNER { floor.to_window(s.origin) } else { f32::INFINITY }
        };
        let spots = self.floor.everywhere(0.1, &[0.0]);
        if let Some((spot, _)) = self.floor.place(&[piece], spots, cost) {
            self.above(spot.origin, plant.as_ref());
        }
    }

    /// Leaves up to `max` small things of these families lying on the floor.
    pub fn strew(&mut self, families: &[&str], max: usize) {
        let count = (self.rng.below(max + 1) as f32 * self.clutter) as usize;
        for _ in 0..count {
            let family = families[self.rng.below(families.len())];
            let Some(thing) = self.any(family) else { continue };
            let target =
                self.room.box_center + Vec2::new(self.rng.range(-1.0, 1.0), self.rng.range(-1.0, 1.0)) * 0.4 * self.room.size.truncate();
            let yaws = [self.rng.range(0.0, 2.0 * PI)];
            self.stand_free(thing.as_ref(), &yaws, |_, s| s.origin.distance(target));
        }
    }

    /// Adds families that nothing else has asked for: each that people have in this kind of room, with a probability of `SELDOM`.
    pub fn extras(&mut self) {
        let kind = self.room.kind;
        for family in FAMILIES.iter().filter(|f| f.is_in(kind)) {
            // A room has its seats, its bed and its sanitary ware already.
            let once = matches!(
                family.class,
                Class::Sofa
                    | Class::Bed
                    | Class::Chair
                    | Class::Table
                    | Class::Desk
                    | Class::Toilet
                    | Class::Sink
                    | Class::Bathtub
                    | Class::Refrigerator
                    | Class::Counter
            );
            if once || PLACED.contains(&family.name) || self.known.contains(&family.name) || !self.chance(SELDOM) {
                continue;
            }
            match family.place {
                Place::AgainstWall => drop(self.furnish(family.name, tucked_away)),
                Place::Corner | Place::Free => drop(self.furnish(family.name, cornered)),
                Place::OnWall => drop(self.hang_one(1.0, family.name, 1.5, |_, s| s.x.abs())),
                Place::Ceiling | Place::OnSurface | Place::Underfoot => {}
            }
        }
    }
}
