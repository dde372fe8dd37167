//! Small dining tables, 82 to 105 cm across, of class table: round or square, on four legs, a turned column, a trumpet-shaped foot, crossed
//! feet of metal, bent wire, or of plastic for the garden. A row of [`STYLES`] is a style with its weight. [`round_top`] also makes the tops
//! of other tables.

use super::form::{all, corners, cylinder, rod, turned, wire};
use super::style::drawn;
use super::{Furniture, board, grained, leg, on, standing};
use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::shape::{Reshape, lathe};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rng, Vec2, Vec3};
use std::f32::consts::FRAC_1_SQRT_2;

/// What a small table stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SmallStand {
    /// Four splayed legs and the rails between them.
    Legs,
    /// A turned column on four bent feet.
    Column,
    /// A foot and a column of one trumpet-shaped piece.
    Trumpet,
    /// Two crossed bars on the floor and a column of metal.
    Cross,
    /// Four legs of bent wire.
    Hairpins,
    /// Four hollow legs of plastic, and a rim below the top.
    Plastic,
}

/// A stand, whether the top may be round and square, and the finishes of the top and of the stand, drawn together.
type Row = (SmallStand, [bool; 2], &'static [[Finish; 2]]);

const WOODS: &[[Finish; 2]] = &[[Finish::Wood, Finish::Wood], [Finish::Wood, Finish::Wood], [Finish::DarkWood, Finish::DarkWood]];
const PAINTED: &[[Finish; 2]] = &[[Finish::Wood, Finish::WhitePaint], [Finish::DarkWood, Finish::DarkWood], [Finish::Wood, Finish::Wood]];
const SMOOTH: &[[Finish; 2]] = &[
    [Finish::WhiteLacquer, Finish::CoatedWhite],
    [Finish::MarbleTop, Finish::CoatedWhite],
    [Finish::DrinkingGlass, Finish::Chrome],
    [Finish::Wood, Finish::BlackMetal],
];
const METAL: &[[Finish; 2]] =
    &[[Finish::Wood, Finish::BlackMetal], [Finish::WhiteLacquer, Finish::Chrome], [Finish::DarkWood, Finish::BlackMetal]];
const GARDEN: &[[Finish; 2]] = &[[Finish::WhitePlastic, Finish::WhitePlastic], [Finish::Plastic(1), Finish::Plastic(1)]];

/// The styles and their weights.
const STYLES: &[(u32, Row)] = &[
    (4, (SmallStand::Legs, [true, true], WOODS)),
    (2, (SmallStand::Column, [true, false], PAINTED)),
    (2, (SmallStand::Trumpet, [true, false], SMOOTH)),
    (2, (SmallStand::Cross, [true, true], METAL)),
    (2, (SmallStand::Hairpins, [true, true], METAL)),
    (1, (SmallStand::Plastic, [true, true], GARDEN)),
];

/// A small dining table, round or square.
#[derive(Clone, Copy, Debug)]
pub struct DiningTable {
    /// Diameter, or edge length.
    pub width: f32,
    /// Round instead of square.
    pub round: bool,
    /// What it stands on.
    pub stand: SmallStand,
    /// Finishes of top and stand.
    pub finish: [Finish; 2],
}

/// Height of the top's surface, metres: dining tables are 72 to 76 cm high.
pub const TOP: f32 = 0.74;
/// Thickness of the top, metres.
const BOARD: f32 = 0.028;

impl DiningTable {
    /// Height of the surface that things stand on.
    pub const TOP: f32 = TOP;

    fn of((stand, [round, square], finishes): Row, rng: &mut Rng) -> Self {
        let round = round && (!square || rng.below(3) > 0);
        let wide = if stand == SmallStand::Legs { [0.82, 0.95] } else { [0.82, 1.05] };
        Self { width: rng.range(wide[0], wide[1]), round, stand, finish: finishes[rng.below(finishes.len())] }
    }

    fn legs(&self, b: &mut Builder, table: &Object, rng: &mut Rng) {
        let (half, wood) = (0.5 * self.width, self.finish[1]);
        let stand = if self.round { 0.56 * half } else { half - 0.06 };
        for (i, s) in corners(Vec2::ONE).into_iter().enumerate() {
            let mesh = leg(TOP - 0.0275, [0.015, 0.026], s * 0.044);
            let at = on(DAffine3::IDENTITY, (s * stand).extend(0.0), 0.0);
            b.part_at(table, &format!("leg_{}", i + 1), grained(mesh, rng), at, wood);
        }
        let apron = stand - 0.012;
        for i in 0..4 {
            // Two run into the legs, the others end at them.
            let end = if i % 2 == 0 { apron } else { apron - 0.0092 };
            let rail = board([-end, -0.009, -0.085], [end, 0.009, -0.0275], 0.002);
            let at = DAffine3::from_rotation_z(f64::from(i) * std::f64::consts::FRAC_PI_2)
                * DAffine3::from_translation(DVec3::new(0.0, f64::from(apron), f64::from(TOP)));
            b.part_at(table, &format!("rail_{}", i + 1), grained(rail, rng), at, wood);
        }
    }

    /// Everything below the top but splayed legs: the parts' names and meshes.
    fn base(&self) -> Vec<(&'static str, Mesh)> {
        let (half, under) = (0.5 * self.width, TOP - BOARD - 0.0002);
        // Feet end 12 cm within the edge, behind the feet of those who sit.
        let reach = half - 0.12;
        match self.stand {
            SmallStand::Legs => Vec::new(),
            SmallStand::Column => {
                let column = [
                    [0.0, 0.1],
                    [0.045, 0.1],
                    [0.055, 0.14],
                    [0.036, 0.22],
                    [0.033, 0.36],
                    [0.055, 0.46],
                    [0.06, 0.53],
                    [0.038, 0.6],
                    [0.045, under - 0.03],
                    [0.16, under - 0.018],
                    [0.16, under],
                    [0.0, under],
                ];
                let feet = corners(Vec2::ONE).map(|d| {
                    let at = |r: f32, z: f32| [d.x * r * FRAC_1_SQRT_2, d.y * r * FRAC_1_SQRT_2, z];
                    standing(wire(&[at(0.02, 0.16), at(0.14, 0.15), at(0.7 * reach, 0.06), at(reach, 0.02)], 0.024, 12))
                });
                vec![("column", turned(&column, 36)), ("feet", all(feet))]
            }
            SmallStand::Trumpet => {
                let r = 0.62 * reach + 0.02;
                let curve = crate::shape::spline(
                    &[
                        [r, 0.008],
                        [0.5 * r, 0.03],
                        [0.16 * r + 0.01, 0.12],
                        [0.038, 0.3],
                        [0.036, 0.5],
                        [0.06, under - 0.03],
                        [0.13, under - 0.006],
                    ],
                    6,
                );
                let mut profile = vec![Vec2::ZERO, Vec2::new(r - 0.004, 0.0)];
                profile.extend(curve.into_iter().map(|p| Vec2::new(p.x.max(0.02), p.y.clamp(0.004, under - 0.004))));
                profile.extend([Vec2::new(0.13, under), Vec2::new(0.0, under)]);
                vec![("foot", lathe(&profile, 56))]
            }
            SmallStand::Cross => {
                let bar = |x: f32, y: f32, z: [f32; 2]| board([-x, -y, z[0]], [x, y, z[1]], 0.003);
                let turn = std::f32::consts::FRAC_PI_4;
                let low = bar(reach, 0.03, [0.0, 0.028]).with(bar(0.0295, reach, [0.0004, 0.0276]));
                let high = bar(0.7 * reach, 0.02, [under - 0.02, under]).with(bar(0.0195, 0.7 * reach, [under - 0.0196, under - 0.0002]));
                let column = cylinder(0.038, under - 0.044, 28).moved(Vec3::Z * 0.026);
                vec![("stand", all([low, high]).turned(Vec3::Z, turn).with(column))]
            }
            SmallStand::Hairpins => {
                let at = if self.round { 0.62 * half } else { half - 0.1 };
                let pins = corners(Vec2::ONE).map(|s| hairpin(s * at, s, under));
                vec![("legs", all(pins))]
            }
            SmallStand::Plastic => {
                let at = if self.round { 0.6 * half } else { half - 0.06 };
                let legs = corners(Vec2::splat(at)).map(|p| {
                    let [wide, narrow] = [0.034, 0.024];
                    let mesh = board([-wide, -wide, 0.0], [wide, wide, under], 0.01);
                    mesh.deformed(|q| (q.truncate() * (narrow + (wide - narrow) * q.z / under) / wide + p).extend(q.z)).smoothed(30.0)
                });
                let side = at + 0.02;
                let rim = [0.0f32, 1.0, 2.0, 3.0].map(|k| {
                    let rail = board([-side + 0.004 * (k % 2.0), -0.006, under - 0.045], [side - 0.004 * (k % 2.0), 0.006, under], 0.002);
                    rail.moved(Vec3::Y * at).turned(Vec3::Z, k * std::f32::consts::FRAC_PI_2)
                });
                vec![("legs", all(legs)), ("rim", all(rim))]
            }
        }
    }
}

/// A leg of bent wire below a top: two rods that meet on the floor, screwed to the top's underside at height `under`. It leans
/// outward along `s`.
pub fn hairpin(at: Vec2, s: Vec2, under: f32) -> Mesh {
    let (r, out) = (0.006, s.normalize_or(Vec2::X));
    let side = out.perp();
    let p = |along: f32, across: f32, z: f32| (at + out * along + side * across).extend(z).to_array();
    let rods = [-1.0f32, 1.0].map(|e| rod(p(-0.05, 0.055 * e, under - 0.002), p(0.03, 0.009 * e, 0.5 * r), r, 10));
    let plate = rod(p(-0.05, 0.07, under - 0.003), p(-0.05, -0.07, under - 0.003), 0.0029, 8);
    let foot = rod(p(0.03, -0.015, r), p(0.03, 0.015, r), r, 10);
    standing(all(rods)).with(plate).with(foot)
}

impl Furniture for DiningTable {
    fn random(rng: &mut Rng) -> Self {
        Self::of(drawn(STYLES, rng), rng)
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, self.width, TOP)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let table = b.object("dining_table", Class::Table, pose);
        let half = 0.5 * self.width;
        let top = if self.round { round_top(half, BOARD) } else { board([-half, -half, -BOARD], [half, half, 0.0], 0.004) };
        b.part(&table, "top", grained(top.moved(Vec3::new(0.0, 0.0, TOP)), rng), self.finish[0]);
        if self.stand == SmallStand::Legs {
            return self.legs(b, &table, rng);
        }
        for (name, mesh) in self.base() {
            b.part(&table, name, grained(mesh, rng), self.finish[1]);
        }
    }
}

/// A round board with a chamfered edge, its surface at z = 0; the grain runs along x.
pub fn round_top(radius: f32, thickness: f32) -> enfilade_geometry::Mesh {
    let profile =
        [[0.0, -thickness], [radius - 0.02, -thickness], [radius - 0.002, -0.009], [radius, -0.006], [radius - 0.004, 0.0], [0.0, 0.0]];
    let mut mesh = lathe(&profile.map(Vec2::from_array), 72);
    for (uv, p) in mesh.uvs.iter_mut().zip(&mesh.positions) {
        *uv = Vec2::new(p.x, p.y + p.z);
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::{Place, style_tests::check};

    #[test]
    fn every_style_stands_and_is_of_one_piece() {
        let mut rng = Rng::new(1);
        let mut things: Vec<(String, Box<dyn Furniture>)> = Vec::new();
        for &(_, style) in STYLES {
            things.extend((0..3).map(|k| (format!("{:?} {k}", style.0), Box::new(DiningTable::of(style, &mut rng)) as Box<dyn Furniture>)));
        }
        check(Place::Free, &things);
    }
}
