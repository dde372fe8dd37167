//! A rectangular dining table for four to eight people, 130 to 230 × 82 to 98 cm, of class table, on one of five kinds of stand. Some are
//! cut for a leaf in the middle, and one in three is laid for a meal at its long sides. The long side is along x.

use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, cut_out, rod, rounded_rectangle, turned};
use crate::pieces::tableware::PlaceSetting;
use crate::pieces::{Furniture, Surface, board, grained, leg, on};
use crate::shape::{Reshape, bevelled_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A rectangular dining table.
#[derive(Clone, Copy, Debug)]
pub struct LongTable {
    /// Length along x.
    pub length: f32,
    /// Width along y.
    pub width: f32,
    /// The stand of the table.
    pub stand: Stand,
    /// The top is cut for a leaf in the middle, to be pulled out.
    pub extends: bool,
    /// Finish of the top, and the stand unless it is of metal.
    pub finish: Finish,
    /// The setting of every place along the long sides, if the table is laid.
    pub laid: Option<PlaceSetting>,
}

/// The stand of a long table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stand {
    /// Square legs in the corners and an apron.
    Corners,
    /// Round legs that slant outward.
    Slanted,
    /// Two frames of metal.
    Frames,
    /// Crossed beams at either end, with a beam between them.
    Trestle,
    /// Two turned columns on feet.
    Columns,
}

/// Height of the top's surface, metres: EN 1729 and common practice have 720 to 760 mm.
const TOP: f32 = 0.75;
/// Thickness of the top, metres.
const BOARD: f32 = 0.032;

impl LongTable {
    /// Places along one long side: 60 cm for a person (Neufert).
    pub fn places(&self) -> usize {
        ((self.length - 0.1) / 0.6) as usize
    }

    /// Seats: the edge of the table in front of a person, and the direction in which the person looks.
    pub fn seats(&self) -> Vec<(Vec2, Vec2)> {
        let n = self.places();
        let x = |k: usize| ((k as f32 + 0.5) / n as f32 - 0.5) * (self.length - 0.1);
        let half = 0.5 * self.width;
        let mut seats: Vec<_> = (0..n).flat_map(|k| [(Vec2::new(x(k), half), Vec2::NEG_Y), (Vec2::new(x(k), -half), Vec2::Y)]).collect();
        if self.length > 1.7 {
            let end = 0.5 * self.length;
            seats.extend([(Vec2::new(end, 0.0), Vec2::NEG_X), (Vec2::new(-end, 0.0), Vec2::X)]);
        }
        seats
    }

    fn top(&self, b: &mut Builder, table: &Object, rng: &mut Rng) {
        let slab = |x0: f32, x1: f32| board([x0, -0.5 * self.width, TOP - BOARD], [x1, 0.5 * self.width, TOP], 0.003);
        let half = 0.5 * self.length;
        if self.extends {
            // Half the length of the leaf, and half of the joint at its ends.
            let (leaf, joint) = (0.22, 0.0008);
            for (i, [x0, x1]) in [[-half, -leaf - joint], [-leaf + joint, leaf - joint], [leaf + joint, half]].into_iter().enumerate() {
                b.part(table, &format!("top_{}", i + 1), grained(slab(x0, x1), rng), self.finish);
            }
        } else if self.stand == Stand::Slanted {
            let outline = rounded_rectangle(self.length, self.width, 0.08, 6);
            b.part(table, "top", grained(cut_out(&outline, BOARD, 0.006).moved(Vec3::new(0.0, 0.0, TOP - BOARD)), rng), self.finish);
        } else {
            b.part(table, "top", grained(slab(-half, half), rng), self.finish);
        }
    }

    fn apron(&self, b: &mut Builder, table: &Object, inset: f32, rng: &mut Rng) {
        let (x, y) = (0.5 * self.length - inset, 0.5 * self.width - inset);
        for (i, s) in [-1.0f32, 1.0].into_iter().enumerate() {
            let long = bevelled_box(Vec3::new(2.0 * x, 0.02, 0.085), 0.0015).moved(Vec3::new(0.0, s * y, TOP - BOARD - 0.0432));
            let short = bevelled_box(Vec3::new(0.02, 2.0 * y - 0.022, 0.085), 0.0015).moved(Vec3::new(s * x, 0.0, TOP - BOARD - 0.0434));
            b.part(table, &format!("apron_long_{}", i + 1), grained(long, rng), self.finish);
            b.part(table, &format!("apron_short_{}", i + 1), grained(short, rng), self.finish);
        }
    }

