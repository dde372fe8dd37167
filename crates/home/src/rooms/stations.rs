//! Equal groups of things in rows: desks, tables with chairs, shelves; and what public rooms share.

use super::Furnisher;
use super::wishes::by_door;
use crate::place::{Floor, Piece, Spot};
use crate::room::Wall;
use enfilade_furniture::Furniture;
use enfilade_math::{DAffine3, Vec2};

/// A thing and its place in a group.
pub struct Part<'a> {
    /// The thing.
    pub thing: &'a dyn Furniture,
    /// The station's place.
    pub piece: Piece,
}

impl<'a> Part<'a> {
    /// A thing whose middle is at a point of the group.
    pub fn new(thing: &'a dyn Furniture, at: [f32; 2], yaw: f32) -> Self {
        Self { thing, piece: Piece::standing(thing.size(), 0.0).at(at[0], at[1], yaw) }
    }

    /// The thing with this free depth before it.
    #[must_use]
    pub fn reached(self, reach: f32) -> Self {
        Self { piece: Piece { reach, ..self.piece }, ..self }
    }
}

impl Furnisher<'_> {
    /// Places a group at each of these spots where it fits, and builds it; the poses of its parts.
    pub fn each(&mut self, spots: Vec<Spot>, parts: &[Part]) -> Vec<Vec<DAffine3>> {
        spots.into_iter().filter_map(|spot| self.once(vec![spot], parts, |_, _| 0.0)).collect()
    }

    /// Places a group at the cheapest of these spots, and builds it; the poses of its parts.
    pub fn once(&mut self, spots: Vec<Spot>, parts: &[Part], cost: impl Fn(&Floor, &Spot) -> f32) -> Option<Vec<DAffine3>> {
        let group: Vec<Piece> = parts.iter().map(|part| part.piece).collect();
        let (_, poses) = self.floor.place(&group, spots, cost)?;
        for (part, pose) in parts.iter().zip(&poses) {
            self.build(part.thing, *pose);
        }
        Some(poses)
    }

    /// Number of these spots at which a group fits, one after another.
    pub fn fitting(&self, spots: &[Spot], parts: &[Part]) -> usize {
        let group: Vec<Piece> = parts.iter().map(|part| part.piece).collect();
        self.fitting_pieces(spots, &group)
    }

    /// As [`Furnisher::fitting`].
    pub fn fitting_pieces(&self, spots: &[Spot], group: &[Piece]) -> usize {
        let mut floor = self.floor.clone();
        spots.iter().filter(|spot| floor.place(group, vec![**spot], |_, _| 0.0).is_some()).count()
    }

    /// Spots before a wall in rows along it: `count` in each, `pitch` apart along and across, the first row at `out`.
    pub fn rows_before(&self, wall: Wall, counts: [usize; 2], pitch: Vec2, out: f32) -> Vec<Spot> {
        let yaw = self.room.yaw(wall);
        let spot = |column: usize, row: usize| {
            let x = pitch.x * (column as f32 - 0.5 * (counts[0] as f32 - 1.0));
            let origin = self.room.before(wall, x, out + pitch.y * row as f32);
            Spot { origin, yaw, wall: None, x }
        };
        (0..counts[1]).flat_map(|row| (0..counts[0]).map(move |column| (column, row))).map(|(column, row)| spot(column, row)).collect()
    }

    /// Spots all over the room in lines that are turned by `yaw` from most walls; ends of lines keep `margin` from walls.
    pub fn lines(&self, yaw: f32, pitch: Vec2, margin: Vec2) -> Vec<Spot> {
        let turn = Vec2::from_angle(self.room.grain + yaw);
        let size = self.room.size.truncate();
        let across = Vec2::from_angle(yaw);
        let extent = Vec2::new((size * across.abs()).element_sum(), (size * across.perp().abs()).element_sum());
        let counts = ((extent - 2.0 * margin) / pitch).floor().max(Vec2::ZERO) + 1.0;
        let mut spots = Vec::new();
        for row in 0..counts.y as usize {
            for column in 0..counts.x as usize {
                let at = pitch * (Vec2::new(column as f32, row as f32) - 0.5 * (counts - 1.0));
                let origin = self.room.box_center + turn.rotate(at);
                spots.push(Spot { origin, yaw: self.room.grain + yaw, wall: None, x: 0.0 });
            }
        }
        spots
    }

    /// The lines of [`Furnisher::lines`] along which more of a group fit: along one wall or the other.
    pub fn best_lines(&self, parts: &[Part], pitch: Vec2, margin: Vec2) -> Vec<Spot> {
        let both = [0.0, std::f32::consts::FRAC_PI_2].map(|yaw| self.lines(yaw, pitch, margin));
        let counts = [0, 1].map(|k| self.fitting(&both[k], parts));
        let [first, second] = both;
        if counts[0] >= counts[1] { first } else { second }
    }

    /// An extinguisher by the door, a clock, a sign over the way out, now and then.
    pub fn public_things(&mut self) {
        self.hang_one(0.45, "fire_extinguisher", 1.0, by_door);
        self.hang_one(0.5, "wall_clock", 2.15, |_, s| s.x.abs());
        if self.room.size.z > 2.55 && self.chance(0.35) {
            self.sign_over_door();
        }
    }

    /// A sign over the first way out of the room.
    pub fn sign_over_door(&mut self) {
        let Some((wall, middle, top)) = self.room.ways().next().map(|way| (way.wall, way.center_x(), way.z[1])) else { return };
        let Some(sign) = self.any("exit_sign") else { return };
        let near = |s: &Spot| if (s.x - middle).abs() < 0.3 { (s.x - middle).abs() } else { f32::INFINITY };
        self.hang(sign.as_ref(), top + 0.22, &[wall], |_, s| near(s));
    }
}
