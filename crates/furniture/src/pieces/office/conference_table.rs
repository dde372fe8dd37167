//! A table for meetings, 1.8 to 4.4 m long, class table: rectangular, with bulging sides, or oval; on panels, columns or frames, with a lid
//! over sockets in its middle.

use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, cut_out, cylinder, rounded_rectangle};
use crate::pieces::{Furniture, Surface, board, grained};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// A table for meetings; people sit along both sides and at its ends.
#[derive(Clone, Copy, Debug)]
pub struct ConferenceTable {
    /// Length along x.
    pub length: f32,
    /// Width at the middle.
    pub width: f32,
    /// Outline of the top.
    pub outline: TableOutline,
    /// The stand below.
    pub stand: TableStand,
    /// Finish of the top.
    pub finish: Finish,
}

/// Outline of a table's top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableOutline {
    /// A rectangle with round corners.
    Rectangle,
    /// Sides that bulge, so that all see each other.
    Boat,
    /// An oval.
    Oval,
}

/// The stand of a large table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableStand {
    /// Upright panels across.
    Panels,
    /// Columns on round plates.
    Columns,
    /// Frames of steel.
    Frames,
}

/// Height and thickness of the top, metres.
const TOP: f32 = 0.74;
const BOARD: f32 = 0.03;
/// Width of the table's edge that each person has, metres.
const PERSON: f32 = 0.68;
/// Narrowing of the ends of tables with bulging sides, metres.
const BULGE: f32 = 0.22;

impl ConferenceTable {
    /// A table of this length.
    pub fn of_length(length: f32, rng: &mut Rng) -> Self {
        let width = (0.9 + 0.11 * length).clamp(1.05, 1.4);
        let outline = [TableOutline::Rectangle, TableOutline::Rectangle, TableOutline::Boat, TableOutline::Oval][rng.below(4)];
        let stand = [TableStand::Panels, TableStand::Columns, TableStand::Frames][rng.below(3)];
        let finish = [Finish::Wood, Finish::DarkWood, Finish::WhiteLacquer, Finish::Wood][rng.below(4)];
        Self { length, width, outline, stand, finish }
    }

    /// Where people sit: the edge before each, and the way that they look.
    pub fn seats(&self) -> Vec<(Vec2, Vec2)> {
        let straight = match self.outline {
            TableOutline::Rectangle | TableOutline::Boat => self.length - 0.24,
            TableOutline::Oval => 0.72 * self.length,
        };
        let count = (straight / PERSON) as usize;
        let side = |s: f32| {
            (0..count).map(move |k| {
                let x = straight * ((k as f32 + 0.5) / count as f32 - 0.5);
                (Vec2::new(x, s * self.half_width(x)), Vec2::new(0.0, -s))
            })
        };
        let ends = [-1.0f32, 1.0].map(|s| (Vec2::new(s * 0.5 * self.length, 0.0), Vec2::new(-s, 0.0)));
        side(1.0).chain(side(-1.0)).chain(ends).collect()
    }

    fn half_width(&self, x: f32) -> f32 {
        let t = 2.0 * x / self.length;
        match self.outline {
            TableOutline::Rectangle => 0.5 * self.width,
            TableOutline::Boat => 0.5 * self.width - 0.5 * BULGE * t * t,
            TableOutline::Oval => 0.5 * self.width * (1.0 - t.abs().powf(2.6)).max(0.0).powf(1.0 / 2.6),
        }
    }

    fn edge(&self) -> Vec<Vec2> {
        let half = 0.5 * Vec2::new(self.length, self.width);
        match self.outline {
            TableOutline::Rectangle => rounded_rectangle(self.length, self.width, 0.06, 6),
            TableOutline::Boat => {
                let side = |s: f32| {
                    (0..=24).map(move |k| {
                        let x = -s * half.x * (1.0 - k as f32 / 12.0);
                        Vec2::new(x, -s * self.half_width(x))
                    })
                };
                side(-1.0).chain(side(1.0)).collect()
            }
            TableOutline::Oval => (0..72)
                .map(|k| {
                    let (sin, cos) = (TAU * k as f32 / 72.0).sin_cos();
                    let power = |v: f32| v.signum() * v.abs().powf(2.0 / 2.6);
                    Vec2::new(half.x * power(cos), half.y * power(sin))
                })
                .collect(),
        }
    }

    fn stand(&self, b: &mut Builder, table: &Object, rng: &mut Rng) {
        let under = TOP - BOARD - 0.0002;
        let count = if self.length > 3.2 { 3 } else { 2 };
        let reach = 0.5 * self.length - if self.outline == TableOutline::Oval { 0.75 } else { 0.5 };
        let y = self.half_width(reach) - 0.26;
        for k in 0..count {
            let x = reach * (2.0 * k as f32 / (count - 1) as f32 - 1.0);
            let (mesh, finish) = match self.stand {
                TableStand::Panels => (grained(board([x - 0.02, -y, 0.0], [x + 0.02, y, under], 0.002), rng), self.finish),
                TableStand::Columns => {
                    let plate = cylinder(0.3, 0.012, 40);
                    let column = cylinder(0.045, under - 0.0118, 28).moved(Vec3::new(0.0, 0.0, 0.0118));
                    (plate.with(column).moved(Vec3::new(x, 0.0, 0.0)), Finish::Aluminium)
                }
                TableStand::Frames => {
                    let post = |s: f32| board([x - 0.03, s * y - 0.015, 0.0], [x + 0.03, s * y + 0.015, under], 0.002);
                    let bar = |z: f32| board([x - 0.03, 0.0145 - y, z], [x + 0.03, y - 0.0145, z + 0.03], 0.002);
                    (all([post(-1.0), post(1.0), bar(0.0), bar(under - 0.03)]), Finish::BlackMetal)
                }
            };
            b.part(table, &format!("stand_{}", k + 1), mesh, finish);
        }
        if self.stand == TableStand::Panels {
            let rail = board([0.0202 - reach, -0.012, 0.3], [reach - 0.0202, 0.012, under], 0.002);
            if count == 2 {
                b.part(table, "rail", grained(rail, rng), self.finish);
            }
        }
    }
}

impl Furniture for ConferenceTable {
    fn random(rng: &mut Rng) -> Self {
        let length = rng.range(1.8, 4.4);
        Self::of_length(length, rng)
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.length, self.width, TOP + 0.004)
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = Vec2::new(0.5 * self.length - 0.35, self.half_width(0.5 * self.length - 0.35) - 0.05);
        let of =
            |low: f32, high: f32| Surface { min: Vec2::new(low, -half.y), max: Vec2::new(high, half.y), z: TOP, headroom: f32::INFINITY };
        vec![of(-half.x, -0.2), of(0.2, half.x)]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let table = b.object("conference_table", Class::Table, pose);
        let top = cut_out(&self.edge(), BOARD, 0.003).moved(Vec3::new(0.0, 0.0, TOP - BOARD));
        b.part(&table, "top", grained(top, rng), self.finish);
        self.stand(b, &table, rng);
        let lid = rounded_box(Vec3::new(0.3, 0.13, 0.006), 0.002, 2).moved(Vec3::new(0.0, 0.0, TOP + 0.0005));
        b.part(&table, "lid", lid, Finish::Aluminium);
    }
}