    fn stand(&self, b: &mut Builder, table: &Object, rng: &mut Rng) {
        let under = TOP - BOARD - 0.0002;
        let half = 0.5 * Vec2::new(self.length, self.width);
        let corners = [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)];
        match self.stand {
            Stand::Corners => {
                self.apron(b, table, 0.06, rng);
                for (i, s) in corners.into_iter().enumerate() {
                    // Half the thickness of a leg.
                    let (at, thick) = (s * (half - 0.045), 0.037);
                    let post = board([at.x - thick, at.y - thick, 0.0], [at.x + thick, at.y + thick, under], 0.004);
                    b.part(table, &format!("leg_{}", i + 1), grained(post, rng), self.finish);
                }
            }
            Stand::Slanted => {
                self.apron(b, table, 0.16, rng);
                for (i, s) in corners.into_iter().enumerate() {
                    let at = (s * (half - 0.15)).extend(0.0);
                    let mesh = leg(under, [0.017, 0.031], s * Vec2::new(0.07, 0.06));
                    b.part(table, &format!("leg_{}", i + 1), grained(mesh.moved(at), rng), self.finish);
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
                    b.part(table, &format!("frame_{}", i + 1), frame, Finish::BlackMetal);
                }
            }
            Stand::Trestle => {
                for (i, s) in [-1.0f32, 1.0].into_iter().enumerate() {
                    let x = s * (half.x - 0.3);
                    let beam = |y: f32, z: f32, w: f32| bevelled_box(Vec3::new(0.08, 2.0 * w, 0.06), 0.004).moved(Vec3::new(x, y, z));
                    let post = board([x - 0.045, -0.06, 0.0598], [x + 0.045, 0.06, under - 0.0598], 0.004);
                    let mesh = all([beam(0.0, 0.03, half.y - 0.1), beam(0.0, under - 0.03, half.y - 0.06), post]);
                    b.part(table, &format!("trestle_{}", i + 1), grained(mesh, rng), self.finish);
                }
                let rail = board([-half.x + 0.33, -0.02, 0.24], [half.x - 0.33, 0.02, 0.33], 0.003);
                b.part(table, "rail", grained(rail, rng), self.finish);
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
                    b.part(table, &format!("column_{}", i + 1), grained(column.moved(Vec3::new(x, 0.0, 0.0)), rng), self.finish);
                    let foot = |side: f32| {
                        let curve = [[x, side * 0.03, 0.11], [x, side * 0.16, 0.1], [x, side * (half.y - 0.13), 0.015]];
                        crate::pieces::standing(crate::pieces::form::wire(&curve, 0.022, 12))
                    };
                    b.part(table, &format!("feet_{}", i + 1), foot(-1.0).with(foot(1.0)), self.finish);
                }
                let rail = rod([-half.x + inset, 0.0, 0.2], [half.x - inset, 0.0, 0.2], 0.018, 14);
                b.part(table, "rail", grained(rail, rng), self.finish);
            }
        }
    }
}

impl Furniture for LongTable {
    fn random(rng: &mut Rng) -> Self {
        let stands = [Stand::Corners, Stand::Slanted, Stand::Frames, Stand::Trestle, Stand::Columns];
        let stand = stands[rng.below(5)];
        let laid = (rng.below(3) == 0).then(|| PlaceSetting::random(rng));
        Self {
            length: rng.range(1.3, 2.3),
            width: rng.range(0.82, 0.98),
            stand,
            extends: stand == Stand::Corners && rng.below(2) == 0,
            finish: [Finish::Wood, Finish::Wood, Finish::DarkWood, Finish::WhiteLacquer][rng.below(4)],
            laid,
        }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.length, self.width, TOP + self.laid.map_or(0.0, |laid| laid.size().z))
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = 0.5 * Vec2::new(self.length, self.width) - 0.05;
        // On a laid table only the middle between the glasses is free, and mats push the glasses further in.
        let taken = self.laid.map_or(0.0, |laid| if laid.mat { 0.395 } else { 0.37 });
        let half = Vec2::new(half.x, half.y - taken);
        if half.y < 0.05 {
            return Vec::new();
        }
        vec![Surface { min: -half, max: half, z: TOP, headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let table = b.object("long_table", Class::Table, pose);
        self.top(b, &table, rng);
        self.stand(b, &table, rng);
        let Some(setting) = self.laid else { return };
        // Plates of all places are of one set.
        let set = rng.fork(1);
        for (edge, look) in self.seats().into_iter().filter(|(_, look)| look.x == 0.0) {
            let at = edge + look * 0.2;
            let yaw = if look.y < 0.0 { 0.0 } else { std::f32::consts::PI };
            setting.build(b, on(pose, at.extend(TOP), yaw), &mut set.clone());
        }
    }
}
