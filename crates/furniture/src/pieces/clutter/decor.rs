//! Ornaments and boxes that stand on furniture: photographs in frames of 11 to 21 cm (class picture), groups of one to three pillar candles
//! on a tray, figurines, boxes of tissues and board games (class box), and woven baskets of 16 to 30 cm; the rest is of class other prop.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::palette::Palette;
use crate::pieces::form::{all, cylinder, loft, rod, turned, vessel};
use crate::pieces::wall_art::printed;
use crate::pieces::{CONTACT, Furniture, board, grained, on};
use crate::shape::{Reshape, bevelled_box, grid, picture_frame, rounded_loop, sphere, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use enfilade_textures::PaintingStyle;

/// A small framed picture that stands on its strut.
#[derive(Clone, Copy, Debug)]
pub struct PhotoFrame {
    /// Width and height over the frame.
    pub size: Vec2,
    /// Finish of the frame.
    pub finish: Finish,
}

/// How far a photo frame leans back, radians.
const LEAN: f32 = 0.2;

impl Furniture for PhotoFrame {
    fn random(rng: &mut Rng) -> Self {
        let (a, c) = (rng.range(0.11, 0.16), rng.range(0.15, 0.21));
        let size = if rng.below(2) == 0 { Vec2::new(a, c) } else { Vec2::new(c, a) };
        Self { size, finish: [Finish::Wood, Finish::BlackMetal, Finish::Brass, Finish::WhiteLacquer][rng.below(4)] }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.size.x, 0.13, self.size.y + 0.003)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let (w, h) = (self.size.x, self.size.y);
        let place = on(pose, Vec3::new(0.0, 0.045, CONTACT + 0.0005), 0.0);
        let frame = b.object("photo_frame", Class::Picture, place);
        let lean = |mesh: enfilade_geometry::Mesh| mesh.moved(Vec3::new(0.0, 0.0, 0.5 * h)).turned(Vec3::X, LEAN);
        let section = [[0.0, 0.0], [0.0, 0.012], [0.002, 0.014], [0.013, 0.012], [0.014, 0.0]];
        b.part(&frame, "frame", lean(grained(picture_frame(w, h, &section), rng)), self.finish);
        b.part(
            &frame,
            "back",
            lean(board([0.002 - 0.5 * w, 0.0005, 0.002 - 0.5 * h], [0.5 * w - 0.002, 0.004, 0.5 * h - 0.002], 0.0004)),
            Finish::Cardboard,
        );
        let style = [PaintingStyle::Hills, PaintingStyle::Hills, PaintingStyle::Shapes][rng.below(3)];
        let palettes = Palette::all();
        let material = printed(b, "photo", style, &palettes[rng.below(palettes.len())], rng);
        let half = 0.5 * self.size - 0.013;
        let corner = |i: usize, j: usize| Vec2::new(i as f32, j as f32);
        let print =
            grid(1, 1, |i, j| Vec3::new(half.x * (1.0 - 2.0 * corner(i, j).x), 0.0045, half.y * (2.0 * corner(i, j).y - 1.0)), corner);
        b.part(&frame, "print", lean(print), material);
        let top = 0.62 * h;
        let strut = rod([0.0, -top * LEAN.sin() - 0.001, top * LEAN.cos()], [0.0, -0.085 - 0.05 * h, 0.003], 0.0035, 6);
        b.part(&frame, "strut", crate::pieces::standing(strut), self.finish);
    }
}

/// Thick candles in a group, on a tray.
#[derive(Clone, Copy, Debug)]
pub struct PillarCandles {
    /// One to three.
    pub count: usize,
}

impl Furniture for PillarCandles {
    fn random(rng: &mut Rng) -> Self {
        Self { count: 1 + rng.below(3) }
    }

    fn size(&self) -> Vec3 {
        let w = if self.count == 1 { 0.12 } else { 0.22 };
        Vec3::new(w, w, 0.19)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let r = 0.5 * self.size().x;
        let tray = b.object("tray", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let plate = vessel(&[[0.8 * r, 0.0], [0.97 * r, 0.003], [r, 0.012]], 0.003, 48);
        b.part(&tray, "plate", plate, [Finish::Brass, Finish::Ceramic(0), Finish::DarkWood, Finish::MarbleTop][rng.below(4)]);
        for (k, d) in crate::pieces::form::around(self.count, 0.5).enumerate() {
            let at = if self.count == 1 { Vec2::ZERO } else { d * 0.05 };
            let (radius, h) = (rng.range(0.03, 0.037), 0.07 + 0.035 * k as f32 + rng.range(0.0, 0.02));
            let candle = b.object("candle", Class::OtherProp, on(pose, at.extend(0.0032 + 2.0 * CONTACT), 0.0));
            let wax = [[0.0, 0.0], [radius, 0.0], [radius, h - 0.003], [radius - 0.004, h], [radius - 0.008, h - 0.003], [0.0, h - 0.007]];
            b.part(&candle, "wax", turned(&wax, 32), Finish::Wax);
            b.part(&candle, "wick", rod([0.0, 0.0, h - 0.009], [0.002, 0.0, h + 0.007], 0.0009, 5), Finish::Soil);
        }
    }
}

/// A small sculpture: a knot, three arches in each other, a bird, or a stack of pebbles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum Figurine {
    Knot,
    Arch,
    Bird,
    Pebbles,
}

