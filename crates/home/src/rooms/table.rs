//! A table with chairs around it.

use super::Furnisher;
use crate::place::{Floor, Piece, Spot};
use crate::room::Footprint;
use enfilade_furniture::assets::Borrowed;
use enfilade_furniture::{CeilingLamp, Chair, DiningTable, Furniture, LongTable, Pendant, pose};
use enfilade_math::{Rng, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, TAU};

/// Height of a lamp's rim over a table.
const LAMP: f32 = 1.5;
/// From a table's edge to the middle of the chair before it, and how much that varies.
const SEAT: [f32; 2] = [0.17, 0.08];
/// Free height over chairs under a sloping ceiling: people rise from them.
const RISING: f32 = 1.8;
/// Floor behind a chair for getting up.
const BEHIND: f32 = 0.30;

/// Distance between the edge of a table and the box of a chair where one of them is a model, metres: how much is free below the top is
/// not known.
const APART: f32 = 0.03;
/// The families of chairs, as [`chair`] numbers them.
const CHAIRS: [&str; 4] = ["chair", "spindle_chair", "shell_chair", "upholstered_chair"];

/// Chairs of one family.
fn chair(family: usize, rng: &mut Rng) -> Box<dyn Furniture> {
    use enfilade_furniture::{ShellChair, SpindleChair, UpholsteredChair};
    match family {
        0 => Box::new(Chair::random(rng)),
        1 => Box::new(SpindleChair::random(rng)),
        2 => Box::new(ShellChair::random(rng)),
        _ => Box::new(UpholsteredChair::random(rng)),
    }
}

/// A table, and where people sit: the edge before them and the way that they look.
enum Table {
    Long(LongTable),
    Small(DiningTable),
    /// A model, and its seats.
    Model(Borrowed, Vec<(Vec2, Vec2)>),
}

impl Table {
    fn thing(&self) -> &dyn Furniture {
        match self {
            Self::Long(table) => table,
            Self::Small(table) => table,
            Self::Model(table, _) => table,
        }
    }

    fn seats(&self) -> Vec<(Vec2, Vec2)> {
        match self {
            Self::Long(table) => table.seats(),
            Self::Small(table) => {
                let half = 0.5 * table.width;
                (0..4).map(|k| Vec2::from_angle(TAU * k as f32 / 4.0)).map(|d| (d * half, -d)).collect()
            }
            Self::Model(_, seats) => seats.clone(),
        }
    }
}

