//! The hand that furnishes a room: it finds a place for a thing, and builds the thing there.

use super::placed::PLACED;
use crate::place::{Floor, Piece, Spot, scatter};
use crate::plan::FloorPlan;
use crate::room::{Footprint, Room, Wall};
use enfilade_furniture::assets::{Borrowed, Library};
use enfilade_furniture::{Builder, FAMILIES, Family, Furniture, Palette, PictureOnWall, Place, RoomKind, Rug, Surface, family_named, on};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A room being furnished.
pub struct Furnisher<'a> {
    /// Takes the parts.
    pub b: &'a mut Builder,
    /// Plan of the whole home.
    pub plan: &'a FloorPlan,
    /// The room.
    pub room: &'a Room,
    /// The home's colours.
    pub palette: &'a Palette,
    /// Models of others.
    pub models: &'a Library,
    /// The floor with the things placed so far.
    pub floor: Floor,
    /// Density of small things.
    pub clutter: f32,
    /// Decides what is in this room.
    pub rng: Rng,
    /// The wall that may get a finish of its own.
    pub accent: Option<Wall>,
    /// Families that have been asked for, so that [`Furnisher::extras`] leaves them out.
    pub known: Vec<&'static str>,
    /// Pieces of wall without skirting, because of what is built in there.
    pub built_in: Vec<(Wall, [f32; 2])>,
    /// Positions of things that need a socket.
    pub plugs: Vec<Vec2>,
}

/// Height of the middle of pictures.
const EYE: f32 = 1.52;
/// Small things on a square metre of a surface in a home that is lived in.
const DENSITY: f32 = 9.0;
/// Distance between things on furniture and the ceiling, metres.
const CEILING_AIR: f32 = 0.05;
/// Variants of a family that are tried before the room does without.
const VARIANTS: usize = 4;

/// Something that found its place.
#[derive(Clone, Copy, Debug)]
pub struct Standing {
    /// Pose of the thing.
    pub pose: DAffine3,
    /// Width, depth and height of the box around the thing.
    pub size: Vec3,
    /// Spot of its group.
    pub spot: Spot,
}

impl<'a> Furnisher<'a> {
    /// An empty room.
    pub fn new(
        b: &'a mut Builder,
        plan: &'a FloorPlan,
        room: &'a Room,
        palette: &'a Palette,
        models: &'a Library,
        clutter: f32,
        rng: Rng,
    ) -> Self {
        let floor = Floor::new(room);
        let (known, built_in, plugs) = (Vec::new(), Vec::new(), Vec::new());
        Self { b, plan, room, palette, models, floor, clutter, rng, accent: None, known, built_in, plugs }
    }

    /// True with this probability.
    pub fn chance(&mut self, probability: f32) -> bool {
        self.rng.next_f32() < probability
    }

    /// True where the home has a room of this kind.
    pub fn home_has(&self, kind: RoomKind) -> bool {
        self.plan.rooms.iter().any(|room| room.kind == kind)
    }

    /// Builds a thing in a pose.
    pub fn build(&mut self, thing: &dyn Furniture, pose: DAffine3) {
        thing.build(self.b, pose, &mut self.rng);
    }

    /// Builds a small thing in a pose. In a home without clutter it is removed again, so that the random numbers that follow stay the same.
    pub fn build_small(&mut self, thing: &dyn Furniture, pose: DAffine3) {
        let before = self.b.part_count();
        self.build(thing, pose);
        if self.clutter == 0.0 {
            self.b.take_back(before);
        }
    }

    /// Whether something of this size, in this pose, is below the ceiling, where that slopes.
    pub fn is_below_slopes(&self, size: Vec3, pose: DAffine3) -> bool {
        let top = pose.translation.z as f32 + size.z + CEILING_AIR;
        self.room.slopes.is_empty() || self.room.lowest_over(&Footprint::of(pose, size)) >= top
    }

    /// One variant of a family, or a model of the library.
    pub fn any(&mut self, family: &str) -> Option<Box<dyn Furniture>> {
        let family = family_named(family)?;
        self.known.push(family.name);
        Some(self.variant(family))
    }

    fn variant(&mut self, family: &'static Family) -> Box<dyn Furniture> {
        let mut own = (family.random)(&mut self.rng);
        own.fit(self.room.size.z);
        match self.borrow(family.name, own.as_ref(), |_| true) {
            Some(model) => Box::new(model),
            None => own,
        }
    }