impl Furniture for Figurine {
    fn random(rng: &mut Rng) -> Self {
        [Self::Knot, Self::Arch, Self::Bird, Self::Pebbles][rng.below(4)]
    }

    fn size(&self) -> Vec3 {
        Vec3::from_array(match self {
            Self::Knot => [0.19, 0.19, 0.085],
            Self::Arch => [0.17, 0.05, 0.16],
            Self::Bird => [0.2, 0.09, 0.14],
            Self::Pebbles => [0.13, 0.13, 0.14],
        })
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("figurine", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let finish = [Finish::Ceramic(rng.below(3) as u8), Finish::Wood, Finish::Brass, Finish::DarkWood, Finish::Stone][rng.below(5)];
        match self {
            Self::Knot => {
                // A trefoil that lies on its loops.
                let path: Vec<Vec3> = (0..=72)
                    .map(|k| {
                        let t = std::f32::consts::TAU * k as f32 / 72.0;
                        Vec3::new(
                            0.024 * (t.sin() + 2.0 * (2.0 * t).sin()),
                            0.024 * (t.cos() - 2.0 * (2.0 * t).cos()),
                            -0.022 * (3.0 * t).sin() + 0.039,
                        )
                    })
                    .collect();
                b.part(&object, "knot", tube(&path, 0.0165, 16), finish);
            }
            Self::Arch => {
                for k in 0..3usize {
                    let r = 0.066 - 0.026 * k as f32;
                    let path: Vec<Vec3> = (0..=28)
                        .map(|i| match i {
                            0 => Vec3::new(r, 0.0, 0.0),
                            28 => Vec3::new(-r, 0.0, 0.0),
                            i => {
                                let a = std::f32::consts::PI * (i - 1) as f32 / 26.0;
                                Vec3::new(r * a.cos(), 0.0, 0.072 + r * a.sin())
                            }
                        })
                        .collect();
                    b.part(
                        &object,
                        &format!("arch_{}", k + 1),
                        tube(&path, 0.0125, 16),
                        [Finish::Wood, finish, Finish::Accent(k as u8)][k],
                    );
                }
            }
            Self::Bird => {
                let body = sphere(1.0, 28)
                    .deformed(|p| {
                        let tail = (-p.x).max(0.0);
                        Vec3::new(
                            0.062 * p.x - 0.03 * tail * tail,
                            0.036 * p.y * (1.0 - 0.55 * tail),
                            0.046 * p.z * (1.0 - 0.35 * tail) + 0.018 * tail,
                        )
                    })
                    .smoothed(60.0);
                let body = body.moved(Vec3::new(0.0, 0.0, 0.052));
                let head = sphere(0.026, 22).moved(Vec3::new(0.05, 0.0, 0.105));
                let beak = turned(&[[0.0, 0.0], [0.006, 0.0], [0.0, 0.022]], 14)
                    .turned(Vec3::Y, std::f32::consts::FRAC_PI_2)
                    .moved(Vec3::new(0.073, 0.0, 0.104));
                b.part(&object, "body", body.with(head), finish);
                b.part(&object, "beak", beak, Finish::Brass);
                b.part(&object, "foot", cylinder(0.026, 0.012, 28), Finish::DarkWood);
            }
            Self::Pebbles => {
                let mut z = 0.0;
                for k in 0..4usize {
                    let (r, h) = (0.06 - 0.011 * k as f32, 0.019 - 0.002 * k as f32);
                    let stone = sphere(1.0, 28).deformed(|p| Vec3::new(r * p.x, 0.84 * r * p.y, h * p.z)).smoothed(60.0);
                    let at = Vec3::new(rng.range(-0.004, 0.004), rng.range(-0.004, 0.004), z + h);
                    b.part(&object, &format!("pebble_{}", k + 1), stone.turned(Vec3::Z, rng.range(0.0, 3.0)).moved(at), Finish::Stone);
                    z += 2.0 * h - 0.0005;
                }
            }
        }
    }
}

/// A box of paper handkerchiefs, one sticking out.
#[derive(Clone, Copy, Debug)]
pub struct TissueBox {
    /// A cube instead of a long box.
    pub cube: bool,
    /// Number of the colour of its cardboard.
    pub color: u8,
}

impl Furniture for TissueBox {
    fn random(rng: &mut Rng) -> Self {
        Self { cube: rng.below(2) == 0, color: rng.below(4) as u8 }
    }

