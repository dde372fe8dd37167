//! Styles of low tables before a sofa, 36 to 46 cm high. A row of [`STYLES`] is a style with its weight.

use super::dining_table::{hairpin, round_top};
use super::form::{all, corners, cut_out, rod};
use super::joinery::hollow_box;
use super::style::drawn;
use super::{Surface, board, grained, leg, standing};
use crate::builder::{Builder, Object};
use crate::materials::Finish;
use crate::shape::{Reshape, padded_box, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{Rng, Vec2, Vec3};

/// The build of a low table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Low {
    /// A pane on a frame of metal tube with a shelf of glass.
    GlassFrame,
    /// A pane on two crossed pairs of wooden boards.
    GlassCross,
    /// A solid drum.
    Drum,
    /// A block with an open compartment from side to side.
    Block,
    /// A thick board on bent wire.
    Hairpins,
    /// An oval on four slanted legs, as of the fifties.
    Oval,
    /// Two round tables of different heights, one partly below the other.
    Nest,
    /// A chest with bands of metal.
    Trunk,
    /// A padded top with buttons of cloth: a footstool that serves as a table.
    Padded,
    /// Two boards upright and one level: a bent plate.
    Bridge,
}

/// A build, its smallest and largest length, its depth as a share of that, its height, and the finishes of top and stand, drawn together.
type Row = (Low, [f32; 2], f32, f32, &'static [[Finish; 2]]);

const GLASS: &[[Finish; 2]] =
    &[[Finish::DrinkingGlass, Finish::Chrome], [Finish::DrinkingGlass, Finish::BlackMetal], [Finish::GlossBlack, Finish::Chrome]];
const WOOD: &[[Finish; 2]] =
    &[[Finish::Wood, Finish::Wood], [Finish::DarkWood, Finish::DarkWood], [Finish::WhiteLacquer, Finish::WhiteLacquer]];
const STONE: &[[Finish; 2]] = &[
    [Finish::Stone, Finish::Stone],
    [Finish::DarkWood, Finish::DarkWood],
    [Finish::Wood, Finish::Wood],
    [Finish::WhiteLacquer, Finish::WhiteLacquer],
];
const METAL: &[[Finish; 2]] =
    &[[Finish::Wood, Finish::BlackMetal], [Finish::DarkWood, Finish::BlackMetal], [Finish::MarbleTop, Finish::Brass]];
const CLOTH: &[[Finish; 2]] =
    &[[Finish::Leather, Finish::DarkWood], [Finish::SofaCloth, Finish::Wood], [Finish::Velvet, Finish::BlackMetal]];

/// The styles and their weights.
const STYLES: &[(u32, Row)] = &[
    (2, (Low::GlassFrame, [0.9, 1.2], 0.58, 0.42, GLASS)),
    (1, (Low::GlassCross, [0.9, 1.15], 0.6, 0.41, &[[Finish::DrinkingGlass, Finish::Wood], [Finish::DrinkingGlass, Finish::DarkWood]])),
    (1, (Low::Drum, [0.6, 0.8], 1.0, 0.37, STONE)),
    (2, (Low::Block, [0.8, 1.2], 0.62, 0.38, WOOD)),
    (2, (Low::Hairpins, [0.9, 1.2], 0.52, 0.42, METAL)),
    (2, (Low::Oval, [1.0, 1.25], 0.5, 0.44, WOOD)),
    (2, (Low::Nest, [0.85, 1.0], 0.68, 0.44, METAL)),
    (1, (Low::Trunk, [0.85, 1.05], 0.55, 0.43, WOOD)),
    (1, (Low::Padded, [0.8, 1.1], 0.65, 0.41, CLOTH)),
    (1, (Low::Bridge, [0.9, 1.2], 0.55, 0.4, WOOD)),
];

/// A low table.
#[derive(Clone, Copy, Debug)]
pub struct LowTable {
    /// The build.
    pub low: Low,
    /// Half the length and half the depth.
    pub half: Vec2,
    /// Height of the top's surface.
    pub top: f32,
    /// Finishes of top and stand.
    pub finish: [Finish; 2],
}

impl LowTable {
    fn of((low, [short, long], share, top, finishes): Row, rng: &mut Rng) -> Self {
        let length = rng.range(short, long);
        let finish = finishes[rng.below(finishes.len())];
        Self { low, half: 0.5 * Vec2::new(length, length * share), top, finish }
    }

    /// A random one.
    pub fn random(rng: &mut Rng) -> Self {
        Self::of(drawn(STYLES, rng), rng)
    }

    /// Size of the box around it.
    pub fn size(&self) -> Vec3 {
        let swell = if self.low == Low::Padded { 0.012 } else { 0.0 };
        (2.0 * self.half + swell).extend(self.top)
    }

    /// Where small things may stand.
    pub fn surface(&self) -> Surface {
        let (min, max) = match self.low {
            Low::Drum | Low::Oval => (-0.66 * self.half, 0.66 * self.half),
            // The higher one of the two is at the left.
            Low::Nest => {
                let [at, r] = self.nest()[0];
                (Vec2::new(at - 0.66 * r, -0.66 * r), Vec2::new(at + 0.66 * r, 0.66 * r))
            }
            Low::Padded => (-0.55 * self.half, 0.55 * self.half),
            _ => (0.05 - self.half, self.half - 0.05),
        };
        let z = if self.low == Low::Padded { self.top - 0.002 } else { self.top };
        Surface { min, max, z, headroom: f32::INFINITY }
    }

    /// Middle (x) and radius of the two tables of a nest, the higher one first.
    fn nest(&self) -> [[f32; 2]; 2] {
        let (a, c) = (0.96 * self.half.y, 0.7 * self.half.y);
        [[a - self.half.x, a], [self.half.x - c, c]]
    }

    /// Adds its parts.
    pub fn build(&self, b: &mut Builder, table: &Object, rng: &mut Rng) {
        let [top, below] = self.finish;
        for (name, mesh, is_top) in self.parts() {
            b.part(table, name, grained(mesh, rng), if is_top { top } else { below });
        }
    }

    /// Names and meshes of its parts, and whether they have the finish of the top.
    fn parts(&self) -> Vec<(&'static str, Mesh, bool)> {
        let (half, top) = (self.half, self.top);
        let slab =
            |thick: f32, inset: f32| board([inset - half.x, inset - half.y, top - thick], [half.x - inset, half.y - inset, top], 0.002);
        match self.low {
            Low::GlassFrame => {
                let (x, y) = (half.x - 0.03, half.y - 0.03);
                let under = top - 0.0102;
                let posts =
                    corners(Vec2::new(x, y)).map(|p| board([p.x - 0.0125, p.y - 0.0125, 0.0], [p.x + 0.0125, p.y + 0.0125, under], 0.001));
                let ring = |z: f32| {
                    let long = [-1.0f32, 1.0].map(|s| board([-x, s * y - 0.01, z - 0.02], [x, s * y + 0.01, z], 0.001));
                    let short = [-1.0f32, 1.0].map(|s| board([s * x - 0.01, -y, z - 0.0198], [s * x + 0.01, y, z - 0.0002], 0.001));
                    all(long.into_iter().chain(short))
                };
                let pane = board([0.0135 - x, 0.0135 - y, 0.14], [x - 0.0135, y - 0.0135, 0.148], 0.001);
                let frame = all(posts.into_iter().chain([ring(under - 0.0005), ring(0.1398)]));
                vec![("top", slab(0.01, 0.0), true), ("shelf", pane, true), ("frame", frame, false)]
            }
            Low::GlassCross => {
                let cross = [-1.0f32, 1.0].map(|s| {
                    let plank = |e: f32| {
                        let mesh = board([-0.03, -0.5, 0.0], [0.03, 0.5, 0.06], 0.003);
                        let high = top - 0.0122;
                        mesh.deformed(|p| {
                            let t = p.y + 0.5;
                            Vec3::new(s * (half.x - 0.2) + p.x + 0.0005 * e, e * (p.y * 2.0 * (half.y - 0.08)), (high - 0.06) * t + p.z)
                        })
                        .smoothed(30.0)
                    };
                    let mirrored = |mesh: Mesh| {
                        let triangles = mesh.triangles.iter().map(|&[p, q, r]| [p, r, q]).collect();
                        Mesh { triangles, normals: Vec::new(), ..mesh }.smoothed(30.0)
                    };
                    plank(1.0).with(mirrored(plank(-1.0)))
                });
                let rail = rod([0.2 - half.x, 0.0, 0.5 * top], [half.x - 0.2, 0.0, 0.5 * top], 0.018, 14);
                vec![("top", slab(0.012, 0.0), true), ("stand", all(cross).with(rail), false)]
            }
            Low::Drum => {
                let r = half.x;
                let profile = [
                    [0.0, 0.0],
                    [r - 0.03, 0.0],
                    [r - 0.012, 0.012],
                    [r - 0.012, top - 0.04],
                    [r, top - 0.03],
                    [r, top - 0.005],
                    [r - 0.006, top],
                    [0.0, top],
                ];
                let mut drum = super::form::turned(&profile, 64);
                drum.uvs.iter_mut().zip(&drum.positions).filter(|(_, p)| p.z > top - 0.001).for_each(|(uv, p)| *uv = Vec2::new(p.x, p.y));
                vec![("drum", drum, true)]
            }
            Low::Block => {
                // The compartment goes through from the front to the rear; a board in the middle divides it.
                let t = 0.03;
                let pieces = [
                    board([-half.x, -half.y, top - t], [half.x, half.y, top], 0.002),
                    board([-half.x, -half.y, 0.05], [half.x, half.y, 0.05 + t], 0.002),
                    board([-half.x, -half.y, 0.0502 + t], [t - half.x, half.y, top - t - 0.0002], 0.002),
                    board([half.x - t, -half.y, 0.0502 + t], [half.x, half.y, top - t - 0.0002], 0.002),
                    board([-0.01, 0.01 - half.y, 0.0502 + t], [0.01, half.y - 0.01, top - t - 0.0002], 0.002),
                ];
                let plinth = board([0.06 - half.x, 0.06 - half.y, 0.0], [half.x - 0.06, half.y - 0.06, 0.0502], 0.002);
                vec![("top", all(pieces), true), ("plinth", plinth, false)]
            }
            Low::Hairpins => {
                let pins = corners(Vec2::ONE).map(|s| hairpin(s * (half - 0.1), s, top - 0.0382));
                vec![("top", slab(0.038, 0.0), true), ("legs", all(pins), false)]
            }
            Low::Oval => {
                let outline: Vec<Vec2> = (0..64)
                    .map(|k| {
                        let (sin, cos) = (k as f32 / 64.0 * std::f32::consts::TAU).sin_cos();
                        let round = |v: f32| v.signum() * v.abs().powf(0.8);
                        half * Vec2::new(round(cos), round(sin))
                    })
                    .collect();
                let plate = cut_out(&outline, 0.024, 0.006).moved(Vec3::Z * (top - 0.024));
                let legs = corners(Vec2::ONE).map(|s| leg(top - 0.0238, [0.011, 0.021], s * 0.07).moved((s * half * 0.56).extend(0.0)));
                vec![("top", plate, true), ("legs", all(legs), false)]
            }
            Low::Nest => {
                let tables = self.nest();
                let highs = [top, top - 0.1];
                let tops = [0, 1].map(|k| round_top(tables[k][1], 0.018).moved(Vec3::new(tables[k][0], 0.0, highs[k])));
                let legs = [0, 1].map(|k| {
                    let [x, r] = tables[k];
                    let pins = super::form::around(3, if k == 0 { 1.05 } else { 0.0 }).map(|d| {
                        let at = Vec2::new(x, 0.0) + d * (r - 0.05);
                        standing(tube(&[(at + d * 0.02).extend(0.0), at.extend(highs[k] - 0.0182)], 0.009, 10))
                    });
                    // Legs stand on a ring of flat metal each.
                    let hoop: Vec<Vec3> = (0..=40)
                        .map(|i| (Vec2::new(x, 0.0) + Vec2::from_angle(i as f32 / 40.0 * std::f32::consts::TAU) * (r - 0.033)).extend(0.1))
                        .collect();
                    all(pins).with(tube(&hoop, 0.006, 8))
                });
                let [a, c] = tops;
                vec![("top_1", a, true), ("legs", all(legs), false), ("top_2", c, true)]
            }
            Low::Trunk => {
                let chest = hollow_box([0.006 - half.x, 0.006 - half.y, 0.02], [half.x - 0.006, half.y - 0.006, top - 0.07], 0.016);
                let front = board([0.0222 - half.x, half.y - 0.024, 0.0362], [half.x - 0.0222, half.y - 0.0062, top - 0.0862], 0.001);
                let lid = board([-half.x, -half.y, top - 0.0698], [half.x, half.y, top], 0.008);
                let feet = corners(half - 0.05).map(|p| board([p.x - 0.03, p.y - 0.03, 0.0], [p.x + 0.03, p.y + 0.03, 0.0202], 0.003));
                let band = |x: f32| board([x - 0.02, 0.004 - half.y, 0.021], [x + 0.02, half.y - 0.004, top - 0.0705], 0.001);
                let bands = [band(-0.6 * half.x), band(0.6 * half.x)];
                vec![("chest", all([chest, front]), true), ("lid", lid, true), ("bands", all(bands), false), ("feet", all(feet), false)]
            }
            Low::Padded => {
                let pad = padded_box(Vec3::new(2.0 * half.x, 2.0 * half.y, 0.16), 0.05, 0.018).moved(Vec3::Z * (top - 0.098));
                let base = board([0.02 - half.x, 0.02 - half.y, top - 0.2], [half.x - 0.02, half.y - 0.02, top - 0.16], 0.004);
                let feet = corners(half - 0.09).map(|p| leg(top - 0.1998, [0.014, 0.022], p.signum() * 0.02).moved(p.extend(0.0)));
                vec![("pad", pad, true), ("base", base, false), ("legs", all(feet), false)]
            }
            Low::Bridge => {
                let t = 0.036;
                let sides = [-1.0f32, 1.0].map(|s| {
                    let x = s * (half.x - 0.5 * t);
                    board([x - 0.5 * t, -half.y, 0.0], [x + 0.5 * t, half.y, top - t - 0.0002], 0.003)
                });
                let shelf = board([t - half.x + 0.0002, 0.03 - half.y, 0.14], [half.x - t - 0.0002, half.y - 0.03, 0.16], 0.002);
                vec![("top", slab(t, 0.0), true), ("sides", all(sides), false), ("shelf", shelf, true)]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::{CoffeeTable, Furniture, Place, style_tests::check};

    #[test]
    fn every_style_stands_and_is_of_one_piece() {
        let mut rng = Rng::new(1);
        let mut things: Vec<(String, Box<dyn Furniture>)> = Vec::new();
        for &(_, style) in STYLES {
            things.extend((0..2).map(|k| {
                (format!("{:?} {k}", style.0), Box::new(CoffeeTable::Styled(LowTable::of(style, &mut rng))) as Box<dyn Furniture>)
            }));
        }
        check(Place::Free, &things);
    }
}