    /// A model of the library that replaces `own`, if there is one of a size that `fits`.
    pub fn borrow(&mut self, family: &str, own: &dyn Furniture, fits: impl Fn(Vec3) -> bool) -> Option<Borrowed> {
        let family = family_named(family)?;
        let (number, model) = self.models.pick(family, fits, &mut self.rng)?;
        Some(Borrowed { number, model, family, reach: own.reach() })
    }

    /// `own`, or a model of the library in its place.
    pub fn or_borrowed(&mut self, family: &str, own: impl Furniture + 'static) -> Box<dyn Furniture> {
        match self.borrow(family, &own, |_| true) {
            Some(model) => Box::new(model),
            None => Box::new(own),
        }
    }

    /// Places one of a family with its back to the wall where `cost` is lowest, and scatters small things on it.
    pub fn furnish(&mut self, family: &str, cost: impl Fn(&Floor, &Spot) -> f32) -> Option<Standing> {
        for _ in 0..VARIANTS {
            let thing = self.any(family)?;
            if let Some(found) = self.stand(thing.as_ref(), &cost) {
                self.litter(&thing.surfaces(), found.pose, 1.0);
                return Some(found);
            }
        }
        None
    }

    /// Furnishes as [`Furnisher::furnish`] does, with this probability.
    pub fn perhaps(&mut self, probability: f32, family: &str, cost: impl Fn(&Floor, &Spot) -> f32) -> Option<Standing> {
        if self.chance(probability) { self.furnish(family, cost) } else { None }
    }

    /// Scatters small things that people have in this kind of room on surfaces, `density` times as many as usual.
    pub fn litter(&mut self, surfaces: &[Surface], pose: DAffine3, density: f32) {
        let area: f32 = surfaces.iter().map(|s| (s.max - s.min).max(Vec2::ZERO)).map(|e| e.x * e.y).sum();
        let kind = self.room.kind;
        let is_scattered = |f: &&Family| f.place == Place::OnSurface && f.is_in(kind) && !PLACED.contains(&f.name);
        let fitting: Vec<_> = FAMILIES.iter().filter(is_scattered).collect();
        let expected = (DENSITY * area * density * self.clutter).min(40.0);
        let count = (expected * self.rng.range(0.6, 1.4) + self.rng.next_f32()) as usize;
        if fitting.is_empty() {
            return;
        }
        let things: Vec<Box<dyn Furniture>> = (0..count)
            .map(|_| {
                let family = fitting[self.rng.below(fitting.len())];
                self.variant(family)
            })
            .collect();
        self.scatter(surfaces, pose, &things);
    }

    /// Hangs one of a family with this probability.
    pub fn hang_one(&mut self, probability: f32, family: &str, height: f32, cost: impl Fn(&Floor, &Spot) -> f32) -> Option<Wall> {
        if !self.chance(probability) {
            return None;
        }
        let thing = self.any(family)?;
        self.hang(thing.as_ref(), height, &self.room.walls(), cost)
    }

    /// Hangs one to `max` pictures, each where `cost` is lowest and not beside another on the same wall.
    pub fn art(&mut self, max: usize, cost: impl Fn(&Floor, &Spot) -> f32) {
        let mut walls = self.room.walls();
        for _ in 0..1 + self.rng.below(max.max(1)) {
            let picture = PictureOnWall { palette: *self.palette, ..PictureOnWall::random(&mut self.rng) };
            let picture = self.or_borrowed("picture", picture);
            if let Some(wall) = self.hang(picture.as_ref(), EYE, &walls, &cost) {
                walls.retain(|w| *w != wall);
            }
        }
    }

    /// Lays a rug with this probability where `cost` is lowest, clear of all furniture.
    pub fn rug(&mut self, probability: f32, cost: impl Fn(&Floor, &Spot) -> f32) {
        if !self.chance(probability) {
            return;
        }
        let rug = Rug::random(&mut self.rng);
        let half_width = 0.5 * self.room.size.truncate().min_element();
        for share in [1.0, 0.75, 0.55] {
            let size = (rug.size * share).min(Vec2::splat(2.0 * half_width - 0.5));
            let rug = Rug { size };
            let piece = Piece { flat: true, ..Piece::standing(rug.size(), 0.0).at(0.0, 0.0, 0.0) };
            let spots = self.floor.everywhere(0.12, &[0.0, std::f32::consts::FRAC_PI_2]);
            if let Some((_, poses)) = self.floor.place(&[piece], spots, &cost) {
                return self.build(&rug, poses[0]);
            }
        }
    }