    fn size(&self) -> Vec3 {
        if self.cube { Vec3::new(0.122, 0.115, 0.20) } else { Vec3::new(0.235, 0.115, 0.13) }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let tissues = b.object("tissue_box", Class::Box, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let (w, d, h) = if self.cube { (0.113, 0.113, 0.125) } else { (0.233, 0.113, 0.06) };
        b.part(&tissues, "box", board([-0.5 * w, -0.5 * d, 0.0], [0.5 * w, 0.5 * d, h], 0.0015), Finish::ColoredLacquer(self.color));
        b.part(&tissues, "slit", loft(&[[0.08, 0.028, 0.013, h - 0.001], [0.08, 0.028, 0.013, h + 0.0006]], 5), Finish::Soil);
        let phase = rng.range(0.0, 6.0);
        let sheet = |side: f32| {
            let point = move |i: usize, j: usize| {
                let (u, t) = (i as f32 / 18.0 - 0.5, j as f32 / 12.0);
                let spread = 0.05 + 0.05 * t;
                let fold = (0.006 + 0.016 * t) * (13.0 * u + phase).sin() + 0.012 * t * t * (3.0 * u).cos();
                Vec3::new(-u * spread * 1.2, fold + side * 0.0003, h - 0.002 + 0.066 * t * (1.0 - 0.9 * u * u))
            };
            let mesh = grid(18, 12, point, |i, j| Vec2::new(i as f32 * 0.006, j as f32 * 0.006));
            if side > 0.0 {
                mesh
            } else {
                enfilade_geometry::Mesh { triangles: mesh.triangles.iter().map(|&[p, q, r]| [p, r, q]).collect(), ..mesh }
            }
        };
        b.part(&tissues, "tissue", sheet(1.0).smoothed(70.0).with(sheet(-1.0).smoothed(70.0)), Finish::Paper);
    }
}

/// A board game's box, or several on each other.
#[derive(Clone, Copy, Debug)]
pub struct BoardGame {
    /// Boxes on each other.
    pub count: usize,
}

impl Furniture for BoardGame {
    fn random(rng: &mut Rng) -> Self {
        Self { count: 1 + rng.below(4) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.36, 0.34, 0.062 * self.count as f32 + 0.002)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let mut z = CONTACT;
        for k in 0..self.count {
            let (w, d, h) = (0.3 - 0.012 * k as f32 + rng.range(0.0, 0.012), 0.29 - 0.015 * k as f32, rng.range(0.045, 0.06));
            let game = b.object("board_game", Class::Box, on(pose, Vec3::new(0.0, 0.0, z), rng.range(-0.12, 0.12)));
            let color = Finish::ColoredLacquer((k + rng.below(5)) as u8);
            b.part(
                &game,
                "tray",
                bevelled_box(Vec3::new(w - 0.004, d - 0.004, 0.4 * h), 0.001).moved(Vec3::new(0.0, 0.0, 0.2 * h)),
                Finish::Cardboard,
            );
            b.part(&game, "lid", bevelled_box(Vec3::new(w, d, 0.8 * h), 0.0015).moved(Vec3::new(0.0, 0.0, 0.6 * h)), color);
            let title = board([-0.3 * w, 0.5 * d - 0.0003, 0.45 * h], [0.3 * w, 0.5 * d + 0.0004, 0.75 * h], 0.0002);
            let picture = board([-0.36 * w, -0.34 * d, h - 0.0003], [0.36 * w, 0.34 * d, h + 0.0004], 0.0002);
            b.part(&game, "print", title.with(picture), Finish::Accent(k as u8));
            z += h + CONTACT + 0.0004;
        }
    }
}

/// A basket for bread, keys or wool: woven, with two grips.
#[derive(Clone, Copy, Debug)]
pub struct StorageBasket {
    /// Width, depth and height of the body.
    pub body: Vec3,
    /// Finish of the weave.
    pub finish: Finish,
}

impl Furniture for StorageBasket {
    fn random(rng: &mut Rng) -> Self {
        let body = Vec3::new(rng.range(0.16, 0.3), rng.range(0.14, 0.2), rng.range(0.09, 0.15));
        Self { body, finish: [Finish::Wicker, Finish::Rattan, Finish::Felt][rng.below(3)] }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.body.x + 0.01, self.body.y + 0.01, self.body.z + 0.032)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let basket = b.object("basket", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let (w, d, h) = (self.body.x, self.body.y, self.body.z);
        let ring = |inset: f32, z: f32| [w - inset, d - inset, 0.04, z];
        let walls = loft(&[ring(0.03, 0.0), ring(0.02, 0.006), ring(0.0, h), ring(0.014, h), ring(0.034, 0.012), ring(0.05, 0.01)], 6);
        b.part(&basket, "weave", walls.uv_moved(Vec2::splat(rng.next_f32())), self.finish);
        let rim = tube(&rounded_loop(w - 0.006, d - 0.006, 0.04, 6), 0.006, 8).moved(Vec3::new(0.0, 0.0, h));
        let grip = |s: f32| {
            crate::pieces::form::wire(
                &[
                    [s * (0.5 * w - 0.004), -0.035, h],
                    [s * (0.5 * w - 0.004), -0.03, h + 0.024],
                    [s * (0.5 * w - 0.004), 0.03, h + 0.024],
                    [s * (0.5 * w - 0.004), 0.035, h],
                ],
                0.0045,
                8,
            )
        };
        b.part(&basket, "rim", all([rim, grip(-1.0), grip(1.0)]), self.finish);
    }
}