impl Furnisher<'_> {
    /// Places a table with chairs where there is room, the largest that fits; `seats` is the minimum and maximum number of people.
    pub fn dine(&mut self, seats: [usize; 2], cost: impl Fn(&Floor, &Spot) -> f32) -> bool {
        // The first family has most styles.
        let family = [0, 0, 0, 1, 2, 3][self.rng.below(6)];
        let mut tables: Vec<Table> = (0..3).map(|_| Table::Small(DiningTable::random(&mut self.rng))).collect();
        if seats[1] > 4 || self.chance(0.4) {
            tables.extend((0..5).map(|_| Table::Long(LongTable::random(&mut self.rng))));
        }
        tables.retain(|table| seats[1] >= 4 && table.seats().len() <= seats[1].max(4));
        let own = chair(family, &mut self.rng);
        let model = self.borrow(CHAIRS[family], own.as_ref(), |_| true);
        let apart = model.is_some();
        let chair: &dyn Furniture = model.as_ref().map_or(own.as_ref(), |model| model);
        let mut models = self.borrowed_tables(seats[1].max(4));
        for tables in [&mut models, &mut tables] {
            tables.sort_by_key(|table| std::cmp::Reverse(table.seats().len()));
        }
        for table in models.into_iter().chain(tables) {
            for taken in [table.seats().len(), table.seats().len() / 2] {
                if taken >= seats[0] && self.table(&table, taken, chair, apart, &cost) {
                    return true;
                }
            }
        }
        false
    }

    /// Models of tables for up to `max` people, where the library has any.
    fn borrowed_tables(&mut self, max: usize) -> Vec<Table> {
        let small = DiningTable::random(&mut self.rng.clone());
        let long = LongTable::random(&mut self.rng.clone());
        let mut tables = Vec::new();
        for _ in 0..3 {
            if let Some(model) = self.borrow("dining_table", &small, |_| true) {
                let half = 0.5 * model.size().truncate();
                let seats = (0..4).map(|k| Vec2::from_angle(TAU * k as f32 / 4.0)).map(|d| (d * half, -d)).collect();
                tables.push(Table::Model(model, seats));
            }
            if let Some(model) = self.borrow("long_table", &long, |_| true) {
                let (length, width) = (model.size().x, model.size().y);
                tables.push(Table::Model(model, LongTable { length, width, ..long }.seats()));
            }
        }
        tables.retain(|table| table.seats().len() <= max);
        tables
    }

    fn table(&mut self, table: &Table, taken: usize, chair: &dyn Furniture, apart: bool, cost: &impl Fn(&Floor, &Spot) -> f32) -> bool {
        let mut seats = table.seats();
        // The seats of one side come last, so they are dropped first: then the table can be closer to a wall.
        seats.sort_by(|a, b| a.1.y.total_cmp(&b.1.y));
        seats.truncate(taken);
        let mut group = vec![Piece::standing(table.thing().size(), 0.0).at(0.0, 0.0, 0.0)];
        for (edge, look) in &seats {
            let drawn = SEAT[1] * self.rng.next_f32();
            let under = !apart && !matches!(table, Table::Model(..));
            let out = drawn + if under { SEAT[0] } else { 0.5 * chair.size().y + APART };
            let at = *edge - *look * out;
            let yaw = look.y.atan2(look.x) - FRAC_PI_2 + self.rng.range(-0.1, 0.1);
            group.push(Piece { headroom: RISING, ..Piece::standing(chair.size(), 0.0).at(at.x, at.y, yaw) });
        }
        // What is behind the chairs is kept free by making room for a deeper one.
        let deep: Vec<Piece> = group
            .iter()
            .enumerate()
            .map(|(i, piece)| {
                let back = if i == 0 { 0.0 } else { BEHIND };
                let at = piece.at - back * 0.5 * Vec2::from_angle(piece.yaw).perp();
                Piece { size: piece.size + Vec3::new(0.0, back, 0.0), at, ..*piece }
            })
            .collect();
        let spots = self.floor.everywhere(0.12, &[0.0, FRAC_PI_2]);
        let Some((spot, poses)) = self.floor.place(&deep, spots, cost) else { return false };
        match table {
            // Without small things no table is laid, but it is in the same place.
            Table::Long(table) if self.clutter == 0.0 => self.build(&LongTable { laid: None, ..*table }, poses[0]),
            _ => self.build(table.thing(), poses[0]),
        }
        for (piece, _) in group.iter().zip(&poses).skip(1) {
            let at = spot.point(piece.at);
            let z = f64::from(enfilade_furniture::CONTACT);
            self.build(chair, pose(f64::from(at.x), f64::from(at.y), z, f64::from(spot.yaw + piece.yaw)));
        }
        let laid = matches!(table, Table::Long(LongTable { laid: Some(_), .. }));
        self.litter(&table.thing().surfaces(), poses[0], if laid { 0.3 } else { 0.7 });
        // Under a slope there is nothing level from which a lamp could hang.
        if self.room.level_places(&[spot.origin]).first().is_none_or(|at| *at != spot.origin) {
            return true;
        }
        let drop = self.room.size.z - LAMP;
        let pendant = Pendant { drop, ..Pendant::random(&mut self.rng) };
        let bar = CeilingLamp::Bar(0.6 * table.thing().size().x, drop);
        let cluster = CeilingLamp::Cluster(3);
        let own: &dyn Furniture = match self.rng.below(5) {
            0 if table.thing().size().x > 1.3 => &bar,
            1 if cluster.size().z < drop + 0.1 => &cluster,
            _ => &pendant,
        };
        let model = self.borrow("pendant", &pendant, |size| size.z < drop + 0.1);
        let lamp: &dyn Furniture = model.as_ref().map_or(own, |model| model);
        let above = pose(f64::from(spot.origin.x), f64::from(spot.origin.y), f64::from(self.room.size.z), f64::from(spot.yaw));
        self.build(lamp, above);
        let around = Footprint { center: spot.origin, half: 0.5 * lamp.size().truncate(), yaw: spot.yaw };
        self.floor.take(around, [LAMP, self.room.size.z]);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rooms::tests::lacks_without_clutter;
    use enfilade_furniture::RoomKind;

    fn guests(f: &mut Furnisher) {
        let center = f.room.center;
        f.dine([4, 10], |_, s| s.origin.distance(center));
    }

    #[test]
    fn without_clutter_no_table_is_laid() {
        let cover = ["place_mat", "plate", "fork", "knife", "spoon", "glass", "napkin", "napkin_ring"];
        lacks_without_clutter(RoomKind::Dining, guests, &cover);
    }
}
