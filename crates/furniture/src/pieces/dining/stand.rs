//! The stands of long tables, and the styles of these: which outline goes with which stand, and in which finishes.

use super::long_kind::{BOARD, LongTable, Outline, Stand, TOP};
use crate::builder::{Builder, Object};
use crate::materials::Finish;
use crate::materials::Finish::{BlackMetal, Chrome, DarkWood, DrinkingGlass, MarbleTop, WhiteLacquer, WhitePaint, WhitePlastic, Wood};
use crate::pieces::dining_table::hairpin;
use crate::pieces::form::{all, corners, rod, turned, wire};
use crate::pieces::{board, grained, leg, standing};
use crate::shape::{Reshape, bevelled_box};
use enfilade_geometry::Mesh;
use enfilade_math::{Rng, Vec2, Vec3};

/// An outline, a stand, and the finishes of top and stand, drawn together.
pub type Style = (Outline, Stand, &'static [[Finish; 2]]);

const WOODS: &[[Finish; 2]] = &[[Wood, Wood], [Wood, Wood], [DarkWood, DarkWood], [WhiteLacquer, WhiteLacquer]];
const FARM: &[[Finish; 2]] = &[[Wood, Wood], [Wood, WhitePaint], [DarkWood, DarkWood]];
const METAL: &[[Finish; 2]] = &[[Wood, BlackMetal], [DarkWood, BlackMetal], [WhiteLacquer, BlackMetal], [Wood, WhitePaint]];
const SMOOTH: &[[Finish; 2]] = &[[DrinkingGlass, Chrome], [WhiteLacquer, Chrome], [MarbleTop, BlackMetal], [DrinkingGlass, BlackMetal]];
const FOLDING: &[[Finish; 2]] = &[[WhitePlastic, BlackMetal], [Wood, Wood]];

/// The styles and their weights.
pub const STYLES: &[(u32, Style)] = &[
    (3, (Outline::Rectangle, Stand::Corners, WOODS)),
    (2, (Outline::Rounded, Stand::Slanted, WOODS)),
    (2, (Outline::Rectangle, Stand::Frames, METAL)),
    (2, (Outline::Rectangle, Stand::Trestle, WOODS)),
    (2, (Outline::Rectangle, Stand::Columns, WOODS)),
    (2, (Outline::Planks, Stand::Turned, FARM)),
    (1, (Outline::Planks, Stand::Trestle, FARM)),
    (2, (Outline::Rectangle, Stand::Crosses, METAL)),
    (1, (Outline::Planks, Stand::Crosses, METAL)),
    (1, (Outline::Rounded, Stand::Hairpins, METAL)),
    (1, (Outline::Rectangle, Stand::Panels, WOODS)),
    (2, (Outline::Oval, Stand::Column, WOODS)),
    (1, (Outline::Oval, Stand::Slanted, WOODS)),
    (2, (Outline::Rounded, Stand::Frames, SMOOTH)),
    (1, (Outline::Oval, Stand::Crosses, SMOOTH)),
    (1, (Outline::Rectangle, Stand::Folding, FOLDING)),
];

impl LongTable {
    fn apron(&self, b: &mut Builder, table: &Object, inset: f32, rng: &mut Rng) {
        let (x, y) = (0.5 * self.length - inset, 0.5 * self.width - inset);
        for (i, s) in [-1.0f32, 1.0].into_iter().enumerate() {
            let long = bevelled_box(Vec3::new(2.0 * x, 0.02, 0.085), 0.0015).moved(Vec3::new(0.0, s * y, TOP - BOARD - 0.0432));
            let short = bevelled_box(Vec3::new(0.02, 2.0 * y - 0.022, 0.085), 0.0015).moved(Vec3::new(s * x, 0.0, TOP - BOARD - 0.0434));
            b.part(table, &format!("apron_long_{}", i + 1), grained(long, rng), self.below);
            b.part(table, &format!("apron_short_{}", i + 1), grained(short, rng), self.below);
        }
    }

    /// Adds the stand.
    pub(super) fn stand(&self, b: &mut Builder, table: &Object, rng: &mut Rng) {
        let under = TOP - BOARD - 0.0002;
        let half = 0.5 * Vec2::new(self.length, self.width);
        let corners = corners(Vec2::ONE);
        match self.stand {
            Stand::Corners => {
                self.apron(b, table, 0.06, rng);
                for (i, s) in corners.into_iter().enumerate() {
                    // Half the thickness of a leg.
                    let (at, thick) = (s * (half - 0.045), 0.037);
                    let post = board([at.x - thick, at.y - thick, 0.0], [at.x + thick, at.y + thick, under], 0.004);
                    b.part(table, &format!("leg_{}", i + 1), grained(post, rng), self.below);
                }
            }
            Stand::Slanted => {
                self.apron(b, table, 0.16, rng);
                for (i, s) in corners.into_iter().enumerate() {
                    let at = (s * (half - 0.15)).extend(0.0);
                    let mesh = leg(under, [0.017, 0.031], s * Vec2::new(0.07, 0.06));
                    b.part(table, &format!("leg_{}", i + 1), grained(mesh.moved(at), rng), self.below);
                }
            }
            Stand::Frames => {
                for (i, s) in [-1.0f32, 1.0].into_iter().enumerate() {
                    let (x, y) = (s * (half.x - 0.22), half.y - 0.09);
                    let bar = |from: Vec3, to: Vec3| {
                        bevelled_box((to - from).abs() + Vec3::new(0.08, 0.03, 0.03), 0.002).moved(0.5 * (from + to))
                    };
                    let z = [0.015, under - 0.015];
                    let [p, q] = [Vec3::new(x, -y, 0.0), Vec3::new(x, y, 0.0)];
                    let up = |z: f32| Vec3::new(0.0, 0.0, z);
                    // Posts reach half a millimetre into the bars below and above them.
                    let end = 0.0295;
                    let frame = all([
                        bar(p + up(z[0]), q + up(z[0])),
                        bar(p + up(z[1]), q + up(z[1])),
                        bar(p + up(z[0] + end), p + up(z[1] - end)),
                        bar(q + up(z[0] + end), q + up(z[1] - end)),
                    ]);
                    b.part(table, &format!("frame_{}", i + 1), frame, self.below);
                }
            }
            Stand::Trestle => {
                for (i, s) in [-1.0f32, 1.0].into_iter().enumerate() {
                    let x = s * (half.x - 0.3);
                    let beam = |y: f32, z: f32, w: f32| bevelled_box(Vec3::new(0.08, 2.0 * w, 0.06), 0.004).moved(Vec3::new(x, y, z));
                    let post = board([x - 0.045, -0.06, 0.0598], [x + 0.045, 0.06, under - 0.0598], 0.004);
                    let mesh = all([beam(0.0, 0.03, half.y - 0.1), beam(0.0, under - 0.03, half.y - 0.06), post]);
                    b.part(table, &format!("trestle_{}", i + 1), grained(mesh, rng), self.below);
                }
                let rail = board([-half.x + 0.33, -0.02, 0.24], [half.x - 0.33, 0.02, 0.33], 0.003);
                b.part(table, "rail", grained(rail, rng), self.below);
            }
            Stand::Columns => {
                let inset = 0.42;
                for (i, s) in [-1.0f32, 1.0].into_iter().enumerate() {
                    let x = s * (half.x - inset);
                    let column = turned(
                        &[
                            [0.0, 0.06],
                            [0.05, 0.06],
                            [0.055, 0.09],
                            [0.038, 0.14],
                            [0.034, 0.3],
                            [0.052, 0.42],
                            [0.058, 0.5],
                            [0.04, 0.58],
                            [0.05, 0.64],
                            [0.05, under - 0.03],
                            [0.12, under - 0.02],
                            [0.12, under],
                            [0.0, under],
                        ],
                        32,
                    );
                    b.part(table, &format!("column_{}", i + 1), grained(column.moved(Vec3::new(x, 0.0, 0.0)), rng), self.below);
                    let foot = |side: f32| {
                        let curve = [[x, side * 0.03, 0.11], [x, side * 0.16, 0.1], [x, side * (half.y - 0.13), 0.015]];
                        standing(wire(&curve, 0.022, 12))
                    };
                    b.part(table, &format!("feet_{}", i + 1), foot(-1.0).with(foot(1.0)), self.below);
                }
                let rail = rod([-half.x + inset, 0.0, 0.2], [half.x - inset, 0.0, 0.2], 0.018, 14);
                b.part(table, "rail", grained(rail, rng), self.below);
            }
            Stand::Turned => {
                self.apron(b, table, 0.07, rng);
                for (i, s) in corners.into_iter().enumerate() {
                    let at = s * (half - 0.075);
                    b.part(table, &format!("leg_{}", i + 1), grained(turned_leg(under).moved(at.extend(0.0)), rng), self.below);
                }
            }
            Stand::Crosses | Stand::Panels | Stand::Folding => {
                for (i, s) in [-1.0f32, 1.0].into_iter().enumerate() {
                    let x = s * (half.x - if self.outline == Outline::Oval { 0.42 } else { 0.28 });
                    let mesh = match self.stand {
                        Stand::Crosses => cross(half.y - 0.12, under),
                        Stand::Panels => board([-0.022, 0.1 - half.y, 0.0], [0.022, half.y - 0.1, under], 0.003),
                        _ => folding(half.y - 0.1, under),
                    };
                    b.part(table, &format!("stand_{}", i + 1), grained(mesh.moved(Vec3::X * x), rng), self.below);
                }
                if self.stand == Stand::Panels {
                    let x = half.x - 0.25;
                    b.part(table, "rail", grained(board([-x, -0.015, under - 0.2], [x, 0.015, under - 0.05], 0.002), rng), self.below);
                }
            }
            Stand::Hairpins => {
                let pins = corners.map(|s| hairpin(s * (half - 0.12), s, under));
                b.part(table, "legs", all(pins), self.below);
            }
            Stand::Column => {
                let profile = [
                    [0.0, 0.06],
                    [0.1, 0.06],
                    [0.11, 0.09],
                    [0.075, 0.16],
                    [0.07, 0.3],
                    [0.1, 0.44],
                    [0.105, 0.52],
                    [0.075, 0.62],
                    [0.09, under - 0.045],
                    [0.2, under - 0.03],
                    [0.2, under],
                    [0.0, under],
                ];
                b.part(table, "column", grained(turned(&profile, 40), rng), self.below);
                let arm = |x: f32, y: f32, e: f32| board([-x, -y, e], [x, y, 0.07 - e], 0.006);
                let (long, wide) = (0.3 * self.length, half.y - 0.14);
                b.part(table, "foot", grained(arm(long, 0.05, 0.0).with(arm(0.0495, wide, 0.0004)), rng), self.below);
                let beam = board([-0.34 * self.length, -0.04, under - 0.029], [0.34 * self.length, 0.04, under - 0.0004], 0.002);
                b.part(table, "beam", grained(beam, rng), self.below);
            }
        }
    }
}

/// A thick turned leg with a square head.
fn turned_leg(under: f32) -> Mesh {
    let profile = [
        [0.0, 0.0],
        [0.026, 0.0],
        [0.034, 0.03],
        [0.024, 0.07],
        [0.034, 0.14],
        [0.047, 0.32],
        [0.044, 0.44],
        [0.03, 0.52],
        [0.042, 0.55],
        [0.03, under - 0.142],
        [0.0, under - 0.142],
    ];
    turned(&profile, 28).with(board([-0.042, -0.042, under - 0.145], [0.042, 0.042, under], 0.003))
}

/// Two crossed bars in the plane x = 0 between a bar on the floor and one below the top.
fn cross(half: f32, under: f32) -> Mesh {
    let bar = |z: f32, e: f32| board([-0.03, -half, z], [0.03, half, z + 0.012 - e], 0.002);
    let long = half - 0.03;
    let slanted = |s: f32, x: f32| {
        let height = under - 0.02;
        let mesh = bevelled_box(Vec3::new(0.05, 0.06, height), 0.002);
        mesh.deformed(|p| p + Vec3::new(x, s * 2.0 * long * p.z / height, 0.5 * under)).smoothed(20.0)
    };
    all([bar(0.0, 0.0), bar(under - 0.012, 0.0), slanted(1.0, 0.001), slanted(-1.0, -0.001)])
}

/// A trestle that folds: two frames in planes that lean against each other below a beam.
fn folding(half: f32, under: f32) -> Mesh {
    let beam = board([-0.03, -half, under - 0.045], [0.03, half, under], 0.003);
    let side = |s: f32| {
        let at = |y: f32, z: f32| [s * (0.2 - 0.18 * z / under), y, z];
        let legs = [-1.0f32, 1.0].map(|e| standing(rod(at(e * (half - 0.04), 0.0), at(e * (half - 0.08), under - 0.02), 0.014, 12)));
        let rung = rod(at(0.05 - half, 0.18), at(half - 0.05, 0.18), 0.01, 10);
        all(legs).with(rung)
    };
    all([beam, side(-1.0), side(1.0)])
}
