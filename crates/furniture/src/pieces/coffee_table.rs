//! Low tables before a sofa, of class table: a rectangular one of wood with a shelf below its top (95 to 115 × 52 to 60 cm), a round top of
//! stone (78 to 90 cm across) on four legs and a ring of black metal, or in a style of the table in [`super::low_table`].

use super::dining_table::round_top;
use super::low_table::LowTable;
use super::{Furniture, Surface, board, grained, leg, on, standing};
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::shape::{Reshape, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A low table before the sofa.
#[derive(Clone, Copy, Debug)]
pub enum CoffeeTable {
    /// A rectangular wooden one with a shelf below.
    Shelf {
        /// Long side, along x.
        length: f32,
        /// Short side.
        depth: f32,
    },
    /// A round stone top on a bent frame.
    Round {
        /// Diameter of the top.
        diameter: f32,
    },
    /// In one of the other styles.
    Styled(LowTable),
}

/// Height of the top, metres: a little below the seat of a sofa.
const TOP: f32 = 0.40;

impl CoffeeTable {
    /// Height of the surface that things stand on.
    pub const TOP: f32 = TOP;

    fn shelf(b: &mut Builder, table: &crate::builder::Object, half: Vec2, rng: &mut Rng) {
        let wood = Finish::Wood;
        b.part(table, "top", grained(board([-half.x, -half.y, TOP - 0.026], [half.x, half.y, TOP], 0.004), rng), wood);
        let inset = half - 0.05;
        b.part(table, "shelf", grained(board([-inset.x, -inset.y, 0.145], [inset.x, inset.y, 0.161], 0.003), rng), wood);
        for (i, s) in [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].into_iter().enumerate() {
            let mesh = leg(TOP - 0.0255, [0.016, 0.024], s * 0.03);
            let at = on(DAffine3::IDENTITY, (s * (half - 0.065)).extend(0.0), 0.0);
            b.part_at(table, &format!("leg_{}", i + 1), grained(mesh, rng), at, wood);
        }
    }

    fn round(b: &mut Builder, table: &crate::builder::Object, radius: f32) {
        b.part(table, "top", round_top(radius, 0.022).moved(Vec3::new(0.0, 0.0, TOP)), Finish::Stone);
        let metal = Finish::BlackMetal;
        for i in 0..4 {
            let out = Vec2::from_angle(0.4 + i as f32 * std::f32::consts::FRAC_PI_2);
            let p = |r: f32, z: f32| (out * r * radius).extend(z);
            b.part(table, &format!("leg_{}", i + 1), standing(tube(&[p(0.82, 0.0), p(0.70, TOP - 0.0222)], 0.011, 12)), metal);
        }
        let ring: Vec<Vec3> =
            (0..=48).map(|k| (Vec2::from_angle(k as f32 / 48.0 * std::f32::consts::TAU) * 0.76 * radius).extend(0.19)).collect();
        b.part(table, "ring", tube(&ring, 0.008, 10), metal);
    }
}

impl Furniture for CoffeeTable {
    fn random(rng: &mut Rng) -> Self {
        match rng.below(6) {
            0 => Self::Shelf { length: rng.range(0.95, 1.15), depth: rng.range(0.52, 0.6) },
            1 => Self::Round { diameter: rng.range(0.78, 0.9) },
            _ => Self::Styled(LowTable::random(rng)),
        }
    }

    fn size(&self) -> Vec3 {
        match *self {
            Self::Shelf { length, depth } => Vec3::new(length, depth, TOP),
            Self::Round { diameter } => Vec3::new(diameter, diameter, TOP),
            Self::Styled(table) => table.size(),
        }
    }

    fn surfaces(&self) -> Vec<Surface> {
        if let Self::Styled(table) = self { vec![table.surface()] } else { Vec::new() }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let table = b.object("coffee_table", Class::Table, pose);
        match *self {
            Self::Shelf { length, depth } => Self::shelf(b, &table, 0.5 * Vec2::new(length, depth), rng),
            Self::Round { diameter } => Self::round(b, &table, 0.5 * diameter),
            Self::Styled(styled) => styled.build(b, &table, rng),
        }
    }
}