    /// Scatters things on surfaces of something in `pose`; those that find no place are left out.
    pub fn scatter(&mut self, surfaces: &[Surface], pose: DAffine3, things: &[Box<dyn Furniture>]) {
        // Under the open sky of the room is its ceiling.
        let sky = self.room.size.z - CEILING_AIR - pose.translation.z as f32;
        let slope = |s: &Surface| {
            let corners = [s.min, Vec2::new(s.max.x, s.min.y), s.max, Vec2::new(s.min.x, s.max.y)];
            let world = corners.map(|corner| pose.transform_point3(corner.extend(s.z).as_dvec3()).as_vec3());
            world.iter().map(|p| self.room.ceiling_at(p.truncate()) - CEILING_AIR - p.z).fold(f32::INFINITY, f32::min)
        };
        let above = |s: &Surface| if self.room.slopes.is_empty() { sky - s.z } else { slope(s) };
        let surfaces: Vec<Surface> = surfaces.iter().map(|s| Surface { headroom: s.headroom.min(above(s)), ..*s }).collect();
        for (index, pose) in scatter(&surfaces, pose, things, &mut self.rng) {
            self.build(things[index].as_ref(), pose);
        }
    }

    /// Places a thing with its back to the wall where `cost` is lowest.
    pub fn stand(&mut self, thing: &dyn Furniture, cost: impl Fn(&Floor, &Spot) -> f32) -> Option<Standing> {
        let spots = self.floor.along_walls(thing.size().x);
        self.stand_at(thing, spots, cost)
    }

    /// Places a thing with its back at one of `spots`.
    pub fn stand_at(&mut self, thing: &dyn Furniture, spots: Vec<Spot>, cost: impl Fn(&Floor, &Spot) -> f32) -> Option<Standing> {
        let piece = Piece::standing(thing.size(), thing.reach());
        let (spot, poses) = self.floor.place(&[piece], spots, cost)?;
        self.build(thing, poses[0]);
        Some(Standing { pose: poses[0], size: thing.size(), spot })
    }

    /// Places a thing anywhere on the floor, turned by one of `yaws`, where `cost` is lowest.
    pub fn stand_free(&mut self, thing: &dyn Furniture, yaws: &[f32], cost: impl Fn(&Floor, &Spot) -> f32) -> Option<Standing> {
        let piece = Piece::standing(thing.size(), thing.reach()).at(0.0, 0.0, 0.0);
        let (spot, poses) = self.floor.place(&[piece], self.floor.everywhere(0.1, yaws), cost)?;
        self.build(thing, poses[0]);
        Some(Standing { pose: poses[0], size: thing.size(), spot })
    }

    /// Finds a place on a wall for something whose middle is at `height`, where `cost` is lowest. The pose has its origin on the wall.
    pub fn find_on_wall(
        &mut self,
        size: Vec3,
        height: f32,
        walls: &[Wall],
        cost: impl Fn(&Floor, &Spot) -> f32,
    ) -> Option<(Wall, DAffine3)> {
        let z = height - 0.5 * size.z;
        let piece = Piece { z, ..Piece::standing(size, 0.0) };
        let spots = walls.iter().flat_map(|&wall| self.floor.along(wall, size.x + 0.1)).collect();
        let (spot, _) = self.floor.place(&[piece], spots, cost)?;
        let wall = spot.wall?;
        Some((wall, on(self.room.wall_pose(wall), Vec3::new(spot.x, 0.0, height), 0.0)))
    }

    /// Hangs a thing whose origin is the middle of its back.
    pub fn hang(&mut self, thing: &dyn Furniture, height: f32, walls: &[Wall], cost: impl Fn(&Floor, &Spot) -> f32) -> Option<Wall> {
        let (wall, pose) = self.find_on_wall(thing.size(), height, walls, cost)?;
        self.build(thing, pose);
        Some(wall)
    }
}
