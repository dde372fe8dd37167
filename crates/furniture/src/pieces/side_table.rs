//! Small tables beside a sofa, 36 to 50 cm wide and 45 to 60 cm high, class table. A row of [`STYLES`] is a style with its weight.

use super::dining_table::round_top;
use super::form::{all, around, corners, rod, turned};
use super::style::drawn;
use super::{Furniture, board, grained, standing};
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::materials::Finish::{BlackMetal, Brass, Chrome, DarkWood, DrinkingGlass, MarbleTop, Stone, WhiteLacquer, Wood};
use crate::shape::{Reshape, lathe, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// The build of a side table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// A round top on a thin column and a plate.
    Pedestal,
    /// A round top on three slanted legs.
    Tripod,
    /// A round top with a rim on crossed rods.
    Tray,
    /// A square top and a shelf on four posts.
    Posts,
    /// Two frames of metal and a top that reaches over the seat beside it.
    Frame,
    /// An open cube.
    Cube,
    /// A solid drum that is narrower in the middle.
    Drum,
    /// A turned column on three bent feet.
    Turned,
}

/// A build, smallest and largest width and height, and the finishes of top and stand, drawn together.
type Row = (Side, [f32; 2], [f32; 2], &'static [[Finish; 2]]);

const METAL: &[[Finish; 2]] = &[[Wood, BlackMetal], [MarbleTop, Brass], [DrinkingGlass, Chrome], [DarkWood, BlackMetal]];
const WOOD: &[[Finish; 2]] = &[[Wood, Wood], [DarkWood, DarkWood], [WhiteLacquer, Wood]];

/// The styles and their weights.
const STYLES: &[(u32, Row)] = &[
    (2, (Side::Pedestal, [0.40, 0.46], [0.48, 0.54], METAL)),
    (3, (Side::Tripod, [0.40, 0.46], [0.48, 0.54], WOOD)),
    (2, (Side::Tray, [0.38, 0.45], [0.48, 0.55], &[[BlackMetal, Wood], [BlackMetal, BlackMetal], [Brass, DarkWood]])),
    (2, (Side::Posts, [0.40, 0.5], [0.5, 0.6], WOOD)),
    (2, (Side::Frame, [0.40, 0.48], [0.55, 0.6], METAL)),
    (1, (Side::Cube, [0.40, 0.45], [0.42, 0.46], WOOD)),
    (1, (Side::Drum, [0.38, 0.44], [0.45, 0.5], &[[Stone, Stone], [Wood, Wood], [Brass, Brass]])),
    (1, (Side::Turned, [0.42, 0.5], [0.55, 0.62], &[[DarkWood, DarkWood], [Wood, Wood]])),
];

/// A small table beside the sofa.
#[derive(Clone, Copy, Debug)]
pub struct SideTable {
    /// The build.
    pub side: Side,
    /// Diameter of the top, or its width and depth.
    pub diameter: f32,
    /// Height of the top's surface.
    pub height: f32,
    /// Finishes of top and stand.
    pub finish: [Finish; 2],
}

impl SideTable {
    fn of((side, wide, high, finishes): Row, rng: &mut Rng) -> Self {
        let finish = finishes[rng.below(finishes.len())];
        Self { side, diameter: rng.range(wide[0], wide[1]), height: rng.range(high[0], high[1]), finish }
    }

    fn top(&self) -> Mesh {
        let (r, h) = (0.5 * self.diameter, self.height);
        match self.side {
            Side::Posts | Side::Frame | Side::Cube => board([-r, -r, h - 0.02], [r, r, h], 0.003),
            Side::Tray => {
                let floor = h - 0.012;
                turned(
                    &[
                        [0.0, floor],
                        [r - 0.004, floor],
                        [r, floor + 0.006],
                        [r, h + 0.02],
                        [r - 0.003, h + 0.022],
                        [r - 0.005, h + 0.018],
                        [r - 0.007, h],
                        [0.0, h],
                    ],
                    56,
                )
            }
            Side::Drum => {
                let w = 0.86 * r;
                let profile =
                    [[0.0, 0.0], [r - 0.02, 0.0], [r - 0.008, 0.012], [w, 0.3 * h], [w, 0.7 * h], [r, h - 0.012], [r - 0.006, h], [0.0, h]];
                turned(&profile, 56)
            }
            Side::Pedestal | Side::Tripod | Side::Turned => round_top(r, 0.02).moved(Vec3::Z * h),
        }
    }

    fn stand(&self) -> Mesh {
        let (r, h) = (0.5 * self.diameter, self.height - 0.0195);
        match self.side {
            Side::Pedestal => {
                let profile = [
                    [0.0, 0.0],
                    [0.15, 0.0],
                    [0.153, 0.004],
                    [0.15, 0.009],
                    [0.03, 0.016],
                    [0.014, 0.03],
                    [0.014, h - 0.02],
                    [0.05, h],
                    [0.0, h],
                ];
                lathe(&profile.map(Vec2::from_array), 40)
            }
            Side::Tripod => {
                let path = |out: Vec2| [(out * 0.92 * r).extend(0.0), (out * 0.55 * r).extend(h)];
                all(around(3, 0.5).map(|out| standing(tube(&path(out), 0.013, 14))))
            }
            Side::Tray => {
                let h = self.height - 0.0122;
                let leg = |d: Vec2, e: f32| {
                    standing(tube(&[(d * 0.9 * r).extend(0.0), (d.perp() * e).extend(0.5 * h), (-d * 0.8 * r).extend(h)], 0.009, 10))
                };
                all(around(4, 0.4).map(|d| leg(d, 0.004)))
            }
            Side::Posts => {
                let posts = corners(Vec2::splat(r - 0.03))
                    .map(|p| board([p.x - 0.015, p.y - 0.015, 0.0], [p.x + 0.015, p.y + 0.015, h - 0.0007], 0.002));
                let shelf = board([0.02 - r, 0.02 - r, 0.15], [r - 0.02, r - 0.02, 0.166], 0.002);
                let rails = [-1.0f32, 1.0]
                    .map(|s| board([0.035 - r, s * (r - 0.03) - 0.008, h - 0.05], [r - 0.035, s * (r - 0.03) + 0.008, h - 0.0009], 0.001));
                all(posts.into_iter().chain(rails).chain([shelf]))
            }
            Side::Frame => {
                // A foot to the front and a post at either side of the rear edge.
                let sides = [-1.0f32, 1.0].map(|s| {
                    let x = s * (r - 0.02);
                    let bar = |y: [f32; 2], z: [f32; 2]| board([x - 0.01, y[0], z[0]], [x + 0.01, y[1], z[1]], 0.001);
                    all([
                        bar([0.02 - r, r - 0.04], [0.0, 0.02]),
                        bar([0.0202 - r, 0.04 - r], [0.0198, h - 0.0007]),
                        bar([0.0402 - r, r - 0.06], [h - 0.0207, h - 0.0009]),
                    ])
                });
                let bars = [0.03 - r, r - 0.05].map(|y| board([0.02 - r, y - 0.009, 0.0008], [r - 0.02, y + 0.009, 0.0192], 0.001));
                all(sides.into_iter().chain(bars))
            }
            Side::Cube => {
                let t = 0.02;
                let sides = [-1.0f32, 1.0].map(|s| {
                    let x = s * (r - 0.5 * t);
                    board([x - 0.5 * t, -r, 0.0202], [x + 0.5 * t, r, h - 0.0007], 0.002)
                });
                let floor = board([-r, -r, 0.0], [r, r, 0.02], 0.002);
                let shelf = board([t - r + 0.0002, 0.004 - r, 0.5 * h], [r - t - 0.0002, r - 0.004, 0.5 * h + 0.016], 0.002);
                all(sides.into_iter().chain([floor, shelf]))
            }
            Side::Drum => Mesh::default(),
            Side::Turned => {
                let column = [
                    [0.0, 0.08],
                    [0.022, 0.08],
                    [0.032, 0.12],
                    [0.018, 0.2],
                    [0.016, 0.3],
                    [0.03, 0.38],
                    [0.018, 0.46],
                    [0.022, h - 0.012],
                    [0.1, h - 0.006],
                    [0.1, h],
                    [0.0, h],
                ];
                let feet = around(3, 0.5).map(|d| {
                    let at = |q: f32, z: f32| [d.x * q, d.y * q, z];
                    standing(super::form::wire(&[at(0.01, 0.13), at(0.08, 0.11), at(0.7 * r, 0.04), at(0.86 * r, 0.012)], 0.014, 10))
                });
                turned(&column, 28).with(all(feet)).with(rod([0.0, 0.0, 0.07], [0.0, 0.0, 0.09], 0.02, 12))
            }
        }
    }
}

impl Furniture for SideTable {
    fn random(rng: &mut Rng) -> Self {
        Self::of(drawn(STYLES, rng), rng)
    }

    fn size(&self) -> Vec3 {
        let rim = if self.side == Side::Tray { 0.022 } else { 0.0 };
        Vec3::new(self.diameter, self.diameter, self.height + rim)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let table = b.object("side_table", Class::Table, pose);
        b.part(&table, "top", grained(self.top(), rng), self.finish[0]);
        if self.side != Side::Drum {
            b.part(&table, "stand", grained(self.stand(), rng), self.finish[1]);
        }
    }
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
            things.extend((0..2).map(|k| (format!("{:?} {k}", style.0), Box::new(SideTable::of(style, &mut rng)) as Box<dyn Furniture>)));
        }
        check(Place::Free, &things);
    }
}
